//! What is transparent is drawn by many threads, in an order that is none: the picture does not depend on it, nor on the order in which
//! a file tells its objects where no two surfaces are at one depth.

use restyle::engine::{Engine, Request};
use restyle::measure::hard::{Hard, SCENES};
use restyle::scene::{Pixels, Scene};

use super::bkb::shuffled;
use super::{gpu, layers};

const SIZE: [u32; 2] = [64, 64];

/// An engine for a scene as a file with this text tells it.
fn engine(hard: &Hard, method: &str, text: &str) -> Option<Engine> {
    let scene = Scene::from_bytes(hard.file, text.as_bytes()).unwrap_or_else(|error| panic!("{error}"));
    Some(Engine::new(gpu::device()?, scene, layers::load(&hard.style(method, hard.opacity))))
}

fn pixels(engine: &mut Engine) -> Pixels {
    engine.still(&Request { wide: true, ..Request::new(SIZE, 1) }).expect("a still").pixels
}

/// The same things in an order that depends on the salt.
fn shuffle<T: Clone>(all: &mut [T], salt: u32) {
    let former = all.to_vec();
    let order = shuffled(all.len() as u32, salt);
    order.into_iter().zip(all).for_each(|(index, thing)| *thing = former[index as usize].clone());
}

/// The text of a hard scene with its parts in another order, and the faces of each part, too; or with its atoms.
fn in_another_order(hard: &Hard, salt: u32) -> String {
    let text = (hard.text)();
    if hard.file.ends_with(".xyz") {
        let mut lines: Vec<&str> = text.lines().collect();
        shuffle(&mut lines[2..], salt);
        return lines.join("\n") + "\n";
    }
    let mut parts: Vec<(&str, Vec<[&str; 4]>)> = Vec::new();
    let mut corners = Vec::new();
    for line in text.lines() {
        match line.split_once(' ') {
            Some(("o", name)) => parts.push((name, Vec::new())),
            Some(("v", _)) => corners.push(line),
            _ => {
                let face: [&str; 4] = std::mem::take(&mut corners).try_into().expect("four corners of each face");
                parts.last_mut().expect("a part").1.push(face);
            }
        }
    }
    shuffle(&mut parts, salt);
    let (mut out, mut num_corners) = (String::new(), 0);
    for (name, mut faces) in parts {
        shuffle(&mut faces, salt + 1);
        out += &format!("o {name}\n");
        for face in faces {
            let [a, b, c, d] = [1, 2, 3, 4].map(|corner| num_corners + corner);
            out += &format!("{}\nf {a} {b} {c} {d}\n", face.join("\n"));
            num_corners += 4;
        }
    }
    out
}

/// Scenes in which no two surfaces are at one depth, nor within a step of the k-buffer's.
fn without_ties() -> impl Iterator<Item = &'static Hard> {
    let names = ["more layers than k", "one object", "an opaque wall in front", "k = 1", "at the border"];
    SCENES.iter().filter(move |hard| names.contains(&hard.name))
}

#[test]
fn a_hundred_stills_are_one() {
    for hard in SCENES.iter().filter(|hard| ["more layers than k", "solids through each other"].contains(&hard.name)) {
        for method in ["packed", "bkb"] {
            let Some(mut engine) = engine(hard, method, &(hard.text)()) else { return };
            let first = pixels(&mut engine);
            for round in 1..100 {
                assert!(pixels(&mut engine) == first, "{}, {method}, round {round}", hard.name);
            }
        }
    }
}

#[test]
fn pictures_do_not_depend_on_the_order_of_a_file() {
    for hard in without_ties() {
        for method in ["packed", "bkb"] {
            let Some(mut first) = engine(hard, method, &(hard.text)()) else { return };
            let first = pixels(&mut first);
            for salt in 1..6 {
                let text = in_another_order(hard, salt);
                assert_ne!(text, (hard.text)());
                let Some(mut other) = engine(hard, method, &text) else { return };
                assert!(pixels(&mut other) == first, "{}, {method}, order {salt}", hard.name);
            }
        }
    }
}

#[test]
fn objects_at_one_depth_are_in_the_order_of_the_file() {
    // Two faces, the first in the file counts as the nearer one, however they are drawn.
    let face = |name: &str, first: u32| {
        let corners = "v -1 -0.93 0\nv 1 -0.93 0\nv 1 1.1 0\nv -1 1.1 0\n";
        format!("o {name}\n{corners}f {first} {} {} {}\n", first + 1, first + 2, first + 3)
    };
    let hard = SCENES.iter().find(|hard| hard.name == "k = 1").expect("a hard scene");
    let [red, blue, behind] =
        ["#d04020", "#2060d0", "#f0e0a0"].map(|color| gpu::color(color).to_array().map(f64::from));
    for (names, [near, far]) in [(["a", "b"], [red, blue]), (["b", "a"], [blue, red])] {
        let text = face(names[0], 1) + &face(names[1], 5);
        let Some(mut engine) = engine(hard, "packed", &text) else { return };
        let image = gpu::still(&mut engine, SIZE, 1);
        let middle = (SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize;
        for channel in 0..3 {
            let over = |behind: f64, color: f64| behind + hard.opacity * (color - behind);
            let expected = over(over(behind[channel], far[channel]), near[channel]);
            let found = gpu::channel(&image, channel)[middle];
            assert!((found - expected).abs() < 1e-3, "{names:?}, channel {channel}: {found} and not {expected}");
        }
    }
}
