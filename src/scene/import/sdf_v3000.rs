//! Tables of version V3000 [CTfile, throughout]: `M  V30` lines in blocks, continued after a hyphen.

use super::Import;
use super::lines::Lines;
use super::number;
use super::sdf;
use super::table::{Table, TableBond, count_error, row_error, words};
use crate::scene::error::SceneError;
use crate::scene::name::Name;
use std::borrow::Cow;

/// What every line of the table begins with.
const PREFIX: &[u8] = b"M  V30";

/// The next line of the table, with its continuations, and the number of its first line; none where the table ends.
fn next<'a>(lines: &mut Lines<'a>) -> Option<(u32, Cow<'a, [u8]>)> {
    let (number, first) = next_part(lines)?;
    let Some(start) = first.strip_suffix(b"-") else {
        return Some((number, Cow::Borrowed(first)));
    };
    let mut whole = start.to_vec();
    while let Some((_, part)) = next_part(lines) {
        match part.strip_suffix(b"-") {
            Some(part) => whole.extend_from_slice(part),
            None => {
                whole.extend_from_slice(part);
                break;
            }
        }
    }
    Some((number, Cow::Owned(whole)))
}

/// The next line of the file if it is of the table, without what it begins with.
fn next_part<'a>(lines: &mut Lines<'a>) -> Option<(u32, &'a [u8])> {
    let before = lines.clone();
    loop {
        let (number, line) = lines.next()?;
        if let Some(rest) = line.strip_prefix(PREFIX) {
            return Some((number, rest.strip_prefix(b" ").unwrap_or(rest).trim_ascii_end()));
        }
        // Blank lines between are harmless, all else ends the table.
        if !line.trim_ascii().is_empty() {
            *lines = before;
            return None;
        }
    }
}

/// The numbers after `COUNTS`.
fn counts(line: &[u8]) -> Option<[i64; 2]> {
    let mut words = words(line);
    words.next().filter(|word| *word == b"COUNTS")?;
    let mut numbers = words.map(number::integer);
    Some([numbers.next()??, numbers.next()??])
}

/// Whether the table that begins here announces atoms.
pub(super) fn has_atoms(mut lines: Lines<'_>) -> bool {
    while let Some((_, line)) = next(&mut lines) {
        if let Some([atoms, _]) = counts(&line) {
            return atoms != 0;
        }
    }
    true
}

/// A block of the table.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Block {
    Atoms,
    Bonds,
    Other,
}

/// Reads a table up to its end.
pub(super) fn read_table(import: &mut Import<'_>, lines: &mut Lines<'_>, residue: Name) -> Result<Table, SceneError> {
    let mut table = Table::default();
    let mut announced = None;
    let mut block = Block::Other;
    let mut num_bonds = 0;
    while let Some((number, line)) = next(lines) {
        let mut start = words(&line);
        match (start.next().unwrap_or_default(), start.next().unwrap_or_default()) {
            (b"BEGIN", b"ATOM") => block = Block::Atoms,
            (b"BEGIN", b"BOND") => block = Block::Bonds,
            // The end of the table, not that of a group in it.
            (b"END", b"CTAB") => break,
            (b"BEGIN" | b"END", _) => block = Block::Other,
            (b"COUNTS", _) => match counts(&line) {
                Some(counts) if counts.iter().all(|&count| count >= 0) => announced = Some((number, counts)),
                _ => {
                    let belongs = "COUNTS with the number of atoms and bonds";
                    return Err(row_error(import, number, &line, belongs, "write how many of them follow"));
                }
            },
            _ if block == Block::Atoms => read_atom(import, number, &line, residue, &mut table)?,
            _ if block == Block::Bonds => {
                num_bonds += 1;
                read_bond(import, number, &line, &mut table)?;
            }
            _ => {}
        }
    }
    if let Some((line, [atoms, bonds])) = announced {
        for (announced, what, found) in [(atoms, "atoms", table.atoms.len()), (bonds, "bonds", num_bonds)] {
            if announced != found as i64 {
                return Err(count_error(import, line, announced, what, found));
            }
        }
    }
    Ok(table)
}

/// Reads an atom: number, symbol, x, y, z, a number for reactions, and perhaps `CHG=`.
fn read_atom(
    import: &mut Import<'_>,
    line: u32,
    text: &[u8],
    residue: Name,
    table: &mut Table,
) -> Result<(), SceneError> {
    let mut words = words(text);
    let number = words.next().and_then(number::integer).and_then(|number| u32::try_from(number).ok());
    // A list of elements may follow a word of its own.
    let symbol = words.next().filter(|symbol| *symbol != b"NOT").or_else(|| words.next());
    let fields = (words.next(), words.next(), words.next());
    let (Some(number), Some(symbol), (Some(x), Some(y), Some(z))) = (number, symbol, fields) else {
        return Err(row_error(import, line, text, "an atom", "write its number, symbol, x, y and z"));
    };
    let mut atom = sdf::atom(import, line, number, symbol, residue);
    atom.position = import.position(line, [x, y, z])?;
    let charge = words.find_map(|word| number::integer(word.strip_prefix(b"CHG=")?));
    atom.charge = charge.map_or(0.0, |charge| charge.clamp(-99, 99) as f32);
    table.atoms.push(atom);
    Ok(())
}

/// Reads a bond: number, type, two atoms.
fn read_bond(import: &Import<'_>, line: u32, text: &[u8], table: &mut Table) -> Result<(), SceneError> {
    let mut numbers = words(text).map(number::integer).skip(1);
    let mut next = || numbers.next().flatten();
    let (Some(bond_type), Some(a), Some(b)) = (next(), next(), next()) else {
        return Err(row_error(import, line, text, "a bond", "write its number, type, and the numbers of two atoms"));
    };
    let end = |end: i64| u32::try_from(end).unwrap_or(u32::MAX);
    table.bonds.extend(sdf::order(bond_type).map(|order| TableBond { line, ends: [end(a), end(b)], order }));
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, ModelChoice, Scene, SceneError};

    /// A table with the lines given.
    fn load(lines: &[&str]) -> Result<Scene, SceneError> {
        let lines: String = lines.iter().map(|line| format!("M  V30 {line}\n")).collect();
        let text = format!("n\n\n\n  0  0  0     0  0            999 V3000\n{lines}M  END\n$$$$\n");
        let options = LoadOptions { model: ModelChoice::All, ..LoadOptions::default() };
        Scene::from_bytes_with("t.mol", text.as_bytes(), &options)
    }

    #[test]
    fn continued_lines_charges_and_odd_numbers_are_read() {
        let lines = [
            "BEGIN CTAB",
            "COUNTS 2 1 0 0 0",
            "BEGIN ATOM",
            "7 N 0.-",
            "0 0 0 0 X=(1 2) CHG=1",
            "99 C 1.2 -",
            "0 0 0",
            "END ATOM",
            "BEGIN BOND",
            "1 3 99 7",
            "END BOND",
            "END CTAB",
        ];
        let molecule = load(&lines).expect("a scene").molecule;
        assert_eq!((molecule.atoms[0].charge, molecule.atoms[1].name.as_str()), (1.0, "C99"));
        assert_eq!((molecule.bonds[0].order, molecule.bonds.len()), (3, 1));
    }

    #[test]
    fn blocks_that_lie_are_refused() {
        let atom = "1 C 0 0 0 0";
        let message = |lines: &[&str]| load(lines).expect_err("refused").to_string();
        assert_eq!(
            message(&["COUNTS 2000000000 0 0 0 0", "BEGIN ATOM", atom, "END ATOM"]),
            "t.mol:5: announces 2000000000 atoms, but 1 follows; write 1 if they are all, else the file was cut short"
        );
        assert!(message(&["COUNTS -1 0", "BEGIN ATOM", atom]).starts_with("t.mol:5: found \"COUNTS -1 0\""));
        assert!(
            message(&["COUNTS 1 1", "BEGIN ATOM", atom, "END ATOM", "BEGIN BOND", "1 1 1"]).starts_with("t.mol:10:")
        );
        assert!(
            message(&["COUNTS 1 0", "BEGIN ATOM", "1 C 0 0"]).starts_with("t.mol:7: found \"1 C 0 0\" where an atom")
        );
        assert!(message(&["BEGIN ATOM", "1 C 0 1e31 0"]).contains("y = \"1e31\" is no position"));
    }
}
