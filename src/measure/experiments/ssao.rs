//! `ssao`: ambient occlusion in screen space, against rays.

use std::rc::Rc;

use serde_json::json;

use crate::engine::{EffectForm, Request};
use crate::measure::boxes::boxes;
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, Judge, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::{Row, geometric_mean};
use crate::measure::stage::{GpuFrame, Look, Stage, device, scene, shipped_scene};
use crate::scene::{Image, Scene, linear_from_srgb};

const SIZE: [u32; 2] = [256, 256];

/// The error of the chart, and what else is asked of a picture.
const RMSE: &str = "RMSE of occlusion";
const HALO: &str = "false halo, %";

/// Occlusion below this is none, and occlusion above that is seen.
const NONE: f64 = 0.005;
const SEEN: f64 = 0.05;
/// What a picture without any error counts as in a geometric mean.
const LEAST_RMSE: f64 = 1e-3;

/// One scene with the radius that counts there and its camera.
struct Stand {
    name: &'static str,
    load: fn() -> Result<Scene, MeasureError>,
    radius: &'static str,
    camera: &'static str,
    geometry: &'static str,
}

const STANDS: [Stand; 9] = [
    Stand { name: "pocket", load: pocket, radius: "3r", camera: "", geometry: r#""atom": "vdw", "scale": 1"# },
    Stand { name: "ball and stick", load: || shipped_scene("c60"), radius: "4r", camera: "", geometry: "" },
    Stand {
        name: "rod before a wall",
        load: rod,
        radius: "0.3",
        camera: r#""position": [0.9, 0.5, 2.8]"#,
        geometry: "",
    },
    Stand {
        name: "ball far before a wall",
        load: ball,
        radius: "0.15",
        camera: r#""position": [0.7, 0.4, 2.8]"#,
        geometry: "",
    },
    Stand {
        name: "grazing plane",
        load: plane,
        radius: "0.3",
        camera: r#""position": [0.3, 0.25, 2.6]"#,
        geometry: "",
    },
    Stand { name: "crevice", load: crevice, radius: "0.6", camera: r#""position": [0.4, 1.8, 2.2]"#, geometry: "" },
    Stand { name: "assembly", load: || shipped_scene("gearbox"), radius: "0.15", camera: "", geometry: "" },
    Stand {
        name: "border of the picture",
        load: pocket,
        radius: "3r",
        camera: r#""zoom": 3"#,
        geometry: r#""atom": "vdw", "scale": 1"#,
    },
    Stand {
        name: "orthographic",
        load: || shipped_scene("alpha_helix"),
        radius: "4r",
        camera: r#""orthographic": true"#,
        geometry: "",
    },
];

/// What finds it: a method, its samples, and whether a form that no style has.
struct Kind {
    name: &'static str,
    method: &'static str,
    samples: &'static [u32],
    form: Option<EffectForm>,
}

const KINDS: [Kind; 6] = [
    Kind {
        name: "hemisphere, published",
        method: "hemisphere",
        samples: &[16],
        form: Some(EffectForm::OCCLUSION_PUBLISHED),
    },
    Kind {
        name: "hemisphere, turned",
        method: "hemisphere",
        samples: &[16],
        form: Some(EffectForm::OCCLUSION_ROTATED),
    },
    Kind { name: "hemisphere", method: "hemisphere", samples: &[4, 8, 16, 32, 64, 256], form: None },
    Kind { name: "gtao", method: "gtao", samples: &[4, 8, 16, 32, 64], form: None },
    Kind { name: "bitmask", method: "bitmask", samples: &[4, 8, 16, 32, 64], form: None },
    Kind {
        name: "bitmask, every pixel",
        method: "bitmask",
        samples: &[4, 8, 16, 32, 64],
        form: Some(EffectForm::OCCLUSION_FINE),
    },
];

/// The experiment.
pub struct Ssao;

/// Balls of carbon packed around a hole.
fn pocket() -> Result<Scene, MeasureError> {
    let mut lines = Vec::new();
    for index in 0..343 {
        let [x, y, z] = [index % 7, index / 7 % 7, index / 49].map(|at| f64::from(at) - 3.0);
        // Face-centred, with a hole that opens to the viewer.
        let (x, y, z) = (x + 0.5 * z.rem_euclid(2.0), y + 0.5 * z.rem_euclid(2.0), 0.72 * z);
        if x * x + y * y > 2.2 || z < -1.0 {
            lines.push(format!("C {:.3} {:.3} {:.3}", 3.2 * x, 3.2 * y, 3.2 * z));
        }
    }
    scene("pocket.xyz", format!("{}\n\n{}\n", lines.len(), lines.join("\n")).as_bytes())
}

fn rod() -> Result<Scene, MeasureError> {
    boxes("rod", &[("box", [-1.0, -1.0, -0.1], [1.0, 1.0, 0.0]), ("box", [-0.9, -0.03, 0.15], [0.9, 0.03, 0.21])])
}

fn ball() -> Result<Scene, MeasureError> {
    boxes("far", &[("box", [-1.0, -1.0, -0.1], [1.0, 1.0, 0.0]), ("box", [-0.2, -0.2, 0.8], [0.2, 0.2, 1.2])])
}

fn plane() -> Result<Scene, MeasureError> {
    boxes("plane", &[("box", [-1.0, -0.05, -1.5], [1.0, 0.0, 1.5]), ("box", [-0.2, 0.0, -0.4], [0.2, 0.4, 0.0])])
}

fn crevice() -> Result<Scene, MeasureError> {
    boxes(
        "crevice",
        &[
            ("box", [-1.0, -0.1, -1.0], [1.0, 0.0, 1.0]),
            ("box", [-1.0, 0.0, -1.0], [-0.12, 0.6, 1.0]),
            ("box", [0.12, 0.0, -1.0], [1.0, 0.6, 1.0]),
        ],
    )
}

fn look(stand: &Stand, kind: Option<(&Kind, u32)>) -> Result<Look, MeasureError> {
    let Stand { name, radius, camera, geometry, .. } = stand;
    let radius = if radius.ends_with('r') { format!("{radius:?}") } else { (*radius).to_owned() };
    let method =
        kind.map_or(String::new(), |(kind, samples)| format!(r#", "method": "{}", "samples": {samples}"#, kind.method));
    let camera = if camera.is_empty() { String::new() } else { format!(", {camera}") };
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "white"{camera} }}, "geometry": {{ {geometry} }},
              "mapping": {{ "*": "white", "post_effects": ["ao"] }},
              "shaders": [{{ "name": "white", "shader": "unlit", "properties": {{ "base_color": "white" }} }},
                {{ "name": "ao", "shader": "ssaoPost", "properties": {{ "radius": {radius}{method} }} }}] }}"##
    );
    Look::of_text(&format!("{name} {method}"), &text)
}

/// The occlusion of each pixel of a picture of white objects.
fn occlusion(image: &Image) -> impl Iterator<Item = f64> {
    let [width, height] = image.size;
    (0..height).flat_map(move |y| (0..width).map(move |x| 1.0 - linear_from_srgb(f64::from(image.pixel(x, y)[1]))))
}

/// Compares occlusion where objects are, which the ids of the scene do not say: where either picture is darkened, and so where
/// an error can be; the halo is a share of all pixels.
fn judge() -> Judge {
    Rc::new(|truth, picture| {
        let pairs = || occlusion(truth).zip(occlusion(picture));
        let is_seen = |(a, b): &(f64, f64)| *a > NONE || *b > NONE;
        let (sum, count) =
            pairs().filter(is_seen).fold((0.0, 0usize), |(sum, count), (a, b)| (sum + (a - b) * (a - b), count + 1));
        let halo = pairs().filter(|(truth, drawn)| *truth <= NONE && *drawn > SEEN).count();
        let bias = pairs().filter(is_seen).map(|(truth, drawn)| drawn - truth).sum::<f64>() / count.max(1) as f64;
        vec![
            (RMSE, (sum / count.max(1) as f64).sqrt()),
            ("bias", bias),
            (HALO, 100.0 * halo as f64 / pairs().count().max(1) as f64),
        ]
    })
}

impl Experiment for Ssao {
    fn name(&self) -> &'static str {
        "ssao"
    }

    fn doc(&self) -> &'static str {
        "How far ambient occlusion in screen space is from rays, by method and samples, on nine scenes, and what it costs."
    }

    fn chart(&self) -> ChartKind {
        let error = ErrorKind::Figure { name: RMSE, title: "error: RMSE of occlusion, 0 to 1" };
        ChartKind::CostAgainstError { error, per_pixel: false, has_front: true }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            "Objects are white and unlit, so that pictures are 1 minus occlusion. The truth is the reference renderer with 512 rays from \
             what each pixel's centre sees; pictures have one sample a pixel. Radii are what each scene's parts ask for."
                .to_owned(),
            format!(
                "RMSE and bias are over pixels of which truth or picture have an occlusion above {NONE}, false halo the share of all \
                 pixels where the truth has none and the picture more than {SEEN}."
            ),
            "Hemisphere, published, is the form of the paper, with neither a check of the range nor points kept to the normal's side; \
             turned has Engel's rotations instead of mirrored points, with both mends."
                .to_owned(),
            "Bitmask and gtao look around one pixel of four where a frame has one sample; every pixel: around each, as in stills of \
             more samples."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let figure = |row: &Row, name: &str| row.figure(name).unwrap_or(f64::NAN);
        let of = |kind: usize, samples: u32| {
            rows.iter()
                .filter(move |row| row.entry.series == KINDS[kind].name && row.entry.extent == f64::from(samples))
        };
        let error =
            |kind: usize, samples: u32| geometric_mean(of(kind, samples).map(|row| figure(row, RMSE).max(LEAST_RMSE)));
        let cost = |kind: usize, samples: u32| geometric_mean(of(kind, samples).map(Row::median_ms));
        let (published, mended) = ((error(0, 16), cost(0, 16)), (error(2, 16), cost(2, 16)));
        let quick = KINDS[4].samples.iter().rev().find(|samples| cost(4, **samples) <= mended.1);
        let quick = quick.map_or("no setting of bitmask is as quick".to_owned(), |samples| {
            let ratio = error(4, *samples) / mended.0;
            format!("bitmask with {samples}, which takes no longer, has {} times that", short(ratio))
        });
        let halo = |kind: usize| of(kind, 16).map(|row| figure(row, HALO)).fold(0.0, f64::max);
        format!(
            "With 16 points the published form has an RMSE of {}, the mended one {}; {quick}, and with 16 taps {} at {} times the time. \
             False halos cover up to {} % of a picture as published, {} % mended and {} % with bitmask; 256 points still have an RMSE of {}.",
            short(published.0),
            short(mended.0),
            short(error(4, 16)),
            short(cost(4, 16) / mended.1),
            short(halo(0)),
            short(halo(2)),
            short(halo(4)),
            short(error(2, 256)),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let wide = |samples| Request { wide: true, ..Request::new(size, samples) };
        let mut cases = Vec::new();
        for stand in &STANDS {
            let scene = (stand.load)()?;
            let stage = Stage::new(gpu, scene.clone());
            let truth = look(stand, None)?.exact(&scene, wide(1));
            for kind in &KINDS {
                for &samples in kind.samples {
                    let settings = settings(json!({ "samples": samples }));
                    let frame = stage.frame(&look(stand, Some((kind, samples)))?, wide(1));
                    cases.push(Case {
                        entry: Entry {
                            scene: stand.name.to_owned(),
                            method: kind.name.to_owned(),
                            settings,
                            series: kind.name.to_owned(),
                            point: samples.to_string(),
                            extent: f64::from(samples),
                            is_published: kind.form == Some(EffectForm::OCCLUSION_PUBLISHED),
                            size,
                        },
                        subject: Box::new(GpuFrame { forms: kind.form.into_iter().collect(), ..frame }),
                        truth: Some(Rc::clone(&truth)),
                        judge: Some(judge()),
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
                look(stand, Some((kind, 16))).unwrap_or_else(|error| panic!("{}, {}: {error}", stand.name, kind.name));
            }
        }
    }
}
