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
             {curvatures}, or the path of a PNG picture beside the style, such as `\"mine.png\"`: {picture}"
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

#[cfg(test)]
mod tests {
    use super::*;

    fn preset(kind: TransferKind, name: &str) -> Transfer {
        Transfer::preset(kind, name).unwrap()
    }

    #[test]
    fn tables_have_their_sizes() {
        let opacity = preset(TransferKind::Opacity, "fig7a");
        assert_eq!(opacity.opacity_nodes().len(), OPACITY_SIZE[0] * OPACITY_SIZE[1]);
        assert!(opacity.color_nodes().is_empty() && opacity.kind() == TransferKind::Opacity);
        let color = preset(TransferKind::Color, "fig6a");
        assert_eq!(color.color_nodes().len(), COLOR_SIZE);
        assert!(color.opacity_nodes().is_empty() && color.kind() == TransferKind::Color);
        assert_eq!((opacity.color(0.5), color.opacity(0.5, 0.5)), ([1.0; 3], 1.0));
    }

    #[test]
    fn nodes_are_the_function_and_straight_between() {
        let opacity = preset(TransferKind::Opacity, "fig7a");
        let [columns, rows] = OPACITY_SIZE;
        for (i, node) in opacity.opacity_nodes().iter().enumerate() {
            let (column, row) = (i % columns, i / columns);
            let (curvature, depth) = (column as f64 / (columns - 1) as f64, row as f64 / (rows - 1) as f64);
            assert_eq!(opacity.opacity(curvature, depth), f64::from(*node));
        }
        let color = preset(TransferKind::Color, "warm_cool");
        for (i, node) in color.color_nodes().iter().enumerate() {
            assert_eq!(color.color(i as f64 / 32.0 - 1.0), node.map(f64::from));
        }
        let (low, high) = (opacity.opacity(3.0 / 64.0, 0.0), opacity.opacity(4.0 / 64.0, 0.0));
        assert!((opacity.opacity(3.5 / 64.0, 0.0) - (low + high) / 2.0).abs() < 1e-12);
        let (near, far) = (opacity.opacity(0.5, 2.0 / 16.0), opacity.opacity(0.5, 3.0 / 16.0));
        assert!((opacity.opacity(0.5, 2.25 / 16.0) - (0.75 * near + 0.25 * far)).abs() < 1e-12);
    }

    #[test]
    fn ends_hold_beyond_and_no_number_is_flat_and_near() {
        let opacity = preset(TransferKind::Opacity, "fig7b");
        assert_eq!(opacity.opacity(-0.5, 0.25), opacity.opacity(0.5, 0.25));
        assert_eq!(opacity.opacity(-7.0, 9.0), opacity.opacity(1.0, 1.0));
        assert_eq!(opacity.opacity(f64::INFINITY, f64::NEG_INFINITY), opacity.opacity(1.0, 0.0));
        assert_eq!(opacity.opacity(f64::NAN, f64::NAN), opacity.opacity(0.0, 0.0));
        let color = preset(TransferKind::Color, "fig6a");
        assert_eq!((color.color(-7.0), color.color(f64::INFINITY)), (color.color(-1.0), color.color(1.0)));
        assert_eq!(color.color(f64::NAN), color.color(0.0));
    }

    #[test]
    fn presets_have_known_values() {
        let at = |name, curvature, depth| preset(TransferKind::Opacity, name).opacity(curvature, depth);
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} is not {b}");
        near(at("fig7a", 0.0, 0.0), 0.05);
        near(at("fig7a", 0.0, 0.25), 0.45);
        near(at("fig7a", 1.0, 0.0), 0.95);
        near(at("fig7b", 0.0, 0.5), 0.12);
        near(at("fig8d", 0.5, 0.5), 0.55);
        near(at("constant", 0.3, 0.7), 1.0);
        near(at("xray", 0.5, 0.9), 0.515);
        near(at("ghost", 0.0, 0.5), 0.15);
        // Far is more opaque than near in the paper's first two, and less in the last one.
        for step in 0..=64 {
            let curvature = f64::from(step) / 64.0;
            for (name, sign) in [("fig7a", 1.0), ("fig7b", 1.0), ("fig8d", -1.0)] {
                assert!(sign * (at(name, curvature, 1.0) - at(name, curvature, 0.0)) > 0.0, "{name} at {curvature}");
            }
        }
        let color = |name, curvature| preset(TransferKind::Color, name).color(curvature);
        near(color("fig6a", -1.0)[0], 1.6);
        near(color("fig6a", 0.5)[2], 0.65);
        near(color("fig6b", 0.0)[1], 0.5);
        near(color("warm_cool", 1.0)[2], 1.1);
        assert_eq!(color("none", 0.4), [1.0; 3]);
        assert_eq!(color("ink", 0.0), [1.0; 3]);
    }
}
