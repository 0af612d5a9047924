//! What a style can name: the shaders and post effects of the program, handed over by the engine.

use super::param::{Param, check_table};
use super::selector::{Attribute, ObjectKind};

/// The shader of everything that nothing selects.
pub const BASIC: &str = "basic";

/// What a shader is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// It draws objects.
    Object,
    /// It changes the picture.
    PostEffect,
}

/// One registered shader or post effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CatalogEntry {
    /// Its name in style files.
    pub name: &'static str,
    /// What it is for.
    pub role: Role,
    /// One sentence for the manual, the schema and the editor.
    pub doc: &'static str,
    /// Its parameters.
    pub params: &'static [Param],
}

/// All names that a style can use. It must have [`BASIC`] as a shader of objects.
#[derive(Debug, Clone, Copy)]
pub struct Catalog<'a> {
    /// Shaders and post effects.
    pub shaders: &'a [CatalogEntry],
    /// The types of objects that this version draws.
    pub kinds: &'a [ObjectKind],
}

impl<'a> Catalog<'a> {
    /// The entry of a name.
    pub fn get(&self, name: &str) -> Option<&'a CatalogEntry> {
        self.shaders.iter().find(|entry| entry.name == name)
    }

    /// Names of one role or of both.
    pub fn names(&self, role: Option<Role>) -> impl Iterator<Item = &'static str> + use<'a> {
        self.shaders.iter().filter(move |entry| role.is_none_or(|role| role == entry.role)).map(|entry| entry.name)
    }

    /// What selectors can ask of the types that are drawn.
    pub fn attributes(&self) -> impl Iterator<Item = Attribute> + use<'a> {
        let kinds = self.kinds;
        Attribute::ALL.into_iter().filter(move |of| kinds.iter().any(|kind| kind.attributes().contains(of)))
    }

    /// The shader of everything that nothing selects.
    pub(super) fn basic(&self) -> &'a CatalogEntry {
        self.get(BASIC).expect("every catalog has basic, which Catalog::check finds in a test")
    }

    /// What is wrong with the catalog and its tables; empty if nothing is. For a test of whoever builds one.
    pub fn check(&self) -> Vec<String> {
        let mut wrong = Vec::new();
        if !self.get(BASIC).is_some_and(|entry| entry.role == Role::Object) {
            wrong.push(format!("{BASIC:?} is not a shader of objects"));
        }
        for (i, entry) in self.shaders.iter().enumerate() {
            if self.shaders[..i].iter().any(|earlier| earlier.name == entry.name) {
                wrong.push(format!("{:?} is registered twice", entry.name));
            }
            if !entry.doc.ends_with('.') {
                wrong.push(format!("{:?}: its doc is not a sentence", entry.name));
            }
            wrong.extend(check_table(entry.params).into_iter().map(|reason| format!("{}: {reason}", entry.name)));
        }
        wrong
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_catalog_without_basic_is_found() {
        let entry = CatalogEntry { name: "fog", role: Role::PostEffect, doc: "Hides what is far.", params: &[] };
        let catalog = Catalog { shaders: &[entry, entry], kinds: &[] };
        assert_eq!(catalog.check(), ["\"basic\" is not a shader of objects", "\"fog\" is registered twice"]);
    }
}
