//! The JSON Schema of style files: current, valid, and of one mind with the loader.

use std::collections::BTreeMap;
use std::path::Path;

use jsonschema::Validator;
use restyle::config::param::Default;
use restyle::config::schema::{self, schema};
use restyle::config::{Catalog, CatalogEntry, Mistake, Mistakes, Param, SECTIONS, Source, Style, load_with};
use restyle::engine;
use restyle::shipped::LOOKS;
use serde_json::Value;

use super::style_files::mutations::Random;
use super::style_files::transfers::CURVATURE;

/// The catalog of the program.
pub struct House(pub Vec<CatalogEntry>);

impl House {
    pub fn new() -> House {
        House(engine::catalog())
    }

    /// The same with a shader that has transfer functions.
    fn with_transfers() -> House {
        let mut house = House::new();
        house.0.push(CatalogEntry { name: "transferring", ..CURVATURE });
        house
    }

    pub fn catalog(&self) -> Catalog<'_> {
        Catalog { shaders: &self.0, kinds: engine::DRAWN_KINDS }
    }

    fn schema(&self) -> Value {
        schema(&self.catalog())
    }

    pub fn validator(&self) -> Validator {
        jsonschema::draft7::new(&self.schema()).unwrap_or_else(|error| panic!("the schema is no schema: {error}"))
    }

    /// Loads a text; any base is a look.
    fn load(&self, text: &str) -> Result<Style, Mistakes> {
        let look = |_: &str, _: &Source| Ok(Source::new(LOOKS[1].file, LOOKS[1].bytes));
        load_with(&Source::new("s.json", text), &self.catalog(), &look)
    }
}

pub fn at(path: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn parse(text: &str) -> Result<Value, String> {
    jsonc_parser::parse_to_serde_value(text, &jsonc_parser::ParseOptions::default()).map_err(|error| error.to_string())
}

/// The looks, and the published styles that are fixtures.
fn styles() -> Vec<(String, String)> {
    let mut styles = Vec::new();
    for folder in ["styles", "tests/fixtures/prost2016"] {
        for entry in std::fs::read_dir(at(folder)).expect("a folder of the project") {
            let name = entry.expect("a file of the project").file_name().to_string_lossy().into_owned();
            if name.ends_with(".json") && name != schema::FILE {
                let text = std::fs::read_to_string(at(folder).join(&name)).expect("a style is text");
                styles.push((format!("{folder}/{name}"), text));
            }
        }
    }
    styles.sort();
    assert_eq!(styles.len(), 14);
    styles
}

#[test]
fn the_committed_schema_is_current() {
    let committed = std::fs::read_to_string(at("styles").join(schema::FILE)).unwrap_or_default();
    let current = format!("{:#}\n", House::new().schema());
    assert!(
        committed == current,
        "styles/{file} is not what the tables say; renew it: restyle schema > styles/{file}",
        file = schema::FILE
    );
}

#[test]
fn the_schema_is_valid_draft_7() {
    if let Err(error) = jsonschema::meta::validate(&House::new().schema()) {
        panic!("{}: {error}", error.instance_path());
    }
}

#[test]
fn every_style_of_the_house_is_valid() {
    let validator = House::new().validator();
    for (name, text) in styles() {
        if let Err(error) = validator.validate(&parse(&text).unwrap()) {
            panic!("{name}: {}: {error}", error.instance_path());
        };
    }
}

/// What only the loader can know, with the reason why no schema can. Any other mistake, the schema finds as well.
const BEYOND_A_SCHEMA: [(&str, &str); 7] = [
    ("duplicate_key", "of two equal keys, it sees the last"),
    ("duplicate_name", "it cannot compare the entries of a list in one of their keys"),
    ("unknown_name", "it cannot know which names the file declares"),
    ("effect_as_shader", "it cannot follow a name to its entry"),
    ("shader_as_effect", "it cannot follow a name to its entry"),
    ("picture", "it reads no pictures"),
    ("meaningless", "it compares no two values, such as camera.position and camera.target"),
];

/// Whether only the loader can know of a mistake.
fn is_beyond_a_schema(mistake: &Mistake, style: &Value) -> bool {
    // What an entry without a shader may hold, the base decides.
    let entry =
        mistake.place.path.strip_prefix("shaders[").and_then(|rest| rest.split(']').next()?.parse::<usize>().ok());
    let of_base = style.get("extends").and(entry).is_some_and(|i| style["shaders"][i].get("shader").is_none());
    // Any text may be the name of a shader: that `none` is meant as null, only who knows all names can tell.
    let is_none = mistake.problem.to_string().contains("write null, without quotes, to hide");
    of_base || is_none || BEYOND_A_SCHEMA.iter().any(|(known, _)| *known == mistake.problem.code())
}

/// What schema and loader say of one text.
#[derive(Debug, PartialEq)]
pub enum Verdict {
    BothTake,
    BothRefuse,
    /// The codes of what only the loader refuses.
    OnlyLoaderRefuses(Vec<&'static str>),
}

/// Checks both verdicts on one text.
pub fn judge(house: &House, validator: &Validator, text: &str) -> Verdict {
    let loaded = house.load(text).map(drop);
    let Ok(value) = parse(text) else {
        assert!(loaded.is_err(), "the loader takes what is no JSON:\n{text}");
        return Verdict::BothRefuse;
    };
    match (validator.validate(&value), loaded) {
        (Err(error), Ok(())) => {
            panic!("the loader takes what the schema refuses ({}: {error}):\n{text}", error.instance_path())
        }
        (Ok(()), Err(mistakes)) => {
            let codes: Vec<_> = mistakes.list.iter().map(|mistake| mistake.problem.code()).collect();
            // What stands under the first of two equal keys, the schema never sees.
            let excused = codes.contains(&"duplicate_key")
                || mistakes.list.iter().all(|mistake| is_beyond_a_schema(mistake, &value));
            assert!(excused, "the schema takes what the loader refuses:\n{mistakes}\n{text}");
            Verdict::OnlyLoaderRefuses(codes)
        }
        (Ok(()), Ok(())) => Verdict::BothTake,
        (Err(_), Err(_)) => Verdict::BothRefuse,
    }
}

/// A key or value of a text, by its bytes.
#[derive(Clone)]
enum Token {
    Key(std::ops::Range<usize>),
    /// A text, number, word, list or object.
    Value(std::ops::Range<usize>),
    /// A key with its value.
    Member(std::ops::Range<usize>),
    /// A value in a list.
    Item(std::ops::Range<usize>),
}

impl Token {
    fn range(&self) -> std::ops::Range<usize> {
        match self {
            Token::Key(range) | Token::Value(range) | Token::Member(range) | Token::Item(range) => range.clone(),
        }
    }
}

fn tokens(text: &str) -> Vec<Token> {
    use jsonc_parser::ast::Value as Ast;
    use jsonc_parser::common::Ranged;
    fn walk(value: &Ast<'_>, into: &mut Vec<Token>) {
        let range = |ranged: &dyn Ranged| ranged.start()..ranged.end();
        into.push(Token::Value(range(value)));
        match value {
            Ast::Object(object) => {
                for property in &object.properties {
                    into.push(Token::Key(range(&property.name)));
                    into.push(Token::Member(range(property)));
                    walk(&property.value, into);
                }
            }
            Ast::Array(list) => {
                for item in &list.elements {
                    into.push(Token::Item(range(item)));
                    walk(item, into);
                }
            }
            _ => {}
        }
    }
    let options = jsonc_parser::ParseOptions::default();
    let parsed = jsonc_parser::parse_to_ast(text, &jsonc_parser::CollectOptions::default(), &options);
    let mut tokens = Vec::new();
    let root = parsed.ok().and_then(|parsed| parsed.value).expect("only JSON is taken apart");
    walk(&root, &mut tokens);
    tokens
}

/// Values that reach further than those of the styles.
const VALUES: &[&str] = &[
    "null",
    "true",
    "false",
    "0",
    "-0.0",
    "-1",
    "0.5",
    "1",
    "1.0",
    "2",
    "2.5",
    "3",
    "64",
    "255",
    "256",
    "1e9",
    "1.1e9",
    "-1e9",
    "1e300",
    "\"\"",
    "\" \"",
    "\"true\"",
    "\" false \"",
    "\"True\"",
    "\"2pt\"",
    "\" 2 pt \"",
    "\"-2pt\"",
    "\"-0pt\"",
    "\"+1.5A\"",
    "\"1.5 \u{c5}\"",
    "\"3r\"",
    "\"2mm\"",
    "\"2px\"",
    "\".5pt\"",
    "\"5.pt\"",
    "\".pt\"",
    "\"1e3pt\"",
    "\"1000000000A\"",
    "\"1000000000.5A\"",
    "\"1000000000.00000000001A\"",
    "\"9999999999A\"",
    "\"0000000000001A\"",
    "\"2\"",
    "\"#fff\"",
    "\"#ffff\"",
    "\"#fffff\"",
    "\"#c0392b\"",
    "\"#c0392b80\"",
    "\"c0392b\"",
    "\"Teal\"",
    "\" teal \"",
    "\"tael\"",
    "\"transparent\"",
    "\"element\"",
    "\"Element\"",
    "\"chain\"",
    "\"vdw\"",
    "\"covalent\"",
    "\"toon\"",
    "\"basic\"",
    "\"unlit\"",
    "\"curvature\"",
    "\"ssaoPost\"",
    "\"dofPost\"",
    "\"tone\"",
    "\"soft\"",
    "\"ambient\"",
    "\"point\"",
    "\"principal\"",
    "\"centre\"",
    "\"inch\"",
    "\"bkb\"",
    "[]",
    "{}",
    "[0, 0, 0]",
    "[1, 2, 3]",
    "[1, 2]",
    "[1, 2, 3, 4]",
    "[1, 2, 3, 4, 5]",
    "[[0, 0, 0.7, 0.9]]",
    "[256, 0, 0]",
    "[\"0\", 0, 0]",
    "[null]",
    "[{}]",
    "[[]]",
    "{ \"a\": 1 }",
    "{ \"steps\": 4 }",
    "{ \"name\": \"a\", \"shader\": \"toon\" }",
    "[\"dofPost\"]",
    "[\"toon\"]",
    "7",
    "\"base.json\"",
    "\"*\"",
    "\" atom[element=O] \"",
    "\"atom[element=O\"",
    "\"atom[number=1..2][b_factor=5..]\"",
    "\"mesh[part=2pt]\"",
    "\"mesh[element=O]\"",
    "\"ribbon[chain='']\"",
    "\"atm\"",
    "\"post_effects\"",
    "\"layers\"",
    "\" center\"",
    "\"+2pt\"",
    "\" .5A\"",
    "\"fig7a\"",
    "\"fig6a\"",
    "\"mine.png\"",
    "\"mine.PNG\"",
    "\"minepng\"",
    "\"mine.jpg\"",
    "[[0, 1]]",
    "[[-0.5, 1]]",
    "[[0, 0.1, 0.9], [1, 1, 1]]",
    "[[0, 0.1, 0.9, 1]]",
    "[[0, 1, 2, 3]]",
    "[[-1, 1.5, 2, 0], [1, 1, 1, 1]]",
    "[[0, 1], [0, 0.5]]",
    "[[0, 1], [1, 0.5, 0.5]]",
    "[[0, 1], \"xray\"]",
    "[[0, null]]",
];

/// Keys that reach further than those of the styles.
const KEYS: &[&str] = &[
    "\"atom\"",
    "\" atom \"",
    "\"*\"",
    "\"ribbon\"",
    "\"surface[chain=A]\"",
    "\"mesh[part=Housing*]\"",
    "\"mesh[element=O]\"",
    "\"atom[part=a]\"",
    "\"*[part=a][element=C]\"",
    "\"atom[element=]\"",
    "\"atom[element=\\\"\\\"]\"",
    "\"atom[element='C']\"",
    "\"atom[name=C1']\"",
    "\"atom[name='C]\"",
    "\"atom [ name = CA ] [chain=A] \"",
    "\"atom[name=a]b\"",
    "\"atom[name=a[b]\"",
    "\"atom[name=\u{feff}]\"",
    "\"atom[name=\u{a0}]\"",
    "\"atom[name=\u{85}]\"",
    "\"atom[]\"",
    "\"atom[\"",
    "\"Atom\"",
    "\"atm\"",
    "\"post_effects\"",
    "\"post_effect\"",
    "\"camera\"",
    "\"$schema\"",
    "\"version\"",
    "\"extends\"",
    "\"name\"",
    "\"shader\"",
    "\"properties\"",
    "\"opacity\"",
    "\"base_color\"",
    "\"color\"",
    "\"hull_size\"",
    "\"steps\"",
    "\"shadow_color\"",
    "\"up\"",
    "\"position\"",
    "\"target\"",
    "\"range\"",
    "\"type\"",
    "\"orient\"",
    "\"orthographic\"",
    "\"bond_orders\"",
    "\"file_unit\"",
    "\"transparency\"",
    "\"k\"",
    "\"memory_mb\"",
    "\"movable\"",
    "\"softness\"",
    "\"\"",
];

fn pick<'a, T>(list: &'a [T], random: &mut Random) -> &'a T {
    &list[random.below(list.len())]
}

/// One change of one token; mostly, what comes out is JSON.
fn mutate(text: &str, pool: &[(String, Vec<Token>)], random: &mut Random) -> String {
    let places = tokens(text);
    let place = pick(&places, random).clone();
    let range = place.range();
    let here = &text[range.clone()];
    let (other, theirs) = pick(pool, random);
    let same_kind: Vec<&Token> =
        theirs.iter().filter(|token| std::mem::discriminant(*token) == std::mem::discriminant(&place)).collect();
    let from_other = || other[theirs[0].range()].to_owned();
    let foreign = match same_kind.is_empty() {
        true => from_other(),
        false => other[pick(&same_kind, random).range()].to_owned(),
    };
    let changed = match (&place, random.below(4)) {
        (Token::Key(_), 0) => pick(KEYS, random).to_string(),
        (Token::Key(_), 1) => misspelt(here, random),
        (Token::Value(_), 0 | 1) => pick(VALUES, random).to_string(),
        (Token::Value(_), 2) => match here.parse::<f64>() {
            Ok(number) => (number * pick(&[-1.0, 0.1, 10.0, 1000.0, 1e8], random)).to_string(),
            Err(_) if here.starts_with('"') => misspelt(here, random),
            Err(_) => foreign,
        },
        (Token::Member(_), 0) => format!("{}: {}", pick(KEYS, random), pick(VALUES, random)),
        (Token::Member(_), 1) => format!("{here}, {}: {}", pick(KEYS, random), pick(VALUES, random)),
        (Token::Member(_), 2) => format!("{here}, {foreign}"),
        (Token::Item(_), 0) => format!("{here}, {here}"),
        (Token::Item(_), 1) => format!("{here}, {}", pick(VALUES, random)),
        (Token::Member(_) | Token::Item(_), 3) => return without(text, range),
        _ => foreign,
    };
    format!("{}{changed}{}", &text[..range.start], &text[range.end..])
}

/// A text without a member or item, and without one of the commas beside it.
fn without(text: &str, range: std::ops::Range<usize>) -> String {
    let (before, after) = (&text[..range.start], &text[range.end..]);
    let rest = after.trim_start();
    match (rest.strip_prefix(','), before.trim_end().strip_suffix(',')) {
        (Some(rest), _) => format!("{before}{rest}"),
        (None, Some(before)) => format!("{before}{after}"),
        (None, None) => format!("{before}{after}"),
    }
}

/// A quoted word with a letter lost, doubled or in the other case.
fn misspelt(quoted: &str, random: &mut Random) -> String {
    let mut letters: Vec<char> = quoted.chars().collect();
    if letters.len() < 4 {
        return "\"x\"".to_owned();
    }
    let at = 1 + random.below(letters.len() - 2);
    match random.below(3) {
        0 => drop(letters.remove(at)),
        1 => letters.insert(at, letters[at]),
        _ => {
            letters[at] = if letters[at].is_lowercase() {
                letters[at].to_ascii_uppercase()
            } else {
                letters[at].to_ascii_lowercase()
            }
        }
    }
    letters.into_iter().collect()
}

#[test]
fn schema_and_loader_agree_on_damaged_styles() {
    /// Texts that are tried.
    const MUTATIONS: usize = 12_000;
    let house = House::with_transfers();
    let validator = house.validator();
    let mut texts: Vec<String> = styles().into_iter().map(|(_, text)| text).collect();
    // Every key of every table, with its default and its examples.
    texts.push(everything(&house));
    texts.push(EXTENDING.to_owned());
    texts.push(NEAR.to_owned());
    texts.push(PICTURED.to_owned());
    texts.extend(LIT.map(str::to_owned));
    let pool: Vec<(String, Vec<Token>)> = texts.iter().map(|text| (text.clone(), tokens(text))).collect();
    let mut random = Random(0x5C4E_3A00_0001);
    let (mut taken, mut refused, mut only_loader) = (0, 0, BTreeMap::<&str, u32>::new());
    for i in 0..MUTATIONS {
        let mut text = mutate(&texts[i % texts.len()], &pool, &mut random);
        if random.below(3) == 0 && parse(&text).is_ok() {
            text = mutate(&text, &pool, &mut random);
        }
        match judge(&house, &validator, &text) {
            Verdict::BothTake => taken += 1,
            Verdict::BothRefuse => refused += 1,
            Verdict::OnlyLoaderRefuses(codes) => {
                codes.into_iter().for_each(|c| *only_loader.entry(c).or_default() += 1)
            }
        }
    }
    println!("{taken} taken and {refused} refused by both; only the loader refuses {only_loader:?}");
    // All ends are reached, or the mutations would test nothing.
    assert!(taken > MUTATIONS / 10 && refused > MUTATIONS / 5, "{taken} taken, {refused} refused");
    for (code, _) in BEYOND_A_SCHEMA {
        assert!(only_loader.contains_key(code), "no mutation reaches {code:?}: {only_loader:?}");
    }
}

/// A style that changes another, with entries that take their shader from it.
const EXTENDING: &str = r##"{ "extends": "education.json", "camera": { "fov": 20, "bgcolor": "#101522" },
    "mapping": { "atom[element=C]": "ink", "connector": null, "*[chain=A]": "unlit" },
    "shaders": [{ "name": "carbon", "properties": { "steps": 2, "hull_size": "2pt" } },
                { "name": "ink", "shader": "unlit", "properties": { "base_color": "#101010" } },
                { "name": "glass", "shader": "curvature", "properties": { "gain": 3, "opacity": 0.5 } }] }"##;

/// Styles of entries that may be there once, twice or not at all, so that many changes leave them right.
const LIT: [&str; 4] = [
    r#"{ "lights": [{}, {}, {}, {}, {}, {}] }"#,
    r#"{ "camera": { "exposure": 0.5 }, "lights": [{}, { "intensity": 0.5 }, {}, { "type": "ambient" }, {}, { "color": "white" }, {},
        { "type": "ambient", "intensity": 0.4 }, {}, { "shadow": "soft" }, {}, { "position": [1, 2, 3] }] }"#,
    r#"{ "geometry": { "scale": 0.4 }, "lights": [{ "type": "point" }, {}, { "movable": true }, {}, { "range": 4 }, {}, { "space": "scene" }, {},
        { "softness": 5 }, {}, { "strength": 0.5, "shadow": "hard" }, {}, { "type": "ambient" }] }"#,
    r#"{ "lights": [{ "color": "white" }, {}, { "intensity": 2 }, {}, { "type": "ambient" }, {}, { "strength": 0.2 }, {}] }"#,
];

/// A small style that one number makes meaningless: the camera then stands where it looks.
const NEAR: &str = r#"{ "camera": { "position": [0, 0, 1], "target": [0, 0, 0] } }"#;

/// A small style with a picture, which only a style that is a file can have.
const PICTURED: &str = r#"{ "shaders": [{ "name": "a", "shader": "transferring",
    "properties": { "opacity_transfer": "a.png", "color_transfer": [[-1, 1, 1, 2], [0, 1, 1, 1], [1, 0.5, 0, 0]] } }] }"#;

/// A style with every key that there is.
fn everything(house: &House) -> String {
    let members = |params: &[Param]| -> String {
        let examples = params.iter().map(|param| {
            let value = param.examples.first().map_or_else(|| "0.5".to_owned(), |example| (*example).to_owned());
            format!("{:?}: {value}", param.name)
        });
        examples.collect::<Vec<_>>().join(", ")
    };
    let sections = SECTIONS.iter().filter(|section| section.key != "transparency").map(|section| {
        let object = format!("{{ {} }}", members(section.params));
        if section.is_list { format!("{:?}: [{object}]", section.key) } else { format!("{:?}: {object}", section.key) }
    });
    let drawn = house.0.iter();
    let shaders = drawn.map(|entry| {
        format!(
            "{{ \"name\": \"my {0}\", \"shader\": {0:?}, \"properties\": {{ {1} }} }}",
            entry.name,
            members(entry.params)
        )
    });
    let shaders = shaders.collect::<Vec<_>>().join(",\n");
    let transparency = "\"transparency\": { \"method\": \"auto\", \"k\": 8, \"memory_mb\": 512 }";
    format!(
        "{{ {}, {transparency},\n\"shaders\": [{shaders}], \"mapping\": {{ \"*\": \"my toon\" }} }}",
        sections.collect::<Vec<_>>().join(",\n")
    )
}

#[test]
fn a_style_with_every_key_loads_and_is_valid() {
    let house = House::new();
    assert_eq!(judge(&house, &house.validator(), &everything(&house)), Verdict::BothTake);
    assert_eq!(judge(&house, &house.validator(), EXTENDING), Verdict::BothTake);
}

#[test]
fn every_kind_of_value_is_judged_alike() {
    let house = House::with_transfers();
    let validator = house.validator();
    let mut tried = 0;
    let mut try_all = |style: &dyn Fn(&str) -> String| {
        for value in VALUES {
            judge(&house, &validator, &style(value));
            tried += 1;
        }
    };
    for section in SECTIONS {
        for param in section.params {
            let object = |value: &str| format!("{{ {:?}: {value} }}", param.name);
            try_all(&|value| match section.is_list {
                true => format!("{{ {:?}: [{}] }}", section.key, object(value)),
                false => format!("{{ {:?}: {} }}", section.key, object(value)),
            });
        }
    }
    for entry in &house.0 {
        for name in entry.params.iter().map(|param| param.name).chain(["base_color", "opacity", "gain"]) {
            let (shader, own) = (entry.name, format!("{{ {name:?}: "));
            try_all(&|value| {
                format!(
                    "{{ \"shaders\": [{{ \"name\": \"a\", \"shader\": {shader:?}, \"properties\": {own}{value} }} }}] }}"
                )
            });
        }
    }
    try_all(&|value| format!("{{ \"mapping\": {{ \"atom\": {value}, \"post_effects\": {value} }} }}"));
    for key in ["$schema", "version", "extends", "camera", "geometry", "mapping", "shaders", "lights", "transparency"] {
        try_all(&|value| format!("{{ {key:?}: {value} }}"));
    }
    for key in KEYS {
        judge(&house, &validator, &format!("{{ \"mapping\": {{ {key}: null }} }}"));
        judge(&house, &validator, &format!("{{ {key}: {{}} }}"));
    }
    assert!(tried > 3000, "{tried}");
}

#[test]
fn what_the_loader_takes_as_a_transfer_function_is_offered() {
    let house = House::with_transfers();
    let validator = house.validator();
    let verdict = |key: &str, value: &str| {
        let properties = format!("{{ {key:?}: {value} }}");
        let text = format!(
            "{{ \"shaders\": [{{ \"name\": \"a\", \"shader\": \"transferring\", \"properties\": {properties} }}] }}"
        );
        judge(&house, &validator, &text)
    };
    let schema = house.schema();
    for key in ["opacity_transfer", "color_transfer"] {
        let found = schema.pointer(&format!("/definitions/transferring_properties/properties/{key}")).unwrap();
        let offered = found["defaultSnippets"].as_array().unwrap();
        assert!(offered.len() > 5 && found["markdownDescription"].as_str().unwrap().contains("\n- `\""), "{found}");
        for name in offered.iter().filter_map(|offer| offer["body"].as_str()).filter(|body| !body.ends_with(".png")) {
            assert_eq!(verdict(key, &format!("{name:?}")), Verdict::BothTake, "{name}");
        }
        assert_eq!(verdict(key, "[[0, 1], [1, 0.5]]"), Verdict::BothTake);
        for value in ["[]", "[[0]]", "[[0, -1]]", "[[2, 1]]", "[0, 1]", "0", "null", "\"fig\"", "\"a.jpg\""] {
            assert_eq!(verdict(key, value), Verdict::BothRefuse, "{key}: {value}");
        }
        assert_eq!(verdict(key, "\"a.png\""), Verdict::OnlyLoaderRefuses(vec!["picture"]));
        assert_eq!(verdict(key, "[[1, 1], [0, 1]]"), Verdict::OnlyLoaderRefuses(vec!["meaningless"]));
    }
    assert_eq!(verdict("opacity_transfer", "[[0, 1, 0]]"), Verdict::BothTake);
    assert_eq!(verdict("color_transfer", "[[0, 1, 0]]"), Verdict::BothRefuse);
    assert_eq!(verdict("color_transfer", "[[-1, 1, 0, 2]]"), Verdict::BothTake);
    assert_eq!(verdict("opacity_transfer", "[[0, 1, 0, 0]]"), Verdict::BothRefuse);
}

#[test]
fn every_parameter_is_in_the_schema_with_its_default_and_range() {
    let house = House::new();
    let schema = house.schema();
    let check = |place: &str, params: &[Param]| {
        for param in params {
            let found = schema.pointer(&format!("{place}/properties/{}", param.name));
            let found = found.unwrap_or_else(|| panic!("{place} has no {:?}", param.name));
            let name = format!("{place}: {:?}", param.name);
            assert_eq!(found["description"], param.doc, "{name}");
            match param.default {
                Default::Unset => assert_eq!(found["default"], Value::Null, "{name}"),
                Default::Number(n) | Default::Radii(n) => assert_eq!(found["default"].as_f64(), Some(n), "{name}"),
                Default::Count(n) => assert_eq!(found["default"], n, "{name}"),
                Default::Text(text) => assert_eq!(found["default"], text, "{name}"),
                Default::Color(color) => assert_eq!(found["default"], color.to_string(), "{name}"),
                Default::BaseColor(color) => assert_eq!(found["default"], color.to_string(), "{name}"),
                Default::Boolean(value) => assert_eq!(found["default"], value, "{name}"),
                Default::Numbers(list) => assert_eq!(found["default"].as_array().unwrap().len(), list.len(), "{name}"),
                Default::Vector(vector) => {
                    assert_eq!(found["default"][2].as_f64(), Some(vector[2]), "{name}");
                }
            }
            if let (Some((lowest, highest)), Some(minimum)) = (param.range, found.get("minimum")) {
                assert_eq!(minimum.as_f64(), Some(lowest), "{name}");
                assert_eq!(found["maximum"].as_f64(), Some(highest.min(1e9)), "{name}");
            } else {
                let (lowest, _) = param.range.unzip();
                let of_items = found["anyOf"][0]["items"].get("minimum").and_then(Value::as_f64);
                assert!(lowest.is_none() || lowest == of_items, "{name}: its range is lost");
            }
        }
    };
    for section in SECTIONS {
        let items = if section.is_list { "/items" } else { "" };
        check(&format!("/properties/{}{items}", section.key), section.params);
    }
    for entry in house.0.iter() {
        check(&format!("/definitions/{}_properties", entry.name), entry.params);
    }
}

#[test]
fn the_schema_itself_is_no_style_and_that_is_said_once() {
    let house = House::new();
    let mistakes = house.load(&house.schema().to_string()).map(drop).unwrap_err();
    let message = mistakes.to_string();
    assert!(message.contains("the schema that editors check styles with, not a style"), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
}
