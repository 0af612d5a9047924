//! A style, resolved: every name bound, every property with a value, ready for an engine.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::camera::Camera;
use super::catalog::{Catalog, Role};
use super::diagnostic::SourceTexts;
use super::error::{Mistakes, Notice, Place, Problem, Warning};
use super::extends::{Merged, Replaced};
use super::geometry::{self, Geometry};
use super::light::Light;
use super::param::Param;
use super::read::{Reader, wrong_type};
use super::selector::{Attribute, AttributeSet, ObjectKind, Selector};
use super::shaders::{ShaderUse, Shaders};
use super::source::Texts;
use super::syntax::{Node, Span, Tree};
use super::transparency::{self, Transparency};
use super::values::Values;

/// The version of style files that this program reads.
pub const VERSION: u32 = 1;

/// The keys of a style file.
pub const KEYS: [&str; 9] =
    ["$schema", "version", "extends", "camera", "geometry", "mapping", "shaders", "lights", "transparency"];

/// The key of `mapping` that lists post effects.
pub(super) const POST_EFFECTS: &str = "post_effects";

/// One line of `mapping`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Which objects.
    pub selector: Selector,
    /// What draws them, as an index into [`Style::shaders`]; `None` hides them.
    pub target: Option<usize>,
    /// Where it is written.
    pub place: Place,
}

/// One entry of `post_effects`.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectUse {
    /// The effect, as an index into [`Style::shaders`].
    pub index: usize,
    /// Where it is listed.
    pub place: Place,
}

/// The values of the sections of a style, with the origin of each.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionValues {
    /// Of `camera`.
    pub camera: Values,
    /// Of `geometry`.
    pub geometry: Values,
    /// Of `transparency`.
    pub transparency: Values,
    /// Of each light.
    pub lights: Vec<Values>,
    /// Where `lights` are listed; `None`: the style has none, and the default ones shine.
    pub lights_place: Option<Place>,
    /// Where post effects are listed, if they are.
    pub effects_place: Option<Place>,
}

/// What the values and entries of a style replace or change in its bases.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overrides(HashMap<(Arc<str>, usize), Place>);

impl Overrides {
    fn new(texts: &Texts, replaced: &Replaced) -> Self {
        let spot = |span| {
            let (line, column) = texts.line_column(span);
            let text = &texts.0[span.file as usize];
            let (start, end) = (span.start as usize, span.end as usize);
            Place { file: text.name.clone(), line, column, start, end, path: String::new() }
        };
        let key = |span: Span| (texts.0[span.file as usize].name.clone(), span.start as usize);
        Self(replaced.0.iter().map(|(own, base)| (key(*own), spot(*base))).collect())
    }

    /// What lies at the same path of the nearest base, if that has it; without the path.
    pub fn of(&self, place: &Place) -> Option<&Place> {
        self.0.get(&(place.file.clone(), place.start))
    }
}

/// A style without mistakes.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// Projection, background, framing.
    pub camera: Camera,
    /// How large atoms and bonds are.
    pub geometry: Geometry,
    /// The rules, the one that wins first: the first that matches an object decides.
    pub mapping: Vec<Rule>,
    /// Every shader that is declared or used; rules, post effects and `basic` are indices into it.
    pub shaders: Vec<ShaderUse>,
    /// What draws the objects that no rule matches.
    pub basic: usize,
    /// The post effects that this version draws, in the order of the file.
    pub post_effects: Vec<usize>,
    /// Every post effect that the file lists, drawn or not, in its order.
    pub listed_effects: Vec<EffectUse>,
    /// The lights.
    pub lights: Vec<Light>,
    /// How fragments that let light through are put in order.
    pub transparency: Transparency,
    /// What the file asks for and does not get.
    pub warnings: Vec<Warning>,
    /// How many more warnings there are than the list holds.
    pub unlisted_warnings: usize,
    /// The values behind camera, geometry, lights and transparency, with their origins.
    pub values: SectionValues,
    /// What it replaces of its bases.
    pub overrides: Overrides,
    /// The texts of its files, for the source lines under messages.
    pub texts: SourceTexts,
    /// The files it was read from, itself first, then its bases, then its pictures: what to watch for changes.
    pub files: Vec<PathBuf>,
}

impl Style {
    /// What draws an object, as an index into [`Style::shaders`]; `None` hides it.
    /// A connector is asked for twice, with the attributes of either atom.
    pub fn shader_of<'a>(&self, kind: ObjectKind, attribute: &dyn Fn(Attribute) -> Option<&'a str>) -> Option<usize> {
        match self.rule_of(kind, attribute) {
            Some(rule) => rule.target,
            None => Some(self.basic),
        }
    }

    /// The rule that decides about an object; `None`: no rule matches it.
    pub fn rule_of<'a>(&self, kind: ObjectKind, attribute: &dyn Fn(Attribute) -> Option<&'a str>) -> Option<&Rule> {
        self.mapping.iter().find(|rule| rule.selector.matches(kind, attribute))
    }

    /// The attributes that decide about objects of a type: objects that are equal in these are drawn alike, so that
    /// an engine needs to ask once for each combination and not once for each of 100,000 atoms.
    pub fn attributes_used(&self, kind: ObjectKind) -> AttributeSet {
        let mut used = AttributeSet::default();
        for rule in self.mapping.iter().filter(|rule| rule.selector.is_for(kind)) {
            rule.selector.attributes().iter().for_each(|attribute| used.insert(attribute));
        }
        used
    }
}

/// Resolves a merged tree.
pub(super) fn resolve(texts: &Texts, merged: Merged, catalog: &Catalog<'_>) -> Result<Style, Mistakes> {
    let mut reader = Reader::new(texts, *catalog, merged.mistakes);
    let root = &merged.root;
    if let Some(node) = root.get("$id").filter(|node| node.text() == Some(super::schema::ID)) {
        let reason = "this is the schema that editors check styles with, not a style: name a style, such as one that \
                      restyle copy makes";
        reader.wrong(node.span, Problem::Meaningless(reason));
        return Err(reader.mistakes);
    }
    for member in reader.object("style", root) {
        if !KEYS.contains(&member.key.as_str()) {
            reader.unknown_key("a style", member, KEYS, None);
        }
    }
    if let Some(schema) = root.get("$schema") {
        reader.text("$schema", schema);
    }
    let camera = match root.get("camera") {
        Some(node) => Camera::read(&mut reader, node),
        None => Values::defaults(super::camera::PARAMS),
    };
    let geometry = section(&mut reader, root, "geometry", geometry::PARAMS);
    let transparency = section(&mut reader, root, "transparency", transparency::PARAMS);
    let lights = match root.get("lights") {
        Some(node) => reader.list("lights", node).iter().map(|light| Light::read(&mut reader, light)).collect(),
        None => Light::default_lights(),
    };
    let lights_place = root.get("lights").map(|node| texts.place(node.span));
    let effects_node = root.get("mapping").and_then(|mapping| mapping.get(POST_EFFECTS));
    let effects_place = effects_node.map(|node| texts.place(node.span));
    let values = SectionValues { camera, geometry, transparency, lights, lights_place, effects_place };
    let mut shaders = Shaders::new(*catalog);
    if let Some(node) = root.get("shaders") {
        shaders.declare(&mut reader, node);
    }
    let (mapping, listed_effects) = match root.get("mapping") {
        Some(node) => read_mapping(&mut reader, &mut shaders, node),
        None => (Vec::new(), Vec::new()),
    };
    let basic = shaders.basic();
    if reader.mistakes.is_empty() {
        shaders.warn_of_unused(&mut reader, &mapping, &listed_effects, basic);
    }
    let Reader { mut mistakes, mut warnings, unlisted_warnings, pictures, .. } = reader;
    let files: Vec<PathBuf> = merged.files.into_iter().chain(pictures.into_files()).collect();
    let order = |place: &Place| (texts.0.iter().position(|text| text.name == place.file), place.start);
    warnings.sort_by_key(|warning| order(&warning.place));
    if !mistakes.is_empty() {
        mistakes.list.sort_by_key(|mistake| order(&mistake.place));
        return Err(Mistakes { files, warnings, unlisted_warnings, ..mistakes });
    }
    Ok(Style {
        camera: Camera::new(&values.camera),
        geometry: Geometry::new(&values.geometry),
        mapping,
        shaders: shaders.uses,
        basic,
        post_effects: listed_effects.iter().map(|effect| effect.index).collect(),
        listed_effects,
        lights: values.lights.iter().map(Light::new).collect(),
        transparency: Transparency::new(&values.transparency),
        warnings,
        unlisted_warnings,
        values,
        overrides: Overrides::new(texts, &merged.replaced),
        texts: SourceTexts::default(),
        files,
    })
}

fn section(reader: &mut Reader<'_>, root: &Node, name: &str, params: &'static [Param]) -> Values {
    match root.get(name) {
        Some(node) => {
            let members = reader.object(name, node);
            reader.table(name, members, params)
        }
        None => Values::defaults(params),
    }
}

fn read_mapping(reader: &mut Reader<'_>, shaders: &mut Shaders<'_>, node: &Node) -> (Vec<Rule>, Vec<EffectUse>) {
    let mut rules = Vec::new();
    let mut effects = Vec::new();
    for member in reader.object("mapping", node) {
        if member.key == POST_EFFECTS {
            for item in reader.list(POST_EFFECTS, &member.value) {
                let index = shaders.resolve(reader, POST_EFFECTS, item, Role::PostEffect);
                effects.extend(index.map(|index| EffectUse { index, place: reader.texts.place(item.span) }));
            }
            continue;
        }
        let selector = match Selector::parse_or(&member.key, &[POST_EFFECTS]) {
            Ok(selector) => Some(selector),
            // What is no selector may be a key of another part, whose value is then no name of a shader.
            Err(_) if reader.is_stray(&member.key) => {
                let kinds = ObjectKind::ALL.into_iter().map(ObjectKind::name);
                reader.unknown_key("mapping", member, kinds.chain(["*", POST_EFFECTS]), None);
                continue;
            }
            Err(problem) => {
                reader.wrong(member.key_span, problem);
                None
            }
        };
        let target = match &member.value.value {
            Tree::Null => None,
            _ => match shaders.resolve(reader, &member.key, &member.value, Role::Object) {
                Some(index) => Some(index),
                None => continue,
            },
        };
        let Some(selector) = selector else { continue };
        let place = reader.texts.place(member.key_span);
        reader.warn_of_undrawn_type(&selector, &place);
        rules.push(Rule { selector, target, place });
    }
    warn_of_beaten(reader, &rules);
    // The later of two equal ranks wins: turn the order round, then sort without disturbing it.
    rules.reverse();
    rules.sort_by_key(|rule| std::cmp::Reverse(rule.selector.rank()));
    (rules, effects)
}

/// Warns of each rule that another one of the same file always beats: both ask the same, and that one comes later.
/// `rules` are in the order of the text. Over a base, to write a selector in another way is to change the base.
fn warn_of_beaten(reader: &mut Reader<'_>, rules: &[Rule]) {
    let mut last = HashMap::with_capacity(rules.len());
    for rule in rules {
        last.insert((rule.place.file.clone(), rule.selector.question()), rule);
    }
    for rule in rules {
        let winner = last[&(rule.place.file.clone(), rule.selector.question())];
        if winner.place.start != rule.place.start {
            let (selector, later) = (rule.selector.to_string(), winner.selector.to_string());
            let (line, column) = (winner.place.line, winner.place.column);
            reader.warn(rule.place.clone(), Notice::NeverDecides { selector, later, line, column });
        }
    }
}

/// Refuses a file of another version. Each file is asked, a base too.
pub(super) fn check_version(root: &Node) -> Result<(), (super::syntax::Span, Problem)> {
    let Some(node) = root.get("version") else {
        return Ok(());
    };
    match node.value {
        Tree::Number(n) if n == f64::from(VERSION) => Ok(()),
        Tree::Number(value) => {
            let allowed = format!("be {VERSION}: this program reads no other version of style files");
            Err((node.span, Problem::OutOfRange { name: "version".to_owned(), value, allowed }))
        }
        _ => Err((node.span, wrong_type("version", &format!("the number {VERSION}"), node))),
    }
}
