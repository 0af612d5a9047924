//! Object shaders: one file each, with its parameters, its GPU struct and the name of its WGSL; found through [`SHADERS`].
//!
//! To add one: `src/shading/NAME.rs`, `shaders/objects/NAME.wgsl` with `fn NAME_shade(s: Surface, m: NAMEMaterial) ->
//! vec3<f32>` (linear light), a twin in `tests/twins/NAME.rs`, and one line in [`SHADERS`]. One that stylises what another
//! lights has `NAME_bend` and `NAME_stylised` instead: see `shaders/objects/curvature.wgsl`.

pub mod basic;
pub mod brdf_table;
pub mod curvature;
pub mod environment;
pub mod toon;
pub mod unlit;

use glam::Vec3;

use crate::config::param::{BaseColor, Length, Param, Srgba, Values};
use crate::gpu::{Gpu, GpuError, StructInfo, Wgsl};
use crate::scene::Sphere;

/// What a material needs to know beside its own parameters.
#[derive(Clone, Copy)]
pub struct MaterialContext<'a> {
    /// 2 to the power of the camera's exposure in stops.
    pub exposure_factor: f32,
    /// The scene's sphere, in world space.
    pub bounds: Sphere,
    /// How strongly curvature is read unless a style says, over one curvature of that sphere.
    pub gain: f32,
    /// A length on the screen: pixels, and scene units, to be added.
    pub screen: &'a dyn Fn(Length) -> (f64, f64),
    /// The first texel of the material's tables.
    pub table: u32,
}

/// An outline by enlarged back faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hull {
    /// Linear RGB.
    pub color: Vec3,
    /// Width in the picture or the scene.
    pub width: Length,
}

/// What a shader binds beside its materials.
pub enum ResourceData {
    /// A uniform buffer with this content.
    Uniform(Vec<u8>),
    /// A texture of 32-bit float RGBA, with its size.
    Texture([u32; 2], Vec<u8>),
}

/// A binding of a shader: the WGSL declaration after the binding's number, and its content.
pub struct Resource {
    /// Such as `var<uniform> environment: Environment;`.
    pub declaration: &'static str,
    /// Makes the content.
    pub data: fn() -> ResourceData,
}

/// One way to shade objects.
pub trait ObjectShader: Sync {
    /// Its name in style files, and the stem of its files and of its WGSL function.
    fn name(&self) -> &'static str;
    /// One sentence for the manual.
    fn doc(&self) -> &'static str;
    /// Its parameters, [`BASE_COLOR`] among them.
    fn params(&self) -> &'static [Param];
    /// WGSL that its entry needs, its own file last.
    fn wgsl(&self) -> &'static [Wgsl];
    /// The WGSL struct of its materials.
    fn material_info(&self) -> StructInfo;
    /// The bytes of one material.
    fn material(&self, values: &Values, context: &MaterialContext<'_>) -> Vec<u8>;
    /// Names of the constants by which its WGSL leaves out what no material of a style uses.
    fn features(&self) -> &'static [&'static str] {
        &[]
    }
    /// Which of them a material uses, one bit each.
    fn features_used(&self, _values: &Values) -> u32 {
        0
    }
    /// Its outline by enlarged back faces, if it has one.
    fn hull(&self, _values: &Values) -> Option<Hull> {
        None
    }
    /// Bindings beside its materials.
    fn resources(&self) -> &'static [Resource] {
        &[]
    }
    /// The shader that lights its surfaces, for one that only stylises that light: it weighs it and says how much it covers.
    fn lit_by(&self, _values: &Values) -> Option<&'static str> {
        None
    }
    /// Whether it stylises what another one lights.
    fn stylises(&self) -> bool {
        false
    }
    /// Whether, with these features, it asks what lies beside a fragment in neighbouring pixels.
    fn asks_neighbours(&self, _features: u32) -> bool {
        false
    }
    /// Whether what it draws is blended in layers.
    fn is_layered(&self, values: &Values) -> bool {
        values.number(OPACITY.name) < 1.0
    }
    /// Tables of a material, four numbers a texel; materials with equal tables share them.
    fn tables(&self, _values: &Values) -> Vec<[f32; 4]> {
        Vec::new()
    }
    /// The texture that its WGSL finds tables in, if it has any.
    fn tables_name(&self) -> Option<&'static str> {
        None
    }
    /// The structs that its resources hold.
    fn resource_infos(&self) -> Vec<StructInfo> {
        Vec::new()
    }
}

/// All object shaders, in the order of their numbers on the GPU.
pub const SHADERS: &[&dyn ObjectShader] = &[&basic::Basic, &toon::Toon, &unlit::Unlit, &curvature::Curvature];

/// The shader of what nothing selects.
pub const DEFAULT_SHADER: &str = "basic";

/// Different materials in one frame: as many as fit a uniform buffer, which a software adapter reads far faster than
/// storage.
pub const MAX_MATERIALS: usize = 512;

/// Place in [`SHADERS`] of a name.
pub fn shader_index(name: &str) -> Option<usize> {
    SHADERS.iter().position(|shader| shader.name() == name)
}

/// `base_color`, which every object shader has.
pub const BASE_COLOR: Param = Param::base_color("base_color", BaseColor::Element)
    .doc("Colour of the object: element (CPK), chain, residue, part, material, or one colour.")
    .examples(&[r#""element""#, r##""#c0392b""##, r#""steelblue""#]);

/// `opacity`, which every object shader has.
pub const OPACITY: Param = Param::number("opacity", 1.0)
    .range(0.0, 1.0)
    .doc("1 is opaque, 0 invisible; between them what lies behind is seen through it. Of meshes all sides count, of atoms and bonds the near one.")
    .examples(&["0.2", "0.5"]);

/// Linear RGB of a colour.
pub fn linear(color: Srgba) -> Vec3 {
    let [r, g, b, _] = color.to_linear();
    Vec3::new(r, g, b)
}

/// Linear RGB and 1, or zeros where the parameter is unset.
pub fn optional_linear(color: Option<Srgba>) -> [f32; 4] {
    color.map_or([0.0; 4], |color| linear(color).extend(1.0).to_array())
}

/// The WGSL text that declares a shader's material array.
pub fn material_declaration(shader: &dyn ObjectShader) -> String {
    format!("var<uniform> {}_materials: array<{}, {MAX_MATERIALS}>;", shader.name(), shader.material_info().name)
}

/// Creates the texture or buffer of a resource.
///
/// # Errors
/// [`GpuError`] where it does not fit the device.
pub fn upload(gpu: &Gpu, resource: &Resource) -> Result<UploadedResource, GpuError> {
    match (resource.data)() {
        ResourceData::Uniform(bytes) => {
            let size = bytes.len().next_multiple_of(16);
            let buffer = gpu.buffer(resource.declaration, &bytes, size, wgpu::BufferUsages::UNIFORM);
            Ok(UploadedResource::Uniform(buffer))
        }
        ResourceData::Texture(size, bytes) => {
            let extent = wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 };
            let texture = gpu.texture(&wgpu::TextureDescriptor {
                label: Some(resource.declaration),
                size: extent,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba32Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            gpu.write_texture(
                texture.as_image_copy(),
                &bytes,
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size[0] * 16), rows_per_image: None },
                extent,
            );
            Ok(UploadedResource::Texture(texture.create_view(&Default::default())))
        }
    }
}

/// A resource on the GPU.
pub enum UploadedResource {
    /// A uniform buffer.
    Uniform(wgpu::Buffer),
    /// A texture of 32-bit floats, not filtered.
    Texture(wgpu::TextureView),
}
