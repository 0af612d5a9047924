//! `curvature`: transparency that follows the curvature of surfaces, so that what is flat clears away and rims stay
//! [Murray2016 §5].
//!
//! Another shader lights the surfaces. Where this differs from the paper: see `shaders/objects/curvature.wgsl`. Twin:
//! `tests/twins/curvature.rs` and `neighbours.rs`.

use super::{BASE_COLOR, MaterialContext, OPACITY, ObjectShader, basic, toon};
pub use crate::config::param::Transfer;
use crate::config::param::{COLOR_SIZE, OPACITY_SIZE, Param, Values};
use crate::gpu::{GpuStruct, StructInfo, Wgsl};
use crate::{gpu_struct, wgsl};

/// Shaders that may light the surfaces.
const SHADING: &[&str] = &["basic", "toon", "unlit"];

/// Where curvature comes from.
const SOURCES: &[&str] = &["auto", "surface", "screen"];

/// The feature of curvature from neighbouring pixels.
const OF_SCREEN: u32 = 1 << 1;

/// The parameters of `curvature`.
pub const PARAMS: &[Param] = &[
    BASE_COLOR,
    OPACITY,
    Param::opacity_transfer("opacity_transfer", "fig7a")
        .doc("How much of what is behind a surface covers, by the size of its curvature and its depth.")
        .examples(&[r#""glass""#, r#""fig7a""#, r#""fig7b""#, "[[0, 0.05, 0.4], [1, 0.9, 0.9]]"]),
    Param::color_transfer("color_transfer", "fig6a")
        .doc("Factor on the light of a surface, by its curvature.")
        .examples(&[r#""none""#, r#""fig6a""#, r#""ink""#]),
    Param::number("gain", 1.0)
        .range(0.0, 1000.0)
        .doc("How strongly curvature counts; at 1, nine tenths of what is curved at all count less than 0.9.")
        .examples(&["0.2", "1", "5"]),
    Param::choice("curvature_source", SOURCES, "auto")
        .doc("Whether curvature is that of the surface itself or found from what neighbouring pixels see; auto takes the surface's. With bkb it is always found from neighbouring pixels.")
        .examples(&[r#""surface""#, r#""screen""#]),
    Param::numbers("depth_range", &[0.0, 1.0])
        .of_len(2)
        .ascending()
        .range(0.0, 1.0)
        .doc("Depths between which the transfer function lies: 0 is the nearest point of the scene's sphere, 1 the farthest.")
        .examples(&["[0, 1]", "[0, 0.5]"]),
    Param::number("contour", 1.0)
        .range(0.0, 1.0)
        .doc("Curvature that silhouettes and creases count as.")
        .examples(&["0", "0.5", "1"]),
    Param::length("contour_width", "1.5pt")
        .doc("Width of silhouettes and creases; 0 draws none.")
        .examples(&[r#""0pt""#, r#""1.5pt""#, r#""12pt""#]),
    Param::number("contour_emphasis", 0.0)
        .range(0.0, 1.0)
        .doc("How much of the curvature is that of the picture, which grows towards silhouettes.")
        .examples(&["0", "1"]),
    Param::choice("shading", SHADING, "basic")
        .doc("The shader that lights the surfaces; the parameters below are its own.")
        .examples(&[r#""basic""#, r#""toon""#, r#""unlit""#]),
    basic::SMOOTHNESS,
    basic::METALLIC,
    toon::SCALE,
    toon::BIAS,
    toon::STEPS,
    toon::LEVELS,
    toon::SHADOW_COLOR,
];

gpu_struct! {
    "objects/curvature.wgsl",
    /// See `shaders/objects/curvature.wgsl`.
    pub struct CurvatureMaterial {
        /// Of the scene's sphere, in world space.
        pub center_world: [f32; 3],
        /// Its radius.
        pub radius: f32,
        /// Curvature is read as tanh(gain * kappa).
        pub gain: f32,
        /// What curvature rims count as, 0..1.
        pub contour: f32,
        /// Their width in pixels.
        pub contour_px: f32,
        /// Their width in scene units, added.
        pub contour_world: f32,
        /// Share of the picture's curvature, 0..1.
        pub emphasis: f32,
        /// Where the transfer function begins, in 0..1 of the scene's sphere.
        pub depth_start: f32,
        /// One over its depth.
        pub depth_scale: f32,
        /// Factor on the opacity.
        pub opacity: f32,
        /// First texel of its transfer functions.
        pub table: u32,
        /// 1 where curvature is found from neighbouring pixels.
        pub from_screen: u32,
        /// Padding.
        pub _pad1: u32,
        /// Padding.
        pub _pad2: u32,
    }
}

/// Texels of the transfer functions as `shaders/lib/transfer.wgsl` reads them: the four corners of each cell, then colours.
pub fn texels(opacity: &Transfer, color: &Transfer) -> Vec<[f32; 4]> {
    let nodes = opacity.opacity_nodes();
    let [width, height] = OPACITY_SIZE;
    let node = |x: usize, y: usize| nodes[y * width + x];
    let cells = (0..height - 1).flat_map(|y| (0..width - 1).map(move |x| (x, y)));
    let mut texels: Vec<[f32; 4]> =
        cells.map(|(x, y)| [node(x, y), node(x + 1, y), node(x, y + 1), node(x + 1, y + 1)]).collect();
    texels.extend(color.color_nodes().iter().take(COLOR_SIZE).map(|[r, g, b]| [*r, *g, *b, 0.0]));
    texels
}

fn is_of_screen(values: &Values) -> bool {
    values.choice("curvature_source") == "screen"
}

/// The shader's registry entry.
pub struct Curvature;

impl ObjectShader for Curvature {
    fn name(&self) -> &'static str {
        "curvature"
    }
    fn doc(&self) -> &'static str {
        "Glass that is clearer where the surface is flat."
    }
    fn params(&self) -> &'static [Param] {
        PARAMS
    }
    fn wgsl(&self) -> &'static [Wgsl] {
        const FILES: &[Wgsl] = &[wgsl!("lib/transfer.wgsl"), wgsl!("objects/curvature.wgsl")];
        FILES
    }
    fn material_info(&self) -> StructInfo {
        CurvatureMaterial::info()
    }
    fn material(&self, values: &Values, context: &MaterialContext<'_>) -> Vec<u8> {
        let (contour_px, contour_world) = (context.screen)(values.length("contour_width"));
        let &[start, end] = values.numbers("depth_range") else { return Vec::new() };
        let radius = f64::from(context.bounds.radius).max(f64::from(f32::MIN_POSITIVE));
        bytemuck::bytes_of(&CurvatureMaterial {
            center_world: context.bounds.center.to_array(),
            radius: radius as f32,
            gain: (values.number("gain") * f64::from(context.gain) * radius) as f32,
            contour: values.number("contour") as f32,
            contour_px: contour_px as f32,
            contour_world: contour_world as f32,
            emphasis: values.number("contour_emphasis") as f32,
            depth_start: start as f32,
            depth_scale: (1.0 / (end - start).max(1e-6)) as f32,
            opacity: values.number(OPACITY.name) as f32,
            table: context.table,
            from_screen: u32::from(is_of_screen(values)),
            _pad1: 0,
            _pad2: 0,
        })
        .to_vec()
    }
    fn features(&self) -> &'static [&'static str] {
        &["CURVATURE_EMPHASIS", "CURVATURE_SCREEN"]
    }
    fn features_used(&self, values: &Values) -> u32 {
        u32::from(values.number("contour_emphasis") > 0.0) | if is_of_screen(values) { OF_SCREEN } else { 0 }
    }
    fn asks_neighbours(&self, features: u32) -> bool {
        features & OF_SCREEN != 0
    }
    fn lit_by(&self, values: &Values) -> Option<&'static str> {
        Some(values.choice("shading"))
    }
    fn stylises(&self) -> bool {
        true
    }
    fn is_layered(&self, _values: &Values) -> bool {
        true
    }
    fn tables(&self, values: &Values) -> Vec<[f32; 4]> {
        texels(values.transfer("opacity_transfer"), values.transfer("color_transfer"))
    }
    fn tables_name(&self) -> Option<&'static str> {
        Some("curvature_tables")
    }
}
