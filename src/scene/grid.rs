//! Pairs of points that are near each other, in linear time.
//!
//! Points are sorted by the cell of a uniform grid that they lie in; empty cells cost nothing, so that two molecules a
//! kilometre apart are fine. Half of the neighbour cells are searched, as five runs of the sorted list whose starts only
//! move forwards. A run is cut where it is longer than any matter fills it, so that coincident points stay linear, too.

use glam::Vec3;

/// Points that one cell may hold before its runs are cut. A cell of bonds is at most 4 angstrom wide, and diamond, the
/// densest matter, fills it with 11 atoms; overlaid conformers of one molecule may come to more.
const CELL_LIMIT: usize = 32;
/// Bits of a cell's index along each axis.
const BITS: u32 = 21;
/// Cell indices stay one off both ends, so that neighbours never run over into the next row.
const LAST: u32 = (1 << BITS) - 2;

/// Points sorted by grid cell.
pub(super) struct Grid {
    /// Cell and point, sorted.
    keys: Vec<(u64, u32)>,
    /// Position of each sorted point.
    positions: Vec<Vec3>,
}

impl Grid {
    /// Sorts points into cells of the given width. Positions must be finite, widths positive.
    pub(super) fn new(points: impl Iterator<Item = (u32, Vec3)> + Clone, cell: f32) -> Self {
        let low = points.clone().fold(Vec3::splat(f32::INFINITY), |low, (_, point)| low.min(point));
        // A float too large for u32 becomes the largest u32: far away, cells merge, and the limit takes over.
        let index = |value: f32| u64::from(((value / cell) as u32).saturating_add(1).min(LAST));
        let key = |point: Vec3| {
            let offset = point - low;
            index(offset.z) << (2 * BITS) | index(offset.y) << BITS | index(offset.x)
        };
        let mut sorted: Vec<(u64, u32, Vec3)> = points.map(|(id, point)| (key(point), id, point)).collect();
        sorted.sort_unstable_by_key(|&(key, id, _)| (key, id));
        let positions = sorted.iter().map(|&(_, _, position)| position).collect();
        Self { keys: sorted.into_iter().map(|(key, id, _)| (key, id)).collect(), positions }
    }

    /// Calls `visit` with both points and their squared distance, once for each pair nearer than a cell's width and for
    /// some that are farther. Calls `cut` for points whose neighbours were too many to look at all.
    pub(super) fn pairs(&self, mut visit: impl FnMut(u32, u32, f32), mut cut: impl FnMut(u32)) {
        // Rows after the point's own: (y + 1, z), (y - 1, z + 1), (y, z + 1), (y + 1, z + 1).
        let row_offsets: [u64; 4] =
            [1 << BITS, (1 << (2 * BITS)) - (1 << BITS), 1 << (2 * BITS), (1 << (2 * BITS)) + (1 << BITS)];
        let mut row_starts = [0; 4];
        for (i, (&(key, id), &position)) in self.keys.iter().zip(&self.positions).enumerate() {
            let mut scan = |start: usize, last_key: u64, limit: usize| {
                let end = self.keys.len().min(start.saturating_add(limit));
                for j in start..end {
                    let (other_key, other_id) = self.keys[j];
                    if other_key > last_key {
                        return;
                    }
                    visit(id, other_id, position.distance_squared(self.positions[j]));
                }
                if self.keys.get(end).is_some_and(|&(other_key, _)| other_key <= last_key) {
                    cut(id);
                }
            };
            scan(i + 1, key + 1, 2 * CELL_LIMIT);
            for (start, offset) in row_starts.iter_mut().zip(row_offsets) {
                while self.keys.get(*start).is_some_and(|&(other_key, _)| other_key < key + offset - 1) {
                    *start += 1;
                }
                scan(*start, key + offset + 1, 3 * CELL_LIMIT);
            }
        }
    }
}

/// Which points are near enough to one of some to be looked at; some others are, too.
pub(super) struct Near {
    low: Vec3,
    cell: f32,
    /// Hashed cells, half as wide as the reach, that may hold such points; a power of two of words, or none to let all pass.
    bits: Vec<u64>,
}

impl Near {
    /// Marks what is nearer than `reach` to one of `centers`, which must be among `points`.
    pub(super) fn new(
        points: impl Iterator<Item = Vec3>,
        centers: impl Iterator<Item = Vec3> + Clone,
        reach: f32,
    ) -> Self {
        let (low, num_points) =
            points.fold((Vec3::splat(f32::INFINITY), 0_usize), |(low, count), point| (low.min(point), count + 1));
        let num_centers = centers.clone().count();
        let mut near = Self { low, cell: 0.5 * reach, bits: Vec::new() };
        // Where most points pass anyway, asking costs more than it saves.
        if num_centers * 8 < num_points {
            // Some 80 cells each, many of them shared: at most a third of the bits is set.
            near.bits = vec![0; (4 * num_centers).next_power_of_two().clamp(1 << 10, 1 << 18)];
            for center in centers {
                near.mark(center, reach);
            }
        }
        near
    }

    /// Marks the cells that come nearer than `reach`, which is two cells, to a point.
    fn mark(&mut self, center: Vec3, reach: f32) {
        let [x, y, z] = self.cell_of(center);
        // Where in its cell the point is. Far away that is not known, and all cells around are marked.
        let place = (center - self.low) / self.cell - Vec3::new(x as f32, y as f32, z as f32);
        let is_exact = place.min_element() >= 0.0 && place.max_element() <= 1.0;
        let limit = (reach / self.cell + 0.01).powi(2);
        for step in (0..125).map(|i| [i % 5, i / 5 % 5, i / 25]) {
            let gap = |axis: usize| match step[axis] as f32 - 2.0 {
                below if below < 0.0 => place[axis] - (below + 1.0),
                above if above > 0.0 => above - place[axis],
                _ => 0.0,
            };
            let gap = Vec3::new(gap(0), gap(1), gap(2));
            if !is_exact || gap.length_squared() <= limit {
                let (word, bit) = self.bit_of([x + step[0], y + step[1], z + step[2]]);
                self.bits[word] |= bit;
            }
        }
    }

    /// The cell of a point.
    fn cell_of(&self, point: Vec3) -> [u64; 3] {
        // Far away, cells merge as those of the grid do.
        let offset = point - self.low;
        [offset.x, offset.y, offset.z].map(|value| u64::from(((value / self.cell) as u32).min(LAST - 2)))
    }

    /// Where the bit of a cell is; cells here are two more than those of [`Near::cell_of`], which leaves room below.
    fn bit_of(&self, [x, y, z]: [u64; 3]) -> (usize, u64) {
        let key = z << (2 * BITS) | y << BITS | x;
        // The upper bits of a product are the mixed ones.
        let hash = key.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
        (hash as usize >> 6 & (self.bits.len() - 1), 1 << (hash & 63))
    }

    /// Whether a point may be nearer than the reach to one of the centres.
    pub(super) fn contains(&self, point: Vec3) -> bool {
        if self.bits.is_empty() {
            return true;
        }
        let [x, y, z] = self.cell_of(point);
        let (word, bit) = self.bit_of([x + 2, y + 2, z + 2]);
        self.bits[word] & bit != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_finds_the_pairs_of_brute_force() {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f32 / (1 << 24) as f32 * 12.0 - 6.0
        };
        let points: Vec<Vec3> = (0..400).map(|_| Vec3::new(next(), next(), next())).collect();
        let near = |a: Vec3, b: Vec3| a.distance_squared(b) <= 1.5 * 1.5;
        let mut expected = Vec::new();
        for a in 0..points.len() {
            for b in a + 1..points.len() {
                if near(points[a], points[b]) {
                    expected.push((a as u32, b as u32));
                }
            }
        }
        let mut found = Vec::new();
        let grid = Grid::new(points.iter().enumerate().map(|(id, &point)| (id as u32, point)), 1.5);
        grid.pairs(
            |a, b, squared| {
                if squared <= 1.5 * 1.5 {
                    found.push((a.min(b), a.max(b)));
                }
            },
            |_| panic!("nothing is crowded"),
        );
        found.sort_unstable();
        assert_eq!(found, expected);
    }

    #[test]
    fn points_near_a_centre_pass_and_most_others_do_not() {
        let points: Vec<Vec3> =
            (0..8000).map(|i| Vec3::new((i % 20) as f32, (i / 20 % 20) as f32, (i / 400) as f32) * 1.3).collect();
        let centers = [points[0], points[4210], points[7999]];
        let near = Near::new(points.iter().copied(), centers.iter().copied(), 1.5);
        let is_near = |point: &&Vec3| centers.iter().any(|center| center.distance(**point) <= 1.5);
        assert!(points.iter().filter(is_near).all(|&point| near.contains(point)));
        assert!(points.iter().filter(|&&point| near.contains(point)).count() < 400);
        let all = Near::new(points.iter().copied(), points.iter().copied(), 1.5);
        assert!(points.iter().all(|&point| all.contains(point)));
    }

    #[test]
    fn coincident_points_are_cut_not_squared() {
        let grid = Grid::new((0..10_000).map(|id| (id, Vec3::ONE)), 2.0);
        let (mut visited, mut cut) = (0_usize, 0);
        grid.pairs(|_, _, _| visited += 1, |_| cut += 1);
        assert!(visited <= 10_000 * 2 * CELL_LIMIT && cut > 9_000, "{visited} {cut}");
    }

    #[test]
    fn points_at_the_ends_of_space_do_not_overflow() {
        let ends = [Vec3::splat(-3e38), Vec3::splat(3e38), Vec3::ZERO];
        let grid = Grid::new(ends.iter().enumerate().map(|(id, &point)| (id as u32, point)), 0.5);
        grid.pairs(|_, _, _| {}, |_| {});
    }
}
