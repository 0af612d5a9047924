//! An object's mesh as shapes: one for each material, and one for its triangles with colours.

use std::collections::HashMap;

use super::super::compact::compact;
use super::model::{Group, Mesh, Object, Property};
use crate::scene::mesh::RawShape;
use crate::scene::report::{NoteKind, Report};

/// What a triangle is made of. Ordered as the shapes are.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Finish {
    Plain,
    Material(u32),
    Colored,
}

/// The shapes of an object, each with its material, and how many triangles were left out.
pub(super) fn of_object(
    object: &mut Object,
    groups: &HashMap<u32, Group>,
    report: &mut Report,
    place: &str,
) -> (Vec<(RawShape, Option<u32>)>, u64) {
    let Mesh { mut positions, mut triangles, mut properties } = std::mem::take(&mut object.mesh);
    let default = object.property.map(|(group, entry)| Property { group, corners: [entry; 3] });
    properties.resize(triangles.len(), None);
    let is_there = |triangle: &[u32; 3]| triangle.iter().all(|&index| (index as usize) < positions.len());
    let is_finite = |triangle: &[u32; 3]| triangle.iter().all(|&index| positions[index as usize].is_finite());
    let (mut num_nowhere, mut num_not_finite) = (0_u32, 0_u32);
    let mut by_finish: HashMap<Finish, Vec<usize>> = HashMap::new();
    for (index, triangle) in triangles.iter().enumerate() {
        if !is_there(triangle) {
            num_nowhere += 1;
        } else if !is_finite(triangle) {
            num_not_finite += 1;
        } else {
            let property = properties[index].or(default);
            by_finish.entry(finish(property, groups)).or_default().push(index);
        }
    }
    report.note_many(NoteKind::FaceOutOfRange, num_nowhere, || place.to_owned());
    report.note_many(NoteKind::FaceNowhere, num_not_finite, || place.to_owned());
    let mut finishes: Vec<Finish> = by_finish.keys().copied().collect();
    finishes.sort_unstable();
    let num_left_out = u64::from(num_nowhere) + u64::from(num_not_finite);
    let mut shapes = Vec::with_capacity(finishes.len());
    for finish in &finishes {
        let members = by_finish.remove(finish).unwrap_or_default();
        let material = if let Finish::Material(material) = finish { Some(*material) } else { None };
        if *finish == Finish::Colored {
            let property = |index: usize| properties[index].or(default);
            shapes.push((colored(&positions, &triangles, &members, property, groups), None));
            continue;
        }
        let mut own: Vec<[u32; 3]> = if members.len() == triangles.len() {
            std::mem::take(&mut triangles)
        } else {
            members.iter().map(|&index| triangles[index]).collect()
        };
        let used = compact(&mut own, positions.len());
        let own_positions = if finishes.len() == 1 && used.len() == positions.len() {
            std::mem::take(&mut positions)
        } else {
            used.iter().map(|&index| positions[index as usize]).collect()
        };
        shapes.push((RawShape { positions: own_positions, triangles: own, ..RawShape::default() }, material));
    }
    (shapes, num_left_out)
}

fn finish(property: Option<Property>, groups: &HashMap<u32, Group>) -> Finish {
    let Some(property) = property else { return Finish::Plain };
    match groups.get(&property.group) {
        Some(Group::Materials { first, count }) if property.corners[0] < *count => {
            Finish::Material(first + property.corners[0])
        }
        Some(Group::Colors(colors)) if !colors.is_empty() => Finish::Colored,
        _ => Finish::Plain,
    }
}

/// The shape of triangles with colours: a vertex for each pair of position and colour.
fn colored(
    positions: &[glam::DVec3],
    triangles: &[[u32; 3]],
    members: &[usize],
    property: impl Fn(usize) -> Option<Property>,
    groups: &HashMap<u32, Group>,
) -> RawShape {
    let mut shape = RawShape::default();
    let mut known: HashMap<(u32, [u8; 3]), u32> = HashMap::new();
    for &member in members {
        let property = property(member);
        let colors = match property.and_then(|property| groups.get(&property.group)) {
            Some(Group::Colors(colors)) => colors.as_slice(),
            _ => &[],
        };
        let entries = property.map_or([0; 3], |property| property.corners);
        let mut corners = [0; 3];
        for ((corner, &vertex), entry) in corners.iter_mut().zip(&triangles[member]).zip(entries) {
            let color = colors.get(entry as usize).copied().unwrap_or([255; 3]);
            *corner = *known.entry((vertex, color)).or_insert_with(|| {
                shape.positions.push(positions[vertex as usize]);
                shape.colors.push(color);
                shape.positions.len() as u32 - 1
            });
        }
        shape.triangles.push(corners);
    }
    shape
}
