//! Why a scene could not be loaded, and what would help.

use std::io;
use std::path::Path;

/// A file that gives no scene. Every message names the file, says what is wrong and what would help.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// There is no such file.
    #[error("{file}: no such file; check the spelling, or give the name of a shipped molecule such as c60")]
    NotFound {
        /// The file as the caller named it.
        file: String,
    },
    /// The path is a folder.
    #[error("{file}: is a folder; give one of the files in it")]
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
    #[error("{file}: is empty; was it saved or downloaded completely?")]
    Empty {
        /// The file as the caller named it.
        file: String,
    },
    /// The format is right, but nothing in the file can be drawn.
    #[error("{file}: holds no atoms; {hint}")]
    NoAtoms {
        /// The file as the caller named it.
        file: String,
        /// What was looked for, and what to do.
        hint: String,
    },
    /// The format is right, but there is no triangle in the file.
    #[error("{file}: holds no triangles; export the model's surfaces, or as a mesh")]
    NoTriangles {
        /// The file as the caller named it.
        file: String,
    },
    /// A line contradicts the format so that nothing can be drawn safely.
    #[error("{file}:{line}: {what}")]
    Malformed {
        /// The file as the caller named it.
        file: String,
        /// Line, from 1.
        line: u32,
        /// What is wrong, and the way out after a semicolon.
        what: String,
    },
    /// The file is of a kind that this reader does not read.
    #[error("{file}: {what}")]
    Unsupported {
        /// The file as the caller named it.
        file: String,
        /// What it is, and the way out after a semicolon.
        what: String,
    },
    /// The file asks for a model that it does not have.
    #[error("{file}: has no model {model}; it has {available}")]
    NoSuchModel {
        /// The file as the caller named it.
        file: String,
        /// The number that was asked for.
        model: u32,
        /// The numbers that exist, in words.
        available: String,
    },
    /// The file asks for a biological assembly that it does not have.
    #[error("{file}: has no assembly {assembly}; it has {available}")]
    NoSuchAssembly {
        /// The file as the caller named it.
        file: String,
        /// The id that was asked for.
        assembly: String,
        /// The ids that exist, in words.
        available: String,
    },
    /// The file is larger than this program reads.
    #[error("{file}: is larger than {limit_mib} MiB; split it, or keep one model of it")]
    TooLarge {
        /// The file as the caller named it.
        file: String,
        /// The limit, in MiB.
        limit_mib: u64,
    },
}

impl SceneError {
    /// Chooses the variant for an error of the operating system.
    pub(super) fn from_io(path: &Path, source: io::Error) -> Self {
        let file = path.display().to_string();
        match source.kind() {
            io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => Self::NotFound { file },
            io::ErrorKind::IsADirectory => Self::IsDirectory { file },
            io::ErrorKind::PermissionDenied => Self::NoPermission { file },
            _ => Self::Unreadable { file, source },
        }
    }
}
