//! Ranges of numbers, and many of them asked at once which hold a value.

use std::fmt;

/// The sign of a range between its ends.
pub(super) const DOTS: &str = "..";

/// Numbers from one end to another, both included; at least one end is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Range {
    from: f64,
    to: f64,
}

/// Why a text is no range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NoRange {
    /// It has another shape.
    Shape,
    /// Its first number is the larger one.
    Reversed,
}

impl Range {
    /// Reads `A..B`, `A..` or `..B`; white space around the numbers is fine.
    pub(super) fn parse(text: &str) -> Result<Self, NoRange> {
        let (from, to) = text.split_once(DOTS).ok_or(NoRange::Shape)?;
        let (from, to) = (from.trim(), to.trim());
        if from.is_empty() && to.is_empty() {
            return Err(NoRange::Shape);
        }
        let end = |text: &str, missing: f64| match text {
            "" => Ok(missing),
            text => leading_number(text).filter(|(_, rest)| rest.is_empty()).map(|(n, _)| n).ok_or(NoRange::Shape),
        };
        let range = Self { from: end(from, f64::NEG_INFINITY)?, to: end(to, f64::INFINITY)? };
        if range.from > range.to { Err(NoRange::Reversed) } else { Ok(range) }
    }

    /// Whether the number that a value begins with lies in the range.
    pub(super) fn matches(&self, value: &str) -> bool {
        leading_number(value).is_some_and(|(number, _)| self.from <= number && number <= self.to)
    }
}

/// One text for every way to write a range.
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // No zero is less than another.
        let end = |n: f64| if n.is_infinite() { String::new() } else { (n + 0.0).to_string() };
        write!(f, "{}{DOTS}{}", end(self.from), end(self.to))
    }
}

/// The decimal number that a text begins with, and what follows it: 100 and `A` of `100A`.
fn leading_number(text: &str) -> Option<(f64, &str)> {
    let digits = |from: usize| from + text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let start = usize::from(text.starts_with(['-', '+']));
    let mut end = digits(start);
    if end == start {
        return None;
    }
    if text[end..].starts_with('.') && digits(end + 1) > end + 1 {
        end = digits(end + 1);
    }
    // Beyond all numbers lies the largest: an end that is there stays one.
    let number: f64 = text[..end].parse().ok()?;
    Some((number.clamp(f64::MIN, f64::MAX), &text[end..]))
}

/// A set of ranges, each with a number: a segment tree over their ends [DeBerg2008 §10.3].
#[derive(Debug, Clone, Default)]
pub(super) struct RangeSet {
    /// All ends, sorted, each once. They and the gaps beside and between them are the tree's leaves.
    ends: Vec<f64>,
    /// The ranges that cover all leaves below a node and not all below the one above it. A node's two lie at twice its index.
    covering: Vec<Vec<u32>>,
}

impl RangeSet {
    /// Builds the set in n log n.
    pub(super) fn new(ranges: &[(Range, u32)]) -> Self {
        let mut ends: Vec<f64> = ranges.iter().flat_map(|(range, _)| [range.from, range.to]).collect();
        ends.sort_unstable_by(f64::total_cmp);
        ends.dedup();
        let mut set = Self { covering: Vec::new(), ends };
        if set.ends.is_empty() {
            return set;
        }
        let num_leaves = 2 * set.ends.len() + 1;
        set.covering.resize(2 * num_leaves, Vec::new());
        for (range, number) in ranges {
            let (mut low, mut high) = (set.leaf(range.from) + num_leaves, set.leaf(range.to) + 1 + num_leaves);
            while low < high {
                if low % 2 == 1 {
                    set.covering[low].push(*number);
                    low += 1;
                }
                if high % 2 == 1 {
                    high -= 1;
                    set.covering[high].push(*number);
                }
                (low, high) = (low / 2, high / 2);
            }
        }
        set
    }

    /// The leaf of a number: odd for an end itself.
    fn leaf(&self, number: f64) -> usize {
        let below = self.ends.partition_point(|end| *end < number);
        2 * below + usize::from(self.ends.get(below) == Some(&number))
    }

    /// Adds the number of each range that holds a value.
    pub(super) fn matches(&self, value: &str, found: &mut Vec<u32>) {
        if self.ends.is_empty() {
            return;
        }
        let Some((number, _)) = leading_number(value) else { return };
        let mut node = self.leaf(number) + 2 * self.ends.len() + 1;
        while node > 0 {
            found.extend(&self.covering[node]);
            node /= 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_in_every_form() {
        for (text, shape) in [
            ("10..40", "10..40"),
            (" 10 .. 40 ", "10..40"),
            ("50..", "50.."),
            ("..-0.5", "..-0.5"),
            ("+0.50..1.0", "0.5..1"),
            ("-0..0", "0..0"),
            ("3..3", "3..3"),
        ] {
            assert_eq!(Range::parse(text).map(|range| range.to_string()), Ok(shape.to_owned()), "{text}");
        }
        for text in
            ["", "..", "10", "10...40", "a..b", "1e3..", "..5x", ".5..", "5...", "--1..", "1..2..3", "\u{663}.."]
        {
            assert_eq!(Range::parse(text), Err(NoRange::Shape), "{text}");
        }
        assert_eq!(Range::parse("40..10"), Err(NoRange::Reversed));
    }

    #[test]
    fn both_ends_are_within() {
        let within = |range: &str, value: &str| Range::parse(range).expect("a range").matches(value);
        for (range, value, expected) in [
            ("10..40", "10", true),
            ("10..40", "40", true),
            ("10..40", "41", false),
            ("10..40", "9", false),
            ("100..100", "100A", true),
            ("..12.3", "12.3", true),
            ("0.5..", "0.499", false),
            ("..-0.5", "-0.5", true),
            ("..0", "-0", true),
            ("-5..", "", false),
            ("-5..", "NaN", false),
        ] {
            assert_eq!(within(range, value), expected, "{range} on {value}");
        }
        // A value of single precision, as text, is the number that the file has.
        assert!(within("..12.3", &12.3f32.to_string()) && within("12.3..", &12.3f32.to_string()));
    }

    #[test]
    fn a_set_finds_what_each_range_alone_does() {
        let ends = ["", "-2", "-0.5", "0", "1", "1.5", "7"];
        let texts = ends.iter().flat_map(|a| ends.iter().map(move |b| format!("{a}..{b}")));
        let ranges: Vec<Range> = texts.filter_map(|text| Range::parse(&text).ok()).collect();
        assert_eq!(ranges.len(), 2 * 6 + 6 * 7 / 2);
        for step in 1..4 {
            let some: Vec<(Range, u32)> = ranges.iter().copied().zip(0..).step_by(step).collect();
            let set = RangeSet::new(&some);
            for value in ["-3", "-2", "-1", "-0.5", "0", "0.25", "1", "1.2", "1.5", "2", "7", "7B", "8", "x"] {
                let mut found = Vec::new();
                set.matches(value, &mut found);
                found.sort_unstable();
                let expected: Vec<u32> =
                    some.iter().filter(|(range, _)| range.matches(value)).map(|(_, number)| *number).collect();
                assert_eq!(found, expected, "{value} in every {step}. range");
            }
        }
        let mut found = Vec::new();
        RangeSet::default().matches("1", &mut found);
        assert!(found.is_empty());
    }
}
