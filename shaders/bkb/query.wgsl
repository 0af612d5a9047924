// Finds buckets [Murray2016 §4.1, Fig. 4].

// First and last slot of the bucket of a shape, counted within the pixel; a last before the first where there is none.
fn bucket_of(first: u32, shape: u32) -> vec2<u32> {
    var place = shape;
    var bucket = bkb_b[first + place % bkb.k];
    for (var probe = 1u; probe < bkb.k && bucket != EMPTY && bucket >> 16u != shape; probe++) {
        place += 1u;
        bucket = bkb_b[first + place % bkb.k];
    }
    let is_there = bucket != EMPTY && bucket >> 16u == shape;
    return select(vec2<u32>(1u, 0u), vec2<u32>(bucket >> 8u & 0xffu, bucket & 0xffu), is_there);
}
