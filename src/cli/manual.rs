//! The manual of style files as files: its Markdown, and its pictures, drawn by the engine.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use super::render::cannot_write;
use super::{Failure, answer};
use crate::config::manual::{FILE, Molecule, PICTURES, Strip, manual, strips};
use crate::config::{self, Catalog, Source};
use crate::engine::{Engine, Gpu, Request};
use crate::scene::{Image, Pixels, Scene, write_whole};
use crate::shipped::{MOLECULES, find};

/// Width and height of one picture of a strip.
const TILE: [u32; 2] = [150, 112];

/// White between two pictures, in pixels.
const GAP: u32 = 4;

/// Samples a pixel.
const SAMPLES: u32 = 32;

/// Writes the manual and its pictures into a folder.
pub(super) fn write(folder: &Path, catalog: &Catalog<'_>) -> Result<(), Failure> {
    let pictures = folder.join(PICTURES);
    std::fs::create_dir_all(&pictures).map_err(|error| Failure::input(cannot_write(&pictures, &error)))?;
    let file = folder.join(FILE);
    let put = |file: &Path, bytes: &[u8]| {
        write_whole(file, |writer| writer.write_all(bytes)).map_err(|error| Failure::input(cannot_write(file, &error)))
    };
    put(&file, manual(catalog).as_bytes())?;
    let gpu = Arc::new(Gpu::open()?);
    let strips = strips(catalog);
    let mut total = 0;
    for strip in &strips {
        let png = encode(&draw(strip, catalog, &gpu)?);
        total += png.len();
        put(&pictures.join(strip.name()).with_extension("png"), &png)?;
    }
    answer(format_args!("{}: {} pictures, {} KB", file.display(), strips.len(), total / 1000))
}

/// Draws the pictures of a strip side by side.
fn draw(strip: &Strip, catalog: &Catalog<'_>, gpu: &Arc<Gpu>) -> Result<Image, Failure> {
    let scene = match strip.scene {
        Molecule::Pdb(text) => Scene::from_bytes("manual.pdb", text.as_bytes()),
        Molecule::Shipped(name) => {
            let molecule = find(MOLECULES, name).expect("a test finds every molecule of the manual");
            Scene::from_bytes(molecule.file, molecule.bytes)
        }
    };
    let scene = scene.map_err(Failure::input)?;
    let count = strip.styles.len() as u32;
    let width = count * (TILE[0] + GAP) - GAP;
    let mut pixels = vec![255; (width * TILE[1] * 4) as usize];
    let mut engine: Option<Engine> = None;
    for (i, style) in (0..).zip(&strip.styles) {
        let source = Source::new(strip.name(), style.as_bytes());
        let style = config::load(&source, catalog).map_err(Failure::input)?;
        let engine = match &mut engine {
            Some(engine) => {
                engine.set_style(style);
                engine
            }
            none => none.insert(Engine::new(Arc::clone(gpu), scene.clone(), style)),
        };
        let tile = engine.still(&Request { size: TILE, samples: SAMPLES, transparent: false, wide: false })?;
        let Pixels::U8(tile) = tile.pixels else { continue };
        let row = TILE[0] as usize * 4;
        for (y, line) in tile.chunks_exact(row).enumerate() {
            let start = (y * width as usize + (i * (TILE[0] + GAP)) as usize) * 4;
            pixels[start..start + row].copy_from_slice(line);
        }
    }
    Ok(Image { size: [width, TILE[1]], pixels: Pixels::U8(pixels), opaque: true })
}

/// A PNG as small as it gets: these are kept with the text.
fn encode(image: &Image) -> Vec<u8> {
    let Pixels::U8(pixels) = &image.pixels else { return Vec::new() };
    let rgb: Vec<u8> = pixels.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.size[0], image.size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&rgb));
    written.expect("memory takes every byte");
    bytes
}
