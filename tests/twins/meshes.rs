//! Meshes on the GPU held to ray casts of their triangles in f64: ids, depths, normals, shadows, outlines, tiles.

use glam::{DMat3, DVec3};
use restyle::engine::{Engine, Request};
use restyle::scene::{Assembly, Camera, Scene};

use super::gpu;
use super::truth::{Ray, View, center_px};

/// Kind of triangles in the upper 3 bits of an id.
const MESH: u32 = 3;
const SIZE: [u32; 2] = [320, 240];

/// A closed solid as an STL text: its facets by their corners.
pub fn stl(facets: &[[DVec3; 3]]) -> String {
    let corner = |p: &DVec3| format!("vertex {} {} {}\n", p.x, p.y, p.z);
    let facet = |corners: &[DVec3; 3]| {
        let vertices: String = corners.iter().map(corner).collect();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    format!("solid test\n{}endsolid test\n", facets.iter().map(facet).collect::<String>())
}

/// Both triangles of a quad, counter-clockwise.
pub fn quad(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> [[DVec3; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// A box of these half sides, turned and moved.
pub fn cuboid(half: DVec3, turn: DMat3, center: DVec3) -> Vec<[DVec3; 3]> {
    let at = |x: f64, y: f64, z: f64| center + turn * (DVec3::new(x, y, z) * half);
    let faces = [
        [(1., -1., -1.), (1., 1., -1.), (1., 1., 1.), (1., -1., 1.)],
        [(-1., -1., -1.), (-1., -1., 1.), (-1., 1., 1.), (-1., 1., -1.)],
        [(-1., 1., -1.), (-1., 1., 1.), (1., 1., 1.), (1., 1., -1.)],
        [(-1., -1., -1.), (1., -1., -1.), (1., -1., 1.), (-1., -1., 1.)],
        [(-1., -1., 1.), (1., -1., 1.), (1., 1., 1.), (-1., 1., 1.)],
        [(-1., -1., -1.), (-1., 1., -1.), (1., 1., -1.), (1., -1., -1.)],
    ];
    faces
        .iter()
        .flat_map(|face| {
            let [a, b, c, d] = face.map(|(x, y, z)| at(x, y, z));
            quad(a, b, c, d)
        })
        .collect()
}

/// A cylinder with flat caps along z, turned and moved.
pub fn cylinder(radius: f64, half: f64, sides: u32, turn: DMat3, center: DVec3) -> Vec<[DVec3; 3]> {
    let at = |index: u32, z: f64| {
        let (sine, cosine) = (f64::from(index % sides) / f64::from(sides) * std::f64::consts::TAU).sin_cos();
        center + turn * DVec3::new(radius * cosine, radius * sine, z)
    };
    let (top, bottom) = (center + turn * DVec3::Z * half, center - turn * DVec3::Z * half);
    (0..sides)
        .flat_map(|i| {
            let mut facets = quad(at(i, -half), at(i + 1, -half), at(i + 1, half), at(i, half)).to_vec();
            facets.push([top, at(i, half), at(i + 1, half)]);
            facets.push([bottom, at(i + 1, -half), at(i, -half)]);
            facets
        })
        .collect()
}

/// A turn that shows three sides.
pub fn askew() -> DMat3 {
    DMat3::from_rotation_x(0.5) * DMat3::from_rotation_y(0.7)
}

/// An engine for facets.
pub fn engine(facets: &[[DVec3; 3]], style: &str) -> Option<Engine> {
    let mut engine = gpu::engine(&["C 0 0 0"], style)?;
    engine.set_scene(Scene::from_bytes("test.stl", stl(facets).as_bytes()).expect("a mesh"));
    Some(engine)
}

/// Every triangle of the scene in view space, with the id that its place in the file gives it where it is drawn once.
fn triangles(assembly: &Assembly, camera: &Camera) -> Vec<[DVec3; 3]> {
    let view = camera.view_from_world.as_dmat4();
    let of_part = |part: &restyle::scene::Part| {
        let shape = &assembly.shapes[part.shape as usize];
        let place = |index: u32| {
            let at = part.world_from_shape.transform_point3(shape.positions[index as usize]);
            view.transform_point3(at.as_dvec3())
        };
        shape.triangles.iter().map(|triangle| triangle.map(place)).collect::<Vec<_>>()
    };
    assembly.parts.iter().flat_map(of_part).collect()
}

/// Where a ray meets a triangle: depth, and the smallest share of its three corners.
pub fn crossing(ray: Ray, [a, b, c]: [DVec3; 3]) -> Option<(f64, f64)> {
    let (along_b, along_c) = (b - a, c - a);
    let normal = along_b.cross(along_c);
    let facing = ray.direction.dot(normal);
    if facing == 0.0 {
        return None;
    }
    let around = (ray.origin - a).cross(ray.direction);
    let (share_b, share_c) = (-around.dot(along_c) / facing, around.dot(along_b) / facing);
    let least = share_b.min(share_c).min(1.0 - share_b - share_c);
    (least >= 0.0).then(|| ((a - ray.origin).dot(normal) / facing, least))
}

/// The first triangle along a ray beyond `near`: its place in the list and its depth.
fn first(triangles: &[[DVec3; 3]], ray: Ray, near: f64) -> Option<(usize, f64)> {
    let crossings =
        triangles.iter().enumerate().filter_map(|(index, &corners)| Some((index, crossing(ray, corners)?.0)));
    crossings.filter(|(_, t)| *t > near).min_by(|a, b| a.1.total_cmp(&b.1))
}

const CAMERAS: [&str; 2] = [r#"{"fov": 40}"#, r#"{"orthographic": true}"#];

#[test]
fn triangles_are_seen_where_ray_casts_meet_them() {
    let mut facets = cuboid(DVec3::new(1.0, 0.6, 0.8), askew(), DVec3::ZERO);
    facets.extend(cylinder(0.5, 0.9, 48, DMat3::from_rotation_x(1.1), DVec3::new(1.4, 0.5, 0.6)));
    for camera in CAMERAS {
        let Some(mut engine) = engine(&facets, &format!(r#"{{"camera": {camera}}}"#)) else { return };
        let aovs = gpu::aovs(&mut engine, SIZE);
        let camera = engine.camera(SIZE).expect("a camera");
        let view = View::new(&camera, SIZE);
        let all = triangles(&engine.scene().expect("a scene").assembly, &camera);
        let (mut num_seen, mut num_other, mut worst) = (0, 0, 0.0_f64);
        for ((x, y), (id, depth)) in gpu::pixels(SIZE).zip(aovs.ids.iter().zip(&aovs.depth)) {
            let ray = view.ray(center_px((x, y)));
            match first(&all, ray, view.near) {
                Some((triangle, t)) => {
                    num_seen += 1;
                    // On an edge either triangle is right, and rounding may choose the background.
                    if *id != MESH << 29 | triangle as u32 {
                        num_other += 1;
                    } else {
                        worst = worst.max((f64::from(*depth) / t - 1.0).abs());
                    }
                }
                None if *id != 0 => num_other += 1,
                None => assert_eq!(*depth, f32::INFINITY),
            }
        }
        eprintln!("{num_seen} pixels, {num_other} on edges differ, depth off by {worst:.1e}");
        assert!(num_seen > 10_000 && num_other <= num_seen / 500, "{num_other} of {num_seen}");
        assert!(worst < 1e-5, "{worst}");
    }
}

#[test]
fn normals_of_flat_sides_are_flat_and_of_round_ones_round() {
    let radius = 1.0;
    let turn = askew();
    let facets = cylinder(radius, 1.2, 96, turn, DVec3::ZERO);
    for camera in CAMERAS {
        let Some(mut engine) = engine(&facets, &format!(r#"{{"camera": {camera}}}"#)) else { return };
        let aovs = gpu::aovs(&mut engine, SIZE);
        let camera = engine.camera(SIZE).expect("a camera");
        let view = View::new(&camera, SIZE);
        let to_view = camera.view_from_world.as_dmat4();
        let origin = engine.scene().expect("a scene").origin();
        let axis = to_view.transform_vector3(turn * DVec3::Z);
        let center = to_view.transform_point3(-origin);
        let mut worst = [0.0_f64; 2];
        for ((x, y), (normal, depth)) in gpu::pixels(SIZE).zip(aovs.normal.chunks_exact(3).zip(&aovs.depth)) {
            if !depth.is_finite() {
                continue;
            }
            let normal = DVec3::new(f64::from(normal[0]), f64::from(normal[1]), f64::from(normal[2]));
            let ray = view.ray(center_px((x, y)));
            let point = ray.origin + f64::from(*depth) * ray.direction - center;
            let along = point.dot(axis);
            let radial = (point - along * axis).length();
            let is_cap = along.abs() > 1.2 - 1e-3;
            // Not on the edges between side and caps, and not where the side is seen from the side: there an interpolated
            // normal that leans away is turned back.
            let is_edge = (along.abs() > 1.19 && !is_cap) || (is_cap && radial > 0.99);
            if is_edge || normal.dot(ray.direction.normalize()) > -0.1 {
                continue;
            }
            let expected = if is_cap { axis * along.signum() } else { (point - along * axis).normalize() };
            let off = normal.angle_between(expected).to_degrees();
            worst[usize::from(is_cap)] = worst[usize::from(is_cap)].max(off);
        }
        eprintln!("normals off by {:.3} degrees on the side, {:.4} on caps", worst[0], worst[1]);
        // A chord of 96 sides leans by 1.9 degrees at the most; interpolation takes nearly all of it.
        assert!(worst[0] < 0.1 && worst[1] < 0.02, "{worst:?}");
    }
}

#[test]
fn a_box_throws_the_shadow_that_rays_find() {
    // A floor, and a box that floats above it.
    let mut facets = cuboid(DVec3::new(2.0, 0.05, 2.0), DMat3::IDENTITY, DVec3::ZERO);
    facets.extend(cuboid(DVec3::splat(0.4), DMat3::from_rotation_y(0.4), DVec3::new(0.0, 0.9, 0.0)));
    let toward = DVec3::new(0.5, 1.0, 0.3);
    for (camera, kind) in CAMERAS.iter().flat_map(|camera| [(camera, "directional"), (camera, "point")]) {
        let fields = camera.trim_matches(['{', '}']);
        let distance = if kind == "point" { 3.0 } else { 1.0 };
        let place = toward * distance;
        let style = format!(
            r##"{{"camera": {{{fields}, "position": [1.2, 1.6, 2.2], "bgcolor": "black"}}, "mapping": {{"*": "t"}},
                "shaders": [{{"name": "t", "shader": "toon",
                    "properties": {{"steps": 1, "base_color": "white", "hull_size": 0, "outline_bias": 0}}}}],
                "lights": [{{"type": "{kind}", "space": "scene", "position": [{}, {}, {}], "shadow": "hard", "strength": 1}}]}}"##,
            place.x, place.y, place.z
        );
        let Some(mut engine) = engine(&facets, &style) else { return };
        let image = gpu::still(&mut engine, SIZE, 1);
        let camera = engine.camera(SIZE).expect("a camera");
        let view = View::new(&camera, SIZE);
        let scene = engine.scene().expect("a scene");
        let all = triangles(&scene.assembly, &camera);
        let to_view = camera.view_from_world.as_dmat4();
        let sphere = scene.bounding_sphere();
        let center = sphere.center.as_dvec3();
        let light = to_view.transform_point3(center + place * f64::from(sphere.radius));
        let (mut shaded, mut lit, mut wrong) = (0, 0, 0);
        for (x, y) in gpu::pixels(SIZE) {
            let ray = view.ray(center_px((x, y)));
            let Some((own, t)) = first(&all, ray, view.near) else { continue };
            let point = ray.origin + t * ray.direction;
            let [a, b, c] = all[own];
            let normal = (b - a).cross(c - a).normalize();
            let to_light = if kind == "point" { light - point } else { to_view.transform_vector3(toward) };
            if normal.dot(to_light.normalize()) < 0.05 {
                continue;
            }
            let is_shaded = |point: DVec3| {
                let ray = Ray { origin: point + normal * 1e-4, direction: to_light };
                let end = if kind == "point" { 1.0 } else { f64::INFINITY };
                all.iter().any(|&corners| crossing(ray, corners).is_some_and(|(t, _)| t > 1e-6 && t < end))
            };
            let here = is_shaded(point);
            // Within three pixels of the shadow's edge, either.
            let around = 2.0 * view.pixel_view() * if view.orthographic { 1.0 } else { t };
            let (side, other) = normal.any_orthonormal_pair();
            let is_edge = (0..8).any(|turn| {
                let (sine, cosine) = (f64::from(turn) * 0.785).sin_cos();
                is_shaded(point + around * 1.5 * (cosine * side + sine * other)) != here
            });
            if is_edge {
                continue;
            }
            let brightness = image.pixel(x, y)[0];
            let is_dark = brightness < 0.5;
            if here {
                shaded += 1
            } else {
                lit += 1
            }
            wrong += u32::from(is_dark != here);
        }
        eprintln!("{kind}: {shaded} shaded, {lit} lit, {wrong} wrong");
        assert!(shaded > 150 && lit > 5_000, "{shaded} {lit}");
        // At corners of the shadow, where eight directions miss the edge.
        assert!(wrong <= 3, "{wrong} wrong: {kind} {style}");
    }
}

/// Groups of neighbouring pixels that fulfil a condition; with corners as neighbours where `diagonal`.
pub fn components(size: [u32; 2], diagonal: bool, is_in: impl Fn(u32, u32) -> bool) -> usize {
    let [width, height] = size;
    let mut seen = vec![false; (width * height) as usize];
    let mut count = 0;
    for (x, y) in gpu::pixels(size) {
        if seen[(y * width + x) as usize] || !is_in(x, y) {
            continue;
        }
        count += 1;
        let mut stack = vec![(x, y)];
        seen[(y * width + x) as usize] = true;
        while let Some((x, y)) = stack.pop() {
            for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
                if !diagonal && dx != 0 && dy != 0 {
                    continue;
                }
                let (Some(nx), Some(ny)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else { continue };
                if nx < width && ny < height && !seen[(ny * width + nx) as usize] && is_in(nx, ny) {
                    seen[(ny * width + nx) as usize] = true;
                    stack.push((nx, ny));
                }
            }
        }
    }
    count
}

#[test]
fn hull_outlines_of_solids_have_no_gaps() {
    let size = [400, 400];
    for (name, facets) in [
        ("cube", cuboid(DVec3::ONE, DMat3::IDENTITY, DVec3::ZERO)),
        ("cylinder", cylinder(0.8, 1.0, 64, DMat3::IDENTITY, DVec3::ZERO)),
    ] {
        for (turn, width_px) in
            [0.0, 0.35, 0.8, 1.9].into_iter().flat_map(|turn| [1, 2, 5, 10, 20].map(move |width| (turn, width)))
        {
            let rotation = DMat3::from_rotation_x(turn) * DMat3::from_rotation_y(1.7 * turn);
            let turned: Vec<_> = facets.iter().map(|facet| facet.map(|corner| rotation * corner)).collect();
            // In points of a 1080th of the height.
            let points = f64::from(width_px) * 1080.0 / f64::from(size[1]);
            let style = format!(
                r##"{{"camera": {{"bgcolor": "white", "zoom": 0.8}}, "mapping": {{"*": "t"}},
                    "shaders": [{{"name": "t", "shader": "toon", "properties": {{"steps": 1, "base_color": "#00ff00",
                        "color": "black", "hull_size": "{points}pt", "outline_bias": 0}}}}]}}"##
            );
            let Some(mut engine) = engine(&turned, &style) else { return };
            let image = gpu::still(&mut engine, size, 1);
            let is_line = |x: u32, y: u32| image.pixel(x, y)[1] < 0.5;
            let is_background = |x: u32, y: u32| image.pixel(x, y)[0] > 0.5;
            let is_body = |x: u32, y: u32| image.pixel(x, y)[1] > 0.5 && image.pixel(x, y)[0] < 0.5;
            let what = format!("{name} turned by {turn}, {width_px} px");
            assert_eq!(components(size, true, is_line), 1, "{what}: the line is one piece");
            // A closed line parts the picture in two: nowhere does the body touch the background.
            assert_eq!(components(size, false, |x, y| is_body(x, y) || is_background(x, y)), 2, "{what}: a gap");
        }
    }
}

#[test]
fn tiles_are_the_picture() {
    let mut facets = cuboid(DVec3::new(1.0, 0.6, 0.8), askew(), DVec3::ZERO);
    facets.extend(cylinder(0.5, 0.9, 48, DMat3::from_rotation_x(1.1), DVec3::new(1.4, 0.5, 0.6)));
    let style = r##"{"camera": {"zoom": 2.5}, "mapping": {"*": "t", "post_effects": ["ao", "lines", "focus"]}, "shaders": [{"name": "t", "shader": "toon", "properties":
        {"base_color": "#88bbee", "hull_size": "9pt"}}, {"name": "ao", "shader": "ssaoPost", "properties": {"radius": 0.08}},
        {"name": "lines", "shader": "outlinePost"}, {"name": "focus", "shader": "dofPost", "properties": {"layers": [0.2, 0.4, 0.5, 0.9]}}],
        "lights": [{"position": [1, 2, 3], "shadow": "soft"}]}"##;
    // Wider than one tile, and so large that the whole is drawn in tiles.
    let request = Request::new([2200, 2100], 2);
    assert!(Engine::is_tiled(&request));
    let Some(mut engine) = engine(&facets, style) else { return };
    let whole = engine.still(&request).expect("a still");
    let mut rows = Vec::new();
    let drawn = engine.draw_rows(&request, &mut |_| std::ops::ControlFlow::Continue(()), &mut |bytes| {
        rows.extend_from_slice(bytes);
        Ok(())
    });
    drawn.expect("tiles");
    let restyle::scene::Pixels::U8(values) = &whole.pixels else { panic!("8 bits") };
    assert_eq!(values.len(), rows.len());
    let differing = values.iter().zip(&rows).filter(|(a, b)| a.abs_diff(**b) > 1).count();
    assert_eq!(differing, 0, "values that differ by more than 1");
}

/// A GLB of one tetrahedron that nodes place: each a column-major matrix and a name.
fn glb(nodes: &[(&str, [f64; 16])]) -> Vec<u8> {
    let corners: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.3, 0.0], [0.0, 0.0, 0.7]];
    let triangles: [u16; 12] = [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2];
    let mut bin: Vec<u8> = corners.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    bin.extend(triangles.iter().flat_map(|index| index.to_le_bytes()));
    let placed: Vec<String> =
        nodes.iter().map(|(name, matrix)| format!(r#"{{"name":"{name}","mesh":0,"matrix":{matrix:?}}}"#)).collect();
    let roots: Vec<String> = (0..nodes.len()).map(|index| index.to_string()).collect();
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],"nodes":[{}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1.3,0.7]}},
                {{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":24}}],
            "buffers":[{{"byteLength":72}}]}}"#,
        roots.join(","),
        placed.join(",")
    )
    .into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF".to_vec();
    glb.extend([2, (12 + 8 + json.len() + 8 + bin.len()) as u32].iter().flat_map(|word| word.to_le_bytes()));
    glb.extend((json.len() as u32).to_le_bytes());
    glb.extend(b"JSON");
    glb.extend(json);
    glb.extend((bin.len() as u32).to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(bin);
    glb
}

/// Moved by `x` and `y`, with these scales: a negative one mirrors.
fn placed(x: f64, y: f64, scale: [f64; 3]) -> [f64; 16] {
    let [a, b, c] = scale;
    [a, 0.0, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, 0.0, c, 0.0, x, y, 0.0, 1.0]
}

#[test]
fn instances_mirrored_or_not_are_where_their_parts_are_and_hidden_ones_are_not() {
    let nodes = [
        ("one", placed(0.0, 0.0, [1.0, 1.0, 1.0])),
        ("mirrored", placed(2.5, 0.2, [-1.0, 1.0, 1.2])),
        ("hidden", placed(0.3, -1.6, [1.0, 1.0, 1.0])),
        ("last", placed(1.6, -1.5, [0.8, 0.8, 1.5])),
    ];
    let style = r##"{"camera": {"bgcolor": "white"}, "mapping": {"mesh[part=hidden]": null, "mesh": "t"},
        "shaders": [{"name": "t", "shader": "toon", "properties":
            {"steps": 1, "base_color": "#00ff00", "color": "black", "hull_size": "9pt", "outline_bias": 0}}]}"##;
    let Some(mut engine) = gpu::engine(&["C 0 0 0"], r#"{}"#) else { return };
    engine.set_scene(Scene::from_bytes("test.glb", &glb(&nodes)).expect("a mesh"));
    // A mapping for meshes alone is of no use to the atom that the engine begins with, so it comes second.
    let source = restyle::config::Source::new("test.json", style);
    let entries = restyle::engine::catalog();
    let catalog = restyle::config::Catalog { shaders: &entries, kinds: restyle::engine::DRAWN_KINDS };
    engine.set_style(restyle::config::load(&source, &catalog).unwrap_or_else(|mistakes| panic!("{mistakes}")));
    let aovs = gpu::aovs(&mut engine, SIZE);
    let image = gpu::still(&mut engine, SIZE, 1);
    let camera = engine.camera(SIZE).expect("a camera");
    let view = View::new(&camera, SIZE);
    let assembly = &engine.scene().expect("a scene").assembly;
    assert_eq!((assembly.parts.len(), assembly.shapes.len()), (4, 1), "one shape, placed four times");
    let all = triangles(assembly, &camera);
    // Four triangles a part, in the order of the parts.
    let hidden = assembly.parts.iter().position(|part| assembly.names[part.name as usize] == "hidden").expect("a part");
    let drawn: Vec<[DVec3; 3]> =
        all.iter().enumerate().filter(|(index, _)| index / 4 != hidden).map(|(_, corners)| *corners).collect();
    let (mut num_seen, mut wrong, mut num_lines) = (0, 0, 0);
    for ((x, y), depth) in gpu::pixels(SIZE).zip(&aovs.depth) {
        let ray = view.ray(center_px((x, y)));
        match first(&drawn, ray, view.near) {
            Some((_, t)) => {
                num_seen += 1;
                wrong += u32::from((f64::from(*depth) / t - 1.0).abs() > 1e-5);
            }
            None => {
                wrong += u32::from(depth.is_finite());
                num_lines += u32::from(image.pixel(x, y)[1] < 0.5);
            }
        }
    }
    eprintln!("{num_seen} pixels, {wrong} wrong, {num_lines} of outlines");
    assert!(num_seen > 5_000 && wrong <= num_seen / 500, "{wrong} of {num_seen}");
    // A shell that is wound the wrong way would cover its part or not be there.
    let covered =
        gpu::pixels(SIZE).zip(&aovs.depth).filter(|((x, y), depth)| depth.is_finite() && image.pixel(*x, *y)[1] < 0.5);
    assert!(covered.count() < 40 && num_lines > 500, "{num_lines} pixels of outlines");
}
