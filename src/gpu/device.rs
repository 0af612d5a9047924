//! Opening an adapter, and what can go wrong with it.

use std::sync::{Arc, Mutex};

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
    #[error("{count} {what} need {bytes} bytes, and this adapter binds at most {limit} at once")]
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
        let wanted = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::FLOAT32_BLENDABLE;
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
        Ok(Gpu { device, queue, info, failure })
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

    /// A storage buffer with this content. An empty one holds one unused element, since bindings may not be empty.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] beyond the largest storage binding.
    pub fn storage<T: bytemuck::Pod>(&self, what: &'static str, items: &[T]) -> Result<wgpu::Buffer, GpuError> {
        let bytes = std::mem::size_of_val(items) as u64;
        let limit = self.device.limits().max_storage_buffer_binding_size;
        if bytes > limit {
            return Err(GpuError::TooMany { what, count: items.len(), bytes, limit });
        }
        Ok(self.buffer(what, bytemuck::cast_slice(items), size_of::<T>(), wgpu::BufferUsages::STORAGE))
    }

    /// A uniform buffer that holds `count` elements, the first of them given by `bytes`.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] where more are given.
    pub fn uniform_array(
        &self,
        what: &'static str,
        bytes: &[u8],
        element: usize,
        count: usize,
    ) -> Result<wgpu::Buffer, GpuError> {
        if bytes.len() > element * count {
            let given = bytes.len() / element;
            return Err(GpuError::TooMany {
                what,
                count: given,
                bytes: bytes.len() as u64,
                limit: (element * count) as u64,
            });
        }
        Ok(self.buffer(what, bytes, element * count, wgpu::BufferUsages::UNIFORM))
    }

    /// A uniform buffer with this content.
    pub fn uniform<T: bytemuck::Pod>(&self, label: &'static str, value: &T) -> wgpu::Buffer {
        self.buffer(label, bytemuck::bytes_of(value), size_of::<T>(), wgpu::BufferUsages::UNIFORM)
    }

    fn buffer(&self, label: &'static str, bytes: &[u8], least: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let size = bytes.len().max(least).next_multiple_of(16) as u64;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// A texture that passes draw to, read from, and that can be copied out.
    pub fn target(
        &self,
        label: &'static str,
        size: [u32; 2],
        layers: u32,
        format: wgpu::TextureFormat,
    ) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
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
