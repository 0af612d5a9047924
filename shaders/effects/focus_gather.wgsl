// Depth of field by circles: each pixel gathers what its neighbours scatter over it. A neighbour's light is spread evenly over its
// circle of confusion, which covers as much of the pixel's lens as the neighbour's share of that circle.
//
// What is before the focus is a field of its own, over the one of all that is sharp or behind. In its own field a pixel sees
// its neighbours as before its surface, as the surface itself, or as behind it. What is before covers what it covers, the
// surface what is left of its own, and only the rest is what lies behind: so a sharp thing neither leaks into a blurred
// background nor does that run over it, and what is blurred before it ends softly. What lies hidden behind a blurred edge is
// taken from what is seen behind it nearby.
//
// After the near and far fields of [Jimenez2014, throughout]; what is relative to the pixel's surface, so that more than two
// depths are told apart, and the areas of taps, are ours.

const PI: f32 = 3.14159265;
// Side of the tiles of `widest` and `reaching`, in pixels.
const TILE: i32 = 16;
// Half the diameter of a circle that is one pixel.
const LEAST_RADIUS_PX: f32 = 0.5;
// Radii that differ by less are of one surface, in pixels.
const SAME_PX: f32 = 0.75;
// Weight of what is seen behind a surface and does not reach the pixel.
const FILL: f32 = 1e-3;
// Least taps of a pixel.
const LEAST_TAPS: f32 = 8.0;
// Side of the square over which noise is evened out, in pixels.
const EVEN_PX: f32 = 4.0;

// A pixel's premultiplied light with the radius of its circle, below 0 before what is sharp.
struct Circle {
    color: vec4<f32>,
    radius_px: f32,
    is_seen: bool,
}

fn circle_at(at: vec2<i32>) -> Circle {
    let texel = textureLoad(circles, clamp(at, vec2<i32>(0), vec2<i32>(view.tile_size_px) - 1), 0);
    let color = vec4<f32>(unpack2x16float(texel.x), unpack2x16float(texel.y));
    return Circle(color, bitcast<f32>(texel.z), texel.w != 0u);
}

@fragment
fn find_circles(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let own = vec2<i32>(position.xy);
    let texel = textureLoad(geometry, own, 0);
    let c = textureLoad(color, own, 0);
    let blur = diameters_of(texel);
    let radius_px = 0.5 * (blur.y - blur.x);
    return vec4<u32>(pack2x16float(c.rg), pack2x16float(c.ba), bitcast<u32>(radius_px), min(texel.w, 1u));
}

// The largest radii of a tile: of what is before the focus, and of all that is seen.
@fragment
fn find_widest(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let corner = vec2<i32>(position.xy) * TILE;
    let end = min(corner + TILE, vec2<i32>(view.tile_size_px));
    var widest = vec2<f32>(0.0);
    for (var y = corner.y; y < end.y; y++) {
        for (var x = corner.x; x < end.x; x++) {
            let texel = textureLoad(circles, vec2<i32>(x, y), 0);
            let radius_px = bitcast<f32>(texel.z);
            if texel.w != 0u { widest = max(widest, vec2<f32>(-radius_px, abs(radius_px))); }
        }
    }
    return vec4<f32>(widest, 0.0, 0.0);
}

// The same of all tiles whose circles reach this one.
@fragment
fn find_reaching(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(reaching_of(vec2<i32>(position.xy), widest), 0.0, 0.0);
}

fn reaching_of(own: vec2<i32>, radii_of: texture_2d<f32>) -> vec2<f32> {
    let count = vec2<i32>(textureDimensions(radii_of));
    let low = max(own - i32(focus_params.tiles), vec2<i32>(0));
    let high = min(own + i32(focus_params.tiles), count - 1);
    var reaching = vec2<f32>(0.0);
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            let between = max(abs(vec2<i32>(x, y) - own) - 1, vec2<i32>(0)) * TILE;
            let radii = textureLoad(radii_of, vec2<i32>(x, y), 0).xy;
            reaching = max(reaching, select(vec2<f32>(0.0), radii, radii >= vec2<f32>(length(vec2<f32>(between)))));
        }
    }
    return reaching;
}

// How far from a pixel things lie that matter to it.
fn reach_px(own: vec2<i32>, circle: Circle) -> f32 {
    let reaching = textureLoad(reaching, own / TILE, 0).xy;
    return select(reaching.y, max(circle.radius_px, reaching.x), circle.is_seen);
}

// Light that covers a share of the lens.
struct Share {
    color: vec4<f32>,
    weight: f32,
}

fn added(share: Share, color: vec4<f32>, weight: f32) -> Share {
    return Share(share.color + weight * color, share.weight + weight);
}

fn mean(share: Share) -> vec4<f32> {
    return share.color / max(share.weight, 1e-9);
}

// The share of a circle's light that falls on a pixel at a distance.
fn spread_at(radius_px: f32, distance_px: f32) -> f32 {
    let radius = max(abs(radius_px), LEAST_RADIUS_PX);
    return clamp(radius - distance_px + 0.5, 0.0, 1.0) / (PI * (radius * radius + 1.0 / 12.0));
}

// The light of two fields, premultiplied: what is before the focus, with what it covers of the lens, and what is seen where that
// does not cover.
@fragment
fn gather_fields(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let own = vec2<i32>(position.xy);
    let circle = circle_at(own);
    let reach = reach_px(own, circle);
    if reach < LEAST_RADIUS_PX { return pack_fields(Fields(vec4<f32>(0.0), circle.color)); }
    let is_near = circle.radius_px < -SAME_PX;
    // In the pixel's own field, against its surface; and all of the other field.
    var before = Share(vec4<f32>(0.0), 0.0);
    var same = Share(vec4<f32>(0.0), 0.0);
    var behind = Share(vec4<f32>(0.0), 0.0);
    var beyond = Share(vec4<f32>(0.0), 0.0);
    // What of the taps a circle like the pixel's own would get: 1, but for how they lie.
    var whole = 0.0;
    // Small circles need fewer taps; so do samples of a still, which add up.
    let most = max(f32(focus_params.taps) * view.footprint_px, LEAST_TAPS);
    let taps = ceil(clamp(PI * reach * reach, LEAST_TAPS, most));
    // Circles end softly, half a pixel beyond their radius.
    let wide = reach + 0.5;
    let noise = pixel_noise(own);
    var inner = 0.0;
    for (var tap = 0.0; tap < taps; tap += 1.0) {
        // Denser near the pixel: the radius is a power of 3/4 of the share of taps, the area one of 3/2.
        let end = (tap + 1.0) / taps;
        let area = PI * wide * wide * (end * sqrt(end) - inner);
        inner = end * sqrt(end);
        let share = (tap + noise.y) / taps;
        let long = select(wide * sqrt(share * sqrt(share)), 0.0, tap == 0.0);
        let angle = 2.3999632 * tap + 2.0 * PI * noise.x;
        let off = vec2<i32>(round(long * vec2<f32>(cos(angle), sin(angle))));
        let other = circle_at(own + off);
        let distance = length(vec2<f32>(off));
        let spread = area * spread_at(other.radius_px, distance);
        whole += area * spread_at(circle.radius_px, distance);
        let nearness = 1.0 / (1.0 + distance * distance);
        let filled = spread + FILL * area * nearness * nearness;
        let deeper = other.radius_px - circle.radius_px;
        if (other.radius_px < -SAME_PX) != is_near {
            beyond = added(beyond, other.color, select(spread, filled, is_near));
        } else if (!other.is_seen && circle.is_seen) || (deeper > SAME_PX && other.is_seen) {
            behind = added(behind, other.color, select(filled, spread, is_near));
        } else if other.is_seen && (deeper < -SAME_PX || !circle.is_seen) {
            before = added(before, other.color, spread);
        } else {
            same = added(same, other.color, spread);
        }
    }
    // Each covers what it covers of what is left of the lens.
    let front = min(before.weight, 1.0);
    let own_share = min(same.weight / max(whole, 1e-9), 1.0 - front);
    let rest = 1.0 - front - own_share;
    var fields: Fields;
    if is_near {
        let back = min(behind.weight, rest);
        let near = front * mean(before) + own_share * mean(same) + back * mean(behind);
        // Where nothing else is seen, it covers all.
        fields.near = select(near, near / max(near.a, 1e-4), beyond.weight == 0.0);
        fields.far = mean(beyond);
    } else {
        fields.near = min(beyond.weight, 1.0) * mean(beyond);
        let is_all = behind.weight == 0.0 || !circle.is_seen;
        fields.far = front * mean(before) + mix(own_share, 1.0 - front, f32(is_all)) * mean(same)
            + select(rest, 0.0, is_all) * mean(behind);
    }
    return pack_fields(fields);
}

// Premultiplied light before the focus, of which the last number is what it covers, and behind it.
struct Fields {
    near: vec4<f32>,
    far: vec4<f32>,
}

fn pack_fields(fields: Fields) -> vec4<u32> {
    let near = vec2<u32>(pack2x16float(fields.near.rg), pack2x16float(fields.near.ba));
    return vec4<u32>(near, pack2x16float(fields.far.rg), pack2x16float(fields.far.ba));
}

// Fields of pixels around are one pixel's with other taps: their mean is less noisy. What is sharp stays as it is.
fn evened_fields(own: vec2<i32>) -> Fields {
    let circle = circle_at(own);
    let reach = reach_px(own, circle);
    let sharp = textureLoad(color, own, 0);
    if reach < LEAST_RADIUS_PX { return Fields(vec4<f32>(0.0), sharp); }
    let last = vec2<i32>(view.tile_size_px) - 1;
    let is_near = circle.radius_px < -SAME_PX;
    let blurred = select(reach, -circle.radius_px, is_near);
    let side = i32(max(round(min(EVEN_PX * view.footprint_px, blurred)), 1.0));
    let is_sharp = circle.is_seen && abs(circle.radius_px) < LEAST_RADIUS_PX;
    // How far its own field is blurred, and its neighbours' are like it.
    let far_reach = select(reach, abs(circle.radius_px), circle.is_seen);
    var near = vec4<f32>(0.0);
    var far = vec4<f32>(0.0);
    var fars = 0.0;
    for (var index = 0; index < side * side; index++) {
        let off = vec2<i32>(index % side, index / side) - side / 2;
        let at = clamp(own + off, vec2<i32>(0), last);
        let texel = textureLoad(fields, at, 0);
        near += vec4<f32>(unpack2x16float(texel.x), unpack2x16float(texel.y));
        if is_sharp { continue; }
        let other = textureLoad(circles, at, 0);
        let radius_px = bitcast<f32>(other.z);
        let is_blurred = other.w == 0u || abs(radius_px) >= LEAST_RADIUS_PX;
        let is_like = (radius_px < -SAME_PX) == is_near && is_blurred && f32(max(abs(off.x), abs(off.y))) <= far_reach;
        if is_like || all(off == vec2<i32>(0)) {
            far += vec4<f32>(unpack2x16float(texel.z), unpack2x16float(texel.w));
            fars += 1.0;
        }
    }
    near /= f32(side * side);
    far = select(far / max(fars, 1.0), sharp, is_sharp);
    return Fields(near, far);
}

@fragment
fn compose_fields(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let fields = evened_fields(vec2<i32>(position.xy));
    return finished(fields.near + (1.0 - fields.near.a) * fields.far);
}
