//! One place for all vertices that lie together, whatever the file calls them.

use std::collections::HashMap;
use std::hash::{BuildHasher, RandomState};

use glam::{DVec3, IVec3, Vec3};

use super::links::Links;
use super::place::{self, Frame};
use super::{RawNormals, RawShape};

/// Vertices nearer than this share of the longest side are one where surfaces end: text files round to six digits or so.
const NEAR: f64 = 1e-6;
/// Links number half-edges in 31 bits.
const MOST_TRIANGLES: usize = (1 << 31) / 3;

/// A shape while it is mended.
#[derive(Debug, Default)]
pub(super) struct Surface {
    /// Different places, scaled to about -1..1 around the middle.
    pub positions: Vec<DVec3>,
    /// Places of each triangle's corners.
    pub triangles: Vec<[u32; 3]>,
    /// The file's normals.
    pub normals: Vec<Vec3>,
    /// For each triangle the indices into `normals`; empty where there are none.
    pub normal_corners: Vec<[u32; 3]>,
    /// The file's colours.
    pub colors: Vec<[u8; 3]>,
    /// For each triangle the indices into `colors`; empty where there are none.
    pub color_corners: Vec<[u32; 3]>,
    /// Places from here on are those of sheets that lie on the back of others.
    pub first_back: usize,
}

impl Surface {
    /// Welds what is equal. Triangles that cannot be drawn are left out, and counted.
    pub fn new(raw: RawShape, frame: &Frame) -> (Surface, u32) {
        let RawShape { mut positions, mut triangles, normals, colors } = raw;
        let num_listed = triangles.len();
        let colors = if colors.len() < positions.len() { Vec::new() } else { colors };
        let (normals, mut normal_corners) = match normals {
            RawNormals::None => (Vec::new(), Vec::new()),
            RawNormals::PerVertex(normals) => (normals, triangles.clone()),
            RawNormals::PerCorner { normals, corners } => (normals, corners),
        };
        if normals.is_empty() || normal_corners.len() != num_listed {
            normal_corners = Vec::new();
        }
        let mut color_corners = if colors.is_empty() { Vec::new() } else { triangles.clone() };
        triangles.truncate(MOST_TRIANGLES);
        let place_of = weld_equal(&mut positions, &triangles, frame);
        // What cannot be drawn repeats a place, as what has shrunk to a line does; both are told apart by the count.
        let mut num_lost = (num_listed - triangles.len()) as u32;
        for triangle in &mut triangles {
            let places = triangle.map(|index| place_of.get(index as usize).copied().unwrap_or(NOWHERE));
            let is_lost = places.contains(&NOWHERE);
            num_lost += u32::from(is_lost);
            *triangle = if is_lost { [0; 3] } else { places };
        }
        normal_corners.truncate(triangles.len());
        color_corners.truncate(triangles.len());
        let first_back = positions.len();
        (Surface { positions, triangles, normals, normal_corners, colors, color_corners, first_back }, num_lost)
    }

    /// Leaves out triangles; `keep` is asked once for each, in order. Gives how many went.
    pub fn retain(&mut self, mut keep: impl FnMut(usize, [u32; 3]) -> bool) -> u32 {
        let mut kept = 0;
        for index in 0..self.triangles.len() {
            if keep(index, self.triangles[index]) {
                for list in [&mut self.triangles, &mut self.normal_corners, &mut self.color_corners] {
                    if !list.is_empty() {
                        list[kept] = list[index];
                    }
                }
                kept += 1;
            }
        }
        let num_gone = (self.triangles.len() - kept) as u32;
        for list in [&mut self.triangles, &mut self.normal_corners, &mut self.color_corners] {
            list.truncate(kept);
        }
        num_gone
    }

    /// Swaps second and third corners of some triangles.
    pub fn turn(&mut self, is_turned: &[bool]) {
        for list in [&mut self.triangles, &mut self.normal_corners, &mut self.color_corners] {
            for (triangle, _) in list.iter_mut().zip(is_turned).filter(|(_, is_turned)| **is_turned) {
                triangle.swap(1, 2);
            }
        }
    }

    /// Leaves out triangles that welding has shrunk to a line or a point.
    pub fn drop_collapsed(&mut self) -> u32 {
        self.retain(|_, [a, b, c]| a != b && b != c && c != a)
    }

    /// Welds places at open edges that lie nearer together than text files round. Gives how many went.
    pub fn weld_near(&mut self, links: &Links, frame: &Frame) -> u32 {
        let near = NEAR * 2.0 * frame.half() * frame.scale();
        // The first of each crowd stands for it. Others never do, so that no chain of steps moves a place far, and a cell
        // holds few that stand.
        let cell_of = |p: DVec3| (p / (near * CELL)).floor().as_ivec3();
        let mut last_in: HashMap<IVec3, u32> = HashMap::new();
        let mut before: Vec<(u32, u32)> = Vec::new();
        let mut moved: HashMap<u32, u32> = HashMap::new();
        for place in links.places_at_open_edges(&self.triangles) {
            let p = self.positions[place as usize];
            let (low, high) = (cell_of(p - near), cell_of(p + near));
            let mut found = None;
            for cell in cells(low, high) {
                let mut next = last_in.get(&cell).copied();
                while let Some(index) = next {
                    let (other, earlier) = before[index as usize];
                    if self.positions[other as usize].distance_squared(p) <= near * near {
                        found = found.min(Some(other)).or(Some(other));
                    }
                    next = (earlier != NOWHERE).then_some(earlier);
                }
            }
            if let Some(other) = found {
                moved.insert(place, other);
            } else {
                let earlier = last_in.insert(cell_of(p), before.len() as u32);
                before.push((place, earlier.unwrap_or(NOWHERE)));
            }
        }
        if !moved.is_empty() {
            for corner in self.triangles.as_flattened_mut() {
                *corner = moved.get(corner).copied().unwrap_or(*corner);
            }
        }
        moved.len() as u32
    }

    /// Leaves out triangles that repeat another one. One that lies on another's back is kept, but as part of a sheet of
    /// its own: otherwise each of its edges had four faces, and nothing would hang together. Gives how many went.
    pub fn part_duplicates(&mut self, links: &Links) -> u32 {
        let mut found: Vec<([u32; 3], bool, u32)> = links.duplicates.iter().map(|&face| self.key(face)).collect();
        found.sort_unstable();
        found.dedup();
        let (mut repeated, mut backs) = (Vec::new(), Vec::new());
        for same in found.chunk_by(|a, b| a.0 == b.0) {
            let mut first = [None; 2];
            for &(_, is_odd, face) in same {
                match first[usize::from(is_odd)] {
                    None => first[usize::from(is_odd)] = Some(face),
                    Some(_) => repeated.push(face),
                }
            }
            if let [Some(even), Some(odd)] = first {
                backs.push(even.max(odd));
            }
        }
        let mut back_of: HashMap<u32, u32> = HashMap::new();
        for face in backs {
            for corner in &mut self.triangles[face as usize] {
                *corner = *back_of.entry(*corner).or_insert_with(|| {
                    self.positions.push(self.positions[*corner as usize]);
                    self.positions.len() as u32 - 1
                });
            }
        }
        repeated.sort_unstable();
        let mut next = repeated.iter().peekable();
        self.retain(|face, _| next.next_if(|&&repeated| repeated as usize == face).is_none())
    }

    /// A triangle's places in order, whether that took an odd number of swaps, and itself.
    fn key(&self, face: u32) -> ([u32; 3], bool, u32) {
        let [a, b, c] = self.triangles[face as usize];
        let is_odd = (a > b) ^ (b > c) ^ (a > c);
        let mut places = [a, b, c];
        places.sort_unstable();
        (places, is_odd, face)
    }
}

/// No place.
const NOWHERE: u32 = u32::MAX;
/// Width of a cell, in distances that count as near: most balls lie in one or two cells, and few points in one cell.
const CELL: f64 = 4.0;

fn cells(low: IVec3, high: IVec3) -> impl Iterator<Item = IVec3> {
    (low.z..=high.z)
        .flat_map(move |z| (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| IVec3::new(x, y, z))))
}

/// Scales the vertices that are used and welds equal ones: gives the place of each vertex, and leaves one position for
/// each place.
fn weld_equal(positions: &mut Vec<DVec3>, triangles: &[[u32; 3]], frame: &Frame) -> Vec<u32> {
    let (middle, scale) = (frame.middle(), frame.scale());
    let mut place_of = vec![NOWHERE; positions.len()];
    for &triangle in triangles {
        if place::corners(positions, triangle).is_some() {
            triangle.into_iter().for_each(|index| place_of[index as usize] = 0);
        }
    }
    let num_used = place_of.iter().filter(|&&place| place == 0).count();
    // Open addressing with at most two thirds of the slots taken, of 4 bytes each. The seed differs in each run, so that no
    // file can choose its collisions; places are numbered by the file's order, so that it shows nowhere.
    let seed = RandomState::new().hash_one(0);
    let num_slots = (num_used + num_used / 2 + 1).next_power_of_two();
    let mut slots = vec![NOWHERE; num_slots];
    let mut num_places = 0;
    for index in 0..place_of.len() {
        if place_of[index] == NOWHERE {
            continue;
        }
        // Adding zero makes -0 and 0 equal.
        let p = (positions[index] - middle) * scale + 0.0;
        let mut slot = hash(p, seed) as usize & (num_slots - 1);
        let place = loop {
            let place = slots[slot];
            if place == NOWHERE {
                // Never ahead of the vertex that is read.
                positions[num_places as usize] = p;
                slots[slot] = num_places;
                num_places += 1;
                break num_places - 1;
            }
            if positions[place as usize] == p {
                break place;
            }
            slot = (slot + 1) & (num_slots - 1);
        };
        place_of[index] = place;
    }
    positions.truncate(num_places as usize);
    positions.shrink_to_fit();
    place_of
}

/// Bits of a position, mixed by multiplication to 128 bits whose halves are folded.
fn hash(p: DVec3, seed: u64) -> u64 {
    let fold = |a: u64, b: u64| {
        let product = u128::from(a) * u128::from(b);
        product as u64 ^ (product >> 64) as u64
    };
    let [x, y, z] = p.to_array().map(f64::to_bits);
    fold(fold(x ^ seed, y ^ 0x9e37_79b9_7f4a_7c15), z ^ seed.rotate_left(32) ^ 0xd1b5_4a32_d192_ed03)
}
