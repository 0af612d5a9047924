//! `failures`: scenes that are hard for methods of transparency, and what each method makes of them.

use std::rc::Rc;

use serde_json::json;

use super::transparency::{LARGEST, WRONG, judge};
use crate::engine::{BkbForm, Request};
use crate::measure::experiment::{Case, ChartKind, Entry, ErrorKind, Experiment, MeasureError, Setup, settings};
use crate::measure::hard::SCENES;
use crate::measure::page::short;
use crate::measure::run::Row;
use crate::measure::stage::{GpuFrame, Look, Stage, device};

const SIZE: [u32; 2] = [120, 120];

/// A method by its name, and its form where it is the k-buffer.
const METHODS: [(&str, &str, BkbForm); 3] = [
    ("packed", "packed", BkbForm::Published),
    ("bkb", "bkb", BkbForm::Published),
    ("bkb, no reverse check", "bkb", BkbForm::OneWay),
];

/// The experiment.
pub struct Failures;

impl Experiment for Failures {
    fn name(&self) -> &'static str {
        "failures"
    }

    fn doc(&self) -> &'static str {
        "What each method of transparency makes of scenes that are hard for one of them."
    }

    fn chart(&self) -> ChartKind {
        let error = ErrorKind::Figure { name: LARGEST, title: "error: largest of any channel in linear light, 0 to 1" };
        ChartKind::CostAgainstError { error, per_pixel: false, has_front: false }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            "The truth is the reference renderer, which crosses every surface along the ray of each pixel's centre, in double precision; pictures \
             have one sample a pixel and 16 bits a channel. Objects are flat colours; in the last scene opacity is by curvature, and rims are lines."
                .to_owned(),
        ]
    }

    fn says(&self, rows: &[Row]) -> String {
        let of = |method: &'static str| {
            let flat =
                rows.iter().filter(move |row| row.entry.method == method && row.entry.settings["curved"] == false);
            flat.filter_map(|row| row.figure(WRONG))
        };
        let most = |method: &'static str| of(method).fold(0.0, f64::max);
        format!(
            "Where colours are flat, lists are off by more than a step of 8 bits in at most {} % of the pixels of any scene, which is where rounding \
             decides on a border; the k-buffer in up to {} %. It is right in all but so few on {} of {} such scenes.",
            short(most("packed")),
            short(most("bkb")),
            of("bkb").filter(|wrong| *wrong < 0.1).count(),
            of("bkb").count()
        )
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let size = setup.size.unwrap_or(SIZE);
        let request = Request { wide: true, ..Request::new(size, 1) };
        let mut cases = Vec::new();
        for (index, hard) in (1..).zip(&SCENES) {
            let scene = hard.scene()?;
            let stage = Stage::new(gpu, scene.clone());
            let look =
                |method: &str| Look::of_text(&format!("{} {method}", hard.name), &hard.style(method, hard.opacity));
            let truth = look("packed")?.exact(&scene, request);
            // Who a neighbour is counts where opacity is by curvature alone.
            for (name, method, bkb_form) in
                METHODS.into_iter().filter(|method| hard.is_curved || method.2 != BkbForm::OneWay)
            {
                cases.push(Case {
                    entry: Entry {
                        scene: hard.name.to_owned(),
                        method: name.to_owned(),
                        settings: settings(json!({ "k": hard.k, "opacity": hard.opacity, "curved": hard.is_curved })),
                        series: name.to_owned(),
                        point: hard.name.to_owned(),
                        extent: f64::from(index),
                        is_published: method == "bkb",
                        size,
                    },
                    subject: Box::new(GpuFrame { bkb_form, ..stage.frame(&look(method)?, request) }),
                    truth: Some(Rc::clone(&truth)),
                    judge: Some(judge()),
                });
            }
        }
        Ok(cases)
    }
}
