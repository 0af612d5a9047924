// Exact ray casts of the two primitives. A miss has t < 0.

struct Hit {
    t: f32,
    // Unit normal of the surface, outwards.
    normal: vec3<f32>,
}

const MISS: f32 = -1.0;

// Entry and exit of a ray and a sphere, as (near, far); near > far on a miss.
// The discriminant is taken from the point of closest approach, which keeps its digits far from the
// sphere [RTGems §7, eq. 8].
fn sphere_span(ray: Ray, center: vec3<f32>, radius: f32) -> vec2<f32> {
    let to_center = center - ray.origin;
    let inverse = 1.0 / dot(ray.direction, ray.direction);
    let middle = dot(to_center, ray.direction) * inverse;
    let off = to_center - middle * ray.direction;
    let left = radius * radius - dot(off, off);
    if left < 0.0 { return vec2<f32>(1.0, -1.0); }
    let half = sqrt(left * inverse);
    return vec2<f32>(middle - half, middle + half);
}

// The nearest depth of a span beyond `near`; the far side where the eye is inside.
fn first_beyond(span: vec2<f32>, near: f32) -> f32 {
    if span.x > span.y { return MISS; }
    if span.x > near { return span.x; }
    return select(MISS, span.y, span.y > near);
}

fn sphere_normal(ray: Ray, t: f32, center: vec3<f32>, radius: f32) -> vec3<f32> {
    return (ray.origin + t * ray.direction - center) / radius;
}

// Entry and exit of a ray and a truncated cone from `a` (radius_a) to `b` (radius_b) with flat caps,
// as (near, far); near > far on a miss. Equal radii make a cylinder.
// Works from the point nearest to the axis, for the same reason as the sphere.
fn cone_span(ray: Ray, a: vec3<f32>, b: vec3<f32>, radius_a: f32, radius_b: f32) -> vec2<f32> {
    let none = vec2<f32>(1.0, -1.0);
    let axis_full = b - a;
    let height = length(axis_full);
    let axis = axis_full / height;
    // Move the ray's start next to the cone.
    let shift = dot(0.5 * (a + b) - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    let start = ray.origin + shift * ray.direction - a;
    let start_axial = dot(start, axis);
    let slope_axial = dot(ray.direction, axis);
    let start_flat = start - start_axial * axis;
    let slope_flat = ray.direction - slope_axial * axis;
    let taper = (radius_b - radius_a) / height;
    let radius_start = radius_a + taper * start_axial;
    let radius_slope = taper * slope_axial;
    // |start_flat + s slope_flat|^2 = (radius_start + s radius_slope)^2
    let qa = dot(slope_flat, slope_flat) - radius_slope * radius_slope;
    let qb = dot(start_flat, slope_flat) - radius_start * radius_slope;
    let qc = dot(start_flat, start_flat) - radius_start * radius_start;
    // Between the caps.
    var enter = -1e30;
    var leave = 1e30;
    if abs(slope_axial) > 1e-12 {
        let s0 = -start_axial / slope_axial;
        let s1 = (height - start_axial) / slope_axial;
        enter = min(s0, s1);
        leave = max(s0, s1);
    } else if start_axial < 0.0 || start_axial > height {
        return none;
    }
    if qa > 1e-12 {
        let left = qb * qb - qa * qc;
        if left < 0.0 { return none; }
        let root = sqrt(left);
        enter = max(enter, (-qb - root) / qa);
        leave = min(leave, (-qb + root) / qa);
    } else if qc > 0.0 {
        return none;
    }
    if enter > leave { return none; }
    return vec2<f32>(enter + shift, leave + shift);
}

// Outward normal of a cylinder at depth t: of its side, or of a cap where the hit lies on one.
fn cylinder_normal(ray: Ray, t: f32, a: vec3<f32>, b: vec3<f32>, radius: f32) -> vec3<f32> {
    let axis_full = b - a;
    let height = length(axis_full);
    let axis = axis_full / height;
    let from_a = ray.origin + t * ray.direction - a;
    let along = dot(from_a, axis);
    let flat = from_a - along * axis;
    // Rounding leaves the point beside both surfaces: it is on the nearer one.
    if abs(min(along, height - along)) < abs(radius - length(flat)) {
        return select(axis, -axis, along < 0.5 * height);
    }
    return normalize(flat);
}
