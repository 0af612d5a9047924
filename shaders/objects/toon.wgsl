// Comic shading: light in a few flat bands, an outline where the surface turns away.
// TOON_EXPONENT, TOON_SPECULAR and TOON_OUTLINE say whether any material of the style uses those at all.

struct ToonMaterial {
    // Linear RGB of the outline.
    color: vec4<f32>,
    // Linear RGB that multiplies the base colour where no light is; alpha 1 where set, else black.
    shadow_color: vec4<f32>,
    // Linear RGB of the highlight; alpha 1 where set, 0: none.
    specular_color: vec4<f32>,
    scale: f32,
    bias: f32,
    exponent: f32,
    steps: f32,
    // n.v below which the outline is drawn; 0: none.
    outline_bias: f32,
    specular_limit: f32,
    // 0 floor, 1 centre, 2 full.
    levels: u32,
    // (scale + bias)^exponent, the brightest level, 0..1 or more.
    top: f32,
}

// Mean of the staircase min(floor(x), steps - 1), 0 for x < 0, over a pixel across which x changes by
// `width`. Below one band a pixel it is the exact box filter of one straight edge;
// above, the staircase's integral, which tends to the bands' mean.
fn band_mean(x: f32, width: f32, steps: f32) -> f32 {
    if steps < 2.0 { return 0.0; }
    if width < 1.0 {
        let edge = clamp(floor(x + 0.5), 1.0, steps - 1.0);
        return edge - 1.0 + clamp((x - edge) / max(width, 1e-6) + 0.5, 0.0, 1.0);
    }
    return (band_integral(x + 0.5 * width, steps) - band_integral(x - 0.5 * width, steps)) / width;
}

fn band_integral(x: f32, steps: f32) -> f32 {
    let k = clamp(floor(x), 0.0, steps - 1.0);
    return k * (x - 0.5 * (k + 1.0));
}

// The level of light for the cosine n.l [Prost2016 eq. 1 and 2], with two mends: a base below 0 has the
// level of 0, and the top band reaches down to its floor instead of being the single point x = 1.
// `gradient` is how fast n.l changes over one pixel.
fn toon_level(cosine: f32, gradient: f32, m: ToonMaterial) -> f32 {
    if m.scale == 0.0 || m.steps < 2.0 { return min(m.top, 1.0); }
    let reach = m.scale + m.bias;
    let share = (m.scale * cosine + m.bias) / reach;
    // Below 0 as well, so that pixels whose middle has no light are not lit by bands beyond.
    var x = m.steps * share;
    // d x / d n.l, times n.l per pixel.
    var slope = m.steps * m.scale / reach;
    if TOON_EXPONENT {
        x = m.steps * pow(max(share, 0.0), m.exponent);
        slope = x * m.exponent * m.scale / max(share * reach, 1e-6);
    }
    let k = band_mean(x, min(slope * gradient, m.steps), m.steps);
    var level = k / m.steps;
    if m.levels == 1u { level = (k + 0.5) / m.steps; }
    if m.levels == 2u { level = k / (m.steps - 1.0); }
    return min(m.top * level, 1.0);
}

fn toon_shade(s: Surface, m: ToonMaterial) -> vec3<f32> {
    var light = vec3<f32>(0.0);
    var highlight = 0.0;
    for (var i = 0u; i < light_count(); i++) {
        let sample = light_at(i, s);
        let l = sample.to_light;
        let cosine = dot(s.normal_view, l);
        // A point light's direction turns as the point moves.
        let turn_dx = -(s.position_dx - l * dot(l, s.position_dx)) * sample.inverse_distance;
        let turn_dy = -(s.position_dy - l * dot(l, s.position_dy)) * sample.inverse_distance;
        let cosine_dx = dot(s.normal_dx, l) + dot(s.normal_view, turn_dx);
        let cosine_dy = dot(s.normal_dy, l) + dot(s.normal_view, turn_dy);
        let level = toon_level(cosine, length(vec2<f32>(cosine_dx, cosine_dy)), m);
        light += level * sample.visibility * sample.radiance;
        if TOON_SPECULAR && m.specular_color.a > 0.0 && cosine > 0.0 {
            // [Livny2007 §4, from the prose: reflected, and only where lit]
            let mirrored = 2.0 * cosine * s.normal_view - l;
            let mirrored_dx = 2.0 * (cosine_dx * s.normal_view + cosine * s.normal_dx) - turn_dx;
            let mirrored_dy = 2.0 * (cosine_dy * s.normal_view + cosine * s.normal_dy) - turn_dy;
            let shine = dot(mirrored, s.to_viewer);
            let shine_dx = dot(mirrored_dx, s.to_viewer) + dot(mirrored, s.to_viewer_dx);
            let shine_dy = dot(mirrored_dy, s.to_viewer) + dot(mirrored, s.to_viewer_dy);
            let step = covered(shine - m.specular_limit, vec2<f32>(shine_dx, shine_dy));
            highlight = max(highlight, step * sample.visibility);
        }
    }
    var color = s.base_color * light;
    if m.shadow_color.a > 0.0 {
        color = s.base_color * mix(m.shadow_color.rgb, vec3<f32>(1.0), min(light, vec3<f32>(1.0)));
    }
    if TOON_SPECULAR {
        color = mix(color, m.specular_color.rgb, highlight * m.specular_color.a);
    }
    if TOON_OUTLINE && m.outline_bias > 0.0 {
        let facing = dot(s.normal_view, s.to_viewer);
        color = mix(m.color.rgb, color, covered(facing - m.outline_bias, facing_step(s)));
    }
    return color;
}

// Share of a pixel in which a value that changes by `gradient` per pixel lies above zero: the box filter
// of a straight edge, by the gradient's length.
fn covered(value: f32, gradient: vec2<f32>) -> f32 {
    return clamp(value / max(length(gradient), 1e-9) + 0.5, 0.0, 1.0);
}
