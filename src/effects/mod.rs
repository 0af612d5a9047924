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

/// Where a scene lies before a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depths {
    /// Whether the camera is orthographic.
    pub orthographic: bool,
    /// Nearest depth that is drawn.
    pub near: f64,
    /// Depth of the middle of the scene's sphere.
    pub middle: f64,
    /// Radius of the scene's sphere.
    pub radius: f64,
    /// Scene units of a pixel at the middle.
    pub pixel_world: f64,
}

impl Depths {
    /// Least depth at which anything of the scene is seen.
    pub fn front(&self) -> f64 {
        (self.middle - self.radius).max(self.near)
    }

    /// Greatest depth of the scene.
    pub fn back(&self) -> f64 {
        self.middle + self.radius
    }
}

/// What an effect needs to know of scene and picture to turn its values into numbers.
#[derive(Clone, Copy)]
pub struct EffectContext<'a> {
    /// A length on the screen: pixels for points, scene units for all others; one of both is 0.
    pub screen: &'a dyn Fn(Length) -> (f64, f64),
    /// A length in scene units.
    pub world: &'a dyn Fn(Length) -> f64,
    /// Scene units of a pixel at the nearest depth that is drawn.
    pub least_pixel_world: f64,
    /// Samples a pixel.
    pub samples: u32,
    /// Where the scene lies.
    pub depths: Depths,
    /// The bit of the objects that [`PostEffect::picks`] picks; 0 where it picks nothing of the scene, or all.
    pub pick_bits: u32,
    /// Depth of what [`PostEffect::looks_at`] picks, in the middle of it; none where that is nothing.
    pub looked_at: Option<f64>,
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

/// A picture of what an effect finds, beside the one that it changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EffectAov {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its fragment entry, which reads what the last pass does.
    pub entry: &'static str,
}

/// What an effect reads beside the opaque picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ListsRead {
    /// Whether lines as well, and the surfaces that they are on.
    pub lines: bool,
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
    /// Whether it changes what is opaque alone, before layers are blended over it.
    fn is_before_layers(&self) -> bool {
        false
    }
    /// WGSL that the entries of its passes need with such features, its own file last.
    fn wgsl(&self, features: u32) -> &'static [Wgsl];
    /// The WGSL struct of its parameters.
    fn params_info(&self) -> StructInfo;
    /// The bytes of that struct.
    fn uniform(&self, values: &Values, context: &EffectContext<'_>) -> Vec<u8>;
    /// Which objects it changes, where not all.
    fn picks<'a>(&self, _values: &'a Values) -> Option<&'a Selector> {
        None
    }
    /// Whose place its numbers depend on.
    fn looks_at<'a>(&self, _values: &'a Values) -> Option<&'a Selector> {
        None
    }
    /// How far what a pixel sees changes others, in pixels.
    fn reach_px(&self, values: &Values, context: &EffectContext<'_>) -> u32;
    /// Its passes with such features, in order.
    fn passes(&self, features: u32) -> &'static [EffectPass];
    /// Textures that one of them does not read, of `geometry`, `color`, `ids` and earlier passes. Some adapters bind no more than 16
    /// at once, those of objects among them.
    fn unread(&self, _features: u32, _pass: &EffectPass) -> &'static [&'static str] {
        &[]
    }
    /// The fragment entry that stands in for the last one where a later effect must know how deep lies what it draws: it
    /// leaves the surfaces of all pixels as well.
    fn surfaces_entry(&self) -> Option<&'static str> {
        None
    }
    /// What it finds with such features, as one number a pixel; -1 where nothing is.
    fn aov(&self, _features: u32) -> Option<EffectAov> {
        None
    }
    /// The features with which it reads the lists of what is transparent, each surface by its own depth, where values with such
    /// features can; `lines` says whether effects drew any between layers and it. It comes last then.
    fn with_lists(&self, _features: u32, _lines: bool) -> Option<u32> {
        None
    }
    /// Whether it reads lists with such features, and lines.
    fn reads_lists(&self, _features: u32) -> Option<ListsRead> {
        None
    }
    /// Why such values change nothing in the picture, if so: the effect is then left out.
    fn changes_nothing(&self, _values: &Values, _context: &EffectContext<'_>) -> Option<&'static str> {
        None
    }
    /// Names of the constants by which its WGSL leaves out what a style does not use.
    fn features(&self) -> &'static [&'static str] {
        &[]
    }
    /// Which of them such values use, one bit each.
    fn features_used(&self, _values: &Values, _context: &EffectContext<'_>) -> u32 {
        0
    }
}

/// All post effects, in the order of their stages.
pub const EFFECTS: &[&dyn PostEffect] = &[&occlusion::AmbientOcclusion, &outline::Outline, &focus::Focus];

/// Place in [`EFFECTS`] of a name.
pub fn effect_index(name: &str) -> Option<usize> {
    EFFECTS.iter().position(|effect| effect.name() == name)
}
