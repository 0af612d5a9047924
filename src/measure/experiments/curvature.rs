//! `curvature`: how far curvature is from that of shapes whose formulas are known, by where it comes from.

use std::ops::ControlFlow;
use std::rc::Rc;

use glam::{DMat3, DVec3};
use serde_json::json;

use crate::engine::{Engine, GpuError, Request};
use crate::measure::experiment::{
    Case, ChartKind, Entry, ErrorKind, Experiment, Judge, MeasureError, Setup, Truth, settings,
};
use crate::measure::page::short;
use crate::measure::run::Row;
use crate::measure::sheet::sheet;
use crate::measure::stage::{Look, Stage, device, scene};
use crate::scene::{Camera, Image, Pixels, Scene, linear_from_srgb, srgb_from_linear};

const SIZES: [u32; 1] = [256];
const SIZES_THOROUGH: [u32; 4] = [128, 256, 512, 1000];
const ZOOMS: [f64; 2] = [1.0, 2.0];

/// Pixels from a silhouette within which curvature is judged apart.
const BAND_PX: i64 = 3;
/// Steps along a ray in which a surface is looked for, and halvings that then find its place.
const STEPS: u32 = 1500;
const HALVINGS: u32 = 60;
/// Step of differences of second order, in scene units: their error is below a millionth.
const STEP: f64 = 1e-3;
/// Linear light of what is flat; what is curved most has none, or twice as much.
const GREY: f64 = 0.215_860_500_113_898_27;

/// Figures: error of the sum of the principal curvatures, away from silhouettes and beside them, over the root mean square of the length of
/// both; and the share of pixels on whose sign it errs.
const ERROR: &str = "error over the curvature, RMS";
const BAND: &str = "error within 3 px of silhouettes";
const SIGNS: &str = "wrong signs, %";

/// A shape of which every point is known.
struct Form {
    name: &'static str,
    file: &'static str,
    /// Below 0 within, above outside, 0 on the surface.
    field: fn(DVec3) -> f64,
    /// Where the surface ends.
    is_there: fn(DVec3) -> bool,
    text: fn() -> String,
    camera: &'static str,
    zoom: f64,
}

const FORMS: [Form; 5] = [
    Form {
        name: "sphere",
        file: "sphere.xyz",
        field: |p| p.length() - 1.0,
        is_there: |_| true,
        text: || "1\n\nC 0 0 0\n".to_owned(),
        camera: r#""position": [0.4, 0.5, 3]"#,
        zoom: 1.0,
    },
    Form {
        name: "cylinder",
        file: "cylinder.obj",
        field: |p| p.x.hypot(p.y) - 0.5,
        is_there: |p| p.z.abs() < 3.0,
        text: || {
            sheet([400, 8], |u, v| {
                let out = around(u);
                (0.5 * out + DVec3::Z * (6.0 * v - 3.0), out)
            })
        },
        camera: r#""position": [3, 2, 1.2]"#,
        zoom: 3.0,
    },
    Form {
        name: "torus",
        file: "torus.obj",
        field: |p| (p.x.hypot(p.y) - 1.0).hypot(p.z) - 0.4,
        is_there: |_| true,
        text: || {
            sheet([360, 180], |u, v| {
                let (out, tube) = (around(u), around(v));
                let normal = out * tube.x + DVec3::Z * tube.y;
                (out + 0.4 * normal, normal)
            })
        },
        camera: r#""position": [0.8, -1.2, 2.4]"#,
        zoom: 1.0,
    },
    Form {
        name: "ellipsoid",
        file: "ellipsoid.obj",
        field: |p| (p / AXES).length_squared() - 1.0,
        is_there: |_| true,
        text: || {
            sheet([360, 180], |u, v| {
                let (out, up) = (around(u), around(0.5 * v - 0.25));
                let ball = out * up.x + DVec3::Z * up.y;
                (ball * AXES, (ball / AXES).normalize())
            })
        },
        camera: r#""position": [1.2, 0.8, 2]"#,
        zoom: 1.0,
    },
    Form {
        name: "saddle",
        file: "saddle.obj",
        field: |p| p.z - 0.5 * (p.x * p.x - p.y * p.y),
        is_there: |p| p.x.abs() < 1.0 && p.y.abs() < 1.0,
        text: || {
            sheet([250, 250], |u, v| {
                let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
                (DVec3::new(x, y, 0.5 * (x * x - y * y)), DVec3::new(-x, y, 1.0).normalize())
            })
        },
        camera: r#""position": [1, -1.4, 2.2]"#,
        zoom: 1.0,
    },
];

/// Of the ellipsoid.
const AXES: DVec3 = DVec3::new(1.0, 0.7, 0.5);

/// A point of the unit circle, by its share of a turn.
fn around(turns: f64) -> DVec3 {
    let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
    DVec3::new(cos, sin, 0.0)
}

/// A point that a pixel sees.
#[derive(Clone, Copy)]
struct Seen {
    point: DVec3,
    /// Sum of the principal curvatures, and of their squares.
    kappa: f64,
    squares: f64,
}

impl Form {
    fn gradient(&self, p: DVec3) -> DVec3 {
        let along = |axis: DVec3| ((self.field)(p + STEP * axis) - (self.field)(p - STEP * axis)) / (2.0 * STEP);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// Sum of the principal curvatures where the surface is seen along a direction, negative where it is convex, and the sum of their
    /// squares: the traces of the change of its unit normals, which the gradients beside it give, and of that change squared.
    fn curvatures(&self, p: DVec3, direction: DVec3) -> [f64; 2] {
        let normal = |p: DVec3| self.gradient(p).normalize();
        let along = |axis: DVec3| (normal(p + STEP * axis) - normal(p - STEP * axis)) / (2.0 * STEP);
        let change = DMat3::from_cols(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
        let trace = |of: DMat3| of.x_axis.x + of.y_axis.y + of.z_axis.z;
        let turned = if normal(p).dot(direction) > 0.0 { 1.0 } else { -1.0 };
        [turned * trace(change), trace(change * change)]
    }

    /// The first point of the surface along a ray.
    fn first(&self, origin: DVec3, direction: DVec3, [start, end]: [f64; 2]) -> Option<Seen> {
        let at = |t: f64| origin + t * direction;
        let step = (end - start) / f64::from(STEPS);
        let mut before = (self.field)(at(start));
        for index in 1..=STEPS {
            let t = start + f64::from(index) * step;
            let here = (self.field)(at(t));
            if before * here <= 0.0 {
                let (mut low, mut high) = (t - step, t);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if (self.field)(at(middle)) * before > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                let point = at(0.5 * (low + high));
                if (self.is_there)(point) {
                    let [kappa, squares] = self.curvatures(point, direction);
                    return Some(Seen { point, kappa, squares });
                }
            }
            before = here;
        }
        None
    }

    /// Whether the surface goes on between two points of it.
    fn goes_on(&self, a: DVec3, b: DVec3) -> bool {
        let middle = 0.5 * (a + b);
        let off = (self.field)(middle).abs() / self.gradient(middle).length().max(f64::MIN_POSITIVE);
        off < 0.1 * a.distance(b)
    }
}

/// What a camera sees of a form.
struct Map {
    size: [u32; 2],
    seen: Vec<Option<Seen>>,
    /// Whether a silhouette or an end of the surface is near.
    is_beside: Vec<bool>,
}

impl Map {
    fn new(form: &Form, camera: &Camera, size: [u32; 2], radius: f64) -> Map {
        let world = camera.view_from_world.as_dmat4().inverse();
        let turn = DMat3::from_mat4(world);
        let eye = world.w_axis.truncate();
        let half = camera.half_extent.as_dvec2();
        let range = [(eye.length() - 2.0 * radius).max(f64::from(camera.near)), eye.length() + 2.0 * radius];
        let pixel = |x: u32, y: u32| {
            let place =
                [(x, size[0]), (y, size[1])].map(|(at, side)| 2.0 * (f64::from(at) + 0.5) / f64::from(side) - 1.0);
            let direction = (turn * DVec3::new(place[0] * half.x, -place[1] * half.y, -1.0)).normalize();
            form.first(eye, direction, range)
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
                (Some(a), Some(b)) => !form.goes_on(a.point, b.point),
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

    /// The picture that exact curvature gives, in 16 bits.
    fn image(&self, scale: f64) -> Image {
        let shade = |seen: &Option<Seen>| {
            let light = seen.map_or(0.0, |seen| GREY * (1.0 + (scale * seen.kappa).tanh()));
            let value = (srgb_from_linear(light) * 65535.0).round() as u16;
            [value, value, value, u16::MAX]
        };
        Image { size: self.size, pixels: Pixels::U16(self.seen.iter().flat_map(shade).collect()), opaque: true }
    }

    /// How far the curvature that a picture tells by its shades is from this.
    fn judge(self: Rc<Self>, scale: f64) -> Judge {
        Rc::new(move |_, picture| {
            let [mut off, mut band, mut all] = [0.0, 0.0, 0.0];
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
            ]
        })
    }
}

/// Where curvature comes from: what a style says, and the method of transparency.
const SOURCES: [(&str, &str, &str); 3] =
    [("surface", "surface", "packed"), ("screen", "screen", "packed"), ("bkb", "auto", "bkb")];

fn look(form: &Form, (name, source, method): (&str, &str, &str), zoom: f64) -> Result<Look, MeasureError> {
    let (camera, zoom_by) = (form.camera, form.zoom * zoom);
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "black", {camera}, "zoom": {zoom_by} }}, "geometry": {{ "atom": "1A", "scale": 1 }},
              "transparency": {{ "method": "{method}", "k": 8 }}, "mapping": {{ "*": "shade" }},
              "shaders": [{{ "name": "shade", "shader": "curvature", "properties": {{ "base_color": "#808080", "shading": "unlit",
                "contour_width": "0pt", "gain": 0.4, "opacity_transfer": [[0, 1], [1, 1]],
                "color_transfer": [[-1, 0, 0, 0], [1, 2, 2, 2]], "curvature_source": "{source}" }} }}] }}"##
    );
    Look::of_text(&format!("{} {name} {zoom}", form.name), &text)
}

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
                "The truth are five implicit surfaces, crossed along the ray of each pixel's centre in double precision; curvature is the divergence of \
                 their normals, and errors are over the root of the sum of both squares. Pictures tell curvature by flat shades of 16 bits, one sample a pixel. Within {BAND_PX} px of silhouettes and ends it is \
                 judged apart. The sphere is one to the device, the others are meshes of 6,400 to 129,600 triangles with exact normals at their vertices."
            ),
            "Signs are judged where the curvature is above a twentieth of its largest. The bucketed k-buffer keeps normals of 15 + 15 + 2 bits, and \
             colours of 8 bits, which is as much as its shades can tell; where a neighbour is missing it says -1."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let most = |method: &'static str, name: &'static str| {
            let of = rows.iter().filter(|row| row.entry.method == method && row.entry.size[0] >= SIZES[0]);
            short(of.filter_map(|row| row.figure(name)).fold(0.0, f64::max))
        };
        format!(
            "From {} pixels on the error is at most {} of the surface itself, {} from neighbouring pixels and {} in the bucketed k-buffer, as a share of \
             the curvature; next to silhouettes {}, {} and {}. Signs are wrong on at most {}, {} and {} % of the pixels.",
            SIZES[0],
            most("surface", ERROR),
            most("screen", ERROR),
            most("bkb", ERROR),
            most("surface", BAND),
            most("screen", BAND),
            most("bkb", BAND),
            most("surface", SIGNS),
            most("screen", SIGNS),
            most("bkb", SIGNS),
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
            let model: Scene = scene(form.file, (form.text)().as_bytes())?;
            let stage = Stage::new(gpu, model.clone());
            for (&side, zoom) in sizes.iter().flat_map(|side| ZOOMS.map(|zoom| (side, zoom))) {
                let size = [side, side];
                let request = Request { wide: true, ..Request::new(size, 1) };
                let mut engine = Engine::new(gpu.clone(), model.clone(), look(form, SOURCES[0], zoom)?.style());
                engine.draw(&request, false, &mut |_| ControlFlow::Continue(()))?;
                let seen = engine.camera(size).zip(engine.curvature_scale());
                let (camera, scale) = seen.ok_or(GpuError::NothingToDraw)?;
                let scale = 0.4 * scale;
                let radius = f64::from(model.bounding_sphere().radius).max(1.0);
                let map = Rc::new(Map::new(form, &camera, size, radius));
                let image = map.image(scale);
                let truth = Truth::new(move |_| Ok(image.clone()));
                for source in SOURCES {
                    let (method, ..) = source;
                    cases.push(Case {
                        entry: Entry {
                            scene: form.name.to_owned(),
                            method: method.to_owned(),
                            settings: settings(json!({ "zoom": zoom })),
                            series: method.to_owned(),
                            point: format!("{side} {zoom}"),
                            extent: f64::from(side),
                            is_published: method == "bkb",
                            size,
                        },
                        subject: Box::new(stage.frame(&look(form, source, zoom)?, request)),
                        truth: Some(Rc::clone(&truth)),
                        judge: Some(Rc::clone(&map).judge(scale)),
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
        for form in &FORMS {
            scene(form.file, (form.text)().as_bytes()).unwrap_or_else(|error| panic!("{}: {error}", form.name));
            for source in SOURCES {
                look(form, source, 2.0).unwrap_or_else(|error| panic!("{}: {error}", form.name));
            }
        }
    }

    #[test]
    fn curvature_of_formulas_is_known() {
        let [sphere, cylinder, torus, ..] = &FORMS;
        for (form, point, due) in [
            (sphere, DVec3::new(0.0, 0.6, 0.8), -2.0),
            (cylinder, DVec3::new(0.3, 0.4, 1.0), -2.0),
            (torus, DVec3::new(1.4, 0.0, 0.0), -1.0 / 0.4 - 1.0 / 1.4),
            (torus, DVec3::new(0.6, 0.0, 0.0), -1.0 / 0.4 + 1.0 / 0.6),
        ] {
            let [kappa, squares] = form.curvatures(point, -form.gradient(point));
            assert!((kappa - due).abs() < 1e-4, "{}: {kappa} for {due}", form.name);
            assert!((form.curvatures(point, form.gradient(point))[0] + due).abs() < 1e-4, "from within");
            assert!(squares >= 0.5 * kappa * kappa - 1e-6, "{}: {squares}", form.name);
        }
    }
}
