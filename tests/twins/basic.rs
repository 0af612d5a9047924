//! Twin of `shaders/objects/basic.wgsl` and `shaders/lib/tone_map.wgsl`.

use super::brdf::{BrdfSurface, brdf_filtered_roughness, brdf_prepare, brdf_reflect};
use super::environment::{environment_diffuse, environment_specular};
use glam::Vec3;
use restyle::shading::{
    basic::BasicMaterial,
    brdf_table::ROUGHNESS_MIN,
    environment::{Environment, Studio},
};

const TONE_MAP_F90: f32 = 0.04;
const TONE_MAP_START: f32 = 0.76;
const TONE_MAP_DESATURATION: f32 = 0.15;

/// `Surface` of the shader, without the positions, which `basic` does not read.
pub struct Surface {
    pub normal_view: Vec3,
    pub to_viewer: Vec3,
    pub base_color: Vec3,
    pub normal_dx: Vec3,
    pub normal_dy: Vec3,
}

/// `LightSample` of the shader.
pub struct LightSample {
    pub to_light: Vec3,
    pub radiance: Vec3,
    pub visibility: f32,
}

/// What the shader reads from bindings.
pub struct Scene {
    pub lights: Vec<LightSample>,
    pub ambient_light: Vec3,
    pub environment: Environment,
}

pub fn tone_map_pbr_neutral(radiance: Vec3) -> Vec3 {
    let color = radiance.max(Vec3::ZERO);
    let low = color.min_element();
    let offset = if low < 2.0 * TONE_MAP_F90 { low - low * low / (4.0 * TONE_MAP_F90) } else { TONE_MAP_F90 };
    let lifted = color - offset;
    let peak = lifted.max_element();
    if peak <= TONE_MAP_START {
        return lifted;
    }
    let room = 1.0 - TONE_MAP_START;
    let new_peak = 1.0 - room * room / (peak + room - TONE_MAP_START);
    let saturation = 1.0 / (TONE_MAP_DESATURATION * (peak - new_peak) + 1.0);
    Vec3::splat(new_peak).lerp(lifted * (new_peak / peak), saturation)
}

pub fn basic_dominant_direction(n: Vec3, r: Vec3, roughness: f32) -> Vec3 {
    let alpha = roughness * roughness;
    let smoothness = 1.0 - alpha;
    n.lerp(r, smoothness * (smoothness.sqrt() + alpha)).normalize()
}

fn basic_direct(scene: &Scene, s: &Surface, b: &BrdfSurface) -> Vec3 {
    scene
        .lights
        .iter()
        .filter(|light| light.visibility > 0.0)
        .map(|light| light.radiance * light.visibility * brdf_reflect(b, s.normal_view, s.to_viewer, light.to_light))
        .sum()
}

/// The environment is blurred by the material's own roughness, in the shader by terms computed once; here in full.
pub fn basic_environment(scene: &Scene, s: &Surface, b: &BrdfSurface, m: &BasicMaterial) -> Vec3 {
    let roughness = (1.0 - m.smoothness).max(ROUGHNESS_MIN);
    let r = 2.0 * s.normal_view.dot(s.to_viewer) * s.normal_view - s.to_viewer;
    let seen = basic_dominant_direction(s.normal_view, r, b.roughness);
    b.diffuse_albedo * environment_diffuse(&scene.environment, s.normal_view)
        + b.specular_albedo * environment_specular(&scene.environment, seen, roughness)
}

pub fn basic_shade(scene: &Scene, s: &Surface, m: &BasicMaterial) -> Vec3 {
    let roughness = brdf_filtered_roughness(1.0 - m.smoothness, s.normal_dx, s.normal_dy);
    let b = brdf_prepare(s.base_color, m.metallic, roughness, s.normal_view.dot(s.to_viewer));
    let mut radiance = basic_direct(scene, s, &b);
    if scene.ambient_light.cmpgt(Vec3::ZERO).any() {
        radiance += scene.ambient_light * basic_environment(scene, s, &b, m);
    }
    tone_map_pbr_neutral(radiance * m.exposure_factor)
}

/// An opaque material; `stops` is the exposure.
pub fn material(smoothness: f32, metallic: f32, stops: f32) -> BasicMaterial {
    BasicMaterial::new(smoothness, metallic, stops.exp2())
}

fn facing(base_color: Vec3) -> Surface {
    Surface { normal_view: Vec3::Z, to_viewer: Vec3::Z, base_color, normal_dx: Vec3::ZERO, normal_dy: Vec3::ZERO }
}

#[test]
fn tone_map_only_takes_the_haze_off_below_compression() {
    for c in [Vec3::new(0.8, 0.1, 0.3), Vec3::splat(0.5), Vec3::new(0.08, 0.2, 0.09)] {
        assert!((tone_map_pbr_neutral(c) - (c - 0.04)).abs().max_element() < 1e-6);
    }
    // Pure colours have no haze to take off: the smallest channel is 0.
    let red = Vec3::new(0.7, 0.0, 0.0);
    assert_eq!(tone_map_pbr_neutral(red), red);
    // x - x + x^2 / (4 F90) of the specification's first case.
    assert!((tone_map_pbr_neutral(Vec3::splat(0.04)).x - 0.01).abs() < 1e-6);
}

#[test]
fn tone_map_rises_and_stays_below_one() {
    let mut last = -1.0;
    for i in 0..4000 {
        let mapped = tone_map_pbr_neutral(Vec3::splat(i as f32 * 0.005));
        assert!(mapped.x > last && mapped.x < 1.0, "{i}: {mapped}");
        last = mapped.x;
    }
    // Peak 1.0 - 0.04 compresses to 1 - 0.24^2 / (0.96 + 0.24 - 0.76).
    assert!((tone_map_pbr_neutral(Vec3::ONE).x - (1.0 - 0.0576 / 0.44)).abs() < 1e-6);
    assert!(tone_map_pbr_neutral(Vec3::new(1e6, 10.0, 0.0)).max_element() <= 1.0);
    assert!(tone_map_pbr_neutral(Vec3::splat(-1.0)).is_finite());
}

#[test]
fn white_matt_surface_that_faces_a_unit_light_reflects_about_one() {
    let b = brdf_prepare(Vec3::ONE, 0.0, 1.0, 1.0);
    let out = brdf_reflect(&b, Vec3::Z, Vec3::Z, Vec3::Z).x;
    assert!((0.9..1.15).contains(&out), "{out}");
}

#[test]
fn white_furnace_is_shaded_as_one() {
    let scene = Scene { lights: vec![], ambient_light: Vec3::ONE, environment: Studio::white().uniform() };
    let white = tone_map_pbr_neutral(Vec3::ONE);
    for metallic in [0.0, 1.0] {
        for smoothness in [0.0, 0.5, 1.0] {
            let m = material(smoothness, metallic, 0.0);
            let out = basic_shade(&scene, &facing(Vec3::ONE), &m);
            assert!((out - white).abs().max_element() < 1e-4, "m {metallic} s {smoothness}: {out}");
        }
    }
}

#[test]
fn exposure_is_in_stops_and_shadow_takes_light_away() {
    let light = |visibility| Scene {
        lights: vec![LightSample { to_light: Vec3::Z, radiance: Vec3::splat(0.25), visibility }],
        ambient_light: Vec3::ZERO,
        environment: Studio::white().uniform(),
    };
    let shade = |scene: &Scene, stops| basic_shade(scene, &facing(Vec3::splat(0.5)), &material(0.0, 0.0, stops)).x;
    // Both lie above the haze and below compression, where the tone map is x - 0.04.
    let (one, two) = (shade(&light(1.0), 0.0) + 0.04, shade(&light(1.0), 1.0) + 0.04);
    assert!((two / one - 2.0).abs() < 1e-4, "{one} {two}");
    assert_eq!(shade(&light(0.0), 0.0), 0.0);
}
