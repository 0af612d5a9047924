// Words of D.

// A colour of linear light as sRGB, 8 bits a channel, and 8 bits beside it. Even steps of light itself would band in the dark.
fn pack_color(color: vec3<f32>, beside: u32) -> u32 {
    return pack4x8unorm(vec4<f32>(srgb_from_linear(color), 0.0)) | beside << 24u;
}

// Linear light of the three channels.
fn unpack_color(word: u32) -> vec3<f32> {
    let value = unpack4x8unorm(word).rgb;
    let high = pow((value + 0.055) / 1.055, vec3<f32>(2.4));
    return select(high, value / 12.92, value <= vec3<f32>(0.04045));
}

// Steps of a coordinate of a normal from 0 to 1: 15 bits for -1 to 1, with 0 among them.
const NORMAL_STEPS: f32 = 16383.0;

// A unit vector: 15 bits each of x and y, and 2 bits that say on which side z is [Murray2016 §4.2]. Never 0.
fn pack_normal(normal: vec3<f32>) -> u32 {
    let place = vec2<u32>(clamp(normal.xy, vec2<f32>(-1.0), vec2<f32>(1.0)) * NORMAL_STEPS + (NORMAL_STEPS + 0.5));
    return place.x | place.y << 15u | select(2u, 1u, normal.z < 0.0) << 30u;
}

fn unpack_normal_word(word: u32) -> vec3<f32> {
    let place = vec2<f32>(f32(word & 0x7fffu), f32(word >> 15u & 0x7fffu)) / NORMAL_STEPS - 1.0;
    let z = sqrt(max(1.0 - place.x * place.x - place.y * place.y, 0.0));
    return vec3<f32>(place, select(z, -z, word >> 30u == 1u));
}
