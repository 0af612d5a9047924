//! A change costs the work that it needs and no other: pipelines, buffers, bind groups and bytes are counted.

use restyle::config::{self, Catalog, Source, Style};
use restyle::engine::{self, Counters, Engine};
use restyle::scene::Scene;

use super::gpu;

/// Oxygen before nitrogen, apart enough to hide nothing: the drawing order stays whatever the outlines are.
const ATOMS: [&str; 4] = ["C -3 0 0", "N 0 0 -1", "O 3 0 1", "C 0 3 0"];

fn style(camera: &str, mapping: &str, shaders: &str, lights: &str) -> String {
    format!(
        "{{ \"camera\": {{ {camera} }}, \"mapping\": {{ {mapping} }}, \"shaders\": [{shaders}], \"lights\": [{lights}] }}"
    )
}

const CAMERA: &str = r#""fov": 30"#;
const MAPPING: &str = r#""atom": "a", "atom[element=O]": "b", "connector": "a""#;
const SHADERS: &str =
    r#"{ "name": "a", "shader": "toon", "properties": { "steps": 3 } }, { "name": "b", "shader": "toon" }"#;
const LIGHTS: &str = r#"{ "type": "directional", "position": [1, 2, 3] }"#;

fn parse(text: &str) -> Style {
    let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
    config::load(&Source::new("s.json", text), &catalog).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// Draws and counts what that asked of the device.
fn cost(engine: &mut Engine) -> Counters {
    let before = engine.counters();
    engine.draw(&gpu::request([64, 48], 1), false, &mut |_| std::ops::ControlFlow::Continue(())).unwrap();
    engine.counters() - before
}

fn cost_of(engine: &mut Engine, text: &str) -> Counters {
    engine.set_style(parse(text));
    cost(engine)
}

/// An engine that has drawn the plain style twice, and so needs nothing more for it.
fn warm() -> Option<Engine> {
    let mut engine = gpu::lone_engine(&ATOMS, &style(CAMERA, MAPPING, SHADERS, LIGHTS))?;
    let first = cost(&mut engine);
    assert!(first.pipelines_built >= 2 && first.buffers_created >= 5 && first.textures_created >= 5, "{first:?}");
    assert_eq!(cost(&mut engine), Counters::default(), "a frame in which nothing changed");
    Some(engine)
}

/// One write of so many bytes, and nothing else.
fn one_write(bytes: u64) -> Counters {
    Counters { writes: 1, bytes_written: bytes, ..Counters::default() }
}

#[test]
fn a_property_costs_one_write() {
    let Some(mut engine) = warm() else { return };
    let mut change = |from: &str, to: &str| {
        let changed = cost_of(&mut engine, &style(CAMERA, MAPPING, &SHADERS.replace(from, to), LIGHTS));
        let back = cost_of(&mut engine, &style(CAMERA, MAPPING, SHADERS, LIGHTS));
        (changed, back)
    };
    assert_eq!(change("\"steps\": 3", "\"steps\": 5"), (one_write(4), one_write(4)));
    let two = "\"steps\": 3, \"bias\": 0.75";
    let (changed, back) = change("\"steps\": 3", two);
    assert_eq!((changed, back.writes, back.buffers_created), (one_write(changed.bytes_written), 1, 0));
    assert!(changed.bytes_written <= 80, "no more than one parameter set: {changed:?}");
    // A colour for all lies in the material; the objects' own colours stay.
    let (changed, _) = change("\"steps\": 3", "\"steps\": 3, \"base_color\": \"#123456\"");
    assert_eq!(changed, one_write(16));
    let (changed, _) = change("\"steps\": 3", "\"steps\": 3, \"levels\": \"centre\"");
    assert_eq!(changed, one_write(4));
    // What is written differently and means the same costs nothing.
    assert_eq!(change("\"steps\": 3", "\"steps\": 3.0, \"bias\": 0.5").0, Counters::default());
}

#[test]
fn an_outline_costs_one_write_once_there_are_outlines() {
    let Some(mut engine) = warm() else { return };
    let hull = |width: &str| {
        let shaders = SHADERS.replace("\"steps\": 3", &format!("\"steps\": 3, \"hull_size\": \"{width}\""));
        style(CAMERA, MAPPING, &shaders, LIGHTS)
    };
    let first = cost_of(&mut engine, &hull("1pt"));
    assert!(first.pipelines_built > 0 && first.buffers_created == 0, "outlines are other pipelines: {first:?}");
    assert_eq!(cost_of(&mut engine, &hull("2pt")), one_write(4));
    let back = cost_of(&mut engine, &style(CAMERA, MAPPING, SHADERS, LIGHTS));
    assert_eq!((back.pipelines_built, back.writes), (0, 1), "{back:?}");
}

#[test]
fn an_effect_costs_its_passes_and_then_one_write() {
    let Some(mut engine) = warm() else { return };
    let lines = |properties: &str| {
        let shaders =
            format!(r#"{SHADERS}, {{ "name": "l", "shader": "outlinePost", "properties": {{ {properties} }} }}"#);
        style(CAMERA, &format!(r#"{MAPPING}, "post_effects": ["l"]"#), &shaders, LIGHTS)
    };
    let off = r#""silhouette_width": 0, "boundary_width": 0"#;
    assert_eq!(cost_of(&mut engine, &lines(off)), Counters::default(), "no line is drawn");
    let first = cost_of(&mut engine, &lines(""));
    // Shading once more, with surfaces; five passes; surfaces, light, and a texture for each pass but the last.
    assert_eq!((first.pipelines_built, first.textures_created, first.buffers_created), (6, 6, 1), "{first:?}");
    assert_eq!(cost(&mut engine), Counters::default(), "a frame in which nothing changed");
    assert_eq!(cost_of(&mut engine, &lines(r#""depth_step": "0.7r""#)), one_write(4));
    let back = cost_of(&mut engine, &style(CAMERA, MAPPING, SHADERS, LIGHTS));
    assert_eq!(Counters { bind_groups_created: 0, ..back }, Counters::default(), "{back:?}");
}

#[test]
fn what_an_effect_applies_to_costs_the_objects() {
    let Some(mut engine) = warm() else { return };
    let occluded = |properties: &str| {
        let shaders =
            format!(r#"{SHADERS}, {{ "name": "o", "shader": "ssaoPost", "properties": {{ {properties} }} }}"#);
        style(CAMERA, &format!(r#"{MAPPING}, "post_effects": ["o"]"#), &shaders, LIGHTS)
    };
    let first = cost_of(&mut engine, &occluded(r#""applies_to": "atom[element=O]""#));
    assert_eq!(first.pipelines_built, 3, "shading with surfaces, and two passes: {first:?}");
    assert_eq!(cost(&mut engine), Counters::default(), "a frame in which nothing changed");
    let row = one_write(4 * 32);
    assert_eq!(cost_of(&mut engine, &occluded(r#""applies_to": "atom[element=N]""#)), row, "the row of the four atoms");
    // All: the passes ask no object.
    let all = cost_of(&mut engine, &occluded(""));
    assert_eq!((all.pipelines_built, all.textures_created, all.writes), (2, 0, 2), "{all:?}");
    assert_eq!(all.bytes_written, row.bytes_written + 4);
    // Nothing: the passes are left out.
    let nothing = cost_of(&mut engine, &occluded(r#""applies_to": "connector""#));
    assert_eq!(Counters { bind_groups_created: 0, ..nothing }, Counters::default(), "{nothing:?}");
}

#[test]
fn more_selectors_than_objects_have_bits_for_are_told() {
    let Some(mut engine) = warm() else { return };
    let told = |engine: &mut Engine, count: usize| {
        let names: Vec<String> = (0..count).map(|i| format!("\"o{i}\"")).collect();
        let entry = |i: usize| {
            format!(
                r#", {{ "name": "o{i}", "shader": "ssaoPost", "properties": {{ "applies_to": "atom[number=..{i}]" }} }}"#
            )
        };
        let shaders = SHADERS.to_owned() + &(0..count).map(entry).collect::<String>();
        let mapping = format!(r#"{MAPPING}, "post_effects": [{}]"#, names.join(", "));
        engine.set_style(parse(&style(CAMERA, &mapping, &shaders, LIGHTS)));
        cost(engine);
        engine.limits_exceeded([64, 48])
    };
    assert_eq!(told(&mut engine, 15), Vec::<String>::new());
    assert_eq!(
        told(&mut engine, 17),
        ["the post effects of the style have 17 different selectors; only those of the first 15 are drawn"]
    );
}

#[test]
fn a_scheme_of_colours_costs_the_objects() {
    let Some(mut engine) = warm() else { return };
    let shaders = SHADERS.replace("\"steps\": 3", "\"steps\": 3, \"base_color\": \"chain\"");
    let changed = cost_of(&mut engine, &style(CAMERA, MAPPING, &shaders, LIGHTS));
    assert_eq!((changed.pipelines_built, changed.buffers_created, changed.textures_created), (0, 0, 0));
    assert_eq!(changed, one_write(4 * 32), "the row of the four atoms");
}

#[test]
fn a_shader_costs_a_cached_pipeline() {
    let Some(mut engine) = warm() else { return };
    let flat =
        SHADERS.replace("{ \"name\": \"b\", \"shader\": \"toon\" }", "{ \"name\": \"b\", \"shader\": \"unlit\" }");
    let first = cost_of(&mut engine, &style(CAMERA, MAPPING, &flat, LIGHTS));
    assert_eq!((first.pipelines_built, first.buffers_created, first.bind_groups_created), (1, 1, 1), "{first:?}");
    assert_eq!(first.textures_created, 0);
    let back = cost_of(&mut engine, &style(CAMERA, MAPPING, SHADERS, LIGHTS));
    let again = cost_of(&mut engine, &style(CAMERA, MAPPING, &flat, LIGHTS));
    for cost in [back, again] {
        assert_eq!((cost.pipelines_built, cost.buffers_created, cost.textures_created), (0, 0, 0), "{cost:?}");
        // Materials that name their shader, and its parameter set where that went away meanwhile.
        assert!(cost.bind_groups_created == 1 && cost.writes <= 2 && cost.bytes_written <= 256, "{cost:?}");
    }
}

#[test]
fn a_light_costs_one_write() {
    let Some(mut engine) = warm() else { return };
    let light = |changed: &str| style(CAMERA, MAPPING, SHADERS, changed);
    assert_eq!(cost_of(&mut engine, &light(&LIGHTS.replace("}", ", \"intensity\": 0.5 }"))), one_write(12));
    let moved = cost_of(&mut engine, &light(r#"{ "type": "directional", "position": [3, 2, 1], "intensity": 0.5 }"#));
    assert_eq!(moved, one_write(12));
    // A second light is another loop in the shader; a shadow is passes of its own.
    let second = cost_of(&mut engine, &light(&format!("{LIGHTS}, {LIGHTS}")));
    assert_eq!((second.pipelines_built, second.writes, second.textures_created), (1, 1, 0), "{second:?}");
    let shadow = cost_of(&mut engine, &light(&LIGHTS.replace("}", ", \"shadow\": \"hard\" }")));
    assert!(shadow.pipelines_built >= 2 && shadow.textures_created == 2, "{shadow:?}");
    let stronger = cost_of(&mut engine, &light(&LIGHTS.replace("}", ", \"shadow\": \"hard\", \"strength\": 0.9 }")));
    assert_eq!(stronger, one_write(4));
}

#[test]
fn a_camera_costs_its_view() {
    let Some(mut engine) = warm() else { return };
    let camera = |camera: &str| style(camera, MAPPING, SHADERS, LIGHTS);
    let zoomed = cost_of(&mut engine, &camera(r#""fov": 30, "zoom": 2"#));
    assert_eq!((zoomed.writes, zoomed.bytes_written <= 256), (1, true), "{zoomed:?}");
    assert_eq!(Counters { writes: 0, bytes_written: 0, ..zoomed }, Counters::default());
    let ground = cost_of(&mut engine, &camera(r#""fov": 30, "zoom": 2, "bgcolor": "black""#));
    assert_eq!(ground, one_write(12), "the background is one uniform");
    let parallel = cost_of(&mut engine, &camera(r#""orthographic": true"#));
    assert_eq!(parallel.pipelines_built, 2, "other rays: atoms and shading");
}

#[test]
fn a_mapping_costs_the_objects() {
    let Some(mut engine) = warm() else { return };
    let mapping = |mapping: &str| style(CAMERA, mapping, SHADERS, LIGHTS);
    let other = cost_of(&mut engine, &mapping(r#""atom": "a", "atom[element=N]": "b", "connector": "a""#));
    assert_eq!((other.pipelines_built, other.buffers_created, other.textures_created), (0, 0, 0), "{other:?}");
    assert_eq!(other, one_write(4 * 32), "the row of the four atoms");
    let hidden = cost_of(
        &mut engine,
        &mapping(r#""atom": "a", "atom[element=N]": null, "connector": "a", "atom[element=O]": "b""#),
    );
    assert_eq!((hidden.pipelines_built, hidden.buffers_created, hidden.textures_created), (0, 0, 0), "{hidden:?}");
    assert!(hidden.writes <= 2, "three atoms, and their order: {hidden:?}");
}

#[test]
fn a_scene_costs_its_upload() {
    let Some(mut engine) = warm() else { return };
    engine.set_scene(Scene::from_bytes("b.xyz", b"4\n\nC -3 1 0\nN 0 0 -1\nO 3 0 1\nC 0 3 0\n").unwrap());
    let moved = cost(&mut engine);
    assert_eq!((moved.pipelines_built, moved.buffers_created, moved.textures_created), (0, 0, 0), "{moved:?}");
    // The objects, the view that frames them, perhaps their order.
    assert!((2..=3).contains(&moved.writes), "{moved:?}");
    let many: String = (0..5000).map(|i| format!("C {} {} 0\n", i % 70 * 3, i / 70 * 3)).collect();
    engine.set_scene(Scene::from_bytes("c.xyz", format!("5000\n\n{many}").as_bytes()).unwrap());
    let large = cost(&mut engine);
    assert_eq!(large.pipelines_built, 1, "one material alone is a shader of its own: {large:?}");
    assert_eq!(large.textures_created, 1, "the atoms outgrew theirs");
    assert!(large.bytes_written >= 5000 * 32 && large.bytes_written < 5000 * 32 + 5000 * 4 + 4096, "{large:?}");
}

#[test]
fn another_size_costs_targets_and_lines_in_points() {
    let Some(mut engine) = warm() else { return };
    let before = engine.counters();
    engine.draw(&gpu::request([128, 96], 1), false, &mut |_| std::ops::ControlFlow::Continue(())).unwrap();
    let cost = engine.counters() - before;
    assert_eq!((cost.pipelines_built, cost.textures_created), (0, 3), "{cost:?}");
}
