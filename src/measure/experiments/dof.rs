//! `dof`: depth of field, against lines of sight through a whole lens.

use std::rc::Rc;

use serde_json::json;

use crate::engine::{EffectForm, Request};
use crate::measure::boxes::{Cuboid, boxes};
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, Judge, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::{Row, geometric_mean};
use crate::measure::stage::{GpuFrame, Look, Stage, device, shipped_scene};
use crate::scene::{Image, Scene, linear_from_srgb};

const SIZE: [u32; 2] = [256, 256];

/// Places of the lens that the truth looks through.
const LENSES: u32 = 256;

/// The share of light that leaks.
const LEAK: &str = "leakage, %";

/// Below this there is no green in a truth.
const NONE: f64 = 0.002;

/// One scene with its depths and its camera. What is green is in focus, and nothing else has any green.
struct Stand {
    name: &'static str,
    load: fn() -> Result<Scene, MeasureError>,
    layers: &'static str,
    camera: &'static str,
    has_green: bool,
    is_transparent: bool,
}

const PLAIN: Stand =
    Stand { name: "", load: wall, layers: "[0.1, 0.45, 0.6, 1]", camera: "", has_green: true, is_transparent: false };

const STANDS: [Stand; 11] = [
    Stand { name: "near bar before a sharp wall", load: bar, ..PLAIN },
    Stand { name: "near glass before a sharp wall", load: near_glass, ..PLAIN },
    Stand { name: "sharp glass before a blurred wall", load: sharp_glass, layers: "[0, 0, 0.2, 0.5]", ..PLAIN },
    Stand { name: "sharp box before a blurred wall", load: wall, layers: "[0, 0, 0.2, 0.5]", ..PLAIN },
    Stand {
        name: "slanted plane",
        load: plane,
        layers: "[0.2, 0.45, 0.55, 0.8]",
        camera: r#""position": [0, 0.9, 2.6]"#,
        ..PLAIN
    },
    Stand { name: "thin rods near", load: rods, ..PLAIN },
    Stand { name: "bright points", load: points, layers: "[0, 0, 0.2, 0.5]", ..PLAIN },
    Stand {
        name: "transparent background",
        load: || shipped_scene("caffeine"),
        layers: "[0, 0.3, 0.4, 0.8]",
        camera: r#""position": [1.4, 0.5, 2.2]"#,
        has_green: false,
        is_transparent: true,
    },
    Stand {
        name: "orthographic",
        load: wall,
        layers: "[0, 0.05, 0.3, 0.6]",
        camera: r#""orthographic": true, "position": [1.2, 0.8, 2.4]"#,
        ..PLAIN
    },
    Stand {
        name: "molecule",
        load: || shipped_scene("c60"),
        layers: "[0, 0.15, 0.35, 0.8]",
        has_green: false,
        camera: r#""position": [0.8, 0.7, 2.6]"#,
        ..PLAIN
    },
    Stand {
        name: "assembly",
        load: || shipped_scene("gearbox"),
        layers: "[0, 0.2, 0.4, 0.8]",
        has_green: false,
        ..PLAIN
    },
];

/// What draws it: a method, and whether a form that no style has.
struct Kind {
    name: &'static str,
    method: Option<&'static str>,
    form: Option<EffectForm>,
}

const KINDS: [Kind; 4] = [
    Kind { name: "nothing blurred", method: None, form: None },
    Kind { name: "five layers, published", method: Some("five_layer"), form: Some(EffectForm::FOCUS_PUBLISHED) },
    Kind { name: "five layers", method: Some("five_layer"), form: None },
    Kind { name: "gather", method: Some("gather"), form: None },
];
const NOTHING: usize = 0;
const PUBLISHED: usize = 1;
const LAYERS: usize = 2;
const GATHER: usize = 3;

/// Samples a pixel: of a frame, and of a still.
const SAMPLES: [u32; 2] = [1, 16];

/// The experiment.
pub struct Dof;

/// A chequered wall at z = 0, of two parts.
fn chequered(even: &'static str, odd: &'static str) -> Vec<Cuboid> {
    let tile = |index: u32| {
        let [x, y] = [index % 8, index / 8].map(|at| f64::from(at) / 4.0 - 1.0);
        let part = if (index % 8 + index / 8).is_multiple_of(2) { even } else { odd };
        (part, [x, y, -0.05], [x + 0.25, y + 0.25, 0.0])
    };
    (0..64).map(tile).collect()
}

fn bar() -> Result<Scene, MeasureError> {
    let near = ("red", [-0.3, -0.8, 1.15], [0.0, 0.8, 1.2]);
    boxes("bar", &[chequered("green", "blue"), vec![near]].concat())
}

fn near_glass() -> Result<Scene, MeasureError> {
    let near = ("glass", [-0.45, -0.6, 1.15], [0.35, 0.5, 1.2]);
    boxes("near glass", &[chequered("green", "blue"), vec![near]].concat())
}

fn sharp_glass() -> Result<Scene, MeasureError> {
    let sharp = ("glass", [-0.45, -0.6, 1.15], [0.35, 0.5, 1.2]);
    boxes("sharp glass", &[chequered("red", "blue"), vec![sharp]].concat())
}

fn wall() -> Result<Scene, MeasureError> {
    let sharp = ("green", [-0.4, -0.5, 1.1], [0.2, 0.3, 1.2]);
    boxes("wall", &[chequered("red", "blue"), vec![sharp]].concat())
}

fn plane() -> Result<Scene, MeasureError> {
    let stripe = |index: u32| {
        let z = f64::from(index) / 6.0 - 1.75;
        let part = match index {
            10 => "green",
            _ if index.is_multiple_of(2) => "red",
            _ => "blue",
        };
        (part, [-1.0, -0.05, z], [1.0, 0.0, z + 1.0 / 6.0])
    };
    boxes("plane", &(0..21).map(stripe).collect::<Vec<_>>())
}

fn rods() -> Result<Scene, MeasureError> {
    let rod = |index: u32| {
        let at = f64::from(index) * 0.3 - 0.6;
        match index % 2 {
            0 => ("red", [at, -0.8, 1.17], [at + 0.03, 0.8, 1.2]),
            _ => ("red", [-0.8, at, 1.17], [0.8, at + 0.03, 1.2]),
        }
    };
    boxes("rods", &[chequered("green", "blue"), (0..5).map(rod).collect()].concat())
}

fn points() -> Result<Scene, MeasureError> {
    let point = |index: u32| {
        let [x, y] = [index % 5, index / 5].map(|at| f64::from(at) * 0.4 - 0.8);
        ("red", [x, y, -0.03], [x + 0.03, y + 0.03, 0.0])
    };
    let sharp = ("green", [-0.4, -0.5, 1.1], [0.2, 0.3, 1.2]);
    boxes("points", &[(0..25).map(point).collect::<Vec<_>>(), vec![sharp]].concat())
}

fn look(stand: &Stand, kind: &Kind) -> Result<Look, MeasureError> {
    let Stand { name, layers, camera, .. } = stand;
    let (listed, method) = kind.method.map_or(("", ""), |method| (r#""focus""#, method));
    let method = if method.is_empty() { String::new() } else { format!(r#", "method": "{method}""#) };
    let camera = if camera.is_empty() { String::new() } else { format!(", {camera}") };
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "#300060"{camera} }},
              "geometry": {{ "atom": "vdw", "scale": 0.33, "bond_radius": "0.2A" }},
              "mapping": {{ "*": "plain", "mesh[part=red]": "red", "mesh[part=green]": "green", "mesh[part=blue]": "blue",
                "mesh[part=glass]": "glass", "post_effects": [{listed}] }},
              "shaders": [{{ "name": "plain", "shader": "basic" }},
                {{ "name": "red", "shader": "unlit", "properties": {{ "base_color": "#ff0060" }} }},
                {{ "name": "green", "shader": "unlit", "properties": {{ "base_color": "#00ff00" }} }},
                {{ "name": "blue", "shader": "unlit", "properties": {{ "base_color": "#2000a0" }} }},
                {{ "name": "glass", "shader": "unlit", "properties": {{ "base_color": "#ff0060", "opacity": 0.4 }} }},
                {{ "name": "focus", "shader": "dofPost", "properties": {{ "layers": {layers}, "blur": "48pt"{method} }} }}] }}"##
    );
    Look::of_text(&format!("{name} {}", kind.name), &text)
}

/// How much green is found where the truth has none, of all its green.
fn judge() -> Judge {
    Rc::new(|truth, picture| {
        let green = |image: &Image, x, y| {
            let [_, green, _, alpha] = image.pixel(x, y).map(f64::from);
            alpha * linear_from_srgb(green)
        };
        let (mut leaked, mut all) = (0.0, 0.0);
        for (x, y) in (0..truth.size[1]).flat_map(|y| (0..truth.size[0]).map(move |x| (x, y))) {
            let own = green(truth, x, y);
            all += own;
            leaked += if own < NONE { (green(picture, x, y) - own).max(0.0) } else { 0.0 };
        }
        vec![(LEAK, 100.0 * leaked / f64::max(all, 1e-9))]
    })
}

impl Experiment for Dof {
    fn name(&self) -> &'static str {
        "dof"
    }

    fn doc(&self) -> &'static str {
        "How far depth of field is from lines of sight through a whole lens, by method, on eleven scenes, and what it costs."
    }

    fn chart(&self) -> ChartKind {
        ChartKind::CostAgainstError { error: ErrorKind::Flip, per_pixel: false, has_front: true }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            format!(
                "The truth is the reference renderer with {LENSES} lines of sight a pixel, each through its own place of the lens. All \
                 methods and the truth have the same layers, and a blur of 48pt beyond them. Frames have one sample a pixel, stills 16; one \
                 sample has jagged edges, which count as errors."
            ),
            "Leakage is measured where what is in focus is green and nothing else has any: the green that is found where the truth has \
             none, in percent of all its green."
                .to_owned(),
            "Five layers, published, is the form of the paper: layers filled with the background's colour. Accumulation of 256 views is \
             counted as 256 frames without any blur."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let of = |kind: usize, samples: u32| {
            rows.iter()
                .filter(move |row| row.entry.series == KINDS[kind].name && row.entry.extent == f64::from(samples))
        };
        let flip = |kind: usize| {
            let of_each = of(kind, 16).filter_map(|row| ErrorKind::Flip.of(row)).map(|flip| flip.max(1e-4));
            geometric_mean(of_each)
        };
        let leak = |kind: usize| of(kind, 16).filter_map(|row| row.figure(LEAK)).fold(0.0, f64::max);
        let cost = |kind: usize, samples: u32| geometric_mean(of(kind, samples).map(Row::median_ms));
        let accumulated = 256.0 * cost(NOTHING, 1);
        let worst = of(GATHER, 16)
            .filter_map(|row| Some((ErrorKind::Flip.of(row)?, row.entry.scene.as_str())))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let worst = worst.map_or(String::new(), |(flip, scene)| format!("at most {} ({scene})", short(flip)));
        format!(
            "Stills by circles have a mean FLIP of {}, {worst}; the published layers have {}, the mended ones {}. Of what is in focus \
             up to {} % leaks by circles, {} % as published and {} % in mended layers. A frame by circles is {} times as fast as \
             256 views, a still of 16 samples {} times.",
            short(flip(GATHER)),
            short(flip(PUBLISHED)),
            short(flip(LAYERS)),
            short(leak(GATHER)),
            short(leak(PUBLISHED)),
            short(leak(LAYERS)),
            short(accumulated / cost(GATHER, 1)),
            short(accumulated / cost(GATHER, 16)),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let mut cases = Vec::new();
        for stand in &STANDS {
            let scene = (stand.load)()?;
            let stage = Stage::new(gpu, scene.clone());
            let request =
                |samples| Request { wide: true, transparent: stand.is_transparent, ..Request::new(size, samples) };
            let truth = look(stand, &KINDS[GATHER])?.exact(&scene, request(LENSES));
            for kind in &KINDS {
                for samples in SAMPLES {
                    let frame = stage.frame(&look(stand, kind)?, request(samples));
                    cases.push(Case {
                        entry: Entry {
                            scene: stand.name.to_owned(),
                            method: kind.name.to_owned(),
                            settings: settings(json!({ "samples": samples })),
                            series: kind.name.to_owned(),
                            point: samples.to_string(),
                            extent: f64::from(samples),
                            is_published: kind.form.is_some(),
                            size,
                        },
                        subject: Box::new(GpuFrame { forms: kind.form.into_iter().collect(), ..frame }),
                        truth: Some(Rc::clone(&truth)),
                        judge: stand.has_green.then(judge),
                    });
                }
            }
        }
        Ok(cases)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_and_styles_load() {
        for stand in &STANDS {
            (stand.load)().unwrap_or_else(|error| panic!("{}: {error}", stand.name));
            for kind in &KINDS {
                look(stand, kind).unwrap_or_else(|error| panic!("{}, {}: {error}", stand.name, kind.name));
            }
        }
    }
}
