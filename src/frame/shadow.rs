//! Shadow maps: what each light that casts shadows sees of the scene, once per still.

use glam::{Mat4, Vec2, Vec3};

use super::view::View;
use super::visibility::{DEPTH_FORMAT, LIGHT_FORMAT};
use crate::gpu::Gpu;
use crate::gpu_struct;
use crate::scene::{Camera, LightPlace, Lighting, Sphere};

/// Lights that cast shadows in one frame.
pub const MAX_SHADOWS: usize = 4;

gpu_struct! {
    "lib/shadow_maps.wgsl",
    /// See `shaders/lib/shadow_maps.wgsl`.
    pub struct ShadowView {
        /// The light's view of the scene.
        pub light: View,
        /// From the camera's to the light's view space.
        pub light_from_view: [[f32; 4]; 4],
    }
}

gpu_struct! {
    "lib/shadow_maps.wgsl",
    /// See `shaders/lib/shadow_maps.wgsl`.
    pub struct Shadows {
        /// One for each layer of the maps.
        pub views: [ShadowView; MAX_SHADOWS],
    }
}

/// The lights' views of a frame, before any map is drawn.
#[derive(Debug, Clone, Default)]
pub struct ShadowPlan {
    /// The lights' views, by layer.
    pub views: Vec<ShadowView>,
    /// The layer of each light of the style.
    pub layers: Vec<Option<u32>>,
}

impl ShadowPlan {
    /// Views that fit the scene, for the lights that cast shadows. A point light within the scene's bounding sphere
    /// casts none: one map cannot hold what lies on all its sides.
    pub fn new(lighting: &Lighting, camera: &Camera, bounds: Sphere, map_size: u32) -> ShadowPlan {
        let view_from_world = camera.view_from_world;
        let center_view = view_from_world.transform_point3(bounds.center);
        let mut plan = ShadowPlan::default();
        for light in &lighting.lights {
            let light_camera = match (light.shadow, light.place) {
                (None, _) => None,
                (Some(_), LightPlace::Directional(toward)) => Some(directional(toward, center_view, bounds.radius)),
                (Some(_), LightPlace::Point { position_view, .. }) => point(position_view, center_view, bounds.radius),
            };
            let layer = light_camera.filter(|_| plan.views.len() < MAX_SHADOWS).map(|light_camera| {
                let light_from_view = light_camera.view_from_world;
                let in_world = Camera { view_from_world: light_from_view * view_from_world, ..light_camera };
                plan.views.push(ShadowView {
                    light: View::new(&in_world, [map_size; 2]),
                    light_from_view: light_from_view.to_cols_array_2d(),
                });
                plan.views.len() as u32 - 1
            });
            plan.layers.push(layer);
        }
        plan
    }

    /// The uniform.
    pub fn uniform(&self) -> Shadows {
        let mut shadows: Shadows = bytemuck::Zeroable::zeroed();
        for (slot, view) in shadows.views.iter_mut().zip(&self.views) {
            *slot = *view;
        }
        shadows
    }
}

/// A point light nearer to the scene's centre than this, in radii, casts no shadow.
pub const SHADOWLESS_RADII: f64 = 1.02;

/// Half a percent beyond the sphere, so that nothing of it touches the border of the map.
const MARGIN: f32 = 1.005;

fn looking(from: Vec3, toward: Vec3) -> Mat4 {
    let up = if toward.y.abs() > 0.9 { Vec3::X } else { Vec3::Y };
    glam::camera::rh::view::look_to_mat4(from, toward, up)
}

/// The parallel view along a directional light, in the camera's view space.
fn directional(toward_light: Vec3, center: Vec3, radius: f32) -> Camera {
    let reach = radius * MARGIN;
    Camera {
        view_from_world: looking(center + toward_light * (2.0 * reach), -toward_light),
        half_extent: Vec2::splat(reach),
        orthographic: true,
        near: reach,
        far: 3.0 * reach,
    }
}

/// The view from a point light onto the sphere, in the camera's view space; none from within it.
fn point(position: Vec3, center: Vec3, radius: f32) -> Option<Camera> {
    let reach = radius * MARGIN;
    let distance = position.distance(center);
    if distance <= SHADOWLESS_RADII as f32 * radius {
        return None;
    }
    let sine = reach / distance;
    Some(Camera {
        view_from_world: looking(position, (center - position) / distance),
        half_extent: Vec2::splat(sine / (1.0 - sine * sine).sqrt()),
        orthographic: false,
        near: (distance - reach).max(1e-3 * distance),
        far: distance + reach,
    })
}

/// What of the maps tells shadows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum ShadowFilter {
    /// The objects that a map names, and depths where they are triangles or the shadow is soft.
    #[default]
    Objects,
    /// Depths: of one texel where hard, within the penumbra where soft. As published, for measurements.
    Depth,
    /// Depths of 3x3 texels where hard. As published, for measurements.
    DepthShare,
}

impl ShadowFilter {
    /// Its number in WGSL.
    pub fn number(self) -> u32 {
        match self {
            ShadowFilter::Objects => 0,
            ShadowFilter::Depth => 1,
            ShadowFilter::DepthShare => 2,
        }
    }
}

/// How fine shadows are. Measurements vary it; what is none follows the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ShadowQuality {
    /// Texels along a side of each map.
    pub map_size: Option<u32>,
    /// Taps of a soft shadow in one sample.
    pub soft_taps: Option<u32>,
    /// What of the maps tells shadows.
    pub filter: ShadowFilter,
}

impl ShadowQuality {
    /// Taps that find the blockers of a soft shadow, and again that filter it, in one sample of a still. They turn from
    /// sample to sample, so that many samples need few each; below 8 the search misses thin blockers (ours).
    pub fn soft_taps(&self, samples: u32) -> u32 {
        self.soft_taps.unwrap_or_else(|| (32 / samples.max(1)).clamp(8, 16))
    }

    /// Texels along a side of the map: about one and a half for each pixel that the picture spends on the scene, since
    /// the exact test of the hard edge needs only ids, and the soft filter is wider than a texel.
    pub fn map_size(&self, gpu: &Gpu, picture_height_px: u32) -> u32 {
        let wanted = (picture_height_px + picture_height_px / 2).next_multiple_of(64).clamp(256, 4096);
        self.map_size.unwrap_or(wanted).min(gpu.device.limits().max_texture_dimension_2d)
    }
}

/// The maps: ids and depths, one layer for each light.
pub struct ShadowMaps {
    /// Ids and depths of what each light sees first.
    seen: wgpu::Texture,
    /// Each layer, to draw to.
    layers: Vec<wgpu::TextureView>,
    /// All layers, to read from.
    all: wgpu::TextureView,
    /// Depth to test with, used by one light after the other.
    depth: wgpu::TextureView,
}

impl ShadowMaps {
    /// Allocates `layers` maps.
    pub fn new(gpu: &Gpu, size: u32, layers: u32) -> ShadowMaps {
        let seen = gpu.target("shadow maps", [size; 2], layers, LIGHT_FORMAT);
        let layer = |index| {
            seen.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: index,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let all = seen.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let depth = gpu.target("shadow depth", [size; 2], 1, DEPTH_FORMAT).create_view(&Default::default());
        ShadowMaps { layers: (0..layers).map(layer).collect(), all, depth, seen }
    }

    /// Whether these are `layers` maps of this size.
    pub fn fit(&self, size: u32, layers: u32) -> bool {
        self.seen.width() == size && self.layers.len() == layers as usize
    }

    /// The layers to draw to, with the depth to test with.
    pub fn layers(&self) -> impl Iterator<Item = (&wgpu::TextureView, &wgpu::TextureView)> {
        self.layers.iter().map(|layer| (layer, &self.depth))
    }

    /// All layers to read from.
    pub fn all(&self) -> &wgpu::TextureView {
        &self.all
    }

    /// Bytes of all maps.
    pub fn bytes(&self) -> u64 {
        (0..self.layers.len()).map(|layer| ShadowMaps::layer_bytes(self.seen.width(), layer == 0)).sum()
    }

    /// Bytes of a layer; the first has the depths to test with, which all use.
    pub fn layer_bytes(size: u32, is_first: bool) -> u64 {
        u64::from(size) * u64::from(size) * if is_first { 12 } else { 8 }
    }
}
