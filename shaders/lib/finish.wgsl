// The end of a pass that changes the picture of one sample.
// FINISH: 0 hands the colour to the next pass, 1 adds it up with the other samples', 2 writes picture values.

// Premultiplied linear light of one sample as the pass returns it.
fn finished(color: vec4<f32>) -> vec4<f32> {
    if FINISH == 2u { return encode(color, output.background); }
    if FINISH == 1u { return color * view.sample_weight; }
    return color;
}
