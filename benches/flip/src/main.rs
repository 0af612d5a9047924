//! FLIP of `restyle::measure::metrics` against its authors' C++ code, pixel by pixel.
//!
//! `cargo run --release` in `benches/flip` prints, for each pair of generated pictures, both means and the largest
//! difference of any pixel, and fails if that is above 1e-4. It also prints the numbers that the library's tests hold.

use std::process::ExitCode;
use std::time::Instant;

use restyle::measure::metrics::{Mask, Metrics, Picture};

/// What two correct implementations may differ by: rounding near zero, seen through a square root.
const TOLERANCE: f32 = 1e-4;

/// Width and height of all pairs, in pixels; more than one band of rows, and no multiple of one.
const SIZE: [usize; 2] = [96, 80];

/// Places whose errors the library's tests hold.
const PLACES: [[usize; 2]; 4] = [[0, 0], [48, 40], [49, 63], [77, 41]];

/// Bytes of a colour by place.
type Color = fn(usize, usize) -> [u8; 3];

/// Pairs by name. The first ones are those of the library's tests.
const PAIRS: &[(&str, Color, Color)] = &[
    ("noise", |x, y| noise(x, y, 0), |x, y| noise(x, y, 3)),
    ("shift", disc, |x, y| disc(x + 1, y)),
    ("level", disc, |x, y| disc(x, y).map(|value| value + 1)),
    ("gradient", gradient, |x, y| gradient(SIZE[0] - 1 - x, y)),
    ("edge", |x, _| [if x < 48 { 40 } else { 200 }; 3], |x, _| [if x < 50 { 40 } else { 200 }; 3]),
    ("color", |_, _| [0, 255, 0], |_, _| [0, 0, 255]),
    ("identical", disc, disc),
    ("points", |_, _| [128; 3], |x, y| if x % 16 == 5 && y % 16 == 9 { [255, 90, 10] } else { [128; 3] }),
    ("grain", disc, |x, y| {
        let n = noise(x, y, 6);
        let d = disc(x, y);
        std::array::from_fn(|c| d[c] + n[c] / 64)
    }),
    ("black-white", |_, _| [0; 3], |_, _| [255; 3]),
    ("lines", |x, _| [if x % 7 == 0 { 0 } else { 255 }; 3], |x, y| [if (x + y / 40) % 7 == 0 { 0 } else { 250 }; 3]),
];

fn noise(x: usize, y: usize, seed: u32) -> [u8; 3] {
    std::array::from_fn(|c| scattered(x as u32, y as u32, c as u32 + seed))
}

/// A byte of a place, as the library's tests have it.
fn scattered(x: u32, y: u32, seed: u32) -> u8 {
    let mut hash = x ^ y.rotate_left(16) ^ seed.wrapping_mul(0x9e37_79b9);
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    (hash ^ (hash >> 16)) as u8
}

/// A shaded disc on a light ground.
fn disc(x: usize, y: usize) -> [u8; 3] {
    let (dx, dy) = (x as i64 - 48, y as i64 - 40);
    if dx * dx + dy * dy < 900 { [200, (100 + dx) as u8, (90 - dy) as u8] } else { [240, 240, 235] }
}

fn gradient(x: usize, y: usize) -> [u8; 3] {
    [(x * 2) as u8, (y * 3) as u8, 128]
}

fn main() -> ExitCode {
    let mut largest = 0.0f32;
    println!("{:<12} {:>10} {:>10} {:>12}", "pair", "authors", "restyle", "largest diff");
    for (name, reference, test) in PAIRS {
        let bytes = |color: &Color| -> Vec<[u8; 3]> {
            (0..SIZE[0] * SIZE[1]).map(|index| color(index % SIZE[0], index / SIZE[0])).collect()
        };
        let [a, b] = [reference, test].map(bytes);
        let size = SIZE.map(|side| side as u32);
        let [theirs_a, theirs_b] =
            [&a, &b].map(|bytes| nv_flip::FlipImageRgb8::with_data(size[0], size[1], bytes.as_flattened()));
        let distance = nv_flip::pixels_per_degree(0.7, 3840.0, 0.7);
        let theirs = nv_flip::flip(theirs_a, theirs_b, distance).to_vec();
        let [ours_a, ours_b] = [&a, &b].map(|bytes| {
            let rgb = bytes.iter().map(|bytes| bytes.map(|byte| f32::from(byte) / 255.0)).collect();
            Picture { size, rgb }
        });
        let (metrics, ours) = match Metrics::of(&ours_a, &ours_b, &Mask::all(size)) {
            Ok(answer) => answer,
            Err(error) => {
                eprintln!("{name}: {error}");
                return ExitCode::FAILURE;
            }
        };
        let differences = theirs.iter().zip(&ours).map(|(a, b)| (a - b).abs());
        let (place, difference) =
            differences.enumerate().fold((0, 0.0), |most, next| if next.1 > most.1 { next } else { most });
        let mean = theirs.iter().copied().map(f64::from).sum::<f64>() / theirs.len() as f64;
        let at = |x: usize, y: usize| theirs[y * SIZE[0] + x];
        println!(
            "{name:<12} {mean:>10.6} {:>10.6} {difference:>12.2e}   at ({}, {}): {:.6}, {:.6}",
            metrics.flip,
            place % SIZE[0],
            place / SIZE[0],
            theirs[place],
            ours[place]
        );
        println!("{:12} authors at {}", "", PLACES.map(|[x, y]| format!("({x}, {y}): {:.6}", at(x, y))).join(", "));
        largest = largest.max(difference);
    }
    println!("largest difference of any pixel: {largest:.2e}");
    time();
    if largest <= TOLERANCE { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Prints how long a picture of 1920x1080 takes.
fn time() {
    let size = [1920u32, 1080];
    let bytes = |shift: usize| -> Vec<[u8; 3]> {
        (0..1920 * 1080).map(|index| disc((index % 1920 + shift) % SIZE[0], index / 1920 % SIZE[1])).collect()
    };
    let [a, b] = [bytes(0), bytes(1)];
    let theirs = [&a, &b].map(|bytes| nv_flip::FlipImageRgb8::with_data(size[0], size[1], bytes.as_flattened()));
    let [theirs_a, theirs_b] = theirs;
    let start = Instant::now();
    nv_flip::flip(theirs_a, theirs_b, nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    let theirs_ms = start.elapsed().as_millis();
    let [ours_a, ours_b] = [&a, &b].map(|bytes| {
        let rgb = bytes.iter().map(|bytes| bytes.map(|byte| f32::from(byte) / 255.0)).collect();
        Picture { size, rgb }
    });
    let start = Instant::now();
    let all = Metrics::of(&ours_a, &ours_b, &Mask::all(size)).is_ok();
    let ours_ms = start.elapsed().as_millis();
    println!("1920x1080: authors' FLIP {theirs_ms} ms, all of restyle's metrics {ours_ms} ms (done: {all})");
}
