//! `restyle gallery`: every look on every scene, as PNG files and one contact sheet that opens from disk.

use std::fmt::Write as _;
use std::io::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::inputs::{self, Size};
use super::messages::clean;
use super::render::{cannot_write, progress_bar};
use super::{Failure, answer, exact, print_message, tell};
use crate::config::Style;
use crate::engine::exact::Exact;
use crate::engine::{Engine, Gpu, GpuError, Request};
use crate::scene::{Image, LoadOptions, Scene, write_whole};
use crate::shipped::{LOOKS, SCENES, Shipped};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Files of molecules or meshes, or names of shipped ones; all shipped ones by default
    scenes: Vec<String>,
    /// Style files or names of looks (repeatable); all shipped ones by default
    #[arg(short, long)]
    style: Vec<String>,
    /// The folder to write to; it is made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "gallery")]
    output: PathBuf,
    /// Width and height of each picture in pixels
    /// 640x640 by default, 480x480 without an adapter
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
    /// Samples a pixel: 16 by default, 9 without an adapter
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1024))]
    samples: Option<u32>,
}

/// What draws the pictures.
enum Drawn {
    /// An adapter, and what draws on it once there is something.
    Gpu(Arc<Gpu>, Option<Box<Engine>>),
    /// The reference renderer.
    Exact,
}

impl Drawn {
    /// The adapter; the reference renderer where there is none.
    fn open() -> Result<Drawn, Failure> {
        match Gpu::open() {
            Ok(gpu) => Ok(Drawn::Gpu(Arc::new(gpu), None)),
            Err(GpuError::NoAdapter) => Ok(Drawn::Exact),
            Err(error) => Err(error.into()),
        }
    }

    fn name(&self) -> String {
        match self {
            Drawn::Gpu(gpu, _) => gpu.info.name.clone(),
            Drawn::Exact => "the reference renderer".to_owned(),
        }
    }

    /// What is drawn where the command line does not say.
    fn request(&self, args: &Args) -> Request {
        let (size, samples) = match self {
            Drawn::Gpu(..) => ([640, 640], 16),
            Drawn::Exact => ([480, 480], 9),
        };
        Request::new(args.size.map_or(size, |size| size.0), args.samples.unwrap_or(samples))
    }

    /// One picture; `is_new` where the scene is another one than before.
    fn still(&mut self, scene: &Scene, style: &Style, is_new: bool, request: &Request) -> Result<Image, Failure> {
        let (gpu, engine) = match self {
            Drawn::Gpu(gpu, engine) => (gpu, engine),
            Drawn::Exact => {
                let exact = Exact::new(scene.clone(), style.clone(), None).as_draft();
                return exact.still(request, &mut |_| ControlFlow::Continue(())).map_err(|_| Failure::interrupted());
            }
        };
        let engine = match engine {
            Some(engine) => {
                if is_new {
                    engine.set_scene(scene.clone());
                }
                engine.set_style(style.clone());
                engine
            }
            none => none.insert(Box::new(Engine::new(Arc::clone(gpu), scene.clone(), style.clone()))),
        };
        Ok(engine.still(request)?)
    }
}

/// One row or column of the sheet: what it is called, and the stem of its file names.
struct Named<T> {
    label: String,
    stem: String,
    value: T,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let start = Instant::now();
    let or_all = |given: &[String], all: &[&[Shipped]]| -> Vec<String> {
        let all = all.iter().copied().flatten().map(|shipped| shipped.name.to_owned());
        if given.is_empty() { all.collect() } else { given.to_vec() }
    };
    let scene_names = or_all(&args.scenes, &SCENES);
    let style_names = or_all(&args.style, &[LOOKS]);

    // All that can be wrong with the input is found before anything is written.
    let options = LoadOptions::default();
    let mut styles: Vec<Named<Style>> = Vec::new();
    for name in &style_names {
        let stem = free_stem(name, styles.iter().map(|style| style.stem.as_str()));
        styles.push(Named { label: stem.clone(), stem, value: inputs::load_style(name)? });
    }
    let mut scenes: Vec<Named<Scene>> = Vec::new();
    let mut drawn = Drawn::open()?;
    // What every cell of a look or a scene shares is told once.
    let mut told: Vec<String> = Vec::new();
    for name in &scene_names {
        let stem = free_stem(name, scenes.iter().map(|scene| scene.stem.as_str()));
        let scene = inputs::load_scene(name, &options)?;
        told.extend(inputs::scene_warnings(&scene, std::slice::from_ref(name)).into_iter().map(clean));
        scenes.push(Named { label: stem.replace('_', " "), stem, value: scene });
    }
    for style in &styles {
        told.extend(inputs::style_warnings(&style.value));
    }
    let pictures = scenes.iter().flat_map(|scene| styles.iter().map(|style| file_name(scene, style)));
    let outputs: Vec<PathBuf> = pictures.chain(["index.html".to_owned()]).map(|file| args.output.join(file)).collect();
    let given: Vec<(&str, &Path)> = scene_names
        .iter()
        .map(|name| ("scene", Path::new(name)))
        .chain(styles.iter().flat_map(|style| style.value.files.iter().map(|file| ("style", file.as_path()))))
        .collect();
    inputs::check_outputs(outputs.iter().cloned(), &given)?;
    let (renderer, request) = (drawn.name(), drawn.request(args));
    std::fs::create_dir_all(&args.output).map_err(|error| Failure::input(cannot_write(&args.output, &error)))?;

    let mut seen = std::collections::HashSet::new();
    told.into_iter().filter(|line| seen.insert(line.clone())).for_each(|message| print_message(&message));
    if matches!(drawn, Drawn::Exact) {
        let [width, height] = request.size;
        tell(format!("{}: pictures of {width}x{height}, {} samples a pixel", exact::instead(), request.samples));
    }
    let bar = progress_bar((styles.len() * scenes.len()) as u64 + 9, false);
    bar.set_length((styles.len() * scenes.len()) as u64);
    for scene in &scenes {
        let mut is_new = true;
        for style in &styles {
            let image = drawn.still(&scene.value, &style.value, is_new, &request)?;
            is_new = false;
            let file = args.output.join(file_name(scene, style));
            image.write_png(&file).map_err(|error| Failure::input(cannot_write(&file, &error)))?;
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    let sheet = args.output.join("index.html");
    let page = contact_sheet(&scenes, &styles, &request, &renderer);
    write_whole(&sheet, |file| file.write_all(page.as_bytes()))
        .map_err(|error| Failure::input(cannot_write(&sheet, &error)))?;
    answer(format_args!(
        "{} pictures in {:.1} s on {renderer}; open {}",
        styles.len() * scenes.len(),
        start.elapsed().as_secs_f64(),
        sheet.display()
    ))
}

/// The file's stem in letters that every file system takes, with a number where it is taken already. It holds no dot,
/// since dots part the names of scene and look.
fn free_stem<'a>(name: &str, taken: impl Iterator<Item = &'a str> + Clone) -> String {
    /// Two of them and an extension fit into the 255 bytes of a file's name.
    const LONGEST: usize = 100;
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    let safe = |c: char| if c.is_alphanumeric() || "-_".contains(c) { c } else { '_' };
    let stem: String = stem.chars().map(safe).collect();
    let stem = if stem.is_empty() { "unnamed" } else { &stem[..stem.floor_char_boundary(LONGEST)] };
    let mut candidate = stem.to_owned();
    let mut number = 2;
    // Not every file system tells upper from lower case.
    while taken.clone().any(|other| other.to_lowercase() == candidate.to_lowercase()) {
        candidate = format!("{stem}-{number}");
        number += 1;
    }
    candidate
}

fn file_name<A, B>(scene: &Named<A>, style: &Named<B>) -> String {
    format!("{}.{}.png", scene.stem, style.stem)
}

/// The page: one row for each scene, one column for each look, as the published table has them.
fn contact_sheet(scenes: &[Named<Scene>], styles: &[Named<Style>], request: &Request, renderer: &str) -> String {
    let [width, height] = request.size;
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>restyle gallery</title>\n<style>\n{CSS}</style>\n<h1>restyle</h1>\n\
         <p>{} looks on {} scenes, {width}x{height}, {} samples a pixel, drawn on {}.</p>\n<table>\n<thead><tr><th></th>",
        styles.len(),
        scenes.len(),
        request.samples,
        escaped(renderer)
    );
    for style in styles {
        let _ = write!(page, "<th scope=\"col\">{}</th>", escaped(&style.label));
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for scene in scenes {
        let label = escaped(&scene.label);
        let _ = write!(page, "<tr><th scope=\"row\">{label}<small>{}</small></th>", counts(&scene.value));
        for style in styles {
            let file = escaped(&file_name(scene, style));
            let alt = escaped(&format!("{} in the look {}", scene.label, style.label));
            let _ = write!(
                page,
                "<td><a href=\"{file}\"><img src=\"{file}\" width=\"{width}\" height=\"{height}\" loading=\"lazy\" alt=\"{alt}\"></a></td>"
            );
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table>\n</html>\n");
    page
}

/// How much a scene holds, in two lines for each type of objects.
fn counts(scene: &Scene) -> String {
    let (molecule, assembly) = (&scene.molecule, &scene.assembly);
    let mut lines = Vec::new();
    if !molecule.atoms.is_empty() {
        lines.extend([format!("{} atoms", molecule.atoms.len()), format!("{} bonds", molecule.bonds.len())]);
    }
    if !assembly.is_empty() {
        lines.extend([format!("{} parts", assembly.parts.len()), format!("{} triangles", assembly.num_triangles())]);
    }
    lines.join("<br>")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Neutral surroundings, so that the pictures' own backgrounds show.
const CSS: &str = "\
body { margin: 2rem auto; max-width: 110rem; padding: 0 1.5rem; background: #dfe1e4; color: #1d2127; font: 16px/1.4 system-ui, sans-serif; }
h1 { margin: 0; font-weight: 600; letter-spacing: -0.02em; }
p { margin: 0.2rem 0 1.5rem; color: #555b66; }
table { width: 100%; border-collapse: separate; border-spacing: 10px; table-layout: fixed; }
thead th { position: sticky; top: 0; padding: 0.6rem 0; background: #dfe1e4; font-weight: 600; text-transform: capitalize; z-index: 1; }
thead th:first-child { width: 9rem; }
tbody th { text-align: left; vertical-align: middle; font-weight: 600; text-transform: capitalize; overflow-wrap: anywhere; }
small { display: block; margin-top: 0.2rem; color: #6a707b; font-weight: 400; text-transform: none; }
td { padding: 0; }
img { display: block; width: 100%; height: auto; border-radius: 6px; box-shadow: 0 1px 4px #0003; }
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stems_are_safe_and_unique() {
        assert_eq!(free_stem("a/b c.pdb", ["x"].into_iter()), "b_c");
        assert_eq!(free_stem("a/x.pdb", ["x", "x-2"].into_iter()), "x-3");
        assert_eq!(free_stem("..", [].into_iter()), "unnamed");
        assert_eq!(free_stem("C60.xyz", ["c60"].into_iter()), "C60-2");
        // Else the scene a.b in the look c would be the scene a in the look b.c.
        assert_eq!(free_stem("a.b.xyz", [].into_iter()), "a_b");
        assert!(free_stem(&"\u{e9}".repeat(200), [].into_iter()).len() <= 100);
    }

    #[test]
    fn names_cannot_break_the_page() {
        assert_eq!(escaped("<a href=\"&\">"), "&lt;a href=&quot;&amp;&quot;&gt;");
    }
}
