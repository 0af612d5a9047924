//! PDB files: fixed columns, thirty years of habits.
//!
//! Columns after [PdbFormat 3.3]; counted from 0 here. Read as bytes: remarks may be in any encoding. Tolerated and
//! noted: lower case, lines cut short, blank or unreadable coordinates, missing or wrong elements, residue numbers and
//! serials past their columns (hybrid-36, or one more digit), `MODEL` without `ENDMDL`. Atoms after `END` or `ENDMDL`
//! without a new `MODEL` are the next model, as trajectories are written.
//!
//! Not read: `ANISOU`, secondary structure.

use super::Import;
use super::assembly::Remarks;
use super::conect::{Conect, SerialPlace};
use super::lines::{Lines, quote};
use super::models::Models;
use super::number;
use crate::scene::builder::{MoleculeBuilder, NewAtom};
use crate::scene::element::Element;
use crate::scene::error::SceneError;
use crate::scene::guess::from_pdb_name;
use crate::scene::molecule::Molecule;
use crate::scene::name::Name;
use crate::scene::report::{NoteKind, Report};

/// A serial number that could not be read.
const NO_SERIAL: u32 = u32::MAX;
/// Where the coordinates end.
const COORDINATES_END: usize = 54;

/// What a line is for.
enum Record {
    Atom { is_hetero: bool, is_lower_case: bool },
    Conect,
    Remark,
    Model,
    EndOfModel,
    Other,
}

/// How a model was opened.
#[derive(PartialEq, Eq)]
enum ModelState {
    /// Nothing has been read yet.
    None,
    /// By a `MODEL` record.
    Explicit,
    /// By an atom.
    Implicit,
    /// Closed by `ENDMDL` or `END`.
    Closed,
}

/// Reads all wanted models.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Molecule, SceneError> {
    let mut builder = MoleculeBuilder::default();
    let mut models = Models::new(import.options.model);
    let mut conect = Conect::default();
    let mut remarks = import.options.assembly.as_ref().map(|_| Remarks::default());
    // One serial and model per atom in the builder.
    let mut serials: Vec<(u32, u32)> = Vec::new();
    let mut state = ModelState::None;
    let mut last_line = 0;
    for (number, line) in Lines::new(bytes) {
        last_line = number;
        match record(line) {
            Record::Atom { is_hetero, is_lower_case } => {
                if matches!(state, ModelState::None | ModelState::Closed) {
                    if state == ModelState::Closed {
                        import
                            .report
                            .note(NoteKind::ModelMended, number, || "atoms after the end of a model".to_string());
                    }
                    models.begin(None);
                    state = ModelState::Implicit;
                }
                let Some(model) = models.atom() else { continue };
                if is_lower_case {
                    import.report.note(NoteKind::LowerCase, number, String::new);
                }
                if let Some(atom) = read_atom(import, number, line, model, is_hetero, is_lower_case)? {
                    builder.push(&atom);
                    serials.push((read_serial(line), model));
                }
            }
            Record::Conect => conect.add(number, line, &mut import.report),
            Record::Remark => {
                if let Some(remarks) = &mut remarks {
                    remarks.add(import, number, line)?;
                }
            }
            Record::Model => {
                if matches!(state, ModelState::Explicit | ModelState::Implicit) {
                    import
                        .report
                        .note(NoteKind::ModelMended, number, || "MODEL before the end of the last one".to_string());
                }
                let model = number::integer(line.get(5..14.min(line.len())).unwrap_or_default());
                models.begin(model.and_then(|model| u32::try_from(model).ok()));
                state = ModelState::Explicit;
            }
            Record::EndOfModel => {
                if state != ModelState::None {
                    state = ModelState::Closed;
                }
            }
            Record::Other => {}
        }
    }
    if state == ModelState::Explicit {
        import.report.note(NoteKind::ModelMended, last_line, || "the file ends within a model".to_string());
    }
    if let Some(error) = models.missing(import.file) {
        return Err(error);
    }
    import.report.note_many(NoteKind::ModelSkipped, models.num_skipped(), String::new);
    note_duplicates(&serials, &mut import.report);
    let bonds = if conect.is_empty() {
        Vec::new()
    } else {
        let wanted = conect.serials();
        let is_wanted = |serial: &u32| wanted.binary_search(serial).is_ok();
        let places = (0..).zip(&serials).filter(|(_, (serial, _))| is_wanted(serial));
        let places = places.map(|(atom, &(serial, model))| SerialPlace { serial, model, atom }).collect();
        conect.resolve(places, models.num_skipped() == 0, &mut import.report)
    };
    drop(serials);
    if let (Some(remarks), false) = (remarks, builder.is_empty()) {
        let copies = remarks.copies(import, &builder)?;
        builder.set_copies(copies);
    }
    builder.finish(&bonds, &mut import.report).ok_or_else(|| no_atoms(import))
}

/// The error of a file without atoms that can be drawn.
fn no_atoms(import: &Import<'_>) -> SceneError {
    let hint = if import.report.is_empty() {
        "no line begins with ATOM or HETATM: download the whole entry".to_string()
    } else {
        format!("every atom line is damaged: {}", import.report.to_string().trim_end().replace('\n', "; "))
    };
    SceneError::NoAtoms { file: import.file.to_string(), hint }
}

/// What a line is for, by its first columns in any case.
fn record(line: &[u8]) -> Record {
    let Some(first) = line.first() else {
        return Record::Other;
    };
    let starts = |name: &[u8]| line.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
    // Names of six letters may be followed by a full column (HETATMA0000, CONECT1000110002), shorter ones may not.
    let is = |name: &[u8]| {
        let next = line.get(name.len());
        starts(name) && next.is_none_or(|next| next.is_ascii_whitespace() || next.is_ascii_digit())
    };
    let is_lower_case = first.is_ascii_lowercase();
    match first.to_ascii_uppercase() {
        b'A' if is(b"ATOM") => Record::Atom { is_hetero: false, is_lower_case },
        b'H' if starts(b"HETATM") => Record::Atom { is_hetero: true, is_lower_case },
        b'C' if starts(b"CONECT") => Record::Conect,
        b'R' if starts(b"REMARK") => Record::Remark,
        b'M' if is(b"MODEL") => Record::Model,
        b'E' if is(b"ENDMDL") || is(b"END") => Record::EndOfModel,
        _ => Record::Other,
    }
}

/// The columns from `start` to `end`, or what the line has of them.
fn columns(line: &[u8], start: usize, end: usize) -> &[u8] {
    &line[start.min(line.len())..end.min(line.len())]
}

/// One column, a space past the line's end.
fn column(line: &[u8], index: usize) -> u8 {
    line.get(index).copied().unwrap_or(b' ')
}

/// A letter, or 0 for a space.
fn letter(byte: u8) -> u8 {
    if byte.is_ascii_graphic() { byte } else { 0 }
}

/// The serial number; a sixth digit uses the blank column after it.
fn read_serial(line: &[u8]) -> u32 {
    let end = if column(line, 11).is_ascii_digit() { 12 } else { 11 };
    number::serial(columns(line, 6, end)).unwrap_or(NO_SERIAL)
}

/// One atom, or `None` with a note if its position is unusable.
fn read_atom<'a>(
    import: &mut Import<'_>,
    number: u32,
    line: &'a [u8],
    model: u32,
    is_hetero: bool,
    is_lower_case: bool,
) -> Result<Option<NewAtom<'a>>, SceneError> {
    if line.len() < COORDINATES_END && !columns(line, 46, COORDINATES_END).trim_ascii().is_empty() || line.len() <= 46 {
        import.report.note(NoteKind::ShortLine, number, String::new);
        return Ok(None);
    }
    let fields = [columns(line, 30, 38), columns(line, 38, 46), columns(line, 46, COORDINATES_END)];
    let Some(position) = import.position(number, fields)? else {
        return Ok(None);
    };
    let label = |bytes: &[u8]| {
        if is_lower_case { Name::new(bytes).to_uppercase() } else { Name::new(bytes) }
    };
    let name = label(columns(line, 12, 16));
    let residue_name = label(columns(line, 17, 21));
    let (residue_number, insertion_code) = residue_number(import, number, line);
    let occupancy = number::float(columns(line, 54, 60)).filter(|value| value.is_finite()).unwrap_or(1.0);
    let element = read_element(import, number, line, residue_name);
    Ok(Some(NewAtom {
        position,
        element,
        name,
        alt_loc: letter(column(line, 16)),
        occupancy: occupancy as f32,
        residue_name,
        residue_number,
        insertion_code,
        is_hetero,
        chain: chain(line),
        model,
        b_factor: number::float(columns(line, 60, 66)).filter(|value| value.is_finite()).unwrap_or(0.0) as f32,
        charge: charge(columns(line, 78, 80)),
    }))
}

/// The charge of columns 79 and 80: a digit and its sign, in either order. Old files number their lines there.
fn charge(field: &[u8]) -> f32 {
    match field {
        [digit @ b'0'..=b'9', sign @ (b'+' | b'-')] | [sign @ (b'+' | b'-'), digit @ b'0'..=b'9'] => {
            let charge = f32::from(digit - b'0');
            if *sign == b'-' { -charge } else { charge }
        }
        _ => 0.0,
    }
}

/// The chain's letter; where there is none, the segment that simulation programs write behind the temperature factor.
fn chain(line: &[u8]) -> &[u8] {
    match columns(line, 21, 22).trim_ascii() {
        // Old files number their lines here (1CRN  70): a digit where the element belongs tells.
        [] if !columns(line, 76, 80).iter().any(u8::is_ascii_digit) => columns(line, 72, 76).trim_ascii(),
        chain => chain,
    }
}

/// Residue number and insertion code; a fifth digit takes the place of the code.
fn residue_number(import: &mut Import<'_>, number: u32, line: &[u8]) -> (i32, u8) {
    let is_wide = column(line, 26).is_ascii_digit();
    let field = columns(line, 22, if is_wide { 27 } else { 26 });
    let insertion_code = if is_wide { 0 } else { letter(column(line, 26)) };
    let parsed = number::hybrid36(field).and_then(|value| i32::try_from(value).ok());
    if parsed.is_none() && !field.trim_ascii().is_empty() {
        import.report.note(NoteKind::BadResidueNumber, number, || quote(field));
    }
    (parsed.unwrap_or(0), insertion_code)
}

/// The element of columns 77 and 78, else the one that the name suggests.
fn read_element(import: &mut Import<'_>, number: u32, line: &[u8], residue_name: Name) -> Element {
    let field = columns(line, 76, 78).trim_ascii();
    if let Some(element) = Element::from_symbol(field) {
        return element;
    }
    let mut name = [b' '; 4];
    name.iter_mut().zip(columns(line, 12, 16)).for_each(|(to, &from)| *to = from);
    let element = from_pdb_name(name, residue_name.as_str());
    let kind = match (element.is_known(), field) {
        (false, _) => NoteKind::ElementUnknown,
        (true, []) => NoteKind::ElementGuessed,
        (true, _) => NoteKind::ElementCorrected,
    };
    import.report.note(kind, number, || match kind {
        NoteKind::ElementGuessed => String::new(),
        NoteKind::ElementCorrected => format!("{} taken as {}", quote(field), element.symbol()),
        _ => quote(&name),
    });
    element
}

/// Notes serial numbers that occur twice in one model.
fn note_duplicates(serials: &[(u32, u32)], report: &mut Report) {
    let key = |&(serial, model): &(u32, u32)| (model, serial);
    if serials.windows(2).all(|pair| key(&pair[0]) < key(&pair[1])) {
        return;
    }
    let mut sorted: Vec<(u32, u32)> = serials.iter().filter(|&&(serial, _)| serial != NO_SERIAL).map(key).collect();
    sorted.sort_unstable();
    let count: usize = sorted.chunk_by(|a, b| a == b).map(|group| if group.len() > 1 { group.len() } else { 0 }).sum();
    report.note_many(NoteKind::DuplicateSerial, count as u32, String::new);
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, ModelChoice, NoteKind, Scene, SceneError};

    fn load(text: &str, model: ModelChoice) -> Result<Scene, SceneError> {
        Scene::from_bytes_with("t.pdb", text.as_bytes(), &LoadOptions { model, ..LoadOptions::default() })
    }

    fn first(text: &str) -> Scene {
        load(text, ModelChoice::First).expect("a scene")
    }

    /// An atom line of element C in residue LIG.
    fn atom(serial: &str, x: f64) -> String {
        format!("HETATM{serial:>5}  C1  LIG A   1    {x:>8.3}   0.000   0.000  1.00  0.00           C\n")
    }

    #[test]
    fn serials_past_99999_find_their_bonds() {
        let text = format!("{}{}CONECT99999A0000A0000\n", atom("99999", 0.0), atom("A0000", 1.4));
        assert_eq!(first(&text).molecule.bonds[0].order, 2);
    }

    #[test]
    fn frames_that_end_with_end_are_models() {
        let text = format!("{}END\n{}END\n", atom("1", 0.0), atom("1", 1.4));
        let scene = first(&text);
        assert_eq!(scene.molecule.atoms.len(), 1);
        assert_eq!(scene.files[0].report.count(NoteKind::ModelSkipped), 1);
        let all = load(&text, ModelChoice::All).expect("both frames").molecule;
        assert_eq!((all.atoms.len(), all.bonds.len()), (2, 0));
        let second = load(&text, ModelChoice::Number(2)).expect("the second frame").molecule;
        assert_eq!(second.residues[0].model, 2);
    }

    #[test]
    fn absurd_coordinates_are_refused_with_their_line() {
        let text = atom("1", 0.0) + &atom("2", 0.0).replacen("   0.000", "    1e31", 1);
        let message = load(&text, ModelChoice::First).expect_err("absurd").to_string();
        assert_eq!(message, "t.pdb:2: x = \"1e31\" is no position in angstrom; correct it or delete the line");
    }

    #[test]
    fn damaged_files_say_what_was_wrong_with_every_atom() {
        let text = atom("1", 0.0).replacen("   0.000", "********", 1);
        let message = load(&text, ModelChoice::First).expect_err("no atom").to_string();
        assert!(message.contains("holds no atoms; every atom line is damaged: 1 atom skipped"));
    }

    #[test]
    fn numbers_may_overflow_their_columns() {
        let text = "ATOM  100000 CA  ALA A10000    ".to_string() + &atom("1", 0.0)[31..];
        let scene = first(&text);
        assert_eq!(scene.molecule.residues[0].number, 10_000);
        assert_eq!(scene.molecule.residues[0].insertion_code, 0);
        let hybrid = first(&atom("1", 0.0).replace("A   1 ", "AA00AB"));
        let residue = hybrid.molecule.residues[0];
        assert_eq!((residue.number, residue.insertion_code), (10_010, b'B'));
    }

    #[test]
    fn formal_charges_have_a_sign() {
        let charge = |columns: &str| {
            let text = atom("1", 0.0).replace(" C\n", &format!(" C{columns}\n"));
            first(&text).molecule.atoms[0].charge
        };
        assert_eq!(["2+", "1-", "-1", "70", " ", "", "++"].map(charge), [2.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn segments_name_chains_that_have_no_letter() {
        let line = atom("1", 0.0).replace(" A   1", "     1");
        let with_segment = line.replace("          C\n", "     PROT C\n");
        assert_eq!(first(&with_segment).molecule.chains[0].id, "PROT");
        let old = line.replace("          C\n", "     1CRN  70\n");
        assert_eq!(first(&old).molecule.chains[0].id, "");
    }
}
