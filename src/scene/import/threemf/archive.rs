//! The zip archive of a 3MF file, read entry by entry and never unpacked as a whole.

use std::io::{BufReader, Cursor, Error, Read, Result as IoResult};

use zip::ZipArchive;
use zip::read::ZipFile;
use zip::result::ZipError;

use super::super::lines::quote;

/// Most bytes that all entries together may unpack to.
const MAX_BYTES: u64 = 1 << 30;
/// Text of meshes packs to a tenth, seldom to a thirtieth of its length; small files may be odder.
const MAX_RATIO: u64 = 100;
const SPARE_BYTES: u64 = 16 << 20;

/// An archive, and how much of it may still be unpacked.
pub(super) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    num_left: u64,
    /// Bytes that were unpacked.
    pub(super) num_unpacked: u64,
}

/// An entry as it is unpacked.
pub(super) type Entry<'r, 'a> = BufReader<Limited<'r, ZipFile<'r, Cursor<&'a [u8]>>>>;

impl<'a> Archive<'a> {
    /// Opens an archive.
    ///
    /// # Errors
    /// In words, if it is none or was cut short.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, String> {
        if !bytes.starts_with(b"PK") {
            let start = quote(bytes.get(..4).unwrap_or(bytes));
            return Err(format!("begins with {start} and is no zip archive, as 3MF is; was it downloaded completely?"));
        }
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|error| match error {
            ZipError::UnsupportedArchive(why) => format!("is a zip archive that is not read ({why}); {PACK_AGAIN}"),
            _ => "its zip archive has no table of contents; the file was cut short: get it again".to_owned(),
        })?;
        let num_left = MAX_BYTES.min(SPARE_BYTES + MAX_RATIO * bytes.len() as u64);
        Ok(Self { zip, num_left, num_unpacked: 0 })
    }

    /// The entry of a path within the archive, with or without a slash before it; none if there is no such entry.
    ///
    /// # Errors
    /// In words, if it is encrypted or packed in an unknown way.
    pub(super) fn entry(&mut self, path: &str) -> Result<Option<Entry<'_, 'a>>, String> {
        let path = path.trim_start_matches('/');
        let index = self.zip.index_for_name(path).or_else(|| {
            // Paths differ in their case only where a file system let them [Opc].
            self.zip.file_names_raw().position(|name| name.eq_ignore_ascii_case(path.as_bytes()))
        });
        let Some(index) = index else { return Ok(None) };
        let file = self.zip.by_index(index).map_err(|error| {
            let place = quote(path.as_bytes());
            match error {
                ZipError::UnsupportedArchive(ZipError::PASSWORD_REQUIRED) | ZipError::InvalidPassword => {
                    format!("its entry {place} is encrypted; save the file without a password")
                }
                ZipError::CompressionMethodNotSupported(method) => {
                    format!("its entry {place} is packed by method {method}, which is not read; {PACK_AGAIN}")
                }
                _ => format!("its entry {place} is damaged; get the file again"),
            }
        })?;
        let limited = Limited { file, num_left: &mut self.num_left, num_unpacked: &mut self.num_unpacked };
        Ok(Some(BufReader::with_capacity(1 << 16, limited)))
    }

    /// The first entry whose name ends like this, in any case.
    pub(super) fn first_ending(&self, end: &str) -> Option<String> {
        let ends = |name: &&[u8]| {
            name.len().checked_sub(end.len()).is_some_and(|at| name[at..].eq_ignore_ascii_case(end.as_bytes()))
        };
        self.zip.file_names_raw().find(ends).map(|name| String::from_utf8_lossy(name).into_owned())
    }
}

const PACK_AGAIN: &str = "export it again, or pack it with deflate";

/// A reader that stops where an archive unpacks to absurd lengths.
pub(super) struct Limited<'r, R> {
    file: R,
    num_left: &'r mut u64,
    num_unpacked: &'r mut u64,
}

impl<R: Read> Read for Limited<'_, R> {
    fn read(&mut self, to: &mut [u8]) -> IoResult<usize> {
        let count = self.file.read(to)?;
        *self.num_unpacked += count as u64;
        match self.num_left.checked_sub(count as u64) {
            Some(left) => *self.num_left = left,
            None => return Err(Error::other(format!("it unpacks to more than {MAX_RATIO} times its length"))),
        }
        Ok(count)
    }
}
