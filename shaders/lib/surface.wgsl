// The visible surface of one pixel, found again from its id by an exact ray cast, with the
// derivatives that anti-alias steps in its shading.

struct Surface {
    position_view: vec3<f32>,
    // Unit, turned to the viewer.
    normal_view: vec3<f32>,
    // Unit.
    to_viewer: vec3<f32>,
    // Linear RGB.
    base_color: vec3<f32>,
    // Changes across one sample's footprint to the right (dx) and down (dy).
    position_dx: vec3<f32>,
    position_dy: vec3<f32>,
    normal_dx: vec3<f32>,
    normal_dy: vec3<f32>,
    to_viewer_dx: vec3<f32>,
    to_viewer_dy: vec3<f32>,
    // Unit, turned to the viewer: the triangle's own where `normal_view` is interpolated.
    facet_view: vec3<f32>,
    // Curvature across its axis: 1 over the radius, 0 where flat.
    bend: f32,
    // Which group of objects (16 bits): of atoms, chain (7 bits) and residue (9).
    group: u32,
    // The object itself: of a triangle its part, where `id` is the triangle's.
    object: u32,
    id: u32,
    // Sum of the principal curvatures as it is seen, negative where convex, over scene units. With CURVATURE alone, as what follows.
    kappa: f32,
    // The same from what neighbouring pixels see, where it is asked for.
    kappa_of_screen: f32,
    // How far the nearest silhouette or crease is in the picture, in samples' footprints.
    rim_steps: f32,
    // How wide the triangle is at most to the right and down, in samples' footprints: between its vertices normals change by one slope.
    // 0 where it is flat, and where the surface bends as its formula says.
    grain_steps: vec2<f32>,
}

// Farther than any rim reaches.
const FAR_STEPS: f32 = 1e9;

// Where a point moves on the tangent plane when its ray moves by `step` [Igehy1999 §3.1].
// On the outline that is infinitely far, yet within a pixel p of it a surface of curvature k turns by
// sqrt(2 p k) only: the plane is never taken as steeper than that (ours).
fn tangent_step(ray: Ray, t: f32, normal: vec3<f32>, bend: f32, step: vec3<f32>, orthographic: f32) -> vec3<f32> {
    let moved = step * mix(t, 1.0, orthographic);
    let least = max(sqrt(0.5 * bend * length(moved)), 1e-4);
    let facing = dot(normal, ray.direction);
    return moved - ray.direction * (dot(normal, moved) / min(facing, -least));
}

// How fast the cosine between surface and view changes for a step to the right and down.
fn facing_step(s: Surface) -> vec2<f32> {
    return vec2<f32>(
        dot(s.normal_dx, s.to_viewer) + dot(s.normal_view, s.to_viewer_dx),
        dot(s.normal_dy, s.to_viewer) + dot(s.normal_view, s.to_viewer_dy),
    );
}

// How far the silhouette of a smooth surface is in the picture, in samples' footprints: near it the cosine goes as the root of
// the distance (ours).
fn silhouette_steps(s: Surface) -> f32 {
    let facing = dot(s.normal_view, s.to_viewer);
    return min(0.5 * facing / max(length(facing_step(s)), 1e-12), FAR_STEPS);
}

fn to_viewer_step(ray: Ray, step: vec3<f32>, orthographic: f32) -> vec3<f32> {
    let inverse = inverseSqrt(dot(ray.direction, ray.direction));
    let toward = ray.direction * inverse;
    return -(step - toward * dot(toward, step)) * inverse * (1.0 - orthographic);
}

// Depth of a surface that the visibility pass saw. On the last ray before the outline this cast may round to a miss;
// the point nearest to the object's middle is then within rounding of the surface.
fn seen_at(ray: Ray, span: vec2<f32>, middle: vec3<f32>) -> f32 {
    let t = first_beyond(span, view.near);
    let nearest = dot(middle - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    return select(t, nearest, t < 0.0);
}

// The surface that `id` names along `ray`. ATOMS, CONNECTORS and MESHES say which kinds the scene has at all.
fn surface_at(ray: Ray, id: u32) -> Surface {
    var s: Surface;
    let index = id & INDEX_MASK;
    var normal = vec3<f32>(0.0);
    var t = 0.0;
    // Curvature of a sphere is 1/r both ways, of a cylinder 1/r across its axis.
    var axis = vec3<f32>(0.0);
    var bend = 0.0;
    var mesh: MeshPoint;
    var is_mesh = false;
    if MESHES && ((!ATOMS && !CONNECTORS) || (id >> 29u) == KIND_MESH) {
        mesh = mesh_point(ray, index);
        is_mesh = true;
        t = mesh.t;
        normal = mesh.normal;
        s.base_color = mesh.base_color;
        s.group = mesh.part & 0xffffu;
    } else if ATOMS && (!CONNECTORS || (id >> 29u) == KIND_ATOM) {
        let atom = atom_at(index);
        let center = to_view(view, atom.position_world);
        t = seen_at(ray, sphere_span(ray, center, atom.radius), center);
        normal = sphere_normal(ray, t, center, atom.radius);
        s.base_color = unpack_linear(atom.color);
        s.group = atom.group;
        bend = 1.0 / atom.radius;
    } else if CONNECTORS {
        let connector = connector_at(index);
        let a = to_view(view, connector.a_world);
        let b = to_view(view, connector.b_world);
        t = seen_at(ray, cone_span(ray, a, b, connector.radius, connector.radius), 0.5 * (a + b));
        normal = cylinder_normal(ray, t, a, b, connector.radius);
        axis = normalize(b - a);
        let along = dot(ray.origin + t * ray.direction - 0.5 * (a + b), axis);
        let half = select(connector.color_a, connector.color_b, along > 0.0);
        s.base_color = unpack_linear(half);
        s.group = half.y >> 16u;
        // A cap is flat.
        bend = select(1.0 / connector.radius, 0.0, abs(dot(normal, axis)) > 0.5);
    }
    // Seen from inside, the surface is turned to the viewer.
    let turned = select(1.0, -1.0, dot(normal, ray.direction) > 0.0);
    normal *= turned;
    s.id = id;
    s.object = id;
    if MESHES && is_mesh { s.object = make_id(KIND_MESH, mesh.part); }
    s.bend = bend;
    s.position_view = ray.origin + t * ray.direction;
    s.normal_view = normal;
    s.facet_view = normal;
    if MESHES && is_mesh { s.facet_view = mesh.facet; }
    s.to_viewer = -normalize(ray.direction);
    let dx = ray_step_dx(view);
    let dy = ray_step_dy(view);
    s.position_dx = tangent_step(ray, t, normal, bend, dx, view.orthographic);
    s.position_dy = tangent_step(ray, t, normal, bend, dy, view.orthographic);
    s.normal_dx = turned * bend * (s.position_dx - axis * dot(axis, s.position_dx));
    s.normal_dy = turned * bend * (s.position_dy - axis * dot(axis, s.position_dy));
    if MESHES && is_mesh {
        s.normal_dx = mesh_normal_step(mesh, s.position_dx);
        s.normal_dy = mesh_normal_step(mesh, s.position_dy);
    }
    s.to_viewer_dx = to_viewer_step(ray, dx, view.orthographic);
    s.to_viewer_dy = to_viewer_step(ray, dy, view.orthographic);
    if CURVATURE {
        // A sphere bends both ways; what is seen from inside is hollow.
        s.kappa = -turned * bend * select(1.0, 2.0, ATOMS && (id >> 29u) == KIND_ATOM);
        s.rim_steps = silhouette_steps(s);
        if MESHES && is_mesh {
            s.kappa = mesh.kappa;
            s.rim_steps = min(s.rim_steps, mesh_crease_steps(mesh, s.position_dx, s.position_dy));
            s.grain_steps = vec2<f32>(mesh_width_steps(mesh, s.position_dx), mesh_width_steps(mesh, s.position_dy));
        }
    }
    return s;
}
