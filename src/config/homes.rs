//! Where a key belongs that stands in the wrong place: a designer mostly knows the word and not the bracket.

use super::catalog::{Catalog, Role};
use super::sections::SECTIONS;
use super::shaders::KEYS as ENTRY_KEYS;
use super::style::KEYS as STYLE_KEYS;

/// What messages call one entry of `shaders`.
pub(super) const ENTRY: &str = "a shader entry";

/// All places of a style in which keys are known.
pub(super) struct Homes<'a> {
    catalog: Catalog<'a>,
}

impl<'a> Homes<'a> {
    pub(super) fn new(catalog: Catalog<'a>) -> Self {
        Self { catalog }
    }

    /// Where a key belongs that `owner`, such as `camera`, does not have; none if no place has it.
    pub(super) fn of(&self, owner: &str, key: &str) -> Option<String> {
        let is_drawn = |params: &[super::Param]| params.iter().any(|param| param.drawn && param.name == key);
        let shaders = self.catalog.shaders.iter().filter(|entry| entry.drawn && is_drawn(entry.params));
        let of_objects = |role| shaders.clone().any(|entry| entry.role == role);
        if owner == ENTRY && (of_objects(Role::Object) || of_objects(Role::PostEffect)) {
            return Some("its \"properties\"".to_owned());
        }
        let mut homes = Vec::new();
        if STYLE_KEYS.contains(&key) && owner != "a style" {
            homes.push("the style itself, outside of all other brackets".to_owned());
        }
        for section in SECTIONS.iter().filter(|section| is_drawn(section.params)) {
            let home = if section.is_list { "a light of" } else { "the part" };
            homes.push(format!("{home} \"{}\"", section.key));
        }
        if ENTRY_KEYS.contains(&key) && owner != ENTRY {
            homes.push("an entry of \"shaders\"".to_owned());
        }
        // Which shader has it matters only where a shader is asked.
        if owner.starts_with("shader ") {
            homes.extend(shaders.map(|entry| format!("the shader \"{}\"", entry.name)));
        } else if of_objects(Role::Object) {
            homes.push("the \"properties\" of a shader".to_owned());
        }
        (!homes.is_empty()).then(|| homes.join(" or "))
    }
}
