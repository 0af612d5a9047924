//! Twin of `shaders/lib/environment.wgsl`, held to integrals over the environment it stands for.

use super::brdf::{brdf_prepare, integrate, viewer};
use glam::{Quat, Vec3};
use restyle::shading::environment::{Environment, EnvironmentLobe, Studio};
use std::f32::consts::PI;

const LOBE_BLUR: f32 = 1.86;
const LOBE_KNEE: f32 = 0.072;
const LOBE_EDGE: f32 = 0.73;
const LOBE_EDGE_FLUX: f32 = 2.08;
const HORIZON_BLUR1: f32 = 2.3;
const HORIZON_BLUR2: f32 = 2.9;
const HORIZON_FADE: f32 = 0.33;

fn rgb(v: [f32; 4]) -> Vec3 {
    Vec3::new(v[0], v[1], v[2])
}

pub fn environment_diffuse(environment: &Environment, n: Vec3) -> Vec3 {
    let sh = environment.sh.map(rgb);
    let constant_linear = sh[0] + sh[1] * n.y + sh[2] * n.z + sh[3] * n.x;
    let quadratic = sh[4] * (n.x * n.y)
        + sh[5] * (n.y * n.z)
        + sh[6] * (3.0 * n.z * n.z - 1.0)
        + sh[7] * (n.x * n.z)
        + sh[8] * (n.x * n.x - n.y * n.y);
    (constant_linear + quadratic).max(Vec3::ZERO)
}

fn environment_flux(falloff: f32) -> f32 {
    let t = 1.0 + 0.25 * falloff;
    (1.0 + t + t * t) / (3.0 * t * t * t)
}

fn environment_falloff(width: f32, alpha: f32) -> f32 {
    let alpha2 = alpha * alpha;
    let open = 1.0 - alpha2;
    let blur = LOBE_BLUR * alpha2 * (1.0 + width / (alpha + LOBE_KNEE * width));
    open / (open * width * width + blur)
}

fn environment_lobe(lobe: &EnvironmentLobe, r: Vec3, alpha: f32) -> f32 {
    let along = environment_falloff(lobe.tangent[3], alpha);
    let across = environment_falloff(lobe.bitangent[3], alpha);
    let edge2 = LOBE_EDGE * alpha * alpha * lobe.tangent[3] * lobe.bitangent[3];
    let flux = (lobe.direction[3] / (environment_flux(along) * environment_flux(across))).sqrt();
    let x = r.dot(rgb(lobe.tangent));
    let y = r.dot(rgb(lobe.bitangent));
    let z = r.dot(rgb(lobe.direction));
    let facing = 0.5 * (z + (z * z + edge2).sqrt()) / (1.0 + LOBE_EDGE_FLUX * edge2);
    let t = 1.0 + 0.25 * (along * x * x + across * y * y);
    let t2 = t * t;
    (flux * facing).max(0.0) / (t2 * t2)
}

fn environment_height(width: f32, up: f32, alpha: f32) -> f32 {
    let alpha2 = alpha * alpha;
    let open = 1.0 - alpha2;
    let blur = HORIZON_BLUR1 * alpha * width + HORIZON_BLUR2 * alpha2;
    let scale = (open * (1.0 + width * width) + blur) / (open * (up * up + width * width) + blur);
    up * scale.sqrt() * (1.0 - HORIZON_FADE * alpha * width)
}

pub fn environment_specular(environment: &Environment, r: Vec3, roughness: f32) -> Vec3 {
    let alpha = roughness * roughness;
    let height = environment_height(environment.zenith[3], r.y, alpha);
    let gradient = rgb(environment.ground).lerp(rgb(environment.zenith), 0.5 + 0.5 * height);
    environment.lobes.iter().fold(gradient, |sum, lobe| sum + rgb(lobe.color) * environment_lobe(lobe, r, alpha))
}

/// Evenly spread unit directions.
fn directions(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * i as f32 + 1.0) / count as f32;
        let angle = 2.399_963_2 * i as f32;
        let radius = (1.0 - z * z).sqrt();
        Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
    })
}

/// Radiance averaged over the GGX lobe of n = v = r, weighted by n.l [Karis2013 §"Pre-Filtered Studio Map"].
fn prefiltered(environment: &Studio, r: Vec3, alpha: f32, count: u32) -> Vec3 {
    let from_z = Quat::from_rotation_arc(Vec3::Z, r);
    let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
    for i in 0..count {
        let u = (i as f32 + 0.5) / count as f32;
        let phi = 2.0 * PI * (i.reverse_bits() as f32 / 4_294_967_296.0);
        let cos_l = 2.0 * (1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u) - 1.0;
        if cos_l > 0.0 {
            let sin_l = (1.0 - cos_l * cos_l).max(0.0).sqrt();
            let l = from_z * Vec3::new(sin_l * phi.cos(), sin_l * phi.sin(), cos_l);
            sum += environment.radiance(l.normalize()) * cos_l;
            weight += cos_l;
        }
    }
    sum / weight
}

#[test]
fn white_environment_is_white_at_any_roughness() {
    let white = Studio::white().uniform();
    for d in directions(50) {
        assert!((environment_diffuse(&white, d) - 1.0).abs().max_element() < 1e-4);
        for roughness in [0.0, 0.5, 1.0] {
            assert!((environment_specular(&white, d, roughness) - 1.0).abs().max_element() < 1e-6);
        }
    }
}

#[test]
fn mirror_sees_the_environment_itself() {
    let studio = Studio::neutral();
    for d in directions(500) {
        let error = environment_specular(&studio.uniform(), d, 0.0) - studio.radiance(d);
        assert!(error.abs().max_element() < 1e-4, "{d}: {error}");
    }
}

#[test]
fn studio_has_mean_radiance_one() {
    let studio = Studio::neutral();
    let mean = directions(10_000).map(|d| studio.radiance(d)).sum::<Vec3>() / 10_000.0;
    assert!((mean.element_sum() / 3.0 - 1.0).abs() < 1e-3, "{mean}");
}

#[test]
fn harmonics_are_near_the_irradiance_integral() {
    let studio = Studio::neutral();
    let uniform = studio.uniform();
    let (mut worst, mut brightest) = (0f32, 0f32);
    for n in directions(150) {
        let truth = directions(10_000).map(|d| studio.radiance(d) * n.dot(d).max(0.0)).sum::<Vec3>() * 4.0 / 10_000.0;
        worst = worst.max((environment_diffuse(&uniform, n) - truth).abs().max_element());
        brightest = brightest.max(truth.max_element());
    }
    println!("irradiance / pi: largest error {worst} of {brightest}");
    assert!(worst <= 0.02 * brightest, "{worst} of {brightest}");
}

#[test]
fn blurred_studio_is_near_its_integral() {
    let studio = Studio::neutral();
    let uniform = studio.uniform();
    for roughness in [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0f32] {
        let (mut squares, mut worst) = (0.0, 0f32);
        for r in directions(200) {
            let truth = prefiltered(&studio, r, roughness * roughness, 1024);
            let error = environment_specular(&uniform, r, roughness) - truth;
            squares += error.length_squared() / 3.0;
            worst = worst.max(error.abs().max_element());
        }
        let rms = (squares / 200.0).sqrt();
        println!("roughness {roughness}: RMS {rms:.4}, largest {worst:.4}");
        assert!(rms <= 0.012 && worst <= 0.05, "roughness {roughness}: RMS {rms}, largest {worst}");
    }
}

/// Quality: the split sum and its dominant direction against integrating BRDF * studio.
#[test]
fn split_sum_is_near_the_full_integral() {
    let studio = Studio::neutral();
    let uniform = studio.uniform();
    let v = Vec3::Z;
    let mut total = 0.0;
    for roughness in [0.1, 0.3, 0.5, 0.7, 1.0] {
        let mut squares = 0.0;
        let normals: Vec<Vec3> = directions(120).filter(|n| n.z > 0.05).collect();
        for &n in &normals {
            let b = brdf_prepare(Vec3::ONE, 1.0, roughness, n.z);
            let r = 2.0 * n.z * n - v;
            let seen = super::basic::basic_dominant_direction(n, r, b.roughness);
            let split = b.specular_albedo * environment_specular(&uniform, seen, b.roughness);
            // `integrate` works around +z with the viewer in the xz plane.
            let tangent = v.reject_from_normalized(n).normalize_or(n.any_orthonormal_vector());
            let to_world = glam::Mat3::from_cols(tangent, n.cross(tangent), n);
            assert!((to_world * viewer(n.z) - v).length() < 1e-3);
            let truth = integrate(&b, n.z, 2048, |l| studio.radiance(to_world * l));
            squares += (split - truth).length_squared() / 3.0;
        }
        let rms = (squares / normals.len() as f32).sqrt();
        total += rms;
        println!("white metal, roughness {roughness}: RMS {rms:.4}");
    }
    println!("split sum, mean RMS {:.4}", total / 5.0);
    assert!(total / 5.0 < 0.06, "{}", total / 5.0);
}
