// Lines where depth jumps (silhouettes), where groups meet (boundaries) and where surfaces fold (creases).
//
// Every place between two neighbouring pixels is looked at once (`find_seeds`). What is an edge there leaves a seed: the
// kinds of line, where the edge crosses between both centres, its direction, and how deep something must lie to be covered.
// Seeds are found again by their bits, a word for 32 pixels (`gather_words`), and the pixels within reach of one by the same
// bits spread out (`spread_beside`, `spread_around`). There `draw_lines` looks through all seeds within reach: a line is the set of points within its width of an edge, its coverage
// that of the sample's own square. So widths are true between pixels, and one sample is smooth already.
// A line lies on what is behind; where nothing is, half on either side.
// Surfaces go on beyond a pixel as the sphere that touches them there: exact for atoms, to second order for connectors, and
// the plane for what is flat. Twin: tests/twins/outline.rs, function by function.

struct OutlineParams {
    // Linear RGB and opacity.
    crease_color: vec4<f32>,
    boundary_color: vec4<f32>,
    silhouette_color: vec4<f32>,
    // Of crease, boundary and silhouette: pixels plus scene units.
    width_px: vec3<f32>,
    crease_cosine: f32,
    width_world: vec3<f32>,
    // Least step of depth of a silhouette in scene units.
    depth_step: f32,
    // Width of the widest line.
    reach_px: f32,
    // Bits of a group word that differ between groups; or every object is a group.
    group_mask: u32,
    by_object: u32,
    _pad0: u32,
}

// A seed is two words: what it is, and the depth beyond which it covers. From bit 0: kinds (3), side (2), place (8),
// direction (6 + 6), radius (6), whether nothing lies behind (1).
const CREASE: u32 = 1u;
const BOUNDARY: u32 = 2u;
const SILHOUETTE: u32 = 4u;
// Which of both pixels sees what is in front.
const SIDE_BOTH: u32 = 0u;
const SIDE_FIRST: u32 = 1u;
const SIDE_SECOND: u32 = 2u;

// The place of an edge that lies somewhere between both pixels: the border of a triangle.
const PLACE_UNKNOWN: u32 = 128u;

// Farther than anything.
const NOWHERE: f32 = 1e30;
// Least step of depth in pixels: planes that are told apart by rounding alone make no edge.
const LEAST_STEP_PX: f32 = 1.0;
// Half of the longest way between two crossings of an edge with the lines through pixel centres.
const HALF_SEGMENT_PX: f32 = 0.71;
// How far in front of an edge a pixel counts as beyond it: what a direction of 6 bits and a bent edge may be off by.
const BEYOND_SLACK_PX: f32 = 0.25;
// A line of which less covers a pixel does not decide how deep that lies.
const LEAST_LINE: f32 = 0.25;
// A seed holds radii below this, in eighths of a pixel.
const MOST_RADIUS: f32 = 63.0;

// A hull outline is drawn already, and no surface.
fn is_line(texel: vec4<u32>) -> bool {
    return texel.w != 0u && bitcast<f32>(texel.x) <= 0.0;
}

// A surface beyond its own pixel, on a neighbour's ray.
struct Continued {
    // Depth there, or of the place where it turns away.
    depth: f32,
    // Whether it turns away before.
    ends: bool,
    // Share of the way at which it turns away.
    place: f32,
}

// The sphere that touches the surface at its pixel: bend |x|^2 + 2 n.x = 0, x from there. On the neighbour's ray x = e + tau d.
fn continued(g: Geometry, own: Ray, other: Ray) -> Continued {
    let e = other.origin + g.depth * other.direction - own.origin - g.depth * own.direction;
    let d = other.direction;
    let bend = g.bend_px / pixel_world(view, g.depth);
    let d_squared = dot(d, d);
    let a = bend * d_squared;
    let b = bend * dot(e, d) + dot(g.facet_view, d);
    let c = bend * dot(e, e) + 2.0 * dot(g.facet_view, e);
    let inside = b * b - a * c;
    let facing = dot(g.facet_view, own.direction);
    let before = facing * facing;
    // Along the way `inside` is a parabola of curvature -2 k from `before` to `inside`, 0 on the outline.
    let k = bend * bend * dot(e, e) * d_squared;
    let slope = inside - before + k;
    let place = 2.0 * before / max(sqrt(slope * slope + 4.0 * k * before) - slope, 1e-12);
    let ends = inside < 0.0 || b >= 0.0;
    let through = c / max(sqrt(max(inside, 0.0)) - b, 1e-12);
    let turn = max(-b, 0.0) / max(a, 1e-12);
    return Continued(g.depth + select(through, select(turn, 0.0, a <= 0.0), ends), ends, clamp(place, 0.0, 1.0));
}

// How depth changes for a pixel to the right and down.
fn depth_slope(g: Geometry, ray: Ray) -> vec2<f32> {
    let pixel = pixel_world(view, g.depth);
    return pixel * vec2<f32>(-g.facet_view.x, g.facet_view.y) / min(dot(g.facet_view, ray.direction), -1e-3);
}

// The normal of the touching sphere where the neighbour's ray meets it.
fn continued_normal(g: Geometry, own: Ray, other: Ray, depth: f32) -> vec3<f32> {
    let bend = g.bend_px / pixel_world(view, g.depth);
    let x = other.origin + depth * other.direction - own.origin - g.depth * own.direction;
    return normalize(g.normal_view + bend * x);
}

// Of two objects. Parts of meshes are groups of their own.
fn group_differs(a: Geometry, b: Geometry) -> bool {
    return outline_params.by_object != 0u || ((a.group ^ b.group) & outline_params.group_mask) != 0u
        || is_part(a.id) || is_part(b.id);
}

// The seed between a pixel and its neighbour a `step` to the right or down.
fn seed_between(a_texel: vec4<u32>, b_texel: vec4<u32>, position: vec2<f32>, step: vec2<f32>) -> vec2<u32> {
    let a = unpack_geometry(a_texel);
    let b = unpack_geometry(b_texel);
    let ray_a = ray_at(view, position);
    let ray_b = ray_at(view, position + step);
    let on_b = continued(a, ray_a, ray_b);
    let on_a = continued(b, ray_b, ray_a);
    // How far each surface, gone on, lies behind the one that is seen.
    let a_behind = on_b.depth - b.depth;
    let b_behind = on_a.depth - a.depth;
    // Signs that differ: one surface ends in front of the other. Equal signs: they meet, in a valley or on a ridge.
    var gap = 0.0;
    var a_nearer = a.depth < b.depth;
    var place = abs(b_behind) / max(abs(a_behind) + abs(b_behind), 1e-12);
    var near_depth = min(a.depth, b.depth);
    var turned = false;
    if a.id == 0u || b.id == 0u {
        gap = NOWHERE;
        a_nearer = b.id == 0u;
        turned = select(on_a.ends, on_b.ends, a_nearer);
        near_depth = select(on_a.depth, on_b.depth, a_nearer);
    } else if a.id != b.id || a.bend_px == 0.0 {
        if on_b.ends && on_a.ends {
            gap = abs(on_b.depth - on_a.depth);
            a_nearer = on_b.depth < on_a.depth;
            turned = true;
        } else if on_b.ends {
            gap = max(-a_behind, 0.0);
            a_nearer = true;
            turned = gap > 0.0;
        } else if on_a.ends {
            gap = max(-b_behind, 0.0);
            a_nearer = false;
            turned = gap > 0.0;
        } else if (a_behind > 0.0) != (b_behind > 0.0) {
            gap = min(abs(a_behind), abs(b_behind));
        }
        if turned { near_depth = select(on_a.depth, on_b.depth, a_nearer); }
    }
    let pixel = pixel_world(view, near_depth);
    let step_px = LEAST_STEP_PX * pixel;
    let step_world = max(outline_params.depth_step, step_px);
    let steps = gap > step_px;

    var kinds = 0u;
    if OUTLINE_SILHOUETTES && gap > step_world { kinds |= SILHOUETTE; }
    if OUTLINE_BOUNDARIES && gap < NOWHERE && a.id != b.id && group_differs(a, b) { kinds |= BOUNDARY; }
    if OUTLINE_CREASES && !steps {
        let normal_a = continued_normal(a, ray_a, ray_b, on_b.depth);
        let normal_b = continued_normal(b, ray_b, ray_a, on_a.depth);
        let angle = max(dot(normal_a, b.normal_view), dot(normal_b, a.normal_view));
        if angle < outline_params.crease_cosine { kinds |= CREASE; }
    }
    if kinds == 0u { return vec2<u32>(0u); }

    // The edge's normal in the picture, to what is behind.
    var across = select(-step, step, a_nearer);
    if turned {
        // Where a surface turns away, it is its own normal.
        place = select(1.0 - on_a.place, on_b.place, a_nearer);
        let normal = select(b.normal_view, a.normal_view, a_nearer);
        across = vec2<f32>(normal.x, -normal.y);
    } else if steps {
        place = 0.5;
    } else {
        // Where surfaces meet, their depths are equal along the edge.
        across = depth_slope(a, ray_a) - depth_slope(b, ray_b);
    }
    let length_squared = dot(across, across);
    across = select(step, across * inverseSqrt(length_squared), length_squared > 1e-20);

    let side = select(SIDE_BOTH, select(SIDE_SECOND, SIDE_FIRST, a_nearer), steps);
    // Halfway between what is in front and what lies a step behind it: neighbours in front stay clear.
    let depth = select(near_depth, near_depth + 0.5 * min(gap, step_world), steps);
    let bend_px = select(select(b.bend_px, a.bend_px, a_nearer), min(a.bend_px, b.bend_px), !steps);
    let radius = min(8.0 / max(bend_px, 1e-3), MOST_RADIUS);
    let direction = vec2<u32>(round(31.5 + 31.0 * across));
    let what = kinds | (side << 3u) | (u32(round(255.0 * place)) << 5u) | (direction.x << 13u) | (direction.y << 19u)
        | (u32(radius) << 25u) | (select(0u, 1u, gap >= NOWHERE) << 31u);
    return vec2<u32>(what, bitcast<u32>(depth));
}

@fragment
fn find_seeds(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let at = vec2<u32>(position.xy);
    let last = vec2<u32>(view.tile_size_px) - 1u;
    let own = textureLoad(ids, at, 0).x;
    // Most neighbours see the same object: a loop skips them, where a condition would not.
    var left = 0u;
    let right = textureLoad(ids, min(at + vec2<u32>(1u, 0u), last), 0).x;
    let below = textureLoad(ids, min(at + vec2<u32>(0u, 1u), last), 0).x;
    // Within one triangle nothing folds.
    let may_fold = OUTLINE_CREASES && own != 0u && !is_part(own);
    if own != right || (may_fold && at.x < last.x) { left |= 1u; }
    if own != below || (may_fold && at.y < last.y) { left |= 2u; }
    var seeds = vec4<u32>(0u);
    while left != 0u {
        let step = select(vec2<u32>(1u, 0u), vec2<u32>(0u, 1u), (left & 1u) == 0u);
        left &= left - 1u;
        let here = textureLoad(geometry, at, 0);
        let there = textureLoad(geometry, at + step, 0);
        // Another loop for the same reason: most objects that meet are of one group and no step apart.
        var is_edge = may_be_edge(here, there);
        while is_edge {
            is_edge = false;
            let seed = seed_between(here, there, position.xy, vec2<f32>(step));
            seeds = select(vec4<u32>(seed, seeds.zw), vec4<u32>(seeds.xy, seed), step.y == 1u);
        }
    }
    return seeds;
}

// Whether two pixels can have a line between them, as far as depths and groups tell: what lies a step behind is at least half
// a step farther a pixel beside, unless it comes forward more steeply than that.
fn may_be_edge(a: vec4<u32>, b: vec4<u32>) -> bool {
    if is_line(a) || is_line(b) { return false; }
    if OUTLINE_CREASES || a.w == 0u || b.w == 0u { return true; }
    let parts = a.w != b.w && (is_part(a.w) || is_part(b.w));
    let groups = (((a.z ^ b.z) >> 16u) & outline_params.group_mask) != 0u && !is_part(a.w) && !is_part(b.w);
    let differs = (outline_params.by_object != 0u && a.w != b.w) || groups || parts;
    let depths = vec2<f32>(bitcast<f32>(a.x), bitcast<f32>(b.x));
    return (OUTLINE_BOUNDARIES && differs) || abs(depths.x - depths.y) > 0.5 * outline_params.depth_step;
}

// The bits of 32 pixels that have seeds, and the least depth beyond which one of those covers, as bits: those of positive
// numbers are ordered as the numbers are.
@fragment
fn gather_words(@builtin(position) position: vec4<f32>) -> @location(0) vec2<u32> {
    let at = vec2<u32>(position.xy);
    let first = 32u * at.x;
    let end = min(first + 32u, u32(view.tile_size_px.x));
    var word = vec2<u32>(0u, bitcast<u32>(NOWHERE));
    for (var x = first; x < end; x++) {
        let seeds = textureLoad(outline_seeds, vec2<u32>(x, at.y), 0);
        word.x |= select(0u, 1u << (x - first), (seeds.x | seeds.z) != 0u);
        word.y = min(word.y, min(least_covered(seeds.xy), least_covered(seeds.zw)));
    }
    return word;
}

fn least_covered(seed: vec2<u32>) -> u32 {
    if seed.x == 0u { return bitcast<u32>(NOWHERE); }
    return select(seed.y, 0u, ((seed.x >> 3u) & 3u) == SIDE_BOTH);
}

// How far to the right and down of a pixel seeds matter to it: the width and half a footprint. A seed lies up to a pixel
// to the right of its own pixel, or below, so to the left and up it is one pixel more.
fn reach_px() -> i32 {
    return i32(floor(outline_params.reach_px + 0.5 * view.footprint_px));
}

// The bits of pixels that have a seed within reach in their row, and the least depth that any there covers.
@fragment
fn spread_beside(@builtin(position) position: vec4<f32>) -> @location(0) vec2<u32> {
    let at = vec2<i32>(position.xy);
    let reach = reach_px();
    let own = textureLoad(outline_words, at, 0).xy;
    var word = own.x | (own.x << 1u);
    var least = own.y;
    for (var step = 0; step < min(reach, 31); step++) { word |= (word << 1u) | (word >> 1u); }
    let words = (i32(view.tile_size_px.x) + 31) >> 5u;
    for (var x = max(at.x - ((reach + 32) >> 5u), 0); x < at.x; x++) {
        let left = textureLoad(outline_words, vec2<i32>(x, at.y), 0);
        // From the last seed there on, as far as the reach goes.
        if left.x != 0u { word |= bits_between(0, reach + 1 + i32(firstLeadingBit(left.x)) - 32 * (at.x - x)); }
        least = min(least, left.y);
    }
    for (var x = at.x + 1; x <= min(at.x + ((reach + 31) >> 5u), words - 1); x++) {
        let right = textureLoad(outline_words, vec2<i32>(x, at.y), 0);
        if right.x != 0u { word |= bits_between(i32(firstTrailingBit(right.x)) + 32 * (x - at.x) - reach, 31); }
        least = min(least, right.y);
    }
    return vec2<u32>(word, least);
}

// The bits of pixels that have a seed within reach at all, and the least depth that any there covers.
@fragment
fn spread_around(@builtin(position) position: vec4<f32>) -> @location(0) vec2<u32> {
    let at = vec2<i32>(position.xy);
    let reach = reach_px();
    var around = vec2<u32>(0u, bitcast<u32>(NOWHERE));
    for (var y = max(at.y - reach - 1, 0); y <= min(at.y + reach, i32(view.tile_size_px.y) - 1); y++) {
        let beside = textureLoad(outline_beside, vec2<i32>(at.x, y), 0);
        around = vec2<u32>(around.x | beside.x, min(around.y, beside.y));
    }
    return around;
}

// Bits from `low` to `high`, both included and cut to 0..31.
fn bits_between(low: i32, high: i32) -> u32 {
    if low > 31 || high < 0 { return 0u; }
    return (0xffffffffu << u32(max(low, 0))) & (0xffffffffu >> u32(31 - min(high, 31)));
}

// What the lines near a pixel do to it.
struct Cover {
    // Shares that crease, boundary and silhouette cover.
    crease: f32,
    boundary: f32,
    silhouette: f32,
    // Share of the pixel that its neighbour in front does not cover, and that neighbour.
    behind: f32,
    front: vec2<i32>,
    // The share of whichever line covers most, and how deep that lies; only where LEAVES_SURFACES.
    most: f32,
    depth: f32,
}

const NO_COVER: Cover = Cover(0.0, 0.0, 0.0, 1.0, vec2<i32>(0), 0.0, 0.0);

// A seed as one pixel sees it.
struct Near {
    side: u32,
    // From the edge, and that with a sign: positive beyond it.
    distance: f32,
    signed_distance: f32,
    // Whether the pixel is the one in front of the edge, and whether it is covered at all.
    in_front: bool,
    covered: bool,
    // Radius of what is outlined in pixels, and whether nothing lies behind.
    radius: f32,
    outermost: bool,
    // Scene units of a pixel at the edge.
    pixel: f32,
    // Side of the square that the line's share is of: the sample's, or the pixel where the edge may be anywhere in it.
    footprint: f32,
}

// Length of what a line from `low` to `high` and a square around `middle` have in common.
fn overlap(low: f32, high: f32, middle: f32, footprint: f32) -> f32 {
    let half = 0.5 * footprint;
    return max(min(high, middle + half) - max(low, middle - half), 0.0);
}

// Share of the sample's square that a line of one kind covers. It fades where it is as wide as what it outlines: a line of
// 2 px around radii below 4 px, the outermost below half a pixel.
fn share_of(near: Near, width_px: f32, width_world: f32) -> f32 {
    var width = width_px;
    if OUTLINE_WORLD_WIDTHS { width = min(width_px + width_world / near.pixel, outline_params.reach_px); }
    let fade_from = select(2.0 * clamp(width, 0.01, 2.0), 0.5, near.outermost);
    let fade = min(near.radius / fade_from, 1.0);
    let footprint = near.footprint;
    if near.side == SIDE_BOTH { return fade * overlap(-0.5 * width, 0.5 * width, near.distance, footprint) / footprint; }
    // In front: only what the pixel has of beyond the edge. Behind: the line's share of what is not in front.
    let middle = select(near.distance, min(near.signed_distance, 0.0), near.in_front);
    let visible = select(min(near.distance + 0.5 * footprint, footprint), footprint, near.in_front);
    return fade * overlap(0.0, width, middle, footprint) / visible;
}

// Adds what one seed covers of the pixel `own` at `depth`.
fn add_seed(before: Cover, seed: vec2<u32>, at: vec2<i32>, step: vec2<i32>, own: vec2<i32>, depth: f32) -> Cover {
    let what = seed.x;
    let covers_beyond = bitcast<f32>(seed.y);
    let place = f32((what >> 5u) & 255u) / 255.0;
    let across = normalize(vec2<f32>(f32((what >> 13u) & 63u), f32((what >> 19u) & 63u)) - 31.5);
    let from_edge = vec2<f32>(own - at) - place * vec2<f32>(step);
    var near: Near;
    near.side = (what >> 3u) & 3u;
    let is_anywhere = near.side != SIDE_BOTH && ((what >> 5u) & 255u) == PLACE_UNKNOWN;
    near.footprint = select(view.footprint_px, 1.0, is_anywhere);
    near.pixel = pixel_world(view, covers_beyond);
    near.signed_distance = dot(from_edge, across);
    let along = max(abs(dot(from_edge, vec2<f32>(-across.y, across.x))) - HALF_SEGMENT_PX, 0.0);
    near.distance = sqrt(near.signed_distance * near.signed_distance + along * along);
    let radius = (what >> 25u) & 63u;
    near.radius = select(f32(radius) / 8.0, NOWHERE, radius == 63u);
    near.outermost = (what >> 31u) != 0u;
    let first = all(own == at);
    let second = all(own == at + step);
    near.in_front = (first && near.side == SIDE_FIRST) || (second && near.side == SIDE_SECOND);
    // Where surfaces meet, both come forward from there, as steeply as 2.
    let slack = select(0.0, (2.0 * near.distance + 2.0) * near.pixel, near.side == SIDE_BOTH);
    // What goes on from the edge to the side in front is not behind it, however deep it comes to lie.
    let beyond = near.side == SIDE_BOTH || first || second || near.signed_distance > -BEYOND_SLACK_PX;
    near.covered = near.in_front || (beyond && depth > covers_beyond - slack);

    var cover = before;
    var most = 0.0;
    if OUTLINE_CREASES {
        let share = share_of(near, outline_params.width_px.x, outline_params.width_world.x);
        let drawn = select(0.0, share, near.covered && (what & CREASE) != 0u);
        cover.crease = max(cover.crease, drawn);
        most = max(most, drawn);
    }
    if OUTLINE_BOUNDARIES {
        let share = share_of(near, outline_params.width_px.y, outline_params.width_world.y);
        let drawn = select(0.0, share, near.covered && (what & BOUNDARY) != 0u);
        cover.boundary = max(cover.boundary, drawn);
        most = max(most, drawn);
    }
    if OUTLINE_SILHOUETTES {
        let share = share_of(near, outline_params.width_px.z, outline_params.width_world.z);
        let drawn = select(0.0, share, near.covered && (what & SILHOUETTE) != 0u);
        cover.silhouette = max(cover.silhouette, drawn);
        most = max(most, drawn);
    }
    if LEAVES_SURFACES && most > cover.most {
        cover.most = most;
        cover.depth = covers_beyond;
    }
    // The pixel right behind an edge shows what is in front where the edge runs through it.
    let shows = most > 0.0 && near.side != SIDE_BOTH && !near.in_front && (first || second);
    let behind = select(1.0, min(near.distance / near.footprint + 0.5, 1.0), shows);
    cover.front = select(cover.front, select(at + step, at, near.side == SIDE_FIRST), behind < cover.behind);
    cover.behind = min(cover.behind, behind);
    return cover;
}

fn over(below: vec4<f32>, color: vec4<f32>, share: f32) -> vec4<f32> {
    return mix(below, vec4<f32>(color.rgb, 1.0), share * color.a);
}

// Whether a seed can do anything to a pixel: it is none, or it lies behind, unless both touch.
fn may_cover(seed: vec2<u32>, depth: f32, touches: bool) -> bool {
    return seed.x != 0u && (touches || ((seed.x >> 3u) & 3u) == SIDE_BOTH || depth > bitcast<f32>(seed.y));
}

// What lines cover of a pixel, near seeds or not.
fn cover_at(own: vec2<i32>) -> Cover {
    let around = textureLoad(outline_around, vec2<i32>(own.x >> 5u, own.y), 0);
    var cover = NO_COVER;
    // Far from all seeds the loops below are none.
    var is_near = ((around.x >> (u32(own.x) & 31u)) & 1u) == 1u;
    while is_near {
        is_near = false;
        cover = cover_of(own, around.y);
    }
    return cover;
}

// A pixel with its lines.
fn lined(own: vec2<i32>, covered: Cover) -> vec4<f32> {
    var cover = covered;
    var result = textureLoad(color, own, 0);
    if OUTLINE_CREASES { result = over(result, outline_params.crease_color, cover.crease); }
    if OUTLINE_BOUNDARIES { result = over(result, outline_params.boundary_color, cover.boundary); }
    if OUTLINE_SILHOUETTES { result = over(result, outline_params.silhouette_color, cover.silhouette); }
    while cover.behind < 1.0 {
        result = mix(textureLoad(color, cover.front, 0), result, cover.behind);
        cover.behind = 1.0;
    }
    return result;
}

@fragment
fn draw_lines(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let own = vec2<i32>(position.xy);
    return finished(lined(own, cover_at(own)));
}

struct LinedSurface {
    @location(0) color: vec4<f32>,
    @location(1) geometry: vec4<u32>,
}

// The same, and the surfaces with lines as hull outlines are, at depths below 0.
@fragment
fn draw_lines_as_surfaces(@builtin(position) position: vec4<f32>) -> LinedSurface {
    let own = vec2<i32>(position.xy);
    let cover = cover_at(own);
    let texel = textureLoad(geometry, own, 0);
    let line = vec4<u32>(bitcast<u32>(-cover.depth), texel.yz, max(texel.w, 1u));
    // Over nothing it is all that is there; else what else is there is more, where a line covers little.
    let least = select(LEAST_LINE, 0.0, texel.w == 0u);
    return LinedSurface(finished(lined(own, cover)), select(texel, line, cover.most > least));
}

// All seeds within reach, from the pixel's own row outwards. In front of all that those cover (`least`), only the rows that can
// hold seeds of the pixel's own edges.
fn cover_of(own: vec2<i32>, least: u32) -> Cover {
    let reach = reach_px();
    let last = vec2<i32>(view.tile_size_px) - 1;
    let seen = textureLoad(geometry, own, 0);
    let depth = select(bitcast<f32>(seen.x), NOWHERE, seen.w == 0u);
    var cover = NO_COVER;
    var rows = select(2 * reach + 2, 2, bitcast<u32>(max(depth, 0.0)) <= least);
    for (var row = 0; row < rows; row++) {
        // 0, one up, one down, two up ...
        let down = ((row + 1) >> 1u) * select(-1, 1, (row & 1) == 0);
        let y = own.y + down;
        // A disc of the reach and a pixel.
        let wide = f32((reach + 1) * (reach + 1) - down * down);
        let half = i32(sqrt(wide)) + 1;
        let left = own.x - min(half, reach + 1);
        let right = own.x + min(half, reach);
        let inside = y >= 0 && y <= last.y;
        for (var tile = max(left, 0) >> 5u; tile <= select(-1, min(right, last.x) >> 5u, inside); tile++) {
            var word = textureLoad(outline_words, vec2<i32>(tile, y), 0).x;
            word &= bits_between(left - 32 * tile, right - 32 * tile);
            while word != 0u {
                let at = vec2<i32>(32 * tile + i32(firstTrailingBit(word)), y);
                word &= word - 1u;
                let seeds = textureLoad(outline_seeds, at, 0);
                let touches = all(own >= at) && all(own <= at + 1);
                var crossings = select(0u, 1u, may_cover(seeds.xy, depth, touches));
                crossings |= select(0u, 2u, may_cover(seeds.zw, depth, touches));
                while crossings != 0u {
                    let below = (crossings & 1u) == 0u;
                    crossings &= crossings - 1u;
                    let step = select(vec2<i32>(1, 0), vec2<i32>(0, 1), below);
                    cover = add_seed(cover, select(seeds.xy, seeds.zw, below), at, step, own, depth);
                }
            }
        }
        // Nothing lies over a whole silhouette; the first two rows hold the seeds of the pixel's own edges.
        if row >= 1 && cover.silhouette >= 1.0 { rows = 0; }
    }
    return cover;
}
