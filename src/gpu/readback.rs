//! Copying a texture back to the CPU.

use super::{Gpu, GpuError};

/// The largest buffer that stays for the next read-back, in bytes: a 4K picture of 8 bits. Larger ones go at once.
const MOST_KEPT: u64 = 48 << 20;

/// Reads a whole buffer of words that can be copied from.
///
/// # Errors
/// [`GpuError::Driver`] when the device cannot map the copy.
pub fn read_words(gpu: &Gpu, from: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
    let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
    let buffer = gpu.empty_buffer("readback", from.size(), usage);
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("readback") });
    encoder.copy_buffer_to_buffer(from, 0, &buffer, 0, Some(from.size()));
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    gpu.wait()?;
    let mapped = buffer.get_mapped_range(..).map_err(|error| GpuError::Driver(error.to_string()))?;
    Ok(mapped.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect())
}

/// Reads a two-dimensional texture: tightly packed rows from the top, `bytes_per_pixel` each pixel.
///
/// # Errors
/// [`GpuError::Driver`] when the device cannot map the copy.
pub fn read_texture(gpu: &Gpu, texture: &wgpu::Texture, bytes_per_pixel: u32) -> Result<Vec<u8>, GpuError> {
    let size = texture.size();
    let row = size.width * bytes_per_pixel;
    let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let bytes = u64::from(padded_row) * u64::from(size.height);
    let former = gpu.take_readback().filter(|buffer| buffer.size() == bytes);
    let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
    let buffer = former.unwrap_or_else(|| gpu.empty_buffer("readback", bytes, usage));
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("readback") });
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_row), rows_per_image: None },
        },
        wgpu::Extent3d { depth_or_array_layers: 1, ..size },
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| {});
    gpu.wait()?;
    let pixels = {
        let mapped = buffer.get_mapped_range(..).map_err(|error| GpuError::Driver(error.to_string()))?;
        if row == padded_row {
            mapped.to_vec()
        } else {
            let mut pixels = Vec::with_capacity(row as usize * size.height as usize);
            for line in mapped.chunks_exact(padded_row as usize) {
                pixels.extend_from_slice(&line[..row as usize]);
            }
            pixels
        }
    };
    buffer.unmap();
    if bytes <= MOST_KEPT {
        gpu.keep_readback(buffer);
    }
    Ok(pixels)
}
