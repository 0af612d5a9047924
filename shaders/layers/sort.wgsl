// Puts lists in order: from near to far, equal depths by their ids. Of one class of runs those that are at most as long as its network
// sorts are held as a whole while it does; any list of the last class is sorted where it lies.

@group(0) @binding(0) var<uniform> layers: LayerBand;
@group(0) @binding(1) var<storage, read_write> layer_ends: array<u32>;
@group(0) @binding(2) var<storage, read_write> layer_runs: array<u32>;
@group(0) @binding(3) var<storage, read_write> layer_pool: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read_write> layer_classes: array<u32>;

// Behind every fragment.
const NOTHING: vec2<u32> = vec2<u32>(0xffffffffu);

fn is_before(a: vec2<u32>, b: vec2<u32>) -> bool {
    // Depths are positive: their bits are in their order.
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

fn fragment_at(list: LayerList, index: u32) -> vec2<u32> {
    return select(NOTHING, layer_pool[list.start + min(index, list.count - 1u)], index < list.count);
}

fn keep(list: LayerList, index: u32, fragment: vec2<u32>) {
    if index < list.count { layer_pool[list.start + index] = fragment; }
}

fn order(a: ptr<function, vec2<u32>>, b: ptr<function, vec2<u32>>) {
    let first = *a;
    let second = *b;
    let is_ordered = is_before(first, second);
    *a = select(second, first, is_ordered);
    *b = select(first, second, is_ordered);
}

@compute @workgroup_size(SORT_GROUP)
fn sort_runs(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let index = invocation.x / RUN;
    if index >= runs_of(layers) { return; }
    let run = layer_classes[CLASS * runs_of(layers) + index];
    if run == 0u { return; }
    let pixel = (run - 1u) * RUN + invocation.x % RUN;
    if pixel >= layers.num_pixels { return; }
    let list = list_of(pixel);
    if list.count > 1u { sort(list); }
}
