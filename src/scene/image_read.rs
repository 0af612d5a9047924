//! PNG files read back as pictures.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use super::image::{Image, Pixels};

/// Widest and highest picture that is read, in pixels: as large as `restyle render` writes.
pub const MAX_SIDE_PX: u32 = 16384;

/// The first bytes of every PNG file [Png2003 §5.2].
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// A file that gives no picture. Every message names the file, says what is wrong and what would help.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// There is no such file.
    #[error("{file}: no such file; check the spelling")]
    NotFound {
        /// The file as the caller named it.
        file: String,
    },
    /// The path is a folder.
    #[error("{file}: is a folder; give one of the pictures in it")]
    IsDirectory {
        /// The file as the caller named it.
        file: String,
    },
    /// The file may not be read.
    #[error("{file}: may not be read; change its permissions (chmod +r) or copy it")]
    NoPermission {
        /// The file as the caller named it.
        file: String,
    },
    /// Reading stopped for another reason.
    #[error("{file}: cannot be read ({source}); copy it to a local disk and try again")]
    Unreadable {
        /// The file as the caller named it.
        file: String,
        /// What the operating system said.
        source: io::Error,
    },
    /// The file holds nothing.
    #[error("{file}: is empty; was it saved completely?")]
    Empty {
        /// The file as the caller named it.
        file: String,
    },
    /// The file is of another kind, whatever its name says.
    #[error("{file}: is {what}, not a PNG picture; export it as PNG")]
    NotPng {
        /// The file as the caller named it.
        file: String,
        /// What it is, as far as its first bytes tell.
        what: &'static str,
    },
    /// More pixels than are read.
    #[error("{file}: is {}x{} pixels; at most {MAX_SIDE_PX}x{MAX_SIDE_PX} are read, so make it smaller", .size[0], .size[1])]
    TooLarge {
        /// The file as the caller named it.
        file: String,
        /// Width and height that the file states, in pixels.
        size: [u32; 2],
    },
    /// There is not enough memory for the pixels.
    #[error("{file}: its {}x{} pixels do not fit into memory; make it smaller", .size[0], .size[1])]
    NoMemory {
        /// The file as the caller named it.
        file: String,
        /// Width and height in pixels.
        size: [u32; 2],
    },
    /// The file ends before the picture does.
    #[error("{file}: ends before the picture does; copy or save it again")]
    Truncated {
        /// The file as the caller named it.
        file: String,
    },
    /// Bytes contradict the format.
    #[error("{file}: is a damaged PNG ({what}); copy or save it again")]
    Damaged {
        /// The file as the caller named it.
        file: String,
        /// What contradicts the format.
        what: String,
    },
}

impl Image {
    /// Reads a PNG file of any colour type and depth; values of less than 8 bits are widened to 8. Values are taken for
    /// sRGB, whatever profile or gamma the file names; of an animation the still picture is read.
    ///
    /// # Errors
    /// The file cannot be read, is no whole PNG, or has more than [`MAX_SIDE_PX`] pixels to a side, which is told
    /// before memory for them is taken.
    pub fn read_png(path: &Path) -> Result<Image, ImageError> {
        let file = || path.display().to_string();
        let of_io = |source: io::Error| match source.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => ImageError::NotFound { file: file() },
            io::ErrorKind::IsADirectory => ImageError::IsDirectory { file: file() },
            io::ErrorKind::PermissionDenied => ImageError::NoPermission { file: file() },
            io::ErrorKind::UnexpectedEof => ImageError::Truncated { file: file() },
            _ => ImageError::Unreadable { file: file(), source },
        };
        let of_png = |error: png::DecodingError, size: [u32; 2]| match error {
            png::DecodingError::IoError(error) => of_io(error),
            png::DecodingError::LimitsExceeded => ImageError::NoMemory { file: file(), size },
            other => ImageError::Damaged { file: file(), what: other.to_string().trim_end_matches('.').to_owned() },
        };

        let mut reader = File::open(path).map_err(of_io)?;
        let mut start = Vec::new();
        (&mut reader).take(SIGNATURE.len() as u64).read_to_end(&mut start).map_err(of_io)?;
        if start.is_empty() {
            return Err(ImageError::Empty { file: file() });
        }
        if !SIGNATURE.starts_with(&start) {
            return Err(ImageError::NotPng { file: file(), what: kind_of(&start) });
        }

        let mut decoder = png::Decoder::new(BufReader::new(WithStart { start, num_given: 0, rest: reader }));
        decoder.set_transformations(png::Transformations::EXPAND);
        decoder.set_ignore_text_chunk(true);
        decoder.set_ignore_iccp_chunk(true);
        let size = decoder.read_header_info().map(|info| [info.width, info.height]).map_err(|e| of_png(e, [0; 2]))?;
        if size.iter().any(|side| *side > MAX_SIDE_PX) {
            return Err(ImageError::TooLarge { file: file(), size });
        }
        let mut reader = decoder.read_info().map_err(|error| of_png(error, size))?;
        let (color, depth) = reader.output_color_type();
        let mut rgba = if depth == png::BitDepth::Sixteen { Pixels::U16(Vec::new()) } else { Pixels::U8(Vec::new()) };
        let no_memory = || ImageError::NoMemory { file: file(), size };
        let row_bytes = reader.output_line_size(size[0]).ok_or_else(no_memory)?;
        if reader.info().interlaced {
            let num_bytes = reader.output_buffer_size().ok_or_else(no_memory)?;
            Vec::<u8>::new().try_reserve_exact(num_bytes).map_err(|_| no_memory())?;
            // Zeros that nothing was decoded to are no memory yet.
            let mut bytes = vec![0; num_bytes];
            reader.next_frame(&mut bytes).map_err(|error| of_png(error, size))?;
            for row in bytes.chunks_exact(row_bytes.max(1)) {
                append(&mut rgba, row, color).map_err(|_| no_memory())?;
            }
        } else {
            // Row by row: a small file that states a large size takes no more memory than it has rows.
            let mut row = vec![0; row_bytes];
            for _ in 0..size[1] {
                if reader.read_row(&mut row).map_err(|error| of_png(error, size))?.is_none() {
                    return Err(ImageError::Truncated { file: file() });
                }
                append(&mut rgba, &row, color).map_err(|_| no_memory())?;
            }
        }
        // What follows the pixels holds their checksums.
        reader.finish().map_err(|error| of_png(error, size))?;
        let opaque = match &rgba {
            Pixels::U8(values) => values.iter().skip(3).step_by(4).all(|alpha| *alpha == u8::MAX),
            Pixels::U16(values) => values.iter().skip(3).step_by(4).all(|alpha| *alpha == u16::MAX),
        };
        Ok(Image { size, pixels: rgba, opaque })
    }
}

/// Appends a row of a file as RGBA.
fn append(rgba: &mut Pixels, row: &[u8], color: png::ColorType) -> Result<(), std::collections::TryReserveError> {
    let num_samples = color.samples();
    match rgba {
        Pixels::U8(values) => {
            values.try_reserve(row.len() / num_samples * 4)?;
            values.extend(row.chunks_exact(num_samples).flat_map(|pixel| widened(pixel, u8::MAX)));
        }
        Pixels::U16(values) => {
            values.try_reserve(row.len() / num_samples * 2)?;
            let mut pixel = [0; 4];
            for bytes in row.chunks_exact(num_samples * 2) {
                for (sample, pair) in pixel.iter_mut().zip(bytes.chunks_exact(2)) {
                    *sample = u16::from_be_bytes([pair[0], pair[1]]);
                }
                values.extend(widened(&pixel[..num_samples], u16::MAX));
            }
        }
    }
    Ok(())
}

/// A pixel of one to four samples as RGBA.
fn widened<T: Copy>(pixel: &[T], full: T) -> [T; 4] {
    match *pixel {
        [grey] => [grey, grey, grey, full],
        [grey, alpha] => [grey, grey, grey, alpha],
        [r, g, b] => [r, g, b, full],
        [r, g, b, a, ..] => [r, g, b, a],
        [] => [full; 4],
    }
}

/// What a file is that does not start as a PNG does.
fn kind_of(start: &[u8]) -> &'static str {
    match start {
        [0xff, 0xd8, 0xff, ..] => "a JPEG",
        [b'G', b'I', b'F', b'8', ..] => "a GIF",
        [b'R', b'I', b'F', b'F', ..] => "a WebP or another RIFF file",
        [b'B', b'M', ..] => "a BMP",
        [b'I', b'I', b'*', 0, ..] | [b'M', b'M', 0, b'*', ..] => "a TIFF",
        [0x76, 0x2f, 0x31, 0x01, ..] => "an OpenEXR file",
        [b'%', b'P', b'D', b'F', ..] => "a PDF",
        _ => "another kind of file",
    }
}

/// A file whose first bytes were looked at already: pipes cannot be read twice.
struct WithStart {
    start: Vec<u8>,
    num_given: usize,
    rest: File,
}

impl Read for WithStart {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = &self.start[self.num_given..];
        if left.is_empty() {
            return self.rest.read(buffer);
        }
        let count = left.len().min(buffer.len());
        buffer[..count].copy_from_slice(&left[..count]);
        self.num_given += count;
        Ok(count)
    }
}

impl io::Seek for WithStart {
    /// The decoder asks for this trait and never seeks.
    fn seek(&mut self, _: io::SeekFrom) -> io::Result<u64> {
        Err(io::ErrorKind::Unsupported.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of its own that is gone afterwards.
    fn read(name: &str, bytes: &[u8]) -> Result<Image, ImageError> {
        let path = std::env::temp_dir().join(format!("restyle-read-{name}-{}.png", std::process::id()));
        std::fs::write(&path, bytes).unwrap();
        let image = Image::read_png(&path);
        std::fs::remove_file(&path).unwrap();
        image
    }

    /// A PNG of 2x1 pixels.
    fn encoded(
        color: png::ColorType,
        depth: png::BitDepth,
        bytes: &[u8],
        more: impl Fn(&mut png::Encoder<&mut Vec<u8>>),
    ) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        more(&mut encoder);
        let mut writer = encoder.write_header().unwrap();
        writer.write_image_data(bytes).unwrap();
        writer.finish().unwrap();
        file
    }

    #[test]
    fn every_colour_type_and_depth_is_read() {
        use png::BitDepth::{Eight, One, Sixteen, Two};
        use png::ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};
        let plain = |_: &mut png::Encoder<&mut Vec<u8>>| {};
        let bytes = |file: &[u8]| match read("types", file).unwrap() {
            Image { pixels: Pixels::U8(values), opaque, .. } => (values, opaque),
            other => panic!("{other:?}"),
        };
        let black_white = (vec![0, 0, 0, 255, 255, 255, 255, 255], true);
        assert_eq!(bytes(&encoded(Grayscale, One, &[0b0100_0000], plain)), black_white);
        assert_eq!(bytes(&encoded(Grayscale, Two, &[0b0011_0000], plain)), black_white);
        assert_eq!(bytes(&encoded(Grayscale, Eight, &[0, 255], plain)), black_white);
        let seen = (vec![7, 7, 7, 255, 9, 9, 9, 0], false);
        assert_eq!(bytes(&encoded(GrayscaleAlpha, Eight, &[7, 255, 9, 0], plain)), seen);
        let colors = (vec![1, 2, 3, 255, 4, 5, 6, 255], true);
        assert_eq!(bytes(&encoded(Rgb, Eight, &[1, 2, 3, 4, 5, 6], plain)), colors);
        assert_eq!(bytes(&encoded(Rgba, Eight, &colors.0, plain)), colors);
        let palette = |encoder: &mut png::Encoder<&mut Vec<u8>>| encoder.set_palette(vec![4, 5, 6, 1, 2, 3]);
        assert_eq!(bytes(&encoded(Indexed, One, &[0b1000_0000], palette)), colors);
        let with_holes = |encoder: &mut png::Encoder<&mut Vec<u8>>| {
            encoder.set_palette(vec![4, 5, 6, 1, 2, 3]);
            encoder.set_trns(vec![0, 128]);
        };
        let holes = (vec![1, 2, 3, 128, 4, 5, 6, 0], false);
        assert_eq!(bytes(&encoded(Indexed, Eight, &[1, 0], with_holes)), holes);
        let wide = read("wide", &encoded(GrayscaleAlpha, Sixteen, &[1, 2, 255, 255, 3, 4, 5, 6], plain)).unwrap();
        assert_eq!(wide.pixels, Pixels::U16(vec![0x102, 0x102, 0x102, 0xffff, 0x304, 0x304, 0x304, 0x506]));
    }

    #[test]
    fn what_is_written_is_read_back() {
        let values: Vec<u16> = (0..5 * 3 * 4).map(|index| index * 1000).collect();
        let bytes: Vec<u8> = values.iter().map(|value| (value >> 8) as u8).collect();
        for pixels in [Pixels::U16(values), Pixels::U8(bytes)] {
            let image = Image { size: [5, 3], pixels, opaque: false };
            let mut file = Vec::new();
            image.encode_png(&mut file).unwrap();
            assert_eq!(read("back", &file).unwrap(), image);
        }
    }

    #[test]
    fn an_interlaced_picture_is_read() {
        // 2x1 grey pixels, 10 and 200, in two passes of Adam7, stored without compression.
        let mut file = SIGNATURE.to_vec();
        let mut chunk = |name: &[u8; 4], data: &[u8]| {
            file.extend((data.len() as u32).to_be_bytes());
            let start = file.len();
            file.extend(name);
            file.extend(data);
            let crc = crc32(&file[start..]);
            file.extend(crc.to_be_bytes());
        };
        chunk(b"IHDR", &[0, 0, 0, 2, 0, 0, 0, 1, 8, 0, 0, 0, 1]);
        // Filter and value of each pass; the checksum is Adler-32 [Png2003 §10].
        let data = [0x78, 0x01, 1, 4, 0, 0xfb, 0xff, 0, 10, 0, 200, 0, 0, 0, 0];
        let (a, b) = data[7..11].iter().fold((1u32, 0u32), |(a, b), byte| (a + byte, a + byte + b));
        let mut stream = data.map(|byte| byte as u8);
        stream[11..].copy_from_slice(&((b << 16) | a).to_be_bytes());
        chunk(b"IDAT", &stream);
        chunk(b"IEND", &[]);
        let image = read("interlaced", &file).unwrap();
        assert_eq!(image.pixels, Pixels::U8(vec![10, 10, 10, 255, 200, 200, 200, 255]));
    }

    /// CRC-32 [Png2003 §D].
    fn crc32(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(!0u32, |crc, byte| {
            (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 })
        })
    }

    #[test]
    fn bad_files_are_one_message_with_the_way_out() {
        let says = |name: &str, bytes: &[u8], words: &str| {
            let said = read(name, bytes).unwrap_err().to_string();
            assert!(said.contains(words) && said.contains(name), "{said}");
        };
        let whole = encoded(png::ColorType::Rgb, png::BitDepth::Eight, &[1, 2, 3, 4, 5, 6], |_| {});
        says("empty", b"", "is empty");
        says("text", b"P3 1 1 255", "is another kind of file, not a PNG picture; export it as PNG");
        says("jpeg", &[0xff, 0xd8, 0xff, 0xe0], "is a JPEG, not a PNG picture");
        for length in [4, 8, 20, 30, whole.len() - 20, whole.len() - 5] {
            says("cut", &whole[..length], "ends before the picture does; copy or save it again");
        }
        let mut damaged = whole.clone();
        damaged[20] ^= 1;
        says("damaged", &damaged, "is a damaged PNG");
        for [width, height] in [[16385u32, 1], [1, u32::MAX >> 1], [1 << 30, 1 << 30]] {
            let mut huge = whole.clone();
            huge[16..20].copy_from_slice(&width.to_be_bytes());
            huge[20..24].copy_from_slice(&height.to_be_bytes());
            let crc = crc32(&huge[12..29]);
            huge[29..33].copy_from_slice(&crc.to_be_bytes());
            says("huge", &huge, "pixels; at most 16384x16384 are read");
        }
        let folder = Image::read_png(&std::env::temp_dir()).unwrap_err();
        assert!(matches!(folder, ImageError::IsDirectory { .. }), "{folder}");
    }
}
