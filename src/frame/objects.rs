//! What a frame draws: atoms, connectors and materials as the GPU holds them.

use glam::Vec3;

use std::sync::Arc;

use super::mesh::{MeshBuffers, MeshPart};
use super::occlusion::Ball;
use super::texels::{KeptTexture, ROW_BYTES};
use crate::gpu::{Gpu, GpuError};
use crate::gpu_struct;
use crate::scene::Scene;

/// Where bits begin that say which selectors of post effects pick an object, and how many there are at the most.
pub const PICKS_SHIFT: u32 = 17;
/// See [`PICKS_SHIFT`].
pub const MOST_PICKS: usize = (u32::BITS - PICKS_SHIFT) as usize;

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
        /// Its group, 16 bits: see [`crate::effects::outline::group_word`]; above it which selectors pick it.
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
        /// Index into the materials, and in the upper half which selectors pick it.
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
        pub hull_color: [f32; 3],
        /// Share of what is behind that it covers: below 1 it is drawn in layers.
        pub opacity: f32,
        /// Width of the hull outline in pixels.
        pub hull_px: f32,
        /// Width of the hull outline in scene units, added.
        pub hull_world: f32,
        /// The object shader's place in the registry.
        pub shader: u32,
        /// Which of that shader's parameter sets.
        pub index: u32,
        /// The shader that stylises its light, by one more than its place in the registry; 0 for none.
        pub stylist: u32,
        /// Which of that shader's parameter sets.
        pub stylist_index: u32,
        /// Padding.
        pub _pad0: u32,
        /// Padding.
        pub _pad1: u32,
    }
}

impl Atom {
    /// Its group.
    pub fn group(&self) -> u32 {
        self.group & 0xffff
    }

    /// A bit for each selector that picks it.
    pub fn picks(&self) -> u32 {
        self.group >> PICKS_SHIFT
    }
}

impl Connector {
    /// Index into the materials.
    pub fn material(&self) -> u32 {
        self.material & 0xffff
    }

    /// A bit for each selector that picks it.
    pub fn picks(&self) -> u32 {
        self.material >> PICKS_SHIFT
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
    /// The scene of the meshes, where it has any.
    pub meshes: Option<Arc<Scene>>,
    /// An entry for each part of that scene, none where it is hidden.
    pub parts: Vec<Option<MeshPart>>,
    /// Whether the curvature of shapes is asked for.
    pub bent: bool,
}

impl DrawList {
    /// The parts that are drawn.
    pub fn drawn_parts(&self) -> impl Iterator<Item = &MeshPart> {
        self.parts.iter().flatten()
    }
}

/// The draw list on the device, and the balls by which its drawing order is found.
pub struct ObjectBuffers {
    atoms: KeptTexture,
    connectors: KeptTexture,
    /// The meshes.
    pub meshes: MeshBuffers,
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
            meshes: MeshBuffers::default(),
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
        match &list.meshes {
            Some(scene) => self.meshes.set(gpu, scene, &list.parts, list.bent)?,
            None => self.meshes.clear(),
        }
        self.atoms.set(gpu, bytemuck::cast_slice(&list.atoms));
        self.connectors.set(gpu, bytemuck::cast_slice(&list.connectors));
        self.num_atoms = list.atoms.len() as u32;
        self.num_connectors = list.connectors.len() as u32;
        self.atom_balls = list.atoms.iter().map(atom_ball).collect();
        self.connector_balls = list.connectors.iter().map(connector_ball).collect();
        self.generation += 1;
        Ok(())
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.atoms.bytes() + self.connectors.bytes() + self.meshes.bytes()
    }

    /// Atoms, connectors and the five of meshes to bind; none before the first content.
    pub fn views(&self) -> Option<[wgpu::TextureView; 7]> {
        let (atoms, connectors) = (self.atoms.view()?, self.connectors.view()?);
        // Without meshes nothing reads theirs.
        let [vertices, triangles, parts, runs, pages] =
            self.meshes.views().unwrap_or_else(|| std::array::from_fn(|_| atoms.clone()));
        Some([atoms, connectors, vertices, triangles, parts, runs, pages])
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
    list.meshes.as_ref().map_or(Ok(()), |scene| super::mesh::check(gpu, scene, &list.parts))
}
