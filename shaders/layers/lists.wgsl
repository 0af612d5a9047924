// The lists of all pixels of a band.

@group(2) @binding(0) var<uniform> layers: LayerBand;
@group(2) @binding(1) var<storage, read_write> layer_ends: array<u32>;
@group(2) @binding(2) var<storage, read_write> layer_runs: array<u32>;
@group(2) @binding(3) var<storage, read_write> layer_pool: array<vec2<u32>>;
