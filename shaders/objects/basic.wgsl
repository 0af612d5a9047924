// `basic`: Disney diffuse + GGX under lights and a studio environment, then the Khronos PBR Neutral tone map.
//
// Reads lib/brdf.wgsl, lib/environment.wgsl, lib/tone_map.wgsl and the scene's surface and lights.
// Source: [Murray2016 §4.2] names the Disney BRDF and image-based lighting; the energy balance is ours (lib/brdf.wgsl).
// Units: a light of radiance 1 lights a white diffuse surface that faces it to 1.
// Limit: the environment casts no shadows; occlusion comes from `ssaoPost`.

struct BasicMaterial {
  smoothness: f32,        // 1 - perceptual roughness
  metallic: f32,
  exposure_factor: f32,   // 2^stops
  _pad0: f32,
  blur: EnvironmentBlur,  // of the environment, for this smoothness
}

// Direction in which a rough lobe sees the environment: it leans from the mirror direction r towards
// the normal [Lagarde2014, p. 69]. Their roughness is alpha: perceptual roughness in its place
// doubles the error against the full integral (mean RMS 0.09 for 0.05; 0.10 without leaning).
fn basic_dominant_direction(n: vec3<f32>, r: vec3<f32>, roughness: f32) -> vec3<f32> {
  let alpha = roughness * roughness;
  let smoothness = 1.0 - alpha;
  return normalize(mix(n, r, smoothness * (sqrt(smoothness) + alpha)));
}

// Light of all lights, linear.
fn basic_direct(s: Surface, b: BrdfSurface) -> vec3<f32> {
  var radiance = vec3(0.0);
  for (var i = 0u; i < light_count(); i++) {
    let light = light_at(i, s);
    if light.visibility > 0.0 {
      radiance += light.radiance * light.visibility * brdf_reflect(b, s.normal_view, s.to_viewer, light.to_light);
    }
  }
  return radiance;
}

// Light of the environment, linear, before `ambient_light()`.
fn basic_environment(s: Surface, b: BrdfSurface, blur: EnvironmentBlur) -> vec3<f32> {
  let r = reflect(-s.to_viewer, s.normal_view);
  let seen = basic_dominant_direction(s.normal_view, r, b.roughness);
  return b.diffuse_albedo * environment_diffuse(s.normal_view) + b.specular_albedo * environment_specular(seen, blur);
}

// Tone-mapped linear light, 0..1.
fn basic_shade(s: Surface, m: BasicMaterial) -> vec3<f32> {
  let roughness = brdf_filtered_roughness(1.0 - m.smoothness, s.normal_dx, s.normal_dy);
  let b = brdf_prepare(s.base_color, m.metallic, roughness, dot(s.normal_view, s.to_viewer));
  var radiance = basic_direct(s, b);
  let ambient = ambient_light();
  if any(ambient > vec3(0.0)) {
    radiance += ambient * basic_environment(s, b, m.blur);
  }
  return tone_map_pbr_neutral(radiance * m.exposure_factor);
}
