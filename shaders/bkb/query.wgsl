// Finds buckets [Murray2016 §4.1, Fig. 4].

// First and last slot of the bucket of a shape, counted within the pixel; a last before the first where there is none.
fn bucket_of(first: u32, shape: u32) -> vec2<u32> {
    var place = shape;
    for (var probe = 0u; probe < bkb.k; probe++) {
        let bucket = bkb_b[first + place % bkb.k];
        if bucket == EMPTY { break; }
        if bucket >> 16u == shape { return vec2<u32>(bucket >> 8u & 0xffu, bucket & 0xffu); }
        place += 1u;
    }
    return vec2<u32>(1u, 0u);
}
