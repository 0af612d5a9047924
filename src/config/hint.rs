//! `; did you mean "…"? allowed: …`: the helpful end of a message.

use std::fmt;

/// Longest word that is compared with others, in bytes: names are short, and comparing takes the product of lengths.
const LONGEST_COMPARED: usize = 64;

/// Longest text that a message repeats, in characters.
const LONGEST_QUOTED: usize = 60;

/// The nearest word and all that are allowed.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Hint {
    /// The nearest allowed word, if one is near.
    pub nearest: Option<String>,
    /// All allowed words; empty if they are too many to list.
    pub allowed: Vec<String>,
}

impl Hint {
    /// Nothing to add.
    pub const NONE: Self = Self { nearest: None, allowed: Vec::new() };

    /// The word of `allowed` that is nearest to `word`, and all of them.
    pub fn new<'a>(word: &str, allowed: impl IntoIterator<Item = &'a str>) -> Self {
        Self::with_more(word, allowed, [])
    }

    /// The word of `allowed` or `also` that is nearest to `word`, and all of `allowed`.
    pub fn with_more<'a>(
        word: &str,
        allowed: impl IntoIterator<Item = &'a str>,
        also: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let allowed: Vec<&str> = allowed.into_iter().collect();
        let nearest = nearest(word, allowed.iter().copied().chain(also));
        Self { nearest, allowed: allowed.into_iter().map(str::to_owned).collect() }
    }

    /// All of `allowed`, with no word to compare.
    pub fn list<'a>(allowed: impl IntoIterator<Item = &'a str>) -> Self {
        Self { nearest: None, allowed: allowed.into_iter().map(str::to_owned).collect() }
    }

    /// The nearest word of a set that is too large to list.
    pub fn nearest_of<'a>(word: &str, words: impl IntoIterator<Item = &'a str>) -> Self {
        Self { nearest: nearest(word, words), allowed: Vec::new() }
    }
}

/// A hint of names that a scene has, rather than of words that are allowed.
pub(super) struct OfScene<'a>(pub(super) &'a Hint);

impl fmt::Display for OfScene<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.write(f, "the scene has")
    }
}

impl fmt::Display for Hint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write(f, "allowed")
    }
}

impl Hint {
    fn write(&self, f: &mut fmt::Formatter<'_>, of_list: &str) -> fmt::Result {
        match &self.nearest {
            Some(nearest) => write!(f, "; did you mean {}?", quote(nearest))?,
            None if self.allowed.is_empty() => return Ok(()),
            None => f.write_str(";")?,
        }
        if self.allowed.is_empty() {
            return Ok(());
        }
        let shown: Vec<String> = self.allowed.iter().map(|word| shorten(word)).collect();
        write!(f, " {of_list}: {}", shown.join(", "))
    }
}

/// The word of `words` that is nearest to `word`: at most a third of its letters differ, rounded up, or one begins the other.
pub fn nearest<'a>(word: &str, words: impl IntoIterator<Item = &'a str>) -> Option<String> {
    if word.is_empty() || word.len() > LONGEST_COMPARED {
        return None;
    }
    let lower = word.to_lowercase();
    let letters = word.chars().count();
    let most = letters.div_ceil(3).min(letters - 1);
    let begins = |other: &str| {
        let shorter = lower.len().min(other.len());
        shorter >= 3 && (other.starts_with(&lower) || lower.starts_with(other))
    };
    words
        .into_iter()
        .filter(|other| other.len() <= LONGEST_COMPARED)
        .filter_map(|other| {
            let other_lower = other.to_lowercase();
            let distance = strsim::damerau_levenshtein(&lower, &other_lower);
            let rank = if distance <= most { distance } else { LONGEST_COMPARED + distance };
            (distance <= most || begins(&other_lower)).then_some((rank, other))
        })
        .min_by_key(|(rank, _)| *rank)
        .map(|(_, other)| other.to_owned())
}

/// A text of the user as a message shows it: quoted, on one line, and not longer than a line.
pub fn quote(text: &str) -> String {
    format!("\"{}\"", shorten(text))
}

/// A number as a message shows it: never hundreds of digits.
pub(super) fn number(value: f64) -> String {
    if value != 0.0 && !(1e-6..1e15).contains(&value.abs()) { format!("{value:e}") } else { value.to_string() }
}

pub(super) fn shorten(text: &str) -> String {
    let mut shown = String::new();
    for (i, c) in text.chars().enumerate() {
        if i == LONGEST_QUOTED {
            shown.push('…');
            break;
        }
        // A line break, or a mark that turns the writing direction, would break the one-line format.
        let turns_text = matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        // A mark that shows nothing would make two words look alike.
        let is_unseen = matches!(c, '\u{ad}' | '\u{200b}' | '\u{2060}' | '\u{feff}');
        if c.is_control() || turns_text || is_unseen {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_its_word() {
        let words = ["hull_size", "outline_bias", "ssaoPost", "steps"];
        assert_eq!(nearest("hul_size", words).as_deref(), Some("hull_size"));
        assert_eq!(nearest("Steps", words).as_deref(), Some("steps"));
        assert_eq!(nearest("ssao", words).as_deref(), Some("ssaoPost"));
        assert_eq!(nearest("xyz", words), None);
        assert_eq!(nearest("", words), None);
        assert_eq!(nearest(&"s".repeat(1_000_000), words), None);
    }

    #[test]
    fn hints_read_as_sentences() {
        assert_eq!(Hint::new("stepz", ["steps", "bias"]).to_string(), "; did you mean \"steps\"? allowed: steps, bias");
        assert_eq!(Hint::new("zzz", ["steps", "bias"]).to_string(), "; allowed: steps, bias");
        assert_eq!(Hint::nearest_of("stepz", ["steps"]).to_string(), "; did you mean \"steps\"?");
        assert_eq!(Hint::NONE.to_string(), "");
    }

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, 0.25, -1e9, 1e300, 1e-300].map(number);
        assert_eq!(shown, ["0", "0.25", "-1000000000", "1e300", "1e-300"]);
    }

    #[test]
    fn a_hostile_text_stays_on_one_line() {
        assert_eq!(quote("a\nb\u{202e}"), "\"a\\nb\\u{202e}\"");
        assert_eq!(quote(&"x".repeat(1000)).chars().count(), LONGEST_QUOTED + 3);
    }
}
