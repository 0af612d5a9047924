//! From what an importer read to what is drawn.

use std::collections::HashMap;

use glam::{Affine3A, DAffine3, DVec3, Vec3};

use super::mend::mend;
use super::place::{self, Frame, extremes, is_position, power_below};
use super::vertices::Placing;
use super::{Assembly, Part, RawMesh, RawPart, RawShape, Shape};
use crate::scene::builder::single;
use crate::scene::{NoteKind, Report, Sphere, bounding_sphere};

/// Radii that need no unit of their own: single precision has room for their squares and their details.
const COMMON_RADII: std::ops::RangeInclusive<f64> = 1e-4..=1e6;
/// Sizes of a shape, in scene units, that need no scale of their own.
const COMMON_SIZES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;
/// The largest entry of a placement whose squares single precision holds with room to spare. Only shapes that are flat
/// along an axis, or so far away that they do not count for the unit, have larger ones.
const LARGEST_ENTRY: f64 = 1e15;
/// Vertices of shapes placed several times that are looked at to measure the sphere around all; then their spheres do.
const MOST_MEASURED: usize = 1 << 24;
/// Attempts at the sphere around all, and the excess that is not worth another one.
const SPHERE_PASSES: usize = 8;
const SPHERE_EXCESS: f32 = 1e-3;

impl Assembly {
    /// Mends and recentres a mesh; none if it has no triangle. `file` is the number of its file in the scene.
    ///
    /// A shape that is placed once gets the coordinates of the scene; one that is placed more often keeps its own, around
    /// its own middle. Notes in the report name the first part of a shape.
    pub fn build(raw: RawMesh, file: u32, report: &mut Report) -> Option<Assembly> {
        let RawMesh { mut shapes, parts, materials } = raw;
        let mut parts = placeable(parts, &shapes, report);
        let mut num_places = vec![0_u32; shapes.len()];
        parts.iter().for_each(|part| num_places[part.shape as usize] += 1);
        for part in &mut parts {
            if num_places[part.shape as usize] == 1 {
                place::bake(&mut shapes[part.shape as usize], &part.file_from_shape);
                part.file_from_shape = DAffine3::IDENTITY;
            }
        }
        let frames: Vec<Option<Frame>> =
            shapes.iter().zip(&num_places).map(|(shape, &times)| Frame::of(shape).filter(|_| times > 0)).collect();
        let (low, high) = bounds(&parts, &shapes, &frames, &num_places)?;
        let origin = low * 0.5 + high * 0.5;
        let unit = unit_for(high * 0.5 - low * 0.5);
        let stored: Vec<Option<Stored>> = frames
            .iter()
            .zip(&num_places)
            .map(|(frame, &times)| frame.map(|frame| Stored::new(frame, times > 1, unit, origin)))
            .collect();

        // The first part of each shape gives it a name for the report; without one it is not needed.
        let mut name_of: Vec<Option<&str>> = vec![None; shapes.len()];
        let mut worlds: Vec<Option<Affine3A>> = Vec::with_capacity(parts.len());
        for part in &parts {
            let index = part.shape as usize;
            let world = stored[index].as_ref().and_then(|stored| stored.world(&part.file_from_shape, unit, origin));
            match world {
                Some(_) => _ = name_of[index].get_or_insert(&part.name),
                None if stored[index].is_some() => report.note(NoteKind::PartUnplaceable, None, || part.name.clone()),
                None => {}
            }
            worlds.push(world);
        }
        let mut mended: Vec<Shape> = Vec::new();
        let mut number_of: Vec<Option<u32>> = Vec::with_capacity(shapes.len());
        for ((raw, stored), name) in shapes.into_iter().zip(&stored).zip(name_of) {
            let shape = stored.as_ref().zip(name);
            let shape = shape.and_then(|(stored, name)| mend(raw, &stored.frame, stored.placing, name, report));
            number_of.push(shape.map(|shape| {
                mended.push(shape);
                mended.len() as u32 - 1
            }));
        }
        let mut names = Names::default();
        let mut placed: Vec<Part> = Vec::with_capacity(parts.len());
        for (RawPart { shape, material, name, path, .. }, world) in parts.into_iter().zip(worlds) {
            if let (Some(shape), Some(world_from_shape)) = (number_of[shape as usize], world) {
                let (name, path) = (names.number(name), names.number(path));
                placed.push(Part { shape, material, name, path, file, world_from_shape });
            }
        }
        if placed.is_empty() {
            return None;
        }
        let sphere = sphere_around(&mended, &placed);
        Some(Assembly { shapes: mended, parts: placed, materials, names: names.texts, sphere, unit, origin })
    }
}

/// The unit for a box of half this diagonal.
fn unit_for(half_diagonal: DVec3) -> f64 {
    // Squares of the smallest lengths would vanish.
    let largest = power_below(half_diagonal.max_element());
    let radius = (half_diagonal / largest).length() * largest;
    if COMMON_RADII.contains(&radius) { 1.0 } else { power_below(radius) }
}

/// How the positions of a shape are stored.
struct Stored {
    frame: Frame,
    placing: Placing,
    /// From stored positions to the coordinates of the file's shape; none where they are those of the scene.
    shape_from_stored: Option<DAffine3>,
}

impl Stored {
    fn new(frame: Frame, is_shared: bool, unit: f64, origin: DVec3) -> Stored {
        let to_units = 1.0 / (frame.scale() * unit);
        if !is_shared {
            let placing = Placing { scale: to_units, middle: (frame.middle() - origin) / unit };
            return Stored { frame, placing, shape_from_stored: None };
        }
        let scale = if COMMON_SIZES.contains(&(frame.half() / unit)) { to_units } else { 1.0 };
        let mut shape_from_stored = DAffine3::from_scale(DVec3::splat(1.0 / (frame.scale() * scale)));
        shape_from_stored.translation = frame.middle();
        let placing = Placing { scale, middle: DVec3::ZERO };
        Stored { frame, placing, shape_from_stored: Some(shape_from_stored) }
    }

    /// The placement in the scene; none if single precision cannot hold it.
    fn world(&self, file_from_shape: &DAffine3, unit: f64, origin: DVec3) -> Option<Affine3A> {
        let Some(shape_from_stored) = self.shape_from_stored else { return Some(Affine3A::IDENTITY) };
        let mut world = *file_from_shape * shape_from_stored;
        world.translation -= origin;
        let entries = world.to_cols_array().map(|entry| entry / unit);
        entries.iter().all(|entry| entry.abs() <= LARGEST_ENTRY).then(|| single(DAffine3::from_cols_array(&entries)))
    }
}

/// The parts that can be placed. One whose placement is not finite or shrinks everything to a line is left out, with
/// a note.
fn placeable(parts: Vec<RawPart>, shapes: &[RawShape], report: &mut Report) -> Vec<RawPart> {
    let is_sound = |part: &RawPart| (part.shape as usize) < shapes.len() && place::can_place(&part.file_from_shape);
    let (sound, unsound): (Vec<_>, Vec<_>) = parts.into_iter().partition(is_sound);
    for part in unsound {
        report.note(NoteKind::PartUnplaceable, None, || part.name);
    }
    sound
}

/// The box around all placed vertices, in the coordinates of the file; that of shapes placed several times is measured at
/// their farthest points.
fn bounds(
    parts: &[RawPart],
    shapes: &[RawShape],
    frames: &[Option<Frame>],
    num_places: &[u32],
) -> Option<(DVec3, DVec3)> {
    let mut farthest: Vec<Vec<DVec3>> = Vec::with_capacity(shapes.len());
    for ((shape, frame), &times) in shapes.iter().zip(frames).zip(num_places) {
        let corners = shape.triangles.iter().filter_map(|&triangle| place::corners(&shape.positions, triangle));
        farthest.push(match frame {
            Some(frame) if times == 1 => vec![frame.low, frame.high],
            Some(_) => extremes(corners.flatten()),
            None => Vec::new(),
        });
    }
    let all = parts
        .iter()
        .flat_map(|part| farthest[part.shape as usize].iter().map(|&p| part.file_from_shape.transform_point3(p)));
    all.filter(|&p| is_position(p)).fold(None, |bounds, p| {
        let (low, high) = bounds.unwrap_or((p, p));
        Some((low.min(p), high.max(p)))
    })
}

/// A sphere around all parts, at most 1 % too large where shapes placed several times have fewer than [`MOST_MEASURED`]
/// vertices in all their places.
fn sphere_around(shapes: &[Shape], parts: &[Part]) -> Sphere {
    match parts {
        [part] if part.world_from_shape == Affine3A::IDENTITY => return shapes[part.shape as usize].sphere,
        _ => {}
    }
    let farthest: Vec<Vec<Vec3>> = shapes.iter().map(|shape| extremes(shape.positions.iter().copied())).collect();
    let mut points: Vec<Vec3> = Vec::new();
    for part in parts {
        points.extend(farthest[part.shape as usize].iter().map(|&p| part.world_from_shape.transform_point3(p)));
    }
    let mut best = Sphere { center: Vec3::ZERO, radius: f32::INFINITY };
    for _ in 0..SPHERE_PASSES {
        let inner = bounding_sphere(points.iter().map(|&p| (p, 0.0)));
        let (reach, farthest) = farthest_from(inner.center, inner.radius, shapes, parts);
        if reach < best.radius {
            best = Sphere { center: inner.center, radius: reach };
        }
        match farthest {
            Some(point) if reach > inner.radius * (1.0 + SPHERE_EXCESS) => points.push(point),
            _ => break,
        }
    }
    best
}

/// How far parts reach from a centre, at least `reach`, and the vertex that does.
fn farthest_from(center: Vec3, reach: f32, shapes: &[Shape], parts: &[Part]) -> (f32, Option<Vec3>) {
    let (mut reach, mut farthest, mut num_measured) = (reach, None, 0);
    for part in parts {
        let shape = &shapes[part.shape as usize];
        let ball = placed_sphere(shape, part);
        let bound = ball.center.distance(center) + ball.radius;
        if bound <= reach {
            continue;
        }
        if part.world_from_shape != Affine3A::IDENTITY {
            num_measured += shape.positions.len();
        }
        if num_measured > MOST_MEASURED {
            (reach, farthest) = (bound, None);
            continue;
        }
        for &p in &shape.positions {
            let p = part.world_from_shape.transform_point3(p);
            // Squares of the smallest scenes vanish in single precision.
            let distance = p.as_dvec3().distance(center.as_dvec3()) as f32;
            if distance > reach {
                (reach, farthest) = (distance, Some(p));
            }
        }
    }
    (reach * (1.0 + 1e-6), farthest)
}

/// A sphere around a part: the shape's, grown by the largest stretch that its placement may have.
fn placed_sphere(shape: &Shape, part: &Part) -> Sphere {
    let matrix = part.world_from_shape.matrix3;
    // Between the true stretch and 1.7 times that; without a shear or uneven scales it would be exact by the longest axis.
    let stretch = [matrix.x_axis, matrix.y_axis, matrix.z_axis].iter().map(|axis| axis.length_squared()).sum::<f32>();
    let center = part.world_from_shape.transform_point3(shape.sphere.center);
    Sphere { center, radius: shape.sphere.radius * stretch.sqrt() }
}

/// Numbers names, each once.
#[derive(Default)]
struct Names {
    number_of: HashMap<String, u32>,
    texts: Vec<String>,
}

impl Names {
    fn number(&mut self, name: String) -> u32 {
        if let Some(&number) = self.number_of.get(&name) {
            return number;
        }
        let number = self.texts.len() as u32;
        self.texts.push(name.clone());
        self.number_of.insert(name, number);
        number
    }
}
