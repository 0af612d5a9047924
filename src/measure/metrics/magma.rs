//! The colour map magma: from black through purple and orange to pale yellow, evenly lighter to the eye.

use crate::scene::{Image, Pixels};

/// 33 of the 256 colours of the map, evenly spaced, sRGB [Smith2015, magma]. Between them values are straight: no
/// channel is off by more than 1.3 of 255.
const COLORS: [u32; 33] = [
    0x000004, 0x030311, 0x0a0822, 0x130d33, 0x1d1146, 0x28115a, 0x36106a, 0x430f76, 0x50127c, 0x5d177f, 0x691c81,
    0x762181, 0x822681, 0x8f2a81, 0x9c2e7f, 0xa9327d, 0xb63779, 0xc33b75, 0xcf4170, 0xdb486a, 0xe65163, 0xee5c5e,
    0xf5695c, 0xf9785d, 0xfb8761, 0xfd9668, 0xfea571, 0xfeb47b, 0xfec387, 0xfed194, 0xfde0a2, 0xfceeb0, 0xfcfdbf,
];

/// Red, green and blue of a value of 0..1.
fn color(value: f32) -> [u8; 3] {
    let place = value.clamp(0.0, 1.0) * (COLORS.len() - 1) as f32;
    let index = (place as usize).min(COLORS.len() - 2);
    let part = place - index as f32;
    [16, 8, 0].map(|shift| {
        let [low, high] = [index, index + 1].map(|index| (COLORS[index] >> shift & 0xff) as f32);
        (low + (high - low) * part).round() as u8
    })
}

/// A map of values of 0..1 as a picture.
pub(super) fn image(size: [u32; 2], values: &[f32]) -> Image {
    let pixels = values.iter().flat_map(|value| {
        let [r, g, b] = color(*value);
        [r, g, b, u8::MAX]
    });
    Image { size, pixels: Pixels::U8(pixels.collect()), opaque: true }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_published_values_are_met() {
        assert_eq!((color(0.0), color(1.0)), ([0, 0, 4], [0xfc, 0xfd, 0xbf]));
        assert_eq!((color(-1.0), color(f32::INFINITY)), (color(0.0), color(1.0)));
        // Entries 31 and 127 of the published 256: (0.107899, 0.064335, 0.267289), (0.709962, 0.212797, 0.477201).
        for (entry, published) in
            [(31.0, [0.107_899, 0.064_335, 0.267_289]), (127.0, [0.709_962, 0.212_797, 0.477_201])]
        {
            for (channel, published) in color(entry / 255.0).into_iter().zip(published) {
                assert!((f64::from(channel) - published * 255.0).abs() < 1.8, "{entry}: {channel}, {published}");
            }
        }
    }

    #[test]
    fn larger_values_are_never_darker() {
        let luma = |value: f32| {
            let [r, g, b] = color(value).map(f32::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..255).all(|entry| luma(entry as f32 / 255.0) <= luma((entry + 1) as f32 / 255.0) + 0.5));
    }
}
