//! Control points: read, checked, and joined by straight lines.

use super::{Between, COLOR_SIZE, MAX_POINTS, Nodes, OPACITY_SIZE, Transfer, TransferKind, Written};
use crate::config::error::Problem;
use crate::config::hint;
use crate::config::read::{Wrong, wrong_type, wrong_type_but};
use crate::config::syntax::{Node, Tree};

/// What is wrong with a point beside another one, and what ends it.
const FALLING: &str = "this curvature is below that of the point before it: put the points in order of curvature";
const EQUAL: &str =
    "this curvature is that of the point before it: keep one of the two, or move one by 0.02 to make a step";
const MIXED: &str = "this point has more or fewer numbers than the first one: give all points of a list the same count";

/// Reads a list of control points, the value of the parameter `name`.
pub(in crate::config) fn read(kind: TransferKind, name: &str, node: &Node, items: &[Node]) -> Result<Transfer, Wrong> {
    if items.is_empty() || items.len() > MAX_POINTS {
        let expected = format!("a list of 1 to {MAX_POINTS} points {}", kind.point_forms().join(" or "));
        return Err((node.span, wrong_type(name, &expected, node)));
    }
    if let Some(point) = bare_point(kind, items) {
        let expected = format!("a list of points {}", kind.point_forms().join(" or "));
        return Err((node.span, wrong_type_but(name, &expected, node, Some(format!("[{point}]")))));
    }
    let mut points: Vec<Vec<f64>> = Vec::with_capacity(items.len());
    for item in items {
        let point = read_point(kind, name, item)?;
        if let Some(before) = points.last() {
            if point.len() != before.len() {
                return Err((item.span, Problem::Meaningless(MIXED)));
            }
            if point[0] <= before[0] {
                let problem = if point[0] < before[0] { FALLING } else { EQUAL };
                return Err((numbers(item)[0].span, Problem::Meaningless(problem)));
            }
        }
        points.push(point);
    }
    let nodes = nodes(kind, &points);
    Ok(Transfer::new(Written::Points(points.into()), nodes))
}

/// The items of a list; none of anything else.
fn numbers(node: &Node) -> &[Node] {
    match &node.value {
        Tree::List(items) => items,
        _ => &[],
    }
}

/// One point whose own brackets stand for those of the list, as it was meant.
fn bare_point(kind: TransferKind, items: &[Node]) -> Option<String> {
    let number = |item: &Node| match item.value {
        Tree::Number(number) => Some(hint::number(number)),
        _ => None,
    };
    let numbers: Vec<String> = items.iter().map(number).collect::<Option<_>>()?;
    kind.widths().contains(&numbers.len()).then(|| format!("[{}]", numbers.join(", ")))
}

/// Reads one point: as many numbers as the kind allows, in their ranges.
fn read_point(kind: TransferKind, name: &str, node: &Node) -> Result<Vec<f64>, Wrong> {
    let items = numbers(node);
    if !kind.widths().contains(&items.len()) {
        let expected = format!("a list of points {}", kind.point_forms().join(" or "));
        return Err((node.span, wrong_type(name, &expected, node)));
    }
    let mut point = Vec::with_capacity(items.len());
    for (i, item) in items.iter().enumerate() {
        let Tree::Number(number) = item.value else {
            let expected = format!("points of numbers {}", kind.point_forms().join(" or "));
            return Err((item.span, wrong_type(name, &expected, item)));
        };
        let ((lowest, highest), what) = match (i, kind) {
            (0, TransferKind::Opacity) => (kind.curvatures(), "a curvature without its sign"),
            (0, TransferKind::Color) => (kind.curvatures(), "a curvature"),
            (_, TransferKind::Opacity) => (kind.values(), "an opacity"),
            (_, TransferKind::Color) => (kind.values(), "a factor"),
        };
        if !(lowest..=highest).contains(&number) {
            let allowed = format!("lie in {lowest} to {highest}, being {what}");
            return Err((item.span, Problem::OutOfRange { name: name.to_owned(), value: number, allowed }));
        }
        point.push(number);
    }
    Ok(point)
}

/// The nodes of control points, which are in order and at least one; before the first and after the last, its values.
pub(super) fn nodes<P: AsRef<[f64]>>(kind: TransferKind, points: &[P]) -> Nodes {
    match kind {
        TransferKind::Opacity => {
            let [columns, rows] = OPACITY_SIZE;
            let across: Vec<Vec<f64>> = (0..columns).map(|i| values_at(points, share(i, columns))).collect();
            let at = |row: usize, values: &Vec<f64>| match values.as_slice() {
                [one] => *one,
                many => {
                    let between = Between::new(share(row, rows), many.len());
                    between.mix(many[between.low], many[between.low + 1])
                }
            };
            Nodes::Opacity((0..rows).flat_map(|row| across.iter().map(move |values| at(row, values) as f32)).collect())
        }
        TransferKind::Color => {
            let at = |i| match values_at(points, share(i, COLOR_SIZE) * 2.0 - 1.0).as_slice() {
                [r, g, b] => [*r, *g, *b].map(|value| value as f32),
                all => [all[0] as f32; 3],
            };
            Nodes::Color((0..COLOR_SIZE).map(at).collect())
        }
    }
}

/// How far along a row of nodes one lies, from 0 to 1.
fn share(index: usize, count: usize) -> f64 {
    index as f64 / (count - 1) as f64
}

/// The values at a curvature, by a straight line between the points on either side.
fn values_at<P: AsRef<[f64]>>(points: &[P], curvature: f64) -> Vec<f64> {
    let above = points.partition_point(|point| point.as_ref()[0] <= curvature);
    let (low, high) = (points[above.max(1) - 1].as_ref(), points[above.min(points.len() - 1)].as_ref());
    let width = high[0] - low[0];
    // Before the first point and after the last one, both are the same.
    let share = if width > 0.0 { (curvature - low[0]) / width } else { 0.0 };
    low[1..].iter().zip(&high[1..]).map(|(low, high)| low + (high - low) * share).collect()
}
