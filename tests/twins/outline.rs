//! Twin of `shaders/effects/outline.wgsl`, its known answers, and the GPU held to it.

use super::gpu;
use super::truth::{Ray, Shape, View, World, center_px};
use glam::{DVec2, DVec3};
use restyle::config::{self, Catalog, Source};
use restyle::effects::outline::group_word;
use restyle::engine::{self, Engine};
use restyle::scene::Scene;

/// `Geometry` of `shaders/lib/geometry.wgsl`; id 0 is nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    pub depth: f64,
    pub normal: DVec3,
    pub bend: f64,
    pub group: u32,
    pub id: u32,
}

/// Nothing seen.
pub const NOTHING: Geometry = Geometry { depth: NOWHERE, normal: DVec3::Z, bend: 0.0, group: 0, id: 0 };

/// `OutlineParams`, with widths in pixels alone.
#[derive(Debug, Clone, Copy)]
pub struct Params {
    pub width_px: [f64; 3],
    pub crease_cosine: f64,
    pub depth_step: f64,
    pub group_mask: u32,
    pub by_object: bool,
    pub footprint_px: f64,
}

const NOWHERE: f64 = 1e30;
const HALF_SEGMENT_PX: f64 = 0.71;
const BEYOND_SLACK_PX: f64 = 0.25;
const CREASE: u32 = 1;
const BOUNDARY: u32 = 2;
const SILHOUETTE: u32 = 4;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    Both,
    First,
    Second,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seed {
    pub kinds: u32,
    pub side: Side,
    pub place: f64,
    pub across: DVec2,
    pub depth: f64,
    pub radius_px: f64,
    pub outermost: bool,
}

struct Continued {
    depth: f64,
    ends: bool,
    place: f64,
}

fn pixel_world(view: &View, depth: f64) -> f64 {
    view.pixel_view() * if view.orthographic { 1.0 } else { depth }
}

fn continued(g: &Geometry, own: Ray, other: Ray) -> Continued {
    let e = other.origin + g.depth * other.direction - own.origin - g.depth * own.direction;
    let d = other.direction;
    let a = g.bend * d.length_squared();
    let b = g.bend * e.dot(d) + g.normal.dot(d);
    let c = g.bend * e.length_squared() + 2.0 * g.normal.dot(e);
    let inside = b * b - a * c;
    let before = g.normal.dot(own.direction).powi(2);
    let k = g.bend * g.bend * e.length_squared() * d.length_squared();
    let slope = inside - before + k;
    let place = 2.0 * before / ((slope * slope + 4.0 * k * before).sqrt() - slope).max(1e-12);
    let ends = inside < 0.0 || b >= 0.0;
    let turn = if a <= 0.0 { 0.0 } else { (-b).max(0.0) / a.max(1e-12) };
    let ahead = if ends { turn } else { c / (inside.max(0.0).sqrt() - b).max(1e-12) };
    Continued { depth: g.depth + ahead, ends, place: place.clamp(0.0, 1.0) }
}

fn depth_slope(view: &View, g: &Geometry, ray: Ray) -> DVec2 {
    pixel_world(view, g.depth) * DVec2::new(-g.normal.x, g.normal.y) / g.normal.dot(ray.direction).min(-1e-3)
}

fn continued_normal(g: &Geometry, own: Ray, other: Ray, depth: f64) -> DVec3 {
    let x = other.origin + depth * other.direction - own.origin - g.depth * own.direction;
    (g.normal + g.bend * x).normalize()
}

fn group_differs(params: &Params, a: &Geometry, b: &Geometry) -> bool {
    params.by_object || (a.group ^ b.group) & params.group_mask != 0
}

/// The seed between two neighbours, the second a `step` to the right or down of `position`.
pub fn seed_between(
    view: &View,
    params: &Params,
    a: &Geometry,
    b: &Geometry,
    position: DVec2,
    step: DVec2,
) -> Option<Seed> {
    let creases = params.width_px[0] > 0.0;
    if a.id == b.id && (!creases || a.id == 0) {
        return None;
    }
    let apart = (a.depth - b.depth).abs() > 0.5 * params.depth_step;
    let differs = params.width_px[1] > 0.0 && group_differs(params, a, b);
    if !creases && a.id != 0 && b.id != 0 && !differs && !apart {
        return None;
    }
    let (ray_a, ray_b) = (view.ray(position), view.ray(position + step));
    let (on_b, on_a) = (continued(a, ray_a, ray_b), continued(b, ray_b, ray_a));
    let (a_behind, b_behind) = (on_b.depth - b.depth, on_a.depth - a.depth);
    let mut gap = 0.0;
    let mut a_nearer = a.depth < b.depth;
    let mut place = b_behind.abs() / (a_behind.abs() + b_behind.abs()).max(1e-12);
    let mut near_depth = a.depth.min(b.depth);
    let mut turned = false;
    if a.id == 0 || b.id == 0 {
        gap = NOWHERE;
        a_nearer = b.id == 0;
        turned = if a_nearer { on_b.ends } else { on_a.ends };
        near_depth = if a_nearer { on_b.depth } else { on_a.depth };
    } else if a.id != b.id || a.bend == 0.0 {
        match (on_b.ends, on_a.ends) {
            (true, true) => {
                gap = (on_b.depth - on_a.depth).abs();
                a_nearer = on_b.depth < on_a.depth;
                turned = true;
            }
            (true, false) => {
                gap = (-a_behind).max(0.0);
                a_nearer = true;
                turned = gap > 0.0;
            }
            (false, true) => {
                gap = (-b_behind).max(0.0);
                a_nearer = false;
                turned = gap > 0.0;
            }
            (false, false) if (a_behind > 0.0) != (b_behind > 0.0) => gap = a_behind.abs().min(b_behind.abs()),
            _ => (),
        }
        if turned {
            near_depth = if a_nearer { on_b.depth } else { on_a.depth };
        }
    }
    let step_px = pixel_world(view, near_depth);
    let step_world = params.depth_step.max(step_px);
    let steps = gap > step_px;
    let mut kinds = 0;
    if params.width_px[2] > 0.0 && gap > step_world {
        kinds |= SILHOUETTE;
    }
    if params.width_px[1] > 0.0 && gap < NOWHERE && a.id != b.id && group_differs(params, a, b) {
        kinds |= BOUNDARY;
    }
    if creases && !steps {
        let normal_a = continued_normal(a, ray_a, ray_b, on_b.depth);
        let normal_b = continued_normal(b, ray_b, ray_a, on_a.depth);
        if normal_a.dot(b.normal).max(normal_b.dot(a.normal)) < params.crease_cosine {
            kinds |= CREASE;
        }
    }
    if kinds == 0 {
        return None;
    }
    let mut across = if a_nearer { step } else { -step };
    if turned {
        place = if a_nearer { on_b.place } else { 1.0 - on_a.place };
        let normal = if a_nearer { a.normal } else { b.normal };
        across = DVec2::new(normal.x, -normal.y);
    } else if steps {
        place = 0.5;
    } else {
        across = depth_slope(view, a, ray_a) - depth_slope(view, b, ray_b);
    }
    let side = match (steps, a_nearer) {
        (false, _) => Side::Both,
        (true, true) => Side::First,
        (true, false) => Side::Second,
    };
    let bend = match side {
        Side::Both => a.bend.min(b.bend),
        Side::First => a.bend,
        Side::Second => b.bend,
    };
    Some(Seed {
        kinds,
        side,
        place,
        across: across.try_normalize().unwrap_or(step),
        depth: if steps { near_depth + 0.5 * gap.min(step_world) } else { near_depth },
        radius_px: 1.0 / (bend * step_px).max(1e-9),
        outermost: gap >= NOWHERE,
    })
}

/// Shares that crease, boundary and silhouette cover of a pixel, and what of it its neighbour in front leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cover {
    pub lines: [f64; 3],
    pub behind: f64,
}

fn overlap(low: f64, high: f64, middle: f64, footprint: f64) -> f64 {
    (high.min(middle + 0.5 * footprint) - low.max(middle - 0.5 * footprint)).max(0.0)
}

fn add_seed(view: &View, params: &Params, cover: &mut Cover, seed: &Seed, from: DVec2, step: DVec2, depth: f64) {
    let from_edge = from - seed.place * step;
    let signed = from_edge.dot(seed.across);
    let along = (from_edge.perp_dot(seed.across).abs() - HALF_SEGMENT_PX).max(0.0);
    let distance = signed.hypot(along);
    let (first, second) = (from == DVec2::ZERO, from == step);
    let in_front = first && seed.side == Side::First || second && seed.side == Side::Second;
    let slack = if seed.side == Side::Both { (2.0 * distance + 2.0) * pixel_world(view, seed.depth) } else { 0.0 };
    let beyond = seed.side == Side::Both || first || second || signed > -BEYOND_SLACK_PX;
    let covered = in_front || beyond && depth > seed.depth - slack;
    let is_anywhere = seed.side != Side::Both && (seed.place * 255.0).round() == 128.0;
    let footprint = if is_anywhere { 1.0 } else { params.footprint_px };
    let mut most = 0.0f64;
    for (kind, line) in cover.lines.iter_mut().enumerate() {
        let width = params.width_px[kind];
        if seed.kinds >> kind & 1 == 0 || width <= 0.0 || !covered {
            continue;
        }
        let fade_from = if seed.outermost { 0.5 } else { 2.0 * width.clamp(0.01, 2.0) };
        let share = match (seed.side, in_front) {
            (Side::Both, _) => overlap(-0.5 * width, 0.5 * width, distance, footprint) / footprint,
            (_, true) => overlap(0.0, width, signed.min(0.0), footprint) / footprint,
            _ => overlap(0.0, width, distance, footprint) / (distance + 0.5 * footprint).min(footprint),
        };
        let share = share * (seed.radius_px / fade_from).min(1.0);
        *line = line.max(share);
        most = most.max(share);
    }
    if most > 0.0 && seed.side != Side::Both && !in_front && (first || second) {
        cover.behind = cover.behind.min((distance / footprint + 0.5).min(1.0));
    }
}

/// The effect on a whole picture of 1 sample: what covers each pixel, found the slow way.
pub fn covers(view: &View, params: &Params, size: [u32; 2], seen: &[Geometry]) -> Vec<Cover> {
    let [width, height] = size.map(|side| side as usize);
    let reach = params.width_px.into_iter().fold(0.0, f64::max) + 0.5 * params.footprint_px;
    let mut seeds = Vec::new();
    for (index, pixel) in gpu::pixels(size).enumerate() {
        for (step, beside) in [(DVec2::X, (index + 1) % width != 0), (DVec2::Y, index + width < width * height)] {
            let other = if step == DVec2::X { index + 1 } else { index + width };
            if beside && let Some(seed) = seed_between(view, params, &seen[index], &seen[other], center_px(pixel), step)
            {
                seeds.push((center_px(pixel), step, seed));
            }
        }
    }
    let mut covers = vec![Cover { lines: [0.0; 3], behind: 1.0 }; seen.len()];
    for (at, step, seed) in &seeds {
        let low = (*at - reach.floor()).floor().max(DVec2::ZERO);
        let high = (*at + reach.floor() + 1.0).floor().min(DVec2::new((width - 1) as f64, (height - 1) as f64));
        for y in low.y as usize..=high.y as usize {
            for x in low.x as usize..=high.x as usize {
                let index = y * width + x;
                let from = DVec2::new(x as f64, y as f64) + 0.5 - *at;
                add_seed(view, params, &mut covers[index], seed, from, *step, seen[index].depth);
            }
        }
    }
    covers
}

/// A scene of atoms `(chain, x, y, z)` of one radius, and its connectors, as engine and as truth.
pub struct Rig {
    pub engine: Engine,
    pub world: World,
    /// Of each shape of the world, at its first and second half.
    groups: Vec<[u32; 2]>,
}

impl Rig {
    /// `None` without an adapter.
    pub fn new(atoms: &[(char, DVec3)], size: [u32; 2], radius: f64, camera: &str, outline: &str) -> Option<Rig> {
        let lines = (1..).zip(atoms).map(|(number, (chain, at))| {
            let DVec3 { x, y, z } = at;
            format!("ATOM  {number:5}  C   ALA {chain}{number:4}    {x:8.3}{y:8.3}{z:8.3}  1.00  0.00           C\n")
        });
        let scene = Scene::from_bytes("test.pdb", lines.collect::<String>().as_bytes()).expect("a molecule");
        let style = format!(
            r##"{{ "camera": {{ "bgcolor": "#0000ff", {camera} }},
                "geometry": {{ "atom": "{radius}A", "scale": 1, "bond_radius": "{BOND_RADIUS}A" }},
                "mapping": {{ "*": "flat", "post_effects": ["lines"] }},
                "shaders": [ {{ "name": "flat", "shader": "unlit", "properties": {{ "base_color": "#00ff00" }} }},
                    {{ "name": "lines", "shader": "outlinePost", "properties": {{ "silhouette_color": "#ff0000",
                       "boundary_color": "#ff0000", "crease_color": "#ff0000", {outline} }} }} ] }}"##
        );
        let catalog = Catalog { shaders: &engine::catalog(), kinds: engine::DRAWN_KINDS };
        let style = config::load(&Source::new("test.json", style), &catalog).unwrap_or_else(|wrong| panic!("{wrong}"));
        let engine = Engine::new(gpu::device()?, scene, style);
        let world = World::new(&engine, size, &vec![radius; atoms.len()], BOND_RADIUS);
        let molecule = &engine.scene().expect("a scene").molecule;
        let group = |index: u32| {
            let atom = &molecule.atoms[index as usize];
            group_word(molecule.residue(atom).chain, atom.residue)
        };
        let of_atoms = (0..atoms.len() as u32).map(|index| [group(index); 2]);
        let groups = of_atoms.chain(molecule.bonds.iter().map(|bond| [group(bond.a), group(bond.b)])).collect();
        Some(Rig { engine, world, groups })
    }

    /// The groups of the two halves of an object.
    pub fn groups(&self, id: u32) -> [u32; 2] {
        let place = self.world.shapes.iter().position(|(of, _)| *of == id).expect("it is there");
        self.groups[place]
    }

    /// What a picture position sees.
    pub fn geometry(&self, at: DVec2) -> Geometry {
        let Some((id, shape, hit)) = self.world.seen(at) else { return NOTHING };
        let ray = self.world.view.ray(at);
        let place = self.world.shapes.iter().position(|(of, _)| *of == id).expect("what is seen is there");
        let (bend, second) = match shape {
            Shape::Sphere { radius, .. } => (1.0 / radius, false),
            Shape::Cylinder { a, b, radius } => {
                let along = (ray.origin + hit.t * ray.direction - 0.5 * (a + b)).dot(b - a);
                (if hit.cap { 0.0 } else { 1.0 / radius }, along > 0.0)
            }
        };
        let turned = if hit.normal.dot(ray.direction) > 0.0 { -1.0 } else { 1.0 };
        let group = self.groups[place][usize::from(second)];
        Geometry { depth: hit.t, normal: turned * hit.normal, bend, group, id }
    }
}

pub const BOND_RADIUS: f64 = 0.25;

/// Random atoms in a box, in three chains; the same each time.
pub fn random_atoms(count: usize, half: DVec3, seed: u64) -> Vec<(char, DVec3)> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64 * 2.0 - 1.0
    };
    (0..count).map(|i| (['A', 'B', 'C'][i % 3], half * DVec3::new(next(), next(), next()))).collect()
}

const SIZE: [u32; 2] = [160, 120];
const CHAINS: u32 = 0x7f << 9;

fn flat(id: u32, group: u32, depth: f64, normal: DVec3) -> Geometry {
    Geometry { depth, normal, bend: 0.0, group, id }
}

/// A view of pixels of size 1.
fn unit_view() -> View {
    View {
        view_from_world: glam::DMat4::IDENTITY,
        half_extent: DVec2::new(80.0, 60.0),
        size: DVec2::new(160.0, 120.0),
        orthographic: true,
        near: 0.1,
    }
}

fn params(width_px: [f64; 3], depth_step: f64) -> Params {
    let crease_cosine = 40f64.to_radians().cos();
    Params { width_px, crease_cosine, depth_step, group_mask: CHAINS, by_object: false, footprint_px: 1.0 }
}

/// A picture of two halves: left of the middle one surface, right of it another one.
fn halves(left: impl Fn(DVec2) -> Geometry, right: impl Fn(DVec2) -> Geometry) -> Vec<Geometry> {
    let half = f64::from(SIZE[0] / 2);
    gpu::pixels(SIZE).map(center_px).map(|at| if at.x < half { left(at) } else { right(at) }).collect()
}

#[test]
fn a_step_gets_a_line_of_its_width_on_what_is_behind() {
    for width in [1.0, 2.0, 7.5, 32.0] {
        let seen = halves(|_| flat(1, 0, 10.0, DVec3::Z), |_| flat(2, 0, 30.0, DVec3::Z));
        let covers = covers(&unit_view(), &params([0.0, 0.0, width], 5.0), SIZE, &seen);
        let row = &covers[60 * 160..61 * 160];
        assert!(row[..80].iter().all(|cover| cover.lines == [0.0; 3]), "the nearer half stays clear");
        let covered: f64 = row.iter().map(|cover| cover.lines[2]).sum();
        assert!((covered - width).abs() < 1e-9, "{covered} of {width} px");
    }
}

#[test]
fn a_step_smaller_than_asked_gets_none() {
    let seen = halves(|_| flat(1, 0, 10.0, DVec3::Z), |_| flat(2, 0, 14.0, DVec3::Z));
    let covers = covers(&unit_view(), &params([0.0, 0.0, 3.0], 5.0), SIZE, &seen);
    assert!(covers.iter().all(|cover| cover.lines == [0.0; 3]));
}

#[test]
fn a_grazing_plane_gets_no_line_and_its_groups_a_boundary() {
    for slope in [0.0, 1.0, 20.0, 200.0] {
        let normal = DVec3::new(slope, 0.0, 1.0).normalize();
        let plane = |id, group| move |at: DVec2| flat(id, group, 1000.0 + slope * (at.x - 80.0), normal);
        let one = halves(plane(1, 0), plane(2, 0));
        let lines = params([2.0, 2.0, 2.0], 5.0);
        let none = covers(&unit_view(), &lines, SIZE, &one);
        assert!(none.iter().all(|cover| cover.lines == [0.0; 3]), "slope {slope}");
        let two = covers(&unit_view(), &lines, SIZE, &halves(plane(1, 0), plane(2, 1 << 9)));
        let sum = |kind: usize| two[60 * 160..61 * 160].iter().map(|cover| cover.lines[kind]).sum::<f64>();
        assert_eq!((sum(0), sum(2)), (0.0, 0.0), "slope {slope}");
        assert!(slope > 1.0 || (sum(1) - 2.0).abs() < 1e-9, "slope {slope}: {} px", sum(1));
        assert!(sum(1) > 0.9, "slope {slope}: {} px", sum(1));
    }
}

#[test]
fn a_steep_surface_that_is_in_front_stays_clear() {
    // It comes forward to the step, more steeply than the line is wide.
    let normal = DVec3::new(-40.0, 0.0, 1.0).normalize();
    let steep = move |at: DVec2| flat(1, 0, 1000.0 - 40.0 * (at.x - 80.0), normal);
    let seen = halves(steep, |_| flat(2, 0, 5000.0, DVec3::Z));
    let covers = covers(&unit_view(), &params([0.0, 0.0, 6.0], 5.0), SIZE, &seen);
    let row = &covers[60 * 160..61 * 160];
    assert!(row[..79].iter().all(|cover| cover.lines == [0.0; 3]), "{:?}", &row[70..80]);
    let covered: f64 = row.iter().map(|cover| cover.lines[2]).sum();
    assert!((covered - 6.0).abs() < 0.5, "{covered} px");
}

#[test]
fn a_fold_gets_a_crease_from_its_angle_on() {
    for (degrees, expected) in [(15.0f64, 0.0), (25.0, 3.0)] {
        let slope = degrees.to_radians().tan();
        let side = |sign: f64| {
            let normal = DVec3::new(-sign * slope, 0.0, 1.0).normalize();
            move |at: DVec2| flat(1, 0, 100.0 - slope * (at.x - 80.0).abs(), normal)
        };
        let seen = halves(side(1.0), side(-1.0));
        let covers = covers(&unit_view(), &params([3.0, 0.0, 0.0], 5.0), SIZE, &seen);
        let sum: f64 = covers[60 * 160..61 * 160].iter().map(|cover| cover.lines[0]).sum();
        assert!((sum - expected).abs() < 1e-9, "{degrees}: {sum}");
    }
}

/// Share of pixels that may differ: where rounding decides between two neighbours' ids or a depth and a step.
const DIFFERING: f64 = 0.005;

#[test]
fn gpu_draws_the_twins_lines() {
    let cameras = [r#""orthographic": true"#, r#""fov": 50"#];
    let kinds = [
        ([0.0, 0.0, 2.0], "residue", 1.0),
        ([0.0, 2.0, 5.0], "chain", 1.0),
        ([1.5, 1.0, 0.0], "object", 0.3),
        ([2.0, 0.0, 14.0], "chain", 2.0),
    ];
    for (camera, ([crease, boundary, silhouette], of, step)) in
        cameras.into_iter().flat_map(|camera| kinds.into_iter().map(move |kind| (camera, kind)))
    {
        // Points are pixels of a picture of 1080.
        let points = |px: f64| px * 1080.0 / f64::from(SIZE[1]);
        let outline = format!(
            r#""crease_width": "{}pt", "boundary_width": "{}pt", "silhouette_width": "{}pt", "boundary": "{of}", "depth_step": "{step}A""#,
            points(crease),
            points(boundary),
            points(silhouette)
        );
        let atoms = random_atoms(24, DVec3::new(4.0, 3.0, 3.0), 7);
        let Some(mut rig) = Rig::new(&atoms, SIZE, 0.7, camera, &outline) else { return };
        let params = Params {
            group_mask: if of == "chain" { CHAINS } else { u32::MAX },
            by_object: of == "object",
            ..params([crease, boundary, silhouette], step)
        };
        let seen: Vec<Geometry> = gpu::pixels(SIZE).map(|pixel| rig.geometry(center_px(pixel))).collect();
        let twin = covers(&rig.world.view, &params, SIZE, &seen);
        let red = gpu::channel(&gpu::still(&mut rig.engine, SIZE, 1), 0);
        let (mut differing, mut lines) = (0.0, 0.0);
        for (cover, red) in twin.iter().zip(&red) {
            let clear: f64 = cover.lines.iter().map(|share| 1.0 - share).product();
            let expected = (1.0 - clear) * cover.behind;
            lines += expected;
            if (expected - red).abs() > 0.02 {
                differing += 1.0;
            }
        }
        eprintln!("{camera} {outline}: {lines:.0} px of lines, {differing} px differ");
        assert!(lines > 300.0 && differing <= DIFFERING * red.len() as f64, "{camera} {outline}: {differing}");
    }
}
