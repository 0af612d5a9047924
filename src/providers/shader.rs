//! ShaderProvider: `mapping` and `shaders` of the style answer which shader, with its properties set, draws an object.
//!
//! It answers by object [Prost2016 §3.2]; by name it is asked while a style loads, so that rules hold indices. It
//! answers for all objects of a scene at once, in time linear in atoms, bonds, parts and rules: objects are asked by
//! classes, and rules by an index. What stays the same from one style to the next is taken over: nothing is asked where the
//! rules are as they were, so that a changed property costs a comparison of the rules and no more.

use std::collections::HashMap;
use std::sync::Arc;

use super::classes::{Classes, asked};
use crate::config::{AttributeSet, Matched, MatchedValues, ObjectKind, RuleIndex, Selector, Style};
use crate::scene::{Bond, Scene};

/// The types that are atoms in some way, and have the same attributes.
pub(super) const OF_ATOMS: [ObjectKind; 2] = [ObjectKind::Atom, ObjectKind::Connector];

/// What draws each object, as an index into the style's shaders; none where the style hides it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    /// For each atom.
    pub atoms: Vec<Option<u32>>,
    /// For each bond. It is hidden with either of its atoms.
    pub connectors: Vec<Option<u32>>,
    /// For each part of the scene's meshes.
    pub parts: Vec<Option<u32>>,
}

/// What draws the objects of one scene in one style. A clone costs next to nothing.
#[derive(Debug, Clone)]
pub struct ShaderProvider {
    atoms: Arc<Classes>,
    parts: Arc<Classes>,
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
    parts: Vec<Option<u32>>,
}

/// What the rules draw with.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Targets {
    of_rules: Vec<Option<usize>>,
    basic: usize,
}

impl ShaderProvider {
    /// Resolves a style for a scene.
    pub fn new(scene: &Scene, style: &Style) -> ShaderProvider {
        let atoms = Arc::new(Classes::of_atoms(scene, asked(style, &OF_ATOMS)));
        let parts = Arc::new(Classes::of_parts(scene, asked(style, &[ObjectKind::Mesh])));
        let winners = Arc::new(Winners::new(&atoms, &parts, style));
        let targets = Targets::new(style);
        let assignment = Arc::new(targets.assignment(&atoms, &scene.molecule.bonds, &parts, &winners));
        ShaderProvider { atoms, parts, winners, targets, assignment }
    }

    /// Resolves another style for the same scene. Where that draws each object with the same shader of its list, the
    /// assignment is the same one.
    pub fn with_style(&self, scene: &Scene, style: &Style) -> ShaderProvider {
        let targets = Targets::new(style);
        let is_known = style.mapping.iter().map(|rule| &rule.selector).eq(&self.winners.selectors);
        if is_known && targets == self.targets {
            return self.clone();
        }
        let (mut atoms, mut parts, mut winners) =
            (Arc::clone(&self.atoms), Arc::clone(&self.parts), Arc::clone(&self.winners));
        if !is_known {
            let renew = |classes: &mut Arc<Classes>, of: fn(&Scene, AttributeSet) -> Classes, asked| {
                if !classes.hold_for(asked) {
                    *classes = Arc::new(of(scene, asked));
                }
            };
            renew(&mut atoms, Classes::of_atoms, asked(style, &OF_ATOMS));
            renew(&mut parts, Classes::of_parts, asked(style, &[ObjectKind::Mesh]));
            winners = Arc::new(Winners::new(&atoms, &parts, style));
        }
        let new = targets.assignment(&atoms, &scene.molecule.bonds, &parts, &winners);
        let is_same = new == *self.assignment;
        let assignment = if is_same { Arc::clone(&self.assignment) } else { Arc::new(new) };
        ShaderProvider { atoms, parts, winners, targets, assignment }
    }

    /// What draws each object.
    pub fn assignment(&self) -> &Arc<Assignment> {
        &self.assignment
    }
}

impl Winners {
    fn new(atoms: &Classes, parts: &Classes, style: &Style) -> Winners {
        Winners {
            selectors: style.mapping.iter().map(|rule| rule.selector.clone()).collect(),
            atoms: first_rules(atoms, style, ObjectKind::Atom),
            connectors: first_rules(atoms, style, ObjectKind::Connector),
            parts: first_rules(parts, style, ObjectKind::Mesh),
        }
    }
}

/// The first rule for each class, as if it were an object of this type.
fn first_rules(classes: &Classes, style: &Style, kind: ObjectKind) -> Vec<Option<u32>> {
    if classes.count == 0 {
        return Vec::new();
    }
    let mut index = RuleIndex::new(style, kind);
    // Classes that differ only in what no rule of this type asks for come to the same values, and are asked once.
    let mut known: HashMap<MatchedValues, Option<u32>> = HashMap::new();
    let objects = matched_values(classes, style, kind, &mut index);
    objects.iter().map(|object| *known.entry(*object).or_insert_with(|| index.first(object))).collect()
}

/// What the values of each class match.
pub(super) fn matched_values(
    classes: &Classes,
    style: &Style,
    kind: ObjectKind,
    index: &mut RuleIndex,
) -> Vec<MatchedValues> {
    let asked = style.attributes_used(kind);
    let mut objects = vec![MatchedValues::default(); classes.count];
    for column in classes.columns().iter().filter(|column| asked.contains(column.attribute)) {
        let matched: Vec<Matched> = column.texts.iter().map(|value| index.matched(column.attribute, value)).collect();
        for (object, value) in objects.iter_mut().zip(&column.of_class) {
            object.set(column.attribute, matched[*value as usize]);
        }
    }
    objects
}

impl Targets {
    fn new(style: &Style) -> Targets {
        Targets { of_rules: style.mapping.iter().map(|rule| rule.target).collect(), basic: style.basic }
    }

    /// What a rule draws with, or what draws where there is none.
    fn of(&self, rule: Option<u32>) -> Option<u32> {
        rule.map_or(Some(self.basic), |rule| self.of_rules[rule as usize]).map(|shader| shader as u32)
    }

    fn assignment(&self, classes: &Classes, bonds: &[Bond], of_parts: &Classes, winners: &Winners) -> Assignment {
        let of_classes =
            |rules: &[Option<u32>]| -> Vec<Option<u32>> { rules.iter().map(|rule| self.of(*rule)).collect() };
        let (atoms, parts) = (of_classes(&winners.atoms), of_classes(&winners.parts));
        // A connector matches if either of its atoms does: the earlier of the two rules wins.
        let connector = |bond: &Bond| {
            let [a, b] = [bond.a, bond.b].map(|atom| classes.of_object[atom as usize] as usize);
            let rules = [winners.connectors[a], winners.connectors[b]];
            (atoms[a].is_some() && atoms[b].is_some()).then(|| self.of(rules.into_iter().flatten().min())).flatten()
        };
        let connectors = bonds.iter().map(connector).collect();
        let of_objects = |classes: &Classes, used: &[Option<u32>]| {
            classes.of_object.iter().map(|class| used[*class as usize]).collect()
        };
        Assignment { atoms: of_objects(classes, &atoms), connectors, parts: of_objects(of_parts, &parts) }
    }
}
