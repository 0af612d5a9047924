//! Regular expressions for what a text may be, in the part of the syntax that JavaScript and Rust share.
//!
//! A schema that refused what the loader takes would be a mistake, so that each takes all that the loader takes.

use crate::config::color::css_names;
use crate::config::selector::{Attribute, AttributeValues, ObjectKind};
use crate::config::transfer::TransferKind;

/// White space as Rust's `trim` has it, which is what `\s` of JavaScript is but for one character each.
const SPACE: &str = r"[\s\u0085]";

/// Decimal digits that give at most [`crate::config::param::LARGEST`]. What follows seven zeros is below half a unit
/// in the last place there, and rounds to it.
const DIGITS: &str = r"0*(?:[0-9]{1,9}(?:\.[0-9]*)?|\.[0-9]+|1000000000(?:\.0{0,7}|\.0{7}[0-9]*)?)";

/// Nothing, with or without a sign.
const MINUS_ZERO: &str = r"-(?:0+\.?0*|\.0+)";

/// One of some words, exactly; nothing if there are none.
pub(super) fn one_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let words: Vec<&str> = words.into_iter().collect();
    // No text has a character before its start.
    if words.is_empty() { "[^\\s\\S]".to_owned() } else { format!("^(?:{})$", words.join("|")) }
}

/// `true` or `false` as a text.
pub(super) fn boolean() -> String {
    format!("^{SPACE}*(?:true|false){SPACE}*$")
}

fn unit() -> String {
    format!("{SPACE}*(?:pt|r|A|\u{c5}|\u{212b}|mm){SPACE}*")
}

/// A length with a unit.
pub(super) fn length(signed: bool) -> String {
    let number = if signed { format!("[-+]?{DIGITS}") } else { format!(r"(?:\+?{DIGITS}|{MINUS_ZERO})") };
    format!("^{SPACE}*{number}{}$", unit())
}

/// One of some words, or a length that begins with its number.
pub(super) fn choice_or_length(words: &[&str], signed: bool) -> String {
    let number = if signed { format!("-?{DIGITS}") } else { format!("(?:{DIGITS}|{MINUS_ZERO})") };
    format!("^(?:{}|{number}{})$", words.join("|"), unit())
}

/// One of some words, a length, or a selector of any type.
pub(super) fn place(words: &[&str], signed: bool) -> String {
    let kinds: Vec<Option<ObjectKind>> = ObjectKind::ALL.into_iter().map(Some).chain([None]).collect();
    format!("{}|{}|{}", one_of(words.iter().copied()), length(signed), selector(&kinds))
}

/// A colour: hexadecimal, or a CSS name in letters of either case; or one of some words, exactly.
pub(super) fn color(words: &[&str]) -> String {
    let mut names: Vec<&str> = css_names().chain(["transparent"]).collect();
    names.sort_unstable();
    let either_case = |name: &&str| -> String {
        name.chars().map(|c| format!("[{}{}]", c.to_ascii_lowercase(), c.to_ascii_uppercase())).collect()
    };
    let names: Vec<String> = names.iter().map(either_case).collect();
    let hex = "#(?:[0-9a-fA-F]{3,4}|[0-9a-fA-F]{6}|[0-9a-fA-F]{8})";
    let color = format!("{SPACE}*(?:{hex}|{}){SPACE}*", names.join("|"));
    if words.is_empty() { format!("^{color}$") } else { format!("^(?:{}|{color})$", words.join("|")) }
}

/// A preset of a transfer function, or a name that ends in `.png`.
pub(super) fn transfer(kind: TransferKind) -> String {
    format!(r"{}|\.[pP][nN][gG]$", one_of(kind.presets().iter().map(|preset| preset.name)))
}

/// A selector of one of some types, each with its own attributes; `None` is `*`.
pub(super) fn selector(kinds: &[Option<ObjectKind>]) -> String {
    let attributes = |kind: Option<ObjectKind>| kind.map_or(&Attribute::ALL[..], ObjectKind::attributes);
    let alternatives = kinds.chunk_by(|a, b| attributes(*a) == attributes(*b)).map(|alike| {
        let kinds: Vec<&str> = alike.iter().map(|kind| kind.map_or(r"\*", ObjectKind::name)).collect();
        let conditions = [AttributeValues::Texts, AttributeValues::Numbers, AttributeValues::Measures].map(|values| {
            let such = attributes(alike[0]).iter().filter(|attribute| attribute.values() == values);
            let names: Vec<&str> = such.map(|attribute| attribute.name()).collect();
            (!names.is_empty()).then(|| format!("(?:{}){SPACE}*={SPACE}*(?:{})", names.join("|"), value(values)))
        });
        let conditions: Vec<String> = conditions.into_iter().flatten().collect();
        format!(r"(?:{}){SPACE}*(?:\[{SPACE}*(?:{})\]{SPACE}*)*", kinds.join("|"), conditions.join("|"))
    });
    format!("^{SPACE}*(?:{})$", alternatives.collect::<Vec<_>>().join("|"))
}

/// What may follow `=`: in quotes, or up to the `]` and not empty.
fn value(values: AttributeValues) -> String {
    let first = r#"[^\]"'\s\u0085]|\ufeff"#;
    let quoted = |inner: &dyn Fn(char) -> String| format!(r#""{}"{SPACE}*|'{}'{SPACE}*"#, inner('"'), inner('\''));
    // Any characters but the end, and no two dots side by side.
    let parted = |end: char| format!(r"(?:\.?[^.{end}])*\.?");
    let range = range();
    match values {
        AttributeValues::Texts => {
            let any = |end: char| format!("[^{end}]*");
            format!(r"{}|(?:{first})[^\]]*", quoted(&any))
        }
        AttributeValues::Numbers => {
            let some = |end: char| format!("(?:{}|{range})", parted(end));
            let rest = r"(?:\.?[^.\]])*\.?";
            let no_dot = r#"[^\]"'\s\u0085.]|\ufeff"#;
            format!(r"{}|(?:{no_dot}){rest}|\.(?:[^.\]]{rest})?|{range}", quoted(&some))
        }
        AttributeValues::Measures => format!("{}|{range}", quoted(&|_| range.clone())),
    }
}

/// `A..B`, `A..` or `..B`.
fn range() -> String {
    let number = r"[-+]?[0-9]+(?:\.[0-9]+)?";
    format!(r"{SPACE}*(?:{number}{SPACE}*\.\.{SPACE}*(?:{number})?|\.\.{SPACE}*{number}){SPACE}*")
}
