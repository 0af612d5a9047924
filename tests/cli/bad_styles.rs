//! Style files that are wrong: exit code 1, one line with file, line and column, and the source line below.

use super::rig::Folder;

#[test]
fn wrong_styles_are_named_with_their_place() {
    let folder = Folder::new("styles");
    let deep = "[".repeat(200_000);
    let objects = format!("{{\"$schema\":{}", "{\"a\":".repeat(100_000));
    let comment = "/* ".repeat(500_000);
    let cases: &[(&[u8], &str)] = &[
        (b"", "s.json: the file is empty"),
        (b" \n\n", "s.json: the file is empty"),
        (b"[]", "s.json:1:1: \"style\" must be an object, not an empty list"),
        (b"null", "s.json:1:1: \"style\" must be an object, not null"),
        (b"{\"mapping\": {\"atom\": \"toon\"", "s.json:1:27: the file ends, but the { at 1:13 is not closed"),
        (b"{\n\"camera\": {\"fov\": NaN}}", "s.json:2:19: NaN is no number"),
        (b"{\"camera\":{\"fov\":1e999}}", "s.json:1:18: this number is too large"),
        (b"{\"camera\":{\"zoom\":1e300}}", "\"zoom\" is 1e300, but must lie in 0.01 to 1000"),
        (b"{\"$schema\": \"\xe9\"}", "s.json:1:14: this is not UTF-8 text"),
        (b"\xff\xfe{\0}\0", "s.json:1:1: this is not UTF-8 text"),
        (b"{\"camra\":{}}", "did you mean \"camera\"?"),
        (b"{\"a\\u001b[31m\\nb\":1}", "s.json:1:2"),
        (b"{\"version\":2}", "s.json:1:12 (version)"),
        (b"{\"extends\":\"s.json\"}", "extend one another in a circle"),
        (b"{\"extends\":\"nope.json\"}", "cannot extend \"nope.json\": there is no such file"),
        (b"{\"extends\":\"eduction\"}", "no shipped look of this name; did you mean \"education\"?"),
        (b"{\"extends\":\".\"}", "this is a folder"),
        (b"{\"extends\":\"a\\u0000b\"}", "cannot extend"),
        (b"{\"mapping\":{\"atom[element=\":\"toon\"}}", "] is missing"),
        (b"{\"mapping\":{\"atom\":\"tooon\"}}", "did you mean \"toon\"?"),
        (b"{\"geometry\":{\"scale\":0}}", "\"scale\" is 0, but must lie in"),
        (b"{\"camera\":{\"up\":[0,0,0]}}", "\"up\" is no direction"),
        (deep.as_bytes(), "s.json:1:65: lists and objects are nested deeper than 64 levels"),
        (objects.as_bytes(), "nested deeper than 64 levels"),
        (comment.as_bytes(), "this comment is never closed"),
    ];
    for (text, words) in cases {
        folder.write("s.json", text);
        let outcome = folder.draw("c60 -s s.json").refused(1, words);
        assert!(outcome.err.starts_with("s.json:"), "{}", outcome.err);
    }
    folder.draw("c60 -s .").refused(1, ".: this is a folder");
    assert_eq!(folder.names(), ["s.json"]);
}

#[test]
fn a_style_of_17_megabytes_and_100_000_mistakes_stay_bounded() {
    let folder = Folder::new("large");
    folder.write("s.json", format!("{{\"version\":1}}{}", " ".repeat(17 << 20)));
    folder.draw("c60 -s s.json").refused(1, "a style is at most 16 MB");
    let keys: Vec<String> = (0..100_000).map(|key| format!("\"k{key}\":1")).collect();
    folder.write("s.json", format!("{{{}}}", keys.join(",")));
    let outcome = folder.draw("c60 -s s.json");
    assert_eq!(outcome.code, Some(1));
    assert_eq!(outcome.messages().len(), 101);
    assert!(outcome.err.len() < 100_000, "{} bytes", outcome.err.len());
    assert!(outcome.err.ends_with("and 99900 more"), "{}", outcome.err);
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_nowhere_is_no_missing_file() {
    let folder = Folder::new("links");
    std::os::unix::fs::symlink("b.json", folder.path("a.json")).unwrap();
    folder.run("check a.json").refused(1, "a.json: this is a link to a file that is not there");
    std::os::unix::fs::symlink("a.json", folder.path("b.json")).unwrap();
    folder.run("check a.json").refused(1, "a.json: this link cannot be followed");
}
