//! Tables of atoms and bonds as SDF and MOL2 files have them: bonds name atoms by number and may be aromatic.

use super::Import;
use super::kekule;
use super::lines::quote;
use crate::scene::bonds::FileBond;
use crate::scene::builder::{MoleculeBuilder, NewAtom};
use crate::scene::element::Element;
use crate::scene::error::SceneError;
use crate::scene::name::Name;
use crate::scene::report::NoteKind;
use glam::DVec3;

/// One atom of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct TableAtom {
    /// The number that bonds name it by.
    pub(super) number: u32,
    /// In angstrom; none if a coordinate is no number, and then it is not drawn.
    pub(super) position: Option<DVec3>,
    pub(super) element: Element,
    pub(super) name: Name,
    /// In elementary charges.
    pub(super) charge: f32,
    pub(super) residue_name: Name,
    pub(super) residue_number: i32,
    pub(super) chain: Name,
    pub(super) is_hetero: bool,
}

/// How a table's bond is to be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TableOrder {
    /// 1 for single, 2 for double, 3 for triple.
    Fixed(u8),
    /// Single or double, as alternates in its ring.
    Aromatic,
}

/// One bond of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct TableBond {
    /// Line of the file, from 1.
    pub(super) line: u32,
    /// Numbers of its atoms.
    pub(super) ends: [u32; 2],
    pub(super) order: TableOrder,
}

/// One molecule of a file.
#[derive(Debug, Default)]
pub(super) struct Table {
    pub(super) atoms: Vec<TableAtom>,
    pub(super) bonds: Vec<TableBond>,
}

impl Table {
    /// Hands atoms and bonds on; bonds of atoms that are missing, left out or not unique are noted.
    pub(super) fn push(
        self,
        import: &mut Import<'_>,
        model: u32,
        builder: &mut MoleculeBuilder,
        file_bonds: &mut Vec<FileBond>,
    ) {
        let mut rows: Vec<(u32, u32)> = (0..).zip(&self.atoms).map(|(row, atom)| (atom.number, row)).collect();
        rows.sort_unstable();
        let num_repeated: usize = rows.chunk_by(|a, b| a.0 == b.0).filter(|rows| rows.len() > 1).map(<[_]>::len).sum();
        import.report.note_many(NoteKind::DuplicateSerial, num_repeated as u32, String::new);
        let row_of = |number: u32| {
            let first = rows.partition_point(|&(other, _)| other < number);
            let mut same = rows[first..].iter().take_while(|&&(other, _)| other == number);
            let row = same.next()?.1;
            same.next().is_none().then_some(row)
        };
        let mut bonds = Vec::with_capacity(self.bonds.len());
        for bond in &self.bonds {
            let [a, b] = bond.ends;
            if a == b {
                import.report.note(NoteKind::BadBondRecord, bond.line, || format!("{a} to itself"));
                continue;
            }
            let rows = row_of(a).zip(row_of(b));
            let drawn = |row: u32| self.atoms[row as usize].position.is_some();
            match rows {
                Some((a, b)) if drawn(a) && drawn(b) => bonds.push((a, b, bond.order)),
                _ => import.report.note(NoteKind::BondToNowhere, bond.line, || format!("{a} to {b}")),
            }
        }
        let orders = kekule::orders(&self.atoms, &bonds);
        let new_index: Vec<u32> = self.atoms.iter().map(|atom| push_atom(atom, model, builder)).collect();
        let index = |row: u32| new_index[row as usize];
        let bonds = bonds.iter().zip(orders);
        file_bonds.extend(bonds.map(|(&(a, b, _), order)| FileBond { a: index(a), b: index(b), order }));
    }
}

/// Adds an atom, if it is drawn; its index.
fn push_atom(atom: &TableAtom, model: u32, builder: &mut MoleculeBuilder) -> u32 {
    let Some(position) = atom.position else { return u32::MAX };
    builder.push(&NewAtom {
        position,
        element: atom.element,
        name: atom.name,
        alt_loc: 0,
        occupancy: 1.0,
        residue_name: atom.residue_name,
        residue_number: atom.residue_number,
        insertion_code: 0,
        is_hetero: atom.is_hetero,
        chain: atom.chain.as_str().as_bytes(),
        model,
        b_factor: 0.0,
        charge: atom.charge,
    })
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// The error of a count that is not that of the lines.
pub(super) fn count_error(import: &Import<'_>, line: u32, announced: i64, what: &str, found: usize) -> SceneError {
    let follow = if found == 1 { "follows" } else { "follow" };
    let way_out = if announced > found as i64 {
        format!("write {found} if they are all, else the file was cut short")
    } else {
        format!("write {found}, or delete the lines that are too many")
    };
    let what = if announced == 1 { what.trim_end_matches('s') } else { what };
    import.malformed(line, format!("announces {announced} {what}, but {found} {follow}; {way_out}"))
}

/// The error of a line that is no row of a table.
pub(super) fn row_error(import: &Import<'_>, line: u32, found: &[u8], belongs: &str, way_out: &str) -> SceneError {
    import.malformed(line, format!("found {} where {belongs} belongs; {way_out}", quote(found)))
}

/// The error of a file whose tables give no atom that can be drawn.
pub(super) fn no_atoms(import: &Import<'_>, where_they_belong: &str) -> SceneError {
    let notes = import.report.to_string().trim_end().replace('\n', "; ");
    let hint = if notes.is_empty() {
        format!("{where_they_belong}: export the molecule anew")
    } else {
        format!("no line of it can be drawn: {notes}")
    };
    SceneError::NoAtoms { file: import.file.to_string(), hint }
}
