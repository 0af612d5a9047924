// The camera (or a light that looks at the scene) and the ray of a picture point. ORTHOGRAPHIC, a constant of each
// pipeline, says which projection its own view has; `view.orthographic` says it of any view.
// View space is right-handed, the eye at the origin looking along -z. `t` is -z_view: since every ray
// direction has z = -1, the ray parameter of a hit is its depth.

struct View {
    view_from_world: mat4x4<f32>,
    // Place on the plane of half_extent = pixel position * xy + zw, the jitter included.
    plane_from_px: vec4<f32>,
    // View units per unit of normalised device x, y: at depth 1 in perspective, everywhere in orthographic.
    half_extent: vec2<f32>,
    size_px: vec2<f32>,
    // The tile of the picture that is drawn: its first pixel and its size. The whole picture is one tile from 0.
    tile_origin_px: vec2<f32>,
    tile_size_px: vec2<f32>,
    // Where in its pixel this sample lies, from the pixel's centre, in pixels, y down.
    jitter_px: vec2<f32>,
    // 1 where the view is orthographic, 0 where it is perspective.
    orthographic: f32,
    // Nearest depth that is drawn.
    near: f32,
    // Depth buffer value = x / t + y + z * t; 1 is nearest.
    depth_from_t: vec3<f32>,
    // View units that one pixel covers at depth 1 (perspective) or anywhere (orthographic).
    pixel_view: f32,
    // Turns the sample pattern of filters between the samples of a still, in radians.
    sample_rotation_rad: f32,
    // One over the number of samples of the still.
    sample_weight: f32,
    // Side of the square that one sample stands for, in pixels: 1 over the root of their number.
    footprint_px: f32,
    // Depth beyond which nothing lies.
    far: f32,
}

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

// The ray of this sample for a fragment's position in its tile. Whole pixels add up exactly, so that tiles are the picture.
fn ray_at(view: View, position_px: vec2<f32>) -> Ray {
    let plane = (position_px + view.tile_origin_px) * view.plane_from_px.xy + view.plane_from_px.zw;
    if ORTHOGRAPHIC {
        return Ray(vec3<f32>(plane, 0.0), vec3<f32>(0.0, 0.0, -1.0));
    }
    return Ray(vec3<f32>(0.0), vec3<f32>(plane, -1.0));
}

// Change of the ray (origin or direction, whichever moves) across one sample's footprint, to the right and down.
fn ray_step_dx(view: View) -> vec3<f32> {
    return vec3<f32>(view.footprint_px * 2.0 * view.half_extent.x / view.size_px.x, 0.0, 0.0);
}
fn ray_step_dy(view: View) -> vec3<f32> {
    return vec3<f32>(0.0, -view.footprint_px * 2.0 * view.half_extent.y / view.size_px.y, 0.0);
}

fn depth_value(view: View, t: f32) -> f32 {
    if ORTHOGRAPHIC { return view.depth_from_t.y + view.depth_from_t.z * t; }
    return view.depth_from_t.x / t;
}

// Clip position of a view-space point. Its depth is set to the middle: fragments write their own.
fn clip_from_view(view: View, position: vec3<f32>) -> vec4<f32> {
    let w = select(-position.z, 1.0, ORTHOGRAPHIC);
    let jitter_ndc = view.jitter_px * vec2<f32>(2.0, -2.0) / view.size_px;
    let xy = position.xy / view.half_extent - jitter_ndc * w;
    return vec4<f32>(xy, 0.5 * w, w);
}

fn to_view(view: View, position_world: vec3<f32>) -> vec3<f32> {
    return (view.view_from_world * vec4<f32>(position_world, 1.0)).xyz;
}
