//! `toon-edges`: three ways to draw the border between two bands of light, against 16x16 supersampling.
//!
//! All are evaluated on the CPU, over surfaces whose normals are known exactly, with the arithmetic of a shader: the
//! derivatives of `fwidth` are differences within quads of 2x2 pixels, as devices have them. `gradient length` is what
//! `shaders/objects/toon.wgsl` draws.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::Instant;

use glam::{Vec2, Vec3};
use serde_json::json;

use crate::measure::experiment::{
    Case, ChartKind, Entry, ErrorKind, Experiment, GoOn, MeasureError, Setup, Subject, Truth, settings,
};
use crate::measure::page::short;
use crate::measure::run::{Row, geometric_mean};
use crate::scene::{Image, Pixels, srgb_from_linear};

/// Bands of light.
const STEPS: f32 = 4.0;
/// Weight of the cosine, and light without it: the defaults of `toon`.
const SCALE: f32 = 0.5;
const BIAS: f32 = 0.5;
/// Samples along each side of a pixel of the truth.
const TRUTH_SIDE: u32 = 16;
const SIZE: [u32; 2] = [256, 256];

/// The experiment.
pub struct ToonEdges;

/// A surface seen straight on; places are in pixels from the picture's middle, y up.
enum Shape {
    Sphere {
        radius: f32,
    },
    /// Through the middle; `across` is the unit vector at right angles to its axis.
    Cylinder {
        across: Vec2,
        radius: f32,
    },
    /// On a square grid.
    Spheres {
        spacing: f32,
        radius: f32,
        /// Cells from the middle that hold one.
        reach: f32,
    },
}

/// A point of a surface.
#[derive(Clone, Copy)]
struct Hit {
    normal: Vec3,
    /// Change of the normal over one pixel to the right and up.
    normal_dx: Vec3,
    normal_dy: Vec3,
}

impl Shape {
    /// The normal, unless the place lies within `margin` of the silhouette or outside.
    fn hit(&self, at: Vec2, margin: f32) -> Option<Hit> {
        match *self {
            Shape::Sphere { radius } => sphere(at, radius, margin),
            Shape::Spheres { spacing, radius, reach } => {
                let cell = (at / spacing).round();
                if cell.abs().max_element() > reach {
                    return None;
                }
                sphere(at - cell * spacing, radius, margin)
            }
            Shape::Cylinder { across, radius } => {
                let u = at.dot(across) / radius;
                if u.abs() * radius >= radius - margin {
                    return None;
                }
                let z = (1.0 - u * u).sqrt();
                let turn = (across.extend(0.0) - Vec3::Z * (u / z)) / radius;
                let normal = (across * u).extend(z);
                Some(Hit { normal, normal_dx: turn * across.x, normal_dy: turn * across.y })
            }
        }
    }
}

fn sphere(at: Vec2, radius: f32, margin: f32) -> Option<Hit> {
    let reach = radius - margin;
    if reach <= 0.0 || at.length_squared() >= reach * reach {
        return None;
    }
    let n = at / radius;
    let z = (1.0 - n.length_squared()).sqrt();
    Some(Hit {
        normal: n.extend(z),
        normal_dx: Vec3::new(1.0, 0.0, -n.x / z) / radius,
        normal_dy: Vec3::new(0.0, 1.0, -n.y / z) / radius,
    })
}

/// Place on the staircase of a cosine, in bands.
fn bands(cosine: f32) -> f32 {
    STEPS * (SCALE * cosine + BIAS).max(0.0) / (SCALE + BIAS)
}

/// How a border between bands is drawn.
#[derive(Clone, Copy, PartialEq)]
enum Step {
    /// Not smoothed at all, as published [Prost2016 eq. 2].
    Hard,
    /// `smoothstep` over `fwidth` to both sides, which is what is found most.
    Fwidth,
    /// Box filter of a straight edge, by the length of the exact gradient.
    GradientLength,
}

const STEP_KINDS: [(Step, &str); 3] =
    [(Step::Hard, "hard step"), (Step::Fwidth, "fwidth smoothstep"), (Step::GradientLength, "gradient length")];

/// The border that a place on the staircase is nearest to.
fn nearest_edge(x: f32) -> f32 {
    (x + 0.5).floor().clamp(1.0, STEPS - 1.0)
}

fn hard(x: f32) -> f32 {
    x.floor().clamp(0.0, STEPS - 1.0)
}

fn fwidth_smoothstep(x: f32, fwidth: f32) -> f32 {
    let edge = nearest_edge(x);
    let t = ((x - edge) / (2.0 * fwidth.max(1e-6)) + 0.5).clamp(0.0, 1.0);
    edge - 1.0 + t * t * (3.0 - 2.0 * t)
}

/// Mean of the staircase over a pixel across which `x` changes by `width`: as `band_mean` of the shader.
fn gradient_length(x: f32, width: f32) -> f32 {
    if width < 1.0 {
        let edge = nearest_edge(x);
        return edge - 1.0 + ((x - edge) / width.max(1e-6) + 0.5).clamp(0.0, 1.0);
    }
    let integral = |x: f32| {
        let k = x.floor().clamp(0.0, STEPS - 1.0);
        k * (x - 0.5 * (k + 1.0))
    };
    (integral(x + 0.5 * width) - integral(x - 0.5 * width)) / width
}

/// A shape in a picture.
struct Sheet {
    shape: Shape,
    size: [u32; 2],
    to_light: Vec3,
}

impl Sheet {
    /// Bands of light, `side` x `side` samples a pixel, as one value each; negative where nothing is.
    fn values(&self, step: Step, side: u32, go_on: GoOn<'_>) -> Result<Vec<f32>, MeasureError> {
        match step {
            Step::Hard => self.sampled(side, go_on, |x, _, _| hard(x)),
            Step::Fwidth => self.sampled(side, go_on, |x, [dx, dy], _| fwidth_smoothstep(x, dx.abs() + dy.abs())),
            Step::GradientLength => self.sampled(side, go_on, |x, _, hit| {
                let cosine_d = Vec2::new(hit.normal_dx.dot(self.to_light), hit.normal_dy.dot(self.to_light));
                let slope = STEPS * SCALE / (SCALE + BIAS);
                gradient_length(x, slope * cosine_d.length() / side as f32)
            }),
        }
    }

    /// `step` has the place on the staircase, its differences within the quad, and the surface.
    fn sampled(
        &self,
        side: u32,
        go_on: GoOn<'_>,
        step: impl Fn(f32, [f32; 2], &Hit) -> f32,
    ) -> Result<Vec<f32>, MeasureError> {
        let [width, height] = self.size;
        let mut sums = vec![0.0f32; width as usize * height as usize];
        let mut hits = vec![0u32; sums.len()];
        let middle = Vec2::new(width as f32, height as f32) * 0.5;
        let place = |x: u32, y: u32| {
            let at = (Vec2::new(x as f32, y as f32) + 0.5) / side as f32;
            Vec2::new(at.x - middle.x, middle.y - at.y)
        };
        let [columns, rows] = [width * side, height * side];
        for y in (0..rows).step_by(2) {
            if go_on() == ControlFlow::Break(()) {
                return Err(MeasureError::Interrupted);
            }
            for x in (0..columns).step_by(2) {
                let quad = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
                let found = quad.map(|[x, y]| self.shape.hit(place(x, y), 0.0));
                // Beside the silhouette a quad holds places of no surface, which have no light.
                let bands = found.map(|hit| hit.map_or(bands(0.0), |hit| bands(hit.normal.dot(self.to_light))));
                for lane in 0..4 {
                    let [x, y] = quad[lane];
                    let Some(hit) = found[lane].filter(|_| x < columns && y < rows) else { continue };
                    let row = lane & 2;
                    let differences = [bands[row + 1] - bands[row], bands[2 + (lane & 1)] - bands[lane & 1]];
                    let pixel = (y / side) as usize * width as usize + (x / side) as usize;
                    sums[pixel] += step(bands[lane], differences, &hit);
                    hits[pixel] += 1;
                }
            }
        }
        let mean = |(sum, hits): (f32, u32)| if hits == 0 { -1.0 } else { sum / hits as f32 };
        Ok(sums.into_iter().zip(hits).map(mean).collect())
    }

    /// The picture of these values, on white; pixels that the silhouette crosses are left out.
    fn image(&self, values: &[f32]) -> Image {
        /// From a pixel's middle to its corner.
        const CORNER: f32 = 0.7072;
        let color = Vec3::new(0.35, 0.62, 0.95);
        let [width, height] = self.size;
        let middle = Vec2::new(width as f32, height as f32) * 0.5;
        let mut pixels = Vec::with_capacity(values.len() * 4);
        for (index, value) in values.iter().enumerate() {
            let at = [index as u32 % width, index as u32 / width].map(|at| at as f32 + 0.5);
            let is_inside = self.shape.hit(Vec2::new(at[0] - middle.x, middle.y - at[1]), CORNER).is_some();
            let light = if is_inside { color * (value / STEPS) } else { Vec3::ONE };
            pixels.extend(light.to_array().map(|light| (srgb_from_linear(f64::from(light)) * 65535.0).round() as u16));
            pixels.push(u16::MAX);
        }
        Image { size: self.size, pixels: Pixels::U16(pixels), opaque: true }
    }
}

/// One kind of step on one shape.
struct Evaluation {
    sheet: Rc<Sheet>,
    step: Step,
    side: u32,
}

impl Evaluation {
    fn values(&self) -> Result<Vec<f32>, MeasureError> {
        self.sheet.values(self.step, self.side, &|| ControlFlow::Continue(()))
    }
}

impl Subject for Evaluation {
    fn frame_ms(&mut self) -> Result<f64, MeasureError> {
        let start = Instant::now();
        black_box(self.values()?);
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    fn picture(&mut self) -> Result<Image, MeasureError> {
        Ok(self.sheet.image(&self.values()?))
    }
}

fn shapes([width, height]: [u32; 2]) -> [(&'static str, Shape); 3] {
    let side = width.min(height) as f32;
    // Slanted, and so thin that the picture's corners stay free; spheres of atoms of a large molecule.
    let across = Vec2::from_angle(117f32.to_radians());
    let (spacing, radius) = (16.37, 7.3);
    [
        ("sphere", Shape::Sphere { radius: 0.46 * side }),
        ("cylinder", Shape::Cylinder { across, radius: 0.18 * side }),
        ("small spheres", Shape::Spheres { spacing, radius, reach: (0.5 * side / spacing - 1.0).floor().max(0.0) }),
    ]
}

impl Experiment for ToonEdges {
    fn name(&self) -> &'static str {
        "toon-edges"
    }

    fn doc(&self) -> &'static str {
        "How well three ways to draw the border between two bands of toon light come near to 16x16 samples, and their cost."
    }

    fn chart(&self) -> ChartKind {
        ChartKind::CostAgainstError { error: ErrorKind::Rmse, per_pixel: true, has_front: true }
    }

    fn needs_gpu(&self) -> bool {
        false
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            "No adapter is used: the steps are evaluated on one CPU core over surfaces whose normals are known exactly, in 32-bit \
             floats, with finding the surface included in the cost."
                .to_owned(),
            format!(
                "The truth is the hard step with {TRUTH_SIDE}x{TRUTH_SIDE} samples a pixel, averaged in linear light. Pixels that \
                 a silhouette crosses are left out of all pictures, since every step draws those alike."
            ),
            "Hard step: no smoothing, as published. Fwidth smoothstep: smoothstep over fwidth to both sides, from differences \
             within quads of 2x2 pixels. Gradient length: box filter of a straight edge by the length of the exact gradient, \
             which is what the shader of toon draws."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let of = |kind: usize, samples: f64| {
            let rows =
                rows.iter().filter(move |row| row.entry.series == STEP_KINDS[kind].1 && row.entry.extent == samples);
            let rmse = |row: &Row| row.error.as_ref().map_or(f64::NAN, |error| error.display.rmse.all);
            [geometric_mean(rows.clone().map(rmse)), geometric_mean(rows.map(Row::median_ns_per_pixel))]
        };
        let [[hard, hard_ns], [fwidth, fwidth_ns], [gradient, gradient_ns]] = [0, 1, 2].map(|kind| of(kind, 1.0));
        let [many, many_ns] = of(0, 16.0);
        format!(
            "With one sample the step by the length of the gradient, which `toon` draws, has {} times less error than the published \
             hard step and {} times less than the smoothstep over `fwidth`, for {} ns a pixel instead of {} and {}, with the surface \
             found. The hard step with 16 samples has {} times its error and costs {} times as much; `fwidth` blurs over two to \
             three pixels.",
            short(hard / gradient),
            short(fwidth / gradient),
            short(gradient_ns),
            short(hard_ns),
            short(fwidth_ns),
            short(many / gradient),
            short(many_ns / gradient_ns),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let size = setup.size.unwrap_or(SIZE);
        let sides: &[u32] = if setup.thorough { &[1, 2, 4, 8] } else { &[1, 2, 4] };
        let mut cases = Vec::new();
        for (name, shape) in shapes(size) {
            let sheet = Rc::new(Sheet { shape, size, to_light: Vec3::new(0.45, 0.5, 0.74).normalize() });
            let truth = {
                let sheet = Rc::clone(&sheet);
                Truth::new(move |go_on| Ok(sheet.image(&sheet.values(Step::Hard, TRUTH_SIDE, go_on)?)))
            };
            for (step, method) in STEP_KINDS {
                for &side in sides {
                    let settings = settings(json!({ "samples": side * side, "steps": STEPS as u32 }));
                    cases.push(Case {
                        entry: Entry {
                            scene: name.to_owned(),
                            method: method.to_owned(),
                            settings,
                            series: method.to_owned(),
                            point: (side * side).to_string(),
                            extent: f64::from(side * side),
                            is_published: step == Step::Hard && side == 1,
                            size,
                        },
                        subject: Box::new(Evaluation { sheet: Rc::clone(&sheet), step, side }),
                        truth: Some(Rc::clone(&truth)),
                        judge: None,
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

    fn values(shape: Shape, step: Step, side: u32) -> Vec<f32> {
        let sheet = Sheet { shape, size: [64, 64], to_light: Vec3::new(0.45, 0.5, 0.74).normalize() };
        sheet.values(step, side, &|| ControlFlow::Continue(())).unwrap()
    }

    fn sphere() -> Shape {
        Shape::Sphere { radius: 29.0 }
    }

    #[test]
    fn far_from_a_border_all_steps_are_one() {
        for x in [0.2f32, 1.5, 2.4, 3.9] {
            assert_eq!([fwidth_smoothstep(x, 0.02), gradient_length(x, 0.04)], [hard(x); 2], "{x}");
        }
        // A pixel that sees all bands alike has their mean.
        assert!((gradient_length(2.0, 4.0) - 1.5).abs() < 1e-6);
    }

    #[test]
    fn gradients_are_those_of_the_normals() {
        let cylinder = Shape::Cylinder { across: Vec2::from_angle(0.7), radius: 20.0 };
        for shape in [sphere(), cylinder] {
            let at = Vec2::new(6.0, -4.0);
            let hit = |x: f32, y: f32| shape.hit(at + Vec2::new(x, y), 0.0).unwrap();
            let (dx, dy) =
                (hit(0.05, 0.0).normal - hit(-0.05, 0.0).normal, hit(0.0, 0.05).normal - hit(0.0, -0.05).normal);
            let hit = hit(0.0, 0.0);
            assert!((dx * 10.0 - hit.normal_dx).length() < 1e-4 && (dy * 10.0 - hit.normal_dy).length() < 1e-4);
            assert!((hit.normal.length() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn the_gradient_length_is_nearest_to_many_samples() {
        let truth = values(sphere(), Step::Hard, TRUTH_SIDE);
        let distance = |step: Step| -> f32 {
            let pairs = values(sphere(), step, 1).into_iter().zip(&truth);
            // Where the silhouette is, only one of them may have a surface.
            let squares = pairs.filter(|(a, b)| *a >= 0.0 && **b >= 0.0).map(|(a, b)| (a - b) * (a - b));
            squares.sum::<f32>().sqrt()
        };
        let [hard, fwidth, gradient] = [Step::Hard, Step::Fwidth, Step::GradientLength].map(distance);
        assert!(gradient < 0.5 * fwidth && fwidth < hard, "{gradient} {fwidth} {hard}");
    }
}
