//! MOL2 files [Mol2, throughout]: sections of atoms, bonds and substructures, by words; several molecules are models.
//!
//! Sections are delimited, so that a count that is too small is mended; one that is too large tells of a file cut short
//! and is refused. Elements come from SYBYL types (`C.ar`), else, with the types of force fields (`ca`), from the atom's
//! name. A substructure `ALA12` is residue 12 of name ALA. Orders: `am`, `du` and `un` are drawn single, `ar` single and
//! double in turn, `nc` not at all.

use super::Import;
use super::lines::{Lines, quote};
use super::models::Models;
use super::number;
use super::table::{Table, TableAtom, TableBond, TableOrder, count_error, no_atoms, row_error, words};
use crate::scene::builder::MoleculeBuilder;
use crate::scene::element::Element;
use crate::scene::error::SceneError;
use crate::scene::guess::{from_xyz_symbol, residue_kind};
use crate::scene::molecule::{Molecule, ResidueKind};
use crate::scene::name::Name;
use crate::scene::report::NoteKind;
use std::collections::HashMap;

/// What a section's first line begins with.
const MARK: &[u8] = b"@<TRIPOS>";

/// A section of the file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Molecule,
    Atom,
    Bond,
    Substructure,
    Other,
}

/// One molecule while it is read.
#[derive(Default)]
struct Draft {
    table: Table,
    /// Line of the counts, and the counts of atoms and bonds as far as there are any.
    counts: Option<(u32, [Option<i64>; 2])>,
    /// Lines of the section so far.
    num_lines: u32,
    num_bonds: usize,
    /// The substructure of each atom.
    substructures: Vec<i64>,
    /// The chain of each substructure that has one.
    chains: HashMap<i64, Name>,
}

/// Reads all wanted molecules.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Molecule, SceneError> {
    let (mut builder, mut file_bonds) = (MoleculeBuilder::default(), Vec::new());
    let mut models = Models::new(import.options.model);
    let mut section = Section::Other;
    let mut draft = Draft::default();
    // Number of the molecule that is being read, while it is wanted or not known to be unwanted.
    let mut model = None;
    let mut lines = Lines::new(bytes);
    while let Some((number, line)) = lines.next() {
        if let Some(name) = line.strip_prefix(MARK) {
            section = match name.trim_ascii() {
                b"MOLECULE" => Section::Molecule,
                b"ATOM" => Section::Atom,
                b"BOND" => Section::Bond,
                b"SUBSTRUCTURE" => Section::Substructure,
                _ => Section::Other,
            };
            draft.num_lines = 0;
            if section == Section::Molecule {
                finish(import, std::mem::take(&mut draft), model.take(), &mut builder, &mut file_bonds)?;
                models.begin(None);
            }
            continue;
        }
        draft.num_lines = draft.num_lines.saturating_add(1);
        // In the first section lines count, blank or not.
        if section == Section::Molecule {
            if draft.num_lines == 2 {
                let mut counts = words(line).map(number::integer);
                draft.counts = Some((number, [counts.next().flatten(), counts.next().flatten()]));
            }
            continue;
        }
        let is_comment = line.starts_with(b"#") || line.trim_ascii().is_empty();
        if is_comment || section == Section::Other {
            continue;
        }
        // The first atom tells whether the molecule is a model, and a wanted one.
        if section == Section::Atom && model.is_none() {
            model = models.atom();
        }
        if model.is_none() {
            continue;
        }
        match section {
            Section::Atom => read_atom(import, number, line, &mut draft, lines.clone().next().is_none())?,
            Section::Bond => read_bond(import, number, line, &mut draft)?,
            _ => read_chain(line, &mut draft),
        }
    }
    finish(import, draft, model, &mut builder, &mut file_bonds)?;
    if let Some(error) = models.missing(import.file) {
        return Err(error);
    }
    import.report.note_many(NoteKind::ModelSkipped, models.num_skipped(), String::new);
    let molecule = builder.finish(&file_bonds, &mut import.report);
    molecule.ok_or_else(|| no_atoms(import, "it has no section @<TRIPOS>ATOM with lines in it"))
}

/// Checks a molecule's counts and hands it on, if it is drawn.
fn finish(
    import: &mut Import<'_>,
    mut draft: Draft,
    model: Option<u32>,
    builder: &mut MoleculeBuilder,
    file_bonds: &mut Vec<crate::scene::bonds::FileBond>,
) -> Result<(), SceneError> {
    let Some(model) = model else { return Ok(()) };
    if let Some((line, announced)) = draft.counts {
        for (announced, what, found) in
            [(announced[0], "atoms", draft.table.atoms.len()), (announced[1], "bonds", draft.num_bonds)]
        {
            match announced {
                Some(announced) if announced > found as i64 => {
                    return Err(count_error(import, line, announced, what, found));
                }
                Some(announced) if announced < found as i64 => {
                    import
                        .report
                        .note(NoteKind::CountMended, line, || format!("{announced} {what} announced, {found} found"));
                }
                _ => {}
            }
        }
    }
    for (atom, substructure) in draft.table.atoms.iter_mut().zip(&draft.substructures) {
        atom.chain = draft.chains.get(substructure).copied().unwrap_or_default();
    }
    draft.table.push(import, model, builder, file_bonds);
    Ok(())
}

/// Reads an atom: number, name, x, y, z, type, and perhaps number and name of its substructure and its charge.
fn read_atom(
    import: &mut Import<'_>,
    line: u32,
    text: &[u8],
    draft: &mut Draft,
    is_last_line: bool,
) -> Result<(), SceneError> {
    let mut words = words(text);
    let number = words.next().and_then(number::integer).and_then(|number| u32::try_from(number).ok());
    let fields = [words.next(), words.next(), words.next(), words.next(), words.next()];
    let (Some(number), [Some(name), Some(x), Some(y), Some(z), Some(atom_type)]) = (number, fields) else {
        let way_out = "write its number, name, x, y, z and type";
        // The last line of a file that was cut.
        if let Some((counts, [Some(announced), _])) = draft.counts
            && announced > draft.table.atoms.len() as i64
            && is_last_line
        {
            return Err(count_error(import, counts, announced, "atoms", draft.table.atoms.len()));
        }
        return Err(row_error(import, line, text, "an atom", way_out));
    };
    let substructure = words.next().and_then(number::integer).unwrap_or(0);
    let label = words.next().unwrap_or_default();
    let charge = words.next().and_then(number::float).filter(|charge| charge.is_finite()).unwrap_or(0.0);
    let (residue_name, residue_number) = residue(label, substructure);
    let element = element(atom_type, name, residue_name);
    let (element, kind) = match element {
        Some((element, is_guessed)) => (element, is_guessed.then_some(NoteKind::ElementGuessed)),
        None => (Element::UNKNOWN, Some(NoteKind::ElementUnknown)),
    };
    if let Some(kind) = kind {
        let is_unknown = kind == NoteKind::ElementUnknown;
        import.report.note(kind, line, || if is_unknown { quote(atom_type) } else { String::new() });
    }
    let is_polymer = matches!(residue_kind(residue_name.as_str(), None), ResidueKind::Protein | ResidueKind::Nucleic);
    draft.table.atoms.push(TableAtom {
        number,
        position: import.position(line, [x, y, z])?,
        element,
        name: Name::new(name),
        charge: charge as f32,
        residue_name,
        residue_number,
        chain: Name::default(),
        is_hetero: !is_polymer,
    });
    draft.substructures.push(substructure);
    Ok(())
}

/// Name and number of a residue, from `ALA12` and the substructure's own number, which stands in where there is no other.
fn residue(label: &[u8], substructure: i64) -> (Name, i32) {
    let label = if label == b"****" { b"" } else { label };
    let own = i32::try_from(substructure).unwrap_or(0);
    let num_digits = label.iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
    let (mut name, mut digits) = label.split_at(label.len() - num_digits);
    let is_polymer = |name: &[u8]| {
        let kind = residue_kind(Name::new(name).as_str(), None);
        matches!(kind, ResidueKind::Protein | ResidueKind::Nucleic | ResidueKind::Water)
    };
    // Digits may be part of the name: SO4, SO41.
    if name.len() < 3 && !is_polymer(name) {
        (name, digits) = label.split_at(label.len().min(3));
    }
    match number::integer(digits).and_then(|number| i32::try_from(number).ok()) {
        Some(number) => (Name::new(name), number),
        None => (Name::new(label), own),
    }
}

/// The element of a type or, failing that, of a name, and whether it is a guess.
fn element(atom_type: &[u8], name: &[u8], residue: Name) -> Option<(Element, bool)> {
    let symbol = atom_type.split(|&byte| byte == b'.').next().unwrap_or_default();
    let is_spelled_right = |symbol: &[u8]| {
        symbol.first().is_some_and(u8::is_ascii_uppercase) && symbol.iter().skip(1).all(u8::is_ascii_lowercase)
    };
    if let Some(element) = Element::from_symbol(symbol).filter(|_| is_spelled_right(symbol)) {
        return Some((element, false));
    }
    // SYBYL's own words for what is no element.
    if [&b"Du"[..], b"LP", b"Any", b"Hal", b"Het", b"Hev"].contains(&symbol) {
        return None;
    }
    let guess = |element: Element| Some((element, true));
    let letters = name.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
    let letters = &name[..letters];
    let is_ion = letters.eq_ignore_ascii_case(residue.as_str().as_bytes());
    if let Some(element) = Element::from_symbol(letters).filter(|_| is_spelled_right(letters) || is_ion) {
        return guess(element);
    }
    for halogen in [b"CL", b"BR"] {
        let starts = |text: &[u8]| text.get(..2).is_some_and(|start| start.eq_ignore_ascii_case(halogen));
        if starts(symbol) && starts(name) {
            return Element::from_symbol(halogen).map(|element| (element, true));
        }
    }
    // Digits may come first: 1HB2.
    let first = name.iter().copied().find(u8::is_ascii_alphabetic)?;
    match first.to_ascii_uppercase() {
        letter @ (b'H' | b'C' | b'N' | b'O' | b'F' | b'P' | b'S' | b'B' | b'I') => {
            Element::from_symbol(&[letter]).and_then(guess)
        }
        _ => Some(from_xyz_symbol(name)).filter(|element| element.is_known()).and_then(guess),
    }
}

/// Reads a bond: number, two atoms, type.
fn read_bond(import: &Import<'_>, line: u32, text: &[u8], draft: &mut Draft) -> Result<(), SceneError> {
    let mut words = words(text).skip(1);
    let mut end = || Some(u32::try_from(number::integer(words.next()?)?).unwrap_or(u32::MAX));
    let (Some(a), Some(b)) = (end(), end()) else {
        return Err(row_error(
            import,
            line,
            text,
            "a bond",
            "write its number, the numbers of two atoms, and its type",
        ));
    };
    draft.num_bonds += 1;
    let order = match words.next().unwrap_or(b"1") {
        b"2" => TableOrder::Fixed(2),
        b"3" => TableOrder::Fixed(3),
        b"ar" => TableOrder::Aromatic,
        b"nc" => return Ok(()),
        _ => TableOrder::Fixed(1),
    };
    draft.table.bonds.push(TableBond { line, ends: [a, b], order });
    Ok(())
}

/// Reads the chain of a substructure: number, name, root atom, type, dictionary, chain.
fn read_chain(text: &[u8], draft: &mut Draft) {
    let mut words = words(text);
    let number = words.next().and_then(number::integer);
    let chain = words.nth(4).filter(|chain| !chain.starts_with(b"*"));
    if let (Some(number), Some(chain)) = (number, chain) {
        draft.chains.insert(number, Name::new(chain));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{LoadOptions, ModelChoice, Scene};

    fn load(text: &str, model: ModelChoice) -> Result<Scene, SceneError> {
        Scene::from_bytes_with("t.mol2", text.as_bytes(), &LoadOptions { model, ..LoadOptions::default() })
    }

    const BENZAMIDE: &str = "# remark\n@<TRIPOS>MOLECULE\nbenz\n 4 3 1\nSMALL\nUSER_CHARGES\n\n@<TRIPOS>ATOM
  1 C1  0.0 0.0 0.0 C.2  7 BZA7  0.5
  2 O1  1.2 0.0 0.0 O.2  7 BZA7 -0.5
  3 N1 -0.7 1.1 0.0 N.am 7 BZA7  0.0
  4 Zn  5.0 0.0 0.0 Du   8 **** 2.0
@<TRIPOS>BOND\n 1 1 2 2\n 2 1 3 am\n 3 1 4 nc\n@<TRIPOS>SUBSTRUCTURE\n 7 BZA7 1 GROUP 0 B ****\n";

    #[test]
    fn sections_residues_chains_and_charges_are_read() {
        let scene = load(BENZAMIDE, ModelChoice::First).expect("a scene");
        let molecule = &scene.molecule;
        let bonds: Vec<_> = molecule.bonds.iter().map(|bond| (bond.a, bond.b, bond.order)).collect();
        assert_eq!(bonds, [(0, 1, 2), (0, 2, 1)]);
        let residue = molecule.residues[0];
        assert_eq!((residue.name.as_str(), residue.number, molecule.chain(&molecule.atoms[0])), ("BZA", 7, "B"));
        assert_eq!((molecule.atoms[1].charge, molecule.atoms[3].element), (-0.5, Element::UNKNOWN));
        assert_eq!(scene.files[0].report.count(NoteKind::ElementUnknown), 1);
    }

    #[test]
    fn molecules_are_models() {
        let text = BENZAMIDE.to_string() + "@<TRIPOS>MOLECULE\nempty\n0 0\n" + BENZAMIDE;
        let scene = load(&text, ModelChoice::First).expect("a scene");
        assert_eq!((scene.molecule.atoms.len(), scene.files[0].report.count(NoteKind::ModelSkipped)), (4, 1));
        assert_eq!(load(&text, ModelChoice::All).expect("both").molecule.bonds.len(), 4);
        assert!(load(&text, ModelChoice::Number(5)).is_err());
    }

    #[test]
    fn counts_are_mended_or_refused() {
        let few = load(&BENZAMIDE.replace(" 4 3 1", "2 1"), ModelChoice::First).expect("mended");
        assert_eq!((few.molecule.atoms.len(), few.files[0].report.count(NoteKind::CountMended)), (4, 2));
        assert!(load(&BENZAMIDE.replace(" 4 3 1", "x"), ModelChoice::First).is_ok());
        let error = load(&BENZAMIDE.replace(" 4 3 1", "9 3"), ModelChoice::First).expect_err("cut short").to_string();
        assert_eq!(
            error,
            "t.mol2:4: announces 9 atoms, but 4 follow; write 4 if they are all, else the file was cut short"
        );
        let error = load(&BENZAMIDE.replace("Zn  5.0 0.0 0.0 Du   8 **** 2.0", "Zn  5.0"), ModelChoice::First)
            .expect_err("damaged")
            .to_string();
        assert!(error.starts_with("t.mol2:12: found \"4 Zn  5.0\" where an atom belongs"), "{error}");
        assert!(
            load("@<TRIPOS>MOLECULE\n", ModelChoice::First).expect_err("empty").to_string().contains("@<TRIPOS>ATOM")
        );
    }

    #[test]
    fn elements_come_from_types_or_names() {
        let symbol = |atom_type: &str, name: &str, residue: &str| {
            let residue = Name::new(residue.as_bytes());
            element(atom_type.as_bytes(), name.as_bytes(), residue).map_or("X", |(element, _)| element.symbol())
        };
        for (atom_type, name, residue, expected) in [
            ("C.ar", "X1", "LIG", "C"),
            ("Ca", "CA", "CA", "Ca"),
            ("ca", "CA", "LIG", "C"),
            ("cl", "CL1", "LIG", "Cl"),
            ("cl", "C11", "LIG", "C"),
            ("opls_404", "Li", "RES", "Li"),
            ("CT", "CA", "ALA", "C"),
            ("HC", "1HB2", "ALA", "H"),
            ("IM", "ZN", "ZN", "Zn"),
            ("Co.oh", "CO", "LIG", "Co"),
            ("Du", "C1", "LIG", "X"),
            ("LP", "LP1", "LIG", "X"),
        ] {
            assert_eq!(symbol(atom_type, name, residue), expected, "{atom_type} {name} {residue}");
        }
    }

    #[test]
    fn residues_keep_digits_of_their_names() {
        for (label, name, number) in [
            ("ALA12", "ALA", 12),
            ("SO4", "SO4", 5),
            ("SO41", "SO4", 1),
            ("A7", "A", 7),
            ("DG12", "DG", 12),
            ("LIG", "LIG", 5),
            ("****", "", 5),
            ("HOH301", "HOH", 301),
            ("<0>", "<0>", 5),
        ] {
            assert_eq!(residue(label.as_bytes(), 5), (Name::new(name.as_bytes()), number), "{label}");
        }
    }
}
