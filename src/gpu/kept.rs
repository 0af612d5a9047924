//! Buffers and bind groups that outlive a frame and know what they hold, so that a change writes what differs and
//! nothing else.

use std::ops::Range;

use super::{Gpu, GpuError};

/// A buffer that has grown for a large scene is given back once what it holds would fit this many times.
const SHRINK: usize = 4;

/// A buffer with a copy of its content: equal content costs nothing, other content one write of the bytes that differ,
/// content that does not fit a new buffer.
pub struct KeptBuffer {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
    content: Vec<u8>,
}

impl KeptBuffer {
    /// A uniform buffer; there is none before the first content.
    pub fn uniform(label: &'static str) -> KeptBuffer {
        KeptBuffer::new(label, wgpu::BufferUsages::UNIFORM)
    }

    /// A storage buffer; there is none before the first content.
    pub fn storage(label: &'static str) -> KeptBuffer {
        KeptBuffer::new(label, wgpu::BufferUsages::STORAGE)
    }

    fn new(label: &'static str, usage: wgpu::BufferUsages) -> KeptBuffer {
        KeptBuffer { label, usage, buffer: None, content: Vec::new() }
    }

    /// The buffer; none before the first content.
    pub fn get(&self) -> Option<wgpu::Buffer> {
        self.buffer.clone()
    }

    /// Makes the buffer hold `bytes`, a multiple of 4 of them. It is at least `least` bytes long, since bindings may not
    /// be empty and shaders index fixed arrays.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] beyond the largest storage binding.
    pub fn set(&mut self, gpu: &Gpu, bytes: &[u8], least: usize) -> Result<wgpu::Buffer, GpuError> {
        let needed = bytes.len().max(least).next_multiple_of(16);
        if self.usage.contains(wgpu::BufferUsages::STORAGE) {
            gpu.check_storage(self.label, bytes.len())?;
        }
        let fitting = self
            .buffer
            .take()
            .filter(|buffer| (needed..=needed.max(least) * SHRINK).contains(&(buffer.size() as usize)));
        let buffer = match fitting {
            Some(buffer) => {
                if let Some(range) = differing(&self.content, bytes) {
                    gpu.write_buffer(&buffer, range.start as u64, &bytes[range]);
                }
                buffer
            }
            None => gpu.buffer(self.label, bytes, needed, self.usage),
        };
        self.content.clear();
        self.content.extend_from_slice(bytes);
        self.buffer = Some(buffer.clone());
        Ok(buffer)
    }
}

/// The smallest range of `new` outside of which it equals `old`, in whole words; none where all of it does.
pub(super) fn differing(old: &[u8], new: &[u8]) -> Option<Range<usize>> {
    const WORD: usize = wgpu::COPY_BUFFER_ALIGNMENT as usize;
    let shared = old.len().min(new.len());
    let start = old.iter().zip(new).position(|(a, b)| a != b).unwrap_or(shared);
    if start == new.len() {
        return None;
    }
    let end = if new.len() > shared {
        new.len()
    } else {
        new.len() - old[..shared].iter().rev().zip(new.iter().rev()).take_while(|(a, b)| a == b).count()
    };
    Some(start / WORD * WORD..end.next_multiple_of(WORD).min(new.len()))
}

/// What a bind group binds.
#[derive(Debug, Clone, PartialEq)]
pub enum Bound {
    /// A whole buffer.
    Buffer(wgpu::Buffer),
    /// As many bytes of a buffer from a dynamic offset.
    Slice(wgpu::Buffer, u64),
    /// A texture.
    View(wgpu::TextureView),
}

impl Bound {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Bound::Buffer(buffer) => buffer.as_entire_binding(),
            Bound::Slice(buffer, size) => wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer,
                offset: 0,
                size: std::num::NonZeroU64::new(*size),
            }),
            Bound::View(view) => wgpu::BindingResource::TextureView(view),
        }
    }
}

/// A bind group that is made anew only where it binds something else.
#[derive(Default)]
pub struct KeptBindGroup(Option<Grouped>);

/// A bind group with what it was made of.
struct Grouped {
    layout: wgpu::BindGroupLayout,
    bound: Vec<(u32, Bound)>,
    group: wgpu::BindGroup,
}

impl KeptBindGroup {
    /// The group of these bindings.
    pub fn get(
        &mut self,
        gpu: &Gpu,
        label: &'static str,
        layout: &wgpu::BindGroupLayout,
        bound: Vec<(u32, Bound)>,
    ) -> wgpu::BindGroup {
        if let Some(kept) = self.0.as_ref().filter(|kept| kept.layout == *layout && kept.bound == bound) {
            return kept.group.clone();
        }
        let entries: Vec<wgpu::BindGroupEntry<'_>> = bound
            .iter()
            .map(|(binding, bound)| wgpu::BindGroupEntry { binding: *binding, resource: bound.resource() })
            .collect();
        let group = gpu.bind_group(label, layout, &entries);
        self.0 = Some(Grouped { layout: layout.clone(), bound, group: group.clone() });
        group
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_differing_range_is_the_smallest_in_words() {
        let old: Vec<u8> = (0..32).collect();
        let mut new = old.clone();
        assert_eq!(differing(&old, &new), None);
        new[9] = 99;
        assert_eq!(differing(&old, &new), Some(8..12));
        new[16] = 99;
        assert_eq!(differing(&old, &new), Some(8..20));
        // What is cut off is not written, what is added is.
        assert_eq!(differing(&old, &old[..16]), None);
        assert_eq!(differing(&old[..16], &old), Some(16..32));
        assert_eq!(differing(&[], &old), Some(0..32));
        assert_eq!(differing(&old, &[]), None);
    }
}
