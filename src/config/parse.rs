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

/// How many bytes are looked at for a sign that the file is no text.
const MOST_LOOKED_AT: usize = 4096;

/// Parses a source as text number `file` of its style. What is wrong is pushed onto `mistakes`; a text in which nothing
/// can be read has a root that is [`Tree::Broken`].
pub(super) fn parse(source: &Source, file: u32, mistakes: &mut Mistakes) -> Text {
    let bytes = source.text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&source.text);
    let root = Node { value: Tree::Broken, span: Span { file, start: 0, end: 0 } };
    let mut text = Text {
        name: source.name.as_str().into(),
        path: source.path.clone(),
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
    // What has both is no text at all, such as a picture.
    let is_binary = first_bad.is_some() && bytes.iter().take(MOST_LOOKED_AT).any(|byte| *byte == 0);
    let is_wide = is_wide || is_binary;
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
        if self.open.len() >= MAX_DEPTH {
            return self.skip_depth(range);
        }
        self.open.push((bracket, range.start));
        match bracket {
            Bracket::Curly => self.object(range.start, Vec::new()),
            Bracket::Square => self.list(range.start, Vec::new()),
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
        let (end, is_closed) = loop {
            if let Some((key, range)) = self.key_of_parent.take() {
                members.extend(self.member(Some(key), &range));
                comma_due = true;
                continue;
            }
            let (token, range) = self.take(Due::Key);
            if self.is_in_lost_list(&token, comma_due, &members) {
                self.put_back(token, range);
                if let Some(last) = members.pop() {
                    let start = last.value.span.start as usize;
                    self.tell_missing_open(Bracket::Square, start, "value");
                    let value = self.list(start, vec![last.value]);
                    members.push(Member { value, ..last });
                }
                comma_due = true;
                continue;
            }
            if self.begins_outer_member(&token, comma_due) {
                let next = if token == Token::Comma { "comma" } else { "key" };
                self.tell_missing_close(&range, next);
                self.put_back(token, range.clone());
                break (range.start, false);
            }
            comma_due = match token {
                Token::End | Token::Close(_) => match self.end_of_container(token, &range) {
                    Some(end) => break end,
                    None => comma_due,
                },
                Token::Comma | Token::Semicolon => {
                    self.separator(&token, range, comma_due, is_first);
                    false
                }
                Token::Text(key) => {
                    if comma_due && self.told_bracket != Some(range.start) {
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
                        break (range.start, false);
                    }
                    if bracket == Bracket::Curly && is_first && *self.balance(bracket) > 0 {
                        *self.balance(bracket) -= 1;
                        self.tell(range, || "this { is one too many: remove it");
                        continue;
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
        self.container_node(Tree::Object(members), start..end, is_closed)
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
        while matches!(self.peek(Due::Value).0, Token::Colon | Token::Equals) {
            let (_, range) = self.take(Due::Value);
            self.tell(range, || "this is one colon too many: remove it");
        }
        let value = match self.member_value() {
            Some(value) => value,
            None => {
                let missing =
                    if has_colon { "write one after the colon" } else { "write a colon and a value after it" };
                self.tell(key_range.clone(), || format!("{} has no value: {missing}", shown()));
                let at = self.peek(Due::Value).1.start;
                self.broken(at..at)
            }
        };
        if key.is_none() {
            self.lose();
        }
        Some(Member { key: key?, key_span: self.span(key_range), value })
    }

    /// What follows a key and its colon; `None` if that is nothing.
    fn member_value(&mut self) -> Option<Node> {
        let (token, range) = self.take(Due::Value);
        let at = range.start;
        match token {
            Token::Text(Some(_)) if self.lexer.next_byte() == Some(b':') && self.lacks_open(Bracket::Curly) => {
                self.put_back(token, range);
                self.tell_missing_open(Bracket::Curly, at, "key");
                Some(self.object(at, Vec::new()))
            }
            Token::Text(_) | Token::Bare | Token::Open(_) => {
                self.put_back(token, range);
                Some(self.value())
            }
            Token::Close(bracket) if self.lacks_open(bracket) => {
                self.tell_missing_open(bracket, at, if bracket == Bracket::Curly { "}" } else { "]" });
                self.open.pop();
                Some(self.broken(range))
            }
            // That the file ends within an object is said there.
            Token::End => Some(self.broken(range)),
            _ => {
                self.put_back(token, range);
                None
            }
        }
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
                    self.broken(start..range.end);
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

    /// Where the list or object ends that is being read, and whether it is closed, at a closing bracket or the end of the
    /// text; none where the bracket is one too many.
    fn end_of_container(&mut self, token: Token, range: &Range<usize>) -> Option<(usize, bool)> {
        let Token::Close(bracket) = token else {
            self.tell_unclosed();
            return Some((self.last.end, false));
        };
        match self.close(bracket, range) {
            Closing::Here => Some((range.end, true)),
            Closing::Above => {
                self.put_back(token, range.clone());
                Some((range.start, false))
            }
            Closing::Extra => None,
        }
    }

    /// The items of a list whose bracket is open, after those that are there already.
    fn list(&mut self, start: usize, mut items: Vec<Node>) -> Node {
        let mut comma_due = false;
        let mut has_keys = false;
        let (end, is_closed) = loop {
            let (token, range) = self.take(Due::Value);
            comma_due = match token {
                Token::End | Token::Close(_) => match self.end_of_container(token, &range) {
                    Some(end) => break end,
                    None => comma_due,
                },
                Token::Comma if !comma_due && self.lacks_close() => {
                    self.tell_missing_close(&range, "comma");
                    self.put_back(token, range.clone());
                    break (range.start, false);
                }
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
                        break (key_range.start, false);
                    }
                    if let Some(Node { value: Tree::Text(key), span }) = &key
                        && self.lacks_open(Bracket::Curly)
                    {
                        let key_range = span.start as usize..span.end as usize;
                        self.tell_missing_open(Bracket::Curly, key_range.start, "key");
                        self.key_of_parent = Some((key.clone(), key_range.clone()));
                        self.put_back(token, range);
                        items.push(self.object(key_range.start, Vec::new()));
                        comma_due = true;
                        continue;
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
        // Of two brackets of which one is never closed, one is too many.
        if !is_closed && items.len() == 1 && matches!(items[0].value, Tree::List(_)) {
            return items.swap_remove(0);
        }
        self.container_node(Tree::List(items), start..end, is_closed)
    }

    /// A list or object. One that lacks its bracket may hold what belongs further out, and is not complained about
    /// itself; what it holds is.
    fn container_node(&mut self, value: Tree, range: Range<usize>, is_closed: bool) -> Node {
        let span = self.span(&range);
        if !is_closed {
            self.broken.push((span.start, span.end));
        }
        Node { value, span }
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

    /// Whether a list or object may begin here without its bracket.
    fn lacks_open(&mut self, bracket: Bracket) -> bool {
        self.open.len() < MAX_DEPTH && *self.balance(bracket) < 0
    }

    /// Whether the innermost list or object is not the style itself, and may end here without its bracket.
    fn lacks_close(&mut self) -> bool {
        match self.open.as_slice() {
            &[_, .., (innermost, _)] => *self.balance(innermost) > 0,
            _ => false,
        }
    }

    /// Begins a list or object whose bracket is missing at an offset, before `next`.
    fn tell_missing_open(&mut self, bracket: Bracket, at: usize, next: &str) {
        *self.balance(bracket) += 1;
        self.tell(at..at + 1, || format!("a {} is missing before this {next}", bracket.open()));
        self.open.push((bracket, at));
    }

    /// Whether a token in place of a key shows that the last value begins a list that lacks its bracket: it is a further
    /// item, or the list's end.
    fn is_in_lost_list(&mut self, token: &Token, comma_due: bool, members: &[Member]) -> bool {
        let Some(last) = members.last().filter(|last| last.value.value != Tree::Broken) else {
            return false;
        };
        let shows_list = match token {
            Token::Text(_) | Token::Bare => !comma_due && self.lexer.next_byte() != Some(b':'),
            Token::Open(_) => !comma_due,
            Token::Close(Bracket::Square) => matches!(last.value.value, Tree::Text(_) | Tree::Object(_)),
            _ => false,
        };
        shows_list && self.lacks_open(Bracket::Square)
    }

    /// Whether a token in place of a key belongs to an object further out, since this one lacks its bracket: a key that
    /// only a style itself has, or a comma after nothing.
    fn begins_outer_member(&mut self, token: &Token, comma_due: bool) -> bool {
        let is_outer = match token {
            Token::Text(Some(key)) => {
                super::style::KEYS.contains(&key.as_str()) && self.lexer.next_byte() == Some(b':')
            }
            Token::Comma => !comma_due,
            _ => false,
        };
        is_outer && self.lacks_close()
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
mod tests;
