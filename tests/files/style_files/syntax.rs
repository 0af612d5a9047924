//! Styles that are no JSON: every slip is told once, where it is, with what to write instead, and what stands around it
//! is checked all the same.

use restyle::config::{Source, load};

use super::catalog::CATALOG;

fn messages(style: &str) -> String {
    match load(&Source::new("s.json", style), &CATALOG) {
        Ok(_) => panic!("this style loads, but should not: {style}"),
        Err(mistakes) => mistakes.to_string(),
    }
}

#[test]
fn every_slip_has_its_message_and_hides_no_other() {
    for (style, expected) in SLIPS {
        assert_eq!(messages(style), *expected, "\nfor {style}");
    }
}

#[rustfmt::skip]
const SLIPS: &[(&str, &str)] = &[
    (
        r#"{ "camera": { "fov": 30 "zoom": 2 } }"#,
        "s.json:1:25: a comma is missing before this key",
    ),
    (
        r#"{ "camera": { "bgcolor": [1 2, 3], "zoom": 0 } }"#,
        r#"s.json:1:29: a comma is missing before this value
s.json:1:44 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "fov" 30, "zoom": 0 } }"#,
        r#"s.json:1:21: a colon is missing between "fov" and this value
s.json:1:33 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera" = { "fov" = 300 } }"#,
        r#"s.json:1:12: write : instead of = between a key and its value
s.json:1:22: write : instead of = between a key and its value
s.json:1:24 (camera.fov): "fov" is 300, but must lie in 1 to 150 degrees"#,
    ),
    (
        r#"{ "camera": { "fov": 30; "zoom": 0; } }"#,
        r#"s.json:1:24: write , instead of ;
s.json:1:34 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:35: write , instead of ;"#,
    ),
    (
        r#"{ "camera": { "fov": 30,, "zoom": 0 } }"#,
        r#"s.json:1:25: there is nothing between these commas: remove one, or write what is missing
s.json:1:35 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ , "camera": { "zoom": 0 } }"#,
        r#"s.json:1:3: there is nothing before this comma: remove it, or write what is missing
s.json:1:25 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        "{ 'camera': { 'orient': 'principle' } }",
        r#"s.json:1:3: a text stands in straight double quotes: write "camera"
s.json:1:15: a text stands in straight double quotes: write "orient"
s.json:1:25: a text stands in straight double quotes: write "principle"
s.json:1:25 (camera.orient): "orient" cannot be "principle"; did you mean "principal"? allowed: default, principal"#,
    ),
    (
        "{ camera: { fov: 300 } }",
        r#"s.json:1:3: a key needs quotes: write "camera"
s.json:1:13: a key needs quotes: write "fov"
s.json:1:18 (camera.fov): "fov" is 300, but must lie in 1 to 150 degrees"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": toon }], "mapping": { "atom": "a" } }"#,
        r#"s.json:1:40: a text needs quotes: write "toon""#,
    ),
    (
        r#"{ "geometry": { "bond_orders": True }, "camera": { "zoom": 0 } }"#,
        r#"s.json:1:32: write true instead of True
s.json:1:60 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "orthographic": yes, "position": None, "target": undefined, "fov": NaN, "zoom": -Infinity } }"#,
        r"s.json:1:31: write true instead of yes
s.json:1:48: write null instead of None
s.json:1:64: write null instead of undefined
s.json:1:82: NaN is no number that a style can hold: write one such as 12 or -0.5
s.json:1:95: -Infinity is no number that a style can hold: write one such as 12 or -0.5",
    ),
    (
        "{ “camera”: { “fov”: 300 } }",
        r#"s.json:1:3: a text stands in straight double quotes: write "camera"
s.json:1:15: a text stands in straight double quotes: write "fov"
s.json:1:22 (camera.fov): "fov" is 300, but must lie in 1 to 150 degrees"#,
    ),
    (
        r#"{ "camera": { "zoom": 0 } } # end"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:29: a comment begins with //, not #"#,
    ),
    (
        r#"{ "camera": { "bgcolor": #ff0000 } }"#,
        r##"s.json:1:26: a colour needs quotes: write "#ff0000""##,
    ),
    (
        r#"{ "camera": { "orient": "principal } }"#,
        r#"s.json:1:25: this text is not closed: write "principal""#,
    ),
    (
        r#"{ "camera": {
  "orient": "principal,
  "zoom": 0
} }"#,
        r#"s.json:2:13: this text is not closed: write "principal"
s.json:3:11 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera: {
  "zoom": 0
} }"#,
        r#"s.json:1:3: this key is not closed: write "camera"
s.json:2:11 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "shaders": [
  { "name: "flat", "shader": "tone" },
  { "name": "b, "shader": "toon" },
  { "name": "c", "shader: "toon" },
  { "name": "d", shader": "toon" },
  { "name": "e", "shader": toon" },
  { "name": "f", "shader": "toon }
], "camera": { "zoom": 0 } }"#,
        r#"s.json:2:5: this key is not closed: write "name"
s.json:2:30 (shaders[0].shader): no shader is called "tone"; did you mean "toon"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost
s.json:3:13: this text is not closed: write "b"
s.json:4:18: this key is not closed: write "shader"
s.json:5:18: this text has no opening quote: write "shader"
s.json:6:28: this text has no opening quote: write "toon"
s.json:7:28: this text is not closed: write "toon"
s.json:8:24 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "mapping": { "atom[element=O]: null, "atm": null } }"#,
        r#"s.json:1:16: this key is not closed: write "atom[element=O]"
s.json:1:40 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "mapping": { atom[element=O]": null, "atm": null } }"#,
        r#"s.json:1:16: this text has no opening quote: write "atom[element=O]"
s.json:1:40 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "mapping": { atom[element=O]: null, "atm": null } }"#,
        r#"s.json:1:16: a key needs quotes: write "atom[element=O]"
s.json:1:39 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "name": "my "best" look", "camera": { "zoom": 0 } }"#,
        r#"s.json:1:3 (name): a style has no "name"; allowed: $schema, version, extends, camera, geometry, mapping, shaders, lights, transparency
s.json:1:15: this quote ends the text: a quote within a text is written \"
s.json:1:49 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "fov": 30 ] }"#,
        "s.json:1:25: the { at 1:13 is closed by ]: write } in its place",
    ),
    (
        r#"{ "camera": { "bgcolor": [1, 2, 3 }, "lights": {} }"#,
        r#"s.json:1:35: the [ at 1:26 is not closed: write ] before this }
s.json:1:48 (lights): "lights" must be a list, not an object: write [ before it and ] after it"#,
    ),
    (
        r#"{ "lights": [ { "strength": 2 }, { "softness": 100 ], "camera": { "zoom": 0 } }"#,
        r#"s.json:1:29 (lights[0].strength): "strength" is 2, but must lie in 0 to 1
s.json:1:48 (lights[1].softness): "softness" is 100, but must lie in 0 to 90 degrees
s.json:1:52: the { at 1:34 is not closed: write } before this ]
s.json:1:75 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "fov": 30 } }, "mapping": { "atm": null } }"#,
        r#"s.json:1:28: there is more text after the end of the style, which is the } at 1:27: move that } to the end, or remove this
s.json:1:43 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "camera": { "zoom": 0 } }}"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:28: this } closes nothing: remove it"#,
    ),
    (
        r#"{ "camera": { "zoom": 0 }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:25: the file ends, but the { at 1:1 is not closed: write } at its end"#,
    ),
    (
        r#"{ "camera": { "zoom": 0 ] } }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:25: this ] closes nothing: remove it"#,
    ),
    (
        r#"{ "camera": { "zoom": 0, "mapping": { "atm": null } }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:26: the { at 1:13 is not closed: write } before this key
s.json:1:39 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon", { "name": "b", "shader": "tone" }] }"#,
        r#"s.json:1:48: the { at 1:15 is not closed: write } before this {
s.json:1:73 (shaders[1].shader): no shader is called "tone"; did you mean "toon"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "shaders": [{ "name": "a", "shader": "toon" { "name": "b", "shader": "tone" }] }"#,
        r#"s.json:1:47: the { at 1:15 is not closed: write } before this {
s.json:1:72 (shaders[1].shader): no shader is called "tone"; did you mean "toon"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "camera": { "up": [0, 0, 0, "fov": 300 } }"#,
        r#"s.json:1:31: the [ at 1:21 is not closed: write ] before this key
s.json:1:38 (camera.fov): "fov" is 300, but must lie in 1 to 150 degrees"#,
    ),
    (
        r#"{ "camera": [ "fov": 300, "zoom": 0 ], "lights": {} }"#,
        r#"s.json:1:20: a list holds no keys: put its keys and values between { and }
s.json:1:50 (lights): "lights" must be a list, not an object: write [ before it and ] after it"#,
    ),
    (
        r#"{ "camera": {} } {}"#,
        "s.json:1:18: there is more text after the end of the style: remove it",
    ),
    (
        r#"{ "camera": {} } oops"#,
        "s.json:1:18: there is more text after the end of the style: remove it",
    ),
    (
        r#"{ "camera": {}, /* open"#,
        "s.json:1:17: this comment is never closed: */ is missing",
    ),
    (
        r#"{ "camera": { "fov": .5, "zoom": 5., "exposure": +1 } }"#,
        r"s.json:1:22: write 0.5 instead of .5
s.json:1:34: write 5 instead of 5.
s.json:1:50: write 1 instead of +1",
    ),
    (
        r#"{ "camera": { "fov": 0x10, "zoom": 01, "exposure": 1e999 } }"#,
        r"s.json:1:22: write 16 instead of 0x10
s.json:1:36: write 1 instead of 01
s.json:1:52: this number is too large",
    ),
    (
        r#"{ "camera": { "fov": 1_000, "zoom": 1,5, "exposure": 100 } }"#,
        r#"s.json:1:22: write 1000 instead of 1_000
s.json:1:37: a decimal number has a point: write 1.5
s.json:1:54 (camera.exposure): "exposure" is 100, but must lie in -10 to 10 stops"#,
    ),
    (
        r#"{ "camera": { "fov": 30 degrees, "zoom": 0 } }"#,
        r#"s.json:1:25: degrees has no meaning here: remove it, or write a key and a value
s.json:1:42 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "fov": 30°, "zoom": 50% } }"#,
        r"s.json:1:22: write 30 instead of 30°
s.json:1:35: write 0.5 instead of 50%",
    ),
    (
        r#"{ "geometry": { "bond_radius": 0.14A, "scale": 0 } }"#,
        r#"s.json:1:32: a length with a unit needs quotes: write "0.14A"
s.json:1:48 (geometry.scale): "scale" is 0, but must lie in 0.001 to 100"#,
    ),
    (
        r#"{ "$schema": "C:\users\me\style.json" }"#,
        r"s.json:1:17: this \u escape is no character: write the character itself, or \\ for a backslash",
    ),
    (
        r#"{ "$schema": "C:\styles\me.json" }"#,
        r"s.json:1:17: there is no escape \s: a backslash itself is written \\",
    ),
    (
        "{ \"$schema\": \"a\u{9}b\" }",
        r"s.json:1:16: a text cannot hold a tab: write \t or a space",
    ),
    (
        r#"{ "camera": { "fov": , "zoom": } }"#,
        r#"s.json:1:15: "fov" has no value: write one after the colon
s.json:1:24: "zoom" has no value: write one after the colon"#,
    ),
    (
        r#"{ "camera": { "fov", "zoom" } }"#,
        r#"s.json:1:15: "fov" has no value: write a colon and a value after it
s.json:1:22: "zoom" has no value: write a colon and a value after it"#,
    ),
    (
        r#"{ "camera": { : 3, "zoom": 0 } }"#,
        r#"s.json:1:15: a key is missing before this colon
s.json:1:28 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ { "zoom": 0 } }"#,
        "s.json:1:3: a key is missing before this {",
    ),
    (
        r#"{ "camera": { "position": (1, 2, 3), "bgcolor": rgb(255, 0, 0) } }"#,
        r##"s.json:1:27: a list stands in [ and ]: write [1, 2, 3]
s.json:1:49: a colour is written as [r, g, b] in 0 to 255, or in quotes as "#rrggbb""##,
    ),
    (
        r#"{ "camera": { "fov": 30 } / "lights": [] }"#,
        r"s.json:1:27: a comment begins with // or /*: remove this /
s.json:1:29: a comma is missing before this key",
    ),
    (
        r#"{ "lights": [{ "position": [1, x, 2] }, { "type": sun }, 7] }"#,
        r#"s.json:1:32: a text needs quotes: write "x"
s.json:1:51: a text needs quotes: write "sun"
s.json:1:58 (lights[2]): "light" must be an object, not the number 7"#,
    ),
    (
        r#"{ "camera":: { "zoom": 0 } }"#,
        r#"s.json:1:12: this is one colon too many: remove it
s.json:1:24 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "mapping": { "atom": "to
on" } }"#,
        r"s.json:1:24: a text cannot go over a line break: write it in one line, with \n for a break",
    ),
    (
        r#"{ "camera": true false }"#,
        r#"s.json:1:13 (camera): "camera" must be an object, not true
s.json:1:18: false has no meaning here: remove it, or write a key and a value"#,
    ),
    (
        r#"{ "camera" { "zoom": 0 } }"#,
        r#"s.json:1:12: a colon is missing between "camera" and this value
s.json:1:22 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "fov"; 30 } }"#,
        "s.json:1:20: write : instead of ; between a key and its value",
    ),
    (
        r#"{"mapping": {"atom": "toon""#,
        "s.json:1:27: the file ends, but the { at 1:13 is not closed: write } at its end",
    ),
    (
        r#"{ "camera": { "fov": 40 }; "lights": [ ]; }"#,
        r"s.json:1:26: write , instead of ;
s.json:1:41: write , instead of ;",
    ),
    (
        r#"{ "camera": { "zoom": 0 }, ... }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:28: ... has no meaning here: remove it, or write a key and a value"#,
    ),
    (
        r#"{ "camera": { "zoom": 0 } */ }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:27: this */ closes no comment: remove it"#,
    ),
    (
        r#"{ "camera": { "orient": "princi"pal" } }"#,
        r#"s.json:1:32: this quote ends the text: a quote within a text is written \""#,
    ),
    (
        r#"{ "shaders": [ { "name": "a", "shader": "toon", "properties": { "steps": 99, }, { "name": "b", "shader": "tone" } ], "mapping": { "atom": "zz" } }"#,
        r#"s.json:1:74 (shaders[0].properties.steps): "steps" is 99, but must lie in 1 to 64 levels
s.json:1:81: the { at 1:16 is not closed: write } before this {
s.json:1:106 (shaders[1].shader): no shader is called "tone"; did you mean "toon"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"{ "mapping": { "post_effects": ["dofPost, "ssaoPost"], "atm": null } }"#,
        r#"s.json:1:33: this text is not closed: write "dofPost"
s.json:1:56 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "mapping": { "post_effects": ["dofPost", ssaoPost], "atm": null } }"#,
        r#"s.json:1:44: a text needs quotes: write "ssaoPost"
s.json:1:55 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "mapping": { "atom": toon, "connector": null, "*": "nix" } }"#,
        r#"s.json:1:24: a text needs quotes: write "toon""#,
    ),
    (
        r#"{ "camera": { "fov": 30 }
  "mapping": { "atom": "toon" }
  "lights": [ { "strength": 2 } ]
}"#,
        r#"s.json:2:3: a comma is missing before this key
s.json:3:3: a comma is missing before this key
s.json:3:29 (lights[0].strength): "strength" is 2, but must lie in 0 to 1"#,
    ),
    (
        r#"{ "camera": { "fov": 12.5.1, "zoom": 1e, "exposure": -- } }"#,
        r"s.json:1:22: numbers are written like 12, -0.5 or 1e-3
s.json:1:38: numbers are written like 12, -0.5 or 1e-3
s.json:1:54: numbers are written like 12, -0.5 or 1e-3",
    ),
    (
        r#"{ "camera": { "fov": '30' } }"#,
        r#"s.json:1:22: a text stands in straight double quotes: write "30"
s.json:1:22 (camera.fov): "fov" must be a number, not the text "30": write 30"#,
    ),
    (
        r#"{ "camera": { "zoom": 0 } }
"camera": { "zoom": 0 }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:2:1: there is more text after the end of the style, which is the } at 1:27: move that } to the end, or remove this"#,
    ),
    (
        "{ \"camera\": { \"fov\": \u{a0}30, \"zoom\": \u{200b}0 } }",
        r#"s.json:1:22: the invisible character U+00A0 has no place here: write a plain space
s.json:1:35: the invisible character U+200B has no place here: write a plain space
s.json:1:36 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#""camera": { "zoom": 0 }, "lights": {}"#,
        r#"s.json:1:1: a style stands in { and }: write { at its start and } at its end
s.json:1:21 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:36 (lights): "lights" must be a list, not an object: write [ before it and ] after it"#,
    ),
    (
        ",",
        "s.json:1:1: a style begins with {",
    ),
    (
        "}",
        "s.json:1:1: this } closes nothing: remove it",
    ),
    (
        "// only",
        "s.json:1:8: the file holds only comments: the smallest style is {}",
    ),
    (
        "[,]",
        "s.json:1:2: there is nothing before this comma: remove it, or write what is missing",
    ),
    (
        "[1,,]",
        "s.json:1:4: there is nothing between these commas: remove one, or write what is missing",
    ),
    (
        "{ \"camera\": { \"fov\": 30, \"fov\": 0, \u{1} \"zoom\": 0 } }",
        r#"s.json:1:26 (camera.fov): duplicate key "fov": it is already at 1:15; keep one of them
s.json:1:33 (camera.fov): "fov" is 0, but must lie in 1 to 150 degrees
s.json:1:36: the invisible character U+0001 has no place here: write a plain space
s.json:1:46 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        "{ \"mapping\": { \"\u{202e}😀\": \"basic\" }, \"\\u0007x\": 1 }",
        r#"s.json:1:16 (mapping["\u{202e}😀"]): selector "\u{202e}😀": there is no type "\u{202e}😀"; allowed: atom, connector, ribbon, surface, mesh, *, post_effects
s.json:1:33 (["\u{7}x"]): a style has no "\u{7}x"; allowed: $schema, version, extends, camera, geometry, mapping, shaders, lights, transparency"#,
    ),
    (
        r#"{ "mapping": { "\ud800": null, "atm": null } }"#,
        r#"s.json:1:17: this \u escape is no character: write the character itself, or \\ for a backslash
s.json:1:32 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "camera": { "fov": }, "lights": {}"#,
        r#"s.json:1:15: "fov" has no value: write one after the colon
s.json:1:35 (lights): "lights" must be a list, not an object: write [ before it and ] after it
s.json:1:36: the file ends, but the { at 1:1 is not closed: write } at its end"#,
    ),
    (
        r#"{ "camera": { "fov": 30, "zoom": [[[ } }"#,
        "s.json:1:38: the [ at 1:36 is not closed: write ] before this }",
    ),
    (
        r#"{ "camera" }"#,
        r#"s.json:1:3: "camera" has no value: write a colon and a value after it"#,
    ),
    (
        r#"{ "camera": { "zoom": 0, "up": [0,0,0 } }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:39: the [ at 1:32 is not closed: write ] before this }"#,
    ),
    (
        r#"{ "lights": [ { "strength": 2 }, { "strength": 3 } }"#,
        r#"s.json:1:29 (lights[0].strength): "strength" is 2, but must lie in 0 to 1
s.json:1:48 (lights[1].strength): "strength" is 3, but must lie in 0 to 1
s.json:1:52: the [ at 1:13 is not closed: write ] before this }"#,
    ),
    (
        r#"{
  "camera": {
    "zoom": 0
  ,
  "lights": [ { "strength": 2 } ],
  "shaders": [ { "name": "a", "shader": "tone" } ]
}"#,
        r#"s.json:3:13 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:5:3: the { at 2:13 is not closed: write } before this key
s.json:5:29 (lights[0].strength): "strength" is 2, but must lie in 0 to 1
s.json:6:41 (shaders[0].shader): no shader is called "tone"; did you mean "toon"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"#,
    ),
    (
        r#"# my look
{ "camera": { "zoom": 0 } }"#,
        r#"s.json:1:1: a comment begins with //, not #
s.json:2:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "fov": 30 oops "zoom": 0 } }"#,
        r#"s.json:1:25: oops has no meaning here: remove it, or write a key and a value
s.json:1:30: a comma is missing before this key
s.json:1:38 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "zoom": 0, "fov": 40 } } # more"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:40: a comment begins with //, not #"#,
    ),
    (
        r#"{ "lights": [{ "strength": 2 } { "strength": 3 }], "mapping": { 'atm': null } }"#,
        r#"s.json:1:28 (lights[0].strength): "strength" is 2, but must lie in 0 to 1
s.json:1:32: a comma is missing before this value
s.json:1:46 (lights[1].strength): "strength" is 3, but must lie in 0 to 1
s.json:1:65: a text stands in straight double quotes: write "atm"
s.json:1:65 (mapping.atm): selector "atm": there is no type "atm"; did you mean "atom"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects"#,
    ),
    (
        r#"{ "mapping": { "atom": "flat", "connector": "toon" }, "shaders": [{ "name": flat, "shader": "toon" }, {}, { "name": "b" }] }"#,
        r#"s.json:1:77: a text needs quotes: write "flat""#,
    ),
    (
        r#"{ "mapping": { "atom": "flat" }, "camera": { "fov": .5 } }"#,
        r#"s.json:1:24 (mapping.atom): no shader is called "flat"; allowed: basic, toon, unlit, curvature
s.json:1:53: write 0.5 instead of .5"#,
    ),
    (
        r#"{ "version": 1, "camera": { "zoom": 0 }, 
  "lights": [{ "intensity": -1, }, ],
  "geometry": { "scale": "big", "bond_radius": 2pt }
  "transparency": { k: 2.5, "memory_mb": 1e999, "methd": "auto" },
  "mapping": { "atom": "toon", "post_effects": [dofPost] }"#,
        r#"s.json:1:37 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:2:29 (lights[0].intensity): "intensity" is -1, but must lie in 0 to 1000
s.json:3:26 (geometry.scale): "scale" must be a number, not the text "big"
s.json:3:48: a length with a unit needs quotes: write "2pt"
s.json:4:3: a comma is missing before this key
s.json:4:21: a key needs quotes: write "k"
s.json:4:24 (transparency.k): "k" must be a whole number, 0 or more, not the number 2.5
s.json:4:42: this number is too large
s.json:4:49 (transparency.methd): transparency has no "methd"; did you mean "method"? allowed: method, k, memory_mb
s.json:5:49: a text needs quotes: write "dofPost"
s.json:5:58: the file ends, but the { at 1:1 is not closed: write } at its end"#,
    ),
    (
        r#"{ "camera": { "position": [1, 2, 3} }"#,
        "s.json:1:35: the [ at 1:27 is not closed: write ] before this }",
    ),
    (
        r#"{ "camera": { "zoom": 0 }
  // "mapping": { "atom": "toon" }"#,
        r#"s.json:1:23 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000
s.json:1:25: the file ends, but the { at 1:1 is not closed: write } at its end"#,
    ),
    (
        r#"{ "camera": { "bgcolor": "rgb(1,2,3)" } }"#,
        r##"s.json:1:26 (camera.bgcolor): "bgcolor" is the text "rgb(1,2,3)", which is no colour: write [r, g, b] or [r, g, b, a] in 0 to 255, "#rrggbb" or a CSS name; did you mean "#010203"?"##,
    ),
    (
        r#"{ "camera": { "orient": principal, "zoom": 0 } }"#,
        r#"s.json:1:25: a text needs quotes: write "principal"
s.json:1:44 (camera.zoom): "zoom" is 0, but must lie in 0.01 to 1000"#,
    ),
    (
        r#"{ "camera": { "fov": 1e400, "zoom": -1e400 } }"#,
        r"s.json:1:22: this number is too large
s.json:1:37: this number is too large",
    ),
    (
        r#"{ "camera": { "fov": 30 /* degrees } }
"#,
        "s.json:1:25: this comment is never closed: */ is missing",
    ),
];

/// How often each number of mistakes is told when `damage` is done to each `mark` of five styles, one at a time.
fn mistakes_by_number(mark: char, damage: impl Fn(&str, usize) -> String) -> Vec<usize> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/prost2016");
    let mut numbers = vec![0; 3];
    for name in ["listing1.json", "advertisement.json", "education.json", "scientific.json", "future.json"] {
        let text = std::fs::read_to_string(folder.join(name)).expect("the fixtures are part of the project");
        for (at, _) in text.match_indices(mark) {
            let damaged = damage(&text, at);
            let number = load(&Source::new("s.json", damaged.as_str()), &CATALOG)
                .map_or_else(|mistakes| mistakes.list.len(), |_| 0);
            numbers[number.min(2)] += 1;
        }
    }
    numbers
}

#[test]
fn a_mark_that_is_missing_is_one_mistake() {
    let missing = |mark| mistakes_by_number(mark, |text, at| format!("{}{}", &text[..at], &text[at + 1..]));
    let found: Vec<_> = ['"', ',', ':', '{', '}', '[', ']'].map(missing).into();
    // A comma after the last item may be missing.
    assert_eq!(found, [[0, 262, 0], [3, 84, 0], [0, 93, 0], [0, 36, 0], [0, 36, 0], [0, 20, 0], [0, 20, 0]]);
}

#[test]
fn a_mark_that_is_doubled_is_one_mistake() {
    let doubled = |mark| mistakes_by_number(mark, |text, at| format!("{}{mark}{}", &text[..at], &text[at..]));
    let found: Vec<_> = ['"', ',', ':', '{', '}', '[', ']'].map(doubled).into();
    assert_eq!(found, [[0, 262, 0], [0, 87, 0], [0, 93, 0], [0, 36, 0], [0, 36, 0], [0, 20, 0], [0, 20, 0]]);
}
