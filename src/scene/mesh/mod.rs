//! Meshes as the renderer needs them: shapes of triangles, and the parts that place them.
//!
//! ```text
//! import/{obj, stl, ply, off, gltf, threemf}  ->  RawMesh  ->  build  ->  Assembly
//!     build: for each shape  place  ->  mend { weld -> links -> winding -> vertices { hull } }
//! ```
//! Importers give [`RawMesh`]: positions in f64, triangles, what the file names. [`Assembly::build`] mends it and moves it
//! near the origin, where single precision is fine enough.

mod assembly;
mod build;
#[cfg(test)]
mod build_tests;
pub mod curvature;
mod hull;
mod links;
mod mend;
mod place;
mod raw;
#[cfg(test)]
mod solids;
mod triangulate;
mod vertices;
mod weld;
mod winding;

pub use assembly::{Assembly, MeshMaterial, Part, Shape, pack_hull, pack_normal, unpack_hull, unpack_normal};
pub use raw::{RawMesh, RawNormals, RawPart, RawShape};
pub use triangulate::Triangulator;
