//! Lines: how well those of a picture cover where lines should be, by precision, recall, width and gaps.

use crate::scene::{Image, linear_from_srgb};

/// How far a line may lie beside its place and still be found, in pixels.
pub const TOLERANCE_PX: usize = 1;
/// Pixels of a line that must be missing together to make a gap.
const GAP_PIXELS: usize = 2;

/// How lines differ from those that should be there. The lines of a picture are its red; nothing else in it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineErrors {
    /// Share of the pixels of drawn lines that have a true one within a pixel; 1 where none are drawn.
    pub precision: f64,
    /// Share of the pixels of true lines that have a drawn one within a pixel; 1 where there are none.
    pub recall: f64,
    /// Mean difference of widths in pixels: of the areas that lines cover around a pixel of a true one, by its length there.
    pub width_error_px: f64,
    /// Pieces of true lines that are missing.
    pub gaps: usize,
}

impl LineErrors {
    /// Compares two pictures of one size; true lines are so many pixels wide.
    pub fn of(truth: &Image, drawn: &Image, width_px: f64) -> LineErrors {
        let width = truth.size[0] as usize;
        let (true_cover, drawn_cover) = (cover(truth), cover(drawn));
        let [true_line, drawn_line] = [&true_cover, &drawn_cover].map(|cover| mask(cover));
        LineErrors {
            precision: share_near(&drawn_line, &true_line, width),
            recall: share_near(&true_line, &drawn_line, width),
            width_error_px: width_error(&true_cover, &drawn_cover, &true_line, width, width_px),
            gaps: gaps(&true_line, &drawn_line, width),
        }
    }

    /// Harmonic mean of precision and recall.
    pub fn f1(&self) -> f64 {
        2.0 * self.precision * self.recall / (self.precision + self.recall).max(1e-9)
    }
}

/// The share of each pixel that lines cover.
fn cover(image: &Image) -> Vec<f64> {
    let [width, height] = image.size;
    let red = |x, y| linear_from_srgb(f64::from(image.pixel(x, y)[0]));
    (0..height).flat_map(|y| (0..width).map(move |x| red(x, y))).collect()
}

fn mask(cover: &[f64]) -> Vec<bool> {
    cover.iter().map(|share| *share > 0.5).collect()
}

/// Share of the pixels of `of` that have one of `among` within a pixel; 1 where `of` is empty. Rows of `width`.
pub fn share_near(of: &[bool], among: &[bool], width: usize) -> f64 {
    let near = widened(among, width);
    let count = of.iter().filter(|is| **is).count();
    let found = of.iter().zip(&near).filter(|(is, near)| **is && **near).count();
    if count == 0 { 1.0 } else { found as f64 / count as f64 }
}

/// The mask with [`TOLERANCE_PX`] around it.
fn widened(mask: &[bool], width: usize) -> Vec<bool> {
    let mut wide = vec![false; mask.len()];
    for index in (0..mask.len()).filter(|index| mask[*index]) {
        for (x, y) in around(index, width, mask.len(), TOLERANCE_PX) {
            wide[y * width + x] = true;
        }
    }
    wide
}

/// Places within so many steps of a pixel, in the picture.
fn around(index: usize, width: usize, len: usize, steps: usize) -> impl Iterator<Item = (usize, usize)> {
    let (x, y, height) = (index % width, index / width, len / width);
    let (left, right) = (x.saturating_sub(steps), (x + steps).min(width - 1));
    let (top, bottom) = (y.saturating_sub(steps), (y + steps).min(height - 1));
    (top..=bottom).flat_map(move |y| (left..=right).map(move |x| (x, y)))
}

fn width_error(truth: &[f64], drawn: &[f64], line: &[bool], width: usize, width_px: f64) -> f64 {
    // A line and what is drawn a pixel beside it.
    let reach = width_px.ceil() as usize + TOLERANCE_PX;
    let error = |index: usize| {
        let places = || around(index, width, truth.len(), reach).map(|(x, y)| y * width + x);
        let area: f64 = places().map(|at| truth[at]).sum();
        let drawn_area: f64 = places().map(|at| drawn[at]).sum();
        (drawn_area - area).abs() / area * width_px
    };
    let errors: Vec<f64> = (0..truth.len()).filter(|index| line[*index]).map(error).collect();
    errors.iter().sum::<f64>() / errors.len().max(1) as f64
}

/// Connected pieces of the true lines that are not drawn.
fn gaps(truth: &[bool], drawn: &[bool], width: usize) -> usize {
    let near = widened(drawn, width);
    let mut missing: Vec<bool> = truth.iter().zip(&near).map(|(line, near)| *line && !near).collect();
    let mut gaps = 0;
    for start in 0..missing.len() {
        let mut pending = if missing[start] { vec![start] } else { continue };
        missing[start] = false;
        let mut size = 0;
        while let Some(index) = pending.pop() {
            size += 1;
            for (x, y) in around(index, width, missing.len(), 1) {
                if std::mem::take(&mut missing[y * width + x]) {
                    pending.push(y * width + x);
                }
            }
        }
        gaps += usize::from(size >= GAP_PIXELS);
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Pixels;

    /// A red picture of 32x32 pixels where `is_line`, black elsewhere.
    fn picture(is_line: impl Fn(usize, usize) -> bool) -> Image {
        let pixels = (0..32 * 32).flat_map(|at| [if is_line(at % 32, at / 32) { 255 } else { 0 }, 0, 0, 255]);
        Image { size: [32, 32], pixels: Pixels::U8(pixels.collect()), opaque: true }
    }

    fn band(x: usize) -> bool {
        (10..14).contains(&x)
    }

    #[test]
    fn a_picture_has_its_own_lines() {
        let truth = picture(|x, _| band(x));
        let same = LineErrors { precision: 1.0, recall: 1.0, width_error_px: 0.0, gaps: 0 };
        assert_eq!(LineErrors::of(&truth, &truth, 4.0), same);
        assert_eq!(same.f1(), 1.0);
    }

    #[test]
    fn a_line_beside_its_place_is_found_within_a_pixel() {
        let truth = picture(|x, _| band(x));
        let beside = |by: usize| LineErrors::of(&truth, &picture(|x, _| band(x + by)), 4.0);
        assert_eq!((beside(1).precision, beside(1).recall, beside(1).gaps), (1.0, 1.0, 0));
        // Two of four columns lie within a pixel of the other line's.
        assert_eq!((beside(3).precision, beside(3).recall, beside(3).gaps), (0.5, 0.5, 1));
    }

    #[test]
    fn a_line_of_another_width_differs_by_that() {
        let truth = picture(|x, _| band(x));
        let wider = LineErrors::of(&truth, &picture(|x, _| (10..15).contains(&x)), 4.0);
        assert!(
            (wider.width_error_px - 1.0).abs() < 1e-6 && wider.recall == 1.0 && wider.precision == 1.0,
            "{wider:?}"
        );
        let none = LineErrors::of(&truth, &picture(|_, _| false), 4.0);
        assert_eq!((none.width_error_px, none.recall, none.precision, none.gaps), (4.0, 0.0, 1.0, 1));
    }

    #[test]
    fn gaps_are_counted_beyond_the_tolerance() {
        let truth = picture(|x, _| band(x));
        let drawn =
            |is_open: &dyn Fn(usize) -> bool| LineErrors::of(&truth, &picture(|x, y| band(x) && !is_open(y)), 4.0).gaps;
        assert_eq!(
            [
                drawn(&|y| (5..7).contains(&y)),
                drawn(&|y| (5..8).contains(&y)),
                drawn(&|y| (5..9).contains(&y) || y > 20)
            ],
            [0, 1, 2]
        );
    }
}
