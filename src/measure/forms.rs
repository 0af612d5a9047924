//! Shapes of which every point is known by a formula, beside what the device draws of them.

use glam::{DMat3, DQuat, DVec3};

use super::experiment::MeasureError;
use super::sheet::sheet;
use super::stage::{scene, shipped_scene};
use crate::scene::Scene;

/// Steps along a ray in which a surface is looked for, and halvings that then find its place.
const STEPS: u32 = 1500;
const HALVINGS: u32 = 60;
/// Step of differences of second order, in units of the form: their error is below a millionth.
const STEP: f64 = 1e-3;
/// By how much two points beside each other may differ in curvature on one face: a share of the length of both principal ones, and more
/// than planes do by rounding, over a unit of the form.
const SAME_FACE: f64 = 0.5;
const SAME_PLANE: f64 = 1e-5;
/// The least cosine between normals of two points beside each other on one face.
const SAME_SIDE: f64 = 0.7;

/// A shape of which every point is known.
pub struct Form {
    /// What it is called.
    pub name: &'static str,
    content: Content,
    /// Below 0 within, above outside, 0 on the surface.
    field: fn(DVec3) -> f64,
    /// Where the surface ends.
    is_there: fn(DVec3) -> bool,
    /// Members of a style's camera.
    pub camera: &'static str,
    /// How much closer than the whole scene it is seen.
    pub zoom: f64,
}

/// What is drawn.
enum Content {
    /// A file of this name, in the units of the form.
    Text(&'static str, fn() -> String),
    /// The shipped scene of the form's name: how many units of the form one of the file is, and how the form is turned in it.
    Shipped(f64, DQuat),
}

/// Shapes that are drawn as their formulas say, up to the triangles of meshes; the last is a part as CAD programs write them.
pub const FORMS: [Form; 6] = [
    Form {
        name: "sphere",
        content: Content::Text("sphere.xyz", || "1\n\nC 0 0 0\n".to_owned()),
        field: |p| p.length() - 1.0,
        is_there: |_| true,
        camera: r#""position": [0.4, 0.5, 3]"#,
        zoom: 1.0,
    },
    Form {
        name: "cylinder",
        content: Content::Text("cylinder.obj", || {
            sheet([400, 8], |u, v| {
                let out = around(u);
                (0.5 * out + DVec3::Z * (6.0 * v - 3.0), out)
            })
        }),
        field: |p| p.x.hypot(p.y) - 0.5,
        is_there: |p| p.z.abs() < 3.0,
        camera: r#""position": [3, 2, 1.2]"#,
        zoom: 3.0,
    },
    Form {
        name: "torus",
        content: Content::Text("torus.obj", || {
            sheet([360, 180], |u, v| {
                let (out, tube) = (around(u), around(v));
                let normal = out * tube.x + DVec3::Z * tube.y;
                (out + 0.4 * normal, normal)
            })
        }),
        field: |p| (p.x.hypot(p.y) - 1.0).hypot(p.z) - 0.4,
        is_there: |_| true,
        camera: r#""position": [0.8, -1.2, 2.4]"#,
        zoom: 1.0,
    },
    Form {
        name: "ellipsoid",
        content: Content::Text("ellipsoid.obj", || {
            sheet([360, 180], |u, v| {
                let (out, up) = (around(u), around(0.5 * v - 0.25));
                let ball = out * up.x + DVec3::Z * up.y;
                (ball * AXES, (ball / AXES).normalize())
            })
        }),
        field: |p| (p / AXES).length_squared() - 1.0,
        is_there: |_| true,
        camera: r#""position": [1.2, 0.8, 2]"#,
        zoom: 1.0,
    },
    Form {
        name: "saddle",
        content: Content::Text("saddle.obj", || {
            sheet([250, 250], |u, v| {
                let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
                (DVec3::new(x, y, 0.5 * (x * x - y * y)), DVec3::new(-x, y, 1.0).normalize())
            })
        }),
        field: |p| p.z - 0.5 * (p.x * p.x - p.y * p.y),
        is_there: |p| p.x.abs() < 1.0 && p.y.abs() < 1.0,
        camera: r#""position": [1, -1.4, 2.2]"#,
        zoom: 1.0,
    },
    Form {
        name: "bracket",
        // Its file is in metres, its drawing in millimetres.
        content: Content::Shipped(1000.0, DQuat::from_xyzw(0.2294203, -0.3078794, -0.0767629, 0.9201544)),
        field: bracket,
        is_there: |_| true,
        camera: r#""orthographic": false"#,
        zoom: 1.0,
    },
];

/// Of the ellipsoid.
const AXES: DVec3 = DVec3::new(1.0, 0.7, 0.5);

/// A point of the unit circle, by its share of a turn.
fn around(turns: f64) -> DVec3 {
    let (sin, cos) = (turns * std::f64::consts::TAU).sin_cos();
    DVec3::new(cos, sin, 0.0)
}

/// The shipped bracket in millimetres, as `angle_bracket` of `meshes/make.py` has it: two plates with rounded corners and drilled
/// holes, and a fillet between them.
fn bracket(p: DVec3) -> f64 {
    const LEG: f64 = 80.0;
    const THICK: f64 = 10.0;
    const WIDTH: f64 = 64.0;
    const ROUND: f64 = 12.0;
    const FILLET: f64 = 8.0;
    let plate = |along: f64, height: f64| {
        let [past, aside] = [along - (LEG - ROUND), (p.z - 0.5 * WIDTH).abs() - (0.5 * WIDTH - ROUND)];
        let plan = if past > 0.0 && aside > 0.0 { past.hypot(aside) } else { past.max(aside) } - ROUND;
        plan.max(-along).max(height - THICK).max(-height)
    };
    let from = |along: f64, [x, z]: [f64; 2]| (along - x).hypot(p.z - z);
    let mut lying = plate(p.x, p.y);
    for middle in [[56.0, 16.0], [56.0, 48.0]] {
        let away = from(p.x, middle);
        lying = lying.max(4.5 - away).max((7.5 - away).min(p.y - 0.5 * THICK));
    }
    let mut standing = plate(p.y, p.x).max(14.0 - from(p.y, [48.0, 32.0]));
    for middle in [[31.0, 15.0], [31.0, 49.0], [65.0, 15.0], [65.0, 49.0]] {
        standing = standing.max(2.75 - from(p.y, middle));
    }
    let inner = THICK + FILLET;
    let within = p.x.min(p.y).min(inner - p.x).min(inner - p.y).min(p.z).min(WIDTH - p.z);
    let fillet = (-within).max(FILLET - (p.x - inner).hypot(p.y - inner));
    lying.min(standing).min(fillet)
}

/// A point that a pixel sees.
#[derive(Clone, Copy)]
pub struct Seen {
    point: DVec3,
    normal: DVec3,
    /// Sum of the principal curvatures over units of the scene, negative where it is convex.
    pub kappa: f64,
    /// Sum of their squares.
    pub squares: f64,
}

/// A line of sight in units of a form.
pub struct Sight {
    /// Where it starts.
    pub origin: DVec3,
    /// Its unit direction.
    pub direction: DVec3,
    /// Between which distances from the start a surface is looked for.
    pub range: [f64; 2],
}

impl Form {
    /// What is drawn of it.
    ///
    /// # Errors
    /// [`MeasureError::Content`] where it cannot be read.
    pub fn scene(&self) -> Result<Scene, MeasureError> {
        match &self.content {
            Content::Text(file, text) => scene(file, text().as_bytes()),
            Content::Shipped(..) => shipped_scene(self.name),
        }
    }

    /// Units of the form in one of the scene.
    fn unit(&self) -> f64 {
        if let Content::Shipped(unit, _) = self.content { unit } else { 1.0 }
    }

    /// A line of sight in scene units as one of the form; `zero` is where the scene's is in the file.
    pub fn sight(&self, origin: DVec3, direction: DVec3, range: [f64; 2], zero: DVec3) -> Sight {
        match self.content {
            Content::Text(..) => Sight { origin: origin + zero, direction, range },
            Content::Shipped(unit, turn) => {
                let back = turn.inverse();
                let origin = back * ((origin + zero) * unit);
                Sight { origin, direction: back * direction, range: range.map(|t| t * unit) }
            }
        }
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        let along = |axis: DVec3| ((self.field)(p + STEP * axis) - (self.field)(p - STEP * axis)) / (2.0 * STEP);
        DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// Sum of the principal curvatures where the surface is seen along a direction, negative where it is convex, and the sum of their
    /// squares: the traces of the change of its unit normals, which the gradients beside it give, and of that change squared.
    fn curvatures(&self, p: DVec3, direction: DVec3) -> [f64; 2] {
        let normal = |p: DVec3| self.gradient(p).normalize();
        let along = |axis: DVec3| (normal(p + STEP * axis) - normal(p - STEP * axis)) / (2.0 * STEP);
        let change = DMat3::from_cols(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
        let trace = |of: DMat3| of.x_axis.x + of.y_axis.y + of.z_axis.z;
        let turned = if normal(p).dot(direction) > 0.0 { 1.0 } else { -1.0 };
        [turned * trace(change), trace(change * change)]
    }

    /// The first point of the surface along a line of sight.
    pub fn first(&self, Sight { origin, direction, range: [start, end] }: Sight) -> Option<Seen> {
        let at = |t: f64| origin + t * direction;
        let step = (end - start) / f64::from(STEPS);
        let mut before = (self.field)(at(start));
        for index in 1..=STEPS {
            let t = start + f64::from(index) * step;
            let here = (self.field)(at(t));
            if before * here <= 0.0 {
                let (mut low, mut high) = (t - step, t);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if (self.field)(at(middle)) * before > 0.0 {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                let point = at(0.5 * (low + high));
                if (self.is_there)(point) {
                    let [kappa, squares] = self.curvatures(point, direction);
                    let unit = self.unit();
                    return Some(Seen {
                        point,
                        normal: self.gradient(point).normalize(),
                        kappa: kappa * unit,
                        squares: squares * unit * unit,
                    });
                }
            }
            before = here;
        }
        None
    }

    /// Whether one face of the surface goes on between two points of it.
    pub fn goes_on(&self, a: &Seen, b: &Seen) -> bool {
        let middle = 0.5 * (a.point + b.point);
        let off = (self.field)(middle).abs() / self.gradient(middle).length().max(f64::MIN_POSITIVE);
        let apart = SAME_FACE * a.squares.max(b.squares).max(0.0).sqrt() + SAME_PLANE * self.unit();
        let is_one = (a.kappa - b.kappa).abs() <= apart && a.normal.dot(b.normal) > SAME_SIDE;
        off < 0.1 * a.point.distance(b.point) && is_one
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str) -> &'static Form {
        FORMS.iter().find(|form| form.name == name).expect("a form")
    }

    #[test]
    fn scenes_load() {
        for form in &FORMS {
            form.scene().unwrap_or_else(|error| panic!("{}: {error}", form.name));
        }
    }

    #[test]
    fn curvature_of_formulas_is_known() {
        for (form, point, due) in [
            ("sphere", DVec3::new(0.0, 0.6, 0.8), -2.0),
            ("cylinder", DVec3::new(0.3, 0.4, 1.0), -2.0),
            ("torus", DVec3::new(1.4, 0.0, 0.0), -1.0 / 0.4 - 1.0 / 1.4),
            ("torus", DVec3::new(0.6, 0.0, 0.0), -1.0 / 0.4 + 1.0 / 0.6),
            ("bracket", DVec3::new(40.0, 10.0, 50.0), 0.0),
            ("bracket", DVec3::new(76.0, 5.0, 64.0 - 12.0 + 12.0 * (5.0f64 / 9.0).sqrt()), -1.0 / 12.0),
            ("bracket", DVec3::new(5.0, 62.0, 32.0), 1.0 / 14.0),
        ] {
            let form = named(form);
            assert!((form.field)(point).abs() < 1e-9, "{}: {point} is off the surface", form.name);
            let [kappa, squares] = form.curvatures(point, -form.gradient(point));
            assert!((kappa - due).abs() < 1e-4, "{}: {kappa} for {due}", form.name);
            assert!((form.curvatures(point, form.gradient(point))[0] + due).abs() < 1e-4, "from within");
            assert!(squares >= 0.5 * kappa * kappa - 1e-6, "{}: {squares}", form.name);
        }
    }

    #[test]
    fn the_bracket_lies_where_its_mesh_does() {
        let form = named("bracket");
        let scene = form.scene().expect("the bracket");
        let (shape, part) = (&scene.assembly.shapes[0], &scene.assembly.parts[0]);
        for position in &shape.positions {
            let at = part.world_from_shape.transform_point3(*position).as_dvec3();
            let at = form.sight(at, DVec3::Z, [0.0, 1.0], scene.origin()).origin;
            assert!((form.field)(at).abs() < 2e-3, "{at} is off the surface by {} mm", (form.field)(at));
        }
    }

    #[test]
    fn faces_end_where_the_bend_begins() {
        let form = named("bracket");
        let seen = |x: f64, y: f64| {
            let sight = Sight { origin: DVec3::new(x, y, 90.0), direction: -DVec3::Z, range: [0.0, 80.0] };
            assert!(form.first(sight).is_some(), "{x} {y}");
            let down = Sight { origin: DVec3::new(x, y + 30.0, 30.0), direction: -DVec3::Y, range: [0.0, 60.0] };
            form.first(down).expect("the surface")
        };
        let [plane, other, bend] = [seen(19.0, 9.0), seen(18.5, 9.0), seen(17.5, 9.0)];
        assert!(form.goes_on(&plane, &other) && !form.goes_on(&other, &bend));
        assert!((bend.kappa - 125.0).abs() < 0.1, "{}", bend.kappa);
    }
}
