// The list of a pixel, and how it is sorted: from near to far, equal depths by their ids.

@group(2) @binding(0) var<uniform> layers: LayerBand;
@group(2) @binding(1) var<storage, read_write> layer_counts: array<u32>;
@group(2) @binding(2) var<storage, read_write> layer_starts: array<u32>;
@group(2) @binding(3) var<storage, read_write> layer_pool: array<vec2<u32>>;

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
