//! Statements of OBJ and MTL files: bytes of any encoding to lines of words.

use std::borrow::Cow;

use crate::scene::import::lines::Lines;
use crate::scene::import::number::float;

/// UTF-16 as UTF-8; anything else as it is. Names in Latin-1 are dealt with where they are read.
pub(super) fn decoded(bytes: &[u8]) -> Cow<'_, [u8]> {
    let Some(is_little) = utf16(bytes) else {
        return Cow::Borrowed(bytes);
    };
    let (units, _) = bytes.as_chunks::<2>();
    let units = units.iter().map(|&unit| if is_little { u16::from_le_bytes(unit) } else { u16::from_be_bytes(unit) });
    let mut text = String::with_capacity(bytes.len() / 2);
    text.extend(char::decode_utf16(units).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER)));
    Cow::Owned(text.into_bytes())
}

/// Whether a text is in UTF-16, and if so whether its low bytes come first.
fn utf16(bytes: &[u8]) -> Option<bool> {
    match bytes {
        [0xff, 0xfe, ..] => Some(true),
        [0xfe, 0xff, ..] => Some(false),
        _ => None,
    }
}

/// Whether the first lines are those of an OBJ file.
pub(in crate::scene::import) fn is_obj(head: &[u8]) -> bool {
    let head = decoded(head);
    let mut statements = Statements::new(&head);
    while let Some((_, line)) = statements.next() {
        let mut words = words(line);
        match words.next() {
            None | Some(b"o" | b"g" | b"s") => {}
            Some(b"v" | b"vn") => return words.clone().count() >= 3 && words.take(3).all(|word| float(word).is_some()),
            Some(b"mtllib") => return words.next().is_some_and(|name| name.to_ascii_lowercase().ends_with(b".mtl")),
            Some(_) => return false,
        }
    }
    false
}

/// A name as the file has it: UTF-8, or else Latin-1.
pub(super) fn name(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// Words of a statement, up to a comment.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    words.take_while(|word| !word.starts_with(b"#"))
}

/// First word of a statement, and what follows it.
pub(super) fn keyword(line: &[u8]) -> (&[u8], &[u8]) {
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    let (word, rest) = line.split_at(end);
    (word, rest.trim_ascii())
}

/// Statements with the numbers of their lines; a backslash at the end continues a line on the next.
pub(super) struct Statements<'a> {
    lines: Lines<'a>,
    joined: Vec<u8>,
}

impl<'a> Statements<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { lines: Lines::new(text), joined: Vec::new() }
    }

    /// The next statement, without spaces around it.
    pub(super) fn next(&mut self) -> Option<(u32, &[u8])> {
        let (number, line) = self.lines.next()?;
        let line = line.trim_ascii();
        let Some(start) = line.strip_suffix(b"\\").filter(|_| !line.starts_with(b"#")) else {
            return Some((number, line));
        };
        self.joined.clear();
        self.joined.extend_from_slice(start);
        for (_, line) in self.lines.by_ref() {
            let line = line.trim_ascii();
            self.joined.push(b' ');
            let Some(start) = line.strip_suffix(b"\\") else {
                self.joined.extend_from_slice(line);
                break;
            };
            self.joined.extend_from_slice(start);
        }
        Some((number, self.joined.trim_ascii()))
    }
}
