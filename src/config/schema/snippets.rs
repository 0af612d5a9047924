//! What an editor inserts: whole pieces of a style, in the syntax of VS Code's snippets.

use serde_json::{Map, Value, json};

use super::FILE;
use super::param::default;
use crate::config::catalog::{Catalog, Role};
use crate::config::light;
use crate::config::param::Kind;
use crate::config::transfer::TransferKind;

/// A whole small style.
pub(super) fn whole_style() -> Value {
    json!({
        "label": "a small style",
        "description": "Background, one shader, and which objects it draws.",
        "body": {
            "$schema": FILE,
            "version": 1,
            "camera": { "bgcolor": "${1:#ffffff}" },
            "mapping": { "*": "${2:look}" },
            "shaders": [{ "name": "${2:look}", "shader": "${3:toon}", "properties": {} }],
        },
    })
}

/// An entry of `shaders` for each shader, with its first property as it is by default.
pub(super) fn shaders(catalog: &Catalog<'_>) -> Value {
    let of = |role| catalog.shaders.iter().filter(move |entry| entry.role == role);
    let entries = of(Role::Object).chain(of(Role::PostEffect)).map(|entry| {
        let first = entry.params.first();
        let properties: Map<String, Value> =
            first.into_iter().map(|param| (param.name.to_owned(), default(param))).collect();
        json!({
            "label": entry.name,
            "description": entry.doc,
            "body": { "name": "${1:name}", "shader": entry.name, "properties": properties },
        })
    });
    entries.collect()
}

/// A light of each type, with the keys that it reads.
pub(super) fn lights() -> Value {
    let types = light::PARAMS.iter().find(|param| param.name == "type").map_or(&[][..], |param| match param.kind {
        Kind::Choice(of) => of,
        _ => &[],
    });
    let entries = types.iter().map(|word| {
        let mut body = json!({ "type": word });
        if *word != "ambient" {
            body["position"] = json!(["^${1:1}", "^${2:2}", "^${3:3}"]);
            body["color"] = "#ffffff".into();
            body["shadow"] = "${4:none}".into();
        }
        body["intensity"] = "^${5:1}".into();
        json!({ "label": format!("{word} light"), "body": body })
    });
    entries.collect()
}

/// A length in each unit.
pub(super) fn lengths() -> Value {
    json!([
        { "label": "\"2pt\"", "description": "Points: picture height / 1080.", "body": "${1:2}pt" },
        { "label": "\"3r\"", "description": "Median radii of the drawn atoms.", "body": "${1:3}r" },
        { "label": "\"1.5A\"", "description": "Angstrom.", "body": "${1:1.5}A" },
        { "label": "\"2mm\"", "description": "Millimetres.", "body": "${1:2}mm" },
        { "label": "0.02", "description": "Radii of the scene's bounding sphere.", "body": "^${1:0.02}" },
    ])
}

/// Some words, and a length in each unit.
pub(super) fn words_and_lengths(words: &[&str]) -> Value {
    let words = words.iter().map(|word| json!({ "label": format!("{word:?}"), "body": word }));
    words.chain(lengths().as_array().cloned().unwrap_or_default()).collect()
}

/// Each preset of a transfer function, a picture, and control points.
pub(super) fn transfers(kind: TransferKind) -> Value {
    let presets = kind
        .presets()
        .iter()
        .map(|preset| json!({ "label": format!("{:?}", preset.name), "description": preset.doc, "body": preset.name }));
    let points = match kind {
        TransferKind::Opacity => json!([["^${1:0}", "^${2:0.05}"], ["^${3:1}", "^${4:0.9}"]]),
        TransferKind::Color => json!([["^${1:-1}", "^${2:1.5}"], ["^${3:0}", "^${4:1}"], ["^${5:1}", "^${6:0.3}"]]),
    };
    let own = [
        json!({ "label": "points", "description": "Values at curvatures, straight between them.", "body": points }),
        json!({ "label": "a picture", "description": "A PNG file beside the style.", "body": "${1:mine}.png" }),
    ];
    presets.chain(own).collect()
}

/// A colour in each way of writing it.
pub(super) fn colors() -> Value {
    json!([
        { "label": "\"#rrggbb\"", "description": "Red, green, blue in hexadecimal.", "body": "#${1:c0392b}" },
        {
            "label": "[r, g, b]",
            "description": "Red, green, blue in 0 to 255.",
            "body": ["^${1:192}", "^${2:57}", "^${3:43}"],
        },
        { "label": "\"teal\"", "description": "A CSS name.", "body": "${1:teal}" },
    ])
}
