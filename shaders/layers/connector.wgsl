// The near side of a connector as a layer.

@fragment
fn connector_layers(in: ConnectorVarying) {
    let ray = ray_at(view, in.position.xy);
    let t = first_beyond(cone_span(ray, in.a.xyz, in.b.xyz, in.radius, in.radius), view.near);
    if t > 0.0 { add_layer(in.position.xy, make_id(KIND_CONNECTOR, in.index), t); }
}
