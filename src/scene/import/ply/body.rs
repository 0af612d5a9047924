//! The body of a PLY file: numbers one after the other, as words or bytes.

use super::header::{Element, Encoding, Property, Scalar};
use crate::scene::import::number::float;
use crate::scene::import::vertex::is_decimal_comma;

/// The file ends inside a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Cut;

/// A place in the body.
pub(super) struct Body<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
    pub(super) encoding: Encoding,
    /// Where the first word is that is a number but for its comma.
    pub(super) comma: Option<usize>,
}

impl Body<'_> {
    /// The next number; NaN for a word that is none.
    #[inline]
    pub(super) fn scalar(&mut self, kind: Scalar) -> Result<f64, Cut> {
        if self.encoding == Encoding::Ascii {
            return self.word();
        }
        macro_rules! read {
            ($number:ty) => {{
                let bytes = *self.bytes.get(self.at..).and_then(<[u8]>::first_chunk).ok_or(Cut)?;
                self.at += size_of::<$number>();
                if self.encoding == Encoding::LittleEndian {
                    <$number>::from_le_bytes(bytes).into()
                } else {
                    <$number>::from_be_bytes(bytes).into()
                }
            }};
        }
        Ok(match kind {
            Scalar::I8 => read!(i8),
            Scalar::U8 => read!(u8),
            Scalar::I16 => read!(i16),
            Scalar::U16 => read!(u16),
            Scalar::I32 => read!(i32),
            Scalar::U32 => read!(u32),
            Scalar::F32 => read!(f32),
            Scalar::F64 => read!(f64),
        })
    }

    fn word(&mut self) -> Result<f64, Cut> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace()).ok_or(Cut)?;
        let rest = &rest[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += start + end;
        Ok(float(&rest[..end]).unwrap_or_else(|| {
            if self.comma.is_none() && is_decimal_comma(&rest[..end]) {
                self.comma = Some(self.at);
            }
            f64::NAN
        }))
    }

    /// Reads a list, or a single number as a list of one.
    pub(super) fn list(&mut self, property: &Property, into: &mut Vec<f64>) -> Result<(), Cut> {
        into.clear();
        let count = match property.counter {
            Some(counter) => self.scalar(counter)?,
            None => 1.0,
        };
        let size = if self.encoding == Encoding::Ascii { 1 } else { property.scalar.size() };
        // Also of counts that are NaN or negative nothing follows that could be trusted.
        if !(count >= 0.0 && count * size as f64 <= self.left() as f64) {
            return Err(Cut);
        }
        for _ in 0..count as usize {
            into.push(self.scalar(property.scalar)?);
        }
        Ok(())
    }

    /// Passes all rows of an element over.
    pub(super) fn skip(&mut self, element: &Element) -> Result<(), Cut> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let is_fixed = element.properties.iter().all(|property| property.counter.is_none());
        if is_fixed && self.encoding != Encoding::Ascii {
            let length = element.count.saturating_mul(element.least_bytes(self.encoding) as u64);
            let is_cut = length > self.left() as u64;
            self.at = if is_cut { self.bytes.len() } else { self.at + length as usize };
            return if is_cut { Err(Cut) } else { Ok(()) };
        }
        let mut list = Vec::new();
        for _ in 0..element.count {
            for property in &element.properties {
                self.list(property, &mut list)?;
            }
        }
        Ok(())
    }

    /// Bytes that are left.
    pub(super) fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// The line of a place, from 1.
    pub(super) fn line(&self, at: usize) -> u32 {
        let before = &self.bytes[..at.min(self.bytes.len())];
        // CR-only files count by those; CRLF files by their LF.
        let ends = [b'\n', b'\r'].map(|end| memchr::memchr_iter(end, before).count());
        (if ends[0] > 0 { ends[0] } else { ends[1] }) as u32 + 1
    }
}
