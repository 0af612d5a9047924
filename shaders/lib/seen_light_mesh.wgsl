// What the visibility pass of triangles writes for a light: as seen_light.wgsl, but for the depth that hardware has.

struct VisibilityOut {
    @location(0) seen: vec2<u32>,
}

fn visibility_out(id: u32, t: f32, outline_t: f32) -> VisibilityOut {
    let shares = (vec2<f32>(t, outline_t) - view.near) / (view.far - view.near);
    return VisibilityOut(vec2<u32>(id, pack2x16unorm(shares)));
}
