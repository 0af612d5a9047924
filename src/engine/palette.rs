//! Colours of atoms by what they are: element, chain or residue.

use glam::Vec3;

use crate::config::{BaseColor, Srgba};
use crate::scene::{Atom, Molecule};
use crate::shading::linear;

/// Colours of chains and residues in turn: after [Okabe2008, "Set of colors"], which stay apart for colour-blind eyes, softened
/// for large areas, then lighter and darker turns of the same hues.
const PALETTE: [[u8; 3]; 12] = [
    [0x4c, 0x8d, 0xc4],
    [0xe0, 0x8e, 0x2b],
    [0x3d, 0xa3, 0x7f],
    [0xc8, 0x6f, 0xa6],
    [0xd9, 0x5f, 0x3b],
    [0x7f, 0xbd, 0xe3],
    [0xd8, 0xc2, 0x4a],
    [0x6a, 0x6f, 0xb5],
    [0x9d, 0xc4, 0x6c],
    [0xa8, 0x5a, 0x4a],
    [0x5f, 0xa8, 0xa8],
    [0x9a, 0x8f, 0x86],
];

/// Gives each atom its own colour.
pub struct AtomColors {
    linear: [Vec3; PALETTE.len()],
    /// Number of each residue's name, in order of first appearance.
    residue_kinds: Vec<u32>,
}

impl AtomColors {
    /// Prepares the colours of a molecule; residue names are numbered only where `by_residue`.
    pub fn new(molecule: &Molecule, by_residue: bool) -> AtomColors {
        let mut names = std::collections::HashMap::new();
        let residue_kinds = if by_residue {
            molecule
                .residues
                .iter()
                .map(|residue| {
                    let next = names.len() as u32;
                    *names.entry(residue.name).or_insert(next)
                })
                .collect()
        } else {
            Vec::new()
        };
        AtomColors { linear: PALETTE.map(|color| linear(Srgba::from_bytes(color))), residue_kinds }
    }

    /// Linear colour of an atom by a scheme. Part and material belong to meshes: an atom keeps its element's colour.
    pub fn of(&self, molecule: &Molecule, atom: &Atom, scheme: BaseColor) -> Vec3 {
        let turn = |index: u32| self.linear[index as usize % PALETTE.len()];
        match scheme {
            BaseColor::Chain => turn(molecule.residue(atom).chain),
            BaseColor::Residue => turn(self.residue_kinds.get(atom.residue as usize).copied().unwrap_or(0)),
            _ => linear(Srgba::from_bytes(atom.element.color())),
        }
    }
}
