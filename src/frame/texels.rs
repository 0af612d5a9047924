//! Objects in textures, one texel for each 16 bytes, row after row.
//!
//! Storage buffers end at 128 MiB on many adapters, and a software rasteriser reads them lane by lane.

use crate::gpu::Gpu;

/// Texels in a row of these textures; `OBJECT_ROW` in `shaders/lib/texels.wgsl`.
pub const OBJECT_ROW: u32 = 2048;

/// A texel holds four 32-bit words.
pub const TEXEL_BYTES: usize = 16;

/// Bytes in a row.
pub const ROW_BYTES: usize = OBJECT_ROW as usize * TEXEL_BYTES;

/// Objects in a texture, one texel for each 16 bytes, and a hash of each row, so that a row that stays is not written.
pub struct KeptTexture {
    label: &'static str,
    texture: Option<(wgpu::Texture, wgpu::TextureView)>,
    row_hashes: Vec<u64>,
}

impl KeptTexture {
    /// No texture yet.
    pub fn new(label: &'static str) -> KeptTexture {
        KeptTexture { label, texture: None, row_hashes: Vec::new() }
    }

    /// To bind; none before the first content.
    pub fn view(&self) -> Option<wgpu::TextureView> {
        self.texture.as_ref().map(|(_, view)| view.clone())
    }

    /// Bytes of the texture.
    pub fn bytes(&self) -> u64 {
        let rows = self.texture.as_ref().map_or(0, |(texture, _)| texture.height());
        u64::from(rows) * ROW_BYTES as u64
    }

    /// Replaces the content, a multiple of 16 bytes.
    pub fn set(&mut self, gpu: &Gpu, bytes: &[u8]) {
        let rows = bytes.len().div_ceil(ROW_BYTES).max(1) as u32;
        let hashes: Vec<u64> = bytes.chunks(ROW_BYTES).map(hash).collect();
        self.fit(gpu, rows);
        let Some((texture, _)) = &self.texture else { return };
        let changed = |row: usize| self.row_hashes.get(row) != hashes.get(row);
        let mut row = 0;
        while row < hashes.len() {
            // Whole rows that changed go in one write, a row that is not full by itself.
            let is_full = |row: usize| (row + 1) * ROW_BYTES <= bytes.len();
            let mut end = row;
            while end < hashes.len() && end - row < MOST_ROWS_AT_ONCE && changed(end) && is_full(end) {
                end += 1;
            }
            if end > row {
                write_rows(gpu, texture, row, OBJECT_ROW, &bytes[row * ROW_BYTES..end * ROW_BYTES]);
                if end - row == MOST_ROWS_AT_ONCE {
                    gpu.flush_writes();
                }
            } else if changed(row) {
                let rest = &bytes[row * ROW_BYTES..];
                write_rows(gpu, texture, row, (rest.len() / TEXEL_BYTES) as u32, rest);
            }
            row = end.max(row + 1);
        }
        self.row_hashes = hashes;
    }

    /// Makes the texture hold so many rows.
    fn fit(&mut self, gpu: &Gpu, rows: u32) {
        // A texture that grew for a large scene is given back once a small one would fit it four times.
        let fits = |texture: &wgpu::Texture| (rows..=4 * rows).contains(&texture.height());
        if !self.texture.as_ref().is_some_and(|(texture, _)| fits(texture)) {
            let texture = gpu.texture(&wgpu::TextureDescriptor {
                label: Some(self.label),
                size: wgpu::Extent3d { width: OBJECT_ROW, height: rows, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba32Uint,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let view = texture.create_view(&Default::default());
            self.texture = Some((texture, view));
            self.row_hashes.clear();
        }
    }

    /// Writes another content from its start, `num_texels` in all, without holding more than a few rows of it.
    pub fn writer<'a>(&'a mut self, gpu: &'a Gpu, num_texels: u64) -> TexelWriter<'a> {
        let rows = num_texels.div_ceil(u64::from(OBJECT_ROW)).max(1) as u32;
        self.fit(gpu, rows);
        self.row_hashes.clear();
        TexelWriter { gpu, texture: self.texture.as_ref().map(|(texture, _)| texture), row: 0, pending: Vec::new() }
    }
}

/// Rows of a changed content that are written at once, so that copies on their way do not pile up: 8 MiB.
const MOST_ROWS_AT_ONCE: usize = 256;

/// Rows that are written at once: 2 MiB.
const ROWS_AT_ONCE: usize = 64;

/// Writes texels in their order.
pub struct TexelWriter<'a> {
    gpu: &'a Gpu,
    texture: Option<&'a wgpu::Texture>,
    row: usize,
    pending: Vec<u8>,
}

impl TexelWriter<'_> {
    /// Adds whole texels.
    pub fn push(&mut self, bytes: &[u8]) {
        self.pending.extend_from_slice(bytes);
        if self.pending.len() >= ROWS_AT_ONCE * ROW_BYTES {
            let rest = self.pending.split_off(ROWS_AT_ONCE * ROW_BYTES);
            self.write_whole_rows();
            self.pending = rest;
        }
    }

    fn write_whole_rows(&mut self) {
        let rows = self.pending.len() / ROW_BYTES;
        if let Some(texture) = self.texture.filter(|_| rows > 0) {
            write_rows(self.gpu, texture, self.row, OBJECT_ROW, &self.pending[..rows * ROW_BYTES]);
            self.gpu.flush_writes();
        }
        self.row += rows;
        self.pending.drain(..rows * ROW_BYTES);
    }

    /// Writes what is left.
    pub fn finish(mut self) {
        self.write_whole_rows();
        if let Some(texture) = self.texture.filter(|_| !self.pending.is_empty()) {
            write_rows(self.gpu, texture, self.row, (self.pending.len() / TEXEL_BYTES) as u32, &self.pending);
        }
    }
}

fn write_rows(gpu: &Gpu, texture: &wgpu::Texture, row: usize, width: u32, bytes: &[u8]) {
    let origin = wgpu::Origin3d { x: 0, y: row as u32, z: 0 };
    let to = wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() };
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(ROW_BYTES as u32), rows_per_image: None };
    let height = bytes.len().div_ceil(ROW_BYTES) as u32;
    gpu.write_texture(to, bytes, layout, wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
}

fn hash(row: &[u8]) -> u64 {
    use std::hash::Hasher;
    let mut hasher = std::hash::DefaultHasher::new();
    hasher.write(row);
    hasher.finish()
}
