//! Twin of `shaders/objects/curvature.wgsl` and `shaders/lib/transfer.wgsl`, and the device held to it, to formulas of surfaces,
//! and to the reference renderer.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};
use restyle::config::transfer::{COLOR_SIZE, OPACITY_SIZE, Transfer, TransferKind};
use restyle::config::{self, Catalog, Source};
use restyle::engine::exact::Exact;
use restyle::engine::{self, Engine, Request};
use restyle::measure::metrics::{Options, compare};
use restyle::measure::sheet::sheet;
use restyle::scene::Scene;
use restyle::shading::curvature::{CurvatureMaterial, texels};
use restyle::shipped::{LOOKS, MESHES, MOLECULES, find};

use super::gpu;
use super::surface::{Surface, surface_at};
use super::truth::{Hit, Shape, View, World, center_px};

/// `opacity_transfer` of `shaders/lib/transfer.wgsl`.
fn opacity_transfer(texels: &[[f32; 4]], curvature: f32, depth: f32) -> f32 {
    let cells = OPACITY_SIZE.map(|nodes| nodes - 1);
    let place = [curvature, depth].map(|value| value.clamp(0.0, 1.0));
    let place = [place[0] * cells[0] as f32, place[1] * cells[1] as f32];
    let cell = [0, 1].map(|axis| (place[axis] as usize).min(cells[axis] - 1));
    let within = [0, 1].map(|axis| place[axis] - cell[axis] as f32);
    let [a, b, c, d] = texels[cell[1] * cells[0] + cell[0]];
    let mix = |a: f32, b: f32, t: f32| a + t * (b - a);
    mix(mix(a, b, within[0]), mix(c, d, within[0]), within[1])
}

/// `color_transfer` of the same.
fn color_transfer(texels: &[[f32; 4]], kappa: f32) -> [f32; 3] {
    let colors = &texels[texels.len() - COLOR_SIZE..];
    let place = (0.5 * kappa + 0.5).clamp(0.0, 1.0) * (COLOR_SIZE - 1) as f32;
    let cell = (place as usize).min(COLOR_SIZE - 2);
    [0, 1, 2].map(|channel| {
        let (a, b) = (colors[cell][channel], colors[cell + 1][channel]);
        a + (place - cell as f32) * (b - a)
    })
}

/// `Bend` of the shader.
#[derive(Debug, Clone, Copy)]
struct Bend {
    kappa: f32,
    depth: f32,
    rim: f32,
}

/// `curvature_bend`: `kappa` is the surface's own, `steps` the distance to its rim in footprints.
fn curvature_bend(s: &Surface, kappa: f32, m: &CurvatureMaterial, middle: f32, pixel_world: f32) -> Bend {
    let facing = s.normal_view.dot(s.to_viewer);
    let facing_step = [(s.normal_dx, s.to_viewer_dx), (s.normal_dy, s.to_viewer_dy)]
        .map(|(normal, viewer)| normal.dot(s.to_viewer) + s.normal_view.dot(viewer));
    let length = facing_step[0].hypot(facing_step[1]);
    let rim_steps = (0.5 * facing / length.max(1e-12)).min(1e9);
    let mut kappa = kappa;
    if m.emphasis > 0.0 {
        let facing = facing.max(0.05);
        let across = s.normal_view - facing * s.to_viewer;
        let turn = (across.x * facing_step[0] - across.y * facing_step[1]) / pixel_world;
        let of_picture = (kappa + 0.4 * turn / facing) / facing.powf(0.4);
        kappa += m.emphasis * (of_picture - kappa);
    }
    let signed = (m.gain * kappa).tanh();
    let width_px = m.contour_px + m.contour_world / pixel_world;
    let rim = (width_px - rim_steps + 0.5).clamp(0.0, (2.0 * width_px).min(1.0));
    let depth = 0.5 * ((-s.position_view.z - middle) / m.radius + 1.0);
    Bend { kappa: signed, depth: ((depth - m.depth_start) * m.depth_scale).clamp(0.0, 1.0), rim }
}

/// `curvature_stylised` of white light: its factor by channel, and its opacity.
fn curvature_stylised(texels: &[[f32; 4]], m: &CurvatureMaterial, bend: Bend) -> ([f32; 3], f32) {
    let (of_body, of_rim) = (1.0 - bend.rim, bend.rim);
    let body = of_body * opacity_transfer(texels, bend.kappa.abs(), bend.depth);
    let rim = of_rim * opacity_transfer(texels, m.contour, bend.depth);
    let [on_body, on_rim] = [bend.kappa, -m.contour].map(|kappa| color_transfer(texels, kappa));
    let share = rim / (body + rim).max(1e-12);
    ([0, 1, 2].map(|channel| on_body[channel] + share * (on_rim[channel] - on_body[channel])), m.opacity * (body + rim))
}

/// `kappa_of_screen` of `shaders/layers/neighbours.wgsl` for an object alone; none where no neighbour is on one of both axes.
fn kappa_of_screen(view: &View, at: (u32, u32), shape: &Shape, hit: &Hit, s: &Surface) -> Option<f64> {
    let px = center_px(at);
    let scale = if view.orthographic { 1.0 } else { hit.t };
    let mut change_of = [DVec3::ZERO; 2];
    for (change, step, along) in [(0, DVec2::X, s.position_dx), (1, DVec2::Y, s.position_dy)] {
        let slope = -f64::from(along.z);
        let reach = view.pixel_view() * scale + slope.abs();
        let beside = |side: f64| {
            let place = px + side * step;
            let within = place.cmpge(DVec2::ZERO).all() && place.cmple(view.size).all();
            let ray = view.ray(place);
            let found =
                shape.first(ray, view.near).filter(|found| within && (found.t - hit.t - side * slope).abs() <= reach);
            found.map(|found| if found.normal.dot(ray.direction) > 0.0 { -found.normal } else { found.normal })
        };
        let (before, after) = (beside(-1.0), beside(1.0));
        let steps = f64::from(u8::from(before.is_some()) + u8::from(after.is_some()));
        if steps == 0.0 {
            return None;
        }
        let own = s.normal_view.as_dvec3();
        // View units of a pixel at depth 1, downwards on the second axis.
        let unit = view.pixel_view() * if step.y > 0.0 { -1.0 } else { 1.0 };
        change_of[change] = (after.unwrap_or(own) - before.unwrap_or(own)) / (steps * unit);
    }
    let [dx, dy] = change_of;
    if view.orthographic {
        return Some(-(dx.x + dy.y));
    }
    let plane = view.ray(px).direction;
    Some(-(dx.x + dy.y + plane.x * dx.z + plane.y * dy.z) / hit.t)
}

pub fn load(text: &str) -> config::Style {
    let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
    config::load(&Source::new("test.json", text), &catalog).unwrap_or_else(|wrong| panic!("{wrong}"))
}

pub fn shipped(name: &str) -> Scene {
    let file = [MOLECULES, MESHES].iter().find_map(|among| find(among, name)).expect("a shipped scene");
    Scene::from_bytes(file.file, file.bytes).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn tables_hold_the_functions() {
    for opacity in TransferKind::Opacity.presets() {
        for color in TransferKind::Color.presets() {
            let opacity = Transfer::preset(TransferKind::Opacity, opacity.name).expect("a preset");
            let color = Transfer::preset(TransferKind::Color, color.name).expect("a preset");
            let texels = texels(&opacity, &color);
            for i in 0..=40 {
                let (x, y) = (f64::from(i) / 40.0, f64::from(i * 7 % 41) / 40.0);
                let drawn = opacity_transfer(&texels, x as f32, y as f32);
                assert!((f64::from(drawn) - opacity.opacity(x, y)).abs() < 1e-6);
                let kappa = 2.0 * x - 1.0;
                let (drawn, due) = (color_transfer(&texels, kappa as f32), color.color(kappa));
                assert!(drawn.iter().zip(due).all(|(drawn, due)| (f64::from(*drawn) - due).abs() < 1e-6));
            }
        }
    }
}

#[test]
fn the_device_weighs_light_as_the_twin_does() {
    let size = [64, 64];
    for orthographic in [false, true] {
        for (contour, emphasis, width, source) in [
            (1.0, 0.0, "3pt", "surface"),
            (0.4, 0.7, "30pt", "auto"),
            (1.0, 1.0, "0pt", "surface"),
            (1.0, 0.0, "0pt", "screen"),
            (0.4, 0.3, "3pt", "screen"),
        ] {
            let style = format!(
                r##"{{ "camera": {{ "bgcolor": "black", "orthographic": {orthographic}, "position": [0.5, 0.3, 3] }},
                  "geometry": {{ "atom": "1A", "scale": 1, "bond_radius": "0.35A" }},
                  "mapping": {{ "*": "c" }},
                  "shaders": [{{ "name": "c", "shader": "curvature", "properties": {{ "base_color": "#e0c080", "shading": "unlit",
                    "opacity_transfer": "fig7b", "color_transfer": "warm_cool", "contour": {contour}, "contour_width": "{width}",
                    "contour_emphasis": {emphasis}, "curvature_source": "{source}", "gain": 0.6, "depth_range": [0.1, 0.8] }} }}] }}"##
            );
            // One atom before the other, and beside them a bond that no atom hides.
            let Some(mut engine) = gpu::engine(&["C 0 0 0", "C 0.4 0.2 -2.5", "O 3 0 0"], &style) else { return };
            let image = gpu::still(&mut engine, size, 1);
            let world = World::new(&engine, size, &[1.0, 1.0, 1.0], 0.35);
            let bounds = engine.scene().expect("a scene").bounding_sphere();
            let middle = -world.view.view_from_world.transform_point3(bounds.center.as_dvec3()).z;
            let radius = f64::from(bounds.radius);
            let [opacity, color] = [(TransferKind::Opacity, "fig7b"), (TransferKind::Color, "warm_cool")]
                .map(|(kind, name)| Transfer::preset(kind, name).expect("a preset"));
            let texels = texels(&opacity, &color);
            let base = gpu::color("#e0c080");
            // Nine tenths of the area are no more curved than the balls.
            let gain = gain_of(2.0);
            let px = |points: f64| points * f64::from(size[1]) / 1080.0;
            let material = CurvatureMaterial {
                center_world: bounds.center.to_array(),
                radius: radius as f32,
                gain: (0.6 * gain) as f32,
                contour: contour as f32,
                contour_px: px(width.trim_end_matches("pt").parse().expect("points")) as f32,
                contour_world: 0.0,
                emphasis: emphasis as f32,
                depth_start: 0.1,
                depth_scale: 1.0 / 0.7,
                opacity: 1.0,
                table: 0,
                from_screen: u32::from(source == "screen"),
                _pad1: 0,
                _pad2: 0,
            };
            let mut largest = 0.0f64;
            let mut seen = 0;
            for at in gpu::pixels(size) {
                let ray = world.view.ray(center_px(at));
                let mut hits: Vec<_> = world
                    .shapes
                    .iter()
                    .filter_map(|(_, shape)| Some((*shape, shape.first(ray, world.view.near)?)))
                    .collect();
                hits.sort_by(|a, b| a.1.t.total_cmp(&b.1.t));
                let (mut light, mut open) = ([0.0f64; 3], 1.0f64);
                for (shape, hit) in &hits {
                    let s = surface_at(&world.view, center_px(at), shape, hit, base, 1.0);
                    let mut kappa = match shape {
                        Shape::Sphere { radius, .. } => -2.0 / radius,
                        Shape::Cylinder { radius, .. } if !hit.cap => -1.0 / radius,
                        Shape::Cylinder { .. } => 0.0,
                    };
                    if source == "screen" {
                        kappa = kappa_of_screen(&world.view, at, shape, hit, &s).unwrap_or(kappa);
                    }
                    let pixel = world.view.pixel_view() * if orthographic { 1.0 } else { hit.t };
                    let bend = curvature_bend(&s, kappa as f32, &material, middle as f32, pixel as f32);
                    let (factor, alpha) = curvature_stylised(&texels, &material, bend);
                    let alpha = f64::from(alpha);
                    for channel in 0..3 {
                        light[channel] += open * alpha * f64::from(base[channel] * factor[channel]);
                    }
                    open *= 1.0 - alpha;
                }
                seen += usize::from(!hits.is_empty());
                for (channel, light) in light.iter().enumerate() {
                    let drawn = gpu::linear_from_srgb(image.pixel(at.0, at.1)[channel]);
                    largest = largest.max((drawn - light.min(1.0)).abs());
                }
            }
            assert!(seen > 300, "{seen}");
            assert!(
                largest < 0.004,
                "orthographic {orthographic}, contour {contour}, emphasis {emphasis}, {source}: {largest}"
            );
        }
    }
}

/// The default gain over scene units of a scene whose curved area is all of this curvature, as far as bins of a 64th of a
/// doubling tell.
fn gain_of(curvature: f64) -> f64 {
    0.9f64.atanh() / curvature
}

const TAU: f64 = std::f64::consts::TAU;

fn torus(cells: [usize; 2]) -> String {
    sheet(cells, |u, v| {
        let (around, tube) = (u * TAU, v * TAU);
        let out = DVec3::new(around.cos(), around.sin(), 0.0);
        let normal = out * tube.cos() + DVec3::Z * tube.sin();
        (out + 0.4 * normal, normal)
    })
}

/// Of the ring at a point near it, convex below 0.
fn torus_kappa(p: DVec3) -> f64 {
    let ring = p.x.hypot(p.y);
    -(1.0 / 0.4 + (ring - 1.0) / 0.4 / ring)
}

fn plain(camera: &str) -> config::Style {
    load(&format!(r##"{{ "camera": {{ {camera} }}, "geometry": {{ "atom": "1.5A", "bond_radius": "0.3A" }} }}"##))
}

/// Cosine between surface and view that counts as being next to a silhouette.
const LEAST_FACING: f64 = 0.15;

/// RMS of the error of the AOV over that of the curvature, away from silhouettes, and the number of pixels.
fn error_of(engine: &mut Engine, size: [u32; 2], due: impl Fn(DVec3) -> f64) -> (f64, usize) {
    let camera = engine.camera(size).expect("a camera");
    let world_from_view = camera.view_from_world.as_dmat4().inverse();
    let view = super::truth::View::new(&camera, size);
    let aovs = gpu::aovs(engine, size);
    let (mut error, mut sum, mut count, mut signs) = (0.0, 0.0, 0, 0);
    for (index, at) in gpu::pixels(size).enumerate() {
        if aovs.ids[index] == 0 {
            assert!(aovs.curvature[index].is_nan(), "nothing has no curvature");
            continue;
        }
        let ray = view.ray(center_px(at));
        let p = world_from_view.transform_point3(ray.origin + f64::from(aovs.depth[index]) * ray.direction);
        let truth = due(p);
        signs += usize::from(f64::from(aovs.curvature[index]) * truth < 0.0);
        // Next to a silhouette the back of a triangle may be seen.
        let normal = DVec3::from_slice(&[0, 1, 2].map(|axis| f64::from(aovs.normal[3 * index + axis])));
        if -normal.dot(ray.direction.normalize()) < LEAST_FACING {
            continue;
        }
        error += (f64::from(aovs.curvature[index]) - truth).powi(2);
        sum += truth * truth;
        count += 1;
    }
    assert!(signs * 1000 <= count, "{signs} wrong signs among {count}");
    ((error / sum).sqrt(), count)
}

#[test]
fn curvature_is_that_of_the_surface() {
    for camera in [
        r#""position": [0.8, -1.2, 2.4]"#,
        r#""orthographic": true, "position": [0.3, 1, 2]"#,
        r#""position": [0.4, -0.6, 1.2]"#,
    ] {
        let scene = |text: &str| Scene::from_bytes("ring.obj", text.as_bytes()).expect("a ring");
        let Some(gpu) = gpu::device() else { return };
        let mut engine = Engine::new(gpu.clone(), scene(&torus([360, 180])), plain(camera));
        let (error, count) = error_of(&mut engine, [256, 256], torus_kappa);
        assert!(count > 5000 && error < 0.002, "{camera}: {error} over {count} pixels");
        // With normals that look inwards, of a surface that is seen from outside.
        let inside = sheet([240, 120], |u, v| {
            let (around, tube) = (u * TAU, -v * TAU);
            let out = DVec3::new(around.cos(), around.sin(), 0.0);
            let normal = out * tube.cos() + DVec3::Z * tube.sin();
            (out + 0.4 * normal, -normal)
        });
        let mut engine = Engine::new(gpu, scene(&inside), plain(camera));
        let (error, _) = error_of(&mut engine, [128, 128], torus_kappa);
        assert!(error < 0.002, "{camera}, inwards: {error}");
    }
}

/// Share of the curved scene's radius and its curvature that a picture of `from_screen` tells by its colour, away from silhouettes.
pub const SHADES: &str = r##""base_color": "#808080", "shading": "unlit", "contour_width": "0pt", "opacity_transfer": [[0, 1], [1, 1]],
    "color_transfer": [[-1, 0, 0, 0], [1, 2, 2, 2]]"##;

/// What tanh was taken of where a picture in `SHADES` has this linear light.
pub fn kappa_of_shade(light: f64) -> f64 {
    (light / gpu::linear_from_srgb(128.0 / 255.0) - 1.0).clamp(-0.999, 0.999).atanh()
}

#[test]
fn curvature_of_neighbouring_pixels_is_that_of_the_surface() {
    let Some(gpu) = gpu::device() else { return };
    let size = [256, 256];
    let above = r#""position": [0.8, -1.2, 2.4]"#;
    // Of the coarse ring a triangle has some ten pixels: by differences over one pixel the error is 0.045.
    for (camera, cells, most) in [
        (above, [360, 180], 0.004),
        (r#""orthographic": true, "position": [0.3, 1, 2]"#, [360, 180], 0.004),
        (above, [60, 30], 0.03),
    ] {
        let shades = |source: &str| {
            let style = load(&format!(
                r##"{{ "camera": {{ {camera}, "bgcolor": "black" }}, "mapping": {{ "*": "c" }}, "shaders": [{{ "name": "c", "shader": "curvature",
                  "properties": {{ {SHADES}, "gain": 0.4, "curvature_source": "{source}" }} }}] }}"##
            ));
            let scene = Scene::from_bytes("ring.obj", torus(cells).as_bytes()).expect("a ring");
            let mut engine = Engine::new(gpu.clone(), scene, style);
            let request = Request { wide: true, ..Request::new(size, 1) };
            let image = engine.still(&request).expect("a still");
            (gpu::channel(&image, 0), gpu::aovs(&mut engine, size))
        };
        let ((own, aovs), (screen, _)) = (shades("surface"), shades("screen"));
        let (mut error, mut sum, mut count) = (0.0, 0.0, 0);
        let [width, _] = size.map(|side| side as usize);
        for (index, (own, screen)) in own.iter().zip(&screen).enumerate() {
            // Three pixels and more from silhouettes.
            let depth = |index: usize| aovs.depth.get(index).copied().unwrap_or(f32::INFINITY);
            let around = [index.wrapping_sub(3), index + 3, index.wrapping_sub(3 * width), index + 3 * width];
            if !around.into_iter().all(|other| (depth(other) - depth(index)).abs() < 0.06) {
                continue;
            }
            error += (kappa_of_shade(*screen) - kappa_of_shade(*own)).powi(2);
            sum += kappa_of_shade(*own).powi(2);
            count += 1;
        }
        let error = (error / sum).sqrt();
        eprintln!("{camera}, {cells:?}: {error:.5} over {count} pixels");
        assert!(count > 5000 && error < most, "{camera}, {cells:?}: {error} over {count} pixels");
    }
}

#[test]
fn balls_and_rods_have_the_curvature_of_their_radius() {
    let Some(mut engine) = gpu::engine(
        &["C 0 0 0", "C 2.9 0 0"],
        r##"{ "geometry": { "atom": "1A", "scale": 1, "bond_radius": "0.25A" } }"##,
    ) else {
        return;
    };
    let aovs = gpu::aovs(&mut engine, [96, 64]);
    for (kappa, id) in aovs.curvature.iter().zip(&aovs.ids) {
        let due = match id >> 29 {
            1 => -2.0,
            2 => -4.0,
            _ => continue,
        };
        assert!((kappa - due).abs() < 1e-5, "{kappa} for {due}");
    }
}

#[test]
fn looks_of_glass_are_those_of_the_reference() {
    let cases = [
        ("glass", "gearbox", 0.045),
        ("xray", "gearbox", 0.06),
        ("glass", "bracket", 0.015),
        ("xray", "caffeine", 0.045),
        ("ghost", "caffeine", 0.02),
    ];
    for (look, name, most) in cases {
        let Some(gpu) = gpu::device() else { return };
        let look = find(LOOKS, look).expect("a shipped look");
        let style = || load(std::str::from_utf8(look.bytes).expect("text"));
        let mut engine = Engine::new(gpu, shipped(name), style());
        let request = Request { wide: true, ..Request::new([160, 160], 16) };
        let drawn = engine.still(&request).expect("a still");
        let exact = Exact::new(shipped(name), style(), None);
        let truth = exact.still(&request, &mut |_| ControlFlow::Continue(())).expect("the reference");
        let flip = compare(&truth, &drawn, &Options::default()).expect("one size").metrics.flip;
        eprintln!("{}, {name}: FLIP {flip:.4}", look.name);
        assert!(flip < most, "{}, {name}: {flip}", look.name);
    }
}

/// What the rim of a ball covers, black on white, over a ring of its width in points; it covers nothing but where curvature is more than
/// `from`.
fn covered_by_rim(width: f64, from: f64, pictures: &[(u32, u32)]) -> Option<Vec<f64>> {
    let style = format!(
        r##"{{ "camera": {{ "bgcolor": "white", "orthographic": true }}, "geometry": {{ "atom": "1A", "scale": 1 }},
          "mapping": {{ "*": "c" }}, "shaders": [{{ "name": "c", "shader": "curvature", "properties": {{ "base_color": "black",
            "shading": "unlit", "gain": 0, "opacity_transfer": [[0, 0], [{from}, 0], [1, 1]], "contour_width": "{width}pt" }} }}] }}"##
    );
    let mut engine = gpu::engine(&["C 0 0 0"], &style)?;
    let camera = engine.camera([1080, 1080]).expect("a camera");
    let ball = 1.0 / f64::from(camera.half_extent.y);
    let ring = std::f64::consts::PI * (ball * ball - (ball - width / 540.0).powi(2)) / 4.0;
    let covered = |&(size, samples): &(u32, u32)| {
        let image = gpu::still(&mut engine, [size, size], samples);
        let dark: f64 = gpu::channel(&image, 0).iter().map(|light| 1.0 - light).sum();
        dark / f64::from(size * size) / ring
    };
    Some(pictures.iter().map(covered).collect())
}

#[test]
fn contours_are_as_wide_in_points_at_any_size() {
    let Some(shares) = covered_by_rim(12.0, 0.01, &[(270, 4), (1080, 4), (2160, 4)]) else { return };
    assert!(shares.iter().all(|share| (share - 1.0).abs() < 0.04), "{shares:?}");
}

/// Rims of 0.3 to 1.5 footprints of a sample cover in proportion, however late their opacity rises.
#[test]
fn thin_rims_cover_as_much_as_they_are_wide() {
    let Some(shares) = covered_by_rim(3.0, 0.9, &[(108, 1), (108, 4), (108, 16), (540, 1)]) else { return };
    assert!(shares.iter().all(|share| (share - 1.0).abs() < 0.03), "{shares:?}");
}

#[test]
fn boxes_alone_have_edges_and_no_curvature() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let Some(gpu) = gpu::device() else { return };
    let style = load(
        r##"{ "camera": { "bgcolor": "white", "position": [1, 0.7, 2] }, "mapping": { "*": "c" }, "shaders": [{ "name": "c", "shader": "curvature",
          "properties": { "base_color": "black", "shading": "unlit", "opacity_transfer": [[0, 0.1], [1, 1]], "contour_width": "6pt" } }] }"##,
    );
    let mut engine = Engine::new(gpu, Scene::from_bytes("cube.obj", cube.as_bytes()).expect("a cube"), style);
    let image = gpu::still(&mut engine, [200, 200], 4);
    let light = gpu::channel(&image, 0);
    // Faces, one upon the other, are all of one of two greys; edges are black.
    let two = light.iter().filter(|light| (**light - 0.81).abs() < 1e-3).count();
    let black = light.iter().filter(|light| **light < 0.01).count();
    assert!(two > 5000 && (300..4000).contains(&black), "{two} and {black}");
    let aovs = gpu::aovs(&mut engine, [64, 64]);
    assert!(aovs.curvature.iter().all(|kappa| kappa.is_nan() || *kappa == 0.0));
}
