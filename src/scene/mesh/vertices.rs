//! The vertices that are drawn: one for each place, normal and colour.
//!
//! Where the file has no normal, the faces around a place fall into smooth groups, parted by edges sharper than the crease
//! angle, and a group's normal is the mean of its faces', each weighted by its angle at the place [Thurmer1998, throughout].

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::Range;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

use glam::{DVec3, Vec3};

use super::hull::hull_vector;
use super::links::{Links, SHARED};
use super::place::unit_normal;
use super::weld::Surface;
use super::{Shape, pack_hull, pack_normal};

/// Cosine of the crease angle, 35 degrees: smooth shading over less, a hard edge over more.
const CREASE: f32 = 0.819_152;
/// Cosine of half of it: normals so near to their mean have no crease among them.
const HALF_CREASE: f32 = 0.953_717;
/// Triangles lower than this, in shapes of size 1 to 2, have normals made of rounding errors.
const NEEDLE: f64 = 1e-6;

/// So many places are worth a thread of their own, and so many threads are worth it.
const PLACES_PER_THREAD: u32 = 1 << 16;
const MOST_THREADS: u32 = 8;
/// So few corners are searched one by one.
const FEW: usize = 16;

/// A face at a place.
#[derive(Debug, Clone, Copy)]
struct Face {
    /// Unit normal, or zero.
    normal: Vec3,
    /// Its angle at the place, in radians; 0 if it has no say.
    angle: f32,
    /// Whether it is drawn.
    is_drawn: bool,
}

/// What is known of the faces when vertices are made.
pub(super) struct Known<'a> {
    /// Which triangles were turned over.
    pub is_turned: &'a [bool],
    /// Which have no area, and are not drawn.
    pub is_flat: &'a [bool],
}

impl Known<'_> {
    /// The file's normal at a corner, on the side of the face.
    fn file_normal(&self, surface: &Surface, corner: u32, face_normal: Vec3) -> Option<Vec3> {
        let (face, k) = (corner as usize / 3, corner as usize % 3);
        let normal = unit_normal(*surface.normals.get(surface.normal_corners.get(face)?[k] as usize)?)?;
        Some(if self.is_turned[face] && normal.dot(face_normal) < 0.0 { -normal } else { normal })
    }

    /// Drops the file's normals if most of them look to the other side than their faces. Gives how many there were.
    pub fn check_normals(&self, surface: &mut Surface) -> u32 {
        let (mut num_good, mut num_bad) = (0, 0);
        for (corner, &place) in (0_u32..).zip(surface.triangles.as_flattened()) {
            if surface.normal_corners.is_empty() {
                break;
            }
            let face = self.face(surface, corner, place);
            match self.file_normal(surface, corner, face.normal) {
                Some(normal) if normal.dot(face.normal) < 0.0 => num_bad += 1,
                Some(_) => num_good += 1,
                None => {}
            }
        }
        if num_bad <= num_good {
            return 0;
        }
        (surface.normals, surface.normal_corners) = (Vec::new(), Vec::new());
        num_bad + num_good
    }

    #[inline]
    fn face(&self, surface: &Surface, corner: u32, place: u32) -> Face {
        let (face, k) = (corner as usize / 3, corner as usize % 3);
        let triangle = &surface.triangles[face];
        let at = |place: u32| surface.positions[place as usize];
        let (p, q, r) = (at(place), at(triangle[(k + 1) % 3]), at(triangle[(k + 2) % 3]));
        let (a, b) = (q - p, r - p);
        let cross = a.cross(b);
        let (area, dot) = (cross.length(), a.dot(b));
        let longest = a.length_squared().max(b.length_squared()).max((r - q).length_squared());
        let is_needle = self.is_flat[face] || area * area <= NEEDLE * NEEDLE * longest;
        let angle = if is_needle { 0.0 } else { angle(area, dot) };
        let normal = if area > 0.0 { (cross / area).as_vec3() } else { Vec3::ZERO };
        Face { normal, angle, is_drawn: !self.is_flat[face] }
    }
}

/// The angle of a sine and a cosine up to a common factor, from 0 to pi. The polynomial is off by less than 3e-6 radians,
/// which is enough for a weight, and it takes a fifth of the time of an exact arctangent.
fn angle(sine: f64, cosine: f64) -> f32 {
    let across = cosine.abs();
    let ratio = sine.min(across) / sine.max(across).max(f64::MIN_POSITIVE);
    let square = ratio * ratio;
    let terms = [-0.011_721_20, 0.052_653_32, -0.116_432_87, 0.193_543_46, -0.332_623_47, 0.999_977_26];
    let octant = terms.into_iter().fold(0.0, |sum, term| sum * square + term) * ratio;
    let quadrant = if sine > across { FRAC_PI_2 - octant } else { octant };
    (if cosine < 0.0 { PI - quadrant } else { quadrant }) as f32
}

/// How scaled positions become those of the shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placing {
    /// Factor.
    pub scale: f64,
    /// Where the middle goes.
    pub middle: DVec3,
}

/// Makes the vertices and triangles of a shape; its sphere is not filled in. `links` must hold rings.
pub(super) fn make(surface: Surface, mut links: Links, known: &Known, placing: Placing) -> Shape {
    // A corner's place on the ring is not needed any more once its vertex is known: the triangles grow there. Each corner
    // belongs to one place, and each place to one thread.
    let twins = std::mem::take(&mut links.twins);
    let rings: Vec<[AtomicU32; 3]> = twins.into_iter().map(|ring| ring.map(AtomicU32::new)).collect();
    let num_places = surface.positions.len() as u32;
    let num_threads = match std::thread::available_parallelism() {
        Ok(threads) => (threads.get() as u32).min(num_places / PLACES_PER_THREAD).clamp(1, MOST_THREADS),
        Err(_) => 1,
    };
    let end = |thread: u32| (u64::from(num_places) * u64::from(thread) / u64::from(num_threads)) as u32;
    let ranges: Vec<Range<u32>> = (0..num_threads).map(|thread| end(thread)..end(thread + 1)).collect();
    let task = Task { surface: &surface, links: &links, known, placing, rings: &rings };
    let chunks: Vec<Shape> = std::thread::scope(|scope| {
        let others: Vec<_> = ranges[1..].iter().map(|range| scope.spawn(|| task.vertices_at(range.clone()))).collect();
        let first = task.vertices_at(ranges[0].clone());
        let join = |thread: std::thread::ScopedJoinHandle<Shape>| {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        std::iter::once(first).chain(others.into_iter().map(join)).collect()
    });
    let mut num_before = 0;
    for (range, chunk) in ranges.into_iter().zip(&chunks) {
        if num_before > 0 {
            for &corner in range.flat_map(|place| links.corners_at(place)) {
                let vertex = &rings.as_flattened()[corner as usize];
                vertex.store(vertex.load(Relaxed).wrapping_add(num_before), Relaxed);
            }
        }
        num_before += chunk.positions.len() as u32;
    }
    drop((surface, links));
    let mut shape = joined(chunks);
    let mut is_flat = known.is_flat.iter();
    shape.triangles = rings.into_iter().map(|ring| ring.map(AtomicU32::into_inner)).collect();
    shape.triangles.retain(|_| is_flat.next() != Some(&true));
    shape.triangles.shrink_to_fit();
    shape
}

/// The vertices of all chunks in one shape.
fn joined(chunks: Vec<Shape>) -> Shape {
    let num_vertices: usize = chunks.iter().map(|chunk| chunk.positions.len()).sum();
    let mut chunks = chunks.into_iter();
    let mut shape = chunks.next().unwrap_or_default();
    let num_more = num_vertices - shape.positions.len();
    if num_more > 0 {
        shape.positions.reserve_exact(num_more);
        shape.normals.reserve_exact(num_more);
        shape.hulls.reserve_exact(num_more);
    }
    for chunk in chunks {
        shape.positions.extend(chunk.positions);
        shape.normals.extend(chunk.normals);
        shape.hulls.extend(chunk.hulls);
        shape.colors.extend(chunk.colors);
    }
    shape.positions.shrink_to_fit();
    shape.normals.shrink_to_fit();
    shape.hulls.shrink_to_fit();
    shape.colors.shrink_to_fit();
    shape
}

/// What all threads read; they write different corners of `rings`.
struct Task<'a> {
    surface: &'a Surface,
    links: &'a Links,
    known: &'a Known<'a>,
    placing: Placing,
    rings: &'a [[AtomicU32; 3]],
}

impl Task<'_> {
    /// The vertices at a range of places; the corners there get their numbers, counted from the range's first one.
    fn vertices_at(&self, places: Range<u32>) -> Shape {
        let Task { surface, links, known, placing, rings } = *self;
        let num_places = places.len();
        let mut shape = Shape {
            positions: Vec::with_capacity(num_places),
            normals: Vec::with_capacity(num_places),
            hulls: Vec::with_capacity(num_places),
            colors: Vec::with_capacity(if surface.colors.is_empty() { 0 } else { num_places }),
            ..Shape::default()
        };
        let mut around = Around::default();
        for place in places {
            let corners = links.corners_at(place);
            let Some((mean, hull)) = around.gather(surface, known, corners, place) else { continue };
            around.find_keys(surface, known, corners, rings, mean);
            let position = (surface.positions[place as usize] * placing.scale + placing.middle).as_vec3();
            let mut last = None;
            for &(key, at) in &around.keys {
                if last != Some(key) {
                    last = Some(key);
                    make_room(&mut shape);
                    shape.positions.push(position);
                    shape.normals.push(key.0);
                    shape.hulls.push(hull);
                    if !surface.colors.is_empty() {
                        shape.colors.push(key.1);
                    }
                }
                let vertex = shape.positions.len() as u32 - 1;
                rings.as_flattened()[corners[at as usize] as usize].store(vertex, Relaxed);
            }
        }
        shape
    }
}

/// Grows the lists by an eighth where they are full: doubling them would cost more than all else here.
fn make_room(shape: &mut Shape) {
    let count = shape.positions.len();
    if count == shape.positions.capacity() {
        let more = count / 8 + 16;
        shape.positions.reserve_exact(more);
        shape.normals.reserve_exact(more);
        shape.hulls.reserve_exact(more);
        if shape.colors.capacity() > 0 {
            shape.colors.reserve_exact(more);
        }
    }
}

/// Room for the work at one place.
#[derive(Debug, Default)]
struct Around {
    faces: Vec<Face>,
    /// Packed normal and colour of a vertex, and which corner it belongs to.
    keys: Vec<((u32, [u8; 3]), u32)>,
    /// For each face the smooth group, and whether another one leads to it.
    groups: Vec<u32>,
    is_led_to: Vec<bool>,
    sums: Vec<Vec3>,
    lowest: f32,
}

impl Around {
    /// Looks at all faces around a place: their mean normal and the packed hull vector; none where nothing is drawn.
    fn gather(&mut self, surface: &Surface, known: &Known, corners: &[u32], place: u32) -> Option<(Vec3, u32)> {
        self.faces.clear();
        self.faces.extend(corners.iter().map(|&corner| known.face(surface, corner, place)));
        if !self.faces.iter().any(|face| face.is_drawn) {
            return None;
        }
        if self.faces.iter().all(|face| face.angle == 0.0) {
            // Nothing but needles.
            self.faces.iter_mut().filter(|face| face.is_drawn).for_each(|face| face.angle = 1.0);
        }
        let sound = self.faces.iter().filter(|face| face.angle > 0.0).map(|face| (face.normal, face.angle));
        let sum: Vec3 = sound.clone().map(|(normal, angle)| normal * angle).sum();
        let mean = if sum.length() > 1e-4 { sum.normalize() } else { Vec3::ZERO };
        self.lowest = sound.clone().map(|(normal, _)| normal.dot(mean)).fold(1.0, f32::min);
        Some((mean, pack_hull(hull_vector(sound, mean, self.lowest))))
    }

    /// Finds the normal and colour of each corner and sorts by them.
    fn find_keys(&mut self, surface: &Surface, known: &Known, corners: &[u32], rings: &[[AtomicU32; 3]], mean: Vec3) {
        self.keys.clear();
        let mut is_grouped = false;
        let smooth = pack_normal(mean);
        for (at, &corner) in (0_u32..).zip(corners) {
            let face = self.faces[at as usize];
            if !face.is_drawn {
                continue;
            }
            let normal = match known.file_normal(surface, corner, face.normal) {
                Some(normal) => pack_normal(normal),
                None if self.lowest > HALF_CREASE => smooth,
                None => {
                    if !is_grouped {
                        self.group(corners, rings, mean);
                        is_grouped = true;
                    }
                    pack_normal(self.sums[self.groups[at as usize] as usize])
                }
            };
            let color = surface.color_corners.get(corner as usize / 3).map(|colors| colors[corner as usize % 3]);
            let color = color.and_then(|color| surface.colors.get(color as usize)).copied().unwrap_or_default();
            self.keys.push(((normal, color), at));
        }
        let first = self.keys.first().map(|key| key.0);
        if self.keys.iter().any(|key| Some(key.0) != first) {
            self.keys.sort_unstable();
        }
    }

    /// Parts the faces into smooth groups and finds the normal of each.
    fn group(&mut self, corners: &[u32], rings: &[[AtomicU32; 3]], mean: Vec3) {
        let Around { faces, groups, is_led_to, sums, .. } = self;
        let rings = rings.as_flattened();
        let following = |at: u32| {
            let corner = rings[corners[at as usize] as usize].load(Relaxed);
            if corner >= SHARED {
                None
            } else if corners.len() <= FEW {
                corners.iter().position(|&other| other == corner).map(|at| at as u32)
            } else {
                corners.binary_search(&corner).ok().map(|at| at as u32)
            }
        };
        let num_faces = faces.len() as u32;
        groups.clear();
        groups.resize(faces.len(), u32::MAX);
        is_led_to.clear();
        is_led_to.resize(faces.len(), false);
        (0..num_faces).filter_map(following).for_each(|at| is_led_to[at as usize] = true);
        sums.clear();
        // Fans first, from their starts; what is left then are whole rings.
        let starts = (0..num_faces).filter(|&at| !is_led_to[at as usize]).chain(0..num_faces);
        for start in starts {
            if groups[start as usize] != u32::MAX {
                continue;
            }
            let first_group = sums.len() as u32;
            sums.push(Vec3::ZERO);
            // Needles have no normal: they are passed over.
            let (mut first_normal, mut last_normal) = (None, None::<Vec3>);
            let mut at = start;
            let is_ring = loop {
                let Face { normal, angle, .. } = faces[at as usize];
                if angle > 0.0 {
                    if last_normal.is_some_and(|last| last.dot(normal) < CREASE) {
                        sums.push(Vec3::ZERO);
                    }
                    (first_normal, last_normal) = (first_normal.or(Some(normal)), Some(normal));
                }
                let group = sums.len() - 1;
                sums[group] += normal * angle;
                groups[at as usize] = group as u32;
                match following(at) {
                    Some(next) if next == start => break true,
                    Some(next) if groups[next as usize] == u32::MAX => at = next,
                    _ => break false,
                }
            };
            let last_group = sums.len() as u32 - 1;
            let closes = matches!((first_normal, last_normal), (Some(a), Some(b)) if a.dot(b) >= CREASE);
            if is_ring && closes && last_group > first_group {
                let sum = sums[last_group as usize];
                sums[first_group as usize] += sum;
                sums[last_group as usize] = sums[first_group as usize];
            }
        }
        for sum in sums.iter_mut() {
            *sum = sum.try_normalize().unwrap_or(if mean == Vec3::ZERO { Vec3::Z } else { mean });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_arctangent() {
        for step in 0..=10_000 {
            let expected = f64::from(step) * PI / 10_000.0;
            let (sine, cosine) = expected.sin_cos();
            let found = f64::from(angle(sine.max(0.0) * 3e-9, cosine * 3e-9));
            assert!((found - expected).abs() < 3e-6, "{found} {expected}");
        }
        assert_eq!(angle(0.0, 0.0), 0.0);
    }
}
