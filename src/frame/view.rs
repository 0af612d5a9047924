//! The view uniform: a camera, or a light that looks at the scene, and one sample of a still.

use glam::{Mat4, Vec2};

use crate::gpu_struct;
use crate::scene::Camera;

gpu_struct! {
    "lib/view.wgsl",
    /// See `shaders/lib/view.wgsl`.
    pub struct View {
        /// From world to view space.
        pub view_from_world: [[f32; 4]; 4],
        /// Place on the plane of half extents = pixel position * xy + zw.
        pub plane_from_px: [f32; 4],
        /// Half the picture in view units, at depth 1 or everywhere.
        pub half_extent: [f32; 2],
        /// Picture size in pixels.
        pub size_px: [f32; 2],
        /// Offset of the sample from the pixel's centre, in pixels, y down.
        pub jitter_px: [f32; 2],
        /// 1 or 0.
        pub orthographic: f32,
        /// Nearest depth that is drawn.
        pub near: f32,
        /// Coefficients of the depth buffer's value.
        pub depth_from_t: [f32; 3],
        /// View units of a pixel, at depth 1 or everywhere.
        pub pixel_view: f32,
        /// Turn of filter patterns, in radians.
        pub sample_rotation_rad: f32,
        /// One over the number of samples.
        pub sample_weight: f32,
        /// Side of the square that one sample stands for, in pixels.
        pub footprint_px: f32,
        /// Padding.
        pub _pad0: f32,
    }
}

impl View {
    /// A view through `camera` onto `size_px` pixels at pixel centres.
    pub fn new(camera: &Camera, size_px: [u32; 2]) -> View {
        let near = camera.near;
        // Reversed depth: 1 at the near plane. Hyperbolic in perspective, as rasterised triangles have it.
        let depth_from_t = if camera.orthographic {
            let span = (camera.far - near).max(f32::MIN_POSITIVE);
            [0.0, 1.0 + near / span, -1.0 / span]
        } else {
            [near, 0.0, 0.0]
        };
        View {
            view_from_world: camera.view_from_world.to_cols_array_2d(),
            half_extent: camera.half_extent.to_array(),
            size_px: [size_px[0] as f32, size_px[1] as f32],
            jitter_px: [0.0; 2],
            plane_from_px: plane_from_px(camera.half_extent, size_px, Vec2::ZERO),
            orthographic: if camera.orthographic { 1.0 } else { 0.0 },
            near,
            depth_from_t,
            pixel_view: camera.pixel_view(size_px[1]),
            sample_rotation_rad: 0.0,
            sample_weight: 1.0,
            footprint_px: 1.0,
            _pad0: 0.0,
        }
    }

    /// The same view for sample `index` of `count`: jittered within the pixel, filters turned.
    pub fn sample(&self, index: u32, count: u32) -> View {
        let jitter_px = sample_offset_px(index, count);
        let size_px = [self.size_px[0] as u32, self.size_px[1] as u32];
        View {
            jitter_px: jitter_px.to_array(),
            plane_from_px: plane_from_px(Vec2::from(self.half_extent), size_px, jitter_px),
            sample_rotation_rad: std::f32::consts::TAU * index as f32 / count as f32,
            sample_weight: 1.0 / count as f32,
            footprint_px: 1.0 / (count as f32).sqrt(),
            ..*self
        }
    }

    /// From world to view space.
    pub fn matrix(&self) -> Mat4 {
        Mat4::from_cols_array_2d(&self.view_from_world)
    }
}

fn plane_from_px(half_extent: Vec2, size_px: [u32; 2], jitter_px: Vec2) -> [f32; 4] {
    let flip = Vec2::new(1.0, -1.0);
    let scale = 2.0 * flip * half_extent / Vec2::new(size_px[0] as f32, size_px[1] as f32);
    let offset = jitter_px * scale - flip * half_extent;
    [scale.x, scale.y, offset.x, offset.y]
}

/// Offset from the pixel's centre of sample `index` of `count`, each coordinate in -0.5..0.5.
///
/// The first two Sobol dimensions: any power of two of them is a (0, 2)-net, one sample in each cell of every
/// dyadic split of the pixel [Kollig2002 §2]. Moved by half a cell so that the mean is the centre.
pub fn sample_offset_px(index: u32, count: u32) -> Vec2 {
    let mut second = 0u32;
    let mut direction = 1u32 << 31;
    let mut rest = index;
    while rest != 0 {
        if rest & 1 == 1 {
            second ^= direction;
        }
        rest >>= 1;
        direction ^= direction >> 1;
    }
    let unit = 1.0 / 4_294_967_296.0;
    let cell = 0.5 / count.max(1).next_power_of_two() as f32;
    let first = index.reverse_bits();
    Vec2::new(first as f32 * unit + cell - 0.5, second as f32 * unit + cell - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sample_is_the_centre() {
        assert_eq!(sample_offset_px(0, 1), Vec2::ZERO);
    }

    #[test]
    fn sixteen_samples_fill_every_dyadic_cell() {
        let points: Vec<Vec2> = (0..16).map(|index| sample_offset_px(index, 16) + 0.5).collect();
        for (columns, rows) in [(16, 1), (8, 2), (4, 4), (2, 8), (1, 16)] {
            let mut seen = vec![false; 16];
            for point in &points {
                let cell = (point.x * columns as f32) as usize + columns * (point.y * rows as f32) as usize;
                assert!(!std::mem::replace(&mut seen[cell], true), "two samples in one cell of {columns}x{rows}");
            }
        }
        let mean = points.iter().sum::<Vec2>() / 16.0;
        assert!((mean - 0.5).length() < 1e-6, "{mean}");
    }
}
