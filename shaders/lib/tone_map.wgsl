// Khronos PBR Neutral: scene light to display light, both linear, Rec. 709.
//
// Base colours below 0.8 keep hue and saturation; only highlights are compressed [PbrNeutral "PBR Neutral Specification"].
// Twin: tests/twins/basic.rs. Known answers: 0.04 is taken off (the Fresnel haze of a dielectric), 1 is never reached.

const TONE_MAP_F90: f32 = 0.04;
const TONE_MAP_START: f32 = 0.76;          // Ks = 0.8 - F90: compression starts
const TONE_MAP_DESATURATION: f32 = 0.15;   // Kd

fn tone_map_pbr_neutral(radiance: vec3<f32>) -> vec3<f32> {
  let color = max(radiance, vec3(0.0));
  let low = min(color.r, min(color.g, color.b));
  let offset = select(TONE_MAP_F90, low - low * low / (4.0 * TONE_MAP_F90), low < 2.0 * TONE_MAP_F90);
  let lifted = color - offset;
  let peak = max(lifted.r, max(lifted.g, lifted.b));
  if peak <= TONE_MAP_START {
    return lifted;
  }
  let room = 1.0 - TONE_MAP_START;
  let new_peak = 1.0 - room * room / (peak + room - TONE_MAP_START);
  let saturation = 1.0 / (TONE_MAP_DESATURATION * (peak - new_peak) + 1.0);
  return mix(vec3(new_peak), lifted * (new_peak / peak), saturation);
}
