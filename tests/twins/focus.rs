//! Twin of `shaders/effects/focus.wgsl`, `focus_gather.wgsl` and `focus_layers.wgsl`, their known answers, and the GPU held to them.
//! What is transparent: `focus_glass.rs`.

use std::f64::consts::PI;

use glam::{DVec3, DVec4};
use restyle::config::{self, Catalog, Source, Style};
use restyle::engine::{self, EffectForm, Engine};

use super::gpu;

/// `FocusParams`, from a style's values and the scene alone.
#[derive(Debug, Clone, Copy)]
pub struct Params {
    pub orthographic: bool,
    pub sharp: [f64; 2],
    pub slopes_px: [f64; 2],
    pub most_px: [f64; 2],
}

pub const TAPS: f64 = 32.0;
pub const TILE: i32 = 16;
pub const LEAST_RADIUS_PX: f64 = 0.5;
pub const SAME_PX: f64 = 0.75;
const FILL: f64 = 1e-3;
pub const LEAST_TAPS: f64 = 8.0;
pub const EVEN_PX: f64 = 4.0;

impl Params {
    pub fn measure(&self, depth: f64) -> f64 {
        if self.orthographic { depth } else { -1.0 / depth }
    }

    /// Before and behind what is sharp; of nothing that of what is farthest.
    fn diameters_px(&self, depth: f64) -> [f64; 2] {
        if depth.is_infinite() {
            return [0.0, self.most_px[1]];
        }
        let measure = self.measure(depth);
        let off = [self.sharp[0] - measure, measure - self.sharp[1]];
        [0, 1].map(|side| (self.slopes_px[side] * off[side].max(0.0)).min(self.most_px[side]))
    }

    pub fn radius_px(&self, depth: f64) -> f64 {
        let [before, behind] = self.diameters_px(depth);
        0.5 * (behind - before)
    }
}

/// What the picture shows, row by row: premultiplied light, and depths, infinite where nothing is.
pub struct Seen {
    pub size: [i32; 2],
    pub color: Vec<DVec4>,
    pub depth: Vec<f64>,
}

impl Seen {
    pub fn index(&self, [x, y]: [i32; 2]) -> usize {
        (y.clamp(0, self.size[1] - 1) * self.size[0] + x.clamp(0, self.size[0] - 1)) as usize
    }

    pub fn pixels(&self) -> impl Iterator<Item = [i32; 2]> + use<> {
        let [width, height] = self.size;
        (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
    }
}

pub fn noise([x, y]: [i32; 2]) -> [f64; 2] {
    let [x, y] = [x as u32 & 3, y as u32 & 3];
    let a = x ^ y;
    let order = (a & 1) << 3 | (y & 1) << 2 | (a & 2) | (y & 2) >> 1;
    [order, (order * 7 + 3) & 15].map(|number| (f64::from(number) + 0.5) / 16.0)
}

#[derive(Clone, Copy, Default)]
struct Share {
    color: DVec4,
    weight: f64,
}

impl Share {
    fn add(&mut self, color: DVec4, weight: f64) {
        self.color += weight * color;
        self.weight += weight;
    }

    fn mean(&self) -> DVec4 {
        self.color / self.weight.max(1e-9)
    }
}

/// For each tile the largest radii that reach it: of what is before the focus, and of all that is seen.
fn reaching(seen: &Seen, params: &Params) -> (Vec<[f64; 2]>, [i32; 2]) {
    let count = seen.size.map(|side| (side + TILE - 1) / TILE);
    let mut widest = vec![[0.0f64; 2]; (count[0] * count[1]) as usize];
    for at in seen.pixels() {
        let depth = seen.depth[seen.index(at)];
        if depth.is_finite() {
            let radius = params.radius_px(depth);
            let [near, any] = &mut widest[(at[1] / TILE * count[0] + at[0] / TILE) as usize];
            (*near, *any) = (near.max(-radius), any.max(radius.abs()));
        }
    }
    let tiles = |index: i32| [index % count[0], index / count[0]];
    let from = |own: i32| {
        let mut reach = [0.0f64; 2];
        for other in 0..count[0] * count[1] {
            let between =
                [0, 1].map(|axis| f64::from(((tiles(own)[axis] - tiles(other)[axis]).abs() - 1).max(0) * TILE));
            for (reach, radius) in reach.iter_mut().zip(widest[other as usize]) {
                if radius >= between[0].hypot(between[1]) {
                    *reach = reach.max(radius);
                }
            }
        }
        reach
    };
    ((0..count[0] * count[1]).map(from).collect(), count)
}

/// The share of a circle's light that falls on a pixel at a distance.
pub fn spread_at(radius: f64, distance: f64) -> f64 {
    let radius = radius.abs().max(LEAST_RADIUS_PX);
    (radius - distance + 0.5).clamp(0.0, 1.0) / (PI * (radius * radius + 1.0 / 12.0))
}

/// Light before the focus and behind it, gathered by circles and evened out.
pub fn evened_fields(seen: &Seen, params: &Params) -> (Vec<[DVec4; 2]>, Vec<[DVec4; 2]>) {
    let (reaching, count) = reaching(seen, params);
    let radius_at = |index: usize| params.radius_px(seen.depth[index]);
    let reach_at = |at: [i32; 2]| {
        let [near, any] = reaching[(at[1] / TILE * count[0] + at[0] / TILE) as usize];
        let index = seen.index(at);
        if seen.depth[index].is_finite() { radius_at(index).max(near) } else { any }
    };
    let fields = |own: [i32; 2]| -> [DVec4; 2] {
        let index = seen.index(own);
        let (radius, is_seen, reach) = (radius_at(index), seen.depth[index].is_finite(), reach_at(own));
        if reach < LEAST_RADIUS_PX {
            return [DVec4::ZERO, seen.color[index]];
        }
        let is_near = radius < -SAME_PX;
        let [mut before, mut same, mut behind, mut beyond] = [Share::default(); 4];
        let taps = (PI * reach * reach).clamp(LEAST_TAPS, TAPS).ceil();
        let wide = reach + 0.5;
        let [turn, start] = noise(own);
        let (mut inner, mut whole) = (0.0, 0.0);
        for tap in 0..taps as u32 {
            let end = f64::from(tap + 1) / taps;
            let area = PI * wide * wide * (end.powf(1.5) - inner);
            inner = end.powf(1.5);
            let share = (f64::from(tap) + start) / taps;
            let long = if tap == 0 { 0.0 } else { wide * share.powf(0.75) };
            let angle = 2.399_963_2 * f64::from(tap) + 2.0 * PI * turn;
            // Halves round to even, as on the device.
            let off = [(long * angle.cos()).round_ties_even(), (long * angle.sin()).round_ties_even()];
            let other = seen.index([own[0] + off[0] as i32, own[1] + off[1] as i32]);
            let (other_radius, other_seen) = (radius_at(other), seen.depth[other].is_finite());
            let distance = off[0].hypot(off[1]);
            let spread = area * spread_at(other_radius, distance);
            whole += area * spread_at(radius, distance);
            let filled = spread + FILL * area / (1.0 + distance * distance).powi(2);
            let (color, deeper) = (seen.color[other], other_radius - radius);
            if (other_radius < -SAME_PX) != is_near {
                beyond.add(color, if is_near { filled } else { spread });
            } else if (!other_seen && is_seen) || (deeper > SAME_PX && other_seen) {
                behind.add(color, if is_near { spread } else { filled });
            } else if other_seen && (deeper < -SAME_PX || !is_seen) {
                before.add(color, spread);
            } else {
                same.add(color, spread);
            }
        }
        let front = before.weight.min(1.0);
        let own_share = (same.weight / whole.max(1e-9)).min(1.0 - front);
        let rest = 1.0 - front - own_share;
        if is_near {
            let near = front * before.mean() + own_share * same.mean() + behind.weight.min(rest) * behind.mean();
            [if beyond.weight == 0.0 { near / near.w.max(1e-4) } else { near }, beyond.mean()]
        } else {
            let is_all = behind.weight == 0.0 || !is_seen;
            let (own_share, rest) = if is_all { (1.0 - front, 0.0) } else { (own_share, rest) };
            let far = front * before.mean() + own_share * same.mean() + rest * behind.mean();
            [beyond.weight.min(1.0) * beyond.mean(), far]
        }
    };
    let fields: Vec<[DVec4; 2]> = seen.pixels().map(fields).collect();
    let evened = |own: [i32; 2]| {
        let index = seen.index(own);
        let (radius, is_seen, reach) = (radius_at(index), seen.depth[index].is_finite(), reach_at(own));
        if reach < LEAST_RADIUS_PX {
            return [DVec4::ZERO, seen.color[index]];
        }
        let blurred = if radius < -SAME_PX { -radius } else { reach };
        let side = EVEN_PX.min(blurred).round_ties_even().max(1.0) as i32;
        let is_sharp = is_seen && radius.abs() < LEAST_RADIUS_PX;
        let far_reach = if is_seen { radius.abs() } else { reach };
        let (mut near, mut far, mut fars) = (DVec4::ZERO, DVec4::ZERO, 0.0);
        for step in 0..side * side {
            let off = [step % side - side / 2, step / side - side / 2];
            let at = seen.index([own[0] + off[0], own[1] + off[1]]);
            near += fields[at][0];
            let (other, other_seen) = (radius_at(at), seen.depth[at].is_finite());
            let is_like = (other < -SAME_PX) == (radius < -SAME_PX)
                && (!other_seen || other.abs() >= LEAST_RADIUS_PX)
                && f64::from(off[0].abs().max(off[1].abs())) <= far_reach;
            if is_like || off == [0, 0] {
                far += fields[at][1];
                fars += 1.0;
            }
        }
        near /= f64::from(side * side);
        [near, if is_sharp { seen.color[index] } else { far / fars }]
    };
    let evened = seen.pixels().map(evened).collect();
    (fields, evened)
}

/// Depth of field by circles, of a picture of one sample.
fn gathered(seen: &Seen, params: &Params) -> Vec<DVec4> {
    evened_fields(seen, params).1.iter().map(|[near, far]| *near + (1.0 - near.w) * *far).collect()
}

/// Depth of field in five layers; over `background` as published.
fn layered(seen: &Seen, params: &Params, background: Option<DVec4>) -> Vec<DVec4> {
    let shares = |index: usize| {
        let blur = params.diameters_px(seen.depth[index]);
        [0, 1].map(|side| blur[side] / params.most_px[side].max(1e-6))
    };
    let layer = |side: usize| -> Vec<Share> {
        let deviation = 0.25 * params.most_px[side];
        let reach = (2.5 * deviation).ceil() as i32;
        let in_layer = |index: usize| {
            let (share, own) = (shares(index)[side], seen.color[index]);
            match background {
                None => Share { color: share * own, weight: share },
                Some(_) if share >= 0.999 => Share { color: own, weight: 1.0 },
                Some(background) => Share { color: background, weight: 1.0 },
            }
        };
        let mut layer: Vec<Share> = (0..seen.color.len()).map(in_layer).collect();
        for step in [[1, 0], [0, 1]] {
            let blurred = |[x, y]: [i32; 2]| {
                let (mut sum, mut weights) = (Share::default(), 0.0);
                for off in -reach..=reach {
                    let weight = (-0.5 * (f64::from(off) / deviation.max(1e-3)).powi(2)).exp();
                    let one = layer[seen.index([x + off * step[0], y + off * step[1]])];
                    sum.color += weight * one.color;
                    sum.weight += weight * one.weight;
                    weights += weight;
                }
                Share { color: sum.color / weights, weight: sum.weight / weights }
            };
            layer = seen.pixels().map(blurred).collect();
        }
        layer
    };
    let layers = [layer(0), layer(1)];
    let composed = |index: usize| {
        let mut color = seen.color[index];
        for (layer, share) in layers.iter().zip(shares(index)) {
            let layer = &layer[index];
            let blurred = if layer.weight > 1e-4 { layer.color / layer.weight.max(1e-6) } else { color };
            color = color.lerp(blurred, share);
        }
        color
    };
    (0..seen.color.len()).map(composed).collect()
}

pub const SIZE: [u32; 2] = [96, 72];
const ATOMS: [&str; 9] = [
    "C 0 0 2.4",
    "N 1.3 0.6 2.0",
    "O -2.2 0.4 1.4",
    "C -0.9 -1.7 0.3",
    "O 2.6 -1.2 0",
    "N 0.6 1.9 -0.6",
    "C -2.9 -0.9 -1.8",
    "O 1.9 1.5 -2.4",
    "N 0.1 -0.2 -2.9",
];

fn style(camera: &str, effect: &str) -> Style {
    let listed = if effect.is_empty() { "" } else { r#""f""# };
    let text = format!(
        r##"{{ "camera": {{ "bgcolor": "black", {camera} }}, "geometry": {{ "atom": "0.8A", "scale": 1, "bond_radius": "0.2A" }},
            "mapping": {{ "*": "flat", "post_effects": [{listed}] }},
            "shaders": [ {{ "name": "flat", "shader": "unlit" }},
                {{ "name": "f", "shader": "dofPost", "properties": {{ {effect} }} }} ] }}"##
    );
    let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
    config::load(&Source::new("test.json", text), &catalog).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// An engine with the picture that it draws without the effect; none without an adapter.
fn staged(atoms: &[&str], camera: &str) -> Option<(Engine, Seen)> {
    let mut engine = gpu::engine(atoms, r#"{ "mapping": { "*": "unlit" } }"#)?;
    engine.set_style(style(camera, ""));
    let aovs = gpu::aovs(&mut engine, SIZE);
    let color = |c: &[f32]| DVec4::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]), f64::from(c[3]));
    let seen = Seen {
        size: SIZE.map(|side| side as i32),
        color: aovs.color.chunks_exact(4).map(color).collect(),
        depth: aovs.depth.iter().map(|depth| f64::from(*depth)).collect(),
    };
    Some((engine, seen))
}

/// Depth of the middle of the scene, and its radius.
pub fn depths(engine: &Engine) -> (f64, f64) {
    let sphere = engine.scene().expect("a scene").bounding_sphere();
    let camera = engine.camera(SIZE).expect("a camera");
    (f64::from(-camera.view_from_world.transform_point3(sphere.center).z), f64::from(sphere.radius))
}

pub fn layers(engine: &Engine, orthographic: bool, layers: [f64; 4], blur_px: f64) -> Params {
    let (middle, radius) = depths(engine);
    let empty = Params { orthographic, sharp: [0.0; 2], slopes_px: [0.0; 2], most_px: [blur_px; 2] };
    let [m0, m1, m2, m3] = layers.map(|layer| empty.measure(middle + (2.0 * layer - 1.0) * radius));
    Params { sharp: [m1, m2], slopes_px: [blur_px / (m1 - m0), blur_px / (m3 - m2)], ..empty }
}

/// What a device draws over black: premultiplied light.
pub fn drawn(engine: &mut Engine) -> Vec<DVec3> {
    let image = gpu::still(engine, SIZE, 1);
    let [r, g, b] = [0, 1, 2].map(|channel| gpu::channel(&image, channel));
    r.into_iter().zip(g).zip(b).map(|((r, g), b)| DVec3::new(r, g, b)).collect()
}

/// Mean and share of errors above 0.01.
pub fn errors(device: &[DVec3], twin: &[DVec4]) -> (f64, f64) {
    let errors: Vec<f64> =
        device.iter().zip(twin).map(|(device, twin)| (*device - twin.truncate()).abs().max_element()).collect();
    let count = errors.len() as f64;
    (errors.iter().sum::<f64>() / count, errors.iter().filter(|error| **error > 0.01).count() as f64 / count)
}

pub const CAMERAS: [(&str, bool); 2] = [(r#""fov": 45"#, false), (r#""orthographic": true"#, true)];
/// 8 pixels of 72 rows.
pub const BLUR: &str = "120pt";

#[test]
fn the_gpu_blurs_as_the_twin_does() {
    for (camera, orthographic) in CAMERAS {
        let Some((mut engine, seen)) = staged(&ATOMS, camera) else { return };
        let params = layers(&engine, orthographic, [0.1, 0.45, 0.5, 0.85], 8.0);
        let background = DVec4::new(0.0, 0.0, 0.0, 1.0);
        for (method, form) in
            [("gather", None), ("five_layer", None), ("five_layer", Some(EffectForm::FOCUS_PUBLISHED))]
        {
            let values = format!(r#""method": "{method}", "layers": [0.1, 0.45, 0.5, 0.85], "blur": "{BLUR}""#);
            engine.set_style(style(camera, &values));
            engine.set_forms(form.into_iter().collect());
            let twin = match (method, form) {
                ("gather", _) => gathered(&seen, &params),
                (_, None) => layered(&seen, &params, None),
                (_, Some(_)) => layered(&seen, &params, Some(background)),
            };
            let device = drawn(&mut engine);
            let (mean, off) = errors(&device, &twin);
            let (changed, _) = errors(&device, &seen.color);
            eprintln!("{method} {form:?}, {camera}: error {mean:.6}, off by 0.01 {off:.4}, changed {changed:.3}");
            assert!(changed > 0.002, "there is something to see");
            // Where a tap lies on the border of two pixels, rounding decides.
            assert!(mean < 5e-4 && off < 0.01, "{method} {form:?}, {camera}: {mean} {off}");
        }
    }
}

#[test]
fn a_focus_is_a_lens() {
    for (camera, orthographic) in CAMERAS {
        let Some((mut engine, seen)) = staged(&ATOMS, camera) else { return };
        let (middle, radius) = depths(&engine);
        for (focus, depth) in
            [("\"center\"".to_owned(), middle), (format!("\"{}A\"", middle - 0.4 * radius), middle - 0.4 * radius)]
        {
            engine.set_style(style(camera, &format!(r#""focus": {focus}, "layers": [0, 0, 1, 1], "blur": "{BLUR}""#)));
            let mut params = Params { orthographic, sharp: [0.0; 2], slopes_px: [0.0; 2], most_px: [9.0; 2] };
            let sharp = params.measure(depth);
            let farther = [-1.0, 1.0].map(|side| (params.measure(middle + side * radius) - sharp).abs());
            (params.sharp, params.slopes_px) = ([sharp; 2], [8.0 / farther[0].max(farther[1]); 2]);
            let (mean, off) = errors(&drawn(&mut engine), &gathered(&seen, &params));
            eprintln!("focus {focus}, {camera}: error {mean:.6}, off by 0.01 {off:.4}");
            assert!(mean < 5e-4 && off < 0.01, "focus {focus}, {camera}: {mean} {off}");
        }
    }
}

#[test]
fn what_is_sharp_stays_as_it_was_and_all_light_arrives() {
    for (camera, _) in CAMERAS {
        // Two atoms beside each other: a near one, and a far one.
        let Some((mut engine, seen)) = staged(&["C -1.6 0 1.5", "C 1.6 0 -1.5"], camera) else { return };
        for (layers, is_sharp_left) in [("[0, 0, 0.5, 0.5]", true), ("[0.5, 0.5, 1, 1]", false)] {
            engine.set_style(style(camera, &format!(r#""layers": {layers}, "blur": "{BLUR}""#)));
            let device = drawn(&mut engine);
            let (mut before, mut after) = (0.0, 0.0);
            for (at, (old, new)) in seen.pixels().zip(seen.color.iter().map(|color| color.truncate()).zip(&device)) {
                let is_left = at[0] < seen.size[0] / 2;
                if is_left == is_sharp_left {
                    assert!(
                        (old - *new).abs().max_element() < 2e-4,
                        "{camera}, {layers}: {at:?} is sharp: {old} {new}"
                    );
                } else {
                    (before, after) = (before + old.x, after + new.x);
                }
            }
            let off = after / before - 1.0;
            eprintln!("{camera}, {layers}: energy off by {:.3} %", 100.0 * off);
            assert!(off.abs() < 0.01, "{camera}, {layers}: energy off by {off}");
        }
    }
}

#[test]
fn nothing_becomes_of_nothing_and_no_number_is_lost() {
    for (camera, _) in CAMERAS {
        let Some((mut engine, _)) = staged(&ATOMS, camera) else { return };
        // Steps, everything before or behind, widest and narrowest.
        for layers in ["[0, 0, 0, 0]", "[1, 1, 1, 1]", "[0.5, 0.5, 0.5, 0.5]", "[0, 1, 1, 1]", "[0, 0, 0, 1]"] {
            for blur in ["0.5pt", "135pt", "1e9"] {
                for method in ["gather", "five_layer"] {
                    let values = format!(r#""method": "{method}", "layers": {layers}, "blur": {blur:?}"#);
                    let values = values.replace("\"1e9\"", "1e9");
                    engine.set_style(style(camera, &values));
                    let transparent = engine::Request { transparent: true, ..gpu::request(SIZE, 2) };
                    let aovs = gpu::aovs(&mut engine, SIZE);
                    assert!(aovs.color.iter().all(|value| (0.0..1.01).contains(value)), "{camera}, {values}");
                    engine.still(&transparent).expect("a still");
                }
            }
        }
    }
}
