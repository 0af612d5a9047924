// The first pass over what is transparent: keys of the k nearest fragments of each pixel, sorted as they come
// [Murray2016 §4.1 "Z insertion", §4.2]. Each slot keeps the smaller of its key and the one that comes, and the larger goes on.
//
// Equal keys are one: the second finds the first, wherever that has gone to, and ends there (as in [Kubisch2014, throughout]).

@group(2) @binding(0) var<uniform> bkb: BkbBand;
@group(2) @binding(1) var<storage, read_write> bkb_z: array<atomic<u32>>;
@group(2) @binding(5) var opaque_depth: texture_depth_2d;

fn add_layer(position_px: vec2<f32>, id: u32, t: f32) {
    let at = vec2<i32>(position_px);
    if depth_value(view, t) <= textureLoad(opaque_depth, at, 0) { return; }
    let first = first_slot(bkb, vec2<u32>(at));
    let last = first + bkb.k - 1u;
    var key = layer_key(id, t);
    // Behind k others already.
    if key >= atomicLoad(&bkb_z[last]) { return; }
    for (var slot = first; slot <= last; slot++) {
        let former = atomicMin(&bkb_z[slot], key);
        if former == EMPTY || former == key { return; }
        key = max(former, key);
    }
}
