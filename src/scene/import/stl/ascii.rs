//! STL as text: words, of which only `solid`, `facet`, `vertex` and their ends matter.

use glam::DVec3;

use super::Solid;
use crate::scene::import::lines::{Lines, quote};
use crate::scene::import::{Import, SceneError};
use crate::scene::mesh::{RawMesh, Triangulator};
use crate::scene::report::NoteKind;

/// Words with their lines; spaces of any kind and number lie between.
struct Words<'a> {
    lines: Lines<'a>,
    number: u32,
    line: &'a [u8],
}

impl<'a> Words<'a> {
    /// The next word, which stays until it is taken.
    fn peek(&mut self) -> Option<&'a [u8]> {
        self.line = self.line.trim_ascii_start();
        while self.line.is_empty() {
            (self.number, self.line) = self.lines.next()?;
            self.line = self.line.trim_ascii_start();
        }
        let end = self.line.iter().position(u8::is_ascii_whitespace).unwrap_or(self.line.len());
        Some(&self.line[..end])
    }

    fn take(&mut self) -> Option<&'a [u8]> {
        let word = self.peek()?;
        self.line = &self.line[word.len()..];
        Some(word)
    }

    /// Takes a word unless it is a keyword.
    fn take_number(&mut self) -> Option<&'a [u8]> {
        let word = self.peek()?;
        if keyword(word) == Keyword::None { self.take() } else { None }
    }

    /// What is left of the line, without spaces around it.
    fn take_line(&mut self) -> &'a [u8] {
        std::mem::take(&mut self.line).trim_ascii()
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Keyword {
    Solid,
    EndSolid,
    Facet,
    EndFacet,
    Normal,
    Outer,
    Loop,
    EndLoop,
    Vertex,
    None,
}

fn keyword(word: &[u8]) -> Keyword {
    const WORDS: [(&[u8], Keyword); 9] = [
        (b"vertex", Keyword::Vertex),
        (b"facet", Keyword::Facet),
        (b"normal", Keyword::Normal),
        (b"outer", Keyword::Outer),
        (b"loop", Keyword::Loop),
        (b"endloop", Keyword::EndLoop),
        (b"endfacet", Keyword::EndFacet),
        (b"solid", Keyword::Solid),
        (b"endsolid", Keyword::EndSolid),
    ];
    WORDS.iter().find(|(text, _)| text.eq_ignore_ascii_case(word)).map_or(Keyword::None, |&(_, keyword)| keyword)
}

/// The facet that is being read.
#[derive(Default)]
struct Facet {
    /// Its first line; 0 outside of facets.
    line: u32,
    corners: Vec<DVec3>,
    is_closed: bool,
    /// A vertex of it is no place.
    is_nowhere: bool,
    /// What the first such vertex says.
    what: String,
}

/// Reads all solids.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let mut words = Words { lines: Lines::new(bytes), number: 0, line: b"" };
    let (mut mesh, mut solid, mut facet) = (RawMesh::default(), Solid::default(), Facet::default());
    let mut is_open = false;
    while let Some(word) = words.take() {
        let line = words.number;
        match keyword(word) {
            Keyword::Solid => {
                facet.finish(import, &mut solid);
                solid.finish(&mut mesh);
                solid.name = String::from_utf8_lossy(words.take_line()).into_owned();
                is_open = true;
            }
            Keyword::EndSolid => {
                words.take_line();
                facet.finish(import, &mut solid);
                solid.finish(&mut mesh);
                is_open = false;
            }
            Keyword::Facet => {
                facet.finish(import, &mut solid);
                facet.line = line;
            }
            Keyword::Normal => (0..3).for_each(|_| {
                words.take_number();
            }),
            // A new loop is a new facet, also where the word for it is misspelt.
            Keyword::Outer | Keyword::Loop if facet.is_closed => {
                facet.finish(import, &mut solid);
                facet.line = line;
            }
            Keyword::Outer | Keyword::Loop => {}
            Keyword::Vertex => {
                let mut read = || words.take_number();
                let (x, y, z) = (read(), read(), read());
                let texts = [x, y, z].map(Option::unwrap_or_default);
                if facet.line == 0 {
                    facet.line = line;
                }
                match import.vertex(line, texts)? {
                    Some(place) => facet.corners.push(place),
                    None if facet.is_nowhere => {}
                    None => (facet.is_nowhere, facet.what) = (true, quote(&texts.join(&b' '))),
                }
            }
            Keyword::EndLoop => facet.is_closed = true,
            Keyword::EndFacet => {
                facet.is_closed = true;
                facet.finish(import, &mut solid);
            }
            Keyword::None => {
                import.report.note(NoteKind::UnknownWord, line, || quote(word));
                words.take_line();
            }
        }
    }
    if is_open || facet.line != 0 {
        import.report.note(NoteKind::MeshCut, words.number, || "no endsolid".to_string());
    }
    // The last number of an open facet may be cut.
    if facet.is_closed {
        facet.finish(import, &mut solid);
    }
    solid.finish(&mut mesh);
    Ok(mesh)
}

impl Facet {
    /// Adds the facet to the solid if it is whole, and begins anew.
    fn finish(&mut self, import: &mut Import<'_>, solid: &mut Solid) {
        let Facet { line, corners, is_nowhere, what, .. } = std::mem::take(self);
        if line == 0 {
            return;
        }
        if is_nowhere {
            import.report.note(NoteKind::FaceNowhere, line, || what);
        } else if corners.len() < 3 {
            import.report.note(NoteKind::ShortFace, line, String::new);
        } else {
            // Some programs write polygons.
            let mut triangles = Vec::new();
            if !Triangulator::default().cut(&corners, &mut triangles) {
                import.report.note(NoteKind::CrossedPolygon, line, String::new);
            }
            for triangle in triangles {
                solid.push(triangle.map(|corner| corners[corner as usize]));
            }
        }
    }
}
