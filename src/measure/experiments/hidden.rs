//! `hidden`: whether what lies within a machine is seen, by opacity that follows curvature and by one opacity for all.

use std::ops::ControlFlow;
use std::rc::Rc;
use std::sync::Arc;

use serde_json::{Value as Json, json};

use crate::config::Style;
use crate::engine::{Engine, Gpu, Request};
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::Row;
use crate::measure::stage::{Look, Stage, device, shipped_scene};
use crate::scene::{Image, Scene};
use crate::shipped::{LOOKS, find};

const SCENE: &str = "gearbox";
const LOOK: &str = "xray";
const SIZE: [u32; 2] = [512, 512];
/// Of the parts, every so many are taken out in turn.
const EVERY: usize = 5;
/// Change of display values from which on the lack of a part is seen, on average over its pixels.
const SEEN: f64 = 0.05;
/// Share of its pixels that a part may show of itself in an opaque picture and still count as hidden.
const HIDDEN: f64 = 0.05;
/// Change of display values that is none.
const SAME: f64 = 0.02;
/// Pixels that a part covers at the least: fewer are no picture of it.
const LEAST_PIXELS: usize = 12;
/// Halvings of the range in which the one opacity lies.
const HALVINGS: usize = 8;

const XRAY: &str = "opacity by curvature";
const CONSTANT: &str = "one opacity";
/// Figures: share of the hidden parts whose lack is not seen, and the mean change of the part in the middle.
const UNSEEN: &str = "hidden parts whose lack is not seen, share";
const MIDDLE: &str = "mean change by the part in the middle, 0 to 1";

/// The experiment.
pub struct Hidden;

/// How all parts are shaded.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    /// As the look does.
    ByCurvature,
    /// In flat colours of one opacity.
    Flat(f64),
}

/// The look with its parts shaded in a way, but for those of a name, which are not there, or there alone.
fn look(way: Way, without: Option<&str>, alone: Option<&str>) -> Result<Look, MeasureError> {
    let bad = |error: String| MeasureError::Content(format!("{LOOK}: {error}"));
    let file = find(LOOKS, LOOK).ok_or_else(|| bad("is not shipped".to_owned()))?;
    let text = String::from_utf8_lossy(file.bytes);
    let plain: String = text.lines().filter(|line| !line.starts_with("//")).collect();
    let mut style: Json = serde_json::from_str(&plain).map_err(|error| bad(error.to_string()))?;
    if let Way::Flat(opacity) = way {
        style["shaders"][0] =
            json!({ "name": "parts", "shader": "unlit", "properties": { "base_color": "part", "opacity": opacity } });
    }
    if let Some(name) = without {
        style["mapping"][format!("mesh[part={name}]")] = Json::Null;
    }
    if let Some(name) = alone {
        style["mapping"]["mesh"] = Json::Null;
        style["mapping"][format!("mesh[part={name}]")] = "parts".into();
    }
    Look::of_text(&format!("{way:?} {without:?} {alone:?}"), &style.to_string())
}

/// Draws the scene in one style after another.
struct Drawer {
    engine: Engine,
    request: Request,
}

impl Drawer {
    fn new(gpu: &Arc<Gpu>, scene: Scene, style: Style, size: [u32; 2]) -> Drawer {
        let request = Request { transparent: true, wide: true, ..Request::new(size, 4) };
        Drawer { engine: Engine::new(Arc::clone(gpu), scene, style), request }
    }

    fn draw(&mut self, look: &Look) -> Result<Image, MeasureError> {
        self.engine.set_style(look.style());
        self.engine.draw(&self.request, false, &mut |_| ControlFlow::Continue(()))?;
        Ok(self.engine.read(&self.request)?)
    }
}

fn pixels(image: &Image) -> Vec<[f64; 4]> {
    let [width, height] = image.size;
    let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    // What is shown on black.
    all.map(|(x, y)| {
        let [r, g, b, a] = image.pixel(x, y).map(f64::from);
        [r * a, g * a, b * a, a]
    })
    .collect()
}

fn mean_coverage(image: &Image) -> f64 {
    let pixels = pixels(image);
    pixels.iter().map(|pixel| pixel[3]).sum::<f64>() / pixels.len().max(1) as f64
}

/// Mean over some pixels of the largest change of a channel.
fn change(a: &[[f64; 4]], b: &[[f64; 4]], own: &[usize]) -> f64 {
    let largest = |at: &usize| (0..3).map(|channel| (a[*at][channel] - b[*at][channel]).abs()).fold(0.0, f64::max);
    own.iter().map(largest).sum::<f64>() / own.len().max(1) as f64
}

/// The changes that hidden parts make, by each of both ways.
struct Changes {
    curvature: Vec<f64>,
    constant: Vec<f64>,
    opacity: f64,
}

fn changes(gpu: &Arc<Gpu>, scene: &Scene, size: [u32; 2], every: usize) -> Result<Changes, MeasureError> {
    let xray = look(Way::ByCurvature, None, None)?;
    let mut drawer = Drawer::new(gpu, scene.clone(), xray.style(), size);
    let coverage = mean_coverage(&drawer.draw(&xray)?);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let covers = mean_coverage(&drawer.draw(&look(Way::Flat(middle), None, None)?)?);
        (low, high) = if covers < coverage { (middle, high) } else { (low, middle) };
    }
    let opacity = 0.5 * (low + high);
    let ways = [Way::ByCurvature, Way::Flat(opacity), Way::Flat(1.0)];
    let mut whole = Vec::new();
    for way in ways {
        whole.push(pixels(&drawer.draw(&look(way, None, None)?)?));
    }
    let mut found = Changes { curvature: Vec::new(), constant: Vec::new(), opacity };
    for part in scene.assembly.parts.iter().step_by(every) {
        let name = &scene.assembly.names[part.name as usize];
        let alone = pixels(&drawer.draw(&look(Way::Flat(1.0), None, Some(name))?)?);
        let own: Vec<usize> = (0..alone.len()).filter(|at| alone[*at][3] > 0.5).collect();
        if own.len() < LEAST_PIXELS {
            continue;
        }
        let mut changed = [0.0; 3];
        for ((way, whole), changed) in ways.into_iter().zip(&whole).zip(&mut changed) {
            let without = pixels(&drawer.draw(&look(way, Some(name), None)?)?);
            *changed = if way == Way::Flat(1.0) {
                let differs = |at: &&usize| (0..3).any(|c| (whole[**at][c] - without[**at][c]).abs() > SAME);
                own.iter().filter(differs).count() as f64 / own.len() as f64
            } else {
                change(whole, &without, &own)
            };
        }
        if changed[2] < HIDDEN {
            found.curvature.push(changed[0]);
            found.constant.push(changed[1]);
        }
    }
    Ok(found)
}

fn figures(changes: &[f64]) -> Vec<(&'static str, f64)> {
    let mut sorted = changes.to_vec();
    sorted.sort_by(f64::total_cmp);
    let unseen = sorted.iter().filter(|change| **change < SEEN).count() as f64 / sorted.len().max(1) as f64;
    vec![(UNSEEN, unseen), (MIDDLE, sorted.get(sorted.len() / 2).copied().unwrap_or(0.0))]
}

impl Experiment for Hidden {
    fn name(&self) -> &'static str {
        "hidden"
    }

    fn doc(&self) -> &'static str {
        "How much of the picture changes where a hidden part of the shipped assembly is taken out, in the look xray and with one opacity for all."
    }

    fn chart(&self) -> ChartKind {
        let error = ErrorKind::Figure { name: UNSEEN, title: "hidden parts whose lack is not seen, share" };
        ChartKind::CostAgainstError { error, per_pixel: false, has_front: false }
    }

    fn conditions(&self, setup: &Setup) -> Vec<String> {
        let each = if setup.thorough { "Each part".to_owned() } else { format!("Every {EVERY}th part") };
        vec![
            format!(
                "{each} of the shipped assembly is taken out in turn. Hidden is one of whose own pixels at most {} % change in an opaque picture; its lack \
                 is seen where they change by {SEEN} of the display values' range or more, on average of the largest channel.",
                100.0 * HIDDEN
            ),
            "The one opacity is that at which the picture covers as much of what is behind it as in xray. Both have the parts' flat colours and 4 \
             samples a pixel."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let of = |method: &str, name: &str| {
            rows.iter().find(|row| row.entry.method == method).and_then(|row| row.figure(name)).unwrap_or(f64::NAN)
        };
        format!(
            "By curvature the lack of {} % of the hidden parts is seen, with one opacity that of {} %; the part in the middle changes its pixels by {} \
             and by {}.",
            short(100.0 * (1.0 - of(XRAY, UNSEEN))),
            short(100.0 * (1.0 - of(CONSTANT, UNSEEN))),
            short(of(XRAY, MIDDLE)),
            short(of(CONSTANT, MIDDLE)),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let scene = shipped_scene(SCENE)?;
        let found = changes(gpu, &scene, size, if setup.thorough { 1 } else { EVERY })?;
        let request = Request::new(size, 1);
        let stage = Stage::new(gpu, scene.clone());
        let ways = [
            (XRAY, look(Way::ByCurvature, None, None)?, found.curvature, Json::Null),
            (CONSTANT, look(Way::Flat(found.opacity), None, None)?, found.constant, json!(found.opacity)),
        ];
        let case = |(method, look, changes, opacity): (&str, Look, Vec<f64>, Json)| {
            let found = figures(&changes);
            Case {
                entry: Entry {
                    scene: SCENE.to_owned(),
                    method: method.to_owned(),
                    settings: settings(json!({ "hidden_parts": changes.len(), "opacity": opacity })),
                    series: method.to_owned(),
                    point: String::new(),
                    extent: changes.len() as f64,
                    is_published: false,
                    size,
                },
                subject: Box::new(stage.frame(&look, request)),
                truth: Some(look.exact(&scene, request)),
                judge: Some(Rc::new(move |_, _| found.clone())),
            }
        };
        Ok(ways.into_iter().map(case).collect())
    }
}
