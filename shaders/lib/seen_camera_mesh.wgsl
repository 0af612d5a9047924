// What the visibility pass of triangles writes for the camera: an id. Hardware has their depths.

struct VisibilityOut {
    @location(0) id: u32,
}

fn visibility_out(id: u32, t: f32, outline_t: f32) -> VisibilityOut {
    return VisibilityOut(id);
}
