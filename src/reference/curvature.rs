//! `curvature`, sample by sample: how a surface bends as it is seen, where its rims are, and what that makes of its light.
//!
//! Curvature is of the object itself: exact of spheres and cylinders, of meshes the one that their vertices have. Formulas are
//! those of `shaders/objects/curvature.wgsl` and `shaders/lib/surface.wgsl`, in double precision.

use glam::{DVec2, DVec3};

use super::Optics;
use super::primitive::Ray;
use super::world::{Hit, Object, Surface, World};
use crate::shading::curvature::{CurvatureMaterial, Transfer};

/// Farther than any rim reaches.
const FAR_PX: f64 = 1e9;
/// Power of the foreshortening, and the least cosine that it is taken of.
const FORESHORTENING: f64 = 0.4;
const LEAST_FACING: f64 = 0.05;

/// A material that weighs light by curvature.
pub struct Stylist {
    /// Its numbers.
    pub material: CurvatureMaterial,
    /// Opacity by the size of curvature, and depth.
    pub opacity: Transfer,
    /// Factor on light by curvature.
    pub color: Transfer,
    /// Middle of the scene's sphere, in view space.
    pub center: DVec3,
}

/// Where a surface stands in the transfer functions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// -1 convex to 1 concave.
    pub kappa: f64,
    /// 0 near to 1 far.
    pub depth: f64,
    /// Share of a sample that a rim takes, 0..1.
    pub rim: f64,
}

impl Stylist {
    /// Where a surface stands; samples are squares of `footprint_px`.
    pub fn bend(
        &self,
        world: &World,
        optics: &Optics,
        ray: Ray,
        hit: Hit,
        surface: &Surface,
        footprint_px: f64,
    ) -> Bend {
        let m = &self.material;
        let bent = bent(world, optics, ray, hit, surface);
        let pixel_world = optics.pixel(hit.t);
        let emphasis = f64::from(m.emphasis);
        let mut kappa = bent.kappa;
        if emphasis > 0.0 {
            kappa += emphasis * (bent.of_picture(surface, ray, pixel_world) - kappa);
        }
        let signed = (f64::from(m.gain) * kappa).tanh();
        let width_px = f64::from(m.contour_px) + f64::from(m.contour_world) / pixel_world;
        let width = width_px / footprint_px;
        let rim = (width - bent.rim_px / footprint_px + 0.5).clamp(0.0, (2.0 * width).min(1.0));
        let depth = 0.5 * ((hit.t + self.center.z) / f64::from(m.radius) + 1.0);
        let depth = ((depth - f64::from(m.depth_start)) * f64::from(m.depth_scale)).clamp(0.0, 1.0);
        Bend { kappa: signed, depth, rim }
    }

    /// Share of what is behind that the surface covers.
    pub fn opacity(&self, bend: Bend) -> f64 {
        f64::from(self.material.opacity) * self.covers(bend).iter().sum::<f64>()
    }

    /// Its light, weighed.
    pub fn weighed(&self, color: DVec3, bend: Bend) -> DVec3 {
        let [of_body, of_rim] = self.covers(bend);
        let [body, rim] =
            [bend.kappa, -f64::from(self.material.contour)].map(|kappa| DVec3::from(self.color.color(kappa)));
        color * body.lerp(rim, of_rim / (of_body + of_rim).max(1e-12))
    }

    /// What the surface beside its rim covers, and its rim.
    fn covers(&self, bend: Bend) -> [f64; 2] {
        [(bend.kappa.abs(), 1.0 - bend.rim), (f64::from(self.material.contour), bend.rim)].map(|(curvature, share)| {
            if share > 0.0 { share * self.opacity.opacity(curvature, bend.depth) } else { 0.0 }
        })
    }
}

/// How a surface bends where a line of sight meets it.
#[derive(Debug, Clone, Copy)]
pub struct Bent {
    /// Sum of the principal curvatures as it is seen, negative where convex, over scene units.
    pub kappa: f64,
    /// How far the nearest silhouette or crease is in the picture.
    pub rim_px: f64,
    /// How fast the cosine between surface and view changes over a pixel to the right and down.
    facing_step: DVec2,
}

impl Bent {
    /// Curvature as the picture has it [Vergne2009 §3].
    fn of_picture(&self, surface: &Surface, ray: Ray, pixel_world: f64) -> f64 {
        let to_viewer = -ray.direction.normalize();
        let facing = surface.normal.dot(to_viewer).max(LEAST_FACING);
        let across = surface.normal - facing * to_viewer;
        let turn = across.truncate().dot(self.facing_step * DVec2::new(1.0, -1.0) / pixel_world);
        (self.kappa + FORESHORTENING * turn / facing) / facing.powf(FORESHORTENING)
    }
}

/// How the surface bends that a line of sight met.
pub fn bent(world: &World, optics: &Optics, ray: Ray, hit: Hit, surface: &Surface) -> Bent {
    let steps = [DVec3::X, DVec3::NEG_Y].map(|step| step * optics.pixel_view);
    let moved = steps.map(|step| step * if optics.orthographic { 1.0 } else { hit.t });
    let along = moved.map(|moved| tangent_step(ray, surface, moved));
    let to_viewer = -ray.direction.normalize();
    let turning = steps.map(|step| {
        if optics.orthographic {
            return DVec3::ZERO;
        }
        -(step - to_viewer * to_viewer.dot(step)) / ray.direction.length()
    });
    let (kappa, normal_steps, crease_px) = match hit.object {
        Object::Triangle(index) => mesh(world, index, ray, surface, along),
        object => {
            let sign = if world.outward(object, surface.position).dot(ray.direction) > 0.0 { -1.0 } else { 1.0 };
            let axis = world.axis(object);
            let both = if matches!(object, Object::Sphere(_)) { 2.0 } else { 1.0 };
            let steps = along.map(|step| sign * surface.bend * (step - axis * axis.dot(step)));
            (-sign * surface.bend * both, steps, FAR_PX)
        }
    };
    let step = |axis: usize| normal_steps[axis].dot(to_viewer) + surface.normal.dot(turning[axis]);
    let facing_step = DVec2::new(step(0), step(1));
    let silhouette_px = 0.5 * surface.normal.dot(to_viewer) / facing_step.length().max(1e-12);
    Bent { kappa, rim_px: silhouette_px.min(crease_px), facing_step }
}

/// Where the point moves on the tangent plane when its line of sight moves.
fn tangent_step(ray: Ray, surface: &Surface, moved: DVec3) -> DVec3 {
    let least = (0.5 * surface.bend * moved.length()).sqrt().max(1e-4);
    let facing = surface.normal.dot(ray.direction);
    moved - ray.direction * (surface.normal.dot(moved) / facing.min(-least))
}

/// Curvature of a triangle, the change of its normal over both steps, and the distance of its nearest crease.
fn mesh(world: &World, index: u32, ray: Ray, surface: &Surface, along: [DVec3; 2]) -> (f64, [DVec3; 2], f64) {
    let Some(facet) = world.facet(index) else { return (0.0, [DVec3::ZERO; 2], FAR_PX) };
    let [a, b, c] = facet.corners;
    let (to_b, to_c) = (b - a, c - a);
    let across = to_b.cross(to_c);
    let area_squared = across.length_squared().max(f64::MIN_POSITIVE);
    // Gradients of the second and third corner's share, and all shares.
    let (grow_b, grow_c) = (to_c.cross(across) / area_squared, across.cross(to_b) / area_squared);
    let from_a = surface.position - a;
    let (share_b, share_c) = (grow_b.dot(from_a).clamp(0.0, 1.0), grow_c.dot(from_a).clamp(0.0, 1.0));
    let shares = [(1.0 - share_b - share_c).max(0.0), share_b, share_c];
    let mixed = |values: [DVec3; 3]| shares[0] * values[0] + shares[1] * values[1] + shares[2] * values[2];
    let mean = mixed(facet.normals);
    let outwards = if across.dot(ray.direction) > 0.0 { -across } else { across };
    let turned = if mean.dot(outwards) < 0.0 { -1.0 } else { 1.0 } / mean.length().max(1e-6);
    let [na, nb, nc] = facet.normals;
    let normal_steps = along.map(|step| {
        let change = turned * ((nb - na) * grow_b.dot(step) + (nc - na) * grow_c.dot(step));
        change - surface.normal * surface.normal.dot(change)
    });
    let kappa = turned.signum() * (0..3).map(|corner| shares[corner] * facet.kappa[corner]).sum::<f64>();
    // In pixels shares are linear: their gradients give the places of the corners.
    let [grow_b, grow_c] = [grow_b, grow_c].map(|grow| DVec2::new(grow.dot(along[0]), grow.dot(along[1])));
    let area = grow_b.perp_dot(grow_c);
    let inverse = 1.0 / if area < 0.0 { area.min(-1e-60) } else { area.max(1e-60) };
    let (along_b, along_c) = (DVec2::new(grow_c.y, -grow_c.x) * inverse, DVec2::new(-grow_b.y, grow_b.x) * inverse);
    let a = -shares[1] * along_b - shares[2] * along_c;
    let corners = [a, a + along_b, a + along_c];
    let edges = (0..3).filter(|edge| facet.creases >> edge & 1 == 1);
    let crease_px = edges.map(|edge| segment_distance(corners[edge], corners[(edge + 1) % 3]));
    // Of a crease beside the triangle its end counts.
    let ends = (0..3).filter(|corner| facet.creases >> (3 + corner) & 1 == 1).map(|corner| corners[corner].length());
    (kappa, normal_steps, crease_px.chain(ends).fold(FAR_PX, f64::min))
}

/// Of the origin from a segment.
fn segment_distance(from: DVec2, to: DVec2) -> f64 {
    let along = to - from;
    let place = (-from.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from + place * along).length()
}
