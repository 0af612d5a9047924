// What the visibility pass writes for the camera: an id and a depth to test with.

struct VisibilityOut {
    @location(0) id: u32,
    @builtin(frag_depth) depth: f32,
}

fn visibility_out(id: u32, t: f32, outline_t: f32) -> VisibilityOut {
    return VisibilityOut(id, depth_value(view, t));
}
