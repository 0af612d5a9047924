// A procedural studio, in view space, that needs no texture at any roughness.
//
// Radiance = a gradient from ground to zenith + soft boxes. Every part has a closed form for its
// GGX-prefiltered radiance, so a mirror and a matt surface cost the same.
// Reads the uniform of src/shading/environment.rs. Twin: tests/twins/environment.rs; truth: integration there.
//
// Ours: a soft box is z / (1 + (x^2/wx^2 + y^2/wy^2) / 4)^4 in its own frame, a rational likeness of
// the anisotropic spherical Gaussian z exp(-x^2/wx^2 - y^2/wy^2) of [Xu2013];
// its tails are nearer to GGX's, so it stays of one form when blurred, and it needs no exp.
// Blurring widens it, w'^2 = w^2 + c alpha^2 (1 + w / (alpha + k w)) / (1 - alpha^2), and keeps its flux.
// The constants were fitted by random search to integrated GGX lobes for w = 0.13..0.5 and roughness 0.07..1;
// what remains is <= 0.0045 RMS and <= 0.013 at worst of the box's peak.

const ENVIRONMENT_NUM_LOBES: u32 = 3u;     // environment.rs, NUM_LOBES
const ENVIRONMENT_LOBE_BLUR: f32 = 1.86;
const ENVIRONMENT_LOBE_KNEE: f32 = 0.072;
const ENVIRONMENT_LOBE_EDGE: f32 = 0.73;   // how far a blurred box reaches past 90 degrees
const ENVIRONMENT_LOBE_EDGE_FLUX: f32 = 2.08;
// The same for the gradient; <= 0.012 RMS of half its range for horizon widths 0.35..0.5.
const ENVIRONMENT_HORIZON_BLUR1: f32 = 2.3;
const ENVIRONMENT_HORIZON_BLUR2: f32 = 2.9;
const ENVIRONMENT_HORIZON_FADE: f32 = 0.33;

struct EnvironmentLobe {
  direction: vec4<f32>,   // xyz: unit, to the middle of the box; w: flux factor at roughness 0
  tangent: vec4<f32>,     // xyz: unit, along the box; w: width as a sine
  bitangent: vec4<f32>,   // xyz: unit, across the box; w: width as a sine
  color: vec4<f32>,       // rgb: peak radiance
}

struct Environment {
  sh: array<vec4<f32>, 9>,   // rgb: irradiance / pi as a polynomial of the normal
  zenith: vec4<f32>,         // rgb: radiance straight up; w: width of the horizon as a sine
  ground: vec4<f32>,         // rgb: radiance straight down
  lobes: array<EnvironmentLobe, 3>,
}


// Irradiance / pi for unit normal n: order-2 spherical harmonics [Ramamoorthi2001],
// all constants folded into the coefficients.
fn environment_diffuse(n: vec3<f32>) -> vec3<f32> {
  let constant_linear = environment.sh[0].rgb + environment.sh[1].rgb * n.y
    + environment.sh[2].rgb * n.z + environment.sh[3].rgb * n.x;
  let quadratic = environment.sh[4].rgb * (n.x * n.y) + environment.sh[5].rgb * (n.y * n.z)
    + environment.sh[6].rgb * (3.0 * n.z * n.z - 1.0) + environment.sh[7].rgb * (n.x * n.z)
    + environment.sh[8].rgb * (n.x * n.x - n.y * n.y);
  return max(constant_linear + quadratic, vec3(0.0));
}

// Flux of a box per axis, over pi: 1 for a lobe without falloff, about 4 w^2 / 3 for a narrow one.
fn environment_flux(falloff: f32) -> f32 {
  let t = 1.0 + 0.25 * falloff;
  return (1.0 + t + t * t) / (3.0 * t * t * t);
}

// 1 / w'^2 of a box of width w.
fn environment_falloff(width: f32, alpha: f32) -> f32 {
  let alpha2 = alpha * alpha;
  let open = 1.0 - alpha2;
  let blur = ENVIRONMENT_LOBE_BLUR * alpha2 * (1.0 + width / (alpha + ENVIRONMENT_LOBE_KNEE * width));
  return open / (open * width * width + blur);
}

// Share of the peak radiance of one box in direction r.
fn environment_lobe(lobe: EnvironmentLobe, r: vec3<f32>, alpha: f32) -> f32 {
  let along = environment_falloff(lobe.tangent.w, alpha);
  let across = environment_falloff(lobe.bitangent.w, alpha);
  let edge2 = ENVIRONMENT_LOBE_EDGE * alpha * alpha * lobe.tangent.w * lobe.bitangent.w;
  let flux = sqrt(lobe.direction.w / (environment_flux(along) * environment_flux(across)));
  let x = dot(r, lobe.tangent.xyz);
  let y = dot(r, lobe.bitangent.xyz);
  let z = dot(r, lobe.direction.xyz);
  let facing = 0.5 * (z + sqrt(z * z + edge2)) / (1.0 + ENVIRONMENT_LOBE_EDGE_FLUX * edge2);
  let t = 1.0 + 0.25 * (along * x * x + across * y * y);
  let t2 = t * t;
  return max(flux * facing, 0.0) / (t2 * t2);
}

// Where between ground (-1) and zenith (1) direction r looks.
fn environment_height(width: f32, up: f32, alpha: f32) -> f32 {
  let alpha2 = alpha * alpha;
  let open = 1.0 - alpha2;
  let blur = ENVIRONMENT_HORIZON_BLUR1 * alpha * width + ENVIRONMENT_HORIZON_BLUR2 * alpha2;
  let scale = (open * (1.0 + width * width) + blur) / (open * (up * up + width * width) + blur);
  return up * sqrt(scale) * (1.0 - ENVIRONMENT_HORIZON_FADE * alpha * width);
}

// Radiance around unit direction r, averaged over the GGX lobe of a viewer who looks along the normal.
fn environment_specular(r: vec3<f32>, roughness: f32) -> vec3<f32> {
  let alpha = roughness * roughness;
  let height = environment_height(environment.zenith.w, r.y, alpha);
  var radiance = mix(environment.ground.rgb, environment.zenith.rgb, 0.5 + 0.5 * height);
  for (var i = 0u; i < ENVIRONMENT_NUM_LOBES; i++) {
    radiance += environment.lobes[i].color.rgb * environment_lobe(environment.lobes[i], r, alpha);
  }
  return radiance;
}
