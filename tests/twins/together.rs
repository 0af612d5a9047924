//! Shadows, lines, ambient occlusion and depth of field together, held to the reference renderer.

use std::sync::Arc;

use restyle::config::Style;
use restyle::engine::{Engine, Request};
use restyle::gpu::Gpu;
use restyle::measure::metrics::{self, Options};

use super::gpu;
use super::reference::{exact_still, shipped_scene, style};

/// The effects that are on, in the order of [`NAMES`].
type Switches = [bool; 4];
const NAMES: [&str; 4] = ["shadows", "lines", "occlusion", "focus"];

/// A lacquered scene with what is on; `bgcolor` is that of the picture.
fn look(on: Switches, bgcolor: &str, layers: &str) -> Style {
    let [shadows, lines, occlusion, focus] = on;
    let shadow = if shadows { r#", "shadow": "soft", "strength": 0.7, "softness": 8"# } else { "" };
    let listed = [(occlusion, "ao"), (lines, "lines"), (focus, "focus")];
    let listed: Vec<String> = listed.iter().filter(|(on, _)| *on).map(|(_, name)| format!("{name:?}")).collect();
    style(&format!(
        r##"{{ "camera": {{ "bgcolor": "{bgcolor}" }}, "geometry": {{ "atom": "vdw", "scale": 0.4, "bond_radius": "0.2A" }},
            "mapping": {{ "*": "matt", "post_effects": [{}] }},
            "shaders": [ {{ "name": "matt", "shader": "basic", "properties": {{ "smoothness": 0.2, "metallic": 0 }} }},
                {{ "name": "ao", "shader": "ssaoPost" }},
                {{ "name": "lines", "shader": "outlinePost", "properties": {{ "silhouette_width": "10pt", "crease_width": 0 }} }},
                {{ "name": "focus", "shader": "dofPost", "properties": {{ "layers": {layers}, "blur": "30pt" }} }} ],
            "lights": [ {{ "type": "directional", "position": [-1, 2, 1.5], "intensity": 2{shadow} }},
                {{ "type": "ambient", "intensity": 0.5 }} ] }}"##,
        listed.join(", ")
    ))
}

/// FLIP of a still from the reference's of so many samples.
fn flip(gpu: &Arc<Gpu>, scene: &str, style: &Style, request: &Request, samples: u32) -> f64 {
    let truth = exact_still(scene, style, &Request { samples, ..*request }, 2);
    let mut engine = Engine::new(Arc::clone(gpu), shipped_scene(scene), style.clone());
    let image = engine.still(request).expect("a still");
    metrics::compare(&truth, &image, &Options::default()).expect("one size").metrics.flip
}

#[test]
fn the_gpu_focuses_as_a_lens_does() {
    let Some(gpu) = gpu::device() else { return };
    let only = [false, false, false, true];
    for (scene, layers) in [
        ("caffeine", "[0, 0.3, 0.4, 0.8]"),
        ("alpha_helix", "[0, 0.1, 0.4, 0.8]"),
        ("c60", "[0, 0.15, 0.35, 0.8]"),
        ("gearbox", "[0, 0.2, 0.4, 0.8]"),
    ] {
        let found = flip(&gpu, scene, &look(only, "white", layers), &Request::new([144, 144], 64), 64);
        eprintln!("{scene} {layers}: FLIP {found:.4}");
        assert!(found < 0.05, "{scene} {layers}: {found}");
    }
}

#[test]
fn any_two_effects_go_together_and_all_do() {
    let Some(gpu) = gpu::device() else { return };
    // Where a triangle ends within a pixel the adapter does not know, so that thin lines of meshes are soft.
    for (scene, flip_limit, lined_limit) in [("caffeine", 0.05, 0.055), ("bracket", 0.045, 0.07)] {
        for set in (0..16u32).filter(|set| set.count_ones() != 3) {
            let on = [0, 1, 2, 3].map(|bit| set >> bit & 1 == 1);
            let style = look(on, "#dfe4ea", "[0, 0.2, 0.4, 0.8]");
            // Every other one without a background.
            let request = Request { transparent: set % 2 == 1, ..Request::new([128, 128], 16) };
            let found = flip(&gpu, scene, &style, &request, 36);
            let names: Vec<&str> = NAMES.into_iter().zip(on).filter(|(_, on)| *on).map(|(name, _)| name).collect();
            eprintln!("{scene} with {names:?}: FLIP {found:.4}");
            assert!(found < if on[1] { lined_limit } else { flip_limit }, "{scene} with {names:?}: {found}");
        }
    }
}
