// What the visibility pass writes: which object a pixel sees.

// An id holds what a pixel sees: kind in the upper 3 bits, index in the lower 29; 0 is nothing.
const KIND_ATOM: u32 = 1u;
const KIND_CONNECTOR: u32 = 2u;
const KIND_MESH: u32 = 3u;
// Outlines come after all surfaces.
const KIND_ATOM_HULL: u32 = 4u;
const KIND_CONNECTOR_HULL: u32 = 5u;
const KIND_MESH_HULL: u32 = 6u;
const KIND_LAST_SURFACE: u32 = KIND_MESH;
const INDEX_MASK: u32 = 0x1fffffffu;

fn make_id(kind: u32, index: u32) -> u32 {
    return (kind << 29u) | index;
}

// Whether it is a part of a mesh, or a triangle of one.
fn is_part(id: u32) -> bool {
    return (id >> 29u) == KIND_MESH;
}
