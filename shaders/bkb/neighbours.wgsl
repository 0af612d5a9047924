// Which fragments of neighbouring pixels belong to the same surface [Murray2016 §5.1].
// BRUTE_FORCE looks among all fragments of a pixel, after [Carnecky2013, throughout], instead of in one bucket.

struct BkbFragment {
    // Its slot within its pixel.
    slot: u32,
    normal: vec3<f32>,
    // 0 at the near end, 1 at the far end.
    depth: f32,
}

fn fragment_at(first: u32, slot: u32) -> BkbFragment {
    let normal = unpack_normal_word(bkb_d[(first + slot) * 2u + 1u]);
    return BkbFragment(slot, normal, f32(bkb_z[first + slot] & 0xffffu) / DEPTH_STEPS);
}

// Whether the second pass found the fragment: no normal is 0.
fn is_stored(first: u32, slot: u32) -> bool {
    return bkb_d[(first + slot) * 2u + 1u] != 0u;
}

// How little two fragments look like one surface: depth as it is stored, for the paper names no unit.
fn unlikeness(a: BkbFragment, b: BkbFragment) -> f32 {
    let apart = a.depth - b.depth;
    return (1.0 - dot(a.normal, b.normal)) + apart * apart;
}

// The fragments of a pixel among which those of a shape are looked for.
fn candidates(first: u32, shape: u32) -> vec2<u32> {
    if BRUTE_FORCE { return vec2<u32>(0u, bkb.k - 1u); }
    return bucket_of(first, shape);
}

// The slot of the candidate that is most like a fragment, of equal ones the first; EMPTY where there is none.
fn most_like(first: u32, range: vec2<u32>, fragment: BkbFragment) -> u32 {
    var best = EMPTY;
    var least = 1e9;
    for (var slot = range.x; slot <= range.y && bkb_z[first + slot] != EMPTY; slot++) {
        let error = unlikeness(fragment, fragment_at(first, slot));
        if is_stored(first, slot) && error < least {
            least = error;
            best = slot;
        }
    }
    return best;
}

struct Neighbour {
    is_there: bool,
    normal: vec3<f32>,
}

// The neighbour of a fragment in the pixel that begins at slot `first`, or none: where no candidate is, or where the best one has
// a better neighbour itself in the fragment's own pixel, which begins at `own_first` and has its candidates in `own_range`.
fn neighbour(first: u32, shape: u32, fragment: BkbFragment, own_first: u32, own_range: vec2<u32>) -> Neighbour {
    let slot = most_like(first, candidates(first, shape), fragment);
    if slot == EMPTY { return Neighbour(false, vec3<f32>(0.0)); }
    let found = fragment_at(first, slot);
    let is_mutual = !REVERSE_CHECK || most_like(own_first, own_range, found) == fragment.slot;
    return Neighbour(is_mutual, found.normal);
}
