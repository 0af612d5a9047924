//! Folders to run the command in, and what it answered there.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Longer than any command here takes on a busy machine: whatever runs on hangs.
const PATIENCE: Duration = Duration::from_secs(300);

/// What the command did.
#[derive(Debug)]
pub struct Outcome {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Outcome {
    /// It did what it should.
    #[track_caller]
    pub fn done(self) -> Outcome {
        assert_eq!(self.code, Some(0), "{self:?}");
        self
    }

    /// It refused with this exit code and these words, in one message and without a panic.
    #[track_caller]
    pub fn refused(self, code: i32, words: &str) -> Outcome {
        assert!(!self.err.contains("panicked"), "{}", self.err);
        assert_eq!(self.code, Some(code), "{self:?}");
        assert!(self.err.contains(words), "{words:?} is not in {:?}", self.err);
        // The parser of the command line adds how to call it; all else is one message.
        if code != 2 {
            assert_eq!(self.messages().len(), 1, "{}", self.err);
        }
        self
    }

    /// The messages on stderr, without the source lines below them, which are checked: a line of the file with its
    /// number, and a marker that lies under it.
    #[track_caller]
    pub fn messages(&self) -> Vec<&str> {
        let mut messages = Vec::new();
        let mut lines = self.err.lines();
        while let Some(line) = lines.next() {
            let Some((number, source)) = source_line(line) else {
                messages.push(line);
                continue;
            };
            assert!(!messages.is_empty() && !number.is_empty(), "a source line of no message: {}", self.err);
            assert!(!source.contains(|c: char| c.is_control()), "{source:?}");
            assert!(source.chars().count() <= 110, "a long line is not cut: {}", self.err);
            let marker = lines.next().and_then(source_line).expect("a marker is below the source line");
            assert!(marker.0.is_empty() && marker.1.trim_start().chars().all(|c| c == '^'), "{}", self.err);
            assert!(!marker.1.trim().is_empty(), "{}", self.err);
        }
        messages
    }
}

/// Number and text of a source line, or of the line with its marker.
fn source_line(line: &str) -> Option<(&str, &str)> {
    let (number, text) = line.split_once('|')?;
    number.trim().chars().all(|c| c.is_ascii_digit()).then_some((number.trim(), text))
}

/// An empty folder that goes when it is dropped.
pub struct Folder(PathBuf);

impl Folder {
    /// The folder of the test of this name.
    pub fn new(name: &str) -> Folder {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// The same for a test that draws; none where that is impossible and allowed to be.
    pub fn with_adapter(name: &str) -> Option<Folder> {
        has_adapter().then(|| Folder::new(name))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Folder {
        std::fs::write(self.path(name), content).unwrap();
        self
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Names of all files, sorted.
    pub fn names(&self) -> Vec<String> {
        let names = std::fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> =
            names.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Runs the command in here; the arguments are parted by spaces.
    pub fn run(&self, args: &str) -> Outcome {
        self.start(args.split_whitespace(), &[], Stdio::null(), None)
    }

    /// The same with an argument that may hold anything.
    pub fn run_all(&self, args: &[&str]) -> Outcome {
        self.start(args.iter().copied(), &[], Stdio::null(), None)
    }

    /// Draws a small picture of a scene: `args` name scene, style and more.
    pub fn draw(&self, args: &str) -> Outcome {
        self.run(&format!("render {args} -o out.png --size 24x24 --samples 1"))
    }

    /// Runs the command with environment variables, an input and an output of its own.
    pub fn start<'a>(
        &self,
        args: impl Iterator<Item = &'a str>,
        env: &[(&str, &str)],
        stdin: Stdio,
        stdout: Option<Stdio>,
    ) -> Outcome {
        static NUMBER: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let beside = |what: &str| self.0.with_extension(format!("{number}.{what}"));
        let [out, err] = [beside("out"), beside("err")];
        let mut child = Command::new(env!("CARGO_BIN_EXE_restyle"))
            .args(args)
            .current_dir(&self.0)
            .envs(env.iter().copied())
            .stdin(stdin)
            .stdout(stdout.unwrap_or_else(|| File::create(&out).unwrap().into()))
            .stderr(File::create(&err).unwrap())
            .spawn()
            .unwrap();
        let start = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait().unwrap() {
                break status;
            }
            if start.elapsed() > PATIENCE {
                child.kill().unwrap();
                panic!("the command hangs");
            }
            std::thread::sleep(Duration::from_millis(10));
        };
        let take = |path: &Path| {
            let text = std::fs::read(path).unwrap_or_default();
            let _ = std::fs::remove_file(path);
            String::from_utf8_lossy(&text).into_owned()
        };
        // Drivers have words of their own where the session has no folder for its sockets.
        let err = take(&err).lines().filter(|line| !line.contains("XDG_RUNTIME_DIR")).collect::<Vec<_>>().join("\n");
        let outcome = Outcome { code: status.code(), out: take(&out), err };
        assert!(!self.names().iter().any(|name| name.ends_with(".part")), "a part stays: {outcome:?}");
        outcome
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Whether anything can be drawn here. Where nothing can, says once how many tests that skips, or fails if
/// `RESTYLE_GPU=required`.
fn has_adapter() -> bool {
    static ANSWER: OnceLock<bool> = OnceLock::new();
    let found = *ANSWER.get_or_init(|| {
        let probe = Folder::new("adapter").run("render water --json --size 4x4 --samples 1");
        let found = probe.code != Some(3);
        if !found {
            let sources = [
                include_str!("pictures.rs"),
                include_str!("extremes.rs"),
                include_str!("bad_outputs.rs"),
                include_str!("watch.rs"),
                include_str!("schema.rs"),
            ];
            let count: usize = sources.map(|source| source.matches("Folder::with_adapter").count()).iter().sum();
            // Written past the capture of passing tests, so that nobody takes them for run.
            let _ = std::io::Write::write_all(
                &mut std::io::stderr(),
                format!("{count} tests skipped: {}\n", probe.err).as_bytes(),
            );
        }
        found
    });
    let required = std::env::var("RESTYLE_GPU").is_ok_and(|value| value == "required");
    assert!(found || !required, "RESTYLE_GPU=required, but no graphics adapter answers");
    found
}

/// A picture read back from a PNG file.
pub struct Picture {
    pub info: (u32, u32, png::ColorType, png::BitDepth),
    pub srgb: bool,
    /// Channel values, 16 bits in two bytes.
    pub bytes: Vec<u8>,
    pub channels: usize,
}

impl Picture {
    pub fn read(folder: &Folder, name: &str) -> Picture {
        let decoder = png::Decoder::new(std::io::Cursor::new(folder.read(name)));
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut bytes).unwrap();
        bytes.truncate(frame.buffer_size());
        let srgb = reader.info().srgb.is_some();
        let info = (frame.width, frame.height, frame.color_type, frame.bit_depth);
        Picture { info, srgb, bytes, channels: frame.color_type.samples() }
    }

    /// How many different pixels there are.
    pub fn num_colors(&self) -> usize {
        let wide = if self.info.3 == png::BitDepth::Sixteen { 2 } else { 1 };
        self.bytes.chunks_exact(self.channels * wide).collect::<std::collections::HashSet<_>>().len()
    }
}
