//! `restyle info SCENE...`: what scenes hold, to people and to tools, and as selectors for styles.

mod facts;
mod selectors;
mod text;

use super::{Failure, answer, inputs};
use crate::scene::LoadOptions;
use facts::Facts;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Files of molecules or meshes, or names of shipped ones; several are looked at as the one scene that they make
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// Print all of it as one JSON object
    #[arg(long)]
    json: bool,
    /// Print selectors that pick something in the scene, to paste into mapping
    #[arg(long, conflicts_with = "json")]
    selectors: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let scene = inputs::load_scenes(&args.scenes, &LoadOptions::default())?.scene;
    let facts = Facts::new(&scene);
    if args.json {
        answer(format_args!("{:#}", facts.json(&args.scenes)))
    } else if args.selectors {
        answer(selectors::lines(&facts).join("\n"))
    } else {
        answer(super::clean(text::lines(&facts).join("\n")))
    }
}
