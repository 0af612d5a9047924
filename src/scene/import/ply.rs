//! PLY: a header that says which elements follow, then their rows as text or bytes.
//!
//! Drawn are `vertex` (places, normals, colours), `face` (polygons, colours) and `tristrips`; everything else is passed
//! over. Counts are held against the bytes that are there before room is made for them.

mod body;
mod header;

use glam::{DVec3, Vec3};

use self::body::{Body, Cut};
use self::header::{Element, Encoding, Header, Scalar};
use super::faces::{Faces, WHITE};
use super::lines::quote;
use super::{Import, SceneError};
use crate::scene::mesh::RawMesh;
use crate::scene::report::NoteKind;

/// Whether a file begins as PLY files do.
pub(super) fn begins(bytes: &[u8]) -> bool {
    bytes.strip_prefix(b"ply").is_some_and(|rest| rest.first().is_none_or(u8::is_ascii_whitespace))
}

/// Reads the mesh, which is one part.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let Header { encoding, format_line, elements, body } = header::read(import, bytes)?;
    let mut body = Body { bytes, at: body, encoding, comma: None };
    let mut reader = Reader::default();
    let mut cut = None;
    for element in &elements {
        (reader.row, reader.row_at) = (None, body.at);
        let result = match element.name.as_slice() {
            b"vertex" if !reader.has_vertices => {
                let vertices = reader.vertices(import, &mut body, element)?;
                if vertices.is_ok()
                    && let Some(comma) = body.comma
                {
                    let what = "a number has a decimal comma; export the model with decimal points".to_string();
                    return Err(import.malformed(body.line(comma), what));
                }
                vertices
            }
            b"face" | b"tristrips" => reader.faces(import, &mut body, element)?,
            _ => body.skip(element),
        };
        if result.is_err() {
            let name = quote(&element.name);
            let row = reader.row.map_or(String::new(), |row| format!("number {} of ", row + 1));
            cut = Some((reader.row_at, format!("{row}{} {name} elements", element.count)));
            break;
        }
    }
    let Reader { faces, normals, colors, .. } = reader;
    let mesh = faces.finish(normals, colors);
    match cut {
        Some((at, row)) if mesh.parts.is_empty() => {
            let what = format!("the file ends in {row}, or is damaged there; was it saved or downloaded completely?");
            Err(body.error(import, at, what))
        }
        Some((_, row)) => {
            import.report.note(NoteKind::MeshCut, None, || row);
            Ok(mesh)
        }
        None if mesh.parts.is_empty() => {
            let is_garbled = encoding != Encoding::Ascii && import.report.count(NoteKind::FaceOutOfRange) > 0;
            if !is_garbled {
                return Err(import.no_triangles());
            }
            let what = "no face names vertices that are there; does the header say the right byte order?".to_string();
            Err(import.malformed(format_line, what))
        }
        None => Ok(mesh),
    }
}

impl Body<'_> {
    /// An error with its line in text, and its byte in binary files.
    fn error(&self, import: &Import<'_>, at: usize, what: String) -> SceneError {
        match self.encoding {
            Encoding::Ascii => {
                let rest = self.bytes.get(at..).unwrap_or_default();
                let spaces = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
                import.malformed(self.line(at + spaces), what)
            }
            _ => SceneError::MalformedAt { file: import.file.to_string(), byte: at as u64, what },
        }
    }
}

/// What numbers of a vertex mean, by their places in a row; the last place takes all others.
const ROLES: [&[&[u8]]; 9] = [
    &[b"x"],
    &[b"y"],
    &[b"z"],
    &[b"nx", b"normal_x"],
    &[b"ny", b"normal_y"],
    &[b"nz", b"normal_z"],
    &[b"red", b"r", b"diffuse_red"],
    &[b"green", b"g", b"diffuse_green"],
    &[b"blue", b"b", b"diffuse_blue"],
];

/// The place of a property in a row.
fn role(name: &[u8]) -> usize {
    ROLES.iter().position(|names| names.contains(&name)).unwrap_or(ROLES.len())
}

/// The properties of an element that have one of three roles.
fn has_roles(element: &Element, roles: std::ops::Range<usize>) -> bool {
    let has =
        |wanted| element.properties.iter().any(|property| property.counter.is_none() && role(&property.name) == wanted);
    roles.into_iter().all(has)
}

/// One of red, green and blue as a byte: integers are bytes or words, floats go to 1.
fn color_byte(value: f64, scalar: Scalar) -> u8 {
    let value = match scalar {
        Scalar::F32 | Scalar::F64 => value * 255.0,
        Scalar::U16 => value / 257.0,
        _ => value,
    };
    // What is no number is white.
    if value.is_nan() { WHITE[0] } else { value.round() as u8 }
}

/// What was read so far.
#[derive(Default)]
struct Reader {
    has_vertices: bool,
    faces: Faces,
    normals: Vec<Vec3>,
    colors: Vec<[u8; 3]>,
    /// The row that is being read, from 0, and where it begins; none of elements that are passed over.
    row: Option<u64>,
    row_at: usize,
}

impl Reader {
    /// Reads all vertices.
    fn vertices(
        &mut self,
        import: &mut Import<'_>,
        body: &mut Body<'_>,
        element: &Element,
    ) -> Result<Result<(), Cut>, SceneError> {
        self.has_vertices = true;
        if !has_roles(element, 0..3) {
            let what = "vertices have no x, y and z; export the model again".to_string();
            return Err(import.malformed(element.line, what));
        }
        let least = element.least_bytes(body.encoding);
        let most = (body.left() + 1) / least;
        if element.count > most as u64 || element.count > u64::from(u32::MAX) {
            let what = format!(
                "{} vertices are announced, and there is room for {most} at most; was the file saved or downloaded completely?",
                element.count
            );
            return Err(import.malformed(element.line, what));
        }
        let count = element.count as usize;
        self.faces.reserve(count, 0);
        let has_normals = has_roles(element, 3..6);
        let has_colors = has_roles(element, 6..9);
        self.normals.reserve_exact(if has_normals { count } else { 0 });
        self.colors.reserve_exact(if has_colors { count } else { 0 });
        let roles: Vec<usize> = element.properties.iter().map(|property| role(&property.name)).collect();
        let kind_of = |wanted: usize| roles.iter().zip(&element.properties).find(|(role, _)| **role == wanted);
        let kinds = [6, 7, 8].map(|wanted| kind_of(wanted).map_or(Scalar::U8, |(_, property)| property.scalar));
        let mut list = Vec::new();
        for row in 0..element.count {
            (self.row, self.row_at) = (Some(row), body.at);
            let mut values = [0.0; ROLES.len() + 1];
            for (property, &role) in element.properties.iter().zip(&roles) {
                if property.counter.is_none() {
                    match body.scalar(property.scalar) {
                        Ok(value) => values[role] = value,
                        Err(cut) => return Ok(Err(cut)),
                    }
                } else if let Err(cut) = body.list(property, &mut list) {
                    return Ok(Err(cut));
                }
            }
            let [x, y, z, nx, ny, nz, red, green, blue, _] = values;
            self.faces.push(DVec3::new(x, y, z));
            if has_normals {
                self.normals.push(DVec3::new(nx, ny, nz).as_vec3());
            }
            if has_colors {
                self.colors.push(std::array::from_fn(|i| color_byte([red, green, blue][i], kinds[i])));
            }
        }
        Ok(Ok(()))
    }

    /// Reads all faces, or strips of triangles in which -1 begins a new one.
    fn faces(
        &mut self,
        import: &mut Import<'_>,
        body: &mut Body<'_>,
        element: &Element,
    ) -> Result<Result<(), Cut>, SceneError> {
        if !self.has_vertices {
            let what = "faces come before the vertices; export the model again".to_string();
            return Err(import.malformed(element.line, what));
        }
        let is_index = |name: &[u8]| matches!(name, b"vertex_indices" | b"vertex_index");
        let Some(indices) = element.properties.iter().position(|property| is_index(&property.name)) else {
            if element.count == 0 {
                return Ok(Ok(()));
            }
            let what = "faces have no list vertex_indices; export the model again".to_string();
            return Err(import.malformed(element.line, what));
        };
        let is_strips = element.name == b"tristrips";
        let has_colors = self.colors.is_empty() && !is_strips && has_roles(element, 6..9);
        let most = body.left() / element.least_bytes(body.encoding).max(1);
        // A list of three is longer than an empty one: room for half of what could be there is no waste.
        self.faces.reserve(0, (element.count as usize).min(most / 2));
        let (mut list, mut other) = (Vec::new(), Vec::new());
        for row in 0..element.count {
            (self.row, self.row_at) = (Some(row), body.at);
            let mut color = WHITE;
            for (i, property) in element.properties.iter().enumerate() {
                let into = if i == indices { &mut list } else { &mut other };
                if let Err(cut) = body.list(property, into) {
                    return Ok(Err(cut));
                }
                if has_colors && let Some(channel) = role(&property.name).checked_sub(6).filter(|&channel| channel < 3)
                {
                    color[channel] = color_byte(other.first().copied().unwrap_or(f64::NAN), property.scalar);
                }
            }
            if is_strips {
                self.strips(import, &list);
            } else {
                self.faces.add(&mut import.report, None, &list, has_colors.then_some(color));
            }
        }
        Ok(Ok(()))
    }

    fn strips(&mut self, import: &mut Import<'_>, list: &[f64]) {
        for strip in list.split(|&index| index < 0.0) {
            for (i, window) in strip.windows(3).enumerate() {
                let &[a, b, c] = window else { continue };
                // Strips turn the other way at each triangle; those of two equal corners only lead on.
                if a != b && b != c && a != c {
                    let triangle = if i % 2 == 0 { [a, b, c] } else { [b, a, c] };
                    self.faces.add(&mut import.report, None, &triangle, None);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
