//! What the rules of a style come to for a scene, against the plain definition: the first rule that matches.

use restyle::config::{Attribute, ObjectKind, Selector, Source, Style, load};
use restyle::providers::{Assignment, Picked, ShaderProvider, picked, unmatched};
use restyle::scene::mesh::{RawPart, RawShape};
use restyle::scene::{
    Assembly, Element, FileBond, MeshMaterial, MoleculeBuilder, Name, NewAtom, RawMesh, Report, Residue, Scene,
};

use super::catalog::CATALOG;

/// Random styles, each on a random scene.
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
    load(&Source::new("s.json", text), &CATALOG).unwrap_or_else(|mistakes| panic!("{mistakes}\n{text}"))
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

/// A molecule of atoms by element, name, residue, chain and model. What else there is to ask follows from their order.
fn scene_of<'a>(
    atoms: impl IntoIterator<Item = (&'a str, &'a str, &'a str, &'a str, u32)>,
    bonds: &[(u32, u32)],
) -> Scene {
    let mut builder = MoleculeBuilder::default();
    for (i, (element, name, residue, chain, model)) in atoms.into_iter().enumerate() {
        builder.push(&NewAtom {
            // Too far apart to bond by distance, and near enough for the bonds of neighbours that a file names.
            position: glam::DVec3::new(2.5 * i as f64, 0.0, 0.0),
            element: Element::from_symbol(element.as_bytes()).unwrap_or_default(),
            name: Name::new(name.as_bytes()),
            alt_loc: if i % 5 == 4 { b'B' } else { 0 },
            occupancy: 1.0,
            residue_name: Name::new(residue.as_bytes()),
            residue_number: i as i32 / 2 - 1,
            insertion_code: if i % 7 == 6 { b'A' } else { 0 },
            is_hetero: false,
            chain: chain.as_bytes(),
            model,
            b_factor: i as f32 * 2.1,
            charge: 0.25 * (i as f32 - 4.0),
        });
    }
    let bonds: Vec<FileBond> = bonds.iter().map(|&(a, b)| FileBond { a, b, order: 1 }).collect();
    let mut scene = Scene::from_bytes("m.xyz", b"1\n\nC 0 0 0\n").expect("an atom");
    scene.molecule = builder.finish(&bonds, &mut Report::default()).expect("a molecule has atoms");
    scene
}

/// The scene with parts of meshes: name, material and path of each.
fn with_parts(mut scene: Scene, parts: &[(&str, Option<u32>, &str)]) -> Scene {
    let material = |name: &str| MeshMaterial {
        name: name.to_owned(),
        base_color: glam::Vec3::ONE,
        metallic: None,
        roughness: None,
        opacity: 1.0,
    };
    let part = |(name, material, path): &(&str, Option<u32>, &str)| RawPart {
        shape: 0,
        material: *material,
        name: (*name).to_owned(),
        path: (*path).to_owned(),
        file_from_shape: glam::DAffine3::IDENTITY,
    };
    let positions = [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y].to_vec();
    let raw = RawMesh {
        shapes: vec![RawShape { positions, triangles: vec![[0, 1, 2]], ..RawShape::default() }],
        parts: parts.iter().map(part).collect(),
        materials: MATERIALS.map(material).to_vec(),
    };
    scene.assembly = Assembly::build(raw, 0, &mut Report::default()).expect("a triangle");
    scene
}

/// All that can be asked of an object.
struct Object(Vec<(Attribute, String)>);

impl Object {
    fn get(&self, wanted: Attribute) -> Option<&str> {
        self.0.iter().find(|(attribute, _)| *attribute == wanted).map(|(_, value)| value.as_str())
    }
}

fn letter(code: u8) -> String {
    if code == 0 { String::new() } else { char::from(code).to_string() }
}

fn atoms_of(scene: &Scene) -> Vec<Object> {
    let molecule = &scene.molecule;
    let object = |atom: &restyle::scene::Atom| {
        let residue: &Residue = molecule.residue(atom);
        Object(vec![
            (Attribute::Element, atom.element.symbol().to_owned()),
            (Attribute::Name, atom.name.to_string()),
            (Attribute::Residue, residue.name.to_string()),
            (Attribute::Number, residue.number.to_string() + &letter(residue.insertion_code)),
            (Attribute::Kind, residue.kind.name().to_owned()),
            (Attribute::Chain, molecule.chain(atom).to_owned()),
            (Attribute::Model, residue.model.to_string()),
            (Attribute::Altloc, letter(atom.alt_loc)),
            (Attribute::BFactor, atom.b_factor.to_string()),
            (Attribute::Charge, atom.charge.to_string()),
            (Attribute::File, "m.xyz".to_owned()),
        ])
    };
    molecule.atoms.iter().map(object).collect()
}

fn parts_of(scene: &Scene) -> Vec<Object> {
    let assembly = &scene.assembly;
    let object = |part: &restyle::scene::Part| {
        let material = part.material.map_or("", |material| MATERIALS[material as usize]);
        Object(vec![
            (Attribute::Part, assembly.names[part.name as usize].clone()),
            (Attribute::Material, material.to_owned()),
            (Attribute::Node, assembly.names[part.path as usize].clone()),
            (Attribute::File, "m.xyz".to_owned()),
        ])
    };
    assembly.parts.iter().map(object).collect()
}

/// The first rule for each object, taken as one of a type.
fn first_rules(style: &Style, objects: &[Object], kind: ObjectKind) -> Vec<Option<usize>> {
    let first = |object: &Object| {
        let rule = style.rule_of(kind, &|attribute| object.get(attribute))?;
        style.mapping.iter().position(|other| std::ptr::eq(rule, other))
    };
    objects.iter().map(first).collect()
}

/// The assignment as it is defined.
fn defined(style: &Style, scene: &Scene) -> Assignment {
    let target = |rule: Option<usize>| {
        rule.map_or(Some(style.basic), |rule| style.mapping[rule].target).map(|shader| shader as u32)
    };
    let objects = atoms_of(scene);
    let atoms: Vec<_> = first_rules(style, &objects, ObjectKind::Atom).into_iter().map(target).collect();
    let rules = first_rules(style, &objects, ObjectKind::Connector);
    let connector = |a: usize, b: usize| {
        let hidden = atoms[a].is_none() || atoms[b].is_none();
        if hidden { None } else { target([rules[a], rules[b]].into_iter().flatten().min()) }
    };
    let connectors = scene.molecule.bonds.iter().map(|bond| connector(bond.a as usize, bond.b as usize)).collect();
    let parts = first_rules(style, &parts_of(scene), ObjectKind::Mesh).into_iter().map(target).collect();
    Assignment { atoms, connectors, parts }
}

/// Which selectors match nothing, as it is defined, in the order of the text.
fn defined_unmatched(style: &Style, scene: &Scene) -> Vec<String> {
    let (atoms, parts) = (atoms_of(scene), parts_of(scene));
    let bonded: Vec<&Object> =
        scene.molecule.bonds.iter().flat_map(|bond| [bond.a, bond.b]).map(|atom| &atoms[atom as usize]).collect();
    let matches = |selector: &restyle::config::Selector, kind, object: &Object| {
        selector.matches(kind, &|attribute| object.get(attribute))
    };
    let mut rules: Vec<_> = style
        .mapping
        .iter()
        .filter(|rule| {
            let is_there = match rule.selector.kind() {
                Some(ObjectKind::Atom | ObjectKind::Connector) | None => true,
                Some(ObjectKind::Mesh) => !parts.is_empty(),
                Some(_) => false,
            };
            is_there
                && !atoms.iter().any(|atom| matches(&rule.selector, ObjectKind::Atom, atom))
                && !bonded.iter().any(|atom| matches(&rule.selector, ObjectKind::Connector, atom))
                && !parts.iter().any(|part| matches(&rule.selector, ObjectKind::Mesh, part))
        })
        .collect();
    rules.sort_by_key(|rule| rule.place.start);
    rules.iter().map(|rule| rule.selector.to_string()).collect()
}

/// What a selector picks, as it is defined.
fn defined_picked(selector: &Selector, scene: &Scene) -> Picked {
    let picks = |kind, object: &Object| selector.matches(kind, &|attribute| object.get(attribute));
    let atoms = atoms_of(scene);
    let is_end = |atom: u32| picks(ObjectKind::Connector, &atoms[atom as usize]);
    Picked {
        atoms: atoms.iter().map(|atom| picks(ObjectKind::Atom, atom)).collect(),
        connectors: scene.molecule.bonds.iter().map(|bond| is_end(bond.a) || is_end(bond.b)).collect(),
        parts: parts_of(scene).iter().map(|part| picks(ObjectKind::Mesh, part)).collect(),
    }
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

const RANGES: [&str; 8] = ["-1..1", "0..", "..0", "2..5", "-0.5..0.75", "4.2..8.4", "..-1", "100..200"];
const NUMBERS: [&str; 6] = ["0", "-1", "2A", "1", "2", "3"];
const KINDS: [&str; 4] = ["protein", "water", "ligand", "other"];
const PARTS: [&str; 4] = ["Bolt1", "Bolt2", "Housing", ""];
const MATERIALS: [&str; 3] = ["Steel", "Brass", ""];
const PATHS: [&str; 4] = ["A/Bolt1", "A/B/Bolt2", "B", ""];

fn random_scene(random: &mut Random) -> Scene {
    let num_atoms = 1 + random.below(12);
    let mut model = 1;
    let atoms: Vec<_> = (0..num_atoms)
        .map(|_| {
            model += u32::from(random.below(5) == 0);
            (random.of(&ELEMENTS), random.of(&NAMES), random.of(&RESIDUES), random.of(&CHAINS), model)
        })
        .collect();
    let bonds: Vec<(u32, u32)> = (1..num_atoms as u32).map(|b| (b - 1, b)).filter(|_| random.below(3) > 0).collect();
    let scene = scene_of(atoms, &bonds);
    let parts: Vec<_> = (0..random.below(6))
        .map(|_| {
            let material = random.below(MATERIALS.len() + 1) as u32;
            (random.of(&PARTS), (material < 3).then_some(material), random.of(&PATHS))
        })
        .collect();
    if parts.is_empty() { scene } else { with_parts(scene, &parts) }
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
    for _ in 0..random.below(4) {
        let of_mesh = selector.starts_with("mesh") || (selector.starts_with('*') && random.below(4) == 0);
        let (attribute, values): (_, &[&str]) = match (of_mesh, random.below(16)) {
            (true, 0..6) => ("part", &PARTS),
            (true, 6..10) => ("material", &MATERIALS),
            (true, 10..14) => ("node", &PATHS),
            (true, _) | (false, 15) => ("file", &["m.xyz", "n"]),
            (false, 0..2) => ("element", &ELEMENTS),
            (false, 2..4) => ("name", &NAMES),
            (false, 4..6) => ("residue", &RESIDUES),
            (false, 6..8) => ("chain", &CHAINS),
            (false, 8) => ("model", &["1", "2", "3"]),
            (false, 9) => ("kind", &KINDS),
            (false, 10) => ("number", &NUMBERS),
            (false, 11) => ("altloc", &["", "B"]),
            (false, _) => {
                let attribute = random.of(&["number", "model", "b_factor", "charge"]);
                selector += &format!("[{attribute}={}]", random.of(&RANGES));
                continue;
            }
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
        let scene = random_scene(&mut random);
        let mut selectors: Vec<String> = (0..random.below(30)).map(|_| random_selector(&mut random)).collect();
        selectors.sort();
        selectors.dedup();
        for i in (1..selectors.len()).rev() {
            selectors.swap(i, random.below(i + 1));
        }
        let style = style_of_rules(selectors.iter().map(|text| (text.as_str(), text.len() % 5 == 0)));
        let expected = defined(&style, &scene);
        let provider = ShaderProvider::new(&scene, &style);
        assert_eq!(**provider.assignment(), expected, "round {round}: {selectors:#?}");
        assert_eq!(selectors_of(&unmatched(&style, &scene)), defined_unmatched(&style, &scene), "round {round}");
        for used in expected.atoms.iter().chain(&expected.connectors).chain(&expected.parts) {
            outcomes[used.map_or(0, |used| if used as usize == style.basic { 1 } else { 2 })] += 1;
        }
    }
    assert!(outcomes.iter().all(|count| *count > NUM_STYLES / 2), "few of one outcome: {outcomes:?}");
}

#[test]
fn every_object_that_matches_is_picked() {
    let mut random = Random(20_160_302);
    let mut outcomes = [0; 2];
    for round in 0..NUM_STYLES {
        let scene = random_scene(&mut random);
        let text = random_selector(&mut random);
        let selector = Selector::parse(&text).unwrap_or_else(|wrong| panic!("{wrong}"));
        let found = picked(&scene, &selector);
        assert_eq!(found, defined_picked(&selector, &scene), "round {round}: {text}");
        assert_eq!(found.is_empty(), found.bounds(&scene).is_none(), "round {round}: {text}");
        outcomes[usize::from(found.is_empty())] += 1;
    }
    assert!(outcomes.iter().all(|count| *count > NUM_STYLES / 10), "few of one outcome: {outcomes:?}");
}

/// The names of what draws the atoms, `-` where nothing does.
fn drawn_with(style: &Style, scene: &Scene) -> String {
    let name = |used: &Option<u32>| used.map_or("-", |used| style.shaders[used as usize].name.as_str());
    ShaderProvider::new(scene, style).assignment().atoms.iter().map(name).collect::<Vec<_>>().join(" ")
}

#[test]
fn more_attributes_win_then_a_type_then_the_later_one() {
    let scene = scene_of([("C", "CA", "ALA", "A", 1), ("O", "O", "HOH", "A", 1)], &[(0, 1)]);
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
        assert_eq!(drawn_with(&style, &scene), expected, "{rules:?}");
    }
    assert_eq!(drawn_with(&style_of_rules([("*", true), ("atom[name=O]", false)]), &scene), "- s1");
}

#[test]
fn a_connector_takes_the_better_rule_of_its_atoms_and_hides_with_either() {
    let atoms = [("C", "CA", "ALA", "A", 1), ("O", "O", "HOH", "A", 1), ("N", "N", "ALA", "A", 1)];
    let scene = scene_of(atoms, &[(0, 1), (1, 2)]);
    let connectors = |rules: &[(&str, bool)]| {
        let style = style_of_rules(rules.iter().copied());
        let assignment = ShaderProvider::new(&scene, &style).assignment().connectors.clone();
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
    let scene = scene_of(atoms, &[(0, 1)]);
    let told = |selector: &str| {
        let style = style_of_rules([(selector, false)]);
        unmatched(&style, &scene).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
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
    let alone = scene_of([("C", "C", "", "", 1)], &[]);
    assert_eq!(unmatched(&style_of_rules([("connector", false)]), &alone).len(), 1);
}

#[test]
fn what_stays_the_same_is_taken_over() {
    use std::sync::Arc;
    let scene = scene_of([("C", "CA", "ALA", "A", 1), ("O", "O", "HOH", "A", 1)], &[(0, 1)]);
    let style = |mapping: &str, color: &str| {
        style_of(&format!(
            r#"{{ "mapping": {{ {mapping} }}, "shaders": [
                {{ "name": "a", "shader": "unlit", "properties": {{ "base_color": "{color}" }} }},
                {{ "name": "b", "shader": "toon" }} ] }}"#
        ))
    };
    let first = ShaderProvider::new(&scene, &style(r#""atom[element=C]": "a", "atom": "b""#, "red"));
    for mapping in [
        r#""atom[element=C]": "a", "atom": "b""#,
        // Other rules, but the same outcome.
        r#""atom": "b", "atom[name=CA]": "a", "atom[name=Q]": null"#,
    ] {
        let next = first.with_style(&scene, &style(mapping, "blue"));
        assert!(Arc::ptr_eq(first.assignment(), next.assignment()), "{mapping}");
    }
    // Each style after the other answers as it would alone.
    let mut provider = first;
    for mapping in [
        r#""atom[element=C]": "b", "atom": "b""#,
        r#""atom[element=C]": null, "atom": "b""#,
        r#""atom[element=O]": "a""#,
        // What was not asked before takes part from here on.
        r#""atom[number=0..]": "a", "connector[b_factor=2..]": "b""#,
        r#""atom[kind=water]": "b""#,
        "",
    ] {
        let style = style(mapping, "red");
        provider = provider.with_style(&scene, &style);
        assert_eq!(**provider.assignment(), defined(&style, &scene), "{mapping}");
    }
}

#[test]
fn meshes_are_asked_by_part_material_node_and_file() {
    let parts = [("Bolt1", Some(0), "A/Bolt1"), ("Bolt2", Some(1), "A/B/Bolt2"), ("Housing", None, "Housing")];
    let mut scene = with_parts(scene_of([("C", "C", "", "", 1)], &[]), &parts);
    let drawn = |scene: &Scene, rules: &[&str]| {
        let style = style_of_rules(rules.iter().map(|rule| (*rule, false)));
        let name = |used: &Option<u32>| used.map_or("-", |used| style.shaders[used as usize].name.as_str()).to_owned();
        ShaderProvider::new(scene, &style).assignment().parts.iter().map(name).collect::<Vec<_>>().join(" ")
    };
    for (rules, expected) in [
        (&["mesh[part=Bolt*]"][..], "s0 s0 basic"),
        (&["mesh[material=Steel]", "mesh"], "s0 s1 s1"),
        (&["mesh[material='']", "*"], "s1 s1 s0"),
        // A star runs over the slashes of a path.
        (&["mesh[node=A/*]", "mesh[node=*/B/*]"], "s0 s1 basic"),
        (&["*[file=m.xyz]", "mesh[part=Housing][material='']"], "s0 s0 s1"),
        (&["atom", "*[element=C]"], "basic basic basic"),
    ] {
        assert_eq!(drawn(&scene, rules), expected, "{rules:?}");
    }
    let told = |scene: &Scene, selector: &str| {
        let style = style_of_rules([(selector, false)]);
        unmatched(&style, scene).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    for (selector, hint) in [
        ("mesh[part=Bolt3]", "; did you mean \"Bolt1\"? the scene has: Bolt1, Bolt2, Housing"),
        ("mesh[material=Steal]", "; did you mean \"Steel\"? the scene has: Brass, Steel"),
        ("mesh[node=A/C*]", "; the scene has: A/B/Bolt2, A/Bolt1, Housing"),
        ("mesh[part=Bolt1][material=Brass]", "; the scene has: Steel"),
        ("*[part=Housin]", "; did you mean \"Housing\"? the scene has: Bolt1, Bolt2, Housing"),
        ("*[file=n.xyz]", "; did you mean \"m.xyz\"? the scene has: m.xyz"),
    ] {
        let message = told(&scene, selector);
        assert!(message.ends_with(&format!("matches nothing in this scene{hint}")), "{selector}: {message}");
    }
    // A scene of meshes says nothing of rules for atoms.
    assert_eq!(told(&scene, "mesh[part=Housing]"), "");
    scene.molecule = restyle::scene::Molecule::default();
    assert_eq!(told(&scene, "atom[chain=A]"), "");
}

#[test]
fn a_range_without_objects_is_told_the_range_that_there_is() {
    let scene = scene_of((0..30).map(|_| ("C", "CA", "ALA", "A", 1)), &[]);
    let told = |selector: &str| {
        let style = style_of_rules([(selector, false)]);
        unmatched(&style, &scene).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    for (selector, hint) in [("atom[number=90..]", "-1..13"), ("atom[charge=..-5]", "-1..6"), ("atom[model=2..]", "1")]
    {
        let message = told(selector);
        assert!(message.ends_with(&format!("matches nothing in this scene; the scene has: {hint}")), "{message}");
    }
}

/// The classes of many parts that differ in all of their names.
#[test]
fn a_hundred_thousand_parts_are_resolved() {
    let names: Vec<(String, String)> =
        (0..100_000).map(|i| (format!("part {i}"), format!("A/{}/part {i}", i % 1000))).collect();
    let parts: Vec<_> = names.iter().map(|(name, path)| (name.as_str(), Some(0), path.as_str())).collect();
    let scene = with_parts(scene_of([("C", "C", "", "", 1)], &[]), &parts);
    let style = style_of_rules([("mesh[part=*7]", false), ("mesh[node=A/5/*]", true), ("mesh", false)]);
    let assignment = ShaderProvider::new(&scene, &style).assignment().clone();
    let count = |wanted: &str| {
        let is_wanted =
            |used: &&Option<u32>| used.map_or("-", |used| style.shaders[used as usize].name.as_str()) == wanted;
        assignment.parts.iter().filter(is_wanted).count()
    };
    assert_eq!([count("s0"), count("-"), count("s2")], [10_000, 100, 89_900]);
}
