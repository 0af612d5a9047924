//! Small archives made here, whole and broken.

use std::io::{Cursor, Write};

use glam::DVec3;
use zip::write::{SimpleFileOptions, ZipWriter};

use super::super::{Import, LoadOptions};
use super::read;
use crate::scene::error::SceneError;
use crate::scene::mesh::RawMesh;
use crate::scene::report::{NoteKind, Report};

/// An archive of entries.
fn packed(entries: &[(&str, &str)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        zip.start_file(*name, SimpleFileOptions::default()).expect("an entry");
        zip.write_all(content.as_bytes()).expect("in memory");
    }
    zip.finish().expect("in memory").into_inner()
}

fn read_bytes(bytes: &[u8]) -> (Result<RawMesh, SceneError>, Report) {
    let options = LoadOptions::default();
    let (report, side_files) = (Report::default(), Vec::new());
    let mut import = Import { file: "a.3mf", options: &options, report, folder: None, side_files };
    let mesh = read(&mut import, bytes);
    (mesh, import.report)
}

fn loaded(entries: &[(&str, &str)]) -> (RawMesh, Report) {
    let (mesh, report) = read_bytes(&packed(entries));
    (mesh.unwrap_or_else(|error| panic!("{error}")), report)
}

fn refusal(entries: &[(&str, &str)]) -> String {
    read_bytes(&packed(entries)).0.expect_err("broken").to_string()
}

/// The path of the main model where nothing else says so.
const MAIN: &str = "3D/3dmodel.model";
/// Four corners of a tetrahedron.
const VERTICES: &str = r#"<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices>"#;

/// A model of resources and items.
fn model(attributes: &str, resources: &str, items: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><model {attributes}><resources>{resources}</resources><build>{items}</build></model>"
    )
}

/// An object of triangles.
fn object(attributes: &str, triangles: &str) -> String {
    format!("<object {attributes}><mesh>{VERTICES}<triangles>{triangles}</triangles></mesh></object>")
}

const TWO: &str = r#"<triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/>"#;

#[test]
fn components_are_placed_with_names_and_paths() {
    let pin = object(r#"id="1" name="pin &amp; bolt""#, TWO);
    let resources = format!(
        r#"{pin}<object id="2" partnumber="A-2"><components>
            <component objectid="1" transform="0 1 0 -1 0 0 0 0 1 5 0 0"/>
            <component objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/></components></object>"#
    );
    let items = r#"<item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 2"/><item objectid="1"/><item objectid="9"/>"#;
    let (mesh, report) = loaded(&[(MAIN, &model(r#"unit="centimeter""#, &resources, items))]);
    assert_eq!(mesh.shapes.len(), 1);
    let names: Vec<(&str, &str)> = mesh.parts.iter().map(|part| (part.name.as_str(), part.path.as_str())).collect();
    let pin = "pin & bolt";
    assert_eq!(names, [(pin, "A-2/pin & bolt"), (pin, "A-2/pin & bolt"), (pin, pin)]);
    // Centimetres: x turns to y, then moves by 5 and up by 2.
    let end = mesh.parts[0].file_from_shape.transform_point3(mesh.shapes[0].positions[1]);
    assert!(end.distance(DVec3::new(50.0, 10.0, 20.0)) < 1e-12, "{end}");
    assert!(mesh.parts[1].file_from_shape.matrix3.determinant() < 0.0);
    assert_eq!(report.count(NoteKind::UnitConverted), 1);
    assert_eq!(report.count(NoteKind::ReferenceToNowhere), 1);
}

#[test]
fn objects_of_other_entries_are_found_by_their_path() {
    let part = model(r#"unit="inch""#, &object(r#"id="1" name="far""#, TWO), "");
    let items = r#"<item objectid="1" p:path="/3D/Parts/a.model"/><item objectid="1" p:path="/3D/parts/A.model"/><item objectid="1" p:path="/gone.model"/>"#;
    let main = model("", &object(r#"id="1" name="near""#, TWO), &format!("{items}<item objectid=\"1\"/>"));
    let relations = r#"<Relationships><Relationship Target="/m.xml" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#;
    let (mesh, report) = loaded(&[("3D/Parts/a.model", &part), ("_rels/.rels", relations), ("m.xml", &main)]);
    let names: Vec<&str> = mesh.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["far", "far", "near"]);
    assert_eq!(mesh.shapes[0].positions[1], DVec3::X * 25.4);
    assert_eq!(report.count(NoteKind::ReferenceToNowhere), 1);
}

#[test]
fn triangles_are_split_by_material_and_colored_by_corner() {
    let materials = r##"<basematerials id="5"><base name="red" displaycolor="#FF0000"/><base name="glass" displaycolor="#00FF0080"/>
        <base name="lost" displaycolor="#0000FF00"/></basematerials>
        <m:colorgroup id="6"><m:color color="#010203FF"/><m:color color="#040506"/><m:color color="blue"/></m:colorgroup>"##;
    let triangles = r#"<triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3" pid="5" p1="1"/>
        <triangle v1="1" v2="2" v3="3" pid="6" p1="0" p2="1" p3="0"/><triangle v1="0" v2="3" v3="2" pid="6" p1="1"/>"#;
    let resources = format!("{materials}{}", object(r#"id="1" pid="5" pindex="0""#, triangles));
    let (mesh, report) = loaded(&[(MAIN, &model("", &resources, r#"<item objectid="1"/>"#))]);
    assert_eq!(mesh.parts.iter().map(|part| part.material).collect::<Vec<_>>(), [Some(0), Some(1), None]);
    assert_eq!(mesh.shapes[0].positions.len(), 3);
    assert_eq!(mesh.shapes[1].triangles, [[0, 1, 2]]);
    let opacities: Vec<f32> = mesh.materials.iter().map(|material| material.opacity).collect();
    assert_eq!(opacities, [1.0, 128.0 / 255.0, 1.0]);
    assert_eq!((mesh.materials[0].name.as_str(), mesh.materials[0].base_color), ("red", glam::Vec3::X));
    let colored = &mesh.shapes[2];
    // Vertex 2 has a color of each triangle; vertex 3 has both colors.
    assert_eq!(colored.triangles, [[0, 1, 2], [3, 4, 1]]);
    assert_eq!(colored.colors, [[1, 2, 3], [4, 5, 6], [1, 2, 3], [4, 5, 6], [4, 5, 6]]);
    assert_eq!(report.count(NoteKind::InvisibleMended), 1);
    assert_eq!(report.count(NoteKind::ColorUnknown), 1);
}

#[test]
fn triangles_without_three_finite_vertices_are_left_out() {
    let triangles = format!(r#"{TWO}<triangle v1="0" v2="1" v3="9"/><triangle v1="0" v2="1"/>"#);
    let text = model("", &object(r#"id="1""#, &triangles), r#"<item objectid="1"/>"#);
    let text = text.replace(r#"<vertex x="0" y="0" z="1"/>"#, r#"<vertex x="0" y="0" z="nan"/>"#);
    let (mesh, report) = loaded(&[(MAIN, &text)]);
    assert_eq!((mesh.shapes[0].triangles.len(), mesh.shapes[0].positions.len()), (1, 3));
    assert_eq!(mesh.parts[0].name, "object 1");
    assert_eq!([NoteKind::FaceNowhere, NoteKind::FaceOutOfRange].map(|kind| report.count(kind)), [1, 2]);
    let text = text.replace("<vertex x=\"1\"", "<vertex x=\"1e999\"");
    assert_eq!(
        refusal(&[(MAIN, &text)]),
        "a.3mf: none of its 4 triangles has three vertices that exist and are finite; export it again"
    );
}

#[test]
fn rings_bushes_and_towers_of_components_are_refused() {
    let group = |id: u32, name: &str, children: &[u32]| {
        let children: String = children.iter().map(|child| format!("<component objectid=\"{child}\"/>")).collect();
        format!("<object id=\"{id}\" name=\"{name}\"><components>{children}</components></object>")
    };
    let item = r#"<item objectid="1"/>"#;
    let ring = [group(1, "a", &[2]), group(2, "b", &[1])].concat();
    assert_eq!(
        refusal(&[(MAIN, &model("", &ring, item))]),
        "a.3mf: the object \"a\" is a component of itself (\"a\" > \"b\"); export it again"
    );
    let mut bush: String = (1..40).map(|id| group(id, "", &[id + 1, id + 1])).collect();
    bush.push_str(&object(r#"id="40""#, TWO));
    assert!(refusal(&[(MAIN, &model("", &bush, item))]).contains(": places its objects more than 16"));
    let tower: String = (1..400).map(|id| group(id, "", &[id + 1])).collect();
    let tower = tower + &group(400, "", &[]);
    assert!(refusal(&[(MAIN, &model("", &tower, item))]).contains(": its components are nested more than 256 deep; "));
}

#[test]
fn broken_archives_and_texts_are_named() {
    let good = packed(&[(MAIN, &model("", &object(r#"id="1""#, TWO), r#"<item objectid="1"/>"#))]);
    let said = |bytes: &[u8]| read_bytes(bytes).0.expect_err("broken").to_string();
    assert!(said(b"hello").starts_with("a.3mf: begins with \"hell\" and is no zip archive"));
    assert!(said(&good[..good.len() / 2]).contains(": its zip archive has no table of contents; "));
    assert!(refusal(&[("readme", "")]).contains(": has no entry \"3D/3dmodel.model\""));
    assert_eq!(
        refusal(&[(MAIN, "<model><resources></build></model>")]),
        "a.3mf: in its entry \"3D/3dmodel.model\", byte 18: ill-formed document: expected `</resources>`, but `</build>` was found; export the file again"
    );
    assert!(refusal(&[(MAIN, "<model><build>")]).contains(", it ends too early; "));
    assert!(refusal(&[(MAIN, "<html></html>")]).contains(", it has no <model>; "));
    let deep = format!("<model>{}", "<a>".repeat(300));
    assert!(refusal(&[(MAIN, &deep)]).contains("more than 256 elements stand in each other"));
    let encrypted = {
        let mut bytes = good.clone();
        // The flag of encryption, in the entry and in the table of contents.
        let contents = memchr::memmem::rfind(&bytes, b"PK\x01\x02").expect("a table of contents");
        (bytes[6], bytes[contents + 8]) = (bytes[6] | 1, bytes[contents + 8] | 1);
        bytes
    };
    assert_eq!(
        said(&encrypted),
        "a.3mf: its entry \"3D/3dmodel.model\" is encrypted; save the file without a password"
    );
}

#[test]
fn archives_that_unpack_without_end_are_refused() {
    let bomb = format!("<model>{}</model>", " ".repeat(64 << 20));
    let packed = packed(&[(MAIN, &bomb)]);
    assert!(packed.len() < 1 << 17);
    let message = read_bytes(&packed).0.expect_err("a bomb").to_string();
    assert!(message.contains("it unpacks to more than 100 times its length; "), "{message}");
}
