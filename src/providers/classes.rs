//! Classes of atoms: atoms that no selector can tell apart are resolved once.
//!
//! The classes depend on the molecule alone, and so outlive every change of a style. A protein of 50,000 atoms has a
//! few thousand.

use std::collections::HashMap;

use crate::config::Attribute;
use crate::scene::{Molecule, Name};

/// What selectors can ask of atoms and connectors. An attribute's place here is its number.
pub(super) const ATTRIBUTES: [Attribute; 5] =
    [Attribute::Element, Attribute::Name, Attribute::Residue, Attribute::Chain, Attribute::Model];

/// The atoms and bonds of a molecule, by what selectors can ask of them.
#[derive(Debug)]
pub(super) struct AtomClasses {
    /// The class of each atom.
    pub(super) of_atom: Vec<u32>,
    /// The classes of the two atoms of each bond.
    pub(super) of_bond: Vec<[u32; 2]>,
    /// The values of each class, as indices into `values`.
    pub(super) classes: Vec<[u32; ATTRIBUTES.len()]>,
    /// The different values of each attribute.
    pub(super) values: [Vec<String>; ATTRIBUTES.len()],
}

impl AtomClasses {
    /// Sorts the atoms of a molecule, in time linear in its size.
    pub(super) fn new(molecule: &Molecule) -> AtomClasses {
        let mut elements = Values::default();
        let mut names = Values::default();
        let mut residues = Values::default();
        let mut models = Values::default();
        // First the residues, of which there are fewer: what follows needs one number of each.
        let mut group_of: HashMap<(Name, u32, u32), u32> = HashMap::new();
        let mut groups: Vec<[u32; 3]> = Vec::new();
        let of_residue: Vec<u32> = molecule
            .residues
            .iter()
            .map(|of| {
                *group_of.entry((of.name, of.chain, of.model)).or_insert_with(|| {
                    let name = residues.number(of.name, Name::to_string);
                    groups.push([name, of.chain, models.number(of.model, u32::to_string)]);
                    groups.len() as u32 - 1
                })
            })
            .collect();
        let mut class_of: HashMap<(Name, u8, u32), u32> = HashMap::new();
        let mut classes = Vec::new();
        let of_atom: Vec<u32> = molecule
            .atoms
            .iter()
            .map(|atom| {
                let group = of_residue[atom.residue as usize];
                *class_of.entry((atom.name, atom.element.number(), group)).or_insert_with(|| {
                    let element = elements.number(atom.element.number(), |_| atom.element.symbol().to_owned());
                    let name = names.number(atom.name, Name::to_string);
                    let [residue, chain, model] = groups[group as usize];
                    classes.push([element, name, residue, chain, model]);
                    classes.len() as u32 - 1
                })
            })
            .collect();
        let of_bond = molecule.bonds.iter().map(|bond| [bond.a, bond.b].map(|atom| of_atom[atom as usize])).collect();
        let values = [
            elements.texts,
            names.texts,
            residues.texts,
            molecule.chains.iter().map(|chain| chain.id.clone()).collect(),
            models.texts,
        ];
        AtomClasses { of_atom, of_bond, classes, values }
    }

    /// The value of an attribute of a class.
    pub(super) fn value(&self, class: u32, attribute: Attribute) -> Option<&str> {
        let number = ATTRIBUTES.iter().position(|of| *of == attribute)?;
        Some(&self.values[number][self.classes[class as usize][number] as usize])
    }

    /// For each class whether a bond has an atom of it.
    pub(super) fn bonded(&self) -> Vec<bool> {
        let mut bonded = vec![false; self.classes.len()];
        self.of_bond.iter().flatten().for_each(|class| bonded[*class as usize] = true);
        bonded
    }
}

/// The different values of an attribute, in order of first appearance.
struct Values<T> {
    number_of: HashMap<T, u32>,
    texts: Vec<String>,
}

impl<T> Default for Values<T> {
    fn default() -> Self {
        Values { number_of: HashMap::new(), texts: Vec::new() }
    }
}

impl<T: std::hash::Hash + Eq> Values<T> {
    fn number(&mut self, value: T, text: impl FnOnce(&T) -> String) -> u32 {
        let texts = &mut self.texts;
        *self.number_of.entry(value).or_insert_with_key(|value| {
            texts.push(text(value));
            texts.len() as u32 - 1
        })
    }
}
