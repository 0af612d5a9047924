//! `transparency`: how exact lists and the k-buffer are and what they cost, by opacity, by k and by what is seen through.

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

const OPACITIES: [f64; 5] = [0.005, 0.1, 0.4, 0.8, 1.0];
const OPACITIES_THOROUGH: [f64; 10] = [0.005, 0.02, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0];

/// Fragments that the k-buffer keeps for each pixel.
const KS: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Where the k-buffer draws in an ordinary run: with many layers that count, and with few.
const BUFFERS: [(&str, f64); 2] = [("32 squares", 0.1), ("assembly", 0.4)];

/// Bits of depth by which each method sorts.
const DEPTH_BITS: [(&str, u32); 2] = [("packed", 32), ("bkb", 16)];

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

/// A stand in one opacity; with a k, drawn by the k-buffer.
fn look(stand: &Stand, opacity: f64, k: Option<usize>) -> Result<Look, MeasureError> {
    let method = k.map_or(r#""method": "packed""#.to_owned(), |k| format!(r#""method": "bkb", "k": {k}"#));
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "#f4ead0", {} }}, "geometry": {{ "atom": "vdw", "scale": {} }},
              "mapping": {{ "*": "glass", "mesh[part=part0]": "other", "atom": "other" }},
              "shaders": [{{ "name": "glass", "shader": "unlit", "properties": {{ "base_color": "#2060d0", "opacity": {opacity} }} }},
                {{ "name": "other", "shader": "unlit", "properties": {{ "base_color": "#d05020", "opacity": {opacity} }} }}],
              "transparency": {{ {method} }} }}"##,
        stand.camera, stand.scale
    );
    Look::of_text(&format!("{} {opacity} {k:?}", stand.name), &text)
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
        "How far lists of all fragments and the k-buffer are from crossing every surface exactly, by opacity and by k, on four scenes, and their cost."
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
            "Lists (packed) sort by 32 bits of depth, the k-buffer (bkb, after Murray 2016) by 16, and that keeps k fragments a pixel and opacity in \
             steps of 1/255. Bytes are those of objects and targets."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let figure = |row: &Row, name: &str| row.figure(name).unwrap_or(f64::NAN);
        let of = |scene: &'static str| {
            rows.iter().filter(move |row| row.entry.scene == scene && row.entry.method == "packed")
        };
        let most = |scene: &'static str, name: &'static str| of(scene).map(|row| figure(row, name)).fold(0.0, f64::max);
        let wrong = STANDS.iter().map(|stand| most(stand.name, WRONG)).fold(0.0, f64::max);
        // What is opaque has no layers.
        let has_layers = |row: &&Row| row.entry.settings["opacity"] != 1.0;
        let times: Vec<f64> = of(STANDS[0].name).filter(has_layers).map(Row::median_ms).collect();
        let [quick, slow] = [f64::min, f64::max].map(|choose| times.iter().copied().fold(f64::NAN, choose));
        format!(
            "On the squares the largest error of lists is {} in linear light; on objects at most {} % of the pixels are off by more than a step of \
             8 bits. {SQUARES} layers take from {} ms, where little light comes through, to {} ms.",
            short(most(STANDS[0].name, LARGEST)),
            short(wrong),
            short(quick),
            short(slow),
        )
    }

    fn findings(&self, rows: &[Row]) -> Vec<String> {
        let figure = |row: &Row, name: &str| row.figure(name).unwrap_or(f64::NAN);
        let cost = |row: &Row| {
            let megabytes = row.bytes as f64 / 1e6;
            format!(
                "{} ({} %) in {} ms and {} MB",
                short(figure(row, LARGEST)),
                short(figure(row, WRONG)),
                short(row.median_ms()),
                short(megabytes)
            )
        };
        let same = |a: &Row, b: &Row| {
            a.entry.scene == b.entry.scene && a.entry.settings["opacity"] == b.entry.settings["opacity"]
        };
        let mut found = Vec::new();
        for lists in rows.iter().filter(|row| row.entry.method == "packed") {
            let buffers: Vec<&Row> = rows.iter().filter(|row| row.entry.method == "bkb" && same(row, lists)).collect();
            if buffers.is_empty() {
                continue;
            }
            let each: Vec<String> =
                buffers.iter().map(|row| format!("k = {}: {}", row.entry.settings["k"], cost(row))).collect();
            found.push(format!(
                "{}, opacity {}: largest error and pixels off by more than 1/255; lists: {}; {}.",
                lists.entry.scene,
                lists.entry.settings["opacity"],
                cost(lists),
                each.join("; ")
            ));
        }
        found
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
                let truth = look(stand, opacity, None)?.exact(&scene, request);
                let has_buffer = opacity < 1.0 && (setup.thorough || BUFFERS.contains(&(stand.name, opacity)));
                let buffers = KS.into_iter().map(Some).filter(|_| has_buffer);
                for k in std::iter::once(None).chain(buffers) {
                    let (method, depth_bits) = DEPTH_BITS[usize::from(k.is_some())];
                    let of_lists = json!({ "opacity": opacity, "depth_bits": depth_bits });
                    let of_buffer = json!({ "opacity": opacity, "k": k, "depth_bits": depth_bits });
                    let series = k.map_or(stand.name.to_owned(), |_| format!("{}, bkb, {opacity}", stand.name));
                    cases.push(Case {
                        entry: Entry {
                            scene: stand.name.to_owned(),
                            method: method.to_owned(),
                            settings: settings(if k.is_some() { of_buffer } else { of_lists }),
                            series,
                            point: k.map_or(opacity.to_string(), |k| format!("k = {k}")),
                            extent: k.map_or(opacity, |k| k as f64),
                            is_published: k.is_some(),
                            size,
                        },
                        subject: Box::new(stage.frame(&look(stand, opacity, k)?, request)),
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
            look(stand, 0.5, Some(8)).unwrap_or_else(|error| panic!("{}: {error}", stand.name));
        }
    }
}
