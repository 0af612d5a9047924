//! Twin of `shaders/effects/focus_glass.wgsl`, its known answers, the GPU held to it, and to the reference renderer's lines of sight
//! through a whole lens.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::ops::ControlFlow;

use glam::{DVec3, DVec4};
use restyle::config::Style;
use restyle::engine::exact::Exact;
use restyle::engine::{Engine, Request};
use restyle::measure::metrics::{Options, compare};
use restyle::scene::Scene;
use restyle::shipped::{MOLECULES, find};

use super::focus::{
    self, CAMERAS, EVEN_PX, LEAST_RADIUS_PX, LEAST_TAPS, Params, SAME_PX, SIZE, Seen, TAPS, TILE, errors,
    evened_fields, spread_at,
};
use super::gpu;
use super::layers::load;

const BINS: usize = 8;
const INNER_TAPS: u32 = 9;
const LEAST_SHARE: f64 = 1e-4;

/// A transparent surface of a pixel.
#[derive(Debug, Clone, Copy)]
struct Pane {
    color: DVec3,
    opacity: f64,
    depth: f64,
}

/// What is transparent in a picture, from near to far in each pixel, with the largest radii of the scene.
struct Panes<'a> {
    lists: &'a [Vec<Pane>],
    params: &'a Params,
    widest_px: [f64; 2],
}

#[derive(Debug, Clone, Copy)]
struct Glass {
    color: DVec4,
    open: f64,
    before_solid: f64,
    radius_px: f64,
}

const NO_GLASS: Glass = Glass { color: DVec4::ZERO, open: 1.0, before_solid: 1.0, radius_px: 0.0 };

struct Tap {
    off: [i32; 2],
    distance: f64,
    area: f64,
}

fn taps(reach: f64, own: [i32; 2]) -> Vec<Tap> {
    let inner_px = (9.0 / PI).sqrt();
    let wide = (reach + 0.5).max(inner_px);
    let outer = if wide > inner_px { (PI * wide * wide - 9.0).clamp(LEAST_TAPS, TAPS).ceil() as u32 } else { 0 };
    let [turn, start] = focus::noise(own);
    let tap = |tap: u32| {
        if tap < INNER_TAPS {
            let off = [tap as i32 % 3 - 1, tap as i32 / 3 - 1];
            return Tap { off, distance: f64::from(off[0]).hypot(f64::from(off[1])), area: 1.0 };
        }
        let number = f64::from(tap - INNER_TAPS);
        let at = |number: f64| inner_px + (wide - inner_px) * (number / f64::from(outer)).powf(0.75);
        let angle = 2.399_963_2 * number + 2.0 * PI * turn;
        let long = at(number + start);
        let off = [(long * angle.cos()).round_ties_even(), (long * angle.sin()).round_ties_even()];
        let area = PI * (at(number + 1.0).powi(2) - at(number).powi(2));
        Tap { off: off.map(|off| off as i32), distance: off[0].hypot(off[1]), area }
    };
    (0..INNER_TAPS + outer).map(tap).collect()
}

fn fill_of(tap: &Tap) -> f64 {
    tap.area / (1.0 + tap.distance * tap.distance).powi(2)
}

/// By how much more a part of the lens counts that covers so much of it.
fn filled_up(covered: f64) -> f64 {
    let more = ((covered - 0.9) / 0.05).clamp(0.0, 1.0);
    (covered + (1.0 - covered) * more) / covered.max(LEAST_SHARE)
}

impl Panes<'_> {
    fn bin_of(&self, radius: f64, is_near_side: bool) -> usize {
        let most = self.widest_px[usize::from(!is_near_side)].max(LEAST_RADIUS_PX);
        let share = (radius.abs() / most).min(1.0);
        let share = if is_near_side { 1.0 - share } else { share };
        ((share * BINS as f64) as usize).min(BINS - 1)
    }

    /// For each tile the largest radii that reach it, on either side of the focus.
    fn reaching(&self, seen: &Seen) -> (Vec<[f64; 2]>, [i32; 2]) {
        let count = seen.size.map(|side| (side + TILE - 1) / TILE);
        let mut widest = vec![[0.0f64; 2]; (count[0] * count[1]) as usize];
        for at in seen.pixels() {
            for pane in &self.lists[seen.index(at)] {
                let radius = self.params.radius_px(pane.depth);
                let tile = &mut widest[(at[1] / TILE * count[0] + at[0] / TILE) as usize];
                *tile = [tile[0].max(-radius), tile[1].max(radius)];
            }
        }
        let from = |own: i32| {
            let mut reach = [0.0f64; 2];
            for other in 0..count[0] * count[1] {
                let place = |index: i32| [index % count[0], index / count[0]];
                let between =
                    [0, 1].map(|axis| f64::from(((place(own)[axis] - place(other)[axis]).abs() - 1).max(0) * TILE));
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

    fn gather_side(&self, seen: &Seen, own: [i32; 2], is_near_side: bool, reach: f64, near_solid: f64) -> Glass {
        let solid_at = |at: usize| seen.depth[at].is_finite().then(|| self.params.radius_px(seen.depth[at]));
        let index = seen.index(own);
        let circle = solid_at(index);
        let is_near = circle.is_some_and(|radius| radius < -SAME_PX);
        let own_radius = circle.filter(|_| is_near == is_near_side);
        let fills = is_near && !is_near_side;
        let own_bin = own_radius.map(|radius| self.bin_of(radius, is_near_side));
        let taps = taps(reach, own);

        let mut colors = [DVec4::ZERO; BINS + 1];
        let (mut panes, mut solids) = ([[0.0f64; 2]; BINS + 1], [[0.0f64; 2]; BINS + 1]);
        for tap in &taps {
            let at = seen.index([own[0] + tap.off[0], own[1] + tap.off[1]]);
            if let Some(radius) = solid_at(at).filter(|radius| (*radius < -SAME_PX) == is_near_side) {
                let spread = tap.area * spread_at(radius, tap.distance);
                let found = self.bin_of(radius, is_near_side);
                let bin = match (own_radius, own_bin) {
                    (Some(own), _) if radius > own + SAME_PX => found + 1,
                    (_, Some(own_bin)) => found.min(own_bin),
                    _ => found,
                };
                solids[bin] = [solids[bin][0] + spread, solids[bin][1] + spread * radius];
            }
            let (mut bin_before, mut open) = (usize::MAX, 0.0);
            for pane in &self.lists[at] {
                let radius = self.params.radius_px(pane.depth);
                let is_sharp = radius.abs() < LEAST_RADIUS_PX;
                let is_of_side = match is_near_side {
                    true => radius <= -LEAST_RADIUS_PX,
                    false => radius >= LEAST_RADIUS_PX || (is_sharp && fills),
                };
                if !is_of_side {
                    continue;
                }
                let is_behind = own_radius.is_some_and(|own| radius > own + SAME_PX) || (fills && !is_sharp);
                let bin = if is_sharp { 0 } else { self.bin_of(radius, is_near_side) } + usize::from(is_behind);
                if bin != bin_before {
                    open = if is_sharp { fill_of(tap) } else { tap.area * spread_at(radius, tap.distance) };
                    panes[bin] = [panes[bin][0] + open, panes[bin][1] + open * radius];
                }
                bin_before = bin;
                colors[bin] += open * pane.opacity * pane.color.extend(1.0);
                open *= 1.0 - pane.opacity;
            }
        }

        let (mut shares, mut radii, mut solid_shares) = ([0.0f64; BINS + 1], [0.0f64; BINS + 1], [0.0f64; BINS + 1]);
        let mut solid_sum = 0.0;
        for bin in 0..=BINS {
            let [weight, solid_weight] = [panes[bin][0], solids[bin][0]];
            if weight + solid_weight == 0.0 {
                continue;
            }
            radii[bin] = panes[bin][1] / weight.max(1e-9);
            let solid_radius = solids[bin][1] / solid_weight.max(1e-9);
            let (mut whole, mut solid_whole) = (0.0, 0.0);
            for tap in &taps {
                let at = seen.index([own[0] + tap.off[0], own[1] + tap.off[1]]);
                if !solid_at(at).is_some_and(|radius| radius < radii[bin] - SAME_PX) {
                    let spread = tap.area * spread_at(radii[bin], tap.distance);
                    whole += if fills && bin == 0 { fill_of(tap) } else { spread };
                }
                solid_whole += tap.area * spread_at(solid_radius, tap.distance);
            }
            shares[bin] = (weight / f64::max(whole, 1e-9)).min(1.0);
            colors[bin] *= if weight > 0.0 { shares[bin] / weight.max(1e-9) } else { 0.0 };
            solid_shares[bin] = (solid_weight / f64::max(solid_whole, 1e-9)).min(1.0 - solid_sum);
            solid_sum += solid_shares[bin];
        }

        let solid_scale = if is_near_side { near_solid / solid_sum.max(1e-9) } else { 1.0 };
        let mut glass = NO_GLASS;
        let (mut through, mut part, mut covered, mut lens) = (1.0, 0.0, 0.0, 1.0);
        let (mut solid_light, mut radius, mut light) = (0.0, [0.0f64; 2], DVec4::ZERO);
        for bin in 0..=BINS {
            let (share, color) = (shares[bin], colors[bin]);
            if share > LEAST_SHARE {
                let first = share.min(1.0 - covered) / share;
                light += lens * first * color;
                part += first * color.w;
                covered += share * first;
                if first < 1.0 {
                    glass.color += through * light;
                    through *= 1.0 - part;
                    (part, covered) = ((1.0 - first) * color.w, (1.0 - first) * share);
                    light = lens * (1.0 - first) * color;
                }
                radius = [radius[0] + color.w * radii[bin].abs(), radius[1] + color.w];
            } else {
                glass.color += through * filled_up(covered) * light;
                through *= 1.0 - filled_up(covered) * part;
                (part, covered, light) = (0.0, 0.0, DVec4::ZERO);
            }
            let solid = solid_scale * solid_shares[bin];
            solid_light += solid * through * (1.0 - filled_up(covered) * part);
            lens = f64::max(lens - solid, 0.0);
        }
        glass.color += through * filled_up(covered) * light;
        glass.open = through * (1.0 - filled_up(covered) * part);
        glass.before_solid = match is_near_side {
            true if solid_sum > LEAST_SHARE && near_solid > LEAST_SHARE => solid_light / near_solid,
            true => glass.open,
            false => solid_light + lens * glass.open,
        }
        .clamp(0.0, 1.0);
        glass.radius_px = radius[0] / radius[1].max(1e-9);
        glass
    }

    /// The picture over what is opaque, of one sample.
    fn composed(&self, seen: &Seen) -> Vec<DVec4> {
        let (fields, evened) = evened_fields(seen, self.params);
        let (reaching, count) = self.reaching(seen);
        let radius_at = |index: usize| self.params.radius_px(seen.depth[index]);
        let is_near = |index: usize| seen.depth[index].is_finite() && radius_at(index) < -SAME_PX;
        let side = |own: [i32; 2], is_near_side: bool| {
            let index = seen.index(own);
            let near_solid = fields[index][0].w;
            let mut reach = reaching[(own[1] / TILE * count[0] + own[0] / TILE) as usize][usize::from(!is_near_side)];
            if !is_near_side && is_near(index) && near_solid < 0.999 {
                reach = reach.max(-radius_at(index));
            }
            if reach < LEAST_RADIUS_PX {
                return NO_GLASS;
            }
            self.gather_side(seen, own, is_near_side, reach, near_solid)
        };
        let near: Vec<Glass> = seen.pixels().map(|own| side(own, true)).collect();
        let far: Vec<Glass> = seen.pixels().map(|own| side(own, false)).collect();
        let mean = |own: [i32; 2], of: &[Glass], is_near_side: bool| {
            let index = seen.index(own);
            let side = EVEN_PX.min(of[index].radius_px).round_ties_even().max(1.0) as i32;
            let (mut sum, mut count) = (Glass { open: 0.0, before_solid: 0.0, ..NO_GLASS }, 0.0f64);
            for step in 0..side * side {
                let other = seen.index([own[0] + step % side - side / 2, own[1] + step / side - side / 2]);
                let is_like = seen.depth[index].is_finite() == seen.depth[other].is_finite()
                    && (radius_at(other) < -SAME_PX) == (radius_at(index) < -SAME_PX)
                    && (radius_at(other) - radius_at(index)).abs() <= SAME_PX.max(0.25 * radius_at(index).abs());
                if is_near_side || is_like {
                    sum.color += of[other].color;
                    sum.open += of[other].open;
                    sum.before_solid += of[other].before_solid;
                    count += 1.0;
                }
            }
            let share = 1.0 / count.max(1.0);
            (share * sum.color, share * sum.open, share * sum.before_solid)
        };
        let pixel = |own: [i32; 2]| {
            let index = seen.index(own);
            let [solid_near, solid_far] = evened[index];
            let (near, near_open, near_before) = mean(own, &near, true);
            let (far, _, far_before) = mean(own, &far, false);
            let mut sharp = DVec4::ZERO;
            for pane in &self.lists[index] {
                if self.params.radius_px(pane.depth).abs() < LEAST_RADIUS_PX {
                    sharp += (1.0 - sharp.w) * pane.opacity * pane.color.extend(1.0);
                }
            }
            let behind = sharp + (1.0 - sharp.w) * (far + far_before * solid_far);
            near + near_before * solid_near + (1.0 - solid_near.w) * near_open * behind
        };
        seen.pixels().map(pixel).collect()
    }
}

/// A square that is turned about its upright middle.
#[derive(Clone, Copy)]
struct Square {
    name: &'static str,
    middle: [f64; 3],
    half: [f64; 2],
    turned_rad: f64,
}

const fn square(name: &'static str, middle: [f64; 3], half: [f64; 2]) -> Square {
    Square { name, middle, half, turned_rad: 0.0 }
}

/// A wall with stripes, an opaque bar before it, and three panes, one of them across all depths.
const SQUARES: [Square; 8] = [
    square("wall", [0.0, 0.0, -0.9], [1.0, 0.9]),
    square("stripe0", [-0.6, 0.0, -0.88], [0.1, 0.8]),
    square("stripe1", [0.0, 0.0, -0.88], [0.1, 0.8]),
    square("stripe2", [0.6, 0.0, -0.88], [0.1, 0.8]),
    square("bar", [0.15, -0.2, 0.6], [0.08, 0.5]),
    square("pane0", [-0.3, 0.2, 0.8], [0.35, 0.3]),
    square("pane1", [0.25, -0.15, 0.1], [0.4, 0.35]),
    Square { turned_rad: 1.0, ..square("pane2", [-0.1, -0.4, 0.0], [0.9, 0.25]) },
];
const PANES: [(&str, &str, f64); 3] = [("pane0", "#ff8040", 0.4), ("pane1", "#40a0ff", 0.6), ("pane2", "#f0e060", 0.3)];

fn squares(all: &[Square]) -> Scene {
    let mut text = String::new();
    for (index, Square { name, middle, half, turned_rad }) in all.iter().enumerate() {
        let _ = writeln!(text, "o {name}");
        for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let (x, y) = (x * half[0], y * half[1]);
            let (dx, dz) = (x * turned_rad.cos(), x * turned_rad.sin());
            let _ = writeln!(text, "v {} {} {}", middle[0] + dx, middle[1] + y, middle[2] + dz);
        }
        let first = 4 * index + 1;
        let _ = writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
    }
    Scene::from_bytes("squares.obj", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// Flat colours, with the panes of some opacities, the others' and effects.
fn style(camera: &str, opacities: [f64; 3], opaque: f64, listed: &str, focus: &str) -> Style {
    let panes: String = PANES
        .iter()
        .zip(opacities)
        .map(|((name, color, _), opacity)| {
            format!(
                r##"{{ "name": "{name}", "shader": "unlit", "properties": {{ "base_color": "{color}", "opacity": {opacity} }} }},"##
            )
        })
        .collect();
    let mapped: String = PANES.iter().map(|(name, ..)| format!(r#""mesh[part={name}]": "{name}", "#)).collect();
    let focus = if listed.contains("focus") {
        format!(r#", {{ "name": "focus", "shader": "dofPost", "properties": {{ {focus} }} }}"#)
    } else {
        String::new()
    };
    let lines = if listed.contains("lines") {
        r#", { "name": "lines", "shader": "outlinePost", "properties": { "silhouette_width": "12pt" } }"#
    } else {
        ""
    };
    load(&format!(
        r##"{{ "camera": {{ "bgcolor": "black", {camera} }},
            "mapping": {{ "*": "wall", "mesh[part=stripe*]": "stripe", {mapped}"post_effects": [{listed}] }},
            "shaders": [{panes}
              {{ "name": "wall", "shader": "unlit", "properties": {{ "base_color": "#40b040", "opacity": {opaque} }} }},
              {{ "name": "stripe", "shader": "unlit", "properties": {{ "base_color": "#2010a0", "opacity": {opaque} }} }}{lines}{focus}] }}"##
    ))
}

const OPACITIES: [f64; 3] = [PANES[0].2, PANES[1].2, PANES[2].2];

/// What is opaque, and the panes of each pixel before it.
fn staged(engine: &mut Engine, camera: &str) -> (Seen, Vec<Vec<Pane>>) {
    let mut shown = |opacities, opaque| {
        engine.set_style(style(camera, opacities, opaque, "", ""));
        let aovs = gpu::aovs(engine, SIZE);
        let color = |c: &[f32]| DVec4::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]), f64::from(c[3]));
        Seen {
            size: SIZE.map(|side| side as i32),
            color: aovs.color.chunks_exact(4).map(color).collect(),
            depth: aovs.depth.iter().map(|depth| f64::from(*depth)).collect(),
        }
    };
    let opaque = shown([0.0; 3], 1.0);
    let mut lists = vec![Vec::new(); opaque.depth.len()];
    for (index, (_, color, opacity)) in PANES.iter().enumerate() {
        let mut alone = [0.0; 3];
        alone[index] = 1.0;
        let seen = shown(alone, 0.0);
        for ((list, depth), solid) in lists.iter_mut().zip(&seen.depth).zip(&opaque.depth) {
            if depth < solid {
                list.push(Pane { color: gpu::color(color).as_dvec3(), opacity: *opacity, depth: *depth });
            }
        }
    }
    for list in &mut lists {
        list.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    }
    (opaque, lists)
}

fn engine(scene: Scene) -> Option<Engine> {
    Some(Engine::new(gpu::device()?, scene, style("", OPACITIES, 1.0, "", "")))
}

#[test]
fn the_gpu_blurs_glass_as_the_twin_does() {
    for (camera, orthographic) in CAMERAS {
        let Some(mut engine) = engine(squares(&SQUARES)) else { return };
        let (seen, lists) = staged(&mut engine, camera);
        for layers in [[0.1, 0.4, 0.5, 0.9], [0.2, 0.8, 0.9, 1.0], [0.0, 0.1, 0.2, 0.7]] {
            let params = focus::layers(&engine, orthographic, layers, 8.0);
            let (middle, radius) = focus::depths(&engine);
            let widest_px = [-1.0, 1.0].map(|side: f64| (side * params.radius_px(middle + side * radius)).max(0.0));
            let twin = Panes { lists: &lists, params: &params, widest_px }.composed(&seen);
            let values = format!(r#""layers": {layers:?}, "blur": "{}""#, focus::BLUR);
            engine.set_style(style(camera, OPACITIES, 1.0, r#""focus""#, &values));
            let device = focus::drawn(&mut engine);
            let (mean, off) = errors(&device, &twin);
            let (changed, _) = errors(&device, &seen.color);
            eprintln!("{camera}, {layers:?}: error {mean:.6}, off by 0.01 {off:.4}, changed {changed:.3}");
            assert!(changed > 0.02, "there is something to see");
            // Where a tap lies on the border of two pixels, or a radius on that of two bins, rounding decides.
            assert!(mean < 5e-4 && off < 0.01, "{camera}, {layers:?}: {mean} {off}");
        }
    }
}

#[test]
fn a_blurred_pane_tints_a_sharp_wall_alike() {
    // One pane across the whole view, flat or slanted through many bins, before a wall without stripes.
    for turned_rad in [0.0, 0.6] {
        for (camera, _) in CAMERAS {
            let pane = Square { turned_rad, ..square("pane0", [0.0, 0.0, 0.5], [0.9, 0.9]) };
            let wall = square("wall", [0.0, 0.0, -0.9], [2.0, 2.0]);
            let Some(mut engine) = engine(squares(&[wall, pane])) else { return };
            for layers in ["[0, 0.6, 0.7, 1]", "[0, 0, 0.1, 0.3]"] {
                let values = format!(r#""layers": {layers}, "blur": "{}""#, focus::BLUR);
                engine.set_style(style(camera, OPACITIES, 1.0, r#""focus""#, &values));
                let device = focus::drawn(&mut engine);
                let [wall, pane] = ["#40b040", PANES[0].1].map(|color| gpu::color(color).as_dvec3());
                let expected = wall.lerp(pane, PANES[0].2);
                let mut worst = 0.0f64;
                for (x, y) in (30..42).flat_map(|y| (42..54).map(move |x| (x, y))) {
                    worst = worst.max((device[(y * SIZE[0] + x) as usize] - expected).abs().max_element());
                }
                eprintln!("{camera}, turned {turned_rad}, {layers}: {worst:.5}");
                // Circles that grow by a third of a pixel from one to the next do not add up to the whole lens.
                let most = if turned_rad == 0.0 { 0.001 } else { 0.05 };
                assert!(worst < most, "{camera}, turned {turned_rad}, {layers}: {worst}");
            }
        }
    }
}

/// FLIP of a still against lines of sight through so many places of a lens.
fn flip(scene: &dyn Fn() -> Scene, look: &dyn Fn() -> Style, size: [u32; 2], lenses: u32) -> Option<f64> {
    let mut engine = Engine::new(gpu::device()?, scene(), look());
    let request = Request { wide: true, ..Request::new(size, 16) };
    let drawn = engine.still(&request).expect("a still");
    let exact = Exact::new(scene(), look(), None);
    let through = Request { samples: lenses, ..request };
    let truth = exact.still(&through, &mut |_| ControlFlow::Continue(())).expect("the reference");
    Some(compare(&truth, &drawn, &Options::default()).expect("one size").metrics.flip)
}

#[test]
fn glass_out_of_focus_is_that_of_a_lens() {
    let sharp_wall = r#""layers": [0, 0.6, 0.7, 1], "blur": "90pt""#;
    let sharp_glass = r#""layers": [0, 0, 0.25, 0.7], "blur": "60pt""#;
    for (camera, _) in CAMERAS {
        for (what, focus) in [("sharp wall", sharp_wall), ("sharp glass", sharp_glass)] {
            // What is blurred before the focus and opaque is the matter of `focus.rs`.
            let scene = || squares(&SQUARES.into_iter().filter(|square| square.name != "bar").collect::<Vec<_>>());
            let look = || style(camera, OPACITIES, 1.0, r#""focus""#, focus);
            let Some(flip) = flip(&scene, &look, [128, 96], 256) else { return };
            eprintln!("{what}, {camera}: FLIP {flip:.4}");
            assert!(flip < 0.05, "{what}, {camera}: {flip}");
        }
    }
}

fn caffeine() -> Scene {
    let file = find(MOLECULES, "caffeine").expect("a shipped molecule");
    Scene::from_bytes(file.file, file.bytes).unwrap_or_else(|error| panic!("{error}"))
}

const FOCUS: &str = r#""focus": "center", "layers": [0, 0, 1, 1]"#;

/// Atoms of glass whose opacity follows curvature, before such an effect.
fn curved_glass(properties: &str, focus: &str) -> Style {
    load(
        &r##"{ "camera": { "bgcolor": "white", "position": [0.8, 0.7, 2.2] }, "geometry": { "atom": "vdw", "scale": 0.6 },
                "mapping": { "atom": "glass", "connector": "plain", "post_effects": ["focus"] },
                "shaders": [{ "name": "plain", "shader": "basic" },
                  { "name": "glass", "shader": "curvature", "properties": { PROPERTIES } },
                  { "name": "focus", "shader": "dofPost", "properties": { FOCUS, "blur": "90pt" } }] }"##
            .replace("PROPERTIES", properties)
            .replace("FOCUS", focus),
    )
}

#[test]
fn glass_by_curvature_is_that_of_a_lens() {
    let Some(flip) = flip(&caffeine, &|| curved_glass("", FOCUS), [128, 128], 256) else { return };
    eprintln!("glass by curvature: FLIP {flip:.4}");
    assert!(flip < 0.05, "{flip}");
}

#[test]
fn glass_by_curvature_of_neighbouring_pixels_is_blurred_alike() {
    let Some(gpu) = gpu::device() else { return };
    let still = |source: &str| {
        let look = curved_glass(&format!(r#""curvature_source": "{source}""#), FOCUS);
        let mut engine = Engine::new(gpu.clone(), caffeine(), look);
        engine.still(&Request::new([256, 256], 4)).expect("a still")
    };
    let [surface, screen] = ["surface", "screen"].map(still);
    let flip = compare(&surface, &screen, &Options::default()).expect("one size").metrics.flip;
    eprintln!("glass by curvature of neighbouring pixels: FLIP {flip:.4}");
    // What lies in the place of something else doubles it.
    assert!(flip < 0.0015, "{flip}");
}

#[test]
fn lines_on_glass_are_blurred_with_it() {
    let all = [square("wall", [0.0, 0.0, -0.9], [1.0, 0.9]), square("pane0", [-0.1, 0.1, 0.7], [0.4, 0.4])];
    let focus = r#""layers": [0, 0.6, 0.7, 1], "blur": "90pt""#;
    let look = || style(r#""fov": 45"#, OPACITIES, 1.0, r#""lines", "focus""#, focus);
    let Some(flip) = flip(&|| squares(&all), &look, [96, 72], 64) else { return };
    eprintln!("lines on glass: FLIP {flip:.4}");
    assert!(flip < 0.05, "{flip}");
}

#[test]
fn lists_that_are_too_long_are_blended_first() {
    let all: Vec<Square> =
        (0..30).map(|index| square("pane0", [0.0, 0.0, f64::from(index) / 30.0], [1.0, 1.0])).collect();
    let request = Request::new([400, 300], 1);
    for (memory_mb, is_merged) in [(512, false), (16, true)] {
        let values = r#""layers": [0, 0.6, 0.7, 1], "blur": "90pt""#;
        let mut style = style(r#""zoom": 2"#, [0.02; 3], 1.0, r#""focus""#, values);
        style.transparency.memory_mb = memory_mb;
        let Some(gpu) = gpu::device() else { return };
        let mut engine = Engine::new(gpu, squares(&all), style);
        let twice = [engine.still(&request), engine.still(&request)].map(|image| image.expect("a still").pixels);
        assert_eq!(twice[0], twice[1]);
        assert_eq!(engine.layers_are_merged(&request).expect("a plan"), is_merged, "{memory_mb} MB");
    }
}

#[test]
fn glass_does_not_depend_on_what_was_drawn_before() {
    let all: Vec<Square> =
        (0..30).map(|index| square("pane0", [0.0, 0.0, f64::from(index) / 30.0], [1.0, 1.0])).collect();
    let request = Request::new([400, 300], 1);
    let look = |memory_mb, listed| {
        let mut style = style(r#""zoom": 2"#, [0.02; 3], 1.0, listed, r#""layers": [0, 0.6, 0.7, 1], "blur": "90pt""#);
        style.transparency.memory_mb = memory_mb;
        style
    };
    let Some(gpu) = gpu::device() else { return };
    let mut used = Engine::new(gpu.clone(), squares(&all), look(16, ""));
    // In bands, merged, apart, and in bands once more.
    for (memory_mb, listed) in [(16, ""), (16, r#""focus""#), (512, r#""focus""#), (16, "")] {
        used.set_style(look(memory_mb, listed));
        let mut fresh = Engine::new(gpu.clone(), squares(&all), look(memory_mb, listed));
        let [one, other] = [&mut used, &mut fresh].map(|engine| engine.still(&request).expect("a still").pixels);
        assert!(one == other, "{memory_mb} MB, {listed}");
        let merged = [&mut used, &mut fresh].map(|engine| engine.layers_are_merged(&request).expect("a plan"));
        assert_eq!(merged[0], merged[1], "{memory_mb} MB, {listed}");
    }
}
