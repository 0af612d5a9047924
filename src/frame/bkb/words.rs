//! The k-buffer of the last frame word by word, for whoever holds it to its twin.

use super::{Bkb, BkbBand};
use crate::gpu::{Gpu, GpuError, read_words};

/// What the k-buffer of a frame in one band holds after blending, and the fragments that it was made of.
#[derive(Debug, Clone)]
pub struct BkbWords {
    /// Sizes and scales.
    pub band: BkbBand,
    /// Z: 16 bits of shape above 16 bits of depth, k for each pixel.
    pub z: Vec<u32>,
    /// B: 16 bits of shape, 8 bits each for its first and last slot.
    pub b: Vec<u32>,
    /// D: two words for each slot, the stylised colour and the normal.
    pub d: Vec<u32>,
    /// kappa of each slot.
    pub kappa: Vec<f32>,
    /// All fragments of each pixel: the bits of its depth, and its id.
    pub fragments: Vec<Vec<[u32; 2]>>,
}

impl Bkb {
    /// Reads it; none where the last frame kept none, or was drawn in bands.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where it cannot be read.
    pub fn read(&self, gpu: &Gpu) -> Result<Option<BkbWords>, GpuError> {
        let (Some(buffers), [band]) = (&self.buffers, &self.bands[..]) else { return Ok(None) };
        let (Some(b), Some(kappa)) = (&buffers.b, &buffers.kappa) else { return Ok(None) };
        let kappa = read_words(gpu, kappa)?.into_iter().map(f32::from_bits).collect();
        let [z, b, d] = [&buffers.z, b, &buffers.d].map(|buffer| read_words(gpu, buffer));
        Ok(Some(BkbWords { band: *band, z: z?, b: b?, d: d?, kappa, fragments: Vec::new() }))
    }
}
