//! Measurements: how far pictures are from each other, and experiments that chart what methods cost against how wrong they
//! are.
//!
//! ```text
//! experiments/*  ->  cases  ->  run: rounds, truths, metrics  ->  report  ->  chart, page
//! ```

mod boxes;
pub mod chart;
mod date;
pub mod experiment;
pub mod experiments;
mod forms;
mod front;
pub mod hard;
pub mod metrics;
mod overview;
pub mod page;
pub mod run;
pub mod sheet;
mod stage;

pub use experiment::{Case, ChartKind, Entry, Experiment, MeasureError, Setup};
pub use experiments::{EXPERIMENTS, find};
pub use run::{Report, Row, run};
