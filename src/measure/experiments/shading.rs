//! `shading`: the device against the reference renderer, for every shipped look on six scenes.

use std::rc::Rc;

use serde_json::json;

use crate::engine::Request;
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::{Row, geometric_mean};
use crate::measure::stage::{Look, Stage, device, shipped_scene};
use crate::shipped::LOOKS;

/// A cage, a flat molecule, a helix, a metal between rings, a machine of many parts, and a part with holes.
const SCENES: [&str; 6] = ["c60", "caffeine", "alpha_helix", "ferrocene", "gearbox", "bracket"];

/// With the samples of the truth, as much as three minutes hold.
const SIZE: [u32; 2] = [144, 144];
const SIZE_THOROUGH: [u32; 2] = [256, 256];

/// What counts as near to the truth: no eye tells more on a screen.
const NEAR_FLIP: f64 = 0.01;
const NEAR_DB: f64 = 40.0;

/// The experiment.
pub struct Shading;

/// Samples a pixel of the truth.
fn truth_samples(setup: &Setup) -> u32 {
    if setup.thorough { 256 } else { 64 }
}

/// Samples a pixel of the device.
fn samples(setup: &Setup) -> &'static [u32] {
    if setup.thorough { &[1, 4, 16, 64] } else { &[1, 4, 16] }
}

impl Experiment for Shading {
    fn name(&self) -> &'static str {
        "shading"
    }

    fn doc(&self) -> &'static str {
        "How far pictures of the device are from exact ray casts, for every shipped look on six scenes, by samples per pixel."
    }

    fn chart(&self) -> ChartKind {
        ChartKind::CostAgainstError { error: ErrorKind::Flip, per_pixel: false, has_front: false }
    }

    fn conditions(&self, setup: &Setup) -> Vec<String> {
        vec![
            format!(
                "The truth is the reference renderer with {} samples a pixel: exact spheres, cylinders, triangles and shadows, \
                 and the environment integrated without tables.",
                truth_samples(setup)
            ),
            "Post effects are off in both. Errors are over the pixels that either picture covers and 2 pixels around them."
                .to_owned(),
            "In the chart, a large point is one look with one number of samples: the geometric mean over the six scenes, \
             which are the small points."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let samples = |row: &Row| row.entry.extent;
        let flip = |row: &Row| row.error.as_ref().map_or(f64::NAN, |error| error.flip);
        let [least, most] = [f64::min, f64::max].map(|choose| rows.iter().map(samples).fold(f64::NAN, choose));
        let with = |count: f64| rows.iter().filter(move |row| samples(row) == count && row.error.is_some());
        let errors = [least, most].map(|count| geometric_mean(with(count).map(flip)));
        let costs = [least, most].map(|count| geometric_mean(with(count).map(Row::median_ms)));
        let mut looks: Vec<(f64, &str)> = LOOKS
            .iter()
            .map(|look| (geometric_mean(with(most).filter(|row| row.entry.series == look.name).map(flip)), look.name))
            .collect();
        looks.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (Some(best), Some(worst)) = (looks.first(), looks.last()) else { return String::new() };
        let is_near = |row: &&Row| row.error.as_ref().is_some_and(|e| e.flip <= NEAR_FLIP && e.psnr_db >= NEAR_DB);
        let furthest = with(most).max_by(|a, b| flip(a).total_cmp(&flip(b)));
        let furthest = furthest.map_or(String::new(), |row| {
            format!("; the furthest is {} in {} (FLIP {})", row.entry.scene, row.entry.series, short(flip(row)))
        });
        format!(
            "From {least} to {most} samples the error falls to {} % of what it was, at {} times the cost. With {most} samples the \
             mean FLIP of a look goes from {} ({}) to {} ({}), and {} of {} pictures keep to FLIP {NEAR_FLIP} and {NEAR_DB} dB at \
             once{furthest}.",
            short(100.0 * errors[1] / errors[0]),
            short(costs[1] / costs[0]),
            short(best.0),
            best.1,
            short(worst.0),
            worst.1,
            with(most).filter(is_near).count(),
            with(most).count(),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(if setup.thorough { SIZE_THOROUGH } else { SIZE });
        let mut cases = Vec::new();
        for name in SCENES {
            let scene = shipped_scene(name)?;
            let stage = Stage::new(gpu, scene.clone());
            for shipped in LOOKS {
                let look = Look::shipped(shipped)?.without_effects();
                let truth = look.exact(&scene, Request::new(size, truth_samples(setup)));
                for &samples in samples(setup) {
                    let settings = settings(json!({ "look": shipped.name, "samples": samples }));
                    cases.push(Case {
                        entry: Entry {
                            scene: name.to_owned(),
                            method: "gpu".to_owned(),
                            settings,
                            series: shipped.name.to_owned(),
                            point: samples.to_string(),
                            extent: f64::from(samples),
                            is_published: false,
                            size,
                        },
                        subject: Box::new(stage.frame(&look, Request::new(size, samples))),
                        truth: Some(Rc::clone(&truth)),
                        judge: None,
                    });
                }
            }
        }
        Ok(cases)
    }
}
