//! What a `.model` entry holds, before its objects are placed.

use std::collections::HashMap;

use glam::{DAffine3, DVec3};

/// One `.model` entry. Lengths of objects are in millimetres already.
#[derive(Default)]
pub(super) struct Model {
    /// By id.
    pub(super) objects: HashMap<u32, Object>,
    /// What is to be built.
    pub(super) items: Vec<Placement>,
    /// Materials and colours, by id.
    pub(super) groups: HashMap<u32, Group>,
}

/// A mesh, or an assembly of other objects.
#[derive(Default)]
pub(super) struct Object {
    pub(super) name: String,
    pub(super) part_number: String,
    /// Group and entry of triangles that say nothing else.
    pub(super) property: Option<(u32, u32)>,
    pub(super) mesh: Mesh,
    pub(super) components: Vec<Placement>,
}

/// Triangles of an object.
#[derive(Default)]
pub(super) struct Mesh {
    /// In millimetres; NaN where the file has no number.
    pub(super) positions: Vec<DVec3>,
    /// Indices into `positions`, not yet checked.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Of each triangle; as short as the last one that has any.
    pub(super) properties: Vec<Option<Property>>,
}

/// Group and entries of a triangle's corners.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) group: u32,
    pub(super) corners: [u32; 3],
}

/// An object at a place.
#[derive(Clone)]
pub(super) struct Placement {
    pub(super) object: u32,
    /// Another entry that has the object.
    pub(super) path: Option<String>,
    pub(super) part_number: String,
    /// In millimetres.
    pub(super) parent_from_object: DAffine3,
}

/// Entries that properties number.
pub(super) enum Group {
    /// Their first index in the mesh's materials, and how many there are.
    Materials { first: u32, count: u32 },
    /// sRGB.
    Colors(Vec<[u8; 3]>),
}
