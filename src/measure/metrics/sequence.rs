//! How steady a sequence of pictures is: flicker and pops that are not in the truth.

use glam::Vec3;

use super::mask::Mask;
use super::picture::{BLACK, Picture};
use super::{SizesDiffer, common_background, flip, same_size};
use crate::scene::Image;

/// How steady a sequence is, beside its truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stability {
    /// Mean over steps, pixels and channels of `||I_t - I_(t-1)| - |R_t - R_(t-1)||`, I the sequence and R the truth,
    /// display values: change that the truth does not have, or lacks. 0 is as steady as the truth.
    pub flicker: f64,
    /// Largest `FLIP(I_t, I_(t-1)) - FLIP(R_t, R_(t-1))`, each the mean over the pixels that count: the plainest jump
    /// that the truth does not have. Below 0 where the sequence moves less than the truth in every step.
    pub pop: f64,
    /// The picture that the plainest jump leads to, counted from 0.
    pub pop_frame: usize,
}

/// A sequence that is measured picture by picture, so that no more than two of them are kept.
#[derive(Debug, Default)]
pub struct Sequence {
    /// Every pixel counts, not only those covered in any of the four pictures of a step.
    pub all_pixels: bool,
    /// The background (sRGB display values): transparent pictures are laid over it, opaque ones cover what differs from
    /// it. By default the colour of all corners, and black under transparent pictures.
    pub background: Option<[f32; 3]>,
    former: Option<[Image; 2]>,
    num_frames: usize,
    flicker_sum: f64,
    /// Size of the plainest jump, and the picture that it leads to.
    pop: Option<(f64, usize)>,
}

impl Sequence {
    /// A sequence of which no picture is known yet.
    pub fn new() -> Sequence {
        Sequence::default()
    }

    /// Adds the next picture, and the truth at the same place of the path.
    ///
    /// # Errors
    /// All pictures of a sequence have one size.
    pub fn push(&mut self, frame: &Image, truth: &Image) -> Result<(), SizesDiffer> {
        same_size(frame.size, truth.size)?;
        if let Some(former) = &self.former {
            same_size(former[0].size, frame.size)?;
            let images = [frame, &former[0], truth, &former[1]];
            let background = self.background.or_else(|| common_background(&images));
            let mask = if self.all_pixels { Mask::all(frame.size) } else { Mask::covered(&images, background) };
            let [now, before, truth_now, truth_before] =
                images.map(|image| Picture::new(image, background.unwrap_or(BLACK)));
            let [change, due] = [changes(&now, &before), changes(&truth_now, &truth_before)];
            let flicker: Vec<f32> =
                change.zip(due).map(|(change, due)| (change - due).abs().element_sum() / 3.0).collect();
            self.flicker_sum += mask.mean(&flicker);
            let jump = mask.mean(&flip::map(&before, &now)) - mask.mean(&flip::map(&truth_before, &truth_now));
            if self.pop.is_none_or(|(largest, _)| jump > largest) {
                self.pop = Some((jump, self.num_frames));
            }
        }
        self.former = Some([frame.clone(), truth.clone()]);
        self.num_frames += 1;
        Ok(())
    }

    /// What was measured; none of fewer than two pictures.
    pub fn stability(&self) -> Option<Stability> {
        let (pop, pop_frame) = self.pop?;
        Some(Stability { flicker: self.flicker_sum / (self.num_frames - 1) as f64, pop, pop_frame })
    }
}

/// How much each pixel changed.
fn changes(now: &Picture, before: &Picture) -> impl Iterator<Item = Vec3> {
    now.rgb.iter().zip(&before.rgb).map(|(now, before)| (Vec3::from(*now) - Vec3::from(*before)).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Pixels;

    /// A grey picture of one level, but for one pixel.
    fn grey(level: u8, dot: u8) -> Image {
        let pixels = (0..16 * 16).flat_map(|index| {
            let level = if index == 8 * 16 + 8 { dot } else { level };
            [level, level, level, 255]
        });
        Image { size: [16, 16], pixels: Pixels::U8(pixels.collect()), opaque: true }
    }

    fn measured(frames: &[(u8, u8)], truth: &[(u8, u8)], all_pixels: bool) -> Stability {
        let mut sequence = Sequence { all_pixels, ..Sequence::new() };
        for ((level, dot), (truth, truth_dot)) in frames.iter().zip(truth) {
            sequence.push(&grey(*level, *dot), &grey(*truth, *truth_dot)).unwrap();
        }
        sequence.stability().unwrap()
    }

    #[test]
    fn a_sequence_that_moves_as_its_truth_is_steady() {
        let path = [(10, 50), (20, 60), (40, 20)];
        let steady = measured(&path, &path, false);
        assert_eq!((steady.flicker, steady.pop), (0.0, 0.0));
        // A constant error does not flicker.
        let brighter = path.map(|(level, dot)| (level + 51, dot + 51));
        assert!(measured(&brighter, &path, true).flicker < 1e-7);
    }

    #[test]
    fn change_that_the_truth_lacks_is_flicker() {
        let still = [(100, 100); 4];
        let steps = [(100, 100), (151, 151), (151, 151), (100, 100)];
        // A fifth of the range in two of three steps.
        let flicker = measured(&steps, &still, true);
        assert!((flicker.flicker - 0.2 * 2.0 / 3.0).abs() < 1e-6, "{flicker:?}");
        assert_eq!(flicker.pop_frame, 1);
        // The other way round it is change that is missing.
        let missing = measured(&still, &steps, true);
        assert!((missing.flicker - flicker.flicker).abs() < 1e-12 && missing.pop <= 0.0);
        assert_eq!(missing.pop_frame, 2);
    }

    #[test]
    fn a_dot_that_pops_counts_in_its_margin_alone() {
        let still = [(100, 100); 3];
        let dot = [(100, 100), (100, 151), (100, 100)];
        let [all, covered] = [true, false].map(|all| measured(&dot, &still, all));
        assert!((all.flicker - 0.2 / 256.0).abs() < 1e-7 && (covered.flicker - 0.2 / 25.0).abs() < 1e-6);
        assert!(covered.pop > all.pop && all.pop > 0.0, "{all:?} {covered:?}");
    }

    #[test]
    fn one_picture_or_another_size_is_no_sequence() {
        let mut sequence = Sequence::new();
        assert_eq!(sequence.stability(), None);
        sequence.push(&grey(1, 1), &grey(1, 1)).unwrap();
        assert_eq!(sequence.stability(), None);
        let small = Image { size: [1, 1], pixels: Pixels::U8(vec![0; 4]), opaque: false };
        assert!(sequence.push(&grey(1, 1), &small).is_err());
        assert_eq!(sequence.push(&small, &small), Err(SizesDiffer { reference: [16, 16], test: [1, 1] }));
    }
}
