// Depth of field in five layers [Prost2016 §4.3]: what is near and what is far are pictures of their own, each blurred by a separable
// Gaussian; in between, a pixel is interpolated from both of its layers. Its flaws stay: a near layer ends where it did, and
// what is blurred by half is a ghost over what is sharp.
//
// Mended: a layer's pixels count by what it covers of them, where the published form fills them with the background, which
// then shows as a fringe; and what lies in between belongs to both layers, so that it blurs itself and does not fade.
// FOCUS_PUBLISHED leaves the mends out, for measurements.

// Standard deviation of a Gaussian that is as wide as a disc, in diameters of that (ours): equal variance.
const DEVIATIONS: f32 = 0.25;
// Where a Gaussian ends, in standard deviations.
const END: f32 = 2.5;
// A circle is the largest from this share of it on.
const ALMOST: f32 = 0.999;

// Premultiplied light of a layer, and how much of a pixel's surroundings it covers.
struct Layer {
    color: vec4<f32>,
    weight: f32,
}

fn pack_layer(layer: Layer) -> vec4<u32> {
    let c = layer.color;
    return vec4<u32>(pack2x16float(c.rg), pack2x16float(c.ba), bitcast<u32>(layer.weight), 0u);
}

fn unpack_layer(texel: vec4<u32>) -> Layer {
    return Layer(vec4<f32>(unpack2x16float(texel.x), unpack2x16float(texel.y)), bitcast<f32>(texel.z));
}

// How far a texel is in the near layer and in the far one, 0 to 1.
fn layer_shares(texel: vec4<u32>) -> vec2<f32> {
    return diameters_of(texel) / max(focus_params.most_px, vec2<f32>(1e-6));
}

// A pixel as the near layer (or the far one) has it.
fn in_layer(at: vec2<i32>, is_far: bool) -> Layer {
    let shares = layer_shares(textureLoad(geometry, at, 0));
    let share = select(shares.x, shares.y, is_far);
    let own = textureLoad(color, at, 0);
    if !FOCUS_PUBLISHED { return Layer(share * own, share); }
    if share >= ALMOST { return Layer(own, 1.0); }
    return Layer(output.background, 1.0);
}

// How many pixels to each side a layer's Gaussian reaches.
fn reach_px(is_far: bool) -> i32 {
    return i32(ceil(END * deviation_px(is_far)));
}

fn deviation_px(is_far: bool) -> f32 {
    return DEVIATIONS * select(focus_params.most_px.x, focus_params.most_px.y, is_far);
}

fn gaussian(off_px: i32, is_far: bool) -> f32 {
    let off = f32(off_px) / max(deviation_px(is_far), 1e-3);
    return exp(-0.5 * off * off);
}

fn inside(at: vec2<i32>) -> vec2<i32> {
    return clamp(at, vec2<i32>(0), vec2<i32>(view.tile_size_px) - 1);
}

fn mixed(sum: Layer, layer: Layer, weight: f32) -> Layer {
    return Layer(sum.color + weight * layer.color, sum.weight + weight * layer.weight);
}

// A layer of the picture, blurred across.
fn across(own: vec2<i32>, is_far: bool) -> vec4<u32> {
    var sum = Layer(vec4<f32>(0.0), 0.0);
    var weights = 0.0;
    for (var off = -reach_px(is_far); off <= reach_px(is_far); off++) {
        let weight = gaussian(off, is_far);
        sum = mixed(sum, in_layer(inside(own + vec2<i32>(off, 0)), is_far), weight);
        weights += weight;
    }
    return pack_layer(Layer(sum.color / weights, sum.weight / weights));
}

// What is blurred across, blurred down.
fn down(own: vec2<i32>, is_far: bool, layer: texture_2d<u32>) -> vec4<u32> {
    var sum = Layer(vec4<f32>(0.0), 0.0);
    var weights = 0.0;
    for (var off = -reach_px(is_far); off <= reach_px(is_far); off++) {
        let weight = gaussian(off, is_far);
        sum = mixed(sum, unpack_layer(textureLoad(layer, inside(own + vec2<i32>(0, off)), 0)), weight);
        weights += weight;
    }
    return pack_layer(Layer(sum.color / weights, sum.weight / weights));
}

@fragment
fn blur_near_across(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    return across(vec2<i32>(position.xy), false);
}

@fragment
fn blur_near_down(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    return down(vec2<i32>(position.xy), false, near_across);
}

@fragment
fn blur_far_across(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    return across(vec2<i32>(position.xy), true);
}

@fragment
fn blur_far_down(@builtin(position) position: vec4<f32>) -> @location(0) vec4<u32> {
    return down(vec2<i32>(position.xy), true, far_across);
}

// A pixel's own colour, or as much as it is out of focus that of a layer.
fn layered(own: vec4<f32>, layer: Layer, share: f32) -> vec4<f32> {
    let blurred = select(own, layer.color / max(layer.weight, 1e-6), layer.weight > 1e-4);
    return mix(own, blurred, share);
}

@fragment
fn compose_layers(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let own = vec2<i32>(position.xy);
    let shares = layer_shares(textureLoad(geometry, own, 0));
    let sharp = textureLoad(color, own, 0);
    let near = layered(sharp, unpack_layer(textureLoad(near_layer, own, 0)), shares.x);
    return finished(layered(near, unpack_layer(textureLoad(far_layer, own, 0)), shares.y));
}
