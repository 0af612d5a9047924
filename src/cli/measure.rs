//! `restyle measure EXPERIMENT|all`: runs experiments, and writes figures, charts and pages.

use std::fs::{self, File};
use std::io::{self, IsTerminal};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use indicatif::{ProgressBar, ProgressStyle};

use super::exact::stopped_by_interrupt;
use super::inputs::Size;
use super::render::cannot_write;
use super::{Failure, answer};
use crate::engine::Gpu;
use crate::measure::page::{self, PageError, best_and_worst};
use crate::measure::{EXPERIMENTS, Experiment, MeasureError, Report, Setup, find, run as run_experiment};

/// The largest side of a picture, in pixels: with truths of 256 samples it takes days already.
const MOST_SIDE: u32 = 4096;

/// The end of the help: the experiments.
fn experiments_help() -> String {
    let lines = EXPERIMENTS.iter().map(|experiment| format!("  {:<12} {}", experiment.name(), experiment.doc()));
    format!(
        "Experiments:\n{}\n\nEach writes DIR/EXPERIMENT/ with EXPERIMENT.json, chart.svg and index.html, and takes at most about 3 \
         minutes on two\ncores; rounds are left out where time is short. With --thorough it takes as long as it takes: more samples, \
         larger\nscenes, 15 rounds. What was measured when a run is broken off is written, marked as partial.",
        lines.collect::<Vec<_>>().join("\n")
    )
}

#[derive(Debug, clap::Args)]
#[command(after_help = experiments_help())]
pub(super) struct Args {
    /// An experiment, or all of them
    experiment: String,
    /// The folder to write to; it is made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "measure")]
    output: PathBuf,
    /// More cases, samples and rounds, however long they take
    #[arg(long)]
    thorough: bool,
    /// Width and height of pictures in pixels; by default what each experiment takes
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let experiments = chosen(&args.experiment)?;
    if let Some(Size(size)) = args.size.filter(|size| size.0.iter().any(|side| *side > MOST_SIDE)) {
        let [width, height] = size;
        return Err(Failure::usage(format!(
            "--size {width}x{height}: pictures are at most {MOST_SIDE}x{MOST_SIDE} here"
        )));
    }
    let needs_gpu = experiments.iter().any(|experiment| experiment.needs_gpu());
    let gpu = if needs_gpu { Some(Arc::new(Gpu::open()?)) } else { None };
    for experiment in &experiments {
        check_folder(&args.output.join(experiment.name()))?;
    }
    let setup = Setup { gpu, size: args.size.map(|size| size.0), thorough: args.thorough };
    let stop = stopped_by_interrupt();
    let go_on = || if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };

    let mut reports: Vec<Report> = Vec::new();
    for experiment in &experiments {
        let bar = bar(experiment.name());
        let report = run_experiment(
            *experiment,
            &setup,
            &mut |done, of| {
                bar.set_length(of);
                bar.set_position(done);
            },
            &go_on,
        );
        bar.finish_and_clear();
        let report = report.map_err(failure)?;
        let page = page::write(&report, &args.output).map_err(cannot_write_page)?;
        answer(format_args!("{}: {}; open {}", report.name, best_and_worst(&report), page.display()))?;
        let is_partial = report.is_partial;
        reports.push(report);
        if is_partial {
            break;
        }
    }
    if args.experiment == "all" {
        let index = page::write_overview(&reports, &args.output).map_err(cannot_write_page)?;
        answer(format_args!("{} experiments; open {}", reports.len(), index.display()))?;
    }
    match reports.last().filter(|report| report.is_partial) {
        Some(report) => {
            let message =
                format!("interrupted: what was measured of {} until then is written, as partial", report.name);
            Err(Failure { message, ..Failure::interrupted() })
        }
        None => Ok(()),
    }
}

/// The experiments of a name.
fn chosen(name: &str) -> Result<Vec<&'static dyn Experiment>, Failure> {
    if name == "all" {
        return Ok(EXPERIMENTS.to_vec());
    }
    find(name).map(|experiment| vec![experiment]).ok_or_else(|| {
        let names: Vec<&str> = EXPERIMENTS.iter().map(|experiment| experiment.name()).collect();
        let nearest = names.iter().map(|known| (strsim::damerau_levenshtein(known, name), known)).min();
        let nearest = nearest.filter(|(distance, known)| *distance <= known.len() / 2);
        let hint = nearest.map_or(String::new(), |(_, known)| format!("did you mean {known:?}? "));
        Failure::usage(format!("{name:?}: no such experiment; {hint}there are {}, all", names.join(", ")))
    })
}

/// Makes a folder, and finds out whether files can be written there before minutes are spent.
fn check_folder(folder: &Path) -> Result<(), Failure> {
    let refused = |error: io::Error| Failure::input(cannot_write(folder, &error));
    fs::create_dir_all(folder).map_err(refused)?;
    let probe = folder.join(format!(".restyle-{}-probe.part", std::process::id()));
    let made = File::create(&probe).map(drop);
    let _ = fs::remove_file(&probe);
    made.map_err(refused)
}

/// The progress of an experiment, for people only.
fn bar(name: &'static str) -> ProgressBar {
    if !io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(1);
    let look = ProgressStyle::with_template("{msg} {bar:40} {percent} %, {elapsed}");
    bar.set_style(look.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar.set_message(name);
    bar
}

fn failure(error: MeasureError) -> Failure {
    match error {
        MeasureError::Gpu(error) => error.into(),
        error => Failure::input(error),
    }
}

fn cannot_write_page(error: PageError) -> Failure {
    match error {
        PageError::File(path, error) => Failure::input(cannot_write(&path, &error)),
        PageError::Chart(error) => failure(error),
    }
}
