//! Known answers for whole shapes, and promises for any.

use glam::{Affine3A, DAffine3, DVec3, Vec3};

use super::solids::*;
use super::{Assembly, RawNormals, RawShape, Shape, unpack_hull, unpack_normal};
use crate::scene::{NoteKind, Report};

fn normal(shape: &Shape, vertex: u32) -> Vec3 {
    unpack_normal(shape.normals[vertex as usize])
}

fn hull(shape: &Shape, vertex: u32) -> Vec3 {
    unpack_hull(shape.hulls[vertex as usize])
}

fn face_normal(shape: &Shape, triangle: [u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|index| shape.positions[index as usize]);
    (b - a).cross(c - a).normalize()
}

/// Six times the volume, with signs.
fn volume(shape: &Shape) -> f32 {
    let corners = shape.triangles.iter().map(|triangle| triangle.map(|index| shape.positions[index as usize]));
    corners.map(|[a, b, c]| a.dot(b.cross(c))).sum::<f32>() / 6.0
}

/// What every assembly promises.
fn assert_sound(assembly: &Assembly) {
    assert!(!assembly.is_empty() && assembly.unit > 0.0 && assembly.origin.is_finite());
    assert!(assembly.sphere.radius > 0.0 && assembly.sphere.radius.is_finite() && assembly.sphere.center.is_finite());
    for part in &assembly.parts {
        assert!((part.shape as usize) < assembly.shapes.len() && part.world_from_shape.is_finite());
        for &p in &assembly.shapes[part.shape as usize].positions {
            let p = part.world_from_shape.transform_point3(p);
            assert!(p.distance(assembly.sphere.center) <= assembly.sphere.radius * (1.0 + 1e-5), "{p} {assembly:?}");
        }
    }
    for shape in &assembly.shapes {
        let count = shape.positions.len();
        assert!(!shape.triangles.is_empty() && shape.normals.len() == count && shape.hulls.len() == count);
        assert!(shape.colors.is_empty() || shape.colors.len() == count);
        assert!(shape.sphere.radius > 0.0 && shape.sphere.radius.is_finite());
        let mut is_used = vec![false; count];
        for &triangle in &shape.triangles {
            assert!(triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]);
            triangle.iter().for_each(|&index| is_used[index as usize] = true);
        }
        assert!(is_used.iter().all(|&used| used));
        for (index, p) in shape.positions.iter().enumerate() {
            assert!(p.is_finite() && p.distance(shape.sphere.center) <= shape.sphere.radius * (1.0 + 1e-6));
            assert!((normal(shape, index as u32).length() - 1.0).abs() < 1e-5);
            assert!(hull(shape, index as u32).length() <= 4.001);
        }
    }
}

/// No two outline vectors at one place.
fn assert_no_gaps(shape: &Shape) {
    let mut hulls: Vec<([u32; 3], u32)> =
        shape.positions.iter().zip(&shape.hulls).map(|(p, &hull)| (p.to_array().map(f32::to_bits), hull)).collect();
    hulls.sort_unstable();
    assert!(hulls.windows(2).all(|pair| pair[0].0 != pair[1].0 || pair[0].1 == pair[1].1));
}

fn alone(raw: RawShape) -> (Shape, Report) {
    let (mut assembly, report) = build_one(raw);
    assert_sound(&assembly);
    let shape = assembly.shapes.remove(0);
    assert_no_gaps(&shape);
    (shape, report)
}

#[test]
fn a_cube_has_24_vertices_however_it_was_written() {
    for raw in [cube(), soup(&cube())] {
        let (shape, report) = alone(raw);
        assert_eq!((shape.positions.len(), shape.triangles.len()), (24, 12));
        assert!(report.is_empty(), "{report}");
        for &triangle in &shape.triangles {
            for index in triangle {
                assert_eq!(normal(&shape, index), face_normal(&shape, triangle));
                let expected = shape.positions[index as usize];
                assert!(hull(&shape, index).distance(expected) < 0.01, "{} {expected}", hull(&shape, index));
            }
        }
        assert!((volume(&shape) - 8.0).abs() < 1e-5);
        assert!((shape.sphere.radius - 3.0_f32.sqrt()).abs() < 1e-3);
        // Four times 8 over 24.
        assert!((shape.thickness - 4.0 / 3.0).abs() < 1e-5);
    }
}

#[test]
fn places_along_an_edge_lie_on_both_sides() {
    // A box of 2 quads a side: the middles of its edges have two normals.
    let side = |turn: fn(DVec3) -> DVec3| {
        mapped(sheet(2, 2, false, false, |u, v| DVec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 1.0)), turn)
    };
    let around = [
        side(|p| p),
        side(|p| DVec3::new(p.x, -p.y, -p.z)),
        side(|p| DVec3::new(p.z, p.x, p.y)),
        side(|p| DVec3::new(-p.z, -p.x, p.y)),
        side(|p| DVec3::new(p.y, p.z, p.x)),
        side(|p| DVec3::new(p.y, -p.z, -p.x)),
    ];
    let (shape, report) = alone(around.into_iter().reduce(joined).expect("six"));
    assert!((volume(&shape) - 8.0).abs() < 1e-5 && report.is_empty(), "{report}");
    assert_eq!(shape.positions.len(), 6 * 9);
    for (index, &p) in shape.positions.iter().enumerate() {
        assert!(hull(&shape, index as u32).distance(p) < 0.012, "{p} {}", hull(&shape, index as u32));
    }
}

#[test]
fn a_round_surface_is_smooth() {
    for raw in [sphere(48, 24), soup(&sphere(48, 24))] {
        let (shape, report) = alone(raw);
        // Poles are one vertex each; the triangles between their many vertices are gone.
        assert_eq!((shape.positions.len(), shape.triangles.len()), (48 * 23 + 2, 48 * 46));
        assert_eq!(report.count(NoteKind::FlatTriangle), 96);
        assert!(volume(&shape) > 4.0);
        for (index, &p) in shape.positions.iter().enumerate() {
            assert!(normal(&shape, index as u32).dot(p.normalize()) > 0.9995, "{p}");
            assert!((hull(&shape, index as u32) - p).length() < 0.03, "{p} {}", hull(&shape, index as u32));
        }
    }
    let (shape, report) = alone(torus());
    assert!(report.is_empty() && shape.positions.len() == 48 * 24);
}

#[test]
fn many_places_are_shared_out_and_put_together_again() {
    let raw = torus_of(512, 300);
    let expected = raw.triangles.clone();
    let (shape, report) = alone(raw);
    assert!(report.is_empty());
    assert_eq!(shape.positions.len(), 512 * 300);
    assert!(shape.triangles == expected);
}

#[test]
fn a_cylinder_is_smooth_around_and_sharp_at_its_rims() {
    let (shape, report) = alone(cylinder(64));
    assert!(report.is_empty());
    assert_eq!(shape.positions.len(), 64 * 4 + 2);
    for (index, &p) in shape.positions.iter().enumerate() {
        let n = normal(&shape, index as u32);
        let expected = if n.z.abs() > 0.5 { Vec3::Z * p.z } else { Vec3::new(p.x, p.y, 0.0) };
        assert!(n.dot(expected) > 0.9999, "{p} {n}");
        if p.truncate().length() > 0.5 {
            assert!(hull(&shape, index as u32).distance(p) < 0.02, "{p} {}", hull(&shape, index as u32));
        }
    }
    // Eight sides meet at 45 degrees: a prism.
    assert_eq!(alone(cylinder(8)).0.positions.len(), 8 * 6 + 2);
}

#[test]
fn random_winding_is_mended() {
    for raw in [cube(), torus(), cylinder(64)] {
        let expected = volume(&alone(raw.clone()).0);
        let mut random = Random(3);
        let mut num_turned = 0;
        let raw = turned(raw, |_| {
            let turns = random.below(2) == 1;
            num_turned += u32::from(turns);
            turns
        });
        let (shape, report) = alone(raw);
        assert!((volume(&shape) - expected).abs() < 1e-5 * expected, "{} {expected}", volume(&shape));
        assert_eq!(report.count(NoteKind::FaceTurned), num_turned);
        assert_eq!(report.count(NoteKind::InsideOut), 0);
    }
}

#[test]
fn what_is_inside_out_is_turned_and_cavities_are_not() {
    let (shape, report) = alone(turned(cube(), |_| true));
    assert!(volume(&shape) > 7.9);
    assert_eq!((report.count(NoteKind::InsideOut), report.count(NoteKind::FaceTurned)), (1, 0));
    assert_eq!(report.to_string(), "1 closed surface inside out, turned (part)\n");
    assert_eq!(shape.positions.len(), 24);

    let small = || mapped(cube(), |p| p * 0.5);
    let hollow = || joined(cube(), turned(small(), |_| true));
    let (shape, report) = alone(hollow());
    assert!((volume(&shape) - 7.0).abs() < 1e-4 && report.is_empty());
    // The same from the other side: both turn, and the cavity stays one.
    let (shape, report) = alone(turned(hollow(), |_| true));
    assert!((volume(&shape) - 7.0).abs() < 1e-4);
    assert_eq!(report.count(NoteKind::InsideOut), 2);
    // Beside each other they are no cavities.
    let (shape, report) = alone(joined(cube(), turned(mapped(cube(), |p| p + DVec3::X * 5.0), |_| true)));
    assert!((volume(&shape) - 16.0).abs() < 1e-3 && report.count(NoteKind::InsideOut) == 1);
}

#[test]
fn open_surfaces_keep_what_most_of_their_area_says() {
    let (shape, report) = alone(terrain());
    assert!(report.is_empty());
    assert_eq!((shape.positions.len(), shape.triangles.len()), (441, 800));
    assert!(shape.triangles.iter().all(|&triangle| face_normal(&shape, triangle).z > 0.0));
    let (shape, report) = alone(turned(terrain(), |face| face % 3 == 0));
    assert!(shape.triangles.iter().all(|&triangle| face_normal(&shape, triangle).z > 0.0));
    assert_eq!(report.count(NoteKind::FaceTurned), 267);
    // A sheet that looks down stays so.
    let (shape, report) = alone(turned(terrain(), |_| true));
    assert!(shape.triangles.iter().all(|&triangle| face_normal(&shape, triangle).z < 0.0) && report.is_empty());
}

#[test]
fn a_moebius_strip_is_drawn_with_one_seam() {
    let (shape, _) = alone(moebius());
    assert_eq!(shape.triangles.len(), 160);
    let (shape, _) = alone(turned(moebius(), |face| face % 2 == 0));
    assert_eq!(shape.triangles.len(), 160);
}

#[test]
fn a_fan_of_forty_on_one_edge_stays() {
    let mut raw = shape(vec![DVec3::ZERO, DVec3::Z], Vec::new());
    for i in 0..40 {
        let angle = f64::from(i) * 0.157;
        raw.positions.push(DVec3::new(angle.cos(), angle.sin(), 0.5));
        raw.triangles.push([0, 1, i + 2]);
    }
    let (shape, report) = alone(raw.clone());
    assert_eq!((shape.triangles.len(), shape.positions.len()), (40, 120));
    assert!(report.is_empty(), "{report}");
    for &triangle in &shape.triangles {
        assert!(normal(&shape, triangle[2]).dot(face_normal(&shape, triangle)) > 0.9999);
    }
}

#[test]
fn what_has_no_area_is_left_out() {
    let line = |to: DVec3| shape(vec![DVec3::ZERO, to, to * 3.0], vec![[0, 1, 2]]);
    for raw in [line(DVec3::ZERO), line(DVec3::X), line(DVec3::new(0.1, 0.2, 0.7)), RawShape::default()] {
        assert!(build(vec![raw], vec![part(0, DAffine3::IDENTITY)]).0.is_none());
    }
    let mut raw = cube();
    raw.positions.extend([DVec3::new(0.0, 0.3, 7.0), DVec3::new(f64::NAN, 0.0, 0.0)]);
    raw.triangles.extend([[0, 1, 1], [9, 0, 1], [0, 1, 10], [0, 1, u32::MAX]]);
    let (shape, report) = alone(raw);
    assert_eq!((shape.triangles.len(), shape.positions.len()), (12, 24));
    assert_eq!((report.count(NoteKind::LostTriangle), report.count(NoteKind::FlatTriangle)), (3, 1));
}

#[test]
fn a_sliver_on_an_edge_neither_parts_nor_bends_the_surface() {
    // One edge has a vertex in its middle on one side only, and a triangle without area closes the gap.
    let mut raw = turned(cube(), |_| true);
    let face = raw.triangles.iter().position(|triangle| triangle.contains(&0) && triangle.contains(&1)).expect("edge");
    let [a, b, c] = raw.triangles[face];
    raw.positions.push((raw.positions[a as usize] + raw.positions[b as usize]) * 0.5);
    raw.triangles.splice(face..=face, [[a, 8, c], [8, b, c], [a, b, 8]]);
    let (shape, report) = alone(raw);
    assert_eq!((report.count(NoteKind::FlatTriangle), report.count(NoteKind::InsideOut)), (1, 1));
    assert!((volume(&shape) - 8.0).abs() < 1e-4);
    for &triangle in &shape.triangles {
        triangle.iter().for_each(|&index| assert!(normal(&shape, index).dot(face_normal(&shape, triangle)) > 0.9999));
    }
}

#[test]
fn nearly_equal_vertices_are_welded_at_open_edges() {
    let mut random = Random(11);
    let mut raw = soup(&torus());
    raw.positions.iter_mut().for_each(|p| *p += DVec3::new(random.signed(), random.signed(), random.signed()) * 2e-7);
    let (shape, report) = alone(raw);
    assert_eq!((shape.positions.len(), shape.triangles.len()), (48 * 24, 48 * 24 * 2));
    assert_eq!(report.count(NoteKind::NearlyWelded), 48 * 24 * 5);
}

#[test]
fn repeated_triangles_go_and_sheets_of_two_sides_stay() {
    let mut raw = terrain();
    raw.triangles.extend_from_within(10..15);
    let (shape, report) = alone(raw);
    assert_eq!((shape.triangles.len(), report.count(NoteKind::RepeatedTriangle)), (800, 5));
    assert_eq!(shape.positions.len(), 441);

    let double = joined(terrain(), turned(terrain(), |_| true));
    let (assembly, report) = build_one(double);
    assert_sound(&assembly);
    assert!(report.is_empty(), "{report}");
    let shape = &assembly.shapes[0];
    assert_eq!((shape.triangles.len(), shape.positions.len()), (1600, 882));
    for (face, &triangle) in shape.triangles.iter().enumerate() {
        let up = if face < 800 { 1.0 } else { -1.0 };
        assert!(triangle.iter().all(|&index| normal(shape, index).z * up > 0.3 && hull(shape, index).z * up > 0.3));
    }
}

#[test]
fn the_files_normals_are_kept_unless_they_look_inwards() {
    let slanted = |raw: RawShape, sign: f32| {
        let normals = raw.positions.iter().map(|p| (p.as_vec3() + Vec3::X * 0.1) * sign).collect();
        RawShape { normals: RawNormals::PerVertex(normals), ..raw }
    };
    let expected = |p: Vec3| (p + Vec3::X * 0.1).normalize();
    for raw in [slanted(sphere(24, 12), 1.0), slanted(turned(sphere(24, 12), |_| true), -1.0)] {
        let (shape, report) = alone(raw);
        assert_eq!(report.count(NoteKind::NormalsDropped), 0);
        for (index, &p) in shape.positions.iter().enumerate() {
            assert!(normal(&shape, index as u32).dot(expected(p)) > 0.9999, "{p}");
        }
    }
    let (shape, report) = alone(slanted(sphere(24, 12), -1.0));
    assert!(report.count(NoteKind::NormalsDropped) > 1000);
    assert!(shape.positions.iter().enumerate().all(|(index, &p)| normal(&shape, index as u32).dot(p) > 0.99));

    // One for each corner, some of them missing or no direction.
    let raw = cube();
    let corners = vec![[0, 1, 9]; 12];
    let normals = RawNormals::PerCorner { normals: vec![Vec3::splat(f32::NAN), Vec3::ZERO], corners };
    assert_eq!(alone(RawShape { normals, ..raw }).0, alone(cube()).0);
}

#[test]
fn colours_part_vertices() {
    let mut raw = soup(&cube());
    raw.colors = (0..36).map(|index| if index < 6 { [255, 0, 0] } else { [0, 0, 255] }).collect();
    let (shape, _) = alone(raw.clone());
    assert_eq!(shape.positions.len(), 24);
    raw.colors[0] = [0, 255, 0];
    let (shape, _) = alone(raw);
    assert_eq!(shape.positions.len(), 25);
    assert_eq!(shape.colors[shape.triangles[0][0] as usize], [0, 255, 0]);
}

#[test]
fn size_and_place_change_nothing() {
    let raw =
        || turned(joined(soup(&cylinder(24)), mapped(torus(), |p| p * 0.2 + DVec3::X * 3.0)), |face| face % 5 == 0);
    let (reference, report) = build_one(raw());
    for (scale, shift) in [
        (1e-9, DVec3::ZERO),
        (1e30, DVec3::ZERO),
        (1e95, DVec3::ZERO),
        (1e-200, DVec3::ZERO),
        (1.0, DVec3::new(483_000.0, 5_431_000.0, 250.0)),
        (0.001, DVec3::new(483_000.0, 5_431_000.0, 250.0)),
    ] {
        let (moved, moved_report) = build_one(mapped(raw(), |p| p * scale + shift));
        assert_sound(&moved);
        // Where a millimetre stands at 5000 km, f64 has six digits left, and some triangles weld nearly.
        assert_eq!(moved_report.count(NoteKind::FaceTurned), report.count(NoteKind::FaceTurned));
        let (a, b) = (&reference.shapes[0], &moved.shapes[0]);
        assert_eq!(a.triangles, b.triangles, "{scale} {shift}");
        let factor = (moved.unit / scale) as f32;
        let tolerance = if scale == 0.001 { 1e-5 } else { 1e-6 };
        for index in 0..a.positions.len() {
            assert!(a.positions[index].distance(b.positions[index] * factor) < tolerance, "{scale} {shift}");
            assert!(normal(a, index as u32).distance(normal(b, index as u32)) < 1e-3);
            assert!(hull(a, index as u32).distance(hull(b, index as u32)) < 0.03);
        }
        assert!((moved.sphere.radius * factor / reference.sphere.radius - 1.0).abs() < 1e-3);
        let expected = reference.origin * scale + shift;
        assert!(moved.origin.distance(expected) < 1e-6 * scale.max(1e-3), "{} {expected}", moved.origin);
        if !(1e-4..1e6).contains(&scale) {
            assert!((0.5..2.0).contains(&moved.sphere.radius), "{}", moved.sphere.radius);
        }
    }
}

#[test]
fn a_shape_placed_once_gets_the_coordinates_of_the_scene() {
    let mirror =
        DAffine3::from_translation(DVec3::new(100.0, 0.0, 0.0)) * DAffine3::from_scale(DVec3::new(-1.0, 2.0, 1.0));
    let (assembly, report) = build(vec![cube(), torus()], vec![part(0, mirror)]);
    let assembly = assembly.expect("a cube");
    assert_sound(&assembly);
    // The torus is nowhere.
    assert!(assembly.shapes.len() == 1 && report.is_empty());
    assert_eq!(assembly.parts[0].world_from_shape, Affine3A::IDENTITY);
    assert_eq!(assembly.origin, DVec3::new(100.0, 0.0, 0.0));
    assert!((volume(&assembly.shapes[0]) - 16.0).abs() < 1e-4);
}

#[test]
fn a_shape_placed_twice_keeps_its_own_coordinates() {
    let apart = |x: f64, scale: DVec3| DAffine3::from_translation(DVec3::X * x) * DAffine3::from_scale(scale);
    let raw = mapped(cube(), |p| p + DVec3::new(1e5, 0.0, 0.0));
    let parts = vec![part(0, apart(0.0, DVec3::ONE)), part(0, apart(1e5 + 10.0, DVec3::ONE))];
    let (assembly, _) = build(vec![raw], parts);
    let assembly = assembly.expect("cubes");
    assert_sound(&assembly);
    let shape = &assembly.shapes[0];
    assert_eq!(shape.positions.iter().map(|p| p.abs().max_element()).fold(0.0, f32::max), 1.0);
    assert!((assembly.sphere.radius - 5e4).abs() < 10.0, "{:?}", assembly.sphere);
    let far = (assembly.parts[1].world_from_shape.translation - assembly.parts[0].world_from_shape.translation).x;
    assert!((f64::from(far) * assembly.unit - (1e5 + 10.0)).abs() < 1.0, "{far}");

    // A mirrored place stays, as the renderer draws it with the other front.
    let mirrored = vec![part(0, DAffine3::IDENTITY), part(0, apart(9.0, DVec3::new(-1.0, 1.0, 1.0)))];
    let assembly = build(vec![cube()], mirrored).0.expect("cubes");
    assert_sound(&assembly);
    assert!(assembly.parts[1].world_from_shape.matrix3.determinant() < 0.0);
    assert!((assembly.sphere.radius - DVec3::new(5.5, 1.0, 1.0).length() as f32).abs() < 0.02);
}

#[test]
fn tiny_shapes_placed_hugely_stay_in_single_precision() {
    let place = |x: f64| DAffine3::from_translation(DVec3::X * x) * DAffine3::from_scale(DVec3::splat(1e40));
    let assembly = build(vec![mapped(cube(), |p| p * 1e-40)], vec![part(0, place(0.0)), part(0, place(3.0))]).0;
    let assembly = assembly.expect("cubes");
    assert_sound(&assembly);
    assert!((assembly.sphere.radius - DVec3::new(2.5, 1.0, 1.0).length() as f32).abs() < 0.02);
}

#[test]
fn places_that_are_none_are_left_out() {
    let scaled = |factor: f64| DAffine3::from_scale(DVec3::splat(factor));
    let parts = vec![part(0, scaled(f64::NAN)), part(0, scaled(0.0)), part(0, scaled(1e308)), part(7, scaled(1.0))];
    let (assembly, report) = build(vec![cube()], parts.clone());
    assert!(assembly.is_none() && report.count(NoteKind::PartUnplaceable) == 4);
    let (assembly, _) = build(vec![cube()], parts.into_iter().chain([part(0, scaled(2.0))]).collect());
    assert!((assembly.expect("one").sphere.radius - 12.0_f32.sqrt()).abs() < 0.01);
}

#[test]
fn a_place_that_single_precision_cannot_hold_is_left_out() {
    // Flat shapes hide any scale across them.
    let flat = mapped(terrain(), |p| p.with_z(0.0));
    let place = |z: f64| DAffine3::from_translation(DVec3::X) * DAffine3::from_scale(DVec3::new(1.0, 1.0, z));
    let (assembly, report) = build(vec![flat], vec![part(0, place(1.0)), part(0, place(1e60))]);
    let assembly = assembly.expect("one sheet");
    assert_sound(&assembly);
    assert_eq!((assembly.parts.len(), report.count(NoteKind::PartUnplaceable)), (1, 1));
}

/// Triangles among few points, with copies, specks and wild numbers.
fn any_mesh(random: &mut Random) -> (Vec<RawShape>, Vec<super::RawPart>) {
    let num_shapes = 1 + random.below(3);
    let shapes = (0..num_shapes).map(|_| any_shape(random)).collect();
    let parts = (0..random.below(5))
        .map(|_| {
            let mut place =
                DAffine3::from_translation(DVec3::new(random.signed(), random.signed(), random.signed()) * 9.0);
            place.matrix3.x_axis *= random.signed() * 3.0;
            place.matrix3.y_axis = DVec3::new(random.signed(), random.signed(), random.signed());
            part(random.below(num_shapes), place)
        })
        .collect();
    (shapes, parts)
}

fn any_shape(random: &mut Random) -> RawShape {
    let num_positions = 1 + random.below(12);
    let coarse = random.below(2) == 1;
    let coordinate = |random: &mut Random| {
        let value = if coarse { (random.signed() * 1.4).round() } else { random.signed() };
        match random.below(60) {
            0 => value * 1e-7,
            1 => value * 1e60,
            2 => f64::NAN,
            _ => value,
        }
    };
    let position = |random: &mut Random| DVec3::new(coordinate(random), coordinate(random), coordinate(random));
    let positions: Vec<DVec3> = (0..num_positions).map(|_| position(random)).collect();
    let index = |random: &mut Random| {
        let is_wild = random.below(50) == 0;
        random.below(num_positions + u32::from(is_wild))
    };
    let triangles: Vec<[u32; 3]> =
        (0..random.below(40)).map(|_| [index(random), index(random), index(random)]).collect();
    let direction = |random: &mut Random| DVec3::new(random.signed(), random.signed(), random.signed()).as_vec3();
    let normals = match random.below(3) {
        0 => RawNormals::None,
        1 => RawNormals::PerVertex((0..random.below(num_positions + 2)).map(|_| direction(random)).collect()),
        _ => RawNormals::PerCorner {
            normals: (0..5).map(|_| direction(random)).collect(),
            corners: (0..triangles.len()).map(|_| [random.below(6), random.below(6), random.below(6)]).collect(),
        },
    };
    let colors = (0..random.below(2) * num_positions).map(|_| [random.below(2) as u8; 3]).collect();
    RawShape { positions, triangles, normals, colors }
}

#[test]
fn any_mesh_comes_out_sound() {
    let mut random = Random(2016);
    let mut num_built = 0;
    for _ in 0..4000 {
        let (shapes, parts) = any_mesh(&mut random);
        if let (Some(assembly), _) = build(shapes, parts) {
            assert_sound(&assembly);
            num_built += 1;
        }
    }
    assert!(num_built > 1500, "{num_built}");
}

#[test]
fn an_open_shape_has_no_thickness() {
    let raw = cube();
    let open = RawShape { triangles: raw.triangles[2..].to_vec(), ..raw };
    assert_eq!(alone(open).0.thickness, f32::INFINITY);
}
