// The surface of a pixel as the shading pass leaves it for post effects: one texel of four words.

struct Geometry {
    // -z_view, or z_view of a hull outline, which is a line and no surface.
    depth: f32,
    // Unit, in view space, turned to the viewer.
    normal_view: vec3<f32>,
    // The same of the plane that goes on beyond the pixel: of a triangle its own, where `normal_view` is interpolated.
    facet_view: vec3<f32>,
    // Curvature times the size of a pixel there: 1 over the radius in pixels, 0 on flat surfaces.
    bend_px: f32,
    // Which group of objects (16 bits).
    group: u32,
    id: u32,
}

// Scene units of a pixel at a depth.
fn pixel_world(view: View, depth: f32) -> f32 {
    return view.pixel_view * select(depth, 1.0, ORTHOGRAPHIC);
}

// A unit vector as a point of an octahedron that is folded open, -1..1.
fn fold_unit(v: vec3<f32>) -> vec2<f32> {
    let flat = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    let signs = select(vec2<f32>(-1.0), vec2<f32>(1.0), flat >= vec2<f32>(0.0));
    return select(flat, (1.0 - abs(flat.yx)) * signs, v.z < 0.0);
}

fn unfold_unit(flat: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let signs = select(vec2<f32>(-1.0), vec2<f32>(1.0), flat >= vec2<f32>(0.0));
    return normalize(vec3<f32>(select(flat, (1.0 - abs(flat.yx)) * signs, z < 0.0), z));
}

// The same with 16 bits a coordinate.
fn pack_unit(v: vec3<f32>) -> u32 {
    return pack2x16snorm(fold_unit(v));
}

fn unpack_unit(word: u32) -> vec3<f32> {
    return unfold_unit(unpack2x16snorm(word));
}

fn pack_geometry(g: Geometry) -> vec4<u32> {
    let bend_and_group = (pack2x16float(vec2<f32>(min(g.bend_px, 6e4), 0.0)) & 0xffffu) | (g.group << 16u);
    // A part is flat and its own group, so that there is room for its facet.
    let own = select(bend_and_group, pack_unit(g.facet_view), is_part(g.id));
    return vec4<u32>(bitcast<u32>(g.depth), pack_unit(g.normal_view), own, g.id);
}

fn unpack_geometry(texel: vec4<u32>) -> Geometry {
    let normal = unpack_unit(texel.y);
    let part = is_part(texel.w);
    let facet = select(normal, unpack_unit(texel.z), part);
    let bend_px = select(unpack2x16float(texel.z).x, 0.0, part);
    return Geometry(bitcast<f32>(texel.x), normal, facet, bend_px, select(texel.z >> 16u, 0u, part), texel.w);
}
