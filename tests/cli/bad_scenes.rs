//! Molecule files that are wrong: exit code 1, one line with the file, its line where there is one, and a way out.

use super::rig::{Folder, Picture};

#[test]
fn wrong_molecules_are_named_with_their_line() {
    let folder = Folder::new("scenes");
    let atom = "HETATM    1  C1  LIG A   1    ********   0.000   0.000  1.00  0.00           C\n";
    let cases: &[(&str, &[u8], &str)] = &[
        ("empty.xyz", b"", "empty.xyz: is empty"),
        ("empty.pdb", b"", "empty.pdb: is empty"),
        ("blank.pdb", b" \r\n\t \n", "blank.pdb: is empty"),
        ("words.xyz", b"hello\n", "words.xyz:1: found \"hello\" where the number of atoms belongs"),
        ("cut.xyz", b"5\n\nC 0 0 0\n", "cut.xyz:1: announces 5 atoms, but 1 follows"),
        ("huge.xyz", b"4000000000\n\nC 0 0 0\n", "huge.xyz:1: announces 4000000000 atoms, but 1 follows"),
        ("count.xyz", b"99999999999999999999\n\nC 0 0 0\n", "count.xyz:1: found"),
        ("minus.xyz", b"-1\n\nC 0 0 0\n", "minus.xyz:1: the number of atoms is -1"),
        ("none.xyz", b"0\n\n", "none.xyz: holds no atoms"),
        ("nan.xyz", b"1\n\nC nan 0 0\n", "line 3: x = \"nan\""),
        ("inf.xyz", b"1\n\nC 0 -inf 0\n", "line 3: y = \"-inf\""),
        ("far.xyz", b"1\n\nC 0 0 1e31\n", "far.xyz:3: z = \"1e31\" is no position"),
        ("short.xyz", b"1\n\nC 0 0\n", "short.xyz:3: found \"C 0 0\" where an atom belongs"),
        ("nul.xyz", &[0; 1000], "nul.xyz:1: found"),
        ("utf16.xyz", b"\xff\xfe1\0\n\0", "is a text in UTF-16"),
        ("escape.xyz", b"\x1b[31mhello\n", "found \"?[31mhello\""),
        ("cut.pdb", b"ATOM      1  N   THR A   1      17.0", "the line is cut short (line 1)"),
        ("stars.pdb", atom.as_bytes(), "line 1: x = \"********\""),
        ("head.pdb", b"HEADER\nEND\n", "no line begins with ATOM or HETATM"),
        ("noise.pdb", b"\x80\x81\x82\x83\n\xff\xfe", "holds no atoms"),
        ("picture.pdb", b"\x89PNG\r\n\x1a\n", "is a PNG picture"),
        ("style.json", b"{}", "is a JSON file"),
        ("notes.txt", b"hello", "is in no format that is known here"),
    ];
    for (name, content, words) in cases {
        folder.write(name, content);
        let outcome = folder.draw(name).refused(1, words);
        assert!(outcome.err.starts_with(name), "{}", outcome.err);
    }
    folder.draw(".").refused(1, ".: is a folder");
    assert!(!folder.names().contains(&"out.png".to_owned()));
}

#[test]
fn twenty_megabytes_of_nothing_are_refused() {
    let folder = Folder::new("nothing");
    folder.write("spaces.pdb", vec![b' '; 20 << 20]).write("letters.xyz", vec![b'C'; 20 << 20]);
    folder.draw("spaces.pdb").refused(1, "spaces.pdb: is empty");
    folder.draw("letters.xyz").refused(1, "letters.xyz:1: found \"CCCCCCCCCCCCCCCCCCCCCCCC...\"");
}

#[cfg(unix)]
#[test]
fn a_file_without_permission_is_said_to_be_one() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("forbidden");
    folder.write("a.xyz", "1\n\nC 0 0 0\n").write("a.json", "{}");
    for name in ["a.xyz", "a.json"] {
        std::fs::set_permissions(folder.path(name), std::fs::Permissions::from_mode(0o000)).unwrap();
    }
    if std::fs::read(folder.path("a.xyz")).is_ok() {
        let _ = std::io::Write::write_all(&mut std::io::stderr(), b"1 test skipped: root may read every file\n");
        return;
    }
    folder.draw("a.xyz").refused(1, "a.xyz: may not be read");
    folder.draw("c60 -s a.json").refused(1, "a.json: no permission to read this file");
}

#[cfg(unix)]
#[test]
fn links_in_a_circle_lead_nowhere() {
    let folder = Folder::new("circle");
    std::os::unix::fs::symlink("b.xyz", folder.path("a.xyz")).unwrap();
    std::os::unix::fs::symlink("a.xyz", folder.path("b.xyz")).unwrap();
    folder.draw("a.xyz").refused(1, "a.xyz");
    folder.draw("c60 -s a.xyz").refused(1, "a.xyz");
}

#[test]
fn a_flat_scene_seen_from_its_edge_is_told() {
    let Some(folder) = Folder::with_adapter("edge") else { return };
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3 4\n");
    folder.write("turned.json", r#"{ "camera": { "orient": "principal" } }"#);
    let words = "the scene lies flat and is seen from its edge";
    let outcome = folder.draw("flat.obj").done();
    assert!(outcome.messages().iter().any(|line| line.contains(words)), "{:?}", outcome.messages());
    let outcome = folder.draw("flat.obj -s turned.json").done();
    assert!(!outcome.messages().iter().any(|line| line.contains(words)), "{:?}", outcome.messages());
    assert!(Picture::read(&folder, "out.png").num_colors() > 1);
}
