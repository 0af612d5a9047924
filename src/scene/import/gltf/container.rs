//! The envelope of a glTF file: bare JSON, or a GLB with a JSON and a binary chunk [Gltf2 §4.4].

use serde_json::Value;

use super::super::Import;
use super::super::lines::quote;
use crate::scene::error::SceneError;
use crate::scene::report::NoteKind;

/// Type of the chunk that holds the JSON.
const JSON_CHUNK: &[u8] = b"JSON";
/// Type of the chunk that holds the first buffer.
const BINARY_CHUNK: &[u8] = b"BIN\0";
/// Bytes before the first chunk.
const HEADER_BYTES: usize = 12;

/// A file taken apart.
pub(super) struct Container<'a> {
    /// All of its JSON.
    pub(super) json: Value,
    /// The binary chunk of a GLB.
    pub(super) binary: Option<&'a [u8]>,
}

/// Takes a file apart.
///
/// # Errors
/// `MalformedAt` or `Malformed` where envelope or JSON are broken, `Unsupported` for other versions.
pub(super) fn open<'a>(import: &mut Import<'_>, bytes: &'a [u8]) -> Result<Container<'a>, SceneError> {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if text.trim_ascii_start().starts_with(b"{") {
        let json = serde_json::from_slice(text).map_err(|error| {
            let what = format!("column {}: {}", error.column(), what_is_wrong(&error));
            import.malformed(u32::try_from(error.line()).unwrap_or(u32::MAX).max(1), what)
        })?;
        return Ok(Container { json, binary: None });
    }
    if !bytes.starts_with(b"glTF") {
        let what = format!(
            "the file begins with {} instead of \"glTF\" or \"{{\"; was it downloaded completely?",
            quote(bytes.get(..4).unwrap_or(bytes))
        );
        return Err(import.malformed_at(0, what));
    }
    let Some((version, length)) = u32_at(bytes, 4).zip(u32_at(bytes, 8)) else {
        return Err(import.malformed_at(bytes.len(), "the header is cut short; get the file again".to_owned()));
    };
    match version {
        2 => {}
        1 => return Err(super::version_1(import)),
        other => {
            let what = format!("the container has version {other}, and only 2 is known; export it as glTF 2.0");
            return Err(import.malformed_at(4, what));
        }
    }
    if length as usize != bytes.len() {
        import.report.note(NoteKind::LengthMended, None, || format!("{length} in the header, {} found", bytes.len()));
    }
    let (kind, json_bytes, mut at) = chunk(import, bytes, HEADER_BYTES)?;
    if kind != JSON_CHUNK {
        let what = format!("the first chunk is {} and must be \"JSON\"; export the file again", quote(kind));
        return Err(import.malformed_at(HEADER_BYTES + 4, what));
    }
    let json = serde_json::from_slice(json_bytes).map_err(|error| {
        let byte = HEADER_BYTES + 8 + offset_of(json_bytes, error.line(), error.column());
        import.malformed_at(byte, format!("in the JSON: {}", what_is_wrong(&error)))
    })?;
    // Chunks of other types may follow in any number; a few bytes after the last one are padding.
    let mut binary = None;
    while binary.is_none() && at + 8 <= bytes.len() {
        let (kind, content, next) = chunk(import, bytes, at)?;
        if kind == BINARY_CHUNK {
            binary = Some(content);
        }
        at = next;
    }
    Ok(Container { json, binary })
}

/// Type and content of the chunk at a byte, and where the next one begins.
fn chunk<'a>(import: &Import<'_>, bytes: &'a [u8], at: usize) -> Result<(&'a [u8], &'a [u8], usize), SceneError> {
    let header = u32_at(bytes, at).zip(bytes.get(at + 4..at + 8));
    let Some((length, kind)) = header else {
        return Err(import.malformed_at(at, "a chunk is cut short; get the file again".to_owned()));
    };
    let start = at + 8;
    let end = start.checked_add(length as usize).filter(|&end| end <= bytes.len());
    let Some(end) = end else {
        let what = format!(
            "the chunk {} announces {length} bytes, but {} follow; the file was cut short: get it again",
            quote(kind.strip_suffix(b"\0").unwrap_or(kind)),
            bytes.len() - start
        );
        return Err(import.malformed_at(at, what));
    };
    Ok((kind, &bytes[start..end], end.next_multiple_of(4)))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}

/// The bytes before a line and column, both from 1.
fn offset_of(text: &[u8], line: usize, column: usize) -> usize {
    let lines_before = line.saturating_sub(1);
    let start = match lines_before {
        0 => 0,
        _ => memchr::memchr_iter(b'\n', text).nth(lines_before - 1).map_or(0, |at| at + 1),
    };
    (start + column.saturating_sub(1)).min(text.len())
}

/// What the JSON reader says, without its place, and the way out.
fn what_is_wrong(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let message = message.split(" at line ").next().unwrap_or_default();
    let way_out = if error.is_eof() { "it was cut short: get it again" } else { "export the file again" };
    format!("{message}; {way_out}")
}
