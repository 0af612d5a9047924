//! What a scene holds, for people: one fact a line, lists cut where nobody reads on.

use super::facts::{Facts, Group};

/// Most lines of a list.
const MOST: usize = 20;

/// Widest column of names, in characters.
const WIDEST: usize = 40;

/// The lines.
pub(super) fn lines(facts: &Facts) -> Vec<String> {
    let mut rows: Vec<(&str, Vec<String>)> = Vec::new();
    rows.push(("files", table(facts.files.iter().map(|file| vec![file.name.clone(), file.format.to_owned()]))));
    rows.push(("types", vec![facts.types().join(", ")]));
    if facts.atoms > 0 {
        rows.push(("atoms", vec![grouped(facts.atoms)]));
        rows.push(("bonds", vec![grouped(facts.bonds)]));
        let of_group =
            |name: &str, of: &Group| vec![named(name), counted(of.residues, "residue"), counted(of.atoms, "atom")];
        rows.push(("residues", table(facts.residues.iter().map(|(kind, of)| of_group(kind, of)))));
        rows.push(("ligands", table(facts.ligands.iter().map(|(name, of)| of_group(name, of)))));
        let many_files = facts.files.len() > 1;
        let chains = facts.chains.iter().map(|chain| {
            let mut cells = of_group(&chain.id, &chain.group);
            cells.extend(many_files.then(|| chain.file.clone()));
            cells
        });
        rows.push(("chains", table(chains)));
        let elements = facts.elements.iter().map(|(symbol, count)| format!("{symbol} {}", grouped(*count)));
        rows.push(("elements", vec![elements.collect::<Vec<_>>().join(", ")]));
        let models = facts.models.iter().take(MOST).map(u32::to_string).collect::<Vec<_>>().join(", ");
        let more =
            if facts.models.len() > MOST { format!(" {}", more(facts.models.len() - MOST)) } else { String::new() };
        rows.push(("models", vec![models + &more]));
        if facts.copies > 0 {
            rows.push(("copies", vec![grouped(facts.copies)]));
        }
    }
    if !facts.parts.is_empty() {
        let placed: u64 = facts.parts.iter().map(|part| part.placed).sum();
        rows.push(("triangles", vec![grouped(facts.triangles as usize)]));
        rows.push(("vertices", vec![grouped(facts.vertices)]));
        let parts = facts.parts.iter().map(|part| {
            let material = part.material.as_deref().map_or_else(|| "no material".to_owned(), named);
            let times =
                if part.placed > 1 { format!("{} times", grouped(part.placed as usize)) } else { String::new() };
            vec![named(&part.name), material, counted(part.triangles as usize, "triangle"), times]
        });
        let mut lines = vec![grouped(placed as usize)];
        lines.extend(table(parts));
        rows.push(("parts", lines));
        let materials = facts.materials.iter().map(|of| {
            vec![
                named(&of.name),
                of.color.clone(),
                counted(of.parts as usize, "part"),
                counted(of.triangles as usize, "triangle"),
            ]
        });
        rows.push(("materials", table(materials)));
    }
    let bounds = &facts.bounds;
    let point = |p: glam::DVec3| p.to_array().map(digits).join(", ");
    let size = (bounds.high - bounds.low).to_array().map(digits).join(" x ");
    let sphere = format!("radius {} around {}", digits(bounds.radius), point(bounds.center));
    rows.push(("box", vec![format!("{size} from {} to {}", point(bounds.low), point(bounds.high))]));
    rows.push(("sphere", vec![sphere]));
    rows.push(("memory", vec![format!("{} MB", digits(facts.memory_bytes as f64 / 1e6))]));
    let notes = facts.files.iter().flat_map(|file| file.notes.iter().map(move |note| format!("{}: {note}", file.name)));
    rows.push(("notes", notes.collect()));
    let line = |(label, lines): (&str, Vec<String>)| {
        let labels = std::iter::once(label.to_owned()).chain(std::iter::repeat(String::new()));
        labels.zip(lines).map(|(label, line)| format!("{label:<10} {line}").trim_end().to_owned()).collect::<Vec<_>>()
    };
    rows.into_iter().flat_map(line).collect()
}

/// Rows in columns, the first [`MOST`] of them and how many more there are.
fn table(mut rows: impl ExactSizeIterator<Item = Vec<String>>) -> Vec<String> {
    let num_rows = rows.len();
    let shown: Vec<Vec<String>> = rows.by_ref().take(MOST).collect();
    let num_columns = shown.iter().map(Vec::len).max().unwrap_or(0);
    let cell = |row: &[String], column: usize| row.get(column).map_or(0, |cell| cell.chars().count().min(WIDEST));
    let widths: Vec<usize> =
        (0..num_columns).map(|column| shown.iter().map(|row| cell(row, column)).max().unwrap_or(0)).collect();
    let is_count = |text: &str| text.starts_with(|c: char| c.is_ascii_digit()) && text.contains(' ');
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (text, &width))| {
            let text = shortened(text);
            if column > 0 && is_count(&text) { format!("{text:>width$}") } else { format!("{text:<width$}") }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let rest = (num_rows > MOST).then(|| more(num_rows - MOST));
    shown.iter().map(line).chain(rest).collect()
}

fn more(count: usize) -> String {
    format!("... and {} more", grouped(count))
}

/// A name, or what stands for one that is empty.
fn named(name: &str) -> String {
    if name.is_empty() { "(no name)".to_owned() } else { name.to_owned() }
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= WIDEST {
        text.to_owned()
    } else {
        text.chars().take(WIDEST - 1).chain(['…']).collect()
    }
}

/// `1 atom`, `1,234 atoms`.
pub(super) fn counted(count: usize, what: &str) -> String {
    format!("{} {what}{}", grouped(count), if count == 1 { "" } else { "s" })
}

/// A number with its thousands parted.
pub(super) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// To four digits.
fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let places = (3 - value.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{value:.places$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_grouped() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        assert_eq!(
            [0.0, 1.0, -0.5, 12345.678, 0.000_123_456, 99.999].map(digits),
            ["0", "1", "-0.5", "12346", "0.0001235", "100"]
        );
    }

    #[test]
    fn tables_are_aligned_and_end() {
        let rows = (1..=100_000).map(|i| vec![format!("part {i}"), counted(i * 10, "triangle")]).collect::<Vec<_>>();
        let lines = table(rows.into_iter());
        assert_eq!(lines.len(), MOST + 1);
        assert_eq!((lines[0].as_str(), lines[19].as_str()), ("part 1    10 triangles", "part 20  200 triangles"));
        assert_eq!(lines[MOST], "... and 99,980 more");
    }
}
