//! The molecules that restyle ships: each loads without a note and has the bonds that chemistry gives it.

use restyle::scene::{Molecule, Scene};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// File, formula in alphabetical order, bonds by distance.
const SHIPPED: &[(&str, &str, usize)] = &[
    ("alpha_helix.pdb", "C48 N16 O17", 80),
    ("ammonia.xyz", "H3 N1", 3),
    ("anthracene.xyz", "C14 H10", 26),
    ("arsenic_trioxide.xyz", "As4 O6", 12),
    ("benzene.xyz", "C6 H6", 12),
    ("c60.xyz", "C60", 90),
    ("caffeine.xyz", "C8 H10 N4 O2", 25),
    ("diamond.xyz", "C35 H36", 88),
    ("ferrocene.xyz", "C10 Fe1 H10", 30),
    ("magnesium.xyz", "Mg81", 0),
    ("methane.xyz", "C1 H4", 4),
    ("nanotube.xyz", "C140", 200),
    ("sodium_chloride.xyz", "Cl32 Na32", 0),
    ("sulfur.xyz", "S8", 8),
    ("water.xyz", "H2 O1", 2),
];

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("molecules")
}

fn formula(molecule: &Molecule) -> String {
    let mut counts = BTreeMap::new();
    for atom in &molecule.atoms {
        *counts.entry(atom.element.symbol()).or_insert(0) += 1;
    }
    counts.iter().map(|(symbol, count)| format!("{symbol}{count}")).collect::<Vec<_>>().join(" ")
}

#[test]
fn every_shipped_molecule_has_its_formula_and_bonds() {
    for &(file, expected, num_bonds) in SHIPPED {
        let scene = Scene::load(&folder().join(file)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(formula(&scene.molecule), expected, "{file}");
        assert_eq!(scene.molecule.bonds.len(), num_bonds, "{file}");
        assert!(scene.files[0].report.is_empty(), "{file}: {}", scene.files[0].report);
    }
}

#[test]
fn every_file_of_the_folder_is_tested_and_names_its_source() {
    for entry in std::fs::read_dir(folder()).expect("the folder is shipped") {
        let path = entry.expect("readable").path();
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        if !(name.ends_with(".xyz") || name.ends_with(".pdb")) {
            continue;
        }
        assert!(SHIPPED.iter().any(|&(file, ..)| file == name), "{name} is not in the table");
        let text = std::fs::read_to_string(&path).expect("readable");
        let head: String = text.lines().take(3).collect();
        let year = head
            .split(|c: char| !c.is_ascii_digit())
            .any(|word| word.len() == 4 && (1900..2100).contains(&word.parse::<u32>().unwrap_or(0)));
        assert!(year || head.contains("Handbook"), "{name} names no source: {head}");
    }
}

/// Shortest and longest bond between two elements, in angstrom.
fn bond_range(molecule: &Molecule, elements: [&str; 2]) -> (f32, f32) {
    let atom = |index: u32| &molecule.atoms[index as usize];
    let lengths = molecule.bonds.iter().filter_map(|bond| {
        let (a, b) = (atom(bond.a), atom(bond.b));
        let symbols = [a.element.symbol(), b.element.symbol()];
        let matches = symbols == elements || symbols == [elements[1], elements[0]];
        matches.then(|| a.position.distance(b.position))
    });
    lengths.fold((f32::INFINITY, 0.0), |(low, high), length| (low.min(length), high.max(length)))
}

#[test]
fn bond_lengths_are_those_of_the_sources() {
    let cases = [
        ("c60.xyz", ["C", "C"], (1.401, 1.458)),
        ("arsenic_trioxide.xyz", ["As", "O"], (1.78, 1.78)),
        ("anthracene.xyz", ["C", "C"], (1.36, 1.44)),
        ("methane.xyz", ["C", "H"], (1.087, 1.087)),
        ("water.xyz", ["H", "O"], (0.9572, 0.9572)),
        ("ferrocene.xyz", ["C", "Fe"], (2.064, 2.064)),
        ("diamond.xyz", ["C", "C"], (1.5445, 1.5445)),
        // Chords are shorter than bonds on the rolled wall.
        ("nanotube.xyz", ["C", "C"], (1.4096, 1.4189)),
        ("alpha_helix.pdb", ["C", "N"], (1.329, 1.458)),
        ("alpha_helix.pdb", ["C", "O"], (1.231, 1.231)),
    ];
    for (file, elements, (low, high)) in cases {
        let scene = Scene::load(&folder().join(file)).unwrap_or_else(|error| panic!("{error}"));
        let found = bond_range(&scene.molecule, elements);
        // PDB files keep three decimals, which moves a bond by up to a thousandth.
        let near = |a: f32, b: f32| (a - b).abs() < 1.5e-3;
        assert!(near(found.0, low) && near(found.1, high), "{file} {elements:?}: {found:?}");
    }
}

#[test]
fn the_helix_has_sixteen_alanines_in_chain_a() {
    let scene = Scene::load(&folder().join("alpha_helix.pdb")).unwrap_or_else(|e| panic!("{e}"));
    let molecule = &scene.molecule;
    assert_eq!((scene.name.as_str(), molecule.residues.len()), ("alpha_helix", 16));
    assert_eq!((molecule.chains.len(), molecule.chains[0].id.as_str()), (1, "A"));
    assert!(molecule.residues.iter().all(|residue| residue.name.as_str() == "ALA"));
    assert_eq!(molecule.residues[15].number, 16);
    // One residue climbs 1.5 angstrom.
    let alpha: Vec<_> = molecule.atoms.iter().filter(|atom| atom.name.as_str() == "CA").collect();
    let climb = (alpha[15].position.y - alpha[0].position.y) / 15.0;
    assert!((1.45..1.6).contains(&climb), "{climb}");
}
