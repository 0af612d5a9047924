//! Post effects of a frame: after each sample is shaded, one after the other changes its picture, and the last adds it up.

use std::collections::BTreeMap;

use super::fullscreen;
use super::layers::{self, Apart};
use super::targets::Target;
use super::visibility::{SceneBindings, Visibility};
use crate::effects::{EFFECTS, EffectPass, ListsRead, PassTarget, PostEffect};
use crate::gpu::{Bound, Gpu, GpuError, KeptBindGroup, KeptBuffer, Module, PassTimer};
use crate::wgsl;

/// The light of one sample, premultiplied.
pub const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// The surface of one sample: see `shaders/lib/geometry.wgsl`.
pub const GEOMETRY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;

/// What an effect finds, one number a pixel.
const AOV_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// A post effect as a frame uses it.
#[derive(Debug, Clone, PartialEq)]
pub struct Effect {
    /// Its place in the registry.
    pub effect: usize,
    /// The features that it uses, one bit each.
    pub features: u32,
    /// Its parameters as its WGSL reads them.
    pub params: Vec<u8>,
    /// How far what a pixel sees changes others, in pixels.
    pub reach_px: u32,
}

/// Where the picture goes that an effect leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Finish {
    /// To the next effect.
    Next,
    /// To the other samples.
    Add,
    /// To the picture, as values of 8 bits.
    Encode,
}

impl Finish {
    /// As WGSL has it.
    pub fn number(self) -> u32 {
        match self {
            Finish::Next => 0,
            Finish::Add => 1,
            Finish::Encode => 2,
        }
    }
}

/// The target of what ends so.
pub fn target_of(gpu: &Gpu, finish: Finish) -> wgpu::ColorTargetState {
    match finish {
        Finish::Next => COLOR_FORMAT.into(),
        Finish::Add => super::adding_light(gpu),
        Finish::Encode => super::OUTPUT_8.into(),
    }
}

/// Where layers stand in a chain of effects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LayersAt {
    /// How many effects are before them.
    pub effects: usize,
    /// Whether they leave the nearest surface for what follows.
    pub surfaces: bool,
    /// Whether they stay apart until the last effect, and what effects between draw is a picture of lines alone.
    pub apart: bool,
}

/// How many pictures, and how many surfaces, were drawn before the effect of an index, after the first.
fn hops(keys: &[EffectKey], index: usize, layers: Option<LayersAt>) -> [usize; 2] {
    let layers = layers.filter(|layers| layers.effects <= index && !layers.apart);
    [
        index + usize::from(layers.is_some()),
        num_left(&keys[..index]) + usize::from(layers.is_some_and(|layers| layers.surfaces)),
    ]
}

/// What the pipelines of an effect are built for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct EffectKey {
    /// Its place in the registry.
    pub effect: usize,
    /// The features that it uses, one bit each.
    pub features: u32,
    /// Whether the camera is orthographic.
    pub orthographic: bool,
    /// Where its picture goes.
    pub finish: Finish,
    /// Whether it also leaves the surfaces, for the next effect.
    pub leaves_surfaces: bool,
}

/// The keys of a chain of effects, in which layers may come after so many.
pub fn keys(effects: &[Effect], orthographic: bool, encode: bool, layers: Option<usize>) -> Vec<EffectKey> {
    let last = if layers == Some(effects.len()) { effects.len() } else { effects.len().saturating_sub(1) };
    let finish = |index: usize| match (index == last, encode) {
        (false, _) => Finish::Next,
        (true, false) => Finish::Add,
        (true, true) => Finish::Encode,
    };
    effects
        .iter()
        .enumerate()
        .map(|(index, effect)| EffectKey {
            effect: effect.effect,
            features: effect.features,
            orthographic,
            finish: finish(index),
            leaves_surfaces: index < last && EFFECTS[effect.effect].surfaces_entry().is_some(),
        })
        .collect()
}

/// Has the last of some effects read the lists of what is transparent, where it can, and those between it and layers draw lines alone.
pub fn keep_apart(keys: &mut [EffectKey], after_effects: usize) -> Option<Apart> {
    let between = keys.len().checked_sub(1)?.checked_sub(after_effects)?;
    let (last, others) = keys.split_last_mut()?;
    let lines = between > 0;
    if !others[after_effects..].iter().all(|key| key.leaves_surfaces) {
        return None;
    }
    last.features = EFFECTS[last.effect].with_lists(last.features, lines)?;
    Some(Apart { lines })
}

/// First binding of the textures that an effect's own passes drew.
const FIRST_OWN_BINDING: u32 = 5;

/// A pipeline for each pass, with the layout of what it reads.
type Pipelines = Vec<(wgpu::BindGroupLayout, wgpu::RenderPipeline)>;

/// What one effect of the chain keeps from frame to frame.
struct Slot {
    /// The passes and the picture's size that its textures are for.
    fits: Option<(&'static [EffectPass], [u32; 2])>,
    params: KeptBuffer,
    own: Vec<Target>,
    groups: Vec<KeptBindGroup>,
}

/// What the passes of a frame's effects bind.
pub struct EffectGroups {
    /// For each effect, a group for each pass.
    passes: Vec<Vec<wgpu::BindGroup>>,
    /// Lists of what is transparent, for the effect that reads them.
    lists: Option<wgpu::BindGroup>,
}

impl EffectGroups {
    /// What an effect of a key binds beside the scene and a pass's own group.
    fn lists_of(&self, key: &EffectKey) -> Option<&wgpu::BindGroup> {
        self.lists.as_ref().filter(|_| reads_lists(key).is_some())
    }
}

/// What all effects of a frame read and draw to.
#[derive(Clone, Copy)]
pub struct PostTargets<'a> {
    /// Ids of the visibility pass.
    pub ids: &'a wgpu::TextureView,
    /// The surfaces that were shaded, and another texture of them where an effect leaves its own.
    pub geometry: &'a [wgpu::TextureView],
    /// The picture that was shaded, and another one where there are more effects than one.
    pub colors: &'a [wgpu::TextureView],
    /// The nearest surfaces with lines, and pictures of lines, where those are drawn apart.
    pub line_geometry: &'a [wgpu::TextureView],
    /// Their pictures.
    pub line_colors: &'a [wgpu::TextureView],
    /// Where the last effect draws.
    pub last: &'a wgpu::TextureView,
    /// The background, for the last effect.
    pub output: &'a wgpu::Buffer,
}

impl<'a> PostTargets<'a> {
    /// The picture and the surfaces that effects before one left to it: of lines alone, where layers stay apart before.
    fn before(&self, keys: &[EffectKey], index: usize, layers: Option<LayersAt>) -> [Option<&'a wgpu::TextureView>; 2] {
        if let Some(layers) = layers.filter(|layers| layers.apart && layers.effects <= index) {
            let between = &keys[layers.effects..index];
            return [turn(self.line_colors, between.len()), turn(self.line_geometry, num_left(between))];
        }
        let [colors, surfaces] = hops(keys, index, layers);
        [turn(self.colors, colors), turn(self.geometry, surfaces)]
    }

    /// Where an effect leaves its own.
    fn after(&self, keys: &[EffectKey], index: usize, layers: Option<LayersAt>) -> [Option<&'a wgpu::TextureView>; 2] {
        if let Some(layers) = layers.filter(|layers| layers.apart && layers.effects <= index) {
            let between = &keys[layers.effects..index];
            return [turn(self.line_colors, between.len() + 1), turn(self.line_geometry, num_left(between) + 1)];
        }
        let [colors, surfaces] = hops(keys, index, layers);
        [turn(self.colors, colors + 1), turn(self.geometry, surfaces + 1)]
    }

    /// What an effect reads: that, or what is opaque alone where it reads lists.
    fn read_by(
        &self,
        keys: &[EffectKey],
        index: usize,
        layers: Option<LayersAt>,
    ) -> [Option<&'a wgpu::TextureView>; 2] {
        match layers.filter(|layers| layers.apart && index + 1 == keys.len()) {
            Some(layers) => [turn(self.colors, layers.effects), self.geometry.first()],
            None => self.before(keys, index, layers),
        }
    }
}

/// Pipelines and textures of post effects.
#[derive(Default)]
pub struct Post {
    pipelines: BTreeMap<EffectKey, Pipelines>,
    slots: Vec<Slot>,
    lists: KeptBindGroup,
}

impl Post {
    /// Builds the pipelines of an effect, unless they are there.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    pub fn prepare(&mut self, gpu: &Gpu, visibility: &Visibility, key: &EffectKey) -> Result<(), GpuError> {
        if !self.pipelines.contains_key(key) {
            self.pipelines.insert(*key, build(gpu, visibility, key)?);
        }
        Ok(())
    }

    /// Pipelines that are there built anew, from the shaders as they are now.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile; nothing has changed then.
    pub fn rebuild(&mut self, gpu: &Gpu, visibility: &Visibility) -> Result<(), GpuError> {
        let fresh: Result<BTreeMap<_, _>, GpuError> =
            self.pipelines.keys().map(|key| Ok((*key, build(gpu, visibility, key)?))).collect();
        self.pipelines = fresh?;
        Ok(())
    }

    /// Makes the effects' own textures fit; returns their bytes.
    pub fn fit(&mut self, gpu: &Gpu, size: [u32; 2], keys: &[EffectKey]) -> u64 {
        self.slots.resize_with(keys.len(), || Slot {
            fits: None,
            params: KeptBuffer::uniform("effect"),
            own: Vec::new(),
            groups: Vec::new(),
        });
        for (slot, key) in self.slots.iter_mut().zip(keys) {
            let passes = EFFECTS[key.effect].passes(key.features);
            if slot.fits == Some((passes, size)) {
                continue;
            }
            let own = passes.iter().filter_map(|pass| match pass.target {
                PassTarget::Own { format, pixels } => {
                    let size = [0, 1].map(|axis| size[axis].div_ceil(pixels[axis].max(1)));
                    Some(Target::new(gpu, pass.name, size, format))
                }
                PassTarget::Picture => None,
            });
            slot.own = own.collect();
            slot.groups = passes.iter().map(|_| KeptBindGroup::default()).collect();
            slot.fits = Some((passes, size));
        }
        self.slots.iter().flat_map(|slot| &slot.own).map(Target::bytes).sum()
    }

    /// Binds the inputs of one frame; none where a pipeline is not there.
    ///
    /// # Errors
    /// Never for uniforms of a fixed size.
    pub fn bind(
        &mut self,
        gpu: &Gpu,
        effects: &[Effect],
        keys: &[EffectKey],
        targets: &PostTargets<'_>,
        (layers, lists): (Option<LayersAt>, Option<Vec<Bound>>),
    ) -> Result<Option<EffectGroups>, GpuError> {
        let mut groups = Vec::with_capacity(keys.len());
        let mut lists_group = None;
        for (index, ((slot, effect), key)) in self.slots.iter_mut().zip(effects).zip(keys).enumerate() {
            let inputs = targets.read_by(keys, index, layers);
            let (Some(pipelines), [Some(color), Some(geometry)]) = (self.pipelines.get(key), inputs) else {
                return Ok(None);
            };
            if let Some(read) = reads_lists(key) {
                let Some(lists) = &lists else { return Ok(None) };
                let mut bound = lists.clone();
                if read.lines {
                    let [Some(lines), Some(surfaces)] = targets.before(keys, index, layers) else { return Ok(None) };
                    bound.extend([lines, surfaces].map(|view| Bound::View(view.clone())));
                }
                let layout = layers::lists_layout(gpu, read.lines);
                lists_group = Some(self.lists.get(gpu, "lists", &layout, (0..).zip(bound).collect()));
            }
            let params = slot.params.set(gpu, &effect.params, 0)?;
            let mut of_effect = Vec::with_capacity(pipelines.len());
            let passes = EFFECTS[key.effect].passes(key.features);
            for (index, ((kept, (layout, _)), pass)) in slot.groups.iter_mut().zip(pipelines).zip(passes).enumerate() {
                let mut bound = vec![
                    (0, Bound::Buffer(params.clone())),
                    (1, Bound::Buffer(targets.output.clone())),
                    (2, Bound::View(geometry.clone())),
                    (3, Bound::View(color.clone())),
                    (4, Bound::View(targets.ids.clone())),
                ];
                let earlier = slot.own.iter().take(index).map(|target| Bound::View(target.view.clone()));
                bound.extend((FIRST_OWN_BINDING..).zip(earlier));
                bound.retain(|(binding, _)| is_read(key, pass, *binding));
                of_effect.push(kept.get(gpu, "effect", layout, bound));
            }
            groups.push(of_effect);
        }
        Ok(Some(EffectGroups { passes: groups, lists: lists_group }))
    }

    /// Draws all passes of some of the effects for view `view_index`; the first view clears the last target.
    #[allow(clippy::too_many_arguments)]
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        keys: &[EffectKey],
        scene: &SceneBindings,
        view_index: usize,
        groups: &EffectGroups,
        targets: &PostTargets<'_>,
        (drawn, layers): (std::ops::Range<usize>, Option<LayersAt>),
        timer: &mut Option<PassTimer>,
    ) {
        let nothing = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let chain = self.slots.iter().zip(keys).zip(&groups.passes).enumerate();
        for (index, ((slot, key), of_passes)) in chain.filter(|(index, _)| drawn.contains(index)) {
            let Some(pipelines) = self.pipelines.get(key) else { return };
            let [next, surfaces] = targets.after(keys, index, layers);
            let last = match key.finish {
                Finish::Next => next.map(|color| (color, nothing)),
                _ if view_index > 0 => Some((targets.last, wgpu::LoadOp::Load)),
                _ => Some((targets.last, nothing)),
            };
            let surfaces = surfaces.filter(|_| key.leaves_surfaces);
            let last = last.into_iter().chain(surfaces.map(|surfaces| (surfaces, nothing))).collect();
            let onto = slot.own.iter().map(|target| vec![(&target.view, nothing)]).chain([last]);
            for (((pass, (_, pipeline)), group), onto) in
                EFFECTS[key.effect].passes(key.features).iter().zip(pipelines).zip(of_passes).zip(onto)
            {
                let times = timer.as_mut().and_then(|timer| timer.pass(pass.name));
                let offset = [SceneBindings::offset(view_index)];
                let mut bound: Vec<(&wgpu::BindGroup, &[u32])> = vec![(&scene.group, &offset), (group, &[])];
                bound.extend(groups.lists_of(key).map(|lists| (lists, &[][..])));
                fullscreen::draw_onto(encoder, pass.name, pipeline, &bound, &onto, times);
            }
        }
    }
}

impl Post {
    /// Draws what the effects of a frame find, each into a texture of its own, by their places in the registry.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    #[allow(clippy::too_many_arguments)]
    pub fn draw_aovs(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        visibility: &Visibility,
        keys: &[EffectKey],
        scene: &SceneBindings,
        groups: &EffectGroups,
        size: [u32; 2],
    ) -> Result<Vec<(usize, wgpu::Texture)>, GpuError> {
        let mut aovs = Vec::new();
        for (key, of_passes) in keys.iter().zip(&groups.passes) {
            let layout = self.pipelines.get(key).and_then(|pipelines| pipelines.last());
            let aov = EFFECTS[key.effect].aov(key.features);
            let (Some(aov), Some((layout, _)), Some(group)) = (aov, layout, of_passes.last()) else {
                continue;
            };
            let lists = reads_lists(key).map(|read| layers::lists_layout(gpu, read.lines));
            let layouts: Vec<_> = [&visibility.layout, layout].into_iter().chain(&lists).collect();
            let pipeline =
                fullscreen::pipeline(gpu, aov.name, &effect_module(key), aov.entry, &layouts, &[AOV_FORMAT.into()])?;
            let texture = gpu.target(aov.name, size, 1, AOV_FORMAT);
            let target = texture.create_view(&Default::default());
            let offset = [SceneBindings::offset(0)];
            let mut bound: Vec<(&wgpu::BindGroup, &[u32])> = vec![(&scene.group, &offset), (group, &[])];
            bound.extend(groups.lists_of(key).map(|lists| (lists, &[][..])));
            fullscreen::draw(encoder, aov.name, &pipeline, &bound, &target, None);
            aovs.push((key.effect, texture));
        }
        Ok(aovs)
    }
}

/// Of textures that are read and drawn to in turn the one at a place of the chain.
pub fn turn(textures: &[wgpu::TextureView], index: usize) -> Option<&wgpu::TextureView> {
    textures.get(index % textures.len().max(1))
}

/// How many of some effects leave surfaces.
pub fn num_left(keys: &[EffectKey]) -> usize {
    keys.iter().filter(|key| key.leaves_surfaces).count()
}

fn build(gpu: &Gpu, visibility: &Visibility, key: &EffectKey) -> Result<Pipelines, GpuError> {
    let module = effect_module(key);
    let passes = EFFECTS[key.effect].passes(key.features);
    let lists = reads_lists(key).map(|read| layers::lists_layout(gpu, read.lines));
    let build = |(index, pass): (usize, &EffectPass)| {
        let uint = fullscreen::texture(wgpu::TextureSampleType::Uint);
        let float = fullscreen::texture(wgpu::TextureSampleType::Float { filterable: false });
        let mut types = vec![fullscreen::UNIFORM, fullscreen::UNIFORM, uint, float, uint];
        types.extend(passes[..index].iter().map(|pass| if is_uint(pass) { uint } else { float }));
        let types = (0..).zip(types).filter(|(binding, _)| is_read(key, pass, *binding));
        let layout = fullscreen::layout_at(gpu, pass.name, types);
        let target: wgpu::ColorTargetState = match pass.target {
            PassTarget::Own { format, .. } => format.into(),
            PassTarget::Picture => target_of(gpu, key.finish),
        };
        let is_last = pass.target == PassTarget::Picture;
        let as_surfaces = EFFECTS[key.effect].surfaces_entry().filter(|_| is_last && key.leaves_surfaces);
        let entry = as_surfaces.unwrap_or(pass.entry);
        let layouts: Vec<_> = [&visibility.layout, &layout].into_iter().chain(&lists).collect();
        let targets: Vec<_> = [target].into_iter().chain(as_surfaces.map(|_| GEOMETRY_FORMAT.into())).collect();
        let pipeline = fullscreen::pipeline(gpu, pass.name, &module, entry, &layouts, &targets)?;
        Ok((layout, pipeline))
    };
    passes.iter().enumerate().map(build).collect()
}

/// Whether a pass has a binding of its effect: a uniform, or a texture that it reads.
fn is_read(key: &EffectKey, pass: &EffectPass, binding: u32) -> bool {
    let passes = EFFECTS[key.effect].passes(key.features);
    let name = match binding.checked_sub(FIRST_OWN_BINDING) {
        Some(own) => passes.get(own as usize).map_or("", |earlier| earlier.name),
        None => ["", "", "geometry", "color", "ids"][binding as usize],
    };
    !EFFECTS[key.effect].unread(key.features, pass).contains(&name)
}

fn reads_lists(key: &EffectKey) -> Option<ListsRead> {
    EFFECTS[key.effect].reads_lists(key.features)
}

fn is_uint(pass: &EffectPass) -> bool {
    let PassTarget::Own { format, .. } = pass.target else { return false };
    format.sample_type(None, None) == Some(wgpu::TextureSampleType::Uint)
}

/// The WGSL of a post effect for a key.
pub fn effect_module(key: &EffectKey) -> Module {
    let effect: &dyn PostEffect = EFFECTS[key.effect];
    let mut module = Module::new(&[
        wgsl!("lib/view.wgsl"),
        wgsl!("lib/ids.wgsl"),
        wgsl!("lib/geometry.wgsl"),
        wgsl!("lib/encode.wgsl"),
    ]);
    let finish = key.finish.number();
    let mut bindings = format!(
        "const ORTHOGRAPHIC: bool = {};\nconst FINISH: u32 = {finish}u;\nconst LEAVES_SURFACES: bool = {};\n\
         @group(0) @binding(0) var<uniform> view: View;\n\
         @group(0) @binding(1) var atoms: texture_2d<u32>;\n\
         @group(0) @binding(2) var connectors: texture_2d<u32>;\n\
         @group(0) @binding(8) var mesh_parts: texture_2d<u32>;\n\
         @group(1) @binding(0) var<uniform> {}_params: {};\n\
         @group(1) @binding(1) var<uniform> output: Output;\n\
         @group(1) @binding(2) var geometry: texture_2d<u32>;\n\
         @group(1) @binding(3) var color: texture_2d<f32>;\n\
         @group(1) @binding(4) var ids: texture_2d<u32>;\n",
        key.orthographic,
        key.leaves_surfaces,
        effect.file(),
        effect.params_info().name
    );
    for (bit, feature) in effect.features().iter().enumerate() {
        bindings.push_str(&format!("const {feature}: bool = {};\n", key.features >> bit & 1 == 1));
    }
    let own = effect.passes(key.features).iter().filter(|pass| pass.target != PassTarget::Picture);
    for (pass, binding) in own.zip(FIRST_OWN_BINDING..) {
        let kind = if is_uint(pass) { "u32" } else { "f32" };
        bindings.push_str(&format!("@group(1) @binding({binding}) var {}: texture_2d<{kind}>;\n", pass.name));
    }
    module.add_generated("effect bindings", bindings);
    module.add(wgsl!("lib/fullscreen.wgsl"));
    module.add(wgsl!("lib/post.wgsl"));
    module.add(wgsl!("lib/finish.wgsl"));
    for file in effect.wgsl(key.features) {
        module.add(*file);
    }
    module
}
