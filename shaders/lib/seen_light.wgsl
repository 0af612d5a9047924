// What the visibility pass writes for a light: an id with its depth along the light's view, in one texel.

struct VisibilityOut {
    @location(0) id_and_t: vec2<u32>,
    @builtin(frag_depth) depth: f32,
}

fn visibility_out(id: u32, t: f32) -> VisibilityOut {
    return VisibilityOut(vec2<u32>(id, bitcast<u32>(t)), depth_value(view, t));
}
