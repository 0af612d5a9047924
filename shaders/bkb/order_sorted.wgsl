// Lists that are in the order of depths already: of the plain dual-pass k-buffer.

@group(2) @binding(0) var<uniform> bkb: BkbBand;
@group(2) @binding(1) var<storage, read_write> bkb_z: array<u32>;
@group(2) @binding(3) var<storage, read_write> bkb_d: array<u32>;

// How many fragments a pixel has.
fn order_by_depth(first: u32) -> u32 {
    var count = 0u;
    while count < bkb.k && bkb_z[first + count] != EMPTY { count += 1u; }
    return count;
}

fn slot_from_near(first: u32, index: u32) -> u32 {
    return first + index;
}
