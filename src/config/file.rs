//! Reading a style file whole, or not at all.
//!
//! Editors and scripts write while others read. A file that changed while it was read is read again, a few times; who
//! watches it is told of the last change in any case, and comes back.

use std::fs::{File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::parse::too_large;
use super::source::Source;
use super::syntax::MAX_BYTES;

/// How often a file that keeps changing is read.
const TRIES: usize = 4;

/// Time for whoever writes to finish, before the next try.
const PAUSE: Duration = Duration::from_millis(5);

/// A byte-order mark is not counted as part of the style.
const MARK_BYTES: u64 = 3;

/// Why a style cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unreadable {
    /// Why, as a message says it.
    pub reason: String,
    /// Where it was looked for: what to watch, since it may come to be there.
    pub path: Option<PathBuf>,
}

impl From<String> for Unreadable {
    /// For what has no path.
    fn from(reason: String) -> Self {
        Self { reason, path: None }
    }
}

/// Reads a style file, or says why that is not possible.
pub fn read_file(path: &Path) -> Result<Source, Unreadable> {
    if path.as_os_str().as_encoded_bytes().contains(&0) {
        return Err(Unreadable::from("no file name can hold the character U+0000: remove it".to_owned()));
    }
    match read_settled(path) {
        Ok(text) => {
            let canonical = path.canonicalize().unwrap_or_else(|_| path.to_owned());
            let link = path.is_symlink().then(|| path.to_owned());
            Ok(Source { name: path.display().to_string(), text, path: Some(canonical), link })
        }
        Err(reason) => {
            let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
            Err(Unreadable { reason, path: Some(path) })
        }
    }
}

/// Reads until nothing changed meanwhile, or often enough.
fn read_settled(path: &Path) -> Result<Vec<u8>, String> {
    for _ in 1..TRIES {
        let (text, is_settled) = read_once(path)?;
        if is_settled {
            return Ok(text);
        }
        std::thread::sleep(PAUSE);
    }
    read_once(path).map(|(text, _)| text)
}

/// The bytes of a file, and whether it stayed the same while it was read.
fn read_once(path: &Path) -> Result<(Vec<u8>, bool), String> {
    let reason = |error| reason(path, &error);
    if path.is_dir() {
        return Err("this is a folder, not a style file".to_owned());
    }
    let mut file = File::open(path).map_err(reason)?;
    let before = file.metadata().map_err(reason)?;
    // What grows beyond the limit while it is read, or has no size, such as a pipe, is cut: it is refused later.
    let most = MAX_BYTES as u64 + MARK_BYTES + 1;
    if before.len() >= most {
        return Err(too_large());
    }
    let mut text = Vec::with_capacity(before.len() as usize);
    file.by_ref().take(most).read_to_end(&mut text).map_err(reason)?;
    let after = file.metadata().map_err(reason)?;
    let is_settled = !before.is_file() || (state(&before) == state(&after) && before.len() == text.len() as u64);
    Ok((text, is_settled))
}

fn state(metadata: &Metadata) -> (u64, Option<std::time::SystemTime>) {
    (metadata.len(), metadata.modified().ok())
}

fn reason(path: &Path, error: &io::Error) -> String {
    let is_link = path.is_symlink();
    match error.kind() {
        ErrorKind::NotFound if is_link => "this is a link to a file that is not there".to_owned(),
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "no permission to read this file".to_owned(),
        ErrorKind::IsADirectory => "this is a folder, not a style file".to_owned(),
        ErrorKind::NotADirectory => "a part of this path is a file, not a folder".to_owned(),
        ErrorKind::InvalidFilename => "this name is too long, or no name of a file".to_owned(),
        _ if is_link => format!("this link cannot be followed: {error}"),
        _ => format!("this file cannot be read: {error}"),
    }
}
