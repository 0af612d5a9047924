//! Selectors for what a scene has, as lines of `mapping` to paste and to complete.

use std::collections::{HashMap, HashSet};

use super::facts::Facts;
use super::text::{counted, grouped};

/// Most selectors of one kind.
const MOST: usize = 50;

/// One line a selector, with a comment that says how much it picks.
pub(super) fn lines(facts: &Facts) -> Vec<String> {
    let atoms = |count: usize| counted(count, "atom");
    let mut groups: Vec<Vec<(String, String)>> = Vec::new();
    let placed: u64 = facts.parts.iter().map(|part| part.placed).sum();
    let types = [("atom", atoms(facts.atoms)), ("connector", counted(facts.bonds, "bond")), ("mesh", parts(placed))];
    let is_there = |name: &str| facts.types().contains(&name);
    groups.push(types.into_iter().filter(|(name, _)| is_there(name)).map(|(name, of)| (name.to_owned(), of)).collect());
    let chains = summed(facts.chains.iter().map(|chain| (chain.id.as_str(), chain.group.atoms)));
    groups.push(chains.into_iter().map(|(id, of)| (selector("atom", "chain", id), atoms(of))).collect());
    let kinds = facts.residues.iter().map(|(kind, of)| {
        (selector("atom", "kind", kind), format!("{}, {}", counted(of.residues, "residue"), atoms(of.atoms)))
    });
    groups.push(kinds.collect());
    let ligands = facts.ligands.iter().map(|(name, of)| {
        (selector("atom", "residue", name), format!("{}, {}", counted(of.residues, "residue"), atoms(of.atoms)))
    });
    groups.push(ligands.collect());
    groups.push(facts.elements.iter().map(|(symbol, of)| (selector("atom", "element", symbol), atoms(*of))).collect());
    let names = facts.parts.iter().map(|part| (part.name.as_str(), part.placed));
    groups.push(alike(names).into_iter().map(|(glob, of)| (selector("mesh", "part", &glob), parts(of))).collect());
    let used = facts.materials.iter().filter(|material| material.parts > 0);
    let materials = summed(used.map(|material| (material.name.as_str(), material.parts as usize)));
    groups
        .push(materials.iter().map(|(name, of)| (selector("mesh", "material", name), counted(*of, "part"))).collect());
    // Files of one name are one selector.
    let mut files: Vec<(String, String)> =
        facts.files.iter().map(|file| (selector("*", "file", &file.name), file.format.to_owned())).collect();
    let mut seen = HashSet::new();
    files.retain(|(selector, _)| seen.insert(selector.clone()));
    groups.push(files);
    groups.iter().flat_map(|group| aligned(group)).collect()
}

/// The counts of each name that is not empty, in the order of the first.
fn summed<'a>(names: impl Iterator<Item = (&'a str, usize)>) -> Vec<(&'a str, usize)> {
    let mut number_of: HashMap<&str, usize> = HashMap::new();
    let mut sums: Vec<(&str, usize)> = Vec::new();
    for (name, count) in names.filter(|(name, _)| !name.is_empty()) {
        let number = *number_of.entry(name).or_insert_with(|| {
            sums.push((name, 0));
            sums.len() - 1
        });
        sums[number].1 += count;
    }
    sums
}

fn parts(count: u64) -> String {
    counted(count as usize, "part")
}

/// Lines of one kind, their comments in a column.
fn aligned(group: &[(String, String)]) -> Vec<String> {
    let shown: Vec<(String, &str)> = group
        .iter()
        .take(MOST)
        .map(|(selector, comment)| {
            (format!("{}: \"...\",", serde_json::Value::from(selector.as_str())), comment.as_str())
        })
        .collect();
    let width = shown.iter().map(|(line, _)| line.chars().count().min(60)).max().unwrap_or(0);
    let rest = (group.len() > MOST).then(|| format!("// ... and {} more", grouped(group.len() - MOST)));
    shown.iter().map(|(line, comment)| format!("{line:<width$} // {comment}")).chain(rest).collect()
}

/// A selector of one value, quoted where it must be.
fn selector(kind: &str, attribute: &str, value: &str) -> String {
    let is_plain =
        !value.is_empty() && !value.contains(']') && !value.starts_with(['"', '\'']) && value.trim() == value;
    if is_plain {
        return format!("{kind}[{attribute}={value}]");
    }
    match ['"', '\''].into_iter().find(|quote| !value.contains(*quote)) {
        Some(quote) => format!("{kind}[{attribute}={quote}{value}{quote}]"),
        // One that holds both quotes: what must not stand alone is any character.
        None => format!("{kind}[{attribute}=\"{}\"]", value.replace('"', "?")),
    }
}

/// Names that differ in digits alone.
struct Alike<'a> {
    texts: Vec<&'a str>,
    /// The digits between the texts; none where they differ.
    runs: Vec<Option<&'a str>>,
    count: u64,
}

/// Names, those that differ in digits alone as one glob, with what there is of each, in the order of the first.
fn alike<'a>(names: impl Iterator<Item = (&'a str, u64)>) -> Vec<(String, u64)> {
    let mut number_of: HashMap<Vec<&str>, usize> = HashMap::new();
    let mut groups: Vec<Alike<'_>> = Vec::new();
    for (name, count) in names.filter(|(name, _)| !name.is_empty()) {
        let (texts, runs) = runs_of(name);
        let number = *number_of.entry(texts.clone()).or_insert(groups.len());
        match groups.get_mut(number) {
            Some(group) => {
                group.count += count;
                for (known, run) in group.runs.iter_mut().zip(runs) {
                    *known = known.filter(|known| *known == run);
                }
            }
            None => groups.push(Alike { texts, runs: runs.into_iter().map(Some).collect(), count }),
        }
    }
    let glob = |group: Alike<'_>| {
        let runs = group.runs.into_iter().map(|run| run.unwrap_or("*")).chain([""]);
        (group.texts.into_iter().zip(runs).flat_map(|(text, run)| [text, run]).collect(), group.count)
    };
    groups.into_iter().map(glob).collect()
}

/// A name parted into texts and the runs of digits between them; there is a text before and after each run.
fn runs_of(name: &str) -> (Vec<&str>, Vec<&str>) {
    let (mut texts, mut runs) = (Vec::new(), Vec::new());
    let mut rest = name;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let after = &rest[start..];
        let end = after.find(|c: char| !c.is_ascii_digit()).unwrap_or(after.len());
        texts.push(&rest[..start]);
        runs.push(&after[..end]);
        rest = &after[end..];
    }
    texts.push(rest);
    (texts, runs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Selector;

    #[test]
    fn names_that_differ_in_digits_are_one_glob() {
        let names = ["Bolt1", "Housing", "Bolt12", "M6 nut 1", "M6 nut 2", "Gear3", "7", ""];
        let expected = [("Bolt*", 2), ("Housing", 1), ("M6 nut *", 2), ("Gear3", 1), ("7", 1)];
        let found = alike(names.map(|name| (name, 1)).into_iter());
        assert_eq!(found, expected.map(|(glob, count)| (glob.to_owned(), count)));
    }

    #[test]
    fn every_value_makes_a_selector_that_matches_it() {
        for value in ["A", "", " A", "A]", "\"A\"", "'A", "a\"]'", "A B", "\u{e9}", "a=b", "[x]", "x\"'", "\t"] {
            let text = selector("mesh", "part", value);
            let selector = Selector::parse(&text).unwrap_or_else(|problem| panic!("{text}: {problem}"));
            assert!(selector.matches(crate::config::ObjectKind::Mesh, &|_| Some(value)), "{text}");
        }
    }
}
