//! What is out of focus: lines of sight that bend where the circle of confusion begins or ceases to grow.
//!
//! A point at depth z is seen from all places of a disc around its own, as wide as [`Circles`] say. Between the depths where they
//! grow otherwise such lines of sight are straight: one of them is a lens [Potmesil1981 §2]. An orthographic view has no lens; there they
//! are a sheaf of parallel views.

use glam::{DVec2, DVec3};

use super::Optics;
use super::primitive::Ray;
use super::sampling::disc_point;
use crate::effects::focus::Circles;

/// A piece of a line of sight.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    /// The depth at which it begins.
    pub from: f64,
    /// The depth at which the next one begins.
    pub until: f64,
    /// Its line; `t` is depth.
    pub ray: Ray,
}

/// A line of sight, from the eye.
#[derive(Debug, Clone)]
pub struct Sight {
    pieces: [Option<Piece>; 5],
}

impl Sight {
    /// That of a place in the picture, through a place of a lens, a point of the unit square, where there is one.
    pub fn new(optics: &Optics, place_px: DVec2, lens: Option<(&Lens, DVec2)>) -> Sight {
        let straight = optics.ray(place_px);
        match lens {
            Some((lens, point)) => lens.sight(optics, straight, point),
            None => {
                let all = Piece { from: optics.near, until: f64::INFINITY, ray: straight };
                Sight { pieces: [Some(all), None, None, None, None] }
            }
        }
    }

    /// Its pieces, nearest first.
    pub fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.pieces.iter().flatten()
    }

    /// The line of the piece at a depth, or of the nearest piece.
    pub fn line_at(&self, depth: f64) -> Ray {
        let at_depth = self.pieces().find(|piece| depth < piece.until).or_else(|| self.pieces().last());
        at_depth.map_or(Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Z }, |piece| piece.ray)
    }
}

/// What blurs before a camera, and how the lines of sight of a place come about.
#[derive(Debug, Clone, Copy)]
pub struct Lens {
    circles: Circles,
    /// Between these depths diameters in pixels are the first number plus the second times the measure.
    spans: [(f64, f64, [f64; 2]); 5],
}

impl Lens {
    /// One that blurs so; `front` is the least depth at which anything lies.
    pub fn new(circles: Circles, front: f64) -> Lens {
        let Circles {
            orthographic,
            sharp: [from, to],
            slopes_px: [before, behind],
            most_px: [most_before, most_behind],
        } = circles;
        // Where a measure is met: behind everything, if it never is.
        let depth = |measure: f64| match orthographic {
            true => measure,
            false if measure < 0.0 => -1.0 / measure,
            false => f64::INFINITY,
        };
        let bends = [depth(from - most_before / before), depth(from), depth(to), depth(to + most_behind / behind)];
        let lines =
            [[-most_before, 0.0], [-before * from, before], [0.0, 0.0], [-behind * to, behind], [most_behind, 0.0]];
        let mut spans = [(0.0, 0.0, [0.0; 2]); 5];
        let mut start = f64::NEG_INFINITY;
        for (index, (span, line)) in spans.iter_mut().zip(lines).enumerate() {
            let end = bends.get(index).map_or(f64::INFINITY, |end| end.max(start));
            // What ends before anything begins is never looked along.
            *span = (start, if end <= front { start } else { end }, line);
            start = if end <= front { start } else { end };
        }
        Lens { circles, spans }
    }

    /// How wide things blur.
    pub fn circles(&self) -> &Circles {
        &self.circles
    }

    fn sight(&self, optics: &Optics, sharp: Ray, point: DVec2) -> Sight {
        // A circle of one pixel is pixel_view wide on the plane at depth 1.
        let off = 0.5 * optics.pixel_view * disc_point(point);
        let piece = |(from, until, [plain, growing]): (f64, f64, [f64; 2])| {
            let along = |origin: f64, direction: f64| Ray {
                origin: sharp.origin + (origin * off).extend(0.0),
                direction: sharp.direction + (direction * off).extend(0.0),
            };
            // Off the straight line at depth z by the diameter there: in perspective times z.
            let ray = if optics.orthographic { along(plain, growing) } else { along(-growing, plain) };
            (from < until).then_some(Piece { from: from.max(optics.near), until, ray })
        };
        Sight { pieces: self.spans.map(piece) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::focus::measure;
    use crate::scene::Camera;
    use glam::{Mat4, Vec2};

    fn optics(orthographic: bool) -> Optics {
        let camera = Camera {
            view_from_world: Mat4::IDENTITY,
            half_extent: Vec2::splat(0.5),
            orthographic,
            near: 0.1,
            far: 100.0,
        };
        Optics::new(&camera, [400, 400])
    }

    /// The place in the picture of a point in view space.
    fn project(optics: &Optics, point: DVec3) -> DVec2 {
        let plane = if optics.orthographic { point.truncate() } else { point.truncate() / -point.z };
        (plane / optics.half_extent * DVec2::new(0.5, -0.5) + 0.5) * optics.size_px
    }

    fn layers(orthographic: bool) -> Circles {
        let [z0, z1, z2, z3] = [4.0, 6.0, 9.0, 14.0].map(|depth| measure(orthographic, depth));
        Circles {
            orthographic,
            sharp: [z1, z2],
            slopes_px: [20.0 / (z1 - z0), 30.0 / (z3 - z2)],
            most_px: [20.0, 30.0],
        }
    }

    #[test]
    fn a_point_is_seen_from_the_circle_of_its_depth() {
        for orthographic in [false, true] {
            let optics = optics(orthographic);
            let lens = Lens::new(layers(orthographic), 0.2);
            for (depth, expected) in [(3.0, -20.0), (4.0, -20.0), (6.0, 0.0), (8.0, 0.0), (14.0, 30.0), (60.0, 30.0)] {
                assert!((lens.circles().diameter_px(depth) - expected).abs() < 1e-9, "{depth}");
            }
            for depth in [3.0, 4.7, 5.9, 6.0, 8.0, 9.5, 12.0, 20.0, 60.0] {
                // Which pixels see a point: a line of sight meets its depth at the place of the straight one moved by the blur.
                let (mut widest, center) = (0.0f64, DVec2::new(137.0, 260.0));
                for turn in 0..64 {
                    let rim = DVec2::new(1.0, f64::from(turn) / 64.0);
                    let sight = Sight::new(&optics, center, Some((&lens, rim)));
                    let met: Vec<_> = sight.pieces().filter(|p| p.from <= depth && depth < p.until).collect();
                    let [piece] = met[..] else { panic!("{depth}: {met:?}") };
                    let met = piece.ray.at(depth);
                    assert!((met.z + depth).abs() < 1e-12, "t is depth");
                    widest = widest.max(2.0 * project(&optics, met).distance(center));
                }
                let expected = lens.circles().diameter_px(depth).abs();
                assert!((widest - expected).abs() < 1e-9 * (1.0 + expected), "{depth}: {widest} {expected}");
            }
        }
    }

    #[test]
    fn pieces_follow_each_other_and_meet() {
        for orthographic in [false, true] {
            let optics = optics(orthographic);
            for (front, pieces) in [(0.2, 5), (4.5, 4), (6.0, 3), (10.0, 2), (50.0, 1)] {
                let lens = Lens::new(layers(orthographic), front);
                let sight = Sight::new(&optics, DVec2::splat(70.0), Some((&lens, DVec2::new(0.4, 0.9))));
                let found: Vec<_> = sight.pieces().collect();
                assert_eq!(found.len(), pieces, "{front}");
                assert_eq!(found[0].from, optics.near);
                assert_eq!(found[pieces - 1].until, f64::INFINITY);
                for pair in found.windows(2) {
                    assert_eq!(pair[0].until, pair[1].from);
                    assert!(pair[0].ray.at(pair[0].until).distance(pair[1].ray.at(pair[1].from)) < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_lens_is_the_thin_lens_formula() {
        // A f |z - s| / (z (s - f)), with the image scaled so that f -> 0.
        let circles = Circles { orthographic: false, sharp: [-1.0 / 8.0; 2], slopes_px: [400.0; 2], most_px: [1e3; 2] };
        let quotient = circles.diameter_px(12.0) / circles.diameter_px(20.0);
        assert!((quotient - (4.0 / 12.0) / (12.0 / 20.0)).abs() < 1e-12);
    }
}
