// What every pass of every post effect has: the whole picture as one triangle, and the end of a chain of effects.
// FINISH: 0 hands the colour to the next effect, 1 adds it up with the other samples', 2 writes picture values.

struct Output {
    // Premultiplied linear background; alpha 0 for a transparent picture.
    background: vec4<f32>,
}

@vertex
fn post_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

// Premultiplied linear light of one sample as the effect's last pass returns it.
fn finished(color: vec4<f32>) -> vec4<f32> {
    if FINISH == 2u { return encode(color, output.background); }
    if FINISH == 1u { return color * view.sample_weight; }
    return color;
}
