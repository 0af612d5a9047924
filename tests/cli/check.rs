//! `restyle check`: what it says of styles, to people and to tools.

use std::process::Stdio;

use serde_json::{Value as Json, json};

use super::rig::{Folder, Outcome};

const WRONG: &str = "{\n  \"camera\": { \"fovv\": 30 },\n  \"mapping\": { \"atom\": \"tooon\" }\n}\n";

fn json_of(outcome: &Outcome) -> Json {
    serde_json::from_str(&outcome.out).unwrap_or_else(|error| panic!("{error}: {outcome:?}"))
}

#[test]
fn every_look_is_fine() {
    let folder = Folder::new("looks");
    for look in ["advertisement", "education", "scientific", "future"] {
        let outcome = folder.run(&format!("check {look} --scene alpha_helix")).done();
        assert!(outcome.out.starts_with(&format!("{look}: fine")), "{outcome:?}");
        assert_eq!(outcome.out.lines().count(), 1);
    }
    let outcome = folder.run("check education scientific").done();
    assert_eq!((outcome.out.as_str(), outcome.err.as_str()), ("education: fine\nscientific: fine\n", ""));
}

#[test]
fn mistakes_are_listed_with_their_lines_and_fail_the_command() {
    let folder = Folder::new("mistakes");
    folder
        .write("wrong.json", WRONG)
        .write("fine.json", "{ \"shaders\": [{ \"name\": \"a\", \"shader\": \"toon\" }] }");
    let outcome = folder.run("check wrong.json fine.json");
    assert_eq!(outcome.code, Some(1));
    assert_eq!(outcome.out, "wrong.json: 2 mistakes\nfine.json: fine, 1 warning\n");
    assert_eq!(
        outcome.err,
        "wrong.json:2:15 (camera.fovv): camera has no \"fovv\"; did you mean \"fov\"? allowed: orthographic, bgcolor, fov, exposure, zoom, orient, position, target, up\n\
         2 |   \"camera\": { \"fovv\": 30 },\n  \
           |               ^^^^^^\n\
         wrong.json:3:24 (mapping.atom): no shader is called \"tooon\"; did you mean \"toon\"? allowed: basic, toon, unlit, curvature\n\
         3 |   \"mapping\": { \"atom\": \"tooon\" }\n  \
           |                        ^^^^^^^\n\
         fine.json:1:25 (shaders[0].name): warning: shader \"a\" draws nothing: name it in mapping, or remove it\n\
         1 | { \"shaders\": [{ \"name\": \"a\", \"shader\": \"toon\" }] }\n  \
           |                         ^^^"
    );
    assert_eq!(outcome.messages().len(), 3);
}

#[test]
fn tools_read_json() {
    let folder = Folder::new("json");
    folder.write("wrong.json", WRONG);
    let outcome = folder.run("check wrong.json scientific --format json");
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(1), ""));
    let allowed = ["orthographic", "bgcolor", "fov", "exposure", "zoom", "orient", "position", "target", "up"];
    let expected = json!([
        {
            "file": "wrong.json",
            "ok": false,
            "mistakes": [
                {
                    "code": "unknown_key", "file": "wrong.json", "path": "camera.fovv",
                    "line": 2, "column": 15, "end_line": 2, "end_column": 21, "start": 16, "end": 22,
                    "message": format!("camera has no \"fovv\"; did you mean \"fov\"? allowed: {}", allowed.join(", ")),
                    "suggestion": "fov", "allowed": allowed,
                },
                {
                    "code": "unknown_name", "file": "wrong.json", "path": "mapping.atom",
                    "line": 3, "column": 24, "end_line": 3, "end_column": 31, "start": 53, "end": 60,
                    "message": "no shader is called \"tooon\"; did you mean \"toon\"? allowed: basic, toon, unlit, curvature",
                    "suggestion": "toon", "allowed": ["basic", "toon", "unlit", "curvature"],
                },
            ],
            "warnings": [],
            "unlisted": 0,
            "unlisted_warnings": 0,
        },
        { "file": "scientific", "ok": true, "mistakes": [], "warnings": [], "unlisted": 0, "unlisted_warnings": 0 },
    ]);
    assert_eq!(json_of(&outcome), expected);

    // A value over several lines, a file as a whole, and a name that nothing has.
    folder.write("lines.json", "{ \"camera\": [\n\n] }").write("empty.json", "");
    let document = json_of(&folder.run("check lines.json empty.json educaton --format json"));
    let mistake = |file: usize| &document[file]["mistakes"][0];
    assert_eq!(
        (&mistake(0)["line"], &mistake(0)["end_line"], &mistake(0)["end_column"]),
        (&json!(1), &json!(3), &json!(2))
    );
    assert_eq!((&mistake(1)["line"], &mistake(1)["start"]), (&Json::Null, &Json::Null));
    assert_eq!((&mistake(2)["code"], &mistake(2)["file"]), (&json!("unreadable"), &json!("educaton")));
}

#[test]
fn help_describes_every_key_of_the_json() {
    let folder = Folder::new("keys");
    folder.write("wrong.json", WRONG);
    let help = folder.run("check --help").done().out;
    let document = json_of(&folder.run("check wrong.json --format json"));
    let keys = |object: &Json| object.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    for key in [keys(&document[0]), keys(&document[0]["mistakes"][0])].concat() {
        assert!(
            help.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == key),
            "{key} is not in {help}"
        );
    }
}

#[test]
fn mistakes_of_bases_are_told_at_their_place() {
    let folder = Folder::new("bases");
    folder.write("base.json", "{\n \"camera\": { \"fov\": 0 } }");
    folder.write("own.json", "{ \"extends\": \"base.json\", \"camera\": { \"zoom\": 0 } }");
    let outcome = folder.run("check own.json");
    let lines: Vec<&str> = outcome.err.lines().collect();
    assert!(
        lines[0].starts_with("own.json:1:47 (camera.zoom)") && lines[1].ends_with("{ \"zoom\": 0 } }"),
        "{lines:?}"
    );
    assert!(lines[3].starts_with("base.json:2:21 (camera.fov)"), "{lines:?}");
    assert_eq!(&lines[4..], ["2 |  \"camera\": { \"fov\": 0 } }", "  |                     ^"]);
    assert_eq!(outcome.out, "own.json: 2 mistakes\n");
}

#[test]
fn a_scene_tells_more() {
    let folder = Folder::new("scene");
    let style = r#"{ "mapping": { "atom": "a" }, "shaders": [{ "name": "a", "shader": "toon", "properties": { "hull_size": 0.45 } }] }"#;
    folder.write("wide.json", style);
    folder.run("check wide.json").done();
    let outcome = folder.run("check wide.json --scene water").done();
    assert!(
        outcome.err.starts_with("wide.json:1:105 (shaders[0].properties.hull_size): warning: the outline is "),
        "{outcome:?}"
    );
    assert_eq!(outcome.out, "wide.json: fine, 1 warning\n");
    folder.run("check wide.json --scene watr").refused(1, "no molecule or mesh of this name; did you mean \"water\"?");
    folder.run("check wide.json --scene nope.pdb").refused(1, "nope.pdb: no such file");
    folder.write("damaged.xyz", "2\n\nC 0 0 0\nC nan 0 0\n");
    let outcome = folder.run("check scientific --scene damaged.xyz --format json").done();
    assert!(outcome.err.starts_with("damaged.xyz: warning: "), "{outcome:?}");
    json_of(&outcome);
}

#[test]
fn explanations_have_origins() {
    let folder = Folder::new("explain");
    folder.write("base.json", "{ \"camera\": { \"fov\": 20, \"zoom\": 2 } }");
    folder.write("own.json", "{ \"extends\": \"base.json\",\n  \"camera\": { \"fov\": 30 } }");
    let outcome = folder.run("check own.json --explain").done();
    assert!(
        outcome.out.starts_with("own.json: fine\ncamera\n  orthographic  false       default\n"),
        "{}",
        outcome.out
    );
    assert!(
        outcome.out.contains("  fov           30 degrees  own.json:2:22, over base.json:1:22\n"),
        "{}",
        outcome.out
    );
    assert!(outcome.out.contains("  zoom          2           base.json:1:34\n"), "{}", outcome.out);
    let document = json_of(&folder.run("check own.json --explain --format json").done());
    let expected = json!({ "file": "base.json", "line": 1, "column": 22 });
    assert_eq!(document[0]["explain"]["camera"]["fov"]["over"], expected);
    // What does not load comes to nothing.
    folder.write("wrong.json", WRONG);
    let outcome = folder.run("check wrong.json --explain");
    assert_eq!((outcome.code, outcome.out.as_str()), (Some(1), "wrong.json: 2 mistakes\n"));
}

#[test]
fn colours_come_only_on_request() {
    let folder = Folder::new("colours");
    folder.write("wrong.json", WRONG);
    let colored = |env: &[(&str, &str)], command: &str| {
        let outcome = folder.start(command.split(' '), env, Stdio::null(), None);
        assert_eq!(outcome.code, Some(1), "{outcome:?}");
        outcome.err.contains("\u{1b}[")
    };
    for command in ["check wrong.json", "render c60 -s wrong.json -o a.png", "gallery c60 -s wrong.json"] {
        assert!(!colored(&[("NO_COLOR", ""), ("CLICOLOR_FORCE", "")], command), "{command}");
        assert!(!colored(&[("NO_COLOR", ""), ("CLICOLOR_FORCE", "0")], command), "{command}");
        assert!(colored(&[("NO_COLOR", ""), ("CLICOLOR_FORCE", "1")], command), "{command}");
        assert!(!colored(&[("NO_COLOR", "1"), ("CLICOLOR_FORCE", "1")], command), "{command}");
    }
    // A file's own colours are obeyed never.
    folder.write("wrong.json", "{ \"a\": 1, /* \u{1b}[35m\u{9b}35m */ \"b\": 2 }");
    for force in ["", "1"] {
        let outcome = folder.start(
            ["check", "wrong.json"].into_iter(),
            &[("NO_COLOR", ""), ("CLICOLOR_FORCE", force)],
            Stdio::null(),
            None,
        );
        assert!(outcome.err.contains("[35m") && !outcome.err.contains("\u{1b}[35m"), "{outcome:?}");
        assert!(!outcome.err.contains('\u{9b}'), "{outcome:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = Folder::new("pipe");
    folder.write("wrong.json", WRONG);
    for (args, code) in
        [("check education --explain", 0), ("check education --explain --format json", 0), ("check wrong.json", 1)]
    {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let outcome = folder.start(args.split(' '), &[], Stdio::null(), Some(writer.into()));
        assert_eq!(outcome.code, Some(code), "{outcome:?}");
        assert!(!outcome.err.contains("panicked") && !outcome.err.contains("written"), "{outcome:?}");
    }
}

#[test]
fn a_hundred_thousand_mistakes_stay_bounded() {
    let folder = Folder::new("many");
    let keys: Vec<String> = (0..100_000).map(|key| format!("\"k{key}\":1")).collect();
    let entries: Vec<String> = (0..100_000).map(|i| format!("{{\"name\":\"n{i}\",\"shader\":\"toon\"}}")).collect();
    folder.write("keys.json", format!("{{{}}}", keys.join(",")));
    folder.write("unused.json", format!("{{\"shaders\":[{}]}}", entries.join(",")));
    let outcome = folder.run("check keys.json unused.json");
    assert_eq!(
        (outcome.code, outcome.out.as_str()),
        (Some(1), "keys.json: 100000 mistakes\nunused.json: fine, 100000 warnings\n")
    );
    let messages = outcome.messages();
    assert_eq!((messages.len(), messages[100], messages[201]), (202, "and 99900 more", "and 99900 more warnings"));
    assert!(outcome.err.len() < 200_000, "{} bytes", outcome.err.len());
    let document = json_of(&folder.run("check keys.json unused.json --format json"));
    assert_eq!(document[0]["mistakes"].as_array().unwrap().len(), 100);
    assert_eq!((&document[0]["unlisted"], &document[1]["unlisted_warnings"]), (&json!(99_900), &json!(99_900)));
}

#[test]
fn names_of_files_cannot_steer_a_terminal() {
    let folder = Folder::new("steer");
    let name = "a\u{1b}[31m.json";
    folder.write(name, "{}");
    let outcome = folder.run_all(&["check", name, "--explain"]).done();
    assert!(outcome.out.starts_with("a?[31m.json: fine\n") && !outcome.out.contains('\u{1b}'), "{outcome:?}");
    folder.run("check").refused(2, "<STYLE>...");
    folder.run("check c60 --format xml").refused(2, "[possible values: text, json]");
}
