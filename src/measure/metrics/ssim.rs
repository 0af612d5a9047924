//! Structural similarity, in its published form.
//!
//! Method: [Wang2004 §III.B, eq. 13], with the window and constants of [Wang2004 §III.C]. On luma: display values
//! weighted by the luminances of sRGB's primaries [IEC61966, part 2-1]; the paper has grey pictures only.
//! Where we differ: the authors' code leaves out the 5 pixels along each border; here the window is cut there and its
//! weights sum to 1 again, so that each pixel has a value.

use super::bands;
use super::picture::Picture;

/// Reach of the window of 11x11 pixels, and the standard deviation of its Gaussian, in pixels [Wang2004 §III.C].
const RADIUS_PX: usize = 5;
const SIGMA_PX: f64 = 1.5;

/// `(K L)^2` with K1 = 0.01, K2 = 0.03 and values of 0..1 [Wang2004 §III.C].
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// Similarity of each pixel's surroundings: 1 where they are the same, -1 at the least. Pictures of one size.
pub(super) fn map(reference: &Picture, test: &Picture) -> Vec<f32> {
    let (width, height) = (reference.size[0] as usize, reference.size[1] as usize);
    let mut map = vec![0.0; width * height];
    let weights: [f64; 2 * RADIUS_PX + 1] =
        std::array::from_fn(|tap| (-(tap as f64 - RADIUS_PX as f64).powi(2) / (2.0 * SIGMA_PX * SIGMA_PX)).exp());
    // The weights that lie inside, for windows at each place of a side.
    let sums = |side: usize| -> Vec<f64> {
        (0..side).map(|at| window(at, side).map(|near| weights[near + RADIUS_PX - at]).sum()).collect()
    };
    let (sums_x, sums_y) = (sums(width), sums(height));
    bands::fill(&mut map, width, |rows, band| {
        let near_rows = rows.start.saturating_sub(RADIUS_PX)..(rows.end + RADIUS_PX).min(height);
        let filtered: Vec<Vec<[f64; 5]>> = near_rows
            .clone()
            .map(|y| {
                let row = y * width..(y + 1) * width;
                let moments: Vec<[f64; 5]> = reference.rgb[row.clone()]
                    .iter()
                    .zip(&test.rgb[row])
                    .map(|(a, b)| (luma(*a), luma(*b)))
                    .map(|(a, b)| [a, b, a * a, b * b, a * b])
                    .collect();
                (0..width)
                    .map(|x| {
                        let taps = window(x, width).map(|near| (weights[near + RADIUS_PX - x], &moments[near]));
                        weighted(taps, sums_x[x])
                    })
                    .collect()
            })
            .collect();
        for (y, band_row) in rows.zip(band.chunks_exact_mut(width)) {
            for (x, value) in band_row.iter_mut().enumerate() {
                let taps =
                    window(y, height).map(|near| (weights[near + RADIUS_PX - y], &filtered[near - near_rows.start][x]));
                *value = similarity(weighted(taps, sums_y[y])) as f32;
            }
        }
    });
    map
}

/// The places of a window around `at` that lie on the side.
fn window(at: usize, side: usize) -> std::ops::Range<usize> {
    at.saturating_sub(RADIUS_PX)..(at + RADIUS_PX + 1).min(side)
}

fn weighted<'a>(taps: impl Iterator<Item = (f64, &'a [f64; 5])>, sum: f64) -> [f64; 5] {
    let mut total = [0.0; 5];
    for (weight, moments) in taps {
        for (total, moment) in total.iter_mut().zip(moments) {
            *total += weight * moment;
        }
    }
    total.map(|total| total / sum)
}

/// [Wang2004 eq. 13] from the means of a, b, a², b² and ab.
fn similarity([a, b, aa, bb, ab]: [f64; 5]) -> f64 {
    let (variances, covariance) = (aa - a * a + (bb - b * b), ab - a * b);
    (2.0 * a * b + C1) * (2.0 * covariance + C2) / ((a * a + b * b + C1) * (variances + C2))
}

/// Luma of display values.
fn luma([r, g, b]: [f32; 3]) -> f64 {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::metrics::testing::{noise, picture};

    #[test]
    fn identical_pictures_are_one_everywhere() {
        let noise = noise([33, 70], 1);
        assert!(map(&noise, &noise).iter().all(|value| *value == 1.0));
    }

    #[test]
    fn flat_pictures_differ_by_their_means_alone() {
        let (a, b) = (picture([20, 13], |_, _| [0.2; 3]), picture([20, 13], |_, _| [0.6; 3]));
        // (2 0.2 0.6 + C1) / (0.2² + 0.6² + C1).
        let expected = 0.2401 / 0.4001;
        assert!(map(&a, &b).iter().all(|value| (f64::from(*value) - expected).abs() < 1e-6));
    }

    #[test]
    fn inverted_structure_is_negative() {
        let stripes = |x: usize, _| [if x.is_multiple_of(2) { 0.25 } else { 0.75 }; 3];
        let (a, b) = (picture([64, 64], stripes), picture([64, 64], |x, y| stripes(x + 1, y)));
        // Mean 1/2 for both; the variance of each is 1/16, the covariance -1/16.
        let expected = (-2.0 / 16.0 + C2) / (2.0 / 16.0 + C2);
        let value = f64::from(map(&a, &b)[32 * 64 + 32]);
        assert!((value - expected).abs() < 1e-3, "{value}, not {expected}");
    }

    #[test]
    fn separable_sums_are_the_windows_of_the_paper() {
        let (a, b) = (noise([23, 90], 1), noise([23, 90], 2));
        let map = map(&a, &b);
        for [x, y] in [[11usize, 45usize], [5, 63], [17, 64], [0, 0], [22, 89], [3, 66]] {
            let mut taps = Vec::new();
            for v in y.saturating_sub(5)..=(y + 5).min(89) {
                for u in x.saturating_sub(5)..=(x + 5).min(22) {
                    let squared = (u as f64 - x as f64).powi(2) + (v as f64 - y as f64).powi(2);
                    taps.push(((-squared / 4.5).exp(), luma(a.rgb[v * 23 + u]), luma(b.rgb[v * 23 + u])));
                }
            }
            let sum: f64 = taps.iter().map(|(weight, ..)| weight).sum();
            let mean = |of: &dyn Fn(f64, f64) -> f64| taps.iter().map(|(w, a, b)| w * of(*a, *b)).sum::<f64>() / sum;
            let (mean_a, mean_b) = (mean(&|a, _| a), mean(&|_, b| b));
            let (var_a, var_b) = (mean(&|a, _| (a - mean_a).powi(2)), mean(&|_, b| (b - mean_b).powi(2)));
            let covariance = mean(&|a, b| (a - mean_a) * (b - mean_b));
            let expected = (2.0 * mean_a * mean_b + C1) / (mean_a * mean_a + mean_b * mean_b + C1)
                * ((2.0 * covariance + C2) / (var_a + var_b + C2));
            assert!((f64::from(map[y * 23 + x]) - expected).abs() < 1e-6, "{x}, {y}");
        }
    }
}
