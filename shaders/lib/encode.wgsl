// From linear light to what a picture file holds.

// The sRGB transfer curve [IEC61966, part 2-1].
fn srgb_from_linear(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let low = 12.92 * c;
    let high = 1.055 * pow(max(c, vec3<f32>(0.0031308)), vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, low, c <= vec3<f32>(0.0031308));
}

// Straight-alpha sRGB of premultiplied linear light laid over a background (alpha 0: left transparent).
fn encode(color: vec4<f32>, background: vec4<f32>) -> vec4<f32> {
    let over = color + (1.0 - color.a) * background;
    let straight = over.rgb / max(over.a, 1e-6);
    return vec4<f32>(srgb_from_linear(straight), over.a);
}
