//! Pictures as metrics see them: three display values a pixel, nothing behind them.

use crate::scene::{Image, Pixels};

/// Black, sRGB display values.
pub const BLACK: [f32; 3] = [0.0; 3];
/// White, sRGB display values.
pub const WHITE: [f32; 3] = [1.0; 3];

/// An opaque picture: rows from the top, sRGB display values of 0..1.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green, blue.
    pub rgb: Vec<[f32; 3]>,
}

impl Picture {
    /// An image laid over a colour (sRGB display values) in linear light, as the renderer lays its pictures over a
    /// background. An opaque image stays what it is.
    pub fn new(image: &Image, over: [f32; 3]) -> Picture {
        let behind = over.map(linear_from_srgb);
        let laid = |[r, g, b, alpha]: [f32; 4]| {
            // Neither end goes through the curve and back: equal colours stay equal.
            if alpha >= 1.0 {
                return [r, g, b];
            }
            if alpha <= 0.0 {
                return over;
            }
            let mix = |color: f32, behind: f32| linear_from_srgb(color) * alpha + behind * (1.0 - alpha);
            [(r, behind[0]), (g, behind[1]), (b, behind[2])].map(|(color, behind)| srgb_from_linear(mix(color, behind)))
        };
        Picture { size: image.size, rgb: rgba(image).map(laid).collect() }
    }
}

/// The pixels of an image, RGBA of 0..1, rows from the top.
pub(super) fn rgba(image: &Image) -> impl Iterator<Item = [f32; 4]> {
    let (bytes, words): (&[u8], &[u16]) = match &image.pixels {
        Pixels::U8(values) => (values, &[]),
        Pixels::U16(values) => (&[], values),
    };
    let narrow = bytes.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]].map(|value| f32::from(value) / 255.0));
    let wide = words.chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]].map(|value| f32::from(value) / 65535.0));
    narrow.chain(wide)
}

/// Linear light of a display value [IEC61966, part 2-1].
pub(super) fn linear_from_srgb(display: f32) -> f32 {
    if display <= 0.04045 { display / 12.92 } else { ((display + 0.055) / 1.055).powf(2.4) }
}

/// The display value of linear light [IEC61966, part 2-1].
fn srgb_from_linear(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(pixels: Vec<u8>, opaque: bool) -> Image {
        Image { size: [pixels.len() as u32 / 4, 1], pixels: Pixels::U8(pixels), opaque }
    }

    #[test]
    fn transparent_pixels_are_laid_over_in_linear_light() {
        let image = image(vec![255, 255, 255, 0, 255, 0, 51, 255, 255, 255, 255, 51], false);
        let picture = Picture::new(&image, BLACK);
        assert_eq!((picture.rgb[0], picture.rgb[1]), (BLACK, [1.0, 0.0, 0.2]));
        // A fifth of the light is more than a third of the display value, 0.4845.
        assert!((picture.rgb[2][0] - 0.484_5).abs() < 1e-4, "{:?}", picture.rgb[2]);
        let grey = Picture::new(&image, [0.5; 3]);
        assert_eq!(grey.rgb[0], [0.5; 3]);
    }

    #[test]
    fn both_depths_are_the_same_values() {
        let narrow = image(vec![0, 128, 255, 255], true);
        let wide = Image { pixels: Pixels::U16(vec![0, 128 * 257, 65535, 65535]), ..narrow.clone() };
        assert_eq!(Picture::new(&narrow, WHITE), Picture::new(&wide, BLACK));
    }
}
