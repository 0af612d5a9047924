//! Texts with `*` (any characters, also none) and `?` (one character).

/// A text with `*` and `?`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Glob {
    pattern: String,
    /// Neither `*` nor `?`: a plain comparison does.
    is_plain: bool,
}

impl Glob {
    pub(super) fn new(pattern: &str) -> Self {
        Self { pattern: pattern.to_owned(), is_plain: is_plain(pattern) }
    }

    pub(super) fn pattern(&self) -> &str {
        &self.pattern
    }

    /// Whether the whole text matches.
    pub(super) fn matches(&self, text: &str, ignore_case: bool) -> bool {
        match (self.is_plain, ignore_case) {
            (true, true) => self.pattern.eq_ignore_ascii_case(text),
            (true, false) => self.pattern == text,
            (false, true) => glob_matches(&self.pattern.to_ascii_lowercase(), &text.to_ascii_lowercase()),
            (false, false) => glob_matches(&self.pattern, text),
        }
    }
}

/// Whether a pattern has no wildcard, and matches its own text alone.
pub(super) fn is_plain(pattern: &str) -> bool {
    !pattern.contains(['*', '?'])
}

/// The same glob in its one shape: of neighbouring wildcards, all `?` stand before a single `*`.
pub(super) fn normal(pattern: &str) -> String {
    let mut normal = String::with_capacity(pattern.len());
    let mut star = false;
    for c in pattern.chars() {
        if c == '*' {
            star = true;
            continue;
        }
        if c != '?' && std::mem::take(&mut star) {
            normal.push('*');
        }
        normal.push(c);
    }
    if star {
        normal.push('*');
    }
    normal
}

/// Each `*` first takes nothing, then one character more whenever the rest fails; only the last `*` ever needs to
/// grow, which bounds the work by the product of the lengths.
pub(super) fn glob_matches(pattern: &str, text: &str) -> bool {
    let (mut p, mut t) = (pattern, text);
    // The pattern after the last star, and the text that it was last tried on.
    let mut star: Option<(&str, &str)> = None;
    loop {
        let mut after = p.chars();
        match (after.next(), t.chars().next()) {
            (Some('*'), _) => {
                p = after.as_str();
                star = Some((p, t));
                continue;
            }
            (Some(want), Some(have)) if want == '?' || want == have => {
                p = after.as_str();
                t = &t[have.len_utf8()..];
                continue;
            }
            (None, None) => return true,
            _ => {}
        }
        let Some((after_star, tried)) = star else {
            return false;
        };
        let Some(skipped) = tried.chars().next() else {
            return false;
        };
        let rest = &tried[skipped.len_utf8()..];
        star = Some((after_star, rest));
        (p, t) = (after_star, rest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_wildcards_have_one_shape() {
        for (pattern, expected) in
            [("", ""), ("a**b", "a*b"), ("*?*", "?*"), ("?*?a*", "??*a*"), ("a*?", "a?*"), ("CA", "CA"), ("***", "*")]
        {
            assert_eq!(normal(pattern), expected, "{pattern}");
        }
    }

    #[test]
    fn globs_match_whole_values() {
        for (pattern, text, expected) in [
            ("", "", true),
            ("*", "", true),
            ("?", "", false),
            ("Housing*", "Housing_2", true),
            ("*a*b*", "xxaxxbxx", true),
            ("*ab", "aab", true),
            ("a?c", "a\u{e9}c", true),
            ("a?c", "ac", false),
            ("*\u{1F600}", "x\u{1F600}", true),
            ("a*b", "ab ", false),
        ] {
            assert_eq!(glob_matches(pattern, text), expected, "{pattern} on {text}");
        }
        let hostile = "*a".repeat(200);
        assert!(!glob_matches(&hostile, &("a".repeat(2000) + "b")));
    }
}
