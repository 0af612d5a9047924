//! The tree of a style, in which every key and value knows its place.
//!
//! The texts are strict JSON, but for comments, one trailing comma in a list or object, and a byte-order mark.

use super::error::{Mistakes, Problem};
use super::source::Text;

/// Largest style that is read, in bytes.
pub const MAX_BYTES: usize = 16 * 1024 * 1024;

/// Deepest nesting. Ours: a style needs five levels.
pub const MAX_DEPTH: usize = 64;

/// Most values of a style, lists and objects among them. Ours: 16 MB of `[[],[],` would need half a gigabyte of tree.
pub const MAX_VALUES: usize = 1_000_000;

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
    /// What stands here cannot be read, and that was said.
    Broken,
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
            Tree::Broken => "what cannot be read".to_owned(),
        }
    }
}

/// Pushes each key that its object has already.
pub(super) fn find_duplicates(node: &Node, text: &Text, mistakes: &mut Mistakes) {
    match &node.value {
        Tree::Object(members) => {
            let mut first = std::collections::HashMap::with_capacity(members.len());
            for member in members {
                let earlier = first.entry(member.key.as_str()).or_insert(member.key_span);
                if *earlier != member.key_span {
                    if mistakes.is_full() {
                        mistakes.unlisted += 1;
                        continue;
                    }
                    let (line, column) = text.line_column(*earlier);
                    let problem = Problem::DuplicateKey { key: member.key.clone(), line, column };
                    mistakes.push(|| text.place(member.key_span), problem);
                }
                find_duplicates(&member.value, text, mistakes);
            }
        }
        Tree::List(items) => items.iter().for_each(|item| find_duplicates(item, text, mistakes)),
        Tree::Null | Tree::Bool(_) | Tree::Number(_) | Tree::Text(_) | Tree::Broken => {}
    }
}
