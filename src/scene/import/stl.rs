//! STL: facets of three vertices, as text or 50 bytes each.
//!
//! The length tells binary files from text, since headers of binary ones begin with `solid`, too, and counts are often
//! wrong. Normals of the file are not read: they are zero or wrong as often as right. Vertices of equal coordinates
//! are one vertex, so that a facet costs 12 bytes and not 72. Attribute bytes, in which some programs hide colours, are not read.

mod ascii;

use glam::{DAffine3, DVec3};

use super::vertex::{UniquePositions, is_place};
use super::{Import, SceneError};
use crate::scene::mesh::{RawMesh, RawPart, RawShape};
use crate::scene::report::NoteKind;

/// Bytes of a binary file before its facets: 80 of header and the count.
const HEADER: usize = 84;

/// Bytes of a binary facet: normal, three vertices, two of attributes.
const FACET: usize = 50;

/// Reads either kind.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let mesh =
        if is_exact_binary(bytes) || !is_text(bytes) { binary(import, bytes)? } else { ascii::read(import, bytes)? };
    if mesh.parts.is_empty() { Err(import.no_triangles()) } else { Ok(mesh) }
}

/// Whether a file can only be binary: its length is that of its header and as many facets as the header says.
pub(super) fn is_exact_binary(bytes: &[u8]) -> bool {
    let count = count(bytes).filter(|&count| count > 0);
    count.is_some_and(|count| bytes.len() as u64 == HEADER as u64 + u64::from(count) * FACET as u64)
}

/// Whether a file begins as text in STL does.
pub(super) fn begins_as_text(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    let rest = bytes.get(..5).filter(|word| word.eq_ignore_ascii_case(b"solid")).map(|word| &bytes[word.len()..]);
    rest.is_some_and(|rest| rest.first().is_none_or(u8::is_ascii_whitespace)) && is_text(bytes)
}

/// Whether there is no control character where a binary file has many.
fn is_text(bytes: &[u8]) -> bool {
    let is_control = |byte: &u8| matches!(byte, 0..=8 | 14..=31 | 127);
    !bytes.iter().take(1024).any(is_control)
}

fn count(bytes: &[u8]) -> Option<u32> {
    bytes.get(HEADER - 4..HEADER)?.try_into().ok().map(u32::from_le_bytes)
}

fn binary(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let (Some(count), Some(body)) = (count(bytes), bytes.get(HEADER..)) else {
        let what = format!("ends inside the header of {HEADER} bytes; was it saved or downloaded completely?");
        return Err(SceneError::MalformedAt { file: import.file.to_string(), byte: bytes.len() as u64, what });
    };
    let (facets, rest) = body.as_chunks::<FACET>();
    let there = facets.len();
    let wanted = if count == 0 { there } else { there.min(count as usize) };
    if count == 0 && there > 0 || count as usize > there {
        import.report.note(NoteKind::CountWrong, None, || format!("{count} facets announced, {there} there"));
    }
    if wanted == there && !rest.is_empty() {
        import.report.note(NoteKind::MeshCut, None, || format!("inside facet {}", there + 1));
    } else if wanted < there {
        let num_bytes = (there - wanted) * FACET + rest.len();
        import.report.note_many(NoteKind::TrailingBytes, num_bytes as u32, String::new);
    }
    let mut solid = Solid::default();
    for (number, facet) in facets[..wanted].iter().enumerate() {
        let (words, _) = facet.as_chunks::<4>();
        let mut corners = [DVec3::ZERO; 3];
        // Three numbers of the normal come first.
        for (value, word) in corners.iter_mut().flat_map(|corner| corner.as_mut()).zip(&words[3..]) {
            *value = f64::from(f32::from_le_bytes(*word));
        }
        if corners.iter().all(|&corner| is_place(corner)) {
            solid.push(corners);
        } else {
            import.report.note(NoteKind::FaceNowhere, None, || format!("facet {}", number + 1));
        }
    }
    let mut mesh = RawMesh::default();
    solid.finish(&mut mesh);
    Ok(mesh)
}

/// A body while it is read.
#[derive(Default)]
struct Solid {
    name: String,
    unique: UniquePositions,
    triangles: Vec<[u32; 3]>,
}

impl Solid {
    fn push(&mut self, corners: [DVec3; 3]) {
        let triangle = corners.map(|corner| self.unique.number(corner));
        self.triangles.push(triangle);
    }

    /// Adds the solid as a part, if it has any triangle, and begins anew.
    fn finish(&mut self, mesh: &mut RawMesh) {
        let Solid { name, mut unique, triangles } = std::mem::take(self);
        if triangles.is_empty() {
            return;
        }
        let shape = mesh.shapes.len() as u32;
        mesh.shapes.push(RawShape { positions: unique.take(), triangles, ..RawShape::default() });
        let (path, file_from_shape) = (name.clone(), DAffine3::IDENTITY);
        mesh.parts.push(RawPart { shape, material: None, name, path, file_from_shape });
    }
}

#[cfg(test)]
mod tests;
