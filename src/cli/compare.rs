//! `restyle compare A.png B.png`: how far two pictures are from each other, and where.

use std::fmt;
use std::path::{Path, PathBuf};

use serde_json::{Value as Json, json};

use super::messages::clean;
use super::{Failure, answer, inputs, render};
use crate::config::Srgba;
use crate::measure::metrics::{self, Channels, Comparison, Metrics, Options};
use crate::scene::Image;

/// The end of the help: what the figures mean.
const FIGURES_HELP: &str = "\
Figures:
  rmse         root mean square error of display values, 0 to 1
  max          largest error of display values, 0 to 1: one wrong pixel shows here
  rmse_linear, max_linear
               the same in linear light
  psnr         peak signal-to-noise ratio of display values in dB; inf if nothing differs (in JSON the
               string inf)
  ssim         structural similarity of luma, windows of 11x11 pixels; 1 if nothing differs
  flip         FLIP, how plainly the difference is seen when the pictures alternate, 0 to 1; for a screen of 3840
               pixels and 0.7 m, seen from 0.7 m

They are over the pixels that either picture covers and 2 pixels around them: all that is not wholly transparent, in an
opaque picture all that is not the background. The background is --background, else the colour that all corners of
opaque pictures share; where they share none, and with --all-pixels, every pixel counts.

A picture with transparency is laid over the background in linear light before it is compared. Where no background is
known, as with two transparent pictures, it is laid over black and over white, and the larger error counts.

DIFF.png shows FLIP for each pixel: black where no difference is seen, then purple and orange, to pale yellow for the
plainest.

With --json, one object: a, b, each figure by its name, rmse_rgb and the like by channel, pixels (that count),
all_pixels, and limits_passed, a list of messages.

The exit code is 4 if a --limit is passed: below it for psnr and ssim, above it for all others.";

#[derive(Debug, clap::Args)]
#[command(after_long_help = FIGURES_HELP)]
pub(super) struct Args {
    /// The picture that is right
    #[arg(value_name = "A.png")]
    reference: PathBuf,
    /// The picture to compare with it
    #[arg(value_name = "B.png")]
    test: PathBuf,
    /// Write a picture of where they differ, black where no difference is seen
    #[arg(short, long, value_name = "DIFF.png")]
    output: Option<PathBuf>,
    /// Fail with exit code 4 if a figure is worse than this (repeatable): flip=0.01, psnr=40
    #[arg(long, value_name = "FIGURE=X")]
    limit: Vec<Limit>,
    /// Colour of the background; by default that of the corners (see --help)
    #[arg(long, value_name = "COLOR", value_parser = parse_color)]
    background: Option<[f32; 3]>,
    /// Count every pixel, not only what either picture covers
    #[arg(long)]
    all_pixels: bool,
    /// Print one line of JSON
    #[arg(long)]
    json: bool,
}

/// A figure of a comparison.
struct Figure {
    name: &'static str,
    /// A larger value is a smaller difference.
    is_likeness: bool,
    /// Values that it can have; a psnr has no end.
    range: [f64; 2],
    value: fn(&Metrics) -> f64,
    channels: Option<fn(&Metrics) -> Channels>,
}

const FIGURES: [Figure; 7] = [
    Figure::error("rmse", |metrics| metrics.display.rmse.all, Some(|metrics| metrics.display.rmse)),
    Figure::error("max", |metrics| metrics.display.max.all, Some(|metrics| metrics.display.max)),
    Figure::error("rmse_linear", |metrics| metrics.linear.rmse.all, Some(|metrics| metrics.linear.rmse)),
    Figure::error("max_linear", |metrics| metrics.linear.max.all, Some(|metrics| metrics.linear.max)),
    Figure {
        name: "psnr",
        is_likeness: true,
        range: [0.0, f64::MAX],
        value: |metrics| metrics.psnr_db,
        channels: None,
    },
    Figure { name: "ssim", is_likeness: true, range: [-1.0, 1.0], value: |metrics| metrics.ssim, channels: None },
    Figure::error("flip", |metrics| metrics.flip, None),
];

impl Figure {
    const fn error(
        name: &'static str,
        value: fn(&Metrics) -> f64,
        channels: Option<fn(&Metrics) -> Channels>,
    ) -> Figure {
        Figure { name, is_likeness: false, range: [0.0, 1.0], value, channels }
    }
}

/// How far a figure may go.
#[derive(Debug, Clone, Copy)]
struct Limit {
    /// Its place in [`FIGURES`].
    figure: usize,
    value: f64,
}

impl std::str::FromStr for Limit {
    type Err = String;

    fn from_str(text: &str) -> Result<Limit, String> {
        let names = || FIGURES.map(|figure| figure.name).join(", ");
        let (name, value) =
            text.split_once('=').ok_or_else(|| format!("write it as FIGURE=X, FIGURE one of {}", names()))?;
        let figure = FIGURES.iter().position(|figure| figure.name == name);
        let figure = figure.ok_or_else(|| format!("there is no {name:?}; there are {}", names()))?;
        let [min, max] = FIGURES[figure].range;
        match value.trim().parse() {
            Ok(value) if (min..=max).contains(&value) => Ok(Limit { figure, value }),
            _ if max == f64::MAX => Err(format!("a limit of {name} is a number from {min} up")),
            _ => Err(format!("a limit of {name} is a number from {min} to {max}")),
        }
    }
}

impl Limit {
    /// By how much the figure is worse than the limit, in words, if it is.
    fn passed(&self, metrics: &Metrics) -> Option<String> {
        let figure = &FIGURES[self.figure];
        let value = (figure.value)(metrics);
        let (by, side) = if figure.is_likeness { (self.value - value, "below") } else { (value - self.value, "above") };
        (by > 0.0)
            .then(|| format!("{} is {}, {} {side} the limit of {}", figure.name, Short(value), Short(by), self.value))
    }
}

/// A number of few digits that is never shown as zero unless it is.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0 != 0.0 && self.0.abs() < 1e-5 { write!(f, "{:.1e}", self.0) } else { write!(f, "{:.5}", self.0) }
    }
}

fn parse_color(text: &str) -> Result<[f32; 3], String> {
    match Srgba::parse(text).map(|color| color.rgba) {
        Some([r, g, b, 1.0]) => Ok([r, g, b]),
        Some(_) => Err("a background is opaque: write it as #rrggbb".to_owned()),
        None => Err("a colour is written as #rrggbb or by its CSS name".to_owned()),
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(output) = &args.output {
        render::check_format(output, "png")?;
        render::check_writable(output)?;
        let given = [("first picture", args.reference.as_path()), ("second picture", args.test.as_path())];
        inputs::check_outputs(args.output.iter().cloned(), &given)?;
    }
    let [reference, test] = [&args.reference, &args.test].map(|file| Image::read_png(file).map_err(Failure::input));
    let (reference, test) = (reference?, test?);
    let options = Options { background: args.background, all_pixels: args.all_pixels };
    let comparison = metrics::compare(&reference, &test, &options).map_err(|_| {
        let named = |file: &Path, [width, height]: [u32; 2]| format!("{}: {width}x{height} pixels", file.display());
        let (a, b) = (named(&args.reference, reference.size), named(&args.test, test.size));
        Failure::input(format!("{b}, but {a}; draw both in one size"))
    })?;
    if let Some(output) = &args.output {
        let written = comparison.flip_image().write_png(output);
        written.map_err(|error| Failure::input(render::cannot_write(output, &error)))?;
    }
    if args.json {
        answer(document(args, &comparison))?
    } else {
        answer(clean(table(&comparison)))?
    }
    let passed: Vec<String> = args.limit.iter().filter_map(|limit| limit.passed(&comparison.metrics)).collect();
    if passed.is_empty() {
        return Ok(());
    }
    let (a, b) = (args.reference.display(), args.test.display());
    Err(Failure::above_limit(format!("{b}: is too far from {a}: {}", passed.join("; "))))
}

/// The figures for people, one a line.
fn table(comparison: &Comparison) -> String {
    let metrics = &comparison.metrics;
    let mut lines = vec![format!("{:<12}{:>10}{:>10}{:>10}{:>10}", "", "all", "red", "green", "blue")];
    for figure in &FIGURES {
        let channels = figure.channels.map_or_else(Vec::new, |channels| channels(metrics).rgb.to_vec());
        let unit = if figure.name == "psnr" { " dB" } else { "" };
        let value = match (figure.value)(metrics) {
            value if figure.name == "psnr" => format!("{value:.3}"),
            value => Short(value).to_string(),
        };
        let channels: String = channels.iter().map(|value| format!("{:>10}", Short(*value).to_string())).collect();
        lines.push(format!("{:<12}{value:>10}{unit}{channels}", figure.name));
    }
    let (counted, all) = (metrics.num_pixels, comparison.mask.counts.len());
    lines.push(format!("{:<12}{counted:>10} of {all}", "pixels"));
    lines.join("\n")
}

/// The figures for tools.
fn document(args: &Args, comparison: &Comparison) -> Json {
    let metrics = &comparison.metrics;
    let mut document = json!({
        "a": args.reference.display().to_string(),
        "b": args.test.display().to_string(),
        "pixels": metrics.num_pixels,
        "all_pixels": comparison.mask.counts.len(),
    });
    for figure in &FIGURES {
        // JSON has no infinity.
        document[figure.name] = match (figure.value)(metrics) {
            value if value.is_finite() => value.into(),
            _ => Json::from("inf"),
        };
        if let Some(channels) = figure.channels {
            document[format!("{}_rgb", figure.name)] = channels(metrics).rgb.to_vec().into();
        }
    }
    document["limits_passed"] = args.limit.iter().filter_map(|limit| limit.passed(metrics)).collect::<Vec<_>>().into();
    document
}
