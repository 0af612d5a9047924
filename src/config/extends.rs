//! `extends`: a style that changes another.
//!
//! `shaders` merge by name, property by property, and an entry with another `shader` drops the base's properties;
//! `mapping` and the objects `camera`, `geometry` and `transparency` merge by key; lists are replaced. A key that is
//! written again counts as written last, so that among equal selectors a base comes before what extends it.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::error::{Mistakes, Place, Problem};
use super::source::{Source, Texts};
use super::style::check_version;
use super::syntax::{self, MAX_BYTES, Member, Node, Tree};

/// Longest chain of bases. Ours: nobody keeps track of more.
const MAX_BASES: usize = 16;

/// Finds the base that a style names.
pub trait Loader {
    /// Reads the base `name` of the style `from`, or says why that is not possible.
    fn load(&self, name: &str, from: &Source) -> Result<Source, String>;
}

impl<F: Fn(&str, &Source) -> Result<Source, String>> Loader for F {
    fn load(&self, name: &str, from: &Source) -> Result<Source, String> {
        self(name, from)
    }
}

/// Finds bases as files, relative to the file that names them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Files;

impl Loader for Files {
    fn load(&self, name: &str, from: &Source) -> Result<Source, String> {
        let Some(path) = &from.path else {
            return Err("only a style that is a file can extend another file".to_owned());
        };
        let beside = |path: &Path| path.parent().map_or_else(|| PathBuf::from(name), |folder| folder.join(name));
        let mut source = read_file(&beside(path))?;
        source.name = beside(Path::new(&from.name)).display().to_string();
        Ok(source)
    }
}

/// Reads a style file, or says why that is not possible.
pub fn read_file(path: &Path) -> Result<Source, String> {
    use std::io::{ErrorKind, Read};
    let reason = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => "there is no such file".to_owned(),
        ErrorKind::PermissionDenied => "no permission to read this file".to_owned(),
        ErrorKind::IsADirectory => "this is a folder, not a style file".to_owned(),
        _ => format!("this file cannot be read: {error}"),
    };
    if path.is_dir() {
        return Err("this is a folder, not a style file".to_owned());
    }
    let mut text = Vec::new();
    // A byte-order mark and one byte more than is allowed are enough to know that it is too much.
    let file = std::fs::File::open(path).map_err(reason)?;
    file.take(MAX_BYTES as u64 + 4).read_to_end(&mut text).map_err(reason)?;
    let canonical = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    Ok(Source { name: path.display().to_string(), text, path: Some(canonical) })
}

/// A style with its bases in one tree.
pub(super) struct Merged {
    pub(super) root: Node,
    /// What is wrong so far.
    pub(super) mistakes: Mistakes,
    pub(super) files: Vec<PathBuf>,
}

/// Parses a style and its bases into `texts` and merges them.
pub(super) fn merge_all(source: &Source, loader: &dyn Loader, texts: &mut Texts) -> Result<Merged, Mistakes> {
    let mut mistakes = Mistakes::default();
    let mut chain = vec![source.clone()];
    let complete = read_chain(&mut chain, loader, texts, &mut mistakes);
    let files: Vec<PathBuf> = chain.iter().filter_map(|source| source.path.clone()).collect();
    // Without its base, half a style would be full of names that nothing explains.
    if !complete {
        mistakes.files = files;
        return Err(mistakes);
    }
    let mut roots = texts.0.iter().rev().map(|text| &text.root);
    let first = roots.next().cloned().expect("the style itself was parsed");
    let root = roots.fold(first, merge);
    Ok(Merged { root, mistakes, files })
}

/// Parses the last source of the chain, then its base, and so on; false if one of them cannot be used.
fn read_chain(chain: &mut Vec<Source>, loader: &dyn Loader, texts: &mut Texts, mistakes: &mut Mistakes) -> bool {
    loop {
        let index = chain.len() - 1;
        match syntax::parse(&chain[index], index as u32, mistakes) {
            Ok(text) => texts.0.push(text),
            Err(wrong) => {
                let (place, problem) = *wrong;
                mistakes.push(|| place, problem);
                return false;
            }
        }
        let text = &texts.0[index];
        if let Err((span, problem)) = check_version(&text.root) {
            mistakes.push(|| text.place(span), problem);
            return false;
        }
        if index > 0 && !matches!(text.root.value, Tree::Object(_)) {
            let problem = super::read::wrong_type("style", "an object", &text.root);
            mistakes.push(|| text.place(text.root.span), problem);
            return false;
        }
        let Some(node) = text.root.get("extends") else {
            return true;
        };
        let Some(name) = node.text() else {
            let problem = super::read::wrong_type("extends", "the name of a style file", node);
            mistakes.push(|| text.place(node.span), problem);
            return false;
        };
        match find_base(name, chain, loader) {
            Ok(base) => chain.push(base),
            Err(reason) => {
                let problem = Problem::Extends { base: name.to_owned(), reason };
                mistakes.push(|| text.place(node.span), problem);
                return false;
            }
        }
    }
}

fn find_base(name: &str, chain: &[Source], loader: &dyn Loader) -> Result<Source, String> {
    if chain.len() > MAX_BASES {
        return Err(format!("more than {MAX_BASES} styles extend one another"));
    }
    let base = loader.load(name, &chain[chain.len() - 1])?;
    if chain.iter().any(|source| source.is_same_file(&base)) {
        let names: Vec<&str> = chain.iter().chain([&base]).map(|source| source.name.as_str()).collect();
        return Err(format!("these styles extend one another in a circle: {}", names.join(" > ")));
    }
    Ok(base)
}

/// The members of an object; `None` for anything else.
fn members(node: &Node) -> Option<&[Member]> {
    match &node.value {
        Tree::Object(members) => Some(members),
        _ => None,
    }
}

/// All members of `own`, after those of `base` whose keys `own` does not have. If either is no object, `own`.
fn union(base: &Node, own: &Node) -> Node {
    let (Some(base), Some(own_members)) = (members(base), members(own)) else {
        return own.clone();
    };
    let keys: HashSet<&str> = own_members.iter().map(|member| member.key.as_str()).collect();
    let kept = base.iter().filter(|member| !keys.contains(member.key.as_str()));
    Node { value: Tree::Object(kept.chain(own_members).cloned().collect()), span: own.span }
}

/// Makes one value of a base's and a style's own.
type Merge = fn(&Node, &Node) -> Node;

/// The parts of a style that are merged, each with its way.
const MERGED: [(&str, Merge); 5] =
    [("camera", union), ("geometry", union), ("transparency", union), ("mapping", union), ("shaders", merge_shaders)];

/// A whole style over its base.
fn merge(base: Node, own: &Node) -> Node {
    let mut merged = union(&base, own);
    let Tree::Object(merged_members) = &mut merged.value else {
        return merged;
    };
    for (key, merge) in MERGED {
        // A key that is written twice is a mistake that was found already: merging each would be a way to fill memory.
        let first = merged_members.iter_mut().find(|member| member.key == key);
        if let (Some(member), Some(base), Some(own)) = (first, base.get(key), own.get(key)) {
            member.value = merge(base, own);
        }
    }
    merged
}

/// The base's entries in their order, each with the changes of its namesake, then the new ones.
fn merge_shaders(base: &Node, own: &Node) -> Node {
    let (Tree::List(base_entries), Tree::List(own_entries)) = (&base.value, &own.value) else {
        return own.clone();
    };
    let mut entries = base_entries.clone();
    let named = entries.iter().enumerate().rev();
    let mut of_name: HashMap<String, usize> =
        named.filter_map(|(i, entry)| Some((entry.get("name")?.text()?.to_owned(), i))).collect();
    for entry in own_entries {
        // Taken out, so that a second namesake stays an entry of its own, which is a mistake that is found later.
        let namesake = entry.get("name").and_then(Node::text).and_then(|name| of_name.remove(name));
        match namesake {
            Some(i) => entries[i] = merge_entry(&entries[i], entry),
            None => entries.push(entry.clone()),
        }
    }
    Node { value: Tree::List(entries), span: own.span }
}

fn merge_entry(base: &Node, own: &Node) -> Node {
    let shader_of = |entry: &Node| entry.get("shader").and_then(Node::text).map(str::to_owned);
    if own.get("shader").is_some() && shader_of(own) != shader_of(base) {
        return own.clone();
    }
    let mut merged = union(base, own);
    if let (Tree::Object(members), Some(base), Some(own)) =
        (&mut merged.value, base.get("properties"), own.get("properties"))
        && let Some(first) = members.iter_mut().find(|member| member.key == "properties")
    {
        first.value = union(base, own);
    }
    merged
}

/// A file that cannot be read, as mistakes.
pub(super) fn unreadable(path: &Path, reason: String) -> Mistakes {
    Mistakes::one(Place::of_file(&path.display().to_string()), Problem::Unreadable(reason))
}
