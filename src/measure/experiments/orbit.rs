//! `orbit`: how much pictures change from frame to frame while the scene turns, beside the truth on the same path.

use std::rc::Rc;

use serde_json::json;

use crate::engine::exact::Exact;
use crate::engine::{EffectForm, Request};
use crate::measure::experiment::{
    Case, ChartKind, Entry, ErrorKind, Experiment, Judge, MeasureError, Setup, Subject, Truth, settings,
};
use crate::measure::metrics::Sequence;
use crate::measure::page::short;
use crate::measure::run::Row;
use crate::measure::stage::{GpuFrame, Look, Stage, device, shipped_scene};
use crate::scene::{Image, Pixels};

/// Frames of a whole turn, and how many of them are drawn.
const TURN: u32 = 48;
const FRAMES: u32 = 6;

const SIZE: [u32; 2] = [320, 180];

/// Figures: change from frame to frame over that of the truth, and change that the truth does not have.
const CHANGE: &str = "change over the truth's";
const FLICKER: &str = "flicker";

const SCENES: [&str; 2] = ["alpha_helix", "gearbox"];

/// An effect with a method; lines of sight a pixel of its truth.
struct Kind {
    name: &'static str,
    effect: &'static str,
    properties: &'static str,
    form: Option<EffectForm>,
    /// Which of [`TRUTHS`] it is held against.
    truth: usize,
}

/// Samples of a truth: occlusion is cast by 512 rays from each, a lens needs many.
const TRUTHS: [u32; 2] = [1, 64];

const KINDS: [Kind; 7] = [
    Kind {
        name: "hemisphere, published",
        effect: "ssaoPost",
        properties: r#""method": "hemisphere""#,
        form: Some(EffectForm::OCCLUSION_PUBLISHED),
        truth: 0,
    },
    Kind { name: "hemisphere", effect: "ssaoPost", properties: r#""method": "hemisphere""#, form: None, truth: 0 },
    Kind { name: "bitmask", effect: "ssaoPost", properties: "", form: None, truth: 0 },
    Kind {
        name: "bitmask, every pixel",
        effect: "ssaoPost",
        properties: "",
        form: Some(EffectForm::OCCLUSION_FINE),
        truth: 0,
    },
    Kind {
        name: "five layers, published",
        effect: "dofPost",
        properties: r#""layers": [0, 0.2, 0.4, 0.8], "blur": "48pt", "method": "five_layer""#,
        form: Some(EffectForm::FOCUS_PUBLISHED),
        truth: 1,
    },
    Kind {
        name: "five layers",
        effect: "dofPost",
        properties: r#""layers": [0, 0.2, 0.4, 0.8], "blur": "48pt", "method": "five_layer""#,
        form: None,
        truth: 1,
    },
    Kind {
        name: "gather",
        effect: "dofPost",
        properties: r#""layers": [0, 0.2, 0.4, 0.8], "blur": "48pt""#,
        form: None,
        truth: 1,
    },
];

/// The experiment.
pub struct Orbit;

fn look(scene: &str, kind: &Kind) -> Result<Look, MeasureError> {
    // Occlusion is seen alone on what is white and unlit; what is blurred needs something on it.
    let (shader, background) = match kind.effect {
        "ssaoPost" => (r#"{ "name": "plain", "shader": "unlit", "properties": { "base_color": "white" } }"#, "#00ff00"),
        _ => (r#"{ "name": "plain", "shader": "basic" }"#, "#e8e8f0"),
    };
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "{background}", "position": [0.3, 0.4, 1] }}, "mapping": {{ "*": "plain", "post_effects": ["effect"] }},
              "shaders": [{shader},
                {{ "name": "effect", "shader": "{}", "properties": {{ {} }} }}] }}"##,
        kind.effect, kind.properties
    );
    Look::of_text(&format!("{scene} {}", kind.name), &text)
}

/// The requests of a path.
fn path(request: Request, frames: u32) -> impl Iterator<Item = Request> {
    (0..frames).map(move |frame| Request { turn_deg: 360.0 * frame as f32 / TURN as f32, ..request })
}

/// Pictures one below the other.
fn strip(images: &[Image]) -> Image {
    let size = images.first().map_or([0, 0], |image| [image.size[0], image.size[1] * images.len() as u32]);
    let values = |image: &Image| match &image.pixels {
        Pixels::U16(values) => values.clone(),
        Pixels::U8(values) => values.iter().map(|value| u16::from(*value) * 257).collect(),
    };
    Image { size, pixels: Pixels::U16(images.iter().flat_map(values).collect()), opaque: true }
}

/// The pictures of a strip.
fn frames(strip: &Image, num_frames: u32) -> Vec<Image> {
    let size = [strip.size[0], strip.size[1] / num_frames];
    let length = 4 * size[0] as usize * size[1] as usize;
    let Pixels::U16(values) = &strip.pixels else { return Vec::new() };
    values
        .chunks_exact(length)
        .map(|values| Image { size, pixels: Pixels::U16(values.to_vec()), opaque: true })
        .collect()
}

/// Mean change of display values from one picture to the next, over what neither shows as background where that is green.
fn change(images: &[Image]) -> f64 {
    let is_seen = |pixel: [f32; 4]| pixel[1] - pixel[0] < 0.02;
    let (mut sum, mut count) = (0.0, 0usize);
    for pair in images.windows(2) {
        for (x, y) in (0..pair[0].size[1]).flat_map(|y| (0..pair[0].size[0]).map(move |x| (x, y))) {
            let [before, now] = [&pair[0], &pair[1]].map(|image| image.pixel(x, y));
            if is_seen(before) && is_seen(now) {
                sum += (0..3).map(|channel| f64::from((now[channel] - before[channel]).abs())).sum::<f64>() / 3.0;
                count += 1;
            }
        }
    }
    sum / count.max(1) as f64
}

fn judge(num_frames: u32) -> Judge {
    Rc::new(move |truth, picture| {
        let [truth, drawn] = [truth, picture].map(|strip| frames(strip, num_frames));
        let mut sequence = Sequence::new();
        for (drawn, truth) in drawn.iter().zip(&truth) {
            if sequence.push(drawn, truth).is_err() {
                return Vec::new();
            }
        }
        let flicker = sequence.stability().map_or(f64::NAN, |stability| stability.flicker);
        vec![(CHANGE, change(&drawn) / change(&truth).max(1e-9)), (FLICKER, flicker)]
    })
}

/// A path on the device, as one picture.
struct Film {
    first: GpuFrame,
    frames: u32,
}

impl Subject for Film {
    fn frame_ms(&mut self) -> Result<f64, MeasureError> {
        self.first.frame_ms()
    }

    fn pass_ms(&mut self) -> Result<Vec<(&'static str, f64)>, MeasureError> {
        self.first.pass_ms()
    }

    fn bytes(&self) -> u64 {
        self.first.bytes()
    }

    fn picture(&mut self) -> Result<Image, MeasureError> {
        let still = self.first.request;
        let images: Result<Vec<Image>, MeasureError> = path(still, self.frames)
            .map(|request| {
                self.first.request = request;
                self.first.picture()
            })
            .collect();
        self.first.request = still;
        Ok(strip(&images?))
    }
}

impl Experiment for Orbit {
    fn name(&self) -> &'static str {
        "orbit"
    }

    fn doc(&self) -> &'static str {
        "How much occlusion and depth of field change from frame to frame of an orbit, beside the truth on the same path."
    }

    fn chart(&self) -> ChartKind {
        let error = ErrorKind::Figure { name: FLICKER, title: "flicker: change that the truth does not have, 0 to 1" };
        ChartKind::CostAgainstError { error, per_pixel: false, has_front: false }
    }

    fn conditions(&self, setup: &Setup) -> Vec<String> {
        let num_frames = if setup.thorough { TURN } else { FRAMES };
        vec![
            format!(
                "{num_frames} frames of an orbit, {} degrees from one to the next, one sample a pixel, nothing kept from frame to frame. The \
                 truth of occlusion has 512 rays from each pixel's centre, that of depth of field {} lines of sight through the lens.",
                360.0 / f64::from(TURN),
                TRUTHS[1]
            ),
            "Change is the mean difference of display values from a frame to the next, over pixels that show a surface in both where it is \
             occlusion that is measured; it is given as a multiple of the truth's. Flicker is the mean difference between a change and \
             the truth's."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let of = |name: &str| {
            let changes = rows.iter().filter(|row| row.entry.series == name).filter_map(|row| row.figure(CHANGE));
            short(changes.fold(0.0, f64::max))
        };
        format!(
            "From frame to frame bitmask changes at most {} times as much as the truth, found at every pixel {} times, hemisphere {} times and as \
             published {} times. Depth of field changes at most {} times as much by circles, {} times in five layers and {} times as \
             published.",
            of(KINDS[2].name),
            of(KINDS[3].name),
            of(KINDS[1].name),
            of(KINDS[0].name),
            of(KINDS[6].name),
            of(KINDS[5].name),
            of(KINDS[4].name),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let num_frames = if setup.thorough { TURN } else { FRAMES };
        let mut cases = Vec::new();
        for name in SCENES {
            let scene = shipped_scene(name)?;
            let stage = Stage::new(gpu, scene.clone());
            let request = move |samples| Request { wide: true, ..Request::new(size, samples) };
            let mut truths: Vec<Rc<Truth>> = Vec::new();
            for kind in &KINDS {
                let look = look(name, kind)?;
                if kind.truth == truths.len() {
                    let exact: Exact = look.reference(&scene);
                    truths.push(Truth::new(move |go_on| {
                        let still =
                            |request| exact.still(&request, &mut |_| go_on()).map_err(|_| MeasureError::Interrupted);
                        let images: Result<Vec<Image>, MeasureError> =
                            path(request(TRUTHS[kind.truth]), num_frames).map(still).collect();
                        Ok(strip(&images?))
                    }));
                }
                let first = stage.frame(&look, request(1));
                let first = GpuFrame { forms: kind.form.into_iter().collect(), ..first };
                cases.push(Case {
                    entry: Entry {
                        scene: name.to_owned(),
                        method: kind.name.to_owned(),
                        settings: settings(json!({ "frames": num_frames })),
                        series: kind.name.to_owned(),
                        point: name.to_owned(),
                        extent: f64::from(num_frames),
                        is_published: kind.name.ends_with("published"),
                        size,
                    },
                    subject: Box::new(Film { first, frames: num_frames }),
                    truth: truths.get(kind.truth).map(Rc::clone),
                    judge: Some(judge(num_frames)),
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
    fn styles_load() {
        for kind in &KINDS {
            look("test", kind).unwrap_or_else(|error| panic!("{}: {error}", kind.name));
        }
    }

    #[test]
    fn a_strip_holds_its_pictures() {
        let image = |value: u16| Image { size: [2, 1], pixels: Pixels::U16(vec![value; 8]), opaque: true };
        let images = [image(1), image(2), image(3)];
        let found = frames(&strip(&images), 3);
        assert_eq!(found.len(), 3);
        assert!(found.iter().zip(&images).all(|(a, b)| a.pixels == b.pixels && a.size == b.size));
        assert!((change(&images) * 65535.0 - 1.0).abs() < 1e-3);
    }
}
