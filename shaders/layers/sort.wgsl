// Puts the lists of all pixels in order, for blending that looks beyond its own.

@group(0) @binding(0) var<uniform> layers: LayerBand;
@group(0) @binding(1) var<storage, read_write> layer_counts: array<u32>;
@group(0) @binding(2) var<storage, read_write> layer_starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> layer_pool: array<vec2<u32>>;

@compute @workgroup_size(8, 8)
fn sort_lists(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let pixel = invocation.y * layers.width + invocation.x;
    if invocation.x >= layers.width || pixel >= layers.num_pixels { return; }
    let count = layer_counts[pixel];
    if count > 1u && fits(layers, layer_starts[pixel], count) { sort_layers(layer_starts[pixel], count); }
}
