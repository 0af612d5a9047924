//! Warnings, each with the exact text that the author of the style reads.

use restyle::config::{Catalog, Notice, Source, Style, Warning, load, load_with};
use restyle::engine::{DRAWN_KINDS, catalog, lint};
use restyle::scene::Scene;

use super::catalog::CATALOG;

fn told(warnings: &[Warning]) -> Vec<String> {
    warnings.iter().map(ToString::to_string).collect()
}

fn warnings(style: &str) -> Vec<String> {
    told(&load(&Source::new("s.json", style), &CATALOG).unwrap_or_else(|mistakes| panic!("{mistakes}")).warnings)
}

/// A style as the program itself loads it.
fn drawn(style: &str) -> Style {
    let entries = catalog();
    let catalog = Catalog { shaders: &entries, kinds: DRAWN_KINDS };
    load(&Source::new("s.json", style), &catalog).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn scene(xyz: &str) -> Scene {
    Scene::from_bytes("a.xyz", xyz.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_colour_in_shares_of_one_is_nearly_black() {
    let meant = r#"s.json:1:26 (camera.bgcolor): warning: "bgcolor" is nearly black: numbers of a colour go to 255; write [255, 128, 51] if shares of 1 were meant"#;
    assert_eq!(warnings(r#"{ "camera": { "bgcolor": [1.0, 0.5, 0.2] } }"#), [meant]);
    for color in ["[0, 0, 0]", "[1, 1, 1]", "[0, 1, 2.5]", "[0.5, 128, 0]", "\"#010101\""] {
        assert_eq!(warnings(&format!("{{ \"camera\": {{ \"bgcolor\": {color} }} }}")), Vec::<String>::new(), "{color}");
    }
}

#[test]
fn what_nothing_names_is_unused() {
    let text = r#"{ "shaders": [{ "name": "a", "shader": "toon" }, { "name": "b", "shader": "toon" },
        { "name": "ao", "shader": "ssaoPost" }, { "name": "basic", "shader": "toon" }], "mapping": { "atom": "b" } }"#;
    assert_eq!(
        warnings(text),
        [
            r#"s.json:1:25 (shaders[0].name): warning: shader "a" draws nothing: name it in mapping, or remove it"#,
            r#"s.json:2:19 (shaders[2].name): warning: post effect "ao" does nothing: list it in mapping.post_effects, or remove it"#,
        ]
    );
}

#[test]
fn a_base_may_hold_more_than_a_style_takes() {
    let base = r#"{ "shaders": [{ "name": "a", "shader": "toon" }, { "name": "b", "shader": "toon" }] }"#;
    let loader = |_: &str, _: &Source| Ok(Source::new("base.json", base));
    let own = r#"{ "extends": "base.json", "shaders": [{ "name": "b", "properties": { "steps": 2 } }] }"#;
    let style = load_with(&Source::new("s.json", own), &CATALOG, &loader).unwrap();
    assert_eq!(
        told(&style.warnings),
        [r#"s.json:1:49 (shaders[0].name): warning: shader "b" draws nothing: name it in mapping, or remove it"#]
    );
}

#[test]
fn a_selector_that_a_later_one_always_beats_is_told() {
    let text = r#"{ "mapping": { "atom[element=O]": "toon", "atom[name=CA][chain=A]": "toon", "atom": "toon",
        "atom[chain=A][name=CA]": "unlit", "atom[element=o]": "basic", "atom[name=ca][chain=A]": null } }"#;
    assert_eq!(
        warnings(text),
        [
            r#"s.json:1:16 (mapping["atom[element=O]"]): warning: selector "atom[element=O]" never decides: "atom[element=o]" at 2:44 picks the same objects and comes later; remove one"#,
            r#"s.json:1:43 (mapping["atom[name=CA][chain=A]"]): warning: selector "atom[name=CA][chain=A]" never decides: "atom[chain=A][name=CA]" at 2:9 picks the same objects and comes later; remove one"#,
        ]
    );
    // To write a selector of the base in another way is to change the base.
    let loader = |_: &str, _: &Source| Ok(Source::new("base.json", r#"{ "mapping": { "atom[element=O]": "toon" } }"#));
    let own = r#"{ "extends": "base.json", "mapping": { "atom[element=o]": "unlit" } }"#;
    let style = load_with(&Source::new("s.json", own), &CATALOG, &loader).unwrap();
    assert_eq!(told(&style.warnings), Vec::<String>::new());
}

#[test]
fn effects_out_of_order_are_told() {
    let order =
        |effects: &str| told(&lint::lint(&drawn(&format!(r#"{{ "mapping": {{ "post_effects": [{effects}] }} }}"#))));
    assert_eq!(
        order(r#""dofPost", "outlinePost", "ssaoPost""#),
        [
            r#"s.json:1:44 (mapping.post_effects[1]): warning: post effect "outlinePost" is listed after "dofPost", but always comes before it: list it first, as order counts within a stage only"#,
            r#"s.json:1:59 (mapping.post_effects[2]): warning: post effect "ssaoPost" is listed after "dofPost", but always comes before it: list it first, as order counts within a stage only"#,
        ]
    );
    assert_eq!(order(r#""ssaoPost", "ssaoPost", "outlinePost", "dofPost""#), Vec::<String>::new());
}

#[test]
fn an_outline_wider_than_what_it_surrounds_is_told() {
    let toon = |geometry: &str, hull_size: &str| {
        drawn(&format!(
            r#"{{ "geometry": {{ {geometry} }}, "mapping": {{ "atom": "a", "connector": "basic" }},
            "shaders": [{{ "name": "a", "shader": "toon", "properties": {{ "hull_size": {hull_size} }} }}] }}"#
        ))
    };
    let water = scene("3\n\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n");
    let in_scene = |geometry, hull_size| told(&lint::lint_with(&toon(geometry, hull_size), &water));
    let alone = |geometry, hull_size| told(&lint::lint(&toon(geometry, hull_size)));
    let none = Vec::<String>::new();

    // A quarter of hydrogen's 1.1 A [Mantina2009].
    let place = "s.json:2:87 (shaders[0].properties.hull_size): warning: ";
    assert_eq!(
        in_scene("", "\"0.3A\""),
        [format!(
            "{place}the outline is 0.3 A wide, but the smallest atom inside has a radius of 0.275 A: make it narrower, or give it in points, such as \"2pt\""
        )]
    );
    assert_eq!(in_scene("", "\"0.27A\""), none);
    assert_eq!(in_scene("\"scale\": 0.5", "\"0.3A\""), none);
    assert_eq!(in_scene("", "\"400pt\""), none, "lines in points thin out");
    assert_eq!(in_scene("", "\"0.9r\""), none);
    assert_eq!(in_scene("", "0.45").len(), 1);

    // Without a scene, only what is so in all of them.
    assert_eq!(alone("", "0.45"), none);
    assert_eq!(alone("\"atom\": \"1A\"", "\"0.2A\""), none);
    assert_eq!(
        alone("\"atom\": \"1A\"", "\"0.3A\""),
        [format!(
            "{place}the outline is 0.3 A wide, but every atom has a radius of 0.25 A: make it narrower, or give it in points, such as \"2pt\""
        )]
    );
    assert_eq!(alone("\"atom\": \"1A\"", "\"1.5r\"").len(), 1);
    assert_eq!(alone("\"atom\": 0.1", "0.03").len(), 1);
}

#[test]
fn an_outline_of_connectors_is_held_against_their_radius() {
    let style = drawn(
        r#"{ "mapping": { "connector": "a" },
        "shaders": [{ "name": "a", "shader": "toon", "properties": { "hull_size": "0.2A" } }] }"#,
    );
    let expected = [
        "s.json:2:83 (shaders[0].properties.hull_size): warning: the outline is 0.2 A wide, but a connector inside has a radius of 0.14 A: make it narrower, or give it in points, such as \"2pt\"",
    ];
    assert_eq!(told(&lint::lint(&style)), expected);
    let methane = scene("2\n\nC 0 0 0\nH 1.09 0 0\n");
    assert_eq!(told(&lint::lint_with(&style, &methane)), expected);
    // Where it draws nothing, it is nobody's outline.
    let helium = scene("1\n\nHe 0 0 0\n");
    let nothing = "s.json:1:16 (mapping.connector): warning: selector \"connector\" matches nothing in this scene";
    assert_eq!(told(&lint::lint_with(&style, &helium)), [nothing]);
}

#[test]
fn warnings_beyond_a_hundred_are_counted() {
    let entry = |i: usize| format!(r#"{{ "name": "n{i}", "shader": "toon" }}"#);
    let entries: Vec<String> = (0..20_000).map(entry).collect();
    let text = format!(r#"{{ "shaders": [{}] }}"#, entries.join(", "));
    let style = load(&Source::new("s.json", text), &CATALOG).unwrap();
    assert_eq!((style.warnings.len(), style.unlisted_warnings), (100, 19_900));
}

#[test]
fn warnings_stand_beside_mistakes() {
    let text = r#"{ "camera": { "fov": 0 }, "mapping": { "ribbon": "toon" },
        "shaders": [{ "name": "a", "shader": "toon" }] }"#;
    let mistakes = load(&Source::new("s.json", text), &CATALOG).unwrap_err();
    assert_eq!(mistakes.list.len(), 1);
    // What is unused is not told yet: a rule that could not be read may name it.
    let notices: Vec<&Notice> = mistakes.warnings.iter().map(|warning| &warning.notice).collect();
    assert!(matches!(notices[..], [Notice::TypeNotDrawn { .. }]), "{notices:?}");
}
