//! Which triangles meet at a place and over an edge.
//!
//! A corner is a triangle's number times three plus 0, 1 or 2; the half-edge of the same number goes from it to the
//! triangle's next corner.

use super::weld::Surface;

/// The half-edge belongs to no other triangle: the surface ends here.
pub(super) const OPEN: u32 = u32::MAX;
/// The edge belongs to more than two triangles; it joins none of them.
pub(super) const SHARED: u32 = u32::MAX - 1;

/// The corner after one of the same triangle.
pub(super) const fn next(corner: u32) -> u32 {
    if corner % 3 == 2 { corner - 2 } else { corner + 1 }
}

/// The corner before one of the same triangle.
pub(super) const fn previous(corner: u32) -> u32 {
    if corner.is_multiple_of(3) { corner + 2 } else { corner - 1 }
}

/// Who meets whom. Cost: 24 bytes per triangle, 4 per place.
#[derive(Debug, Default)]
pub(super) struct Links {
    starts: Vec<u32>,
    corners: Vec<u32>,
    /// For each half-edge that of the other triangle, or [`OPEN`] or [`SHARED`].
    pub twins: Vec<[u32; 3]>,
    /// Edges of one triangle.
    pub num_open: usize,
    /// Edges of three or more.
    pub num_shared: usize,
    /// Triangles that have all places in common with another one; some more than once.
    pub duplicates: Vec<u32>,
}

impl Links {
    /// Links all triangles. Where more than two meet at an edge, those that `is_flat` says have no area do not count.
    pub fn new(surface: &Surface, is_flat: &[bool]) -> Links {
        let Surface { triangles, positions, .. } = surface;
        let (starts, corners) = sorted_corners(triangles, positions.len());
        let twins = vec![[OPEN; 3]; triangles.len()];
        let mut links = Links { starts, corners, twins, ..Links::default() };
        // Half-edges between the place and higher ones, as the other place and the half-edge.
        let mut around: Vec<u64> = Vec::new();
        for place in 0..positions.len() as u32 {
            around.clear();
            for &corner in links.corners_at(place) {
                let triangle = &triangles[corner as usize / 3];
                let (after, before) = (next(corner), previous(corner));
                for (other, half_edge) in
                    [(triangle[after as usize % 3], corner), (triangle[before as usize % 3], before)]
                {
                    if other > place {
                        around.push(u64::from(other) << 32 | u64::from(half_edge));
                    }
                }
            }
            around.sort_unstable();
            for edge in around.chunk_by(|a, b| a >> 32 == b >> 32) {
                links.join(edge, triangles, is_flat);
            }
        }
        links
    }

    /// Links the triangles at one edge.
    fn join(&mut self, edge: &[u64], triangles: &[[u32; 3]], is_flat: &[bool]) {
        let opposite = |half_edge: u32| triangles[half_edge as usize / 3][previous(half_edge) as usize % 3];
        match *edge {
            [_] => self.num_open += 1,
            [a, b] => {
                let (a, b) = (a as u32, b as u32);
                if opposite(a) == opposite(b) {
                    self.duplicates.extend([a / 3, b / 3]);
                }
                self.set_twins(a, b);
            }
            _ => {
                self.num_shared += 1;
                let mut faces: Vec<(u32, u32)> =
                    edge.iter().map(|&half| (opposite(half as u32), half as u32)).collect();
                faces.sort_unstable();
                for same in faces.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
                    self.duplicates.extend(same.iter().map(|(_, half_edge)| half_edge / 3));
                }
                for &(_, half_edge) in &faces {
                    self.twins.as_flattened_mut()[half_edge as usize] = SHARED;
                }
                faces.retain(|(_, half_edge)| is_flat.get(*half_edge as usize / 3) != Some(&true));
                if let [(_, a), (_, b)] = faces[..] {
                    self.set_twins(a, b);
                }
            }
        }
    }

    fn set_twins(&mut self, a: u32, b: u32) {
        let twins = self.twins.as_flattened_mut();
        (twins[a as usize], twins[b as usize]) = (b, a);
    }

    /// The corners at a place, in ascending order.
    pub fn corners_at(&self, place: u32) -> &[u32] {
        &self.corners[self.starts[place as usize] as usize..self.starts[place as usize + 1] as usize]
    }

    /// Places at which the surface ends, in ascending order.
    pub fn places_at_open_edges(&self, triangles: &[[u32; 3]]) -> Vec<u32> {
        let mut is_at_end = vec![false; self.starts.len() - 1];
        for (triangle, twins) in triangles.iter().zip(&self.twins) {
            for k in 0..3 {
                if twins[k] == OPEN {
                    is_at_end[triangle[k] as usize] = true;
                    is_at_end[triangle[(k + 1) % 3] as usize] = true;
                }
            }
        }
        (0_u32..).zip(is_at_end).filter_map(|(place, is_at_end)| is_at_end.then_some(place)).collect()
    }

    /// Renumbers corners for triangles whose second and third corners are to be swapped.
    pub fn turn(&mut self, is_turned: &[bool]) {
        let turned = |face: u32| is_turned[face as usize / 3];
        for corner in self.corners.iter_mut().filter(|corner| turned(**corner) && **corner % 3 != 0) {
            *corner = *corner / 3 * 3 + 3 - *corner % 3;
        }
        for (twins, &is_turned) in self.twins.iter_mut().zip(is_turned) {
            for twin in twins.iter_mut().filter(|twin| **twin < SHARED && turned(**twin)) {
                *twin = *twin / 3 * 3 + 2 - *twin % 3;
            }
            if is_turned {
                twins.swap(0, 2);
            }
        }
    }

    /// Turns `twins` into the way around each place: for a corner the one of the neighbour over the edge before it, at
    /// the same place; [`OPEN`] or [`SHARED`] where there is no neighbour or it has the other winding.
    pub fn make_rings(&mut self, triangles: &[[u32; 3]]) {
        let place_of = triangles.as_flattened();
        for (triangle, twins) in triangles.iter().zip(&mut self.twins) {
            twins.rotate_right(1);
            for (twin, &place) in twins.iter_mut().zip(triangle) {
                if *twin < SHARED && place_of[*twin as usize] != place {
                    *twin = SHARED;
                }
            }
        }
    }
}

/// Corners sorted by place, and where those of each place start.
fn sorted_corners(triangles: &[[u32; 3]], num_places: usize) -> (Vec<u32>, Vec<u32>) {
    // Counts stand two further, so that filling in moves each start to where it belongs.
    let mut starts = vec![0_u32; num_places + 2];
    for &place in triangles.as_flattened() {
        starts[place as usize + 2] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut corners = vec![0; triangles.len() * 3];
    for (corner, &place) in (0_u32..).zip(triangles.as_flattened()) {
        let at = &mut starts[place as usize + 1];
        corners[*at as usize] = corner;
        *at += 1;
    }
    starts.pop();
    (starts, corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn surface(num_places: usize, triangles: &[[u32; 3]]) -> Surface {
        Surface { positions: vec![DVec3::ZERO; num_places], triangles: triangles.to_vec(), ..Surface::default() }
    }

    #[test]
    fn half_edges_find_each_other() {
        let surface = surface(5, &[[0, 1, 2], [2, 1, 3]]);
        let links = Links::new(&surface, &[]);
        assert_eq!(links.twins, [[OPEN, 3, OPEN], [1, OPEN, OPEN]]);
        assert_eq!((links.num_open, links.num_shared), (4, 0));
        assert_eq!((links.corners_at(2), links.corners_at(1)), (&[2, 3][..], &[1, 4][..]));
        assert!(links.corners_at(4).is_empty());
    }

    #[test]
    fn three_at_an_edge_are_parted_unless_one_is_flat() {
        let surface = surface(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
        let links = Links::new(&surface, &[false; 3]);
        assert_eq!([links.twins[0][0], links.twins[1][0], links.twins[2][0]], [SHARED; 3]);
        assert_eq!((links.num_open, links.num_shared), (6, 1));
        let links = Links::new(&surface, &[false, false, true]);
        assert_eq!([links.twins[0][0], links.twins[1][0], links.twins[2][0]], [3, 0, SHARED]);
    }

    #[test]
    fn copies_are_found() {
        assert_eq!(Links::new(&surface(3, &[[0, 1, 2], [2, 1, 0]]), &[]).duplicates[..2], [0, 1]);
        assert!(Links::new(&surface(4, &[[0, 1, 2], [2, 1, 3]]), &[]).duplicates.is_empty());
    }

    #[test]
    fn turning_renumbers_as_if_it_had_been_so_in_the_file() {
        let mut links = Links::new(&surface(4, &[[0, 1, 2], [1, 2, 3], [0, 3, 1]]), &[]);
        links.turn(&[false, true, false]);
        let expected = Links::new(&surface(4, &[[0, 1, 2], [1, 3, 2], [0, 3, 1]]), &[]);
        assert_eq!((links.twins, links.corners), (expected.twins, expected.corners));
    }

    #[test]
    fn rings_lead_around_a_place() {
        let surface = surface(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]]);
        let mut links = Links::new(&surface, &[]);
        assert_eq!(links.num_open, 0);
        links.make_rings(&surface.triangles);
        assert_eq!([links.twins[0][0], links.twins[1][0], links.twins[2][0]], [3, 6, 0]);
    }
}
