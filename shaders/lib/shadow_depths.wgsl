// Shadows from depths alone, as published: for measurements only, beside those of lib/shadow.wgsl that styles have.
// Hard, SHADOW_FILTER 1: whether the one texel at the place is nearer to the light [Williams1978, throughout].
// Hard, SHADOW_FILTER 2: the share of 3x3 texels that are [Reeves1987, throughout].
// Soft: mean depth of what is nearer, then the share that is within the penumbra it makes [Fernando2005 §2].

// What keeps a surface from shading itself, in texels: enough for a slope of 45 degrees.
const DEPTH_BIAS_TEXELS: f32 = 1.5;

// Depth of the front that the light sees in a texel; the far end where that is nothing or outside.
fn front_depth(light_view: View, layer: i32, texel: vec2<i32>) -> f32 {
    let last = vec2<i32>(light_view.size_px) - 1;
    let inside = clamp(texel, vec2<i32>(0), last);
    let seen = textureLoad(shadow_maps, inside, layer, 0).xy;
    let depth = light_view.near + (light_view.far - light_view.near) * unpack2x16unorm(seen.y).x;
    return select(depth, light_view.far, seen.x == 0u || any(texel != inside));
}

fn shadow_light(light: Light, s: Surface) -> f32 {
    let layer = light.shadow;
    let light_view = shadows.views[layer].light;
    let lit = lit_place(light_view, (shadows.views[layer].light_from_view * vec4<f32>(s.position_view, 1.0)).xyz);
    if lit.t <= light_view.near { return 1.0; }
    let depth = lit.t - DEPTH_BIAS_TEXELS * lit.texel_light;
    let texel = vec2<i32>(floor(lit.place_px));
    if light.softness_tan <= 0.0 {
        if SHADOW_FILTER == 1u { return select(1.0, 0.0, front_depth(light_view, layer, texel) < depth); }
        var open = 0.0;
        for (var i = 0; i < 9; i++) {
            let around = texel + vec2<i32>(i % 3 - 1, i / 3 - 1);
            open += select(1.0, 0.0, front_depth(light_view, layer, around) < depth);
        }
        return open / 9.0;
    }
    let nearest = mix(lit.t / light_view.near, 1.0, light_view.orthographic);
    let reach = light.softness_tan * (lit.t - light_view.near) * nearest / lit.texel_light;
    let turn = view.sample_rotation_rad + 6.2831853 * interleaved_noise(lit.place_px);
    var blocker_sum = 0.0;
    var blockers = 0.0;
    for (var i = 0u; i < SOFT_TAPS; i++) {
        let tap = front_depth(light_view, layer, vec2<i32>(floor(lit.place_px + reach * disc_tap(i, turn))));
        if tap < depth {
            blocker_sum += tap;
            blockers += 1.0;
        }
    }
    if blockers == 0.0 { return 1.0; }
    let blocker_t = blocker_sum / blockers;
    let quotient = mix(lit.t / blocker_t, 1.0, light_view.orthographic);
    let wide = light.softness_tan * (lit.t - blocker_t) * quotient / lit.texel_light;
    var open = 0.0;
    for (var i = 0u; i < SOFT_TAPS; i++) {
        let tap = front_depth(light_view, layer, vec2<i32>(floor(lit.place_px + wide * disc_tap(i, turn))));
        open += select(1.0, 0.0, tap < depth);
    }
    return open / f32(SOFT_TAPS);
}
