// A point of a triangle as a ray meets it, for shading: see lib/mesh.wgsl for where triangles lie.
//
// Of all meshes that are drawn: SHARED says whether a shape has more places than one, PLACED whether a part is placed by a matrix,
// COLORED whether colours of vertices count. What none needs is never read.

fn drawn_corners(index: u32) -> MeshCorners {
    if SHARED { return mesh_corners(index); }
    return mesh_corners_at(index, 0u);
}

fn mesh_part_of(index: u32) -> u32 {
    return drawn_corners(index).part;
}

fn mesh_material(index: u32) -> u32 {
    return object_texel(mesh_parts, 4u * drawn_corners(index).part + 3u).z & 0xffffu;
}

fn placed_point(part: MeshPart, position: vec3<f32>) -> vec3<f32> {
    if PLACED { return mesh_to_world(part, position); }
    return position;
}

fn placed_normal(part: MeshPart, packed: u32) -> vec3<f32> {
    let normal = unpack_normal(packed);
    if PLACED { return normalize(mesh_normal_to_world(part, normal)); }
    return normal;
}

// A point of a triangle, in view space.
struct MeshPoint {
    t: f32,
    part: u32,
    // Unit, interpolated between the vertices, turned to the viewer.
    normal: vec3<f32>,
    // Unit, of the triangle itself, turned to the viewer.
    facet: vec3<f32>,
    base_color: vec3<f32>,
    // Change of the normal for a step along the triangle's plane: dot with the step gives the shares of the two edges.
    share_b: vec3<f32>,
    share_c: vec3<f32>,
    normal_b: vec3<f32>,
    normal_c: vec3<f32>,
    // Shares of the second and third corner at the point.
    at: vec2<f32>,
    // As in MeshCorners.
    creases: u32,
    // Whether its normals are equal.
    is_flat: bool,
    // Sum of the principal curvatures as it is seen, negative where convex, over scene units. With CURVATURE alone.
    kappa: f32,
}

// The triangle that the index of an id names, where a ray meets it. On its border and on edges seen from the side the ray
// may round to a miss: the nearest point of the triangle is then within rounding of the surface.
fn mesh_point(ray: Ray, index: u32) -> MeshPoint {
    let corners = drawn_corners(index);
    let part = mesh_part_at(corners.part);
    let va = mesh_vertex_at(corners.vertices.x);
    let vb = mesh_vertex_at(corners.vertices.y);
    let vc = mesh_vertex_at(corners.vertices.z);
    let a = to_view(view, placed_point(part, va.position));
    let along_b = to_view(view, placed_point(part, vb.position)) - a;
    let along_c = to_view(view, placed_point(part, vc.position)) - a;
    // In units of the longer edge, so that squares of squares neither vanish nor overflow.
    let scale = 1.0 / max(max(length(along_b), length(along_c)), 1e-30);
    let b = along_b * scale;
    let c = along_c * scale;
    let across = cross(b, c);
    let area_squared = max(dot(across, across), 1e-30);
    let from_a = (ray.origin - a) * scale;
    // [Moller1997 §2]
    let facing = dot(ray.direction, across);
    let inverse = 1.0 / select(min(facing, -1e-20), max(facing, 1e-20), facing >= 0.0);
    let around = cross(from_a, ray.direction);
    var share_b = clamp(-dot(around, c) * inverse, 0.0, 1.0);
    var share_c = clamp(dot(around, b) * inverse, 0.0, 1.0);
    let sum = max(share_b + share_c, 1.0);
    share_b /= sum;
    share_c /= sum;

    var point: MeshPoint;
    point.part = corners.part;
    point.t = -(a.z + share_b * along_b.z + share_c * along_c.z);
    let to_view_normal = mat3x3<f32>(view.view_from_world[0].xyz, view.view_from_world[1].xyz, view.view_from_world[2].xyz);
    let na = to_view_normal * placed_normal(part, va.normal);
    let nb = to_view_normal * placed_normal(part, vb.normal);
    let nc = to_view_normal * placed_normal(part, vc.normal);
    let mixed = na + share_b * (nb - na) + share_c * (nc - na);
    let inverse_length = inverseSqrt(max(dot(mixed, mixed), 1e-12));
    // To the side of the triangle that is seen.
    let outwards = select(across, -across, facing > 0.0);
    point.facet = outwards * inverseSqrt(area_squared);
    let turned = select(inverse_length, -inverse_length, dot(mixed, outwards) < 0.0);
    point.normal = mixed * turned;
    // An interpolated normal may lean away where the triangle does not: it is then seen from the side.
    let away = dot(point.normal, ray.direction);
    if away > 0.0 {
        point.normal = normalize(point.normal - ray.direction * (away * 1.001 / dot(ray.direction, ray.direction)));
    }
    point.normal_b = (nb - na) * turned;
    point.normal_c = (nc - na) * turned;
    point.share_b = cross(c, across) * (scale / area_squared);
    point.share_c = cross(across, b) * (scale / area_squared);
    if CURVATURE {
        point.at = vec2<f32>(share_b, share_c);
        point.creases = corners.creases;
        let of_shape = va.kappa + share_b * (vb.kappa - va.kappa) + share_c * (vc.kappa - va.kappa);
        // A triangle whose normals are equal is flat, whatever its neighbours are.
        point.is_flat = va.normal == vb.normal && va.normal == vc.normal;
        point.kappa = select(sign(turned) * of_shape / max(part.radius, 1e-30), 0.0, point.is_flat);
    }
    point.base_color = unpack_linear(part.color);
    if COLORED && (part.color.y & 0x10000u) != 0u {
        let ca = unpack_vertex_color(va.color);
        point.base_color *= ca + share_b * (unpack_vertex_color(vb.color) - ca)
            + share_c * (unpack_vertex_color(vc.color) - ca);
    }
    return point;
}

// Change of the unit normal for a step along the triangle's plane.
fn mesh_normal_step(point: MeshPoint, step: vec3<f32>) -> vec3<f32> {
    let change = point.normal_b * dot(point.share_b, step) + point.normal_c * dot(point.share_c, step);
    return change - point.normal * dot(point.normal, change);
}

// How wide the triangle is at most along its plane, in steps: its longest line that way goes through a corner, from all of its share to none.
// 0 where it is flat.
fn mesh_width_steps(point: MeshPoint, step: vec3<f32>) -> f32 {
    if point.is_flat { return 0.0; }
    let grow = vec2<f32>(dot(point.share_b, step), dot(point.share_c, step));
    return 1.0 / max(max(max(abs(grow.x), abs(grow.y)), abs(grow.x + grow.y)), 1.0 / FAR_STEPS);
}

// How far the nearest crease of the triangle is in the picture, in steps of `dx` and `dy` along its plane.
fn mesh_crease_steps(point: MeshPoint, dx: vec3<f32>, dy: vec3<f32>) -> f32 {
    if point.creases == 0u { return FAR_STEPS; }
    // In steps shares are linear: their gradients give the places of the corners.
    let grow_b = vec2<f32>(dot(point.share_b, dx), dot(point.share_b, dy));
    let grow_c = vec2<f32>(dot(point.share_c, dx), dot(point.share_c, dy));
    let area = grow_b.x * grow_c.y - grow_b.y * grow_c.x;
    let inverse = 1.0 / select(min(area, -1e-30), max(area, 1e-30), area >= 0.0);
    let along_b = vec2<f32>(grow_c.y, -grow_c.x) * inverse;
    let along_c = vec2<f32>(-grow_b.y, grow_b.x) * inverse;
    let a = -point.at.x * along_b - point.at.y * along_c;
    let b = a + along_b;
    let c = a + along_c;
    var nearest = FAR_STEPS;
    if (point.creases & 1u) != 0u { nearest = min(nearest, segment_distance(a, b)); }
    if (point.creases & 2u) != 0u { nearest = min(nearest, segment_distance(b, c)); }
    if (point.creases & 4u) != 0u { nearest = min(nearest, segment_distance(c, a)); }
    // Of a crease beside the triangle its end counts.
    if (point.creases & 8u) != 0u { nearest = min(nearest, length(a)); }
    if (point.creases & 16u) != 0u { nearest = min(nearest, length(b)); }
    if (point.creases & 32u) != 0u { nearest = min(nearest, length(c)); }
    return nearest;
}

// Of the origin from a segment.
fn segment_distance(from_end: vec2<f32>, to_end: vec2<f32>) -> f32 {
    let along = to_end - from_end;
    let place = clamp(-dot(from_end, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
    return length(from_end + place * along);
}
