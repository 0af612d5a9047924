//! The reference renderer held to truths that can be written down, and the GPU held to it.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3, Mat4, Vec2};
use restyle::config::{self, Catalog, Source};
use restyle::engine::exact::Exact;
use restyle::engine::{self, Engine, Request};
use restyle::measure::metrics::{self, Options};
use restyle::reference::{
    Cylinder, Look, Material, Meshes, Object, Occlusion, Optics, Part, Picture, Settings, Shade, Sphere, World,
};
use restyle::scene::{Camera, Image, Lighting, Scene};
use restyle::shipped;

use super::gpu;
use super::meshes::{quad, stl};

const WHITE: Look = Look { color: DVec3::ONE, material: 0, group: 0, picks: 0 };

fn ball(center: DVec3, radius: f64) -> Sphere {
    Sphere { center, radius, look: WHITE }
}

fn matt(opacity: f64) -> Material {
    Material { base_color: None, hull: None, opacity, shade: Shade::Unlit, stylist: None }
}

/// A camera at the origin that sees one unit to each side.
fn optics(size: [u32; 2]) -> Optics {
    let half_extent = Vec2::new(size[0] as f32 / size[1] as f32, 1.0);
    let camera = Camera { view_from_world: Mat4::IDENTITY, half_extent, orthographic: true, near: 0.1, far: 100.0 };
    Optics::new(&camera, size)
}

/// Premultiplied linear light of every pixel.
fn drawn(
    world: &World,
    materials: &[Material],
    occlusions: &[Occlusion],
    size: [u32; 2],
    samples: u32,
) -> Vec<[f32; 4]> {
    let lighting = Lighting::default();
    let picture = Picture {
        world,
        materials,
        optics: optics(size),
        lighting: &lighting,
        occlusions,
        lens: None,
        layers: None,
        lines: &[],
        background: [0.0; 4],
    };
    let settings = Settings { size, samples, draft: false, threads: 2 };
    let mut light = Vec::new();
    restyle::reference::render::<restyle::reference::BrokenOff>(
        &picture,
        &settings,
        &mut |_| ControlFlow::Continue(()),
        &mut |rows| {
            light.extend_from_slice(rows);
            Ok(())
        },
    )
    .expect("a picture");
    light
}

fn world(spheres: Vec<Sphere>, cylinders: Vec<Cylinder>, meshes: Option<Meshes>) -> World {
    World::new(DVec3::new(0.0, 0.0, -5.0), DAffine3::IDENTITY, spheres, cylinders, meshes, |_| Vec::new())
}

/// Facets around the origin as a scene, moved to a depth of 5; and that scene.
fn mesh(facets: &[[DVec3; 3]]) -> World {
    let scene = Arc::new(Scene::from_bytes("test.stl", stl(facets).as_bytes()).expect("a mesh"));
    let origin = scene.origin();
    let parts = vec![Part { part: 0, look: WHITE, has_vertex_colors: false }];
    let place = DAffine3::from_translation(origin + DVec3::new(0.0, 0.0, -5.0));
    World::new(DVec3::new(0.0, 0.0, -5.0), place, vec![], vec![], Some(Meshes { scene, parts }), |_| Vec::new())
}

#[test]
fn objects_cover_their_exact_share_of_the_picture() {
    let size = [120, 120];
    let area = |world: &World| -> f64 {
        let light = drawn(world, &[matt(1.0)], &[], size, 64);
        light.iter().map(|pixel| f64::from(pixel[3])).sum::<f64>() * (2.0 / 120.0f64).powi(2)
    };
    let middle = DVec3::new(0.013, -0.027, -5.0);
    let disc = area(&world(vec![ball(middle, 0.7)], vec![], None));
    assert!((disc - 0.49 * std::f64::consts::PI).abs() < 2e-4, "{disc}");
    let ends = [middle - DVec3::new(0.5, 0.0, 0.2), middle + DVec3::new(0.5, 0.0, 0.2)];
    let rod = area(&world(vec![], vec![Cylinder { ends, radius: 0.25, looks: [WHITE; 2] }], None));
    // A rectangle, and at each end half of the ellipse that the cap is seen as.
    let tilt = 0.2 / (0.29f64).sqrt();
    let expected = 2.0 * 0.5 * 0.5 + std::f64::consts::PI * 0.25 * 0.25 * tilt;
    assert!((rod - expected).abs() < 2e-4, "{rod} {expected}");
    let corners = [DVec3::new(-0.6, -0.5, 0.1), DVec3::new(0.7, -0.3, -0.2), DVec3::new(0.1, 0.8, 0.3)];
    let triangle = area(&mesh(&[corners]));
    let [a, b, c] = corners.map(DVec3::truncate);
    let expected = 0.5 * (b - a).perp_dot(c - a).abs();
    assert!((triangle - expected).abs() < 2e-4, "{triangle} {expected}");
}

#[test]
fn nested_spheres_blend_by_the_product() {
    let alphas = [0.3, 0.005, 0.9, 0.5, 0.25, 0.6, 0.1];
    let balls = (0..alphas.len()).map(|index| {
        let look = Look { material: index as u32, ..WHITE };
        Sphere { center: DVec3::new(0.0, 0.0, -5.0), radius: 0.9 - 0.1 * index as f64, look }
    });
    let materials: Vec<Material> = alphas.iter().map(|alpha| matt(*alpha)).collect();
    let light = drawn(&world(balls.collect(), vec![], None), &materials, &[], [21, 21], 1);
    let seen = f64::from(light[10 * 21 + 10][3]);
    let expected = 1.0 - alphas.iter().map(|alpha| 1.0 - alpha).product::<f64>();
    assert!((seen - expected).abs() < 1e-6, "{seen} {expected}");
    // As many that lie in one place are as many layers.
    let same = vec![ball(DVec3::new(0.0, 0.0, -5.0), 0.5); 5];
    let light = drawn(&world(same, vec![], None), &[matt(0.4)], &[], [21, 21], 1);
    let expected = 1.0 - 0.6f64.powi(5);
    assert!((f64::from(light[10 * 21 + 10][3]) - expected).abs() < 1e-6);
}

/// Occlusion at the surface that a line of sight meets, by so many rays.
fn occlusion_at(world: &World, place: DVec2, radius: f64, num_rays: u32) -> f64 {
    let ray = restyle::reference::Ray { origin: place.extend(0.0), direction: DVec3::NEG_Z };
    let hit = world.next(ray, 0.1, None).expect("a surface");
    restyle::reference::occluded(world, &world.surface(ray, hit), hit.object, radius, num_rays, 7)
}

/// As good as without an end.
const FAR: f64 = 50.0;

/// A floor that faces the eye.
fn floor() -> [[DVec3; 3]; 2] {
    let corner = |x: f64, y: f64| DVec3::new(x * FAR, y * FAR, 0.0);
    quad(corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0))
}

#[test]
fn occlusion_beside_a_wall_is_the_integral() {
    // A floor that faces the eye, and a wall at x = 0 that rises from it towards the eye.
    let far = FAR;
    let wall = quad(
        DVec3::new(0.0, -far, 0.0),
        DVec3::new(0.0, far, 0.0),
        DVec3::new(0.0, far, 4.0),
        DVec3::new(0.0, -far, 4.0),
    );
    let world = mesh(&[floor(), wall].concat());
    let radius = 2.0;
    for distance in [0.2, 0.5, 0.9] {
        let c: f64 = distance / radius;
        let expected = (c.acos() - c * (1.0 - c * c).sqrt()) / std::f64::consts::PI;
        let found = occlusion_at(&world, DVec2::new(distance, 0.3), radius, 1_000_000);
        eprintln!("beside a wall at {distance}: {found:.5}, {expected:.5}");
        assert!((found / expected - 1.0).abs() < 0.005, "{distance}: {found} {expected}");
    }
}

#[test]
fn occlusion_below_a_sphere_is_the_integral() {
    let scene = Arc::new(Scene::from_bytes("test.stl", stl(&floor()).as_bytes()).expect("a mesh"));
    let place = DAffine3::from_translation(scene.origin() + DVec3::new(0.0, 0.0, -5.0));
    let parts = vec![Part { part: 0, look: WHITE, has_vertex_colors: false }];
    let above = DVec3::new(0.0, 0.0, -3.6);
    let meshes = Some(Meshes { scene, parts });
    let world = World::new(DVec3::new(0.0, 0.0, -5.0), place, vec![ball(above, 1.0)], vec![], meshes, |_| Vec::new());
    for aside in [1.1, 1.6, 2.1] {
        let offset = above - DVec3::new(aside, 0.0, -5.0);
        let (distance, cosine) = (offset.length(), offset.z / offset.length());
        let expected = cosine / (distance * distance);
        let found = occlusion_at(&world, DVec2::new(aside, 0.0), 100.0, 1_000_000);
        eprintln!("below a sphere {aside} aside: {found:.5}, {expected:.5}");
        assert!((found / expected - 1.0).abs() < 0.005, "{aside}: {found} {expected}");
    }
}

pub fn style(text: &str) -> config::Style {
    let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
    config::load(&Source::new("test.json", text), &catalog).unwrap_or_else(|wrong| panic!("{wrong}"))
}

pub fn shipped_scene(name: &str) -> Scene {
    let all = shipped::SCENES.iter().copied().flatten();
    let found = all.into_iter().find(|shipped| shipped.name == name).expect("a shipped scene");
    Scene::from_bytes(found.file, found.bytes).expect("it loads")
}

pub fn exact_still(scene: &str, style: &config::Style, request: &Request, threads: usize) -> Image {
    let exact = Exact::new(shipped_scene(scene), style.clone(), Some(threads));
    exact.still(request, &mut |_| ControlFlow::Continue(())).expect("a picture")
}

#[test]
fn any_number_of_threads_draws_the_same_bytes() {
    let look = shipped::find(shipped::LOOKS, "advertisement").expect("a look");
    let style = style(std::str::from_utf8(look.bytes).expect("text"));
    let request = Request::new([70, 50], 4);
    let one = exact_still("caffeine", &style, &request, 1);
    assert_eq!(one, exact_still("caffeine", &style, &request, 2));
    assert_eq!(one, exact_still("caffeine", &style, &request, 7));
}

#[test]
fn the_gpu_draws_what_the_reference_draws() {
    let Some(gpu) = gpu::device() else { return };
    let (size, samples) = ([160, 120], 64);
    for (scene, look, flip_limit) in [
        ("c60", "education", 0.025),
        ("caffeine", "scientific", 0.025),
        ("alpha_helix", "future", 0.035),
        ("bracket", "education", 0.015),
        // Metal mirrors the studio, whose blur is an approximation on the GPU.
        ("bracket", "scientific", 0.05),
    ] {
        let look_file = shipped::find(shipped::LOOKS, look).expect("a look");
        let mut style = style(std::str::from_utf8(look_file.bytes).expect("text"));
        style.post_effects.clear();
        style.listed_effects.clear();
        let truth = exact_still(scene, &style, &Request::new(size, 64), 2);
        let mut engine = Engine::new(Arc::clone(&gpu), shipped_scene(scene), style);
        let image = engine.still(&Request::new(size, samples)).expect("a still");
        let found = metrics::compare(&truth, &image, &Options::default()).expect("one size").metrics;
        eprintln!("{scene} in {look}: FLIP {:.4}, PSNR {:.1} dB", found.flip, found.psnr_db);
        assert!(found.flip < flip_limit, "{scene} in {look}: {}", found.flip);
    }
}

#[test]
fn the_gpu_occludes_as_rays_do() {
    let Some(gpu) = gpu::device() else { return };
    let (size, samples) = ([144, 144], 16);
    let style = style(
        r##"{ "camera": { "bgcolor": "white" }, "mapping": { "*": "paper", "post_effects": ["ao"] },
            "shaders": [ { "name": "paper", "shader": "unlit", "properties": { "base_color": "#e8d8c0" } },
                { "name": "ao", "shader": "ssaoPost" } ] }"##,
    );
    // What the picture does not show cannot be known: the inner side of the cage's back, and of the bracket's holes.
    for (scene, flip_limit) in [("caffeine", 0.025), ("alpha_helix", 0.025), ("c60", 0.045), ("bracket", 0.035)] {
        let truth = exact_still(scene, &style, &Request::new(size, samples), 2);
        let mut engine = Engine::new(Arc::clone(&gpu), shipped_scene(scene), style.clone());
        let image = engine.still(&Request::new(size, samples)).expect("a still");
        let found = metrics::compare(&truth, &image, &Options::default()).expect("one size").metrics;
        eprintln!("{scene}: FLIP {:.4}, PSNR {:.1} dB", found.flip, found.psnr_db);
        assert!(found.flip < flip_limit, "{scene}: {}", found.flip);
    }
}

#[test]
fn the_gpu_occludes_what_is_picked_as_rays_do() {
    let Some(gpu) = gpu::device() else { return };
    let (size, samples) = ([120, 120], 16);
    // Both effects count: each darkens what it picks.
    let style = |first: &str, second: &str| {
        style(&format!(
            r##"{{ "camera": {{ "bgcolor": "white" }}, "mapping": {{ "*": "paper", "post_effects": ["a", "b"] }},
                "shaders": [ {{ "name": "paper", "shader": "unlit", "properties": {{ "base_color": "#e8d8c0" }} }},
                    {{ "name": "a", "shader": "ssaoPost", "properties": {{ "applies_to": "{first}" }} }},
                    {{ "name": "b", "shader": "ssaoPost", "properties": {{ "applies_to": "{second}", "radius": "6r" }} }} ] }}"##
        ))
    };
    for (scene, first, second, flip_limit) in [
        ("caffeine", "connector", "atom[element=O]", 0.02),
        ("alpha_helix", "*[number=1..6]", "*[number=4..9]", 0.025),
        // Half of what is near a part of a gearbox lies behind others.
        ("gearbox", "mesh[part=*1]", "mesh[part=*o*]", 0.055),
    ] {
        let style = style(first, second);
        let truth = exact_still(scene, &style, &Request::new(size, samples), 2);
        let mut engine = Engine::new(Arc::clone(&gpu), shipped_scene(scene), style.clone());
        let image = engine.still(&Request::new(size, samples)).expect("a still");
        let found = metrics::compare(&truth, &image, &Options::default()).expect("one size").metrics;
        let mut plain = style;
        plain.post_effects.clear();
        plain.listed_effects.clear();
        engine.set_style(plain);
        let bare = engine.still(&Request::new(size, samples)).expect("a still");
        let darkened = metrics::compare(&truth, &bare, &Options::default()).expect("one size").metrics;
        eprintln!("{scene}: FLIP {:.4} of {:.4}, PSNR {:.1} dB", found.flip, darkened.flip, found.psnr_db);
        assert!(found.flip < flip_limit && found.flip < 0.5 * darkened.flip, "{scene}: {}", found.flip);
    }
}

#[test]
fn a_hit_is_an_object() {
    let world = world(vec![ball(DVec3::new(0.0, 0.0, -5.0), 1.0)], vec![], None);
    let ray = restyle::reference::Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Z };
    let hit = world.next(ray, 0.1, None).expect("a hit");
    assert_eq!((hit.t, hit.object), (4.0, Object::Sphere(0)));
    assert_eq!(world.next(ray, 0.1, Some(hit)), None, "the eye sees one side of a sphere");
    assert_eq!(world.surface(ray, hit).normal, DVec3::Z);
}
