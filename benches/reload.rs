//! From a save to the frame that shows it: `cargo bench --bench reload`.
//!
//! 1,000 saves of a look, each with another value, in place, by rename and truncated first in turn; after each the bare
//! frame once more. Median and 95th percentile of the whole and of its parts. Writing the picture comes apart.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use restyle::config::{Catalog, load_file};
use restyle::engine::{self, Engine, Reload, Request, Sources};
use restyle::gpu::Gpu;
use restyle::scene::{LoadOptions, Scene};
use restyle::shipped::{LOOKS, MOLECULES, Shipped, find};

const SAVES: usize = 1000;
const REQUEST: Request = Request::new([1000, 1000], 1);

/// What one save took, in milliseconds.
#[derive(Default)]
struct Times {
    rows: Vec<(&'static str, Vec<f64>)>,
}

impl Times {
    fn add(&mut self, row: &'static str, time: Duration) {
        let ms = time.as_secs_f64() * 1e3;
        match self.rows.iter_mut().find(|(name, _)| *name == row) {
            Some((_, times)) => times.push(ms),
            None => self.rows.push((row, vec![ms])),
        }
    }

    fn quantile(&self, row: &str, share: f64) -> f64 {
        let Some((_, times)) = self.rows.iter().find(|(name, _)| *name == row) else { return f64::NAN };
        let mut times = times.clone();
        times.sort_by(f64::total_cmp);
        times[((times.len() - 1) as f64 * share).round() as usize]
    }
}

/// Saves a text as one of three kinds of editors does.
fn save(path: &Path, text: &str, number: usize) -> std::io::Result<()> {
    match number % 3 {
        0 => fs::write(path, text),
        1 => {
            let beside = path.with_extension("new");
            fs::write(&beside, text)?;
            fs::rename(&beside, path)
        }
        _ => {
            let mut file = File::options().write(true).open(path)?;
            file.set_len(0)?;
            file.write_all(text.as_bytes())
        }
    }
}

fn look(name: &str) -> String {
    find(LOOKS, name).map_or_else(String::new, |look| String::from_utf8_lossy(look.bytes).into_owned())
}

fn sources(style: &Path, scene: Option<PathBuf>) -> Sources {
    let (style, own) = (style.to_owned(), style.to_owned());
    let shipped: Option<&'static Shipped> = find(MOLECULES, "c60");
    let file = scene.clone();
    Sources {
        style: Box::new(move || {
            let entries = engine::catalog();
            load_file(&style, &Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS })
        }),
        style_file: Some(own),
        scene: Box::new(move || match (&scene, shipped) {
            (None, Some(molecule)) => Scene::from_bytes(molecule.file, molecule.bytes),
            (scene, _) => {
                let path = scene.clone().unwrap_or_default();
                Scene::load_with(&path, &LoadOptions::default())
            }
        }),
        scene_files: file.into_iter().collect(),
        shader_folder: None,
    }
}

/// Waits for the next change to be in force.
fn taken(engine: &mut Engine) -> Option<engine::ReloadTimes> {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(10) {
        for reload in engine.wait(Duration::from_secs(1)) {
            match reload {
                Reload::Taken(_, times) => return Some(times),
                other => println!("{other:?}"),
            }
        }
    }
    None
}

fn measure(
    gpu: &Arc<Gpu>,
    name: &str,
    scene: Option<PathBuf>,
    look_name: &str,
    from: &str,
    to: &dyn Fn(usize) -> String,
) {
    let folder = std::env::temp_dir().join(format!("restyle-reload-{}", std::process::id()));
    let style = folder.join("style.json");
    let text = look(look_name);
    assert!(text.contains(from), "{look_name} has no {from}");
    if fs::create_dir_all(&folder).and_then(|()| fs::write(&style, &text)).is_err() {
        return println!("{} cannot be written", folder.display());
    }
    let mut engine = Engine::live(Arc::clone(gpu), sources(&style, scene));
    let draw = |engine: &mut Engine| engine.draw(&REQUEST, false, &mut |_| std::ops::ControlFlow::Continue(()));
    if taken(&mut engine).is_none() || draw(&mut engine).and_then(|_| draw(&mut engine)).is_err() {
        return println!("{name}: nothing was drawn");
    }
    let mut times = Times::default();
    for number in 0..SAVES {
        let changed = text.replace(from, &to(number));
        std::thread::sleep(Duration::from_millis(5 + number as u64 % 17));
        let start = Instant::now();
        if save(&style, &changed, number).is_err() {
            return println!("{} cannot be written", style.display());
        }
        let saved = Instant::now();
        let Some(stages) = taken(&mut engine) else { return println!("{name}: a save was never taken") };
        let Ok(_) = draw(&mut engine) else { return println!("{name}: nothing was drawn") };
        let end = Instant::now();
        times.add("save to frame done", end - saved.min(stages.started));
        times.add("of it, all but the draw", stages.uploaded - saved.min(stages.started));
        times.add("the save itself", saved - start);
        times.add("event", stages.noticed.saturating_duration_since(start));
        times.add("debounce", stages.started - stages.noticed);
        times.add("read, parse, check", stages.loaded - stages.started);
        times.add("resolve", stages.resolved - stages.loaded);
        times.add("build and upload", stages.uploaded - stages.resolved);
        times.add("draw", end - stages.uploaded);
        let written = Instant::now();
        let image = engine.read(&REQUEST);
        if number.is_multiple_of(10)
            && let Ok(image) = image
            && image.write_png(&folder.join("out.png")).is_ok()
        {
            times.add("apart: read back, encode and write the PNG", written.elapsed());
        }
        if let Ok(ms) = draw(&mut engine) {
            times.add("beside it: the bare frame", Duration::from_secs_f64(ms * 1e-3));
        }
    }
    let _ = fs::remove_dir_all(&folder);
    println!("\n{name}, {SAVES} saves:\n\n| part | median ms | 95 % ms |\n|---|---:|---:|");
    for (row, _) in &times.rows {
        println!("| {row} | {:.2} | {:.2} |", times.quantile(row, 0.5), times.quantile(row, 0.95));
    }
    let over = times.quantile("save to frame done", 0.95) - times.quantile("beside it: the bare frame", 0.5);
    println!("\nThe 95th percentile lies {over:.1} ms above the median bare frame; the aim is 50 ms.");
}

fn main() {
    // `cargo test --benches` only asks whether it runs.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let gpu = match Gpu::open() {
        Ok(gpu) => Arc::new(gpu),
        Err(error) => return println!("{error}"),
    };
    println!("{} ({} {}), 1000x1000, one sample", gpu.info.name, gpu.info.driver, gpu.info.driver_info);
    let bias = |number: usize| format!("\"bias\": 0.{:03}", 400 + number % 500);
    measure(&gpu, "a property of C60 in education", None, "education", "\"bias\": 0.65", &bias);
    let haemoglobin = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/molecules/4hhb.pdb");
    if haemoglobin.exists() {
        measure(
            &gpu,
            "a property of 4HHB in education",
            Some(haemoglobin.clone()),
            "education",
            "\"bias\": 0.65",
            &bias,
        );
        let scale = |number: usize| format!("\"scale\": 0.{:03}", 200 + number % 200);
        let name = "the radii of all 4,779 atoms of 4HHB in scientific";
        measure(&gpu, name, Some(haemoglobin), "scientific", "\"scale\": 0.26", &scale);
    } else {
        println!("left out: {}", haemoglobin.display());
    }
}
