//! Geometry AOVs: depth, view-space normal, id and curvature of the nearest surface at each pixel's centre.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::fullscreen;
use super::mesh::{self, MeshForm};
use super::visibility::{SceneBindings, Visibility};
use crate::gpu::{Gpu, GpuError, Module};
use crate::wgsl;

/// RGB: view-space normal. A: depth, -1 where nothing is.
pub const GEOMETRY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Sum of the principal curvatures.
pub const CURVATURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// The pipeline of the geometry AOVs, once it is asked for.
#[derive(Default)]
pub struct Aov {
    pipelines: BTreeMap<(bool, bool), (wgpu::BindGroupLayout, wgpu::RenderPipeline)>,
}

impl Aov {
    /// Draws geometry and curvature of what `ids` holds, as the first bound view sees it. Builds the pipeline first, where it is
    /// not there.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where the shader does not compile.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        visibility: &Visibility,
        scene: &SceneBindings,
        from: &GeometrySource<'_>,
        [geometry, curvature]: [&wgpu::TextureView; 2],
    ) -> Result<(), GpuError> {
        let (layout, pipeline) = match self.pipelines.entry((from.orthographic, from.meshes)) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => {
                let layout = fullscreen::layout(gpu, "aov", &[fullscreen::texture(wgpu::TextureSampleType::Uint)]);
                let pipeline = fullscreen::pipeline(
                    gpu,
                    "aov",
                    &aov_module(from.orthographic, from.meshes),
                    "aov_fragment",
                    &[&visibility.layout, &layout],
                    &[GEOMETRY_FORMAT.into(), CURVATURE_FORMAT.into()],
                )?;
                entry.insert((layout, pipeline))
            }
        };
        let ids = wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(from.ids) };
        let group = gpu.bind_group("aov", layout, &[ids]);
        let groups: &[(&wgpu::BindGroup, &[u32])] = &[(&scene.group, &[SceneBindings::offset(0)]), (&group, &[])];
        let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        fullscreen::draw_onto(encoder, "aov", pipeline, groups, &[(geometry, clear), (curvature, clear)], None);
        Ok(())
    }
}

/// What the geometry is found from.
pub struct GeometrySource<'a> {
    /// Ids of the visibility pass.
    pub ids: &'a wgpu::TextureView,
    /// Whether its view is orthographic.
    pub orthographic: bool,
    /// Whether there are triangles of meshes.
    pub meshes: bool,
}

/// The WGSL of the geometry AOVs.
pub fn aov_module(orthographic: bool, meshes: bool) -> Module {
    let mut module = Module::new(&[
        wgsl!("lib/view.wgsl"),
        wgsl!("lib/ids.wgsl"),
        wgsl!("lib/texels.wgsl"),
        wgsl!("lib/objects.wgsl"),
        wgsl!("lib/intersect.wgsl"),
        wgsl!("lib/surface.wgsl"),
    ]);
    mesh::add_point(&mut module, meshes.then_some(MeshForm::ANY));
    module.add_generated(
        "aov options",
        format!(
            "const ORTHOGRAPHIC: bool = {orthographic};\nconst ATOMS: bool = true;\nconst CONNECTORS: bool = true;\nconst MESHES: bool = {meshes};\nconst CURVATURE: bool = true;"
        ),
    );
    module.add(wgsl!("lib/fullscreen.wgsl"));
    module.add(wgsl!("objects/aov.wgsl"));
    module
}
