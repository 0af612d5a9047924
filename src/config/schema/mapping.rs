//! The schema of `mapping`: selectors as keys, names of shaders as values.

use serde_json::{Map, Value, json};

use super::{NOT_DRAWN, patterns};
use crate::config::catalog::{Catalog, Role};
use crate::config::selector::{Attribute, ObjectKind, Selector};

/// Selectors that the editor offers, beside one for each type that is drawn.
const OFFERED: [(&str, &str); 16] = [
    ("*", "Everything."),
    ("atom[element=C]", "Atoms of one element."),
    ("atom[element=H]", "Atoms of one element."),
    ("atom[element=N]", "Atoms of one element."),
    ("atom[element=O]", "Atoms of one element."),
    ("atom[residue=HOH]", "Atoms of one residue: water."),
    ("atom[kind=protein]", "Atoms of amino acids."),
    ("atom[kind=water]", "Atoms of water."),
    ("atom[kind=ligand]", "Atoms of ligands."),
    ("atom[number=10..40]", "Atoms of residues 10 to 40."),
    ("atom[b_factor=50..]", "Atoms of high temperature factors."),
    ("atom[name=CA]", "Atoms of one name: the backbone's carbon."),
    ("*[chain=A]", "Everything of one chain."),
    ("connector[element=H]", "Bonds that end at an atom of this element."),
    ("mesh[part=Bolt*]", "Parts of a mesh whose names begin alike."),
    ("mesh[material=Steel]", "Parts of a mesh that are of one material."),
];

/// What the editor says of a text that is no selector.
fn no_selector(catalog: &Catalog<'_>) -> String {
    let kinds: Vec<&str> = catalog.kinds.iter().map(|kind| kind.name()).collect();
    let attributes: Vec<&str> = catalog.attributes().map(Attribute::name).collect();
    format!(
        "This is no selector: write a type ({} or *), then any number of [attribute=value], such as atom[element=O]. \
         Attributes: {}.",
        kinds.join(", "),
        attributes.join(", ")
    )
}

/// What the editor says of a rule; of one that is offered, it says which objects it picks.
const TARGET: &str = "The name of an entry of shaders, or of a shader with its defaults; null hides.";

/// The schema of the object `mapping`.
pub(super) fn mapping(catalog: &Catalog<'_>) -> Value {
    let target = || json!([{ "$ref": "#/definitions/target" }]);
    let rule = |doc: &str| json!({ "description": doc, "type": ["string", "null"], "allOf": target() });
    let mut properties: Map<String, Value> =
        offered(catalog).map(|(selector, doc)| (selector.to_owned(), rule(doc))).collect();
    properties.insert("post_effects".to_owned(), post_effects(catalog));
    let [drawn, not_drawn] = kinds(catalog);
    let mut patterns = Map::new();
    patterns.insert(patterns::selector(&drawn), rule(TARGET));
    if !not_drawn.is_empty() {
        let rule = json!({ "description": TARGET, "deprecationMessage": type_not_drawn(), "allOf": target() });
        patterns.insert(patterns::selector(&not_drawn), rule);
    }
    json!({
        "type": "object",
        "description": "Which shader draws what. More attributes win, then a type over *, then the later rule. What no \
                        rule selects is drawn with basic; null hides.",
        // Alone, so that its words are said of keys and not of a mapping that is no object.
        "allOf": [{
            "properties": properties,
            "patternProperties": patterns,
            "additionalProperties": false,
            "errorMessage": no_selector(catalog),
        }],
    })
}

/// Each selector that the editor offers, and what it picks.
fn offered(catalog: &Catalog<'_>) -> impl Iterator<Item = (&'static str, &'static str)> {
    let is_drawn = |selector: &str| {
        let kind = Selector::parse(selector).ok().and_then(|selector| selector.kind());
        kind.is_none_or(|kind| catalog.kinds.contains(&kind))
    };
    let kinds = catalog.kinds.iter().map(|kind| (kind.name(), kind.doc()));
    kinds.chain(OFFERED.into_iter().filter(move |(selector, _)| is_drawn(selector)))
}

/// Types that are drawn, with `None` for `*`, and types that are not.
fn kinds(catalog: &Catalog<'_>) -> [Vec<Option<ObjectKind>>; 2] {
    let (mut drawn, not_drawn): (Vec<_>, Vec<_>) =
        ObjectKind::ALL.into_iter().map(Some).partition(|kind| kind.is_some_and(|kind| catalog.kinds.contains(&kind)));
    drawn.push(None);
    [drawn, not_drawn]
}

fn type_not_drawn() -> String {
    format!("objects of this type are {NOT_DRAWN}")
}

/// A selector as the value of a parameter.
pub(super) fn selector(catalog: &Catalog<'_>) -> Value {
    let [drawn, not_drawn] = kinds(catalog);
    let offered = offered(catalog)
        .map(|(selector, doc)| json!({ "label": format!("{selector:?}"), "description": doc, "body": selector }));
    let mut schema = json!({
        "pattern": patterns::selector(&[&drawn[..], &not_drawn].concat()),
        "patternErrorMessage": no_selector(catalog),
        "defaultSnippets": offered.collect::<Vec<_>>(),
    });
    if !not_drawn.is_empty() {
        schema["if"] = json!({ "type": "string", "pattern": patterns::selector(&not_drawn) });
        schema["then"] = json!({ "deprecationMessage": type_not_drawn() });
    }
    schema
}

/// What draws: a name of `shaders`, of a base, or of a registered shader.
pub(super) fn target(catalog: &Catalog<'_>) -> Value {
    named(catalog, Role::Object, &["string", "null"])
}

fn post_effects(catalog: &Catalog<'_>) -> Value {
    let mut schema = json!({
        "type": "array",
        "description": "Post effects, in the order in which they change the picture.",
        "items": named(catalog, Role::PostEffect, &["string"]),
    });
    if catalog.names(Some(Role::PostEffect)).next().is_none() {
        schema["doNotSuggest"] = true.into();
    }
    schema
}

/// A name of one role. Any text may be one: what the file calls its shaders, no schema can know.
fn named(catalog: &Catalog<'_>, role: Role, types: &[&str]) -> Value {
    let of_role = || catalog.shaders.iter().filter(|entry| entry.role == role);
    let names: Vec<&str> = of_role().map(|entry| entry.name).collect();
    let docs: Vec<&str> = of_role().map(|entry| entry.doc).collect();
    let known = json!({ "enum": names, "enumDescriptions": docs });
    let mut alternatives = vec![json!({})];
    if !names.is_empty() {
        alternatives.insert(0, known);
    }
    json!({
        "type": types,
        "anyOf": alternatives,
    })
}
