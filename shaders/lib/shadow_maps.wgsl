// Shadow maps: for each texel the id of what a light sees first, and two depths, of its front and of its outline.

const MAX_SHADOWS: u32 = 4u;

struct ShadowView {
    light: View,
    light_from_view: mat4x4<f32>,
}

struct Shadows {
    views: array<ShadowView, 4>,
}

// A point of the camera's view space as a light sees it.
struct LitPlace {
    // In the light's view space.
    point: vec3<f32>,
    // Depth there.
    t: f32,
    place_px: vec2<f32>,
    // Size of a texel at that depth.
    texel_light: f32,
}

fn lit_place(light_view: View, point: vec3<f32>) -> LitPlace {
    let t = -point.z;
    let scale = mix(t, 1.0, light_view.orthographic);
    let ndc = point.xy / (light_view.half_extent * scale);
    return LitPlace(
        point, t, (ndc * vec2<f32>(0.5, -0.5) + 0.5) * light_view.size_px, light_view.pixel_view * scale,
    );
}

// Points spread evenly over the unit disc on a spiral of the golden angle [Vogel1979 eq. 1].
fn disc_tap(i: u32, turn: f32) -> vec2<f32> {
    let angle = f32(i) * 2.3999632 + turn;
    return sqrt((f32(i) + 0.5) / f32(SOFT_TAPS)) * vec2<f32>(cos(angle), sin(angle));
}

// A value in 0..1 for each texel, different among neighbours [Jimenez2014 p. 123].
fn interleaved_noise(place_px: vec2<f32>) -> f32 {
    let p = floor(place_px);
    return fract(52.9829189 * fract(dot(p, vec2<f32>(0.06711056, 0.00583715))));
}
