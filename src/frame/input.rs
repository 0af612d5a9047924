//! What a frame is asked for.

use super::bkb::BkbForm;
use super::post::Effect;
use super::view::{Tile, View};
use crate::scene::{Camera, Lighting, Sphere};

/// How the fragments of what is transparent are put in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerMethod {
    /// All of them, in sorted lists.
    Packed,
    /// The nearest of each pixel, in buckets.
    Bkb {
        /// How many of them.
        k: u32,
        /// How they are used.
        form: BkbForm,
    },
}

/// What one still needs beside objects and materials.
#[derive(Debug, Clone)]
pub struct FrameInput<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The lights, in view space.
    pub lighting: &'a Lighting,
    /// What shadow maps must hold, in world space.
    pub bounds: Sphere,
    /// Premultiplied linear background; alpha 0 for a transparent picture.
    pub background: [f32; 4],
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The tile of the picture to draw; all of it where there is none.
    pub tile: Option<Tile>,
    /// Whether the shadow maps still hold what the frame needs: the last one was another tile of the same picture.
    pub shadows_drawn: bool,
    /// Samples a pixel.
    pub samples: u32,
    /// 16 bits a channel instead of 8.
    pub wide: bool,
    /// Post effects, in the order in which they change the picture.
    pub effects: &'a [Effect],
    /// Most bytes that the fragments of what is transparent take at once.
    pub layer_bytes: u64,
    /// How they are put in order.
    pub layer_method: LayerMethod,
    /// What curvature, with the radius of `bounds` as the unit of length, is multiplied by before tanh.
    pub curvature_gain: f32,
}

impl FrameInput<'_> {
    /// Width and height of what is drawn, in pixels.
    pub(super) fn drawn_size(&self) -> [u32; 2] {
        self.tile.map_or(self.size, |tile| tile.size_px)
    }

    /// The view at pixel centres.
    pub(super) fn view(&self) -> View {
        let view = View::new(self.camera, self.size);
        self.tile.map_or(view, |tile| view.tile(tile))
    }
}
