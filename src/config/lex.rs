//! Text to tokens. Comments and blanks are passed over; quotes that are missing or wrong are mended where it is clear
//! what was meant.
//!
//! A missing quote is the slip with the longest tail: from there on, what is text and what is not change places. No
//! text goes over a line break, so that a line that ends inside a text tells that one of its quotes is missing. Only on
//! such lines does the lexer guess which, once a line; every guess looks a bounded way ahead, so that the whole stays
//! linear in the length of the file.

use std::ops::Range;

use super::hint::quote;
use super::slips::Slips;

/// How far a guess looks ahead, in bytes. Ours: longer than any key or name.
const REACH: usize = 300;

/// `{}` or `[]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bracket {
    Curly,
    Square,
}

impl Bracket {
    pub(super) fn open(self) -> char {
        if self == Self::Curly { '{' } else { '[' }
    }

    pub(super) fn close(self) -> char {
        if self == Self::Curly { '}' } else { ']' }
    }
}

/// A piece of the text that is neither blank nor comment.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Token {
    Open(Bracket),
    Close(Bracket),
    Comma,
    Semicolon,
    Colon,
    Equals,
    /// A text; `None` if it holds what cannot be read, which was said.
    Text(Option<String>),
    /// A number, a literal, or what stands without quotes and should not.
    Bare,
    End,
}

/// What the next token should be, which tells how to mend it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Due {
    Key,
    Value,
}

/// Goes through a text.
pub(super) struct Lexer<'a> {
    pub(super) slips: Slips<'a>,
    text: &'a str,
    at: usize,
    /// The end of the line whose quotes were counted last, and whether one was left over.
    counted: (usize, bool),
    /// Up to where a guess at the true end of a text looked in vain, or found it.
    searched: usize,
    /// Whether a value must follow, so that `#` begins a colour rather than a comment.
    is_value_next: bool,
    /// Whether the rest of the text is lost in a comment or was given up.
    pub(super) is_cut: bool,
    /// Whether bytes that were no UTF-8 stand as [`SUBSTITUTE`].
    pub(super) has_substitutes: bool,
}

/// Stands for a byte that is no UTF-8, once that was said. As long as one byte, so that no offset moves.
pub(super) const SUBSTITUTE: char = '\u{7f}';

impl<'a> Lexer<'a> {
    pub(super) fn new(slips: Slips<'a>, has_substitutes: bool) -> Self {
        let text = slips.text;
        Self {
            slips,
            text,
            at: 0,
            counted: (0, false),
            searched: 0,
            is_value_next: false,
            is_cut: false,
            has_substitutes,
        }
    }

    /// The next token and its bytes.
    pub(super) fn next(&mut self, due: Due) -> (Token, Range<usize>) {
        self.skip_blank();
        let start = self.at;
        let Some(first) = self.text[start..].chars().next() else {
            return (Token::End, start..start);
        };
        let token = match first {
            '{' => self.single(Token::Open(Bracket::Curly)),
            '[' => self.single(Token::Open(Bracket::Square)),
            '}' => self.single(Token::Close(Bracket::Curly)),
            ']' => self.single(Token::Close(Bracket::Square)),
            ',' => self.single(Token::Comma),
            ';' => self.single(Token::Semicolon),
            ':' => self.single(Token::Colon),
            '=' => self.single(Token::Equals),
            '"' => self.text(start, due),
            quote if closers(quote).is_some() => self.other_quotes(start, quote, due),
            _ => self.bare(start, due),
        };
        self.is_value_next =
            matches!(token, Token::Colon | Token::Equals | Token::Comma | Token::Open(Bracket::Square));
        (token, start..self.at)
    }

    /// The first byte from here on that is no blank; comments count.
    pub(super) fn next_byte(&self) -> Option<u8> {
        self.bytes()[self.at..].iter().copied().find(|byte| !is_blank(*byte))
    }

    /// The text of a range.
    pub(super) fn slice(&self, range: &Range<usize>) -> &'a str {
        &self.text[range.clone()]
    }

    /// Where the whole number begins that ends in a comma right before an offset, as in `1,5`.
    pub(super) fn number_before_comma(&self, offset: usize) -> Option<usize> {
        let before = self.text[..offset].strip_suffix(',')?;
        let digits = before.bytes().rev().take(20).take_while(u8::is_ascii_digit).count();
        (digits > 0).then_some(before.len() - digits)
    }

    /// Gives the rest of the text up.
    pub(super) fn cut(&mut self) {
        self.at = self.text.len();
        self.is_cut = true;
        self.slips.is_whole = false;
    }

    /// How many more of each bracket are opened than closed, curly first.
    pub(super) fn balance(&self) -> [i64; 2] {
        let bytes = self.bytes();
        let mut balance = [0, 0];
        let mut at = 0;
        while at < bytes.len() {
            match bytes[at] {
                b'{' => balance[0] += 1,
                b'}' => balance[0] -= 1,
                b'[' => balance[1] += 1,
                b']' => balance[1] -= 1,
                b'"' => at = self.end_of_text(at + 1).0,
                b'/' if bytes.get(at + 1) == Some(&b'/') => at = self.line_break(at),
                b'/' if bytes.get(at + 1) == Some(&b'*') => at = self.end_of_comment(at).unwrap_or(bytes.len()),
                _ => {}
            }
            at += 1;
        }
        balance
    }

    fn bytes(&self) -> &'a [u8] {
        self.text.as_bytes()
    }

    fn single(&mut self, token: Token) -> Token {
        self.at += 1;
        token
    }

    fn skip_blank(&mut self) {
        let bytes = self.bytes();
        while let Some(byte) = bytes.get(self.at) {
            let start = self.at;
            match (*byte, bytes.get(self.at + 1)) {
                (byte, _) if is_blank(byte) => self.at += 1,
                (b'/', Some(b'/')) => self.at = self.line_feed(start),
                (b'/', Some(b'*')) => match self.end_of_comment(start) {
                    Some(end) => self.at = end,
                    None => {
                        self.slips.tell(start..start + 2, || "this comment is never closed: */ is missing");
                        self.cut();
                    }
                },
                (b'*', Some(b'/')) => {
                    self.at += 2;
                    self.slips.tell(start..self.at, || "this */ closes no comment: remove it");
                }
                (b'/', _) => {
                    self.at += 1;
                    self.slips.tell(start..self.at, || "a comment begins with // or /*: remove this /");
                }
                (b'#', _) if !(self.is_value_next && self.is_color()) => {
                    self.at = self.line_feed(start);
                    self.slips.tell(start..self.at, || "a comment begins with //, not #");
                }
                _ => {
                    let strange: usize =
                        self.text[start..].chars().take_while(|c| is_strange(*c)).map(char::len_utf8).sum();
                    if strange == 0 {
                        return;
                    }
                    self.at += strange;
                    if self.has_substitutes && self.text[start..self.at].chars().all(|c| c == SUBSTITUTE) {
                        self.slips.is_whole = false;
                        continue;
                    }
                    let code = self.text[start..].chars().next().map_or(0, u32::from);
                    self.slips.tell(start..self.at, || {
                        format!("the invisible character U+{code:04X} has no place here: write a plain space")
                    });
                }
            }
        }
    }

    /// `#` and 3, 4, 6 or 8 digits.
    fn is_color(&self) -> bool {
        let digits = self.bytes()[self.at + 1..].iter().take_while(|byte| byte.is_ascii_alphanumeric()).take(9);
        let (mut count, mut all_hex) = (0, true);
        digits.for_each(|byte| (count, all_hex) = (count + 1, all_hex && byte.is_ascii_hexdigit()));
        all_hex && matches!(count, 3 | 4 | 6 | 8)
    }

    /// The line feed that ends the line of an offset, or the end.
    fn line_feed(&self, from: usize) -> usize {
        memchr::memchr(b'\n', &self.bytes()[from..]).map_or(self.text.len(), |length| from + length)
    }

    /// Where no text can go on: a line feed, a carriage return, or the end.
    fn line_break(&self, from: usize) -> usize {
        memchr::memchr2(b'\n', b'\r', &self.bytes()[from..]).map_or(self.text.len(), |length| from + length)
    }

    /// One past the comment that begins at `start`.
    fn end_of_comment(&self, start: usize) -> Option<usize> {
        memchr::memmem::find(&self.bytes()[start + 2..], b"*/").map(|length| start + 2 + length + 2)
    }

    /// The closing quote of the text whose inside begins here, or the line break that comes first, and which it is.
    fn end_of_text(&self, inside: usize) -> (usize, bool) {
        let bytes = self.bytes();
        let mut at = inside;
        while let Some(byte) = bytes.get(at) {
            match byte {
                b'"' => return (at, true),
                b'\n' | b'\r' => return (at, false),
                b'\\' if !matches!(bytes.get(at + 1), Some(b'\n' | b'\r') | None) => at += 2,
                _ => at += 1,
            }
        }
        (bytes.len(), false)
    }

    /// Whether the line ends inside a text, seen from a token of it.
    fn is_odd_line(&mut self, from: usize) -> bool {
        if from < self.counted.0 {
            return self.counted.1;
        }
        let bytes = self.bytes();
        let mut at = from;
        self.counted = loop {
            match bytes.get(at) {
                None | Some(b'\n' | b'\r') => break (at, false),
                Some(b'"') => match self.end_of_text(at + 1) {
                    (end, true) => at = end + 1,
                    (end, false) => break (end, true),
                },
                Some(b'/') if bytes.get(at + 1) == Some(&b'/') => break (self.line_break(at), false),
                Some(b'/') if bytes.get(at + 1) == Some(&b'*') => match self.end_of_comment(at) {
                    Some(end) => at = end,
                    None => break (bytes.len(), false),
                },
                Some(_) => at += 1,
            }
        };
        self.counted.1
    }

    /// No more guesses on this line.
    fn settle_line(&mut self, from: usize) {
        self.counted = (self.line_break(from).max(self.counted.0), false);
    }

    /// The token at a double quote.
    fn text(&mut self, start: usize, due: Due) -> Token {
        let (end, is_closed) = self.end_of_text(start + 1);
        let runs_on = is_closed && self.text[end + 1..].chars().next().is_some_and(is_bare);
        if !is_closed || (runs_on && self.is_odd_line(start)) {
            return self.unclosed(start, due);
        }
        if is_closed && self.bytes().get(end + 1) == Some(&b'"') && self.is_odd_line(start) {
            self.settle_line(start);
            self.slips.tell(end + 1..end + 2, || "this quote is one too many: remove it");
            self.at = end + 2;
            return self.read(start + 1..end);
        }
        if runs_on && let Some(close) = self.outer_close(end + 1) {
            self.tell_quote_within(end);
            self.at = close + 1;
            self.slips.is_whole = false;
            return Token::Text(None);
        }
        self.at = end + 1;
        self.read(start + 1..end)
    }

    fn read(&mut self, inside: Range<usize>) -> Token {
        // What these bytes were is not known, and that they are no UTF-8 was said.
        if self.has_substitutes && self.text[inside.clone()].contains(SUBSTITUTE) {
            self.slips.is_whole = false;
            return Token::Text(None);
        }
        match super::escape::unescape(self.text, inside) {
            Ok(text) => Token::Text(Some(text)),
            Err((place, words)) => {
                self.slips.tell(place, || words);
                self.slips.is_whole = false;
                Token::Text(None)
            }
        }
    }

    fn tell_quote_within(&mut self, at: usize) {
        self.slips.tell(at..at + 1, || "this quote ends the text: a quote within a text is written \\\"");
    }

    /// A quote on this line that a separator follows: the true end of a text that holds quotes.
    fn outer_close(&mut self, from: usize) -> Option<usize> {
        // Where a search found none, the next ones would look at the same bytes.
        if from < self.searched {
            return None;
        }
        let reach = self.reach(from);
        self.searched = from + reach.len();
        let mut quotes = memchr::memchr_iter(b'"', reach.as_bytes()).map(|at| from + at);
        quotes.find(|at| self.is_followed_by_separator(at + 1))
    }

    fn is_followed_by_separator(&self, at: usize) -> bool {
        let next = self.bytes()[at..].iter().copied().find(|byte| !matches!(byte, b' ' | b'\t'));
        matches!(next, None | Some(b',' | b':' | b']' | b'}' | b'\n' | b'\r'))
    }

    /// What follows on the line, as far as guesses look.
    fn reach(&self, from: usize) -> &'a str {
        let near = &self.bytes()[from..self.bytes().len().min(from + REACH)];
        let mut end = memchr::memchr2(b'\n', b'\r', near).map_or(from + near.len(), |length| from + length);
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        &self.text[from..end]
    }

    /// A text whose closing quote is missing.
    fn unclosed(&mut self, start: usize, due: Due) -> Token {
        self.settle_line(start);
        let inside = self.reach(start + 1);
        let before_quote = inside.split('"').next().unwrap_or(inside);
        if due == Due::Key
            && let Some((key, _)) = before_quote.split_once(':')
            && is_sound_guess(key)
        {
            return self.mended_text(start, start + 1 + key.len(), key, "key");
        }
        if before_quote.len() == inside.len()
            && let Some(end) = self.end_on_a_later_line(start)
        {
            let line_end = self.line_break(start);
            self.slips.tell(
                start..line_end,
                || "a text cannot go over a line break: write it in one line, with \\n for a break",
            );
            self.slips.is_whole = false;
            self.at = end;
            return Token::Text(None);
        }
        // A guess that goes on beyond what is looked at is none.
        let is_line = start + 1 + inside.len() == self.line_break(start);
        if let Some(length) = end_of_value(before_quote, inside)
            && (is_line || length < inside.len())
        {
            let value = &before_quote[..length];
            if is_sound_guess(value) {
                return self.mended_text(start, start + 1 + length, value, "text");
            }
        }
        let line_end = self.line_break(start);
        self.slips.is_whole = false;
        let quote_within = before_quote.len() < inside.len();
        if quote_within && let Some(close) = self.outer_close(start + 2 + before_quote.len()) {
            self.tell_quote_within(start + 1 + before_quote.len());
            self.at = close + 1;
        } else {
            self.slips.tell(start..line_end, || "this text is not closed: write \" at its end");
            self.at = line_end;
        }
        Token::Text(None)
    }

    /// A text without its closing quote, up to `end`, where tokens go on.
    fn mended_text(&mut self, start: usize, end: usize, content: &str, what: &str) -> Token {
        let content = content.trim();
        self.at = end;
        self.slips
            .tell(start..start + 1 + content.len(), || format!("this {what} is not closed: write {}", quote(content)));
        Token::Text(Some(content.to_owned()))
    }

    /// One past the closing quote of a text that goes over a line break, if that is what it does.
    fn end_on_a_later_line(&self, start: usize) -> Option<usize> {
        let line_end = self.line_break(start);
        let mut end = (line_end + REACH).min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        let (between, _) = self.text[line_end..end].split_once('"')?;
        let close = line_end + between.len();
        let is_text = !between.contains(['{', '}', '[', ']', ':', ',']);
        let goes_on = self.is_followed_by_separator(close + 1) && !self.reach(close + 1).trim_start().starts_with(':');
        (is_text && goes_on).then_some(close + 1)
    }

    /// A text in single or typographic quotes.
    fn other_quotes(&mut self, start: usize, opener: char, due: Due) -> Token {
        let inside = start + opener.len_utf8();
        let reach = self.reach(inside);
        let closers = closers(opener).unwrap_or_default();
        let Some((content, after)) = reach.find(closers).map(|length| reach.split_at(length)) else {
            let length = match due {
                Due::Key => reach.find(':'),
                Due::Value => end_of_value(reach, reach),
            };
            let content = &reach[..length.unwrap_or(reach.len())];
            self.at = inside + content.len();
            self.slips.is_whole &= length.is_some();
            self.slips.tell(start..self.at, || {
                format!("a text stands in straight double quotes: write {}", quote(content.trim()))
            });
            return Token::Text(length.map(|_| content.trim().to_owned()));
        };
        self.at = inside + content.len() + after.chars().next().map_or(0, char::len_utf8);
        self.slips
            .tell(start..self.at, || format!("a text stands in straight double quotes: write {}", quote(content)));
        if content.contains('\\') {
            self.slips.is_whole = false;
            return Token::Text(None);
        }
        Token::Text(Some(content.to_owned()))
    }

    /// What stands without quotes, up to the next character that ends it.
    fn bare(&mut self, start: usize, due: Due) -> Token {
        if due == Due::Key
            && self.is_odd_line(start)
            && let Some((key, after)) = self.reach(start).split_once('"')
            && after.trim_start_matches([' ', '\t']).starts_with(':')
        {
            return self.unopened(start, key);
        }
        let rest = &self.text[start..];
        // Bytes above 127 belong to characters that are looked at one by one; the first is taken whatever it is.
        let end = rest.char_indices().skip(1).find(|(_, c)| !is_bare(*c)).map_or(self.text.len(), |(at, _)| start + at);
        let run = &self.text[start..end];
        if self.bytes().get(end) == Some(&b'"') && self.is_odd_line(start) {
            return self.unopened(start, run);
        }
        self.at = end;
        if run.contains('(') && !run.contains(')') {
            self.at += self.reach(end).find(')').map_or(0, |length| length + 1);
        } else if due == Due::Key {
            // A selector.
            while self.bytes().get(self.at) == Some(&b'[')
                && let Some((inside, _)) = self.reach(self.at + 1).split_once(']')
                && !inside.contains(['"', '{', '[', ','])
            {
                self.at += inside.len() + 2;
            }
        }
        Token::Bare
    }

    /// A text without its opening quote.
    fn unopened(&mut self, start: usize, content: &str) -> Token {
        self.settle_line(start);
        self.at = start + content.len() + 1;
        self.slips.tell(start..self.at, || format!("this text has no opening quote: write {}", quote(content)));
        Token::Text(Some(content.to_owned()))
    }
}

fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r')
}

/// What looks like a space or like nothing: control characters, wide and no-break spaces, marks without width.
fn is_strange(c: char) -> bool {
    let is_plain = c.is_ascii() && is_blank(c as u8);
    (!is_plain && (c.is_control() || c.is_whitespace()))
        || matches!(c, '\u{feff}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}' | '\u{2066}'..='\u{2069}')
}

/// What can be part of a piece without quotes.
fn is_bare(c: char) -> bool {
    let ends_it = matches!(c, '{' | '}' | '[' | ']' | ',' | ':' | ';' | '=' | '"' | '/');
    !ends_it && !c.is_whitespace() && !is_strange(c) && closers(c).is_none()
}

/// What closes a text that begins with a quote other than `"`; `None` for what is no such quote.
fn closers(opener: char) -> Option<&'static [char]> {
    match opener {
        '\'' | '\u{2018}' | '\u{2019}' | '\u{201a}' | '`' => Some(&['\'', '\u{2018}', '\u{2019}', '`']),
        '\u{201c}' | '\u{201d}' | '\u{201e}' | '\u{ab}' | '\u{bb}' => {
            Some(&['\u{201c}', '\u{201d}', '\u{ab}', '\u{bb}', '"'])
        }
        _ => None,
    }
}

/// Whether a guess at a text that lacks a quote looks like a name, a selector or a value.
fn is_sound_guess(content: &str) -> bool {
    !content.trim().is_empty() && !content.contains(['{', '}', '"', '\\']) && !content.chars().any(is_control)
}

fn is_control(c: char) -> bool {
    c.is_control()
}

/// Where a value without its closing quote ends: at a separator outside brackets after which a style goes on.
fn end_of_value(before_quote: &str, line: &str) -> Option<usize> {
    let bytes = before_quote.as_bytes();
    let mut depth = 0_usize;
    let mut at = 0;
    while at < bytes.len() {
        match bytes[at] {
            b'[' | b'{' => depth += 1,
            b']' | b'}' if depth > 0 => depth -= 1,
            b',' | b']' | b'}' if depth == 0 => {
                let rest = line[at..].trim_start_matches([' ', '\t', ',', ']', '}']);
                if rest.is_empty() || rest.starts_with(['"', '{']) || rest.starts_with("//") {
                    return Some(at);
                }
                at = line.len() - rest.len();
                continue;
            }
            _ => {}
        }
        at += 1;
    }
    // Nothing follows on the line: the value is all of it.
    (before_quote.len() == line.len() && !line.contains([':', '{', '['])).then_some(before_quote.trim_end().len())
}
