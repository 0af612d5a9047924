//! A molecule as the renderer needs it: atoms, residues, chains, bonds and a bounding sphere.
//!
//! Cost: 32 bytes per atom, 24 per residue, 12 per bond; a protein comes to some 50 bytes per atom.
//! Files far from their origin keep their precision: positions are f32 around an f64 origin.

use super::element::Element;
use super::name::Name;
use glam::{Affine3A, DVec3, Vec3};
use std::ops::Range;

/// One atom, 32 bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atom {
    /// Centre in angstrom, relative to [`Molecule::origin`].
    pub position: Vec3,
    /// Index into [`Molecule::residues`].
    pub residue: u32,
    /// The file's name of the atom: `CA`; in XYZ files the symbol as written.
    pub name: Name,
    /// Chemical element.
    pub element: Element,
    /// Letter of the alternate location that is drawn, or 0.
    pub alt_loc: u8,
    /// Temperature factor in square angstrom; 0 where the file has none.
    pub b_factor: f32,
    /// Charge in elementary charges: formal, or partial where the file has those; 0 where it has none.
    pub charge: f32,
}

/// What a residue is, as far as its name tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum ResidueKind {
    /// An amino acid.
    Protein,
    /// A nucleotide.
    Nucleic,
    /// A sugar of a glycan.
    Sugar,
    /// Water.
    Water,
    /// A single atom that is an ion or a noble gas.
    Ion,
    /// Any other group with a name.
    Ligand,
    /// Without a name, as in XYZ files.
    #[default]
    Other,
}

impl ResidueKind {
    /// The word that selectors know it by.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Protein => "protein",
            Self::Nucleic => "nucleic",
            Self::Sugar => "sugar",
            Self::Water => "water",
            Self::Ion => "ion",
            Self::Ligand => "ligand",
            Self::Other => "other",
        }
    }
}

/// A residue or any other group of atoms that the file names together, 24 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Residue {
    /// Number in its chain, as in the file; 0 where the file has none.
    pub number: i32,
    /// Index into [`Molecule::chains`].
    pub chain: u32,
    /// Number of the model or frame it belongs to.
    pub model: u32,
    /// Name: `ALA`, `HOH`; empty where the file has none.
    pub name: Name,
    /// Insertion code, or 0.
    pub insertion_code: u8,
    /// Whether its first atom is a `HETATM`.
    pub is_hetero: bool,
    /// What it is.
    pub kind: ResidueKind,
}

/// A chain of one file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chain {
    /// Its id; empty where the file has none.
    pub id: String,
    /// Index into [`Scene::files`](crate::scene::Scene::files).
    pub file: u32,
}

/// Some of the atoms, placed once more: a copy of a biological assembly.
#[derive(Debug, Clone, PartialEq)]
pub struct MoleculeCopy {
    /// The atoms, in ascending ranges that do not overlap.
    pub atoms: Vec<Range<u32>>,
    /// From the molecule's coordinates to the scene's; rotation and translation.
    pub world_from_molecule: Affine3A,
}

/// A bond between two atoms, `a < b`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Bond {
    /// Index of the first atom.
    pub a: u32,
    /// Index of the second atom.
    pub b: u32,
    /// 1 for single, 2 for double, 3 for triple.
    pub order: u8,
}

/// A sphere, in the molecule's coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sphere {
    /// Centre in angstrom, relative to [`Molecule::origin`].
    pub center: Vec3,
    /// Radius in angstrom.
    pub radius: f32,
}

/// Atoms, the groups they belong to, and the bonds between them. Empty in a scene of meshes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Molecule {
    /// All atoms that are drawn, in the order of the file.
    pub atoms: Vec<Atom>,
    /// Residues, in the order of the file.
    pub residues: Vec<Residue>,
    /// Chains, each once for its file.
    pub chains: Vec<Chain>,
    /// Unique bonds, sorted.
    pub bonds: Vec<Bond>,
    /// Where the atoms are drawn; empty where they are drawn once, as they are.
    pub copies: Vec<MoleculeCopy>,
    /// Where the file puts the zero of [`Atom::position`]: the centre of the atoms' bounding box, in angstrom.
    pub origin: DVec3,
    pub(super) sphere: Sphere,
}

impl Molecule {
    /// The smallest sphere, to about 1e-4 of its radius, that holds all atoms with their van der Waals radii, copies included.
    pub const fn bounding_sphere(&self) -> Sphere {
        self.sphere
    }

    /// Index and centre of all atoms where they are drawn, in scene coordinates.
    pub fn drawn_places(&self) -> impl Iterator<Item = (u32, Vec3)> + Clone {
        let position = |atom: u32| self.atoms[atom as usize].position;
        let plain = if self.copies.is_empty() { 0..self.atoms.len() as u32 } else { 0..0 };
        let of_copy = move |copy: &MoleculeCopy| {
            let place = copy.world_from_molecule;
            copy.atoms.clone().into_iter().flatten().map(move |atom| (atom, place.transform_point3(position(atom))))
        };
        plain.map(move |atom| (atom, position(atom))).chain(self.copies.iter().flat_map(of_copy))
    }

    /// Centres and van der Waals radii of all atoms where they are drawn, in scene coordinates.
    pub fn drawn_balls(&self) -> impl Iterator<Item = (Vec3, f32)> + Clone {
        self.drawn_places().map(|(atom, center)| (center, self.atoms[atom as usize].element.vdw_radius()))
    }

    /// The residue of an atom.
    pub fn residue(&self, atom: &Atom) -> &Residue {
        &self.residues[atom.residue as usize]
    }

    /// The chain id of an atom.
    pub fn chain(&self, atom: &Atom) -> &str {
        &self.chains[self.residue(atom).chain as usize].id
    }

    /// Bytes that the molecule holds in memory.
    pub fn memory_bytes(&self) -> usize {
        let chains: usize = self.chains.iter().map(|chain| size_of::<Chain>() + chain.id.capacity()).sum();
        self.atoms.capacity() * size_of::<Atom>()
            + self.residues.capacity() * size_of::<Residue>()
            + self.bonds.capacity() * size_of::<Bond>()
            + chains
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_as_documented() {
        assert_eq!(size_of::<Atom>(), 32);
        assert_eq!(size_of::<Residue>(), 24);
        assert_eq!(size_of::<Bond>(), 12);
    }
}
