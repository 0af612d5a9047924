//! Root mean square and largest errors, in display values and in linear light, and the peak signal-to-noise ratio.

use super::mask::Mask;
use super::picture::{Picture, linear_from_srgb};

/// An error overall and in each channel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Channels {
    /// Over all three channels.
    pub all: f64,
    /// Red, green, blue.
    pub rgb: [f64; 3],
}

/// Differences of values of 0..1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// Root of the mean squared difference.
    pub rmse: Channels,
    /// Largest absolute difference: a single wrong pixel that means hide.
    pub max: Channels,
}

impl Errors {
    /// Differences of sRGB display values.
    pub fn display(reference: &Picture, test: &Picture, mask: &Mask) -> Errors {
        Errors::of(reference, test, mask, |value| value)
    }

    /// Differences in linear light.
    pub fn linear(reference: &Picture, test: &Picture, mask: &Mask) -> Errors {
        Errors::of(reference, test, mask, linear_from_srgb)
    }

    fn of(reference: &Picture, test: &Picture, mask: &Mask, scale: impl Fn(f32) -> f32) -> Errors {
        let (mut squares, mut max) = ([0.0; 3], [0.0f64; 3]);
        for (a, b) in mask.of(&reference.rgb).zip(mask.of(&test.rgb)).filter(|(a, b)| a != b) {
            for c in 0..3 {
                let difference = f64::from(scale(a[c])) - f64::from(scale(b[c]));
                squares[c] += difference * difference;
                max[c] = max[c].max(difference.abs());
            }
        }
        let means = squares.map(|sum| sum / mask.num_pixels.max(1) as f64);
        Errors {
            rmse: Channels { all: (means.iter().sum::<f64>() / 3.0).sqrt(), rgb: means.map(f64::sqrt) },
            max: Channels { all: max.into_iter().fold(0.0, f64::max), rgb: max },
        }
    }

    /// Peak signal-to-noise ratio in dB, for a peak of 1; infinite where nothing differs.
    pub fn psnr_db(&self) -> f64 {
        // Not -0 for a difference of black and white.
        0.0 - 20.0 * self.rmse.all.log10()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(values: &[([u8; 3], [u8; 3])]) -> (Picture, Picture, Mask) {
        let size = [values.len() as u32, 1];
        let value = |bytes: [u8; 3]| bytes.map(|byte| f32::from(byte) / 255.0);
        let reference = Picture { size, rgb: values.iter().map(|(a, _)| value(*a)).collect() };
        (reference, Picture { size, rgb: values.iter().map(|(_, b)| value(*b)).collect() }, Mask::all(size))
    }

    #[test]
    fn identical_pictures_have_none() {
        let (a, b, mask) = pair(&[([1, 2, 3], [1, 2, 3]), ([255, 0, 9], [255, 0, 9])]);
        let errors = Errors::display(&a, &b, &mask);
        assert_eq!(errors, Errors::default());
        assert_eq!(Errors::linear(&a, &b, &mask), Errors::default());
        assert_eq!(errors.psnr_db(), f64::INFINITY);
    }

    #[test]
    fn one_level_is_48_decibels() {
        let (a, b, mask) = pair(&[([10, 20, 30], [11, 21, 31]), ([0, 128, 254], [1, 129, 255])]);
        let errors = Errors::display(&a, &b, &mask);
        for value in [errors.rmse.all, errors.max.all, errors.rmse.rgb[2], errors.max.rgb[0]] {
            assert!((value - 1.0 / 255.0).abs() < 1e-7, "{errors:?}");
        }
        // 20 log10(255).
        assert!((errors.psnr_db() - 48.130_804).abs() < 1e-4, "{}", errors.psnr_db());
    }

    #[test]
    fn black_and_white_are_one_apart() {
        let (a, b, mask) = pair(&[([0; 3], [255; 3])]);
        for errors in [Errors::display(&a, &b, &mask), Errors::linear(&a, &b, &mask)] {
            assert_eq!((errors.rmse.all, errors.max.all, errors.psnr_db().to_bits()), (1.0, 1.0, 0));
        }
    }

    #[test]
    fn channels_are_told_apart_and_light_is_linear() {
        let (a, b, mask) = pair(&[([0, 0, 0], [188, 0, 0]), ([0; 3], [0; 3]), ([0; 3], [0; 3]), ([0; 3], [0; 3])]);
        let errors = Errors::linear(&a, &b, &mask);
        // 188 of 255 is half of the light: 0.5029.
        assert!((errors.max.rgb[0] - 0.502_886).abs() < 1e-5 && errors.max.rgb[1] == 0.0, "{errors:?}");
        // A quarter of the pixels, a third of the channels.
        assert!((errors.rmse.rgb[0] - 0.502_886 / 2.0).abs() < 1e-5, "{errors:?}");
        assert!((errors.rmse.all - 0.502_886 / 12f64.sqrt()).abs() < 1e-5, "{errors:?}");
        let far = Mask { counts: vec![false, true, true, true], num_pixels: 3 };
        assert_eq!(Errors::linear(&a, &b, &far), Errors::default());
    }
}
