//! `restyle render --renderer reference`: stills by exact ray casts.

use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use indicatif::ProgressStyle;

use super::inputs::Loaded;
use super::render::{Args, cannot_write, files_read, progress_bar, rounded};
use super::{Failure, answer, inputs, tell};
use crate::config::Style;
use crate::engine::Request;
use crate::engine::exact::{Exact, ExactError};
use crate::scene::{LoadOptions, RowsHeader, write_png_rows};

/// Samples of a still.
const SAMPLES: u32 = 64;

/// Draws where there is no adapter, and says so.
pub(super) fn run_instead(args: &Args, style: Style, loaded: Loaded) -> Result<(), Failure> {
    check(args)?;
    tell(instead());
    draw(args, style, loaded)
}

/// The line that says what draws where there is no adapter.
pub(super) fn instead() -> &'static str {
    "no graphics adapter was found: the reference renderer draws, exactly and more slowly, on all cores"
}

/// Draws what the command line asks for.
pub(super) fn run(args: &Args, options: &LoadOptions) -> Result<(), Failure> {
    check(args)?;
    let style = inputs::load_style(args.style())?;
    let loaded = inputs::load_scenes(args.scenes(), options)?;
    inputs::check_outputs(args.outputs(), &files_read(&style, &loaded.scene))?;
    draw(args, style, loaded)
}

/// Refuses what only an adapter does.
fn check(args: &Args) -> Result<(), Failure> {
    if args.is_watched() || args.has_aovs() {
        return Err(Failure::usage("--watch and --aov are of the adapter: give them without --renderer reference"));
    }
    Ok(())
}

fn draw(args: &Args, style: Style, loaded: Loaded) -> Result<(), Failure> {
    let start = Instant::now();
    inputs::print_warnings(&style, &loaded.scene, args.scenes());
    let atoms = loaded.scene.molecule.atoms.len();
    let triangles = loaded.scene.assembly.num_triangles();
    let exact = Exact::new(loaded.scene, style, None);
    let stop = stopped_by_interrupt();
    let request = Request { samples: args.samples(SAMPLES), ..args.request() };
    let timed = |request: &Request, output: Option<&Path>| {
        let frame = Instant::now();
        draw_to(&exact, request, output, args.json(), &stop)?;
        Ok::<f64, Failure>(rounded(frame.elapsed().as_secs_f64() * 1e3))
    };
    let count = args.turntable().unwrap_or(1);
    let outputs: Vec<PathBuf> = args.outputs().collect();
    let mut first_frame_ms = None;
    for index in 0..count {
        let turn_deg = 360.0 * index as f32 / count as f32;
        let ms = timed(&Request { turn_deg, ..request }, outputs.get(index as usize).map(PathBuf::as_path))?;
        first_frame_ms.get_or_insert(ms);
    }
    let mut frame_ms = Vec::new();
    for _ in 0..args.frames() {
        frame_ms.push(timed(&request, None)?);
    }
    if args.json() {
        let line = serde_json::json!({
            "scene": args.scenes().join(", "),
            "scenes": args.scenes(),
            "style": args.style(),
            "size": request.size,
            "samples": request.samples,
            "adapter": null,
            "renderer": "reference",
            "threads": exact.threads(),
            "load_ms": rounded(loaded.ms),
            "first_frame_ms": first_frame_ms,
            "frame_ms": frame_ms,
            "atoms": atoms,
            "mesh_triangles": triangles,
            "total_ms": rounded(loaded.ms + start.elapsed().as_secs_f64() * 1e3),
        });
        answer(line)?;
    }
    Ok(())
}

/// Draws one picture, and writes it where an output is given.
fn draw_to(
    exact: &Exact,
    request: &Request,
    output: Option<&Path>,
    is_quiet: bool,
    stop: &AtomicBool,
) -> Result<(), Failure> {
    let bar = progress_bar(u64::from(request.size[1]), is_quiet);
    let look = ProgressStyle::with_template("{bar:40} {percent} % of the rows, {eta} left");
    bar.set_style(look.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let mut progress = |rows| {
        bar.set_position(u64::from(rows));
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let drawn = match output {
        None => exact.draw_rows(request, &mut progress, &mut |_| Ok(())).map_err(|_| Failure::interrupted()),
        Some(output) => {
            let header = RowsHeader { size: request.size, opaque: exact.is_opaque(request), wide: request.wide };
            let mut is_broken_off = false;
            let written = write_png_rows(output, &header, |sink| match exact.draw_rows(request, &mut progress, sink) {
                Ok(()) => Ok(()),
                Err(ExactError::Sink(error)) => Err(error),
                Err(ExactError::BrokenOff) => {
                    is_broken_off = true;
                    Err(io::ErrorKind::Interrupted.into())
                }
            });
            match written {
                Ok(()) => Ok(()),
                Err(_) if is_broken_off => Err(Failure::interrupted()),
                Err(error) => Err(Failure::input(cannot_write(output, &error))),
            }
        }
    };
    bar.finish_and_clear();
    drawn
}

/// A flag that an interrupt sets: a picture is then left out whole.
pub(super) fn stopped_by_interrupt() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&stop);
    // Without a handler an interrupt ends the process, which leaves no half picture either.
    let _ = ctrlc::set_handler(move || set.store(true, Ordering::Relaxed));
    stop
}
