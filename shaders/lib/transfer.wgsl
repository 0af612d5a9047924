// Transfer functions as nodes of a grid: opacity by the size of the curvature and depth, a factor on light by the curvature.
// A table holds OPACITY_TEXELS for opacity, each with the four nodes of one cell, then a texel for each node of the colour.

const OPACITY_CELLS: vec2<u32> = vec2<u32>(64u, 16u);
const OPACITY_TEXELS: u32 = 1024u;
const COLOR_CELLS: u32 = 64u;

// `curvature` and `depth` in 0..1, near at 0.
fn opacity_transfer(tables: texture_2d<u32>, table: u32, curvature: f32, depth: f32) -> f32 {
    let place = clamp(vec2<f32>(curvature, depth), vec2<f32>(0.0), vec2<f32>(1.0)) * vec2<f32>(OPACITY_CELLS);
    let cell = min(vec2<u32>(place), OPACITY_CELLS - 1u);
    let within = place - vec2<f32>(cell);
    let nodes = bitcast<vec4<f32>>(object_texel(tables, table + cell.y * OPACITY_CELLS.x + cell.x));
    return mix(mix(nodes.x, nodes.y, within.x), mix(nodes.z, nodes.w, within.x), within.y);
}

// `kappa` in -1..1, convex at -1.
fn color_transfer(tables: texture_2d<u32>, table: u32, kappa: f32) -> vec3<f32> {
    let place = clamp(0.5 * kappa + 0.5, 0.0, 1.0) * f32(COLOR_CELLS);
    let cell = min(u32(place), COLOR_CELLS - 1u);
    let first = table + OPACITY_TEXELS + cell;
    let a = bitcast<vec4<f32>>(object_texel(tables, first)).rgb;
    let b = bitcast<vec4<f32>>(object_texel(tables, first + 1u)).rgb;
    return mix(a, b, place - f32(cell));
}
