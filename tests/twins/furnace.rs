//! `basic` over a whole sphere: white stays white in a furnace, and the GPU draws what the twin computes.

use super::basic::{LightSample, Scene, Surface, basic_environment, basic_shade, material};
use super::brdf::{brdf_filtered_roughness, brdf_prepare};
use super::gpu;
use super::surface;
use super::truth::{World, center_px};
use glam::{DVec2, DVec3, Vec3};
use restyle::shading::environment::Studio;

const SIZE: [u32; 2] = [256, 256];
const RADIUS: f64 = 1.6;
const MATERIALS: [(f32, f32); 10] = [
    (0.0, 0.0),
    (0.25, 0.0),
    (0.5, 0.0),
    (0.75, 0.0),
    (1.0, 0.0),
    (0.0, 1.0),
    (0.25, 1.0),
    (0.5, 1.0),
    (0.75, 1.0),
    (1.0, 1.0),
];
/// Of display light, 0..1: a fiftieth of a step of 8 bits, where f32 has 1e-7 and the smoothest lobe, whose cosine
/// changes it most, magnifies that a hundredfold. Largest seen 6.2e-5 (llvmpipe 15).
const TWIN: f32 = 8e-5;

fn surface_of(s: &surface::Surface) -> Surface {
    Surface {
        normal_view: s.normal_view,
        to_viewer: s.to_viewer,
        base_color: s.base_color,
        normal_dx: s.normal_dx,
        normal_dy: s.normal_dy,
    }
}

#[test]
fn gpu_equals_twin_in_the_studio() {
    let toward = Vec3::new(1.0, 2.0, 3.0);
    let mut worst_of_all = 0f32;
    for (smoothness, metallic) in MATERIALS {
        let style = format!(
            r##"{{"camera": {{"fov": 35, "exposure": 0.5}}, "geometry": {{"atom": "{RADIUS}A", "scale": 1}},
                "mapping": {{"atom": "b"}},
                "shaders": [{{"name": "b", "shader": "basic", "properties":
                    {{"base_color": "#d9a066", "smoothness": {smoothness}, "metallic": {metallic}}}}}],
                "lights": [{{"position": [1, 2, 3], "intensity": 0.8}}, {{"type": "ambient", "intensity": 0.7}}]}}"##
        );
        let Some(mut engine) = gpu::engine(&["C 0.1 -0.2 0.3"], &style) else { return };
        let image = gpu::aovs(&mut engine, SIZE);
        let world = World::new(&engine, SIZE, &[RADIUS], 0.14);
        let light = LightSample { to_light: toward.normalize(), radiance: Vec3::splat(0.8), visibility: 1.0 };
        let scene =
            Scene { lights: vec![light], ambient_light: Vec3::splat(0.7), environment: Studio::neutral().uniform() };
        let (mut worst, mut compared) = (0f32, 0);
        for (index, pixel) in gpu::pixels(SIZE).enumerate() {
            let Some((_, shape, hit)) = world.seen(center_px(pixel)) else { continue };
            let s = surface::surface_at(&world.view, center_px(pixel), &shape, &hit, gpu::color("#d9a066"), 1.0);
            let twin = basic_shade(&scene, &surface_of(&s), &material(smoothness, metallic, 0.5));
            let drawn = Vec3::from_slice(&image.color[4 * index..4 * index + 3]);
            worst = worst.max((drawn - twin).abs().max_element());
            compared += 1;
        }
        assert!(compared > 10_000, "{compared} pixels");
        assert!(worst <= TWIN, "smoothness {smoothness}, metallic {metallic}: {worst}");
        worst_of_all = worst_of_all.max(worst);
    }
    eprintln!("basic, GPU and twin: at most {worst_of_all:.1e}");
}

#[test]
fn a_white_sphere_vanishes_in_a_white_furnace() {
    let scene = Scene { lights: vec![], ambient_light: Vec3::ONE, environment: Studio::white().uniform() };
    let view = super::truth::View {
        view_from_world: glam::DMat4::IDENTITY,
        half_extent: DVec2::splat(0.32),
        size: DVec2::splat(64.0),
        orthographic: false,
        near: 0.1,
    };
    let sphere = super::truth::Shape::Sphere { center: DVec3::new(0.0, 0.0, -4.0), radius: 1.2 };
    let (mut least, mut most, mut compared) = (f32::MAX, f32::MIN, 0);
    for (smoothness, metallic) in MATERIALS {
        for pixel in gpu::pixels([64, 64]) {
            let Some(hit) = sphere.first(view.ray(center_px(pixel)), view.near) else { continue };
            let s = surface_of(&surface::surface_at(&view, center_px(pixel), &sphere, &hit, Vec3::ONE, 1.0));
            let roughness = brdf_filtered_roughness(1.0 - smoothness, s.normal_dx, s.normal_dy);
            let b = brdf_prepare(Vec3::ONE, metallic, roughness, s.normal_view.dot(s.to_viewer));
            let radiance = basic_environment(&scene, &s, &b, &material(smoothness, metallic, 0.0));
            (least, most) = (least.min(radiance.min_element()), most.max(radiance.max_element()));
            compared += 1;
        }
    }
    eprintln!("white furnace over a sphere: {least:.4}..{most:.4}");
    assert!(compared > 10_000 && least >= 0.95 && most <= 1.02, "{least}..{most} over {compared}");
}
