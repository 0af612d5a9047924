// Depth of field of what is transparent, each surface by its own depth: every pixel gathers from the lists of its neighbours the surfaces
// whose circles reach it, as `focus_gather.wgsl` gathers what is opaque, and lays them over each other in the order of their circles.
//
// What is blurred before the focus and what is blurred behind it are gathered apart; what is sharp comes from the pixel's own list. On each
// side surfaces fall into bins by the radii of their circles, nearest first. A surface covers as much of the lens as its circle does: all of
// it within the surface, less at its edge, which so ends softly over whatever is behind, as that is. Parts of a lens in neighbouring bins are
// beside each other, as those of one slanted surface are, until they cover all of it; else one is over the other.
//
// Opaque surfaces have their bins as well: what of the lens they cover, what is behind them does not. Their light is that of the
// opaque picture's two fields, behind as much as lies before them.
//
// Layers whose surfaces keep their depths are those of [Lee2009, throughout]; that they are gathered, and how they are ordered, is ours.

@group(2) @binding(0) var<uniform> layers: LayerBand;
@group(2) @binding(1) var<storage, read> layer_ends: array<u32>;
@group(2) @binding(2) var<storage, read> layer_runs: array<u32>;
@group(2) @binding(3) var<storage, read> layer_pool: array<vec2<u32>>;

// Bins of a side.
const BINS: u32 = 8u;
// And one more: what is behind the pixel's own surface is one bin further.
const ALL_BINS: u32 = BINS + 1u;
// Taps that are the pixel and its neighbours, each an area of one pixel.
const INNER_TAPS: f32 = 9.0;
// Radius of a disc of that area.
const INNER_PX: f32 = 1.6925688;
// What covers more of the lens than the first covers more than it did, up to all from the second on: circles that grow along a
// surface do not add up to one.
const NEARLY_ALL: vec2<f32> = vec2<f32>(0.9, 0.95);
// Least that counts as covered.
const LEAST_SHARE: f32 = 1e-4;

fn list_at(at: vec2<i32>) -> LayerList {
    return list_of(u32(at.y) * layers.width + u32(at.x));
}

// A transparent surface: its light, how much it covers, and the radius of its circle, below 0 before what is sharp.
struct Pane {
    color: vec3<f32>,
    opacity: f32,
    radius_px: f32,
}

fn signed_radius_px(depth: f32) -> f32 {
    let blur = diameters_px(depth);
    return 0.5 * (blur.y - blur.x);
}

fn pane_radius_px(place: u32) -> f32 {
    return signed_radius_px(bitcast<f32>(layer_pool[place].x));
}

fn pane_at(place: u32) -> Pane {
    let light = layer_pool[layers.capacity + place];
    let color = vec4<f32>(unpack2x16float(light.x), unpack2x16float(light.y));
    return Pane(color.rgb, color.a, pane_radius_px(place));
}

// The largest radii of transparent surfaces in a tile: before the focus, and behind it. Lists are sorted.
@fragment
fn find_glass_widest(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let corner = vec2<i32>(position.xy) * TILE;
    let end = min(corner + TILE, vec2<i32>(view.tile_size_px));
    var widest = vec2<f32>(0.0);
    for (var y = corner.y; y < end.y; y++) {
        for (var x = corner.x; x < end.x; x++) {
            let list = list_at(vec2<i32>(x, y));
            if list.count > 0u {
                let last = list.start + list.count - 1u;
                widest = max(widest, vec2<f32>(-pane_radius_px(list.start), pane_radius_px(last)));
            }
            let line = line_at(vec2<i32>(x, y));
            if line.opacity > 0.0 { widest = max(widest, vec2<f32>(-line.radius_px, line.radius_px)); }
        }
    }
    return vec4<f32>(widest, 0.0, 0.0);
}

@fragment
fn find_glass_reaching(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(reaching_of(vec2<i32>(position.xy), glass_widest), 0.0, 0.0);
}

// What lies on one side of the focus.
struct Glass {
    // Premultiplied light of what is transparent, behind nothing of that side.
    color: vec4<f32>,
    // What comes through all of it.
    open: f32,
    // What comes through that of it which is before the opaque surfaces of that side.
    before_solid: f32,
    // How wide it is blurred.
    radius_px: f32,
}

const NO_GLASS: Glass = Glass(vec4<f32>(0.0), 1.0, 1.0, 0.0);

fn pack_glass(glass: Glass) -> vec4<u32> {
    let c = glass.color;
    let through = pack2x16float(vec2<f32>(glass.open, glass.before_solid));
    return vec4<u32>(pack2x16float(c.rg), pack2x16float(c.ba), through, bitcast<u32>(glass.radius_px));
}

fn unpack_glass(texel: vec4<u32>) -> Glass {
    let through = unpack2x16float(texel.z);
    let color = vec4<f32>(unpack2x16float(texel.x), unpack2x16float(texel.y));
    return Glass(color, through.x, through.y, bitcast<f32>(texel.w));
}

struct Tap {
    off: vec2<i32>,
    distance_px: f32,
    area: f32,
}

// The pixel and its neighbours one by one, and around them taps as of what is opaque, denser near them.
fn tap_of(tap: f32, outer: f32, wide: f32, noise: vec2<f32>) -> Tap {
    if tap < INNER_TAPS {
        let off = vec2<i32>(i32(tap) % 3, i32(tap) / 3) - 1;
        return Tap(off, length(vec2<f32>(off)), 1.0);
    }
    let number = tap - INNER_TAPS;
    let range = wide - INNER_PX;
    let ends = (vec2<f32>(number, number + 1.0)) / outer;
    let radii = INNER_PX + range * sqrt(ends * sqrt(ends));
    let share = (number + noise.y) / outer;
    let long = INNER_PX + range * sqrt(share * sqrt(share));
    let angle = 2.3999632 * number + 2.0 * PI * noise.x;
    let off = vec2<i32>(round(long * vec2<f32>(cos(angle), sin(angle))));
    return Tap(off, length(vec2<f32>(off)), PI * (radii.y * radii.y - radii.x * radii.x));
}

// The bin of a radius on a side.
fn bin_of(radius_px: f32, is_near_side: bool) -> u32 {
    let most = max(select(focus_params.widest_px.y, focus_params.widest_px.x, is_near_side), LEAST_RADIUS_PX);
    let share = min(abs(radius_px) / most, 1.0);
    return min(u32(select(share, 1.0 - share, is_near_side) * f32(BINS)), BINS - 1u);
}

// Weight of a tap that stands for what is hidden from the pixel.
fn fill_of(tap: Tap) -> f32 {
    let nearness = 1.0 / (1.0 + tap.distance_px * tap.distance_px);
    return tap.area * nearness * nearness;
}

// By how much more a part of the lens counts that covers so much of it.
fn filled_up(covered: f32) -> f32 {
    let more = clamp((covered - NEARLY_ALL.x) / (NEARLY_ALL.y - NEARLY_ALL.x), 0.0, 1.0);
    return mix(covered, 1.0, more) / max(covered, LEAST_SHARE);
}

// One side of the focus, as far as `reach` pixels around.
fn gather_side(own: vec2<i32>, is_near_side: bool, reach: f32) -> Glass {
    let circle = circle_at(own);
    let is_near = circle.radius_px < -SAME_PX && circle.is_seen;
    let last = vec2<i32>(view.tile_size_px) - 1;
    let near_solid = unpack2x16float(textureLoad(fields, own, 0).y).y;
    // The pixel's own surface is of this side, and hides what is behind it; one before the focus hides nothing behind it where its
    // field does not cover.
    let has_own = circle.is_seen && is_near == is_near_side;
    let fills = is_near && !is_near_side;
    let own_bin = select(ALL_BINS, bin_of(circle.radius_px, is_near_side), has_own);

    let most = max(f32(focus_params.taps) * view.footprint_px, LEAST_TAPS);
    let wide = max(reach + 0.5, INNER_PX);
    let outer = select(0.0, ceil(clamp(PI * wide * wide - INNER_TAPS, LEAST_TAPS, most)), wide > INNER_PX);
    let taps = INNER_TAPS + outer;
    let noise = pixel_noise(own);

    // Of each bin premultiplied light; what the surfaces cover and that times their radii, and the same of opaque ones.
    var colors: array<vec4<f32>, ALL_BINS>;
    var weights: array<vec4<f32>, ALL_BINS>;
    for (var tap = 0.0; tap < taps; tap += 1.0) {
        let t = tap_of(tap, outer, wide, noise);
        let at = clamp(own + t.off, vec2<i32>(0), last);
        let solid = circle_at(at);
        if solid.is_seen && (solid.radius_px < -SAME_PX) == is_near_side {
            let spread = t.area * spread_at(solid.radius_px, t.distance_px);
            if spread > 0.0 {
                let is_behind = has_own && solid.radius_px > circle.radius_px + SAME_PX;
                let found = bin_of(solid.radius_px, is_near_side);
                let bin = select(select(found, min(found, own_bin), has_own), found + 1u, is_behind);
                weights[bin] += vec4<f32>(0.0, 0.0, spread, spread * solid.radius_px);
            }
        }
        let list = list_at(at);
        var bin_before = ALL_BINS;
        var open = 0.0;
        var pane = line_at(at);
        var place = list.start;
        let end = list.start + list.count;
        var is_line = pane.opacity > 0.0;
        loop {
            if !is_line {
                if place >= end { break; }
                pane = pane_at(place);
                place += 1u;
            }
            is_line = false;
            let is_sharp = abs(pane.radius_px) < LEAST_RADIUS_PX;
            if is_near_side && pane.radius_px > -LEAST_RADIUS_PX { break; }
            if !is_near_side && (pane.radius_px < -LEAST_RADIUS_PX || (is_sharp && !fills)) { continue; }
            let is_behind = has_own && pane.radius_px > circle.radius_px + SAME_PX;
            let bin = select(bin_of(pane.radius_px, is_near_side), 0u, is_sharp)
                + select(0u, 1u, is_behind || (fills && !is_sharp));
            // Surfaces of one list in one bin are spread as the first of them: what they cover is one number.
            if bin != bin_before {
                open = t.area * spread_at(pane.radius_px, t.distance_px);
                if is_sharp { open = fill_of(t); }
                weights[bin] += vec4<f32>(open, open * pane.radius_px, 0.0, 0.0);
            }
            bin_before = bin;
            colors[bin] += open * pane.opacity * vec4<f32>(pane.color, 1.0);
            open *= 1.0 - pane.opacity;
        }
    }

    // What such circles would get of all taps that can see them, or of all taps.
    var solid_sum = 0.0;
    for (var bin = 0u; bin < ALL_BINS; bin++) {
        let w = weights[bin];
        if w.x + w.z == 0.0 { continue; }
        let fills_bin = fills && bin == 0u;
        let radii = w.yw / max(w.xz, vec2<f32>(1e-9));
        var whole = vec2<f32>(0.0);
        for (var tap = 0.0; tap < taps; tap += 1.0) {
            let t = tap_of(tap, outer, wide, noise);
            let solid = circle_at(own + t.off);
            let is_hidden = solid.is_seen && solid.radius_px < radii.x - SAME_PX;
            let spread = t.area * vec2<f32>(spread_at(radii.x, t.distance_px), spread_at(radii.y, t.distance_px));
            whole += vec2<f32>(select(select(spread.x, fill_of(t), fills_bin), 0.0, is_hidden), spread.y);
        }
        let share = min(w.x / max(whole.x, 1e-9), 1.0);
        colors[bin] *= select(0.0, share / max(w.x, 1e-9), w.x > 0.0);
        let solid_share = min(w.z / max(whole.y, 1e-9), 1.0 - solid_sum);
        solid_sum += solid_share;
        weights[bin] = vec4<f32>(share, radii.x, solid_share, 0.0);
    }

    // Before the focus opaque surfaces cover what their field says.
    let solid_scale = select(1.0, near_solid / max(solid_sum, 1e-9), is_near_side);
    var glass = NO_GLASS;
    // What comes through all that covered the whole lens; what covers a part of it, and how large a part.
    var through = 1.0;
    var part = 0.0;
    var covered = 0.0;
    var light = vec4<f32>(0.0);
    var lens = 1.0;
    var solid_light = 0.0;
    var radius = vec2<f32>(0.0);
    for (var bin = 0u; bin < ALL_BINS; bin++) {
        let share = weights[bin].x;
        let color = colors[bin];
        if share > LEAST_SHARE {
            let first = min(share, 1.0 - covered) / share;
            light += lens * first * color;
            part += first * color.a;
            covered += share * first;
            if first < 1.0 {
                glass.color += through * light;
                through *= 1.0 - part;
                part = (1.0 - first) * color.a;
                covered = (1.0 - first) * share;
                light = lens * (1.0 - first) * color;
            }
            radius += color.a * vec2<f32>(abs(weights[bin].y), 1.0);
        } else {
            glass.color += through * filled_up(covered) * light;
            through *= 1.0 - filled_up(covered) * part;
            light = vec4<f32>(0.0);
            part = 0.0;
            covered = 0.0;
        }
        let solid = solid_scale * weights[bin].z;
        solid_light += solid * through * (1.0 - filled_up(covered) * part);
        lens = max(lens - solid, 0.0);
    }
    glass.color += through * filled_up(covered) * light;
    glass.open = through * (1.0 - filled_up(covered) * part);
    if is_near_side {
        glass.before_solid = select(glass.open, solid_light / max(near_solid, 1e-9), solid_sum > LEAST_SHARE && near_solid > LEAST_SHARE);
    } else {
        glass.before_solid = solid_light + lens * glass.open;
    }
    glass.before_solid = clamp(glass.before_solid, 0.0, 1.0);
    glass.radius_px = radius.x / max(radius.y, 1e-9);
    return glass;
}

@fragment
fn gather_near_glass(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let own = vec2<i32>(position.xy);
    let reach = textureLoad(glass_reaching, own / TILE, 0).x;
    if reach < LEAST_RADIUS_PX { return pack_glass(NO_GLASS); }
    return pack_glass(gather_side(own, true, reach));
}

@fragment
fn gather_far_glass(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    let own = vec2<i32>(position.xy);
    var reach = textureLoad(glass_reaching, own / TILE, 0).y;
    let circle = circle_at(own);
    // Behind the soft edge of what is before the focus.
    let near_solid = unpack2x16float(textureLoad(fields, own, 0).y).y;
    if circle.is_seen && circle.radius_px < -SAME_PX && near_solid < 0.999 { reach = max(reach, -circle.radius_px); }
    if reach < LEAST_RADIUS_PX { return pack_glass(NO_GLASS); }
    return pack_glass(gather_side(own, false, reach));
}

fn added_glass(a: Glass, b: Glass) -> Glass {
    return Glass(a.color + b.color, a.open + b.open, a.before_solid + b.before_solid, a.radius_px);
}

// The mean of a side around a pixel, as of the fields: of what is behind the focus only where the surface is like the pixel's.
fn evened_side(own: vec2<i32>, is_near_side: bool) -> Glass {
    let circle = circle_at(own);
    let is_near = circle.radius_px < -SAME_PX;
    let last = vec2<i32>(view.tile_size_px) - 1;
    let radius_px = unpack_glass(select(textureLoad(far_glass, own, 0), textureLoad(near_glass, own, 0), is_near_side)).radius_px;
    let side = i32(max(round(min(EVEN_PX * view.footprint_px, radius_px)), 1.0));
    var sum = Glass(vec4<f32>(0.0), 0.0, 0.0, radius_px);
    var count = 0.0;
    for (var index = 0; index < side * side; index++) {
        let off = vec2<i32>(index % side, index / side) - side / 2;
        let at = clamp(own + off, vec2<i32>(0), last);
        let other = circle_at(at);
        let is_like = other.is_seen == circle.is_seen && (other.radius_px < -SAME_PX) == is_near
            && abs(other.radius_px - circle.radius_px) <= max(SAME_PX, 0.25 * abs(circle.radius_px));
        if is_near_side || is_like {
            let texel = select(textureLoad(far_glass, at, 0), textureLoad(near_glass, at, 0), is_near_side);
            sum = added_glass(sum, unpack_glass(texel));
            count += 1.0;
        }
    }
    let share = 1.0 / max(count, 1.0);
    return Glass(share * sum.color, share * sum.open, share * sum.before_solid, radius_px);
}

// What is before the focus, what is sharp, and what is behind, each over the next.
@fragment
fn compose_glass(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let own = vec2<i32>(position.xy);
    let solid = evened_fields(own);
    let near = evened_side(own, true);
    let far = evened_side(own, false);
    var result = far.color + far.before_solid * solid.far;
    // Sharp surfaces of the pixel itself.
    let list = list_at(own);
    var sharp = vec4<f32>(0.0);
    let line = line_at(own);
    if line.opacity > 0.0 && abs(line.radius_px) < LEAST_RADIUS_PX { sharp = line.opacity * vec4<f32>(line.color, 1.0); }
    for (var place = list.start; place < list.start + list.count; place++) {
        let pane = pane_at(place);
        if abs(pane.radius_px) < LEAST_RADIUS_PX { sharp += (1.0 - sharp.a) * pane.opacity * vec4<f32>(pane.color, 1.0); }
    }
    result = sharp + (1.0 - sharp.a) * result;
    result = near.color + near.before_solid * solid.near + (1.0 - solid.near.a) * near.open * result;
    return finished(result);
}

// The diameter of the circle of what each pixel shows first, -1 where that is a line or nothing.
@fragment
fn glass_aov(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let seen = first_seen(vec2<i32>(position.xy));
    let blur = diameters_px(seen.x);
    return vec4<f32>(select(-1.0, blur.x + blur.y, seen.y > 0.0 && seen.x > 0.0), 0.0, 0.0, 0.0);
}
