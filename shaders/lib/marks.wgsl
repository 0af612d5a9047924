// What neighbouring pixels ask of a fragment, in two words behind the fragments of the pool and their light, where that is kept: its normal,
// as a point of an octahedron that is folded open, 22 bits a coordinate, and 20 bits of the number of its object.

const MARK_STEPS: f32 = 2097151.0;

fn mark_place(index: u32) -> u32 {
    return layers.capacity * select(1u, 2u, KEEPS_LIGHT) + index;
}

// Kinds differ in their upper bits.
fn mark_of_object(object: u32) -> u32 {
    return (object ^ object >> 12u) & 0xfffffu;
}

fn pack_mark(normal: vec3<f32>, object: u32) -> vec2<u32> {
    let flat = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let signs = select(vec2<f32>(-1.0), vec2<f32>(1.0), flat >= vec2<f32>(0.0));
    let folded = select(flat, (1.0 - abs(flat.yx)) * signs, normal.z < 0.0);
    let steps = vec2<u32>(vec2<i32>(round(folded * MARK_STEPS)) + i32(MARK_STEPS));
    let number = mark_of_object(object);
    return steps << vec2<u32>(10u) | vec2<u32>(number & 0x3ffu, number >> 10u);
}

fn object_of_mark(mark: vec2<u32>) -> u32 {
    return (mark.x & 0x3ffu) | (mark.y & 0x3ffu) << 10u;
}

fn normal_of_mark(mark: vec2<u32>) -> vec3<f32> {
    let flat = (vec2<f32>(mark >> vec2<u32>(10u)) - MARK_STEPS) / MARK_STEPS;
    let z = 1.0 - abs(flat.x) - abs(flat.y);
    let signs = select(vec2<f32>(-1.0), vec2<f32>(1.0), flat >= vec2<f32>(0.0));
    return normalize(vec3<f32>(select(flat, (1.0 - abs(flat.yx)) * signs, z < 0.0), z));
}
