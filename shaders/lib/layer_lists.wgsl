// The lists of all pixels, once they are written: for what binds `layers`, `layer_ends` and `layer_runs`.

fn list_of(pixel: u32) -> LayerList {
    var start = 0u;
    if pixel % RUN == 0u { start = layer_runs[pixel / RUN]; } else { start = layer_ends[pixel - 1u]; }
    return list_between(layers, start, layer_ends[pixel]);
}
