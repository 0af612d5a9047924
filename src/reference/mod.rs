//! The reference renderer: the same scene in the same style by exact ray casts on all cores, without GPU or driver.
//!
//! ```text
//! World (tree of boxes, exact casts)  ->  for each sample of each pixel: surface, its lights by shadow rays, its shader,
//!     occlusion  ->  lines  ->  pixel
//! ```
//! It is the truth that other methods are measured against, the still of final quality, and what draws where there is no
//! adapter. Parameters and formulas of shading are those of the GPU; no table, bias or filter of its is used. All numbers are
//! spread by pixel and sample: the same bytes come from any number of threads.

mod basic;
pub mod curvature;
mod hull;
mod lens;
mod light;
mod lines;
mod occlusion;
mod primitive;
mod render;
mod sampling;
mod toon;
mod world;

use glam::DVec3;

pub use hull::outlines;
pub use lens::Lens;
pub use occlusion::{Occlusion, occluded};
pub use primitive::Ray;
pub use render::{BrokenOff, Picture, RowSink, Settings, render};
pub use world::{Cylinder, Hit, Look, Meshes, Object, Part, Sphere, Surface, World};

use crate::scene::Camera;
use crate::shading::toon::ToonMaterial;
use basic::Basic;
use curvature::Stylist;

/// How a material is shaded.
pub enum Shade {
    /// See [`crate::shading::basic`].
    Basic(Box<BasicShade>),
    /// See [`crate::shading::toon`].
    Toon(ToonMaterial),
    /// See [`crate::shading::unlit`].
    Unlit,
}

/// A material of `basic`, made ready.
pub struct BasicShade(Basic);

impl Shade {
    /// Of `basic`, its albedos integrated.
    pub fn basic(material: &crate::shading::basic::BasicMaterial) -> Shade {
        Shade::Basic(Box::new(BasicShade(Basic::new(material))))
    }
}

/// An outline by enlarged back faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullLook {
    /// Linear RGB.
    pub color: DVec3,
    /// In pixels, and in scene units, added.
    pub width: (f64, f64),
}

/// What objects of one material share.
pub struct Material {
    /// Linear RGB that replaces the objects' own, if it does.
    pub base_color: Option<DVec3>,
    /// Their outline, if they have one.
    pub hull: Option<HullLook>,
    /// Share of light that they keep back, 0..1.
    pub opacity: f64,
    /// How they are shaded.
    pub shade: Shade,
    /// What their curvature makes of that, where anything.
    pub stylist: Option<Box<Stylist>>,
}

/// A camera onto pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optics {
    /// Half the picture in view units, at depth 1 or everywhere.
    half_extent: glam::DVec2,
    size_px: glam::DVec2,
    /// Parallel rays.
    pub orthographic: bool,
    /// Nearest depth that is drawn.
    pub near: f64,
    /// View units of a pixel, at depth 1 or everywhere.
    pub pixel_view: f64,
}

impl Optics {
    /// A camera onto a picture of this size.
    pub fn new(camera: &Camera, size_px: [u32; 2]) -> Optics {
        let size_px = glam::DVec2::new(f64::from(size_px[0]), f64::from(size_px[1]));
        let half_extent = camera.half_extent.as_dvec2();
        Optics {
            half_extent,
            size_px,
            orthographic: camera.orthographic,
            near: f64::from(camera.near),
            pixel_view: 2.0 * half_extent.y / size_px.y,
        }
    }

    /// The line of sight of a place in the picture, in pixels from the top left; `t` of it is depth.
    pub fn ray(&self, place_px: glam::DVec2) -> Ray {
        let plane =
            (glam::DVec2::new(2.0, -2.0) * place_px / self.size_px + glam::DVec2::new(-1.0, 1.0)) * self.half_extent;
        if self.orthographic {
            Ray { origin: plane.extend(0.0), direction: DVec3::NEG_Z }
        } else {
            Ray { origin: DVec3::ZERO, direction: plane.extend(-1.0) }
        }
    }

    /// Scene units of a pixel at a depth.
    pub fn pixel(&self, depth: f64) -> f64 {
        self.pixel_view * if self.orthographic { 1.0 } else { depth.max(self.near) }
    }
}
