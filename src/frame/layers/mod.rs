//! Layers: what is transparent, all of its surfaces at each pixel, blended from near to far over what is opaque.
//!
//! Every fragment is kept, once, in a pool of about as many: fragments are counted for each pixel, given room, written down with
//! 8 bytes each (depth and id), sorted, and shaded from their ids only as far as light comes through (ours, of the family that
//! [Maule2014, throughout] surveys). Of each list its end alone is kept, and of each run of lists its start. Nothing is dropped: where
//! the pool is too small, the frame tells by how much, the pool grows and the frame is drawn again; where it would outgrow a
//! binding, the picture is drawn in bands.
//!
//! Depth of field reads the lists themselves, with the light of each fragment beside it, instead of a blended picture. That
//! takes all of them at once: where they would not fit, what is blended is blurred by the depth of its nearest surface.

mod read;

use read::BandLists;

use super::ShadeKey;
use super::fullscreen;
use super::objects::ObjectBuffers;
use super::post::Finish;
use super::shade::{LayerWork, Shade};
use super::sort::{self, sort_module};
use super::visibility::{Drawn, ID_FORMAT, SceneBindings, Visibility, VisibilityKey, VisibilityPass};
use crate::gpu::{Bound, Gpu, GpuError, KeptBindGroup, KeptBuffer, Module, PassTimer};
use crate::{gpu_struct, wgsl};

/// Bytes of what a band tells: its fragments, and whether they are more than that word counts. Classes of runs follow, with four words
/// each, the first of which are dispatched.
const TOTAL_BYTES: u64 = 8;
const CLASS_BYTES: u64 = 16;
const TALLY_BYTES: u64 = CLASS_BYTES * (1 + sort::CLASSES as u64);
/// Bytes of a fragment, of its light where that is kept, and of what neighbouring pixels ask of it where they do.
const FRAGMENT_BYTES: u64 = 8;
const LIGHT_BYTES: u64 = 8;
const MARK_BYTES: u64 = 8;
/// Fragments for each pixel that a pool holds before more are known to be there.
const FIRST_LAYERS: u64 = 4;
/// How much more than what was needed a pool holds: next to nothing for a still, which outgrows it once; more for a scene that is turned
/// and does so again.
const SLACKS: [f64; 2] = [1.03, 1.25];
/// Pixels of a run, see `shaders/lib/layers.wgsl`, and runs that a group gives room, see `shaders/layers/room.wgsl`.
const RUN: u32 = 32;
const ROOM_GROUP: u32 = 64;
/// Rows and columns around each pixel that curvature from neighbouring pixels asks for, see `shaders/layers/neighbours.wgsl`.
pub const HALO: u32 = 8;

gpu_struct! {
    "lib/layers.wgsl",
    /// See `shaders/lib/layers.wgsl`.
    pub struct LayerBand {
        /// Width of what is drawn, in pixels.
        pub width: u32,
        /// Pixels before the band's first row.
        pub first_pixel: u32,
        /// Pixels of the band.
        pub num_pixels: u32,
        /// Fragments that the pool holds.
        pub capacity: u32,
    }
}

/// What a frame's layers are drawn by.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LayersPlan {
    /// The shading of blended fragments.
    pub shade: ShadeKey,
    /// What marks fragments for those of neighbouring pixels, where these ask.
    pub mark: Option<ShadeKey>,
    /// Counting.
    pub count: VisibilityKey,
    /// Writing.
    pub write: VisibilityKey,
    /// Post effects before them.
    pub after_effects: usize,
    /// Whether they stay apart, instead of being blended.
    pub apart: Option<Apart>,
    /// Whether counts and ids of nearest surfaces are asked for.
    pub for_aovs: bool,
}

/// How layers stay with their depths until the effect that reads their lists, the last of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Apart {
    /// Whether effects draw lines between.
    pub lines: bool,
}

/// Where the blended picture goes, and what it is blended over.
pub struct LayerTargets<'a> {
    /// Opaque light of one sample.
    pub color: &'a wgpu::TextureView,
    /// Its surfaces.
    pub geometry: &'a wgpu::TextureView,
    /// Depths of what is opaque.
    pub depth: &'a wgpu::TextureView,
    /// Ids of what is opaque, which become those of the nearest surfaces.
    pub ids: &'a wgpu::TextureView,
    /// The picture; none where layers stay apart.
    pub to: Option<&'a wgpu::TextureView>,
    /// Its surfaces, for effects that follow.
    pub to_geometry: Option<&'a wgpu::TextureView>,
    /// Whether the picture is cleared first.
    pub clears: bool,
}

/// Some rows of the picture, with what their passes bind.
struct Band {
    rows: std::ops::Range<u32>,
    /// These and the halo.
    held: std::ops::Range<u32>,
    raster: wgpu::BindGroup,
    room: wgpu::BindGroup,
    sort: wgpu::BindGroup,
    blend: wgpu::BindGroup,
}

#[derive(Default)]
struct BandSlot {
    params: Option<KeptBuffer>,
    raster: KeptBindGroup,
    room: KeptBindGroup,
    sort: KeptBindGroup,
    blend: KeptBindGroup,
}

/// What layers keep from frame to frame.
#[derive(Default)]
pub struct Layers {
    size: [u32; 2],
    /// Most bytes of a buffer that they were made for.
    limit: u64,
    /// The end of each list, and the start of each run of them.
    ends: Option<wgpu::Buffer>,
    runs: Option<wgpu::Buffer>,
    pool: Option<wgpu::Buffer>,
    /// What a band tells: see `shaders/layers/room.wgsl`.
    tally: Option<wgpu::Buffer>,
    classes: Option<wgpu::Buffer>,
    readable: Option<(wgpu::Buffer, u64)>,
    /// Fragments that the pool holds.
    capacity: u64,
    /// Whether it has grown for pictures of this size.
    has_grown: bool,
    /// What it holds of each.
    each: Each,
    /// Whether the lists of a picture of this size are too many to be kept at once.
    is_too_much: bool,
    num_bands: u32,
    /// Rows that a band holds beyond each of its ends.
    halo: u32,
    /// For each class of runs.
    sort: Vec<wgpu::ComputePipeline>,
    room: Option<(wgpu::BindGroupLayout, wgpu::ComputePipeline)>,
    nearest: Option<wgpu::RenderPipeline>,
    slots: Vec<BandSlot>,
    lists_params: Option<KeptBuffer>,
    num_totals: u64,
    /// Ends and runs of all bands, where AOVs ask for them.
    all_lists: Option<(wgpu::Buffer, Vec<BandLists>)>,
}

/// A buffer that shaders read and write.
pub(super) fn storage(binding: u32, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

fn plain(binding: u32, visibility: wgpu::ShaderStages, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

/// A layout of a band, its ends, runs and pool, and then textures.
fn band_layout(gpu: &Gpu, label: &'static str, textures: &[wgpu::TextureSampleType]) -> wgpu::BindGroupLayout {
    let stage = wgpu::ShaderStages::FRAGMENT;
    let mut entries =
        vec![plain(0, stage, fullscreen::UNIFORM), storage(1, stage), storage(2, stage), storage(3, stage)];
    entries.extend((4..).zip(textures).map(|(binding, of)| plain(binding, stage, fullscreen::texture(*of))));
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// What a pool holds of each fragment beside its depth and id.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Each {
    light: bool,
    mark: bool,
}

impl Each {
    fn bytes(self) -> u64 {
        let more = [(self.light, LIGHT_BYTES), (self.mark, MARK_BYTES)];
        FRAGMENT_BYTES + more.iter().filter(|(holds, _)| *holds).map(|(_, bytes)| bytes).sum::<u64>()
    }
}

/// Bytes of the lists of so many pixels beside their fragments: of their ends, of runs of them, and of the classes of these.
pub fn list_bytes(pixels: u64) -> [u64; 3] {
    let runs = pixels.div_ceil(u64::from(RUN));
    [pixels, runs, runs * sort::CLASSES as u64].map(|words| words * 4)
}

/// Bands of which each has as many lists as fit a binding.
fn bands_of_lists(size: [u32; 2], limit: u64, halo: u32) -> u32 {
    let [row, halo] = [1, 2 * halo].map(|rows| u64::from(rows) * u64::from(size[0]) * 4);
    let limit = limit.min(sort::MOST_PIXELS * 4);
    (u64::from(size[1]) * row).div_ceil(limit.saturating_sub(halo).max(1)).max(1) as u32
}

fn band_of(size: [u32; 2], rows: &std::ops::Range<u32>, capacity: u64) -> LayerBand {
    LayerBand {
        width: size[0],
        first_pixel: rows.start * size[0],
        num_pixels: (rows.end - rows.start) * size[0],
        capacity: capacity as u32,
    }
}

/// What an effect binds that reads lists, with lines and their surfaces where there are any.
pub fn lists_layout(gpu: &Gpu, lines: bool) -> wgpu::BindGroupLayout {
    let stage = wgpu::ShaderStages::FRAGMENT;
    let read = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let mut entries = vec![plain(0, stage, fullscreen::UNIFORM)];
    entries.extend((1..4).map(|binding| plain(binding, stage, read)));
    if lines {
        let types = [wgpu::TextureSampleType::Float { filterable: false }, wgpu::TextureSampleType::Uint];
        entries.extend((4..).zip(types).map(|(binding, of)| plain(binding, stage, fullscreen::texture(of))));
    }
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("lists"), entries: &entries })
}

/// What counting and writing bind.
pub fn raster_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    band_layout(gpu, "layers", &[wgpu::TextureSampleType::Depth])
}

/// What blending binds beside the scene and the shading.
pub fn blend_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let types = [wgpu::TextureSampleType::Float { filterable: false }, wgpu::TextureSampleType::Uint];
    band_layout(gpu, "blend layers", &types)
}

/// Most bytes of one buffer.
pub(super) fn most_bytes(gpu: &Gpu, memory_bytes: u64) -> u64 {
    let limits = gpu.device.limits();
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size).min(memory_bytes)
}

impl LayersPlan {
    /// The plan of a frame whose opaque part has such keys.
    pub fn new(
        shade: &ShadeKey,
        seen: VisibilityKey,
        finish: Finish,
        surfaces: bool,
        after_effects: usize,
        apart: Option<Apart>,
    ) -> LayersPlan {
        let shade = ShadeKey {
            layers: Some((finish, surfaces)),
            layer_work: if apart.is_some() { LayerWork::Keep } else { LayerWork::Blend },
            hulls: false,
            encode: false,
            geometry: true,
            ..shade.clone()
        };
        let raster = |drawn| VisibilityKey { drawn, hulls: false, ..seen };
        LayersPlan {
            mark: shade
                .asks_neighbours()
                .then(|| ShadeKey { layer_work: LayerWork::Mark { keeps_light: apart.is_some() }, ..shade.clone() }),
            shade,
            count: raster(Drawn::CountedLayers),
            write: raster(Drawn::WrittenLayers),
            after_effects,
            apart,
            for_aovs: false,
        }
    }

    /// Whether ids of nearest surfaces replace those of what is opaque.
    pub fn has_nearest(&self) -> bool {
        self.for_aovs || self.leaves_surfaces()
    }

    /// Whether effects follow that ask for the nearest surface.
    pub fn leaves_surfaces(&self) -> bool {
        self.shade.layers.is_some_and(|(_, surfaces)| surfaces)
    }
}

impl Layers {
    /// Builds what the layers of a frame need, unless it is there.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    pub fn prepare(&mut self, gpu: &Gpu, shade: &Shade, plan: &LayersPlan) -> Result<(), GpuError> {
        if let Some(layout) = shade.layers_layout().filter(|_| plan.has_nearest() && self.nearest.is_none()) {
            let targets = [ID_FORMAT.into()];
            let module = nearest_module();
            self.nearest =
                Some(fullscreen::pipeline(gpu, "nearest layers", &module, "nearest_id", &[layout], &targets)?);
        }
        if self.room.is_none() {
            let stage = wgpu::ShaderStages::COMPUTE;
            let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some("room of layers"),
                entries: &[
                    plain(0, stage, fullscreen::UNIFORM),
                    storage(1, stage),
                    storage(2, stage),
                    storage(3, stage),
                    storage(4, stage),
                ],
            });
            let pipeline = gpu.compute_pipeline("room of layers", &room_module(), "make_room", &[Some(&layout)])?;
            self.room = Some((layout, pipeline));
        }
        if let Some((layout, _)) = self.room.as_ref().filter(|_| self.sort.is_empty()) {
            let build =
                |class| gpu.compute_pipeline("sorted layers", &sort_module(class), "sort_runs", &[Some(layout)]);
            self.sort = (0..sort::CLASSES).map(build).collect::<Result<_, _>>()?;
        }
        Ok(())
    }

    /// Forgets the pipeline, so that it is built anew.
    pub fn forget_pipelines(&mut self) {
        (self.room, self.nearest) = (None, None);
        self.sort.clear();
    }

    /// Makes the buffers fit a picture, with at most `limit` bytes for each.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] where a row of the picture alone outgrows a binding.
    fn fit(&mut self, gpu: &Gpu, size: [u32; 2], limit: u64, samples: u32, plan: &LayersPlan) -> Result<(), GpuError> {
        let holds = Each { light: plan.apart.is_some(), mark: plan.mark.is_some() };
        let (each, halo) = (holds.bytes(), if holds.mark { HALO } else { 0 });
        let most = limit / each;
        if holds != self.each {
            self.each = holds;
            self.capacity = self.capacity.min(most);
            self.pool = None;
        }
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        if (self.size, self.limit, self.halo) != (size, limit, halo) || self.num_bands == 0 {
            self.num_bands = bands_of_lists(size, limit, halo);
            self.is_too_much = false;
            (self.size, self.limit, self.halo) = (size, limit, halo);
            self.capacity = self.capacity.max((pixels / u64::from(self.num_bands)) * FIRST_LAYERS).min(most);
            self.has_grown = false;
            self.pool = None;
            (self.ends, self.runs) = (None, None);
        }
        if self.num_bands > size[1] {
            let bytes = self.capacity * each * u64::from(self.num_bands) / u64::from(size[1].max(1));
            return Err(GpuError::TooMany {
                what: "layers of one row, which transparency.memory_mb limits, too,",
                count: self.num_bands as usize,
                bytes,
                limit,
            });
        }
        let rows = (size[1].div_ceil(self.num_bands) + 2 * halo).min(size[1]);
        let pixels = u64::from(rows) * u64::from(size[0]);
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let fit = |buffer: &mut Option<wgpu::Buffer>, label, bytes: u64| {
            if buffer.as_ref().is_none_or(|buffer| buffer.size() != bytes) {
                *buffer = None;
                *buffer = Some(gpu.empty_buffer(label, bytes, usage));
            }
        };
        let [ends, runs, classes] = list_bytes(pixels);
        fit(&mut self.ends, "layer ends", ends);
        fit(&mut self.runs, "layer runs", runs);
        fit(&mut self.classes, "classes of layer runs", classes);
        fit(&mut self.pool, "layers", self.capacity.max(1) * each);
        self.tally
            .get_or_insert_with(|| gpu.empty_buffer("layer tally", TALLY_BYTES, usage | wgpu::BufferUsages::INDIRECT));
        let totals = u64::from(samples) * u64::from(self.num_bands);
        if self.readable.as_ref().is_none_or(|(_, count)| *count < totals) {
            let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
            self.readable = Some((gpu.empty_buffer("layer totals", totals * TOTAL_BYTES, usage), totals));
        }
        self.num_totals = 0;
        gpu.check()
    }

    /// Bytes that they take.
    pub fn bytes(&self) -> u64 {
        [&self.ends, &self.runs, &self.classes, &self.pool].into_iter().flatten().map(wgpu::Buffer::size).sum()
    }

    /// The bands of the picture, each with what its passes bind.
    fn bands(
        &mut self,
        gpu: &Gpu,
        visibility: &Visibility,
        shade: &Shade,
        to: &LayerTargets<'_>,
    ) -> Result<Vec<Band>, GpuError> {
        let rows = self.size[1].div_ceil(self.num_bands.max(1));
        self.slots.resize_with(self.num_bands as usize, BandSlot::default);
        let (Some(ends), Some(runs), Some(classes), Some(pool), Some(tally), Some((room_layout, _))) =
            (&self.ends, &self.runs, &self.classes, &self.pool, &self.tally, &self.room)
        else {
            return Ok(Vec::new());
        };
        let Some(blend_layout) = shade.layers_layout() else { return Ok(Vec::new()) };
        let mut bands = Vec::new();
        for (index, slot) in (0..).zip(&mut self.slots) {
            let rows = index * rows..((index + 1) * rows).min(self.size[1]);
            if rows.is_empty() {
                continue;
            }
            let held = rows.start.saturating_sub(self.halo)..(rows.end + self.halo).min(self.size[1]);
            let band = band_of(self.size, &held, self.capacity);
            let params = slot.params.get_or_insert_with(|| KeptBuffer::uniform("layers"));
            let params = params.set(gpu, bytemuck::bytes_of(&band), 16)?;
            let stored = |last: Vec<(u32, Bound)>| {
                let mut bound = vec![
                    (0, Bound::Buffer(params.clone())),
                    (1, Bound::Buffer(ends.clone())),
                    (2, Bound::Buffer(runs.clone())),
                ];
                bound.extend(last);
                bound
            };
            let pool = || (3, Bound::Buffer(pool.clone()));
            let view = |binding, view: &wgpu::TextureView| (binding, Bound::View(view.clone()));
            bands.push(Band {
                rows,
                held,
                sort: slot.sort.get(
                    gpu,
                    "sorted layers",
                    room_layout,
                    stored(vec![pool(), (4, Bound::Buffer(classes.clone()))]),
                ),
                raster: slot.raster.get(
                    gpu,
                    "layers",
                    &visibility.layers_layout,
                    stored(vec![pool(), view(4, to.depth)]),
                ),
                room: slot.room.get(
                    gpu,
                    "room of layers",
                    room_layout,
                    stored(vec![(3, Bound::Buffer(tally.clone())), (4, Bound::Buffer(classes.clone()))]),
                ),
                blend: slot.blend.get(
                    gpu,
                    "blend layers",
                    blend_layout,
                    stored(vec![pool(), view(4, to.color), view(5, to.geometry)]),
                ),
            });
        }
        Ok(bands)
    }

    /// Makes room for the layers of a frame, before its first sample.
    ///
    /// # Errors
    /// As [`Layers::prepare`], and [`GpuError::TooMany`] where nothing helps.
    pub fn begin(
        &mut self,
        gpu: &Gpu,
        size: [u32; 2],
        memory_bytes: u64,
        samples: u32,
        plan: &LayersPlan,
    ) -> Result<(), GpuError> {
        self.fit(gpu, size, most_bytes(gpu, memory_bytes), samples, plan)
    }

    /// Whether the lists of a picture of this size can be kept at once, as far as is known.
    pub fn can_keep(&self, gpu: &Gpu, size: [u32; 2], memory_bytes: u64) -> bool {
        let limit = most_bytes(gpu, memory_bytes);
        let is_known = (self.size, self.limit) == (size, limit);
        bands_of_lists(size, limit, HALO) == 1 && !(is_known && (self.is_too_much || self.num_bands > 1))
    }

    /// The lists of the whole picture, in the order of [`lists_layout`]; none before they are made.
    ///
    /// # Errors
    /// Never for uniforms of a fixed size.
    pub fn lists(&mut self, gpu: &Gpu) -> Result<Option<Vec<Bound>>, GpuError> {
        let (Some(ends), Some(runs), Some(pool)) = (&self.ends, &self.runs, &self.pool) else { return Ok(None) };
        let band = band_of(self.size, &(0..self.size[1]), self.capacity);
        let params = self.lists_params.get_or_insert_with(|| KeptBuffer::uniform("lists"));
        let params = params.set(gpu, bytemuck::bytes_of(&band), 16)?;
        Ok(Some([params, ends.clone(), runs.clone(), pool.clone()].map(Bound::Buffer).to_vec()))
    }

    /// Draws the layers of one sample.
    ///
    /// # Errors
    /// Never for uniforms of a fixed size.
    #[allow(clippy::too_many_arguments)]
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        (visibility, shade): (&Visibility, &Shade),
        plan: &LayersPlan,
        (scene, objects): (&SceneBindings, &ObjectBuffers),
        pass: &VisibilityPass<'_>,
        shade_group: &wgpu::BindGroup,
        to: &LayerTargets<'_>,
        timer: &mut Option<PassTimer>,
    ) -> Result<(), GpuError> {
        let bands = self.bands(gpu, visibility, shade, to)?;
        let (Some(ends), Some(runs), Some(classes), Some(tally), Some((readable, _)), Some((_, room))) =
            (&self.ends, &self.runs, &self.classes, &self.tally, &self.readable, &self.room)
        else {
            return Ok(());
        };
        self.all_lists = plan.for_aovs.then(|| {
            let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
            let bands: Vec<BandLists> =
                bands.iter().map(|band| BandLists { rows: band.rows.clone(), held: band.held.clone() }).collect();
            let words: usize = bands.iter().flat_map(|band| band.words(self.size[0])).sum();
            (gpu.empty_buffer("all layer lists", words as u64 * 4, usage), bands)
        });
        let mut copied = 0;
        for (index, band) in bands.iter().enumerate() {
            encoder.clear_buffer(ends, 0, None);
            encoder.clear_buffer(tally, 0, None);
            encoder.clear_buffer(classes, 0, None);
            let raster = |name, key| VisibilityPass { name, key, ..*pass };
            let (rows, held) = (band.rows.clone(), band.held.clone());
            let counted = raster("layers_counted", plan.count);
            visibility.draw_layers(encoder, scene, objects, &counted, &band.raster, held.clone(), timer);
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("room of layers"),
                    timestamp_writes: timer.as_mut().and_then(|timer| timer.compute_pass("layers_room")),
                });
                pass.set_pipeline(room);
                pass.set_bind_group(0, &band.room, &[]);
                let pixels = (held.end - held.start) * self.size[0];
                pass.dispatch_workgroups(pixels.div_ceil(RUN * ROOM_GROUP), 1, 1);
            }
            encoder.copy_buffer_to_buffer(tally, 0, readable, self.num_totals * TOTAL_BYTES, Some(TOTAL_BYTES));
            self.num_totals += 1;
            let written = raster("layers_written", plan.write);
            visibility.draw_layers(encoder, scene, objects, &written, &band.raster, held.clone(), timer);
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("sorted layers"),
                    timestamp_writes: timer.as_mut().and_then(|timer| timer.compute_pass("layers_sorted")),
                });
                pass.set_bind_group(0, &band.sort, &[]);
                for (class, sort) in (1..).zip(&self.sort) {
                    pass.set_pipeline(sort);
                    pass.dispatch_workgroups_indirect(tally, class * CLASS_BYTES);
                }
            }
            if let Some((all, bands)) = &self.all_lists {
                for (from, words) in [ends, runs].into_iter().zip(bands[index].words(self.size[0])) {
                    let bytes = words as u64 * 4;
                    encoder.copy_buffer_to_buffer(from, 0, all, copied, Some(bytes));
                    copied += bytes;
                }
            }
            let clears = to.clears && index == 0;
            let groups = [&scene.group, shade_group, &band.blend];
            if let Some(mark) = &plan.mark {
                shade.draw_layers(encoder, mark, groups, pass.view, to, false, held.clone(), timer);
            }
            shade.draw_layers(encoder, &plan.shade, groups, pass.view, to, clears, rows.clone(), timer);
            if let Some(nearest) = self.nearest.as_ref().filter(|_| plan.has_nearest()) {
                let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                    label: Some("nearest layers"),
                    color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                        view: to.ids,
                        depth_slice: None,
                        resolve_target: None,
                        ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
                    })],
                    depth_stencil_attachment: None,
                    timestamp_writes: timer.as_mut().and_then(|timer| timer.pass("layers_nearest")),
                    occlusion_query_set: None,
                    multiview_mask: None,
                });
                pass.set_pipeline(nearest);
                pass.set_bind_group(0, &band.blend, &[]);
                pass.set_scissor_rect(0, rows.start, self.size[0], rows.end - rows.start);
                pass.draw(0..3, 0..1);
            }
        }
        Ok(())
    }

    /// Whether the pool held all fragments of the frame that was submitted last; where not, it has grown. Waits for the frame.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where the totals cannot be read.
    pub fn finish(&mut self, gpu: &Gpu, memory_bytes: u64) -> Result<bool, GpuError> {
        let Some((readable, _)) = self.readable.as_ref().filter(|_| self.num_totals > 0) else { return Ok(true) };
        let bytes = self.num_totals * TOTAL_BYTES;
        readable.map_async(wgpu::MapMode::Read, ..bytes, |_| {});
        gpu.wait()?;
        let needed = {
            let mapped = readable.get_mapped_range(..bytes).map_err(|error| GpuError::Driver(error.to_string()))?;
            let totals = mapped.chunks_exact(TOTAL_BYTES as usize).map(bytemuck::pod_read_unaligned::<[u32; 2]>);
            totals.map(|[total, beyond]| u64::from(if beyond == 0 { total } else { u32::MAX })).max().unwrap_or(0)
        };
        readable.unmap();
        if needed <= self.capacity {
            return Ok(true);
        }
        let wanted = (needed as f64 * SLACKS[usize::from(self.has_grown)]) as u64;
        self.has_grown = true;
        let most = most_bytes(gpu, memory_bytes) / self.each.bytes();
        if wanted > most && self.each.light {
            // Drawn again without their light, which may fit at once.
            self.is_too_much = true;
            return Ok(false);
        }
        if wanted > most {
            self.num_bands = (u64::from(self.num_bands) * wanted.div_ceil(most.max(1))).min(u64::from(u32::MAX)) as u32;
            (self.ends, self.runs) = (None, None);
        }
        self.capacity = wanted.min(most);
        Ok(false)
    }
}

/// The WGSL of nearest ids.
pub fn nearest_module() -> Module {
    Module::new(&[
        wgsl!("lib/fullscreen.wgsl"),
        wgsl!("lib/layers.wgsl"),
        wgsl!("lib/layer_lists.wgsl"),
        wgsl!("layers/nearest.wgsl"),
    ])
}

/// The WGSL that gives lists their room.
pub fn room_module() -> Module {
    let mut module = Module::new(&[wgsl!("lib/layers.wgsl")]);
    module.add_generated("classes of runs", sort::constants());
    module.add(wgsl!("layers/room.wgsl"));
    module
}
