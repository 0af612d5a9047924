//! Hot reload: what files hold, followed while they change. All or nothing: a change is read, checked, resolved and built
//! aside, then put into force; what is wrong is told once and changes nothing.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::pending::Pending;
use super::watch::Watch;
use super::{Content, Engine};
use crate::config::{Mistakes, Style};
use crate::gpu::{GpuError, ShaderEdits};
use crate::scene::{Scene, SceneError};

/// Where a live engine finds its style and its scene, again after each change.
pub struct Sources {
    /// Loads the style. Which files that takes, it says itself.
    pub style: Box<dyn Fn() -> Result<Style, Mistakes> + Send>,
    /// The style's own file, if it is one: watched even before it can be read.
    pub style_file: Option<PathBuf>,
    /// Loads the scene. Which files beside its own that takes, it says itself.
    pub scene: Box<dyn Fn() -> Result<Scene, SceneError> + Send>,
    /// The scene's own files: watched even before they can be read.
    pub scene_files: Vec<PathBuf>,
    /// Shaders that stand in for those of the program, such as [`source_tree_shaders`].
    pub shader_folder: Option<PathBuf>,
}

/// What files hold that can change by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// WGSL files of a source tree.
    Shaders,
    /// The files of the scene.
    Scene,
    /// The style with its bases.
    Style,
}

/// Why a change was not put into force.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// The style has mistakes.
    #[error("{0}")]
    Style(Mistakes),
    /// The scene does not load.
    #[error("{0}")]
    Scene(SceneError),
    /// The device cannot draw it, or a shader does not compile.
    #[error("{0}")]
    Device(GpuError),
}

/// What came of a change.
#[derive(Debug)]
pub enum Reload {
    /// It is in force: the next frame shows it.
    Taken(Part, ReloadTimes),
    /// It is wrong; what was in force stays. Told once until it changes.
    Refused(Part, Refusal),
    /// What was wrong is again what is in force.
    Mended(Part),
}

/// When a change went through its stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReloadTimes {
    /// The first event came.
    pub noticed: Instant,
    /// The files counted as whole, and reading began.
    pub started: Instant,
    /// Read, parsed and checked.
    pub loaded: Instant,
    /// Resolved for the scene.
    pub resolved: Instant,
    /// Pipelines built, and what differs written to the device.
    pub uploaded: Instant,
}

/// A part with what is known of its changes.
struct Followed {
    part: Part,
    pending: Pending,
    /// What was told to be wrong last.
    told: Option<String>,
}

/// The files of a live engine.
pub(super) struct Live {
    sources: Sources,
    watch: Watch<Part>,
    parts: [Followed; 3],
    /// What has loaded before the other one did.
    style: Option<Arc<Style>>,
    scene: Option<Arc<Scene>>,
    has_loaded: bool,
}

impl Live {
    pub(super) fn new(sources: Sources) -> Live {
        let parts = [Part::Shaders, Part::Scene, Part::Style];
        let mut live = Live {
            watch: Watch::new(),
            parts: parts.map(|part| Followed { part, pending: Pending::default(), told: None }),
            style: None,
            scene: None,
            has_loaded: false,
            sources,
        };
        // Watched before anything is read, so that no change falls between.
        live.watch.set(Part::Scene, live.sources.scene_files.clone());
        live.watch.set(Part::Style, live.sources.style_file.clone());
        if let Some(folder) = &live.sources.shader_folder {
            live.watch.set(Part::Shaders, shader_files(folder));
        }
        live
    }

    /// Hears what happened, waiting for it at most so long.
    fn listen(&mut self, patience: Duration) {
        for (part, touch, at) in self.watch.changes(patience) {
            if let Some(followed) = self.parts.iter_mut().find(|followed| followed.part == part) {
                followed.pending.touch(touch, at);
            }
        }
    }

    fn next_due(&self) -> Option<Instant> {
        self.parts.iter().filter_map(|followed| followed.pending.due_at()).min()
    }
}

impl Engine {
    /// Takes what changed in the files since the last call, without waiting. The first call loads everything.
    ///
    /// Empty for an engine that was given its content.
    pub fn poll(&mut self) -> Vec<Reload> {
        let Some(mut live) = self.live.take() else { return Vec::new() };
        let mut reloads = Vec::new();
        if !live.has_loaded {
            live.has_loaded = true;
            for index in 0..live.parts.len() {
                self.reload(&mut live, index, true, &mut reloads);
            }
        }
        live.listen(Duration::ZERO);
        for index in 0..live.parts.len() {
            let now = Instant::now();
            if live.parts[index].pending.due_at().is_some_and(|due| due <= now) {
                let tell = live.parts[index].pending.is_recheck(now);
                self.reload(&mut live, index, tell, &mut reloads);
            }
        }
        self.live = Some(live);
        reloads
    }

    /// The same, but waits at most `patience` until there is something to take.
    pub fn wait(&mut self, patience: Duration) -> Vec<Reload> {
        let end = Instant::now() + patience;
        loop {
            let reloads = self.poll();
            let now = Instant::now();
            let Some(live) = &mut self.live else { return reloads };
            if !reloads.is_empty() || now >= end {
                return reloads;
            }
            let until = live.next_due().unwrap_or(end).min(end);
            live.listen(until.saturating_duration_since(now));
        }
    }

    /// Reads one part. What is wrong is told where `tell`, else looked at again after a while.
    fn reload(&mut self, live: &mut Live, index: usize, tell: bool, reloads: &mut Vec<Reload>) {
        let part = live.parts[index].part;
        let started = Instant::now();
        let noticed = live.parts[index].pending.noticed().unwrap_or(started);
        live.parts[index].pending.read();
        live.watch.will_read(part);
        let taken = match part {
            Part::Style => self.reload_style(live),
            Part::Scene => self.reload_scene(live),
            Part::Shaders => self.reload_shaders(live),
        };
        let followed = &mut live.parts[index];
        match taken {
            Ok(stages) => {
                followed.pending.resolved();
                let was_wrong = followed.told.take().is_some();
                if let Some((loaded, resolved)) = stages {
                    let times = ReloadTimes { noticed, started, loaded, resolved, uploaded: Instant::now() };
                    reloads.push(Reload::Taken(part, times));
                } else if was_wrong {
                    reloads.push(Reload::Mended(part));
                }
            }
            Err(refusal) => {
                let message = refusal.to_string();
                if followed.told.as_ref() == Some(&message) {
                    followed.pending.resolved();
                } else if tell {
                    followed.pending.resolved();
                    followed.told = Some(message);
                    reloads.push(Reload::Refused(part, refusal));
                } else {
                    followed.pending.wrong(Instant::now());
                }
            }
        }
    }

    /// When it was loaded and resolved; none where nothing is different.
    fn reload_style(&mut self, live: &mut Live) -> Result<Option<(Instant, Instant)>, Refusal> {
        let loaded = (live.sources.style)();
        let own = live.sources.style_file.clone();
        let files = match &loaded {
            Ok(style) => style.files.clone(),
            Err(mistakes) => mistakes.files.clone(),
        };
        live.watch.set(Part::Style, own.into_iter().chain(files));
        let style = loaded.map_err(Refusal::Style)?;
        let loaded_at = Instant::now();
        if self.style().or(live.style.as_deref()) == Some(&style) {
            return Ok(None);
        }
        let style = Arc::new(style);
        let scene = self.content.as_ref().map(|content| Arc::clone(&content.scene)).or(live.scene.clone());
        let Some(scene) = scene else {
            live.style = Some(style);
            return Ok(None);
        };
        let resolved_at = self.replace(Content::new(scene, style), false).map_err(Refusal::Device)?;
        live.scene = None;
        Ok(Some((loaded_at, resolved_at)))
    }

    fn reload_scene(&mut self, live: &mut Live) -> Result<Option<(Instant, Instant)>, Refusal> {
        let scene = (live.sources.scene)().map_err(Refusal::Scene)?;
        // What a scene that does not load names is not known: what the former one named is watched until then.
        let beside = scene.files.iter().flat_map(|file| file.side_files.iter().cloned());
        live.watch.set(Part::Scene, live.sources.scene_files.iter().cloned().chain(beside));
        let loaded_at = Instant::now();
        if self.scene().or(live.scene.as_deref()) == Some(&scene) {
            return Ok(None);
        }
        let scene = Arc::new(scene);
        let style = self.content.as_ref().map(|content| Arc::clone(&content.style)).or(live.style.clone());
        let Some(style) = style else {
            live.scene = Some(scene);
            return Ok(None);
        };
        let resolved_at = self.replace(Content::new(scene, style), true).map_err(Refusal::Device)?;
        live.style = None;
        Ok(Some((loaded_at, resolved_at)))
    }

    fn reload_shaders(&mut self, live: &mut Live) -> Result<Option<(Instant, Instant)>, Refusal> {
        let Some(folder) = &live.sources.shader_folder else { return Ok(None) };
        let former = self.gpu.shader_edits();
        // A file that is away is mostly half of a save: its text stays, and its return is waited for.
        let mut edits = ShaderEdits::clone(&former);
        edits.extend(shader_files(folder).iter().filter_map(|file| text_of(folder, file)));
        live.watch.set(Part::Shaders, edits.keys().map(|path| folder.join(path)));
        // Before the first frame no pipeline is there that could be built anew.
        if *former == edits || former.is_empty() {
            self.gpu.set_shader_edits(Arc::new(edits));
            return Ok(None);
        }
        let loaded_at = Instant::now();
        self.gpu.set_shader_edits(Arc::new(edits));
        if let Err(error) = self.renderer.rebuild_pipelines() {
            self.gpu.set_shader_edits(former);
            return Err(Refusal::Device(error));
        }
        Ok(Some((loaded_at, Instant::now())))
    }
}

/// The shaders of the source tree that this program was built in, where it still runs in it.
pub fn source_tree_shaders() -> Option<PathBuf> {
    let tree = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = std::env::current_exe().ok()?.canonicalize().ok()?;
    let folder = tree.join("shaders");
    (program.starts_with(tree.canonicalize().ok()?) && folder.is_dir()).then_some(folder)
}

/// All WGSL files below a folder and one level deeper.
fn shader_files(folder: &Path) -> Vec<PathBuf> {
    let entries = |folder: &Path| -> Vec<PathBuf> {
        std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
    };
    let mut files: Vec<PathBuf> = entries(folder).iter().flat_map(|below| entries(below)).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "wgsl"));
    files.sort();
    files
}

/// Path below the folder and text of a file.
fn text_of(folder: &Path, file: &Path) -> Option<(String, String)> {
    let path = file.strip_prefix(folder).ok()?.to_str()?.replace('\\', "/");
    Some((path, std::fs::read_to_string(file).ok()?))
}
