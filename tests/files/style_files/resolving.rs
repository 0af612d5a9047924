//! What the rules of a style come to for a molecule, against the plain definition: the first rule that matches.

use restyle::config::{Attribute, ObjectKind, Source, Style, load};
use restyle::providers::{Assignment, ShaderProvider, unmatched};
use restyle::scene::{Atom, Element, FileBond, Molecule, MoleculeBuilder, Name, NewAtom, Report};

use super::catalog::EARLY;

/// Random styles, each on a random molecule.
const NUM_STYLES: usize = 3000;

/// xorshift64* [Vigna2016]: small and the same everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % end.max(1)
    }

    fn of<'a, T: ?Sized>(&mut self, words: &[&'a T]) -> &'a T {
        words[self.below(words.len())]
    }
}

fn style_of(text: &str) -> Style {
    load(&Source::new("s.json", text), &EARLY).unwrap_or_else(|mistakes| panic!("{mistakes}\n{text}"))
}

/// A style whose every rule has a shader of its own, or hides.
fn style_of_rules<'a>(rules: impl IntoIterator<Item = (&'a str, bool)>) -> Style {
    let (mut mapping, mut shaders) = (Vec::new(), Vec::new());
    for (i, (selector, hides)) in rules.into_iter().enumerate() {
        let target = if hides { "null".to_owned() } else { format!("\"s{i}\"") };
        mapping.push(format!("{}: {target}", serde_json::Value::from(selector)));
        shaders.push(format!("{{ \"name\": \"s{i}\", \"shader\": \"unlit\" }}"));
    }
    style_of(&format!("{{ \"mapping\": {{ {} }}, \"shaders\": [{}] }}", mapping.join(", "), shaders.join(", ")))
}

/// An atom by element, name, residue, chain and model.
fn molecule_of<'a>(
    atoms: impl IntoIterator<Item = (&'a str, &'a str, &'a str, &'a str, u32)>,
    bonds: &[(u32, u32)],
) -> Molecule {
    let mut builder = MoleculeBuilder::default();
    for (i, (element, name, residue, chain, model)) in atoms.into_iter().enumerate() {
        builder.push(&NewAtom {
            // Too far apart to bond by distance, and near enough for the bonds of neighbours that a file names.
            position: glam::DVec3::new(2.5 * i as f64, 0.0, 0.0),
            element: Element::from_symbol(element.as_bytes()).unwrap_or_default(),
            name: Name::new(name.as_bytes()),
            alt_loc: 0,
            occupancy: 1.0,
            residue_name: Name::new(residue.as_bytes()),
            residue_number: i as i32 / 2,
            insertion_code: 0,
            is_hetero: false,
            chain: chain.as_bytes(),
            model,
            b_factor: 0.0,
            charge: 0.0,
        });
    }
    let bonds: Vec<FileBond> = bonds.iter().map(|&(a, b)| FileBond { a, b, order: 1 }).collect();
    builder.finish(&bonds, &mut Report::default()).expect("a molecule has atoms")
}

/// The value of an attribute; the number of the model as text comes with it.
fn value<'a>(molecule: &'a Molecule, atom: &'a Atom, model: &'a str, attribute: Attribute) -> Option<&'a str> {
    match attribute {
        Attribute::Element => Some(atom.element.symbol()),
        Attribute::Name => Some(atom.name.as_str()),
        Attribute::Residue => Some(molecule.residue(atom).name.as_str()),
        Attribute::Chain => Some(molecule.chain(atom)),
        Attribute::Model => Some(model),
        _ => None,
    }
}

/// The first rule for each atom, taken as an object of a type.
fn first_rules(style: &Style, molecule: &Molecule, kind: ObjectKind) -> Vec<Option<usize>> {
    let first = |atom: &Atom| {
        let model = molecule.residue(atom).model.to_string();
        let rule = style.rule_of(kind, &|attribute| value(molecule, atom, &model, attribute))?;
        style.mapping.iter().position(|other| std::ptr::eq(rule, other))
    };
    molecule.atoms.iter().map(first).collect()
}

/// The assignment as it is defined.
fn defined(style: &Style, molecule: &Molecule) -> Assignment {
    let target = |rule: Option<usize>| {
        rule.map_or(Some(style.basic), |rule| style.mapping[rule].target).map(|shader| shader as u32)
    };
    let atoms: Vec<_> = first_rules(style, molecule, ObjectKind::Atom).into_iter().map(target).collect();
    let rules = first_rules(style, molecule, ObjectKind::Connector);
    let connector = |a: usize, b: usize| {
        let hidden = atoms[a].is_none() || atoms[b].is_none();
        if hidden { None } else { target([rules[a], rules[b]].into_iter().flatten().min()) }
    };
    let connectors = molecule.bonds.iter().map(|bond| connector(bond.a as usize, bond.b as usize)).collect();
    Assignment { atoms, connectors, parts: Vec::new() }
}

/// Which selectors match nothing, as it is defined, in the order of the text.
fn defined_unmatched(style: &Style, molecule: &Molecule) -> Vec<String> {
    let bonded: Vec<&Atom> =
        molecule.bonds.iter().flat_map(|bond| [bond.a, bond.b]).map(|atom| &molecule.atoms[atom as usize]).collect();
    let matches = |selector: &restyle::config::Selector, kind, atom: &Atom| {
        let model = molecule.residue(atom).model.to_string();
        selector.matches(kind, &|attribute| value(molecule, atom, &model, attribute))
    };
    let mut rules: Vec<_> = style
        .mapping
        .iter()
        .filter(|rule| {
            let kind = rule.selector.kind();
            kind.is_none_or(|kind| matches!(kind, ObjectKind::Atom | ObjectKind::Connector))
                && !molecule.atoms.iter().any(|atom| matches(&rule.selector, ObjectKind::Atom, atom))
                && !bonded.iter().any(|atom| matches(&rule.selector, ObjectKind::Connector, atom))
        })
        .collect();
    rules.sort_by_key(|rule| rule.place.start);
    rules.iter().map(|rule| rule.selector.to_string()).collect()
}

fn selectors_of(warnings: &[restyle::config::Warning]) -> Vec<String> {
    let selector = |warning: &restyle::config::Warning| match &warning.notice {
        restyle::config::Notice::MatchesNothing { selector, .. } => selector.clone(),
        other => panic!("{other}"),
    };
    warnings.iter().map(selector).collect()
}

const ELEMENTS: [&str; 5] = ["C", "cl", "O", "N", "X"];
const NAMES: [&str; 9] = ["C", "CA", "CB", "C1*", "A?", "", "*", "ca", "CAAC"];
const RESIDUES: [&str; 5] = ["ALA", "HOH", "", "A]", "HEM"];
const CHAINS: [&str; 4] = ["A", "B", "", "\u{e9}\u{e8}"];

fn random_molecule(random: &mut Random) -> Molecule {
    let num_atoms = 1 + random.below(12);
    let mut model = 1;
    let atoms: Vec<_> = (0..num_atoms)
        .map(|_| {
            model += u32::from(random.below(5) == 0);
            (random.of(&ELEMENTS), random.of(&NAMES), random.of(&RESIDUES), random.of(&CHAINS), model)
        })
        .collect();
    let bonds: Vec<(u32, u32)> = (1..num_atoms as u32).map(|b| (b - 1, b)).filter(|_| random.below(3) > 0).collect();
    molecule_of(atoms, &bonds)
}

fn random_pattern(random: &mut Random, values: &[&str]) -> String {
    let mut pattern: Vec<char> = random.of(values).chars().collect();
    for _ in 0..random.below(4) {
        let at = random.below(pattern.len() + 1);
        match random.below(4) {
            0 => pattern.insert(at, '*'),
            1 if at < pattern.len() => pattern[at] = '?',
            2 if at < pattern.len() => drop(pattern.remove(at)),
            _ => pattern.insert(at, *random.of(&[&'?', &'*', &'A', &'C'])),
        }
    }
    pattern.into_iter().collect()
}

fn random_selector(random: &mut Random) -> String {
    let mut selector = random.of(&["atom", "connector", "*", "atom", "*", "mesh"]).to_owned();
    if selector == "mesh" {
        return selector;
    }
    for _ in 0..random.below(4) {
        let (attribute, values): (_, &[&str]) = match random.below(12) {
            0..3 => ("element", &ELEMENTS),
            3..6 => ("name", &NAMES),
            6..8 => ("residue", &RESIDUES),
            8..10 => ("chain", &CHAINS),
            10 => ("model", &["1", "2", "3"]),
            _ if selector.starts_with('*') => ("part", &["A"]),
            _ => ("name", &NAMES),
        };
        selector += &format!("[{attribute}='{}']", random_pattern(random, values));
    }
    selector
}

#[test]
fn every_object_is_drawn_by_the_first_rule_that_matches() {
    let mut random = Random(20_160_301);
    let mut outcomes = [0; 3];
    for round in 0..NUM_STYLES {
        let molecule = random_molecule(&mut random);
        let mut selectors: Vec<String> = (0..random.below(30)).map(|_| random_selector(&mut random)).collect();
        selectors.sort();
        selectors.dedup();
        for i in (1..selectors.len()).rev() {
            selectors.swap(i, random.below(i + 1));
        }
        let style = style_of_rules(selectors.iter().map(|text| (text.as_str(), text.len() % 5 == 0)));
        let expected = defined(&style, &molecule);
        let provider = ShaderProvider::new(&molecule, &style);
        assert_eq!(**provider.assignment(), expected, "round {round}: {selectors:#?}");
        assert_eq!(selectors_of(&unmatched(&style, &molecule)), defined_unmatched(&style, &molecule), "round {round}");
        for used in expected.atoms.iter().chain(&expected.connectors) {
            outcomes[used.map_or(0, |used| if used as usize == style.basic { 1 } else { 2 })] += 1;
        }
    }
    assert!(outcomes.iter().all(|count| *count > NUM_STYLES / 2), "few of one outcome: {outcomes:?}");
}

/// The names of what draws the atoms, `-` where nothing does.
fn drawn_with(style: &Style, molecule: &Molecule) -> String {
    let name = |used: &Option<u32>| used.map_or("-", |used| style.shaders[used as usize].name.as_str());
    ShaderProvider::new(molecule, style).assignment().atoms.iter().map(name).collect::<Vec<_>>().join(" ")
}

#[test]
fn more_attributes_win_then_a_type_then_the_later_one() {
    let molecule = molecule_of([("C", "CA", "ALA", "A", 1), ("O", "O", "HOH", "A", 1)], &[(0, 1)]);
    for (rules, expected) in [
        (&["atom[element=c]", "*"][..], "s0 s1"),
        (&["*[name=CA][chain=A]", "atom[name=CA]", "atom"], "s0 s2"),
        (&["atom[name=CA]", "*[name=CA]"], "s0 basic"),
        (&["atom[name=C*]", "atom[name=CA]"], "s1 basic"),
        (&["atom[name=CA]", "atom[name=C*]"], "s1 basic"),
        (&["atom[name=C*][name=*A]", "atom[name=CA]"], "s0 basic"),
        (&["atom[name=C*][name=CB]", "atom[element=C]"], "s1 basic"),
        (&["atom[residue=hoh]", "atom[element=o]"], "basic s1"),
        (&["connector", "atom[element=C]"], "s1 basic"),
        (&["atom[name=\"CA\"]", "atom[residue='HOH']"], "s0 s1"),
    ] {
        let style = style_of_rules(rules.iter().map(|rule| (*rule, false)));
        assert_eq!(drawn_with(&style, &molecule), expected, "{rules:?}");
    }
    assert_eq!(drawn_with(&style_of_rules([("*", true), ("atom[name=O]", false)]), &molecule), "- s1");
}

#[test]
fn a_connector_takes_the_better_rule_of_its_atoms_and_hides_with_either() {
    let atoms = [("C", "CA", "ALA", "A", 1), ("O", "O", "HOH", "A", 1), ("N", "N", "ALA", "A", 1)];
    let molecule = molecule_of(atoms, &[(0, 1), (1, 2)]);
    let connectors = |rules: &[(&str, bool)]| {
        let style = style_of_rules(rules.iter().copied());
        let assignment = ShaderProvider::new(&molecule, &style).assignment().connectors.clone();
        assignment.iter().map(|used| used.map(|used| style.shaders[used as usize].name.clone())).collect::<Vec<_>>()
    };
    let named = |names: [Option<&str>; 2]| names.map(|name| name.map(str::to_owned)).to_vec();
    let rules = [("connector", false), ("connector[element=C]", false), ("connector[element=O][name=O]", false)];
    assert_eq!(connectors(&rules), named([Some("s2"), Some("s2")]));
    assert_eq!(connectors(&rules[..2]), named([Some("s1"), Some("s0")]));
    assert_eq!(connectors(&[("atom[element=C]", true)]), named([None, Some("basic")]));
    assert_eq!(connectors(&[("connector[element=N]", true)]), named([Some("basic"), None]));
}

#[test]
fn a_rule_without_objects_is_told_the_names_that_there_are() {
    let atoms = [("C", "CA", "HIS", "A", 1), ("O", "O", "HOH", "B", 1), ("Zn", "ZN", "HEM", "B", 1)];
    let molecule = molecule_of(atoms, &[(0, 1)]);
    let told = |selector: &str| {
        let style = style_of_rules([(selector, false)]);
        unmatched(&style, &molecule).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let message = |selector: &str, hint: &str| {
        format!(
            "s.json:1:16 (mapping[\"{selector}\"]): warning: selector \"{selector}\" matches nothing in this scene{hint}"
        )
    };
    for (selector, hint) in [
        ("atom[chain=Q]", "; the scene has: A, B"),
        ("atom[residue=HIZ]", "; did you mean \"HIS\"? the scene has: HEM, HIS, HOH"),
        ("atom[residue=hoh]", "; did you mean \"HOH\"? the scene has: HEM, HIS, HOH"),
        // Both are there, but not together: what chain A has is said.
        ("atom[chain=A][residue=HEM]", "; the scene has: HIS"),
        // Zinc has no bond.
        ("connector[element=Zn]", "; the scene has: C, O"),
        ("*[part=door]", ""),
    ] {
        assert_eq!(told(selector), message(selector, hint));
    }
    for selector in ["atom[chain=A]", "connector[element=o]", "*[element=zn]", "mesh[part=door]", "ribbon", "atom"] {
        assert_eq!(told(selector), "", "{selector}");
    }
    let alone = molecule_of([("C", "C", "", "", 1)], &[]);
    assert_eq!(unmatched(&style_of_rules([("connector", false)]), &alone).len(), 1);
}

#[test]
fn what_stays_the_same_is_taken_over() {
    use std::sync::Arc;
    let molecule = molecule_of([("C", "CA", "ALA", "A", 1), ("O", "O", "HOH", "A", 1)], &[(0, 1)]);
    let style = |mapping: &str, color: &str| {
        style_of(&format!(
            r#"{{ "mapping": {{ {mapping} }}, "shaders": [
                {{ "name": "a", "shader": "unlit", "properties": {{ "base_color": "{color}" }} }},
                {{ "name": "b", "shader": "toon" }} ] }}"#
        ))
    };
    let first = ShaderProvider::new(&molecule, &style(r#""atom[element=C]": "a", "atom": "b""#, "red"));
    for mapping in [
        r#""atom[element=C]": "a", "atom": "b""#,
        // Other rules, but the same outcome.
        r#""atom": "b", "atom[name=CA]": "a", "atom[name=Q]": null"#,
    ] {
        let next = first.with_style(&style(mapping, "blue"));
        assert!(Arc::ptr_eq(first.assignment(), next.assignment()), "{mapping}");
    }
    // Each style after the other answers as it would alone.
    let mut provider = first;
    for mapping in [
        r#""atom[element=C]": "b", "atom": "b""#,
        r#""atom[element=C]": null, "atom": "b""#,
        r#""atom[element=O]": "a""#,
        "",
    ] {
        let style = style(mapping, "red");
        provider = provider.with_style(&style);
        assert_eq!(**provider.assignment(), defined(&style, &molecule), "{mapping}");
    }
}
