//! Which side of a triangle is outside.
//!
//! Neighbours are made to agree by a flood over the edges of two triangles. Then each component is turned as a whole, if it
//! has to be: a closed one encloses a positive volume, unless it is a cavity; an open one keeps what most of its area says.

use glam::DVec3;

use super::links::{Links, OPEN, SHARED};
use super::weld::Surface;

/// Solids among which cavities are looked for, the largest ones: all pairs would take quadratic time.
const MOST_HOSTS: usize = 64;
/// Volumes below this share of the box's cube are rounding.
const NO_VOLUME: f64 = 1e-10;

/// What was found, and which triangles are to be turned.
#[derive(Debug, Default)]
pub(super) struct Winding {
    /// For each triangle whether its second and third corners are to be swapped.
    pub is_turned: Vec<bool>,
    /// Triangles that did not agree with their neighbours.
    pub num_turned: u32,
    /// Components that were inside out.
    pub num_inside_out: u32,
    /// Triangles that hang together over edges.
    pub num_components: u32,
    /// Components without an end.
    pub num_closed: u32,
    /// Edges over which no winding agrees, as on a Moebius strip.
    pub num_torn: u32,
}

/// A component that encloses a volume.
struct Solid {
    /// Range in the order of the flood.
    faces: std::ops::Range<usize>,
    volume: f64,
    low: DVec3,
    high: DVec3,
    /// Whether some of its triangles did not agree.
    is_mixed: bool,
    /// Whether more of its area was turned than kept.
    is_mostly_turned: bool,
    /// Decided: as a whole the other way round than after the flood.
    is_reversed: bool,
    /// Whether it was inside out as it was in the file.
    is_inside_out: bool,
}

impl Winding {
    /// Decides on the winding of all triangles.
    pub fn find(surface: &Surface, links: &Links) -> Winding {
        let num_faces = surface.triangles.len();
        let mut winding = Winding { is_turned: vec![false; num_faces], ..Winding::default() };
        let mut is_reached = vec![false; num_faces];
        let mut order: Vec<u32> = Vec::with_capacity(num_faces);
        let mut solids: Vec<Solid> = Vec::new();
        for seed in 0..num_faces {
            if !is_reached[seed] {
                let first = order.len();
                order.push(seed as u32);
                is_reached[seed] = true;
                winding.num_components += 1;
                let (is_closed, is_mixed) = winding.flood(surface, links, &mut order, &mut is_reached);
                let faces = first..order.len();
                if is_closed {
                    winding.num_closed += 1;
                    solids.push(Solid::new(surface, &order, faces, &winding.is_turned, is_mixed));
                } else if is_mixed {
                    let reverse = is_mostly_turned(surface, &order[faces.clone()], &winding.is_turned);
                    winding.settle(&order[faces], reverse, true);
                }
            }
        }
        decide(&mut solids);
        for solid in solids {
            let (faces, is_mixed) = (&order[solid.faces.clone()], solid.is_mixed);
            winding.num_inside_out += u32::from(solid.is_inside_out);
            winding.settle(faces, solid.is_reversed, is_mixed);
        }
        winding
    }

    /// Reaches all that hangs together with the last of `order`; whether that has no end, and whether it was mixed.
    fn flood(
        &mut self,
        surface: &Surface,
        links: &Links,
        order: &mut Vec<u32>,
        is_reached: &mut [bool],
    ) -> (bool, bool) {
        let place_of = surface.triangles.as_flattened();
        let (mut is_closed, mut is_mixed) = (true, false);
        let mut head = order.len() - 1;
        while let Some(&face) = order.get(head) {
            head += 1;
            let is_turned = self.is_turned[face as usize];
            for (&twin, &place) in links.twins[face as usize].iter().zip(&surface.triangles[face as usize]) {
                if twin >= SHARED {
                    is_closed &= twin != OPEN;
                    continue;
                }
                let other = twin as usize / 3;
                // Neighbours that agree go along their edge in opposite directions.
                let turns = is_turned ^ (place_of[twin as usize] == place);
                if !is_reached[other] {
                    is_reached[other] = true;
                    self.is_turned[other] = turns;
                    is_mixed |= turns;
                    order.push(other as u32);
                } else if self.is_turned[other] != turns {
                    // Seen from both sides.
                    self.num_torn += u32::from(face as usize <= other);
                    is_closed = false;
                }
            }
        }
        (is_closed, is_mixed)
    }

    /// Turns a component as a whole, if it has to be, and counts.
    fn settle(&mut self, faces: &[u32], reverse: bool, is_mixed: bool) {
        for &face in faces {
            let is_turned = &mut self.is_turned[face as usize];
            *is_turned ^= reverse;
            self.num_turned += u32::from(is_mixed && *is_turned);
        }
    }
}

impl Solid {
    fn new(
        surface: &Surface,
        order: &[u32],
        faces: std::ops::Range<usize>,
        is_turned: &[bool],
        is_mixed: bool,
    ) -> Solid {
        let members = &order[faces.clone()];
        let corners = |face: u32| surface.triangles[face as usize].map(|place| surface.positions[place as usize]);
        // Volumes of tetrahedra from a corner of its own: small numbers, small errors.
        let apex = corners(members[0])[0];
        let (mut volume, mut low, mut high) = (0.0, apex, apex);
        for &face in members {
            let [a, b, c] = corners(face);
            (low, high) = (low.min(a).min(b).min(c), high.max(a).max(b).max(c));
            let six = (a - apex).dot((b - apex).cross(c - apex));
            volume += if is_turned[face as usize] { -six } else { six };
        }
        let is_back = surface.triangles[members[0] as usize][0] as usize >= surface.first_back;
        if is_back || volume.abs() <= NO_VOLUME * low.distance(high).powi(3) {
            volume = 0.0;
        }
        let is_mostly_turned = is_mixed && is_mostly_turned(surface, members, is_turned);
        Solid { faces, volume, low, high, is_mixed, is_mostly_turned, is_reversed: false, is_inside_out: false }
    }

    fn holds(&self, other: &Solid) -> bool {
        self.low.cmplt(other.low).all() && self.high.cmpgt(other.high).all()
    }
}

/// Whether the flood turned more area than it kept.
fn is_mostly_turned(surface: &Surface, faces: &[u32], is_turned: &[bool]) -> bool {
    let area = |face: u32| {
        let [a, b, c] = surface.triangles[face as usize].map(|place| surface.positions[place as usize]);
        (b - a).cross(c - a).length()
    };
    faces.iter().map(|&face| if is_turned[face as usize] { area(face) } else { -area(face) }).sum::<f64>() > 0.0
}

/// Decides which solids are reversed.
///
/// Without a host, a volume must be positive. Within a host it may be a cavity or another solid, and the file is believed
/// as far as the host was right: a file that is inside out as a whole has cavities that are, too.
fn decide(solids: &mut [Solid]) {
    let size = |solid: &Solid| solid.low.distance_squared(solid.high);
    let mut by_size: Vec<u32> = (0..solids.len() as u32).collect();
    by_size.sort_by(|&a, &b| size(&solids[b as usize]).total_cmp(&size(&solids[a as usize])));
    let mut hosts: Vec<u32> = Vec::new();
    for index in by_size {
        let solid = &solids[index as usize];
        // The smallest host is the last one.
        let host = hosts.iter().rev().find(|&&host| solids[host as usize].holds(solid));
        let host_was_inside_out = host.map(|&host| solids[host as usize].is_inside_out);
        let solid = &mut solids[index as usize];
        match host_was_inside_out {
            _ if solid.volume == 0.0 => solid.is_reversed = solid.is_mostly_turned,
            None => {
                solid.is_reversed = solid.volume < 0.0;
                solid.is_inside_out = solid.is_reversed && !solid.is_mixed;
            }
            Some(was_inside_out) => {
                solid.is_reversed = solid.is_mostly_turned ^ was_inside_out;
                solid.is_inside_out = was_inside_out && !solid.is_mixed;
            }
        }
        if hosts.len() < MOST_HOSTS && solid.volume != 0.0 {
            hosts.push(index);
        }
    }
}
