// Two numbers in 0..1 for a pixel: others for each of a square of 4x4, and for each sample of a still.
fn pixel_noise(at: vec2<i32>) -> vec2<f32> {
    let own = vec2<u32>(at + vec2<i32>(view.tile_origin_px)) & vec2<u32>(3u);
    // Bayer's order: pixels that are neighbours differ most.
    let a = own.x ^ own.y;
    let order = ((a & 1u) << 3u) | ((own.y & 1u) << 2u) | (a & 2u) | ((own.y & 2u) >> 1u);
    let turned = (order * 7u + 3u) & 15u;
    let phase = view.sample_rotation_rad / 6.2831853;
    // Of sample i of n: i / n, and i times the golden ratio.
    return fract((vec2<f32>(f32(order), f32(turned)) + 0.5) / 16.0 + phase * vec2<f32>(1.0, 0.618034 / view.sample_weight));
}
