//! Styles that extend others.

use restyle::config::{ObjectKind, Source, Style, load, load_file, load_with};

use super::catalog::EARLY;

/// Loads `own` with bases from a table of names and texts.
fn extended(own: &str, bases: &[(&str, &str)]) -> Result<Style, String> {
    let loader = |name: &str, _: &Source| match bases.iter().find(|(of, _)| *of == name) {
        Some((name, text)) => Ok(Source::new(*name, *text)),
        None => Err("there is no such look".to_owned()),
    };
    load_with(&Source::new("own.json", own), &EARLY, &loader).map_err(|mistakes| mistakes.to_string())
}

const BASE: &str = r#"{ "camera": { "fov": 20, "zoom": 2 }, "lights": [{}, {}, {}],
    "mapping": { "atom": "a", "connector": "b", "post_effects": ["dofPost"] },
    "shaders": [{ "name": "a", "shader": "toon", "properties": { "steps": 3, "bias": 0.1 } },
                { "name": "b", "shader": "toon", "properties": { "steps": 5 } }] }"#;

#[test]
fn shaders_merge_property_by_property() {
    let own = r#"{ "extends": "base", "camera": { "fov": 30 }, "lights": [{}],
        "shaders": [{ "name": "a", "properties": { "steps": 7 } }, { "name": "b", "shader": "unlit" },
                    { "name": "c", "shader": "basic" }], "mapping": { "connector": null } }"#;
    let style = extended(own, &[("base", BASE)]).unwrap();
    assert_eq!((style.camera.fov, style.camera.zoom, style.lights.len()), (30.0, 2.0, 1));
    let names: Vec<(&str, &str)> = style.shaders.iter().map(|used| (used.name.as_str(), used.shader)).collect();
    assert_eq!(names, [("a", "toon"), ("b", "unlit"), ("c", "basic"), ("dofPost", "dofPost"), ("basic", "basic")]);
    assert_eq!((style.shaders[0].values.count("steps"), style.shaders[0].values.number("bias")), (7, 0.1));
    assert_eq!(style.shader_of(ObjectKind::Atom, &|_| None), Some(0));
    assert_eq!(style.shader_of(ObjectKind::Connector, &|_| None), None);
}

#[test]
fn a_base_comes_before_what_extends_it() {
    let base = r#"{ "mapping": { "*[chain=A]": "toon", "*[name=B]": "unlit" } }"#;
    let own = r#"{ "extends": "base", "mapping": { "*[chain=A]": "basic" } }"#;
    let style = extended(own, &[("base", base)]).unwrap();
    let index = style.shader_of(ObjectKind::Atom, &|attribute| match attribute {
        restyle::config::Attribute::Chain => Some("A"),
        restyle::config::Attribute::Name => Some("B"),
        _ => None,
    });
    assert_eq!(index.map(|index| style.shaders[index].shader), Some("basic"));
}

#[test]
fn bases_may_have_bases() {
    let middle = r#"{ "extends": "base", "camera": { "zoom": 3 } }"#;
    let style = extended(r#"{ "extends": "middle" }"#, &[("middle", middle), ("base", BASE)]).unwrap();
    assert_eq!((style.camera.fov, style.camera.zoom, style.lights.len()), (20.0, 3.0, 3));
}

#[test]
fn a_mistake_is_said_of_the_file_it_is_in() {
    let base = "{\n \"camera\": { \"fov\": 0 } }";
    let own = "{ \"extends\": \"base\", \"camera\": { \"zoom\": 0 } }";
    assert_eq!(
        extended(own, &[("base", base)]).unwrap_err(),
        "own.json:1:42 (camera.zoom): \"zoom\" is 0, but must lie in 0.01 to 1000\n\
         base:2:21 (camera.fov): \"fov\" is 0, but must lie in 1 to 150 degrees"
    );
}

#[test]
fn paths_are_those_of_the_file() {
    let own = r#"{ "extends": "base", "shaders": [{ "name": "b", "properties": { "steps": 0 } }] }"#;
    assert_eq!(
        extended(own, &[("base", BASE)]).unwrap_err(),
        "own.json:1:74 (shaders[0].properties.steps): \"steps\" is 0, but must lie in 1 to 64 levels"
    );
}

#[test]
fn bases_that_cannot_be_used_say_why() {
    let own = r#"{ "extends": "base" }"#;
    for (base, message) in [
        (
            "{ \"extends\": \"base\" }",
            "base:1:14 (extends): cannot extend \"base\": these styles extend one another in a circle: own.json > base > base",
        ),
        ("{ \"extends\": \"none\" }", "base:1:14 (extends): cannot extend \"none\": there is no such look"),
        ("[]", "base:1:1: \"style\" must be an object, not an empty list"),
        ("{", "base:1:1: the file ends, but the { at 1:1 is not closed"),
        (
            "{ \"version\": 2 }",
            "base:1:14 (version): \"version\" is 2, but must be 1: this program reads no other version of style files",
        ),
    ] {
        assert_eq!(extended(own, &[("base", base)]).unwrap_err(), message);
    }
}

#[test]
fn a_long_chain_is_refused() {
    let count = std::cell::Cell::new(0);
    let loader = |_: &str, _: &Source| {
        count.set(count.get() + 1);
        Ok(Source::new(format!("base{}", count.get()), "{ \"extends\": \"next\" }"))
    };
    let mistakes = load_with(&Source::new("own.json", "{ \"extends\": \"next\" }"), &EARLY, &loader).unwrap_err();
    assert!(mistakes.to_string().ends_with("more than 16 styles extend one another"), "{mistakes}");
}

#[test]
fn files_are_found_beside_the_file_that_names_them() {
    let folder = std::env::temp_dir().join(format!("restyle_extends_{}", std::process::id()));
    std::fs::create_dir_all(folder.join("bases")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("own.json", r#"{ "extends": "bases/one.json" }"#);
    write("bases/one.json", r#"{ "extends": "two.json", "camera": { "zoom": 4 } }"#);
    write("bases/two.json", r#"{ "camera": { "zoom": 2, "fov": 25 } }"#);
    let style = load_file(&folder.join("own.json"), &EARLY);
    write("bases/two.json", r#"{ "extends": "../bases/../own.json" }"#);
    let circle = load_file(&folder.join("own.json"), &EARLY).unwrap_err();
    write("bases/two.json", "{ \"camera\": 1 }");
    let lonely = load(&Source::new("look", "{ \"extends\": \"own.json\" }"), &EARLY).unwrap_err();
    std::fs::remove_dir_all(&folder).unwrap();
    let style = style.unwrap();
    assert_eq!((style.camera.zoom, style.camera.fov), (4.0, 25.0));
    let names: Vec<_> = style.files.iter().filter_map(|path| path.file_name()).collect();
    assert_eq!(names, ["own.json", "one.json", "two.json"]);
    assert!(circle.to_string().contains("in a circle"), "{circle}");
    assert_eq!(circle.files.len(), 3);
    assert!(lonely.to_string().contains("only a style that is a file can extend"));
}

#[test]
fn thousands_of_unknown_or_repeated_keys_merge_in_time() {
    let unknown: String = (0..100_000).map(|i| format!("\"key{i}\": {i}, ")).collect();
    let selectors: String = (0..10_000).map(|i| format!("\"atom[name=N{i}]\": \"toon\", ")).collect();
    let own = format!("{{ \"extends\": \"base\", {unknown} {} }}", "\"mapping\": {}, ".repeat(10_000));
    let base = format!("{{ {unknown} \"mapping\": {{ {selectors} }} }}");
    let start = std::time::Instant::now();
    let message = extended(&own, &[("base", &base)]).unwrap_err();
    assert!(message.ends_with(" more"), "{message}");
    // Merging them one by one takes minutes; this takes a second or two on a busy machine.
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}
