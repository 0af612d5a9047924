//! A mesh as an importer read it, before it is mended.

use glam::{DAffine3, DVec3, Vec3};

use super::MeshMaterial;

/// Everything that one mesh file holds, in its own coordinates.
#[derive(Debug, Clone, Default)]
pub struct RawMesh {
    /// The shapes; each may be placed any number of times.
    pub shapes: Vec<RawShape>,
    /// Where the shapes are, in the order of the file.
    pub parts: Vec<RawPart>,
    /// The materials that parts name by index.
    pub materials: Vec<MeshMaterial>,
}

/// Triangles of one shape. Positions that occur twice are welded later, and nothing needs to be sound.
#[derive(Debug, Clone, Default)]
pub struct RawShape {
    /// Vertices; may hold anything but NaN and infinity, which importers leave out with the triangles that use them.
    pub positions: Vec<DVec3>,
    /// Indices into `positions`, counter-clockwise as seen from outside where the file is right.
    pub triangles: Vec<[u32; 3]>,
    /// The file's normals, if it has any.
    pub normals: RawNormals,
    /// sRGB of each vertex, 0 to 255; empty where the file has no colours.
    pub colors: Vec<[u8; 3]>,
}

/// Normals as files have them; they need not be unit vectors.
#[derive(Debug, Clone, Default)]
pub enum RawNormals {
    /// None: they are found by crease angle.
    #[default]
    None,
    /// One for each position.
    PerVertex(Vec<Vec3>),
    /// A list, and three indices into it for each triangle.
    PerCorner {
        /// The normals.
        normals: Vec<Vec3>,
        /// For each triangle.
        corners: Vec<[u32; 3]>,
    },
}

/// One shape at one place.
#[derive(Debug, Clone, PartialEq)]
pub struct RawPart {
    /// Index into [`RawMesh::shapes`].
    pub shape: u32,
    /// Index into [`RawMesh::materials`], if the file gives it one.
    pub material: Option<u32>,
    /// What the file calls it: the node, object, group or solid; empty where it has no name.
    pub name: String,
    /// Names of the nodes above it and its own, joined by `/`; the name alone in files without a tree.
    pub path: String,
    /// From the shape's coordinates to those of the file; may mirror.
    pub file_from_shape: DAffine3,
}
