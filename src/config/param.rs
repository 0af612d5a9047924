//! Parameters, declared once: a table feeds defaults, checks, schema, sliders and the manual.
//!
//! ```
//! use restyle::config::Param;
//! const PARAMS: &[Param] = &[
//!     Param::number("scale", 0.5).range(0.0, 10.0).doc("Weight of the light's direction."),
//!     Param::length("hull_size", "2pt").doc("Width of the outline."),
//!     Param::choice("levels", &["floor", "centre", "full"], "floor").doc("Brightness of each level."),
//! ];
//! ```

pub use super::color::{BaseColor, Srgba};
pub use super::length::Length;
pub use super::selector::Selector;
pub use super::transfer::{COLOR_SIZE, OPACITY_SIZE, Transfer, TransferKind};
pub use super::values::Values;

/// Largest magnitude of any number in a style. Ours: far above any use, and safe to square in 32-bit floats.
pub const LARGEST: f64 = 1e9;

/// What a parameter holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number.
    Number,
    /// A whole number, 0 or more.
    Count,
    /// A length: a number of radii, or text with a unit.
    Length,
    /// One of some words, or a length.
    ChoiceOrLength(&'static [&'static str]),
    /// One of some words, a length, or a selector.
    Place(&'static [&'static str]),
    /// A selector.
    Selector,
    /// A colour.
    Color,
    /// A source of colour, or a colour.
    BaseColor,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// `true` or `false`.
    Boolean,
    /// `true` or `false`, also as text, as [Prost2016, Table 1] has it.
    BooleanOrText,
    /// A list of numbers; a length of 0 allows any.
    Numbers {
        /// How many there must be.
        len: usize,
        /// Whether none may be below the one before it.
        ascending: bool,
    },
    /// Three numbers.
    Vector,
    /// A transfer function: the name of a preset, the path of a picture, or a list of control points.
    Transfer(TransferKind),
}

/// The value of a parameter that the file does not give, in the form in which a table can hold it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Default {
    /// None: the parameter may be unset.
    Unset,
    /// For a number.
    Number(f64),
    /// For a count.
    Count(u32),
    /// For a length in radii.
    Radii(f64),
    /// For a length with a unit, a word of a choice, or a preset of a transfer function.
    Text(&'static str),
    /// For a colour.
    Color(Srgba),
    /// For a source of colour.
    BaseColor(BaseColor),
    /// For a boolean.
    Boolean(bool),
    /// For a list of numbers.
    Numbers(&'static [f64]),
    /// For a vector.
    Vector([f64; 3]),
}

/// One value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Of a parameter that may be unset, and is.
    Unset,
    /// A number.
    Number(f64),
    /// A whole number.
    Count(u32),
    /// A length.
    Length(Length),
    /// A selector.
    Selector(Selector),
    /// A colour.
    Color(Srgba),
    /// A source of colour.
    BaseColor(BaseColor),
    /// A word, as an index into the choices of the parameter's kind.
    Choice(usize),
    /// A boolean.
    Boolean(bool),
    /// A list of numbers.
    Numbers(Vec<f64>),
    /// A vector.
    Vector([f64; 3]),
    /// A transfer function.
    Transfer(Transfer),
}

/// One parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Param {
    /// Its key in style files.
    pub name: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// Its value where a file gives none.
    pub default: Default,
    /// Lowest and highest allowed number, both included; an infinite end is open. Each number of a list or vector is
    /// held to it. Of a length with a unit, only a lower end of 0 counts: the rest is in radii.
    pub range: Option<(f64, f64)>,
    /// The unit of its numbers, for messages and the manual; empty if there is none.
    pub unit: &'static str,
    /// One sentence for the manual, the schema and the editor.
    pub doc: &'static str,
    /// Values that show what it does, as JSON: the editor offers them, and the manual has a picture of each.
    pub examples: &'static [&'static str],
}

impl Param {
    const fn new(name: &'static str, kind: Kind, default: Default) -> Self {
        Self { name, kind, default, range: None, unit: "", doc: "", examples: &[] }
    }

    /// A number.
    pub const fn number(name: &'static str, default: f64) -> Self {
        Self::new(name, Kind::Number, Default::Number(default))
    }

    /// A whole number, 0 or more.
    pub const fn count(name: &'static str, default: u32) -> Self {
        Self::new(name, Kind::Count, Default::Count(default))
    }

    /// A length with a unit, such as `"2pt"`; not negative unless `range` says so.
    pub const fn length(name: &'static str, default: &'static str) -> Self {
        Self::new(name, Kind::Length, Default::Text(default)).at_least(0.0)
    }

    /// A length whose default is in radii of the scene; not negative unless `range` says so.
    pub const fn radii(name: &'static str, default: f64) -> Self {
        Self::new(name, Kind::Length, Default::Radii(default)).at_least(0.0)
    }

    /// A length that may be unset.
    pub const fn optional_length(name: &'static str) -> Self {
        Self::new(name, Kind::Length, Default::Unset).at_least(0.0)
    }

    /// One of some words, or a length. The default is a word.
    pub const fn choice_or_length(name: &'static str, of: &'static [&'static str], default: &'static str) -> Self {
        Self::new(name, Kind::ChoiceOrLength(of), Default::Text(default)).at_least(0.0)
    }

    /// One of some words, a length, or a selector. The default is a word.
    pub const fn place(name: &'static str, of: &'static [&'static str], default: &'static str) -> Self {
        Self::new(name, Kind::Place(of), Default::Text(default)).at_least(0.0)
    }

    /// A selector that may be unset.
    pub const fn optional_selector(name: &'static str) -> Self {
        Self::new(name, Kind::Selector, Default::Unset)
    }

    /// A colour, opaque by default.
    pub const fn color(name: &'static str, default: [u8; 3]) -> Self {
        Self::new(name, Kind::Color, Default::Color(Srgba::from_bytes(default)))
    }

    /// A colour that may be unset.
    pub const fn optional_color(name: &'static str) -> Self {
        Self::new(name, Kind::Color, Default::Unset)
    }

    /// A source of colour, or a colour.
    pub const fn base_color(name: &'static str, default: BaseColor) -> Self {
        Self::new(name, Kind::BaseColor, Default::BaseColor(default))
    }

    /// One of some words.
    pub const fn choice(name: &'static str, of: &'static [&'static str], default: &'static str) -> Self {
        Self::new(name, Kind::Choice(of), Default::Text(default))
    }

    /// `true` or `false`.
    pub const fn boolean(name: &'static str, default: bool) -> Self {
        Self::new(name, Kind::Boolean, Default::Boolean(default))
    }

    /// A list of numbers, of any length unless `of_len` says so.
    pub const fn numbers(name: &'static str, default: &'static [f64]) -> Self {
        Self::new(name, Kind::Numbers { len: 0, ascending: false }, Default::Numbers(default))
    }

    /// Three numbers.
    pub const fn vector(name: &'static str, default: [f64; 3]) -> Self {
        Self::new(name, Kind::Vector, Default::Vector(default))
    }

    /// Three numbers that may be unset.
    pub const fn optional_vector(name: &'static str) -> Self {
        Self::new(name, Kind::Vector, Default::Unset)
    }

    /// A transfer function of opacity. The default is a preset.
    pub const fn opacity_transfer(name: &'static str, default: &'static str) -> Self {
        Self::new(name, Kind::Transfer(TransferKind::Opacity), Default::Text(default))
    }

    /// A transfer function of colour. The default is a preset.
    pub const fn color_transfer(name: &'static str, default: &'static str) -> Self {
        Self::new(name, Kind::Transfer(TransferKind::Color), Default::Text(default))
    }

    /// Lowest and highest allowed number.
    pub const fn range(mut self, lowest: f64, highest: f64) -> Self {
        self.range = Some((lowest, highest));
        self
    }

    /// Lowest allowed number.
    pub const fn at_least(self, lowest: f64) -> Self {
        self.range(lowest, f64::INFINITY)
    }

    /// The unit of its numbers.
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// One sentence about it.
    pub const fn doc(mut self, doc: &'static str) -> Self {
        self.doc = doc;
        self
    }

    /// Values that show what it does, as JSON texts; [`check_table`] tries each.
    pub const fn examples(mut self, examples: &'static [&'static str]) -> Self {
        self.examples = examples;
        self
    }

    /// How many numbers the list must hold.
    pub const fn of_len(mut self, len: usize) -> Self {
        self.kind = Kind::Numbers { len, ascending: false };
        self
    }

    /// Numbers of the list must not fall.
    pub const fn ascending(mut self) -> Self {
        if let Kind::Numbers { len, .. } = self.kind {
            self.kind = Kind::Numbers { len, ascending: true };
        }
        self
    }

    /// Accepts `"true"` and `"false"` for a boolean.
    pub const fn or_text(mut self) -> Self {
        self.kind = Kind::BooleanOrText;
        self
    }

    /// The words of a choice; empty for other kinds.
    pub const fn choices(&self) -> &'static [&'static str] {
        match self.kind {
            Kind::Choice(of) | Kind::ChoiceOrLength(of) | Kind::Place(of) => of,
            _ => &[],
        }
    }

    /// The default as a value, or what is wrong with the declaration.
    pub fn default_value(&self) -> Result<Value, String> {
        let bad = || Err(format!("{:?}: the default {:?} does not fit {:?}", self.name, self.default, self.kind));
        match (self.kind, self.default) {
            (Kind::Length | Kind::Selector | Kind::Color | Kind::Vector, Default::Unset) => Ok(Value::Unset),
            (Kind::Number, Default::Number(n)) => Ok(Value::Number(n)),
            (Kind::Count, Default::Count(n)) => Ok(Value::Count(n)),
            (Kind::Length, Default::Radii(n)) => Ok(Value::Length(Length::Radii(n))),
            (Kind::Length, Default::Text(text)) => text.parse().map(Value::Length).or_else(|_| bad()),
            (Kind::Choice(of) | Kind::ChoiceOrLength(of) | Kind::Place(of), Default::Text(text)) => {
                of.iter().position(|choice| *choice == text).map_or_else(bad, |i| Ok(Value::Choice(i)))
            }
            (Kind::Color, Default::Color(color)) => Ok(Value::Color(color)),
            (Kind::BaseColor, Default::BaseColor(color)) => Ok(Value::BaseColor(color)),
            (Kind::Boolean | Kind::BooleanOrText, Default::Boolean(value)) => Ok(Value::Boolean(value)),
            (Kind::Numbers { len, .. }, Default::Numbers(list)) if len == 0 || list.len() == len => {
                Ok(Value::Numbers(list.to_vec()))
            }
            (Kind::Vector, Default::Vector(vector)) => Ok(Value::Vector(vector)),
            (Kind::Transfer(kind), Default::Text(name)) => {
                Transfer::preset(kind, name).map_or_else(bad, |transfer| Ok(Value::Transfer(transfer)))
            }
            _ => bad(),
        }
    }

    /// Whether a number lies in the range.
    pub fn allows(&self, number: f64) -> bool {
        let (lowest, highest) = self.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        number.abs() <= LARGEST && lowest <= number && number <= highest
    }

    /// Lowest and highest number of a length in its own unit: the range of radii, or its sign for other units.
    pub fn length_bounds(&self, length: Length) -> (f64, f64) {
        let (lowest, highest) = self.range.unwrap_or((-LARGEST, LARGEST));
        match length {
            Length::Radii(_) => (lowest.max(-LARGEST), highest.min(LARGEST)),
            _ if lowest < 0.0 => (-LARGEST, LARGEST),
            _ => (0.0, LARGEST),
        }
    }

    /// What a number must do to be allowed, such as `lie in 1 to 179 degrees`, or `be 0 or more`, which leaves unsaid
    /// that no number of a style is beyond [`LARGEST`].
    pub fn allowed(&self) -> String {
        let bounds = match self.range {
            Some((lowest, highest)) if lowest.is_finite() && highest.is_finite() => {
                format!("lie in {lowest} to {highest}")
            }
            Some((lowest, _)) if lowest.is_finite() => {
                format!("be {lowest} or more")
            }
            _ => format!("lie in -{LARGEST:e} to {LARGEST:e}"),
        };
        if self.unit.is_empty() { bounds } else { format!("{bounds} {}", self.unit) }
    }
}

/// What a selector is, in [`Param::facts`].
const SELECTOR: &str = "a selector such as `atom[element=O]`";

impl Param {
    /// What it holds and its default, for the manual and the editor, in Markdown.
    pub fn facts(&self) -> String {
        let words = |of: &[&str]| of.iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", ");
        let numbers = |what: &str| {
            let (lowest, highest) = self.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
            let bounds = match (lowest.is_finite(), highest.is_finite()) {
                (true, true) => format!(" from {lowest} to {highest}"),
                (true, false) => format!(", {lowest} or more"),
                (false, true) => format!(", {highest} or less"),
                (false, false) => String::new(),
            };
            let unit = if self.unit.is_empty() { String::new() } else { format!(" ({})", self.unit) };
            format!("{what}{bounds}{unit}")
        };
        let holds = match self.kind {
            Kind::Number => numbers("a number"),
            Kind::Count => numbers("a whole number"),
            Kind::Length => numbers("a length"),
            Kind::ChoiceOrLength(of) => format!("{}, or {}", words(of), numbers("a length")),
            Kind::Place(of) => format!("{}, {}, or {SELECTOR}", words(of), numbers("a length")),
            Kind::Selector => SELECTOR.to_owned(),
            Kind::Color => "a colour".to_owned(),
            Kind::BaseColor => format!("{}, or a colour", words(&BaseColor::NAMES)),
            Kind::Choice(of) => format!("one of {}", words(of)),
            Kind::Boolean | Kind::BooleanOrText => "`true` or `false`".to_owned(),
            Kind::Numbers { len: 0, .. } => numbers("a list of numbers"),
            Kind::Numbers { len, ascending } => {
                let order = if ascending { ", none below the one before it" } else { "" };
                numbers(&format!("a list of {len} numbers")) + order
            }
            Kind::Vector => numbers("three numbers"),
            Kind::Transfer(kind) => kind.facts(),
        };
        let default = match self.default {
            Default::Unset => "unset (`null`)".to_owned(),
            Default::Number(n) | Default::Radii(n) => format!("`{n}`"),
            Default::Count(n) => format!("`{n}`"),
            Default::Text(text) => format!("`\"{text}\"`"),
            Default::Color(color) => format!("`\"{color}\"`"),
            Default::BaseColor(color) => format!("`\"{color}\"`"),
            Default::Boolean(value) => format!("`{value}`"),
            Default::Numbers(list) => format!("`{list:?}`"),
            Default::Vector([x, y, z]) => format!("`[{x}, {y}, {z}]`"),
        };
        let mut holds = holds.chars();
        let first: String = holds.next().into_iter().flat_map(char::to_uppercase).collect();
        let presets = match self.kind {
            Kind::Transfer(kind) => format!("\n{}", kind.preset_facts()),
            _ => String::new(),
        };
        format!("{first}{}. Default: {default}.{presets}", holds.as_str())
    }
}

/// What is wrong with a table; empty if nothing is. For the test that every table of the program goes through.
pub fn check_table(params: &[Param]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (i, param) in params.iter().enumerate() {
        let name = param.name;
        if params[..i].iter().any(|earlier| earlier.name == name) {
            wrong.push(format!("{name:?} is declared twice"));
        }
        if name.is_empty() || !name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_') {
            wrong.push(format!("{name:?} is not in lower case with underscores"));
        }
        if param.doc.is_empty() {
            wrong.push(format!("{name:?} has no doc"));
        }
        for example in param.examples {
            if let Err(reason) = super::read::check_example(param, example) {
                wrong.push(format!("{name:?}: the example {example} is wrong: {reason}"));
            }
        }
        if param.range.is_some_and(|(lowest, highest)| lowest.is_nan() || highest.is_nan() || lowest > highest) {
            wrong.push(format!("{name:?}: the range is empty"));
        }
        let numbers = match param.default_value() {
            Err(reason) => {
                wrong.push(reason);
                continue;
            }
            Ok(Value::Number(n)) => vec![n],
            Ok(Value::Count(n)) => vec![f64::from(n)],
            Ok(Value::Length(length)) => {
                let (lowest, highest) = param.length_bounds(length);
                if !(lowest..=highest).contains(&length.number()) {
                    wrong.push(format!("{name:?}: the default is outside the range"));
                }
                continue;
            }
            Ok(Value::Numbers(list)) => list,
            Ok(Value::Vector(vector)) => vector.to_vec(),
            Ok(
                Value::Unset
                | Value::Selector(_)
                | Value::Color(_)
                | Value::BaseColor(_)
                | Value::Choice(_)
                | Value::Boolean(_)
                | Value::Transfer(_),
            ) => continue,
        };
        if numbers.iter().any(|n| !param.allows(*n)) {
            wrong.push(format!("{name:?}: the default is outside the range"));
        }
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_declarations_are_found() {
        let params = [
            Param::number("n", 2.0).range(0.0, 1.0).doc("d"),
            Param::length("size", "2px").doc("d"),
            Param::choice("levels", &["a", "b"], "c").doc("d"),
            Param::numbers("layers", &[0.0]).of_len(4).doc("d"),
            Param::count("n", 1),
            Param::boolean("Flag", true).doc("d"),
            Param::number("x", 1.0).range(0.0, 1.0).doc("d").examples(&["0.5", "7", "07"]),
            Param::opacity_transfer("glow", "fig6a").doc("d"),
            Param::color_transfer("tint", "none").doc("d").examples(&["\"fig6a\"", "[[0, 1]]", "\"a.png\""]),
        ];
        let wrong = check_table(&params).join("\n");
        for part in [
            "\"n\": the default is outside",
            "\"size\": the default",
            "\"levels\"",
            "\"layers\"",
            "declared twice",
            "no doc",
            "\"Flag\" is not",
            "\"x\": the example 7 is wrong: \"x\" is 7, but must lie in 0 to 1",
            "\"x\": the example 07 is wrong: example:1:1: write 7 instead of 07",
            "\"glow\": the default Text(\"fig6a\") does not fit",
            "\"tint\": the example \"a.png\" is wrong: \"tint\" cannot use \"a.png\": no picture lies beside an example",
        ] {
            assert!(wrong.contains(part), "{part} is not in\n{wrong}");
        }
    }

    #[test]
    fn ranges_read_as_sentences() {
        assert_eq!(Param::number("fov", 35.0).range(1.0, 179.0).unit("degrees").allowed(), "lie in 1 to 179 degrees");
        assert_eq!(Param::number("zoom", 1.0).at_least(0.1).allowed(), "be 0.1 or more");
        assert_eq!(Param::number("x", 1.0).allowed(), "lie in -1e9 to 1e9");
    }
}
