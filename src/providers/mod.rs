//! The three providers of [Prost2016 §3.2]: each answers one question about a scene from its part of the style file.

mod camera;
mod classes;
mod lighting;
mod picked;
mod shader;
mod unmatched;

pub use camera::CameraProvider;
pub use lighting::LightingProvider;
pub use picked::{Picked, picked};
pub use shader::{Assignment, ShaderProvider};
pub use unmatched::unmatched;

use crate::config::{Geometry, Length};
use crate::scene::{Scene, Sphere};

/// Millimetres in an angstrom.
const ANGSTROM_MM: f64 = 1e-7;

/// Turns lengths of a style into scene units or pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lengths {
    /// Radius of the scene's bounding sphere.
    pub radius: f64,
    /// Median radius of the drawn atoms; a fiftieth of the sphere's radius where there are none.
    pub median_radius: f64,
    /// An angstrom in scene units.
    pub angstrom: f64,
    /// A millimetre in scene units.
    pub millimetre: f64,
}

impl Lengths {
    /// Lengths in a molecule of this bounding sphere, whose unit is the angstrom, with this median radius of the drawn
    /// atoms, if there are any.
    pub fn new(bounds: Sphere, median_radius: Option<f64>) -> Lengths {
        let radius = f64::from(bounds.radius);
        let median_radius = median_radius.unwrap_or(radius / 50.0);
        Lengths { radius, median_radius, angstrom: 1.0, millimetre: 1.0 / ANGSTROM_MM }
    }

    /// Lengths in a scene. Files of molecules are in angstrom, and what those of meshes are in, the style's geometry
    /// says. Where both are drawn at once, a length in angstrom is one of the molecules, and one in millimetres of the meshes.
    pub fn of_scene(scene: &Scene, geometry: &Geometry, median_radius: Option<f64>) -> Lengths {
        let has_atoms = !scene.molecule.atoms.is_empty();
        let file_unit_mm = if scene.assembly.is_empty() { ANGSTROM_MM } else { geometry.file_unit_mm };
        let millimetre = 1.0 / (file_unit_mm * scene.unit);
        let angstrom = if has_atoms { 1.0 / scene.unit } else { ANGSTROM_MM * millimetre };
        Lengths { angstrom, millimetre, ..Lengths::new(scene.bounding_sphere(), median_radius) }
    }

    /// A length in scene units. Points are taken where the whole scene fills the picture: 1080pt are its diameter.
    pub fn world(&self, length: Length) -> f64 {
        match length {
            Length::Radii(n) => n * self.radius,
            Length::Points(n) => n / 1080.0 * 2.0 * self.radius,
            Length::MedianRadii(n) => n * self.median_radius,
            Length::Angstrom(n) => n * self.angstrom,
            Length::Millimetre(n) => n * self.millimetre,
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
