//! MessagePack: the small part of it that BinaryCIF is written in, read with limits.
//!
//! Format after [MessagePack, throughout]. Each entry of an array or map takes a byte at least, so that a count above the bytes
//! that are left is a lie; values nested deeper than any BinaryCIF file nests them are refused, which bounds the recursion.

/// Depth of nesting. BinaryCIF needs 12: block, category, column, data, encodings and their own encodings.
const MAX_DEPTH: u32 = 32;
/// Entries for which room is made before they are read.
const FIRST_CAPACITY: usize = 64;

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node<'a> {
    /// Nothing, true, false, or a type that has no use here.
    Other,
    /// `true`.
    True,
    /// Any integer.
    Integer(i64),
    /// Any floating-point number.
    Float(f64),
    /// Text, which need not be UTF-8.
    Text(&'a [u8]),
    /// Bytes.
    Bytes(&'a [u8]),
    /// A list.
    Array(Vec<Node<'a>>),
    /// Keys and values.
    Map(Vec<(&'a [u8], Node<'a>)>),
}

impl<'a> Node<'a> {
    /// A value of a map.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        let Self::Map(pairs) = self else { return None };
        pairs.iter().find(|(name, _)| *name == key.as_bytes()).map(|(_, value)| value)
    }

    /// The entries of a list, or none.
    pub(super) fn items(&self) -> &[Self] {
        match self {
            Self::Array(items) => items,
            _ => &[],
        }
    }

    /// The text, or none.
    pub(super) fn text(&self) -> &'a [u8] {
        match self {
            Self::Text(text) => text,
            _ => b"",
        }
    }

    /// The number.
    pub(super) fn float(&self) -> Option<f64> {
        match self {
            Self::Integer(number) => Some(*number as f64),
            Self::Float(number) => Some(*number),
            _ => None,
        }
    }

    /// The integer, also where a writer without integers made it a whole floating-point number.
    pub(super) fn integer(&self) -> Option<i64> {
        match self {
            Self::Integer(number) => Some(*number),
            Self::Float(number) if number.trunc() == *number && number.abs() < 1e15 => Some(*number as i64),
            _ => None,
        }
    }
}

/// What is wrong, and at which byte.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) byte: usize,
    pub(super) what: &'static str,
}

/// Reads the first value of some bytes.
pub(super) fn parse(bytes: &[u8]) -> Result<Node<'_>, Fault> {
    Reader { bytes, at: 0 }.node(0)
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn fault(&self, what: &'static str) -> Fault {
        Fault { byte: self.at, what }
    }

    /// The next `count` bytes.
    fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let end = self.at.checked_add(count).filter(|&end| end <= self.bytes.len());
        let end = end.ok_or_else(|| self.fault("the file ends within a value"))?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    /// The next bytes as a big-endian number.
    fn big_endian<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let mut number = [0; N];
        number.copy_from_slice(self.take(N)?);
        Ok(number)
    }

    /// A length of 1, 2 or 4 bytes.
    fn length(&mut self, width: usize) -> Result<usize, Fault> {
        Ok(self.take(width)?.iter().fold(0, |length, &byte| length << 8 | usize::from(byte)))
    }

    fn node(&mut self, depth: u32) -> Result<Node<'a>, Fault> {
        if depth > MAX_DEPTH {
            return Err(self.fault("values are nested deeper than in any BinaryCIF file"));
        }
        let first = self.take(1)?[0];
        Ok(match first {
            0x00..=0x7f => Node::Integer(i64::from(first)),
            0x80..=0x8f => self.map(usize::from(first & 0xf), depth)?,
            0x90..=0x9f => self.array(usize::from(first & 0xf), depth)?,
            0xa0..=0xbf => Node::Text(self.take(usize::from(first & 0x1f))?),
            0xc3 => Node::True,
            0xc4..=0xc6 => {
                let length = self.length(1 << (first - 0xc4))?;
                Node::Bytes(self.take(length)?)
            }
            0xc7..=0xc9 => {
                let length = self.length(1 << (first - 0xc7))?;
                self.take(length.saturating_add(1))?;
                Node::Other
            }
            0xca => Node::Float(f64::from(f32::from_be_bytes(self.big_endian()?))),
            0xcb => Node::Float(f64::from_be_bytes(self.big_endian()?)),
            0xcc => Node::Integer(i64::from(self.take(1)?[0])),
            0xcd => Node::Integer(i64::from(u16::from_be_bytes(self.big_endian()?))),
            0xce => Node::Integer(i64::from(u32::from_be_bytes(self.big_endian()?))),
            0xcf => Node::Integer(i64::try_from(u64::from_be_bytes(self.big_endian()?)).unwrap_or(i64::MAX)),
            0xd0 => Node::Integer(i64::from(i8::from_be_bytes(self.big_endian()?))),
            0xd1 => Node::Integer(i64::from(i16::from_be_bytes(self.big_endian()?))),
            0xd2 => Node::Integer(i64::from(i32::from_be_bytes(self.big_endian()?))),
            0xd3 => Node::Integer(i64::from_be_bytes(self.big_endian()?)),
            0xd4..=0xd8 => {
                self.take(1 + (1 << (first - 0xd4)))?;
                Node::Other
            }
            0xd9..=0xdb => {
                let length = self.length(1 << (first - 0xd9))?;
                Node::Text(self.take(length)?)
            }
            0xdc | 0xdd => {
                let length = self.length(2 << (first - 0xdc))?;
                self.array(length, depth)?
            }
            0xde | 0xdf => {
                let length = self.length(2 << (first - 0xde))?;
                self.map(length, depth)?
            }
            0xe0..=0xff => Node::Integer(i64::from(first as i8)),
            0xc0..=0xc2 => Node::Other,
        })
    }

    /// Refuses counts that the bytes left cannot hold, each entry taking `size` bytes at least.
    fn check(&self, count: usize, size: usize) -> Result<(), Fault> {
        let is_true = count <= (self.bytes.len() - self.at) / size;
        if is_true { Ok(()) } else { Err(self.fault("a list announces more entries than the file has bytes left")) }
    }

    fn array(&mut self, count: usize, depth: u32) -> Result<Node<'a>, Fault> {
        self.check(count, 1)?;
        let mut items = Vec::with_capacity(count.min(FIRST_CAPACITY));
        for _ in 0..count {
            items.push(self.node(depth + 1)?);
        }
        Ok(Node::Array(items))
    }

    fn map(&mut self, count: usize, depth: u32) -> Result<Node<'a>, Fault> {
        self.check(count, 2)?;
        let mut pairs = Vec::with_capacity(count.min(FIRST_CAPACITY));
        for _ in 0..count {
            let Node::Text(key) = self.node(depth + 1)? else {
                return Err(self.fault("a key is no text"));
            };
            pairs.push((key, self.node(depth + 1)?));
        }
        Ok(Node::Map(pairs))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_is_read() {
        let cases: [(&[u8], Node<'_>); 16] = [
            (&[0x05], Node::Integer(5)),
            (&[0xff], Node::Integer(-1)),
            (&[0xcc, 0xff], Node::Integer(255)),
            (&[0xcd, 1, 0], Node::Integer(256)),
            (&[0xce, 0xff, 0xff, 0xff, 0xff], Node::Integer(4_294_967_295)),
            (&[0xd0, 0x80], Node::Integer(-128)),
            (&[0xd1, 0xff, 0], Node::Integer(-256)),
            (&[0xd2, 0xff, 0xff, 0xff, 0xfe], Node::Integer(-2)),
            (&[0xca, 0x3f, 0xc0, 0, 0], Node::Float(1.5)),
            (&[0xcb, 0x3f, 0xf8, 0, 0, 0, 0, 0, 0], Node::Float(1.5)),
            (&[0xa2, b'h', b'i'], Node::Text(b"hi")),
            (&[0xd9, 1, b'x'], Node::Text(b"x")),
            (&[0xc4, 2, 1, 2], Node::Bytes(&[1, 2])),
            (&[0xdc, 0, 2, 1, 0xc3], Node::Array(vec![Node::Integer(1), Node::True])),
            (&[0x81, 0xa1, b'k', 0xc0], Node::Map(vec![(b"k", Node::Other)])),
            (&[0xd6, 1, 0, 0, 0, 0], Node::Other),
        ];
        for (bytes, node) in cases {
            assert_eq!(parse(bytes), Ok(node), "{bytes:x?}");
            for end in 0..bytes.len() {
                assert!(parse(&bytes[..end]).is_err(), "{bytes:x?} cut at {end}");
            }
        }
    }

    #[test]
    fn lies_and_abysses_are_refused() {
        let fault = |bytes: &[u8]| parse(bytes).expect_err("refused");
        assert_eq!(fault(&[0xdd, 0xff, 0xff, 0xff, 0xff, 0xc0]).byte, 5);
        assert_eq!(
            fault(&[0xdf, 0xff, 0xff, 0xff, 0xff, 0xc0]).what,
            "a list announces more entries than the file has bytes left"
        );
        assert_eq!(fault(&[0x91; 100_000]).what, "values are nested deeper than in any BinaryCIF file");
        assert_eq!(fault(&[0xc6, 0xff, 0xff, 0xff, 0xff]).what, "the file ends within a value");
        assert_eq!(fault(&[0x81, 0x01, 0x01]).what, "a key is no text");
    }
}
