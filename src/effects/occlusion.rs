//! `ssaoPost`: darkens what has things near it, by what the picture shows of them.
//!
//! `gtao` and `bitmask` after [Jimenez2016, throughout] and [Therrien2023, throughout], `hemisphere` after [Prost2016 §4.2]; where we differ: see
//! `shaders/effects/occlusion.wgsl`. Its exact form, by rays: `src/reference/occlusion.rs`. Twin: `tests/twins/occlusion.rs`.

use super::{EffectAov, EffectContext, EffectPass, PassTarget, PostEffect};
use crate::config::param::{Param, Selector, Values};
use crate::gpu::{GpuStruct, StructInfo, Wgsl};
use crate::{gpu_struct, wgsl};

/// Values of `method`.
const METHODS: &[&str] = &["bitmask", "gtao", "hemisphere"];

/// Farthest place that a pixel looks at, in pixels. Ours: a bound on what tiles of large pictures have in common; larger radii
/// are looked through up to there.
pub const MAX_REACH_PX: f64 = 512.0;

/// Radii on the screen below this darken nothing that a pixel shows.
const LEAST_RADIUS_PX: f64 = 1.5;

/// The parameters of `ssaoPost`.
pub const PARAMS: &[Param] = &[
    Param::choice("method", METHODS, "bitmask")
        .doc("How it is found: by what is covered around each pixel, with thin things or as if all were solid, or by points as published.")
        .examples(&[r#""bitmask""#, r#""gtao""#, r#""hemisphere""#]),
    Param::length("radius", "3r")
        .doc("How far away things count, whatever the size of the picture.")
        .examples(&[r#""1r""#, r#""4r""#, r#""12r""#]),
    Param::number("intensity", 1.0)
        .range(0.0, 4.0)
        .doc("How much it darkens: 1 makes what is wholly enclosed black, 0 does nothing.")
        .examples(&["0.5", "1", "2"]),
    Param::count("samples", 16)
        .range(4.0, 256.0)
        .doc("Places that each pixel looks at: more are smoother and slower.")
        .examples(&["4", "16", "64"]),
    Param::count("blur", 4)
        .range(1.0, 8.0)
        .unit("pixels")
        .doc("Side of the square over which noise is evened out, twice as many in a frame of one sample; 1 leaves it.")
        .examples(&["1", "4", "8"]),
    Param::optional_selector(APPLIES_TO)
        .doc("What is darkened, all unless set; what is not still darkens what lies near it.")
        .examples(&[r#""atom""#, r#""*[kind=ligand]""#]),
];

/// The parameter that says what is darkened.
const APPLIES_TO: &str = "applies_to";

gpu_struct! {
    "effects/occlusion.wgsl",
    /// See `shaders/effects/occlusion.wgsl`.
    pub struct OcclusionParams {
        /// Scene units within which things count.
        pub radius: f32,
        /// Light is multiplied by 1 - intensity times occlusion.
        pub intensity: f32,
        /// Points around the surface.
        pub samples: u32,
        /// Slices through the line of sight.
        pub slices: u32,
        /// Taps to each side of a slice.
        pub steps: u32,
        /// Side of the square over which noise is evened out, in pixels.
        pub blur: u32,
        /// Farthest tap in pixels.
        pub reach_px: f32,
        /// The bit of what is picked.
        pub pick_bits: u32,
    }
}

/// How many slices, and taps to each side of one, come nearest to a number of taps in all: twice as many to a side as slices.
fn slices_and_steps(samples: u32) -> [u32; 2] {
    let slices = (f64::from(samples) / 4.0).sqrt().round().max(1.0);
    let steps = (f64::from(samples) / (2.0 * slices)).round().max(1.0);
    [slices as u32, steps as u32]
}

/// Farthest tap in pixels.
fn farthest_px(values: &Values, context: &EffectContext<'_>) -> f64 {
    ((context.world)(values.length("radius")) / context.least_pixel_world).min(MAX_REACH_PX)
}

/// The effect's registry entry.
pub struct AmbientOcclusion;

impl PostEffect for AmbientOcclusion {
    fn name(&self) -> &'static str {
        "ssaoPost"
    }
    fn file(&self) -> &'static str {
        "occlusion"
    }
    fn doc(&self) -> &'static str {
        "Darkens creases and contacts."
    }
    fn params(&self) -> &'static [Param] {
        PARAMS
    }
    fn wgsl(&self, _features: u32) -> &'static [Wgsl] {
        const FILES: &[Wgsl] = &[
            wgsl!("lib/noise.wgsl"),
            wgsl!("lib/texels.wgsl"),
            wgsl!("lib/picks.wgsl"),
            wgsl!("effects/occlusion.wgsl"),
        ];
        FILES
    }
    fn is_before_layers(&self) -> bool {
        true
    }
    fn params_info(&self) -> StructInfo {
        OcclusionParams::info()
    }
    fn uniform(&self, values: &Values, context: &EffectContext<'_>) -> Vec<u8> {
        let samples = values.count("samples");
        let [slices, steps] = slices_and_steps(samples);
        bytemuck::bytes_of(&OcclusionParams {
            radius: (context.world)(values.length("radius")) as f32,
            intensity: values.number("intensity") as f32,
            samples,
            slices,
            steps,
            blur: values.count("blur"),
            reach_px: farthest_px(values, context) as f32,
            pick_bits: context.pick_bits,
        })
        .to_vec()
    }
    fn picks<'a>(&self, values: &'a Values) -> Option<&'a Selector> {
        values.optional_selector(APPLIES_TO)
    }
    fn reach_px(&self, values: &Values, context: &EffectContext<'_>) -> u32 {
        farthest_px(values, context).ceil() as u32 + 2 * values.count("blur") + 2
    }
    fn passes(&self, features: u32) -> &'static [EffectPass] {
        const fn passes(stride: u32) -> [EffectPass; 2] {
            [
                EffectPass {
                    name: "occlusion",
                    entry: "estimate_occlusion",
                    target: PassTarget::Own { format: wgpu::TextureFormat::R32Float, pixels: [stride, stride] },
                },
                EffectPass { name: "occlusion_applied", entry: "apply_occlusion", target: PassTarget::Picture },
            ]
        }
        const EVERY: &[EffectPass] = &passes(1);
        const COARSE: &[EffectPass] = &passes(2);
        let is_on = |feature| features & bit(feature) != 0;
        if is_on(IS_COARSE) && !is_on(FINE) { COARSE } else { EVERY }
    }
    fn aov(&self, _features: u32) -> Option<EffectAov> {
        Some(EffectAov { name: "ao", entry: "occlusion_aov" })
    }
    fn changes_nothing(&self, values: &Values, context: &EffectContext<'_>) -> Option<&'static str> {
        if values.number("intensity") <= 0.0 {
            return Some("its intensity is 0");
        }
        if self.picks(values).is_some() && context.pick_bits == 0 {
            return Some("it applies to nothing in this scene");
        }
        (farthest_px(values, context) < LEAST_RADIUS_PX).then_some("its radius is less than 1.5 pixels anywhere")
    }
    fn features(&self) -> &'static [&'static str] {
        FEATURES
    }
    fn features_used(&self, values: &Values, context: &EffectContext<'_>) -> u32 {
        let method = values.choice("method");
        let is_horizons = method != "hemisphere";
        // A still of many samples sees each edge at many places; a single one is what a designer turns and waits for. Without a
        // mean to take, a square would show.
        let is_coarse = is_horizons && context.samples == 1 && values.count("blur") > 1;
        let is_used = |feature: &&str| match *feature {
            HORIZONS => is_horizons,
            THIN => method == "bitmask",
            PICKS => self.picks(values).is_some(),
            IS_COARSE => is_coarse,
            _ => false,
        };
        FEATURES.iter().filter(|feature| is_used(feature)).map(|feature| bit(feature)).sum()
    }
}

const FEATURES: &[&str] = &[HORIZONS, THIN, PUBLISHED, ROTATED, PICKS, IS_COARSE, FINE];
const HORIZONS: &str = "OCCLUSION_HORIZONS";
const THIN: &str = "OCCLUSION_THIN";
const PICKS: &str = "OCCLUSION_PICKS";
const IS_COARSE: &str = "OCCLUSION_COARSE";

/// The bit of a feature among [`FEATURES`].
fn bit(feature: &str) -> u32 {
    FEATURES.iter().position(|known| *known == feature).map_or(0, |place| 1 << place)
}

/// The form of `hemisphere` as published, for measurements: no style has this feature.
pub const PUBLISHED: &str = "OCCLUSION_PUBLISHED";
/// `hemisphere` with its points turned instead of mirrored, for measurements: no style has this feature.
pub const ROTATED: &str = "OCCLUSION_ROTATED";
/// Horizons found for every pixel of a frame of one sample, for measurements: no style has this feature.
pub const FINE: &str = "OCCLUSION_FINE";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn taps_are_as_many_as_asked_for() {
        for samples in 4..=256 {
            let [slices, steps] = slices_and_steps(samples);
            let taps = 2 * slices * steps;
            assert!(taps.abs_diff(samples) <= slices, "{samples}: {slices} slices of {steps} steps to a side");
        }
        assert_eq!([4, 16, 64, 256].map(slices_and_steps), [[1, 2], [2, 4], [4, 8], [8, 16]]);
    }
}
