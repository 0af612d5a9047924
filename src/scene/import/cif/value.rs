//! One value of a table, from text or from a binary column.

use super::super::lines::quote;
use super::super::number;
use std::borrow::Cow;

/// A value as the file has it. Text is read as a number only where one is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::scene::import) enum Value<'a> {
    /// `.` or `?`: not applicable, or unknown.
    Missing,
    /// Text, without the quotes around it.
    Text(&'a [u8]),
    /// An integer of a binary column.
    Integer(i32),
    /// A number of a binary column.
    Float(f64),
}

impl<'a> Value<'a> {
    /// The text; empty where there is none.
    pub(super) fn text(self) -> &'a [u8] {
        match self {
            Self::Text(text) => text,
            _ => b"",
        }
    }

    /// The text, also of a number; empty where there is neither.
    pub(super) fn to_text(self) -> Cow<'a, [u8]> {
        match self {
            Self::Missing => Cow::Borrowed(b""),
            Self::Text(text) => Cow::Borrowed(text.trim_ascii()),
            Self::Integer(number) => Cow::Owned(number.to_string().into_bytes()),
            Self::Float(number) => Cow::Owned(number.to_string().into_bytes()),
        }
    }

    /// The number; a standard uncertainty behind it, as in `12.345(6)`, is left out. May be NaN or infinite, as written.
    pub(super) fn float(self) -> Option<f64> {
        match self {
            Self::Missing => None,
            Self::Text(text) => number::float(text).or_else(|| {
                let end = memchr::memchr(b'(', text)?;
                number::float(&text[..end])
            }),
            Self::Integer(number) => Some(f64::from(number)),
            Self::Float(number) => Some(number),
        }
    }

    /// A number that is neither NaN nor infinite.
    pub(super) fn finite(self) -> Option<f64> {
        self.float().filter(|number| number.is_finite())
    }

    /// The integer.
    pub(super) fn integer(self) -> Option<i64> {
        match self {
            Self::Missing => None,
            Self::Text([digit @ b'0'..=b'9']) => Some(i64::from(digit - b'0')),
            Self::Text(text) => number::integer(text),
            Self::Integer(number) => Some(i64::from(number)),
            Self::Float(number) => (number == number.trunc() && number.abs() < 1e15).then_some(number as i64),
        }
    }

    /// The first letter, or 0 where there is none.
    pub(super) fn letter(self) -> u8 {
        match self {
            Self::Text([first, ..]) if first.is_ascii_graphic() => *first,
            Self::Integer(digit @ 0..=9) => b'0' + digit as u8,
            _ => 0,
        }
    }

    /// The value in a message.
    pub(super) fn quoted(self) -> String {
        match self {
            Self::Missing => quote(b"?"),
            value => quote(&value.to_text()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uncertainties_are_left_out() {
        assert_eq!(Value::Text(b"12.345(6)").float(), Some(12.345));
        assert_eq!(Value::Text(b"-0.18526(17)").float(), Some(-0.18526));
        assert_eq!(Value::Text(b"90").float(), Some(90.0));
        assert_eq!(Value::Text(b"(6)").float(), None);
        assert_eq!(Value::Missing.float(), None);
    }

    #[test]
    fn numbers_of_any_column_are_numbers_and_text() {
        assert_eq!(Value::Text(b"-12").integer(), Some(-12));
        assert_eq!(Value::Text(b"7").integer(), Some(7));
        assert_eq!(Value::Float(3.0).integer(), Some(3));
        assert_eq!(Value::Float(3.5).integer(), None);
        assert_eq!(&*Value::Integer(42).to_text(), b"42");
        assert_eq!((Value::Text(b"AB").letter(), Value::Missing.letter(), Value::Integer(2).letter()), (b'A', 0, b'2'));
    }
}
