//! Files that a scene's file names: materials of an OBJ, buffers of a glTF. Read only from the scene's own folder.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use super::Import;

/// The largest side file that is read, in bytes.
const MAX_BYTES: u64 = 2 << 30;

/// Why a side file was not read: what is wrong with it, without its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct NotRead(pub(super) String);

impl Import<'_> {
    /// The bytes of the file that `reference`, a relative path, names beside the scene's file.
    ///
    /// Nothing outside of the scene's folder is read, whatever the reference says: no absolute path, no `..` that leads
    /// out, no link out, no network address. Every file that is read is noted for who follows its changes.
    pub(super) fn side_file(&mut self, reference: &str) -> Result<Vec<u8>, NotRead> {
        let refused = |why: &str| Err(NotRead(why.to_owned()));
        let Some(folder) = self.folder else {
            return refused("is not part of this file, and nothing beside it is read");
        };
        if reference.contains("://") {
            let is_local = reference.trim_start().to_ascii_lowercase().starts_with("file:");
            return refused(match is_local {
                true => "is an address of this machine's disk, which is not followed; name it by a relative path",
                false => "is a network address, which is not followed",
            });
        }
        // Files from other systems write their separators.
        let reference = reference.trim().replace('\\', "/");
        let relative = Path::new(&reference);
        let mut depth = 0_i32;
        let mut leaves = reference.is_empty();
        for component in relative.components() {
            match component {
                Component::Normal(_) => depth += 1,
                Component::CurDir => {}
                Component::ParentDir => depth -= 1,
                Component::RootDir | Component::Prefix(_) => leaves = true,
            }
            leaves |= depth < 0;
        }
        let is_drive = reference.as_bytes().get(1) == Some(&b':');
        if leaves || is_drive {
            return refused(
                "lies outside of the scene's folder, which is not followed; put it beside the scene's file",
            );
        }
        let path = folder.join(relative);
        let read = || -> std::io::Result<Option<(Vec<u8>, PathBuf)>> {
            let real = path.canonicalize()?;
            let root = if folder.as_os_str().is_empty() { Path::new(".") } else { folder }.canonicalize()?;
            if !real.starts_with(root) {
                return Ok(None);
            }
            // A pipe would be waited for without end.
            if !real.is_file() {
                return Err(std::io::Error::other("it is no regular file"));
            }
            let file = File::open(&real)?;
            let mut bytes = Vec::new();
            file.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
            if bytes.len() as u64 > MAX_BYTES {
                return Err(std::io::Error::other("it is larger than 2048 MiB"));
            }
            Ok(Some((bytes, path.clone())))
        };
        match read() {
            Ok(Some((bytes, path))) => {
                self.side_files.push(path);
                Ok(bytes)
            }
            Ok(None) => refused("is a link out of the scene's folder, which is not followed"),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => refused("is not beside the scene's file"),
            Err(error) => Err(NotRead(format!("cannot be read: {error}"))),
        }
    }
}
