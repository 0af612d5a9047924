//! The values of a parameter table, each with its origin.

use super::color::{BaseColor, Srgba};
use super::error::Place;
use super::length::Length;
use super::param::{Param, Value};
use super::selector::Selector;
use super::transfer::Transfer;

/// Where a value comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum Origin {
    /// The table's default.
    Default,
    /// A place in a style file.
    File(Place),
}

/// One value for each parameter of a table.
///
/// The getters take a name and expect it to be in the table with the right kind: shader code asks for what its own
/// table declares, so that anything else is a slip of the programmer and panics. [`Values::get`] does not.
#[derive(Debug, Clone)]
pub struct Values {
    params: &'static [Param],
    entries: Vec<(Value, Origin)>,
}

/// Equal values of one table are equal wherever they were written.
impl PartialEq for Values {
    fn eq(&self, other: &Self) -> bool {
        let values = |of: &Self| of.entries.iter().map(|(value, _)| value.clone()).collect::<Vec<_>>();
        self.params == other.params && values(self) == values(other)
    }
}

impl Values {
    /// The defaults of a table.
    ///
    /// # Panics
    /// If a default does not fit its parameter, which [`super::param::check_table`] finds in a test.
    pub fn defaults(params: &'static [Param]) -> Self {
        let default = |param: &Param| (param.default_value().expect("tables are checked by a test"), Origin::Default);
        Self { params, entries: params.iter().map(default).collect() }
    }

    /// The table.
    pub fn params(&self) -> &'static [Param] {
        self.params
    }

    /// Each parameter with its value and origin, in the order of the table.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Param, &Value, &Origin)> {
        self.params.iter().zip(&self.entries).map(|(param, (value, origin))| (param, value, origin))
    }

    /// A value, if the table has the parameter.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.index(name).map(|i| &self.entries[i].0)
    }

    /// Where a value comes from, if the table has the parameter.
    pub fn origin(&self, name: &str) -> Option<&Origin> {
        self.index(name).map(|i| &self.entries[i].1)
    }

    /// Whether a file gives the value.
    pub fn is_set(&self, name: &str) -> bool {
        matches!(self.origin(name), Some(Origin::File(_)))
    }

    pub(super) fn set(&mut self, index: usize, value: Value, place: Place) {
        self.entries[index] = (value, Origin::File(place));
    }

    /// Replaces a default by another one: no file gives the value.
    pub fn change_default(&mut self, name: &str, value: Value) {
        let index = self.index(name).expect("a table knows its own names");
        self.entries[index] = (value, Origin::Default);
    }

    /// The values of another table: those of its parameters that this one has as well, and the defaults of the others.
    pub fn taken_by(&self, params: &'static [Param]) -> Self {
        let mut taken = Self::defaults(params);
        for (param, entry) in params.iter().zip(&mut taken.entries) {
            if let Some(index) = self.index(param.name) {
                entry.clone_from(&self.entries[index]);
            }
        }
        taken
    }

    fn index(&self, name: &str) -> Option<usize> {
        self.params.iter().position(|param| param.name == name)
    }

    fn expect<'a, T>(&'a self, name: &str, kind: &str, of: impl FnOnce(&'a Value) -> Option<T>) -> T {
        match self.get(name).and_then(of) {
            Some(value) => value,
            None => panic!("the table of this shader declares no {kind} {name:?}"),
        }
    }

    /// A number.
    pub fn number(&self, name: &str) -> f64 {
        self.expect(name, "number", |value| match value {
            Value::Number(n) => Some(*n),
            _ => None,
        })
    }

    /// A whole number.
    pub fn count(&self, name: &str) -> u32 {
        self.expect(name, "count", |value| match value {
            Value::Count(n) => Some(*n),
            _ => None,
        })
    }

    /// A length.
    pub fn length(&self, name: &str) -> Length {
        self.expect(name, "length", |value| match value {
            Value::Length(length) => Some(*length),
            _ => None,
        })
    }

    /// A length that may be unset.
    pub fn optional_length(&self, name: &str) -> Option<Length> {
        self.expect(name, "optional length", |value| match value {
            Value::Length(length) => Some(Some(*length)),
            Value::Unset => Some(None),
            _ => None,
        })
    }

    /// A selector that may be unset.
    pub fn optional_selector(&self, name: &str) -> Option<&Selector> {
        self.expect(name, "optional selector", |value| match value {
            Value::Selector(selector) => Some(Some(selector)),
            Value::Unset => Some(None),
            _ => None,
        })
    }

    /// A colour.
    pub fn color(&self, name: &str) -> Srgba {
        self.expect(name, "colour", |value| match value {
            Value::Color(color) => Some(*color),
            _ => None,
        })
    }

    /// A colour that may be unset.
    pub fn optional_color(&self, name: &str) -> Option<Srgba> {
        self.expect(name, "optional colour", |value| match value {
            Value::Color(color) => Some(Some(*color)),
            Value::Unset => Some(None),
            _ => None,
        })
    }

    /// A source of colour.
    pub fn base_color(&self, name: &str) -> BaseColor {
        self.expect(name, "source of colour", |value| match value {
            Value::BaseColor(color) => Some(*color),
            _ => None,
        })
    }

    /// The word that is chosen.
    pub fn choice(&self, name: &str) -> &'static str {
        self.choices(name)[self.choice_index(name)]
    }

    /// The words that a choice has; empty for other kinds.
    pub(super) fn choices(&self, name: &str) -> &'static [&'static str] {
        self.index(name).map_or(&[], |i| self.params[i].choices())
    }

    /// The index of the word that is chosen, in the order of the table.
    pub fn choice_index(&self, name: &str) -> usize {
        self.expect(name, "choice", |value| match value {
            Value::Choice(i) => Some(*i),
            _ => None,
        })
    }

    /// A boolean.
    pub fn boolean(&self, name: &str) -> bool {
        self.expect(name, "boolean", |value| match value {
            Value::Boolean(b) => Some(*b),
            _ => None,
        })
    }

    /// A transfer function.
    pub fn transfer(&self, name: &str) -> &Transfer {
        self.expect(name, "transfer function", |value| match value {
            Value::Transfer(transfer) => Some(transfer),
            _ => None,
        })
    }

    /// A list of numbers.
    pub fn numbers(&self, name: &str) -> &[f64] {
        self.expect(name, "list of numbers", |value| match value {
            Value::Numbers(list) => Some(list.as_slice()),
            _ => None,
        })
    }

    /// Three numbers.
    pub fn vector(&self, name: &str) -> [f64; 3] {
        self.expect(name, "vector", |value| match value {
            Value::Vector(vector) => Some(*vector),
            _ => None,
        })
    }

    /// Three numbers that may be unset.
    pub fn optional_vector(&self, name: &str) -> Option<[f64; 3]> {
        self.expect(name, "optional vector", |value| match value {
            Value::Vector(vector) => Some(Some(*vector)),
            Value::Unset => Some(None),
            _ => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMS: &[Param] = &[
        Param::number("scale", 0.5).doc("d"),
        Param::choice("levels", &["floor", "full"], "full").doc("d"),
        Param::optional_color("shadow_color").doc("d"),
    ];

    #[test]
    fn getters_give_defaults() {
        let values = Values::defaults(PARAMS);
        assert_eq!(values.number("scale"), 0.5);
        assert_eq!(values.choice("levels"), "full");
        assert_eq!(values.optional_color("shadow_color"), None);
        assert_eq!(values.get("missing"), None);
        assert!(!values.is_set("scale"));
    }

    #[test]
    #[should_panic(expected = "declares no count \"scale\"")]
    fn a_getter_of_another_kind_is_a_slip() {
        Values::defaults(PARAMS).count("scale");
    }

    #[test]
    fn equality_ignores_the_place() {
        let (mut a, mut b) = (Values::defaults(PARAMS), Values::defaults(PARAMS));
        a.set(0, Value::Number(1.0), Place::of_file("a"));
        assert_ne!(a, b);
        b.set(0, Value::Number(1.0), Place::of_file("b"));
        assert_eq!(a, b);
        assert!(a.is_set("scale"));
    }
}
