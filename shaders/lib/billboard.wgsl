// Tight quads around the primitives, as clip positions of their corners (sign = +-1 in x and y).

// Covers exactly the silhouette cone of a sphere: a square across its centre, turned to the eye.
// The whole picture where the eye is in the sphere or close to it.
fn sphere_quad(view: View, center: vec3<f32>, radius: f32, sign: vec2<f32>) -> vec4<f32> {
    if ORTHOGRAPHIC {
        return clip_from_view(view, center + vec3<f32>(sign * radius, 0.0));
    }
    let distance_squared = dot(center, center);
    let left = distance_squared - radius * radius;
    if left <= 0.02 * distance_squared {
        return vec4<f32>(sign, 0.5, 1.0);
    }
    let toward = center * inverseSqrt(distance_squared);
    let side = normalize(cross(toward, select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(toward.y) > 0.9)));
    let up = cross(side, toward);
    // The cone's half width in the plane of the centre: r d / sqrt(d^2 - r^2).
    let half = radius * sqrt(distance_squared / left);
    return clip_from_view(view, center + half * (sign.x * side + sign.y * up));
}

// Covers a cylinder: a rectangle through its axis, turned to the eye. In that plane the planes from the
// eye that touch the side lie r D / sqrt(D^2 - r^2) off the axis, D the eye's distance to the axis.
// Where the eye looks along the axis a sphere's square around it all is tighter and always right.
fn cylinder_quad(view: View, a: vec3<f32>, b: vec3<f32>, radius: f32, sign: vec2<f32>) -> vec4<f32> {
    let middle = 0.5 * (a + b);
    let axis_full = b - a;
    let height = length(axis_full);
    let axis = axis_full / height;
    let around = sqrt(0.25 * height * height + radius * radius);
    if ORTHOGRAPHIC {
        let flat = sqrt(max(1.0 - axis.z * axis.z, 0.0));
        if flat < 0.5 { return sphere_quad(view, middle, around, sign); }
        let side = vec3<f32>(-axis.y, axis.x, 0.0) / flat;
        // A cap's rim sticks out along the axis by r |axis.z| / flat in this plane.
        let reach = 0.5 * height + radius * abs(axis.z) / flat;
        return clip_from_view(view, middle + sign.x * radius * side + sign.y * reach * axis);
    }
    let foot = dot(-a, axis);
    let from_axis = -(a + foot * axis);
    let eye_distance = length(from_axis);
    if eye_distance < 1.5 * radius || eye_distance < 0.5 * length(middle) {
        return sphere_quad(view, middle, around, sign);
    }
    let side = cross(axis, from_axis / eye_distance);
    let half = radius * eye_distance / sqrt(eye_distance * eye_distance - radius * radius);
    // Cap rims nearer to or farther from the eye move along the axis by D / (D -+ r).
    let grow = eye_distance / (eye_distance - radius);
    let shrink = eye_distance / (eye_distance + radius);
    let low = -foot;
    let high = height - foot;
    let start = min(low * grow, low * shrink);
    let end = max(high * grow, high * shrink);
    let along = select(start, end, sign.y > 0.0);
    return clip_from_view(view, a + (foot + along) * axis + sign.x * half * side);
}
