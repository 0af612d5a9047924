//! Reading a style file, or a picture that it names, whole or not at all.
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

/// Why a style or a picture cannot be read.
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

/// What files are called in messages.
pub(super) const STYLE: &str = "a style file";
const PICTURE: &str = "a picture";

/// Reads a style file, or says why that is not possible.
pub fn read_file(path: &Path) -> Result<Source, Unreadable> {
    check_name(path)?;
    match read_settled(|| read_once(path)) {
        Ok(text) => {
            let canonical = path.canonicalize().unwrap_or_else(|_| path.to_owned());
            let link = path.is_symlink().then(|| path.to_owned());
            Ok(Source { name: path.display().to_string(), text, path: Some(canonical), link })
        }
        Err(reason) => Err(unreadable(path, reason)),
    }
}

/// Reads a picture by `decode`, or says why that is not possible.
pub(super) fn read_picture<T>(path: &Path, decode: impl Fn(&mut File) -> Result<T, String>) -> Result<T, Unreadable> {
    check_name(path)?;
    // Half of a picture is no mistake while the other half is written.
    let decoded = read_settled(|| {
        let reason = |error| reason(path, PICTURE, &error);
        if path.is_dir() {
            return Err(folder(PICTURE));
        }
        if !path.metadata().map_err(reason)?.is_file() {
            return Err(pipe(PICTURE));
        }
        let mut file = File::open(path).map_err(reason)?;
        let before = file.metadata().map_err(reason)?;
        let decoded = decode(&mut file);
        let after = file.metadata().map_err(reason)?;
        Ok((decoded, state(&before) == state(&after)))
    });
    decoded.and_then(|decoded| decoded).map_err(|reason| unreadable(path, reason))
}

/// Refuses a name that no file can have.
fn check_name(path: &Path) -> Result<(), Unreadable> {
    if path.as_os_str().as_encoded_bytes().contains(&0) {
        return Err(Unreadable::from("no file name can hold the character U+0000: remove it".to_owned()));
    }
    Ok(())
}

fn unreadable(path: &Path, reason: String) -> Unreadable {
    Unreadable { reason, path: Some(std::path::absolute(path).unwrap_or_else(|_| path.to_owned())) }
}

/// Reads until nothing changed meanwhile, or often enough; `read_once` also tells whether it did not.
fn read_settled<T>(read_once: impl Fn() -> Result<(T, bool), String>) -> Result<T, String> {
    for _ in 1..TRIES {
        let (read, is_settled) = read_once()?;
        if is_settled {
            return Ok(read);
        }
        std::thread::sleep(PAUSE);
    }
    read_once().map(|(read, _)| read)
}

/// The bytes of a file, and whether it stayed the same while it was read.
fn read_once(path: &Path) -> Result<(Vec<u8>, bool), String> {
    let reason = |error| reason(path, STYLE, &error);
    if path.is_dir() {
        return Err(folder(STYLE));
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

/// What is said of a folder that stands for `what`.
fn folder(what: &str) -> String {
    format!("this is a folder, not {what}")
}

/// What is said of that which has no end that anybody knows.
pub(super) fn pipe(what: &str) -> String {
    format!("this is a pipe or a device, not {what}")
}

fn reason(path: &Path, what: &str, error: &io::Error) -> String {
    let is_link = path.is_symlink();
    match error.kind() {
        ErrorKind::NotFound if is_link => "this is a link to a file that is not there".to_owned(),
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "no permission to read this file".to_owned(),
        ErrorKind::IsADirectory => folder(what),
        ErrorKind::NotADirectory => "a part of this path is a file, not a folder".to_owned(),
        ErrorKind::InvalidFilename => "this name is too long, or no name of a file".to_owned(),
        _ if is_link => format!("this link cannot be followed: {error}"),
        _ => format!("this file cannot be read: {error}"),
    }
}
