// The slot of a fragment whose key was kept, in a list that is in the order of depths: of the plain dual-pass k-buffer.

@group(2) @binding(1) var<storage, read_write> bkb_z: array<u32>;

// EMPTY where it was not kept.
fn slot_of(first: u32, key: u32) -> u32 {
    var low = 0u;
    var end = bkb.k;
    while low < end {
        let middle = (low + end) / 2u;
        if bkb_z[first + middle] < key { low = middle + 1u; } else { end = middle; }
    }
    if low >= bkb.k || bkb_z[first + low] != key { return EMPTY; }
    return first + low;
}
