//! Classes of objects: objects that no selector can tell apart are resolved once.
//!
//! Only what the rules ask for takes part, so that a style of elements has a class for each element, and residue numbers
//! or temperature factors make classes only where a rule names them. Classes that a style asks less of still hold.

use std::collections::HashMap;
use std::hash::Hash;

use crate::config::{Attribute, AttributeSet, ObjectKind, Selector, Style};
use crate::scene::{Bond, Molecule, Scene};

/// Objects of a scene by what selectors can ask of them.
#[derive(Debug)]
pub(super) struct Classes {
    /// What takes part.
    asked: AttributeSet,
    /// The class of each object.
    pub(super) of_object: Vec<u32>,
    /// The number of classes.
    pub(super) count: usize,
    columns: Vec<Column>,
}

/// The values of one attribute.
#[derive(Debug)]
pub(super) struct Column {
    pub(super) attribute: Attribute,
    /// The different values; two may have the same text.
    pub(super) texts: Vec<String>,
    /// The value of each class.
    pub(super) of_class: Vec<u32>,
}

/// What the rules of a style ask of objects of some types that have the same attributes.
pub(super) fn asked(style: &Style, kinds: &[ObjectKind]) -> AttributeSet {
    let mut asked = AttributeSet::default();
    for kind in kinds {
        let used = style.attributes_used(*kind);
        kind.attributes().iter().filter(|of| used.contains(**of)).for_each(|of| asked.insert(*of));
    }
    asked
}

/// What a selector asks of objects of a type.
pub(super) fn asked_by(selector: &Selector, kind: ObjectKind) -> AttributeSet {
    let mut asked = AttributeSet::default();
    kind.attributes().iter().filter(|of| selector.attributes().contains(**of)).for_each(|of| asked.insert(*of));
    asked
}

impl Classes {
    /// Sorts the atoms of a scene, in time linear in their number.
    pub(super) fn of_atoms(scene: &Scene, asked: AttributeSet) -> Classes {
        let molecule = &scene.molecule;
        let asks = |attribute| asked.contains(attribute);
        // First the residues, of which there are fewer: what follows needs one number of each.
        let group_of_residue = group_residues(molecule, asked);
        let [element, name, altloc] = [Attribute::Element, Attribute::Name, Attribute::Altloc].map(asks);
        let [b_factor, charge] = [Attribute::BFactor, Attribute::Charge].map(asks);
        let keys = molecule.atoms.iter().map(|atom| {
            let label = if name { atom.name.bits() } else { 0 };
            let small = u64::from(if element { atom.element.number() } else { 0 }) << 8
                | u64::from(if altloc { atom.alt_loc } else { 0 });
            let group = group_of_residue.get(atom.residue as usize).copied().unwrap_or(0);
            let b_factor = if b_factor { atom.b_factor.to_bits() } else { 0 };
            let charge = if charge { atom.charge.to_bits() } else { 0 };
            (label | small << 48, u64::from(group) << 32 | u64::from(b_factor), charge)
        });
        let (of_object, firsts) = number(keys);
        let atom = |index: u32| &molecule.atoms[index as usize];
        let residue = |index: u32| molecule.residue(atom(index));
        let file = |index: u32| molecule.chains[residue(index).chain as usize].file;
        let columns = asked.iter().map(|attribute| match attribute {
            Attribute::Element => {
                column(attribute, &firsts, |i| atom(i).element, |element| element.symbol().to_owned())
            }
            Attribute::Name => column(attribute, &firsts, |i| atom(i).name, ToString::to_string),
            Attribute::Residue => column(attribute, &firsts, |i| residue(i).name, ToString::to_string),
            Attribute::Number => {
                let number = |(number, code): &(i32, u8)| match code {
                    0 => number.to_string(),
                    code => format!("{number}{}", char::from(*code)),
                };
                column(attribute, &firsts, |i| (residue(i).number, residue(i).insertion_code), number)
            }
            Attribute::Kind => column(attribute, &firsts, |i| residue(i).kind, |kind| kind.name().to_owned()),
            Attribute::Chain => {
                let id = |chain: &u32| molecule.chains[*chain as usize].id.clone();
                column(attribute, &firsts, |i| residue(i).chain, id)
            }
            Attribute::Model => column(attribute, &firsts, |i| residue(i).model, ToString::to_string),
            Attribute::Altloc => {
                let letter = |code: &u8| if *code == 0 { String::new() } else { char::from(*code).to_string() };
                column(attribute, &firsts, |i| atom(i).alt_loc, letter)
            }
            Attribute::BFactor => column(attribute, &firsts, |i| atom(i).b_factor.to_bits(), measure),
            Attribute::Charge => column(attribute, &firsts, |i| atom(i).charge.to_bits(), measure),
            Attribute::File => column(attribute, &firsts, file, |file| file_name(scene, *file)),
            Attribute::Part | Attribute::Material | Attribute::Node => {
                column(attribute, &firsts, |_| (), |()| String::new())
            }
        });
        let columns = columns.collect();
        Classes { asked, of_object, count: firsts.len(), columns }
    }

    /// Sorts the parts of a scene's meshes, in time linear in their number.
    pub(super) fn of_parts(scene: &Scene, asked: AttributeSet) -> Classes {
        let assembly = &scene.assembly;
        let of_asked = |attribute, value: u32| if asked.contains(attribute) { value } else { 0 };
        let material = |material: Option<u32>| material.map_or(0, |index| index + 1);
        let keys = assembly.parts.iter().map(|part| {
            let [name, path] = [of_asked(Attribute::Part, part.name), of_asked(Attribute::Node, part.path)];
            let material = of_asked(Attribute::Material, material(part.material));
            let file = of_asked(Attribute::File, part.file);
            (u64::from(name) << 32 | u64::from(path), u64::from(material) << 32 | u64::from(file))
        });
        let (of_object, firsts) = number(keys);
        let part = |index: u32| &assembly.parts[index as usize];
        let text = |name: &u32| assembly.names[*name as usize].clone();
        let columns = asked.iter().map(|attribute| match attribute {
            Attribute::Part => column_of_indices(attribute, &firsts, assembly.names.len(), |i| part(i).name, text),
            Attribute::Node => column_of_indices(attribute, &firsts, assembly.names.len(), |i| part(i).path, text),
            Attribute::Material => {
                let name = |material: &Option<u32>| {
                    material.map_or(String::new(), |index| assembly.materials[index as usize].name.clone())
                };
                column(attribute, &firsts, |i| part(i).material, name)
            }
            _ => column(attribute, &firsts, |i| part(i).file, |file| file_name(scene, *file)),
        });
        let columns = columns.collect();
        Classes { asked, of_object, count: firsts.len(), columns }
    }

    /// Whether these classes tell apart whatever rules that ask for this can tell apart.
    pub(super) fn hold_for(&self, asked: AttributeSet) -> bool {
        self.asked.covers(asked)
    }

    /// The values of each attribute that takes part.
    pub(super) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The value of an attribute of a class.
    pub(super) fn value(&self, class: u32, attribute: Attribute) -> Option<&str> {
        let column = self.columns.iter().find(|column| column.attribute == attribute)?;
        Some(&column.texts[column.of_class[class as usize] as usize])
    }

    /// For each class whether a selector picks its objects, taken as ones of a type.
    pub(super) fn picks(&self, selector: &Selector, kind: ObjectKind) -> Vec<bool> {
        let picks = |class| selector.matches(kind, &|attribute| self.value(class, attribute));
        (0..self.count as u32).map(picks).collect()
    }

    /// For each class of atoms whether a bond has an atom of it.
    pub(super) fn bonded(&self, bonds: &[Bond]) -> Vec<bool> {
        let mut bonded = vec![false; self.count];
        for atom in bonds.iter().flat_map(|bond| [bond.a, bond.b]) {
            bonded[self.of_object[atom as usize] as usize] = true;
        }
        bonded
    }
}

/// A number for each residue, equal where no selector can tell residues apart; none where no rule asks for residues.
fn group_residues(molecule: &Molecule, asked: AttributeSet) -> Vec<u32> {
    let asks = |attribute| asked.contains(attribute);
    let [name, number_of, kind] = [Attribute::Residue, Attribute::Number, Attribute::Kind].map(asks);
    let [chain, model, file] = [Attribute::Chain, Attribute::Model, Attribute::File].map(asks);
    if !(name || number_of || kind || chain || model || file) {
        return Vec::new();
    }
    let keys = molecule.residues.iter().map(|residue| {
        let label = if name { residue.name.bits() } else { 0 };
        let kind = if kind { residue.kind as u64 } else { 0 };
        let code = if number_of { u64::from(residue.insertion_code) } else { 0 };
        let number = if number_of { residue.number as u32 } else { 0 };
        let place = match (chain, file) {
            (true, _) => residue.chain,
            (false, true) => molecule.chains[residue.chain as usize].file,
            (false, false) => 0,
        };
        let model = if model { residue.model } else { 0 };
        (label | kind << 48 | code << 56, u64::from(place) << 32 | u64::from(model), number)
    });
    number(keys).0
}

/// A number for each key, equal for equal keys and in order of first appearance, and where each number appears first.
fn number<K: Hash + Eq>(keys: impl Iterator<Item = K>) -> (Vec<u32>, Vec<u32>) {
    let mut number_of: HashMap<K, u32> = HashMap::new();
    let mut firsts = Vec::new();
    let numbers = (0..).zip(keys).map(|(index, key)| {
        *number_of.entry(key).or_insert_with(|| {
            firsts.push(index);
            firsts.len() as u32 - 1
        })
    });
    (numbers.collect(), firsts)
}

/// The values of an attribute: `value` of the first object of each class, with a text for each that differs.
fn column<T: Hash + Eq>(
    attribute: Attribute,
    firsts: &[u32],
    value: impl Fn(u32) -> T,
    text: impl Fn(&T) -> String,
) -> Column {
    let (of_class, differing) = number(firsts.iter().map(|index| value(*index)));
    let texts = differing.into_iter().map(|class| text(&value(firsts[class as usize]))).collect();
    Column { attribute, texts, of_class }
}

/// The same where values are indices into a list of so many: nothing is hashed.
fn column_of_indices(
    attribute: Attribute,
    firsts: &[u32],
    list_len: usize,
    value: impl Fn(u32) -> u32,
    text: impl Fn(&u32) -> String,
) -> Column {
    let mut number_of = vec![u32::MAX; list_len];
    let mut texts = Vec::new();
    let of_class = firsts.iter().map(|index| {
        let value = value(*index);
        let number = &mut number_of[value as usize];
        if *number == u32::MAX {
            *number = texts.len() as u32;
            texts.push(text(&value));
        }
        *number
    });
    let of_class = of_class.collect();
    Column { attribute, texts, of_class }
}

/// A number of single precision, of these bits, as it is written.
fn measure(bits: &u32) -> String {
    f32::from_bits(*bits).to_string()
}

/// The name of a file of the scene.
fn file_name(scene: &Scene, file: u32) -> String {
    scene.files.get(file as usize).map_or(String::new(), |file| file.name.clone())
}
