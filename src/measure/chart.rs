//! The chart of an experiment as SVG: cost against error with the Pareto front, or time by size.

use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, Ranged};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::experiment::{ChartKind, ErrorKind, MeasureError};
use super::front::pareto;
use super::run::{Report, Row, geometric_mean};

/// Pixels of the picture.
const SIZE: (u32, u32) = (900, 560);
/// Where the legend begins.
const LEGEND_X: i32 = 700;
const INK: RGBColor = RGBColor(29, 33, 39);
const FAINT: RGBColor = RGBColor(223, 226, 230);

/// Colours that people with any colour vision tell apart, after Okabe and Ito, dark enough for lines on white.
const COLORS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(175, 130, 0),
    RGBColor(86, 180, 233),
    RGBColor(90, 90, 90),
    RGBColor(120, 60, 150),
];

/// A point of a chart.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Point {
    at: [f64; 2],
    is_published: bool,
}

/// Points of one colour.
struct Series<'a> {
    name: &'a str,
    color: RGBColor,
    /// Joined by a line.
    points: Vec<Point>,
    /// What they are the means of.
    parts: Vec<[f64; 2]>,
    is_thin: bool,
}

/// The chart.
///
/// # Errors
/// [`MeasureError::Content`] where it cannot be drawn.
pub fn svg(report: &Report) -> Result<String, MeasureError> {
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        let drawn = match report.chart {
            ChartKind::CostAgainstError { error, per_pixel, has_front } => {
                cost_against_error(&root, report, error, per_pixel, has_front)
            }
            ChartKind::TimeByExtent { extent } => time_by_extent(&root, report, extent),
        };
        drawn
            .and_then(|()| root.present().map_err(words))
            .map_err(|what| MeasureError::Content(format!("the chart of {} cannot be drawn: {what}", report.name)))?;
    }
    Ok(text)
}

fn words(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Distinct values in the order in which they come.
fn distinct<'a>(rows: &'a [Row], of: impl Fn(&'a Row) -> &'a str) -> Vec<&'a str> {
    let mut names = Vec::new();
    for name in rows.iter().map(of) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn color(index: usize) -> RGBColor {
    COLORS[index % COLORS.len()]
}

/// Geometric mean of each coordinate.
fn mean(points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|axis| geometric_mean(points.iter().map(|point| point[axis])))
}

/// Points of cost and error, averaged over scenes.
fn series(report: &Report, error: ErrorKind, per_pixel: bool) -> Vec<Series<'_>> {
    let at = |row: &Row| {
        let cost = if per_pixel { row.median_ns_per_pixel() } else { row.median_ms() };
        let error = error.of(row)?.max(error.floor());
        (cost > 0.0).then_some([cost, error])
    };
    let names = distinct(&report.rows, |row| &row.entry.series);
    let of = |(index, name): (usize, &'_ str)| {
        let rows: Vec<&Row> = report.rows.iter().filter(|row| row.entry.series == name).collect();
        let mut marks: Vec<&str> = rows.iter().map(|row| &*row.entry.point).collect();
        let mut seen = Vec::new();
        marks.retain(|mark| {
            let is_new = !seen.contains(mark);
            seen.push(*mark);
            is_new
        });
        let points = marks.iter().filter_map(|mark| {
            let rows = || rows.iter().filter(|row| row.entry.point == *mark);
            let parts: Vec<[f64; 2]> = rows().filter_map(|row| at(row)).collect();
            (!parts.is_empty())
                .then(|| Point { at: mean(&parts), is_published: rows().any(|row| row.entry.is_published) })
        });
        (index, points.collect::<Vec<_>>(), rows.iter().filter_map(|row| at(row)).collect::<Vec<_>>())
    };
    let series = names.iter().enumerate().map(|(index, name)| {
        let (index, points, parts) = of((index, name));
        Series { name, color: color(index), points, parts, is_thin: false }
    });
    series.filter(|series| !series.points.is_empty()).collect()
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn cost_against_error(
    root: &Area<'_>,
    report: &Report,
    error: ErrorKind,
    per_pixel: bool,
    has_front: bool,
) -> Result<(), String> {
    let series = series(report, error, per_pixel);
    let cost = if per_pixel { "cost: ns per pixel" } else { "cost: ms per frame" };
    let mut chart = plot(root, &series, [cost, error.title()])?;
    let all: Vec<[f64; 2]> = series.iter().flat_map(|series| series.points.iter().map(|point| point.at)).collect();
    let best = if has_front { pareto(&all) } else { Vec::new() };
    let front: Vec<(f64, f64)> = best.into_iter().map(|index| (all[index][0], all[index][1])).collect();
    let has_front = front.len() > 1;
    for series in &series {
        chart
            .draw_series(series.parts.iter().map(|at| Circle::new((at[0], at[1]), 2, series.color.mix(0.4).filled())))
            .map_err(words)?;
        let line = series.points.iter().map(|point| (point.at[0], point.at[1]));
        chart.draw_series(LineSeries::new(line, series.color.stroke_width(2))).map_err(words)?;
    }
    chart.draw_series(DashedLineSeries::new(front, 7, 5, INK.stroke_width(2))).map_err(words)?;
    for series in &series {
        for point in &series.points {
            let at = (point.at[0], point.at[1]);
            chart.draw_series([Circle::new(at, 5, series.color.filled())]).map_err(words)?;
            if point.is_published {
                chart.draw_series([Circle::new(at, 10, INK.stroke_width(2))]).map_err(words)?;
            }
        }
    }
    let is_published = series.iter().any(|series| series.points.iter().any(|point| point.is_published));
    legend(root, &series, has_front, is_published)
}

fn time_by_extent(root: &Area<'_>, report: &Report, extent: &str) -> Result<(), String> {
    let names = distinct(&report.rows, |row| &row.entry.series);
    let marks = distinct(&report.rows, |row| &row.entry.point);
    let mut series = Vec::new();
    for (index, name) in names.iter().enumerate() {
        for (thin, mark) in marks.iter().enumerate() {
            let rows = report.rows.iter().filter(|row| row.entry.series == *name && row.entry.point == *mark);
            let points =
                rows.map(|row| Point { at: [row.entry.extent, row.median_ms()], is_published: row.entry.is_published });
            let points: Vec<Point> = points.filter(|point| point.at.iter().all(|value| *value > 0.0)).collect();
            series.push(Series { name, color: color(index), points, parts: Vec::new(), is_thin: thin > 0 });
        }
    }
    let mut chart = plot(root, &series, [extent, "time: ms per frame"])?;
    for series in &series {
        let line: Vec<(f64, f64)> = series.points.iter().map(|point| (point.at[0], point.at[1])).collect();
        if series.is_thin {
            let style = series.color.mix(0.8).stroke_width(1);
            chart.draw_series(DashedLineSeries::new(line, 4, 3, style)).map_err(words)?;
        } else {
            chart.draw_series(LineSeries::new(line.iter().copied(), series.color.stroke_width(2))).map_err(words)?;
            chart.draw_series(line.into_iter().map(|at| Circle::new(at, 3, series.color.filled()))).map_err(words)?;
        }
    }
    let thick: Vec<Series<'_>> = series.into_iter().filter(|series| !series.is_thin).collect();
    legend(root, &thick, false, false)?;
    for (index, mark) in marks.iter().enumerate() {
        let y = 330 + 22 * index as i32;
        let style = INK.stroke_width(if index == 0 { 2 } else { 1 });
        let step = if index == 0 { 24 } else { 4 };
        for x in (0..24).step_by(if index == 0 { 24 } else { 7 }) {
            root.draw(&PathElement::new([(LEGEND_X + x, y), (LEGEND_X + x + step, y)], style)).map_err(words)?;
        }
        root.draw(&Text::new((*mark).to_owned(), (LEGEND_X + 34, y), label())).map_err(words)?;
    }
    Ok(())
}

type Log = plotters::coord::combinators::LogCoord<f64>;
type Plot<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// A logarithmic axis with marks at 1, 2 and 5 of each power of ten.
struct Axis {
    log: Log,
    range: std::ops::Range<f64>,
}

impl Axis {
    fn new(range: std::ops::Range<f64>) -> Axis {
        Axis { log: range.clone().log_scale().into(), range }
    }
}

impl Ranged for Axis {
    type FormatOption = plotters::coord::ranged1d::NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.log.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        ticks(&self.range)
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.range.clone()
    }
}

impl plotters::coord::ranged1d::ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        tick_label(*value)
    }
}

/// Round numbers within a range; fewer of each power of ten where it spans many.
fn ticks(range: &std::ops::Range<f64>) -> Vec<f64> {
    let decades = (range.end / range.start).log10();
    let steps: &[f64] = if decades > 3.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let (first, last) = (range.start.log10().floor() as i32, range.end.log10().ceil() as i32);
    let all = (first..=last).flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power)));
    all.filter(|tick| *tick >= range.start * 0.999 && *tick <= range.end * 1.001).collect()
}

/// A tick as it is read: no noise of binary fractions, thousands parted.
fn tick_label(value: f64) -> String {
    if value >= 1000.0 {
        let digits = format!("{value:.0}");
        let mut text = String::new();
        for (index, digit) in digits.chars().enumerate() {
            if index > 0 && (digits.len() - index).is_multiple_of(3) {
                text.push(',');
            }
            text.push(digit);
        }
        return text;
    }
    let places = (-value.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{value:.places$}")
}

fn label() -> TextStyle<'static> {
    ("sans-serif", 14).into_font().color(&INK).pos(Pos::new(HPos::Left, VPos::Center))
}

/// Axes around all points.
fn plot<'a, 'b>(root: &'a Area<'b>, series: &[Series<'_>], titles: [&str; 2]) -> Result<Plot<'a, 'b>, String> {
    root.fill(&WHITE).map_err(words)?;
    let all =
        || series.iter().flat_map(|series| series.points.iter().map(|p| p.at).chain(series.parts.iter().copied()));
    let [x, y] = [0, 1].map(|axis| {
        let (min, max) = all().map(|at| at[axis]).fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
        // Nothing measured, or one value: an axis all the same.
        let (min, max) = if min <= max { (min, max) } else { (1.0, 10.0) };
        let room = (max / min).powf(0.05).max(1.15);
        (min / room)..(max * room)
    });
    let (left, _) = root.split_horizontally(LEGEND_X - 20);
    let mut chart = ChartBuilder::on(&left)
        .margin(16)
        .x_label_area_size(52)
        .y_label_area_size(72)
        .build_cartesian_2d(Axis::new(x), Axis::new(y))
        .map_err(words)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .label_style(("sans-serif", 13).into_font().color(&INK))
        .axis_desc_style(("sans-serif", 15).into_font().color(&INK))
        .x_desc(titles[0])
        .y_desc(titles[1])
        .draw()
        .map_err(words)?;
    Ok(chart)
}

/// What the colours and marks mean, to the right of the plot.
fn legend(root: &Area<'_>, series: &[Series<'_>], has_front: bool, has_published: bool) -> Result<(), String> {
    let mut y = 36;
    for series in series {
        let line = [(LEGEND_X, y), (LEGEND_X + 24, y)];
        root.draw(&PathElement::new(line, series.color.stroke_width(2))).map_err(words)?;
        root.draw(&Circle::new((LEGEND_X + 12, y), 5, series.color.filled())).map_err(words)?;
        root.draw(&Text::new(series.name.to_owned(), (LEGEND_X + 34, y), label())).map_err(words)?;
        y += 22;
    }
    if has_front {
        for x in [0, 12] {
            let dash = [(LEGEND_X + x, y), (LEGEND_X + x + 8, y)];
            root.draw(&PathElement::new(dash, INK.stroke_width(2))).map_err(words)?;
        }
        root.draw(&Text::new("Pareto front", (LEGEND_X + 34, y), label())).map_err(words)?;
        y += 24;
    }
    if has_published {
        root.draw(&Circle::new((LEGEND_X + 12, y), 9, INK.stroke_width(2))).map_err(words)?;
        root.draw(&Text::new("as published", (LEGEND_X + 34, y), label())).map_err(words)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few() {
        assert_eq!(ticks(&(0.9..22.0)), [1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!(ticks(&(0.5..30_000.0)).len(), 5);
        let labels = [0.002, 0.05, 1.0, 20.0, 1000.0, 300_000.0].map(tick_label);
        assert_eq!(labels, ["0.002", "0.05", "1", "20", "1,000", "300,000"]);
    }

    #[test]
    fn means_are_geometric() {
        let [x, y] = mean(&[[1.0, 10.0], [4.0, 1000.0]]);
        assert!((x - 2.0).abs() < 1e-12 && (y - 100.0).abs() < 1e-9);
    }
}
