//! Pipelines of the bucketed k-buffer's passes, built for what a style uses.

use std::collections::BTreeMap;

use super::modules::{self, FragmentKind};
use super::{BkbKey, storage};
use crate::frame::fullscreen;
use crate::frame::post;
use crate::frame::shade::Shade;
use crate::frame::visibility::{self, Kind, Visibility};
use crate::gpu::{Gpu, GpuError};

/// The pipelines of one key.
pub struct Pipelines {
    /// What shading binds.
    pub shade_layout: wgpu::BindGroupLayout,
    /// What all passes bind of the k-buffer.
    pub layout: wgpu::BindGroupLayout,
    /// Empties slots.
    pub clear: wgpu::ComputePipeline,
    /// The first pass over objects.
    pub insert: BTreeMap<Kind, wgpu::RenderPipeline>,
    /// Makes buckets, where there are any.
    pub buckets: Option<wgpu::ComputePipeline>,
    /// The second pass over objects.
    pub store: BTreeMap<Kind, wgpu::RenderPipeline>,
    /// Finds colour and opacity by curvature.
    pub stylise: Option<wgpu::ComputePipeline>,
    /// Blends.
    pub blend: wgpu::RenderPipeline,
}

/// What all passes bind of the k-buffer of a key.
fn layout(gpu: &Gpu, key: &BkbKey) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    let color = fullscreen::texture(wgpu::TextureSampleType::Float { filterable: false });
    let mut entries = vec![
        entry(0, fullscreen::UNIFORM),
        storage(1, visibility),
        storage(3, visibility),
        entry(5, fullscreen::texture(wgpu::TextureSampleType::Depth)),
        entry(6, color),
    ];
    if !key.form.is_dual_pass() {
        entries.push(storage(2, visibility));
    }
    if key.keeps_kappa {
        entries.push(storage(4, visibility));
    }
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("bkb"), entries: &entries })
}

impl Pipelines {
    /// Builds them.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    pub fn new(gpu: &Gpu, visibility: &Visibility, shade: &Shade, key: &BkbKey) -> Result<Pipelines, GpuError> {
        let shade_layout = shade.layout(gpu, &key.shade);
        let layout = layout(gpu, key);
        let numbered = gpu.numbers_triangles();
        let scene = Some(&visibility.layout);
        let (alone, beside_scene) = ([None, None, Some(&layout)], [scene, None, Some(&layout)]);
        let all = [scene, Some(&shade_layout), Some(&layout)];
        let (mut insert, mut store) = (BTreeMap::new(), BTreeMap::new());
        for kind in FragmentKind::ALL.into_iter().filter(|kind| kind.is_in(&key.shade)) {
            let module = modules::insert_module(kind, key.form, key.shade.orthographic, numbered);
            insert.insert(kind.drawn(), visibility::object_pipeline(gpu, &module, kind.drawn(), &beside_scene, None)?);
            let module = modules::store_module(kind, key, numbered);
            store.insert(kind.drawn(), visibility::object_pipeline(gpu, &module, kind.drawn(), &all, None)?);
        }
        let module = modules::blend_module(key);
        let is_bucketed = !key.form.is_dual_pass();
        let buckets = is_bucketed
            .then(|| gpu.compute_pipeline("bkb buckets", &modules::buckets_module(), "make_buckets", &alone));
        let stylise = is_bucketed.then(|| gpu.compute_pipeline("bkb stylise", &module, "stylise", &all));
        let blend = fullscreen::pipeline(
            gpu,
            "bkb blend",
            &module,
            "blend_slots",
            &[&visibility.layout, &shade_layout, &layout],
            &[post::target_of(gpu, key.finish)],
        )?;
        Ok(Pipelines {
            clear: gpu.compute_pipeline("bkb clear", &modules::clear_module(key.form), "clear_slots", &alone)?,
            insert,
            buckets: buckets.transpose()?,
            store,
            stylise: stylise.transpose()?,
            blend,
            shade_layout,
            layout,
        })
    }
}
