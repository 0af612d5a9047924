//! From a scene and a style to what a frame draws: radii, colours, materials, and which objects are left out.

use std::collections::BTreeMap;

use glam::Vec3;

use super::palette::AtomColors;
use crate::config::{AtomRadius, Attribute, BaseColor, ObjectKind, Style, Value};
use crate::frame::Materials;
use crate::frame::objects::{self, Connector, DrawList, Material, pack_linear};
use crate::providers::{Lengths, ObjectAttributes, ShaderProvider};
use crate::scene::{Atom, Bond, Molecule};
use crate::shading::{self, MaterialContext, SHADERS};

/// What a style makes of a scene, and the lengths that go with it.
pub struct Built {
    /// Objects.
    pub list: DrawList,
    /// Their materials.
    pub materials: Materials,
    /// The shaders of the style that draw something, each with its material.
    pub material_of: BTreeMap<usize, u32>,
    /// Lengths, with the median radius of the drawn atoms.
    pub lengths: Lengths,
}

struct AtomView<'a> {
    molecule: &'a Molecule,
    atom: &'a Atom,
    models: &'a BTreeMap<u32, String>,
}

impl ObjectAttributes for AtomView<'_> {
    fn attribute(&self, attribute: Attribute) -> Option<&str> {
        match attribute {
            Attribute::Element => Some(self.atom.element.symbol()),
            Attribute::Name => Some(self.atom.name.as_str()),
            Attribute::Residue => Some(self.molecule.residue(self.atom).name.as_str()),
            Attribute::Chain => Some(self.molecule.chain(self.atom)),
            Attribute::Model => self.models.get(&self.molecule.residue(self.atom).model).map(String::as_str),
            _ => None,
        }
    }
}

/// Resolves the style for every object of the molecule. `height_px` is the picture's, for lengths in points.
pub fn build(molecule: &Molecule, style: &Style, exposure_factor: f32, height_px: u32) -> Built {
    let provider = ShaderProvider::new(style);
    let models: BTreeMap<u32, String> =
        molecule.residues.iter().map(|residue| (residue.model, residue.model.to_string())).collect();
    let view = |atom| AtomView { molecule, atom, models: &models };
    let bounds = molecule.bounding_sphere();
    let geometry_lengths = Lengths::new(bounds, None);

    // The style's shader of each atom; one question for all where no selector asks for an attribute.
    let uniform = provider.attributes_used(ObjectKind::Atom).is_empty();
    let first = molecule.atoms.first().and_then(|atom| provider.for_object(ObjectKind::Atom, &view(atom)));
    let uses: Vec<Option<usize>> = molecule
        .atoms
        .iter()
        .map(|atom| if uniform { first } else { provider.for_object(ObjectKind::Atom, &view(atom)) })
        .collect();

    let radius = |atom: &Atom| {
        let plain = match style.geometry.atom {
            AtomRadius::Vdw => f64::from(atom.element.vdw_radius()),
            AtomRadius::Covalent => f64::from(atom.element.covalent_radius()),
            AtomRadius::Length(length) => geometry_lengths.world(length),
        };
        (plain * style.geometry.scale) as f32
    };
    let mut drawn_radii: Vec<f32> =
        molecule.atoms.iter().zip(&uses).filter(|(_, used)| used.is_some()).map(|(atom, _)| radius(atom)).collect();
    let middle = drawn_radii.len() / 2;
    let median =
        (!drawn_radii.is_empty()).then(|| f64::from(*drawn_radii.select_nth_unstable_by(middle, f32::total_cmp).1));
    let lengths = Lengths::new(bounds, median);

    let mut materials = MaterialTable::new(style, exposure_factor, lengths, height_px);
    let by_residue = style.shaders.iter().any(|shader| scheme(shader) == BaseColor::Residue);
    let colors = AtomColors::new(molecule, by_residue);

    let mut list = DrawList::default();
    for (atom, used) in molecule.atoms.iter().zip(&uses) {
        let (Some(used), radius) = (*used, radius(atom)) else { continue };
        if radius > 0.0 {
            list.atoms.push(objects::Atom {
                position_world: atom.position.to_array(),
                radius,
                color: pack_linear(colors.of(molecule, atom, scheme(&style.shaders[used]))),
                material: materials.material(used),
                _pad0: 0,
            });
        }
    }

    let bond_radius = lengths.world(style.geometry.bond_radius) as f32;
    let uniform = provider.attributes_used(ObjectKind::Connector).is_empty();
    let first = molecule.bonds.first().map(|bond| connector_use(&provider, &view, molecule, bond));
    for bond in if bond_radius > 0.0 { &molecule.bonds[..] } else { &[] } {
        // Hidden with either of its atoms.
        if uses[bond.a as usize].is_none() || uses[bond.b as usize].is_none() {
            continue;
        }
        let used = match first {
            Some(first) if uniform => first,
            _ => connector_use(&provider, &view, molecule, bond),
        };
        let Some(used) = used else { continue };
        let (a, b) = (&molecule.atoms[bond.a as usize], &molecule.atoms[bond.b as usize]);
        let length = a.position.distance(b.position);
        if length <= 1e-6 * bounds.radius {
            continue;
        }
        let order = if style.geometry.bond_orders { bond.order.clamp(1, 3) } else { 1 };
        if order == 1 && buried(radius(a), radius(b), length, bond_radius) {
            continue;
        }
        let scheme = scheme(&style.shaders[used]);
        let material = materials.material(used);
        for (offset, radius) in strands(molecule, bond, order, bond_radius) {
            list.connectors.push(Connector {
                a_world: (a.position + offset).to_array(),
                radius,
                b_world: (b.position + offset).to_array(),
                material,
                color_a: pack_linear(colors.of(molecule, a, scheme)),
                color_b: pack_linear(colors.of(molecule, b, scheme)),
            });
        }
    }
    Built { list, materials: materials.materials, material_of: materials.index_of, lengths }
}

fn connector_use<'a>(
    provider: &ShaderProvider<'_>,
    view: &impl Fn(&'a Atom) -> AtomView<'a>,
    molecule: &'a Molecule,
    bond: &Bond,
) -> Option<usize> {
    provider.for_connector(&view(&molecule.atoms[bond.a as usize]), &view(&molecule.atoms[bond.b as usize]))
}

fn scheme(shader: &crate::config::ShaderUse) -> BaseColor {
    // Post effects are in the same list and have none.
    match shader.values.get(shading::BASE_COLOR.name) {
        Some(Value::BaseColor(color)) => *color,
        _ => BaseColor::Element,
    }
}

/// Whether a connector lies wholly within its two atoms: their spheres meet in a circle wider than it is.
fn buried(radius_a: f32, radius_b: f32, length: f32, bond_radius: f32) -> bool {
    if radius_a + radius_b <= length {
        return false;
    }
    let along = (length * length + radius_a * radius_a - radius_b * radius_b) / (2.0 * length);
    let circle = radius_a * radius_a - along * along;
    // One sphere within the other hides it too, if the larger one is wider than the connector.
    if circle <= 0.0 {
        return radius_a.max(radius_b) > bond_radius + length;
    }
    circle > bond_radius * bond_radius
}

/// Offset and radius of each cylinder of a bond: double and triple bonds lie side by side in the plane of a neighbour.
fn strands(molecule: &Molecule, bond: &Bond, order: u8, radius: f32) -> Vec<(Vec3, f32)> {
    if order <= 1 {
        return vec![(Vec3::ZERO, radius)];
    }
    let position = |index: u32| molecule.atoms[index as usize].position;
    let axis = (position(bond.b) - position(bond.a)).normalize_or(Vec3::X);
    // Bonds are few per atom; a neighbour is looked for only where an order is drawn.
    let neighbour = molecule.bonds.iter().find_map(|other| {
        let shares = |index| index == bond.a || index == bond.b;
        match (shares(other.a), shares(other.b)) {
            (true, false) => Some(position(other.b) - position(other.a)),
            (false, true) => Some(position(other.a) - position(other.b)),
            _ => None,
        }
    });
    let side = neighbour.map_or(Vec3::ZERO, |toward| toward - axis * toward.dot(axis));
    let side = side.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
    let thin = radius * 0.55;
    let gap = radius * if order == 2 { 0.8 } else { 1.3 };
    match order {
        2 => vec![(side * gap, thin), (side * -gap, thin)],
        _ => vec![(Vec3::ZERO, thin), (side * gap, thin), (side * -gap, thin)],
    }
}

/// Collects the materials that objects use, in order of first use.
struct MaterialTable<'a> {
    style: &'a Style,
    context: MaterialContext,
    lengths: Lengths,
    height_px: u32,
    index_of: BTreeMap<usize, u32>,
    materials: Materials,
}

impl<'a> MaterialTable<'a> {
    fn new(style: &'a Style, exposure_factor: f32, lengths: Lengths, height_px: u32) -> MaterialTable<'a> {
        let context = MaterialContext { exposure_factor };
        MaterialTable { style, context, lengths, height_px, index_of: BTreeMap::new(), materials: Materials::default() }
    }

    fn material(&mut self, used: usize) -> u32 {
        if let Some(&index) = self.index_of.get(&used) {
            return index;
        }
        let shader_use = &self.style.shaders[used];
        // The loader accepts only names of the registry.
        let shader_index = shading::shader_index(shader_use.shader).unwrap_or(0);
        let shader = SHADERS[shader_index];
        let bytes = shader.material(&shader_use.values, &self.context);
        let params = self.materials.params.entry(shader_index).or_default();
        *self.materials.features.entry(shader_index).or_default() |= shader.features_used(&shader_use.values);
        let params_index = params.len() / bytes.len().max(1);
        params.extend_from_slice(&bytes);
        let base_color = match scheme(shader_use) {
            BaseColor::Color(color) => shading::linear(color).extend(1.0).to_array(),
            _ => [0.0; 4],
        };
        let hull = shader.hull(&shader_use.values);
        let (hull_px, hull_world) = hull.map_or((0.0, 0.0), |hull| self.lengths.screen(hull.width, self.height_px));
        let index = self.materials.common.len() as u32;
        self.materials.common.push(Material {
            base_color,
            hull_color: hull.map_or([0.0; 4], |hull| hull.color.extend(1.0).to_array()),
            hull_px: hull_px as f32,
            hull_world: hull_world as f32,
            shader: shader_index as u32,
            index: params_index as u32,
        });
        self.index_of.insert(used, index);
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_connector_is_buried_only_where_its_atoms_cover_it() {
        assert!(buried(1.7, 1.7, 1.5, 0.14));
        assert!(!buried(0.4, 0.4, 1.5, 0.14), "spheres apart");
        assert!(!buried(0.8, 0.8, 1.59, 0.14), "the circle of contact is narrower than the bond");
        assert!(buried(3.0, 0.5, 1.0, 0.14), "one sphere within the other");
    }
}
