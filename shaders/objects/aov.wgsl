// Geometry of the nearest surface at each pixel's centre: view-space normal and depth, and curvature.
// Depth is -z_view in scene units, -1 where nothing is.

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var atoms: texture_2d<u32>;
@group(0) @binding(2) var connectors: texture_2d<u32>;
@group(0) @binding(6) var mesh_vertices: texture_2d<u32>;
@group(0) @binding(7) var mesh_triangles: texture_2d<u32>;
@group(0) @binding(8) var mesh_parts: texture_2d<u32>;
@group(0) @binding(9) var mesh_runs: texture_2d<u32>;
@group(0) @binding(10) var mesh_pages: texture_2d<u32>;
@group(1) @binding(0) var visibility: texture_2d<u32>;

struct Found {
    @location(0) geometry: vec4<f32>,
    @location(1) kappa: f32,
}

@fragment
fn aov_fragment(@builtin(position) position: vec4<f32>) -> Found {
    let id = textureLoad(visibility, vec2<i32>(position.xy), 0).x;
    if id == 0u || (id >> 29u) > KIND_LAST_SURFACE {
        return Found(vec4<f32>(0.0, 0.0, 0.0, -1.0), 0.0);
    }
    let s = surface_at(ray_at(view, position.xy), id);
    return Found(vec4<f32>(s.normal_view, -s.position_view.z), s.kappa);
}
