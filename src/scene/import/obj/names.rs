//! Names of objects, groups and materials, and the parts that they make.

use std::collections::HashMap;

/// Faces of one object, group and material: a part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Run {
    /// Index into [`Names::texts`].
    pub(super) object: u32,
    /// Index into [`Names::texts`].
    pub(super) group: u32,
    /// Index into [`Names::materials`].
    pub(super) material: Option<u32>,
    /// Whether all corners have normals: `tobj` answers one list for a run, whole or not.
    pub(super) has_normals: bool,
}

/// What the file names.
#[derive(Default)]
pub(super) struct Names {
    /// By their numbers, which are the names of `tobj`'s models.
    pub(super) runs: Vec<Run>,
    /// Materials in the order in which faces use them.
    pub(super) materials: Vec<String>,
    /// Files of materials, with the lines that name them.
    pub(super) libraries: Vec<(u32, String)>,
    /// Objects and groups.
    pub(super) texts: Vec<String>,
}

impl Names {
    /// Name and path of a part.
    pub(super) fn label(&self, run: &Run) -> (String, String) {
        let text = |number: u32| self.texts.get(number as usize).map_or("", String::as_str);
        let (object, group) = (text(run.object), text(run.group));
        match (object, group) {
            (only, "") | ("", only) => (only.to_owned(), only.to_owned()),
            _ => (group.to_owned(), format!("{object}/{group}")),
        }
    }
}

/// Numbers for texts, each once.
#[derive(Default)]
pub(super) struct Numbers(HashMap<String, u32>);

impl Numbers {
    /// The number of a text; new ones join `texts`.
    pub(super) fn of(&mut self, text: String, texts: &mut Vec<String>) -> u32 {
        *self.0.entry(text).or_insert_with_key(|text| {
            texts.push(text.clone());
            texts.len() as u32 - 1
        })
    }
}
