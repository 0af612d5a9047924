//! AOVs on the CPU: linear float pictures, and their OpenEXR files.

use std::io;
use std::path::Path;

use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage};

use super::image::write_whole;

/// Which picture of the geometry or light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AovName {
    /// -z_view in scene units, infinity where nothing is.
    Depth,
    /// Unit normal in view space, turned to the viewer; 0 where nothing is.
    Normal,
    /// Number of the drawn object, from 1; 0 where nothing is.
    Id,
    /// Premultiplied linear colour.
    Color,
    /// Share of light that ambient occlusion leaves, -1 where nothing is.
    Ao,
    /// Diameter of the circle of confusion in pixels, -1 where nothing is.
    Coc,
    /// How many transparent surfaces a pixel's ray meets in front of what is opaque.
    LayerCount,
    /// Sum of the principal curvatures of the nearest surface as it is seen, negative where convex, over scene units; no number
    /// where nothing is.
    Curvature,
}

impl AovName {
    /// All of them, by their names on the command line.
    pub const ALL: [(&'static str, AovName); 8] = [
        ("depth", AovName::Depth),
        ("normal", AovName::Normal),
        ("id", AovName::Id),
        ("color", AovName::Color),
        ("ao", AovName::Ao),
        ("coc", AovName::Coc),
        ("layer_count", AovName::LayerCount),
        ("curvature", AovName::Curvature),
    ];
}

/// One sample at each pixel's centre, rows from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct AovImage {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// -z_view in scene units, infinity where nothing is.
    pub depth: Vec<f32>,
    /// Three floats a pixel.
    pub normal: Vec<f32>,
    /// Kind in the upper 3 bits, index in the lower 29; 0 where nothing is.
    pub ids: Vec<u32>,
    /// Four floats a pixel, premultiplied linear.
    pub color: Vec<f32>,
    /// Share of light that ambient occlusion leaves, -1 where nothing is.
    pub ao: Vec<f32>,
    /// Diameter of the circle of confusion in pixels, -1 where nothing is.
    pub coc: Vec<f32>,
    /// How many transparent surfaces a pixel's ray meets in front of what is opaque.
    pub layer_count: Vec<u32>,
    /// Sum of the principal curvatures of the nearest surface as it is seen, negative where convex, over scene units; no number
    /// where nothing is.
    pub curvature: Vec<f32>,
}

impl AovImage {
    /// Writes one of the pictures as OpenEXR, 32 bits a channel. The file appears whole or not at all.
    ///
    /// # Errors
    /// Whatever the file system or the encoder says.
    pub fn write_exr(&self, name: AovName, path: &Path) -> io::Result<()> {
        let plane = |values: &[f32], stride: usize, offset: usize| {
            FlatSamples::F32(values.iter().skip(offset).step_by(stride).copied().collect())
        };
        let channels = match name {
            AovName::Depth => vec![AnyChannel::new("Z", plane(&self.depth, 1, 0))],
            AovName::Normal => ["X", "Y", "Z"]
                .into_iter()
                .enumerate()
                .map(|(offset, channel)| AnyChannel::new(channel, plane(&self.normal, 3, offset)))
                .collect(),
            AovName::Ao => vec![AnyChannel::new("Y", plane(&self.ao, 1, 0))],
            AovName::Coc => vec![AnyChannel::new("Y", plane(&self.coc, 1, 0))],
            AovName::LayerCount => vec![AnyChannel::new("Y", FlatSamples::U32(self.layer_count.clone()))],
            AovName::Curvature => vec![AnyChannel::new("Y", plane(&self.curvature, 1, 0))],
            AovName::Id => vec![AnyChannel::new("id", FlatSamples::U32(self.ids.clone()))],
            AovName::Color => ["R", "G", "B", "A"]
                .into_iter()
                .enumerate()
                .map(|(offset, channel)| AnyChannel::new(channel, plane(&self.color, 4, offset)))
                .collect(),
        };
        let size = (self.size[0] as usize, self.size[1] as usize);
        let layer = Layer::new(
            size,
            LayerAttributes::named("restyle"),
            Encoding::FAST_LOSSLESS,
            AnyChannels::sort(channels.into_iter().collect()),
        );
        let image = Image::from_layer(layer);
        write_whole(path, |file| image.write().to_buffered(file).map_err(io::Error::other))
    }
}
