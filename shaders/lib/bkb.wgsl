// The bucketed k-buffer of some rows of a picture [Murray2016 §4]: k slots for each pixel, of Z, B and D.
//
// Z: the k nearest fragments, 16 bits of depth above 16 bits of shape, from near to far; later the two halves are swapped and
//    the list is in the order of shapes. Free slots are EMPTY and come last.
// B: buckets, one for each shape of the pixel: 16 bits of shape, 8 bits each for its first and last slot in Z.
//    A hash table of k slots: bucket b lies at b mod k, or in the next free slot after that.
// D: two words for each slot of Z: colour, and normal.

struct BkbBand {
    // Size of what is drawn, in pixels.
    width: u32,
    height: u32,
    // First row that is stored, and how many: those that are drawn and, within the picture, one on each side.
    first_row: u32,
    num_rows: u32,
    // Rows that are drawn.
    first_drawn: u32,
    end_drawn: u32,
    // Slots of a pixel.
    k: u32,
    // Shapes are numbered through: atoms, connectors from here, parts of meshes from there.
    first_connector: u32,
    first_part: u32,
    // Depth t is stored as (t - near) * depth_scale, rounded.
    near: f32,
    depth_scale: f32,
    // What curvature is multiplied by before tanh.
    curvature_scale: f32,
}

const EMPTY: u32 = 0xffffffffu;

// The largest depth; one less than 16 bits hold, so that no fragment is EMPTY.
const DEPTH_STEPS: f32 = 65534.0;

// The first slot of a pixel.
fn first_slot(band: BkbBand, at: vec2<u32>) -> u32 {
    return ((at.y - band.first_row) * band.width + at.x) * band.k;
}

// Depth as it is stored: 16 bits, even steps between the near and the far end of what is drawn.
fn stored_depth(band: BkbBand, t: f32) -> u32 {
    return u32(clamp((t - band.near) * band.depth_scale, 0.0, DEPTH_STEPS) + 0.5);
}
