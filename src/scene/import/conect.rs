//! `CONECT` records of PDB files: bonds between serial numbers.
//!
//! A record names an atom and up to four partners, in columns of five. Real files list each bond from both ends, and a
//! double bond twice from each [wwPDB format 3.3, CONECT, and common use]: the order is the larger count of either end.

use super::lines::quote;
use super::number::serial;
use crate::scene::bonds::FileBond;
use crate::scene::report::{NoteKind, Report};
use std::collections::HashMap;

/// Partners of one atom at most. Ours: chemistry needs 12, and models times records would not stay bounded without.
const MAX_PARTNERS: u8 = 16;

/// One mention of a bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Mention {
    low: u32,
    high: u32,
    /// Whether the record stands at the higher serial number.
    from_high: bool,
    line: u32,
}

/// Where an atom of the file went. Ordered by serial number, then model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct SerialPlace {
    /// Serial number.
    pub(super) serial: u32,
    /// Model number.
    pub(super) model: u32,
    /// Index in the builder.
    pub(super) atom: u32,
}

/// All `CONECT` records of a file.
#[derive(Debug, Default)]
pub(super) struct Conect {
    mentions: Vec<Mention>,
}

impl Conect {
    /// Reads one record; what is no pair of atoms is noted.
    pub(super) fn add(&mut self, line: u32, record: &[u8], report: &mut Report) {
        let record = record.trim_ascii_end();
        let field = |index: usize| {
            record.get((6 + 5 * index).min(record.len())..(11 + 5 * index).min(record.len())).unwrap_or_default()
        };
        let fields = (1..5).map(field).filter(|field| !field.trim_ascii().is_empty());
        let Some(from) = serial(field(0)) else {
            report.note(NoteKind::BadBondRecord, line, || quote(record));
            return;
        };
        for field in fields {
            match serial(field) {
                Some(to) if to != from => {
                    self.mentions.push(Mention { low: from.min(to), high: from.max(to), from_high: from > to, line });
                }
                _ => report.note(NoteKind::BadBondRecord, line, || {
                    format!("{} to {}", quote(self::trim(record)), quote(field))
                }),
            }
        }
    }

    /// Whether the file has no bonds.
    pub(super) fn is_empty(&self) -> bool {
        self.mentions.is_empty()
    }

    /// Serial numbers that bonds name, sorted, each once.
    pub(super) fn serials(&self) -> Vec<u32> {
        let mut serials: Vec<u32> = self.mentions.iter().flat_map(|mention| [mention.low, mention.high]).collect();
        serials.sort_unstable();
        serials.dedup();
        serials
    }

    /// The bonds, in every model that has both atoms. `places` are the atoms that bonds name. Missing atoms are noted if
    /// `is_complete`, that is, if no model was left out.
    pub(super) fn resolve(
        mut self,
        mut places: Vec<SerialPlace>,
        is_complete: bool,
        report: &mut Report,
    ) -> Vec<FileBond> {
        places.sort_unstable();
        self.mentions.sort_unstable();
        let mut pairs: Vec<(Mention, u8)> = Vec::new();
        for group in self.mentions.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
            let from_high = group.iter().filter(|mention| mention.from_high).count();
            let order = from_high.max(group.len() - from_high).min(3) as u8;
            let first = group.iter().min_by_key(|mention| mention.line).copied();
            pairs.extend(first.map(|mention| (mention, order)));
        }
        pairs.sort_unstable_by_key(|(mention, _)| mention.line);

        let mut num_partners: HashMap<u32, u8> = HashMap::new();
        let mut bonds = Vec::new();
        for (Mention { low, high, line, .. }, order) in pairs {
            if [low, high].iter().any(|end| num_partners.get(end).is_some_and(|&count| count >= MAX_PARTNERS)) {
                report.note(NoteKind::BadBondRecord, line, || format!("more than {MAX_PARTNERS} bonds of one atom"));
                continue;
            }
            [low, high].iter().for_each(|&end| *num_partners.entry(end).or_default() += 1);
            let (ends, others) = (of_serial(&places, low), of_serial(&places, high));
            if (ends.is_empty() || others.is_empty()) && is_complete {
                report.note(NoteKind::BondToNowhere, line, || format!("{low} to {high}"));
                continue;
            }
            let mut is_unique = true;
            let mut rest = others;
            for end in ends.chunk_by(|a, b| a.model == b.model) {
                let before = rest.partition_point(|place| place.model < end[0].model);
                rest = &rest[before..];
                let same = &rest[..rest.partition_point(|place| place.model <= end[0].model)];
                match (end, same) {
                    ([a], [b]) => bonds.push(FileBond { a: a.atom, b: b.atom, order }),
                    (_, []) => {}
                    _ => is_unique = false,
                }
            }
            if !is_unique {
                report.note(NoteKind::BondToNowhere, line, || format!("{low} to {high}"));
            }
        }
        bonds
    }
}

/// The number part of a record.
fn trim(record: &[u8]) -> &[u8] {
    record.get(6..11.min(record.len())).unwrap_or_default()
}

/// All atoms with a serial number.
fn of_serial(places: &[SerialPlace], serial: u32) -> &[SerialPlace] {
    let start = places.partition_point(|place| place.serial < serial);
    let length = places[start..].partition_point(|place| place.serial == serial);
    &places[start..start + length]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolve(records: &[&str], places: &[(u32, u32, u32)]) -> (Vec<(u32, u32, u8)>, Report) {
        let mut report = Report::default();
        let mut conect = Conect::default();
        for (line, record) in (1..).zip(records) {
            conect.add(line, record.as_bytes(), &mut report);
        }
        let places = places.iter().map(|&(serial, model, atom)| SerialPlace { serial, model, atom }).collect();
        let bonds = conect.resolve(places, true, &mut report);
        (bonds.into_iter().map(|bond| (bond.a, bond.b, bond.order)).collect(), report)
    }

    #[test]
    fn repeated_partners_are_higher_orders_and_both_ends_are_one_bond() {
        let places = [(1, 1, 0), (2, 1, 1), (3, 1, 2)];
        assert_eq!(resolve(&["CONECT    1    2", "CONECT    2    1"], &places).0, [(0, 1, 1)]);
        assert_eq!(
            resolve(&["CONECT    1    2    2", "CONECT    2    1    1    3"], &places).0,
            [(0, 1, 2), (1, 2, 1)]
        );
        assert_eq!(resolve(&["CONECT    1    2    2    2    2"], &places).0, [(0, 1, 3)]);
    }

    #[test]
    fn full_columns_need_no_spaces() {
        assert_eq!(resolve(&["CONECT1000110002"], &[(10_001, 1, 0), (10_002, 1, 1)]).0, [(0, 1, 1)]);
        assert_eq!(resolve(&["CONECTA0000A0001"], &[(100_000, 1, 0), (100_001, 1, 1)]).0, [(0, 1, 1)]);
    }

    #[test]
    fn nonsense_is_noted_with_its_line() {
        let records = ["CONECT    1 9999 8888", "CONECT    1    1", "CONECT   ab   cd", "CONECT", "CON"];
        let (bonds, report) = resolve(&records, &[(1, 1, 0)]);
        assert!(bonds.is_empty());
        assert_eq!(report.count(NoteKind::BondToNowhere), 2);
        assert_eq!(report.count(NoteKind::BadBondRecord), 4);
    }

    #[test]
    fn every_model_gets_the_bonds() {
        let places = [(1, 1, 0), (2, 1, 1), (1, 2, 2), (2, 2, 3), (1, 3, 4)];
        assert_eq!(resolve(&["CONECT    1    2"], &places).0, [(0, 1, 1), (2, 3, 1)]);
    }

    #[test]
    fn ambiguous_serials_bond_nothing() {
        let (bonds, report) = resolve(&["CONECT    1    2"], &[(1, 1, 0), (1, 1, 1), (2, 1, 2)]);
        assert!(bonds.is_empty());
        assert_eq!(report.count(NoteKind::BondToNowhere), 1);
    }

    #[test]
    fn a_star_of_a_thousand_bonds_is_cut() {
        let records: Vec<String> = (2..1000).map(|serial| format!("CONECT    1{serial:>5}")).collect();
        let records: Vec<&str> = records.iter().map(String::as_str).collect();
        let places: Vec<(u32, u32, u32)> = (1..1000).map(|serial| (serial, 1, serial - 1)).collect();
        assert_eq!(resolve(&records, &places).0.len(), usize::from(MAX_PARTNERS));
    }
}
