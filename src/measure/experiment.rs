//! What an experiment is: cases that are timed in turn, and pictures that are held against a truth.

use std::cell::OnceCell;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::sync::Arc;

use serde_json::{Map, Value as Json};

use super::run::Row;
use crate::engine::{Gpu, GpuError};
use crate::scene::Image;

/// What an experiment runs on, and how far it goes.
#[derive(Clone)]
pub struct Setup {
    /// The device; none for an experiment that needs none.
    pub gpu: Option<Arc<Gpu>>,
    /// Width and height of pictures in pixels, unless each experiment takes its own.
    pub size: Option<[u32; 2]>,
    /// As many cases, samples and rounds as are worth having, however long they take.
    pub thorough: bool,
}

/// Why an experiment came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A scene or a style of the experiment cannot be read.
    #[error("{0}")]
    Content(String),
    /// The user broke it off.
    #[error("interrupted")]
    Interrupted,
}

/// Asked again and again whether to go on.
pub type GoOn<'a> = &'a dyn Fn() -> ControlFlow<()>;

/// What is measured: it can be timed, and seen.
pub trait Subject {
    /// Draws one frame; returns its milliseconds by the wall clock.
    ///
    /// # Errors
    /// [`MeasureError`] where it cannot be drawn.
    fn frame_ms(&mut self) -> Result<f64, MeasureError>;

    /// Milliseconds of each pass of a frame, where the device has timestamps.
    ///
    /// # Errors
    /// As [`Subject::frame_ms`].
    fn pass_ms(&mut self) -> Result<Vec<(&'static str, f64)>, MeasureError> {
        Ok(Vec::new())
    }

    /// Bytes of objects and targets of the last frame.
    fn bytes(&self) -> u64 {
        0
    }

    /// The picture that is held against the truth.
    ///
    /// # Errors
    /// As [`Subject::frame_ms`].
    fn picture(&mut self) -> Result<Image, MeasureError>;
}

/// Makes the picture of a truth.
type Make = Box<dyn Fn(GoOn<'_>) -> Result<Image, MeasureError>>;

/// The right picture, made when the first case asks for it.
pub struct Truth {
    make: Make,
    image: OnceCell<Rc<Image>>,
}

impl Truth {
    /// A truth that `make` draws; it asks whether to go on.
    pub fn new(make: impl Fn(GoOn<'_>) -> Result<Image, MeasureError> + 'static) -> Rc<Truth> {
        Rc::new(Truth { make: Box::new(make), image: OnceCell::new() })
    }

    /// Its picture.
    ///
    /// # Errors
    /// [`MeasureError::Interrupted`], and whatever drawing says.
    pub fn image(&self, go_on: GoOn<'_>) -> Result<Rc<Image>, MeasureError> {
        if let Some(image) = self.image.get() {
            return Ok(Rc::clone(image));
        }
        let image = Rc::new((self.make)(go_on)?);
        Ok(Rc::clone(self.image.get_or_init(|| image)))
    }
}

/// A method with its settings on a scene: what a row of an experiment stands for.
#[derive(Debug, Clone)]
pub struct Entry {
    /// What is drawn.
    pub scene: String,
    /// What draws it.
    pub method: String,
    /// With which settings.
    pub settings: Map<String, Json>,
    /// The colour of its points: entries of one series share it and are joined by a line.
    pub series: String,
    /// Entries of one series and one point are averaged over scenes in the chart of cost and error.
    pub point: String,
    /// How large the scene is, for charts of time by size.
    pub extent: f64,
    /// Whether the method was published as it is here.
    pub is_published: bool,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

/// The settings of an entry, from a JSON object.
pub fn settings(of: Json) -> Map<String, Json> {
    match of {
        Json::Object(settings) => settings,
        _ => Map::new(),
    }
}

/// A figure of a picture beside its metrics: what it is called, and its value.
pub type Figure = (&'static str, f64);

/// Finds figures of a picture (second) that is held against its truth (first).
pub type Judge = Rc<dyn Fn(&Image, &Image) -> Vec<Figure>>;

/// What becomes a row of an experiment.
pub struct Case {
    /// What it stands for.
    pub entry: Entry,
    /// What is measured.
    pub subject: Box<dyn Subject>,
    /// What it should look like; none where only time counts.
    pub truth: Option<Rc<Truth>>,
    /// What is asked of the picture beside the metrics that all have.
    pub judge: Option<Judge>,
}

/// Which error a chart shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorKind {
    /// Mean FLIP.
    Flip,
    /// Root mean square of display values.
    Rmse,
    /// A [`Figure`] of 0 for none to 1, by its name.
    Figure {
        /// As the judge calls it.
        name: &'static str,
        /// What an axis says.
        title: &'static str,
    },
}

impl ErrorKind {
    /// Its value; none where the picture was not held against a truth.
    pub fn of(self, row: &Row) -> Option<f64> {
        match self {
            ErrorKind::Flip => row.error.as_ref().map(|metrics| metrics.flip),
            ErrorKind::Rmse => row.error.as_ref().map(|metrics| metrics.display.rmse.all),
            ErrorKind::Figure { name, .. } => row.figure(name),
        }
    }

    /// What an axis says.
    pub fn title(self) -> &'static str {
        match self {
            ErrorKind::Flip => "error: mean FLIP, 0 to 1",
            ErrorKind::Rmse => "error: RMSE of display values, 0 to 1",
            ErrorKind::Figure { title, .. } => title,
        }
    }

    /// What a figure is called.
    pub fn short_name(self) -> &'static str {
        match self {
            ErrorKind::Flip => "FLIP",
            ErrorKind::Rmse => "RMSE",
            ErrorKind::Figure { name, .. } => name,
        }
    }

    /// The smallest error that a chart tells from none: less than eight bits a channel show, or pixels can count.
    pub fn floor(self) -> f64 {
        match self {
            ErrorKind::Flip | ErrorKind::Rmse => 1e-4,
            ErrorKind::Figure { .. } => 1e-3,
        }
    }
}

/// What the chart of an experiment has on its axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChartKind {
    /// Cost against error.
    CostAgainstError {
        /// On the vertical axis.
        error: ErrorKind,
        /// Cost in ns a pixel instead of ms a frame.
        per_pixel: bool,
        /// A line through what nothing beats in both; not where series draw different things.
        has_front: bool,
    },
    /// Milliseconds by the extent of a scene.
    TimeByExtent {
        /// What the extent counts.
        extent: &'static str,
    },
}

/// One experiment: a file in `experiments/`, and a line in [`super::EXPERIMENTS`].
pub trait Experiment: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;
    /// What it finds out, in one sentence.
    fn doc(&self) -> &'static str;
    /// What its chart shows.
    fn chart(&self) -> ChartKind;
    /// Whether anything of it is drawn by the device.
    fn needs_gpu(&self) -> bool {
        true
    }
    /// Rounds that are due even where an ordinary run has spent its time.
    fn least_rounds(&self) -> usize {
        0
    }
    /// Whether every round times the passes, instead of the first alone.
    fn times_passes(&self) -> bool {
        false
    }
    /// How its numbers come about: truth, samples, what is left out. One paragraph each.
    fn conditions(&self, setup: &Setup) -> Vec<String>;
    /// What its chart says, in two sentences with the figures of these rows.
    fn says(&self, rows: &[Row]) -> String;
    /// What its rows come to, one sentence each, beyond what chart and table show.
    fn findings(&self, _rows: &[Row]) -> Vec<String> {
        Vec::new()
    }
    /// Its cases, scene by scene.
    ///
    /// # Errors
    /// [`MeasureError::Content`] where a scene or a style cannot be read.
    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError>;
}
