//! `transparency`: how exact layers are and what they cost, by opacity and by what is seen through.

use std::fmt::Write as _;
use std::rc::Rc;

use serde_json::json;

use crate::engine::Request;
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, Judge, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::Row;
use crate::measure::stage::{Look, Stage, device, scene, shipped_scene};
use crate::scene::{Image, Scene, linear_from_srgb};

const SIZE: [u32; 2] = [256, 256];

/// Squares across the whole picture.
const SQUARES: usize = 32;

const OPACITIES: [f64; 4] = [0.005, 0.1, 0.4, 0.8];
const OPACITIES_THOROUGH: [f64; 9] = [0.005, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95];

/// Figures: the largest error of any channel in linear light, and the share of pixels with more than a step of 8 bits.
pub(super) const LARGEST: &str = "largest error, linear";
pub(super) const WRONG: &str = "pixels off by more than 1/255, %";

/// A scene, how it is looked at, and how its atoms are drawn.
struct Stand {
    name: &'static str,
    load: fn() -> Result<Scene, MeasureError>,
    camera: &'static str,
    /// Radii of atoms over those of van der Waals.
    scale: f64,
}

const STANDS: [Stand; 4] = [
    Stand {
        name: "32 squares",
        load: squares,
        camera: r#""orthographic": true, "position": [0, 0, 1], "zoom": 2.5"#,
        scale: 1.0,
    },
    Stand { name: "assembly", load: || shipped_scene("gearbox"), camera: r#""zoom": 1.2"#, scale: 0.3 },
    Stand { name: "molecule", load: || shipped_scene("nanotube"), camera: r#""zoom": 1.2"#, scale: 1.0 },
    Stand { name: "ball and stick", load: || shipped_scene("c60"), camera: r#""zoom": 1.2"#, scale: 0.3 },
];

/// The experiment.
pub struct Transparency;

/// Squares one upon the other at depths in no order [after Murray2016 §6].
fn squares() -> Result<Scene, MeasureError> {
    let mut text = String::new();
    for index in 0..SQUARES {
        let depth = ((index * 13 + 5) % SQUARES) as f64 / SQUARES as f64;
        let _ = writeln!(text, "o part{}", index % 4);
        // No edge lies on the centres of pixels.
        for [x, y] in [[-1.0, -0.93], [1.0, -0.93], [1.0, 1.1], [-1.0, 1.1]] {
            let _ = writeln!(text, "v {x} {y} {}", -depth);
        }
        let first = 4 * index + 1;
        let _ = writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
    }
    scene("squares.obj", text.as_bytes())
}

fn look(stand: &Stand, opacity: f64) -> Result<Look, MeasureError> {
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "#f4ead0", {} }}, "geometry": {{ "atom": "vdw", "scale": {} }},
              "mapping": {{ "*": "glass", "mesh[part=part0]": "other", "atom": "other" }},
              "shaders": [{{ "name": "glass", "shader": "unlit", "properties": {{ "base_color": "#2060d0", "opacity": {opacity} }} }},
                {{ "name": "other", "shader": "unlit", "properties": {{ "base_color": "#d05020", "opacity": {opacity} }} }}] }}"##,
        stand.camera, stand.scale
    );
    Look::of_text(&format!("{} {opacity}", stand.name), &text)
}

pub(super) fn judge() -> Judge {
    Rc::new(|truth, picture| {
        let (mut largest, mut wrong, mut count) = (0.0f64, 0usize, 0usize);
        for (x, y) in (0..truth.size[1]).flat_map(|y| (0..truth.size[0]).map(move |x| (x, y))) {
            let linear = |image: &Image| image.pixel(x, y).map(|value| linear_from_srgb(f64::from(value)));
            let (a, b) = (linear(truth), linear(picture));
            let off = (0..3).map(|channel| (a[channel] - b[channel]).abs()).fold(0.0, f64::max);
            largest = largest.max(off);
            wrong += usize::from(off > 1.0 / 255.0);
            count += 1;
        }
        vec![(LARGEST, largest), (WRONG, 100.0 * wrong as f64 / count.max(1) as f64)]
    })
}

impl Experiment for Transparency {
    fn name(&self) -> &'static str {
        "transparency"
    }

    fn doc(&self) -> &'static str {
        "How far layers of what is transparent are from crossing every surface exactly, by opacity, on four scenes, and their cost."
    }

    fn chart(&self) -> ChartKind {
        let error = ErrorKind::Figure { name: LARGEST, title: "error: largest of any channel in linear light, 0 to 1" };
        ChartKind::CostAgainstError { error, per_pixel: false, has_front: false }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            "The truth is the reference renderer, which crosses every surface along the ray of each pixel's centre, in double precision; pictures have \
             one sample a pixel and 16 bits a channel. Objects are flat colours, so that nothing but order and blending differs."
                .to_owned(),
            format!(
                "The squares are those of Fig. 10 of Murray 2016: {SQUARES} across the whole picture, at depths in no order. On the border of an \
                 object rounding decides whether a pixel sees it, and which of two faces at one place is the nearer."
            ),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let figure = |row: &Row, name: &str| row.figure(name).unwrap_or(f64::NAN);
        let of = |scene: &'static str| rows.iter().filter(move |row| row.entry.scene == scene);
        let most = |scene: &'static str, name: &'static str| of(scene).map(|row| figure(row, name)).fold(0.0, f64::max);
        let wrong = STANDS.iter().map(|stand| most(stand.name, WRONG)).fold(0.0, f64::max);
        let times: Vec<f64> = of(STANDS[0].name).map(Row::median_ms).collect();
        let [quick, slow] = [f64::min, f64::max].map(|choose| times.iter().copied().fold(f64::NAN, choose));
        format!(
            "On the squares the largest error is {} in linear light; on objects at most {} % of the pixels are off by more than a step of \
             8 bits. {SQUARES} layers take from {} ms, where little light comes through, to {} ms.",
            short(most(STANDS[0].name, LARGEST)),
            short(wrong),
            short(quick),
            short(slow),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let request = Request { wide: true, ..Request::new(size, 1) };
        let opacities: &[f64] = if setup.thorough { &OPACITIES_THOROUGH } else { &OPACITIES };
        let mut cases = Vec::new();
        for stand in &STANDS {
            let scene = (stand.load)()?;
            let stage = Stage::new(gpu, scene.clone());
            for &opacity in opacities {
                let look = look(stand, opacity)?;
                cases.push(Case {
                    entry: Entry {
                        scene: stand.name.to_owned(),
                        method: "packed".to_owned(),
                        settings: settings(json!({ "opacity": opacity })),
                        series: stand.name.to_owned(),
                        point: opacity.to_string(),
                        extent: opacity,
                        is_published: false,
                        size,
                    },
                    subject: Box::new(stage.frame(&look, request)),
                    truth: Some(look.exact(&scene, request)),
                    judge: Some(judge()),
                });
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
            look(stand, 0.5).unwrap_or_else(|error| panic!("{}: {error}", stand.name));
        }
    }
}
