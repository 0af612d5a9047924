//! `transparency`: how fragments that let light through are put in order.

use super::param::Param;
use super::values::Values;

/// The keys of `transparency`.
pub const PARAMS: &[Param] = &[
    Param::choice("method", &["auto", "packed", "bkb"], "auto")
        .doc("auto takes the cheapest that is right for the scene, which is packed: all surfaces, sorted exactly. bkb is the bucketed k-buffer of Murray 2016: the k nearest of each pixel.")
        .examples(&[r#""packed""#, r#""bkb""#]),
    Param::count("k", 8)
        .range(1.0, 64.0)
        .unit("fragments")
        .doc("Most fragments that bkb keeps for each pixel, the nearest; packed keeps all.")
        .examples(&["1", "2", "8"]),
    Param::count("memory_mb", 512)
        .range(16.0, 65536.0)
        .unit("MB")
        .doc("Most memory that the fragments of what is transparent may take at once; a picture with more is drawn in bands, and is the same.")
        .examples(&["64", "512", "4096"]),
];

/// How fragments are put in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TransparencyMethod {
    /// What is cheapest and right for the scene.
    Auto,
    /// All fragments, sorted.
    Packed,
    /// Bucketed k-buffer.
    Bkb,
}

/// The transparency of a style.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transparency {
    /// How fragments are put in order.
    pub method: TransparencyMethod,
    /// Most fragments for each pixel.
    pub k: u32,
    /// Most memory for fragments, in MB.
    pub memory_mb: u32,
}

impl Transparency {
    /// The transparency that the values of [`PARAMS`] describe.
    pub fn new(values: &Values) -> Self {
        let methods = [TransparencyMethod::Auto, TransparencyMethod::Packed, TransparencyMethod::Bkb];
        Self {
            method: methods[values.choice_index("method")],
            k: values.count("k"),
            memory_mb: values.count("memory_mb"),
        }
    }
}
