//! Where a shape is: its own frame, in which it is mended whatever its size and place.

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::{RawNormals, RawShape};

/// Coordinates beyond this are no positions: their cubes would leave f64.
pub(super) const FARTHEST: f64 = 1e100;

/// Whether a vertex can be drawn.
pub(super) fn is_position(p: DVec3) -> bool {
    p.abs().cmple(DVec3::splat(FARTHEST)).all()
}

/// A power of two. Exponents are cut at 1000, so that its reciprocal is a normal number too.
pub(super) fn power_of_two(exponent: f64) -> f64 {
    f64::from_bits(((1023 + exponent.clamp(-1000.0, 1000.0) as i64) as u64) << 52)
}

/// The largest power of two that is not above a length; 1 for none.
pub(super) fn power_below(length: f64) -> f64 {
    if length > 0.0 { power_of_two(length.log2().floor()) } else { 1.0 }
}

/// Box, middle and size of the vertices that triangles use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    /// Lower corner, in the coordinates of the shape.
    pub low: DVec3,
    /// Upper corner.
    pub high: DVec3,
}

impl Frame {
    /// The frame of the triangles that can be drawn; none if none can.
    pub fn of(raw: &RawShape) -> Option<Frame> {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for triangle in &raw.triangles {
            let Some(corners) = corners(&raw.positions, *triangle) else { continue };
            for p in corners {
                (low, high) = (low.min(p), high.max(p));
            }
        }
        (low.x <= high.x).then_some(Frame { low, high })
    }

    /// The middle of the box.
    pub fn middle(&self) -> DVec3 {
        self.low * 0.5 + self.high * 0.5
    }

    /// Half of the box's longest side.
    pub fn half(&self) -> f64 {
        (self.high * 0.5 - self.low * 0.5).max_element()
    }

    /// From the shape's coordinates to about -1..1 around its middle: `(p - middle) * scale`, where rounding errors are
    /// those of the file's own digits and nothing overflows.
    pub fn scale(&self) -> f64 {
        0.5 / power_below(self.half())
    }

    /// How far rounding of the file's coordinates may have moved a vertex, in the scaled frame.
    pub fn rounding(&self) -> f64 {
        let farthest = self.low.abs().max(self.high.abs()).max_element();
        4.0 * f64::EPSILON * (farthest * self.scale()).max(1.0)
    }
}

/// The corners of a triangle, if it can be drawn.
pub(super) fn corners(positions: &[DVec3], triangle: [u32; 3]) -> Option<[DVec3; 3]> {
    let [a, b, c] = triangle.map(|index| positions.get(index as usize).copied().filter(|&p| is_position(p)));
    Some([a?, b?, c?])
}

/// Moves a shape that is placed once to where it is placed. A mirroring placement turns the triangles over, so that they
/// stay counter-clockwise as seen from outside.
pub(super) fn bake(raw: &mut RawShape, place: &DAffine3) {
    if *place == DAffine3::IDENTITY {
        return;
    }
    raw.positions.iter_mut().for_each(|p| *p = place.transform_point3(*p));
    let mirrors = is_mirror(&place.matrix3);
    if let RawNormals::PerVertex(normals) | RawNormals::PerCorner { normals, .. } = &mut raw.normals {
        let turn = normal_matrix(&place.matrix3);
        normals.iter_mut().for_each(|normal| *normal = (turn * normal.as_dvec3()).normalize_or_zero().as_vec3());
    }
    if mirrors {
        raw.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        if let RawNormals::PerCorner { corners, .. } = &mut raw.normals {
            corners.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
    }
}

/// Whether a placement is finite and leaves more than a line of a shape.
pub(super) fn can_place(place: &DAffine3) -> bool {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = place.matrix3;
    let [p, q, r] = {
        let tame = tame(&place.matrix3);
        [tame.x_axis, tame.y_axis, tame.z_axis]
    };
    [x, y, z, place.translation].into_iter().all(is_position)
        && [p.cross(q), q.cross(r), r.cross(p)].iter().any(|normal| normal.length_squared() > 0.0)
}

/// The matrix with entries of at most 1: determinants of it cannot overflow.
fn tame(matrix: &DMat3) -> DMat3 {
    let largest = matrix.to_cols_array().into_iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
    if largest > 0.0 { *matrix * (1.0 / power_below(largest)) } else { *matrix }
}

/// Whether a placement turns left hands into right ones.
pub(super) fn is_mirror(matrix: &DMat3) -> bool {
    tame(matrix).determinant() < 0.0
}

/// The inverse transpose up to a positive factor; finite even where there is no inverse.
fn normal_matrix(matrix: &DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = tame(matrix);
    let sign = if is_mirror(matrix) { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z) * sign, z.cross(x) * sign, x.cross(y) * sign)
}

/// Directions to the corners, edges and faces of a cube, one of each opposite two.
const DIRECTIONS: [[i8; 3]; 13] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 1, 0],
    [1, -1, 0],
    [1, 0, 1],
    [1, 0, -1],
    [0, 1, 1],
    [0, 1, -1],
    [1, 1, 1],
    [1, 1, -1],
    [1, -1, 1],
    [1, -1, -1],
];

/// The points that lie farthest out in 26 directions [Larsson2008, EPOS-26].
pub(super) fn extremes<P: Copy + Into<DVec3>>(points: impl Iterator<Item = P>) -> Vec<P> {
    let directions = DIRECTIONS.map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into()));
    let mut ends: [Option<[(f64, P); 2]>; 13] = [None; 13];
    for point in points {
        let p: DVec3 = point.into();
        for (end, direction) in ends.iter_mut().zip(&directions) {
            let along = p.dot(*direction);
            let [low, high] = end.get_or_insert([(along, point); 2]);
            if along < low.0 {
                *low = (along, point);
            }
            if along > high.0 {
                *high = (along, point);
            }
        }
    }
    ends.into_iter().flatten().flatten().map(|(_, point)| point).collect()
}

/// A file's normal as a unit vector, if it is one.
pub(super) fn unit_normal(normal: Vec3) -> Option<Vec3> {
    normal.as_dvec3().try_normalize().map(|normal| normal.as_vec3())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_are_exact_over_all_sizes() {
        for (length, expected) in
            [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (0.75, 0.5), (1e100, 2_f64.powi(332)), (0.0, 1.0)]
        {
            assert_eq!(power_below(length), expected);
        }
        for length in [5e-324, 1e-300, 1e300, f64::MAX] {
            assert!(power_below(length).is_normal() && (1.0 / power_below(length)).is_normal());
        }
    }

    #[test]
    fn only_vertices_in_use_make_the_frame() {
        let mut raw =
            RawShape { positions: vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::splat(9.0)], ..RawShape::default() };
        assert_eq!(Frame::of(&raw), None);
        raw.triangles = vec![[0, 1, 2], [1, 2, 4]];
        let frame = Frame::of(&raw).expect("a triangle");
        assert_eq!((frame.low, frame.high, frame.middle()), (DVec3::ZERO, DVec3::ONE, DVec3::splat(0.5)));
        assert_eq!((frame.half(), frame.scale()), (0.5, 1.0));
        raw.positions[2].y = f64::NAN;
        assert_eq!(Frame::of(&raw), None);
    }

    #[test]
    fn a_mirror_keeps_the_outside_outside() {
        let normals = RawNormals::PerVertex(vec![Vec3::Z; 3]);
        let mut raw = RawShape {
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            triangles: vec![[0, 1, 2]],
            normals,
            colors: Vec::new(),
        };
        bake(&mut raw, &DAffine3::from_scale(DVec3::new(1.0, 1.0, -3.0)));
        assert_eq!(raw.triangles, [[0, 2, 1]]);
        let RawNormals::PerVertex(normals) = raw.normals else { panic!("normals") };
        assert_eq!(normals, [Vec3::NEG_Z; 3]);
    }

    #[test]
    fn normals_of_uneven_scales_stay_upright() {
        let normals = RawNormals::PerVertex(vec![Vec3::new(1.0, 1.0, 0.0)]);
        let mut raw = RawShape { positions: vec![DVec3::ZERO], normals, ..RawShape::default() };
        bake(&mut raw, &DAffine3::from_scale(DVec3::new(2.0, 1.0, 1.0)));
        let RawNormals::PerVertex(normals) = raw.normals else { panic!("normals") };
        assert!(normals[0].distance(Vec3::new(1.0, 2.0, 0.0).normalize()) < 1e-6);
    }

    #[test]
    fn extremes_hold_the_corners_of_a_box() {
        let points = (0..1000).map(|i| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100)));
        let found = extremes(points);
        assert!(found.len() == 26 && found.contains(&DVec3::ZERO) && found.contains(&DVec3::new(9.0, 0.0, 9.0)));
    }
}
