//! SDF and MOL files [CTfile, throughout]: records of a name, two lines of remarks, and a table of atoms and bonds; here version V2000.
//!
//! Each record that has atoms is a model, numbered from 1. Its atoms are called by symbol and number (`C12`), its residue
//! by the first word of its name, so that selectors can tell molecules and atoms apart. Aromatic bonds (type 4) become
//! single and double ones in turn. Charges are those of `M  CHG`, else of the atoms' column. Counts that do not fit the
//! lines are refused: the table has no other marks to go by. Not read: isotopes, stereochemistry, queries, data items.

use super::Import;
use super::lines::{Lines, quote};
use super::models::Models;
use super::number;
use super::sdf_v3000;
use super::table::{Table, TableAtom, TableBond, TableOrder, count_error, no_atoms, row_error, words};
use crate::scene::builder::MoleculeBuilder;
use crate::scene::element::Element;
use crate::scene::error::SceneError;
use crate::scene::guess::{from_xyz_symbol, is_polymer_residue};
use crate::scene::molecule::Molecule;
use crate::scene::name::Name;
use crate::scene::report::NoteKind;

/// The residue of a molecule without name.
const NAMELESS: &[u8] = b"LIG";

/// Reads all wanted records.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Molecule, SceneError> {
    let (mut builder, mut file_bonds) = (MoleculeBuilder::default(), Vec::new());
    let mut models = Models::new(import.options.model);
    let mut lines = Lines::new(bytes);
    while !lines.clone().all(|(_, line)| line.trim_ascii().is_empty()) {
        let name = lines.next().map(|(_, line)| line).unwrap_or_default();
        let Some((number, counts)) = lines.by_ref().nth(2) else {
            import.report.note(NoteKind::TrailingText, None, || quote(name));
            break;
        };
        let is_v3000 = counts.trim_ascii_end().ends_with(b"V3000");
        let table = if is_v3000 { None } else { Some(Counts::read(import, number, counts)?) };
        let has_atoms = table.as_ref().map_or_else(|| sdf_v3000::has_atoms(lines.clone()), |table| table.atoms != 0);
        models.begin(None);
        if let Some(model) = has_atoms.then(|| models.atom()).flatten() {
            let residue = residue_name(name);
            let table = match table {
                Some(counts) => read_table(import, &mut lines, &counts, residue)?,
                None => sdf_v3000::read_table(import, &mut lines, residue)?,
            };
            table.push(import, model, &mut builder, &mut file_bonds);
        }
        lines.by_ref().find(|(_, line)| line.starts_with(b"$$$$"));
    }
    if let Some(error) = models.missing(import.file) {
        return Err(error);
    }
    import.report.note_many(NoteKind::ModelSkipped, models.num_skipped(), String::new);
    let molecule = builder.finish(&file_bonds, &mut import.report);
    molecule.ok_or_else(|| no_atoms(import, "its counts announce none"))
}

/// The residue that a record's name gives; a lone amino acid or nucleotide is none of a chain, nor are its atoms called so.
fn residue_name(name: &[u8]) -> Name {
    let name = Name::new(words(name).next().unwrap_or(NAMELESS));
    if is_polymer_residue(name.as_str()) { Name::new(NAMELESS) } else { name }
}

/// An atom of a table, whose charge may still be told.
pub(super) fn atom(import: &mut Import<'_>, line: u32, number: u32, symbol: &[u8], residue: Name) -> TableAtom {
    let element = Element::from_symbol(symbol).unwrap_or_else(|| from_xyz_symbol(symbol));
    if !element.is_known() {
        import.report.note(NoteKind::ElementUnknown, line, || quote(symbol));
    }
    let mut name = symbol.to_vec();
    name.extend_from_slice(number.to_string().as_bytes());
    TableAtom {
        number,
        position: None,
        element,
        name: Name::new(&name),
        charge: 0.0,
        residue_name: residue,
        residue_number: 1,
        chain: Name::default(),
        is_hetero: true,
    }
}

/// The order of a bond type; none of a hydrogen bond, which is not drawn.
pub(super) fn order(bond_type: i64) -> Option<TableOrder> {
    match bond_type {
        2 | 7 => Some(TableOrder::Fixed(2)),
        3 => Some(TableOrder::Fixed(3)),
        4 => Some(TableOrder::Aromatic),
        10 => None,
        // Single, any, coordination, and what no version knows.
        _ => Some(TableOrder::Fixed(1)),
    }
}

/// What the fourth line of a record announces.
struct Counts {
    line: u32,
    atoms: i64,
    bonds: i64,
    has_atom_lists: bool,
}

impl Counts {
    fn read(import: &Import<'_>, line: u32, text: &[u8]) -> Result<Self, SceneError> {
        let by_columns = || Some([number::integer(columns(text, 0, 3))?, number::integer(columns(text, 3, 6))?]);
        let by_words = || {
            let mut words = words(text).map(number::integer);
            Some([words.next()??, words.next()??])
        };
        let Some([atoms, bonds]) = by_columns().or_else(by_words) else {
            return Err(row_error(
                import,
                line,
                text,
                "the number of atoms and bonds",
                "a record has them in its fourth line: look for a line too many or too few above",
            ));
        };
        for (count, what) in [(atoms, "atoms"), (bonds, "bonds")] {
            if count < 0 {
                let what = format!("the number of {what} is {count}; write how many lines of {what} follow");
                return Err(import.malformed(line, what));
            }
        }
        let has_atom_lists = number::integer(columns(text, 6, 9)).is_some_and(|count| count > 0);
        Ok(Self { line, atoms, bonds, has_atom_lists })
    }
}

/// The columns from `start` to `end`, or what the line has of them.
fn columns(line: &[u8], start: usize, end: usize) -> &[u8] {
    &line[start.min(line.len())..end.min(line.len())]
}

/// Reads a table of version V2000, up to `M  END` or the end of the record.
fn read_table(
    import: &mut Import<'_>,
    lines: &mut Lines<'_>,
    counts: &Counts,
    residue: Name,
) -> Result<Table, SceneError> {
    let mut table = Table::default();
    for row in 1..=counts.atoms {
        let number = u32::try_from(row).unwrap_or(u32::MAX);
        let before = lines.clone();
        let Some((line, text)) = lines.next().filter(|(_, text)| !is_end(text)) else {
            return Err(count_error(import, counts.line, counts.atoms, "atoms", table.atoms.len()));
        };
        let Some(fields) = atom_fields(text) else {
            let is_early_bond = bond_fields(text).is_some() && before.clone().any(|(_, line)| is_end(line));
            return Err(if is_early_bond && table.atoms.len() > 1 {
                count_error(import, counts.line, counts.atoms, "atoms", table.atoms.len())
            } else {
                row_error(import, line, text, "an atom", "write x, y, z and its symbol")
            });
        };
        let mut atom = atom(import, line, number, fields.symbol, residue);
        atom.position = import.position(line, fields.position)?;
        atom.charge = fields.charge;
        table.atoms.push(atom);
    }
    for found in 0..counts.bonds {
        let Some((line, text)) = lines.next().filter(|(_, text)| !is_end(text)) else {
            return Err(count_error(import, counts.line, counts.bonds, "bonds", found as usize));
        };
        let Some([a, b, bond_type]) = bond_fields(text) else {
            let way_out =
                "write the numbers of two atoms and the bond's type, or correct the counts in the fourth line";
            return Err(row_error(import, line, text, "a bond", way_out));
        };
        let end = |end: i64| u32::try_from(end).unwrap_or(0);
        table.bonds.extend(order(bond_type).map(|order| TableBond { line, ends: [end(a), end(b)], order }));
    }
    let more = lines.clone().take_while(|(_, text)| bond_fields(text).is_some()).count();
    if more > 0 && !counts.has_atom_lists {
        return Err(count_error(import, counts.line, counts.bonds, "bonds", counts.bonds as usize + more));
    }
    read_properties(lines, &mut table.atoms);
    Ok(table)
}

/// Whether a table cannot go on here.
fn is_end(line: &[u8]) -> bool {
    line.starts_with(b"M  ") || line.starts_with(b"$$$$") || line.trim_ascii().is_empty()
}

/// What is read of an atom's line.
struct AtomFields<'a> {
    position: [&'a [u8]; 3],
    symbol: &'a [u8],
    charge: f32,
}

/// The fields of an atom's line by columns, else by words; none if it is no atom.
fn atom_fields(line: &[u8]) -> Option<AtomFields<'_>> {
    let is_atom = |position: [&[u8]; 3], symbol: &[u8]| {
        position.iter().all(|field| number::float(field).is_some() || field.iter().all(|&byte| byte == b'*'))
            && symbol.first().is_some_and(|byte| !byte.is_ascii_digit())
    };
    let position = [columns(line, 0, 10), columns(line, 10, 20), columns(line, 20, 30)].map(<[u8]>::trim_ascii);
    let symbol = columns(line, 30, 34).trim_ascii();
    if position.iter().all(|field| !field.is_empty()) && is_atom(position, symbol) {
        return Some(AtomFields { position, symbol, charge: charge(columns(line, 36, 39)) });
    }
    let mut words = words(line);
    let position = [words.next()?, words.next()?, words.next()?];
    let symbol = words.next()?;
    is_atom(position, symbol).then(|| AtomFields { position, symbol, charge: charge(words.nth(1).unwrap_or_default()) })
}

/// The charge that the atom's column means: 1 to 3 are positive, 5 to 7 negative, 4 is a radical.
fn charge(field: &[u8]) -> f32 {
    match number::integer(field) {
        Some(code @ (1..=3 | 5..=7)) => (4 - code) as f32,
        _ => 0.0,
    }
}

/// Two atoms and the type of a bond's line, by columns, else by words; none if it is no bond.
fn bond_fields(line: &[u8]) -> Option<[i64; 3]> {
    let field = |start: usize| number::integer(columns(line, start, start + 3));
    let by_columns = || Some([field(0)?, field(3)?, field(6)?]);
    let by_words = || {
        let mut words = words(line).map(number::integer);
        Some([words.next()??, words.next()??, words.next()??])
    };
    by_columns().or_else(by_words)
}

/// Reads the lines up to `M  END`: `M  CHG` and `M  RAD` replace all charges of the atoms' lines.
fn read_properties(lines: &mut Lines<'_>, atoms: &mut [TableAtom]) {
    let mut is_first = true;
    loop {
        let before = lines.clone();
        let Some((_, line)) = lines.next() else { return };
        if line.starts_with(b"$$$$") {
            *lines = before;
            return;
        }
        if line.starts_with(b"M  END") {
            return;
        }
        let is_charge = line.starts_with(b"M  CHG");
        if (is_charge || line.starts_with(b"M  RAD")) && std::mem::take(&mut is_first) {
            atoms.iter_mut().for_each(|atom| atom.charge = 0.0);
        }
        if !is_charge {
            continue;
        }
        // A count, then pairs of atom and charge.
        let numbers: Vec<i64> = words(&line[6..]).skip(1).map_while(number::integer).collect();
        for pair in numbers.chunks_exact(2) {
            let row = usize::try_from(pair[0] - 1).ok();
            if let Some(atom) = row.and_then(|row| atoms.get_mut(row)) {
                atom.charge = pair[1].clamp(-99, 99) as f32;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, ModelChoice, NoteKind, Scene, SceneError};

    fn load(text: &str, model: ModelChoice) -> Result<Scene, SceneError> {
        Scene::from_bytes_with("t.sdf", text.as_bytes(), &LoadOptions { model, ..LoadOptions::default() })
    }

    fn message(text: &str) -> String {
        load(text, ModelChoice::First).expect_err("refused").to_string()
    }

    fn orders(scene: &Scene) -> Vec<(u32, u32, u8)> {
        scene.molecule.bonds.iter().map(|bond| (bond.a, bond.b, bond.order)).collect()
    }

    /// Acetate: counts of atoms and bonds, and the lines after the bonds.
    fn acetate(counts: &str, end: &str) -> String {
        format!(
            "acetate\n  test\n\n{counts}  0  0  0  0            999 V2000
    0.0000    0.0000    0.0000 C   0  0
    1.5000    0.0000    0.0000 C   0  0
    2.1000    1.1000    0.0000 O   0  0
    2.1000   -1.1000    0.0000 O   0  5
  1  2  1  0\n  2  3  2  0\n  2  4  1  0\n{end}"
        )
    }

    #[test]
    fn names_orders_and_old_charges_are_read() {
        let scene = load(&acetate("  4  3", "M  END\n"), ModelChoice::First).expect("a scene");
        assert_eq!(orders(&scene), [(0, 1, 1), (1, 2, 2), (1, 3, 1)]);
        let molecule = &scene.molecule;
        assert_eq!((molecule.residues[0].name.as_str(), molecule.atoms[3].name.as_str()), ("acetat", "O4"));
        assert_eq!(molecule.atoms.iter().map(|atom| atom.charge).collect::<Vec<_>>(), [0.0, 0.0, 0.0, -1.0]);
        assert!(scene.files[0].report.is_empty());
        let named = |name: &str| {
            let text = acetate("  4  3", "M  END\n").replacen("acetate", name, 1);
            load(&text, ModelChoice::First).expect("a scene").molecule.residues[0].name
        };
        assert_eq!(["", "GLY", "CHEBI:1 x"].map(|name| named(name).as_str().to_owned()), ["LIG", "LIG", "CHEBI:"]);
    }

    #[test]
    fn charges_of_properties_replace_those_of_atoms() {
        let end = "M  CHG  2   3  -1   1   2\nM  CHG  1  99   1\nM  END\n";
        let scene = load(&acetate("  4  3", end), ModelChoice::First).expect("a scene");
        let charges: Vec<f32> = scene.molecule.atoms.iter().map(|atom| atom.charge).collect();
        assert_eq!(charges, [2.0, 0.0, -1.0, 0.0]);
    }

    #[test]
    fn records_are_models() {
        let text = acetate("  4  3", "M  END\n> <x>\n1\n\n$$$$\n")
            + "\n\n\n  0  0  0\nM  END\n$$$$\n"
            + &acetate("  4  3", "$$$$\n\n");
        let scene = load(&text, ModelChoice::First).expect("a scene");
        assert_eq!(scene.molecule.atoms.len(), 4);
        assert_eq!(scene.files[0].report.count(NoteKind::ModelSkipped), 1);
        let all = load(&text, ModelChoice::All).expect("both").molecule;
        assert_eq!((all.atoms.len(), all.bonds.len(), all.residues.len()), (8, 6, 2));
        assert!(load(&text, ModelChoice::Number(4)).expect_err("three").to_string().contains("has no model 4"));
    }

    #[test]
    fn counts_that_lie_are_refused_with_their_line() {
        let end = "M  END\n";
        let cut = "if they are all, else the file was cut short";
        assert_eq!(
            message(&acetate("999  3", end)),
            format!("t.sdf:4: announces 999 atoms, but 4 follow; write 4 {cut}")
        );
        assert_eq!(
            message(&acetate("  4  9", end)),
            format!("t.sdf:4: announces 9 bonds, but 3 follow; write 3 {cut}")
        );
        assert_eq!(
            message(&acetate("  4  1", end)),
            "t.sdf:4: announces 1 bond, but 3 follow; write 3, or delete the lines that are too many"
        );
        assert!(
            message(&acetate("  2  3", end)).starts_with("t.sdf:7: found \"2.1000    1.1000    0.00...\" where a bond")
        );
        assert!(message(&acetate(" -4  3", end)).starts_with("t.sdf:4: the number of atoms is -4; write"));
        assert!(message(&acetate("  a  b", end)).starts_with("t.sdf:4: found \"a  b"));
        assert!(message("x\n\n\n  0  0\n$$$$\n").starts_with("t.sdf: holds no atoms; its counts"));
    }

    #[test]
    fn bonds_to_missing_atoms_are_noted() {
        let text = acetate("  4  3", "M  END\n").replace("  1  2  1", " 99  2  1").replace("  2  3  2", "  2  2  2");
        let scene = load(&text, ModelChoice::First).expect("a scene");
        let report = &scene.files[0].report;
        assert_eq!((report.count(NoteKind::BondToNowhere), report.count(NoteKind::BadBondRecord)), (1, 1));
        let broken =
            acetate("  4  3", "M  END\n").replace("    0.0000    0.0000    0.0000", "       nan    0.0000    0.0000");
        let scene = load(&broken, ModelChoice::First).expect("a scene");
        assert_eq!(orders(&scene), [(0, 1, 2), (0, 2, 1)]);
        assert_eq!(scene.files[0].report.count(NoteKind::BadCoordinate), 1);
    }

    #[test]
    fn words_will_do_where_columns_do_not() {
        let text = "m\n\n\n2 1 V2000\n0 0 0 Na 0 3\n3.1 0 0 Cl 0 5\n1 2 1\n";
        let scene = load(text, ModelChoice::First).expect("a scene");
        let symbols: Vec<_> = scene.molecule.atoms.iter().map(|atom| (atom.element.symbol(), atom.charge)).collect();
        assert_eq!(symbols, [("Na", 1.0), ("Cl", -1.0)]);
    }
}
