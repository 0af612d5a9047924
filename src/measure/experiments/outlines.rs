//! `outlines`: three ways to draw lines, against lines found between many places of each pixel.

use std::rc::Rc;

use serde_json::json;

use crate::engine::Request;
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, Judge, MeasureError, Setup, settings};
use crate::measure::metrics::LineErrors;
use crate::measure::page::short;
use crate::measure::run::{Row, geometric_mean};
use crate::measure::stage::{Look, Stage, device, scene, shipped_scene};
use crate::scene::Scene;

/// Two molecules, and three parts with hard edges.
const SCENES: [&str; 5] = ["c60", "alpha_helix", "cube", "bracket", "gearbox"];

/// A cube that stands askew.
const CUBE: &str = "v -.9 -.6 .7\nv .5 -1 .9\nv 1 .4 .6\nv -.4 .8 .4\nv -1 -.4 -.7\nv .4 -.8 -.5\nv .9 .6 -.8\nv -.5 1 -1\n\
                    f 1 2 3 4\nf 6 5 8 7\nf 2 6 7 3\nf 5 1 4 8\nf 4 3 7 8\nf 5 6 2 1\n";

/// Widths of lines in pixels, each with the cosine of the dot-product line that is as wide around spheres of 20 px.
const WIDTHS: [(f64, f64); 2] = [(1.5, 0.38), (4.0, 0.6)];

const SIZE: [u32; 2] = [256, 256];
/// Places of a pixel between which the truth looks for edges.
const TRUTH_SAMPLES: u32 = 16;

/// The error of the chart.
const F1_ERROR: &str = "1 - F1";

/// How lines are drawn, and which.
#[derive(Clone, Copy, PartialEq)]
enum Lines {
    /// What turns away from the view, as published [Prost2016 §4.1].
    Dot,
    /// Back faces of an enlarged object, as published [Prost2016 §4.1].
    Hull,
    /// `outlinePost`, where depth jumps.
    Silhouette,
    /// The same between objects.
    Boundary,
    /// The same along folds.
    Crease,
}

const KINDS: [(Lines, &str); 5] = [
    (Lines::Dot, "dot product"),
    (Lines::Hull, "hull"),
    (Lines::Silhouette, "screen space, silhouettes"),
    (Lines::Boundary, "screen space, boundaries"),
    (Lines::Crease, "screen space, creases"),
];

/// The experiment.
pub struct Outlines;

/// A style that draws objects in green, and lines of this kind in red.
fn look(kind: Lines, (width_px, cosine): (f64, f64), height_px: u32) -> Result<Look, MeasureError> {
    let points = width_px * 1080.0 / f64::from(height_px);
    let number = KINDS.iter().position(|(other, _)| *other == kind).unwrap_or(0);
    let name = format!("lines {number} of {width_px}");
    let of_kind = |other: Lines| if kind == other { points } else { 0.0 };
    let (hull, silhouette, boundary, crease) =
        (of_kind(Lines::Hull), of_kind(Lines::Silhouette), of_kind(Lines::Boundary), of_kind(Lines::Crease));
    let cosine = if kind == Lines::Dot { cosine } else { 0.0 };
    let objects = match kind {
        Lines::Dot | Lines::Hull => format!(
            r##""shader": "toon", "properties": {{ "steps": 1, "base_color": "#00ff00", "color": "#ff0000",
                "hull_size": "{hull}pt", "outline_bias": {cosine} }}"##
        ),
        _ => r##""shader": "unlit", "properties": { "base_color": "#00ff00" }"##.to_owned(),
    };
    let effects = if silhouette + boundary + crease > 0.0 { r#", "post_effects": ["lines"]"# } else { "" };
    let lines = format!(
        r##", {{ "name": "lines", "shader": "outlinePost", "properties": {{ "depth_step": "0r", "boundary": "object",
            "silhouette_color": "#ff0000", "boundary_color": "#ff0000", "crease_color": "#ff0000", "silhouette_width": "{silhouette}pt",
            "boundary_width": "{boundary}pt", "crease_width": "{crease}pt" }} }}"##
    );
    let lines = if effects.is_empty() { "" } else { &lines };
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "#0000ff" }}, "mapping": {{ "*": "objects"{effects} }},
              "shaders": [{{ "name": "objects", {objects} }}{lines}] }}"##
    );
    Look::of_text(&name, &text)
}

fn load(name: &str) -> Result<Scene, MeasureError> {
    if name == "cube" { scene("cube.obj", CUBE.as_bytes()) } else { shipped_scene(name) }
}

/// What a picture's lines are like; widths in pixels.
fn judge(width_px: f64) -> Judge {
    Rc::new(move |truth, picture| {
        let errors = LineErrors::of(truth, picture, width_px);
        vec![
            ("precision", errors.precision),
            ("recall", errors.recall),
            (F1_ERROR, 1.0 - errors.f1()),
            ("width error, px", errors.width_error_px),
            ("gaps", errors.gaps as f64),
        ]
    })
}

impl Experiment for Outlines {
    fn name(&self) -> &'static str {
        "outlines"
    }

    fn doc(&self) -> &'static str {
        "How well lines by dot product, by hull and in screen space lie where edges are, on molecules and parts, and their cost."
    }

    fn chart(&self) -> ChartKind {
        let error = ErrorKind::Figure { name: F1_ERROR, title: "error: 1 - F1 of line pixels within 1 px, 0 to 1" };
        ChartKind::CostAgainstError { error, per_pixel: false, has_front: true }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            format!(
                "The truth is the reference renderer's lines, found between {TRUTH_SAMPLES} places of each pixel: silhouettes for dot \
                 product, hull and silhouettes, and those of their kind for boundaries and creases. Pictures have one sample a pixel."
            ),
            "Precision: the share of drawn line pixels that lie within a pixel of true ones. Recall: the share of true ones that lie \
             within a pixel of drawn ones. Width error: the mean difference of the area that lines cover around each pixel of a true \
             line, by its length there. Gaps: connected pieces of true lines of which nothing is drawn."
                .to_owned(),
            format!(
                "Lines are {} and {} pixels wide. A dot-product line has no width: its cosines, {} and {}, give those around spheres \
                 of 20 pixels.",
                WIDTHS[0].0, WIDTHS[1].0, WIDTHS[0].1, WIDTHS[1].1
            ),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let is_part = |row: &Row| ["cube", "bracket", "gearbox"].contains(&&*row.entry.scene);
        let of =
            |kind: usize| rows.iter().filter(move |row| row.entry.series == KINDS[kind].1 && !row.figures.is_empty());
        let figure = |row: &Row, name: &str| row.figure(name).unwrap_or(f64::NAN);
        let worst = |rows: &mut dyn Iterator<Item = &Row>, name: &str| {
            let least = rows.min_by(|a, b| figure(a, name).total_cmp(&figure(b, name)));
            least.map_or("nothing".to_owned(), |row| {
                format!("{} ({}, {} px)", short(figure(row, name)), row.entry.scene, row.entry.point)
            })
        };
        let [dot, hull] = [0, 1].map(|kind| worst(&mut of(kind).filter(|row| is_part(row)), "recall"));
        let [precision, recall] = ["precision", "recall"].map(|name| worst(&mut (2..5).flat_map(of), name));
        let widths = (2..5).flat_map(of).map(|row| figure(row, "width error, px"));
        let cost = |kind: usize| geometric_mean(of(kind).map(Row::median_ms));
        format!(
            "In screen space precision is at least {precision} and recall at least {recall}, with widths wrong by {} px at the most. \
             Of the silhouettes of parts dot products find as little as {dot} and hulls {hull}; a hull costs {} times a dot product, \
             lines in screen space {} to {} times.",
            short(widths.fold(0.0, f64::max)),
            short(cost(1) / cost(0)),
            short((2..5).map(cost).fold(f64::INFINITY, f64::min) / cost(0)),
            short((2..5).map(cost).fold(0.0, f64::max) / cost(0)),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let truth_samples = if setup.thorough { 64 } else { TRUTH_SAMPLES };
        let mut cases = Vec::new();
        for name in SCENES {
            let scene = load(name)?;
            let stage = Stage::new(gpu, scene.clone());
            for width in WIDTHS {
                let truth = |kind| {
                    let look = look(kind, width, size[1])?;
                    Ok::<_, MeasureError>(look.exact(&scene, Request::new(size, truth_samples)))
                };
                let silhouettes = truth(Lines::Silhouette)?;
                for (kind, method) in KINDS {
                    let truth = match kind {
                        Lines::Boundary | Lines::Crease => truth(kind)?,
                        _ => Rc::clone(&silhouettes),
                    };
                    let settings = settings(json!({ "width": format!("{} px", width.0) }));
                    cases.push(Case {
                        entry: Entry {
                            scene: name.to_owned(),
                            method: method.to_owned(),
                            settings,
                            series: method.to_owned(),
                            point: width.0.to_string(),
                            extent: width.0,
                            is_published: matches!(kind, Lines::Dot | Lines::Hull),
                            size,
                        },
                        subject: Box::new(stage.frame(&look(kind, width, size[1])?, Request::new(size, 1))),
                        truth: Some(truth),
                        judge: Some(judge(width.0)),
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
        for name in SCENES {
            load(name).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        for (kind, name) in KINDS {
            look(kind, WIDTHS[0], 256).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }
}
