//! Bonds of known residues by the names of their atoms, and what they leave to the search by distance.
//!
//! A template's bond counts only where its length is one that the search would take as well. An atom whose bonds all
//! count is closed: it gets no others by distance, however near a neighbour comes. Left open are atoms that no template
//! names, those without a bond or with a bond of a wrong length, and hydrogens of residues with such atoms. Chains are
//! linked from residue to residue; ends that find no link may still be linked by distance, to an end of the other kind.

use super::bond_table::TABLE;
use super::bonds::{MIN_DISTANCE, are_exclusive, longest};
use super::element::Element;
use super::molecule::{Atom, Bond, Residue, ResidueKind};
use super::name::Name;
use std::ops::Range;

/// What may still bond an atom by distance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum State {
    /// Any other atom.
    #[default]
    Open,
    /// Open atoms only; a hydrogen nothing.
    Closed,
    /// As closed, and the nitrogen that begins a peptide of the same chain: carbon.
    PeptideEnd,
    /// As closed, and the carbon that ends a peptide of the same chain: nitrogen.
    PeptideStart,
    /// As closed, and the phosphorus of a nucleotide of the same chain: oxygen 3'.
    NucleotideEnd,
    /// As closed, and the oxygen 3' of a nucleotide of the same chain: phosphorus.
    NucleotideStart,
    /// As closed, and another sulphur: cystine.
    Sulfur,
}

impl State {
    /// Whether two atoms that templates describe may be linked by distance.
    pub(super) fn links(self, other: Self, is_same_chain: bool) -> bool {
        use State::{NucleotideEnd, NucleotideStart, PeptideEnd, PeptideStart, Sulfur};
        match (self, other) {
            (PeptideEnd, PeptideStart) | (PeptideStart, PeptideEnd) => is_same_chain,
            (NucleotideEnd, NucleotideStart) | (NucleotideStart, NucleotideEnd) => is_same_chain,
            (Sulfur, Sulfur) => true,
            _ => false,
        }
    }

    /// What an atom of a template becomes, by its name.
    fn of(name: Name) -> Self {
        match name.as_str() {
            "C" => Self::PeptideEnd,
            "N" => Self::PeptideStart,
            "O3'" => Self::NucleotideEnd,
            "P" => Self::NucleotideStart,
            "SG" => Self::Sulfur,
            _ => Self::Closed,
        }
    }
}

/// Bonds by templates, and what they leave open.
pub(super) struct Described {
    /// Unique, `a < b`.
    pub(super) bonds: Vec<Bond>,
    /// One per atom.
    pub(super) states: Vec<State>,
}

/// The atoms that end a residue of a chain, for its link with the next.
#[derive(Clone, Copy)]
struct ChainEnd {
    residue: u32,
    atom: u32,
}

/// Finds the residues that have templates. `has_own_orders` says of which residues the file knows orders of bonds; in those,
/// all bonds by templates are single.
pub(super) fn describe(atoms: &[Atom], residues: &[Residue], has_own_orders: &[bool]) -> Described {
    let mut matcher = Matcher {
        atoms,
        bonds: Vec::with_capacity(atoms.len() + atoms.len() / 16),
        states: vec![State::Open; atoms.len()],
        slots: Vec::new(),
        places: Vec::new(),
    };
    let mut last_end: Option<ChainEnd> = None;
    let mut start = 0;
    while start < atoms.len() {
        let index = atoms[start].residue;
        let length = atoms[start..].iter().take_while(|atom| atom.residue == index).count();
        let (range, residue) = (start..start + length, &residues[index as usize]);
        start += length;
        if residue.kind == ResidueKind::Water {
            matcher.add_water(range);
            last_end = None;
            continue;
        }
        let with_orders = has_own_orders.get(index as usize) != Some(&true);
        let Some([first, last]) = matcher.add_residue(range, residue.name, with_orders) else {
            last_end = None;
            continue;
        };
        if let (Some(end), Some(first)) = (last_end, first) {
            let before = &residues[end.residue as usize];
            if (before.chain, before.model) == (residue.chain, residue.model) {
                matcher.link(end.atom, first);
            }
        }
        last_end = last.map(|atom| ChainEnd { residue: index, atom });
    }
    Described { bonds: matcher.bonds, states: matcher.states }
}

/// An atom that its template does not have, or a place without atom.
const NONE: u32 = u32::MAX;

struct Matcher<'a> {
    atoms: &'a [Atom],
    bonds: Vec<Bond>,
    states: Vec<State>,
    /// The atom in each place of the template that is being matched.
    slots: Vec<u32>,
    /// How the bonds of each place turned out: whether one counts, whether one has a wrong length.
    places: Vec<(bool, bool)>,
}

impl Matcher<'_> {
    /// Whether two atoms are at the distance of a bond.
    fn is_bond(&self, a: u32, b: u32) -> bool {
        let (a, b) = (&self.atoms[a as usize], &self.atoms[b as usize]);
        let limit = longest(a.element, b.element);
        let squared = a.position.distance_squared(b.position);
        (MIN_DISTANCE * MIN_DISTANCE..=limit * limit).contains(&squared)
    }

    fn add_bond(&mut self, a: u32, b: u32, order: u8) {
        self.bonds.push(Bond { a: a.min(b), b: a.max(b), order });
    }

    /// Bonds the atoms of a residue; the atoms that begin and end it in its chain, or none if it has no template.
    fn add_residue(&mut self, range: Range<usize>, name: Name, with_orders: bool) -> Option<[Option<u32>; 2]> {
        let template = TABLE.find(name)?;
        self.slots.clear();
        self.slots.resize(template.names.len(), NONE);
        self.places.clear();
        self.places.resize(template.names.len(), (false, false));
        let (mut cursor, mut is_whole, mut num_hydrogens) = (0, true, 0_u32);
        for index in range.clone() {
            let atom = &self.atoms[index];
            if atom.element == Element::HYDROGEN {
                num_hydrogens += 1;
                continue;
            }
            let name = if template.is_nucleotide { atom.name.with_primes() } else { atom.name };
            // Files mostly have the order of the template.
            let (before, after) = template.names.split_at(cursor);
            let after = after.iter().position(|&other| other == name).map(|place| place + cursor);
            let place = after.or_else(|| before.iter().position(|&other| other == name));
            match place {
                Some(place) if self.slots[place] == NONE && is_element_of(atom.element, name) => {
                    self.slots[place] = index as u32;
                    cursor = (place + 1) % template.names.len();
                }
                _ => is_whole = false,
            }
        }
        for &(place_a, place_b, order) in &template.bonds {
            let (a, b) = (self.slots[place_a as usize], self.slots[place_b as usize]);
            if a == NONE || b == NONE {
                continue;
            }
            let is_bond = self.is_bond(a, b) && !are_exclusive(&self.atoms[a as usize], &self.atoms[b as usize]);
            if is_bond {
                self.add_bond(a, b, if with_orders { order } else { 1 });
            }
            for place in [place_a, place_b] {
                let (counts, fails) = &mut self.places[place as usize];
                *counts |= is_bond;
                *fails |= !is_bond;
            }
        }
        let mut ends = [None; 2];
        for place in 0..self.slots.len() {
            let index = self.slots[place];
            if index == NONE {
                continue;
            }
            if self.places[place] != (true, false) {
                is_whole = false;
                continue;
            }
            let state = State::of(template.names[place]);
            self.states[index as usize] = state;
            match state {
                State::PeptideStart | State::NucleotideStart => ends[0] = Some(index),
                State::PeptideEnd | State::NucleotideEnd => ends[1] = Some(index),
                _ => {}
            }
        }
        if is_whole && num_hydrogens > 0 {
            self.add_hydrogens(range);
        }
        Some(ends)
    }

    /// Bonds each hydrogen of a residue to the nearest atom in a slot.
    fn add_hydrogens(&mut self, range: Range<usize>) {
        for index in range.filter(|&index| self.atoms[index].element == Element::HYDROGEN) {
            let atom = &self.atoms[index];
            let mut nearest = (f32::INFINITY, NONE);
            for &slot in self.slots.iter().filter(|&&slot| slot != NONE) {
                let other = &self.atoms[slot as usize];
                let squared = atom.position.distance_squared(other.position);
                if squared < nearest.0 && !are_exclusive(atom, other) {
                    nearest = (squared, slot);
                }
            }
            if nearest.1 != NONE && self.is_bond(index as u32, nearest.1) {
                self.add_bond(index as u32, nearest.1, 1);
                self.states[index] = State::Closed;
            }
        }
    }

    /// Bonds a water that stands alone in its residue.
    fn add_water(&mut self, range: Range<usize>) {
        let mut heavy = range.clone().filter(|&index| self.atoms[index].element != Element::HYDROGEN);
        if let (Some(oxygen), None) = (heavy.next(), heavy.next()) {
            self.slots.clear();
            self.slots.push(oxygen as u32);
            self.states[oxygen] = State::Closed;
            self.add_hydrogens(range);
        }
    }

    /// Links the end of a residue with the beginning of the next, if they are near enough.
    fn link(&mut self, end: u32, start: u32) {
        let fits = self.states[end as usize].links(self.states[start as usize], true);
        if fits && self.is_bond(end, start) {
            self.add_bond(end, start, 1);
            self.states[end as usize] = State::Closed;
            self.states[start as usize] = State::Closed;
        }
    }
}

/// Whether an atom is of the element that a template's name begins with.
fn is_element_of(element: Element, name: Name) -> bool {
    let symbol = element.symbol().as_bytes();
    let name = name.as_str().as_bytes();
    name.first() == symbol.first() && (symbol.len() == 1 || name == b"SE" && symbol == b"Se")
}
