//! OFF: counts, then a line for each vertex and a line for each face.
//!
//! Letters before the keyword say what a vertex has besides its place: `C` a colour, `N` a normal, `ST` a place in a
//! picture, `4` a fourth coordinate to divide by. Lines may hold more than that, and the keyword may be missing.

use glam::{DVec3, Vec3};

use super::faces::Faces;
use super::lines::{Lines, quote};
use super::number::float;
use super::{Import, SceneError};
use crate::scene::mesh::RawMesh;
use crate::scene::report::NoteKind;

/// What the keyword says of vertices.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Keyword {
    has_texture: bool,
    has_colors: bool,
    has_normals: bool,
    has_weight: bool,
}

impl Keyword {
    /// The meaning of `OFF` and its kin.
    fn parse(word: &[u8]) -> Option<Self> {
        let mut keyword = Self::default();
        let mut rest = word.strip_suffix(b"OFF")?;
        let mut take = |letters: &[u8], is: &mut bool| {
            *is = rest.starts_with(letters);
            rest = if *is { &rest[letters.len()..] } else { rest };
        };
        take(b"ST", &mut keyword.has_texture);
        take(b"C", &mut keyword.has_colors);
        take(b"N", &mut keyword.has_normals);
        take(b"4", &mut keyword.has_weight);
        rest.is_empty().then_some(keyword)
    }
}

/// Whether a file begins as OFF files do.
pub(super) fn begins(head: &[u8]) -> bool {
    let first = Lines::new(head).find_map(|(_, line)| words(line).next());
    first.is_some_and(|word| Keyword::parse(word).is_some())
}

/// Words of a line, up to a comment.
fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let line = memchr::memchr(b'#', line).map_or(line, |end| &line[..end]);
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// Reads the mesh, which is one part.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let mut lines = Lines::new(bytes).filter(|(_, line)| words(line).next().is_some());
    let last = std::cell::Cell::new(1);
    let mut next = || lines.next().inspect(|(number, _)| last.set(*number));
    let Some((mut number, mut line)) = next() else { return Err(import.no_triangles()) };
    let mut first = words(line).peekable();
    let keyword = first.peek().and_then(|word| Keyword::parse(word));
    if keyword.is_some() {
        first.next();
    }
    if first.peek() == Some(&&b"BINARY"[..]) {
        let what = "is a binary OFF file, which is not read; save it as text, or as PLY".to_string();
        return Err(SceneError::Unsupported { file: import.file.to_string(), what });
    }
    let mut counts = first.collect::<Vec<_>>();
    if counts.is_empty()
        && let Some(other) = next()
    {
        (number, line) = other;
        counts = words(line).collect();
    }
    let count = |index: usize| counts.get(index).and_then(|word| std::str::from_utf8(word).ok()?.parse::<u64>().ok());
    let (Some(num_vertices), Some(num_faces)) = (count(0), count(1)) else {
        let what = format!("{} are no counts of vertices and faces; export the model again", quote(line));
        return Err(import.malformed(number, what));
    };
    // A vertex is three digits and three spaces at least.
    let most = bytes.len() as u64 / 6 + 1;
    if num_vertices > most {
        let what =
            format!("{num_vertices} vertices are announced, and there is room for {most} at most; correct the count");
        return Err(import.malformed(number, what));
    }
    let keyword = keyword.unwrap_or_default();
    let mut vertices = Vertices { keyword, ..Vertices::default() };
    vertices.faces.reserve(num_vertices as usize, 0);
    for index in 0..num_vertices {
        let Some((number, line)) = next() else {
            let what = format!(
                "the file ends after {index} of {num_vertices} vertices; was it saved or downloaded completely?"
            );
            return Err(import.malformed(last.get(), what));
        };
        vertices.read(import, number, line)?;
    }
    let Vertices { mut faces, normals, colors, .. } = vertices;
    let mut indices = Vec::new();
    for index in 0..num_faces {
        let Some((number, line)) = next() else {
            let what = format!("after {index} of {num_faces} faces");
            import.report.note(NoteKind::MeshCut, last.get(), || what);
            break;
        };
        let mut numbers = words(line).map(|word| float(word).unwrap_or(f64::NAN));
        let length = numbers.next().unwrap_or(f64::NAN);
        indices.clear();
        indices.extend(numbers.by_ref().take(if length >= 0.0 { length as usize } else { 0 }));
        if length.is_nan() || length != indices.len() as f64 {
            import.report.note(NoteKind::ShortFace, number, || quote(line));
            continue;
        }
        let rest: Vec<&[u8]> = words(line).skip(1 + indices.len()).collect();
        let color = if colors.is_empty() { color(&rest) } else { None };
        faces.add(&mut import.report, Some(number), &indices, color);
    }
    if let Some((number, line)) = next() {
        import
            .report
            .note(NoteKind::CountWrong, number, || format!("{num_faces} faces announced, then {}", quote(line)));
    }
    let mesh = faces.finish(normals, colors);
    if mesh.parts.is_empty() { Err(import.no_triangles()) } else { Ok(mesh) }
}

/// Vertices while they are read.
#[derive(Default)]
struct Vertices {
    keyword: Keyword,
    faces: Faces,
    normals: Vec<Vec3>,
    colors: Vec<[u8; 3]>,
}

impl Vertices {
    fn read(&mut self, import: &Import<'_>, number: u32, line: &[u8]) -> Result<(), SceneError> {
        let mut rest = words(line);
        let mut three = || [rest.next(), rest.next(), rest.next()].map(Option::unwrap_or_default);
        let place = import.vertex(number, three())?.unwrap_or(DVec3::NAN);
        let keyword = self.keyword;
        let weight = if keyword.has_weight { rest.next().and_then(float).unwrap_or(f64::NAN) } else { 1.0 };
        self.faces.push(place / weight);
        let mut three = || [rest.next(), rest.next(), rest.next()].map(|word| word.and_then(float).unwrap_or(0.0));
        if keyword.has_normals {
            self.normals.push(DVec3::from_array(three()).as_vec3());
        }
        let rest: Vec<&[u8]> = rest.collect();
        // Colours without being announced are common, too: three or four numbers more.
        if keyword.has_colors || !self.colors.is_empty() || rest.len() >= 3 && self.faces.num_positions() == 1 {
            self.colors.push(color(&rest).unwrap_or(super::faces::WHITE));
        }
        Ok(())
    }
}

/// Three or four numbers as sRGB: whole ones go to 255, others to 1. Fewer are numbers of a table that no file has.
fn color(words: &[&[u8]]) -> Option<[u8; 3]> {
    let words = words.get(..3)?;
    let is_float = words.iter().any(|word| word.contains(&b'.'));
    let scale = if is_float { 255.0 } else { 1.0 };
    let mut color = [0; 3];
    for (byte, word) in color.iter_mut().zip(words) {
        *byte = (float(word).filter(|value| !value.is_nan())? * scale).round() as u8;
    }
    Some(color)
}

#[cfg(test)]
mod tests {
    use crate::scene::import::sniff::{Format, sniff};
    use crate::scene::mesh::RawNormals;
    use crate::scene::{LoadOptions, Report};

    use super::*;

    fn read_off(text: &str) -> (Result<RawMesh, SceneError>, Report) {
        assert_eq!(sniff("a.off", text.as_bytes()), Format::Off);
        let options = LoadOptions::default();
        let mut import = Import {
            file: "a.off",
            options: &options,
            report: Report::default(),
            folder: None,
            side_files: Vec::new(),
        };
        (read(&mut import, text.as_bytes()), import.report)
    }

    const SQUARE: &str = "OFF # a square\n\n4 2 5\n0 0 0\n1 0 0 # right\n1 1 0\n0 1 0\n# faces\n3 0 1 2\n4 0 1 2 3\n";

    #[test]
    fn counts_may_stand_anywhere_and_the_keyword_nowhere() {
        let on_first = SQUARE.replace("OFF # a square\n\n", "OFF ");
        for text in
            [SQUARE, &on_first, &SQUARE.replace("OFF", ""), &SQUARE.replace(" 5\n", "\n"), &SQUARE.replace('\n', "\r")]
        {
            let (mesh, report) = read_off(text);
            assert!(report.is_empty(), "{report}");
            assert_eq!(mesh.expect("loads").shapes[0].triangles, [[0, 1, 2], [0, 1, 2], [0, 2, 3]]);
        }
        assert_eq!(sniff("square", on_first.as_bytes()), Format::Off);
    }

    #[test]
    fn letters_say_what_vertices_have() {
        let text = "CN4OFF\n3 1\n0 0 0 1 0 0 1 255 0 9 255\n4 0 0 2 0 0 1 0.5 0.5 0.5 1\n0 1 0 1 0 0 1 x\n3 0 1 2\n";
        // The fourth coordinate comes before the normal.
        let (mesh, _) = read_off(text);
        let shape = &mesh.expect("loads").shapes[0];
        assert_eq!(shape.positions[1].to_array(), [2.0, 0.0, 0.0]);
        assert_eq!(shape.colors, [[255, 0, 9], [128; 3], [255; 3]]);
        assert!(matches!(&shape.normals, RawNormals::PerVertex(normals) if *normals == [Vec3::Z; 3]));
        for word in [&b"OFF"[..], b"STCN4OFF", b"NOFF", b"STOFF"] {
            assert!(Keyword::parse(word).is_some());
        }
        for word in [&b"OF"[..], b"XOFF", b"NCOFF", b"off "] {
            assert!(Keyword::parse(word).is_none());
        }
    }

    #[test]
    fn faces_may_have_colours() {
        let (mesh, _) =
            read_off(&SQUARE.replace("3 0 1 2\n", "3 0 1 2 255 128 0\n").replace("2 3\n", "2 3 0.5 0 0 1\n"));
        let shape = &mesh.expect("loads").shapes[0];
        assert_eq!(shape.positions.len(), 7);
        assert_eq!(
            [0, 1, 2].map(|i| shape.colors[shape.triangles[i][0] as usize]),
            [[255, 128, 0], [128, 0, 0], [128, 0, 0]]
        );
    }

    #[test]
    fn what_is_wrong_is_left_out_or_refused_with_its_line() {
        let (mesh, report) = read_off(&SQUARE.replace("4 0 1 2 3", "4 0 1 2 4"));
        assert_eq!((mesh.expect("loads").shapes[0].triangles.len(), report.count(NoteKind::FaceOutOfRange)), (1, 1));
        let (mesh, report) = read_off(&SQUARE.replace("4 0 1 2 3\n", ""));
        assert_eq!((mesh.expect("loads").shapes[0].triangles.len(), report.count(NoteKind::MeshCut)), (1, 1));
        let (mesh, report) = read_off(&SQUARE.replace("4 0 1 2 3", "9 0 1 2 3\n3 0 1 2"));
        assert!(mesh.is_ok() && report.count(NoteKind::ShortFace) == 1 && report.count(NoteKind::CountWrong) == 1);
        for (from, to, end) in [
            (
                "4 2 5",
                "353535235358 2 5",
                "a.off:3: 353535235358 vertices are announced, and there is room for 16 at most; correct the count",
            ),
            ("4 2 5", "four 2", "a.off:3: \"four 2\" are no counts of vertices and faces; export the model again"),
            ("4 2 5", "9 2 5", "a.off:10: the file ends after 6 of 9 vertices; was it saved or downloaded completely?"),
            ("1 0 0", "1,5 0 0", "a.off:5: \"1,5\" has a decimal comma; export the model with decimal points"),
            ("OFF", "OFF BINARY", "a.off: is a binary OFF file, which is not read; save it as text, or as PLY"),
        ] {
            assert_eq!(read_off(&SQUARE.replacen(from, to, 1)).0.expect_err(to).to_string(), end);
        }
    }
}
