//! Lines of a text file of any origin: ended by LF, CRLF or a lone CR.

/// Numbers and contents of lines, without their ends; copying it marks a place to come back to.
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: u32,
}

impl<'a> Lines<'a> {
    /// The lines of a file whose byte-order mark, if any, is skipped.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 0 }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (u32, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        self.number = self.number.saturating_add(1);
        let Some(end) = memchr::memchr2(b'\n', b'\r', self.rest) else {
            return Some((self.number, std::mem::take(&mut self.rest)));
        };
        let line = &self.rest[..end];
        let length = if self.rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
        self.rest = &self.rest[end + length..];
        Some((self.number, line))
    }
}

/// A short quotation of a file for messages: quoted, other than ASCII replaced, at most 24 characters.
pub(super) fn quote(bytes: &[u8]) -> String {
    let bytes = bytes.trim_ascii();
    let text: String = bytes
        .iter()
        .take(24)
        .map(|&byte| if byte.is_ascii_graphic() || byte == b' ' { byte as char } else { '?' })
        .collect();
    let more = if bytes.len() > 24 { "..." } else { "" };
    format!("\"{text}{more}\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_line_ends_are_one_line_each() {
        let lines: Vec<_> = Lines::new(b"\xef\xbb\xbfa\nb\r\nc\rd\n\n\re").collect();
        let expected: [(u32, &[u8]); 7] = [(1, b"a"), (2, b"b"), (3, b"c"), (4, b"d"), (5, b""), (6, b""), (7, b"e")];
        assert_eq!(lines, expected);
        assert_eq!(Lines::new(b"").count(), 0);
    }

    #[test]
    fn quotations_are_short_and_printable() {
        assert_eq!(quote(b"  ab\xffc "), "\"ab?c\"");
        assert_eq!(quote(&[b'x'; 100]).len(), 24 + 3 + 2);
    }
}
