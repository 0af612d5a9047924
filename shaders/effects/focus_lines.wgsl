// Lines that effects drew before depth of field, as surfaces of their own: at their depths, before all that their pixels show.

@group(2) @binding(4) var lines: texture_2d<f32>;
@group(2) @binding(5) var lines_geometry: texture_2d<u32>;

fn line_at(at: vec2<i32>) -> Pane {
    let color = textureLoad(lines, at, 0);
    if color.a <= 0.0 { return Pane(vec3<f32>(0.0), 0.0, 0.0); }
    let depth = abs(bitcast<f32>(textureLoad(lines_geometry, at, 0).x));
    return Pane(color.rgb / color.a, color.a, signed_radius_px(depth));
}

// What a pixel shows first.
fn first_seen(at: vec2<i32>) -> vec2<f32> {
    let texel = textureLoad(lines_geometry, at, 0);
    return vec2<f32>(bitcast<f32>(texel.x), f32(min(texel.w, 1u)));
}
