//! Twin of `shaders/lib/surface.wgsl`: a surface with the derivatives that anti-alias steps in its shading.

use super::truth::{Hit, Ray, Shape, View};
use glam::{DVec2, DVec3, Vec3};

/// `Surface` of the shader.
pub struct Surface {
    pub position_view: Vec3,
    pub normal_view: Vec3,
    pub to_viewer: Vec3,
    pub base_color: Vec3,
    pub position_dx: Vec3,
    pub position_dy: Vec3,
    pub normal_dx: Vec3,
    pub normal_dy: Vec3,
    pub to_viewer_dx: Vec3,
    pub to_viewer_dy: Vec3,
}

fn tangent_step(view: &View, ray: Ray, t: f64, normal: DVec3, bend: f64, step: DVec3) -> DVec3 {
    let moved = if view.orthographic { step } else { step * t };
    let least = (0.5 * bend * moved.length()).sqrt().max(1e-4);
    moved - ray.direction * (normal.dot(moved) / normal.dot(ray.direction).min(-least))
}

fn to_viewer_step(view: &View, ray: Ray, step: DVec3) -> DVec3 {
    if view.orthographic {
        return DVec3::ZERO;
    }
    let toward = ray.direction.normalize();
    -(step - toward * toward.dot(step)) / ray.direction.length()
}

/// What the ray of a picture position sees of a shape. `footprint_px`: the side of the square of one sample.
pub fn surface_at(
    view: &View,
    position_px: DVec2,
    shape: &Shape,
    hit: &Hit,
    base_color: Vec3,
    footprint_px: f64,
) -> Surface {
    let ray = view.ray(position_px);
    let turned = if hit.normal.dot(ray.direction) > 0.0 { -1.0 } else { 1.0 };
    let normal = turned * hit.normal;
    let (axis, bend) = match *shape {
        Shape::Sphere { radius, .. } => (DVec3::ZERO, 1.0 / radius),
        Shape::Cylinder { a, b, radius } => ((b - a).normalize(), if hit.cap { 0.0 } else { 1.0 / radius }),
    };
    let step = DVec2::new(2.0, -2.0) * footprint_px * view.half_extent / view.size;
    let [dx, dy] = [DVec3::X * step.x, DVec3::Y * step.y];
    let [position_dx, position_dy] = [dx, dy].map(|step| tangent_step(view, ray, hit.t, normal, bend, step));
    let turn = |position: DVec3| (turned * bend * (position - axis * axis.dot(position))).as_vec3();
    Surface {
        position_view: (ray.origin + hit.t * ray.direction).as_vec3(),
        normal_view: normal.as_vec3(),
        to_viewer: -ray.direction.normalize().as_vec3(),
        base_color,
        position_dx: position_dx.as_vec3(),
        position_dy: position_dy.as_vec3(),
        normal_dx: turn(position_dx),
        normal_dy: turn(position_dy),
        to_viewer_dx: to_viewer_step(view, ray, dx).as_vec3(),
        to_viewer_dy: to_viewer_step(view, ray, dy).as_vec3(),
    }
}

/// Central differences over a thousandth of a pixel have about half of f64's 16 digits; 1e-5 of the length leaves room.
const DIFFERENCE: f64 = 1e-5;

#[test]
fn derivatives_are_the_limits_of_differences() {
    let sphere = Shape::Sphere { center: DVec3::new(0.7, -0.4, -6.0), radius: 2.0 };
    let cylinder = Shape::Cylinder { a: DVec3::new(-2.0, 0.3, -5.0), b: DVec3::new(2.0, -0.5, -7.0), radius: 0.8 };
    for shape in [sphere, cylinder] {
        for orthographic in [false, true] {
            let half = if orthographic { 3.0 } else { 0.5 };
            let view = View {
                view_from_world: glam::DMat4::IDENTITY,
                half_extent: DVec2::splat(half),
                size: DVec2::splat(100.0),
                orthographic,
                near: 0.1,
            };
            let at = |position: DVec2| {
                let ray = view.ray(position);
                let hit = shape.first(ray, view.near).expect("a hit");
                (ray.origin + hit.t * ray.direction, hit.normal, -ray.direction.normalize())
            };
            let position = DVec2::new(58.0, 51.0);
            let hit = shape.first(view.ray(position), view.near).expect("a hit");
            let s = surface_at(&view, position, &shape, &hit, Vec3::ONE, 1.0);
            let steps = [
                (DVec2::X, s.position_dx, s.normal_dx, s.to_viewer_dx),
                (DVec2::Y, s.position_dy, s.normal_dy, s.to_viewer_dy),
            ];
            for (step, position_step, normal_step, viewer_step) in steps {
                let (before, after) = (at(position - 1e-3 * step), at(position + 1e-3 * step));
                let near = |found: Vec3, a: DVec3, b: DVec3| {
                    let truth = (b - a) / 2e-3;
                    let error = (found.as_dvec3() - truth).length();
                    assert!(error <= DIFFERENCE * truth.length().max(1e-3), "{found} {truth}");
                };
                near(position_step, before.0, after.0);
                near(normal_step, before.1, after.1);
                near(viewer_step, before.2, after.2);
            }
        }
    }
}
