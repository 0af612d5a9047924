// The near side of an atom as a layer.

@fragment
fn atom_layers(in: AtomVarying) {
    let t = first_beyond(sphere_span(ray_at(view, in.position.xy), in.sphere.xyz, in.sphere.w), view.near);
    if t > 0.0 { add_layer(in.position.xy, make_id(KIND_ATOM, in.index), t); }
}
