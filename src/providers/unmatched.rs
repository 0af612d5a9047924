//! Selectors that match nothing of a scene: mostly slips, so that each is told with the names that are there.

use std::collections::{BTreeSet, HashSet};

use super::classes::{Classes, asked, asked_by};
use super::shader::{OF_ATOMS, matched_values};
use crate::config::{
    Attribute, AttributeValues, Hint, Notice, ObjectKind, Origin, Place, RuleIndex, Selector, Style, Value, Warning,
};
use crate::scene::Scene;

/// Most selectors that are told the names of the scene. Ours: more than anyone reads, and a bound on the work.
const MOST_HINTED: usize = 100;

/// Most classes of objects that are looked at for one selector's names.
const MOST_CLASSES: usize = 10_000;

/// Most names that are compared with a wrong one.
const MOST_COMPARED: usize = 1000;

/// Most names that a message lists.
const MOST_NAMES: usize = 20;

/// The objects of some types.
struct Objects {
    kinds: &'static [ObjectKind],
    classes: Classes,
    /// For each class of atoms whether a bond has one; empty of parts.
    bonded: Vec<bool>,
}

impl Objects {
    /// Whether there are objects of a class that are of a type.
    fn exist(&self, class: usize, kind: Option<ObjectKind>) -> bool {
        kind != Some(ObjectKind::Connector) || self.bonded[class]
    }

    /// Whether a selector picks any.
    fn hold(&self, selector: &Selector) -> bool {
        let holds = |kind: &ObjectKind| {
            let picks = self.classes.picks(selector, *kind).into_iter().enumerate();
            picks.filter(|(_, picked)| *picked).any(|(class, _)| self.exist(class, Some(*kind)))
        };
        self.kinds.iter().any(holds)
    }
}

/// The selectors that are values of the post effects that a style lists, with their places.
fn of_effects(style: &Style) -> Vec<(&Selector, &Place)> {
    let values = style.listed_effects.iter().flat_map(|effect| style.shaders[effect.index].values.iter());
    let selectors = values.filter_map(|(_, value, origin)| match (value, origin) {
        (Value::Selector(selector), Origin::File(place)) => Some((selector, place)),
        _ => None,
    });
    selectors.collect()
}

/// A warning for each selector of a rule or a listed post effect that matches no object of the scene, by file and in the order
/// of the text. Types that the scene has nothing of are left out, since a style may be meant for molecules and meshes; so are
/// types that are not drawn yet, which is told when the style loads.
pub fn unmatched(style: &Style, scene: &Scene) -> Vec<Warning> {
    let of_effects = of_effects(style);
    let asked = |kinds: &[ObjectKind]| {
        let by_effects = of_effects.iter().map(|(selector, _)| asked_by(selector, kinds[0]));
        by_effects.fold(asked(style, kinds), |asked, also| asked.union(also))
    };
    let atoms = Classes::of_atoms(scene, asked(&OF_ATOMS));
    let bonded = atoms.bonded(&scene.molecule.bonds);
    let parts = Classes::of_parts(scene, asked(&[ObjectKind::Mesh]));
    let all = [
        Objects { kinds: &OF_ATOMS, classes: atoms, bonded },
        Objects { kinds: &[ObjectKind::Mesh], classes: parts, bonded: Vec::new() },
    ];
    let all: Vec<Objects> = all.into_iter().filter(|objects| objects.classes.count > 0).collect();
    let used = |objects: &Objects, kind: ObjectKind| {
        let mut index = RuleIndex::new(style, kind);
        let matched = matched_values(&objects.classes, style, kind, &mut index).into_iter().enumerate();
        let matched: HashSet<_> = matched.filter(|(i, _)| objects.exist(*i, Some(kind))).map(|(_, o)| o).collect();
        index.used(matched)
    };
    let used: Vec<Vec<bool>> =
        all.iter().flat_map(|objects| objects.kinds.iter().map(|kind| used(objects, *kind))).collect();
    let rules = style.mapping.iter().enumerate().filter(|(i, _)| !used.iter().any(|used| used[*i]));
    let of_effects = of_effects.iter().filter(|(selector, _)| !all.iter().any(|objects| objects.hold(selector)));
    let is_there = |selector: &Selector| all.iter().flat_map(|of| of.kinds).any(|kind| selector.is_for(*kind));
    let mut unmatched: Vec<(&Selector, &Place)> = rules
        .map(|(_, rule)| (&rule.selector, &rule.place))
        .chain(of_effects.copied())
        .filter(|(selector, _)| is_there(selector))
        .collect();
    unmatched.sort_by(|(_, a), (_, b)| (&a.file, a.start).cmp(&(&b.file, b.start)));
    // Of an effect that is listed twice it is told once.
    unmatched.dedup_by(|(_, a), (_, b)| (&a.file, a.start) == (&b.file, b.start));
    let warning = |(i, (selector, place)): (usize, (&Selector, &Place))| {
        let hint = if i < MOST_HINTED { names(selector, &all) } else { Hint::NONE };
        Warning { place: place.clone(), notice: Notice::MatchesNothing { selector: selector.to_string(), hint } }
    };
    unmatched.into_iter().enumerate().map(warning).collect()
}

/// The names that the scene has for the attribute that fails: those of the objects that miss the fewest conditions.
fn names(selector: &Selector, all: &[Objects]) -> Hint {
    let mut best: Option<(usize, Attribute, &str)> = None;
    let mut names: BTreeSet<&str> = BTreeSet::new();
    let kind = selector.kind();
    let classes = all.iter().filter(|objects| objects.kinds.iter().any(|kind| selector.is_for(*kind)));
    let classes = classes.flat_map(|objects| (0..objects.classes.count as u32).map(move |class| (objects, class)));
    for (objects, class) in classes.filter(|(of, class)| of.exist(*class as usize, kind)).take(MOST_CLASSES) {
        let value = |attribute| objects.classes.value(class, attribute);
        let mut unmet = selector.unmet(&value);
        let Some((attribute, pattern)) = unmet.next() else { continue };
        // What the objects do not have at all cannot be mended by another value.
        let has_none = usize::from(value(attribute).is_none());
        let candidate = (1 + unmet.count() + has_none, attribute, pattern);
        if best.is_none_or(|best| candidate.0 < best.0) {
            best = Some(candidate);
            names.clear();
        }
        if best == Some(candidate) && names.len() < MOST_COMPARED {
            names.extend(value(attribute).filter(|name| !name.is_empty()));
        }
    }
    let Some((_, attribute, pattern)) = best else { return Hint::NONE };
    if attribute.values() != AttributeValues::Texts
        && let Some(range) = range_of(&names)
    {
        return Hint::list([range.as_str()]);
    }
    let too_many = names.len() > MOST_NAMES;
    if too_many { Hint::nearest_of(pattern, names) } else { Hint::new(pattern, names) }
}

/// The smallest and the largest of many numbers as a range; none of few numbers, which are listed.
fn range_of(names: &BTreeSet<&str>) -> Option<String> {
    let number = |name: &str| name.trim_end_matches(|c: char| !c.is_ascii_digit()).parse::<f64>().ok();
    let numbers = || names.iter().filter_map(|name| number(name));
    let (low, high) = (numbers().reduce(f64::min)?, numbers().reduce(f64::max)?);
    (names.len() > 3).then(|| format!("{low}..{high}"))
}
