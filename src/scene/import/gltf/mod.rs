//! glTF 2.0, as `.gltf` and `.glb` [Gltf2, throughout].
//!
//! Every pair of mesh and primitive that is placed is one shape, read once; every node that has it is a part. Read: triangles,
//! strips and fans, sparse and quantised vertices, normals, the first set of colours, factors of materials. Mended and noted:
//! indices past the vertices, positions that are no numbers, rotations of zero length, nodes with two parents. Not drawn and
//! noted: points and lines, textures, animations, skins and morph targets: the mesh is as it is saved.
//!
//! The JSON is looked up value by value, in f64: what is broken beside the meshes does no harm, and what is broken in them is
//! named with its place. Not read: compressed meshes, cameras, lights.

mod accessor;
mod buffers;
mod container;
mod json;
mod material;
mod nodes;
mod primitive;
#[cfg(test)]
mod tests;

use serde_json::Value;

use super::Import;
use super::lines::quote;
use crate::scene::error::SceneError;
use crate::scene::mesh::RawMesh;
use crate::scene::report::{NoteKind, Report};
use buffers::Buffer;
use container::Container;
use json::{EXPORT_AGAIN, list, text, whole};
use nodes::Walk;

/// Beginnings of names of extensions that change nothing of what is read, or are read.
const HARMLESS: &[&str] = &[
    "KHR_mesh_quantization",
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_animation_pointer",
    "KHR_xmp",
    "EXT_texture_",
    "EXT_lights_",
    "MSFT_texture_",
];

/// A file's JSON and the bytes that it is about.
struct Document<'a> {
    json: Value,
    buffers: Vec<Buffer<'a>>,
}

/// Reads the default scene.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let Container { json, binary } = container::open(import, bytes)?;
    check_version(import, &json)?;
    let damaged = |what: String| SceneError::Damaged { file: import.file.to_owned(), what };
    let required = list(&json, "extensionsRequired", "").map_err(damaged)?;
    let is_harmless = |name: &str| HARMLESS.iter().any(|start| name.starts_with(start));
    if let Some(name) = required.iter().filter_map(Value::as_str).find(|name| !is_harmless(name)) {
        return Err(SceneError::Unsupported { file: import.file.to_owned(), what: needs_extension(name) });
    }
    let buffers = buffers::read(import, &json, binary);
    let damaged = |what: String| SceneError::Damaged { file: import.file.to_owned(), what };
    let document = Document { json, buffers: buffers.map_err(damaged)? };
    let mesh = read_scene(&document, bytes.len(), &mut import.report);
    mesh.map_err(|what| SceneError::Damaged { file: import.file.to_owned(), what })
}

fn read_scene(document: &Document<'_>, num_file_bytes: usize, report: &mut Report) -> Result<RawMesh, String> {
    let json = &document.json;
    let mut walk = Walk::new(document, num_file_bytes)?;
    walk.run(&roots(json, report)?, report)?;
    let (parts, shapes) = (walk.parts, walk.shapes);
    if parts.is_empty() && shapes.num_left_out > 0 {
        return Err(format!(
            "none of its {} triangles has three vertices that exist and are finite; {EXPORT_AGAIN}",
            shapes.num_left_out
        ));
    }
    let count = |key: &str| Ok::<u32, String>(u32::try_from(list(json, key, "")?.len()).unwrap_or(u32::MAX));
    report.note_many(NoteKind::TextureNotDrawn, count("textures").unwrap_or(0), String::new);
    let num_morphed = list(json, "meshes", "")?.iter().filter(|mesh| is_morphed(mesh)).count() as u32;
    let num_moving = count("animations").unwrap_or(0) + count("skins").unwrap_or(0) + num_morphed;
    report.note_many(NoteKind::NotAnimated, num_moving, String::new);
    let materials = material::read(list(json, "materials", "")?);
    Ok(RawMesh { shapes: shapes.shapes, parts, materials })
}

/// The nodes at the top of the default scene; of the first if none is the default, and of all nodes without a parent if
/// there is no scene.
fn roots(json: &Value, report: &mut Report) -> Result<Vec<Value>, String> {
    let scenes = list(json, "scenes", "")?;
    let chosen = whole(json, "scene", "")?.unwrap_or(0);
    report.note_many(NoteKind::SceneSkipped, (scenes.len() as u32).saturating_sub(1), String::new);
    match accessor::entry(scenes, chosen).or(scenes.first()) {
        Some(scene) => Ok(list(scene, "nodes", &format!("scenes[{chosen}]"))?.to_vec()),
        None => {
            let nodes = list(json, "nodes", "")?;
            let mut has_parent = vec![false; nodes.len()];
            for child in nodes.iter().filter_map(|node| node.get("children")?.as_array()).flatten() {
                let child = json::whole_of(child).and_then(|child| usize::try_from(child).ok());
                if let Some(has_parent) = child.and_then(|child| has_parent.get_mut(child)) {
                    *has_parent = true;
                }
            }
            // Where every node has a parent they go round in circles, and the walk says so.
            let has_none = has_parent.iter().all(|&has| has);
            let roots = (0..nodes.len()).filter(|&node| has_none || !has_parent[node]);
            Ok(roots.map(Value::from).collect())
        }
    }
}

/// Whether a mesh has other forms to turn into.
fn is_morphed(mesh: &Value) -> bool {
    let primitives = mesh.get("primitives").and_then(Value::as_array);
    primitives.is_some_and(|all| all.iter().any(|primitive| primitive.get("targets").is_some()))
}

fn check_version(import: &Import<'_>, json: &Value) -> Result<(), SceneError> {
    let version = json.get("asset").map(|asset| text(asset, "version")).unwrap_or_default();
    // The first version had objects where lists are now, and its earliest files no version.
    if version.starts_with("1.") || version.starts_with("0.") || json.get("meshes").is_some_and(is_version_1) {
        return Err(version_1(import));
    }
    let what = match version {
        "" => "is JSON, but no glTF: it has no asset.version; give a glTF 2.0 file".to_owned(),
        version if version.starts_with("2") => return Ok(()),
        version => {
            format!("is glTF of version {}, and only 2.0 is read; export it as glTF 2.0", quote(version.as_bytes()))
        }
    };
    Err(SceneError::Unsupported { file: import.file.to_owned(), what })
}

/// Whether these are meshes of the first version: named, not numbered.
fn is_version_1(meshes: &Value) -> bool {
    meshes.as_object().is_some_and(|meshes| meshes.values().any(|mesh| mesh.get("primitives").is_some()))
}

/// The error of a file of the first version.
fn version_1(import: &Import<'_>) -> SceneError {
    let what = "is glTF 1.0, and only 2.0 is read; convert it to glTF 2.0".to_owned();
    SceneError::Unsupported { file: import.file.to_owned(), what }
}

/// What is said of an extension that the file cannot be read without.
fn needs_extension(name: &str) -> String {
    let is_compression =
        ["draco", "meshopt", "compression"].iter().any(|word| name.to_ascii_lowercase().contains(word));
    let without = if is_compression { "compression" } else { "it" };
    let name: String = name.chars().filter(char::is_ascii_graphic).take(64).collect();
    format!("needs the extension {name}, which is not read; export without {without}")
}
