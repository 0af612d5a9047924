//! The device that all GPU tests share, scenes small enough to write down, and pictures as linear light.
//!
//! Without an adapter the tests pass and say so; with `RESTYLE_GPU=required` they fail.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};

use glam::Vec3;
use restyle::config::{self, Catalog, Source, Srgba};
use restyle::engine::{self, Engine, Request};
use restyle::gpu::Gpu;
use restyle::scene::{AovImage, Image, Scene};

/// The adapter's device, opened once; `None` where there is none and none is required.
pub fn device() -> Option<Arc<Gpu>> {
    static GPU: OnceLock<Option<Arc<Gpu>>> = OnceLock::new();
    static SKIPPED: AtomicU32 = AtomicU32::new(0);
    let gpu = GPU.get_or_init(|| match Gpu::open() {
        Ok(gpu) => {
            eprintln!("GPU tests on {} ({} {})", gpu.info.name, gpu.info.driver, gpu.info.driver_info);
            Some(Arc::new(gpu))
        }
        Err(error) => {
            let required = std::env::var("RESTYLE_GPU").is_ok_and(|value| value == "required");
            assert!(!required, "{error}, and RESTYLE_GPU=required");
            None
        }
    });
    if gpu.is_none() {
        let count = SKIPPED.fetch_add(1, Ordering::Relaxed) + 1;
        eprintln!("skipped {count} so far of the GPU's scenes: there is no adapter");
    }
    gpu.clone()
}

/// An engine for a molecule as XYZ lines (`C 0 0 0`) and a style as JSON; `None` without an adapter.
pub fn engine(atoms: &[&str], style: &str) -> Option<Engine> {
    Some(engine_on(device()?, atoms, style))
}

/// The same on a device of its own, which no other test counts on.
#[allow(dead_code, reason = "only what counts needs it")]
pub fn lone_engine(atoms: &[&str], style: &str) -> Option<Engine> {
    device()?;
    Some(engine_on(Arc::new(Gpu::open().expect("an adapter that opened before")), atoms, style))
}

fn engine_on(gpu: Arc<Gpu>, atoms: &[&str], style: &str) -> Engine {
    let xyz = format!("{}\n\n{}\n", atoms.len(), atoms.join("\n"));
    let scene = Scene::from_bytes("test.xyz", xyz.as_bytes()).expect("a molecule");
    let source = Source::new("test.json", style);
    let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
    let style = config::load(&source, &catalog).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    assert!(style.warnings.is_empty(), "{:?}", style.warnings);
    Engine::new(gpu, scene, style)
}

/// A request of one opaque picture of 8 bits.
pub fn request(size: [u32; 2], samples: u32) -> Request {
    Request::new(size, samples)
}

/// Depth, normal, id and linear light at the pixels' centres.
pub fn aovs(engine: &mut Engine, size: [u32; 2]) -> AovImage {
    engine.aovs(&request(size, 1)).expect("AOVs")
}

/// A still of 16 bits a channel.
pub fn still(engine: &mut Engine, size: [u32; 2], samples: u32) -> Image {
    engine.still(&Request { wide: true, ..request(size, samples) }).expect("a still")
}

/// Linear light of an sRGB value [IEC61966, part 2-1].
pub fn linear_from_srgb(value: f32) -> f64 {
    let c = f64::from(value);
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// sRGB value of linear light [IEC61966, part 2-1].
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// One channel of a still in linear light.
pub fn channel(image: &Image, channel: usize) -> Vec<f64> {
    pixels(image.size).map(|(x, y)| linear_from_srgb(image.pixel(x, y)[channel])).collect()
}

/// All pixels, in the order in which pictures hold them.
pub fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = (u32, u32)> {
    (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)))
}

/// Linear light of a colour as a style writes it.
pub fn color(text: &str) -> Vec3 {
    restyle::shading::linear(Srgba::parse(text).expect("a colour"))
}
