//! Exact ray casts of spheres, truncated cones and triangles, in double precision.

use glam::DVec3;

/// A line of sight, or of light. `direction` need not be of unit length: `t` counts in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes.
    pub direction: DVec3,
}

impl Ray {
    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// Entry and exit of a sphere. From the point of closest approach, which keeps its digits far from the sphere.
pub fn sphere_span(ray: Ray, center: DVec3, radius: f64) -> Option<[f64; 2]> {
    let to_center = center - ray.origin;
    let inverse = 1.0 / ray.direction.length_squared();
    let middle = to_center.dot(ray.direction) * inverse;
    let off = to_center - middle * ray.direction;
    let left = radius * radius - off.length_squared();
    let half = (left * inverse).sqrt();
    (left >= 0.0).then_some([middle - half, middle + half])
}

/// Entry and exit of a truncated cone with flat caps, from `a` (radius `radii[0]`) to `b`; equal radii make a cylinder.
pub fn cone_span(ray: Ray, a: DVec3, b: DVec3, radii: [f64; 2]) -> Option<[f64; 2]> {
    let height = a.distance(b);
    let axis = (b - a) / height;
    // The ray's start, moved next to the cone.
    let shift = (0.5 * (a + b) - ray.origin).dot(ray.direction) / ray.direction.length_squared();
    let start = ray.at(shift) - a;
    let (start_axial, slope_axial) = (start.dot(axis), ray.direction.dot(axis));
    let (start_flat, slope_flat) = (start - start_axial * axis, ray.direction - slope_axial * axis);
    let taper = (radii[1] - radii[0]) / height;
    let (radius_start, radius_slope) = (radii[0] + taper * start_axial, taper * slope_axial);
    let qa = slope_flat.length_squared() - radius_slope * radius_slope;
    let qb = start_flat.dot(slope_flat) - radius_start * radius_slope;
    let qc = start_flat.length_squared() - radius_start * radius_start;
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    if slope_axial.abs() > 1e-15 {
        let ends = [-start_axial / slope_axial, (height - start_axial) / slope_axial];
        (enter, leave) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    } else if start_axial < 0.0 || start_axial > height {
        return None;
    }
    if qa > 1e-15 {
        let left = qb * qb - qa * qc;
        if left < 0.0 {
            return None;
        }
        let root = left.sqrt();
        enter = enter.max((-qb - root) / qa);
        leave = leave.min((-qb + root) / qa);
    } else if qc > 0.0 {
        return None;
    }
    (enter <= leave).then_some([enter + shift, leave + shift])
}

/// Outward normal of a cylinder at a point of it: of its side, or of the cap that the point lies on.
pub fn cylinder_normal(point: DVec3, a: DVec3, b: DVec3, radius: f64) -> DVec3 {
    let height = a.distance(b);
    let axis = (b - a) / height;
    let along = (point - a).dot(axis);
    let flat = point - a - along * axis;
    // Rounding leaves the point beside both surfaces: it is on the nearer one.
    if along.min(height - along).abs() < (radius - flat.length()).abs() {
        return if along < 0.5 * height { -axis } else { axis };
    }
    flat.normalize_or(axis)
}

/// Where a ray meets a triangle, from either side: `t`, and the shares of the corners [Moller1997 §2].
pub fn triangle_hit(ray: Ray, [a, b, c]: [DVec3; 3]) -> Option<(f64, DVec3)> {
    let (along_b, along_c) = (b - a, c - a);
    let across = along_b.cross(along_c);
    let facing = ray.direction.dot(across);
    if facing == 0.0 {
        return None;
    }
    let from_a = ray.origin - a;
    let around = from_a.cross(ray.direction);
    let (share_b, share_c) = (-around.dot(along_c) / facing, around.dot(along_b) / facing);
    let share_a = 1.0 - share_b - share_c;
    (share_a >= 0.0 && share_b >= 0.0 && share_c >= 0.0)
        .then(|| (-from_a.dot(across) / facing, DVec3::new(share_a, share_b, share_c)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOWN: DVec3 = DVec3::NEG_Z;

    #[test]
    fn a_sphere_is_met_at_its_radius_from_any_distance() {
        for far in [5.0, 1e3, 1e7] {
            let ray = Ray { origin: DVec3::new(0.6, 0.0, far), direction: 2.0 * DOWN };
            let [near, leave] = sphere_span(ray, DVec3::ZERO, 1.0).expect("a hit");
            assert!((2.0 * near - (far - 0.8)).abs() < 1e-15 * far.powi(2).max(1e2), "{far}: {near}");
            assert!((2.0 * (leave - near) - 1.6).abs() < 1e-15 * far.powi(2).max(1e2));
        }
        let beside = Ray { origin: DVec3::new(1.0 + 1e-12, 0.0, 5.0), direction: DOWN };
        assert_eq!(sphere_span(beside, DVec3::ZERO, 1.0), None);
    }

    #[test]
    fn a_cylinder_has_sides_and_caps() {
        let (a, b) = (DVec3::new(-1.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0));
        let across = Ray { origin: DVec3::new(0.3, 0.3, 4.0), direction: DOWN };
        let [near, far] = cone_span(across, a, b, [0.5; 2]).expect("a hit");
        assert!((near - 3.6).abs() < 1e-15 && (far - 4.4).abs() < 1e-14);
        let along = Ray { origin: DVec3::new(-4.0, 0.2, 0.1), direction: DVec3::X };
        assert_eq!(cone_span(along, a, b, [0.5; 2]), Some([3.0, 5.0]));
        assert_eq!(cylinder_normal(DVec3::new(-1.0, 0.2, 0.1), a, b, 0.5), DVec3::NEG_X);
        assert!((cylinder_normal(across.at(near), a, b, 0.5) - DVec3::new(0.0, 0.6, 0.8)).length() < 1e-15);
        let beyond = Ray { origin: DVec3::new(1.01, 0.0, 4.0), direction: DOWN };
        assert_eq!(cone_span(beyond, a, b, [0.5; 2]), None);
        // Half as wide in the middle between radii 0 and 1.
        let middle = Ray { origin: DVec3::new(0.0, 0.0, 4.0), direction: DOWN };
        let [near, _] = cone_span(middle, a, b, [0.0, 1.0]).expect("a hit");
        assert!((near - 3.5).abs() < 1e-15);
    }

    #[test]
    fn a_triangle_is_met_from_both_sides_and_nowhere_else() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for direction in [DOWN, DVec3::Z] {
            let ray = Ray { origin: DVec3::new(0.2, 0.3, 0.0) - 2.0 * direction, direction };
            let (t, shares) = triangle_hit(ray, corners).expect("a hit");
            assert!((t - 2.0).abs() < 1e-15 && (shares - DVec3::new(0.5, 0.2, 0.3)).length() < 1e-15);
        }
        let beside = Ray { origin: DVec3::new(0.51, 0.5, 2.0), direction: DOWN };
        assert_eq!(triangle_hit(beside, corners), None);
        let within = Ray { origin: DVec3::new(-1.0, 0.1, 0.0), direction: DVec3::X };
        assert_eq!(triangle_hit(within, corners), None);
    }
}
