//! `restyle copy LOOK FILE`: a shipped look as a file to start from.

use std::io::Write;
use std::path::PathBuf;

use super::Failure;
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
        let names: Vec<&str> = shipped::LOOKS.iter().map(|look| look.name).collect();
        return Err(Failure::input(format!("there is no look {:?}; shipped: {}", args.look, names.join(", "))));
    };
    let file = args.file.display();
    if args.file.exists() {
        return Err(Failure::input(format!("{file}: is there already and is left as it is; choose another name")));
    }
    write_whole(&args.file, |writer| writer.write_all(look.bytes))
        .map_err(|error| Failure::input(super::render::cannot_write(&args.file, &error)))?;
    println!("{file}");
    Ok(())
}
