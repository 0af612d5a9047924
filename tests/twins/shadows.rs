//! Shadows in pictures against ray casts in f64: the place of hard edges, the width of soft ones, their strength.

use super::gpu;
use super::truth::{Shape, World, center_px, distance_to_change};
use glam::{DVec2, DVec3};
use restyle::engine::Engine;

const SIZE: [u32; 2] = [384, 384];
/// Pixels by which a hard edge may be off.
const EDGE_PX: f64 = 1.0;
/// Of full light, where it is whole or wholly taken: the rounding of f32.
const STRENGTH: f64 = 1e-5;
/// Relative error of a penumbra's width.
const PENUMBRA: f64 = 0.1;

/// A light of a test, in radii of the scene's sphere, as seen by the camera.
#[derive(Debug, Clone, Copy)]
enum Source {
    Directional(DVec3),
    Point(DVec3),
}

impl Source {
    fn written(self) -> String {
        let (kind, position) = match self {
            Source::Directional(position) => ("directional", position),
            Source::Point(position) => ("point", position),
        };
        format!(r#""type": "{kind}", "position": [{}, {}, {}]"#, position.x, position.y, position.z)
    }

    /// The way to the light from a view-space point, and the ray parameter at which it ends.
    fn way(self, engine: &Engine, world: &World, from: DVec3) -> (DVec3, f64) {
        match self {
            Source::Directional(position) => (position.normalize(), f64::INFINITY),
            Source::Point(position) => {
                let bounds = engine.scene().expect("a scene").molecule.bounding_sphere();
                let center = world.view.view_from_world.transform_point3(bounds.center.as_dvec3());
                (center + f64::from(bounds.radius) * position - from, 1.0)
            }
        }
    }
}

/// A molecule, its radii, and who shades whom.
struct Case {
    name: &'static str,
    atoms: &'static [&'static str],
    /// Of the style, on van der Waals radii.
    scale: f64,
    radii: &'static [f64],
    bond_radius: f64,
    camera: &'static str,
    light: Source,
}

/// Caesium, as large as atoms get, and helium before it; neither bonds.
const SPHERE_ON_SPHERE: Case = Case {
    name: "a sphere on a sphere",
    atoms: &["Cs 0 0 0", "He 1.6 0.5 5.5"],
    scale: 1.0,
    radii: &[3.43, 1.40],
    bond_radius: 0.1,
    camera: r#""orthographic": true"#,
    light: Source::Directional(DVec3::new(0.6, 0.2, 1.0)),
};

const SPHERE_ON_BOND: Case = Case {
    name: "a sphere on a bond",
    atoms: &["C -0.75 0 0", "C 0.75 0 0", "He 0.1 1.2 1.3"],
    scale: 0.2,
    radii: &[0.34, 0.34, 0.28],
    bond_radius: 0.25,
    camera: r#""fov": 35, "zoom": 1.5"#,
    light: Source::Directional(DVec3::new(0.0, 1.0, 1.1)),
};

const CASES: [Case; 4] = [
    SPHERE_ON_SPHERE,
    SPHERE_ON_BOND,
    Case {
        name: "a sphere on a sphere, by a point light",
        camera: r#""fov": 40"#,
        light: Source::Point(DVec3::new(1.0, 0.4, 2.2)),
        ..SPHERE_ON_SPHERE
    },
    Case {
        name: "a bond on a sphere",
        atoms: &["Cs 0 0 0", "C 0.4 0.3 6", "C 1.8 0.6 6.2"],
        scale: 1.0,
        radii: &[3.43, 1.70, 1.70],
        bond_radius: 0.3,
        camera: r#""fov": 40"#,
        light: Source::Directional(DVec3::new(0.7, 0.1, 1.0)),
    },
];

impl Case {
    /// White surfaces in flat light: what is drawn is the light that arrives.
    fn open(&self, shadow: &str, camera: &str) -> Option<Engine> {
        let style = format!(
            r##"{{"camera": {{"bgcolor": "#000000", {}{camera}}},
                "geometry": {{"atom": "vdw", "scale": {}, "bond_radius": "{}A"}}, "mapping": {{"*": "t"}},
                "shaders": [{{"name": "t", "shader": "toon", "properties": {{"steps": 1, "base_color": "#ffffff"}}}}],
                "lights": [{{{}, {shadow}}}]}}"##,
            self.camera,
            self.scale,
            self.bond_radius,
            self.light.written()
        );
        gpu::engine(self.atoms, &style)
    }

    fn world(&self, engine: &Engine, size: [u32; 2]) -> World {
        World::new(engine, size, self.radii, self.bond_radius)
    }
}

/// The object that a picture position sees, and whether the light's middle is hidden from there; `None` on its unlit
/// side, which shading, not shadows, turns dark.
fn shaded(case: &Case, engine: &Engine, world: &World, at: DVec2) -> Option<(u32, bool)> {
    let (id, _, hit) = world.seen(at)?;
    let ray = world.view.ray(at);
    let point = ray.origin + hit.t * ray.direction;
    let (toward, end) = case.light.way(engine, world, point);
    (hit.normal.dot(toward) > 0.0).then(|| (id, world.is_shaded(id, point, toward, end)))
}

#[test]
fn hard_shadows_fall_where_rays_are_blocked_and_take_their_strength() {
    for case in &CASES {
        for strength in [0.6, 1.0] {
            let shadow = format!(r#""shadow": "hard", "strength": {strength}"#);
            let Some(mut engine) = case.open(&shadow, "") else { return };
            let image = gpu::aovs(&mut engine, SIZE);
            let world = case.world(&engine, SIZE);
            let (mut off_px, mut off_light, mut dark) = (0f64, 0f64, 0);
            for (index, pixel) in gpu::pixels(SIZE).enumerate() {
                let at = center_px(pixel);
                let Some((id, truth)) = shaded(case, &engine, &world, at) else { continue };
                let light = f64::from(image.color[4 * index]);
                let drawn = light < 1.0 - 0.5 * strength;
                dark += u32::from(drawn);
                off_light = off_light.max((light - if drawn { 1.0 - strength } else { 1.0 }).abs());
                if drawn != truth {
                    // A change of the object is no edge of the shadow.
                    let same = |at| shaded(case, &engine, &world, at).is_some_and(|other| other == (id, !truth));
                    let off = distance_to_change(at, EDGE_PX, same);
                    off_px = off_px.max(off.unwrap_or(f64::INFINITY));
                }
            }
            let name = case.name;
            eprintln!(
                "hard shadow of {name}, strength {strength}: edge off by {off_px:.3} px, light by {off_light:.1e}"
            );
            assert!(dark > 300, "{name}: a shadow of {dark} pixels");
            assert!(off_px <= EDGE_PX && off_light <= STRENGTH, "{name}: {off_px} px, {off_light}");
        }
    }
}

/// Directions over the light's disc in the exact penumbra; its steps are below a hundredth of the light.
const DISC: u32 = 512;

/// Share of a disc of this angular diameter around the light's middle that a picture position sees.
fn open_share(case: &Case, engine: &Engine, world: &World, at: DVec2, softness_deg: f64) -> Option<f64> {
    let (id, _, hit) = world.seen(at)?;
    let ray = world.view.ray(at);
    let point = ray.origin + hit.t * ray.direction;
    let (toward, end) = case.light.way(engine, world, point);
    let reach = toward.length() * (0.5 * softness_deg).to_radians().tan();
    let side = toward.any_orthonormal_vector();
    let up = toward.normalize().cross(side);
    let open = (0..DISC)
        .filter(|i| {
            // Evenly over the disc, on a spiral of the golden angle.
            let part = (f64::from(*i) + 0.5) / f64::from(DISC);
            let disc = reach * part.sqrt() * DVec2::from_angle(f64::from(*i) * 2.399_963_229_728_653);
            !world.is_shaded(id, point, toward + disc.x * side + disc.y * up, end)
        })
        .count();
    Some(open as f64 / f64::from(DISC))
}

/// Pixels between 10% and 90% of a profile that rises from dark to light, the first and last crossings.
fn rise(profile: &[f64]) -> f64 {
    let crossing = |level: f64, i: usize| i as f64 + (level - profile[i]) / (profile[i + 1] - profile[i]);
    let crosses = |level: f64, i: usize| (profile[i] - level) * (profile[i + 1] - level) < 0.0;
    let low = (0..profile.len() - 1).rfind(|&i| crosses(0.1, i)).map(|i| crossing(0.1, i));
    let high = (0..profile.len() - 1).find(|&i| crosses(0.9, i)).map(|i| crossing(0.9, i));
    high.expect("the profile reaches the light") - low.expect("the profile leaves the dark")
}

/// Pixels along one profile, and lines that are averaged to still the filter's noise.
const PROFILE: usize = 75;
const LINES: i32 = 9;

/// Widths in pixels of the penumbra in a picture and in truth, upwards from the middle of the shadow on object 0.
fn penumbra(case: &Case, softness_deg: f64, camera: &str) -> Option<(f64, f64)> {
    let shadow = format!(r#""shadow": "soft", "strength": 1, "softness": {softness_deg}"#);
    let mut engine = case.open(&shadow, camera)?;
    let light = gpu::channel(&gpu::still(&mut engine, SIZE, 64), 0);
    let world = case.world(&engine, SIZE);
    // The middle of the last object's shadow: along its light onto object 0.
    let (Shape::Sphere { center, .. }, receiver) = (world.shapes[case.atoms.len() - 1].1, world.shapes[0].1) else {
        unreachable!("atoms are spheres and come first")
    };
    let (toward, _) = case.light.way(&engine, &world, center);
    let away = super::truth::Ray { origin: center, direction: -toward };
    let hit = receiver.first(away, 0.0).expect("the shadow falls on object 0");
    let middle = world.view.project(center - hit.t * toward).floor() + 0.5;
    let mut drawn = vec![0.0; PROFILE];
    let mut truth = vec![0.0; PROFILE];
    for line in -LINES / 2..=LINES / 2 {
        for step in 0..PROFILE {
            let at = middle + DVec2::new(f64::from(line), -(step as f64));
            drawn[step] += light[at.y as usize * SIZE[0] as usize + at.x as usize] / f64::from(LINES);
            let open = open_share(case, &engine, &world, at, softness_deg).expect("the profile stays on the receiver");
            truth[step] += open / f64::from(LINES);
        }
    }
    Some((rise(&drawn), rise(&truth)))
}

#[test]
fn penumbras_are_as_wide_as_the_light_is_large() {
    let far = Case {
        atoms: &["Cs 0 0 0", "He 3.37 0.42 7.55"],
        light: Source::Directional(DVec3::new(1.0, 0.1, 1.0)),
        ..SPHERE_ON_SPHERE
    };
    let near = Case { atoms: &["Cs 0 0 0", "He 1.26 0.21 5.44"], ..far };
    let point = Case { light: Source::Point(DVec3::new(1.61, 0.17, 2.0)), ..far };
    let cases = [
        ("far", &far, 4.0),
        ("far", &far, 8.0),
        ("near", &near, 8.0),
        ("near", &near, 16.0),
        ("point", &point, 4.0),
        ("point", &point, 8.0),
    ];
    for (name, case, softness_deg) in cases {
        let Some((drawn, truth)) = penumbra(case, softness_deg, "") else { return };
        eprintln!(
            "penumbra, {name}, {softness_deg} degrees: {drawn:.2} px, in truth {truth:.2}: {:+.1}%",
            100.0 * (drawn / truth - 1.0)
        );
        assert!((drawn / truth - 1.0).abs() <= PENUMBRA, "{name}, {softness_deg} degrees: {drawn} for {truth}");
    }
}
