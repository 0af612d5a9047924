//! `extends`: a style that changes another.
//!
//! `shaders` merge by name, property by property, and an entry with another `shader` drops the base's properties;
//! `mapping` and the objects `camera`, `geometry` and `transparency` merge by key; lists are replaced. A key that is
//! written again counts as written last, so that among equal selectors a base comes before what extends it.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::error::{Mistakes, Place, Problem};
use super::file::{STYLE, Unreadable, pipe, read_file};
use super::parse::parse;
use super::source::{Source, Texts};
use super::style::check_version;
use super::syntax::{Member, Node, Span, Tree};

/// Longest chain of bases. Ours: nobody keeps track of more.
const MAX_BASES: usize = 16;

/// Finds the base that a style names.
pub trait Loader {
    /// Reads the base `name` of the style `from`, or says why that is not possible.
    fn load(&self, name: &str, from: &Source) -> Result<Source, Unreadable>;
}

impl<F: Fn(&str, &Source) -> Result<Source, String>> Loader for F {
    fn load(&self, name: &str, from: &Source) -> Result<Source, Unreadable> {
        self(name, from).map_err(Unreadable::from)
    }
}

/// Finds bases as files, relative to the file that names them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Files;

impl Loader for Files {
    fn load(&self, name: &str, from: &Source) -> Result<Source, Unreadable> {
        if name.is_empty() {
            return Err(Unreadable::from("the name is empty: write the name of a style file".to_owned()));
        }
        let Some(path) = &from.path else {
            return Err(Unreadable::from("only a style that is a file can extend another file".to_owned()));
        };
        let beside = |path: &Path| path.parent().map_or_else(|| PathBuf::from(name), |folder| folder.join(name));
        let found = beside(path);
        // Of a pipe or a device nobody knows when it ends, and --watch reads a base again and again.
        if found.metadata().is_ok_and(|base| !base.is_file() && !base.is_dir()) {
            return Err(Unreadable { reason: pipe(STYLE), path: std::path::absolute(&found).ok() });
        }
        let mut source = read_file(&found)?;
        source.name = beside(Path::new(&from.name)).display().to_string();
        Ok(source)
    }
}

/// A style with its bases in one tree.
pub(super) struct Merged {
    pub(super) root: Node,
    /// What is wrong so far.
    pub(super) mistakes: Mistakes,
    pub(super) files: Vec<PathBuf>,
    pub(super) replaced: Replaced,
}

/// What each value or entry of a style replaces or changes in its base.
#[derive(Debug, Default)]
pub(super) struct Replaced(pub(super) Vec<(Span, Span)>);

/// Parses a style and its bases into `texts` and merges what can be read of them.
pub(super) fn merge_all(source: &Source, loader: &dyn Loader, texts: &mut Texts) -> Merged {
    let mut chain = Chain { sources: vec![source.clone()], tried: None, mistakes: Mistakes::default() };
    let mut usable = Vec::new();
    loop {
        let index = chain.sources.len() - 1;
        let text = parse(&chain.sources[index], index as u32, &mut chain.mistakes);
        texts.0.push(text);
        let (is_usable, base) = chain.read_last(loader, texts);
        usable.push(is_usable);
        match base {
            Some(base) => chain.sources.push(base),
            None => break,
        }
    }
    // A link is watched beside what it leads to: it may come to lead elsewhere.
    let read = chain.sources.iter().flat_map(|source| [&source.path, &source.link]).flatten().cloned();
    let files = read.chain(chain.tried).collect();
    // A style that is unusable as a whole leaves its bases to be checked.
    let mut roots = texts.0.iter().zip(usable).rev().filter(|(_, is_usable)| *is_usable).map(|(text, _)| &text.root);
    let first = roots.next().unwrap_or(&texts.0[0].root).clone();
    let mut replaced = Replaced::default();
    let root = roots.fold(first, |base, own| merge(base, own, &mut replaced));
    Merged { root, mistakes: chain.mistakes, files, replaced }
}

/// A style, its base, and so on, while they are read.
struct Chain {
    sources: Vec<Source>,
    /// A base that is not there.
    tried: Option<PathBuf>,
    mistakes: Mistakes,
}

impl Chain {
    /// Whether the last text can be checked, and the base that it names.
    fn read_last(&mut self, loader: &dyn Loader, texts: &mut Texts) -> (bool, Option<Source>) {
        let Some(text) = texts.0.last_mut() else {
            return (false, None);
        };
        let is_base = self.sources.len() > 1;
        if let Err((span, problem)) = check_version(&text.root)
            && !text.holds_broken(span)
        {
            // What a key means in another version is not known.
            self.mistakes.push(|| text.place(span), problem);
            text.is_whole = false;
            return (false, None);
        }
        if is_base && !matches!(text.root.value, Tree::Object(_) | Tree::Broken) {
            let problem = super::read::wrong_type("style", "an object", &text.root);
            self.mistakes.push(|| text.place(text.root.span), problem);
            text.is_whole = false;
            return (false, None);
        }
        let Some(node) = text.root.get("extends") else {
            return (true, None);
        };
        if text.holds_broken(node.span) {
            text.is_whole = false;
            return (true, None);
        }
        let found = match node.text() {
            None => Err(super::read::wrong_type("extends", "the name of a style file", node)),
            Some(name) => self.find_base(name, loader),
        };
        match found {
            Ok(base) => (true, Some(base)),
            Err(problem) => {
                self.mistakes.push(|| text.place(node.span), problem);
                text.is_whole = false;
                (true, None)
            }
        }
    }

    fn find_base(&mut self, name: &str, loader: &dyn Loader) -> Result<Source, Problem> {
        let problem = |reason| Problem::Extends { base: name.to_owned(), reason };
        let last = self.sources.last().expect("the style itself is the first");
        if self.sources.len() > MAX_BASES {
            return Err(problem(format!("more than {MAX_BASES} styles extend one another: make the chain shorter")));
        }
        let base = loader.load(name, last).map_err(|unreadable| {
            self.tried = unreadable.path;
            problem(unreadable.reason)
        })?;
        if self.sources.iter().any(|source| source.is_same_file(&base)) {
            let names: Vec<&str> = self.sources.iter().chain([&base]).map(|source| source.name.as_str()).collect();
            return Err(problem(format!("these styles extend one another in a circle: {}", names.join(" > "))));
        }
        Ok(base)
    }
}

/// The members of an object; `None` for anything else.
fn members(node: &Node) -> Option<&[Member]> {
    match &node.value {
        Tree::Object(members) => Some(members),
        _ => None,
    }
}

/// All members of `own`, after those of `base` whose keys `own` does not have. If either is no object, `own`, unless
/// that cannot be read.
fn union(base: &Node, own: &Node, replaced: &mut Replaced) -> Node {
    if own.value == Tree::Broken {
        return base.clone();
    }
    let (Some(base), Some(own_members)) = (members(base), members(own)) else {
        return own.clone();
    };
    let keys: HashMap<&str, &Member> = own_members.iter().map(|member| (member.key.as_str(), member)).collect();
    let kept = base.iter().filter(|member| match keys.get(member.key.as_str()) {
        Some(own) => {
            replaced.0.extend([(own.key_span, member.key_span), (own.value.span, member.value.span)]);
            false
        }
        None => true,
    });
    Node { value: Tree::Object(kept.chain(own_members).cloned().collect()), span: own.span }
}

/// Makes one value of a base's and a style's own.
type Merge = fn(&Node, &Node, &mut Replaced) -> Node;

/// The parts of a style that are merged, each with its way.
const MERGED: [(&str, Merge); 5] =
    [("camera", union), ("geometry", union), ("transparency", union), ("mapping", union), ("shaders", merge_shaders)];

/// A whole style over its base.
fn merge(base: Node, own: &Node, replaced: &mut Replaced) -> Node {
    let mut merged = union(&base, own, replaced);
    let Tree::Object(merged_members) = &mut merged.value else {
        return merged;
    };
    for (key, merge) in MERGED {
        // A key that is written twice is a mistake that was found already: merging each would be a way to fill memory.
        let first = merged_members.iter_mut().find(|member| member.key == key);
        if let (Some(member), Some(base), Some(own)) = (first, base.get(key), own.get(key)) {
            member.value = merge(base, own, replaced);
        }
    }
    merged
}

/// The base's entries in their order, each with the changes of its namesake, then the new ones.
fn merge_shaders(base: &Node, own: &Node, replaced: &mut Replaced) -> Node {
    if own.value == Tree::Broken {
        return base.clone();
    }
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
            Some(i) => entries[i] = merge_entry(&entries[i], entry, replaced),
            None => entries.push(entry.clone()),
        }
    }
    Node { value: Tree::List(entries), span: own.span }
}

fn merge_entry(base: &Node, own: &Node, replaced: &mut Replaced) -> Node {
    replaced.0.push((own.span, base.span));
    let shader_of = |entry: &Node| entry.get("shader").and_then(Node::text).map(str::to_owned);
    if own.get("shader").is_some() && shader_of(own) != shader_of(base) {
        return own.clone();
    }
    let mut merged = union(base, own, replaced);
    if let (Tree::Object(members), Some(base), Some(own)) =
        (&mut merged.value, base.get("properties"), own.get("properties"))
        && let Some(first) = members.iter_mut().find(|member| member.key == "properties")
    {
        first.value = union(base, own, replaced);
    }
    merged
}

/// A file that cannot be read, as mistakes.
pub(super) fn unreadable(path: &Path, unreadable: Unreadable) -> Mistakes {
    let place = Place::of_file(&path.display().to_string());
    let files = unreadable.path.into_iter().collect();
    Mistakes { files, ..Mistakes::one(place, Problem::Unreadable(unreadable.reason)) }
}
