//! Real and damaged files: what each row of the data folder's README promises.
//!
//! The folder lies beside the project. Without it the tests print what they skip; with `RESTYLE_DATA=required` they fail.

use restyle::scene::{LoadOptions, ModelChoice, NoteKind, Scene, SceneError};
use std::path::PathBuf;

use super::outcome::Outcome;

/// A folder of the test data, or `None` if there is none and none is required.
pub fn data(folder: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    let required = std::env::var("RESTYLE_DATA").is_ok_and(|value| value == "required");
    assert!(!required, "{}: no such folder, and RESTYLE_DATA=required", path.display());
    println!("skipped 1 test: there is no {}", path.display());
    None
}

/// A good file: name, atoms of the first model, atoms of all models, bonds of the first model. Alternate locations that
/// are not drawn are not counted; the README counts them.
const MOLECULES: &[(&str, usize, usize, usize)] = &[
    ("1LVZ.pdb", 185, 3700, 185),
    ("1bcu.pdb", 2581 - 7, 2581 - 7, 2404),
    ("1crn.pdb", 327, 327, 337),
    ("1d66.pdb", 1762, 1762, 1828),
    ("1ubq.pdb", 1271, 1271, 1237),
    ("2btv.pdb", 49_061, 49_061, 50_127),
    // One fewer than by distance alone: both oxygens of the last residue, 1.65 angstrom apart.
    ("2buk_assembly_models.pdb", 1430, 85_800, 1449),
    // 23 fewer than by distance alone: pairs 1.4 to 2.0 angstrom apart within and between distorted residues of this old
    // entry, such as ND1 and NE2 of histidines, or C and the next CA.
    ("4hhb.pdb", 4779, 4779, 4611),
    ("7az6.pdb", 3448 - 83, 3448 - 83, 2986),
    ("MOF-5.pdb", 65, 65, 68),
    // Nine atoms stand in the only MODEL, the others after its ENDMDL.
    ("a_structure.pdb", 9, 901 - 57, 6),
    ("acrolein.pdb", 8, 8, 7),
    ("hemo.pdb", 522, 522, 519),
    ("insertion_codes.pdb", 6, 6, 2),
    ("psfgen-output.pdb", 26, 26, 23),
    // A hundred frames with an END after each; waters at the box's faces are written in two halves.
    ("water.pdb", 297, 29_700, 186),
    ("CoCl6.xyz", 7, 7, 6),
    ("anthracene.xyz", 24, 24, 26),
    ("as4o6.xyz", 10, 10, 12),
    ("au_thiol.xyz", 247, 247, 147),
    ("c60.xyz", 60, 60, 90),
    ("caffeine.xyz", 24, 24, 25),
    ("dna.xyz", 698, 698, 751),
    ("methane.xyz", 5, 5, 4),
    ("mg_hcp_288.xyz", 288, 288, 0),
    ("sn2.v000.xyz", 47, 940, 48),
    ("testosterone.xyz", 46, 46, 49),
];

#[rustfmt::skip]
fn bad_files() -> Vec<(&'static str, Outcome<usize>)> {
    use NoteKind as K;
    use Outcome::{Fails, Loads};
    vec![
        ("pdb_all_same_point.pdb", Loads(327, &[K::OddBond, K::Crowded])),
        ("pdb_conect_to_nowhere.pdb", Loads(327, &[K::BadBondRecord, K::BondToNowhere])),
        ("pdb_crlf_bom.pdb", Loads(327, &[])),
        ("pdb_duplicate_serials.pdb", Loads(327, &[K::DuplicateSerial, K::BondToNowhere])),
        ("pdb_empty.pdb", Fails(": is empty; was it saved or downloaded completely?")),
        ("pdb_far_coordinates.pdb", Loads(327, &[])),
        ("pdb_header_only.pdb", Fails(": holds no atoms; no line begins with ATOM or HETATM: download the whole entry")),
        ("pdb_latin1_remark.pdb", Loads(327, &[])),
        ("pdb_lowercase_names.pdb", Loads(327, &[K::LowerCase])),
        ("pdb_model_without_endmdl.pdb", Loads(327, &[K::ModelSkipped, K::ModelMended])),
        ("pdb_nan_stars_blank_coords.pdb", Loads(324, &[K::BadCoordinate])),
        ("pdb_no_element_no_occ.pdb", Loads(327, &[K::ElementGuessed])),
        ("pdb_truncated_mid_line.pdb", Loads(200, &[K::ShortLine])),
        ("pdb_unknown_elements.pdb", Loads(327, &[K::ElementCorrected])),
        ("pymol_odd01.pdb", Loads(18, &[K::ElementGuessed, K::ElementCorrected])),
        ("biopython_header_only.pdb", Fails(": holds no atoms; no line begins with ATOM or HETATM: download the whole entry")),
        ("chemfiles_bad_helium.xyz", Fails(":1: announces 8 atoms, but 4 follow; write 4 if they are all, else the file was cut short")),
        ("xyz_count_2e9.xyz", Fails(":1: announces 2000000000 atoms, but 24 follow; write 24 if they are all, else the file was cut short")),
        ("xyz_count_negative.xyz", Fails(":1: the number of atoms is -24; write how many lines of atoms follow")),
        ("xyz_count_too_small.xyz", Loads(10, &[K::TrailingText])),
        ("xyz_nan_fortran_tabs.xyz", Loads(3, &[K::BadCoordinate])),
        ("xyz_no_comment_line.xyz", Loads(24, &[K::CountMended])),
        ("xyz_symbols_unknown.xyz", Loads(3, &[K::ElementUnknown])),
        ("wrong_ext_cif_as.pdb", Loads(327, &[])),
        ("wrong_ext_png_as.obj", Fails(": is a PNG picture, no molecule and no mesh; molecules are read as mmCIF, PDB, SDF, MOL2, PQR and XYZ, meshes as glTF, OBJ, STL, PLY, OFF and 3MF")),
    ]
}

/// Whether a file is one of those that these tests are about.
fn is_ours(name: &str) -> bool {
    let named = ["pdb_", "xyz_", "wrong_ext"].iter().any(|start| name.starts_with(start));
    named || name.ends_with(".pdb") || name.ends_with(".xyz")
}

/// Every file of a folder that is ours must be in a table.
fn assert_complete(folder: &std::path::Path, table: &[&str]) {
    for entry in std::fs::read_dir(folder).expect("readable") {
        let name = entry.expect("readable").file_name().to_string_lossy().into_owned();
        assert!(!is_ours(&name) || table.contains(&name.as_str()), "{name} is not in the table");
    }
}

#[test]
fn every_real_molecule_has_the_atoms_of_its_row() {
    let Some(folder) = data("molecules") else {
        return;
    };
    assert_complete(&folder, &MOLECULES.iter().map(|row| row.0).collect::<Vec<_>>());
    for &(file, num_first, num_all, num_bonds) in MOLECULES {
        let path = folder.join(file);
        let scene = Scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.molecule.atoms.len(), num_first, "{file}");
        assert_eq!(scene.molecule.bonds.len(), num_bonds, "{file}");
        if num_all != num_first {
            let options = LoadOptions { model: ModelChoice::All, ..LoadOptions::default() };
            let all = Scene::load_with(&path, &options).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(all.molecule.atoms.len(), num_all, "{file}, all models");
        }
    }
}

#[test]
fn every_damaged_file_is_mended_or_refused_as_promised() {
    let Some(folder) = data("bad") else { return };
    let table = bad_files();
    assert_complete(&folder, &table.iter().map(|row| row.0).collect::<Vec<_>>());
    for (file, outcome) in table {
        let path = folder.join(file);
        outcome.check(&path, |scene| scene.molecule.atoms.len(), |_| true);
    }
}

#[test]
fn damaged_coordinates_are_named_with_their_lines() {
    let Some(folder) = data("bad") else { return };
    let scene = Scene::load(&folder.join("pdb_nan_stars_blank_coords.pdb"));
    let report = scene.unwrap_or_else(|error| panic!("{error}")).files[0].report.to_string();
    assert_eq!(
        report,
        "3 atoms skipped: a coordinate is no number (line 278: x = \"nan\"; line 279: x = \"********\"; line 280: y = \"\")\n"
    );
}

#[test]
fn a_model_can_be_chosen() {
    let Some(folder) = data("molecules") else {
        return;
    };
    let load = |model| {
        Scene::load_with(
            &folder.join("1LVZ.pdb"),
            &LoadOptions { model: ModelChoice::Number(model), ..LoadOptions::default() },
        )
    };
    let scene = load(20).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.molecule.atoms.len(), 185);
    assert!(scene.molecule.residues.iter().all(|residue| residue.model == 20));
    let error = load(21).expect_err("there are 20");
    assert!(matches!(error, SceneError::NoSuchModel { .. }));
    assert!(error.to_string().ends_with("has no model 21; it has 20, from 1 to 20"), "{error}");
}

/// Whatever a file is, it gives a scene that can be drawn or one message that names it; never a panic.
#[test]
fn every_file_loads_or_is_refused_with_a_message() {
    let (mut num_loaded, mut num_refused) = (0, 0);
    for folder in ["molecules", "bad", "meshes"] {
        let Some(folder) = data(folder) else { return };
        for entry in std::fs::read_dir(folder).expect("readable") {
            let path = entry.expect("readable").path();
            let is_large = path.metadata().is_ok_and(|metadata| metadata.len() > 8 << 20);
            if !path.is_file() || is_large {
                continue;
            }
            match Scene::load(&path) {
                Ok(scene) => {
                    let sphere = scene.bounding_sphere();
                    assert!(sphere.center.is_finite() && sphere.radius.is_finite(), "{}", path.display());
                    assert!(sphere.radius > 0.0, "{}", path.display());
                    num_loaded += 1;
                }
                Err(error) => {
                    assert!(error.to_string().starts_with(&*path.to_string_lossy()), "{error}");
                    num_refused += 1;
                }
            }
        }
    }
    assert!(num_loaded > 150 && num_refused > 30, "{num_loaded} loaded, {num_refused} refused");
}
