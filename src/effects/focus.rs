//! `dofPost`: blurs what is out of focus; its parameters.
//!
//! Drawn by the reference renderer alone so far, by a thin lens (`src/reference/lens.rs`).

use crate::config::param::Param;

/// Values of `focus` beside lengths.
pub const FOCUS: &[&str] = &["layers", "center"];

/// The parameters of `dofPost`.
pub const PARAMS: &[Param] = &[
    Param::numbers("layers", &[0.0, 0.0, 0.7, 0.9])
        .of_len(4)
        .range(0.0, 1.0)
        .doc("Depths from 0, the nearest point of the scene's sphere, to 1: before the first and behind the last all is blurred, between the middle two all is sharp [Prost2016 \u{a7}4.3]."),
    Param::choice_or_length("focus", FOCUS, "layers")
        .doc("What is sharp: the middle of `layers`, the scene's center, or what lies this far from the camera."),
    Param::length("blur", "16pt").doc("Width of the blur at the first or last of `layers`, whichever is farther from what is sharp; 0 blurs nothing."),
];
