//! Time to find what draws each object, by selectors and atoms, and to load such styles: `cargo bench --bench resolve`.
//!
//! Molecules and styles are made from formulas. All cells of a table are measured in turn, round after round, so that a
//! machine's drift falls on all alike; the first round is left out. Nothing is drawn.

use std::fmt::Write;
use std::time::Instant;

use restyle::config::{Attribute, Catalog, ObjectKind, Source, Style, load};
use restyle::engine;
use restyle::providers::{ShaderProvider, unmatched};
use restyle::scene::{Element, FileBond, MoleculeBuilder, Name, NewAtom, Report, Scene};

const ROUNDS: usize = 15;
const SELECTORS: [usize; 2] = [1_000, 10_000];
const ATOMS: [usize; 2] = [10_000, 100_000];

/// What a style's selectors ask for.
const STYLES: [&str; 3] = ["plain", "glob", "mixed"];

/// A molecule's names: those of a large protein, or another one for each atom as an XYZ file may have it.
const MOLECULES: [&str; 2] = ["protein", "all names differ"];

fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| values[(values.len() - 1) * quarter / 4])
}

fn timed<T>(run: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = run();
    (start.elapsed().as_secs_f64() * 1e3, result)
}

/// A number in letters, so that all letters are as frequent.
fn letters(mut number: usize, count: usize) -> String {
    let mut text = String::new();
    for _ in 0..count {
        text.push(char::from(b'A' + (number % 26) as u8));
        number /= 26;
    }
    text
}

fn scene(kind: &str, num_atoms: usize) -> Scene {
    let mut builder = MoleculeBuilder::default();
    let elements = [b"C", b"N", b"O", b"S"].map(|symbol| Element::from_symbol(symbol).unwrap_or_default());
    for i in 0..num_atoms {
        // 60 names, 100 residues of 10 atoms, chains of 300 residues.
        let (name, residue, chain) = match kind {
            "protein" => (letters(i % 60 * 7, 2), letters(i / 10 % 100 * 41, 3), letters(i / 3000, 1)),
            _ => (letters(i * 7919, 5), String::new(), String::new()),
        };
        builder.push(&NewAtom {
            position: glam::DVec3::new(2.5 * i as f64, 0.0, 0.0),
            element: elements[i % 4],
            name: Name::new(name.as_bytes()),
            alt_loc: 0,
            occupancy: 1.0,
            residue_name: Name::new(residue.as_bytes()),
            residue_number: (i / 10) as i32,
            insertion_code: 0,
            is_hetero: false,
            chain: chain.as_bytes(),
            model: 1,
            b_factor: 0.0,
            charge: 0.0,
        });
    }
    let bonds: Vec<FileBond> = (1..num_atoms as u32).map(|b| FileBond { a: b - 1, b, order: 1 }).collect();
    let mut scene = Scene::from_bytes("bench.xyz", b"1\n\nC 0 0 0\n").expect("an atom");
    scene.molecule = builder.finish(&bonds, &mut Report::default()).expect("a molecule has atoms");
    scene
}

fn selector(kind: &str, i: usize) -> String {
    match (kind, i % 4) {
        ("plain", 0) => format!("atom[name={}]", letters(i * 7919, 5)),
        ("plain", _) => format!("atom[name={}][residue={}]", letters(i % 60 * 7, 2), letters(i / 60 * 41, 3)),
        ("glob", 0) => format!("atom[name=*{}*{}*]", letters(i, 1), letters(i / 26, 2)),
        ("glob", _) => format!("atom[name={}?][residue=*{}*]", letters(i, 1), letters(i / 26, 2)),
        (_, 0) => selector("plain", i + i / 4 % 2),
        (_, 1) => selector("glob", i),
        (_, 2) => format!("*[residue={}][element=c][name=?{}*]", letters(i * 41, 3), letters(i / 7, 1)),
        _ => format!("connector[chain={}][name={}]", letters(i / 650, 1), letters(i * 7, 2)),
    }
}

/// A style of so many selectors and a tenth as many shaders; `steps` is a property of one of them.
fn style_text(kind: &str, num_selectors: usize, steps: usize) -> String {
    let num_shaders = num_selectors / 10;
    let mut text = "{ \"mapping\": {".to_owned();
    for i in 0..num_selectors {
        let _ = writeln!(text, "\"{}\": \"s{}\",", selector(kind, i), i % num_shaders);
    }
    text += "\"*\": \"basic\" }, \"shaders\": [\n";
    for i in 0..num_shaders {
        let steps = if i == 0 { steps } else { 4 };
        let _ = writeln!(
            text,
            "{{ \"name\": \"s{i}\", \"shader\": \"toon\", \"properties\": {{ \"steps\": {steps}, \"base_color\": \"#c0392b\" }} }},"
        );
    }
    text + "] }"
}

fn style_of(text: &str, catalog: &Catalog<'_>) -> Style {
    load(&Source::new("bench.json", text), catalog).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// One molecule in one style, and the milliseconds of each round.
struct Cell {
    label: String,
    scene: Scene,
    style: Style,
    /// The same rules; one shader has another property.
    recolored: Style,
    /// Rules in another order.
    reordered: Style,
    /// All of it; another style on a scene that is known; another property; what `check --scene` asks.
    times: [Vec<f64>; 4],
}

fn resolving(catalog: &Catalog<'_>) {
    let mut cells = Vec::new();
    for of_molecule in MOLECULES {
        for of_style in STYLES {
            for num_atoms in ATOMS {
                for num_selectors in SELECTORS {
                    let mut reordered = style_of(&style_text(of_style, num_selectors, 4), catalog);
                    reordered.mapping.rotate_left(1);
                    cells.push(Cell {
                        label: format!("{of_molecule} | {of_style} | {num_atoms} | {num_selectors}"),
                        scene: scene(of_molecule, num_atoms),
                        style: style_of(&style_text(of_style, num_selectors, 4), catalog),
                        recolored: style_of(&style_text(of_style, num_selectors, 5), catalog),
                        reordered,
                        times: Default::default(),
                    });
                }
            }
        }
    }
    for round in 0..=ROUNDS {
        for cell in &mut cells {
            let (whole, provider) = timed(|| ShaderProvider::new(&cell.scene, &cell.style));
            let (again, other) = timed(|| provider.with_style(&cell.scene, &cell.reordered));
            let (property, same) = timed(|| provider.with_style(&cell.scene, &cell.recolored));
            let (check, _) = timed(|| unmatched(&cell.style, &cell.scene));
            assert_eq!(provider.assignment(), same.assignment());
            drop(other);
            if round > 0 {
                for (times, ms) in cell.times.iter_mut().zip([whole, again, property, check]) {
                    times.push(ms);
                }
            }
        }
    }
    println!(
        "| names | selectors ask | atoms | selectors | new scene ms | new rules ms | new property ms | unmatched ms |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|");
    for cell in cells {
        let row = cell.times.map(|times| {
            let [low, middle, high] = quartiles(times);
            format!("{low:.2}, {middle:.2}, {high:.2}")
        });
        println!("| {} | {} |", cell.label, row.join(" | "));
    }
}

/// The plain definition, asked for each atom, as a measure for the above.
fn walking(catalog: &Catalog<'_>) {
    let molecule = scene("protein", ATOMS[0]).molecule;
    println!("\n| walking all rules for each of {} atoms | selectors | ms |\n|---|---:|---:|", ATOMS[0]);
    for kind in STYLES {
        let style = style_of(&style_text(kind, SELECTORS[0], 4), catalog);
        let (ms, _) = timed(|| {
            let rule_of = |atom: &restyle::scene::Atom| {
                let residue = molecule.residue(atom);
                let model = residue.model.to_string();
                let value = |attribute| match attribute {
                    Attribute::Element => Some(atom.element.symbol()),
                    Attribute::Name => Some(atom.name.as_str()),
                    Attribute::Residue => Some(residue.name.as_str()),
                    Attribute::Chain => Some(molecule.chain(atom)),
                    Attribute::Model => Some(model.as_str()),
                    _ => None,
                };
                style.rule_of(ObjectKind::Atom, &value).is_some()
            };
            molecule.atoms.iter().filter(|atom| rule_of(atom)).count()
        });
        println!("| {kind} | {} | {ms:.1} |", SELECTORS[0]);
    }
}

/// A style full of slips: each name and every third selector is wrong.
fn broken_text(num_selectors: usize) -> String {
    style_text("mixed", num_selectors, 4).replace("\": \"s", "\": \"t").replace("connector[chain", "conector[chian")
}

fn loading(catalog: &Catalog<'_>) {
    let mut cells: Vec<(String, String, Vec<f64>)> = Vec::new();
    for num_selectors in [1_000, 10_000, 100_000] {
        cells.push((format!("plain | {num_selectors}"), style_text("plain", num_selectors, 4), Vec::new()));
        cells.push((format!("broken | {num_selectors}"), broken_text(num_selectors), Vec::new()));
    }
    for round in 0..=ROUNDS {
        for (_, text, times) in &mut cells {
            let source = Source::new("bench.json", text.as_str());
            let (ms, loaded) = timed(|| load(&source, catalog));
            drop(loaded);
            if round > 0 {
                times.push(ms);
            }
        }
    }
    println!("\n| loading | selectors | MB | ms |\n|---|---:|---:|---:|");
    for (label, text, times) in cells {
        let [low, middle, high] = quartiles(times);
        println!("| {label} | {:.1} | {low:.1}, {middle:.1}, {high:.1} |", text.len() as f64 / 1e6);
    }
}

fn main() {
    // `cargo test --benches` only asks whether it runs.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let entries = engine::catalog();
    let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
    resolving(&catalog);
    walking(&catalog);
    loading(&catalog);
}
