// Shades each pixel once, from the id that the visibility pass left there.
// Composed with the object shaders that the style uses. Written by the composer: `shade_object` and `material_of`,
// which read no more memory than the style's materials need.
// ENCODE: straight to picture values; otherwise premultiplied linear light, weighted for adding up samples.

struct Output {
    // Premultiplied linear background; alpha 0 for a transparent picture.
    background: vec4<f32>,
}

@group(1) @binding(0) var<uniform> lights: Lights;
@group(1) @binding(1) var<uniform> output: Output;
@group(1) @binding(2) var visibility: texture_2d<u32>;

// Linear light of a surface; of a hull outline its colour.
fn shaded(s: Surface, id: u32) -> vec3<f32> {
    let material = material_of(id);
    var color = shade_object(s, material);
    if HULLS && (id >> 29u) > KIND_LAST_SURFACE {
        color = materials[material].hull_color;
    }
    return color;
}

@fragment
fn shade_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let id = textureLoad(visibility, vec2<i32>(position.xy), 0).x;
    let color = shaded(surface_at(ray_at(view, position.xy), id), id);
    if ENCODE {
        return encode(vec4<f32>(color, 1.0), output.background);
    }
    return vec4<f32>(color, 1.0) * view.sample_weight;
}
