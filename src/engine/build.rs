//! From a scene and a style to what a frame draws: radii, colours, materials, and which objects are left out.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::Vec3;

use super::bending;
use super::palette::{AtomColors, PartColors};
use super::picks::{self, Picks};
use crate::config::{AtomRadius, BaseColor, Geometry, Origin, Selector, ShaderUse, Style, Value, Values};
use crate::effects::outline::group_word;
use crate::frame::Materials;
use crate::frame::mesh::{MeshPart, VERTEX_COLORS};
use crate::frame::objects::{
    self, Connector, DrawList, MOST_PICKS, Material, PICKS_SHIFT, pack_linear, pack_linear_and_group,
};
use crate::providers::{Assignment, Lengths};
use crate::scene::{Atom, Bond, MeshMaterial, Molecule, MoleculeCopy, Scene};
use crate::shading::{self, MaterialContext, SHADERS};

/// Whatever of a style decides which objects are drawn, how large, in which colours of their own, and which of them post effects
/// pick. Styles that are equal in it draw the same objects, and differ in materials at the most.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectKey {
    assignment: Arc<Assignment>,
    geometry: Geometry,
    schemes: Vec<BaseColor>,
    /// Whether each shader hides what is within its objects.
    opaque: Vec<bool>,
    /// Whether something asks how surfaces bend.
    bent: bool,
    /// Selectors of post effects, in the order of their bits.
    pub picking: Vec<Selector>,
}

impl ObjectKey {
    /// The key of a style, of which the rules come to `assignment`; `bent` asks how surfaces bend.
    pub fn new(style: &Style, assignment: Arc<Assignment>, bent: bool) -> ObjectKey {
        ObjectKey {
            assignment,
            geometry: style.geometry.clone(),
            schemes: style.shaders.iter().map(own_scheme).collect(),
            opaque: style.shaders.iter().map(is_opaque).collect(),
            bent,
            picking: picks::selectors(style).into_iter().take(MOST_PICKS).cloned().collect(),
        }
    }
}

/// The objects that a style draws of a scene, and what belongs to them.
pub struct Objects {
    /// The objects.
    pub list: DrawList,
    /// What each material is, in the order of the materials' numbers.
    pub materials: Vec<MaterialUse>,
    /// Lengths, with the median radius of the drawn atoms.
    pub lengths: Lengths,
    /// How strongly curvature is read unless a style says.
    pub gain: f32,
}

/// A shader of the style, with what a file says of the surface where that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct MaterialUse {
    /// Which of the style's shaders.
    pub shader: usize,
    /// Metallic and smoothness of the file, in steps of one [`FINISH_STEPS`]th.
    pub finish: Option<[u8; 2]>,
}

/// Steps in which a file's finish is kept: finer than is seen, and coarse enough that parts share materials.
const FINISH_STEPS: f32 = 64.0;

/// Makes every object of the scene that the style draws; `assignment` is what the style's rules come to, `picks` what the
/// selectors of its post effects do, and `bent` asks how surfaces bend.
pub fn objects(scene: &Arc<Scene>, style: &Style, assignment: &Assignment, picks: &Picks, bent: bool) -> Objects {
    // A scene of huge or tiny meshes has a unit of its own.
    let lengths = |median| Lengths::of_scene(scene, &style.geometry, median);
    let (mut objects, mut materials) =
        molecule_objects(&scene.molecule, scene.unit, style, assignment, picks, &lengths);
    if !scene.assembly.is_empty() {
        add_parts(&mut objects.list, &mut materials, scene, style, assignment, picks);
    }
    if bent {
        objects.list.bent = true;
        objects.gain = bending::default_gain(&objects.list, lengths(None).radius);
    }
    Objects { materials: materials.used, ..objects }
}

/// The objects of a molecule alone; `unit` is the scene's, in angstrom, and `lengths` knows its lengths for a median radius
/// of the drawn atoms.
fn molecule_objects(
    molecule: &Molecule,
    unit: f64,
    style: &Style,
    assignment: &Assignment,
    picks: &Picks,
    lengths: &dyn Fn(Option<f64>) -> Lengths,
) -> (Objects, MaterialNumbers) {
    let geometry_lengths = lengths(None);

    let uses: Vec<Option<usize>> = assignment.atoms.iter().map(|used| used.map(|index| index as usize)).collect();

    let radius = |atom: &Atom| {
        let plain = match style.geometry.atom {
            AtomRadius::Vdw => f64::from(atom.element.vdw_radius()) / unit,
            AtomRadius::Covalent => f64::from(atom.element.covalent_radius()) / unit,
            AtomRadius::Length(length) => geometry_lengths.world(length),
        };
        (plain * style.geometry.scale) as f32
    };
    let mut drawn_radii: Vec<f32> =
        molecule.atoms.iter().zip(&uses).filter(|(_, used)| used.is_some()).map(|(atom, _)| radius(atom)).collect();
    let middle = drawn_radii.len() / 2;
    let median =
        (!drawn_radii.is_empty()).then(|| f64::from(*drawn_radii.select_nth_unstable_by(middle, f32::total_cmp).1));
    let lengths = lengths(median);

    let mut materials = MaterialNumbers::default();
    let by_residue = style.shaders.iter().any(|shader| own_scheme(shader) == BaseColor::Residue);
    let colors = AtomColors::new(molecule, by_residue);

    let group = |atom: &Atom| group_word(molecule.residue(atom).chain, atom.residue);

    // Large lists are never grown: that would hold them twice.
    let mut list = DrawList {
        atoms: Vec::with_capacity(uses.iter().flatten().count()),
        connectors: Vec::with_capacity(assignment.connectors.iter().flatten().count()),
        ..DrawList::default()
    };
    // Which atom and which bond each object is, where copies need to know.
    let is_copied = !molecule.copies.is_empty();
    let (mut atom_of, mut bond_of) = (Vec::new(), Vec::new());
    for (index, (atom, used)) in (0..).zip(molecule.atoms.iter().zip(&uses)) {
        let (Some(used), radius) = (*used, radius(atom)) else { continue };
        if radius > 0.0 {
            list.atoms.push(objects::Atom {
                position_world: atom.position.to_array(),
                radius,
                color: pack_linear(colors.of(molecule, atom, own_scheme(&style.shaders[used]))),
                material: materials.of(plain_use(used)),
                group: group(atom) | picks.of_atom(index as usize) << PICKS_SHIFT,
            });
            atom_of.extend(is_copied.then_some(index));
        }
    }

    let bond_radius = lengths.world(style.geometry.bond_radius) as f32;
    let neighbours = Neighbours::new(molecule, style.geometry.bond_orders);
    let bonds = molecule.bonds.iter().zip(&assignment.connectors).enumerate();
    for (index, (bond, used)) in bonds.take(if bond_radius > 0.0 { usize::MAX } else { 0 }) {
        let Some(used) = used.map(|index| index as usize) else { continue };
        let (a, b) = (&molecule.atoms[bond.a as usize], &molecule.atoms[bond.b as usize]);
        let length = a.position.distance(b.position);
        if f64::from(length) <= 1e-6 * lengths.radius {
            continue;
        }
        let order = if style.geometry.bond_orders { bond.order.clamp(1, 3) } else { 1 };
        // What is seen through hides nothing.
        let hides = |atom: u32| uses[atom as usize].is_some_and(|used| is_opaque(&style.shaders[used]));
        let [hidden_a, hidden_b] =
            [(bond.a, a), (bond.b, b)].map(|(index, atom)| if hides(index) { radius(atom) } else { 0.0 });
        if order == 1 && buried(hidden_a, hidden_b, length, bond_radius) {
            continue;
        }
        let scheme = own_scheme(&style.shaders[used]);
        let material = materials.of(plain_use(used)) | picks.of_connector(index) << PICKS_SHIFT;
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
            bond_of.extend(is_copied.then_some(*bond));
        }
    }
    if is_copied {
        place_copies(&mut list, &atom_of, &bond_of, &molecule.copies);
    }
    (Objects { list, materials: Vec::new(), lengths, gain: 1.0 }, materials)
}

/// The objects of a molecule that stands alone.
pub fn objects_of(molecule: &Molecule, style: &Style, assignment: &Assignment) -> Objects {
    let lengths = |median| Lengths::new(molecule.bounding_sphere(), median);
    let (objects, materials) = molecule_objects(molecule, 1.0, style, assignment, &Picks::default(), &lengths);
    Objects { materials: materials.used, ..objects }
}

/// Adds the parts of meshes.
fn add_parts(
    list: &mut DrawList,
    materials: &mut MaterialNumbers,
    scene: &Arc<Scene>,
    style: &Style,
    assignment: &Assignment,
    picks: &Picks,
) {
    let assembly = &scene.assembly;
    let colors = PartColors::new(assembly);
    let parts = assembly.parts.iter().zip(&assignment.parts).enumerate().map(|(index, (part, used))| {
        let used = used.map(|index| index as usize)?;
        let own = own_scheme(&style.shaders[used]);
        let of_file = part.material.and_then(|material| assembly.materials.get(material as usize));
        let finish = of_file.filter(|_| PartColors::is_of_file(own)).and_then(finish);
        let shape = &assembly.shapes[part.shape as usize];
        let material = materials.of(MaterialUse { shader: used, finish });
        let mut color = pack_linear(colors.of(assembly, part, own));
        // Colours of vertices are the file's, too.
        if PartColors::is_of_file(own) && !shape.colors.is_empty() {
            color[1] |= VERTEX_COLORS;
        }
        color[1] |= picks.of_part(index) << PICKS_SHIFT;
        Some(MeshPart::new(&part.world_from_shape, color, material, shape))
    });
    list.parts = parts.collect();
    list.meshes = Some(Arc::clone(scene));
}

/// What a file says of a surface beside its colour.
fn finish(of_file: &MeshMaterial) -> Option<[u8; 2]> {
    let steps = |value: f32| (value.clamp(0.0, 1.0) * FINISH_STEPS).round() as u8;
    let (metallic, roughness) = (of_file.metallic?, of_file.roughness?);
    Some([steps(metallic), steps(1.0 - roughness)])
}

/// The values of a shader for a material: where it takes the file's colours and leaves its finish at the defaults, the
/// file's finish, too.
fn values_of<'a>(of: &MaterialUse, shader: &'a ShaderUse) -> Cow<'a, Values> {
    let is_default = |name: &str| shader.values.origin(name) == Some(&Origin::Default);
    let is_of_file = PartColors::is_of_file(scheme(shader)) && is_default(METALLIC) && is_default(SMOOTHNESS);
    let Some([metallic, smoothness]) = of.finish.filter(|_| is_of_file) else { return Cow::Borrowed(&shader.values) };
    let share = |steps: u8| Value::Number(f64::from(steps) / f64::from(FINISH_STEPS));
    let mut values = shader.values.clone();
    values.change_default(METALLIC, share(metallic));
    values.change_default(SMOOTHNESS, share(smoothness));
    Cow::Owned(values)
}

/// The parameters that a file's material sets.
const METALLIC: &str = "metallic";
const SMOOTHNESS: &str = "smoothness";

fn plain_use(shader: usize) -> MaterialUse {
    MaterialUse { shader, finish: None }
}

/// Puts the objects where the copies of a biological assembly are, and nowhere else. `bonds` are those of the connectors.
fn place_copies(list: &mut DrawList, atom_of: &[u32], bond_of: &[Bond], copies: &[MoleculeCopy]) {
    let (atoms, connectors) = (std::mem::take(&mut list.atoms), std::mem::take(&mut list.connectors));
    for copy in copies {
        let place = copy.world_from_molecule;
        let moved = |at: [f32; 3]| place.transform_point3(Vec3::from(at)).to_array();
        for range in &copy.atoms {
            let start = atom_of.partition_point(|&atom| atom < range.start);
            let end = atom_of.partition_point(|&atom| atom < range.end);
            let drawn = &atoms[start..end];
            list.atoms
                .extend(drawn.iter().map(|atom| objects::Atom { position_world: moved(atom.position_world), ..*atom }));
        }
        let holds = |atom: u32| {
            let after = copy.atoms.partition_point(|range| range.start <= atom);
            after > 0 && copy.atoms[after - 1].contains(&atom)
        };
        let joined = connectors.iter().zip(bond_of).filter(|(_, bond)| holds(bond.a) && holds(bond.b));
        list.connectors.extend(joined.map(|(connector, _)| Connector {
            a_world: moved(connector.a_world),
            b_world: moved(connector.b_world),
            ..*connector
        }));
    }
}

fn scheme(shader: &ShaderUse) -> BaseColor {
    // Post effects are in the same list and have none.
    match shader.values.get(shading::BASE_COLOR.name) {
        Some(Value::BaseColor(color)) => *color,
        _ => BaseColor::Element,
    }
}

/// Whether nothing is seen through what a shader draws.
fn is_opaque(shader: &ShaderUse) -> bool {
    // Post effects are in the same list and are no shaders of objects.
    shading::shader_index(shader.shader).is_none_or(|index| !SHADERS[index].is_layered(&shader.values))
}

/// Whether a style asks how surfaces bend.
pub fn asks_for_bending(style: &Style) -> bool {
    style
        .shaders
        .iter()
        .filter_map(|shader| shading::shader_index(shader.shader))
        .any(|index| SHADERS[index].stylises())
}

/// Where the colours of the objects themselves come from. One colour for all lies in the material, which then covers
/// them.
fn own_scheme(shader: &ShaderUse) -> BaseColor {
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
    number_of: BTreeMap<MaterialUse, u32>,
    used: Vec<MaterialUse>,
}

impl MaterialNumbers {
    fn of(&mut self, of: MaterialUse) -> u32 {
        *self.number_of.entry(of).or_insert_with(|| {
            self.used.push(of);
            self.used.len() as u32 - 1
        })
    }
}

/// Opacity below which materials are drawn in layers, or the next number below.
const MOST_OF_A_LAYER: f32 = 1.0 - f32::EPSILON / 2.0;

/// Adds a set of a shader's parameters to the materials and returns its number.
fn add_set(materials: &mut Materials, shader: usize, values: &Values, context: &MaterialContext<'_>) -> u32 {
    let registered = SHADERS[shader];
    let table = registered.tables(values);
    let mut first = 0;
    if !table.is_empty() {
        let tables = materials.tables.entry(shader).or_default();
        let known = tables.chunks_exact(table.len()).position(|known| *known == table);
        first = known.map_or(tables.len(), |known| known * table.len());
        if known.is_none() {
            tables.extend(&table);
        }
    }
    let bytes = registered.material(values, &MaterialContext { table: first as u32, ..*context });
    *materials.features.entry(shader).or_default() |= registered.features_used(values);
    let sets = materials.params.entry(shader).or_default();
    let set = sets.len() / bytes.len().max(1);
    sets.extend_from_slice(&bytes);
    set as u32
}

/// The materials of what is `used`, by number.
pub fn materials(style: &Style, used: &[MaterialUse], context: &MaterialContext<'_>) -> Materials {
    let mut materials = Materials::default();
    for of in used {
        let shader_use = &style.shaders[of.shader];
        let values = values_of(of, shader_use);
        // The loader accepts only names of the registry.
        let shader_index = shading::shader_index(shader_use.shader).unwrap_or(0);
        let shader = SHADERS[shader_index];
        let set = add_set(&mut materials, shader_index, &values, context);
        // A shader that stylises the light of another one has a set of that one's parameters as well.
        let lit_by = shader.lit_by(&values).and_then(shading::shader_index);
        let lit = lit_by.map(|lit_by| {
            (lit_by, add_set(&mut materials, lit_by, &values.taken_by(SHADERS[lit_by].params()), context))
        });
        let (shade_shader, shade_index) = lit.unwrap_or((shader_index, set));
        let (stylist, stylist_index) = lit.map_or((0, 0), |_| (shader_index as u32 + 1, set));
        // What is blended in layers although it may cover all covers next to all.
        let opacity = values.number(shading::OPACITY.name) as f32;
        let opacity = if shader.is_layered(&values) { opacity.min(MOST_OF_A_LAYER) } else { opacity };
        let base_color = match scheme(shader_use) {
            BaseColor::Color(color) => shading::linear(color).extend(1.0).to_array(),
            _ => [0.0; 4],
        };
        let hull = shader.hull(&shader_use.values);
        let (hull_px, hull_world) = hull.map_or((0.0, 0.0), |hull| (context.screen)(hull.width));
        materials.common.push(Material {
            base_color,
            hull_color: hull.map_or([0.0; 3], |hull| hull.color.to_array()),
            opacity,
            hull_px: hull_px as f32,
            hull_world: hull_world as f32,
            shader: shade_shader as u32,
            index: shade_index,
            stylist,
            stylist_index,
            _pad0: 0,
            _pad1: 0,
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
