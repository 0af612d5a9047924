// The ids of nearest layers, over those of what is opaque, for effects that follow: lists are sorted by then.

@group(0) @binding(0) var<uniform> layers: LayerBand;
@group(0) @binding(1) var<storage, read_write> layer_counts: array<u32>;
@group(0) @binding(2) var<storage, read_write> layer_starts: array<u32>;
@group(0) @binding(3) var<storage, read_write> layer_pool: array<vec2<u32>>;

@fragment
fn nearest_id(@builtin(position) position: vec4<f32>) -> @location(0) u32 {
    let at = vec2<u32>(position.xy);
    let pixel = at.y * layers.width + at.x - layers.first_pixel;
    let count = layer_counts[pixel];
    if count == 0u || !fits(layers, layer_starts[pixel], count) { discard; }
    return layer_pool[layer_starts[pixel]].y;
}
