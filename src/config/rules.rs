//! An index over the rules of a style: which rule decides about an object, without asking them one after the other.
//!
//! Each attribute that rules ask for has its patterns, plain values, globs and ranges, each once however many share it. A
//! value is matched against all of them at once (`Patterns`), which leaves the set of patterns that match it; values
//! with equal sets are alike to this style. Rules that ask for the same attributes make a group: a tree with one level
//! for each of its attributes, whose leaves are rules. An object follows the branches that its values match.
//!
//! Bounds, for n rules of any lengths and objects of v different values of an attribute:
//! - To build: n log n, the logarithm for sorting.
//! - Each different value: one look-up for plain patterns, the steps of a tree of globs for globs, and log n for ranges.
//! - Each question: a group for each set of attributes that rules ask for. With plain values alone a group is one path of
//!   a search of log n for each of its attributes; a value that also matches g globs or ranges makes g + 1 branches of it. Rules that cannot win any more are passed over. The worst is a style of globs of which many match
//!   one attribute of an object and none the next: it costs, as it must, the pairs that have to be tried.

use std::collections::HashMap;
use std::hash::{Hash, Hasher};
use std::ops;

use super::glob_set::{GlobSet, Reached};
use super::pattern::{Shape, ShapeKind};
use super::range::{Range, RangeSet};
use super::selector::{Attribute, AttributeSet, ObjectKind, Selector};
use super::style::Style;

/// No node, or no rule.
const NONE: u32 = u32::MAX;

/// The values of an object, or of many that this style cannot tell apart: for each attribute what its value matches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MatchedValues([Matched; Attribute::ALL.len()]);

impl MatchedValues {
    /// Says what the value of an attribute matches.
    pub fn set(&mut self, attribute: Attribute, matched: Matched) {
        self.0[attribute as usize] = matched;
    }
}

/// Two at a time: these are hashed once for each class of objects.
impl Hash for MatchedValues {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let (pairs, rest) = self.0.as_chunks::<2>();
        pairs.iter().for_each(|[a, b]| state.write_u64(u64::from(a.0) << 32 | u64::from(b.0)));
        rest.iter().for_each(|one| state.write_u32(one.0));
    }
}

/// What a value of an attribute matches: a number for each set of patterns. By default, nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Matched(u32);

/// Answers for the objects of one type.
#[derive(Debug)]
pub struct RuleIndex {
    patterns: [Patterns; Attribute::ALL.len()],
    groups: Vec<Group>,
    nodes: Vec<Node>,
    /// The branches of all nodes, each node's sorted by pattern.
    branch_patterns: Vec<u32>,
    branch_nodes: Vec<u32>,
    /// Where each rule is a leaf; nowhere if it can match no object of the type.
    leaf_of: Vec<u32>,
    /// The sets of patterns, each sorted.
    sets: Vec<Box<[u32]>>,
    number_of: HashMap<Box<[u32]>, Matched>,
    reached: Reached,
}

/// The rules that ask for the same attributes.
#[derive(Debug)]
struct Group {
    attributes: Vec<Attribute>,
    root: u32,
}

/// Some rules of a group whose first patterns are equal.
#[derive(Debug, Clone)]
struct Node {
    branches: ops::Range<u32>,
    /// The one among them that wins over the others.
    first: u32,
}

/// For each attribute of a group the pattern of a rule, and the rule.
type Entry = ([u32; Attribute::ALL.len()], u32);

impl RuleIndex {
    /// The index of a style's rules for objects of a type.
    pub fn new(style: &Style, kind: ObjectKind) -> Self {
        let mut builders: [PatternsBuilder; Attribute::ALL.len()] = Default::default();
        let mut group_of: HashMap<AttributeSet, Vec<Entry>> = HashMap::new();
        for (rule, selector) in (0..).zip(style.mapping.iter().map(|rule| &rule.selector)) {
            let attributes = selector.attributes();
            if !selector.is_for(kind) || attributes.iter().any(|of| !kind.attributes().contains(&of)) {
                continue;
            }
            let mut entry = [NONE; Attribute::ALL.len()];
            let mut can_match = true;
            for (level, attribute) in attributes.iter().enumerate() {
                match builders[attribute as usize].add(selector, attribute) {
                    Some(pattern) => entry[level] = pattern,
                    None => can_match = false,
                }
            }
            if can_match {
                group_of.entry(attributes).or_default().push((entry, rule));
            }
        }
        let mut index = Self {
            patterns: builders.map(PatternsBuilder::finish),
            groups: Vec::new(),
            nodes: Vec::new(),
            branch_patterns: Vec::new(),
            branch_nodes: Vec::new(),
            leaf_of: vec![NONE; style.mapping.len()],
            sets: vec![Box::default()],
            number_of: HashMap::from([(Box::default(), Matched::default())]),
            reached: Reached::default(),
        };
        for (attributes, mut entries) in group_of {
            let attributes: Vec<Attribute> = attributes.iter().collect();
            entries.sort_unstable();
            let root = index.build(&entries, 0, attributes.len());
            index.groups.push(Group { attributes, root });
        }
        // What wins first is asked first, so that the others need not be followed.
        let nodes = &index.nodes;
        index.groups.sort_unstable_by_key(|group| nodes[group.root as usize].first);
        index
    }

    /// Builds the tree of sorted entries from a level on.
    fn build(&mut self, entries: &[Entry], level: usize, num_levels: usize) -> u32 {
        let node = self.nodes.len() as u32;
        let first = entries.iter().map(|(_, rule)| *rule).min().unwrap_or(NONE);
        self.nodes.push(Node { branches: 0..0, first });
        if level == num_levels {
            entries.iter().for_each(|(_, rule)| self.leaf_of[*rule as usize] = node);
            return node;
        }
        let branches: Vec<(u32, u32)> = entries
            .chunk_by(|(a, _), (b, _)| a[level] == b[level])
            .map(|alike| (alike[0].0[level], self.build(alike, level + 1, num_levels)))
            .collect();
        let start = self.branch_nodes.len() as u32;
        self.branch_patterns.extend(branches.iter().map(|(pattern, _)| *pattern));
        self.branch_nodes.extend(branches.iter().map(|(_, node)| *node));
        self.nodes[node as usize].branches = start..self.branch_nodes.len() as u32;
        node
    }

    /// What a value matches. To be asked once for each value, not for each object.
    pub fn matched(&mut self, attribute: Attribute, value: &str) -> Matched {
        let set = self.patterns[attribute as usize].matching(value, attribute.ignores_case(), &mut self.reached);
        let (sets, new) = (&mut self.sets, Matched(self.number_of.len() as u32));
        *self.number_of.entry(set).or_insert_with_key(|set| {
            sets.push(set.clone());
            new
        })
    }

    /// The first rule that matches an object, as an index into [`Style::mapping`].
    pub fn first(&self, object: &MatchedValues) -> Option<u32> {
        let mut first = NONE;
        for group in &self.groups {
            if self.nodes[group.root as usize].first >= first {
                break;
            }
            self.search(group.root, &group.attributes, object, &mut first);
        }
        (first != NONE).then_some(first)
    }

    fn search(&self, node: u32, attributes: &[Attribute], object: &MatchedValues, first: &mut u32) {
        if self.nodes[node as usize].first >= *first {
            return;
        }
        let [attribute, attributes @ ..] = attributes else {
            *first = self.nodes[node as usize].first;
            return;
        };
        for next in self.branches(node, object.0[*attribute as usize]) {
            self.search(next, attributes, object, first);
        }
    }

    /// The branches of a node that a value matches: the shorter list is gone through, the longer one searched.
    fn branches(&self, node: u32, matched: Matched) -> impl Iterator<Item = u32> {
        let ops::Range { start, end } = self.nodes[node as usize].branches;
        let (own, set) = (&self.branch_patterns[start as usize..end as usize], &*self.sets[matched.0 as usize]);
        let own_is_shorter = own.len() < set.len();
        let (shorter, longer) = if own_is_shorter { (own, set) } else { (set, own) };
        shorter.iter().enumerate().filter_map(move |(i, pattern)| {
            let j = longer.binary_search(pattern).ok()?;
            Some(self.branch_nodes[start as usize + if own_is_shorter { i } else { j }])
        })
    }

    /// For each rule of the style whether it matches any of the objects, be it that another rule wins there.
    pub fn used(&self, objects: impl IntoIterator<Item = MatchedValues>) -> Vec<bool> {
        // Leaves below each node that no object reached yet: where there are none, nothing is left to find.
        let mut unreached = vec![0; self.nodes.len()];
        for node in (0..self.nodes.len()).rev() {
            let ops::Range { start, end } = self.nodes[node].branches;
            let below = self.branch_nodes[start as usize..end as usize].iter();
            unreached[node] = if start == end { 1 } else { below.map(|next| unreached[*next as usize]).sum() };
        }
        for object in objects {
            for group in &self.groups {
                self.reach(group.root, &group.attributes, &object, &mut unreached);
            }
        }
        self.leaf_of.iter().map(|leaf| *leaf != NONE && unreached[*leaf as usize] == 0).collect()
    }

    /// Follows an object to all its leaves and answers how many of them are new.
    fn reach(&self, node: u32, attributes: &[Attribute], object: &MatchedValues, unreached: &mut [u32]) -> u32 {
        if unreached[node as usize] == 0 {
            return 0;
        }
        let new = match attributes {
            [] => 1,
            [attribute, attributes @ ..] => self
                .branches(node, object.0[*attribute as usize])
                .map(|next| self.reach(next, attributes, object, unreached))
                .sum(),
        };
        unreached[node as usize] -= new;
        new
    }
}

/// The patterns of one attribute, each with a number.
#[derive(Debug)]
struct Patterns {
    /// Plain values, and globs and ranges, which match their own text as well; no value has that of a range.
    number_of: HashMap<Box<str>, u32>,
    globs: GlobSet,
    ranges: RangeSet,
    /// Patterns that ask for several others at once: those, sorted, and the number of the whole.
    joint: Vec<(Box<[u32]>, u32)>,
    /// By the one of its patterns that the fewest others share: which of `joint` to try where that matches.
    joint_of: HashMap<u32, Vec<u32>>,
}

impl Patterns {
    /// All patterns that match a value, sorted.
    fn matching(&self, value: &str, ignore_case: bool, reached: &mut Reached) -> Box<[u32]> {
        let lower = ignore_case.then(|| value.to_ascii_lowercase());
        let value = lower.as_deref().unwrap_or(value);
        let mut found: Vec<u32> = self.number_of.get(value).copied().into_iter().collect();
        self.globs.matches(value, reached, &mut found);
        self.ranges.matches(value, &mut found);
        found.sort_unstable();
        found.dedup();
        let joint = found.iter().filter_map(|one| self.joint_of.get(one)).flatten();
        let joint = joint.map(|i| &self.joint[*i as usize]);
        let met = joint.filter(|(all, _)| all.iter().all(|one| found.binary_search(one).is_ok()));
        let met: Vec<u32> = met.map(|(_, number)| *number).collect();
        found.extend(met);
        found.sort_unstable();
        found.into()
    }
}

/// Gives numbers to the patterns of one attribute.
#[derive(Debug, Default)]
struct PatternsBuilder {
    number_of: HashMap<Box<str>, u32>,
    joint: HashMap<Box<[u32]>, u32>,
    globs: Vec<(Box<str>, u32)>,
    ranges: Vec<(Range, u32)>,
    num_patterns: u32,
}

impl PatternsBuilder {
    /// The number of what a selector asks of an attribute; `None` if no value can be all of that.
    fn add(&mut self, selector: &Selector, attribute: Attribute) -> Option<u32> {
        let mut shapes: Vec<Shape> =
            selector.patterns(attribute).map(|pattern| pattern.shape(attribute.ignores_case())).collect();
        if let [only] = &shapes[..] {
            return Some(self.number(only));
        }
        shapes.sort_unstable_by(|a, b| a.text.cmp(&b.text));
        shapes.dedup();
        // Asked twice: a plain value must be each plain value and match each glob and range.
        if let Some(plain) = shapes.iter().find(|shape| shape.kind == ShapeKind::Plain) {
            return shapes.iter().all(|shape| shape.matches(&plain.text)).then(|| self.number(plain));
        }
        let mut all: Vec<u32> = shapes.iter().map(|shape| self.number(shape)).collect();
        if let [only] = all[..] {
            return Some(only);
        }
        all.sort_unstable();
        let next = self.num_patterns;
        let number = *self.joint.entry(all.into()).or_insert(next);
        self.num_patterns += u32::from(number == next);
        Some(number)
    }

    fn number(&mut self, shape: &Shape) -> u32 {
        if let Some(number) = self.number_of.get(shape.text.as_str()) {
            return *number;
        }
        let number = self.num_patterns;
        self.num_patterns += 1;
        self.number_of.insert(shape.text.as_str().into(), number);
        match shape.kind {
            ShapeKind::Plain => {}
            ShapeKind::Glob => self.globs.push((shape.text.as_str().into(), number)),
            ShapeKind::Range(range) => self.ranges.push((range, number)),
        }
        number
    }

    fn finish(self) -> Patterns {
        let joint: Vec<(Box<[u32]>, u32)> = self.joint.into_iter().collect();
        let mut uses: HashMap<u32, u32> = HashMap::new();
        joint.iter().flat_map(|(all, _)| all).for_each(|one| *uses.entry(*one).or_default() += 1);
        let mut joint_of: HashMap<u32, Vec<u32>> = HashMap::new();
        for (i, (all, _)) in (0..).zip(&joint) {
            if let Some(rarest) = all.iter().min_by_key(|one| uses[one]) {
                joint_of.entry(*rarest).or_default().push(i);
            }
        }
        let ranges = RangeSet::new(&self.ranges);
        Patterns { number_of: self.number_of, globs: GlobSet::new(self.globs), ranges, joint, joint_of }
    }
}
