//! JSON text to a tree in which every key and value knows its place.
//!
//! Comments and trailing commas are accepted, nothing else beyond strict JSON. Three steps: `blank` replaces comments
//! and trailing commas by spaces, so that no offset moves; `serde_json` then decides whether the rest is JSON;
//! `jsonc_parser`, which is laxer but keeps byte ranges and duplicate keys, gives the tree.

use jsonc_parser::ast;
use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};

use super::blank::{Blanked, blank};
use super::error::{Mistakes, Place, Problem};
use super::source::{Positions, Source, Text};

/// Largest style that is read, in bytes.
pub const MAX_BYTES: usize = 16 * 1024 * 1024;

/// Deepest nesting. Ours: a style needs five levels.
pub const MAX_DEPTH: usize = 64;

/// A range of bytes in one of the texts of a style.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    /// Which text, as an index into the style's texts.
    pub(super) file: u32,
    pub(super) start: u32,
    pub(super) end: u32,
}

/// A value with its place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    pub(super) value: Tree,
    pub(super) span: Span,
}

/// A JSON value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Tree {
    Null,
    Bool(bool),
    Number(f64),
    Text(String),
    List(Vec<Node>),
    Object(Vec<Member>),
}

/// One `"key": value` of an object.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Member {
    pub(super) key: String,
    pub(super) key_span: Span,
    pub(super) value: Node,
}

impl Node {
    /// The value of a key, if this is an object that has it.
    pub(super) fn get(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Tree::Object(members) => members.iter().find(|member| member.key == key).map(|member| &member.value),
            _ => None,
        }
    }

    /// The text, if this is one.
    pub(super) fn text(&self) -> Option<&str> {
        match &self.value {
            Tree::Text(text) => Some(text),
            _ => None,
        }
    }

    /// What this is, as a message says it.
    pub(super) fn describe(&self) -> String {
        match &self.value {
            Tree::Null => "null".to_owned(),
            Tree::Bool(value) => value.to_string(),
            Tree::Number(value) => format!("the number {}", super::hint::number(*value)),
            Tree::Text(text) => format!("the text {}", super::hint::quote(text)),
            Tree::List(items) if items.is_empty() => "an empty list".to_owned(),
            Tree::List(items) if items.len() == 1 => "a list of 1 value".to_owned(),
            Tree::List(items) => format!("a list of {} values", items.len()),
            Tree::Object(_) => "an object".to_owned(),
        }
    }
}

/// Parses a source as text number `file` of its style. Duplicate keys are pushed onto `mistakes` once the whole is JSON.
pub(super) fn parse(source: &Source, file: u32, mistakes: &mut Mistakes) -> Result<Text, Box<(Place, Problem)>> {
    let bytes = source.text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&source.text);
    let whole = |problem| Box::new((Place::of_file(&source.name), problem));
    if bytes.len() > MAX_BYTES {
        let limit = format!("a style is at most {} MB, and this file is larger", MAX_BYTES / (1024 * 1024));
        return Err(whole(Problem::Unreadable(limit)));
    }
    let positions = Positions::new(bytes);
    let at = |offset: usize, problem| {
        let (line, column) = positions.line_column(bytes, offset);
        let place = Place { line, column, start: offset, end: offset, ..Place::of_file(&source.name) };
        Box::new((place, problem))
    };
    let text = str::from_utf8(bytes).map_err(|error| at(error.valid_up_to(), Problem::NotUtf8))?;
    if text.trim_ascii().is_empty() {
        return Err(whole(Problem::Syntax("the file is empty: the smallest style is {}".to_owned())));
    }
    let syntax = |(offset, message): (usize, String)| at(offset, Problem::Syntax(message));
    let blanked = blank(text).map_err(syntax)?;
    check_strictly(&blanked, &positions).map_err(syntax)?;
    let root = read_tree(&blanked.text, file).map_err(syntax)?;
    let text = Text { name: source.name.as_str().into(), text: text.to_owned(), positions, root };
    find_duplicates(&text.root, &text, mistakes);
    Ok(text)
}

/// Whether `serde_json` takes the text; its message in plainer words otherwise.
fn check_strictly(blanked: &Blanked, positions: &Positions) -> Result<(), (usize, String)> {
    let Err(error) = serde_json::from_str::<serde_json::Value>(&blanked.text) else {
        return Ok(());
    };
    // Column 0 is the line break before the line.
    let mut offset = (positions.line_start(error.line()) + error.column()).saturating_sub(1);
    offset = offset.min(blanked.text.len());
    while !blanked.text.is_char_boundary(offset) {
        offset -= 1;
    }
    let full = error.to_string();
    let message = full.rsplit_once(" at line ").map_or(full.as_str(), |(message, _)| message);
    let message = match (message, blanked.unclosed) {
        (m, Some((bracket, at))) if m.starts_with("EOF while parsing") && !m.ends_with("a string") => {
            let (line, column) = positions.line_column(blanked.text.as_bytes(), at);
            format!("the file ends, but the {} at {line}:{column} is not closed", char::from(bracket))
        }
        ("EOF while parsing a string", _) => "the file ends inside a text: a closing \" is missing".to_owned(),
        ("EOF while parsing a value", _) => "the file has no value, only comments".to_owned(),
        ("trailing characters", _) => "there is more text after the end of the style".to_owned(),
        (message, _) => plainer(message),
    };
    Err((offset, message))
}

/// A message of `serde_json` for people who write styles; any that is not listed stays as it is.
fn plainer(message: &str) -> String {
    let plain = match message {
        "key must be a string" => "a key in quotes is due here",
        "expected value" => "a value is due here (a text needs quotes)",
        "expected ident" => "only true, false and null stand without quotes",
        "expected `:`" => "a colon is due here",
        "expected `,` or `}`" => "a comma or } is due here",
        "expected `,` or `]`" => "a comma or ] is due here",
        "number out of range" => "this number is too large",
        "invalid number" => "numbers are written like 12, -0.5 or 1e-3",
        "invalid escape" => "there is no such \\ escape (a backslash itself is written \\\\)",
        "unexpected end of hex escape" | "lone leading surrogate in hex escape" | "invalid unicode code point" => {
            "this \\u escape is no character"
        }
        message if message.starts_with("control character") => {
            "a text cannot hold a line break or control character: close it with \" on its line"
        }
        other => other,
    };
    plain.to_owned()
}

/// The tree of a text that is known to be JSON.
fn read_tree(text: &str, file: u32) -> Result<Node, (usize, String)> {
    let options = ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    let parsed = parse_to_ast(text, &CollectOptions::default(), &options)
        .map_err(|error| (error.range().start, error.kind().to_string()))?;
    parsed.value.map(|value| node(value, file)).ok_or((0, "the file has no value".to_owned()))
}

fn node(value: ast::Value<'_>, file: u32) -> Node {
    use jsonc_parser::common::Ranged;
    let span = span(value.range(), file);
    let value = match value {
        ast::Value::NullKeyword(_) => Tree::Null,
        ast::Value::BooleanLit(literal) => Tree::Bool(literal.value),
        // The strict check refused every number that f64 cannot hold; NaN would be refused by each range.
        ast::Value::NumberLit(literal) => Tree::Number(literal.value.parse().unwrap_or(f64::NAN)),
        ast::Value::StringLit(literal) => Tree::Text(literal.value.into_owned()),
        ast::Value::Array(list) => Tree::List(list.elements.into_iter().map(|item| node(item, file)).collect()),
        ast::Value::Object(object) => Tree::Object(object.properties.into_iter().map(|p| member(p, file)).collect()),
    };
    Node { value, span }
}

fn member(property: ast::ObjectProp<'_>, file: u32) -> Member {
    use jsonc_parser::common::Ranged;
    Member {
        key_span: span(property.name.range(), file),
        key: property.name.into_string(),
        value: node(property.value, file),
    }
}

/// Texts are at most [`MAX_BYTES`] long, so that offsets fit.
fn span(range: jsonc_parser::common::Range, file: u32) -> Span {
    Span { file, start: range.start as u32, end: range.end as u32 }
}

fn find_duplicates(node: &Node, text: &Text, mistakes: &mut Mistakes) {
    match &node.value {
        Tree::Object(members) => {
            let mut first = std::collections::HashMap::with_capacity(members.len());
            for member in members {
                let earlier = first.entry(member.key.as_str()).or_insert(member.key_span);
                if *earlier != member.key_span {
                    let (line, column) = text.positions.line_column(text.text.as_bytes(), earlier.start as usize);
                    let problem = Problem::DuplicateKey { key: member.key.clone(), line, column };
                    mistakes.push(|| text.place(member.key_span), problem);
                }
                find_duplicates(&member.value, text, mistakes);
            }
        }
        Tree::List(items) => items.iter().for_each(|item| find_duplicates(item, text, mistakes)),
        Tree::Null | Tree::Bool(_) | Tree::Number(_) | Tree::Text(_) => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(text: &str) -> Tree {
        let mut mistakes = Mistakes::default();
        let parsed = parse(&Source::new("s.json", text), 0, &mut mistakes);
        parsed.unwrap_or_else(|wrong| panic!("{}", wrong.1)).root.value
    }

    fn message(text: &str) -> String {
        match parse(&Source::new("s.json", text), 0, &mut Mistakes::default()) {
            Ok(_) => panic!("{text} is no style, but was read"),
            Err(wrong) => format!("{}: {}", wrong.0, wrong.1),
        }
    }

    #[test]
    fn only_one_comma_may_trail() {
        assert_eq!(tree("[1,]"), tree("[1]"));
        for text in ["[,]", "[1,,]", "{,}", "{\"a\":,}", "[1],", ",", "[1,/**/,]"] {
            assert!(message(text).starts_with("s.json:1:"), "{text}");
        }
    }

    #[test]
    fn what_lax_parsers_take_is_refused() {
        for text in [
            "[.5]",
            "[1.]",
            "[01]",
            "[+1]",
            "[0x10]",
            "[1e999]",
            "[NaN]",
            "['a']",
            "{a:1}",
            "[\"\\q\"]",
            "[\"a\nb\"]",
            "[1 2]",
            "[\"\\ud800\"]",
            "[\"\t\"]",
            "\u{a0}[]",
            "[/]",
            "# no\n[]",
            "[1] /*",
            "\"a",
            "[tru]",
        ] {
            message(text);
        }
    }

    #[test]
    fn values_and_escapes_are_read() {
        let Tree::List(items) = tree("[\"\\u00e9\\n\\ud83d\\ude00\", -0.5e1, true, null, \"\"]") else {
            panic!("this is a list")
        };
        let values: Vec<Tree> = items.into_iter().map(|item| item.value).collect();
        let text = |text: &str| Tree::Text(text.to_owned());
        assert_eq!(values, [text("\u{e9}\n\u{1F600}"), Tree::Number(-5.0), Tree::Bool(true), Tree::Null, text("")]);
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
        let mut mistakes = Mistakes::default();
        let text = "{\"a\":1,\n\"a\":{\"b\":1,\"b\":2,\"b\":3}}";
        parse(&Source::new("s.json", text), 0, &mut mistakes).unwrap();
        assert_eq!(
            mistakes.to_string(),
            "s.json:2:1 (a): duplicate key \"a\": it is already at 1:2\n\
             s.json:2:12 (a.b): duplicate key \"b\": it is already at 2:6\n\
             s.json:2:18 (a.b): duplicate key \"b\": it is already at 2:6"
        );
    }
}
