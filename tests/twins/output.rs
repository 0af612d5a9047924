//! What leaves the program: exact flat colours, transparency that composites right, no value that is no number.

use super::gpu::{self, linear_from_srgb, srgb_from_linear};
use restyle::engine::Request;
use restyle::scene::{Image, Pixels};

const SIZE: [u32; 2] = [256, 192];
/// Bonded, with a third atom apart.
const MOLECULE: &[&str] = &["C 0 0 0", "O 1.2 0.3 0.2", "N -2 1 -1"];

/// Everything that draws: both outlines, bands, a highlight, a shadow, plastic.
fn style(background: &str) -> String {
    format!(
        r##"{{"camera": {{"bgcolor": "{background}"}}, "geometry": {{"scale": 0.35, "bond_radius": "0.2A"}},
            "mapping": {{"atom": "t", "connector": "t", "atom[element=N]": "b"}},
            "shaders": [
                {{"name": "t", "shader": "toon", "properties": {{"hull_size": "9pt", "outline_bias": 0.3,
                    "color": "#501060", "specular_color": "#ffffff", "shadow_color": "#304080"}}}},
                {{"name": "b", "shader": "basic", "properties": {{"smoothness": 0.9}}}}],
            "lights": [{{"position": [1, 2, 3], "shadow": "soft"}}, {{"type": "ambient", "intensity": 0.4}}]}}"##
    )
}

/// A picture over another of one colour, in linear light, as an image viewer should lay it.
fn over(image: &Image, background: [f32; 3]) -> Vec<[f64; 3]> {
    gpu::pixels(image.size)
        .map(|(x, y)| {
            let [r, g, b, a] = image.pixel(x, y);
            let alpha = f64::from(a);
            std::array::from_fn(|c| {
                let light = linear_from_srgb([r, g, b][c]) * alpha + (1.0 - alpha) * linear_from_srgb(background[c]);
                srgb_from_linear(light)
            })
        })
        .collect()
}

/// Of full scale: the rounding of straight colour and alpha to 16 bits, far below one step of 8 bits.
const COMPOSITE_16: f64 = 1.0 / 255.0;
/// Of full scale: alpha to 8 bits is off by half a step, which over black is 12.92 / 2 = 6.5 steps of sRGB, rounded up.
const COMPOSITE_8: f64 = 7.0 / 255.0;

#[test]
fn transparent_pictures_composite_to_the_direct_ones() {
    let backgrounds = [("#000000", [0.0; 3]), ("#ffffff", [1.0; 3]), ("#3366cc", [0.2, 0.4, 0.8])];
    for (wide, samples, limit) in
        [(true, 16, COMPOSITE_16), (true, 1, COMPOSITE_16), (false, 16, COMPOSITE_8), (false, 1, COMPOSITE_8)]
    {
        let request = Request { transparent: true, wide, ..Request::new(SIZE, samples) };
        let Some(mut engine) = gpu::engine(MOLECULE, &style("#123456")) else { return };
        let cut_out = engine.still(&request).expect("a still");
        let partly = gpu::pixels(SIZE).filter(|&(x, y)| (0.1..0.9).contains(&cut_out.pixel(x, y)[3])).count();
        assert!(samples == 1 || partly > 200, "{partly} partly covered pixels are too few to tell");
        for (name, color) in backgrounds {
            let Some(mut engine) = gpu::engine(MOLECULE, &style(name)) else { return };
            let direct = engine.still(&Request { transparent: false, ..request }).expect("a still");
            assert!(direct.opaque);
            let worst = gpu::pixels(SIZE)
                .zip(over(&cut_out, color))
                .flat_map(|((x, y), laid)| {
                    let pixel = direct.pixel(x, y);
                    (0..3).map(move |c| (f64::from(pixel[c]) - laid[c]).abs())
                })
                .fold(0.0, f64::max);
            let bits = if wide { 16 } else { 8 };
            eprintln!("transparent over {name}, {bits} bits, {samples} samples: off by {:.3} of 1/255", worst * 255.0);
            assert!(worst <= limit, "{name}, {bits} bits, {samples} samples: {worst}");
        }
    }
}

#[test]
fn flat_colours_leave_as_they_were_written() {
    // The object and the background swap the same two colours.
    for (object, background) in [([0x33, 0x66, 0xcc], [0xfe, 0x01, 0x80]), ([0xfe, 0x01, 0x80], [0x33, 0x66, 0xcc])] {
        let hex = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
        let style = format!(
            r#"{{"camera": {{"bgcolor": "{}"}}, "mapping": {{"*": "u"}},
                "shaders": [{{"name": "u", "shader": "unlit", "properties": {{"base_color": "{}"}}}}]}}"#,
            hex(background),
            hex(object)
        );
        for (wide, samples) in [(false, 1), (false, 16), (true, 1), (true, 16)] {
            let Some(mut engine) = gpu::engine(&["C 0 0 0"], &style) else { return };
            let image = engine.still(&Request { wide, ..Request::new(SIZE, samples) }).expect("a still");
            for ((x, y), color) in [((SIZE[0] / 2, SIZE[1] / 2), object), ((2, 2), background)] {
                let start = 4 * (y as usize * SIZE[0] as usize + x as usize);
                match &image.pixels {
                    Pixels::U8(values) => {
                        assert_eq!(values[start..start + 4], [color[0], color[1], color[2], 255], "{samples} samples");
                    }
                    Pixels::U16(values) => {
                        // 0x33 of 8 bits is 0x3333 of 16.
                        let expected = [color[0], color[1], color[2], 255].map(|value| u16::from(value) * 257);
                        assert_eq!(values[start..start + 4], expected, "{samples} samples");
                    }
                }
            }
        }
    }
}

#[test]
fn every_value_is_a_number() {
    let cameras = [
        r#""fov": 35"#,
        r#""orthographic": true"#,
        // Within the first atom, and within the bond.
        r#""fov": 100, "position": [0.05, 0, 0], "target": [1, 0.2, 0]"#,
    ];
    for camera in cameras {
        let style = style("#000000").replace(r##""bgcolor": "#000000""##, camera);
        let Some(mut engine) = gpu::engine(MOLECULE, &style) else { return };
        let image = gpu::aovs(&mut engine, SIZE);
        assert!(image.color.iter().all(|value| value.is_finite() && *value >= 0.0), "{camera}");
        assert!(image.normal.iter().all(|value| value.is_finite()), "{camera}");
        assert!(image.depth.iter().all(|value| *value > 0.0), "{camera}");
    }
}
