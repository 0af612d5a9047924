//! One parameter as a schema. Each is a single schema with several types, not a choice of schemas: an editor then says
//! what is wrong with the value that is there, not that it is no number.

use serde_json::{Map, Number, Value, json};

use super::{patterns, snippets};
use crate::config::color::BaseColor;
use crate::config::param::{Default, Kind, LARGEST, Param};
use crate::config::transfer::{MAX_POINTS, TransferKind};

/// The schemas that parameters share.
pub(super) fn definitions() -> Map<String, Value> {
    let color = |words: &[&str], message: &str| {
        json!({
            "type": ["string", "array"],
            // A hint for editors, which show a swatch; names of colours are fine with it.
            "format": "color",
            "pattern": patterns::color(words),
            "patternErrorMessage": message,
            "items": { "type": "number", "minimum": 0, "maximum": 255 },
            "minItems": 3,
            "maxItems": 4,
            "defaultSnippets": snippets::colors(),
        })
    };
    let no_color = "This is no colour: write [r, g, b] or [r, g, b, a] in 0 to 255, \"#rrggbb\" or a CSS name.";
    let no_source = format!(
        "This is no colour and no source of one: write {}, [r, g, b] in 0 to 255, \"#rrggbb\" or a CSS name.",
        BaseColor::NAMES.map(|name| format!("{name:?}")).join(", ")
    );
    let length = |signed| {
        json!({
            "type": ["string", "number"],
            "pattern": patterns::length(signed),
            "patternErrorMessage": format!("{NO_LENGTH}{}", if signed { "" } else { " It cannot be negative." }),
            "defaultSnippets": snippets::lengths(),
        })
    };
    let mut map = Map::new();
    map.insert("color".to_owned(), color(&[], no_color));
    map.insert("base_color".to_owned(), color(&BaseColor::NAMES, &no_source));
    map.insert("length".to_owned(), length(false));
    map.insert("signed_length".to_owned(), length(true));
    map
}

/// What the editor says of a text that is no length.
const NO_LENGTH: &str =
    "This is no length: write a number (radii of the scene), \"2pt\", \"3r\", \"1.5A\" or \"2mm\", at most 1000000000.";

/// The schema of a parameter.
pub(super) fn param(param: &Param) -> Value {
    let mut schema = Map::new();
    let mut put = |key: &str, value: Value| {
        schema.insert(key.to_owned(), value);
    };
    put("description", param.doc.into());
    put("markdownDescription", format!("{}\n\n{}", param.doc, param.facts()).into());
    put("default", default(param));
    let takes_words = matches!(param.kind, Kind::Choice(_) | Kind::Boolean);
    if !param.examples.is_empty() && !takes_words {
        put("examples", param.examples.iter().map(|text| example(text)).collect());
    }
    let (lowest, highest) = param.range.unwrap_or((-LARGEST, LARGEST));
    let bounds = [("minimum", lowest.max(-LARGEST)), ("maximum", highest.min(LARGEST))];
    let bounds = bounds.map(|(key, bound)| (key, number(bound)));
    let numbers = || json!({ "type": "number", "minimum": bounds[0].1, "maximum": bounds[1].1 });
    let types = |names: &[&str]| -> Value {
        let unset = (param.default == Default::Unset).then_some("null");
        let all: Vec<&str> = names.iter().copied().chain(unset).collect();
        if let [one] = all[..] { one.into() } else { all.into() }
    };
    let shared = |name: &str| json!([{ "$ref": format!("#/definitions/{name}") }]);
    match param.kind {
        Kind::Number | Kind::Count | Kind::Length | Kind::ChoiceOrLength(_) | Kind::Place(_) => {
            for (key, bound) in bounds.clone() {
                put(key, bound);
            }
        }
        _ => {}
    }
    match param.kind {
        Kind::Number => put("type", types(&["number"])),
        Kind::Count => {
            // Not "integer": some validators take that as a way of writing, and refuse 4.0.
            put("type", types(&["number"]));
            put("multipleOf", 1.into());
        }
        Kind::Length if param.default == Default::Unset => {
            put("type", types(&["string", "number"]));
            put("pattern", patterns::length(lowest < 0.0).into());
            put("patternErrorMessage", NO_LENGTH.into());
            put("defaultSnippets", snippets::lengths());
        }
        Kind::Length => {
            put("type", types(&["string", "number"]));
            put("allOf", shared(if lowest < 0.0 { "signed_length" } else { "length" }));
        }
        Kind::ChoiceOrLength(of) => {
            put("type", types(&["string", "number"]));
            put("pattern", patterns::choice_or_length(of, lowest < 0.0).into());
            put("patternErrorMessage", format!("Neither {} nor a length. {NO_LENGTH}", of.join(", ")).into());
            put("defaultSnippets", snippets::words_and_lengths(of));
        }
        Kind::Place(of) => {
            put("type", types(&["string", "number"]));
            put("pattern", patterns::place(of, lowest < 0.0).into());
            let no_place =
                format!("Neither {} nor a length nor a selector such as \"atom[element=O]\".", of.join(", "));
            put("patternErrorMessage", no_place.into());
            put("defaultSnippets", snippets::words_and_lengths(of));
        }
        Kind::Selector => {
            put("type", types(&["string"]));
            put("allOf", shared("selector"));
        }
        Kind::Color if param.default == Default::Unset => {
            put("anyOf", json!([{ "$ref": "#/definitions/color" }, { "type": "null" }]));
        }
        Kind::Color => put("allOf", shared("color")),
        Kind::BaseColor => {
            put("allOf", shared("base_color"));
            let sources = BaseColor::NAMES.map(|name| json!({ "label": format!("{name:?}"), "body": name }));
            put("defaultSnippets", sources.into());
        }
        Kind::Choice(of) => put("enum", json!(of)),
        Kind::Boolean => put("type", types(&["boolean"])),
        Kind::BooleanOrText => {
            put("type", types(&["boolean", "string"]));
            put("pattern", patterns::boolean().into());
            put("patternErrorMessage", "Write true or false.".into());
        }
        Kind::Numbers { len, .. } => {
            let mut list = json!({ "type": "array", "items": numbers() });
            if len > 0 {
                (list["minItems"], list["maxItems"]) = (len.into(), len.into());
            }
            // As published styles have it, which the reader takes too.
            let nested = json!({ "type": "array", "items": list, "minItems": 1, "maxItems": 1 });
            put("anyOf", json!([list, nested]));
        }
        Kind::Vector => {
            put("type", types(&["array"]));
            put("items", numbers());
            put("minItems", 3.into());
            put("maxItems", 3.into());
        }
        Kind::Transfer(kind) => {
            put("type", types(&["string", "array"]));
            put("pattern", patterns::transfer(kind).into());
            let presets = kind.presets().iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ");
            let no_transfer = format!("Neither {presets} nor a picture that ends in .png.");
            put("patternErrorMessage", no_transfer.into());
            put("items", point(kind));
            put("minItems", 1.into());
            put("maxItems", MAX_POINTS.into());
            put("defaultSnippets", snippets::transfers(kind));
        }
    }
    schema.into()
}

/// A control point of a transfer function.
fn point(kind: TransferKind) -> Value {
    let [few, many] = kind.widths();
    let within = |(lowest, highest)| json!({ "type": "number", "minimum": number(lowest), "maximum": number(highest) });
    let mut point = json!({
        "type": "array",
        "items": [within(kind.curvatures())],
        "additionalItems": within(kind.values()),
        "minItems": few,
        "maxItems": many,
    });
    if many > few + 1 {
        point["not"] = json!({ "minItems": few + 1, "maxItems": many - 1 });
        point["errorMessage"] = format!("Write {few} or {many} numbers.").into();
    }
    point
}

/// An example of a table, which [`crate::config::param::check_table`] has tried in a test.
fn example(text: &str) -> Value {
    serde_json::from_str(text).expect("a test tries every example")
}

/// The default as a file would write it.
pub(super) fn default(param: &Param) -> Value {
    match param.default {
        Default::Unset => Value::Null,
        Default::Number(n) | Default::Radii(n) => number(n),
        Default::Count(n) => n.into(),
        Default::Text(text) => text.into(),
        Default::Color(color) => color.to_string().into(),
        Default::BaseColor(color) => color.to_string().into(),
        Default::Boolean(value) => value.into(),
        Default::Numbers(list) => list.iter().copied().map(number).collect(),
        Default::Vector(vector) => vector.into_iter().map(number).collect(),
    }
}

/// A number as people write it: 35, not 35.0.
fn number(n: f64) -> Value {
    if n.fract() == 0.0 && n.abs() <= LARGEST {
        return (n as i64).into();
    }
    Number::from_f64(n).map_or(Value::Null, Value::Number)
}
