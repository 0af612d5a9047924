// Which objects the post effects of a style pick, where they do not change all: bits above what a word of each object holds.
const PICKS_SHIFT: u32 = 17u;

// The bits of an atom, connector or part, one for each selector.
fn picks_of(id: u32) -> u32 {
    let index = id & INDEX_MASK;
    if is_part(id) { return object_texel(mesh_parts, 4u * index + 3u).y >> PICKS_SHIFT; }
    if (id >> 29u) == KIND_ATOM { return object_texel(atoms, 2u * index + 1u).w >> PICKS_SHIFT; }
    return object_texel(connectors, 3u * index + 1u).w >> PICKS_SHIFT;
}
