//! Which points of a crystal are taken: points less than a hundredth of an angstrom apart are one, across cell faces too.

use super::cell::Cell;
use glam::{DMat3, DVec3, IVec3};
use std::collections::HashMap;

/// Nearer points are the same, in angstrom: special positions are written to some 1e-4 of an edge.
const SAME: f64 = 0.01;
/// About the width of a box of the search, in angstrom.
const BOX: f64 = 0.1;

/// Points that are taken, by fractions of the cell's edges.
#[derive(Debug)]
pub(super) struct Places {
    cartesian_from_fractional: DMat3,
    /// Boxes along each edge.
    num_boxes: IVec3,
    /// [`SAME`] in boxes along each edge.
    reach: DVec3,
    boxes: HashMap<IVec3, Vec<u32>>,
    points: Vec<DVec3>,
}

impl Places {
    pub(super) fn new(cell: &Cell) -> Self {
        let matrix = cell.cartesian_from_fractional;
        // Rows of the inverse are as long as one over the distance of the faces.
        let inverse = matrix.inverse().transpose();
        let per_angstrom = DVec3::new(inverse.x_axis.length(), inverse.y_axis.length(), inverse.z_axis.length());
        let num_boxes = (1.0 / (per_angstrom * BOX)).floor().clamp(DVec3::ONE, DVec3::splat(1e6));
        Self {
            cartesian_from_fractional: matrix,
            num_boxes: num_boxes.as_ivec3(),
            reach: per_angstrom * SAME * num_boxes,
            boxes: HashMap::new(),
            points: Vec::new(),
        }
    }

    /// Takes a point and returns its number, or tells which one it is that was taken before.
    pub(super) fn take(&mut self, point: DVec3) -> Result<u32, u32> {
        let place = (point - point.floor()) * self.num_boxes.as_dvec3();
        let (low, high) = ((place - self.reach).floor().as_ivec3(), (place + self.reach).floor().as_ivec3());
        for x in low.x..=high.x.min(low.x + 2) {
            for y in low.y..=high.y.min(low.y + 2) {
                for z in low.z..=high.z.min(low.z + 2) {
                    let key = IVec3::new(x, y, z).rem_euclid(self.num_boxes);
                    for &index in self.boxes.get(&key).into_iter().flatten() {
                        let between = point - self.points[index as usize];
                        let between = self.cartesian_from_fractional * (between - between.round());
                        if between.length_squared() < SAME * SAME {
                            return Err(index);
                        }
                    }
                }
            }
        }
        let index = self.points.len() as u32;
        self.points.push(point);
        let key = place.floor().as_ivec3().rem_euclid(self.num_boxes);
        self.boxes.entry(key).or_default().push(index);
        Ok(index)
    }
}

#[cfg(test)]
mod tests {
    use super::super::table::Table;
    use super::super::value::Value;
    use super::*;

    fn places() -> Places {
        let mut table = Table::default();
        for (name, value) in
            [("length_a", "4"), ("length_b", "5"), ("length_c", "6"), ("angle_beta", "120"), ("angle_gamma", "75")]
        {
            table.add_item(name.as_bytes(), Value::Text(value.as_bytes()), 1);
        }
        Places::new(&Cell::new(&table).expect("a cell"))
    }

    #[test]
    fn points_across_faces_are_one() {
        let mut places = places();
        assert_eq!(places.take(DVec3::new(0.0, 0.5, 0.25)), Ok(0));
        assert_eq!(places.take(DVec3::new(0.9999, 0.5, 0.25)), Err(0));
        assert_eq!(places.take(DVec3::new(1.0, -0.5, 2.2501)), Err(0));
        assert_eq!(places.take(DVec3::new(0.0, 0.5, 0.26)), Ok(1));
        assert_eq!(places.take(DVec3::new(0.999_999_999_999_999_9, 0.5, 0.26)), Err(1));
    }

    #[test]
    fn every_near_pair_is_found() {
        let mut places = places();
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        for number in 0..2000 {
            let point = DVec3::new(random(), random(), random());
            if let Ok(index) = places.take(point) {
                let near = point + DVec3::splat(0.0005);
                assert_eq!(places.take(near), Err(index), "{number}");
            }
        }
    }
}
