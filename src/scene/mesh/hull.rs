//! Where the outline's shell lies.
//!
//! A shell of width w has its vertex at `p + w m`. It keeps the distance w from a face of normal n if `m . n = 1`: for the
//! three sides of a box's corner that is (1, 1, 1), which normals of unit length miss, so that the shell gets thin there.

use glam::{DMat3, DVec3, Vec3};

/// The longest vector: miters of sharper edges are cut.
const LONGEST: f64 = 4.0;
/// Weight of the mean direction against the faces. Ours: corners of a box are off by 0.13 %, and where normals hardly
/// differ, their noise is not blown up.
const MEAN_WEIGHT: f64 = 1e-3;
/// Cosine of the angle to the mean, within which all normals count as the same one: 1.8 degrees.
const SAME: f32 = 0.9995;

/// The vector `m` with `m . n = 1` for all faces around a place, as nearly as it goes; `faces` gives unit normals and the
/// angles by which they count, `mean` the unit mean of those, or zero, and `lowest` the least `n . mean`.
pub(super) fn hull_vector(faces: impl Iterator<Item = (Vec3, f32)> + Clone, mean: Vec3, lowest: f32) -> Vec3 {
    if lowest > SAME {
        return mean;
    }
    let (mut x, mut y, mut z, mut sum) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    let mut total = 0.0;
    for (normal, angle) in faces.clone() {
        let (n, weight) = (normal.as_dvec3(), f64::from(angle));
        let weighted = n * weight;
        (x, y, z) = (x + weighted * n.x, y + weighted * n.y, z + weighted * n.z);
        sum += weighted;
        total += weight;
    }
    let pull = MEAN_WEIGHT * total;
    let matrix = DMat3::from_cols(x, y, z) + DMat3::from_diagonal(DVec3::splat(pull));
    let solved = (matrix.inverse() * (sum + mean.as_dvec3() * pull)).as_vec3();
    if solved.is_finite()
        && f64::from(solved.length_squared()) <= LONGEST * LONGEST
        && faces.clone().all(|(normal, _)| normal.dot(solved) > 0.0)
    {
        return solved;
    }
    let nearest = faces.map(|(normal, _)| normal.dot(mean)).filter(|&dot| dot > 0.0).fold(1.0, f32::min);
    mean * (1.0 / nearest).min(LONGEST as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The vector for faces that all count alike.
    fn hull_of(normals: &[Vec3]) -> Vec3 {
        let mean = normals.iter().sum::<Vec3>().normalize_or_zero();
        let lowest = normals.iter().map(|normal| normal.dot(mean)).fold(1.0, f32::min);
        hull_vector(normals.iter().map(|&normal| (normal, 1.0)), mean, lowest)
    }

    #[test]
    fn boxes_have_whole_numbers() {
        assert_eq!(hull_of(&[Vec3::X, Vec3::X]), Vec3::X);
        assert!(hull_of(&[Vec3::X, Vec3::Y]).distance(Vec3::new(1.0, 1.0, 0.0)) < 3e-3);
        assert!(hull_of(&[Vec3::X, Vec3::Y, Vec3::NEG_Z]).distance(Vec3::new(1.0, 1.0, -1.0)) < 3e-3);
        // However many triangles a side has.
        assert!(hull_of(&[Vec3::X, Vec3::X, Vec3::X, Vec3::Y]).distance(Vec3::new(1.0, 1.0, 0.0)) < 3e-3);
    }

    #[test]
    fn a_cone_has_its_axis_over_the_cosine() {
        let slant = |angle: f32| Vec3::new(angle.cos() * 0.8, angle.sin() * 0.8, 0.6);
        let normals: Vec<Vec3> = (0..7).map(|i| slant(i as f32 * std::f32::consts::TAU / 7.0)).collect();
        assert!(hull_of(&normals).distance(Vec3::Z / 0.6) < 5e-3, "{}", hull_of(&normals));
    }

    #[test]
    fn blades_and_contradictions_are_cut() {
        // The miter of an edge of 10 degrees is 11.5 long.
        let half = 85_f32.to_radians();
        let blade = hull_of(&[Vec3::new(half.sin(), 0.0, half.cos()), Vec3::new(-half.sin(), 0.0, half.cos())]);
        assert!(blade.distance(Vec3::Z * 4.0) < 1e-4, "{blade}");
        let slot = hull_of(&[Vec3::X, Vec3::NEG_X, Vec3::Z]);
        assert!(slot.distance(Vec3::Z) < 1e-6, "{slot}");
        assert_eq!(hull_of(&[Vec3::X, Vec3::NEG_X]), Vec3::ZERO);
    }
}
