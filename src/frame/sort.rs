//! The order of lists: short ones by networks of comparisons, which are the same for every list of one length, so that all that is
//! compared stays in registers and neighbouring pixels do the same at the same time; longer ones in place.

use std::fmt::Write as _;

use crate::gpu::Module;
use crate::wgsl;

/// Fragments of the longest list of each class of runs, but for the last, which has all that are longer. Ours: a network of 64 no
/// longer fits the registers of a GPU.
const LONGEST: [u32; 3] = [8, 16, 32];
/// Classes of runs.
pub const CLASSES: usize = LONGEST.len() + 1;
/// Invocations of a group, and groups of a dispatch at most, which any adapter takes.
const GROUP: u32 = 256;
/// Pixels that one dispatch can sort.
pub const MOST_PIXELS: u64 = 65535 * GROUP as u64;

/// The comparisons of the network of odd-even merges [Batcher1968, throughout] that sorts a power of two.
fn comparisons(size: u32) -> Vec<[u32; 2]> {
    let mut all = Vec::new();
    for merged in (0..size.ilog2()).map(|bit| 1u32 << bit) {
        for apart in (0..=merged.ilog2()).rev().map(|bit| 1u32 << bit) {
            for first in (apart % merged..size - apart).step_by(2 * apart as usize) {
                let pairs = (first..(first + apart).min(size - apart)).map(|index| [index, index + apart]);
                all.extend(pairs.filter(|[a, b]| a / (2 * merged) == b / (2 * merged)));
            }
        }
    }
    all
}

/// `sort`, for lists of at most so many fragments.
fn network(size: u32) -> String {
    let mut text = "fn sort(list: LayerList) {\n".to_owned();
    for index in 0..size {
        let _ = writeln!(text, "    var f{index} = fragment_at(list, {index}u);");
    }
    for [a, b] in comparisons(size) {
        let _ = writeln!(text, "    order(&f{a}, &f{b});");
    }
    for index in 0..size {
        let _ = writeln!(text, "    keep(list, {index}u, f{index});");
    }
    text.push_str("}\n");
    text
}

/// What giving room and sorting know of classes.
pub fn constants() -> String {
    let longest = LONGEST.map(|size| format!("{size}u")).join(", ");
    format!(
        "const CLASSES: u32 = {CLASSES}u;\nconst LONGEST: array<u32, {}> = array<u32, {}>({longest});\nconst SORT_GROUP: u32 = {GROUP}u;\n",
        LONGEST.len(),
        LONGEST.len(),
    )
}

/// The WGSL that puts the lists of a class of runs in order.
pub fn sort_module(class: usize) -> Module {
    let mut module = Module::new(&[wgsl!("lib/layers.wgsl"), wgsl!("lib/layer_lists.wgsl")]);
    module.add_generated("classes of runs", format!("{}const CLASS: u32 = {class}u;\n", constants()));
    module.add(wgsl!("layers/sort.wgsl"));
    match LONGEST.get(class) {
        Some(size) => module.add_generated("sorting network", network(*size)),
        None => module.add(wgsl!("layers/sort_in_place.wgsl")),
    }
    module
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorts(size: u32, bits: u32) -> bool {
        let mut values: Vec<bool> = (0..size).map(|bit| bits >> bit & 1 == 1).collect();
        for [a, b] in comparisons(size) {
            if values[a as usize] && !values[b as usize] {
                values.swap(a as usize, b as usize);
            }
        }
        values.is_sorted()
    }

    // What sorts all lists of two values sorts all lists [Knuth1998 §5.3.4].
    #[test]
    fn networks_sort_everything() {
        for size in [8, 16] {
            assert!((0..1 << size).all(|bits| sorts(size, bits)), "{size}");
        }
        // The network of 32 begins with two of 16 and merges them: halves in order are all that is left to be merged.
        let [short, long] = [16, 32].map(comparisons);
        let half = |half: u32| long.iter().filter(move |[a, b]| a / 16 == half && b / 16 == half);
        for (index, first) in [0, 16].into_iter().enumerate() {
            let due = short.iter().map(|[a, b]| [a + first, b + first]);
            assert!(half(index as u32).take(short.len()).copied().eq(due), "half {index}");
        }
        let ordered = |ones: u32| ((1u32 << ones) - 1) << (16 - ones);
        assert!((0..=16).flat_map(|a| (0..=16).map(move |b| [a, b])).all(|ones| {
            let [low, high] = ones.map(ordered);
            sorts(32, low | high << 16)
        }));
        assert_eq!([8, 16, 32].map(|size| comparisons(size).len()), [19, 63, 191]);
    }
}
