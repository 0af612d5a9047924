//! Tables of a data block that are kept: small ones, and those that need others first.

use super::rows::{RowFault, Rows};
use super::value::Value;
use crate::scene::report::Report;

/// Names with a value each that a table keeps; real ones have some 70.
const MAX_ITEMS: usize = 500;

/// What a table is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::scene::import) enum Category {
    /// Atoms.
    AtomSite,
    /// The unit cell.
    Cell,
    /// Symmetry operations of the crystal.
    SymmetryOperation,
    /// Bonds between residues.
    StructConn,
    /// Bonds within residues.
    ChemCompBond,
    /// Which operations make which assembly.
    AssemblyGenerator,
    /// Operations of assemblies.
    Operator,
}

impl Category {
    /// How many there are.
    pub(super) const COUNT: usize = 7;

    /// By its name before the point, in any case, without `_` before it.
    pub(in crate::scene::import) fn from_name(name: &[u8]) -> Option<Self> {
        const NAMES: [(&[u8], Category); 8] = [
            (b"atom_site", Category::AtomSite),
            (b"cell", Category::Cell),
            (b"symmetry_equiv", Category::SymmetryOperation),
            (b"space_group_symop", Category::SymmetryOperation),
            (b"struct_conn", Category::StructConn),
            (b"chem_comp_bond", Category::ChemCompBond),
            (b"pdbx_struct_assembly_gen", Category::AssemblyGenerator),
            (b"pdbx_struct_oper_list", Category::Operator),
        ];
        NAMES.iter().find(|(known, _)| name.eq_ignore_ascii_case(known)).map(|&(_, category)| category)
    }

    /// The category and the column of a name such as `_cell.length_a` or, in files of small molecules, `_cell_length_a`.
    pub(super) fn split(name: &[u8]) -> Option<(Self, &[u8])> {
        const PREFIXES: [(&[u8], Category); 4] = [
            (b"_atom_site_", Category::AtomSite),
            (b"_cell_", Category::Cell),
            (b"_symmetry_equiv_pos_", Category::SymmetryOperation),
            (b"_space_group_symop_", Category::SymmetryOperation),
        ];
        if let Some(point) = memchr::memchr(b'.', name) {
            return Some((Self::from_name(name.get(1..point)?)?, &name[point + 1..]));
        }
        let (category, column) = PREFIXES.iter().find_map(|&(prefix, category)| {
            let (start, column) = name.split_at_checked(prefix.len())?;
            start.eq_ignore_ascii_case(prefix).then_some((category, column))
        })?;
        // Displacements have a table of their own.
        let is_aniso = column.get(..6).is_some_and(|start| start.eq_ignore_ascii_case(b"aniso_"));
        (!is_aniso).then_some((category, column))
    }
}

/// Rows of values under names.
#[derive(Debug, Clone, Default)]
pub(in crate::scene::import) struct Table<'a> {
    /// The columns' names, without that of the category.
    pub(in crate::scene::import) names: Vec<&'a [u8]>,
    /// All values, row by row.
    pub(in crate::scene::import) values: Vec<Value<'a>>,
    /// Line where the table begins, if it has one.
    pub(in crate::scene::import) line: Option<u32>,
    /// Line of each row; empty where there are none.
    pub(in crate::scene::import) lines: Vec<u32>,
}

impl<'a> Table<'a> {
    /// The index of a column, by its name in any case.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        find(&self.names, name)
    }

    /// All rows.
    pub(super) fn rows(&self) -> impl Iterator<Item = &[Value<'a>]> {
        self.values.chunks_exact(self.names.len().max(1))
    }

    /// A value of the first row.
    pub(super) fn first(&self, name: &str) -> Value<'a> {
        self.column(name).and_then(|column| self.values.get(column)).copied().unwrap_or(Value::Missing)
    }

    /// Adds a column to a table of one row, as names with a value each make it.
    pub(super) fn add_item(&mut self, name: &'a [u8], value: Value<'a>, line: u32) {
        if self.lines.len() > 1
            || self.names.len() >= MAX_ITEMS
            || self.names.iter().any(|known| known.eq_ignore_ascii_case(name))
        {
            return;
        }
        self.line.get_or_insert(line);
        self.names.push(name);
        self.values.push(value);
        self.lines = vec![line];
    }
}

/// The index of a name among those of columns.
pub(super) fn find(names: &[&[u8]], name: &str) -> Option<usize> {
    names.iter().position(|known| known.eq_ignore_ascii_case(name.as_bytes()))
}

/// The value of a column that there may be.
pub(super) fn at<'a>(row: &[Value<'a>], column: Option<usize>) -> Value<'a> {
    column.and_then(|column| row.get(column)).copied().unwrap_or(Value::Missing)
}

/// A table's rows in turn.
pub(super) struct TableRows<'a, 't> {
    table: &'t Table<'a>,
    /// Rows begun.
    number: usize,
}

impl<'a, 't> TableRows<'a, 't> {
    pub(super) fn new(table: &'t Table<'a>) -> Self {
        Self { table, number: 0 }
    }
}

impl<'a> Rows<'a> for TableRows<'a, '_> {
    fn advance(&mut self, _: &mut Report) -> Result<bool, RowFault> {
        self.number += 1;
        Ok(self.number * self.table.names.len() <= self.table.values.len() && !self.table.names.is_empty())
    }

    fn value(&self, column: usize) -> Value<'a> {
        let index = self.number.saturating_sub(1) * self.table.names.len() + column;
        self.table.values.get(index).copied().unwrap_or(Value::Missing)
    }

    fn line(&self) -> Option<u32> {
        self.table.lines.get(self.number.saturating_sub(1)).copied()
    }

    fn number(&self) -> u32 {
        self.number as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_styles_of_names_are_known() {
        let split =
            |name: &'static str| Category::split(name.as_bytes()).map(|(category, column)| (category, str(column)));
        assert_eq!(split("_atom_site.Cartn_x"), Some((Category::AtomSite, "Cartn_x")));
        assert_eq!(split("_atom_site_fract_x"), Some((Category::AtomSite, "fract_x")));
        assert_eq!(split("_CELL_length_a"), Some((Category::Cell, "length_a")));
        assert_eq!(split("_symmetry_equiv_pos_as_xyz"), Some((Category::SymmetryOperation, "as_xyz")));
        assert_eq!(split("_atom_site_aniso_label"), None);
        assert_eq!(split("_atom_site_anisotrop.id"), None);
        assert_eq!(split("_atom_sites_solution_primary"), None);
        assert_eq!(split("_."), None);
    }

    fn str(bytes: &[u8]) -> &str {
        std::str::from_utf8(bytes).expect("text")
    }
}
