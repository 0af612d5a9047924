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
use super::lines::quote;
use crate::scene::error::SceneError;
use crate::scene::molecule::Molecule;
use crate::scene::report::Report;
use column::Column;
use msgpack::Node;

/// Rows that a table may have in any file; beyond, each takes two bytes of the file at least (atoms take some eight).
const ALWAYS_ALLOWED_ROWS: usize = 4096;
/// Values of all columns together that a file may have, and how many more for each of its bytes (real files: about three).
const ALWAYS_ALLOWED_VALUES: usize = 1 << 20;
const VALUES_PER_BYTE: usize = 8;
/// Bytes of a [`Value`] over those of a decoded integer.
const KEPT_VALUE: usize = 6;
/// Columns of a table; real ones have some 70.
const MAX_COLUMNS: usize = 500;

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
    let blocks = root.get("dataBlocks").map(Node::items).unwrap_or_default();
    let mut entry = Entry::new(import);
    let mut file =
        BinaryFile { bytes, values_left: ALWAYS_ALLOWED_VALUES.saturating_add(bytes.len() * VALUES_PER_BYTE) };
    for block in blocks {
        file.read_block(import, &mut entry, block)?;
    }
    entry.finish(import, "there is no row in a table _atom_site: download the whole entry")
}

/// The bytes of a file, and how much more may be made of them: small lies must not take large memory.
struct BinaryFile<'a> {
    bytes: &'a [u8],
    values_left: usize,
}

/// A table of the file.
struct BinaryTable<'a> {
    names: Vec<&'a [u8]>,
    columns: Vec<Column<'a>>,
    num_rows: usize,
}

impl<'a> BinaryFile<'a> {
    /// Reads the tables of a block that matter.
    fn read_block(&mut self, import: &mut Import<'_>, entry: &mut Entry, block: &Node<'a>) -> Result<(), SceneError> {
        let mut tables: Vec<(Category, BinaryTable<'a>)> = Vec::new();
        for category in block.get("categories").map(Node::items).unwrap_or_default() {
            let name = category.get("name").map(Node::text).unwrap_or_default();
            let name = name.strip_prefix(b"_").unwrap_or(name);
            let Some(kind) = Category::from_name(name) else { continue };
            if tables.iter().all(|(other, _)| *other != kind) {
                tables.push((kind, self.read_table(import, kind, category)?));
            }
        }
        let mut kept = Block::default();
        for (category, table) in &tables {
            if *category == Category::AtomSite && !table.names.is_empty() {
                let Some(columns) = entry.columns(import, &table.names, None) else { continue };
                if columns.axes == Axes::Cartesian {
                    entry.read_atoms(import, &columns, &mut BinaryRows { table, next: 0 })?;
                    continue;
                }
            }
            let size = table.num_rows.saturating_mul(table.columns.len()).saturating_mul(KEPT_VALUE);
            self.charge(import, table.names.first().copied().unwrap_or_default(), size)?;
            let cells = (0..table.num_rows).flat_map(|row| table.columns.iter().map(move |column| column.value(row)));
            let values = cells.collect();
            *kept.table_mut(*category) = Table { names: table.names.clone(), values, ..Table::default() };
        }
        entry.end_block(import, &kept)
    }

    /// Decodes the columns of a table.
    fn read_table(
        &mut self,
        import: &Import<'_>,
        category: Category,
        node: &Node<'a>,
    ) -> Result<BinaryTable<'a>, SceneError> {
        let num_rows = node.get("rowCount").and_then(Node::integer).and_then(|count| usize::try_from(count).ok());
        let num_rows = num_rows.unwrap_or(0);
        let limit = ALWAYS_ALLOWED_ROWS.max(self.bytes.len() / 2);
        if num_rows > limit {
            let name = node.get("name").map(Node::text).unwrap_or_default();
            return Err(self.refuse(import, name, "announces more rows than the file has bytes for"));
        }
        let mut table = BinaryTable { names: Vec::new(), columns: Vec::new(), num_rows };
        for column in node.get("columns").map(Node::items).unwrap_or_default() {
            let name = column.get("name").map(Node::text).unwrap_or_default();
            let is_wanted = category != Category::AtomSite
                || ATOM_COLUMNS.iter().any(|known| known.as_bytes().eq_ignore_ascii_case(name));
            if is_wanted && table.names.len() < MAX_COLUMNS && !table.names.contains(&name) {
                let column = Column::new(column, self.bytes.len().max(ALWAYS_ALLOWED_ROWS));
                let column = column.map_err(|what| self.refuse(import, name, &what))?;
                self.charge(import, name, column.len())?;
                table.names.push(name);
                table.columns.push(column);
            }
        }
        Ok(table)
    }

    /// Takes values off what is left.
    fn charge(&mut self, import: &Import<'_>, name: &[u8], num_values: usize) -> Result<(), SceneError> {
        let left = self.values_left.checked_sub(num_values);
        self.values_left =
            left.ok_or_else(|| self.refuse(import, name, "has more values than the file has bytes for"))?;
        Ok(())
    }

    /// The error of a table or column, at the byte of its name.
    fn refuse(&self, import: &Import<'_>, name: &[u8], what: &str) -> SceneError {
        let byte = (name.as_ptr() as usize).checked_sub(self.bytes.as_ptr() as usize);
        SceneError::MalformedAt {
            file: import.file.to_string(),
            byte: byte.filter(|&byte| byte < self.bytes.len()).unwrap_or(0) as u64,
            what: format!("{} {what}; download or save the file again", quote(name)),
        }
    }
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
