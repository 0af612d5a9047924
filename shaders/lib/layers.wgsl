// Some rows of a picture whose layers are drawn at once.

struct LayerBand {
    // Width of what is drawn, in pixels.
    width: u32,
    // Pixels before the band's first row.
    first_pixel: u32,
    // Pixels of the band.
    num_pixels: u32,
    // Fragments that the pool holds.
    capacity: u32,
}

// Whether a list lies within the pool; starts beyond it may be as large as words are.
fn fits(layers: LayerBand, start: u32, count: u32) -> bool {
    return count <= layers.capacity && start <= layers.capacity - count;
}
