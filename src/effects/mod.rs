//! Post effects: one file each, with its parameters, its GPU struct, its passes and the name of its WGSL; found through
//! [`EFFECTS`]. They change the picture of each sample after its objects are shaded.
//!
//! To add one: `src/effects/NAME.rs`, `shaders/effects/NAME.wgsl` with a fragment entry for each pass, a twin in
//! `tests/twins/NAME.rs`, and one line in [`EFFECTS`]. What the entries can read, the frame declares: `view`, `params`,
//! `geometry`, `color`, `ids`, the textures of objects, and each earlier pass by its name; the last returns `finished(color)`.

pub mod focus;
pub mod occlusion;
pub mod outline;

use crate::config::param::{Length, Param, Selector, Values};
use crate::gpu::{StructInfo, Wgsl};

/// What an effect needs to know of scene and picture to turn its values into numbers.
#[derive(Clone, Copy)]
pub struct EffectContext<'a> {
    /// A length on the screen: pixels for points, scene units for all others; one of both is 0.
    pub screen: &'a dyn Fn(Length) -> (f64, f64),
    /// A length in scene units.
    pub world: &'a dyn Fn(Length) -> f64,
    /// Scene units of a pixel at the nearest depth that is drawn.
    pub least_pixel_world: f64,
    /// The bit of the objects that [`PostEffect::picks`] picks; 0 where it picks nothing of the scene, or all.
    pub pick_bits: u32,
}

/// Where a pass of an effect draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PassTarget {
    /// A texture that later passes of the effect read by the pass's name.
    Own {
        /// Its format, of unsigned integers or of floats.
        format: wgpu::TextureFormat,
        /// Pixels of the picture, across and down, that one texel stands for.
        pixels: [u32; 2],
    },
    /// The picture. The last pass of every effect, and no other.
    Picture,
}

/// One pass over all texels of its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EffectPass {
    /// Its name in timings, and of its texture in WGSL.
    pub name: &'static str,
    /// Its fragment entry.
    pub entry: &'static str,
    /// Where it draws.
    pub target: PassTarget,
}

/// One way to change the picture.
pub trait PostEffect: Sync {
    /// Its name in style files.
    fn name(&self) -> &'static str;
    /// The stem of its files.
    fn file(&self) -> &'static str;
    /// One sentence for the manual.
    fn doc(&self) -> &'static str;
    /// Its parameters.
    fn params(&self) -> &'static [Param];
    /// WGSL that its entries need, its own file last.
    fn wgsl(&self) -> &'static [Wgsl];
    /// The WGSL struct of its parameters.
    fn params_info(&self) -> StructInfo;
    /// The bytes of that struct.
    fn uniform(&self, values: &Values, context: &EffectContext<'_>) -> Vec<u8>;
    /// Which objects it changes, where not all.
    fn picks<'a>(&self, _values: &'a Values) -> Option<&'a Selector> {
        None
    }
    /// How far what a pixel sees changes others, in pixels.
    fn reach_px(&self, values: &Values, context: &EffectContext<'_>) -> u32;
    /// Its passes in order.
    fn passes(&self) -> &'static [EffectPass];
    /// Why such values change nothing in the picture, if so: the effect is then left out.
    fn changes_nothing(&self, _values: &Values, _context: &EffectContext<'_>) -> Option<&'static str> {
        None
    }
    /// Names of the constants by which its WGSL leaves out what a style does not use.
    fn features(&self) -> &'static [&'static str] {
        &[]
    }
    /// Which of them such values use, one bit each.
    fn features_used(&self, _values: &Values) -> u32 {
        0
    }
}

/// All post effects, in the order of their stages.
pub const EFFECTS: &[&dyn PostEffect] = &[&occlusion::AmbientOcclusion, &outline::Outline];

/// Place in [`EFFECTS`] of a name.
pub fn effect_index(name: &str) -> Option<usize> {
    EFFECTS.iter().position(|effect| effect.name() == name)
}
