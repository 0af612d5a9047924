// The shading pass of a picture that post effects change: light that is not weighted yet, and the surface beside it.

struct ShadedSurface {
    @location(0) color: vec4<f32>,
    @location(1) geometry: vec4<u32>,
}

@fragment
fn shade_geometry_fragment(@builtin(position) position: vec4<f32>) -> ShadedSurface {
    let id = textureLoad(visibility, vec2<i32>(position.xy), 0).x;
    let s = surface_at(ray_at(view, position.xy), id);
    // A hull outline is a line, no surface: its depth is below 0, where no other line lies on it.
    let is_line = HULLS && (id >> 29u) > KIND_LAST_SURFACE;
    let depth = select(-s.position_view.z, s.position_view.z, is_line);
    let bend_px = s.bend * pixel_world(view, depth);
    let geometry = pack_geometry(Geometry(depth, s.normal_view, s.facet_view, bend_px, s.group, s.object));
    return ShadedSurface(vec4<f32>(shaded(s, id), 1.0), geometry);
}
