//! The three providers of [Prost2016 §3.2]: each answers one question about a scene from its part of the style file.

mod camera;
mod classes;
mod lighting;
mod shader;
mod unmatched;

pub use camera::CameraProvider;
pub use lighting::LightingProvider;
pub use shader::{Assignment, ShaderProvider};
pub use unmatched::unmatched;

use crate::config::Length;
use crate::scene::Sphere;

/// Turns lengths of a style into scene units (angstrom for molecules) or pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lengths {
    /// Radius of the scene's bounding sphere.
    pub radius: f64,
    /// Median radius of the drawn atoms; a fiftieth of the sphere's radius where there are none.
    pub median_radius: f64,
}

impl Lengths {
    /// Lengths in a scene of this bounding sphere, with this median radius of the drawn atoms, if there are any.
    pub fn new(bounds: Sphere, median_radius: Option<f64>) -> Lengths {
        let radius = f64::from(bounds.radius);
        Lengths { radius, median_radius: median_radius.unwrap_or(radius / 50.0) }
    }

    /// A length in scene units. Points are taken where the whole scene fills the picture: 1080pt are its diameter.
    pub fn world(&self, length: Length) -> f64 {
        match length {
            Length::Radii(n) => n * self.radius,
            Length::Points(n) => n / 1080.0 * 2.0 * self.radius,
            Length::MedianRadii(n) => n * self.median_radius,
            Length::Angstrom(n) => n,
            // A molecule's unit is the angstrom.
            Length::Millimetre(n) => n * 1e7,
        }
    }

    /// A length on the screen: pixels for points, scene units for all others.
    pub fn screen(&self, length: Length, height_px: u32) -> (f64, f64) {
        match length {
            Length::Points(n) => (n * f64::from(height_px) / 1080.0, 0.0),
            other => (0.0, self.world(other)),
        }
    }
}
