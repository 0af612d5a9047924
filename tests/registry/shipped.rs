//! The looks, molecules and meshes that the program carries are the files of their folders, and all of them load.

use restyle::config::{self, Catalog, Source};
use restyle::engine;
use restyle::scene::Scene;
use restyle::shipped::{LOOKS, MESHES, MOLECULES, SCENES, Shipped};

use super::{assert_none, at, files_below};

/// The schema that the styles refer to.
const NO_STYLES: &[&str] = &[restyle::config::schema::FILE];

/// Files that write molecules or meshes instead of being one.
const MAKERS: &[&str] = &["make.py"];

fn assert_lists_the_files_of(folder: &str, shipped: &[Shipped], except: &[&str]) {
    let mut listed: Vec<String> = shipped.iter().map(|shipped| format!("{folder}/{}", shipped.file)).collect();
    listed.sort();
    let excepted: Vec<String> = except.iter().map(|file| format!("{folder}/{file}")).collect();
    let files: Vec<String> = files_below(folder, "").into_iter().filter(|file| !excepted.contains(file)).collect();
    assert_eq!(listed, files, "src/shipped.rs (left) does not list the files of {folder}/ (right)");
    for shipped in shipped {
        let file = format!("{folder}/{}", shipped.file);
        assert!(
            std::fs::read(at(&file)).is_ok_and(|bytes| bytes == shipped.bytes),
            "{file}: another content is built in"
        );
        assert_eq!(
            shipped.file.rsplit_once('.').map(|(stem, _)| stem),
            Some(shipped.name),
            "{file}: its name is its stem"
        );
    }
}

#[test]
fn looks_are_the_files_of_styles() {
    assert_lists_the_files_of("styles", LOOKS, NO_STYLES);
}

#[test]
fn molecules_are_the_files_of_their_folder() {
    assert_lists_the_files_of("molecules", MOLECULES, MAKERS);
}

#[test]
fn meshes_are_the_files_of_their_folder() {
    assert_lists_the_files_of("meshes", MESHES, MAKERS);
}

#[test]
fn every_look_loads_without_mistakes() {
    let shaders = engine::catalog();
    let catalog = Catalog { shaders: &shaders, kinds: engine::DRAWN_KINDS };
    let complaints = LOOKS.iter().filter_map(|look| {
        let mistakes = config::load(&Source::new(look.file, look.bytes), &catalog).err()?;
        Some(format!("styles/{mistakes}"))
    });
    assert_none(&complaints.collect::<Vec<_>>());
}

#[test]
fn every_scene_loads() {
    let complaints = SCENES.iter().copied().flatten().filter_map(|shipped| {
        let error = Scene::from_bytes(shipped.file, shipped.bytes).err()?;
        Some(error.to_string())
    });
    assert_none(&complaints.collect::<Vec<_>>());
}

#[test]
fn no_two_scenes_have_one_name() {
    let mut names: Vec<&str> = SCENES.iter().copied().flatten().map(|shipped| shipped.name).collect();
    names.sort_unstable();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
}
