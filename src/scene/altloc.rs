//! Alternate locations: which of several positions of one atom is drawn.
//!
//! A residue is drawn in the conformer with the highest mean occupancy, the first in the file if equal. Atoms that this
//! conformer lacks keep their own most occupied position, if they belong to a residue of the same name (a position may
//! hold glycine in one conformer and serine in the other, and only one of them is drawn). Atoms without a letter stay,
//! unless a lettered atom of the same name is more occupied.

use super::molecule::{Atom, Residue};
use super::name::Name;
use std::collections::HashMap;

/// What the alternatives share: model, chain, residue number and insertion code.
type Place = (u32, u32, i32, u8);

/// For each atom whether it is drawn. All slices but `residues` have one entry per atom.
pub(super) fn choose(atoms: &[Atom], residues: &[Residue], occupancies: &[f32]) -> Vec<bool> {
    let place = |atom: &Atom| -> Place {
        let residue = &residues[atom.residue as usize];
        (residue.model, residue.chain, residue.number, residue.insertion_code)
    };
    let mut places: HashMap<Place, Vec<usize>> = HashMap::new();
    for atom in atoms.iter().filter(|atom| atom.alt_loc != 0) {
        places.entry(place(atom)).or_default();
    }
    for (index, atom) in atoms.iter().enumerate() {
        if let Some(members) = places.get_mut(&place(atom)) {
            members.push(index);
        }
    }
    let mut keep = vec![true; atoms.len()];
    for members in places.values() {
        choose_in_place(members, atoms, residues, occupancies, &mut keep);
    }
    keep
}

/// Decides for the atoms of one place.
fn choose_in_place(members: &[usize], atoms: &[Atom], residues: &[Residue], occupancies: &[f32], keep: &mut [bool]) {
    let residue_name = |index: usize| residues[atoms[index].residue as usize].name;
    // Conformers by letter: sum and count of occupancies, first member.
    let mut conformers: Vec<(u8, f64, u32, usize)> = Vec::new();
    for &index in members.iter().filter(|&&index| atoms[index].alt_loc != 0) {
        let letter = atoms[index].alt_loc;
        let occupancy = f64::from(occupancies[index]);
        match conformers.iter_mut().find(|conformer| conformer.0 == letter) {
            Some((_, sum, count, _)) => (*sum, *count) = (*sum + occupancy, *count + 1),
            None => conformers.push((letter, occupancy, 1, index)),
        }
    }
    let mean = |conformer: &(u8, f64, u32, usize)| conformer.1 / f64::from(conformer.2);
    let Some(&chosen) = conformers.iter().reduce(|best, other| if mean(other) > mean(best) { other } else { best })
    else {
        return;
    };
    let (chosen_letter, chosen_name) = (chosen.0, residue_name(chosen.3));

    let mut drawn: HashMap<Name, usize> = HashMap::new();
    // The chosen conformer wins over other letters; against an atom without a letter, occupancy decides.
    let beats = |a: usize, b: usize| match (atoms[a].alt_loc, atoms[b].alt_loc) {
        (x, y) if x == y => false,
        (0, _) | (_, 0) => occupancies[a] > occupancies[b],
        (x, _) if x == chosen_letter => true,
        (_, y) if y == chosen_letter => false,
        _ => occupancies[a] > occupancies[b],
    };
    for &index in members {
        let atom = &atoms[index];
        if atom.alt_loc != 0 && residue_name(index) != chosen_name {
            keep[index] = false;
            continue;
        }
        match drawn.get(&atom.name).copied() {
            None => {
                drawn.insert(atom.name, index);
            }
            // Two atoms of one name and one letter are not alternatives, the file only names them alike.
            Some(other) if atoms[other].alt_loc == atom.alt_loc => {}
            Some(other) if beats(index, other) => {
                keep[other] = false;
                drawn.insert(atom.name, index);
            }
            Some(_) => keep[index] = false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::builder::NewAtom;
    use super::super::builder::tests::{bare, build};
    use super::*;

    fn alternate(name: &str, letter: u8, occupancy: f32, residue: &str) -> NewAtom<'static> {
        NewAtom {
            name: Name::new(name.as_bytes()),
            alt_loc: letter,
            occupancy,
            residue_name: Name::new(residue.as_bytes()),
            residue_number: 10,
            ..bare("C", f64::from(letter) + f64::from(name.as_bytes()[1]) * 3.0, 0.0, 0.0)
        }
    }

    fn drawn(atoms: &[NewAtom<'_>]) -> Vec<String> {
        build(atoms)
            .atoms
            .iter()
            .map(|atom| format!("{}{}", atom.name, if atom.alt_loc == 0 { '-' } else { atom.alt_loc as char }))
            .collect()
    }

    #[test]
    fn the_more_occupied_conformer_is_drawn_whole() {
        let atoms = [
            alternate("CB", 0, 1.0, "SER"),
            alternate("CG", b'A', 0.4, "SER"),
            alternate("CG", b'B', 0.6, "SER"),
            alternate("CD", b'A', 0.5, "SER"),
            alternate("CD", b'B', 0.5, "SER"),
        ];
        assert_eq!(drawn(&atoms), ["CB-", "CGB", "CDB"]);
    }

    #[test]
    fn equal_occupancy_draws_the_first() {
        assert_eq!(drawn(&[alternate("CG", b'A', 0.5, "SER"), alternate("CG", b'B', 0.5, "SER")]), ["CGA"]);
    }

    #[test]
    fn one_of_two_residues_at_one_place_is_drawn() {
        let atoms = [
            alternate("CA", b'A', 0.3, "GLY"),
            alternate("CA", b'B', 0.7, "SER"),
            alternate("CB", b'B', 0.7, "SER"),
            alternate("CX", b'A', 0.3, "GLY"),
        ];
        assert_eq!(drawn(&atoms), ["CAB", "CBB"]);
        assert_eq!(build(&atoms).residues.len(), 1);
    }

    #[test]
    fn an_atom_that_only_the_other_conformer_has_stays() {
        let atoms =
            [alternate("CG", b'A', 0.6, "SER"), alternate("CG", b'B', 0.4, "SER"), alternate("CE", b'B', 0.4, "SER")];
        assert_eq!(drawn(&atoms), ["CGA", "CEB"]);
    }

    #[test]
    fn a_blank_letter_competes_by_occupancy() {
        assert_eq!(drawn(&[alternate("CG", 0, 0.6, "SER"), alternate("CG", b'B', 0.4, "SER")]), ["CG-"]);
        assert_eq!(drawn(&[alternate("CG", 0, 0.4, "SER"), alternate("CG", b'B', 0.6, "SER")]), ["CGB"]);
    }

    #[test]
    fn equal_names_without_letters_all_stay() {
        assert_eq!(drawn(&[alternate("CG", 0, 0.6, "SER"), alternate("CG", 0, 0.4, "SER")]), ["CG-", "CG-"]);
    }
}
