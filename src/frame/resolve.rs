//! Resolve: accumulated linear light to picture values of 8 or 16 bits.

use std::collections::BTreeMap;

use super::fullscreen;
use crate::gpu::{Bound, Gpu, GpuError, KeptBindGroup, Module, PassTimer};
use crate::wgsl;

/// Pipelines of the resolve pass, by bits a channel.
#[derive(Default)]
pub struct Resolve {
    pipelines: BTreeMap<bool, (wgpu::BindGroupLayout, wgpu::RenderPipeline)>,
    group: KeptBindGroup,
}

impl Resolve {
    /// Builds the pipeline for 8 or 16 bits, unless it is there.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where the shader does not compile.
    pub fn prepare(&mut self, gpu: &Gpu, wide: bool) -> Result<(), GpuError> {
        if self.pipelines.contains_key(&wide) {
            return Ok(());
        }
        let light = fullscreen::texture(wgpu::TextureSampleType::Float { filterable: false });
        let layout = fullscreen::layout(gpu, "resolve", &[fullscreen::UNIFORM, light]);
        let (entry, format) = if wide { ("resolve_16", super::OUTPUT_16) } else { ("resolve_8", super::OUTPUT_8) };
        let pipeline = fullscreen::pipeline(gpu, "resolve", &resolve_module(), entry, &[&layout], &[format.into()])?;
        self.pipelines.insert(wide, (layout, pipeline));
        Ok(())
    }

    /// Resolves `light` into `target`, over the background that `output` holds.
    #[allow(clippy::too_many_arguments)]
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        wide: bool,
        output: &wgpu::Buffer,
        light: &wgpu::TextureView,
        target: &wgpu::TextureView,
        timer: &mut Option<PassTimer>,
    ) {
        let Some((layout, pipeline)) = self.pipelines.get(&wide) else { return };
        let bound = vec![(0, Bound::Buffer(output.clone())), (1, Bound::View(light.clone()))];
        let group = self.group.get(gpu, "resolve", layout, bound);
        let times = timer.as_mut().and_then(|timer| timer.pass("resolve"));
        fullscreen::draw(encoder, "resolve", pipeline, &[(&group, &[])], target, times);
    }

    /// Builds the pipelines that are there anew, from the shaders as they are now.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where a shader does not compile.
    pub fn rebuilt(&self, gpu: &Gpu) -> Result<Resolve, GpuError> {
        let mut fresh = Resolve::default();
        self.pipelines.keys().try_for_each(|&wide| fresh.prepare(gpu, wide))?;
        Ok(fresh)
    }
}

/// The WGSL of the resolve pass.
pub fn resolve_module() -> Module {
    Module::new(&[wgsl!("lib/fullscreen.wgsl"), wgsl!("lib/encode.wgsl"), wgsl!("objects/resolve.wgsl")])
}
