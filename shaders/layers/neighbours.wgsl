// Curvature from differences between pixels: of the normals of what lies beside a fragment, on the same object, in the sorted lists of
// the four pixels around it [Murray2016 §5.1], by the exact trace of their change instead of the paper's sum (ours), and without the
// paper's limits of a bucket: a list is searched by depth, where the tangent plane of the fragment goes on.

// How far from its tangent plane a surface may be one pixel on, in widths of a pixel on it as it is seen: beyond, it is another sheet.
const PLANE_REACH: f32 = 1.0;

struct Beside {
    is_there: bool,
    normal: vec3<f32>,
}

fn object_of(id: u32) -> u32 {
    if MESHES && is_part(id) { return make_id(KIND_MESH, mesh_part_of(id & INDEX_MASK)); }
    return id;
}

// The fragment of the same object in the pixel at `at`, where it is expected at depth `t`, at most `reach` from it.
fn beside(s: Surface, at: vec2<i32>, t: f32, reach: f32) -> Beside {
    let none = Beside(false, s.normal_view);
    let pixel = at.y * i32(layers.width) + at.x - i32(layers.first_pixel);
    if at.x < 0 || at.x >= i32(layers.width) || pixel < 0 || pixel >= i32(layers.num_pixels) { return none; }
    let list = list_of(u32(pixel));
    // The first that is not before all that counts.
    var low = 0u;
    var high = list.count;
    while low < high {
        let middle = (low + high) / 2u;
        if bitcast<f32>(layer_pool[list.start + middle].x) < t - reach { low = middle + 1u; } else { high = middle; }
    }
    var best = 0u;
    var nearest = reach;
    for (var index = low; index < list.count; index++) {
        let fragment = layer_pool[list.start + index];
        let apart = bitcast<f32>(fragment.x) - t;
        if apart > nearest { break; }
        if abs(apart) <= nearest && object_of(fragment.y) == s.object {
            nearest = abs(apart);
            best = fragment.y;
        }
    }
    if best == 0u { return none; }
    return Beside(true, surface_at(ray_at(view, vec2<f32>(at) + 0.5), best).normal_view);
}

// As `kappa` of the surface, from the pixels around it. Where one of two is missing the difference is one-sided; where both are, nothing
// is known but the curvature of the surface itself.
fn kappa_of_screen(s: Surface, position_px: vec2<f32>) -> f32 {
    let at = vec2<i32>(position_px);
    let t = -s.position_view.z;
    let slope = -vec2<f32>(s.position_dx.z, s.position_dy.z) / view.footprint_px;
    // A steep surface bends away from its plane in proportion.
    let reach = PLANE_REACH * (pixel_world(view, t) + abs(slope));
    let left = beside(s, at - vec2<i32>(1, 0), t - slope.x, reach.x);
    let right = beside(s, at + vec2<i32>(1, 0), t + slope.x, reach.x);
    let above = beside(s, at - vec2<i32>(0, 1), t - slope.y, reach.y);
    let below = beside(s, at + vec2<i32>(0, 1), t + slope.y, reach.y);
    let steps = vec2<f32>(
        f32(u32(left.is_there) + u32(right.is_there)),
        f32(u32(above.is_there) + u32(below.is_there)),
    );
    if any(steps == vec2<f32>(0.0)) { return s.kappa; }
    let scale = 1.0 / (steps * view.plane_from_px.xy);
    // Normals of what is missing are those of the fragment.
    let dx = (right.normal - left.normal) * scale.x;
    let dy = (below.normal - above.normal) * scale.y;
    let plane = (position_px + view.tile_origin_px) * view.plane_from_px.xy + view.plane_from_px.zw;
    return curvature_of(dx, dy, plane, t);
}
