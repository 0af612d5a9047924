//! `geometry`: ray-cast impostors against tessellated spheres.

use std::fmt::Write as _;
use std::rc::Rc;

use glam::{DVec3, Vec3};
use serde_json::json;

use crate::engine::Request;
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::{Row, geometric_mean};
use crate::measure::stage::{Look, Stage, device, scene};
use crate::scene::Scene;

/// Subdivisions of an icosahedron, and the triangles that they come to.
const LEVELS: [u32; 4] = [1, 2, 3, 4];
const TRIANGLES: [usize; 4] = [80, 320, 1280, 5120];
/// Spheres of the scenes: with 5120 triangles each, half a million and two.
const COUNTS: [usize; 2] = [20, 97];
const COUNTS_THOROUGH: [usize; 3] = [20, 97, 390];
/// Sides of the square pictures, in pixels.
const SIDES: [u32; 2] = [128, 512];
/// Samples a pixel: with one, the pixels' own steps would hide those of the triangles.
const SAMPLES: u32 = 16;
const TRUTH_SAMPLES: u32 = 256;
/// Between centres, in angstrom: nothing is bonded, and hardly anything is hidden.
const SPACING: f64 = 5.0;
const IMPOSTORS: &str = "impostors";

/// One colour, so that errors are those of silhouettes alone. What bounds both scenes alike is not drawn.
const STYLE: &str = r##"{ "camera": { "bgcolor": [255, 255, 255] }, "geometry": { "atom": "vdw", "scale": 1 },
  "mapping": { "atom": "flat", "mesh": "flat", "mesh[part=bounds]": null },
  "shaders": [{ "name": "flat", "shader": "unlit", "properties": { "base_color": "#2f5f9f" } }] }"##;

/// The experiment.
pub struct Geometry;

/// Carbon on a square grid, slightly deep.
fn atoms(count: usize) -> Result<Scene, MeasureError> {
    let side = (count as f64).sqrt().ceil() as usize;
    let mut text = format!("{count}\n\n");
    for index in 0..count {
        let [x, y] = [index % side, index / side].map(|at| at as f64 * SPACING);
        // Each is cut by pixels in its own way.
        let z = (index as f64 * 0.618).fract() * SPACING;
        let _ = writeln!(text, "C {:.3} {:.3} {z:.3}", x + 0.31 * z, y - 0.17 * z);
    }
    scene("spheres.xyz", text.as_bytes())
}

/// Vertices and triangles of an icosahedron whose faces are parted in four, so many times, on the unit sphere.
fn icosphere(level: u32) -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let t = 0.5 * (1.0 + 5f64.sqrt());
    let corners = [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)];
    let turned =
        |turn: usize| corners.map(|(a, b)| [DVec3::new(a, b, 0.0), DVec3::new(0.0, a, b), DVec3::new(b, 0.0, a)][turn]);
    let mut vertices: Vec<DVec3> = (0..3).flat_map(turned).map(DVec3::normalize).collect();
    let mut triangles = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..level {
        let mut middles = std::collections::HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a] + vertices[b]).normalize());
                vertices.len() - 1
            })
        };
        let parted = triangles.iter().flat_map(|&[a, b, c]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        });
        triangles = parted.collect();
    }
    (vertices, triangles)
}

/// The same spheres as triangles, in a mesh that has the same bounds.
fn tessellated(atoms: &Scene, level: u32) -> Result<Scene, MeasureError> {
    let (vertices, triangles) = icosphere(level);
    let bounds = atoms.bounding_sphere();
    let mut text = "o bounds\n".to_owned();
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for at in [bounds.center + axis * bounds.radius, bounds.center - axis * bounds.radius] {
            let _ = writeln!(text, "v {} {} {}", at.x, at.y, at.z);
        }
    }
    for [a, b, c] in [[1, 3, 5], [3, 2, 5], [2, 4, 5], [4, 1, 5], [3, 1, 6], [2, 3, 6], [4, 2, 6], [1, 4, 6]] {
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text.push_str("o spheres\n");
    let mut first = 7;
    for (center, radius) in atoms.molecule.drawn_balls() {
        for vertex in &vertices {
            let at = center.as_dvec3() + *vertex * f64::from(radius);
            let _ = writeln!(text, "v {:.6} {:.6} {:.6}", at.x, at.y, at.z);
        }
        for corners in &triangles {
            let [a, b, c] = corners.map(|corner| corner + first);
            let _ = writeln!(text, "f {a} {b} {c}");
        }
        first += vertices.len();
    }
    scene("spheres.obj", text.as_bytes())
}

fn rmse(row: &Row) -> f64 {
    row.error.as_ref().map_or(f64::NAN, |error| error.display.rmse.all)
}

/// Whether triangles take less time than the impostors of the same spheres.
fn is_quicker(row: &Row, rows: &[Row]) -> bool {
    let is_same = |other: &&Row| other.entry.scene == row.entry.scene && other.entry.size == row.entry.size;
    let impostors = rows.iter().filter(is_same).find(|other| other.entry.method == IMPOSTORS);
    impostors.is_some_and(|impostors| row.median_ms() < impostors.median_ms())
}

impl Experiment for Geometry {
    fn name(&self) -> &'static str {
        "geometry"
    }

    fn doc(&self) -> &'static str {
        "What spheres of 80 to 5120 triangles cost and how wrong their silhouettes are, beside ray-cast impostors."
    }

    fn chart(&self) -> ChartKind {
        ChartKind::CostAgainstError { error: ErrorKind::Rmse, per_pixel: false, has_front: true }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            format!(
                "Spheres stand apart in one flat colour, so that errors are those of silhouettes. Pictures and times are of \
                 {SAMPLES} samples a pixel; the truth is the reference renderer's exact spheres with {TRUTH_SAMPLES}."
            ),
            "Triangles are of subdivided icosahedra with their vertices on the sphere; at most two million a row."
                .to_owned(),
            "In the chart, a large point is the geometric mean over the numbers of spheres, which are the small points."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let [impostors, coarse, fine] = [0.0, TRIANGLES[0] as f64, TRIANGLES[3] as f64].map(|triangles| {
            let rows = rows.iter().filter(move |row| row.entry.extent == triangles);
            [
                geometric_mean(rows.clone().map(Row::median_ms)),
                geometric_mean(rows.clone().map(rmse)),
                geometric_mean(rows.map(|row| row.bytes as f64)),
            ]
        });
        let mut quicker: Vec<&Row> = rows.iter().filter(|row| is_quicker(row, rows)).collect();
        quicker.sort_by(|a, b| a.entry.extent.total_cmp(&b.entry.extent));
        let crossover = match quicker.last() {
            Some(row) => format!(
                "Triangles are quicker in {} of {} cases, at the most {} for {} at {}x{}",
                quicker.len(),
                rows.iter().filter(|row| row.entry.extent > 0.0).count(),
                row.entry.method,
                row.entry.scene,
                row.entry.size[0],
                row.entry.size[1]
            ),
            None => "There is no crossover on this adapter: no tessellation is quicker in any case".to_owned(),
        };
        format!(
            "{crossover}; {} triangles a sphere take {} times the time of impostors, with {} times their error. {} triangles come to \
             {} times their error, for {} times the time and {} times the memory.",
            TRIANGLES[0],
            short(coarse[0] / impostors[0]),
            short(coarse[1] / impostors[1]),
            TRIANGLES[3],
            short(fine[1] / impostors[1]),
            short(fine[0] / impostors[0]),
            short(fine[2] / impostors[2]),
        )
    }

    fn findings(&self, rows: &[Row]) -> Vec<String> {
        let mut findings = Vec::new();
        for impostors in rows.iter().filter(|row| row.entry.method == IMPOSTORS) {
            let meshes: Vec<&Row> = rows
                .iter()
                .filter(|row| {
                    row.entry.scene == impostors.entry.scene
                        && row.entry.size == impostors.entry.size
                        && row.entry.method != IMPOSTORS
                })
                .collect();
            let said = |row: &Row| format!("{} ms, RMSE {}", short(row.median_ms()), short(rmse(row)));
            let quicker = meshes.iter().filter(|row| is_quicker(row, rows));
            let crossover = match quicker.max_by(|a, b| a.entry.extent.total_cmp(&b.entry.extent)) {
                Some(row) => format!("spheres of up to {} are quicker ({})", row.entry.method, said(row)),
                None => "no tessellation is quicker".to_owned(),
            };
            let as_good = meshes.iter().find(|row| rmse(row) <= 1.1 * rmse(impostors));
            let as_good = match as_good {
                Some(row) => format!("as near to the truth are {} ({})", row.entry.method, said(row)),
                None => "none is as near to the truth".to_owned(),
            };
            findings.push(format!(
                "{} at {}x{}: impostors take {}; {crossover}; {as_good}.",
                impostors.entry.scene,
                impostors.entry.size[0],
                impostors.entry.size[1],
                said(impostors)
            ));
        }
        findings
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let look = Look::of_text("spheres", STYLE)?;
        let counts: &[usize] = if setup.thorough { &COUNTS_THOROUGH } else { &COUNTS };
        let sizes = setup.size.map_or(SIDES.map(|side| [side; 2]).to_vec(), |size| vec![size]);
        let mut cases = Vec::new();
        for &count in counts {
            let spheres = atoms(count)?;
            let truths: Vec<_> =
                sizes.iter().map(|size| look.exact(&spheres, Request::new(*size, TRUTH_SAMPLES))).collect();
            let mut kinds = vec![(IMPOSTORS.to_owned(), 0, Stage::new(gpu, spheres.clone()))];
            for (level, triangles) in LEVELS.into_iter().zip(TRIANGLES) {
                let stage = Stage::new(gpu, tessellated(&spheres, level)?);
                kinds.push((format!("{triangles} triangles"), triangles, stage));
            }
            for (size, truth) in sizes.iter().zip(&truths) {
                for (method, triangles, stage) in &kinds {
                    let settings = settings(json!({ "size": size, "samples": SAMPLES }));
                    cases.push(Case {
                        entry: Entry {
                            scene: format!("{count} spheres"),
                            method: method.clone(),
                            settings,
                            series: method.clone(),
                            point: format!("{}x{}", size[0], size[1]),
                            extent: *triangles as f64,
                            is_published: false,
                            size: *size,
                        },
                        subject: Box::new(stage.frame(&look, Request::new(*size, SAMPLES))),
                        truth: Some(Rc::clone(truth)),
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

    #[test]
    fn icospheres_are_closed_and_wound_one_way() {
        for level in 0..3 {
            let (vertices, triangles) = icosphere(level);
            assert_eq!((triangles.len(), vertices.len()), (20 * 4usize.pow(level), 2 + 10 * 4usize.pow(level)));
            for [a, b, c] in triangles.iter().map(|corners| corners.map(|corner| vertices[corner])) {
                assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
            }
        }
    }

    #[test]
    fn both_scenes_are_framed_alike() {
        let spheres = atoms(5).unwrap();
        let mesh = tessellated(&spheres, 1).unwrap();
        // The mesh lies around its own middle.
        let [a, b] = [spheres.bounding_sphere(), mesh.bounding_sphere()];
        assert!((a.radius - b.radius).abs() < 1e-4 * a.radius && b.center.length() < 1e-4, "{a:?} {b:?}");
        assert_eq!((spheres.molecule.bonds.len(), mesh.assembly.num_triangles()), (0, 5 * 80 + 8));
    }
}
