//! What a damaged file gives: a scene with so much in it, or a message.

use std::fmt::Debug;
use std::path::Path;

use restyle::scene::{NoteKind, Report, Scene};

/// What is expected of a file.
pub enum Outcome<T> {
    /// What is drawn, and the only kinds of notes.
    Loads(T, &'static [NoteKind]),
    /// The end of the message, after the file's path.
    Fails(&'static str),
}

impl<T: PartialEq + Debug> Outcome<T> {
    /// Holds a file to it: `drawn` counts what is drawn, and `is_ours` says of which notes the table speaks.
    pub fn check(&self, path: &Path, drawn: impl Fn(&Scene) -> T, is_ours: impl Fn(NoteKind) -> bool) {
        let file = path.display();
        match (Scene::load(path), self) {
            (Ok(scene), Outcome::Loads(expected, kinds)) => {
                let report = &scene.files[0].report;
                assert_eq!(drawn(&scene), *expected, "{file}: {report}");
                let is_noted = |kind: &NoteKind| report.count(*kind) > 0 && is_ours(*kind);
                let noted: Vec<NoteKind> = NoteKind::ALL.iter().copied().filter(is_noted).collect();
                let mut expected = kinds.to_vec();
                expected.sort_unstable();
                assert_eq!(noted, expected, "{file}: {report}");
                let sphere = scene.bounding_sphere();
                assert!(sphere.radius.is_finite() && sphere.center.is_finite(), "{file}");
                assert!(scene.assembly.parts.iter().all(|part| part.world_from_shape.is_finite()), "{file}");
            }
            (Err(error), Outcome::Fails(end)) => assert_eq!(error.to_string(), format!("{file}{end}")),
            (Ok(scene), Outcome::Fails(_)) => panic!("{file} gives {:?}", drawn(&scene)),
            (Err(error), Outcome::Loads(..)) => panic!("{error}"),
        }
    }
}

/// Triangles of a mesh, those included that are left out since they have no area or are there already.
pub fn num_triangles(scene: &Scene) -> u64 {
    scene.assembly.num_triangles() + num_dropped(&scene.files[0].report)
}

/// Triangles of a file that are left out since they have no area or are there already.
pub fn num_dropped(report: &Report) -> u64 {
    u64::from(report.count(NoteKind::FlatTriangle) + report.count(NoteKind::RepeatedTriangle))
}

/// Notes of mending, which depend on a mesh and not on its format.
pub const MENDED: &[NoteKind] = &[
    NoteKind::FlatTriangle,
    NoteKind::RepeatedTriangle,
    NoteKind::NearlyWelded,
    NoteKind::FaceTurned,
    NoteKind::InsideOut,
];
