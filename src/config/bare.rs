//! What stands without quotes: numbers, `true`, `false`, `null`, and what people write in their place.

use super::hint::quote;
use super::length::Length;
use super::syntax::Tree;

/// What is wrong with a value that stands without quotes.
pub(super) struct BareSlip {
    pub(super) words: String,
    /// Whether it may have been meant as a text, which may be a name that the rest of the file refers to.
    pub(super) may_be_text: bool,
}

/// The value, or what to write instead.
pub(super) fn read(run: &str) -> Result<Tree, BareSlip> {
    match run {
        "true" => return Ok(Tree::Bool(true)),
        "false" => return Ok(Tree::Bool(false)),
        "null" => return Ok(Tree::Null),
        _ if is_number(run) => return finite(run),
        _ => {}
    }
    let slip = |may_be_text, words| Err(BareSlip { words, may_be_text });
    if let Some(number) = mend_number(run) {
        return slip(false, format!("write {} instead of {}", short(&number), short(run)));
    }
    if run.parse::<Length>().is_ok() {
        return slip(false, format!("a length with a unit needs quotes: write {}", quote(run)));
    }
    if let Some(meant) = mend_unit(run) {
        return slip(false, format!("write {meant} instead of {}", short(run)));
    }
    let lower = run.to_ascii_lowercase();
    match lower.trim_start_matches(['-', '+']) {
        "nan" | "inf" | "infinity" => {
            return slip(
                false,
                format!("{} is no number that a style can hold: write one such as 12 or -0.5", short(run)),
            );
        }
        _ => {}
    }
    if let Some(literal) = mend_literal(&lower) {
        return slip(true, format!("write {literal} instead of {}", short(run)));
    }
    let is_color = ["rgb(", "rgba(", "hsl(", "hsla("].iter().any(|start| lower.starts_with(start));
    match run.chars().next() {
        Some('#') => slip(true, format!("a colour needs quotes: write {}", quote(run))),
        _ if is_color => {
            slip(true, "a colour is written as [r, g, b] in 0 to 255, or in quotes as \"#rrggbb\"".to_owned())
        }
        Some('(') => {
            let inside = run.trim_start_matches('(').trim_end_matches(')');
            slip(true, format!("a list stands in [ and ]: write [{}]", short(inside)))
        }
        Some('0'..='9' | '+' | '-' | '.') => slip(true, "numbers are written like 12, -0.5 or 1e-3".to_owned()),
        Some(c) if c.is_alphabetic() || matches!(c, '_' | '$' | '*' | '<') => {
            slip(true, format!("a text needs quotes: write {}", quote(run)))
        }
        _ => slip(true, format!("{} has no meaning here: remove it, or put quotes around a text", short(run))),
    }
}

/// A piece of the file as a message shows it, without quotes that would seem to be part of it.
pub(super) fn short(run: &str) -> String {
    super::hint::shorten(run)
}

fn finite(run: &str) -> Result<Tree, BareSlip> {
    let number: f64 = run.parse().unwrap_or(f64::INFINITY);
    if number.is_finite() {
        return Ok(Tree::Number(number));
    }
    Err(BareSlip { words: "this number is too large".to_owned(), may_be_text: false })
}

/// Whether this is a number by the grammar of JSON.
fn is_number(run: &str) -> bool {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let unsigned = run.strip_prefix('-').unwrap_or(run);
    let whole = digits(unsigned);
    if whole == 0 || (whole > 1 && unsigned.starts_with('0')) {
        return false;
    }
    let mut rest = &unsigned[whole..];
    if let Some(after) = rest.strip_prefix('.') {
        let fraction = digits(after);
        if fraction == 0 {
            return false;
        }
        rest = &after[fraction..];
    }
    if let Some(after) = rest.strip_prefix(['e', 'E']) {
        let after = after.strip_prefix(['+', '-']).unwrap_or(after);
        let exponent = digits(after);
        if exponent == 0 {
            return false;
        }
        rest = &after[exponent..];
    }
    rest.is_empty()
}

/// The number that was meant, for one that other languages take.
fn mend_number(run: &str) -> Option<String> {
    let (sign, unsigned) = match run.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", run.strip_prefix('+').unwrap_or(run)),
    };
    if let Some(digits) = unsigned.strip_prefix("0x").or_else(|| unsigned.strip_prefix("0X")) {
        return u32::from_str_radix(digits, 16).ok().map(|number| format!("{sign}{number}"));
    }
    let plain = unsigned.replace('_', "");
    let whole_end = plain.bytes().take_while(u8::is_ascii_digit).count();
    let (whole, rest) = plain.split_at(whole_end);
    // 007 is 7, .5 is 0.5, and 5. is 5.
    let whole = whole.trim_start_matches('0');
    let whole = if whole.is_empty() { "0" } else { whole };
    let rest = match rest.strip_prefix('.') {
        Some(after) if !after.starts_with(|c: char| c.is_ascii_digit()) && whole_end > 0 => after,
        _ => rest,
    };
    let mended = format!("{sign}{whole}{rest}");
    let is_known = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    (is_known && is_number(&mended)).then_some(mended)
}

/// What was meant by a number with a unit or a sign that other programs take: `50%`, `35°`, `2px`, or a minus of print.
fn mend_unit(run: &str) -> Option<String> {
    let with_minus = run.strip_prefix(['\u{2212}', '\u{2013}']).map(|rest| format!("-{rest}"));
    if let Some(number) = with_minus.filter(|number| is_number(number)) {
        return Some(number);
    }
    let number = |unit| run.strip_suffix(unit).filter(|number| is_number(number));
    if let Some(percent) = number("%") {
        let percent: f64 = percent.parse().ok()?;
        return Some(super::hint::number(percent / 100.0));
    }
    number("\u{b0}")
        .or_else(|| number("deg"))
        .map(str::to_owned)
        .or_else(|| Some(quote(&format!("{}pt", number("px")?))))
}

/// `true`, `false` or `null`, where another language's word or a part of one stands.
fn mend_literal(lower: &str) -> Option<&'static str> {
    match lower {
        "yes" | "on" => return Some("true"),
        "no" | "off" => return Some("false"),
        "none" | "nil" | "undefined" | "nothing" => return Some("null"),
        _ => {}
    }
    let is_part = |literal: &&str| {
        lower.len() >= 2 && lower.len() <= 6 && (literal.starts_with(lower) || lower.starts_with(*literal))
    };
    ["true", "false", "null"].into_iter().find(is_part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_json() {
        for number in ["0", "-0", "12", "-0.5", "1e5", "1E+5", "0.0e-0", "1e-999"] {
            assert!(is_number(number) && read(number).is_ok(), "{number}");
        }
        for other in ["", "-", "01", "-01", ".5", "5.", "1e", "1e+", "+1", "0x1", "1.e5", "1e5.", "Infinity", "\u{661}"]
        {
            assert!(!is_number(other) && read(other).is_err(), "{other}");
        }
    }

    #[test]
    fn what_was_meant_is_said() {
        let words = |run: &str| read(run).err().map(|slip| slip.words).unwrap_or_default();
        for (run, meant) in [
            (".5", "write 0.5 instead of .5"),
            ("-.5e3", "write -0.5e3 instead of -.5e3"),
            ("5.", "write 5 instead of 5."),
            ("+1", "write 1 instead of +1"),
            ("0x10", "write 16 instead of 0x10"),
            ("007", "write 7 instead of 007"),
            ("1_000", "write 1000 instead of 1_000"),
            ("00", "write 0 instead of 00"),
            ("1e999", "this number is too large"),
            ("2pt", "a length with a unit needs quotes: write \"2pt\""),
            ("True", "write true instead of True"),
            ("None", "write null instead of None"),
            ("nul", "write null instead of nul"),
            ("50%", "write 0.5 instead of 50%"),
            ("35\u{b0}", "write 35 instead of 35\u{b0}"),
            ("2px", "write \"2pt\" instead of 2px"),
            ("\u{2212}1.5", "write -1.5 instead of \u{2212}1.5"),
            ("full", "a text needs quotes: write \"full\""),
            ("-Infinity", "-Infinity is no number that a style can hold: write one such as 12 or -0.5"),
            ("#c0392b", "a colour needs quotes: write \"#c0392b\""),
            ("(1, 2)", "a list stands in [ and ]: write [1, 2]"),
            ("1.2.3", "numbers are written like 12, -0.5 or 1e-3"),
        ] {
            assert_eq!(words(run), meant, "{run}");
        }
    }
}
