//! Colours of atoms by what they are: element, chain or residue.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use crate::config::{BaseColor, Srgba};
use crate::scene::{Assembly, Atom, Molecule, Part};
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
        let mut names = HashMap::new();
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

/// Gives each part of a mesh its own colour.
pub struct PartColors {
    linear: [Vec3; PALETTE.len()],
    /// The turn of each name of the assembly, in order of first appearance. Names that differ only in a number at their end
    /// are one where at least half of their parts are copies of others: all bolts have one colour, all bodies have not.
    turn_of_name: Vec<u32>,
    num_turns: u32,
}

/// What has no material: a light grey, as bare plaster.
const NO_MATERIAL: Vec3 = Vec3::splat(0.6);

impl PartColors {
    /// Prepares the colours of all parts.
    pub fn new(assembly: &Assembly) -> PartColors {
        fn kind(name: &str) -> &str {
            name.trim_end_matches(|c: char| c.is_ascii_digit() || " .-_#:()[]".contains(c))
        }
        let mut of_kinds: HashMap<&str, (usize, HashSet<u32>)> = HashMap::new();
        for part in &assembly.parts {
            let (num_parts, shapes) = of_kinds.entry(kind(&assembly.names[part.name as usize])).or_default();
            *num_parts += 1;
            shapes.insert(part.shape);
        }
        let mut turn_of: HashMap<&str, u32> = HashMap::new();
        let mut turn_of_name = vec![0; assembly.names.len()];
        for part in &assembly.parts {
            let name = assembly.names[part.name as usize].as_str();
            let are_copies = of_kinds.get(kind(name)).is_some_and(|(num_parts, shapes)| 2 * shapes.len() <= *num_parts);
            let next = turn_of.len() as u32;
            let shared = are_copies && !kind(name).is_empty();
            turn_of_name[part.name as usize] = *turn_of.entry(if shared { kind(name) } else { name }).or_insert(next);
        }
        let num_turns = turn_of.len() as u32;
        PartColors { linear: PALETTE.map(|color| linear(Srgba::from_bytes(color))), turn_of_name, num_turns }
    }

    /// Whether a scheme leaves meshes the colours of their file. Elements do: a mesh has none.
    pub fn is_of_file(scheme: BaseColor) -> bool {
        matches!(scheme, BaseColor::Material | BaseColor::Element)
    }

    /// Linear colour of a part by a scheme. Chain and residue belong to molecules: parts stand in for them.
    pub fn of(&self, assembly: &Assembly, part: &Part, scheme: BaseColor) -> Vec3 {
        if PartColors::is_of_file(scheme) {
            let material = part.material.and_then(|material| assembly.materials.get(material as usize));
            // Colours of vertices are shares of the material's.
            let is_colored = !assembly.shapes[part.shape as usize].colors.is_empty();
            let plain = if is_colored { Vec3::ONE } else { NO_MATERIAL };
            return material.map_or(plain, |material| material.base_color);
        }
        let is_named = !assembly.names[part.name as usize].is_empty();
        // Parts without a name are told apart by their shapes.
        let turn = if is_named { self.turn_of_name[part.name as usize] } else { self.num_turns + part.shape };
        self.linear[turn as usize % PALETTE.len()]
    }
}
