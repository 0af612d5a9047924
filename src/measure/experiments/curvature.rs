//! `curvature`: how far curvature is from that of shapes whose formulas are known, by where it comes from.

use std::ops::ControlFlow;
use std::rc::Rc;

use glam::{DMat3, DVec3};
use serde_json::json;

use crate::engine::{Engine, GpuError, Request};
use crate::measure::experiment::{
    Case, ChartKind, Entry, ErrorKind, Experiment, Judge, MeasureError, Setup, Subject, Truth, settings,
};
use crate::measure::forms::{FORMS, Form, Seen};
use crate::measure::page::short;
use crate::measure::run::{PassTimes, Row};
use crate::measure::stage::{GpuFrame, Look, Stage, device};
use crate::scene::{Camera, Image, Pixels, Scene, linear_from_srgb, srgb_from_linear};

const SIZES: [u32; 1] = [256];
const SIZES_THOROUGH: [u32; 4] = [128, 256, 512, 1000];
const ZOOMS: [f64; 2] = [1.0, 2.0];

/// Pixels from a silhouette within which curvature is judged apart.
const BAND_PX: i64 = 3;
/// Linear light of what is flat; what is curved most has none, or twice as much.
const GREY: f64 = 0.215_860_500_113_898_27;

/// Bits of each coordinate of a normal of a mesh, as it is stored.
const STORED_BITS: u32 = 16;
/// Fewer, for how much the storage has to do with the error.
const FEWER_BITS: [u32; 1] = [12];
const FEWER_BITS_THOROUGH: [u32; 2] = [14, 12];

/// Figures: error of the sum of the principal curvatures, away from silhouettes and beside them, over the root mean square of the length of
/// both; the share of pixels on whose sign it errs; and the factor by which what is found is nearest to what is due.
const ERROR: &str = "error over the curvature, RMS";
const BAND: &str = "error within 3 px of silhouettes and ends";
const SIGNS: &str = "wrong signs, %";
const FACTOR: &str = "found over due";

/// What a camera sees of a form.
struct Map {
    size: [u32; 2],
    seen: Vec<Option<Seen>>,
    /// Whether a silhouette or an end of the surface is near.
    is_beside: Vec<bool>,
}

impl Map {
    /// `zero` is where the scene's is in its file; beyond twice the radius there is nothing.
    fn new(form: &Form, camera: &Camera, size: [u32; 2], radius: f64, zero: DVec3) -> Map {
        let world = camera.view_from_world.as_dmat4().inverse();
        let turn = DMat3::from_mat4(world);
        let eye = world.w_axis.truncate();
        let half = camera.half_extent.as_dvec2();
        let range = [(eye.length() - 2.0 * radius).max(f64::from(camera.near)), eye.length() + 2.0 * radius];
        let pixel = |x: u32, y: u32| {
            let place =
                [(x, size[0]), (y, size[1])].map(|(at, side)| 2.0 * (f64::from(at) + 0.5) / f64::from(side) - 1.0);
            let direction = (turn * DVec3::new(place[0] * half.x, -place[1] * half.y, -1.0)).normalize();
            form.first(form.sight(eye, direction, range, zero))
        };
        let seen: Vec<Option<Seen>> =
            (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        let [width, height] = size.map(i64::from);
        let at = |x: i64, y: i64| {
            let within = (0..width).contains(&x) && (0..height).contains(&y);
            if within { seen[(y * width + x) as usize] } else { None }
        };
        let mut is_beside = vec![false; seen.len()];
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let ends = |dx: i64, dy: i64| match (at(x, y), at(x + dx, y + dy)) {
                (Some(a), Some(b)) => !form.goes_on(&a, &b),
                // Beyond the picture nothing ends.
                (a, b) => a.is_some() != b.is_some() && x + dx < width && y + dy < height,
            };
            if !(ends(1, 0) || ends(0, 1)) {
                continue;
            }
            for (dx, dy) in (-BAND_PX..=BAND_PX).flat_map(|dy| (-BAND_PX..=BAND_PX).map(move |dx| (dx, dy))) {
                let (x, y) = (x + dx, y + dy);
                if (0..width).contains(&x) && (0..height).contains(&y) {
                    is_beside[(y * width + x) as usize] = true;
                }
            }
        }
        Map { size, seen, is_beside }
    }

    /// The picture that exact curvature gives.
    fn image(&self, scale: f64) -> Image {
        shades(self.size, self.seen.iter().map(|seen| seen.map(|seen| (scale * seen.kappa).tanh())))
    }

    /// How far the curvature that a picture tells by its shades is from this.
    fn judge(self: Rc<Self>, scale: f64) -> Judge {
        Rc::new(move |_, picture| {
            let [mut off, mut band, mut all] = [0.0, 0.0, 0.0];
            let [mut along, mut square] = [0.0, 0.0];
            let (mut wrong, mut signed, mut count) = (0usize, 0usize, [0usize; 2]);
            let largest = self.seen.iter().flatten().map(|seen| seen.kappa.abs()).fold(0.0, f64::max);
            for (index, seen) in self.seen.iter().enumerate() {
                let Some(seen) = seen else { continue };
                let (x, y) = (index as u32 % self.size[0], index as u32 / self.size[0]);
                let light = linear_from_srgb(f64::from(picture.pixel(x, y)[0]));
                // Beyond this a shade tells no more.
                let kappa = (light / GREY - 1.0).clamp(-0.9999, 0.9999).atanh() / scale;
                let error = (kappa - seen.kappa).powi(2);
                if self.is_beside[index] {
                    band += error;
                    count[1] += 1;
                    continue;
                }
                off += error;
                all += seen.squares;
                along += kappa * seen.kappa;
                square += seen.kappa * seen.kappa;
                count[0] += 1;
                if seen.kappa.abs() > 0.05 * largest {
                    signed += 1;
                    wrong += usize::from(kappa * seen.kappa < 0.0);
                }
            }
            let mean = all / count[0].max(1) as f64;
            vec![
                (ERROR, (off / count[0].max(1) as f64 / mean).sqrt()),
                (BAND, (band / count[1].max(1) as f64 / mean).sqrt()),
                (SIGNS, 100.0 * wrong as f64 / signed.max(1) as f64),
                (FACTOR, along / square),
            ]
        })
    }
}

/// A picture in 16 bits of curvature read by tanh, -1 to 1; black where nothing is.
fn shades(size: [u32; 2], read: impl Iterator<Item = Option<f64>>) -> Image {
    let shade = |read: Option<f64>| {
        let light = read.map_or(0.0, |read| GREY * (1.0 + read));
        let value = (srgb_from_linear(light) * 65535.0).round() as u16;
        [value, value, value, u16::MAX]
    };
    Image { size, pixels: Pixels::U16(read.flat_map(shade).collect()), opaque: true }
}

/// Where curvature comes from.
#[derive(Debug, Clone, Copy)]
struct Origin {
    method: &'static str,
    /// What a style says of it.
    source: &'static str,
    /// The style's method of transparency.
    layers: &'static str,
    /// Whether it is read from the k-buffer before it becomes a colour.
    is_read_out: bool,
}

const SURFACE: Origin = Origin { method: "surface", source: "surface", layers: "packed", is_read_out: false };
const SCREEN: Origin = Origin { method: "screen", source: "screen", layers: "packed", is_read_out: false };
const BKB: Origin = Origin { method: "bkb", source: "auto", layers: "bkb", is_read_out: false };
const READ_OUT: Origin = Origin { method: "bkb before colours", is_read_out: true, ..BKB };

/// The k-buffer's own curvature as a picture.
struct ReadOut(GpuFrame);

impl Subject for ReadOut {
    fn frame_ms(&mut self) -> Result<f64, MeasureError> {
        self.0.frame_ms()
    }

    fn pass_ms(&mut self) -> Result<PassTimes, MeasureError> {
        self.0.pass_ms()
    }

    fn bytes(&self) -> u64 {
        self.0.bytes()
    }

    fn picture(&mut self) -> Result<Image, MeasureError> {
        let words = self.0.bkb_words()?;
        let words = words.ok_or_else(|| MeasureError::Content("the k-buffer is drawn in bands".to_owned()))?;
        // Keys have 16 bits of depth at their lower end, and are all 1 where nothing is.
        let nearest = |(keys, kappa): (&[u32], &[f32])| {
            let stored = keys.iter().zip(kappa).filter(|(key, _)| **key != u32::MAX);
            stored.min_by_key(|(key, _)| **key & 0xffff).map(|(_, kappa)| f64::from(*kappa))
        };
        let k = words.band.k as usize;
        Ok(shades(self.0.request.size, words.z.chunks(k).zip(words.kappa.chunks(k)).map(nearest)))
    }
}

/// The normals of a scene's meshes rounded to so many bits a coordinate, before anything asks how they bend.
fn with_normals(mut scene: Scene, bits: u32) -> Scene {
    let step = 1 << (STORED_BITS - bits);
    let rounded = |coordinate: u32| ((coordinate + step / 2) / step * step).min(u32::from(u16::MAX) - 1);
    for shape in &mut scene.assembly.shapes {
        for normal in &mut shape.normals {
            *normal = rounded(*normal & 0xffff) | rounded(*normal >> 16) << 16;
        }
    }
    scene
}

fn look(form: &Form, origin: Origin, zoom: f64) -> Result<Look, MeasureError> {
    let (camera, zoom_by) = (form.camera, form.zoom * zoom);
    let Origin { method, source, layers, .. } = origin;
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "black", {camera}, "zoom": {zoom_by} }}, "geometry": {{ "atom": "1A", "scale": 1 }},
              "transparency": {{ "method": "{layers}", "k": 8 }}, "mapping": {{ "*": "shade" }},
              "shaders": [{{ "name": "shade", "shader": "curvature", "properties": {{ "base_color": "#808080", "shading": "unlit",
                "contour_width": "0pt", "gain": 0.4, "opacity_transfer": [[0, 1], [1, 1]],
                "color_transfer": [[-1, 0, 0, 0], [1, 2, 2, 2]], "curvature_source": "{source}" }} }}] }}"##
    );
    Look::of_text(&format!("{} {method} {zoom}", form.name), &text)
}

/// How many bits a coordinate of a row's normals has.
fn bits(row: &Row) -> u32 {
    row.entry.settings.get(BITS).and_then(|bits| u32::try_from(bits.as_u64()?).ok()).unwrap_or(STORED_BITS)
}

/// The setting of that name.
const BITS: &str = "normal bits";
/// The form that is a part as CAD programs write them, and no smooth surface.
const PART: &str = "bracket";

/// The experiment.
pub struct Curvature;

impl Experiment for Curvature {
    fn name(&self) -> &'static str {
        "curvature"
    }

    fn doc(&self) -> &'static str {
        "How far curvature is from that of shapes with known formulas: of the surface itself, from neighbouring pixels, and in the bucketed k-buffer."
    }

    fn chart(&self) -> ChartKind {
        let error = ErrorKind::Figure { name: ERROR, title: "error: RMS over that of the curvature, 0 to 1" };
        ChartKind::CostAgainstError { error, per_pixel: false, has_front: false }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            format!(
                "The truth are five implicit surfaces and a part of planes and cylinders, crossed along the ray of each pixel's centre in double \
                 precision; curvature is the divergence of their normals, and errors are over the root of the sum of both squares. Pictures tell \
                 curvature by flat shades of 16 bits, one sample a pixel. Within {BAND_PX} px of silhouettes, and of ends of the surface or of a face, \
                 it is judged apart; a pixel that the device leaves empty there counts as the sharpest bend. The sphere is one to the device, four others are meshes of 6,400 to 129,600 triangles with exact normals at their \
                 vertices. The part is the shipped bracket as its file has it: 992 triangles, 32 to a full turn of its bends and 20 to that of its \
                 smallest holes, normals of three decimals."
            ),
            format!(
                "Signs are judged where the curvature is above a twentieth of its largest. Normals of meshes are stored in {STORED_BITS} + \
                 {STORED_BITS} bits; rows of fewer have them rounded further. The bucketed k-buffer keeps normals of 15 + 15 + 2 bits, and colours \
                 of 8 bits, which is as much as its shades can tell; rows before colours are what it found itself. Where a neighbour is missing it \
                 says -1."
            ),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.entry.size[0] >= SIZES[0]).collect();
        let of = |origin: Origin, is_part: bool| {
            let of = move |row: &&&Row| row.entry.method == origin.method && (row.entry.scene == PART) == is_part;
            rows.iter().filter(of).copied().collect::<Vec<&Row>>()
        };
        let most = |rows: &[&Row], bits_due: u32, name: &'static str| {
            let of = rows.iter().filter(|row| bits(row) == bits_due);
            short(of.filter_map(|row| row.figure(name)).fold(0.0, f64::max))
        };
        let three = |is_part: bool, name: &'static str| {
            let [surface, screen, bkb] =
                [SURFACE, SCREEN, BKB].map(|origin| most(&of(origin, is_part), STORED_BITS, name));
            format!("{surface}, {screen} and {bkb}")
        };
        let zoomed = [SURFACE, SCREEN, BKB].map(|origin| {
            let of = of(origin, false);
            let alike = |a: &Row, b: &Row| a.entry.scene == b.entry.scene && a.entry.size == b.entry.size;
            let pairs = of
                .iter()
                .flat_map(|a| of.iter().filter(move |b| alike(a, b) && bits(a) == bits(b)).map(move |b| (a, b)));
            let apart = pairs.filter_map(|(a, b)| Some(a.figure(FACTOR)? - b.figure(FACTOR)?));
            short(100.0 * apart.fold(0.0, f64::max))
        });
        let by_bits = |origin: Origin| {
            let of = of(origin, false);
            let [stored, few] = [STORED_BITS, FEWER_BITS[0]].map(|bits| most(&of, bits, ERROR));
            format!("{stored} and {few}")
        };
        format!(
            "From {} pixels on the error of the surface itself, from neighbouring pixels and in the bucketed k-buffer is at most {} of the \
             curvature, next to silhouettes {}; signs are wrong on at most {} % of the pixels, and twice the zoom changes what is found by {}, {} \
             and {} %. On the bracket, whose bends are coarse, the errors are {}. With normals of {STORED_BITS} and {} bits a coordinate the \
             surface itself errs by {}, neighbouring pixels by {}; the k-buffer before its colours by {}.",
            SIZES[0],
            three(false, ERROR),
            three(false, BAND),
            three(false, SIGNS),
            zoomed[0],
            zoomed[1],
            zoomed[2],
            three(true, ERROR),
            FEWER_BITS[0],
            by_bits(SURFACE),
            by_bits(SCREEN),
            most(&of(READ_OUT, false), STORED_BITS, ERROR),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let sizes: Vec<u32> = match setup.size {
            Some(size) => vec![size[0]],
            None if setup.thorough => SIZES_THOROUGH.to_vec(),
            None => SIZES.to_vec(),
        };
        let mut cases = Vec::new();
        for form in &FORMS {
            let model = form.scene()?;
            let is_mesh = !model.assembly.is_empty();
            let radius = if is_mesh { f64::from(model.bounding_sphere().radius) } else { 1.0 };
            let coarser = match setup.thorough {
                _ if !is_mesh || form.name == PART => &[],
                false => &FEWER_BITS[..],
                true => &FEWER_BITS_THOROUGH,
            };
            let scenes = [STORED_BITS].iter().chain(coarser).map(|&bits| {
                let scene = with_normals(model.clone(), bits);
                (bits, Stage::new(gpu, scene.clone()), scene)
            });
            let scenes: Vec<_> = scenes.collect();
            for (&side, zoom) in sizes.iter().flat_map(|side| ZOOMS.map(|zoom| (side, zoom))) {
                let size = [side, side];
                let request = Request { wide: true, ..Request::new(size, 1) };
                let mut map: Option<Rc<Map>> = None;
                for (bits, stage, scene) in &scenes {
                    let origins = match *bits {
                        STORED_BITS => &[SURFACE, SCREEN, BKB, READ_OUT][..],
                        _ if zoom == ZOOMS[0] => &[SURFACE, SCREEN],
                        _ => continue,
                    };
                    let mut engine = Engine::new(gpu.clone(), scene.clone(), look(form, SURFACE, zoom)?.style());
                    engine.draw(&request, false, &mut |_| ControlFlow::Continue(()))?;
                    let seen = engine.camera(size).zip(engine.curvature_scale());
                    let (camera, scale) = seen.ok_or(GpuError::NothingToDraw)?;
                    let scale = 0.4 * scale;
                    let map = map.get_or_insert_with(|| Rc::new(Map::new(form, &camera, size, radius, model.origin())));
                    let image = map.image(scale);
                    let truth = Truth::new(move |_| Ok(image.clone()));
                    for origin in origins {
                        let series = match *bits {
                            STORED_BITS => origin.method.to_owned(),
                            bits => format!("{}, {bits} + {bits} bits", origin.method),
                        };
                        let settings = match is_mesh {
                            true => settings(json!({ "zoom": zoom, BITS: bits })),
                            false => settings(json!({ "zoom": zoom })),
                        };
                        let frame = stage.frame(&look(form, *origin, zoom)?, request);
                        cases.push(Case {
                            entry: Entry {
                                scene: form.name.to_owned(),
                                method: origin.method.to_owned(),
                                settings,
                                series,
                                point: format!("{side} {zoom}"),
                                extent: f64::from(side),
                                is_published: origin.layers == BKB.layers,
                                size,
                            },
                            subject: if origin.is_read_out { Box::new(ReadOut(frame)) } else { Box::new(frame) },
                            truth: Some(Rc::clone(&truth)),
                            judge: Some(Rc::clone(map).judge(scale)),
                        });
                    }
                }
            }
        }
        Ok(cases)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::mesh::unpack_normal;

    #[test]
    fn styles_load() {
        for form in &FORMS {
            for origin in [SURFACE, SCREEN, BKB, READ_OUT] {
                look(form, origin, 2.0).unwrap_or_else(|error| panic!("{}: {error}", form.name));
            }
        }
    }

    #[test]
    fn normals_of_fewer_bits_are_off_by_as_much_more() {
        let form = FORMS.iter().find(|form| form.name == "torus").expect("a torus");
        let scene = form.scene().expect("a torus");
        let normals =
            |scene: &Scene| scene.assembly.shapes[0].normals.iter().map(|n| unpack_normal(*n)).collect::<Vec<_>>();
        let exact = normals(&scene);
        for (bits, most) in [(16, 0.0), (14, 2.0), (12, 8.0)] {
            let off = exact
                .iter()
                .zip(normals(&with_normals(scene.clone(), bits)))
                .map(|(a, b)| a.distance(b))
                .fold(0.0, f32::max);
            // Two coordinates are off by half a step of many, which a normal in the middle of a face of the octahedron is by three times the
            // root of two as much.
            let step = 2.0 / 65_534.0;
            assert!(off <= 4.25 * most * step && off >= 0.8 * most * step, "{bits} bits: {off}");
        }
    }
}
