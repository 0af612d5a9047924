//! What is left of an experiment: figures as JSON, a chart as SVG, and a page of both with the pictures, which opens from
//! disk and needs nothing beside it.

use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::rc::Rc;

use serde_json::{Map, Value as Json, json};

use super::chart;
use super::experiment::{ChartKind, MeasureError};
use super::metrics::Metrics;
use super::overview;
use super::run::{Report, Row, quantile};
use crate::scene::{Image, Pixels, write_whole};

/// Why an experiment could not be written.
#[derive(Debug)]
pub enum PageError {
    /// A file or a folder.
    File(PathBuf, io::Error),
    /// The chart.
    Chart(MeasureError),
}

/// Writes `folder/NAME/` with `NAME.json`, `chart.svg` and `index.html`; returns the page's path.
///
/// # Errors
/// [`PageError`]; each file is whole or as it was.
pub fn write(report: &Report, folder: &Path) -> Result<PathBuf, PageError> {
    let chart = chart::svg(report).map_err(PageError::Chart)?;
    let folder = folder.join(report.name);
    let at = |path: &Path| {
        let path = path.to_owned();
        move |error| PageError::File(path, error)
    };
    std::fs::create_dir_all(&folder).map_err(at(&folder))?;
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        write_whole(&path, |file| file.write_all(text.as_bytes())).map_err(at(&path)).map(|()| path)
    };
    write(&format!("{}.json", report.name), &format!("{:#}\n", document(report)))?;
    write("chart.svg", &chart)?;
    write("index.html", &page(report, &chart))
}

/// Writes what all experiments have in common: `folder/index.html` with links to their pages, and `folder/accuracy.md`
/// with their charts, which lie in `folder/accuracy/`. Returns the path of the former.
///
/// # Errors
/// [`PageError`].
pub fn write_overview(reports: &[Report], folder: &Path) -> Result<PathBuf, PageError> {
    let write = |path: PathBuf, text: &str| {
        let written = write_whole(&path, |file| file.write_all(text.as_bytes()));
        written.map(|()| path.clone()).map_err(|error| PageError::File(path, error))
    };
    let charts = folder.join("accuracy");
    std::fs::create_dir_all(&charts).map_err(|error| PageError::File(charts.clone(), error))?;
    for report in reports {
        let chart = chart::svg(report).map_err(PageError::Chart)?;
        write(charts.join(format!("{}.svg", report.name)), &chart)?;
    }
    write(folder.join("accuracy.md"), &overview::markdown(reports))?;
    write(folder.join("index.html"), &index(reports))
}

/// The page with links to experiments.
fn index(reports: &[Report]) -> String {
    let mut page = head("restyle measure");
    page.push_str("<h1>restyle measure</h1>\n<table class=\"rows\">\n<tr><th>experiment</th><th>what it finds out</th><th>best and worst</th></tr>\n");
    for report in reports {
        let name = report.name;
        let _ = writeln!(
            page,
            "<tr><td><a href=\"{name}/index.html\">{name}</a></td><td>{}</td><td>{}</td></tr>",
            escaped(report.doc),
            escaped(&best_and_worst(report))
        );
    }
    page.push_str("</table>\n</html>\n");
    page
}

/// The figures for tools.
pub fn document(report: &Report) -> Json {
    let size = report.sizes().into_iter().max();
    json!({
        "experiment": report.name,
        "adapter": report.adapter,
        "driver": report.driver,
        "size": size,
        "date": report.date,
        "rounds": report.rounds,
        "rounds_due": report.rounds_due,
        "partial": report.is_partial,
        "noise": report.noise(),
        "seconds": report.seconds,
        "conditions": report.conditions,
        "says": report.says,
        "findings": report.findings,
        "rows": report.rows.iter().map(row).collect::<Vec<_>>(),
    })
}

fn row(row: &Row) -> Json {
    let [median, min, max] = [0.5, 0.0, 1.0].map(|share| quantile(&row.frame_ms, share));
    let passes = |share: f64| -> Map<String, Json> {
        row.pass_ms(share).into_iter().map(|(name, ms)| (name.to_owned(), json!(ms))).collect()
    };
    json!({
        "scene": row.entry.scene,
        "method": row.entry.method,
        "settings": row.entry.settings,
        "published": row.entry.is_published,
        "size": row.entry.size,
        "ms": { "median": median, "min": min, "max": max },
        "passes": passes(0.5),
        "pass_quartiles": [passes(0.25), passes(0.75)],
        "bytes": row.bytes,
        "error": row.error.as_ref().map(error),
        "figures": row.figures.iter().map(|(name, value)| ((*name).to_owned(), json!(value))).collect::<Map<_, _>>(),
    })
}

fn error(metrics: &Metrics) -> Json {
    json!({
        "rmse": metrics.display.rmse.all,
        "max": metrics.display.max.all,
        // JSON has no infinity.
        "psnr": if metrics.psnr_db.is_finite() { json!(metrics.psnr_db) } else { json!("inf") },
        "ssim": metrics.ssim,
        "flip": metrics.flip,
    })
}

/// A number of three digits.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "-".to_owned() };
    }
    let places = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.places$}")
}

/// A row as people call it: scene and settings.
fn called(row: &Row) -> String {
    let settings: Vec<String> = row.entry.settings.iter().map(|(name, value)| setting(name, value)).collect();
    let method = if row.entry.method == "gpu" { String::new() } else { format!("{}, ", row.entry.method) };
    format!("{}, {method}{}", row.entry.scene, settings.join(", "))
}

fn setting(name: &str, value: &Json) -> String {
    match value {
        Json::String(text) => text.clone(),
        Json::Array(values) => values.iter().map(Json::to_string).collect::<Vec<_>>().join("x"),
        value => format!("{value} {}", if value.as_f64() == Some(1.0) { name.trim_end_matches('s') } else { name }),
    }
}

/// The least and the largest figure of the chart's vertical axis, with what has them.
pub fn best_and_worst(report: &Report) -> String {
    let value = |row: &Row| match report.chart {
        ChartKind::CostAgainstError { error, .. } => error.of(row),
        ChartKind::TimeByExtent { .. } => Some(row.median_ms()).filter(|ms| ms.is_finite()),
    };
    let (unit, nothing) = match report.chart {
        ChartKind::CostAgainstError { error, .. } => (error.short_name(), "nothing was held against the truth"),
        ChartKind::TimeByExtent { .. } => ("ms", "nothing was measured"),
    };
    let mut rows: Vec<(f64, &Row)> = report.rows.iter().filter_map(|row| Some((value(row)?, row))).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(best), Some(worst)) = (rows.first(), rows.last()) else { return nothing.to_owned() };
    let said = |(value, row): &(f64, &Row)| format!("{unit} {} ({})", short(*value), called(row));
    format!("best {}, worst {}", said(best), said(worst))
}

fn head(title: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{}</title>\n<style>\n{CSS}</style>\n",
        escaped(title)
    )
}

/// Sizes of pictures in pixels, in words.
pub(super) fn resolution(report: &Report) -> String {
    let sizes: Vec<String> = report.sizes().iter().map(|[width, height]| format!("{width}x{height}")).collect();
    sizes.join(", ")
}

/// How much times differ from round to round, in words.
pub(super) fn noise(report: &Report) -> String {
    report.noise().map_or("one round tells none".to_owned(), |noise| {
        format!("the slowest round took {} % longer than the fastest", short(noise * 100.0))
    })
}

/// How many rounds there were, in words.
pub(super) fn rounds(report: &Report) -> String {
    let rounds = format!("{} of {}", report.rounds, report.rounds_due);
    let is_short = report.rounds < report.rounds_due && !report.is_partial;
    if is_short { format!("{rounds}, which is what the time allows") } else { rounds }
}

fn page(report: &Report, chart: &str) -> String {
    let mut page = head(&format!("restyle measure {}", report.name));
    let _ = writeln!(page, "<h1>{}</h1>\n<p class=\"doc\">{}</p>", escaped(report.name), escaped(report.doc));
    if report.is_partial {
        page.push_str("<p class=\"partial\">Partial: the run was broken off before all was measured.</p>\n");
    }
    let adapter = report.adapter.as_deref().unwrap_or("none: evaluated on the CPU");
    let driver = report.driver.as_deref().unwrap_or("none");
    page.push_str("<dl>\n");
    for (name, value) in [
        ("adapter", adapter.to_owned()),
        ("driver", driver.to_owned()),
        ("resolution", resolution(report)),
        ("date", report.date.clone()),
        ("rounds", rounds(report)),
        ("noise", noise(report)),
        ("result", best_and_worst(report)),
    ] {
        let _ = writeln!(page, "<div><dt>{name}</dt><dd>{}</dd></div>", escaped(&value));
    }
    page.push_str("</dl>\n");
    for paragraph in &report.conditions {
        let _ = writeln!(page, "<p>{}</p>", escaped(paragraph));
    }
    let _ = writeln!(page, "<figure class=\"chart\">{chart}</figure>\n<p class=\"doc\">{}</p>", escaped(&report.says));
    if !report.findings.is_empty() {
        page.push_str("<ul>\n");
        for finding in &report.findings {
            let _ = writeln!(page, "<li>{}</li>", escaped(finding));
        }
        page.push_str("</ul>\n");
    }
    table(&mut page, report);
    pictures(&mut page, report);
    page.push_str("</html>\n");
    page
}

fn table(page: &mut String, report: &Report) {
    let has_errors = report.rows.iter().any(|row| row.error.is_some());
    let per_pixel = matches!(report.chart, ChartKind::CostAgainstError { per_pixel: true, .. });
    page.push_str("<table class=\"rows\">\n<thead><tr><th>scene</th><th>method</th><th>settings</th><th>ms, median</th><th>min</th><th>max</th>");
    page.push_str(if per_pixel { "<th>ns per pixel</th>" } else { "<th>passes, ms</th><th>memory, MiB</th>" });
    if has_errors {
        page.push_str("<th>FLIP</th><th>RMSE</th><th>max</th><th>PSNR, dB</th><th>SSIM</th>");
    }
    // Every row of an experiment is judged alike.
    let judged = report.rows.iter().map(|row| &row.figures).find(|figures| !figures.is_empty());
    let names: Vec<&str> = judged.into_iter().flatten().map(|(name, _)| *name).collect();
    for name in &names {
        let _ = write!(page, "<th>{}</th>", escaped(name));
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for row in &report.rows {
        let settings: Vec<String> = row.entry.settings.iter().map(|(name, value)| setting(name, value)).collect();
        let [median, min, max] = [0.5, 0.0, 1.0].map(|share| short(quantile(&row.frame_ms, share)));
        let published = if row.entry.is_published { " (published)" } else { "" };
        let _ = write!(
            page,
            "<tr><td>{}</td><td>{}{published}</td><td>{}</td><td>{median}</td><td>{min}</td><td>{max}</td>",
            escaped(&row.entry.scene),
            escaped(&row.entry.method),
            escaped(&settings.join(", "))
        );
        if per_pixel {
            let _ = write!(page, "<td>{}</td>", short(row.median_ns_per_pixel()));
        } else {
            let passes: Vec<String> =
                row.pass_ms(0.5).iter().map(|(name, ms)| format!("{name} {}", short(*ms))).collect();
            let mebibytes = short(row.bytes as f64 / f64::from(1 << 20));
            let _ = write!(page, "<td>{}</td><td>{mebibytes}</td>", escaped(&passes.join(", ")));
        }
        if has_errors {
            match &row.error {
                Some(error) => {
                    let figures = [error.flip, error.display.rmse.all, error.display.max.all].map(short);
                    figures.iter().for_each(|figure| {
                        let _ = write!(page, "<td>{figure}</td>");
                    });
                    let psnr =
                        if error.psnr_db.is_finite() { format!("{:.1}", error.psnr_db) } else { "inf".to_owned() };
                    let _ = write!(page, "<td>{psnr}</td><td>{:.4}</td>", error.ssim);
                }
                None => page.push_str("<td colspan=\"5\">not reached</td>"),
            }
        }
        for name in &names {
            let _ = write!(page, "<td>{}</td>", row.figure(name).map_or("-".to_owned(), short));
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody>\n</table>\n");
}

/// For each truth: it, and the picture and the difference of each case that is held against it.
fn pictures(page: &mut String, report: &Report) {
    let rows: Vec<(&Row, &Rc<Image>)> = report.rows.iter().filter_map(|row| Some((row, row.truth.as_ref()?))).collect();
    if rows.is_empty() {
        return;
    }
    page.push_str(
        "<h2>Pictures</h2>\n<p>The truth, then of each case its picture and the difference, as FLIP: black where none is seen, \
         through purple and orange to pale yellow for the plainest.</p>\n",
    );
    let mut start = 0;
    while let Some((first, truth)) = rows.get(start) {
        let count = rows[start..].iter().take_while(|(_, other)| Rc::ptr_eq(truth, other)).count();
        let title = match first.entry.settings.get("look") {
            Some(look) => format!("{}, {}", first.entry.scene, setting("look", look)),
            None => first.entry.scene.clone(),
        };
        let _ = writeln!(page, "<section><h3>{}</h3><div class=\"strip\">", escaped(&title));
        picture(page, truth, "truth");
        for (row, _) in &rows[start..start + count] {
            let settings = row.entry.settings.iter().filter(|(name, _)| *name != "look");
            let settings: Vec<String> = settings.map(|(name, value)| setting(name, value)).collect();
            let method = if row.entry.method == "gpu" { String::new() } else { format!("{}, ", row.entry.method) };
            let caption = format!("{method}{}", settings.join(", "));
            if let (Some(image), Some(difference), Some(error)) = (&row.picture, &row.difference, &row.error) {
                picture(page, image, &caption);
                picture(page, difference, &format!("difference, FLIP {}", short(error.flip)));
            }
        }
        page.push_str("</div></section>\n");
        start += count;
    }
}

fn picture(page: &mut String, image: &Image, caption: &str) {
    let mut bytes = Vec::new();
    // Memory does not run out of space; a picture of no size has nothing to show.
    if narrow(image).encode_png(&mut bytes).is_err() {
        return;
    }
    let caption = escaped(caption);
    let [width, height] = image.size;
    let _ = write!(
        page,
        "<figure><img src=\"data:image/png;base64,{}\" width=\"{width}\" height=\"{height}\" loading=\"lazy\" alt=\"{caption}\">\
         <figcaption>{caption}</figcaption></figure>",
        base64(&bytes)
    );
}

/// The image with 8 bits a channel, which is all that a page shows.
fn narrow(image: &Image) -> Image {
    let pixels = match &image.pixels {
        Pixels::U8(values) => values.clone(),
        Pixels::U16(values) => values.iter().map(|value| (f32::from(*value) / 257.0).round() as u8).collect(),
    };
    Image { pixels: Pixels::U8(pixels), ..*image }
}

/// Base 64, with padding.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let word = (0..3).fold(0u32, |word, index| word << 8 | u32::from(group.get(index).copied().unwrap_or(0)));
        for index in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * index)) as usize & 63] as char;
            text.push(if index <= group.len() { letter } else { '=' });
        }
    }
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The gallery's surroundings, with room for tables.
const CSS: &str = "\
body { margin: 2rem auto; max-width: 84rem; padding: 0 1.5rem; background: #dfe1e4; color: #1d2127; font: 16px/1.45 system-ui, sans-serif; }
h1 { margin: 0; font-weight: 600; letter-spacing: -0.02em; }
h2 { margin: 2.5rem 0 0; font-weight: 600; }
h3 { margin: 1.5rem 0 0.4rem; font-size: 1rem; font-weight: 600; }
p { max-width: 60rem; margin: 0.4rem 0; color: #454b55; }
p.doc { font-size: 1.1rem; color: #1d2127; }
p.partial { padding: 0.5rem 0.8rem; background: #f6dcc0; color: #6b3200; border-radius: 6px; }
dl { display: flex; flex-wrap: wrap; gap: 0.4rem 2rem; margin: 1rem 0; }
dt { font-size: 0.8rem; color: #6a707b; }
dd { margin: 0; }
figure { margin: 0; }
figure.chart { margin: 1.2rem 0; padding: 0.5rem; background: #fff; border-radius: 6px; box-shadow: 0 1px 4px #0003; max-width: 900px; }
figure.chart svg { display: block; width: 100%; height: auto; }
table.rows { border-collapse: collapse; background: #fff; border-radius: 6px; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
table.rows th, table.rows td { padding: 0.25rem 0.6rem; text-align: left; border-bottom: 1px solid #e6e8eb; }
table.rows thead th { position: sticky; top: 0; background: #fff; }
.strip { display: flex; gap: 8px; overflow-x: auto; padding-bottom: 8px; }
.strip img { display: block; border-radius: 4px; box-shadow: 0 1px 4px #0003; }
figcaption { margin-top: 0.2rem; font-size: 0.8rem; color: #454b55; }
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_padded() {
        assert_eq!(
            ["", "f", "fo", "foo", "foob"].map(|text| base64(text.as_bytes())),
            ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg=="]
        );
    }

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!([0.0, 0.012_345, 1.5, 12.345, 12345.6].map(short), ["0", "0.0123", "1.50", "12.3", "12346"]);
        assert_eq!(short(f64::NAN), "-");
    }
}
