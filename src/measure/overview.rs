//! All experiments in one document: each chart with what it says, as Markdown.

use std::fmt::Write as _;

use super::page::{noise, resolution, rounds};
use super::run::Report;

/// Columns of its text.
const WIDTH: usize = 118;

/// The document; charts are linked as `accuracy/NAME.svg`.
pub fn markdown(reports: &[Report]) -> String {
    let mut page = "# Speed against accuracy\n\n".to_owned();
    let adapters = reports.iter().find_map(|report| Some((report.adapter.as_ref()?, report.driver.as_ref()?)));
    let on =
        adapters.map_or(String::new(), |(adapter, driver)| format!(" They were drawn on {adapter}, driver {driver}."));
    paragraph(
        &mut page,
        &format!(
            "`restyle measure all` draws the same scenes in several ways, times each, holds each against a truth, and writes this page \
             with one chart for each experiment.{on} Times say which way costs more on that adapter; errors depend on neither \
             adapter nor load. In charts of cost and error, large points are geometric means over scenes and small ones the scenes; \
             the dashed line joins what nothing beats in both."
        ),
    );
    for report in reports {
        let (name, doc) = (report.name, report.doc);
        let _ = write!(page, "\n## `{name}`\n\n");
        paragraph(&mut page, doc);
        let _ = write!(page, "\n![{name}](accuracy/{name}.svg)\n\n");
        paragraph(&mut page, &report.says);
        page.push('\n');
        for condition in &report.conditions {
            paragraph(&mut page, condition);
            page.push('\n');
        }
        let adapter = report.adapter.as_deref().unwrap_or("the CPU");
        let partial = if report.is_partial { "; broken off before all was measured" } else { "" };
        let day = report.date.split('T').next().unwrap_or_default();
        let (resolution, rounds, noise) = (resolution(report), rounds(report), noise(report));
        paragraph(&mut page, &format!("On {adapter}, {resolution}, {day}; rounds: {rounds}; noise: {noise}{partial}."));
    }
    page
}

/// Adds text in lines of at most [`WIDTH`] columns, unless a word is longer.
fn paragraph(page: &mut String, text: &str) {
    let mut column = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > WIDTH {
            page.push('\n');
            column = 0;
        } else if column > 0 {
            page.push(' ');
            column += 1;
        }
        page.push_str(word);
        column += length;
    }
    page.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::experiment::ChartKind;

    #[test]
    fn each_experiment_has_its_chart_and_what_it_says() {
        let report = Report {
            name: "speed",
            doc: "How quick it is.",
            chart: ChartKind::TimeByExtent { extent: "atoms" },
            conditions: vec!["One sample a pixel.".to_owned()],
            says: "It is quick. It is right.".to_owned(),
            findings: Vec::new(),
            adapter: Some("a card".to_owned()),
            driver: Some("its driver".to_owned()),
            date: "2026-11-26T01:02:03Z".to_owned(),
            rounds: 2,
            rounds_due: 5,
            is_partial: true,
            seconds: 1.0,
            rows: Vec::new(),
        };
        let page = markdown(&[report]);
        for words in [
            "drawn on a card, driver its driver.",
            "## `speed`\n\nHow quick it is.\n\n![speed](accuracy/speed.svg)\n\nIt is quick. It is right.\n\nOne sample a pixel.\n",
            "2026-11-26; rounds: 2 of 5; noise: one round tells none; broken off before all was measured.",
        ] {
            assert!(page.contains(words), "{words:?} is not in {page}");
        }
    }

    #[test]
    fn paragraphs_are_broken_between_words() {
        let mut page = String::new();
        paragraph(&mut page, &"word ".repeat(60));
        assert!(page.lines().all(|line| line.len() <= WIDTH && !line.ends_with(' ')), "{page}");
        assert_eq!(page.split_whitespace().count(), 60);
    }
}
