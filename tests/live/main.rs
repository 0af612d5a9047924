//! What a change costs the device, and what hot reload does with files as editors write them.
//!
//! Without an adapter the tests pass and say so; with `RESTYLE_GPU=required` they fail.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop there")]

mod counters;
#[path = "../twins/gpu.rs"]
#[allow(dead_code, reason = "the twins use more of it")]
mod gpu;
mod reload;
mod rig;
mod storm;
