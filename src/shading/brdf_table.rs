//! Directional albedos of the `basic` BRDF: what a white surface reflects towards one viewer.
//!
//! A texel holds (A, B, D, 0) for one pair of n.v and perceptual roughness:
//! - `A`, `B`: GGX reflects `F0 * A + B` of a uniform white environment, the split of
//!   [Karis2013 §"Environment BRDF"] with the height-correlated Smith term of [Heitz2014, eq. 99].
//! - `D`: what the Disney diffuse term of [Burley2012 §5.3] reflects with base colour 1.
//!
//! Column x holds n.v = (x / 31)^2, which puts texels where Fresnel and masking change fastest;
//! row y holds perceptual roughness y / 31. Shader: `shaders/lib/brdf.wgsl`. Twin: `tests/twins/brdf.rs`.

use std::f64::consts::PI;

/// Texels on each side.
pub const SIZE: u32 = 32;

/// Smallest perceptual roughness, so alpha >= 0.002: below it D(h) leaves what f32 resolves
/// around its peak. Filament's value for 32-bit floats [Filament, roughness clamping].
pub const ROUGHNESS_MIN: f32 = 0.045;

/// Smallest n.v: exact grazing has no albedo to tabulate.
pub const N_DOT_V_MIN: f32 = 1e-4;

/// The table as it goes into an `rgba32float` texture, rows from roughness 0 to 1.
/// `RESTYLE_BLESS=brdf_table cargo test` writes it anew; a test keeps it equal to [`compute`].
pub const BYTES: &[u8] = include_bytes!("brdf_table.bin");

/// Ours: the worst of 1024 texels is within 0.0007 of what 8192 points give.
const NUM_SAMPLES: u32 = 2048;

/// The table, row by row, from its defining integrals.
pub fn compute() -> Vec<[f32; 4]> {
    compute_with(NUM_SAMPLES)
}

/// [`compute`] with another number of samples a texel, to measure its error.
pub fn compute_with(num_samples: u32) -> Vec<[f32; 4]> {
    let last = f64::from(SIZE - 1);
    let mut table = Vec::with_capacity((SIZE * SIZE) as usize);
    for y in 0..SIZE {
        for x in 0..SIZE {
            let u = f64::from(x) / last;
            let n_dot_v = (u * u).max(f64::from(N_DOT_V_MIN));
            let roughness = f64::from(y) / last;
            let [a, b] = specular_albedo(n_dot_v, roughness, num_samples);
            let d = diffuse_albedo(n_dot_v, roughness, num_samples);
            table.push([a as f32, b as f32, d as f32, 0.0]);
        }
    }
    table
}

/// A, B and D of one n.v and perceptual roughness by this many samples: at 2048 what the table holds.
pub fn albedos(n_dot_v: f64, roughness: f64, num_samples: u32) -> [f64; 3] {
    let [a, b] = specular_albedo(n_dot_v, roughness, num_samples);
    [a, b, diffuse_albedo(n_dot_v, roughness, num_samples)]
}

/// (A, B) by sampling visible normals with spherical caps [Dupuy2023, VNDF sampling]: the estimator
/// is then F * G2 / G1, which is bounded, so few samples are enough at any roughness.
fn specular_albedo(n_dot_v: f64, roughness: f64, num_samples: u32) -> [f64; 2] {
    let alpha = roughness.max(f64::from(ROUGHNESS_MIN)).powi(2);
    let v = [(1.0 - n_dot_v * n_dot_v).sqrt(), 0.0, n_dot_v];
    let stretched = normalize([alpha * v[0], 0.0, v[2]]);
    let smith = |cos: f64| (alpha * alpha + (1.0 - alpha * alpha) * cos * cos).sqrt();
    let (mut a, mut b) = (0.0, 0.0);
    for i in 0..num_samples {
        let (u0, u1) = hammersley(i, num_samples);
        let cap = (1.0 - u1) * (1.0 + stretched[2]) - stretched[2];
        let sin = (1.0 - cap * cap).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (2.0 * PI * u0).sin_cos();
        let h = normalize([
            alpha * (sin * cos_phi + stretched[0]),
            alpha * (sin * sin_phi + stretched[1]),
            cap + stretched[2],
        ]);
        let v_dot_h = (v[0] * h[0] + v[2] * h[2]).clamp(0.0, 1.0);
        let n_dot_l = 2.0 * v_dot_h * h[2] - v[2];
        if n_dot_l <= 0.0 {
            continue;
        }
        let g1 = 2.0 * n_dot_v / (n_dot_v + smith(n_dot_v));
        let g2 = 2.0 * n_dot_v * n_dot_l / (n_dot_v * smith(n_dot_l) + n_dot_l * smith(n_dot_v));
        let fresnel = (1.0 - v_dot_h).powi(5);
        a += (1.0 - fresnel) * g2 / g1;
        b += fresnel * g2 / g1;
    }
    [a, b].map(|sum| sum / f64::from(num_samples))
}

/// D by cosine-weighted sampling.
fn diffuse_albedo(n_dot_v: f64, roughness: f64, num_samples: u32) -> f64 {
    let sin_v = (1.0 - n_dot_v * n_dot_v).sqrt();
    let sum: f64 = (0..num_samples)
        .map(|i| {
            let (u0, u1) = hammersley(i, num_samples);
            let n_dot_l = (1.0 - u1).sqrt();
            let l_dot_v = n_dot_l * n_dot_v + u1.sqrt() * sin_v * (2.0 * PI * u0).cos();
            let l_dot_h2 = 0.5 * (1.0 + l_dot_v);
            let grazing = 2.0 * roughness * l_dot_h2 - 0.5;
            let lobe = |cos: f64| 1.0 + grazing * (1.0 - cos).powi(5);
            lobe(n_dot_l) * lobe(n_dot_v)
        })
        .sum();
    sum / f64::from(num_samples)
}

/// Point `i` of `n` of the Hammersley set, centred in its stratum.
fn hammersley(i: u32, n: u32) -> (f64, f64) {
    let radical_inverse = f64::from(i.reverse_bits()) / 2f64.powi(32);
    ((f64::from(i) + 0.5) / f64::from(n), radical_inverse + 0.5 / f64::from(n))
}

fn normalize(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}
