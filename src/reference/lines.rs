//! `outlinePost` from many lines of sight a pixel: where depth jumps, where groups meet, where surfaces fold.
//!
//! The same rules as in `shaders/effects/outline.wgsl`, looked for between places of a grid that is finer than pixels; a line
//! is the set of places within its width of an edge. What goes on beyond a place is the sphere that touches the surface there.
//! Through a lens each of its places has a grid of its own.

use glam::{DVec2, DVec3};

use super::lens::Sight;
use super::{Lens, Optics};
use crate::effects::outline::{MAX_WIDTH_PX, OutlineParams};

const CREASE: usize = 0;
const BOUNDARY: usize = 1;
const SILHOUETTE: usize = 2;
/// Steps of depth below this are none, in pixels.
const LEAST_STEP_PX: f64 = 1.0;

/// What a place of the grid sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Along the line of sight.
    pub depth: f64,
    /// Unit, to the viewer, interpolated and of the facet.
    pub normal: DVec3,
    /// The same of the facet.
    pub facet: DVec3,
    /// 1 over the radius, 0 where flat.
    pub bend: f64,
    /// Group word of 16 bits; 0 of meshes.
    pub group: u32,
    /// Which atom, connector or part; 0 for a hull outline, which is a line already.
    pub id: u64,
}

/// A part of the picture as a grid of places.
pub struct Grid<'a> {
    /// Who looks.
    pub optics: &'a Optics,
    /// Through which place of a lens, if there is one.
    pub lens: Option<(&'a Lens, DVec2)>,
    /// The first pixel, which may lie outside the picture.
    pub origin_px: DVec2,
    /// Places to each side of a pixel.
    pub side: u32,
    /// How much farther lines reach than they are wide, in places, -0.5 to 0.5: over many grids they are as wide as they should be,
    /// however coarse each is.
    pub dither: f64,
    /// Places across and down.
    pub size: [usize; 2],
    /// What each sees, row by row.
    pub places: Vec<Option<Place>>,
}

/// A piece of an edge, between two places.
struct Mark {
    /// In places from the grid's corner.
    at: DVec2,
    /// Which kinds of line lie there.
    kinds: [bool; 3],
    /// What is in front, on its line of sight, and how far behind it the other lies; none where surfaces touch.
    front: Option<(Place, Sight, f64)>,
    /// Depth of the edge, for widths in scene units.
    depth: f64,
    radius_px: f64,
    outermost: bool,
}

/// Widest line of an effect in pixels, for pixels of this many scene units at the least.
pub fn reach_px(params: &OutlineParams, least_pixel: f64) -> f64 {
    let widths = params.width_px.iter().zip(params.width_world);
    let width = |(px, world): (&f32, f32)| f64::from(*px) + f64::from(world) / least_pixel.max(f64::MIN_POSITIVE);
    widths.map(width).fold(0.0, f64::max).min(MAX_WIDTH_PX)
}

impl Grid<'_> {
    /// The line of sight of a place.
    pub fn sight(&self, [x, y]: [usize; 2]) -> Sight {
        let place = self.origin_px + DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / f64::from(self.side);
        Sight::new(self.optics, place, self.lens)
    }

    fn seen(&self, [x, y]: [usize; 2]) -> Option<&Place> {
        self.places.get(y * self.size[0] + x)?.as_ref()
    }

    /// The share by which each line covers each place: crease, boundary, silhouette.
    pub fn covered(&self, params: &OutlineParams) -> Vec<[f64; 3]> {
        let mut covered = vec![[0.0; 3]; self.places.len()];
        for mark in self.marks(params) {
            for kind in [CREASE, BOUNDARY, SILHOUETTE] {
                let world = f64::from(params.width_world[kind]) / self.optics.pixel(mark.depth);
                let width = (f64::from(params.width_px[kind]) + world).min(MAX_WIDTH_PX);
                if mark.kinds[kind] && width > 0.0 {
                    self.cover(&mark, kind, width, &mut covered);
                }
            }
        }
        covered
    }

    fn cover(&self, mark: &Mark, kind: usize, width: f64, covered: &mut [[f64; 3]]) {
        // A line fades where it is as wide as what it outlines.
        let fade_from = if mark.outermost { 0.5 } else { 2.0 * width.clamp(0.01, 2.0) };
        let share = (mark.radius_px / fade_from).min(1.0);
        let reach = self.dither + f64::from(self.side) * if mark.front.is_some() { width } else { 0.5 * width };
        let last = DVec2::new(self.size[0] as f64 - 1.0, self.size[1] as f64 - 1.0);
        let low = (mark.at - reach - 0.5).ceil().max(DVec2::ZERO);
        let high = (mark.at + reach - 0.5).floor().min(last);
        let mut y = low.y;
        while y <= high.y {
            let mut x = low.x;
            while x <= high.x {
                let index = y as usize * self.size[0] + x as usize;
                let way = DVec2::new(x + 0.5, y + 0.5) - mark.at;
                if covered[index][kind] < share && way.length() <= reach && self.is_behind(mark, way, index) {
                    covered[index][kind] = share;
                }
                x += 1.0;
            }
            y += 1.0;
        }
    }

    /// Whether a line covers the place a `way` from its edge: the way leads to the side behind, and so does the place lie.
    fn is_behind(&self, mark: &Mark, way: DVec2, index: usize) -> bool {
        let own = self.places[index].as_ref();
        if own.is_some_and(|own| own.id == 0) {
            return false;
        }
        let Some((front, on, behind)) = &mark.front else { return true };
        let beside = (mark.at + way.normalize_or_zero()).floor();
        if beside.x < 0.0 || beside.y < 0.0 || beside.x >= self.size[0] as f64 || beside.y >= self.size[1] as f64 {
            return false;
        }
        let beside = [beside.x as usize, beside.y as usize];
        let is_front = self.seen(beside).is_some_and(|seen| {
            let (goes_on, ends) = continued(front, on, &self.sight(beside));
            seen.depth <= front.depth || (!ends && (seen.depth - goes_on).abs() < 0.5 * behind)
        });
        !is_front && own.is_none_or(|own| own.depth > front.depth + 0.5 * behind)
    }

    fn marks(&self, params: &OutlineParams) -> Vec<Mark> {
        let [width, height] = self.size;
        let mut marks = Vec::new();
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            for step in [[1, 0], [0, 1]] {
                if x + step[0] < width && y + step[1] < height {
                    marks.extend(self.mark([x, y], step, params));
                }
            }
        }
        marks
    }

    /// The edge between a place and the next one to the right or down.
    fn mark(&self, at: [usize; 2], step: [usize; 2], params: &OutlineParams) -> Option<Mark> {
        let other = [at[0] + step[0], at[1] + step[1]];
        let (a, b) = (self.seen(at), self.seen(other));
        let (on_a, on_b) = (self.sight(at), self.sight(other));
        let place = 0.5 * DVec2::new((at[0] + other[0] + 1) as f64, (at[1] + other[1] + 1) as f64);
        let least = |depth: f64| LEAST_STEP_PX * self.optics.pixel(depth);
        let step_at = |depth: f64| f64::from(params.depth_step).max(least(depth));
        let radius_px = |of: &Place| 1.0 / (of.bend * self.optics.pixel(of.depth)).max(1e-9);
        let (a, b) = match (a, b) {
            (None, None) => return None,
            (Some(only), None) | (None, Some(only)) => {
                let on = if a.is_some() { on_a } else { on_b };
                return (only.id != 0).then(|| Mark {
                    at: place,
                    kinds: [false, false, true],
                    front: Some((*only, on, step_at(only.depth))),
                    depth: only.depth,
                    radius_px: radius_px(only),
                    outermost: true,
                });
            }
            (Some(a), Some(b)) => (a, b),
        };
        if a.id == 0 || b.id == 0 {
            return None;
        }
        let is_same_round = a.id == b.id && a.bend != 0.0;
        let (gap, a_nearer) = if is_same_round { (0.0, a.depth < b.depth) } else { gap(a, &on_a, b, &on_b) };
        let front = if a_nearer { a } else { b };
        let (least, step_world) = (least(front.depth), step_at(front.depth));
        let is_part = |place: &Place| place.id >> 32 == 3;
        let groups_differ =
            params.by_object != 0 || (a.group ^ b.group) & params.group_mask != 0 || is_part(a) || is_part(b);
        let touches = gap <= least;
        let kinds = [
            touches && self.folds(at, step, f64::from(params.crease_cosine), least),
            a.id != b.id && groups_differ,
            gap > step_world,
        ];
        kinds.contains(&true).then(|| Mark {
            at: place,
            kinds,
            front: (!touches).then(|| (*front, if a_nearer { on_a } else { on_b }, step_world.min(gap))),
            depth: front.depth,
            radius_px: if touches { radius_px(a).max(radius_px(b)) } else { radius_px(front) },
            outermost: false,
        })
    }

    /// Whether surfaces turn by more than an angle within a pixel, rounded or not, and half of the whole fold lies before a
    /// step's end: there the line lies.
    fn folds(&self, at: [usize; 2], step: [usize; 2], cosine: f64, least: f64) -> bool {
        let side = self.side as usize;
        let angle = cosine.clamp(-1.0, 1.0).acos();
        // Less than this is flat.
        let flat = angle / (2.0 * side as f64);
        // The step so many places on; none where it ends or jumps.
        let turn = |offset: isize| -> Option<f64> {
            let place = |offset: isize| {
                let x = at[0].checked_add_signed(offset * step[0] as isize)?;
                let y = at[1].checked_add_signed(offset * step[1] as isize)?;
                (x < self.size[0] && y < self.size[1]).then_some([x, y])
            };
            let (from, to) = (place(offset)?, place(offset + 1)?);
            let (p, q) = (self.seen(from)?, self.seen(to)?);
            let is_round = p.id == q.id && p.bend != 0.0;
            let touches = is_round || gap(p, &self.sight(from), q, &self.sight(to)).0 <= least;
            let turn = if is_round { 0.0 } else { p.normal.dot(q.normal).clamp(-1.0, 1.0).acos() };
            (p.id != 0 && q.id != 0 && touches).then_some(turn)
        };
        let Some(own) = turn(0).filter(|own| *own >= flat) else { return false };
        // The fold is as long as it turns, and never many pixels.
        let most = 4 * side as isize;
        let before: Vec<f64> = (1..=most).map_while(|offset| turn(-offset).filter(|turn| *turn >= flat)).collect();
        let after: Vec<f64> = (1..=most).map_while(|offset| turn(offset).filter(|turn| *turn >= flat)).collect();
        let (until, beyond) = (before.iter().sum::<f64>(), after.iter().sum::<f64>());
        let half = 0.5 * (until + own + beyond);
        if until >= half || until + own < half {
            return false;
        }
        let turns: Vec<f64> = before.iter().rev().copied().chain([own]).chain(after).collect();
        turns.windows(side.min(turns.len())).any(|window| window.iter().sum::<f64>() > angle)
    }
}

/// How far one of two neighbours lies behind the other where that ends, 0 where they meet; and whether the first is in front.
fn gap(a: &Place, sight_a: &Sight, b: &Place, sight_b: &Sight) -> (f64, bool) {
    let ((on_b, a_ends), (on_a, b_ends)) = (continued(a, sight_a, sight_b), continued(b, sight_b, sight_a));
    let (a_behind, b_behind) = (on_b - b.depth, on_a - a.depth);
    match (a_ends, b_ends) {
        (true, true) => ((on_b - on_a).abs(), on_b < on_a),
        (true, false) => ((-a_behind).max(0.0), true),
        (false, true) => ((-b_behind).max(0.0), false),
        (false, false) if (a_behind > 0.0) != (b_behind > 0.0) => {
            (a_behind.abs().min(b_behind.abs()), a.depth < b.depth)
        }
        (false, false) => (0.0, a.depth < b.depth),
    }
}

/// The sphere that touches a surface at its place, on a neighbour's line of sight: its depth there, or where it turns away, and whether
/// it does.
fn continued(g: &Place, own: &Sight, other: &Sight) -> (f64, bool) {
    let (own, other) = (own.line_at(g.depth), other.line_at(g.depth));
    let e = other.at(g.depth) - own.at(g.depth);
    let d = other.direction;
    let normal = if g.bend == 0.0 { g.facet } else { g.normal };
    let a = g.bend * d.length_squared();
    let b = g.bend * e.dot(d) + normal.dot(d);
    let c = g.bend * e.length_squared() + 2.0 * normal.dot(e);
    let inside = b * b - a * c;
    let ends = inside < 0.0 || b >= 0.0;
    let turn = if a <= 0.0 { 0.0 } else { (-b).max(0.0) / a.max(1e-300) };
    let through = c / (inside.max(0.0).sqrt() - b).max(1e-300);
    (g.depth + if ends { turn } else { through }, ends)
}
