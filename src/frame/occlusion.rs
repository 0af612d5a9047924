//! Which objects to draw, nearest first: on a software adapter without those that nearer atoms hide wholly.
//!
//! Half of a protein's atoms lie within it. Finding them on the CPU costs less than casting rays at them there; a hardware
//! adapter gets the whole order. Hiding is exact: a tile of the picture counts as covered only where one
//! sphere covers all of it, and an object is left out only where all tiles that it touches are covered in front of it,
//! so the picture stays the same to the last bit (ours).

use glam::{Vec2, Vec3};

use super::view::View;

/// Depth is sorted into this many bins: fine enough for early rejection, and one pass whatever the count.
const DEPTH_BINS: usize = 2048;

/// Room for jitter and rounding, in pixels: samples lie within half a pixel of the pixel's centre.
const MARGIN_PX: f32 = 1.0;

/// A sphere around an object, in world space.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Centre.
    pub center: Vec3,
    /// Radius, of the atom itself or around the whole connector.
    pub radius: f32,
}

/// What hull outlines add to the reach of an object.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reach {
    /// In pixels.
    pub px: f32,
    /// In scene units.
    pub world: f32,
}

/// A ball in the picture.
struct Seen {
    center_px: Vec2,
    /// Radii of circles within and around its outline.
    inner_px: f32,
    outer_px: f32,
    nearest: f32,
    /// No visible point of it is deeper.
    farthest: f32,
}

/// Covered depth by tiles.
struct Tiles {
    size_px: f32,
    columns: usize,
    rows: usize,
    /// Everything deeper is hidden.
    covered: Vec<f32>,
}

/// Orders of atoms and connectors, nearest first; with `cull` without those that are hidden.
pub fn orders(view: &View, atoms: &[Ball], connectors: &[Ball], reach: Reach, cull: bool) -> (Vec<u32>, Vec<u32>) {
    let matrix = view.matrix();
    let toward = matrix.row(2).truncate() * -1.0;
    let mut atom_order = order_by_depth(atoms, toward);
    let mut connector_order = order_by_depth(connectors, toward);
    if cull && let Some(mut tiles) = Tiles::new(view, atoms) {
        let see = |ball: &Ball| Seen::new(view, matrix.transform_point3(ball.center), ball.radius, reach);
        atom_order.retain(|&index| match see(&atoms[index as usize]) {
            Some(seen) => {
                let visible = !tiles.hides(&seen);
                if visible {
                    tiles.cover(&seen);
                }
                visible
            }
            None => true,
        });
        connector_order.retain(|&index| see(&connectors[index as usize]).is_none_or(|seen| !tiles.hides(&seen)));
    }
    (atom_order, connector_order)
}

impl Seen {
    /// None where the ball reaches behind the near plane: such a one neither hides nor is hidden.
    fn new(view: &View, center: Vec3, radius: f32, reach: Reach) -> Option<Seen> {
        let depth = -center.z;
        let nearest = depth - radius - reach.world;
        if nearest <= view.near {
            return None;
        }
        let half = Vec2::from(view.half_extent);
        let size = Vec2::from(view.size_px);
        let orthographic = view.orthographic > 0.5;
        let scale = if orthographic { 1.0 } else { 1.0 / depth };
        let in_picture = (center.truncate() * scale / half * Vec2::new(0.5, -0.5) + 0.5) * size;
        let center_px = in_picture - Vec2::from(view.tile_origin_px);
        let outer_radius = radius + reach.world;
        let (inner, outer, lean) = if orthographic {
            (radius, outer_radius, 0.0)
        } else {
            // On the axis the outline's radius is r / sqrt(d^2 - r^2); off the axis it stretches by up to 1/cos^2 of
            // the ball's farthest direction. At least r / depth everywhere.
            let squared = center.length_squared();
            let farthest_slope = center.truncate().length() / depth + outer_radius / nearest;
            let tangent = outer_radius / (squared - outer_radius * outer_radius).max(f32::MIN_POSITIVE).sqrt();
            let stretch = 1.0 + farthest_slope * farthest_slope;
            (radius / squared.sqrt(), tangent * stretch, center.truncate().length() / squared.sqrt())
        };
        Some(Seen {
            center_px,
            inner_px: inner / view.pixel_view - MARGIN_PX,
            outer_px: outer / view.pixel_view + reach.px + MARGIN_PX,
            nearest,
            farthest: depth + lean * radius,
        })
    }
}

impl Tiles {
    /// Tiles a sixth as wide as the median atom's radius, so that an atom covers many; none where atoms are too small
    /// for that, or there are none.
    fn new(view: &View, atoms: &[Ball]) -> Option<Tiles> {
        let mut radii: Vec<f32> = atoms.iter().map(|atom| atom.radius).collect();
        if radii.is_empty() {
            return None;
        }
        let middle = radii.len() / 2;
        let radius = *radii.select_nth_unstable_by(middle, f32::total_cmp).1;
        let matrix = view.matrix();
        let depth = -matrix.transform_point3(atoms[middle].center).z;
        let scale = if view.orthographic > 0.5 { 1.0 } else { 1.0 / depth.max(view.near) };
        let size_px = (radius * scale / view.pixel_view / 6.0).clamp(0.0, 32.0);
        if size_px < 1.0 {
            return None;
        }
        let columns = (view.tile_size_px[0] / size_px).ceil() as usize;
        let rows = (view.tile_size_px[1] / size_px).ceil() as usize;
        Some(Tiles { size_px, columns, rows, covered: vec![f32::INFINITY; columns * rows] })
    }

    /// The tiles from `low` to `high` along one side; none where they lie outside the picture.
    fn span(&self, low: f32, high: f32, count: usize) -> Option<(usize, usize)> {
        let first = (low / self.size_px).floor();
        let last = (high / self.size_px).floor();
        if last < 0.0 || first >= count as f32 {
            return None;
        }
        Some((first.max(0.0) as usize, (last as usize).min(count - 1)))
    }

    /// Whether nearer spheres cover all tiles that it touches.
    fn hides(&self, seen: &Seen) -> bool {
        let (low, high) = (seen.center_px - seen.outer_px, seen.center_px + seen.outer_px);
        let (Some((left, right)), Some((top, bottom))) =
            (self.span(low.x, high.x, self.columns), self.span(low.y, high.y, self.rows))
        else {
            // Out of the picture.
            return true;
        };
        (top..=bottom).all(|row| {
            self.covered[row * self.columns + left..=row * self.columns + right].iter().all(|&z| z < seen.nearest)
        })
    }

    /// Marks the tiles that it covers wholly.
    fn cover(&mut self, seen: &Seen) {
        if seen.inner_px < self.size_px {
            return;
        }
        let (low, high) = (seen.center_px - seen.inner_px, seen.center_px + seen.inner_px);
        let (Some((left, right)), Some((top, bottom))) =
            (self.span(low.x, high.x, self.columns), self.span(low.y, high.y, self.rows))
        else {
            return;
        };
        // Distance from the centre to the far side of a tile, along one axis.
        let far = |index: usize, center: f32| {
            let start = index as f32 * self.size_px - center;
            start.abs().max((start + self.size_px).abs())
        };
        let limit = seen.inner_px * seen.inner_px;
        for row in top..=bottom {
            let y = far(row, seen.center_px.y);
            for column in left..=right {
                let x = far(column, seen.center_px.x);
                if x * x + y * y <= limit {
                    let covered = &mut self.covered[row * self.columns + column];
                    *covered = covered.min(seen.farthest);
                }
            }
        }
    }
}

/// Indices of `balls`, nearest centre first along `toward`, exact to one part in [`DEPTH_BINS`]; linear in their number.
fn order_by_depth(balls: &[Ball], toward: Vec3) -> Vec<u32> {
    let depths: Vec<f32> = balls.iter().map(|ball| ball.center.dot(toward)).collect();
    let (low, high) = depths.iter().fold((f32::MAX, f32::MIN), |(low, high), &depth| (low.min(depth), high.max(depth)));
    let scale = (DEPTH_BINS - 1) as f32 / (high - low).max(f32::MIN_POSITIVE);
    let bin = |depth: f32| (((depth - low) * scale) as usize).min(DEPTH_BINS - 1);
    let mut starts = vec![0u32; DEPTH_BINS + 1];
    for &depth in &depths {
        starts[bin(depth) + 1] += 1;
    }
    for index in 1..starts.len() {
        starts[index] += starts[index - 1];
    }
    let mut order = vec![0u32; balls.len()];
    for (index, &depth) in depths.iter().enumerate() {
        let slot = &mut starts[bin(depth)];
        order[*slot as usize] = index as u32;
        *slot += 1;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Camera;
    use glam::Mat4;

    fn view(orthographic: bool) -> View {
        let half_extent = if orthographic { Vec2::splat(5.0) } else { Vec2::splat(0.5) };
        let camera = Camera { view_from_world: Mat4::IDENTITY, half_extent, orthographic, near: 0.1, far: 100.0 };
        View::new(&camera, [500, 500])
    }

    fn ball(x: f32, y: f32, depth: f32, radius: f32) -> Ball {
        Ball { center: Vec3::new(x, y, -depth), radius }
    }

    #[test]
    fn the_order_is_a_permutation_and_nearest_first() {
        let balls: Vec<Ball> = (0..1000).map(|i| ball(0.0, 0.0, (i * 7919 % 1000) as f32, 1.0)).collect();
        let order = order_by_depth(&balls, Vec3::NEG_Z);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &v)| i as u32 == v));
        let depths: Vec<f32> = order.iter().map(|&i| -balls[i as usize].center.z).collect();
        assert!(depths.windows(2).all(|pair| pair[1] >= pair[0] - 1000.0 / DEPTH_BINS as f32));
    }

    #[test]
    fn equal_depths_are_all_kept() {
        assert_eq!(order_by_depth(&[ball(1.0, 2.0, 3.0, 1.0); 5], Vec3::Z), [0, 1, 2, 3, 4]);
        assert!(order_by_depth(&[], Vec3::Z).is_empty());
    }

    #[test]
    fn only_what_lies_wholly_behind_a_larger_ball_is_left_out() {
        for orthographic in [false, true] {
            let balls = [ball(0.0, 0.0, 10.0, 2.0), ball(0.3, 0.0, 14.0, 0.5), ball(2.4, 0.0, 14.0, 0.5)];
            let (order, _) = orders(&view(orthographic), &balls, &[], Reach::default(), true);
            assert_eq!(order, [0, 2], "orthographic: {orthographic}");
            let (order, _) = orders(&view(orthographic), &balls, &[], Reach::default(), false);
            assert_eq!(order, [0, 1, 2]);
        }
    }

    #[test]
    fn a_ball_that_pokes_through_stays() {
        let balls = [ball(0.0, 0.0, 10.0, 2.0), ball(0.0, 0.0, 11.5, 3.6)];
        let (order, _) = orders(&view(false), &balls, &[], Reach::default(), true);
        assert_eq!(order.len(), 2);
    }

    #[test]
    fn outlines_reach_beyond_the_ball() {
        let balls = [ball(0.0, 0.0, 10.0, 2.0), ball(0.0, 0.0, 14.0, 1.0)];
        let wide = Reach { px: 200.0, world: 0.0 };
        assert_eq!(orders(&view(true), &balls, &[], wide, true).0, [0, 1]);
    }
}
