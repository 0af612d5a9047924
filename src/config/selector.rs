//! Selectors: `atom[element=O][residue=HOH]` picks objects of a scene.
//!
//! A type or `*`, then any number of `[attribute=glob]`, all of which must match. `*` stands for any characters and `?`
//! for one; case counts, except in `element`. Where values are numbers, `A..B`, `A..` and `..B` are ranges that hold their
//! ends. A value that holds `]` is quoted with `"` or `'`.

use std::fmt;

use super::error::Problem;
use super::hint::Hint;
use super::pattern::{BadPattern, Pattern};

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
        use Attribute::{
            Altloc, BFactor, Chain, Charge, Element, File, Kind, Material, Model, Name, Node, Number, Part, Residue,
        };
        match self {
            Self::Mesh => &[Part, Material, Node, File],
            Self::Atom | Self::Connector | Self::Ribbon | Self::Surface => {
                &[Element, Name, Residue, Number, Kind, Chain, Model, Altloc, BFactor, Charge, File]
            }
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
    /// Number of the residue with its insertion code.
    Number,
    /// What the residue is, such as `protein`.
    Kind,
    /// Name of the chain.
    Chain,
    /// Number of the model.
    Model,
    /// Letter of the alternate location.
    Altloc,
    /// Temperature factor.
    BFactor,
    /// Charge.
    Charge,
    /// Name of a part of a mesh.
    Part,
    /// Name of a material of a mesh.
    Material,
    /// The way to a part through the tree of its file.
    Node,
    /// Name of the file.
    File,
}

/// What the values of an attribute are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttributeValues {
    /// Texts.
    Texts,
    /// Whole numbers, maybe with a letter: asked for as texts, or by a range.
    Numbers,
    /// Measures, which nobody writes to the last digit: asked for by a range alone.
    Measures,
}

impl Attribute {
    /// All attributes, in the order of the manual.
    pub const ALL: [Self; 14] = [
        Self::Element,
        Self::Name,
        Self::Residue,
        Self::Number,
        Self::Kind,
        Self::Chain,
        Self::Model,
        Self::Altloc,
        Self::BFactor,
        Self::Charge,
        Self::Part,
        Self::Material,
        Self::Node,
        Self::File,
    ];

    /// The name in selectors.
    pub fn name(self) -> &'static str {
        match self {
            Self::Element => "element",
            Self::Name => "name",
            Self::Residue => "residue",
            Self::Number => "number",
            Self::Kind => "kind",
            Self::Chain => "chain",
            Self::Model => "model",
            Self::Altloc => "altloc",
            Self::BFactor => "b_factor",
            Self::Charge => "charge",
            Self::Part => "part",
            Self::Material => "material",
            Self::Node => "node",
            Self::File => "file",
        }
    }

    /// Whether letters of either case match.
    pub fn ignores_case(self) -> bool {
        self == Self::Element
    }

    /// What its values are.
    pub fn values(self) -> AttributeValues {
        match self {
            Self::Number | Self::Model => AttributeValues::Numbers,
            Self::BFactor | Self::Charge => AttributeValues::Measures,
            _ => AttributeValues::Texts,
        }
    }

    /// One sentence for the manual, the schema and the editor.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Element => "Symbol of the element, such as `C` or `Mg`; upper or lower case.",
            Self::Name => "Name of the atom in its file, such as `CA`.",
            Self::Residue => "Name of the residue, such as `HOH` for water.",
            Self::Number => "Number of the residue, such as `42`, with its insertion code, such as `100A`; or a range.",
            Self::Kind => "What the residue is: `protein`, `nucleic`, `sugar`, `water`, `ion`, `ligand` or `other`.",
            Self::Chain => "Name of the chain, such as `A`.",
            Self::Model => "Number of the model, such as `1`; or a range.",
            Self::Altloc => "Letter of the alternate location, such as `B`; empty where there is one location.",
            Self::BFactor => "A range of temperature factors, such as `50..`.",
            Self::Charge => "A range of charges, such as `..-0.5`.",
            Self::Part => "Name of a part of a mesh, such as `Bolt*`.",
            Self::Material => "Name of a material of a mesh.",
            Self::Node => "The way to a part of a mesh through the tree of its file, such as `Engine/*/Bolt`.",
            Self::File => "Name of the file, such as `4hhb.pdb`.",
        }
    }
}

/// A set of attributes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct AttributeSet(u16);

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

    /// Whether it has all of another.
    pub fn covers(self, other: Self) -> bool {
        other.0 & !self.0 == 0
    }

    /// What either has.
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The attributes of the set.
    pub fn iter(self) -> impl Iterator<Item = Attribute> {
        Attribute::ALL.into_iter().filter(move |attribute| self.contains(*attribute))
    }
}

/// A parsed selector. Equal to another if both are written alike.
#[derive(Debug, Clone)]
pub struct Selector {
    text: String,
    kind: Option<ObjectKind>,
    conditions: Vec<(Attribute, Pattern)>,
}

/// The rest follows from the text.
impl PartialEq for Selector {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Eq for Selector {}

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
    /// Parses a selector.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        Self::parse_or(text, &[])
    }

    /// The same where other words may stand, too, which are allowed then as types are.
    pub(super) fn parse_or(text: &str, words: &[&str]) -> Result<Self, Problem> {
        let bad = |reason: String, hint| Problem::BadSelector { text: text.to_owned(), reason, hint };
        let trimmed = text.trim();
        let (kind_name, mut rest) = trimmed.split_at(trimmed.find('[').unwrap_or(trimmed.len()));
        let kind_name = kind_name.trim_end();
        let kind = ObjectKind::ALL.into_iter().find(|kind| kind.name() == kind_name);
        if kind.is_none() && kind_name != "*" {
            let kinds = ObjectKind::ALL.into_iter().map(|kind| -> &str { kind.name() });
            let words = kinds.chain(["*"]).chain(words.iter().copied());
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
            let pattern = Pattern::read(*attribute, value).map_err(|wrong| match wrong {
                BadPattern::Reversed => Problem::Meaningless("a range has its smaller end first: 10..40, not 40..10"),
                BadPattern::NoRange => {
                    let kinds = if attribute.values() == AttributeValues::Measures { "is asked by" } else { "has" };
                    let value = super::hint::quote(value);
                    bad(format!("{name} {kinds} ranges such as 10..40, 10.. or ..40, and {value} is none"), Hint::NONE)
                }
            })?;
            conditions.push((*attribute, pattern));
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
        self.conditions.iter().map(|(attribute, pattern)| (*attribute, pattern.text()))
    }

    /// What it asks of an attribute.
    pub(super) fn patterns(&self, attribute: Attribute) -> impl Iterator<Item = &Pattern> {
        self.conditions.iter().filter(move |(of, _)| *of == attribute).map(|(_, pattern)| pattern)
    }

    /// The conditions that an object does not meet, in the order of the text, given a way to ask for its attributes.
    pub fn unmet<'a>(
        &self,
        attribute: &dyn Fn(Attribute) -> Option<&'a str>,
    ) -> impl Iterator<Item = (Attribute, &str)> {
        let meets = |of: Attribute, pattern: &Pattern| {
            attribute(of).is_some_and(|value| pattern.matches(value, of.ignores_case()))
        };
        self.conditions.iter().filter(move |(of, pattern)| !meets(*of, pattern)).map(|(of, p)| (*of, p.text()))
    }

    /// What it asks, in one form for every way to write it: two that ask the same match the same objects.
    pub(super) fn question(&self) -> (Option<ObjectKind>, Vec<(Attribute, String)>) {
        let plain = |of: Attribute, pattern: &Pattern| match pattern {
            Pattern::Text(glob) if of.ignores_case() => glob.pattern().to_ascii_lowercase(),
            Pattern::Text(glob) => glob.pattern().to_owned(),
            Pattern::Range(range, _) => range.to_string(),
        };
        let mut conditions: Vec<_> = self.conditions.iter().map(|(of, pattern)| (*of, plain(*of, pattern))).collect();
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
    fn numbers_are_asked_by_ranges() {
        let of = |attribute, value| [(attribute, value)];
        for (selector, attribute, value, expected) in [
            ("atom[number=10..40]", Attribute::Number, "40", true),
            ("atom[number=10..40]", Attribute::Number, "40B", true),
            ("atom[number=10..40]", Attribute::Number, "41", false),
            ("atom[number=100A]", Attribute::Number, "100A", true),
            ("atom[number=100A]", Attribute::Number, "100", false),
            ("atom[number=1?]", Attribute::Number, "17", true),
            ("*[model=..2]", Attribute::Model, "2", true),
            ("connector[b_factor=50..]", Attribute::BFactor, "50", true),
            ("atom[charge=..-0.5]", Attribute::Charge, "-0.4", false),
            ("atom[charge = ' .. -0.5 ' ]", Attribute::Charge, "-1", true),
            ("mesh[part=1..2]", Attribute::Part, "1..2", true),
            ("mesh[node=A/*/C]", Attribute::Node, "A/B/B/C", true),
        ] {
            let kind = if attribute == Attribute::BFactor { ObjectKind::Connector } else { ObjectKind::Atom };
            let kind = if selector.starts_with("mesh") { ObjectKind::Mesh } else { kind };
            assert_eq!(picks(selector, kind, &of(attribute, value)), expected, "{selector} on {value}");
        }
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
                "selector \"atm\": there is no type \"atm\"; did you mean \"atom\"? allowed: atom, connector, ribbon, surface, mesh, *",
            ),
            (
                "mesh[element=O]",
                "selector \"mesh[element=O]\": \"mesh\" has no attribute \"element\"; allowed: part, material, node, file",
            ),
            (
                "atom[elemnt=O]",
                "selector \"atom[elemnt=O]\": \"atom\" has no attribute \"elemnt\"; did you mean \"element\"? allowed: element, name, residue, number, kind, chain, model, altloc, b_factor, charge, file",
            ),
            (
                "atom[b_factor=20]",
                "selector \"atom[b_factor=20]\": b_factor is asked by ranges such as 10..40, 10.. or ..40, and \"20\" is none",
            ),
            (
                "atom[number=10..x]",
                "selector \"atom[number=10..x]\": number has ranges such as 10..40, 10.. or ..40, and \"10..x\" is none",
            ),
            ("atom[number=40..10]", "a range has its smaller end first: 10..40, not 40..10"),
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
