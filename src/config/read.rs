//! Reading parsed values as a parameter table asks, and collecting what is wrong with them.

use std::collections::HashSet;

use super::catalog::{Catalog, CatalogEntry};
use super::color::{BaseColor, Srgba, css_names};
use super::elsewhere::{begins_selector, home, is_same_word};
use super::error::{MOST_LISTED, Mistakes, Notice, Place, Problem, Warning};
use super::hint::{Hint, quote};
use super::length::Length;
use super::param::{Kind, LARGEST, Param, Value};
use super::parse::parse;
use super::pictures::Pictures;
use super::selector::Selector;
use super::source::{Source, Texts};
use super::syntax::{Member, Node, Span, Tree};
use super::transfer::{MAX_POINTS, Nodes, Transfer, TransferKind, Written, points};
use super::values::Values;

/// A problem and the value it lies in.
pub(super) type Wrong = (Span, Problem);

/// Reads a picture that is named by its path, or says why that is not possible.
type ReadPicture<'a> = dyn FnMut(TransferKind, &str) -> Result<Nodes, String> + 'a;

/// What goes through a style: its texts, and what was found so far.
pub(super) struct Reader<'a> {
    pub(super) texts: &'a Texts,
    catalog: Catalog<'a>,
    pub(super) mistakes: Mistakes,
    pub(super) warnings: Vec<Warning>,
    /// How many more warnings there are.
    pub(super) unlisted_warnings: usize,
    pub(super) pictures: Pictures,
    told: HashSet<Notice>,
}

impl<'a> Reader<'a> {
    /// A reader of these texts, with the mistakes that parsing them found.
    pub(super) fn new(texts: &'a Texts, catalog: Catalog<'a>, mistakes: Mistakes) -> Self {
        let (warnings, pictures, told) = (Vec::new(), Pictures::default(), HashSet::new());
        Self { texts, catalog, mistakes, warnings, unlisted_warnings: 0, pictures, told }
    }

    /// Notes a mistake, unless it is one of a value that cannot be read, which was said.
    pub(super) fn wrong(&mut self, span: Span, problem: Problem) {
        let texts = self.texts;
        if texts.holds_broken(span) {
            return;
        }
        self.mistakes.push(|| texts.place(span), problem);
    }

    /// Notes that something is missing, unless it may stand in a part of the style that cannot be read.
    pub(super) fn missing(&mut self, span: Span, problem: Problem) {
        if self.texts.are_whole() {
            self.wrong(span, problem);
        }
    }

    /// Notes a warning, once for each text of it.
    pub(super) fn warn(&mut self, place: Place, notice: Notice) {
        if !self.told.insert(notice.clone()) {
            return;
        }
        if self.warnings.len() < MOST_LISTED {
            self.warnings.push(Warning { place, notice });
        } else {
            self.unlisted_warnings += 1;
        }
    }

    /// The members of an object; anything else is a mistake and counts as an empty object.
    pub(super) fn object<'n>(&mut self, name: &str, node: &'n Node) -> &'n [Member] {
        match &node.value {
            Tree::Object(members) => members,
            _ => {
                self.wrong(node.span, wrong_type(name, "an object", node));
                &[]
            }
        }
    }

    /// The items of a list; anything else is a mistake and counts as an empty list.
    pub(super) fn list<'n>(&mut self, name: &str, node: &'n Node) -> &'n [Node] {
        match &node.value {
            Tree::List(items) => items,
            _ => {
                let in_brackets = matches!(node.value, Tree::Object(_) | Tree::Text(_));
                let write = in_brackets.then(|| "[ before it and ] after it".to_owned());
                self.wrong(node.span, wrong_type_but(name, "a list", node, write));
                &[]
            }
        }
    }

    /// A text; anything else is a mistake.
    pub(super) fn text<'n>(&mut self, name: &str, node: &'n Node) -> Option<&'n str> {
        let text = node.text();
        if text.is_none() {
            self.wrong(node.span, wrong_type(name, "a text", node));
        }
        text
    }

    /// The values of a table: what the members give, and defaults for the rest. Unknown keys are mistakes, said of
    /// `owner`, such as `camera`.
    pub(super) fn table(&mut self, owner: &str, members: &[Member], params: &'static [Param]) -> Values {
        let mut values = Values::defaults(params);
        for member in members {
            let Some(index) = params.iter().position(|param| param.name == member.key) else {
                self.unknown_key(owner, member, params.iter().map(|param| param.name), None);
                continue;
            };
            self.set(&mut values, index, &member.value);
        }
        values
    }

    /// Reads one parameter of a table.
    pub(super) fn set(&mut self, values: &mut Values, index: usize, node: &Node) {
        let param = &values.params()[index];
        let style = self.texts.0[node.span.file as usize].path.as_deref();
        let pictures = &mut self.pictures;
        let mut picture = |kind, name: &str| pictures.read(kind, name, style);
        match read(param, node, !self.mistakes.is_full(), &mut picture) {
            Ok(value) => {
                if let Some(meant) = color_of_shares(&value, node) {
                    self.warn(self.texts.place(node.span), Notice::NearlyBlack { name: param.name.to_owned(), meant });
                }
                if let Value::Selector(selector) = &value {
                    self.warn_of_undrawn_type(selector, &self.texts.place(node.span));
                }
                values.set(index, value, self.texts.place(node.span));
            }
            Err((span, problem)) => self.wrong(span, problem),
        }
    }

    /// Notes that a selector is for a type that this version does not draw, if it is.
    pub(super) fn warn_of_undrawn_type(&mut self, selector: &Selector, place: &Place) {
        if let Some(kind) = selector.kind().filter(|kind| !self.catalog.kinds.contains(kind)) {
            self.warn(place.clone(), Notice::TypeNotDrawn { name: kind.name() });
        }
    }

    /// Notes a key that nothing knows where it stands; `allowed` are the keys that may stand there. `entry` is the shader of
    /// the entry that it stands in, if it stands in one.
    pub(super) fn unknown_key(
        &mut self,
        owner: &str,
        member: &Member,
        allowed: impl IntoIterator<Item = &'static str> + Clone,
        entry: Option<&CatalogEntry>,
    ) {
        // Where a bracket is missing, a key may only have come into the wrong object.
        let is_of_style = super::style::KEYS.contains(&member.key.as_str());
        if is_of_style && !self.texts.0[member.key_span.file as usize].is_closed {
            return;
        }
        let key = member.key.clone();
        let is_slip = || allowed.clone().into_iter().any(|name| is_same_word(&key, name));
        let home = if self.mistakes.is_full() || is_slip() { None } else { home(&key, &self.catalog, entry) };
        let mut hint = self.hint(|| Hint::new(&key, allowed.clone()));
        if home.is_some() {
            hint.nearest = None;
        }
        let (owner, key, home) = (owner.into(), key.into(), home.map(String::into_boxed_str));
        self.wrong(member.key_span, Problem::UnknownKey { owner, key, home, hint });
    }

    /// Whether a key of `mapping` that is no selector is known elsewhere.
    pub(super) fn is_stray(&self, key: &str) -> bool {
        !self.mistakes.is_full() && !begins_selector(key) && home(key, &self.catalog, None).is_some()
    }

    /// A hint, unless the mistake will only be counted.
    pub(super) fn hint(&self, hint: impl FnOnce() -> Hint) -> Hint {
        if self.mistakes.is_full() { Hint::NONE } else { hint() }
    }
}

/// The same with what to write instead.
pub(super) fn wrong_type_but(name: &str, expected: &str, node: &Node, write: Option<String>) -> Problem {
    let (expected, found) = (expected.to_owned(), node.describe());
    let advice = write.map(|write| format!(": write {write}")).unwrap_or_default();
    Problem::WrongType { name: name.to_owned(), expected, found, advice }
}

/// A value of another type than is due.
pub(super) fn wrong_type(name: &str, expected: &str, node: &Node) -> Problem {
    let (expected, found) = (expected.to_owned(), node.describe());
    Problem::WrongType { name: name.to_owned(), expected, found, advice: String::new() }
}

/// Reads one value as its parameter asks. With hints, the names of colours are searched for one that is near.
fn read(param: &Param, node: &Node, with_hints: bool, picture: &mut ReadPicture<'_>) -> Result<Value, Wrong> {
    if node.value == Tree::Null && param.default == super::param::Default::Unset {
        return Ok(Value::Unset);
    }
    match param.kind {
        Kind::Number => number(param, node, "a number").map(Value::Number),
        Kind::Count => count(param, node).map(Value::Count),
        Kind::Length => length(param, node).map(Value::Length),
        Kind::ChoiceOrLength(of) => choice_or_length(param, of, node),
        Kind::Place(of) => place(param, of, node),
        Kind::Selector => selector(param, node).map(Value::Selector),
        Kind::Color => color(param, &[], node, with_hints).map(Value::Color),
        Kind::BaseColor => match node.text().and_then(BaseColor::from_name) {
            Some(source) => Ok(Value::BaseColor(source)),
            None => {
                color(param, &BaseColor::NAMES, node, with_hints).map(|color| Value::BaseColor(BaseColor::Color(color)))
            }
        },
        Kind::Choice(of) => choice(param, of, node).map(Value::Choice),
        Kind::Boolean | Kind::BooleanOrText => boolean(param, node).map(Value::Boolean),
        Kind::Numbers { len, ascending } => numbers(param, len, ascending, node).map(Value::Numbers),
        Kind::Vector => vector(param, node).map(Value::Vector),
        Kind::Transfer(kind) => transfer(param, kind, node, picture).map(Value::Transfer),
    }
}

/// Whether a parameter accepts an example of its table, or why not.
pub(super) fn check_example(param: &Param, json: &str) -> Result<(), String> {
    let mut mistakes = Mistakes::default();
    let text = parse(&Source::new("example", json), 0, &mut mistakes);
    if !mistakes.is_empty() {
        return Err(mistakes.to_string());
    }
    let mut no_picture = |_, _: &str| Err("no picture lies beside an example".to_owned());
    read(param, &text.root, false, &mut no_picture).map(drop).map_err(|(_, problem)| problem.to_string())
}

fn out_of_range(param: &Param, value: f64, allowed: String) -> Problem {
    Problem::OutOfRange { name: param.name.to_owned(), value, allowed }
}

/// What a number must do that lies outside the range which `allowed` tells; an open range ends somewhere, too.
fn due(number: f64, allowed: String) -> String {
    match number {
        n if n > LARGEST && allowed.ends_with("or more") => format!("be at most {LARGEST:e}"),
        _ => allowed,
    }
}

fn number(param: &Param, node: &Node, expected: &str) -> Result<f64, Wrong> {
    match node.value {
        Tree::Number(n) if param.allows(n) => Ok(n),
        Tree::Number(n) => Err((node.span, out_of_range(param, n, due(n, param.allowed())))),
        _ => {
            let meant = node.text().and_then(number_in).filter(|n| param.allows(*n));
            Err((node.span, wrong_type_but(param.name, expected, node, meant.map(super::hint::number))))
        }
    }
}

/// The number that a text was meant to be: `"35"`, `"35deg"`, `"50%"`.
fn number_in(text: &str) -> Option<f64> {
    let text = text.trim();
    let end = text.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+'))).unwrap_or(text.len());
    let number: f64 = text[..end].parse().ok()?;
    match text[end..].trim() {
        "%" => Some(number / 100.0),
        "" | "deg" | "°" | "x" | "px" | "pt" => Some(number),
        _ => None,
    }
}

fn count(param: &Param, node: &Node) -> Result<u32, Wrong> {
    const EXPECTED: &str = "a whole number, 0 or more";
    match node.value {
        Tree::Number(n) if n.fract() != 0.0 || n < 0.0 => Err((node.span, wrong_type(param.name, EXPECTED, node))),
        // Allowed numbers are at most `LARGEST`, which u32 holds.
        _ => number(param, node, EXPECTED).map(|n| n as u32),
    }
}

fn length(param: &Param, node: &Node) -> Result<Length, Wrong> {
    let Some(text) = node.text() else {
        let expected = "a number (radii of the scene) or a text such as \"2pt\", \"3r\", \"1.5A\" or \"2mm\"";
        return number(param, node, expected).map(Length::Radii);
    };
    let bad = || Problem::BadLength { name: param.name.to_owned(), value: text.to_owned(), hint: length_hint(text) };
    let length: Length = text.parse().map_err(|_| (node.span, bad()))?;
    let (lowest, highest) = param.length_bounds(length);
    if (lowest..=highest).contains(&length.number()) {
        return Ok(length);
    }
    let allowed = match (lowest, highest) {
        (0.0, LARGEST) => "be 0 or more".to_owned(),
        (lowest, highest) => format!("lie in {lowest:e} to {highest:e} {}", length.unit()),
    };
    Err((node.span, out_of_range(param, length.number(), due(length.number(), allowed))))
}

/// The length that was meant by a unit of another language, or one that is written in another way.
fn length_hint(text: &str) -> Hint {
    let text = text.trim();
    let (number, unit) = text.split_at(text.find(|c: char| c.is_alphabetic()).unwrap_or(text.len()));
    let unit = match unit.to_lowercase().as_str() {
        "px" | "pt" | "pts" | "point" | "points" => "pt",
        "a" | "ang" | "angstrom" | "angstroms" | "\u{e5}" | "\u{e5}ngstr\u{f6}m" => "A",
        "mm" | "millimetre" | "millimeter" => "mm",
        "r" => "r",
        _ => return Hint::NONE,
    };
    let meant = format!("{}{unit}", number.trim());
    Hint { nearest: meant.parse::<Length>().is_ok().then_some(meant), allowed: Vec::new() }
}

fn choice_or_length(param: &Param, of: &'static [&'static str], node: &Node) -> Result<Value, Wrong> {
    let word = node.text().filter(|text| !text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-')));
    match word {
        Some(text) => choice(param, of, node).map(Value::Choice).map_err(|_| {
            let mut hint = Hint::new(text, of.iter().copied());
            hint.allowed.push("a length".to_owned());
            (node.span, not_a_choice(param, text, hint))
        }),
        None => length(param, node).map(Value::Length),
    }
}

fn place(param: &Param, of: &'static [&'static str], node: &Node) -> Result<Value, Wrong> {
    let begins_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    match node.text().filter(|text| !text.trim_start().starts_with(begins_number)) {
        Some(text) => match of.iter().position(|word| *word == text) {
            Some(index) => Ok(Value::Choice(index)),
            None => {
                let words = [of, &["a length"]].concat();
                Selector::parse_or(text, &words).map(Value::Selector).map_err(|problem| (node.span, problem))
            }
        },
        None if node.text().is_none() && !matches!(node.value, Tree::Number(_)) => {
            let words: Vec<String> = of.iter().map(|word| quote(word)).collect();
            let expected = format!("{}, a length such as \"2A\", or {SELECTOR}", words.join(", "));
            Err((node.span, wrong_type(param.name, &expected, node)))
        }
        None => length(param, node).map(Value::Length),
    }
}

/// What a selector is, in messages.
const SELECTOR: &str = "a selector such as \"atom[element=O]\"";

fn selector(param: &Param, node: &Node) -> Result<Selector, Wrong> {
    let text = node.text().ok_or_else(|| (node.span, wrong_type(param.name, SELECTOR, node)))?;
    Selector::parse(text).map_err(|problem| (node.span, problem))
}

fn choice(param: &Param, of: &'static [&'static str], node: &Node) -> Result<usize, Wrong> {
    let Some(text) = node.text() else {
        let expected = format!("one of the texts {}", of.iter().map(|word| quote(word)).collect::<Vec<_>>().join(", "));
        return Err((node.span, wrong_type(param.name, &expected, node)));
    };
    of.iter().position(|word| *word == text).ok_or_else(|| {
        let hint = Hint::new(text, of.iter().copied());
        (node.span, not_a_choice(param, text, hint))
    })
}

fn not_a_choice(param: &Param, text: &str, hint: Hint) -> Problem {
    Problem::NotAChoice { name: param.name.to_owned(), value: text.to_owned(), hint }
}

fn boolean(param: &Param, node: &Node) -> Result<bool, Wrong> {
    match (&node.value, param.kind) {
        (Tree::Bool(value), _) => Ok(*value),
        // [Prost2016, Table 1] writes "orthographic": "true", broken over two lines in print.
        (Tree::Text(text), Kind::BooleanOrText) if text.trim() == "true" => Ok(true),
        (Tree::Text(text), Kind::BooleanOrText) if text.trim() == "false" => Ok(false),
        _ => Err((node.span, wrong_type(param.name, "true or false", node))),
    }
}

/// The components of a colour are bytes as in [Prost2016, Listing 1].
fn color(param: &Param, other_words: &[&'static str], node: &Node, with_hints: bool) -> Result<Srgba, Wrong> {
    let bad = |hint| Problem::BadColor { name: param.name.to_owned(), found: node.describe(), hint };
    match &node.value {
        Tree::Text(text) => Srgba::parse(text).ok_or_else(|| {
            let words = css_names().chain(other_words.iter().copied());
            let near = match Srgba::meant(text) {
                Some(meant) => Hint { nearest: Some(meant.to_string()), allowed: Vec::new() },
                None if with_hints => Hint::nearest_of(text, words),
                None => Hint::NONE,
            };
            (node.span, bad(near))
        }),
        Tree::List(items) if items.len() == 3 || items.len() == 4 => {
            let mut rgba = [1.0; 4];
            for (component, item) in rgba.iter_mut().zip(items) {
                let Tree::Number(n) = item.value else {
                    return Err((item.span, wrong_type(param.name, "a colour of numbers in 0 to 255", item)));
                };
                if !(0.0..=255.0).contains(&n) {
                    return Err((item.span, out_of_range(param, n, "lie in 0 to 255".to_owned())));
                }
                *component = (n / 255.0) as f32;
            }
            Ok(Srgba { rgba })
        }
        _ => Err((node.span, bad(Hint::NONE))),
    }
}

/// The colour in bytes that was meant by numbers between 0 and 1, as other programs take them; none where bytes can be
/// meant.
fn color_of_shares(value: &Value, node: &Node) -> Option<String> {
    let (Value::Color(_) | Value::BaseColor(BaseColor::Color(_)), Tree::List(items)) = (value, &node.value) else {
        return None;
    };
    let numbers = items.iter().map(|item| match item.value {
        Tree::Number(n) if (0.0..=1.0).contains(&n) => Some(n),
        _ => None,
    });
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    let bytes: Vec<String> = numbers.iter().map(|n| (n * 255.0).round().to_string()).collect();
    numbers.iter().any(|n| n.fract() != 0.0).then(|| format!("[{}]", bytes.join(", ")))
}

/// [Prost2016, Table 1] nests its one list of `layers` in another.
/// What is wrong with a list whose numbers fall.
const FALLING: &str = "this number is below the one before it, but those of this list must not fall";

fn numbers(param: &Param, len: usize, ascending: bool, node: &Node) -> Result<Vec<f64>, Wrong> {
    let expected = match len {
        0 => "a list of numbers".to_owned(),
        len => format!("a list of {len} numbers"),
    };
    let mut inner = node;
    if let Tree::List(items) = &node.value
        && let [only] = items.as_slice()
        && matches!(only.value, Tree::List(_))
    {
        inner = only;
    }
    match &inner.value {
        Tree::List(items) if len == 0 || items.len() == len => {
            let list: Result<Vec<f64>, Wrong> = items.iter().map(|item| number(param, item, &expected)).collect();
            let list = list?;
            let falls = list.windows(2).zip(items.iter().skip(1)).find(|(pair, _)| ascending && pair[1] < pair[0]);
            match falls {
                Some((_, item)) => Err((item.span, Problem::Meaningless(FALLING))),
                None => Ok(list),
            }
        }
        _ => Err((inner.span, wrong_type(param.name, &expected, inner))),
    }
}

fn vector(param: &Param, node: &Node) -> Result<[f64; 3], Wrong> {
    const EXPECTED: &str = "a list of 3 numbers";
    match &node.value {
        Tree::List(items) if items.len() == 3 => {
            let mut vector = [0.0; 3];
            for (component, item) in vector.iter_mut().zip(items) {
                *component = number(param, item, EXPECTED)?;
            }
            Ok(vector)
        }
        _ => Err((node.span, wrong_type(param.name, EXPECTED, node))),
    }
}

fn transfer(param: &Param, kind: TransferKind, node: &Node, picture: &mut ReadPicture<'_>) -> Result<Transfer, Wrong> {
    let text = match &node.value {
        Tree::Text(text) => text,
        Tree::List(items) => return points::read(kind, param.name, node, items),
        _ => {
            let expected =
                format!("the name of a preset, the path of a PNG picture, or a list of 1 to {MAX_POINTS} points");
            return Err((node.span, wrong_type(param.name, &expected, node)));
        }
    };
    if let Some(preset) = Transfer::preset(kind, text) {
        return Ok(preset);
    }
    let (stem, extension) = text.rsplit_once('.').unwrap_or((text, ""));
    if extension.eq_ignore_ascii_case("png") {
        let unusable = |reason| Problem::Picture { name: param.name.to_owned(), picture: text.clone(), reason };
        let nodes = picture(kind, text).map_err(|reason| (node.span, unusable(reason)))?;
        return Ok(Transfer::new(Written::Picture(text.as_str().into()), nodes));
    }
    if extension.starts_with(|c: char| c.is_ascii_alphabetic()) {
        let write = format!("{}, exported as PNG", quote(&format!("{stem}.png")));
        return Err((node.span, wrong_type_but(param.name, "a picture that ends in .png", node, Some(write))));
    }
    let mut hint = Hint::new(text, kind.presets().iter().map(|preset| preset.name));
    hint.allowed.extend(["a picture that ends in .png".to_owned(), "a list of points".to_owned()]);
    Err((node.span, not_a_choice(param, text, hint)))
}
