//! What a frame draws: atoms, connectors and materials as the GPU holds them.

use glam::Vec3;

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
    atom_centers: Vec<[f32; 3]>,
    connector_centers: Vec<[f32; 3]>,
}

impl ObjectBuffers {
    /// Uploads a draw list.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] beyond the largest storage binding.
    pub fn upload(gpu: &Gpu, list: &DrawList) -> Result<ObjectBuffers, GpuError> {
        let middle = |c: &Connector| ((Vec3::from(c.a_world) + Vec3::from(c.b_world)) * 0.5).to_array();
        Ok(ObjectBuffers {
            atoms: upload(gpu, "atoms", &list.atoms)?,
            connectors: upload(gpu, "connectors", &list.connectors)?,
            num_atoms: list.atoms.len() as u32,
            num_connectors: list.connectors.len() as u32,
            atom_centers: list.atoms.iter().map(|atom| atom.position_world).collect(),
            connector_centers: list.connectors.iter().map(middle).collect(),
        })
    }

    /// Orders of atoms and connectors, nearest first for `toward` (the direction of the view, world space).
    pub fn orders(&self, toward: Vec3) -> (Vec<u32>, Vec<u32>) {
        (order_by_depth(&self.atom_centers, toward), order_by_depth(&self.connector_centers, toward))
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

/// Depth is sorted into this many bins: fine enough for early rejection, and one pass whatever the count.
const DEPTH_BINS: usize = 2048;

/// Indices of `centers`, nearest first along `toward`, exact to one part in [`DEPTH_BINS`]; linear in their number.
fn order_by_depth(centers: &[[f32; 3]], toward: Vec3) -> Vec<u32> {
    let depths: Vec<f32> = centers.iter().map(|center| Vec3::from(*center).dot(toward)).collect();
    let (low, high) = depths.iter().fold((f32::MAX, f32::MIN), |(low, high), &depth| (low.min(depth), high.max(depth)));
    let scale = (DEPTH_BINS - 1) as f32 / (high - low).max(f32::MIN_POSITIVE);
    let bin = |depth: f32| (((depth - low) * scale) as usize).min(DEPTH_BINS - 1);
    let mut starts = vec![0u32; DEPTH_BINS + 1];
    for &depth in &depths {
        starts[bin(depth) + 1] += 1;
    }
    for index in 1..starts.len() {
        starts[index] += starts[index - 1];
    }
    let mut order = vec![0u32; centers.len()];
    for (index, &depth) in depths.iter().enumerate() {
        let slot = &mut starts[bin(depth)];
        order[*slot as usize] = index as u32;
        *slot += 1;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_is_a_permutation_and_nearest_first() {
        let centers: Vec<[f32; 3]> = (0..1000).map(|i| [0.0, 0.0, -((i * 7919 % 1000) as f32)]).collect();
        let order = order_by_depth(&centers, Vec3::NEG_Z);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &v)| i as u32 == v));
        let depths: Vec<f32> = order.iter().map(|&i| -centers[i as usize][2]).collect();
        assert!(depths.windows(2).all(|pair| pair[1] >= pair[0] - 1000.0 / DEPTH_BINS as f32));
    }

    #[test]
    fn equal_depths_are_all_kept() {
        assert_eq!(order_by_depth(&[[1.0, 2.0, 3.0]; 5], Vec3::Z), [0, 1, 2, 3, 4]);
        assert!(order_by_depth(&[], Vec3::Z).is_empty());
    }
}
