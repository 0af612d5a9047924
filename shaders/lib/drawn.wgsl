// Which objects a pass leaves out, by their materials: DRAWN, a constant of each pipeline, is one of these.
const DRAWN_ALL: u32 = 0u;
const DRAWN_OPAQUE: u32 = 1u;
const DRAWN_LAYERS: u32 = 2u;

fn is_left_out(material: u32) -> bool {
    if DRAWN == DRAWN_ALL { return false; }
    let opacity = materials[material].opacity;
    return (opacity < 1.0) != (DRAWN == DRAWN_LAYERS) || opacity <= 0.0;
}
