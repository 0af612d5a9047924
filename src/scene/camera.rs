//! A camera, resolved: where it stands and what it sees. No JSON, no GPU.

use glam::{Mat4, Vec2, Vec3};

/// A view of the scene. View space has the camera at the origin looking along -z, +y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// From world (scene) space to view space; rotation and translation only.
    pub view_from_world: Mat4,
    /// Half the picture in view units: at depth 1 in perspective, everywhere in orthographic.
    pub half_extent: Vec2,
    /// Parallel rays instead of rays from the origin.
    pub orthographic: bool,
    /// Nearest depth that is drawn, above 0.
    pub near: f32,
    /// Depth beyond which nothing lies.
    pub far: f32,
}

impl Camera {
    /// View units that a pixel of a picture `height_px` high covers, at depth 1 (perspective) or anywhere.
    pub fn pixel_view(&self, height_px: u32) -> f32 {
        2.0 * self.half_extent.y / height_px.max(1) as f32
    }

    /// The eye in world space.
    pub fn position_world(&self) -> Vec3 {
        self.view_from_world.inverse().transform_point3(Vec3::ZERO)
    }

    /// The ray of a picture position in pixels (origin top left): origin and direction in view space, direction.z = -1.
    pub fn ray(&self, position_px: Vec2, size_px: [u32; 2]) -> (Vec3, Vec3) {
        let size = Vec2::new(size_px[0] as f32, size_px[1] as f32);
        let ndc = Vec2::new(2.0, -2.0) * position_px / size + Vec2::new(-1.0, 1.0);
        let plane = ndc * self.half_extent;
        if self.orthographic { (plane.extend(0.0), Vec3::NEG_Z) } else { (Vec3::ZERO, plane.extend(-1.0)) }
    }
}
