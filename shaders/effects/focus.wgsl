// Depth of field: how wide things blur. A point at a depth is seen all over a circle around its place in the picture, the circle
// of confusion: nothing where it is sharp, and growing from there by a measure of depth, up to a largest one.
//
// How it is drawn: `focus_gather.wgsl`, or `focus_layers.wgsl`.

struct FocusParams {
    // Measures between which all is sharp.
    sharp: vec2<f32>,
    // Growth of the diameter before and behind, in pixels for each unit of the measure.
    slopes_px: vec2<f32>,
    // Largest diameters before and behind, in pixels.
    most_px: vec2<f32>,
    // Largest radii of the scene, before and behind.
    widest_px: vec2<f32>,
    // Most taps of a pixel.
    taps: u32,
    // Tiles to each side that a blur can come from.
    tiles: u32,
}

// Diameters below this are sharp.
const LEAST_PX: f32 = 0.5;

// Diameters before and behind what is sharp: one of both is 0.
fn diameters_px(depth: f32) -> vec2<f32> {
    // Lines of sight through a lens are straight by it [Potmesil1981 §2].
    let measure = select(-1.0 / depth, depth, ORTHOGRAPHIC);
    let off = max(vec2<f32>(focus_params.sharp.x - measure, measure - focus_params.sharp.y), vec2<f32>(0.0));
    return min(focus_params.slopes_px * off, focus_params.most_px);
}

// Of what a texel shows; where that is nothing, of what is farthest.
fn diameters_of(texel: vec4<u32>) -> vec2<f32> {
    // A hull outline lies at its depth below 0.
    let depth = abs(bitcast<f32>(texel.x));
    return select(vec2<f32>(0.0, focus_params.most_px.y), diameters_px(depth), texel.w != 0u);
}

// The diameter of each pixel's circle, -1 where no surface is.
@fragment
fn focus_aov(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = textureLoad(geometry, vec2<i32>(position.xy), 0);
    let blur = diameters_of(texel);
    return vec4<f32>(select(-1.0, blur.x + blur.y, texel.w != 0u && bitcast<f32>(texel.x) > 0.0), 0.0, 0.0, 0.0);
}

// Linear colours of the five layers, from near to far.
fn layer_color(layer: u32) -> vec3<f32> {
    var colors = array<vec3<f32>, 5>(
        vec3<f32>(0.78, 0.09, 0.09), vec3<f32>(0.95, 0.45, 0.10), vec3<f32>(0.75, 0.85, 0.75), vec3<f32>(0.12, 0.50, 0.80),
        vec3<f32>(0.05, 0.12, 0.55),
    );
    return colors[layer];
}

// Which of five layers each surface is in: in the layer's colour, as bright as its own. Lines keep theirs.
@fragment
fn show_layers(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let own = vec2<i32>(position.xy);
    let texel = textureLoad(geometry, own, 0);
    var result = textureLoad(color, own, 0);
    if texel.w != 0u && bitcast<f32>(texel.x) > 0.0 {
        let blur = diameters_of(texel);
        var layer = 2u;
        if blur.x > LEAST_PX { layer = select(1u, 0u, blur.x >= 0.999 * focus_params.most_px.x); }
        if blur.y > LEAST_PX { layer = select(3u, 4u, blur.y >= 0.999 * focus_params.most_px.y); }
        let luminance = dot(result.rgb, vec3<f32>(0.2126, 0.7152, 0.0722));
        result = vec4<f32>(layer_color(layer) * (0.3 + 0.7 * luminance), result.a);
    }
    return finished(result);
}
