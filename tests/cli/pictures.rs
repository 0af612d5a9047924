//! What the command draws and writes.

use super::rig::{Folder, Picture};
use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};
use png::{BitDepth, ColorType};

#[test]
fn a_still_is_a_png_of_its_size_in_srgb() {
    let Some(folder) = Folder::with_adapter("still") else { return };
    let outcome = folder.run("render c60 -s education -o c60.png --size 64x48 --samples 4").done();
    assert_eq!((outcome.out.as_str(), outcome.err.as_str()), ("", ""));
    let picture = Picture::read(&folder, "c60.png");
    assert_eq!(picture.info, (64, 48, ColorType::Rgb, BitDepth::Eight));
    assert!(picture.srgb && picture.num_colors() > 8, "{} colours", picture.num_colors());
    assert_eq!(folder.names(), ["c60.png"]);
}

#[test]
fn more_samples_give_more_shades() {
    let Some(folder) = Folder::with_adapter("samples") else { return };
    let colors = |samples: &str| {
        folder.run(&format!("render c60 -o {samples}.png --size 64x64 --samples {samples}")).done();
        Picture::read(&folder, &format!("{samples}.png")).num_colors()
    };
    assert!(colors("1") < colors("16"));
}

#[test]
fn sixteen_bits_and_a_transparent_background() {
    let Some(folder) = Folder::with_adapter("wide") else { return };
    folder.run("render c60 -o wide.png --size 64x64 --samples 2 --bits 16").done();
    let wide = Picture::read(&folder, "wide.png");
    assert_eq!(wide.info, (64, 64, ColorType::Rgb, BitDepth::Sixteen));
    folder.run("render c60 -o clear.png --size 64x64 --samples 2 --transparent").done();
    let clear = Picture::read(&folder, "clear.png");
    assert_eq!(clear.info, (64, 64, ColorType::Rgba, BitDepth::Eight));
    let alphas: Vec<u8> = clear.bytes.iter().skip(3).step_by(4).copied().collect();
    assert_eq!(alphas[0], 0, "the corner");
    assert!(alphas.contains(&255));
}

#[test]
fn aovs_are_linear_floats_with_nothing_marked() {
    let Some(folder) = Folder::with_adapter("aovs") else { return };
    let aovs = ["depth", "normal", "id", "color"].map(|name| format!("--aov {name}={name}.exr")).join(" ");
    folder.run(&format!("render c60 --size 64x48 --samples 1 {aovs}")).done();
    let channels = |name: &str| -> Vec<(String, FlatSamples)> {
        let image = read_first_flat_layer_from_file(folder.path(&format!("{name}.exr"))).unwrap();
        assert_eq!((image.layer_data.size.width(), image.layer_data.size.height()), (64, 48));
        let list = image.layer_data.channel_data.list;
        list.into_iter().map(|channel| (channel.name.to_string(), channel.sample_data)).collect()
    };
    let floats = |channels: &[(String, FlatSamples)], name: &str| -> Vec<f32> {
        match channels.iter().find(|(channel, _)| channel == name) {
            Some((_, FlatSamples::F32(values))) => values.clone(),
            other => panic!("{name}: {other:?}"),
        }
    };
    let depth = floats(&channels("depth"), "Z");
    assert_eq!(depth[0], f32::INFINITY, "the corner");
    let seen: Vec<bool> = depth.iter().map(|depth| depth.is_finite()).collect();
    assert!(seen.iter().any(|&seen| seen) && depth.iter().all(|depth| *depth > 0.0));

    let normal = channels("normal");
    let [x, y, z] = ["X", "Y", "Z"].map(|name| floats(&normal, name));
    for (pixel, &seen) in seen.iter().enumerate() {
        let length = (x[pixel].powi(2) + y[pixel].powi(2) + z[pixel].powi(2)).sqrt();
        // 1e-3: the square root of what single precision loses on a unit vector, with room.
        assert!((length - if seen { 1.0 } else { 0.0 }).abs() < 1e-3, "{pixel}: {length}");
        assert!(!seen || z[pixel] > -1e-3, "turned to the viewer");
    }
    match &channels("id")[0] {
        (name, FlatSamples::U32(ids)) => {
            assert_eq!(name, "id");
            assert!(ids.iter().zip(&seen).all(|(id, seen)| (*id != 0) == *seen));
        }
        other => panic!("{other:?}"),
    }
    let color = channels("color");
    assert_eq!(floats(&color, "A")[0], 0.0, "nothing is there");
    assert!(["R", "G", "B"].iter().all(|name| floats(&color, name).iter().all(|value| value.is_finite())));
}

#[test]
fn json_is_one_line_with_the_keys_of_the_manual() {
    let Some(folder) = Folder::with_adapter("json") else { return };
    let outcome = folder.run("render water -s scientific --json --size 32x16 --samples 2 --frames 3").done();
    assert_eq!(outcome.out.lines().count(), 1);
    let line: serde_json::Value = serde_json::from_str(&outcome.out).unwrap();
    for key in ["adapter", "driver", "renderer", "scene", "style"] {
        assert!(line[key].is_string(), "{key}: {line}");
    }
    for key in ["load_ms", "first_frame_ms", "readback_ms", "encode_ms", "device_ms", "total_ms"] {
        assert!(line[key].as_f64().is_some_and(|ms| ms >= 0.0), "{key}: {line}");
    }
    for key in
        ["triangles", "spheres", "cylinders", "atoms", "bonds", "parts", "mesh_triangles", "pipelines_built", "samples"]
    {
        assert!(line[key].is_u64(), "{key}: {line}");
    }
    assert_eq!(line["frame_ms"].as_array().map(Vec::len), Some(3));
    assert_eq!((&line["atoms"], &line["bonds"], &line["size"]), (&3.into(), &2.into(), &serde_json::json!([32, 16])));
    assert!(line["pass_ms"].is_object() && line["peak_rss_mb"].as_f64().is_none_or(|mb| mb > 1.0));
    assert!(line["target_bytes"].as_object().unwrap().values().all(|bytes| bytes.as_u64() > Some(0)));
}

#[test]
fn a_gallery_is_a_folder_that_opens_from_disk() {
    let Some(folder) = Folder::with_adapter("gallery") else { return };
    folder.write("a b&c.xyz", "1\n\nC 0 0 0\n");
    folder.write("glass.json", r#"{ "shaders": [{ "name": "unused", "shader": "toon" }] }"#);
    let args = ["gallery", "c60", "a b&c.xyz", "-s", "education", "-s", "glass.json", "-o", "new/sheet"];
    let outcome = folder.run_all(&[&args[..], &["--size", "32x32", "--samples", "1"]].concat()).done();
    assert!(outcome.out.contains("4 pictures") && outcome.out.contains("index.html"), "{}", outcome.out);
    assert_eq!(outcome.messages().len(), 1, "one note for all cells of a look: {}", outcome.err);
    let page = String::from_utf8(folder.read("new/sheet/index.html")).unwrap();
    let mut links = 0;
    for attribute in ["src=\"", "href=\""] {
        for link in page.split(attribute).skip(1).map(|rest| rest.split('"').next().unwrap()) {
            assert!(!link.contains(['/', ':', '%', '#', '?', '&']), "relative, and the same as a name: {link}");
            let picture = Picture::read(&folder, &format!("new/sheet/{link}"));
            assert_eq!((picture.info.0, picture.info.1), (32, 32));
            links += 1;
        }
    }
    assert_eq!(links, 8);
    // A second run writes over its own files.
    folder.run("gallery c60 -s education -o new/sheet --size 8x8 --samples 1").done();
}

#[test]
fn names_that_would_collide_in_a_gallery_do_not() {
    let Some(folder) = Folder::with_adapter("collide") else { return };
    for name in ["a.b.xyz", "a.xyz", "A.xyz"] {
        folder.write(name, "1\n\nC 0 0 0\n");
    }
    folder.write("c.json", "{}").write("b.c.json", "{}");
    folder.run("gallery a.b.xyz a.xyz A.xyz -s c.json -s b.c.json -o g --size 4x4 --samples 1").done();
    let names = std::fs::read_dir(folder.path("g")).unwrap();
    let lower: std::collections::HashSet<String> =
        names.map(|entry| entry.unwrap().file_name().to_string_lossy().to_lowercase()).collect();
    assert_eq!(lower.len(), 7, "{lower:?}");
}

#[test]
fn a_file_that_has_a_shipped_name_comes_first_and_a_folder_does_not() {
    let Some(folder) = Folder::with_adapter("shadow") else { return };
    folder.write("c60", "1\n\nO 0 0 0\n");
    std::fs::create_dir(folder.path("water")).unwrap();
    let atoms = |scene: &str| -> u64 {
        let outcome = folder.run(&format!("render {scene} --json --size 4x4 --samples 1")).done();
        serde_json::from_str::<serde_json::Value>(&outcome.out).unwrap()["atoms"].as_u64().unwrap()
    };
    assert_eq!((atoms("c60"), atoms("water")), (1, 3));
}

#[test]
fn every_shipped_scene_and_look_is_drawn_from_any_folder() {
    let Some(folder) = Folder::with_adapter("shipped") else { return };
    folder.run("gallery --size 4x4 --samples 1 -o all").done();
    let count = std::fs::read_dir(folder.path("all")).unwrap().count();
    assert_eq!(
        count,
        restyle::shipped::LOOKS.len() * restyle::shipped::SCENES.iter().map(|shipped| shipped.len()).sum::<usize>() + 1
    );
}

#[test]
fn model_chooses_a_frame() {
    let Some(folder) = Folder::with_adapter("model") else { return };
    folder.write("two.xyz", "1\n\nC 0 0 0\n2\n\nO 0 0 0\nH 0.9 0 0\n");
    let run = |model: &str| {
        let outcome = folder.run(&format!("render two.xyz --json --size 4x4 --samples 1 {model}")).done();
        (serde_json::from_str::<serde_json::Value>(&outcome.out).unwrap()["atoms"].as_u64(), outcome.err)
    };
    let (first, note) = run("");
    assert_eq!(first, Some(1));
    assert!(note.starts_with("two.xyz: warning: 1 other model in the file"), "{note}");
    assert_eq!((run("--model 2").0, run("--model all").0), (Some(2), Some(3)));
}
