//! Maps of pictures, made by all cores: bands of rows, each by itself, so that the result does not depend on their
//! order.

use std::ops::Range;
use std::sync::Mutex;
use std::thread;

/// Rows of a band: so few that what a filter keeps of them fits in a cache, so many that its margin costs little.
const BAND_ROWS: usize = 64;

/// Fills a map of rows of `width` values: `work` is given the rows of a band and their values.
pub(super) fn fill(map: &mut [f32], width: usize, work: impl Fn(Range<usize>, &mut [f32]) + Sync) {
    if width == 0 {
        return;
    }
    let num_bands = map.len().div_ceil(width * BAND_ROWS);
    let num_threads = thread::available_parallelism().map_or(1, usize::from).min(num_bands);
    let bands = Mutex::new(map.chunks_mut(width * BAND_ROWS).enumerate());
    let next = || bands.lock().ok().and_then(|mut bands| bands.next());
    thread::scope(|scope| {
        for _ in 0..num_threads {
            scope.spawn(|| {
                while let Some((index, band)) = next() {
                    let start = index * BAND_ROWS;
                    work(start..start + band.len() / width, band);
                }
            });
        }
    });
}
