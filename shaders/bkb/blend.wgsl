// The fragments of a pixel over what is opaque there, from far to near [Murray2016 §3].

@group(2) @binding(6) var color: texture_2d<f32>;

@fragment
fn blend_slots(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<u32>(position.xy);
    var result = textureLoad(color, vec2<i32>(position.xy), 0);
    let first = first_slot(bkb, at);
    for (var left = order_by_depth(first); left > 0u; left--) {
        let word = bkb_d[slot_from_near(first, left - 1u) * DATA_WORDS];
        let opacity = f32(word >> 24u) / 255.0;
        result = mix(result, vec4<f32>(unpack_color(word), 1.0), opacity);
    }
    return finished(result);
}
