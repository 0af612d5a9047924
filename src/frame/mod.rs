//! One frame, in order: shadow maps once, then for each sample visibility, shading and post effects, then resolve.
//!
//! A pass that nothing needs does not exist in that frame, and its pipeline and targets are never made.

mod aov;
pub mod bkb;
mod contents;
mod explain;
mod fullscreen;
mod input;
pub mod layers;
mod lights;
pub mod mesh;
pub mod objects;
mod occlusion;
mod plan;
mod post;
mod resolve;
mod shade;
mod shadow;
pub mod sort;
mod targets;
mod texels;
mod view;
mod visibility;

use std::ops::ControlFlow;
use std::sync::Arc;

pub use aov::aov_module;
use bkb::{Bkb, BkbWords};
pub use contents::Materials;
use contents::{Contents, Needs};
pub use explain::Step;
pub use input::{FrameInput, LayerMethod};
use layers::{LayerTargets, Layers, LayersPlan};
pub use lights::{Light, Lights, MAX_LIGHTS};
use objects::{DrawList, Material};
use occlusion::Reach;
use plan::Plan;
pub use post::{Effect, EffectKey, Finish, effect_module};
use post::{EffectGroups, Post, PostTargets, turn};
pub use resolve::resolve_module;
pub use shade::{LayerWork, Output, ShadeKey, ShaderNeeds, shade_module};
use shade::{Shade, ShadeInputs, ShadeTarget};
use shadow::ShadowMaps;
pub use shadow::{MAX_SHADOWS, SHADOWLESS_RADII, ShadowFilter, ShadowQuality, ShadowView, Shadows};
pub use targets::TargetBytes;
use targets::Targets;
use view::sample_offsets_px;
pub use view::{Tile, View};
use visibility::{DEPTH_FORMAT, Eye, ID_FORMAT, Visibility, VisibilityPass};
pub use visibility::{Drawn, VisibilityKey};
pub use visibility::{mesh_module, visibility_module};

use crate::effects::EFFECTS;
use crate::gpu::{Gpu, GpuError, GpuStruct, PassTimer, PassTimes, StructInfo, read_texture};
use crate::shading::SHADERS;

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

/// A target in which samples add up.
fn adding_light(gpu: &Gpu) -> wgpu::ColorTargetState {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::ColorTargetState {
        format: light_format(gpu),
        blend: Some(wgpu::BlendState { color: add, alpha: add }),
        write_mask: wgpu::ColorWrites::ALL,
    }
}

/// Linear float pictures of the geometry and light at pixel centres.
pub struct Aovs {
    /// View-space normal and depth (-1: nothing), four floats a pixel.
    pub geometry: Vec<f32>,
    /// Ids; 0: nothing.
    pub ids: Vec<u32>,
    /// Premultiplied linear colour, four floats a pixel.
    pub color: Vec<f32>,
    /// What post effects found, by their places in the registry: one float a pixel, -1 where nothing is.
    pub found: Vec<(usize, Vec<f32>)>,
    /// How many transparent surfaces each pixel has.
    pub layer_count: Vec<u32>,
    /// Sum of the principal curvatures as they are seen, negative where convex, over scene units; meaningless where nothing is.
    pub curvature: Vec<f32>,
}

/// Draws frames of one scene in one style. Everything on the device is kept from frame to frame, and written again only
/// where it changed.
pub struct Renderer {
    gpu: Arc<Gpu>,
    visibility: Visibility,
    shade: Shade,
    post: Post,
    resolve: resolve::Resolve,
    aov: aov::Aov,
    targets: Targets,
    contents: Contents,
    eye: Eye,
    light_eyes: Vec<Eye>,
    maps: Option<ShadowMaps>,
    layers: Layers,
    bkb: Bkb,
    shadow_quality: ShadowQuality,
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
            post: Post::default(),
            resolve: resolve::Resolve::default(),
            aov: aov::Aov::default(),
            targets: Targets::default(),
            contents: Contents::default(),
            eye: Eye::default(),
            light_eyes: Vec::new(),
            maps: None,
            layers: Layers::default(),
            bkb: Bkb::default(),
            shadow_quality: ShadowQuality::default(),
            last_times: Vec::new(),
        }
    }

    /// Changes how fine the shadows of the next frames are.
    pub fn set_shadow_quality(&mut self, quality: ShadowQuality) {
        self.shadow_quality = quality;
    }

    /// Replaces the materials and, where `list` is given, the objects. On an error what was drawn stays.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] where objects or materials exceed what the device binds.
    pub fn set_contents(&mut self, list: Option<&DrawList>, materials: Materials) -> Result<(), GpuError> {
        self.contents.set(&self.gpu, list, materials)
    }

    /// Builds every pipeline that such contents would need for such a frame, and changes nothing that is drawn.
    ///
    /// # Errors
    /// [`GpuError`] where contents or picture do not fit the device, or a shader does not compile.
    pub fn prepare(
        &mut self,
        list: Option<&DrawList>,
        materials: &Materials,
        input: &FrameInput<'_>,
    ) -> Result<(), GpuError> {
        check_size(&self.gpu, input)?;
        let needs = self.contents.needs_of(&self.gpu, list, materials)?;
        self.build(&needs, &self.plan(&needs, input), input.wide)
    }

    /// Builds all pipelines anew from the shaders as they are now.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where one does not compile; all stay as they were then.
    pub fn rebuild_pipelines(&mut self) -> Result<(), GpuError> {
        let visibility = self.visibility.rebuilt(&self.gpu)?;
        let resolve = self.resolve.rebuilt(&self.gpu)?;
        self.shade.rebuild(&self.gpu, &visibility)?;
        self.post.rebuild(&self.gpu, &visibility)?;
        self.bkb.rebuild(&self.gpu, &visibility, &self.shade)?;
        self.visibility = visibility;
        self.resolve = resolve;
        self.aov = aov::Aov::default();
        self.layers.forget_pipelines();
        Ok(())
    }

    /// The passes of a frame, without drawing any.
    ///
    /// # Errors
    /// [`GpuError`] where the picture does not fit the device.
    pub fn explain(&self, input: &FrameInput<'_>) -> Result<Vec<Step>, GpuError> {
        check_size(&self.gpu, input)?;
        let plan = self.plan(&self.contents.needs(), input);
        let [spheres, cylinders] = self.object_counts().map(u64::from);
        Ok(explain::steps(&self.gpu, &plan, input, [spheres, cylinders, self.num_triangles()]))
    }

    /// Whether a frame blurs layers as they are blended, since lists of them all are more than the device holds at once. Known when it was
    /// drawn.
    pub fn layers_are_merged(&self, input: &FrameInput<'_>) -> bool {
        let needs = self.contents.needs();
        let wanted = Plan::new(&self.gpu, &needs, input, self.shadow_quality, true);
        wanted.is_apart() && !self.plan(&needs, input).is_apart()
    }

    fn plan(&self, needs: &Needs, input: &FrameInput<'_>) -> Plan {
        let can_keep = self.layers.can_keep(&self.gpu, input.drawn_size(), input.layer_bytes);
        Plan::new(&self.gpu, needs, input, self.shadow_quality, can_keep)
    }

    fn build(&mut self, needs: &Needs, plan: &Plan, wide: bool) -> Result<(), GpuError> {
        let gpu = &self.gpu;
        for key in std::iter::once(plan.seen).chain(plan.shadows.views.iter().map(|shadow| plan.lit(shadow))) {
            self.visibility.prepare(gpu, needs.kinds, key)?;
        }
        self.shade.prepare(gpu, &self.visibility, &plan.shade)?;
        for key in &plan.effects {
            self.post.prepare(gpu, &self.visibility, key)?;
        }
        if let Some(layers) = plan.lists() {
            for key in [layers.count, layers.write] {
                self.visibility.prepare(gpu, needs.kinds, key)?;
            }
            for key in [&layers.shade].into_iter().chain(&layers.mark) {
                self.shade.prepare(gpu, &self.visibility, key)?;
            }
            self.layers.prepare(gpu, &self.shade, layers)?;
        }
        if let Some(bkb) = &plan.bkb {
            self.bkb.prepare(gpu, &self.visibility, &mut self.shade, bkb)?;
        }
        if !plan.direct {
            self.resolve.prepare(gpu, wide)?;
        }
        Ok(())
    }

    /// Draws one still and waits for it. `timed` also measures each pass; `progress` hears of samples that are done,
    /// and may break off.
    ///
    /// # Errors
    /// [`GpuError`] where the picture or the objects do not fit, the driver fails, or `progress` breaks off.
    pub fn render(
        &mut self,
        input: &FrameInput<'_>,
        timed: bool,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
    ) -> Result<(), GpuError> {
        self.draw_frame(input, timed, progress, None)
    }

    /// The same; what effects find goes to `found`, where there is one sample. Drawn again where the pool of layers was too small.
    fn draw_frame(
        &mut self,
        input: &FrameInput<'_>,
        timed: bool,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
        mut found: Option<&mut Vec<(usize, wgpu::Texture)>>,
    ) -> Result<(), GpuError> {
        loop {
            self.draw_once(input, timed, progress, found.as_deref_mut())?;
            if self.layers.finish(&self.gpu, input.layer_bytes)? {
                return Ok(());
            }
        }
    }

    fn draw_once(
        &mut self,
        input: &FrameInput<'_>,
        timed: bool,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
        found: Option<&mut Vec<(usize, wgpu::Texture)>>,
    ) -> Result<(), GpuError> {
        let gpu = Arc::clone(&self.gpu);
        check_size(&gpu, input)?;
        let Some(materials) = self.contents.common() else { return Ok(()) };

        // What this frame needs, and what of it is not there yet.
        let needs = self.contents.needs();
        let mut plan = self.plan(&needs, input);
        if found.is_some() {
            plan.ask_for_aovs();
        }
        self.build(&needs, &plan, input.wide)?;
        let output_format = if input.wide { OUTPUT_16 } else { OUTPUT_8 };
        self.targets.fit(&gpu, input.drawn_size(), output_format, !plan.direct, plan.chain());
        let effect_bytes = self.post.fit(&gpu, input.drawn_size(), &plan.effects);
        self.fit_shadows(&plan);
        let view = input.view();
        match plan.lists() {
            Some(layers) => {
                self.layers.begin(&gpu, input.drawn_size(), input.layer_bytes, plan.samples, layers)?;
            }
            None => self.layers = Layers::default(),
        }
        match &plan.bkb {
            Some(bkb) => {
                let of = (&view, input.drawn_size());
                self.bkb.begin(&gpu, of, input.layer_bytes, bkb, &self.contents.objects)?;
            }
            None => self.bkb.forget_buffers(),
        }

        // Uniforms and bindings: a view for each sample, and the view of each light that casts shadows.
        let samples = plan.samples;
        let views: Vec<View> =
            (0..).zip(sample_offsets_px(samples)).map(|(index, offset)| view.sample(index, samples, offset)).collect();
        let (objects, reach) = (&self.contents.objects, self.contents.reach());
        let all_opaque = plan.layers.is_none();
        let outlined = (reach, all_opaque);
        let Some(scene) = self.visibility.bind(&gpu, &mut self.eye, objects, &materials, &views, outlined)? else {
            return Ok(());
        };
        let mut lit_scenes = Vec::with_capacity(plan.shadows.views.len());
        for (eye, shadow) in self.light_eyes.iter_mut().zip(&plan.shadows.views) {
            let views = [shadow.light];
            lit_scenes.extend(self.visibility.bind(
                &gpu,
                eye,
                objects,
                &materials,
                &views,
                (Reach::default(), all_opaque),
            )?);
        }
        let [ids, depth, output] = self.targets.views()?;
        let light = self.targets.light_view();
        let shadow_uniform = plan.shadows.uniform();
        let inputs = ShadeInputs {
            lights: &Lights::new(input.lighting, &plan.shadows.layers),
            output: &Output { background: input.background },
            visibility: &ids,
            shadows: self.maps.as_ref().map(|maps| (maps, &shadow_uniform)),
            materials: &self.contents.params,
            tables: &self.contents.tables,
        };
        let Some((shade_group, background)) = self.shade.bind(&gpu, &plan.shade, &inputs)? else { return Ok(()) };
        let finished = light.as_ref().unwrap_or(&output);
        let shaded = self.targets.shaded_views();
        let post = shaded.as_ref().map(|shaded| PostTargets {
            ids: &ids,
            geometry: &shaded.geometry,
            colors: &shaded.colors,
            line_geometry: &shaded.line_geometry,
            line_colors: &shaded.line_colors,
            last: finished,
            output: &background,
        });
        let effect_groups: Option<EffectGroups> = match &post {
            Some(targets) => {
                let lists = if plan.is_apart() { self.layers.lists(&gpu)? } else { None };
                self.post.bind(&gpu, input.effects, &plan.effects, targets, (plan.layers_at(), lists))?
            }
            None => None,
        };
        let layers_group = match plan.lists() {
            Some(layers) => self.shade.bind(&gpu, &layers.shade, &inputs)?,
            None => None,
        };
        let bkb_group = match &plan.bkb {
            Some(bkb) => self.bkb.bind_shading(&gpu, &mut self.shade, bkb, &inputs)?,
            None => None,
        };
        let mut timer = if timed { PassTimer::new(&gpu) } else { None };

        // The frame, in submissions of a few samples each, so that progress can be told.
        let mut encoder = frame_encoder(&gpu);
        let layers = self.maps.iter().filter(|_| !input.shadows_drawn).flat_map(ShadowMaps::layers);
        for ((ids, depth), (shadow, lit_scene)) in layers.zip(plan.shadows.views.iter().zip(&lit_scenes)) {
            let pass =
                VisibilityPass { name: "shadow", view: 0, key: plan.lit(shadow), ids, depth, seen: &shadow.light };
            self.visibility.draw(&mut encoder, lit_scene, objects, &pass, &mut timer);
        }
        let clear = if plan.shade.encode { clear_value(input.background) } else { wgpu::Color::TRANSPARENT };
        let shaded_light = post.as_ref().and_then(|post| post.colors.first()).unwrap_or(finished);
        let geometry = post.as_ref().and_then(|post| post.geometry.first());
        let target = ShadeTarget { light: shaded_light, geometry, depth: &depth, clear };
        for index in 0..samples as usize {
            let pass = VisibilityPass {
                name: "visibility",
                view: index,
                key: plan.seen,
                ids: &ids,
                depth: &depth,
                seen: &view,
            };
            self.visibility.draw(&mut encoder, &scene, objects, &pass, &mut timer);
            self.shade.draw(&mut encoder, &plan.shade, &scene, index, &shade_group, &target, &mut timer);
            let at = plan.layers_at();
            let num_before = at.map_or(plan.effects.len(), |at| at.effects);
            if let (Some(targets), Some(groups)) = (&post, &effect_groups) {
                let before = (0..num_before, at);
                self.post.draw(&mut encoder, &plan.effects, &scene, index, groups, targets, before, &mut timer);
            }
            if let (Some(targets), Some(_)) = (&post, &plan.layers) {
                let is_last = num_before == plan.effects.len();
                let (Some(color), Some(next), Some(opaque)) =
                    (turn(targets.colors, num_before), turn(targets.colors, num_before + 1), targets.geometry.first())
                else {
                    continue;
                };
                let to = LayerTargets {
                    color,
                    geometry: opaque,
                    depth: &depth,
                    ids: &ids,
                    to: match &plan.layers {
                        Some(LayersPlan { apart: Some(_), .. }) => targets.line_colors.first(),
                        _ if is_last => Some(targets.last),
                        _ => Some(next),
                    },
                    to_geometry: match plan.is_apart() {
                        true => targets.line_geometry.first(),
                        false => turn(targets.geometry, 1).filter(|_| !is_last),
                    },
                    clears: index == 0 || !is_last,
                };
                let on = (&scene, objects);
                if let (Some(layers), Some((group, _))) = (plan.lists(), &layers_group) {
                    let with = (&self.visibility, &self.shade);
                    self.layers.draw(&gpu, &mut encoder, with, layers, on, &pass, group, &to, &mut timer)?;
                }
                // Over what lists came to: of them only the nearest surfaces stay.
                if let (Some(bkb), Some(group)) = (&plan.bkb, &bkb_group) {
                    self.bkb.draw(&gpu, &mut encoder, &self.visibility, bkb, on, &pass, group, &to, &mut timer)?;
                }
            }
            if let (Some(targets), Some(groups)) = (&post, &effect_groups) {
                let after = (num_before..plan.effects.len(), at);
                self.post.draw(&mut encoder, &plan.effects, &scene, index, groups, targets, after, &mut timer);
            }
            if (index + 1) % SAMPLES_PER_SUBMISSION == 0 && index + 1 < samples as usize {
                gpu.queue.submit([std::mem::replace(&mut encoder, frame_encoder(&gpu)).finish()]);
                gpu.wait()?;
                if progress(index as u32 + 1).is_break() {
                    return Err(GpuError::BrokenOff);
                }
            }
        }
        if let (Some(found), Some(groups)) = (found, &effect_groups) {
            let (keys, size) = (&plan.effects, input.drawn_size());
            *found = self.post.draw_aovs(&gpu, &mut encoder, &self.visibility, keys, &scene, groups, size)?;
        }
        if let Some(light) = &light {
            self.resolve.draw(&gpu, &mut encoder, input.wide, &background, light, &output, &mut timer);
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
        self.targets.note_shadow_bytes(self.maps.as_ref().map_or(0, ShadowMaps::bytes));
        self.targets.note_effect_bytes(effect_bytes);
        self.targets.note_layer_bytes(self.layers.bytes() + self.bkb.bytes());
        Ok(())
    }

    /// Makes shadow maps and the eyes of lights as the frame needs them; what fits already stays.
    fn fit_shadows(&mut self, plan: &Plan) {
        let count = plan.shadows.views.len();
        self.light_eyes.resize_with(count, Eye::default);
        let former = self.maps.take().filter(|maps| maps.fit(plan.map_size, count as u32));
        if count > 0 {
            self.maps = Some(former.unwrap_or_else(|| ShadowMaps::new(&self.gpu, plan.map_size, count as u32)));
        }
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
        let single = FrameInput { samples: 1, wide: true, tile: None, shadows_drawn: false, ..input.clone() };
        let mut found = Vec::new();
        self.draw_frame(&single, false, &mut |_| ControlFlow::Continue(()), Some(&mut found))?;
        let gpu = Arc::clone(&self.gpu);
        let num_pixels = input.size[0] as usize * input.size[1] as usize;
        let layer_count = self.layers.read_counts(&gpu)?.unwrap_or_else(|| vec![0; num_pixels]);
        let (view, objects, reach) =
            (View::new(input.camera, input.size), &self.contents.objects, self.contents.reach());
        let scene = match self.contents.common() {
            Some(materials) => {
                let outlined = (reach, !self.contents.needs().layered);
                self.visibility.bind(&gpu, &mut self.eye, objects, &materials, &[view], outlined)?
            }
            None => None,
        };
        let Some(scene) = scene else {
            return Ok(Aovs {
                geometry: Vec::new(),
                ids: Vec::new(),
                color: Vec::new(),
                found: Vec::new(),
                layer_count: Vec::new(),
                curvature: Vec::new(),
            });
        };
        let [ids, _, _] = self.targets.views()?;
        let geometry = gpu.target("geometry", input.size, 1, aov::GEOMETRY_FORMAT);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("aov") });
        let curvature = gpu.target("curvature", input.size, 1, aov::CURVATURE_FORMAT);
        let views = [&geometry, &curvature].map(|target| target.create_view(&Default::default()));
        let from = aov::GeometrySource {
            ids: &ids,
            orthographic: input.camera.orthographic,
            meshes: self.contents.needs().kinds.meshes,
        };
        self.aov.draw(&gpu, &mut encoder, &self.visibility, &scene, &from, views.each_ref())?;
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
        let found = found.into_iter().map(|(effect, texture)| Ok((effect, floats(read_texture(&gpu, &texture, 4)?))));
        Ok(Aovs {
            layer_count,
            found: found.collect::<Result<_, GpuError>>()?,
            geometry: floats(read_texture(&gpu, &geometry, 16)?),
            curvature: floats(read_texture(&gpu, &curvature, 4)?),
            ids: read_texture(&gpu, self.targets.ids()?, 4)?
                .chunks_exact(4)
                .map(bytemuck::pod_read_unaligned)
                .collect(),
            color,
        })
    }

    /// The k-buffer of the same view and the fragments that it was made of; none where the frame has none, or in bands.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_bkb(&mut self, input: &FrameInput<'_>) -> Result<Option<BkbWords>, GpuError> {
        let single = FrameInput { samples: 1, wide: true, tile: None, shadows_drawn: false, ..input.clone() };
        self.draw_frame(&single, false, &mut |_| ControlFlow::Continue(()), Some(&mut Vec::new()))?;
        let gpu = Arc::clone(&self.gpu);
        let Some(words) = self.bkb.read(&gpu)? else { return Ok(None) };
        let fragments = self.layers.read_lists(&gpu)?;
        Ok(fragments.map(|fragments| BkbWords { fragments, ..words }))
    }

    /// Milliseconds of each pass of the last timed frame; empty where the adapter has no timestamps.
    pub fn pass_times(&self) -> &PassTimes {
        &self.last_times
    }

    /// How far what is transparent in a pixel changes others, in pixels.
    pub fn layers_reach_px(&self, method: LayerMethod) -> u32 {
        let needs = self.contents.needs();
        match method {
            _ if !needs.layered => 0,
            LayerMethod::Packed if needs.key.asks_neighbours() => layers::HALO,
            LayerMethod::Packed => 0,
            _ => 1,
        }
    }

    /// Triangles of meshes that are drawn.
    pub fn num_triangles(&self) -> u64 {
        self.contents.objects.meshes.num_triangles()
    }

    /// Spheres and cylinders that are drawn.
    pub fn object_counts(&self) -> [u32; 2] {
        [self.contents.objects.num_atoms, self.contents.objects.num_connectors]
    }

    /// Bytes of the objects on the device.
    pub fn object_bytes(&self) -> u64 {
        self.contents.objects.bytes()
    }

    /// Bytes of each target of the last frame.
    pub fn target_bytes(&self) -> TargetBytes {
        self.targets.bytes()
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

fn check_size(gpu: &Gpu, input: &FrameInput<'_>) -> Result<(), GpuError> {
    check_picture(gpu, input.size)?;
    check_picture(gpu, input.drawn_size())
}

/// Refuses a picture beyond the device's largest texture; viewports end there, too, so that tiles do not help.
///
/// # Errors
/// [`GpuError::TooLarge`] with both sizes.
pub fn check_picture(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<(), GpuError> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if width == 0 || height == 0 || width > limit || height > limit {
        return Err(GpuError::TooLarge { width, height, limit });
    }
    Ok(())
}

/// Every struct that Rust and WGSL both declare, for the layout test.
pub fn gpu_structs() -> Vec<StructInfo> {
    let mut all = vec![
        View::info(),
        objects::Atom::info(),
        objects::Connector::info(),
        mesh::MeshVertex::info(),
        mesh::MeshPart::info(),
        mesh::MeshRun::info(),
        Material::info(),
        Light::info(),
        Lights::info(),
        Output::info(),
        ShadowView::info(),
        Shadows::info(),
        layers::LayerBand::info(),
        bkb::BkbBand::info(),
    ];
    for shader in SHADERS {
        all.push(shader.material_info());
        all.extend(shader.resource_infos());
    }
    all.extend(EFFECTS.iter().map(|effect| effect.params_info()));
    all
}
