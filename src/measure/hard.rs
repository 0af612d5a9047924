//! Scenes that are hard for methods of transparency, each made from a formula: what experiment, tests and plate draw alike.

use std::fmt::Write as _;

use super::experiment::MeasureError;
use super::stage::scene;
use crate::scene::Scene;

/// A scene with how it is looked at. Parts `a...` and oxygen are red, the part `wall` is opaque and green, all else is blue.
pub struct Hard {
    /// What is hard about it.
    pub name: &'static str,
    /// The file that it would be.
    pub file: &'static str,
    /// What the file says. Its parts follow each other, and all of their faces have four corners.
    pub text: fn() -> String,
    /// Entries of the style's `camera`.
    camera: &'static str,
    /// Opacity of all that is not opaque.
    pub opacity: f64,
    /// Fragments that the k-buffer keeps for each pixel.
    pub k: usize,
    /// Whether opacity is by curvature, which the k-buffer finds from neighbours.
    pub is_curved: bool,
    /// Whether nothing of it is drawn.
    is_hidden: bool,
}

/// Straight ahead, without perspective.
const AHEAD: &str = r#""orthographic": true, "zoom": 1.3"#;

/// So faint that light comes through forty layers. As all opacities here a number of steps of 1/255, which is how the k-buffer holds them.
const FAINT: f64 = 17.0 / 255.0;

/// What most scenes share.
const PLAIN: Hard = Hard {
    name: "",
    file: "hard.obj",
    text: String::new,
    camera: AHEAD,
    opacity: 0.2,
    k: 16,
    is_curved: false,
    is_hidden: false,
};

/// All of them.
pub const SCENES: [Hard; 12] = [
    Hard { name: "more layers than k", text: more_than_k, opacity: FAINT, ..PLAIN },
    Hard { name: "one object", text: one_object, opacity: FAINT, k: 32, ..PLAIN },
    Hard {
        name: "many tiny objects",
        file: "hard.xyz",
        text: tiny_objects,
        camera: r#""orthographic": true, "zoom": 1.2"#,
        opacity: 0.4,
        k: 32,
        ..PLAIN
    },
    Hard {
        name: "70,000 objects",
        file: "hard.xyz",
        text: beyond_16_bits,
        camera: r#""orthographic": true, "zoom": 1.2"#,
        opacity: FAINT,
        k: 32,
        ..PLAIN
    },
    Hard { name: "shells 1e-4 apart", text: thin_shells, camera: r#""orthographic": true, "zoom": 8.5"#, ..PLAIN },
    Hard {
        name: "solids through each other",
        text: crossing_solids,
        camera: r#""position": [1, 0.7, 2], "zoom": 0.85"#,
        opacity: 0.4,
        ..PLAIN
    },
    Hard { name: "faces both ways", text: mirrored_faces, ..PLAIN },
    Hard { name: "an opaque wall in front", text: behind_a_wall, ..PLAIN },
    Hard {
        name: "at the border",
        file: "hard.xyz",
        text: at_the_border,
        camera: r#""zoom": 1.8"#,
        opacity: 0.4,
        k: 8,
        ..PLAIN
    },
    Hard { name: "nothing to see", is_hidden: true, text: one_object, ..PLAIN },
    Hard { name: "k = 1", text: || squares(8, 4), opacity: 0.4, k: 1, ..PLAIN },
    Hard { name: "the wrong neighbour", text: wrong_neighbour, opacity: 0.2, k: 4, is_curved: true, ..PLAIN },
];

impl Hard {
    /// The scene.
    ///
    /// # Errors
    /// [`MeasureError::Content`] where its text is not what its file may say.
    pub fn scene(&self) -> Result<Scene, MeasureError> {
        scene(self.file, (self.text)().as_bytes())
    }

    /// A style that draws it by a method, with this opacity.
    pub fn style(&self, method: &str, opacity: f64) -> String {
        let glass = |name: &str, color: &str| {
            let shader = if self.is_curved {
                format!(
                    r#""curvature", "properties": {{ "shading": "unlit", "color_transfer": "none", "contour_width": "1.5pt",
                       "opacity_transfer": [[0, {opacity}, {opacity}], [1, 1, 1]]"#
                )
            } else {
                format!(r#""unlit", "properties": {{ "opacity": {opacity}"#)
            };
            format!(r#"{{ "name": "{name}", "shader": {shader}, "base_color": "{color}" }} }}"#)
        };
        let mapping = match self.is_hidden {
            true => r#""*": null"#,
            false => r#""*": "blue", "mesh[part=a*]": "red", "mesh[part=wall]": "solid", "atom[element=O]": "red""#,
        };
        format!(
            r##"{{ "camera": {{ "bgcolor": "#f0e0a0", {} }}, "geometry": {{ "atom": "vdw", "scale": 1 }},
                "mapping": {{ {mapping} }},
                "shaders": [{}, {}, {{ "name": "solid", "shader": "unlit", "properties": {{ "base_color": "#208040" }} }}],
                "transparency": {{ "method": "{method}", "k": {} }} }}"##,
            self.camera,
            glass("blue", "#2060d0"),
            glass("red", "#d04020"),
            self.k
        )
    }
}

/// Faces of four corners as OBJ, part by part.
#[derive(Default)]
struct Faces {
    text: String,
    num_corners: usize,
}

impl Faces {
    fn part(&mut self, name: &str) {
        let _ = writeln!(self.text, "o {name}");
    }

    fn face(&mut self, corners: [[f64; 3]; 4]) {
        for [x, y, z] in corners {
            let _ = writeln!(self.text, "v {x} {y} {z}");
        }
        let first = self.num_corners + 1;
        let _ = writeln!(self.text, "f {first} {} {} {}", first + 1, first + 2, first + 3);
        self.num_corners += 4;
    }

    /// A square upright to the view, from `left` to the picture's right border.
    fn square(&mut self, left: f64, z: f64) {
        self.face([[left, -0.93, z], [1.0, -0.93, z], [1.0, 1.1, z], [left, 1.1, z]]);
    }
}

/// Where a square begins, so that each column of the picture has another number of layers. No edge lies on the centres of pixels.
fn left(index: usize, count: usize) -> f64 {
    -1.0 + 1.963 * index as f64 / count as f64
}

/// Squares that begin one after the other at depths in no order, those of each object together.
fn squares(count: usize, num_objects: usize) -> String {
    let mut faces = Faces::default();
    for object in 0..num_objects {
        faces.part(&format!("{}{object}", if object % 2 == 0 { 'a' } else { 'b' }));
        for index in (object..count).step_by(num_objects) {
            faces.square(left(index, count), -(((index * 89 + 31) % count) as f64) / count as f64);
        }
    }
    faces.text
}

/// Forty layers where sixteen are kept.
fn more_than_k() -> String {
    squares(40, 4)
}

/// All fragments of a pixel are of one object, and buckets part nothing.
fn one_object() -> String {
    squares(24, 1)
}

/// Two thousand balls of two or three pixels, strewn by the golden ratio.
fn tiny_objects() -> String {
    const COUNT: usize = 2000;
    let share = |index: usize, step: f64| (index as f64 * step).fract() - 0.5;
    let mut text = format!("{COUNT}\n\n");
    for index in 0..COUNT {
        let element = if index % 2 == 0 { "O" } else { "C" };
        let [x, y] = [0.754_877_666, 0.569_840_290].map(|step| 120.0 * share(index, step));
        let _ = writeln!(text, "{element} {x} {y} {}", 40.0 * share(index, 0.618_033_989));
    }
    text
}

/// Columns of balls, seventeen and more in each: of two that are 65,536 numbers apart the later one lies just behind the earlier one.
fn beyond_16_bits() -> String {
    const COUNT: usize = 70_000;
    const SIDE: usize = 64;
    let mut text = format!("{COUNT}\n\n");
    for index in 0..COUNT {
        let (column, layer) = (index % (SIDE * SIDE), index / (SIDE * SIDE));
        let [x, y] = [column % SIDE, column / SIDE].map(|place| 3.6 * (place as f64 - 0.5 * SIDE as f64));
        let z = -3.6 * (layer % 16) as f64 - 1e-3 * (layer / 16) as f64;
        let _ = writeln!(text, "{} {x} {y} {z}", if layer % 2 == 0 { "O" } else { "C" });
    }
    text
}

/// Twelve squares with a pebble far before and far behind them, which spread the steps of depth.
fn thin_shells() -> String {
    let mut faces = Faces::default();
    for (object, name) in ["a", "b"].iter().enumerate() {
        faces.part(name);
        for index in (object..12).step_by(2) {
            faces.square(left(index, 12), -1e-4 * ((index * 5 + 3) % 12) as f64);
        }
    }
    faces.part("wall");
    for z in [-10.0, 10.0] {
        faces.face([[0.0, 0.0, z], [0.001, 0.0, z], [0.001, 0.001, z], [0.0, 0.001, z]]);
    }
    faces.text
}

/// Two cubes and a plank, each through the others.
fn crossing_solids() -> String {
    let mut faces = Faces::default();
    let (sine, cosine) = 0.6f64.sin_cos();
    let turned = |[x, y, z]: [f64; 3]| {
        let [x, y] = [cosine * x - sine * y, sine * x + cosine * y];
        [x, cosine * y - sine * z, sine * y + cosine * z]
    };
    let solids =
        [("a0", [0.52, 0.5, 0.51], false), ("b1", [0.46, 0.47, 0.48], true), ("b2", [1.03, 0.13, 0.35], false)];
    for (name, half, is_turned) in solids {
        let place = |at: [f64; 3]| if is_turned { turned(at) } else { at };
        faces.part(name);
        for sides in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]] {
            let corner = |corner: usize| [0, 1, 2].map(|axis| half[axis] * ((corner >> axis & 1) as f64 * 2.0 - 1.0));
            faces.face(sides.map(|side: usize| place(corner(side))));
        }
    }
    faces.text
}

/// At each of three depths a square and, over most of it, its mirror image, wound the other way.
fn mirrored_faces() -> String {
    let mut faces = Faces::default();
    for (name, z) in [("a", -0.1), ("b", -0.5), ("c", -0.9)] {
        faces.part(name);
        faces.square(-1.0, z);
        faces.face([[-0.4, 1.2, z], [1.1, 1.2, z], [1.1, -0.98, z], [-0.4, -0.98, z]]);
    }
    faces.text
}

/// Sixteen layers, and before all of them a wall over two thirds of the picture.
fn behind_a_wall() -> String {
    let mut faces = Faces { text: squares(16, 4), num_corners: 64 };
    faces.part("wall");
    faces.face([[-1.01, -0.94, 0.2], [0.35, -0.94, 0.2], [0.35, 1.11, 0.2], [-1.01, 1.11, 0.2]]);
    faces.text
}

/// A ball in the middle and balls that the picture cuts.
fn at_the_border() -> String {
    "6\n\nC 0.1 0.1 0\nO -2.4 0.2 1\nO 2.5 0.1 -1\nC 0.3 -2.3 1.5\nC -0.2 2.4 -0.5\nO 2.2 2.3 0.7\n".to_owned()
}

/// A small square close before a large one of the same object: beyond the rim of the small one the nearest fragment is of the large one
/// [Murray2016 fig. 5].
fn wrong_neighbour() -> String {
    let mut faces = Faces::default();
    faces.part("b");
    faces.face([[-1.0, -0.93, -0.2], [1.0, -0.93, -0.2], [1.0, 1.1, -0.2], [-1.0, 1.1, -0.2]]);
    faces.face([[-0.41, -0.37, 0.0], [0.43, -0.37, 0.0], [0.43, 0.46, 0.0], [-0.41, 0.46, 0.0]]);
    faces.text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::stage::Look;

    #[test]
    fn scenes_and_styles_load() {
        for hard in &SCENES {
            hard.scene().unwrap_or_else(|error| panic!("{}: {error}", hard.name));
            Look::of_text(hard.name, &hard.style("bkb", 0.5)).unwrap_or_else(|error| panic!("{}: {error}", hard.name));
        }
    }
}
