//! Rows of a table, one after the other: what atoms are read from, whatever the file's form.

use super::value::Value;
use crate::scene::report::Report;

/// A table that is read from its first row to its last.
pub(in crate::scene::import) trait Rows<'a> {
    /// Goes to the next row; false at the end.
    ///
    /// # Errors
    /// The values that are left are no row, and the row at fault cannot be told.
    fn advance(&mut self, report: &mut Report) -> Result<bool, RowFault>;

    /// A value of the row; `column` counts from 0 and is one of the table's.
    fn value(&self, column: usize) -> Value<'a>;

    /// The line of the row, if it has one.
    fn line(&self) -> Option<u32>;

    /// The number of the row, from 1.
    fn number(&self) -> u32;

    /// Whether the row's values may belong to another row, so that a misfit is a fault of the whole table.
    fn is_suspect(&self) -> bool {
        false
    }
}

/// Values that make no row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::scene::import) struct RowFault {
    /// Line where the row begins.
    pub(super) line: u32,
    /// Values that were found.
    pub(super) num_values: usize,
    /// Columns that the table has.
    pub(super) num_columns: usize,
}
