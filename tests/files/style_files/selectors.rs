//! Selectors as values of parameters: what is read, refused and warned of, with the exact words.

use restyle::config::{Catalog, Length, Notice, Source, Style, Value, load, load_with};
use restyle::engine::{DRAWN_KINDS, catalog, lint};
use restyle::scene::Scene;

/// A style of one post effect as the program itself loads it, or what is wrong with it.
fn style(effect: &str, property: &str) -> Result<Style, String> {
    let entries = catalog();
    let catalog = Catalog { shaders: &entries, kinds: DRAWN_KINDS };
    let text = format!(
        "{{ \"mapping\": {{ \"post_effects\": [\"e\"] }}, \"shaders\": [\n{{ \"name\": \"e\", \"shader\": \"{effect}\",\n\"properties\": {{ {property} }} }}] }}"
    );
    load(&Source::new("s.json", text), &catalog).map_err(|mistakes| mistakes.to_string())
}

fn value(effect: &str, name: &str, written: &str) -> Result<Value, String> {
    let style = style(effect, &format!("\"{name}\": {written}"))?;
    Ok(style.shaders[style.listed_effects[0].index].values.get(name).expect("it has one").clone())
}

const KINDS: &str = "atom, connector, ribbon, surface, mesh, *";

#[test]
fn bad_selectors_are_told_as_those_of_mapping_are() {
    let expected = "\"applies_to\" must be a selector such as \"atom[element=O]\", not";
    for (written, message) in [
        ("3", format!("{expected} the number 3")),
        ("true", format!("{expected} true")),
        ("[\"atom\", \"mesh\"]", format!("{expected} a list of 2 values")),
        ("{ \"atom\": 1 }", format!("{expected} an object")),
        ("\"\"", format!("selector \"\": there is no type \"\"; allowed: {KINDS}")),
        ("\" \"", format!("selector \" \": there is no type \"\"; allowed: {KINDS}")),
        ("\"atm\"", format!("selector \"atm\": there is no type \"atm\"; did you mean \"atom\"? allowed: {KINDS}")),
        (
            "\"bonds\"",
            format!("selector \"bonds\": there is no type \"bonds\"; did you mean \"connector\"? allowed: {KINDS}"),
        ),
        ("\"atom[element=O\"", "selector \"atom[element=O\": ] is missing".to_owned()),
        (
            "\"mesh[prt=a]\"",
            "selector \"mesh[prt=a]\": \"mesh\" has no attribute \"prt\"; did you mean \"part\"? allowed: part, material, node, file"
                .to_owned(),
        ),
        ("\"atom[number=40..10]\"", "a range has its smaller end first: 10..40, not 40..10".to_owned()),
    ] {
        let told = format!("s.json:3:31 (shaders[0].properties.applies_to): {message}");
        assert_eq!(value("ssaoPost", "applies_to", written), Err(told), "{written}");
    }
    let words = format!("{KINDS}, layers, center, a length");
    for (written, message) in [
        (
            "\"centre\"",
            format!("selector \"centre\": there is no type \"centre\"; did you mean \"center\"? allowed: {words}"),
        ),
        ("\"\"", format!("selector \"\": there is no type \"\"; allowed: {words}")),
        ("\"atom[element=O\"", "selector \"atom[element=O\": ] is missing".to_owned()),
        (
            "\"2px\"",
            "\"focus\" is \"2px\", which is no length: write a number (radii of the scene), \"2pt\", \"3r\", \"1.5A\" or \"2mm\"; did you mean \"2pt\"?"
                .to_owned(),
        ),
        ("\"-2A\"", "\"focus\" is -2, but must be 0 or more".to_owned()),
        (
            "[1]",
            "\"focus\" must be \"layers\", \"center\", a length such as \"2A\", or a selector such as \"atom[element=O]\", not a list of 1 value"
                .to_owned(),
        ),
    ] {
        let told = format!("s.json:3:26 (shaders[0].properties.focus): {message}");
        assert_eq!(value("dofPost", "focus", written), Err(told), "{written}");
    }
}

#[test]
fn words_lengths_and_selectors_are_told_apart() {
    let focus = |written: &str| value("dofPost", "focus", written).unwrap_or_else(|wrong| panic!("{wrong}"));
    assert_eq!(focus("\"layers\""), Value::Choice(0));
    assert_eq!(focus("\"center\""), Value::Choice(1));
    assert_eq!(focus("0.5"), Value::Length(Length::Radii(0.5)));
    for (written, length) in [("\"2A\"", 2.0), ("\".5A\"", 0.5), ("\" +3 A \"", 3.0)] {
        assert_eq!(focus(written), Value::Length(Length::Angstrom(length)), "{written}");
    }
    for written in ["*", "atom", "mesh[part=Bolt*]", " atom [ residue = 2MM ] "] {
        let Value::Selector(selector) = focus(&format!("{written:?}")) else { panic!("{written}") };
        assert_eq!(selector.to_string(), written);
    }
    assert_eq!(value("ssaoPost", "applies_to", "null"), Ok(Value::Unset));
    assert!(matches!(value("ssaoPost", "applies_to", "\"*\""), Ok(Value::Selector(_))));
    assert!(matches!(value("dofPost", "focus", "null"), Err(wrong) if wrong.contains("\"focus\" must be ")));
}

#[test]
fn a_type_that_is_not_drawn_is_told_at_the_value() {
    let told = |effect, property| -> Vec<String> {
        let style = style(effect, property).unwrap_or_else(|wrong| panic!("{wrong}"));
        let of_type = style.warnings.iter().filter(|warning| matches!(warning.notice, Notice::TypeNotDrawn { .. }));
        of_type.map(ToString::to_string).collect()
    };
    let warning = "warning: objects of type \"ribbon\" are not drawn by this version yet";
    assert_eq!(
        told("ssaoPost", "\"applies_to\": \"ribbon[chain=A]\""),
        [format!("s.json:3:31 (shaders[0].properties.applies_to): {warning}")]
    );
    assert_eq!(
        told("dofPost", "\"focus\": \"ribbon\""),
        [format!("s.json:3:26 (shaders[0].properties.focus): {warning}")]
    );
    assert_eq!(told("ssaoPost", "\"applies_to\": \"mesh\""), Vec::<String>::new());
}

#[test]
fn a_selector_that_matches_nothing_is_told_the_names_that_there_are() {
    let scene = Scene::from_bytes("a.xyz", b"3\n\nO 0 0 0\nH 0.96 0 0\nHe 0 9 0\n").expect("atoms");
    let told = |effect, property: &str| -> Vec<String> {
        let style = style(effect, property).unwrap_or_else(|wrong| panic!("{wrong}"));
        lint::lint_with(&style, &scene).iter().map(ToString::to_string).collect()
    };
    let message = |selector: &str, hint: &str| {
        let place = "s.json:3:31 (shaders[0].properties.applies_to)";
        [format!("{place}: warning: selector \"{selector}\" matches nothing in this scene{hint}")]
    };
    for (selector, hint) in [
        ("atom[element=N]", "; the scene has: H, He, O"),
        ("*[file=b.xyz]", "; did you mean \"a.xyz\"? the scene has: a.xyz"),
        ("connector[element=He]", "; did you mean \"H\"? the scene has: H, O"),
    ] {
        assert_eq!(told("ssaoPost", &format!("\"applies_to\": \"{selector}\"")), message(selector, hint));
    }
    for selector in ["atom[element=he]", "connector[element=O]", "*", "mesh[part=door]", "ribbon"] {
        assert_eq!(told("ssaoPost", &format!("\"applies_to\": \"{selector}\"")), Vec::<String>::new(), "{selector}");
    }
    assert_eq!(
        told("dofPost", "\"focus\": \"atom[element=N]\""),
        [
            "s.json:3:26 (shaders[0].properties.focus): warning: selector \"atom[element=N]\" matches nothing in this scene; the scene has: H, He, O"
        ]
    );
}

#[test]
fn only_effects_that_are_listed_are_held_against_the_scene() {
    let entries = catalog();
    let catalog = Catalog { shaders: &entries, kinds: DRAWN_KINDS };
    let scene = Scene::from_bytes("a.xyz", b"1\n\nO 0 0 0\n").expect("an atom");
    let told = |listed: &str| {
        let text = format!(
            r#"{{ "mapping": {{ "atom[element=Q]": "basic", "post_effects": [{listed}] }}, "shaders": [
                {{ "name": "e", "shader": "ssaoPost", "properties": {{ "applies_to": "atom[element=N]" }} }}] }}"#
        );
        let style = load(&Source::new("s.json", text), &catalog).unwrap_or_else(|wrong| panic!("{wrong}"));
        let warnings = lint::lint_with(&style, &scene);
        warnings.iter().map(|warning| warning.place.line).collect::<Vec<_>>()
    };
    assert_eq!(told(""), [1]);
    // In the order of the text, and once however often it is listed.
    assert_eq!(told("\"e\""), [1, 2]);
    assert_eq!(told("\"e\", \"e\""), [1, 2]);
}

#[test]
fn null_takes_the_selector_of_a_base_back() {
    let entries = catalog();
    let catalog = Catalog { shaders: &entries, kinds: DRAWN_KINDS };
    let base = r#"{ "mapping": { "post_effects": ["e"] }, "shaders": [
        { "name": "e", "shader": "ssaoPost", "properties": { "applies_to": "atom" } }] }"#;
    let loader = |_: &str, _: &Source| Ok(Source::new("base.json", base));
    let applies_to = |properties: &str| {
        let own = format!(
            r#"{{ "extends": "base.json", "shaders": [{{ "name": "e", "properties": {{ {properties} }} }}] }}"#
        );
        let style = load_with(&Source::new("s.json", own), &catalog, &loader).unwrap_or_else(|wrong| panic!("{wrong}"));
        let values = &style.shaders[style.post_effects[0]].values;
        values.optional_selector("applies_to").map(ToString::to_string)
    };
    assert_eq!(applies_to(""), Some("atom".to_owned()));
    assert_eq!(applies_to("\"applies_to\": null"), None);
    assert_eq!(applies_to("\"applies_to\": \"mesh\""), Some("mesh".to_owned()));
}
