//! Lights, resolved into view space. No JSON, no GPU.

use glam::Vec3;

/// What a light is and where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightPlace {
    /// Shines from everywhere in one direction: unit vector towards the light, view space.
    Directional(Vec3),
    /// Sits at a place in view space; ends at `range` scene units where that is above 0.
    Point {
        /// Place in view space.
        position_view: Vec3,
        /// End of the light in scene units; 0: no falloff.
        range: f32,
    },
}

/// The shadow that a light casts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shadow {
    /// Share of the light that it takes away, 0..1.
    pub strength: f32,
    /// The light's angular diameter in radians; 0 for a hard edge.
    pub softness_rad: f32,
}

/// One light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Kind and place.
    pub place: LightPlace,
    /// Linear colour times intensity.
    pub color: Vec3,
    /// Its shadow, if it casts one.
    pub shadow: Option<Shadow>,
}

/// All lights of a style.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Lighting {
    /// Directional and point lights.
    pub lights: Vec<Light>,
    /// Linear sum of the ambient lights.
    pub ambient: Vec3,
}
