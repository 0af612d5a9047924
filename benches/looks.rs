//! Frame time of every look by number of atoms, and the cold start: `cargo bench --bench looks`.
//!
//! After [Prost2016 §5.2, Fig. 7], which counts polygons: 1920x1080, one sample a pixel, a frame being encode, submit and
//! idle. All cells of the table are measured in turn, round after round, so that a machine's drift falls on all alike.
//! Larger molecules come from `../shared/data/molecules` where that folder is.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

use restyle::config::{Catalog, Source, load};
use restyle::engine::{self, Engine, Request};
use restyle::gpu::Gpu;
use restyle::scene::Scene;
use restyle::shipped::{LOOKS, MOLECULES, find};

const ROUNDS: usize = 15;
const REQUEST: Request = Request::new([1920, 1080], 1);

fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| values[(values.len() - 1) * quarter / 4])
}

fn scenes() -> Vec<Scene> {
    let mut scenes = Vec::new();
    for name in ["c60", "nanotube"] {
        if let Some(molecule) = find(MOLECULES, name) {
            scenes.extend(Scene::from_bytes(molecule.file, molecule.bytes));
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/molecules");
    for file in ["1crn.pdb", "dna.xyz", "4hhb.pdb", "2btv.pdb"] {
        match Scene::load(&folder.join(file)) {
            Ok(scene) => scenes.push(scene),
            Err(error) => println!("left out: {error}"),
        }
    }
    scenes.sort_by_key(|scene| scene.molecule.atoms.len());
    scenes
}

fn frames(gpu: &Arc<Gpu>) {
    let entries = engine::catalog();
    let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
    let mut cells: Vec<(String, usize, Engine, Vec<f64>)> = Vec::new();
    for scene in scenes() {
        for look in LOOKS {
            let Ok(style) = load(&Source::new(look.file, look.bytes), &catalog) else { continue };
            let atoms = scene.molecule.atoms.len();
            let label = format!("{} | {}", scene.name, look.name);
            cells.push((label, atoms, Engine::new(Arc::clone(gpu), scene.clone(), style), Vec::new()));
        }
    }
    for round in 0..=ROUNDS {
        for (label, _, engine, times) in &mut cells {
            match engine.draw(&REQUEST, false, &mut |_| std::ops::ControlFlow::Continue(())) {
                // The first round builds pipelines.
                Ok(ms) if round > 0 => times.push(ms),
                Ok(_) => (),
                Err(error) => println!("{label}: {error}"),
            }
        }
    }
    println!("| scene | look | atoms | spheres and cylinders | frame ms, quartiles |\n|---|---|---:|---:|---:|");
    for (label, atoms, engine, times) in cells {
        let [low, middle, high] = quartiles(times);
        let counts = engine.counts();
        println!("| {label} | {atoms} | {} | {low:.1}, {middle:.1}, {high:.1} |", counts.spheres + counts.cylinders);
    }
}

/// Process start to a 1000x1000 PNG of C60 in `education`, one sample, with its parts.
fn cold_start() {
    let output = std::env::temp_dir().join(format!("restyle-bench-{}.png", std::process::id()));
    let parts = ["device_ms", "load_ms", "first_frame_ms", "readback_ms", "encode_ms"];
    let mut whole = Vec::new();
    let mut times = vec![Vec::new(); parts.len()];
    for _ in 0..=ROUNDS {
        let start = Instant::now();
        let run = Command::new(env!("CARGO_BIN_EXE_restyle"))
            .args(["render", "c60", "-s", "education", "--size", "1000x1000", "--samples", "1", "--json", "-o"])
            .arg(&output)
            .output();
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let Some(json) = run.ok().and_then(|run| serde_json::from_slice::<serde_json::Value>(&run.stdout).ok()) else {
            continue;
        };
        // --json draws one frame more, to time its passes; the whole is what the program says up to the PNG, plus what
        // it takes the system to start and end it.
        whole.push((ms, json["total_ms"].as_f64().unwrap_or(0.0)));
        for (part, times) in parts.iter().zip(&mut times) {
            times.push(json[part].as_f64().unwrap_or(0.0));
        }
    }
    let _ = std::fs::remove_file(&output);
    println!("\n| cold start of c60 in education | ms, quartiles |\n|---|---:|");
    let row = |name: &str, values: Vec<f64>| {
        let [low, middle, high] = quartiles(values[1..].to_vec());
        println!("| {name} | {low:.1}, {middle:.1}, {high:.1} |");
    };
    row("process start to PNG, by the program's own clock", whole.iter().map(|(_, inner)| *inner).collect());
    row("process start to exit, one timed frame more included", whole.iter().map(|(outer, _)| *outer).collect());
    for (part, times) in parts.iter().zip(times) {
        row(part, times);
    }
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
    println!("{} ({} {})\n", gpu.info.name, gpu.info.driver, gpu.info.driver_info);
    frames(&gpu);
    cold_start();
}
