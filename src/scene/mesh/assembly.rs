//! Shapes and parts, mended and recentred.
//!
//! Cost: 20 bytes per vertex (24 with colours), 12 per triangle, some 100 per part.

use std::sync::OnceLock;

use glam::{Affine3A, DVec3, Vec3};

use super::curvature::Bending;
use crate::scene::Sphere;

/// What a file says of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshMaterial {
    /// Its name, or empty.
    pub name: String,
    /// Linear RGB, 0 to 1.
    pub base_color: Vec3,
    /// 0 dielectric to 1 metal; none where the file says nothing.
    pub metallic: Option<f32>,
    /// Perceptual roughness, 0 to 1; none where the file says nothing.
    pub roughness: Option<f32>,
    /// Share of light that it stops, 0 to 1.
    pub opacity: f32,
}

/// Triangles in the coordinates of the shape, single precision, near its origin.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shape {
    /// Vertices.
    pub positions: Vec<Vec3>,
    /// Unit normal of each vertex, by [`pack_normal`]. A hard edge has a vertex for each side.
    pub normals: Vec<u32>,
    /// Where the outline's shell lies for each vertex, by [`pack_hull`]: the same at all vertices of one place, so that
    /// the shell has no gaps.
    pub hulls: Vec<u32>,
    /// sRGB of each vertex, or empty.
    pub colors: Vec<[u8; 3]>,
    /// Vertices of each triangle, counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// A sphere around all of it.
    pub sphere: Sphere,
    /// How thick it is on average: the mean length of lines within it. Infinite where it does not enclose a volume.
    pub thickness: f32,
    /// See [`Shape::bending`].
    pub(super) bending: OnceLock<Bending>,
}

impl Shape {
    /// How it bends, found when it is asked for first.
    pub fn bending(&self) -> &Bending {
        self.bending.get_or_init(|| Bending::new(self))
    }

    /// The mean length of all lines through a closed surface, which is four times its volume over its area (Cauchy).
    /// Infinite of an open one.
    pub(super) fn mean_chord(&self) -> f32 {
        /// A closed surface's area vectors add up to nothing; share of its area by which they may miss it.
        const OPEN: f64 = 1e-3;
        let (mut volume, mut area, mut sum) = (0.0f64, 0.0f64, DVec3::ZERO);
        let origin = self.sphere.center;
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|corner| (self.positions[corner as usize] - origin).as_dvec3());
            let across = (b - a).cross(c - a);
            volume += a.dot(across) / 6.0;
            area += 0.5 * across.length();
            sum += 0.5 * across;
        }
        let chord = 4.0 * volume / area;
        if sum.length() <= OPEN * area && chord > 0.0 { chord as f32 } else { f32::INFINITY }
    }
}

/// A shape at a place, with what selectors can ask of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Index into [`Assembly::shapes`].
    pub shape: u32,
    /// Index into [`Assembly::materials`].
    pub material: Option<u32>,
    /// Index into [`Assembly::names`]: what the file calls it.
    pub name: u32,
    /// Index into [`Assembly::names`]: the way to it through the file's tree.
    pub path: u32,
    /// Index into [`Scene::files`](crate::scene::Scene::files).
    pub file: u32,
    /// From the shape's to the scene's coordinates; may mirror.
    pub world_from_shape: Affine3A,
}

/// All meshes of a scene. Empty where it has none.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// Triangles, each shape once.
    pub shapes: Vec<Shape>,
    /// Where they are, in the order of the files.
    pub parts: Vec<Part>,
    /// Materials of all files.
    pub materials: Vec<MeshMaterial>,
    /// Different names of parts and paths.
    pub names: Vec<String>,
    /// Around all parts.
    pub sphere: Sphere,
    /// File units in one scene unit: 1, but a power of two for meshes so large or small that single precision would fail.
    pub unit: f64,
    /// Where the file has the scene's zero, in file units.
    pub origin: glam::DVec3,
}

impl Default for Assembly {
    fn default() -> Self {
        Self {
            shapes: Vec::new(),
            parts: Vec::new(),
            materials: Vec::new(),
            names: Vec::new(),
            sphere: Sphere { center: Vec3::ZERO, radius: 0.0 },
            unit: 1.0,
            origin: glam::DVec3::ZERO,
        }
    }
}

impl Assembly {
    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Triangles of all parts, those of a shape once for each place.
    pub fn num_triangles(&self) -> u64 {
        self.parts.iter().map(|part| self.shapes[part.shape as usize].triangles.len() as u64).sum()
    }

    /// Bytes that it holds in memory, names aside.
    pub fn memory_bytes(&self) -> usize {
        let of_shape = |shape: &Shape| {
            shape.positions.capacity() * size_of::<Vec3>()
                + (shape.normals.capacity() + shape.hulls.capacity()) * size_of::<u32>()
                + shape.colors.capacity() * size_of::<[u8; 3]>()
                + shape.triangles.capacity() * size_of::<[u32; 3]>()
        };
        self.shapes.iter().map(of_shape).sum::<usize>() + self.parts.capacity() * size_of::<Part>()
    }
}

/// Octahedral coordinates of a unit vector, each in -1..1 [Cigolle2014, throughout].
fn octahedral(v: Vec3) -> [f32; 2] {
    let sum = v.x.abs() + v.y.abs() + v.z.abs();
    let (x, y) = if sum > 0.0 { (v.x / sum, v.y / sum) } else { (0.0, 0.0) };
    if v.z >= 0.0 {
        return [x, y];
    }
    let sign = |value: f32| if value >= 0.0 { 1.0 } else { -1.0 };
    [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)]
}

fn from_octahedral([x, y]: [f32; 2]) -> Vec3 {
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let folded = |value: f32| if value >= 0.0 { value - fold } else { value + fold };
    Vec3::new(folded(x), folded(y), z).normalize_or(Vec3::Z)
}

fn quantised(value: f32, steps: f32) -> u32 {
    ((value.clamp(-1.0, 1.0) * 0.5 + 0.5) * steps).round() as u32
}

fn from_quantised(bits: u32, steps: f32) -> f32 {
    bits as f32 / steps * 2.0 - 1.0
}

/// A unit vector in 16 + 16 bits; off by less than 0.004 degrees.
pub fn pack_normal(normal: Vec3) -> u32 {
    let [x, y] = octahedral(normal).map(|value| quantised(value, 65_534.0));
    x | y << 16
}

/// The unit vector of [`pack_normal`]. 0 to 65534 so that the axes are exact.
pub fn unpack_normal(packed: u32) -> Vec3 {
    from_octahedral([packed & 0xffff, packed >> 16].map(|bits| from_quantised(bits, 65_534.0)))
}

/// The longest outline vector, in widths of the outline: miters of sharper edges are cut.
const HULL_LONGEST: f32 = 4.0;

/// An outline vector in 12 + 12 bits of direction and 8 bits of length up to 4.
pub fn pack_hull(offset: Vec3) -> u32 {
    let length = offset.length().min(HULL_LONGEST);
    let [x, y] = octahedral(offset).map(|value| quantised(value, 4094.0));
    x | y << 12 | ((length / HULL_LONGEST * 255.0).round() as u32) << 24
}

/// The vector of [`pack_hull`].
pub fn unpack_hull(packed: u32) -> Vec3 {
    let direction = from_octahedral([packed & 0xfff, packed >> 12 & 0xfff].map(|bits| from_quantised(bits, 4094.0)));
    direction * (packed >> 24) as f32 / 255.0 * HULL_LONGEST
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Directions all over the sphere.
    fn directions() -> impl Iterator<Item = Vec3> {
        (0..5000).map(|i| {
            let z = 1.0 - (i as f32 + 0.5) / 2500.0;
            let (sine, cosine) = (i as f32 * 2.399_963_2).sin_cos();
            Vec3::new(cosine, sine, 0.0) * (1.0 - z * z).max(0.0).sqrt() + Vec3::Z * z
        })
    }

    #[test]
    fn packed_normals_keep_their_direction() {
        let worst = directions().map(|v| unpack_normal(pack_normal(v)).angle_between(v)).fold(0.0, f32::max);
        assert!(worst.to_degrees() < 0.03, "{worst}");
        for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
            assert_eq!(unpack_normal(pack_normal(axis)), axis);
        }
    }

    #[test]
    fn packed_outline_vectors_keep_direction_and_length() {
        for v in directions() {
            let long = v * 1.7;
            let back = unpack_hull(pack_hull(long));
            assert!(back.distance(long) < 0.012, "{long} {back}");
        }
        assert!((unpack_hull(pack_hull(Vec3::X * 9.0)) - Vec3::X * 4.0).length() < 1e-3);
    }
}
