// The base colour as it was written: no light, no tone map.

struct UnlitMaterial {
    _pad0: f32,
    _pad1: f32,
    _pad2: f32,
    _pad3: f32,
}

fn unlit_shade(s: Surface, m: UnlitMaterial) -> vec3<f32> {
    return s.base_color;
}
