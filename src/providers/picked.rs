//! What a selector picks of a scene, where it is the value of a parameter and no key of `mapping`.

use glam::Vec3;

use super::classes::{Classes, asked_by};
use crate::config::{ObjectKind, Selector};
use crate::scene::{Scene, Sphere};

/// What a selector picks of a scene, hidden or not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picked {
    /// For each atom.
    pub atoms: Vec<bool>,
    /// For each bond. It matches if either of its atoms does.
    pub connectors: Vec<bool>,
    /// For each part of the scene's meshes.
    pub parts: Vec<bool>,
}

/// Finds what a selector picks of a scene, in time linear in its objects.
pub fn picked(scene: &Scene, selector: &Selector) -> Picked {
    let of_atoms = Classes::of_atoms(scene, asked_by(selector, ObjectKind::Atom));
    let of_parts = Classes::of_parts(scene, asked_by(selector, ObjectKind::Mesh));
    let of_objects = |classes: &Classes, kind| -> Vec<bool> {
        let picks = classes.picks(selector, kind);
        classes.of_object.iter().map(|class| picks[*class as usize]).collect()
    };
    let ends = of_objects(&of_atoms, ObjectKind::Connector);
    let connectors = scene.molecule.bonds.iter().map(|bond| ends[bond.a as usize] || ends[bond.b as usize]);
    Picked {
        atoms: of_objects(&of_atoms, ObjectKind::Atom),
        connectors: connectors.collect(),
        parts: of_objects(&of_parts, ObjectKind::Mesh),
    }
}

impl Picked {
    /// Whether it is nothing.
    pub fn is_empty(&self) -> bool {
        !self.atoms.iter().chain(&self.connectors).chain(&self.parts).any(|is_picked| *is_picked)
    }

    /// A sphere around it in the scene's coordinates, wherever it is drawn: around the box of the centres of atoms, the ends of
    /// connectors and the vertices of parts. None of nothing.
    pub fn bounds(&self, scene: &Scene) -> Option<Sphere> {
        let mut counts = self.atoms.clone();
        for (bond, _) in scene.molecule.bonds.iter().zip(&self.connectors).filter(|(_, is_picked)| **is_picked) {
            (counts[bond.a as usize], counts[bond.b as usize]) = (true, true);
        }
        let places = || {
            let atoms = scene.molecule.drawn_places().filter(|(atom, _)| counts[*atom as usize]);
            let parts = scene.assembly.parts.iter().zip(&self.parts).filter(|(_, is_picked)| **is_picked);
            let vertices = parts.flat_map(|(part, _)| {
                let positions = &scene.assembly.shapes[part.shape as usize].positions;
                positions.iter().map(|position| part.world_from_shape.transform_point3(*position))
            });
            atoms.map(|(_, place)| place).chain(vertices)
        };
        let first = places().next()?;
        let (low, high) = places().fold((first, first), |(low, high), place| (low.min(place), high.max(place)));
        let center: Vec3 = 0.5 * (low + high);
        let radius = places().map(|place| place.distance(center)).fold(0.0, f32::max);
        Some(Sphere { center, radius })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_is_around_all_that_is_picked() {
        let scene = Scene::from_bytes("a.xyz", b"4\n\nC 0 0 0\nO 1.2 0 0\nO -1.2 0 0\nHe 0 9 0\n").expect("atoms");
        let bounds = |selector| picked(&scene, &Selector::parse(selector).expect("a selector")).bounds(&scene);
        let places: Vec<Vec3> = scene.molecule.atoms.iter().map(|atom| atom.position).collect();
        let around = |center: Vec3, radius: f32, found: Option<Sphere>| {
            let found = found.expect("something is picked");
            assert!(found.center.distance(center) < 1e-6 && (found.radius - radius).abs() < 1e-6, "{found:?}");
        };
        around(places[0], 1.2, bounds("atom[element=O]"));
        around(places[3], 0.0, bounds("atom[element=He]"));
        // Each bond has carbon at one end.
        around(places[0], 1.2, bounds("connector[element=C]"));
        assert_eq!((bounds("mesh"), bounds("atom[element=N]"), bounds("connector[element=He]")), (None, None, None));
    }

    #[test]
    fn parts_count_with_their_vertices() {
        let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 0 0\nvertex 0 2 0\nendloop\nendfacet\n";
        let scene = Scene::from_bytes("a.stl", format!("solid a\n{facet}endsolid a\n").as_bytes()).expect("a facet");
        let found = picked(&scene, &Selector::parse("mesh[file=a.stl]").expect("a selector"));
        assert_eq!((found.parts.as_slice(), found.is_empty()), ([true].as_slice(), false));
        let bounds = found.bounds(&scene).expect("a part");
        assert!((bounds.radius - 5f32.sqrt()).abs() < 1e-6, "{bounds:?}");
        assert!(picked(&scene, &Selector::parse("atom").expect("a selector")).is_empty());
    }
}
