//! The scene in view space, and what a ray meets of it first: a tree of boxes in single precision around exact casts in
//! double.
//!
//! Cost: some 100 bytes a primitive, and 60 to 250 ns a ray a core (300,000 spheres).

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::RayHit;
use obvhs::{Boundable, BvhBuildParams};

use super::hull::Outline;
use super::primitive::{Ray, cone_span, cylinder_normal, sphere_span, triangle_hit};
use crate::scene::mesh::curvature::is_flat;
use crate::scene::{Scene, linear_from_srgb, unpack_normal};

/// How an object looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Linear RGB of the object itself; of a connector, of the half at its first end.
    pub color: DVec3,
    /// Index into the materials.
    pub material: u32,
    /// Which group of objects: chain and residue, 16 bits.
    pub group: u32,
    /// Which selectors of post effects pick it, one bit each.
    pub picks: u32,
}

/// A sphere in view space.
#[derive(Debug, Clone, Copy)]
pub struct Sphere {
    /// Its centre.
    pub center: DVec3,
    /// Its radius in scene units.
    pub radius: f64,
    /// How it looks.
    pub look: Look,
}

/// A cylinder with flat caps in view space, in two halves.
#[derive(Debug, Clone, Copy)]
pub struct Cylinder {
    /// Its ends.
    pub ends: [DVec3; 2],
    /// Its radius in scene units.
    pub radius: f64,
    /// How each half looks; the material is the first one's.
    pub looks: [Look; 2],
}

/// One part of the scene's meshes.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// Index into the parts of the assembly.
    pub part: u32,
    /// How it looks.
    pub look: Look,
    /// Whether the colours of its vertices count.
    pub has_vertex_colors: bool,
}

/// Meshes that are drawn.
#[derive(Debug, Clone)]
pub struct Meshes {
    /// The scene that they are of.
    pub scene: Arc<Scene>,
    /// The parts that are drawn.
    pub parts: Vec<Part>,
}

/// A triangle of a part, around the middle of the world.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corners: [Vec3; 3],
    /// Index into [`Meshes::parts`], and the triangle's place in its shape.
    part: u32,
    index: u32,
}

/// What a ray met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Where, as the ray counts: of a line of sight the depth.
    pub t: f64,
    /// What.
    pub object: Object,
}

impl Hit {
    /// One that comes before all that is met at `t` or beyond.
    pub fn just_before(t: f64) -> Hit {
        Hit { t: t.next_down(), object: Object::Triangle(u32::MAX) }
    }
}

/// A hull outline on a line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlineHit {
    /// How deep it counts.
    pub depth: f64,
    /// Index into the materials.
    pub material: u32,
    /// The object that it is of, as [`Surface::id`] counts.
    pub owner: u64,
}

/// One primitive of a world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Object {
    /// A sphere.
    Sphere(u32),
    /// A cylinder.
    Cylinder(u32),
    /// A triangle.
    Triangle(u32),
}

/// What there is at a point that a ray met.
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    /// In view space.
    pub position: DVec3,
    /// Unit, turned to where the ray came from; between the vertices of a triangle.
    pub normal: DVec3,
    /// The same of the triangle itself.
    pub facet: DVec3,
    /// Linear RGB of the object itself.
    pub color: DVec3,
    /// Index into the materials.
    pub material: u32,
    /// Group of 16 bits; 0 for meshes.
    pub group: u32,
    /// Which selectors of post effects pick it, one bit each.
    pub picks: u32,
    /// Its atom, connector or part, never 0.
    pub id: u64,
    /// 1 over the radius, 0 where flat.
    pub bend: f64,
}

/// A triangle of a part where it is, for who asks more of it than [`Surface`] says.
#[derive(Debug, Clone, Copy)]
pub struct Facet {
    /// In view space.
    pub corners: [DVec3; 3],
    /// Unit normals of its corners, outwards.
    pub normals: [DVec3; 3],
    /// Sum of the principal curvatures at its corners, over scene units; 0 where its normals are equal.
    pub kappa: [f64; 3],
    /// As in [`Bending::creases`](crate::scene::mesh::curvature::Bending::creases).
    pub creases: u8,
}

/// Everything that is drawn, in view space.
pub struct World {
    /// Middle and radius of a ball around all of it.
    center: DVec3,
    radius: f64,
    spheres: Vec<Sphere>,
    cylinders: Vec<Cylinder>,
    triangles: Vec<Triangle>,
    meshes: Option<(Meshes, Vec<Placed>)>,
    tree: Option<Bvh2>,
    outlines: Vec<Outline>,
    outline_tree: Option<Bvh2>,
    /// Of each material whether it lets light through.
    see_through: Vec<bool>,
}

/// Where a part is.
#[derive(Debug, Clone, Copy)]
struct Placed {
    view_from_shape: DAffine3,
    /// For normals, of any length; keeps their side where the part is mirrored.
    normals: DMat3,
}

struct Bounds(Aabb);

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl World {
    /// Builds the trees of all objects, and of the outlines that `outlines` makes of them; `center` is about their middle.
    pub fn new(
        center: DVec3,
        view_from_world: DAffine3,
        spheres: Vec<Sphere>,
        cylinders: Vec<Cylinder>,
        meshes: Option<Meshes>,
        outlines: impl FnOnce(&World) -> Vec<Outline>,
    ) -> World {
        let mut world = World {
            center,
            radius: 0.0,
            spheres,
            cylinders,
            triangles: Vec::new(),
            meshes: None,
            tree: None,
            outlines: Vec::new(),
            outline_tree: None,
            see_through: Vec::new(),
        };
        if let Some(meshes) = meshes {
            world.add_meshes(meshes, view_from_world);
        }
        let corners =
            world.triangles.iter().flat_map(|triangle| triangle.corners).map(|corner| f64::from(corner.length()));
        let balls = world.spheres.iter().map(|ball| ball.center.distance(center) + ball.radius);
        let rods = world.cylinders.iter().flat_map(|rod| rod.ends.map(|end| end.distance(center) + rod.radius * 1.5));
        world.radius = corners.chain(balls).chain(rods).fold(f64::MIN_POSITIVE, f64::max);
        let slack = world.radius * 1e-6;
        let balls =
            world.spheres.iter().map(|ball| boxed(ball.center - ball.radius, ball.center + ball.radius, center, slack));
        let rods = world.cylinders.iter().map(|rod| {
            let [a, b] = rod.ends;
            boxed(a.min(b) - rod.radius, a.max(b) + rod.radius, center, slack)
        });
        let triangles = world.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.corners.map(Vec3::as_dvec3);
            boxed(a.min(b).min(c), a.max(b).max(c), DVec3::ZERO, slack)
        });
        let bounds: Vec<Bounds> = balls.chain(rods).chain(triangles).collect();
        world.tree = tree(&bounds);
        world.outlines = outlines(&world);
        let bounds: Vec<Bounds> = world
            .outlines
            .iter()
            .map(|outline| {
                let (low, high) = outline.bounds();
                boxed(low, high, center, slack)
            })
            .collect();
        world.outline_tree = tree(&bounds);
        let corners = world
            .outlines
            .iter()
            .map(Outline::bounds)
            .map(|(low, high)| (low - center).abs().max((high - center).abs()).length());
        world.radius = corners.fold(world.radius, f64::max);
        world
    }

    fn add_meshes(&mut self, meshes: Meshes, view_from_world: DAffine3) {
        let assembly = &meshes.scene.assembly;
        let mut placed = Vec::with_capacity(meshes.parts.len());
        for (number, part) in (0..).zip(&meshes.parts) {
            let of_scene = &assembly.parts[part.part as usize];
            let world_from_shape = DAffine3::from_mat4(glam::Mat4::from(of_scene.world_from_shape).as_dmat4());
            let view_from_shape = view_from_world * world_from_shape;
            let [x, y, z] =
                [view_from_shape.matrix3.x_axis, view_from_shape.matrix3.y_axis, view_from_shape.matrix3.z_axis];
            // Cofactors, which exist for every matrix.
            let normals = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
            let side = if view_from_shape.matrix3.determinant() < 0.0 { -1.0 } else { 1.0 };
            placed.push(Placed { view_from_shape, normals: normals * side });
            let shape = &assembly.shapes[of_scene.shape as usize];
            let center = self.center;
            let corner = |vertex: u32| {
                (view_from_shape.transform_point3(shape.positions[vertex as usize].as_dvec3()) - center).as_vec3()
            };
            self.triangles.extend((0..).zip(&shape.triangles).map(|(index, vertices)| Triangle {
                corners: vertices.map(corner),
                part: number,
                index,
            }));
        }
        self.meshes = Some((meshes, placed));
    }

    /// The objects, for who makes outlines of them.
    pub fn objects(&self) -> (&[Sphere], &[Cylinder]) {
        (&self.spheres, &self.cylinders)
    }

    /// The parts of meshes, where there are any, with the way from the shape to view space.
    pub fn parts(&self) -> impl Iterator<Item = (&Meshes, &Part, &DAffine3)> {
        self.meshes.iter().flat_map(|(meshes, placed)| {
            meshes.parts.iter().zip(placed).map(move |(part, placed)| (meshes, part, &placed.view_from_shape))
        })
    }

    /// The first surface along a line of sight beyond `near`, or the next one after `last`. Of spheres and cylinders the eye
    /// sees one side, the first beyond `near`; of meshes every triangle. At equal depths each is met once, in their order.
    pub fn next(&self, ray: Ray, near: f64, last: Option<Hit>) -> Option<Hit> {
        let tree = self.tree.as_ref()?;
        let after = last.map_or(near, |last| last.t);
        let (start, fast) = self.fast_ray(ray, after, f64::INFINITY)?;
        let mut found: Option<Hit> = None;
        let comes_before = |a: (f64, Object), b: (f64, Object)| a.0 < b.0 || (a.0 == b.0 && a.1 < b.1);
        tree.ray_traverse(fast, &mut RayHit::none(), |_, slot| {
            let object = self.object(tree.primitive_indices[slot] as usize);
            let Some(t) = self.meets(ray, object, near) else { return f32::INFINITY };
            let is_after = last.is_none_or(|last| comes_before((last.t, last.object), (t, object)));
            let is_nearer = found.is_none_or(|found| comes_before((t, object), (found.t, found.object)));
            if !(is_after && is_nearer) {
                return f32::INFINITY;
            }
            found = Some(Hit { t, object });
            // Beyond what single precision rounds, so that equal depths are still looked at.
            ((t - start) as f32).next_up().next_up()
        });
        found
    }

    /// The same world in which what is of such materials, by number, neither casts shadows nor occludes.
    pub fn with_see_through(self, see_through: Vec<bool>) -> World {
        World { see_through, ..self }
    }

    fn is_see_through(&self, object: Object) -> bool {
        let material = match object {
            Object::Sphere(index) => self.spheres[index as usize].look.material,
            Object::Cylinder(index) => self.cylinders[index as usize].looks[0].material,
            Object::Triangle(index) => {
                let part = self.triangles[index as usize].part as usize;
                self.meshes.as_ref().map_or(0, |(meshes, _)| meshes.parts[part].look.material)
            }
        };
        self.see_through.get(material as usize).is_some_and(|see_through| *see_through)
    }

    /// Whether anything opaque that `counts` lies along a ray between `after` and `end`.
    pub fn is_blocked(&self, ray: Ray, after: f64, end: f64, counts: impl Fn(Object) -> bool) -> bool {
        let Some(tree) = &self.tree else { return false };
        let Some((_, fast)) = self.fast_ray(ray, after, end) else { return false };
        !tree.ray_traverse_miss(fast, |_, slot| {
            let object = self.object(tree.primitive_indices[slot] as usize);
            let blocks = self.meets(ray, object, after).is_some_and(|t| t < end)
                && counts(object)
                && !self.is_see_through(object);
            if blocks { 0.0 } else { f32::INFINITY }
        })
    }

    /// The first hull outline along a line of sight, deeper than `after` and less deep than `end`, of what is not `crossed`:
    /// a surface hides its own.
    pub fn first_outline(&self, ray: Ray, near: f64, after: f64, end: f64, crossed: &[u64]) -> Option<OutlineHit> {
        let tree = self.outline_tree.as_ref()?;
        let (start, fast) = self.fast_ray(ray, near, f64::INFINITY)?;
        let mut found: Option<OutlineHit> = None;
        tree.ray_traverse(fast, &mut RayHit::none(), |_, slot| {
            let outline = &self.outlines[tree.primitive_indices[slot] as usize];
            let best = found.map_or(end, |found| found.depth);
            match outline.depth(ray, near) {
                Some(depth) if depth > after && depth < best && !crossed.contains(&outline.owner) => {
                    found = Some(OutlineHit { depth, material: outline.material, owner: outline.owner });
                    ((depth - start) as f32).next_up()
                }
                _ => f32::INFINITY,
            }
        });
        found
    }

    /// What positions are rounded to, and then some: rays from surfaces begin beyond it.
    pub fn rounding(&self) -> f64 {
        self.radius * 1e-7
    }

    /// The ray in single precision around the middle of the world, from where it enters the ball around all: that `t`, and
    /// the ray. None where it passes by.
    fn fast_ray(&self, ray: Ray, after: f64, end: f64) -> Option<(f64, obvhs::ray::Ray)> {
        let [enter, leave] = sphere_span(ray, self.center, self.radius * 1.001)?;
        let start = enter.max(after);
        if leave < after || start > end {
            return None;
        }
        let origin: Vec3A = (ray.at(start) - self.center).as_vec3().into();
        let direction: Vec3A = ray.direction.as_vec3().into();
        let reach = ((end.min(leave) - start) as f32).next_up();
        Some((start, obvhs::ray::Ray::new(origin, direction, 0.0, reach)))
    }

    fn object(&self, index: usize) -> Object {
        let (spheres, cylinders) = (self.spheres.len(), self.cylinders.len());
        if index < spheres {
            Object::Sphere(index as u32)
        } else if index < spheres + cylinders {
            Object::Cylinder((index - spheres) as u32)
        } else {
            Object::Triangle((index - spheres - cylinders) as u32)
        }
    }

    /// The first surface of one object beyond `after`.
    fn meets(&self, ray: Ray, object: Object, after: f64) -> Option<f64> {
        let span = match object {
            Object::Sphere(index) => {
                let ball = &self.spheres[index as usize];
                sphere_span(ray, ball.center, ball.radius)?
            }
            Object::Cylinder(index) => {
                let rod = &self.cylinders[index as usize];
                cone_span(ray, rod.ends[0], rod.ends[1], [rod.radius; 2])?
            }
            Object::Triangle(index) => {
                let (t, _) = triangle_hit(ray, self.corners(index))?;
                return (t > after).then_some(t);
            }
        };
        span.into_iter().find(|t| *t > after)
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].corners.map(|corner| corner.as_dvec3() + self.center)
    }

    /// What a ray met.
    pub fn surface(&self, ray: Ray, hit: Hit) -> Surface {
        let position = ray.at(hit.t);
        let turned = |normal: DVec3| if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        let of = |normal: DVec3, look: Look, material: u32, kind: u64, index: u32, bend: f64| Surface {
            position,
            normal: turned(normal),
            facet: turned(normal),
            color: look.color,
            material,
            group: look.group,
            picks: look.picks,
            id: kind << 32 | u64::from(index),
            bend,
        };
        match hit.object {
            Object::Sphere(index) => {
                let ball = &self.spheres[index as usize];
                let normal = (position - ball.center) / ball.radius;
                of(normal, ball.look, ball.look.material, 1, index, 1.0 / ball.radius)
            }
            Object::Cylinder(index) => {
                let rod = &self.cylinders[index as usize];
                let [a, b] = rod.ends;
                let normal = cylinder_normal(position, a, b, rod.radius);
                let is_cap = normal.dot((b - a).normalize()).abs() > 0.5;
                let half = usize::from((position - 0.5 * (a + b)).dot(b - a) > 0.0);
                let bend = if is_cap { 0.0 } else { 1.0 / rod.radius };
                of(normal, rod.looks[half], rod.looks[0].material, 2, index, bend)
            }
            Object::Triangle(index) => self.mesh_surface(ray, position, index),
        }
    }

    /// A cylinder's axis, a unit vector; zero for all else.
    pub fn axis(&self, object: Object) -> DVec3 {
        match object {
            Object::Cylinder(index) => {
                let [a, b] = self.cylinders[index as usize].ends;
                (b - a).normalize_or_zero()
            }
            _ => DVec3::ZERO,
        }
    }

    /// Outward normal of a sphere or cylinder at a point of it.
    pub fn outward(&self, object: Object, position: DVec3) -> DVec3 {
        match object {
            Object::Sphere(index) => (position - self.spheres[index as usize].center).normalize_or_zero(),
            Object::Cylinder(index) => {
                let rod = &self.cylinders[index as usize];
                cylinder_normal(position, rod.ends[0], rod.ends[1], rod.radius)
            }
            Object::Triangle(_) => DVec3::ZERO,
        }
    }

    /// A triangle with its curvature.
    pub fn facet(&self, index: u32) -> Option<Facet> {
        let triangle = &self.triangles[index as usize];
        let (meshes, placed) = self.meshes.as_ref()?;
        let of_scene = &meshes.scene.assembly.parts[meshes.parts[triangle.part as usize].part as usize];
        let shape = &meshes.scene.assembly.shapes[of_scene.shape as usize];
        let placed = &placed[triangle.part as usize];
        let vertices = &shape.triangles[triangle.index as usize];
        let scale = placed.view_from_shape.matrix3.determinant().abs().cbrt();
        let bending = shape.bending();
        let is_flat = is_flat(shape, vertices);
        let kappa = |vertex: u32| if is_flat { 0.0 } else { f64::from(bending.kappa[vertex as usize]) / scale };
        let normal = |vertex: u32| {
            (placed.normals * unpack_normal(shape.normals[vertex as usize]).as_dvec3()).normalize_or_zero()
        };
        Some(Facet {
            corners: self.corners(index),
            normals: vertices.map(normal),
            kappa: vertices.map(kappa),
            creases: bending.creases[triangle.index as usize],
        })
    }

    fn mesh_surface(&self, ray: Ray, position: DVec3, index: u32) -> Surface {
        let triangle = &self.triangles[index as usize];
        let [a, b, c] = self.corners(index);
        let across = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let facet = if across.dot(ray.direction) > 0.0 { -across } else { across };
        let shares = triangle_hit(ray, [a, b, c]).map_or(DVec3::splat(1.0 / 3.0), |(_, shares)| shares);
        let mut surface = Surface {
            position,
            normal: facet,
            facet,
            color: DVec3::ONE,
            material: 0,
            group: 0,
            picks: 0,
            id: 3 << 32 | u64::from(triangle.part),
            bend: 0.0,
        };
        let Some((meshes, placed)) = &self.meshes else { return surface };
        let part = &meshes.parts[triangle.part as usize];
        let of_scene = &meshes.scene.assembly.parts[part.part as usize];
        let shape = &meshes.scene.assembly.shapes[of_scene.shape as usize];
        let vertices = shape.triangles[triangle.index as usize];
        let normals = vertices.map(|vertex| {
            (placed[triangle.part as usize].normals * unpack_normal(shape.normals[vertex as usize]).as_dvec3())
                .normalize_or(facet)
        });
        let mixed = shares.x * normals[0] + shares.y * normals[1] + shares.z * normals[2];
        let mixed = mixed.normalize_or(facet);
        let normal = if mixed.dot(facet) < 0.0 { -mixed } else { mixed };
        // An interpolated normal may lean away where the triangle does not: it is then seen from the side.
        let away = normal.dot(ray.direction);
        surface.normal = if away > 0.0 {
            (normal - ray.direction * (away * 1.001 / ray.direction.length_squared())).normalize_or(facet)
        } else {
            normal
        };
        surface.material = part.look.material;
        surface.picks = part.look.picks;
        surface.color = part.look.color;
        if part.has_vertex_colors {
            let colors = vertices
                .map(|vertex| shape.colors[vertex as usize].map(|value| linear_from_srgb(f64::from(value) / 255.0)))
                .map(DVec3::from_array);
            surface.color *= shares.x * colors[0] + shares.y * colors[1] + shares.z * colors[2];
        }
        surface
    }
}

fn boxed(low: DVec3, high: DVec3, center: DVec3, slack: f64) -> Bounds {
    let (low, high) = ((low - center - slack).as_vec3(), (high - center + slack).as_vec3());
    Bounds(Aabb { min: low.into(), max: high.into() })
}

fn tree(bounds: &[Bounds]) -> Option<Bvh2> {
    // A large tree is built in a second or two: no more search than that.
    let params = if bounds.len() > 200_000 { BvhBuildParams::fast_build() } else { BvhBuildParams::medium_build() };
    (!bounds.is_empty()).then(|| build_bvh2(bounds, params, &mut Default::default()))
}
