// What neighbouring pixels ask of each fragment: its normal, and which object it is of.

@fragment
fn mark_layers(@builtin(position) position: vec4<f32>) {
    let at = vec2<u32>(position.xy);
    let list = list_of(at.y * layers.width + at.x - layers.first_pixel);
    let ray = ray_at(view, position.xy);
    for (var index = list.start; index < list.start + list.count; index++) {
        let s = surface_at(ray, layer_pool[index].y);
        layer_pool[mark_place(index)] = pack_mark(s.normal_view, s.object);
    }
}
