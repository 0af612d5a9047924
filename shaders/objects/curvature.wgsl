// Transparency by curvature: what is flat clears away, what is curved and the rims stay.
// Another shader lights the surface; this one weighs its light and says how much of what is behind it covers.
// Source: [Murray2016 §5], with the exact curvature of the surface in place of differences between pixels, and rims of a width
// of one's choice in place of pixels without a neighbour.

struct CurvatureMaterial {
    // Of the scene's sphere, in world space, and its radius.
    center_world: vec3<f32>,
    radius: f32,
    // Curvature, over scene units, is read as tanh(gain * kappa).
    gain: f32,
    // What curvature rims count as, 0..1.
    contour: f32,
    // Their width: pixels plus scene units.
    contour_px: f32,
    contour_world: f32,
    // How much of the curvature is that of the picture, which grows towards silhouettes, 0..1.
    emphasis: f32,
    // Depth of the scene's sphere at which the transfer function begins, and one over the depth to its end, both in 0..1 of it.
    depth_start: f32,
    depth_scale: f32,
    // Factor on the opacity.
    opacity: f32,
    // First texel of its transfer functions.
    table: u32,
    // 1 where curvature is found from neighbouring pixels, 0 where it is the surface's own.
    from_screen: u32,
    _pad1: u32,
    _pad2: u32,
}

// Where a fragment stands in the transfer functions.
struct Bend {
    // Signed, -1 convex to 1 concave.
    kappa: f32,
    // 0 near to 1 far.
    depth: f32,
    // Share of the sample's footprint that a rim takes, 0..1.
    rim: f32,
}

// Power of the foreshortening, and the least cosine that it is taken of.
const FORESHORTENING: f32 = 0.4;
const LEAST_FACING: f32 = 0.05;

// Curvature as the picture has it [Vergne2009 §3]: of the normal's two coordinates in the picture over a power of the third.
fn curvature_of_picture(s: Surface, kappa: f32) -> f32 {
    let facing = max(dot(s.normal_view, s.to_viewer), LEAST_FACING);
    let across = s.normal_view - facing * s.to_viewer;
    // Change of the cosine over a scene unit across the line of sight.
    let step = vec2<f32>(1.0, -1.0) * facing_step(s) / max(view.footprint_px * pixel_world_at(s), 1e-30);
    let turn = dot(across.xy, step);
    return (kappa + FORESHORTENING * turn / facing) / pow(facing, FORESHORTENING);
}

fn pixel_world_at(s: Surface) -> f32 {
    return view.pixel_view * mix(-s.position_view.z, 1.0, view.orthographic);
}

// Depth in the transfer functions of a depth along the view.
fn curvature_depth(m: CurvatureMaterial, t: f32) -> f32 {
    let middle = -to_view(view, m.center_world).z;
    let depth = 0.5 * ((t - middle) / m.radius + 1.0);
    return clamp((depth - m.depth_start) * m.depth_scale, 0.0, 1.0);
}

fn curvature_bend(s: Surface, m: CurvatureMaterial) -> Bend {
    var kappa = s.kappa;
    if CURVATURE_SCREEN && m.from_screen != 0u { kappa = s.kappa_of_screen; }
    if CURVATURE_EMPHASIS && m.emphasis > 0.0 { kappa = mix(kappa, curvature_of_picture(s, kappa), m.emphasis); }
    let signed = tanh(clamp(m.gain * kappa, -20.0, 20.0));
    let width_px = m.contour_px + m.contour_world / pixel_world_at(s);
    // What a box of one footprint sees of a rim so wide to both sides of its line.
    let width_steps = width_px / view.footprint_px;
    let rim = clamp(width_steps - s.rim_steps + 0.5, 0.0, min(2.0 * width_steps, 1.0));
    return Bend(signed, curvature_depth(m, -s.position_view.z), rim);
}

// Linear light of a surface, weighed, and the share of what is behind that it covers. A footprint across the border of a rim sees both
// sides of it: their covers add up, since that of their mean would be another wherever transfer functions are not straight lines (ours).
fn curvature_stylised(m: CurvatureMaterial, color: vec3<f32>, bend: Bend) -> vec4<f32> {
    var cover = opacity_transfer(curvature_tables, m.table, abs(bend.kappa), bend.depth);
    var factor = color_transfer(curvature_tables, m.table, bend.kappa);
    if bend.rim > 0.0 {
        let of_rim = bend.rim * opacity_transfer(curvature_tables, m.table, m.contour, bend.depth);
        let whole = (1.0 - bend.rim) * cover + of_rim;
        factor = mix(factor, color_transfer(curvature_tables, m.table, -m.contour), of_rim / max(whole, 1e-12));
        cover = whole;
    }
    return vec4<f32>(color * factor, m.opacity * cover);
}
