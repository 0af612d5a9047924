//! What designers write in the place of what they mean: keys in another part of a style, and the habits of style sheets.

use restyle::config::{SECTIONS, Source, load};
use serde_json::{Value as Json, json};

use super::catalog::CATALOG;

fn messages(style: &str) -> String {
    load(&Source::new("s.json", style), &CATALOG).map_or_else(|mistakes| mistakes.to_string(), |_| "fine".to_owned())
}

#[test]
fn every_parameter_is_sent_home_from_where_it_means_nothing() {
    let mut homes: Vec<(&str, String)> = Vec::new();
    for section in SECTIONS {
        let place = if section.is_list { "in a light of" } else { "in" };
        homes.extend(section.params.iter().map(|param| (param.name, format!("{place} \"{}\"", section.key))));
    }
    for shader in CATALOG.shaders.iter() {
        for param in shader.params {
            let is_shared = ["base_color", "opacity"].contains(&param.name);
            let of = if is_shared { String::new() } else { format!(" \"{}\"", shader.name) };
            homes.push((param.name, format!("in the \"properties\" of a shader{of}")));
        }
    }
    for (key, home) in homes {
        let said = messages(&json!({ key: Json::Null }).to_string());
        assert!(said.contains(&format!("a style has no \"{key}\": it belongs ")) && said.contains(&home), "{said}");
    }
}

#[test]
fn a_stray_key_is_sent_home() {
    for (style, due) in [
        (r#"{ "camera": { "lights": [] } }"#, "camera has no \"lights\": it belongs at the top of the style"),
        (r#"{ "camera": { "atom": "vdw" } }"#, "camera has no \"atom\": it belongs in \"geometry\", or in \"mapping\""),
        (r#"{ "FOV": 35 }"#, "a style has no \"FOV\": it belongs in \"camera\", as \"fov\""),
        (r#"{ "atom[element=O]": "toon" }"#, "a style has no \"atom[element=O]\": it belongs in \"mapping\""),
        (r#"{ "post_effects": [] }"#, "a style has no \"post_effects\": it belongs in \"mapping\""),
        (r#"{ "mapping": { "fov": 35 } }"#, "mapping has no \"fov\": it belongs in \"camera\""),
        (r#"{ "_comment": "dark" }"#, "a style has no \"_comment\": a comment is written as // and its words"),
        (
            r#"{ "shaders": [{ "name": "a", "shader": "toon", "steps": 3 }] }"#,
            "a shader entry has no \"steps\": it belongs in the \"properties\" of this entry",
        ),
        (
            r#"{ "shaders": [{ "name": "a", "shader": "toon", "metallic": 1 }] }"#,
            "a shader entry has no \"metallic\": it belongs in the \"properties\" of a shader \"basic\"",
        ),
        (
            r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "bgcolor": "red" } }] }"#,
            "shader \"toon\" has no \"bgcolor\": it belongs in \"camera\"",
        ),
    ] {
        let said = messages(style);
        assert!(said.contains(due) && said.lines().count() == 1, "{style}\n{said}");
    }
}

#[test]
fn a_slip_that_is_near_stays_where_it_is() {
    for (style, due) in [
        (r#"{ "camera": { "bgColour": "red" } }"#, "did you mean \"bgcolor\"? allowed: "),
        (r#"{ "mapping": { "postEffects": [] } }"#, "did you mean \"post_effects\"? allowed: "),
        (r#"{ "mapping": { "Atom": "toon" } }"#, "did you mean \"atom\"? allowed: "),
        (r#"{ "name": "My style" }"#, "a style has no \"name\"; allowed: "),
    ] {
        let said = messages(style);
        assert!(said.contains(due) && said.lines().count() == 1, "{style}\n{said}");
    }
}

#[test]
fn habits_of_other_programs_are_met_with_what_to_write() {
    let toon = |key: &str, value: &str| {
        format!(r#"{{ "shaders": [{{ "name": "a", "shader": "toon", "properties": {{ "{key}": {value} }} }}] }}"#)
    };
    for (style, due) in [
        (r#"{ "camera": { "fov": "35" } }"#.to_owned(), "not the text \"35\": write 35"),
        (r#"{ "camera": { "fov": "35deg" } }"#.to_owned(), "not the text \"35deg\": write 35"),
        (r#"{ "camera": { "fov": 35° } }"#.to_owned(), "write 35 instead of 35°"),
        (r#"{ "geometry": { "scale": 0,25 } }"#.to_owned(), "a decimal number has a point: write 0.25"),
        (r#"{ "camera": { "bgcolor": "rgb(255, 0, 0)" } }"#.to_owned(), "did you mean \"#ff0000\"?"),
        (r#"{ "camera": { "bgcolor": "255, 0, 0" } }"#.to_owned(), "did you mean \"#ff0000\"?"),
        (toon("opacity", "\"50%\""), "not the text \"50%\": write 0.5"),
        (toon("hull_size", "\"2px\""), "did you mean \"2pt\"?"),
        (r#"{ "geometry": { "bond_radius": "0.14 angstrom" } }"#.to_owned(), "did you mean \"0.14A\"?"),
        (r#"{ "lights": { "type": "ambient" } }"#.to_owned(), "not an object: write [ before it and ] after it"),
        (r#"{ "mapping": { "atom": false } }"#.to_owned(), "not false: write null"),
        (
            r#"{ "mapping": { "atom": "none" } }"#.to_owned(),
            "not the text \"none\": write null, without quotes, to hide",
        ),
        (r#"{ "mapping": { "atom": { "shader": "toon" } } }"#.to_owned(), "write it as an entry of \"shaders\""),
        (r#"{ "mapping": { "bond": "toon" } }"#.to_owned(), "did you mean \"connector\"?"),
        (r#"{ "mapping": { "element=O": "toon" } }"#.to_owned(), "did you mean \"*[element=O]\"?"),
        (
            r#"{ "shaders": { "a": { "shader": "toon" } }, "mapping": { "*": "a" } }"#.to_owned(),
            "\"shaders\" must be a list, not an object: write [ before it and ] after it",
        ),
        ("{ \"camera\": { \"fov\u{200b}\": 35 } }".to_owned(), "camera has no \"fov\\u{200b}\"; did you mean \"fov\"?"),
    ] {
        let said = messages(&style);
        assert!(said.contains(due) && said.lines().count() == 1, "{style}\n{said}");
    }
}

#[test]
fn a_picture_is_one_mistake() {
    let picture = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0 \0\0\0 ";
    let mistakes = load(&Source::new("s.json", *picture), &CATALOG).map(drop).unwrap_err().to_string();
    assert_eq!(mistakes, "s.json:1:1: this is not UTF-8 text: save the file as UTF-8");
}
