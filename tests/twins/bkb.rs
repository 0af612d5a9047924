//! Twin of `shaders/bkb/`: insertion, reordering, hashing, query, neighbours, curvature and blending [Murray2016 §4, §5], and the
//! device held to it, word by word wherever that is exact.

use std::fmt::Write as _;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use restyle::config;
use restyle::engine::{BkbForm, BkbWords, Engine, Gpu, Request};
use restyle::frame::bkb::BkbBand;
use restyle::gpu::ShaderEdits;
use restyle::scene::{Camera, Image, Pixels, Scene};
use restyle::shipped::{MESHES, MOLECULES, find};

use super::{gpu, layers};

pub const EMPTY: u32 = u32::MAX;
const DEPTH_STEPS: f64 = 65534.0;

/// Keys as the k-buffer keeps them: each slot the smaller one, the larger goes on; equal ones are one.
pub fn insert(slots: &mut [u32], mut key: u32) {
    for slot in slots {
        let former = *slot;
        *slot = former.min(key);
        if former == EMPTY || former == key {
            return;
        }
        key = former.max(key);
    }
}

fn swapped(key: u32) -> u32 {
    key.rotate_left(16)
}

/// Lists of depths to lists of shapes, and within each of depths; free slots stay last.
fn reorder(slots: &mut [u32]) {
    slots.iter_mut().filter(|key| **key != EMPTY).for_each(|key| *key = swapped(*key));
    for index in 1..slots.len() {
        let mut at = index;
        while at > 0 && slots[at - 1] > slots[at] {
            slots.swap(at - 1, at);
            at -= 1;
        }
    }
}

/// The hash table of a list in the order of shapes.
fn buckets(z: &[u32]) -> Vec<u32> {
    let k = z.len();
    let mut table = vec![EMPTY; k];
    let count = z.iter().take_while(|key| **key != EMPTY).count();
    let mut start = 0;
    while start < count {
        let shape = z[start] >> 16;
        let end = (start..count).take_while(|slot| z[*slot] >> 16 == shape).last().expect("the first is one") + 1;
        let mut place = shape as usize;
        while table[place % k] != EMPTY {
            place += 1;
        }
        table[place % k] = shape << 16 | (start as u32) << 8 | (end as u32 - 1);
        start = end;
    }
    table
}

/// Slots of the bucket of a shape.
fn query(b: &[u32], shape: u32) -> std::ops::Range<usize> {
    for probe in 0..b.len() {
        match b[(shape as usize + probe) % b.len()] {
            EMPTY => break,
            bucket if bucket >> 16 == shape => return (bucket >> 8 & 0xff) as usize..(bucket & 0xff) as usize + 1,
            _ => {}
        }
    }
    0..0
}

/// What the device multiplies and adds, in its precision.
pub fn stored_depth(band: &BkbBand, t: f32) -> u32 {
    (((t - band.near) * band.depth_scale).clamp(0.0, DEPTH_STEPS as f32) + 0.5) as u32
}

fn pack_normal(normal: DVec3) -> u32 {
    let place = |value: f64| (value.clamp(-1.0, 1.0) * 16383.0 + 16383.5) as u32;
    place(normal.x) | place(normal.y) << 15 | if normal.z < 0.0 { 1 << 30 } else { 2 << 30 }
}

fn unpack_normal(word: u32) -> DVec3 {
    let [x, y] = [word & 0x7fff, word >> 15 & 0x7fff].map(|place| f64::from(place) / 16383.0 - 1.0);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    DVec3::new(x, y, if word >> 30 == 1 { -z } else { z })
}

/// A k-buffer as the device holds it, and how neighbours are looked for.
struct Held<'a> {
    words: &'a BkbWords,
    form: BkbForm,
    camera: Camera,
}

/// A fragment of a pixel.
#[derive(Clone, Copy)]
struct Fragment {
    slot: usize,
    normal: DVec3,
    depth: f64,
}

/// The best of some candidates, and how much better it is than the next best.
type Best = (Option<Fragment>, f64);

impl<'a> Held<'a> {
    fn new(words: &'a BkbWords, form: BkbForm, engine: &Engine) -> Held<'a> {
        let size = [words.band.width, words.band.height];
        Held { words, form, camera: engine.camera(size).expect("a camera") }
    }

    fn k(&self) -> usize {
        self.words.band.k as usize
    }

    fn slots<'b>(&self, of: &'b [u32], [x, y]: [u32; 2]) -> &'b [u32] {
        let first = (y * self.words.band.width + x) as usize * self.k();
        &of[first..first + self.k()]
    }

    fn fragment(&self, at: [u32; 2], slot: usize) -> Fragment {
        let first = (at[1] * self.words.band.width + at[0]) as usize * self.k();
        let depth = f64::from(self.words.z[first + slot] & 0xffff) / DEPTH_STEPS;
        Fragment { slot, normal: unpack_normal(self.words.d[(first + slot) * 2 + 1]), depth }
    }

    fn candidates(&self, at: [u32; 2], shape: u32) -> std::ops::Range<usize> {
        match self.form {
            BkbForm::BruteForce => 0..self.slots(&self.words.z, at).iter().take_while(|key| **key != EMPTY).count(),
            _ => query(self.slots(&self.words.b, at), shape),
        }
    }

    fn most_like(&self, at: [u32; 2], shape: u32, fragment: &Fragment) -> Best {
        let error = |other: &Fragment| {
            let apart = fragment.depth - other.depth;
            1.0 - fragment.normal.dot(other.normal) + apart * apart
        };
        let mut all: Vec<Fragment> = self.candidates(at, shape).map(|slot| self.fragment(at, slot)).collect();
        all.sort_by(|a, b| error(a).total_cmp(&error(b)));
        let margin = all.get(1).map_or(f64::INFINITY, |second| error(second) - error(&all[0]));
        (all.first().copied(), margin)
    }

    /// kappa of a fragment; none where rounding decides who its neighbours are.
    fn kappa(&self, at: [u32; 2], slot: usize) -> Option<f64> {
        const LEAST_MARGIN: f64 = 2e-6;
        let band = &self.words.band;
        let own = self.fragment(at, slot);
        let shape = self.slots(&self.words.z, at)[slot] >> 16;
        let low = at.map(|place| place.saturating_sub(1));
        let high = [(at[0] + 1).min(band.width - 1), (at[1] + 1).min(band.height - 1)];
        let mut normals = [own.normal; 4];
        let (mut is_missing, mut is_sure) = (false, true);
        for (normal, place) in
            normals.iter_mut().zip([[low[0], at[1]], [high[0], at[1]], [at[0], high[1]], [at[0], low[1]]])
        {
            if place == at {
                continue;
            }
            let (found, margin) = self.most_like(place, shape, &own);
            let Some(found) = found else {
                is_missing = true;
                continue;
            };
            is_sure &= margin > LEAST_MARGIN;
            if self.form != BkbForm::OneWay {
                let (back, margin) = self.most_like(at, shape, &found);
                is_sure &= margin > LEAST_MARGIN;
                is_missing |= back.is_none_or(|back| back.slot != slot);
            }
            *normal = found.normal;
        }
        if !is_sure {
            return None;
        }
        if is_missing {
            return Some(-1.0);
        }
        let half = self.camera.half_extent.as_dvec2();
        let step = DVec2::new(2.0, -2.0) * half / DVec2::new(f64::from(band.width), f64::from(band.height));
        let dx = (normals[1] - normals[0]) / (step.x * f64::from(high[0] - low[0]));
        let dy = (normals[2] - normals[3]) / (step.y * f64::from(high[1] - low[1]));
        let plane = DVec2::new(f64::from(at[0]) + 0.5, f64::from(at[1]) + 0.5) * step + DVec2::new(-half.x, half.y);
        let t = f64::from(band.near) + own.depth * DEPTH_STEPS / f64::from(band.depth_scale);
        let sum = if self.camera.orthographic {
            -(dx.x + dy.y)
        } else {
            -(dx.x + dy.y + plane.x * dx.z + plane.y * dy.z) / t
        };
        Some((sum * f64::from(band.curvature_scale)).tanh())
    }

    fn places(&self) -> impl Iterator<Item = [u32; 2]> {
        let band = self.words.band;
        (0..band.height).flat_map(move |y| (0..band.width).map(move |x| [x, y]))
    }

    /// Compares all kappas with the device's; returns how many were compared, and the share of those that rounding decides.
    fn compare_kappas(&self, said: &str) -> (usize, f64) {
        let (mut compared, mut unsure, mut worst) = (0usize, 0usize, 0.0f64);
        for at in self.places() {
            let first = (at[1] * self.words.band.width + at[0]) as usize * self.k();
            let count = self.slots(&self.words.z, at).iter().take_while(|key| **key != EMPTY).count();
            for slot in 0..count {
                let Some(twin) = self.kappa(at, slot) else {
                    unsure += 1;
                    continue;
                };
                let device = f64::from(self.words.kappa[first + slot]);
                let error = (twin - device).abs();
                assert!(error < KAPPA, "{said}, {at:?}, slot {slot}: {device} and by the twin {twin}");
                worst = worst.max(error);
                compared += 1;
            }
        }
        let unsure = unsure as f64 / (compared + unsure).max(1) as f64;
        eprintln!("{said}: {compared} kappas, largest error {worst:.1e}, rounding decides {:.3} %", 100.0 * unsure);
        (compared, unsure)
    }
}

/// Differences of normals of 32 bits over two pixels, times the scene's radius; largest seen 8e-5 on llvmpipe 15.
const KAPPA: f64 = 5e-4;

/// Squares across the view at depths in no order, each of the next of some objects.
fn squares(count: usize, objects: usize) -> Scene {
    let mut text = String::new();
    let mut corners = 0;
    for object in 0..objects {
        let _ = writeln!(text, "o part{object}");
        for index in (0..count).filter(|index| index % objects == object) {
            let z = -(((index * 89 + 31) % count) as f64) / count as f64;
            for [x, y] in [[-1.0, -0.93], [1.0, -0.93], [1.0, 1.1], [-1.0, 1.1]] {
                let _ = writeln!(text, "v {x} {y} {z}");
            }
            let _ = writeln!(text, "f {} {} {} {}", corners + 1, corners + 2, corners + 3, corners + 4);
            corners += 4;
        }
    }
    Scene::from_bytes("squares.obj", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// The object of each square in the order of their triangles.
fn objects_of(count: usize, objects: usize) -> Vec<u32> {
    (0..objects)
        .flat_map(|object| (0..count).filter(move |index| index % objects == object).map(move |_| object as u32))
        .collect()
}

/// Flat colours of glass seen straight ahead.
fn style(transparency: &str, opacity: f64, more: &str) -> config::Style {
    layers::load(&format!(
        r##"{{ "camera": {{ "bgcolor": "#f0e0a0", "orthographic": true, "position": [0, 0, 1], "zoom": 2.5 }},
            "mapping": {{ "*": "glass"{more} }},
            "shaders": [
              {{ "name": "glass", "shader": "unlit", "properties": {{ "base_color": "#2060d0", "opacity": {opacity} }} }},
              {{ "name": "red", "shader": "unlit", "properties": {{ "base_color": "#d04020", "opacity": {opacity} }} }},
              {{ "name": "solid", "shader": "unlit", "properties": {{ "base_color": "#208040" }} }}],
            "transparency": {{ {transparency} }} }}"##
    ))
}

fn bkb(k: usize) -> String {
    format!(r#""method": "bkb", "k": {k}"#)
}

/// A look of glass for scenes of their own.
fn glass(camera: &str, k: usize, memory_mb: u32) -> config::Style {
    layers::load(&format!(
        r##"{{ "camera": {{ "bgcolor": "white"{camera} }}, "geometry": {{ "atom": "vdw", "scale": 0.6 }},
            "mapping": {{ "*": "glass" }},
            "lights": [{{ "type": "directional", "position": [-1, 2, 2] }}, {{ "type": "ambient", "intensity": 0.6 }}],
            "shaders": [{{ "name": "glass", "shader": "basic", "properties": {{ "opacity": 0.35 }} }}],
            "transparency": {{ "method": "bkb", "k": {k}, "memory_mb": {memory_mb} }} }}"##
    ))
}

fn shipped(name: &str) -> Scene {
    let file = [MOLECULES, MESHES].iter().find_map(|among| find(among, name)).expect("a shipped scene");
    Scene::from_bytes(file.file, file.bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn engine(scene: Scene, style: config::Style) -> Option<Engine> {
    Some(Engine::new(gpu::device()?, scene, style))
}

fn words(engine: &mut Engine, size: [u32; 2]) -> BkbWords {
    engine.bkb_words(&Request::new(size, 1)).expect("a frame").expect("a k-buffer in one band")
}

/// Numbers in no order.
pub fn shuffled(count: u32, salt: u32) -> Vec<u32> {
    let mut all: Vec<u32> = (0..count).collect();
    all.sort_by_key(|index| (index ^ salt).wrapping_mul(2_654_435_761).rotate_left(13));
    all
}

#[test]
fn insertion_keeps_the_k_nearest_in_order_whatever_comes_first() {
    for k in [1, 2, 7, 64] {
        for count in [0, 1, 5, 64, 200] {
            for salt in 0..5 {
                let keys: Vec<u32> = shuffled(count, salt).iter().map(|key| ((key / 2) << 16) | (key % 3)).collect();
                let mut slots = vec![EMPTY; k];
                keys.iter().for_each(|key| insert(&mut slots, *key));
                let mut expected = keys.clone();
                expected.sort_unstable();
                expected.dedup();
                expected.resize(k, EMPTY);
                assert_eq!(slots, expected, "{k} of {count}");
            }
        }
    }
}

#[test]
fn every_shape_is_found_in_its_bucket_and_no_other() {
    for k in [1usize, 2, 8, 64] {
        // Shapes that all want one slot, that follow each other, and that are as large as 16 bits.
        for shape_of in [|key: u32, k: u32| key / 2 * k, |key: u32, _: u32| key / 3, |key: u32, _: u32| 65535 - key] {
            let keys = (0..k as u32).map(|key| (key * 7 % 11) << 16 | (shape_of(key, k as u32) & 0xffff));
            let mut z: Vec<u32> = vec![EMPTY; k];
            keys.for_each(|key| insert(&mut z, key));
            reorder(&mut z);
            assert!(z.is_sorted());
            let b = buckets(&z);
            let count = z.iter().take_while(|key| **key != EMPTY).count();
            for shape in z[..count].iter().map(|key| key >> 16) {
                let range = query(&b, shape);
                let expected: Vec<usize> = (0..count).filter(|slot| z[*slot] >> 16 == shape).collect();
                assert_eq!(range.collect::<Vec<_>>(), expected, "{k} slots, shape {shape}");
            }
            assert!(query(&b, 40_000).is_empty());
        }
    }
}

#[test]
fn normals_come_back_within_their_steps() {
    let mut worst = 0.0f64;
    for turn in 0..2000 {
        let z = 1.0 - 2.0 * (f64::from(turn) + 0.5) / 2000.0;
        let (sine, cosine) = (f64::from(turn) * 2.4).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        let normal = DVec3::new(cosine * flat, sine * flat, z);
        assert_ne!(pack_normal(normal), 0);
        worst = worst.max(unpack_normal(pack_normal(normal)).angle_between(normal).to_degrees());
    }
    // Where z is next to 0, its square root is steep [Murray2016 §4.2].
    assert!(worst < 0.6, "{worst}");
    assert_eq!(unpack_normal(pack_normal(DVec3::Z)), DVec3::Z);
}

/// What the device holds is what its own fragments come to, by a rule from ids to shapes; returns how many fragments share a key.
fn compare_words(words: &BkbWords, shape_of: &dyn Fn(u32) -> u32, said: &str) -> usize {
    let k = words.band.k as usize;
    let (mut equal, mut kept) = (0, 0);
    for (pixel, fragments) in words.fragments.iter().enumerate() {
        let mut slots = vec![EMPTY; k];
        let key =
            |[depth, id]: &[u32; 2]| stored_depth(&words.band, f32::from_bits(*depth)) << 16 | (shape_of(*id) & 0xffff);
        let mut keys: Vec<u32> = fragments.iter().map(key).collect();
        keys.iter().rev().for_each(|key| insert(&mut slots, *key));
        reorder(&mut slots);
        let at = pixel * k..(pixel + 1) * k;
        assert_eq!(words.z[at.clone()], slots, "{said}: Z of pixel {pixel}");
        assert_eq!(words.b[at.clone()], buckets(&slots), "{said}: B of pixel {pixel}");
        for (slot, key) in at.zip(&slots) {
            assert_eq!(words.d[2 * slot + 1] != 0, *key != EMPTY, "{said}: D of pixel {pixel} has what Z has");
            kept += usize::from(*key != EMPTY);
        }
        keys.sort_unstable();
        equal += keys.windows(2).filter(|pair| pair[0] == pair[1]).count();
    }
    assert!(kept > 0, "{said}: there is nothing");
    equal
}

#[test]
fn words_of_squares_are_those_of_the_twin() {
    let size = [24, 16];
    for (count, objects, k) in [(1, 1, 1), (5, 2, 8), (16, 3, 16), (32, 32, 32), (32, 4, 7), (64, 1, 64), (64, 9, 64)] {
        let Some(mut engine) = engine(squares(count, objects), style(&bkb(k), 0.3, "")) else { return };
        let words = words(&mut engine, size);
        let said = format!("{count} squares of {objects} objects, k = {k}");
        let of = objects_of(count, objects);
        let shape = |id: u32| of[(id & 0x1fff_ffff) as usize / 2];
        assert!(words.fragments.iter().all(|fragments| fragments.len() == count), "{said}");
        assert_eq!(compare_words(&words, &shape, &said), 0, "{said}: no two are equal");
        for pair in words.d.chunks_exact(2).zip(&words.z).filter(|(_, key)| **key != EMPTY).map(|(pair, _)| pair) {
            assert_eq!(pair[1], pack_normal(DVec3::Z), "{said}");
            // As they were written, #2060d0, and an opacity of 0.3.
            assert_eq!(pair[0], u32::from_le_bytes([0x20, 0x60, 0xd0, 77]), "{said}");
        }
        let held = Held::new(&words, BkbForm::Published, &engine);
        for (at, kappa) in held.places().zip(words.kappa.chunks_exact(k)) {
            let count = held.slots(&words.z, at).iter().take_while(|key| **key != EMPTY).count();
            assert!(kappa[..count].iter().all(|kappa| *kappa == 0.0), "{said}: flat, and no neighbour is missing");
        }
    }
}

#[test]
fn words_of_atoms_and_bonds_are_those_of_the_twin() {
    for camera in ["", r#", "orthographic": true"#] {
        let Some(mut engine) = engine(shipped("caffeine"), glass(camera, 12, 512)) else { return };
        let words = words(&mut engine, [96, 80]);
        let num_atoms = words.band.first_connector;
        let shape = |id: u32| (id & 0x1fff_ffff) + if id >> 29 == 2 { num_atoms } else { 0 };
        let most = words.fragments.iter().map(Vec::len).max().unwrap_or(0);
        assert!((4..=12).contains(&most), "{most}");
        assert_eq!(compare_words(&words, &shape, "caffeine"), 0);
        let (compared, unsure) = Held::new(&words, BkbForm::Published, &engine).compare_kappas("caffeine");
        assert!(compared > 3000 && unsure < 0.001, "{compared}, {unsure}");
    }
}

#[test]
fn normals_of_the_nearest_are_those_that_aovs_have() {
    let Some(mut engine) = engine(shipped("caffeine"), glass("", 12, 512)) else { return };
    let size = [96, 80];
    let aovs = gpu::aovs(&mut engine, size);
    let words = words(&mut engine, size);
    let (mut compared, mut steps) = (0, 0);
    for (pixel, fragments) in words.fragments.iter().enumerate().filter(|(_, fragments)| !fragments.is_empty()) {
        let nearest = stored_depth(&words.band, f32::from_bits(fragments[0][0]));
        let slots = pixel * 12..(pixel + 1) * 12;
        let mut at = slots.filter(|slot| words.z[*slot] != EMPTY && words.z[*slot] & 0xffff == nearest);
        let (Some(slot), None) = (at.next(), at.next()) else { continue };
        let normal = DVec3::from_slice(&[0, 1, 2].map(|axis| f64::from(aovs.normal[3 * pixel + axis])));
        let (word, twin) = (words.d[2 * slot + 1], pack_normal(normal));
        let apart = |shift: u32| (word >> shift & 0x7fff).abs_diff(twin >> shift & 0x7fff);
        assert!(word >> 30 == twin >> 30 && apart(0).max(apart(15)) <= 1, "{word:x} and {twin:x}");
        steps += usize::from(word != twin);
        compared += 1;
    }
    // Rounding to 24 bits before rounding to 15.
    assert!(compared > 1000 && steps * 100 < compared, "{steps} of {compared}");
}

#[test]
fn kappas_of_parts_are_those_of_the_twin_in_every_form() {
    for camera in ["", r#", "orthographic": true"#] {
        for form in [BkbForm::Published, BkbForm::OneWay, BkbForm::BruteForce] {
            let Some(mut engine) = engine(shipped("gearbox"), glass(camera, 24, 512)) else { return };
            engine.set_bkb_form(form);
            let words = words(&mut engine, [80, 60]);
            let (compared, unsure) =
                Held::new(&words, form, &engine).compare_kappas(&format!("gearbox, {form:?}{camera}"));
            assert!(compared > 9000 && unsure < 0.3, "{compared}, {unsure}");
        }
    }
}

#[test]
fn a_check_back_finds_more_neighbours_missing() {
    let missing = |form| {
        let mut engine = engine(shipped("gearbox"), glass("", 24, 512))?;
        engine.set_bkb_form(form);
        Some(words(&mut engine, [80, 60]).kappa.iter().filter(|kappa| **kappa == -1.0).count())
    };
    let (Some(checked), Some(one_way)) = (missing(BkbForm::Published), missing(BkbForm::OneWay)) else { return };
    assert!(checked > one_way + one_way / 20, "{checked} and {one_way}");
}

/// A ball of triangles with the normals of a ball, of radius 1.
fn mesh_ball() -> Scene {
    const ROWS: u32 = 64;
    const COLUMNS: u32 = 128;
    let mut text = "o ball\n".to_owned();
    for row in 0..=ROWS {
        for column in 0..COLUMNS {
            let (polar, turn) = (
                std::f64::consts::PI * f64::from(row) / f64::from(ROWS),
                std::f64::consts::TAU * f64::from(column) / f64::from(COLUMNS),
            );
            let (x, y, z) = (polar.sin() * turn.cos(), polar.cos(), polar.sin() * turn.sin());
            let _ = writeln!(text, "v {x} {y} {z}\nvn {x} {y} {z}");
        }
    }
    for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        let at = |row: u32, column: u32| {
            let vertex = row * COLUMNS + column % COLUMNS + 1;
            format!("{vertex}//{vertex}")
        };
        let (a, b) = (at(row, column), at(row, column + 1));
        let (c, d) = (at(row + 1, column + 1), at(row + 1, column));
        let _ = writeln!(text, "f {a} {b} {c} {d}");
    }
    Scene::from_bytes("ball.obj", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn balls_and_rods_have_the_curvature_of_their_radii() {
    // A scene, what is glass, and the curvature of each of its surfaces from near to far, in the scene's units.
    let ball = || Scene::from_bytes("ball.xyz", b"1\n\nC 0 0 0\n").unwrap_or_else(|error| panic!("{error}"));
    let rod = || Scene::from_bytes("rod.mol2", ROD.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    type Case = (fn() -> Scene, &'static str, f64, &'static [f64]);
    let cases: [Case; 3] = [
        (ball, "atom", 1.0, &[-2.0 / 1.7]),
        (rod, "connector", 0.7, &[-1.0 / 3.5]),
        (mesh_ball, "mesh", 1.0, &[-2.0, 2.0]),
    ];
    for (scene, selector, zoom, curvatures) in cases {
        for camera in ["", r#", "orthographic": true"#] {
            let style = layers::load(&format!(
                r##"{{ "camera": {{ "bgcolor": "white", "position": [0, 0, 4], "zoom": {zoom}{camera} }},
                    "geometry": {{ "atom": "vdw", "scale": {}, "bond_radius": "3.5A" }},
                    "mapping": {{ "*": "solid", "{selector}": "glass" }},
                    "shaders": [{{ "name": "glass", "shader": "unlit", "properties": {{ "opacity": 0.3 }} }},
                      {{ "name": "solid", "shader": "unlit" }}],
                    "transparency": {{ "method": "bkb" }} }}"##,
                if selector == "atom" { 1.0 } else { 0.1 }
            ));
            let Some(mut engine) = engine(scene(), style) else { return };
            let words = words(&mut engine, [200, 200]);
            let (k, num_layers) = (words.band.k as usize, curvatures.len());
            let pixel = |x: u32, y: u32| (y * 200 + x) as usize * k;
            let has_all = |x: u32, y: u32| {
                let kappas = &words.kappa[pixel(x, y)..][..num_layers];
                words.z[pixel(x, y)..][..k].iter().take_while(|key| **key != EMPTY).count() == num_layers
                    && kappas.iter().all(|kappa| *kappa > -1.0)
            };
            // Three pixels from where a neighbour is missing, the outline is left behind.
            let is_inside = |x: u32, y: u32| (x - 3..=x + 3).all(|x| (y - 3..=y + 3).all(|y| has_all(x, y)));
            let (mut worst, mut count) = (0.0f64, 0);
            for (x, y) in (3..197).flat_map(|y| (3..197).map(move |x| (x, y))).filter(|(x, y)| is_inside(*x, *y)) {
                for (slot, expected) in curvatures.iter().enumerate() {
                    let found =
                        f64::from(words.kappa[pixel(x, y) + slot]).atanh() / f64::from(words.band.curvature_scale);
                    worst = worst.max((found / expected - 1.0).abs());
                    count += 1;
                }
            }
            eprintln!("{selector}{camera}: largest error {:.2} % in {count} fragments", 100.0 * worst);
            assert!(count > 300 && worst < 0.02, "{selector}{camera}: {worst} in {count}");
        }
    }
}

/// Two atoms far apart with a bond.
const ROD: &str = "@<TRIPOS>MOLECULE\nrod\n2 1 0 0 0\nSMALL\nNO_CHARGES\n@<TRIPOS>ATOM\n1 C1 -2.0 0.0 0.0 C.3 1 R 0\n\
                   2 C2 2.0 0.0 0.0 C.3 1 R 0\n@<TRIPOS>BOND\n1 1 2 1\n";

#[test]
fn fragments_of_one_key_are_one() {
    // Two squares at one depth, of two objects and of one. Their corners differ, so that both stay.
    let square = |wide: f64| format!("v -{wide} -0.93 -0.5\nv 1 -0.93 -0.5\nv 1 1.1 -0.5\nv -{wide} 1.1 -0.5\n");
    for (between, kept) in [("o two\n", 2), ("", 1)] {
        let (a, b) = (square(1.0), square(1.25));
        let text =
            format!("o one\n{a}f 1 2 3 4\n{between}{b}f 5 6 7 8\nv 0 0 0\nv 0.001 0 0\nv 0 0.001 0\nf 9 10 11\n");
        let scene = Scene::from_bytes("squares.obj", text.as_bytes()).expect("a scene");
        let Some(mut engine) = engine(scene, style(&bkb(4), 0.3, "")) else { return };
        let words = words(&mut engine, [8, 8]);
        for (z, fragments) in words.z.chunks_exact(4).zip(&words.fragments) {
            assert_eq!(fragments.len(), 2);
            assert_eq!(z.iter().filter(|key| **key != EMPTY).count(), kept);
        }
    }
}

#[test]
fn few_fragments_of_an_assembly_share_a_key() {
    let Some(mut engine) = engine(shipped("gearbox"), glass("", 64, 512)) else { return };
    let words = words(&mut engine, [160, 120]);
    let (mut all, mut lost) = (0, 0);
    for (z, fragments) in words.z.chunks_exact(64).zip(&words.fragments) {
        assert!(fragments.len() <= 64);
        all += fragments.len();
        lost += fragments.len() - z.iter().take_while(|key| **key != EMPTY).count();
    }
    eprintln!("{lost} of {all} fragments share a key with another");
    assert!(all > 40_000 && lost * 1000 < all, "{lost} of {all}");
}

/// The picture of the middle, in linear light.
fn middle(engine: &mut Engine, size: [u32; 2], samples: u32) -> [f64; 3] {
    let image = gpu::still(engine, size, samples);
    let at = (size[1] / 2 * size[0] + size[0] / 2) as usize;
    [0, 1, 2].map(|channel| gpu::channel(&image, channel)[at])
}

#[test]
fn pictures_are_those_of_the_blended_twin() {
    let size = [24, 16];
    let [behind, blue, red] =
        ["#f0e0a0", "#2060d0", "#d04020"].map(|color| gpu::color(color).to_array().map(f64::from));
    for (count, k) in [(1, 8), (8, 8), (32, 32), (32, 5), (64, 64)] {
        let objects = 4.min(count);
        let mut sorted: Vec<(usize, usize)> =
            (0..count).map(|index| ((index * 89 + 31) % count, index % objects)).collect();
        sorted.sort_unstable();
        // The nearest k from far to near; the second object is red. Opacity has steps of 1/255.
        let twin = sorted.iter().take(k).rev().fold(behind, |under, (_, object)| {
            let color = if *object == 1 { red } else { blue };
            [0, 1, 2].map(|channel| under[channel] + 51.0 / 255.0 * (color[channel] - under[channel]))
        });
        for samples in [1, 4] {
            for form in [BkbForm::Published, BkbForm::OneWay, BkbForm::BruteForce, BkbForm::DualPass] {
                let style = style(&bkb(k), 0.2, r#", "mesh[part=part1]": "red""#);
                let Some(mut engine) = engine(squares(count, objects), style) else { return };
                engine.set_bkb_form(form);
                let picture = middle(&mut engine, size, samples);
                let error = [0, 1, 2].map(|channel| (picture[channel] - twin[channel]).abs());
                assert!(
                    error.iter().all(|error| *error < 1e-3),
                    "{count} squares, k = {k}, {samples} samples, {form:?}: {error:?}"
                );
            }
        }
    }
}

#[test]
fn what_is_opaque_hides_what_is_behind_it_alone() {
    // Squares of four objects in no order; the second is opaque.
    let size = [24, 16];
    let picture = |transparency: &str| {
        let mut engine = engine(squares(16, 4), style(transparency, 0.4, r#", "mesh[part=part1]": "solid""#))?;
        let image = gpu::still(&mut engine, size, 4);
        let aovs = gpu::aovs(&mut engine, size);
        Some((image, aovs))
    };
    let (Some((packed, lists)), Some((bucketed, buckets))) = (picture(r#""method": "packed""#), picture(&bkb(16)))
    else {
        return;
    };
    assert!(largest_step(&packed, &bucketed) < 300, "{}", largest_step(&packed, &bucketed));
    assert!(lists.layer_count == buckets.layer_count && lists.ids == buckets.ids && lists.depth == buckets.depth);
    // No slot goes to what is hidden.
    let style = style(&bkb(16), 0.4, r#", "mesh[part=part1]": "solid""#);
    let Some(mut engine) = engine(squares(16, 4), style) else { return };
    let words = words(&mut engine, size);
    for (z, fragments) in words.z.chunks_exact(16).zip(&words.fragments) {
        let kept = z.iter().filter(|key| **key != EMPTY).count();
        assert!(kept == fragments.len() && kept < 12, "{kept}");
    }
}

/// The largest difference of two pictures of 16 bits.
fn largest_step(a: &Image, b: &Image) -> u16 {
    let (Pixels::U16(a), Pixels::U16(b)) = (&a.pixels, &b.pixels) else { panic!("16 bits were asked for") };
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// A device on which fragments are coloured by their curvature.
fn device_of_curvature() -> Option<Arc<Gpu>> {
    gpu::device()?;
    let text = include_str!("../../shaders/bkb/stylise.wgsl");
    let call = "stylised(material, unpack_color(word), kappa, depth_of(fragment))";
    assert!(text.contains(call));
    let edited = text.replace(call, "vec4<f32>(vec3<f32>(0.5 + 0.5 * kappa), 0.4)");
    let gpu = Gpu::open().expect("an adapter that opened before");
    gpu.set_shader_edits(Arc::new(ShaderEdits::from([("bkb/stylise.wgsl".to_owned(), edited)])));
    Some(Arc::new(gpu))
}

#[test]
fn pictures_in_bands_are_the_picture() {
    let Some(device) = device_of_curvature() else { return };
    let still = |memory_mb| {
        let mut engine = Engine::new(Arc::clone(&device), shipped("gearbox"), glass("", 48, memory_mb));
        let image = gpu::still(&mut engine, [200, 150], 2);
        let bytes = engine.target_bytes().iter().find(|(name, _)| *name == "layers").map(|(_, bytes)| *bytes);
        (image, bytes.expect("layers"))
    };
    let ((whole, bytes), (banded, band_bytes)) = (still(512), still(16));
    assert!(bytes == 200 * 150 * 48 * 16 && band_bytes <= 16 << 20, "{bytes} and {band_bytes}");
    assert_eq!(whole.pixels, banded.pixels);
}

#[test]
fn pictures_in_tiles_are_the_picture() {
    let Some(device) = device_of_curvature() else { return };
    // A column more than one tile holds, with the ball in it.
    let request = Request::new([2049, 2048], 1);
    let mut engine = Engine::new(device, mesh_ball(), glass(r#", "zoom": 3"#, 2, 512));
    let mut rows = Vec::new();
    engine
        .draw_rows(&request, &mut |_| std::ops::ControlFlow::Continue(()), &mut |bytes| {
            rows.extend_from_slice(bytes);
            Ok(())
        })
        .expect("a picture in tiles");
    let Pixels::U8(whole) = engine.still(&request).expect("the picture").pixels else {
        panic!("8 bits were asked for")
    };
    assert!(rows == whole);
}

#[test]
fn rows_that_do_not_fit_are_told() {
    let Some(mut engine) = engine(squares(2, 1), style(&bkb(64).replace("64", r#"64, "memory_mb": 16"#), 0.5, ""))
    else {
        return;
    };
    let refused = engine.still(&Request::new([8192, 16], 1)).expect_err("three rows take 24 MiB");
    assert!(refused.to_string().contains("layers of three rows"), "{refused}");
    engine.still(&Request::new([64, 64], 1)).expect("a picture that fits");
}

#[test]
fn stills_do_not_depend_on_the_order_of_fragments() {
    let Some(device) = device_of_curvature() else { return };
    let mut engine = Engine::new(device, shipped("gearbox"), glass("", 16, 512));
    let request = Request::new([160, 120], 1);
    let first = engine.still(&request).expect("a still");
    for round in 0..10 {
        assert_eq!(engine.still(&request).expect("a still").pixels, first.pixels, "round {round}");
    }
}
