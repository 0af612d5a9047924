//! What arrives of each light at a point, by shadow rays.

use glam::DVec3;

use super::primitive::Ray;
use super::sampling::{disc_point, spread};
use super::world::{Object, Surface, World};
use crate::scene::{Light, LightPlace};

/// Light that arrives.
#[derive(Debug, Clone, Copy)]
pub struct Arriving {
    /// Unit, to the light.
    pub to_light: DVec3,
    /// Linear RGB, falloff included, shadow not.
    pub radiance: DVec3,
    /// Share that nothing keeps away, 0..1.
    pub visibility: f64,
}

/// What arrives of a light at a surface of `own`. A soft shadow is the mean of `num_rays` to places of the light's disc, which
/// has its angular diameter as seen from here.
pub fn arriving(world: &World, light: &Light, surface: &Surface, own: Object, num_rays: u32, seed: u64) -> Arriving {
    let mut radiance = light.color.as_dvec3();
    let (to_light, distance) = match light.place {
        LightPlace::Directional(toward) => (toward.as_dvec3().normalize_or(DVec3::Z), f64::INFINITY),
        LightPlace::Point { position_view, range } => {
            let offset = position_view.as_dvec3() - surface.position;
            let distance = offset.length().max(1e-12);
            if range > 0.0 {
                // Smooth window to zero at the range [Karis2013 eq. 9, without its 1/d^2].
                let window = (1.0 - (distance / f64::from(range)).powi(4)).clamp(0.0, 1.0);
                radiance *= window * window;
            }
            (offset / distance, distance)
        }
    };
    let visibility = light.shadow.map_or(1.0, |shadow| {
        let half_tan = (0.5 * f64::from(shadow.softness_rad)).tan();
        let (side, other) = to_light.any_orthonormal_pair();
        // What is convex does not shade itself; what a mesh shades of itself begins beyond rounding.
        let is_mesh = matches!(own, Object::Triangle(_));
        let (start, least) = start_of(world, surface, is_mesh);
        let blocked = |direction: DVec3| {
            let ray = Ray { origin: start, direction };
            world.is_blocked(ray, least, distance, |object| object != own)
        };
        let num_blocked = if half_tan <= 0.0 {
            f64::from(u8::from(blocked(to_light)))
        } else {
            let turned = |index: u32| {
                let place = half_tan * disc_point(spread(index, seed));
                blocked((to_light + place.x * side + place.y * other).normalize())
            };
            f64::from((0..num_rays).map(|index| u32::from(turned(index))).sum::<u32>()) / f64::from(num_rays.max(1))
        };
        1.0 - f64::from(shadow.strength) * num_blocked
    });
    Arriving { to_light, radiance, visibility }
}

/// Where rays from a surface start, and the least `t` at which they meet something: beyond what positions are rounded to.
pub fn start_of(world: &World, surface: &Surface, is_mesh: bool) -> (DVec3, f64) {
    let slack = world.rounding();
    let start = if is_mesh { surface.position + surface.facet * slack } else { surface.position };
    (start, slack)
}
