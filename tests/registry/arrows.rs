//! The modules of `src/` use each other only along the arrows of `docs/architecture.md`.

use std::collections::BTreeMap;

use super::{assert_none, code_words, files_below, table, text};

/// The map of the house.
const MAP: &str = "docs/architecture.md";

/// What each module may use: names of modules, or of parts of them (`config::param`).
fn allowed() -> BTreeMap<String, Vec<String>> {
    let rows = table(MAP, "| module | may use |");
    rows.iter()
        .map(|row| {
            let [module] = code_words(&row[0])[..] else { panic!("{MAP}: not one module: {}", row[0]) };
            (module.to_owned(), code_words(&row[1]).into_iter().map(str::to_owned).collect())
        })
        .collect()
}

/// The module that a part belongs to.
fn module_of(path: &str) -> &str {
    path.split("::").next().unwrap_or(path)
}

/// The modules that `lib.rs` declares.
fn declared() -> Vec<String> {
    let lib = text("src/lib.rs");
    let names = lib.lines().filter_map(|line| line.trim_start_matches("pub ").strip_prefix("mod ")?.strip_suffix(';'));
    names.map(str::to_owned).collect()
}

/// A file's place in the tree of modules: `["frame", "lights"]` for `src/frame/lights.rs`.
fn place(file: &str) -> Vec<&str> {
    let path = file.trim_start_matches("src/").trim_end_matches(".rs").trim_end_matches("/mod");
    if path == "lib" { Vec::new() } else { path.split('/').collect() }
}

/// Where the root of the crate is named: lines from 1, with the paths that start there.
fn uses(code: &str, depth: usize) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for root in ["crate::", "restyle::", "super::"] {
        for (at, _) in code.match_indices(root) {
            if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
                continue;
            }
            let mut rest = &code[at + root.len()..];
            if root == "super::" {
                // Indented: a module within the file takes what is the file's.
                if rest.starts_with('*') && code[..at].ends_with(" use ") {
                    continue;
                }
                let mut left = depth.saturating_sub(1);
                while let Some(more) = rest.strip_prefix("super::") {
                    (rest, left) = (more, left.saturating_sub(1));
                }
                if left > 0 {
                    continue;
                }
            }
            let mut paths = Vec::new();
            use_tree(rest, "", &mut paths);
            let line = code[..at].matches('\n').count() + 1;
            found.extend(paths.into_iter().map(|path| (line, path)));
        }
    }
    found
}

/// Spells out the paths of a use tree such as `a::{self, b::c as d}`; returns what follows it.
fn use_tree<'a>(tree: &'a str, before: &str, paths: &mut Vec<String>) -> &'a str {
    let tree = tree.trim_start();
    if let Some(mut rest) = tree.strip_prefix('{') {
        while !rest.is_empty() && !rest.starts_with('}') {
            rest = use_tree(rest, before, paths);
            let end = rest.find([',', '}']).unwrap_or(rest.len());
            rest = rest[end..].trim_start_matches(',').trim_start();
        }
        return rest.strip_prefix('}').unwrap_or(rest);
    }
    let end = tree.find(|c: char| !c.is_alphanumeric() && c != '_' && c != '*').unwrap_or(tree.len());
    let (name, rest) = tree.split_at(end);
    let path = if before.is_empty() { name.to_owned() } else { format!("{before}::{name}") };
    match rest.strip_prefix("::") {
        Some(rest) if !name.is_empty() && !rest.starts_with('<') => use_tree(rest, &path, paths),
        _ => {
            paths.push(path);
            rest
        }
    }
}

/// Code without its comments, line by line.
fn without_comments(text: &str) -> String {
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Macros that are exported to the root of the crate, with the module that declares each.
fn macros(sources: &[(String, String)]) -> BTreeMap<String, String> {
    let mut macros = BTreeMap::new();
    for (file, code) in sources {
        for after in code.split("#[macro_export]").skip(1) {
            let name = after.trim_start().trim_start_matches("macro_rules!").trim_start();
            let end = name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
            macros.insert(name[..end].to_owned(), place(file).first().copied().unwrap_or("lib").to_owned());
        }
    }
    macros
}

#[test]
fn modules_use_each_other_along_the_arrows_alone() {
    let allowed = allowed();
    let declared = declared();
    let sources: Vec<(String, String)> =
        files_below("src", ".rs").into_iter().map(|file| (file.clone(), without_comments(&text(&file)))).collect();
    let macros = macros(&sources);
    let mut complaints = Vec::new();
    let mut num_arrows = 0;
    for (file, code) in &sources {
        let place = place(file);
        let from = place.first().copied().unwrap_or("lib");
        for (line, path) in uses(code, place.len()) {
            let path = macros.get(&path).cloned().unwrap_or(path);
            let to = module_of(&path);
            // A name of a file's own parent is not the root's, unless the root has it.
            if to == from || (!declared.iter().any(|module| module == to) && !path.starts_with('*')) {
                continue;
            }
            num_arrows += 1;
            let may = allowed.get(from).map(Vec::as_slice).unwrap_or_default();
            if !may.iter().any(|part| path == *part || path.starts_with(&format!("{part}::"))) {
                let may = if may.is_empty() { "nothing of ours".to_owned() } else { may.join(", ") };
                complaints.push(format!("{file}:{line}: `{from}` uses `{path}`; {MAP} allows it {may}"));
            }
        }
    }
    assert!(num_arrows > 0, "no arrow was found at all");
    assert_none(&complaints);
}

#[test]
fn the_map_names_every_module() {
    let mut expected = declared();
    expected.push("main".to_owned());
    expected.sort();
    assert_eq!(allowed().into_keys().collect::<Vec<_>>(), expected, "{MAP} (left) has other modules than src/ (right)");
    let unknown =
        allowed().into_values().flatten().find(|part| !expected.iter().any(|module| module == module_of(part)));
    assert_eq!(unknown, None, "{MAP} allows an unknown module");
}

#[test]
fn the_arrows_have_no_cycle() {
    let mut left = allowed();
    while !left.is_empty() {
        let free = left.iter().find(|(_, may)| !may.iter().any(|part| left.contains_key(module_of(part))));
        let Some(free) = free.map(|(module, _)| module.clone()) else {
            panic!("{MAP}: a cycle among {:?}", left.keys());
        };
        left.remove(&free);
    }
}

#[test]
fn paths_are_read_from_groups_macros_and_parents() {
    let paths = |code: &str, depth| uses(code, depth).into_iter().map(|(_, path)| path).collect::<Vec<_>>();
    assert_eq!(
        paths("use crate::{a::{self, b as c}, d};\nfn f(x: crate::e::G<u8>) {}", 1),
        ["a::self", "a::b", "d", "e::G"]
    );
    assert_eq!(paths("$crate::gpu::Wgsl { path: 1 }", 2), ["gpu::Wgsl"]);
    assert_eq!(paths("use super::view::View;\nuse super::super::gpu::{Gpu, Module};", 2), ["gpu::Gpu", "gpu::Module"]);
    assert_eq!(paths("use super::gpu;", 1), ["gpu"]);
    assert!(paths(&without_comments("// crate::a::b\nmy_crate::c"), 1).is_empty());
}
