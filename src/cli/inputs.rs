//! Scenes, styles and sizes as the command line names them.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::{Failure, messages, print_message, tell};
use crate::config::{self, Catalog, Mistakes, Place, Problem, Source, Style};
use crate::engine;
use crate::scene::{LoadOptions, ModelChoice, Scene};
use crate::shipped::{self, Shipped};

/// A picture size written as `WxH`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Size(pub [u32; 2]);

impl std::str::FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Size, String> {
        let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        match parsed {
            Some([0, _] | [_, 0]) => Err("a picture is at least 1x1".to_owned()),
            Some(size) => Ok(Size(size)),
            None => Err("a size is two whole numbers, such as 1920x1080".to_owned()),
        }
    }
}

/// Which models of a molecule file: `all` or a number.
pub(crate) fn parse_model(text: &str) -> Result<ModelChoice, String> {
    match text {
        "all" => Ok(ModelChoice::All),
        number => number.parse().map(ModelChoice::Number).map_err(|_| "a model is its number, or all".to_owned()),
    }
}

/// A scene with the time that loading it took.
pub(crate) struct Loaded {
    pub(crate) scene: Scene,
    pub(crate) ms: f64,
}

/// Loads a file, or a shipped molecule by its name.
pub(crate) fn load_scene(name: &str, options: LoadOptions) -> Result<Loaded, Failure> {
    let start = Instant::now();
    let path = Path::new(name);
    let scene = match shipped::find(shipped::MOLECULES, name) {
        Some(molecule) if !is_shadowed(path) => Scene::from_bytes_with(molecule.file, molecule.bytes, &options),
        None if looks_like_a_name(path) => return Err(unknown("molecule", name, shipped::MOLECULES)),
        _ => Scene::load_with(path, &options),
    };
    let scene = scene.map_err(Failure::input)?;
    Ok(Loaded { scene, ms: start.elapsed().as_secs_f64() * 1e3 })
}

/// Loads a style file, or a shipped look by its name.
pub(crate) fn load_style(name: &str) -> Result<Style, Failure> {
    read_style(name).map_err(Failure::from)
}

/// The same, with its mistakes.
pub(crate) fn read_style(name: &str) -> Result<Style, Mistakes> {
    let entries = engine::catalog();
    let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
    let path = Path::new(name);
    match shipped::find(shipped::LOOKS, name) {
        Some(look) if !is_shadowed(path) => config::load(&Source::new(look.file, look.bytes), &catalog),
        None if !path.exists() => {
            let reason = unknown_reason("look", name, shipped::LOOKS);
            Err(Mistakes::one(Place::of_file(name), Problem::Unreadable(reason)))
        }
        _ => config::load_file(path, &catalog),
    }
}

/// Prints what a style says that this version passes over, and what a scene's file had mended.
pub(crate) fn print_warnings(style: &Style, scene: &Scene, scene_name: &str) {
    style_warnings(style).iter().for_each(|warning| print_message(warning));
    scene_warnings(scene, scene_name).into_iter().for_each(tell);
}

/// What a style asks for and does not get, each with its source line, clean.
pub(crate) fn style_warnings(style: &Style) -> Vec<String> {
    messages::of_warnings(&style.warnings, style.unlisted_warnings, &style.texts)
}

/// What a scene's file had mended, one line a kind.
pub(crate) fn scene_warnings(scene: &Scene, scene_name: &str) -> Vec<String> {
    scene.report.to_string().lines().map(|line| format!("{scene_name}: warning: {line}")).collect()
}

/// A look or molecule that is not shipped, with those that are.
pub(crate) fn unknown(what: &str, name: &str, among: &'static [Shipped]) -> Failure {
    Failure::input(format!("{name:?}: {}", unknown_reason(what, name, among)))
}

fn unknown_reason(what: &str, name: &str, among: &'static [Shipped]) -> String {
    let nearest = among
        .iter()
        .map(|shipped| (strsim::damerau_levenshtein(shipped.name, name), shipped.name))
        .min()
        .filter(|(distance, nearest)| *distance <= nearest.len() / 2);
    let hint = nearest.map_or(String::new(), |(_, nearest)| format!("did you mean {nearest:?}? "));
    let names: Vec<&str> = among.iter().map(|shipped| shipped.name).collect();
    format!("no such file, and no {what} of this name; {hint}shipped: {}", names.join(", "))
}

/// Refuses outputs that would overwrite an input or one another. Devices and pipes take more than one.
pub(crate) fn check_outputs<'a>(
    outputs: impl Iterator<Item = &'a Path>,
    inputs: &[(&str, &Path)],
) -> Result<(), Failure> {
    let inputs: Vec<_> = inputs.iter().map(|(what, path)| (*what, place(path))).collect();
    let mut former: Vec<PathBuf> = Vec::new();
    for output in outputs {
        if output.exists() && !output.is_file() {
            continue;
        }
        let (shown, output) = (output.display(), place(output));
        if let Some((what, _)) = inputs.iter().find(|(_, input)| *input == output) {
            return Err(Failure::usage(format!("{shown}: is the {what} itself; write to another file")));
        }
        if former.contains(&output) {
            return Err(Failure::usage(format!("{shown}: is named for two outputs; write each to its own file")));
        }
        former.push(output);
    }
    Ok(())
}

/// One path for all the ways to write it; a file that is not there yet is found by its folder.
fn place(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        path.file_name().map_or_else(|| folder.clone(), |name| folder.join(name))
    })
}

/// Whether a file of the name of a shipped one lies here; a folder does not count.
fn is_shadowed(path: &Path) -> bool {
    path.exists() && !path.is_dir()
}

fn looks_like_a_name(path: &Path) -> bool {
    !path.exists() && path.extension().is_none() && path.components().count() <= 1
}
