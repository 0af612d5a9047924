//! `unlit`: the base colour exactly as it was written, for flat graphics and for masks.
//!
//! Twin: `tests/twins/unlit.rs`.

use super::{BASE_COLOR, MaterialContext, OPACITY, ObjectShader};
use crate::config::param::{Param, Values};
use crate::gpu::{GpuStruct, StructInfo, Wgsl};
use crate::{gpu_struct, wgsl};

/// The parameters of `unlit`.
pub const PARAMS: &[Param] = &[BASE_COLOR, OPACITY];

gpu_struct! {
    "objects/unlit.wgsl",
    /// See `shaders/objects/unlit.wgsl`.
    pub struct UnlitMaterial {
        /// Padding: colour and opacity are in what all shaders share.
        pub _pad0: f32,
        /// Padding.
        pub _pad1: f32,
        /// Padding.
        pub _pad2: f32,
        /// Padding.
        pub _pad3: f32,
    }
}

/// The shader's registry entry.
pub struct Unlit;

impl ObjectShader for Unlit {
    fn name(&self) -> &'static str {
        "unlit"
    }
    fn doc(&self) -> &'static str {
        "The base colour as it was written, without any light."
    }
    fn params(&self) -> &'static [Param] {
        PARAMS
    }
    fn wgsl(&self) -> &'static [Wgsl] {
        const FILES: &[Wgsl] = &[wgsl!("objects/unlit.wgsl")];
        FILES
    }
    fn material_info(&self) -> StructInfo {
        UnlitMaterial::info()
    }
    fn material(&self, _values: &Values, _context: &MaterialContext<'_>) -> Vec<u8> {
        let material = UnlitMaterial { _pad0: 0.0, _pad1: 0.0, _pad2: 0.0, _pad3: 0.0 };
        bytemuck::bytes_of(&material).to_vec()
    }
}
