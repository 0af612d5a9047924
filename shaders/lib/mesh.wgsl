// Triangles of meshes. Shapes lie once in the textures of vertices and triangles; parts place them; a run is what one
// instance of a draw covers: one part of a shared shape, or a row of parts whose shapes follow each other.
// The index of an id counts the triangles of shapes with one place as they lie, then those of each run of a shared shape, from a
// multiple of MESH_PAGE: `mesh_pages` says whose it is.

struct MeshVertex {
    // In the shape's coordinates.
    position: vec3<f32>,
    // Octahedral, 16 + 16 bits.
    normal: u32,
    // Outline vector: octahedral, 12 + 12 bits, and 8 bits of length up to 4.
    hull: u32,
    // sRGB, 8 bits each, and 255 where the file has a colour.
    color: u32,
    // Which part of its run.
    part: u32,
    // Sum of the principal curvatures, negative where convex, over the shape's radius; 0 unless a style asks.
    kappa: f32,
}

struct MeshPart {
    // Rows of the 3x4 matrix from the shape's to world coordinates.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    // Linear RGB as half floats; then a bit that says whether the file's colours of vertices count, and picks (lib/picks.wgsl).
    color: vec2<u32>,
    // Index into the materials, and in the upper half how thick it is in its radii, as a half float.
    look: u32,
    // Of a sphere around it, in scene units.
    radius: f32,
}

struct MeshRun {
    // Index of its first triangle, as ids count.
    first_id: u32,
    // Its place in the texture of triangles.
    first_triangle: u32,
    // Its first part.
    first_part: u32,
    _pad0: u32,
}

const MESH_PAGE_BITS: u32 = 8u;
// A triangle's last word: its part, and above it its creases.
const MESH_CREASE_SHIFT: u32 = 26u;
const MESH_PART_MASK: u32 = 0x03ffffffu;

fn mesh_vertex_at(index: u32) -> MeshVertex {
    let place = object_texel(mesh_vertices, 2u * index);
    let look = object_texel(mesh_vertices, 2u * index + 1u);
    return MeshVertex(bitcast<vec3<f32>>(place.xyz), place.w, look.x, look.y, look.z, bitcast<f32>(look.w));
}

fn mesh_part_at(index: u32) -> MeshPart {
    let x = bitcast<vec4<f32>>(object_texel(mesh_parts, 4u * index));
    let y = bitcast<vec4<f32>>(object_texel(mesh_parts, 4u * index + 1u));
    let z = bitcast<vec4<f32>>(object_texel(mesh_parts, 4u * index + 2u));
    let look = object_texel(mesh_parts, 4u * index + 3u);
    return MeshPart(x, y, z, look.xy, look.z, bitcast<f32>(look.w));
}

fn mesh_run_at(index: u32) -> MeshRun {
    let run = object_texel(mesh_runs, index);
    return MeshRun(run.x, run.y, run.z, run.w);
}

// The vertices of the triangle that the index of an id names, its part, and its creases:
// a bit for each edge that is one, and above them a bit for each corner on one.
struct MeshCorners {
    vertices: vec3<u32>,
    part: u32,
    creases: u32,
}

fn mesh_corners(index: u32) -> MeshCorners {
    let page = index >> MESH_PAGE_BITS;
    let run = mesh_run_at(object_texel(mesh_pages, page >> 2u)[page & 3u]);
    return mesh_corners_at(run.first_triangle + index - run.first_id, run.first_part);
}

// The same of the place of a triangle, whose part is counted from the first of its run.
fn mesh_corners_at(place: u32, first_part: u32) -> MeshCorners {
    let triangle = object_texel(mesh_triangles, place);
    return MeshCorners(triangle.xyz, first_part + (triangle.w & MESH_PART_MASK), triangle.w >> MESH_CREASE_SHIFT);
}

fn mesh_to_world(part: MeshPart, position: vec3<f32>) -> vec3<f32> {
    let place = vec4<f32>(position, 1.0);
    return vec3<f32>(dot(part.row_x, place), dot(part.row_y, place), dot(part.row_z, place));
}

// Turns a normal as the part's matrix does, by its cofactors, which exist for every matrix. Not of unit length.
fn mesh_normal_to_world(part: MeshPart, normal: vec3<f32>) -> vec3<f32> {
    let x = cross(part.row_y.xyz, part.row_z.xyz);
    let y = cross(part.row_z.xyz, part.row_x.xyz);
    let z = cross(part.row_x.xyz, part.row_y.xyz);
    let turned = vec3<f32>(dot(x, normal), dot(y, normal), dot(z, normal));
    return select(turned, -turned, dot(part.row_x.xyz, x) < 0.0);
}

// The unit vector of octahedral coordinates in -1..1.
fn from_octahedral(place: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(place.x) - abs(place.y);
    let fold = max(-z, 0.0);
    let folded = place - select(vec2<f32>(-fold), vec2<f32>(fold), place >= vec2<f32>(0.0));
    return normalize(vec3<f32>(folded, z));
}

fn unpack_normal(bits: u32) -> vec3<f32> {
    let steps = vec2<f32>(f32(bits & 0xffffu), f32(bits >> 16u));
    return from_octahedral(steps * (2.0 / 65534.0) - 1.0);
}

fn unpack_hull(bits: u32) -> vec3<f32> {
    let steps = vec2<f32>(f32(bits & 0xfffu), f32(bits >> 12u & 0xfffu));
    return from_octahedral(steps * (2.0 / 4094.0) - 1.0) * (f32(bits >> 24u) * (4.0 / 255.0));
}

fn linear_from_srgb(value: f32) -> f32 {
    return select(pow((value + 0.055) / 1.055, 2.4), value / 12.92, value <= 0.04045);
}

// Linear RGB of a vertex; white where the file has no colours.
fn unpack_vertex_color(bits: u32) -> vec3<f32> {
    let color = unpack4x8unorm(bits);
    if color.a == 0.0 { return vec3<f32>(1.0); }
    return vec3<f32>(linear_from_srgb(color.r), linear_from_srgb(color.g), linear_from_srgb(color.b));
}
