// Lists that are in the order of shapes: the order of depths is found for each pixel.

// Depths of fragments above their slots, as far as there are fragments; k is at most 64.
var<private> bkb_order: array<u32, 64>;

// Sorts the fragments of a pixel by depth, equal depths by their shapes, and returns how many there are.
fn order_by_depth(first: u32) -> u32 {
    var count = 0u;
    while count < bkb.k {
        let key = bkb_z[first + count];
        if key == EMPTY { break; }
        let moved = (key & 0xffffu) << 8u | count;
        var slot = count;
        while slot > 0u {
            let other = bkb_order[slot - 1u];
            if other <= moved { break; }
            bkb_order[slot] = other;
            slot -= 1u;
        }
        bkb_order[slot] = moved;
        count += 1u;
    }
    return count;
}

fn slot_from_near(first: u32, index: u32) -> u32 {
    return first + (bkb_order[index] & 0xffu);
}
