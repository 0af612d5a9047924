// Stands in for mesh_point.wgsl where nothing of a mesh is drawn.

struct MeshPoint {
    t: f32,
    part: u32,
    normal: vec3<f32>,
    facet: vec3<f32>,
    base_color: vec3<f32>,
    kappa: f32,
}

fn mesh_point(ray: Ray, index: u32) -> MeshPoint {
    return MeshPoint(0.0, 0u, vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), 0.0);
}

fn mesh_part_of(index: u32) -> u32 {
    return 0u;
}

fn mesh_normal_step(point: MeshPoint, step: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(0.0);
}

fn mesh_crease_steps(point: MeshPoint, dx: vec3<f32>, dy: vec3<f32>) -> f32 {
    return FAR_STEPS;
}

fn mesh_width_steps(point: MeshPoint, step: vec3<f32>) -> f32 {
    return 0.0;
}
