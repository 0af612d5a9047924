//! What is said of styles on stderr: one line each, the source line below, and colours where a terminal shows them.

use std::fmt::Display;
use std::io::IsTerminal;

use crate::config::{Mistakes, Severity, SourceTexts, Warning};

/// A message without what a terminal would obey: names of files may hold anything.
pub(super) fn clean(message: impl Display) -> String {
    message.to_string().replace(|c: char| c.is_control() && c != '\n', "?")
}

/// All mistakes of a style, each with its source line.
pub(super) fn of_mistakes(mistakes: &Mistakes) -> String {
    let styled = has_colors();
    let mut lines = Vec::new();
    for mistake in &mistakes.list {
        lines.push(clean(mistake));
        lines.extend(mistakes.texts.source_line(&mistake.place, Severity::Mistake, styled));
    }
    if mistakes.unlisted > 0 {
        lines.push(format!("and {} more", mistakes.unlisted));
    }
    lines.join("\n")
}

/// Each warning with its source line, and how many more there are.
pub(super) fn of_warnings(warnings: &[Warning], unlisted: usize, texts: &SourceTexts) -> Vec<String> {
    let styled = has_colors();
    let message = |warning: &Warning| {
        let source_line = texts.source_line(&warning.place, Severity::Warning, styled);
        source_line.map_or_else(|| clean(warning), |source_line| format!("{}\n{source_line}", clean(warning)))
    };
    let more = (unlisted > 0).then(|| format!("and {unlisted} more warnings"));
    warnings.iter().map(message).chain(more).collect()
}

/// Whether stderr shows colours: on a terminal that has them, unless `NO_COLOR` is set; elsewhere if
/// `CLICOLOR_FORCE` asks for them.
fn has_colors() -> bool {
    let value = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    if value("NO_COLOR").is_some() {
        return false;
    }
    value("CLICOLOR_FORCE").is_some_and(|value| value != "0")
        || (std::io::stderr().is_terminal() && value("TERM").is_none_or(|term| term != "dumb"))
}
