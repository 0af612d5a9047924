//! Pictures on the CPU: eight or sixteen bits a channel, and their PNG files.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

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
        let keep = if self.opaque { 3 } else { 4 };
        let (bytes, wide): (Vec<u8>, bool) = match &self.pixels {
            Pixels::U8(values) => (values.chunks_exact(4).flat_map(|pixel| &pixel[..keep]).copied().collect(), false),
            Pixels::U16(values) => {
                let kept = values.chunks_exact(4).flat_map(|pixel| &pixel[..keep]);
                (kept.flat_map(|value| value.to_be_bytes()).collect(), true)
            }
        };
        let mut writer = encoder(writer, self.size, self.opaque, wide).write_header().map_err(of_png)?;
        writer.write_image_data(&bytes).map_err(of_png)?;
        writer.finish().map_err(of_png)
    }
}

/// What a picture is that is written row by row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowsHeader {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Every alpha is full: the file needs no alpha channel.
    pub opaque: bool,
    /// 16 bits a channel instead of 8.
    pub wide: bool,
}

/// Writes a PNG file from rows that `rows` hands over from the top, as many at a time as it likes: RGBA, 8 bits a channel,
/// or 16 in native order. The file appears whole or not at all.
///
/// # Errors
/// Whatever the file system or `rows` says.
pub fn write_png_rows(
    path: &Path,
    header: &RowsHeader,
    rows: impl FnOnce(&mut dyn FnMut(&[u8]) -> io::Result<()>) -> io::Result<()>,
) -> io::Result<()> {
    write_whole(path, |file| {
        let mut writer = encoder(file, header.size, header.opaque, header.wide).write_header().map_err(of_png)?;
        let mut stream = writer.stream_writer().map_err(of_png)?;
        let pixel_bytes = if header.wide { 8 } else { 4 };
        let keep = if header.opaque { 3 } else { 4 };
        let row_bytes = header.size[0].max(1) as usize * pixel_bytes;
        let mut kept = Vec::new();
        rows(&mut |bytes| {
            // A row at a time: no second copy of all of them.
            for row in bytes.chunks(row_bytes) {
                kept.clear();
                if header.wide {
                    let values = row.chunks_exact(2).map(|pair| u16::from_ne_bytes([pair[0], pair[1]]).to_be_bytes());
                    kept.extend(values.enumerate().filter(|(index, _)| index % 4 < keep).flat_map(|(_, value)| value));
                } else {
                    kept.extend(row.chunks_exact(4).flat_map(|pixel| &pixel[..keep]));
                }
                stream.write_all(&kept)?;
            }
            Ok(())
        })?;
        stream.finish().map_err(of_png)
    })
}

/// The encoder of all pictures: quick, and tagged as sRGB.
fn encoder<W: Write>(writer: W, [width, height]: [u32; 2], opaque: bool, wide: bool) -> png::Encoder<'static, W> {
    let mut encoder = png::Encoder::new(writer, width, height);
    encoder.set_color(if opaque { png::ColorType::Rgb } else { png::ColorType::Rgba });
    encoder.set_depth(if wide { png::BitDepth::Sixteen } else { png::BitDepth::Eight });
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder
}

/// Writes a file beside its place first, then moves it there: nothing half-written stays, and a former file's
/// permissions do. A link is followed; what is no regular file, such as `/dev/null` or a pipe, is written to as it is.
///
/// # Errors
/// Whatever the file system says; the former file is then as it was.
pub fn write_whole(path: &Path, content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    // Two writers of one process do not meet in one part.
    static PARTS: AtomicU32 = AtomicU32::new(0);
    let write = |file: File| {
        let mut writer = BufWriter::new(file);
        content(&mut writer)?;
        writer.flush()
    };
    let former = match std::fs::metadata(path) {
        Ok(former) => Some(former),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    match &former {
        Some(former) if former.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Some(former) if !former.is_file() => return write(File::options().write(true).open(path)?),
        Some(former) if former.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
        _ => {}
    }
    let path = &if former.is_some() { path.canonicalize()? } else { end_of_links(path) };
    // A short name of its own: one made of the file's may be longer than the file system takes.
    let part = format!(".restyle-{}-{}.part", std::process::id(), PARTS.fetch_add(1, Ordering::Relaxed));
    let beside = path.with_file_name(part);
    let result = File::create(&beside).and_then(write).and_then(|()| {
        if let Some(former) = &former {
            std::fs::set_permissions(&beside, former.permissions())?;
        }
        std::fs::rename(&beside, path)
    });
    if result.is_err() {
        // Nothing more can be done about a part that cannot be removed either.
        let _ = std::fs::remove_file(&beside);
    }
    result
}

/// What the writer said, such as that the disk is full, without the words of the encoder around it.
fn of_png(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

/// Where a file will be that is not there yet, but that links may lead to.
fn end_of_links(path: &Path) -> PathBuf {
    /// As many as the Linux kernel follows.
    const MOST_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&path) {
            Ok(next) => path = path.with_file_name(next),
            Err(_) => break,
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("restyle-image-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    #[test]
    fn a_failure_leaves_the_former_file_and_no_part() {
        let folder = folder("failure");
        let file = folder.join("a.png");
        std::fs::write(&file, "former").unwrap();
        let failed = write_whole(&file, |writer| {
            writer.write_all(b"half")?;
            Err(io::ErrorKind::StorageFull.into())
        });
        assert_eq!(failed.map_err(|error| error.kind()), Err(io::ErrorKind::StorageFull));
        assert_eq!(std::fs::read(&file).unwrap(), b"former");
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_kept() {
        use std::os::unix::fs::symlink;
        let folder = folder("links");
        std::fs::create_dir(folder.join("deep")).unwrap();
        symlink("deep/b.png", folder.join("a.png")).unwrap();
        symlink("c.png", folder.join("deep/b.png")).unwrap();
        write_whole(&folder.join("a.png"), |writer| writer.write_all(b"new")).unwrap();
        assert_eq!(std::fs::read(folder.join("deep/c.png")).unwrap(), b"new");
        assert!(folder.join("a.png").is_symlink() && folder.join("deep/b.png").is_symlink());
        symlink("y", folder.join("x")).unwrap();
        symlink("x", folder.join("y")).unwrap();
        assert!(write_whole(&folder.join("x"), |_| Ok(())).is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
