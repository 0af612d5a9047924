//! Scenes: what a style is applied to. No GPU and no styles in here.
//!
//! [`Scene::load`] reads a file of molecules or meshes, mends what it can, and says in the [`Report`] of each of
//! [`Scene::files`] what it mended, guessed or skipped. What it cannot mend is a [`SceneError`] with file, line and a way
//! out. [`Scene::join`] puts the scenes of several files into one.
//!
//! ```text
//! import/{sniff, pdb, cif/, sdf, ...}  ->  builder  ->  { altloc, bonds -> { templates, grid }, sphere }  ->  molecule
//! import/...  ->  mesh/raw  ->  mesh/build  ->  mesh/assembly
//! ```
//! A new format is one file or folder in `import/` that feeds a [`MoleculeBuilder`] or a [`RawMesh`], and a line in `import/mod.rs`.

mod altloc;
mod aov;
mod bond_table;
mod bond_templates;
mod bonds;
#[cfg(test)]
mod bonds_tests;
mod builder;
mod camera;
mod element;
mod element_table;
mod error;
mod grid;
pub mod guess;
mod image;
mod image_read;
pub mod import;
mod join;
mod light;
pub mod mesh;
mod molecule;
mod name;
mod report;
mod sphere;
mod srgb;

pub use aov::{AovImage, AovName};
pub use bonds::FileBond;
pub use builder::{MoleculeBuilder, NewAtom, NewCopy};
pub use camera::Camera;
pub use element::{Element, ElementInfo};
pub use error::SceneError;
pub use image::{Image, Pixels, RowsHeader, write_png_rows, write_whole};
pub use image_read::{ImageError, MAX_SIDE_PX};
pub use import::{Format, LoadOptions, ModelChoice};
pub use light::{Light, LightPlace, Lighting, Shadow};
pub use mesh::{Assembly, MeshMaterial, Part, RawMesh, Shape, unpack_hull, unpack_normal};
pub use molecule::{Atom, Bond, Chain, Molecule, MoleculeCopy, Residue, ResidueKind, Sphere};
pub use name::Name;
pub use report::{Note, NoteKind, Report};
pub use sphere::bounding_sphere;
pub use srgb::{linear_from_srgb, srgb_from_linear};

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The largest file that is read, in MiB: 20 times the largest entry that the PDB keeps in its old format.
const MAX_FILE_MIB: u64 = 2048;

/// What files hold, ready to be drawn: a molecule, meshes, or both. Never empty.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The atoms of all files.
    pub molecule: Molecule,
    /// The meshes of all files.
    pub assembly: Assembly,
    /// The files, in the order in which they were given.
    pub files: Vec<SceneFile>,
    /// The first file's name without folder and extension.
    pub name: String,
    /// File units in one scene unit: 1, but a power of two for meshes so large or small that single precision would fail.
    pub unit: f64,
    sphere: Sphere,
}

/// One of the files of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFile {
    /// Its name without folder, as selectors know it.
    pub name: String,
    /// What it was read as.
    pub format: Format,
    /// What was mended, guessed or skipped in it.
    pub report: Report,
    /// Files beside it that it names and that were read, such as materials.
    pub side_files: Vec<PathBuf>,
}

impl Scene {
    /// Reads a file: its first model, alternate locations with the highest occupancy.
    ///
    /// # Errors
    /// Every [`SceneError`] but `NoSuchModel`.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::load_with(path, &LoadOptions::default())
    }

    /// Reads a file as the options say.
    ///
    /// # Errors
    /// Every [`SceneError`].
    pub fn load_with(path: &Path, options: &LoadOptions) -> Result<Self, SceneError> {
        let bytes = read(path)?;
        import::read(&path.to_string_lossy(), &bytes, options, Some(path.parent().unwrap_or(Path::new(""))))
    }

    /// Reads a file that is already in memory; `name` is its path, for messages and where the content does not tell the format.
    ///
    /// # Errors
    /// `Empty`, `NoAtoms`, `Malformed`, `Unsupported`.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, SceneError> {
        Self::from_bytes_with(name, bytes, &LoadOptions::default())
    }

    /// Reads a file that is already in memory, as the options say.
    ///
    /// # Errors
    /// `Empty`, `NoAtoms`, `Malformed`, `Unsupported`, `NoSuchModel`.
    pub fn from_bytes_with(name: &str, bytes: &[u8], options: &LoadOptions) -> Result<Self, SceneError> {
        import::read(name, bytes, options, None)
    }
}

impl Scene {
    /// A sphere around all that is loaded, hidden or not: atoms with their van der Waals radii, and vertices.
    pub const fn bounding_sphere(&self) -> Sphere {
        self.sphere
    }
}

/// The bytes of a file, never more than [`MAX_FILE_MIB`] whatever the file system says of its size.
fn read(path: &Path) -> Result<Vec<u8>, SceneError> {
    let fail = |error| SceneError::from_io(path, error);
    let file = File::open(path).map_err(fail)?;
    let metadata = file.metadata().map_err(fail)?;
    let too_large = || SceneError::TooLarge { file: path.display().to_string(), limit_mib: MAX_FILE_MIB };
    let limit = MAX_FILE_MIB << 20;
    if metadata.is_dir() {
        return Err(SceneError::IsDirectory { file: path.display().to_string() });
    }
    if metadata.len() > limit {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    file.take(limit + 1).read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > limit { Err(too_large()) } else { Ok(bytes) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_file_and_a_folder_are_named_as_such() {
        assert!(matches!(Scene::load(Path::new("/no/such/file.pdb")), Err(SceneError::NotFound { .. })));
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        assert!(matches!(Scene::load(folder), Err(SceneError::IsDirectory { .. })));
    }

    #[test]
    fn messages_name_the_file_and_a_way_out() {
        let message = Scene::load(Path::new("/no/such/file.pdb")).expect_err("missing").to_string();
        assert!(message.starts_with("/no/such/file.pdb: no such file; "), "{message}");
    }
}
