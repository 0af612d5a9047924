// Curvature from differences between pixels: of the normals of what lies beside a fragment, on the same object, in the sorted lists of
// the four pixels around it [Murray2016 §5.1], by the exact trace of their change instead of the paper's sum (ours), and without the
// paper's limits of a bucket: a list is searched by depth, where the tangent plane of the fragment goes on.

// How far from its tangent plane a surface may be one pixel on, in widths of a pixel on it as it is seen: beyond, it is another sheet.
const PLANE_REACH: f32 = 1.0;

// A list beside that of a pixel, and how far it is searched: fragments come from near to far, so that each begins where the one before
// it ended.
struct Side {
    list: LayerList,
    index: u32,
}

struct Neighbours {
    left: Side,
    right: Side,
    above: Side,
    below: Side,
}

struct Beside {
    is_there: bool,
    normal: vec3<f32>,
}

fn side_at(at: vec2<i32>) -> Side {
    let pixel = at.y * i32(layers.width) + at.x - i32(layers.first_pixel);
    if at.x < 0 || at.x >= i32(layers.width) || pixel < 0 || pixel >= i32(layers.num_pixels) {
        return Side(LayerList(0u, 0u), 0u);
    }
    return Side(list_of(u32(pixel)), 0u);
}

fn neighbours_of(position_px: vec2<f32>) -> Neighbours {
    let at = vec2<i32>(position_px);
    return Neighbours(
        side_at(at - vec2<i32>(1, 0)), side_at(at + vec2<i32>(1, 0)),
        side_at(at - vec2<i32>(0, 1)), side_at(at + vec2<i32>(0, 1)),
    );
}

// The fragment of the same object in a list beside, where it is expected at depth `t`, at most `reach` from it.
fn beside(side: ptr<function, Side>, s: Surface, t: f32, reach: f32) -> Beside {
    let list = (*side).list;
    // The first that is not before all that counts.
    var low = (*side).index;
    while low < list.count && bitcast<f32>(layer_pool[list.start + low].x) < t - reach { low++; }
    while low > 0u && bitcast<f32>(layer_pool[list.start + low - 1u].x) >= t - reach { low--; }
    (*side).index = low;
    let object = mark_of_object(s.object);
    var best = vec2<u32>(0u);
    var is_there = false;
    var nearest = reach;
    for (var index = low; index < list.count; index++) {
        let apart = bitcast<f32>(layer_pool[list.start + index].x) - t;
        if apart > nearest { break; }
        let mark = layer_pool[mark_place(list.start + index)];
        if abs(apart) <= nearest && object_of_mark(mark) == object {
            nearest = abs(apart);
            best = mark;
            is_there = true;
        }
    }
    return Beside(is_there, select(s.normal_view, normal_of_mark(best), is_there));
}

// As `kappa` of the surface, from the pixels around it. Where one of two is missing the difference is one-sided; where both are, nothing
// is known but the curvature of the surface itself.
fn kappa_of_screen(s: Surface, position_px: vec2<f32>, neighbours: ptr<function, Neighbours>) -> f32 {
    let t = -s.position_view.z;
    let slope = -vec2<f32>(s.position_dx.z, s.position_dy.z) / view.footprint_px;
    // A steep surface bends away from its plane in proportion.
    let reach = PLANE_REACH * (pixel_world(view, t) + abs(slope));
    var left_side = (*neighbours).left;
    let left = beside(&left_side, s, t - slope.x, reach.x);
    (*neighbours).left = left_side;
    var right_side = (*neighbours).right;
    let right = beside(&right_side, s, t + slope.x, reach.x);
    (*neighbours).right = right_side;
    var above_side = (*neighbours).above;
    let above = beside(&above_side, s, t - slope.y, reach.y);
    (*neighbours).above = above_side;
    var below_side = (*neighbours).below;
    let below = beside(&below_side, s, t + slope.y, reach.y);
    (*neighbours).below = below_side;
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
