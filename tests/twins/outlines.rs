//! Widths of both outlines of `toon`, measured in pictures along lines across them.

use super::gpu;
use super::truth::{Shape, World};
use glam::DVec2;
use restyle::scene::Image;

const SIZE: [u32; 2] = [512, 512];
/// Enough that a line's ends hold their place to a sixteenth of a pixel.
const SAMPLES: u32 = 16;
/// Pixels by which a width may be off.
const WIDTH_PX: f64 = 0.5;
/// Steps of a line in pixels; the bilinear picture below changes by at most 1 per pixel.
const STEP_PX: f64 = 0.02;

/// Each of the three colours is one channel of light: outline red, surface green, background blue.
fn style(camera: &str, atom_radius: f64, properties: &str) -> String {
    format!(
        r##"{{"camera": {{"bgcolor": "#0000ff", {camera}}},
            "geometry": {{"atom": "{atom_radius}A", "scale": 1, "bond_radius": "{BOND_RADIUS}A"}},
            "mapping": {{"*": "t"}}, "lights": [{{"type": "directional", "position": [0, 0, 1]}}],
            "shaders": [{{"name": "t", "shader": "toon", "properties":
                {{"steps": 1, "base_color": "#00ff00", "color": "#ff0000", {properties}}}}}]}}"##
    )
}

const BOND_RADIUS: f64 = 0.3;

/// Integral of a property along a line of the picture, in pixels.
fn integral(from: DVec2, to: DVec2, value: impl Fn(DVec2) -> f64) -> f64 {
    let count = (from.distance(to) / STEP_PX).ceil();
    let sum: f64 = (0..count as u32).map(|i| value(from.lerp(to, (f64::from(i) + 0.5) / count))).sum();
    sum * from.distance(to) / count
}

/// Red light between the pixels' centres, bilinear: a line across an edge integrates to the edge's place.
struct Red {
    light: Vec<f64>,
}

impl Red {
    fn new(image: &Image) -> Red {
        Red { light: gpu::channel(image, 0) }
    }

    fn at(&self, position_px: DVec2) -> f64 {
        let low = (position_px - 0.5).floor();
        let part = position_px - 0.5 - low;
        let [x, y] = low.to_array();
        let texel = |x: f64, y: f64| {
            let inside = (0.0..f64::from(SIZE[0])).contains(&x) && (0.0..f64::from(SIZE[1])).contains(&y);
            if inside { self.light[y as usize * SIZE[0] as usize + x as usize] } else { 0.0 }
        };
        let row = |y| texel(x, y) * (1.0 - part.x) + texel(x + 1.0, y) * part.x;
        row(y) * (1.0 - part.y) + row(y + 1.0) * part.y
    }
}

/// Lines across the outline: from the middle of a sphere outwards, or from half-way along a connector to both sides.
fn lines(world: &World) -> Vec<(DVec2, DVec2)> {
    let bond = world.shapes.iter().find_map(|(_, shape)| match *shape {
        Shape::Cylinder { a, b, .. } => Some((a, b)),
        Shape::Sphere { .. } => None,
    });
    let reach = 0.45 * world.view.size.y;
    match (bond, world.shapes[0].1) {
        (Some((a, b)), _) => {
            let middle = world.view.project(0.5 * (a + b));
            let along = (world.view.project(b) - world.view.project(a)).normalize();
            [along.perp(), -along.perp()].map(|across| (middle, middle + 0.5 * reach * across)).to_vec()
        }
        (None, Shape::Sphere { center, .. }) => {
            let middle = world.view.project(center);
            (0..24)
                .map(|turn| DVec2::from_angle(f64::from(turn) * std::f64::consts::TAU / 24.0))
                .map(|direction| (middle, middle + 1.05 * reach * direction))
                .collect()
        }
        _ => unreachable!("the first shape is an atom"),
    }
}

/// Largest difference between the outline's width in the picture and `expected` of each line.
fn worst(
    atoms: &[&str],
    atom_radius: f64,
    camera: &str,
    properties: &str,
    expected: impl Fn(&World, DVec2, DVec2) -> f64,
) -> Option<f64> {
    let mut engine = gpu::engine(atoms, &style(camera, atom_radius, properties))?;
    let red = Red::new(&gpu::still(&mut engine, SIZE, SAMPLES));
    let world = World::new(&engine, SIZE, &vec![atom_radius; atoms.len()], BOND_RADIUS);
    let errors = lines(&world).into_iter().map(|(from, to)| {
        let width = expected(&world, from, to);
        assert!(width > 0.5, "no outline to measure: {width} px");
        (integral(from, to, |at| red.at(at)) - width).abs()
    });
    errors.reduce(f64::max)
}

/// Width along a line of where the surface turns away from the viewer by more than the threshold, in exact geometry.
fn turned_away(world: &World, from: DVec2, to: DVec2, threshold: f64) -> f64 {
    integral(from, to, |at| {
        let Some((_, _, hit)) = world.seen(at) else { return 0.0 };
        let facing = -hit.normal.dot(world.view.ray(at).direction.normalize());
        if facing < threshold { 1.0 } else { 0.0 }
    })
}

const SPHERE: &[&str] = &["C 0 0 0"];
const SPHERE_RADIUS: f64 = 1.5;
/// Smaller than the bond between them, which is seen whole.
const PAIR_RADIUS: f64 = 0.1;
const SIDEWAYS: &[&str] = &["C -0.7 -0.3 0", "C 0.7 0.3 0"];
const SLANTED: &[&str] = &["C -0.5 -0.3 -0.5", "C 0.5 0.3 0.5"];

const CAMERAS: [(&str, &str); 3] = [
    ("orthographic", r#""orthographic": true"#),
    ("perspective", r#""fov": 35"#),
    ("perspective, off the axis", r#""fov": 60, "position": [0, 0, 3], "target": [0.6, 0.4, 0]"#),
];

const OBJECTS: [(&str, &[&str], f64); 3] = [
    ("sphere", SPHERE, SPHERE_RADIUS),
    ("connector sideways", SIDEWAYS, PAIR_RADIUS),
    ("connector slanted", SLANTED, PAIR_RADIUS),
];

#[test]
fn dot_outline_is_as_wide_as_the_geometry_says() {
    for (object, atoms, radius) in OBJECTS {
        for (name, camera) in CAMERAS {
            for threshold in [0.25, 0.35, 0.5] {
                let expected = |world: &World, from, to| turned_away(world, from, to, threshold);
                let outline = format!(r#""outline_bias": {threshold}"#);
                let Some(worst) = worst(atoms, radius, camera, &outline, expected) else { return };
                eprintln!("dot outline {threshold} of a {object}, {name}: off by at most {worst:.3} px");
                assert!(worst <= WIDTH_PX, "{object}, {name}, {threshold}: {worst} px");
            }
        }
    }
}

#[test]
fn dot_outline_of_a_sphere_is_a_ring_from_r_sqrt_1_minus_t2_to_r() {
    let world_radius = |world: &World| SPHERE_RADIUS / world.view.pixel_view();
    for threshold in [0.25f64, 0.35, 0.5] {
        let expected = |world: &World, _, _| world_radius(world) * (1.0 - (1.0 - threshold * threshold).sqrt());
        let outline = format!(r#""outline_bias": {threshold}"#);
        let Some(worst) = worst(SPHERE, SPHERE_RADIUS, CAMERAS[0].1, &outline, expected) else { return };
        assert!(worst <= WIDTH_PX, "{threshold}: {worst} px");
    }
}

#[test]
fn hull_outline_is_as_wide_as_written() {
    for (object, atoms, radius) in OBJECTS {
        for (name, camera) in CAMERAS {
            for width_px in [2.0, 5.0, 10.0] {
                // A point is a 1080th of the picture's height.
                let hull = format!(r#""hull_size": "{}pt""#, width_px * 1080.0 / f64::from(SIZE[1]));
                let Some(worst) = worst(atoms, radius, camera, &hull, |_, _, _| width_px) else { return };
                eprintln!("hull {width_px} px of a {object}, {name}: off by at most {worst:.3} px");
                assert!(worst <= WIDTH_PX, "{object}, {name}, {width_px} px: {worst} px");
            }
        }
    }
}
