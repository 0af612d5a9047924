// Which objects a pass leaves out, by their materials: DRAWN is a constant of each pipeline.

fn is_left_out(material: u32) -> bool {
    if DRAWN == DRAWN_ALL { return false; }
    let opacity = materials[material].opacity;
    return is_layered(opacity) != (DRAWN == DRAWN_LAYERS) || opacity <= 0.0;
}
