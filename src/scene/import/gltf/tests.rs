//! Small files made here, whole and broken.

use glam::{DMat3, DVec3, Vec3};
use serde_json::{Value, json};

use super::super::{Import, LoadOptions};
use super::read;
use crate::scene::error::SceneError;
use crate::scene::mesh::{RawMesh, RawNormals};
use crate::scene::report::{NoteKind, Report};

/// A GLB of JSON and the bytes of buffer 0.
fn glb(json: &Value, binary: &[u8]) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, content) in [(b"JSON", json.as_slice()), (b"BIN\0", binary)] {
        bytes.extend((content.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(content);
    }
    bytes
}

fn read_bytes(bytes: &[u8]) -> (Result<RawMesh, SceneError>, Report) {
    let options = LoadOptions::default();
    let (report, side_files) = (Report::default(), Vec::new());
    let mut import = Import { file: "a.glb", options: &options, report, folder: None, side_files };
    let mesh = read(&mut import, bytes);
    (mesh, import.report)
}

/// What a file gives that must load.
fn loaded(json: &Value, binary: &[u8]) -> (RawMesh, Report) {
    let (mesh, report) = read_bytes(&glb(json, binary));
    (mesh.unwrap_or_else(|error| panic!("{error}")), report)
}

/// What is said of a file that must not load.
fn refusal(json: &Value, binary: &[u8]) -> String {
    read_bytes(&glb(json, binary)).0.expect_err("broken").to_string()
}

/// A square of two triangles: four positions of 12 bytes, then six indices of two bytes.
fn square() -> (Value, Vec<u8>) {
    let json = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "plate", "mesh": 0}],
        "meshes": [{"name": "square", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 60}],
    });
    let corners: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let mut binary: Vec<u8> = corners.iter().flat_map(|value| value.to_le_bytes()).collect();
    binary.extend([0_u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    (json, binary)
}

/// Puts a value at the end of a list.
fn push(list: &mut Value, value: Value) {
    list.as_array_mut().expect("a list").push(value);
}

#[test]
fn a_mesh_is_read_once_and_placed_by_every_node_that_has_it() {
    let (mut json, binary) = square();
    json["nodes"] = json!([
        {"name": "root", "children": [1, 2], "translation": [10, 0, 0]},
        {"name": "plate", "mesh": 0},
        {"mesh": 0, "children": [3], "scale": [-2, 1, 1]},
        {"mesh": 1},
    ]);
    let copy = json["meshes"][0].clone();
    push(&mut json["meshes"], copy);
    json["meshes"][1]["name"] = json!("");
    json["meshes"][1]["primitives"][0]["material"] = json!(0);
    json["materials"] = json!([{"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}]);
    let (mesh, report) = loaded(&json, &binary);
    assert!(report.is_empty(), "{report}");
    assert_eq!(mesh.shapes.len(), 1, "the second mesh has the same vertices");
    assert_eq!(mesh.shapes[0].triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.shapes[0].positions[2], DVec3::new(1.0, 1.0, 0.0));
    let names: Vec<(&str, &str)> = mesh.parts.iter().map(|part| (part.name.as_str(), part.path.as_str())).collect();
    assert_eq!(
        names,
        [("plate", "root/plate"), ("square", "root/square"), ("node 3", "root/square/node 3")],
        "own name, mesh's name, number"
    );
    let ends: Vec<DVec3> = mesh.parts.iter().map(|part| part.file_from_shape.transform_point3(DVec3::X)).collect();
    assert_eq!(ends, [DVec3::X * 11.0, DVec3::X * 8.0, DVec3::X * 8.0]);
    assert!(mesh.parts[1].file_from_shape.matrix3.determinant() < 0.0, "mirrored");
    assert_eq!(mesh.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [None, None, Some(0)]);
    assert_eq!(mesh.materials[0].base_color, Vec3::X);
}

#[test]
fn a_matrix_stands_column_by_column_and_rotations_are_normalised() {
    let (mut json, binary) = square();
    let quarter = json!([0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 5, 6, 7, 1]);
    json["nodes"] = json!([
        {"matrix": quarter, "children": [1]},
        {"mesh": 0, "rotation": [0, 0, 2, 2]},
    ]);
    let (mesh, _) = loaded(&json, &binary);
    let place = mesh.parts[0].file_from_shape;
    assert_eq!(place.translation, DVec3::new(5.0, 6.0, 7.0));
    // The quarter turn takes x to y, and the columns of the matrix are 0, x, y.
    let expected = DMat3::from_cols(DVec3::X, DVec3::ZERO, DVec3::Y);
    assert!((place.matrix3 - expected).to_cols_array().iter().all(|d| d.abs() < 1e-12), "{place}");
}

#[test]
fn primitives_of_shared_vertices_get_their_own() {
    let (mut json, binary) = square();
    json["accessors"][1]["count"] = json!(3);
    push(
        &mut json["accessors"],
        json!({"bufferView": 1, "byteOffset": 6, "componentType": 5123, "count": 3, "type": "SCALAR"}),
    );
    push(&mut json["meshes"][0]["primitives"], json!({"attributes": {"POSITION": 0}, "indices": 2}));
    let (mesh, _) = loaded(&json, &binary);
    assert_eq!(mesh.shapes.iter().map(|shape| shape.positions.len()).collect::<Vec<_>>(), [3, 3]);
    assert_eq!(mesh.shapes[1].triangles, [[0, 1, 2]]);
    assert!(mesh.parts.iter().all(|part| part.name == "plate"));
}

#[test]
fn quantised_positions_normals_and_colors_are_read() {
    let (mut json, mut binary) = square();
    json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": 0, "NORMAL": 1, "COLOR_0": 2}});
    binary.clear();
    for corner in [[0_i16, 0, 0], [32_767, 0, 0], [0, -32_768, 0]] {
        binary.extend(corner.iter().flat_map(|value| value.to_le_bytes()));
        binary.extend([0, 0]);
    }
    binary.extend([0, 0, 127, 0, 127, 0, 0, 0, 0x81, 0, 0, 0]);
    binary.extend([255, 0, 0, 255, 0, 55, 0, 255, 0, 0, 255, 0]);
    json["bufferViews"] = json!([
        {"buffer": 0, "byteLength": 24, "byteStride": 8},
        {"buffer": 0, "byteOffset": 24, "byteLength": 12, "byteStride": 4},
        {"buffer": 0, "byteOffset": 36, "byteLength": 12, "byteStride": 4},
    ]);
    json["accessors"] = json!([
        {"bufferView": 0, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5120, "normalized": true, "count": 3, "type": "VEC3"},
        {"bufferView": 2, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC4"},
    ]);
    let (mesh, report) = loaded(&json, &binary);
    assert!(report.is_empty(), "{report}");
    let shape = &mesh.shapes[0];
    assert_eq!(shape.positions, [DVec3::ZERO, DVec3::X, DVec3::NEG_Y], "-32768 is -1, too");
    let RawNormals::PerVertex(normals) = &shape.normals else { panic!("no normals") };
    assert_eq!(normals, &[Vec3::Z, Vec3::X, Vec3::NEG_X]);
    assert_eq!(shape.colors, [[255, 0, 0], [0, 128, 0], [0, 0, 255]]);
}

#[test]
fn sparse_elements_replace_others() {
    let (mut json, mut binary) = square();
    binary.extend([3, 0, 0, 0]);
    binary.extend([7.0_f32, 8.0, 9.0].iter().flat_map(|value| value.to_le_bytes()));
    push(&mut json["bufferViews"], json!({"buffer": 0, "byteOffset": 60, "byteLength": 1}));
    push(&mut json["bufferViews"], json!({"buffer": 0, "byteOffset": 64, "byteLength": 12}));
    json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 3}
    });
    let (mesh, _) = loaded(&json, &binary);
    assert_eq!(mesh.shapes[0].positions[2..], [DVec3::new(1.0, 1.0, 0.0), DVec3::new(7.0, 8.0, 9.0)]);
    // Without a view all other elements are zero.
    json["accessors"][0].as_object_mut().expect("object").remove("bufferView");
    let (mesh, _) = loaded(&json, &binary);
    assert_eq!(mesh.shapes[0].positions[2..], [DVec3::ZERO, DVec3::new(7.0, 8.0, 9.0)]);
    json["accessors"][0]["sparse"]["count"] = json!(2);
    assert!(refusal(&json, &binary).starts_with("a.glb: accessors[0].sparse.indices needs 2 bytes of bufferViews[2]"));
}

#[test]
fn triangles_without_three_finite_vertices_are_left_out() {
    let (json, whole) = square();
    let mut binary = whole.clone();
    binary[58] = 9;
    let (mesh, report) = loaded(&json, &binary);
    assert_eq!((mesh.shapes[0].triangles.len(), mesh.shapes[0].positions.len()), (1, 3));
    assert_eq!(report.to_string(), "1 face left out: a vertex that the file does not have (meshes[0].primitives[0])\n");
    let mut binary = whole.clone();
    binary[12..16].copy_from_slice(&f32::NAN.to_le_bytes());
    let (mesh, report) = loaded(&json, &binary);
    assert_eq!(report.count(NoteKind::FaceNowhere), 1);
    assert_eq!(mesh.shapes[0].positions, [DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]);
    binary[..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_eq!(
        refusal(&json, &binary),
        "a.glb: none of its 2 triangles has three vertices that exist and are finite; export the file again"
    );
}

#[test]
fn normals_and_colors_that_do_not_fit_are_left_out() {
    let (mut json, binary) = square();
    push(&mut json["accessors"], json!({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}));
    json["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 0, "NORMAL": 2, "COLOR_0": 9});
    let (mesh, report) = loaded(&json, &binary);
    assert!(matches!(mesh.shapes[0].normals, RawNormals::None) && mesh.shapes[0].colors.is_empty());
    assert_eq!(report.count(NoteKind::AttributeLeftOut), 2);
}

#[test]
fn points_and_lines_are_no_triangles() {
    let (mut json, binary) = square();
    json["meshes"][0]["primitives"][0]["mode"] = json!(1);
    let (mesh, report) = loaded(&json, &binary);
    assert!(mesh.parts.is_empty() && report.count(NoteKind::NotTriangles) == 1);
}

#[test]
fn nothing_is_read_past_a_view_or_buffer() {
    let (whole, binary) = square();
    let mut seen = Vec::new();
    for (pointer, value) in [
        ("/accessors/0/count", json!(4_000_000_000_u32)),
        ("/accessors/0/count", json!(u64::MAX)),
        ("/accessors/0/byteOffset", json!(u64::MAX)),
        ("/accessors/0/byteOffset", json!(4)),
        ("/bufferViews/0/byteStride", json!(u64::MAX)),
        ("/bufferViews/0/byteOffset", json!(u64::MAX)),
        ("/bufferViews/0/byteLength", json!(u64::MAX)),
        ("/bufferViews/0/buffer", json!(1)),
        ("/accessors/0/bufferView", json!(7)),
        ("/meshes/0/primitives/0/indices", json!(7)),
        ("/accessors/0/componentType", json!(5124)),
        ("/accessors/0/type", json!("MAT4")),
        ("/accessors/1/componentType", json!(5126)),
        ("/accessors/0/count", json!("many")),
        ("/meshes/0/primitives", json!({})),
    ] {
        let mut json = whole.clone();
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        json.pointer_mut(parent).expect("it exists")[key] = value;
        let message = refusal(&json, &binary);
        assert!(message.starts_with("a.glb: ") && message.contains("; "), "{pointer}: {message}");
        seen.push(message);
    }
    assert_eq!(
        seen[0],
        "a.glb: accessors[0] needs 48000000000 bytes of bufferViews[0], which has 48; export the file again, or get it again"
    );
    assert!(
        seen[5].contains("bufferViews[0] ends at byte 18446744073709551663 of buffer 0, which has 60"),
        "{}",
        seen[5]
    );
}

#[test]
fn elements_without_bytes_are_not_without_end() {
    let (mut json, binary) = square();
    json["accessors"][0] = json!({"componentType": 5126, "count": 3_000_000_000_u32, "type": "VEC3"});
    json["meshes"][0]["primitives"][0].as_object_mut().expect("object").remove("indices");
    assert!(
        refusal(&json, &binary).starts_with("a.glb: its meshes announce more vertices than the buffers can hold; ")
    );
    json["meshes"][0]["primitives"][0]["extensions"] = json!({"KHR_draco_mesh_compression": {}});
    assert_eq!(
        refusal(&json, &binary),
        "a.glb: needs the extension KHR_draco_mesh_compression, which is not read; export without compression"
    );
}

#[test]
fn a_node_below_itself_is_named() {
    let (mut json, binary) = square();
    json["nodes"] = json!([{"name": "a", "children": [1]}, {"name": "b", "children": [2]}, {"children": [1]}]);
    let ring = "the node \"b\" is below itself (\"b\" > \"node 2\" > \"b\"); take it out of the last one's children";
    assert_eq!(refusal(&json, &binary), format!("a.glb: {ring}"));
    // Without a scene the ring has no root to begin at.
    json["nodes"] = json!([{"children": [1]}, {"children": [0]}]);
    json["scenes"] = json!([]);
    assert!(refusal(&json, &binary).contains("the node \"node 0\" is below itself"));
}

#[test]
fn trees_may_be_deep_but_not_bushes_of_copies() {
    let (mut json, binary) = square();
    let chain: Vec<Value> = (1..=20_000).map(|child| json!({"children": [child]})).collect();
    json["nodes"] = json!(chain);
    push(&mut json["nodes"], json!({"mesh": 0, "name": "end"}));
    let (mesh, _) = loaded(&json, &binary);
    assert_eq!(mesh.parts.len(), 1);
    assert!(mesh.parts[0].path.starts_with("...") && mesh.parts[0].path.ends_with("/node 19999/end"));
    // Each node is below the one before it twice: 2^40 copies if all were drawn.
    let doubled: Vec<Value> = (1..=40).map(|child| json!({"children": [child, child]})).collect();
    json["nodes"] = json!(doubled);
    push(&mut json["nodes"], json!({"mesh": 0}));
    let (mesh, report) = loaded(&json, &binary);
    assert_eq!((mesh.parts.len(), report.count(NoteKind::NodeTwice)), (1, 40));
}

#[test]
fn nodes_without_a_place_are_left_out_with_what_is_below() {
    let (mut json, binary) = square();
    json["scenes"] = json!([{"nodes": [0, 1, 2, 3, 9]}]);
    json["nodes"] = json!([
        {"mesh": 0, "matrix": [1e308, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "children": [4]},
        {"mesh": 0, "translation": [0, null, 0]},
        {"mesh": 0, "rotation": [0, 0, 0, 0], "scale": [0, 0, 0]},
        {"mesh": 77},
        {"mesh": 0},
    ]);
    let (mesh, report) = loaded(&json, &binary);
    assert_eq!(mesh.parts.len(), 1);
    assert!(mesh.parts[0].file_from_shape.is_finite());
    assert_eq!(report.count(NoteKind::NodeLeftOut), 2);
    assert_eq!(report.count(NoteKind::RotationMended), 1);
    assert_eq!(report.count(NoteKind::ReferenceToNowhere), 2, "{report}");
}

#[test]
fn buffers_may_be_data_uris_but_nothing_far_away() {
    let (mut json, binary) = square();
    // All zeros, but the indices are what a square has.
    let zeros = "A".repeat(64);
    json["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{zeros}AAABAAIAAAACAAMA"));
    let (mesh, _) = loaded(&json, &binary);
    assert_eq!(mesh.shapes[0].triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.shapes[0].positions, [DVec3::ZERO; 4]);
    json["buffers"][0]["uri"] = json!("data:;base64,AAA*");
    assert_eq!(
        refusal(&json, &binary),
        "a.glb: buffer 0: character 4 of its base64 data is \"*\"; export the file again"
    );
    json["buffers"][0]["uri"] = json!("my%20data.bin");
    assert!(refusal(&json, &binary).starts_with("a.glb: the file \"my data.bin\" of buffer 0 "));
}

#[test]
fn broken_envelopes_are_named_by_their_byte() {
    let (json, binary) = square();
    let whole = glb(&json, &binary);
    let json_length = u32::from_le_bytes(whole[12..16].try_into().expect("four")) as usize;
    let said = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = whole.clone();
        change(&mut bytes);
        read_bytes(&bytes).0.expect_err("broken").to_string()
    };
    assert_eq!(
        said(&|bytes| bytes[3] = b'X'),
        "a.glb: byte 0: the file begins with \"glTX\" instead of \"glTF\" or \"{\"; was it downloaded completely?"
    );
    assert!(said(&|bytes| bytes.truncate(10)).starts_with("a.glb: byte 10: the header is cut short; "));
    assert!(said(&|bytes| bytes[4] = 1).contains("is glTF 1.0, and only 2.0 is read; "));
    assert!(said(&|bytes| bytes[4] = 9).starts_with("a.glb: byte 4: the container has version 9"));
    assert!(said(&|bytes| bytes[17] = b'?').starts_with("a.glb: byte 16: the first chunk is \"J?ON\""));
    assert!(said(&|bytes| bytes[14] = 1).starts_with("a.glb: byte 12: the chunk \"JSON\" announces "));
    let binary_at = json_length + 20;
    let cut = said(&|bytes| bytes.truncate(binary_at + 20));
    assert!(cut.starts_with(&format!("a.glb: byte {binary_at}: the chunk \"BIN\" announces 60 bytes, but 12 follow")));
    assert!(said(&|bytes| bytes.truncate(binary_at)).contains("buffer 0 has no data"));
    assert!(said(&|bytes| bytes[21] = b'!').starts_with("a.glb: byte 21: in the JSON: "));
    let mut longer = whole.clone();
    longer[8] = 0;
    assert_eq!(read_bytes(&longer).1.count(NoteKind::LengthMended), 1);
}

#[test]
fn broken_json_is_named_by_line_and_column() {
    let said = |text: &str| read_bytes(text.as_bytes()).0.expect_err("broken").to_string();
    assert_eq!(said("{\n  \"asset\": {,\n"), "a.glb:2: column 13: key must be a string; export the file again");
    assert!(said("{\"asset\": {\"version\": \"2.0\"").starts_with("a.glb:1: column 27: EOF while parsing an object; "));
    assert!(
        said("{\"asset\": {\"version\": \"1.0\"}}")
            .ends_with(": is glTF 1.0, and only 2.0 is read; convert it to glTF 2.0")
    );
    assert!(said("{\"meshes\": {\"a\": {\"primitives\": []}}}").contains("is glTF 1.0"));
    assert!(said("{\"a\": 1}").contains("is JSON, but no glTF"));
    assert!(said("{\"asset\": {\"version\": \"3.0\"}}").contains("is glTF of version \"3.0\""));
}

#[test]
fn what_is_not_drawn_is_noted() {
    let (mut json, binary) = square();
    json["textures"] = json!([{}, {}]);
    json["animations"] = json!([{}]);
    json["skins"] = json!([{}]);
    json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 0}]);
    push(&mut json["scenes"], json!({}));
    let (_, report) = loaded(&json, &binary);
    let count = |kind| report.count(kind);
    assert_eq!(
        [NoteKind::TextureNotDrawn, NoteKind::NotAnimated, NoteKind::SceneSkipped].map(count),
        [2, 3, 1],
        "{report}"
    );
}
