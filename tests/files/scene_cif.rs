//! Real and damaged CIF and BinaryCIF files: what each row of the data folder's README promises.
//!
//! The folder lies beside the project. Without it the tests print what they skip; with `RESTYLE_DATA=required` they fail.

use restyle::scene::{LoadOptions, ModelChoice, NoteKind, Scene, SceneError};
use std::path::PathBuf;

use super::outcome::Outcome;

/// A file of the test data, or `None` if there is none and none is required.
fn data(file: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(file);
    if path.is_file() {
        return Some(path);
    }
    let required = std::env::var("RESTYLE_DATA").is_ok_and(|value| value == "required");
    assert!(!required, "{}: no such file, and RESTYLE_DATA=required", path.display());
    println!("skipped a check: there is no {}", path.display());
    None
}

fn load(path: &std::path::Path, model: ModelChoice, assembly: Option<&str>) -> Result<Scene, SceneError> {
    Scene::load_with(path, &LoadOptions { model, assembly: assembly.map(str::to_string) })
}

/// A good file: name, atoms of the first model, atoms of all models, chains, bonds of the first model. Alternate locations
/// that are not drawn are not counted; the README counts them.
const MOLECULES: &[(&str, usize, usize, usize, usize)] = &[
    ("1544173.cif", 50, 50, 1, 53),
    ("1bna.cif", 566, 566, 2, 544),
    ("1cbs_full.bcif", 1213, 1213, 1, 1129),
    ("1crn.cif", 327, 327, 1, 337),
    ("1ema.cif", 1866, 1866, 1, 1815),
    ("1grm_updated.cif", 272, 1360, 2, 286),
    ("1j8k.cif", 1402, 28_040, 1, 1418),
    ("1rb8_assembly.cif", 306_720, 306_720, 240, 314_940),
    ("1ubq.cif", 660, 660, 1, 608),
    ("3nig.cif", 22_226 - 40, 22_226 - 40, 12, 21_562),
    ("4hhb.cif", 4779, 4779, 4, 4608),
    ("4v5a.cif", 290_487, 290_487, 112, 315_323),
    ("Fe2O3_mp-715572_conventional_standard.cif", 80, 80, 1, 126),
    ("Zr-UiO-66-pressure.cif", 9, 27, 1, 2),
];

#[test]
fn every_real_file_has_the_atoms_of_its_row() {
    for &(file, num_first, num_all, num_chains, num_bonds) in MOLECULES {
        let Some(path) = data(&format!("molecules/{file}")) else { continue };
        let molecule = load(&path, ModelChoice::First, None).unwrap_or_else(|error| panic!("{error}")).molecule;
        let found = (molecule.atoms.len(), molecule.chains.len(), molecule.bonds.len());
        assert_eq!(found, (num_first, num_chains, num_bonds), "{file}");
        assert!(molecule.atoms.iter().all(|atom| atom.element.is_known()), "{file}");
        if num_all != num_first {
            let all = load(&path, ModelChoice::All, None).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(all.molecule.atoms.len(), num_all, "{file}, all models");
        }
    }
}

#[test]
fn chains_residues_and_atoms_have_the_names_that_authors_gave() {
    if let Some(path) = data("molecules/4v5a.cif") {
        let molecule = load(&path, ModelChoice::First, None).unwrap_or_else(|error| panic!("{error}")).molecule;
        assert_eq!(molecule.chains[0].id, "AA");
        let first = &molecule.atoms[0];
        assert_eq!((first.name.as_str(), molecule.residue(first).number), ("O5'", 5));
    }
    if let Some(path) = data("molecules/1rb8_assembly.cif") {
        let molecule = load(&path, ModelChoice::First, None).unwrap_or_else(|error| panic!("{error}")).molecule;
        assert!(molecule.chains.iter().any(|chain| chain.id == "F-60"));
    }
}

#[test]
fn text_and_pdb_file_of_one_entry_are_equal() {
    for (cif, pdb) in [("1crn.cif", "1crn.pdb"), ("4hhb.cif", "4hhb.pdb")] {
        let paths = [cif, pdb].map(|file| data(&format!("molecules/{file}")));
        let [Some(cif), Some(pdb)] = paths else { continue };
        let [cif, pdb] = [cif, pdb]
            .map(|path| load(&path, ModelChoice::First, None).unwrap_or_else(|error| panic!("{error}")).molecule);
        assert_eq!(cif.atoms.len(), pdb.atoms.len());
        let place = |molecule: &restyle::scene::Molecule, index: usize| {
            (molecule.atoms[index].position.as_dvec3() + molecule.origin, molecule.atoms[index].name)
        };
        let misfits = (0..cif.atoms.len()).filter(|&index| {
            let ((a, name_a), (b, name_b)) = (place(&cif, index), place(&pdb, index));
            a.distance(b) > 1e-3 || name_a != name_b
        });
        assert_eq!(misfits.count(), 0);
    }
}

#[test]
fn models_are_chosen_by_their_number() {
    let Some(path) = data("molecules/1j8k.cif") else { return };
    let scene = load(&path, ModelChoice::Number(20), None).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.molecule.atoms.len(), 1402);
    assert!(scene.molecule.residues.iter().all(|residue| residue.model == 20));
    assert_eq!(scene.files[0].report.count(NoteKind::ModelSkipped), 19);
    let error = load(&path, ModelChoice::Number(21), None).expect_err("there are 20").to_string();
    assert!(error.ends_with("has no model 21; it has 20, from 1 to 20"), "{error}");
}

#[test]
fn assemblies_are_drawn_on_request() {
    for (file, num_copies) in
        [("1crn.cif", 1), ("1ubq.cif", 1), ("3nig.cif", 1), ("4hhb.cif", 1), ("1ema.cif", 1), ("1cbs_full.bcif", 1)]
    {
        let Some(path) = data(&format!("molecules/{file}")) else { continue };
        let plain = load(&path, ModelChoice::First, None).unwrap_or_else(|error| panic!("{error}")).molecule;
        assert_eq!(plain.copies.len(), 0, "{file}");
        match load(&path, ModelChoice::First, Some("1")) {
            Ok(scene) => {
                assert_eq!(scene.molecule.copies.len(), num_copies, "{file}");
                assert_eq!(scene.molecule.atoms.len(), plain.atoms.len(), "{file}");
            }
            Err(error) => panic!("{error}"),
        }
        let error = load(&path, ModelChoice::First, Some("no")).expect_err("there is none").to_string();
        assert!(error.contains(": has no assembly no; it has 1"), "{error}");
    }
}

/// Bonds that a crystal's list cannot show are there once its cell is filled; counts are those of the formula.
#[test]
fn unit_cells_are_filled_on_request() {
    for (file, num_atoms) in
        [("1544173.cif", 100), ("Fe2O3_mp-715572_conventional_standard.cif", 80), ("Zr-UiO-66-pressure.cif", 456)]
    {
        let Some(path) = data(&format!("molecules/{file}")) else { continue };
        let scene = load(&path, ModelChoice::First, Some("cell")).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.molecule.atoms.len(), num_atoms, "{file}");
        let error = load(&path, ModelChoice::First, Some("2")).expect_err("there is none").to_string();
        assert!(error.ends_with("has no assembly 2; it has cell"), "{error}");
    }
}

/// The distance that the file itself states: O1 to C1, 1.4253 angstrom in a monoclinic cell.
#[test]
fn fractional_coordinates_give_the_bond_lengths_of_the_file() {
    let Some(path) = data("molecules/1544173.cif") else { return };
    let molecule = load(&path, ModelChoice::First, None).unwrap_or_else(|error| panic!("{error}")).molecule;
    let atom = |name: &str| molecule.atoms.iter().find(|atom| atom.name.as_str() == name).expect("named");
    for (a, b, length) in [("O1", "C1", 1.4253), ("O1", "H1", 0.84), ("O7'", "C7'", 1.3744)] {
        let found = atom(a).position.distance(atom(b).position);
        assert!((found - length).abs() < 0.001, "{a}-{b}: {found}");
    }
}

#[rustfmt::skip]
fn bad_files() -> Vec<(&'static str, Outcome<usize>)> {
    use NoteKind as K;
    use Outcome::{Fails, Loads};
    vec![
        ("bcif_array_claims_4e9.bcif", Fails(": byte 17: a list announces more entries than the file has bytes left; download or save the file again")),
        ("bcif_deep_nesting.bcif", Fails(": byte 33: values are nested deeper than in any BinaryCIF file; download or save the file again")),
        ("bcif_truncated.bcif", Fails(": byte 33425: the file ends within a value; download or save the file again")),
        ("cif_empty_loop.cif", Fails(": holds no atoms; there is no row in a table _atom_site: download the whole entry")),
        ("cif_no_coords.cif", Fails(":542: the table of atoms has no column Cartn_z; save or download the file with coordinates")),
        ("cif_question_coords.cif", Loads(307, &[K::BadCoordinate, K::BondToNowhere])),
        ("cif_row_short.cif", Loads(326, &[K::BadRow])),
        ("cif_truncated.cif", Loads(100, &[K::BadRow, K::BondToNowhere])),
        ("cif_unterminated_quote.cif", Loads(327, &[K::OpenQuote])),
        ("cif_unterminated_text.cif", Fails(": holds no atoms; the text that begins in line 543 is never closed: write a line ; behind it")),
        ("wrong_ext_cif_as.pdb", Loads(327, &[])),
    ]
}

#[test]
fn every_damaged_file_is_mended_or_refused_as_promised() {
    for (file, outcome) in bad_files() {
        let Some(path) = data(&format!("bad/{file}")) else { continue };
        outcome.check(&path, |scene| scene.molecule.atoms.len(), |_| true);
    }
}

/// No row of the short file may have taken values of its neighbours.
#[test]
fn a_short_row_leaves_all_other_atoms_where_they_were() {
    let (Some(good), Some(bad)) = (data("molecules/1crn.cif"), data("bad/cif_row_short.cif")) else { return };
    let [good, bad] = [good, bad].map(|path| Scene::load(&path).unwrap_or_else(|error| panic!("{error}")).molecule);
    let places = |molecule: &restyle::scene::Molecule| -> Vec<glam::DVec3> {
        molecule.atoms.iter().map(|atom| atom.position.as_dvec3() + molecule.origin).collect()
    };
    let (mut good, bad) = (places(&good), places(&bad));
    good.remove(10);
    assert!(good.iter().zip(&bad).all(|(a, b)| a.distance(*b) < 1e-4));
}
