//! A molecule as the renderer needs it: atoms, residues, chains, bonds and a bounding sphere.
//!
//! Cost: 24 bytes per atom, 20 per residue, 12 per bond; a protein comes to some 40 bytes per atom.
//! Files far from their origin keep their precision: positions are f32 around an f64 origin.

use super::element::Element;
use super::name::Name;
use glam::{DVec3, Vec3};

/// One atom, 24 bytes.
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
}

/// A residue or any other group of atoms that the file names together, 20 bytes.
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Centre in angstrom, relative to [`Molecule::origin`].
    pub center: Vec3,
    /// Radius in angstrom.
    pub radius: f32,
}

/// Atoms, the groups they belong to, and the bonds between them. Has at least one atom.
#[derive(Debug, Clone, PartialEq)]
pub struct Molecule {
    /// All atoms that are drawn, in the order of the file.
    pub atoms: Vec<Atom>,
    /// Residues, in the order of the file.
    pub residues: Vec<Residue>,
    /// Chain ids, each once; an empty id where the file has none.
    pub chains: Vec<String>,
    /// Unique bonds, sorted.
    pub bonds: Vec<Bond>,
    /// Where the file puts the zero of [`Atom::position`]: the centre of the atoms' bounding box, in angstrom.
    pub origin: DVec3,
    pub(super) sphere: Sphere,
}

impl Molecule {
    /// The smallest sphere, to about 1e-4 of its radius, that holds all atoms with their van der Waals radii.
    pub const fn bounding_sphere(&self) -> Sphere {
        self.sphere
    }

    /// The residue of an atom.
    pub fn residue(&self, atom: &Atom) -> &Residue {
        &self.residues[atom.residue as usize]
    }

    /// The chain id of an atom.
    pub fn chain(&self, atom: &Atom) -> &str {
        &self.chains[self.residue(atom).chain as usize]
    }

    /// Bytes that the molecule holds in memory.
    pub fn memory_bytes(&self) -> usize {
        let chains: usize = self.chains.iter().map(|chain| size_of::<String>() + chain.capacity()).sum();
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
        assert_eq!(size_of::<Atom>(), 24);
        assert_eq!(size_of::<Residue>(), 20);
        assert_eq!(size_of::<Bond>(), 12);
    }
}
