//! Importers: bytes of a file to a molecule or a mesh. One file per format.

mod assembly;
mod bcif;
mod cif;
mod compact;
mod conect;
mod faces;
mod gltf;
mod kekule;
mod lines;
mod models;
mod mol2;
mod number;
mod obj;
mod off;
mod pdb;
mod ply;
mod pqr;
mod sdf;
mod sdf_v3000;
mod side_file;
mod sniff;
mod stl;
mod table;
mod threemf;
mod tree_path;
mod vertex;
mod xyz;

pub use models::ModelChoice;
pub use sniff::{Format, sniff};

use super::Scene;
use super::error::SceneError;
use super::mesh::{Assembly, RawMesh};
use super::molecule::Molecule;
use super::report::{NoteKind, Report};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// What to read of a file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LoadOptions {
    /// Which models or frames.
    pub model: ModelChoice,
    /// Which biological assembly, by its id in the file; the deposited coordinates where there is none.
    pub assembly: Option<String>,
}

/// What importers share: the file's name for messages, the options, the notes.
struct Import<'a> {
    file: &'a str,
    options: &'a LoadOptions,
    report: Report,
    /// Where side files may lie; none where nothing but the file itself is read.
    folder: Option<&'a Path>,
    /// Side files that were read.
    side_files: Vec<PathBuf>,
}

impl Import<'_> {
    /// The error of a line that nothing can be made of; `what` says the way out after a semicolon.
    fn malformed(&self, line: u32, what: String) -> SceneError {
        SceneError::Malformed { file: self.file.to_string(), line, what }
    }

    /// The same for a file without lines; `byte` counts from 0.
    fn malformed_at(&self, byte: usize, what: String) -> SceneError {
        SceneError::MalformedAt { file: self.file.to_string(), byte: byte as u64, what }
    }

    /// The position of three coordinates; `None`, with a note, if one is no number.
    ///
    /// # Errors
    /// `Malformed` if one is a number that no picture can hold.
    fn position(&mut self, line: u32, fields: [&[u8]; 3]) -> Result<Option<DVec3>, SceneError> {
        let mut position = DVec3::ZERO;
        for (axis, field) in fields.into_iter().enumerate() {
            let name = ["x", "y", "z"][axis];
            match number::float(field) {
                Some(value) if value.is_finite() && value.abs() <= number::ABSURD => position[axis] = value,
                Some(value) if value.is_finite() => {
                    let what = format!(
                        "{name} = {} is no position in angstrom; correct it or delete the line",
                        lines::quote(field)
                    );
                    return Err(self.malformed(line, what));
                }
                _ => {
                    self.report.note(NoteKind::BadCoordinate, line, || format!("{name} = {}", lines::quote(field)));
                    return Ok(None);
                }
            }
        }
        Ok(Some(position))
    }
}

/// Reads a file of any format that is known; `folder` is where the files that it names may lie.
pub(super) fn read(
    file: &str,
    bytes: &[u8],
    options: &LoadOptions,
    folder: Option<&Path>,
) -> Result<Scene, SceneError> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if text.trim_ascii().is_empty() {
        return Err(SceneError::Empty { file: file.to_string() });
    }
    let unsupported = |what: String| Err(SceneError::Unsupported { file: file.to_string(), what });
    let mut import = Import { file, options, report: Report::default(), folder, side_files: Vec::new() };
    let format = sniff(file, bytes);
    let content = match format {
        Format::Pdb => pdb::read(&mut import, bytes).map(Content::Molecule)?,
        Format::Cif => cif::read(&mut import, bytes).map(Content::Molecule)?,
        Format::BinaryCif => bcif::read(&mut import, bytes).map(Content::Molecule)?,
        Format::Xyz => xyz::read(&mut import, bytes).map(Content::Molecule)?,
        Format::Obj => obj::read(&mut import, bytes).map(Content::Mesh)?,
        Format::Off => off::read(&mut import, bytes).map(Content::Mesh)?,
        Format::Ply => ply::read(&mut import, bytes).map(Content::Mesh)?,
        Format::Stl => stl::read(&mut import, bytes).map(Content::Mesh)?,
        Format::Gltf => gltf::read(&mut import, bytes).map(Content::Mesh)?,
        Format::ThreeMf => threemf::read(&mut import, bytes).map(Content::Mesh)?,
        Format::Sdf => sdf::read(&mut import, bytes).map(Content::Molecule)?,
        Format::Mol2 => mol2::read(&mut import, bytes).map(Content::Molecule)?,
        Format::Pqr => pqr::read(&mut import, bytes).map(Content::Molecule)?,
        Format::Foreign(what) => {
            return unsupported(format!("is {what}, no molecule and no mesh; {}", way_out(what)));
        }
        Format::Unknown => {
            return unsupported(
                "is in no format that is known here; save a molecule as mmCIF, PDB, SDF or XYZ, a mesh as glTF, OBJ, STL or \
                 PLY, with that extension"
                    .to_string(),
            );
        }
    };
    let Import { mut report, side_files, .. } = import;
    // Importers whose formats have assemblies have placed copies or refused by now.
    let has_assemblies = matches!(format, Format::Pdb | Format::Cif | Format::BinaryCif);
    if let Some(assembly) = options.assembly.as_ref().filter(|_| !has_assemblies) {
        report.note(NoteKind::NoAssemblies, None, || lines::quote(assembly.as_bytes()));
    }
    if let (Content::Mesh(_), ModelChoice::Number(model)) = (&content, options.model) {
        report.note(NoteKind::NoModels, None, || model.to_string());
    }
    let (molecule, assembly) = match content {
        Content::Molecule(molecule) => (molecule, Assembly::default()),
        Content::Mesh(raw) => {
            let assembly = Assembly::build(raw, 0, &mut report);
            let assembly = assembly.ok_or_else(|| no_triangles(file, &report))?;
            (Molecule::default(), assembly)
        }
    };
    Ok(Scene::of_file(file, format, molecule, assembly, report, side_files))
}

/// The error of a mesh of which nothing is left.
fn no_triangles(file: &str, report: &Report) -> SceneError {
    let file = file.to_string();
    match report.count(NoteKind::FlatTriangle) {
        0 => SceneError::NoTriangles { file },
        _ => {
            let what = "holds only triangles without area; export the model again, in smaller units".to_owned();
            SceneError::Damaged { file, what }
        }
    }
}

/// What a file holds.
enum Content {
    Molecule(Molecule),
    Mesh(RawMesh),
}

/// What helps with a file of another format.
fn way_out(what: &str) -> &'static str {
    if what.contains("archive") {
        "unpack it first"
    } else if what.contains("LFS") {
        "fetch it with: git lfs pull"
    } else if what.contains("web page") {
        "download the file itself rather than the page about it"
    } else if what.contains("UTF-16") {
        "save it as UTF-8"
    } else {
        "molecules are read as mmCIF, PDB, SDF, MOL2, PQR and XYZ, meshes as glTF, OBJ, STL, PLY, OFF and 3MF"
    }
}
