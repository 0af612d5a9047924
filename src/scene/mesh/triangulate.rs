//! Polygons to triangles: a fan where one fits, else by cutting ears off.
//!
//! Polygons lie in space and are seldom quite flat: they are cut as their projection along the area-weighted normal is.
//! All corners become corners of triangles, so that neighbours share edges. Holes that are joined to the outline by a
//! double edge are holes.

use glam::{DVec2, DVec3};

/// Cuts polygons one after the other, in the same memory.
#[derive(Default)]
pub struct Triangulator {
    /// Corners in their plane, the widest extent of the polygon being 1.
    points: Vec<DVec2>,
    /// Neighbours in what is left of the polygon.
    previous: Vec<u32>,
    next: Vec<u32>,
    /// Corners that are not convex, and those that are cut off. Only the former can lie in an ear.
    is_reflex: Vec<bool>,
    is_cut: Vec<bool>,
    grid: Grid,
    /// Corners that were compared with ears.
    work: usize,
    /// Comparisons of polygons that were given up.
    wasted: usize,
}

/// Areas below this, in squares of the extent, are none.
const NO_AREA: f64 = 1e-15;

/// Comparisons per corner after which a polygon is given up; spirals of 5000 corners need a quarter.
const WORK_PER_CORNER: usize = 4000;
/// The same once polygons that were given up have taken [`MOST_WASTED`] comparisons in one file: about half a second.
const LEAST_WORK_PER_CORNER: usize = 40;
const MOST_WASTED: usize = 100_000_000;

/// How much is demanded of an ear; each is tried when no corner meets the one before.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Demand {
    /// Nothing in it or on it but at its first corner.
    Empty,
    /// Nothing in it or on it but at its corners: where holes touch.
    EmptyInside,
    /// No area: corners on a straight line.
    Flat,
    /// Convex, whatever is in it: the outline crosses itself.
    Convex,
    /// Nothing.
    Any,
}

impl Triangulator {
    /// Appends the triangles of a polygon, as numbers of its corners in its order: always two fewer than corners.
    ///
    /// Answers whether they cover it: outlines that cross themselves or have no area are cut as well as they can be.
    pub fn cut(&mut self, corners: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> bool {
        let count = corners.len() as u32;
        if count <= 3 {
            triangles.extend((count == 3).then_some([0, 1, 2]));
            return true;
        }
        let fan = |first: u32| (1..count - 1).map(move |i| [0, i, i + 1].map(|corner| (corner + first) % count));
        if !self.project(corners) {
            triangles.extend(fan(0));
            return false;
        }
        // The other fan of a quad is its other diagonal.
        for first in 0..if count == 4 { 2 } else { 1 } {
            if fan(first).all(|[a, b, c]| self.area(a, b, c) > NO_AREA) {
                triangles.extend(fan(first));
                return true;
            }
        }
        let start = triangles.len();
        self.cut_ears(triangles);
        let covered: f64 = triangles[start..].iter().map(|&[a, b, c]| self.area(a, b, c).abs()).sum();
        let area: f64 = fan(0).map(|[a, b, c]| self.area(a, b, c)).sum();
        covered <= area * (1.0 + 1e-6)
    }

    /// Lays the corners into their plane, counter-clockwise; answers whether they span any area.
    fn project(&mut self, corners: &[DVec3]) -> bool {
        let origin = corners[0];
        let extent = corners.iter().map(|&corner| (corner - origin).abs().max_element()).fold(0.0, f64::max);
        if extent == 0.0 {
            return false;
        }
        let place = |corner: DVec3| (corner - origin) / extent;
        let pairs = corners.iter().zip(corners.iter().skip(1));
        let normal: DVec3 = pairs.map(|(&a, &b)| place(a).cross(place(b))).sum();
        let Some(normal) = normal.try_normalize() else {
            return false;
        };
        let (right, up) = normal.any_orthonormal_pair();
        self.points.clear();
        self.points.extend(corners.iter().map(|&corner| DVec2::new(place(corner).dot(right), place(corner).dot(up))));
        true
    }

    /// Twice the area of a triangle, positive if counter-clockwise.
    fn area(&self, a: u32, b: u32, c: u32) -> f64 {
        let [a, b, c] = [a, b, c].map(|corner| self.points[corner as usize]);
        (b - a).perp_dot(c - a)
    }

    fn cut_ears(&mut self, triangles: &mut Vec<[u32; 3]>) {
        let count = self.points.len() as u32;
        self.previous.clear();
        self.previous.extend((0..count).map(|i| (i + count - 1) % count));
        self.next.clear();
        self.next.extend((0..count).map(|i| (i + 1) % count));
        self.is_cut.clear();
        self.is_cut.resize(count as usize, false);
        self.is_reflex.clear();
        for i in 0..count {
            let is_reflex = self.corner_area(i) <= NO_AREA;
            self.is_reflex.push(is_reflex);
        }
        self.grid.fill(&self.points, &self.is_reflex);
        self.work = 0;
        let per_corner = if self.wasted > MOST_WASTED { LEAST_WORK_PER_CORNER } else { WORK_PER_CORNER };
        let limit = per_corner * count as usize;
        let (mut left, mut corner, mut demand, mut failures) = (count, 0, Demand::Empty, 0);
        while left > 3 {
            if self.work > limit {
                demand = Demand::Any;
            }
            if self.is_ear(corner, demand) {
                let (a, c) = (self.previous[corner as usize], self.next[corner as usize]);
                triangles.push([a, corner, c]);
                self.is_cut[corner as usize] = true;
                (self.next[a as usize], self.previous[c as usize]) = (c, a);
                for neighbour in [a, c] {
                    self.is_reflex[neighbour as usize] = self.corner_area(neighbour) <= NO_AREA;
                }
                // Passing the next corner over makes fewer slivers.
                corner = self.next[c as usize];
                (left, failures, demand) = (left - 1, 0, Demand::Empty);
            } else {
                (corner, failures) = (self.next[corner as usize], failures + 1);
                if failures == left {
                    failures = 0;
                    demand = match demand {
                        Demand::Empty => Demand::EmptyInside,
                        Demand::EmptyInside => Demand::Flat,
                        Demand::Flat => Demand::Convex,
                        Demand::Convex | Demand::Any => Demand::Any,
                    };
                }
            }
        }
        triangles.push([self.previous[corner as usize], corner, self.next[corner as usize]]);
        // Also what needs all kinds of ears crosses itself.
        if demand == Demand::Any || self.work > limit {
            self.wasted = self.wasted.saturating_add(self.work);
        }
    }

    fn corner_area(&self, corner: u32) -> f64 {
        self.area(self.previous[corner as usize], corner, self.next[corner as usize])
    }

    fn is_ear(&mut self, corner: u32, demand: Demand) -> bool {
        self.work += 1;
        let area = self.corner_area(corner);
        match demand {
            Demand::Any => true,
            Demand::Flat => area.abs() <= NO_AREA,
            Demand::Convex => area > NO_AREA,
            _ => area > NO_AREA && self.is_empty(corner, demand == Demand::EmptyInside),
        }
    }

    /// Whether no reflex corner lies in the triangle at a corner.
    fn is_empty(&mut self, corner: u32, may_touch: bool) -> bool {
        let ear = [self.previous[corner as usize], corner, self.next[corner as usize]];
        let [a, b, c] = ear.map(|corner| self.points[corner as usize]);
        let ((left, bottom), (right, top)) = (self.grid.cell(a.min(b).min(c)), self.grid.cell(a.max(b).max(c)));
        for row in bottom..=top {
            for &other in self.grid.row(row, left, right) {
                self.work += 1;
                let p = self.points[other as usize];
                let is_apart = self.is_cut[other as usize] || !self.is_reflex[other as usize] || ear.contains(&other);
                if is_apart || p == a || may_touch && (p == b || p == c) {
                    continue;
                }
                let side = |from: DVec2, to: DVec2| (to - from).perp_dot(p - from) >= 0.0;
                if side(a, b) && side(b, c) && side(c, a) {
                    return false;
                }
            }
        }
        true
    }
}

/// Corners by square cells, about one for each.
#[derive(Default)]
struct Grid {
    low: DVec2,
    /// Cells per unit of length.
    scale: DVec2,
    /// Cells in a row, and rows.
    side: usize,
    /// Where each cell begins in `corners`, and the end of the last.
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Grid {
    /// Sorts the corners that are marked.
    fn fill(&mut self, points: &[DVec2], is_marked: &[bool]) {
        let marked = || (0..points.len()).filter(|&i| is_marked[i]);
        let count = marked().count();
        self.side = (count as f64).sqrt().ceil().clamp(1.0, 1024.0) as usize;
        self.low = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        self.scale = (self.side as f64 / (high - self.low)).min(DVec2::splat(1e30));
        let cell_of = |grid: &Self, i: usize| {
            let (x, y) = grid.cell(points[i]);
            y * grid.side + x
        };
        self.starts.clear();
        self.starts.resize(self.side * self.side + 1, 0);
        for i in marked() {
            let cell = cell_of(self, i);
            self.starts[cell] += 1;
        }
        let mut sum = 0;
        for start in &mut self.starts {
            sum += *start;
            *start = sum;
        }
        self.corners.clear();
        self.corners.resize(count, 0);
        for i in marked() {
            let cell = cell_of(self, i);
            self.starts[cell] -= 1;
            let start = self.starts[cell];
            self.corners[start as usize] = i as u32;
        }
    }

    /// Column and row.
    fn cell(&self, point: DVec2) -> (usize, usize) {
        let cell = (point - self.low) * self.scale;
        // Casts keep within 0 and the largest number whatever comes.
        ((cell.x as usize).min(self.side - 1), (cell.y as usize).min(self.side - 1))
    }

    /// The corners in the cells of a row from one column to another.
    fn row(&self, row: usize, left: usize, right: usize) -> &[u32] {
        let cell = |column: usize| self.starts[row * self.side + column] as usize;
        &self.corners[cell(left)..cell(right + 1)]
    }
}

#[cfg(test)]
mod tests;
