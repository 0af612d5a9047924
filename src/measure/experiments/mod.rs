//! The experiments: one file each, and one line in [`EXPERIMENTS`].

mod curvature;
mod dof;
mod failures;
mod fig10;
mod geometry;
mod hidden;
mod looks;
mod orbit;
mod outlines;
mod shading;
mod shadows;
mod ssao;
mod toon_edges;
mod transparency;

use super::experiment::Experiment;

/// All of them, in the order in which they are run.
pub const EXPERIMENTS: &[&dyn Experiment] = &[
    &shading::Shading,
    &looks::Looks,
    &toon_edges::ToonEdges,
    &geometry::Geometry,
    &outlines::Outlines,
    &shadows::Shadows,
    &ssao::Ssao,
    &dof::Dof,
    &orbit::Orbit,
    &transparency::Transparency,
    &curvature::Curvature,
    &failures::Failures,
    &hidden::Hidden,
    &fig10::Fig10,
];

/// The experiment of this name.
pub fn find(name: &str) -> Option<&'static dyn Experiment> {
    EXPERIMENTS.iter().copied().find(|experiment| experiment.name() == name)
}
