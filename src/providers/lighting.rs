//! LightingProvider: `lights` of the style make lights in view space.

use glam::{DVec3, Vec3};

use super::Lengths;
use crate::config::{Light, LightKind, Shadow, Space};
use crate::scene::{self, Camera, LightPlace, Lighting, Sphere};

/// Answers which lights shine on a view of the scene.
#[derive(Debug, Clone)]
pub struct LightingProvider {
    lights: Vec<Light>,
    bounds: Sphere,
    lengths: Lengths,
}

impl LightingProvider {
    /// A provider for these lights and a scene of these bounds.
    pub fn new(lights: Vec<Light>, bounds: Sphere, lengths: Lengths) -> LightingProvider {
        LightingProvider { lights, bounds, lengths }
    }

    /// Directional and point lights of the style, in its order.
    pub fn num_lights(&self) -> usize {
        self.lights.iter().filter(|light| light.kind != LightKind::Ambient).count()
    }

    /// The lights as this camera sees them.
    pub fn lighting(&self, camera: &Camera) -> Lighting {
        let center = camera.view_from_world.transform_point3(self.bounds.center);
        let mut lighting = Lighting::default();
        for light in &self.lights {
            let [r, g, b, _] = light.color.to_linear();
            let color = Vec3::new(r, g, b) * light.intensity as f32;
            // Positions are radii from the sphere's centre, along the camera's or the scene's axes.
            let offset = DVec3::from_array(light.position).as_vec3();
            let offset = match light.space {
                Space::Camera => offset,
                Space::Scene => camera.view_from_world.transform_vector3(offset),
            };
            let place = match light.kind {
                LightKind::Ambient => {
                    lighting.ambient += color;
                    continue;
                }
                LightKind::Directional => LightPlace::Directional(offset.normalize_or(Vec3::Z)),
                LightKind::Point => LightPlace::Point {
                    position_view: center + offset * self.bounds.radius,
                    range: light.range.map_or(0.0, |range| self.lengths.world(range) as f32),
                },
            };
            let shadow = match light.shadow {
                Shadow::None => None,
                Shadow::Hard => Some(0.0),
                Shadow::Soft => Some(light.softness.to_radians() as f32),
            };
            let shadow = shadow.map(|softness_rad| scene::Shadow { strength: light.strength as f32, softness_rad });
            lighting.lights.push(scene::Light { place, color, shadow });
        }
        lighting
    }
}
