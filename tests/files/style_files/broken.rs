//! Broken styles, each with the exact text that its author reads.

use restyle::config::{Source, load};

use super::catalog::CATALOG;

fn messages(style: &str) -> String {
    match load(&Source::new("s.json", style), &CATALOG) {
        Ok(_) => panic!("this style loads, but should not: {style}"),
        Err(mistakes) => mistakes.to_string(),
    }
}

#[test]
fn every_mistake_has_its_message() {
    for (style, expected) in BROKEN {
        assert_eq!(messages(style), *expected, "\nfor {style}");
    }
}

#[rustfmt::skip]
const BROKEN: &[(&str, &str)] = &[
    (
        r#"{ "camera": 3 }"#,
        r#"s.json:1:13 (camera): "camera" must be an object, not the number 3"#,
    ),
    (
        "[]",
        r#"s.json:1:1: "style" must be an object, not an empty list"#,
    ),
    (
        r#""text""#,
        r#"s.json:1:1: "style" must be an object, not the text "text""#,
    ),
    (
        r#"{ "camra": {} }"#,
        r#"s.json:1:3 (camra): a style has no "camra"; did you mean "camera"? allowed: $schema, version, extends, camera, geometry, mapping, shaders, lights, transparency"#,
    ),
    (
        r#"{ "camera": { "fovv": 30 } }"#,
        r#"s.json:1:15 (camera.fovv): camera has no "fovv"; did you mean "fov"? allowed: orthographic, bgcolor, fov, exposure, zoom, orient, position, target, up"#,
    ),
    (
        r#"{ "camera": { "fov": "wide" } }"#,
        r#"s.json:1:22 (camera.fov): "fov" must be a number, not the text "wide""#,
    ),
    (
        r#"{ "camera": { "fov": 200 } }"#,
        r#"s.json:1:22 (camera.fov): "fov" is 200, but must lie in 1 to 150 degrees"#,
    ),
    (
        r#"{ "camera": { "fov": 1e999 } }"#,
        r#"s.json:1:22: this number is too large"#,
    ),
    (
        r#"{ "camera": { "orthographic": "yes" } }"#,
        r#"s.json:1:31 (camera.orthographic): "orthographic" must be true or false, not the text "yes""#,
    ),
    (
        r#"{ "camera": { "bgcolor": [255, 255] } }"#,
        r##"s.json:1:26 (camera.bgcolor): "bgcolor" is a list of 2 values, which is no colour: write [r, g, b] or [r, g, b, a] in 0 to 255, "#rrggbb" or a CSS name"##,
    ),
    (
        r#"{ "camera": { "bgcolor": [255, 256, 0] } }"#,
        r#"s.json:1:32 (camera.bgcolor[1]): "bgcolor" is 256, but must lie in 0 to 255"#,
    ),
    (
        r#"{ "camera": { "bgcolor": [255, "0", 0] } }"#,
        r#"s.json:1:32 (camera.bgcolor[1]): "bgcolor" must be a colour of numbers in 0 to 255, not the text "0""#,
    ),
    (
        r#"{ "camera": { "bgcolor": "whit" } }"#,
        r##"s.json:1:26 (camera.bgcolor): "bgcolor" is the text "whit", which is no colour: write [r, g, b] or [r, g, b, a] in 0 to 255, "#rrggbb" or a CSS name; did you mean "white"?"##,
    ),
    (
        r#"{ "camera": { "bgcolor": "ffffff" } }"#,
        r##"s.json:1:26 (camera.bgcolor): "bgcolor" is the text "ffffff", which is no colour: write [r, g, b] or [r, g, b, a] in 0 to 255, "#rrggbb" or a CSS name; did you mean "#ffffff"?"##,
    ),
    (
        r#"{ "camera": { "up": [0, 0, 0] } }"#,
        r#"s.json:1:21 (camera.up): "up" is no direction: one of its numbers must not be 0"#,
    ),
    (
        r#"{ "camera": { "position": [0, 0, 0] } }"#,
        r#"s.json:1:27 (camera.position): "position" and "target" are the same point, so the camera looks nowhere"#,
    ),
    (
        r#"{ "camera": { "position": [1, 2] } }"#,
        r#"s.json:1:27 (camera.position): "position" must be a list of 3 numbers, not a list of 2 values"#,
    ),
    (
        r#"{ "camera": { "fov": 30, "fov": 40 } }"#,
        r#"s.json:1:26 (camera.fov): duplicate key "fov": it is already at 1:15; keep one of them"#,
    ),
    (
        r#"{ "camera": { "orient": "Principal" } }"#,
        r#"s.json:1:25 (camera.orient): "orient" cannot be "Principal"; did you mean "principal"? allowed: default, principal"#,
    ),
    (
        r#"{ "version": 2 }"#,
        r#"s.json:1:14 (version): "version" is 2, but must be 1: this program reads no other version of style files"#,
    ),
    (
        r#"{ "version": "1" }"#,
        r#"s.json:1:14 (version): "version" must be the number 1, not the text "1""#,
    ),
    (
        r#"{ "geometry": { "atom": "vdv" } }"#,
        r#"s.json:1:25 (geometry.atom): "atom" cannot be "vdv"; did you mean "vdw"? allowed: vdw, covalent, a length"#,
    ),
    (
        r#"{ "geometry": { "atom": "2px" } }"#,
        r#"s.json:1:25 (geometry.atom): "atom" is "2px", which is no length: write a number (radii of the scene), "2pt", "3r", "1.5A" or "2mm"; did you mean "2pt"?"#,
    ),
    (
        r#"{ "geometry": { "bond_radius": "-1A" } }"#,
        r#"s.json:1:32 (geometry.bond_radius): "bond_radius" is -1, but must be 0 or more"#,
    ),
    (
        r#"{ "geometry": { "bond_radius": true } }"#,
        r#"s.json:1:32 (geometry.bond_radius): "bond_radius" must be a number (radii of the scene) or a text such as "2pt", "3r", "1.5A" or "2mm", not true"#,
    ),
    (
        r#"{ "transparency": { "k": 2.5 } }"#,
        r#"s.json:1:26 (transparency.k): "k" must be a whole number, 0 or more, not the number 2.5"#,
    ),
    (
        r#"{ "transparency": { "memory_mb": -1 } }"#,
        r#"s.json:1:34 (transparency.memory_mb): "memory_mb" must be a whole number, 0 or more, not the number -1"#,
    ),
    (
        r#"{ "lights": {} }"#,
        r#"s.json:1:13 (lights): "lights" must be a list, not an object: write [ before it and ] after it"#,
    ),
    (
        r#"{ "lights": [{ "type": "sun" }] }"#,
        r#"s.json:1:24 (lights[0].type): "type" cannot be "sun"; allowed: directional, point, ambient"#,
    ),
    (
        r#"{ "lights": [{ "type": "directional", "position": [0, 0, 0] }] }"#,
        "s.json:1:51 (lights[0].position): a directional light at the centre shines nowhere: one of its numbers must not be 0",
    ),
    (
        r#"{ "lights": [{ "strength": 1.5 }, 7] }"#,
        r#"s.json:1:28 (lights[0].strength): "strength" is 1.5, but must lie in 0 to 1
s.json:1:35 (lights[1]): "light" must be an object, not the number 7"#,
    ),
    (
        r#"{ "lights": [{ "shadow": true }] }"#,
        r#"s.json:1:26 (lights[0].shadow): "shadow" must be one of the texts "none", "hard", "soft", not true"#,
    ),
    (
        r#"{ "mapping": { "atm": "basic" } }"#,
        r#"s.json:1:16 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "mapping": { "mesh[element=O]": "basic" } }"#,
        r#"s.json:1:16 (mapping["mesh[element=O]"]): selector "mesh[element=O]": "mesh" has no attribute "element"; allowed: part, material, node, file"#,
    ),
    (
        r#"{ "mapping": { "atom[element=O": "basic" } }"#,
        r#"s.json:1:16 (mapping["atom[element=O"]): selector "atom[element=O": ] is missing"#,
    ),
    (
        r#"{ "mapping": { "atom": "tune" } }"#,
        r#"s.json:1:24 (mapping.atom): no shader is called "tune"; allowed: basic, toon, unlit, curvature"#,
    ),
    (
        r#"{ "mapping": { "atom": 3 } }"#,
        r#"s.json:1:24 (mapping.atom): "atom" must be the name of a shader, or null to hide, not the number 3"#,
    ),
    (
        r#"{ "mapping": { "atom": "dofPost" } }"#,
        r#"s.json:1:24 (mapping.atom): "dofPost" is a post effect, not a shader of objects: list it in mapping.post_effects; allowed: basic, toon, unlit, curvature"#,
    ),
    (
        r#"{ "mapping": { "post_effects": "dofPost" } }"#,
        r#"s.json:1:32 (mapping.post_effects): "post_effects" must be a list, not the text "dofPost": write [ before it and ] after it"#,
    ),
    (
        r#"{ "mapping": { "post_effects": ["toon"] } }"#,
        r#"s.json:1:33 (mapping.post_effects[0]): "toon" is a shader of objects, not a post effect; allowed: ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "mapping": { "post_effects": ["ssao", null] } }"#,
        r#"s.json:1:33 (mapping.post_effects[0]): no post effect is called "ssao"; did you mean "ssaoPost"? allowed: ssaoPost, dofPost, outlinePost
s.json:1:41 (mapping.post_effects[1]): "post_effects" must be a list of names of post effects, not null"#,
    ),
    (
        r#"{ "mapping": { "atom": "flat" }, "shaders": [{ "name": "flta", "shader": "toon" }] }"#,
        r#"s.json:1:24 (mapping.atom): no shader is called "flat"; did you mean "flta"? allowed: flta, basic, toon, unlit, curvature"#,
    ),
    (
        r#"{ "shaders": {} }"#,
        r#"s.json:1:14 (shaders): "shaders" must be a list, not an object: write [ before it and ] after it"#,
    ),
    (
        r#"{ "shaders": [ "toon" ] }"#,
        r#"s.json:1:16 (shaders[0]): "shaders" must be a list of objects, not the text "toon""#,
    ),
    (
        r#"{ "shaders": [{ "properties": {} }] }"#,
        r#"s.json:1:15 (shaders[0]): this shader entry has neither "name" nor "shader", so nothing can use it: name it or remove it"#,
    ),
    (
        r#"{ "shaders": [{ "lights": [] }] }"#,
        r#"s.json:1:15 (shaders[0]): this shader entry has neither "name" nor "shader", so nothing can use it: name it or remove it
s.json:1:17 (shaders[0].lights): a shader entry has no "lights": it belongs at the top of the style"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a" }] }"#,
        r#"s.json:1:15 (shaders[0]): this shader entry needs "shader": add it; allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "shaders": [{ "shader": "toon" }] }"#,
        r#"s.json:1:15 (shaders[0]): this shader entry needs "name": add it"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "tone" }] }"#,
        r#"s.json:1:40 (shaders[0].shader): no shader is called "tone"; did you mean "toon"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "propertys": {} }] }"#,
        r#"s.json:1:48 (shaders[0].propertys): a shader entry has no "propertys"; did you mean "properties"? allowed: name, shader, properties"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "hul_size": "2pt" } }] }"#,
        r#"s.json:1:64 (shaders[0].properties.hul_size): shader "toon" has no "hul_size"; did you mean "hull_size"? allowed: color, hull_size, outline_bias, scale, bias, exponent, steps, levels, shadow_color, specular_color, specular_limit, base_color, opacity"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "hull_size": "2px" } }] }"#,
        r#"s.json:1:77 (shaders[0].properties.hull_size): "hull_size" is "2px", which is no length: write a number (radii of the scene), "2pt", "3r", "1.5A" or "2mm"; did you mean "2pt"?"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "hull_size": 2 } }] }"#,
        r#"s.json:1:77 (shaders[0].properties.hull_size): "hull_size" is 2, but must lie in 0 to 1 radii"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "steps": 99 } }] }"#,
        r#"s.json:1:73 (shaders[0].properties.steps): "steps" is 99, but must lie in 1 to 64 levels"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "levels": "center" } }] }"#,
        r#"s.json:1:74 (shaders[0].properties.levels): "levels" cannot be "center"; did you mean "centre"? allowed: floor, centre, full"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "base_color": "elements" } }] }"#,
        r##"s.json:1:78 (shaders[0].properties.base_color): "base_color" is the text "elements", which is no colour: write [r, g, b] or [r, g, b, a] in 0 to 255, "#rrggbb" or a CSS name; did you mean "element"?"##,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": [] }] }"#,
        r#"s.json:1:62 (shaders[0].properties): "properties" must be an object, not an empty list"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon" }, { "name": "a", "shader": "basic" }] }"#,
        r#"s.json:1:60 (shaders[1].name): a shader called "a" is already at 1:25"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "curvature", "properties": { "opacity": 2 } }] }"#,
        r#"s.json:1:80 (shaders[0].properties.opacity): "opacity" is 2, but must lie in 0 to 1"#,
    ),
    (
        r#"{ "shaders": [{ "name": "e", "shader": "ssaoPost" }], "mapping": { "*": "e" } }"#,
        r#"s.json:1:73 (mapping.*): "e" is a post effect, not a shader of objects: list it in mapping.post_effects; allowed: basic, toon, unlit, curvature"#,
    ),
    (
        r#"{ "extends": 3 }"#,
        r#"s.json:1:14 (extends): "extends" must be the name of a style file, not the number 3"#,
    ),
    (
        r#"{ "extends": "base.json" }"#,
        r#"s.json:1:14 (extends): cannot extend "base.json": only a style that is a file can extend another file"#,
    ),
    (
        r#"{ "camera": { "fov": 30 }"#,
        r#"s.json:1:25: the file ends, but the { at 1:1 is not closed: write } at its end"#,
    ),
    (
        r#"{ "camera": { "fov": 30 ] }"#,
        r#"s.json:1:25: the { at 1:13 is closed by ]: write } in its place"#,
    ),
    (
        r#"{ "camera": {} "mapping": {} }"#,
        r#"s.json:1:16: a comma is missing before this key"#,
    ),
    (
        r#"{ "camera": { "fov": } }"#,
        r#"s.json:1:15: "fov" has no value: write one after the colon"#,
    ),
    (
        r#"{ "camera": { "fov": 030 } }"#,
        r#"s.json:1:22: write 30 instead of 030"#,
    ),
    (
        "{ 'camera': {} }",
        r#"s.json:1:3: a text stands in straight double quotes: write "camera""#,
    ),
    (
        r#"{ "camera": {} } {}"#,
        r#"s.json:1:18: there is more text after the end of the style: remove it"#,
    ),
    (
        r#"{ "camera": /* open }"#,
        "s.json:1:13: this comment is never closed: */ is missing",
    ),
    (
        r#"{ "camera": {},, }"#,
        r#"s.json:1:16: there is nothing between these commas: remove one, or write what is missing"#,
    ),
    (
        "[,]",
        r#"s.json:1:2: there is nothing before this comma: remove it, or write what is missing"#,
    ),
    (
        r#"{ "mapping": { "atom": "to
on" } }"#,
        r#"s.json:1:24: a text cannot go over a line break: write it in one line, with \n for a break"#,
    ),
    (
        r#"{ "mapping": { "a\qb": null } }"#,
        r#"s.json:1:18: there is no escape \q: a backslash itself is written \\"#,
    ),
    (
        r#"{ "mapping": { "\ud800": null } }"#,
        r#"s.json:1:17: this \u escape is no character: write the character itself, or \\ for a backslash"#,
    ),
    (
        "// nothing",
        r#"s.json:1:11: the file holds only comments: the smallest style is {}"#,
    ),
    (
        "",
        "s.json: the file is empty: the smallest style is {}",
    ),
    (
        " \r\n\t",
        "s.json: the file is empty: the smallest style is {}",
    ),
    (
        "{\r\n  // \u{e9}\r\n  \"camera\": { /* \u{1f600} */ \"fov\": 0 },\r\n}",
        r#"s.json:3:30 (camera.fov): "fov" is 0, but must lie in 1 to 150 degrees"#,
    ),
    (
        r#"{ "camera": { "fov": 0, "zoom": 0 },
  "lights": [{ "intensity": -1 }],
  "mapping": { "atom": "x" } }"#,
        r#"s.json:1:22 (camera.fov): "fov" is 0, but must lie in 1 to 150 degrees
s.json:1:33 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:2:29 (lights[0].intensity): "intensity" is -1, but must lie in 0 to 1000
s.json:3:24 (mapping.atom): no shader is called "x"; allowed: basic, toon, unlit, curvature"#,
    ),
    (
        r#"{"a":[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]]}"#,
        r#"s.json:1:2 (a): a style has no "a"; allowed: $schema, version, extends, camera, geometry, mapping, shaders, lights, transparency
s.json:1:69: lists and objects are nested deeper than 64 levels"#,
    ),
    (
        r#"{ "geometry": { "atom": true } }"#,
        r#"s.json:1:25 (geometry.atom): "atom" must be a number (radii of the scene) or a text such as "2pt", "3r", "1.5A" or "2mm", not true"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", "properties": { "hull_size": "-2pt" } }] }"#,
        r#"s.json:1:77 (shaders[0].properties.hull_size): "hull_size" is -2, but must be 0 or more"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "curvatur" }] }"#,
        r#"s.json:1:40 (shaders[0].shader): no shader is called "curvatur"; did you mean "curvature"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "camera": { "fov": nul } }"#,
        r#"s.json:1:22: write null instead of nul"#,
    ),
    (
        r#"{ "mapping": { "post_effects": ["toon"] }, "shaders": [{ "name": "soft", "shader": "ssaoPost" }] }"#,
        r#"s.json:1:33 (mapping.post_effects[0]): "toon" is a shader of objects, not a post effect; allowed: soft, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "camera": { "fov" 30 } }"#,
        r#"s.json:1:21: a colon is missing between "fov" and this value"#,
    ),
];

#[test]
fn a_place_points_at_the_bytes() {
    let style = "\u{feff}{ /* \u{e9} */ \"camera\": { \"fov\": 0 } }";
    let mistakes = load(&Source::new("s.json", style), &CATALOG).unwrap_err();
    let place = &mistakes.list[0].place;
    assert_eq!((place.line, place.column), (1, 30));
    let without_mark = style.trim_start_matches('\u{feff}');
    assert_eq!(&without_mark[place.start..place.end], "0");
}

#[test]
fn text_that_is_not_utf8_has_its_line() {
    let mistakes = load(&Source::new("s.json", b"{\n \xff }"), &CATALOG).unwrap_err();
    assert_eq!(mistakes.to_string(), "s.json:2:2: this is not UTF-8 text: save the file as UTF-8");
}

#[test]
fn a_file_beyond_the_limit_is_refused_whole() {
    let text = vec![b' '; restyle::config::syntax::MAX_BYTES + 1];
    let mistakes = load(&Source::new("s.json", text), &CATALOG).unwrap_err();
    assert_eq!(mistakes.to_string(), "s.json: a style is at most 16 MB, and this file is larger");
}

#[test]
fn depth_is_bounded() {
    let deep = |depth: usize| messages(&format!("{{\"a\":{}{}}}", "[".repeat(depth), "]".repeat(depth)));
    assert!(deep(63).contains("a style has no \"a\""));
    assert!(deep(64).ends_with("\ns.json:1:69: lists and objects are nested deeper than 64 levels"));
    assert!(messages(&"[".repeat(1_000_000)).contains("nested deeper"));
}

#[test]
fn a_flood_of_mistakes_is_counted() {
    let lights = vec!["7"; 1000].join(",");
    let text = messages(&format!("{{ \"lights\": [{lights}] }}"));
    assert_eq!(text.lines().count(), 101);
    assert!(text.ends_with("\nand 900 more"));
}

#[test]
fn a_large_style_of_one_line_is_read_in_time() {
    let entry = "{ \"name\": \"n@\", \"shader\": \"toon\", \"properties\": { \"steps\": 3 } }";
    let entries: Vec<String> = (0..20_000).map(|i| entry.replace('@', &i.to_string())).collect();
    let style = format!("{{ \"shaders\": [{}], \"mapping\": {{ \"atom\": \"n19999\" }} }}", entries.join(","));
    let loaded = load(&Source::new("s.json", style), &CATALOG).unwrap();
    assert_eq!(loaded.shaders.len(), 20_001);
}
