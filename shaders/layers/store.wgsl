// The fragments of transparent objects, all of them: counted for each pixel, then given room, then written down. A pixel's list
// has one entry for each surface that its ray meets in front of what is opaque, of atoms and connectors the near side alone: its depth
// along the view, and its id.
//
// Counting and writing are one fragment shader each way: WRITES says which.

@group(1) @binding(0) var<uniform> layers: LayerBand;
@group(1) @binding(1) var<storage, read_write> layer_ends: array<atomic<u32>>;
@group(1) @binding(3) var<storage, read_write> layer_pool: array<vec2<u32>>;
@group(1) @binding(4) var opaque_depth: texture_depth_2d;

fn add_layer(position_px: vec2<f32>, id: u32, t: f32) {
    let at = vec2<i32>(position_px);
    if depth_value(view, t) <= textureLoad(opaque_depth, at, 0) { return; }
    let place = atomicAdd(&layer_ends[u32(at.y) * layers.width + u32(at.x) - layers.first_pixel], 1u);
    if WRITES && place < layers.capacity { layer_pool[place] = vec2<u32>(bitcast<u32>(t), id); }
}
