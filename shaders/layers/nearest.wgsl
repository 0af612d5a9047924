// The ids of nearest layers, over those of what is opaque, for effects that follow: lists are sorted by then.

@group(0) @binding(0) var<uniform> layers: LayerBand;
@group(0) @binding(1) var<storage, read_write> layer_ends: array<u32>;
@group(0) @binding(2) var<storage, read_write> layer_runs: array<u32>;
@group(0) @binding(3) var<storage, read_write> layer_pool: array<vec2<u32>>;

@fragment
fn nearest_id(@builtin(position) position: vec4<f32>) -> @location(0) u32 {
    let at = vec2<u32>(position.xy);
    let list = list_of(at.y * layers.width + at.x - layers.first_pixel);
    if list.count == 0u { discard; }
    return layer_pool[list.start].y;
}
