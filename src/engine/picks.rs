//! Which objects the post effects of a style pick, where they do not change all: a bit of each object for each selector.

use crate::config::{Selector, Style};
use crate::effects::{EFFECTS, effect_index};
use crate::providers::{Picked, picked};
use crate::scene::Scene;

/// The selectors of the post effects that a style draws, each once, in the order of their bits.
pub fn selectors(style: &Style) -> Vec<&Selector> {
    let mut selectors = Vec::new();
    for used in style.post_effects.iter().map(|&index| &style.shaders[index]) {
        let selector = effect_index(used.shader).and_then(|effect| EFFECTS[effect].picks(&used.values));
        selectors.extend(selector.filter(|selector| !selectors.contains(selector)));
    }
    selectors
}

/// What some selectors pick of a scene.
#[derive(Debug, Default)]
pub struct Picks(Vec<Picked>);

impl Picks {
    /// What these pick.
    pub fn new(scene: &Scene, selectors: &[Selector]) -> Picks {
        Picks(selectors.iter().map(|selector| picked(scene, selector)).collect())
    }

    /// The bits of those that pick anything.
    pub fn any(&self) -> u32 {
        self.bits(|picked| !picked.is_empty())
    }

    /// The bits of an atom of the scene.
    pub fn of_atom(&self, index: usize) -> u32 {
        self.bits(|picked| picked.atoms[index])
    }

    /// The bits of a bond of the scene.
    pub fn of_connector(&self, index: usize) -> u32 {
        self.bits(|picked| picked.connectors[index])
    }

    /// The bits of a part of the scene.
    pub fn of_part(&self, index: usize) -> u32 {
        self.bits(|picked| picked.parts[index])
    }

    fn bits(&self, is_picked: impl Fn(&Picked) -> bool) -> u32 {
        self.0.iter().enumerate().fold(0, |bits, (bit, picked)| bits | u32::from(is_picked(picked)) << bit)
    }
}
