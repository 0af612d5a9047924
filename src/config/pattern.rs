//! What a selector asks of the value of an attribute: a text with wildcards, or a range of numbers.

use super::glob::{Glob, glob_matches, is_plain, normal};
use super::range::{DOTS, NoRange, Range};
use super::selector::{Attribute, AttributeValues};

/// What a value must be.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Pattern {
    /// A text with `*` and `?`.
    Text(Glob),
    /// A number within a range; the text as it is written.
    Range(Range, String),
}

impl Pattern {
    /// Reads what is written after `=`.
    pub(super) fn read(attribute: Attribute, text: &str) -> Result<Self, BadPattern> {
        let values = attribute.values();
        if values == AttributeValues::Texts || (values == AttributeValues::Numbers && !text.contains(DOTS)) {
            return Ok(Self::Text(Glob::new(text)));
        }
        match Range::parse(text) {
            Ok(range) => Ok(Self::Range(range, text.to_owned())),
            Err(NoRange::Reversed) => Err(BadPattern::Reversed),
            Err(NoRange::Shape) => Err(BadPattern::NoRange),
        }
    }

    /// As it is written.
    pub(super) fn text(&self) -> &str {
        match self {
            Self::Text(glob) => glob.pattern(),
            Self::Range(_, text) => text,
        }
    }

    /// Whether a value is such.
    pub(super) fn matches(&self, value: &str, ignore_case: bool) -> bool {
        match self {
            Self::Text(glob) => glob.matches(value, ignore_case),
            Self::Range(range, _) => range.matches(value),
        }
    }

    /// The same in its one shape.
    pub(super) fn shape(&self, ignore_case: bool) -> Shape {
        match self {
            Self::Text(glob) => {
                let text = glob.pattern();
                let text = if ignore_case { normal(&text.to_ascii_lowercase()) } else { normal(text) };
                let kind = if is_plain(&text) { ShapeKind::Plain } else { ShapeKind::Glob };
                Shape { text, kind }
            }
            Self::Range(range, _) => Shape { text: range.to_string(), kind: ShapeKind::Range(*range) },
        }
    }
}

/// Why a text is no pattern for an attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BadPattern {
    /// It had to be a range.
    NoRange,
    /// Its first number is the larger one.
    Reversed,
}

/// A pattern in the one shape that all have that ask the same. No two kinds have the same text.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shape {
    pub(super) text: String,
    pub(super) kind: ShapeKind,
}

/// Which values a shape matches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ShapeKind {
    /// Its own text.
    Plain,
    /// Any that its wildcards allow.
    Glob,
    /// Numbers.
    Range(Range),
}

impl Shape {
    /// Whether a value, which has the case that counts, is such.
    pub(super) fn matches(&self, value: &str) -> bool {
        match self.kind {
            ShapeKind::Range(range) => range.matches(value),
            _ => glob_matches(&self.text, value),
        }
    }
}
