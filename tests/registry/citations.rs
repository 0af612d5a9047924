//! Citations: every key in square brackets is explained in `docs/papers.md`, and every key there is used.

use std::collections::{BTreeMap, BTreeSet};

use super::{assert_none, code_words, files_below, table, text};

/// The list of sources.
const PAPERS: &str = "docs/papers.md";

/// Files that cite, by key: what stands in a comment right after a square bracket and starts with a capital letter.
/// Links to items of the code are written in back quotes, and so are none.
fn citations() -> BTreeMap<String, BTreeSet<String>> {
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let files = [files_below("src", ".rs"), files_below("shaders", ".wgsl"), files_below("tests", ".rs")];
    // This file quotes citations that are none.
    for file in files.concat().into_iter().filter(|file| file != "tests/registry/citations.rs") {
        for line in text(&file).lines() {
            for key in keys_of(line) {
                found.entry(key.to_owned()).or_default().insert(file.clone());
            }
        }
    }
    found
}

/// The keys that a line of code cites in its comment.
fn keys_of(line: &str) -> Vec<&str> {
    let Some(comment) = line.find("//").map(|start| &line[start..]) else { return Vec::new() };
    let brackets = comment.match_indices('[').filter(|(at, _)| comment[..*at].ends_with([' ', '(', '/', '!']));
    let cited = brackets.map(|(at, _)| &comment[at + 1..]).filter(|rest| rest.starts_with(|c: char| c.is_uppercase()));
    cited.map(|rest| rest.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default()).collect()
}

#[test]
fn keys_are_read_from_comments_alone() {
    assert_eq!(keys_of("let a = b[I]; // as in [Prost2016 §2], [Livny2007]"), ["Prost2016", "Livny2007"]);
    assert!(keys_of("let a: [Param; 1] = b; // See [`View`], [n, m] and `&[Param]`.").is_empty());
}

#[test]
fn every_citation_has_its_source() {
    let listed: Vec<String> = table(PAPERS, "| key |").into_iter().map(|row| row[0].clone()).collect();
    let citations = citations();
    assert!(!citations.is_empty(), "nothing is cited at all");
    let missing = citations.iter().filter(|(key, _)| !listed.contains(key));
    assert_none(&missing.map(|(key, files)| format!("{PAPERS} lacks {key}, cited in {files:?}")).collect::<Vec<_>>());
}

#[test]
fn every_source_names_the_files_that_cite_it() {
    let citations = citations();
    let nowhere = BTreeSet::new();
    let mut complaints = Vec::new();
    for row in table(PAPERS, "| key |") {
        let [key, source, used_by] = row.as_slice() else { panic!("{PAPERS}: a row has three cells: {row:?}") };
        let named: BTreeSet<String> = code_words(used_by).into_iter().map(str::to_owned).collect();
        let citing = citations.get(key).unwrap_or(&nowhere);
        if citing.is_empty() {
            complaints.push(format!("{PAPERS}: {key} is cited nowhere"));
        }
        for file in named.difference(citing) {
            complaints.push(format!("{PAPERS}: {file} does not cite {key}"));
        }
        // Twins cite what their shaders cite; they may be named, but need not be.
        for file in citing.difference(&named).filter(|file| !file.starts_with("tests/")) {
            complaints.push(format!("{PAPERS}: {key} is also cited in {file}"));
        }
        if !source.ends_with('.') || !source.contains('*') {
            complaints.push(format!("{PAPERS}: {key} needs an author, a *title* and where it was published"));
        }
    }
    assert_none(&complaints);
}

#[test]
fn sources_are_in_order_and_named_once() {
    let keys: Vec<String> = table(PAPERS, "| key |").into_iter().map(|row| row[0].clone()).collect();
    let wrong = keys.windows(2).filter(|pair| pair[0].to_lowercase() >= pair[1].to_lowercase());
    assert_none(
        &wrong.map(|pair| format!("{PAPERS}: {} does not come before {}", pair[0], pair[1])).collect::<Vec<_>>(),
    );
}
