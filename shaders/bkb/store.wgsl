// The second pass over what is transparent: colour and normal of each fragment whose key was kept [Murray2016 §4.1 "Data storage"].
// Fragments of one key share their slot: the larger words stay, so that pictures do not depend on who comes last (ours).

@group(2) @binding(0) var<uniform> bkb: BkbBand;
@group(2) @binding(3) var<storage, read_write> bkb_d: array<atomic<u32>>;
@group(2) @binding(5) var opaque_depth: texture_depth_2d;

fn add_layer(position_px: vec2<f32>, id: u32, t: f32) {
    let at = vec2<i32>(position_px);
    if depth_value(view, t) <= textureLoad(opaque_depth, at, 0) { return; }
    let slot = slot_of(first_slot(bkb, vec2<u32>(at)), layer_key(id, t));
    if slot == EMPTY { return; }
    let s = surface_at(ray_at(view, position_px), id);
    let material = material_of(id);
    let color = shade_object(s, material);
    // Until it is stylised, a fragment carries its material; where nothing stylises it, its opacity.
    let opacity = u32(materials[material].opacity * 255.0 + 0.5);
    atomicMax(&bkb_d[slot * DATA_WORDS], pack_color(color, select(material, opacity, DUAL_PASS)));
    if !DUAL_PASS { atomicMax(&bkb_d[slot * DATA_WORDS + 1u], pack_normal(s.normal_view)); }
}
