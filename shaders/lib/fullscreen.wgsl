// One triangle over the whole target. It lies at the far end of the depth range, behind all that is drawn.

@vertex
fn fullscreen_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}
