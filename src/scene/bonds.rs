//! Bonds: those that the file names, those of known residues, and those that distances tell.
//!
//! Amino acids, nucleotides and waters have the bonds of their templates ([`bond_templates`](super::bond_templates)), and
//! no others among themselves but the links of chains and cystines. Of all others, two atoms are bonded by distance if they are nearer than the sum of their covalent radii plus 0.45 angstrom and farther
//! apart than 0.4 [OpenBabel, `OBMol::ConnectTheDots` in src/mol.cpp: rule and both numbers]. Exceptions:
//! - A hydrogen has one bond, to its nearest heavy atom (else to its nearest hydrogen), and none if the file gives one.
//! - Two metals never bond; a metal and a non-metal do, with the same tolerance: Co-Cl at 2.4 angstrom is a bond.
//! - Alkali metals and calcium to radium bond only if the file says so ([`Element::is_ionic`]): rock salt has no bonds.
//! - Models never bond with each other, nor waters, nor different alternate locations (but for a chain's own links).
//! - An atom whose bonds the file lists is left as it is: see [`find`].
//! - Non-metals keep their 8 nearest bonds, metals their 12 (ferrocene's iron has 10).
//!
//! Limits: bridging hydrogens (diborane) keep one bond; bonds by distance are single.

use super::bond_templates::{State, describe};
use super::element::Element;
use super::grid::{Grid, Near};
use super::guess::{is_polymer_residue, is_water};
use super::molecule::{Atom, Bond, Residue, ResidueKind};
use super::report::{NoteKind, Report};
use std::cell::Cell;
use std::ops::Range;

/// Slack over the sum of covalent radii, in angstrom.
const TOLERANCE: f32 = 0.45;
/// Nearer atoms are taken for one atom written twice, in angstrom.
pub(super) const MIN_DISTANCE: f32 = 0.4;
/// A file's bond may be this many times as long as one by distance. Ours: coarse beads 5 angstrom apart pass, a bond
/// that leaves a crystal's cell and should enter it again on the other side does not.
const LONGEST_FILE_BOND: f32 = 3.0;
/// A file's bond shorter than this, in angstrom, has no direction to draw it in.
const SHORTEST_FILE_BOND: f32 = 0.05;
/// Bonds by distance that an atom keeps.
const MAX_BONDS: u8 = 8;
/// The same for a metal.
const MAX_BONDS_METAL: u8 = 12;
/// Candidates per atom, so that a crowd takes bounded memory; real atoms have at most 12.
const MAX_CANDIDATES: u8 = 16;

/// A bond that a file names; indices are those of [`MoleculeBuilder::push`](super::builder::MoleculeBuilder::push).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileBond {
    /// One atom.
    pub a: u32,
    /// The other atom.
    pub b: u32,
    /// 1 for single, 2 for double, 3 for triple.
    pub order: u8,
}

/// Two atoms near enough to bond.
#[derive(Clone, Copy)]
struct Candidate {
    a: u32,
    b: u32,
    distance_squared: f32,
}

/// All bonds, unique, sorted, `a < b`.
///
/// Real PDB files list the bonds of ligands, not those of amino acids and nucleotides. So an atom counts as described if
/// the file names a bond of it and its residue is neither amino acid, nucleotide nor water; two described atoms get no bond
/// by distance, nor do two that templates describe, all other pairs may.
pub(super) fn find(atoms: &[Atom], residues: &[Residue], file_bonds: &[FileBond], report: &mut Report) -> Vec<Bond> {
    let mut bonds = accept_file_bonds(atoms, file_bonds, report);
    let described = describe(atoms, residues, &residues_with_orders(atoms, residues, &bonds));
    let context = Context::new(atoms, residues, &bonds, described.states);
    let mut search = Search::new(atoms, &context);
    let mut start = 0;
    while start < atoms.len() {
        let model = residues[atoms[start].residue as usize].model;
        let length = atoms[start..].iter().take_while(|atom| residues[atom.residue as usize].model == model).count();
        search.add_model(start..start + length);
        start += length;
    }
    let num_cut = search.cut.iter().filter(|&&cut| cut).count();
    report.note_many(NoteKind::Crowded, num_cut as u32, String::new);
    bonds.extend(described.bonds);
    bonds.extend(filter(atoms, search.found).into_iter().map(|Candidate { a, b, .. }| Bond { a, b, order: 1 }));
    // A bond found twice keeps its highest order.
    bonds.sort_unstable_by_key(|bond| (bond.a, bond.b, std::cmp::Reverse(bond.order)));
    bonds.dedup_by_key(|bond| (bond.a, bond.b));
    bonds.shrink_to_fit();
    bonds
}

/// The bonds of the file that join two different atoms at a sane distance.
fn accept_file_bonds(atoms: &[Atom], file_bonds: &[FileBond], report: &mut Report) -> Vec<Bond> {
    let mut bonds = Vec::with_capacity(file_bonds.len());
    for &FileBond { a, b, order } in file_bonds {
        let (a, b) = (a.min(b), a.max(b));
        let (Some(atom_a), Some(atom_b)) = (atoms.get(a as usize), atoms.get(b as usize)) else {
            continue;
        };
        if a == b {
            continue;
        }
        let length = atom_a.position.distance(atom_b.position);
        let longest = LONGEST_FILE_BOND * longest(atom_a.element, atom_b.element);
        if !(SHORTEST_FILE_BOND..=longest).contains(&length) {
            report.note(NoteKind::OddBond, None, || format!("{}-{}, {length:.1} angstrom", atom_a.name, atom_b.name));
            continue;
        }
        bonds.push(Bond { a, b, order: order.clamp(1, 3) });
    }
    bonds
}

/// For each residue whether the file gives a bond in it that is not single; no residue if the file has no such bond.
fn residues_with_orders(atoms: &[Atom], residues: &[Residue], file_bonds: &[Bond]) -> Vec<bool> {
    let mut has_orders = Vec::new();
    for bond in file_bonds.iter().filter(|bond| bond.order > 1) {
        has_orders.resize(residues.len(), false);
        for end in [bond.a, bond.b] {
            has_orders[atoms[end as usize].residue as usize] = true;
        }
    }
    has_orders
}

/// Whether two atoms never exist together, as they belong to different alternate locations.
pub(super) fn are_exclusive(a: &Atom, b: &Atom) -> bool {
    a.alt_loc != 0 && b.alt_loc != 0 && a.alt_loc != b.alt_loc
}

/// The longest bond of two elements, in angstrom.
pub(super) fn longest(a: Element, b: Element) -> f32 {
    a.covalent_radius() + b.covalent_radius() + TOLERANCE
}

/// What besides elements and distance decides about a bond.
struct Context<'a> {
    atoms: &'a [Atom],
    residues: &'a [Residue],
    is_water: Vec<bool>,
    is_described: Vec<bool>,
    states: Vec<State>,
}

impl<'a> Context<'a> {
    fn new(atoms: &'a [Atom], residues: &'a [Residue], file_bonds: &[Bond], mut states: Vec<State>) -> Self {
        let mut is_described = vec![false; if file_bonds.is_empty() { 0 } else { atoms.len() }];
        for index in file_bonds.iter().flat_map(|bond| [bond.a as usize, bond.b as usize]) {
            let name = residues[atoms[index].residue as usize].name;
            is_described[index] = !is_polymer_residue(name.as_str()) && !is_water(name.as_str());
            if atoms[index].element == Element::HYDROGEN {
                states[index] = State::Closed;
            }
        }
        let is_water = residues.iter().map(|residue| residue.kind == ResidueKind::Water).collect();
        Self { atoms, residues, is_water, is_described, states }
    }

    /// Whether a bond by distance may join two atoms.
    fn allows(&self, a: u32, b: u32) -> bool {
        let described = |index: u32| self.is_described.get(index as usize) == Some(&true);
        if described(a) && described(b) {
            return false;
        }
        let (atom_a, atom_b) = (&self.atoms[a as usize], &self.atoms[b as usize]);
        let (state_a, state_b) = (self.states[a as usize], self.states[b as usize]);
        if state_a != State::Open && state_b != State::Open {
            let chain = |atom: &Atom| self.residues[atom.residue as usize].chain;
            return state_a.links(state_b, chain(atom_a) == chain(atom_b));
        }
        // A hydrogen that has its bond wants no other.
        let is_bonded = |atom: &Atom, state| atom.element == Element::HYDROGEN && state != State::Open;
        if is_bonded(atom_a, state_a) || is_bonded(atom_b, state_b) {
            return false;
        }
        if atom_a.residue != atom_b.residue
            && self.is_water[atom_a.residue as usize]
            && self.is_water[atom_b.residue as usize]
        {
            return false;
        }
        !are_exclusive(atom_a, atom_b) || self.is_chain_link(atom_a, atom_b)
    }

    /// Whether two atoms are the peptide or phosphate link of neighbours, each of which chose its own alternate location.
    fn is_chain_link(&self, a: &Atom, b: &Atom) -> bool {
        let names = [a.name.as_str(), b.name.as_str()];
        let linked = [["C", "N"], ["N", "C"], ["O3'", "P"], ["P", "O3'"]].contains(&names);
        let (a, b) = (&self.residues[a.residue as usize], &self.residues[b.residue as usize]);
        linked && a.chain == b.chain && a.number.abs_diff(b.number) <= 1 && a != b
    }
}

/// The search for pairs that are near enough to bond.
struct Search<'a> {
    atoms: &'a [Atom],
    context: &'a Context<'a>,
    found: Vec<Candidate>,
    /// Candidates of each atom so far.
    counts: Vec<u8>,
    /// Atoms whose neighbours were too many to try them all.
    cut: Vec<bool>,
}

impl<'a> Search<'a> {
    fn new(atoms: &'a [Atom], context: &'a Context<'a>) -> Self {
        Self { atoms, context, found: Vec::new(), counts: vec![0; atoms.len()], cut: vec![false; atoms.len()] }
    }

    /// Searches among the atoms of one model.
    fn add_model(&mut self, range: Range<usize>) {
        let Self { atoms, context, found, counts, cut } = self;
        let points = range.clone().zip(&atoms[range]).filter(|(_, atom)| !atom.element.is_ionic());
        let (mut metal, mut other) = (0.0_f32, 0.0_f32);
        for (_, atom) in points.clone() {
            let largest = if atom.element.is_metal() { &mut metal } else { &mut other };
            *largest = largest.max(atom.element.covalent_radius());
        }
        if other == 0.0 {
            return; // Nothing but metals.
        }
        let longest_bond = other + metal.max(other) + TOLERANCE;
        let is_open = |index: usize| context.states[index] == State::Open;
        let open = points.clone().filter(|&(index, _)| is_open(index)).map(|(_, atom)| atom.position);
        let near = Near::new(points.clone().map(|(_, atom)| atom.position), open, longest_bond);
        let points =
            points.filter(|&(index, atom)| context.states[index] != State::Closed || near.contains(atom.position));
        let within = MIN_DISTANCE * MIN_DISTANCE..=longest_bond * longest_bond;
        let cut = Cell::from_mut(cut.as_mut_slice()).as_slice_of_cells();
        let grid = Grid::new(points.map(|(index, atom)| (index as u32, atom.position)), longest_bond);
        grid.pairs(
            |a, b, distance_squared| {
                if !within.contains(&distance_squared) {
                    return;
                }
                let (element_a, element_b) = (atoms[a as usize].element, atoms[b as usize].element);
                let limit = longest(element_a, element_b);
                let metals = element_a.is_metal() && element_b.is_metal();
                if distance_squared > limit * limit || metals || !context.allows(a, b) {
                    return;
                }
                if let Some(&full) = [a, b].iter().find(|&&end| counts[end as usize] >= MAX_CANDIDATES) {
                    cut[full as usize].set(true);
                    return;
                }
                counts[a as usize] += 1;
                counts[b as usize] += 1;
                found.push(Candidate { a: a.min(b), b: a.max(b), distance_squared });
            },
            |index| cut[index as usize].set(true),
        );
    }
}

/// Leaves hydrogens one bond and all others their nearest few.
fn filter(atoms: &[Atom], mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    const NONE: u32 = u32::MAX;
    let element = |index: u32| atoms[index as usize].element;
    let is_hydrogen = |index: u32| element(index) == Element::HYDROGEN;
    let mut choice = vec![NONE; atoms.len()];
    for (number, candidate) in candidates.iter().enumerate() {
        for (hydrogen, partner) in [(candidate.a, candidate.b), (candidate.b, candidate.a)] {
            if !is_hydrogen(hydrogen) {
                continue;
            }
            let chosen = &mut choice[hydrogen as usize];
            let better = *chosen == NONE || {
                let old = candidates[*chosen as usize];
                let old_partner = if old.a == hydrogen { old.b } else { old.a };
                let rank = |partner: u32, candidate: &Candidate| (is_hydrogen(partner), candidate.distance_squared);
                rank(partner, candidate) < rank(old_partner, &old)
            };
            if better {
                *chosen = number as u32;
            }
        }
    }
    let mut number = 0;
    candidates.retain(|candidate| {
        let keep = [candidate.a, candidate.b].iter().all(|&end| !is_hydrogen(end) || choice[end as usize] == number);
        number += 1;
        keep
    });

    let limit = |index: u32| {
        if element(index).is_metal() { MAX_BONDS_METAL } else { MAX_BONDS }
    };
    let mut degrees = vec![0_u8; atoms.len()];
    let mut crowded = false;
    for index in candidates.iter().flat_map(|candidate| [candidate.a, candidate.b]) {
        degrees[index as usize] += 1;
        crowded |= degrees[index as usize] > limit(index);
    }
    if crowded {
        degrees.fill(0);
        candidates.sort_unstable_by(|x, y| {
            x.distance_squared.total_cmp(&y.distance_squared).then((x.a, x.b).cmp(&(y.a, y.b)))
        });
        candidates.retain(|&Candidate { a, b, .. }| {
            let keep = degrees[a as usize] < limit(a) && degrees[b as usize] < limit(b);
            if keep {
                degrees[a as usize] += 1;
                degrees[b as usize] += 1;
            }
            keep
        });
    }
    candidates
}
