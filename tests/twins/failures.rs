//! Scenes that are hard for methods of transparency (`src/measure/hard.rs`): what the lists make of each, which is what the reference
//! renderer's exact crossing does, and what the k-buffer makes of it, which is what its twin does, with how much that loses.

use std::ops::ControlFlow;

use restyle::engine::exact::Exact;
use restyle::engine::{BkbForm, BkbWords, Engine, Request};
use restyle::measure::hard::{Hard, SCENES};
use restyle::scene::Image;

use super::bkb::{EMPTY, insert, stored_depth};
use super::{gpu, layers};

const SIZE: [u32; 2] = [64, 64];

/// A step of 8 bits, in linear light.
const STEP: f64 = 1.0 / 255.0;
/// Pictures of 16 bits and arithmetic of 32; largest seen 3e-5 on llvmpipe 15.
const TWIN: f64 = 1e-3;
/// Pixels of a picture whose centre lies so close to a border that rounding decides what is seen; at most 1 seen.
const ON_A_BORDER: usize = 3;

type Light = [f64; 3];

/// A fragment: its depth, its id, its object's number, and that one's colour.
#[derive(Clone, Copy)]
struct Fragment {
    depth: f32,
    id: u32,
    shape: u32,
    color: Light,
}

/// A hard scene as both methods draw it.
struct Drawn {
    packed: Vec<Light>,
    bkb: Vec<Light>,
    words: BkbWords,
    /// The fragments of each pixel, from near to far.
    fragments: Vec<Vec<Fragment>>,
}

fn hard(name: &str) -> &'static Hard {
    SCENES.iter().find(|hard| hard.name == name).expect("a hard scene")
}

fn light(image: &Image) -> Vec<Light> {
    gpu::pixels(image.size)
        .map(|(x, y)| image.pixel(x, y))
        .map(|[r, g, b, _]| [r, g, b].map(gpu::linear_from_srgb))
        .collect()
}

fn apart(a: Light, b: Light) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn largest(a: &[Light], b: &[Light]) -> f64 {
    a.iter().zip(b).map(|(a, b)| apart(*a, *b)).fold(0.0, f64::max)
}

fn over(behind: Light, color: Light, opacity: f64) -> Light {
    [0, 1, 2].map(|channel| behind[channel] + opacity * (color[channel] - behind[channel]))
}

fn engine(hard: &Hard, method: &str, opacity: f64) -> Option<Engine> {
    let scene = hard.scene().unwrap_or_else(|error| panic!("{}: {error}", hard.name));
    Some(Engine::new(gpu::device()?, scene, layers::load(&hard.style(method, opacity))))
}

fn truth(hard: &Hard) -> Image {
    let scene = hard.scene().unwrap_or_else(|error| panic!("{}: {error}", hard.name));
    let exact = Exact::new(scene, layers::load(&hard.style("packed", hard.opacity)), None);
    let request = Request { wide: true, ..Request::new(SIZE, 1) };
    exact.still(&request, &mut |_| ControlFlow::Continue(())).expect("the reference")
}

/// Number and colour of the object of each face or atom, in the order of ids.
fn objects(hard: &Hard) -> Vec<(u32, Light)> {
    let color = |name: &str| {
        let is_red = name.starts_with('a') || name == "O";
        gpu::color(if is_red { "#d04020" } else { "#2060d0" }).to_array().map(f64::from)
    };
    let text = (hard.text)();
    if hard.file.ends_with(".xyz") {
        let elements = text.lines().skip(2).filter_map(|line| line.split(' ').next());
        return elements.zip(0..).map(|(element, number)| (number, color(element))).collect();
    }
    let (mut all, mut part, mut num_parts) = (Vec::new(), "", 0);
    for line in text.lines() {
        match line.split_once(' ') {
            Some(("o", name)) => (part, num_parts) = (name, num_parts + 1),
            // A face of four corners is two triangles.
            Some(("f", _)) => all.extend([(num_parts - 1, color(part)); 2]),
            _ => {}
        }
    }
    all
}

/// What the lists make of a pixel: all fragments over what is opaque.
fn lists(fragments: &[Fragment], behind: Light, opacity: f64) -> Light {
    fragments.iter().rev().fold(behind, |behind, fragment| over(behind, fragment.color, opacity))
}

/// What the k-buffer makes of a pixel: its k nearest keys of depth and object over what is opaque.
fn buffer(words: &BkbWords, fragments: &[Fragment], behind: Light, opacity: f64) -> Light {
    let mut slots = vec![EMPTY; words.band.k as usize];
    let key = |fragment: &Fragment| stored_depth(&words.band, fragment.depth) << 16 | (fragment.shape & 0xffff);
    fragments.iter().for_each(|fragment| insert(&mut slots, key(fragment)));
    let opacity = (opacity * 255.0).round() / 255.0;
    slots.iter().rev().filter(|slot| **slot != EMPTY).fold(behind, |behind, slot| {
        let kept = fragments.iter().find(|fragment| key(fragment) == *slot).expect("a key of a fragment");
        over(behind, kept.color, opacity)
    })
}

/// Draws a scene by both methods, and holds the lists to the reference and both to their twins.
fn drawn(name: &str) -> Option<Drawn> {
    let hard = hard(name);
    let still = |method: &str, opacity: f64| Some(light(&gpu::still(&mut engine(hard, method, opacity)?, SIZE, 1)));
    let (packed, bkb) = (still("packed", hard.opacity)?, still("bkb", hard.opacity)?);
    let behind = still("packed", 0.0)?;
    let off = packed.iter().zip(light(&truth(hard))).filter(|(packed, truth)| apart(**packed, *truth) > STEP).count();
    assert!(off <= ON_A_BORDER, "{name}: {off} pixels of the lists are not those of the reference");

    let words =
        engine(hard, "bkb", hard.opacity)?.bkb_words(&Request::new(SIZE, 1)).expect("a frame").expect("one band");
    let objects = objects(hard);
    let fragment = |&[depth, id]: &[u32; 2]| {
        let (shape, color) = objects[(id & 0x1fff_ffff) as usize];
        Fragment { depth: f32::from_bits(depth), id, shape, color }
    };
    let mut fragments: Vec<Vec<Fragment>> =
        words.fragments.iter().map(|list| list.iter().map(fragment).collect()).collect();
    for list in &mut fragments {
        list.sort_by(|a, b| a.depth.total_cmp(&b.depth).then(a.id.cmp(&b.id)));
    }
    let pixels = || fragments.iter().zip(&behind);
    let of_lists: Vec<Light> = pixels().map(|(list, behind)| lists(list, *behind, hard.opacity)).collect();
    let of_buffer: Vec<Light> = pixels().map(|(list, behind)| buffer(&words, list, *behind, hard.opacity)).collect();
    let [packed_off, bkb_off] = [largest(&packed, &of_lists), largest(&bkb, &of_buffer)];
    eprintln!(
        "{name}: {off} pixels on a border, lists off their twin by {packed_off:.1e}, the k-buffer off its own by {bkb_off:.1e} and off the lists \
         by {:.4}",
        largest(&packed, &bkb)
    );
    assert!(packed_off < TWIN && bkb_off < TWIN, "{name}: {packed_off} and {bkb_off}");
    Some(Drawn { packed, bkb, words, fragments })
}

impl Drawn {
    /// Fragments that the k-buffer keeps of each pixel.
    fn kept(&self) -> Vec<usize> {
        let slots = self.words.z.chunks_exact(self.words.band.k as usize);
        slots.map(|slots| slots.iter().filter(|key| **key != EMPTY).count()).collect()
    }

    /// Light that is different in the pixels of which `is_one` holds, by the number of fragments there are and are kept.
    fn largest_where(&self, is_one: impl Fn(usize, usize) -> bool) -> f64 {
        let pixels = self.fragments.iter().zip(self.kept()).zip(self.packed.iter().zip(&self.bkb));
        let chosen = pixels.filter(|((list, kept), _)| is_one(list.len(), *kept));
        chosen.map(|(_, (packed, bkb))| apart(*packed, *bkb)).fold(0.0, f64::max)
    }

    fn most_layers(&self) -> usize {
        self.fragments.iter().map(Vec::len).max().unwrap_or(0)
    }
}

#[test]
fn beyond_k_layers_the_k_buffer_loses_the_farthest() {
    let Some(drawn) = drawn("more layers than k") else { return };
    assert_eq!(drawn.most_layers(), 40);
    assert!(drawn.kept().iter().zip(&drawn.fragments).all(|(kept, list)| *kept == list.len().min(16)));
    assert!(drawn.largest_where(|count, _| count <= 16) < TWIN);
    let lost = drawn.largest_where(|count, _| count > 16);
    assert!((0.05..0.3).contains(&lost), "{lost}");
}

#[test]
fn of_one_object_there_is_one_bucket_of_all_fragments() {
    let Some(drawn) = drawn("one object") else { return };
    assert_eq!(drawn.most_layers(), 24);
    assert!(drawn.largest_where(|_, _| true) < TWIN, "it is right, but nothing is gained");
    for (buckets, list) in drawn.words.b.chunks_exact(32).zip(&drawn.fragments).filter(|(_, list)| !list.is_empty()) {
        let found: Vec<u32> = buckets.iter().copied().filter(|bucket| *bucket != EMPTY).collect();
        assert_eq!(found, [list.len() as u32 - 1], "from slot 0 to the last");
    }
}

#[test]
fn tiny_objects_are_all_there_but_have_no_neighbours() {
    let Some(drawn) = drawn("many tiny objects") else { return };
    assert!(drawn.most_layers() >= 3 && drawn.largest_where(|_, _| true) < TWIN);
    let kappas = drawn.words.z.iter().zip(&drawn.words.kappa).filter(|(key, _)| **key != EMPTY);
    let (missing, all) =
        kappas.fold((0, 0), |(missing, all), (_, kappa)| (missing + usize::from(*kappa == -1.0), all + 1));
    eprintln!("{missing} of {all} fragments of tiny objects lack a neighbour, and count as a rim");
    assert!(all > 3000 && missing * 2 > all, "{missing} of {all}");
}

#[test]
fn objects_65536_apart_are_one_to_the_k_buffer() {
    let Some(drawn) = drawn("70,000 objects") else { return };
    let most = drawn.most_layers();
    let lost: usize = drawn.fragments.iter().zip(drawn.kept()).map(|(list, kept)| list.len() - kept).sum();
    let all: usize = drawn.fragments.iter().map(Vec::len).sum();
    eprintln!("up to {most} layers; {lost} of {all} fragments are lost to numbers that wrap");
    assert!((17..=32).contains(&most) && drawn.fragments.iter().flatten().any(|fragment| fragment.shape > 65_536));
    assert!(lost * 40 > all, "{lost} of {all}");
    assert!(drawn.largest_where(|count, kept| count == kept) < TWIN && drawn.largest_where(|_, _| true) > 0.01);
}

#[test]
fn shells_within_a_step_of_depth_are_one_or_change_places() {
    let Some(drawn) = drawn("shells 1e-4 apart") else { return };
    // Of 65534 steps each is wider than a shell is deep.
    let step = 1.0 / drawn.words.band.depth_scale;
    assert!((1e-4..1e-3).contains(&step), "{step}");
    let most = drawn.most_layers();
    let kept =
        drawn.kept().into_iter().zip(&drawn.fragments).filter(|(_, list)| list.len() == most).map(|(kept, _)| kept);
    let (fewest, largest) = kept.fold((usize::MAX, 0), |(fewest, most), kept| (fewest.min(kept), most.max(kept)));
    eprintln!("{fewest} to {largest} of {most} shells are kept, with steps of {step:.1e}");
    assert!(most == 12 && largest < most);
    assert!(drawn.largest_where(|_, _| true) > 0.05);
}

#[test]
fn solids_through_each_other_are_right_but_for_one_step_of_depth() {
    let Some(drawn) = drawn("solids through each other") else { return };
    assert!(
        drawn.most_layers() >= 6 && drawn.kept().iter().zip(&drawn.fragments).all(|(kept, list)| *kept == list.len())
    );
    for (list, (packed, bkb)) in drawn.fragments.iter().zip(drawn.packed.iter().zip(&drawn.bkb)) {
        let is_close = list.windows(2).any(|pair| (pair[1].depth - pair[0].depth) * drawn.words.band.depth_scale < 1.0);
        assert!(is_close || apart(*packed, *bkb) < TWIN, "nothing is close, and yet {}", apart(*packed, *bkb));
    }
}

#[test]
fn faces_at_one_place_that_look_both_ways_are_one_to_the_k_buffer() {
    let Some(drawn) = drawn("faces both ways") else { return };
    for (list, kept) in drawn.fragments.iter().zip(drawn.kept()) {
        assert!(kept == list.len().min(3) && [0, 3, 6].contains(&list.len()), "{kept} of {}", list.len());
    }
    assert!(drawn.largest_where(|count, kept| count == kept) < TWIN && drawn.largest_where(|_, _| true) > 0.05);
}

#[test]
fn behind_an_opaque_wall_there_is_nothing() {
    let Some(drawn) = drawn("an opaque wall in front") else { return };
    let wall = gpu::color("#208040").to_array().map(f64::from);
    let is_wall = |light: &Light| apart(*light, wall) < TWIN;
    let behind = drawn.packed.iter().zip(&drawn.bkb).zip(drawn.fragments.iter().zip(drawn.kept()));
    let walls: Vec<_> = behind.filter(|((packed, _), _)| is_wall(packed)).collect();
    assert!(walls.len() > 1000, "{}", walls.len());
    assert!(walls.iter().all(|((_, bkb), (list, kept))| is_wall(bkb) && list.is_empty() && *kept == 0));
    assert!(drawn.most_layers() == 16 && drawn.largest_where(|_, _| true) < TWIN);
}

#[test]
fn at_the_border_neighbours_beyond_it_are_not_missed() {
    let Some(drawn) = drawn("at the border") else { return };
    assert!(drawn.largest_where(|_, _| true) < TWIN);
    let [width, height] = SIZE.map(|pixels| pixels as usize);
    let shapes = |x: usize, y: usize| {
        let mut shapes: Vec<u32> = drawn.fragments[y * width + x].iter().map(|fragment| fragment.shape).collect();
        shapes.sort_unstable();
        shapes
    };
    let mut compared = 0;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let is_border = x == 0 || y == 0 || x == width - 1 || y == height - 1;
        let near = [(x.max(1) - 1, y), ((x + 1).min(width - 1), y), (x, y.max(1) - 1), (x, (y + 1).min(height - 1))];
        if !is_border || near.iter().any(|(nx, ny)| shapes(*nx, *ny) != shapes(x, y)) {
            continue;
        }
        let kappas = &drawn.words.kappa[(y * width + x) * 8..][..shapes(x, y).len()];
        assert!(kappas.iter().all(|kappa| *kappa > -1.0), "{x}, {y}: {kappas:?}");
        compared += kappas.len();
    }
    assert!(compared > 60, "{compared}");
}

#[test]
fn of_nothing_both_methods_draw_the_background() {
    let background = gpu::color("#f0e0a0").to_array().map(f64::from);
    for method in ["packed", "bkb"] {
        let hard = hard("nothing to see");
        let Some(mut engine) = engine(hard, method, hard.opacity) else { return };
        let picture = light(&gpu::still(&mut engine, SIZE, 1));
        assert!(picture.iter().all(|light| apart(*light, background) < TWIN), "{method}");
        assert!(largest(&picture, &light(&truth(hard))) < STEP);
        assert!(engine.bkb_words(&Request::new(SIZE, 1)).expect("a frame").is_none(), "{method} keeps nothing");
    }
}

#[test]
fn with_one_slot_the_nearest_is_all_there_is() {
    let Some(drawn) = drawn("k = 1") else { return };
    assert!(drawn.most_layers() == 8 && drawn.kept().iter().all(|kept| *kept <= 1));
    assert!(drawn.largest_where(|count, _| count <= 1) < TWIN && drawn.largest_where(|_, _| true) > 0.1);
}

#[test]
fn without_a_reverse_check_a_rim_before_its_own_object_is_missed() {
    let hard = hard("the wrong neighbour");
    let rims = |form: BkbForm| {
        let mut engine = engine(hard, "bkb", hard.opacity)?;
        engine.set_bkb_form(form);
        let words = engine.bkb_words(&Request::new(SIZE, 1)).expect("a frame").expect("one band");
        let (width, count) = (SIZE[0] as usize, |pixel: usize| words.fragments[pixel].len());
        let (mut rim, mut found, mut wrong) = (0, 0, 0);
        // Both squares are seen in the middle of the picture, and nothing but the large one around it.
        for pixel in (width..words.fragments.len() - width).filter(|pixel| count(*pixel) == 2) {
            let is_rim = [pixel - 1, pixel + 1, pixel - width, pixel + width].iter().any(|near| count(*near) == 1);
            let is_found = words.kappa[pixel * hard.k] == -1.0;
            rim += usize::from(is_rim);
            found += usize::from(is_rim && is_found);
            wrong += usize::from(!is_rim && is_found);
        }
        Some((rim, found, wrong))
    };
    let (Some(checked), Some(simple)) = (rims(BkbForm::Published), rims(BkbForm::OneWay)) else { return };
    eprintln!("rim of the small square, found, beside it: {checked:?} with a reverse check, {simple:?} without");
    assert!(checked.0 > 60 && checked == (checked.0, checked.0, 0), "{checked:?}");
    assert_eq!(simple, (checked.0, 0, 0));
    // What the lists draw does not ask neighbours.
    let Some(mut engine) = engine(hard, "packed", hard.opacity) else { return };
    let (packed, truth) = (light(&gpu::still(&mut engine, SIZE, 1)), light(&truth(hard)));
    let off = packed.iter().zip(&truth).filter(|(packed, truth)| apart(**packed, **truth) > STEP).count();
    assert!(off <= ON_A_BORDER, "{off}");
}
