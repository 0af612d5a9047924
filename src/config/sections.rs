//! The parts of a style that one table of parameters describes.

use super::param::Param;
use super::{camera, geometry, light, transparency};

/// A key of a style whose value a table describes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// The key at the top of a style.
    pub key: &'static str,
    /// One or two sentences for the manual, the schema and the editor.
    pub doc: &'static str,
    /// Its parameters; of `lights`, those of one light.
    pub params: &'static [Param],
    /// Whether the key holds a list of such objects.
    pub is_list: bool,
}

/// All of them, in the order of the manual.
pub const SECTIONS: [Section; 4] = [
    Section {
        key: "camera",
        doc: "Projection, background and framing. Without a position, the camera looks along -z with +y up and frames \
              the whole scene.",
        params: camera::PARAMS,
        is_list: false,
    },
    Section { key: "geometry", doc: "How large atoms and bonds are drawn.", params: geometry::PARAMS, is_list: false },
    Section {
        key: "lights",
        doc: "What shines on the scene. Without this list there is one white key light and soft light from everywhere; \
              an empty list leaves the scene dark.",
        params: light::PARAMS,
        is_list: true,
    },
    Section {
        key: "transparency",
        doc: "How fragments that let light through are put in order.",
        params: transparency::PARAMS,
        is_list: false,
    },
];
