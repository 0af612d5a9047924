// Between the two passes over what is transparent: the list of each pixel is put in the order of shapes, and within each of depth, and
// a bucket is made for each shape [Murray2016 §4.1 "Z reordering", "Bucket creation"].

@group(2) @binding(0) var<uniform> bkb: BkbBand;
@group(2) @binding(1) var<storage, read_write> bkb_z: array<u32>;
@group(2) @binding(2) var<storage, read_write> bkb_b: array<u32>;

// Swaps depth and shape, and sorts by insertion: few keys move, since those of one shape are in order already.
// Returns how many there are.
fn reorder(first: u32) -> u32 {
    var count = 0u;
    while count < bkb.k {
        let key = bkb_z[first + count];
        if key == EMPTY { break; }
        let swapped = key << 16u | key >> 16u;
        var slot = count;
        while slot > 0u {
            let other = bkb_z[first + slot - 1u];
            if other <= swapped { break; }
            bkb_z[first + slot] = other;
            slot -= 1u;
        }
        bkb_z[first + slot] = swapped;
        count += 1u;
    }
    return count;
}

fn insert_bucket(first: u32, shape: u32, range: vec2<u32>) {
    var place = shape;
    while bkb_b[first + place % bkb.k] != EMPTY { place += 1u; }
    bkb_b[first + place % bkb.k] = shape << 16u | range.x << 8u | range.y;
}

@compute @workgroup_size(8, 8)
fn make_buckets(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let at = invocation.xy + vec2<u32>(0u, bkb.first_row);
    if at.x >= bkb.width || invocation.y >= bkb.num_rows { return; }
    let first = first_slot(bkb, at);
    let count = reorder(first);
    for (var slot = first; slot < first + bkb.k; slot++) { bkb_b[slot] = EMPTY; }
    var start = 0u;
    while start < count {
        let shape = bkb_z[first + start] >> 16u;
        var end = start + 1u;
        while end < count && bkb_z[first + end] >> 16u == shape { end += 1u; }
        insert_bucket(first, shape, vec2<u32>(start, end - 1u));
        start = end;
    }
}
