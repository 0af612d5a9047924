// Gives each pixel's list its room in the pool, in no particular order: lists are sorted afterwards, so that the picture does not
// depend on it. Each invocation takes a row of pixels, so that the one counter is asked once for all of them.

@group(0) @binding(0) var<uniform> layers: LayerBand;
@group(0) @binding(1) var<storage, read_write> layer_counts: array<u32>;
@group(0) @binding(2) var<storage, read_write> layer_starts: array<u32>;
// Fragments in all, and 1 where they are more than a word counts.
@group(0) @binding(3) var<storage, read_write> layer_total: array<atomic<u32>>;

const RUN: u32 = 32u;

@compute @workgroup_size(64)
fn make_room(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let first = invocation.x * RUN;
    let end = min(first + RUN, layers.num_pixels);
    var sum = 0u;
    for (var pixel = first; pixel < end; pixel++) { sum += layer_counts[pixel]; }
    if sum == 0u { return; }
    var start = atomicAdd(&layer_total[0], sum);
    if start > 0xffffffffu - sum { atomicMax(&layer_total[1], 1u); }
    for (var pixel = first; pixel < end; pixel++) {
        let count = layer_counts[pixel];
        layer_starts[pixel] = start;
        start += count;
        // Writing counts anew.
        layer_counts[pixel] = 0u;
    }
}
