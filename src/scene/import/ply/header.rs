//! The header of a PLY file: which elements follow, how many, and what each is made of.

use crate::scene::import::lines::quote;
use crate::scene::import::{Import, SceneError};
use crate::scene::report::NoteKind;

/// How the body is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// A kind of number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Size in bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// A number or list of numbers that each row of an element has.
#[derive(Debug, PartialEq)]
pub(super) struct Property {
    pub(super) name: Vec<u8>,
    pub(super) scalar: Scalar,
    /// What counts the numbers of a list; none for a single number.
    pub(super) counter: Option<Scalar>,
}

/// Rows of one kind, such as vertices.
#[derive(Debug, PartialEq)]
pub(super) struct Element {
    pub(super) name: Vec<u8>,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// The line that announces it.
    pub(super) line: u32,
}

impl Element {
    /// Fewest bytes of a row: empty lists, numbers of one digit with a space after each.
    pub(super) fn least_bytes(&self, encoding: Encoding) -> usize {
        let of_property = |property: &Property| match encoding {
            Encoding::Ascii => 2,
            _ => property.counter.unwrap_or(property.scalar).size(),
        };
        self.properties.iter().map(of_property).sum()
    }
}

/// All that stands before the body.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    /// The line that says the encoding.
    pub(super) format_line: u32,
    pub(super) elements: Vec<Element>,
    /// Where the body begins.
    pub(super) body: usize,
}

/// Reads a header. Comments and words that mean nothing are passed over, the latter with a note.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Header, SceneError> {
    let (mut encoding, mut elements) = (None, Vec::<Element>::new());
    let (mut at, mut number) = (0, 0_u32);
    // A body may begin with any byte, so lines end as the first one does.
    let first_end = bytes.iter().position(|&byte| matches!(byte, b'\r' | b'\n')).unwrap_or(bytes.len());
    let end_byte =
        if bytes[first_end..].starts_with(b"\r") && !bytes[first_end..].starts_with(b"\r\n") { b'\r' } else { b'\n' };
    loop {
        let rest = &bytes[at..];
        number += 1;
        let Some(length) = memchr::memchr(end_byte, rest) else {
            let what = "the header has no end_header; was the file saved or downloaded completely?".to_string();
            return Err(import.malformed(number, what));
        };
        let line = rest[..length].trim_ascii();
        at += length + 1;
        let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).take(5).collect();
        match words.as_slice() {
            [b"end_header", ..] => break,
            [] | [b"ply" | b"comment" | b"obj_info", ..] => {}
            [b"format", word, ..] => {
                let found = match *word {
                    b"ascii" => Encoding::Ascii,
                    b"binary_little_endian" => Encoding::LittleEndian,
                    b"binary_big_endian" => Encoding::BigEndian,
                    _ => {
                        let what = format!("{} is no format of PLY; save the file as ascii", quote(word));
                        return Err(import.malformed(number, what));
                    }
                };
                encoding = Some((found, number));
            }
            [b"element", name, count, ..] => {
                let parsed = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
                let Some(count) = parsed else {
                    let what =
                        format!("{} is no number of {} elements; export the model again", quote(count), quote(name));
                    return Err(import.malformed(number, what));
                };
                elements.push(Element { name: name.to_vec(), count, properties: Vec::new(), line: number });
            }
            [b"property", rest @ ..] => {
                let Some(element) = elements.last_mut() else {
                    let what = "a property before the first element; export the model again".to_string();
                    return Err(import.malformed(number, what));
                };
                let (counter, scalar, name) = match *rest {
                    [b"list", counter, scalar, name] => (Some(counter), scalar, name),
                    [scalar, name, ..] if scalar != b"list" => (None, scalar, name),
                    _ => {
                        let what = format!("{} is no property; export the model again", quote(line));
                        return Err(import.malformed(number, what));
                    }
                };
                let kind = |word: &[u8]| {
                    Scalar::parse(word).ok_or_else(|| {
                        let what =
                            format!("{} is no kind of number that PLY has; save as float, double or int", quote(word));
                        import.malformed(number, what)
                    })
                };
                let counter = counter.map(kind).transpose()?;
                element.properties.push(Property { name: name.to_vec(), scalar: kind(scalar)?, counter });
            }
            [word, ..] => import.report.note(NoteKind::UnknownWord, number, || quote(word)),
        }
    }
    let Some((encoding, format_line)) = encoding else {
        let what = "the header has no format line; export the model again".to_string();
        return Err(import.malformed(number, what));
    };
    Ok(Header { encoding, format_line, elements, body: at })
}
