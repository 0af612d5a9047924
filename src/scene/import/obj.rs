//! OBJ: statements of one line each, with materials in a file of their own.
//!
//! `tobj` reads the vertices and faces. It stops at the first line that it does not like, without saying which, reads
//! ahead of no face, and makes no difference between objects and groups; so it is not given the file but what [`clean`]
//! makes of it: all vertices, then all faces, each sound, and a number for each run of one object, group and material.
//! Texture coordinates are left out, since nothing is drawn from them.

mod checked;
mod clean;
mod material;
mod names;
mod statement;

use std::collections::HashMap;

use glam::{DAffine3, DVec3};
use tobj::{LoadOptions, Mesh};

use self::clean::Cleaned;
use self::names::Run;
use super::{Import, SceneError};
use crate::scene::mesh::{RawMesh, RawNormals, RawPart, RawShape, Triangulator};
use crate::scene::report::NoteKind;

pub(super) use self::statement::is_obj;

/// Reads the mesh and the materials beside it.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let text = statement::decoded(bytes);
    let mut cleaned = Cleaned::new(import, &text);
    let options = LoadOptions { ignore_points: true, ignore_lines: true, ..LoadOptions::default() };
    let models = match tobj::load_obj_buf(&mut cleaned, &options, |_| Err(tobj::LoadError::GenericFailure)) {
        Ok((models, _)) => models,
        Err(error) => return Err(cleaned.blame(&error)),
    };
    let names = cleaned.finish();
    drop(text);
    let materials = material::read(import, &names);
    let scale = color_scale(&models);
    let mut builder =
        Builder { triangulator: Triangulator::default(), shapes: HashMap::new(), parts: Vec::new(), scale };
    for model in models {
        let run = model.name.parse().ok().and_then(|number: usize| names.runs.get(number));
        if let (Some(run), false) = (run, model.mesh.indices.is_empty()) {
            builder.add(import, &names.label(run).0, run, model.mesh);
        }
    }
    let mut mesh = RawMesh { materials, ..RawMesh::default() };
    for (run, shape) in builder.parts {
        let (name, path) = names.label(&run);
        let (shape, number) = (shape, mesh.shapes.len() as u32);
        mesh.shapes.push(shape);
        let file_from_shape = DAffine3::IDENTITY;
        mesh.parts.push(RawPart { shape: number, material: run.material, name, path, file_from_shape });
    }
    if mesh.parts.is_empty() { Err(import.no_triangles()) } else { Ok(mesh) }
}

/// What colours are multiplied by for 0 to 255: some files write 0 to 1, others 0 to 255.
fn color_scale(models: &[tobj::Model]) -> f64 {
    let mut colors = models.iter().flat_map(|model| &model.mesh.vertex_color);
    if colors.any(|&value| value > 1.0) { 1.0 } else { 255.0 }
}

/// Shapes by their runs: one that is broken off and taken up again is one part.
struct Builder {
    triangulator: Triangulator,
    shapes: HashMap<Run, usize>,
    parts: Vec<(Run, RawShape)>,
    scale: f64,
}

impl Builder {
    fn add(&mut self, import: &mut Import<'_>, name: &str, run: &Run, mesh: Mesh) {
        let index = *self.shapes.entry(*run).or_insert_with(|| {
            self.parts.push((*run, RawShape::default()));
            self.parts.len() - 1
        });
        let Some((_, shape)) = self.parts.get_mut(index) else { return };
        let first = shape.positions.len() as u32;
        let (places, _) = mesh.positions.as_chunks::<3>();
        shape.positions.extend(places.iter().copied().map(DVec3::from_array));
        let (colors, _) = mesh.vertex_color.as_chunks::<3>();
        // What is no number is white.
        let byte = |value: f64| if value.is_nan() { 255 } else { (value * self.scale).round() as u8 };
        shape.colors.extend(colors.iter().map(|color| color.map(byte)));
        // Without arities all faces are triangles.
        let arities = mesh.face_arities.iter().map(|&arity| arity as usize);
        let num_triangles = if mesh.face_arities.is_empty() { mesh.indices.len() / 3 } else { 0 };
        let (mut cut, mut corners) = (Vec::new(), Vec::new());
        let mut chosen: Vec<[u32; 3]> = Vec::with_capacity(num_triangles);
        let mut start = 0;
        for arity in arities.chain(std::iter::repeat_n(3, num_triangles)) {
            let face = mesh.indices.get(start..start + arity).unwrap_or_default();
            cut.clear();
            if arity == 3 {
                cut.push([0, 1, 2]);
            } else {
                corners.clear();
                corners.extend(face.iter().map(|&index| places[index as usize]).map(DVec3::from_array));
                if !self.triangulator.cut(&corners, &mut cut) {
                    import.report.note(NoteKind::CrossedPolygon, None, || super::lines::quote(name.as_bytes()));
                }
            }
            chosen.extend(cut.iter().map(|triangle| triangle.map(|corner| corner + start as u32)));
            start += arity;
        }
        let pick = |of: &[u32], first: u32| -> Vec<[u32; 3]> {
            chosen.iter().map(|triangle| triangle.map(|corner| of[corner as usize] + first)).collect()
        };
        append(&mut shape.triangles, pick(&mesh.indices, first));
        if run.has_normals {
            let (theirs, _) = mesh.normals.as_chunks::<3>();
            let theirs = theirs.iter().map(|&normal| DVec3::from_array(normal).as_vec3());
            if !matches!(shape.normals, RawNormals::PerCorner { .. }) {
                shape.normals = RawNormals::PerCorner { normals: Vec::new(), corners: Vec::new() };
            }
            if let RawNormals::PerCorner { normals, corners } = &mut shape.normals {
                let first = normals.len() as u32;
                normals.extend(theirs);
                append(corners, pick(&mesh.normal_indices, first));
            }
        }
    }
}

/// Moves rather than copies where there is nothing yet.
fn append<T>(to: &mut Vec<T>, mut from: Vec<T>) {
    if to.is_empty() {
        *to = from;
    } else {
        to.append(&mut from);
    }
}

#[cfg(test)]
mod tests;
