//! `restyle explain SCENE... -s STYLE`: the passes of a frame and why, and those that are left out and why.

use std::sync::Arc;

use serde_json::{Value as Json, json};

use super::inputs::{self, Size};
use super::{Failure, answer, clean};
use crate::engine::{Engine, Gpu, MAX_SAMPLES, Request, Step};
use crate::scene::LoadOptions;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Files of molecules or meshes, or names of shipped ones; several are drawn as one scene
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// A style file or the name of a shipped look
    #[arg(short, long, default_value = "education")]
    style: String,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1000x1000")]
    size: Size,
    /// Samples a pixel
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    samples: u32,
    /// Print all of it as one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    fn request(&self) -> Request {
        Request::new(self.size.0, self.samples)
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let (style, loaded) = (inputs::load_style(&args.style), inputs::load_scenes(&args.scenes, &LoadOptions::default()));
    let (style, scene) = (style?, loaded?.scene);
    let gpu = Arc::new(Gpu::open()?);
    inputs::print_warnings(&style, &scene, &args.scenes);
    let mut engine = Engine::new(gpu, scene, style);
    let steps = engine.explain(&args.request())?;
    if args.json {
        return answer(format_args!("{:#}", document(args, &steps)));
    }
    answer(clean(text(args, &engine.gpu().info.name, &steps)))
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.1}", bytes as f64 / f64::from(1 << 20))
}

/// A table for people.
fn text(args: &Args, adapter: &str, steps: &[Step]) -> String {
    let [width, height] = args.size.0;
    let scenes = args.scenes.join(" ");
    let request = args.request();
    let tiles = match Engine::is_tiled(&request) {
        true => format!(", in {} tiles, of which this is the first", Engine::num_tiles(&request)),
        false => String::new(),
    };
    let mut lines = vec![format!(
        "{scenes} in {}: a frame of {width}x{height}{tiles}, with {} sample{} on {adapter}",
        args.style,
        args.samples,
        if args.samples == 1 { "" } else { "s" }
    )];
    lines.push(format!("\n{:<20} {:<11} {:>7}  why", "pass", "size", "MiB"));
    for step in steps.iter().filter(|step| step.is_drawn) {
        let size = step.size.map_or(String::new(), |[width, height]| format!("{width}x{height}"));
        let bytes = if step.bytes > 0 { mebibytes(step.bytes) } else { String::new() };
        lines.push(format!("{:<20} {size:<11} {bytes:>7}  {}", step.name, step.reason));
    }
    let total = steps.iter().map(|step| step.bytes).sum();
    lines.push(format!("{:<20} {:<11} {:>7}", "all targets", "", mebibytes(total)));
    lines.push(format!("\n{:<20} why", "left out"));
    lines.extend(steps.iter().filter(|step| !step.is_drawn).map(|step| format!("{:<20} {}", step.name, step.reason)));
    lines.join("\n")
}

fn document(args: &Args, steps: &[Step]) -> Json {
    let steps = steps.iter().map(|step| {
        json!({ "name": step.name, "drawn": step.is_drawn, "size": step.size, "bytes": step.bytes, "reason": step.reason })
    });
    json!({
        "scenes": args.scenes,
        "style": args.style,
        "size": args.size.0,
        "samples": args.samples,
        "passes": steps.collect::<Vec<_>>(),
    })
}
