//! `restyle check STYLE...`: all that is wrong with style files, what is odd about them, and what they come to.

use clap::ValueEnum;
use serde_json::{Value as Json, json};

use super::messages::{self, clean};
use super::{Failure, answer, inputs, print_message, tell};
use crate::config::{Hint, MOST_LISTED, Mistakes, Place, SourceTexts, Style, Warning, explain};
use crate::engine::lint;
use crate::scene::{LoadOptions, Scene};

/// The end of the help: what a tool can rely on.
const JSON_HELP: &str = "\
Mistakes and warnings go to stderr, one line for each style to stdout. The exit code is 1 if any style has mistakes.

With --format json, stdout has one list, with an object for each STYLE:
  file         as it was named
  ok           whether it loads
  mistakes     a list of messages
  warnings     a list of messages
  unlisted     how many more mistakes there are than the 100 that are listed
  unlisted_warnings
  explain      with --explain, if it loads: camera, geometry, transparency, lights, shaders, mapping (the rule that
               wins first), post_effects; each value with its unit, its origin (a place or \"default\") and the place in
               a base that it is written over
A message is an object:
  code         the kind, such as \"unknown_key\"
  file, path   the file that it is about, maybe a base, and the JSON path in it
  line, column, end_line, end_column
               from 1, columns in characters, the end behind the last; null for the file as a whole
  start, end   the same in bytes from the start of the file, a byte-order mark not counted
  message      what is wrong
  suggestion   the nearest word that is allowed, or null
  allowed      the words that are allowed, if they are few";

#[derive(Debug, clap::Args)]
#[command(after_long_help = JSON_HELP)]
pub(super) struct Args {
    /// Style files or names of shipped looks
    #[arg(required = true, value_name = "STYLE")]
    styles: Vec<String>,
    /// Also look at each style with this scene: a file or the name of a shipped one (repeatable, all drawn at once)
    #[arg(long)]
    scene: Vec<String>,
    /// Say what each style comes to: every value with its file, line and column
    #[arg(long)]
    explain: bool,
    /// Text for people, or one JSON document (described under --help)
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

/// What is said of one style.
struct Findings {
    file: String,
    /// The style, or why there is none.
    style: Result<Style, Mistakes>,
    warnings: Vec<Warning>,
    unlisted_warnings: usize,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let options = LoadOptions::default();
    let scene = if args.scene.is_empty() {
        None
    } else {
        let scene = inputs::load_scenes(&args.scene, &options)?.scene;
        inputs::scene_warnings(&scene, &args.scene).into_iter().for_each(tell);
        Some(scene)
    };
    let mut documents = Vec::new();
    let mut all_ok = true;
    for name in &args.styles {
        let findings = check(name, scene.as_ref());
        all_ok &= findings.style.is_ok();
        match args.format {
            Format::Text => findings.print(args.explain)?,
            Format::Json => documents.push(findings.to_json(args.explain)),
        }
    }
    if args.format == Format::Json {
        answer(format_args!("{:#}", Json::Array(documents)))?;
    }
    if all_ok { Ok(()) } else { Err(Failure::told()) }
}

fn check(name: &str, scene: Option<&Scene>) -> Findings {
    let mut style = inputs::check_style(name);
    let (mut warnings, mut unlisted_warnings) = match &mut style {
        Ok(style) => (std::mem::take(&mut style.warnings), style.unlisted_warnings),
        Err(mistakes) => (std::mem::take(&mut mistakes.warnings), mistakes.unlisted_warnings),
    };
    if let Ok(style) = &style {
        warnings.extend(match scene {
            Some(scene) => lint::lint_with(style, scene),
            None => lint::lint(style),
        });
        let order = |place: &Place| (style.texts.position(&place.file), place.start);
        warnings.sort_by_key(|warning| order(&warning.place));
        unlisted_warnings += warnings.len().saturating_sub(MOST_LISTED);
        warnings.truncate(MOST_LISTED);
    }
    Findings { file: name.to_owned(), style, warnings, unlisted_warnings }
}

impl Findings {
    fn texts(&self) -> &SourceTexts {
        match &self.style {
            Ok(style) => &style.texts,
            Err(mistakes) => &mistakes.texts,
        }
    }

    /// Messages to stderr; one line to stdout, and what the style comes to.
    fn print(&self, with_explanation: bool) -> Result<(), Failure> {
        if let Err(mistakes) = &self.style {
            print_message(&messages::of_mistakes(mistakes));
        }
        for message in messages::of_warnings(&self.warnings, self.unlisted_warnings, self.texts()) {
            print_message(&message);
        }
        let num_warnings = self.warnings.len() + self.unlisted_warnings;
        let state = match &self.style {
            Ok(_) => "fine".to_owned(),
            Err(mistakes) => counted(mistakes.list.len() + mistakes.unlisted, "mistake"),
        };
        let also = if num_warnings > 0 { format!(", {}", counted(num_warnings, "warning")) } else { String::new() };
        answer(clean(format_args!("{}: {state}{also}", self.file)))?;
        match &self.style {
            Ok(style) if with_explanation => answer(clean(explain::text(style).trim_end())),
            _ => Ok(()),
        }
    }

    fn to_json(&self, with_explanation: bool) -> Json {
        let texts = self.texts();
        let warning = |warning: &Warning| {
            let notice = &warning.notice;
            message(&warning.place, texts, notice.code(), notice.to_string(), notice.hint())
        };
        let warnings: Vec<Json> = self.warnings.iter().map(warning).collect();
        let (mistakes, unlisted) = match &self.style {
            Ok(_) => (Vec::new(), 0),
            Err(mistakes) => {
                let list = mistakes.list.iter().map(|mistake| {
                    let problem = &mistake.problem;
                    message(&mistake.place, texts, problem.code(), problem.to_string(), problem.hint())
                });
                (list.collect(), mistakes.unlisted)
            }
        };
        let mut document = json!({
            "file": self.file,
            "ok": self.style.is_ok(),
            "mistakes": mistakes,
            "warnings": warnings,
            "unlisted": unlisted,
            "unlisted_warnings": self.unlisted_warnings,
        });
        if let (true, Ok(style)) = (with_explanation, &self.style) {
            document["explain"] = explain::json(style);
        }
        document
    }
}

/// One mistake or warning, as the help describes it.
fn message(place: &Place, texts: &SourceTexts, code: &str, message: String, hint: Option<&Hint>) -> Json {
    let of_whole_file = place.line == 0;
    let (end_line, end_column) = texts.end_of(place);
    let unless_whole = |number: usize| (!of_whole_file).then_some(number);
    json!({
        "code": code,
        "file": &*place.file,
        "path": place.path,
        "line": unless_whole(place.line as usize),
        "column": unless_whole(place.column as usize),
        "end_line": unless_whole(end_line as usize),
        "end_column": unless_whole(end_column as usize),
        "start": unless_whole(place.start),
        "end": unless_whole(place.end),
        "message": message,
        "suggestion": hint.and_then(|hint| hint.nearest.as_deref()),
        "allowed": hint.map(|hint| hint.allowed.as_slice()).unwrap_or_default(),
    })
}

/// `1 mistake`, `2 mistakes`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
