//! Which pixels count: those that a picture covers, and a margin around them.
//!
//! An empty background is most of a picture, and the same in any two. A mean over all of it would fall with the size of
//! the background, not with the error.

use crate::scene::Image;

use super::picture::rgba;

/// How far beyond covered pixels errors still count, in pixels: the edge filters of antialiased pictures reach as far.
pub const MARGIN_PX: usize = 2;

/// The pixels over which metrics are averaged.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mask {
    /// Whether a pixel counts: rows from the top.
    pub counts: Vec<bool>,
    /// How many do.
    pub num_pixels: usize,
}

impl Mask {
    /// Every pixel counts.
    pub fn all([width, height]: [u32; 2]) -> Mask {
        let num_pixels = width as usize * height as usize;
        Mask { counts: vec![true; num_pixels], num_pixels }
    }

    /// Pixels that any of the images covers, and a square margin of [`MARGIN_PX`] around them. A pixel is covered where
    /// it is not wholly transparent, in an opaque image where it is not the background (sRGB display values), and
    /// everywhere if there is none. Where nothing at all is covered, every pixel counts.
    ///
    /// The images have the same size; of others no more counts than they have in common.
    pub fn covered(images: &[&Image], background: Option<[f32; 3]>) -> Mask {
        let Some(first) = images.first() else { return Mask::all([0, 0]) };
        let mut counts = vec![false; first.size[0] as usize * first.size[1] as usize];
        for image in images {
            for (counts, [r, g, b, alpha]) in counts.iter_mut().zip(rgba(image)) {
                *counts |= if image.opaque { background != Some([r, g, b]) } else { alpha > 0.0 };
            }
        }
        let counts = dilated(&counts, first.size[0] as usize);
        let num_pixels = counts.iter().filter(|counts| **counts).count();
        if num_pixels == 0 { Mask::all(first.size) } else { Mask { counts, num_pixels } }
    }

    /// Values of the pixels that count.
    pub(super) fn of<'a, T: Copy>(&'a self, values: &'a [T]) -> impl Iterator<Item = T> + 'a {
        self.counts.iter().zip(values).filter(|(counts, _)| **counts).map(|(_, value)| *value)
    }

    /// Mean over the pixels that count; 0 if none does.
    pub fn mean(&self, values: &[f32]) -> f64 {
        self.of(values).map(f64::from).sum::<f64>() / self.num_pixels.max(1) as f64
    }
}

/// The colour (sRGB display values) that the corners of all opaque images have in common, if they have one.
pub fn common_background(images: &[&Image]) -> Option<[f32; 3]> {
    let mut corners = images.iter().filter(|image| image.opaque && !image.size.contains(&0)).flat_map(|image| {
        let [right, bottom] = image.size.map(|side| side - 1);
        [[0, 0], [right, 0], [0, bottom], [right, bottom]].map(|[x, y]| {
            let [r, g, b, _] = image.pixel(x, y);
            [r, g, b]
        })
    });
    let first = corners.next()?;
    corners.all(|corner| corner == first).then_some(first)
}

/// True where a pixel of the square of [`MARGIN_PX`] around is.
fn dilated(pixels: &[bool], width: usize) -> Vec<bool> {
    if width == 0 {
        return Vec::new();
    }
    let mut wide = vec![false; pixels.len()];
    for (row, wide) in pixels.chunks_exact(width).zip(wide.chunks_exact_mut(width)) {
        for x in (0..width).filter(|x| row[*x]) {
            wide[x.saturating_sub(MARGIN_PX)..(x + MARGIN_PX + 1).min(width)].fill(true);
        }
    }
    let mut out = vec![false; pixels.len()];
    let height = pixels.len() / width;
    for (y, row) in out.chunks_exact_mut(width).enumerate() {
        for near in y.saturating_sub(MARGIN_PX)..(y + MARGIN_PX + 1).min(height) {
            for (out, wide) in row.iter_mut().zip(&wide[near * width..]) {
                *out |= wide;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Pixels;

    /// An image of one colour with another at one place.
    fn dot(size: [u32; 2], ground: [u8; 4], at: [u32; 2], color: [u8; 4]) -> Image {
        let place = (at[1] * size[0] + at[0]) as usize;
        let pixels = (0..(size[0] * size[1]) as usize).flat_map(|index| if index == place { color } else { ground });
        Image { size, pixels: Pixels::U8(pixels.collect()), opaque: ground[3] == 255 }
    }

    const WHITE: [u8; 4] = [255; 4];
    const RED: [u8; 4] = [255, 0, 0, 255];

    #[test]
    fn a_dot_counts_with_two_pixels_around_it() {
        let opaque = dot([9, 8], WHITE, [4, 3], RED);
        let background = common_background(&[&opaque]);
        assert_eq!(background, Some([1.0; 3]));
        let mask = Mask::covered(&[&opaque], background);
        let expected = |index: usize| (2..7).contains(&(index % 9)) && (1..6).contains(&(index / 9));
        assert!(mask.counts.iter().enumerate().all(|(index, counts)| *counts == expected(index)));
        assert_eq!(mask.num_pixels, 25);
        let transparent = dot([9, 8], [9, 9, 9, 0], [4, 3], [9, 9, 9, 1]);
        assert_eq!(Mask::covered(&[&transparent], None), mask);
        // Another dot, cut by the border.
        let corner = dot([9, 8], WHITE, [0, 0], RED);
        assert_eq!(Mask::covered(&[&opaque, &corner], background).num_pixels, 25 + 9 - 2);
    }

    #[test]
    fn everything_counts_where_no_background_is_known() {
        let red_corner = dot([9, 8], WHITE, [0, 0], RED);
        assert_eq!(common_background(&[&red_corner]), None);
        assert_eq!(Mask::covered(&[&red_corner], None), Mask::all([9, 8]));
        let white = dot([9, 8], WHITE, [0, 0], WHITE);
        let red = dot([9, 8], RED, [0, 0], RED);
        assert_eq!(common_background(&[&white, &red]), None);
        assert_eq!(Mask::covered(&[&white], Some([1.0; 3])), Mask::all([9, 8]));
        // A transparent image has no say.
        assert_eq!(common_background(&[&white, &dot([9, 8], [0; 4], [0, 0], RED)]), Some([1.0; 3]));
        assert_eq!(common_background(&[]), None);
    }

    #[test]
    fn means_are_over_what_counts() {
        let mask = Mask { counts: vec![true, false, true, true], num_pixels: 3 };
        assert_eq!(mask.mean(&[1.0, 100.0, 2.0, 6.0]), 3.0);
        assert_eq!(Mask::all([0, 0]).mean(&[]), 0.0);
    }
}
