// Visibility of connectors: a quad around each, an exact ray cast in each of its pixels.
// Writes the id of the nearest surface and its depth; with HULL also the hull outline, a truncated
// cone whose radii are enlarged at each end by that end's own pixel size.

struct ConnectorVarying {
    @builtin(position) position: vec4<f32>,
    // View-space end and the hull's radius there; 0 without one.
    @location(0) @interpolate(flat) a: vec4<f32>,
    @location(1) @interpolate(flat) b: vec4<f32>,
    @location(2) @interpolate(flat) radius: f32,
    @location(3) @interpolate(flat) index: u32,
}

// As HULL_SHARE for atoms; connectors are thin, so their line may be as wide as they are.
const CONNECTOR_HULL_SHARE: f32 = 1.0;

// The radius that moves a cylinder's outline by the hull's width at `point`: the eye sees the side
// at its distance to the axis, so that distance, not the point's own, sets the angle.
fn cylinder_hull_radius(point: vec3<f32>, axis: vec3<f32>, radius: f32, width_px: f32, width_world: f32) -> f32 {
    let wide = radius + width_world;
    if ORTHOGRAPHIC {
        return wide + min(width_px * view.pixel_view, CONNECTOR_HULL_SHARE * wide);
    }
    // Pixels across the axis at this point: its depth times the pixel, seen at the slant of the ray.
    let depth = max(-point.z, view.near);
    let toward = normalize(point);
    let across = cross(axis, toward);
    let sine = max(length(across), 0.1);
    let side = across / sine;
    // How far the picture moves for a step along `side`: its projection at this depth.
    let moved = vec2<f32>(side.x - toward.x / toward.z * side.z, side.y - toward.y / toward.z * side.z);
    // Across the projected axis only.
    let axis_moved = vec2<f32>(axis.x - toward.x / toward.z * axis.z, axis.y - toward.y / toward.z * axis.z);
    let axis_length = max(length(axis_moved), 1e-4);
    let step = abs(moved.x * axis_moved.y - moved.y * axis_moved.x) / axis_length;
    return wide + min(width_px * view.pixel_view * depth / max(step, 0.2), CONNECTOR_HULL_SHARE * wide);
}

@vertex
fn connector_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> ConnectorVarying {
    let index = connector_order[instance];
    let connector = connector_at(index);
    let a = to_view(view, connector.a_world);
    let b = to_view(view, connector.b_world);
    var hull_a = 0.0;
    var hull_b = 0.0;
    if HULL {
        let material = materials[connector.material];
        if material.hull_px + material.hull_world > 0.0 {
            let axis = normalize(b - a);
            hull_a = cylinder_hull_radius(a, axis, connector.radius, material.hull_px, material.hull_world);
            hull_b = cylinder_hull_radius(b, axis, connector.radius, material.hull_px, material.hull_world);
        }
    }
    let sign = vec2<f32>(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    var out: ConnectorVarying;
    if is_left_out(connector.material) {
        out.position = vec4<f32>(2.0, 2.0, 0.5, 1.0);
        return out;
    }
    out.a = vec4<f32>(a, hull_a);
    out.b = vec4<f32>(b, hull_b);
    out.radius = connector.radius;
    out.index = index;
    out.position = cylinder_quad(view, a, b, max(connector.radius, max(hull_a, hull_b)), sign);
    return out;
}

// Depth of the axis beside a hit: there its outline lies.
fn axis_depth(ray: Ray, t: f32, a: vec3<f32>, b: vec3<f32>) -> f32 {
    let along = b - a;
    let share = dot(ray.origin + t * ray.direction - a, along) / dot(along, along);
    return -(a.z + clamp(share, 0.0, 1.0) * along.z);
}

@fragment
fn connector_fragment(in: ConnectorVarying) -> VisibilityOut {
    let ray = ray_at(view, in.position.xy);
    let t = first_beyond(cone_span(ray, in.a.xyz, in.b.xyz, in.radius, in.radius), view.near);
    if t > 0.0 {
        return visibility_out(make_id(KIND_CONNECTOR, in.index), t, axis_depth(ray, t, in.a.xyz, in.b.xyz));
    }
    if HULL && in.a.w > 0.0 {
        let span = cone_span(ray, in.a.xyz, in.b.xyz, in.a.w, in.b.w);
        if span.x <= span.y && span.x > view.near {
            return visibility_out(make_id(KIND_CONNECTOR_HULL, in.index), span.y, span.y);
        }
    }
    discard;
    return visibility_out(0u, 1.0, 1.0);
}
