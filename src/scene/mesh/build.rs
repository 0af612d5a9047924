//! From what an importer read to what is drawn.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Vec3};

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

        let mut name_of: Vec<&str> = vec![""; shapes.len()];
        parts.iter().rev().for_each(|part| name_of[part.shape as usize] = &part.name);
        // For each shape its number among those that are left, and what scales its positions back.
        let mut kept: Vec<Option<(u32, DAffine3)>> = Vec::with_capacity(shapes.len());
        let mut mended: Vec<Shape> = Vec::new();
        for (index, raw) in shapes.into_iter().enumerate() {
            let shape = frames[index].and_then(|frame| {
                let (placing, file_from_stored) = placing(&frame, num_places[index] > 1, unit, origin);
                mend(raw, &frame, placing, name_of[index], report).map(|shape| (shape, file_from_stored))
            });
            kept.push(shape.map(|(shape, file_from_stored)| {
                mended.push(shape);
                (mended.len() as u32 - 1, file_from_stored)
            }));
        }
        let mut names = Names::default();
        let mut placed: Vec<Part> = Vec::with_capacity(parts.len());
        for RawPart { shape, material, name, path, file_from_shape } in parts {
            let is_baked = num_places[shape as usize] == 1;
            let Some((shape, shape_from_stored)) = kept[shape as usize] else { continue };
            let world_from_shape = if is_baked {
                glam::Affine3A::IDENTITY
            } else {
                let moved = DAffine3 { translation: file_from_shape.translation - origin, ..file_from_shape };
                let world_from_stored = moved * shape_from_stored;
                single(DAffine3::from_scale(DVec3::splat(1.0 / unit)) * world_from_stored)
            };
            let (name, path) = (names.number(name), names.number(path));
            placed.push(Part { shape, material, name, path, file, world_from_shape });
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

/// How the positions of a shape are stored, and what brings those back to the coordinates of the file's shape.
fn placing(frame: &Frame, is_shared: bool, unit: f64, origin: DVec3) -> (Placing, DAffine3) {
    let to_units = 1.0 / (frame.scale() * unit);
    if !is_shared {
        return (Placing { scale: to_units, middle: (frame.middle() - origin) / unit }, DAffine3::IDENTITY);
    }
    let scale = if COMMON_SIZES.contains(&(frame.half() / unit)) { to_units } else { 1.0 };
    let back = 1.0 / (frame.scale() * scale);
    let shape_from_stored = DAffine3::from_scale(DVec3::splat(back));
    (Placing { scale, middle: DVec3::ZERO }, DAffine3 { translation: frame.middle(), ..shape_from_stored })
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
    if let [part] = parts {
        return shapes[part.shape as usize].sphere;
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
        if part.world_from_shape != glam::Affine3A::IDENTITY {
            num_measured += shape.positions.len();
        }
        if num_measured > MOST_MEASURED {
            (reach, farthest) = (bound, None);
            continue;
        }
        for &p in &shape.positions {
            let p = part.world_from_shape.transform_point3(p);
            let distance = p.distance(center);
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
