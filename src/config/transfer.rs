//! Transfer functions: the opacity and colour that a surface has by its curvature [Murray2016 §5.2].
//!
//! A style names a preset ([`presets`]), lists control points, or names a picture. Each of them becomes a table of one
//! size, and the straight lines between its nodes are the function: the reference renderer and the GPU hold the same
//! nodes. Curvature is -1 where a surface is most convex, 0 where it is flat and 1 where it is most concave.

use std::fmt;
use std::sync::Arc;

use serde_json::{Value as Json, json};

use super::hint::quote;

pub(super) mod picture;
pub(super) mod points;
pub mod presets;

pub use presets::Preset;

/// Nodes of an opacity, along the curvature without its sign and along the depth. Odd, so that the middle is a node, and
/// along the curvature as many as a colour has.
pub const OPACITY_SIZE: [usize; 2] = [65, 17];

/// Nodes of a colour along the curvature, from -1 to 1. Odd, so that a flat surface is a node.
pub const COLOR_SIZE: usize = 65;

/// Largest factor on a colour. Ours: twice as bright is white for most colours.
pub const MAX_FACTOR: f64 = 2.0;

/// Most control points of one list. Ours: as many as there are values of eight bits.
pub const MAX_POINTS: usize = 256;

/// Widest and highest picture that is read, in pixels. Ours: far more than there are nodes.
pub const MAX_PICTURE_SIDE_PX: u32 = 4096;

/// What a transfer function gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TransferKind {
    /// An opacity of 0 to 1, by the curvature without its sign and the depth.
    Opacity,
    /// A factor of 0 to [`MAX_FACTOR`] on red, green and blue in linear light, by the curvature.
    Color,
}

impl TransferKind {
    /// The presets by name.
    pub fn presets(self) -> &'static [Preset] {
        match self {
            Self::Opacity => presets::OPACITY,
            Self::Color => presets::COLOR,
        }
    }

    /// Lowest and highest curvature of a control point.
    pub const fn curvatures(self) -> (f64, f64) {
        match self {
            Self::Opacity => (0.0, 1.0),
            Self::Color => (-1.0, 1.0),
        }
    }

    /// Lowest and highest value of a control point.
    pub const fn values(self) -> (f64, f64) {
        match self {
            Self::Opacity => (0.0, 1.0),
            Self::Color => (0.0, MAX_FACTOR),
        }
    }

    /// How many numbers a control point of a style file has: few or many.
    pub const fn widths(self) -> [usize; 2] {
        match self {
            Self::Opacity => [2, 3],
            Self::Color => [2, 4],
        }
    }

    /// The ways to write a control point, in the order of [`TransferKind::widths`].
    const fn point_forms(self) -> [&'static str; 2] {
        match self {
            Self::Opacity => ["[curvature, opacity]", "[curvature, opacity near, opacity far]"],
            Self::Color => ["[curvature, factor]", "[curvature, red, green, blue]"],
        }
    }

    /// What a parameter may hold, for the manual and the editor, in Markdown.
    pub(super) fn facts(self) -> String {
        let [few, many] = self.point_forms();
        let (curvatures, picture) = match self {
            Self::Opacity => (
                "from 0 (flat) to 1 (most curved)",
                "flat at the left, near at the bottom, black for 0 and white for 1",
            ),
            Self::Color => (
                "from -1 (most convex) to 1 (most concave), with factors from 0 to 2 on linear light",
                "one row, convex at the left, black for a factor of 0 and white for one of 2",
            ),
        };
        format!(
            "the name of a preset, a list of 1 to {MAX_POINTS} points `{few}` or `{many}` in order of curvature, \
             {curvatures}, or the path of a PNG picture, such as `\"mine.png\"` beside the style: {picture}"
        )
    }

    /// The presets, each with its sentence, as a list in Markdown.
    pub(super) fn preset_facts(self) -> String {
        self.presets().iter().map(|preset| format!("\n- `\"{}\"`: {}", preset.name, preset.doc)).collect()
    }
}

/// How a style says what a transfer function is.
#[derive(Debug, Clone, PartialEq)]
pub enum Written {
    /// The name of a preset.
    Preset(&'static str),
    /// Control points, each a curvature and what the function gives there.
    Points(Arc<[Vec<f64>]>),
    /// The path of a picture.
    Picture(Arc<str>),
}

/// The values of a transfer function at its nodes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Nodes {
    /// One row for each depth, near first.
    Opacity(Arc<[f32]>),
    Color(Arc<[[f32; 3]]>),
}

/// A transfer function: how it is written, and what that comes to. Two are equal if both are, so that a picture that was
/// painted over makes another one.
#[derive(Debug, Clone, PartialEq)]
pub struct Transfer {
    written: Written,
    nodes: Nodes,
}

impl Transfer {
    pub(super) fn new(written: Written, nodes: Nodes) -> Self {
        Self { written, nodes }
    }

    /// A preset by its name.
    pub fn preset(kind: TransferKind, name: &str) -> Option<Self> {
        presets::find(kind, name).cloned()
    }

    /// How the style says it.
    pub fn written(&self) -> &Written {
        &self.written
    }

    /// What it gives.
    pub fn kind(&self) -> TransferKind {
        match self.nodes {
            Nodes::Opacity(_) => TransferKind::Opacity,
            Nodes::Color(_) => TransferKind::Color,
        }
    }

    /// Values at [`OPACITY_SIZE`] nodes: a row for each depth, near first, each from flat to most curved. Empty for a
    /// colour.
    pub fn opacity_nodes(&self) -> &[f32] {
        match &self.nodes {
            Nodes::Opacity(nodes) => nodes,
            Nodes::Color(_) => &[],
        }
    }

    /// Red, green and blue at [`COLOR_SIZE`] nodes, from most convex to most concave. Empty for an opacity.
    pub fn color_nodes(&self) -> &[[f32; 3]] {
        match &self.nodes {
            Nodes::Opacity(_) => &[],
            Nodes::Color(nodes) => nodes,
        }
    }

    /// The opacity at a curvature, whose sign does not matter, and a depth from 0, near, to 1, far. Beyond these it is
    /// that of the nearest end, and what is no number counts as 0. A transfer function of colour leaves the opacity at 1.
    pub fn opacity(&self, curvature: f64, depth: f64) -> f64 {
        let Nodes::Opacity(nodes) = &self.nodes else { return 1.0 };
        let [columns, rows] = OPACITY_SIZE;
        let (across, down) = (Between::new(or_zero(curvature).abs(), columns), Between::new(or_zero(depth), rows));
        let at = |row: usize| {
            let row = &nodes[row * columns..(row + 1) * columns];
            across.mix(f64::from(row[across.low]), f64::from(row[across.low + 1]))
        };
        down.mix(at(down.low), at(down.low + 1))
    }

    /// The factors on red, green and blue at a curvature. Beyond -1 and 1 they are those of the nearest end, and what is
    /// no number counts as 0. A transfer function of opacity leaves colours as they are, by factors of 1.
    pub fn color(&self, curvature: f64) -> [f64; 3] {
        let Nodes::Color(nodes) = &self.nodes else { return [1.0; 3] };
        let at = Between::new((or_zero(curvature) + 1.0) / 2.0, COLOR_SIZE);
        let (low, high) = (nodes[at.low], nodes[at.low + 1]);
        std::array::from_fn(|i| at.mix(f64::from(low[i]), f64::from(high[i])))
    }

    /// The value as a style file would hold it.
    pub(super) fn to_json(&self) -> Json {
        match &self.written {
            Written::Preset(name) => json!(name),
            Written::Points(points) => points.iter().cloned().collect(),
            Written::Picture(path) => json!(&**path),
        }
    }
}

impl fmt::Display for Transfer {
    /// The preset, the picture, or how many points there are.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.written {
            Written::Preset(name) => f.write_str(name),
            Written::Points(points) if points.len() == 1 => f.write_str("1 point"),
            Written::Points(points) => write!(f, "{} points", points.len()),
            Written::Picture(path) => f.write_str(&quote(path)),
        }
    }
}

/// A number, or 0 for what is none.
fn or_zero(number: f64) -> f64 {
    if number.is_nan() { 0.0 } else { number }
}

/// A place between two neighbours in a row of nodes or pixels.
#[derive(Debug, Clone, Copy)]
struct Between {
    /// The neighbour below; the one above follows it.
    low: usize,
    /// The share of the one above.
    share: f64,
}

impl Between {
    /// At `position` of 0 to 1 along `count` nodes, two or more, of which the first lies at 0 and the last at 1.
    fn new(position: f64, count: usize) -> Self {
        let at = position.clamp(0.0, 1.0) * (count - 1) as f64;
        let low = (at as usize).min(count - 2);
        Self { low, share: at - low as f64 }
    }

    fn mix(self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share
    }
}
