//! `fig10`: what the bucketed k-buffer costs by the number of objects, after Fig. 10 of its paper [Murray2016 §6].

use std::fmt::Write as _;
use std::rc::Rc;

use serde_json::json;

use crate::engine::{BkbForm, Request};
use crate::measure::experiment::{
    Case, ChartKind, Entry, Experiment, Figure, Judge, MeasureError, Setup, Subject, settings,
};
use crate::measure::page::short;
use crate::measure::run::{PassTimes, Row, quantile};
use crate::measure::stage::{GpuFrame, Look, Stage, device, scene};
use crate::scene::{Image, Scene, linear_from_srgb};

const SIZE: [u32; 2] = [256, 256];
/// That of the paper.
const SIZE_THOROUGH: [u32; 2] = [512, 512];

/// Squares across the whole picture, and slots of a pixel.
const SQUARES: usize = 32;

const OBJECTS: [usize; 5] = [1, 2, 4, 8, 32];

/// Opacity of all that is not said to be clear: that of Fig. 9 of the paper.
const OPACITY: f64 = 0.6;
/// So clear that light comes through all squares.
const OPACITY_CLEAR: f64 = 0.05;

/// A row of each number of objects.
struct Kind {
    name: &'static str,
    /// None for lists.
    form: Option<BkbForm>,
    opacity: f64,
    /// Whether opacity is by curvature in lists, too.
    is_curved: bool,
}

impl Kind {
    const fn buffer(name: &'static str, form: BkbForm) -> Kind {
        Kind { name, form: Some(form), opacity: OPACITY, is_curved: false }
    }

    const fn lists(name: &'static str, opacity: f64, is_curved: bool) -> Kind {
        Kind { name, form: None, opacity, is_curved }
    }
}

const BKB: usize = 0;
const BRUTE_FORCE: usize = 2;

const KINDS: [Kind; 8] = [
    Kind::buffer("bkb", BkbForm::Published),
    Kind::buffer("bkb, no reverse check", BkbForm::OneWay),
    Kind::buffer("brute_force", BkbForm::BruteForce),
    Kind::buffer("dual_pass", BkbForm::DualPass),
    Kind::lists("packed", OPACITY, true),
    Kind::lists("packed, nothing cut off", OPACITY_CLEAR, true),
    Kind::lists("constant", OPACITY, false),
    Kind::lists("constant, nothing cut off", OPACITY_CLEAR, false),
];

/// Passes of what the paper calls build, query and blend, by their names in timings.
const BUILD: [&str; 7] =
    ["bkb_cleared", "bkb_inserted", "bkb_bucketed", "bkb_stored", "layers_counted", "layers_room", "layers_written"];
const QUERY: [&str; 1] = ["bkb_stylised"];
const BLEND: [&str; 2] = ["bkb_blended", "layers_blended"];

/// The experiment.
pub struct Fig10;

/// A square: its depth from 0 to 1, and its object.
#[derive(Clone, Copy)]
struct Square {
    depth: f64,
    object: usize,
}

/// Numbers that look random, the same ones each time [Steele2014, SplitMix].
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }
}

/// Squares at random depths, each of a random object, in the order in which they are drawn: object by object.
fn squares(objects: usize) -> Vec<Square> {
    let mut random = Random(10);
    let mut all: Vec<Square> = (0..SQUARES)
        .map(|_| Square {
            depth: (random.next() >> 11) as f64 / (1u64 << 53) as f64,
            object: (random.next() % objects as u64) as usize,
        })
        .collect();
    all.sort_by_key(|square| square.object);
    all
}

fn scene_of(squares: &[Square]) -> Result<Scene, MeasureError> {
    let mut text = String::new();
    for (index, square) in squares.iter().enumerate() {
        if index == 0 || squares[index - 1].object != square.object {
            let _ = writeln!(text, "o part{}", square.object);
        }
        // No edge lies on the centres of pixels.
        for [x, y] in [[-1.0, -0.93], [1.0, -0.93], [1.0, 1.1], [-1.0, 1.1]] {
            let _ = writeln!(text, "v {x} {y} {}", -square.depth);
        }
        let first = 4 * index + 1;
        let _ = writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
    }
    scene("squares.obj", text.as_bytes())
}

fn look(kind: &Kind) -> Result<Look, MeasureError> {
    let method = if kind.form.is_some() { "bkb" } else { "packed" };
    let opacity = kind.opacity;
    let shader = if kind.is_curved {
        // On squares, which are flat, the same picture.
        r#""curvature", "properties": { "shading": "unlit", "opacity_transfer": "constant", "color_transfer": "none", "contour_width": 0,"#
    } else {
        r#""unlit", "properties": {"#
    };
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "#f4ead0", "orthographic": true, "position": [0, 0, 1], "zoom": 2.5 }},
              "mapping": {{ "*": "glass", "mesh[part=part0]": "other" }},
              "shaders": [{{ "name": "glass", "shader": {shader} "base_color": "#2060d0", "opacity": {opacity} }} }},
                {{ "name": "other", "shader": {shader} "base_color": "#d05020", "opacity": {opacity} }} }}],
              "transparency": {{ "method": "{method}", "k": {SQUARES} }} }}"##
    );
    Look::of_text(&format!("{method} {opacity} {}", kind.is_curved), &text)
}

/// What the squares of each pixel come to, from the data: comparisons of fragments, fragments of a bucket, moves of the two sorts, and
/// atomics of the first pass.
fn counts(kind: &Kind, squares: &[Square]) -> Vec<Figure> {
    let sizes: Vec<f64> = (0..SQUARES)
        .map(|object| squares.iter().filter(|square| square.object == object).count() as f64)
        .filter(|size| *size > 0.0)
        .collect();
    let pairs: f64 = sizes.iter().map(|size| size * size).sum();
    let all = (SQUARES * SQUARES) as f64;
    let evaluations = match kind.form {
        Some(BkbForm::Published) => 8.0 * pairs,
        Some(BkbForm::OneWay) => 4.0 * pairs,
        Some(BkbForm::BruteForce) => 8.0 * all,
        Some(BkbForm::DualPass) | None => 0.0,
    };
    let mut sorted = squares.to_vec();
    sorted.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let later = |at: usize| sorted[at + 1..].iter().filter(|other| other.object < sorted[at].object).count();
    let inversions: usize = (0..SQUARES).map(later).sum();
    let has_buckets = kind.form.is_some_and(|form| form != BkbForm::DualPass);
    let moves = if has_buckets { 2.0 * inversions as f64 } else { 0.0 };
    // Each key asks as many slots as there are nearer ones, and carries farther ones on to the first free slot.
    let atomics = (SQUARES * (SQUARES + 1) / 2) as f64;
    vec![
        ("evaluations a pixel", evaluations),
        ("fragments a bucket", if has_buckets { SQUARES as f64 / sizes.len() as f64 } else { 0.0 }),
        ("sort moves a pixel", moves),
        ("atomics a pixel", if kind.form.is_some() { atomics } else { 2.0 * SQUARES as f64 }),
    ]
}

/// The largest error of any channel in linear light, beside the counts.
fn judge(counts: Vec<Figure>) -> Judge {
    Rc::new(move |truth, picture| {
        let linear = |image: &Image, x, y| image.pixel(x, y).map(|value| linear_from_srgb(f64::from(value)));
        let [width, height] = truth.size;
        let errors = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| {
            let (a, b) = (linear(truth, x, y), linear(picture, x, y));
            (0..3).map(|channel| (a[channel] - b[channel]).abs()).fold(0.0, f64::max)
        });
        std::iter::once(("largest error, linear", errors.fold(0.0, f64::max))).chain(counts.clone()).collect()
    })
}

/// A frame of which each round times the passes.
struct TimedFrame {
    frame: GpuFrame,
    last: PassTimes,
}

impl Subject for TimedFrame {
    fn frame_ms(&mut self) -> Result<f64, MeasureError> {
        let (ms, passes) = self.frame.timed_ms()?;
        self.last = passes;
        Ok(ms)
    }

    fn pass_ms(&mut self) -> Result<PassTimes, MeasureError> {
        Ok(self.last.clone())
    }

    fn bytes(&self) -> u64 {
        self.frame.bytes()
    }

    fn picture(&mut self) -> Result<Image, MeasureError> {
        self.frame.picture()
    }
}

/// Median milliseconds of some passes together.
fn median_of(row: &Row, names: &[&str]) -> f64 {
    let sums: Vec<f64> = row
        .pass_rounds
        .iter()
        .map(|passes| passes.iter().filter(|(name, _)| names.contains(name)).map(|(_, ms)| ms).sum())
        .collect();
    quantile(&sums, 0.5)
}

fn row_of(rows: &[Row], kind: usize, objects: usize) -> Option<&Row> {
    rows.iter().find(|row| row.entry.series == KINDS[kind].name && row.entry.extent == objects as f64)
}

impl Experiment for Fig10 {
    fn name(&self) -> &'static str {
        "fig10"
    }

    fn doc(&self) -> &'static str {
        "What neighbours of fragments cost by the number of objects: in buckets, among all fragments of a pixel, and without any."
    }

    fn chart(&self) -> ChartKind {
        ChartKind::TimeByExtent { extent: "objects" }
    }

    fn least_rounds(&self) -> usize {
        15
    }

    fn times_passes(&self) -> bool {
        true
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            format!(
                "The scene is that of Fig. 10 of Murray 2016: {SQUARES} squares across the whole picture at random depths, each of a random \
                 object of 1, 2, 4, 8 or 32, the same ones each time; {SQUARES} slots a pixel, one sample, an opacity of {OPACITY}. Times are \
                 medians over rounds in which all rows take turns."
            ),
            "brute_force looks for neighbours among all fragments of a pixel, after Carnecky 2013; dual_pass is the plain k-buffer with 8 bytes a \
             slot, without neighbours; packed has lists of 8 bytes a fragment, which stop where no light comes through, with curvature of the surface \
             itself, and constant the same lists without. No style asks for the first two."
                .to_owned(),
            format!(
                "Counts follow from the squares: comparisons of two fragments, moves of both sorts, and atomics, each for one pixel. Where nothing is \
                 cut off, opacity is {OPACITY_CLEAR}. The truth crosses every square in double precision; a slot has 8 bits for each channel and for \
                 opacity, which is what its largest error comes from."
            ),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let query =
            |kind: usize, objects: usize| row_of(rows, kind, objects).map_or(f64::NAN, |row| median_of(row, &QUERY));
        let brute = OBJECTS.map(|objects| query(BRUTE_FORCE, objects));
        let [least, most] = [f64::min, f64::max].map(|choose| brute.into_iter().fold(f64::NAN, choose));
        let gains = OBJECTS.map(|objects| query(BRUTE_FORCE, objects) / query(BKB, objects));
        let gains: Vec<String> =
            OBJECTS.iter().zip(gains).map(|(objects, gain)| format!("{} at {objects}", short(gain))).collect();
        format!(
            "Among all fragments of a pixel neighbours take {} to {} ms, whatever the number of objects. Buckets are this many times as quick: {}.",
            short(least),
            short(most),
            gains.join(", ")
        )
    }

    fn findings(&self, rows: &[Row]) -> Vec<String> {
        let parts = |row: &Row| {
            let of = |names: &[&str]| {
                let sums: Vec<f64> = row
                    .pass_rounds
                    .iter()
                    .map(|passes| passes.iter().filter(|(name, _)| names.contains(name)).map(|(_, ms)| ms).sum())
                    .collect();
                let [low, middle, high] = [0.25, 0.5, 0.75].map(|share| short(quantile(&sums, share)));
                format!("{middle} ({low} to {high})")
            };
            format!(
                "{}, {} objects: build {}, query {}, blend {}, frame {} ms.",
                row.entry.method,
                row.entry.extent,
                of(&BUILD),
                of(&QUERY),
                of(&BLEND),
                short(row.median_ms())
            )
        };
        rows.iter().map(parts).collect()
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(if setup.thorough { SIZE_THOROUGH } else { SIZE });
        let request = Request { wide: true, ..Request::new(size, 1) };
        let mut cases = Vec::new();
        for objects in OBJECTS {
            let squares = squares(objects);
            let scene = scene_of(&squares)?;
            let truths = [look(&KINDS[0])?.exact(&scene, request), look(&KINDS[5])?.exact(&scene, request)];
            for kind in &KINDS {
                // A stage each: one that changes what it shows draws it once more to be warm, and these frames are slow.
                let frame = Stage::new(gpu, scene.clone()).frame(&look(kind)?, request);
                let frame = GpuFrame { bkb_form: kind.form.unwrap_or_default(), ..frame };
                let truth = &truths[usize::from(kind.opacity == OPACITY_CLEAR)];
                cases.push(Case {
                    entry: Entry {
                        scene: format!("{SQUARES} squares of {objects} objects"),
                        method: kind.name.to_owned(),
                        settings: settings(json!({ "objects": objects, "opacity": kind.opacity })),
                        series: kind.name.to_owned(),
                        point: "frame".to_owned(),
                        extent: objects as f64,
                        is_published: kind.form == Some(BkbForm::Published),
                        size,
                    },
                    subject: Box::new(TimedFrame { frame, last: Vec::new() }),
                    truth: Some(Rc::clone(truth)),
                    judge: Some(judge(counts(kind, &squares))),
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
        for objects in OBJECTS {
            let squares = squares(objects);
            let mut depths: Vec<u32> = squares.iter().map(|square| (square.depth * 65534.0 * 0.3) as u32).collect();
            depths.sort_unstable();
            depths.dedup();
            assert_eq!(depths.len(), SQUARES, "no two at one depth");
            assert!(squares.iter().all(|square| square.object < objects));
            scene_of(&squares).unwrap_or_else(|error| panic!("{objects}: {error}"));
        }
        for kind in &KINDS {
            look(kind).unwrap_or_else(|error| panic!("{}: {error}", kind.name));
        }
    }

    #[test]
    fn counts_of_one_object_are_those_of_all_fragments() {
        let of = |kind: usize, objects: usize| counts(&KINDS[kind], &squares(objects))[0].1;
        assert_eq!(of(BKB, 1), of(BRUTE_FORCE, 1));
        assert!(of(BKB, 32) * 8.0 < of(BRUTE_FORCE, 32), "{}", of(BKB, 32));
        assert_eq!(counts(&KINDS[BKB], &squares(1))[2].1, 0.0, "one object is in order");
    }
}
