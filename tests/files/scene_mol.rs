//! Real and damaged files of SDF, MOL, MOL2 and PQR, assemblies of PDB files, and bonds of solids.

use super::outcome::Outcome;
use super::scene_data::data;
use restyle::scene::{LoadOptions, ModelChoice, Molecule, NoteKind, Scene, SceneError};
use std::collections::BTreeMap;

/// File; atoms, bonds and multiple bonds of the first model; atoms of all models.
const MOLECULES: &[(&str, [usize; 3], usize)] = &[
    ("aspirin.sdf", [21, 21, 5], 21),
    ("kinases.sdf", [47, 50, 11], 328),
    ("small01.mol", [36, 37, 3], 36),
    ("v3000.sdf", [12, 12, 3], 12),
    // Aromatic bonds in turn: two benzenes, pyridine and pyrimidine with three double bonds each, and one C=O.
    ("imatinib.mol2", [68, 72, 13], 68),
    ("li.mol2", [1, 0, 0], 1),
    // Crambin with its hydrogens: 337 bonds between heavy atoms, as in the PDB file, and one for each of 315 hydrogens.
    ("1crn_apbs.pqr", [642, 337 + 315, 62], 642),
];

#[rustfmt::skip]
const BAD: &[(&str, Outcome<(usize, usize)>)] = &[
    ("bad-atom-line.sdf", Outcome::Fails(":5: found \"3.7320   -0.0600\" where an atom belongs; write x, y, z and its symbol")),
    ("count-line-too-short.sdf", Outcome::Fails(": holds no atoms; its counts announce none: export the molecule anew")),
    ("mol2_bond_out_of_range.mol2", Outcome::Loads((68, 72), &[NoteKind::ElementGuessed, NoteKind::BondToNowhere, NoteKind::CountMended])),
    ("mol2_truncated.mol2", Outcome::Fails(":3: announces 68 atoms, but 29 follow; write 29 if they are all, else the file was cut short")),
    ("sdf_bond_to_missing_atom.sdf", Outcome::Loads((21, 20), &[NoteKind::BondToNowhere])),
    ("sdf_counts_999.sdf", Outcome::Fails(":4: announces 999 atoms, but 21 follow; write 21 if they are all, else the file was cut short")),
    ("sdf_counts_negative.sdf", Outcome::Fails(":4: the number of atoms is -1; write how many lines of atoms follow")),
    ("sdf_crlf_no_end.sdf", Outcome::Loads((21, 21), &[])),
    ("sdf_truncated.sdf", Outcome::Fails(":4: announces 21 atoms, but 8 follow; write 8 if they are all, else the file was cut short")),
    ("sdf_v3000_counts_too_big.sdf", Outcome::Fails(":6: announces 2000000000 atoms, but 12 follow; write 12 if they are all, else the file was cut short")),
    ("sdf_v3000_no_end_atom.sdf", Outcome::Fails(":6: announces 12 bonds, but 0 follow; write 0 if they are all, else the file was cut short")),
];

/// Every file of a folder with one of our extensions is in the table.
fn assert_complete(folder: &std::path::Path, table: &[&str]) {
    for entry in std::fs::read_dir(folder).expect("readable") {
        let path = entry.expect("readable").path();
        let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let is_ours = ["sdf", "mol", "mol2", "pqr"].contains(&extension.as_str());
        assert!(!is_ours || table.contains(&name.as_str()), "{name} is not in the table");
    }
}

#[test]
fn every_real_table_has_the_atoms_and_bonds_of_its_row() {
    let Some(folder) = data("molecules") else { return };
    assert_complete(&folder, &MOLECULES.iter().map(|row| row.0).collect::<Vec<_>>());
    for &(file, expected, num_all) in MOLECULES {
        let molecule = Scene::load(&folder.join(file)).unwrap_or_else(|error| panic!("{error}")).molecule;
        let num_multiple = molecule.bonds.iter().filter(|bond| bond.order > 1).count();
        assert_eq!([molecule.atoms.len(), molecule.bonds.len(), num_multiple], expected, "{file}");
        let options = LoadOptions { model: ModelChoice::All, ..LoadOptions::default() };
        let all = Scene::load_with(&folder.join(file), &options).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(all.molecule.atoms.len(), num_all, "{file}, all models");
    }
}

#[test]
fn every_damaged_table_is_mended_or_refused() {
    let Some(folder) = data("bad") else { return };
    assert_complete(&folder, &BAD.iter().map(|row| row.0).collect::<Vec<_>>());
    for (file, outcome) in BAD {
        let path = folder.join(file);
        outcome.check(&path, |scene| (scene.molecule.atoms.len(), scene.molecule.bonds.len()), |_| true);
    }
}

#[test]
fn charges_names_and_residues_are_those_of_the_files() {
    let Some(folder) = data("molecules") else { return };
    let load = |file: &str| Scene::load(&folder.join(file)).unwrap_or_else(|error| panic!("{error}")).molecule;
    let benzene = load("v3000.sdf");
    let charges: Vec<f32> = benzene.atoms.iter().map(|atom| atom.charge).collect();
    assert_eq!((charges[0], charges[5], charges.iter().map(|charge| charge.abs()).sum::<f32>()), (-1.0, 1.0, 2.0));
    let imatinib = load("imatinib.mol2");
    assert_eq!((imatinib.atoms[0].charge, imatinib.residues[0].name.as_str()), (-0.5741, "LIG"));
    let crambin = load("1crn_apbs.pqr");
    assert_eq!((crambin.atoms[0].charge, crambin.residues.len()), (-0.32, 46));
    assert!(crambin.residues.iter().all(|residue| residue.kind.name() == "protein"));
}

fn load_assembly(file: &std::path::Path, assembly: &str) -> Result<Scene, SceneError> {
    let options = LoadOptions { assembly: Some(assembly.to_string()), ..LoadOptions::default() };
    Scene::load_with(file, &options)
}

#[test]
fn the_bluetongue_core_has_sixty_copies_around_its_centre() {
    let Some(folder) = data("molecules") else { return };
    let file = folder.join("2btv.pdb");
    let molecule = load_assembly(&file, "1").unwrap_or_else(|error| panic!("{error}")).molecule;
    assert_eq!((molecule.atoms.len(), molecule.copies.len()), (49_061, 60));
    assert!(molecule.copies.iter().all(|copy| copy.atoms.first() == Some(&(0..49_061))));
    assert_eq!(molecule.drawn_balls().count(), 2_943_660);
    // The core is 700 angstrom wide, and its symmetry puts as much on one side as on the other.
    let sphere = molecule.bounding_sphere();
    assert!((340.0..370.0).contains(&sphere.radius), "{sphere:?}");
    let sum = molecule.drawn_balls().fold(glam::DVec3::ZERO, |sum, (center, _)| sum + center.as_dvec3());
    let middle = sum / 2_943_660.0 - sphere.center.as_dvec3();
    assert!(middle.length() < 0.5, "{middle}");
    let error = load_assembly(&file, "2").expect_err("there is one");
    assert!(matches!(error, SceneError::NoSuchAssembly { .. }));
    assert!(error.to_string().ends_with("2btv.pdb: has no assembly 2; it has only 1"), "{error}");
    // Without the option the deposited coordinates.
    assert!(Scene::load(&file).unwrap_or_else(|error| panic!("{error}")).molecule.copies.is_empty());
}

#[test]
fn assemblies_count_only_atoms_that_are_drawn() {
    let Some(folder) = data("molecules") else { return };
    let molecule = load_assembly(&folder.join("7az6.pdb"), "1").unwrap_or_else(|error| panic!("{error}")).molecule;
    // 83 alternate positions are left out.
    assert_eq!((molecule.copies.len(), molecule.drawn_balls().count()), (2, 2 * (3448 - 83)));
}

/// How many bonds join which two elements, in alphabetical order.
fn bond_kinds(molecule: &Molecule) -> BTreeMap<String, usize> {
    let mut kinds = BTreeMap::new();
    for bond in &molecule.bonds {
        let mut symbols = [bond.a, bond.b].map(|end| molecule.atoms[end as usize].element.symbol());
        symbols.sort_unstable();
        *kinds.entry(symbols.join("-")).or_insert(0) += 1;
    }
    kinds
}

#[test]
fn solids_and_metals_have_the_bonds_that_chemists_draw() {
    let Some(folder) = data("molecules") else { return };
    let kinds = |file: &str| bond_kinds(&Scene::load(&folder.join(file)).unwrap_or_else(|e| panic!("{e}")).molecule);
    let of = |rows: &[(&str, usize)]| {
        rows.iter().map(|&(kind, count)| (kind.to_string(), count)).collect::<BTreeMap<_, _>>()
    };
    assert_eq!(kinds("mg_hcp_288.xyz"), of(&[]));
    // Every sulphur holds its hydrogen and gold, but no gold another; two thiols of the cluster make a disulfide, 2.11
    // angstrom long.
    assert_eq!(kinds("au_thiol.xyz"), of(&[("Au-S", 96), ("H-S", 50), ("S-S", 1)]));
    // The file names all of these itself.
    assert_eq!(kinds("MOF-5.pdb"), of(&[("C-C", 24), ("C-H", 12), ("C-O", 12), ("O-Zn", 20)]));
}
