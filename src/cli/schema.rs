//! `restyle schema`: the JSON Schema of style files, and the manual that is made from the same tables.

use std::path::PathBuf;

use super::{Failure, answer, manual};
use crate::config::{self, Catalog};
use crate::engine;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Write the manual of style files with its pictures into this folder instead
    #[arg(long, value_name = "DIR")]
    manual: Option<PathBuf>,
}

/// The schema as its file holds it.
pub(super) fn text() -> String {
    let entries = engine::catalog();
    let schema = config::schema(&Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS });
    format!("{schema:#}\n")
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    match &args.manual {
        Some(folder) => {
            let entries = engine::catalog();
            manual::write(folder, &Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS })
        }
        None => answer(text().trim_end()),
    }
}
