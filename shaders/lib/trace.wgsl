// Curvature from the change of normals between pixels.

// k1 + k2 of the surface whose normals change by `dx` for a step of 1 to the right in the plane of rays and by `dy` upwards: the
// trace of the change of the normal along the surface, in units of the scene (ours).
fn curvature_of(dx: vec3<f32>, dy: vec3<f32>, plane: vec2<f32>, t: f32) -> f32 {
    if ORTHOGRAPHIC { return -(dx.x + dy.y); }
    return -(dx.x + dy.y + plane.x * dx.z + plane.y * dy.z) / t;
}
