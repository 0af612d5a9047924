//! A folder of files that a live engine follows.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use restyle::config::{self, Catalog, Source};
use restyle::engine::{self, Engine, Gpu, Part, Refusal, Reload, Sources};
use restyle::scene::{LoadOptions, Scene};

/// Longer than any reload takes on a machine that does much else.
pub const PATIENCE: Duration = Duration::from_secs(20);

/// How long nothing must happen to count as nothing: longer than what is wrong is held back.
pub const SILENCE: Duration = Duration::from_millis(600);

/// A folder with `s.json`, `m.xyz` and maybe a `m.side` that is read with it, and an engine that follows them.
pub struct Live {
    pub folder: PathBuf,
    pub engine: Engine,
    /// How often the scene was read.
    reads: Arc<AtomicUsize>,
}

pub fn load_style(path: &Path) -> Result<config::Style, config::Mistakes> {
    let entries = engine::catalog();
    let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
    config::load_file(path, &catalog)
}

impl Live {
    /// The folder of the test of this name with these files; nothing is loaded yet.
    pub fn new(name: &str, files: &[(&str, &str)]) -> Option<Live> {
        Some(Live::on(super::gpu::device()?, name, files))
    }

    /// The same on a device of its own, which no other test counts on.
    pub fn alone(name: &str, files: &[(&str, &str)]) -> Option<Live> {
        super::gpu::device()?;
        Some(Live::on(Arc::new(Gpu::open().unwrap()), name, files))
    }

    fn on(gpu: Arc<Gpu>, name: &str, files: &[(&str, &str)]) -> Live {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("live-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        for (file, text) in files {
            std::fs::write(folder.join(file), text).unwrap();
        }
        let reads = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&reads);
        let (style, scene) = (folder.join("s.json"), folder.join("m.xyz"));
        let sources = Sources {
            style_file: Some(style.clone()),
            style: Box::new(move || load_style(&style)),
            scene_files: vec![scene.clone()],
            scene: Box::new(move || {
                counted.fetch_add(1, Ordering::Relaxed);
                let mut loaded = Scene::load_with(&scene, &LoadOptions::default())?;
                // Stands for a file of materials that a mesh names.
                let beside = scene.with_extension("side");
                if let Ok(text) = std::fs::read_to_string(&beside) {
                    loaded.name = text;
                    loaded.files[0].side_files.push(beside);
                }
                Ok(loaded)
            }),
            shader_folder: Some(folder.join("shaders")),
        };
        Live { engine: Engine::live(gpu, sources), folder, reads }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// How often the scene was read until now.
    pub fn scene_reads(&self) -> usize {
        self.reads.load(Ordering::Relaxed)
    }

    /// Waits until something is taken, and draws it.
    #[track_caller]
    pub fn taken(&mut self) -> Part {
        match self.next() {
            Reload::Taken(part, _) => {
                self.draw();
                part
            }
            other => panic!("{other:?}"),
        }
    }

    /// Waits until something is refused, and answers why.
    #[track_caller]
    pub fn refused(&mut self) -> (Part, Refusal) {
        match self.next() {
            Reload::Refused(part, refusal) => (part, refusal),
            other => panic!("{other:?}"),
        }
    }

    #[track_caller]
    pub fn next(&mut self) -> Reload {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            let mut reloads = self.engine.wait(Duration::from_secs(1));
            if !reloads.is_empty() {
                assert_eq!(reloads.len(), 1, "{reloads:?}");
                return reloads.remove(0);
            }
        }
        panic!("nothing happened");
    }

    /// Nothing happens for a while.
    #[track_caller]
    pub fn silent(&mut self) {
        let reloads = self.engine.wait(SILENCE);
        assert!(reloads.is_empty(), "{reloads:?}");
    }

    pub fn draw(&mut self) {
        self.engine
            .draw(&super::gpu::request([32, 32], 1), false, &mut |_| std::ops::ControlFlow::Continue(()))
            .unwrap();
    }

    /// The colour that the picture's corner has.
    pub fn ground(&mut self) -> [u8; 3] {
        let image = self.engine.still(&super::gpu::request([8, 8], 1)).unwrap();
        let [r, g, b, _] = image.pixel(0, 0).map(|value| (value * 255.0).round() as u8);
        [r, g, b]
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

/// The smallest style of this background.
pub fn ground(color: [u8; 3]) -> String {
    format!("{{ \"camera\": {{ \"bgcolor\": [{}, {}, {}] }} }}", color[0], color[1], color[2])
}

/// A catalog for sources that are no files.
pub fn parses(text: &str) -> bool {
    let entries = engine::catalog();
    let catalog = Catalog { shaders: &entries, kinds: engine::DRAWN_KINDS };
    config::load(&Source::new("s.json", text), &catalog).is_ok()
}
