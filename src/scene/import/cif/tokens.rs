//! The words of a CIF text: names, values and reserved words, with the lines they stand on.
//!
//! Read as bytes, because comments and text may be in any encoding. Syntax after [Hall1991, throughout] (CIF 1.1): values are bare,
//! quoted within a line, or text fields between lines that begin with `;`. A quote ends where white space follows it, so
//! that `'O5'A'` is one value.

use super::value::Value;

/// A word.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Token<'a> {
    /// `data_` and the name of the block.
    Data(&'a [u8]),
    /// `loop_`.
    Loop,
    /// `save_`, `stop_` or `global_`, which data files do without.
    Other,
    /// A name, which begins with `_`.
    Name(&'a [u8]),
    /// A value.
    Value(Value<'a>),
}

/// A value that was never closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unclosed {
    /// A quotation that the line's end closed.
    Quote,
    /// A text field that runs to the end of the file.
    TextField,
}

/// A reader of words; copying its place marks where to come back to.
#[derive(Debug)]
pub(super) struct Tokens<'a> {
    bytes: &'a [u8],
    place: Place,
    unclosed: Vec<(Unclosed, u32)>,
    /// Line of the first text field that holds a `loop_`: it was probably not closed where it should have been.
    swallowing: Option<u32>,
}

/// Where a reader is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    at: usize,
    line: u32,
}

impl<'a> Tokens<'a> {
    /// The words of a file whose byte-order mark, if any, is skipped.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Self { bytes, place: Place { at: 0, line: 1 }, unclosed: Vec::new(), swallowing: None }
    }

    /// The line of the next word, from 1, once [`Self::skip_space`] has found it; else that of the last one's end.
    pub(super) const fn line(&self) -> u32 {
        self.place.line
    }

    /// Where the next word is searched.
    pub(super) const fn place(&self) -> Place {
        self.place
    }

    /// Goes back to a place.
    pub(super) fn go_back(&mut self, place: Place) {
        self.place = place;
        while self.unclosed.pop_if(|&mut (_, line)| line >= place.line).is_some() {}
    }

    /// What was never closed so far, with its lines.
    pub(super) fn unclosed(&self) -> &[(Unclosed, u32)] {
        &self.unclosed
    }

    /// The line of the text field that was most likely meant to end earlier, if one never ends.
    pub(super) fn unclosed_text_field(&self) -> Option<u32> {
        let last = self.unclosed.iter().find(|(unclosed, _)| *unclosed == Unclosed::TextField)?;
        Some(self.swallowing.map_or(last.1, |line| line.min(last.1)))
    }

    /// Goes to the next word and returns its first byte; none at the end of the file.
    pub(super) fn skip_space(&mut self) -> Option<u8> {
        let mut at = self.place.at;
        while let Some(&byte) = self.bytes.get(at) {
            if byte > b' ' && byte != b'#' {
                self.place.at = at;
                return Some(byte);
            }
            at += 1;
            match byte {
                b'\n' => self.place.line += 1,
                b'\r' => self.place.line += u32::from(self.bytes.get(at) != Some(&b'\n')),
                b'#' => at += memchr::memchr2(b'\n', b'\r', &self.bytes[at..]).unwrap_or(self.bytes.len() - at),
                _ => {}
            }
        }
        self.place.at = at;
        None
    }

    /// The next word.
    pub(super) fn next(&mut self) -> Option<Token<'a>> {
        if let Some(value) = self.value() {
            return Some(Token::Value(value));
        }
        self.skip_space()?;
        let word = self.bare();
        self.place.at += word.len();
        Some(reserved(word).unwrap_or(Token::Name(word)))
    }

    /// The next word if it is a value; else it stays.
    pub(super) fn value(&mut self) -> Option<Value<'a>> {
        match self.skip_space()? {
            b'_' => None,
            quote @ (b'\'' | b'"') => Some(Value::Text(self.quotation(quote))),
            b';' if self.is_line_start() => Some(Value::Text(self.text_field())),
            _ => {
                let word = self.bare();
                if matches!(word, [b'.' | b'?']) {
                    self.place.at += 1;
                    return Some(Value::Missing);
                }
                if reserved(word).is_some() {
                    return None;
                }
                self.place.at += word.len();
                Some(Value::Text(word))
            }
        }
    }

    /// The bytes up to the next white space.
    fn bare(&self) -> &'a [u8] {
        let rest = &self.bytes[self.place.at..];
        let length = rest.iter().position(|&byte| byte <= b' ').unwrap_or(rest.len());
        &rest[..length]
    }

    fn is_line_start(&self) -> bool {
        let before = self.place.at.checked_sub(1).and_then(|at| self.bytes.get(at));
        before.is_none_or(|byte| matches!(byte, b'\n' | b'\r'))
    }

    /// A quotation, at its opening quote.
    fn quotation(&mut self, quote: u8) -> &'a [u8] {
        let rest = &self.bytes[self.place.at + 1..];
        for end in memchr::memchr3_iter(quote, b'\n', b'\r', rest) {
            let is_end_of_line = rest[end] != quote;
            if !is_end_of_line && rest.get(end + 1).is_some_and(|&next| next > b' ') {
                continue;
            }
            if is_end_of_line {
                self.unclosed.push((Unclosed::Quote, self.place.line));
            }
            self.place.at += 1 + end + usize::from(!is_end_of_line);
            return &rest[..end];
        }
        self.unclosed.push((Unclosed::Quote, self.place.line));
        self.place.at = self.bytes.len();
        rest
    }

    /// A text field, at its opening semicolon.
    fn text_field(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.place.at + 1..];
        let is_close = |&at: &usize| at.checked_sub(1).is_some_and(|before| matches!(rest[before], b'\n' | b'\r'));
        let Some(end) = memchr::memchr_iter(b';', rest).find(is_close) else {
            self.unclosed.push((Unclosed::TextField, self.place.line));
            self.place.line += num_line_ends(rest);
            self.place.at = self.bytes.len();
            return rest;
        };
        if self.swallowing.is_none() && memchr::memmem::find(&rest[..end], b"\nloop_").is_some() {
            self.swallowing = Some(self.place.line);
        }
        self.place.line += num_line_ends(&rest[..end]);
        self.place.at += 1 + end + 1;
        let text = &rest[..end];
        let text = text.strip_suffix(b"\n").unwrap_or(text);
        text.strip_suffix(b"\r").unwrap_or(text)
    }
}

/// Lines that end within some bytes.
fn num_line_ends(bytes: &[u8]) -> u32 {
    let is_end = |&at: &usize| bytes[at] == b'\n' || bytes.get(at + 1) != Some(&b'\n');
    memchr::memchr2_iter(b'\n', b'\r', bytes).filter(is_end).count() as u32
}

/// The reserved word, in any case, if a bare word is one.
fn reserved(word: &[u8]) -> Option<Token<'_>> {
    if word.get(4) != Some(&b'_') {
        return word.eq_ignore_ascii_case(b"global_").then_some(Token::Other);
    }
    let (start, rest) = word.split_at(5);
    let is = |reserved: &[u8]| start.eq_ignore_ascii_case(reserved);
    if is(b"data_") {
        Some(Token::Data(rest))
    } else if is(b"loop_") && rest.is_empty() {
        Some(Token::Loop)
    } else if is(b"save_") || is(b"stop_") && rest.is_empty() {
        Some(Token::Other)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<(Token<'_>, u32)> {
        let mut tokens = Tokens::new(text.as_bytes());
        let mut all = Vec::new();
        while tokens.skip_space().is_some() {
            let line = tokens.line();
            all.extend(tokens.next().map(|token| (token, line)));
        }
        all
    }

    fn values(text: &str) -> Vec<String> {
        let text_of = |(token, _)| match token {
            Token::Value(Value::Text(text)) => String::from_utf8_lossy(text).into_owned(),
            token => format!("{token:?}"),
        };
        all(text).into_iter().map(text_of).collect()
    }

    #[test]
    fn words_know_their_lines_with_every_line_end() {
        let text = "data_1\n_a.b 'x y'\n# c\nloop_\n_c\n1 .\n;t\nu\n;\n?";
        for end in ["\n", "\r\n", "\r"] {
            let text = text.replace('\n', end);
            let lines: Vec<u32> = all(&text).into_iter().map(|(_, line)| line).collect();
            assert_eq!(lines, [1, 2, 2, 4, 5, 6, 6, 7, 10], "{end:?}");
            assert_eq!(all(&text)[0].0, Token::Data(b"1"));
            assert_eq!(all(&text)[3].0, Token::Loop);
            assert_eq!(all(&text)[7].0, Token::Value(Value::Text(format!("t{end}u").as_bytes())));
            assert_eq!(all(&text)[8].0, Token::Value(Value::Missing));
        }
    }

    #[test]
    fn quotes_end_before_white_space_only() {
        assert_eq!(values("'O5'A' \"O5'\" a'b ''"), ["O5'A", "O5'", "a'b", ""]);
        assert_eq!(values("a#b 'c #d' #e"), ["a#b", "c #d"]);
        assert_eq!(values("'.' \"?\""), [".", "?"]);
        assert_eq!(values("a;b ;c"), ["a;b", ";c"]);
    }

    #[test]
    fn reserved_words_have_any_case() {
        assert_eq!(all("DATA_x Loop_ loop_x SAVE_ global_ _loop_").len(), 6);
        let kinds: Vec<Token<'_>> =
            all("DATA_x Loop_ loop_x SAVE_ global_ _n").into_iter().map(|pair| pair.0).collect();
        let value = Token::Value(Value::Text(b"loop_x"));
        assert_eq!(kinds, [Token::Data(b"x"), Token::Loop, value, Token::Other, Token::Other, Token::Name(b"_n")]);
    }

    #[test]
    fn what_is_never_closed_is_told() {
        let mut tokens = Tokens::new(b"1 'abc\n2 \n;text\n 3");
        while tokens.next().is_some() {}
        assert_eq!(tokens.unclosed(), [(Unclosed::Quote, 1), (Unclosed::TextField, 3)]);
        assert_eq!(values("1 'abc\n2"), ["1", "abc", "2"]);
        assert_eq!(values("'"), [""]);
        assert_eq!(values(";"), [""]);
    }
}
