//! What styles mean once they are loaded.

use std::path::Path;

use restyle::config::{
    AtomRadius, Attribute, BaseColor, Camera, Catalog, Length, LightKind, ObjectKind, Orient, Origin, Role, Shadow,
    Source, Space, Srgba, Style, TransparencyMethod, Value, load, load_file,
};

use super::catalog::CATALOG;

fn style_of(text: &str, catalog: &Catalog<'_>) -> Style {
    load(&Source::new("s.json", text), catalog).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn fixture(name: &str, catalog: &Catalog<'_>) -> Style {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/prost2016").join(name);
    load_file(&path, catalog).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn warnings(style: &Style) -> Vec<String> {
    style.warnings.iter().map(ToString::to_string).collect()
}

fn drawn_with<'a>(style: &'a Style, kind: ObjectKind, of: &[(Attribute, &str)]) -> Option<&'a str> {
    let find = |wanted| of.iter().find(|(attribute, _)| *attribute == wanted).map(|(_, value)| *value);
    style.shader_of(kind, &find).map(|index| style.shaders[index].name.as_str())
}

#[test]
fn every_fixture_loads() {
    for name in ["listing1.json", "advertisement.json", "education.json", "scientific.json", "future.json"] {
        fixture(name, &CATALOG);
        assert_eq!(warnings(&fixture(name, &CATALOG)), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn the_advertisement_has_its_effects_in_order() {
    let style = fixture("advertisement.json", &CATALOG);
    let effects: Vec<&str> = style.post_effects.iter().map(|index| style.shaders[*index].shader).collect();
    assert_eq!(effects, ["dofPost", "ssaoPost"]);
    assert_eq!(style.shaders[style.post_effects[0]].values.numbers("layers"), [0.0, 0.0, 0.7, 0.9]);
    let advert = &style.shaders[style.shader_of(ObjectKind::Atom, &|_| None).unwrap()];
    assert_eq!((advert.shader, advert.values.number("smoothness")), ("basic", 0.15));
}

#[test]
fn education_keeps_the_numbers_of_the_print() {
    let style = fixture("education.json", &CATALOG);
    let toon = &style.shaders[style.shader_of(ObjectKind::Connector, &|_| None).unwrap()].values;
    assert_eq!(toon.length("hull_size"), Length::Radii(0.45));
    assert_eq!((toon.number("bias"), toon.count("steps"), toon.choice("levels")), (0.65, 4, "floor"));
    assert_eq!(toon.color("color"), Srgba::from_bytes([0, 0, 0]));
    assert!(toon.is_set("steps") && !toon.is_set("levels"));
    let Some(Origin::File(place)) = toon.origin("steps") else { panic!("steps is in the file") };
    assert_eq!((place.line, place.path.as_str()), (18, "shaders[0].properties.steps"));
}

#[test]
fn orthographic_may_be_a_text() {
    assert!(fixture("scientific.json", &CATALOG).camera.orthographic);
    assert!(!style_of(r#"{ "camera": { "orthographic": "false" } }"#, &CATALOG).camera.orthographic);
}

#[test]
fn future_shades_atoms_and_connectors_apart() {
    let style = fixture("future.json", &CATALOG);
    assert_eq!(drawn_with(&style, ObjectKind::Atom, &[]), Some("future"));
    assert_eq!(drawn_with(&style, ObjectKind::Connector, &[]), Some("dark"));
}

#[test]
fn an_empty_style_has_the_defaults() {
    let style = style_of("{}", &CATALOG);
    assert_eq!(style.camera.bgcolor, Srgba::from_bytes([255; 3]));
    assert_eq!((style.camera.fov, style.camera.orient, style.camera.position), (35.0, Orient::Default, None));
    assert_eq!((style.geometry.atom, style.geometry.scale), (AtomRadius::Vdw, 0.25));
    assert_eq!(style.geometry.bond_radius, Length::Angstrom(0.14));
    assert_eq!((style.transparency.method, style.transparency.memory_mb), (TransparencyMethod::Auto, 512));
    let kinds: Vec<LightKind> = style.lights.iter().map(|light| light.kind).collect();
    assert_eq!(kinds, [LightKind::Directional, LightKind::Ambient]);
    assert_eq!(drawn_with(&style, ObjectKind::Mesh, &[]), Some("basic"));
    assert_eq!((style.shaders.len(), style.basic, style.post_effects.len()), (1, 0, 0));
}

#[test]
fn comments_trailing_commas_marks_and_line_ends_are_fine() {
    let plain = style_of("{ \"camera\": { \"fov\": 40, \"bgcolor\": [0, 0, 0] } }", &CATALOG);
    let text = "\u{feff}// a // b\r\n{ /* \" */ \"camera\": {\r\n\"fov\": 40, // fov, }\r\n\"bgcolor\": [0, 0, 0,/**/],\r\n}\t,}\r\n/**/";
    assert_eq!(style_of(text, &CATALOG), plain);
    let in_text = style_of("{ \"$schema\": \"http://x/*y*/,}\" }", &CATALOG);
    assert_eq!(in_text.camera, Camera { fov: 35.0, bgcolor: Srgba::from_bytes([255; 3]), ..plain.camera });
}

#[test]
fn the_example_of_the_manual_loads() {
    let style = style_of(
        r##"{ "$schema": "style-v1.json", "version": 1,
          "camera":   { "orthographic": false, "bgcolor": [255, 255, 255], "fov": 35, "exposure": 0 },
          "geometry": { "atom": "vdw", "scale": 0.25, "bond_radius": "0.14A" },
          "mapping":  { "atom": "flat", "connector": "flat", "atom[element=O]": "accent", "atom[residue=HOH]": null,
                        "mesh[part=Housing*]": "glass", "post_effects": ["soft_ao", "dofPost"] },
          "shaders":  [ { "name": "flat", "shader": "toon", "properties": { "steps": 4, "outline_bias": 0.35, "hull_size": "2pt" } },
                        { "name": "accent", "shader": "toon", "properties": { "base_color": "#c0392b" } },
                        { "name": "glass", "shader": "curvature" },
                        { "name": "soft_ao", "shader": "ssaoPost", "properties": { "radius": "3r" } } ],
          "lights":   [ { "type": "directional", "position": [1, 2, 3], "color": [255, 255, 255], "intensity": 1.0,
                          "shadow": "soft", "strength": 0.6, "movable": true }, { "type": "ambient", "intensity": 0.3 } ],
          "transparency": { "method": "auto", "memory_mb": 512 } }"##,
        &CATALOG,
    );
    assert_eq!(warnings(&style), Vec::<String>::new());
    let water = [(Attribute::Element, "O"), (Attribute::Residue, "HOH")];
    assert_eq!(drawn_with(&style, ObjectKind::Atom, &water), None);
    assert_eq!(drawn_with(&style, ObjectKind::Atom, &[(Attribute::Element, "o")]), Some("accent"));
    assert_eq!(drawn_with(&style, ObjectKind::Mesh, &[(Attribute::Part, "Housing_2")]), Some("glass"));
    let glass = style.shaders.iter().find(|used| used.name == "glass").unwrap();
    assert_eq!(glass.shader, "curvature");
    let effects: Vec<&str> = style.post_effects.iter().map(|index| style.shaders[*index].shader).collect();
    assert_eq!(effects, ["ssaoPost", "dofPost"]);
    let key = &style.lights[0];
    assert_eq!((key.shadow, key.space, key.movable, key.range), (Shadow::Soft, Space::Camera, true, None));
    let used: Vec<Attribute> = style.attributes_used(ObjectKind::Atom).iter().collect();
    assert_eq!(used, [Attribute::Element, Attribute::Residue]);
    assert!(style.attributes_used(ObjectKind::Connector).is_empty());
}

#[test]
fn a_type_that_is_not_drawn_warns_once() {
    let text = r#"{ "mapping": { "atom": "curvature", "ribbon": "toon", "ribbon[chain=A]": null } }"#;
    let style = style_of(text, &CATALOG);
    assert_eq!(
        warnings(&style),
        ["s.json:1:37 (mapping.ribbon): warning: objects of type \"ribbon\" are not drawn by this version yet"]
    );
}

#[test]
fn the_more_attributes_the_stronger() {
    let text = r#"{ "mapping": { "*[chain=A][element=O]": "unlit", "atom[element=O]": "toon", "*[element=O]": "basic",
        "atom": null, "*": "toon", "atom[element=*]": "unlit" } }"#;
    let style = style_of(text, &CATALOG);
    let oxygen = (Attribute::Element, "O");
    assert_eq!(drawn_with(&style, ObjectKind::Atom, &[oxygen, (Attribute::Chain, "A")]), Some("unlit"));
    // Equal in attributes and type: the later one, `atom[element=*]`.
    assert_eq!(drawn_with(&style, ObjectKind::Atom, &[oxygen]), Some("unlit"));
    assert_eq!(drawn_with(&style, ObjectKind::Connector, &[oxygen]), Some("basic"));
    assert_eq!(drawn_with(&style, ObjectKind::Atom, &[]), None);
    assert_eq!(drawn_with(&style, ObjectKind::Mesh, &[]), Some("toon"));
}

#[test]
fn a_declared_basic_draws_what_nothing_selects() {
    let text = r#"{ "shaders": [{ "name": "basic", "shader": "unlit", "properties": { "base_color": "chain" } }] }"#;
    let style = style_of(text, &CATALOG);
    let basic = &style.shaders[style.basic];
    assert_eq!((basic.shader, basic.values.base_color("base_color")), ("unlit", BaseColor::Chain));
}

#[test]
fn every_kind_of_value_is_read() {
    let text = r##"{ "camera": { "position": [0, 0, 3], "target": null, "zoom": 2, "exposure": -1.5, "orient": "principal" },
        "geometry": { "atom": "1.5A", "file_unit": "cm" }, "lights": [{ "type": "point", "range": 4, "space": "scene" }],
        "shaders": [{ "name": "a", "shader": "toon", "properties": { "shadow_color": "#12345680", "specular_color": null,
            "steps": 4.0, "color": [1, 2, 3, 127.5], "base_color": [255, 0, 0] } }],
        "mapping": { "atom": "a", "post_effects": [] } }"##;
    let style = style_of(text, &CATALOG);
    assert_eq!((style.camera.position, style.camera.target), (Some([0.0, 0.0, 3.0]), None));
    assert_eq!((style.camera.orient, style.geometry.file_unit_mm), (Orient::Principal, 10.0));
    assert_eq!(style.geometry.atom, AtomRadius::Length(Length::Angstrom(1.5)));
    let light = &style.lights[0];
    assert_eq!((light.kind, light.range, light.space), (LightKind::Point, Some(Length::Radii(4.0)), Space::Scene));
    let used = &style.shaders[0];
    assert_eq!((used.role, used.values.count("steps")), (Role::Object, 4));
    assert_eq!(used.values.optional_color("shadow_color").map(|c| c.to_string()).as_deref(), Some("#12345680"));
    assert_eq!(used.values.get("specular_color"), Some(&Value::Unset));
    assert_eq!(used.values.color("color").rgba[3], 0.5);
    assert_eq!(used.values.base_color("base_color"), BaseColor::Color(Srgba::from_bytes([255, 0, 0])));
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let message = |path: &Path| load_file(path, &CATALOG).unwrap_err().to_string();
    assert_eq!(message(Path::new("no/such.json")), "no/such.json: there is no such file");
    assert_eq!(message(Path::new("tests")), "tests: this is a folder, not a style file");
}

#[cfg(unix)]
#[test]
fn a_file_without_permission_says_so() {
    use std::os::unix::fs::PermissionsExt;
    let path = std::env::temp_dir().join(format!("restyle_locked_{}.json", std::process::id()));
    std::fs::write(&path, "{}").unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o000)).unwrap();
    // The superuser reads everything, so that there is nothing to refuse.
    let is_refused = std::fs::read(&path).is_err();
    let loaded = load_file(&path, &CATALOG);
    std::fs::remove_file(&path).unwrap();
    if is_refused {
        assert!(loaded.unwrap_err().to_string().ends_with(": no permission to read this file"));
    }
}

#[test]
fn every_word_of_a_choice_means_itself() {
    let light = |key: &str, word: &str| {
        let text = format!("{{ \"lights\": [{{ \"{key}\": \"{word}\" }}] }}");
        style_of(&text, &CATALOG).lights[0].clone()
    };
    assert_eq!(light("type", "directional").kind, LightKind::Directional);
    assert_eq!(light("type", "point").kind, LightKind::Point);
    assert_eq!(light("type", "ambient").kind, LightKind::Ambient);
    assert_eq!(light("shadow", "none").shadow, Shadow::None);
    assert_eq!(light("shadow", "hard").shadow, Shadow::Hard);
    assert_eq!(light("shadow", "soft").shadow, Shadow::Soft);
    assert_eq!(light("space", "camera").space, Space::Camera);
    assert_eq!(light("space", "scene").space, Space::Scene);
    let geometry = |key: &str, word: &str| {
        style_of(&format!("{{ \"geometry\": {{ \"{key}\": \"{word}\" }} }}"), &CATALOG).geometry
    };
    assert_eq!(geometry("atom", "vdw").atom, AtomRadius::Vdw);
    assert_eq!(geometry("atom", "covalent").atom, AtomRadius::Covalent);
    for (unit, mm) in [("A", 1e-7), ("nm", 1e-6), ("um", 1e-3), ("mm", 1.0), ("cm", 10.0), ("m", 1e3), ("inch", 25.4)] {
        assert_eq!(geometry("file_unit", unit).file_unit_mm, mm);
    }
    let method = |word: &str| {
        style_of(&format!("{{ \"transparency\": {{ \"method\": \"{word}\" }} }}"), &CATALOG).transparency.method
    };
    assert_eq!(method("auto"), TransparencyMethod::Auto);
    assert_eq!(method("bkb"), TransparencyMethod::Bkb);
    assert_eq!(method("packed"), TransparencyMethod::Packed);
}
