//! CIF files: macromolecules (mmCIF) and crystals of small molecules (core CIF).
//!
//! ```text
//! tokens -> loop_rows -> atom_site -> entry -> { crystal, bonds, assembly }
//! ```
//! A table of atoms in angstrom is read as it goes by, for it may be nearly all of the file; the other tables that matter
//! are kept until their data block ends. Binary files enter at `atom_site` and share all that follows.
//!
//! Chains, residues and atoms have the names that authors gave (`auth_asym_id`), else those of the archive. Data blocks
//! with atoms are models, counted on over all blocks; the first is drawn. Crystals are drawn as listed, which is the
//! asymmetric unit; `--assembly cell` fills the unit cell.
//!
//! Not read: anisotropic displacements, secondary structure, CIF 2.0's lists and triple quotes.

mod assembly;
mod atom_site;
mod bonds;
mod cell;
mod crystal;
mod disorder;
mod entry;
mod loop_rows;
mod operators;
mod places;
mod rows;
mod symbol;
mod symmetry;
mod table;
mod tokens;
mod value;

pub(super) use atom_site::Axes;
pub(super) use entry::{Block, Entry};
pub(super) use rows::{RowFault, Rows};
pub(super) use table::{Category, Table};
pub(super) use value::Value;

use super::Import;
use crate::scene::error::SceneError;
use crate::scene::molecule::Molecule;
use crate::scene::report::NoteKind;
use loop_rows::LoopRows;
use tokens::{Token, Tokens, Unclosed};

/// Reads all wanted models.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Molecule, SceneError> {
    let mut tokens = Tokens::new(bytes);
    let mut entry = Entry::new(import);
    let mut block = Block::default();
    while tokens.skip_space().is_some() {
        let line = tokens.line();
        match tokens.next() {
            Some(Token::Data(_)) => entry.end_block(import, &std::mem::take(&mut block))?,
            Some(Token::Loop) => read_loop(import, &mut tokens, &mut entry, &mut block, line)?,
            Some(Token::Name(name)) => {
                let value = tokens.value();
                if let (Some((category, column)), Some(value)) = (Category::split(name), value) {
                    block.table_mut(category).add_item(column, value, line);
                }
            }
            Some(Token::Value(_) | Token::Other) | None => {}
        }
    }
    entry.end_block(import, &block)?;
    for &(unclosed, line) in tokens.unclosed() {
        if unclosed == Unclosed::Quote {
            import.report.note(NoteKind::OpenQuote, line, String::new);
        }
    }
    if let Some(line) = tokens.unclosed_text_field() {
        if entry.is_empty() {
            let hint = format!("the text that begins in line {line} is never closed: write a line ; behind it");
            return Err(SceneError::NoAtoms { file: import.file.to_string(), hint });
        }
        import.report.note(NoteKind::OpenText, line, String::new);
    }
    entry.finish(import, "there is no row in a table _atom_site: download the whole entry")
}

/// Reads a loop, behind its first word.
fn read_loop<'a>(
    import: &mut Import<'_>,
    tokens: &mut Tokens<'a>,
    entry: &mut Entry,
    block: &mut Block<'a>,
    line: u32,
) -> Result<(), SceneError> {
    let (mut names, mut category) = (Vec::new(), None);
    while tokens.skip_space() == Some(b'_') {
        let Some(Token::Name(name)) = tokens.next() else { break };
        let split = Category::split(name);
        category = category.or(split.map(|(category, _)| category));
        names.push(split.map_or(name, |(_, column)| column));
    }
    let mut rows = LoopRows::new(tokens, names.len());
    let Some(category) = category else {
        rows.skip();
        return Ok(());
    };
    if category == Category::AtomSite {
        let Some(columns) = entry.columns(import, &names, Some(line)) else {
            rows.skip();
            return Ok(());
        };
        if columns.axes == Axes::Cartesian {
            return entry.read_atoms(import, &columns, &mut rows);
        }
    }
    let table = block.table_mut(category);
    *table = Table { names, line: Some(line), ..Table::default() };
    loop {
        match rows.advance(&mut import.report) {
            Ok(true) => {
                table.lines.extend(rows.line());
                table.values.extend((0..table.names.len()).map(|column| rows.value(column)));
            }
            Ok(false) => return Ok(()),
            Err(fault) if category == Category::AtomSite => return Err(atom_site::uneven(import, fault)),
            Err(RowFault { line, num_values, num_columns }) => {
                import.report.note(NoteKind::BadRow, line, || format!("{num_values} values for {num_columns} columns"));
                rows.skip();
                return Ok(());
            }
        }
    }
}
