//! Real and damaged meshes in OBJ, STL, PLY and OFF: what each row of the data folder's README promises.
//!
//! The folder lies beside the project. Without it the tests print what they skip; with `RESTYLE_DATA=required` they fail.

use restyle::scene::{NoteKind, Scene, SceneError};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::outcome::{Outcome, num_triangles};

/// A folder of the test data, or `None` if there is none and none is required.
fn data(folder: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    let required = std::env::var("RESTYLE_DATA").is_ok_and(|value| value == "required");
    assert!(!required, "{}: no such folder, and RESTYLE_DATA=required", path.display());
    println!("skipped 1 test: there is no {}", path.display());
    None
}

/// A good file: name, triangles, parts, different names of parts, materials. Polygons count two less than their corners.
const MESHES: &[(&str, u64, usize, usize, usize)] = &[
    ("1002_tray_bottom.STL", 4520, 1, 1, 0),
    ("angle_block.STL", 704, 1, 1, 0),
    ("counter.unitsmm.STL", 83_750, 1, 1, 0),
    ("featuretype.STL", 3476, 1, 1, 0),
    ("multibody.stl", 32, 2, 2, 0),
    ("Spider_binary.stl", 1368, 1, 1, 0),
    ("stl_ascii.stl", 572, 1, 1, 0),
    ("torus.STL", 8700, 1, 1, 0),
    ("unit_sphere.STL", 1280, 1, 1, 0),
    ("chair_model.obj", 12_756, 5, 4, 3),
    ("concave_polygon/concave_polygon.obj", 66 - 2, 1, 1, 1),
    ("cube_with_materials/cube_with_materials.obj", 12, 5, 1, 5),
    // The last group goes on in an object.
    ("groups.obj", 2308, 15, 14, 0),
    ("hundred_cubes/hundred_cubes.obj", 1200, 100, 100, 3),
    ("panda/panda.obj", 134_888, 58, 58, 5),
    ("quadknot.obj", 2880, 1, 1, 1),
    ("rabbit/rabbit.obj", 678 + 502 + 72, 9, 9, 1),
    ("spider/spider.obj", 1368, 19, 19, 4),
    ("spot.obj", 5856, 1, 1, 0),
    ("stanford/dragon_100k.obj", 100_000, 1, 1, 0),
    ("stanford/stanford-bunny.obj", 69_451, 1, 1, 0),
    ("teapot.obj", 6320, 1, 1, 0),
    ("WusonOBJ.obj", 3732, 1, 1, 0),
    ("1crn.ply", 56_350, 1, 1, 0),
    ("cube.ply", 12, 1, 1, 0),
    ("cycloidal.ply", 43_368, 1, 1, 0),
    ("featuretype.ply", 3476, 1, 1, 0),
    ("terrain_n53e027.ply", 2_880_000, 1, 1, 0),
    ("Wuson.ply", 3732, 1, 1, 0),
    ("rectangle_face_colors_int.off", 2, 1, 1, 0),
    ("Wuson.off", 3732, 1, 1, 0),
];

#[rustfmt::skip]
fn bad_files() -> Vec<(&'static str, Outcome<u64>)> {
    use NoteKind as K;
    use Outcome::{Fails, Loads};
    const WHOLE: &[K] = &[];
    vec![
        ("assimp_crash_30d6d0.ply", Fails(":7: the header has no end_header; was the file saved or downloaded completely?")),
        ("assimp_invalid.off", Fails(":6: none of 4 faces can be drawn: this one has fewer than three vertices; export the model again")),
        ("assimp_malformed.obj", Loads(8, &[K::FaceOutOfRange, K::UnknownMaterial])),
        ("box_UTF16BE.obj", Loads(12, &[K::UnknownMaterial])),
        ("busted.STL", Loads(3878, WHOLE)),
        ("lfs_pointer.off", Fails(": is a Git LFS pointer instead of the file itself, no molecule and no mesh; fetch it with: git lfs pull")),
        ("mirror.ply", Loads(286, WHOLE)),
        ("nancolor.obj", Loads(12, &[K::NoColor])),
        ("obj_bom.obj", Loads(5856, WHOLE)),
        ("obj_cr_only.obj", Loads(5856, WHOLE)),
        ("obj_crlf.obj", Loads(5856, WHOLE)),
        ("obj_decimal_comma.obj", Fails(":1: \"0,348799\" has a decimal comma; export the model with decimal points")),
        ("obj_degenerate_faces.obj", Loads(5861, WHOLE)),
        ("obj_face_with_2_vertices.obj", Loads(5856, &[K::ShortFace])),
        ("obj_far_origin_utm.obj", Loads(5856, WHOLE)),
        ("obj_flat_line.obj", Fails(": holds only triangles without area; export the model again, in smaller units")),
        ("obj_huge_1e30.obj", Loads(5856, WHOLE)),
        ("obj_index_out_of_range.obj", Loads(5854, &[K::FaceOutOfRange])),
        ("obj_index_zero.obj", Loads(5854, &[K::FaceOutOfRange])),
        ("obj_latin1_names.obj", Loads(5856, &[K::UnknownMaterial])),
        ("obj_line_continuation.obj", Loads(5856, WHOLE)),
        ("obj_mirrored_winding.obj", Loads(5856, WHOLE)),
        ("obj_missing_mtl.obj", Loads(5856, &[K::MaterialFile, K::UnknownMaterial])),
        ("obj_mtl_path_traversal.obj", Loads(5856, &[K::MaterialFile, K::UnknownMaterial])),
        ("obj_nan_inf_vertices.obj", Loads(5838, &[K::FaceNowhere])),
        ("obj_negative_index_out_of_range.obj", Loads(5855, &[K::FaceOutOfRange])),
        ("obj_ngon_5000.obj", Loads(4998, WHOLE)),
        ("obj_nonmanifold_fan.obj", Loads(40, WHOLE)),
        ("obj_overflow_1e300.obj", Fails(":1: \"3.487990000e+299\" is no coordinate, being larger than 1e100; scale the model down")),
        ("obj_point_extent.obj", Fails(": holds only triangles without area; export the model again, in smaller units")),
        ("obj_random_winding.obj", Loads(5856, WHOLE)),
        ("obj_tiny_1e-9.obj", Loads(5856, WHOLE)),
        ("obj_truncated.obj", Loads(2200, &[K::ShortFace])),
        ("obj_utf16le.obj", Loads(5856, WHOLE)),
        ("obj_vertices_only.obj", Fails(": holds no triangles; export the model's surfaces, or as a mesh")),
        ("off_no_magic.off", Loads(12, WHOLE)),
        ("off_truncated.off", Fails(":9: the file ends after 7 of 8 vertices; was it saved or downloaded completely?")),
        ("OutOfMemory.off", Fails(":2: 353535235358 vertices are announced, and there is room for 52 at most; correct the count")),
        ("ply_crlf_header_binary.ply", Loads(1610, WHOLE)),
        ("ply_empty_header.ply", Fails(": holds no triangles; export the model's surfaces, or as a mesh")),
        ("ply_face_index_out_of_range.ply", Loads(1, &[K::FaceOutOfRange])),
        ("ply_list_count_255.ply", Fails(": byte 293: the file ends in number 1 of 3 \"face\" elements, or is damaged there; was it saved or downloaded completely?")),
        ("ply_negative_count.ply", Fails(":12: \"-5\" is no number of \"face\" elements; export the model again")),
        ("ply_no_end_header.ply", Fails(":14: the header has no end_header; was the file saved or downloaded completely?")),
        ("ply_odd_property_order.ply", Loads(4, WHOLE)),
        ("ply_short_lists.ply", Fails(": face 1: none of 3 faces can be drawn: this one has fewer than three vertices; export the model again")),
        ("ply_truncated.ply", Loads(1225, &[K::MeshCut])),
        ("ply_unknown_type.ply", Fails(":5: \"float128\" is no kind of number that PLY has; save as float, double or int")),
        ("ply_vertex_count_4e9.ply", Fails(":4: 4294967295 vertices are announced, and there is room for 2153 at most; was the file saved or downloaded completely?")),
        ("ply_wrong_endianness.ply", Fails(":2: no face names vertices that are there; does the header say the right byte order?")),
        ("stl_83_bytes.stl", Fails(": byte 83: ends inside the header of 84 bytes; was it saved or downloaded completely?")),
        ("stl_ascii_junk_tokens.stl", Loads(571, &[K::ShortFace, K::UnknownWord])),
        ("stl_ascii_unterminated.stl", Loads(294, &[K::MeshCut])),
        ("stl_ascii_upper_tabs_crlf.stl", Loads(572, WHOLE)),
        ("stl_bin_count_4e9.stl", Loads(3476, &[K::CountWrong])),
        ("stl_bin_count_zero.stl", Loads(3476, &[K::CountWrong])),
        ("stl_bin_nan.stl", Loads(3475, &[K::FaceNowhere])),
        ("stl_bin_solid_header.stl", Loads(3476, WHOLE)),
        ("stl_bin_trailing_garbage.stl", Loads(3476, &[K::TrailingBytes])),
        ("stl_bin_truncated.stl", Loads(1000, &[K::CountWrong, K::MeshCut])),
        ("stl_bin_zero_normals.stl", Loads(3476, WHOLE)),
        ("stl_header_only.stl", Fails(": holds no triangles; export the model's surfaces, or as a mesh")),
        ("trimesh_empty.stl", Fails(": holds no triangles; export the model's surfaces, or as a mesh")),
    ]
}

/// Kinds that importers of these formats note; what is mended afterwards is not looked at here.
const OURS: &[NoteKind] = &[
    NoteKind::FaceNowhere,
    NoteKind::FaceOutOfRange,
    NoteKind::ShortFace,
    NoteKind::NoNormal,
    NoteKind::NoColor,
    NoteKind::CrossedPolygon,
    NoteKind::UnknownWord,
    NoteKind::CountWrong,
    NoteKind::TrailingBytes,
    NoteKind::MeshCut,
    NoteKind::MaterialFile,
    NoteKind::UnknownMaterial,
    NoteKind::PictureNotDrawn,
];

fn load(path: &Path) -> Scene {
    Scene::load(path).unwrap_or_else(|error| panic!("{error}"))
}

/// The area of all triangles, in square units of the file.
fn area(scene: &Scene) -> f64 {
    let assembly = &scene.assembly;
    let mut sum = 0.0;
    for part in &assembly.parts {
        let shape = &assembly.shapes[part.shape as usize];
        let place = |index: u32| part.world_from_shape.transform_point3(shape.positions[index as usize]).as_dvec3();
        let areas =
            shape.triangles.iter().map(|triangle| triangle.map(place)).map(|[a, b, c]| (b - a).cross(c - a).length());
        sum += areas.sum::<f64>() * 0.5;
    }
    sum * scene.unit * scene.unit
}

fn assert_near(value: f64, expected: f64, relative: f64, what: &str) {
    assert!((value - expected).abs() <= relative * expected, "{what}: {value} for {expected}");
}

/// Every file of a folder that is ours must be in a table.
fn assert_complete(folder: &Path, table: &[&str]) {
    for entry in std::fs::read_dir(folder).expect("readable") {
        let name = entry.expect("readable").file_name().to_string_lossy().into_owned();
        let is_ours =
            ["stl", "obj", "ply", "off"].iter().any(|end| name.to_ascii_lowercase().ends_with(&format!(".{end}")));
        // A molecule and a picture by other names, and a cloud of points.
        let is_other = name.starts_with("wrong_ext") || name == "points_ascii.ply";
        assert!(!is_ours || is_other || table.contains(&name.as_str()), "{name} is not in the table");
    }
}

#[test]
fn every_real_mesh_has_the_triangles_of_its_row() {
    let Some(folder) = data("meshes") else { return };
    assert_complete(&folder, &MESHES.iter().map(|row| row.0).collect::<Vec<_>>());
    for &(file, expected, num_parts, num_names, num_materials) in MESHES {
        let scene = load(&folder.join(file));
        let assembly = &scene.assembly;
        assert_eq!(num_triangles(&scene), expected, "{file}: {}", scene.files[0].report);
        let names: BTreeSet<&str> =
            assembly.parts.iter().map(|part| assembly.names[part.name as usize].as_str()).collect();
        assert_eq!(
            (assembly.parts.len(), names.len(), assembly.materials.len()),
            (num_parts, num_names, num_materials),
            "{file}"
        );
    }
    let error = Scene::load(&folder.join("points_ascii.ply")).expect_err("points only");
    assert!(matches!(error, SceneError::NoTriangles { .. }), "{error}");
}

#[test]
fn every_damaged_mesh_is_mended_or_refused_as_promised() {
    let Some(folder) = data("bad") else { return };
    let table = bad_files();
    assert_complete(&folder, &table.iter().map(|row| row.0).collect::<Vec<_>>());
    for (file, outcome) in table {
        let path = folder.join(file);
        outcome.check(&path, num_triangles, |kind| OURS.contains(&kind));
    }
}

#[test]
fn areas_are_those_of_the_shapes_whatever_the_format() {
    let (Some(meshes), Some(bad)) = (data("meshes"), data("bad")) else { return };
    let of_mesh = |file: &str| area(&load(&meshes.join(file)));
    assert_near(of_mesh("cube.ply"), 6.0, 1e-6, "a cube");
    assert_near(of_mesh("cube_with_materials/cube_with_materials.obj"), 6.0, 1e-6, "a cube");
    assert_near(of_mesh("hundred_cubes/hundred_cubes.obj"), 600.0, 1e-5, "a hundred cubes");
    // The vector area of its outline.
    assert_near(of_mesh("concave_polygon/concave_polygon.obj"), 0.2455, 1e-3, "a concave polygon");
    assert_near(of_mesh("unit_sphere.STL"), 4.0 * std::f64::consts::PI, 0.01, "a sphere");
    assert_near(of_mesh("featuretype.STL"), of_mesh("featuretype.ply"), 1e-5, "STL and PLY");
    let wuson = of_mesh("WusonOBJ.obj");
    for file in ["Wuson.ply", "Wuson.off"] {
        assert_near(of_mesh(file), wuson, 1e-5, file);
    }
    let spot = of_mesh("spot.obj");
    for file in ["obj_bom.obj", "obj_cr_only.obj", "obj_crlf.obj", "obj_utf16le.obj", "obj_line_continuation.obj"] {
        assert_near(area(&load(&bad.join(file))), spot, 1e-6, file);
    }
    let ngon = area(&load(&bad.join("obj_ngon_5000.obj")));
    assert_near(ngon, std::f64::consts::PI, 1e-5, "a circle");
}

#[test]
fn parts_materials_and_side_files_are_those_of_the_file() {
    let Some(folder) = data("meshes") else { return };
    let Scene { assembly, files, .. } = load(&folder.join("panda/panda.obj"));
    let name = |number: u32| assembly.names[number as usize].as_str();
    let first = &assembly.parts[0];
    assert_eq!((name(first.name), name(first.path)), ("link0.link0_0", "link0.link0_0/link0.link0_0"));
    let material = &assembly.materials[first.material.expect("has one") as usize];
    assert_eq!(material.name, "off_white_0.902_0.922_0.929_1");
    // Kd 0.902 in linear light.
    assert!((material.base_color.x - 0.7913).abs() < 1e-3 && material.opacity == 1.0, "{}", material.base_color);
    assert_eq!(files[0].side_files, [folder.join("panda/panda.mtl")]);
    let Scene { assembly, .. } = load(&folder.join("multibody.stl"));
    let names: Vec<&str> = assembly.parts.iter().map(|part| assembly.names[part.name as usize].as_str()).collect();
    assert_eq!(names, ["bodyB", "bodyA"]);
    let Scene { assembly, .. } = load(&folder.join("1crn.ply"));
    assert_eq!(assembly.shapes[0].colors.len(), assembly.shapes[0].positions.len());
}
