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
        /// Its group, 16 bits: see [`crate::effects::outline::group_word`].
        pub group: u32,
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
        /// Linear RGB of the half at `a`, as half floats, and above them the group of the atom there.
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

/// The same with a group of 16 bits in the half float that is left.
pub fn pack_linear_and_group(color: Vec3, group: u32) -> [u32; 2] {
    let [rg, b] = pack_linear(color);
    [rg, b | group << 16]
}

/// Everything that a style draws of a scene.
#[derive(Debug, Clone, Default)]
pub struct DrawList {
    /// The spheres.
    pub atoms: Vec<Atom>,
    /// The cylinders.
    pub connectors: Vec<Connector>,
}

/// The draw list on the device, and the balls by which its drawing order is found.
pub struct ObjectBuffers {
    atoms: KeptTexture,
    connectors: KeptTexture,
    /// How many atoms.
    pub num_atoms: u32,
    /// How many connectors.
    pub num_connectors: u32,
    /// Spheres around the atoms.
    pub atom_balls: Vec<Ball>,
    /// Spheres around the connectors.
    pub connector_balls: Vec<Ball>,
    /// Another number for each content.
    pub generation: u64,
}

impl Default for ObjectBuffers {
    fn default() -> ObjectBuffers {
        ObjectBuffers {
            atoms: KeptTexture::new("atoms"),
            connectors: KeptTexture::new("connectors"),
            num_atoms: 0,
            num_connectors: 0,
            atom_balls: Vec::new(),
            connector_balls: Vec::new(),
            generation: 0,
        }
    }
}

impl ObjectBuffers {
    /// Replaces the content; rows of it that stay the same are not written. On an error the former content stays.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] beyond the largest texture.
    pub fn set(&mut self, gpu: &Gpu, list: &DrawList) -> Result<(), GpuError> {
        check(gpu, list)?;
        let atom_ball = |atom: &Atom| Ball { center: Vec3::from(atom.position_world), radius: atom.radius };
        let connector_ball = |connector: &Connector| {
            let (a, b) = (Vec3::from(connector.a_world), Vec3::from(connector.b_world));
            Ball { center: (a + b) * 0.5, radius: 0.5 * a.distance(b) + connector.radius }
        };
        self.atoms.set(gpu, bytemuck::cast_slice(&list.atoms));
        self.connectors.set(gpu, bytemuck::cast_slice(&list.connectors));
        self.num_atoms = list.atoms.len() as u32;
        self.num_connectors = list.connectors.len() as u32;
        self.atom_balls = list.atoms.iter().map(atom_ball).collect();
        self.connector_balls = list.connectors.iter().map(connector_ball).collect();
        self.generation += 1;
        Ok(())
    }

    /// Atoms and connectors to bind; none before the first content.
    pub fn views(&self) -> Option<[wgpu::TextureView; 2]> {
        Some([self.atoms.view()?, self.connectors.view()?])
    }
}

/// Refuses a draw list that does not fit the device.
///
/// # Errors
/// [`GpuError::TooMany`] beyond the largest texture.
pub fn check(gpu: &Gpu, list: &DrawList) -> Result<(), GpuError> {
    let limit = u64::from(gpu.device.limits().max_texture_dimension_2d) * ROW_BYTES as u64;
    for (what, count, bytes) in [
        ("atoms", list.atoms.len(), size_of_val(&list.atoms[..])),
        ("connectors", list.connectors.len(), size_of_val(&list.connectors[..])),
    ] {
        if bytes as u64 > limit {
            return Err(GpuError::TooMany { what, count, bytes: bytes as u64, limit });
        }
    }
    Ok(())
}

/// Texels in a row of the object textures; `OBJECT_ROW` in `shaders/lib/objects.wgsl`.
const OBJECT_ROW: u32 = 2048;

/// A texel holds four 32-bit words.
const TEXEL_BYTES: usize = 16;

/// Bytes in a row.
const ROW_BYTES: usize = OBJECT_ROW as usize * TEXEL_BYTES;

/// Objects in a texture, one texel for each 16 bytes, and a hash of each row, so that a row that stays is not written.
struct KeptTexture {
    label: &'static str,
    texture: Option<(wgpu::Texture, wgpu::TextureView)>,
    row_hashes: Vec<u64>,
}

impl KeptTexture {
    fn new(label: &'static str) -> KeptTexture {
        KeptTexture { label, texture: None, row_hashes: Vec::new() }
    }

    fn view(&self) -> Option<wgpu::TextureView> {
        self.texture.as_ref().map(|(_, view)| view.clone())
    }

    fn set(&mut self, gpu: &Gpu, bytes: &[u8]) {
        let rows = bytes.len().div_ceil(ROW_BYTES).max(1) as u32;
        let hashes: Vec<u64> = bytes.chunks(ROW_BYTES).map(hash).collect();
        // A texture that grew for a large scene is given back once a small one would fit it four times.
        let fits = |texture: &wgpu::Texture| (rows..=4 * rows).contains(&texture.height());
        if !self.texture.as_ref().is_some_and(|(texture, _)| fits(texture)) {
            let texture = gpu.texture(&wgpu::TextureDescriptor {
                label: Some(self.label),
                size: wgpu::Extent3d { width: OBJECT_ROW, height: rows, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba32Uint,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let view = texture.create_view(&Default::default());
            self.texture = Some((texture, view));
            self.row_hashes.clear();
        }
        let Some((texture, _)) = &self.texture else { return };
        let changed = |row: usize| self.row_hashes.get(row) != hashes.get(row);
        let mut row = 0;
        while row < hashes.len() {
            // Whole rows that changed go in one write, a row that is not full by itself.
            let is_full = |row: usize| (row + 1) * ROW_BYTES <= bytes.len();
            let mut end = row;
            while end < hashes.len() && changed(end) && is_full(end) {
                end += 1;
            }
            if end > row {
                write_rows(gpu, texture, row, OBJECT_ROW, &bytes[row * ROW_BYTES..end * ROW_BYTES]);
            } else if changed(row) {
                let rest = &bytes[row * ROW_BYTES..];
                write_rows(gpu, texture, row, (rest.len() / TEXEL_BYTES) as u32, rest);
            }
            row = end.max(row + 1);
        }
        self.row_hashes = hashes;
    }
}

fn write_rows(gpu: &Gpu, texture: &wgpu::Texture, row: usize, width: u32, bytes: &[u8]) {
    let origin = wgpu::Origin3d { x: 0, y: row as u32, z: 0 };
    let to = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(ROW_BYTES as u32), rows_per_image: None };
    let height = bytes.len().div_ceil(ROW_BYTES) as u32;
    gpu.write_texture(to, bytes, layout, wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
}

fn hash(row: &[u8]) -> u64 {
    use std::hash::Hasher;
    let mut hasher = std::hash::DefaultHasher::new();
    hasher.write(row);
    hasher.finish()
}
