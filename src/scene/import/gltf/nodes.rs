//! The tree of nodes: which mesh stands where [Gltf2 §3.5].
//!
//! Walked with a stack of its own: trees may be deeper than the program's. A node is placed once, as the format has it.

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde_json::Value;

use super::super::lines::quote;
use super::super::number::ABSURD;
use super::super::tree_path::{TreePath, short_name};
use super::Document;
use super::accessor::entry;
use super::json::{list, numbers, text, whole, whole_of};
use super::primitive::Shapes;
use crate::scene::mesh::RawPart;
use crate::scene::report::{NoteKind, Report};

/// Parts that small files may have on top of one for every second byte.
const SPARE_PARTS: usize = 200_000;

/// Where the walk is in one node.
struct Open<'a> {
    node: usize,
    children: &'a [Value],
    num_entered: usize,
    file_from_node: DAffine3,
    /// What the path needs to step back.
    path_length: usize,
}

/// What is known of a node.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Visit {
    Never,
    Open,
    Done,
}

/// A walk, and what it found.
pub(super) struct Walk<'a> {
    document: &'a Document<'a>,
    nodes: &'a [Value],
    meshes: &'a [Value],
    pub(super) shapes: Shapes,
    pub(super) parts: Vec<RawPart>,
    max_parts: usize,
    /// Shapes and materials of the meshes that were placed.
    placed: HashMap<u64, Vec<(u32, Option<u32>)>>,
    num_materials: usize,
    path: TreePath,
}

impl<'a> Walk<'a> {
    /// A walk that has not begun.
    pub(super) fn new(document: &'a Document<'a>, num_file_bytes: usize) -> Result<Self, String> {
        Ok(Self {
            document,
            nodes: list(&document.json, "nodes", "")?,
            meshes: list(&document.json, "meshes", "")?,
            shapes: Shapes::new(document),
            parts: Vec::new(),
            max_parts: num_file_bytes / 2 + SPARE_PARTS,
            placed: HashMap::new(),
            num_materials: list(&document.json, "materials", "")?.len(),
            path: TreePath::default(),
        })
    }

    /// Places everything below the roots.
    ///
    /// # Errors
    /// In words: a node below itself, or a mesh whose data are not there.
    pub(super) fn run(&mut self, roots: &[Value], report: &mut Report) -> Result<(), String> {
        let mut visits = vec![Visit::Never; self.nodes.len()];
        let mut stack: Vec<Open<'_>> = Vec::new();
        let mut roots = roots.iter();
        loop {
            let (child, file_from_parent) = match stack.last_mut() {
                None => match roots.next() {
                    Some(root) => (root, DAffine3::IDENTITY),
                    None => return Ok(()),
                },
                Some(open) => match open.children.get(open.num_entered) {
                    Some(child) => {
                        open.num_entered += 1;
                        (child, open.file_from_node)
                    }
                    None => {
                        visits[open.node] = Visit::Done;
                        self.path.leave(open.path_length);
                        stack.pop();
                        continue;
                    }
                },
            };
            let index = whole_of(child).and_then(|index| usize::try_from(index).ok());
            let Some((index, node)) = index.and_then(|index| Some((index, self.nodes.get(index)?))) else {
                report.note(NoteKind::ReferenceToNowhere, None, || format!("node {}", short(child)));
                continue;
            };
            match visits[index] {
                Visit::Never => {}
                Visit::Done => {
                    report.note(NoteKind::NodeTwice, None, || self.quoted(index));
                    continue;
                }
                Visit::Open => return Err(self.cycle(&stack, index)),
            }
            let file_from_node = self.local(index, node, report).map(|local| file_from_parent * local);
            let Some(file_from_node) = file_from_node.filter(is_place) else {
                visits[index] = Visit::Done;
                report.note(NoteKind::NodeLeftOut, None, || self.quoted(index));
                continue;
            };
            visits[index] = Visit::Open;
            let name = self.name(index);
            let path_length = self.path.enter(&name);
            if let Some(mesh) = whole(node, "mesh", &format!("nodes[{index}]"))? {
                self.place(mesh, &name, file_from_node, report)?;
            }
            let children = list(node, "children", &format!("nodes[{index}]"))?;
            stack.push(Open { node: index, children, num_entered: 0, file_from_node, path_length });
        }
    }

    /// Places the primitives of a mesh.
    fn place(&mut self, mesh: u64, name: &str, file_from_shape: DAffine3, report: &mut Report) -> Result<(), String> {
        if !self.placed.contains_key(&mesh) {
            let shapes = self.read_mesh(mesh, report)?;
            self.placed.insert(mesh, shapes);
        }
        let shapes = self.placed.get(&mesh).map(Vec::as_slice).unwrap_or_default();
        if shapes.is_empty() {
            return Ok(());
        }
        if self.parts.len() + shapes.len() > self.max_parts {
            return Err(format!("places its meshes more than {} times; remove copies", self.max_parts));
        }
        let path = self.path.text();
        self.parts.extend(shapes.iter().map(|&(shape, material)| RawPart {
            shape,
            material,
            name: name.to_owned(),
            path: path.clone(),
            file_from_shape,
        }));
        Ok(())
    }

    fn read_mesh(&mut self, mesh: u64, report: &mut Report) -> Result<Vec<(u32, Option<u32>)>, String> {
        let Some(json) = entry(self.meshes, mesh) else {
            report.note(NoteKind::ReferenceToNowhere, None, || format!("mesh {mesh}"));
            return Ok(Vec::new());
        };
        let place = format!("meshes[{mesh}]");
        let mut shapes = Vec::new();
        for (index, primitive) in list(json, "primitives", &place)?.iter().enumerate() {
            let place = format!("{place}.primitives[{index}]");
            let material = whole(primitive, "material", &place)?;
            let is_there = |material: &u64| (*material as usize) < self.num_materials;
            let known = material.filter(is_there);
            if known != material {
                report.note(NoteKind::ReferenceToNowhere, None, || format!("material of {place}"));
            }
            if let Some(shape) = self.shapes.of_primitive(self.document, primitive, &place, report)? {
                shapes.push((shape, known.map(|material| material as u32)));
            }
        }
        Ok(shapes)
    }

    /// What a node is called: its own name, else that of its mesh, else its number.
    fn name(&self, index: usize) -> String {
        let node = &self.nodes[index];
        let mesh = || node.get("mesh").and_then(whole_of).and_then(|mesh| entry(self.meshes, mesh));
        let own = Some(text(node, "name")).filter(|name| !name.is_empty());
        let name = own.or_else(|| mesh().map(|mesh| text(mesh, "name")).filter(|name| !name.is_empty()));
        name.map_or_else(|| format!("node {index}"), |name| short_name(name).to_owned())
    }

    fn quoted(&self, index: usize) -> String {
        quote(self.name(index).as_bytes())
    }

    /// The error of a node that is below itself.
    fn cycle(&self, stack: &[Open<'_>], index: usize) -> String {
        let above = stack.iter().rev().take_while(|open| open.node != index).map(|open| open.node);
        let mut ring: Vec<usize> = above.collect();
        ring.push(index);
        ring.reverse();
        let names: Vec<String> = ring.iter().take(5).map(|&node| self.quoted(node)).collect();
        let more = if ring.len() > 5 { " > ..." } else { "" };
        let ring = names.join(" > ");
        format!(
            "the node {} is below itself ({ring}{more} > {}); take it out of the last one's children",
            names[0], names[0]
        )
    }

    /// A node's transform; none if it is not made of finite numbers.
    fn local(&self, index: usize, node: &Value, report: &mut Report) -> Option<DAffine3> {
        if node.get("matrix").is_some() {
            let m = numbers::<16>(node, "matrix")?;
            let column = |at: usize| DVec3::new(m[at], m[at + 1], m[at + 2]);
            let matrix3 = DMat3::from_cols(column(0), column(4), column(8));
            return Some(DAffine3::from_mat3_translation(matrix3, column(12)));
        }
        let three = |key: &str, default: DVec3| match node.get(key) {
            Some(_) => numbers::<3>(node, key).map(DVec3::from),
            None => Some(default),
        };
        let translation = three("translation", DVec3::ZERO)?;
        let scale = three("scale", DVec3::ONE)?;
        let rotation = match node.get("rotation") {
            Some(_) => DQuat::from_array(numbers::<4>(node, "rotation")?),
            None => DQuat::IDENTITY,
        };
        let length = rotation.length();
        if !length.is_finite() {
            return None;
        }
        let rotation = if length > 1e-12 {
            rotation / length
        } else {
            report.note(NoteKind::RotationMended, None, || self.quoted(index));
            DQuat::IDENTITY
        };
        Some(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
    }
}

/// Whether a transform can place anything.
fn is_place(transform: &DAffine3) -> bool {
    transform.is_finite() && transform.to_cols_array().iter().all(|value| value.abs() <= ABSURD)
}

/// A value that should have been a number, in few characters.
fn short(value: &Value) -> String {
    match value {
        Value::Number(number) => number.to_string(),
        _ => "that is no number".to_owned(),
    }
}
