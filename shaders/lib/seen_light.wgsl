// What the visibility pass writes for a light: an id with two depths along the light's view, in one texel.
// The first depth is that of the surface, which shades what lies behind it; the second that of the outline, whose
// distance makes the penumbra. 16 bits each, from near to far.

struct VisibilityOut {
    @location(0) seen: vec2<u32>,
    @builtin(frag_depth) depth: f32,
}

fn visibility_out(id: u32, t: f32, outline_t: f32) -> VisibilityOut {
    let shares = (vec2<f32>(t, outline_t) - view.near) / (view.far - view.near);
    return VisibilityOut(vec2<u32>(id, pack2x16unorm(shares)), depth_value(view, t));
}
