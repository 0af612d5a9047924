//! Faces of any number of vertices by their numbers: checked, cut into triangles, coloured.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::vertex::is_place;
use crate::scene::mesh::{RawMesh, RawNormals, RawPart, RawShape, Triangulator};
use crate::scene::report::{NoteKind, Report};

/// A shape while its faces are read.
#[derive(Default)]
pub(super) struct Faces {
    positions: Vec<DVec3>,
    /// Numbers of positions that are no places, ascending.
    nowhere: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// sRGB of each triangle; empty while no face has a colour.
    colors: Vec<[u8; 3]>,
    num_faces: u64,
    triangulator: Triangulator,
    polygon: Vec<u32>,
    corners: Vec<DVec3>,
    cut: Vec<[u32; 3]>,
}

/// Faces without a colour where others have one, and colours that are no numbers.
pub(super) const WHITE: [u8; 3] = [255; 3];

impl Faces {
    /// Makes room for what surely comes.
    pub(super) fn reserve(&mut self, num_positions: usize, num_triangles: usize) {
        self.positions.reserve_exact(num_positions);
        self.triangles.reserve_exact(num_triangles);
    }

    /// Adds a vertex; one that is NaN, infinite or absurd takes its faces with it.
    pub(super) fn push(&mut self, position: DVec3) {
        let is_there = is_place(position);
        if !is_there {
            self.nowhere.push(self.positions.len() as u32);
        }
        self.positions.push(if is_there { position } else { DVec3::ZERO });
    }

    /// Vertices so far.
    pub(super) fn num_positions(&self) -> usize {
        self.positions.len()
    }

    /// Adds a face; `indices` are whole numbers from 0, or wrong.
    pub(super) fn add(&mut self, report: &mut Report, line: Option<u32>, indices: &[f64], color: Option<[u8; 3]>) {
        self.num_faces += 1;
        let number = self.num_faces;
        let text = || format!("face {number}");
        if indices.len() < 3 {
            return report.note(NoteKind::ShortFace, line, text);
        }
        self.polygon.clear();
        for &index in indices {
            if !(index >= 0.0 && index < self.positions.len() as f64 && index.fract() == 0.0) {
                return report.note(NoteKind::FaceOutOfRange, line, text);
            }
            self.polygon.push(index as u32);
        }
        if !self.nowhere.is_empty() && self.polygon.iter().any(|index| self.nowhere.binary_search(index).is_ok()) {
            return report.note(NoteKind::FaceNowhere, line, text);
        }
        if let &[a, b, c] = self.polygon.as_slice() {
            self.triangles.push([a, b, c]);
        } else {
            self.corners.clear();
            self.corners.extend(self.polygon.iter().map(|&index| self.positions[index as usize]));
            self.cut.clear();
            if !self.triangulator.cut(&self.corners, &mut self.cut) {
                report.note(NoteKind::CrossedPolygon, line, text);
            }
            let polygon = &self.polygon;
            self.triangles.extend(self.cut.iter().map(|triangle| triangle.map(|corner| polygon[corner as usize])));
        }
        if color.is_some() && self.colors.is_empty() {
            self.colors.reserve_exact(self.triangles.capacity());
        }
        if color.is_some() || !self.colors.is_empty() {
            self.colors.resize(self.triangles.len() - self.triangles.len().min(self.num_new()), WHITE);
            self.colors.resize(self.triangles.len(), color.unwrap_or(WHITE));
        }
    }

    /// Triangles of the face that was added last.
    fn num_new(&self) -> usize {
        self.polygon.len().saturating_sub(2)
    }

    /// A mesh of one part; empty if there is no triangle. Normals and colours are those of vertices, or empty.
    pub(super) fn finish(self, normals: Vec<Vec3>, colors: Vec<[u8; 3]>) -> RawMesh {
        if self.triangles.is_empty() {
            return RawMesh::default();
        }
        let Faces { mut positions, nowhere, triangles, colors: of_faces, .. } = self;
        // Where the mesh is, so that its bounds stay those of its triangles.
        let inside = positions[triangles[0][0] as usize];
        nowhere.iter().for_each(|&index| positions[index as usize] = inside);
        let mut shape = RawShape { positions, triangles, normals: RawNormals::None, colors };
        let mut normals = normals;
        if shape.colors.is_empty() && !of_faces.is_empty() {
            split(&mut shape, &mut normals, &of_faces);
        }
        if normals.len() == shape.positions.len() {
            shape.normals = RawNormals::PerVertex(normals);
        }
        let (name, file_from_shape) = (String::new(), glam::DAffine3::IDENTITY);
        let part = RawPart { shape: 0, material: None, path: name.clone(), name, file_from_shape };
        RawMesh { shapes: vec![shape], parts: vec![part], materials: Vec::new() }
    }
}

/// Gives each vertex one colour: those between faces of different colours become several.
fn split(shape: &mut RawShape, normals: &mut Vec<Vec3>, of_faces: &[[u8; 3]]) {
    let mut numbers: HashMap<(u32, [u8; 3]), u32> = HashMap::new();
    let (old, old_normals) = (std::mem::take(&mut shape.positions), std::mem::take(normals));
    for (triangle, &color) in shape.triangles.iter_mut().zip(of_faces) {
        for index in triangle {
            *index = *numbers.entry((*index, color)).or_insert_with(|| {
                shape.positions.push(old[*index as usize]);
                shape.colors.push(color);
                normals.extend(old_normals.get(*index as usize));
                shape.positions.len() as u32 - 1
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_between_colours_are_doubled_and_normals_go_with_them() {
        let mut faces = Faces::default();
        let mut report = Report::default();
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (f64::NAN, 0.0)] {
            faces.push(DVec3::new(x, y, 5.0));
        }
        faces.add(&mut report, None, &[0.0, 1.0, 2.0], None);
        faces.add(&mut report, None, &[0.0, 1.0, 2.0, 3.0], Some([9, 0, 0]));
        faces.add(&mut report, None, &[0.0, 1.0, 4.0], Some([9, 0, 0]));
        faces.add(&mut report, None, &[0.0, 2.0, 3.0], None);
        faces.add(&mut report, None, &[0.0, 1.5, 3.0], None);
        let normals: Vec<Vec3> = (0..5).map(|i| Vec3::splat(i as f32)).collect();
        let mesh = faces.finish(normals, Vec::new());
        let shape = &mesh.shapes[0];
        let RawNormals::PerVertex(normals) = &shape.normals else { panic!("no normals") };
        let corners =
            shape.triangles.as_flattened().iter().map(|&i| (shape.colors[i as usize][0], normals[i as usize].x));
        let expected = [(255, [0.0, 1.0, 2.0]), (9, [0.0, 1.0, 2.0]), (9, [0.0, 2.0, 3.0]), (255, [0.0, 2.0, 3.0])];
        assert!(corners.eq(expected.iter().flat_map(|&(red, xs)| xs.map(|x| (red, x)))));
        assert_eq!((shape.positions.len(), shape.colors.len()), (8, 8));
        assert_eq!((report.count(NoteKind::FaceNowhere), report.count(NoteKind::FaceOutOfRange)), (1, 1));
        assert!(shape.positions.iter().all(|place| place.z == 5.0));
    }
}
