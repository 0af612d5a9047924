//! Scenes of one file, and several put into one.

use std::path::{Path, PathBuf};

use glam::{Affine3A, DVec3, Vec3};

use super::import::Format;
use super::mesh::Assembly;
use super::molecule::{Molecule, MoleculeCopy, Sphere};
use super::report::Report;
use super::sphere::bounding_sphere;
use super::{Scene, SceneFile};

impl Scene {
    /// The scene of one file; `file` is its path.
    pub(super) fn of_file(
        file: &str,
        format: Format,
        molecule: Molecule,
        assembly: Assembly,
        report: Report,
        side_files: Vec<PathBuf>,
    ) -> Scene {
        let path = Path::new(file);
        let text = |part: Option<&std::ffi::OsStr>| part.map(|part| part.to_string_lossy().into_owned());
        let name = text(path.file_stem()).unwrap_or_default();
        let unit = if assembly.is_empty() { 1.0 } else { assembly.unit };
        let sphere = if assembly.is_empty() { molecule.bounding_sphere() } else { assembly.sphere };
        let files = vec![SceneFile { name: text(path.file_name()).unwrap_or_default(), format, report, side_files }];
        Scene { molecule, assembly, files, name, unit, sphere }
    }

    /// One scene of several, each where its file has it; none of no scene. A mesh so large or small that it has a unit of
    /// its own keeps it if it stands alone, and is else drawn at its true size.
    pub fn join(scenes: Vec<Scene>) -> Option<Scene> {
        let mut scenes = scenes.into_iter();
        let mut joined = scenes.next()?;
        for scene in scenes {
            joined.add(scene);
        }
        Some(joined)
    }

    /// Zero of the scene, in file units.
    pub fn origin(&self) -> DVec3 {
        if self.assembly.is_empty() { self.molecule.origin } else { self.assembly.origin }
    }

    fn add(&mut self, mut other: Scene) {
        // One unit and one origin for all: that of the larger sphere.
        let size = |scene: &Scene| f64::from(scene.sphere.radius) * scene.unit;
        let (unit, origin) =
            if size(&other) > size(self) { (other.unit, other.origin()) } else { (self.unit, self.origin()) };
        self.move_to(unit, origin);
        other.move_to(unit, origin);
        let (mine, theirs) = (self.sphere, other.sphere);
        self.sphere = bounding_sphere([mine, theirs].iter().map(|sphere| (sphere.center, sphere.radius)));
        let num_files = self.files.len() as u32;
        self.files.append(&mut other.files);
        append_molecule(&mut self.molecule, other.molecule, num_files);
        append_assembly(&mut self.assembly, other.assembly, num_files);
    }

    /// Measures everything in other units from another origin.
    fn move_to(&mut self, unit: f64, origin: DVec3) {
        let scale = (self.unit / unit) as f32;
        let shift = ((self.origin() - origin) / unit).as_vec3();
        if scale == 1.0 && shift == Vec3::ZERO {
            return;
        }
        let place = Affine3A::from_scale_rotation_translation(Vec3::splat(scale), glam::Quat::IDENTITY, shift);
        let back = place.inverse();
        let moved =
            |sphere: Sphere| Sphere { center: place.transform_point3(sphere.center), radius: sphere.radius * scale };
        for atom in &mut self.molecule.atoms {
            atom.position = place.transform_point3(atom.position);
        }
        for copy in &mut self.molecule.copies {
            copy.world_from_molecule = place * copy.world_from_molecule * back;
        }
        for part in &mut self.assembly.parts {
            part.world_from_shape = place * part.world_from_shape;
        }
        self.molecule.sphere = moved(self.molecule.sphere);
        self.assembly.sphere = moved(self.assembly.sphere);
        self.sphere = moved(self.sphere);
        (self.molecule.origin, self.assembly.origin) = (origin, origin);
        (self.unit, self.assembly.unit) = (unit, unit);
    }
}

fn append_molecule(to: &mut Molecule, mut from: Molecule, num_files: u32) {
    if from.atoms.is_empty() {
        return;
    }
    // Where one has copies, the other is drawn once.
    if !(to.copies.is_empty() && from.copies.is_empty()) {
        for molecule in [&mut *to, &mut from].into_iter().filter(|molecule| molecule.copies.is_empty()) {
            let all = 0..molecule.atoms.len() as u32;
            molecule.copies = vec![MoleculeCopy { atoms: vec![all], world_from_molecule: Affine3A::IDENTITY }];
        }
    }
    let (num_atoms, num_residues, num_chains) =
        (to.atoms.len() as u32, to.residues.len() as u32, to.chains.len() as u32);
    from.atoms.iter_mut().for_each(|atom| atom.residue += num_residues);
    from.residues.iter_mut().for_each(|residue| residue.chain += num_chains);
    from.chains.iter_mut().for_each(|chain| chain.file += num_files);
    from.bonds.iter_mut().for_each(|bond| (bond.a, bond.b) = (bond.a + num_atoms, bond.b + num_atoms));
    let shifted = from.copies.iter_mut().flat_map(|copy| &mut copy.atoms);
    shifted.for_each(|range| *range = range.start + num_atoms..range.end + num_atoms);
    to.atoms.append(&mut from.atoms);
    to.residues.append(&mut from.residues);
    to.chains.append(&mut from.chains);
    to.bonds.append(&mut from.bonds);
    to.copies.append(&mut from.copies);
    to.origin = from.origin;
    to.sphere = if num_atoms == 0 {
        from.sphere
    } else {
        bounding_sphere([to.sphere, from.sphere].iter().map(|sphere| (sphere.center, sphere.radius)))
    };
}

fn append_assembly(to: &mut Assembly, mut from: Assembly, num_files: u32) {
    if from.is_empty() {
        return;
    }
    let (num_shapes, num_materials, num_names) =
        (to.shapes.len() as u32, to.materials.len() as u32, to.names.len() as u32);
    for part in &mut from.parts {
        part.shape += num_shapes;
        part.material = part.material.map(|material| material + num_materials);
        (part.name, part.path) = (part.name + num_names, part.path + num_names);
        part.file += num_files;
    }
    let was_empty = to.is_empty();
    to.shapes.append(&mut from.shapes);
    to.parts.append(&mut from.parts);
    to.materials.append(&mut from.materials);
    to.names.append(&mut from.names);
    (to.origin, to.unit) = (from.origin, from.unit);
    to.sphere = if was_empty {
        from.sphere
    } else {
        bounding_sphere([to.sphere, from.sphere].iter().map(|sphere| (sphere.center, sphere.radius)))
    };
}
