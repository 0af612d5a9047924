// The slot of a fragment whose key was kept: its bucket by its shape, then its place there by its depth, by halves
// [Murray2016 §4.2].

@group(2) @binding(1) var<storage, read_write> bkb_z: array<u32>;
@group(2) @binding(2) var<storage, read_write> bkb_b: array<u32>;

// EMPTY where it was not kept.
fn slot_of(first: u32, key: u32) -> u32 {
    let sought = key << 16u | key >> 16u;
    let range = bucket_of(first, sought >> 16u);
    var low = range.x;
    var end = range.y + 1u;
    while low < end {
        let middle = (low + end) / 2u;
        if bkb_z[first + middle] < sought { low = middle + 1u; } else { end = middle; }
    }
    if low > range.y || bkb_z[first + low] != sought { return EMPTY; }
    return first + low;
}
