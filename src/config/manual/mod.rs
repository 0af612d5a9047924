//! The manual of style files, made from the tables that the loader reads styles by.

mod strips;

use std::fmt::Write as _;

use super::catalog::{Catalog, Role};
use super::param::Param;
use super::sections::SECTIONS;
use super::selector::{AttributeValues, ObjectKind};

pub use strips::{Shown, Strip, strips};

/// The manual's file.
pub const FILE: &str = "style-files.md";

/// The folder of its pictures, beside it.
pub const PICTURES: &str = "style-files";

/// The manual of style files in Markdown.
pub fn manual(catalog: &Catalog<'_>) -> String {
    let mut text = include_str!("intro.md").to_owned();
    text.push_str(&selectors(catalog));
    let strips = strips(catalog);
    for section in SECTIONS.iter() {
        let each = if section.is_list { " Each light has these keys:" } else { "" };
        let _ = write!(text, "\n## `{}`\n\n{}{each}\n", section.key, section.doc);
        parameters(&mut text, section.key, section.params, &strips);
    }
    for role in [Role::Object, Role::PostEffect] {
        let title = if role == Role::Object { "Shader" } else { "Post effect" };
        for entry in catalog.shaders.iter().filter(|entry| entry.role == role) {
            let _ = write!(text, "\n## {title} `{}`\n\n{}\n", entry.name, entry.doc);
            parameters(&mut text, entry.name, entry.params, &strips);
        }
    }
    text
}

fn parameters(text: &mut String, group: &str, params: &[Param], strips: &[Strip]) {
    for param in params {
        let _ = write!(text, "\n### {group}: `{}`\n\n{}\n\n{}\n", param.name, param.doc, param.facts());
        if let Some(strip) = strips.iter().find(|strip| strip.group == group && strip.param == param.name) {
            let shown = format!("Left to right: `{}`", param.examples.join("`, `"));
            let alt = format!("{} in {} steps", param.name, param.examples.len());
            let _ = write!(text, "\n![{alt}]({PICTURES}/{}.png)\n\n{shown}. {}\n", strip.name(), strip.said);
        }
    }
}

/// Types, attributes, and which rule wins.
fn selectors(catalog: &Catalog<'_>) -> String {
    let mut text = "\n## Selectors\n\nA key of `mapping` is a type, or `*` for all types, then any number of \
                    `[attribute=value]`, all of which must match.\n\n| type | picks |\n|---|---|\n"
        .to_owned();
    let drawn = |kind: &ObjectKind| catalog.kinds.contains(kind);
    for kind in ObjectKind::ALL.iter().filter(|kind| drawn(kind)) {
        let _ = writeln!(text, "| `{}` | {} |", kind.name(), kind.doc());
    }
    text.push_str("| `*` | Everything. |\n\n| attribute | of | is |\n|---|---|---|\n");
    for attribute in catalog.attributes() {
        let kinds = catalog.kinds.iter().filter(|kind| kind.attributes().contains(&attribute));
        let kinds: Vec<String> = kinds.map(|kind| format!("`{}`", kind.name())).collect();
        let _ = writeln!(text, "| `{}` | {} | {} |", attribute.name(), kinds.join(", "), attribute.doc());
    }
    let ranges: Vec<String> = catalog
        .attributes()
        .filter(|attribute| attribute.values() != AttributeValues::Texts)
        .map(|attribute| format!("`{}`", attribute.name()))
        .collect();
    let _ = write!(
        text,
        "\n`*` in a value stands for any characters and `?` for one; upper and lower case differ except in `element`. \
         The values of {} are numbers and may be asked for by ranges, which hold their ends: `atom[number=10..40]`, \
         `atom[b_factor=50..]`, `atom[charge=..-0.5]`. A value that holds `]` is quoted: `atom[name=\"A]\"]`. Of two rules that select the same object, the one with \
         more attributes wins, then a type over `*`, then the later one; a base comes before what extends it. `restyle info SCENE --selectors` lists \
         selectors for what a scene has.\n",
        ranges.join(", ")
    );
    text
}
