//! `shadows`: sizes and filters of shadow maps, against ray-cast shadows.

use std::rc::Rc;

use serde_json::json;

use crate::engine::{Request, ShadowFilter, ShadowQuality};
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::{Row, geometric_mean};
use crate::measure::stage::{GpuFrame, Look, Stage, device, shipped_scene};

/// Two molecules, and two parts that shade themselves.
const SCENES: [&str; 4] = ["c60", "alpha_helix", "bracket", "gearbox"];

const SIZE: [u32; 2] = [200, 200];
/// Samples a pixel: with one, the pixels' own steps would hide those of the maps.
const SAMPLES: u32 = 16;
const TRUTH_SAMPLES: u32 = 64;

/// Texels along a side of a map; none is what frames take.
const MAP_SIZES: [Option<u32>; 4] = [Some(128), None, Some(512), Some(2048)];

/// What tells shadows: of hard or soft ones, by which filter, with how many taps in a sample.
struct Kind {
    name: &'static str,
    soft: bool,
    filter: ShadowFilter,
    taps: Option<u32>,
}

const KINDS: [Kind; 6] = [
    Kind { name: "hard, by objects", soft: false, filter: ShadowFilter::Objects, taps: None },
    Kind { name: "hard, 1 depth", soft: false, filter: ShadowFilter::Depth, taps: None },
    Kind { name: "hard, 3x3 depths", soft: false, filter: ShadowFilter::DepthShare, taps: None },
    Kind { name: "soft, by outlines", soft: true, filter: ShadowFilter::Objects, taps: None },
    Kind { name: "soft, 32 taps", soft: true, filter: ShadowFilter::Objects, taps: Some(32) },
    Kind { name: "soft, by fronts", soft: true, filter: ShadowFilter::Depth, taps: None },
];

/// How the point of the size that frames take is called.
const TAKEN: &str = "taken";

/// The experiment.
pub struct Shadows;

/// One light on matt white, so that errors are those of its shadow.
fn look(soft: bool) -> Result<Look, MeasureError> {
    let shadow = if soft { "soft" } else { "hard" };
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "#808080" }}, "mapping": {{ "*": "matt" }},
              "lights": [{{ "type": "directional", "position": [2, 2.4, 1.6], "shadow": "{shadow}", "softness": 8, "strength": 1 }}],
              "shaders": [{{ "name": "matt", "shader": "toon",
                "properties": {{ "base_color": "white", "steps": 256, "scale": 1, "bias": 0 }} }}] }}"##
    );
    Look::of_text(shadow, &text)
}

impl Experiment for Shadows {
    fn name(&self) -> &'static str {
        "shadows"
    }

    fn doc(&self) -> &'static str {
        "How far shadows from maps of several sizes and filters are from ray-cast ones, hard and soft, and what they cost."
    }

    fn chart(&self) -> ChartKind {
        ChartKind::CostAgainstError { error: ErrorKind::Rmse, per_pixel: false, has_front: false }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            format!(
                "One directional light on matt white, its shadow hard or of a disc of 8 degrees. The truth is the reference \
                 renderer with {TRUTH_SAMPLES} samples and at least 256 rays to the light a pixel; pictures have {SAMPLES} samples."
            ),
            "By objects is what styles draw: the map names what may block the light, and rays are cast at it; triangles are told by \
             four depths. By outlines is their soft form: depths of where things end, of the receiver's slope."
                .to_owned(),
            "1 depth, 3x3 depths and by fronts are the published forms with a bias of 1.5 texels: one texel, percentage-closer \
             filtering, and percentage-closer soft shadows."
                .to_owned(),
            "In the chart, points of a series are maps of 128, 320 (what styles take for pictures of this size), 512 and 2048 texels a \
             side; large points are geometric means over the scenes."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let rmse = |row: &Row| row.error.as_ref().map_or(f64::NAN, |error| error.display.rmse.all);
        let of = |kind: usize, side: &str| {
            let rows = rows.iter().filter(|row| row.entry.series == KINDS[kind].name && row.entry.point == side);
            [geometric_mean(rows.clone().map(rmse)), geometric_mean(rows.map(Row::median_ms))]
        };
        let [ours, depth, share] = [0, 1, 2].map(|kind| of(kind, TAKEN));
        let [ours_soft, published_soft, taps_soft] = [3, 5, 4].map(|kind| of(kind, TAKEN));
        format!(
            "At the size that styles take, hard shadows by objects have an RMSE of {}, one depth {} at {} times the time (its edges are \
             stairs with one sample a pixel), 3x3 depths {} at {} times. Soft ones by outlines have {}, by fronts {} at {} times the \
             time; four times the taps bring {} at {} times.",
            short(ours[0]),
            short(depth[0]),
            short(depth[1] / ours[1]),
            short(share[0]),
            short(share[1] / ours[1]),
            short(ours_soft[0]),
            short(published_soft[0]),
            short(published_soft[1] / ours_soft[1]),
            short(taps_soft[0]),
            short(taps_soft[1] / ours_soft[1]),
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let looks = [look(false)?, look(true)?];
        let mut cases = Vec::new();
        for name in SCENES {
            let scene = shipped_scene(name)?;
            let stage = Stage::new(gpu, scene.clone());
            let truths = looks.clone().map(|look| look.exact(&scene, Request::new(size, TRUTH_SAMPLES)));
            for kind in &KINDS {
                for map_size in MAP_SIZES {
                    let quality = ShadowQuality { map_size, soft_taps: kind.taps, filter: kind.filter };
                    let texels = quality.map_size(gpu, size[1]);
                    let settings = settings(json!({ "texels": texels }));
                    let frame = stage.frame(&looks[usize::from(kind.soft)], Request::new(size, SAMPLES));
                    cases.push(Case {
                        entry: Entry {
                            scene: name.to_owned(),
                            method: kind.name.to_owned(),
                            settings,
                            series: kind.name.to_owned(),
                            point: map_size.map_or(TAKEN.to_owned(), |side| side.to_string()),
                            extent: f64::from(texels),
                            is_published: kind.filter != ShadowFilter::Objects && map_size == Some(512),
                            size,
                        },
                        subject: Box::new(GpuFrame { shadows: quality, ..frame }),
                        truth: Some(Rc::clone(&truths[usize::from(kind.soft)])),
                        judge: None,
                    });
                }
            }
        }
        Ok(cases)
    }
}
