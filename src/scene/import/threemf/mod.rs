//! 3MF: a zip archive with XML in it [ThreeMfCore, throughout].
//!
//! The items of the build are placed with all components below them; `p:path` finds objects in other entries [ThreeMfProduction, throughout].
//! An object's triangles are split by material; colour groups become colours of vertices [ThreeMfMaterials, throughout]. All lengths are
//! turned into millimetres. Mended and noted: triangles without three finite vertices, objects that do not exist, transforms
//! that are no numbers.
//!
//! Not read: textures, composite materials, lattices, slices.

mod archive;
mod model;
mod parse;
mod shapes;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use glam::DAffine3;
use quick_xml::Reader;
use quick_xml::events::Event;

use super::Import;
use super::lines::quote;
use super::number::ABSURD;
use super::tree_path::TreePath;
use crate::scene::error::SceneError;
use crate::scene::mesh::{RawMesh, RawPart};
use crate::scene::report::{NoteKind, Report};
use archive::Archive;
use model::{Model, Placement};

/// Objects within each other: more is no assembly that anyone made.
const MAX_DEPTH: usize = 256;
/// Objects that small files may place on top of one for each of this many bytes of XML.
const SPARE_PLACEMENTS: u64 = 1 << 14;
const BYTES_OF_PLACEMENT: u64 = 20;

/// An entry and an object of it.
type ObjectKey = (usize, u32);

/// Where the walk is in one object.
struct Open {
    key: ObjectKey,
    num_entered: usize,
    file_from_object: DAffine3,
    /// What the path needs to step back.
    path_length: usize,
}

/// What is read of a file so far.
struct Package<'a, 'r> {
    archive: Archive<'a>,
    report: &'r mut Report,
    models: Vec<Model>,
    model_of_path: HashMap<String, Option<usize>>,
    mesh: RawMesh,
    /// Shapes and materials of the objects that were placed.
    placed: HashMap<ObjectKey, Vec<(u32, Option<u32>)>>,
    num_placements: u64,
    num_left_out: u64,
}

/// Reads what the file wants to be built.
pub(super) fn read(import: &mut Import<'_>, bytes: &[u8]) -> Result<RawMesh, SceneError> {
    let mesh = read_package(bytes, &mut import.report);
    mesh.map_err(|what| SceneError::Damaged { file: import.file.to_owned(), what })
}

fn read_package(bytes: &[u8], report: &mut Report) -> Result<RawMesh, String> {
    let archive = Archive::open(bytes)?;
    let mut package = Package {
        archive,
        report,
        models: Vec::new(),
        model_of_path: HashMap::new(),
        mesh: RawMesh::default(),
        placed: HashMap::new(),
        num_placements: 0,
        num_left_out: 0,
    };
    let root = package.root_path()?;
    let Some(root) = package.model(&root)? else {
        return Err(format!("has no entry {}, where its model should be; export it again", quote(root.as_bytes())));
    };
    package.build(root)?;
    if package.mesh.parts.is_empty() && package.num_left_out > 0 {
        return Err(format!(
            "none of its {} triangles has three vertices that exist and are finite; export it again",
            package.num_left_out
        ));
    }
    Ok(package.mesh)
}

impl Package<'_, '_> {
    /// The path of the main model: what the archive's relations say, else any model [Opc, throughout].
    fn root_path(&mut self) -> Result<String, String> {
        let mut found = None;
        if let Some(entry) = self.archive.entry("_rels/.rels")? {
            let mut reader = Reader::from_reader(entry);
            let mut buffer = Vec::new();
            while let Ok(event) = reader.read_event_into(&mut buffer) {
                let (Event::Start(element) | Event::Empty(element)) = event else {
                    if matches!(event, Event::Eof) {
                        break;
                    }
                    continue;
                };
                let value =
                    |name: &str| element.try_get_attribute(name).ok().flatten().map(|value| value.value.into_owned());
                if value("Type").is_some_and(|kind| kind.ends_with("/3dmodel")) {
                    found = value("Target");
                    break;
                }
                buffer.clear();
            }
        }
        Ok(found.or_else(|| self.archive.first_ending(".model")).unwrap_or_else(|| "3D/3dmodel.model".to_owned()))
    }

    /// The number of a model, read when it is first asked for; none if there is no such entry.
    fn model(&mut self, path: &str) -> Result<Option<usize>, String> {
        let path = path.trim_start_matches('/');
        if let Some(&model) = self.model_of_path.get(path) {
            return Ok(model);
        }
        let model = match self.archive.entry(path)? {
            Some(entry) => {
                let model = parse::parse(entry, &mut self.mesh.materials, self.report)
                    .map_err(|what| format!("in its entry {}, {what}", quote(path.as_bytes())))?;
                self.models.push(model);
                Some(self.models.len() - 1)
            }
            None => None,
        };
        self.model_of_path.insert(path.to_owned(), model);
        Ok(model)
    }

    /// Places all items of a model and what is below them.
    fn build(&mut self, root: usize) -> Result<(), String> {
        let mut items = std::mem::take(&mut self.models[root].items).into_iter();
        let mut stack: Vec<Open> = Vec::new();
        let mut path = TreePath::default();
        loop {
            let (placement, parent_model, file_from_parent) = match stack.last_mut() {
                None => match items.next() {
                    Some(item) => (item, root, DAffine3::IDENTITY),
                    None => return Ok(()),
                },
                Some(open) => {
                    let (model, object) = open.key;
                    let components = self.models[model].objects.get(&object).map(|object| &object.components);
                    match components.and_then(|all| all.get(open.num_entered)) {
                        Some(component) => {
                            open.num_entered += 1;
                            (component.clone(), model, open.file_from_object)
                        }
                        None => {
                            path.leave(open.path_length);
                            stack.pop();
                            continue;
                        }
                    }
                }
            };
            self.count_placement()?;
            let Some(key) = self.find(&placement, parent_model)? else { continue };
            if let Some(at) = stack.iter().position(|open| open.key == key) {
                let ring: Vec<String> = stack[at..].iter().take(5).map(|open| self.quoted(open.key)).collect();
                return Err(format!(
                    "the object {} is a component of itself ({}); export it again",
                    ring[0],
                    ring.join(" > ")
                ));
            }
            if stack.len() >= MAX_DEPTH {
                return Err(format!("its components are nested more than {MAX_DEPTH} deep; export it again, flatter"));
            }
            let file_from_object = file_from_parent * placement.parent_from_object;
            let is_place = file_from_object.to_cols_array().iter().all(|value| value.abs() <= ABSURD);
            if !is_place || !file_from_object.is_finite() {
                self.report.note(NoteKind::NodeLeftOut, None, || format!("object {}", key.1));
                continue;
            }
            let name = self.name(key, &placement.part_number);
            let path_length = path.enter(&name);
            self.place(key, &name, &path, file_from_object);
            stack.push(Open { key, num_entered: 0, file_from_object, path_length });
        }
    }

    fn count_placement(&mut self) -> Result<(), String> {
        self.num_placements += 1;
        let most = SPARE_PLACEMENTS + self.archive.num_unpacked / BYTES_OF_PLACEMENT;
        if self.num_placements > most {
            return Err(format!("places its objects more than {most} times; remove copies"));
        }
        Ok(())
    }

    /// The object that is placed; none, with a note, if it does not exist.
    fn find(&mut self, placement: &Placement, parent_model: usize) -> Result<Option<ObjectKey>, String> {
        let model = match &placement.path {
            Some(path) => self.model(path)?,
            None => Some(parent_model),
        };
        let key = model.map(|model| (model, placement.object));
        let key = key.filter(|(model, object)| self.models[*model].objects.contains_key(object));
        if key.is_none() {
            self.report.note(NoteKind::ReferenceToNowhere, None, || {
                let of =
                    placement.path.as_ref().map_or(String::new(), |path| format!(" of {}", quote(path.as_bytes())));
                format!("object {}{of}", placement.object)
            });
        }
        Ok(key)
    }

    /// What an object is called: by name, else by part number, else by id.
    fn name(&self, (model, id): ObjectKey, part_number: &str) -> String {
        let object = self.models[model].objects.get(&id);
        let names = object.map(|object| [object.name.as_str(), &object.part_number]).unwrap_or_default();
        let mut names = names.into_iter().chain([part_number]);
        names.find(|name| !name.is_empty()).map_or_else(|| format!("object {id}"), str::to_owned)
    }

    fn quoted(&self, key: ObjectKey) -> String {
        quote(self.name(key, "").as_bytes())
    }

    fn place(&mut self, key: ObjectKey, name: &str, path: &TreePath, file_from_shape: DAffine3) {
        let (model, id) = key;
        if !self.placed.contains_key(&key) {
            let Model { objects, groups, .. } = &mut self.models[model];
            let Some(object) = objects.get_mut(&id) else { return };
            let (shapes, num_left_out) = shapes::of_object(object, groups, self.report, &quote(name.as_bytes()));
            self.num_left_out += num_left_out;
            let first = self.mesh.shapes.len() as u32;
            let numbers = (first..).zip(&shapes).map(|(number, (_, material))| (number, *material)).collect();
            self.mesh.shapes.extend(shapes.into_iter().map(|(shape, _)| shape));
            self.placed.insert(key, numbers);
        }
        let shapes = self.placed.get(&key).map(Vec::as_slice).unwrap_or_default();
        self.mesh.parts.extend(shapes.iter().map(|&(shape, material)| RawPart {
            shape,
            material,
            name: name.to_owned(),
            path: path.text(),
            file_from_shape,
        }));
    }
}
