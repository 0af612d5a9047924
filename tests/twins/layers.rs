//! Twin of `shaders/layers/`: fragments sorted by depth and number, blended from near to far, and the GPU held to it and to
//! the reference renderer's exact crossing of all surfaces.

use std::fmt::Write as _;

use restyle::config::{self, Catalog, Source};
use restyle::engine::exact::Exact;
use restyle::engine::{self, Engine, Request};
use restyle::measure::metrics::{Options, compare};
use restyle::scene::Scene;
use restyle::shipped::{MESHES, MOLECULES, find};

use super::gpu;

const SIZE: [u32; 2] = [24, 16];

/// A surface that a ray meets.
#[derive(Debug, Clone, Copy)]
struct Fragment {
    depth: f32,
    id: u32,
    color: [f64; 3],
    opacity: f64,
}

/// Sorted from near to far, equal depths by their ids, and blended over what is behind.
fn blended(fragments: &[Fragment], behind: [f64; 3]) -> [f64; 3] {
    let mut sorted = fragments.to_vec();
    sorted.sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.id.cmp(&b.id)));
    let (mut light, mut open) = ([0.0; 3], 1.0);
    for Fragment { color, opacity, .. } in sorted {
        light = [0, 1, 2].map(|channel| light[channel] + open * opacity * color[channel]);
        open *= 1.0 - opacity;
    }
    [0, 1, 2].map(|channel| light[channel] + open * behind[channel])
}

/// Squares across the view, one upon the other, each a part of its own: `a0`, `b1`, `a2` and so on, the nearest first.
fn stack(depths: &[f64], scale: f64) -> Scene {
    let mut text = String::new();
    for (index, depth) in depths.iter().enumerate() {
        let name = if index % 2 == 0 { "a" } else { "b" };
        let _ = writeln!(text, "o {name}{index}");
        for [x, y] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let _ = writeln!(text, "v {} {} {}", x * scale, y * scale, -depth * scale);
        }
        let first = 4 * index + 1;
        let _ = writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
    }
    Scene::from_bytes("stack.obj", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

const COLORS: [&str; 2] = ["#d04020", "#2060e0"];
const BACKGROUND: &str = "#f0e0a0";

pub fn load(text: &str) -> config::Style {
    let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
    config::load(&Source::new("test.json", text), &catalog).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// Flat colours seen straight ahead, `more` after the mapping's own entries.
fn style(opacity: f64, more: &str, memory_mb: u32) -> config::Style {
    load(&format!(
        r##"{{ "camera": {{ "bgcolor": "{BACKGROUND}", "orthographic": true, "position": [0, 0, 1], "zoom": 3 }},
            "mapping": {{ "mesh[part=a*]": "a", "mesh[part=b*]": "b"{more} }},
            "shaders": [
              {{ "name": "a", "shader": "unlit", "properties": {{ "base_color": "{}", "opacity": {opacity} }} }},
              {{ "name": "b", "shader": "unlit", "properties": {{ "base_color": "{}", "opacity": {opacity} }} }},
              {{ "name": "solid", "shader": "unlit", "properties": {{ "base_color": "#208040" }} }}],
            "transparency": {{ "memory_mb": {memory_mb} }} }}"##,
        COLORS[0], COLORS[1]
    ))
}

fn linear(color: &str) -> [f64; 3] {
    gpu::color(color).to_array().map(f64::from)
}

fn engine(scene: Scene, style: config::Style) -> Option<Engine> {
    Some(Engine::new(gpu::device()?, scene, style))
}

/// The picture's middle in linear light.
fn middle(engine: &mut Engine) -> [f64; 3] {
    let image = gpu::still(engine, SIZE, 1);
    let at = (SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize;
    [0, 1, 2].map(|channel| gpu::channel(&image, channel)[at])
}

fn largest(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn fragments(depths: &[f64], opacity: f64) -> Vec<Fragment> {
    let of = |(index, depth): (usize, &f64)| Fragment {
        depth: *depth as f32,
        id: index as u32,
        color: linear(COLORS[index % 2]),
        opacity,
    };
    depths.iter().enumerate().map(of).collect()
}

/// In an order that is none.
fn shuffled_depths(count: usize) -> Vec<f64> {
    (0..count).map(|index| ((index * 89 + 31) % count) as f64 / count as f64).collect()
}

#[test]
fn a_known_answer() {
    let [red, blue, behind] = [COLORS[0], COLORS[1], BACKGROUND].map(linear);
    let expected = [0, 1, 2].map(|channel| 0.5 * blue[channel] + 0.25 * red[channel] + 0.25 * behind[channel]);
    let twin = blended(&fragments(&[0.5, 0.1], 0.5), behind);
    assert!(largest(twin, expected) < 1e-12, "the nearer one counts first");
}

#[test]
fn a_stack_of_any_depth_is_blended_as_the_twin_does() {
    let mut worst = 0.0f64;
    for count in [1usize, 2, 5, 16, 33, 100, 256] {
        let depths = shuffled_depths(count);
        for opacity in [0.005, 0.05, 0.2, 0.6, 0.99] {
            let Some(mut engine) = engine(stack(&depths, 1.0), style(opacity, "", 512)) else { return };
            let twin = blended(&fragments(&depths, opacity), linear(BACKGROUND));
            let error = largest(middle(&mut engine), twin);
            assert!(error < 1.0 / 255.0, "{count} layers of {opacity}: {error}");
            worst = worst.max(error);
        }
    }
    eprintln!("largest error of stacks in linear light: {worst:.6}");
}

/// Lists of every length up to `count` from left to right, short ones over more of the width, two fragments at each depth.
fn wedge(count: usize) -> Scene {
    let mut text = String::new();
    for (index, depth) in shuffled_depths(count).into_iter().enumerate() {
        let left = (index as f64 / count as f64).powf(0.4) - 1.0;
        let depth = (depth * count as f64 / 2.0).floor() / count as f64;
        for [x, y] in [[left, -1.0], [1.0, -1.0], [1.0, 1.0], [left, 1.0]] {
            let _ = writeln!(text, "v {x} {y} {}", -depth);
        }
        let first = 4 * index + 1;
        let _ = writeln!(text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
    }
    Scene::from_bytes("wedge.obj", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn lists_of_any_length_are_in_order() {
    let style = r##"{ "camera": { "orthographic": true, "position": [0, 0, 1], "zoom": 20 }, "mapping": { "*": "glass" },
        "transparency": { "method": "bkb", "k": 1 },
        "shaders": [{ "name": "glass", "shader": "curvature", "properties": { "opacity": 0.5 } }] }"##;
    let Some(mut engine) = engine(wedge(320), load(style)) else { return };
    let words = engine.bkb_words(&Request::new([1024, 16], 1)).expect("words").expect("a k-buffer");
    // Runs whose longest lists are of each class.
    for longest in [1..9, 9..17, 17..33, 33..320, 320..321] {
        let of_run = |run: &[Vec<[u32; 2]>]| run.iter().map(Vec::len).max().unwrap_or(0);
        assert!(words.fragments.chunks(32).any(|run| longest.contains(&of_run(run))), "{longest:?}");
    }
    for list in &words.fragments {
        let unlike = list.windows(2).find(|pair| pair[0] >= pair[1]);
        assert!(unlike.is_none(), "{}: {unlike:?}", list.len());
    }
}

#[test]
fn equal_depths_keep_every_fragment() {
    for count in [2usize, 9, 40] {
        let depths = vec![0.5; count];
        let Some(mut engine) = engine(stack(&depths, 1.0), style(0.1, "", 512)) else { return };
        let twin = blended(&fragments(&depths, 0.1), linear(BACKGROUND));
        let error = largest(middle(&mut engine), twin);
        assert!(error < 1e-3, "{count} at one depth: {error}");
    }
}

#[test]
fn what_is_opaque_hides_what_is_behind_it_alone() {
    let depths = [0.1, 0.3, 0.5, 0.7, 0.9];
    for (solid, num_before) in [("a0", 0), ("a2", 2), ("a4", 4)] {
        let more = format!(r#", "mesh[part={solid}]": "solid""#);
        let Some(mut engine) = engine(stack(&depths, 1.0), style(0.3, &more, 512)) else { return };
        let twin = blended(&fragments(&depths[..num_before], 0.3), linear("#208040"));
        let error = largest(middle(&mut engine), twin);
        assert!(error < 1e-3, "{solid}: {error}");
    }
}

#[test]
fn surfaces_are_counted_and_the_nearest_is_seen() {
    let depths = [0.7, 0.1, 0.5, 0.3, 0.9];
    let mut nearest = None;
    for (solid, counted) in [("none", 5), ("b3", 1), ("a4", 4)] {
        let more = format!(r#", "mesh[part={solid}]": "solid""#);
        let Some(mut engine) = engine(stack(&depths, 1.0), style(0.3, &more, 512)) else { return };
        let aovs = gpu::aovs(&mut engine, SIZE);
        assert!(aovs.layer_count.iter().all(|count| *count == counted), "{solid}: {:?}", aovs.layer_count[0]);
        // The two triangles of the second square, the nearest in all cases.
        let mut ids = aovs.ids.clone();
        ids.sort_unstable();
        ids.dedup();
        assert!(ids.len() == 2 && ids[0] >> 29 == 3 && ids[1] == ids[0] + 1, "{solid}: {ids:x?}");
        assert_eq!(*nearest.get_or_insert(ids.clone()), ids, "{solid}");
        let depths: Vec<f32> = aovs.depth.clone();
        assert!(depths.iter().all(|depth| (depth - depths[0]).abs() < 1e-3), "{solid}: one square, one depth");
    }
}

#[test]
fn invisible_objects_are_not_there() {
    let Some(mut engine) = engine(stack(&[0.2, 0.4], 1.0), style(0.0, "", 512)) else { return };
    assert!(largest(middle(&mut engine), linear(BACKGROUND)) < 1e-4);
}

#[test]
fn pictures_in_bands_are_the_picture() {
    let depths = shuffled_depths(120);
    let size = [200, 150];
    let still = |memory_mb| {
        let mut engine = engine(stack(&depths, 1.0), style(0.02, "", memory_mb))?;
        let image = gpu::still(&mut engine, size, 2);
        let layers = engine.target_bytes().iter().find(|(name, _)| *name == "layers").map(|(_, bytes)| *bytes);
        Some((image, layers.expect("layers")))
    };
    let (Some((whole, bytes)), Some((banded, band_bytes))) = (still(512), still(16)) else { return };
    assert!(bytes > 28 << 20 && band_bytes < 18 << 20, "{bytes} and {band_bytes}");
    assert_eq!(whole.pixels, banded.pixels);
}

#[test]
fn units_do_not_matter() {
    let depths = shuffled_depths(20);
    let mut of_scale = [1.0, 1e-3, 1e3].into_iter().map(|scale| {
        let mut engine = engine(stack(&depths, scale), style(0.2, "", 512))?;
        Some(gpu::still(&mut engine, SIZE, 4).pixels)
    });
    let Some(Some(first)) = of_scale.next() else { return };
    assert!(of_scale.all(|other| other.as_ref() == Some(&first)));
}

#[test]
fn bonds_within_atoms_of_glass_are_drawn() {
    let of = |opacity: f64| {
        load(&format!(
            r#"{{ "geometry": {{ "atom": "vdw", "scale": 1 }}, "mapping": {{ "atom": "a", "connector": "b" }},
                "shaders": [{{ "name": "a", "shader": "basic", "properties": {{ "opacity": {opacity} }} }},
                  {{ "name": "b", "shader": "basic" }}] }}"#
        ))
    };
    let Some(mut engine) = engine(shipped("caffeine"), of(1.0)) else { return };
    let mut drawn = |style| {
        engine.set_style(style);
        engine.still(&Request::new(SIZE, 1)).expect("a still");
        engine.counts().cylinders
    };
    let [opaque, glass, again] = [1.0, 0.5, 1.0].map(|opacity| drawn(of(opacity)));
    assert!(glass == 25 && opaque < glass && again == opaque, "{opaque}, {glass}, {again}");
}

/// A look of glass: all of it, or what a selector picks.
fn glass(selector: &str, effects: &str) -> config::Style {
    let plain = if selector == "*" { "" } else { r#""*": "plain", "# };
    load(&format!(
        r##"{{ "camera": {{ "bgcolor": "white" }}, "geometry": {{ "atom": "vdw", "scale": 0.3 }},
            "mapping": {{ {plain}"{selector}": "glass", "post_effects": [{effects}] }},
            "lights": [{{ "type": "directional", "position": [-1, 2, 2] }}, {{ "type": "ambient", "intensity": 0.6 }}],
            "shaders": [{{ "name": "plain", "shader": "basic" }}, {{ "name": "glass", "shader": "basic", "properties": {{ "opacity": 0.35 }} }},
              {{ "name": "ao", "shader": "ssaoPost" }},
              {{ "name": "lines", "shader": "outlinePost", "properties": {{ "silhouette_width": "2pt" }} }}] }}"##
    ))
}

fn shipped(name: &str) -> Scene {
    let file = [MOLECULES, MESHES].iter().find_map(|among| find(among, name)).expect("a shipped scene");
    Scene::from_bytes(file.file, file.bytes).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn stills_do_not_depend_on_the_order_of_fragments() {
    let Some(mut engine) = engine(shipped("gearbox"), glass("mesh", "")) else { return };
    let request = Request::new([160, 120], 1);
    let first = engine.still(&request).expect("a still");
    for round in 0..20 {
        assert_eq!(engine.still(&request).expect("a still").pixels, first.pixels, "round {round}");
    }
}

#[test]
fn glass_is_that_of_the_reference() {
    let cases = [
        ("caffeine", "atom", "", 0.02),
        ("caffeine", "*", "", 0.015),
        ("gearbox", "mesh", "", 0.03),
        ("gearbox", "mesh[part=*ousing*]", "", 0.04),
        ("gearbox", "mesh[part=*ousing*]", r#""ao""#, 0.045),
        ("caffeine", "atom", r#""lines""#, 0.03),
    ];
    for (name, selector, effects, most) in cases {
        let Some(mut engine) = engine(shipped(name), glass(selector, effects)) else { return };
        let request = Request { wide: true, ..Request::new([160, 160], 16) };
        let drawn = engine.still(&request).expect("a still");
        let exact = Exact::new(shipped(name), glass(selector, effects), None);
        let truth = exact.still(&request, &mut |_| std::ops::ControlFlow::Continue(())).expect("the reference");
        let flip = compare(&truth, &drawn, &Options::default()).expect("one size").metrics.flip;
        eprintln!("{name}, {selector} of glass, effects {effects}: FLIP {flip:.4}");
        assert!(flip < most, "{name}, {selector}, {effects}: {flip}");
    }
}
