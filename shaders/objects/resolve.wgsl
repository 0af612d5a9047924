// Turns the accumulated light of a still into picture values, 8 or 16 bits a channel.

struct Output {
    // Premultiplied linear background; alpha 0 for a transparent picture.
    background: vec4<f32>,
}

@group(0) @binding(0) var<uniform> output: Output;
@group(0) @binding(1) var light: texture_2d<f32>;

@fragment
fn resolve_8(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return encode(textureLoad(light, vec2<i32>(position.xy), 0), output.background);
}

@fragment
fn resolve_16(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let color = encode(textureLoad(light, vec2<i32>(position.xy), 0), output.background);
    return vec4<u32>(round(clamp(color, vec4<f32>(0.0), vec4<f32>(1.0)) * 65535.0));
}
