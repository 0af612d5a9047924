//! Where a key belongs that stands in the wrong part of a style: what designers get wrong most.
//!
//! Every table that a style can use is asked, so that a parameter that is declared is found without being named here.

use super::catalog::{Catalog, CatalogEntry};
use super::hint::quote;
use super::param::Param;
use super::sections::SECTIONS;
use super::selector::ObjectKind;
use super::{shaders, style};

/// Keys of an entry of `shaders` that mean nothing else; a `name` may be meant for anything.
const OF_ENTRY: [&str; 2] = ["shader", "properties"];

/// Most places that a message names.
const MOST_PLACES: usize = 3;

/// Whether both are one word in different spellings: `bgColour` and `bgcolor`, `base-color` and `base_color`.
pub(super) fn is_same_word(a: &str, b: &str) -> bool {
    /// Longer than any key of a style.
    const LONGEST: usize = 64;
    let plain = |word: &str| {
        let letters: String = word.chars().filter(|c| !matches!(c, '_' | '-' | ' ')).collect();
        letters.to_lowercase().replace("colour", "color")
    };
    a.len() <= LONGEST && b.len() <= LONGEST && plain(a) == plain(b)
}

/// Whether a key is a type of objects, or begins with one.
pub(super) fn begins_selector(key: &str) -> bool {
    let kind = key.split('[').next().unwrap_or(key).trim_end();
    ObjectKind::ALL.iter().any(|known| known.name() == kind)
}

/// Where `key` belongs, in words such as `it belongs in "camera"`; `None`: nowhere. `entry` is the shader of the entry that
/// the key stands in, if it stands in one.
pub(super) fn home(key: &str, catalog: &Catalog<'_>, entry: Option<&CatalogEntry>) -> Option<String> {
    let known = |name: &&'static str| is_same_word(key, name);
    let param_of = |params: &'static [Param]| params.iter().map(|param| param.name).find(known);
    let belongs = |name: &str, places: &[String]| {
        let spelling = if name == key { String::new() } else { format!(", as {}", quote(name)) };
        format!("it belongs {}{spelling}", places.join(", or "))
    };
    if let Some(name) = style::KEYS.into_iter().find(known) {
        return Some(belongs(name, &["at the top of the style".to_owned()]));
    }
    if let Some(name) = entry.and_then(|entry| param_of(entry.params)) {
        return Some(belongs(name, &["in the \"properties\" of this entry".to_owned()]));
    }
    if matches!(key.trim_start_matches(['_', '$']).to_lowercase().as_str(), "//" | "#" | "comment" | "comments") {
        return Some("a comment is written as // and its words, without a key".to_owned());
    }
    let mut found: Vec<(&str, String)> = Vec::new();
    for section in SECTIONS {
        let place = if section.is_list { "in a light of" } else { "in" };
        found.extend(param_of(section.params).map(|name| (name, format!("{place} {}", quote(section.key)))));
    }
    let of_mapping = if begins_selector(key) { Some(key) } else { Some(style::POST_EFFECTS).filter(known) };
    found.extend(of_mapping.map(|name| (name, "in \"mapping\"".to_owned())));
    if let Some(name) = shaders::SHARED.into_iter().find(known) {
        found.push((name, "in the \"properties\" of a shader".to_owned()));
    } else {
        let of = |entry: &CatalogEntry| {
            param_of(entry.params)
                .map(|name| (name, format!("in the \"properties\" of a shader {}", quote(entry.name))))
        };
        found.extend(catalog.shaders.iter().filter_map(of));
    }
    found.extend(OF_ENTRY.into_iter().find(known).map(|name| (name, "in an entry of \"shaders\"".to_owned())));
    let (name, _) = *found.first()?;
    let places: Vec<String> =
        found.iter().filter(|(other, _)| *other == name).map(|(_, place)| place.clone()).collect();
    Some(belongs(name, &places[..places.len().min(MOST_PLACES)]))
}
