//! The engine: the three providers, the scene and the renderer. Window, headless command and tests all use it.

mod bending;
mod build;
pub mod exact;
pub mod lint;
mod live;
mod palette;
mod pending;
mod picks;
mod tiles;
mod watch;

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;

use crate::config::{CatalogEntry, LightKind, ObjectKind, Role, Shadow, Style, TransparencyMethod, Values};
use crate::effects::{self, Depths, EFFECTS, EffectContext, effect_index};
use crate::frame::objects::{DrawList, MOST_PICKS};
use crate::frame::{self, Aovs, Effect, FrameInput, LayerMethod, Materials, Renderer, TargetBytes};
use crate::gpu::PassTimes;
use crate::providers::{CameraProvider, Lengths, LightingProvider, ShaderProvider, picked};
use crate::scene::{AovImage, Camera, Image, Pixels, Scene, Sphere};
use crate::shading::{MaterialContext, SHADERS};
use build::ObjectKey;
use live::Live;
use picks::Picks;

pub use crate::frame::bkb::{BkbForm, BkbWords};
pub use crate::frame::{MAX_SAMPLES, ShadowFilter, ShadowQuality, Step};
pub use crate::gpu::{Counters, Gpu, GpuError};
pub use live::{Part, Refusal, Reload, ReloadTimes, Sources, source_tree_shaders};
pub use tiles::TileError;

/// What curvature, with the scene's radius as the unit of length, is multiplied by before tanh.
const CURVATURE_GAIN: f32 = 1.0;

/// Why a frame lacks an effect that its style does not ask for.
const NOT_LISTED: &str = "post_effects does not list it";

/// Types of objects that this version draws.
pub const DRAWN_KINDS: &[ObjectKind] = &[ObjectKind::Atom, ObjectKind::Connector, ObjectKind::Mesh];

/// Names and parameter tables of everything a style can refer to, from the registries.
pub fn catalog() -> Vec<CatalogEntry> {
    let drawn = SHADERS.iter().map(|shader| (shader.name(), Role::Object, shader.doc(), shader.params()));
    let effects = EFFECTS.iter().map(|effect| (effect.name(), Role::PostEffect, effect.doc(), effect.params()));
    drawn.chain(effects).map(|(name, role, doc, params)| CatalogEntry { name, role, doc, params }).collect()
}

/// What to draw, and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel.
    pub samples: u32,
    /// No background: straight alpha.
    pub transparent: bool,
    /// 16 bits a channel instead of 8.
    pub wide: bool,
    /// Turn of the scene about the camera's upright axis through its middle, in degrees: counter-clockwise from above.
    pub turn_deg: f32,
}

impl Request {
    /// An opaque picture of 8 bits a channel, straight ahead.
    pub const fn new(size: [u32; 2], samples: u32) -> Request {
        Request { size, samples, transparent: false, wide: false, turn_deg: 0.0 }
    }
}

/// A form of a post effect that no style asks for, such as the published one: for measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EffectForm {
    /// The effect's name in style files.
    pub effect: &'static str,
    /// Which of its features is on.
    pub feature: &'static str,
}

impl EffectForm {
    /// `ssaoPost` with `hemisphere` as published.
    pub const OCCLUSION_PUBLISHED: EffectForm =
        EffectForm { effect: "ssaoPost", feature: effects::occlusion::PUBLISHED };
    /// `ssaoPost` with `hemisphere`, its points turned instead of mirrored.
    pub const OCCLUSION_ROTATED: EffectForm = EffectForm { effect: "ssaoPost", feature: effects::occlusion::ROTATED };
    /// `ssaoPost` with horizons found for every pixel of a frame of one sample.
    pub const OCCLUSION_FINE: EffectForm = EffectForm { effect: "ssaoPost", feature: effects::occlusion::FINE };
    /// `dofPost` with `five_layer` as published.
    pub const FOCUS_PUBLISHED: EffectForm = EffectForm { effect: "dofPost", feature: effects::focus::PUBLISHED };
}

/// Counts of what a frame draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counts {
    /// Spheres.
    pub spheres: u32,
    /// Cylinders.
    pub cylinders: u32,
    /// Triangles that the rasteriser sees for one sample.
    pub triangles: u64,
}

/// What is drawn: a scene in a style, with the providers that answer for them.
struct Content {
    scene: Arc<Scene>,
    style: Arc<Style>,
    camera: CameraProvider,
    /// Whether the curvature of surfaces is asked for, whatever the style does.
    bent: bool,
}

impl Content {
    fn new(scene: Arc<Scene>, style: Arc<Style>) -> Content {
        let camera = CameraProvider::new(style.camera.clone(), &scene);
        Content { scene, style, camera, bent: false }
    }
}

/// What a scene and a style come to, found on the CPU and not in force yet.
struct Resolved {
    /// The objects; none where those that are drawn already are the same.
    list: Option<DrawList>,
    materials: Materials,
    drawn: Drawn,
}

/// What the renderer holds, as far as it decides what a change costs.
#[derive(Clone)]
struct Drawn {
    shaders: ShaderProvider,
    key: ObjectKey,
    /// What each material is.
    used: Vec<build::MaterialUse>,
    lengths: Lengths,
    /// How strongly curvature is read unless the style says.
    gain: f32,
    /// The bits of the selectors of post effects that pick any object of the scene.
    picks: u32,
    /// Where that lies of which post effects need the place, by their numbers among the shaders.
    looked_at: BTreeMap<usize, Sphere>,
    lighting: LightingProvider,
    height_px: u32,
}

/// One scene in one style on one device. It draws what it is given, or what files hold and follows their changes.
pub struct Engine {
    gpu: Arc<Gpu>,
    renderer: Renderer,
    content: Option<Content>,
    /// What of the content the renderer holds.
    drawn: Option<Drawn>,
    /// Whether scene or style were replaced since.
    stale: bool,
    /// What was drawn last: new content is made ready for the same again.
    last_request: Option<Request>,
    live: Option<Live>,
    /// Forms of post effects in which the next frames are drawn.
    forms: Vec<EffectForm>,
    /// The form of the bucketed k-buffer in which they are drawn.
    bkb_form: BkbForm,
}

impl Engine {
    /// An engine for a scene and a style. Nothing is built before the first frame.
    pub fn new(gpu: Arc<Gpu>, scene: Scene, style: Style) -> Engine {
        Engine { content: Some(Content::new(Arc::new(scene), Arc::new(style))), ..Engine::empty(gpu) }
    }

    /// An engine for what files hold. Nothing is loaded before the first [`Engine::poll`].
    pub fn live(gpu: Arc<Gpu>, sources: Sources) -> Engine {
        Engine { live: Some(Live::new(sources)), ..Engine::empty(gpu) }
    }

    fn empty(gpu: Arc<Gpu>) -> Engine {
        let renderer = Renderer::new(Arc::clone(&gpu));
        Engine {
            gpu,
            renderer,
            content: None,
            drawn: None,
            stale: false,
            last_request: None,
            live: None,
            forms: Vec::new(),
            bkb_form: BkbForm::default(),
        }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The scene, once there is one.
    pub fn scene(&self) -> Option<&Scene> {
        self.content.as_ref().map(|content| &*content.scene)
    }

    /// The style, once there is one.
    pub fn style(&self) -> Option<&Style> {
        self.content.as_ref().map(|content| &*content.style)
    }

    /// Replaces the style; the next frame writes what differs.
    pub fn set_style(&mut self, style: Style) {
        if let Some(content) = self.content.take() {
            self.content = Some(Content::new(content.scene, Arc::new(style)));
            self.stale = true;
        }
    }

    /// Changes how fine the shadows of the next frames are.
    pub fn set_shadow_quality(&mut self, quality: ShadowQuality) {
        self.renderer.set_shadow_quality(quality);
    }

    /// Draws post effects of the next frames in these forms.
    pub fn set_forms(&mut self, forms: Vec<EffectForm>) {
        self.forms = forms;
    }

    /// Draws the bucketed k-buffer of the next frames in this form, where the style asks for one.
    pub fn set_bkb_form(&mut self, form: BkbForm) {
        self.bkb_form = form;
    }

    /// Replaces the scene.
    pub fn set_scene(&mut self, scene: Scene) {
        if let Some(content) = self.content.take() {
            self.content = Some(Content::new(Arc::new(scene), content.style));
            self.drawn = None;
        }
    }

    /// The camera for a picture of this size, once there is something to see.
    pub fn camera(&self, size: [u32; 2]) -> Option<Camera> {
        self.content.as_ref().map(|content| content.camera.camera(size))
    }

    /// Makes the renderer hold what the content comes to, unless it does.
    fn refresh(&mut self, height_px: u32) -> Result<(), GpuError> {
        let content = self.content.as_ref().ok_or(GpuError::NothingToDraw)?;
        if !self.stale && self.drawn.as_ref().is_some_and(|drawn| drawn.height_px == height_px) {
            return Ok(());
        }
        let resolved = resolve(content, self.drawn.as_ref(), height_px);
        self.take(resolved)
    }

    /// Puts what was resolved into force. On an error the former stays.
    fn take(&mut self, resolved: Resolved) -> Result<(), GpuError> {
        self.renderer.set_contents(resolved.list.as_ref(), resolved.materials)?;
        self.drawn = Some(resolved.drawn);
        self.stale = false;
        Ok(())
    }

    /// Puts other content into force, all or nothing: it is resolved and its pipelines are built first, for a picture
    /// like the last one. Returns when resolving was done.
    fn replace(&mut self, content: Content, scene_is_new: bool) -> Result<Instant, GpuError> {
        let Some(request) = self.last_request else {
            self.content = Some(content);
            (self.drawn, self.stale) = (None, true);
            return Ok(Instant::now());
        };
        let known = self.drawn.as_ref().filter(|_| !scene_is_new);
        let resolved = resolve(&content, known, request.size[1]);
        let resolved_at = Instant::now();
        frame_input(&content, &resolved.drawn, &request, (&self.forms, self.bkb_form), |input| {
            self.renderer.prepare(resolved.list.as_ref(), &resolved.materials, input)
        })?;
        self.take(resolved)?;
        self.content = Some(content);
        Ok(resolved_at)
    }

    /// Draws one frame and waits for it; returns its milliseconds (encode, submit, idle). `progress` hears of samples that
    /// are done, and may break off.
    ///
    /// # Errors
    /// [`GpuError`] where picture or scene do not fit the device, the driver fails, or `progress` breaks off.
    pub fn draw(
        &mut self,
        request: &Request,
        timed: bool,
        progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
    ) -> Result<f64, GpuError> {
        self.with_input(request, |renderer, input| {
            let start = Instant::now();
            renderer.render(input, timed, progress)?;
            Ok(start.elapsed().as_secs_f64() * 1e3)
        })
    }

    /// The frame that was drawn last.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where it cannot be read back.
    pub fn read(&self, request: &Request) -> Result<Image, GpuError> {
        let bytes = self.renderer.read(request.wide)?;
        let pixels = if request.wide {
            Pixels::U16(bytes.chunks_exact(2).map(bytemuck::pod_read_unaligned).collect())
        } else {
            Pixels::U8(bytes)
        };
        Ok(Image { size: request.size, pixels, opaque: self.is_opaque(request) })
    }

    /// Whether every pixel of the picture covers what is behind it.
    pub fn is_opaque(&self, request: &Request) -> bool {
        let background = self.content.as_ref().map(|content| content.camera.background(false)[3]);
        !request.transparent && background.is_some_and(|alpha| alpha >= 1.0)
    }

    /// How far what a pixel sees changes others, in pixels.
    fn reach_px(&mut self, request: &Request) -> Result<u32, GpuError> {
        self.with_input(request, |renderer, input| {
            Ok(renderer.layers_reach_px(input.layer_method)
                + input.effects.iter().map(|effect| effect.reach_px).sum::<u32>())
        })
    }

    /// Whether depth of field blurs what is transparent as one, by the nearest surface of each pixel, since the lists of all its surfaces
    /// take more than `transparency.memory_mb`, or than a buffer of the device. Known when a frame was drawn.
    ///
    /// # Errors
    /// As [`Engine::draw`].
    pub fn layers_are_merged(&mut self, request: &Request) -> Result<bool, GpuError> {
        self.with_input(request, |renderer, input| {
            Ok(renderer.layers_are_merged(&FrameInput { tile: Engine::first_tile(request), ..input.clone() }))
        })
    }

    /// The passes that a frame has and why, and those that are left out and why, without drawing any. Of a picture in tiles it
    /// is the frame of the first tile, without what it shares with its neighbours.
    ///
    /// # Errors
    /// As [`Engine::draw`].
    pub fn explain(&mut self, request: &Request) -> Result<Vec<Step>, GpuError> {
        let steps = self.with_input(request, |renderer, input| {
            renderer.explain(&FrameInput { tile: Engine::first_tile(request), ..input.clone() })
        })?;
        let (Some(content), Some(drawn)) = (&self.content, &self.drawn) else { return Err(GpuError::NothingToDraw) };
        let camera = content.camera.turned(request.size, request.turn_deg.to_radians());
        let mut is_seen = [false; EFFECTS.len()];
        let mut left_out = Vec::new();
        with_effects(content, drawn, &camera, request, |effect, values, context| {
            is_seen[effect] = true;
            let reason = EFFECTS[effect].changes_nothing(values, context);
            left_out.extend(reason.map(|reason| Step::left_out(EFFECTS[effect].name(), reason)));
        });
        let unseen = EFFECTS.iter().zip(is_seen).filter(|(_, is_seen)| !is_seen);
        left_out.extend(unseen.map(|(effect, _)| Step::left_out(effect.name(), NOT_LISTED)));
        Ok(steps.into_iter().chain(left_out).collect())
    }

    /// Draws and reads one still.
    ///
    /// # Errors
    /// As [`Engine::draw`].
    pub fn still(&mut self, request: &Request) -> Result<Image, GpuError> {
        self.draw(request, false, &mut |_| ControlFlow::Continue(()))?;
        self.read(request)
    }

    /// The AOVs of the same view, one sample at each pixel's centre.
    ///
    /// # Errors
    /// As [`Engine::draw`].
    pub fn aovs(&mut self, request: &Request) -> Result<AovImage, GpuError> {
        // Of shapes it is found and written where something asks.
        if let Some(content) = self.content.as_mut().filter(|content| !content.bent) {
            content.bent = true;
            self.stale = true;
        }
        let Aovs { geometry, mut ids, color, found, layer_count, mut curvature } =
            self.with_input(request, |renderer, input| renderer.render_aovs(input))?;
        // Outlines are lines, not surfaces: they have no depth and no id.
        for (id, p) in ids.iter_mut().zip(geometry.chunks_exact(4)) {
            *id = if p[3] < 0.0 { 0 } else { *id };
        }
        let depth = geometry.chunks_exact(4).map(|p| if p[3] < 0.0 { f32::INFINITY } else { p[3] }).collect();
        let normal = geometry.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        curvature.iter_mut().zip(&ids).filter(|(_, id)| **id == 0).for_each(|(kappa, _)| *kappa = f32::NAN);
        // Where a frame lacks the effect, nothing is darkened, and all is sharp.
        let without = |value: f32| ids.iter().map(move |id| if *id == 0 { -1.0 } else { value }).collect::<Vec<f32>>();
        let (mut ao, mut coc) = (without(1.0), without(0.0));
        for (effect, values) in found {
            match EFFECTS[effect].aov(0).map(|aov| aov.name) {
                Some("ao") => {
                    ao.iter_mut().zip(values).filter(|(all, _)| **all > 0.0).for_each(|(all, one)| *all *= one)
                }
                Some("coc") => coc = values,
                _ => {}
            }
        }
        Ok(AovImage { size: request.size, depth, normal, ids, color, ao, coc, layer_count, curvature })
    }

    /// The bucketed k-buffer of the same view, and the fragments that it was made of, for whoever holds it to its twin; none where
    /// the style asks for no such method, nothing is transparent, or it is drawn in bands.
    ///
    /// # Errors
    /// As [`Engine::draw`].
    pub fn bkb_words(&mut self, request: &Request) -> Result<Option<BkbWords>, GpuError> {
        self.with_input(request, |renderer, input| renderer.render_bkb(input))
    }

    fn with_input<T>(
        &mut self,
        request: &Request,
        draw: impl FnOnce(&mut Renderer, &FrameInput<'_>) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.refresh(request.size[1])?;
        self.last_request = Some(*request);
        let (Some(content), Some(drawn)) = (&self.content, &self.drawn) else { return Err(GpuError::NothingToDraw) };
        frame_input(content, drawn, request, (&self.forms, self.bkb_form), |input| draw(&mut self.renderer, input))
    }

    /// What the shader `curvature` multiplies curvature over scene units by at a gain of 1; none before the first frame.
    pub fn curvature_scale(&self) -> Option<f64> {
        self.drawn.as_ref().map(|drawn| f64::from(drawn.gain) * drawn.lengths.radius)
    }

    /// Milliseconds of each pass of the last timed frame.
    pub fn pass_times(&self) -> &PassTimes {
        self.renderer.pass_times()
    }

    /// What the last frame drew.
    pub fn counts(&self) -> Counts {
        let [spheres, cylinders] = self.renderer.object_counts();
        let triangles = 2 * u64::from(spheres + cylinders) + self.renderer.num_triangles();
        Counts { spheres, cylinders, triangles }
    }

    /// What was asked of the device so far.
    pub fn counters(&self) -> Counters {
        self.gpu.counters()
    }

    /// Bytes of the objects on the device.
    pub fn object_bytes(&self) -> u64 {
        self.renderer.object_bytes()
    }

    /// Bytes of each target of the last frame.
    pub fn target_bytes(&self) -> TargetBytes {
        self.renderer.target_bytes()
    }

    /// What the style asks of lights that a frame does not do, and what a picture of this size cannot show, in plain words.
    pub fn limits_exceeded(&self, size: [u32; 2]) -> Vec<String> {
        let Some(style) = self.style() else { return Vec::new() };
        let lights: Vec<_> = style.lights.iter().filter(|light| light.kind != LightKind::Ambient).collect();
        let mut exceeded = Vec::new();
        if lights.len() > frame::MAX_LIGHTS {
            exceeded.push(format!("the style has {} lights; only the first {} shine", lights.len(), frame::MAX_LIGHTS));
        }
        let mut casting = 0;
        for light in lights.iter().take(frame::MAX_LIGHTS).filter(|light| light.shadow != Shadow::None) {
            let inside =
                light.kind == LightKind::Point && DVec3::from_array(light.position).length() <= frame::SHADOWLESS_RADII;
            if inside {
                exceeded.push(
                    "a point light within the scene's sphere casts no shadow; move it more than 1.02 radii away"
                        .to_owned(),
                );
            } else {
                casting += 1;
            }
        }
        if casting > frame::MAX_SHADOWS {
            exceeded.push(format!(
                "{casting} lights cast shadows; only the shadows of the first {} are drawn",
                frame::MAX_SHADOWS
            ));
        }
        let selectors = picks::selectors(style).len();
        if selectors > MOST_PICKS {
            exceeded.push(format!(
                "the post effects of the style have {selectors} different selectors; only those of the first {MOST_PICKS} are drawn"
            ));
        }
        if self.content.as_ref().is_some_and(|content| content.camera.sees_edge_on(&content.scene, size)) {
            exceeded.push(
                "the scene lies flat and is seen from its edge, as a line thinner than a pixel; turn it with \"camera\": \
                 { \"orient\": \"principal\" } or give another \"position\""
                    .to_owned(),
            );
        }
        exceeded
    }
}

/// Finds what a scene and a style come to; `drawn` is what the renderer holds of the same scene, of which what stays the
/// same is taken over.
fn resolve(content: &Content, drawn: Option<&Drawn>, height_px: u32) -> Resolved {
    let Content { scene, style, camera, bent } = content;
    let bent = *bent || build::asks_for_bending(style);
    let shaders = match drawn {
        Some(drawn) => drawn.shaders.with_style(scene, style),
        None => ShaderProvider::new(scene, style),
    };
    let key = ObjectKey::new(style, Arc::clone(shaders.assignment()), bent);
    let (list, used, lengths, gain, picks) = match drawn.filter(|drawn| drawn.key == key) {
        Some(drawn) => (None, drawn.used.clone(), drawn.lengths, drawn.gain, drawn.picks),
        None => {
            let picks = Picks::new(scene, &key.picking);
            let objects = build::objects(scene, style, shaders.assignment(), &picks, bent);
            (Some(objects.list), objects.materials, objects.lengths, objects.gain, picks.any())
        }
    };
    let context = MaterialContext {
        exposure_factor: camera.exposure_factor(),
        bounds: scene.bounding_sphere(),
        gain,
        screen: &|length| lengths.screen(length, height_px),
        table: 0,
    };
    let materials = build::materials(style, &used, &context);
    let lighting = LightingProvider::new(style.lights.clone(), scene.bounding_sphere(), lengths);
    let looked_at = looked_at(scene, style);
    Resolved {
        list,
        materials,
        drawn: Drawn { shaders, key, used, lengths, gain, picks, looked_at, lighting, height_px },
    }
}

/// Where that lies of which a post effect of the style needs the place, by the effect's number among the shaders.
fn looked_at(scene: &Scene, style: &Style) -> BTreeMap<usize, Sphere> {
    let place = |&index: &usize| {
        let used = &style.shaders[index];
        let selector = EFFECTS[effect_index(used.shader)?].looks_at(&used.values)?;
        Some((index, picked(scene, selector).bounds(scene)?))
    };
    style.post_effects.iter().filter_map(place).collect()
}

/// Calls `draw` with what a frame of the content needs beside objects and materials.
fn frame_input<T>(
    content: &Content,
    drawn: &Drawn,
    request: &Request,
    (forms, bkb_form): (&[EffectForm], BkbForm),
    draw: impl FnOnce(&FrameInput<'_>) -> T,
) -> T {
    let camera = content.camera.turned(request.size, request.turn_deg.to_radians());
    let lighting = drawn.lighting.lighting(&camera);
    let mut effects = effects(content, drawn, &camera, request);
    for effect in &mut effects {
        let registered = EFFECTS[effect.effect];
        for (bit, feature) in registered.features().iter().enumerate() {
            let is_on = forms.iter().any(|form| form.effect == registered.name() && form.feature == *feature);
            effect.features |= u32::from(is_on) << bit;
        }
    }
    let transparency = &content.style.transparency;
    draw(&FrameInput {
        camera: &camera,
        lighting: &lighting,
        bounds: content.scene.bounding_sphere(),
        background: content.camera.background(request.transparent),
        size: request.size,
        tile: None,
        shadows_drawn: false,
        samples: request.samples,
        layer_bytes: u64::from(transparency.memory_mb) << 20,
        layer_method: match transparency.method {
            TransparencyMethod::Auto | TransparencyMethod::Packed => LayerMethod::Packed,
            TransparencyMethod::Bkb => LayerMethod::Bkb { k: transparency.k, form: bkb_form },
        },
        curvature_gain: CURVATURE_GAIN,
        wide: request.wide,
        effects: &effects,
    })
}

/// The post effects of the content's style in the order of their stages, without those that change nothing.
fn effects(content: &Content, drawn: &Drawn, camera: &Camera, request: &Request) -> Vec<Effect> {
    let mut effects = Vec::new();
    with_effects(content, drawn, camera, request, |effect, values, context| {
        let registered = EFFECTS[effect];
        if registered.changes_nothing(values, context).is_none() {
            effects.push(Effect {
                effect,
                features: registered.features_used(values, context),
                params: registered.uniform(values, context),
                reach_px: registered.reach_px(values, context),
            });
        }
    });
    effects.sort_by_key(|effect| effect.effect);
    effects
}

/// Gives `each` the post effects that the content's style lists, by their places in the registry; without those whose selectors
/// are more than objects have bits for.
fn with_effects(
    content: &Content,
    drawn: &Drawn,
    camera: &Camera,
    request: &Request,
    mut each: impl FnMut(usize, &Values, &EffectContext<'_>),
) {
    let height_px = request.size[1];
    let pixel_world = |depth: f32| camera.pixel_view(height_px) * if camera.orthographic { 1.0 } else { depth };
    let bounds = content.scene.bounding_sphere();
    let middle = (-camera.view_from_world.transform_point3(bounds.center).z).max(camera.near);
    let depths = Depths {
        orthographic: camera.orthographic,
        near: f64::from(camera.near),
        middle: f64::from(middle),
        radius: f64::from(bounds.radius),
        pixel_world: f64::from(pixel_world(middle).max(f32::MIN_POSITIVE)),
    };
    let context = EffectContext {
        samples: request.samples.clamp(1, MAX_SAMPLES),
        depths,
        screen: &|length| drawn.lengths.screen(length, height_px),
        world: &|length| drawn.lengths.world(length),
        least_pixel_world: f64::from(pixel_world(camera.near).max(f32::MIN_POSITIVE)),
        pick_bits: 0,
        looked_at: None,
    };
    for &index in &content.style.post_effects {
        let used = &content.style.shaders[index];
        let Some(effect) = effect_index(used.shader) else { continue };
        let pick_bits = match EFFECTS[effect].picks(&used.values) {
            Some(selector) => match drawn.key.picking.iter().position(|known| known == selector) {
                Some(bit) => 1 << bit & drawn.picks,
                None => continue,
            },
            None => 0,
        };
        let depth = |sphere: &Sphere| f64::from(-camera.view_from_world.transform_point3(sphere.center).z);
        let looked_at = drawn.looked_at.get(&index).map(depth);
        each(effect, &used.values, &EffectContext { pick_bits, looked_at, ..context });
    }
}
