use crate::scene::import::sniff::{Format, sniff};
use crate::scene::mesh::RawNormals;
use crate::scene::{LoadOptions, Report};

use super::*;

fn read_ply(bytes: &[u8]) -> (Result<RawMesh, SceneError>, Report) {
    assert_eq!(sniff("a", bytes), Format::Ply);
    let options = LoadOptions::default();
    let mut import =
        Import { file: "a.ply", options: &options, report: Report::default(), folder: None, side_files: Vec::new() };
    (read(&mut import, bytes), import.report)
}

fn loaded(bytes: &[u8]) -> (RawMesh, Report) {
    let (mesh, report) = read_ply(bytes);
    (mesh.unwrap_or_else(|error| panic!("{error}")), report)
}

fn message(bytes: &[u8]) -> String {
    read_ply(bytes).0.expect_err("refused").to_string()
}

/// A square of four vertices, whose `face` lines are given.
fn square(num_faces: u32, faces: &str) -> String {
    format!(
        "ply\nformat ascii 1.0\ncomment\nelement vertex 4\nproperty double x\nproperty int quality\nproperty float32 z\n\
         property short y\nelement face {num_faces}\nproperty list uchar int vertex_indices\nend_header\n\
         0 7 0.5 0\n1 7 0.5 0\n1 7 0.5 1\n0 7 0.5 1\n{faces}"
    )
}

#[test]
fn text_is_read_with_any_order_of_properties_and_any_line_ends() {
    let text = square(2, "4 0 1 2 3\n3 0 1 2\n");
    for text in [text.clone(), text.replace('\n', "\r\n"), text.replace('\n', "\r"), text.replace("indices", "index")] {
        let (mesh, report) = loaded(text.as_bytes());
        assert!(report.is_empty(), "{report}");
        let shape = &mesh.shapes[0];
        assert_eq!(shape.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
        assert_eq!(shape.positions[2].to_array(), [1.0, 1.0, 0.5]);
    }
}

/// A binary file of one triangle with normals, colours, a list at each vertex and an element between.
fn binary(is_little: bool) -> Vec<u8> {
    let kind = if is_little { "little" } else { "big" };
    let mut bytes = format!(
        "ply\r\nformat binary_{kind}_endian 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty list ushort double extra\r\n\
         property double y\r\nproperty int8 z\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\n\
         property ushort red\r\nproperty float green\r\nproperty uchar blue\r\nelement edge 2\r\nproperty int vertex1\r\n\
         element face 1\r\nproperty float area\r\nproperty list uint uint16 vertex_indices\r\nend_header\r\n"
    )
    .into_bytes();
    macro_rules! put {
        ($($value:expr),*) => {
            $(if is_little { bytes.extend($value.to_le_bytes()) } else { bytes.extend($value.to_be_bytes()) })*
        };
    }
    for i in 0..3_u8 {
        put!(f32::from(i), 2_u16, 0.0_f64, 1.0_f64, f64::from(i * i), i as i8 - 1, 0.0_f32, 0.0_f32, f32::from(i));
        put!(u16::MAX, 0.5_f32, i);
    }
    put!(0_i32, 1_i32, 8.5_f32, 3_u32, 2_u16, 1_u16, 0_u16);
    bytes
}

#[test]
fn bytes_are_read_in_either_order() {
    for is_little in [true, false] {
        let (mesh, report) = loaded(&binary(is_little));
        assert!(report.is_empty(), "{report}");
        let shape = &mesh.shapes[0];
        assert_eq!(shape.triangles, [[2, 1, 0]]);
        assert_eq!(shape.positions[2].to_array(), [2.0, 4.0, 1.0]);
        assert_eq!(shape.colors, [[255, 128, 0], [255, 128, 1], [255, 128, 2]]);
        assert!(matches!(&shape.normals, RawNormals::PerVertex(normals) if normals[2] == Vec3::Z * 2.0));
    }
}

#[test]
fn colours_of_faces_split_their_vertices_and_strips_are_triangles() {
    let text = square(2, "3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n")
        .replace("vertex_indices\n", "vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n");
    let shape = &loaded(text.as_bytes()).0.shapes[0];
    assert_eq!((shape.positions.len(), shape.colors[shape.triangles[1][0] as usize]), (6, [0, 0, 255]));
    let text = square(1, "8 0 1 3 2 -1 0 1 2\n").replace("face", "tristrips");
    assert_eq!(loaded(text.as_bytes()).0.shapes[0].triangles, [[0, 1, 3], [3, 1, 2], [0, 1, 2]]);
}

#[test]
fn counts_are_held_against_the_bytes() {
    let text = square(1, "3 0 1 2\n");
    let many = message(text.replace("vertex 4", "vertex 4294967295").as_bytes());
    assert!(many.starts_with("a.ply:4: 4294967295 vertices are announced, and there is room for"), "{many}");
    let (mesh, report) = loaded(text.replace("face 1", "face 18446744073709551615").as_bytes());
    assert_eq!((mesh.shapes[0].triangles.len(), report.count(NoteKind::MeshCut)), (1, 1));
    assert!(message(text.replace("face 1", "face -5").as_bytes()).starts_with("a.ply:9: \"-5\" is no number of"));
    let bytes = binary(true);
    let cut = message(&bytes[..bytes.len() - 1]);
    let at = bytes.len() - 14;
    assert!(
        cut.starts_with(&format!("a.ply: byte {at}: the file ends in number 1 of 1 \"face\" elements, or")),
        "{cut}"
    );
    let long = message(square(1, "255 0 1 2\n").as_bytes());
    assert!(long.starts_with("a.ply:16: the file ends in number 1 of 1 \"face\" elements, or"), "{long}");
    // Nothing to read, however often.
    let nothing = text.replace("element vertex", "element nothing 18446744073709551615\nelement vertex");
    assert_eq!(loaded(nothing.as_bytes()).0.shapes[0].triangles.len(), 1);
}

#[test]
fn faces_that_cannot_be_are_left_out() {
    let (mesh, report) = loaded(square(7, "3 0 1 7\n3 -1 0 1\n2 0 1\n0\n3 0 1 2\n3 0 x 1\n3 0 1.5 2\n").as_bytes());
    assert_eq!(mesh.shapes[0].triangles.len(), 1);
    assert_eq!([NoteKind::FaceOutOfRange, NoteKind::ShortFace].map(|kind| report.count(kind)), [4, 2]);
    let (mesh, report) = loaded(square(2, "3 0 1 2\n3 1 2 3\n").replace("\n0 7 0.5 0", "\nnan 7 1e200 0").as_bytes());
    assert_eq!((mesh.shapes[0].triangles.len(), report.count(NoteKind::FaceNowhere)), (1, 1));
    assert!(mesh.shapes[0].positions.iter().all(|place| place.z == 0.5));
}

#[test]
fn what_is_wrong_is_said_with_its_line() {
    let text = square(1, "3 0 1 2\n");
    for (from, to, end) in [
        ("\nend_header", "\n", "a.ply:17: the header has no end_header; was the file saved or downloaded completely?"),
        (
            "double x",
            "float128 x",
            "a.ply:5: \"float128\" is no kind of number that PLY has; save as float, double or int",
        ),
        ("double x", "double w", "a.ply:4: vertices have no x, y and z; export the model again"),
        ("format ascii 1.0\n", "", "a.ply:10: the header has no format line; export the model again"),
        ("ascii", "utf8", "a.ply:2: \"utf8\" is no format of PLY; save the file as ascii"),
        ("0 7 0.5 0", "0 7 0,5 0", "a.ply:12: a number has a decimal comma; export the model with decimal points"),
        (
            "list uchar int",
            "list uchar",
            "a.ply:10: \"property list uchar vert...\" is no property; export the model again",
        ),
    ] {
        assert_eq!(message(text.replacen(from, to, 1).as_bytes()), end);
    }
    assert!(message(square(0, "").as_bytes()).starts_with("a.ply: holds no triangles; "));
    let wrong = binary(true).iter().map(|&byte| char::from(byte)).collect::<String>().replace("_little_", "_big_");
    let wrong: Vec<u8> = wrong.chars().map(|letter| letter as u8).collect();
    assert!(message(&wrong).starts_with("a.ply: byte "), "{}", message(&wrong));
}
