//! The rows of a `loop_` in a text.
//!
//! The format gives rows no ends: a value too few or too many shifts all that follow. Files as programs write them have a
//! row in each line, though, and where all rows so far had, a line with another count of values is a damaged row: it is left
//! out and noted. Where rows do not follow lines, a table whose values do not come out even is refused.

use super::rows::{RowFault, Rows};
use super::tokens::{Place, Tokens};
use super::value::Value;
use crate::scene::report::{NoteKind, Report};

/// Lines over which one row may be spread where all before it were single lines, so that damage is not read over and over.
const MAX_LINES: u32 = 8;

/// A reader of rows; the loop ends before the first word that is no value.
pub(super) struct LoopRows<'a, 't> {
    tokens: &'t mut Tokens<'a>,
    num_columns: usize,
    values: Vec<Value<'a>>,
    line: u32,
    number: u32,
    /// Whether each row so far was one line.
    follows_lines: bool,
    /// Whether the row spans lines though no other did.
    is_wrapped: bool,
}

/// How the values of a row stand in the text.
struct ReadRow {
    /// Where its second line begins, if it has one, and how many values stand before it.
    second_line: Option<(Place, usize)>,
    /// Whether no further value stands behind it on its last line.
    ends_line: bool,
}

impl<'a, 't> LoopRows<'a, 't> {
    /// The rows behind the names of a loop.
    pub(super) fn new(tokens: &'t mut Tokens<'a>, num_columns: usize) -> Self {
        let values = Vec::with_capacity(num_columns);
        Self { tokens, num_columns, values, line: 0, number: 0, follows_lines: true, is_wrapped: false }
    }

    /// Passes over the rest of the rows.
    pub(super) fn skip(self) {
        while self.tokens.value().is_some() {}
    }

    /// Passes over the values that are left on the row's line.
    fn skip_line(&mut self) {
        while self.tokens.skip_space().is_some() && self.tokens.line() == self.line && self.tokens.value().is_some() {}
    }

    /// Reads as many values as there are columns, or as there are.
    fn read_row(&mut self) -> ReadRow {
        self.values.clear();
        self.tokens.skip_space();
        self.line = self.tokens.line();
        let (mut second_line, mut num_lines, mut line) = (None, 1, self.line);
        while self.values.len() < self.num_columns {
            self.tokens.skip_space();
            if self.tokens.line() != line {
                line = self.tokens.line();
                num_lines += 1;
                if num_lines > MAX_LINES && self.follows_lines && self.number > 0 {
                    break;
                }
            }
            let place = self.tokens.place();
            let Some(value) = self.tokens.value() else { break };
            if num_lines > 1 {
                second_line.get_or_insert((place, self.values.len()));
            }
            self.values.push(value);
        }
        let last_line = self.tokens.line();
        let mut ends_line = self.tokens.skip_space().is_none() || self.tokens.line() != last_line;
        if !ends_line {
            // What follows on the line may be the next name.
            let place = self.tokens.place();
            ends_line = self.tokens.value().is_none();
            self.tokens.go_back(place);
        }
        ReadRow { second_line, ends_line }
    }
}

impl<'a> Rows<'a> for LoopRows<'a, '_> {
    fn advance(&mut self, report: &mut Report) -> Result<bool, RowFault> {
        loop {
            let row = self.read_row();
            let (num_values, num_columns) = (self.values.len(), self.num_columns);
            if num_values == 0 {
                return Ok(false);
            }
            let is_first = self.number == 0;
            let is_whole = num_values == num_columns;
            self.is_wrapped = row.second_line.is_some();
            if is_whole && (row.ends_line || !self.follows_lines || is_first) {
                self.number += 1;
                self.follows_lines &= !is_first || row.ends_line && !self.is_wrapped;
                return Ok(true);
            }
            if !self.follows_lines || is_first && self.is_wrapped {
                return Err(RowFault { line: self.line, num_values, num_columns });
            }
            let num_values = match row.second_line {
                Some((place, num_values)) => {
                    self.tokens.go_back(place);
                    num_values
                }
                None => {
                    self.skip_line();
                    num_values
                }
            };
            report.note(NoteKind::BadRow, self.line, || {
                if num_values < num_columns {
                    format!("{num_values} values for {num_columns} columns")
                } else {
                    format!("more values than the {num_columns} columns")
                }
            });
        }
    }

    fn value(&self, column: usize) -> Value<'a> {
        self.values.get(column).copied().unwrap_or(Value::Missing)
    }

    fn line(&self) -> Option<u32> {
        Some(self.line)
    }

    fn number(&self) -> u32 {
        self.number
    }

    fn is_suspect(&self) -> bool {
        !self.follows_lines || self.is_wrapped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First values of the rows, lines of the damaged ones, and whether the table was refused.
    fn read(text: &str, num_columns: usize) -> (Vec<String>, Vec<u32>, Option<RowFault>) {
        let mut tokens = Tokens::new(text.as_bytes());
        let mut rows = LoopRows::new(&mut tokens, num_columns);
        let (mut firsts, mut report, mut fault) = (Vec::new(), Report::default(), None);
        loop {
            match rows.advance(&mut report) {
                Ok(true) => firsts.push(String::from_utf8_lossy(&rows.value(0).to_text()).into_owned()),
                Ok(false) => break,
                Err(error) => {
                    fault = Some(error);
                    break;
                }
            }
        }
        (firsts, report.entries.iter().filter_map(|note| note.line).collect(), fault)
    }

    #[test]
    fn a_damaged_line_does_not_shift_the_others() {
        assert_eq!(read("a 1 2\nb 1\nc 1 2\n", 3), (vec!["a".into(), "c".into()], vec![2], None));
        assert_eq!(read("a 1 2\nb 1 2 3\nc 1 2\n_x", 3), (vec!["a".into(), "c".into()], vec![2], None));
        assert_eq!(read("a 1 2\nb 1 2\nc 1\n#\nloop_", 3), (vec!["a".into(), "b".into()], vec![3], None));
        assert_eq!(read("a 1 2\nb\nc\nd 1 2\n", 3), (vec!["a".into(), "d".into()], vec![2, 3], None));
    }

    #[test]
    fn rows_need_not_follow_lines() {
        assert_eq!(read("a 1 b\n2 c\n3", 2), (vec!["a".into(), "b".into(), "c".into()], vec![], None));
        assert_eq!(read("a\n1\nb\n2", 2), (vec!["a".into(), "b".into()], vec![], None));
        let wrapped = read("a 1 2\nb 1\n2\nc 1 2\n", 3);
        assert_eq!(wrapped, (vec!["a".into(), "b".into(), "c".into()], vec![], None));
        let text_field = read("a 1\nb\n;text\nmore\n;\nc 1\n", 2);
        assert_eq!(text_field, (vec!["a".into(), "b".into(), "c".into()], vec![], None));
    }

    #[test]
    fn values_that_do_not_come_out_even_are_refused() {
        let (firsts, notes, fault) = read("a 1 b\n2 c", 2);
        assert_eq!((firsts.len(), notes.len()), (2, 0));
        assert_eq!(fault, Some(RowFault { line: 2, num_values: 1, num_columns: 2 }));
        assert!(read("a\n", 2).0.is_empty());
    }
}
