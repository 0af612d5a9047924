// Visibility of meshes: triangles, of which hardware finds pixels and depths; the id is the triangle's.
// SHELL draws the hull outline instead: the back faces of a copy whose vertices are moved outwards, the same way at all
// vertices of one place, so that it has no gaps at hard edges.
// NUMBERED says whether the device numbers the triangles of a draw; where it does not, vertices are fetched one by one.

// An outline is never wider than this share of its part's radius: what is small in the picture would turn into a blot.
const SHELL_SHARE: f32 = 0.25;

struct MeshVarying {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) id: u32,
}

// Clip position with the depth that rays have, `behind` farther, so that triangles and ray casts meet exactly.
fn clip_with_depth(position: vec3<f32>, behind: f32) -> vec4<f32> {
    let flat_clip = clip_from_view(view, position);
    let t = -position.z;
    let parallel = view.depth_from_t.y + view.depth_from_t.z * (t + behind);
    let z = select(view.depth_from_t.x * t / max(t + behind, view.near), parallel, ORTHOGRAPHIC);
    return vec4<f32>(flat_clip.xy, select(z, view.depth_from_t.x, !ORTHOGRAPHIC && behind == 0.0), flat_clip.w);
}

@vertex
fn mesh_vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> MeshVarying {
    let run = mesh_run_at(instance);
    var vertex_index = index;
    var out: MeshVarying;
    out.id = run.first_id;
    if !NUMBERED {
        let triangle = index / 3u;
        vertex_index = object_texel(mesh_triangles, run.first_triangle + triangle)[index % 3u];
        out.id = run.first_id + triangle;
    }
    let vertex = mesh_vertex_at(vertex_index);
    let part = mesh_part_at(run.first_part + vertex.part);
    if is_left_out(part.look & 0xffffu) {
        out.position = vec4<f32>(2.0, 2.0, 0.5, 1.0);
        return out;
    }
    var position = to_view(view, mesh_to_world(part, vertex.position));
    var behind = 0.0;
    if SHELL {
        let material = materials[part.look & 0xffffu];
        let t = max(-position.z, view.near);
        let line = material.hull_px * view.pixel_view * select(t, 1.0, ORTHOGRAPHIC);
        let width = min(material.hull_world + line, SHELL_SHARE * part.radius);
        let turned = mesh_normal_to_world(part, unpack_hull(vertex.hull));
        // Without the part's scale, of which the cofactors have the square.
        let volume = abs(dot(part.row_x.xyz, cross(part.row_y.xyz, part.row_z.xyz)));
        let outwards = turned / max(pow(volume, 2.0 / 3.0), 1e-30);
        position += (view.view_from_world * vec4<f32>(outwards, 0.0)).xyz * width;
        // A step that is lower than its line is wide has none: there the shell would come through in dashes.
        behind = width;
        // A part without an outline has no shell.
        if width <= 0.0 {
            out.position = vec4<f32>(2.0, 2.0, 0.5, 1.0);
            return out;
        }
    }
    out.position = clip_with_depth(position, behind);
    return out;
}

// Depth along the view of a fragment.
fn mesh_depth(position: vec4<f32>) -> f32 {
    let parallel = (position.z - view.depth_from_t.y) / view.depth_from_t.z;
    return select(view.depth_from_t.x / position.z, parallel, ORTHOGRAPHIC);
}

fn mesh_out(position: vec4<f32>, index: u32) -> VisibilityOut {
    let t = mesh_depth(position);
    return visibility_out(make_id(select(KIND_MESH, KIND_MESH_HULL, SHELL), index), t, t);
}
