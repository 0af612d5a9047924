//! Metrics: how far a picture is from another one, in numbers and as a map.
//!
//! [`compare`] gives all of them for two images: [`Errors`] in display values and in linear light, PSNR, SSIM and FLIP.
//! [`Sequence`] says how steady pictures are that follow each other. Numbers are over the pixels of a [`Mask`]: what
//! either image covers, with a margin, or all. SSIM and FLIP see the whole pictures and are averaged over the mask.
//!
//! ```text
//! scene::Image  ->  picture, mask  ->  errors, ssim, flip  ->  magma
//! ```

mod bands;
mod errors;
mod flip;
mod lines;
mod magma;
mod mask;
mod picture;
mod sequence;
mod ssim;
#[cfg(test)]
mod testing;

pub use errors::{Channels, Errors};
pub use lines::{LineErrors, share_near};
pub use mask::{MARGIN_PX, Mask, common_background};
pub use picture::{BLACK, Picture, WHITE};
pub use sequence::{Sequence, Stability};

use crate::scene::Image;

/// What is compared, and over what.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Options {
    /// The background (sRGB display values): transparent images are laid over it, and opaque ones cover what differs
    /// from it. By default the colour that the corners of all opaque images share. Where they share none, opaque images
    /// cover all, and transparent ones are laid over black and over white, of which the larger error counts.
    pub background: Option<[f32; 3]>,
    /// Every pixel counts, not only those that either image covers.
    pub all_pixels: bool,
}

/// How far a picture is from its reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metrics {
    /// How many pixels counted.
    pub num_pixels: usize,
    /// Errors of sRGB display values of 0..1.
    pub display: Errors,
    /// Errors of linear light of 0..1.
    pub linear: Errors,
    /// Peak signal-to-noise ratio of display values, in dB; infinite where nothing differs.
    pub psnr_db: f64,
    /// Mean structural similarity: 1 for identical pictures, -1 at the least.
    pub ssim: f64,
    /// Mean FLIP error: 0 where no difference is seen, to 1.
    pub flip: f64,
}

impl Metrics {
    /// Compares two pictures, and gives the FLIP error of each pixel as well.
    ///
    /// # Errors
    /// The pictures, and the mask, have one size.
    pub fn of(reference: &Picture, test: &Picture, mask: &Mask) -> Result<(Metrics, Vec<f32>), SizesDiffer> {
        same_size(reference.size, test.size)?;
        let [display, linear] = [Errors::display, Errors::linear].map(|errors| errors(reference, test, mask));
        let flip_map = flip::map(reference, test);
        let metrics = Metrics {
            num_pixels: mask.num_pixels,
            display,
            linear,
            psnr_db: display.psnr_db(),
            ssim: mask.mean(&ssim::map(reference, test)),
            flip: mask.mean(&flip_map),
        };
        Ok((metrics, flip_map))
    }

    /// The larger error of each kind.
    fn worst(self, other: Metrics) -> Metrics {
        let channels = |a: Channels, b: Channels| Channels {
            all: a.all.max(b.all),
            rgb: std::array::from_fn(|channel| a.rgb[channel].max(b.rgb[channel])),
        };
        let errors = |a: Errors, b: Errors| Errors { rmse: channels(a.rmse, b.rmse), max: channels(a.max, b.max) };
        Metrics {
            num_pixels: self.num_pixels,
            display: errors(self.display, other.display),
            linear: errors(self.linear, other.linear),
            psnr_db: self.psnr_db.min(other.psnr_db),
            ssim: self.ssim.min(other.ssim),
            flip: self.flip.max(other.flip),
        }
    }
}

/// What came of comparing two images.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The numbers.
    pub metrics: Metrics,
    /// FLIP error of each pixel, 0..1, rows from the top; of all pixels, whichever count.
    pub flip_map: Vec<f32>,
    /// The pixels that counted.
    pub mask: Mask,
    size: [u32; 2],
}

impl Comparison {
    /// The FLIP errors in the colours of magma: black where no difference is seen, through purple and orange to pale
    /// yellow for the plainest.
    pub fn flip_image(&self) -> Image {
        magma::image(self.size, &self.flip_map)
    }
}

/// Compares an image with its reference.
///
/// # Errors
/// Both have one size.
pub fn compare(reference: &Image, test: &Image, options: &Options) -> Result<Comparison, SizesDiffer> {
    same_size(reference.size, test.size)?;
    let images = [reference, test];
    let background = options.background.or_else(|| common_background(&images));
    let mask = if options.all_pixels { Mask::all(reference.size) } else { Mask::covered(&images, background) };
    let measure = |over: [f32; 3]| {
        let [reference, test] = images.map(|image| Picture::new(image, over));
        Metrics::of(&reference, &test, &mask)
    };
    let (mut metrics, mut flip_map) = measure(background.unwrap_or(BLACK))?;
    if background.is_none() && !(reference.opaque && test.opaque) {
        let (others, other_map) = measure(WHITE)?;
        metrics = metrics.worst(others);
        flip_map.iter_mut().zip(other_map).for_each(|(error, other)| *error = error.max(other));
    }
    Ok(Comparison { metrics, flip_map, mask, size: reference.size })
}

/// Pictures of different sizes cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{}x{} pixels are compared with {}x{}; draw both in one size", .reference[0], .reference[1], .test[0], .test[1])]
pub struct SizesDiffer {
    /// Width and height of the reference, in pixels.
    pub reference: [u32; 2],
    /// Width and height of the other one, in pixels.
    pub test: [u32; 2],
}

fn same_size(reference: [u32; 2], test: [u32; 2]) -> Result<(), SizesDiffer> {
    if reference == test { Ok(()) } else { Err(SizesDiffer { reference, test }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Pixels;

    /// An image of a grey ground with a square in its middle.
    fn square(ground: [u8; 4], color: [u8; 4]) -> Image {
        let inside = |place: usize| (12..20).contains(&place);
        let pixels = (0..32 * 32).flat_map(|at| if inside(at % 32) && inside(at / 32) { color } else { ground });
        Image { size: [32, 32], pixels: Pixels::U8(pixels.collect()), opaque: ground[3] == 255 && color[3] == 255 }
    }

    const GREY: [u8; 4] = [128, 128, 128, 255];
    const RED: [u8; 4] = [200, 0, 0, 255];

    fn measured(reference: &Image, test: &Image, options: Options) -> Metrics {
        compare(reference, test, &options).unwrap().metrics
    }

    #[test]
    fn an_image_does_not_differ_from_itself() {
        let image = square(GREY, RED);
        let comparison = compare(&image, &image, &Options::default()).unwrap();
        let metrics = comparison.metrics;
        assert_eq!((metrics.num_pixels, metrics.display, metrics.linear), (144, Errors::default(), Errors::default()));
        assert_eq!((metrics.psnr_db, metrics.ssim, metrics.flip), (f64::INFINITY, 1.0, 0.0));
        assert!(comparison.flip_image().opaque && comparison.flip_image().pixel(0, 0)[2] < 0.02);
    }

    #[test]
    fn the_background_does_not_thin_errors_out() {
        let (a, b) = (square(GREY, RED), square(GREY, [251, 0, 0, 255]));
        let covered = measured(&a, &b, Options::default());
        let all = measured(&a, &b, Options { all_pixels: true, ..Options::default() });
        assert_eq!((covered.num_pixels, all.num_pixels), (144, 1024));
        assert!((covered.display.rmse.rgb[0] - 0.2 * (64f64 / 144.0).sqrt()).abs() < 1e-6, "{covered:?}");
        assert!((all.display.rmse.rgb[0] - 0.2 * (64f64 / 1024.0).sqrt()).abs() < 1e-6, "{all:?}");
        assert!((covered.flip / all.flip - 1024.0 / 144.0).abs() < 3.0 && covered.ssim < all.ssim);
        assert_eq!(covered.display.max, all.display.max);
    }

    #[test]
    fn another_background_is_a_difference() {
        let metrics = measured(&square(GREY, RED), &square([255; 4], RED), Options::default());
        assert!(metrics.num_pixels == 1024 && metrics.display.max.all > 0.49 && metrics.flip > 0.3, "{metrics:?}");
    }

    #[test]
    fn transparent_images_are_seen_over_black_and_over_white() {
        // Black and nothing are the same over black, white and nothing over white.
        let nothing = square([0; 4], [0; 4]);
        for color in [[0, 0, 0, 255], [255; 4]] {
            let metrics = measured(&square([0; 4], color), &nothing, Options::default());
            assert!((metrics.display.max.all - 1.0).abs() < 1e-6, "{metrics:?}");
            let over = color.map(|value| f32::from(value) / 255.0);
            let options = Options { background: Some([over[0], over[1], over[2]]), all_pixels: false };
            assert!(measured(&square([0; 4], color), &nothing, options).display.max.all < 1e-6);
        }
    }

    #[test]
    fn a_transparent_image_is_laid_over_the_background_of_the_opaque_one() {
        let metrics = measured(&square(GREY, RED), &square([0; 4], RED), Options::default());
        assert!(metrics.num_pixels == 144 && metrics.display.max.all < 1e-6, "{metrics:?}");
    }

    #[test]
    fn sizes_that_differ_are_both_named() {
        let small = Image { size: [3, 2], pixels: Pixels::U8(vec![0; 24]), opaque: false };
        let error = compare(&square(GREY, RED), &small, &Options::default()).unwrap_err();
        assert_eq!(error.to_string(), "32x32 pixels are compared with 3x2; draw both in one size");
    }
}
