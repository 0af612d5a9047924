//! Finds out what kind of file some bytes are, by content first and by extension second.

use super::lines::Lines;
use super::{obj, off, ply, stl};
use std::path::Path;

/// What a file turned out to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Protein Data Bank, fixed columns.
    Pdb,
    /// mmCIF, or a CIF of a small molecule.
    Cif,
    /// BinaryCIF, in MessagePack.
    BinaryCif,
    /// A count, a comment, and lines of symbol x y z.
    Xyz,
    /// Wavefront OBJ.
    Obj,
    /// Object file format of Geomview.
    Off,
    /// Polygon file format, text or binary.
    Ply,
    /// Stereolithography, ASCII or binary.
    Stl,
    /// glTF 2.0: JSON, or a GLB.
    Gltf,
    /// 3MF: a zip archive with a model in XML.
    ThreeMf,
    /// Records of a table of atoms and bonds: SDF, MOL.
    Sdf,
    /// Sections that begin with `@<TRIPOS>`.
    Mol2,
    /// Atoms of a PDB file by words, with charge and radius.
    Pqr,
    /// Another known kind: what it is, with its article.
    Foreign(&'static str),
    /// Nothing that is known here.
    Unknown,
}

impl Format {
    /// What people call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pdb => "PDB",
            Self::Cif => "CIF",
            Self::BinaryCif => "BinaryCIF",
            Self::Xyz => "XYZ",
            Self::Obj => "OBJ",
            Self::Off => "OFF",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Gltf => "glTF",
            Self::ThreeMf => "3MF",
            Self::Sdf => "SDF",
            Self::Mol2 => "MOL2",
            Self::Pqr => "PQR",
            Self::Foreign(what) => what,
            Self::Unknown => "unknown",
        }
    }
}

/// Bytes at the start that are looked at.
const HEAD: usize = 1 << 16;

/// First bytes of binary and other formats.
const MAGIC: &[(&[u8], &str)] = &[
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"%PDF", "a PDF document"),
    (b"PK\x03\x04", "a zip archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"BZh", "a bzip2 archive"),
    (b"\xfd7zXZ", "an xz archive"),
    (b"\x28\xb5\x2f\xfd", "a zstd archive"),
    (b"\x7fELF", "a program"),
    (b"\xff\xfe", "a text in UTF-16"),
    (b"\xfe\xff", "a text in UTF-16"),
    (b"version https://git-lfs", "a Git LFS pointer instead of the file itself"),
    (b"<", "a web page or XML file"),
    (b"{", "a JSON file"),
];

/// Extensions of formats whose content does not say clearly what it is.
const FOREIGN_EXTENSIONS: &[(&str, &str)] =
    &[("mmtf", "an MMTF file"), ("cube", "a Gaussian cube file"), ("gro", "a GROMACS file")];

/// Records that begin lines of PDB files and of nothing else that has them in its first lines.
const PDB_RECORDS: &[&[u8]] = &[
    b"HEADER", b"OBSLTE", b"TITLE ", b"SPLIT ", b"CAVEAT", b"COMPND", b"SOURCE", b"KEYWDS", b"EXPDTA", b"AUTHOR",
    b"REVDAT", b"JRNL  ", b"REMARK", b"SEQRES", b"CRYST1", b"ORIGX1", b"SCALE1", b"MODEL ", b"ATOM  ", b"HETATM",
    b"CONECT", b"HELIX ", b"SHEET ", b"SSBOND", b"MASTER", b"USER  ",
];

/// The format of a file; `name` is its path and may be anything.
pub fn sniff(name: &str, bytes: &[u8]) -> Format {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let head = &bytes[..bytes.len().min(HEAD)];
    let start = head.trim_ascii_start();
    // A MessagePack map begins with such a byte, which no text does; the name of its first keys stands near it.
    let is_map = matches!(head.first(), Some(0x80..=0x8f | 0xde | 0xdf));
    if is_map && memchr::memmem::find(&head[..head.len().min(1024)], b"dataBlocks").is_some() {
        return Format::BinaryCif;
    }
    let extension = Path::new(name)
        .extension()
        .map(|extension| extension.to_string_lossy().to_ascii_lowercase())
        .unwrap_or_default();
    if let Some(format) = triangles(bytes, head, &extension) {
        return format;
    }
    let has = |word: &[u8]| memchr::memmem::find(head, word).is_some();
    let is_gltf_text = || extension == "gltf" || has(b"\"asset\"");
    if head.starts_with(b"glTF") || start.starts_with(b"{") && is_gltf_text() {
        return Format::Gltf;
    }
    // The names of entries stand before them, and other archives with models do not call them so.
    if head.starts_with(b"PK\x03\x04") && (extension == "3mf" || has(b"3dmodel.model")) {
        return Format::ThreeMf;
    }
    if let Some((_, what)) = MAGIC.iter().find(|(magic, _)| head.starts_with(magic) || start.starts_with(magic)) {
        return Format::Foreign(what);
    }
    by_lines(head, &extension).unwrap_or_else(|| by_extension(&extension))
}

/// Meshes that begin or end as nothing else does.
fn triangles(bytes: &[u8], head: &[u8], extension: &str) -> Option<Format> {
    let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    if stl::is_exact_binary(bytes) || stl::begins_as_text(bytes) {
        Some(Format::Stl)
    } else if ply::begins(head) {
        Some(Format::Ply)
    } else if off::begins(head) || extension == "off" && head.trim_ascii_start().first().is_some_and(u8::is_ascii_digit)
    {
        // Without its keyword it begins with a count, as an XYZ file does.
        Some(Format::Off)
    } else if obj::is_obj(head) || extension == "obj" && is_utf16 {
        Some(Format::Obj)
    } else {
        None
    }
}

/// What the first lines tell, if they do.
fn by_lines(head: &[u8], extension: &str) -> Option<Format> {
    let starts =
        |line: &[u8], word: &[u8]| line.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word));
    let first = Lines::new(head).next().map(|(_, line)| line.trim_ascii()).unwrap_or_default();
    let digits = first.strip_prefix(b"-").unwrap_or(first);
    // Other formats begin with a number, too; their names tell.
    let is_count = !digits.is_empty()
        && digits.iter().all(u8::is_ascii_digit)
        && !matches!(extension, "sdf" | "sd" | "mol" | "mdl" | "mol2" | "pqr")
        && !FOREIGN_EXTENSIONS.iter().any(|(foreign, _)| *foreign == extension);
    let mut is_pdb = false;
    for (number, line) in Lines::new(head) {
        let ends = |word: &[u8]| line.trim_ascii_end().ends_with(word);
        if number == 4 && (ends(b"V2000") || ends(b"V3000")) {
            return Some(Format::Sdf);
        }
        if is_count {
            // The comment of an XYZ file may begin with any word.
            if number == 4 {
                break;
            }
            continue;
        }
        // Comments may come first.
        if line.starts_with(b"@<TRIPOS>") {
            return Some(Format::Mol2);
        }
        let is_loop = number == 1 && starts(line, b"loop_");
        if is_loop || starts(line, b"data_") || starts(line, b"_atom_site") {
            return Some(Format::Cif);
        }
        // A CIF begins with its data block, so nothing after a first record can change this.
        is_pdb = PDB_RECORDS.iter().any(|record| is_record(line, record.trim_ascii_end()));
        if is_pdb {
            break;
        }
    }
    match (is_count, is_pdb, extension) {
        (true, ..) => Some(Format::Xyz),
        (_, true, "pqr") => Some(Format::Pqr),
        (_, true, _) => Some(Format::Pdb),
        _ => None,
    }
}

/// Whether a line begins with a record's name, all in upper or all in lower case: `Model` begins a sentence.
fn is_record(line: &[u8], record: &[u8]) -> bool {
    let Some((start, rest)) = line.split_at_checked(record.len()) else {
        return false;
    };
    let is_one_case = !start.iter().any(u8::is_ascii_lowercase) || !start.iter().any(u8::is_ascii_uppercase);
    start.eq_ignore_ascii_case(record) && is_one_case && is_record_end(rest.first())
}

/// Whether a record name ends here: the line ends, or a space or a digit (`HETATM10000`) follows.
fn is_record_end(next: Option<&u8>) -> bool {
    next.is_none_or(|next| next.is_ascii_whitespace() || next.is_ascii_digit())
}

/// What the name tells.
fn by_extension(extension: &str) -> Format {
    match extension {
        "pdb" | "ent" | "pdb1" | "brk" | "pdbqt" => Format::Pdb,
        "cif" | "mmcif" => Format::Cif,
        "bcif" => Format::BinaryCif,
        "xyz" => Format::Xyz,
        "stl" => Format::Stl,
        "gltf" | "glb" => Format::Gltf,
        "off" => Format::Off,
        "ply" => Format::Ply,
        "obj" => Format::Obj,
        "3mf" => Format::ThreeMf,
        "sdf" | "sd" | "mol" | "mdl" => Format::Sdf,
        "mol2" => Format::Mol2,
        "pqr" => Format::Pqr,
        _ => FOREIGN_EXTENSIONS
            .iter()
            .find(|(foreign, _)| *foreign == extension)
            .map_or(Format::Unknown, |(_, what)| Format::Foreign(what)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_beats_the_extension() {
        assert_eq!(sniff("a.pdb", b"\x89PNG\r\n\x1a\n"), Format::Foreign("a PNG picture"));
        assert_eq!(sniff("a.pdb", b"data_1CRN\n#\nloop_\n_atom_site.id\nATOM 1 N"), Format::Cif);
        assert_eq!(sniff("a.pdb", b"\x83\xa7encoder\xa1x\xaadataBlocks\x90"), Format::BinaryCif);
        assert_eq!(sniff("a.xyz", b"ATOM      1  N   THR"), Format::Pdb);
        assert_eq!(sniff("a.txt", b"atom      1  n   thr"), Format::Pdb);
        assert_eq!(sniff("molecule", b"  3 \n\nC 0 0 0"), Format::Xyz);
        assert_eq!(sniff("a.pdb", b"-24\n\nC 0 0 0"), Format::Xyz);
        assert_eq!(sniff("a", b"1\nMODEL 1, data_set 2\nC 0 0 0"), Format::Xyz);
        assert_eq!(sniff("a", b"7\n\n\n  1  0  0     0  0  0999 V2000"), Format::Sdf);
        assert_eq!(sniff("a.pdb", b"# a comment\n@<TRIPOS>MOLECULE\n"), Format::Mol2);
        assert_eq!(sniff("a.md", b"Model 1 is nicer\n"), Format::Unknown);
        assert_eq!(sniff("a", b"{ \"asset\": {\"version\": \"2.0\"}}"), Format::Gltf);
        assert_eq!(sniff("a.json", b"{\"data\": 1}"), Format::Foreign("a JSON file"));
        assert_eq!(sniff("a.zip", b"PK\x03\x04..3D/3dmodel.model"), Format::ThreeMf);
        assert_eq!(sniff("a.docx", b"PK\x03\x04..word/document.xml"), Format::Foreign("a zip archive"));
        assert_eq!(sniff("a.glb", b"glTX"), Format::Gltf);
    }

    #[test]
    fn the_extension_helps_where_content_is_silent() {
        assert_eq!(sniff("a.PDB", b"hello"), Format::Pdb);
        assert_eq!(sniff("a.xyz", b"caffeine\n"), Format::Xyz);
        assert_eq!(sniff("a.cif", b"# nothing yet\n"), Format::Cif);
        assert_eq!(sniff("a.bcif", b"\x91\x91"), Format::BinaryCif);
        assert_eq!(sniff("a.cube", b"12\n"), Format::Foreign("a Gaussian cube file"));
        assert_eq!(sniff("a.pqr", b"ATOM      1  N   THR"), Format::Pqr);
        assert_eq!(sniff("a.sdf", b"2244\n\n\n  1  0\n"), Format::Sdf);
        assert_eq!(sniff("a.docx", b"hello"), Format::Unknown);
        assert_eq!(sniff("", b""), Format::Unknown);
    }
}
