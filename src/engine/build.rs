//! From a scene and a style to what a frame draws: radii, colours, materials, and which objects are left out.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec3;

use super::palette::AtomColors;
use crate::config::{AtomRadius, BaseColor, Geometry, Style, Value};
use crate::effects::outline::group_word;
use crate::frame::Materials;
use crate::frame::objects::{self, Connector, DrawList, Material, pack_linear, pack_linear_and_group};
use crate::providers::{Assignment, Lengths};
use crate::scene::{Atom, Bond, Molecule};
use crate::shading::{self, MaterialContext, SHADERS};

/// Whatever of a style decides which objects are drawn, how large, and in which colours of their own. Styles that are
/// equal in it draw the same objects, and differ in materials at the most.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectKey {
    assignment: Arc<Assignment>,
    geometry: Geometry,
    schemes: Vec<BaseColor>,
}

impl ObjectKey {
    /// The key of a style, of which the rules come to `assignment`.
    pub fn new(style: &Style, assignment: Arc<Assignment>) -> ObjectKey {
        ObjectKey {
            assignment,
            geometry: style.geometry.clone(),
            schemes: style.shaders.iter().map(own_scheme).collect(),
        }
    }
}

/// The objects that a style draws of a scene, and what belongs to them.
pub struct Objects {
    /// The objects.
    pub list: DrawList,
    /// The shader of the style that each material is, in the order of the materials' numbers.
    pub materials: Vec<usize>,
    /// Lengths, with the median radius of the drawn atoms.
    pub lengths: Lengths,
}

/// Makes every object of the molecule that the style draws; `assignment` is what the style's rules come to.
pub fn objects(molecule: &Molecule, style: &Style, assignment: &Assignment) -> Objects {
    let bounds = molecule.bounding_sphere();
    let geometry_lengths = Lengths::new(bounds, None);

    let uses: Vec<Option<usize>> = assignment.atoms.iter().map(|used| used.map(|index| index as usize)).collect();

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

    let mut materials = MaterialNumbers::default();
    let by_residue = style.shaders.iter().any(|shader| own_scheme(shader) == BaseColor::Residue);
    let colors = AtomColors::new(molecule, by_residue);

    let group = |atom: &Atom| group_word(molecule.residue(atom).chain, atom.residue);

    let mut list = DrawList::default();
    for (atom, used) in molecule.atoms.iter().zip(&uses) {
        let (Some(used), radius) = (*used, radius(atom)) else { continue };
        if radius > 0.0 {
            list.atoms.push(objects::Atom {
                position_world: atom.position.to_array(),
                radius,
                color: pack_linear(colors.of(molecule, atom, own_scheme(&style.shaders[used]))),
                material: materials.of(used),
                group: group(atom),
            });
        }
    }

    let bond_radius = lengths.world(style.geometry.bond_radius) as f32;
    let neighbours = Neighbours::new(molecule, style.geometry.bond_orders);
    let bonds = molecule.bonds.iter().zip(&assignment.connectors);
    for (bond, used) in bonds.take(if bond_radius > 0.0 { usize::MAX } else { 0 }) {
        let Some(used) = used.map(|index| index as usize) else { continue };
        let (a, b) = (&molecule.atoms[bond.a as usize], &molecule.atoms[bond.b as usize]);
        let length = a.position.distance(b.position);
        if length <= 1e-6 * bounds.radius {
            continue;
        }
        let order = if style.geometry.bond_orders { bond.order.clamp(1, 3) } else { 1 };
        if order == 1 && buried(radius(a), radius(b), length, bond_radius) {
            continue;
        }
        let scheme = own_scheme(&style.shaders[used]);
        let material = materials.of(used);
        let toward = || neighbours.direction(molecule, bond);
        for (offset, radius) in strands(b.position - a.position, order, bond_radius, toward) {
            list.connectors.push(Connector {
                a_world: (a.position + offset).to_array(),
                radius,
                b_world: (b.position + offset).to_array(),
                material,
                color_a: pack_linear_and_group(colors.of(molecule, a, scheme), group(a)),
                color_b: pack_linear_and_group(colors.of(molecule, b, scheme), group(b)),
            });
        }
    }
    Objects { list, materials: materials.used, lengths }
}

fn scheme(shader: &crate::config::ShaderUse) -> BaseColor {
    // Post effects are in the same list and have none.
    match shader.values.get(shading::BASE_COLOR.name) {
        Some(Value::BaseColor(color)) => *color,
        _ => BaseColor::Element,
    }
}

/// Where the colours of the objects themselves come from. One colour for all lies in the material, which then covers
/// them.
fn own_scheme(shader: &crate::config::ShaderUse) -> BaseColor {
    match scheme(shader) {
        BaseColor::Color(_) => BaseColor::Element,
        other => other,
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

/// Finds a bond beside another one, without a search.
struct Neighbours {
    /// The first two bonds of each atom, as indices; empty where no style asks.
    first_two: Vec<[Option<u32>; 2]>,
}

impl Neighbours {
    fn new(molecule: &Molecule, needed: bool) -> Neighbours {
        let mut first_two = vec![[None; 2]; if needed { molecule.atoms.len() } else { 0 }];
        for (index, bond) in (0..).zip(if needed { &molecule.bonds[..] } else { &[] }) {
            for atom in [bond.a, bond.b] {
                if let Some(free) = first_two[atom as usize].iter_mut().find(|bond| bond.is_none()) {
                    *free = Some(index);
                }
            }
        }
        Neighbours { first_two }
    }

    /// Where the first other bond of either of a bond's atoms points from there.
    fn direction(&self, molecule: &Molecule, bond: &Bond) -> Option<Vec3> {
        // One of the first two bonds of an atom is another one; no two bonds share both atoms.
        let others = [bond.a, bond.b].map(|atom| self.first_two[atom as usize]);
        let others = others.as_flattened().iter().flatten().filter(|index| molecule.bonds[**index as usize] != *bond);
        let other = &molecule.bonds[*others.min()? as usize];
        let position = |index: u32| molecule.atoms[index as usize].position;
        let from_a = [bond.a, bond.b].contains(&other.a);
        let (from, to) = if from_a { (other.a, other.b) } else { (other.b, other.a) };
        Some(position(to) - position(from))
    }
}

/// Offset and radius of each cylinder of a bond: double and triple bonds lie side by side in the plane of a neighbour,
/// which is `toward` there.
fn strands(along: Vec3, order: u8, radius: f32, toward: impl FnOnce() -> Option<Vec3>) -> Vec<(Vec3, f32)> {
    if order <= 1 {
        return vec![(Vec3::ZERO, radius)];
    }
    let axis = along.normalize_or(Vec3::X);
    let side = toward().map_or(Vec3::ZERO, |toward| toward - axis * toward.dot(axis));
    let side = side.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
    let thin = radius * 0.55;
    let gap = radius * if order == 2 { 0.8 } else { 1.3 };
    match order {
        2 => vec![(side * gap, thin), (side * -gap, thin)],
        _ => vec![(Vec3::ZERO, thin), (side * gap, thin), (side * -gap, thin)],
    }
}

/// Numbers the materials that objects use, in order of first use.
#[derive(Default)]
struct MaterialNumbers {
    number_of: BTreeMap<usize, u32>,
    used: Vec<usize>,
}

impl MaterialNumbers {
    fn of(&mut self, shader: usize) -> u32 {
        *self.number_of.entry(shader).or_insert_with(|| {
            self.used.push(shader);
            self.used.len() as u32 - 1
        })
    }
}

/// The materials of the shaders `used`, by number. `height_px` is the picture's, for lengths in points.
pub fn materials(style: &Style, used: &[usize], exposure_factor: f32, lengths: &Lengths, height_px: u32) -> Materials {
    let context = MaterialContext { exposure_factor };
    let mut materials = Materials::default();
    for shader_use in used.iter().map(|&used| &style.shaders[used]) {
        // The loader accepts only names of the registry.
        let shader_index = shading::shader_index(shader_use.shader).unwrap_or(0);
        let shader = SHADERS[shader_index];
        let bytes = shader.material(&shader_use.values, &context);
        let params = materials.params.entry(shader_index).or_default();
        *materials.features.entry(shader_index).or_default() |= shader.features_used(&shader_use.values);
        let params_index = params.len() / bytes.len().max(1);
        params.extend_from_slice(&bytes);
        let base_color = match scheme(shader_use) {
            BaseColor::Color(color) => shading::linear(color).extend(1.0).to_array(),
            _ => [0.0; 4],
        };
        let hull = shader.hull(&shader_use.values);
        let (hull_px, hull_world) = hull.map_or((0.0, 0.0), |hull| lengths.screen(hull.width, height_px));
        materials.common.push(Material {
            base_color,
            hull_color: hull.map_or([0.0; 4], |hull| hull.color.extend(1.0).to_array()),
            hull_px: hull_px as f32,
            hull_world: hull_world as f32,
            shader: shader_index as u32,
            index: params_index as u32,
        });
    }
    materials
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

    #[test]
    fn a_neighbour_is_the_first_other_bond_of_either_atom() {
        let atoms: String = (0..12).map(|i| format!("C {} {} 0\n", i % 4 * 3, i / 4 * 3)).collect();
        let scene = crate::scene::Scene::from_bytes("grid.xyz", format!("12\n\n{atoms}").as_bytes());
        let mut molecule = scene.expect("twelve atoms").molecule;
        assert!(molecule.bonds.is_empty(), "they lie apart");
        let pairs = [(0, 1), (0, 4), (1, 5), (2, 3), (4, 5), (4, 8), (5, 9)];
        molecule.bonds = pairs.map(|(a, b)| Bond { a, b, order: 2 }).to_vec();
        let neighbours = Neighbours::new(&molecule, true);
        for bond in &molecule.bonds {
            let position = |index: u32| molecule.atoms[index as usize].position;
            let searched = molecule.bonds.iter().find_map(|other| {
                let shares = |index| index == bond.a || index == bond.b;
                match (shares(other.a), shares(other.b)) {
                    (true, false) => Some(position(other.b) - position(other.a)),
                    (false, true) => Some(position(other.a) - position(other.b)),
                    _ => None,
                }
            });
            assert_eq!(neighbours.direction(&molecule, bond), searched, "{bond:?}");
        }
    }
}
