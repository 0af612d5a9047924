//! Opening an adapter, and what can go wrong with it.

use std::sync::{Arc, Mutex};

use super::counters::{Counters, Counting};
use super::wgsl::{Module, ShaderEdits};

/// Why the graphics device cannot do what is asked. Exit code 3.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// The machine has no Vulkan driver that works.
    #[error(
        "no graphics adapter was found: restyle needs a Vulkan driver. Without a GPU, install the software driver \
         (Debian, Ubuntu: apt install mesa-vulkan-drivers) and run the command again"
    )]
    NoAdapter,
    /// An adapter is there but gives no device.
    #[error("the adapter {adapter:?} refused to open: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// The driver's words.
        reason: String,
    },
    /// A picture larger than the adapter's textures.
    #[error("a picture of {width}x{height} is larger than this adapter draws: at most {limit} each way")]
    TooLarge {
        /// Asked width in pixels.
        width: u32,
        /// Asked height in pixels.
        height: u32,
        /// Largest side of a texture.
        limit: u32,
    },
    /// More objects than one storage binding holds.
    #[error("{count} {what} need {bytes} bytes, and at most {limit} can be bound at once")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        count: usize,
        /// Bytes that they take.
        bytes: u64,
        /// Bytes that one binding may hold.
        limit: u64,
    },
    /// More of something than a method has room to number.
    #[error("{count} {what} are more than method {method:?} tells apart: at most {limit}")]
    TooManyKinds {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        count: usize,
        /// How many it tells apart.
        limit: usize,
        /// As style files name it.
        method: &'static str,
    },
    /// Whoever asked for the picture does not want it any more.
    #[error("the picture was broken off")]
    BrokenOff,
    /// A shader that was edited in a source tree does not compile.
    #[error("{0}")]
    Shader(String),
    /// Neither scene nor style has loaded yet.
    #[error("there is nothing to draw yet: scene or style has not loaded")]
    NothingToDraw,
    /// The driver reported an error: out of memory, a lost device, or a mistake of ours.
    #[error("the graphics driver reported: {0}")]
    Driver(String),
}

/// An open device and its queue.
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name, driver and kind of the adapter.
    pub info: wgpu::AdapterInfo,
    failure: Arc<Mutex<Option<String>>>,
    counting: Counting,
    readback: Mutex<Option<wgpu::Buffer>>,
    shader_edits: Mutex<Arc<ShaderEdits>>,
}

impl Gpu {
    /// Opens the best adapter, without a window.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] where no driver is installed, [`GpuError::NoDevice`] where it refuses.
    pub fn open() -> Result<Gpu, GpuError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::PRIMARY;
        // Validation layers are a developer's choice, by WGPU_VALIDATION=1.
        descriptor.flags = wgpu::InstanceFlags::empty().with_env();
        let instance = wgpu::Instance::new(descriptor);
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            force_fallback_adapter: false,
            compatible_surface: None,
            apply_limit_buckets: false,
        }))
        .map_err(|_| GpuError::NoAdapter)?;
        let info = adapter.get_info();
        let wanted =
            wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::FLOAT32_BLENDABLE | wgpu::Features::PRIMITIVE_INDEX;
        let available = adapter.limits();
        let limits = wgpu::Limits {
            max_texture_dimension_2d: available.max_texture_dimension_2d,
            max_buffer_size: available.max_buffer_size,
            max_storage_buffer_binding_size: available.max_storage_buffer_binding_size,
            ..Default::default()
        }
        .or_worse_values_from(&available);
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("restyle"),
            required_features: adapter.features() & wanted,
            required_limits: limits,
            ..Default::default()
        }))
        .map_err(|error| GpuError::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        let failure = Arc::new(Mutex::new(None));
        let sink = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut slot) = sink.lock() {
                slot.get_or_insert(error.to_string());
            }
        }));
        Ok(Gpu {
            device,
            queue,
            info,
            failure,
            counting: Counting::default(),
            readback: Mutex::new(None),
            shader_edits: Mutex::default(),
        })
    }

    /// The first error that the driver reported since the last call.
    ///
    /// # Errors
    /// [`GpuError::Driver`] with the driver's words.
    pub fn check(&self) -> Result<(), GpuError> {
        match self.failure.lock().ok().and_then(|mut slot| slot.take()) {
            Some(reason) => Err(GpuError::Driver(reason)),
            None => Ok(()),
        }
    }

    /// Waits until all submitted work is done.
    ///
    /// # Errors
    /// [`GpuError::Driver`] when the device was lost meanwhile.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.device
            .poll(wgpu::PollType::Wait { submission_index: None, timeout: None })
            .map_err(|error| GpuError::Driver(error.to_string()))?;
        self.check()
    }

    /// Whether 32-bit float targets add up in the blender.
    pub fn adds_float32(&self) -> bool {
        self.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE)
    }

    /// Whether the triangles of a draw have numbers in fragment shaders.
    pub fn numbers_triangles(&self) -> bool {
        self.device.features().contains(wgpu::Features::PRIMITIVE_INDEX)
    }

    /// Refuses what is larger than the largest storage binding.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] with both sizes.
    pub fn check_storage(&self, what: &'static str, bytes: usize) -> Result<(), GpuError> {
        let limit = self.device.limits().max_storage_buffer_binding_size;
        if bytes as u64 > limit {
            return Err(GpuError::TooMany { what, count: bytes / 4, bytes: bytes as u64, limit });
        }
        Ok(())
    }

    /// Texts that stand in for shader files of the program.
    pub fn shader_edits(&self) -> Arc<ShaderEdits> {
        self.shader_edits.lock().map_or_else(|poisoned| Arc::clone(&poisoned.into_inner()), |edits| Arc::clone(&edits))
    }

    /// Replaces them; modules that are compiled from now on use them.
    pub fn set_shader_edits(&self, edits: Arc<ShaderEdits>) {
        match self.shader_edits.lock() {
            Ok(mut slot) => *slot = edits,
            Err(poisoned) => *poisoned.into_inner() = edits,
        }
    }

    /// The buffer of the last read-back, if it stayed.
    pub(super) fn take_readback(&self) -> Option<wgpu::Buffer> {
        self.readback.lock().ok().and_then(|mut kept| kept.take())
    }

    /// Keeps a buffer for the next read-back.
    pub(super) fn keep_readback(&self, buffer: wgpu::Buffer) {
        if let Ok(mut kept) = self.readback.lock() {
            *kept = Some(buffer);
        }
    }

    /// What was asked of the device so far.
    pub fn counters(&self) -> Counters {
        self.counting.read()
    }

    /// A buffer of `size` bytes that begins with this content.
    pub fn buffer(&self, label: &'static str, bytes: &[u8], size: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let buffer = self.empty_buffer(label, size as u64, usage | wgpu::BufferUsages::COPY_DST);
        if !bytes.is_empty() {
            self.write_buffer(&buffer, 0, bytes);
        }
        buffer
    }

    /// A buffer of `size` bytes.
    pub fn empty_buffer(&self, label: &'static str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        Counting::one(&self.counting.buffers);
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// Writes to a buffer, whole words.
    pub fn write_buffer(&self, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
        self.counting.write(bytes.len());
        self.queue.write_buffer(buffer, offset, bytes);
    }

    /// Carries pending writes out, so that their copies do not pile up in memory.
    pub fn flush_writes(&self) {
        let submission_index = self.queue.submit([]);
        // A lost device is told by the next frame.
        let _ = self.device.poll(wgpu::PollType::Wait { submission_index: Some(submission_index), timeout: None });
    }

    /// Writes to a texture.
    pub fn write_texture(
        &self,
        to: wgpu::TexelCopyTextureInfo<'_>,
        bytes: &[u8],
        layout: wgpu::TexelCopyBufferLayout,
        size: wgpu::Extent3d,
    ) {
        self.counting.write(bytes.len());
        self.queue.write_texture(to, bytes, layout, size);
    }

    /// A bind group.
    pub fn bind_group(
        &self,
        label: &'static str,
        layout: &wgpu::BindGroupLayout,
        entries: &[wgpu::BindGroupEntry<'_>],
    ) -> wgpu::BindGroup {
        Counting::one(&self.counting.bind_groups);
        self.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries })
    }

    /// A render pipeline.
    ///
    /// # Errors
    /// [`GpuError::Driver`] with the driver's words where it does not fit its shaders.
    pub fn render_pipeline(
        &self,
        descriptor: &wgpu::RenderPipelineDescriptor<'_>,
    ) -> Result<wgpu::RenderPipeline, GpuError> {
        Counting::one(&self.counting.pipelines);
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let pipeline = self.device.create_render_pipeline(descriptor);
        match pollster::block_on(scope.pop()) {
            Some(error) => Err(GpuError::Driver(error.to_string())),
            None => Ok(pipeline),
        }
    }

    /// A compute pipeline with these groups.
    ///
    /// # Errors
    /// [`GpuError::Driver`] with the driver's words where it does not fit its shader.
    pub fn compute_pipeline(
        &self,
        label: &'static str,
        module: &Module,
        entry: &str,
        groups: &[Option<&wgpu::BindGroupLayout>],
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        let module = module.compile(self, label)?;
        Counting::one(&self.counting.pipelines);
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: groups,
            immediate_size: 0,
        });
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(label),
            layout: Some(&layout),
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        });
        match pollster::block_on(scope.pop()) {
            Some(error) => Err(GpuError::Driver(error.to_string())),
            None => Ok(pipeline),
        }
    }

    /// A texture.
    pub fn texture(&self, descriptor: &wgpu::TextureDescriptor<'_>) -> wgpu::Texture {
        Counting::one(&self.counting.textures);
        self.device.create_texture(descriptor)
    }

    /// A texture that passes draw to, read from, and that can be copied out.
    pub fn target(
        &self,
        label: &'static str,
        size: [u32; 2],
        layers: u32,
        format: wgpu::TextureFormat,
    ) -> wgpu::Texture {
        self.texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }
}
