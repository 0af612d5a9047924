//! Style files: from JSON text to a [`Style`] in which every name is bound and every property has a value.
//!
//! The format is a superset of the JSON config file of [Prost2016 §3.1]. The text becomes a tree that knows the place
//! of each key ([`syntax`]); the parser reads on after every mistake, so that what is sound is checked all the same. A
//! base is merged under it ([`extends`]); what is left is read by tables of [`Param`]s: those of `camera`, `geometry`,
//! `light` and `transparency` lie here, those of shaders and post effects come with the [`Catalog`] that the engine
//! hands over. Every mistake of a file and its bases is collected before any is reported, and a style with mistakes
//! never becomes a `Style`.
//!
//! Nothing here knows of a GPU, a scene or a shader.

mod bare;
pub mod camera;
pub mod catalog;
pub mod color;
pub mod diagnostic;
mod elsewhere;
pub mod error;
mod escape;
pub mod explain;
pub mod extends;
pub mod file;
pub mod geometry;
mod glob;
mod glob_set;
pub mod hint;
pub mod length;
mod lex;
pub mod light;
pub mod manual;
pub mod param;
mod parse;
mod pattern;
mod pictures;
mod range;
mod read;
pub mod rules;
pub mod schema;
pub mod sections;
pub mod selector;
pub mod shaders;
mod slips;
mod source;
pub mod style;
pub mod syntax;
pub mod transfer;
pub mod transparency;
pub mod values;

use std::path::Path;

pub use camera::{Camera, Orient};
pub use catalog::{Catalog, CatalogEntry, Role};
pub use color::{BaseColor, Srgba};
pub use diagnostic::{Severity, SourceTexts};
pub use error::{MOST_LISTED, Mistake, Mistakes, Notice, Place, Problem, Warning};
pub use extends::{Files, Loader};
pub use file::Unreadable;
pub use geometry::{AtomRadius, Geometry};
pub use hint::Hint;
pub use length::Length;
pub use light::{Light, LightKind, Shadow, Space};
pub use param::{Kind, Param, Value};
pub use rules::{Matched, MatchedValues, RuleIndex};
pub use schema::schema;
pub use sections::{SECTIONS, Section};
pub use selector::{Attribute, AttributeSet, AttributeValues, ObjectKind, Selector};
pub use shaders::ShaderUse;
pub use source::Source;
pub use style::{EffectUse, Overrides, Rule, SectionValues, Style};
pub use transfer::{Transfer, TransferKind};
pub use transparency::{Transparency, TransparencyMethod};
pub use values::{Origin, Values};

/// Loads a style; a base that it extends is a file beside it.
pub fn load(source: &Source, catalog: &Catalog<'_>) -> Result<Style, Mistakes> {
    load_with(source, catalog, &Files)
}

/// Loads a style; `loader` finds the base that it extends.
pub fn load_with(source: &Source, catalog: &Catalog<'_>, loader: &dyn Loader) -> Result<Style, Mistakes> {
    let mut texts = source::Texts::default();
    let merged = extends::merge_all(source, loader, &mut texts);
    let mut resolved = style::resolve(&texts, merged, catalog);
    let texts = SourceTexts::new(texts.0.into_iter().map(|text| (text.name, text.text.into())));
    match &mut resolved {
        Ok(style) => style.texts = texts,
        Err(mistakes) => mistakes.texts = texts,
    }
    resolved
}

/// Loads a style file; a base that it extends is a file beside it.
pub fn load_file(path: &Path, catalog: &Catalog<'_>) -> Result<Style, Mistakes> {
    load_file_with(path, catalog, &Files)
}

/// Loads a style file; `loader` finds the base that it extends.
pub fn load_file_with(path: &Path, catalog: &Catalog<'_>, loader: &dyn Loader) -> Result<Style, Mistakes> {
    let source = file::read_file(path).map_err(|reason| extends::unreadable(path, reason))?;
    load_with(&source, catalog, loader)
}
