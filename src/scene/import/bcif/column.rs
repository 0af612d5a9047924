//! A column of a binary table, decoded.

use super::super::cif::Value;
use super::encoding::{Numbers, decode, decode_integers, kind};
use super::msgpack::Node;

/// The values of a column, and which of them are missing.
#[derive(Debug, Default)]
pub(super) struct Column<'a> {
    data: Data<'a>,
    /// 0 where a value is there; empty where all are.
    mask: Vec<i32>,
}

#[derive(Debug, Default)]
enum Data<'a> {
    /// A column that is not needed or has no values.
    #[default]
    None,
    Integers(Vec<i32>),
    Floats(Vec<f64>),
    Strings {
        /// All different strings, one behind the other.
        text: &'a [u8],
        /// Where each begins, and the end.
        offsets: Vec<i32>,
        /// Which string each row has; negative for none.
        indices: Vec<i32>,
    },
}

impl<'a> Column<'a> {
    /// Decodes a column; no list in it grows beyond `limit`.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn new(column: &Node<'a>, limit: usize) -> Result<Self, String> {
        let data = decode_column(column.get("data").ok_or("has no data")?, limit)?;
        let mask = match column.get("mask") {
            Some(mask @ Node::Map(_)) => match decode_column(mask, limit)? {
                Data::Integers(mask) => mask,
                _ => return Err("has a mask that is no list of integers".to_string()),
            },
            _ => Vec::new(),
        };
        Ok(Self { data, mask })
    }

    /// How many values it holds, mask and strings included.
    pub(super) fn len(&self) -> usize {
        let data = match &self.data {
            Data::None => 0,
            Data::Integers(integers) => integers.len(),
            // Twice as large as integers.
            Data::Floats(floats) => 2 * floats.len(),
            Data::Strings { offsets, indices, .. } => offsets.len() + indices.len(),
        };
        data + self.mask.len()
    }

    /// The value of a row, from 0.
    pub(super) fn value(&self, row: usize) -> Value<'_> {
        if self.mask.get(row).is_some_and(|&mask| mask != 0) {
            return Value::Missing;
        }
        match &self.data {
            Data::None => None,
            Data::Integers(integers) => integers.get(row).map(|&integer| Value::Integer(integer)),
            Data::Floats(floats) => floats.get(row).map(|&float| Value::Float(float)),
            Data::Strings { text, offsets, indices } => indices.get(row).and_then(|&index| {
                let index = usize::try_from(index).ok()?;
                let offset = |index: usize| offsets.get(index).and_then(|&offset| usize::try_from(offset).ok());
                text.get(offset(index)?..offset(index + 1)?).map(Value::Text)
            }),
        }
        .unwrap_or(Value::Missing)
    }
}

/// Decodes a pair of bytes and their encodings.
fn decode_column<'a>(node: &Node<'a>, limit: usize) -> Result<Data<'a>, String> {
    let encodings = node.get("encoding").map(Node::items).unwrap_or_default();
    let Some(Node::Bytes(bytes)) = node.get("data") else {
        return Err("has no bytes".to_string());
    };
    let Some(first) = encodings.first() else { return Err("has no encoding".to_string()) };
    if first.get("kind").map(Node::text) != Some(b"StringArray") {
        return Ok(match decode(encodings, bytes, limit)? {
            Numbers::Integers(integers) => Data::Integers(integers),
            Numbers::Floats(floats) => Data::Floats(floats),
        });
    }
    if encodings.len() > 1 {
        return Err(format!("has {} of strings", kind(&encodings[1])));
    }
    let list = |key| first.get(key).map(Node::items).unwrap_or_default();
    let Some(Node::Bytes(offsets)) = first.get("offsets") else {
        return Err("has strings without offsets".to_string());
    };
    let indices = decode_integers(list("dataEncoding"), bytes, limit)?;
    let offsets = decode_integers(list("offsetEncoding"), offsets, limit.saturating_add(1))?;
    let text = first.get("stringData").map(Node::text).unwrap_or_default();
    Ok(Data::Strings { text, offsets, indices })
}
