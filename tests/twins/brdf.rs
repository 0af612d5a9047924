//! Twin of `shaders/lib/brdf.wgsl`, and its known answers: furnace, normalisation, reciprocity.

use glam::Vec3;
use restyle::shading::brdf_table::{BYTES, N_DOT_V_MIN, ROUGHNESS_MIN, SIZE};
use std::f32::consts::PI;

const F0_DIELECTRIC: f32 = 0.04;
const PIXEL_VARIANCE: f32 = 0.159_154_94;
const KERNEL_MAX: f32 = 0.18;

/// `BrdfSurface` of the shader.
pub struct BrdfSurface {
    pub n_dot_v: f32,
    pub roughness: f32,
    pub alpha2: f32,
    pub smith_v: f32,
    pub schlick_v: f32,
    pub f0: Vec3,
    pub specular_gain: Vec3,
    pub specular_albedo: Vec3,
    pub diffuse_gain: Vec3,
    pub diffuse_albedo: Vec3,
}

fn brdf_pow5(x: f32) -> f32 {
    let x2 = x * x;
    x2 * x2 * x
}

fn brdf_distribution_pi(alpha2: f32, sin2_n_h: f32) -> f32 {
    let d = sin2_n_h + alpha2 * (1.0 - sin2_n_h);
    alpha2 / (d * d)
}

fn brdf_smith(alpha2: f32, n_dot_x: f32) -> f32 {
    (n_dot_x * n_dot_x * (1.0 - alpha2) + alpha2).sqrt()
}

fn brdf_visibility(n_dot_l: f32, n_dot_v: f32, smith_l: f32, smith_v: f32) -> f32 {
    0.5 / (n_dot_l * smith_v + n_dot_v * smith_l)
}

fn brdf_fresnel(f0: Vec3, l_dot_h: f32) -> Vec3 {
    f0 + (Vec3::ONE - f0) * brdf_pow5(1.0 - l_dot_h)
}

fn brdf_disney_diffuse(roughness: f32, l_dot_h2: f32, schlick_l: f32, schlick_v: f32) -> f32 {
    let grazing = 2.0 * roughness * l_dot_h2 - 0.5;
    (1.0 + grazing * schlick_l) * (1.0 + grazing * schlick_v)
}

fn texel(x: usize, y: usize) -> Vec3 {
    let at = (y * SIZE as usize + x) * 16;
    let texel: [f32; 4] = bytemuck::pod_read_unaligned(&BYTES[at..at + 16]);
    Vec3::new(texel[0], texel[1], texel[2])
}

pub fn brdf_albedos(n_dot_v: f32, roughness: f32) -> Vec3 {
    let last = (SIZE - 1) as f32;
    let [x, y] = [n_dot_v.sqrt(), roughness].map(|u| u.clamp(0.0, 1.0) * last);
    let (low_x, low_y) = (x.floor().min(last - 1.0), y.floor().min(last - 1.0));
    let (i, j) = (low_x as usize, low_y as usize);
    let row0 = texel(i, j).lerp(texel(i + 1, j), x - low_x);
    let row1 = texel(i, j + 1).lerp(texel(i + 1, j + 1), x - low_x);
    row0.lerp(row1, y - low_y)
}

pub fn brdf_filtered_roughness(roughness: f32, normal_dx: Vec3, normal_dy: Vec3) -> f32 {
    let alpha = roughness * roughness;
    let turn = normal_dx.dot(normal_dx) + normal_dy.dot(normal_dy);
    let kernel = (2.0 * PIXEL_VARIANCE * turn).min(KERNEL_MAX);
    (alpha * alpha + kernel).min(1.0).sqrt().sqrt()
}

fn brdf_specular_albedo(f0: Vec3, albedos: Vec3) -> Vec3 {
    (f0 * albedos.x + albedos.y) * (1.0 + f0 * (1.0 / (albedos.x + albedos.y) - 1.0))
}

pub fn brdf_prepare(base_color: Vec3, metallic: f32, roughness: f32, n_dot_v: f32) -> BrdfSurface {
    let r = roughness.clamp(ROUGHNESS_MIN, 1.0);
    let v = n_dot_v.clamp(N_DOT_V_MIN, 1.0);
    let albedos = brdf_albedos(v, r);
    let alpha2 = r * r * r * r;
    let f0 = Vec3::splat(F0_DIELECTRIC).lerp(base_color, metallic);
    let coat = brdf_specular_albedo(Vec3::splat(F0_DIELECTRIC), albedos).x;
    let specular_albedo = Vec3::splat(coat).lerp(brdf_specular_albedo(base_color, albedos), metallic);
    let diffuse_albedo = base_color * ((1.0 - metallic) * (1.0 - coat));
    BrdfSurface {
        n_dot_v: v,
        roughness: r,
        alpha2,
        smith_v: brdf_smith(alpha2, v),
        schlick_v: brdf_pow5(1.0 - v),
        f0,
        specular_gain: specular_albedo / (f0 * albedos.x + albedos.y).max(Vec3::splat(1e-6)),
        specular_albedo,
        diffuse_gain: diffuse_albedo / albedos.z,
        diffuse_albedo,
    }
}

pub fn brdf_reflect(b: &BrdfSurface, n: Vec3, to_viewer: Vec3, to_light: Vec3) -> Vec3 {
    let n_dot_l = n.dot(to_light).min(1.0);
    if n_dot_l <= 0.0 {
        return Vec3::ZERO;
    }
    let half = to_light + to_viewer;
    let half2 = half.dot(half).max(1e-8);
    let l_dot_h2 = (0.25 * half2).min(1.0);
    let across = n.cross(half);
    let sin2_n_h = (across.dot(across) / half2).min(1.0);
    let smith_l = brdf_smith(b.alpha2, n_dot_l);
    let specular = brdf_distribution_pi(b.alpha2, sin2_n_h) * brdf_visibility(n_dot_l, b.n_dot_v, smith_l, b.smith_v);
    let diffuse = brdf_disney_diffuse(b.roughness, l_dot_h2, brdf_pow5(1.0 - n_dot_l), b.schlick_v);
    n_dot_l * (b.diffuse_gain * diffuse + b.specular_gain * brdf_fresnel(b.f0, l_dot_h2.sqrt()) * specular)
}

/// A viewer at `n_dot_v` over the normal +z.
pub fn viewer(n_dot_v: f32) -> Vec3 {
    Vec3::new((1.0 - n_dot_v * n_dot_v).max(0.0).sqrt(), 0.0, n_dot_v)
}

/// Integral of (BRDF * n.l * radiance) over the hemisphere around +z. Directions are spread evenly over
/// the half vector's GGX slope and over the cosine-weighted hemisphere, weighted by the balance
/// heuristic, so that neither lobe is missed.
pub fn integrate(b: &BrdfSurface, n_dot_v: f32, count: u32, radiance: impl Fn(Vec3) -> Vec3) -> Vec3 {
    let v = viewer(n_dot_v);
    let alpha2 = f64::from(b.alpha2);
    let pdfs = |l: Vec3| {
        let half = (l + v).as_dvec3();
        let sin2 = (half.x * half.x + half.y * half.y) / half.length_squared();
        let cos = (1.0 - sin2).max(0.0).sqrt();
        let d = sin2 + alpha2 * (1.0 - sin2);
        let half_pdf = alpha2 / (d * d) / std::f64::consts::PI * cos;
        let l_dot_h = half.length() * 0.5;
        half_pdf / (4.0 * l_dot_h) + f64::from(l.z.max(0.0)) / std::f64::consts::PI
    };
    let mut sum = glam::DVec3::ZERO;
    for i in 0..count {
        let u0 = (f64::from(i) + 0.5) / f64::from(count);
        let phi = 2.0 * std::f64::consts::PI * f64::from(i.reverse_bits()) / 2f64.powi(32);
        let cos2 = (1.0 - u0) / (1.0 + (alpha2 - 1.0) * u0);
        let polar = |cos2: f64| {
            let sin = (1.0 - cos2).max(0.0).sqrt();
            glam::DVec3::new(sin * phi.cos(), sin * phi.sin(), cos2.sqrt()).as_vec3()
        };
        let h = polar(cos2);
        for l in [h * (2.0 * v.dot(h)) - v, polar(1.0 - u0)] {
            if l.z > 0.0 {
                // brdf_reflect is pi f n.l.
                let value = brdf_reflect(b, Vec3::Z, v, l.normalize()) * radiance(l) / PI;
                sum += value.as_dvec3() / pdfs(l);
            }
        }
    }
    (sum / f64::from(count)).as_vec3()
}

const N_DOT_VS: [f32; 9] = [0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0];
const SMOOTHNESSES: [f32; 6] = [0.0, 0.25, 0.5, 0.75, 0.9, 1.0];

#[test]
fn white_surface_reflects_all_light_of_a_furnace() {
    let (mut least, mut most) = (f32::MAX, f32::MIN);
    for metallic in [0.0, 0.5, 1.0] {
        for smoothness in SMOOTHNESSES {
            for n_dot_v in N_DOT_VS {
                let b = brdf_prepare(Vec3::ONE, metallic, 1.0 - smoothness, n_dot_v);
                let total = integrate(&b, n_dot_v, 1 << 14, |_| Vec3::ONE).x;
                assert!((0.98..=1.02).contains(&total), "m {metallic} s {smoothness} n.v {n_dot_v}: {total}");
                (least, most) = (least.min(total), most.max(total));
            }
        }
    }
    println!("furnace, direct: {least}..{most}");
}

#[test]
fn white_surface_reflects_all_of_a_white_environment() {
    for metallic in [0.0, 0.5, 1.0] {
        for smoothness in SMOOTHNESSES {
            for n_dot_v in N_DOT_VS {
                let b = brdf_prepare(Vec3::ONE, metallic, 1.0 - smoothness, n_dot_v);
                let total = (b.diffuse_albedo + b.specular_albedo).x;
                assert!((total - 1.0).abs() < 1e-5, "m {metallic} s {smoothness} n.v {n_dot_v}: {total}");
            }
        }
    }
}

#[test]
fn albedo_that_the_table_gives_is_the_integral_of_the_brdf() {
    let mut worst = 0f32;
    for metallic in [0.0, 1.0] {
        for smoothness in [0.03, 0.33, 0.52, 0.77, 0.88] {
            for n_dot_v in [0.07, 0.13, 0.37, 0.81] {
                let base = Vec3::new(1.0, 0.5, 0.0);
                let b = brdf_prepare(base, metallic, 1.0 - smoothness, n_dot_v);
                let direct = integrate(&b, n_dot_v, 1 << 14, |_| Vec3::ONE);
                worst = worst.max((direct - b.diffuse_albedo - b.specular_albedo).abs().max_element());
            }
        }
    }
    println!("albedo between texels: {worst}");
    assert!(worst < 0.01, "{worst}");
}

#[test]
fn normal_distribution_integrates_to_one() {
    for roughness in [ROUGHNESS_MIN, 0.1, 0.25, 0.5, 0.75, 1.0] {
        let alpha2 = roughness.powi(4);
        // Integral of D (n.h) over the hemisphere = integral over t = sin^2 of pi D; substitute t = e^s.
        let n = 20_000;
        let low = -30.0f32;
        let sum: f64 = (0..n)
            .map(|i| {
                let sin2 = (low * (1.0 - (i as f32 + 0.5) / n as f32)).exp();
                f64::from(brdf_distribution_pi(alpha2, sin2) * sin2)
            })
            .sum();
        let total = sum * f64::from(-low) / f64::from(n);
        assert!((total - 1.0).abs() < 1e-3, "roughness {roughness}: {total}");
    }
}

#[test]
fn lobes_are_reciprocal_before_their_gains() {
    let pairs = [(Vec3::new(0.3, 0.1, 0.8), Vec3::new(-0.7, 0.4, 0.3)), (Vec3::Z, Vec3::new(0.9, 0.0, 0.1))];
    for (a, b) in pairs.map(|(a, b)| (a.normalize(), b.normalize())) {
        for roughness in [0.1, 0.5, 1.0] {
            let lobe = |v: Vec3, l: Vec3| {
                let mut s = brdf_prepare(Vec3::splat(0.7), 0.5, roughness, v.z);
                // The gains hold what depends on n.v alone: [Turquin2019] and the diffuse normalisation.
                s.specular_gain = Vec3::ONE;
                s.diffuse_gain = Vec3::ONE;
                brdf_reflect(&s, Vec3::Z, v, l) / l.z
            };
            let (one, other) = (lobe(a, b), lobe(b, a));
            assert!((one - other).abs().max_element() <= 1e-4 * one.max_element(), "{one} {other}");
        }
    }
}

#[test]
fn extreme_inputs_stay_finite() {
    let directions = [Vec3::Z, Vec3::X, Vec3::new(1.0, 0.0, -0.1).normalize(), -Vec3::X, -Vec3::Z];
    for base in [Vec3::ZERO, Vec3::ONE] {
        for roughness in [-1.0, 0.0, 1.0, 2.0] {
            for metallic in [0.0, 1.0] {
                for v in directions {
                    let b = brdf_prepare(base, metallic, roughness, v.z);
                    for l in directions {
                        let out = brdf_reflect(&b, Vec3::Z, v, l);
                        assert!(out.is_finite() && out.min_element() >= 0.0, "{v} {l} {roughness}: {out}");
                    }
                }
            }
        }
    }
}

#[test]
fn filter_is_off_without_derivatives_and_bounded() {
    assert!((brdf_filtered_roughness(0.3, Vec3::ZERO, Vec3::ZERO) - 0.3).abs() < 1e-6);
    assert!((brdf_filtered_roughness(0.0, Vec3::X * 9.0, Vec3::ZERO).powi(4) - KERNEL_MAX).abs() < 1e-6);
}
