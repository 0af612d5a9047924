//! What a scene holds, counted.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use glam::{DVec3, Vec3};
use serde_json::{Value as Json, json};

use crate::config::ObjectKind;
use crate::scene::{Element, MeshMaterial, Part, ResidueKind, Scene};

/// Everything that is told of a scene. The longest lists begin with what there is most of.
pub(super) struct Facts {
    pub(super) files: Vec<FileFacts>,
    /// Atoms and bonds.
    pub(super) atoms: usize,
    pub(super) bonds: usize,
    /// By what they are.
    pub(super) residues: Vec<(&'static str, Group)>,
    /// Names of ligands.
    pub(super) ligands: Vec<(String, Group)>,
    /// In the order of the files.
    pub(super) chains: Vec<ChainFacts>,
    /// Symbols with the number of their atoms.
    pub(super) elements: Vec<(&'static str, usize)>,
    pub(super) models: Vec<u32>,
    /// How often atoms are placed by a biological assembly; 0 without one.
    pub(super) copies: usize,
    pub(super) parts: Vec<PartFacts>,
    pub(super) materials: Vec<MaterialFacts>,
    /// Of all parts, those of a shape once for each place.
    pub(super) triangles: u64,
    /// Of all shapes, each once.
    pub(super) vertices: usize,
    pub(super) bounds: Bounds,
    pub(super) memory_bytes: usize,
}

/// A file of the scene.
pub(super) struct FileFacts {
    pub(super) name: String,
    pub(super) format: &'static str,
    /// What was mended, guessed or skipped, one line a kind.
    pub(super) notes: Vec<String>,
    side_files: Vec<String>,
}

/// Residues and their atoms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Group {
    pub(super) residues: usize,
    pub(super) atoms: usize,
}

/// A chain of a file.
pub(super) struct ChainFacts {
    pub(super) id: String,
    pub(super) file: String,
    pub(super) group: Group,
}

/// Parts of a file that are alike in name, material and shape.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct PartFacts {
    pub(super) name: String,
    file: String,
    pub(super) material: Option<String>,
    /// Of one of them.
    pub(super) triangles: u64,
    pub(super) placed: u64,
}

/// A material with what is made of it.
pub(super) struct MaterialFacts {
    pub(super) name: String,
    /// sRGB, `#rrggbb`.
    pub(super) color: String,
    pub(super) parts: u64,
    pub(super) triangles: u64,
}

/// What a scene fills, in the units and coordinates of its files: atoms with their van der Waals radii, and vertices.
pub(super) struct Bounds {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    pub(super) center: DVec3,
    pub(super) radius: f64,
}

impl Facts {
    /// Counts what a scene holds, in time linear in it.
    pub(super) fn new(scene: &Scene) -> Facts {
        let (molecule, assembly) = (&scene.molecule, &scene.assembly);
        let mut atoms_of_residue = vec![0; molecule.residues.len()];
        let mut elements: HashMap<Element, usize> = HashMap::new();
        for atom in &molecule.atoms {
            atoms_of_residue[atom.residue as usize] += 1;
            *elements.entry(atom.element).or_default() += 1;
        }
        let mut kinds: BTreeMap<ResidueKind, Group> = BTreeMap::new();
        let mut ligands: HashMap<&str, Group> = HashMap::new();
        let mut chains = vec![Group::default(); molecule.chains.len()];
        for (residue, atoms) in molecule.residues.iter().zip(atoms_of_residue) {
            let add = |group: &mut Group| (group.residues, group.atoms) = (group.residues + 1, group.atoms + atoms);
            add(kinds.entry(residue.kind).or_default());
            add(&mut chains[residue.chain as usize]);
            if residue.kind == ResidueKind::Ligand {
                add(ligands.entry(residue.name.as_str()).or_default());
            }
        }
        let file_name = |file: u32| scene.files.get(file as usize).map_or(String::new(), |file| file.name.clone());
        let chains = molecule.chains.iter().zip(chains).map(|(chain, group)| ChainFacts {
            id: chain.id.clone(),
            file: file_name(chain.file),
            group,
        });
        let mut elements: Vec<_> = elements.into_iter().map(|(of, count)| (of.symbol(), count)).collect();
        elements.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
        let mut ligands: Vec<_> = ligands.into_iter().map(|(name, group)| (name.to_owned(), group)).collect();
        ligands.sort_by(|a, b| b.1.atoms.cmp(&a.1.atoms).then(a.0.cmp(&b.0)));
        let files = scene.files.iter().map(|file| FileFacts {
            name: file.name.clone(),
            format: file.format.name(),
            notes: file.report.to_string().lines().map(str::to_owned).collect(),
            side_files: file.side_files.iter().map(|path| path.display().to_string()).collect(),
        });
        Facts {
            files: files.collect(),
            atoms: molecule.atoms.len(),
            bonds: molecule.bonds.len(),
            residues: kinds.into_iter().map(|(kind, group)| (kind.name(), group)).collect(),
            ligands,
            chains: chains.collect(),
            elements,
            models: molecule.residues.iter().map(|of| of.model).collect::<BTreeSet<_>>().into_iter().collect(),
            copies: molecule.copies.len(),
            parts: parts(scene, &file_name),
            materials: materials(scene),
            triangles: assembly.num_triangles(),
            vertices: assembly.shapes.iter().map(|shape| shape.positions.len()).sum(),
            bounds: bounds(scene),
            memory_bytes: molecule.memory_bytes() + assembly.memory_bytes(),
        }
    }

    /// The types of objects that the scene has, as selectors call them.
    pub(super) fn types(&self) -> Vec<&'static str> {
        let counts =
            [(ObjectKind::Atom, self.atoms), (ObjectKind::Connector, self.bonds), (ObjectKind::Mesh, self.parts.len())];
        counts.into_iter().filter(|(_, count)| *count > 0).map(|(kind, _)| kind.name()).collect()
    }

    /// All of it; `scenes` are what the command line calls them.
    pub(super) fn json(&self, scenes: &[String]) -> Json {
        let group = |group: &Group| json!({ "residues": group.residues, "atoms": group.atoms });
        let residues: serde_json::Map<String, Json> =
            self.residues.iter().map(|(kind, of)| ((*kind).to_owned(), group(of))).collect();
        let ligands: serde_json::Map<String, Json> =
            self.ligands.iter().map(|(name, of)| (name.clone(), group(of))).collect();
        let elements: serde_json::Map<String, Json> =
            self.elements.iter().map(|(symbol, count)| ((*symbol).to_owned(), (*count).into())).collect();
        let file = |file: &FileFacts| json!({ "name": file.name, "format": file.format, "notes": file.notes, "side_files": file.side_files });
        let chain = |chain: &ChainFacts| {
            let Group { residues, atoms } = chain.group;
            json!({ "id": chain.id, "file": chain.file, "residues": residues, "atoms": atoms })
        };
        let part = |part: &PartFacts| {
            json!({
                "name": part.name,
                "file": part.file,
                "material": part.material,
                "triangles": part.triangles,
                "placed": part.placed,
            })
        };
        let material = |of: &MaterialFacts| json!({ "name": of.name, "color": of.color, "parts": of.parts, "triangles": of.triangles });
        let Bounds { low, high, center, radius } = &self.bounds;
        json!({
            "scenes": scenes,
            "files": self.files.iter().map(file).collect::<Vec<_>>(),
            "types": self.types(),
            "atoms": self.atoms,
            "bonds": self.bonds,
            "residues": residues,
            "ligands": ligands,
            "chains": self.chains.iter().map(chain).collect::<Vec<_>>(),
            "elements": elements,
            "models": self.models,
            "copies": self.copies,
            "parts": self.parts.iter().map(part).collect::<Vec<_>>(),
            "materials": self.materials.iter().map(material).collect::<Vec<_>>(),
            "triangles": self.triangles,
            "vertices": self.vertices,
            "bounds": {
                "min": low.to_array(),
                "max": high.to_array(),
                "center": center.to_array(),
                "radius": radius,
            },
            "memory_bytes": self.memory_bytes,
        })
    }
}

/// Parts that are alike, those of the most triangles first.
fn parts(scene: &Scene, file_name: &dyn Fn(u32) -> String) -> Vec<PartFacts> {
    let assembly = &scene.assembly;
    let mut placed: HashMap<_, (usize, u64)> = HashMap::new();
    for (first, part) in assembly.parts.iter().enumerate() {
        placed.entry((part.file, part.name, part.material, part.shape)).or_insert((first, 0)).1 += 1;
    }
    let mut rows: Vec<(usize, PartFacts)> = placed
        .into_iter()
        .map(|((file, name, material, shape), (first, placed))| {
            let facts = PartFacts {
                name: assembly.names[name as usize].clone(),
                file: file_name(file),
                material: material.map(|material| assembly.materials[material as usize].name.clone()),
                triangles: assembly.shapes[shape as usize].triangles.len() as u64,
                placed,
            };
            (first, facts)
        })
        .collect();
    rows.sort_by_key(|(first, part)| (std::cmp::Reverse(part.triangles * part.placed), *first));
    rows.into_iter().map(|(_, part)| part).collect()
}

fn materials(scene: &Scene) -> Vec<MaterialFacts> {
    let assembly = &scene.assembly;
    let mut counts = vec![(0, 0); assembly.materials.len()];
    let triangles = |part: &Part| assembly.shapes[part.shape as usize].triangles.len() as u64;
    for part in &assembly.parts {
        if let Some(material) = part.material {
            let (parts, of_triangles) = &mut counts[material as usize];
            (*parts, *of_triangles) = (*parts + 1, *of_triangles + triangles(part));
        }
    }
    let facts = |(material, (parts, triangles)): (&MeshMaterial, (u64, u64))| MaterialFacts {
        name: material.name.clone(),
        color: hex(material.base_color),
        parts,
        triangles,
    };
    assembly.materials.iter().zip(counts).map(facts).collect()
}

/// Linear RGB as sRGB [IEC61966 §5.2].
fn hex(linear: Vec3) -> String {
    let byte = |value: f32| {
        let value = value.clamp(0.0, 1.0);
        let coded = if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
        (coded * 255.0).round() as u8
    };
    let [r, g, b] = linear.to_array().map(byte);
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn bounds(scene: &Scene) -> Bounds {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for (center, radius) in scene.molecule.drawn_balls() {
        (low, high) = (low.min(center - radius), high.max(center + radius));
    }
    for part in &scene.assembly.parts {
        for &position in &scene.assembly.shapes[part.shape as usize].positions {
            let position = part.world_from_shape.transform_point3(position);
            (low, high) = (low.min(position), high.max(position));
        }
    }
    let of_file = |point: Vec3| scene.origin() + point.as_dvec3() * scene.unit;
    let sphere = scene.bounding_sphere();
    Bounds {
        low: of_file(low),
        high: of_file(high),
        center: of_file(sphere.center),
        radius: f64::from(sphere.radius) * scene.unit,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_those_of_the_file() {
        assert_eq!(hex(Vec3::new(0.0, 1.0, 0.214_041_14)), "#00ff80");
        assert_eq!(hex(Vec3::new(-1.0, 9.0, 0.003)), "#00ff0a");
    }
}
