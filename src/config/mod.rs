//! Style files: from JSON text to a [`Style`] in which every name is bound and every property has a value.
//!
//! The format is a superset of the JSON config file of [Prost2016 §3.1]. The text becomes a tree that knows the place
//! of each key ([`syntax`]); a base is merged under it ([`extends`]); what is left is read by tables of [`Param`]s:
//! those of `camera`, `geometry`, `light` and `transparency` lie here, those of shaders and post effects come with the
//! [`Catalog`] that the engine hands over. Every mistake of a file is collected before any is reported, and a style with
//! mistakes never becomes a `Style`.
//!
//! Nothing here knows of a GPU, a scene or a shader.

mod blank;
pub mod camera;
pub mod catalog;
pub mod color;
pub mod error;
pub mod extends;
pub mod geometry;
mod glob;
pub mod hint;
pub mod length;
pub mod light;
pub mod manual;
pub mod param;
mod read;
pub mod schema;
pub mod sections;
pub mod selector;
pub mod shaders;
mod source;
pub mod style;
pub mod syntax;
pub mod transparency;
pub mod values;

use std::path::Path;

pub use camera::{Camera, Orient};
pub use catalog::{Catalog, CatalogEntry, Role};
pub use color::{BaseColor, Srgba};
pub use error::{Mistake, Mistakes, Notice, Place, Problem, Warning};
pub use extends::{Files, Loader};
pub use geometry::{AtomRadius, Geometry};
pub use hint::Hint;
pub use length::Length;
pub use light::{Light, LightKind, Shadow, Space};
pub use param::{Kind, Param, Value};
pub use schema::schema;
pub use sections::{SECTIONS, Section};
pub use selector::{Attribute, AttributeSet, ObjectKind, Selector};
pub use shaders::ShaderUse;
pub use source::Source;
pub use style::{Rule, Style};
pub use transparency::{Transparency, TransparencyMethod};
pub use values::{Origin, Values};

/// Loads a style; a base that it extends is a file beside it.
pub fn load(source: &Source, catalog: &Catalog<'_>) -> Result<Style, Mistakes> {
    load_with(source, catalog, &Files)
}

/// Loads a style; `loader` finds the base that it extends.
pub fn load_with(source: &Source, catalog: &Catalog<'_>, loader: &dyn Loader) -> Result<Style, Mistakes> {
    let mut texts = source::Texts::default();
    let merged = extends::merge_all(source, loader, &mut texts)?;
    style::resolve(&texts, merged, catalog)
}

/// Loads a style file.
pub fn load_file(path: &Path, catalog: &Catalog<'_>) -> Result<Style, Mistakes> {
    let source = extends::read_file(path).map_err(|reason| extends::unreadable(path, reason))?;
    load(&source, catalog)
}
