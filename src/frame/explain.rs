//! The passes of a frame with their reasons, sizes and bytes, told without drawing any.

use super::bkb::BkbPlan;
use super::layers::{self, LayersPlan};
use super::shadow::{MAX_SHADOWS, ShadowMaps};
use super::{FrameInput, OUTPUT_8, OUTPUT_16, Plan, light_format};
use super::{post::COLOR_FORMAT, post::GEOMETRY_FORMAT, visibility::DEPTH_FORMAT, visibility::ID_FORMAT};
use crate::effects::{EFFECTS, PassTarget};
use crate::gpu::Gpu;
use crate::shading::SHADERS;

/// A pass that a frame has, or could have and has not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// What it is called, as in timings where it is timed.
    pub name: String,
    /// Whether the frame has it.
    pub is_drawn: bool,
    /// Width and height of what it draws to, in pixels; none of what is left out, or is part of another pass.
    pub size: Option<[u32; 2]>,
    /// Bytes of the targets that exist for its sake.
    pub bytes: u64,
    /// Why the frame has it, or has it not.
    pub reason: String,
}

impl Step {
    /// A pass that a frame has.
    pub fn drawn(name: &str, size: [u32; 2], bytes: u64, reason: impl Into<String>) -> Step {
        Step { name: name.to_owned(), is_drawn: true, size: Some(size), bytes, reason: reason.into() }
    }

    /// A pass that a frame has not.
    pub fn left_out(name: &str, reason: impl Into<String>) -> Step {
        Step { name: name.to_owned(), is_drawn: false, size: None, bytes: 0, reason: reason.into() }
    }
}

/// Bytes of a target.
fn bytes_of(size: [u32; 2], format: wgpu::TextureFormat) -> u64 {
    // A depth format has no block size to copy, and four bytes.
    u64::from(size[0]) * u64::from(size[1]) * u64::from(format.block_copy_size(None).unwrap_or(4))
}

fn plural(count: u64, of: &str) -> String {
    format!("{count} {of}{}", if count == 1 { "" } else { "s" })
}

/// The steps of a frame of this plan, in order; `counts` are its spheres, cylinders and triangles. Post effects that are left out
/// are not among them: what is listed is known to the style alone.
pub fn steps(gpu: &Gpu, plan: &Plan, input: &FrameInput<'_>, counts: [u64; 3]) -> Vec<Step> {
    let size = input.drawn_size();
    let mut steps = shadow_steps(plan, input);

    let [spheres, cylinders, triangles] = counts;
    let seen: Vec<String> = [(spheres, "sphere"), (cylinders, "cylinder"), (triangles, "triangle")]
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, of)| plural(count, of))
        .collect();
    let seen = if seen.is_empty() { "nothing to see".to_owned() } else { seen.join(", ") };
    let bytes = bytes_of(size, ID_FORMAT) + bytes_of(size, DEPTH_FORMAT);
    steps.push(Step::drawn("visibility", size, bytes, format!("{seen}: which of them each pixel sees")));
    steps.push(if plan.seen.hulls {
        let reason = "a shader has a hull outline: back faces of enlarged objects, in the same pass";
        Step { size: None, ..Step::drawn("hull outlines", size, 0, reason) }
    } else {
        Step::left_out("hull outlines", "no shader has one")
    });

    let shaders: Vec<&str> = plan.shade.shaders.iter().map(|needs| SHADERS[needs.shader].name()).collect();
    let lights = plural(u64::from(plan.shade.lights), "light");
    let chain = plan.chain();
    let of_effects = match chain.pictures {
        0 => 0,
        count => {
            (1 + chain.surfaces.min(1)) as u64 * bytes_of(size, GEOMETRY_FORMAT)
                + count.min(2) as u64 * bytes_of(size, COLOR_FORMAT)
                + if chain.lines { 2 * (bytes_of(size, GEOMETRY_FORMAT) + bytes_of(size, COLOR_FORMAT)) } else { 0 }
        }
    };
    let beside = if of_effects > 0 { ", with the surface beside it for post effects" } else { "" };
    let reason = format!("{} in {lights}, once for each pixel that sees something{beside}", shaders.join(", "));
    let output = bytes_of(size, if input.wide { OUTPUT_16 } else { OUTPUT_8 });
    // The picture itself is written by shading where nothing comes after it.
    let is_last = plan.direct && chain.pictures == 0;
    steps.push(Step::drawn("shade", size, of_effects + if is_last { output } else { 0 }, reason));

    let mut layers = layer_steps(gpu, plan, size, input.layer_bytes);
    let layers_after = plan.layers.as_ref().map_or(plan.effects.len(), |layers| layers.after_effects);
    let is_end = plan.direct && plan.layers.is_some() && layers_after == plan.effects.len();
    if let Some(last) = layers.last_mut().filter(|_| is_end) {
        last.bytes += output;
    }
    for (index, key) in plan.effects.iter().enumerate() {
        if index == layers_after {
            steps.extend(layers.clone());
        }
        let effect = EFFECTS[key.effect];
        for pass in effect.passes(key.features) {
            let is_end = pass.target == PassTarget::Picture;
            let (target, mut bytes) = match pass.target {
                PassTarget::Own { format, pixels } => {
                    let target = [0, 1].map(|axis| size[axis].div_ceil(pixels[axis].max(1)));
                    (target, bytes_of(target, format))
                }
                PassTarget::Picture => (size, 0),
            };
            if is_end && plan.direct && index + 1 == plan.effects.len() {
                bytes += output;
            }
            steps.push(Step::drawn(pass.name, target, bytes, format!("{} is listed in post_effects", effect.name())));
        }
    }

    if layers_after == plan.effects.len() {
        steps.extend(layers);
    }

    steps.push(if plan.direct {
        Step::left_out("resolve", "one sample of 8 bits a channel is written straight away")
    } else {
        let reason = match plan.samples {
            1 => "16 bits a channel are asked for".to_owned(),
            samples => format!("{samples} samples add up, each through all passes from visibility on"),
        };
        Step::drawn("resolve", size, bytes_of(size, light_format(gpu)) + output, reason)
    });
    steps
}

/// The passes of what is transparent. How many fragments there are is known when they are counted.
fn layer_steps(gpu: &Gpu, plan: &Plan, size: [u32; 2], memory_bytes: u64) -> Vec<Step> {
    let (Some(_), layers) = (&plan.layers, plan.lists()) else {
        return vec![Step::left_out("layers", "nothing is transparent")];
    };
    let mut steps = layers.map_or_else(Vec::new, |layers| list_steps(layers, size));
    steps.extend(plan.bkb.iter().flat_map(|bkb| bkb_steps(bkb, size, bkb.bands(gpu, size, memory_bytes))));
    steps
}

/// The passes that keep all fragments in lists.
fn list_steps(layers: &LayersPlan, size: [u32; 2]) -> Vec<Step> {
    let lists = layers::list_bytes(u64::from(size[0]) * u64::from(size[1])).iter().sum();
    let mut steps = vec![
        Step::drawn(
            "layers_counted",
            size,
            lists,
            "some objects have an opacity below 1: how many surfaces each pixel has",
        ),
        Step::drawn("layers_room", size, 0, "each pixel's list gets its place in the pool"),
        Step::drawn("layers_written", size, 0, "8 bytes for each fragment, in a pool of as many as there are"),
    ];
    steps.push(Step::drawn("layers_sorted", size, 0, "each list is put in order, short ones in registers"));
    if layers.mark.is_some() {
        let reason = "curvature is found from neighbouring pixels: 8 bytes more a fragment, of its normal and object";
        steps.push(Step::drawn("layers_marked", size, 0, reason));
    }
    steps.push(match layers.apart {
        Some(_) => {
            let reason =
                "each list is shaded and kept, with 8 bytes more a fragment, for an effect that sees each at its own depth";
            Step::drawn("layers_kept", size, 0, reason)
        }
        None => Step::drawn("layers_blended", size, 0, "each list is shaded and blended until no light comes through"),
    });
    if layers.leaves_surfaces() {
        let reason = "a post effect follows, which sees the nearest surface";
        steps.push(Step::drawn("layers_nearest", size, 0, reason));
    }
    steps
}

/// The passes of the bucketed k-buffer, in so many bands, of which one takes so many bytes.
fn bkb_steps(bkb: &BkbPlan, size: [u32; 2], (num_bands, bytes): (usize, u64)) -> Vec<Step> {
    let k = plural(u64::from(bkb.k), "fragment");
    let in_bands = if num_bands > 1 { format!(", in {num_bands} bands of rows") } else { String::new() };
    let cleared = format!("the style asks for bkb: room for the nearest {k} of each pixel{in_bands}");
    let mut steps = vec![
        Step::drawn("bkb_cleared", size, bytes, cleared),
        Step::drawn("bkb_inserted", size, 0, "depth and shape of each fragment, sorted as they come"),
    ];
    let is_bucketed = !bkb.key.form.is_dual_pass();
    if is_bucketed {
        steps.push(Step::drawn("bkb_bucketed", size, 0, "each list is put in the order of shapes, a bucket for each"));
    }
    steps.push(Step::drawn("bkb_stored", size, 0, "colour and normal of each fragment that was kept"));
    if is_bucketed {
        let reason = "colour and opacity by the curvature that neighbours tell";
        steps.push(Step::drawn("bkb_stylised", size, 0, reason));
    }
    steps.push(Step::drawn("bkb_blended", size, 0, "each list is sorted by depth and blended from far to near"));
    steps
}

fn shadow_steps(plan: &Plan, input: &FrameInput<'_>) -> Vec<Step> {
    let size = [plan.map_size; 2];
    let mut steps = Vec::new();
    for (number, (light, layer)) in (1..).zip(input.lighting.lights.iter().zip(&plan.shadows.layers)) {
        let Some(shadow) = light.shadow else { continue };
        let kind = if shadow.softness_rad > 0.0 { "soft" } else { "hard" };
        steps.push(match layer {
            Some(layer) => {
                let bytes = ShadowMaps::layer_bytes(plan.map_size, *layer == 0);
                Step::drawn(
                    "shadow",
                    size,
                    bytes,
                    format!("light {number} casts a {kind} shadow; once for all samples"),
                )
            }
            None => {
                let reason = match plan.shadows.views.len() < MAX_SHADOWS {
                    true => "it is within the scene's sphere",
                    false => "as many as can be cast theirs already",
                };
                Step::left_out("shadow", format!("light {number} asks for a {kind} shadow, but {reason}"))
            }
        });
    }
    if steps.is_empty() {
        steps.push(Step::left_out("shadow", "no light casts one"));
    }
    steps
}
