//! Files as editors write them: in place, by rename, truncated first, gone and back.

use std::fs::{self, File};
use std::io::Write;
use std::time::Duration;

use restyle::engine::{Counters, Part, Refusal, Reload};

use super::gpu;
use super::rig::{Live, ground};

const MOLECULE: &str = "2\n\nC 0 0 0\nO 1.2 0 0\n";
const RED: [u8; 3] = [200, 10, 10];
const BLUE: [u8; 3] = [10, 10, 200];
const GREEN: [u8; 3] = [10, 200, 10];

/// A live engine that has drawn a red ground.
fn red(name: &str) -> Option<Live> {
    let mut live = Live::new(name, &[("s.json", &ground(RED)), ("m.xyz", MOLECULE)])?;
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), RED);
    Some(live)
}

#[test]
fn a_save_in_place_is_taken() {
    let Some(mut live) = red("in-place") else { return };
    live.write("s.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), BLUE);
    live.silent();
}

#[test]
fn a_save_by_rename_is_taken_each_time() {
    let Some(mut live) = red("rename") else { return };
    for color in [BLUE, GREEN, RED] {
        live.write("s.json.new", &ground(color));
        fs::rename(live.path("s.json.new"), live.path("s.json")).unwrap();
        assert_eq!(live.taken(), Part::Style);
        assert_eq!(live.ground(), color);
    }
}

#[test]
fn a_save_that_keeps_a_backup_is_taken() {
    let Some(mut live) = red("backup") else { return };
    fs::rename(live.path("s.json"), live.path("s.json~")).unwrap();
    live.write("s.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), BLUE);
}

#[test]
fn a_slow_save_shows_no_half_of_itself() {
    let Some(mut live) = red("slow") else { return };
    let text = ground(BLUE);
    let mut file = File::create(live.path("s.json")).unwrap();
    for piece in text.as_bytes().chunks(10) {
        file.write_all(piece).unwrap();
        let reloads = live.engine.wait(Duration::from_millis(30));
        assert!(reloads.is_empty() || piece.ends_with(b"}"), "half a file is no mistake yet: {reloads:?}");
        if let [Reload::Taken(..)] = reloads[..] {
            assert_eq!(live.ground(), BLUE);
            return;
        }
        assert_eq!(live.ground(), RED);
    }
    drop(file);
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), BLUE);
}

#[test]
fn a_bad_save_leaves_the_picture_and_is_told_once() {
    let Some(mut live) = red("bad") else { return };
    live.write("s.json", "{ \"camera\": { \"fov\": 0 } }");
    let (part, refusal) = live.refused();
    assert!(part == Part::Style && refusal.to_string().contains("\"fov\" is 0"), "{refusal}");
    assert_eq!(live.ground(), RED);
    // The same again, and a touch: nothing new to say.
    live.write("s.json", "{ \"camera\": { \"fov\": 0 } }");
    live.silent();
    live.write("s.json", "{ \"camera\": { \"fov\": -1 } }");
    assert!(live.refused().1.to_string().contains("\"fov\" is -1"));
    // As it was: nothing to draw, but the mistake is over.
    live.write("s.json", &ground(RED));
    assert!(matches!(live.next(), Reload::Mended(Part::Style)));
    live.write("s.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
}

#[test]
fn what_an_effect_applies_to_is_taken() {
    let style = |applies_to: &str| {
        format!(
            r#"{{ "mapping": {{ "*": "unlit", "post_effects": ["o"] }}, "geometry": {{ "scale": 0.5 }},
                "shaders": [{{ "name": "o", "shader": "ssaoPost", "properties": {{ "applies_to": {applies_to} }} }}] }}"#
        )
    };
    let (carbon, oxygen) = (style("\"atom[element=C]\""), style("\"atom[element=O]\""));
    let Some(mut live) = Live::new("applies-to", &[("s.json", &carbon), ("m.xyz", MOLECULE)]) else { return };
    assert_eq!(live.taken(), Part::Style);
    let drawn = |live: &mut Live| live.engine.still(&gpu::request([48, 48], 1)).unwrap();
    let first = drawn(&mut live);
    let mut seen = vec![first.clone()];
    for text in [&oxygen, &style("null"), &style("\"atom[element=N]\"")] {
        live.write("s.json", text);
        assert_eq!(live.taken(), Part::Style);
        let now = drawn(&mut live);
        assert!(seen.iter().all(|other| *other != now), "{text}");
        seen.push(now);
    }
    live.write("s.json", &carbon);
    assert_eq!(live.taken(), Part::Style);
    assert!(drawn(&mut live) == first);
}

#[test]
fn a_file_that_vanishes_leaves_the_picture_and_may_come_back() {
    let Some(mut live) = red("vanish") else { return };
    fs::remove_file(live.path("s.json")).unwrap();
    assert!(live.refused().1.to_string().contains("no such file"));
    assert_eq!(live.ground(), RED);
    live.write("s.json", &ground(GREEN));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), GREEN);
}

#[test]
fn a_first_load_that_fails_can_be_mended() {
    for (name, first) in [("first-bad", Some("{")), ("first-missing", None)] {
        let files: Vec<(&str, &str)> =
            first.map(|text| ("s.json", text)).into_iter().chain([("m.xyz", MOLECULE)]).collect();
        let Some(mut live) = Live::new(name, &files) else { return };
        assert_eq!(live.refused().0, Part::Style);
        assert!(live.engine.style().is_none());
        live.write("s.json", &ground(BLUE));
        assert_eq!(live.taken(), Part::Style);
        assert_eq!(live.ground(), BLUE);
    }
}

#[test]
fn files_beside_the_scene_are_followed_once_it_names_them() {
    let Some(mut live) = red("scene-side") else { return };
    live.write("m.side", "first");
    live.silent();
    live.write("m.xyz", "1\n\nC 0 0 0\n");
    assert_eq!(live.taken(), Part::Scene);
    live.write("m.side", "second");
    assert_eq!(live.taken(), Part::Scene);
    assert_eq!(live.engine.scene().map(|scene| scene.name.as_str()), Some("second"));
    fs::remove_file(live.path("m.side")).unwrap();
    assert_eq!(live.taken(), Part::Scene);
    // Events come in order: what the files of the scene had to tell came before this, however late.
    live.write("s.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
    live.silent();
    live.write("m.side", "third");
    live.silent();
}

#[test]
fn a_save_that_was_read_is_not_read_once_more() {
    let Some(mut live) = red("read-once") else { return };
    live.write("m.xyz", "1\n\nC 0 0 0\n");
    assert_eq!(live.taken(), Part::Scene);
    // The last events of the save.
    live.silent();
    let reads = live.scene_reads();
    // Longer than the time between two looks at the files.
    live.silent();
    live.silent();
    assert_eq!(live.scene_reads(), reads);
}

#[test]
fn the_scene_is_followed_like_the_style() {
    let Some(mut live) = red("scene") else { return };
    assert_eq!(live.engine.counts().spheres, 2);
    live.write("m.xyz", "1\n\nC 0 0 0\n");
    assert_eq!(live.taken(), Part::Scene);
    assert_eq!(live.engine.counts().spheres, 1);
    live.write("m.xyz", "");
    assert!(matches!(live.refused(), (Part::Scene, Refusal::Scene(_))));
    live.draw();
    assert_eq!(live.engine.counts().spheres, 1);
    live.write("m.xyz", "3\n\nC 0 0 0\nC 3 0 0\nC 6 0 0\n");
    assert_eq!(live.taken(), Part::Scene);
    assert_eq!(live.engine.counts().spheres, 3);
}

#[test]
fn every_base_is_followed() {
    let Some(mut live) = red("bases") else { return };
    live.write("base.json", &ground(GREEN));
    live.write("middle.json", "{ \"extends\": \"base.json\" }");
    live.write("s.json", "{ \"extends\": \"middle.json\" }");
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), GREEN);
    live.write("base.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), BLUE);
    live.write("middle.json", &ground(RED));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), RED);
    // Nothing asks for it any more.
    live.write("base.json", &ground(GREEN));
    live.silent();
}

#[test]
fn a_base_that_is_missing_may_come() {
    let Some(mut live) = red("missing-base") else { return };
    live.write("s.json", "{ \"extends\": \"later.json\" }");
    assert!(live.refused().1.to_string().contains("later.json"));
    // Longer than the time between two looks at the files, which would hide that nobody listens for it.
    live.silent();
    live.silent();
    live.silent();
    live.write("later.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), BLUE);
}

#[cfg(unix)]
#[test]
fn links_are_followed_to_what_they_mean() {
    let Some(mut live) = red("links") else { return };
    fs::create_dir(live.path("far")).unwrap();
    live.write("far/real.json", &ground(BLUE));
    fs::remove_file(live.path("s.json")).unwrap();
    std::os::unix::fs::symlink("far/real.json", live.path("s.json")).unwrap();
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), BLUE);
    live.write("far/real.json", &ground(GREEN));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), GREEN);
    // A base behind a link, which then leads elsewhere.
    live.write("far/other.json", &ground(RED));
    std::os::unix::fs::symlink("far/real.json", live.path("base.json")).unwrap();
    fs::remove_file(live.path("s.json")).unwrap();
    live.write("s.json", "{ \"extends\": \"base.json\", \"camera\": { \"fov\": 20 } }");
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), GREEN);
    std::os::unix::fs::symlink("far/other.json", live.path("new.json")).unwrap();
    fs::rename(live.path("new.json"), live.path("base.json")).unwrap();
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), RED);
    // A circle of links, then an honest file.
    fs::remove_file(live.path("s.json")).unwrap();
    std::os::unix::fs::symlink("s.json", live.path("s.json")).unwrap();
    assert_eq!(live.refused().0, Part::Style);
    fs::remove_file(live.path("s.json")).unwrap();
    live.write("s.json", &ground(RED));
    assert_eq!(live.taken(), Part::Style);
}

#[test]
fn a_folder_in_place_of_the_style_is_refused() {
    let Some(mut live) = red("folder") else { return };
    fs::remove_file(live.path("s.json")).unwrap();
    fs::create_dir(live.path("s.json")).unwrap();
    assert!(live.refused().1.to_string().contains("folder"));
    fs::remove_dir(live.path("s.json")).unwrap();
    live.write("s.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
}

#[test]
fn a_folder_that_is_replaced_is_followed_again() {
    let Some(mut live) = red("replaced") else { return };
    let aside = live.folder.with_extension("aside");
    fs::rename(&live.folder, &aside).unwrap();
    fs::create_dir(&live.folder).unwrap();
    live.write("m.xyz", MOLECULE);
    live.write("s.json", &ground(BLUE));
    assert_eq!(live.taken(), Part::Style);
    live.write("s.json", &ground(GREEN));
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(live.ground(), GREEN);
    fs::remove_dir_all(aside).unwrap();
}

#[test]
fn what_the_device_cannot_hold_is_refused_whole() {
    let Some(mut live) = red("too-many") else { return };
    let atoms: String = (0..600).map(|i| format!("C {} {} 0\n", i % 30 * 3, i / 30 * 3)).collect();
    live.write("m.xyz", &format!("600\n\n{atoms}"));
    assert_eq!(live.taken(), Part::Scene);
    // 600 materials in use; a frame holds 512.
    let names = |i: usize| format!("\"atom[name=N{i}]\": \"n{i}\"");
    let scene: String = (0..600).map(|i| format!("N{i} {} {} 0\n", i % 30 * 3, i / 30 * 3)).collect();
    live.write("m.xyz", &format!("600\n\n{scene}"));
    assert_eq!(live.taken(), Part::Scene);
    let shaders: Vec<String> = (0..600).map(|i| format!("{{ \"name\": \"n{i}\", \"shader\": \"unlit\" }}")).collect();
    let mapping: Vec<String> = (0..600).map(names).collect();
    let many = format!("{{ \"shaders\": [{}], \"mapping\": {{ {} }} }}", shaders.join(","), mapping.join(","));
    live.write("s.json", &many);
    let (part, refusal) = live.refused();
    assert!(part == Part::Style && matches!(refusal, Refusal::Device(_)), "{refusal}");
    assert_eq!(live.ground(), RED);
    assert_eq!(live.engine.counts().spheres, 600);
}

#[test]
fn a_property_saved_to_a_file_costs_one_write_as_well() {
    let toon = |steps: u32| {
        format!(
            "{{ \"mapping\": {{ \"*\": \"t\" }}, \"shaders\": [{{ \"name\": \"t\", \"shader\": \"toon\", \
             \"properties\": {{ \"steps\": {steps} }} }}] }}"
        )
    };
    let Some(mut live) = Live::alone("one-write", &[("s.json", &toon(3)), ("m.xyz", MOLECULE)]) else { return };
    live.taken();
    live.draw();
    let before = live.engine.counters();
    live.write("s.json", &toon(5));
    live.taken();
    let cost = live.engine.counters() - before;
    assert_eq!(cost, Counters { writes: 1, bytes_written: 4, ..Counters::default() });
}

/// Copies the project's shaders into the folder.
fn copy_shaders(live: &Live) {
    let from = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    for below in ["lib", "objects"] {
        fs::create_dir_all(live.path("shaders").join(below)).unwrap();
        for entry in fs::read_dir(from.join(below)).unwrap() {
            let name = entry.unwrap().file_name();
            fs::copy(from.join(below).join(&name), live.path("shaders").join(below).join(&name)).unwrap();
        }
    }
}

#[test]
fn shaders_of_a_source_tree_are_followed() {
    let style = "{ \"mapping\": { \"*\": \"unlit\" }, \"shaders\": [{ \"name\": \"unlit\", \"shader\": \"unlit\", \
                 \"properties\": { \"base_color\": \"lime\" } }], \"geometry\": { \"scale\": 1 } }";
    let Some(mut live) = Live::alone("shaders", &[("m.xyz", "1\n\nC 0 0 0\n")]) else { return };
    copy_shaders(&live);
    live.write("s.json", style);
    assert_eq!(live.taken(), Part::Style);
    let middle = |live: &mut Live| {
        let image = live.engine.still(&super::gpu::request([9, 9], 1)).unwrap();
        let [r, g, b, _] = image.pixel(4, 4).map(|value| (value * 255.0).round() as u8);
        [r, g, b]
    };
    assert_eq!(middle(&mut live), [0, 255, 0]);
    let good = fs::read_to_string(live.path("shaders/objects/unlit.wgsl")).unwrap();
    assert!(good.contains("return s.base_color;"), "{good}");
    live.write("shaders/objects/unlit.wgsl", &good.replace("return s.base_color;", "return s.base_color.yxz;"));
    assert_eq!(live.taken(), Part::Shaders);
    assert_eq!(middle(&mut live), [255, 0, 0]);
    // A mistake leaves the picture, and is said with its file and line.
    live.write("shaders/objects/unlit.wgsl", &good.replace("return s.base_color;", "return s.base_colour;"));
    let (part, refusal) = live.refused();
    assert!(part == Part::Shaders && refusal.to_string().starts_with("shaders/objects/unlit.wgsl:"), "{refusal}");
    assert_eq!(middle(&mut live), [255, 0, 0]);
    live.write("shaders/objects/unlit.wgsl", &good);
    assert_eq!(live.taken(), Part::Shaders);
    assert_eq!(middle(&mut live), [0, 255, 0]);
    // A save that keeps a backup: the file is away for a while, and the picture stays.
    live.write("shaders/objects/unlit.wgsl", &good.replace("return s.base_color;", "return s.base_color.yxz;"));
    assert_eq!(live.taken(), Part::Shaders);
    let own = live.path("shaders/objects/unlit.wgsl");
    fs::rename(&own, live.path("shaders/objects/unlit.wgsl~")).unwrap();
    live.silent();
    assert_eq!(middle(&mut live), [255, 0, 0]);
    live.write("shaders/objects/unlit.wgsl", &good);
    assert_eq!(live.taken(), Part::Shaders);
    assert_eq!(middle(&mut live), [0, 255, 0]);
}
/// A PNG of one grey pixel.
fn pixel(grey: u8) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 1, 1);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[grey]).unwrap();
    writer.finish().unwrap();
    file
}

#[test]
fn a_picture_of_a_transfer_function_is_followed() {
    let style = r#"{ "mapping": { "*": "g" }, "shaders": [{ "name": "g", "shader": "curvature",
        "properties": { "opacity_transfer": "p.png" } }] }"#;
    let Some(mut live) = Live::new("picture", &[("s.json", style), ("m.xyz", MOLECULE)]) else { return };
    let opacity = |live: &Live| {
        let style = live.engine.style().unwrap();
        let used = style.shaders.iter().find(|used| used.name == "g").unwrap();
        used.values.transfer("opacity_transfer").opacity(0.5, 0.5)
    };
    assert!(live.refused().1.to_string().contains("cannot use \"p.png\": there is no such file"));
    // Longer than the time between two looks at the files.
    live.silent();
    live.silent();
    live.silent();
    fs::write(live.path("p.png"), pixel(0)).unwrap();
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(opacity(&live), 0.0);
    fs::write(live.path("p.png"), pixel(255)).unwrap();
    assert_eq!(live.taken(), Part::Style);
    assert_eq!(opacity(&live), 1.0);
    // The same content again is no change, a broken one is told, and the picture stays.
    fs::write(live.path("p.png"), pixel(255)).unwrap();
    live.silent();
    fs::write(live.path("p.png"), &pixel(255)[..40]).unwrap();
    assert!(live.refused().1.to_string().contains("this PNG is broken"));
    assert_eq!(opacity(&live), 1.0);
    // By rename, as painting programs save.
    fs::write(live.path("p.png.new"), pixel(51)).unwrap();
    fs::rename(live.path("p.png.new"), live.path("p.png")).unwrap();
    assert_eq!(live.taken(), Part::Style);
    assert!((opacity(&live) - 0.2).abs() < 1e-6);
    live.silent();
}
