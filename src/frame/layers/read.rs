//! Lists of transparent fragments, read back.

use super::{Layers, RUN};
use crate::gpu::{Gpu, GpuError, read_words};

/// Where the lists of a band lie among those of all.
pub struct BandLists {
    pub rows: std::ops::Range<u32>,
    pub held: std::ops::Range<u32>,
}

impl BandLists {
    /// Words of its ends, and of its runs behind them.
    pub fn words(&self, width: u32) -> [usize; 2] {
        let pixels = (self.held.end - self.held.start) * width;
        [pixels, pixels.div_ceil(RUN)].map(|words| words as usize)
    }
}

/// Start and end of each list.
fn bounds_of<'a>(ends: &'a [u32], runs: &'a [u32]) -> impl Iterator<Item = [u32; 2]> + 'a {
    let of_run = |(run, start): (&'a [u32], &'a u32)| {
        let starts = std::iter::once(start).chain(run);
        starts.zip(run).map(|(start, end)| [*start, *end])
    };
    ends.chunks(RUN as usize).zip(runs).flat_map(of_run)
}

impl Layers {
    /// Surfaces that each pixel of the last frame for AOVs has; none where nothing is transparent.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where they cannot be read.
    pub fn read_counts(&mut self, gpu: &Gpu) -> Result<Option<Vec<u32>>, GpuError> {
        let Some((all, bands)) = self.all_lists.take() else { return Ok(None) };
        let words = read_words(gpu, &all)?;
        let mut counts = Vec::with_capacity(self.size.map(|side| side as usize).iter().product());
        let mut left = &words[..];
        for band in bands {
            let [num_ends, num_runs] = band.words(self.size[0]);
            let ((ends, rest), skipped) = (left.split_at(num_ends), band.rows.start - band.held.start);
            let [before, of_rows] =
                [skipped, band.rows.end - band.rows.start].map(|rows| (rows * self.size[0]) as usize);
            let bounds = bounds_of(ends, &rest[..num_runs]).skip(before).take(of_rows);
            counts.extend(bounds.map(|[start, end]| end.saturating_sub(start)));
            left = &rest[num_runs..];
        }
        Ok(Some(counts))
    }

    /// All fragments of each pixel of the last frame, from near to far: the bits of its depth, and its id. None where it was drawn in
    /// bands, or not at all.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where they cannot be read.
    pub fn read_lists(&self, gpu: &Gpu) -> Result<Option<Vec<Vec<[u32; 2]>>>, GpuError> {
        let (Some(ends), Some(runs), Some(pool), 1) = (&self.ends, &self.runs, &self.pool, self.num_bands) else {
            return Ok(None);
        };
        let (ends, runs, pool) = (read_words(gpu, ends)?, read_words(gpu, runs)?, read_words(gpu, pool)?);
        let list = |[start, end]: [u32; 2]| {
            let words = pool.chunks_exact(2).skip(start as usize).take(end.saturating_sub(start) as usize);
            words.map(|words| [words[0], words[1]]).collect()
        };
        Ok(Some(bounds_of(&ends, &runs).map(list).collect()))
    }
}
