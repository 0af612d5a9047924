// Hull outlines: back faces of an enlarged copy [Prost2016 §4.1].

// A line in pixels is never wider than HULL_SHARE of the radius that it outlines: on a molecule seen from
// far it thins out, where it would turn everything black (ours).
const HULL_SHARE: f32 = 0.4;

// Centre and radius of a larger sphere whose outline in the picture lies `width_px`, plus `width_world`,
// outside that of the sphere of `radius` at `center`. Perspective stretches pictures away from their
// middle: the two ends of the outline on the line through the middle are moved by the width, and the
// larger sphere is the one between them; across that line it is right within 3% of the width (ours).
fn hull_sphere(view: View, center: vec3<f32>, radius: f32, width_px: f32, width_world: f32) -> vec4<f32> {
    let wide = radius + width_world;
    let line = width_px * view.pixel_view;
    if ORTHOGRAPHIC {
        return vec4<f32>(center, wide + min(line, HULL_SHARE * wide));
    }
    let distance = length(center);
    if distance <= wide { return vec4<f32>(center, wide); }
    let sine = wide / distance;
    let spread = sine / sqrt(max(1.0 - sine * sine, 1e-6));
    let step = min(line, HULL_SHARE * spread);
    let off = length(center.xy);
    let tilt = off / max(-center.z, 1e-3 * distance);
    // Where the outline reaches beyond 80 degrees or so, as if in the middle of the picture.
    if tilt * spread > 0.8 || center.z >= 0.0 {
        let grown = spread + step;
        return vec4<f32>(center, distance * grown / sqrt(1.0 + grown * grown));
    }
    let high = normalize(vec2<f32>((tilt + spread) / (1.0 - tilt * spread) + step, 1.0));
    let low = normalize(vec2<f32>((tilt - spread) / (1.0 + tilt * spread) - step, 1.0));
    let toward = normalize(high + low);
    let outwards = center.xy / max(off, 1e-6 * distance);
    return vec4<f32>(distance * vec3<f32>(outwards * toward.x, -toward.y), 0.5 * distance * length(high - low));
}
