// What is drawn: atoms as spheres, connectors as cylinders, and the ids that the visibility pass writes.

struct Atom {
    position_world: vec3<f32>,
    radius: f32,
    // Linear RGB as half floats: (r, g), (b, unused).
    color: vec2<u32>,
    material: u32,
    // Chain (7 bits) and residue (9 bits), as far as neighbours need them to differ; above them picks (lib/picks.wgsl).
    group: u32,
}

struct Connector {
    a_world: vec3<f32>,
    radius: f32,
    b_world: vec3<f32>,
    // In the lower half; above it picks (lib/picks.wgsl).
    material: u32,
    // Colours of the halves, as an atom's; in their unused 16 bits the groups of the atoms there.
    color_a: vec2<u32>,
    color_b: vec2<u32>,
}

struct Material {
    // Linear RGB; alpha 1 replaces the object's own colour, 0 keeps it.
    base_color: vec4<f32>,
    // Linear RGB of the hull outline.
    hull_color: vec3<f32>,
    // Share of what is behind that it covers: below 1 it is drawn in layers.
    opacity: f32,
    // Width of the hull outline: pixels plus scene units. 0 and 0: none.
    hull_px: f32,
    hull_world: f32,
    // Which object shader, by its place in the registry, and which of its parameter sets.
    shader: u32,
    index: u32,
    // The shader that stylises its light by curvature, by one more than its place in the registry, 0 for none; and which set.
    stylist: u32,
    stylist_index: u32,
    _pad0: u32,
    _pad1: u32,
}

fn atom_at(index: u32) -> Atom {
    let place = object_texel(atoms, 2u * index);
    let look = object_texel(atoms, 2u * index + 1u);
    return Atom(bitcast<vec3<f32>>(place.xyz), bitcast<f32>(place.w), look.xy, look.z, look.w & 0xffffu);
}

fn connector_at(index: u32) -> Connector {
    let a = object_texel(connectors, 3u * index);
    let b = object_texel(connectors, 3u * index + 1u);
    let colors = object_texel(connectors, 3u * index + 2u);
    return Connector(
        bitcast<vec3<f32>>(a.xyz), bitcast<f32>(a.w), bitcast<vec3<f32>>(b.xyz), b.w & 0xffffu, colors.xy, colors.zw,
    );
}

fn unpack_linear(color: vec2<u32>) -> vec3<f32> {
    return vec3<f32>(unpack2x16float(color.x), unpack2x16float(color.y).x);
}
