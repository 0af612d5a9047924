//! The pictures that passes draw to, kept from frame to frame while size and need stay.

use super::post::{COLOR_FORMAT, GEOMETRY_FORMAT};
use super::{DEPTH_FORMAT, ID_FORMAT, light_format};
use crate::gpu::{Gpu, GpuError};

/// Bytes of each target, by name.
pub type TargetBytes = Vec<(&'static str, u64)>;

/// A texture with the view that bind groups know it by.
pub(super) struct Target {
    texture: wgpu::Texture,
    /// To draw to and to read.
    pub view: wgpu::TextureView,
}

impl Target {
    pub fn new(gpu: &Gpu, label: &'static str, size: [u32; 2], format: wgpu::TextureFormat) -> Target {
        let texture = gpu.target(label, size, 1, format);
        let view = texture.create_view(&Default::default());
        Target { texture, view }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> u64 {
        let block = self.texture.format().block_copy_size(None).unwrap_or(4);
        u64::from(self.texture.width()) * u64::from(self.texture.height()) * u64::from(block)
    }
}

/// What post effects read: the light of one sample, and its surfaces.
struct Shaded {
    /// Two only where an effect leaves surfaces to the next one.
    geometry: Vec<Target>,
    /// Two only where one effect's picture is the next one's.
    colors: Vec<Target>,
    /// Of each two more only where lines are drawn apart.
    lines: Option<([Target; 2], [Target; 2])>,
}

/// How often a picture of one sample is changed after it was shaded.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Chain {
    /// Pictures that are changed: by post effects, and by layers.
    pub pictures: usize,
    /// Which of them leave surfaces of their own.
    pub surfaces: usize,
    /// Whether lines are drawn apart, as pictures and surfaces of their own.
    pub lines: bool,
}

/// What post effects read and draw to.
pub struct ShadedViews {
    /// The surfaces of a sample.
    pub geometry: Vec<wgpu::TextureView>,
    /// The pictures that effects change in turn.
    pub colors: Vec<wgpu::TextureView>,
    /// The same of lines that are drawn apart; empty where none are.
    pub line_geometry: Vec<wgpu::TextureView>,
    /// Their pictures.
    pub line_colors: Vec<wgpu::TextureView>,
}

struct Set {
    size: [u32; 2],
    ids: Target,
    depth: Target,
    output: Target,
    light: Option<Target>,
    shaded: Option<Shaded>,
}

/// The targets of the last frame.
#[derive(Default)]
pub struct Targets {
    set: Option<Set>,
    shadow_bytes: u64,
    effect_bytes: u64,
    layer_bytes: u64,
}

impl Targets {
    /// Makes the targets fit; what fits already stays. `light` asks for the target in which samples add up, `chain` for
    /// what post effects and layers read.
    pub fn fit(&mut self, gpu: &Gpu, size: [u32; 2], output: wgpu::TextureFormat, light: bool, chain: Chain) {
        let former = self.set.take().filter(|set| set.size == size);
        let make = |label, format| Target::new(gpu, label, size, format);
        let (ids, depth, former_output, former_light, former_shaded) = match former {
            Some(set) => (set.ids, set.depth, Some(set.output), set.light, set.shaded),
            None => (make("ids", ID_FORMAT), make("depth", DEPTH_FORMAT), None, None, None),
        };
        let output =
            former_output.filter(|target| target.texture.format() == output).unwrap_or_else(|| make("output", output));
        let light = light.then(|| former_light.unwrap_or_else(|| make("light", light_format(gpu))));
        let shaded = (chain.pictures > 0).then(|| {
            let none = || Shaded { geometry: Vec::new(), colors: Vec::new(), lines: None };
            let mut shaded = former_shaded.unwrap_or_else(none);
            let counts = [chain.pictures.min(2), 1 + chain.surfaces.min(1)];
            shaded.colors.truncate(counts[0]);
            shaded.geometry.truncate(counts[1]);
            while shaded.colors.len() < counts[0] {
                shaded.colors.push(make("color", COLOR_FORMAT));
            }
            while shaded.geometry.len() < counts[1] {
                shaded.geometry.push(make("geometry", GEOMETRY_FORMAT));
            }
            shaded.lines = shaded.lines.filter(|_| chain.lines);
            if chain.lines && shaded.lines.is_none() {
                let two = |label, format| [make(label, format), make(label, format)];
                shaded.lines = Some((two("line geometry", GEOMETRY_FORMAT), two("line color", COLOR_FORMAT)));
            }
            shaded
        });
        self.set = Some(Set { size, ids, depth, output, light, shaded });
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

    /// What post effects read and draw to, if this frame has any.
    pub fn shaded_views(&self) -> Option<ShadedViews> {
        let shaded = self.set.as_ref()?.shaded.as_ref()?;
        let views = |of: &[Target]| of.iter().map(|target| target.view.clone()).collect();
        let (line_geometry, line_colors) = shaded.lines.as_ref().map_or((&[][..], &[][..]), |(a, b)| (a, b));
        Some(ShadedViews {
            geometry: views(&shaded.geometry),
            colors: views(&shaded.colors),
            line_geometry: views(line_geometry),
            line_colors: views(line_colors),
        })
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

    /// Notes what the textures of the frame's post effects take.
    pub fn note_effect_bytes(&mut self, bytes: u64) {
        self.effect_bytes = bytes;
    }

    /// Notes what the frame's layers take.
    pub fn note_layer_bytes(&mut self, bytes: u64) {
        self.layer_bytes = bytes;
    }

    /// Bytes of each target.
    pub fn bytes(&self) -> TargetBytes {
        let Some(set) = &self.set else { return Vec::new() };
        let mut all = vec![("ids", set.ids.bytes()), ("depth", set.depth.bytes()), ("output", set.output.bytes())];
        all.extend(set.light.as_ref().map(|light| ("light", light.bytes())));
        if let Some(shaded) = &set.shaded {
            all.push(("geometry", shaded.geometry.iter().map(Target::bytes).sum()));
            all.push(("color", shaded.colors.iter().map(Target::bytes).sum()));
            all.extend(
                shaded
                    .lines
                    .as_ref()
                    .map(|(geometry, colors)| ("lines", geometry.iter().chain(colors).map(Target::bytes).sum())),
            );
            all.push(("effects", self.effect_bytes));
        }
        if self.layer_bytes > 0 {
            all.push(("layers", self.layer_bytes));
        }
        if self.shadow_bytes > 0 {
            all.push(("shadow_maps", self.shadow_bytes));
        }
        all
    }
}
