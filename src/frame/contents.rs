//! What a style makes of a scene, on the device: objects and materials, each written only where it changed.

use std::collections::BTreeMap;

use super::mesh::MeshForm;
use super::objects::{self, Connector, DrawList, Material, ObjectBuffers};
use super::occlusion::Reach;
use super::shade::{LayerWork, ShadeKey, ShaderNeeds};
use super::shadow::ShadowFilter;
use super::texels::KeptTexture;
use super::visibility::DrawnKinds;
use crate::gpu::{Gpu, GpuError, KeptBuffer};
use crate::shading::{MAX_MATERIALS, SHADERS};

/// Materials of a style: what all share, and each shader's parameter sets.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Materials {
    /// One for each material.
    pub common: Vec<Material>,
    /// Bytes of the parameter sets, by the shader's place in the registry.
    pub params: BTreeMap<usize, Vec<u8>>,
    /// Features that the materials of each shader use, one bit each.
    pub features: BTreeMap<usize, u32>,
    /// Tables of each shader one after another, four numbers a texel.
    pub tables: BTreeMap<usize, Vec<[f32; 4]>>,
}

impl Materials {
    fn has_hulls(&self) -> bool {
        let Reach { px, world } = self.reach();
        px + world > 0.0
    }

    /// Whether anything is transparent; what is invisible as well is left out with it.
    fn has_layers(&self) -> bool {
        self.common.iter().any(|material| material.opacity < 1.0)
    }

    /// The widest hull outline.
    fn reach(&self) -> Reach {
        self.common.iter().fold(Reach::default(), |reach, material| Reach {
            px: reach.px.max(material.hull_px),
            world: reach.world.max(material.hull_world),
        })
    }

    /// Refuses more materials than a frame holds.
    fn check(&self) -> Result<(), GpuError> {
        let count = self.common.len();
        if count > MAX_MATERIALS {
            let bytes = |count: usize| (count * size_of::<Material>()) as u64;
            return Err(GpuError::TooMany {
                what: "materials",
                count,
                bytes: bytes(count),
                limit: bytes(MAX_MATERIALS),
            });
        }
        Ok(())
    }
}

/// What pipelines need to know of the objects.
#[derive(Debug, Clone, Copy, Default)]
struct ObjectNeeds {
    kinds: DrawnKinds,
    /// What is known of the meshes that are drawn.
    mesh_form: Option<MeshForm>,
    /// The one material of all atoms, where there is only one.
    atom_material: Option<u32>,
    /// The same of connectors.
    connector_material: Option<u32>,
    /// The same of parts.
    part_material: Option<u32>,
}

impl ObjectNeeds {
    fn new(list: &DrawList) -> ObjectNeeds {
        fn common(mut materials: impl Iterator<Item = u32>) -> Option<u32> {
            let first = materials.next()?;
            materials.all(|material| material == first).then_some(first)
        }
        ObjectNeeds {
            kinds: DrawnKinds {
                atoms: !list.atoms.is_empty(),
                connectors: !list.connectors.is_empty(),
                meshes: list.drawn_parts().next().is_some(),
            },
            mesh_form: list
                .meshes
                .as_ref()
                .filter(|_| list.drawn_parts().next().is_some())
                .map(|scene| MeshForm::new(&scene.assembly, list.drawn_parts())),
            atom_material: common(list.atoms.iter().map(|atom| atom.material)),
            connector_material: common(list.connectors.iter().map(Connector::material)),
            part_material: common(list.drawn_parts().map(|part| part.material())),
        }
    }
}

/// What the pipelines of a frame need to know of objects and materials.
#[derive(Debug, Clone)]
pub struct Needs {
    /// Which kinds of objects there are.
    pub kinds: DrawnKinds,
    /// Whether anything is transparent.
    pub layered: bool,
    /// Materials of the style.
    pub num_materials: usize,
    /// What shading reads; lights and output are filled in for each frame.
    pub key: ShadeKey,
}

impl Needs {
    fn new(objects: &ObjectNeeds, materials: &Materials) -> Needs {
        let shaders = materials.params.keys().map(|&shader| ShaderNeeds {
            shader,
            features: materials.features.get(&shader).copied().unwrap_or(0),
            only_material: {
                let uses =
                    |material: &Material| material.shader as usize == shader || material.stylist as usize == shader + 1;
                let mut using = (0..).zip(&materials.common).filter(|(_, material)| uses(material));
                match (using.next(), using.next()) {
                    (Some((material, _)), None) => Some(material),
                    _ => None,
                }
            },
        });
        let key = ShadeKey {
            shaders: shaders.collect(),
            atoms: objects.kinds.atoms,
            connectors: objects.kinds.connectors,
            meshes: objects.mesh_form,
            atom_material: objects.atom_material,
            connector_material: objects.connector_material,
            part_material: objects.part_material,
            hulls: materials.has_hulls(),
            lights: 0,
            point_lights: false,
            ambient: false,
            shadows: false,
            soft_taps: 0,
            shadow_filter: ShadowFilter::default(),
            orthographic: false,
            encode: false,
            geometry: false,
            layers: None,
            layer_work: LayerWork::default(),
        };
        Needs { kinds: objects.kinds, key, layered: materials.has_layers(), num_materials: materials.common.len() }
    }
}

/// Objects and materials on the device.
pub struct Contents {
    /// The objects.
    pub objects: ObjectBuffers,
    object_needs: ObjectNeeds,
    materials: Materials,
    common: KeptBuffer,
    /// The parameter sets of each shader, by its place in the registry.
    pub params: BTreeMap<usize, KeptBuffer>,
    /// The tables of each shader that has any.
    pub tables: BTreeMap<usize, KeptTexture>,
}

impl Default for Contents {
    fn default() -> Contents {
        Contents {
            objects: ObjectBuffers::default(),
            object_needs: ObjectNeeds::default(),
            materials: Materials::default(),
            common: KeptBuffer::uniform("materials"),
            params: BTreeMap::new(),
            tables: BTreeMap::new(),
        }
    }
}

impl Contents {
    /// What pipelines would need, were these put in; `list` is none where the objects stay.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] where the device cannot hold them.
    pub fn needs_of(&self, gpu: &Gpu, list: Option<&DrawList>, materials: &Materials) -> Result<Needs, GpuError> {
        materials.check()?;
        if let Some(list) = list {
            objects::check(gpu, list)?;
        }
        Ok(Needs::new(&list.map_or(self.object_needs, ObjectNeeds::new), materials))
    }

    /// Replaces materials and, where `list` is given, objects. On an error all stays as it was.
    ///
    /// # Errors
    /// As [`Contents::needs_of`].
    pub fn set(&mut self, gpu: &Gpu, list: Option<&DrawList>, materials: Materials) -> Result<(), GpuError> {
        self.needs_of(gpu, list, &materials)?;
        if let Some(list) = list {
            self.objects.set(gpu, list)?;
            self.object_needs = ObjectNeeds::new(list);
        }
        self.common.set(gpu, bytemuck::cast_slice(&materials.common), MAX_MATERIALS * size_of::<Material>())?;
        for (&shader, bytes) in &materials.params {
            let buffer = self.params.entry(shader).or_insert_with(|| KeptBuffer::uniform("parameters"));
            buffer.set(gpu, bytes, MAX_MATERIALS * SHADERS[shader].material_info().size)?;
        }
        for (&shader, texels) in &materials.tables {
            let texture = self.tables.entry(shader).or_insert_with(|| KeptTexture::new("tables"));
            texture.set(gpu, bytemuck::cast_slice(texels));
        }
        self.materials = materials;
        Ok(())
    }

    /// What the pipelines of its frames need.
    pub fn needs(&self) -> Needs {
        Needs::new(&self.object_needs, &self.materials)
    }

    /// What all shaders' materials share; none before the first content.
    pub fn common(&self) -> Option<wgpu::Buffer> {
        self.common.get()
    }

    /// What outlines add to the objects.
    pub fn reach(&self) -> Reach {
        self.materials.reach()
    }
}
