// Colour and opacity of each fragment by the curvature of its surface [Murray2016 §5]: kappa = tanh(k1 + k2), with the scene's radius
// as the unit of length, negative where the surface is convex; -1 where a neighbour is missing.
//
// Here, in `neighbours.wgsl` and `query.wgsl` loops end at their heads alone and skip no turn: while Mesa 22.3 compiles a nest of others for
// its software adapter it writes to memory that it has freed.

@group(2) @binding(0) var<uniform> bkb: BkbBand;
@group(2) @binding(1) var<storage, read_write> bkb_z: array<u32>;
@group(2) @binding(2) var<storage, read_write> bkb_b: array<u32>;
@group(2) @binding(3) var<storage, read_write> bkb_d: array<u32>;

// Depth along the view.
fn depth_of(fragment: BkbFragment) -> f32 {
    return bkb.near + fragment.depth * DEPTH_STEPS / bkb.depth_scale;
}

// kappa of the fragment in a slot of a pixel; `scale` is what its material multiplies curvature by.
fn kappa_of(at: vec2<u32>, own: u32, fragment: BkbFragment, shape: u32, scale: f32) -> f32 {
    let range = candidates(own, shape);
    // Beyond the picture nothing is known: there the difference is one-sided (ours).
    let low = max(at, vec2<u32>(1u)) - 1u;
    let high = min(at + 1u, vec2<u32>(bkb.width, bkb.height) - 1u);
    let places = array<vec2<u32>, 4>(
        vec2<u32>(low.x, at.y), vec2<u32>(high.x, at.y), vec2<u32>(at.x, high.y), vec2<u32>(at.x, low.y),
    );
    var normals: array<vec3<f32>, 4>;
    var is_whole = true;
    for (var side = 0u; side < 4u && is_whole; side++) {
        normals[side] = fragment.normal;
        if any(places[side] != at) {
            let found = neighbour(first_slot(bkb, places[side]), shape, fragment, own, range);
            is_whole = found.is_there;
            normals[side] = found.normal;
        }
    }
    if !is_whole { return -1.0; }
    let steps = vec2<f32>(high - low) * view.plane_from_px.xy;
    // A picture of one column or row has no difference across it.
    let inverse = select(1.0 / steps, vec2<f32>(0.0), low == high);
    let dx = (normals[1] - normals[0]) * inverse.x;
    let dy = (normals[2] - normals[3]) * inverse.y;
    let position_px = vec2<f32>(at) + 0.5 + view.tile_origin_px;
    let plane = position_px * view.plane_from_px.xy + view.plane_from_px.zw;
    // Beyond 10, tanh is 1 to the last bit, and may overflow on its way.
    return tanh(clamp(curvature_of(dx, dy, plane, depth_of(fragment)) * scale, -10.0, 10.0));
}

fn stylise_slot(at: vec2<u32>, first: u32, slot: u32, shape: u32) {
    let fragment = fragment_at(first, slot);
    let word = bkb_d[(first + slot) * 2u];
    let material = word >> 24u;
    let kappa = kappa_of(at, first, fragment, shape, curvature_scale(material, bkb.curvature_scale));
    keep_kappa(first + slot, kappa);
    let styled = stylised(material, unpack_color(word), kappa, depth_of(fragment));
    bkb_d[(first + slot) * 2u] = pack_color(styled.rgb, u32(clamp(styled.a, 0.0, 1.0) * 255.0 + 0.5));
}

@compute @workgroup_size(8, 8)
fn stylise(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let at = invocation.xy + vec2<u32>(0u, bkb.first_drawn);
    if at.x >= bkb.width || at.y >= bkb.end_drawn { return; }
    let first = first_slot(bkb, at);
    for (var slot = 0u; slot < bkb.k && bkb_z[first + slot] != EMPTY; slot++) {
        let key = bkb_z[first + slot];
        // Kept by the first pass and not found by the second: it stays invisible.
        if is_stored(first, slot) { stylise_slot(at, first, slot, key >> 16u); }
    }
}
