//! The source line under a message, with a marker below the key or value that it is about.
//!
//! ```text
//! 3 |   "camera": { "fovv": 30 },
//!   |               ^^^^^^
//! ```
//!
//! What a terminal would obey, or what would turn the text round, is replaced before it is shown, and of a long line only
//! the part around the marker is looked at. Right-to-left letters are shown as they are: a terminal that reorders them
//! may show the marker at the other end of their word.

use std::fmt;
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::error::Place;

/// Most columns of a line that are shown. Ours: fits a terminal of 120 columns with the line number.
const WIDTH: usize = 100;

/// Columns before the marker where a line does not fit.
const BEFORE: usize = 40;

/// Columns that stand for a tab, as the renderer writes it.
const TAB_WIDTH: usize = 4;

/// How bad it is: what colour the marker has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// The style does not load.
    Mistake,
    /// It loads.
    Warning,
}

/// The texts of a style and its bases by the names that places have, in the order in which they were read.
///
/// They are kept as long as the style, so that what is noticed later still finds its line: at most
/// [`super::syntax::MAX_BYTES`] for each file.
#[derive(Clone, Default)]
pub struct SourceTexts(Vec<(Arc<str>, Arc<str>)>);

/// How a style was written is no part of what it means.
impl PartialEq for SourceTexts {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for SourceTexts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.0.iter().map(|(name, text)| format!("{name}: {} bytes", text.len()))).finish()
    }
}

impl SourceTexts {
    pub(super) fn new(texts: impl Iterator<Item = (Arc<str>, Arc<str>)>) -> Self {
        Self(texts.collect())
    }

    /// The text of a file, without its byte-order mark.
    pub fn of(&self, file: &str) -> Option<&str> {
        self.0.iter().find(|(name, _)| **name == *file).map(|(_, text)| &**text)
    }

    /// The position of a file among those that were read, for putting messages in order.
    pub fn position(&self, file: &str) -> Option<usize> {
        self.0.iter().position(|(name, _)| **name == *file)
    }

    /// Line and column of the end of a place, both from 1; the place's own where its text is not known.
    pub fn end_of(&self, place: &Place) -> (u32, u32) {
        let marked = self.of(&place.file).and_then(|text| text.get(place.start..place.end)).unwrap_or_default();
        let chars = |text: &str| text.chars().count() as u32;
        match marked.rfind('\n') {
            Some(last) => (place.line + marked.matches('\n').count() as u32, chars(&marked[last + 1..]) + 1),
            None => (place.line, place.column + chars(marked)),
        }
    }

    /// The line of a place and a marker below, without a line break at the end; none for a file as a whole.
    /// `styled`: with the colours of a terminal.
    pub fn source_line(&self, place: &Place, severity: Severity, styled: bool) -> Option<String> {
        let text = self.of(&place.file).filter(|_| place.line > 0)?;
        let excerpt = Excerpt::new(text, place.start, place.end)?;
        let marker = AnnotationKind::Primary.span(excerpt.start..excerpt.end);
        let snippet = Snippet::source(excerpt.shown).line_start(place.line as usize).annotation(marker);
        let level = match severity {
            Severity::Mistake => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let renderer = if styled { Renderer::styled().hyperlink(false) } else { Renderer::plain() };
        // The excerpt is short already; a second cut would lose the marker of wide characters.
        let renderer = renderer.term_width(4 * WIDTH);
        let rendered = renderer.render(&[Group::with_level(level).element(snippet)]);
        // It begins with a line for the eye alone, which a message above it does not need.
        let (_, lines) = rendered.split_once('\n')?;
        Some(lines.trim_end().to_owned())
    }
}

/// The part of a line that is shown, and the bytes of it that are marked.
#[derive(Debug, PartialEq, Eq)]
struct Excerpt {
    shown: String,
    start: usize,
    end: usize,
}

impl Excerpt {
    /// The line at `start`; none if the text ends before that.
    fn new(text: &str, start: usize, end: usize) -> Option<Self> {
        let start = text.floor_char_boundary((start <= text.len()).then_some(start)?);
        let line_break = |c: &char| *c == '\n';
        // Not more than is shown is looked at, on either side: the line may be the whole of a large file.
        let before = Side::new(text[..start].chars().rev().take_while(|c| !line_break(c)));
        // The carriage return of a line break is no part of the line.
        let mut line = text[start..].chars().take_while(|c| !line_break(c)).peekable();
        let after = Side::new(std::iter::from_fn(|| line.next().filter(|c| *c != '\r' || line.peek().is_some())));

        let (fits_before, fits_after) = match before.width + after.width <= WIDTH {
            true => (before.width, after.width),
            false => {
                let fits_after = after.width.min(WIDTH - before.width.min(BEFORE));
                (before.width.min(WIDTH - fits_after), fits_after)
            }
        };
        let (before, is_cut_before) = before.within(fits_before);
        let (after, is_cut_after) = after.within(fits_after);
        let mut shown = String::from(if is_cut_before { "…" } else { "" });
        shown.extend(before.iter().rev().flat_map(|c| printed(*c)));
        let marked_from = shown.len();
        let mut marked_to = marked_from;
        let mut at = start;
        for c in after {
            shown.extend(printed(c));
            at += c.len_utf8();
            // Of a value over several lines, the first one is marked; of nothing at all, one character.
            if at <= end || marked_to == marked_from {
                marked_to = shown.len();
            }
        }
        shown.push_str(if is_cut_after { "…" } else { "" });
        Some(Self { shown, start: marked_from, end: marked_to })
    }
}

/// Characters of a line on one side of the marker's start, nearest first.
struct Side {
    chars: Vec<char>,
    width: usize,
    is_cut: bool,
}

impl Side {
    fn new(chars: impl Iterator<Item = char>) -> Self {
        let mut side = Self { chars: Vec::new(), width: 0, is_cut: false };
        for c in chars {
            // Characters without a width of their own count too, so that no pile of marks is endless.
            side.width += width(c);
            if side.width > WIDTH {
                side.is_cut = true;
                break;
            }
            side.chars.push(c);
        }
        side
    }

    /// The nearest characters that fit, and whether there are more.
    fn within(mut self, columns: usize) -> (Vec<char>, bool) {
        let mut width_so_far = 0;
        let fit = self.chars.iter().take_while(|c| {
            width_so_far += width(**c);
            width_so_far <= columns
        });
        let num_fit = fit.count();
        let is_cut = self.is_cut || num_fit < self.chars.len();
        self.chars.truncate(num_fit);
        (self.chars, is_cut)
    }
}

/// Columns of a character, or more: those from the Hangul letters on may be twice as wide.
fn width(c: char) -> usize {
    match c {
        '\t' => TAB_WIDTH,
        '\u{1100}'.. => 2,
        _ => 1,
    }
}

/// A character as it may stand in a terminal: controls as their pictures, marks that turn the text or hide in it as the
/// replacement character, joiners and variants of what stands before them not at all.
fn printed(c: char) -> Option<char> {
    match c {
        '\t' => Some('\t'),
        '\0'..='\u{1f}' => char::from_u32(0x2400 + u32::from(c)),
        '\u{7f}' => Some('\u{2421}'),
        '\u{200c}' | '\u{200d}' | '\u{fe00}'..='\u{fe0f}' => None,
        '\u{80}'..='\u{9f}'
        | '\u{ad}'
        | '\u{61c}'
        | '\u{180e}'
        | '\u{200b}'..='\u{200f}'
        | '\u{2028}'..='\u{202e}'
        | '\u{2060}'..='\u{206f}'
        | '\u{feff}'
        | '\u{fff9}'..='\u{fffb}'
        | '\u{e0000}'..='\u{e0fff}' => Some('\u{fffd}'),
        c => Some(c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn excerpt(text: &str, marked: &str) -> String {
        let start = text.find(marked).unwrap();
        let Excerpt { shown, start, end } = Excerpt::new(text, start, start + marked.len()).unwrap();
        format!("{}<{}>{}", &shown[..start], &shown[start..end], &shown[end..])
    }

    #[test]
    fn an_excerpt_is_one_line() {
        assert_eq!(excerpt("{\n  \"a\": 1,\n}", "\"a\""), "  <\"a\">: 1,");
        assert_eq!(excerpt("{\r\n  \"a\": 1\r\n}", "1"), "  \"a\": <1>");
        assert_eq!(excerpt("a [\n1,\n2] b", "[\n1,\n2]"), "a <[>");
    }

    #[test]
    fn a_long_line_is_cut_around_the_marker() {
        let text = format!("{}[here]{}", "a".repeat(1000), "b".repeat(1000));
        let shown = excerpt(&text, "[here]");
        assert_eq!(shown, format!("…{}<[here]>{}…", "a".repeat(40), "b".repeat(54)));
        let wide = format!("{}[here]{}", "\u{6c34}".repeat(1000), "\u{6c34}".repeat(1000));
        assert_eq!(excerpt(&wide, "[here]"), format!("…{}<[here]>{}…", "\u{6c34}".repeat(20), "\u{6c34}".repeat(27)));
        // Near an end of the line, the other side gets what this side leaves.
        let text = format!("{}[here]", "a".repeat(1000));
        assert_eq!(excerpt(&text, "[here]"), format!("…{}<[here]>", "a".repeat(94)));
        let text = format!("[{}]", "a".repeat(1000));
        assert_eq!(excerpt(&text, &text), format!("<[{}>…", "a".repeat(99)));
    }

    #[test]
    fn nothing_at_all_is_marked_by_one_column() {
        let ends = |text: &str, at| {
            let excerpt = Excerpt::new(text, at, at);
            excerpt.map(|excerpt| (excerpt.shown, excerpt.start, excerpt.end))
        };
        assert_eq!(ends("ab", 1), Some(("ab".to_owned(), 1, 2)));
        assert_eq!(ends("ab", 2), Some(("ab".to_owned(), 2, 2)));
        assert_eq!(ends("ab\n", 3), Some((String::new(), 0, 0)));
        assert_eq!(ends("", 0), Some((String::new(), 0, 0)));
        assert_eq!(ends("ab", 3), None);
    }

    #[test]
    fn nothing_that_a_terminal_obeys_is_printed() {
        let text: String =
            (0..=0x2fff).chain(0xfe00..=0xffff).chain(0xe_0000..0xe_1000).filter_map(char::from_u32).collect();
        for c in text.chars().filter_map(printed) {
            assert!(c == '\t' || !c.is_control(), "{c:?}");
            assert!(!matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'), "{c:?}");
        }
    }
}
