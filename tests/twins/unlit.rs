//! Twin of `shaders/objects/unlit.wgsl`, and of the way of its colour to the picture in `shaders/lib/encode.wgsl`.

use glam::Vec3;
use restyle::config::Srgba;
use restyle::frame::objects::pack_linear;
use restyle::shading::{linear, unlit::UnlitMaterial};

/// The base colour, whatever the light.
pub fn unlit_shade(base_color: Vec3, _material: &UnlitMaterial) -> Vec3 {
    base_color
}

pub fn srgb_from_linear(linear: Vec3) -> Vec3 {
    let encode = |c: f32| if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    Vec3::from(linear.clamp(Vec3::ZERO, Vec3::ONE).to_array().map(encode))
}

/// `unpack_linear` of `shaders/lib/objects.wgsl`.
fn unpack_linear([red_green, blue]: [u32; 2]) -> Vec3 {
    let half = |bits: u32| half::f16::from_bits(bits as u16).to_f32();
    Vec3::new(half(red_green), half(red_green >> 16), half(blue))
}

/// The bytes of a picture that shows this colour.
fn drawn(base_color: Vec3) -> [u8; 3] {
    let material = UnlitMaterial { _pad0: 0.0, _pad1: 0.0, _pad2: 0.0, _pad3: 0.0 };
    srgb_from_linear(unlit_shade(base_color, &material)).to_array().map(|channel| (channel * 255.0).round() as u8)
}

#[test]
fn a_flat_colour_leaves_exactly_as_it_was_written() {
    for level in 0..=255 {
        let written = [level, 255 - level, level / 2];
        assert_eq!(drawn(linear(Srgba::from_bytes(written))), written, "of a material");
    }
}

#[test]
fn a_colour_of_an_object_survives_its_half_floats() {
    for level in 0..=255 {
        let written = [level, 255 - level, level / 2];
        assert_eq!(drawn(unpack_linear(pack_linear(linear(Srgba::from_bytes(written))))), written, "of an atom");
    }
}
