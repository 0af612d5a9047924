// The `basic` BRDF: GGX specular + Disney diffuse, so balanced that a white surface reflects all light.
//
// Reads `brdf_table` (src/shading/brdf_table.rs). Twin: tests/twins/brdf.rs, function by function.
// The per-pixel part is `brdf_prepare`; `brdf_reflect` is what remains for each light.
// Not reciprocal, by choice: the multiple-scattering gain of [Turquin2019] and the division by the
// diffuse albedo both depend on n.v alone; that makes the furnace exact for every viewer.


const BRDF_TABLE_LAST: f32 = 31.0;
const BRDF_ROUGHNESS_MIN: f32 = 0.045;   // brdf_table.rs, ROUGHNESS_MIN
const BRDF_N_DOT_V_MIN: f32 = 1e-4;      // brdf_table.rs, N_DOT_V_MIN
// Reflectance at normal incidence of index 1.5, the usual dielectric [Filament].
const BRDF_F0_DIELECTRIC: f32 = 0.04;
// Pixel footprint and its clamp [Tokuyoshi2021].
const BRDF_PIXEL_VARIANCE: f32 = 0.15915494;
const BRDF_KERNEL_MAX: f32 = 0.18;

// What one pixel's material and viewer give every light.
struct BrdfSurface {
  n_dot_v: f32,
  roughness: f32,               // perceptual, after filtering
  alpha2: f32,
  smith_v: f32,
  schlick_v: f32,               // (1 - n.v)^5
  f0: vec3<f32>,
  specular_gain: vec3<f32>,     // multiple scattering, on the single-scattering lobe
  specular_albedo: vec3<f32>,   // share of a white environment that the specular term reflects
  diffuse_gain: vec3<f32>,      // on the raw Disney diffuse term
  diffuse_albedo: vec3<f32>,    // share that the diffuse term reflects
}

// x^5 for Schlick's Fresnel and the Disney diffuse term.
fn brdf_pow5(x: f32) -> f32 {
  let x2 = x * x;
  return x2 * x2 * x;
}

// pi * D of GGX [Walter2007, eq. 33]. `sin2_n_h` = 1 - (n.h)^2, taken from a cross product:
// 1 - (n.h)^2 itself has no digits left in f32 where a smooth surface needs them.
fn brdf_distribution_pi(alpha2: f32, sin2_n_h: f32) -> f32 {
  let d = sin2_n_h + alpha2 * (1.0 - sin2_n_h);
  return alpha2 / (d * d);
}

// The square root of Smith's Lambda for GGX, times n.x.
fn brdf_smith(alpha2: f32, n_dot_x: f32) -> f32 {
  return sqrt(n_dot_x * n_dot_x * (1.0 - alpha2) + alpha2);
}

// G / (4 n.l n.v), height-correlated [Heitz2014, eq. 99].
fn brdf_visibility(n_dot_l: f32, n_dot_v: f32, smith_l: f32, smith_v: f32) -> f32 {
  return 0.5 / (n_dot_l * smith_v + n_dot_v * smith_l);
}

// Schlick's Fresnel term [Schlick1994].
fn brdf_fresnel(f0: vec3<f32>, l_dot_h: f32) -> vec3<f32> {
  return f0 + (vec3(1.0) - f0) * brdf_pow5(1.0 - l_dot_h);
}

// pi * f of the Disney diffuse term for base colour 1 [Burley2012 §5.3]: FD90 = 0.5 + 2 roughness (l.h)^2.
fn brdf_disney_diffuse(roughness: f32, l_dot_h2: f32, schlick_l: f32, schlick_v: f32) -> f32 {
  let grazing = 2.0 * roughness * l_dot_h2 - 0.5;
  return (1.0 + grazing * schlick_l) * (1.0 + grazing * schlick_v);
}

// (A, B, D) at n.v and perceptual roughness, bilinear.
fn brdf_albedos(n_dot_v: f32, roughness: f32) -> vec3<f32> {
  let texel = clamp(vec2(sqrt(n_dot_v), roughness), vec2(0.0), vec2(1.0)) * BRDF_TABLE_LAST;
  let low = min(floor(texel), vec2(BRDF_TABLE_LAST - 1.0));
  let part = texel - low;
  let at = vec2<i32>(low);
  let row0 = mix(textureLoad(brdf_table, at, 0), textureLoad(brdf_table, at + vec2(1, 0), 0), part.x);
  let row1 = mix(textureLoad(brdf_table, at + vec2(0, 1), 0), textureLoad(brdf_table, at + vec2(1, 1), 0), part.x);
  return mix(row0, row1, part.y).xyz;
}

// Perceptual roughness widened by how much the normal turns within a pixel, so that small glossy
// atoms neither sparkle nor lose their highlight [Tokuyoshi2021]. Zero derivatives change nothing.
fn brdf_filtered_roughness(roughness: f32, normal_dx: vec3<f32>, normal_dy: vec3<f32>) -> f32 {
  let alpha = roughness * roughness;
  let turn = dot(normal_dx, normal_dx) + dot(normal_dy, normal_dy);
  let kernel = min(2.0 * BRDF_PIXEL_VARIANCE * turn, BRDF_KERNEL_MAX);
  return sqrt(sqrt(min(alpha * alpha + kernel, 1.0)));
}

// Share of a white environment that GGX reflects, multiple scattering included: the single-scattering
// share F0 A + B times 1 + F0 (1/E - 1), where E = A + B [Turquin2019, eqs. 14, 16].
fn brdf_specular_albedo(f0: vec3<f32>, albedos: vec3<f32>) -> vec3<f32> {
  return (f0 * albedos.x + albedos.y) * (1.0 + f0 * (1.0 / (albedos.x + albedos.y) - 1.0));
}

// Per-pixel terms. What the dielectric coat reflects never reaches the diffuse base, so white plastic
// reflects coat + (1 - coat) = 1 [Kulla2017]. `metallic` blends the albedos of plastic and metal, not
// F0 inside them, in which they are quadratic: a white surface reflects 1 at any `metallic`.
fn brdf_prepare(base_color: vec3<f32>, metallic: f32, roughness: f32, n_dot_v: f32) -> BrdfSurface {
  let r = clamp(roughness, BRDF_ROUGHNESS_MIN, 1.0);
  let v = clamp(n_dot_v, BRDF_N_DOT_V_MIN, 1.0);
  let albedos = brdf_albedos(v, r);
  var b: BrdfSurface;
  b.n_dot_v = v;
  b.roughness = r;
  b.alpha2 = r * r * r * r;
  b.smith_v = brdf_smith(b.alpha2, v);
  b.schlick_v = brdf_pow5(1.0 - v);
  b.f0 = mix(vec3(BRDF_F0_DIELECTRIC), base_color, metallic);
  let coat = brdf_specular_albedo(vec3(BRDF_F0_DIELECTRIC), albedos).x;
  b.specular_albedo = mix(vec3(coat), brdf_specular_albedo(base_color, albedos), metallic);
  b.specular_gain = b.specular_albedo / max(b.f0 * albedos.x + albedos.y, vec3(1e-6));
  b.diffuse_albedo = base_color * ((1.0 - metallic) * (1.0 - coat));
  b.diffuse_gain = b.diffuse_albedo / albedos.z;
  return b;
}

// pi * f * n.l: radiance for light of radiance 1 (1 on a white diffuse surface that faces it).
fn brdf_reflect(b: BrdfSurface, n: vec3<f32>, to_viewer: vec3<f32>, to_light: vec3<f32>) -> vec3<f32> {
  let n_dot_l = min(dot(n, to_light), 1.0);
  if n_dot_l <= 0.0 {
    return vec3(0.0);
  }
  // |l + v|^2 = 2 + 2 l.v = 4 (l.h)^2, so h itself need not be normalised.
  let half = to_light + to_viewer;
  let half2 = max(dot(half, half), 1e-8);
  let l_dot_h2 = min(0.25 * half2, 1.0);
  let across = cross(n, half);
  let sin2_n_h = min(dot(across, across) / half2, 1.0);
  let smith_l = brdf_smith(b.alpha2, n_dot_l);
  let specular = brdf_distribution_pi(b.alpha2, sin2_n_h) * brdf_visibility(n_dot_l, b.n_dot_v, smith_l, b.smith_v);
  let diffuse = brdf_disney_diffuse(b.roughness, l_dot_h2, brdf_pow5(1.0 - n_dot_l), b.schlick_v);
  return n_dot_l * (b.diffuse_gain * diffuse + b.specular_gain * brdf_fresnel(b.f0, sqrt(l_dot_h2)) * specular);
}
