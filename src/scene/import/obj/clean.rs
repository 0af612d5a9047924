//! An OBJ file as `tobj` can read it: every number finite, every index in range, every name a number.

use std::collections::HashMap;
use std::io::{self, BufRead, Read, Write};

use super::checked::Checked;
use super::names::{Names, Numbers, Run};
use super::statement::{Statements, keyword, name, words};
use crate::scene::import::lines::quote;
use crate::scene::import::number::float;
use crate::scene::import::{Import, SceneError};
use crate::scene::report::NoteKind;

/// What is being handed out.
#[derive(PartialEq)]
enum Pass {
    Vertices,
    Faces,
}

/// Hands the file to `tobj` statement by statement: vertices first, so that faces may come before them.
pub(super) struct Cleaned<'a, 'b, 'c> {
    import: &'a mut Import<'b>,
    text: &'c [u8],
    statements: Statements<'c>,
    pass: Pass,
    /// Line of the last statement that was handed out, or of the one that is wrong.
    line: u32,
    error: Option<SceneError>,
    /// What is being handed out, and how much of it was taken.
    out: Vec<u8>,
    taken: usize,
    has_colors: bool,
    positions: Checked,
    normals: Checked,
    corners: Vec<(u32, Option<u32>)>,
    names: Names,
    run_numbers: HashMap<Run, u32>,
    text_numbers: Numbers,
    material_numbers: Numbers,
    now: Run,
    /// Number of the run that faces were handed out for last.
    last_run: Option<u32>,
}

/// Why a face is left out.
enum LeftOut {
    Short,
    OutOfRange,
    Nowhere,
}

impl<'a, 'b, 'c> Cleaned<'a, 'b, 'c> {
    pub(super) fn new(import: &'a mut Import<'b>, text: &'c [u8]) -> Self {
        let mut names = Names::default();
        let mut text_numbers = Numbers::default();
        let nameless = text_numbers.of(String::new(), &mut names.texts);
        Self {
            import,
            text,
            statements: Statements::new(text),
            pass: Pass::Vertices,
            line: 0,
            error: None,
            out: Vec::new(),
            taken: 0,
            has_colors: has_colors(text),
            positions: Checked::default(),
            normals: Checked::default(),
            corners: Vec::new(),
            names,
            run_numbers: HashMap::new(),
            text_numbers,
            material_numbers: Numbers::default(),
            now: Run { object: nameless, group: nameless, material: None, has_normals: false },
            last_run: None,
        }
    }

    /// The error behind one of `tobj`, with the line that it was given last.
    pub(super) fn blame(self, error: &tobj::LoadError) -> SceneError {
        let what = || format!("cannot be read ({error}); export the model again");
        self.error.unwrap_or_else(|| self.import.malformed(self.line, what()))
    }

    /// What the file names.
    pub(super) fn finish(self) -> Names {
        self.names
    }

    /// Fills `out` from the next statement that gives anything; leaves it empty at the end.
    fn advance(&mut self) -> Result<(), SceneError> {
        self.out.clear();
        self.taken = 0;
        // Taken out so that statements, which lie in it, can be looked at.
        let mut statements = std::mem::replace(&mut self.statements, Statements::new(b""));
        let result = loop {
            let Some((line, statement)) = statements.next() else {
                if self.pass == Pass::Faces {
                    break Ok(());
                }
                self.pass = Pass::Faces;
                statements = Statements::new(self.text);
                continue;
            };
            self.line = line;
            let (word, rest) = keyword(statement);
            let result = if self.pass == Pass::Vertices { self.vertices(word, rest) } else { self.faces(word, rest) };
            if result.is_err() || !self.out.is_empty() {
                break result;
            }
        };
        self.statements = statements;
        result
    }

    fn vertices(&mut self, word: &[u8], rest: &[u8]) -> Result<(), SceneError> {
        match word {
            b"v" => {
                let mut numbers = words(rest);
                let texts = [numbers.next(), numbers.next(), numbers.next()].map(Option::unwrap_or_default);
                let place = self.import.vertex(self.line, texts)?;
                self.positions.push(place.is_some());
                self.write(b"v", texts, place.is_some());
                if self.has_colors {
                    self.write_color([numbers.next(), numbers.next(), numbers.next()]);
                }
            }
            b"vn" => {
                let mut numbers = words(rest);
                let texts = [numbers.next(), numbers.next(), numbers.next()].map(Option::unwrap_or_default);
                let is_good = texts.iter().all(|text| float(text).is_some_and(|value| value.abs() <= 1e30));
                self.normals.push(is_good);
                self.write(b"vn", texts, is_good);
            }
            _ => return Ok(()),
        }
        self.out.push(b'\n');
        Ok(())
    }

    /// Writes three numbers, or zeros in their place.
    fn write(&mut self, word: &[u8], texts: [&[u8]; 3], is_good: bool) {
        self.out.extend_from_slice(word);
        for text in texts {
            self.out.push(b' ');
            if !is_good {
                self.out.push(b'0');
            } else {
                // The exponent letters of Fortran are not known everywhere.
                self.out.extend(text.iter().map(|&byte| if matches!(byte, b'd' | b'D') { b'e' } else { byte }));
            }
        }
    }

    fn write_color(&mut self, texts: [Option<&[u8]>; 3]) {
        let values = texts.map(|text| text.map(|text| float(text).filter(|value| value.is_finite())));
        let [Some(Some(red)), Some(Some(green)), Some(Some(blue))] = values else {
            if values.iter().any(|value| matches!(value, Some(None))) {
                self.import.report.note(NoteKind::NoColor, self.line, String::new);
            }
            // The range of colours is not known yet.
            self.out.extend_from_slice(b" nan nan nan");
            return;
        };
        // Writing to memory cannot fail.
        let _ = write!(self.out, " {red} {green} {blue}");
    }

    fn faces(&mut self, word: &[u8], rest: &[u8]) -> Result<(), SceneError> {
        match word {
            b"v" => self.positions.before += 1,
            b"vn" => self.normals.before += 1,
            b"f" | b"fo" => self.face(rest),
            // Groups go on: the format knows nothing of groups within objects.
            b"o" => self.now.object = self.text_numbers.of(name(rest), &mut self.names.texts),
            b"g" => self.now.group = self.text_numbers.of(name(rest), &mut self.names.texts),
            b"usemtl" if rest.is_empty() => self.now.material = None,
            b"usemtl" => {
                self.now.material = Some(self.material_numbers.of(name(rest), &mut self.names.materials));
            }
            b"mtllib" => {
                let library = name(rest);
                if !self.names.libraries.iter().any(|(_, other)| *other == library) {
                    self.names.libraries.push((self.line, library));
                }
            }
            _ if word.starts_with(b"#") || IGNORED.contains(&word) => {}
            _ => self.import.report.note(NoteKind::UnknownWord, self.line, || quote(word)),
        }
        Ok(())
    }

    fn face(&mut self, rest: &[u8]) {
        match self.parse_corners(rest) {
            Ok(has_normals) => {
                let run = Run { has_normals, ..self.now };
                let runs = &mut self.names.runs;
                let number = *self.run_numbers.entry(run).or_insert_with(|| {
                    runs.push(run);
                    runs.len() as u32 - 1
                });
                if self.last_run.replace(number) != Some(number) {
                    let _ = writeln!(self.out, "g {number}");
                }
                self.out.push(b'f');
                for &(position, normal) in &self.corners {
                    let _ = match normal.filter(|_| has_normals) {
                        Some(normal) => write!(self.out, " {}//{}", position + 1, normal + 1),
                        None => write!(self.out, " {}", position + 1),
                    };
                }
                self.out.push(b'\n');
            }
            Err(LeftOut::Short) => self.import.report.note(NoteKind::ShortFace, self.line, || quote(rest)),
            Err(LeftOut::OutOfRange) => self.import.report.note(NoteKind::FaceOutOfRange, self.line, || quote(rest)),
            Err(LeftOut::Nowhere) => self.import.report.note(NoteKind::FaceNowhere, self.line, || quote(rest)),
        }
    }

    /// Reads the corners of a face; answers whether all have normals.
    fn parse_corners(&mut self, rest: &[u8]) -> Result<bool, LeftOut> {
        self.corners.clear();
        let (mut has_any_normal, mut is_nowhere) = (false, false);
        for word in words(rest) {
            let mut indices = word.split(|&byte| byte == b'/');
            let position = self.positions.resolve(indices.next().unwrap_or_default()).ok_or(LeftOut::OutOfRange)?;
            is_nowhere |= self.positions.is_bad(position);
            let normal = indices.nth(1).filter(|text| !text.is_empty());
            has_any_normal |= normal.is_some();
            let normal = normal.and_then(|text| self.normals.resolve(text));
            self.corners.push((position, normal.filter(|&normal| !self.normals.is_bad(normal))));
        }
        if self.corners.len() < 3 {
            return Err(LeftOut::Short);
        }
        if is_nowhere {
            return Err(LeftOut::Nowhere);
        }
        let has_normals = self.corners.iter().all(|(_, normal)| normal.is_some());
        if has_any_normal && !has_normals {
            self.import.report.note(NoteKind::NoNormal, self.line, || quote(rest));
        }
        Ok(has_normals)
    }
}

/// Statements that say nothing about triangles or their colours.
const IGNORED: &[&[u8]] = &[
    b"",
    b"vt",
    b"vp",
    b"s",
    b"mg",
    b"l",
    b"p",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"maplib",
    b"usemap",
    b"call",
    b"csh",
    b"cstype",
    b"deg",
    b"bmat",
    b"step",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"ctech",
    b"stech",
];

/// Whether any vertex has a colour: `tobj` wants one for each or none at all.
fn has_colors(text: &[u8]) -> bool {
    let mut statements = Statements::new(text);
    while let Some((_, statement)) = statements.next() {
        let (word, rest) = keyword(statement);
        if word == b"v" && words(rest).count() >= 6 {
            return true;
        }
    }
    false
}

impl BufRead for Cleaned<'_, '_, '_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.taken == self.out.len() && self.error.is_none() {
            self.error = self.advance().err();
        }
        match self.error {
            Some(_) => Err(io::ErrorKind::InvalidData.into()),
            None => Ok(&self.out[self.taken..]),
        }
    }

    fn consume(&mut self, amount: usize) {
        self.taken = self.out.len().min(self.taken + amount);
    }
}

impl Read for Cleaned<'_, '_, '_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(into)?;
        self.consume(count);
        Ok(count)
    }
}
