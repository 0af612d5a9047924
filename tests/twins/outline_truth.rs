//! `outlinePost` against truths: exact areas, contours on a lattice far finer than pixels, and a slow pan.

use super::gpu;
use super::outline::{Geometry, Rig, random_atoms};
use super::truth::center_px;
use glam::{DVec2, DVec3};
use restyle::measure::metrics::share_near;

const SIZE: [u32; 2] = [160, 120];
/// Lines of sight along which the truth looks for edges, a pixel.
const LINES: u32 = 3;

fn points(px: f64) -> f64 {
    px * 1080.0 / f64::from(SIZE[1])
}

fn silhouettes(width_px: f64, step: f64) -> String {
    format!(r#""silhouette_width": "{}pt", "boundary_width": "0pt", "depth_step": "{step}A""#, points(width_px))
}

/// Red light of a still: the share of each pixel that lines cover.
fn lines(rig: &mut Rig, samples: u32) -> Vec<f64> {
    gpu::channel(&gpu::still(&mut rig.engine, SIZE, samples), 0)
}

#[test]
fn a_line_around_a_ball_has_the_area_of_its_ring() {
    for (width, samples) in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0].into_iter().flat_map(|width| [(width, 1), (width, 16)]) {
        let camera = r#""orthographic": true, "zoom": 0.5"#;
        let Some(mut rig) =
            Rig::new(&[('A', DVec3::new(0.01, 0.02, 0.0))], SIZE, 1.6, camera, &silhouettes(width, 1.0))
        else {
            return;
        };
        let radius = 1.6 / rig.world.view.pixel_view();
        let area: f64 = lines(&mut rig, samples).iter().sum();
        // The ring between radius and radius + width has the area 2 pi (radius + width / 2) width.
        let found = (radius * radius + area / std::f64::consts::PI).sqrt() - radius;
        eprintln!("{width} px, {samples} samples: {found:.3} px");
        assert!((found - width).abs() <= 0.25, "{width} px, {samples} samples: {found}");
    }
}

/// A point of a contour: its place in the picture, and the depth of what lies in front and behind.
struct Contour {
    at: DVec2,
    near: f64,
    far: f64,
}

/// Contours where depth jumps by more than `step`, each found on a line of sight to a 64th of a pixel.
fn contours(rig: &Rig, step: f64) -> Vec<Contour> {
    let mut found = Vec::new();
    let fine = 1.0 / f64::from(LINES);
    for (along, across, axis) in [(SIZE[0], SIZE[1], DVec2::X), (SIZE[1], SIZE[0], DVec2::Y)] {
        for line in 0..across * LINES {
            let start = (f64::from(line) + 0.5) * fine * (DVec2::ONE - axis);
            let seen = |place: f64| rig.geometry(start + place * axis);
            let mut before: Option<(f64, Geometry)> = None;
            for place in (0..along * LINES).map(|index| (f64::from(index) + 0.5) * fine) {
                let here = seen(place);
                if let Some((mut low, mut first)) = before
                    && first.id != here.id
                {
                    let (mut high, mut second) = (place, here);
                    while high - low > 1.0 / 64.0 {
                        let middle = 0.5 * (low + high);
                        let between = seen(middle);
                        if between.id == first.id {
                            (low, first) = (middle, between)
                        } else {
                            (high, second) = (middle, between)
                        }
                    }
                    let (near, far) = (first.depth.min(second.depth), first.depth.max(second.depth));
                    if far - near > step {
                        found.push(Contour { at: start + 0.5 * (low + high) * axis, near, far });
                    }
                }
                before = Some((place, here));
            }
        }
    }
    found
}

/// Whether each pixel's centre lies within `width` of a contour that is in front of it.
fn line_mask(rig: &Rig, contours: &[Contour], width: f64, step: f64) -> Vec<bool> {
    // Contours by pixel, so that only those nearby are tried.
    let mut cells: Vec<Vec<&Contour>> = Vec::new();
    cells.resize_with((SIZE[0] * SIZE[1]) as usize, Vec::new);
    for contour in contours {
        cells[contour.at.y as usize * SIZE[0] as usize + contour.at.x as usize].push(contour);
    }
    let reach = width.ceil() as i64;
    let inside = |x: i64, y: i64| (0..i64::from(SIZE[0])).contains(&x) && (0..i64::from(SIZE[1])).contains(&y);
    let covered = |(x, y): (u32, u32)| {
        let (at, depth) = (center_px((x, y)), rig.geometry(center_px((x, y))).depth);
        (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (i64::from(x) + dx, i64::from(y) + dy))).any(
            |(x, y)| {
                inside(x, y)
                    && cells[y as usize * SIZE[0] as usize + x as usize].iter().any(|contour| {
                        contour.at.distance_squared(at) <= width * width
                            && depth > contour.near + 0.5 * step.min(contour.far - contour.near)
                    })
            },
        )
    };
    gpu::pixels(SIZE).map(covered).collect()
}

/// Precision and recall of pixels of lines, within a pixel.
const ACCEPTED: f64 = 0.98;

#[test]
fn lines_lie_where_contours_are() {
    let chain: Vec<_> =
        (0..8).map(|i| ('A', DVec3::new(f64::from(i) * 1.3 - 4.5, f64::from(i % 2), f64::from(i % 3)))).collect();
    let scenes = [
        ("apart", random_atoms(14, DVec3::new(6.0, 4.0, 5.0), 3), 0.9),
        ("dense", random_atoms(70, DVec3::new(5.0, 4.0, 4.0), 5), 0.8),
        ("small", random_atoms(40, DVec3::new(9.0, 7.0, 6.0), 9), 0.35),
        ("connected", chain, 0.4),
    ];
    let cameras = [r#""orthographic": true"#, r#""fov": 40"#];
    for ((name, atoms, radius), camera) in scenes.into_iter().zip(cameras.into_iter().cycle()) {
        let step = 1.0;
        let Some(rig) = Rig::new(&atoms, SIZE, radius, camera, &silhouettes(1.0, step)) else { return };
        let contours = contours(&rig, step);
        for width in [1.5, 4.0, 12.0] {
            let Some(mut rig) = Rig::new(&atoms, SIZE, radius, camera, &silhouettes(width, step)) else { return };
            let truth = line_mask(&rig, &contours, width, step);
            let drawn: Vec<bool> = lines(&mut rig, 1).iter().map(|share| *share > 0.5).collect();
            let (precision, recall) =
                (share_near(&drawn, &truth, SIZE[0] as usize), share_near(&truth, &drawn, SIZE[0] as usize));
            eprintln!("{name}, {camera}, {width} px: precision {precision:.4}, recall {recall:.4}");
            assert!(precision >= ACCEPTED && recall >= ACCEPTED, "{name}, {camera}, {width} px: {precision} {recall}");
        }
    }
}

/// Change between frames against that of the truth.
const FLICKER: f64 = 1.2;

#[test]
fn a_slow_pan_does_not_flicker() {
    let atoms = random_atoms(30, DVec3::new(6.0, 4.0, 5.0), 11);
    let pan = |frame: u32, samples: u32| -> Option<Vec<f64>> {
        // Half the picture's height is one radius of the sphere, as near as counts here.
        let shift = 0.05 * f64::from(frame) * 2.0 / f64::from(SIZE[1]);
        let camera = format!(r#""orthographic": true, "position": [{shift}, 0, 4], "target": [{shift}, 0, 0]"#);
        let mut rig = Rig::new(&atoms, SIZE, 0.9, &camera, &silhouettes(2.0, 1.0))?;
        Some(lines(&mut rig, samples))
    };
    let change = |samples: u32| -> Option<f64> {
        let frames: Option<Vec<_>> = (0..12).map(|frame| pan(frame, samples)).collect();
        let frames = frames?;
        let differences = frames.windows(2).flat_map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).abs()));
        Some(differences.sum::<f64>())
    };
    let (Some(drawn), Some(truth)) = (change(1), change(64)) else { return };
    eprintln!("change of a pan: {drawn:.2} with one sample, {truth:.2} with 64: {:.3}", drawn / truth);
    assert!(drawn <= FLICKER * truth, "{drawn} {truth}");
}
