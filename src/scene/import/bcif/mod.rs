//! BinaryCIF: the tables of mmCIF, column by column, compressed, in MessagePack.
//!
//! ```text
//! msgpack -> column -> encoding
//! ```
//! Only the columns that are asked for are decoded; what follows is shared with CIF texts.

mod column;
mod encoding;
mod msgpack;

use super::Import;
use super::cif::{Axes, Block, Category, Entry, RowFault, Rows, Table, Value};
use crate::scene::error::SceneError;
use crate::scene::molecule::Molecule;
use crate::scene::report::Report;
use column::Column;
use msgpack::Node;

/// Rows that a table may have in any file; above it, no more than the file has bytes.
const ALWAYS_ALLOWED_ROWS: usize = 4096;

/// Columns of atoms that are read.
const ATOM_COLUMNS: &[&str] = &[
    "group_PDB",
    "type_symbol",
    "label_atom_id",
    "auth_atom_id",
    "label_alt_id",
    "label_comp_id",
    "auth_comp_id",
    "label_asym_id",
    "auth_asym_id",
    "label_seq_id",
    "auth_seq_id",
    "pdbx_PDB_ins_code",
    "Cartn_x",
    "Cartn_y",
    "Cartn_z",
    "fract_x",
    "fract_y",
    "fract_z",
    "occupancy",
    "B_iso_or_equiv",
    "U_iso_or_equiv",
    "pdbx_formal_charge",
    "pdbx_PDB_model_num",
    "label",
    "disorder_group",
    "disorder_assembly",
    "calc_flag",
];

/// Reads all wanted models.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Molecule, SceneError> {
    let root = msgpack::parse(bytes).map_err(|fault| SceneError::MalformedAt {
        file: import.file.to_string(),
        byte: fault.byte as u64,
        what: format!("{}; download or save the file again", fault.what),
    })?;
    let limit = bytes.len().max(ALWAYS_ALLOWED_ROWS);
    let blocks = root.get("dataBlocks").map(Node::items).unwrap_or_default();
    let mut entry = Entry::new(import);
    for block in blocks {
        read_block(import, &mut entry, bytes, block, limit)?;
    }
    entry.finish(import, "there is no row in a table _atom_site: download the whole entry")
}

/// A table of the file.
struct BinaryTable<'a> {
    names: Vec<&'a [u8]>,
    columns: Vec<Column<'a>>,
    num_rows: usize,
}

/// Reads the tables of a block that matter.
fn read_block<'a>(
    import: &mut Import<'_>,
    entry: &mut Entry,
    bytes: &'a [u8],
    block: &Node<'a>,
    limit: usize,
) -> Result<(), SceneError> {
    let mut tables: Vec<(Category, BinaryTable<'a>)> = Vec::new();
    for category in block.get("categories").map(Node::items).unwrap_or_default() {
        let name = category.get("name").map(Node::text).unwrap_or_default();
        let name = name.strip_prefix(b"_").unwrap_or(name);
        let Some(kind) = Category::from_name(name) else { continue };
        if tables.iter().all(|(other, _)| *other != kind) {
            tables.push((kind, read_table(import, bytes, kind, category, limit)?));
        }
    }
    let mut kept = Block::default();
    for (category, table) in &tables {
        if *category == Category::AtomSite {
            let Some(columns) = entry.columns(import, &table.names, None) else { continue };
            if columns.axes == Axes::Cartesian {
                entry.read_atoms(import, &columns, &mut BinaryRows { table, next: 0 })?;
                continue;
            }
        }
        let cells = (0..table.num_rows).flat_map(|row| table.columns.iter().map(move |column| column.value(row)));
        let values = cells.collect();
        *kept.table_mut(*category) = Table { names: table.names.clone(), values, ..Table::default() };
    }
    entry.end_block(import, &kept)
}

/// Decodes the columns of a table.
fn read_table<'a>(
    import: &Import<'_>,
    bytes: &[u8],
    category: Category,
    node: &Node<'a>,
    limit: usize,
) -> Result<BinaryTable<'a>, SceneError> {
    let num_rows = node.get("rowCount").and_then(Node::integer).and_then(|count| usize::try_from(count).ok());
    let num_rows = num_rows.unwrap_or(0);
    let table_name = node.get("name").map(Node::text).unwrap_or_default();
    let refuse = |name: &[u8], what: &str| SceneError::MalformedAt {
        file: import.file.to_string(),
        byte: (name.as_ptr() as usize).saturating_sub(bytes.as_ptr() as usize) as u64,
        what: format!(
            "column {} {what}; download or save the file again",
            String::from_utf8_lossy(name).escape_debug()
        ),
    };
    if num_rows > limit {
        return Err(refuse(table_name, "is a table that announces more rows than the file has bytes"));
    }
    let mut table = BinaryTable { names: Vec::new(), columns: Vec::new(), num_rows };
    for column in node.get("columns").map(Node::items).unwrap_or_default() {
        let name = column.get("name").map(Node::text).unwrap_or_default();
        let is_wanted = category != Category::AtomSite
            || ATOM_COLUMNS.iter().any(|known| known.as_bytes().eq_ignore_ascii_case(name));
        if is_wanted && !table.names.contains(&name) {
            table.names.push(name);
            table.columns.push(Column::new(column, num_rows).map_err(|what| refuse(name, &what))?);
        }
    }
    Ok(table)
}

/// A table's rows in turn.
struct BinaryRows<'t, 'a> {
    table: &'t BinaryTable<'a>,
    next: usize,
}

impl<'t> Rows<'t> for BinaryRows<'t, '_> {
    fn advance(&mut self, _: &mut Report) -> Result<bool, RowFault> {
        self.next += 1;
        Ok(self.next <= self.table.num_rows)
    }

    fn value(&self, column: usize) -> Value<'t> {
        self.table.columns[column].value(self.next.saturating_sub(1))
    }

    fn line(&self) -> Option<u32> {
        None
    }

    fn number(&self) -> u32 {
        self.next as u32
    }
}
