//! `restyle render SCENE... -s STYLE -o OUT.png`: one still, its AOVs, its timings.

use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::inputs::{self, Size};
use super::{Failure, answer, exact, inputs::Loaded, tell};
use crate::config::Style;
use crate::engine::{Engine, Gpu, GpuError, MAX_SAMPLES, Request, TileError};
use crate::scene::{AovName, LoadOptions, ModelChoice, RowsHeader, Scene, write_png_rows};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A file of molecules or meshes, or the name of a shipped one; several are drawn at once, each where its file has it
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<String>,
    /// A style file or the name of a shipped look
    #[arg(short, long, default_value = "education")]
    style: String,
    /// The picture to write
    #[arg(short, long, value_name = "OUT.png")]
    output: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1000x1000")]
    size: Size,
    /// Samples a pixel: 16 by default, 64 by the reference renderer
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    samples: Option<u32>,
    /// What draws: the adapter, or exact ray casts on all cores; auto takes the adapter where there is one
    #[arg(long, value_enum, default_value_t = Renderer::Auto)]
    renderer: Renderer,
    /// Leave the background transparent (straight alpha)
    #[arg(long)]
    transparent: bool,
    /// Bits a channel of the PNG
    #[arg(long, default_value = "8", value_parser = ["8", "16"])]
    bits: String,
    /// Which model of the file: its number, or all; the first by default
    #[arg(long, value_parser = inputs::parse_model)]
    model: Option<ModelChoice>,
    /// Which biological assembly of the file, by its id; the coordinates as they were deposited by default
    #[arg(long, value_name = "ID")]
    assembly: Option<String>,
    /// Also time this many warm frames
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=10_000))]
    frames: u32,
    /// Write a linear float picture: depth, normal, id or color (repeatable)
    #[arg(long, value_name = "NAME=FILE.exr", value_parser = parse_aov)]
    aov: Vec<(AovName, PathBuf)>,
    /// Print one line of JSON: adapter, times, counts, bytes
    #[arg(long)]
    json: bool,
    /// Draw again after each save of the style, its bases or the scene, until interrupted
    #[arg(long, conflicts_with = "frames")]
    watch: bool,
    /// Write this many pictures of one full turn, numbered: OUT_0001.png and so on
    #[arg(long, value_name = "N", conflicts_with_all = ["watch", "aov", "frames"], requires = "output",
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    turntable: Option<u32>,
}

/// What draws a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Renderer {
    /// The adapter, or the reference renderer where there is none
    Auto,
    /// The adapter
    Gpu,
    /// The reference renderer
    Reference,
}

/// Samples of a still on an adapter.
const GPU_SAMPLES: u32 = 16;

impl Args {
    /// The files or names of the scenes.
    pub(super) fn scenes(&self) -> &[String] {
        &self.scenes
    }

    /// Samples a pixel, `default` where the command line says nothing.
    pub(super) fn samples(&self, default: u32) -> u32 {
        self.samples.unwrap_or(default)
    }

    /// How many warm frames to time.
    pub(super) fn frames(&self) -> u32 {
        self.frames
    }

    /// How many pictures of a turn.
    pub(super) fn turntable(&self) -> Option<u32> {
        self.turntable
    }

    /// Whether it goes on after each save.
    pub(super) fn is_watched(&self) -> bool {
        self.watch
    }

    /// Whether AOVs are asked for.
    pub(super) fn has_aovs(&self) -> bool {
        !self.aov.is_empty()
    }

    /// Width and height of the picture.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size.0
    }

    /// The style's file or name.
    pub(super) fn style(&self) -> &str {
        &self.style
    }

    /// Whether each picture is told as JSON.
    pub(super) fn json(&self) -> bool {
        self.json
    }

    /// How the scenes are read.
    pub(super) fn load_options(&self) -> LoadOptions {
        LoadOptions { model: self.model.unwrap_or(ModelChoice::First), assembly: self.assembly.clone() }
    }

    /// The files to write.
    pub(super) fn outputs(&self) -> impl Iterator<Item = PathBuf> {
        let pictures = self.output.iter().flat_map(|output| {
            (0..self.turntable.unwrap_or(1))
                .map(|index| self.turntable.map_or(output.clone(), |_| numbered(output, index)))
        });
        pictures.chain(self.aov.iter().map(|(_, file)| file.clone()))
    }

    /// What to draw.
    pub(super) fn request(&self) -> Request {
        let wide = self.bits == "16";
        Request {
            transparent: self.transparent,
            wide,
            ..Request::new(self.size.0, self.samples.unwrap_or(GPU_SAMPLES))
        }
    }
}

fn parse_aov(text: &str) -> Result<(AovName, PathBuf), String> {
    let names = || AovName::ALL.map(|(name, _)| name).join(", ");
    let (name, file) =
        text.split_once('=').ok_or_else(|| format!("write it as NAME=FILE.exr, NAME one of {}", names()))?;
    let aov = AovName::ALL.iter().find(|(known, _)| *known == name);
    match aov {
        Some((_, aov)) if !file.is_empty() => Ok((*aov, PathBuf::from(file))),
        Some(_) => Err("the file name is missing".to_owned()),
        None => Err(format!("there is no {name:?}; there are {}", names())),
    }
}

/// The name of a picture of a sequence, counted from 1.
fn numbered(output: &Path, index: u32) -> PathBuf {
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push(format!("_{:04}", index + 1));
    if let Some(extension) = output.extension() {
        name.push(".");
        name.push(extension);
    }
    output.with_file_name(name)
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let start = Instant::now();
    if args.output.is_none() && args.aov.is_empty() && !args.json {
        return Err(Failure::usage("nothing to write: give -o OUT.png, --aov NAME=FILE.exr or --json"));
    }
    args.output.iter().try_for_each(|output| check_format(output, "png"))?;
    args.aov.iter().try_for_each(|(_, output)| check_format(output, "exr"))?;
    args.outputs().try_for_each(|output| check_writable(&output))?;
    let scenes = args.scenes.iter().map(|scene| ("scene", Path::new(scene)));
    let given: Vec<_> = scenes.chain([("style", Path::new(&args.style))]).collect();
    inputs::check_outputs(args.outputs(), &given)?;
    if args.watch {
        return super::watch::run(args);
    }
    let options = args.load_options();
    if args.renderer == Renderer::Reference {
        return exact::run(args, &options);
    }

    // The device opens while the files are read.
    let (gpu, loaded, style) = std::thread::scope(|scope| {
        let gpu = scope.spawn(|| {
            let start = Instant::now();
            (Gpu::open(), start.elapsed().as_secs_f64() * 1e3)
        });
        let style: Result<Style, Failure> = inputs::load_style(&args.style);
        let loaded: Result<Loaded, Failure> = inputs::load_scenes(&args.scenes, &options);
        (gpu.join(), loaded, style)
    });
    let (style, loaded) = (style?, loaded?);
    inputs::check_outputs(args.outputs(), &files_read(&style, &loaded.scene))?;
    let (gpu, device_ms) = gpu.map_err(|_| Failure::from(GpuError::NoAdapter))?;
    if args.renderer == Renderer::Auto && matches!(gpu, Err(GpuError::NoAdapter)) {
        return exact::run_instead(args, style, loaded);
    }
    let gpu = Arc::new(gpu?);
    inputs::print_warnings(&style, &loaded.scene, &args.scenes);
    let mut engine = Engine::new(gpu, loaded.scene, style);
    for limit in engine.limits_exceeded(args.size.0) {
        tell(format!("{}: warning: {limit}", args.style));
    }
    if let Some(count) = args.turntable {
        return turn(&mut engine, args, count);
    }
    let picture = draw(&mut engine, args, &|| false)?;
    let total_ms = ms_since(start);
    if engine.layers_are_merged(&args.request())? {
        tell(format!(
            "{}: warning: dofPost blurs what is transparent by its nearest surfaces alone: lists of all surfaces take more memory than \
             transparency.memory_mb or the device allows",
            args.style
        ));
    }

    let mut frame_ms = Vec::new();
    for _ in 0..args.frames {
        frame_ms.push(rounded(engine.draw(&args.request(), false, &mut |_| ControlFlow::Continue(()))?));
    }
    write_aovs(&mut engine, args)?;
    if args.json {
        let mut line = describe(&mut engine, args, &picture)?;
        line.insert("device_ms".to_owned(), rounded(device_ms).into());
        line.insert("load_ms".to_owned(), rounded(loaded.ms).into());
        line.insert("total_ms".to_owned(), rounded(total_ms).into());
        line.insert("frame_ms".to_owned(), frame_ms.into());
        answer(serde_json::Value::Object(line))?;
    }
    Ok(())
}

/// Writes the pictures of one turn.
fn turn(engine: &mut Engine, args: &Args, count: u32) -> Result<(), Failure> {
    let start = Instant::now();
    let bar = progress_bar(u64::from(count), args.json);
    for (index, output) in (0..count).zip(args.outputs()) {
        let turn_deg = 360.0 * index as f32 / count as f32;
        draw_to(engine, &Request { turn_deg, ..args.request() }, Some(&output), &mut |_| ControlFlow::Continue(()))?;
        bar.set_position(u64::from(index) + 1);
    }
    bar.finish_and_clear();
    if args.json {
        let pictures: Vec<String> = args.outputs().map(|output| output.display().to_string()).collect();
        let line = serde_json::json!({ "pictures": pictures, "total_ms": rounded(ms_since(start)) });
        answer(line)?;
    }
    Ok(())
}

/// The files that a style and a scene name: what is on the command line is known without them.
pub(super) fn files_read<'a>(style: &'a Style, scene: &'a Scene) -> Vec<(&'static str, &'a Path)> {
    let is_picture = |file: &Path| file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    let of_style = style.files.iter().map(|file| {
        let what = if is_picture(file) { "style's picture" } else { "style's base" };
        (what, file.as_path())
    });
    let side_files = scene.files.iter().flat_map(|file| &file.side_files);
    of_style.chain(side_files.map(|file| ("scene's side file", file.as_path()))).collect()
}

/// Times of one picture in milliseconds.
pub(super) struct Drawn {
    /// The frame itself.
    pub(super) frame_ms: f64,
    readback_ms: f64,
    encode_ms: f64,
}

/// Draws one picture and writes it, unless it `is_unwanted` before it is done.
pub(super) fn draw(engine: &mut Engine, args: &Args, is_unwanted: &dyn Fn() -> bool) -> Result<Drawn, Failure> {
    let request = args.request();
    let steps = if Engine::is_tiled(&request) { Engine::num_tiles(&request) } else { request.samples };
    let bar = progress_bar(u64::from(steps), args.json);
    let drawn = draw_to(engine, &request, args.output.as_deref(), &mut |done| {
        bar.set_position(u64::from(done));
        if is_unwanted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    drawn
}

/// Draws one picture and writes it to `output`, if there is one; tile by tile where it is large.
fn draw_to(
    engine: &mut Engine,
    request: &Request,
    output: Option<&Path>,
    progress: &mut dyn FnMut(u32) -> ControlFlow<()>,
) -> Result<Drawn, Failure> {
    let first = Instant::now();
    let cannot = |output: &Path, error: &io::Error| Failure::input(cannot_write(output, error));
    // Before anything is written.
    engine.check_size(request)?;
    if let Some(output) = output.filter(|_| Engine::is_tiled(request)) {
        let header = RowsHeader { size: request.size, opaque: engine.is_opaque(request), wide: request.wide };
        let mut failed = None;
        let written = write_png_rows(output, &header, |sink| match engine.draw_rows(request, progress, sink) {
            Ok(()) => Ok(()),
            Err(TileError::Sink(error)) => Err(error),
            Err(TileError::Gpu(error)) => {
                failed = Some(error);
                Err(io::ErrorKind::Other.into())
            }
        });
        return match (written, failed) {
            (_, Some(error)) => Err(error.into()),
            (Err(error), None) => Err(cannot(output, &error)),
            // Rows are read and encoded as they are drawn.
            (Ok(()), None) => Ok(Drawn { frame_ms: ms_since(first), readback_ms: 0.0, encode_ms: 0.0 }),
        };
    }
    engine.draw(request, false, progress)?;
    let frame_ms = ms_since(first);
    let read = Instant::now();
    let image = engine.read(request)?;
    let readback_ms = ms_since(read);
    let encode = Instant::now();
    if let Some(output) = output {
        image.write_png(output).map_err(|error| cannot(output, &error))?;
    }
    Ok(Drawn { frame_ms, readback_ms, encode_ms: ms_since(encode) })
}

/// Writes the AOVs that are asked for.
pub(super) fn write_aovs(engine: &mut Engine, args: &Args) -> Result<(), Failure> {
    if args.aov.is_empty() {
        return Ok(());
    }
    let aovs = engine.aovs(&args.request())?;
    for (name, file) in &args.aov {
        aovs.write_exr(*name, file).map_err(|error| Failure::input(cannot_write(file, &error)))?;
    }
    Ok(())
}

/// What `--json` says of a picture. Draws one frame more, to time its passes.
pub(super) fn describe(
    engine: &mut Engine,
    args: &Args,
    picture: &Drawn,
) -> Result<serde_json::Map<String, serde_json::Value>, Failure> {
    // Passes of a picture in tiles are not timed.
    if !Engine::is_tiled(&args.request()) {
        engine.draw(&args.request(), true, &mut |_| ControlFlow::Continue(()))?;
    }
    let passes: serde_json::Map<String, serde_json::Value> =
        engine.pass_times().iter().map(|(name, ms)| ((*name).to_owned(), rounded(*ms).into())).collect();
    let targets: serde_json::Map<String, serde_json::Value> =
        engine.target_bytes().into_iter().map(|(name, bytes)| (name.to_owned(), bytes.into())).collect();
    let (info, counts) = (&engine.gpu().info, engine.counts());
    let counts_of = |scene: &Scene| {
        let (molecule, assembly) = (&scene.molecule, &scene.assembly);
        [
            molecule.atoms.len() as u64,
            molecule.bonds.len() as u64,
            assembly.parts.len() as u64,
            assembly.num_triangles(),
        ]
    };
    let [atoms, bonds, parts, mesh_triangles] = engine.scene().map_or([0; 4], counts_of);
    let line = serde_json::json!({
        "scene": args.scenes.join(", "),
        "scenes": args.scenes,
        "style": args.style,
        "size": args.size.0,
        "samples": args.request().samples,
        "adapter": info.name,
        "driver": format!("{} {}", info.driver, info.driver_info),
        "renderer": "gpu",
        "first_frame_ms": rounded(picture.frame_ms),
        "readback_ms": rounded(picture.readback_ms),
        "encode_ms": rounded(picture.encode_ms),
        "pass_ms": passes,
        "pipelines_built": engine.counters().pipelines_built,
        "peak_rss_mb": peak_rss_mb(),
        "atoms": atoms,
        "bonds": bonds,
        "parts": parts,
        "mesh_triangles": mesh_triangles,
        "spheres": counts.spheres,
        "cylinders": counts.cylinders,
        "triangles": counts.triangles,
        "target_bytes": targets,
    });
    match line {
        serde_json::Value::Object(line) => Ok(line),
        _ => Ok(serde_json::Map::new()),
    }
}

fn ms_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// A bar on a terminal; silent elsewhere, for short work and beside JSON.
pub(super) fn progress_bar(steps: u64, quiet: bool) -> indicatif::ProgressBar {
    use std::io::IsTerminal;
    if quiet || steps <= 8 || !std::io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    indicatif::ProgressBar::new(steps)
}

pub(super) fn rounded(ms: f64) -> f64 {
    (ms * 100.0).round() / 100.0
}

/// Largest memory that the process held, in MiB; none where the system does not tell.
fn peak_rss_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(rounded(kib / 1024.0))
}

/// Extensions of formats that other programs write.
const OTHER_FORMATS: &[&str] = &[
    "png", "apng", "jpg", "jpeg", "jxl", "webp", "avif", "heic", "gif", "bmp", "tga", "tif", "tiff", "ppm", "exr",
    "hdr", "svg", "pdf", "eps", "psd", "mp4", "mov", "webm", "avi", "mkv",
];

/// Refuses a name that promises another format than what is written.
pub(super) fn check_format(path: &Path, written: &str) -> Result<(), Failure> {
    let Some(extension) = path.extension().and_then(|extension| extension.to_str()) else { return Ok(()) };
    let extension = extension.to_ascii_lowercase();
    if extension == written || !OTHER_FORMATS.contains(&extension.as_str()) {
        return Ok(());
    }
    let (shown, named) = (path.display(), path.with_extension(written));
    let what = if written == "png" { "pictures are written as PNG" } else { "AOVs are written as OpenEXR" };
    let named = named.display();
    Err(Failure::usage(format!("{shown}: {what}, not as {}; write to {named}", extension.to_uppercase())))
}

/// Refuses what cannot be written before any work is done.
pub(super) fn check_writable(path: &Path) -> Result<(), Failure> {
    let shown = path.display();
    if path.is_dir() || path.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return Err(Failure::input(format!("{shown}: is a folder; name a file in it")));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let (folder, exists) = (folder.display(), folder.exists());
        let wrong = if exists { "is a file, not a folder; choose another" } else { "does not exist; make it first" };
        return Err(Failure::input(format!("{shown}: the folder {folder} {wrong}")));
    }
    Ok(())
}

/// Why a file could not be written, in plain words.
pub(super) fn cannot_write(path: &Path, error: &io::Error) -> String {
    let path = path.display();
    match error.kind() {
        io::ErrorKind::NotFound => format!("{path}: its folder does not exist; make it first"),
        io::ErrorKind::PermissionDenied => format!("{path}: no permission to write there; choose another place"),
        io::ErrorKind::StorageFull => format!("{path}: the disk is full; free some space"),
        io::ErrorKind::IsADirectory => format!("{path}: is a folder; name a file in it"),
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => {
            format!("{path}: there is a file where a folder is needed; choose another place")
        }
        io::ErrorKind::InvalidFilename => format!("{path}: this name is too long or not allowed; choose another"),
        io::ErrorKind::BrokenPipe => format!("{path}: nobody reads from it any more"),
        _ => format!("{path}: cannot be written: {error}; choose another place"),
    }
}
