use crate::scene::import::sniff::{Format, sniff};
use crate::scene::{LoadOptions, NoteKind, RawMesh, Report, SceneError};

use super::*;

fn read_stl(bytes: &[u8]) -> (Result<RawMesh, SceneError>, Report) {
    let options = LoadOptions::default();
    let mut import =
        Import { file: "a.stl", options: &options, report: Report::default(), folder: None, side_files: Vec::new() };
    (read(&mut import, bytes), import.report)
}

fn loaded(bytes: &[u8]) -> (RawMesh, Report) {
    let (mesh, report) = read_stl(bytes);
    (mesh.expect("loads"), report)
}

/// A fan of `count` facets around the z axis.
fn binary_fan(count: u32, header: &[u8], announced: u32) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(announced.to_le_bytes());
    for i in 0..count {
        let corner = |i: u32| [(i as f32).cos(), (i as f32).sin(), 0.0];
        let normal = [f32::NAN, 0.0, 0.0];
        let floats = [normal, [0.0, -0.0, 0.0], corner(i), corner(i + 1)];
        floats.as_flattened().iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        bytes.extend([0x12, 0x80]);
    }
    bytes
}

#[test]
fn the_length_tells_binary_from_text_and_vertices_are_shared() {
    let bytes = binary_fan(6, b"solid fan", 6);
    assert_eq!(sniff("fan", &bytes), Format::Stl);
    let (mesh, report) = loaded(&bytes);
    assert!(report.is_empty(), "{report}");
    assert_eq!((mesh.shapes[0].triangles.len(), mesh.shapes[0].positions.len()), (6, 8));
    assert_eq!(mesh.shapes[0].triangles[1], [0, 2, 3]);
    assert_eq!(mesh.shapes[0].positions[2].x, f64::from(1.0_f32.cos()));
}

#[test]
fn counts_of_binary_files_are_not_believed() {
    for announced in [0, u32::MAX] {
        let (mesh, report) = loaded(&binary_fan(6, b"fan", announced));
        assert_eq!(mesh.shapes[0].triangles.len(), 6);
        assert_eq!(report.count(NoteKind::CountWrong), 1);
    }
    let (mesh, report) = loaded(&binary_fan(6, b"fan", 4));
    assert_eq!((mesh.shapes[0].triangles.len(), report.count(NoteKind::TrailingBytes)), (4, 100));
    let mut bytes = binary_fan(6, b"fan\0\0", 6);
    bytes.truncate(84 + 5 * 50 + 49);
    let (mesh, report) = loaded(&bytes);
    assert_eq!((mesh.shapes[0].triangles.len(), report.count(NoteKind::MeshCut)), (5, 1));
    assert!(matches!(read_stl(&binary_fan(0, b"\0", 0)).0, Err(SceneError::NoTriangles { .. })));
    let message = read_stl(&[0; 83]).0.expect_err("cut").to_string();
    assert_eq!(message, "a.stl: byte 83: ends inside the header of 84 bytes; was it saved or downloaded completely?");
}

#[test]
fn facets_without_a_place_are_left_out() {
    let mut bytes = binary_fan(3, b"fan", 3);
    for value in [f32::INFINITY, f32::NAN] {
        bytes[84 + 50 + 12..84 + 50 + 16].copy_from_slice(&value.to_le_bytes());
        assert_eq!(loaded(&bytes).0.shapes[0].triangles.len(), 2);
    }
    let (_, report) = loaded(&bytes);
    assert_eq!(report.to_string(), "1 face left out: a coordinate is no number (facet 2)\n");
}

const TWO_SOLIDS: &str = "solid Body A\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  \
    endloop\n endfacet\nendsolid Body A\nsolid\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 0 0 1e-1\n   \
    vertex 0 1 0\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 0 1 0\n   vertex 2 0 0\n  \
    endloop\n endfacet\nendsolid\n";

#[test]
fn each_solid_is_a_part_in_any_case_and_with_any_spaces() {
    let upper = TWO_SOLIDS.to_uppercase().replace('\n', "\r\n").replace("  ", "\t");
    for (text, name) in [(TWO_SOLIDS, "Body A"), (upper.as_str(), "BODY A")] {
        assert_eq!(sniff("a", text.as_bytes()), Format::Stl);
        let (mesh, report) = loaded(text.as_bytes());
        assert!(report.is_empty(), "{report}");
        let parts: Vec<_> = mesh.parts.iter().map(|part| (part.name.as_str(), part.shape)).collect();
        assert_eq!(parts, [(name, 0), ("", 1)]);
        assert_eq!(
            (mesh.shapes[1].triangles.as_slice(), mesh.shapes[1].positions[1].z),
            (&[[0, 1, 2], [0, 2, 3]][..], 0.1)
        );
    }
}

#[test]
fn misspelt_words_and_cut_files_keep_what_is_whole() {
    let (mesh, report) = loaded(TWO_SOLIDS.replacen("vertex", "vertx", 1).as_bytes());
    assert_eq!(mesh.parts.len(), 1);
    assert_eq!((report.count(NoteKind::UnknownWord), report.count(NoteKind::ShortFace)), (1, 1));
    let (mesh, report) = loaded(TWO_SOLIDS.replace(" facet", " fact").replace("endfacet", "endfact").as_bytes());
    assert_eq!((mesh.shapes[1].triangles.len(), report.count(NoteKind::UnknownWord)), (2, 6));
    let (mesh, report) = loaded(TWO_SOLIDS.replacen("endloop", "vertex -1 0.5 0\nendloop", 1).as_bytes());
    assert_eq!((mesh.shapes[0].triangles.len(), report.count(NoteKind::CrossedPolygon)), (2, 0));
    let cut = TWO_SOLIDS.find("2 0 0").expect("there");
    let (mesh, report) = loaded(&TWO_SOLIDS.as_bytes()[..cut + 5]);
    assert_eq!((mesh.shapes[1].triangles.len(), report.count(NoteKind::MeshCut)), (1, 1));
    let (mesh, report) = loaded(TWO_SOLIDS.replacen("1 0 0", "nan 0 0", 1).as_bytes());
    assert_eq!((mesh.parts.len(), report.count(NoteKind::FaceNowhere)), (1, 1));
    assert!(report.to_string().ends_with("(line 2: \"nan 0 0\")\n"), "{report}");
}

#[test]
fn what_no_picture_can_hold_is_refused_with_its_line() {
    let message =
        |text: &str| read_stl(TWO_SOLIDS.replacen("1 0 0", text, 1).as_bytes()).0.expect_err(text).to_string();
    assert_eq!(message("1,5 0 0"), "a.stl:5: \"1,5\" has a decimal comma; export the model with decimal points");
    assert_eq!(
        message("1e101 0 0"),
        "a.stl:5: \"1e101\" is no coordinate, being larger than 1e100; scale the model down"
    );
    assert!(matches!(read_stl(b"solid Empty\nendsolid Empty").0, Err(SceneError::NoTriangles { .. })));
}
