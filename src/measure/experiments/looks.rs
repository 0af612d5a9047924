//! `looks`: the time of a frame in every look, by number of atoms and at two sizes [Prost2016 §5.2, Fig. 7].

use std::fmt::Write as _;

use serde_json::json;

use crate::engine::Request;
use crate::measure::experiment::{Case, ChartKind, Entry, Experiment, MeasureError, Setup, settings};
use crate::measure::page::short;
use crate::measure::run::Row;
use crate::measure::stage::{Look, Stage, device, scene, shipped_scene};
use crate::scene::Scene;
use crate::shipped::LOOKS;

/// Shipped molecules, from 3 atoms up.
const SHIPPED: [&str; 4] = ["water", "caffeine", "c60", "nanotube"];

/// Atoms of the lattices that go beyond them.
const LATTICES: [usize; 3] = [1_000, 5_000, 30_000];
const LATTICES_THOROUGH: [usize; 5] = [1_000, 5_000, 30_000, 100_000, 300_000];

/// Those of the published figure.
const SIZES: [[u32; 2]; 2] = [[1920, 1080], [1920, 1200]];

/// Scenes of fewer atoms cover too little of a picture to be compared.
const FEW_ATOMS: f64 = 50.0;

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

    fn says(&self, rows: &[Row]) -> String {
        let [few, many] = [f64::min, f64::max].map(|choose| {
            let atoms = rows.iter().map(|row| row.entry.extent).filter(|atoms| *atoms >= FEW_ATOMS);
            atoms.fold(f64::NAN, choose)
        });
        let size = rows.first().map(|row| row.entry.size);
        let at = |atoms: f64| rows.iter().filter(move |row| row.entry.extent == atoms && Some(row.entry.size) == size);
        let mut times: Vec<(f64, &str)> = at(few).map(|row| (row.median_ms(), &*row.entry.series)).collect();
        times.sort_by(|a, b| a.0.total_cmp(&b.0));
        let growth = |row: &Row| {
            let small = at(few).find(|small| small.entry.series == row.entry.series)?;
            Some((row.median_ms() / small.median_ms(), row.entry.series.clone()))
        };
        let mut growths: Vec<(f64, String)> = at(many).filter_map(growth).collect();
        growths.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (Some(quick), Some(slow)) = (times.first(), times.last()) else { return String::new() };
        let (Some(least), Some(most)) = (growths.first(), growths.last()) else { return String::new() };
        format!(
            "{few} atoms take from {} ms ({}) to {} ms ({}), which is mostly what the pixels cost. From there to {many} atoms \
             times grow by {} ({}) to {} ({}), for {} times the atoms.",
            short(quick.0),
            quick.1,
            short(slow.0),
            slow.1,
            short(least.0),
            least.1,
            short(most.0),
            most.1,
            short(many / few),
        )
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
                let look = Look::shipped(shipped)?;
                for &size in &sizes {
                    let settings = settings(json!({ "look": shipped.name, "atoms": num_atoms, "size": size }));
                    cases.push(Case {
                        entry: Entry {
                            scene: name.clone(),
                            method: "gpu".to_owned(),
                            settings,
                            series: shipped.name.to_owned(),
                            point: format!("{}x{}", size[0], size[1]),
                            extent: num_atoms as f64,
                            is_published: false,
                            size,
                        },
                        subject: Box::new(stage.frame(&look, Request::new(size, 1))),
                        truth: None,
                        judge: None,
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
