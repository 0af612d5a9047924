// Curvature from differences between pixels: of the normals of what lies beside a fragment, on the same object, in the sorted lists of
// the four pixels around it [Murray2016 §5.1], by the exact trace of their change instead of the paper's sum (ours), and without the
// paper's limits of a bucket: a list is searched by depth, where the tangent plane of the fragment goes on.

// How far from its tangent plane a surface may be one pixel on, in widths of a pixel on it as it is seen: beyond, it is another sheet.
const PLANE_REACH: f32 = 1.0;
// Normals between the vertices of a mesh change by one slope within each triangle, which tells no more than one curvature for all of it. So
// differences go over one and a half triangles, which takes the mean over some (ours): over no more than WIDEST_PX pixels to each side,
// and not across the triangle's own creases and borders.
const GRAIN_SHARE: f32 = 0.75;
// Where both sides do not bend alike within this share of what they bend, a feature of the surface ends: no mean is taken over it, and the
// triangle's own slope counts.
const SAME_BEND: f32 = 0.15;

// A list beside that of a pixel, and how far it is searched: fragments come from near to far, so that each begins where the one before
// it ended.
struct Side {
    list: LayerList,
    index: u32,
}

// The lists so many pixels before and after that of a pixel.
struct Pair {
    before: Side,
    after: Side,
    step_px: i32,
}

struct Neighbours {
    across: Pair,
    down: Pair,
}

struct Beside {
    is_there: bool,
    normal: vec3<f32>,
}

fn side_at(at: vec2<i32>, index: u32) -> Side {
    let pixel = at.y * i32(layers.width) + at.x - i32(layers.first_pixel);
    if at.x < 0 || at.x >= i32(layers.width) || pixel < 0 || pixel >= i32(layers.num_pixels) {
        return Side(LayerList(0u, 0u), 0u);
    }
    let list = list_of(u32(pixel));
    return Side(list, min(index, list.count));
}

// `along` is one pixel to the right or down. Lists that are near each other are alike: they are searched from where the last ones were.
fn pair_at(at: vec2<i32>, along: vec2<i32>, step_px: i32, index: vec2<u32>) -> Pair {
    return Pair(side_at(at - step_px * along, index.x), side_at(at + step_px * along, index.y), step_px);
}

fn neighbours_of(position_px: vec2<f32>) -> Neighbours {
    let at = vec2<i32>(position_px);
    return Neighbours(pair_at(at, vec2<i32>(1, 0), 1, vec2<u32>(0u)), pair_at(at, vec2<i32>(0, 1), 1, vec2<u32>(0u)));
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

// The change of normals to the right or down, and over how many pixels that is. Normals of what is missing are those of the fragment.
struct Change {
    normal: vec3<f32>,
    steps_px: f32,
    // Whether both sides are there and bend alike.
    is_even: bool,
}

// `slope` is the change of depth for one pixel.
fn change_over(pair: ptr<function, Pair>, at: vec2<i32>, along: vec2<i32>, step_px: i32, s: Surface, slope: f32) -> Change {
    if (*pair).step_px != step_px {
        let index = vec2<u32>((*pair).before.index, (*pair).after.index);
        *pair = pair_at(at, along, step_px, index);
    }
    let t = -s.position_view.z;
    // A steep surface bends away from its plane in proportion.
    let reach = PLANE_REACH * (pixel_world(view, t) + abs(slope));
    let step = f32(step_px);
    var before_side = (*pair).before;
    let before = beside(&before_side, s, t - step * slope, reach);
    (*pair).before = before_side;
    var after_side = (*pair).after;
    let after = beside(&after_side, s, t + step * slope, reach);
    (*pair).after = after_side;
    let change = after.normal - before.normal;
    let uneven = after.normal + before.normal - 2.0 * s.normal_view;
    return Change(
        change,
        step * f32(u32(before.is_there) + u32(after.is_there)),
        before.is_there && after.is_there && length(uneven) <= SAME_BEND * length(change),
    );
}

// The same, or the triangle's own where a wider one says nothing: `own` is the change for one sample's footprint.
fn change_along(pair: ptr<function, Pair>, at: vec2<i32>, along: vec2<i32>, step_px: i32, s: Surface, slope: f32, own: vec3<f32>) -> Change {
    let change = change_over(pair, at, along, step_px, s, slope);
    if step_px == 1 || change.is_even { return change; }
    return Change(own, view.footprint_px, true);
}

// As `kappa` of the surface, from the pixels around it. Where one of the nearest two is missing the difference is one-sided; where both
// are, nothing is known but the curvature of the surface itself.
fn kappa_of_screen(s: Surface, position_px: vec2<f32>, neighbours: ptr<function, Neighbours>) -> f32 {
    let at = vec2<i32>(position_px);
    let slope = -vec2<f32>(s.position_dx.z, s.position_dy.z) / view.footprint_px;
    let wide_px = min(GRAIN_SHARE * s.grain_steps, vec2<f32>(s.rim_steps)) * view.footprint_px;
    let step_px = vec2<i32>(clamp(wide_px, vec2<f32>(1.0), vec2<f32>(WIDEST_PX)));
    var pair = (*neighbours).across;
    let across = change_along(&pair, at, vec2<i32>(1, 0), step_px.x, s, slope.x, s.normal_dx);
    (*neighbours).across = pair;
    pair = (*neighbours).down;
    let down = change_along(&pair, at, vec2<i32>(0, 1), step_px.y, s, slope.y, s.normal_dy);
    (*neighbours).down = pair;
    if min(across.steps_px, down.steps_px) == 0.0 { return s.kappa; }
    let dx = across.normal / (across.steps_px * view.plane_from_px.x);
    let dy = down.normal / (down.steps_px * view.plane_from_px.y);
    let plane = (position_px + view.tile_origin_px) * view.plane_from_px.xy + view.plane_from_px.zw;
    return curvature_of(dx, dy, plane, -s.position_view.z);
}
