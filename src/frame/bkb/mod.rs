//! The bucketed k-buffer [Murray2016 §4, §5]: the k nearest fragments of each pixel, in buckets by the shape that they are of, so
//! that the fragment of the same surface in the next pixel is found among few, and curvature by it.
//!
//! Two passes over what is transparent, with compute passes between and after them: Z is filled, sorted as it comes; put in the order of
//! shapes, with B, the buckets; D takes colour and normal of each fragment that was kept; each fragment is stylised by its
//! curvature; and all are blended from far to near. Where a buffer would outgrow a binding or the style's memory, in bands of rows, which
//! hold one row more on each side for the neighbours.
//!
//! Where the paper is silent: a shape is an object (atom, connector, or part of a mesh), of which 65,536 have numbers of their own; depth
//! is in even steps between the near and the far end of what is drawn; colours are sRGB of 8 bits a channel, so that light above 1 is cut
//! off. Twin: `tests/twins/bkb.rs`. Limits: surfaces beyond k are not there; two of one shape at one depth are one; opacity has 8 bits; on a
//! device that rounds a depth differently in the two passes, which are different shaders, that fragment is lost.

mod modules;
mod pipelines;
mod words;

pub use modules::{FragmentKind, blend_module, buckets_module, clear_module, insert_module, store_module};
use pipelines::Pipelines;
pub use words::BkbWords;

use super::layers::{LayerTargets, most_bytes, storage};
use super::objects::ObjectBuffers;
use super::post::Finish;
use super::shade::{Shade, ShadeInputs, ShadeKey};
use super::view::View;
use super::visibility::{SceneBindings, Visibility, VisibilityPass};
use crate::gpu::{Bound, Gpu, GpuError, KeptBindGroup, KeptBuffer, PassTimer};
use crate::gpu_struct;

/// Steps of a stored depth: see `shaders/lib/bkb.wgsl`.
const DEPTH_STEPS: f32 = 65534.0;

/// Materials that 8 bits beside a colour tell apart.
const MOST_MATERIALS: usize = 256;

/// Pixels to a side of a compute pass's group.
const GROUP_PX: u32 = 8;

/// Keys whose pipelines are kept. Ours: a still and its AOVs, a few times over.
const MOST_PIPELINES: usize = 8;

/// Which of [`Shade`]'s groups is ours.
const SHADE_GROUP: usize = 2;

gpu_struct! {
    "lib/bkb.wgsl",
    /// See `shaders/lib/bkb.wgsl`.
    pub struct BkbBand {
        /// Width of what is drawn, in pixels.
        pub width: u32,
        /// Its height.
        pub height: u32,
        /// First row that is stored.
        pub first_row: u32,
        /// Rows that are stored.
        pub num_rows: u32,
        /// First row that is drawn.
        pub first_drawn: u32,
        /// The row after the last that is drawn.
        pub end_drawn: u32,
        /// Slots of a pixel.
        pub k: u32,
        /// Number of the first connector's shape.
        pub first_connector: u32,
        /// Number of the first part's shape.
        pub first_part: u32,
        /// Depth that is stored as 0.
        pub near: f32,
        /// Steps of stored depth in a unit of the scene.
        pub depth_scale: f32,
        /// What curvature is multiplied by before tanh.
        pub curvature_scale: f32,
    }
}

/// How the k-buffer is used. All but the first are for measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum BkbForm {
    /// As in the paper.
    #[default]
    Published,
    /// A neighbour need not find back.
    OneWay,
    /// Neighbours are looked for among all fragments of a pixel, after [Carnecky2013, throughout].
    BruteForce,
    /// No buckets and no curvature: 32 bits of depth and 32 of colour for each slot, after [Kubisch2014, throughout].
    DualPass,
}

impl BkbForm {
    /// Whether it has neither buckets nor curvature.
    pub fn is_dual_pass(self) -> bool {
        self == BkbForm::DualPass
    }

    /// Words of D for each slot.
    fn data_words(self) -> u64 {
        if self.is_dual_pass() { 1 } else { 2 }
    }

    /// Bytes of all buffers for each slot.
    fn slot_bytes(self) -> u64 {
        if self.is_dual_pass() { 8 } else { 16 }
    }
}

/// What pipelines are built for.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct BkbKey {
    /// The shading of fragments.
    pub shade: ShadeKey,
    /// How neighbours are found.
    pub form: BkbForm,
    /// Where the blended picture goes.
    pub finish: Finish,
    /// Whether curvatures are kept, to be read.
    pub keeps_kappa: bool,
}

/// What a frame's k-buffer is drawn by.
#[derive(Debug, Clone, PartialEq)]
pub struct BkbPlan {
    /// Its pipelines.
    pub key: BkbKey,
    /// Slots of a pixel.
    pub k: u32,
    /// Materials of the style.
    pub num_materials: usize,
    /// What curvature is multiplied by before tanh.
    pub curvature_scale: f32,
}

impl BkbPlan {
    /// Slots of a row of a picture.
    fn row_slots(&self, width: u32) -> u64 {
        u64::from(width) * u64::from(self.k)
    }

    /// Most rows that are stored at once, with at most `memory_bytes` for all buffers.
    fn most_rows(&self, gpu: &Gpu, width: u32, memory_bytes: u64) -> u32 {
        let row_bytes = self.row_slots(width) * self.key.form.slot_bytes();
        (self.most_bytes(gpu, memory_bytes) / row_bytes).min(u64::from(u32::MAX)) as u32
    }

    /// Most bytes of all buffers: as many as the style allows, and as the largest of them, D, can be bound with.
    fn most_bytes(&self, gpu: &Gpu, memory_bytes: u64) -> u64 {
        let form = self.key.form;
        let bound = most_bytes(gpu, u64::MAX) / (4 * form.data_words()) * form.slot_bytes();
        memory_bytes.min(bound)
    }

    /// Bands of a picture, and bytes of all buffers for the largest of them.
    pub fn bands(&self, gpu: &Gpu, size: [u32; 2], memory_bytes: u64) -> (usize, u64) {
        let rows = band_rows(size[1], self.most_rows(gpu, size[0], memory_bytes));
        (rows.len(), most_stored(&rows) * self.row_slots(size[0]) * self.key.form.slot_bytes())
    }
}

/// The slots of the rows of a band.
struct Buffers {
    slots: u64,
    has_kappa: bool,
    is_dual_pass: bool,
    z: wgpu::Buffer,
    b: Option<wgpu::Buffer>,
    d: wgpu::Buffer,
    kappa: Option<wgpu::Buffer>,
}

impl Buffers {
    fn new(gpu: &Gpu, slots: u64, key: &BkbKey) -> Buffers {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let make = |label, words: u64| gpu.empty_buffer(label, slots * words * 4, usage);
        Buffers {
            slots,
            has_kappa: key.keeps_kappa,
            is_dual_pass: key.form.is_dual_pass(),
            z: make("bkb z", 1),
            b: (!key.form.is_dual_pass()).then(|| make("bkb b", 1)),
            d: make("bkb d", key.form.data_words()),
            kappa: key.keeps_kappa.then(|| make("bkb kappa", 1)),
        }
    }

    fn fits(&self, slots: u64, key: &BkbKey) -> bool {
        let is_dual_pass = key.form.is_dual_pass();
        self.slots == slots && self.has_kappa == key.keeps_kappa && self.is_dual_pass == is_dual_pass
    }
}

struct BandSlot {
    params: KeptBuffer,
    group: KeptBindGroup,
}

/// What the k-buffer keeps from frame to frame.
#[derive(Default)]
pub struct Bkb {
    /// The key used last comes last.
    pipelines: Vec<(BkbKey, Pipelines)>,
    buffers: Option<Buffers>,
    bands: Vec<BkbBand>,
    slots: Vec<BandSlot>,
}

/// Rows of a band: those that are drawn, and those that are stored.
type BandRows = [std::ops::Range<u32>; 2];

/// Rows that the largest of some bands stores.
fn most_stored(bands: &[BandRows]) -> u64 {
    bands.iter().map(|[_, stored]| u64::from(stored.end - stored.start)).max().unwrap_or(0)
}

/// The bands of a picture, which store at most so many rows.
fn band_rows(height: u32, most_rows: u32) -> Vec<BandRows> {
    if most_rows >= height {
        return vec![[0..height, 0..height]];
    }
    let most_drawn = most_rows.saturating_sub(2).max(1);
    let rows = |index: u32| index * most_drawn..((index + 1) * most_drawn).min(height);
    let stored = |rows: &std::ops::Range<u32>| rows.start.saturating_sub(1)..(rows.end + 1).min(height);
    (0..height.div_ceil(most_drawn)).map(rows).map(|rows| [rows.clone(), stored(&rows)]).collect()
}

impl Bkb {
    /// Builds the pipelines of a plan, unless they are there.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile, [`GpuError::TooManyKinds`] of materials.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        visibility: &Visibility,
        shade: &mut Shade,
        plan: &BkbPlan,
    ) -> Result<(), GpuError> {
        if plan.num_materials > MOST_MATERIALS {
            return Err(GpuError::TooManyKinds {
                what: "materials",
                count: plan.num_materials,
                limit: MOST_MATERIALS,
                method: "bkb",
            });
        }
        let entry = match self.pipelines.iter().position(|(key, _)| *key == plan.key) {
            Some(index) => self.pipelines.remove(index),
            None => {
                shade.upload(gpu, &plan.key.shade)?;
                (plan.key.clone(), Pipelines::new(gpu, visibility, shade, &plan.key)?)
            }
        };
        if self.pipelines.len() >= MOST_PIPELINES {
            self.pipelines.remove(0);
        }
        self.pipelines.push(entry);
        Ok(())
    }

    /// Builds the pipelines that are there anew, from the shaders as they are now.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile; nothing has changed then.
    pub fn rebuild(&mut self, gpu: &Gpu, visibility: &Visibility, shade: &Shade) -> Result<(), GpuError> {
        let fresh = |(key, _): &(BkbKey, Pipelines)| Ok((key.clone(), Pipelines::new(gpu, visibility, shade, key)?));
        self.pipelines = self.pipelines.iter().map(fresh).collect::<Result<_, GpuError>>()?;
        Ok(())
    }

    /// Gives the memory back.
    pub fn forget_buffers(&mut self) {
        (self.buffers, self.bands) = (None, Vec::new());
        self.slots.clear();
    }

    /// Makes the buffers fit a picture, with at most `memory_bytes` for all of them.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] where three rows of the picture alone outgrow them, [`GpuError::Driver`] where there is no memory.
    pub fn begin(
        &mut self,
        gpu: &Gpu,
        (view, size): (&View, [u32; 2]),
        memory_bytes: u64,
        plan: &BkbPlan,
        objects: &ObjectBuffers,
    ) -> Result<(), GpuError> {
        let row_slots = plan.row_slots(size[0]);
        let most_rows = plan.most_rows(gpu, size[0], memory_bytes);
        if most_rows < size[1].min(3) {
            return Err(GpuError::TooMany {
                what: "layers of three rows, which transparency.memory_mb limits, too,",
                count: (3 * row_slots) as usize,
                bytes: 3 * row_slots * plan.key.form.slot_bytes(),
                limit: plan.most_bytes(gpu, memory_bytes),
            });
        }
        let rows = band_rows(size[1], most_rows);
        let slots = most_stored(&rows) * row_slots;
        if self.buffers.as_ref().is_none_or(|buffers| !buffers.fits(slots, &plan.key)) {
            self.buffers = None;
            self.buffers = Some(Buffers::new(gpu, slots, &plan.key));
        }
        let band = |[drawn, stored]: BandRows| BkbBand {
            width: size[0],
            height: size[1],
            first_row: stored.start,
            num_rows: stored.end - stored.start,
            first_drawn: drawn.start,
            end_drawn: drawn.end,
            k: plan.k,
            first_connector: objects.num_atoms,
            first_part: objects.num_atoms + objects.num_connectors,
            near: view.near,
            depth_scale: DEPTH_STEPS / (view.far - view.near).max(f32::MIN_POSITIVE),
            curvature_scale: plan.curvature_scale,
        };
        self.bands = rows.into_iter().map(band).collect();
        let slot = || BandSlot { params: KeptBuffer::uniform("bkb"), group: KeptBindGroup::default() };
        self.slots.resize_with(self.bands.len(), slot);
        gpu.check()
    }

    /// Bytes of the buffers.
    pub fn bytes(&self) -> u64 {
        let Some(Buffers { z, b, d, kappa, .. }) = &self.buffers else { return 0 };
        [Some(z), b.as_ref(), Some(d), kappa.as_ref()].into_iter().flatten().map(wgpu::Buffer::size).sum()
    }

    /// Binds what shading reads; none where the plan's pipelines are not there.
    ///
    /// # Errors
    /// Never for uniforms of a fixed size.
    pub fn bind_shading(
        &self,
        gpu: &Gpu,
        shade: &mut Shade,
        plan: &BkbPlan,
        inputs: &ShadeInputs<'_>,
    ) -> Result<Option<wgpu::BindGroup>, GpuError> {
        let Some((_, pipelines)) = self.pipelines.iter().find(|(key, _)| *key == plan.key) else { return Ok(None) };
        let bound = shade.bind_to(gpu, &plan.key.shade, (&pipelines.shade_layout, SHADE_GROUP), inputs)?;
        Ok(bound.map(|(group, _)| group))
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
        visibility: &Visibility,
        plan: &BkbPlan,
        (scene, objects): (&SceneBindings, &ObjectBuffers),
        pass: &VisibilityPass<'_>,
        shade_group: &wgpu::BindGroup,
        to: &LayerTargets<'_>,
        timer: &mut Option<PassTimer>,
    ) -> Result<(), GpuError> {
        let (Some((_, pipelines)), Some(buffers), Some(picture)) =
            (self.pipelines.iter().find(|(key, _)| *key == plan.key), &self.buffers, to.to)
        else {
            return Ok(());
        };
        let offset = SceneBindings::offset(pass.view);
        for (index, (band, slot)) in self.bands.iter().zip(&mut self.slots).enumerate() {
            let params = slot.params.set(gpu, bytemuck::bytes_of(band), size_of::<BkbBand>())?;
            let buffer = |binding, buffer: &wgpu::Buffer| (binding, Bound::Buffer(buffer.clone()));
            let mut bound = vec![
                (0, Bound::Buffer(params)),
                buffer(1, &buffers.z),
                buffer(3, &buffers.d),
                (5, Bound::View(to.depth.clone())),
                (6, Bound::View(to.color.clone())),
            ];
            bound.extend(buffers.b.as_ref().map(|b| buffer(2, b)));
            bound.extend(buffers.kappa.as_ref().map(|kappa| buffer(4, kappa)));
            let group = slot.group.get(gpu, "bkb", &pipelines.layout, bound);
            let compute =
                |encoder: &mut wgpu::CommandEncoder, name, pipeline, timer: &mut Option<PassTimer>, rows: u32| {
                    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                        label: Some(name),
                        timestamp_writes: timer.as_mut().and_then(|timer| timer.compute_pass(name)),
                    });
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(0, &scene.group, &[offset]);
                    pass.set_bind_group(1, shade_group, &[]);
                    pass.set_bind_group(2, &group, &[]);
                    pass.dispatch_workgroups(band.width.div_ceil(GROUP_PX), rows.div_ceil(GROUP_PX), 1);
                };
            let stored = band.first_row..band.first_row + band.num_rows;
            let raster = |name| VisibilityPass { name, ..*pass };

            compute(encoder, "bkb_cleared", &pipelines.clear, timer, band.num_rows);
            let (inserted, pipeline) = (raster("bkb_inserted"), |kind| pipelines.insert.get(&kind));
            let groups = [(2, &group)];
            visibility.draw_fragments(encoder, scene, objects, &inserted, &groups, stored.clone(), &pipeline, timer);
            if let Some(buckets) = &pipelines.buckets {
                compute(encoder, "bkb_bucketed", buckets, timer, band.num_rows);
            }
            let (kept, pipeline) = (raster("bkb_stored"), |kind| pipelines.store.get(&kind));
            let groups = [(1, shade_group), (2, &group)];
            visibility.draw_fragments(encoder, scene, objects, &kept, &groups, stored, &pipeline, timer);
            if let Some(stylise) = &pipelines.stylise {
                compute(encoder, "bkb_stylised", stylise, timer, band.end_drawn - band.first_drawn);
            }
            let clears = to.clears && index == 0;
            let load = if clears { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("bkb_blended"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: picture,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
                })],
                depth_stencil_attachment: None,
                timestamp_writes: timer.as_mut().and_then(|timer| timer.pass("bkb_blended")),
                occlusion_query_set: None,
                multiview_mask: None,
            });
            pass.set_pipeline(&pipelines.blend);
            pass.set_bind_group(0, &scene.group, &[offset]);
            pass.set_bind_group(1, shade_group, &[]);
            pass.set_bind_group(2, &group, &[]);
            pass.set_scissor_rect(0, band.first_drawn, band.width, band.end_drawn - band.first_drawn);
            pass.draw(0..3, 0..1);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_draw_every_row_once_and_hold_its_neighbours() {
        for (height, most) in [(1, 1), (10, 10), (10, 9), (100, 3), (101, 50)] {
            let bands = band_rows(height, most);
            let drawn: Vec<u32> = bands.iter().flat_map(|[drawn, _]| drawn.clone()).collect();
            assert_eq!(drawn, (0..height).collect::<Vec<_>>(), "{height}, {most}");
            for [drawn, stored] in bands {
                assert!(stored.len() <= most as usize, "{height}, {most}: {stored:?}");
                assert!(stored.start == drawn.start.saturating_sub(1) && stored.end == (drawn.end + 1).min(height));
            }
        }
    }
}
