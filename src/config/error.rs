//! What can be wrong with a style file, and how it is said.
//!
//! Every mistake has a [`Place`] and is shown on one line as
//! `file:line:col (json.path): what is wrong; did you mean "…"? allowed: …`.
//! All mistakes of a file are collected in [`Mistakes`], in the order of the text. Warnings look the same.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use super::diagnostic::SourceTexts;
use super::hint::{Hint, OfScene, number, quote};

/// Most mistakes, and most warnings, that are listed; the rest is counted.
/// Ours: more than a screen holds, and a bound on the work that a hostile file causes.
pub const MOST_LISTED: usize = 100;

/// A place in a file: what a message points at.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The file, named as the user named it.
    pub file: Arc<str>,
    /// Line, from 1; 0 means the file as a whole.
    pub line: u32,
    /// Column in characters, from 1; 0 means the file as a whole.
    pub column: u32,
    /// First byte of the key or value, counted after a byte-order mark.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
    /// The JSON path, such as `shaders[1].properties.radius`; empty at the root.
    pub path: String,
}

impl Place {
    /// The file as a whole.
    pub fn of_file(file: &str) -> Self {
        Self { file: file.into(), line: 0, column: 0, start: 0, end: 0, path: String::new() }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if self.line > 0 {
            write!(f, ":{}:{}", self.line, self.column)?;
        }
        if self.path.is_empty() { Ok(()) } else { write!(f, " ({})", self.path) }
    }
}

/// Where a key belongs, or else what may stand in its place.
struct Whither<'a>(Option<&'a str>, &'a Hint);

impl fmt::Display for Whither<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(home) => write!(f, ": {home}"),
            None => self.1.fmt(f),
        }
    }
}

/// What is wrong, without the place.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Problem {
    /// The file cannot be read at all.
    #[error("{0}")]
    Unreadable(String),
    /// The text is not UTF-8.
    #[error("this is not UTF-8 text: save the file as UTF-8")]
    NotUtf8,
    /// The text is not JSON.
    #[error("{0}")]
    Syntax(String),
    /// The same key twice in one object.
    #[error("duplicate key {}: it is already at {line}:{column}; keep one of them", quote(.key))]
    DuplicateKey {
        /// The key.
        key: String,
        /// Line of the first one.
        line: u32,
        /// Column of the first one.
        column: u32,
    },
    /// A key that nothing knows.
    #[error("{owner} has no {}{}", quote(.key), Whither(.home.as_deref(), .hint))]
    UnknownKey {
        /// Whose key it would be, such as `camera` or `shader "toon"`.
        owner: Box<str>,
        /// The key as written.
        key: Box<str>,
        /// Where it belongs, such as `it belongs in "camera"`, if it belongs elsewhere.
        home: Option<Box<str>>,
        /// Nearest key and all keys.
        hint: Hint,
    },
    /// A key that must be there.
    #[error("{owner} needs {}: add it{hint}", quote(.key))]
    MissingKey {
        /// Who needs it.
        owner: String,
        /// The key.
        key: &'static str,
        /// What it may be.
        hint: Hint,
    },
    /// A value of another JSON type, or a list of another length.
    #[error("{} must be {expected}, not {found}{advice}", quote(.name))]
    WrongType {
        /// The key.
        name: String,
        /// What is expected, such as `a whole number`.
        expected: String,
        /// What is there, such as `the text "four"`.
        found: String,
        /// What to write, such as `: write 4`; empty where nobody can tell.
        advice: String,
    },
    /// A number outside what its parameter allows.
    #[error("{} is {}, but must {allowed}", quote(.name), number(*.value))]
    OutOfRange {
        /// The key.
        name: String,
        /// The value as read.
        value: f64,
        /// The range and its unit, such as `lie in 1 to 179 degrees`.
        allowed: String,
    },
    /// A text that is none of the choices.
    #[error("{} cannot be {}{hint}", quote(.name), quote(.value))]
    NotAChoice {
        /// The key.
        name: String,
        /// The text as written.
        value: String,
        /// Nearest choice and all choices.
        hint: Hint,
    },
    /// A name that is neither in `shaders` nor registered.
    #[error("no {what} is called {}{hint}", quote(.name))]
    UnknownName {
        /// `shader` or `post effect`.
        what: &'static str,
        /// The name as written.
        name: String,
        /// Nearest name and all names.
        hint: Hint,
    },
    /// A post effect where a shader of objects is due.
    #[error("{} is a post effect, not a shader of objects: list it in mapping.post_effects{hint}", quote(.name))]
    EffectAsShader {
        /// The name as written.
        name: String,
        /// The shaders that may stand here.
        hint: Hint,
    },
    /// A shader of objects where a post effect is due.
    #[error("{} is a shader of objects, not a post effect{hint}", quote(.name))]
    ShaderAsEffect {
        /// The name as written.
        name: String,
        /// The effects that may stand here.
        hint: Hint,
    },
    /// A shader entry with nothing to refer to it by.
    #[error("this shader entry has neither \"name\" nor \"shader\", so nothing can use it: name it or remove it")]
    NamelessShader,
    /// Two entries of `shaders` with one name.
    #[error("a shader called {} is already at {line}:{column}", quote(.name))]
    DuplicateName {
        /// The name.
        name: String,
        /// Line of the first one.
        line: u32,
        /// Column of the first one.
        column: u32,
    },
    /// A text that is no colour.
    #[error("{} is {found}, which is no colour: write [r, g, b] or [r, g, b, a] in 0 to 255, \"#rrggbb\" or a CSS name{hint}", quote(.name))]
    BadColor {
        /// The key.
        name: String,
        /// What is there.
        found: String,
        /// Nearest name.
        hint: Hint,
    },
    /// A text that is no length.
    #[error("{} is {}, which is no length: write a number (radii of the scene), \"2pt\", \"3r\", \"1.5A\" or \"2mm\"{hint}", quote(.name), quote(.value))]
    BadLength {
        /// The key.
        name: String,
        /// The text as written.
        value: String,
        /// The length that was meant.
        hint: Hint,
    },
    /// A text that is no selector.
    #[error("selector {}: {reason}{hint}", quote(.text))]
    BadSelector {
        /// The selector as written.
        text: String,
        /// What is wrong with it.
        reason: String,
        /// Nearest word and all words.
        hint: Hint,
    },
    /// A picture that cannot be used.
    #[error("{} cannot use {}: {reason}", quote(.name), quote(.picture))]
    Picture {
        /// The key.
        name: String,
        /// The path as written.
        picture: String,
        /// Why not.
        reason: String,
    },
    /// A base file that cannot be used.
    #[error("cannot extend {}: {reason}", quote(.base))]
    Extends {
        /// The base as written.
        base: String,
        /// Why not.
        reason: String,
    },
    /// Values that are fine one by one but have no meaning together.
    #[error("{0}")]
    Meaningless(&'static str),
}

impl Problem {
    /// The kind of mistake, as tools read it.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unreadable(_) => "unreadable",
            Self::NotUtf8 => "not_utf8",
            Self::Syntax(_) => "syntax",
            Self::DuplicateKey { .. } => "duplicate_key",
            Self::UnknownKey { .. } => "unknown_key",
            Self::MissingKey { .. } => "missing_key",
            Self::WrongType { .. } => "wrong_type",
            Self::OutOfRange { .. } => "out_of_range",
            Self::NotAChoice { .. } => "not_a_choice",
            Self::UnknownName { .. } => "unknown_name",
            Self::EffectAsShader { .. } => "effect_as_shader",
            Self::ShaderAsEffect { .. } => "shader_as_effect",
            Self::NamelessShader => "nameless_shader",
            Self::DuplicateName { .. } => "duplicate_name",
            Self::BadColor { .. } => "bad_color",
            Self::BadLength { .. } => "bad_length",
            Self::BadSelector { .. } => "bad_selector",
            Self::Picture { .. } => "picture",
            Self::Extends { .. } => "extends",
            Self::Meaningless(_) => "meaningless",
        }
    }

    /// The nearest word and the words that are allowed, if the problem is one of words.
    pub fn hint(&self) -> Option<&Hint> {
        match self {
            Self::UnknownKey { hint, .. }
            | Self::MissingKey { hint, .. }
            | Self::NotAChoice { hint, .. }
            | Self::UnknownName { hint, .. }
            | Self::EffectAsShader { hint, .. }
            | Self::ShaderAsEffect { hint, .. }
            | Self::BadColor { hint, .. }
            | Self::BadLength { hint, .. }
            | Self::BadSelector { hint, .. } => Some(hint),
            _ => None,
        }
    }
}

/// One mistake.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct Mistake {
    /// Where.
    pub place: Place,
    /// What.
    pub problem: Problem,
}

/// Everything that is wrong with a style; never empty when returned.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mistakes {
    /// The mistakes, file by file in the order of the text.
    pub list: Vec<Mistake>,
    /// How many more there are than the list holds.
    pub unlisted: usize,
    /// The files that were read, the style first, then its bases, one that is not there or cannot be read, and last the
    /// pictures, readable or not: what to watch for a correction.
    pub files: Vec<PathBuf>,
    /// What was noticed beside the mistakes.
    pub warnings: Vec<Warning>,
    /// How many more warnings there are than the list holds.
    pub unlisted_warnings: usize,
    /// The texts of the files, for the source lines under messages.
    pub texts: SourceTexts,
}

impl Mistakes {
    /// One mistake alone.
    pub fn one(place: Place, problem: Problem) -> Self {
        Self { list: vec![Mistake { place, problem }], ..Self::default() }
    }

    /// Whether nothing is wrong.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Whether further mistakes are only counted, so that nobody needs to look for their nearest names.
    pub(super) fn is_full(&self) -> bool {
        self.list.len() >= MOST_LISTED
    }

    /// Adds one; the place is asked for only if the mistake is listed.
    pub(super) fn push(&mut self, place: impl FnOnce() -> Place, problem: Problem) {
        if self.is_full() {
            self.unlisted += 1;
        } else {
            self.list.push(Mistake { place: place(), problem });
        }
    }
}

impl fmt::Display for Mistakes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, mistake) in self.list.iter().enumerate() {
            let line_break = if i == 0 { "" } else { "\n" };
            write!(f, "{line_break}{mistake}")?;
        }
        if self.unlisted > 0 {
            write!(f, "\nand {} more", self.unlisted)?;
        }
        Ok(())
    }
}

impl std::error::Error for Mistakes {}

/// What a style asks for and does not get, though it loads.
#[derive(Debug, Clone, PartialEq, Eq, Hash, thiserror::Error)]
pub enum Notice {
    /// A type of objects that this version does not draw.
    #[error("objects of type {} are not drawn by this version yet", quote(.name))]
    TypeNotDrawn {
        /// The type.
        name: &'static str,
    },
    /// A selector that matches nothing of the scene. Only who knows the scene can tell.
    #[error("selector {} matches nothing in this scene{}", quote(.selector), OfScene(.hint))]
    MatchesNothing {
        /// The selector as written.
        selector: String,
        /// The nearest names that the scene has.
        hint: Hint,
    },
    /// A colour in bytes with the numbers of one in shares.
    #[error("{} is nearly black: numbers of a colour go to 255; write {meant} if shares of 1 were meant", quote(.name))]
    NearlyBlack {
        /// The key.
        name: String,
        /// The colour that was meant, in bytes.
        meant: String,
    },
    /// A shader of the file that no rule names.
    #[error("shader {} draws nothing: name it in mapping, or remove it", quote(.name))]
    UnusedShader {
        /// The name of the entry.
        name: String,
    },
    /// A post effect of the file that is not listed.
    #[error("post effect {} does nothing: list it in mapping.post_effects, or remove it", quote(.name))]
    UnusedEffect {
        /// The name of the entry.
        name: String,
    },
    /// A selector that a later one always beats.
    #[error(
        "selector {} never decides: {} at {line}:{column} picks the same objects and comes later; remove one",
        quote(.selector),
        quote(.later)
    )]
    NeverDecides {
        /// The selector as written.
        selector: String,
        /// The one that always wins, as written.
        later: String,
        /// Line of that one.
        line: u32,
        /// Column of that one.
        column: u32,
    },
    /// A post effect that is listed after one of a later stage.
    #[error(
        "post effect {} is listed after {}, but always comes before it: list it first, as order counts within a stage only",
        quote(.name),
        quote(.after)
    )]
    StageOrder {
        /// The effect.
        name: String,
        /// The effect of a later stage that is listed before it.
        after: String,
    },
    /// An outline that is wider than what it outlines.
    #[error(
        "the outline is {width} wide, but {outlined} has a radius of {radius}: make it narrower, or give it in points, \
         such as \"2pt\""
    )]
    WideOutline {
        /// Its width with the unit.
        width: String,
        /// What it surrounds, such as `the smallest atom inside`.
        outlined: &'static str,
        /// The radius of that, with the unit.
        radius: String,
    },
}

impl Notice {
    /// The kind of warning, as tools read it.
    pub fn code(&self) -> &'static str {
        match self {
            Self::TypeNotDrawn { .. } => "type_not_drawn",
            Self::MatchesNothing { .. } => "matches_nothing",
            Self::NearlyBlack { .. } => "nearly_black",
            Self::UnusedShader { .. } => "unused_shader",
            Self::UnusedEffect { .. } => "unused_effect",
            Self::NeverDecides { .. } => "never_decides",
            Self::StageOrder { .. } => "stage_order",
            Self::WideOutline { .. } => "wide_outline",
        }
    }

    /// The nearest word and the words that are allowed, if there are any.
    pub fn hint(&self) -> Option<&Hint> {
        match self {
            Self::MatchesNothing { hint, .. } => Some(hint),
            _ => None,
        }
    }
}

/// One warning.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: warning: {notice}")]
pub struct Warning {
    /// Where.
    pub place: Place,
    /// What.
    pub notice: Notice,
}
