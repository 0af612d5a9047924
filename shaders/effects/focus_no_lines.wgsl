// No effect drew lines before depth of field.

fn line_at(at: vec2<i32>) -> Pane {
    return Pane(vec3<f32>(0.0), 0.0, 0.0);
}

// What a pixel shows first.
fn first_seen(at: vec2<i32>) -> vec2<f32> {
    let list = list_at(at);
    if list.count > 0u { return vec2<f32>(bitcast<f32>(layer_pool[list.start].x), 1.0); }
    let texel = textureLoad(geometry, at, 0);
    return vec2<f32>(bitcast<f32>(texel.x), f32(min(texel.w, 1u)));
}
