//! `restyle copy LOOK FILE`: a shipped look as a file to start from.

use std::io::Write;
use std::path::PathBuf;

use super::{Failure, answer, inputs};
use crate::scene::write_whole;
use crate::shipped;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Name of a shipped look
    look: String,
    /// Where to write it
    file: PathBuf,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let Some(look) = shipped::find(shipped::LOOKS, &args.look) else {
        return Err(inputs::unknown("look", &args.look, shipped::LOOKS));
    };
    let file = args.file.display();
    if args.file.exists() {
        return Err(Failure::input(format!("{file}: is there already and is left as it is; choose another name")));
    }
    write_whole(&args.file, |writer| writer.write_all(look.bytes))
        .map_err(|error| Failure::input(super::render::cannot_write(&args.file, &error)))?;
    answer(file)
}
