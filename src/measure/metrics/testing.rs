//! Pictures for tests, the same on every machine.

use super::picture::Picture;

/// A picture of a function of place.
pub(super) fn picture(size: [u32; 2], color: impl Fn(usize, usize) -> [f32; 3]) -> Picture {
    let (width, height) = (size[0] as usize, size[1] as usize);
    Picture { size, rgb: (0..width * height).map(|index| color(index % width, index / width)).collect() }
}

/// Values of 8 bits in no order.
pub(super) fn noise(size: [u32; 2], seed: u32) -> Picture {
    picture(size, |x, y| std::array::from_fn(|c| f32::from(scattered(x as u32, y as u32, c as u32 + 3 * seed)) / 255.0))
}

/// A byte of a place: the mixing of MurmurHash3 in its published form [Appleby2011].
pub(super) fn scattered(x: u32, y: u32, seed: u32) -> u8 {
    let mut hash = x ^ y.rotate_left(16) ^ seed.wrapping_mul(0x9e37_79b9);
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    (hash ^ (hash >> 16)) as u8
}
