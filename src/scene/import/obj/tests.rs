use std::path::PathBuf;

use crate::scene::import::sniff::{Format, sniff};
use crate::scene::{LoadOptions, Report};

use super::*;

fn read_obj(bytes: &[u8]) -> (Result<RawMesh, SceneError>, Report) {
    let options = LoadOptions::default();
    let folder = PathBuf::from("/nowhere");
    let mut import = Import {
        file: "a.obj",
        options: &options,
        report: Report::default(),
        folder: Some(&folder),
        side_files: Vec::new(),
    };
    (read(&mut import, bytes), import.report)
}

fn loaded(bytes: &[u8]) -> (RawMesh, Report) {
    let (mesh, report) = read_obj(bytes);
    (mesh.expect("loads"), report)
}

/// Name, path, material and triangles of each part.
fn parts(mesh: &RawMesh) -> Vec<(&str, &str, Option<u32>, usize)> {
    let describe = |part: &'_ RawPart| mesh.shapes[part.shape as usize].triangles.len();
    mesh.parts.iter().map(|part| (part.name.as_str(), part.path.as_str(), part.material, describe(part))).collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn parts_are_runs_of_object_group_and_material() {
    let text = format!(
        "{SQUARE}f 1 2 3\no Box\nf 1 2 3\ng lid\nusemtl red\nf 1 2 3 4\nusemtl blue\nf 1 2 3\nusemtl red\nf 1 3 4\ng\nf 1 2 4\n"
    );
    let (mesh, report) = loaded(text.as_bytes());
    assert_eq!(
        parts(&mesh),
        [
            ("", "", None, 1),
            ("Box", "Box", None, 1),
            ("lid", "Box/lid", Some(0), 3),
            ("lid", "Box/lid", Some(1), 1),
            ("Box", "Box", Some(0), 1),
        ]
    );
    let names: Vec<_> = mesh.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["red", "blue"]);
    assert_eq!(report.count(NoteKind::UnknownMaterial), 2);
    assert_eq!(mesh.shapes[2].positions.len(), 4 + 3);
}

#[test]
fn any_encoding_line_end_and_broken_line_will_do() {
    let text = format!("# caf\u{e9}\\\ng K\u{f6}rper\n{SQUARE}f 1 2\\\n3 \\\n  4 # square\n");
    let latin: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
    let utf16 = |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(bytes).collect()
    };
    let files = [
        text.clone().into_bytes(),
        format!("\u{feff}{text}").into_bytes(),
        text.replace('\n', "\r\n").into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        latin,
        utf16(u16::to_le_bytes),
        utf16(u16::to_be_bytes),
    ];
    for (i, bytes) in files.iter().enumerate() {
        assert_eq!(sniff("a.obj", bytes), Format::Obj);
        assert_eq!(sniff("a", bytes), Format::Obj);
        let (mesh, report) = loaded(bytes);
        assert_eq!(parts(&mesh), [("K\u{f6}rper", "K\u{f6}rper", None, 2)], "{i}");
        assert!(report.is_empty(), "{report}");
    }
}

#[test]
fn indices_may_be_relative_and_faces_may_come_first() {
    let (mesh, _) = loaded(format!("{SQUARE}f -4 -3 -2\nv 9 9 9\nf -2 1 5\n").as_bytes());
    let shape = &mesh.shapes[0];
    let corners: Vec<_> = shape.triangles.as_flattened().iter().map(|&i| shape.positions[i as usize]).collect();
    let places = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [9.0, 9.0]];
    assert_eq!(corners.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>(), places);
    let (mesh, report) = loaded(format!("g a\nf 1 2 3\ng b\nf 4 1 2\n{SQUARE}").as_bytes());
    assert_eq!((mesh.parts.len(), report.is_empty()), (2, true));
}

#[test]
fn faces_that_cannot_be_are_left_out_with_their_lines() {
    let bad = "f 0 1 2\nf 1 2 5\nf 1 2 99999999999999999999\nf -5 1 2\nf 1 2\nf\nf 1 2 -9223372036854775808\nf x 1 2\nv nan 0 0\n\
        v 1\nf 1 2 5\nf 1 2 6\n";
    let (mesh, report) = loaded(format!("{SQUARE}f 1 2 3 4\n{bad}").as_bytes());
    assert_eq!(parts(&mesh)[0].3, 2);
    let counts = [NoteKind::FaceOutOfRange, NoteKind::ShortFace, NoteKind::FaceNowhere].map(|kind| report.count(kind));
    // The fifth vertex comes later, and is no place.
    assert_eq!(counts, [5, 2, 3]);
    assert!(report.to_string().contains("(line 6: \"0 1 2\"; line 8: "), "{report}");
    let message = read_obj(format!("{SQUARE}f 1 2 7\n").as_bytes()).0.expect_err("none").to_string();
    assert_eq!(
        message,
        "a.obj:5: none of 1 faces can be drawn: the vertices of this one are not there; export the model again"
    );
    assert!(matches!(read_obj(SQUARE.as_bytes()).0, Err(SceneError::NoTriangles { .. })));
}

#[test]
fn decimal_commas_and_absurd_numbers_are_refused_with_their_line() {
    for (bad, line) in [("v 0,5 1 2", 5), ("v 1e300 0 0", 5)] {
        let error = read_obj(format!("{SQUARE}{bad}\nf 1 2 3\n").as_bytes()).0.expect_err(bad).to_string();
        assert!(error.starts_with(&format!("a.obj:{line}: ")), "{error}");
    }
}

#[test]
fn normals_stay_with_their_corners_and_colours_with_their_vertices() {
    let text = "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0\nv 0 1 1 nan 0 0\nvt 0 0\nvn 0 0 1\nvn 0 1 0\nf 1/1/2 2//1 3//1\nf 1/1/1 3 4\nf 1 3 4//7\n";
    let (mesh, report) = loaded(text.as_bytes());
    // Faces with and without normals are shapes of their own.
    assert_eq!(parts(&mesh), [("", "", None, 1), ("", "", None, 2)]);
    assert_eq!((report.count(NoteKind::NoNormal), report.count(NoteKind::NoColor)), (2, 1));
    let RawNormals::PerCorner { normals, corners } = &mesh.shapes[0].normals else { panic!("no normals") };
    let of_corners: Vec<_> = corners[0].iter().map(|&i| normals[i as usize].to_array()).collect();
    assert_eq!(of_corners, [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    assert!(matches!(mesh.shapes[1].normals, RawNormals::None));
    assert_eq!(mesh.shapes[0].colors, [[255, 0, 0], [0, 128, 0], [255; 3]]);
    let bytes = "v 0 0 0 255 0 20\nv 1 0 0 0 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
    assert_eq!(loaded(bytes.as_bytes()).0.shapes[0].colors, [[255, 0, 20], [0; 3], [0, 0, 1]]);
    let mixed = bytes.replace(" 0 0 1", "");
    assert_eq!(loaded(mixed.as_bytes()).0.shapes[0].colors, [[255, 0, 20], [0; 3], [255; 3]]);
    // A weight, the exponent of Fortran, and words that say nothing.
    let (mesh, report) = loaded(b"v 0 0 0 2\nv 1.5D1 0 0 1\nv 0 1 0 1 1\ns off\nfrobnicate 3\nf 1 2 3\n");
    assert_eq!((mesh.shapes[0].positions[1].x, report.count(NoteKind::UnknownWord)), (15.0, 1));
    assert!(mesh.shapes[0].colors.is_empty());
}

#[test]
fn concave_polygons_are_cut_where_a_fan_would_leave_them() {
    let (mesh, report) = loaded(b"v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 3 4 5 1 2\n");
    let shape = &mesh.shapes[0];
    let area: f64 = shape
        .triangles
        .iter()
        .map(|triangle| triangle.map(|index| shape.positions[index as usize]))
        .map(|[a, b, c]| (b - a).cross(c - a).z * 0.5)
        .sum();
    assert_eq!((shape.triangles.len(), area, report.is_empty()), (3, 10.0, true));
    let (_, report) = loaded(b"g bow\nv 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nf 1 2 3 4\n");
    assert_eq!(report.count(NoteKind::CrossedPolygon), 1);
}
