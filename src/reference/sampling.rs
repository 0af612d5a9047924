//! Numbers that are spread evenly and the same in every run, on any number of threads.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// A seed of a place: pixel, sample of it, and what the numbers are for.
pub fn seed(pixel: [u32; 2], sample: u32, purpose: u32) -> u64 {
    let place = u64::from(pixel[0]) | u64::from(pixel[1]) << 20 | u64::from(sample) << 40 | u64::from(purpose) << 56;
    mixed(place)
}

/// Well-mixed bits of a number [Steele2014, the finaliser of SplitMix].
fn mixed(value: u64) -> u64 {
    let mut bits = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// A point of the unit square that belongs to a seed.
pub fn square_point(seed: u64) -> DVec2 {
    let bits = mixed(seed);
    let part = |bits: u64| (bits & 0xffff_ffff) as f64 / 4_294_967_296.0;
    DVec2::new(part(bits), part(bits >> 32))
}

/// Point `index` of `count` points that cover the unit square evenly, moved by the seed's own shift: the sequence of the
/// plastic number's powers [Roberts2018, throughout].
pub fn spread(index: u32, seed: u64) -> DVec2 {
    const STEP: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);
    (square_point(seed) + f64::from(index) * STEP).fract()
}

/// A point of the unit square as one of the unit disc, areas kept.
pub fn disc_point(point: DVec2) -> DVec2 {
    point.x.sqrt() * DVec2::from_angle(TAU * point.y)
}

/// A point of the unit square as a direction around `normal`, as likely as its cosine.
pub fn cosine_direction(point: DVec2, normal: DVec3) -> DVec3 {
    let flat = disc_point(point);
    let (side, other) = normal.any_orthonormal_pair();
    flat.x * side + flat.y * other + (1.0 - point.x).max(0.0).sqrt() * normal
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_points_integrate_well() {
        for seed in 0..20 {
            let mean = |of: &dyn Fn(DVec2) -> f64| (0..1024).map(|i| of(spread(i, seed))).sum::<f64>() / 1024.0;
            assert!((mean(&|p| p.x * p.y) - 0.25).abs() < 2e-3, "{seed}");
            assert!((mean(&|p| f64::from(p.x + p.y < 1.0)) - 0.5).abs() < 4e-3, "{seed}");
        }
    }

    #[test]
    fn directions_are_as_likely_as_their_cosine() {
        let normal = DVec3::new(1.0, 2.0, -0.5).normalize();
        let cosines: Vec<f64> = (0..4096).map(|i| cosine_direction(spread(i, 3), normal).dot(normal)).collect();
        assert!(cosines.iter().all(|cosine| *cosine >= 0.0));
        // The mean of the cosine under a density of cosine / pi is 2/3.
        assert!((cosines.iter().sum::<f64>() / 4096.0 - 2.0 / 3.0).abs() < 1e-3);
    }

    #[test]
    fn seeds_of_neighbours_differ() {
        let mut all: Vec<u64> =
            (0..64).flat_map(|x| (0..64).flat_map(move |y| (0..4).map(move |s| seed([x, y], s, 1)))).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 64 * 64 * 4);
    }
}
