//! One frame, in order: shadow maps once, then for each sample visibility and shading, then resolve.
//!
//! A pass that nothing needs does not exist in that frame, and its pipeline and targets are never made.

mod aov;
mod fullscreen;
mod lights;
pub mod objects;
mod occlusion;
mod resolve;
mod shade;
mod shadow;
mod targets;
mod view;
mod visibility;

use std::collections::BTreeMap;
use std::sync::Arc;

pub use aov::aov_module;
pub use lights::{Light, Lights, MAX_LIGHTS};
use objects::{DrawList, Material, ObjectBuffers};
use occlusion::Reach;
pub use resolve::resolve_module;
pub use shade::{Output, ShadeKey, ShaderNeeds, shade_module};
use shade::{Shade, ShadeInputs, ShadeTarget};
pub use shadow::{MAX_SHADOWS, SHADOWLESS_RADII, ShadowView, Shadows};
use shadow::{ShadowMaps, ShadowPlan};
pub use targets::TargetBytes;
use targets::Targets;
pub use view::View;
use view::sample_offsets_px;
pub use visibility::VisibilityKey;
pub use visibility::visibility_module;
use visibility::{DEPTH_FORMAT, ID_FORMAT, Visibility, VisibilityPass};

use crate::gpu::{Gpu, GpuError, GpuStruct, PassTimer, PassTimes, StructInfo, read_texture};
use crate::scene::{Camera, LightPlace, Lighting, Sphere};
use crate::shading::{MAX_MATERIALS, SHADERS};

/// Pictures of 8 bits a channel, sRGB values written by the shader.
const OUTPUT_8: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Pictures of 16 bits a channel; an integer format, since every adapter can draw to it.
const OUTPUT_16: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Uint;

/// Largest number of samples of one still.
pub const MAX_SAMPLES: u32 = 4096;

/// Samples of one submission to the device. Ours: below a second on a software adapter at 1080p.
const SAMPLES_PER_SUBMISSION: usize = 8;

/// Where samples add up: 32-bit floats, or 16-bit ones where the adapter cannot blend those.
fn light_format(gpu: &Gpu) -> wgpu::TextureFormat {
    if gpu.adds_float32() { wgpu::TextureFormat::Rgba32Float } else { wgpu::TextureFormat::Rgba16Float }
}

/// Materials of a style: what all share, and each shader's parameter sets.
#[derive(Debug, Clone, Default)]
pub struct Materials {
    /// One for each material.
    pub common: Vec<Material>,
    /// Bytes of the parameter sets, by the shader's place in the registry.
    pub params: BTreeMap<usize, Vec<u8>>,
    /// Features that the materials of each shader use, one bit each.
    pub features: BTreeMap<usize, u32>,
}

impl Materials {
    fn has_hulls(&self) -> bool {
        let Reach { px, world } = self.reach();
        px + world > 0.0
    }

    /// The widest hull outline.
    fn reach(&self) -> Reach {
        self.common.iter().fold(Reach::default(), |reach, material| Reach {
            px: reach.px.max(material.hull_px),
            world: reach.world.max(material.hull_world),
        })
    }
}

/// What one still needs beside objects and materials.
#[derive(Debug, Clone)]
pub struct FrameInput<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The lights, in view space.
    pub lighting: &'a Lighting,
    /// What shadow maps must hold, in world space.
    pub bounds: Sphere,
    /// Premultiplied linear background; alpha 0 for a transparent picture.
    pub background: [f32; 4],
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// 16 bits a channel instead of 8.
    pub wide: bool,
}

/// Linear float pictures of the geometry and light at pixel centres.
pub struct Aovs {
    /// View-space normal and depth (-1: nothing), four floats a pixel.
    pub geometry: Vec<f32>,
    /// Ids; 0: nothing.
    pub ids: Vec<u32>,
    /// Premultiplied linear colour, four floats a pixel.
    pub color: Vec<f32>,
}

struct Contents {
    objects: ObjectBuffers,
    materials: wgpu::Buffer,
    params: Vec<wgpu::Buffer>,
    /// The needs of the objects; those of lights and output are filled in for each frame.
    needs: ShadeKey,
    /// What outlines add to the objects.
    reach: Reach,
}

/// Draws frames of one scene in one style.
pub struct Renderer {
    gpu: Arc<Gpu>,
    visibility: Visibility,
    shade: Shade,
    resolve: resolve::Resolve,
    aov: aov::Aov,
    targets: Targets,
    contents: Option<Contents>,
    pipelines_built: u32,
    last_times: PassTimes,
}

impl Renderer {
    /// A renderer that has nothing to draw yet and has built nothing yet.
    pub fn new(gpu: Arc<Gpu>) -> Renderer {
        let visibility = Visibility::new(&gpu);
        Renderer {
            gpu,
            visibility,
            shade: Shade::default(),
            resolve: resolve::Resolve::default(),
            aov: aov::Aov::default(),
            targets: Targets::default(),
            contents: None,
            pipelines_built: 0,
            last_times: Vec::new(),
        }
    }

    /// Replaces what is drawn. On an error the former contents stay.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] where objects exceed a storage binding.
    pub fn set_contents(&mut self, list: &DrawList, materials: &Materials) -> Result<(), GpuError> {
        let objects = ObjectBuffers::upload(&self.gpu, list)?;
        let array = |bytes, size| self.gpu.uniform_array("materials", bytes, size, MAX_MATERIALS);
        let common = array(bytemuck::cast_slice(&materials.common), size_of::<Material>())?;
        let params: Result<Vec<_>, _> = materials
            .params
            .iter()
            .map(|(&shader, bytes)| array(bytes, SHADERS[shader].material_info().size))
            .collect();
        self.contents = Some(Contents {
            objects,
            materials: common,
            params: params?,
            needs: needs(list, materials),
            reach: materials.reach(),
        });
        Ok(())
    }

    /// Draws one still and waits for it. `timed` also measures each pass; `progress` hears of samples that are done.
    ///
    /// # Errors
    /// [`GpuError`] where the picture or the objects do not fit, or the driver fails.
    pub fn render(
        &mut self,
        input: &FrameInput<'_>,
        timed: bool,
        progress: &mut dyn FnMut(u32),
    ) -> Result<(), GpuError> {
        let gpu = Arc::clone(&self.gpu);
        check_size(&gpu, input.size)?;
        let Some(contents) = &self.contents else { return Ok(()) };

        // What this frame needs.
        let samples = input.samples.clamp(1, MAX_SAMPLES);
        let direct = samples == 1 && !input.wide;
        let plan = ShadowPlan::new(input.lighting, input.camera, input.bounds, shadow::map_size(&gpu, input.size[1]));
        let shadowed = !plan.views.is_empty();
        let key = ShadeKey {
            lights: input.lighting.lights.len().min(MAX_LIGHTS) as u32,
            point_lights: input.lighting.lights.iter().any(|light| matches!(light.place, LightPlace::Point { .. })),
            shadows: shadowed,
            soft_taps: if shadowed { shadow::soft_taps(samples) } else { 0 },
            orthographic: input.camera.orthographic,
            encode: direct,
            ..contents.needs.clone()
        };
        let hulls = key.hulls;

        // Pipelines and targets that are not there yet.
        let seen = VisibilityKey { hulls, orthographic: input.camera.orthographic, light: false };
        // Outlines cast no shadows.
        let lit = |shadow: &ShadowView| VisibilityKey {
            hulls: false,
            orthographic: shadow.light.orthographic > 0.5,
            light: true,
        };
        for key in std::iter::once(seen).chain(plan.views.iter().map(lit)) {
            self.pipelines_built += self.visibility.prepare(&gpu, &contents.objects, key)?;
        }
        self.pipelines_built += self.shade.prepare(&gpu, &self.visibility, &key)?;
        if !direct {
            self.pipelines_built += self.resolve.prepare(&gpu, input.wide)?;
        }
        let maps =
            shadowed.then(|| ShadowMaps::new(&gpu, plan.views[0].light.size_px[0] as u32, plan.views.len() as u32));
        self.targets.fit(&gpu, input.size, if input.wide { OUTPUT_16 } else { OUTPUT_8 }, !direct);

        // Uniforms and bindings: a view for each sample, and the view of each light that casts shadows.
        let view = View::new(input.camera, input.size);
        let views: Vec<View> =
            (0..).zip(sample_offsets_px(samples)).map(|(index, offset)| view.sample(index, samples, offset)).collect();
        let bind =
            |views: &[View], reach| self.visibility.bind(&gpu, &contents.objects, &contents.materials, views, reach);
        let scene = bind(&views, contents.reach)?;
        let lit_scenes: Result<Vec<_>, _> =
            plan.views.iter().map(|shadow| bind(&[shadow.light], Reach::default())).collect();
        let lit_scenes = lit_scenes?;
        let [ids, depth, output] = self.targets.views()?;
        let light = self.targets.light_view();
        let shadow_uniform = plan.uniform();
        let inputs = ShadeInputs {
            lights: &Lights::new(input.lighting, &plan.layers),
            output: &Output { background: input.background },
            visibility: &ids,
            shadows: maps.as_ref().map(|maps| (maps, &shadow_uniform)),
            materials: &contents.params,
        };
        let Some(shade_group) = self.shade.bind(&gpu, &key, &inputs) else { return Ok(()) };
        let mut timer = if timed { PassTimer::new(&gpu) } else { None };

        // The frame, in submissions of a few samples each, so that progress can be told.
        let mut encoder = frame_encoder(&gpu);
        for (layer, (shadow, lit_scene)) in (0..).zip(plan.views.iter().zip(&lit_scenes)) {
            let Some(maps) = &maps else { break };
            let (map_ids, map_depth) = maps.layer(layer);
            let pass = VisibilityPass { name: "shadow", view: 0, key: lit(shadow), ids: &map_ids, depth: &map_depth };
            self.visibility.draw(&mut encoder, lit_scene, &pass, &mut timer);
        }
        let clear = if direct { clear_value(input.background) } else { wgpu::Color::TRANSPARENT };
        let target = ShadeTarget { light: light.as_ref().unwrap_or(&output), depth: &depth, clear };
        for index in 0..samples as usize {
            let pass = VisibilityPass { name: "visibility", view: index, key: seen, ids: &ids, depth: &depth };
            self.visibility.draw(&mut encoder, &scene, &pass, &mut timer);
            self.shade.draw(&mut encoder, &key, &scene, index, &shade_group, &target, &mut timer);
            if (index + 1) % SAMPLES_PER_SUBMISSION == 0 && index + 1 < samples as usize {
                gpu.queue.submit([std::mem::replace(&mut encoder, frame_encoder(&gpu)).finish()]);
                gpu.wait()?;
                progress(index as u32 + 1);
            }
        }
        if let Some(light) = &light {
            self.resolve.draw(&gpu, &mut encoder, input.wide, inputs.output, light, &output, &mut timer);
        }
        if let Some(timer) = &timer {
            timer.resolve(&mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        self.last_times = match &timer {
            Some(timer) => timer.read(&gpu)?,
            None => Vec::new(),
        };
        self.targets.note_shadow_bytes(maps.as_ref().map_or(0, ShadowMaps::bytes));
        Ok(())
    }

    /// The last still: straight-alpha sRGB, rows from the top, 4 channels of 8 bits, or of 16 bits in native order.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where it cannot be read back.
    pub fn read(&self, wide: bool) -> Result<Vec<u8>, GpuError> {
        read_texture(&self.gpu, self.targets.output()?, if wide { 8 } else { 4 })
    }

    /// The AOVs of the same view, one sample at each pixel's centre.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_aovs(&mut self, input: &FrameInput<'_>) -> Result<Aovs, GpuError> {
        // 16 bits keep the linear light of the single sample.
        let single = FrameInput { samples: 1, wide: true, ..input.clone() };
        self.render(&single, false, &mut |_| ())?;
        let gpu = Arc::clone(&self.gpu);
        let Some(contents) = &self.contents else {
            return Ok(Aovs { geometry: Vec::new(), ids: Vec::new(), color: Vec::new() });
        };
        let view = View::new(input.camera, input.size);
        let scene = self.visibility.bind(&gpu, &contents.objects, &contents.materials, &[view], contents.reach)?;
        let [ids, _, _] = self.targets.views()?;
        let geometry = gpu.target("geometry", input.size, 1, aov::GEOMETRY_FORMAT);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("aov") });
        let target = geometry.create_view(&Default::default());
        let from = aov::GeometrySource { ids: &ids, orthographic: input.camera.orthographic };
        self.aov.draw(&gpu, &mut encoder, &self.visibility, &scene, &from, &target)?;
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()?;
        let floats = |bytes: Vec<u8>| bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect::<Vec<f32>>();
        let light = self.targets.light()?;
        let color = if light.format() == wgpu::TextureFormat::Rgba16Float {
            let halves = read_texture(&gpu, light, 8)?;
            halves.chunks_exact(2).map(|h| half::f16::from_le_bytes([h[0], h[1]]).to_f32()).collect()
        } else {
            floats(read_texture(&gpu, light, 16)?)
        };
        Ok(Aovs {
            geometry: floats(read_texture(&gpu, &geometry, 16)?),
            ids: read_texture(&gpu, self.targets.ids()?, 4)?
                .chunks_exact(4)
                .map(bytemuck::pod_read_unaligned)
                .collect(),
            color,
        })
    }

    /// Milliseconds of each pass of the last timed frame; empty where the adapter has no timestamps.
    pub fn pass_times(&self) -> &PassTimes {
        &self.last_times
    }

    /// How many pipelines were built so far.
    pub fn pipelines_built(&self) -> u32 {
        self.pipelines_built
    }

    /// Spheres and cylinders that are drawn.
    pub fn object_counts(&self) -> [u32; 2] {
        self.contents.as_ref().map_or([0, 0], |c| [c.objects.num_atoms, c.objects.num_connectors])
    }

    /// Bytes of each target of the last frame.
    pub fn target_bytes(&self) -> TargetBytes {
        self.targets.bytes()
    }
}

/// What the shading of these objects reads, lights and output aside.
fn needs(list: &DrawList, materials: &Materials) -> ShadeKey {
    fn common(mut materials: impl Iterator<Item = u32>) -> Option<u32> {
        let first = materials.next()?;
        materials.all(|material| material == first).then_some(first)
    }
    let shaders = materials.params.keys().map(|&shader| ShaderNeeds {
        shader,
        features: materials.features.get(&shader).copied().unwrap_or(0),
        only_material: {
            let mut using = (0..).zip(&materials.common).filter(|(_, material)| material.shader as usize == shader);
            match (using.next(), using.next()) {
                (Some((material, _)), None) => Some(material),
                _ => None,
            }
        },
    });
    ShadeKey {
        shaders: shaders.collect(),
        atoms: !list.atoms.is_empty(),
        connectors: !list.connectors.is_empty(),
        atom_material: common(list.atoms.iter().map(|atom| atom.material)),
        connector_material: common(list.connectors.iter().map(|connector| connector.material)),
        hulls: materials.has_hulls(),
        lights: 0,
        point_lights: false,
        shadows: false,
        soft_taps: 0,
        orthographic: false,
        encode: false,
    }
}

/// A premultiplied linear background as the straight-alpha sRGB value that a direct frame leaves where nothing is.
fn clear_value(background: [f32; 4]) -> wgpu::Color {
    let alpha = f64::from(background[3]);
    let channel = |value: f32| {
        let linear = if alpha > 0.0 { f64::from(value) / alpha } else { 0.0 };
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
    };
    wgpu::Color { r: channel(background[0]), g: channel(background[1]), b: channel(background[2]), a: alpha }
}

fn frame_encoder(gpu: &Gpu) -> wgpu::CommandEncoder {
    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") })
}

fn check_size(gpu: &Gpu, size: [u32; 2]) -> Result<(), GpuError> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if size[0] == 0 || size[1] == 0 || size[0] > limit || size[1] > limit {
        return Err(GpuError::TooLarge { width: size[0], height: size[1], limit });
    }
    Ok(())
}

/// Every struct that Rust and WGSL both declare, for the layout test.
pub fn gpu_structs() -> Vec<StructInfo> {
    let mut all = vec![
        View::info(),
        objects::Atom::info(),
        objects::Connector::info(),
        Material::info(),
        Light::info(),
        Lights::info(),
        Output::info(),
        ShadowView::info(),
        Shadows::info(),
    ];
    for shader in SHADERS {
        all.push(shader.material_info());
        all.extend(shader.resource_infos());
    }
    all
}
