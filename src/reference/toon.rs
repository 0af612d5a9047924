//! `toon`, sample by sample: bands and outlines have hard edges, which many samples make smooth [Prost2016 eq. 1 and 2,
//! Livny2007 §4]. The mends of both are those of `shaders/objects/toon.wgsl`.

use glam::{DVec3, Vec4};

use super::light::Arriving;
use crate::shading::toon::ToonMaterial;

/// Linear light of a surface of this base colour.
pub fn shade(m: &ToonMaterial, base_color: DVec3, normal: DVec3, to_viewer: DVec3, lights: &[Arriving]) -> DVec3 {
    let facing = normal.dot(to_viewer);
    if m.outline_bias > 0.0 && facing < f64::from(m.outline_bias) {
        return rgb(m.color);
    }
    let (mut light, mut highlight) = (DVec3::ZERO, 0.0f64);
    for arriving in lights {
        let cosine = normal.dot(arriving.to_light);
        light += level(m, cosine) * arriving.visibility * arriving.radiance;
        if m.specular_color[3] > 0.0 && cosine > 0.0 {
            let mirrored = 2.0 * cosine * normal - arriving.to_light;
            if mirrored.dot(to_viewer) > f64::from(m.specular_limit) {
                highlight = highlight.max(arriving.visibility);
            }
        }
    }
    let color = if m.shadow_color[3] > 0.0 {
        let shadow = rgb(m.shadow_color);
        base_color * (shadow + (DVec3::ONE - shadow) * light.min(DVec3::ONE))
    } else {
        base_color * light
    };
    color.lerp(rgb(m.specular_color), highlight * f64::from(m.specular_color[3]))
}

/// Brightness of the band in which a cosine lies.
fn level(m: &ToonMaterial, cosine: f64) -> f64 {
    let [scale, bias, exponent, steps, top] = [m.scale, m.bias, m.exponent, m.steps, m.top].map(f64::from);
    if scale == 0.0 || steps < 2.0 {
        return top.min(1.0);
    }
    let share = (scale * cosine + bias).max(0.0) / (scale + bias);
    let band = (steps * share.powf(exponent)).floor().min(steps - 1.0);
    let level = match m.levels {
        1 => (band + 0.5) / steps,
        2 => band / (steps - 1.0),
        _ => band / steps,
    };
    (top * level).min(1.0)
}

fn rgb(color: [f32; 4]) -> DVec3 {
    Vec4::from(color).truncate().as_dvec3()
}
