//! Collects atoms as importers read them and makes a [`Molecule`] of them.
//!
//! Steps of [`MoleculeBuilder::finish`]: drop the less occupied alternate locations, recentre, bond, bound.

use super::altloc;
use super::bonds::{self, FileBond};
use super::element::Element;
use super::guess;
use super::molecule::{Atom, Chain, Molecule, MoleculeCopy, Residue, ResidueKind, Sphere};
use super::name::Name;
use super::report::{NoteKind, Report};
use super::sphere::bounding_sphere;
use glam::{Affine3A, DAffine3, DVec3, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// Above this rounding step of f32 positions, in angstrom, the report says so; a tenth of a pixel in any close view.
const VISIBLE_ROUNDING: f64 = 0.005;

/// An atom as a file gives it.
#[derive(Debug, Clone, Copy)]
pub struct NewAtom<'a> {
    /// Centre in angstrom, as in the file; must be finite and below 1e30.
    pub position: DVec3,
    /// Chemical element.
    pub element: Element,
    /// The file's name of the atom.
    pub name: Name,
    /// Letter of its alternate location, or 0.
    pub alt_loc: u8,
    /// Share of molecules in which the atom is here; decides between alternate locations. 1 if unknown.
    pub occupancy: f32,
    /// Name of its residue, or empty.
    pub residue_name: Name,
    /// Number of its residue, or 0.
    pub residue_number: i32,
    /// Insertion code of its residue, or 0.
    pub insertion_code: u8,
    /// Whether it is a `HETATM`.
    pub is_hetero: bool,
    /// Chain id, or empty; any bytes.
    pub chain: &'a [u8],
    /// Model number; must not fall from one atom to the next.
    pub model: u32,
    /// Temperature factor in square angstrom, or 0.
    pub b_factor: f32,
    /// Charge in elementary charges, or 0.
    pub charge: f32,
}

/// A copy of some atoms, as a biological assembly has them.
#[derive(Debug, Clone, PartialEq)]
pub struct NewCopy {
    /// Ascending ranges of indices that [`MoleculeBuilder::push`] returned.
    pub atoms: Vec<Range<u32>>,
    /// From the file's coordinates to where the copy stands; rotation and translation.
    pub place: DAffine3,
}

/// Atoms in the order of the file, with the groups they belong to.
#[derive(Debug, Default)]
pub struct MoleculeBuilder {
    positions: Vec<DVec3>,
    atoms: Vec<Atom>,
    occupancies: Vec<f32>,
    residues: Vec<Residue>,
    chains: Vec<Chain>,
    copies: Vec<NewCopy>,
    chain_index: HashMap<Vec<u8>, u32>,
    last_chain: Option<(Vec<u8>, u32)>,
    has_alt_locs: bool,
}

impl MoleculeBuilder {
    /// Number of atoms so far.
    pub fn len(&self) -> usize {
        self.atoms.len()
    }

    /// Whether there is no atom yet.
    pub fn is_empty(&self) -> bool {
        self.atoms.is_empty()
    }

    /// Adds an atom and returns its index, by which [`FileBond`]s name it.
    pub fn push(&mut self, atom: &NewAtom<'_>) -> u32 {
        let residue = Residue {
            number: atom.residue_number,
            chain: self.chain(atom.chain),
            model: atom.model,
            name: atom.residue_name,
            insertion_code: atom.insertion_code,
            is_hetero: atom.is_hetero,
            kind: ResidueKind::default(),
        };
        if self.residues.last().is_none_or(|last| !same_residue(last, &residue)) {
            self.residues.push(residue);
        }
        let index = self.atoms.len() as u32;
        self.has_alt_locs |= atom.alt_loc != 0;
        self.positions.push(atom.position);
        self.occupancies.push(atom.occupancy);
        self.atoms.push(Atom {
            position: Vec3::ZERO,
            residue: self.residues.len() as u32 - 1,
            name: atom.name,
            element: atom.element,
            alt_loc: atom.alt_loc,
            // Numbers beyond single precision say nothing.
            b_factor: if atom.b_factor.is_finite() { atom.b_factor } else { 0.0 },
            charge: if atom.charge.is_finite() { atom.charge } else { 0.0 },
        });
        index
    }

    /// The atoms so far; their positions are in [`Self::positions`].
    pub(super) fn atoms(&self) -> &[Atom] {
        &self.atoms
    }

    /// Where the atoms are, in the file's coordinates.
    pub(super) fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The residues so far.
    pub(super) fn residues(&self) -> &[Residue] {
        &self.residues
    }

    /// The chains so far.
    pub(super) fn chains(&self) -> &[Chain] {
        &self.chains
    }

    /// The atoms so far that stand in certain chains, as ascending ranges for [`NewCopy::atoms`].
    pub fn atoms_of_chains(&self, is_wanted: impl Fn(&str) -> bool) -> Vec<Range<u32>> {
        let is_wanted: Vec<bool> = self.chains.iter().map(|chain| is_wanted(&chain.id)).collect();
        let mut ranges: Vec<Range<u32>> = Vec::new();
        for (index, atom) in (0..).zip(&self.atoms) {
            if !is_wanted[self.residues[atom.residue as usize].chain as usize] {
                continue;
            }
            match ranges.last_mut() {
                Some(range) if range.end == index => range.end += 1,
                _ => ranges.push(index..index + 1),
            }
        }
        ranges
    }

    /// Draws these copies instead of the atoms as they are; atoms that no copy names are not drawn.
    pub fn set_copies(&mut self, copies: Vec<NewCopy>) {
        self.copies = copies;
    }

    /// Makes the molecule, or `None` if there is no atom. `file_bonds` may hold duplicates and any direction.
    pub fn finish(mut self, file_bonds: &[FileBond], report: &mut Report) -> Option<Molecule> {
        let new_index = self.drop_alternates(report);
        let copies = std::mem::take(&mut self.copies);
        let copies: Vec<NewCopy> = copies.into_iter().map(|copy| kept(copy, new_index.as_deref())).collect();
        let (low, high) = self.bounds(&copies)?;
        let origin = (low + high) * 0.5;
        for (atom, &position) in self.atoms.iter_mut().zip(&self.positions) {
            atom.position = (position - origin).as_vec3();
        }
        let rounding = (high - low).max_element() * f64::from(f32::EPSILON) * 0.25;
        if rounding > VISIBLE_ROUNDING {
            report.note(NoteKind::CoarsePositions, None, || format!("to about {rounding:.2e} angstrom"));
        }
        // Give back what growing the lists left over before the bond search takes memory.
        drop((std::mem::take(&mut self.positions), std::mem::take(&mut self.occupancies)));
        self.chain_index = HashMap::new();
        self.classify_residues();
        self.atoms.shrink_to_fit();
        self.residues.shrink_to_fit();
        let kept_bond = |bond: &FileBond| {
            let map = |index: u32| {
                new_index.as_ref().map_or(Some(index), |new_index| new_index.get(index as usize).copied().flatten())
            };
            Some(FileBond { a: map(bond.a)?, b: map(bond.b)?, order: bond.order })
        };
        let file_bonds: Vec<FileBond> = file_bonds.iter().filter_map(kept_bond).collect();
        let bonds = bonds::find(&self.atoms, &self.residues, &file_bonds, report);
        let copies = copies.into_iter().map(|copy| MoleculeCopy {
            atoms: copy.atoms,
            world_from_molecule: single(
                DAffine3::from_translation(-origin) * copy.place * DAffine3::from_translation(origin),
            ),
        });
        let mut molecule = Molecule {
            atoms: self.atoms,
            residues: self.residues,
            chains: self.chains,
            bonds,
            copies: copies.collect(),
            origin,
            sphere: Sphere::default(),
        };
        molecule.sphere = bounding_sphere(molecule.drawn_balls());
        Some(molecule)
    }

    /// Tells what each residue is: by name, and by whether it is a single atom.
    fn classify_residues(&mut self) {
        let mut first = 0;
        for (index, residue) in self.residues.iter_mut().enumerate() {
            let count = self.atoms[first..].iter().take_while(|atom| atom.residue as usize == index).count();
            let element = self.atoms.get(first).map_or(Element::UNKNOWN, |atom| atom.element);
            residue.kind = guess::residue_kind(residue.name.as_str(), (count == 1).then_some(element));
            first += count;
        }
    }

    /// The box around all that is drawn, in the file's coordinates; none where that is nothing.
    fn bounds(&self, copies: &[NewCopy]) -> Option<(DVec3, DVec3)> {
        let grow = |(low, high): (DVec3, DVec3), p: DVec3| (low.min(p), high.max(p));
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = if copies.is_empty() {
            self.positions.iter().fold(nothing, |bounds, &p| grow(bounds, p))
        } else {
            copies.iter().fold(nothing, |bounds, copy| {
                let atoms = copy.atoms.iter().flat_map(|range| &self.positions[as_usize(range)]);
                atoms.fold(bounds, |bounds, &p| grow(bounds, copy.place.transform_point3(p)))
            })
        };
        (low.x <= high.x).then_some((low, high))
    }

    /// Drops all but one alternate location and the residues left without atoms; returns where each atom went, if any moved.
    fn drop_alternates(&mut self, report: &mut Report) -> Option<Vec<Option<u32>>> {
        if !self.has_alt_locs {
            return None;
        }
        let keep = altloc::choose(&self.atoms, &self.residues, &self.occupancies);
        let mut new_index = vec![None; self.atoms.len()];
        let (mut count, mut residues) = (0_usize, Vec::<Residue>::new());
        for (old, &kept) in keep.iter().enumerate() {
            if !kept {
                continue;
            }
            let mut atom = self.atoms[old];
            let residue = self.residues[atom.residue as usize];
            if residues.last().is_none_or(|last| !same_residue(last, &residue)) {
                residues.push(residue);
            }
            atom.residue = residues.len() as u32 - 1;
            self.atoms[count] = atom;
            self.positions[count] = self.positions[old];
            new_index[old] = Some(count as u32);
            count += 1;
        }
        report.note_many(NoteKind::AlternateLocation, (keep.len() - count) as u32, String::new);
        self.atoms.truncate(count);
        self.positions.truncate(count);
        self.residues = residues;
        Some(new_index)
    }

    /// The index of a chain id, which is new or, nearly always, that of the atom before.
    fn chain(&mut self, id: &[u8]) -> u32 {
        if let Some((last, index)) = &self.last_chain
            && last == id
        {
            return *index;
        }
        let index = match self.chain_index.get(id) {
            Some(&index) => index,
            None => {
                let index = self.chains.len() as u32;
                self.chains.push(Chain { id: String::from_utf8_lossy(id).into_owned(), file: 0 });
                self.chain_index.insert(id.to_vec(), index);
                index
            }
        };
        self.last_chain = Some((id.to_vec(), index));
        index
    }
}

/// A copy with the indices that its atoms have after some were dropped.
fn kept(copy: NewCopy, new_index: Option<&[Option<u32>]>) -> NewCopy {
    let Some(new_index) = new_index else { return copy };
    let moved = |range: &Range<u32>| {
        let mut kept = new_index.get(as_usize(range)).unwrap_or_default().iter().flatten();
        let first = *kept.next()?;
        Some(first..kept.next_back().copied().unwrap_or(first) + 1)
    };
    NewCopy { atoms: copy.atoms.iter().filter_map(moved).collect(), place: copy.place }
}

fn as_usize(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}

/// A placement in single precision.
pub(super) fn single(place: DAffine3) -> Affine3A {
    let [x, y, z] = [place.matrix3.x_axis, place.matrix3.y_axis, place.matrix3.z_axis].map(|axis| axis.as_vec3());
    Affine3A::from_mat3_translation(glam::Mat3::from_cols(x, y, z), place.translation.as_vec3())
}

/// Whether two neighbours in the file belong together; a `HETATM` within a residue does not split it.
fn same_residue(a: &Residue, b: &Residue) -> bool {
    Residue { is_hetero: b.is_hetero, ..*a } == *b
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// An atom without residue.
    pub(in crate::scene) fn bare(element: &str, x: f64, y: f64, z: f64) -> NewAtom<'static> {
        NewAtom {
            position: DVec3::new(x, y, z),
            element: Element::from_symbol(element.as_bytes()).unwrap_or_default(),
            name: Name::new(element.as_bytes()),
            alt_loc: 0,
            occupancy: 1.0,
            residue_name: Name::default(),
            residue_number: 0,
            insertion_code: 0,
            is_hetero: false,
            chain: b"",
            model: 1,
            b_factor: 0.0,
            charge: 0.0,
        }
    }

    /// The molecule of some atoms without bonds of their own.
    pub(in crate::scene) fn build(atoms: &[NewAtom<'_>]) -> Molecule {
        let mut builder = MoleculeBuilder::default();
        atoms.iter().for_each(|atom| {
            builder.push(atom);
        });
        builder.finish(&[], &mut Report::default()).expect("at least one atom")
    }

    #[test]
    fn nothing_gives_no_molecule() {
        assert_eq!(MoleculeBuilder::default().finish(&[], &mut Report::default()), None);
    }

    #[test]
    fn far_molecules_keep_their_precision() {
        let near = build(&[bare("C", 0.0, 0.0, 0.0), bare("C", 1.5, 0.0, 0.001)]);
        let far = build(&[bare("C", 1e8, 0.0, 0.0), bare("C", 1e8 + 1.5, 0.0, 0.001)]);
        assert!((far.origin.x - 1e8 - 0.75).abs() < 1e-6);
        assert_eq!(near.atoms[0].position, far.atoms[0].position);
        assert_eq!(far.bonds.len(), 1);
    }

    #[test]
    fn atoms_miles_apart_are_reported_as_rounded() {
        let mut builder = MoleculeBuilder::default();
        builder.push(&bare("C", 0.0, 0.0, 0.0));
        builder.push(&bare("C", 1e9, 0.0, 0.0));
        let mut report = Report::default();
        let molecule = builder.finish(&[], &mut report).expect("two atoms");
        assert_eq!(report.count(NoteKind::CoarsePositions), 1);
        assert!(molecule.bounding_sphere().radius >= 5e8);
    }

    #[test]
    fn chains_are_listed_once_and_residues_follow_the_file() {
        let mut atoms = [bare("C", 0.0, 0.0, 0.0); 4];
        (atoms[0].chain, atoms[1].chain, atoms[2].chain, atoms[3].chain) = (b"A", b"B", b"A", b"A");
        atoms[3].is_hetero = true;
        let molecule = build(&atoms);
        let chains: Vec<&str> = molecule.chains.iter().map(|chain| chain.id.as_str()).collect();
        assert_eq!(chains, ["A", "B"]);
        assert_eq!(molecule.residues.len(), 3);
        assert_eq!(molecule.chain(&molecule.atoms[2]), "A");
        assert!(!molecule.residue(&molecule.atoms[3]).is_hetero);
    }
}
