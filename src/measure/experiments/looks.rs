//! `looks`: the time of a frame in every look, by number of atoms and at two sizes [Prost2016 §5.2, Fig. 7].

use std::fmt::Write as _;
use std::rc::Rc;

use serde_json::json;

use crate::engine::Request;
use crate::measure::experiment::{Case, ChartKind, Experiment, MeasureError, Setup};
use crate::measure::stage::{GpuFrame, Stage, device, look, scene, shipped_scene};
use crate::scene::Scene;
use crate::shipped::LOOKS;

/// Shipped molecules, from 3 atoms up.
const SHIPPED: [&str; 4] = ["water", "caffeine", "c60", "nanotube"];

/// Atoms of the lattices that go beyond them.
const LATTICES: [usize; 3] = [1_000, 5_000, 30_000];
const LATTICES_THOROUGH: [usize; 5] = [1_000, 5_000, 30_000, 100_000, 300_000];

/// Those of the published figure.
const SIZES: [[u32; 2]; 2] = [[1920, 1080], [1920, 1200]];

/// The experiment.
pub struct Looks;

/// Carbon on a cubic lattice, 1.54 angstrom apart (the length of its single bond), so that all neighbours are bonded.
fn lattice(num_atoms: usize) -> Result<Scene, MeasureError> {
    let side = (num_atoms as f64).cbrt().ceil() as usize;
    let mut text = format!("{num_atoms}\n\n");
    for index in 0..num_atoms {
        let [x, y, z] = [index % side, index / side % side, index / side / side].map(|at| at as f64 * 1.54);
        let _ = writeln!(text, "C {x:.2} {y:.2} {z:.2}");
    }
    scene("lattice.xyz", text.as_bytes())
}

impl Experiment for Looks {
    fn name(&self) -> &'static str {
        "looks"
    }

    fn doc(&self) -> &'static str {
        "How long a frame takes in every shipped look, by number of atoms, at 1920x1080 and 1920x1200."
    }

    fn chart(&self) -> ChartKind {
        ChartKind::TimeByExtent { extent: "atoms" }
    }

    fn conditions(&self, _: &Setup) -> Vec<String> {
        vec![
            "One sample a pixel; a frame is encoding, submission and the wait until the device is idle. Looks are drawn whole, \
             with those of their post effects that this version draws."
                .to_owned(),
            format!(
                "Molecules are {}, then cubic lattices of bonded carbon atoms; each fills the picture's height.",
                SHIPPED.join(", ")
            ),
        ]
    }

    fn cases(&self, setup: &Setup) -> Result<Vec<Case>, MeasureError> {
        let gpu = device(setup.gpu.as_ref())?;
        let mut scenes = Vec::new();
        for name in SHIPPED {
            scenes.push((name.to_owned(), shipped_scene(name)?));
        }
        let lattices: &[usize] = if setup.thorough { &LATTICES_THOROUGH } else { &LATTICES };
        for &num_atoms in lattices {
            scenes.push((format!("lattice of {num_atoms}"), lattice(num_atoms)?));
        }
        scenes.sort_by_key(|(_, scene)| scene.molecule.atoms.len());
        let sizes = setup.size.map_or(SIZES.to_vec(), |size| vec![size]);
        let mut cases = Vec::new();
        for (name, scene) in scenes {
            let num_atoms = scene.molecule.atoms.len();
            let stage = Stage::new(gpu, scene);
            for shipped in LOOKS {
                let (style_name, style) = (Rc::from(shipped.name), Rc::new(look(shipped)?));
                for &size in &sizes {
                    let settings = json!({ "look": shipped.name, "atoms": num_atoms, "size": size });
                    cases.push(Case {
                        scene: name.clone(),
                        method: "gpu".to_owned(),
                        settings: settings.as_object().cloned().unwrap_or_default(),
                        series: shipped.name.to_owned(),
                        point: format!("{}x{}", size[0], size[1]),
                        extent: num_atoms as f64,
                        is_published: false,
                        size,
                        subject: Box::new(GpuFrame {
                            stage: Rc::clone(&stage),
                            style_name: Rc::clone(&style_name),
                            style: Rc::clone(&style),
                            request: Request::new(size, 1),
                        }),
                        truth: None,
                    });
                }
            }
        }
        Ok(cases)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_is_bonded_to_its_neighbours() {
        let scene = lattice(64).unwrap_or_else(|error| panic!("{error}"));
        // 4 by 4 rows of 3 bonds, in three directions.
        assert_eq!((scene.molecule.atoms.len(), scene.molecule.bonds.len()), (64, 144));
    }
}
