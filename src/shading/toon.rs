//! `toon`: light in a few flat bands with two kinds of outline [Prost2016 §4.1], and the shadow and highlight colours
//! of [Livny2007 §3.1].
//!
//! Where we differ from the paper: see `shaders/objects/toon.wgsl`. Twin: `tests/twins/toon.rs`.

use super::{BASE_COLOR, Hull, MaterialContext, OPACITY, ObjectShader, linear, optional_linear};
use crate::config::param::{Param, Values};
use crate::gpu::{GpuStruct, StructInfo, Wgsl};
use crate::{gpu_struct, wgsl};

/// Values of `levels`, in the order of their numbers on the GPU.
const LEVEL_WORDS: &[&str] = &["floor", "centre", "full"];

/// The parameters of `toon`.
pub const PARAMS: &[Param] = &[
    BASE_COLOR,
    OPACITY,
    Param::color("color", [0, 0, 0]).doc("Colour of both outlines.").examples(&[
        r##""#000000""##,
        r##""#8a1c1c""##,
        r#""white""#,
    ]),
    Param::length("hull_size", "0pt").doc("Width of the outline around the object; 0 draws none.").examples(&[
        r#""0pt""#,
        r#""12pt""#,
        r#""36pt""#,
    ]),
    Param::number("outline_bias", 0.0)
        .range(0.0, 1.0)
        .doc("Cosine between surface and view below which the surface itself turns into outline; 0 draws none.")
        .examples(&["0", "0.35", "0.6"]),
    SCALE,
    BIAS,
    Param::number("exponent", 1.0)
        .range(0.01, 100.0)
        .doc("Moves the borders between the bands (gamma).")
        .examples(&["0.4", "1", "3"]),
    STEPS,
    LEVELS,
    SHADOW_COLOR,
    Param::optional_color("specular_color").doc("Colour of a flat highlight; unset, there is none.").examples(&[
        "null",
        r#""white""#,
        r##""#ffd27f""##,
    ]),
    Param::number("specular_limit", 0.95)
        .range(-1.0, 1.0)
        .doc("Cosine between mirrored light and view above which the highlight is drawn.")
        .examples(&["0.7", "0.9", "0.98"]),
];

/// `scale`.
pub const SCALE: Param = Param::number("scale", 0.5)
    .range(0.0, 10.0)
    .doc("Weight of the cosine between surface and light (alpha).")
    .examples(&["0.1", "0.5", "1"]);

/// `bias`.
pub const BIAS: Param = Param::number("bias", 0.5)
    .range(0.0, 10.0)
    .doc("Light that is there without the cosine (beta).")
    .examples(&["0.1", "0.5", "0.9"]);

/// `steps`.
pub const STEPS: Param =
    Param::count("steps", 4).range(1.0, 256.0).doc("How many bands; 1 is flat.").examples(&["1", "2", "4", "8"]);

/// `levels`.
pub const LEVELS: Param = Param::choice("levels", LEVEL_WORDS, "floor")
    .doc("Brightness of a band: of its darker border as published, its centre, or spread from black to full.")
    .examples(&[r#""floor""#, r#""centre""#, r#""full""#]);

/// `shadow_color`.
pub const SHADOW_COLOR: Param = Param::optional_color("shadow_color")
    .doc("Multiplies the colour where no light is; unset, what is unlit turns black.")
    .examples(&["null", r##""#3b3a66""##, "[150, 70, 40]"]);

gpu_struct! {
    "objects/toon.wgsl",
    /// See `shaders/objects/toon.wgsl`.
    pub struct ToonMaterial {
        /// Linear RGB of the outline.
        pub color: [f32; 4],
        /// Linear RGB of the unlit end; alpha 0: black.
        pub shadow_color: [f32; 4],
        /// Linear RGB of the highlight; alpha 0: none.
        pub specular_color: [f32; 4],
        /// Alpha of Eq. 1.
        pub scale: f32,
        /// Beta of Eq. 1.
        pub bias: f32,
        /// Gamma of Eq. 1.
        pub exponent: f32,
        /// s of Eq. 2.
        pub steps: f32,
        /// Threshold of the dot-product outline.
        pub outline_bias: f32,
        /// Threshold of the highlight.
        pub specular_limit: f32,
        /// 0 floor, 1 centre, 2 full.
        pub levels: u32,
        /// (scale + bias)^exponent.
        pub top: f32,
    }
}

/// The shader's registry entry.
pub struct Toon;

impl ObjectShader for Toon {
    fn name(&self) -> &'static str {
        "toon"
    }
    fn doc(&self) -> &'static str {
        "Comic shading: flat bands of light, outlines by hull or by dot product."
    }
    fn params(&self) -> &'static [Param] {
        PARAMS
    }
    fn wgsl(&self) -> &'static [Wgsl] {
        const FILES: &[Wgsl] = &[wgsl!("objects/toon.wgsl")];
        FILES
    }
    fn material_info(&self) -> StructInfo {
        ToonMaterial::info()
    }
    fn material(&self, values: &Values, _context: &MaterialContext<'_>) -> Vec<u8> {
        bytemuck::bytes_of(&ToonMaterial {
            color: linear(values.color("color")).extend(1.0).to_array(),
            shadow_color: optional_linear(values.optional_color("shadow_color")),
            specular_color: optional_linear(values.optional_color("specular_color")),
            scale: values.number("scale") as f32,
            bias: values.number("bias") as f32,
            exponent: values.number("exponent") as f32,
            steps: values.count("steps") as f32,
            outline_bias: values.number("outline_bias") as f32,
            specular_limit: values.number("specular_limit") as f32,
            levels: LEVEL_WORDS.iter().position(|level| *level == values.choice("levels")).unwrap_or(0) as u32,
            top: (values.number("scale") + values.number("bias")).powf(values.number("exponent")) as f32,
        })
        .to_vec()
    }
    fn features(&self) -> &'static [&'static str] {
        &["TOON_EXPONENT", "TOON_SPECULAR", "TOON_OUTLINE"]
    }
    fn features_used(&self, values: &Values) -> u32 {
        let used = [
            values.number("exponent") != 1.0,
            values.optional_color("specular_color").is_some(),
            values.number("outline_bias") > 0.0,
        ];
        used.iter().enumerate().map(|(bit, used)| u32::from(*used) << bit).sum()
    }
    fn hull(&self, values: &Values) -> Option<Hull> {
        let width = values.length("hull_size");
        (width.number() > 0.0).then(|| Hull { color: linear(values.color("color")), width })
    }
}
