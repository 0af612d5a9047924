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
