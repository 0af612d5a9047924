//! `ssaoPost`: darkens what has things near it; its parameters.
//!
//! Drawn by the reference renderer alone so far, by rays (`src/reference/occlusion.rs`).

use crate::config::param::Param;

/// The parameters of `ssaoPost`.
pub const PARAMS: &[Param] = &[
    Param::length("radius", "3r")
        .doc("How far away things count. As wide in every picture of the scene, whatever its size."),
    Param::number("intensity", 1.0)
        .range(0.0, 4.0)
        .doc("How much it darkens: 1 makes what is wholly enclosed black, 0 does nothing."),
];
