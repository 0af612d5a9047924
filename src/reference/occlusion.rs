//! Ambient occlusion: the share of cosine-weighted directions in which something lies within a radius.

use super::light::start_of;
use super::primitive::Ray;
use super::sampling::{cosine_direction, spread};
use super::world::{Object, Surface, World};

/// What occlusion a style asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Occlusion {
    /// Scene units within which things count.
    pub radius: f64,
    /// Light is multiplied by 1 - intensity times occlusion, at least 0.
    pub intensity: f64,
    /// The bit of what is darkened, where that is not all.
    pub pick_bits: Option<u32>,
}

impl Occlusion {
    /// Whether it darkens a surface.
    pub fn picks(&self, surface: &Surface) -> bool {
        self.pick_bits.is_none_or(|bits| surface.picks & bits != 0)
    }
}

/// The share of `num_rays` directions above a surface's plane that are blocked, 0..1.
pub fn occluded(world: &World, surface: &Surface, own: Object, radius: f64, num_rays: u32, seed: u64) -> f64 {
    let is_mesh = matches!(own, Object::Triangle(_));
    let (origin, least) = start_of(world, surface, is_mesh);
    let is_blocked = |index: u32| {
        let direction = cosine_direction(spread(index, seed), surface.facet);
        world.is_blocked(Ray { origin, direction }, least, radius, |object| object != own)
    };
    let num_blocked: u32 = (0..num_rays).map(|index| u32::from(is_blocked(index))).sum();
    f64::from(num_blocked) / f64::from(num_rays.max(1))
}
