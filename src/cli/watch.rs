//! `restyle render --watch`: the picture again after each save, for any image viewer that follows a file.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::messages::{self, clean};
use super::render::{self, Args, rounded};
use super::{Failure, answer, inputs, inputs::Input, print_message, tell};
use crate::engine::{Engine, Gpu, Part, Refusal, Reload, Sources, source_tree_shaders};

/// How often an interrupt is looked for while nothing happens. Ours: a key press that takes longer feels lost.
const PATIENCE: Duration = Duration::from_millis(100);

/// What a shell calls the exit of a process that was interrupted.
const INTERRUPTED: i32 = 130;

/// Draws until the process is interrupted. A style or scene that does not load is told and waited for.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&interrupted);
    // A picture that is being drawn is broken off, one that is being written is finished. A second interrupt ends what
    // does not end by itself. Without a handler, one ends the process as ever.
    let _ = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
    });

    let style = inputs::find_style(args.style())?;
    let scenes: Vec<Input> = args.scenes().iter().map(|name| inputs::find_scene(name)).collect::<Result<_, _>>()?;
    let scene_files: Vec<PathBuf> = scenes.iter().filter_map(Input::file).map(Path::to_owned).collect();
    if style.file().is_none() && scene_files.is_empty() {
        return Err(Failure::usage(
            "--watch: what is shipped never changes; start from a copy: restyle copy education mine.json",
        ));
    }
    let options = args.load_options();
    let sources = Sources {
        style_file: style.file().map(Path::to_owned),
        style: Box::new(move || inputs::follow_style(&style)),
        scene_files,
        scene: Box::new(move || inputs::follow_scenes(&scenes, &options)),
        shader_folder: source_tree_shaders(),
    };
    let mut engine = Engine::live(Arc::new(Gpu::open()?), sources);
    let mut told = Vec::new();
    let is_interrupted = || interrupted.load(Ordering::Relaxed);
    while !is_interrupted() {
        let mut noticed: Option<Instant> = None;
        for reload in engine.wait(PATIENCE) {
            match reload {
                Reload::Taken(_, times) => {
                    noticed = Some(noticed.map_or(times.noticed, |earlier| earlier.min(times.noticed)));
                }
                Reload::Mended(part) => {
                    let kept = if engine.style().is_some() { "; the picture is as it was" } else { "" };
                    tell(format!("{}: fine again{kept}", part_name(part, args)));
                }
                Reload::Refused(part, refusal) => {
                    match &refusal {
                        Refusal::Style(mistakes) => print_message(&messages::of_mistakes(mistakes)),
                        other => tell(other),
                    }
                    let kept = if engine.style().is_some() { "; the picture stays as it is" } else { "" };
                    tell(format!("{}: waiting for it to be mended{kept}", part_name(part, args)));
                }
            }
        }
        if let Some(noticed) = noticed {
            tell_warnings(&engine, args, &mut told);
            match draw(&mut engine, args, noticed, &is_interrupted) {
                _ if is_interrupted() => {}
                Err(failure) if failure.code == 1 => print_message(&failure.message),
                other => other?,
            }
        }
    }
    Ok(())
}

fn part_name(part: Part, args: &Args) -> String {
    match part {
        Part::Style => args.style().to_owned(),
        Part::Scene => args.scenes().join(", "),
        Part::Shaders => "shaders".to_owned(),
    }
}

/// Tells warnings of what is drawn now that were not told before.
fn tell_warnings(engine: &Engine, args: &Args, told: &mut Vec<String>) {
    let (Some(style), Some(scene)) = (engine.style(), engine.scene()) else { return };
    let mut warnings = inputs::style_warnings(style);
    warnings.extend(inputs::scene_warnings(scene, args.scenes()).iter().map(clean));
    let limits = engine.limits_exceeded(args.size());
    warnings.extend(limits.iter().map(|limit| clean(format!("{}: warning: {limit}", args.style()))));
    warnings.iter().filter(|warning| !told.contains(warning)).for_each(|warning| print_message(warning));
    *told = warnings;
}

/// Draws and writes the picture and what else is asked for; the change was noticed at `noticed`.
fn draw(engine: &mut Engine, args: &Args, noticed: Instant, is_interrupted: &dyn Fn() -> bool) -> Result<(), Failure> {
    let read = engine.style().zip(engine.scene()).map(|(style, scene)| render::files_read(style, scene));
    inputs::check_outputs(args.outputs(), &read.unwrap_or_default())?;
    let picture = render::draw(engine, args, is_interrupted)?;
    render::write_aovs(engine, args)?;
    let total_ms = noticed.elapsed().as_secs_f64() * 1e3;
    if args.json() {
        let mut line = render::describe(engine, args, &picture)?;
        line.insert("total_ms".to_owned(), rounded(total_ms).into());
        return answer(serde_json::Value::Object(line));
    }
    let written: Vec<String> = args.outputs().map(|output| output.display().to_string()).collect();
    tell(format!("{}: drawn in {:.0} ms, the frame {:.0} ms", written.join(", "), total_ms, picture.frame_ms));
    Ok(())
}
