//! Pictures on the CPU: eight or sixteen bits a channel, and their PNG files.

use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Channel values, four a pixel: straight-alpha sRGB.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Pixels {
    /// 8 bits a channel.
    U8(Vec<u8>),
    /// 16 bits a channel.
    U16(Vec<u16>),
}

/// A picture: rows from the top, RGBA.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The values.
    pub pixels: Pixels,
    /// Every alpha is full: files need no alpha channel.
    pub opaque: bool,
}

impl Image {
    /// A pixel as values of 0..1, RGBA.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 4] {
        let start = (y as usize * self.size[0] as usize + x as usize) * 4;
        match &self.pixels {
            Pixels::U8(values) => std::array::from_fn(|c| f32::from(values[start + c]) / 255.0),
            Pixels::U16(values) => std::array::from_fn(|c| f32::from(values[start + c]) / 65535.0),
        }
    }

    /// Writes a PNG file, sRGB-tagged. The file appears whole or not at all.
    ///
    /// # Errors
    /// Whatever the file system says.
    pub fn write_png(&self, path: &Path) -> io::Result<()> {
        write_whole(path, |file| self.encode_png(file))
    }

    /// Encodes a PNG.
    ///
    /// # Errors
    /// Whatever the writer says.
    pub fn encode_png(&self, writer: &mut dyn Write) -> io::Result<()> {
        let mut encoder = png::Encoder::new(writer, self.size[0], self.size[1]);
        encoder.set_color(if self.opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
        encoder.set_compression(png::Compression::Fast);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let keep = if self.opaque { 3 } else { 4 };
        let bytes: Vec<u8> = match &self.pixels {
            Pixels::U8(values) => {
                encoder.set_depth(png::BitDepth::Eight);
                values.chunks_exact(4).flat_map(|pixel| &pixel[..keep]).copied().collect()
            }
            Pixels::U16(values) => {
                encoder.set_depth(png::BitDepth::Sixteen);
                values.chunks_exact(4).flat_map(|pixel| &pixel[..keep]).flat_map(|value| value.to_be_bytes()).collect()
            }
        };
        let mut writer = encoder.write_header().map_err(io::Error::other)?;
        writer.write_image_data(&bytes).map_err(io::Error::other)?;
        writer.finish().map_err(io::Error::other)
    }
}

/// Writes a file beside its place first, then moves it there: nothing half-written stays.
///
/// # Errors
/// Whatever the file system says; the former file is then as it was.
pub fn write_whole(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<std::fs::File>) -> io::Result<()>,
) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "this is a folder"));
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let beside = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
    let result = std::fs::File::create(&beside).and_then(|file| {
        let mut writer = BufWriter::new(file);
        content(&mut writer)?;
        writer.flush()?;
        std::fs::rename(&beside, path)
    });
    if result.is_err() {
        // Nothing more can be done about a part that cannot be removed either.
        let _ = std::fs::remove_file(&beside);
    }
    result
}
