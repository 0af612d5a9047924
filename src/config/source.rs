//! Texts of style files, and what an offset in one of them is called: line, column, JSON path.

use std::path::PathBuf;
use std::sync::Arc;

use super::error::Place;
use super::syntax::{Node, Span, Tree};

/// Bytes between two stored character counts, so that a column costs little even in a file of one long line.
const BLOCK: usize = 1024;

/// A style file before it is parsed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The name that messages show.
    pub name: String,
    /// The bytes of the file.
    pub text: Vec<u8>,
    /// Where it lies, if it is a file: bases are found relative to it. Two sources are one file if their paths are
    /// equal, or, without paths, their names.
    pub path: Option<PathBuf>,
    /// The symbolic link that led there, if one did.
    pub link: Option<PathBuf>,
}

impl Source {
    /// A text that is no file, such as an embedded look.
    pub fn new(name: impl Into<String>, text: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), text: text.into(), path: None, link: None }
    }

    /// Whether both are the same file.
    pub fn is_same_file(&self, other: &Self) -> bool {
        match (&self.path, &other.path) {
            (Some(a), Some(b)) => a == b,
            (None, None) => self.name == other.name,
            _ => false,
        }
    }
}

/// Where lines and characters begin in a text. In 32 bits, which hold [`super::syntax::MAX_BYTES`]: a hostile file has as
/// many lines as bytes.
#[derive(Debug)]
pub(super) struct Positions {
    line_starts: Vec<u32>,
    /// Characters that begin before each multiple of [`BLOCK`].
    chars_before: Vec<u32>,
}

impl Positions {
    pub(super) fn new(text: &[u8]) -> Self {
        let breaks = text.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at as u32 + 1);
        let mut chars_before = Vec::with_capacity(text.len() / BLOCK + 1);
        let mut count = 0;
        for block in text.chunks(BLOCK) {
            chars_before.push(count);
            count += count_chars(block);
        }
        chars_before.push(count);
        Self { line_starts: std::iter::once(0).chain(breaks).collect(), chars_before }
    }

    /// Line and column of a byte, both from 1, the column in characters.
    pub(super) fn line_column(&self, text: &[u8], offset: usize) -> (u32, u32) {
        let offset = offset.min(text.len());
        let line = self.line_starts.partition_point(|start| *start as usize <= offset);
        let start = self.line_starts[line - 1] as usize;
        let column = self.chars_until(text, offset) - self.chars_until(text, start) + 1;
        (line as u32, column)
    }

    fn chars_until(&self, text: &[u8], offset: usize) -> u32 {
        let block = offset / BLOCK;
        self.chars_before[block] + count_chars(&text[block * BLOCK..offset])
    }
}

/// Characters that begin in these bytes of UTF-8.
fn count_chars(bytes: &[u8]) -> u32 {
    bytes.iter().filter(|byte| **byte & 0xC0 != 0x80).count() as u32
}

/// A text with its positions and, once parsed, its own tree.
#[derive(Debug)]
pub(super) struct Text {
    pub(super) name: Arc<str>,
    /// Where it lies, if it is a file: pictures are found relative to it.
    pub(super) path: Option<PathBuf>,
    pub(super) text: String,
    pub(super) positions: Positions,
    pub(super) root: Node,
    /// The values that cannot be read, as ranges of bytes in order.
    pub(super) broken: Vec<(u32, u32)>,
    /// Whether all of it could be read, and what it extends. If not, what seems to be missing may be there all the same.
    pub(super) is_whole: bool,
    /// Whether every bracket is closed where it should be. If not, a key may have come into the wrong object.
    pub(super) is_closed: bool,
}

impl Text {
    /// The full place of a key or value.
    pub(super) fn place(&self, span: Span) -> Place {
        let (line, column) = self.line_column(span);
        Place {
            file: self.name.clone(),
            line,
            column,
            start: span.start as usize,
            end: span.end as usize,
            path: path_at(&self.root, span.start),
        }
    }

    /// Whether a value cannot be read, or a part of it.
    pub(super) fn holds_broken(&self, span: Span) -> bool {
        let from = self.broken.partition_point(|(start, _)| *start < span.start);
        self.broken.get(from).is_some_and(|(start, _)| *start == span.start || *start < span.end)
    }

    /// Line and column alone.
    pub(super) fn line_column(&self, span: Span) -> (u32, u32) {
        self.positions.line_column(self.text.as_bytes(), span.start as usize)
    }
}

/// All texts of one style: the file itself and its bases.
#[derive(Debug, Default)]
pub(super) struct Texts(pub(super) Vec<Text>);

impl Texts {
    /// The full place of a key or value.
    pub(super) fn place(&self, span: Span) -> Place {
        self.0[span.file as usize].place(span)
    }

    /// Whether a value cannot be read, or a part of it, so that what is wrong with it may only follow from that.
    pub(super) fn holds_broken(&self, span: Span) -> bool {
        self.0[span.file as usize].holds_broken(span)
    }

    /// Whether the style and all its bases could be read whole.
    pub(super) fn are_whole(&self) -> bool {
        self.0.iter().all(|text| text.is_whole)
    }

    /// Line and column alone.
    pub(super) fn line_column(&self, span: Span) -> (u32, u32) {
        self.0[span.file as usize].line_column(span)
    }
}

/// The JSON path of the key or value that begins at an offset.
fn path_at(root: &Node, offset: u32) -> String {
    let mut path = String::new();
    let mut node = root;
    loop {
        match &node.value {
            Tree::Object(members) => {
                let after = members.partition_point(|member| member.key_span.start <= offset);
                let Some(member) = after.checked_sub(1).map(|i| &members[i]) else {
                    return path;
                };
                if offset >= member.value.span.end {
                    return path;
                }
                push_key(&mut path, &member.key);
                node = &member.value;
            }
            Tree::List(items) => {
                let after = items.partition_point(|item| item.span.start <= offset);
                let Some(i) = after.checked_sub(1) else {
                    return path;
                };
                if offset >= items[i].span.end {
                    return path;
                }
                path.push_str(&format!("[{i}]"));
                node = &items[i];
            }
            Tree::Null | Tree::Bool(_) | Tree::Number(_) | Tree::Text(_) | Tree::Broken => return path,
        }
        if offset <= node.span.start {
            return path;
        }
    }
}

/// Plain keys follow a dot, others are quoted in brackets.
fn push_key(path: &mut String, key: &str) {
    let plain = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '$' | '-' | '*'));
    if !plain {
        path.push_str(&format!("[{}]", super::hint::quote(key)));
        return;
    }
    if !path.is_empty() {
        path.push('.');
    }
    path.push_str(&super::hint::shorten(key));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "ab\n\u{e9}\u{1F600}x\r\ny";
        let positions = Positions::new(text.as_bytes());
        let at = |needle: &str| positions.line_column(text.as_bytes(), text.find(needle).expect("in the text"));
        assert_eq!(at("b"), (1, 2));
        assert_eq!(at("x"), (2, 3));
        assert_eq!(at("y"), (3, 1));
        assert_eq!(positions.line_column(text.as_bytes(), 10_000), (3, 2));
    }

    #[test]
    fn columns_hold_over_blocks() {
        let text = "\u{e9}".repeat(5 * BLOCK) + "x";
        let positions = Positions::new(text.as_bytes());
        assert_eq!(positions.line_column(text.as_bytes(), text.len() - 1), (1, 5 * BLOCK as u32 + 1));
    }

    #[test]
    fn an_empty_text_has_one_position() {
        assert_eq!(Positions::new(b"").line_column(b"", 0), (1, 1));
    }
}
