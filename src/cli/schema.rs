//! `restyle schema`: the JSON Schema of style files.

use super::{Failure, answer};
use crate::config::{self, Catalog};
use crate::engine;

#[derive(Debug, clap::Args)]
pub(super) struct Args {}

/// The schema as its file holds it.
pub(super) fn text() -> String {
    let entries = engine::catalog();
    let schema = config::schema(&Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS });
    format!("{schema:#}\n")
}

pub(super) fn run(_args: &Args) -> Result<(), Failure> {
    answer(text().trim_end())
}
