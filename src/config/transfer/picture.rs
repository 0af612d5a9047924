//! Transfer functions as pictures: PNG files of numbers, not of light, so that nothing is decoded from sRGB.

use std::fs::File;
use std::io::{BufReader, Read, Seek};

use super::{Between, COLOR_SIZE, MAX_FACTOR, MAX_PICTURE_SIDE_PX, Nodes, OPACITY_SIZE, TransferKind};

/// The first bytes of every PNG file [Png2003 §5.2].
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Samples of a picture, each a share of the largest that its depth allows.
struct Samples {
    bytes: Vec<u8>,
    row_bytes: usize,
    /// Of one pixel: grey or red, green and blue, then alpha if there is one.
    per_pixel: usize,
    is_wide: bool,
}

impl Samples {
    fn get(&self, x: usize, y: usize, channel: usize) -> f64 {
        let index = x * self.per_pixel + channel;
        let row = &self.bytes[y * self.row_bytes..];
        if self.is_wide {
            f64::from(u16::from_be_bytes([row[2 * index], row[2 * index + 1]])) / f64::from(u16::MAX)
        } else {
            f64::from(row[index]) / f64::from(u8::MAX)
        }
    }
}

/// Reads the nodes of a transfer function from a PNG file, or says what is wrong with it.
///
/// Of an opacity, the grey or red values are taken, from flat at the left to most curved at the right, and from far at
/// the top to near at the bottom. A colour is one row from most convex at the left to most concave at the right, where
/// full is a factor of [`MAX_FACTOR`]. Alpha means nothing.
pub(in crate::config) fn read(kind: TransferKind, file: &mut File) -> Result<Nodes, String> {
    let mut start = Vec::new();
    let cannot_read = |error: std::io::Error| format!("this file cannot be read: {error}");
    file.by_ref().take(SIGNATURE.len() as u64).read_to_end(&mut start).map_err(cannot_read)?;
    if start.is_empty() {
        return Err("this file is empty: save the picture again".to_owned());
    }
    if start != SIGNATURE {
        return Err("this is no PNG picture, whatever its name says: export it as PNG".to_owned());
    }
    file.rewind().map_err(cannot_read)?;

    let broken = |error: png::DecodingError| {
        format!("this PNG is broken ({}): save it again", error.to_string().trim_end_matches('.'))
    };
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(png::Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let [width, height] = decoder.read_header_info().map(|info| [info.width, info.height]).map_err(broken)?;
    if width.max(height) > MAX_PICTURE_SIDE_PX {
        return Err(format!(
            "this picture is {width}x{height} pixels: make it at most {MAX_PICTURE_SIDE_PX} pixels wide and high"
        ));
    }
    if kind == TransferKind::Color && height != 1 {
        return Err(format!(
            "this picture is {height} pixels high, but one of colours has the height 1: crop it to one row"
        ));
    }
    let mut reader = decoder.read_info().map_err(broken)?;
    let (color, depth) = reader.output_color_type();
    let no_memory = || format!("the {width}x{height} pixels of this picture do not fit into memory: make it smaller");
    let num_bytes = reader.output_buffer_size().ok_or_else(no_memory)?;
    Vec::<u8>::new().try_reserve_exact(num_bytes).map_err(|_| no_memory())?;
    // Zeros that nothing was decoded to are no memory yet.
    let mut bytes = vec![0; num_bytes];
    reader.next_frame(&mut bytes).map_err(broken)?;
    // What follows the pixels holds their checksums.
    reader.finish().map_err(broken)?;
    let [width, height] = [width as usize, height as usize];
    let samples = Samples {
        row_bytes: num_bytes / height,
        bytes,
        per_pixel: color.samples(),
        is_wide: depth == png::BitDepth::Sixteen,
    };
    Ok(match kind {
        TransferKind::Opacity => opacity(&samples, width, height),
        TransferKind::Color => colors(&samples, width),
    })
}

fn opacity(samples: &Samples, width: usize, height: usize) -> Nodes {
    let [columns, rows] = OPACITY_SIZE;
    let across: Vec<Weights> = (0..columns).map(|i| Weights::new(i, columns, width)).collect();
    let lines: Vec<Vec<f64>> =
        (0..height).map(|y| across.iter().map(|weights| weights.sum(|x| samples.get(x, y, 0))).collect()).collect();
    let row = |i: usize| {
        // The last line is the nearest.
        let weights = Weights::new(rows - 1 - i, rows, height);
        (0..columns).map(|column| weights.sum(|y| lines[y][column]) as f32).collect::<Vec<_>>()
    };
    Nodes::Opacity((0..rows).flat_map(row).collect())
}

fn colors(samples: &Samples, width: usize) -> Nodes {
    let node = |i: usize| {
        let weights = Weights::new(i, COLOR_SIZE, width);
        let channel = |c: usize| weights.sum(|x| samples.get(x, 0, c)) * MAX_FACTOR;
        match samples.per_pixel {
            1 | 2 => [channel(0); 3],
            _ => [0, 1, 2].map(channel),
        }
        .map(|value| value as f32)
    };
    Nodes::Color((0..COLOR_SIZE).map(node).collect())
}

/// How much of each pixel of a row goes into one node; together 1.
struct Weights {
    first: usize,
    shares: Vec<f64>,
}

impl Weights {
    /// For one of `count` nodes over a row of pixels, of which the first and the last lie on the first and last node.
    fn new(node: usize, count: usize, pixels: usize) -> Self {
        if pixels == 1 {
            return Self { first: 0, shares: vec![1.0] };
        }
        if pixels < count {
            let between = Between::new(node as f64 / (count - 1) as f64, pixels);
            return Self { first: between.low, shares: vec![1.0 - between.share, between.share] };
        }
        // A node takes the pixels that are nearer to it than to another one, each by the length that it covers. At
        // either end that is half as much, and would lie to one side: the end takes its own pixel alone.
        let step = (pixels - 1) as f64 / (count - 1) as f64;
        let (centre, reach) = (node as f64 * step, if node == 0 || node == count - 1 { 0.5 } else { step / 2.0 });
        let (from, to) = (centre - reach, centre + reach);
        let first = (from + 0.5).floor().max(0.0) as usize;
        let last = ((to + 0.5).ceil() as usize).clamp(first + 1, pixels);
        let covered = |pixel: usize| (to.min(pixel as f64 + 0.5) - from.max(pixel as f64 - 0.5)).max(0.0);
        let covered: Vec<f64> = (first..last).map(covered).collect();
        let total: f64 = covered.iter().sum();
        Self { first, shares: covered.iter().map(|share| share / total).collect() }
    }

    fn sum(&self, of_pixel: impl Fn(usize) -> f64) -> f64 {
        self.shares.iter().zip(self.first..).map(|(share, pixel)| share * of_pixel(pixel)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_shares_and_keep_the_ends() {
        for pixels in [1, 2, 3, 16, 64, 65, 66, 100, 129, 256, 1000, 4096] {
            for count in [COLOR_SIZE, OPACITY_SIZE[1]] {
                for node in 0..count {
                    let weights = Weights::new(node, count, pixels);
                    assert!((weights.sum(|_| 1.0) - 1.0).abs() < 1e-12, "{pixels} pixels, node {node}");
                    assert!(weights.first + weights.shares.len() <= pixels, "{pixels} pixels, node {node}");
                    // A ramp stays one, but for how a pixel is cut in two.
                    let ramp = weights.sum(|pixel| pixel as f64 / (pixels - 1).max(1) as f64);
                    let due = if pixels == 1 { 0.0 } else { node as f64 / (count - 1) as f64 };
                    assert!((ramp - due).abs() < 2e-3, "{pixels} pixels, node {node}: {ramp}");
                }
                let ends = [0, count - 1].map(|node| Weights::new(node, count, pixels).sum(|pixel| pixel as f64));
                assert_eq!(ends, [0.0, (pixels - 1) as f64]);
            }
        }
    }

    #[test]
    fn a_larger_row_is_averaged() {
        // 129 pixels are two for each node; one in two is full.
        let weights = Weights::new(7, COLOR_SIZE, 129);
        assert!((weights.sum(|pixel| (pixel % 2) as f64) - 0.5).abs() < 1e-12);
        // As many pixels as nodes are the nodes.
        assert_eq!(Weights::new(7, COLOR_SIZE, COLOR_SIZE).sum(|pixel| pixel as f64), 7.0);
    }
}
