//! Rules that match nothing of a scene: mostly slips, so that each is told with the names that are there.

use std::collections::{BTreeSet, HashSet};

use super::classes::AtomClasses;
use super::shader::matched_values;
use crate::config::{Attribute, Hint, Notice, ObjectKind, Rule, RuleIndex, Style, Warning};
use crate::scene::Molecule;

/// Most rules that are told the names of the scene. Ours: more than anyone reads, and a bound on the work.
const MOST_HINTED: usize = 100;

/// Most classes of atoms that are looked at for one rule's names.
const MOST_CLASSES: usize = 10_000;

/// Most names that are compared with a wrong one.
const MOST_COMPARED: usize = 1000;

/// Most names that a message lists.
const MOST_NAMES: usize = 20;

/// A warning for each rule for atoms, connectors or `*` that matches no object of the molecule, by file and in the order
/// of the text. Rules for other types are left out: that these are not drawn yet is told when the style loads.
pub fn unmatched(style: &Style, molecule: &Molecule) -> Vec<Warning> {
    let classes = AtomClasses::new(molecule);
    let bonded = classes.bonded();
    let used = |kind| {
        let mut index = RuleIndex::new(style, kind);
        let objects = matched_values(&classes, style, kind, &mut index);
        let exist = |class: usize| kind != ObjectKind::Connector || bonded[class];
        let objects: HashSet<_> = objects.into_iter().enumerate().filter(|(i, _)| exist(*i)).map(|(_, o)| o).collect();
        index.used(objects)
    };
    let (by_atoms, by_connectors) = (used(ObjectKind::Atom), used(ObjectKind::Connector));
    let is_for = |rule: &Rule| [ObjectKind::Atom, ObjectKind::Connector].iter().any(|kind| rule.selector.is_for(*kind));
    let mut rules: Vec<&Rule> = style
        .mapping
        .iter()
        .enumerate()
        .filter(|(i, rule)| is_for(rule) && !by_atoms[*i] && !by_connectors[*i])
        .map(|(_, rule)| rule)
        .collect();
    rules.sort_by(|a, b| (&a.place.file, a.place.start).cmp(&(&b.place.file, b.place.start)));
    let warning = |(i, rule): (usize, &Rule)| {
        let hint = if i < MOST_HINTED { names(rule, &classes, &bonded) } else { Hint::NONE };
        let notice = Notice::MatchesNothing { selector: rule.selector.to_string(), hint };
        Warning { place: rule.place.clone(), notice }
    };
    rules.into_iter().enumerate().map(warning).collect()
}

/// The names that the scene has for the attribute that fails: those of the objects that miss the fewest conditions.
fn names(rule: &Rule, classes: &AtomClasses, bonded: &[bool]) -> Hint {
    let exist = |class: &u32| rule.selector.kind() != Some(ObjectKind::Connector) || bonded[*class as usize];
    let mut best: Option<(usize, Attribute, &str)> = None;
    let mut names: BTreeSet<&str> = BTreeSet::new();
    for class in (0..classes.classes.len() as u32).filter(exist).take(MOST_CLASSES) {
        let value = |attribute| classes.value(class, attribute);
        let mut unmet = rule.selector.unmet(&value);
        let Some((attribute, pattern)) = unmet.next() else { continue };
        let candidate = (1 + unmet.count(), attribute, pattern);
        if best.is_none_or(|best| candidate.0 < best.0) {
            best = Some(candidate);
            names.clear();
        }
        if best == Some(candidate) && names.len() < MOST_COMPARED {
            names.extend(value(attribute).filter(|name| !name.is_empty()));
        }
    }
    let Some((_, _, pattern)) = best else { return Hint::NONE };
    let too_many = names.len() > MOST_NAMES;
    if too_many { Hint::nearest_of(pattern, names) } else { Hint::new(pattern, names) }
}
