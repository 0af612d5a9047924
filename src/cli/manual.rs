//! The manual of style files as files: its Markdown, and its pictures, drawn by the engine.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use super::render::cannot_write;
use super::{Failure, answer};
use crate::config::manual::{FILE, PICTURES, Shown, Strip, manual, strips};
use crate::config::{self, Catalog, Source};
use crate::engine::{Engine, Gpu, Request};
use crate::scene::{Scene, write_whole};
use crate::shipped::{SCENES, find};

/// Width and height of one picture of a strip.
const TILE: [u32; 2] = [150, 112];

/// White between two pictures, in pixels.
const GAP: u32 = 4;

/// Samples a pixel.
const SAMPLES: u32 = 32;

/// Writes the manual and its pictures into a folder.
pub(super) fn write(folder: &Path, catalog: &Catalog<'_>) -> Result<(), Failure> {
    let gpu = Arc::new(Gpu::open()?);
    let pictures = folder.join(PICTURES);
    std::fs::create_dir_all(&pictures).map_err(|error| Failure::input(cannot_write(&pictures, &error)))?;
    let put = |file: &Path, bytes: &[u8]| {
        write_whole(file, |writer| writer.write_all(bytes)).map_err(|error| Failure::input(cannot_write(file, &error)))
    };
    let strips = strips(catalog);
    let mut total = 0;
    for strip in &strips {
        let png = encode(strip.styles.len() as u32, &draw(strip, catalog, &gpu)?);
        total += png.len();
        put(&pictures.join(strip.name()).with_extension("png"), &png)?;
    }
    let file = folder.join(FILE);
    put(&file, manual(catalog).as_bytes())?;
    answer(format_args!("{}: {} pictures, {} KB", file.display(), strips.len(), total / 1000))
}

/// Width of so many pictures side by side.
fn width(count: u32) -> u32 {
    count * (TILE[0] + GAP) - GAP
}

/// Draws the pictures of a strip side by side; RGB.
fn draw(strip: &Strip, catalog: &Catalog<'_>, gpu: &Arc<Gpu>) -> Result<Vec<u8>, Failure> {
    let scene = match strip.scene {
        Shown::Pdb(text) => Scene::from_bytes("manual.pdb", text.as_bytes()),
        Shown::Shipped(name) => {
            let found = SCENES.iter().find_map(|among| find(among, name));
            let shipped = found.expect("a test finds every scene of the manual");
            Scene::from_bytes(shipped.file, shipped.bytes)
        }
    };
    let scene = scene.map_err(Failure::input)?;
    let mut tiles = Vec::new();
    for style in &strip.styles {
        let source = Source::new(strip.name(), style.as_bytes());
        let style = config::load(&source, catalog).map_err(Failure::input)?;
        let mut engine = Engine::new(Arc::clone(gpu), scene.clone(), style);
        tiles.push(engine.still(&Request::new(TILE, SAMPLES))?);
    }
    let mut rgb = Vec::new();
    for y in 0..TILE[1] {
        for (i, tile) in tiles.iter().enumerate() {
            let gap = if i == 0 { 0 } else { GAP as usize * 3 };
            rgb.extend(std::iter::repeat_n(u8::MAX, gap));
            let bytes = (0..TILE[0]).flat_map(|x| tile.pixel(x, y).into_iter().take(3));
            // Six bits a channel look the same at this size and take a quarter less.
            rgb.extend(bytes.map(|value| ((value * 63.0).round() / 63.0 * 255.0).round() as u8));
        }
    }
    Ok(rgb)
}

/// A PNG as small as it gets: these are kept with the text.
fn encode(count: u32, rgb: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width(count), TILE[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(rgb));
    written.expect("memory takes every byte");
    bytes
}
