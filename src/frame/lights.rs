//! The lights uniform.

use crate::gpu_struct;
use crate::scene::{LightPlace, Lighting};

/// Lights that one frame holds; `check` of a style names the limit.
pub const MAX_LIGHTS: usize = 8;

gpu_struct! {
    "lib/lights.wgsl",
    /// See `shaders/lib/lights.wgsl`.
    pub struct Light {
        /// Unit vector towards a directional light, or the place of a point light; view space.
        pub position_view: [f32; 3],
        /// 0 directional, 1 point.
        pub kind: u32,
        /// Linear colour times intensity.
        pub color: [f32; 3],
        /// End of a point light in scene units; 0: none.
        pub range: f32,
        /// Layer of the shadow maps; negative: none.
        pub shadow: i32,
        /// Share of the light that a shadow takes.
        pub strength: f32,
        /// Tangent of half the angular diameter; 0: hard.
        pub softness_tan: f32,
        /// Padding.
        pub _pad0: f32,
    }
}

gpu_struct! {
    "lib/lights.wgsl",
    /// See `shaders/lib/lights.wgsl`.
    pub struct Lights {
        /// Linear sum of the ambient lights.
        pub ambient: [f32; 3],
        /// Padding.
        pub _pad0: f32,
        /// The lights.
        pub items: [Light; MAX_LIGHTS],
    }
}

impl Lights {
    /// The uniform of a style's lights; `layers[i]` is the shadow layer of light `i`.
    pub fn new(lighting: &Lighting, layers: &[Option<u32>]) -> Lights {
        let mut lights: Lights = bytemuck::Zeroable::zeroed();
        lights.ambient = lighting.ambient.to_array();
        for (index, (slot, light)) in lights.items.iter_mut().zip(&lighting.lights).enumerate() {
            (slot.position_view, slot.kind, slot.range) = match light.place {
                LightPlace::Directional(toward) => (toward.to_array(), 0, 0.0),
                LightPlace::Point { position_view, range } => (position_view.to_array(), 1, range),
            };
            slot.color = light.color.to_array();
            slot.shadow = layers.get(index).copied().flatten().map_or(-1, |layer| layer as i32);
            if let Some(shadow) = light.shadow {
                slot.strength = shadow.strength;
                slot.softness_tan = (0.5 * shadow.softness_rad).tan();
            }
        }
        lights
    }
}
