//! From what an importer read to what is drawn.

use std::collections::HashMap;

use glam::{DAffine3, DVec3, Vec3};

use super::{Assembly, Part, RawMesh, RawNormals, RawShape, Shape, pack_hull, pack_normal};
use crate::scene::builder::single;
use crate::scene::{Report, Sphere};

impl Assembly {
    /// Mends and recentres a mesh; none if it has no triangle. `file` is the number of its file in the scene.
    pub fn build(raw: RawMesh, file: u32, _report: &mut Report) -> Option<Assembly> {
        let RawMesh { shapes, parts, materials } = raw;
        let bounds = |low: DVec3, high: DVec3, p: DVec3| (low.min(p), high.max(p));
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for part in &parts {
            for &p in &shapes[part.shape as usize].positions {
                (low, high) = bounds(low, high, part.file_from_shape.transform_point3(p));
            }
        }
        let origin = if low.x <= high.x { (low + high) * 0.5 } else { return None };
        let mut names = Names::default();
        let parts: Vec<Part> = parts
            .into_iter()
            .map(|part| Part {
                shape: part.shape,
                material: part.material,
                name: names.number(part.name),
                path: names.number(part.path),
                file,
                world_from_shape: single(DAffine3::from_translation(-origin) * part.file_from_shape),
            })
            .collect();
        let shapes: Vec<Shape> = shapes.into_iter().map(shape).collect();
        let sphere = Sphere { center: Vec3::ZERO, radius: ((high - low).length() * 0.5) as f32 };
        Some(Assembly { shapes, parts, materials, names: names.texts, sphere, unit: 1.0, origin })
    }
}

fn shape(raw: RawShape) -> Shape {
    let positions: Vec<Vec3> = raw.positions.iter().map(|p| p.as_vec3()).collect();
    let mut smooth = vec![Vec3::ZERO; positions.len()];
    for triangle in &raw.triangles {
        let [a, b, c] = triangle.map(|index| positions[index as usize]);
        triangle.iter().for_each(|&index| smooth[index as usize] += (b - a).cross(c - a));
    }
    let normals: Vec<Vec3> = match raw.normals {
        RawNormals::PerVertex(normals) => normals,
        _ => smooth,
    };
    let unit: Vec<Vec3> = normals.iter().map(|normal| normal.normalize_or(Vec3::Z)).collect();
    let radius = positions.iter().map(|p| p.length()).fold(0.0, f32::max);
    Shape {
        normals: unit.iter().map(|&normal| pack_normal(normal)).collect(),
        hulls: unit.iter().map(|&normal| pack_hull(normal)).collect(),
        positions,
        colors: raw.colors,
        triangles: raw.triangles,
        sphere: Sphere { center: Vec3::ZERO, radius },
    }
}

/// Numbers names, each once.
#[derive(Default)]
struct Names {
    number_of: HashMap<String, u32>,
    texts: Vec<String>,
}

impl Names {
    fn number(&mut self, name: String) -> u32 {
        if let Some(&number) = self.number_of.get(&name) {
            return number;
        }
        let number = self.texts.len() as u32;
        self.texts.push(name.clone());
        self.number_of.insert(name, number);
        number
    }
}
