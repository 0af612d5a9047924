//! Real and damaged files of glTF and 3MF: what each row of the data folder's README promises.

use std::path::Path;

use restyle::scene::{Assembly, LoadOptions, NoteKind, Scene};

use super::outcome::{MENDED, Outcome, num_dropped, num_triangles};
use super::scene_data::data;

/// A good file: placed triangles, those of different shapes, parts, shapes, and parts that are mirrored.
const MESHES: &[(&str, u64, u64, usize, usize, usize)] = &[
    // 67 nodes; some of their meshes have several primitives.
    ("2CylinderEngine.glb", 121_496, 75_730, 115, 34, 0),
    ("CesiumMilkTruck.glb", 3624, 2856, 5, 4, 0),
    ("FlightHelmet/FlightHelmet.gltf", 94_722, 94_722, 6, 6, 0),
    ("Mesh_PrimitiveMode/Mesh_PrimitiveMode_04.gltf", 2, 2, 1, 1, 0),
    ("Mesh_PrimitiveMode/Mesh_PrimitiveMode_05.gltf", 2, 2, 1, 1, 0),
    ("Mesh_PrimitiveMode/Mesh_PrimitiveMode_06.gltf", 2, 2, 1, 1, 0),
    ("Mesh_PrimitiveMode/Mesh_PrimitiveMode_12.gltf", 2, 2, 1, 1, 0),
    ("OrientationTest.glb", 524, 524, 13, 13, 0),
    ("SimpleSparseAccessor.gltf", 12, 12, 1, 1, 0),
    ("VertexColorTest.glb", 36, 36, 2, 2, 0),
    ("anymal_c.glb", 58_318, 38_149, 50, 24, 0),
    // Three meshes of 14 primitives have the same vertices as three others, and are read once.
    ("cakeBirthday.glb", 1332, 444, 42, 14, 0),
    ("cube_gears_prod_req.3mf", 25_692, 25_692, 17, 17, 0),
    ("cycloidal.glb", 376_520, 61_442, 72, 13, 0),
    ("featuretype.3MF", 2208, 2208, 1, 1, 0),
    ("nested.glb", 36, 36, 3, 3, 0),
    ("robotiq_2f85.glb", 71_330, 63_706, 14, 8, 0),
    ("rod.glb", 57_036, 5412, 29, 3, 0),
    ("simple_pole.glb", 580, 580, 11, 11, 0),
];

#[rustfmt::skip]
fn bad_files() -> Vec<(&'static str, Outcome<u64>)> {
    use NoteKind as K;
    use Outcome::{Fails, Loads};
    vec![
        ("3mf_not_a_zip.3mf", Fails(": its zip archive has no table of contents; the file was cut short: get it again")),
        ("3mf_truncated.3mf", Fails(": its zip archive has no table of contents; the file was cut short: get it again")),
        ("BoxWithInfinites.glb", Fails(": none of its 12 triangles has three vertices that exist and are finite; export the file again")),
        ("CesiumMilkTruck_gltf1.glb", Fails(": is glTF 1.0, and only 2.0 is read; convert it to glTF 2.0")),
        ("IndexOutOfRange/IndexOutOfRange.gltf", Loads(11, &[K::FaceOutOfRange])),
        ("RecursiveNodes.gltf", Fails(": the node \"node 0\" is below itself (\"node 0\" > \"node 1\" > \"node 0\"); take it out of the last one's children")),
        ("assimp_badArray.gltf", Fails(": meshes[0].primitives is an object and must be a list; export the file again")),
        // The text that should be a number is about a texture.
        ("assimp_badNumber.gltf", Loads(12, &[K::TextureNotDrawn])),
        ("fuzz.glb", Loads(12, &[K::TextureNotDrawn])),
        ("glb_20000_deep_hierarchy.glb", Loads(48, &[])),
        ("glb_accessor_count_4e9.glb", Fails(": accessors[0] needs 48000000000 bytes of bufferViews[0], which has 288; export the file again, or get it again")),
        ("glb_bad_json.glb", Fails(": byte 2651: in the JSON: EOF while parsing an object; it was cut short: get it again")),
        ("glb_bufferview_offset_overflow.glb", Fails(": bufferViews[0] ends at byte 4294967578 of buffer 0, which has 2376; it was cut short: get it again")),
        ("glb_json_chunk_too_long.glb", Fails(": byte 12: the chunk \"JSON\" announces 10000000 bytes, but 4780 follow; the file was cut short: get it again")),
        ("glb_magic_wrong.glb", Fails(": byte 0: the file begins with \"glTX\" instead of \"glTF\" or \"{\"; was it downloaded completely?")),
        ("glb_matrix_1e308.glb", Loads(24, &[K::NodeLeftOut])),
        ("glb_mesh_index_out_of_range.glb", Loads(24, &[K::ReferenceToNowhere])),
        ("glb_no_bin.glb", Fails(": buffer 0 has no data: the file has no binary chunk for it; export the file again")),
        ("glb_node_cycle.glb", Fails(": the node \"block02\" is below itself (\"block02\" > \"block03\" > \"block02\"); take it out of the last one's children")),
        ("glb_requires_draco.glb", Fails(": needs the extension KHR_draco_mesh_compression, which is not read; export without compression")),
        ("glb_total_length_too_big.glb", Loads(36, &[K::LengthMended])),
        ("glb_truncated_bin.glb", Fails(": byte 2416: the chunk \"BIN\" announces 2376 bytes, but 1676 follow; the file was cut short: get it again")),
        ("glb_version_9.glb", Fails(": byte 4: the container has version 9, and only 2 is known; export it as glTF 2.0")),
        ("glb_zero_scale_zero_quat.glb", Loads(24, &[K::RotationMended, K::PartUnplaceable])),
        ("gltf_bad_base64.gltf", Fails(": buffer 0: character 1 of its base64 data is \"!\"; export the file again")),
        ("gltf_missing_bin.gltf", Fails(": the file \"gone.bin\" of buffer 0 is not beside the scene's file; put it there, or export as .glb, which holds everything")),
        ("gltf_remote_uri.gltf", Fails(": the file \"http://127.0.0.1:9/x.bin\" of buffer 0 is a network address, which is not followed; export as .glb, which holds everything")),
        ("missing_bin/BoxTextured.gltf", Fails(": the file \"BoxTextured0.bin\" of buffer 0 is not beside the scene's file; put it there, or export as .glb, which holds everything")),
    ]
}

fn load(path: &Path) -> Scene {
    Scene::load(path).unwrap_or_else(|error| panic!("{error}"))
}

fn num_unique(assembly: &Assembly) -> u64 {
    assembly.shapes.iter().map(|shape| shape.triangles.len() as u64).sum()
}

/// Whether a file is one of those that these tests are about.
pub(super) fn is_ours(name: &str) -> bool {
    let name = name.to_lowercase();
    [".gltf", ".glb", ".3mf"].iter().any(|end| name.ends_with(end)) && !name.starts_with("lfs_")
}

/// Every file of a folder that is ours must be in a table.
fn assert_complete(folder: &Path, table: &[&str]) {
    for entry in std::fs::read_dir(folder).expect("readable") {
        let name = entry.expect("readable").file_name().to_string_lossy().into_owned();
        assert!(!is_ours(&name) || table.contains(&name.as_str()), "{name} is not in the table");
    }
}

#[test]
fn every_real_mesh_has_the_triangles_and_parts_of_its_row() {
    let Some(folder) = data("meshes") else { return };
    assert_complete(&folder, &MESHES.iter().map(|row| row.0).collect::<Vec<_>>());
    for &(file, num_placed, num_different, num_parts, num_shapes, num_mirrored) in MESHES {
        let scene = load(&folder.join(file));
        let (assembly, dropped) = (&scene.assembly, num_dropped(&scene.files[0].report));
        assert_eq!(num_unique(assembly) + dropped, num_different, "{file}");
        if dropped == 0 {
            assert_eq!(assembly.num_triangles(), num_placed, "{file}");
        }
        assert_eq!((assembly.parts.len(), assembly.shapes.len()), (num_parts, num_shapes), "{file}");
        let is_mirrored = |determinant: f32| determinant < 0.0;
        let mirrored = assembly.parts.iter().filter(|part| is_mirrored(part.world_from_shape.matrix3.determinant()));
        assert_eq!(mirrored.count(), num_mirrored, "{file}");
        assert!(assembly.sphere.radius > 0.0 && assembly.sphere.radius.is_finite(), "{file}");
    }
}

#[test]
fn every_damaged_mesh_is_mended_or_refused_as_promised() {
    let Some(folder) = data("bad") else { return };
    let table = bad_files();
    assert_complete(&folder, &table.iter().map(|row| row.0).collect::<Vec<_>>());
    for (file, outcome) in table {
        let path = folder.join(file);
        outcome.check(&path, num_triangles, |kind| !MENDED.contains(&kind));
    }
}

#[test]
fn lines_alone_are_no_mesh() {
    let Some(folder) = data("meshes/Mesh_PrimitiveMode") else { return };
    let error = Scene::load(&folder.join("Mesh_PrimitiveMode_02.gltf")).expect_err("points").to_string();
    assert!(error.ends_with(": holds no triangles; export the model's surfaces, or as a mesh"), "{error}");
}

#[test]
fn parts_have_the_names_and_paths_of_their_nodes() {
    let Some(folder) = data("meshes") else { return };
    let names = |file: &str| -> Vec<(String, String)> {
        let Assembly { parts, names, .. } = load(&folder.join(file)).assembly;
        let text = |index: u32| names[index as usize].clone();
        parts.iter().map(|part| (text(part.name), text(part.path))).collect()
    };
    let pairs = |rows: &[(&str, &str)]| -> Vec<(String, String)> {
        rows.iter().map(|(name, path)| ((*name).to_owned(), (*path).to_owned())).collect()
    };
    assert_eq!(
        names("nested.glb"),
        pairs(&[("block01", "block01"), ("block02", "block01/block02"), ("block03", "block01/block02/block03")])
    );
    let engine = names("2CylinderEngine.glb");
    assert!(engine.iter().all(|(name, path)| path == name || path.ends_with(&format!("/{name}"))));
    assert!(
        engine.iter().any(|(name, _)| name == "Piston_123-844_0_Parts_1"),
        "the mesh's name, of a node without one"
    );
    assert_eq!(names("cube_gears_prod_req.3mf")[6], ("cube 7".to_owned(), "cube 7".to_owned()));
    assert_eq!(names("featuretype.3MF"), pairs(&[("Cut-Extrude6", "Cut-Extrude6")]));
}

#[test]
fn colors_materials_and_units_are_read() {
    let Some(folder) = data("meshes") else { return };
    let colored = load(&folder.join("VertexColorTest.glb")).assembly;
    let has_colors: Vec<bool> = colored.shapes.iter().map(|shape| !shape.colors.is_empty()).collect();
    assert_eq!(has_colors, [false, true]);
    let part = load(&folder.join("featuretype.3MF"));
    assert_eq!(part.assembly.materials[0].opacity, 1.0, "an alpha of 0 is a habit, not glass");
    assert_eq!(part.files[0].report.count(NoteKind::UnitConverted), 1);
    // 2.5 inches deep.
    let size = part.assembly.sphere.radius;
    assert!((60.0..80.0).contains(&size), "{size} mm");
    let truck = load(&folder.join("CesiumMilkTruck.glb"));
    assert_eq!(truck.files[0].report.count(NoteKind::TextureNotDrawn), 2);
    assert_eq!(truck.files[0].report.count(NoteKind::NotAnimated), 1);
    let helmet = load(&folder.join("FlightHelmet/FlightHelmet.gltf"));
    assert_eq!(helmet.files[0].side_files.len(), 1, "the buffer");
}

/// Cut anywhere, a real file is refused in words or loads in part.
#[test]
fn files_that_are_cut_short_say_so() {
    let Some(folder) = data("meshes") else { return };
    for file in ["nested.glb", "featuretype.3MF", "SimpleSparseAccessor.gltf"] {
        let bytes = std::fs::read(folder.join(file)).expect("readable");
        for length in (1..bytes.len()).step_by(bytes.len() / 97 + 1) {
            match Scene::from_bytes_with(file, &bytes[..length], &LoadOptions::default()) {
                Err(error) => {
                    let message = error.to_string();
                    assert!(message.starts_with(&format!("{file}:")) && message.is_ascii(), "{message}");
                }
                Ok(_) => panic!("{length} bytes of {file} load"),
            }
        }
    }
}
