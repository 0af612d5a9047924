//! Where the lexer and the parser note what is not JSON in one text.

use std::ops::Range;
use std::sync::Arc;

use super::error::{Mistakes, Place, Problem};
use super::source::Positions;

/// The mistakes of one text, by ranges of its bytes.
pub(super) struct Slips<'a> {
    pub(super) name: &'a Arc<str>,
    pub(super) text: &'a str,
    pub(super) positions: &'a Positions,
    pub(super) mistakes: &'a mut Mistakes,
    /// Within what is skipped, nothing is noted.
    pub(super) is_muted: bool,
    /// Whether anything was noted.
    pub(super) is_told: bool,
    /// Whether something may have been lost: what seems to be missing from the style may stand in the file all the same.
    pub(super) is_whole: bool,
}

impl Slips<'_> {
    /// Notes a mistake. The words are asked for only if they will be read, so that a flood of mistakes costs little.
    pub(super) fn tell<S: Into<String>>(&mut self, range: Range<usize>, words: impl FnOnce() -> S) {
        if self.is_muted {
            return;
        }
        self.is_told = true;
        if self.mistakes.is_full() {
            self.mistakes.unlisted += 1;
            return;
        }
        let (line, column) = self.line_column(range.start);
        let place =
            Place { file: self.name.clone(), line, column, start: range.start, end: range.end, path: String::new() };
        self.mistakes.push(|| place, Problem::Syntax(words().into()));
    }

    /// Line and column of a byte, as messages write them.
    pub(super) fn at(&self, offset: usize) -> String {
        let (line, column) = self.line_column(offset);
        format!("{line}:{column}")
    }

    fn line_column(&self, offset: usize) -> (u32, u32) {
        self.positions.line_column(self.text.as_bytes(), offset)
    }
}
