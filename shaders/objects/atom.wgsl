// Visibility of atoms: a quad around each, an exact ray cast in each of its pixels.
// Writes the id of the nearest surface and its depth; with HULL also the hull outline of the atom.

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> atoms: array<Atom>;
@group(0) @binding(3) var<storage, read> materials: array<Material>;
@group(0) @binding(4) var<storage, read> atom_order: array<u32>;

struct AtomVarying {
    @builtin(position) position: vec4<f32>,
    // View-space centre and radius.
    @location(0) @interpolate(flat) sphere: vec4<f32>,
    @location(1) @interpolate(flat) index: u32,
    // View-space centre of the hull and its radius; 0 without one.
    @location(2) @interpolate(flat) hull: vec4<f32>,
}

struct VisibilityOut {
    @location(0) id: u32,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn atom_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> AtomVarying {
    let index = atom_order[instance];
    let atom = atoms[index];
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
    let ray = ray_at(view, in.position.xy + view.jitter_px);
    let t = first_beyond(sphere_span(ray, in.sphere.xyz, in.sphere.w), view.near);
    if t > 0.0 {
        return VisibilityOut(make_id(KIND_ATOM, in.index), depth_value(view, t));
    }
    if HULL && in.hull.w > 0.0 {
        let span = sphere_span(ray, in.hull.xyz, in.hull.w);
        // Only the back faces, and only in front of the eye.
        if span.x <= span.y && span.x > view.near {
            return VisibilityOut(make_id(KIND_ATOM_HULL, in.index), depth_value(view, span.y));
        }
    }
    discard;
    return VisibilityOut(0u, 0.0);
}
