//! `dofPost`: blurs what is out of focus; its parameters.
//!
//! Drawn by the reference renderer alone so far, by a thin lens (`src/reference/lens.rs`).

use crate::config::param::Param;

/// Values of `focus` beside lengths and selectors.
pub const FOCUS: &[&str] = &["layers", "center"];

/// The parameters of `dofPost`. After [Prost2016 §4.3].
pub const PARAMS: &[Param] = &[
    Param::numbers("layers", &[0.0, 0.0, 0.7, 0.9]).of_len(4).range(0.0, 1.0).not_drawn_yet().doc(
        "Depths from 0, the sphere's nearest point, to 1: sharp between the middle two, blurred beyond the others.",
    ),
    Param::place("focus", FOCUS, "layers")
        .not_drawn_yet()
        .doc("What is sharp: the middle of layers, the scene's center, what lies this far from the camera, or what is picked."),
    Param::length("blur", "16pt").not_drawn_yet().doc(
        "Width of the blur at the first or last of layers, whichever is farther from what is sharp; 0 blurs nothing.",
    ),
];
