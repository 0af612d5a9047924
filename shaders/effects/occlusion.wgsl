// Ambient occlusion in screen space: the share of cosine-weighted directions in which something lies within a radius.
//
// OCCLUSION_HORIZONS: directions are gathered in slices through the line of sight [Jimenez2016, throughout]. Each tap is a piece of the
// scene from its front to its back, cut to the sphere of the radius; the directions that it covers are bits of a word
// [Therrien2023, throughout]. Bits stand for equal shares of cosine-weighted light, so that counting them is the integral (ours), and the
// back of a sphere or cylinder is where it is (ours): with OCCLUSION_THIN thin things let light pass behind them.
//
// Otherwise: points around the surface are compared with depths [Prost2016 §4.2]. Mended: they lie on the normal's side; only what
// lies within the radius counts, so that far things cast no halo; points outside the picture are left out. OCCLUSION_PUBLISHED
// leaves the mends out, OCCLUSION_ROTATED turns the points by a matrix [Engel2009, throughout] instead of mirroring them: for measurements.
//
// OCCLUSION_COARSE: horizons are found for one pixel of a square of 2x2, and every pixel takes the mean of those around it that lie on
// its plane; where none does, it finds its own (ours). OCCLUSION_FINE leaves that out, for measurements.
//
// OCCLUSION_PICKS: only what is picked is darkened; what is not still darkens others.

struct OcclusionParams {
    // Scene units within which things count.
    radius: f32,
    // Light is multiplied by 1 - intensity times occlusion.
    intensity: f32,
    // Points around the surface.
    samples: u32,
    // Slices, and taps to each side of them.
    slices: u32,
    steps: u32,
    // Side of the square over which noise is evened out, in pixels.
    blur: u32,
    // Farthest tap in pixels.
    reach_px: f32,
    // The bit of what is picked: see lib/picks.wgsl.
    pick_bits: u32,
}

// One of so many pixels, across and down, finds horizons.
const STRIDE: i32 = select(1, 2, OCCLUSION_COARSE && !OCCLUSION_FINE);

const PI: f32 = 3.14159265;
// Stands for occlusion where nothing is to be darkened.
const NOT_PICKED: f32 = -1.0;
// How much thicker than itself a sphere or cylinder is taken, and than its mean a part of a mesh: what hides behind it counts as
// well. Of 1 and 2, and 4 for parts, the nearest to rays (ours).
const THICKER: f32 = 2.0;
// What rises above a surface's plane by less than this, as a sine, is the plane itself.
const LEAST_RISE: f32 = 0.01;
// Points must lie this far behind what is seen, in radii, to count as hidden.
const POINT_BIAS_RADII: f32 = 0.02;
// Denoising leaves out what lies off the pixel's plane by more than this, in radii, and what is turned by more than acos of this.
const PLANE_RADII: f32 = 0.1;
const LEAST_COSINE: f32 = 0.7;
// With less weight than this in all there is nothing to take a mean of.
const LEAST_WEIGHT: f32 = 0.05;

fn is_surface(texel: vec4<u32>) -> bool {
    // A hull outline is a line, at a depth below 0: it neither receives nor casts.
    return texel.w != 0u && bitcast<f32>(texel.x) > 0.0;
}

fn position_at(at: vec2<i32>, depth: f32) -> vec3<f32> {
    let ray = ray_at(view, vec2<f32>(at) + 0.5);
    return ray.origin + depth * ray.direction;
}

fn is_outside(at: vec2<i32>) -> bool {
    return any(at < vec2<i32>(0)) || any(at >= vec2<i32>(view.tile_size_px));
}

// acos within 5e-5 [AbramowitzStegun1964 4.4.45].
fn angle_of(cosine: f32) -> f32 {
    let x = abs(cosine);
    let angle = sqrt(1.0 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
    return select(angle, PI - angle, cosine < 0.0);
}

// A slice through the line of sight.
struct Slice {
    // Cosine and sine of the angle from the line of sight to the normal within the slice, positive to the first side.
    cos_n: f32,
    sin_n: f32,
    // Light of the half circle on the second side, and of both.
    second: f32,
    all: f32,
}

// Light from the line of sight to an angle on one side, `sin_m` the sine of the normal's angle towards it [Jimenez2016, throughout].
fn light_to(cosine: f32, cos_n: f32, sin_m: f32) -> f32 {
    // Beyond the surface's own plane there is none.
    let c = clamp(cosine, -sin_m, 1.0);
    let s = sqrt(max(1.0 - c * c, 0.0));
    let doubled = (2.0 * c * c - 1.0) * cos_n + 2.0 * s * c * sin_m;
    return 0.25 * (cos_n - doubled + 2.0 * angle_of(c) * sin_m);
}

// How thick what a texel shows is behind its front, along the line of sight.
fn thickness(texel: vec4<u32>, depth: f32, away: vec3<f32>) -> f32 {
    if !OCCLUSION_THIN { return 1e30; }
    if is_part(texel.w) {
        // Its mean thickness, whichever way it is looked through.
        let look = object_texel(mesh_parts, 4u * (texel.w & INDEX_MASK) + 3u);
        return THICKER * unpack2x16float(look.z).y * bitcast<f32>(look.w);
    }
    let bend_px = unpack2x16float(texel.z).x;
    let across = 2.0 * pixel_world(view, depth) / max(bend_px, 1e-6);
    return THICKER * across * max(-dot(unpack_unit(texel.y), away), 0.0);
}

// The pixel whose horizons a texel of the estimate holds.
fn pixel_of(coarse: vec2<i32>) -> vec2<i32> {
    return min(STRIDE * coarse, vec2<i32>(view.tile_size_px) - 1);
}

fn horizons(own: vec2<i32>, texel: vec4<u32>) -> f32 {
    let g = unpack_geometry(texel);
    let p = position_at(own, g.depth);
    let to_viewer = select(normalize(-p), vec3<f32>(0.0, 0.0, 1.0), ORTHOGRAPHIC);
    let radius = occlusion_params.radius;
    let radius_px = min(radius / pixel_world(view, g.depth), occlusion_params.reach_px);
    let noise = pixel_noise(own / STRIDE);
    var blocked = 0.0;
    var all = 0.0;
    for (var index = 0u; index < occlusion_params.slices; index++) {
        let angle = PI * (f32(index) + noise.x) / f32(occlusion_params.slices);
        let way = vec2<f32>(cos(angle), sin(angle));
        let flat = vec3<f32>(way, 0.0);
        let along = flat - to_viewer * dot(to_viewer, flat);
        let axis = normalize(cross(along, to_viewer));
        let projected = g.facet_view - axis * dot(g.facet_view, axis);
        let size = length(projected);
        var slice: Slice;
        slice.cos_n = clamp(dot(projected, to_viewer) / max(size, 1e-6), -1.0, 1.0);
        slice.sin_n = sqrt(1.0 - slice.cos_n * slice.cos_n) * select(-1.0, 1.0, dot(along, projected) > 0.0);
        slice.second = light_to(-1.0, slice.cos_n, -slice.sin_n);
        slice.all = slice.second + light_to(-1.0, slice.cos_n, slice.sin_n);
        let bits = covered_bits(own, texel.w, p, g.facet_view, to_viewer, way, radius_px, noise.y, slice);
        blocked += size * slice.all * f32(countOneBits(bits)) / 32.0;
        all += size * slice.all;
    }
    return blocked / max(all, 1e-6);
}

// Light from the line of sight to a place, seen from the surface: all of the side's where it does not rise above the plane. Taps lie
// beside the slice by up to half a pixel, where a slanted plane would seem to rise.
fn light_to_place(place: vec3<f32>, normal: vec3<f32>, to_viewer: vec3<f32>, cos_n: f32, sin_m: f32) -> f32 {
    let inverse = inverseSqrt(max(dot(place, place), 1e-30));
    let rises = dot(place, normal) * inverse > LEAST_RISE;
    return light_to(select(-1.0, dot(place, to_viewer) * inverse, rises), cos_n, sin_m);
}

// From where to where, in 0..most, a line from `start` lies within the radius of the surface; nowhere where x is not below y.
fn within(start: vec3<f32>, way: vec3<f32>, most: f32) -> vec2<f32> {
    let radius = occlusion_params.radius;
    let a = max(dot(way, way), 1e-20);
    let b = dot(start, way);
    let inside = b * b - a * (dot(start, start) - radius * radius);
    let root = sqrt(max(inside, 0.0));
    let span = vec2<f32>(max((-b - root) / a, 0.0), min((-b + root) / a, most));
    return select(span, vec2<f32>(0.0), inside <= 0.0);
}

// How far from its pixel a tap lies, in pixels: denser near the surface (ours).
fn tap_px(step: f32, radius_px: f32) -> f32 {
    let share = step / f32(occlusion_params.steps);
    return max(share * sqrt(share) * radius_px, 1.0);
}

// The bits of a slice, from the end of its second side to the end of its first, in whose directions something lies.
fn covered_bits(
    own: vec2<i32>, own_id: u32, p: vec3<f32>, normal: vec3<f32>, to_viewer: vec3<f32>, way: vec2<f32>, radius_px: f32, noise: f32,
    slice: Slice,
) -> u32 {
    var bits = 0u;
    // What the last tap saw: between two taps of one object its surface goes on.
    var last_id = own_id;
    var last_front = vec3<f32>(0.0);
    for (var tap = 0u; tap < 2u * occlusion_params.steps; tap++) {
        let is_second = tap >= occlusion_params.steps;
        let step = f32(select(tap, tap - occlusion_params.steps, is_second)) + noise;
        if tap == occlusion_params.steps {
            last_id = own_id;
            last_front = vec3<f32>(0.0);
        }
        let side = select(1.0, -1.0, is_second);
        let off_px = tap_px(step, radius_px);
        let at = own + vec2<i32>(round(way * vec2<f32>(side, -side) * off_px));
        if is_outside(at) { continue; }
        let texel = textureLoad(geometry, at, 0);
        // A sphere or cylinder never hides light from itself.
        if !is_surface(texel) || (texel.w == own_id && !is_part(own_id)) { continue; }
        let depth = bitcast<f32>(texel.x);
        let ray = ray_at(view, vec2<f32>(at) + 0.5);
        let away = normalize(ray.direction);
        let front = ray.origin + depth * ray.direction - p;
        // Where what lies here begins: at the last tap of the same object, or half way to it, on its plane.
        var begins = last_front;
        if texel.w != last_id {
            let plane = unpack_unit(select(texel.y, texel.z, is_part(texel.w)));
            let back_px = off_px - tap_px(max(step - 0.5, 0.0), radius_px);
            let beside = vec3<f32>(-side * way * back_px * pixel_world(view, depth), 0.0);
            begins = front + beside - away * (dot(beside, plane) / min(dot(away, plane), -0.1));
        }
        last_id = texel.w;
        last_front = front;
        // Its front, and from there along the line of sight to its back, as far as they lie within the radius.
        let across = within(begins, front - begins, 1.0);
        let along = within(front, away, thickness(texel, depth, away));
        let is_across = across.y > across.x;
        let is_along = along.y > along.x;
        if !is_across && !is_along { continue; }
        let sin_m = slice.sin_n * side;
        // Where both are, the one ends where the other begins, but for fronts before the radius.
        let middle = select(front + along.x * away, mix(begins, front, across.y), is_across);
        let first_end = select(middle, mix(begins, front, across.x), is_across);
        let last_end = select(middle, front + along.y * away, is_along);
        let lights = vec3<f32>(
            light_to_place(first_end, normal, to_viewer, slice.cos_n, sin_m),
            light_to_place(middle, normal, to_viewer, slice.cos_n, sin_m),
            light_to_place(last_end, normal, to_viewer, slice.cos_n, sin_m),
        );
        let nearest = min(lights.x, min(lights.y, lights.z));
        let farthest = max(lights.x, max(lights.y, lights.z));
        // Shares of the whole slice, from the end of the second side.
        let low = (slice.second + select(nearest, -farthest, is_second)) / slice.all;
        let high = (slice.second + select(farthest, -nearest, is_second)) / slice.all;
        let first = u32(clamp(low * 32.0 + noise, 0.0, 32.0));
        let last = u32(clamp(high * 32.0 + noise, 0.0, 32.0));
        // Bits from the first to before the last; a shift by a whole word is none.
        let count = max(last, first) - first;
        bits |= select((0xffffffffu >> (32u - max(count, 1u))) << (first & 31u), 0u, count == 0u);
    }
    return bits;
}

// A unit vector of `count` that are spread evenly over the sphere [Vogel1979 eq. 1, on a sphere].
fn sphere_tap(index: f32, count: f32) -> vec3<f32> {
    let z = 1.0 - 2.0 * (index + 0.5) / count;
    let angle = index * 2.3999632;
    return vec3<f32>(sqrt(max(1.0 - z * z, 0.0)) * vec2<f32>(cos(angle), sin(angle)), z);
}

// The point's offset as this pixel has it: mirrored at its vector, or turned about it.
fn shuffled(offset: vec3<f32>, random: vec3<f32>, noise: f32) -> vec3<f32> {
    if OCCLUSION_ROTATED {
        let angle = 2.0 * PI * noise;
        return offset * cos(angle) + cross(random, offset) * sin(angle) + random * dot(random, offset) * (1.0 - cos(angle));
    }
    return offset - 2.0 * dot(offset, random) * random;
}

fn hidden_points(own: vec2<i32>, texel: vec4<u32>) -> f32 {
    let g = unpack_geometry(texel);
    let p = position_at(own, g.depth);
    let radius = min(occlusion_params.radius, occlusion_params.reach_px * pixel_world(view, g.depth));
    let count = f32(occlusion_params.samples);
    let noise = pixel_noise(own);
    let random = sphere_tap(16.0 * noise.x - 0.5, 16.0);
    var hidden = 0.0;
    var counted = 0.0;
    for (var index = 0u; index < occlusion_params.samples; index++) {
        // Spread evenly over the ball.
        let long = pow((f32(index) * 0.618034 + 0.5) - floor(f32(index) * 0.618034 + 0.5), 1.0 / 3.0);
        var offset = shuffled(long * radius * sphere_tap(f32(index), count), random, noise.y);
        if !OCCLUSION_PUBLISHED { offset *= select(-1.0, 1.0, dot(offset, g.facet_view) > 0.0); }
        let point = p + offset;
        let depth = -point.z;
        let plane = point.xy / select(max(depth, 1e-6), 1.0, ORTHOGRAPHIC);
        let at = vec2<i32>(floor((plane - view.plane_from_px.zw) / view.plane_from_px.xy - view.tile_origin_px));
        if !OCCLUSION_PUBLISHED && (is_outside(at) || depth <= view.near) { continue; }
        counted += 1.0;
        let last = vec2<i32>(view.tile_size_px) - 1;
        let seen = textureLoad(geometry, clamp(at, vec2<i32>(0), last), 0);
        let seen_depth = bitcast<f32>(seen.x);
        var is_hidden = is_surface(seen) && seen_depth < depth;
        if !OCCLUSION_PUBLISHED {
            is_hidden = is_hidden && seen_depth < depth - POINT_BIAS_RADII * radius && abs(seen_depth - g.depth) < radius;
        }
        hidden += select(0.0, 1.0, is_hidden);
    }
    return hidden / max(counted, 1.0);
}

@fragment
fn estimate_occlusion(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let own = pixel_of(vec2<i32>(position.xy));
    let texel = textureLoad(geometry, own, 0);
    if !is_surface(texel) { return vec4<f32>(0.0); }
    if OCCLUSION_PICKS && (picks_of(texel.w) & occlusion_params.pick_bits) == 0u { return vec4<f32>(NOT_PICKED, 0.0, 0.0, 0.0); }
    if OCCLUSION_HORIZONS { return vec4<f32>(horizons(own, texel), 0.0, 0.0, 0.0); }
    return vec4<f32>(hidden_points(own, texel), 0.0, 0.0, 0.0);
}

// The mean over the square around a pixel. Horizons: over what lies on its plane and faces its way, so that edges stay.
fn denoised(own: vec2<i32>, texel: vec4<u32>) -> f32 {
    // Samples of a still even noise out already.
    let side = i32(max(round(f32(occlusion_params.blur) * view.footprint_px), 1.0));
    let texels = (vec2<i32>(view.tile_size_px) + STRIDE - 1) / STRIDE;
    let g = unpack_geometry(texel);
    let p = position_at(own, g.depth);
    var sum = 0.0;
    var weights = 0.0;
    for (var index = 0; index < side * side; index++) {
        let coarse = (own + STRIDE / 2) / STRIDE + vec2<i32>(index % side, index / side) - side / 2;
        let inside = clamp(coarse, vec2<i32>(0), texels - 1);
        let at = pixel_of(inside);
        let other = textureLoad(geometry, at, 0);
        if any(inside != coarse) || !is_surface(other) { continue; }
        let estimate = textureLoad(occlusion, coarse, 0).x;
        if OCCLUSION_PICKS && estimate == NOT_PICKED { continue; }
        var weight = 1.0;
        if OCCLUSION_HORIZONS {
            let off = dot(position_at(at, bitcast<f32>(other.x)) - p, g.normal_view);
            let turned = dot(unpack_unit(other.y), g.normal_view);
            weight = max(1.0 - abs(off) / (PLANE_RADII * occlusion_params.radius), 0.0)
                * max((turned - LEAST_COSINE) / (1.0 - LEAST_COSINE), 0.0);
        }
        sum += weight * estimate;
        weights += weight;
    }
    if STRIDE > 1 && weights < LEAST_WEIGHT { return horizons(own, texel); }
    return sum / max(weights, 1e-6);
}

// The share of light that is left to a surface.
fn light_left(own: vec2<i32>, texel: vec4<u32>) -> f32 {
    if OCCLUSION_PICKS && (picks_of(texel.w) & occlusion_params.pick_bits) == 0u { return 1.0; }
    return max(1.0 - occlusion_params.intensity * denoised(own, texel), 0.0);
}

@fragment
fn apply_occlusion(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let own = vec2<i32>(position.xy);
    let texel = textureLoad(geometry, own, 0);
    var result = textureLoad(color, own, 0);
    if is_surface(texel) { result = vec4<f32>(result.rgb * light_left(own, texel), result.a); }
    return finished(result);
}

@fragment
fn occlusion_aov(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let own = vec2<i32>(position.xy);
    let texel = textureLoad(geometry, own, 0);
    if !is_surface(texel) { return vec4<f32>(-1.0, 0.0, 0.0, 0.0); }
    return vec4<f32>(light_left(own, texel), 0.0, 0.0, 0.0);
}
