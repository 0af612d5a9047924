//! The pictures that a style names: found beside the file that names them, and each read once.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::file::read_picture;
use super::transfer::{Nodes, TransferKind, picture};

/// Most pictures that one style may name. Ours: nobody paints more, and a bound on what a hostile file makes the program read.
const MOST_PICTURES: usize = 64;

/// What was read for a style.
#[derive(Default)]
pub(super) struct Pictures {
    /// By the path as it was put together, and by what was read from there.
    read: HashMap<(PathBuf, TransferKind), Result<Nodes, String>>,
    files: Vec<PathBuf>,
}

impl Pictures {
    /// The nodes in the picture `name` of a style that lies at `style`, or why there are none.
    pub(super) fn read(&mut self, kind: TransferKind, name: &str, style: Option<&Path>) -> Result<Nodes, String> {
        let Some(style) = style else {
            return Err("only a style that is a file can name a picture".to_owned());
        };
        let path = style.parent().map_or_else(|| PathBuf::from(name), |folder| folder.join(name));
        if let Some(read) = self.read.get(&(path.clone(), kind)) {
            return read.clone();
        }
        if self.read.len() >= MOST_PICTURES {
            return Err(format!("a style can name {MOST_PICTURES} pictures, and no more: use one of those again"));
        }
        let read = read_picture(&path, |file| picture::read(kind, file)).map_err(|unreadable| {
            let is_missing = unreadable.path.is_some_and(|path| !path.exists());
            unreadable.reason + if is_missing { "; a picture is found beside the style that names it" } else { "" }
        });
        self.note(&path);
        self.read.insert((path, kind), read.clone());
        read
    }

    /// Notes a file to watch, and the link that leads to it: that may come to lead elsewhere.
    fn note(&mut self, path: &Path) {
        let is_name = !path.as_os_str().as_encoded_bytes().contains(&0);
        let file = path.canonicalize().or_else(|_| std::path::absolute(path)).ok().filter(|_| is_name);
        let link = path.is_symlink().then(|| path.to_owned());
        for file in file.into_iter().chain(link) {
            if !self.files.contains(&file) {
                self.files.push(file);
            }
        }
    }

    /// The files that were read or looked for, in the order of the style.
    pub(super) fn into_files(self) -> Vec<PathBuf> {
        self.files
    }
}
