// Hull outlines: back faces of an enlarged copy [Prost2016 §4.1].

// By how much a sphere of `radius` at `center` grows so that its outline in the picture moves by
// `width_px`, plus `width_world`. The angle of the silhouette cone grows by the angle of the pixels,
// at the mean scale of the picture around the sphere's rim: pixels are stretched by 1/cos^2 away
// from the axis along the radius and by 1/cos across it.
// A line in pixels is never wider than HULL_SHARE of the radius that it outlines: on a molecule seen from
// far it thins out, where it would turn everything black (ours).
const HULL_SHARE: f32 = 0.4;

fn hull_radius(view: View, center: vec3<f32>, radius: f32, width_px: f32, width_world: f32) -> f32 {
    let wide = radius + width_world;
    if ORTHOGRAPHIC {
        return wide + min(width_px * view.pixel_view, HULL_SHARE * wide);
    }
    let distance = length(center);
    if distance <= wide { return wide; }
    let cosine = clamp(-center.z / distance, 0.2, 1.0);
    let sine = wide / distance;
    let tangent = sine / sqrt(max(1.0 - sine * sine, 1e-6));
    let line = width_px * view.pixel_view * 0.5 * (cosine + cosine * cosine);
    let grown = tangent + min(line, HULL_SHARE * tangent);
    return distance * grown / sqrt(1.0 + grown * grown);
}
