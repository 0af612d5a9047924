//! Primitives to shapes: lists, strips and fans of triangles [Gltf2 §3.7.2].

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use serde_json::Value;

use super::super::compact::compact;
use super::super::number::ABSURD;
use super::Document;
use super::accessor::{Accessor, Component};
use super::json::{EXPORT_AGAIN, whole};
use crate::scene::mesh::{RawNormals, RawShape};
use crate::scene::report::{NoteKind, Report};
use crate::scene::srgb_from_linear;

/// Elements that small files may have on top of one for each byte of their buffers.
const SPARE_ELEMENTS: u64 = 1 << 18;

/// What a primitive is made of; primitives of the same parts share their shape.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Recipe {
    mode: u64,
    indices: Option<u64>,
    position: Option<u64>,
    normal: Option<u64>,
    color: Option<u64>,
}

/// The shapes of a file, each read when it is first placed.
pub(super) struct Shapes {
    /// Those that have triangles.
    pub(super) shapes: Vec<RawShape>,
    /// Triangles that were left out.
    pub(super) num_left_out: u64,
    known: HashMap<Recipe, Option<u32>>,
    /// Vertices and corners that may still be read: primitives may share bytes, but not without end.
    num_elements_left: u64,
}

impl Shapes {
    /// No shape yet.
    pub(super) fn new(document: &Document<'_>) -> Self {
        let num_bytes: u64 = document.buffers.iter().flatten().map(|buffer| buffer.len() as u64).sum();
        let num_elements_left = num_bytes + SPARE_ELEMENTS;
        Self { shapes: Vec::new(), num_left_out: 0, known: HashMap::new(), num_elements_left }
    }

    /// The number of a primitive's shape; none if it has no triangles.
    pub(super) fn of_primitive(
        &mut self,
        document: &Document<'_>,
        primitive: &Value,
        place: &str,
        report: &mut Report,
    ) -> Result<Option<u32>, String> {
        let nothing = Value::Null;
        let attributes = primitive.get("attributes").unwrap_or(&nothing);
        let attribute = |key: &str| whole(attributes, key, &format!("{place}.attributes"));
        let recipe = Recipe {
            mode: whole(primitive, "mode", place)?.unwrap_or(4),
            indices: whole(primitive, "indices", place)?,
            position: attribute("POSITION")?,
            normal: attribute("NORMAL")?,
            color: attribute("COLOR_0")?,
        };
        if let Some(&shape) = self.known.get(&recipe) {
            return Ok(shape);
        }
        let is_draco = primitive.get("extensions").is_some_and(|all| all.get("KHR_draco_mesh_compression").is_some());
        let shape = self.read(document, &recipe, place, is_draco, report)?.map(|shape| {
            self.shapes.push(shape);
            self.shapes.len() as u32 - 1
        });
        self.known.insert(recipe, shape);
        Ok(shape)
    }

    fn read(
        &mut self,
        document: &Document<'_>,
        recipe: &Recipe,
        place: &str,
        is_draco: bool,
        report: &mut Report,
    ) -> Result<Option<RawShape>, String> {
        let (Some(position), 4..=6) = (recipe.position, recipe.mode) else {
            report.note(NoteKind::NotTriangles, None, || place.to_owned());
            return Ok(None);
        };
        let positions = document.accessor(position)?;
        if !positions.has_values() && is_draco {
            return Err(super::needs_extension("KHR_draco_mesh_compression"));
        }
        if positions.components != 3 {
            return Err(format!("accessors[{position}] of positions is no VEC3; {EXPORT_AGAIN}"));
        }
        let indices = recipe.indices.map(|index| document.accessor(index)).transpose()?;
        let num_corners = indices.as_ref().map_or(positions.count, |indices| indices.count);
        self.take(num_corners)?;
        let is_index = |component| matches!(component, Component::U8 | Component::U16 | Component::U32);
        if indices.as_ref().is_some_and(|indices| indices.components != 1 || !is_index(indices.component)) {
            return Err(format!("the indices of {place} are no whole numbers from 0; {EXPORT_AGAIN}"));
        }
        let mut triangles = match &indices {
            Some(indices) => triangles(recipe.mode, num_corners, |i| indices.index(i)),
            // Below the number of elements that may be left, which is far below 2^32 times what memory holds.
            None => triangles(recipe.mode, num_corners.min(u32::MAX as usize), |i| i as u32),
        };
        let num_all = triangles.len();
        let is_there = |triangle: &[u32; 3]| triangle.iter().all(|&index| (index as usize) < positions.count);
        triangles.retain(is_there);
        let num_cut = usize::from(recipe.mode == 4 && num_corners % 3 != 0);
        self.leave_out(NoteKind::FaceOutOfRange, num_all - triangles.len() + num_cut, place, report);
        let mut used = compact(&mut triangles, positions.count);
        self.take(used.len())?;
        let mut points: Vec<DVec3> = used.iter().map(|&i| DVec3::from(positions.floats::<3>(i as usize))).collect();
        let is_point = |point: &DVec3| point.abs().max_element() <= ABSURD && point.is_finite();
        if !points.iter().all(is_point) {
            let num_all = triangles.len();
            triangles.retain(|triangle| triangle.iter().all(|&index| is_point(&points[index as usize])));
            self.leave_out(NoteKind::FaceNowhere, num_all - triangles.len(), place, report);
            let left = compact(&mut triangles, points.len());
            points = left.iter().map(|&i| points[i as usize]).collect();
            used = left.iter().map(|&i| used[i as usize]).collect();
        }
        if triangles.is_empty() {
            return Ok(None);
        }
        let mut attribute = |index: Option<u64>, components: &[usize]| {
            let accessor = index.map(|index| document.accessor(index))?.ok();
            let fits = |accessor: &Accessor<'_>| {
                accessor.count >= positions.count && components.contains(&accessor.components)
            };
            let accessor = accessor.filter(fits);
            if accessor.is_none() {
                report.note(NoteKind::AttributeLeftOut, None, || place.to_owned());
            }
            accessor
        };
        let normals = attribute(recipe.normal, &[3]).map_or(RawNormals::None, |accessor| {
            let normal = |&i: &u32| accessor.floats::<3>(i as usize).map(|value| value as f32);
            let finite = |normal: Vec3| if normal.is_finite() { normal } else { Vec3::ZERO };
            RawNormals::PerVertex(used.iter().map(|i| finite(Vec3::from(normal(i)))).collect())
        });
        let colors = attribute(recipe.color, &[3, 4]).map_or(Vec::new(), |accessor| {
            let accessor = accessor.into_share();
            used.iter().map(|&i| accessor.floats::<3>(i as usize).map(srgb)).collect()
        });
        Ok(Some(RawShape { positions: points, triangles, normals, colors }))
    }

    fn leave_out(&mut self, kind: NoteKind, count: usize, place: &str, report: &mut Report) {
        self.num_left_out += count as u64;
        report.note_many(kind, u32::try_from(count).unwrap_or(u32::MAX), || place.to_owned());
    }

    fn take(&mut self, count: usize) -> Result<(), String> {
        match self.num_elements_left.checked_sub(count as u64) {
            Some(left) => self.num_elements_left = left,
            None => {
                return Err(format!("its meshes announce more vertices than the buffers can hold; {EXPORT_AGAIN}"));
            }
        }
        Ok(())
    }
}

/// Triangles of `count` corners: 4 is a list, 5 a strip, 6 a fan. A strip repeats corners to turn; those have no surface.
fn triangles(mode: u64, count: usize, index: impl Fn(usize) -> u32) -> Vec<[u32; 3]> {
    let corners = |a, b, c| [index(a), index(b), index(c)];
    let is_surface = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let num_linked = count.saturating_sub(2);
    match mode {
        // Every second triangle of a strip is turned round.
        5 => (0..num_linked).map(|i| corners(i, i + 1 + i % 2, i + 2 - i % 2)).filter(is_surface).collect(),
        6 => (0..num_linked).map(|i| corners(i + 1, i + 2, 0)).filter(is_surface).collect(),
        _ => (0..count / 3).map(|i| corners(3 * i, 3 * i + 1, 3 * i + 2)).collect(),
    }
}

/// A linear share in sRGB of 8 bits.
fn srgb(linear: f64) -> u8 {
    (srgb_from_linear(linear) * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_turn_every_second_triangle_and_fans_keep_their_first_corner() {
        let index = |i| i as u32;
        assert_eq!(triangles(4, 7, index), [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(triangles(5, 5, index), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(triangles(6, 4, index), [[1, 2, 0], [2, 3, 0]]);
        assert_eq!(triangles(5, 1, index).len(), 0);
        assert_eq!(triangles(5, 4, |i| [0, 1, 1, 2][i]).len(), 0, "turning corners");
    }

    #[test]
    fn linear_colors_are_encoded() {
        assert_eq!([0.0, 0.5, 1.0, 0.001, -1.0, f64::NAN].map(srgb), [0, 188, 255, 3, 0, 0]);
    }
}
