//! Load, first frame and warm frame by the size of a scene: `cargo bench --bench scale`.
//!
//! Atoms as an mmCIF file of a protein-like lattice, triangles as a binary PLY of hills; 1000x1000, one sample a pixel. All sizes are
//! measured in turn, round after round, so that a machine's drift falls on all alike. A line through the medians gives
//! fixed cost and slope. Real files come from `../shared/data` where that folder is.

use std::fmt::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use restyle::config::{Catalog, Source, Style, load};
use restyle::engine::{self, Engine, Request};
use restyle::gpu::Gpu;
use restyle::scene::Scene;
use restyle::shipped::{LOOKS, find};

const ROUNDS: usize = 15;
const REQUEST: Request = Request::new([1000, 1000], 1);
const ATOMS: [usize; 6] = [1_000, 3_000, 10_000, 30_000, 100_000, 300_000];
const TRIANGLES: [usize; 6] = [10_000, 30_000, 100_000, 300_000, 1_000_000, 2_900_000];

/// Alanines on a lattice, of five atoms each, four angstrom apart.
fn molecule(num_atoms: usize) -> (String, Vec<u8>) {
    let mut text =
        "data_BENCH\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n\
                    _atom_site.label_comp_id\n_atom_site.auth_asym_id\n_atom_site.auth_seq_id\n_atom_site.Cartn_x\n\
                    _atom_site.Cartn_y\n_atom_site.Cartn_z\n"
            .to_owned();
    let shape = [
        ("N", 0.0, 0.0, 0.0),
        ("C", 1.46, 0.0, 0.0),
        ("C", 2.0, 1.42, 0.0),
        ("O", 1.3, 2.4, 0.0),
        ("C", 1.99, -0.7, 1.2),
    ];
    let names = ["N", "CA", "C", "O", "CB"];
    let side = ((num_atoms / 5) as f64).cbrt().ceil() as usize;
    for index in 0..num_atoms {
        let (residue, atom) = (index / 5, index % 5);
        let (element, x, y, z) = shape[atom];
        let place = [residue % side, residue / side % side, residue / side / side].map(|i| i as f64 * 4.6);
        let _ = writeln!(
            text,
            "ATOM {} {element} {} ALA {} {} {:.3} {:.3} {:.3}",
            index + 1,
            names[atom],
            (b'A' + (residue / 500 % 26) as u8) as char,
            residue % 500 + 1,
            x + place[0],
            y + place[1],
            z + place[2]
        );
    }
    ("bench.cif".to_owned(), text.into_bytes())
}

/// Hills over a square grid.
fn mesh(num_triangles: usize) -> (String, Vec<u8>) {
    let side = ((num_triangles / 2) as f64).sqrt().ceil() as u32;
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        (side + 1) * (side + 1),
        2 * side * side
    )
    .into_bytes();
    for (x, y) in (0..=side).flat_map(|y| (0..=side).map(move |x| (x, y))) {
        let [u, v] = [x, y].map(|at| at as f32 / side as f32 * 40.0);
        for value in [u, v, 1.5 * (u * 0.5).sin() * (v * 0.4).cos()] {
            bytes.extend(value.to_le_bytes());
        }
    }
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let at = |dx: u32, dy: u32| ((y + dy) * (side + 1) + x + dx) as i32;
        for corners in [[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]] {
            bytes.push(3);
            corners.iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
        }
    }
    ("bench.ply".to_owned(), bytes)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Offset and slope of the line through two points.
fn line((x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> (f64, f64) {
    let slope = (y1 - y0) / (x1 - x0);
    (y0 - slope * x0, slope)
}

fn measure(gpu: &Arc<Gpu>, style: &Style, what: &str, files: &[(usize, String, Vec<u8>)]) {
    let small = || Scene::from_bytes("a.xyz", b"1\n\nC 0 0 0\n").ok();
    let mut times = vec![[Vec::new(), Vec::new(), Vec::new()]; files.len()];
    for round in 0..=ROUNDS {
        for ((_, name, bytes), times) in files.iter().zip(&mut times) {
            let Some(first) = small() else { return };
            let mut engine = Engine::new(Arc::clone(gpu), first, style.clone());
            let draw = |engine: &mut Engine| engine.draw(&REQUEST, false, &mut |_| ControlFlow::Continue(()));
            if draw(&mut engine).is_err() {
                return;
            }
            let start = Instant::now();
            let scene = match Scene::from_bytes(name, bytes) {
                Ok(scene) => scene,
                Err(error) => return println!("{error}"),
            };
            let load_ms = start.elapsed().as_secs_f64() * 1e3;
            let start = Instant::now();
            engine.set_scene(scene);
            let first = draw(&mut engine);
            let first_ms = start.elapsed().as_secs_f64() * 1e3;
            // The first round builds pipelines.
            if let (Ok(_), Ok(frame_ms), true) = (first, draw(&mut engine), round > 0) {
                [load_ms, first_ms, frame_ms].into_iter().zip(times.iter_mut()).for_each(|(ms, of)| of.push(ms));
            }
        }
    }
    println!("| {what} | load | resolve, upload, first frame | warm frame |\n|---:|---:|---:|---:|");
    let medians: Vec<(f64, [f64; 3])> =
        files.iter().zip(times).map(|((count, ..), times)| (*count as f64, times.map(median))).collect();
    for (count, [load, first, frame]) in &medians {
        println!("| {count} | {load:.1} | {first:.1} | {frame:.1} |");
    }
    let [low, .., high] = &medians[..] else { return };
    for (index, part) in ["load", "first frame", "warm frame"].into_iter().enumerate() {
        let (fixed, slope) = line((low.0, low.1[index]), (high.0, high.1[index]));
        println!("{part}: {fixed:.2} ms and {:.3} ms for each thousand", slope * 1e3);
    }
}

fn main() {
    let gpu = match Gpu::open() {
        Ok(gpu) => Arc::new(gpu),
        Err(error) => return println!("{error}"),
    };
    println!("{} ({} {}), medians of {ROUNDS} rounds in ms", gpu.info.name, gpu.info.driver, gpu.info.driver_info);
    let entries = engine::catalog();
    let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
    let Some(look) = find(LOOKS, "scientific") else { return };
    let Ok(style) = load(&Source::new(look.file, look.bytes), &catalog) else { return };
    let files = |sizes: &[usize], make: fn(usize) -> (String, Vec<u8>)| -> Vec<(usize, String, Vec<u8>)> {
        sizes.iter().map(|&size| (size, make(size))).map(|(size, (name, bytes))| (size, name, bytes)).collect()
    };
    measure(&gpu, &style, "atoms", &files(&ATOMS, molecule));
    measure(&gpu, &style, "triangles", &files(&TRIANGLES, mesh));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    for (file, count) in [("molecules/4v5a.cif", 290_487), ("meshes/terrain_n53e027.ply", 2_880_000)] {
        match std::fs::read(folder.join(file)) {
            Ok(bytes) => measure(&gpu, &style, file, &[(count, file.to_owned(), bytes)]),
            Err(_) => println!("left out: {file}"),
        }
    }
}
