//! `basic`, its integrals taken by directions: GGX and Disney diffuse under lights and all of the studio's light
//! [Burley2012 §5, named by Murray2016 §4.2].
//!
//! The formulas are those of `shaders/lib/brdf.wgsl`; the albedos that balance them are integrated here, closely enough that
//! linear interpolation between them is within 1e-4, and the environment is summed up over directions.

use glam::DVec3;

use super::light::Arriving;
use super::sampling::{cosine_direction, spread};
use crate::shading::basic::BasicMaterial;
use crate::shading::brdf_table::{N_DOT_V_MIN, ROUGHNESS_MIN, albedos};
use crate::shading::environment::Studio;

/// Reflectance at normal incidence of index 1.5, the usual dielectric [Filament, base colour remapping].
const F0_DIELECTRIC: f64 = 0.04;
/// Albedos of one roughness: at n.v = (x / last)^2.
const NUM_ALBEDOS: usize = 257;
/// Directions of each albedo.
const ALBEDO_DIRECTIONS: u32 = 2048;

/// A material, with its albedos.
pub struct Basic {
    roughness: f64,
    metallic: f64,
    exposure_factor: f64,
    albedos: Vec<DVec3>,
}

/// What one surface's material and viewer give every light.
struct Balanced {
    n_dot_v: f64,
    alpha2: f64,
    f0: DVec3,
    specular_gain: DVec3,
    diffuse_gain: DVec3,
}

impl Basic {
    /// The material of these parameters.
    pub fn new(material: &BasicMaterial) -> Basic {
        let roughness = f64::from((1.0 - material.smoothness).clamp(ROUGHNESS_MIN, 1.0));
        let place = |index: usize| (index as f64 / (NUM_ALBEDOS - 1) as f64).powi(2).max(f64::from(N_DOT_V_MIN));
        Basic {
            roughness,
            metallic: f64::from(material.metallic),
            exposure_factor: f64::from(material.exposure_factor),
            albedos: (0..NUM_ALBEDOS).map(|index| albedos(place(index), roughness, ALBEDO_DIRECTIONS).into()).collect(),
        }
    }

    /// Linear light that leaves a surface, before the tone map. `num_directions` of the environment for each lobe.
    #[allow(clippy::too_many_arguments, reason = "all that light depends on")]
    pub fn radiance(
        &self,
        base_color: DVec3,
        normal: DVec3,
        to_viewer: DVec3,
        lights: &[Arriving],
        studio: &Studio,
        ambient: DVec3,
        num_directions: u32,
        seed: u64,
    ) -> DVec3 {
        let balanced = self.balanced(base_color, normal.dot(to_viewer));
        let mut radiance = DVec3::ZERO;
        for light in lights.iter().filter(|light| light.visibility > 0.0) {
            radiance +=
                light.radiance * light.visibility * self.reflected(&balanced, normal, to_viewer, light.to_light);
        }
        if ambient.max_element() > 0.0 {
            radiance += ambient * self.environment(&balanced, normal, to_viewer, studio, num_directions, seed);
        }
        radiance
    }

    /// Linear light of the picture.
    pub fn tone_mapped(&self, radiance: DVec3) -> DVec3 {
        tone_map(radiance * self.exposure_factor)
    }

    fn balanced(&self, base_color: DVec3, n_dot_v: f64) -> Balanced {
        let n_dot_v = n_dot_v.clamp(f64::from(N_DOT_V_MIN), 1.0);
        let place = n_dot_v.sqrt() * (NUM_ALBEDOS - 1) as f64;
        let low = (place as usize).min(NUM_ALBEDOS - 2);
        let albedos = self.albedos[low].lerp(self.albedos[low + 1], place - low as f64);
        // Single scattering and what follows it [Turquin2019, eqs. 14, 16].
        let specular = |f0: DVec3| {
            let single = f0 * albedos.x + albedos.y;
            single * (DVec3::ONE + f0 * (1.0 / (albedos.x + albedos.y) - 1.0))
        };
        let coat = specular(DVec3::splat(F0_DIELECTRIC)).x;
        let f0 = DVec3::splat(F0_DIELECTRIC).lerp(base_color, self.metallic);
        let specular_albedo = DVec3::splat(coat).lerp(specular(base_color), self.metallic);
        Balanced {
            n_dot_v,
            alpha2: self.roughness.powi(4),
            f0,
            specular_gain: specular_albedo / (f0 * albedos.x + albedos.y).max(DVec3::splat(1e-6)),
            diffuse_gain: base_color * ((1.0 - self.metallic) * (1.0 - coat)) / albedos.z,
        }
    }

    /// pi f n.l: radiance for light of radiance 1.
    fn reflected(&self, b: &Balanced, normal: DVec3, to_viewer: DVec3, to_light: DVec3) -> DVec3 {
        let n_dot_l = normal.dot(to_light).min(1.0);
        if n_dot_l <= 0.0 {
            return DVec3::ZERO;
        }
        let half = (to_light + to_viewer).normalize_or(normal);
        let l_dot_h = half.dot(to_light).clamp(0.0, 1.0);
        let sin2 = normal.cross(half).length_squared().min(1.0);
        let width = sin2 + b.alpha2 * (1.0 - sin2);
        let distribution_pi = b.alpha2 / (width * width);
        let masking = 0.5 / (n_dot_l * smith(b.alpha2, b.n_dot_v) + b.n_dot_v * smith(b.alpha2, n_dot_l));
        n_dot_l
            * (b.diffuse_gain * self.diffuse(l_dot_h, n_dot_l, b.n_dot_v)
                + b.specular_gain * fresnel(b.f0, l_dot_h) * (distribution_pi * masking))
    }

    /// pi f of the Disney diffuse term for base colour 1 [Burley2012 §5.3].
    fn diffuse(&self, l_dot_h: f64, n_dot_l: f64, n_dot_v: f64) -> f64 {
        let grazing = 0.5 + 2.0 * self.roughness * l_dot_h * l_dot_h;
        let term = |cosine: f64| 1.0 + (grazing - 1.0) * (1.0 - cosine).powi(5);
        term(n_dot_l) * term(n_dot_v)
    }

    /// The studio's light that a surface reflects, for ambient light of 1.
    fn environment(
        &self,
        b: &Balanced,
        normal: DVec3,
        to_viewer: DVec3,
        studio: &Studio,
        num_directions: u32,
        seed: u64,
    ) -> DVec3 {
        let seen = |direction: DVec3| studio.radiance(direction.as_vec3()).as_dvec3();
        let (mut diffuse, mut specular) = (DVec3::ZERO, DVec3::ZERO);
        let (side, other) = normal.any_orthonormal_pair();
        let viewer = DVec3::new(to_viewer.dot(side), to_viewer.dot(other), b.n_dot_v).normalize();
        let alpha = self.roughness * self.roughness;
        let stretched = DVec3::new(alpha * viewer.x, alpha * viewer.y, viewer.z).normalize();
        let masked_v = smith(b.alpha2, viewer.z);
        let g1 = 2.0 * viewer.z / (viewer.z + masked_v);
        for index in 0..num_directions {
            let point = spread(index, seed);
            if b.diffuse_gain.max_element() > 0.0 {
                let to_light = cosine_direction(point, normal);
                let half = (to_light + to_viewer).normalize_or(normal);
                let weight = self.diffuse(half.dot(to_light).clamp(0.0, 1.0), normal.dot(to_light).max(0.0), b.n_dot_v);
                diffuse += weight * seen(to_light);
            }
            // Visible normals by spherical caps [Dupuy2023, VNDF sampling].
            let cap = (1.0 - point.y) * (1.0 + stretched.z) - stretched.z;
            let sine = (1.0 - cap * cap).max(0.0).sqrt();
            let (sin, cos) = (std::f64::consts::TAU * point.x).sin_cos();
            let raised = DVec3::new(sine * cos, sine * sin, cap) + stretched;
            let half = DVec3::new(alpha * raised.x, alpha * raised.y, raised.z).normalize_or(DVec3::Z);
            let v_dot_h = viewer.dot(half).clamp(0.0, 1.0);
            let light = 2.0 * v_dot_h * half - viewer;
            if light.z > 0.0 {
                let g2 = 2.0 * viewer.z * light.z / (viewer.z * smith(b.alpha2, light.z) + light.z * masked_v);
                let to_light = light.x * side + light.y * other + light.z * normal;
                specular += fresnel(b.f0, v_dot_h) * (g2 / g1) * seen(to_light);
            }
        }
        (b.diffuse_gain * diffuse + b.specular_gain * specular) / f64::from(num_directions.max(1))
    }
}

/// The square root of Smith's Lambda for GGX, times the cosine [Heitz2014, eq. 99].
fn smith(alpha2: f64, cosine: f64) -> f64 {
    (cosine * cosine * (1.0 - alpha2) + alpha2).sqrt()
}

/// Schlick's Fresnel term [Schlick1994, eq. 15].
fn fresnel(f0: DVec3, l_dot_h: f64) -> DVec3 {
    f0 + (DVec3::ONE - f0) * (1.0 - l_dot_h).powi(5)
}

/// Khronos PBR Neutral [PbrNeutral "PBR Neutral Specification"].
fn tone_map(radiance: DVec3) -> DVec3 {
    const F90: f64 = 0.04;
    const START: f64 = 0.8 - F90;
    const DESATURATION: f64 = 0.15;
    let color = radiance.max(DVec3::ZERO);
    let low = color.min_element();
    let offset = if low < 2.0 * F90 { low - low * low / (4.0 * F90) } else { F90 };
    let lifted = color - offset;
    let peak = lifted.max_element();
    if peak <= START {
        return lifted;
    }
    let room = 1.0 - START;
    let new_peak = 1.0 - room * room / (peak + room - START);
    let saturation = 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    DVec3::splat(new_peak).lerp(lifted * (new_peak / peak), saturation)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(smoothness: f32, metallic: f32) -> Basic {
        Basic::new(&BasicMaterial::new(smoothness, metallic, 1.0))
    }

    #[test]
    fn a_white_surface_in_white_light_reflects_all_of_it() {
        for (smoothness, metallic) in [(0.0, 0.0), (0.5, 0.0), (0.9, 0.0), (0.3, 1.0), (0.9, 1.0), (0.5, 0.5)] {
            let basic = material(smoothness, metallic);
            for degrees in [0.0f64, 30.0, 60.0, 80.0] {
                let to_viewer = DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
                let light = basic.radiance(DVec3::ONE, DVec3::Z, to_viewer, &[], &Studio::white(), DVec3::ONE, 4096, 1);
                assert!((light - DVec3::ONE).abs().max_element() < 0.01, "{smoothness} {metallic} {degrees}: {light}");
            }
        }
    }

    #[test]
    fn a_light_that_a_white_matt_surface_faces_lights_it_to_about_one() {
        let light = Arriving { to_light: DVec3::Z, radiance: DVec3::ONE, visibility: 1.0 };
        let lit =
            material(0.0, 0.0).radiance(DVec3::ONE, DVec3::Z, DVec3::Z, &[light], &Studio::white(), DVec3::ZERO, 0, 0);
        assert!((lit.x - 1.0).abs() < 0.1, "{lit}");
    }
}
