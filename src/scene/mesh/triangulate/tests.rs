use super::*;

/// Cuts a polygon, checks what always holds, and answers whether it was covered.
fn cut(corners: &[DVec3]) -> (Vec<[u32; 3]>, bool) {
    let mut triangles = Vec::new();
    let is_covered = Triangulator::default().cut(corners, &mut triangles);
    assert_eq!(triangles.len(), corners.len().saturating_sub(2));
    assert!(triangles.as_flattened().iter().all(|&corner| (corner as usize) < corners.len()));
    (triangles, is_covered)
}

fn area_vector(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    (b - a).cross(c - a) * 0.5
}

/// The sum of areas must be the length of the vector area: nothing is covered twice, nothing lies outside.
fn assert_covers(corners: &[DVec3], tolerance: f64) {
    let (triangles, is_covered) = cut(corners);
    let sum: f64 =
        triangles.iter().map(|t| t.map(|i| corners[i as usize])).map(|[a, b, c]| area_vector(a, b, c).length()).sum();
    let vector: DVec3 = (1..corners.len() - 1).map(|i| area_vector(corners[0], corners[i], corners[i + 1])).sum();
    assert!(is_covered && (sum - vector.length()).abs() <= tolerance * sum, "{sum} {vector}");
    // All triangles face the way the polygon does.
    for [a, b, c] in triangles.iter().map(|t| t.map(|i| corners[i as usize])) {
        assert!(area_vector(a, b, c).dot(vector) >= -tolerance * vector.length_squared());
    }
    // Every edge of the polygon is an edge of exactly one triangle.
    let count = corners.len() as u32;
    let mut edges: Vec<_> = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
    edges.sort_unstable();
    for i in 0..count {
        assert_eq!(edges.iter().filter(|&&edge| edge == (i, (i + 1) % count)).count(), 1, "edge {i}");
    }
}

/// A plane that is along no axis, far from the origin.
fn tilted(points: impl IntoIterator<Item = (f64, f64)>) -> Vec<DVec3> {
    let (u, v) = (DVec3::new(2.0, 1.0, -1.0).normalize(), DVec3::new(0.0, 1.0, 1.0).normalize());
    points.into_iter().map(|(x, y)| DVec3::new(100.0, -50.0, 30.0) + u * x + v * y).collect()
}

/// A star of `count` points and as many notches.
fn star(count: u32) -> Vec<DVec3> {
    tilted((0..count * 2).map(|i| {
        let (radius, angle) = (1.0 + f64::from(i % 2) * 2.0, f64::from(i) * std::f64::consts::PI / f64::from(count));
        (radius * angle.cos(), radius * angle.sin())
    }))
}

/// Two arms around each other.
fn spiral(count: u32) -> Vec<DVec3> {
    let at = |i: u32, inset: f64| {
        let turn = f64::from(i) * 0.05;
        ((turn + inset) * turn.cos(), (turn + inset) * turn.sin())
    };
    tilted((0..count / 2).map(|i| at(i + 40, 2.0)).chain((0..count / 2).rev().map(|i| at(i + 40, 0.0))))
}

#[test]
fn quads_are_cut_along_the_diagonal_that_lies_inside() {
    assert_eq!(cut(&tilted([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])).0, [[0, 1, 2], [0, 2, 3]]);
    let dart = tilted([(0.0, 0.0), (2.0, -1.0), (0.5, 0.0), (2.0, 1.0)]);
    assert_covers(&dart, 1e-12);
    let other = tilted([(2.0, -1.0), (0.5, 0.0), (2.0, 1.0), (0.0, 0.0)]);
    assert_eq!(cut(&other).0, [[1, 2, 3], [1, 3, 0]]);
    assert_covers(&other, 1e-12);
}

#[test]
fn concave_polygons_are_covered_once() {
    let comb = (0..40).map(|i| (f64::from(i), f64::from(i % 2) * 7.0)).chain([(39.0, -1.0), (0.0, -1.0)]);
    let mut comb = tilted(comb);
    assert_covers(&comb, 1e-9);
    comb.reverse();
    assert_covers(&comb, 1e-9);
    assert_covers(&star(7), 1e-9);
    assert_covers(&spiral(300), 1e-9);
}

#[test]
fn five_thousand_corners_are_cut_within_the_limit_of_work() {
    let circle = tilted((0..5000).map(|i| (f64::from(i) * std::f64::consts::TAU / 5000.0).sin_cos()));
    assert_covers(&circle, 1e-9);
    for polygon in [star(2500), spiral(5000)] {
        let (mut triangulator, mut triangles) = (Triangulator::default(), Vec::new());
        assert!(triangulator.cut(&polygon, &mut triangles));
        assert!(triangulator.work < WORK_PER_CORNER / 2 * 5000, "{}", triangulator.work);
    }
}

#[test]
fn holes_joined_by_double_edges_and_double_corners_are_no_obstacle() {
    let outer = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (0.0, 0.0)];
    let hole = [(1.0, 1.0), (1.0, 3.0), (3.0, 3.0), (3.0, 1.0), (1.0, 1.0)];
    let corners = tilted(outer.into_iter().chain(hole));
    let (triangles, is_covered) = cut(&corners);
    let sum: f64 =
        triangles.iter().map(|t| t.map(|i| corners[i as usize])).map(|[a, b, c]| area_vector(a, b, c).length()).sum();
    assert!(is_covered && (sum - 12.0).abs() < 1e-9, "{sum}");
    let doubled = tilted([(0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.2), (0.5, 0.2), (0.0, 1.0)]);
    assert!(cut(&doubled).1);
    // Corners along straight edges.
    assert_covers(&tilted([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (2.0, 2.0), (0.0, 2.0), (0.0, 1.0)]), 1e-12);
}

#[test]
fn polygons_that_are_not_quite_flat_are_cut_as_seen_along_their_normal() {
    let mut bent = star(20);
    for (i, corner) in bent.iter_mut().enumerate() {
        *corner += DVec3::new(0.0, 1.0, -1.0) * if i % 3 == 0 { 0.01 } else { -0.01 };
    }
    assert_covers(&bent, 0.01);
}

#[test]
fn size_does_not_matter() {
    for scale in [1e-150, 1e-9, 1e30, 1e100] {
        let large: Vec<DVec3> =
            star(9).iter().map(|&corner| (corner - DVec3::new(100.0, -50.0, 30.0)) * scale).collect();
        assert!(cut(&large).1, "{scale}");
    }
}

#[test]
fn what_has_no_area_or_crosses_itself_is_cut_all_the_same() {
    assert!(!cut(&[DVec3::ONE; 9]).1);
    assert!(!cut(&tilted((0..50).map(|i| (f64::from(i), 0.0)))).1);
    let bow = tilted([(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 1.0)]);
    assert!(!cut(&bow).1);
    let pentagram = tilted((0..5).map(|i| (f64::from(i * 2) * std::f64::consts::TAU / 5.0).sin_cos()));
    cut(&pentagram);
    for count in 0..3 {
        assert!(cut(&vec![DVec3::ZERO; count]).0.is_empty());
    }
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f64
    };
    for _ in 0..300 {
        let noise: Vec<DVec3> = (0..60).map(|_| DVec3::new(random() % 8.0, random() % 8.0, random() % 2.0)).collect();
        cut(&noise);
    }
}
