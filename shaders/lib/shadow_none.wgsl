// Stands in for shadow.wgsl where no light of the style casts shadows.

fn shadow_light(light: Light, s: Surface) -> f32 {
    return 1.0;
}
