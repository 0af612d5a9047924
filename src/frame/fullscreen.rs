//! A pass over all pixels: resolve, the geometry AOVs, and each pass of a post effect.

use crate::gpu::{Gpu, GpuError, Module};

/// The vertex entry of every pass over all pixels, in `lib/fullscreen.wgsl`.
pub const VERTEX: &str = "fullscreen_vertex";

/// Declares what a full-screen pipeline reads at its own group.
pub fn layout(gpu: &Gpu, label: &'static str, types: &[wgpu::BindingType]) -> wgpu::BindGroupLayout {
    layout_at(gpu, label, (0..).zip(types.iter().copied()))
}

/// The same with bindings of its own.
pub fn layout_at(
    gpu: &Gpu,
    label: &'static str,
    bindings: impl Iterator<Item = (u32, wgpu::BindingType)>,
) -> wgpu::BindGroupLayout {
    let entries: Vec<wgpu::BindGroupLayoutEntry> = bindings
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        })
        .collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// Builds a pipeline that covers its targets with one triangle.
///
/// # Errors
/// [`GpuError::Driver`] where the shader does not compile.
pub fn pipeline(
    gpu: &Gpu,
    label: &'static str,
    module: &Module,
    entry: &str,
    layouts: &[&wgpu::BindGroupLayout],
    targets: &[wgpu::ColorTargetState],
) -> Result<wgpu::RenderPipeline, GpuError> {
    let module = module.compile(gpu, label)?;
    let layouts: Vec<Option<&wgpu::BindGroupLayout>> = layouts.iter().map(|layout| Some(*layout)).collect();
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(VERTEX),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &targets.iter().cloned().map(Some).collect::<Vec<_>>(),
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws it onto a cleared target: `groups` in order, each with its dynamic offsets.
pub fn draw(
    encoder: &mut wgpu::CommandEncoder,
    label: &'static str,
    pipeline: &wgpu::RenderPipeline,
    groups: &[(&wgpu::BindGroup, &[u32])],
    target: &wgpu::TextureView,
    times: Option<wgpu::RenderPassTimestampWrites<'_>>,
) {
    draw_onto(encoder, label, pipeline, groups, &[(target, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))], times);
}

/// The same onto targets that are cleared or not.
pub fn draw_onto(
    encoder: &mut wgpu::CommandEncoder,
    label: &'static str,
    pipeline: &wgpu::RenderPipeline,
    groups: &[(&wgpu::BindGroup, &[u32])],
    targets: &[(&wgpu::TextureView, wgpu::LoadOp<wgpu::Color>)],
    times: Option<wgpu::RenderPassTimestampWrites<'_>>,
) {
    let attachment = |&(view, load): &(_, wgpu::LoadOp<wgpu::Color>)| {
        let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
        Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &targets.iter().map(attachment).collect::<Vec<_>>(),
        depth_stencil_attachment: None,
        timestamp_writes: times,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    pass.set_pipeline(pipeline);
    for (index, (group, offsets)) in (0..).zip(groups) {
        pass.set_bind_group(index, *group, offsets);
    }
    pass.draw(0..3, 0..1);
}

/// A texture whose values are read without a filter.
pub const fn texture(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled: false }
}

/// A whole uniform buffer.
pub const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};
