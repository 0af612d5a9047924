//! Meshes on the device: shapes once for each scene, parts and draws for each style.
//!
//! Shapes that one part places follow each other in a row and are one draw, however many there are; a shape with more
//! places is one draw of as many instances. Ids count triangles through all of them, so that a pixel knows shape and
//! place; `shaders/lib/mesh.wgsl` finds them again.

use std::ops::Range;
use std::sync::{Arc, Weak};

use glam::Affine3A;

use super::objects::PICKS_SHIFT;
use super::texels::{self, KeptTexture, OBJECT_ROW};
use crate::gpu::{Gpu, GpuError, Module};
use crate::scene::{Assembly, Scene, Shape};
use crate::{gpu_struct, wgsl};

gpu_struct! {
    "lib/mesh.wgsl",
    /// See `shaders/lib/mesh.wgsl`.
    pub struct MeshVertex {
        /// In the shape's coordinates.
        pub position: [f32; 3],
        /// Packed normal.
        pub normal: u32,
        /// Packed outline vector.
        pub hull: u32,
        /// sRGB and 255, or 0.
        pub color: u32,
        /// Which part of its run.
        pub part: u32,
        /// Sum of the principal curvatures over the shape's radius; 0 unless a style asks.
        pub kappa: f32,
    }
}

gpu_struct! {
    "lib/mesh.wgsl",
    /// A part as it is drawn.
    pub struct MeshPart {
        /// Row of the matrix to world x.
        pub row_x: [f32; 4],
        /// To world y.
        pub row_y: [f32; 4],
        /// To world z.
        pub row_z: [f32; 4],
        /// Linear RGB as half floats; in the half that is left, whether colours of vertices count and which selectors pick it.
        pub color: [u32; 2],
        /// Index into the materials, and in the upper half how thick it is in its radii, as a half float.
        pub look: u32,
        /// Of a sphere around it, in scene units.
        pub radius: f32,
    }
}

gpu_struct! {
    "lib/mesh.wgsl",
    /// What one instance of a draw covers.
    pub struct MeshRun {
        /// Index of its first triangle, as ids count.
        pub first_id: u32,
        /// Its place in the texture of triangles.
        pub first_triangle: u32,
        /// Its first part.
        pub first_part: u32,
        /// Padding.
        pub _pad0: u32,
    }
}

/// Where the creases of a triangle lie in the word of its part: `MESH_CREASE_SHIFT` in `shaders/lib/mesh.wgsl`.
const CREASE_SHIFT: u32 = 26;

/// The bit of a part's colour that says that the colours of its vertices count.
pub const VERTEX_COLORS: u32 = 1 << 16;

/// Thicker than any radius reaches, and a half float.
const MOST_THICKNESS_RADII: f32 = 6e4;

impl MeshPart {
    /// A part of this placement, colour and material.
    pub fn new(world_from_shape: &Affine3A, color: [u32; 2], material: u32, shape: &Shape) -> MeshPart {
        let matrix = world_from_shape.matrix3;
        let shift = world_from_shape.translation;
        let row = |axis: usize| {
            let row = matrix.row(axis);
            [row.x, row.y, row.z, shift[axis]]
        };
        let scale = matrix.determinant().abs().cbrt();
        let radius = shape.sphere.radius;
        // Shaders need not know infinity.
        let thickness =
            half::f16::from_f32((shape.thickness / radius.max(f32::MIN_POSITIVE)).min(MOST_THICKNESS_RADII));
        let look = material & 0xffff | u32::from(thickness.to_bits()) << 16;
        MeshPart { row_x: row(0), row_y: row(1), row_z: row(2), color, look, radius: radius * scale }
    }

    /// Index into the materials.
    pub fn material(&self) -> u32 {
        self.look & 0xffff
    }

    /// Whether the colours of its vertices count.
    pub fn has_vertex_colors(&self) -> bool {
        self.color[1] & VERTEX_COLORS != 0
    }

    /// A bit for each selector that picks it.
    pub fn picks(&self) -> u32 {
        self.color[1] >> PICKS_SHIFT
    }
}

/// Triangles on a page of ids: `MESH_PAGE_BITS` in `shaders/lib/mesh.wgsl`.
const PAGE: u64 = 1 << 8;

/// Indices that are on their way at once: 3/4 MiB.
const TRIANGLES_AT_ONCE: usize = 1 << 16;

/// Ids have 29 bits for the index.
const MOST_IDS: u64 = 1 << 29;

/// A draw of the rasteriser.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MeshDraw {
    /// Indices, three a triangle.
    pub indices: Range<u32>,
    /// Rows of the texture of runs.
    pub runs: Range<u32>,
    /// Whether its parts are mirrored.
    pub mirrored: bool,
}

/// Where shapes and parts lie, found from the scene alone.
#[derive(Debug, Default)]
struct Layout {
    /// Shapes in the order in which they lie.
    shapes: Vec<Placed>,
    /// How many of them follow each other as one run: those with one place.
    num_single: usize,
    /// The parts in the order of their rows, as indices into the scene's.
    parts: Vec<u32>,
    num_vertices: u64,
    num_triangles: u64,
}

/// A shape with its places.
#[derive(Debug)]
struct Placed {
    shape: u32,
    first_triangle: u32,
    num_triangles: u32,
    /// Rows of its parts.
    parts: Range<u32>,
}

impl Layout {
    fn new(assembly: &Assembly) -> Layout {
        let mut parts_of: Vec<Vec<u32>> = vec![Vec::new(); assembly.shapes.len()];
        for (index, part) in (0..).zip(&assembly.parts) {
            parts_of[part.shape as usize].push(index);
        }
        let mut order: Vec<u32> = (0..assembly.shapes.len() as u32).collect();
        order.retain(|&shape| !parts_of[shape as usize].is_empty());
        // Single places first, in the order of the file.
        order.sort_by_key(|&shape| parts_of[shape as usize].len() > 1);
        let num_single = order.iter().filter(|&&shape| parts_of[shape as usize].len() == 1).count();
        let mut layout = Layout { num_single, ..Layout::default() };
        for shape in order {
            let of = &assembly.shapes[shape as usize];
            let first = layout.parts.len() as u32;
            layout.parts.append(&mut parts_of[shape as usize]);
            layout.shapes.push(Placed {
                shape,
                first_triangle: layout.num_triangles as u32,
                num_triangles: of.triangles.len() as u32,
                parts: first..layout.parts.len() as u32,
            });
            layout.num_vertices += of.positions.len() as u64;
            layout.num_triangles += of.triangles.len() as u64;
        }
        layout
    }
}

/// Rows of runs and pages, and the draws that they are for.
#[derive(Debug, Default, PartialEq)]
struct Draws {
    draws: Vec<MeshDraw>,
    runs: Vec<MeshRun>,
    /// For each page of ids its run.
    pages: Vec<u32>,
    num_triangles: u64,
}

impl Draws {
    /// The draws of the parts that are drawn.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] beyond the ids of 29 bits.
    fn new(layout: &Layout, assembly: &Assembly, is_drawn: impl Fn(u32) -> bool) -> Result<Draws, GpuError> {
        let mut draws = Draws::default();
        let single_triangles: u64 =
            layout.shapes[..layout.num_single].iter().map(|placed| u64::from(placed.num_triangles)).sum();
        // Ids of shapes with one place are those of their triangles, drawn or not: their page names the first run, which as
        // any other of them starts where its ids do, with the first part.
        let mut next_id = single_triangles.next_multiple_of(PAGE);
        draws.pages.resize((next_id / PAGE) as usize, 0);
        fn run(draws: &mut Draws, num_triangles: u32, run: MeshRun) -> u32 {
            draws.runs.push(run);
            draws.num_triangles += u64::from(num_triangles);
            draws.runs.len() as u32 - 1
        }
        check_ids(next_id)?;
        let indices = |first_triangle: u32, count: u32| 3 * first_triangle..3 * (first_triangle + count);

        // Shapes with one place: as few draws as hidden parts between them allow.
        let (single, shared) = layout.shapes.split_at(layout.num_single);
        let visible =
            |placed: &&Placed| placed.num_triangles > 0 && is_drawn(layout.parts[placed.parts.start as usize]);
        let mirrored = |row: u32| is_mirrored(assembly, layout.parts[row as usize]);
        for group in
            single.chunk_by(|a, b| visible(&a) == visible(&b) && mirrored(a.parts.start) == mirrored(b.parts.start))
        {
            let (Some(first), Some(last)) = (group.first(), group.last()) else { continue };
            if !visible(&first) {
                continue;
            }
            let count = last.first_triangle + last.num_triangles - first.first_triangle;
            // Vertices count their parts from the first of all.
            let first_triangle = first.first_triangle;
            let row =
                run(&mut draws, count, MeshRun { first_id: first_triangle, first_triangle, first_part: 0, _pad0: 0 });
            draws.draws.push(MeshDraw {
                indices: indices(first.first_triangle, count),
                runs: row..row + 1,
                mirrored: mirrored(first.parts.start),
            });
        }
        for placed in shared.iter().filter(|placed| placed.num_triangles > 0) {
            for side in [false, true] {
                let start = draws.runs.len() as u32;
                for part in placed.parts.clone() {
                    if is_drawn(layout.parts[part as usize]) && mirrored(part) == side {
                        let (first_id, first_triangle) = (next_id as u32, placed.first_triangle);
                        next_id += u64::from(placed.num_triangles).next_multiple_of(PAGE);
                        check_ids(next_id)?;
                        let first = MeshRun { first_id, first_triangle, first_part: part, _pad0: 0 };
                        let row = run(&mut draws, placed.num_triangles, first);
                        draws.pages.resize((next_id / PAGE) as usize, row);
                    }
                }
                let end = draws.runs.len() as u32;
                if end > start {
                    draws.draws.push(MeshDraw {
                        indices: indices(placed.first_triangle, placed.num_triangles),
                        runs: start..end,
                        mirrored: side,
                    });
                }
            }
        }
        Ok(draws)
    }
}

/// Refuses more ids than there are.
fn check_ids(num_ids: u64) -> Result<(), GpuError> {
    let bytes = |count: u64| count * size_of::<[u32; 4]>() as u64;
    if num_ids > MOST_IDS {
        let (count, bytes, limit) = (num_ids as usize, bytes(num_ids), bytes(MOST_IDS));
        return Err(GpuError::TooMany { what: "triangles", count, bytes, limit });
    }
    Ok(())
}

fn is_mirrored(assembly: &Assembly, part: u32) -> bool {
    assembly.parts[part as usize].world_from_shape.matrix3.determinant() < 0.0
}

/// The meshes of a scene on the device.
pub struct MeshBuffers {
    /// What scene the shapes are of.
    scene: Weak<Scene>,
    /// Whether their curvature is there.
    bent: bool,
    layout: Layout,
    vertices: KeptTexture,
    triangles: KeptTexture,
    indices: Option<wgpu::Buffer>,
    parts: KeptTexture,
    runs: KeptTexture,
    pages: KeptTexture,
    draws: Draws,
}

impl Default for MeshBuffers {
    fn default() -> MeshBuffers {
        MeshBuffers {
            scene: Weak::new(),
            bent: false,
            layout: Layout::default(),
            vertices: KeptTexture::new("mesh vertices"),
            triangles: KeptTexture::new("mesh triangles"),
            indices: None,
            parts: KeptTexture::new("mesh parts"),
            runs: KeptTexture::new("mesh runs"),
            pages: KeptTexture::new("mesh pages"),
            draws: Draws::default(),
        }
    }
}

impl MeshBuffers {
    /// Replaces the parts and, for another scene, the shapes. `parts` has an entry for each part of the scene, none where
    /// it is hidden; `bent` asks for the curvature of the shapes, too. On an error the former content stays.
    ///
    /// # Errors
    /// [`GpuError::TooMany`] beyond the largest texture, or beyond the ids of 29 bits.
    pub fn set(
        &mut self,
        gpu: &Gpu,
        scene: &Arc<Scene>,
        parts: &[Option<MeshPart>],
        bent: bool,
    ) -> Result<(), GpuError> {
        let assembly = &scene.assembly;
        check(gpu, scene, parts)?;
        let is_drawn = |part: u32| parts.get(part as usize).is_some_and(Option::is_some);
        // All that can fail comes before anything is replaced.
        let is_there = Weak::ptr_eq(&self.scene, &Arc::downgrade(scene)) && (self.bent || !bent);
        let layout = (!is_there).then(|| Layout::new(assembly));
        let draws = Draws::new(layout.as_ref().unwrap_or(&self.layout), assembly, is_drawn)?;
        if let Some(layout) = layout {
            self.draws = Draws::default();
            self.upload(gpu, assembly, &layout, bent);
            self.layout = layout;
            self.bent = bent;
            self.scene = Arc::downgrade(scene);
        }
        let hidden = <MeshPart as bytemuck::Zeroable>::zeroed();
        let rows: Vec<MeshPart> = self
            .layout
            .parts
            .iter()
            .map(|&part| parts.get(part as usize).copied().flatten().unwrap_or(hidden))
            .collect();
        self.parts.set(gpu, bytemuck::cast_slice(&rows));
        if draws != self.draws {
            self.runs.set(gpu, bytemuck::cast_slice(&draws.runs));
            let mut pages = draws.pages.clone();
            pages.resize(pages.len().next_multiple_of(4), 0);
            self.pages.set(gpu, bytemuck::cast_slice(&pages));
            self.draws = draws;
        }
        Ok(())
    }

    /// Forgets the scene's meshes.
    pub fn clear(&mut self) {
        *self = MeshBuffers::default();
    }

    /// Writes the shapes, piece by piece, so that no second copy of them is made in memory.
    fn upload(&mut self, gpu: &Gpu, assembly: &Assembly, layout: &Layout, bent: bool) {
        let mut vertices = self.vertices.writer(gpu, layout.num_vertices * 2);
        let mut triangles = self.triangles.writer(gpu, layout.num_triangles);
        let size = (layout.num_triangles * 12).max(16);
        let buffer = gpu.empty_buffer("mesh indices", size, wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST);
        let (mut first_vertex, mut pending) = (0u32, 0);
        for (number, placed) in layout.shapes.iter().enumerate() {
            let shape = &assembly.shapes[placed.shape as usize];
            // Vertices of single places know their part; a shared shape has one part for each run.
            let part = if number < layout.num_single { placed.parts.start } else { 0 };
            let bending = bent.then(|| shape.bending());
            for (index, position) in shape.positions.iter().enumerate() {
                let color = shape.colors.get(index).map_or(0, |[r, g, b]| u32::from_le_bytes([*r, *g, *b, 255]));
                vertices.push(bytemuck::bytes_of(&MeshVertex {
                    position: position.to_array(),
                    normal: shape.normals.get(index).copied().unwrap_or(0),
                    hull: shape.hulls.get(index).copied().unwrap_or(0),
                    color,
                    part,
                    kappa: bending.map_or(0.0, |bending| bending.kappa[index] * shape.sphere.radius),
                }));
            }
            let mut offset = u64::from(placed.first_triangle) * 12;
            let mut creases = bending.map(|bending| bending.creases.iter());
            for chunk in shape.triangles.chunks(TRIANGLES_AT_ONCE) {
                let moved: Vec<[u32; 3]> = chunk.iter().map(|triangle| triangle.map(|v| v + first_vertex)).collect();
                for [a, b, c] in &moved {
                    let creases = creases.as_mut().and_then(Iterator::next).copied().unwrap_or(0);
                    triangles.push(bytemuck::bytes_of(&[*a, *b, *c, part | u32::from(creases) << CREASE_SHIFT]));
                }
                gpu.write_buffer(&buffer, offset, bytemuck::cast_slice(&moved));
                offset += moved.len() as u64 * 12;
                pending += moved.len();
                // Small shapes go together.
                if pending >= TRIANGLES_AT_ONCE {
                    gpu.flush_writes();
                    pending = 0;
                }
            }
            first_vertex += shape.positions.len() as u32;
        }
        vertices.finish();
        triangles.finish();
        gpu.flush_writes();
        self.indices = Some(buffer);
    }

    /// Vertices, triangles, parts, runs and pages to bind; none without meshes.
    pub fn views(&self) -> Option<[wgpu::TextureView; 5]> {
        Some([self.vertices.view()?, self.triangles.view()?, self.parts.view()?, self.runs.view()?, self.pages.view()?])
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        let textures = [&self.vertices, &self.triangles, &self.parts, &self.runs, &self.pages];
        let indices = self.indices.as_ref().map_or(0, wgpu::Buffer::size);
        textures.iter().map(|texture| texture.bytes()).sum::<u64>() + indices
    }

    /// The draws, and the indices that they draw by.
    pub fn draws(&self) -> Option<(&[MeshDraw], &wgpu::Buffer)> {
        Some((&self.draws.draws, self.indices.as_ref()?))
    }

    /// Triangles that are drawn, those of hidden parts not counted.
    pub fn num_triangles(&self) -> u64 {
        self.draws.num_triangles
    }
}

/// What shading need not ask of each triangle, since it holds for all of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct MeshForm {
    /// Whether a shape has more places than one: ids are those of triangles otherwise.
    pub shared: bool,
    /// Whether a part is placed by a matrix: shapes lie in world coordinates otherwise.
    pub placed: bool,
    /// Whether the colours of vertices count anywhere.
    pub colored: bool,
}

impl MeshForm {
    /// What is right for all meshes.
    pub const ANY: MeshForm = MeshForm { shared: true, placed: true, colored: true };

    /// The form of the parts of an assembly, hidden ones with them, in the looks that those have that are drawn.
    pub fn new<'a>(assembly: &Assembly, drawn: impl Iterator<Item = &'a MeshPart>) -> MeshForm {
        let mut places = vec![0u32; assembly.shapes.len()];
        assembly.parts.iter().for_each(|part| places[part.shape as usize] += 1);
        MeshForm {
            shared: places.iter().any(|&places| places > 1),
            placed: assembly.parts.iter().any(|part| part.world_from_shape != Affine3A::IDENTITY),
            colored: { drawn }.any(MeshPart::has_vertex_colors),
        }
    }
}

/// Adds the WGSL of points of meshes, or what stands in for it where there are none.
pub fn add_point(module: &mut Module, form: Option<MeshForm>) {
    let Some(MeshForm { shared, placed, colored }) = form else {
        module.add(wgsl!("lib/mesh_point_none.wgsl"));
        return;
    };
    module.add(wgsl!("lib/mesh.wgsl"));
    module.add_generated(
        "mesh form",
        format!("const SHARED: bool = {shared};\nconst PLACED: bool = {placed};\nconst COLORED: bool = {colored};"),
    );
    module.add(wgsl!("lib/mesh_point.wgsl"));
}

/// Refuses meshes that do not fit the device.
///
/// # Errors
/// [`GpuError::TooMany`] with what does not fit.
pub fn check(gpu: &Gpu, scene: &Scene, parts: &[Option<MeshPart>]) -> Result<(), GpuError> {
    let assembly = &scene.assembly;
    let vertices: u64 = assembly.shapes.iter().map(|shape| shape.positions.len() as u64).sum();
    let triangles: u64 = assembly.shapes.iter().map(|shape| shape.triangles.len() as u64).sum();
    let limits = gpu.device.limits();
    let texture = u64::from(limits.max_texture_dimension_2d) * u64::from(OBJECT_ROW) * texels::TEXEL_BYTES as u64;
    for (what, count, bytes, limit) in [
        ("vertices", vertices, vertices * size_of::<MeshVertex>() as u64, texture),
        ("triangles", triangles, triangles * 16, texture.min(limits.max_buffer_size / 3 * 4)),
        ("parts", parts.len() as u64, size_of_val(parts) as u64, texture),
    ] {
        if bytes > limit {
            return Err(GpuError::TooMany { what, count: count as usize, bytes, limit });
        }
    }
    Ok(())
}
