//! Time that each pass takes on the device, by timestamp queries where the adapter has them.

use super::{Gpu, GpuError};

/// Passes that one timer holds at the most; later ones are not timed.
const MAX_PASSES: u32 = 64;

/// Milliseconds of each pass, in order; passes of one name are added up.
pub type PassTimes = Vec<(&'static str, f64)>;

/// Records when passes begin and end.
pub struct PassTimer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
    names: Vec<&'static str>,
    period_ns: f64,
}

impl PassTimer {
    /// A timer, or none where the adapter has no timestamps.
    pub fn new(gpu: &Gpu) -> Option<PassTimer> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let size = u64::from(MAX_PASSES) * 2 * 8;
        let buffer = |label, usage| gpu.empty_buffer(label, size, usage);
        Some(PassTimer {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count: MAX_PASSES * 2,
            }),
            resolved: buffer("pass times", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readable: buffer("pass times readable", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST),
            names: Vec::new(),
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// Where the next pass writes its times.
    pub fn pass(&mut self, name: &'static str) -> Option<wgpu::RenderPassTimestampWrites<'_>> {
        let index = self.names.len() as u32;
        if index >= MAX_PASSES {
            return None;
        }
        self.names.push(name);
        Some(wgpu::RenderPassTimestampWrites {
            query_set: &self.queries,
            beginning_of_pass_write_index: Some(2 * index),
            end_of_pass_write_index: Some(2 * index + 1),
        })
    }

    /// The same for a compute pass.
    pub fn compute_pass(&mut self, name: &'static str) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        let wgpu::RenderPassTimestampWrites { query_set, beginning_of_pass_write_index, end_of_pass_write_index } =
            self.pass(name)?;
        Some(wgpu::ComputePassTimestampWrites { query_set, beginning_of_pass_write_index, end_of_pass_write_index })
    }

    /// Ends the recording of a frame.
    pub fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        let count = self.names.len() as u32 * 2;
        if count > 0 {
            encoder.resolve_query_set(&self.queries, 0..count, &self.resolved, 0);
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, Some(u64::from(count) * 8));
        }
    }

    /// The times of the frame that was submitted last. Waits for it.
    ///
    /// # Errors
    /// [`GpuError::Driver`] when the device cannot map the times.
    pub fn read(&self, gpu: &Gpu) -> Result<PassTimes, GpuError> {
        let bytes = self.names.len() as u64 * 16;
        if bytes == 0 {
            return Ok(Vec::new());
        }
        self.readable.map_async(wgpu::MapMode::Read, ..bytes, |_| {});
        gpu.wait()?;
        let ticks: Vec<u64> = {
            let mapped =
                self.readable.get_mapped_range(..bytes).map_err(|error| GpuError::Driver(error.to_string()))?;
            mapped.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect()
        };
        self.readable.unmap();
        let mut times: PassTimes = Vec::new();
        for (name, ticks) in self.names.iter().zip(ticks.chunks_exact(2)) {
            let ms = ticks[1].saturating_sub(ticks[0]) as f64 * self.period_ns * 1e-6;
            match times.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += ms,
                None => times.push((name, ms)),
            }
        }
        Ok(times)
    }
}
