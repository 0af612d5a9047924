//! How a shape bends at its vertices, and which of its edges are creases: found once, where a style asks.
//!
//! Normals that are interpolated over a triangle are a linear field, and its divergence over the triangle's plane is the sum of
//! both principal curvatures of the surface that the normals describe. Triangles whose three normals are equal are flat and have
//! no say in the mean at their corners, so that a fillet does not fade towards the plates that it joins.

use std::collections::HashMap;

use glam::DVec3;

use super::{Shape, unpack_normal};

/// Cosine between normals on both sides from which on an edge is a crease: 8 degrees.
const CREASE: f32 = 0.990_268;

/// The bending of a shape.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bending {
    /// Sum of the principal curvatures at each vertex, negative where convex, over units of the shape.
    pub kappa: Vec<f32>,
    /// For each triangle a bit for each of its edges, from its first, second and third corner on, that is a crease or ends the
    /// surface, and above them a bit for each of its corners at which any such edge begins or ends.
    pub creases: Vec<u8>,
}

impl Bending {
    /// The bending of a shape.
    pub fn new(shape: &Shape) -> Bending {
        Bending { kappa: vertex_kappa(shape), creases: creases(shape) }
    }
}

/// Whether the normals of a triangle are equal.
pub fn is_flat(shape: &Shape, triangle: &[u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|vertex| shape.normals.get(vertex as usize));
    a == b && a == c
}

/// Sum of the principal curvatures over a triangle and twice its area, in units of the shape; none where it has no area.
pub fn triangle_kappa(shape: &Shape, triangle: &[u32; 3]) -> Option<(f64, f64)> {
    let [a, b, c] = triangle.map(|vertex| shape.positions[vertex as usize].as_dvec3());
    let across = (b - a).cross(c - a);
    let area = across.length();
    if is_flat(shape, triangle) || area <= 0.0 {
        return None;
    }
    let normal = |k: usize| unpack_normal(shape.normals[triangle[k] as usize]).as_dvec3();
    let (toward, inverse) = (across / area, 1.0 / area);
    // Gradients of the shares of the second and third corner.
    let grow_b = (c - a).cross(toward) * inverse;
    let grow_c = toward.cross(b - a) * inverse;
    let grow = |gradient: DVec3, from: DVec3, to: DVec3| gradient.dot(to - from);
    let (na, nb, nc) = (normal(0), normal(1), normal(2));
    // In the middle the interpolated normal is shorter than 1 and bends as much more.
    let shortened = ((na + nb + nc) / 3.0).length().max(0.1);
    let divergence = grow(grow_b, na, nb) + grow(grow_c, na, nc);
    Some((-divergence / shortened, area))
}

/// The mean over the triangles around each vertex, by area.
fn vertex_kappa(shape: &Shape) -> Vec<f32> {
    let mut sums = vec![(0.0f64, 0.0f64); shape.positions.len()];
    for triangle in &shape.triangles {
        let Some((kappa, area)) = triangle_kappa(shape, triangle) else { continue };
        for vertex in triangle {
            let (sum, weight) = &mut sums[*vertex as usize];
            *sum += kappa * area;
            *weight += area;
        }
    }
    sums.into_iter().map(|(sum, weight)| if weight > 0.0 { (sum / weight) as f32 } else { 0.0 }).collect()
}

/// Edges whose sides have different normals, and those without another side.
fn creases(shape: &Shape) -> Vec<u8> {
    let places = places(shape);
    // Each edge in the order of its places, with the triangles and edges that have it.
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(shape.triangles.len() * 3);
    for (triangle, vertices) in (0u32..).zip(&shape.triangles) {
        let at = vertices.map(|vertex| places[vertex as usize]);
        for k in 0..3 {
            let (from, to) = (at[k], at[(k + 1) % 3]);
            sides.push(([from.min(to), from.max(to)], triangle * 3 + k as u32));
        }
    }
    sides.sort_unstable();
    let mut creases = vec![0u8; shape.triangles.len()];
    let mut is_on_crease = vec![false; places.len()];
    // The normal of a side at one of its places.
    let normal = |side: u32, place: u32| {
        let vertices = &shape.triangles[side as usize / 3];
        let vertex = vertices.iter().find(|vertex| places[**vertex as usize] == place);
        vertex.and_then(|vertex| shape.normals.get(*vertex as usize)).copied().unwrap_or(0)
    };
    for edge in sides.chunk_by(|a, b| a.0 == b.0) {
        let parts = |a: u32, b: u32| {
            edge[0].0.iter().any(|&place| {
                let (a, b) = (normal(a, place), normal(b, place));
                a != b && unpack_normal(a).dot(unpack_normal(b)) < CREASE
            })
        };
        let is_crease = match edge {
            [a, b] => parts(a.1, b.1),
            _ => true,
        };
        if is_crease {
            edge.iter().for_each(|(_, side)| creases[*side as usize / 3] |= 1 << (side % 3));
            edge[0].0.iter().for_each(|place| is_on_crease[*place as usize] = true);
        }
    }
    for (triangle, bits) in shape.triangles.iter().zip(&mut creases) {
        let corners = (0..3).filter(|&k| is_on_crease[places[triangle[k] as usize] as usize]);
        *bits |= corners.map(|k| 8 << k).sum::<u8>();
    }
    creases
}

/// For each vertex a number that all vertices at its place share.
fn places(shape: &Shape) -> Vec<u32> {
    let mut known: HashMap<[u32; 3], u32> = HashMap::with_capacity(shape.positions.len());
    let mut places = Vec::with_capacity(shape.positions.len());
    for (vertex, position) in (0u32..).zip(&shape.positions) {
        // Adding zero makes -0 the same as 0.
        let key = position.to_array().map(|value| (value + 0.0).to_bits());
        places.push(*known.entry(key).or_insert(vertex));
    }
    places
}

#[cfg(test)]
mod tests {
    use super::super::solids::{build_one, cube, cylinder, mapped, sphere, torus_of};
    use super::*;

    fn bending(shape: &Shape) -> Vec<(DVec3, f64)> {
        let at = |vertex: usize| shape.positions[vertex].as_dvec3();
        shape.bending().kappa.iter().enumerate().map(|(vertex, kappa)| (at(vertex), f64::from(*kappa))).collect()
    }

    #[test]
    fn a_cylinder_bends_by_one_over_its_radius_and_its_caps_do_not() {
        let (assembly, _) = build_one(cylinder(64));
        let shape = &assembly.shapes[0];
        for triangle in &shape.triangles {
            let side = !is_flat(shape, triangle);
            for vertex in triangle {
                let kappa = shape.bending().kappa[*vertex as usize];
                let due = if side { -1.0 } else { 0.0 };
                assert!((kappa - due).abs() < 0.003, "{kappa} for {due}");
            }
        }
        // The rims of both caps, from both sides.
        let count: u32 = shape.bending().creases.iter().map(|bits| (bits & 7).count_ones()).sum();
        assert_eq!(count, 4 * 64);
    }

    #[test]
    fn a_ring_bends_as_its_formula_says() {
        let (assembly, _) = build_one(torus_of(240, 120));
        let part = assembly.parts[0].world_from_shape;
        let shape = &assembly.shapes[0];
        let (mut error, mut sum) = (0.0, 0.0);
        for (at, kappa) in bending(shape) {
            let at = part.transform_point3(at.as_vec3()).as_dvec3();
            let ring = (at.x * at.x + at.y * at.y).sqrt();
            let cosine = (ring - 1.0) / 0.3;
            let due = -(1.0 / 0.3 + cosine / ring);
            error += (kappa - due).powi(2);
            sum += due * due;
        }
        let relative = (error / sum).sqrt();
        assert!(relative < 0.004, "{relative}");
        assert!(shape.bending().creases.iter().all(|bits| *bits == 0));
    }

    #[test]
    fn a_bowl_bends_the_other_way_and_size_divides() {
        let (assembly, _) = build_one(mapped(sphere(96, 48), |p| p * 5.0));
        let kappas: Vec<f64> = bending(&assembly.shapes[0]).into_iter().map(|(_, kappa)| kappa).collect();
        let mean = kappas.iter().sum::<f64>() / kappas.len() as f64;
        assert!(
            (mean + 0.4 * f64::from(assembly.parts[0].world_from_shape.matrix3.x_axis.length())).abs() < 0.004,
            "{mean}"
        );
        let mut inside = assembly.shapes[0].clone();
        inside.normals.iter_mut().for_each(|normal| {
            *normal = super::super::pack_normal(-unpack_normal(*normal));
        });
        let inside = Bending::new(&inside);
        assert!(inside.kappa.iter().all(|kappa| *kappa > 0.3));
    }

    #[test]
    fn a_cube_has_creases_along_its_edges_and_not_across_its_faces() {
        let (assembly, _) = build_one(cube());
        let shape = &assembly.shapes[0];
        assert!(shape.bending().kappa.iter().all(|kappa| *kappa == 0.0));
        assert!(
            shape.bending().creases.iter().all(|bits| (bits & 7).count_ones() == 2 && bits >> 3 == 7),
            "{:?}",
            shape.bending().creases
        );
    }

    #[test]
    fn an_open_edge_is_a_crease() {
        let sheet = mapped(super::super::solids::terrain(), |p| DVec3::new(p.x, p.y, 0.0));
        let (assembly, _) = build_one(sheet);
        let count: u32 = assembly.shapes[0].bending().creases.iter().map(|bits| (bits & 7).count_ones()).sum();
        assert_eq!(count, 80, "20 on each side");
    }
}
