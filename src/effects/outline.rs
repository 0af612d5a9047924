//! `outlinePost`: lines of one width where depth jumps, where groups meet and where surfaces fold, found in the picture.
//!
//! After the contour, subunit and residue lines of [Goodsell2019, throughout]; how edges are placed within pixels and widened is ours:
//! see `shaders/effects/outline.wgsl`. Twin: `tests/twins/outline.rs`.

use super::{EffectContext, EffectPass, PassTarget, PostEffect};
use crate::config::param::{Length, Param, Srgba, Values};
use crate::gpu::{GpuStruct, StructInfo, Wgsl};
use crate::{gpu_struct, wgsl};

/// Values of `boundary`, each with the bits of a group word that it compares; the last compares ids.
const BOUNDARIES: &[&str] = &["chain", "residue", "object"];

/// Widest line in pixels. Ours: 1/15 of the height of a picture of 4000 pixels, and a bound on what a pixel looks through.
pub const MAX_WIDTH_PX: f64 = 256.0;

/// The parameters of `outlinePost`.
pub const PARAMS: &[Param] = &[
    Param::length("silhouette_width", "2pt")
        .doc("Width of the line around what lies in front of something; 0 draws none. It lies on what is behind.")
        .examples(&[r#""0pt""#, r#""2pt""#, r#""8pt""#]),
    Param::color("silhouette_color", [0, 0, 0])
        .doc("Colour of that line; an alpha below 255 lets the picture through.")
        .examples(&[r##""#000000""##, r##""#8a1c1c""##, "[0, 0, 0, 110]"]),
    Param::length("depth_step", "0.5r")
        .doc("How far behind something must lie to get that line; a larger step leaves the lines of larger groups.")
        .examples(&[r#""0r""#, r#""2r""#, r#""6r""#]),
    Param::length("boundary_width", "2pt")
        .doc("Width of the line between groups, also where they touch; 0 draws none.")
        .examples(&[r#""0pt""#, r#""2pt""#, r#""6pt""#]),
    Param::color("boundary_color", [0, 0, 0]).doc("Colour of that line.").examples(&[
        r##""#000000""##,
        r#""white""#,
        "[0, 0, 0, 110]",
    ]),
    Param::choice("boundary", BOUNDARIES, "chain")
        .doc("What a group is: a chain or a part of a mesh, also a residue, or every atom, connector and part by itself.")
        .examples(&[r#""chain""#, r#""residue""#, r#""object""#]),
    Param::length("crease_width", "0pt")
        .doc("Width of the line along folds and where surfaces meet at an angle; 0 draws none.")
        .examples(&[r#""0pt""#, r#""2pt""#, r#""6pt""#]),
    Param::color("crease_color", [0, 0, 0]).doc("Colour of that line.").examples(&[
        r##""#000000""##,
        r#""white""#,
        "[0, 0, 0, 110]",
    ]),
    Param::number("crease_angle", 40.0)
        .range(1.0, 180.0)
        .unit("degrees")
        .doc("Angle between the surfaces from which on that line is drawn.")
        .examples(&["40", "100"]),
];

gpu_struct! {
    "effects/outline.wgsl",
    /// See `shaders/effects/outline.wgsl`.
    pub struct OutlineParams {
        /// Linear RGB and opacity.
        pub crease_color: [f32; 4],
        /// Linear RGB and opacity.
        pub boundary_color: [f32; 4],
        /// Linear RGB and opacity.
        pub silhouette_color: [f32; 4],
        /// Widths of crease, boundary and silhouette in pixels.
        pub width_px: [f32; 3],
        /// Cosine of the crease angle.
        pub crease_cosine: f32,
        /// The same widths in scene units, added.
        pub width_world: [f32; 3],
        /// Least step of depth of a silhouette in scene units.
        pub depth_step: f32,
        /// Width of the widest line in pixels.
        pub reach_px: f32,
        /// Bits of a group word that differ between groups.
        pub group_mask: u32,
        /// 1 where every object is a group of its own.
        pub by_object: u32,
        /// Padding.
        pub _pad0: u32,
    }
}

/// Width of the widest line in pixels.
fn widest_px(values: &Values, context: &EffectContext<'_>) -> f64 {
    let widths = WIDTHS.map(|name| (context.screen)(values.length(name)));
    let widest = widths.map(|(px, world)| px + world / context.least_pixel_world).into_iter().fold(0.0, f64::max);
    widest.min(MAX_WIDTH_PX)
}

/// Pixels in a word of the map of seeds.
const WORD_PX: u32 = 32;

/// The effect's registry entry.
pub struct Outline;

impl PostEffect for Outline {
    fn name(&self) -> &'static str {
        "outlinePost"
    }
    fn file(&self) -> &'static str {
        "outline"
    }
    fn doc(&self) -> &'static str {
        "Lines around what lies in front, between groups, and along folds, of one width everywhere."
    }
    fn params(&self) -> &'static [Param] {
        PARAMS
    }
    fn wgsl(&self, _features: u32) -> &'static [Wgsl] {
        const FILES: &[Wgsl] = &[wgsl!("effects/outline.wgsl")];
        FILES
    }
    fn params_info(&self) -> StructInfo {
        OutlineParams::info()
    }
    fn uniform(&self, values: &Values, context: &EffectContext<'_>) -> Vec<u8> {
        let widths = WIDTHS.map(|name| (context.screen)(values.length(name)));
        let boundary = values.choice("boundary");
        bytemuck::bytes_of(&OutlineParams {
            crease_color: linear(values.color("crease_color")),
            boundary_color: linear(values.color("boundary_color")),
            silhouette_color: linear(values.color("silhouette_color")),
            width_px: widths.map(|(px, _)| px as f32),
            crease_cosine: values.number("crease_angle").to_radians().cos() as f32,
            width_world: widths.map(|(_, world)| world as f32),
            depth_step: (context.world)(values.length("depth_step")) as f32,
            reach_px: widest_px(values, context) as f32,
            group_mask: if boundary == "chain" { CHAIN_MASK } else { u32::MAX },
            by_object: u32::from(boundary == "object"),
            _pad0: 0,
        })
        .to_vec()
    }
    fn reach_px(&self, values: &Values, context: &EffectContext<'_>) -> u32 {
        // Seeds lie between a pixel and the next one, whose colour is taken at their borders.
        widest_px(values, context).ceil() as u32 + 3
    }
    fn passes(&self, _features: u32) -> &'static [EffectPass] {
        const fn own(format: wgpu::TextureFormat, pixels: [u32; 2]) -> PassTarget {
            PassTarget::Own { format, pixels }
        }
        use wgpu::TextureFormat::{Rg32Uint, Rgba32Uint};
        const PASSES: &[EffectPass] = &[
            EffectPass { name: "outline_seeds", entry: "find_seeds", target: own(Rgba32Uint, [1, 1]) },
            EffectPass { name: "outline_words", entry: "gather_words", target: own(Rg32Uint, [WORD_PX, 1]) },
            EffectPass { name: "outline_beside", entry: "spread_beside", target: own(Rg32Uint, [WORD_PX, 1]) },
            EffectPass { name: "outline_around", entry: "spread_around", target: own(Rg32Uint, [WORD_PX, 1]) },
            EffectPass { name: "outline", entry: "draw_lines", target: PassTarget::Picture },
        ];
        PASSES
    }
    fn surfaces_entry(&self) -> Option<&'static str> {
        Some("draw_lines_as_surfaces")
    }
    fn changes_nothing(&self, values: &Values, _: &EffectContext<'_>) -> Option<&'static str> {
        let is_any = WIDTHS.iter().any(|name| is_drawn(values.length(name)));
        (!is_any).then_some("its lines have no width")
    }
    fn features(&self) -> &'static [&'static str] {
        &["OUTLINE_CREASES", "OUTLINE_BOUNDARIES", "OUTLINE_SILHOUETTES", "OUTLINE_WORLD_WIDTHS"]
    }
    fn features_used(&self, values: &Values, _context: &EffectContext<'_>) -> u32 {
        let in_points = |length| matches!(length, Length::Points(_)) || !is_drawn(length);
        let world = !WIDTHS.iter().all(|name| in_points(values.length(name)));
        let drawn = WIDTHS.map(|name| is_drawn(values.length(name)));
        drawn.into_iter().chain([world]).enumerate().map(|(bit, used)| u32::from(used) << bit).sum()
    }
}

/// The widths, in the order of the kinds' bits in a seed: later ones lie over earlier ones.
const WIDTHS: [&str; 3] = ["crease_width", "boundary_width", "silhouette_width"];

fn is_drawn(width: Length) -> bool {
    width.number() > 0.0
}

/// Linear RGB and opacity.
fn linear(color: Srgba) -> [f32; 4] {
    color.to_linear()
}

/// Bits of a residue in a group word; those above it are of the chain.
const RESIDUE_BITS: u32 = 9;
/// Bits of a chain.
const CHAIN_MASK: u32 = 0x7f << RESIDUE_BITS;

/// The group word of an atom, of 16 bits: chain and residue, enough of both to tell neighbours apart.
pub const fn group_word(chain: u32, residue: u32) -> u32 {
    (chain << RESIDUE_BITS & CHAIN_MASK) | (residue & ((1 << RESIDUE_BITS) - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::Depths;

    #[test]
    fn a_group_word_tells_neighbours_apart() {
        assert_ne!(group_word(0, 7), group_word(0, 8));
        assert_ne!(group_word(0, 7) & CHAIN_MASK, group_word(1, 8) & CHAIN_MASK);
        assert_eq!(group_word(3, 7) & CHAIN_MASK, group_word(3, 8) & CHAIN_MASK);
        assert!(group_word(u32::MAX, u32::MAX) <= 0xffff);
    }

    #[test]
    fn lines_without_width_are_left_out() {
        let values = Values::defaults(PARAMS);
        let depths = Depths { orthographic: false, near: 1.0, middle: 2.0, radius: 1.0, pixel_world: 1.0 };
        let context = EffectContext {
            screen: &|_| (0.0, 0.0),
            world: &|_| 0.0,
            least_pixel_world: 1.0,
            depths,
            samples: 1,
            looked_at: None,
            pick_bits: 0,
        };
        assert_eq!(Outline.changes_nothing(&values, &context), None);
        assert_eq!(Outline.features_used(&values, &context), 0b110);
    }
}
