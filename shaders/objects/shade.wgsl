// Shades each pixel once, from the id that the visibility pass left there.
// Composed with the object shaders that the style uses; `shade_object` is written by the composer.
// ENCODE: straight to picture values; otherwise premultiplied linear light, weighted for adding up samples.

struct Output {
    // Premultiplied linear background; alpha 0 for a transparent picture.
    background: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> atoms: array<Atom>;
@group(0) @binding(2) var<storage, read> connectors: array<Connector>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(1) @binding(0) var<uniform> lights: Lights;
@group(1) @binding(1) var<uniform> output: Output;
@group(1) @binding(2) var visibility: texture_2d<u32>;

@vertex
fn shade_vertex(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}

@fragment
fn shade_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let id = textureLoad(visibility, vec2<i32>(position.xy), 0).x;
    if id == 0u {
        if ENCODE {
            return encode(vec4<f32>(0.0), output.background);
        }
        discard;
    }
    let material = materials[object_material(id)];
    var color = material.hull_color.rgb;
    if (id >> 29u) <= KIND_CONNECTOR {
        var s = surface_at(ray_at(view, position.xy + view.jitter_px), id);
        s.base_color = mix(s.base_color, material.base_color.rgb, material.base_color.a);
        color = shade_object(s, material);
    }
    if ENCODE {
        return encode(vec4<f32>(color, 1.0), output.background);
    }
    return vec4<f32>(color, 1.0) * view.sample_weight;
}
