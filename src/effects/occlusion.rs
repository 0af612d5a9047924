//! `ssaoPost`: darkens what has things near it; its parameters.
//!
//! Drawn by the reference renderer alone so far, by rays (`src/reference/occlusion.rs`).

use crate::config::param::Param;

/// The parameters of `ssaoPost`.
pub const PARAMS: &[Param] = &[
    Param::length("radius", "3r").not_drawn_yet().doc("How far away things count, whatever the size of the picture."),
    Param::number("intensity", 1.0)
        .range(0.0, 4.0)
        .not_drawn_yet()
        .doc("How much it darkens: 1 makes what is wholly enclosed black, 0 does nothing."),
];
