//! Pictures that are drawn tile by tile and given away row by row, so that memory does not grow with their height.

use std::io;
use std::ops::{ControlFlow, Range};

use super::{Engine, Request};
use crate::frame::Tile;
use crate::gpu::GpuError;

/// Largest side of a tile in pixels: a gigabyte for all targets of a tile would be too much, a thousand tiles too slow.
const TILE_PX: u32 = 2048;

/// Pictures of more pixels are drawn in tiles.
const WHOLE_PX: u64 = 4 << 20;

/// Why a picture in tiles was not finished.
#[derive(Debug)]
pub enum TileError {
    /// The device.
    Gpu(GpuError),
    /// Whoever takes the rows.
    Sink(io::Error),
}

impl From<GpuError> for TileError {
    fn from(error: GpuError) -> TileError {
        TileError::Gpu(error)
    }
}

/// Pixels to a side of the largest texel that an effect has.
const LARGEST_TEXEL_PX: u32 = 32;

/// The tiles along one side: what each holds of the picture, and what is drawn for it, which reaches `margin` farther.
fn spans(length: u32, margin: u32) -> impl Iterator<Item = (Range<u32>, Range<u32>)> {
    (0..length.div_ceil(TILE_PX)).map(move |index| {
        let start = index * TILE_PX;
        let end = length.min(start + TILE_PX);
        (start..end, start.saturating_sub(margin)..length.min(end.saturating_add(margin)))
    })
}

impl Engine {
    /// Whether a picture is so large that it is drawn in tiles.
    pub fn is_tiled(request: &Request) -> bool {
        u64::from(request.size[0]) * u64::from(request.size[1]) > WHOLE_PX
    }

    /// Refuses a picture that the device cannot draw, in tiles or not.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] with both sizes.
    pub fn check_size(&self, request: &Request) -> Result<(), GpuError> {
        crate::frame::check_picture(&self.gpu, request.size)
    }

    /// The first tile of a picture that is drawn in tiles.
    pub(super) fn first_tile(request: &Request) -> Option<Tile> {
        Engine::is_tiled(request)
            .then(|| Tile { origin_px: [0, 0], size_px: request.size.map(|side| side.min(TILE_PX)) })
    }

    /// How many tiles a picture has.
    pub fn num_tiles(request: &Request) -> u32 {
        request.size[0].div_ceil(TILE_PX).saturating_mul(request.size[1].div_ceil(TILE_PX))
    }

    /// Draws a picture in tiles, which overlap by as much as effects reach, and gives `sink` its rows from the top, some
    /// at a time: RGBA, 8 bits a channel, or 16 in native order. `progress` hears of tiles that are done, and may break off.
    ///
    /// # Errors
    /// As [`Engine::draw`], and whatever `sink` says.
    pub fn draw_rows(
        &mut self,
        request: &Request,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
        sink: &mut dyn FnMut(&[u8]) -> io::Result<()>,
    ) -> Result<(), TileError> {
        let [width, height] = request.size;
        let bytes_per_pixel = if request.wide { 8 } else { 4 };
        let row_bytes = width as usize * bytes_per_pixel;
        // Texels of effects that stand for several pixels lie as in the whole picture.
        let margin = self.reach_px(request)?.next_multiple_of(LARGEST_TEXEL_PX);
        let mut done = 0;
        for (rows, drawn_rows) in spans(height, margin) {
            let mut band = vec![0; rows.len() * row_bytes];
            for (columns, drawn_columns) in spans(width, margin) {
                let tile = Tile {
                    origin_px: [drawn_columns.start, drawn_rows.start],
                    size_px: [drawn_columns.len() as u32, drawn_rows.len() as u32],
                };
                // The first tile draws the shadow maps for all.
                let pixels = self.draw_tile(request, tile, done > 0)?;
                let copied = columns.len() * bytes_per_pixel;
                let tile_row_bytes = drawn_columns.len() * bytes_per_pixel;
                for (row, target) in rows.clone().zip(band.chunks_exact_mut(row_bytes)) {
                    let start = (row - drawn_rows.start) as usize * tile_row_bytes
                        + (columns.start - drawn_columns.start) as usize * bytes_per_pixel;
                    let at = columns.start as usize * bytes_per_pixel;
                    target[at..at + copied].copy_from_slice(&pixels[start..start + copied]);
                }
                done += 1;
                if progress(done).is_break() {
                    return Err(GpuError::BrokenOff.into());
                }
            }
            sink(&band).map_err(TileError::Sink)?;
        }
        Ok(())
    }

    /// One tile's pixels.
    fn draw_tile(&mut self, request: &Request, tile: Tile, shadows_drawn: bool) -> Result<Vec<u8>, GpuError> {
        self.with_input(request, |renderer, input| {
            let input = crate::frame::FrameInput { tile: Some(tile), shadows_drawn, ..input.clone() };
            renderer.render(&input, false, &mut |_| ControlFlow::Continue(()))?;
            renderer.read(request.wide)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_side_and_overlap_within_it() {
        let all: Vec<_> = spans(5000, 10).collect();
        assert_eq!(all, [(0..2048, 0..2058), (2048..4096, 2038..4106), (4096..5000, 4086..5000)]);
        assert_eq!(spans(16, 10).collect::<Vec<_>>(), [(0..16, 0..16)]);
    }
}
