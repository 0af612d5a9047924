// Visibility of atoms: a quad around each, an exact ray cast in each of its pixels.
// Writes the id of the nearest surface and its depth; with HULL also the hull outline of the atom.

struct AtomVarying {
    @builtin(position) position: vec4<f32>,
    // View-space centre and radius.
    @location(0) @interpolate(flat) sphere: vec4<f32>,
    @location(1) @interpolate(flat) index: u32,
    // View-space centre of the hull and its radius; 0 without one.
    @location(2) @interpolate(flat) hull: vec4<f32>,
}

@vertex
fn atom_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> AtomVarying {
    let index = atom_order[instance];
    let atom = atom_at(index);
    let center = to_view(view, atom.position_world);
    var hull = vec4<f32>(0.0);
    if HULL {
        let material = materials[atom.material];
        if material.hull_px + material.hull_world > 0.0 {
            hull = hull_sphere(view, center, atom.radius, material.hull_px, material.hull_world);
        }
    }
    let sign = vec2<f32>(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    var out: AtomVarying;
    if is_left_out(atom.material) {
        out.position = vec4<f32>(2.0, 2.0, 0.5, 1.0);
        return out;
    }
    out.sphere = vec4<f32>(center, atom.radius);
    out.index = index;
    out.hull = hull;
    if hull.w > 0.0 {
        out.position = sphere_quad(view, hull.xyz, hull.w, sign);
    } else {
        out.position = sphere_quad(view, center, atom.radius, sign);
    }
    return out;
}

@fragment
fn atom_fragment(in: AtomVarying) -> VisibilityOut {
    let ray = ray_at(view, in.position.xy);
    let to_center = in.sphere.xyz - ray.origin;
    let inverse = 1.0 / dot(ray.direction, ray.direction);
    let middle = dot(to_center, ray.direction) * inverse;
    let off = to_center - middle * ray.direction;
    let left = in.sphere.w * in.sphere.w - dot(off, off);
    let half = sqrt(max(left, 0.0) * inverse);
    let t = select(middle + half, middle - half, middle - half > view.near);
    var id = make_id(KIND_ATOM, in.index);
    var depth = t;
    var seen = left >= 0.0 && t > view.near;
    if HULL {
        // Only the back faces, and only in front of the eye; behind the sphere itself they never show.
        let to_hull = in.hull.xyz - ray.origin;
        let hull_middle = dot(to_hull, ray.direction) * inverse;
        let hull_off = to_hull - hull_middle * ray.direction;
        let hull_left = in.hull.w * in.hull.w - dot(hull_off, hull_off);
        let hull_half = sqrt(max(hull_left, 0.0) * inverse);
        if !seen {
            id = make_id(KIND_ATOM_HULL, in.index);
            depth = hull_middle + hull_half;
            seen = hull_left >= 0.0 && hull_middle - hull_half > view.near;
        }
    }
    if !seen { discard; }
    return visibility_out(id, depth, -in.sphere.z);
}
