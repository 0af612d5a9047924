// Empties all slots of Z and D.

@group(2) @binding(0) var<uniform> bkb: BkbBand;
@group(2) @binding(1) var<storage, read_write> bkb_z: array<u32>;
@group(2) @binding(3) var<storage, read_write> bkb_d: array<u32>;

@compute @workgroup_size(8, 8)
fn clear_slots(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let at = invocation.xy + vec2<u32>(0u, bkb.first_row);
    if at.x >= bkb.width || invocation.y >= bkb.num_rows { return; }
    let first = first_slot(bkb, at);
    for (var slot = first; slot < first + bkb.k; slot++) {
        bkb_z[slot] = EMPTY;
        for (var word = 0u; word < DATA_WORDS; word++) { bkb_d[slot * DATA_WORDS + word] = 0u; }
    }
}
