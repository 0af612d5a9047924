//! Twin of `shaders/objects/toon.wgsl`, its known answers, and the bands of [Prost2016 eq. 2] measured in pictures.

use super::basic::LightSample;
use super::gpu;
use super::surface::{Surface, surface_at};
use super::truth::{World, center_px};
use glam::{Vec2, Vec3, Vec4};
use restyle::shading::toon::ToonMaterial;

/// A light with what the derivatives of a point light's direction need.
pub struct ToonLight {
    pub sample: LightSample,
    /// 0 for a directional one.
    pub inverse_distance: f32,
}

pub fn band_mean(x: f32, width: f32, steps: f32) -> f32 {
    if steps < 2.0 {
        return 0.0;
    }
    if width < 1.0 {
        let edge = (x + 0.5).floor().clamp(1.0, steps - 1.0);
        return edge - 1.0 + ((x - edge) / width.max(1e-6) + 0.5).clamp(0.0, 1.0);
    }
    (band_integral(x + 0.5 * width, steps) - band_integral(x - 0.5 * width, steps)) / width
}

fn band_integral(x: f32, steps: f32) -> f32 {
    let k = x.floor().clamp(0.0, steps - 1.0);
    k * (x - 0.5 * (k + 1.0))
}

pub fn toon_level(cosine: f32, gradient: f32, m: &ToonMaterial) -> f32 {
    if m.scale == 0.0 || m.steps < 2.0 {
        return m.top.min(1.0);
    }
    let reach = m.scale + m.bias;
    let share = (m.scale * cosine + m.bias) / reach;
    let mut x = m.steps * share;
    let mut slope = m.steps * m.scale / reach;
    if m.exponent != 1.0 {
        x = m.steps * share.max(0.0).powf(m.exponent);
        slope = x * m.exponent * m.scale / (share * reach).max(1e-6);
    }
    let k = band_mean(x, (slope * gradient).min(m.steps), m.steps);
    let level = match m.levels {
        1 => (k + 0.5) / m.steps,
        2 => k / (m.steps - 1.0),
        _ => k / m.steps,
    };
    (m.top * level).min(1.0)
}

fn covered(value: f32, gradient: Vec2) -> f32 {
    (value / gradient.length().max(1e-9) + 0.5).clamp(0.0, 1.0)
}

fn rgb(color: [f32; 4]) -> Vec3 {
    Vec4::from_array(color).truncate()
}

pub fn toon_shade(lights: &[ToonLight], s: &Surface, m: &ToonMaterial) -> Vec3 {
    let mut light = Vec3::ZERO;
    let mut highlight = 0f32;
    for ToonLight { sample, inverse_distance } in lights {
        let l = sample.to_light;
        let cosine = s.normal_view.dot(l);
        let turn_dx = -(s.position_dx - l * l.dot(s.position_dx)) * *inverse_distance;
        let turn_dy = -(s.position_dy - l * l.dot(s.position_dy)) * *inverse_distance;
        let cosine_dx = s.normal_dx.dot(l) + s.normal_view.dot(turn_dx);
        let cosine_dy = s.normal_dy.dot(l) + s.normal_view.dot(turn_dy);
        let level = toon_level(cosine, Vec2::new(cosine_dx, cosine_dy).length(), m);
        light += level * sample.visibility * sample.radiance;
        if m.specular_color[3] > 0.0 && cosine > 0.0 {
            let mirrored = 2.0 * cosine * s.normal_view - l;
            let mirrored_dx = 2.0 * (cosine_dx * s.normal_view + cosine * s.normal_dx) - turn_dx;
            let mirrored_dy = 2.0 * (cosine_dy * s.normal_view + cosine * s.normal_dy) - turn_dy;
            let shine = mirrored.dot(s.to_viewer);
            let shine_dx = mirrored_dx.dot(s.to_viewer) + mirrored.dot(s.to_viewer_dx);
            let shine_dy = mirrored_dy.dot(s.to_viewer) + mirrored.dot(s.to_viewer_dy);
            let step = covered(shine - m.specular_limit, Vec2::new(shine_dx, shine_dy));
            highlight = highlight.max(step * sample.visibility);
        }
    }
    let mut color = s.base_color * light;
    if m.shadow_color[3] > 0.0 {
        color = s.base_color * (rgb(m.shadow_color) + (1.0 - rgb(m.shadow_color)) * light.min(Vec3::ONE));
    }
    color = color.lerp(rgb(m.specular_color), highlight * m.specular_color[3]);
    if m.outline_bias > 0.0 {
        let facing = s.normal_view.dot(s.to_viewer);
        let facing_dx = s.normal_dx.dot(s.to_viewer) + s.normal_view.dot(s.to_viewer_dx);
        let facing_dy = s.normal_dy.dot(s.to_viewer) + s.normal_view.dot(s.to_viewer_dy);
        color = rgb(m.color).lerp(color, covered(facing - m.outline_bias, Vec2::new(facing_dx, facing_dy)));
    }
    color
}

/// Alpha, beta, gamma and s of [Prost2016 eqs. 1, 2].
pub type Bands = (f32, f32, f32, f32);

/// A material of these bands: no outline, no colours of its own, `levels: floor`.
pub fn material((scale, bias, exponent, steps): Bands) -> ToonMaterial {
    ToonMaterial {
        color: [0.0, 0.0, 0.0, 1.0],
        scale,
        bias,
        exponent,
        steps,
        specular_limit: 0.95,
        top: (scale + bias).powf(exponent),
        ..bytemuck::Zeroable::zeroed()
    }
}

/// The properties of a style for these bands.
pub fn properties((scale, bias, exponent, steps): Bands) -> String {
    format!(r#""scale": {scale}, "bias": {bias}, "exponent": {exponent}, "steps": {steps}"#)
}

/// The published settings of [Prost2016 fig. 3], then others: few and many bands, each exponent side, a dim top.
pub const SETTINGS: [Bands; 8] = [
    (0.5, 0.5, 2.0, 2.0),
    (0.5, 0.5, 2.0, 4.0),
    (0.5, 0.5, 2.0, 8.0),
    (1.0, 0.0, 1.0, 4.0),
    (0.7, 0.3, 1.0, 6.0),
    (0.9, 0.1, 0.5, 5.0),
    (0.6, 0.2, 3.0, 5.0),
    (0.8, 0.4, 0.7, 3.0),
];

#[test]
fn a_negative_base_is_dark_and_never_nan() {
    for exponent in [0.3, 0.5, 1.0, 2.0, 3.5] {
        let m = material((1.0, 0.2, exponent, 4.0));
        for i in 0..=200 {
            let cosine = i as f32 / 100.0 - 1.0;
            for gradient in [0.0, 1e-3, 0.1, 10.0] {
                let level = toon_level(cosine, gradient, &m);
                assert!((0.0..=1.0).contains(&level), "{exponent} {cosine} {gradient}: {level}");
            }
        }
        assert_eq!(toon_level(-1.0, 0.0, &m), 0.0);
    }
}

#[test]
fn without_alpha_or_with_one_step_nothing_changes_anywhere() {
    for bands in [(0.0, 0.7, 2.0, 8.0), (0.5, 0.5, 2.0, 1.0), (0.6, 0.2, 0.5, 1.0)] {
        let m = material(bands);
        for i in 0..=200 {
            let cosine = i as f32 / 100.0 - 1.0;
            assert_eq!(toon_level(cosine, 0.01, &m), m.top.min(1.0), "{bands:?} at {cosine}");
        }
    }
}

#[test]
fn the_light_pole_has_the_level_of_its_band() {
    // Eq. 2 as printed would give it a level of its own, a single point wide.
    let m = material((0.5, 0.5, 2.0, 4.0));
    assert_eq!(toon_level(1.0, 1e-6, &m), toon_level(0.99, 1e-6, &m));
    assert_eq!(toon_level(1.0, 1e-6, &m), 0.75);
}

#[test]
fn what_is_turned_from_the_light_is_dark_however_fine_the_bands_are() {
    let m = material((1.0, 0.0, 1.0, 256.0));
    // Ten bands a pixel: half of the pixel on the terminator is lit, and no pixel beyond it.
    let [on, beyond, far] = [0.0, -0.02, -1.0].map(|cosine| toon_level(cosine, 10.0 / 256.0, &m));
    assert!((on - 0.5 * 2.0 / 256.0).abs() < 1e-6 && beyond == 0.0 && far == 0.0, "{on} {beyond} {far}");
}

#[test]
fn a_band_mean_without_width_is_the_hard_step() {
    for steps in [2.0, 3.0, 8.0] {
        for i in 0..1000 {
            // Never on an edge, where both sides are right.
            let x = (i as f32 + 0.5) / 1000.0 * steps;
            assert_eq!(band_mean(x, 0.0, steps), x.floor().min(steps - 1.0), "{x} of {steps}");
        }
    }
}

#[test]
fn a_wide_band_mean_is_the_mean_over_the_bands() {
    for steps in [2.0, 3.0, 8.0] {
        // A pixel over all of it sees each band once: 0, 1, ..., steps - 1.
        let mean = band_mean(0.5 * steps, steps, steps);
        assert!((mean - 0.5 * (steps - 1.0)).abs() < 1e-5, "{mean} of {steps}");
        for (x, width) in [(0.3, 1.0), (1.7, 1.5), (0.5 * steps, 2.2), (steps, 3.0)] {
            let samples = 100_000;
            let truth: f64 = (0..samples)
                .map(|i| f64::from(x) + f64::from(width) * ((f64::from(i) + 0.5) / f64::from(samples) - 0.5))
                .map(|x| x.floor().clamp(0.0, f64::from(steps) - 1.0))
                .sum();
            let truth = truth / f64::from(samples);
            let mean = band_mean(x, width, steps);
            assert!((f64::from(mean) - truth).abs() < 1e-4, "{x} {width} of {steps}: {mean}, not {truth}");
        }
    }
}

#[test]
fn levels_are_the_floor_the_centre_or_the_full_range() {
    let mut m = material((1.0, 0.0, 1.0, 4.0));
    let level = |m: &ToonMaterial, cosine| toon_level(cosine, 1e-6, m);
    for (levels, expected) in [(0, [0.0, 0.25, 0.5, 0.75]), (1, [0.125, 0.375, 0.625, 0.875])] {
        m.levels = levels;
        assert_eq!([0.1, 0.3, 0.6, 0.9].map(|cosine| level(&m, cosine)), expected);
    }
    m.levels = 2;
    for (cosine, expected) in [(0.1, 0.0), (0.3, 1.0 / 3.0), (0.6, 2.0 / 3.0), (0.9, 1.0)] {
        assert!((level(&m, cosine) - expected).abs() < 1e-6);
    }
    // Brighter than white is white.
    assert_eq!(level(&material((2.0, 1.0, 1.0, 2.0)), 1.0), 1.0);
}

const SIZE: [u32; 2] = [256, 256];
const RADIUS: f64 = 1.6;

fn style(camera: &str, lights: &str, properties: &str) -> String {
    format!(
        r#"{{"camera": {{{camera}}}, "geometry": {{"atom": "{RADIUS}A", "scale": 1}}, "mapping": {{"atom": "t"}},
            "shaders": [{{"name": "t", "shader": "toon", "properties": {{{properties}}}}}], "lights": [{lights}]}}"#
    )
}

const HEADLIGHT: &str = r#"{"type": "directional", "position": [0, 0, 1]}"#;

/// Largest difference of a channel at pixels that face the viewer by more than [`FACING`]. A step divides its distance
/// by its gradient: 1e-6 of rounding in n.l is 1e-4 of a step where n.l changes by 0.01 a pixel.
const TWIN: f32 = 1e-3;
/// Towards the silhouette the derivatives grow without bound, and with them the rounding.
const FACING: f64 = 0.1;

#[test]
fn gpu_equals_twin() {
    let camera_lights = [
        (r#""orthographic": true"#, r#"{"type": "directional", "position": [1, 2, 3], "intensity": 0.9}"#),
        (r#""fov": 50"#, r#"{"type": "point", "position": [2, 1, 1.5]}"#),
    ];
    let mut worst = 0f32;
    for (camera, light) in camera_lights {
        for (bands, levels) in SETTINGS.into_iter().zip(["floor", "centre", "full"].into_iter().cycle()) {
            for livny in [false, true] {
                let mut m = material(bands);
                m.levels = ["floor", "centre", "full"].iter().position(|name| *name == levels).expect("a level") as u32;
                let mut written = format!(r##"{}, "levels": "{levels}", "base_color": "#e09050""##, properties(bands));
                if livny {
                    m.shadow_color = gpu::color("#203060").extend(1.0).to_array();
                    m.specular_color = gpu::color("#fffff0").extend(1.0).to_array();
                    m.color = gpu::color("#401010").extend(1.0).to_array();
                    m.outline_bias = 0.4;
                    m.specular_limit = 0.9;
                    written += r##", "shadow_color": "#203060", "specular_color": "#fffff0", "specular_limit": 0.9,
                        "color": "#401010", "outline_bias": 0.4"##;
                }
                let Some(mut engine) = gpu::engine(&["C 0.1 0.2 0.3"], &style(camera, light, &written)) else {
                    return;
                };
                let image = gpu::aovs(&mut engine, SIZE);
                let world = World::new(&engine, SIZE, &[RADIUS], 0.14);
                let difference = difference(&world, &image.color, &m, light);
                assert!(difference <= TWIN, "{bands:?} {levels} {livny} {camera}: {difference}");
                worst = worst.max(difference);
            }
        }
    }
    eprintln!("toon, GPU and twin: at most {worst:.1e}");
}

fn difference(world: &World, color: &[f32], m: &ToonMaterial, light: &str) -> f32 {
    let mut worst = 0f32;
    let mut compared = 0;
    let point = light.contains("point");
    // Where `gpu_equals_twin` puts the lights; radii are those of the bounding sphere, carbon's 1.7.
    let center = match world.shapes[0].1 {
        super::truth::Shape::Sphere { center, .. } => center.as_vec3(),
        _ => unreachable!("an atom is a sphere"),
    };
    for (index, pixel) in gpu::pixels(SIZE).enumerate() {
        let Some((_, shape, hit)) = world.seen(center_px(pixel)) else { continue };
        let s = surface_at(&world.view, center_px(pixel), &shape, &hit, gpu::color("#e09050"), 1.0);
        if f64::from(s.normal_view.dot(s.to_viewer)) < FACING {
            continue;
        }
        let (to_light, radiance, inverse_distance) = if point {
            let offset = center + 1.7 * Vec3::new(2.0, 1.0, 1.5) - s.position_view;
            (offset.normalize(), 1.0, 1.0 / offset.length())
        } else {
            (Vec3::new(1.0, 2.0, 3.0).normalize(), 0.9, 0.0)
        };
        let sample = LightSample { to_light, radiance: Vec3::splat(radiance), visibility: 1.0 };
        let twin = toon_shade(&[ToonLight { sample, inverse_distance }], &s, m);
        let drawn = Vec3::from_slice(&color[4 * index..4 * index + 3]);
        worst = worst.max((drawn - twin).abs().max_element());
        compared += 1;
    }
    assert!(compared > 10_000, "{compared} pixels");
    worst
}

/// Pixels. A border that is anti-aliased over one pixel holds its place in the covered share.
const BORDER_PX: f64 = 0.5;

#[test]
fn levels_change_where_the_published_equation_says() {
    const SIZE: [u32; 2] = [512, 512];
    for bands in SETTINGS {
        let (scale, bias, exponent, steps) = bands;
        let written = format!(r##"{}, "base_color": "#ffffff""##, properties(bands));
        let Some(mut engine) = gpu::engine(&["C 0 0 0"], &style(r#""orthographic": true"#, HEADLIGHT, &written)) else {
            return;
        };
        let image = gpu::aovs(&mut engine, SIZE);
        let world = World::new(&engine, SIZE, &[RADIUS], 0.14);
        let radius_px = RADIUS / world.view.pixel_view();
        let middle = 0.5 * world.view.size;
        let top = (f64::from(scale) + f64::from(bias)).powf(f64::from(exponent));
        let (mut worst, mut borders) = (0f64, 0);
        for k in 1..steps as u32 {
            // Eq. 2 steps to level k where s ((alpha n.l + beta) / (alpha + beta))^gamma = k.
            let base = (f64::from(k) / f64::from(steps)).powf(1.0 / f64::from(exponent));
            let cosine = (base * f64::from(scale + bias) - f64::from(bias)) / f64::from(scale);
            if cosine <= 0.0 {
                continue;
            }
            borders += 1;
            let border_px = radius_px * (1.0 - cosine * cosine).sqrt();
            for (index, pixel) in gpu::pixels(SIZE).enumerate() {
                if image.ids[index] == 0 {
                    continue;
                }
                // Share of the pixel on the bright side of border k, and where it puts the border.
                let level = f64::from(image.color[4 * index]) / top * f64::from(steps);
                let share = level - f64::from(k - 1);
                let inside_px = border_px - center_px(pixel).distance(middle);
                // A pure pixel only says that the border is half a pixel away or more; the rounding of levels is 1e-6.
                let error = if share < 1e-4 {
                    inside_px + 0.5
                } else if share > 1.0 - 1e-4 {
                    0.5 - inside_px
                } else {
                    (inside_px - (share - 0.5)).abs()
                };
                worst = worst.max(error);
            }
        }
        eprintln!("{bands:?}: {borders} borders, off by at most {worst:.3} px");
        assert!(borders > 0 && worst <= BORDER_PX, "{bands:?}: {worst} px");
    }
}
