//! `dofPost`: blurs what is out of focus.
//!
//! `gather` is ours, after the fields of [Jimenez2014, throughout]; `five_layer` after [Prost2016 §4.3]; where we differ: see
//! `shaders/effects/focus_gather.wgsl` and `shaders/effects/focus_layers.wgsl`. What is transparent is gathered from its lists, where a
//! frame keeps them: `shaders/effects/focus_glass.wgsl`. How wide things blur is the same for both, and
//! for the truth, which bends lines of sight to it: `src/reference/lens.rs`. Twin: `tests/twins/focus.rs`.

use glam::DVec3;

use super::{EffectAov, EffectContext, EffectPass, ListsRead, PassTarget, PostEffect};
use crate::config::param::{Length, Param, Selector, Value, Values};
use crate::gpu::{GpuStruct, StructInfo, Wgsl};
use crate::{gpu_struct, wgsl};

/// Values of `method`.
const METHODS: &[&str] = &["gather", "five_layer"];

/// Values of `focus` beside lengths and selectors.
const FOCUS: &[&str] = &["layers", "center"];

/// Values of `show`.
const SHOW: &[&str] = &["picture", "layers"];

/// Widest blur. Ours: a bound on what tiles of large pictures have in common, and an eighth of the picture's height.
const WIDEST: Length = Length::Points(135.0);

/// Blurs of a smaller diameter change nothing that is seen.
const LEAST_PX: f64 = 0.5;

/// Side of the tiles in which the widest blur is looked for, in pixels: `TILE` of `shaders/effects/focus_gather.wgsl`.
const TILE_PX: u32 = 16;

/// Most taps of a pixel (ours).
const TAPS: u32 = 32;

/// The parameters of `dofPost`. After [Prost2016 §4.3].
pub const PARAMS: &[Param] = &[
    Param::choice("method", METHODS, "gather")
        .doc("How it blurs: by circles, which lie behind what is sharp and over what is behind them, or in five layers as published.")
        .examples(&[r#""gather""#, r#""five_layer""#]),
    Param::numbers("layers", &[0.0, 0.0, 0.7, 0.9])
        .of_len(4)
        .ascending()
        .range(0.0, 1.0)
        .doc("Depths from 0, the sphere's nearest point, to 1: sharp between the middle two, blurred beyond the others.")
        .examples(&["[0, 0, 0.3, 0.6]", "[0.4, 0.7, 1, 1]"]),
    Param::place("focus", FOCUS, "layers")
        .doc("What is sharp: layers, or as through a lens the scene's center, what lies this far from the camera, or what is picked.")
        .examples(&[r#""layers""#, r#""center""#]),
    Param::length("blur", "16pt")
        .doc("Width of the blur beyond layers, or through a lens at the first or last of them, whichever is farther; at most 135pt.")
        .examples(&[r#""20pt""#, r#""90pt""#]),
    Param::choice("show", SHOW, "picture")
        .doc("What is drawn: the picture, or in flat colours which of the five layers is where.")
        .examples(&[r#""picture""#, r#""layers""#]),
];

/// How wide things blur: the diameter of the circle of confusion by depth, in pixels, below 0 before what is sharp.
///
/// It is flat, grows, and is flat again on either side of what is sharp, by a measure of depth along which lines of sight
/// through a lens are straight: -1 / z in perspective [Potmesil1981 §2], z in an orthographic view, which has no lens and is
/// defined so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circles {
    /// Whether the measure is z.
    pub orthographic: bool,
    /// Measures between which all is sharp.
    pub sharp: [f64; 2],
    /// Growth before and behind, in pixels for each unit of the measure.
    pub slopes_px: [f64; 2],
    /// Largest diameters before and behind, in pixels.
    pub most_px: [f64; 2],
}

impl Circles {
    /// Those of a style; none where nothing is out of focus.
    pub fn new(values: &Values, context: &EffectContext<'_>) -> Option<Circles> {
        let screen_px = |length| {
            let (px, world) = (context.screen)(length);
            px + world / context.depths.pixel_world
        };
        let blur_px = screen_px(values.length("blur")).min(screen_px(WIDEST));
        let depths = &context.depths;
        let measure = |depth: f64| measure(depths.orthographic, depth.max(depths.near));
        let &[first, sharp_from, sharp_to, last] = values.numbers("layers") else { return None };
        let layer = |layer: f64| measure(depths.middle + (2.0 * layer - 1.0) * depths.radius);
        let focus = match values.get("focus") {
            Some(Value::Length(length)) => Some((context.world)(*length)),
            Some(Value::Selector(_)) => Some(context.looked_at.unwrap_or(depths.middle)),
            Some(Value::Choice(index)) if FOCUS[*index] == "center" => Some(depths.middle),
            _ => None,
        };
        let circles = match focus {
            Some(depth) => {
                let focus = measure(depth);
                let farther = (layer(first) - focus).abs().max((layer(last) - focus).abs());
                let most_px = screen_px(WIDEST);
                Circles {
                    orthographic: depths.orthographic,
                    sharp: [focus; 2],
                    slopes_px: [blur_px / farther.max(f64::from(f32::MIN_POSITIVE)); 2],
                    most_px: [most_px; 2],
                }
            }
            None => {
                let slope = |from: f64, to: f64| (blur_px / (layer(to) - layer(from))).min(STEEPEST);
                Circles {
                    orthographic: depths.orthographic,
                    sharp: [layer(sharp_from), layer(sharp_to)],
                    slopes_px: [slope(first, sharp_from), slope(sharp_to, last)],
                    most_px: [blur_px; 2],
                }
            }
        };
        (blur_px > 0.0).then_some(circles)
    }

    /// The diameter at a depth.
    pub fn diameter_px(&self, depth: f64) -> f64 {
        let measure = measure(self.orthographic, depth);
        let [near, far] = [self.sharp[0] - measure, measure - self.sharp[1]];
        (self.slopes_px[1] * far.max(0.0)).min(self.most_px[1])
            - (self.slopes_px[0] * near.max(0.0)).min(self.most_px[0])
    }

    /// The linear colour in which layers are shown of what lies at a depth and has this one: of the layer, as bright as its own.
    pub fn layer_color(&self, depth: f64, color: DVec3) -> DVec3 {
        let diameter_px = self.diameter_px(depth);
        let most_px = self.most_px[usize::from(diameter_px > 0.0)];
        let layer = match diameter_px.abs() {
            blur if blur <= LEAST_PX => 2,
            blur => {
                let is_transition = usize::from(blur < 0.999 * most_px);
                if diameter_px < 0.0 { is_transition } else { 4 - is_transition }
            }
        };
        DVec3::from_array(LAYER_COLORS[layer]) * (0.3 + 0.7 * color.dot(DVec3::new(0.2126, 0.7152, 0.0722)))
    }

    /// The widest of what lies between two depths.
    fn widest_px(&self, from: f64, to: f64) -> f64 {
        self.diameter_px(from).abs().max(self.diameter_px(to).abs())
    }
}

/// Linear colours of the layers, from near to far.
const LAYER_COLORS: [[f64; 3]; 5] =
    [[0.78, 0.09, 0.09], [0.95, 0.45, 0.10], [0.75, 0.85, 0.75], [0.12, 0.50, 0.80], [0.05, 0.12, 0.55]];

/// A growth that is a step.
const STEEPEST: f64 = 1e30;

/// See [`Circles`].
pub fn measure(orthographic: bool, depth: f64) -> f64 {
    if orthographic { depth } else { -1.0 / depth }
}

gpu_struct! {
    "effects/focus.wgsl",
    /// See `shaders/effects/focus.wgsl`.
    pub struct FocusParams {
        /// Measures between which all is sharp.
        pub sharp: [f32; 2],
        /// Growth of the diameter before and behind, in pixels for each unit of the measure.
        pub slopes_px: [f32; 2],
        /// Largest diameters before and behind, in pixels.
        pub most_px: [f32; 2],
        /// Largest radii of the scene, before and behind.
        pub widest_px: [f32; 2],
        /// Most taps of a pixel.
        pub taps: u32,
        /// Tiles to each side that a blur can come from.
        pub tiles: u32,
    }
}

/// The effect's registry entry.
pub struct Focus;

/// The published layers.
const FIVE_LAYER: u32 = 1;
/// Colours instead of the picture.
const SHOWS_LAYERS: u32 = 1 << 1;
/// Lists of what is transparent.
const GLASS: u32 = 1 << 3;
/// The same, and lines that were drawn before.
const LINED_GLASS: u32 = 1 << 4;

impl PostEffect for Focus {
    fn name(&self) -> &'static str {
        "dofPost"
    }
    fn file(&self) -> &'static str {
        "focus"
    }
    fn doc(&self) -> &'static str {
        "Blurs what is out of focus."
    }
    fn params(&self) -> &'static [Param] {
        PARAMS
    }
    fn wgsl(&self, features: u32) -> &'static [Wgsl] {
        const LAYERS: &[Wgsl] = &[wgsl!("effects/focus_layers.wgsl"), wgsl!("effects/focus.wgsl")];
        const GATHER: &[Wgsl] =
            &[wgsl!("lib/noise.wgsl"), wgsl!("effects/focus_gather.wgsl"), wgsl!("effects/focus.wgsl")];
        const SHOWN: &[Wgsl] = &[wgsl!("effects/focus.wgsl")];
        const GLASS: &[Wgsl] = &[
            wgsl!("lib/noise.wgsl"),
            wgsl!("lib/layers.wgsl"),
            wgsl!("lib/layer_lists.wgsl"),
            wgsl!("effects/focus_gather.wgsl"),
            wgsl!("effects/focus_glass.wgsl"),
            wgsl!("effects/focus_no_lines.wgsl"),
            wgsl!("effects/focus.wgsl"),
        ];
        const LINED_GLASS: &[Wgsl] = &[
            wgsl!("lib/noise.wgsl"),
            wgsl!("lib/layers.wgsl"),
            wgsl!("lib/layer_lists.wgsl"),
            wgsl!("effects/focus_gather.wgsl"),
            wgsl!("effects/focus_glass.wgsl"),
            wgsl!("effects/focus_lines.wgsl"),
            wgsl!("effects/focus.wgsl"),
        ];
        match features {
            _ if features & SHOWS_LAYERS != 0 => SHOWN,
            _ if features & FIVE_LAYER != 0 => LAYERS,
            _ if features & self::LINED_GLASS != 0 => LINED_GLASS,
            _ if features & self::GLASS != 0 => GLASS,
            _ => GATHER,
        }
    }
    fn params_info(&self) -> StructInfo {
        FocusParams::info()
    }
    fn uniform(&self, values: &Values, context: &EffectContext<'_>) -> Vec<u8> {
        let nothing = Circles { orthographic: false, sharp: [0.0; 2], slopes_px: [0.0; 2], most_px: [0.0; 2] };
        let circles = Circles::new(values, context).unwrap_or(nothing);
        let floats = |[a, b]: [f64; 2]| [a as f32, b as f32];
        let reach_px = 0.5 * circles.most_px[0].max(circles.most_px[1]);
        let (front, back) = (context.depths.front(), context.depths.back());
        bytemuck::bytes_of(&FocusParams {
            sharp: floats(circles.sharp),
            slopes_px: floats(circles.slopes_px),
            most_px: floats(circles.most_px),
            widest_px: floats([-circles.diameter_px(front), circles.diameter_px(back)].map(|px| 0.5 * px.max(0.0))),
            taps: TAPS,
            tiles: (reach_px / f64::from(TILE_PX)).ceil() as u32 + 1,
        })
        .to_vec()
    }
    fn looks_at<'a>(&self, values: &'a Values) -> Option<&'a Selector> {
        match values.get("focus") {
            Some(Value::Selector(selector)) => Some(selector),
            _ => None,
        }
    }
    fn reach_px(&self, values: &Values, context: &EffectContext<'_>) -> u32 {
        let most_px = Circles::new(values, context).map_or(0.0, |circles| circles.most_px[0].max(circles.most_px[1]));
        // Half a circle, the tiles that it is looked for in, and the square over which noise is evened out.
        (0.5 * most_px).ceil() as u32 + 2 * TILE_PX + 4
    }
    fn passes(&self, features: u32) -> &'static [EffectPass] {
        const PACKED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
        const fn own(name: &'static str, entry: &'static str) -> EffectPass {
            EffectPass { name, entry, target: PassTarget::Own { format: PACKED, pixels: [1, 1] } }
        }
        const fn of_tiles(name: &'static str, entry: &'static str) -> EffectPass {
            let format = wgpu::TextureFormat::Rg32Float;
            EffectPass { name, entry, target: PassTarget::Own { format, pixels: [TILE_PX; 2] } }
        }
        const fn end(name: &'static str, entry: &'static str) -> EffectPass {
            EffectPass { name, entry, target: PassTarget::Picture }
        }
        const LAYERS: &[EffectPass] = &[
            own("near_across", "blur_near_across"),
            own("near_layer", "blur_near_down"),
            own("far_across", "blur_far_across"),
            own("far_layer", "blur_far_down"),
            end("layers_composed", "compose_layers"),
        ];
        const GATHER: &[EffectPass] = &[
            own("circles", "find_circles"),
            of_tiles("widest", "find_widest"),
            of_tiles("reaching", "find_reaching"),
            own("fields", "gather_fields"),
            end("focused", "compose_fields"),
        ];
        const SHOWN: &[EffectPass] = &[end("layers_shown", "show_layers")];
        const GLASS: &[EffectPass] = &[
            own("circles", "find_circles"),
            of_tiles("widest", "find_widest"),
            of_tiles("reaching", "find_reaching"),
            own("fields", "gather_fields"),
            of_tiles("glass_widest", "find_glass_widest"),
            of_tiles("glass_reaching", "find_glass_reaching"),
            own("near_glass", "gather_near_glass"),
            own("far_glass", "gather_far_glass"),
            end("focused_glass", "compose_glass"),
        ];
        match features {
            _ if features & SHOWS_LAYERS != 0 => SHOWN,
            _ if features & FIVE_LAYER != 0 => LAYERS,
            _ if features & (self::GLASS | LINED_GLASS) != 0 => GLASS,
            _ => GATHER,
        }
    }
    fn unread(&self, features: u32, pass: &EffectPass) -> &'static [&'static str] {
        let is_lined = self.reads_lists(features).is_some_and(|read| read.lines);
        match pass.name {
            "glass_widest" | "glass_reaching" => {
                &["geometry", "color", "ids", "circles", "widest", "reaching", "fields"]
            }
            "near_glass" | "far_glass" => {
                &["geometry", "color", "ids", "widest", "reaching", "glass_widest", "near_glass"]
            }
            "focused_glass" if is_lined => &["geometry", "ids", "widest", "glass_widest", "glass_reaching"],
            "focused_glass" => &["ids", "widest", "glass_widest", "glass_reaching"],
            _ => &[],
        }
    }
    fn aov(&self, features: u32) -> Option<EffectAov> {
        let entry = if self.reads_lists(features).is_some() { "glass_aov" } else { "focus_aov" };
        Some(EffectAov { name: "coc", entry })
    }
    fn with_lists(&self, features: u32, lines: bool) -> Option<u32> {
        let is_gather = features & (FIVE_LAYER | SHOWS_LAYERS) == 0;
        is_gather.then_some(features | if lines { LINED_GLASS } else { GLASS })
    }
    fn reads_lists(&self, features: u32) -> Option<ListsRead> {
        let is_gather = features & (FIVE_LAYER | SHOWS_LAYERS) == 0;
        let read = ListsRead { lines: features & LINED_GLASS != 0 };
        (is_gather && features & (GLASS | LINED_GLASS) != 0).then_some(read)
    }
    fn changes_nothing(&self, values: &Values, context: &EffectContext<'_>) -> Option<&'static str> {
        if values.choice("show") == "layers" {
            return None;
        }
        let depths = &context.depths;
        let widest_px =
            Circles::new(values, context).map_or(0.0, |circles| circles.widest_px(depths.front(), depths.back()));
        (widest_px < LEAST_PX).then_some("nothing of the scene is blurred by half a pixel")
    }
    fn features(&self) -> &'static [&'static str] {
        &["FOCUS_FIVE_LAYER", "FOCUS_SHOWN", PUBLISHED, "FOCUS_GLASS", "FOCUS_LINED_GLASS"]
    }
    fn features_used(&self, values: &Values, _context: &EffectContext<'_>) -> u32 {
        let method = if values.choice("method") == "five_layer" { FIVE_LAYER } else { 0 };
        method | if values.choice("show") == "layers" { SHOWS_LAYERS } else { 0 }
    }
}

/// The form of `five_layer` as published, for measurements: no style has this feature.
pub const PUBLISHED: &str = "FOCUS_PUBLISHED";
