//! Twin of `shaders/effects/occlusion.wgsl`, its known answers, and the GPU held to it.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use restyle::config::{self, Catalog, Source};
use restyle::engine::{self, EffectForm, Engine};

use super::gpu;
use super::outline::{Geometry, NOTHING, Rig, random_atoms};
use super::truth::{View, center_px};

/// `OcclusionParams`, and which form is drawn.
#[derive(Debug, Clone, Copy)]
struct Params {
    radius: f64,
    samples: u32,
    slices: u32,
    steps: u32,
    blur: i32,
    form: Form,
    /// One of so many pixels, across and down, finds horizons.
    stride: i32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Bitmask,
    Gtao,
    Hemisphere,
    Rotated,
    Published,
}

impl Form {
    fn is_horizons(self) -> bool {
        matches!(self, Form::Bitmask | Form::Gtao)
    }
}

const THICKER: f64 = 2.0;
const LEAST_RISE: f64 = 0.01;
const POINT_BIAS_RADII: f64 = 0.02;
const PLANE_RADII: f64 = 0.1;
const LEAST_COSINE: f64 = 0.7;
const LEAST_WEIGHT: f64 = 0.05;

/// What the picture shows, row by row.
struct Seen<'a> {
    view: &'a View,
    size: [i32; 2],
    geometry: &'a [Geometry],
}

impl Seen<'_> {
    fn at(&self, [x, y]: [i32; 2]) -> Option<&Geometry> {
        let inside = x >= 0 && y >= 0 && x < self.size[0] && y < self.size[1];
        inside.then(|| &self.geometry[(y * self.size[0] + x) as usize])
    }

    fn surface(&self, at: [i32; 2]) -> Option<&Geometry> {
        self.at(at).filter(|seen| seen.id != 0)
    }

    fn position(&self, [x, y]: [i32; 2], depth: f64) -> DVec3 {
        let ray = self.view.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        ray.origin + depth * ray.direction
    }

    fn away(&self, [x, y]: [i32; 2]) -> DVec3 {
        self.view.ray(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).direction.normalize()
    }

    fn pixel_world(&self, depth: f64) -> f64 {
        self.view.pixel_view() * if self.view.orthographic { 1.0 } else { depth }
    }
}

fn noise([x, y]: [i32; 2]) -> DVec2 {
    let [x, y] = [x as u32 & 3, y as u32 & 3];
    let a = x ^ y;
    let order = (a & 1) << 3 | (y & 1) << 2 | (a & 2) | (y & 2) >> 1;
    let turned = (order * 7 + 3) & 15;
    (DVec2::new(f64::from(order), f64::from(turned)) + 0.5) / 16.0
}

fn angle_of(cosine: f64) -> f64 {
    let x = cosine.abs();
    let angle = (1.0 - x).sqrt() * (1.570_728_8 + x * (-0.212_114_4 + x * (0.074_261_0 - 0.018_729_3 * x)));
    if cosine < 0.0 { PI - angle } else { angle }
}

fn light_to(cosine: f64, cos_n: f64, sin_m: f64) -> f64 {
    let c = cosine.clamp(-sin_m, 1.0);
    let s = (1.0 - c * c).max(0.0).sqrt();
    let doubled = (2.0 * c * c - 1.0) * cos_n + 2.0 * s * c * sin_m;
    0.25 * (cos_n - doubled + 2.0 * angle_of(c) * sin_m)
}

/// A slice through the line of sight, and the surface in it.
struct Slice {
    normal: DVec3,
    to_viewer: DVec3,
    cos_n: f64,
    sin_n: f64,
    second: f64,
    all: f64,
}

impl Slice {
    fn light_to_place(&self, place: DVec3, side: f64) -> f64 {
        let place = place / place.length().max(1e-15);
        let cosine = if place.dot(self.normal) > LEAST_RISE { place.dot(self.to_viewer) } else { -1.0 };
        light_to(cosine, self.cos_n, self.sin_n * side)
    }
}

fn within(radius: f64, start: DVec3, way: DVec3, most: f64) -> [f64; 2] {
    let a = way.length_squared().max(1e-20);
    let b = start.dot(way);
    let inside = b * b - a * (start.length_squared() - radius * radius);
    if inside <= 0.0 {
        return [0.0; 2];
    }
    [((-b - inside.sqrt()) / a).max(0.0), ((-b + inside.sqrt()) / a).min(most)]
}

fn horizons(seen: &Seen<'_>, params: &Params, own: [i32; 2], g: &Geometry) -> f64 {
    let p = seen.position(own, g.depth);
    let to_viewer = if seen.view.orthographic { DVec3::Z } else { -p.normalize() };
    let radius_px = params.radius / seen.pixel_world(g.depth);
    let noise = noise(own.map(|at| at / params.stride));
    let (mut blocked, mut all) = (0.0, 0.0);
    for index in 0..params.slices {
        let angle = PI * (f64::from(index) + noise.x) / f64::from(params.slices);
        let way = DVec2::from_angle(angle);
        let along = way.extend(0.0) - to_viewer * to_viewer.dot(way.extend(0.0));
        let axis = along.cross(to_viewer).normalize();
        let projected = g.normal - axis * g.normal.dot(axis);
        let size = projected.length();
        let cos_n = (projected.dot(to_viewer) / size.max(1e-6)).clamp(-1.0, 1.0);
        let sin_n = (1.0 - cos_n * cos_n).sqrt() * if along.dot(projected) > 0.0 { 1.0 } else { -1.0 };
        let second = light_to(-1.0, cos_n, -sin_n);
        let slice =
            Slice { normal: g.normal, to_viewer, cos_n, sin_n, second, all: second + light_to(-1.0, cos_n, sin_n) };
        let bits = covered_bits(seen, params, own, g.id, p, way, radius_px, noise.y, &slice);
        blocked += size * slice.all * f64::from(bits.count_ones()) / 32.0;
        all += size * slice.all;
    }
    blocked / all.max(1e-6)
}

#[allow(clippy::too_many_arguments)]
fn covered_bits(
    seen: &Seen<'_>,
    params: &Params,
    own: [i32; 2],
    own_id: u32,
    p: DVec3,
    way: DVec2,
    radius_px: f64,
    noise: f64,
    slice: &Slice,
) -> u32 {
    let tap_px = |step: f64| ((step / f64::from(params.steps)).powf(1.5) * radius_px).max(1.0);
    let mut bits = 0u32;
    for side in [1.0, -1.0] {
        let (mut last_id, mut last_front) = (own_id, DVec3::ZERO);
        for tap in 0..params.steps {
            let step = f64::from(tap) + noise;
            let off_px = tap_px(step);
            let off = (way * DVec2::new(side, -side) * off_px).to_array().map(|off| off.round_ties_even() as i32);
            let at = [own[0] + off[0], own[1] + off[1]];
            let Some(tapped) = seen.surface(at).filter(|tapped| tapped.id != own_id) else { continue };
            let away = seen.away(at);
            let front = seen.position(at, tapped.depth) - p;
            let mut begins = last_front;
            if tapped.id != last_id {
                let back_px = off_px - tap_px((step - 0.5).max(0.0));
                let beside = (-side * way * back_px * seen.pixel_world(tapped.depth)).extend(0.0);
                begins = front + beside - away * (beside.dot(tapped.normal) / away.dot(tapped.normal).min(-0.1));
            }
            (last_id, last_front) = (tapped.id, front);
            let thickness = match params.form {
                Form::Gtao => 1e30,
                _ => THICKER * 2.0 / tapped.bend * (-tapped.normal.dot(away)).max(0.0),
            };
            let across = within(params.radius, begins, front - begins, 1.0);
            let along = within(params.radius, front, away, thickness);
            let (is_across, is_along) = (across[1] > across[0], along[1] > along[0]);
            if !is_across && !is_along {
                continue;
            }
            let middle = if is_across { begins.lerp(front, across[1]) } else { front + along[0] * away };
            let first_end = if is_across { begins.lerp(front, across[0]) } else { middle };
            let last_end = if is_along { front + along[1] * away } else { middle };
            let lights = [first_end, middle, last_end].map(|place| slice.light_to_place(place, side));
            let nearest = lights.into_iter().fold(f64::INFINITY, f64::min);
            let farthest = lights.into_iter().fold(0.0, f64::max);
            let (low, high) = if side < 0.0 { (-farthest, -nearest) } else { (nearest, farthest) };
            let bit = |light: f64| ((slice.second + light) / slice.all * 32.0 + noise).clamp(0.0, 32.0) as u32;
            for set in bit(low)..bit(high) {
                bits |= 1 << (set & 31);
            }
        }
    }
    bits
}

fn sphere_tap(index: f64, count: f64) -> DVec3 {
    let z = 1.0 - 2.0 * (index + 0.5) / count;
    let angle = index * 2.399_963_2;
    (DVec2::from_angle(angle) * (1.0 - z * z).max(0.0).sqrt()).extend(z)
}

fn hidden_points(seen: &Seen<'_>, params: &Params, own: [i32; 2], g: &Geometry) -> f64 {
    let p = seen.position(own, g.depth);
    let noise = noise(own);
    let random = sphere_tap(16.0 * noise.x - 0.5, 16.0);
    let is_published = params.form == Form::Published;
    let (mut hidden, mut counted) = (0.0, 0.0);
    for index in 0..params.samples {
        let index = f64::from(index);
        let long = (index * 0.618_034 + 0.5).fract().cbrt();
        let offset = long * params.radius * sphere_tap(index, f64::from(params.samples));
        let mut offset = if params.form == Form::Rotated {
            let (sine, cosine) = (2.0 * PI * noise.y).sin_cos();
            offset * cosine + random.cross(offset) * sine + random * random.dot(offset) * (1.0 - cosine)
        } else {
            offset - 2.0 * offset.dot(random) * random
        };
        if !is_published && offset.dot(g.normal) <= 0.0 {
            offset = -offset;
        }
        let point = p + offset;
        let place = seen.view.project(point);
        let at = place.to_array().map(|at| at.floor() as i32);
        if !is_published && (seen.at(at).is_none() || -point.z <= seen.view.near) {
            continue;
        }
        counted += 1.0;
        let inside = [0, 1].map(|axis: usize| at[axis].clamp(0, seen.size[axis] - 1));
        let Some(tapped) = seen.surface(inside) else { continue };
        let is_hidden = if is_published {
            tapped.depth < -point.z
        } else {
            tapped.depth < -point.z - POINT_BIAS_RADII * params.radius && (tapped.depth - g.depth).abs() < params.radius
        };
        hidden += f64::from(u8::from(is_hidden));
    }
    hidden / f64::max(counted, 1.0)
}

/// The occlusion of each pixel of a picture of one sample: 0 of what is not picked.
fn occlusion(
    view: &View,
    params: &Params,
    size: [u32; 2],
    geometry: &[Geometry],
    is_picked: &dyn Fn(u32) -> bool,
) -> Vec<f64> {
    let seen = Seen { view, size: size.map(|side| side as i32), geometry };
    let own = |(x, y): (u32, u32)| [x as i32, y as i32];
    let texels = size.map(|side| side.div_ceil(params.stride as u32));
    let pixel_of = |texel: [i32; 2]| [0, 1].map(|axis| (params.stride * texel[axis]).min(seen.size[axis] - 1));
    let picked = |at| seen.surface(at).filter(|g| is_picked(g.id));
    let estimate = |pixel| {
        let at = pixel_of(own(pixel));
        picked(at).map_or(0.0, |g| match params.form.is_horizons() {
            true => horizons(&seen, params, at, g),
            false => hidden_points(&seen, params, at, g),
        })
    };
    let estimates: Vec<f64> = gpu::pixels(texels).map(estimate).collect();
    let denoised = |pixel| {
        let own = own(pixel);
        let Some(g) = picked(own) else { return 0.0 };
        let p = seen.position(own, g.depth);
        let (mut sum, mut weights) = (0.0, 0.0);
        for index in 0..params.blur * params.blur {
            let off = [index % params.blur - params.blur / 2, index / params.blur - params.blur / 2];
            let texel = [0, 1].map(|axis| (own[axis] + params.stride / 2) / params.stride + off[axis]);
            if texel.iter().zip(texels).any(|(at, side)| *at < 0 || *at >= side as i32) {
                continue;
            }
            let at = pixel_of(texel);
            let Some(other) = picked(at) else { continue };
            let mut weight = 1.0;
            if params.form.is_horizons() {
                let off = (seen.position(at, other.depth) - p).dot(g.normal);
                let turned = other.normal.dot(g.normal);
                weight = (1.0 - off.abs() / (PLANE_RADII * params.radius)).max(0.0)
                    * ((turned - LEAST_COSINE) / (1.0 - LEAST_COSINE)).max(0.0);
            }
            sum += weight * estimates[(texel[1] * texels[0] as i32 + texel[0]) as usize];
            weights += weight;
        }
        if params.stride > 1 && weights < LEAST_WEIGHT {
            return horizons(&seen, params, own, g);
        }
        sum / f64::max(weights, 1e-6)
    };
    gpu::pixels(size).map(denoised).collect()
}

const SIZE: [u32; 2] = [96, 72];
const RADIUS: f64 = 2.5;

/// A style of white objects with occlusion alone, of what a selector picks.
fn style(method: &str, samples: u32, camera: &str, [atom, bond]: [f64; 2], applies_to: &str) -> config::Style {
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "black", {camera} }},
            "geometry": {{ "atom": "{atom}A", "scale": 1, "bond_radius": "{bond}A" }},
            "mapping": {{ "*": "flat", "post_effects": ["ao"] }},
            "shaders": [ {{ "name": "flat", "shader": "unlit", "properties": {{ "base_color": "white" }} }},
                {{ "name": "ao", "shader": "ssaoPost",
                   "properties": {{ "method": "{method}", "samples": {samples}, "radius": "{RADIUS}A",
                       "applies_to": {applies_to} }} }} ] }}"##
    );
    let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
    config::load(&Source::new("test.json", text), &catalog).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// What the device draws: 1 minus its light.
fn drawn(engine: &mut Engine) -> Vec<f64> {
    let request = engine::Request { wide: true, ..gpu::request(SIZE, 1) };
    let image = engine.still(&request).expect("a picture");
    gpu::channel(&image, 1).iter().map(|light| 1.0 - light).collect()
}

#[test]
fn the_gpu_finds_the_occlusion_of_the_twin() {
    let forms = [
        (Form::Bitmask, "bitmask", None),
        (Form::Bitmask, "bitmask", Some(EffectForm::OCCLUSION_FINE)),
        (Form::Gtao, "gtao", None),
        (Form::Hemisphere, "hemisphere", None),
        (Form::Rotated, "hemisphere", Some(EffectForm::OCCLUSION_ROTATED)),
        (Form::Published, "hemisphere", Some(EffectForm::OCCLUSION_PUBLISHED)),
    ];
    let atoms = random_atoms(40, DVec3::new(6.0, 4.0, 5.0), 7);
    for camera in [r#""orthographic": true"#, r#""fov": 45"#] {
        for (form, method, of_measure) in forms {
            let Some(mut rig) = Rig::new(&atoms, SIZE, 1.0, camera, "") else { return };
            rig.engine.set_style(style(method, 16, camera, [1.0, super::outline::BOND_RADIUS], "null"));
            rig.engine.set_forms(of_measure.into_iter().collect());
            let stride = if form.is_horizons() && of_measure.is_none() { 2 } else { 1 };
            assert_is_of_twin(&mut rig, (form, stride), &|_| true, 1000.0, camera);
        }
    }
}

/// Holds what the device draws of a rig against the twin: what is picked, of so many pixels at the least, and what is not.
fn assert_is_of_twin(
    rig: &mut Rig,
    (form, stride): (Form, i32),
    is_picked: &dyn Fn(u32) -> bool,
    least_px: f64,
    name: &str,
) {
    let device = drawn(&mut rig.engine);
    let params = Params { radius: RADIUS, samples: 16, slices: 2, steps: 4, blur: 4, form, stride };
    let geometry: Vec<Geometry> = gpu::pixels(SIZE).map(|pixel| rig.geometry(center_px(pixel))).collect();
    let twin = occlusion(&rig.world.view, &params, SIZE, &geometry, is_picked);
    let surfaces: Vec<(f64, f64)> = (device.iter().zip(&twin).zip(&geometry))
        .filter(|(_, g)| **g != NOTHING && is_picked(g.id))
        .map(|((device, twin), _)| (*device, *twin))
        .collect();
    let count = surfaces.len() as f64;
    let mean = surfaces.iter().map(|(_, twin)| twin).sum::<f64>() / count;
    let off = |least: f64| surfaces.iter().filter(|(a, b)| (a - b).abs() > least).count() as f64 / count;
    let error = surfaces.iter().map(|(a, b)| (a - b).abs()).sum::<f64>() / count;
    eprintln!(
        "{form:?} / {stride}, {name}: mean {mean:.4}, error {error:.6}, off by 0.01: {:.4}, {count} px",
        off(0.01)
    );
    assert!(mean > 0.02 && count > least_px, "there is something to see: {mean} of {count}");
    // Where a tap lies on the border of two pixels, or a bit on the end of what is covered, rounding decides.
    assert!(error < 1e-3 && off(0.01) < 0.02, "{form:?}, {name}");
    let left = (device.iter().zip(&geometry)).filter(|(_, g)| **g != NOTHING && !is_picked(g.id));
    assert_eq!(left.filter(|(dark, _)| **dark != 0.0).count(), 0, "{name}: what is not picked is as bright as ever");
}

#[test]
fn what_is_not_picked_is_not_darkened_and_darkens() {
    let atoms = random_atoms(60, DVec3::new(5.0, 4.0, 4.0), 11);
    let camera = r#""fov": 45"#;
    // Small enough that connectors are seen between them.
    let radii = [0.45, super::outline::BOND_RADIUS];
    for (form, method) in [(Form::Bitmask, "bitmask"), (Form::Hemisphere, "hemisphere")] {
        let Some(mut rig) = Rig::new(&atoms, SIZE, radii[0], camera, "") else { return };
        let of_chain: Vec<u32> = {
            let chains = &rig.engine.scene().expect("a scene").molecule.chains;
            let chain = chains.iter().position(|chain| chain.id == "B").expect("a chain") as u32;
            let ids = rig.world.shapes.iter().map(|(id, _)| *id);
            ids.filter(|id| rig.groups(*id).iter().any(|group| group >> 9 == chain)).collect()
        };
        let is_of_chain = |id: u32| of_chain.contains(&id);
        let is_atom = |id: u32| id >> 29 == 1;
        let picks: [(&str, &dyn Fn(u32) -> bool); 4] = [
            ("atom", &is_atom),
            ("connector", &|id| !is_atom(id)),
            ("*[chain=B]", &is_of_chain),
            ("atom[chain=B]", &|id| is_atom(id) && is_of_chain(id)),
        ];
        for (selector, is_picked) in picks {
            rig.engine.set_style(style(method, 16, camera, radii, &format!("\"{selector}\"")));
            let stride = if form.is_horizons() { 2 } else { 1 };
            assert_is_of_twin(&mut rig, (form, stride), is_picked, 100.0, selector);
        }
    }
}

#[test]
fn light_of_whole_slices_is_that_of_the_hemisphere() {
    // The normal at an angle in a slice: both sides together, over all slices, are pi; one alone by quadrature.
    for angle in [-1.2f64, -0.4, 0.0, 0.7, 1.5] {
        let (sin_n, cos_n) = angle.sin_cos();
        for (side, sin_m) in [(1.0, sin_n), (-1.0, -sin_n)] {
            for end in [0.3f64, 1.0, 2.0, PI] {
                let last = end.min(PI / 2.0 + side * angle);
                let steps = 20_000;
                let width = last / f64::from(steps);
                let sum: f64 = (0..steps)
                    .map(|step| (f64::from(step) + 0.5) * width)
                    .map(|theta| (theta - side * angle).cos() * theta.sin() * width)
                    .sum();
                let light = light_to(end.cos(), cos_n, sin_m);
                assert!((light - sum).abs() < 2e-4, "{angle} {side} {end}: {light} {sum}");
            }
        }
    }
}

#[test]
fn a_lone_sphere_is_not_darkened() {
    let lone = [('A', DVec3::ZERO)];
    for form in ["bitmask", "gtao"] {
        let Some(mut rig) = Rig::new(&lone, SIZE, 1.0, r#""fov": 45"#, "") else { return };
        rig.engine.set_style(style(form, 16, r#""fov": 45"#, [1.0, 0.1], "null"));
        let seen: Vec<bool> = gpu::pixels(SIZE).map(|pixel| rig.geometry(center_px(pixel)) != NOTHING).collect();
        let dark = drawn(&mut rig.engine).into_iter().zip(seen).filter(|(dark, seen)| *seen && *dark > 1e-4).count();
        assert_eq!(dark, 0, "{form}: nothing is near a lone sphere");
    }
}
