//! Scenes, styles and sizes as the command line names them.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use super::{Failure, messages, print_message, tell};
use crate::config::{
    self, Catalog, Files, Hint, Loader, Mistakes, Place, Problem, Source, SourceTexts, Style, Unreadable,
};
use crate::engine;
use crate::scene::{LoadOptions, ModelChoice, Scene, SceneError, SceneFile};
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

/// One scene of all files that are named, with the time that loading it took.
pub(crate) struct Loaded {
    pub(crate) scene: Scene,
    pub(crate) ms: f64,
}

/// Where a scene or style comes from.
#[derive(Debug, Clone)]
pub(crate) enum Input {
    /// It is part of the program.
    Shipped(&'static Shipped),
    /// It is a file, whether it is there or not.
    File(PathBuf),
}

impl Input {
    /// The file, if it is one.
    pub(crate) fn file(&self) -> Option<&Path> {
        match self {
            Input::Shipped(_) => None,
            Input::File(path) => Some(path),
        }
    }
}

/// Finds what a name on the command line means: a file, or something shipped.
fn find(what: &str, name: &str, among: &[&'static [Shipped]]) -> Result<Input, Failure> {
    let path = Path::new(name);
    match among.iter().find_map(|shipped| shipped::find(shipped, name)) {
        Some(shipped) if !is_shadowed(path) => Ok(Input::Shipped(shipped)),
        None if looks_like_a_name(path) => Err(unknown(what, name, among)),
        _ => Ok(Input::File(path.to_owned())),
    }
}

/// What a scene's name means.
pub(crate) fn find_scene(name: &str) -> Result<Input, Failure> {
    find("molecule or mesh", name, &shipped::SCENES)
}

/// What a style's name means.
pub(crate) fn find_style(name: &str) -> Result<Input, Failure> {
    find("look", name, &[shipped::LOOKS])
}

/// Reads a scene.
pub(crate) fn read_scene(input: &Input, options: &LoadOptions) -> Result<Scene, SceneError> {
    match input {
        Input::Shipped(shipped) => Scene::from_bytes_with(shipped.file, shipped.bytes, options),
        Input::File(path) => Scene::load_with(path, options),
    }
}

/// Reads a style with its bases.
pub(crate) fn read_style(input: &Input) -> Result<Style, Mistakes> {
    let entries = engine::catalog();
    let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
    match input {
        Input::Shipped(look) => config::load_with(&Source::new(look.file, look.bytes), &catalog, &FilesAndLooks),
        Input::File(path) => config::load_file_with(path, &catalog, &FilesAndLooks),
    }
}

/// Why a file cannot be followed, if it cannot: a pipe gives its content once, and waits for it without end.
fn no_file_to_follow(input: &Input) -> Option<(&Path, &'static str)> {
    let path = input.file()?;
    let kind = path.metadata().ok()?.file_type();
    let is_followed = kind.is_file() || kind.is_dir();
    (!is_followed).then_some((path, "this is a pipe or a device: --watch follows files, so save it to one"))
}

/// Reads a style with its bases, again and again.
pub(crate) fn follow_style(input: &Input) -> Result<Style, Mistakes> {
    match no_file_to_follow(input) {
        Some((path, reason)) => {
            let place = Place::of_file(&path.display().to_string());
            Err(Mistakes::one(place, Problem::Unreadable(reason.to_owned())))
        }
        None => read_style(input),
    }
}

/// Reads scenes into one, again and again.
pub(crate) fn follow_scenes(inputs: &[Input], options: &LoadOptions) -> Result<Scene, SceneError> {
    let follow = |input: &Input| match no_file_to_follow(input) {
        Some((path, reason)) => {
            Err(SceneError::Unsupported { file: path.display().to_string(), what: reason.to_owned() })
        }
        None => read_scene(input, options),
    };
    let scenes: Vec<Scene> = inputs.iter().map(follow).collect::<Result<_, _>>()?;
    Ok(Scene::join(scenes).expect("the command line has at least one scene"))
}

/// Loads a file, or a shipped molecule or mesh by its name.
pub(crate) fn load_scene(name: &str, options: &LoadOptions) -> Result<Scene, Failure> {
    read_scene(&find_scene(name)?, options).map_err(Failure::input)
}

/// Loads all of them into one scene. What is wrong with any is said.
pub(crate) fn load_scenes(names: &[String], options: &LoadOptions) -> Result<Loaded, Failure> {
    let start = Instant::now();
    let (mut scenes, mut messages) = (Vec::new(), Vec::new());
    for name in names {
        match load_scene(name, options) {
            Ok(scene) => scenes.push(scene),
            Err(failure) => messages.push(failure.message),
        }
    }
    if !messages.is_empty() {
        return Err(Failure::input(messages.join("\n")));
    }
    let scene = Scene::join(scenes).expect("the command line has at least one scene");
    Ok(Loaded { scene, ms: start.elapsed().as_secs_f64() * 1e3 })
}

/// Loads a style file, or a shipped look by its name.
pub(crate) fn load_style(name: &str) -> Result<Style, Failure> {
    check_style(name).map_err(Failure::from)
}

/// The same, with its mistakes.
pub(crate) fn check_style(name: &str) -> Result<Style, Mistakes> {
    match find_style(name) {
        // A link that leads nowhere is there, and says more of itself.
        Ok(input) if input.file().is_none_or(|path| path.exists() || path.is_symlink()) => read_style(&input),
        // Of a file that is not there, the looks that are may be meant.
        _ => {
            let reason = unknown_reason("look", name, &[shipped::LOOKS]);
            Err(Mistakes::one(Place::of_file(name), Problem::Unreadable(reason)))
        }
    }
}

/// Finds the base of a style as a file beside it, or as a shipped look by its name, with `.json` or without.
pub(crate) struct FilesAndLooks;

impl Loader for FilesAndLooks {
    fn load(&self, name: &str, from: &Source) -> Result<Source, Unreadable> {
        let unreadable = match Files.load(name, from) {
            // A folder of the name does not count, as on the command line.
            Err(unreadable) if !unreadable.path.as_deref().is_some_and(is_shadowed) => unreadable,
            found => return found,
        };
        let look_name = name.strip_suffix(".json").unwrap_or(name);
        if let Some(look) = shipped::find(shipped::LOOKS, look_name) {
            return Ok(Source::new(format!("{look_name} (shipped)"), look.bytes));
        }
        if unreadable.path.as_deref().is_some_and(Path::is_dir) || look_name.contains(['/', '\\']) {
            return Err(unreadable);
        }
        let hint = Hint::new(look_name, shipped::LOOKS.iter().map(|look| look.name));
        Err(Unreadable {
            reason: format!("{}, and no shipped look of this name{hint}", unreadable.reason),
            ..unreadable
        })
    }
}

/// Prints what a style says that this version passes over, and what the scenes' files had mended.
pub(crate) fn print_warnings(style: &Style, scene: &Scene, scene_names: &[String]) {
    style_warnings(style).iter().for_each(|warning| print_message(warning));
    scene_warnings(scene, scene_names).into_iter().for_each(tell);
}

/// What a style asks for and does not get, clean, each with its source line where there is a file to mend.
pub(crate) fn style_warnings(style: &Style) -> Vec<String> {
    let texts = if style.files.is_empty() { &SourceTexts::default() } else { &style.texts };
    messages::of_warnings(&style.warnings, style.unlisted_warnings, texts)
}

/// What the files of a scene had mended, one line a kind; `names` are what the command line calls them.
pub(crate) fn scene_warnings(scene: &Scene, names: &[String]) -> Vec<String> {
    let of_file = |(file, name): (&SceneFile, &String)| {
        let report = file.report.to_string();
        report.lines().map(|line| format!("{name}: warning: {line}")).collect::<Vec<_>>()
    };
    scene.files.iter().zip(names).flat_map(of_file).collect()
}

/// A look, molecule or mesh that is not shipped, with those that are.
pub(crate) fn unknown(what: &str, name: &str, among: &[&'static [Shipped]]) -> Failure {
    // A name that would not show as it is, is quoted.
    let is_plain = !name.is_empty() && !name.contains(char::is_control);
    let shown = if is_plain { name.to_owned() } else { format!("{name:?}") };
    Failure::input(format!("{shown}: {}", unknown_reason(what, name, among)))
}

fn unknown_reason(what: &str, name: &str, among: &[&'static [Shipped]]) -> String {
    // The longest name of a file is longer than any that is worth comparing.
    let word = if name.len() > 64 { "" } else { name };
    let word = word.rsplit(['/', '\\']).next().unwrap_or(word).to_lowercase();
    let word = word.strip_suffix(".json").unwrap_or(&word);
    let names: Vec<&str> = among.iter().copied().flatten().map(|shipped| shipped.name).collect();
    let nearest = names
        .iter()
        .map(|name| (strsim::damerau_levenshtein(name, word), name))
        .min()
        .filter(|(distance, nearest)| *distance <= nearest.len() / 2);
    let hint = nearest.map_or(String::new(), |(_, nearest)| format!("did you mean {nearest:?}? "));
    format!("no such file, and no {what} of this name; {hint}shipped: {}", names.join(", "))
}

/// Refuses outputs that would overwrite an input or one another. Devices and pipes take more than one.
pub(crate) fn check_outputs(outputs: impl Iterator<Item = PathBuf>, inputs: &[(&str, &Path)]) -> Result<(), Failure> {
    let inputs: Vec<_> = inputs.iter().map(|(what, path)| (*what, place(path))).collect();
    let mut former: HashSet<PathBuf> = HashSet::new();
    for output in outputs {
        if output.exists() && !output.is_file() {
            continue;
        }
        let (shown, output) = (output.display().to_string(), place(&output));
        if let Some((what, _)) = inputs.iter().find(|(_, input)| *input == output) {
            return Err(Failure::usage(format!("{shown}: is the {what} itself; write to another file")));
        }
        if !former.insert(output) {
            return Err(Failure::usage(format!("{shown}: is named for two outputs; write each to its own file")));
        }
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
    !path.exists() && !path.is_symlink() && path.extension().is_none() && path.components().count() <= 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loads `own` as a file in a folder of its own, beside another style.
    fn load(test: &str, own: &str, beside: Option<(&str, &str)>) -> Result<Style, String> {
        let folder = std::env::temp_dir().join(format!("restyle_{test}_{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("own.json");
        std::fs::write(&path, own).unwrap();
        if let Some((name, text)) = beside {
            std::fs::write(folder.join(name), text).unwrap();
        }
        let style = load_style(path.to_str().unwrap()).map_err(|failure| failure.message);
        std::fs::remove_dir_all(&folder).unwrap();
        style
    }

    #[test]
    fn a_shipped_look_is_a_base_by_its_name() {
        let look = load_style("education").unwrap_or_else(|failure| panic!("{}", failure.message));
        for name in ["education", "education.json"] {
            let style = load("shipped_base", &format!("{{ \"extends\": \"{name}\" }}"), None).unwrap();
            assert_eq!((style.camera, style.mapping.len()), (look.camera.clone(), look.mapping.len()));
            // Only the style itself is a file that can change.
            assert_eq!(style.files.len(), 1);
        }
    }

    #[test]
    fn a_file_comes_before_a_shipped_look() {
        let beside = ("education.json", "{ \"camera\": { \"fov\": 21 } }");
        let style = load("file_first", "{ \"extends\": \"education.json\" }", Some(beside)).unwrap();
        assert_eq!((style.camera.fov, style.files.len()), (21.0, 2));
    }

    #[test]
    fn mistakes_over_a_shipped_look_name_it() {
        let own =
            "{ \"extends\": \"education\", \"shaders\": [{ \"name\": \"x\" }], \"mapping\": { \"atom\": \"nix\" } }";
        let said = load("over_shipped", own, None).unwrap_err();
        assert!(said.contains("no shader is called \"nix\"") && !said.contains("(shipped)"), "{said}");
    }

    #[test]
    fn a_slip_in_the_name_of_a_look_is_met_with_the_nearest() {
        let said = load("slip", "{ \"extends\": \"eduction.json\" }", None).unwrap_err();
        let due = "cannot extend \"eduction.json\": there is no such file, and no shipped look of this name; \
                   did you mean \"education\"? allowed: advertisement, education, scientific, future, illustrative, technical, glass, \
                   xray, ghost";
        assert!(said.lines().next().is_some_and(|line| line.ends_with(due)), "{said}");
        let said = load("slip", "{ \"extends\": \"looks/education.json\" }", None).unwrap_err();
        assert!(said.lines().next().is_some_and(|line| line.ends_with(": there is no such file")), "{said}");
    }
}
