//! `restyle explain`: the passes of every shipped look, and that bytes are those of the frame that is drawn.

use serde_json::Value as Json;

use super::rig::Folder;

fn passes(folder: &Folder, args: &str) -> Vec<Json> {
    let out = folder.run(&format!("explain {args} --json")).done().out;
    let document: Json = serde_json::from_str(&out).expect("JSON");
    document["passes"].as_array().expect("passes").clone()
}

fn names(passes: &[Json], drawn: bool) -> String {
    let of = passes.iter().filter(|pass| pass["drawn"] == drawn);
    of.map(|pass| pass["name"].as_str().expect("a name")).collect::<Vec<_>>().join(" ")
}

#[test]
fn every_look_has_the_passes_that_it_needs() {
    let Some(folder) = Folder::with_adapter("explain-looks") else { return };
    let lines = "outline_seeds outline_words outline_beside outline_around outline";
    let focus = "circles widest reaching fields focused";
    for (look, drawn, left_out) in [
        (
            "advertisement",
            format!("shadow visibility shade occlusion occlusion_applied {focus} resolve"),
            "hull outlines layers outlinePost",
        ),
        (
            "education",
            "visibility hull outlines shade resolve".to_owned(),
            "shadow layers ssaoPost outlinePost dofPost",
        ),
        (
            "scientific",
            "visibility shade resolve".to_owned(),
            "shadow hull outlines layers ssaoPost outlinePost dofPost",
        ),
        ("future", format!("visibility shade {focus} resolve"), "shadow hull outlines layers ssaoPost outlinePost"),
        (
            "illustrative",
            format!("shadow visibility shade {lines} {lines} resolve"),
            "hull outlines layers ssaoPost dofPost",
        ),
        ("technical", format!("visibility shade {lines} resolve"), "shadow hull outlines layers ssaoPost dofPost"),
    ] {
        let passes = passes(&folder, &format!("c60 -s {look}"));
        assert_eq!((names(&passes, true), names(&passes, false).as_str()), (drawn, left_out), "{look}");
        assert!(passes.iter().all(|pass| pass["reason"].as_str().is_some_and(|reason| !reason.is_empty())), "{look}");
    }
}

#[test]
fn bytes_are_those_of_the_frame() {
    let Some(folder) = Folder::with_adapter("explain-bytes") else { return };
    for args in [
        "c60 -s advertisement --size 90x70 --samples 4",
        "c60 -s illustrative --size 90x70 --samples 1",
        "bracket -s technical --size 65x33 --samples 1",
        "caffeine -s education --size 64x64 --samples 1",
        "c60 -s future --size 64x40 --samples 1",
    ] {
        let said: u64 = passes(&folder, args).iter().map(|pass| pass["bytes"].as_u64().expect("bytes")).sum();
        let out = folder.run(&format!("render {args} --json")).done().out;
        let line: Json = serde_json::from_str(&out).expect("JSON");
        let targets = line["target_bytes"].as_object().expect("targets");
        assert_eq!(said, targets.values().map(|bytes| bytes.as_u64().expect("bytes")).sum::<u64>(), "{args}: {line}");
    }
}

#[test]
fn what_is_left_out_says_why() {
    let Some(folder) = Folder::with_adapter("explain-why") else { return };
    folder.write(
        "s.json",
        r#"{ "mapping": { "*": "basic", "post_effects": ["faint", "tiny", "meshes", "none", "blur"] },
            "lights": [{ "type": "point", "position": [0.5, 0, 0], "shadow": "hard" }],
            "shaders": [{ "name": "faint", "shader": "ssaoPost", "properties": { "intensity": 0 } },
                { "name": "tiny", "shader": "ssaoPost", "properties": { "radius": "0.0001r" } },
                { "name": "meshes", "shader": "ssaoPost", "properties": { "applies_to": "mesh" } },
                { "name": "none", "shader": "outlinePost", "properties": { "silhouette_width": 0, "boundary_width": 0 } },
                { "name": "blur", "shader": "dofPost", "properties": { "blur": "1pt" } }] }"#,
    );
    let out = folder.run("explain water -s s.json --size 100x80 --samples 1").done().out;
    for words in [
        "water in s.json: a frame of 100x80, with 1 sample on ",
        "3 spheres, 2 cylinders: which of them each pixel sees",
        "light 1 asks for a hard shadow, but it is within the scene's sphere",
        "hull outlines        no shader has one",
        "resolve              one sample of 8 bits a channel is written straight away",
        "ssaoPost             its intensity is 0",
        "ssaoPost             its radius is less than 1.5 pixels anywhere",
        "ssaoPost             it applies to nothing in this scene",
        "outlinePost          its lines have no width",
        "dofPost              nothing of the scene is blurred by half a pixel",
    ] {
        assert!(out.contains(words), "{words:?} is not in\n{out}");
    }
    let large = folder.run("explain water -s scientific --size 9000x6000").done().out;
    assert!(
        large.contains("9000x6000, in 15 tiles, of which this is the first") && large.contains(" 2048x2048 "),
        "{large}"
    );
    folder.run("explain water -s nothing-here.json").refused(1, "nothing-here.json");
    folder.run("explain no-such-scene -s education").refused(1, "no-such-scene");
    folder.run("explain water --size 0x5").refused(2, "at least 1x1");
    folder.run("explain water --samples 0").refused(2, "--samples");
}

#[test]
fn the_bucketed_k_buffer_is_told_with_its_bytes_and_bands() {
    let Some(folder) = Folder::with_adapter("explain-bkb") else { return };
    let style = |k: u32, effects: &str| {
        let text = format!(
            r#"{{ "mapping": {{ "*": "glass", "post_effects": [{effects}] }},
                "shaders": [{{ "name": "glass", "shader": "basic", "properties": {{ "opacity": 0.5 }} }}],
                "transparency": {{ "method": "bkb", "k": {k}, "memory_mb": 16 }} }}"#
        );
        folder.write("s.json", text);
    };
    let bkb = "bkb_cleared bkb_inserted bkb_bucketed bkb_stored bkb_stylised bkb_blended";
    let bytes = |passes: &[Json]| passes.iter().map(|pass| pass["bytes"].as_u64().expect("bytes")).sum::<u64>();
    for (k, size, in_bands) in [(8, "90x70", false), (64, "200x150", true)] {
        style(k, "");
        let args = format!("caffeine -s s.json --size {size} --samples 1");
        let passes = passes(&folder, &args);
        assert_eq!(names(&passes, true), format!("visibility shade {bkb}"));
        let reason = passes.iter().find(|pass| pass["name"] == "bkb_cleared").map(|pass| pass["reason"].to_string());
        assert_eq!(reason.expect("a reason").contains("in 2 bands of rows"), in_bands);
        let line: Json = serde_json::from_str(&folder.run(&format!("render {args} --json")).done().out).expect("JSON");
        let targets = line["target_bytes"].as_object().expect("targets").values();
        assert_eq!(bytes(&passes), targets.map(|bytes| bytes.as_u64().expect("bytes")).sum::<u64>(), "{line}");
    }
    // What follows sees nearest surfaces, of which lists have the ids.
    style(8, r#""outlinePost""#);
    let passes = passes(&folder, "caffeine -s s.json --size 90x70 --samples 1");
    let lists = "layers_counted layers_room layers_written layers_sorted layers_blended layers_nearest";
    assert!(names(&passes, true).starts_with(&format!("visibility shade {lists} {bkb} outline_seeds")));
    style(64, "");
    folder.run("render caffeine -s s.json --size 8192x16 --samples 1 --json").refused(3, "layers of three rows");
}
