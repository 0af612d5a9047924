// Puts the list of a pixel in order, from near to far, equal depths by their ids: for what binds `layer_pool`.

fn is_before(a: vec2<u32>, b: vec2<u32>) -> bool {
    // Depths are positive: their bits are in their order.
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// Sorts by insertion at falling distances [Shell1959, throughout] [Ciura2001, throughout]: in place, quick for few and for many.
fn sort_layers(start: u32, count: u32) {
    var gap = 1u;
    if count > 4u { gap = 4u; }
    if count > 10u { gap = 10u; }
    if count > 23u { gap = 23u; }
    if count > 57u { gap = 57u; }
    if count > 132u { gap = 132u; }
    if count > 301u { gap = 301u; }
    loop {
        for (var i = gap; i < count; i++) {
            let moved = layer_pool[start + i];
            var j = i;
            while j >= gap {
                let other = layer_pool[start + j - gap];
                if !is_before(moved, other) { break; }
                layer_pool[start + j] = other;
                j -= gap;
            }
            layer_pool[start + j] = moved;
        }
        if gap <= 1u { break; }
        switch gap {
            case 301u: { gap = 132u; }
            case 132u: { gap = 57u; }
            case 57u: { gap = 23u; }
            case 23u: { gap = 10u; }
            case 10u: { gap = 4u; }
            default: { gap = 1u; }
        }
    }
}
