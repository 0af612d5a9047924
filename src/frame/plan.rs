//! The passes of one frame and what they need, found before anything is made.

use super::bkb::{BkbKey, BkbPlan};
use super::contents::Needs;
use super::input::{FrameInput, LayerMethod};
use super::layers::LayersPlan;
use super::post::{self, EffectKey, Finish, LayersAt};
use super::shade::ShadeKey;
use super::shadow::{ShadowPlan, ShadowQuality, ShadowView};
use super::targets::Chain;
use super::visibility::{Drawn, VisibilityKey};
use super::{MAX_LIGHTS, MAX_SAMPLES};
use crate::effects::EFFECTS;
use crate::gpu::Gpu;
use crate::scene::LightPlace;

/// The passes of one frame and what they need.
pub struct Plan {
    /// Samples a pixel.
    pub samples: u32,
    /// Straight to picture values, without a target in which samples add up.
    pub direct: bool,
    pub shadows: ShadowPlan,
    pub map_size: u32,
    pub shade: ShadeKey,
    pub seen: VisibilityKey,
    pub effects: Vec<EffectKey>,
    pub layers: Option<LayersPlan>,
    /// Buckets that what is transparent is blended from, instead of from lists.
    pub bkb: Option<BkbPlan>,
}

impl Plan {
    /// `can_keep` says whether lists of what is transparent can be kept for effects that read them.
    pub fn new(gpu: &Gpu, needs: &Needs, input: &FrameInput<'_>, quality: ShadowQuality, can_keep: bool) -> Plan {
        let samples = input.samples.clamp(1, MAX_SAMPLES);
        let direct = samples == 1 && !input.wide;
        let map_size = quality.map_size(gpu, input.size[1]);
        let shadows = ShadowPlan::new(input.lighting, input.camera, input.bounds, map_size);
        let shadowed = !shadows.views.is_empty();
        let orthographic = input.camera.orthographic;
        let shade = ShadeKey {
            lights: input.lighting.lights.len().min(MAX_LIGHTS) as u32,
            point_lights: input.lighting.lights.iter().any(|light| matches!(light.place, LightPlace::Point { .. })),
            ambient: input.lighting.ambient != glam::Vec3::ZERO,
            shadows: shadowed,
            soft_taps: if shadowed { quality.soft_taps(samples) } else { 0 },
            shadow_filter: quality.filter,
            orthographic,
            encode: direct && input.effects.is_empty() && !needs.layered,
            geometry: !input.effects.is_empty() || needs.layered,
            ..needs.key.clone()
        };
        let drawn = if needs.layered { Drawn::Opaque } else { Drawn::All };
        let seen = VisibilityKey { hulls: shade.hulls, orthographic, light: false, drawn };
        let before = input.effects.iter().take_while(|effect| EFFECTS[effect.effect].is_before_layers()).count();
        let mut effects = post::keys(input.effects, orthographic, direct, needs.layered.then_some(before));
        let may_keep = needs.layered && can_keep && input.layer_method == LayerMethod::Packed;
        let apart = if may_keep { post::keep_apart(&mut effects, before) } else { None };
        let finish = match (before == input.effects.len(), direct) {
            (false, _) => Finish::Next,
            (true, false) => Finish::Add,
            (true, true) => Finish::Encode,
        };
        let surfaces = apart.map_or(finish == Finish::Next, |apart| apart.lines);
        let layers = needs.layered.then(|| LayersPlan::new(&shade, seen, finish, surfaces, before, apart));
        let bkb = match input.layer_method {
            LayerMethod::Bkb { k, form } if needs.layered => {
                let shade = ShadeKey { hulls: false, encode: false, geometry: false, ..shade.clone() };
                Some(BkbPlan {
                    key: BkbKey { shade, form, finish, keeps_kappa: false },
                    k,
                    num_materials: needs.num_materials,
                    curvature_scale: input.bounds.radius * input.curvature_gain,
                })
            }
            _ => None,
        };
        Plan { samples, direct, shadows, map_size, shade, seen, effects, layers, bkb }
    }

    /// Has counts and ids of nearest surfaces found, and curvatures kept.
    pub fn ask_for_aovs(&mut self) {
        if let Some(layers) = &mut self.layers {
            layers.for_aovs = true;
        }
        if let Some(bkb) = &mut self.bkb {
            bkb.key.keeps_kappa = !bkb.key.form.is_dual_pass();
        }
    }

    /// The lists of what is transparent, where the frame makes them: without buckets, or where nearest surfaces are asked for.
    pub fn lists(&self) -> Option<&LayersPlan> {
        self.layers.as_ref().filter(|layers| self.bkb.is_none() || layers.has_nearest())
    }

    /// How a light sees the scene. Outlines cast no shadows, nor does what is transparent.
    pub fn lit(&self, shadow: &ShadowView) -> VisibilityKey {
        VisibilityKey { hulls: false, orthographic: shadow.light.orthographic > 0.5, light: true, ..self.seen }
    }

    /// Whether layers stay apart for an effect that reads their lists.
    pub fn is_apart(&self) -> bool {
        self.layers.as_ref().is_some_and(|layers| layers.apart.is_some())
    }

    /// Where layers stand among the effects.
    pub fn layers_at(&self) -> Option<LayersAt> {
        self.layers.as_ref().map(|layers| LayersAt {
            effects: layers.after_effects,
            surfaces: layers.leaves_surfaces(),
            apart: layers.apart.is_some(),
        })
    }

    /// How often the picture of a sample is changed.
    pub fn chain(&self) -> Chain {
        let at = self.layers_at();
        if let Some(LayersPlan { after_effects, apart: Some(apart), .. }) = &self.layers {
            let surfaces = post::num_left(&self.effects[..*after_effects]);
            return Chain { pictures: after_effects + 1, surfaces, lines: apart.lines };
        }
        Chain {
            pictures: self.effects.len() + usize::from(at.is_some()),
            surfaces: post::num_left(&self.effects) + usize::from(at.is_some_and(|at| at.surfaces)),
            lines: false,
        }
    }
}
