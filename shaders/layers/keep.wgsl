// The layers of a pixel, each shaded and kept, for depth of field: what is blurred lets through what lies behind it, so that none of them
// is left out. Their light lies in the pool behind all fragments, 8 bytes each.

@group(2) @binding(5) var geometry: texture_2d<u32>;

// Shades them; what is left is the nearest surface, for effects that come between.
fn kept(position_px: vec2<f32>) -> vec4<u32> {
    let at = vec2<i32>(position_px);
    var nearest = textureLoad(geometry, at, 0);
    let list = list_of(u32(at.y) * layers.width + u32(at.x) - layers.first_pixel);
    if list.count == 0u { return nearest; }
    let ray = ray_at(view, position_px);
    var neighbours = neighbours_of(position_px);
    for (var index = 0u; index < list.count; index++) {
        let id = layer_pool[list.start + index].y;
        var s = surface_at(ray, id);
        if ASKS_NEIGHBOURS { s.kappa_of_screen = kappa_of_screen(s, position_px, &neighbours); }
        let drawn = shade_layer(s, material_of(id));
        let light = vec2<u32>(pack2x16float(drawn.rg), pack2x16float(drawn.ba));
        layer_pool[layers.capacity + list.start + index] = light;
        if index == 0u {
            let depth = -s.position_view.z;
            let bend_px = s.bend * pixel_world(view, depth);
            nearest = pack_geometry(Geometry(depth, s.normal_view, s.facet_view, bend_px, s.group, s.object));
        }
    }
    return nearest;
}

@fragment
fn keep_layers(@builtin(position) position: vec4<f32>) {
    let nearest = kept(position.xy);
}

// With a picture of nothing, for lines, and the nearest surfaces.
@fragment
fn keep_layers_geometry(@builtin(position) position: vec4<f32>) -> Shaded {
    return Shaded(vec4<f32>(0.0), kept(position.xy));
}

struct Shaded {
    @location(0) color: vec4<f32>,
    @location(1) geometry: vec4<u32>,
}
