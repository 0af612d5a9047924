//! The graphics device: opening it, shader text, uniform layouts, targets, read-back and timing.
//!
//! Depends on nothing of ours. Everything is headless: no surface, no window.

mod counters;
mod device;
mod kept;
pub mod layout;
mod readback;
mod timing;
mod wgsl;

pub use counters::Counters;
pub use device::{Gpu, GpuError};
pub use kept::{Bound, KeptBindGroup, KeptBuffer};
pub use layout::{Field, GpuStruct, StructInfo};
pub use readback::{read_texture, read_words};
pub use timing::{PassTimer, PassTimes};
pub use wgsl::{Module, ShaderEdits, Wgsl};
