//! The shading pass: each pixel once, from the id that it sees, with only the shaders that the style uses.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fmt::Write as _;

use super::fullscreen;
use super::layers::{self, LayerTargets};
use super::lights::Lights;
use super::mesh::{self, MeshForm};
use super::post::{self, Finish};
use super::shadow::{ShadowFilter, ShadowMaps, Shadows};
use super::texels::KeptTexture;
use super::visibility::{DEPTH_FORMAT, SceneBindings, Visibility};
use crate::gpu::{Bound, Gpu, GpuError, KeptBindGroup, KeptBuffer, Module, PassTimer, Wgsl};
use crate::gpu_struct;
use crate::shading::{self, ObjectShader, SHADERS, UploadedResource};
use crate::wgsl;

gpu_struct! {
    "objects/shade.wgsl",
    /// See `shaders/objects/shade.wgsl`.
    pub struct Output {
        /// Premultiplied linear background; alpha 0 for a transparent picture.
        pub background: [f32; 4],
    }
}

/// What a shading pipeline is built for; equal needs share one pipeline. Whatever a frame does not use is no part of its
/// shader, since a software adapter runs every line of a shader for every pixel.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ShadeKey {
    /// The shaders that the style uses, ascending by registry place.
    pub shaders: Vec<ShaderNeeds>,
    /// Whether there are atoms.
    pub atoms: bool,
    /// Whether there are connectors.
    pub connectors: bool,
    /// What is known of triangles of meshes, where there are any.
    pub meshes: Option<MeshForm>,
    /// The one material of all atoms, where there is only one.
    pub atom_material: Option<u32>,
    /// The one material of all connectors, where there is only one.
    pub connector_material: Option<u32>,
    /// The one material of all parts of meshes, where there is only one.
    pub part_material: Option<u32>,
    /// Whether a material has a hull outline.
    pub hulls: bool,
    /// Directional and point lights.
    pub lights: u32,
    /// Whether one of them is a point light.
    pub point_lights: bool,
    /// Whether there is ambient light.
    pub ambient: bool,
    /// Whether a light casts shadows.
    pub shadows: bool,
    /// Taps of a soft shadow's filter, for one sample.
    pub soft_taps: u32,
    /// What of the shadow maps tells shadows.
    pub shadow_filter: ShadowFilter,
    /// Whether the camera is orthographic.
    pub orthographic: bool,
    /// Straight to 8-bit picture values, instead of adding up linear light.
    pub encode: bool,
    /// Light that is not weighted yet and the surface beside it, for post effects.
    pub geometry: bool,
    /// Layers of what is transparent instead of the nearest surface: where the blended picture goes, and whether its nearest
    /// surface goes beside it.
    pub layers: Option<(Finish, bool)>,
    /// What is done with layers, where there are any.
    pub layer_work: LayerWork,
}

/// What is done with the layers of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum LayerWork {
    /// They are shaded and blended.
    #[default]
    Blend,
    /// They are shaded and kept, each with its own light; a surface beside them is then that of lines.
    Keep,
    /// What neighbouring pixels ask of them is kept.
    Mark {
        /// Whether their light will be, too.
        keeps_light: bool,
    },
}

impl LayerWork {
    /// Whether the pool has room for their light.
    fn keeps_light(self) -> bool {
        matches!(self, LayerWork::Keep | LayerWork::Mark { keeps_light: true })
    }
}

/// What a style needs of one shader.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ShaderNeeds {
    /// Its place in the registry.
    pub shader: usize,
    /// The features that its materials use, one bit each.
    pub features: u32,
    /// The material that alone uses it, where only one does.
    pub only_material: Option<u32>,
}

impl ShadeKey {
    /// Whether all that it leaves lies in the pool of layers.
    fn has_no_target(&self) -> bool {
        self.layers.is_some_and(|(_, surfaces)| match self.layer_work {
            LayerWork::Blend => false,
            LayerWork::Keep => !surfaces,
            LayerWork::Mark { .. } => true,
        })
    }

    /// Whether its layers, where it has any, are shaded by what lies beside them in neighbouring pixels.
    pub fn asks_neighbours(&self) -> bool {
        self.shaders.iter().any(|needs| SHADERS[needs.shader].asks_neighbours(needs.features))
    }
}

/// First binding of the shaders' own bindings in group 1.
const FIRST_SHADER_BINDING: u32 = 5;

struct ShadePipeline {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    /// When it was used last, in uses of any pipeline.
    last_use: u64,
}

/// What the shading pass reads beside the scene.
pub struct ShadeInputs<'a> {
    /// The lights.
    pub lights: &'a Lights,
    /// The background.
    pub output: &'a Output,
    /// Ids of the visibility pass.
    pub visibility: &'a wgpu::TextureView,
    /// Shadow maps and their views, where lights cast shadows.
    pub shadows: Option<(&'a ShadowMaps, &'a Shadows)>,
    /// Parameter sets of each shader, by its registry place.
    pub materials: &'a BTreeMap<usize, KeptBuffer>,
    /// Tables of each shader that has any.
    pub tables: &'a BTreeMap<usize, KeptTexture>,
}

/// Where the shading pass draws.
pub struct ShadeTarget<'a> {
    /// Light, or picture values.
    pub light: &'a wgpu::TextureView,
    /// Surfaces, for post effects.
    pub geometry: Option<&'a wgpu::TextureView>,
    /// Depths of the visibility pass.
    pub depth: &'a wgpu::TextureView,
    /// What stays where nothing is seen.
    pub clear: wgpu::Color,
}

/// Pipelines of the shading pass, by need, the resources of its shaders, and its uniforms.
pub struct Shade {
    pipelines: BTreeMap<ShadeKey, ShadePipeline>,
    uses: u64,
    resources: BTreeMap<usize, Vec<UploadedResource>>,
    lights: KeptBuffer,
    output: KeptBuffer,
    shadows: KeptBuffer,
    /// For nearest surfaces, for layers, and for buckets: not one for each pipeline, which would keep targets of former sizes alive.
    groups: [KeptBindGroup; 3],
    /// What blending layers binds.
    layers_layout: Option<wgpu::BindGroupLayout>,
}

/// Pipelines that are kept, the ones used last. Ours: a designer goes back and forth between a few states, and each new
/// set of features makes one; without an end, a day of saves would fill the memory.
const MOST_PIPELINES: usize = 32;

impl Default for Shade {
    fn default() -> Shade {
        Shade {
            pipelines: BTreeMap::new(),
            uses: 0,
            resources: BTreeMap::new(),
            lights: KeptBuffer::uniform("lights"),
            output: KeptBuffer::uniform("output"),
            shadows: KeptBuffer::uniform("shadows"),
            groups: Default::default(),
            layers_layout: None,
        }
    }
}

impl Shade {
    /// Builds the pipeline of a key, unless it is there.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    pub fn prepare(&mut self, gpu: &Gpu, visibility: &Visibility, key: &ShadeKey) -> Result<(), GpuError> {
        self.upload(gpu, key)?;
        if key.layers.is_some() {
            self.layers_layout.get_or_insert_with(|| layers::blend_layout(gpu));
        }
        self.uses += 1;
        if let Some(pipeline) = self.pipelines.get_mut(key) {
            pipeline.last_use = self.uses;
            return Ok(());
        }
        let built = self.build(gpu, visibility, key)?;
        if self.pipelines.len() >= MOST_PIPELINES
            && let Some(oldest) = self.pipelines.iter().min_by_key(|(_, pipeline)| pipeline.last_use)
        {
            let oldest = oldest.0.clone();
            self.pipelines.remove(&oldest);
        }
        self.pipelines.insert(key.clone(), built);
        Ok(())
    }

    /// Uploads what the shaders of a key bind beside their materials, unless it is there.
    ///
    /// # Errors
    /// [`GpuError`] where it does not fit the device.
    pub fn upload(&mut self, gpu: &Gpu, key: &ShadeKey) -> Result<(), GpuError> {
        for shader in key.shaders.iter().map(|needs| needs.shader) {
            if let Entry::Vacant(entry) = self.resources.entry(shader) {
                let uploaded: Result<Vec<_>, _> =
                    SHADERS[shader].resources().iter().map(|resource| shading::upload(gpu, resource)).collect();
                entry.insert(uploaded?);
            }
        }
        Ok(())
    }

    /// Builds the pipelines that are there anew, from the shaders as they are now, and keeps everything else.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile; nothing has changed then.
    pub fn rebuild(&mut self, gpu: &Gpu, visibility: &Visibility) -> Result<(), GpuError> {
        let keys: Vec<ShadeKey> = self.pipelines.keys().cloned().collect();
        let fresh: Result<BTreeMap<_, _>, GpuError> =
            keys.into_iter().map(|key| Ok((key.clone(), self.build(gpu, visibility, &key)?))).collect();
        self.pipelines = fresh?;
        Ok(())
    }

    fn build(&self, gpu: &Gpu, visibility: &Visibility, key: &ShadeKey) -> Result<ShadePipeline, GpuError> {
        let module = shade_module(key).compile(gpu, "shade")?;
        let layout = self.layout(gpu, key);
        let layers = self.layers_layout.as_ref().filter(|_| key.layers.is_some());
        let groups: Vec<_> = [&visibility.layout, &layout].into_iter().chain(layers).map(Some).collect();
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shade"),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        let (entry_point, targets) = if key.has_no_target() {
            (if key.layer_work == LayerWork::Keep { "keep_layers" } else { "mark_layers" }, Vec::new())
        } else if key.layer_work == LayerWork::Keep && key.layers.is_some() {
            let formats = [post::COLOR_FORMAT, post::GEOMETRY_FORMAT];
            ("keep_layers_geometry", formats.map(|format| Some(format.into())).to_vec())
        } else if let Some((finish, surfaces)) = key.layers {
            let surface = surfaces.then(|| Some(post::GEOMETRY_FORMAT.into()));
            let entry = if surfaces { "blend_layers_geometry" } else { "blend_layers" };
            (entry, std::iter::once(Some(post::target_of(gpu, finish))).chain(surface).collect())
        } else if key.geometry {
            let formats = [post::COLOR_FORMAT, post::GEOMETRY_FORMAT];
            ("shade_geometry_fragment", formats.map(|format| Some(format.into())).to_vec())
        } else if key.encode {
            ("shade_fragment", vec![Some(super::OUTPUT_8.into())])
        } else {
            ("shade_fragment", vec![Some(super::adding_light(gpu))])
        };
        let pipeline = gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("shade"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(fullscreen::VERTEX),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            // The pass lies behind all that is drawn: only pixels that see something are shaded at all. A pass without
            // another target has this one, and passes everywhere.
            depth_stencil: (key.layers.is_none() || key.has_no_target()).then(|| wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(false),
                depth_compare: Some(match key.has_no_target() {
                    true => wgpu::CompareFunction::Always,
                    false => wgpu::CompareFunction::Less,
                }),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })?;
        Ok(ShadePipeline { layout, pipeline, last_use: self.uses })
    }

    /// What the shading of a key binds beside the scene.
    pub fn layout(&self, gpu: &Gpu, key: &ShadeKey) -> wgpu::BindGroupLayout {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = |sample_type, view_dimension| wgpu::BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled: false,
        };
        use wgpu::TextureViewDimension::{D2, D2Array};
        let mut entries =
            vec![entry(0, uniform), entry(1, uniform), entry(2, texture(wgpu::TextureSampleType::Uint, D2))];
        if key.shadows {
            entries.push(entry(3, uniform));
            entries.push(entry(4, texture(wgpu::TextureSampleType::Uint, D2Array)));
        }
        let mut binding = FIRST_SHADER_BINDING;
        for shader in key.shaders.iter().map(|needs| &needs.shader) {
            entries.push(entry(binding, uniform));
            binding += 1;
            if SHADERS[*shader].tables_name().is_some() {
                entries.push(entry(binding, texture(wgpu::TextureSampleType::Uint, D2)));
                binding += 1;
            }
            for resource in self.resources.get(shader).into_iter().flatten() {
                let ty = match resource {
                    UploadedResource::Uniform(_) => uniform,
                    UploadedResource::Texture(_) => texture(wgpu::TextureSampleType::Float { filterable: false }, D2),
                };
                entries.push(entry(binding, ty));
                binding += 1;
            }
        }
        gpu.device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("shade"), entries: &entries })
    }

    /// Binds the inputs of one frame; none where the key's pipeline is not there. Returns the buffer of the background
    /// as well, which resolving reads.
    ///
    /// # Errors
    /// Never for uniforms of a fixed size.
    pub fn bind(
        &mut self,
        gpu: &Gpu,
        key: &ShadeKey,
        inputs: &ShadeInputs<'_>,
    ) -> Result<Option<(wgpu::BindGroup, wgpu::Buffer)>, GpuError> {
        let Some(layout) = self.pipelines.get(key).map(|pipeline| pipeline.layout.clone()) else { return Ok(None) };
        self.bind_to(gpu, key, (&layout, usize::from(key.layers.is_some())), inputs)
    }

    /// The same for pipelines of others with this layout; the number says whose group is kept.
    ///
    /// # Errors
    /// As [`Shade::bind`].
    pub fn bind_to(
        &mut self,
        gpu: &Gpu,
        key: &ShadeKey,
        (layout, kept): (&wgpu::BindGroupLayout, usize),
        inputs: &ShadeInputs<'_>,
    ) -> Result<Option<(wgpu::BindGroup, wgpu::Buffer)>, GpuError> {
        let output = self.output.set(gpu, bytemuck::bytes_of(inputs.output), 0)?;
        let lights = self.lights.set(gpu, bytemuck::bytes_of(inputs.lights), 0)?;
        let mut bound = vec![
            (0, Bound::Buffer(lights)),
            (1, Bound::Buffer(output.clone())),
            (2, Bound::View(inputs.visibility.clone())),
        ];
        if let Some((maps, uniform)) = inputs.shadows {
            bound.push((3, Bound::Buffer(self.shadows.set(gpu, bytemuck::bytes_of(uniform), 0)?)));
            bound.push((4, Bound::View(maps.all().clone())));
        }
        let mut binding = FIRST_SHADER_BINDING;
        for shader in key.shaders.iter().map(|needs| &needs.shader) {
            let Some(materials) = inputs.materials.get(shader).and_then(KeptBuffer::get) else { return Ok(None) };
            bound.push((binding, Bound::Buffer(materials)));
            binding += 1;
            if SHADERS[*shader].tables_name().is_some() {
                let Some(tables) = inputs.tables.get(shader).and_then(KeptTexture::view) else { return Ok(None) };
                bound.push((binding, Bound::View(tables)));
                binding += 1;
            }
            for resource in self.resources.get(shader).into_iter().flatten() {
                let resource = match resource {
                    UploadedResource::Uniform(buffer) => Bound::Buffer(buffer.clone()),
                    UploadedResource::Texture(view) => Bound::View(view.clone()),
                };
                bound.push((binding, resource));
                binding += 1;
            }
        }
        Ok(Some((self.groups[kept].get(gpu, "shade", layout, bound), output)))
    }

    /// Shades the pixels of view `view_index` that see something. The first view clears the target to `clear`; where post
    /// effects follow, every view does.
    #[allow(clippy::too_many_arguments)]
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        key: &ShadeKey,
        scene: &SceneBindings,
        view_index: usize,
        inputs: &wgpu::BindGroup,
        to: &ShadeTarget<'_>,
        timer: &mut Option<PassTimer>,
    ) {
        let Some(pipeline) = self.pipelines.get(key) else { return };
        let first = view_index == 0 || key.geometry;
        let load = if first { wgpu::LoadOp::Clear(to.clear) } else { wgpu::LoadOp::Load };
        let attachment = |view, load| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })
        };
        let mut attachments = vec![attachment(to.light, load)];
        let nothing = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        attachments.extend(to.geometry.map(|geometry| attachment(geometry, nothing)));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shade"),
            color_attachments: &attachments,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: to.depth,
                depth_ops: None,
                stencil_ops: None,
            }),
            timestamp_writes: timer.as_mut().and_then(|timer| timer.pass("shade")),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&pipeline.pipeline);
        pass.set_bind_group(0, &scene.group, &[SceneBindings::offset(view_index)]);
        pass.set_bind_group(1, inputs, &[]);
        pass.draw(0..3, 0..1);
    }
}

impl Shade {
    /// What blending layers binds; none where no pipeline does.
    pub fn layers_layout(&self) -> Option<&wgpu::BindGroupLayout> {
        self.layers_layout.as_ref()
    }

    /// Blends the layers of some rows of the picture of view `view_index`. The groups are those of the scene, of the shading, and of
    /// the layers.
    #[allow(clippy::too_many_arguments)]
    pub fn draw_layers(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        key: &ShadeKey,
        [scene, inputs, layers]: [&wgpu::BindGroup; 3],
        view_index: usize,
        to: &LayerTargets<'_>,
        clears: bool,
        rows: std::ops::Range<u32>,
        timer: &mut Option<PassTimer>,
    ) {
        let Some(pipeline) = self.pipelines.get(key) else { return };
        let load = if clears { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })
        };
        let targets = to.to.into_iter().chain(to.to_geometry).filter(|_| !key.has_no_target());
        let attachments: Vec<_> = targets.map(attachment).collect();
        let depth = wgpu::RenderPassDepthStencilAttachment { view: to.depth, depth_ops: None, stencil_ops: None };
        let name = match key.layer_work {
            LayerWork::Blend => "layers_blended",
            LayerWork::Keep => "layers_kept",
            LayerWork::Mark { .. } => "layers_marked",
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(name),
            color_attachments: &attachments,
            depth_stencil_attachment: attachments.is_empty().then_some(depth),
            timestamp_writes: timer.as_mut().and_then(|timer| timer.pass(name)),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&pipeline.pipeline);
        pass.set_bind_group(0, scene, &[SceneBindings::offset(view_index)]);
        pass.set_bind_group(1, inputs, &[]);
        pass.set_bind_group(2, layers, &[]);
        let width = to.depth.texture().width();
        pass.set_scissor_rect(0, rows.start, width, rows.end - rows.start);
        pass.draw(0..3, 0..1);
    }
}

/// The WGSL of the shading pass for a key.
pub fn shade_module(key: &ShadeKey) -> Module {
    let mut module = Module::new(&[wgsl!("lib/fullscreen.wgsl")]);
    add_shading(&mut module, key);
    if let Some((finish, _)) = key.layers {
        let asks = key.asks_neighbours();
        module.add(wgsl!("lib/geometry.wgsl"));
        module.add_generated(
            "layers options",
            format!(
                "const FINISH: u32 = {}u;\nconst ASKS_NEIGHBOURS: bool = {asks};\nconst KEEPS_LIGHT: bool = {};\nconst WIDEST_PX: f32 = {:?};",
                finish.number(),
                key.layer_work.keeps_light(),
                f64::from(layers::HALO)
            ),
        );
        module.add(wgsl!("lib/finish.wgsl"));
        module.add(wgsl!("lib/layers.wgsl"));
        module.add(wgsl!("layers/lists.wgsl"));
        module.add(wgsl!("lib/layer_lists.wgsl"));
        let marks = matches!(key.layer_work, LayerWork::Mark { .. });
        if asks || marks {
            module.add(wgsl!("lib/marks.wgsl"));
        }
        if asks && !marks {
            module.add(wgsl!("lib/trace.wgsl"));
            module.add(wgsl!("layers/neighbours.wgsl"));
        } else if !marks {
            module.add(wgsl!("layers/neighbours_none.wgsl"));
        }
        module.add(match key.layer_work {
            LayerWork::Blend => wgsl!("layers/blend.wgsl"),
            LayerWork::Keep => wgsl!("layers/keep.wgsl"),
            LayerWork::Mark { .. } => wgsl!("layers/mark.wgsl"),
        });
    } else if key.geometry {
        module.add(wgsl!("lib/geometry.wgsl"));
        module.add(wgsl!("objects/shade_geometry.wgsl"));
    }
    module
}

/// Adds the WGSL that finds surfaces and shades them: `surface_at`, `shade_object` and `material_of`.
pub fn add_shading(module: &mut Module, key: &ShadeKey) {
    for file in [
        wgsl!("lib/view.wgsl"),
        wgsl!("lib/ids.wgsl"),
        wgsl!("lib/texels.wgsl"),
        wgsl!("lib/objects.wgsl"),
        wgsl!("lib/scene.wgsl"),
        wgsl!("lib/intersect.wgsl"),
        wgsl!("lib/surface.wgsl"),
        wgsl!("lib/lights.wgsl"),
        wgsl!("lib/encode.wgsl"),
    ] {
        module.add(file);
    }
    mesh::add_point(module, key.meshes);
    let shadow_files: &[Wgsl] = match (key.shadows, key.shadow_filter) {
        (false, _) => &[wgsl!("lib/shadow_none.wgsl")],
        (true, ShadowFilter::Objects) => &[wgsl!("lib/shadow_maps.wgsl"), wgsl!("lib/shadow.wgsl")],
        (true, _) => &[wgsl!("lib/shadow_maps.wgsl"), wgsl!("lib/shadow_depths.wgsl")],
    };
    shadow_files.iter().for_each(|file| module.add(*file));
    let mut bindings = format!(
        "const ORTHOGRAPHIC: bool = {};\nconst ENCODE: bool = {};\nconst ATOMS: bool = {};\nconst CONNECTORS: bool = {};\nconst MESHES: bool = {};\nconst HULLS: bool = {};\n\
         const CURVATURE: bool = {};\nconst SHADOWS: bool = {};\nconst LIGHT_COUNT: u32 = {}u;\nconst POINT_LIGHTS: bool = {};\nconst AMBIENT: bool = {};\n",
        key.orthographic,
        key.encode,
        key.atoms,
        key.connectors,
        key.meshes.is_some(),
        key.hulls,
        key.layers.is_some() && key.shaders.iter().any(|needs| SHADERS[needs.shader].stylises()),
        key.shadows,
        key.lights,
        key.point_lights,
        key.ambient
    );
    if key.shadows {
        bindings.push_str(
            "@group(1) @binding(3) var<uniform> shadows: Shadows;\n\
             @group(1) @binding(4) var shadow_maps: texture_2d_array<u32>;\n",
        );
        let filter = key.shadow_filter.number();
        bindings
            .push_str(&format!("const SOFT_TAPS: u32 = {}u;\nconst SHADOW_FILTER: u32 = {filter}u;\n", key.soft_taps));
    }
    let mut binding = FIRST_SHADER_BINDING;
    let num_lighting = key.shaders.iter().filter(|needs| !SHADERS[needs.shader].stylises()).count();
    let (mut cases, mut stylings) = (String::new(), String::new());
    for needs in &key.shaders {
        let shader: &dyn ObjectShader = SHADERS[needs.shader];
        for file in shader.wgsl() {
            module.add(*file);
        }
        for (bit, feature) in shader.features().iter().enumerate() {
            bindings.push_str(&format!("const {feature}: bool = {};\n", needs.features >> bit & 1 == 1));
        }
        let tables = shader.tables_name().map(|name| format!("var {name}: texture_2d<u32>;"));
        let declarations = std::iter::once(shading::material_declaration(shader))
            .chain(tables)
            .chain(shader.resources().iter().map(|resource| resource.declaration.to_owned()));
        for declaration in declarations {
            bindings.push_str(&format!("@group(1) @binding({binding}) {declaration}\n"));
            binding += 1;
        }
        let name = shader.name();
        if shader.stylises() {
            let _ = writeln!(
                stylings,
                "    if materials[material].stylist == {}u {{\n        \
                 let m = {name}_materials[materials[material].stylist_index];\n        \
                 return {name}_stylised(m, color, {name}_bend(s, m));\n    }}",
                needs.shader + 1
            );
            continue;
        }
        // A constant index is one load for all pixels, a varying one a load for each.
        let (material, params) = match needs.only_material {
            Some(material) => (format!("materials[{material}u]"), "0u".to_owned()),
            None => ("materials[material]".to_owned(), "materials[material].index".to_owned()),
        };
        let call =
            format!("return {name}_shade(with_base_color(s, {material}.base_color), {name}_materials[{params}]);");
        let condition = match needs.only_material {
            _ if num_lighting == 1 => "true".to_owned(),
            Some(material) => format!("material == {material}u"),
            None => format!("materials[material].shader == {}u", needs.shader),
        };
        cases.push_str(&format!("    if {condition} {{ {call} }}\n"));
    }
    bindings.push_str(&format!(
        "fn with_base_color(s: Surface, color: vec4<f32>) -> Surface {{\n    var colored = s;\n    \
         colored.base_color = mix(s.base_color, color.rgb, color.a);\n    return colored;\n}}\n\
         fn shade_object(s: Surface, material: u32) -> vec3<f32> {{\n{cases}    return s.base_color;\n}}\n"
    ));
    if key.layers.is_some() {
        bindings.push_str(&format!(
            "fn shade_layer(s: Surface, material: u32) -> vec4<f32> {{\n    \
             let color = shade_object(s, material);\n{stylings}    \
             return vec4<f32>(color, materials[material].opacity);\n}}\n"
        ));
    }
    bindings.push_str(&material_function(key));
    module.add_generated("shade bindings", bindings);
    module.add(wgsl!("objects/shade.wgsl"));
}

/// `curvature_scale`, what a material multiplies curvature by, and `stylised`, linear colour and opacity of a fragment of a material, with
/// `kappa` from -1 for convex to 1 for concave and `t` its depth along the view.
pub fn stylising_by_kappa(key: &ShadeKey) -> String {
    let (mut scales, mut stylings) = (String::new(), String::new());
    for needs in key.shaders.iter().filter(|needs| SHADERS[needs.shader].stylises()) {
        let (name, number) = (SHADERS[needs.shader].name(), needs.shader + 1);
        let m = format!("let m = {name}_materials[materials[material].stylist_index];");
        let _ = writeln!(scales, "    if materials[material].stylist == {number}u {{ {m} return m.gain; }}");
        let _ = writeln!(
            stylings,
            "    if materials[material].stylist == {number}u {{\n        {m}\n        \
             return {name}_stylised(m, color, Bend(kappa, {name}_depth(m, t), 0.0));\n    }}"
        );
    }
    format!(
        "fn curvature_scale(material: u32, otherwise: f32) -> f32 {{\n{scales}    return otherwise;\n}}\n\
         fn stylised(material: u32, color: vec3<f32>, kappa: f32, t: f32) -> vec4<f32> {{\n{stylings}    \
         return vec4<f32>(color, materials[material].opacity);\n}}\n"
    )
}

/// `material_of`: the material of an id, from memory only where it is not the same for all objects of a kind.
fn material_function(key: &ShadeKey) -> String {
    let index = "id & INDEX_MASK";
    let source =
        |constant: Option<u32>, lookup: &str| constant.map_or(lookup.to_owned(), |material| format!("{material}u"));
    // Kinds that are there, each with its ids and the source of its material.
    let kinds = [
        (key.atoms, "ATOM", source(key.atom_material, &format!("atom_at({index}).material"))),
        (key.connectors, "CONNECTOR", source(key.connector_material, &format!("connector_at({index}).material"))),
        (key.meshes.is_some(), "MESH", source(key.part_material, &format!("mesh_material({index})"))),
    ];
    let mut kinds: Vec<(&str, String)> =
        kinds.into_iter().filter(|(drawn, ..)| *drawn).map(|(_, kind, source)| (kind, source)).collect();
    let Some((_, last)) = kinds.pop() else {
        return "fn material_of(id: u32) -> u32 {\n    return 0u;\n}\n".to_owned();
    };
    let constants = [key.atom_material, key.connector_material, key.part_material];
    let is_constant = |source: &str| constants.iter().flatten().any(|material| format!("{material}u") == source);
    let mut body = String::new();
    if !(is_constant(&last) && kinds.iter().all(|(_, source)| *source == last)) {
        body.push_str(if kinds.is_empty() { "" } else { "    let kind = id >> 29u;\n" });
        for (kind, source) in kinds {
            let _ = writeln!(body, "    if kind == KIND_{kind} || kind == KIND_{kind}_HULL {{ return {source}; }}");
        }
    }
    let _ = writeln!(body, "    return {last};");
    format!("fn material_of(id: u32) -> u32 {{\n{body}}}\n")
}
