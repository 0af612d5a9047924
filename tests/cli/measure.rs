//! `restyle measure`: what an experiment leaves, and command lines and folders that are refused before any work.

use serde_json::Value as Json;

use super::rig::Folder;

#[test]
fn an_experiment_leaves_figures_a_chart_and_a_page() {
    let folder = Folder::new("measure");
    let outcome = folder.run("measure toon-edges -o out --size 24x24").done();
    assert!(outcome.out.starts_with("toon-edges: best RMSE ") && outcome.err.is_empty(), "{outcome:?}");
    let document: Json = serde_json::from_slice(&folder.read("out/toon-edges/toon-edges.json")).unwrap();
    assert_eq!(
        (&document["partial"], &document["size"], &document["adapter"]),
        (&false.into(), &[24, 24].into(), &Json::Null)
    );
    let rows = document["rows"].as_array().unwrap();
    // Three shapes, three steps, three numbers of samples.
    assert_eq!(rows.len(), 27);
    for row in rows {
        let ms = &row["ms"];
        let [min, median, max] = ["min", "median", "max"].map(|name| ms[name].as_f64().unwrap());
        assert!(0.0 < min && min <= median && median <= max, "{row}");
        for figure in ["rmse", "max", "psnr", "ssim", "flip"] {
            assert!(row["error"][figure].is_number() || row["error"][figure] == "inf", "{row}");
        }
    }
    assert_eq!(rows.iter().filter(|row| row["published"] == true).count(), 3);
    let chart = String::from_utf8(folder.read("out/toon-edges/chart.svg")).unwrap();
    let page = String::from_utf8(folder.read("out/toon-edges/index.html")).unwrap();
    assert!(chart.starts_with("<svg") && chart.contains("gradient length") && chart.contains("as published"));
    assert!(page.contains(&chart) && page.contains("data:image/png;base64,") && !page.contains("http-equiv"));
    for word in ["adapter", "driver", "24x24", "rounds", "noise"] {
        assert!(page.contains(word), "{word}");
    }
}

#[test]
fn experiments_and_sizes_that_cannot_be_are_refused() {
    let folder = Folder::new("measure-usage");
    for (args, words) in [
        ("measure", "<EXPERIMENT>"),
        ("measure toonedges", "\"toonedges\": no such experiment; did you mean \"toon-edges\"? there are shading, "),
        ("measure nothing-of-ours", "\"nothing-of-ours\": no such experiment; there are shading, looks, "),
        ("measure toon-edges --size 0x4", "at least 1x1"),
        ("measure toon-edges --size 5000x4", "5000x4: pictures are at most 4096x4096 here"),
    ] {
        folder.run(args).refused(2, words);
    }
    folder.run_all(&["measure", ""]).refused(2, "no such experiment");
    assert!(folder.names().is_empty());
}

#[test]
fn a_folder_that_cannot_be_written_is_told_before_any_work() {
    let folder = Folder::new("measure-folder");
    folder.write("file", "former");
    for output in ["file", "file/deep"] {
        let run = folder.run(&format!("measure toon-edges -o {output}"));
        run.refused(1, "there is a file where a folder is needed; choose another place");
    }
    assert_eq!((folder.names(), folder.read("file")), (vec!["file".to_owned()], b"former".to_vec()));
}

#[test]
fn pictures_of_one_pixel_are_measured() {
    let folder = Folder::new("measure-pixel");
    folder.run("measure toon-edges -o out --size 1x1").done();
    folder.run("measure toon-edges -o out --size 3x1").done();
}
