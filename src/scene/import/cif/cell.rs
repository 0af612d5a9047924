//! The unit cell of a crystal.

use super::table::Table;
use glam::{DMat3, DVec3};

/// The longest edge, in angstrom. Ours: the largest known cells have some 2000.
const LONGEST_EDGE: f64 = 1e5;
/// The flattest cell: its volume over that of the box with the same edges. Real ones have more than 0.1.
const FLATTEST: f64 = 1e-3;

/// A unit cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    /// From fractions of the edges to angstrom: `a` lies along x, `b` in the plane of x and y
    /// [PdbFormat, SCALE, whose matrix is its inverse].
    pub(super) cartesian_from_fractional: DMat3,
}

impl Cell {
    /// The cell of a table `_cell`; angles that are missing are right ones, as the dictionary says.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn new(table: &Table<'_>) -> Result<Self, String> {
        let mut edges = [0.0; 3];
        for (edge, name) in edges.iter_mut().zip(["length_a", "length_b", "length_c"]) {
            let value = table.first(name);
            let length = value.float().filter(|length| (0.01..=LONGEST_EDGE).contains(length));
            *edge = length.ok_or_else(|| format!("_cell_{name} is {}, no length in angstrom", value.quoted()))?;
        }
        let mut cosines = [0.0; 3];
        for (cosine, name) in cosines.iter_mut().zip(["angle_alpha", "angle_beta", "angle_gamma"]) {
            let value = table.first(name);
            let angle = value.float().or_else(|| (value.text().is_empty()).then_some(90.0));
            let angle = angle.filter(|&angle| angle > 0.0 && angle < 180.0);
            let angle = angle.ok_or_else(|| format!("_cell_{name} is {}, no angle in degrees", value.quoted()))?;
            *cosine = if angle == 90.0 { 0.0 } else { angle.to_radians().cos() };
        }
        Self::from_edges(edges, cosines).ok_or_else(|| "the angles of _cell enclose no volume".to_string())
    }

    /// The cell of edges, in angstrom, and of the cosines of the angles opposite to them.
    fn from_edges([a, b, c]: [f64; 3], [alpha, beta, gamma]: [f64; 3]) -> Option<Self> {
        let volume_squared = 1.0 - alpha * alpha - beta * beta - gamma * gamma + 2.0 * alpha * beta * gamma;
        if volume_squared < FLATTEST * FLATTEST {
            return None;
        }
        let sine = (1.0 - gamma * gamma).sqrt();
        let cartesian_from_fractional = DMat3::from_cols(
            DVec3::new(a, 0.0, 0.0),
            DVec3::new(b * gamma, b * sine, 0.0),
            DVec3::new(c * beta, c * (alpha - beta * gamma) / sine, c * volume_squared.sqrt() / sine),
        );
        Some(Self { cartesian_from_fractional })
    }
}

#[cfg(test)]
mod tests {
    use super::super::value::Value;
    use super::*;

    fn cell(values: [&'static str; 6]) -> Result<Cell, String> {
        const NAMES: [&str; 6] = ["length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma"];
        let mut table = Table::default();
        for (name, value) in NAMES.iter().zip(values) {
            let value = if value == "?" { Value::Missing } else { Value::Text(value.as_bytes()) };
            table.add_item(name.as_bytes(), value, 1);
        }
        Cell::new(&table)
    }

    #[test]
    fn edges_and_angles_come_back() {
        let matrix = cell(["10(1)", "11", "12", "80", "95.5", "110"]).expect("a cell").cartesian_from_fractional;
        let [a, b, c] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
        for (edge, length) in [(a, 10.0), (b, 11.0), (c, 12.0)] {
            assert!((edge.length() - length).abs() < 1e-12);
        }
        for (one, other, angle) in [(b, c, 80.0), (a, c, 95.5), (a, b, 110.0_f64)] {
            assert!((one.angle_between(other).to_degrees() - angle).abs() < 1e-10);
        }
        assert!(matrix.determinant() > 0.0);
    }

    #[test]
    fn right_angles_are_exact_and_need_not_be_given() {
        let matrix = cell(["2", "3", "4", "?", "90", "90.0"]).expect("a cell").cartesian_from_fractional;
        assert_eq!(matrix, DMat3::from_diagonal(DVec3::new(2.0, 3.0, 4.0)));
    }

    #[test]
    fn nonsense_is_named() {
        assert_eq!(
            cell(["0", "1", "1", "90", "90", "90"]).expect_err("no"),
            "_cell_length_a is \"0\", no length in angstrom"
        );
        assert!(cell(["1", "1", "1", "90", "180", "90"]).expect_err("no").starts_with("_cell_angle_beta is \"180\""));
        assert!(cell(["1", "1", "1", "10", "20", "90"]).expect_err("no").contains("no volume"));
        assert!(cell(["1", "?", "1", "90", "90", "90"]).expect_err("no").contains("_cell_length_b"));
    }
}
