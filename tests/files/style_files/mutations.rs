//! Styles with random damage: none may panic, hang, or be refused without a reason.

use std::path::Path;

use restyle::config::{Source, load, load_with};

use super::catalog::CATALOG;
use super::transfers::GLASS;

/// Mutations in all, unless `RESTYLE_MUTATIONS` sets another number.
const MUTATIONS: usize = 10_000;

/// xorshift64* [Vigna2016]: small and the same everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % end.max(1)
    }
}

/// Pieces that are likely to reach further than random bytes.
const PIECES: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "\\",
    "//",
    "/*",
    "*/",
    "null",
    "true",
    "1e999",
    "-1",
    "0.5",
    "1e308",
    "\u{e9}",
    "\u{feff}",
    "\r\n",
    "\"2pt\"",
    "\"#fff\"",
    "\"\\u0000\"",
    "\"\\ud83d\\ude00\"",
    "\"atom[element=O]\"",
    "*",
    "[x=",
    "\"extends\": \"listing1.json\",",
    "\"properties\": {},",
    "\"shaders\"",
    "\"post_effects\"",
    "'",
    "\u{201c}",
    "=",
    ";",
    "#",
    "True",
    "toon",
    ".5",
    "0x10",
    "\\u",
    "\u{a0}",
    "(1, 2, 3)",
    "\"a\": ",
    "{ \"name\": \"a\" },",
    "[0.5, 1]",
    "[0, 0.1, 0.9]",
    "\"a.png\"",
];

/// A style with transfer functions, for [`GLASS`].
const TRANSFERS: &str = r#"{ "mapping": { "*": "g" }, "shaders": [
    { "name": "g", "shader": "curvature", "properties": { "opacity_transfer": "xray", "color_transfer": "ink" } },
    { "name": "h", "shader": "curvature", "properties": {
        "opacity_transfer": [[0, 0.1, 0.9], [0.5, 0.5, 0.9], [1, 1, 1]],
        "color_transfer": [[-1, 1, 1.5, 2], [0, 1, 1, 1], [0.5, 0.75, 0.25, 0]] } }] }"#;

fn mutate(text: &[u8], others: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut bytes = text.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() + 1);
        let end = (at + random.below(12)).min(bytes.len());
        match random.below(6) {
            0 => drop(bytes.drain(at..end)),
            1 => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].bytes())),
            2 => drop(bytes.splice(at..end, PIECES[random.below(PIECES.len())].bytes())),
            3 => bytes.insert(at, random.below(256) as u8),
            4 => bytes.truncate(at.max(bytes.len() / 2)),
            _ => {
                let other = &others[random.below(others.len())];
                let from = random.below(other.len());
                let to = (from + random.below(40)).min(other.len());
                bytes.splice(at..at, other[from..to].iter().copied());
            }
        }
    }
    bytes
}

/// Where the texts and numbers of a style are.
fn tokens(text: &[u8]) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut i = 0;
    while i < text.len() {
        let start = i;
        let is_text = text[i] == b'"';
        i += 1;
        if is_text {
            i += text[i..].iter().position(|b| *b == b'"').map_or(0, |length| length + 1);
            found.push(start..i);
        } else if text[start].is_ascii_digit() {
            i += text[i..].iter().take_while(|b| b.is_ascii_digit() || **b == b'.').count();
            found.push(start..i);
        }
    }
    found
}

/// Replaces one text or number by another, which mostly leaves JSON, so that the damage reaches the meaning.
fn swap_token(text: &[u8], others: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let other = &others[random.below(others.len())];
    let (places, sources) = (tokens(text), tokens(other));
    let place = places[random.below(places.len())].clone();
    let mut bytes = text.to_vec();
    match random.below(3) {
        0 => drop(bytes.splice(place, PIECES[random.below(PIECES.len())].bytes())),
        _ => drop(bytes.splice(place, other[sources[random.below(sources.len())].clone()].iter().copied())),
    }
    bytes
}

#[test]
fn damaged_styles_never_panic() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/prost2016");
    let names = ["listing1.json", "advertisement.json", "education.json", "scientific.json", "future.json"];
    let mut texts: Vec<Vec<u8>> = names.iter().map(|name| std::fs::read(folder.join(name)).unwrap()).collect();
    texts.push(TRANSFERS.as_bytes().to_vec());
    let mut random = Random(0x5EED_0F57_71E5);
    let (mut loaded, mut refused) = (0, 0);
    let mutations = std::env::var("RESTYLE_MUTATIONS").map_or(MUTATIONS, |number| number.parse().unwrap());
    let start = std::time::Instant::now();
    for i in 0..mutations {
        let text = &texts[i % texts.len()];
        let damage = if random.below(2) == 0 { mutate } else { swap_token };
        let source = Source::new("s.json", damage(text, &texts, &mut random));
        let loader = |_: &str, _: &Source| Ok(Source::new("base.json", texts[i % texts.len()].clone()));
        let catalog = if i % texts.len() < names.len() { &CATALOG } else { &GLASS };
        match load_with(&source, catalog, &loader) {
            Ok(style) => {
                loaded += 1;
                assert!(style.basic < style.shaders.len());
                style.warnings.iter().for_each(|warning| assert!(!warning.to_string().is_empty()));
            }
            Err(mistakes) => {
                refused += 1;
                assert!(!mistakes.is_empty() && mistakes.list.len() <= 100);
                for line in mistakes.to_string().lines() {
                    assert!(line.starts_with("s.json") || line.starts_with("base.json"), "{line}");
                }
            }
        }
    }
    println!("{mutations} mutations: {loaded} loaded, {refused} refused, {:.1} s", start.elapsed().as_secs_f64());
    // Both ends are reached, or the mutations would test nothing.
    assert!(loaded > mutations / 50 && refused > mutations / 5, "{loaded} loaded, {refused} refused");
}

#[test]
fn every_cut_of_a_style_is_refused_or_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/prost2016/listing1.json");
    let text = std::fs::read(path).unwrap();
    for end in 0..text.len() - 2 {
        let source = Source::new("s.json", &text[..end]);
        assert!(load(&source, &CATALOG).is_err(), "cut at {end}");
    }
}
