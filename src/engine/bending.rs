//! How much the objects of a scene bend, all in all.

use std::f64::consts::PI;
use std::ops::AddAssign;

use crate::frame::objects::DrawList;
use crate::scene::mesh::curvature::triangle_kappa;

/// Curvature, over one of the scene's sphere, from which on a surface is curved at all.
const LEAST: f64 = 0.01;
/// Share of what is curved that bends less than what is read as [`READ_AS`].
const SHARE: f64 = 0.9;
/// See [`SHARE`].
const READ_AS: f64 = 0.9;
/// Bins of the histogram for each doubling of the curvature, and doublings above [`LEAST`].
const BINS_PER_OCTAVE: f64 = 64.0;
const OCTAVES: usize = 40;

/// Area by the logarithm of its curvature.
struct Histogram(Vec<f64>);

impl Histogram {
    fn new() -> Histogram {
        Histogram(vec![0.0; OCTAVES * BINS_PER_OCTAVE as usize])
    }

    /// Adds an area of this curvature, over one of the scene's sphere.
    fn add(&mut self, curvature: f64, area: f64) {
        let bin = ((curvature / LEAST).log2() * BINS_PER_OCTAVE).floor();
        if bin >= 0.0 && area.is_finite() {
            let last = self.0.len() - 1;
            self.0[(bin as usize).min(last)].add_assign(area);
        }
    }

    /// The curvature below which [`SHARE`] of all area lies.
    fn percentile(&self) -> Option<f64> {
        let all: f64 = self.0.iter().sum();
        let mut below = 0.0;
        let bin = self.0.iter().position(|area| {
            below += area;
            below >= SHARE * all
        });
        bin.filter(|_| all > 0.0).map(|bin| LEAST * ((bin as f64 + 0.5) / BINS_PER_OCTAVE).exp2())
    }
}

/// The factor on curvature, over one of the scene's sphere of this radius, by which tanh takes the 90th percentile of what is
/// curved to 0.9; 1 where nothing is. Creases are no curvature.
pub fn default_gain(list: &DrawList, radius: f64) -> f32 {
    let mut histogram = Histogram::new();
    for atom in &list.atoms {
        let r = f64::from(atom.radius);
        histogram.add(2.0 / r * radius, 4.0 * PI * r * r);
    }
    for connector in &list.connectors {
        let r = f64::from(connector.radius);
        let [a, b] = [connector.a_world, connector.b_world].map(glam::Vec3::from);
        histogram.add(radius / r, 2.0 * PI * r * f64::from(a.distance(b)));
    }
    if let Some(scene) = &list.meshes {
        let assembly = &scene.assembly;
        let mut scales: Vec<Vec<f64>> = vec![Vec::new(); assembly.shapes.len()];
        for (part, _) in assembly.parts.iter().zip(&list.parts).filter(|(_, drawn)| drawn.is_some()) {
            scales[part.shape as usize].push(f64::from(part.world_from_shape.matrix3.determinant().abs().cbrt()));
        }
        for (shape, scales) in assembly.shapes.iter().zip(&scales).filter(|(_, scales)| !scales.is_empty()) {
            // Of places of one size one stands for all.
            let mut sizes: Vec<(f64, f64)> = Vec::new();
            for scale in scales {
                match sizes.iter_mut().find(|(size, _)| (size - scale).abs() <= 1e-3 * scale) {
                    Some((_, count)) => *count += 1.0,
                    None => sizes.push((*scale, 1.0)),
                }
            }
            for (kappa, doubled_area) in shape.triangles.iter().filter_map(|triangle| triangle_kappa(shape, triangle)) {
                for (size, count) in &sizes {
                    histogram.add(kappa.abs() / size * radius, 0.5 * count * doubled_area * size * size);
                }
            }
        }
    }
    histogram.percentile().map_or(1.0, |curvature| (READ_AS.atanh() / curvature) as f32)
}
