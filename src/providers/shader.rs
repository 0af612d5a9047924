//! ShaderProvider: `mapping` and `shaders` of the style answer which shader, with its properties set, draws an object.
//!
//! It answers by object and by shader name [Prost2016 §3.2].

use crate::config::{Attribute, AttributeSet, ObjectKind, Style};

/// What selectors may ask of an object.
pub trait ObjectAttributes {
    /// The value of an attribute, if the object has it.
    fn attribute(&self, attribute: Attribute) -> Option<&str>;
}

/// Answers by object and by name; a material is an index into the style's shaders.
#[derive(Debug, Clone)]
pub struct ShaderProvider<'a> {
    style: &'a Style,
}

impl<'a> ShaderProvider<'a> {
    /// A provider for this style.
    pub fn new(style: &'a Style) -> ShaderProvider<'a> {
        ShaderProvider { style }
    }

    /// The material of an object; none where the style hides it.
    pub fn for_object(&self, kind: ObjectKind, object: &dyn ObjectAttributes) -> Option<usize> {
        self.style.shader_of(kind, &|attribute| object.attribute(attribute))
    }

    /// The material of a connector, which matches if either of its atoms does.
    pub fn for_connector(&self, a: &dyn ObjectAttributes, b: &dyn ObjectAttributes) -> Option<usize> {
        let kind = ObjectKind::Connector;
        let rule =
            self.style.mapping.iter().find(|rule| {
                [a, b].iter().any(|atom| rule.selector.matches(kind, &|attribute| atom.attribute(attribute)))
            });
        match rule {
            Some(rule) => rule.target,
            None => Some(self.style.basic),
        }
    }

    /// The material with this name in the style.
    pub fn by_name(&self, name: &str) -> Option<usize> {
        self.style.shaders.iter().position(|shader| shader.name == name)
    }

    /// Attributes on which the answer for this kind can depend at all.
    pub fn attributes_used(&self, kind: ObjectKind) -> AttributeSet {
        self.style.attributes_used(kind)
    }
}
