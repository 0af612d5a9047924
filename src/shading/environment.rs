//! The procedural studio that lights `basic` from all sides: a gradient, soft boxes, their irradiance.
//!
//! It lives in view space (camera at the origin, looking along -z), so highlights stay where the
//! viewer expects them when a scene turns. Mean radiance is 1: ambient intensity `a` lights a white
//! diffuse surface to about `a`. Shader: `shaders/lib/environment.wgsl`, which also says where the
//! shapes come from. Twin: `tests/twins/environment.rs`.

use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Soft boxes of an environment.
pub const NUM_LOBES: usize = 3;

/// Ours: directions in the irradiance integral; 4 times as many move no coefficient by more than 1e-4.
const NUM_DIRECTIONS: u32 = 8192;

/// A light of soft outline, infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftBox {
    /// Unit direction to its middle, view space.
    pub direction: Vec3,
    /// Direction along its width; what of it is parallel to `direction` is ignored.
    pub tangent: Vec3,
    /// Half widths along and across, as sines, 0.15..=0.5: the range in which blurring is accurate.
    pub widths: [f32; 2],
    /// Radiance of its middle, linear Rec. 709.
    pub color: Vec3,
}

/// Radiance from all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Studio {
    /// Radiance straight up.
    pub zenith: Vec3,
    /// Radiance straight down.
    pub ground: Vec3,
    /// Half width of the transition between them, as a sine, 0.2..=0.7.
    pub horizon_width: f32,
    /// The lights in it.
    pub lobes: [SoftBox; NUM_LOBES],
}

crate::gpu_struct! {
    "lib/environment.wgsl",
    /// One soft box, as `environment.wgsl` reads it.
    pub struct EnvironmentLobe {
        /// xyz: unit, to the middle of the box; w: flux factor at roughness 0.
        pub direction: [f32; 4],
        /// xyz: unit, along the box; w: width as a sine.
        pub tangent: [f32; 4],
        /// xyz: unit, across the box; w: width as a sine.
        pub bitangent: [f32; 4],
        /// rgb: peak radiance.
        pub color: [f32; 4],
    }
}

crate::gpu_struct! {
    "lib/environment.wgsl",
    /// What one roughness makes of the environment: the terms of its closed forms that no pixel changes.
    pub struct EnvironmentBlur {
        /// Of each box: falloff along and across, over 4; square of its soft edge; peak with its flux.
        pub lobes: [[f32; 4]; NUM_LOBES],
        /// Of the gradient: height = y w sqrt(x / (y'^2 y + z)).
        pub horizon: [f32; 4],
    }
}

// Constants of the blurred forms, fitted by random search to integrated GGX lobes; see environment.wgsl.
const LOBE_BLUR: f32 = 1.86;
const LOBE_KNEE: f32 = 0.072;
/// How far a blurred box reaches past 90 degrees.
const LOBE_EDGE: f32 = 0.73;
const LOBE_EDGE_FLUX: f32 = 2.08;
const HORIZON_BLUR1: f32 = 2.3;
const HORIZON_BLUR2: f32 = 2.9;
const HORIZON_FADE: f32 = 0.33;

impl EnvironmentBlur {
    /// The blur of this studio's parts by GGX of a perceptual roughness, 0..=1.
    pub fn new(studio: &Studio, roughness: f32) -> EnvironmentBlur {
        let alpha = roughness * roughness;
        let alpha2 = alpha * alpha;
        let open = 1.0 - alpha2;
        // 1 / w'^2 of a box of width w.
        let falloff = |width: f32| {
            let blur = LOBE_BLUR * alpha2 * (1.0 + width / (alpha + LOBE_KNEE * width));
            open / (open * width * width + blur)
        };
        // Flux of a box per axis, over pi: 1 for a lobe without falloff, about 4 w^2 / 3 for a narrow one.
        let flux = |falloff: f32| {
            let t = 1.0 + 0.25 * falloff;
            (1.0 + t + t * t) / (3.0 * t * t * t)
        };
        let lobe = |lobe: &SoftBox| {
            let [along, across] = lobe.widths.map(falloff);
            let edge2 = LOBE_EDGE * alpha * alpha * lobe.widths[0] * lobe.widths[1];
            let kept = (lobe.lobe().direction[3] / (flux(along) * flux(across))).sqrt();
            [0.25 * along, 0.25 * across, edge2, 0.5 * kept / (1.0 + LOBE_EDGE_FLUX * edge2)]
        };
        let width = studio.horizon_width;
        let blur = HORIZON_BLUR1 * alpha * width + HORIZON_BLUR2 * alpha2;
        EnvironmentBlur {
            lobes: std::array::from_fn(|index| lobe(&studio.lobes[index])),
            horizon: [
                open * (1.0 + width * width) + blur,
                open,
                open * width * width + blur,
                1.0 - HORIZON_FADE * alpha * width,
            ],
        }
    }
}

crate::gpu_struct! {
    "lib/environment.wgsl",
    /// What `environment.wgsl` reads.
    pub struct Environment {
        /// rgb: irradiance / pi as a polynomial of the normal: 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2.
        pub sh: [[f32; 4]; 9],
        /// rgb: radiance straight up; w: width of the horizon as a sine.
        pub zenith: [f32; 4],
        /// rgb: radiance straight down.
        pub ground: [f32; 4],
        /// The soft boxes.
        pub lobes: [EnvironmentLobe; NUM_LOBES],
    }
}

impl SoftBox {
    /// Unit vectors (to the middle, along, across).
    fn frame(&self) -> [Vec3; 3] {
        let z = self.direction.normalize_or(Vec3::Z);
        let x = self.tangent.reject_from_normalized(z).normalize_or(z.any_orthonormal_vector());
        [z, x, z.cross(x)]
    }

    fn radiance(&self, direction: Vec3) -> Vec3 {
        let [z, x, y] = self.frame().map(|axis| axis.dot(direction));
        let t = 1.0 + 0.25 * ((x / self.widths[0]).powi(2) + (y / self.widths[1]).powi(2));
        self.color * z.max(0.0) / t.powi(4)
    }

    fn lobe(&self) -> EnvironmentLobe {
        let [z, x, y] = self.frame();
        let flux = |width: f32| {
            let t = 1.0 + 0.25 / (width * width);
            (1.0 + t + t * t) / (3.0 * t * t * t)
        };
        EnvironmentLobe {
            direction: z.extend(flux(self.widths[0]) * flux(self.widths[1])).to_array(),
            tangent: x.extend(self.widths[0]).to_array(),
            bitangent: y.extend(self.widths[1]).to_array(),
            color: self.color.extend(0.0).to_array(),
        }
    }
}

impl Studio {
    /// Ours: a neutral studio. One large box above left of the camera models the form, a narrow one
    /// right and behind draws a rim that parts dark objects from a dark background, a weak one below
    /// right keeps the shadow side from closing. Chosen by eye on plastic and metal spheres.
    pub fn neutral() -> Self {
        Self::neutral_shape().with_mean_radiance(1.0)
    }

    /// The neutral studio before its brightness is set: what its blurs depend on.
    pub fn neutral_shape() -> Self {
        Self {
            zenith: Vec3::splat(0.9),
            ground: Vec3::splat(0.28),
            horizon_width: 0.4,
            lobes: [
                SoftBox {
                    direction: Vec3::new(-0.52, 0.66, 0.54),
                    tangent: Vec3::X,
                    widths: [0.34, 0.25],
                    color: Vec3::new(4.0, 3.95, 3.85),
                },
                SoftBox {
                    direction: Vec3::new(0.88, 0.20, -0.43),
                    tangent: Vec3::new(0.43, 0.0, 0.88),
                    widths: [0.16, 0.5],
                    color: Vec3::new(2.4, 2.45, 2.55),
                },
                SoftBox {
                    direction: Vec3::new(0.60, -0.45, 0.66),
                    tangent: Vec3::X,
                    widths: [0.45, 0.35],
                    color: Vec3::splat(0.5),
                },
            ],
        }
    }

    /// Radiance 1 from everywhere, for furnace tests.
    pub fn white() -> Self {
        let dark = SoftBox { direction: Vec3::Z, tangent: Vec3::X, widths: [0.5; 2], color: Vec3::ZERO };
        Self { zenith: Vec3::ONE, ground: Vec3::ONE, horizon_width: 0.5, lobes: [dark; NUM_LOBES] }
    }

    /// Radiance from unit `direction` in view space, linear Rec. 709.
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        let width2 = self.horizon_width * self.horizon_width;
        let height = direction.y * ((1.0 + width2) / (direction.y * direction.y + width2)).sqrt();
        let gradient = self.ground.lerp(self.zenith, 0.5 + 0.5 * height);
        self.lobes.iter().fold(gradient, |sum, lobe| sum + lobe.radiance(direction))
    }

    /// What the shader reads.
    pub fn uniform(&self) -> Environment {
        Environment {
            sh: self.irradiance_over_pi().map(|c| c.as_vec3().extend(0.0).to_array()),
            zenith: self.zenith.extend(self.horizon_width).to_array(),
            ground: self.ground.extend(0.0).to_array(),
            lobes: self.lobes.map(|lobe| lobe.lobe()),
        }
    }

    fn with_mean_radiance(mut self, mean: f32) -> Self {
        let sum = mean_over_sphere(|d| [self.radiance(d.as_vec3()).as_dvec3()])[0];
        let factor = mean * 3.0 / sum.element_sum() as f32;
        self.zenith *= factor;
        self.ground *= factor;
        for lobe in &mut self.lobes {
            lobe.color *= factor;
        }
        self
    }

    /// Nine coefficients of irradiance / pi: the projection onto order-2 spherical harmonics
    /// [Ramamoorthi2001, order 2], times A_l / pi = 1, 2/3, 1/4 and both basis constants.
    fn irradiance_over_pi(&self) -> [DVec3; 9] {
        let factors = {
            let quadratic = 15.0 / (16.0 * PI);
            let linear = 1.0 / (2.0 * PI);
            let zonal = 5.0 / (64.0 * PI);
            [1.0 / (4.0 * PI), linear, linear, linear, quadratic, quadratic, zonal, quadratic, quadratic / 4.0]
        };
        let moments = mean_over_sphere(|d| {
            let radiance = self.radiance(d.as_vec3()).as_dvec3();
            basis(d).map(|polynomial| radiance * polynomial)
        });
        std::array::from_fn(|i| moments[i] * (4.0 * PI * factors[i]))
    }
}

/// The polynomials behind `Environment::sh`.
fn basis(d: DVec3) -> [f64; 9] {
    let DVec3 { x, y, z } = d;
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

/// Mean over a Fibonacci spiral of directions.
fn mean_over_sphere<const N: usize>(f: impl Fn(DVec3) -> [DVec3; N]) -> [DVec3; N] {
    let golden_angle = PI * (3.0 - 5f64.sqrt());
    let mut sum = [DVec3::ZERO; N];
    for i in 0..NUM_DIRECTIONS {
        let y = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(NUM_DIRECTIONS);
        let radius = (1.0 - y * y).sqrt();
        let (sin, cos) = (golden_angle * f64::from(i)).sin_cos();
        for (total, value) in sum.iter_mut().zip(f(DVec3::new(radius * cos, y, radius * sin))) {
            *total += value;
        }
    }
    sum.map(|total| total / f64::from(NUM_DIRECTIONS))
}
