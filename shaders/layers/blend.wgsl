// The layers of a pixel over what is opaque there: each fragment of its list, which is sorted from near to far, is shaded from its id
// and blended until next to no light comes through. Nothing but the surfaces that count is ever shaded.

@group(2) @binding(4) var color: texture_2d<f32>;
@group(2) @binding(5) var geometry: texture_2d<u32>;

// Light that still comes through where blending ends: a quarter of a step of 10 bits.
const LEAST_LIGHT: f32 = 1.0 / 4096.0;

struct Blended {
    // Premultiplied linear light of one sample.
    color: vec4<f32>,
    // The nearest surface, for effects that follow.
    geometry: vec4<u32>,
}

fn blended(position_px: vec2<f32>) -> Blended {
    let at = vec2<i32>(position_px);
    let behind = textureLoad(color, at, 0);
    var result = Blended(behind, textureLoad(geometry, at, 0));
    let list = list_of(u32(at.y) * layers.width + u32(at.x) - layers.first_pixel);
    if list.count == 0u { return result; }
    let ray = ray_at(view, position_px);
    var neighbours = neighbours_of(position_px);
    var light = vec3<f32>(0.0);
    var open = 1.0;
    for (var index = 0u; index < list.count; index++) {
        let id = layer_pool[list.start + index].y;
        var s = surface_at(ray, id);
        if ASKS_NEIGHBOURS { s.kappa_of_screen = kappa_of_screen(s, position_px, &neighbours); }
        let material = material_of(id);
        let drawn = shade_layer(s, material);
        light += open * drawn.a * drawn.rgb;
        open *= 1.0 - drawn.a;
        if index == 0u {
            let depth = -s.position_view.z;
            let bend_px = s.bend * pixel_world(view, depth);
            result.geometry = pack_geometry(Geometry(depth, s.normal_view, s.facet_view, bend_px, s.group, s.object));
        }
        if open < LEAST_LIGHT { break; }
    }
    result.color = vec4<f32>(light + open * behind.rgb, 1.0 - open * (1.0 - behind.a));
    return result;
}

@fragment
fn blend_layers(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return finished(blended(position.xy).color);
}

@fragment
fn blend_layers_geometry(@builtin(position) position: vec4<f32>) -> Shaded {
    let result = blended(position.xy);
    return Shaded(result.color, result.geometry);
}

struct Shaded {
    @location(0) color: vec4<f32>,
    @location(1) geometry: vec4<u32>,
}
