// The lights of a style, in view space.

const LIGHT_POINT: u32 = 1u;

struct Light {
    // Directional: unit vector towards the light. Point: its place.
    position_view: vec3<f32>,
    kind: u32,
    // Linear colour times intensity.
    color: vec3<f32>,
    // Distance at which a point light ends, in scene units; 0: it has no falloff.
    range: f32,
    // Which layer of the shadow maps; negative: casts none.
    shadow: i32,
    // Share of the light that a shadow takes away.
    strength: f32,
    // Tangent of half the light's angular diameter; 0: a hard shadow.
    softness_tan: f32,
    _pad0: f32,
}

struct Lights {
    // Linear; the sum of the ambient lights.
    ambient: vec3<f32>,
    _pad0: f32,
    items: array<Light, 8>,
}

struct LightSample {
    // Unit.
    to_light: vec3<f32>,
    // Linear, falloff included, shadow not.
    radiance: vec3<f32>,
    // Share of the light that arrives, 0..1.
    visibility: f32,
    // One over the distance of a point light; 0 for a directional one.
    inverse_distance: f32,
}

// A constant of the pipeline, so that the loop over the lights unrolls.
fn light_count() -> u32 {
    return LIGHT_COUNT;
}

// Whether there is any is a constant of the pipeline, so that nothing is found in vain for it.
fn ambient_light() -> vec3<f32> {
    if !AMBIENT { return vec3<f32>(0.0); }
    return lights.ambient;
}

fn light_at(i: u32, s: Surface) -> LightSample {
    let light = lights.items[i];
    var sample: LightSample;
    sample.radiance = light.color;
    if POINT_LIGHTS && light.kind == LIGHT_POINT {
        let offset = light.position_view - s.position_view;
        let distance = max(length(offset), 1e-6);
        sample.to_light = offset / distance;
        sample.inverse_distance = 1.0 / distance;
        if light.range > 0.0 {
            // Smooth window to zero at the range [Karis2013 eq. 9, without its 1/d^2].
            let share = distance / light.range;
            let window = clamp(1.0 - share * share * share * share, 0.0, 1.0);
            sample.radiance *= window * window;
        }
    } else {
        sample.to_light = light.position_view;
        sample.inverse_distance = 0.0;
    }
    sample.visibility = 1.0;
    if SHADOWS && light.shadow >= 0 {
        sample.visibility = 1.0 - light.strength * (1.0 - shadow_light(light, s));
    }
    return sample;
}
