//! Input that is right but extreme: it is drawn, without a panic and without running on.

use super::rig::{Folder, Picture};

#[test]
fn extreme_molecules_are_drawn() {
    let Some(folder) = Folder::with_adapter("molecules") else { return };
    let crowd = format!("10000\n\n{}", "C 0 0 0\n".repeat(10_000));
    let cases: &[(&str, &[u8], &str)] = &[
        ("one", b"1\n\nC 0 0 0\n", ""),
        ("latin1", b"1\ncaf\xe9\nC 0 0 0\n", ""),
        ("bom", b"\xef\xbb\xbf2\r\n\r\nC 0 0 0\r\nC 1.4 0 0\r\n", ""),
        ("nan", b"2\n\nC nan 0 0\nC 0 0 0\n", "1 atom skipped: a coordinate is no number (line 3"),
        ("unknown", b"2\n\nXx 0 0 0\nQq99 1 0 0\n", "2 atoms of unknown element"),
        ("coincident", b"3\n\nC 0 0 0\nO 0 0 0\nC 0 0 0\n", ""),
        ("crowd", crowd.as_bytes(), "too crowded"),
        ("offset", b"2\n\nC 1e9 0 0\nC 1000000001.4 0 0\n", ""),
        ("tiny", b"2\n\nC 0 0 0\nO 1e-9 0 0\n", ""),
        ("wide", b"2\n\nC -1e30 0 0\nO 1e30 0 0\n", "positions are rounded"),
    ];
    for (name, content, note) in cases {
        let file = format!("{name}.xyz");
        let outcome = folder.write(&file, content).draw(&file).done();
        assert_eq!(outcome.err.is_empty(), note.is_empty(), "{name}: {}", outcome.err);
        assert!(outcome.err.contains(note) && outcome.err.lines().count() <= 1, "{name}: {}", outcome.err);
        let picture = Picture::read(&folder, "out.png");
        // Atoms of a few angstrom in a scene of 1e30 are smaller than a pixel.
        assert!(picture.num_colors() > 1 || *name == "wide", "{name} is blank");
    }
    // A name may hold a line break.
    folder.write("a\nb.xyz", "1\n\nC 0 0 0\n");
    folder.run_all(&["render", "a\nb.xyz", "-o", "c\nd.png", "--size", "8x8", "--samples", "1"]).done();
    assert_eq!(Picture::read(&folder, "c\nd.png").info.0, 8);
}

#[test]
fn extreme_styles_are_drawn() {
    let Some(folder) = Folder::with_adapter("extreme") else { return };
    let light = |light: &str| format!(r#"{{"lights":[{light}]}}"#);
    let toon = |properties: &str| {
        format!(r#"{{"mapping":{{"*":"x"}},"shaders":[{{"name":"x","shader":"toon","properties":{{{properties}}}}}]}}"#)
    };
    let twelve = [r#"{"type":"directional","position":[1,2,3],"shadow":"soft"}"#; 12].join(",");
    let selectors: Vec<String> = (0..2000).map(|name| format!(r#""atom[name=n{name}]":"toon""#)).collect();
    let globs = format!(r#"{{"mapping":{{"atom[name={}]":"toon"}}}}"#, "*a".repeat(5000));
    for (name, style) in [
        ("lights", light(&twelve)),
        ("inside", light(r#"{"type":"point","position":[0.1,0,0],"shadow":"soft"}"#)),
        ("centre", light(r#"{"type":"point","position":[0,0,0],"shadow":"hard","range":0}"#)),
        ("far", light(r#"{"type":"point","position":[1e9,0,0],"shadow":"hard"}"#)),
        ("faint", light(r#"{"type":"directional","position":[1e-300,0,0],"shadow":"hard"}"#)),
        ("in an atom", r#"{"camera":{"position":[0,0,0.93],"target":[0,0,0]}}"#.to_owned()),
        ("distant", r#"{"camera":{"position":[0,0,1e9]}}"#.to_owned()),
        ("zoom", r#"{"camera":{"zoom":1000}}"#.to_owned()),
        ("wide", r#"{"camera":{"fov":150}}"#.to_owned()),
        ("up", r#"{"camera":{"up":[0,0,1]}}"#.to_owned()),
        ("exposure", r#"{"camera":{"exposure":10}}"#.to_owned()),
        ("scale", r#"{"geometry":{"scale":100}}"#.to_owned()),
        ("points", r#"{"geometry":{"atom":0,"bond_radius":0}}"#.to_owned()),
        ("hull", toon(r#""hull_size":"1000pt""#)),
        ("hull in radii", toon(r#""hull_size":1000000000"#)),
        ("steps", toon(r#""steps":256"#)),
        ("one step", toon(r#""steps":1"#)),
        ("exponent", toon(r#""exponent":0.01"#)),
        ("steep", toon(r#""exponent":100"#)),
        ("selectors", format!(r#"{{"mapping":{{{}}}}}"#, selectors.join(","))),
        ("globs", globs),
        ("bom", "\u{feff}{\r\n\"version\": 1,\r\n}\r\n".to_owned()),
    ] {
        folder.write("s.json", style);
        let outcome = folder.draw("c60 -s s.json");
        assert_eq!(outcome.code, Some(0), "{name}: {outcome:?}");
        let said = match name {
            "lights" => "12 lights; only the first 8 shine",
            "inside" | "centre" => "a point light within the scene's sphere casts no shadow",
            _ => "",
        };
        assert!(outcome.err.contains(said) && outcome.err.is_empty() == said.is_empty(), "{name}: {}", outcome.err);
    }
}

#[test]
fn a_style_that_hides_everything_leaves_the_background() {
    let Some(folder) = Folder::with_adapter("hidden") else { return };
    folder.write("s.json", r#"{"camera":{"bgcolor":[10,200,30]},"mapping":{"*":null}}"#);
    for samples in [1, 4] {
        folder.run(&format!("render c60 -s s.json -o out.png --size 8x8 --samples {samples}")).done();
        let picture = Picture::read(&folder, "out.png");
        assert!(picture.bytes.chunks_exact(3).all(|pixel| pixel == [10, 200, 30]), "{:?}", &picture.bytes[..3]);
    }
}

#[test]
fn pictures_of_one_pixel_and_one_line_are_drawn() {
    let Some(folder) = Folder::with_adapter("sizes") else { return };
    for (size, shape) in [("1x1", (1, 1)), ("2048x1", (2048, 1)), ("1x2048", (1, 2048))] {
        folder.run(&format!("render c60 -o out.png --samples 1 --size {size}")).done();
        let picture = Picture::read(&folder, "out.png");
        assert_eq!((picture.info.0, picture.info.1), shape);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn scenes_and_styles_may_come_from_a_pipe() {
    use std::io::Write;
    let Some(folder) = Folder::with_adapter("pipes") else { return };
    for (args, content) in [("/dev/stdin", "1\n\nC 0 0 0\n"), ("c60 -s /dev/stdin", "{}")] {
        let (reader, mut writer) = std::io::pipe().unwrap();
        writer.write_all(content.as_bytes()).unwrap();
        drop(writer);
        let args = format!("render {args} -o out.png --size 8x8 --samples 1");
        folder.start(args.split_whitespace(), &[], reader.into(), None).done();
    }
    folder.draw("/dev/stdin").refused(1, "/dev/stdin: is empty");
}
