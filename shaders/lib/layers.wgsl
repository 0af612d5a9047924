// Some rows of a picture whose layers are drawn at once, and the lists of their pixels.

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

// Pixels whose lists follow each other in the pool, so that the end of each is the start of the next.
const RUN: u32 = 32u;

fn runs_of(layers: LayerBand) -> u32 {
    return (layers.num_pixels + RUN - 1u) / RUN;
}

// Where the list of a pixel lies in the pool.
struct LayerList {
    start: u32,
    count: u32,
}

// The list between two places; none where the pool does not hold it: it grows, and all is drawn again. Places beyond it may be as
// large as words are, and larger.
fn list_between(layers: LayerBand, start: u32, end: u32) -> LayerList {
    if start > end || end > layers.capacity { return LayerList(0u, 0u); }
    return LayerList(start, end - start);
}
