// The order of lists that no network sorts: by insertion at falling distances [Shell1959, throughout] [Ciura2001, throughout].
fn sort(list: LayerList) {
    let start = list.start;
    var gap = 23u;
    if list.count > 57u { gap = 57u; }
    if list.count > 132u { gap = 132u; }
    if list.count > 301u { gap = 301u; }
    loop {
        for (var i = gap; i < list.count; i++) {
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
