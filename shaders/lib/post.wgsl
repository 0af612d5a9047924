// What every pass of every post effect has: the whole picture as one triangle, and the background.

struct Output {
    // Premultiplied linear background; alpha 0 for a transparent picture.
    background: vec4<f32>,
}

@vertex
fn post_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
