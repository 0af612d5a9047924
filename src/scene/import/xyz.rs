//! XYZ files: a count, a comment, and a line `symbol x y z` per atom; then perhaps further frames.
//!
//! The count is never trusted for memory. Further columns are ignored; symbols may be atomic numbers or carry labels;
//! exponents may be Fortran's. A missing comment line is mended, any other contradiction of count and lines is an error:
//! a picture of half a molecule would be worse.

use super::Import;
use super::lines::{Lines, quote};
use super::models::Models;
use super::number;
use crate::scene::builder::{MoleculeBuilder, NewAtom};
use crate::scene::error::SceneError;
use crate::scene::guess::from_xyz_symbol;
use crate::scene::molecule::Molecule;
use crate::scene::name::Name;
use crate::scene::report::NoteKind;

/// The first four words of a line that has so many.
fn words(line: &[u8]) -> Option<[&[u8]; 4]> {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    Some([words.next()?, words.next()?, words.next()?, words.next()?])
}

/// Whether a line can only be an atom: a known element and three numbers.
fn is_surely_atom(line: &[u8]) -> bool {
    words(line).is_some_and(|[symbol, fields @ ..]| {
        from_xyz_symbol(symbol).is_known() && fields.iter().all(|field| number::float(field).is_some())
    })
}

/// The only word of a line.
fn only_word(line: &[u8]) -> Option<&[u8]> {
    let word = line.trim_ascii();
    (!word.is_empty() && !word.iter().any(u8::is_ascii_whitespace)).then_some(word)
}

/// Reads all wanted frames.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<Molecule, SceneError> {
    let mut builder = MoleculeBuilder::default();
    let mut models = Models::new(import.options.model);
    let mut lines = Lines::new(bytes);
    let mut is_first = true;
    while let Some((number, header)) = lines.by_ref().find(|(_, line)| !line.trim_ascii().is_empty()) {
        let count = match header.split(u8::is_ascii_whitespace).find(|word| !word.is_empty()).and_then(number::integer)
        {
            Some(count) => count,
            None if is_first => {
                let what = format!(
                    "found {} where the number of atoms belongs; put the number there, and a comment line after it",
                    quote(header)
                );
                return Err(import.malformed(number, what));
            }
            None => {
                note_trailing(import, number, header, lines);
                break;
            }
        };
        let Ok(count) = u64::try_from(count) else {
            let what = format!("the number of atoms is {count}; write how many lines of atoms follow");
            return Err(import.malformed(number, what));
        };
        is_first = false;
        let comment = lines.next();
        models.begin(None);
        // A frame without atoms is no model.
        match (count > 0).then(|| models.atom()).flatten() {
            Some(model) => read_frame(import, &mut builder, &mut lines, Header { number, count, comment, model })?,
            None => skip(&mut lines, count),
        }
    }
    if let Some(error) = models.missing(import.file) {
        return Err(error);
    }
    import.report.note_many(NoteKind::ModelSkipped, models.num_skipped(), String::new);
    builder.finish(&[], &mut import.report).ok_or_else(|| {
        let notes = import.report.to_string().trim_end().replace('\n', "; ");
        let hint = if notes.is_empty() {
            "its count of atoms is 0".to_string()
        } else {
            format!("no line of it can be drawn: {notes}")
        };
        SceneError::NoAtoms { file: import.file.to_string(), hint }
    })
}

/// Passes over lines, as many as there are.
fn skip(lines: &mut Lines<'_>, count: u64) {
    let mut left = count;
    while left > 0 && lines.next().is_some() {
        left -= 1;
    }
}

/// Notes what follows the last frame, unless it is blank.
fn note_trailing(import: &mut Import<'_>, number: u32, line: &[u8], rest: Lines<'_>) {
    import.report.note(NoteKind::TrailingText, number, || quote(line));
    for (number, line) in rest.filter(|(_, line)| !line.trim_ascii().is_empty()) {
        import.report.note(NoteKind::TrailingText, number, || quote(line));
    }
}

/// The two lines above a frame's atoms.
struct Header<'a> {
    number: u32,
    count: u64,
    comment: Option<(u32, &'a [u8])>,
    model: u32,
}

/// Reads the atoms of one frame.
fn read_frame(
    import: &mut Import<'_>,
    builder: &mut MoleculeBuilder,
    lines: &mut Lines<'_>,
    header: Header<'_>,
) -> Result<(), SceneError> {
    for found in 0..header.count {
        let before = lines.clone();
        let line = lines.next();
        if let Some((number, line)) = line
            && let Some(words) = words(line)
        {
            read_atom(import, builder, number, words, header.model)?;
            continue;
        }
        // No atom here: the frame ended early, or the line is damaged.
        let is_end = line.is_none_or(|(_, line)| {
            line.trim_ascii().is_empty() || only_word(line).is_some_and(|word| number::integer(word).is_some())
        });
        if let Some((number, line)) = line
            && !is_end
        {
            return Err(import.malformed(
                number,
                format!("found {} where an atom belongs; write its symbol, x, y and z", quote(line)),
            ));
        }
        if found + 1 == header.count
            && let Some((number, comment)) = header.comment
            && is_surely_atom(comment)
            && let Some(words) = words(comment)
        {
            import
                .report
                .note(NoteKind::CountMended, number, || "an atom stands where the comment belongs".to_string());
            read_atom(import, builder, number, words, header.model)?;
            *lines = before;
            return Ok(());
        }
        let (count, follow) = (header.count, if found == 1 { "follows" } else { "follow" });
        let what = format!(
            "announces {count} atoms, but {found} {follow}; write {found} if they are all, else the file was cut short"
        );
        return Err(import.malformed(header.number, what));
    }
    Ok(())
}

/// Adds one atom, or notes that its position is unusable.
fn read_atom(
    import: &mut Import<'_>,
    builder: &mut MoleculeBuilder,
    number: u32,
    [symbol, x, y, z]: [&[u8]; 4],
    model: u32,
) -> Result<(), SceneError> {
    let Some(position) = import.position(number, [x, y, z])? else {
        return Ok(());
    };
    let element = from_xyz_symbol(symbol);
    if !element.is_known() {
        import.report.note(NoteKind::ElementUnknown, number, || quote(symbol));
    }
    builder.push(&NewAtom {
        position,
        element,
        name: Name::new(symbol),
        alt_loc: 0,
        occupancy: 1.0,
        residue_name: Name::default(),
        residue_number: 0,
        insertion_code: 0,
        is_hetero: false,
        chain: b"",
        model,
        b_factor: 0.0,
        charge: 0.0,
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, ModelChoice, NoteKind, Scene, SceneError};

    fn load(text: &str, model: ModelChoice) -> Result<Scene, SceneError> {
        Scene::from_bytes_with("t.xyz", text.as_bytes(), &LoadOptions { model, ..LoadOptions::default() })
    }

    fn message(text: &str) -> String {
        load(text, ModelChoice::First).expect_err("refused").to_string()
    }

    const TWO_FRAMES: &str = "1\none\nC 0 0 0\n2\ntwo\nO 0 0 0\nH 0.9 0 0\n";

    #[test]
    fn the_first_of_several_frames_is_drawn() {
        let scene = load(TWO_FRAMES, ModelChoice::First).expect("a scene");
        assert_eq!(scene.molecule.atoms.len(), 1);
        assert_eq!(scene.files[0].report.count(NoteKind::ModelSkipped), 1);
        let all = load(TWO_FRAMES, ModelChoice::All).expect("both").molecule;
        assert_eq!((all.atoms.len(), all.bonds.len(), all.residues.len()), (3, 1, 2));
        let second = load(TWO_FRAMES, ModelChoice::Number(2)).expect("the second").molecule;
        assert_eq!(second.atoms.len(), 2);
        let error = load(TWO_FRAMES, ModelChoice::Number(3)).expect_err("there are two");
        assert_eq!(error.to_string(), "t.xyz: has no model 3; it has 2, from 1 to 2");
    }

    #[test]
    fn lies_about_the_count_are_named() {
        let end = "write 1 if they are all, else the file was cut short";
        assert_eq!(message("9\n\nC 0 0 0\n"), format!("t.xyz:1: announces 9 atoms, but 1 follows; {end}"));
        assert_eq!(
            message("2\n\nC 0 0 0\n1\n\nC 0 0 0\n"),
            format!("t.xyz:1: announces 2 atoms, but 1 follows; {end}")
        );
        assert!(message("99999999999999999999\n\nC 0 0 0\n").starts_with("t.xyz:1: found"));
        assert!(message("0\n\n").starts_with("t.xyz: holds no atoms; its count"));
        assert!(message("C 0 0 0\n").starts_with("t.xyz:1: found \"C 0 0 0\" where the number"));
    }

    #[test]
    fn a_missing_comment_line_is_mended_also_before_another_frame() {
        for text in ["2\nC 0 0 0\nC 1.4 0 0\n", "2\nC 0 0 0\nC 1.4 0 0\n1\n\nO 0 0 0\n"] {
            let scene = load(text, ModelChoice::First).expect("mended");
            assert_eq!(scene.molecule.atoms.len(), 2, "{text:?}");
            assert_eq!(scene.files[0].report.count(NoteKind::CountMended), 1);
        }
    }

    #[test]
    fn damaged_rows_are_named() {
        assert_eq!(
            message("2\n\nC 0 0 0\nC 1 2\n"),
            "t.xyz:4: found \"C 1 2\" where an atom belongs; write its symbol, x, y and z"
        );
        assert!(message("1\n\nC 1e31 0 0\n").starts_with("t.xyz:3: x = \"1e31\" is no position"));
        assert!(message("1\n\nC nan 0 0\n").contains("no line of it can be drawn: 1 atom skipped"));
    }

    #[test]
    fn every_line_end_will_do() {
        for end in ["\n", "\r\n", "\r"] {
            let scene = load(&TWO_FRAMES.replace('\n', end), ModelChoice::All).expect("a scene");
            assert_eq!(scene.molecule.atoms.len(), 3);
        }
    }
}
