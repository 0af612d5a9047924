//! Tokens to a tree, over every mistake on the way.
//!
//! A mistake is told once, where it is, and costs as little of the tree as it can: what stands around it is read on.
//! A value that cannot be read is [`Tree::Broken`]; a key that cannot be read takes its value with it. Brackets need
//! most care, for one that is missing moves all that follow. Whether a wrong one was meant for another, is one too many,
//! or shows that one is missing before it, is told by how many of each the whole file opens and closes.

use std::ops::Range;

use super::bare::{self, BareSlip};
use super::error::{Mistakes, Place, Problem};
use super::hint::quote;
use super::lex::{Bracket, Due, Lexer, SUBSTITUTE, Token};
use super::slips::Slips;
use super::source::{Positions, Source, Text};
use super::syntax::{MAX_BYTES, MAX_DEPTH, MAX_VALUES, Member, Node, Span, Tree, find_duplicates};

/// Parses a source as text number `file` of its style. What is wrong is pushed onto `mistakes`; a text in which nothing
/// can be read has a root that is [`Tree::Broken`].
pub(super) fn parse(source: &Source, file: u32, mistakes: &mut Mistakes) -> Text {
    let bytes = source.text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&source.text);
    let root = Node { value: Tree::Broken, span: Span { file, start: 0, end: 0 } };
    let mut text = Text {
        name: source.name.as_str().into(),
        text: String::new(),
        positions: Positions::new(b""),
        root,
        broken: vec![(0, 0)],
        is_whole: false,
        is_closed: true,
    };
    let of_file = |problem| (Place::of_file(&source.name), problem);
    if bytes.len() > MAX_BYTES {
        let (place, problem) = of_file(Problem::Unreadable(too_large()));
        mistakes.push(|| place, problem);
        return text;
    }
    text.positions = Positions::new(bytes);
    let first_bad = std::str::from_utf8(bytes).err().map(|error| error.valid_up_to());
    // A zero as one of the first two bytes is UTF-16, also without a mark: nothing in it can be read.
    let is_wide =
        bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") || bytes.iter().take(2).any(|byte| *byte == 0);
    if is_wide || first_bad.is_some() {
        let offset = if is_wide { 0 } else { first_bad.unwrap_or(0) };
        let (line, column) = text.positions.line_column(bytes, offset);
        let place = Place { line, column, start: offset, end: offset + 1, ..Place::of_file(&source.name) };
        mistakes.push(|| place, Problem::NotUtf8);
        if is_wide {
            return text;
        }
    }
    text.text = match first_bad {
        None => String::from_utf8_lossy(bytes).into_owned(),
        Some(_) => substitute(bytes),
    };
    if text.text.trim_ascii().is_empty() {
        let (place, problem) = of_file(Problem::Syntax("the file is empty: the smallest style is {}".to_owned()));
        mistakes.push(|| place, problem);
        return text;
    }
    let slips = Slips {
        name: &text.name,
        text: &text.text,
        positions: &text.positions,
        mistakes,
        is_muted: false,
        is_told: false,
        is_whole: true,
    };
    let mut parser = Parser {
        lexer: Lexer::new(slips, first_bad.is_some()),
        file,
        peeked: None,
        last: 0..0,
        open: Vec::new(),
        balance: None,
        told_bracket: None,
        is_end_told: false,
        is_depth_told: false,
        is_closed: true,
        num_values: 0,
        key_of_parent: None,
        broken: Vec::new(),
    };
    let root = parser.root();
    let Parser { lexer, is_closed, mut broken, .. } = parser;
    let is_whole = lexer.slips.is_whole;
    broken.sort_unstable();
    if let Some(root) = root {
        (text.root, text.broken) = (root, broken);
    }
    (text.is_whole, text.is_closed) = (is_whole, is_closed);
    // Where brackets were moved, members of two objects may have come together.
    if is_closed {
        find_duplicates(&text.root, &text, mistakes);
    }
    text
}

/// Why a file is not read.
pub(super) fn too_large() -> String {
    format!("a style is at most {} MB, and this file is larger", MAX_BYTES / (1024 * 1024))
}

/// The text with a stand-in for every byte that is no UTF-8.
fn substitute(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|_| SUBSTITUTE));
    }
    text
}

/// What a closing bracket does to the list or object that is being read.
enum Closing {
    /// It closes it.
    Here,
    /// It closes one further out, so that a bracket is missing before it.
    Above,
    /// Nothing.
    Extra,
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    file: u32,
    peeked: Option<(Token, Range<usize>)>,
    /// The bytes of the last token that was taken.
    last: Range<usize>,
    /// The brackets that are open, each with its offset.
    open: Vec<(Bracket, usize)>,
    /// How many more of each bracket are opened than closed, less what was mended; counted when first asked for.
    balance: Option<[i64; 2]>,
    /// The token before which a missing bracket was told.
    told_bracket: Option<usize>,
    /// Whether it was told that the file ends too early, or goes on too long.
    is_end_told: bool,
    is_depth_told: bool,
    /// Whether every bracket is closed where it should be.
    is_closed: bool,
    num_values: usize,
    /// A key that ended the list before it, which lacks its bracket.
    key_of_parent: Option<(String, Range<usize>)>,
    broken: Vec<(u32, u32)>,
}

impl Parser<'_> {
    fn peek(&mut self, due: Due) -> &(Token, Range<usize>) {
        if self.peeked.is_none() {
            self.peeked = Some(self.lexer.next(due));
        }
        self.peeked.as_ref().expect("it was just filled")
    }

    fn take(&mut self, due: Due) -> (Token, Range<usize>) {
        let (token, range) = self.peeked.take().unwrap_or_else(|| self.lexer.next(due));
        if token != Token::End {
            self.last = range.clone();
        }
        (token, range)
    }

    fn put_back(&mut self, token: Token, range: Range<usize>) {
        self.peeked = Some((token, range));
    }

    fn tell<S: Into<String>>(&mut self, range: Range<usize>, words: impl FnOnce() -> S) {
        self.lexer.slips.tell(range, words);
    }

    fn lose(&mut self) {
        self.lexer.slips.is_whole = false;
    }

    /// Texts are at most [`MAX_BYTES`] long, so that offsets fit.
    fn span(&self, range: &Range<usize>) -> Span {
        Span { file: self.file, start: range.start as u32, end: range.end as u32 }
    }

    fn broken(&mut self, range: Range<usize>) -> Node {
        let span = self.span(&range);
        self.broken.push((span.start, span.end));
        Node { value: Tree::Broken, span }
    }

    /// The whole style; `None` if there is nothing in it.
    fn root(&mut self) -> Option<Node> {
        let mut root = loop {
            let (token, range) = self.take(Due::Value);
            match token {
                Token::End => {
                    if !self.lexer.slips.is_told {
                        self.tell(range, || "the file holds only comments: the smallest style is {}");
                    }
                    self.lose();
                    return None;
                }
                Token::Close(bracket) => {
                    self.tell(range, || format!("this {} closes nothing: remove it", bracket.close()));
                    self.lose();
                }
                Token::Comma | Token::Semicolon | Token::Colon | Token::Equals => {
                    self.tell(range, || "a style begins with {");
                    self.lose();
                }
                Token::Text(Some(_)) if self.lexer.next_byte() == Some(b':') => {
                    self.tell(range.clone(), || "a style stands in { and }: write { at its start and } at its end");
                    self.is_end_told = true;
                    self.open.push((Bracket::Curly, range.start));
                    let start = range.start;
                    self.put_back(token, range);
                    break self.object(start, Vec::new());
                }
                token => {
                    self.put_back(token, range);
                    break self.value();
                }
            }
        };
        loop {
            let (token, range) = self.take(Due::Key);
            match token {
                Token::End => return Some(root),
                Token::Close(bracket) => {
                    if !self.is_end_told {
                        self.tell(range, || format!("this {} closes nothing: remove it", bracket.close()));
                    }
                    self.is_end_told = true;
                }
                Token::Comma | Token::Text(_) if matches!(root.value, Tree::Object(_)) => {
                    let Node { value: Tree::Object(members), span } = root else { return Some(root) };
                    if !self.is_end_told {
                        let end = self.lexer.slips.at((span.end as usize).saturating_sub(1));
                        self.tell(range.clone(), || format!("there is more text after the end of the style, which is the }} at {end}: move that }} to the end, or remove this"));
                    }
                    self.is_end_told = true;
                    self.is_closed = false;
                    self.lose();
                    let start = span.start as usize;
                    self.open.push((Bracket::Curly, start));
                    self.put_back(token, range);
                    root = self.object(start, members);
                }
                _ => {
                    if !self.is_end_told {
                        self.tell(range, || "there is more text after the end of the style: remove it");
                    }
                    self.lose();
                    return Some(root);
                }
            }
        }
    }

    /// The value that begins with the next token.
    fn value(&mut self) -> Node {
        let (token, range) = self.take(Due::Value);
        self.num_values += 1;
        if self.num_values > MAX_VALUES && !self.lexer.is_cut {
            self.tell(range.clone(), || format!("a style holds at most {MAX_VALUES} values, and this file has more"));
            self.lexer.cut();
            return self.broken(range);
        }
        let value = match token {
            Token::Open(bracket) => return self.container(bracket, &range),
            Token::Text(Some(text)) => Tree::Text(text),
            Token::Bare => match bare::read(self.lexer.slice(&range)) {
                Ok(value) => value,
                Err(BareSlip { words, may_be_text }) => {
                    self.tell(range.clone(), || words);
                    self.lexer.slips.is_whole &= !may_be_text;
                    return self.broken(range);
                }
            },
            _ => return self.broken(range),
        };
        Node { value, span: self.span(&range) }
    }

    fn container(&mut self, bracket: Bracket, range: &Range<usize>) -> Node {
        if self.open.len() == MAX_DEPTH {
            return self.skip_depth(range);
        }
        self.open.push((bracket, range.start));
        match bracket {
            Bracket::Curly => self.object(range.start, Vec::new()),
            Bracket::Square => self.list(range.start),
        }
    }

    /// Passes over what is nested too deep, without going deeper itself.
    fn skip_depth(&mut self, range: &Range<usize>) -> Node {
        if !std::mem::replace(&mut self.is_depth_told, true) {
            self.tell(range.clone(), || format!("lists and objects are nested deeper than {MAX_DEPTH} levels"));
        }
        self.lose();
        let was_muted = std::mem::replace(&mut self.lexer.slips.is_muted, true);
        let mut depth = 1_usize;
        while depth > 0 {
            match self.take(Due::Value).0 {
                Token::Open(_) => depth += 1,
                Token::Close(_) => depth -= 1,
                Token::End => {
                    self.lexer.cut();
                    break;
                }
                _ => {}
            }
        }
        self.lexer.slips.is_muted = was_muted;
        let end = self.last.end;
        self.broken(range.start..end)
    }

    /// The members of an object whose bracket is open, after those that are there already.
    fn object(&mut self, start: usize, mut members: Vec<Member>) -> Node {
        let mut comma_due = matches!(self.peeked, Some((Token::Comma, _)));
        let mut is_first = members.is_empty();
        let end = loop {
            if let Some((key, range)) = self.key_of_parent.take() {
                members.extend(self.member(Some(key), &range));
                comma_due = true;
                continue;
            }
            let (token, range) = self.take(Due::Key);
            comma_due = match token {
                Token::End => {
                    self.tell_unclosed();
                    break self.last.end;
                }
                Token::Close(bracket) => match self.close(bracket, &range) {
                    Closing::Here => break range.end,
                    Closing::Above => {
                        self.put_back(token, range.clone());
                        break range.start;
                    }
                    Closing::Extra => comma_due,
                },
                Token::Comma | Token::Semicolon => {
                    self.separator(&token, range, comma_due, is_first);
                    false
                }
                Token::Text(key) => {
                    if comma_due {
                        self.tell(range.clone(), || "a comma is missing before this key");
                    }
                    members.extend(self.member(key, &range));
                    true
                }
                Token::Bare => {
                    if let Some(key) = self.bare_key(&range, comma_due) {
                        members.extend(self.member(Some(key), &range));
                    }
                    true
                }
                Token::Open(bracket) => {
                    if bracket == Bracket::Curly && self.lacks_brace() {
                        self.tell_missing_close(&range, "{");
                        self.put_back(token, range.clone());
                        break range.start;
                    }
                    self.tell(range.clone(), || format!("a key is missing before this {}", bracket.open()));
                    self.lose();
                    self.put_back(token, range);
                    self.value();
                    true
                }
                Token::Colon | Token::Equals => {
                    self.tell(range, || "a key is missing before this colon");
                    self.lose();
                    if matches!(self.peek(Due::Value).0, Token::Text(_) | Token::Bare | Token::Open(_)) {
                        self.value();
                    }
                    true
                }
            };
            is_first = false;
        };
        Node { value: Tree::Object(members), span: self.span(&(start..end)) }
    }

    /// The member of a key; `None` if the key could not be read, so that nobody can tell what its value should be.
    fn member(&mut self, key: Option<String>, key_range: &Range<usize>) -> Option<Member> {
        let shown = || key.as_deref().map_or_else(|| "this key".to_owned(), quote);
        let (token, range) = self.take(Due::Value);
        let has_colon = match token {
            Token::Colon => true,
            Token::Equals | Token::Semicolon => {
                let wrong = self.lexer.slice(&range);
                self.tell(range, || format!("write : instead of {wrong} between a key and its value"));
                true
            }
            Token::Text(_) | Token::Bare | Token::Open(_) => {
                self.tell(range.clone(), || format!("a colon is missing between {} and this value", shown()));
                self.put_back(token, range);
                true
            }
            token => {
                self.put_back(token, range);
                false
            }
        };
        let (next, at) = self.peek(Due::Value);
        let at = at.start;
        let value = match next {
            Token::Text(_) | Token::Bare | Token::Open(_) => self.value(),
            Token::End => self.broken(at..at),
            _ => {
                let missing =
                    if has_colon { "write one after the colon" } else { "write a colon and a value after it" };
                self.tell(key_range.clone(), || format!("{} has no value: {missing}", shown()));
                // A second colon belongs to nothing.
                if matches!(self.peek(Due::Value).0, Token::Colon | Token::Equals) {
                    self.take(Due::Value);
                    if matches!(self.peek(Due::Value).0, Token::Text(_) | Token::Bare | Token::Open(_)) {
                        self.value();
                    }
                }
                self.broken(at..at)
            }
        };
        if key.is_none() {
            self.lose();
        }
        Some(Member { key: key?, key_span: self.span(key_range), value })
    }

    /// The key that stands without quotes; `None` if it is no key, and was passed over.
    fn bare_key(&mut self, range: &Range<usize>, comma_due: bool) -> Option<String> {
        let run = self.lexer.slice(range);
        let next = self.lexer.next_byte();
        let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        if !comma_due && is_digits(run) && next != Some(b':') {
            // Of `1,5`, the comma and the number before it were taken already.
            let before = self.lexer.number_before_comma(range.start);
            self.lose();
            match before {
                Some(start) => {
                    let number = self.lexer.slice(&(start..range.end)).replace(',', ".");
                    self.tell(start..range.end, || format!("a decimal number has a point: write {number}"));
                }
                None => self.tell(range.clone(), || format!("{run} has no key: write a key and a colon before it")),
            }
            return None;
        }
        let is_key =
            matches!(next, Some(b':' | b'=')) || (!comma_due && !matches!(next, None | Some(b',' | b'}' | b']')));
        if !is_key {
            self.tell(range.clone(), || {
                format!("{} has no meaning here: remove it, or write a key and a value", bare::short(run))
            });
            self.lose();
            self.skip_to_separator();
            return None;
        }
        if comma_due {
            self.tell(range.clone(), || "a comma is missing before this key");
        }
        self.tell(range.clone(), || format!("a key needs quotes: write {}", quote(run)));
        Some(run.to_owned())
    }

    /// Passes over what follows something meaningless, up to where an object can go on.
    fn skip_to_separator(&mut self) {
        loop {
            let (token, range) = self.take(Due::Key);
            let goes_on = match token {
                Token::Comma | Token::Semicolon | Token::Close(_) | Token::End => true,
                Token::Text(_) => self.lexer.next_byte() == Some(b':'),
                _ => false,
            };
            let is_open = matches!(token, Token::Open(_));
            if goes_on || is_open {
                self.put_back(token, range);
            }
            if goes_on {
                return;
            }
            if is_open {
                self.value();
            }
        }
    }

    /// A comma, or what stands in its place.
    fn separator(&mut self, token: &Token, range: Range<usize>, comma_due: bool, is_first: bool) {
        if *token == Token::Semicolon {
            self.tell(range, || "write , instead of ;");
            return;
        }
        if comma_due {
            return;
        }
        let place = if is_first { "before this comma" } else { "between these commas" };
        self.tell(range, || {
            format!(
                "there is nothing {place}: remove {}, or write what is missing",
                if is_first { "it" } else { "one" }
            )
        });
        while self.peek(Due::Value).0 == Token::Comma {
            self.take(Due::Value);
        }
    }

    /// The items of a list whose bracket is open.
    fn list(&mut self, start: usize) -> Node {
        let mut items: Vec<Node> = Vec::new();
        let mut comma_due = false;
        let mut has_keys = false;
        let end = loop {
            let (token, range) = self.take(Due::Value);
            comma_due = match token {
                Token::End => {
                    self.tell_unclosed();
                    break self.last.end;
                }
                Token::Close(bracket) => match self.close(bracket, &range) {
                    Closing::Here => break range.end,
                    Closing::Above => {
                        self.put_back(token, range.clone());
                        break range.start;
                    }
                    Closing::Extra => comma_due,
                },
                Token::Comma | Token::Semicolon => {
                    if !comma_due && token == Token::Comma {
                        items.push(self.broken(range.start..range.start));
                    }
                    self.separator(&token, range, comma_due, items.len() < 2);
                    false
                }
                Token::Colon | Token::Equals => {
                    let key = items.pop();
                    if let Some(Node { value: Tree::Text(key), span }) = &key
                        && self.lacks_square()
                    {
                        let key_range = span.start as usize..span.end as usize;
                        self.key_of_parent = Some((key.clone(), key_range.clone()));
                        self.tell_missing_close(&key_range, "key");
                        self.put_back(token, range);
                        break key_range.start;
                    }
                    if !std::mem::replace(&mut has_keys, true) {
                        self.tell(range, || "a list holds no keys: put its keys and values between { and }");
                    }
                    self.lose();
                    comma_due
                }
                Token::Text(_) | Token::Bare | Token::Open(_) => {
                    if comma_due && !has_keys && self.told_bracket != Some(range.start) {
                        self.tell(range.clone(), || "a comma is missing before this value");
                    }
                    self.put_back(token, range);
                    items.push(self.value());
                    true
                }
            };
        };
        if has_keys {
            return self.broken(start..end);
        }
        Node { value: Tree::List(items), span: self.span(&(start..end)) }
    }

    /// What a closing bracket means to the innermost bracket that is open.
    fn close(&mut self, bracket: Bracket, range: &Range<usize>) -> Closing {
        let Some(&(innermost, at)) = self.open.last() else {
            return Closing::Extra;
        };
        if innermost == bracket {
            self.open.pop();
            return Closing::Here;
        }
        let is_too_many = *self.balance(bracket) < 0;
        if is_too_many && *self.balance(innermost) > 0 {
            *self.balance(bracket) += 1;
            *self.balance(innermost) -= 1;
            let opener = self.lexer.slips.at(at);
            self.tell(range.clone(), || {
                format!(
                    "the {} at {opener} is closed by {}: write {} in its place",
                    innermost.open(),
                    bracket.close(),
                    innermost.close()
                )
            });
            self.open.pop();
            return Closing::Here;
        }
        if is_too_many || self.open.iter().all(|(open, _)| *open != bracket) {
            *self.balance(bracket) += 1;
            self.tell(range.clone(), || format!("this {} closes nothing: remove it", bracket.close()));
            return Closing::Extra;
        }
        self.tell_missing_close(range, if bracket == Bracket::Curly { "}" } else { "]" });
        Closing::Above
    }

    /// How many more of a bracket are opened than closed in the whole file.
    fn balance(&mut self, bracket: Bracket) -> &mut i64 {
        let lexer = &self.lexer;
        let balance = self.balance.get_or_insert_with(|| lexer.balance());
        &mut balance[usize::from(bracket == Bracket::Square)]
    }

    /// Whether the object being read is an item of a list, and lacks its closing bracket.
    fn lacks_brace(&mut self) -> bool {
        let is_item = matches!(self.open.as_slice(), [.., (Bracket::Square, _), (Bracket::Curly, _)]);
        is_item && *self.balance(Bracket::Curly) > 0
    }

    /// Whether the list being read is a value of an object, and lacks its closing bracket.
    fn lacks_square(&mut self) -> bool {
        let is_value = matches!(self.open.as_slice(), [.., (Bracket::Curly, _), (Bracket::Square, _)]);
        is_value && *self.balance(Bracket::Square) > 0
    }

    /// Ends the innermost list or object before a token that cannot be part of it.
    fn tell_missing_close(&mut self, range: &Range<usize>, next: &str) {
        let Some((innermost, at)) = self.open.pop() else {
            return;
        };
        *self.balance(innermost) -= 1;
        self.is_closed = false;
        self.lose();
        if self.told_bracket.replace(range.start) == Some(range.start) {
            return;
        }
        let opener = self.lexer.slips.at(at);
        self.tell(range.clone(), || {
            format!(
                "the {} at {opener} is not closed: write {} before this {next}",
                innermost.open(),
                innermost.close()
            )
        });
    }

    /// The file ends within a list or object.
    fn tell_unclosed(&mut self) {
        let Some((innermost, at)) = self.open.pop() else {
            return;
        };
        self.is_closed = false;
        self.lose();
        if self.lexer.is_cut || std::mem::replace(&mut self.is_end_told, true) {
            return;
        }
        let opener = self.lexer.slips.at(at);
        let end = self.last.end;
        self.tell(end.saturating_sub(1)..end, || {
            format!(
                "the file ends, but the {} at {opener} is not closed: write {} at its end",
                innermost.open(),
                innermost.close()
            )
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    fn parsed(text: &str) -> (Text, Mistakes) {
        let mut mistakes = Mistakes::default();
        let text = parse(&Source::new("s.json", text), 0, &mut mistakes);
        (text, mistakes)
    }

    fn tree(text: &str) -> Tree {
        let (text, mistakes) = parsed(text);
        assert!(mistakes.is_empty(), "{mistakes}");
        text.root.value
    }

    #[test]
    fn only_one_comma_may_trail() {
        let items = |text: &str| match tree(text) {
            Tree::List(items) => items.len(),
            other => panic!("{other:?} is no list"),
        };
        assert_eq!((items("[1,]"), items("[1 /**/ , // x\n ]")), (1, 1));
        for text in ["[,]", "[1,,]", "{,}", "{\"a\":,}", "[1],", ",", "[1,/**/,]", "{\"a\":1,,}"] {
            assert!(parsed(text).1.to_string().starts_with("s.json:1:"), "{text}");
        }
    }

    #[test]
    fn spans_cover_keys_and_values() {
        let text = "{ \"a\" : [10, \"\u{e9}\"] }";
        let Tree::Object(members) = tree(text) else { panic!("this is an object") };
        let of = |span: Span| &text[span.start as usize..span.end as usize];
        assert_eq!((of(members[0].key_span), of(members[0].value.span)), ("\"a\"", "[10, \"\u{e9}\"]"));
    }

    #[test]
    fn every_duplicate_is_found() {
        let (_, mistakes) = parsed("{\"a\":1,\n\"a\":{\"b\":1,\"b\":2,\"b\":3}}");
        assert_eq!(
            mistakes.to_string(),
            "s.json:2:1 (a): duplicate key \"a\": it is already at 1:2\n\
             s.json:2:12 (a.b): duplicate key \"b\": it is already at 2:6\n\
             s.json:2:18 (a.b): duplicate key \"b\": it is already at 2:6"
        );
    }

    #[test]
    fn spans_of_broken_values_cover_what_holds_them() {
        let (text, _) = parsed("{ \"a\": [1, x], \"b\": , \"c\": [2] }");
        let Tree::Object(members) = &text.root.value else { panic!("this is an object") };
        let held: Vec<bool> = members.iter().map(|member| text.holds_broken(member.value.span)).collect();
        assert_eq!(held, [true, true, false]);
        assert!(members.iter().all(|member| !text.holds_broken(member.key_span)));
    }

    /// What stands between `,` and a closing bracket may go; all else is what another parser must take as well.
    fn without_trailing_commas(text: &str) -> String {
        let mut kept: Vec<char> = Vec::new();
        let mut chars = text.chars();
        // The last two characters outside texts that are no blanks, each with its index.
        let mut last = [(' ', 0); 2];
        while let Some(c) = chars.next() {
            if matches!(c, ']' | '}') && last[1].0 == ',' && !matches!(last[0].0, ' ' | ',' | ':' | '[' | '{') {
                kept[last[1].1] = ' ';
            }
            if !matches!(c, ' ' | '\t' | '\n' | '\r') {
                last = [last[1], (c, kept.len())];
            }
            kept.push(c);
            let mut is_text = c == '"';
            while is_text {
                let Some(inner) = chars.next() else { break };
                kept.push(inner);
                if inner == '\\' {
                    kept.extend(chars.next());
                }
                is_text = inner != '"';
            }
        }
        kept.into_iter().collect()
    }

    /// Of a key that is there twice, the later value counts, as there.
    fn value_of(node: &Node) -> Value {
        match &node.value {
            Tree::Null | Tree::Broken => Value::Null,
            Tree::Bool(value) => Value::Bool(*value),
            Tree::Number(number) => Value::from(*number),
            Tree::Text(text) => Value::from(text.as_str()),
            Tree::List(items) => items.iter().map(value_of).collect(),
            Tree::Object(members) => {
                Value::Object(members.iter().map(|member| (member.key.clone(), value_of(&member.value))).collect())
            }
        }
    }

    /// Equal, but for the last digits of numbers, which the other parser rounds more quickly.
    fn are_equal(a: &Value, b: &Value) -> bool {
        match (a, b) {
            (Value::Number(a), Value::Number(b)) => {
                let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
                (a - b).abs() <= 1e-15 * a.abs().max(b.abs())
            }
            (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| are_equal(a, b)),
            (Value::Object(a), Value::Object(b)) => {
                a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| are_equal(a, b)))
            }
            (a, b) => a == b,
        }
    }

    #[test]
    fn another_parser_takes_the_same_texts() {
        const SEEDS: [&str; 4] = [
            "{\"a\": [1, -2.5e3, 0.25, {\"b\": null, \"c\": [true, false]}], \"d\\n\": \"\\u00e9\\ud83d\\ude00\", \"\": {}}",
            "[\"x\", \"\\\\ \\/ \\b\\f\\r\\t \\\" \", 1e-7, 120E+2, -0, 0.0, [[], [[]], {}], 123456789012345678901234567890]",
            "{\r\n\t\"camera\": {\"fov\": 35, \"bgcolor\": [255, 255, 255]},\r\n\t\"mapping\": {\"atom[element=O]\": \"a\"}\n}",
            " \"\u{e9}\u{1F600}\" ",
        ];
        const PIECES: [&str; 44] = [
            "{",
            "}",
            "[",
            "]",
            ",",
            ":",
            "\"",
            "\\",
            "null",
            "true",
            "1e999",
            "-1",
            "0.5",
            "1e308",
            "\u{e9}",
            "\r\n",
            " ",
            "\t",
            "\"a\"",
            "\\u0000",
            "\\ud83d",
            "\\ude00",
            "0",
            "00",
            "-",
            "+",
            ".",
            "e",
            "E5",
            "'",
            "=",
            ";",
            "#",
            "NaN",
            "\"a\":1,",
            "\u{feff}",
            "\u{a0}",
            "\u{1}",
            "\u{7f}",
            "\\n",
            "\\x",
            "[1,]",
            "{\"a\":1,}",
            ",,",
        ];
        let mut state = 0x9E37_79B9_7F4A_7C15_u64;
        let mut below = |end: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 33) as usize % end
        };
        let (mut taken, mut refused) = (0, 0);
        for i in 0..60_000 {
            let mut chars: Vec<char> = SEEDS[i % SEEDS.len()].chars().collect();
            for _ in 0..=below(3) {
                let at = below(chars.len() + 1);
                let end = (at + below(4)).min(chars.len());
                match below(4) {
                    0 => drop(chars.drain(at..end)),
                    1 => drop(chars.splice(at..end, PIECES[below(PIECES.len())].chars())),
                    2 => drop(chars.splice(at..at, PIECES[below(PIECES.len())].chars())),
                    _ => {
                        let from = below(chars.len() + 1);
                        let copy: Vec<char> = chars[from..(from + below(30)).min(chars.len())].to_vec();
                        chars.splice(at..at, copy);
                    }
                }
            }
            // A mark is ours to pass over, and so are comments.
            let text: String = chars.iter().collect();
            if text.starts_with('\u{feff}') || text.contains('/') && !text.contains("\\/") {
                continue;
            }
            let (ours, mistakes) = parsed(&text);
            let is_taken = mistakes.list.iter().all(|mistake| mistake.problem.code() == "duplicate_key");
            match serde_json::from_str::<Value>(&without_trailing_commas(&text)) {
                Ok(theirs) => {
                    assert!(is_taken, "{text:?} is JSON, but: {mistakes}");
                    assert!(ours.is_whole && are_equal(&value_of(&ours.root), &theirs), "{text:?}: {:?}", ours.root);
                    taken += 1;
                }
                Err(error) => {
                    assert!(!is_taken, "{text:?} is no JSON: {error}");
                    refused += 1;
                }
            }
        }
        assert!(taken > 5_000 && refused > 20_000, "{taken} taken, {refused} refused");
    }

    #[test]
    fn hostile_texts_take_little_time_and_few_words() {
        let flood = |piece: &str| piece.repeat((MAX_BYTES / piece.len()).min(2_000_000 / piece.len()));
        for piece in [
            "[",
            "]",
            "{",
            "}",
            "\"",
            "\\",
            ",",
            ":",
            "'",
            "#",
            "/",
            "[]",
            "[],",
            "{}",
            "\"\"",
            "\"a\"b",
            "\"a:\"",
            "\"\\",
            "a ",
            "a\"",
            "'a\"",
            "a(",
            "a[",
            "[}",
            "{]",
            "{\"a\":",
            "{\"a\":[",
            "\"a\":",
            "=",
            ";",
            "1,",
            "1 ",
            "\u{201c}",
            "\u{201c}\"",
            "\u{a0}",
            "\u{1}",
            "/*",
            "*/",
            "//",
            "\"//\"a",
            "\"/*\"a",
            "\"a,",
            "\"a}",
            "a:",
            "[\"a\":1,",
            "\n\"a",
            "\"a\n",
            "0x",
            "\"\\u",
            ",\"",
            ", \"a\"x",
            "\u{1F600}",
            "\u{202e}",
        ] {
            let text = flood(piece);
            let (_, mistakes) = parsed(&text);
            assert!(mistakes.list.len() <= 100, "{piece}");
            let (_, mistakes) = parsed(&format!("{{\"a\": \"{text}"));
            assert!(!mistakes.is_empty(), "{piece}");
        }
    }
}
