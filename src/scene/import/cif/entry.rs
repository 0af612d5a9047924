//! What is gathered from the blocks of a file, in text or binary form.

use super::super::Import;
use super::super::models::Models;
use super::assembly::{self, ChainRuns};
use super::atom_site::{Axes, Columns, SiteReader};
use super::bonds;
use super::crystal;
use super::rows::Rows;
use super::table::{Category, Table, TableRows};
use crate::scene::bonds::FileBond;
use crate::scene::builder::{MoleculeBuilder, NewCopy};
use crate::scene::error::SceneError;
use crate::scene::molecule::Molecule;
use crate::scene::report::NoteKind;

/// The tables of one data block that are kept.
#[derive(Debug, Default)]
pub(in crate::scene::import) struct Block<'a> {
    tables: [Table<'a>; Category::COUNT],
}

impl<'a> Block<'a> {
    /// A table, empty where the block has none.
    pub(super) fn table(&self, category: Category) -> &Table<'a> {
        &self.tables[category as usize]
    }

    /// A table to add to.
    pub(in crate::scene::import) fn table_mut(&mut self, category: Category) -> &mut Table<'a> {
        &mut self.tables[category as usize]
    }
}

/// The atoms, bonds and copies of all blocks so far.
pub(in crate::scene::import) struct Entry {
    builder: MoleculeBuilder,
    models: Models,
    runs: ChainRuns,
    file_bonds: Vec<FileBond>,
    copies: Vec<NewCopy>,
    /// Atoms of the blocks before.
    block_start: u32,
    /// Why a table of atoms could not be read.
    fault: Option<SceneError>,
}

impl Entry {
    pub(in crate::scene::import) fn new(import: &Import<'_>) -> Self {
        Self {
            builder: MoleculeBuilder::default(),
            models: Models::new(import.options.model),
            runs: ChainRuns::default(),
            file_bonds: Vec::new(),
            copies: Vec::new(),
            block_start: 0,
            fault: None,
        }
    }

    /// Whether there is no atom so far.
    pub(super) fn is_empty(&self) -> bool {
        self.builder.is_empty()
    }

    /// The columns of a table of atoms; none, which is remembered, if it has no coordinates.
    pub(in crate::scene::import) fn columns(
        &mut self,
        import: &Import<'_>,
        names: &[&[u8]],
        line: Option<u32>,
    ) -> Option<Columns> {
        let missing = match Columns::new(names) {
            Ok(columns) => return Some(columns),
            Err(missing) => missing,
        };
        let what = format!("the table of atoms has no column {missing}; save or download the file with coordinates");
        let file = import.file.to_string();
        let fault = match line {
            Some(line) => SceneError::Malformed { file, line, what },
            None => SceneError::Unsupported { file, what },
        };
        self.fault.get_or_insert(fault);
        None
    }

    /// Adds the atoms of a table in angstrom.
    pub(in crate::scene::import) fn read_atoms<'a>(
        &mut self,
        import: &mut Import<'_>,
        columns: &Columns,
        rows: &mut impl Rows<'a>,
    ) -> Result<(), SceneError> {
        let wants_chains = import.options.assembly.is_some();
        let mut reader = SiteReader::new(columns);
        while let Some(site) = reader.next(import, &mut self.models, rows)? {
            let index = self.builder.push(&site.atom);
            if wants_chains {
                self.runs.push(index, site.label_chain);
            }
        }
        Ok(())
    }

    /// Ends a block: atoms that waited for the cell, bonds, and the assembly that was asked for.
    pub(in crate::scene::import) fn end_block(
        &mut self,
        import: &mut Import<'_>,
        block: &Block<'_>,
    ) -> Result<(), SceneError> {
        let atoms = block.table(Category::AtomSite);
        let mut is_crystal = false;
        if !atoms.names.is_empty()
            && let Some(columns) = self.columns(import, &atoms.names, atoms.line)
        {
            is_crystal = columns.axes == Axes::Fractional;
            let mut rows = TableRows::new(atoms);
            if is_crystal {
                crystal::read(import, block, &columns, &mut rows, &mut self.models, &mut self.builder)?;
            } else {
                self.read_atoms(import, &columns, &mut rows)?;
            }
        }
        let block_atoms = self.block_start..self.builder.len() as u32;
        self.block_start = block_atoms.end;
        if block_atoms.is_empty() {
            return Ok(());
        }
        self.file_bonds.extend(bonds::of_block(block, &self.builder, block_atoms.clone(), &mut import.report));
        if !is_crystal && let Some(id) = &import.options.assembly {
            let copies = assembly::copies(import.file, id, block, &self.runs, block_atoms)?;
            self.copies.extend(copies);
        }
        Ok(())
    }

    /// Makes the molecule of all blocks; `hint` says what was missing if there are no atoms.
    pub(in crate::scene::import) fn finish(self, import: &mut Import<'_>, hint: &str) -> Result<Molecule, SceneError> {
        let Self { mut builder, models, file_bonds, copies, fault, .. } = self;
        if let Some(error) = models.missing(import.file) {
            return Err(error);
        }
        import.report.note_many(NoteKind::ModelSkipped, models.num_skipped(), String::new);
        if builder.is_empty()
            && let Some(fault) = fault
        {
            return Err(fault);
        }
        builder.set_copies(copies);
        builder.finish(&file_bonds, &mut import.report).ok_or_else(|| {
            let notes = import.report.to_string().trim_end().replace('\n', "; ");
            let hint = if notes.is_empty() { hint.to_string() } else { format!("no row of it can be drawn: {notes}") };
            SceneError::NoAtoms { file: import.file.to_string(), hint }
        })
    }
}
