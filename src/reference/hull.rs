//! Hull outlines: the far sides of enlarged copies [Prost2016 §4.1], as ray casts.
//!
//! How large a copy is belongs to what is drawn, not to how: the same sizes as in `shaders/lib/hull.wgsl`,
//! `shaders/objects/connector.wgsl` and `shaders/objects/mesh.wgsl`, in double precision.

use glam::{DVec2, DVec3};

use super::primitive::{Ray, cone_span, sphere_span, triangle_hit};
use super::world::World;
use super::{Material, Optics};
use crate::scene::unpack_hull;

/// A line in pixels is never wider than this share of the radius that it outlines.
const SHARE: f64 = 0.4;
/// The same of connectors, which are thin.
const CONNECTOR_SHARE: f64 = 1.0;
/// The same of the radius of a mesh's part.
const SHELL_SHARE: f64 = 0.25;

/// One enlarged copy.
#[derive(Debug, Clone, Copy)]
pub struct Outline {
    shape: Shape,
    /// Index into the materials.
    pub material: u32,
    /// The object that it is of, as [`super::world::Surface::id`] counts.
    pub owner: u64,
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    Sphere {
        center: DVec3,
        radius: f64,
    },
    Cone {
        ends: [DVec3; 2],
        radii: [f64; 2],
    },
    /// Wound so that what faces the eye is the near side, which does not show; `behind` is how much deeper each corner counts.
    Facet {
        corners: [DVec3; 3],
        behind: DVec3,
    },
}

impl Outline {
    /// A box around it.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        match self.shape {
            Shape::Sphere { center, radius } => (center - radius, center + radius),
            Shape::Cone { ends: [a, b], radii } => {
                let radius = radii[0].max(radii[1]);
                (a.min(b) - radius, a.max(b) + radius)
            }
            Shape::Facet { corners: [a, b, c], .. } => (a.min(b).min(c), a.max(b).max(c)),
        }
    }

    /// How deep it counts along a line of sight: at least as deep as it lies. Only the far side shows, and only of what is in
    /// front of the eye.
    pub fn depth(&self, ray: Ray, near: f64) -> Option<f64> {
        let far_side = |[enter, leave]: [f64; 2]| (enter > near).then_some(leave);
        match self.shape {
            Shape::Sphere { center, radius } => far_side(sphere_span(ray, center, radius)?),
            Shape::Cone { ends: [a, b], radii } => far_side(cone_span(ray, a, b, radii)?),
            Shape::Facet { corners, behind } => {
                let [a, b, c] = corners;
                if (b - a).cross(c - a).dot(ray.direction) <= 0.0 {
                    return None;
                }
                let (t, shares) = triangle_hit(ray, corners)?;
                (t > near).then(|| t + shares.dot(behind))
            }
        }
    }
}

/// The outlines of all objects whose material has one.
pub fn outlines(world: &World, materials: &[Material], optics: &Optics) -> Vec<Outline> {
    let width =
        |material: u32| materials.get(material as usize).and_then(|material| material.hull).map(|hull| hull.width);
    let (spheres, cylinders) = world.objects();
    let mut outlines = Vec::new();
    for (index, ball) in (0u64..).zip(spheres) {
        if let Some(width) = width(ball.look.material) {
            let (center, radius) = around_sphere(optics, ball.center, ball.radius, width);
            outlines.push(Outline {
                shape: Shape::Sphere { center, radius },
                material: ball.look.material,
                owner: 1 << 32 | index,
            });
        }
    }
    for (index, rod) in (0u64..).zip(cylinders) {
        let material = rod.looks[0].material;
        if let Some(width) = width(material) {
            let axis = (rod.ends[1] - rod.ends[0]).normalize_or(DVec3::X);
            let radii = rod.ends.map(|end| around_cylinder(optics, end, axis, rod.radius, width));
            outlines.push(Outline { shape: Shape::Cone { ends: rod.ends, radii }, material, owner: 2 << 32 | index });
        }
    }
    for (index, (meshes, part, view_from_shape)) in (0u64..).zip(world.parts()) {
        let material = part.look.material;
        let Some((width_px, width_world)) = width(material) else { continue };
        let of_scene = &meshes.scene.assembly.parts[part.part as usize];
        let shape = &meshes.scene.assembly.shapes[of_scene.shape as usize];
        let matrix = view_from_shape.matrix3;
        let volume = matrix.determinant();
        let scale = volume.abs().cbrt();
        let radius = f64::from(shape.sphere.radius) * scale;
        // As normals turn, without the part's scale, of which the cofactors have the square.
        let cofactors = glam::DMat3::from_cols(
            matrix.y_axis.cross(matrix.z_axis),
            matrix.z_axis.cross(matrix.x_axis),
            matrix.x_axis.cross(matrix.y_axis),
        ) * (volume.signum() / (scale * scale).max(1e-30));
        let moved = |vertex: u32| {
            let place = view_from_shape.transform_point3(shape.positions[vertex as usize].as_dvec3());
            let line = width_px * optics.pixel(-place.z);
            let width = (width_world + line).min(SHELL_SHARE * radius);
            (place + cofactors * (unpack_hull(shape.hulls[vertex as usize]).as_dvec3() * width), width)
        };
        outlines.extend(shape.triangles.iter().map(|vertices| {
            let [a, b, c] = vertices.map(moved);
            // A mirrored part is wound the other way.
            let [b, c] = if volume < 0.0 { [c, b] } else { [b, c] };
            Outline {
                shape: Shape::Facet { corners: [a.0, b.0, c.0], behind: DVec3::new(a.1, b.1, c.1) },
                material,
                owner: 3 << 32 | index,
            }
        }));
    }
    outlines
}

/// Centre and radius of a larger sphere whose outline in the picture lies a width outside that of a sphere.
fn around_sphere(optics: &Optics, center: DVec3, radius: f64, (width_px, width_world): (f64, f64)) -> (DVec3, f64) {
    let wide = radius + width_world;
    let line = width_px * optics.pixel_view;
    if optics.orthographic {
        return (center, wide + line.min(SHARE * wide));
    }
    let distance = center.length();
    if distance <= wide {
        return (center, wide);
    }
    let sine = wide / distance;
    let spread = sine / (1.0 - sine * sine).max(1e-6).sqrt();
    let step = line.min(SHARE * spread);
    let off = center.truncate().length();
    let tilt = off / (-center.z).max(1e-3 * distance);
    if tilt * spread > 0.8 || center.z >= 0.0 {
        let grown = spread + step;
        return (center, distance * grown / (1.0 + grown * grown).sqrt());
    }
    let high = DVec2::new((tilt + spread) / (1.0 - tilt * spread) + step, 1.0).normalize();
    let low = DVec2::new((tilt - spread) / (1.0 + tilt * spread) - step, 1.0).normalize();
    let toward = (high + low).normalize();
    let outwards = center.truncate() / off.max(1e-6 * distance);
    (distance * (outwards * toward.x).extend(-toward.y), 0.5 * distance * (high - low).length())
}

/// The radius at one end of a cylinder that moves its outline there by a width.
fn around_cylinder(optics: &Optics, end: DVec3, axis: DVec3, radius: f64, (width_px, width_world): (f64, f64)) -> f64 {
    let wide = radius + width_world;
    if optics.orthographic {
        return wide + (width_px * optics.pixel_view).min(CONNECTOR_SHARE * wide);
    }
    let depth = (-end.z).max(optics.near);
    let toward = end.normalize_or(DVec3::NEG_Z);
    let across = axis.cross(toward);
    let side = across / across.length().max(0.1);
    let projected = |way: DVec3| way.truncate() - toward.truncate() / toward.z * way.z;
    let (moved, axis_moved) = (projected(side), projected(axis));
    let step = moved.perp_dot(axis_moved).abs() / axis_moved.length().max(1e-4);
    wide + (width_px * optics.pixel_view * depth / step.max(0.2)).min(CONNECTOR_SHARE * wide)
}
