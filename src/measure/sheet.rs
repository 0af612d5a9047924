//! Surfaces of two parameters as meshes.

use std::fmt::Write as _;

use glam::DVec3;

/// A surface as OBJ with its exact normals; `at` gives place and normal for two shares.
pub fn sheet([columns, rows]: [usize; 2], at: impl Fn(f64, f64) -> (DVec3, DVec3)) -> String {
    let mut text = String::new();
    for row in 0..=rows {
        for column in 0..=columns {
            let (p, n) = at(column as f64 / columns as f64, row as f64 / rows as f64);
            let _ = writeln!(text, "v {} {} {}\nvn {} {} {}", p.x, p.y, p.z, n.x, n.y, n.z);
        }
    }
    let index = |column: usize, row: usize| row * (columns + 1) + column + 1;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| index(column + x, row + y));
            let _ = writeln!(text, "f {a}//{a} {b}//{b} {c}//{c} {d}//{d}");
        }
    }
    text
}
