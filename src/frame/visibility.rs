//! The visibility pass: which object each pixel sees, by exact ray casts in tight quads.
//!
//! Writes an id (32 bits) and a depth (32-bit float) and nothing else; shading comes once per pixel, later. The same
//! pass draws what a light sees, into shadow maps.

use std::collections::BTreeMap;

use super::layers;
use super::mesh::MeshDraw;
use super::objects::ObjectBuffers;
use super::occlusion::{self, Reach};
use super::view::View;
use crate::gpu::{Bound, Gpu, GpuError, KeptBindGroup, KeptBuffer, Module, PassTimer};
use crate::wgsl;

/// Ids: kind in the upper 3 bits, index below.
pub const ID_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
/// Shadow maps: an id, and the depth along the light's view as the bits of a float.
pub const LIGHT_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;
/// Reversed depth, 1 nearest.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Bytes between two views in the view buffer: WebGPU's alignment of dynamic offsets.
const VIEW_STRIDE: u64 = 256;

/// What a visibility pipeline is built for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct VisibilityKey {
    /// Whether outlines by enlarged back faces are drawn.
    pub hulls: bool,
    /// Whether the view is orthographic.
    pub orthographic: bool,
    /// Whether it is a light that looks, into a shadow map.
    pub light: bool,
    /// Which objects are drawn, and what becomes of their fragments.
    pub drawn: Drawn,
}

/// What a visibility pass is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Drawn {
    /// The nearest surface of all objects.
    All,
    /// The nearest surface of what is opaque.
    Opaque,
    /// All surfaces of what is not, counted.
    CountedLayers,
    /// The same, written down.
    WrittenLayers,
}

impl Drawn {
    /// Whether it is for layers.
    pub fn is_layers(self) -> bool {
        matches!(self, Drawn::CountedLayers | Drawn::WrittenLayers)
    }

    /// What its WGSL needs to know.
    fn constants(self) -> String {
        let name = match self {
            Drawn::All => "ALL",
            Drawn::Opaque => "OPAQUE",
            _ => "LAYERS",
        };
        format!("const DRAWN: u32 = DRAWN_{name};\nconst WRITES: bool = {};\n", self == Drawn::WrittenLayers)
    }
}

/// Which kinds of objects are drawn at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DrawnKinds {
    /// Whether there are atoms.
    pub atoms: bool,
    /// Whether there are connectors.
    pub connectors: bool,
    /// Whether there are triangles of meshes.
    pub meshes: bool,
}

/// What a pipeline draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Atoms.
    Atom,
    /// Connectors.
    Connector,
    /// Triangles.
    Mesh,
    /// Outlines around triangles; of mirrored parts, or of others.
    Shell {
        /// Of mirrored parts.
        mirrored: bool,
    },
}

/// Pipelines of the visibility pass. Builds only what is drawn.
pub struct Visibility {
    /// Group 0 of every pass that reads the scene: view, objects, materials, orders.
    pub layout: wgpu::BindGroupLayout,
    /// Group 1 of the passes that count and write layers.
    pub layers_layout: wgpu::BindGroupLayout,
    /// Whether the device numbers the triangles of a draw.
    numbered: bool,
    pipelines: BTreeMap<(Kind, VisibilityKey), wgpu::RenderPipeline>,
}

/// One use of the pass.
pub struct VisibilityPass<'a> {
    /// Its name in timings.
    pub name: &'static str,
    /// Which of the bound views sees.
    pub view: usize,
    /// How it is drawn.
    pub key: VisibilityKey,
    /// Where ids go.
    pub ids: &'a wgpu::TextureView,
    /// Where depths go.
    pub depth: &'a wgpu::TextureView,
    /// The view that sees: of its picture only its tile is drawn.
    pub seen: &'a View,
}

/// Group 0 as one pass binds it.
pub struct SceneBindings {
    /// To bind at group 0 with a [`SceneBindings::offset`].
    pub group: wgpu::BindGroup,
    /// Atoms and connectors that are drawn; the others are hidden.
    pub num_drawn: [u32; 2],
}

/// What one eye, the camera's or a light's, sees by, kept from frame to frame: its views, and the order of the objects.
pub struct Eye {
    views: KeptBuffer,
    atom_order: KeptBuffer,
    connector_order: KeptBuffer,
    group: KeptBindGroup,
    /// The view, objects and outlines that the orders are for.
    ordered_for: Option<(Vec<u8>, u64, Reach, bool)>,
    num_drawn: [u32; 2],
}

impl Default for Eye {
    fn default() -> Eye {
        Eye {
            views: KeptBuffer::uniform("views"),
            atom_order: KeptBuffer::storage("atom order"),
            connector_order: KeptBuffer::storage("connector order"),
            group: KeptBindGroup::default(),
            ordered_for: None,
            num_drawn: [0; 2],
        }
    }
}

impl SceneBindings {
    /// Dynamic offset of view `index`.
    pub fn offset(index: usize) -> u32 {
        index as u32 * VIEW_STRIDE as u32
    }
}

impl Visibility {
    /// The bind group layout; pipelines come when they are drawn with.
    pub fn new(gpu: &Gpu) -> Visibility {
        let storage = |binding, visibility| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        // What is asked of layers between passes is asked in compute passes.
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
        let objects = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: both,
            ty: super::fullscreen::texture(wgpu::TextureSampleType::Uint),
            count: None,
        };
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("scene"),
            entries: &[
                wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: both,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: true,
                        min_binding_size: None,
                    },
                    count: None,
                },
                objects(1),
                objects(2),
                wgpu::BindGroupLayoutEntry {
                    binding: 3,
                    visibility: both,
                    ty: super::fullscreen::UNIFORM,
                    count: None,
                },
                storage(4, wgpu::ShaderStages::VERTEX),
                storage(5, wgpu::ShaderStages::VERTEX),
                objects(6),
                objects(7),
                objects(8),
                objects(9),
                objects(10),
            ],
        });
        let layers_layout = layers::raster_layout(gpu);
        Visibility { layout, layers_layout, numbered: gpu.numbers_triangles(), pipelines: BTreeMap::new() }
    }

    /// Binds objects, materials and the views of one eye; `reach` is what outlines add to the objects there, and
    /// beside it whether all materials are opaque. The order
    /// of the objects is found again only where the first view, the objects or the outlines are others.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] where the orders exceed a binding.
    pub fn bind(
        &self,
        gpu: &Gpu,
        eye: &mut Eye,
        objects: &ObjectBuffers,
        materials: &wgpu::Buffer,
        views: &[View],
        (reach, all_opaque): (Reach, bool),
    ) -> Result<Option<SceneBindings>, GpuError> {
        let Some([atoms, connectors, meshes @ ..]) = objects.views() else { return Ok(None) };
        let mut bytes = vec![0u8; views.len() * VIEW_STRIDE as usize];
        for (slot, view) in bytes.chunks_exact_mut(VIEW_STRIDE as usize).zip(views) {
            slot[..size_of::<View>()].copy_from_slice(bytemuck::bytes_of(view));
        }
        let view_buffer = eye.views.set(gpu, &bytes, VIEW_STRIDE as usize)?;
        // What is seen through hides nothing.
        let cull = all_opaque && gpu.info.device_type == wgpu::DeviceType::Cpu;
        let order_key = (bytemuck::bytes_of(&views[0]).to_vec(), objects.generation, reach, cull);
        if eye.ordered_for.as_ref() != Some(&order_key) {
            eye.ordered_for = None;
            let (atom_order, connector_order) =
                occlusion::orders(&views[0], &objects.atom_balls, &objects.connector_balls, reach, cull);
            eye.atom_order.set(gpu, bytemuck::cast_slice(&atom_order), 4)?;
            eye.connector_order.set(gpu, bytemuck::cast_slice(&connector_order), 4)?;
            eye.num_drawn = [atom_order.len() as u32, connector_order.len() as u32];
            eye.ordered_for = Some(order_key);
        }
        let (Some(atom_order), Some(connector_order)) = (eye.atom_order.get(), eye.connector_order.get()) else {
            return Ok(None);
        };
        let mut bound = vec![
            (0, Bound::Slice(view_buffer, size_of::<View>() as u64)),
            (1, Bound::View(atoms)),
            (2, Bound::View(connectors)),
            (3, Bound::Buffer(materials.clone())),
            (4, Bound::Buffer(atom_order)),
            (5, Bound::Buffer(connector_order)),
        ];
        bound.extend((6..).zip(meshes).map(|(binding, view)| (binding, Bound::View(view))));
        let group = eye.group.get(gpu, "scene", &self.layout, bound);
        Ok(Some(SceneBindings { group, num_drawn: eye.num_drawn }))
    }

    /// Builds the pipelines that atoms and connectors need, unless they are there.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    pub fn prepare(&mut self, gpu: &Gpu, kinds: DrawnKinds, key: VisibilityKey) -> Result<(), GpuError> {
        let shells = kinds.meshes && key.hulls;
        for (kind, drawn) in [
            (Kind::Atom, kinds.atoms),
            (Kind::Connector, kinds.connectors),
            (Kind::Mesh, kinds.meshes),
            (Kind::Shell { mirrored: false }, shells),
            (Kind::Shell { mirrored: true }, shells),
        ] {
            if drawn && !self.pipelines.contains_key(&(kind, key)) {
                let pipeline = self.build(gpu, kind, key)?;
                self.pipelines.insert((kind, key), pipeline);
            }
        }
        Ok(())
    }

    /// Builds the pipelines that are there anew, from the shaders as they are now.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    pub fn rebuilt(&self, gpu: &Gpu) -> Result<Visibility, GpuError> {
        let mut fresh = Visibility {
            layout: self.layout.clone(),
            layers_layout: self.layers_layout.clone(),
            numbered: self.numbered,
            pipelines: BTreeMap::new(),
        };
        for &(kind, key) in self.pipelines.keys() {
            let pipeline = fresh.build(gpu, kind, key)?;
            fresh.pipelines.insert((kind, key), pipeline);
        }
        Ok(fresh)
    }

    fn build(&self, gpu: &Gpu, kind: Kind, key: VisibilityKey) -> Result<wgpu::RenderPipeline, GpuError> {
        let numbered = gpu.numbers_triangles();
        let module = match kind {
            Kind::Atom => visibility_module(true, key),
            Kind::Connector => visibility_module(false, key),
            Kind::Mesh => mesh_module(key, false, numbered),
            Kind::Shell { .. } => mesh_module(key, true, numbered),
        };
        let layers = key.drawn.is_layers().then_some(&self.layers_layout);
        let groups: Vec<_> = [&self.layout].into_iter().chain(layers).map(Some).collect();
        let target = if key.light { LIGHT_FORMAT } else { ID_FORMAT };
        let target = (!key.drawn.is_layers()).then_some(target);
        object_pipeline(gpu, &module, kind, &groups, target)
    }

    /// Draws all objects, as the pass's view of the bindings sees them.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        bindings: &SceneBindings,
        objects: &ObjectBuffers,
        to: &VisibilityPass<'_>,
        timer: &mut Option<PassTimer>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(to.name),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: to.ids,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: to.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            timestamp_writes: timer.as_mut().and_then(|timer| timer.pass(to.name)),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        self.draw_objects(&mut pass, bindings, objects, to, &|kind| self.pipelines.get(&(kind, to.key)));
    }

    /// Counts or writes the layers of all objects within some rows of the picture, in front of what is opaque.
    #[allow(clippy::too_many_arguments)]
    pub fn draw_layers(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        bindings: &SceneBindings,
        objects: &ObjectBuffers,
        to: &VisibilityPass<'_>,
        layers: &wgpu::BindGroup,
        rows: std::ops::Range<u32>,
        timer: &mut Option<PassTimer>,
    ) {
        let pipeline = |kind| self.pipelines.get(&(kind, to.key));
        self.draw_fragments(encoder, bindings, objects, to, &[(1, layers)], rows, &pipeline, timer);
    }

    /// Draws the fragments of all objects within some rows of the picture to no target, by pipelines and with groups of others.
    #[allow(clippy::too_many_arguments)]
    pub fn draw_fragments<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        bindings: &SceneBindings,
        objects: &ObjectBuffers,
        to: &VisibilityPass<'_>,
        groups: &[(u32, &wgpu::BindGroup)],
        rows: std::ops::Range<u32>,
        pipeline: &dyn Fn(Kind) -> Option<&'a wgpu::RenderPipeline>,
        timer: &mut Option<PassTimer>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(to.name),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: to.depth,
                depth_ops: None,
                stencil_ops: None,
            }),
            timestamp_writes: timer.as_mut().and_then(|timer| timer.pass(to.name)),
            occlusion_query_set: None,
            multiview_mask: None,
        });
        for &(index, group) in groups {
            pass.set_bind_group(index, group, &[]);
        }
        pass.set_scissor_rect(0, rows.start, to.seen.tile_size_px[0] as u32, rows.end - rows.start);
        self.draw_objects(&mut pass, bindings, objects, to, pipeline);
    }

    fn draw_objects<'a>(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        bindings: &SceneBindings,
        objects: &ObjectBuffers,
        to: &VisibilityPass<'_>,
        pipeline: &dyn Fn(Kind) -> Option<&'a wgpu::RenderPipeline>,
    ) {
        pass.set_bind_group(0, &bindings.group, &[SceneBindings::offset(to.view)]);
        // The viewport is that of the whole picture, so that triangles fall on the same pixels in every tile.
        let ([x, y], [width, height]) = (to.seen.tile_origin_px, to.seen.size_px);
        if to.seen.tile_size_px != to.seen.size_px {
            pass.set_viewport(-x, -y, width, height, 0.0, 1.0);
        }
        for (kind, count) in [Kind::Atom, Kind::Connector].into_iter().zip(bindings.num_drawn) {
            if count > 0
                && let Some(pipeline) = pipeline(kind)
            {
                pass.set_pipeline(pipeline);
                pass.draw(0..4, 0..count);
            }
        }
        let Some((draws, indices)) = objects.meshes.draws() else { return };
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        let mut draw_all = |kind: Kind, is_drawn: &dyn Fn(&MeshDraw) -> bool| {
            let Some(pipeline) = pipeline(kind) else { return };
            pass.set_pipeline(pipeline);
            for draw in draws.iter().filter(|draw| is_drawn(draw)) {
                if self.numbered {
                    pass.draw_indexed(draw.indices.clone(), 0, draw.runs.clone());
                } else {
                    // Vertices are fetched by their number in the run.
                    pass.draw(0..draw.indices.end - draw.indices.start, draw.runs.clone());
                }
            }
        };
        draw_all(Kind::Mesh, &|_| true);
        if to.key.hulls {
            for mirrored in [false, true] {
                draw_all(Kind::Shell { mirrored }, &|draw| draw.mirrored == mirrored);
            }
        }
    }
}

/// A pipeline that draws objects of one kind: nearest surfaces to a target, or without one all fragments of what is transparent.
///
/// # Errors
/// [`GpuError::Driver`] where the shader does not compile.
pub fn object_pipeline(
    gpu: &Gpu,
    module: &Module,
    kind: Kind,
    groups: &[Option<&wgpu::BindGroupLayout>],
    target: Option<wgpu::TextureFormat>,
) -> Result<wgpu::RenderPipeline, GpuError> {
    let module = module.compile(gpu, "visibility")?;
    let (vertex, fragment) = match kind {
        Kind::Atom => ("atom_vertex", ["atom_fragment", "atom_layers"]),
        Kind::Connector => ("connector_vertex", ["connector_fragment", "connector_layers"]),
        Kind::Mesh | Kind::Shell { .. } => ("mesh_vertex", ["mesh_fragment", "mesh_layers"]),
    };
    let is_layers = target.is_none();
    let impostor = wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() };
    let primitive = match kind {
        Kind::Atom | Kind::Connector => impostor,
        // Meshes may be open: both sides are drawn.
        Kind::Mesh => wgpu::PrimitiveState::default(),
        Kind::Shell { mirrored } => wgpu::PrimitiveState {
            front_face: if mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
            cull_mode: Some(wgpu::Face::Front),
            ..Default::default()
        },
    };
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("visibility"),
        bind_group_layouts: groups,
        immediate_size: 0,
    });
    let targets: Vec<_> = target.into_iter().map(|format| Some(format.into())).collect();
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("visibility"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive,
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(!is_layers),
            // Layers test depths themselves: what they write does not wait for the test.
            depth_compare: Some(match is_layers {
                true => wgpu::CompareFunction::Always,
                false => wgpu::CompareFunction::Greater,
            }),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment[usize::from(is_layers)]),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The WGSL of the triangles' visibility, or of the shell that is their outline. `numbered`: the device numbers the
/// triangles of a draw.
pub fn mesh_module(key: VisibilityKey, shell: bool, numbered: bool) -> Module {
    let mut module = Module::default();
    add_extensions(&mut module, numbered);
    module.add_generated("view options", format!("const ORTHOGRAPHIC: bool = {};", key.orthographic));
    add_triangles(&mut module, key, shell, numbered);
    if key.drawn.is_layers() {
        module.add(wgsl!("lib/layers.wgsl"));
        module.add(wgsl!("layers/store.wgsl"));
        add_triangle_layers(&mut module, numbered);
    }
    module
}

/// What comes first in a module of triangles.
pub fn add_extensions(module: &mut Module, numbered: bool) {
    if numbered {
        module.add_generated("extensions", "enable primitive_index;".to_owned());
    }
}

/// What WGSL says of a triangle's number: a parameter of its entry, and its index.
fn triangle_words(numbered: bool) -> (&'static str, &'static str) {
    match numbered {
        true => (", @builtin(primitive_index) triangle: u32", "in.id + triangle"),
        false => ("", "in.id"),
    }
}

/// Adds the WGSL that draws triangles.
pub fn add_triangles(module: &mut Module, key: VisibilityKey, shell: bool, numbered: bool) {
    for file in [
        wgsl!("lib/view.wgsl"),
        wgsl!("lib/ids.wgsl"),
        wgsl!("lib/texels.wgsl"),
        wgsl!("lib/objects.wgsl"),
        wgsl!("lib/scene.wgsl"),
        wgsl!("lib/mesh.wgsl"),
        wgsl!("lib/drawn.wgsl"),
        if key.light { wgsl!("lib/seen_light_mesh.wgsl") } else { wgsl!("lib/seen_camera_mesh.wgsl") },
        wgsl!("objects/mesh.wgsl"),
    ] {
        module.add(file);
    }
    let (parameter, index) = triangle_words(numbered);
    module.add_generated(
        "mesh options",
        format!(
            "{}const SHELL: bool = {shell};\nconst NUMBERED: bool = {numbered};\n\
             @fragment\nfn mesh_fragment(in: MeshVarying{parameter}) -> VisibilityOut {{\n    \
             return mesh_out(in.position, {index});\n}}",
            key.drawn.constants(),
        ),
    );
}

/// Adds the entry that gives the fragments of triangles to `add_layer`.
pub fn add_triangle_layers(module: &mut Module, numbered: bool) {
    let (parameter, index) = triangle_words(numbered);
    let text = format!(
        "@fragment\nfn mesh_layers(in: MeshVarying{parameter}) {{\n    \
         add_layer(in.position.xy, make_id(KIND_MESH, {index}), mesh_depth(in.position));\n}}"
    );
    module.add_generated("mesh layers", text);
}

/// The WGSL of the atoms' or connectors' visibility.
pub fn visibility_module(atoms: bool, key: VisibilityKey) -> Module {
    let mut module = Module::default();
    module.add_generated("view options", format!("const ORTHOGRAPHIC: bool = {};", key.orthographic));
    add_impostors(&mut module, atoms, key);
    if key.drawn.is_layers() {
        module.add(wgsl!("lib/layers.wgsl"));
        module.add(wgsl!("layers/store.wgsl"));
        add_impostor_layers(&mut module, atoms);
    }
    module
}

/// Adds the WGSL that draws atoms or connectors.
pub fn add_impostors(module: &mut Module, atoms: bool, key: VisibilityKey) {
    for file in [
        wgsl!("lib/view.wgsl"),
        wgsl!("lib/ids.wgsl"),
        wgsl!("lib/texels.wgsl"),
        wgsl!("lib/objects.wgsl"),
        wgsl!("lib/scene.wgsl"),
        wgsl!("lib/intersect.wgsl"),
        wgsl!("lib/hull.wgsl"),
        wgsl!("lib/billboard.wgsl"),
        wgsl!("lib/drawn.wgsl"),
        if key.light { wgsl!("lib/seen_light.wgsl") } else { wgsl!("lib/seen_camera.wgsl") },
        if atoms { wgsl!("objects/atom.wgsl") } else { wgsl!("objects/connector.wgsl") },
    ] {
        module.add(file);
    }
    let constants = key.drawn.constants();
    module.add_generated("visibility options", format!("{constants}const HULL: bool = {};", key.hulls));
}

/// Adds the entry that gives the fragments of atoms or connectors to `add_layer`.
pub fn add_impostor_layers(module: &mut Module, atoms: bool) {
    module.add(if atoms { wgsl!("layers/atom.wgsl") } else { wgsl!("layers/connector.wgsl") });
}
