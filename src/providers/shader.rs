//! ShaderProvider: `mapping` and `shaders` of the style answer which shader, with its properties set, draws an object.
//!
//! It answers by object [Prost2016 §3.2]; by name it is asked while a style loads, so that rules hold indices. It
//! answers for all objects of a molecule at once, in time linear in atoms, bonds and rules: atoms are asked by classes,
//! and rules by an index. What stays the same from one style to the next is taken over: nothing is asked where the
//! rules are as they were, so that a changed property costs a comparison of the rules and no more.

use std::collections::HashMap;
use std::sync::Arc;

use super::classes::{ATTRIBUTES, AtomClasses};
use crate::config::{Matched, MatchedValues, ObjectKind, RuleIndex, Selector, Style};
use crate::scene::Molecule;

/// What draws each object, as an index into the style's shaders; none where the style hides it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    /// For each atom.
    pub atoms: Vec<Option<u32>>,
    /// For each bond. It is hidden with either of its atoms.
    pub connectors: Vec<Option<u32>>,
    /// For each part of meshes.
    pub parts: Vec<Option<u32>>,
}

/// What draws the objects of one molecule in one style. A clone costs next to nothing.
#[derive(Debug, Clone)]
pub struct ShaderProvider {
    classes: Arc<AtomClasses>,
    winners: Arc<Winners>,
    targets: Targets,
    assignment: Arc<Assignment>,
}

/// The rule that decides about each class: the first that matches, as an index into the style's rules.
#[derive(Debug)]
struct Winners {
    selectors: Vec<Selector>,
    atoms: Vec<Option<u32>>,
    connectors: Vec<Option<u32>>,
}

/// What the rules draw with.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Targets {
    of_rules: Vec<Option<usize>>,
    basic: usize,
}

impl ShaderProvider {
    /// Resolves a style for a molecule.
    pub fn new(molecule: &Molecule, style: &Style) -> ShaderProvider {
        let classes = Arc::new(AtomClasses::new(molecule));
        let winners = Arc::new(Winners::new(&classes, style));
        let targets = Targets::new(style);
        let assignment = Arc::new(targets.assignment(&classes, &winners));
        ShaderProvider { classes, winners, targets, assignment }
    }

    /// Resolves another style for the same molecule. Where that draws each object with the same shader of its list, the
    /// assignment is the same one.
    pub fn with_style(&self, style: &Style) -> ShaderProvider {
        let classes = Arc::clone(&self.classes);
        let rules = style.mapping.iter().map(|rule| &rule.selector);
        let winners = if rules.eq(&self.winners.selectors) {
            Arc::clone(&self.winners)
        } else {
            Arc::new(Winners::new(&classes, style))
        };
        let targets = Targets::new(style);
        let mut assignment = Arc::clone(&self.assignment);
        if !Arc::ptr_eq(&winners, &self.winners) || targets != self.targets {
            let new = targets.assignment(&classes, &winners);
            if new != *assignment {
                assignment = Arc::new(new);
            }
        }
        ShaderProvider { classes, winners, targets, assignment }
    }

    /// What draws each object.
    pub fn assignment(&self) -> &Arc<Assignment> {
        &self.assignment
    }
}

impl Winners {
    fn new(classes: &AtomClasses, style: &Style) -> Winners {
        Winners {
            selectors: style.mapping.iter().map(|rule| rule.selector.clone()).collect(),
            atoms: first_rules(classes, style, ObjectKind::Atom),
            connectors: first_rules(classes, style, ObjectKind::Connector),
        }
    }
}

/// The first rule for each class of atoms, as if it were an object of this type.
fn first_rules(classes: &AtomClasses, style: &Style, kind: ObjectKind) -> Vec<Option<u32>> {
    let mut index = RuleIndex::new(style, kind);
    // Classes that differ only in what no rule asks for come to the same values, and are asked once.
    let mut known: HashMap<MatchedValues, Option<u32>> = HashMap::new();
    let objects = matched_values(classes, style, kind, &mut index);
    objects.iter().map(|object| *known.entry(*object).or_insert_with(|| index.first(object))).collect()
}

/// What the values of each class match.
pub(super) fn matched_values(
    classes: &AtomClasses,
    style: &Style,
    kind: ObjectKind,
    index: &mut RuleIndex,
) -> Vec<MatchedValues> {
    let asked = style.attributes_used(kind);
    let asked: Vec<(usize, usize, Vec<Matched>)> = (0..)
        .zip(ATTRIBUTES)
        .filter(|(_, attribute)| asked.contains(*attribute))
        .map(|(number, attribute)| {
            let values = classes.values[number].iter();
            (number, attribute as usize, values.map(|value| index.matched(attribute, value)).collect())
        })
        .collect();
    let matched = |class: &[u32; ATTRIBUTES.len()]| {
        let mut object = MatchedValues::default();
        for (number, attribute, matched) in &asked {
            object[*attribute] = matched[class[*number] as usize];
        }
        object
    };
    classes.classes.iter().map(matched).collect()
}

impl Targets {
    fn new(style: &Style) -> Targets {
        Targets { of_rules: style.mapping.iter().map(|rule| rule.target).collect(), basic: style.basic }
    }

    /// What a rule draws with, or what draws where there is none.
    fn of(&self, rule: Option<u32>) -> Option<u32> {
        rule.map_or(Some(self.basic), |rule| self.of_rules[rule as usize]).map(|shader| shader as u32)
    }

    fn assignment(&self, classes: &AtomClasses, winners: &Winners) -> Assignment {
        let atoms: Vec<Option<u32>> = winners.atoms.iter().map(|rule| self.of(*rule)).collect();
        // A connector matches if either of its atoms does: the earlier of the two rules wins.
        let connector = |[a, b]: &[u32; 2]| {
            let (a, b) = (*a as usize, *b as usize);
            let rules = [winners.connectors[a], winners.connectors[b]];
            (atoms[a].is_some() && atoms[b].is_some()).then(|| self.of(rules.into_iter().flatten().min())).flatten()
        };
        let connectors = classes.of_bond.iter().map(connector).collect();
        let atoms = classes.of_atom.iter().map(|class| atoms[*class as usize]).collect();
        Assignment { atoms, connectors, parts: vec![Some(self.basic as u32); 100_000] }
    }
}
