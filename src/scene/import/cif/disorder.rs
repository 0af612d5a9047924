//! Disordered groups of a crystal: which of several places of one group is drawn.
//!
//! Of each assembly the group with the highest mean occupancy is drawn, the first in the file if equal. Groups with a
//! negative number are disordered about a symmetry element and have no alternative in the list [CoreCif,
//! `_atom_site_disorder_group`]. Of atoms that share one place, as in alloys, the most occupied is drawn.

use super::atom_site::Site;
use super::cell::Cell;
use super::places::Places;
use std::collections::HashMap;

/// Sum and count of the occupancies of a group, and its first atom.
type Occupied = (f64, u32, usize);

/// For each atom whether it is drawn.
pub(super) fn choose(sites: &[Site<'_>], cell: &Cell) -> Vec<bool> {
    // By assembly and group.
    let mut groups: HashMap<(&[u8], &[u8]), Occupied> = HashMap::new();
    for (index, site) in sites.iter().enumerate().filter(|(_, site)| has_alternatives(site)) {
        let group = groups.entry((site.disorder.1, site.disorder.0)).or_insert((0.0, 0, index));
        *group = (group.0 + f64::from(site.atom.occupancy), group.1 + 1, group.2);
    }
    let mut chosen: HashMap<&[u8], (&[u8], f64, usize)> = HashMap::new();
    for (&(assembly, group), &(sum, count, first)) in &groups {
        let mean = sum / f64::from(count);
        let best = chosen.entry(assembly).or_insert((group, mean, first));
        if mean > best.1 || mean == best.1 && first < best.2 {
            *best = (group, mean, first);
        }
    }
    let is_chosen = |site: &Site<'_>| {
        let group = chosen.get(site.disorder.1).map(|best| best.0);
        !has_alternatives(site) || group == Some(site.disorder.0)
    };
    let mut keep: Vec<bool> = sites.iter().map(is_chosen).collect();

    let mut places = Places::new(cell);
    // The atom at each place.
    let mut drawn: Vec<usize> = Vec::new();
    for (index, site) in sites.iter().enumerate() {
        if !keep[index] {
            continue;
        }
        match places.take(site.atom.position) {
            Ok(_) => drawn.push(index),
            Err(place) => {
                let other = &mut drawn[place as usize];
                let occupancies = [*other, index].map(|index| sites[index].atom.occupancy);
                // Whole atoms at one place are the file's mistake, not an alternative.
                if occupancies.iter().all(|&occupancy| occupancy < 1.0) {
                    let loser = if occupancies[1] > occupancies[0] { std::mem::replace(other, index) } else { index };
                    keep[loser] = false;
                }
            }
        }
    }
    keep
}

fn has_alternatives(site: &Site<'_>) -> bool {
    !site.disorder.0.is_empty() && !site.disorder.0.starts_with(b"-")
}
