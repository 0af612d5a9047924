//! What a style comes to: every value with where it comes from, as text for people and as JSON for tools.

use std::fmt::Write as _;

use serde_json::{Map, Value as Json, json};

use super::catalog::Role;
use super::error::Place;
use super::hint::{number, quote};
use super::param::{Param, Value};
use super::shaders::ShaderUse;
use super::style::{Overrides, Style};
use super::values::{Origin, Values};

/// Widest column of names or values that is lined up; a longer entry stands out to the right.
const WIDEST: usize = 32;

/// One line of the text: a name, a value, and where it comes from.
type Row = [String; 3];

/// Every value of a style, one a line: `fov  30 degrees  mine.json:4:20, over base.json:2:11`.
pub fn text(style: &Style) -> String {
    let mut shown = String::new();
    let mut section = |title: &str, rows: &[Row]| {
        let _ = writeln!(shown, "{title}");
        write_rows(&mut shown, rows);
    };
    section("camera", &rows_of(&style.values.camera, &style.overrides));
    section("geometry", &rows_of(&style.values.geometry, &style.overrides));
    section("transparency", &rows_of(&style.values.transparency, &style.overrides));
    let origin = match &style.values.lights_place {
        Some(place) => said(place, &style.overrides),
        None => "default".to_owned(),
    };
    if style.values.lights.is_empty() {
        section(&format!("lights: none  {origin}"), &[]);
    }
    for (i, light) in style.values.lights.iter().enumerate() {
        section(&format!("lights[{i}]  {origin}"), &rows_of(light, &style.overrides));
    }
    for used in &style.shaders {
        let what = match used.role {
            Role::Object => "shader",
            Role::PostEffect => "post effect",
        };
        let title = format!("{what} {}: {}  {}", quote(&used.name), used.shader, entry_origin(used, &style.overrides));
        section(&title, &rows_of(&used.values, &style.overrides));
    }
    let mut rules: Vec<Row> = Vec::new();
    for rule in &style.mapping {
        let target = rule.target.map_or("null (hidden)".to_owned(), |index| quote(&style.shaders[index].name));
        rules.push([super::hint::shorten(&rule.selector.to_string()), target, said(&rule.place, &style.overrides)]);
    }
    rules.push(["all else".to_owned(), quote(&style.shaders[style.basic].name), "default".to_owned()]);
    section("mapping, the first line that picks an object decides", &rules);
    let effects = style.listed_effects.iter().map(|effect| {
        let used = &style.shaders[effect.index];
        [quote(&used.name), used.shader.to_owned(), spot(&effect.place)]
    });
    let origin =
        style.values.effects_place.as_ref().map_or("default".to_owned(), |place| said(place, &style.overrides));
    let title = if style.listed_effects.is_empty() { "post effects: none" } else { "post effects" };
    section(&format!("{title}  {origin}"), &effects.collect::<Vec<_>>());
    shown
}

/// Every value of a style as JSON, each as `{"value", "unit", "origin", "over"}`: the origin is a place or `"default"`,
/// and `over` is the place in a base that it replaces.
pub fn json(style: &Style) -> Json {
    let overrides = &style.overrides;
    let shaders = style.shaders.iter().map(|used| {
        json!({
            "name": used.name,
            "role": match used.role { Role::Object => "shader", Role::PostEffect => "post_effect" },
            "shader": used.shader,
            "origin": used.place.as_ref().map_or(json!("default"), place_json),
            "over": used.place.as_ref().and_then(|place| overrides.of(place)).map(place_json),
            "properties": values_json(&used.values, overrides),
        })
    });
    let rules = style.mapping.iter().map(|rule| {
        json!({
            "selector": rule.selector.to_string(),
            "shader": rule.target.map(|index| style.shaders[index].name.as_str()),
            "origin": place_json(&rule.place),
            "over": overrides.of(&rule.place).map(place_json),
        })
    });
    let effects = style.listed_effects.iter().map(|effect| {
        let used = &style.shaders[effect.index];
        json!({ "name": used.name, "effect": used.shader, "origin": place_json(&effect.place) })
    });
    let lights = style.values.lights.iter().map(|light| values_json(light, overrides));
    let list_json = |place: &Option<Place>| {
        let over = place.as_ref().and_then(|place| overrides.of(place)).map(place_json);
        json!({ "origin": place.as_ref().map_or(json!("default"), place_json), "over": over })
    };
    json!({
        "camera": values_json(&style.values.camera, overrides),
        "geometry": values_json(&style.values.geometry, overrides),
        "transparency": values_json(&style.values.transparency, overrides),
        "lights": lights.collect::<Vec<_>>(),
        "lights_list": list_json(&style.values.lights_place),
        "shaders": shaders.collect::<Vec<_>>(),
        "mapping": rules.collect::<Vec<_>>(),
        "all_else": style.shaders[style.basic].name,
        "post_effects": effects.collect::<Vec<_>>(),
        "post_effects_list": list_json(&style.values.effects_place),
    })
}

/// A place as JSON.
fn place_json(place: &Place) -> Json {
    json!({ "file": &*place.file, "line": place.line, "column": place.column })
}

fn values_json(values: &Values, overrides: &Overrides) -> Json {
    let entry = |(param, value, origin): (&Param, &Value, &Origin)| {
        let (origin, over) = match origin {
            Origin::Default => (json!("default"), None),
            Origin::File(place) => (place_json(place), overrides.of(place).map(place_json)),
        };
        let has_unit = !param.unit.is_empty() && !matches!(value, Value::Unset | Value::Length(_));
        let unit = has_unit.then_some(param.unit);
        (
            param.name.to_owned(),
            json!({ "value": value_json(param, value), "unit": unit, "origin": origin, "over": over }),
        )
    };
    Json::Object(values.iter().map(entry).collect::<Map<_, _>>())
}

/// A value as a style file would hold it.
fn value_json(param: &Param, value: &Value) -> Json {
    match value {
        Value::Unset => Json::Null,
        Value::Number(n) => json!(n),
        Value::Count(n) => json!(n),
        Value::Length(super::Length::Radii(n)) => json!(n),
        Value::Length(length) => json!(length.to_string()),
        Value::Boolean(value) => json!(value),
        Value::Numbers(list) => json!(list),
        Value::Vector(vector) => json!(vector),
        Value::Transfer(transfer) => transfer.to_json(),
        Value::Selector(_) | Value::Color(_) | Value::BaseColor(_) | Value::Choice(_) => json!(shown(param, value)),
    }
}

/// A value as people read it, with its unit.
fn shown(param: &Param, value: &Value) -> String {
    let list = |numbers: &[f64]| numbers.iter().map(|n| number(*n)).collect::<Vec<_>>().join(", ");
    let bare = match value {
        Value::Unset => return "unset".to_owned(),
        Value::Number(n) => number(*n),
        Value::Count(n) => n.to_string(),
        Value::Length(super::Length::Radii(n)) => return format!("{} radii", number(*n)),
        Value::Length(length) => return length.to_string(),
        Value::Selector(selector) => selector.to_string(),
        Value::Color(color) => color.to_string(),
        Value::BaseColor(source) => source.to_string(),
        Value::Choice(i) => param.choices()[*i].to_owned(),
        Value::Boolean(value) => value.to_string(),
        Value::Numbers(numbers) => format!("[{}]", list(numbers)),
        Value::Vector(vector) => format!("[{}]", list(vector)),
        Value::Transfer(transfer) => transfer.to_string(),
    };
    if param.unit.is_empty() { bare } else { format!("{bare} {}", param.unit) }
}

fn entry_origin(used: &ShaderUse, overrides: &Overrides) -> String {
    used.place.as_ref().map_or("default".to_owned(), |place| said(place, overrides))
}

fn rows_of(values: &Values, overrides: &Overrides) -> Vec<Row> {
    let row = |(param, value, origin): (&Param, &Value, &Origin)| {
        let origin = match origin {
            Origin::Default => "default".to_owned(),
            Origin::File(place) => said(place, overrides),
        };
        [param.name.to_owned(), shown(param, value), origin]
    };
    values.iter().map(row).collect()
}

/// `mine.json:4:20, over base.json:2:11`.
fn said(place: &Place, overrides: &Overrides) -> String {
    match overrides.of(place) {
        Some(base) => format!("{}, over {}", spot(place), spot(base)),
        None => spot(place),
    }
}

fn spot(place: &Place) -> String {
    format!("{}:{}:{}", place.file, place.line, place.column)
}

fn write_rows(shown: &mut String, rows: &[Row]) {
    let widest = |column: usize| {
        let widths = rows.iter().map(|row| row[column].chars().count()).filter(|width| *width <= WIDEST);
        widths.max().unwrap_or_default()
    };
    let (names, values) = (widest(0), widest(1));
    for [name, value, origin] in rows {
        let _ = writeln!(shown, "  {name:names$}  {value:values$}  {origin}");
    }
}
