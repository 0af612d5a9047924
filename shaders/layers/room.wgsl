// Gives each pixel's list its room in the pool, in no particular order: lists are sorted afterwards, so that the picture does not
// depend on it. Each invocation takes a run of pixels, so that the one counter is asked once for all of them. Runs that have a list to
// sort are sorted out by their longest.

@group(0) @binding(0) var<uniform> layers: LayerBand;
// Counts become places that writing begins at, and moves to the ends.
@group(0) @binding(1) var<storage, read_write> layer_ends: array<u32>;
@group(0) @binding(2) var<storage, read_write> layer_runs: array<u32>;
// Fragments in all, 1 where they are more than a word counts, and two words more; then four words for each class of runs: the groups
// that sort it, and its runs.
@group(0) @binding(3) var<storage, read_write> layer_tally: array<atomic<u32>>;
// Runs of each class, counted from 1, class after class.
@group(0) @binding(4) var<storage, read_write> layer_classes: array<u32>;

@compute @workgroup_size(64)
fn make_room(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let run = invocation.x;
    if run == 0u {
        for (var of_class = 0u; of_class < CLASSES; of_class++) {
            atomicStore(&layer_tally[4u + 4u * of_class + 1u], 1u);
            atomicStore(&layer_tally[4u + 4u * of_class + 2u], 1u);
        }
    }
    let first = run * RUN;
    if first >= layers.num_pixels { return; }
    let end = min(first + RUN, layers.num_pixels);
    var sum = 0u;
    var longest = 0u;
    for (var pixel = first; pixel < end; pixel++) {
        sum += layer_ends[pixel];
        longest = max(longest, layer_ends[pixel]);
    }
    var start = 0u;
    if sum > 0u {
        start = atomicAdd(&layer_tally[0], sum);
        if start > 0xffffffffu - sum { atomicMax(&layer_tally[1], 1u); }
    }
    layer_runs[run] = start;
    if sum == 0u { return; }
    for (var pixel = first; pixel < end; pixel++) {
        let count = layer_ends[pixel];
        layer_ends[pixel] = start;
        start += count;
    }
    if longest <= 1u { return; }
    var of_class = 0u;
    while of_class + 1u < CLASSES && longest > LONGEST[of_class] { of_class++; }
    let index = atomicAdd(&layer_tally[4u + 4u * of_class + 3u], 1u);
    if index % (SORT_GROUP / RUN) == 0u { atomicAdd(&layer_tally[4u + 4u * of_class], 1u); }
    layer_classes[of_class * runs_of(layers) + index] = run + 1u;
}
