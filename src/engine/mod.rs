//! The engine: the three providers, the scene and the renderer. Window, headless command and tests all use it.

mod build;
mod palette;

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;

use crate::config::{CatalogEntry, LightKind, ObjectKind, Role, Shadow, Style};
use crate::frame::{self, Aovs, FrameInput, Renderer, TargetBytes};
use crate::gpu::PassTimes;
use crate::providers::{CameraProvider, LightingProvider};
use crate::scene::{AovImage, Image, Pixels, Scene};
use crate::shading::SHADERS;

pub use crate::frame::MAX_SAMPLES;
pub use crate::gpu::{Gpu, GpuError};
pub use build::Built;

/// Effects and shaders of the contract that this version names but does not draw.
const NOT_DRAWN: [(&str, Role, &str); 4] = [
    ("curvature", Role::Object, "Glass that is clearer where the surface is flat."),
    ("ssaoPost", Role::PostEffect, "Darkens creases and contacts."),
    ("dofPost", Role::PostEffect, "Blurs what is out of focus."),
    ("outlinePost", Role::PostEffect, "Lines where depth or direction jump."),
];

/// Types of objects that this version draws.
pub const DRAWN_KINDS: &[ObjectKind] = &[ObjectKind::Atom, ObjectKind::Connector];

/// Names and parameter tables of everything a style can refer to, from the registries.
pub fn catalog() -> Vec<CatalogEntry> {
    let drawn = SHADERS.iter().map(|shader| CatalogEntry {
        name: shader.name(),
        role: Role::Object,
        doc: shader.doc(),
        params: shader.params(),
        drawn: true,
    });
    let named = NOT_DRAWN.iter().map(|&(name, role, doc)| CatalogEntry { name, role, doc, params: &[], drawn: false });
    drawn.chain(named).collect()
}

/// What to draw, and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// No background: straight alpha.
    pub transparent: bool,
    /// 16 bits a channel instead of 8.
    pub wide: bool,
}

/// Counts of what a frame draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Spheres.
    pub spheres: u32,
    /// Cylinders.
    pub cylinders: u32,
    /// Triangles that the rasteriser sees for one sample.
    pub triangles: u32,
}

/// One scene in one style on one device.
pub struct Engine {
    scene: Scene,
    style: Style,
    gpu: Arc<Gpu>,
    renderer: Renderer,
    built_for: Option<u32>,
    lighting: Option<LightingProvider>,
    camera: CameraProvider,
}

impl Engine {
    /// An engine for a scene and a style. Nothing is built before the first frame.
    pub fn new(gpu: Arc<Gpu>, scene: Scene, style: Style) -> Engine {
        let camera = camera_provider(&scene, &style);
        let renderer = Renderer::new(Arc::clone(&gpu));
        Engine { scene, style, gpu, renderer, built_for: None, lighting: None, camera }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Replaces the style; pipelines stay where the new one needs the same.
    pub fn set_style(&mut self, style: Style) {
        self.camera = camera_provider(&self.scene, &style);
        self.style = style;
        self.built_for = None;
    }

    /// Replaces the scene.
    pub fn set_scene(&mut self, scene: Scene) {
        self.camera = camera_provider(&scene, &self.style);
        self.scene = scene;
        self.built_for = None;
    }

    /// The camera for a picture of this size.
    pub fn camera(&self, size: [u32; 2]) -> crate::scene::Camera {
        self.camera.camera(size)
    }

    /// Resolves scene and style, unless that was done for this picture height.
    fn prepare(&mut self, request: &Request) -> Result<LightingProvider, GpuError> {
        let height = request.size[1];
        if let (Some(lighting), true) = (&self.lighting, self.built_for == Some(height)) {
            return Ok(lighting.clone());
        }
        let molecule = &self.scene.molecule;
        let built = build::build(molecule, &self.style, self.camera.exposure_factor(), height);
        self.renderer.set_contents(&built.list, &built.materials)?;
        let lighting = LightingProvider::new(self.style.lights.clone(), molecule.bounding_sphere(), built.lengths);
        self.lighting = Some(lighting.clone());
        self.built_for = Some(height);
        Ok(lighting)
    }

    /// Draws one frame and waits for it; returns its milliseconds (encode, submit, idle).
    ///
    /// # Errors
    /// [`GpuError`] where picture or scene do not fit the device, or the driver fails.
    pub fn draw(&mut self, request: &Request, timed: bool, progress: &mut dyn FnMut(u32)) -> Result<f64, GpuError> {
        self.with_input(request, |renderer, input| {
            let start = Instant::now();
            renderer.render(input, timed, progress)?;
            Ok(start.elapsed().as_secs_f64() * 1e3)
        })
    }

    /// The frame that was drawn last.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where it cannot be read back.
    pub fn read(&self, request: &Request) -> Result<Image, GpuError> {
        let bytes = self.renderer.read(request.wide)?;
        let pixels = if request.wide {
            Pixels::U16(bytes.chunks_exact(2).map(bytemuck::pod_read_unaligned).collect())
        } else {
            Pixels::U8(bytes)
        };
        Ok(Image {
            size: request.size,
            pixels,
            opaque: !request.transparent && self.camera.background(false)[3] >= 1.0,
        })
    }

    /// Draws and reads one still.
    ///
    /// # Errors
    /// As [`Engine::draw`].
    pub fn still(&mut self, request: &Request) -> Result<Image, GpuError> {
        self.draw(request, false, &mut |_| ())?;
        self.read(request)
    }

    /// The AOVs of the same view, one sample at each pixel's centre.
    ///
    /// # Errors
    /// As [`Engine::draw`].
    pub fn aovs(&mut self, request: &Request) -> Result<AovImage, GpuError> {
        let Aovs { geometry, mut ids, color } =
            self.with_input(request, |renderer, input| renderer.render_aovs(input))?;
        // Outlines are lines, not surfaces: they have no depth and no id.
        for (id, p) in ids.iter_mut().zip(geometry.chunks_exact(4)) {
            *id = if p[3] < 0.0 { 0 } else { *id };
        }
        let depth = geometry.chunks_exact(4).map(|p| if p[3] < 0.0 { f32::INFINITY } else { p[3] }).collect();
        let normal = geometry.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        Ok(AovImage { size: request.size, depth, normal, ids, color })
    }

    fn with_input<T>(
        &mut self,
        request: &Request,
        draw: impl FnOnce(&mut Renderer, &FrameInput<'_>) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let lighting_provider = self.prepare(request)?;
        let camera = self.camera.camera(request.size);
        let lighting = lighting_provider.lighting(&camera);
        let input = FrameInput {
            camera: &camera,
            lighting: &lighting,
            bounds: self.scene.molecule.bounding_sphere(),
            background: self.camera.background(request.transparent),
            size: request.size,
            samples: request.samples,
            wide: request.wide,
        };
        draw(&mut self.renderer, &input)
    }

    /// Milliseconds of each pass of the last timed frame.
    pub fn pass_times(&self) -> &PassTimes {
        self.renderer.pass_times()
    }

    /// What the last frame drew.
    pub fn counts(&self) -> Counts {
        let [spheres, cylinders] = self.renderer.object_counts();
        Counts { spheres, cylinders, triangles: 2 * (spheres + cylinders) }
    }

    /// Pipelines built so far.
    pub fn pipelines_built(&self) -> u32 {
        self.renderer.pipelines_built()
    }

    /// Bytes of each target of the last frame.
    pub fn target_bytes(&self) -> TargetBytes {
        self.renderer.target_bytes()
    }

    /// What the style asks of lights that a frame does not do, in plain words.
    pub fn limits_exceeded(&self) -> Vec<String> {
        let lights: Vec<_> = self.style.lights.iter().filter(|light| light.kind != LightKind::Ambient).collect();
        let mut exceeded = Vec::new();
        if lights.len() > frame::MAX_LIGHTS {
            exceeded.push(format!("the style has {} lights; only the first {} shine", lights.len(), frame::MAX_LIGHTS));
        }
        let mut casting = 0;
        for light in lights.iter().take(frame::MAX_LIGHTS).filter(|light| light.shadow != Shadow::None) {
            let inside =
                light.kind == LightKind::Point && DVec3::from_array(light.position).length() <= frame::SHADOWLESS_RADII;
            if inside {
                exceeded.push(
                    "a point light within the scene's sphere casts no shadow; move it more than 1.02 radii away"
                        .to_owned(),
                );
            } else {
                casting += 1;
            }
        }
        if casting > frame::MAX_SHADOWS {
            exceeded.push(format!(
                "{casting} lights cast shadows; only the shadows of the first {} are drawn",
                frame::MAX_SHADOWS
            ));
        }
        exceeded
    }
}

fn camera_provider(scene: &Scene, style: &Style) -> CameraProvider {
    let molecule = &scene.molecule;
    let positions = molecule.atoms.iter().map(|atom| atom.position);
    CameraProvider::new(style.camera.clone(), molecule.bounding_sphere(), positions)
}
