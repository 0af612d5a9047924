//! The pictures that passes draw to, kept from frame to frame while size and need stay.

use super::{DEPTH_FORMAT, ID_FORMAT, light_format};
use crate::gpu::{Gpu, GpuError};

/// Bytes of each target, by name.
pub type TargetBytes = Vec<(&'static str, u64)>;

/// A texture with the view that bind groups know it by.
struct Target {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

impl Target {
    fn new(gpu: &Gpu, label: &'static str, size: [u32; 2], format: wgpu::TextureFormat) -> Target {
        let texture = gpu.target(label, size, 1, format);
        let view = texture.create_view(&Default::default());
        Target { texture, view }
    }
}

struct Set {
    size: [u32; 2],
    ids: Target,
    depth: Target,
    output: Target,
    light: Option<Target>,
}

/// The targets of the last frame.
#[derive(Default)]
pub struct Targets {
    set: Option<Set>,
    shadow_bytes: u64,
}

impl Targets {
    /// Makes the targets fit; what fits already stays. `light` asks for the target in which samples add up.
    pub fn fit(&mut self, gpu: &Gpu, size: [u32; 2], output: wgpu::TextureFormat, light: bool) {
        let former = self.set.take().filter(|set| set.size == size);
        let make = |label, format| Target::new(gpu, label, size, format);
        let (ids, depth, former_output, former_light) = match former {
            Some(set) => (set.ids, set.depth, Some(set.output), set.light),
            None => (make("ids", ID_FORMAT), make("depth", DEPTH_FORMAT), None, None),
        };
        let output =
            former_output.filter(|target| target.texture.format() == output).unwrap_or_else(|| make("output", output));
        let light = light.then(|| former_light.unwrap_or_else(|| make("light", light_format(gpu))));
        self.set = Some(Set { size, ids, depth, output, light });
    }

    fn set(&self) -> Result<&Set, GpuError> {
        self.set.as_ref().ok_or_else(|| GpuError::Driver("nothing was drawn yet".to_owned()))
    }

    /// Ids, depth and output, to draw to.
    ///
    /// # Errors
    /// [`GpuError::Driver`] before the first frame.
    pub fn views(&self) -> Result<[wgpu::TextureView; 3], GpuError> {
        let set = self.set()?;
        Ok([&set.ids, &set.depth, &set.output].map(|target| target.view.clone()))
    }

    /// Where samples add up, if this frame adds any.
    pub fn light_view(&self) -> Option<wgpu::TextureView> {
        Some(self.set.as_ref()?.light.as_ref()?.view.clone())
    }

    /// The picture.
    ///
    /// # Errors
    /// [`GpuError::Driver`] before the first frame.
    pub fn output(&self) -> Result<&wgpu::Texture, GpuError> {
        Ok(&self.set()?.output.texture)
    }

    /// The accumulated light.
    ///
    /// # Errors
    /// [`GpuError::Driver`] where the last frame added none.
    pub fn light(&self) -> Result<&wgpu::Texture, GpuError> {
        let light = self.set()?.light.as_ref().map(|light| &light.texture);
        light.ok_or_else(|| GpuError::Driver("this frame kept no linear light".to_owned()))
    }

    /// The ids.
    ///
    /// # Errors
    /// [`GpuError::Driver`] before the first frame.
    pub fn ids(&self) -> Result<&wgpu::Texture, GpuError> {
        Ok(&self.set()?.ids.texture)
    }

    /// Notes what the frame's shadow maps take.
    pub fn note_shadow_bytes(&mut self, bytes: u64) {
        self.shadow_bytes = bytes;
    }

    /// Bytes of each target.
    pub fn bytes(&self) -> TargetBytes {
        let Some(set) = &self.set else { return Vec::new() };
        let bytes = |target: &Target| {
            let block = target.texture.format().block_copy_size(None).unwrap_or(4);
            u64::from(set.size[0]) * u64::from(set.size[1]) * u64::from(block)
        };
        let mut all = vec![("ids", bytes(&set.ids)), ("depth", bytes(&set.depth)), ("output", bytes(&set.output))];
        all.extend(set.light.as_ref().map(|light| ("light", bytes(light))));
        if self.shadow_bytes > 0 {
            all.push(("shadow_maps", self.shadow_bytes));
        }
        all
    }
}
