//! Atoms and connectors on the GPU against ray casts in f64: depth, normal and silhouette.

use super::gpu;
use super::truth::{World, center_px, distance_to_change};
use restyle::scene::AovImage;

const SIZE: [u32; 2] = [320, 256];
/// Of the depth: 168 steps of f32, some 20 operations on values about as large as the scene.
const DEPTH: f64 = 1e-5;
/// Degrees. f32 holds a unit vector to 1e-5 degrees; a depth off by [`DEPTH`] turns a small sphere by more.
const NORMAL_DEG: f64 = 0.01;
/// Pixels. A pixel is drawn where its centre is, so a correct mask is off by rounding alone.
const SILHOUETTE_PX: f64 = 0.5;
/// Depth along the ray grows without bound towards the silhouette; from here inwards it must hold.
const FACING: f64 = 0.1;

/// What was reached.
#[derive(Debug, Default)]
struct Errors {
    depth: f64,
    normal_deg: f64,
    silhouette_px: f64,
    /// Pixels compared, so that an empty picture does not pass.
    compared: u32,
}

fn errors(world: &World, image: &AovImage) -> Errors {
    let mut errors = Errors::default();
    for (index, pixel) in gpu::pixels(image.size).enumerate() {
        let at = center_px(pixel);
        let seen = world.seen(at);
        let id = seen.map_or(0, |(id, ..)| id);
        if image.ids[index] != id {
            let seen_id = |at| world.seen(at).map_or(0, |(id, ..)| id);
            let off = distance_to_change(at, SILHOUETTE_PX, seen_id).unwrap_or(f64::INFINITY);
            errors.silhouette_px = errors.silhouette_px.max(off);
            continue;
        }
        let Some((_, _, hit)) = seen else {
            assert_eq!(image.depth[index], f32::INFINITY);
            continue;
        };
        let direction = world.view.ray(at).direction.normalize();
        let facing = hit.normal.dot(direction);
        if facing.abs() < FACING {
            continue;
        }
        let normal = -facing.signum() * hit.normal;
        let drawn = glam::Vec3::from_slice(&image.normal[3 * index..3 * index + 3]).as_dvec3();
        assert!((drawn.length() - 1.0).abs() < 1e-4, "{drawn} is no unit vector");
        // The sine of a small angle keeps its digits, a cosine does not.
        let turn = drawn.cross(normal).length().atan2(drawn.dot(normal)).to_degrees();
        errors.normal_deg = errors.normal_deg.max(turn);
        errors.depth = errors.depth.max((f64::from(image.depth[index]) / hit.t - 1.0).abs());
        errors.compared += 1;
    }
    errors
}

/// Draws atoms of `atom_radius` and bonds of `bond_radius` through `camera` and holds them to the truth.
fn check(name: &str, atoms: &[&str], atom_radius: f64, bond_radius: f64, camera: &str) {
    let style = format!(
        r#"{{"camera": {{{camera}}},
            "geometry": {{"atom": "{atom_radius}A", "scale": 1, "bond_radius": "{bond_radius}A"}},
            "mapping": {{"*": "unlit"}}}}"#
    );
    let Some(mut engine) = gpu::engine(atoms, &style) else { return };
    let image = gpu::aovs(&mut engine, SIZE);
    let world = World::new(&engine, SIZE, &vec![atom_radius; atoms.len()], bond_radius);
    let errors = errors(&world, &image);
    eprintln!(
        "{name}: depth {:.1e}, normal {:.5} degrees, silhouette {:.3} px over {} pixels",
        errors.depth, errors.normal_deg, errors.silhouette_px, errors.compared
    );
    assert!(errors.compared > 500, "{name}: {errors:?}");
    assert!(errors.depth <= DEPTH, "{name}: {errors:?}");
    assert!(errors.normal_deg <= NORMAL_DEG, "{name}: {errors:?}");
    assert!(errors.silhouette_px <= SILHOUETTE_PX, "{name}: {errors:?}");
}

const ONE: &[&str] = &["C 0.3 -0.2 0.1"];
/// Bonded, along x, y and z by `pair`.
fn pair(axis: [f64; 3]) -> [String; 2] {
    let [x, y, z] = axis.map(|c| 0.75 * c);
    [format!("C {} {} {}", -x, -y, -z), format!("C {x} {y} {z}")]
}

fn check_pair(name: &str, axis: [f64; 3], camera: &str) {
    let atoms = pair(axis);
    check(name, &atoms.each_ref().map(String::as_str), 0.2, 0.15, camera);
}

#[test]
fn a_sphere_is_exact_in_the_middle() {
    check("sphere, perspective", ONE, 1.4, 0.14, r#""fov": 35"#);
    check("sphere, orthographic", ONE, 1.4, 0.14, r#""orthographic": true"#);
}

#[test]
fn a_sphere_is_exact_in_the_corner_of_a_wide_view() {
    let camera = r#""fov": 90, "position": [0, 0, 3], "target": [2.2, 1.7, 0]"#;
    check("sphere in the corner, 90 degrees", ONE, 1.4, 0.14, camera);
    let camera = r#""fov": 130, "position": [0, 0, 1.2], "target": [1.5, 0.9, 0]"#;
    check("large sphere at the border, 130 degrees", ONE, 1.4, 0.14, camera);
}

#[test]
fn a_sphere_is_exact_from_inside() {
    let camera = r#""fov": 90, "position": [0.2, 0.1, 0.3], "target": [0, 0.2, -1]"#;
    check("camera inside the sphere", ONE, 1.4, 0.14, camera);
}

#[test]
fn a_sphere_just_before_the_eye_is_exact() {
    // Nearer still, the place of the sphere itself has too few digits in f32: 3e-5 at half a percent.
    let camera = r#""fov": 60, "position": [0, 0, 1.02]"#;
    check("camera 2 percent of a radius from the sphere", ONE, 1.7, 0.14, camera);
}

#[test]
fn a_small_sphere_far_away_is_exact() {
    check("sphere at 60 radii", ONE, 1.4, 0.14, r#""fov": 2"#);
    check("two spheres that intersect", &["C 0 0 0", "C 1 0.4 0.9"], 1.0, 0.14, r#""fov": 35"#);
}

#[test]
fn a_connector_is_exact_sideways() {
    check_pair("connector sideways, perspective", [1.0, 0.0, 0.0], r#""fov": 35"#);
    check_pair("connector sideways, orthographic", [1.0, 0.0, 0.0], r#""orthographic": true"#);
}

#[test]
fn a_connector_is_exact_slanted() {
    check_pair("connector slanted, perspective", [0.6, 0.5, 0.62], r#""fov": 60"#);
    check_pair("connector slanted, orthographic", [0.6, 0.5, 0.62], r#""orthographic": true"#);
    let camera = r#""fov": 90, "position": [0, 0, 1.4], "target": [0.8, 0.6, 0]"#;
    check_pair("connector slanted in the corner, 90 degrees", [0.6, -0.5, 0.62], camera);
}

#[test]
fn a_connector_is_exact_nearly_end_on() {
    // Atoms smaller than the bond leave its caps in sight.
    for (name, camera) in [
        ("end-on, perspective", r#""fov": 35, "zoom": 4"#),
        ("end-on, orthographic", r#""orthographic": true, "zoom": 4"#),
    ] {
        let atoms = pair([0.05, 0.03, 0.998]);
        check(&format!("connector {name}"), &atoms.each_ref().map(String::as_str), 0.1, 0.3, camera);
        let atoms = pair([0.0, 0.0, 1.0]);
        check(&format!("connector exactly {name}"), &atoms.each_ref().map(String::as_str), 0.1, 0.3, camera);
    }
}

#[test]
fn a_connector_is_exact_from_inside() {
    let camera = r#""fov": 100, "position": [0.05, 0.02, 0.0], "target": [1, 0.3, 0]"#;
    let atoms = pair([1.0, 0.0, 0.0]);
    check("camera inside the connector", &atoms.each_ref().map(String::as_str), 0.1, 0.3, camera);
}
