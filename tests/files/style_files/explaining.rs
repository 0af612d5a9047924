//! What a style comes to: values and where they come from.

use restyle::config::{Source, Style, explain, load_with};

use super::catalog::CATALOG;

const BASE: &str = r#"{ "camera": { "fov": 20, "zoom": 2 }, "lights": [{}],
  "mapping": { "atom": "a", "connector": "toon" },
  "shaders": [{ "name": "a", "shader": "toon", "properties": { "steps": 3, "bias": 0.1 } }] }"#;

const OWN: &str = r##"{ "extends": "base",
  "camera": { "fov": 30, "bgcolor": "#102030" },
  "geometry": { "atom": "1.5A" },
  "shaders": [{ "name": "a", "properties": { "steps": 7 } }],
  "mapping": { "connector": null, "atom[element=O]": "curvature", "post_effects": ["dofPost"] } }"##;

fn style() -> Style {
    let loader = |_: &str, _: &Source| Ok(Source::new("base", BASE));
    load_with(&Source::new("own", OWN), &CATALOG, &loader).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

#[test]
fn every_value_has_its_origin() {
    let text = explain::text(&style());
    for line in [
        "  fov           30 degrees  own:2:22, over base:1:22",
        "  zoom          2           base:1:34",
        "  bgcolor       #102030     own:2:37",
        "  exposure      0 stops     default",
        "  atom         1.5A   own:3:25",
        "lights[0]  base:1:49",
        "  position   [1, 2, 3] radii  default",
        "shader \"a\": toon  own:4:15, over base:3:15",
        "  steps           7 levels  own:4:55, over base:3:73",
        "  bias            0.1       base:3:84",
        "  shadow_color    unset     default",
        "mapping, the first line that picks an object decides",
        "  atom[element=O]  \"curvature\"    own:5:35",
        "  connector        null (hidden)  own:5:16, over base:2:29",
        "  atom             \"a\"            base:2:16",
        "  all else         \"basic\"        default",
        "shader \"curvature\": curvature  default",
        "post effects  own:5:83",
        "  \"dofPost\"  dofPost  own:5:84",
    ] {
        assert!(text.lines().any(|shown| shown == line), "{line:?} is not in\n{text}");
    }
    // In the order in which they are asked.
    let at = |line: &str| text.find(line).unwrap();
    assert!(at("  atom[element=O]") < at("  connector  ") && at("  connector  ") < at("  atom             "));
}

#[test]
fn json_holds_the_same() {
    let json = explain::json(&style());
    let place =
        |file: &str, line: u32, column: u32| serde_json::json!({ "file": file, "line": line, "column": column });
    let fov = serde_json::json!({ "value": 30.0, "unit": "degrees", "origin": place("own", 2, 22), "over": place("base", 1, 22) });
    assert_eq!(json["camera"]["fov"], fov);
    let exposure = serde_json::json!({ "value": 0.0, "unit": "stops", "origin": "default", "over": null });
    assert_eq!(json["camera"]["exposure"], exposure);
    assert_eq!(json["geometry"]["atom"]["value"], "1.5A");
    assert_eq!(json["lights"].as_array().unwrap().len(), 1);
    assert_eq!(json["lights_list"], serde_json::json!({ "origin": place("base", 1, 49), "over": null }));
    let a = &json["shaders"][0];
    assert_eq!(
        (&a["name"], &a["shader"], &a["properties"]["steps"]["value"]),
        (&"a".into(), &"toon".into(), &7.into())
    );
    assert_eq!(a["over"], place("base", 3, 15));
    let mapping: Vec<(&str, Option<&str>)> = json["mapping"]
        .as_array()
        .unwrap()
        .iter()
        .map(|rule| (rule["selector"].as_str().unwrap(), rule["shader"].as_str()))
        .collect();
    assert_eq!(mapping, [("atom[element=O]", Some("curvature")), ("connector", None), ("atom", Some("a"))]);
    assert_eq!(json["all_else"], "basic");
    assert_eq!(json["post_effects"][0]["effect"], "dofPost");
}

#[test]
fn an_override_of_an_override_names_the_nearest_base() {
    let loader = |name: &str, _: &Source| match name {
        "middle" => Ok(Source::new("middle", r#"{ "extends": "base", "camera": { "fov": 25 }, "lights": [] }"#)),
        _ => Ok(Source::new("base", BASE)),
    };
    let own = r#"{ "extends": "middle", "camera": { "fov": 26 } }"#;
    let style = load_with(&Source::new("own", own), &CATALOG, &loader).unwrap();
    let text = explain::text(&style);
    assert!(text.contains("own:1:43, over middle:1:41\n"), "{text}");
    assert!(text.contains("lights: none  middle:1:57, over base:1:49\n"), "{text}");
}

#[test]
fn a_style_without_lights_explains_the_default_ones() {
    let style = load_with(&Source::new("own", "{}"), &CATALOG, &|_: &str, _: &Source| Err(String::new())).unwrap();
    let text = explain::text(&style);
    assert!(text.contains("lights[1]  default\n  type       ambient          default\n"), "{text}");
    assert!(text.contains("  intensity  0.3              default\n"), "{text}");
}
