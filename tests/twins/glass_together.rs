//! Lines, ambient occlusion and no background beside glass, held to the reference renderer.

use std::ops::ControlFlow;
use std::sync::Arc;

use restyle::config::Style;
use restyle::engine::exact::Exact;
use restyle::engine::{Engine, Request};
use restyle::measure::metrics::{self, Options};

use super::gpu;
use super::reference::{shipped_scene, style};

/// Opacity by curvature, and one for all.
const CURVED: (&str, &str) =
    ("curvature", r#""opacity_transfer": "glass", "color_transfer": "fig6a", "contour_width": "2pt""#);
const EVEN: (&str, &str) = ("basic", r#""opacity": 0.35"#);

/// A scene, members of the camera that looks at it, and what of it is glass.
const GEARBOX: [&str; 3] = ["gearbox", r#""zoom": 2, "target": [-0.1, -0.1, 0]"#, "mesh[part=*ousing*]"];
const CAFFEINE: [&str; 3] = ["caffeine", r#""zoom": 1"#, "atom[element=C]"];

const LINES: &str = r#""lines""#;
const OCCLUSION: &str = r#""ao""#;
const ALL: &str = r#""ao", "lines""#;

/// Glass beside what is opaque, with post effects.
fn look([_, camera, glass]: [&str; 3], (shader, properties): (&str, &str), effects: &str) -> Style {
    style(&format!(
        r##"{{ "camera": {{ "bgcolor": "#dfe4ea", {camera} }},
            "geometry": {{ "atom": "vdw", "scale": 0.5, "bond_radius": "0.2A" }},
            "mapping": {{ "*": "solid", "{glass}": "glass", "post_effects": [{effects}] }},
            "shaders": [ {{ "name": "solid", "shader": "basic", "properties": {{ "smoothness": 0.2, "metallic": 0 }} }},
                {{ "name": "glass", "shader": "{shader}", "properties": {{ "smoothness": 0.5, {properties} }} }},
                {{ "name": "ao", "shader": "ssaoPost" }},
                {{ "name": "lines", "shader": "outlinePost", "properties": {{ "silhouette_width": "8pt", "crease_width": 0 }} }} ],
            "lights": [ {{ "type": "directional", "position": [-1, 2, 2] }}, {{ "type": "ambient", "intensity": 0.6 }} ] }}"##
    ))
}

/// Held to the reference: glass by which shader, with which effects, without a background or with, and the most FLIP.
type Case = ((&'static str, &'static str), &'static str, bool, f64);

fn hold(scene: [&str; 3], cases: [Case; 4]) {
    let Some(gpu) = gpu::device() else { return };
    let loaded = shipped_scene(scene[0]);
    let mut engine: Option<Engine> = None;
    for (glass, effects, transparent, most) in cases {
        let style = look(scene, glass, effects);
        let request = Request { transparent, ..Request::new([96, 96], 16) };
        let exact = Exact::new(loaded.clone(), style.clone(), Some(2));
        let go_on = &mut |_| ControlFlow::Continue(());
        let truth = exact.still(&Request { samples: 25, ..request }, go_on).expect("the reference");
        let engine = engine.get_or_insert_with(|| Engine::new(Arc::clone(&gpu), loaded.clone(), style.clone()));
        engine.set_style(style);
        let drawn = engine.still(&request).expect("a still");
        // Without a background both are laid over black and over white, and the larger error counts.
        let flip = metrics::compare(&truth, &drawn, &Options::default()).expect("one size").metrics.flip;
        let called = format!("{}, glass by {}, [{effects}], background {}", scene[0], glass.0, !transparent);
        eprintln!("{called}: FLIP {flip:.4}");
        assert!(flip < most, "{called}: {flip}");
    }
}

#[test]
fn atoms_of_glass_go_with_lines_occlusion_and_no_background() {
    hold(
        CAFFEINE,
        [
            (CURVED, LINES, false, 0.035),
            (EVEN, OCCLUSION, false, 0.04),
            (EVEN, "", true, 0.03),
            (CURVED, ALL, true, 0.045),
        ],
    );
}

#[test]
fn parts_of_glass_go_with_lines_occlusion_and_no_background() {
    // Where a triangle ends within a pixel the adapter does not know, so that lines of meshes are soft, on glass or not.
    hold(
        GEARBOX,
        [
            (CURVED, LINES, false, 0.07),
            (CURVED, OCCLUSION, false, 0.05),
            (CURVED, "", true, 0.04),
            (EVEN, ALL, true, 0.075),
        ],
    );
}
