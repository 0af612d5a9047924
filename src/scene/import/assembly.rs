//! Biological assemblies of PDB files: the matrices of `REMARK 350` and the chains that they place [PdbFormat 3.3, REMARK 350].

use super::Import;
use super::lines::quote;
use super::number;
use super::table::words;
use crate::scene::builder::{MoleculeBuilder, NewCopy};
use crate::scene::error::SceneError;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashSet;

/// Copies of one assembly at most. Ours: the largest capsids of the archive have some thousands.
const MAX_COPIES: usize = 10_000;
/// Atoms of all copies at most. Ours.
const MAX_COPIED_ATOMS: u64 = 100_000_000;
/// Runs of atoms in all copies at most, so that a file whose chains alternate takes bounded memory. Ours.
const MAX_RUNS: u64 = 2_000_000;
/// How far the product of a rotation and its transpose may be from one. Real files have six decimals, old ones fewer.
const RIGID_TOLERANCE: f64 = 2e-3;

/// Chains and the matrices that place them.
#[derive(Debug, Default)]
struct Group {
    chains: Vec<Vec<u8>>,
    /// The three rows of each matrix, and the line of its first; rows that are still missing are none.
    matrices: Vec<(u32, [Option<[f64; 4]>; 3])>,
}

/// One assembly of a file.
#[derive(Debug, Default)]
struct Biomolecule {
    line: u32,
    ids: Vec<String>,
    groups: Vec<Group>,
}

/// All assemblies of a file, as they are read.
#[derive(Debug, Default)]
pub(super) struct Remarks {
    biomolecules: Vec<Biomolecule>,
    /// Whether the last line listed chains, and the next may go on.
    is_in_chains: bool,
}

impl Remarks {
    /// Reads a remark, if it is one of number 350.
    ///
    /// # Errors
    /// `Malformed` if a row of a matrix has no numbers.
    pub(super) fn add(&mut self, import: &Import<'_>, line: u32, record: &[u8]) -> Result<(), SceneError> {
        let mut start = words(record.get(6..).unwrap_or_default());
        if start.next() != Some(b"350") {
            return Ok(());
        }
        let text = record.get(10..).unwrap_or_default();
        let was_in_chains = std::mem::take(&mut self.is_in_chains);
        if let Some(ids) = after(text, b"BIOMOLECULE:") {
            let ids = list(ids).map(printable).collect();
            self.biomolecules.push(Biomolecule { line, ids, groups: Vec::new() });
            return Ok(());
        }
        if let Some(row) = start.next().and_then(|word| word.strip_prefix(b"BIOMT")) {
            return self.add_row(import, line, row, start);
        }
        let is_first = after(text, b"APPLY THE FOLLOWING TO CHAINS:");
        let more = || after(text, b"AND CHAINS:").or_else(|| text.contains(&b',').then_some(text));
        if let Some(chains) = is_first.or_else(|| more().filter(|_| was_in_chains)) {
            let biomolecule = self.last(line);
            if is_first.is_some() {
                biomolecule.groups.push(Group::default());
            }
            let names = list(chains).map(|chain| if chain == b"NULL" { Vec::new() } else { chain.to_vec() });
            if let Some(group) = biomolecule.groups.last_mut() {
                group.chains.extend(names);
            }
            self.is_in_chains = true;
        }
        Ok(())
    }

    /// The assembly that is being read; the first of files that do not number theirs.
    fn last(&mut self, line: u32) -> &mut Biomolecule {
        if self.biomolecules.is_empty() {
            self.biomolecules.push(Biomolecule { line, ids: vec!["1".to_string()], groups: Vec::new() });
        }
        let last = self.biomolecules.len() - 1;
        &mut self.biomolecules[last]
    }

    /// Reads a row of a matrix: its number, the matrix's number, and four numbers.
    fn add_row<'a>(
        &mut self,
        import: &Import<'_>,
        line: u32,
        row: &[u8],
        mut words: impl Iterator<Item = &'a [u8]>,
    ) -> Result<(), SceneError> {
        let row = number::integer(row).and_then(|row| usize::try_from(row - 1).ok()).filter(|&row| row < 3);
        let _matrix_number = words.next();
        let mut values = [0.0; 4];
        let mut is_whole = row.is_some();
        for value in &mut values {
            let word = words.next().and_then(number::float);
            is_whole &= word.is_some_and(|word| word.is_finite() && word.abs() <= number::ABSURD);
            *value = word.unwrap_or_default();
        }
        let (Some(row), true) = (row, is_whole) else {
            let what = "the row of the matrix is not whole; write BIOMT1 to BIOMT3, a number, and four numbers";
            return Err(import.malformed(line, what.to_string()));
        };
        let biomolecule = self.last(line);
        if biomolecule.groups.is_empty() {
            biomolecule.groups.push(Group::default());
        }
        let Some(group) = biomolecule.groups.last_mut() else { return Ok(()) };
        match group.matrices.last_mut() {
            Some((_, rows)) if row > 0 && rows[row].is_none() => rows[row] = Some(values),
            _ => {
                let mut rows = [None; 3];
                rows[row] = Some(values);
                group.matrices.push((line, rows));
            }
        }
        Ok(())
    }

    /// The copies of the assembly that was asked for.
    ///
    /// # Errors
    /// `NoSuchAssembly`, or `Malformed` if it places nothing, too much, or by more than rotation and translation.
    pub(super) fn copies(&self, import: &Import<'_>, builder: &MoleculeBuilder) -> Result<Vec<NewCopy>, SceneError> {
        let wanted = import.options.assembly.as_deref().unwrap_or_default();
        let is_wanted = |biomolecule: &&Biomolecule| biomolecule.ids.iter().any(|id| id.eq_ignore_ascii_case(wanted));
        let Some(biomolecule) = self.biomolecules.iter().find(is_wanted) else {
            let file = import.file.to_string();
            return Err(SceneError::NoSuchAssembly { file, assembly: wanted.to_string(), available: self.available() });
        };
        let (mut copies, mut num_atoms, mut num_runs) = (Vec::new(), 0_u64, 0_u64);
        for group in &biomolecule.groups {
            let num_copies = group.matrices.len();
            let too_many = copies.len() + num_copies > MAX_COPIES;
            if num_copies == 0 {
                continue;
            }
            let chains: HashSet<&[u8]> = group.chains.iter().map(Vec::as_slice).collect();
            let is_in_group = |id: &str| !too_many && (chains.is_empty() || chains.contains(id.as_bytes()));
            let atoms = builder.atoms_of_chains(is_in_group);
            let in_one: u64 = atoms.iter().map(|range| u64::from(range.end - range.start)).sum();
            num_atoms = num_atoms.saturating_add(in_one.saturating_mul(num_copies as u64));
            num_runs = num_runs.saturating_add((atoms.len() as u64).saturating_mul(num_copies as u64));
            if too_many || num_atoms > MAX_COPIED_ATOMS || num_runs > MAX_RUNS {
                let what = format!(
                    "assembly {wanted} is more than {MAX_COPIES} copies or {MAX_COPIED_ATOMS} atoms; draw the deposited \
                     coordinates, without --assembly"
                );
                return Err(import.malformed(biomolecule.line, what));
            }
            if in_one == 0 {
                continue;
            }
            for (line, rows) in &group.matrices {
                copies.push(NewCopy { atoms: atoms.clone(), place: place(import, *line, rows)? });
            }
        }
        if copies.is_empty() {
            let what = format!(
                "assembly {wanted} places no atom; its chains and BIOMT matrices belong in the lines below, and the \
                 chains into the file"
            );
            return Err(import.malformed(biomolecule.line, what));
        }
        Ok(copies)
    }

    /// The ids that there are, in words.
    fn available(&self) -> String {
        let ids: Vec<&str> =
            self.biomolecules.iter().flat_map(|biomolecule| &biomolecule.ids).map(String::as_str).collect();
        match ids.as_slice() {
            [] => "none".to_string(),
            [only] => format!("only {only}"),
            [ids @ .., last] if ids.len() < 12 => format!("{} and {last}", ids.join(", ")),
            [first, .., last] => format!("{}, from {first} to {last}", ids.len()),
        }
    }
}

/// The placement that three rows make.
fn place(import: &Import<'_>, line: u32, rows: &[Option<[f64; 4]>; 3]) -> Result<DAffine3, SceneError> {
    let &[Some(x), Some(y), Some(z)] = rows else {
        let what = "the matrix lacks a row; write BIOMT1, BIOMT2 and BIOMT3 one after the other".to_string();
        return Err(import.malformed(line, what));
    };
    let row = |row: [f64; 4]| DVec3::new(row[0], row[1], row[2]);
    let rotation = DMat3::from_cols(row(x), row(y), row(z)).transpose();
    let off = rotation * rotation.transpose() - DMat3::IDENTITY;
    let largest = off.to_cols_array().into_iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if largest.is_nan() || largest > RIGID_TOLERANCE || rotation.determinant() < 0.0 {
        let mut found = Vec::new();
        for value in &x[..3] {
            found.extend_from_slice(format!("{value} ").as_bytes());
        }
        let what = format!(
            "the matrix that begins with {} is no rotation; correct it, or draw without --assembly",
            quote(&found)
        );
        return Err(import.malformed(line, what));
    }
    Ok(DAffine3 { matrix3: rotation, translation: DVec3::new(x[3], y[3], z[3]) })
}

/// An id for comparing and for messages: they are small numbers, whatever else stands there is cut and made printable.
fn printable(id: &[u8]) -> String {
    let letter = |&byte: &u8| if byte.is_ascii_graphic() { byte as char } else { '?' };
    id.iter().take(12).map(letter).collect()
}

/// What follows a label, wherever it stands.
fn after<'a>(text: &'a [u8], label: &[u8]) -> Option<&'a [u8]> {
    let at = memchr::memmem::find(text, label)?;
    Some(&text[at + label.len()..])
}

/// The parts between commas and spaces.
fn list(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|&byte| byte == b',' || byte.is_ascii_whitespace()).filter(|part| !part.is_empty())
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, Molecule, NoteKind, Scene, SceneError};

    const ATOMS: &str = "\
ATOM      1  C   LIG A   1       0.000   0.000   0.000  1.00  0.00           C
ATOM      2  C   LIG B   1       5.000   0.000   0.000  1.00  0.00           C
ATOM      3  C   LIG b   1       9.000   0.000   0.000  1.00  0.00           C
";
    const IDENTITY: &str = "\
REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000
";
    const SCREW: &str = "\
REMARK 350   BIOMT1   2  0.000000 -1.000000  0.000000        0.00000
REMARK 350   BIOMT2   2  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000       20.00000
";

    fn load(remarks: &str, assembly: &str) -> Result<Molecule, SceneError> {
        let options = LoadOptions { assembly: Some(assembly.to_string()), ..LoadOptions::default() };
        Scene::from_bytes_with("t.pdb", format!("{remarks}{ATOMS}").as_bytes(), &options).map(|scene| scene.molecule)
    }

    fn message(remarks: &str, assembly: &str) -> String {
        load(remarks, assembly).expect_err("refused").to_string()
    }

    #[test]
    fn chains_and_matrices_make_copies() {
        let remarks = format!(
            "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A,\nREMARK 350                    \
             AND CHAINS: b\n{IDENTITY}{SCREW}REMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n{SCREW}\
             REMARK 350 BIOMOLECULE: 2\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n{IDENTITY}"
        );
        let molecule = load(&remarks, "1").expect("three copies");
        let atoms: Vec<_> = molecule.copies.iter().map(|copy| copy.atoms.clone()).collect();
        let alone = std::iter::once(1..2).collect::<Vec<_>>();
        assert_eq!(atoms, [vec![0..1, 2..3], vec![0..1, 2..3], alone]);
        let drawn: Vec<_> =
            molecule.drawn_balls().map(|(center, _)| (molecule.origin + center.as_dvec3()).to_array()).collect();
        let expected = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 0.0, 20.0], [0.0, 9.0, 20.0], [0.0, 5.0, 20.0]];
        assert!(drawn.iter().flatten().zip(expected.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-5), "{drawn:?}");
        assert_eq!(load(&remarks, "2").expect("one copy").copies.len(), 1);
        assert_eq!(message(&remarks, "3"), "t.pdb: has no assembly 3; it has 1 and 2");
    }

    #[test]
    fn files_without_assemblies_say_so() {
        assert_eq!(message("", "1"), "t.pdb: has no assembly 1; it has none");
        let options = LoadOptions { assembly: Some("1".to_string()), ..LoadOptions::default() };
        let scene = Scene::from_bytes_with("t.xyz", b"1\n\nC 0 0 0\n", &options).expect("an XYZ file");
        assert_eq!(scene.files[0].report.count(NoteKind::NoAssemblies), 1);
    }

    #[test]
    fn matrices_that_deform_are_refused_with_their_line() {
        let scaled = IDENTITY.replacen("1.000000", "1.100000", 1);
        assert_eq!(
            message(&format!("REMARK\n{scaled}"), "1"),
            "t.pdb:2: the matrix that begins with \"1.1 0 0\" is no rotation; correct it, or draw without --assembly"
        );
        let mirrored = IDENTITY.replacen("1.000000", "-1.00000", 1);
        assert!(message(&mirrored, "1").contains("no rotation"));
        let short: String = IDENTITY.lines().take(2).map(|line| format!("{line}\n")).collect();
        assert!(message(&short, "1").starts_with("t.pdb:1: the matrix lacks a row; "));
        assert!(message(&IDENTITY.replace("0.00000\n", "nan\n"), "1").starts_with("t.pdb:1: the row of the matrix"));
    }

    #[test]
    fn assemblies_of_nothing_or_of_too_much_are_refused() {
        let nobody = format!("REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: X\n{IDENTITY}");
        assert!(message(&nobody, "1").starts_with("t.pdb:1: assembly 1 places no atom; "));
        assert!(message("REMARK 350 BIOMOLECULE: 1\n", "1").starts_with("t.pdb:1: assembly 1 places no atom; "));
        let crowd = format!("REMARK 350 BIOMOLECULE: 7\n{}", IDENTITY.repeat(10_001));
        assert!(message(&crowd, "7").starts_with("t.pdb:1: assembly 7 is more than 10000 copies"));
        assert_eq!(load(&IDENTITY.repeat(10_000), "1").expect("as many as may be").copies.len(), 10_000);
    }
}
