//! Styles that extend others.

use std::path::PathBuf;

use restyle::config::syntax::MAX_BYTES;
use restyle::config::{ObjectKind, Source, Style, load, load_file, load_with};

use super::catalog::CATALOG;

/// Loads `own` with bases from a table of names and texts.
fn extended(own: &str, bases: &[(&str, &str)]) -> Result<Style, String> {
    let loader = |name: &str, _: &Source| match bases.iter().find(|(of, _)| *of == name) {
        Some((name, text)) => Ok(Source::new(*name, *text)),
        None => Err("there is no such look".to_owned()),
    };
    load_with(&Source::new("own.json", own), &CATALOG, &loader).map_err(|mistakes| mistakes.to_string())
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
        ("{", "base:1:1: the file ends, but the { at 1:1 is not closed: write } at its end"),
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
    let mistakes = load_with(&Source::new("own.json", "{ \"extends\": \"next\" }"), &CATALOG, &loader).unwrap_err();
    assert!(
        mistakes.to_string().ends_with("more than 16 styles extend one another: make the chain shorter"),
        "{mistakes}"
    );
}

#[test]
fn files_are_found_beside_the_file_that_names_them() {
    let folder = std::env::temp_dir().join(format!("restyle_extends_{}", std::process::id()));
    std::fs::create_dir_all(folder.join("bases")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    write("own.json", r#"{ "extends": "bases/one.json" }"#);
    write("bases/one.json", r#"{ "extends": "two.json", "camera": { "zoom": 4 } }"#);
    write("bases/two.json", r#"{ "camera": { "zoom": 2, "fov": 25 } }"#);
    let style = load_file(&folder.join("own.json"), &CATALOG);
    write("bases/two.json", r#"{ "extends": "../bases/../own.json" }"#);
    let circle = load_file(&folder.join("own.json"), &CATALOG).unwrap_err();
    write("bases/two.json", "{ \"camera\": 1 }");
    let lonely = load(&Source::new("look", "{ \"extends\": \"own.json\" }"), &CATALOG).unwrap_err();
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
    // Comparing each with each would take minutes.
    let message = extended(&own, &[("base", &base)]).unwrap_err();
    assert!(message.ends_with(" more"), "{message}");
}

#[test]
fn a_style_without_its_base_is_checked_itself() {
    // What the base might hold is no mistake: the shader of `a`, and what is called `flat`.
    let own = r#"{ "extends": "none", "camera": { "zoom": 0 }, "mapping": { "atom": "flat", "atm": null },
        "shaders": [{ "name": "a", "properties": { "steps": 3 } }, { "name": "b", "shader": "tone" }] }"#;
    assert_eq!(
        extended(own, &[]).unwrap_err(),
        "own.json:1:14 (extends): cannot extend \"none\": there is no such look\n\
         own.json:1:42 (camera.zoom): \"zoom\" is 0, but must lie in 0.01 to 1000\n\
         own.json:1:76 (mapping.atm): selector \"atm\": there is no type \"atm\"; did you mean \"atom\"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects\n\
         own.json:2:93 (shaders[1].shader): no shader is called \"tone\"; did you mean \"toon\"? allowed: basic, toon, unlit, curvature, ssaoPost, dofPost, outlinePost"
    );
}

#[test]
fn every_mistake_of_all_bases_is_said_at_once() {
    let own =
        "{ \"extends\": \"middle\", \"camera\": { \"zoom\": 0 \"fov\": .5 }, \"mapping\": { \"atom\": \"flat\" } }";
    let middle = "{ \"extends\": \"base\", \"lights\": [{ \"strength\": 2 }], \"geometry\": { scale: 0 } }";
    let base = "{ 'camera': { \"exposure\": 50 }, \"shaders\": [{ \"name\": \"flat, \"shader\": \"toon\" }";
    assert_eq!(
        extended(own, &[("middle", middle), ("base", base)]).unwrap_err(),
        "own.json:1:44 (camera.zoom): \"zoom\" is 0, but must lie in 0.01 to 1000\n\
         own.json:1:46: a comma is missing before this key\n\
         own.json:1:53: write 0.5 instead of .5\n\
         middle:1:47 (lights[0].strength): \"strength\" is 2, but must lie in 0 to 1\n\
         middle:1:67: a key needs quotes: write \"scale\"\n\
         middle:1:74 (geometry.scale): \"scale\" is 0, but must lie in 0.001 to 100\n\
         base:1:3: a text stands in straight double quotes: write \"camera\"\n\
         base:1:27 (camera.exposure): \"exposure\" is 50, but must lie in -10 to 10 stops\n\
         base:1:55: this text is not closed: write \"flat\"\n\
         base:1:79: the file ends, but the [ at 1:44 is not closed: write ] at its end"
    );
}

#[test]
fn bases_of_which_nothing_can_be_read_leave_the_style_to_be_checked() {
    let own = r#"{ "extends": "base", "camera": { "zoom": 0 }, "mapping": { "atom": "flat" } }"#;
    let zoom = "own.json:1:42 (camera.zoom): \"zoom\" is 0, but must lie in 0.01 to 1000";
    for (base, message) in [
        ("[7]", "base:1:1: \"style\" must be an object, not a list of 1 value"),
        ("", "base: the file is empty: the smallest style is {}"),
        ("// all of it", "base:1:13: the file holds only comments: the smallest style is {}"),
        ("\u{0}{", "base:1:1: this is not UTF-8 text: save the file as UTF-8"),
        (
            "{ \"version\": 2, \"camra\": {} }",
            "base:1:14 (version): \"version\" is 2, but must be 1: this program reads no other version of style files",
        ),
    ] {
        let said = extended(own, &[("base", base)]).unwrap_err();
        let mut lines: Vec<&str> = said.lines().collect();
        lines.sort_unstable();
        assert_eq!(
            lines,
            {
                let mut due = [zoom, message];
                due.sort_unstable();
                due
            },
            "{base}"
        );
    }
    // A style of which nothing can be read leaves nothing to extend.
    assert_eq!(extended("\u{0}", &[]).unwrap_err(), "own.json:1:1: this is not UTF-8 text: save the file as UTF-8");
    assert_eq!(
        extended("{ \"extends\": base }", &[]).unwrap_err(),
        "own.json:1:14: a text needs quotes: write \"base\""
    );
}

/// A folder for files of one test, which goes with it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("restyle_{name}_{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("the temporary folder takes folders");
        // As the loader sees it, without links.
        Self(folder.canonicalize().expect("it was just made"))
    }

    fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, text).expect("the folder takes files");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn files_that_are_looked_for_are_told_whether_they_are_there_or_not() {
    let folder = Folder::new("looked_for");
    let own = folder.write("own.json", "{ \"extends\": \"middle.json\" }");
    let middle = folder.write("middle.json", "{ \"extends\": \"none.json\" }");
    let mistakes = load_file(&own, &CATALOG).unwrap_err();
    assert_eq!(mistakes.files, [own.clone(), middle, folder.0.join("none.json")]);
    assert!(mistakes.to_string().ends_with("cannot extend \"none.json\": there is no such file"), "{mistakes}");
    let absent = folder.0.join("absent.json");
    assert_eq!(load_file(&absent, &CATALOG).unwrap_err().files, [absent]);
}

#[test]
fn paths_that_are_no_style_files_say_why() {
    let folder = Folder::new("paths");
    std::fs::create_dir(folder.0.join("folder")).unwrap();
    folder.write("empty.json", "");
    let large = std::fs::File::create(folder.0.join("large.json")).unwrap();
    large.set_len(100 << 20).unwrap();
    // With its byte-order mark, a style may be as long as this and no longer.
    let mut longest = b"\xEF\xBB\xBF{}".to_vec();
    longest.resize(MAX_BYTES + 3, b' ');
    folder.write("longest.json", &longest);
    for (base, reason) in [
        ("none.json", "cannot extend \"none.json\": there is no such file"),
        ("empty.json/x.json", "cannot extend \"empty.json/x.json\": a part of this path is a file, not a folder"),
        ("folder", "cannot extend \"folder\": this is a folder, not a style file"),
        ("..", "cannot extend \"..\": this is a folder, not a style file"),
        ("", "cannot extend \"\": the name is empty: write the name of a style file"),
        ("a\\u0000b", "cannot extend \"a\\u{0}b\": no file name can hold the character U+0000: remove it"),
        ("large.json", "cannot extend \"large.json\": a style is at most 16 MB, and this file is larger"),
        ("own.json", "in a circle: "),
        ("./folder/../own.json", "in a circle: "),
        ("empty.json", "empty.json: the file is empty: the smallest style is {}"),
    ] {
        let own = folder.write("own.json", format!("{{ \"extends\": \"{base}\" }}"));
        let mistakes = load_file(&own, &CATALOG).unwrap_err().to_string();
        assert_eq!(mistakes.lines().count(), 1, "{mistakes}");
        assert!(mistakes.contains(reason), "{mistakes}");
    }
    let long = "x".repeat(5000);
    let own = folder.write("own.json", format!("{{ \"extends\": \"{long}\" }}"));
    assert!(load_file(&own, &CATALOG).unwrap_err().to_string().contains("this name is too long"));
    let own = folder.write("own.json", "{ \"extends\": \"longest.json\" }");
    assert!(load_file(&own, &CATALOG).is_ok());
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_never_in_circles() {
    use std::os::unix::fs::symlink;
    let folder = Folder::new("links");
    let own = folder.write("own.json", "{ \"extends\": \"link.json\" }");
    let link = folder.0.join("link.json");
    let said_with_link_to = |target: &str| {
        symlink(target, &link).unwrap();
        let said = load_file(&own, &CATALOG).map_err(|mistakes| mistakes.to_string());
        std::fs::remove_file(&link).unwrap();
        said.map(|style| style.camera.fov)
    };
    folder.write("base.json", "{ \"camera\": { \"fov\": 20 } }");
    assert_eq!(said_with_link_to("base.json"), Ok(20.0));
    assert!(said_with_link_to("own.json").unwrap_err().contains("in a circle"));
    assert!(said_with_link_to("none.json").unwrap_err().ends_with("this is a link to a file that is not there"));
    assert!(said_with_link_to("link.json").unwrap_err().contains("this link cannot be followed"));
}

#[test]
fn a_file_that_never_settles_is_read_all_the_same() {
    use std::io::Write;
    use std::sync::atomic::{AtomicBool, Ordering};
    let folder = Folder::new("unsettled");
    let own = folder.write("own.json", "{}");
    let is_done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let mut file = std::fs::OpenOptions::new().append(true).open(&own).unwrap();
            while !is_done.load(Ordering::Relaxed) {
                file.write_all(b" ").unwrap();
            }
        });
        let loaded: Vec<bool> = (0..20).map(|_| load_file(&own, &CATALOG).is_ok()).collect();
        is_done.store(true, Ordering::Relaxed);
        assert_eq!(loaded, [true; 20]);
    });
}
