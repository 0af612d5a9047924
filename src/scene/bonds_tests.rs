//! Tests of the bond rules, on small arrangements of atoms.

use super::builder::tests::{bare, build};
use super::builder::{MoleculeBuilder, NewAtom};
use super::molecule::Molecule;
use super::name::Name;
use super::report::{NoteKind, Report};
use super::{Bond, FileBond};

/// An atom of a residue.
fn of(residue: &str, number: i32, name: &str, element: &str, [x, y, z]: [f64; 3]) -> NewAtom<'static> {
    NewAtom {
        residue_name: Name::new(residue.as_bytes()),
        residue_number: number,
        name: Name::new(name.as_bytes()),
        ..bare(element, x, y, z)
    }
}

fn build_with(atoms: &[NewAtom<'_>], file_bonds: &[FileBond]) -> (Molecule, Report) {
    let mut builder = MoleculeBuilder::default();
    for atom in atoms {
        builder.push(atom);
    }
    let mut report = Report::default();
    let molecule = builder.finish(file_bonds, &mut report);
    (molecule.expect("at least one atom"), report)
}

fn pairs(molecule: &Molecule) -> Vec<(u32, u32)> {
    molecule.bonds.iter().map(|bond| (bond.a, bond.b)).collect()
}

#[test]
fn bonds_end_at_the_sum_of_radii_plus_the_tolerance() {
    // Carbon: 0.76 + 0.76 + 0.45 = 1.97.
    assert_eq!(pairs(&build(&[bare("C", 0.0, 0.0, 0.0), bare("C", 1.96, 0.0, 0.0)])), [(0, 1)]);
    assert!(build(&[bare("C", 0.0, 0.0, 0.0), bare("C", 1.98, 0.0, 0.0)]).bonds.is_empty());
    assert!(build(&[bare("C", 0.0, 0.0, 0.0), bare("C", 0.39, 0.0, 0.0)]).bonds.is_empty());
}

#[test]
fn a_hydrogen_bonds_its_nearest_heavy_atom_only() {
    let atoms =
        [bare("O", 0.0, 0.0, 0.0), bare("H", 0.96, 0.0, 0.0), bare("H", 1.60, 0.0, 0.0), bare("C", 2.2, 0.0, 0.0)];
    assert_eq!(pairs(&build(&atoms)), [(0, 1), (2, 3)]);
    let hydrogen_molecule = [bare("H", 0.0, 0.0, 0.0), bare("H", 0.74, 0.0, 0.0)];
    assert_eq!(pairs(&build(&hydrogen_molecule)), [(0, 1)]);
}

#[test]
fn metals_bond_ligands_but_not_each_other() {
    let chloride = [bare("Co", 0.0, 0.0, 0.0), bare("Cl", 2.4, 0.0, 0.0)];
    assert_eq!(pairs(&build(&chloride)), [(0, 1)]);
    let dimer = [bare("Mg", 0.0, 0.0, 0.0), bare("Mg", 2.5, 0.0, 0.0)];
    assert!(build(&dimer).bonds.is_empty());
}

#[test]
fn oxides_and_frameworks_bond_metal_and_oxygen_alone() {
    // Distances of hematite: two kinds of Fe-O bonds, and irons and oxygens as near each other as they come.
    let hematite =
        [bare("Fe", 0.0, 0.0, 0.0), bare("O", 1.95, 0.0, 0.0), bare("O", 0.0, 2.12, 0.0), bare("Fe", 0.0, 0.0, 2.9)];
    assert_eq!(pairs(&build(&hematite)), [(0, 1), (0, 2)]);
    // A carboxylate on zirconium, as in UiO-66: its carbon is 3.1 angstrom from the metal.
    let uio =
        [bare("Zr", 0.0, 0.0, 0.0), bare("O", 2.2, 0.0, 0.0), bare("C", 3.0, 0.9, 0.0), bare("Zr", 0.0, 3.5, 0.0)];
    assert_eq!(pairs(&build(&uio)), [(0, 1), (1, 2)]);
}

#[test]
fn ions_bond_only_if_the_file_says_so() {
    let salt = [bare("Na", 0.0, 0.0, 0.0), bare("Cl", 2.8, 0.0, 0.0)];
    assert!(build(&salt).bonds.is_empty());
    let (molecule, _) = build_with(&salt, &[FileBond { a: 1, b: 0, order: 1 }]);
    assert_eq!(pairs(&molecule), [(0, 1)]);
}

#[test]
fn waters_of_different_residues_never_bond() {
    let mut atoms = [of("HOH", 1, "O", "O", [0.0, 0.0, 0.0]), of("HOH", 2, "O", "O", [1.5, 0.0, 0.0])];
    assert!(build(&atoms).bonds.is_empty());
    atoms[1].residue_number = 1;
    assert_eq!(build(&atoms).bonds.len(), 1);
}

#[test]
fn models_never_bond() {
    let mut atoms = [bare("C", 0.0, 0.0, 0.0), bare("C", 1.5, 0.0, 0.0), bare("C", 1.5, 0.1, 0.0)];
    (atoms[1].model, atoms[2].model) = (2, 3);
    assert!(build(&atoms).bonds.is_empty());
}

#[test]
fn alternates_never_bond_but_for_the_chain() {
    let mut atoms = [of("ALA", 1, "CB", "C", [0.0, 0.0, 0.0]), of("ALA", 2, "CB", "C", [1.5, 0.0, 0.0])];
    (atoms[0].alt_loc, atoms[1].alt_loc) = (b'A', b'B');
    assert!(build(&atoms).bonds.is_empty());
    (atoms[0].name, atoms[1].name) = (Name::new(b"C"), Name::new(b"N"));
    assert_eq!(build(&atoms).bonds.len(), 1);
}

#[test]
fn ligands_the_file_describes_get_no_bonds_by_distance() {
    let ligand = [
        of("LIG", 1, "C1", "C", [0.0, 0.0, 0.0]),
        of("LIG", 1, "C2", "C", [1.5, 0.0, 0.0]),
        of("LIG", 1, "C3", "C", [3.0, 0.0, 0.0]),
        of("LIG", 1, "C4", "C", [3.0, 1.5, 0.0]),
    ];
    let bond = |a, b, order| FileBond { a, b, order };
    let (molecule, _) = build_with(&ligand, &[bond(1, 0, 2), bond(3, 2, 1)]);
    assert_eq!(molecule.bonds, [Bond { a: 0, b: 1, order: 2 }, Bond { a: 2, b: 3, order: 1 }]);
    // An atom that no record names is bonded by distance.
    let (molecule, _) = build_with(&ligand, &[bond(1, 0, 2)]);
    assert_eq!(pairs(&molecule), [(0, 1), (1, 2), (2, 3)]);
    // Records of amino acids are links, not descriptions.
    let protein = ligand.map(|atom| NewAtom { residue_name: Name::new(b"CYS"), ..atom });
    let (molecule, _) = build_with(&protein, &[bond(1, 0, 2), bond(3, 2, 1)]);
    assert_eq!(pairs(&molecule), [(0, 1), (1, 2), (2, 3)]);
}

#[test]
fn odd_bonds_of_the_file_are_left_out() {
    let atoms =
        [bare("C", 0.0, 0.0, 0.0), bare("C", 0.0, 0.0, 0.0), bare("C", 9.0, 0.0, 0.0), bare("C", 5.0, 0.0, 0.0)];
    let bonds = [(0, 1), (0, 2), (0, 3), (0, 0), (0, 99)];
    let bonds = bonds.map(|(a, b)| FileBond { a, b, order: 9 });
    let (molecule, report) = build_with(&atoms, &bonds);
    assert_eq!(molecule.bonds, [Bond { a: 0, b: 3, order: 3 }]);
    assert_eq!(report.count(NoteKind::OddBond), 2);
}

#[test]
fn coincident_atoms_do_not_blow_up() {
    let atoms = vec![bare("C", 1.0, 2.0, 3.0); 300_000];
    let (molecule, report) = build_with(&atoms, &[]);
    assert!(molecule.bonds.is_empty());
    assert!(report.count(NoteKind::Crowded) > 299_000);
    assert!((molecule.bounding_sphere().radius - 1.7).abs() < 1e-3);
}

#[test]
fn a_crowd_keeps_eight_bonds_per_atom() {
    let spot = |i: i32| f64::from(i) * 0.5;
    let atoms: Vec<NewAtom<'_>> =
        (0..1000).map(|i| bare("C", spot(i % 10), spot(i / 10 % 10), spot(i / 100))).collect();
    let (molecule, report) = build_with(&atoms, &[]);
    let mut degrees = vec![0; atoms.len()];
    for bond in &molecule.bonds {
        assert!(bond.a < bond.b);
        degrees[bond.a as usize] += 1;
        degrees[bond.b as usize] += 1;
    }
    assert!(degrees.iter().all(|&degree| degree <= 8));
    assert!(report.count(NoteKind::Crowded) > 0);
    assert!(molecule.bonds.is_sorted() && molecule.bonds.windows(2).all(|pair| pair[0] != pair[1]));
}

/// Glycine at a height, as long as peptides make it: N, CA, C and O.
fn glycine(number: i32, x: f64, y: f64) -> [NewAtom<'static>; 4] {
    [("N", 0.0, 0.0), ("CA", 1.45, 0.0), ("C", 2.9, 0.3), ("O", 3.0, 1.5)]
        .map(|(name, dx, dy)| of("GLY", number, name, &name[..1], [x + dx, y + dy, 0.0]))
}

fn orders(molecule: &Molecule) -> Vec<(u32, u32, u8)> {
    molecule.bonds.iter().map(|bond| (bond.a, bond.b, bond.order)).collect()
}

#[test]
fn known_residues_have_their_orders_and_their_links() {
    let chain = [glycine(1, 0.0, 0.0), glycine(2, 4.2, 0.0)].concat();
    let first = [(0, 1, 1), (1, 2, 1), (2, 3, 2)];
    let second = [(4, 5, 1), (5, 6, 1), (6, 7, 2)];
    assert_eq!(orders(&build(&chain)), [&first[..], &[(2, 4, 1)], &second].concat());
    let broken = [glycine(1, 0.0, 0.0), glycine(2, 5.2, 0.0)].concat();
    assert_eq!(orders(&build(&broken)), [first, second].concat());
}

#[test]
fn known_residues_that_touch_do_not_bond() {
    // CA of one 1.2 angstrom above CA of the other.
    let touching = [glycine(1, 0.0, 0.0), glycine(9, 0.0, -1.2)].concat();
    assert_eq!(build(&touching).bonds.len(), 6);
    // The same atoms in residues that no template knows.
    let unknown: Vec<_> = touching.iter().map(|atom| NewAtom { residue_name: Name::new(b"LIG"), ..*atom }).collect();
    assert!(build(&unknown).bonds.len() > 6);
}

#[test]
fn chains_may_be_closed_to_rings_but_not_with_other_chains() {
    let mut ends = [glycine(1, 0.0, 0.0), glycine(9, -4.2, 0.0)].concat();
    assert!(pairs(&build(&ends)).contains(&(0, 6)));
    ends[4..].iter_mut().for_each(|atom| atom.chain = b"B");
    assert_eq!(build(&ends).bonds.len(), 6);
}

#[test]
fn cystines_ligands_and_metals_find_known_residues() {
    let cysteine = |number: i32, y: f64| {
        [("N", 0.0), ("CA", 1.45), ("CB", 2.9), ("SG", 4.7)]
            .map(|(name, x)| of("CYS", number, name, &name[..1], [x, y, 0.0]))
    };
    let cystine = [cysteine(1, 0.0), cysteine(30, 2.05)].concat();
    assert_eq!(pairs(&build(&cystine)), [(0, 1), (1, 2), (2, 3), (3, 7), (4, 5), (5, 6), (6, 7)]);
    let zinc = [cysteine(1, 0.0).to_vec(), vec![of("ZN", 90, "ZN", "Zn", [4.7, 2.3, 0.0])]].concat();
    assert_eq!(pairs(&build(&zinc)), [(0, 1), (1, 2), (2, 3), (3, 4)]);
    let inhibitor = [cysteine(1, 0.0).to_vec(), vec![of("LIG", 90, "C1", "C", [4.7, 1.8, 0.0])]].concat();
    assert_eq!(pairs(&build(&inhibitor)), [(0, 1), (1, 2), (2, 3), (3, 4)]);
}

#[test]
fn hydrogens_stay_in_known_residues() {
    // Nearer to the oxygen of another residue than to its own nitrogen.
    let mut atoms = glycine(1, 0.0, 0.0).to_vec();
    atoms.push(of("GLY", 1, "H", "H", [-1.0, 0.0, 0.0]));
    atoms.push(of("HOH", 2, "O", "O", [-1.9, 0.0, 0.0]));
    assert_eq!(pairs(&build(&atoms)), [(0, 1), (0, 4), (1, 2), (2, 3)]);
    // Open atoms do not get them either.
    atoms[5].residue_name = Name::new(b"LIG");
    assert_eq!(pairs(&build(&atoms)), [(0, 1), (0, 4), (1, 2), (2, 3)]);
}

#[test]
fn names_or_lengths_that_do_not_fit_are_left_to_the_search() {
    let mut odd = glycine(1, 0.0, 0.0);
    odd[2].name = Name::new(b"C7");
    assert_eq!(orders(&build(&odd)), [(0, 1, 1), (1, 2, 1), (2, 3, 1)]);
    // Names swapped: CA and O are far apart, and the bonds of the names would be wrong.
    let mut swapped = glycine(1, 0.0, 0.0);
    (swapped[1].name, swapped[2].name) = (Name::new(b"C"), Name::new(b"CA"));
    assert_eq!(pairs(&build(&swapped)), [(0, 1), (1, 2), (2, 3)]);
    // A calcium called CA.
    let mut calcium = glycine(1, 0.0, 0.0);
    calcium[1].element = bare("Ca", 0.0, 0.0, 0.0).element;
    assert_eq!(pairs(&build(&calcium)), [(2, 3)]);
}

#[test]
fn orders_of_the_file_replace_those_of_templates() {
    let atoms = glycine(1, 0.0, 0.0);
    let (molecule, _) = build_with(&atoms, &[FileBond { a: 0, b: 1, order: 2 }]);
    assert_eq!(orders(&molecule), [(0, 1, 2), (1, 2, 1), (2, 3, 1)]);
    let (molecule, _) = build_with(&atoms, &[FileBond { a: 0, b: 1, order: 1 }]);
    assert_eq!(orders(&molecule), [(0, 1, 1), (1, 2, 1), (2, 3, 2)]);
}

#[test]
fn nucleotides_are_known_by_old_names_too() {
    let names = ["P", "O1P", "O5*", "C5*"];
    let atoms: Vec<NewAtom<'_>> = (0..)
        .zip(names)
        .map(|(i, name)| {
            let y = if name == "O1P" { 1.5 } else { 0.0 };
            of("A", 1, name, &name[..1], [[0.0, 0.0, 1.6, 3.0][i as usize], y, 0.0])
        })
        .collect();
    assert_eq!(orders(&build(&atoms)), [(0, 1, 2), (0, 2, 1), (2, 3, 1)]);
}
