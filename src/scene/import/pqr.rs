//! PQR files: the atoms of a PDB file by words, with charge and radius [Apbs, PQR].
//!
//! `ATOM serial name residue [chain] number x y z charge radius`. A chain may be written together with the number
//! (`A1000`); where columns run into each other, those of PDB files are tried. Elements are guessed from names, as the
//! format has none; radii are ignored. `MODEL` and `ENDMDL` separate models as in PDB files.

use super::Import;
use super::lines::{Lines, quote};
use super::models::Models;
use super::number;
use super::table::{no_atoms, row_error, words};
use crate::scene::builder::{MoleculeBuilder, NewAtom};
use crate::scene::element::Element;
use crate::scene::error::SceneError;
use crate::scene::guess::from_pdb_name;
use crate::scene::molecule::Molecule;
use crate::scene::name::Name;
use crate::scene::report::NoteKind;

/// Reads all wanted models.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Molecule, SceneError> {
    let mut builder = MoleculeBuilder::default();
    let mut models = Models::new(import.options.model);
    let mut is_open = false;
    for (number, line) in Lines::new(bytes) {
        let is_hetero = match words(line).next().unwrap_or_default() {
            b"ATOM" => false,
            // The number may follow without a space.
            word if word.starts_with(b"HETATM") => true,
            b"MODEL" => {
                let model = words(line).nth(1).and_then(number::integer);
                models.begin(model.and_then(|model| u32::try_from(model).ok()));
                is_open = true;
                continue;
            }
            b"ENDMDL" | b"END" => {
                is_open = false;
                continue;
            }
            _ => continue,
        };
        if !std::mem::replace(&mut is_open, true) {
            models.begin(None);
        }
        let Some(model) = models.atom() else { continue };
        let Some(fields) = by_words(line).or_else(|| by_columns(line)) else {
            let way_out = "write ATOM, serial number, name, residue, chain, residue number, x, y, z, charge and radius";
            return Err(row_error(import, number, line, "an atom", way_out));
        };
        let Some(position) = import.position(number, fields.position)? else { continue };
        let element = element(fields.name, fields.residue);
        if !element.is_known() {
            import.report.note(NoteKind::ElementUnknown, number, || quote(fields.name));
        }
        builder.push(&NewAtom {
            position,
            element,
            name: Name::new(fields.name),
            alt_loc: 0,
            occupancy: 1.0,
            residue_name: Name::new(fields.residue),
            residue_number: fields.number,
            insertion_code: fields.insertion_code,
            is_hetero,
            chain: fields.chain,
            model,
            b_factor: 0.0,
            charge: fields.charge,
        });
    }
    if let Some(error) = models.missing(import.file) {
        return Err(error);
    }
    import.report.note_many(NoteKind::ModelSkipped, models.num_skipped(), String::new);
    builder.finish(&[], &mut import.report).ok_or_else(|| no_atoms(import, "no line begins with ATOM or HETATM"))
}

/// What an atom's line says.
struct Fields<'a> {
    name: &'a [u8],
    residue: &'a [u8],
    chain: &'a [u8],
    number: i32,
    insertion_code: u8,
    position: [&'a [u8]; 3],
    charge: f32,
}

/// The fields of a line with ten words, or eleven with a chain; one fewer where `HETATM` and number are one word.
fn by_words(line: &[u8]) -> Option<Fields<'_>> {
    let line = line.trim_ascii_start();
    let mut all = words(&line[line.iter().position(u8::is_ascii_digit)?..]);
    let (_serial, name, residue) = (all.next()?, all.next()?, all.next()?);
    let mut rest = [&b""[..]; 7];
    let mut count = 0;
    for word in all {
        *rest.get_mut(count)? = word;
        count += 1;
    }
    let (chain, number, numbers) = match count {
        6 => (None, rest[0], &rest[1..6]),
        7 => (Some(rest[0]), rest[1], &rest[2..7]),
        _ => return None,
    };
    // A letter before the number is the chain.
    let (chain, number) = match chain {
        Some(chain) => (chain, number),
        None => number.split_at(number.iter().take_while(|byte| byte.is_ascii_alphabetic()).count()),
    };
    let (number, insertion_code) = residue_number(number)?;
    let &[x, y, z, charge, radius] = numbers else { return None };
    let charge = number::float(charge).filter(|charge| charge.is_finite())?;
    number::float(radius)?;
    Some(Fields { name, residue, chain, number, insertion_code, position: [x, y, z], charge: charge as f32 })
}

/// The number of a residue and the insertion code after it.
fn residue_number(field: &[u8]) -> Option<(i32, u8)> {
    let (digits, code) = match field {
        [digits @ .., code] if code.is_ascii_alphabetic() => (digits, *code),
        digits => (digits, 0),
    };
    Some((number::integer(digits).and_then(|number| i32::try_from(number).ok())?, code))
}

/// The fields of a line with the columns of a PDB file.
fn by_columns(line: &[u8]) -> Option<Fields<'_>> {
    let columns = |start: usize, end: usize| line.get(start..end.min(line.len())).unwrap_or_default().trim_ascii();
    let position = [columns(30, 38), columns(38, 46), columns(46, 54)];
    if position.iter().any(|field| number::float(field).is_none()) {
        return None;
    }
    let (number, insertion_code) = residue_number(columns(22, 27))?;
    let charge = words(columns(54, line.len())).next().and_then(number::float).filter(|charge| charge.is_finite());
    Some(Fields {
        name: columns(12, 16),
        residue: columns(17, 21),
        chain: columns(21, 22),
        number,
        insertion_code,
        position,
        charge: charge.unwrap_or(0.0) as f32,
    })
}

/// The element of a name that has lost its columns.
fn element(name: &[u8], residue: &[u8]) -> Element {
    let starts = |symbol: &[u8]| name.get(..2).is_some_and(|start| start.eq_ignore_ascii_case(symbol));
    // Else a name of two or three letters begins in the second column, as most do.
    let is_two_letter =
        [&b"CL"[..], b"BR", b"FE", b"ZN", b"MG", b"MN", b"CU", b"NI"].iter().any(|&symbol| starts(symbol));
    let start = usize::from(name.len() < 4 && !is_two_letter);
    let mut columns = [b' '; 4];
    columns[start..].iter_mut().zip(name).for_each(|(to, &from)| *to = from);
    from_pdb_name(columns, &String::from_utf8_lossy(residue))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{LoadOptions, ModelChoice, Scene};

    fn load(text: &str) -> Result<Scene, SceneError> {
        let options = LoadOptions { model: ModelChoice::All, ..LoadOptions::default() };
        Scene::from_bytes_with("t.pqr", text.as_bytes(), &options)
    }

    #[test]
    fn lines_with_and_without_chain_are_read() {
        let text = "REMARK x\nATOM 1 CA ALA 5 1.0 2.0 3.0 -0.25 1.9\nATOM 2 N GLY B 6A 1 2 3 0.5 1.5
ATOM 3 C GLY C1000 1 2 3 0.5 1.5\nHETATM99999 ZN ZN 7 1 2 3 2.0 1.2\nTER\nEND\n";
        let molecule = load(text).expect("a scene").molecule;
        let facts = |index: usize| {
            let atom = &molecule.atoms[index];
            let residue = molecule.residue(atom);
            (atom.element.symbol(), atom.charge, molecule.chain(atom), residue.number, residue.insertion_code)
        };
        assert_eq!(facts(0), ("C", -0.25, "", 5, 0));
        assert_eq!(facts(1), ("N", 0.5, "B", 6, b'A'));
        assert_eq!(facts(2), ("C", 0.5, "C", 1000, 0));
        assert_eq!(facts(3), ("Zn", 2.0, "", 7, 0));
        assert!(molecule.residue(&molecule.atoms[3]).is_hetero);
    }

    #[test]
    fn columns_that_run_into_each_other_are_read_as_in_pdb_files() {
        let text = "ATOM      1  N   MET A   1    -105.123-110.456-120.789 -0.3200 1.8500\n";
        let molecule = load(text).expect("a scene").molecule;
        assert_eq!((molecule.atoms[0].charge, molecule.residues[0].name.as_str()), (-0.32, "MET"));
        assert!((molecule.origin.y + 110.456).abs() < 1e-9);
    }

    #[test]
    fn damaged_lines_are_named() {
        let message = |text: &str| load(text).expect_err("refused").to_string();
        assert!(
            message("ATOM 1 CA ALA 5 1.0 2.0\n")
                .starts_with("t.pqr:1: found \"ATOM 1 CA ALA 5 1.0 2.0\" where an atom")
        );
        assert!(message("REMARK\n").ends_with("no line begins with ATOM or HETATM: export the molecule anew"));
        assert!(message("ATOM 1 CA ALA 5 nan 2.0 1 0 0\n").contains("no line of it can be drawn: 1 atom skipped"));
    }

    #[test]
    fn models_do_not_bond() {
        let text = "MODEL 1\nATOM 1 C L 1 0 0 0 0 1\nENDMDL\nMODEL 2\nATOM 1 C L 1 1.4 0 0 0 1\nENDMDL\n";
        let molecule = load(text).expect("two models").molecule;
        assert_eq!((molecule.atoms.len(), molecule.bonds.len()), (2, 0));
    }
}
