// What neighbouring pixels ask of a fragment, in two words behind the fragments of the pool and their light, where that is kept: its normal,
// folded with 22 bits a coordinate (`lib/geometry.wgsl`), and 20 bits of the number of its object.

const MARK_STEPS: f32 = 2097151.0;

fn mark_place(index: u32) -> u32 {
    return layers.capacity * select(1u, 2u, KEEPS_LIGHT) + index;
}

// Kinds differ in their upper bits.
fn mark_of_object(object: u32) -> u32 {
    return (object ^ object >> 12u) & 0xfffffu;
}

fn pack_mark(normal: vec3<f32>, object: u32) -> vec2<u32> {
    let steps = vec2<u32>(vec2<i32>(round(fold_unit(normal) * MARK_STEPS)) + i32(MARK_STEPS));
    let number = mark_of_object(object);
    return steps << vec2<u32>(10u) | vec2<u32>(number & 0x3ffu, number >> 10u);
}

fn object_of_mark(mark: vec2<u32>) -> u32 {
    return (mark.x & 0x3ffu) | (mark.y & 0x3ffu) << 10u;
}

fn normal_of_mark(mark: vec2<u32>) -> vec3<f32> {
    return unfold_unit((vec2<f32>(mark >> vec2<u32>(10u)) - MARK_STEPS) / MARK_STEPS);
}
