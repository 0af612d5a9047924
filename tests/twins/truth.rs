//! Analytic ray casts in f64, the textbook way: what the impostors, their shading and their shadows are held to.

use glam::{DMat4, DVec2, DVec3};
use restyle::engine::Engine;
use restyle::scene::Camera;

/// Kinds in the upper 3 bits of an id.
const ATOM: u32 = 1 << 29;
const CONNECTOR: u32 = 2 << 29;

#[derive(Debug, Clone, Copy)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

/// A convex primitive in view space.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    Sphere {
        center: DVec3,
        radius: f64,
    },
    /// With flat caps.
    Cylinder {
        a: DVec3,
        b: DVec3,
        radius: f64,
    },
}

/// A point on a shape's surface.
#[derive(Debug, Clone, Copy)]
pub struct Hit {
    /// Ray parameter; for the rays of a [`View`] the depth.
    pub t: f64,
    /// Unit, outwards.
    pub normal: DVec3,
    /// On the flat end of a cylinder.
    pub cap: bool,
}

impl Shape {
    /// Entry and exit.
    pub fn crossings(&self, ray: Ray) -> Option<[Hit; 2]> {
        match *self {
            Shape::Sphere { center, radius } => {
                let [near, far] = quadratic(ray.direction, ray.origin - center, radius)?;
                Some([near, far].map(|t| {
                    let normal = (ray.origin + t * ray.direction - center) / radius;
                    Hit { t, normal, cap: false }
                }))
            }
            Shape::Cylinder { a, b, radius } => {
                let axis = (b - a).normalize();
                let flat = |v: DVec3| v - v.dot(axis) * axis;
                let side = quadratic(flat(ray.direction), flat(ray.origin - a), radius)?.map(|t| {
                    let normal = flat(ray.origin + t * ray.direction - a) / radius;
                    Hit { t, normal, cap: false }
                });
                // Plus zero: across the axis the ends lie at -infinity and +infinity, not the other way round.
                let slope = ray.direction.dot(axis) + 0.0;
                let end = |at: DVec3, normal| Hit { t: (at - ray.origin).dot(axis) / slope, normal, cap: true };
                let ends = if slope >= 0.0 { [end(a, -axis), end(b, axis)] } else { [end(b, axis), end(a, -axis)] };
                let enter = if side[0].t > ends[0].t { side[0] } else { ends[0] };
                let leave = if side[1].t < ends[1].t { side[1] } else { ends[1] };
                (enter.t <= leave.t).then_some([enter, leave])
            }
        }
    }

    /// The first surface beyond depth `near`: the far side where the ray starts inside.
    pub fn first(&self, ray: Ray, near: f64) -> Option<Hit> {
        self.crossings(ray)?.into_iter().find(|hit| hit.t > near)
    }
}

/// Where `|offset + t direction| = radius`.
fn quadratic(direction: DVec3, offset: DVec3, radius: f64) -> Option<[f64; 2]> {
    let a = direction.length_squared();
    if a == 0.0 {
        return (offset.length() <= radius).then_some([f64::NEG_INFINITY, f64::INFINITY]);
    }
    let b = direction.dot(offset);
    let left = b * b - a * (offset.length_squared() - radius * radius);
    (left >= 0.0).then(|| [(-b - left.sqrt()) / a, (-b + left.sqrt()) / a])
}

/// A camera and the pixels that it sees.
#[derive(Debug, Clone, Copy)]
pub struct View {
    pub view_from_world: DMat4,
    pub half_extent: DVec2,
    pub size: DVec2,
    pub orthographic: bool,
    pub near: f64,
}

impl View {
    pub fn new(camera: &Camera, size: [u32; 2]) -> View {
        View {
            view_from_world: camera.view_from_world.as_dmat4(),
            half_extent: camera.half_extent.as_dvec2(),
            size: DVec2::new(f64::from(size[0]), f64::from(size[1])),
            orthographic: camera.orthographic,
            near: f64::from(camera.near),
        }
    }

    /// The ray of a picture position in pixels, origin top left.
    pub fn ray(&self, position_px: DVec2) -> Ray {
        let plane = (DVec2::new(2.0, -2.0) * position_px / self.size + DVec2::new(-1.0, 1.0)) * self.half_extent;
        if self.orthographic {
            Ray { origin: plane.extend(0.0), direction: DVec3::NEG_Z }
        } else {
            Ray { origin: DVec3::ZERO, direction: plane.extend(-1.0) }
        }
    }

    /// View units of a pixel at depth 1 (perspective) or anywhere.
    pub fn pixel_view(&self) -> f64 {
        2.0 * self.half_extent.y / self.size.y
    }

    /// Where a view-space point lies in the picture.
    pub fn project(&self, point: DVec3) -> DVec2 {
        let plane = if self.orthographic { point.truncate() } else { point.truncate() / -point.z };
        (plane / self.half_extent * DVec2::new(0.5, -0.5) + 0.5) * self.size
    }
}

/// The centre of a pixel.
pub fn center_px((x, y): (u32, u32)) -> DVec2 {
    DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5)
}

/// A scene as one view sees it.
pub struct World {
    pub view: View,
    /// Each with the id that the engine gives it.
    pub shapes: Vec<(u32, Shape)>,
}

impl World {
    /// The engine's scene with these radii of atoms, and its bonds with theirs.
    pub fn new(engine: &Engine, size: [u32; 2], atom_radii: &[f64], bond_radius: f64) -> World {
        let view = View::new(&engine.camera(size).expect("a camera"), size);
        let molecule = &engine.scene().expect("a scene").molecule;
        assert_eq!(molecule.atoms.len(), atom_radii.len(), "a radius for each atom");
        let place = |index: usize| view.view_from_world.transform_point3(molecule.atoms[index].position.as_dvec3());
        let atoms = (0u32..)
            .zip(atom_radii)
            .map(|(index, &radius)| (ATOM | index, Shape::Sphere { center: place(index as usize), radius }));
        let bonds = (0u32..).zip(&molecule.bonds).map(|(index, bond)| {
            let (a, b) = (place(bond.a as usize), place(bond.b as usize));
            (CONNECTOR | index, Shape::Cylinder { a, b, radius: bond_radius })
        });
        World { view, shapes: atoms.chain(bonds).collect() }
    }

    /// What a picture position sees first.
    pub fn seen(&self, position_px: DVec2) -> Option<(u32, Shape, Hit)> {
        let ray = self.view.ray(position_px);
        self.shapes
            .iter()
            .filter_map(|&(id, shape)| Some((id, shape, shape.first(ray, self.view.near)?)))
            .min_by(|a, b| a.2.t.total_cmp(&b.2.t))
    }

    /// Whether something but the object `own` lies between a point and a light: `toward` is the way to a point light,
    /// or any length of the direction to a directional one, which has no `end`.
    pub fn is_shaded(&self, own: u32, point: DVec3, toward: DVec3, end: f64) -> bool {
        let ray = Ray { origin: point, direction: toward };
        self.shapes
            .iter()
            .filter(|(id, _)| *id != own)
            .filter_map(|(_, shape)| shape.crossings(ray))
            .any(|[enter, leave]| leave.t > 0.0 && enter.t < end)
    }
}

/// How far from a picture position, in pixels and up to `limit`, a property first changes, looked for in 32 directions
/// and 64 steps; `None` if it does not.
pub fn distance_to_change<T: PartialEq>(at_px: DVec2, limit: f64, property: impl Fn(DVec2) -> T) -> Option<f64> {
    let here = property(at_px);
    (1..=64).map(|step| limit * f64::from(step) / 64.0).find(|distance| {
        (0..32).any(|turn| {
            let direction = DVec2::from_angle(f64::from(turn) * std::f64::consts::TAU / 32.0);
            property(at_px + *distance * direction) != here
        })
    })
}

#[test]
fn a_ray_through_the_middle_crosses_at_the_radius() {
    let ray = Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Z };
    let center = DVec3::new(0.0, 0.0, -5.0);
    let [near, far] = Shape::Sphere { center, radius: 2.0 }.crossings(ray).expect("a hit");
    assert_eq!((near.t, near.normal, far.t, far.normal), (3.0, DVec3::Z, 7.0, DVec3::NEG_Z));
    let across = Shape::Cylinder { a: center - DVec3::X, b: center + DVec3::X, radius: 2.0 };
    let [near, far] = across.crossings(ray).expect("a hit");
    assert_eq!((near.t, near.normal, far.t, near.cap), (3.0, DVec3::Z, 7.0, false));
    let along = Shape::Cylinder { a: center, b: center + DVec3::Z, radius: 2.0 };
    let slanted = Ray { origin: DVec3::ZERO, direction: DVec3::new(0.1, 0.0, -1.0) };
    let [near, far] = along.crossings(slanted).expect("a hit");
    assert_eq!((near.t, near.normal, far.t, near.cap), (4.0, DVec3::Z, 5.0, true));
    assert!(along.crossings(Ray { origin: DVec3::ZERO, direction: DVec3::new(0.6, 0.0, -1.0) }).is_none());
}
