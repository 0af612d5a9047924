//! `shaders` and the names that `mapping` gives to them.

use std::collections::HashMap;

use super::catalog::{Catalog, CatalogEntry, Role};
use super::error::{Notice, Place, Problem};
use super::hint::{Hint, quote};
use super::read::{Reader, wrong_type, wrong_type_but};
use super::style::{EffectUse, Rule};
use super::syntax::{Member, Node, Tree};
use super::values::Values;

/// The keys of one entry of `shaders`.
const KEYS: [&str; 3] = ["name", "shader", "properties"];

/// What every shader of objects has.
pub(super) const SHARED: [&str; 2] = ["base_color", "opacity"];

/// Most names of a file that a message lists.
const MOST_NAMES: usize = 20;

/// Most names of a file that are compared with a wrong one.
const MOST_COMPARED: usize = 1000;

/// A shader or post effect with its properties: one entry of `shaders`, or a registered one with its defaults.
#[derive(Debug, Clone, PartialEq)]
pub struct ShaderUse {
    /// The name that `mapping` uses.
    pub name: String,
    /// The registered shader that draws.
    pub shader: &'static str,
    /// What it is for.
    pub role: Role,
    /// Its properties.
    pub values: Values,
    /// Its entry; `None` if the file declares none.
    pub place: Option<Place>,
    /// Its name, where the entry has one.
    pub name_place: Option<Place>,
}

/// The shaders of a style while it is read.
pub(super) struct Shaders<'a> {
    catalog: Catalog<'a>,
    /// All that are declared, then all that are used undeclared.
    pub(super) uses: Vec<ShaderUse>,
    /// `None`: declared, but so wrong that it cannot be used; what refers to it is no further mistake.
    declared: HashMap<String, Option<usize>>,
    undeclared: HashMap<&'static str, usize>,
    /// Whether `shaders` is no list, so that nobody knows what it declares.
    is_lost: bool,
}

impl<'a> Shaders<'a> {
    pub(super) fn new(catalog: Catalog<'a>) -> Self {
        Self { catalog, uses: Vec::new(), declared: HashMap::new(), undeclared: HashMap::new(), is_lost: false }
    }

    /// Reads the list `shaders`.
    pub(super) fn declare(&mut self, reader: &mut Reader<'_>, node: &Node) {
        self.is_lost = !matches!(node.value, Tree::List(_));
        let mut first = HashMap::new();
        for entry in reader.list("shaders", node) {
            let Some(name) = self.declare_one(reader, entry) else {
                continue;
            };
            let at = entry.get("name").unwrap_or(entry).span;
            let earlier = *first.entry(name.clone()).or_insert(at);
            if earlier != at {
                let (line, column) = reader.texts.line_column(earlier);
                reader.wrong(at, Problem::DuplicateName { name, line, column });
            }
        }
    }

    /// Reads one entry and answers its name, if it has one.
    fn declare_one(&mut self, reader: &mut Reader<'_>, entry: &Node) -> Option<String> {
        let members = match &entry.value {
            Tree::Object(members) => members,
            _ => {
                reader.wrong(entry.span, wrong_type("shaders", "a list of objects", entry));
                return None;
            }
        };
        let meant = entry.get("shader").and_then(Node::text).and_then(|name| self.catalog.get(name));
        for member in members.iter().filter(|member| !KEYS.contains(&member.key.as_str())) {
            reader.unknown_key("a shader entry", member, KEYS, meant);
        }
        let (name, shader) = (entry.get("name"), entry.get("shader"));
        if name.is_none() && shader.is_none() {
            reader.missing(entry.span, Problem::NamelessShader);
            return None;
        }
        let name = match name {
            Some(name) => reader.text("name", name).map(str::to_owned),
            None => {
                missing(reader, entry, "name", Hint::NONE);
                None
            }
        };
        let registered = match shader {
            Some(shader) => self.registered(reader, shader),
            None => {
                missing(reader, entry, "shader", Hint::list(self.catalog.names(None)));
                None
            }
        };
        let properties = match entry.get("properties") {
            Some(properties) => reader.object("properties", properties),
            None => &[],
        };
        let used = registered.map(|found| Self::use_of(reader, found, entry, name.as_deref(), properties));
        let name = name?;
        if !self.declared.contains_key(&name) {
            let index = used.map(|used| self.push(used));
            self.declared.insert(name.clone(), index);
        }
        Some(name)
    }

    fn registered(&self, reader: &mut Reader<'_>, shader: &Node) -> Option<&'a CatalogEntry> {
        let name = reader.text("shader", shader)?;
        let found = self.catalog.get(name);
        if found.is_none() {
            let hint = reader.hint(|| Hint::new(name, self.catalog.names(None)));
            reader.wrong(shader.span, Problem::UnknownName { what: "shader", name: name.to_owned(), hint });
        }
        found
    }

    fn use_of(
        reader: &mut Reader<'_>,
        entry: &CatalogEntry,
        node: &Node,
        name: Option<&str>,
        properties: &[Member],
    ) -> ShaderUse {
        ShaderUse {
            name: name.unwrap_or(entry.name).to_owned(),
            place: Some(reader.texts.place(node.span)),
            name_place: node.get("name").map(|name| reader.texts.place(name.span)),
            values: reader.table(&format!("shader {}", quote(entry.name)), properties, entry.params),
            ..with_defaults(entry)
        }
    }

    fn push(&mut self, used: ShaderUse) -> usize {
        self.uses.push(used);
        self.uses.len() - 1
    }

    /// What a name in `mapping` refers to: an entry of `shaders`, else a registered shader with its defaults.
    /// `key` is where it stands.
    pub(super) fn resolve(&mut self, reader: &mut Reader<'_>, key: &str, node: &Node, role: Role) -> Option<usize> {
        let expected = match role {
            Role::Object => "the name of a shader, or null to hide",
            Role::PostEffect => "a list of names of post effects",
        };
        let Some(name) = node.text() else {
            let write = match (&node.value, role) {
                (Tree::Bool(false), Role::Object) => Some("null".to_owned()),
                (Tree::Object(_), Role::Object) => {
                    Some("it as an entry of \"shaders\" with a \"name\", and that name here".to_owned())
                }
                _ => None,
            };
            reader.wrong(node.span, wrong_type_but(key, expected, node, write));
            return None;
        };
        if let Some(index) = self.declared.get(name) {
            let index = (*index)?;
            return self.check_role(reader, node, name, self.uses[index].role, role).then_some(index);
        }
        let Some(entry) = self.catalog.get(name) else {
            let hides = ["none", "hidden", "hide", "null", "off", "false"];
            if role == Role::Object && hides.contains(&name.to_lowercase().as_str()) {
                let problem = wrong_type_but(key, expected, node, Some("null, without quotes, to hide".to_owned()));
                reader.missing(node.span, problem);
                return None;
            }
            // What a list without brackets declares is not known.
            if self.is_lost {
                return None;
            }
            let what = if role == Role::Object { "shader" } else { "post effect" };
            let hint = reader.hint(|| self.names(name, role));
            reader.missing(node.span, Problem::UnknownName { what, name: name.to_owned(), hint });
            return None;
        };
        if !self.check_role(reader, node, name, entry.role, role) {
            return None;
        }
        Some(self.undeclared_use(entry))
    }

    /// What draws everything that nothing selects: `basic`, of the file if it declares one.
    pub(super) fn basic(&mut self) -> usize {
        let basic = self.catalog.basic();
        match self.declared.get(basic.name) {
            Some(Some(index)) if self.uses[*index].role == Role::Object => *index,
            _ => self.undeclared_use(basic),
        }
    }

    /// Warns of the entries of the style itself that nothing names. A base may hold more than a style takes from it.
    pub(super) fn warn_of_unused(
        &self,
        reader: &mut Reader<'_>,
        mapping: &[Rule],
        effects: &[EffectUse],
        basic: usize,
    ) {
        let mut is_used = vec![false; self.uses.len()];
        let named = mapping.iter().filter_map(|rule| rule.target).chain(effects.iter().map(|effect| effect.index));
        named.chain([basic]).for_each(|index| is_used[index] = true);
        let own = reader.texts.0[0].name.clone();
        for used in self.uses.iter().zip(is_used).filter(|(_, is_used)| !is_used).map(|(used, _)| used) {
            let Some(place) = used.name_place.clone().filter(|place| place.file == own) else { continue };
            let name = used.name.clone();
            let notice = match used.role {
                Role::Object => Notice::UnusedShader { name },
                Role::PostEffect => Notice::UnusedEffect { name },
            };
            reader.warn(place, notice);
        }
    }

    fn undeclared_use(&mut self, entry: &CatalogEntry) -> usize {
        if let Some(index) = self.undeclared.get(entry.name) {
            return *index;
        }
        let index = self.push(with_defaults(entry));
        self.undeclared.insert(entry.name, index);
        index
    }

    fn check_role(&self, reader: &mut Reader<'_>, node: &Node, name: &str, is: Role, due: Role) -> bool {
        if is == due {
            return true;
        }
        let hint = reader.hint(|| Hint { nearest: None, ..self.names(name, due) });
        let name = name.to_owned();
        let problem = match due {
            Role::Object => Problem::EffectAsShader { name, hint },
            Role::PostEffect => Problem::ShaderAsEffect { name, hint },
        };
        reader.wrong(node.span, problem);
        false
    }

    /// What may stand where `name` stands: entries of the file in their order, then what is registered.
    fn names(&self, name: &str, role: Role) -> Hint {
        let declared = self.uses.iter().filter(|used| used.place.is_some() && used.role == role);
        let declared: Vec<&str> = declared.map(|used| used.name.as_str()).take(MOST_COMPARED).collect();
        let registered = self.catalog.names(Some(role)).map(|name| -> &str { name });
        let undeclared = registered.filter(|name| !declared.contains(name));
        let listed = declared.iter().copied().take(MOST_NAMES).chain(undeclared);
        Hint::with_more(name, listed, declared.iter().copied().skip(MOST_NAMES))
    }
}

/// A registered shader with its defaults.
fn with_defaults(entry: &CatalogEntry) -> ShaderUse {
    ShaderUse {
        name: entry.name.to_owned(),
        shader: entry.name,
        role: entry.role,
        values: Values::defaults(entry.params),
        place: None,
        name_place: None,
    }
}

fn missing(reader: &mut Reader<'_>, entry: &Node, key: &'static str, hint: Hint) {
    reader.missing(entry.span, Problem::MissingKey { owner: "this shader entry".to_owned(), key, hint });
}
