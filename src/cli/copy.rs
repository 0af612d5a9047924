//! `restyle copy LOOK FILE`: a shipped look as a file to start from, with the schema that editors check it by.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::{Failure, answer, inputs, schema, tell};
use crate::config::schema::{FILE, ID};
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
        return Err(inputs::unknown("look", &args.look, &[shipped::LOOKS]));
    };
    let file = args.file.display();
    if args.file.exists() {
        return Err(Failure::input(format!("{file}: is there already and is left as it is; choose another name")));
    }
    write_whole(&args.file, |writer| writer.write_all(look.bytes))
        .map_err(|error| Failure::input(super::render::cannot_write(&args.file, &error)))?;
    answer(file)?;
    // Without it the style is as good; only an editor knows less.
    if let Err(reason) = write_schema(&args.file.with_file_name(FILE)) {
        tell(format!("warning: {reason}; editors will not know what this style may hold"));
    }
    Ok(())
}

/// Writes the schema, over a former one of ours, never over anything else.
fn write_schema(path: &Path) -> Result<(), String> {
    let current = schema::text();
    match std::fs::read(path) {
        Ok(former) if former == current.as_bytes() => return Ok(()),
        Ok(former) => {
            let json: Option<serde_json::Value> = serde_json::from_slice(&former).ok();
            if json.is_none_or(|json| json["$id"] != ID) {
                let path = path.display();
                return Err(format!("{path}: is another file and is left as it is, so the schema is not written"));
            }
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
        Err(error) => return Err(super::render::cannot_write(path, &error)),
    }
    write_whole(path, |writer| writer.write_all(current.as_bytes()))
        .map_err(|error| super::render::cannot_write(path, &error))
}
