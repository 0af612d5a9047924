//! Curvature from neighbouring pixels: on a triangle as the twin finds it, of one object alone, and across bands.

use std::fmt::Write as _;

use glam::{DVec2, DVec3};
use restyle::engine::{Engine, Request};
use restyle::scene::Scene;
use restyle::scene::mesh::unpack_normal;

use super::curvature::{SHADES, kappa_of_shade, load, shipped};
use super::gpu;
use super::truth::{View, center_px};

/// A triangle in view space as `shaders/lib/mesh_point.wgsl` sees it with an orthographic camera.
struct Triangle {
    corners: [DVec3; 3],
    normals: [DVec3; 3],
}

/// What a pixel sees of one.
struct OnTriangle {
    normal: DVec3,
    depth: f64,
    /// Change of the depth for a pixel to the right and down on the tangent plane.
    slope: [f64; 2],
    /// Change of the shares of the second and third corner for a pixel to the right and down.
    grow: [[f64; 2]; 2],
    /// Change of the normal for the same.
    turn: [DVec3; 2],
    /// How far the nearest edge or silhouette is, in pixels.
    rim_px: f64,
}

impl Triangle {
    fn at(&self, view: &View, position_px: DVec2) -> Option<OnTriangle> {
        if position_px.cmplt(DVec2::ZERO).any() || position_px.cmpgt(view.size).any() {
            return None;
        }
        let ray = view.ray(position_px);
        // Shares by areas of what is seen.
        let [a, b, c] = self.corners.map(|corner| (corner - ray.origin).truncate());
        let whole = (b - a).perp_dot(c - a);
        let shares = [b.perp_dot(c), c.perp_dot(a), a.perp_dot(b)].map(|area| area / whole);
        if shares.iter().any(|share| *share < 0.0) {
            return None;
        }
        let mixed: DVec3 = (0..3).map(|corner| shares[corner] * self.normals[corner]).sum();
        let (normal, length) = (mixed.normalize(), mixed.length());
        let [along_b, along_c] = [1, 2].map(|corner| self.corners[corner] - self.corners[0]);
        let across = along_b.cross(along_c);
        let share_of = [along_c.cross(across), across.cross(along_b)].map(|to| to / across.length_squared());
        // A step on the tangent plane.
        let pixel = view.pixel_view();
        let steps = [DVec3::X * pixel, DVec3::NEG_Y * pixel]
            .map(|moved| moved - ray.direction * (normal.dot(moved) / normal.dot(ray.direction)));
        let grow = steps.map(|step| share_of.map(|share| share.dot(step)));
        let turn = grow.map(|[b, c]| {
            let change = (b * (self.normals[1] - self.normals[0]) + c * (self.normals[2] - self.normals[0])) / length;
            change - normal * normal.dot(change)
        });
        let facing_step = turn.map(|change| change.dot(-ray.direction));
        let silhouette = 0.5 * normal.dot(-ray.direction) / facing_step[0].hypot(facing_step[1]);
        // In pixels shares are linear.
        let of_a = grow.map(|[b, c]| -b - c);
        let gradients = [of_a, [grow[0][0], grow[1][0]], [grow[0][1], grow[1][1]]];
        let edge = |corner: usize| shares[corner] / gradients[corner][0].hypot(gradients[corner][1]);
        let point: DVec3 = (0..3).map(|corner| shares[corner] * self.corners[corner]).sum();
        let slope = steps.map(|step| -step.z);
        Some(OnTriangle {
            normal,
            depth: -point.z,
            slope,
            grow,
            turn,
            rim_px: edge(0).min(edge(1)).min(edge(2)).min(silhouette),
        })
    }

    /// `change_along` of `shaders/layers/neighbours.wgsl` along an axis, by pixel, and over how many pixels to each side, 0 where it is
    /// the triangle's own; none where a neighbour is missing, or where rounding decides.
    fn change(&self, view: &View, position_px: DVec2, axis: usize) -> Option<(DVec3, f64)> {
        let own = self.at(view, position_px)?;
        // Whether a pixel on the border sees the triangle is up to rounding.
        if own.rim_px < 1.5 {
            return None;
        }
        let [b, c] = own.grow[axis];
        let wide = (0.75 / b.abs().max(c.abs()).max((b + c).abs())).min(own.rim_px).clamp(1.0, 8.0);
        if (wide - wide.round()).abs() < 0.02 && wide > 1.0 && wide < 8.0 {
            return None;
        }
        let along = [DVec2::X, DVec2::Y][axis];
        let slope = own.slope[axis];
        let reach = view.pixel_view() + slope.abs();
        // How far the neighbours are from the tangent plane, over how far they may be, and their normals.
        let sides = |step: f64| {
            let sides = [-step, step].map(|step| {
                let side = self.at(view, position_px + step * along)?;
                Some(((side.depth - own.depth - step * slope).abs() / reach, side.normal))
            });
            Some([sides[0]?, sides[1]?])
        };
        let step = wide.floor();
        let [before, after] = sides(step)?;
        let uneven = (after.1 + before.1 - 2.0 * own.normal).length() / (after.1 - before.1).length();
        for (share, most) in [(uneven, 0.15), (before.0, 1.0), (after.0, 1.0)] {
            if (share / most - 1.0).abs() < 0.02 {
                return None;
            }
            if share > most && step > 1.0 {
                return Some((own.turn[axis], 0.0));
            }
        }
        if before.0.max(after.0) > 1.0 {
            return None;
        }
        Some(((after.1 - before.1) / (2.0 * step), step))
    }
}

#[test]
fn neighbours_on_a_triangle_are_asked_as_the_twin_does() {
    let Some(gpu) = gpu::device() else { return };
    // One whose slope changes evenly, and one whose normals turn by more than half a right angle.
    for (normals, gain) in
        [(["-0.3 0.1 1", "0.35 0.2 1", "0.1 -0.25 1"], 0.4), (["-2 0.1 1", "0.1 0.2 1", "0.4 -2 0.8"], 0.04)]
    {
        let [a, b, c] = normals;
        let text = format!("v 0 0 0\nv 2 0.2 0.3\nv 0.7 1.8 -0.2\nvn {a}\nvn {b}\nvn {c}\nf 1//1 2//2 3//3\n");
        let scene = Scene::from_bytes("one.obj", text.as_bytes()).expect("a triangle");
        let style = load(&format!(
            r##"{{ "camera": {{ "orthographic": true, "position": [0.1, 0.2, 2], "bgcolor": "black" }}, "mapping": {{ "*": "c" }},
              "shaders": [{{ "name": "c", "shader": "curvature", "properties": {{ {SHADES}, "gain": {gain}, "curvature_source": "screen" }} }}] }}"##
        ));
        let mut engine = Engine::new(gpu.clone(), scene, style);
        let size = [40, 30];
        let image = engine.still(&Request { wide: true, ..Request::new(size, 1) }).expect("a still");
        let scale = gain * engine.curvature_scale().expect("a scale");
        let camera = engine.camera(size).expect("a camera");
        let view = View::new(&camera, size);
        let assembly = &engine.scene().expect("a scene").assembly;
        let world_from_shape = assembly.parts[0].world_from_shape;
        let shape = &assembly.shapes[0];
        let corner = |corner: usize| shape.triangles[0][corner] as usize;
        let triangle = Triangle {
            corners: [0, 1, 2].map(|index| {
                let world = world_from_shape.transform_point3(shape.positions[corner(index)]);
                camera.view_from_world.as_dmat4().transform_point3(world.as_dvec3())
            }),
            normals: [0, 1, 2].map(|index| {
                let normal = unpack_normal(shape.normals[corner(index)]).as_dvec3();
                camera.view_from_world.as_dmat4().transform_vector3(normal)
            }),
        };
        let (mut largest, mut most, mut widest, mut count) = (0.0f64, 0.0f64, 0.0f64, 0);
        for at in gpu::pixels(size) {
            let px = center_px(at);
            let changes = [0, 1].map(|axis| triangle.change(&view, px, axis));
            let [Some((dx, step)), Some((down, _))] = changes else { continue };
            let due = -(dx.x - down.y) / view.pixel_view();
            let found = kappa_of_shade(gpu::linear_from_srgb(image.pixel(at.0, at.1)[0])) / scale;
            largest = largest.max((found - due).abs());
            most = most.max(due.abs());
            widest = widest.max(step);
            count += 1;
        }
        eprintln!("{normals:?}: {largest} of {most} over {count} pixels");
        assert!(count > 300 && most > 0.1 && widest >= 7.0, "{count} pixels, {most}, over {widest}");
        assert!(largest < 0.001 * most, "{largest} of {most}");
    }
}

/// Two sides of a roof are flat: what is beside a fragment on the other one says nothing of it.
#[test]
fn neighbours_are_of_one_object() {
    let Some(gpu) = gpu::device() else { return };
    let mut text = String::new();
    for (index, side) in [-1.0, 0.0].into_iter().enumerate() {
        let _ = writeln!(text, "o side{index}");
        for [x, y] in [[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]] {
            let x: f64 = x + side;
            let _ = writeln!(text, "v {x} {y} {}", -0.7 * x.abs());
        }
        let first = 4 * index + 1;
        let _ = writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
    }
    let scene = Scene::from_bytes("roof.obj", text.as_bytes()).expect("a roof");
    let style = load(&format!(
        r##"{{ "camera": {{ "orthographic": true, "position": [0.2, 0.3, 2], "bgcolor": "black", "zoom": 3 }}, "mapping": {{ "*": "c" }},
          "shaders": [{{ "name": "c", "shader": "curvature", "properties": {{ {SHADES}, "curvature_source": "screen" }} }}] }}"##
    ));
    let mut engine = Engine::new(gpu, scene, style);
    let image = engine.still(&Request { wide: true, ..Request::new([128, 96], 1) }).expect("a still");
    let light = gpu::linear_from_srgb(128.0 / 255.0);
    for (index, shade) in gpu::channel(&image, 0).into_iter().enumerate() {
        assert!((shade - light).abs() < 1e-3, "pixel {index}: {shade} instead of {light}");
    }
}

#[test]
fn neighbours_are_found_across_bands() {
    let Some(gpu) = gpu::device() else { return };
    let style = |memory_mb: u32| {
        load(&format!(
            r##"{{ "transparency": {{ "memory_mb": {memory_mb} }}, "mapping": {{ "*": "c" }}, "shaders": [{{ "name": "c", "shader": "curvature",
              "properties": {{ "opacity_transfer": "fig7b", "curvature_source": "screen" }} }}] }}"##
        ))
    };
    let pixels = |size: [u32; 2], memory_mb: u32| {
        let mut engine = Engine::new(gpu.clone(), shipped("gearbox"), style(memory_mb));
        let pixels = engine.still(&Request::new(size, 1)).expect("a still").pixels;
        let layers = engine.target_bytes().iter().find(|(name, _)| *name == "layers").map(|(_, bytes)| *bytes);
        (pixels, layers.expect("layers"))
    };
    let (whole, bytes) = pixels([1000, 1000], 512);
    let (banded, band_bytes) = pixels([1000, 1000], 16);
    assert!(bytes > 32 << 20 && band_bytes < 28 << 20, "{bytes} and {band_bytes}");
    assert_eq!(whole, banded);
}
