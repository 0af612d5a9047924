//! A thin lens: which depth is sharp, and how wide the rest blurs.
//!
//! In perspective the circle of confusion of a point at depth z is `strength * |1/focus - 1/z|` wide [Potmesil1981 §2]. An
//! orthographic view has no lens; there it is `strength * |z - focus|`, as wide in front as behind, which a sheaf of parallel
//! views makes that turns about the plane of focus.

use glam::DVec2;

use super::Optics;
use super::primitive::Ray;
use super::sampling::disc_point;

/// A lens before a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lens {
    /// Depth of what is sharp.
    pub focus: f64,
    /// Diameter of the circle of confusion in pixels, for each unit of |1/focus - 1/z|, or of |z - focus|.
    pub strength_px: f64,
}

impl Lens {
    /// The lens that is sharp at `focus` and blurs what lies at `depth` to a circle of `blur_px`; none where both are the same.
    pub fn new(optics: &Optics, focus: f64, depth: f64, blur_px: f64) -> Option<Lens> {
        let measure = measure(optics, focus, depth);
        let strength_px = blur_px / measure;
        (strength_px.is_finite() && strength_px > 0.0).then_some(Lens { focus, strength_px })
    }

    /// Diameter of the circle of confusion at a depth, in pixels.
    pub fn circle_px(&self, optics: &Optics, depth: f64) -> f64 {
        self.strength_px * measure(optics, self.focus, depth)
    }

    /// The line of sight through a place of the lens, a point of the unit square, that meets the pinhole's at the focus.
    pub fn ray(&self, optics: &Optics, place_px: DVec2, point: DVec2) -> Ray {
        let sharp = optics.ray(place_px);
        // A circle of one pixel is pixel_view wide on the plane at depth 1.
        let off = 0.5 * self.strength_px * optics.pixel_view * disc_point(point);
        if optics.orthographic {
            let direction = off.extend(-1.0);
            Ray { origin: sharp.at(self.focus) - self.focus * direction, direction }
        } else {
            let origin = off.extend(0.0);
            Ray { origin, direction: (self.focus * sharp.direction - origin) / self.focus }
        }
    }
}

fn measure(optics: &Optics, focus: f64, depth: f64) -> f64 {
    if optics.orthographic { (depth - focus).abs() } else { (1.0 / focus - 1.0 / depth).abs() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Camera;
    use glam::{DVec3, Mat4, Vec2};

    fn optics(orthographic: bool) -> Optics {
        let camera = Camera {
            view_from_world: Mat4::IDENTITY,
            half_extent: Vec2::splat(0.5),
            orthographic,
            near: 0.1,
            far: 100.0,
        };
        Optics::new(&camera, [400, 400])
    }

    /// The place in the picture of a point in view space.
    fn project(optics: &Optics, point: DVec3) -> DVec2 {
        let plane = if optics.orthographic { point.truncate() } else { point.truncate() / -point.z };
        (plane / optics.half_extent * DVec2::new(0.5, -0.5) + 0.5) * optics.size_px
    }

    #[test]
    fn a_point_blurs_to_the_circle_of_the_formula() {
        for orthographic in [false, true] {
            let optics = optics(orthographic);
            let lens = Lens::new(&optics, 8.0, 20.0, 30.0).expect("a lens");
            for depth in [3.0, 6.0, 8.0, 12.0, 20.0, 60.0] {
                // Which pixels see a point: a lens ray meets its depth at the place of the pinhole's ray moved by the blur.
                let (mut widest, center) = (0.0f64, DVec2::new(137.0, 260.0));
                for turn in 0..64 {
                    let rim = DVec2::new(1.0, f64::from(turn) / 64.0);
                    let met = lens.ray(&optics, center, rim).at(depth);
                    assert!((met.z + depth).abs() < 1e-12, "t is depth");
                    widest = widest.max(2.0 * project(&optics, met).distance(center));
                }
                let expected = lens.circle_px(&optics, depth);
                assert!((widest - expected).abs() < 1e-9 * (1.0 + expected), "{depth}: {widest} {expected}");
            }
            assert!((lens.circle_px(&optics, 20.0) - 30.0).abs() < 1e-12);
            // The thin-lens formula: A f |z - s| / (z (s - f)), with the image scaled so that f -> 0.
            if !orthographic {
                let quotient = lens.circle_px(&optics, 12.0) / lens.circle_px(&optics, 20.0);
                assert!((quotient - (4.0 / 12.0) / (12.0 / 20.0)).abs() < 1e-12);
            }
        }
    }
}
