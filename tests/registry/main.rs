//! The house is in order: what the program declares in two places is the same in both, and its map is true.
//!
//! No test here needs a GPU.

mod arrows;
mod citations;
mod layouts;
mod modules;
mod shaders;
mod shipped;

use std::path::{Path, PathBuf};

/// A file or folder of the project.
fn at(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The text of a file of the project.
fn text(path: &str) -> String {
    std::fs::read_to_string(at(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// All files below a folder whose names end so, as paths from the project's root, in order.
fn files_below(folder: &str, ending: &str) -> Vec<String> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(at(folder)).unwrap_or_else(|error| panic!("{folder}: {error}")) {
        let entry = entry.unwrap_or_else(|error| panic!("{folder}: {error}"));
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            files.extend(files_below(&path, ending));
        } else if path.ends_with(ending) {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Cells of the rows of the first table in a document whose header row starts so.
fn table(document: &str, header: &str) -> Vec<Vec<String>> {
    let text = text(document);
    let rows: Vec<Vec<String>> = text
        .lines()
        .skip_while(|line| !line.starts_with(header))
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect())
        .collect();
    assert!(!rows.is_empty(), "{document}: there is no table {header:?}");
    rows
}

/// The words of a cell that stand `in code`.
fn code_words(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// Fails with all complaints, one a line.
fn assert_none(complaints: &[String]) {
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}
