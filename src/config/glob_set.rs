//! Many globs matched against one text at once.
//!
//! The globs form a tree that shares their beginnings, and a text is followed through it by all ways at once. A step of
//! the text costs as many nodes as there are different beginnings of globs that match the text so far: for the short
//! names of molecules a few of thousands, and never more than the tree has.

use std::ops::Range;

use super::glob::glob_matches;

/// So few globs are tried one by one rather than split further.
const FEW: u32 = 4;

/// Deepest node, in characters. Ours: no name of a scene is as long, and it bounds what a hostile style takes.
const DEEPEST: usize = 64;

/// No node.
const NONE: u32 = u32::MAX;

/// Where all globs of the set that begin alike lie.
#[derive(Debug, Clone)]
struct Node {
    /// Globs that are tried one by one from here: those that end here, or all that begin so if they are few.
    tried: Range<u32>,
    /// Bytes of those that lie above this node.
    depth: usize,
    /// Where the next character decides.
    literals: Range<u32>,
    /// After `?`.
    any: u32,
    /// After `*`.
    star: u32,
    /// Whether this node is after `*`, and so stays through any character.
    stays: bool,
}

/// A set of globs, each in its one shape.
#[derive(Debug, Clone, Default)]
pub(super) struct GlobSet {
    /// Sorted, each with its number.
    globs: Vec<(Box<str>, u32)>,
    nodes: Vec<Node>,
    literals: Vec<(char, u32)>,
}

/// The nodes that are reached; kept from text to text for its memory.
#[derive(Debug, Default)]
pub(super) struct Reached {
    now: Vec<u32>,
    next: Vec<u32>,
    /// When each node was reached last.
    at: Vec<u64>,
    step: u64,
}

impl GlobSet {
    /// Builds the set of different globs.
    pub(super) fn new(mut globs: Vec<(Box<str>, u32)>) -> Self {
        globs.sort_unstable();
        let mut set = Self { globs, ..Self::default() };
        let all = 0..set.globs.len() as u32;
        set.build(all, 0, 0, false);
        set
    }

    fn build(&mut self, range: Range<u32>, depth: usize, characters: usize, stays: bool) -> u32 {
        let index = self.nodes.len() as u32;
        let mut node = Node { tried: range.clone(), depth, literals: 0..0, any: NONE, star: NONE, stays };
        if range.len() as u32 <= FEW || characters >= DEEPEST {
            // Globs that are tried one by one see to their `*` themselves: once, and not at each character.
            node.depth -= usize::from(stays);
            node.stays = false;
            self.nodes.push(node);
            return index;
        }
        self.nodes.push(node.clone());
        let next_of = |set: &Self, at: u32| set.globs[at as usize].0[depth..].chars().next();
        let mut at = range.start;
        // A glob that ends here sorts first.
        while at < range.end && next_of(self, at).is_none() {
            at += 1;
        }
        node.tried.end = at;
        let mut literals = Vec::new();
        while let Some(c) = (at < range.end).then(|| next_of(self, at)).flatten() {
            let rest = &self.globs[at as usize..range.end as usize];
            let same = rest.partition_point(|(glob, _)| glob[depth..].starts_with(c)) as u32;
            let child = self.build(at..at + same, depth + c.len_utf8(), characters + 1, c == '*');
            match c {
                '*' => node.star = child,
                '?' => node.any = child,
                c => literals.push((c, child)),
            }
            at += same;
        }
        node.literals.start = self.literals.len() as u32;
        self.literals.extend(literals);
        node.literals.end = self.literals.len() as u32;
        self.nodes[index as usize] = node;
        index
    }

    /// Adds the number of each glob that matches the whole text, some of them more than once.
    pub(super) fn matches(&self, text: &str, reached: &mut Reached, found: &mut Vec<u32>) {
        reached.at.resize(self.nodes.len(), 0);
        reached.now.clear();
        reached.step += 1;
        self.enter(0, text, &mut reached.now, (&mut reached.at, reached.step), found);
        let mut characters = text.chars();
        while let Some(c) = characters.next() {
            reached.step += 1;
            reached.next.clear();
            for index in &reached.now {
                let node = &self.nodes[*index as usize];
                let literals = &self.literals[node.literals.start as usize..node.literals.end as usize];
                let literal = literals.binary_search_by_key(&c, |(c, _)| *c).map_or(NONE, |i| literals[i].1);
                for next in [literal, node.any, if node.stays { *index } else { NONE }] {
                    let stamps = (&mut reached.at, reached.step);
                    self.enter(next, characters.as_str(), &mut reached.next, stamps, found);
                }
            }
            std::mem::swap(&mut reached.now, &mut reached.next);
        }
    }

    /// Reaches a node, and without a character the one after its `*`; `rest` of the text is left.
    fn enter(
        &self,
        mut index: u32,
        rest: &str,
        into: &mut Vec<u32>,
        (at, step): (&mut Vec<u64>, u64),
        found: &mut Vec<u32>,
    ) {
        while index != NONE && at[index as usize] != step {
            at[index as usize] = step;
            let node = &self.nodes[index as usize];
            for (glob, number) in &self.globs[node.tried.start as usize..node.tried.end as usize] {
                if glob_matches(&glob[node.depth..], rest) {
                    found.push(*number);
                }
            }
            if node.stays || node.any != NONE || !node.literals.is_empty() {
                into.push(index);
            }
            index = node.star;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::glob::normal;
    use super::*;

    fn matches(set: &GlobSet, text: &str) -> Vec<u32> {
        let mut found = Vec::new();
        set.matches(text, &mut Reached::default(), &mut found);
        found.sort_unstable();
        found.dedup();
        found
    }

    #[test]
    fn a_set_finds_what_each_glob_alone_does() {
        // All globs of up to five of these characters, on all texts of up to five.
        let words = |alphabet: &[&str], longest: usize| {
            let mut words = vec![String::new()];
            let mut from = 0;
            for _ in 0..longest {
                let to = words.len();
                for i in from..to {
                    words.extend(alphabet.iter().map(|letter| format!("{}{letter}", words[i])).collect::<Vec<_>>());
                }
                from = to;
            }
            words
        };
        let mut globs: Vec<String> =
            words(&["a", "\u{e9}", "*", "?"], 5).iter().map(|pattern| normal(pattern)).collect();
        globs.sort();
        globs.dedup();
        let set = GlobSet::new((0..).zip(&globs).map(|(i, glob)| (glob.as_str().into(), i)).collect());
        for text in words(&["a", "\u{e9}", "b"], 5) {
            let expected: Vec<u32> =
                (0..).zip(&globs).filter(|(_, g)| glob_matches(g, &text)).map(|(i, _)| i).collect();
            assert_eq!(matches(&set, &text), expected, "{text}");
        }
    }

    #[test]
    fn hostile_globs_stay_small_and_quick() {
        let long = "?".repeat(100_000);
        let globs: Vec<String> = (0..1000).map(|i| format!("{long}{i}*")).collect();
        let set = GlobSet::new((0..).zip(&globs).map(|(i, glob)| (glob.as_str().into(), i)).collect());
        assert!(set.nodes.len() <= DEEPEST + 1, "{}", set.nodes.len());
        assert!(matches(&set, "CA").is_empty());
        let stars: Vec<String> = (0..200).map(|i| "*a".repeat(i) + "*b*").collect();
        let set = GlobSet::new((0..).zip(&stars).map(|(i, glob)| (glob.as_str().into(), i)).collect());
        assert!(matches(&set, &"a".repeat(200)).is_empty());
        assert_eq!(matches(&set, "aab"), [0, 1, 2]);
    }
}
