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
// The gradient blurs likewise: <= 0.012 RMS of half its range for horizon widths 0.35..0.5. The constants
// are those of src/shading/environment.rs, which evaluates what depends on roughness alone.

struct EnvironmentLobe {
  direction: vec4<f32>,   // xyz: unit, to the middle of the box; w: flux factor at roughness 0
  tangent: vec4<f32>,     // xyz: unit, along the box; w: width as a sine
  bitangent: vec4<f32>,   // xyz: unit, across the box; w: width as a sine
  color: vec4<f32>,       // rgb: peak radiance
}

// The blur of one roughness, computed once for each material (src/shading/environment.rs).
struct EnvironmentBlur {
  lobes: array<vec4<f32>, 3>,   // falloff along and across, over 4; square of the soft edge; peak with its flux
  horizon: vec4<f32>,           // height = y w sqrt(x / (y'^2 y + z)), as (x, y, z, w)
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

// Share of the peak radiance of one box in direction r; `blur` is its entry of EnvironmentBlur.
fn environment_lobe(lobe: EnvironmentLobe, blur: vec4<f32>, r: vec3<f32>) -> f32 {
  let x = dot(r, lobe.tangent.xyz);
  let y = dot(r, lobe.bitangent.xyz);
  let z = dot(r, lobe.direction.xyz);
  let facing = z + sqrt(z * z + blur.z);
  let t = 1.0 + blur.x * x * x + blur.y * y * y;
  let t2 = t * t;
  return max(blur.w * facing, 0.0) / (t2 * t2);
}

// Radiance around unit direction r, averaged over the GGX lobe of a viewer who looks along the normal.
fn environment_specular(r: vec3<f32>, blur: EnvironmentBlur) -> vec3<f32> {
  let height = r.y * blur.horizon.w * sqrt(blur.horizon.x / (blur.horizon.y * r.y * r.y + blur.horizon.z));
  var radiance = mix(environment.ground.rgb, environment.zenith.rgb, 0.5 + 0.5 * height);
  for (var i = 0u; i < ENVIRONMENT_NUM_LOBES; i++) {
    radiance += environment.lobes[i].color.rgb * environment_lobe(environment.lobes[i], blur.lobes[i], r);
  }
  return radiance;
}
