//! FLIP: how plainly a person sees the difference when two pictures alternate at one place.
//!
//! Method: [Andersson2020 §4], as its authors compute it [FlipCode, src/cpp/FLIP.h], for pictures of 0..1 (LDR-FLIP).
//! Both pictures are blurred as the eye blurs them at the distance that is assumed, their colours compared, and
//! differences made larger where edges or points are in the one and not in the other.
//! Checked: `benches/flip` holds every pixel against the authors' program; the tests below hold some of its numbers.
//! All of it is single precision and in the authors' order: a square root near zero shows every other rounding (one
//! last digit of one constant moved a pixel by 1.7e-4).

use std::f32::consts::PI;
use std::ops::Range;

use super::bands;
use super::picture::{Picture, linear_from_srgb};

/// Pixels in one degree of what is seen: a screen of 3840 pixels and 0.7 m, seen from 0.7 m [FlipCode, README].
const PIXELS_PER_DEGREE: f32 = 0.7 * (3840.0 / 0.7) * (PI / 180.0);

/// Exponent of colour differences, the share of the largest difference that is mapped to a share of the range of
/// errors, the width of a feature in degrees, and the exponent of feature differences [Andersson2020 §4].
const QC: f32 = 0.7;
const PC: f32 = 0.4;
const PT: f32 = 0.95;
const FEATURE_WIDTH_DEG: f32 = 0.082;
const QF: f32 = 0.5;

/// Gaussians of the eye's contrast sensitivity: amplitude and scale for Y, Cx, and the two whose sum is that of Cz
/// [Andersson2020 §4.1.1, table 1].
const Y_SCALE: f32 = 0.0047;
const CX_SCALE: f32 = 0.0053;
const CZ_GAUSSIANS: [[f32; 2]; 2] = [[34.1, 0.04], [13.5, 0.025]];

/// White of D65, X and Z for Y = 1, and what divides by it [FlipCode, src/cpp/FLIP.h].
const WHITE_XZ: [f32; 2] = [0.950_428_55, 1.088_900_3];
const INVERSE_WHITE_XZ: [f32; 2] = [1.052_156_9, 0.918_357_7];

/// Error of each pixel, 0 (no difference is seen) to 1. Pictures of one size.
pub(super) fn map(reference: &Picture, test: &Picture) -> Vec<f32> {
    let (width, height) = (reference.size[0] as usize, reference.size[1] as usize);
    let (eye, feature) = (EyeFilters::new(PIXELS_PER_DEGREE), FeatureFilters::new(PIXELS_PER_DEGREE));
    let largest = largest_color_difference();
    let mut map = vec![0.0; width * height];
    bands::fill(&mut map, width, |rows, band| {
        let seen = [reference, test].map(|picture| Seen::new(picture, rows.clone(), height, &eye, &feature));
        let [mut a, mut b] = [0, 1].map(|_| SeenRow::new(width));
        for (row, band_row) in band.chunks_exact_mut(width).enumerate() {
            a.fill(&seen[0], row, &eye, &feature);
            b.fill(&seen[1], row, &eye, &feature);
            for (x, error) in band_row.iter_mut().enumerate() {
                let color = remapped(color_difference(a.lab(x), b.lab(x)).powf(QC), largest);
                let (edges, points) = ((a.edge(x) - b.edge(x)).abs(), (a.point(x) - b.point(x)).abs());
                let feature = ((1.0 / 2f32.sqrt()) * edges.max(points)).powf(QF);
                *error = color.powf(1.0 - feature);
            }
        }
    });
    map
}

/// Separated filters of the eye's contrast sensitivity. That of Cz is a sum of two Gaussians, each the product of its
/// own with itself [FlipCode, misc/separatedConvolutions.pdf].
struct EyeFilters {
    radius_px: usize,
    y: Vec<f32>,
    cx: Vec<f32>,
    cz: [Vec<f32>; 2],
}

impl EyeFilters {
    fn new(pixels_per_degree: f32) -> EyeFilters {
        let widest = CZ_GAUSSIANS[0][1];
        let radius_px = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize;
        let gaussian = |amplitude: f32, scale: f32| -> Vec<f32> {
            let at = |tap: usize| {
                let degrees = (tap as f32 - radius_px as f32) * (1.0 / pixels_per_degree);
                amplitude * (-(PI * PI) * (degrees * degrees) / scale).exp()
            };
            (0..=2 * radius_px).map(at).collect()
        };
        let sum = |weights: &[f32]| weights.iter().sum::<f32>();
        let normal = |scale: f32| {
            let weights = gaussian((PI / scale).sqrt(), scale);
            scaled(&weights, 1.0 / sum(&weights))
        };
        let cz = CZ_GAUSSIANS.map(|[amplitude, scale]| gaussian((amplitude * (PI / scale).sqrt()).sqrt(), scale));
        let sums = [sum(&cz[0]), sum(&cz[1])];
        let factor = 1.0 / (sums[0] * sums[0] + sums[1] * sums[1]).sqrt();
        EyeFilters { radius_px, y: normal(Y_SCALE), cx: normal(CX_SCALE), cz: cz.map(|cz| scaled(&cz, factor)) }
    }
}

fn scaled(weights: &[f32], factor: f32) -> Vec<f32> {
    weights.iter().map(|weight| weight * factor).collect()
}

/// A Gaussian with its first derivative, which finds edges, and its second, which finds points [Andersson2020 §4.2].
struct FeatureFilters {
    radius_px: usize,
    gaussian: Vec<f32>,
    edge: Vec<f32>,
    point: Vec<f32>,
}

impl FeatureFilters {
    fn new(pixels_per_degree: f32) -> FeatureFilters {
        let sigma_px = 0.5 * FEATURE_WIDTH_DEG * pixels_per_degree;
        let radius_px = (3.0 * sigma_px).ceil() as usize;
        let taps: Vec<f32> = (0..=2 * radius_px).map(|tap| tap as f32 - radius_px as f32).collect();
        let bell: Vec<f32> = taps.iter().map(|x| (-(x * x) / (2.0 * sigma_px * sigma_px)).exp()).collect();
        let with_bell = |of: &dyn Fn(f32) -> f32| taps.iter().zip(&bell).map(|(x, bell)| of(*x) * bell).collect();
        let edge: Vec<f32> = with_bell(&|x| -x);
        let point: Vec<f32> = with_bell(&|x| x * x / (sigma_px * sigma_px) - 1.0);
        let sum: f32 = bell.iter().sum();
        let gaussian = bell.iter().map(|weight| weight / sum).collect();
        FeatureFilters { radius_px, gaussian, edge: balanced(&edge), point: balanced(&point) }
    }
}

/// Weights whose positive ones sum to 1 and whose negative ones to -1.
fn balanced(weights: &[f32]) -> Vec<f32> {
    let sum = |sign: f32| weights.iter().map(|weight| (weight * sign).max(0.0)).sum::<f32>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    weights.iter().map(|weight| weight / if *weight > 0.0 { positive } else { negative }).collect()
}

/// Rows of a picture, filtered along x: those of a band, and as many above and below as filters along y reach.
struct Seen {
    width: usize,
    /// Rows above the band.
    margin: usize,
    y: Vec<f32>,
    cx: Vec<f32>,
    cz: [Vec<f32>; 2],
    /// The grey picture with the Gaussian and with its derivatives.
    gaussian: Vec<f32>,
    edge: Vec<f32>,
    point: Vec<f32>,
}

impl Seen {
    fn new(picture: &Picture, rows: Range<usize>, height: usize, eye: &EyeFilters, feature: &FeatureFilters) -> Seen {
        let width = picture.size[0] as usize;
        let margin = eye.radius_px.max(feature.radius_px);
        let plane = || vec![0.0; width * (rows.len() + 2 * margin)];
        let mut seen = Seen {
            width,
            margin,
            y: plane(),
            cx: plane(),
            cz: [plane(), plane()],
            gaussian: plane(),
            edge: plane(),
            point: plane(),
        };
        // Beyond the border the outermost pixels go on.
        let padded = || vec![0.0; width + 2 * margin];
        let [mut y, mut cx, mut cz, mut grey] = [padded(), padded(), padded(), padded()];
        for at in 0..rows.len() + 2 * margin {
            let row = (rows.start + at).saturating_sub(margin).min(height - 1);
            let pixels = &picture.rgb[row * width..(row + 1) * width];
            for x in 0..width {
                [y[margin + x], cx[margin + x], cz[margin + x]] = opponent(pixels[x]);
                grey[margin + x] = y[margin + x] * (1.0 / 116.0) + 16.0 / 116.0;
            }
            for plane in [&mut y, &mut cx, &mut cz, &mut grey] {
                let (first, last) = (plane[margin], plane[margin + width - 1]);
                plane[..margin].fill(first);
                plane[margin + width..].fill(last);
            }
            let out = at * width..(at + 1) * width;
            let into = |plane: &mut Vec<f32>, source: &[f32], weights: &[f32]| {
                let start = margin - weights.len() / 2;
                let out = &mut plane[out.clone()];
                for (tap, weight) in weights.iter().enumerate() {
                    add(out, *weight, &source[start + tap..]);
                }
            };
            into(&mut seen.y, &y, &eye.y);
            into(&mut seen.cx, &cx, &eye.cx);
            into(&mut seen.cz[0], &cz, &eye.cz[0]);
            into(&mut seen.cz[1], &cz, &eye.cz[1]);
            into(&mut seen.gaussian, &grey, &feature.gaussian);
            into(&mut seen.edge, &grey, &feature.edge);
            into(&mut seen.point, &grey, &feature.point);
        }
        seen
    }
}

/// `sums += weight * values`, as far as there are sums.
fn add(sums: &mut [f32], weight: f32, values: &[f32]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// One row of a picture, filtered along both sides.
struct SeenRow {
    y: Vec<f32>,
    cx: Vec<f32>,
    cz: [Vec<f32>; 2],
    /// First derivatives along x and y, and the second ones.
    edge: [Vec<f32>; 2],
    point: [Vec<f32>; 2],
}

impl SeenRow {
    fn new(width: usize) -> SeenRow {
        let row = || vec![0.0; width];
        SeenRow { y: row(), cx: row(), cz: [row(), row()], edge: [row(), row()], point: [row(), row()] }
    }

    /// The row of this number within the band.
    fn fill(&mut self, seen: &Seen, row: usize, eye: &EyeFilters, feature: &FeatureFilters) {
        let into = |sums: &mut Vec<f32>, plane: &[f32], weights: &[f32]| {
            sums.fill(0.0);
            let start = row + seen.margin - weights.len() / 2;
            for (tap, weight) in weights.iter().enumerate() {
                add(sums, *weight, &plane[(start + tap) * seen.width..]);
            }
        };
        into(&mut self.y, &seen.y, &eye.y);
        into(&mut self.cx, &seen.cx, &eye.cx);
        into(&mut self.cz[0], &seen.cz[0], &eye.cz[0]);
        into(&mut self.cz[1], &seen.cz[1], &eye.cz[1]);
        into(&mut self.edge[0], &seen.edge, &feature.gaussian);
        into(&mut self.edge[1], &seen.gaussian, &feature.edge);
        into(&mut self.point[0], &seen.point, &feature.gaussian);
        into(&mut self.point[1], &seen.gaussian, &feature.point);
    }

    /// What is seen of a pixel's colour: CIELAB, its chroma scaled by its lightness.
    fn lab(&self, x: usize) -> [f32; 3] {
        let linear = linear_from_opponent([self.y[x], self.cx[x], self.cz[0][x] + self.cz[1][x]]);
        hunt(lab(linear.map(|value| value.clamp(0.0, 1.0))))
    }

    fn edge(&self, x: usize) -> f32 {
        (self.edge[0][x] * self.edge[0][x] + self.edge[1][x] * self.edge[1][x]).sqrt()
    }

    fn point(&self, x: usize) -> f32 {
        (self.point[0][x] * self.point[0][x] + self.point[1][x] * self.point[1][x]).sqrt()
    }
}

/// XYZ of linear sRGB [FlipCode, src/cpp/FLIP.h].
fn xyz([r, g, b]: [f32; 3]) -> [f32; 3] {
    [
        10_135_552.0 / 24_577_794.0 * r + 8_788_810.0 / 24_577_794.0 * g + 4_435_075.0 / 24_577_794.0 * b,
        2_613_072.0 / 12_288_897.0 * r + 8_788_810.0 / 12_288_897.0 * g + 887_015.0 / 12_288_897.0 * b,
        1_425_312.0 / 73_733_382.0 * r + 8_788_810.0 / 73_733_382.0 * g + 70_074_185.0 / 73_733_382.0 * b,
    ]
}

/// The linear opponent space YCxCz of display values [Andersson2020 §4.1].
fn opponent(display: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = xyz(display.map(|value| linear_from_srgb(value.clamp(0.0, 1.0))));
    let (x, z) = (x * INVERSE_WHITE_XZ[0], z * INVERSE_WHITE_XZ[1]);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Linear sRGB of YCxCz; the inverse matrix as [FlipCode, src/cpp/FLIP.h] rounds it.
fn linear_from_opponent([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (y + 16.0) / 116.0;
    let (x, z) = ((y + cx / 500.0) * WHITE_XZ[0], (y - cz / 200.0) * WHITE_XZ[1]);
    [
        3.241_003_3 * x + -1.537_398_9 * y + -0.498_615_86 * z,
        -0.969_224_33 * x + 1.875_930_1 * y + 0.041_554_224 * z,
        0.055_639_423 * x + -0.204_011_2 * y + 1.057_148_9 * z,
    ]
}

/// CIELAB of linear sRGB, for D65.
fn lab(linear: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let [x, y, z] = xyz(linear);
    let curve = |value: f32| {
        if value > DELTA * DELTA * DELTA {
            value.powf(1.0 / 3.0)
        } else {
            1.0 / (3.0 * (DELTA * DELTA)) * value + 4.0 / 29.0
        }
    };
    let [x, y, z] = [x * INVERSE_WHITE_XZ[0], y, z * INVERSE_WHITE_XZ[1]].map(curve);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Colours look less colourful the darker they are: the Hunt effect [Andersson2020 §4.1.2].
fn hunt([l, a, b]: [f32; 3]) -> [f32; 3] {
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// HyAB: the distance in lightness plus that in colour, for large differences [Andersson2020 §4.1.3].
fn color_difference(reference: [f32; 3], test: [f32; 3]) -> f32 {
    let [l, a, b] = [0, 1, 2].map(|c| reference[c] - test[c]);
    l.abs() + (a * a + b * b).sqrt()
}

/// The largest difference there is, of green and blue, to the power of [`QC`] [Andersson2020 §4.1.3].
fn largest_color_difference() -> f32 {
    color_difference(hunt(lab([0.0, 1.0, 0.0])), hunt(lab([0.0, 0.0, 1.0]))).powf(QC)
}

/// A difference as an error of 0..1: what lies below [`PC`] of the largest one takes [`PT`] of the range
/// [Andersson2020 §4.1.3].
fn remapped(difference: f32, largest: f32) -> f32 {
    let knee = PC * largest;
    if difference < knee { difference * (PT / knee) } else { PT + (difference - knee) / (largest - knee) * (1.0 - PT) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::metrics::testing::{noise, picture, scattered};

    /// What two correct implementations may differ by: rounding near zero, seen through a square root.
    const TOLERANCE: f32 = 1e-4;
    /// Width and height of the pairs whose errors the authors' program gave.
    const SIZE: [u32; 2] = [96, 80];

    /// A shaded disc on a light ground.
    fn disc(x: usize, y: usize) -> [u8; 3] {
        let (dx, dy) = (x as i64 - 48, y as i64 - 40);
        if dx * dx + dy * dy < 900 { [200, (100 + dx) as u8, (90 - dy) as u8] } else { [240, 240, 235] }
    }

    /// Holds a pair against what the authors' program gives: the mean, and four places.
    #[track_caller]
    fn holds(
        reference: impl Fn(usize, usize) -> [u8; 3],
        test: impl Fn(usize, usize) -> [u8; 3],
        mean: f64,
        at: [f32; 4],
    ) {
        let value = |byte: u8| f32::from(byte) / 255.0;
        let reference = picture(SIZE, |x, y| reference(x, y).map(value));
        let map = map(&reference, &picture(SIZE, |x, y| test(x, y).map(value)));
        let found = [[0, 0], [48, 40], [49, 63], [77, 41]].map(|[x, y]: [usize; 2]| map[y * SIZE[0] as usize + x]);
        assert!(found.iter().zip(at).all(|(found, due)| (found - due).abs() < TOLERANCE), "{found:?}, not {at:?}");
        let found = map.iter().copied().map(f64::from).sum::<f64>() / map.len() as f64;
        assert!((found - mean).abs() < 1e-5, "mean {found}, not {mean}");
    }

    #[test]
    fn errors_are_those_of_the_authors_program() {
        let noise = |x, y, seed| [0u32, 1, 2].map(|c| scattered(x as u32, y as u32, c + seed));
        let at = [0.962_785, 0.510_422, 0.387_944, 0.333_831];
        holds(|x, y| noise(x, y, 0), |x, y| noise(x, y, 3), 0.444_670, at);
        holds(disc, |x, y| disc(x + 1, y), 0.056_903, [0.0, 0.035_812, 0.037_903, 0.483_473]);
        let brighter = |x, y| disc(x, y).map(|value| value + 1);
        holds(disc, brighter, 0.032_413, [0.027_933, 0.036_239, 0.037_772, 0.037_556]);
        let gradient = |x, y| [(x * 2) as u8, (y * 3) as u8, 128];
        let at = [0.921_975, 0.033_812, 0.068_842, 0.580_469];
        holds(gradient, |x, y| gradient(95 - x, y), 0.489_842, at);
        let edge = |end| move |x, _| [if x < end { 40 } else { 200 }; 3];
        holds(edge(48), edge(50), 0.040_942, [0.0, 0.839_398, 0.691_997, 0.0]);
        holds(|_, _| [0, 255, 0], |_, _| [0, 0, 255], 1.0, [1.0; 4]);
        holds(|_, _| [0; 3], |_, _| [255; 3], 0.967_388, [0.967_388; 4]);
    }

    #[test]
    fn identical_pictures_have_no_error() {
        let noise = noise([40, 90], 3);
        assert!(map(&noise, &noise).iter().all(|error| *error == 0.0));
    }

    #[test]
    fn flat_colours_are_their_difference_alone() {
        let flat = |color: [f32; 3]| picture([30, 20], |_, _| color);
        let error = |a, b| map(&flat(a), &flat(b))[10 * 30 + 15];
        // Lightness 0 and 100, no colour: 100^0.7 of a largest 308.1^0.7, above the knee.
        let largest = largest_color_difference();
        assert!((largest - 41.28).abs() < 0.01, "{largest}");
        let expected = remapped(100f32.powf(QC), largest);
        assert!((error([0.0; 3], [1.0; 3]) - expected).abs() < 1e-4);
        assert!((error([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]) - 1.0).abs() < 1e-4);
        assert_eq!(remapped(largest, largest), 1.0);
        assert!((remapped(PC * largest, largest) - PT).abs() < 1e-6);
    }

    #[test]
    fn bands_leave_no_seam() {
        // A difference in one column is the same in each row.
        let a = picture([40, 200], |x, _| [if x < 20 { 0.2 } else { 0.7 }; 3]);
        let b = picture([40, 200], |x, _| [if x < 21 { 0.2 } else { 0.7 }; 3]);
        let map = map(&a, &b);
        assert!(map.chunks(40).all(|row| row == &map[..40]));
        assert!(map[20] > 0.1);
    }
}
