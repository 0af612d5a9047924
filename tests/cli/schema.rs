//! `restyle schema`: the schema, and the manual with its pictures.

use super::rig::{Folder, Picture};

#[test]
fn the_schema_is_the_file_of_the_looks() {
    let folder = Folder::new("schema-print");
    let committed = include_str!("../../styles/style-v1.json");
    assert_eq!(folder.run("schema").done().out, committed);
}

#[test]
fn every_picture_of_the_manual_shows_its_parameter() {
    let Some(folder) = Folder::with_adapter("manual") else { return };
    folder.run("schema --manual new/docs").done();
    let text = String::from_utf8(folder.read("new/docs/style-files.md")).unwrap();
    let pictures: Vec<&str> = text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(pictures.len() > 30, "{pictures:?}");
    for name in pictures {
        let picture = Picture::read(&folder, &format!("new/docs/{name}"));
        let (width, height) = (picture.info.0 as usize, picture.info.1 as usize);
        // A picture of 150 pixels, then 4 of white.
        let count = (width + 4) / 154;
        assert_eq!((count * 154 - 4, height), (width, 112), "{name}");
        let pixel = |tile: usize, x: usize, y: usize| {
            let start = (y * width + tile * 154 + x) * 3;
            &picture.bytes[start..start + 3]
        };
        for tile in 1..count {
            let apart = |x, y| pixel(tile - 1, x, y).iter().zip(pixel(tile, x, y)).any(|(a, b)| a.abs_diff(*b) > 12);
            let changed = (0..150 * 112).filter(|i| apart(i % 150, i / 150)).count();
            // Ours: a hundredth of a picture is what an eye finds without being told.
            assert!(changed > 168, "{name}: between pictures {tile} and {}, {changed} pixels change", tile + 1);
        }
    }
}

#[test]
fn a_manual_needs_a_folder() {
    let Some(folder) = Folder::with_adapter("manual-file") else { return };
    folder.write("docs", "a file");
    folder.run("schema --manual docs").refused(1, "there is a file where a folder is needed");
    assert_eq!(folder.names(), ["docs"]);
}
