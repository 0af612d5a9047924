//! Scenes of boxes, for experiments that need nothing else.

use std::fmt::Write as _;

use super::experiment::MeasureError;
use super::stage::scene;
use crate::scene::Scene;

/// A box: the part that it is, its lowest corner and its highest.
pub type Cuboid = (&'static str, [f64; 3], [f64; 3]);

/// A scene of boxes.
pub fn boxes(name: &str, all: &[Cuboid]) -> Result<Scene, MeasureError> {
    let mut text = String::new();
    for (index, (part, low, high)) in all.iter().enumerate() {
        let _ = writeln!(text, "o {part}");
        add(&mut text, 8 * index + 1, *low, *high);
    }
    scene(&format!("{name}.obj"), text.as_bytes())
}

/// A box as OBJ; `first` is the number of its first corner.
fn add(text: &mut String, first: usize, low: [f64; 3], high: [f64; 3]) {
    for corner in 0..8 {
        let at = |axis: usize| if corner >> axis & 1 == 1 { high[axis] } else { low[axis] };
        let _ = writeln!(text, "v {} {} {}", at(0), at(1), at(2));
    }
    for [a, b, c, d] in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
        let [a, b, c, d] = [a, b, c, d].map(|corner| corner + first);
        let _ = writeln!(text, "f {a} {b} {c} {d}");
    }
}
