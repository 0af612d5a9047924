//! Single and double bonds of aromatic rings, where a file only says that they are aromatic.
//!
//! Every carbon gets one double bond as far as that goes: a matching that grows along alternating paths [Edmonds1965,
//! without its blossoms: two odd rings in one path may keep a carbon single]. Nitrogens take part where they have room.

use super::table::{TableAtom, TableOrder};

const NONE: u32 = u32::MAX;

/// The orders of bonds between rows of a table, 1 to 3; `bonds` must name existing rows.
pub(super) fn orders(atoms: &[TableAtom], bonds: &[(u32, u32, TableOrder)]) -> Vec<u8> {
    let mut rings = Rings::new(atoms, bonds);
    if !rings.neighbors.is_empty() {
        rings.pair_up();
    }
    let order = |&(a, b, order): &(u32, u32, TableOrder)| match order {
        TableOrder::Fixed(order) => order,
        TableOrder::Aromatic if rings.mates.get(a as usize) == Some(&b) => 2,
        TableOrder::Aromatic => 1,
    };
    bonds.iter().map(order).collect()
}

/// The aromatic bonds of a table, and which of them are double.
#[derive(Default)]
struct Rings {
    /// Where each atom's neighbours begin in `neighbors`, and where the last one's end.
    starts: Vec<u32>,
    /// Atoms that aromatic bonds lead to, only those that may have a double bond.
    neighbors: Vec<u32>,
    /// The partner of each atom's double bond.
    mates: Vec<u32>,
    /// Who led to an atom in the search that is under way.
    parents: Vec<u32>,
    /// The last search that came by, by the atom it began at.
    seen: Vec<u32>,
}

impl Rings {
    fn new(atoms: &[TableAtom], bonds: &[(u32, u32, TableOrder)]) -> Self {
        let is_aromatic = |bond: &&(u32, u32, TableOrder)| bond.2 == TableOrder::Aromatic;
        if !bonds.iter().any(|bond| is_aromatic(&bond)) {
            return Self::default();
        }
        let mut degrees = vec![0_u32; atoms.len()];
        let mut is_full = vec![false; atoms.len()];
        for &(a, b, order) in bonds {
            for end in [a as usize, b as usize] {
                degrees[end] += 1;
                is_full[end] |= matches!(order, TableOrder::Fixed(2..));
            }
        }
        let may_be_double: Vec<bool> = atoms
            .iter()
            .enumerate()
            .map(|(row, atom)| {
                // Pyridine's nitrogen has room, pyrrole's has not; a positive charge makes room, in oxygen as well.
                let max_degree = match atom.element.number() {
                    6 => 3,
                    7 | 15 => 2 + u32::from(atom.charge > 0.5),
                    8 | 16 if atom.charge > 0.5 => 2,
                    _ => 0,
                };
                !is_full[row] && degrees[row] <= max_degree
            })
            .collect();
        let usable = |&&(a, b, order): &&(u32, u32, TableOrder)| {
            order == TableOrder::Aromatic && may_be_double[a as usize] && may_be_double[b as usize]
        };
        let mut starts = vec![0_u32; atoms.len() + 1];
        for &(a, b, _) in bonds.iter().filter(usable) {
            starts[a as usize + 1] += 1;
            starts[b as usize + 1] += 1;
        }
        for row in 1..starts.len() {
            starts[row] += starts[row - 1];
        }
        let mut ends = starts.clone();
        let mut neighbors = vec![0; starts.last().map_or(0, |&end| end as usize)];
        for &(a, b, _) in bonds.iter().filter(usable) {
            for (from, to) in [(a, b), (b, a)] {
                let end = &mut ends[from as usize];
                neighbors[*end as usize] = to;
                *end += 1;
            }
        }
        let none = vec![NONE; atoms.len()];
        Self { starts, neighbors, mates: none.clone(), parents: none.clone(), seen: none }
    }

    /// The aromatic neighbours of an atom.
    fn of(&self, row: u32) -> std::ops::Range<usize> {
        self.starts[row as usize] as usize..self.starts[row as usize + 1] as usize
    }

    /// Gives as many atoms as possible a double bond.
    fn pair_up(&mut self) {
        // Chemistry needs a few steps per atom. A file made to be slow keeps single bonds.
        let mut steps_left = 64 * self.neighbors.len() + 100_000;
        for row in 0..self.mates.len() as u32 {
            if self.mates[row as usize] == NONE && !self.of(row).is_empty() && steps_left > 0 {
                self.grow_from(row, &mut steps_left);
            }
        }
    }

    /// Searches breadth-first for a path from an atom without double bond to another, and shifts the bonds along it.
    fn grow_from(&mut self, root: u32, steps_left: &mut usize) {
        let mut queue = vec![root];
        self.seen[root as usize] = root;
        let mut head = 0;
        while let Some(&from) = queue.get(head) {
            head += 1;
            for index in self.of(from) {
                *steps_left = steps_left.saturating_sub(1);
                if *steps_left == 0 {
                    return;
                }
                let to = self.neighbors[index];
                if self.seen[to as usize] == root {
                    continue;
                }
                self.seen[to as usize] = root;
                self.parents[to as usize] = from;
                match self.mates[to as usize] {
                    NONE => return self.shift(to),
                    mate => {
                        self.seen[mate as usize] = root;
                        queue.push(mate);
                    }
                }
            }
        }
    }

    /// Makes every other bond of the path that ends here double.
    fn shift(&mut self, mut end: u32) {
        while end != NONE {
            let from = self.parents[end as usize];
            let next = std::mem::replace(&mut self.mates[from as usize], end);
            self.mates[end as usize] = from;
            end = next;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::element::Element;
    use crate::scene::name::Name;

    /// Double bonds of each atom in a table of elements, aromatic bonds and single bonds.
    fn doubles(symbols: &str, aromatic: &[(u32, u32)], single: &[(u32, u32)]) -> Vec<usize> {
        let atoms: Vec<TableAtom> = symbols
            .split(' ')
            .map(|symbol| TableAtom {
                number: 1,
                position: None,
                element: Element::from_symbol(symbol.as_bytes()).expect("a symbol"),
                name: Name::default(),
                charge: 0.0,
                residue_name: Name::default(),
                residue_number: 0,
                chain: Name::default(),
                is_hetero: false,
            })
            .collect();
        let aromatic = aromatic.iter().map(|&(a, b)| (a, b, TableOrder::Aromatic));
        let bonds: Vec<_> = aromatic.chain(single.iter().map(|&(a, b)| (a, b, TableOrder::Fixed(1)))).collect();
        let mut counts = vec![0; atoms.len()];
        for (&(a, b, _), order) in bonds.iter().zip(orders(&atoms, &bonds)) {
            if order == 2 {
                counts[a as usize] += 1;
                counts[b as usize] += 1;
            }
        }
        counts
    }

    #[test]
    fn benzene_and_naphthalene_alternate() {
        let ring = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0)];
        assert_eq!(doubles("C C C C C C", &ring, &[]), [1; 6]);
        // A greedy choice would pair the two in the middle first.
        assert_eq!(doubles("C C C C", &[(0, 2), (0, 1), (2, 3)], &[]), [1; 4]);
        let naphthalene = [(1, 2), (4, 9), (3, 4), (0, 1), (2, 3), (9, 0), (4, 5), (5, 6), (6, 7), (7, 8), (8, 9)];
        assert_eq!(doubles("C C C C C C C C C C", &naphthalene, &[]), [1; 10]);
    }

    #[test]
    fn nitrogen_takes_part_where_it_has_room() {
        let five = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)];
        assert_eq!(doubles("N C C C C H", &five, &[(0, 5)]), [0, 1, 1, 1, 1, 0]);
        assert_eq!(doubles("O C C C C", &five, &[]), [0, 1, 1, 1, 1]);
        let six = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0)];
        assert_eq!(doubles("N C C C C C", &six, &[]), [1; 6]);
    }

    #[test]
    fn a_long_ladder_of_rings_ends_soon() {
        let num = 20_000;
        let bonds: Vec<(u32, u32)> = (0..num - 1).map(|i| (i, i + 1)).chain((0..num - 5).map(|i| (i, i + 5))).collect();
        let symbols = vec!["C"; num as usize].join(" ");
        assert!(doubles(&symbols, &bonds, &[]).iter().all(|&count| count <= 1));
    }
}
