//! Resolve: accumulated linear light to picture values of 8 or 16 bits.

use std::collections::BTreeMap;

use super::fullscreen;
use super::shade::Output;
use crate::gpu::{Gpu, GpuError, Module, PassTimer};
use crate::wgsl;

/// Pipelines of the resolve pass, by bits a channel.
#[derive(Default)]
pub struct Resolve {
    pipelines: BTreeMap<bool, (wgpu::BindGroupLayout, wgpu::RenderPipeline)>,
}

impl Resolve {
    /// Builds the pipeline for 8 or 16 bits, unless it is there. Returns how many were built.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where the shader does not compile.
    pub fn prepare(&mut self, gpu: &Gpu, wide: bool) -> Result<u32, GpuError> {
        if self.pipelines.contains_key(&wide) {
            return Ok(0);
        }
        let light = fullscreen::texture(wgpu::TextureSampleType::Float { filterable: false });
        let layout = fullscreen::layout(gpu, "resolve", &[fullscreen::UNIFORM, light]);
        let (entry, format) = if wide { ("resolve_16", super::OUTPUT_16) } else { ("resolve_8", super::OUTPUT_8) };
        let pipeline =
            fullscreen::pipeline(gpu, "resolve", &resolve_module(), ["resolve_vertex", entry], &[&layout], format)?;
        self.pipelines.insert(wide, (layout, pipeline));
        Ok(1)
    }

    /// Resolves `light` into `target`.
    #[allow(clippy::too_many_arguments)]
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        wide: bool,
        output: &Output,
        light: &wgpu::TextureView,
        target: &wgpu::TextureView,
        timer: &mut Option<PassTimer>,
    ) {
        let Some((layout, pipeline)) = self.pipelines.get(&wide) else { return };
        let output = gpu.uniform("output", output);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("resolve"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: output.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(light) },
            ],
        });
        let times = timer.as_mut().and_then(|timer| timer.pass("resolve"));
        fullscreen::draw(encoder, "resolve", pipeline, &[(&group, &[])], target, times);
    }
}

/// The WGSL of the resolve pass.
pub fn resolve_module() -> Module {
    Module::new(&[wgsl!("lib/encode.wgsl"), wgsl!("objects/resolve.wgsl")])
}
