// Shadows from maps that hold, for each texel, the id and depth of what the light sees first.
// Hard: the ids near a point name the few objects that can shade it, and an exact ray cast against
// those gives an edge that does not depend on the map's resolution (ours).
// Soft: average depth of what blocks, then a filter as wide as the penumbra [Fernando2005 §2]. What blocks
// is the outline of an object, not the front that the map holds: the map has the depth of both (ours).
// A convex object never shades itself: its unlit side is found by n.l, so there is no bias for it.

// Blocks the way from `origin` along `toward` (light space) the object `id`?
fn blocks(light_view: View, id: u32, origin: vec3<f32>, toward: vec3<f32>) -> bool {
    let ray = Ray(origin, toward);
    let index = id & INDEX_MASK;
    var span = vec2<f32>(1.0, -1.0);
    if (id >> 29u) == KIND_ATOM {
        let atom = atom_at(index);
        span = sphere_span(ray, to_view(light_view, atom.position_world), atom.radius);
    } else {
        let connector = connector_at(index);
        let a = to_view(light_view, connector.a_world);
        let b = to_view(light_view, connector.b_world);
        span = cone_span(ray, a, b, connector.radius, connector.radius);
    }
    return span.x <= span.y && span.y > 0.0;
}

// How far in front of a receiver's plane triangles must lie to shade it, in texels: what lies in a fold is a slope of one.
const MESH_BIAS_TEXELS: f32 = 1.0;
// The steepest that a receiver's plane is taken, where the shadow is hard and where it is soft and so looks far beyond it.
const MESH_SLOPE: f32 = 16.0;
const SOFT_SLOPE: f32 = 4.0;

// Share of the light that triangles let through: of the four texels around a place, each weighed by how near it is
// [Reeves1987, throughout], and compared with the receiver's plane there [Isidoro2006].
fn mesh_light(light_view: View, layer: i32, lit: LitPlace, slope: vec2<f32>, last: vec2<i32>) -> f32 {
    let base = floor(lit.place_px - 0.5);
    let share = lit.place_px - 0.5 - base;
    var open = 0.0;
    for (var i = 0; i < 4; i++) {
        let corner = vec2<i32>(i & 1, i >> 1);
        let texel = vec2<i32>(base) + corner;
        let weights = select(1.0 - share, share, corner == vec2<i32>(1));
        let seen = textureLoad(shadow_maps, clamp(texel, vec2<i32>(0), last), layer, 0).xy;
        let depth = light_view.near + (light_view.far - light_view.near) * unpack2x16unorm(seen.y).x;
        let own = lit.t + dot(slope, vec2<f32>(corner) - share) - MESH_BIAS_TEXELS * lit.texel_light;
        let is_blocked = (seen.x >> 29u) == KIND_MESH && depth < own && all(texel == clamp(texel, vec2<i32>(0), last));
        open += select(weights.x * weights.y, 0.0, is_blocked);
    }
    return open;
}

// Change of depth for each texel across the plane of this normal (light space), taken as no steeper than `most` to one.
fn plane_slope(light_view: View, lit: LitPlace, normal: vec3<f32>, most: f32) -> vec2<f32> {
    // Towards the light; of length 1 along its axis, as depths are.
    let toward = mix(-lit.point / lit.t, vec3<f32>(0.0, 0.0, 1.0), light_view.orthographic);
    let facing = dot(normal, toward);
    let steep = normal.xy / (max(abs(facing), 0.01) * select(1.0, -1.0, facing < 0.0));
    let tangent = length(steep);
    return vec2<f32>(steep.x, -steep.y) * (min(tangent, most) / max(tangent, 1e-6)) * lit.texel_light;
}

fn shadow_light(light: Light, s: Surface) -> f32 {
    let layer = light.shadow;
    let light_view = shadows.views[layer].light;
    let lit = lit_place(light_view, (shadows.views[layer].light_from_view * vec4<f32>(s.position_view, 1.0)).xyz);
    let point = lit.point;
    let t = lit.t;
    if t <= light_view.near { return 1.0; }
    let place_px = lit.place_px;
    let texel_light = lit.texel_light;
    let last = vec2<i32>(light_view.size_px) - 1;
    if light.softness_tan <= 0.0 {
        let toward = mix(-normalize(point), vec3<f32>(0.0, 0.0, 1.0), light_view.orthographic);
        let base = vec2<i32>(floor(place_px - 0.5));
        // What a triangle shades is told by depths: the few that the map names would leave gaps between them.
        var seen = s.id;
        for (var i = 0; i < 4; i++) {
            let texel = base + vec2<i32>(i & 1, i >> 1);
            if any(texel < vec2<i32>(0)) || any(texel > last) { continue; }
            let id = textureLoad(shadow_maps, texel, layer, 0).x;
            if id == 0u || id == s.id || id == seen { continue; }
            if MESHES && (id >> 29u) == KIND_MESH {
                continue;
            }
            seen = id;
            if blocks(light_view, id, point, toward) { return 0.0; }
        }
        if MESHES {
            let is_flat = (s.id >> 29u) == KIND_MESH;
            let facet = (shadows.views[layer].light_from_view * vec4<f32>(s.facet_view, 0.0)).xyz;
            let slope = plane_slope(light_view, lit, facet, MESH_SLOPE);
            return mesh_light(light_view, layer, lit, select(vec2<f32>(0.0), slope, is_flat), last);
        }
        return 1.0;
    }

    // Two texels: neighbouring objects that touch do not shade each other's seam.
    let near_enough = t - 2.0 * texel_light;
    // A flat receiver goes on beneath the filter: depths are compared with its plane there [Isidoro2006], which is
    // taken as no steeper than four to one.
    var slope = vec2<f32>(0.0);
    if MESHES && (s.id >> 29u) == KIND_MESH {
        let normal = (shadows.views[layer].light_from_view * vec4<f32>(s.normal_view, 0.0)).xyz;
        slope = plane_slope(light_view, lit, normal, SOFT_SLOPE);
    }
    // The widest penumbra: as if the blocker were the nearest thing that the light can see.
    // A point light has its angular diameter as seen from here, hence the quotient of the depths.
    let nearest = mix(t / light_view.near, 1.0, light_view.orthographic);
    let reach = light.softness_tan * (t - light_view.near) * nearest / texel_light;
    let turn = view.sample_rotation_rad + 6.2831853 * interleaved_noise(place_px);
    var blocker_sum = 0.0;
    var blockers = 0.0;
    for (var i = 0u; i < SOFT_TAPS; i++) {
        let offset = reach * disc_tap(i, turn);
        let tap = shadow_tap(light_view, layer, place_px + offset, last, s.id);
        if tap.x < near_enough + min(dot(slope, offset), 0.0) {
            blocker_sum += min(tap.y, near_enough);
            blockers += 1.0;
        }
    }
    if blockers == 0.0 { return 1.0; }
    let blocker_t = blocker_sum / blockers;
    // Similar triangles: half the penumbra, seen from the blocker towards the receiver.
    let quotient = mix(t / blocker_t, 1.0, light_view.orthographic);
    let wide = max(light.softness_tan * (t - blocker_t) * quotient / texel_light, 0.5);
    var open = 0.0;
    for (var i = 0u; i < SOFT_TAPS; i++) {
        let offset = wide * disc_tap(i, turn);
        let tap = shadow_tap(light_view, layer, place_px + offset, last, s.id);
        if tap.x >= near_enough + min(dot(slope, offset), 0.0) { open += 1.0; }
    }
    return open / f32(SOFT_TAPS);
}

// Depths of the surface and of the outline that the light sees at a place; the far end where that is nothing, outside,
// or the receiver itself.
fn shadow_tap(light_view: View, layer: i32, place_px: vec2<f32>, last: vec2<i32>, own: u32) -> vec2<f32> {
    let texel = vec2<i32>(floor(place_px));
    let inside = clamp(texel, vec2<i32>(0), last);
    let seen = textureLoad(shadow_maps, inside, layer, 0).xy;
    let depths = light_view.near + (light_view.far - light_view.near) * unpack2x16unorm(seen.y);
    let nothing = seen.x == 0u || seen.x == own || any(texel != inside);
    return select(depths, vec2<f32>(light_view.far), nothing);
}
