//! One shape from the file's triangles to those that are drawn.

use super::links::Links;
use super::place::Frame;
use super::vertices::{self, Known, Placing};
use super::weld::Surface;
use super::winding::Winding;
use super::{RawShape, Shape};
use crate::scene::{NoteKind, Report, bounding_sphere};

/// Mends a shape; none if no triangle is left. `name` is that of its part, for the report.
pub(super) fn mend(raw: RawShape, frame: &Frame, placing: Placing, name: &str, report: &mut Report) -> Option<Shape> {
    let mut note = |kind, count| report.note_many(kind, count, || name.to_string());
    let (mut surface, num_lost) = Surface::new(raw, frame);
    let mut num_flat = surface.drop_collapsed().saturating_sub(num_lost);
    let mut is_flat = flat_faces(&surface, frame);
    let mut links = Links::new(&surface, &is_flat);
    if links.num_open > 0 {
        let num_welded = surface.weld_near(&links, frame);
        if num_welded > 0 {
            num_flat += surface.drop_collapsed();
            drop(links);
            is_flat = flat_faces(&surface, frame);
            links = Links::new(&surface, &is_flat);
        }
        note(NoteKind::NearlyWelded, num_welded);
    }
    if !links.duplicates.is_empty() {
        note(NoteKind::RepeatedTriangle, surface.part_duplicates(&links));
        drop(links);
        is_flat = flat_faces(&surface, frame);
        links = Links::new(&surface, &is_flat);
    }
    let Winding { is_turned, num_turned, num_inside_out, .. } = Winding::find(&surface, &links);
    if is_turned.contains(&true) {
        surface.turn(&is_turned);
        links.turn(&is_turned);
    }
    links.make_rings(&surface.triangles);
    let known = Known { is_turned: &is_turned, is_flat: &is_flat };
    note(NoteKind::LostTriangle, num_lost);
    note(NoteKind::FlatTriangle, num_flat + is_flat.iter().filter(|&&is_flat| is_flat).count() as u32);
    note(NoteKind::FaceTurned, num_turned);
    note(NoteKind::InsideOut, num_inside_out);
    note(NoteKind::NormalsDropped, known.check_normals(&mut surface));
    let mut shape = vertices::make(surface, links, &known, placing);
    shape.sphere = bounding_sphere(shape.positions.iter().map(|&p| (p, 0.0)));
    shape.thickness = shape.mean_chord();
    (!shape.triangles.is_empty()).then_some(shape)
}

/// Which triangles have no area, as far as the file's digits can tell. They still hold their neighbours together while
/// windings are found: CAD programs leave them where an edge has a vertex on one side only.
fn flat_faces(surface: &Surface, frame: &Frame) -> Vec<bool> {
    let rounding = frame.rounding();
    let is_flat = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|place| surface.positions[place as usize]);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        (b - a).cross(c - a).length_squared() <= longest * rounding * rounding
    };
    surface.triangles.iter().map(is_flat).collect()
}
