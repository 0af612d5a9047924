//! What an importer mended, guessed or skipped, with the lines where it did.

use std::collections::BTreeMap;
use std::fmt;

/// How many lines of one kind are named; the rest is only counted, so that a damaged million-atom file costs no memory.
const LISTED_PER_KIND: usize = 5;

macro_rules! note_kinds {
    ($($(#[$doc:meta])* $kind:ident => $one:literal / $many:literal : $rest:literal,)*) => {
        /// A kind of thing that was mended, guessed or skipped.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum NoteKind { $($(#[$doc])* $kind,)* }

        impl NoteKind {
            /// Every kind, in the order of reports.
            pub const ALL: &'static [Self] = &[$(Self::$kind,)*];

            /// Singular, plural, and the end of the sentence.
            const fn words(self) -> (&'static str, &'static str, &'static str) {
                match self { $(Self::$kind => ($one, $many, $rest),)* }
            }
        }
    };
}

note_kinds! {
    /// A coordinate that is blank, `****`, NaN or no number.
    BadCoordinate => "atom" / "atoms": "skipped: a coordinate is no number",
    /// An atom line that ends inside its coordinates.
    ShortLine => "atom" / "atoms": "skipped: the line is cut short",
    /// A row of a table with too few or too many values.
    BadRow => "row" / "rows": "skipped: not as many values as columns",
    /// A quotation that does not end on its line.
    OpenQuote => "quotation" / "quotations": "never closed: taken to end with the line",
    /// A text field that does not end at all.
    OpenText => "text field" / "text fields": "never closed: what follows it is not read",
    /// Less occupied alternate locations.
    AlternateLocation => "alternate position" / "alternate positions": "left out: the most occupied one of each is drawn",
    /// Models or frames that were not asked for.
    ModelSkipped => "other model" / "other models": "in the file, not drawn (--model chooses)",
    /// A model that was not closed, or an atom outside of any.
    ModelMended => "model" / "models": "not properly opened or closed, mended",
    /// A residue number that is none.
    BadResidueNumber => "residue number" / "residue numbers": "unreadable, taken as 0",
    /// No element given; it was guessed from the atom's name.
    ElementGuessed => "atom" / "atoms": "without an element: guessed from the name",
    /// An element symbol that no element has; guessed from the atom's name.
    ElementCorrected => "atom" / "atoms": "with a symbol that no element has: guessed from the name",
    /// The element stays unknown; drawn in pink with carbon's size.
    ElementUnknown => "atom" / "atoms": "of unknown element, drawn in pink with carbon's size",
    /// Lower-case records.
    LowerCase => "line" / "lines": "in lower case, read as upper case",
    /// Serial numbers used more than once.
    DuplicateSerial => "atom" / "atoms": "with a serial number that another atom has too",
    /// A `CONECT` record that is no number, or names the atom itself.
    BadBondRecord => "bond record" / "bond records": "ignored: no two atoms",
    /// A `CONECT` record to an atom that is missing or ambiguous.
    BondToNowhere => "bond record" / "bond records": "ignored: an atom is missing or not unique",
    /// A bond of the file that is several times too long, or has no length.
    OddBond => "bond of the file" / "bonds of the file": "left out: no length, or several times too long as across the edge of a cell",
    /// A symmetry operation of a crystal that is none.
    BadSymmetry => "symmetry operation" / "symmetry operations": "ignored: not like -x+1/2, y, -z",
    /// Crowded atoms: not all neighbours were looked at.
    Crowded => "atom" / "atoms": "too crowded for bonds by distance: only some neighbours were tried",
    /// The count line of an XYZ file was mended.
    CountMended => "place" / "places": "where count or comment line and atoms disagree, mended",
    /// Text after the last atom that is neither an atom nor a frame.
    TrailingText => "line" / "lines": "after the atoms not read",
    /// A triangle or polygon with a vertex at NaN or infinity.
    FaceNowhere => "face" / "faces": "left out: a coordinate is no number",
    /// A triangle or polygon that names a vertex that is not there, or ends before its last.
    FaceOutOfRange => "face" / "faces": "left out: a vertex that the file does not have",
    /// Points or lines of a mesh file.
    NotTriangles => "set of points or lines" / "sets of points or lines": "left out: only triangles are drawn",
    /// Normals or colours that do not belong to the vertices.
    AttributeLeftOut => "list of normals or colours" / "lists of normals or colours": "left out: not as many as vertices, or damaged",
    /// A number of a node, mesh or material that does not exist.
    ReferenceToNowhere => "reference" / "references": "ignored: there is no such thing in the file",
    /// A transform of NaN, infinity or absurd numbers.
    NodeLeftOut => "node" / "nodes": "left out with all below: the transform is not made of finite numbers",
    /// A node that is the child of two others.
    NodeTwice => "node" / "nodes": "found in two places, drawn in the first",
    /// A quaternion of zeros.
    RotationMended => "rotation" / "rotations": "of zero length, taken as none",
    /// A length in a file's header.
    LengthMended => "length" / "lengths": "wrong in the file's header, ignored",
    /// Scenes that are not the default.
    SceneSkipped => "other scene" / "other scenes": "in the file, not drawn",
    /// Textures.
    TextureNotDrawn => "texture" / "textures": "in the file, not drawn: surfaces have the colours of their materials",
    /// Animations, skins, morph targets.
    NotAnimated => "animation, skin or morph" / "animations, skins and morphs": "in the file, not followed: the mesh is drawn as it is saved",
    /// Lengths of a file that were turned into millimetres.
    UnitConverted => "unit" / "units": "of length converted to millimetres",
    /// A unit that does not exist.
    UnitUnknown => "unit" / "units": "of length unknown, taken as millimetres",
    /// A colour with an alpha of zero.
    InvisibleMended => "material" / "materials": "invisible by its alpha of 0, drawn solid",
    /// A colour that cannot be read.
    ColorUnknown => "colour" / "colours": "missing or unreadable, taken as white",
    /// Positions that single precision rounds visibly.
    CoarsePositions => "molecule" / "molecules": "so wide that positions are rounded",
    /// A face of no, one or two vertices.
    ShortFace => "face" / "faces": "left out: fewer than three vertices",
    /// A normal that the file does not have, or that is no number.
    NoNormal => "face" / "faces": "with normals that the file does not have: found anew",
    /// A vertex colour that is no number.
    NoColor => "vertex" / "vertices": "with a colour that is no number, drawn white",
    /// A polygon that no way of cutting covers.
    CrossedPolygon => "polygon" / "polygons": "crossing itself or without area: cut as well as it can be",
    /// A word or line of a mesh file that says nothing to this reader.
    UnknownWord => "word" / "words": "not understood, skipped",
    /// A count in a mesh file that is not that of what follows.
    CountWrong => "count" / "counts": "not that of what follows: what is there is drawn",
    /// Bytes after the last thing that a binary mesh file announces.
    TrailingBytes => "byte" / "bytes": "at the end not read",
    /// A mesh file that ends inside something.
    MeshCut => "place" / "places": "where the file ends too early: what is whole is drawn",
    /// A part whose placement is not finite, or shrinks everything to a line.
    PartUnplaceable => "part" / "parts": "left out: its placement is not finite or shrinks it to nothing",
    /// A triangle with a vertex that is missing or lies nowhere.
    LostTriangle => "triangle" / "triangles": "left out: a vertex is missing or no finite number",
    /// A triangle that is a line or a point.
    FlatTriangle => "triangle" / "triangles": "without area left out",
    /// A triangle that is there more than once.
    RepeatedTriangle => "triangle" / "triangles": "left out: the same one is there already",
    /// Vertices at open edges, nearer together than a millionth of the size.
    NearlyWelded => "vertex" / "vertices": "at open edges moved onto another one that is as good as equal",
    /// Triangles whose winding did not agree with that of their neighbours.
    FaceTurned => "triangle" / "triangles": "turned to agree with their neighbours",
    /// A closed surface whose triangles all looked inwards.
    InsideOut => "closed surface" / "closed surfaces": "inside out, turned",
    /// Normals that look inwards.
    NormalsDropped => "normal" / "normals": "of the file not used: most look to the other side than their triangles",
    /// A file of materials that was not read.
    MaterialFile => "material file" / "material files": "not read",
    /// A material that parts name and no file describes.
    UnknownMaterial => "material" / "materials": "that no file describes, drawn in grey",
    /// An assembly was asked for, and the format has none.
    NoAssemblies => "assembly" / "assemblies": "asked for, which files of this format do not have: drawn as they are",
    /// A model was asked for, and the format has none.
    NoModels => "model" / "models": "asked for, which meshes do not have: drawn as they are",
    /// A picture on a surface.
    PictureNotDrawn => "picture" / "pictures": "on surfaces not drawn: plain colours are",
}

/// One thing that was mended, guessed or skipped.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// Line of the file, from 1, if it has one.
    pub line: Option<u32>,
    /// What kind of thing.
    pub kind: NoteKind,
    /// What was there, or empty.
    pub text: String,
}

/// All notes about one file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Report {
    /// The first few notes of each kind, in the order of the file.
    pub entries: Vec<Note>,
    counts: BTreeMap<NoteKind, u32>,
}

impl Report {
    /// Notes one thing; `text` is asked for only if the note is listed.
    pub fn note(&mut self, kind: NoteKind, line: impl Into<Option<u32>>, text: impl FnOnce() -> String) {
        let count = self.counts.entry(kind).or_default();
        *count = count.saturating_add(1);
        if *count as usize <= LISTED_PER_KIND {
            self.entries.push(Note { line: line.into(), kind, text: text() });
        }
    }

    /// Notes `count` things of a kind that have no lines.
    pub fn note_many(&mut self, kind: NoteKind, count: u32, text: impl FnOnce() -> String) {
        if count > 0 {
            self.note(kind, None, text);
            let noted = self.counts.entry(kind).or_default();
            *noted = noted.saturating_add(count - 1);
        }
    }

    /// How many things of a kind were noted, listed or not.
    pub fn count(&self, kind: NoteKind) -> u32 {
        self.counts.get(&kind).copied().unwrap_or(0)
    }

    /// Whether nothing was noted.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }
}

impl fmt::Display for Report {
    /// One line per kind, each ended by a line feed: `3 atoms skipped: a coordinate is no number (line 278: x = "nan"; ...)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for &kind in NoteKind::ALL {
            let count = self.count(kind);
            if count == 0 {
                continue;
            }
            let (one, many, rest) = kind.words();
            write!(f, "{count} {} {rest}", if count == 1 { one } else { many })?;
            let listed = self.entries.iter().filter(|note| note.kind == kind);
            let places: Vec<String> = listed.map(Note::place).filter(|place| !place.is_empty()).collect();
            if !places.is_empty() {
                let more = if count as usize > LISTED_PER_KIND { "; ..." } else { "" };
                write!(f, " ({}{more})", places.join("; "))?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

impl Note {
    /// Line and text, as far as there are any.
    fn place(&self) -> String {
        match (self.line, self.text.as_str()) {
            (None, text) => text.to_string(),
            (Some(line), "") => format!("line {line}"),
            (Some(line), text) => format!("line {line}: {text}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_notes_list_five() {
        let mut report = Report::default();
        for line in 1..=1_000_000 {
            report.note(NoteKind::BadCoordinate, line, || "x = \"nan\"".to_string());
        }
        assert_eq!(report.entries.len(), LISTED_PER_KIND);
        assert_eq!(report.count(NoteKind::BadCoordinate), 1_000_000);
        assert!(
            report.to_string().starts_with("1000000 atoms skipped: a coordinate is no number (line 1: x = \"nan\"; ")
        );
    }

    #[test]
    fn each_kind_prints_one_line_in_good_english() {
        let mut report = Report::default();
        assert!(report.is_empty() && report.to_string().is_empty());
        report.note(NoteKind::ShortLine, 7, String::new);
        report.note_many(NoteKind::ModelSkipped, 19, String::new);
        report.note_many(NoteKind::Crowded, 0, String::new);
        assert_eq!(
            report.to_string(),
            "1 atom skipped: the line is cut short (line 7)\n19 other models in the file, not drawn (--model chooses)\n"
        );
    }

    #[test]
    fn kinds_stand_in_the_order_of_their_numbers() {
        for (index, &kind) in NoteKind::ALL.iter().enumerate() {
            assert_eq!(kind as usize, index);
        }
    }
}
