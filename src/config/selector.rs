//! Selectors: `atom[element=O][residue=HOH]` picks objects of a scene.
//!
//! A type or `*`, then any number of `[attribute=glob]`, all of which must match. `*` stands for any characters and `?`
//! for one; case counts, except in `element`. A value that holds `]` is quoted with `"` or `'`.

use std::fmt;

use super::error::Problem;
use super::glob::Glob;
use super::hint::Hint;

/// The types of objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ObjectKind {
    /// One atom.
    Atom,
    /// The bond between two atoms.
    Connector,
    /// The backbone of a chain.
    Ribbon,
    /// The surface of a molecule.
    Surface,
    /// Triangles of a mesh file.
    Mesh,
}

impl ObjectKind {
    /// All types, in the order of the manual.
    pub const ALL: [Self; 5] = [Self::Atom, Self::Connector, Self::Ribbon, Self::Surface, Self::Mesh];

    /// The name in selectors.
    pub fn name(self) -> &'static str {
        match self {
            Self::Atom => "atom",
            Self::Connector => "connector",
            Self::Ribbon => "ribbon",
            Self::Surface => "surface",
            Self::Mesh => "mesh",
        }
    }

    /// One sentence for the manual, the schema and the editor.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Atom => "Atoms, drawn as spheres.",
            Self::Connector => {
                "Bonds between two atoms, drawn as rods; a rule picks one if either of its atoms matches."
            }
            Self::Ribbon => "The backbones of chains.",
            Self::Surface => "The surfaces of molecules.",
            Self::Mesh => "The triangles of mesh files.",
        }
    }

    /// What selectors can ask of this type.
    pub fn attributes(self) -> &'static [Attribute] {
        use Attribute::{Chain, Element, File, Material, Model, Name, Part, Residue};
        match self {
            Self::Mesh => &[Part, Material, File],
            Self::Atom | Self::Connector | Self::Ribbon | Self::Surface => &[Element, Name, Residue, Chain, Model],
        }
    }
}

/// What a selector can ask of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Attribute {
    /// Symbol of the element; letters of either case match.
    Element,
    /// Name of the atom, such as `CA`.
    Name,
    /// Name of the residue, such as `HOH`.
    Residue,
    /// Name of the chain.
    Chain,
    /// Number of the model.
    Model,
    /// Name of a part of a mesh.
    Part,
    /// Name of a material of a mesh.
    Material,
    /// Name of the mesh's file.
    File,
}

impl Attribute {
    /// All attributes, in the order of the manual.
    pub const ALL: [Self; 8] =
        [Self::Element, Self::Name, Self::Residue, Self::Chain, Self::Model, Self::Part, Self::Material, Self::File];

    /// The name in selectors.
    pub fn name(self) -> &'static str {
        match self {
            Self::Element => "element",
            Self::Name => "name",
            Self::Residue => "residue",
            Self::Chain => "chain",
            Self::Model => "model",
            Self::Part => "part",
            Self::Material => "material",
            Self::File => "file",
        }
    }

    /// Whether letters of either case match.
    pub fn ignores_case(self) -> bool {
        self == Self::Element
    }

    /// One sentence for the manual, the schema and the editor.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Element => "Symbol of the element, such as `C` or `Mg`; upper or lower case.",
            Self::Name => "Name of the atom in its file, such as `CA`.",
            Self::Residue => "Name of the residue, such as `HOH` for water.",
            Self::Chain => "Name of the chain, such as `A`.",
            Self::Model => "Number of the model, such as `1`.",
            Self::Part => "Name of a part of a mesh.",
            Self::Material => "Name of a material of a mesh.",
            Self::File => "Name of the mesh's file.",
        }
    }
}

/// A set of attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct AttributeSet(u8);

impl AttributeSet {
    /// Adds one.
    pub fn insert(&mut self, attribute: Attribute) {
        self.0 |= 1 << attribute as u8;
    }

    /// Whether it is in the set.
    pub fn contains(self, attribute: Attribute) -> bool {
        self.0 & (1 << attribute as u8) != 0
    }

    /// Whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The attributes of the set.
    pub fn iter(self) -> impl Iterator<Item = Attribute> {
        Attribute::ALL.into_iter().filter(move |attribute| self.contains(*attribute))
    }
}

/// A parsed selector. Equal to another if both are written alike.
#[derive(Debug, Clone, Eq)]
pub struct Selector {
    text: String,
    kind: Option<ObjectKind>,
    conditions: Vec<(Attribute, Glob)>,
}

/// The rest follows from the text.
impl PartialEq for Selector {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

/// The selector that was meant by what other programs call it.
fn meant(text: &str) -> Option<String> {
    match text.to_lowercase().as_str() {
        "bond" | "bonds" | "stick" | "sticks" => return Some("connector".to_owned()),
        "all" | "any" | "default" | "everything" => return Some("*".to_owned()),
        _ => {}
    }
    let (attribute, _) = text.trim_matches(['[', ']']).split_once('=')?;
    let is_known = Attribute::ALL.iter().any(|known| known.name() == attribute.trim());
    is_known.then(|| format!("*[{}]", text.trim_matches(['[', ']'])))
}

impl Selector {
    /// Parses a key of `mapping`.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        let bad = |reason: String, hint| Problem::BadSelector { text: text.to_owned(), reason, hint };
        let trimmed = text.trim();
        let (kind_name, mut rest) = trimmed.split_at(trimmed.find('[').unwrap_or(trimmed.len()));
        let kind_name = kind_name.trim_end();
        let kind = ObjectKind::ALL.into_iter().find(|kind| kind.name() == kind_name);
        if kind.is_none() && kind_name != "*" {
            let words = ObjectKind::ALL.into_iter().map(ObjectKind::name).chain(["*", "post_effects"]);
            let reason = format!("there is no type {}", super::hint::quote(kind_name));
            let hint = Hint { nearest: meant(trimmed), ..Hint::list(words.clone()) };
            return Err(bad(reason, if hint.nearest.is_some() { hint } else { Hint::new(kind_name, words) }));
        }
        let mut conditions = Vec::new();
        while let Some(after) = rest.strip_prefix('[') {
            let Some((name, value)) = after.split_once('=').filter(|(name, _)| !name.contains(['[', ']'])) else {
                return Err(bad("[attribute=value] is due after the type".to_owned(), Hint::NONE));
            };
            let name = name.trim();
            let allowed: &[Attribute] = kind.map_or(&Attribute::ALL, ObjectKind::attributes);
            let Some(attribute) = allowed.iter().find(|attribute| attribute.name() == name) else {
                let reason = format!("{kind_name:?} has no attribute {}", super::hint::quote(name));
                return Err(bad(reason, Hint::new(name, allowed.iter().map(|attribute| attribute.name()))));
            };
            let (value, after) = read_value(value).map_err(|reason| bad(reason, Hint::NONE))?;
            conditions.push((*attribute, Glob::new(value)));
            rest = after;
        }
        if !rest.is_empty() {
            return Err(bad(format!("{} after ] is too much", super::hint::quote(rest)), Hint::NONE));
        }
        Ok(Self { text: text.to_owned(), kind, conditions })
    }

    /// The type it is for; `None` is `*`.
    pub fn kind(&self) -> Option<ObjectKind> {
        self.kind
    }

    /// The attributes it asks for.
    pub fn attributes(&self) -> AttributeSet {
        let mut set = AttributeSet::default();
        self.conditions.iter().for_each(|(attribute, _)| set.insert(*attribute));
        set
    }

    /// Each attribute with the pattern that it must match.
    pub fn conditions(&self) -> impl Iterator<Item = (Attribute, &str)> {
        self.conditions.iter().map(|(attribute, glob)| (*attribute, glob.pattern()))
    }

    /// The conditions that an object does not meet, in the order of the text, given a way to ask for its attributes.
    pub fn unmet<'a>(
        &self,
        attribute: &dyn Fn(Attribute) -> Option<&'a str>,
    ) -> impl Iterator<Item = (Attribute, &str)> {
        let meets =
            |of: Attribute, glob: &Glob| attribute(of).is_some_and(|value| glob.matches(value, of.ignores_case()));
        self.conditions.iter().filter(move |(of, glob)| !meets(*of, glob)).map(|(of, glob)| (*of, glob.pattern()))
    }

    /// What it asks, in one form for every way to write it: two that ask the same match the same objects.
    pub(super) fn question(&self) -> (Option<ObjectKind>, Vec<(Attribute, String)>) {
        let plain = |attribute, pattern: &str| match attribute {
            Attribute::Element => pattern.to_ascii_lowercase(),
            _ => pattern.to_owned(),
        };
        let mut conditions: Vec<_> = self.conditions().map(|(of, pattern)| (of, plain(of, pattern))).collect();
        conditions.sort();
        (self.kind, conditions)
    }

    /// Whether it is for objects of a type at all.
    pub fn is_for(&self, kind: ObjectKind) -> bool {
        self.kind.is_none_or(|own| own == kind)
    }

    /// Whether it picks an object, given its type and a way to ask for its attributes. An attribute that the object
    /// does not have matches nothing.
    pub fn matches<'a>(&self, kind: ObjectKind, attribute: &dyn Fn(Attribute) -> Option<&'a str>) -> bool {
        self.is_for(kind) && self.unmet(attribute).next().is_none()
    }

    /// Its rank among selectors that match the same object: more attributes win, then a type over `*`.
    /// Of equal ranks the later one wins.
    pub fn rank(&self) -> (usize, bool) {
        (self.conditions.len(), self.kind.is_some())
    }
}

impl fmt::Display for Selector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// The value up to its `]`, and what follows that.
fn read_value(text: &str) -> Result<(&str, &str), String> {
    let text = text.trim_start();
    let close = || "] is missing".to_owned();
    if let Some(quote) = text.chars().next().filter(|c| matches!(c, '"' | '\'')) {
        let (value, after) = text[1..].split_once(quote).ok_or("the quote is never closed")?;
        let after = after.trim_start().strip_prefix(']').ok_or_else(close)?;
        return Ok((value, after.trim_start()));
    }
    let (value, after) = text.split_once(']').ok_or_else(close)?;
    match value.trim() {
        "" => Err("the value is empty: write \"\" in quotes if that is meant".to_owned()),
        value => Ok((value, after.trim_start())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picks(selector: &str, kind: ObjectKind, of: &[(Attribute, &str)]) -> bool {
        let selector = Selector::parse(selector).unwrap();
        selector.matches(kind, &|wanted| of.iter().find(|(attribute, _)| *attribute == wanted).map(|(_, value)| *value))
    }

    #[test]
    fn types_and_attributes_must_all_match() {
        let water = [(Attribute::Element, "O"), (Attribute::Residue, "HOH"), (Attribute::Name, "O")];
        for selector in
            ["atom", "*", "atom[element=O]", "atom[element=o][residue=HOH]", "*[residue=H*]", " atom [ name = O ] "]
        {
            assert!(picks(selector, ObjectKind::Atom, &water), "{selector}");
        }
        for selector in [
            "mesh",
            "connector",
            "atom[element=C]",
            "atom[residue=hoh]",
            "atom[element=O][residue=ALA]",
            "atom[chain=*]",
        ] {
            assert!(!picks(selector, ObjectKind::Atom, &water), "{selector}");
        }
    }

    #[test]
    fn quoted_values_may_hold_brackets() {
        let part = [(Attribute::Part, "A[1]")];
        assert!(picks("mesh[part=\"A[1]\"]", ObjectKind::Mesh, &part));
        assert!(picks("mesh[part='A[1]']", ObjectKind::Mesh, &part));
        assert!(picks("atom[name=C1']", ObjectKind::Atom, &[(Attribute::Name, "C1'")]));
        assert!(picks("atom[chain='']", ObjectKind::Atom, &[(Attribute::Chain, "")]));
    }

    #[test]
    fn ranks_follow_attributes_then_type() {
        let rank = |text: &str| Selector::parse(text).unwrap().rank();
        assert!(rank("*[name=a][chain=b]") > rank("atom[name=a]"));
        assert!(rank("atom[name=a]") > rank("*[name=a]"));
        assert!(rank("*[name=a]") > rank("atom"));
        assert!(rank("atom") > rank("*"));
    }

    #[test]
    fn bad_selectors_say_why() {
        for (text, message) in [
            (
                "atm",
                "selector \"atm\": there is no type \"atm\"; did you mean \"atom\"? allowed: atom, connector, ribbon, surface, mesh, *, post_effects",
            ),
            (
                "mesh[element=O]",
                "selector \"mesh[element=O]\": \"mesh\" has no attribute \"element\"; allowed: part, material, file",
            ),
            (
                "atom[elemnt=O]",
                "selector \"atom[elemnt=O]\": \"atom\" has no attribute \"elemnt\"; did you mean \"element\"? allowed: element, name, residue, chain, model",
            ),
            ("atom[element=O", "selector \"atom[element=O\": ] is missing"),
            ("atom[element]", "selector \"atom[element]\": [attribute=value] is due after the type"),
            ("atom[", "selector \"atom[\": [attribute=value] is due after the type"),
            ("atom[name='O]", "selector \"atom[name='O]\": the quote is never closed"),
            ("atom[name=]", "selector \"atom[name=]\": the value is empty: write \"\" in quotes if that is meant"),
            ("atom[name=O]x", "selector \"atom[name=O]x\": \"x\" after ] is too much"),
        ] {
            assert_eq!(Selector::parse(text).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn sets_hold_what_was_added() {
        let set = Selector::parse("*[part=a][element=b]").unwrap().attributes();
        assert_eq!(set.iter().collect::<Vec<_>>(), [Attribute::Element, Attribute::Part]);
        assert!(AttributeSet::default().is_empty());
    }
}
