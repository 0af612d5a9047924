//! `shading`: the device against the reference renderer, for every shipped look on six scenes.

use std::rc::Rc;

use serde_json::json;

use crate::engine::Request;
use crate::measure::experiment::{Case, ChartKind, ErrorKind, Experiment, MeasureError, Setup};
use crate::measure::stage::{GpuFrame, Stage, device, exact, look, shipped_scene, without_effects};
use crate::shipped::LOOKS;

/// A cage, a flat molecule, a helix, a metal between rings, a machine of many parts, and a part with holes.
const SCENES: [&str; 6] = ["c60", "caffeine", "alpha_helix", "ferrocene", "gearbox", "bracket"];

/// With the samples of the truth, as much as three minutes hold.
const SIZE: [u32; 2] = [144, 144];
const SIZE_THOROUGH: [u32; 2] = [256, 256];

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
        ChartKind::CostAgainstError { error: ErrorKind::Flip, per_pixel: false }
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

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(if setup.thorough { SIZE_THOROUGH } else { SIZE });
        let mut cases = Vec::new();
        for name in SCENES {
            let scene = shipped_scene(name)?;
            let stage = Stage::new(gpu, scene.clone());
            for shipped in LOOKS {
                let style = without_effects(look(shipped)?);
                let truth = exact(scene.clone(), style.clone(), Request::new(size, truth_samples(setup)));
                let (style_name, style) = (Rc::from(shipped.name), Rc::new(style));
                for &samples in samples(setup) {
                    let settings = json!({ "look": shipped.name, "samples": samples });
                    cases.push(Case {
                        scene: name.to_owned(),
                        method: "gpu".to_owned(),
                        settings: settings.as_object().cloned().unwrap_or_default(),
                        series: shipped.name.to_owned(),
                        point: samples.to_string(),
                        extent: f64::from(samples),
                        is_published: false,
                        size,
                        subject: Box::new(GpuFrame {
                            stage: Rc::clone(&stage),
                            style_name: Rc::clone(&style_name),
                            style: Rc::clone(&style),
                            request: Request::new(size, samples),
                        }),
                        truth: Some(Rc::clone(&truth)),
                    });
                }
            }
        }
        Ok(cases)
    }
}
