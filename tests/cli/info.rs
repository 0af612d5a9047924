//! `restyle info`, and several scenes at once.

use serde_json::{Value as Json, json};

use super::rig::Folder;

/// Two waters, an amino acid's nitrogen, an ion and two atoms of a ligand, in two chains; none is bonded.
const PDB: &str = "\
ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00 20.00           N
HETATM    2  O   HOH A 101      10.000   0.000   0.000  1.00 30.00           O
HETATM    3  O   HOH B 102      20.000   0.000   0.000  1.00 40.50           O
HETATM    4 ZN    ZN B 103      30.000   0.000   0.000  1.00 50.00          ZN
HETATM    5  C1  LIG B 104      40.000   0.000   0.000  1.00  1.00           C
HETATM    6  C2  LIG B 104      43.000   0.000   0.000  1.00  1.00           C
END
";

fn json_of(folder: &Folder, args: &str) -> Json {
    let outcome = folder.run(args).done();
    serde_json::from_str(&outcome.out).unwrap_or_else(|error| panic!("{error}: {outcome:?}"))
}

#[test]
fn a_molecule_is_counted() {
    let folder = Folder::new("info");
    folder.write("m.pdb", PDB);
    let facts = json_of(&folder, "info m.pdb --json");
    assert_eq!((&facts["atoms"], &facts["bonds"], &facts["triangles"]), (&json!(6), &json!(0), &json!(0)));
    assert_eq!(facts["types"], json!(["atom"]));
    assert_eq!(facts["files"][0]["format"], "PDB");
    assert_eq!(facts["elements"], json!({ "C": 2, "O": 2, "N": 1, "Zn": 1 }));
    assert_eq!(facts["residues"]["water"], json!({ "residues": 2, "atoms": 2 }));
    assert_eq!(facts["ligands"], json!({ "LIG": { "residues": 1, "atoms": 2 } }));
    assert_eq!(facts["models"], json!([1]));
    assert_eq!(facts["chains"][1], json!({ "id": "B", "file": "m.pdb", "residues": 3, "atoms": 4 }));
    // Nitrogen's radius on the left, carbon's on the right.
    let bound = |end: &str| facts["bounds"][end][0].as_f64().unwrap();
    assert!((bound("min") + 1.55).abs() < 0.2 && (bound("max") - 44.7).abs() < 0.1, "{facts}");

    let text = folder.run("info m.pdb").done().out;
    for line in [
        "files      m.pdb  PDB",
        "types      atom",
        "atoms      6",
        "residues   protein   1 residue   1 atom",
        "           water    2 residues  2 atoms",
        "chains     A  2 residues  2 atoms",
        "elements   C 2, O 2, N 1, Zn 1",
        "models     1",
    ] {
        assert!(text.lines().any(|found| found.trim_end() == line), "{line}\n{text}");
    }
}

#[test]
fn selectors_can_be_pasted_and_pick_what_they_say() {
    let folder = Folder::new("info-selectors");
    folder.write("m.pdb", PDB);
    let lines = folder.run("info m.pdb --selectors").done().out;
    for line in [
        "\"atom\": \"...\", // 6 atoms",
        "\"atom[chain=B]\": \"...\", // 4 atoms",
        "\"atom[kind=water]\":   \"...\", // 2 residues, 2 atoms",
        "\"atom[residue=LIG]\": \"...\", // 1 residue, 2 atoms",
        "\"atom[element=Zn]\": \"...\", // 1 atom",
    ] {
        let squeezed = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(lines.lines().any(|found| squeezed(found) == squeezed(line)), "{line}\n{lines}");
    }
    let mapping = lines.replace("\"...\"", "\"basic\"");
    folder.write("s.json", format!("{{ \"mapping\": {{\n{mapping}}} }}"));
    let outcome = folder.run("check s.json --scene m.pdb").done();
    assert_eq!((outcome.out.as_str(), outcome.err.as_str()), ("s.json: fine\n", ""));
}

#[test]
fn what_was_mended_is_in_it_and_what_is_wrong_is_refused() {
    let folder = Folder::new("info-bad");
    folder.write("damaged.xyz", "2\n\nC 0 0 0\nC nan 0 0\n");
    assert!(folder.run("info damaged.xyz").done().out.contains("notes      damaged.xyz: 1 atom skipped"));
    folder.run("info nope.xyz").refused(1, "nope.xyz: no such file");
    folder.run("info watr").refused(1, "no molecule or mesh of this name; did you mean \"water\"?");
    folder.run("info").refused(2, "<SCENE>");
    folder.run("info water --json --selectors").refused(2, "--selectors");
}

#[test]
fn several_scenes_are_one() {
    let folder = Folder::new("several");
    folder.write("a.xyz", "1\n\nC 0 0 0\n").write("b.xyz", "2\n\nO 9 0 0\nO 20 0 0\n").write("bad.xyz", "");
    let facts = json_of(&folder, "info a.xyz b.xyz --json");
    assert_eq!((&facts["atoms"], &facts["elements"]), (&json!(3), &json!({ "O": 2, "C": 1 })));
    assert_eq!((&facts["files"][1]["name"], &facts["scenes"]), (&json!("b.xyz"), &json!(["a.xyz", "b.xyz"])));
    let outcome = folder.run("info a.xyz nope.xyz bad.xyz");
    assert_eq!(outcome.code, Some(1));
    let messages = outcome.messages();
    assert!(messages.len() == 2 && messages[0].starts_with("nope.xyz: ") && messages[1].starts_with("bad.xyz: "));

    folder.write("s.json", "{ \"mapping\": { \"atom[file=b.xyz]\": null, \"atom[file=c.xyz]\": null } }");
    let outcome = folder.run("check s.json --scene a.xyz --scene b.xyz").done();
    assert_eq!(outcome.messages().len(), 1);
    assert!(
        outcome.err.contains("\"atom[file=c.xyz]\" matches nothing in this scene; did you mean \"a.xyz\"?"),
        "{outcome:?}"
    );
}

#[test]
fn several_scenes_are_drawn_at_once() {
    let Some(folder) = Folder::with_adapter("drawn-together") else { return };
    folder.write("a.xyz", "1\n\nC 0 0 0\n").write("b.xyz", "3\n\nO 9 0 0\nO nan 0 0\nO 20 0 0\n");
    let outcome = folder.run("render a.xyz b.xyz -o o.png --size 8x8 --samples 1 --json").done();
    let line: Json = serde_json::from_str(&outcome.out).unwrap();
    assert_eq!((&line["spheres"], &line["scenes"]), (&json!(3), &json!(["a.xyz", "b.xyz"])));
    assert!(outcome.err.starts_with("b.xyz: warning: 1 atom skipped"), "{outcome:?}");
    folder.run("render a.xyz b.xyz -o ./b.xyz").refused(2, "./b.xyz: is the scene itself");
    folder.write("s.json", "{ \"mapping\": { \"atom[file=b.xyz]\": null } }");
    let outcome = folder.run("render a.xyz b.xyz -s s.json -o o.png --size 8x8 --samples 1 --json").done();
    let line: Json = serde_json::from_str(&outcome.out).unwrap();
    assert_eq!((&line["spheres"], &line["atoms"]), (&json!(1), &json!(3)));
}
