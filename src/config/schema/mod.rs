//! The JSON Schema of style files, draft 7, made from the tables that the loader reads styles by.
//!
//! It is for editors: VS Code completes keys and values from it, shows each sentence of the manual on hover, and marks
//! mistakes while a designer types. Whatever it refuses, the loader refuses too. The loader refuses more, such as names
//! that refer to nothing: a test holds the list of what only it can know.
//!
//! Types of objects that this version does not draw are accepted, as they are in files, but never suggested, and marked as not drawn.
//! Some keywords are of VS Code's language server alone: `markdownDescription`, `defaultSnippets`, `doNotSuggest`,
//! `deprecationMessage`, `patternErrorMessage`, `errorMessage`, `allowComments`, `allowTrailingCommas`.

mod mapping;
mod param;
mod patterns;
mod snippets;

use serde_json::{Map, Value, json};

use super::catalog::{Catalog, CatalogEntry};
use super::param::Param;
use super::sections::{SECTIONS, Section};
use super::style::VERSION;

/// The name of the schema: what tells it from any other file.
pub const ID: &str = "urn:restyle:style:1";

/// The file that styles refer to with `$schema`.
pub const FILE: &str = "style-v1.json";

/// What the editor says of anything that loads with a warning.
const NOT_DRAWN: &str = "not drawn by this version yet";

/// The JSON Schema of style files.
pub fn schema(catalog: &Catalog<'_>) -> Value {
    let mut properties = Map::new();
    properties.insert(
        "$schema".to_owned(),
        json!({
            "type": "string",
            "description": "Where an editor finds this schema, relative to the style.",
            "default": FILE,
        }),
    );
    properties.insert(
        "version".to_owned(),
        json!({ "description": "The version of the format.", "const": VERSION, "default": VERSION }),
    );
    properties.insert(
        "extends".to_owned(),
        json!({
            "type": "string",
            "description": "A style file that this one changes, found beside it. Shaders merge by name and property by \
                            property, camera, geometry and mapping key by key; lights are replaced as a whole.",
        }),
    );
    for section in SECTIONS.iter().take(2) {
        properties.insert(section.key.to_owned(), of_section(section));
    }
    properties.insert("mapping".to_owned(), mapping::mapping(catalog));
    properties.insert("shaders".to_owned(), shaders(catalog));
    for section in SECTIONS.iter().skip(2) {
        properties.insert(section.key.to_owned(), of_section(section));
    }
    let mut definitions = param::definitions();
    definitions.insert("target".to_owned(), mapping::target(catalog));
    definitions.insert("selector".to_owned(), mapping::selector(catalog));
    for entry in catalog.shaders {
        definitions.insert(format!("{}_properties", entry.name), properties_of(entry));
    }
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "$id": ID,
        "title": "restyle style",
        "description": "How molecules and meshes are drawn. Everything is optional.",
        "allowComments": true,
        "allowTrailingCommas": true,
        "type": "object",
        "defaultSnippets": [snippets::whole_style()],
        "properties": properties,
        "additionalProperties": false,
        // An entry that changes one of a base takes the shader from there.
        "if": { "not": { "required": ["extends"] } },
        "then": { "properties": { "shaders": { "doNotSuggest": true, "items": { "required": ["shader"] } } } },
        "definitions": definitions,
    })
}

/// An object with the keys of a table and no others.
fn table(params: &[Param]) -> Value {
    let properties: Map<String, Value> = params.iter().map(|p| (p.name.to_owned(), param::param(p))).collect();
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

fn of_section(section: &Section) -> Value {
    let table = table(section.params);
    let mut schema = if section.is_list {
        let mut items = table;
        items["defaultSnippets"] = snippets::lights();
        json!({ "type": "array", "items": items })
    } else {
        table
    };
    schema["description"] = section.doc.into();
    schema
}

/// The list `shaders`.
fn shaders(catalog: &Catalog<'_>) -> Value {
    let names: Vec<&str> = catalog.names(None).collect();
    let docs: Vec<&str> = catalog.shaders.iter().map(|entry| entry.doc).collect();
    let mut by_shader: Vec<Value> = catalog.shaders.iter().map(for_shader).collect();
    // No shader of its own: whose properties they are, only the base knows.
    let described: Map<String, Value> = catalog
        .shaders
        .iter()
        .flat_map(|entry| entry.params)
        .map(|param| (param.name.to_owned(), json!({ "description": param.doc })))
        .collect();
    by_shader.push(json!({
        "if": { "not": { "required": ["shader"] } },
        "then": { "properties": { "properties": { "doNotSuggest": true, "properties": described } } },
    }));
    json!({
        "type": "array",
        "description": "Shaders with their properties, each under a name that mapping uses.",
        "items": {
            "type": "object",
            "defaultSnippets": snippets::shaders(catalog),
            "properties": {
                "name": { "type": "string", "description": "The name that mapping uses." },
                "shader": {
                    "type": "string",
                    "description": "What draws.",
                    "enum": names,
                    "enumDescriptions": docs,
                },
                "properties": { "type": "object", "description": "What differs from the shader's defaults." },
            },
            "additionalProperties": false,
            "required": ["name"],
            "allOf": by_shader,
        },
    })
}

/// Chooses the properties of an entry by its shader. A pattern and not a `const`: an editor would suggest that.
fn for_shader(entry: &CatalogEntry) -> Value {
    let properties = json!({ "$ref": format!("#/definitions/{}_properties", entry.name) });
    let shader = json!({ "doNotSuggest": true, "pattern": patterns::one_of([entry.name]) });
    json!({
        "if": { "properties": { "shader": shader }, "required": ["shader"] },
        "then": { "properties": { "properties": properties } },
    })
}

/// What `properties` of a shader may hold.
fn properties_of(entry: &CatalogEntry) -> Value {
    let mut schema = table(entry.params);
    schema["description"] = format!("What differs from the defaults of {}. {}", entry.name, entry.doc).into();
    schema
}
