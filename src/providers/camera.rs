//! CameraProvider: `camera` of the style and the scene's bounds make a view.

use glam::{DVec3, Mat3, Mat4, Vec2, Vec3};

use crate::config;
use crate::scene::{Camera, Part, Scene, Sphere};

/// The scene's sphere fills this share of the shorter side of the picture.
const FILL: f32 = 0.98;

/// Most vertices of meshes that say how a scene lies. Ours: the axes of larger meshes turn by less than anyone sees.
const MOST_VERTICES: u64 = 1 << 16;

/// Answers what the camera sees.
#[derive(Debug, Clone)]
pub struct CameraProvider {
    style: config::Camera,
    bounds: Sphere,
    /// Turns the scene's axes of largest, middle and smallest extent to x, y and z.
    principal: Mat3,
}

impl CameraProvider {
    /// A provider for this part of a style and a scene.
    pub fn new(style: config::Camera, scene: &Scene) -> CameraProvider {
        let principal = match style.orient {
            config::Orient::Default => Mat3::IDENTITY,
            config::Orient::Principal => {
                let atoms = scene.molecule.drawn_balls().map(|(center, _)| center);
                principal_axes(atoms.chain(vertices(scene, MOST_VERTICES)))
            }
        };
        CameraProvider { style, bounds: scene.bounding_sphere(), principal }
    }

    /// Premultiplied linear background; transparent where asked.
    pub fn background(&self, transparent: bool) -> [f32; 4] {
        if transparent {
            return [0.0; 4];
        }
        let [r, g, b, a] = self.style.bgcolor.to_linear();
        [r * a, g * a, b * a, a]
    }

    /// 2 to the power of the exposure.
    pub fn exposure_factor(&self) -> f32 {
        self.style.exposure.exp2() as f32
    }

    /// Whether meshes are all of the scene and lie flat, and their picture of this size is a line of less than a pixel.
    pub fn sees_edge_on(&self, scene: &Scene, size_px: [u32; 2]) -> bool {
        if scene.assembly.is_empty() || !scene.molecule.atoms.is_empty() {
            return false;
        }
        let camera = self.camera(size_px);
        let size = Vec2::new(size_px[0] as f32, size_px[1] as f32);
        let in_picture = |position: Vec3| {
            let place = camera.view_from_world.transform_point3(position);
            let depth = if camera.orthographic { 1.0 } else { (-place.z).max(camera.near) };
            place.truncate() / depth / camera.half_extent * 0.5 * size
        };
        let mut places = vertices(scene, MOST_VERTICES).map(in_picture);
        let Some(first) = places.next() else { return false };
        let places: Vec<Vec2> = places.map(|place| place - first).collect();
        let along = places.iter().copied().fold(Vec2::ZERO, |a, b| if b.length() > a.length() { b } else { a });
        let across = along.perp().normalize_or_zero();
        let sides = places
            .iter()
            .map(|place| place.dot(across))
            .fold((0.0f32, 0.0f32), |(low, high), side| (low.min(side), high.max(side)));
        sides.1 - sides.0 < 1.0
    }

    /// The camera for a picture of this size.
    pub fn camera(&self, size_px: [u32; 2]) -> Camera {
        self.turned(size_px, 0.0)
    }

    /// The same with the scene turned by `turn_rad` about the upright axis through the middle of its sphere,
    /// counter-clockwise as seen from above.
    pub fn turned(&self, size_px: [u32; 2], turn_rad: f32) -> Camera {
        let aspect = size_px[0].max(1) as f32 / size_px[1].max(1) as f32;
        let radius = self.bounds.radius.max(f32::MIN_POSITIVE);
        let center = self.principal * self.bounds.center;
        // The whole sphere fits the shorter side.
        let tangent_y = (0.5 * self.style.fov.to_radians()).tan() as f32;
        let tangent_fit = tangent_y * aspect.min(1.0);
        let sine_fit = tangent_fit / (1.0 + tangent_fit * tangent_fit).sqrt();
        let framing_distance = radius / (sine_fit * FILL);

        let place = |p: [f64; 3]| center + DVec3::from_array(p).as_vec3() * radius;
        let target = self.style.target.map_or(center, place);
        let position = self.style.position.map_or(target + Vec3::Z * framing_distance, place);
        let distance = position.distance(target).max(1e-6 * radius);
        let toward = (target - position).try_normalize().unwrap_or(Vec3::NEG_Z);
        let up = self.style.up.map_or(Vec3::Y, |up| DVec3::from_array(up).normalize_or(DVec3::Y).as_vec3());
        let upright = up;
        // An up along the view says nothing: take another.
        let up = if up.cross(toward).length_squared() < 1e-8 { Vec3::new(0.0, toward.z, -toward.y) } else { up };
        let up = if up.cross(toward).length_squared() < 1e-8 { Vec3::Z } else { up };
        let view_from_turned = glam::camera::rh::view::look_to_mat4(position, toward, up);
        let turn =
            Mat4::from_translation(center) * Mat4::from_axis_angle(upright, turn_rad) * Mat4::from_translation(-center);
        let view_from_turned = if turn_rad == 0.0 { view_from_turned } else { view_from_turned * turn };
        let zoom = self.style.zoom as f32;
        let half_height = if self.style.orthographic {
            // What the perspective camera would show at the target's distance.
            let fit =
                if self.style.position.is_some() { distance * tangent_y } else { radius / (FILL * aspect.min(1.0)) };
            fit / zoom
        } else {
            tangent_y / zoom
        };
        // Outlines and impostors reach beyond the sphere by less than a tenth of it.
        let depth = (center - position).dot(toward);
        let least = 1e-3 * radius;
        let mut near = depth - 1.1 * radius;
        let mut far = (depth + 1.1 * radius).max(2.0 * least);
        let mut view_from_world = view_from_turned * Mat4::from_mat3(self.principal);
        if self.style.orthographic && near < least {
            // Parallel rays have no eye that things could lie behind: step back until all lies in front.
            view_from_world = Mat4::from_translation(Vec3::Z * (near - least)) * view_from_world;
            far += least - near;
        }
        near = near.max(least);
        Camera {
            view_from_world,
            half_extent: Vec2::new(half_height * aspect, half_height),
            orthographic: self.style.orthographic,
            near,
            far,
        }
    }
}

/// Vertices of all parts where they are drawn, at most so many, each as far from the next in the order of the scene.
fn vertices(scene: &Scene, most: u64) -> impl Iterator<Item = Vec3> {
    let assembly = &scene.assembly;
    let positions = |part: &Part| &assembly.shapes[part.shape as usize].positions;
    let total: u64 = assembly.parts.iter().map(|part| positions(part).len() as u64).sum();
    let step = total.div_ceil(most).max(1);
    let mut next = 0;
    assembly.parts.iter().flat_map(move |part| {
        let (positions, first) = (positions(part), next);
        let num_taken = (positions.len() as u64).saturating_sub(first).div_ceil(step);
        next = first + num_taken * step - positions.len() as u64;
        (0..num_taken).map(move |i| part.world_from_shape.transform_point3(positions[(first + i * step) as usize]))
    })
}

/// Rotation that turns the directions of largest, middle and smallest spread of `positions` to x, y and z, each axis
/// kept as close to its own as it can be. Identity where the spreads do not differ by a tenth, as in a ball.
fn principal_axes(positions: impl Iterator<Item = Vec3>) -> Mat3 {
    let points: Vec<DVec3> = positions.map(Vec3::as_dvec3).collect();
    let count = points.len().max(1) as f64;
    let mean = points.iter().sum::<DVec3>() / count;
    let mut spread = [[0.0f64; 3]; 3];
    for point in &points {
        let off = (*point - mean).to_array();
        for (row, a) in spread.iter_mut().zip(off) {
            for (cell, b) in row.iter_mut().zip(off) {
                *cell += a * b / count;
            }
        }
    }
    let (values, vectors) = symmetric_eigen(spread);
    let mut axes: Vec<(f64, DVec3)> = values.into_iter().zip(vectors).collect();
    axes.sort_by(|a, b| b.0.total_cmp(&a.0));
    if axes[0].0 <= 1.21 * axes[2].0 {
        return Mat3::IDENTITY;
    }
    let x = axes[0].1 * axes[0].1.x.signum();
    let z = axes[2].1 * axes[2].1.z.signum();
    let y = z.cross(x);
    Mat3::from_cols(x.as_vec3(), y.as_vec3(), z.as_vec3()).transpose()
}

/// Eigenvalues and unit eigenvectors of a symmetric matrix, by cyclic Jacobi rotations [Golub2013 §8.5].
fn symmetric_eigen(mut m: [[f64; 3]; 3]) -> ([f64; 3], [DVec3; 3]) {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..16 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q].abs() < 1e-300 {
                continue;
            }
            let theta = 0.5 * (m[q][q] - m[p][p]) / m[p][q];
            let t = if theta == 0.0 { 1.0 } else { theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt()) };
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut m {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            let (old_p, old_q) = (m[p], m[q]);
            m[p] = std::array::from_fn(|k| c * old_p[k] - s * old_q[k]);
            m[q] = std::array::from_fn(|k| s * old_p[k] + c * old_q[k]);
            for row in &mut v {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
        }
    }
    let column = |j: usize| DVec3::new(v[0][j], v[1][j], v[2][j]).normalize_or(DVec3::X);
    ([m[0][0], m[1][1], m[2][2]], [column(0), column(1), column(2)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::mesh::{RawMesh, RawPart, RawShape};

    fn provider(change: impl FnOnce(&mut config::Camera)) -> CameraProvider {
        let mut style = config::Camera::new(&config::Values::defaults(config::camera::PARAMS));
        change(&mut style);
        let bounds = Sphere { center: Vec3::new(1.0, 2.0, 3.0), radius: 5.0 };
        CameraProvider { style, bounds, principal: Mat3::IDENTITY }
    }

    #[test]
    fn the_whole_sphere_is_framed_at_any_aspect() {
        for orthographic in [false, true] {
            for size in [[1000, 1000], [1920, 1080], [300, 1200]] {
                let camera = provider(|style| style.orthographic = orthographic).camera(size);
                let center = camera.view_from_world.transform_point3(Vec3::new(1.0, 2.0, 3.0));
                let shorter = camera.half_extent.min_element();
                let reach = if orthographic {
                    5.0 / shorter
                } else {
                    let sine = 5.0 / -center.z;
                    sine / (1.0 - sine * sine).sqrt() / shorter
                };
                assert!((0.9..=1.0).contains(&reach), "{orthographic} {size:?}: {reach}");
                assert!(camera.near > 0.0 && camera.near < -center.z - 5.0 && camera.far > -center.z + 5.0);
            }
        }
    }

    #[test]
    fn the_default_looks_along_minus_z() {
        let camera = provider(|_| ()).camera([100, 100]);
        let toward = camera.view_from_world.inverse().transform_vector3(Vec3::NEG_Z);
        assert!((toward - Vec3::NEG_Z).length() < 1e-6);
    }

    #[test]
    fn an_orthographic_camera_within_the_scene_shows_all_of_it() {
        let camera = provider(|style| {
            style.orthographic = true;
            style.position = Some([0.0, 0.0, 0.1]);
        })
        .camera([100, 100]);
        let center = camera.view_from_world.transform_point3(Vec3::new(1.0, 2.0, 3.0));
        assert!(camera.near < -center.z - 5.0, "{camera:?}");
    }

    #[test]
    fn a_bounded_sample_of_vertices_spans_all_parts() {
        let mut scene = Scene::from_bytes("a.xyz", b"1\n\nC 0 0 0\n").expect("an atom");
        let shape = |count: u32| RawShape {
            // A zigzag, so that each vertex is in a triangle of its own size.
            positions: (0..count).map(|i| DVec3::new(f64::from(i), f64::from(i % 2) * 0.3, 0.0)).collect(),
            triangles: (2..count).map(|i| [i - 2, i - 1, i]).collect(),
            ..RawShape::default()
        };
        let part = |shape: u32, y: f64| RawPart {
            shape,
            material: None,
            name: String::new(),
            path: String::new(),
            file_from_shape: glam::DAffine3::from_translation(DVec3::Y * y),
        };
        let raw = RawMesh {
            shapes: vec![shape(3), shape(40)],
            parts: (0..50).map(|i| part(i % 2, f64::from(i))).collect(),
            materials: Vec::new(),
        };
        let assembly = crate::scene::Assembly::build(raw, 0, &mut crate::scene::Report::default());
        scene.assembly = assembly.expect("triangles");
        let total: usize =
            scene.assembly.parts.iter().map(|part| scene.assembly.shapes[part.shape as usize].positions.len()).sum();
        for most in [1, 7, 100, 1000, 10_000] {
            let taken = vertices(&scene, most).count();
            assert!(taken <= most as usize && taken >= total.min(most as usize / 2).max(1), "{taken} of {most}");
        }
        // Every part of the larger shape is met, and each vertex once where there is no bound.
        let ys: std::collections::BTreeSet<i32> = vertices(&scene, 100).map(|p| p.y.floor() as i32).collect();
        assert!(ys.len() >= 25, "{ys:?}");
        assert_eq!(vertices(&scene, u64::MAX).count(), total);
    }

    #[test]
    fn a_flat_thing_turns_to_the_camera() {
        let points = (0..100).map(|i| Vec3::new(0.0, (i % 10) as f32, (i / 10) as f32 * 3.0));
        let turn = principal_axes(points);
        let normal = turn * Vec3::X;
        assert!(normal.z.abs() > 0.999, "{normal}");
        assert!((turn * Vec3::Z).x.abs() > 0.999);
        assert!((turn.determinant() - 1.0).abs() < 1e-5);
    }
}
