//! What a frame draws: atoms, connectors and materials as the GPU holds them.

use glam::Vec3;

use super::occlusion::Ball;
use crate::gpu::{Gpu, GpuError};
use crate::gpu_struct;

gpu_struct! {
    "lib/objects.wgsl",
    /// A sphere.
    pub struct Atom {
        /// Centre in world space.
        pub position_world: [f32; 3],
        /// Radius in scene units.
        pub radius: f32,
        /// Linear RGB as half floats.
        pub color: [u32; 2],
        /// Index into the materials.
        pub material: u32,
        /// Padding.
        pub _pad0: u32,
    }
}

gpu_struct! {
    "lib/objects.wgsl",
    /// A cylinder between two atoms, coloured half by half.
    pub struct Connector {
        /// One end in world space.
        pub a_world: [f32; 3],
        /// Radius in scene units.
        pub radius: f32,
        /// The other end.
        pub b_world: [f32; 3],
        /// Index into the materials.
        pub material: u32,
        /// Linear RGB of the half at `a`, as half floats.
        pub color_a: [u32; 2],
        /// The same at `b`.
        pub color_b: [u32; 2],
    }
}

gpu_struct! {
    "lib/objects.wgsl",
    /// What all shaders' materials share.
    pub struct Material {
        /// Linear RGB; alpha 1 where it replaces the object's own colour.
        pub base_color: [f32; 4],
        /// Linear RGB of the hull outline.
        pub hull_color: [f32; 4],
        /// Width of the hull outline in pixels.
        pub hull_px: f32,
        /// Width of the hull outline in scene units, added.
        pub hull_world: f32,
        /// The object shader's place in the registry.
        pub shader: u32,
        /// Which of that shader's parameter sets.
        pub index: u32,
    }
}

/// Linear RGB packed as half floats, as `unpack_linear` reads it.
pub fn pack_linear(color: Vec3) -> [u32; 2] {
    let [r, g, b] = color.to_array().map(|channel| u32::from(half::f16::from_f32(channel).to_bits()));
    [r | g << 16, b]
}

/// Everything that a style draws of a scene.
#[derive(Debug, Clone, Default)]
pub struct DrawList {
    /// The spheres.
    pub atoms: Vec<Atom>,
    /// The cylinders.
    pub connectors: Vec<Connector>,
}

/// The draw list in buffers, and the orders to draw it in.
pub struct ObjectBuffers {
    /// All atoms.
    pub atoms: wgpu::TextureView,
    /// All connectors.
    pub connectors: wgpu::TextureView,
    /// How many atoms.
    pub num_atoms: u32,
    /// How many connectors.
    pub num_connectors: u32,
    /// Spheres around the atoms.
    pub atom_balls: Vec<Ball>,
    /// Spheres around the connectors.
    pub connector_balls: Vec<Ball>,
}

impl ObjectBuffers {
    /// Uploads a draw list.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] beyond the largest storage binding.
    pub fn upload(gpu: &Gpu, list: &DrawList) -> Result<ObjectBuffers, GpuError> {
        let atom_ball = |atom: &Atom| Ball { center: Vec3::from(atom.position_world), radius: atom.radius };
        let connector_ball = |connector: &Connector| {
            let (a, b) = (Vec3::from(connector.a_world), Vec3::from(connector.b_world));
            Ball { center: (a + b) * 0.5, radius: 0.5 * a.distance(b) + connector.radius }
        };
        Ok(ObjectBuffers {
            atoms: upload(gpu, "atoms", &list.atoms)?,
            connectors: upload(gpu, "connectors", &list.connectors)?,
            num_atoms: list.atoms.len() as u32,
            num_connectors: list.connectors.len() as u32,
            atom_balls: list.atoms.iter().map(atom_ball).collect(),
            connector_balls: list.connectors.iter().map(connector_ball).collect(),
        })
    }
}

/// Texels in a row of the object textures; `OBJECT_ROW` in `shaders/lib/objects.wgsl`.
const OBJECT_ROW: u32 = 2048;

/// Puts objects into a texture, one texel of four 32-bit words for each 16 bytes.
fn upload<T: bytemuck::Pod>(gpu: &Gpu, what: &'static str, items: &[T]) -> Result<wgpu::TextureView, GpuError> {
    let row_bytes = OBJECT_ROW as usize * 16;
    let bytes: &[u8] = bytemuck::cast_slice(items);
    let rows = bytes.len().div_ceil(row_bytes).max(1);
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if rows > limit as usize {
        let limit = u64::from(limit) * row_bytes as u64;
        return Err(GpuError::TooMany { what, count: items.len(), bytes: bytes.len() as u64, limit });
    }
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some(what),
        size: wgpu::Extent3d { width: OBJECT_ROW, height: rows as u32, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    // Whole rows first, then what is left of the last one.
    let whole = bytes.len() / row_bytes;
    let write = |row: u32, width: u32, height: u32, bytes: &[u8]| {
        if width > 0 && height > 0 {
            let to =
                wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y: row, z: 0 }, ..texture.as_image_copy() };
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row_bytes as u32), rows_per_image: None };
            let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
            gpu.queue.write_texture(to, bytes, layout, size);
        }
    };
    let (full, rest) = bytes.split_at(whole * row_bytes);
    write(0, OBJECT_ROW, whole as u32, full);
    write(whole as u32, (rest.len() / 16) as u32, 1, rest);
    Ok(texture.create_view(&Default::default()))
}
