//! Shapes for tests.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec3};

use super::{Assembly, RawMesh, RawPart, RawShape};
use crate::scene::Report;

/// Numbers from a seed.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, limit: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) % u64::from(limit.max(1))) as u32
    }

    /// From -1 to 1.
    pub fn signed(&mut self) -> f64 {
        f64::from(self.below(1 << 30)) / f64::from(1 << 29) - 1.0
    }
}

pub fn shape(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> RawShape {
    RawShape { positions, triangles, ..RawShape::default() }
}

/// Corners at -1 and 1, 8 vertices, 12 triangles.
pub fn cube() -> RawShape {
    let positions = (0..8).map(|i| DVec3::new(sign(i & 1), sign(i >> 1 & 1), sign(i >> 2))).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    shape(positions, quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

fn sign(bit: u32) -> f64 {
    if bit == 1 { 1.0 } else { -1.0 }
}

/// The same triangles, each with vertices of its own, as STL has them.
pub fn soup(raw: &RawShape) -> RawShape {
    let positions = raw.triangles.iter().flatten().map(|&index| raw.positions[index as usize]).collect();
    shape(positions, (0..raw.triangles.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect())
}

/// A grid of `columns` times `rows` quads, closed over its sides as told; `at` gives the vertices.
pub fn sheet(
    columns: u32,
    rows: u32,
    closed_columns: bool,
    closed_rows: bool,
    at: impl Fn(f64, f64) -> DVec3,
) -> RawShape {
    let (wide, high) = (columns + u32::from(!closed_columns), rows + u32::from(!closed_rows));
    let mut raw = RawShape::default();
    for row in 0..high {
        raw.positions.extend(
            (0..wide).map(|column| at(f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows))),
        );
    }
    let index = |column: u32, row: u32| row % high * wide + column % wide;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [index(column, row), index(column + 1, row)];
            let [c, d] = [index(column + 1, row + 1), index(column, row + 1)];
            raw.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    raw
}

/// A ring of radius 1, a tube of radius 0.3.
pub fn torus() -> RawShape {
    torus_of(48, 24)
}

pub fn torus_of(columns: u32, rows: u32) -> RawShape {
    sheet(columns, rows, true, true, |u, v| {
        let (out, up) = (1.0 + 0.3 * (v * TAU).cos(), 0.3 * (v * TAU).sin());
        DVec3::new((u * TAU).cos() * out, (u * TAU).sin() * out, up)
    })
}

/// Radius 1, with all vertices of a pole in one place.
pub fn sphere(columns: u32, rows: u32) -> RawShape {
    sheet(columns, rows, true, false, |u, v| {
        let (polar, around) = ((1.0 - v) * TAU / 2.0, u * TAU);
        let ring = if v == 0.0 || v == 1.0 { 0.0 } else { polar.sin() };
        DVec3::new(around.cos() * ring, around.sin() * ring, polar.cos())
    })
}

/// Radius 1, height 2, closed by fans.
pub fn cylinder(columns: u32) -> RawShape {
    let mut raw = sheet(columns, 1, true, false, |u, v| DVec3::new((u * TAU).cos(), (u * TAU).sin(), 2.0 * v - 1.0));
    let bottom = raw.positions.len() as u32;
    raw.positions.extend([DVec3::NEG_Z, DVec3::Z]);
    for column in 0..columns {
        let after = (column + 1) % columns;
        raw.triangles.push([bottom, after, column]);
        raw.triangles.push([bottom + 1, columns + column, columns + after]);
    }
    raw
}

/// A strip with half a twist.
pub fn moebius() -> RawShape {
    let mut raw = sheet(40, 2, false, false, |u, v| {
        let (across, half) = (v - 0.5, u * TAU / 2.0);
        let out = 1.0 + across * half.cos();
        DVec3::new((u * TAU).cos() * out, (u * TAU).sin() * out, across * half.sin())
    });
    // The last column is the first one, upside down.
    for corner in raw.triangles.as_flattened_mut() {
        if *corner % 41 == 40 {
            *corner = (2 - *corner / 41) * 41;
        }
    }
    raw
}

/// Hills.
pub fn terrain() -> RawShape {
    sheet(20, 20, false, false, |u, v| DVec3::new(u * 20.0, v * 20.0, (u * 9.0).sin() + (v * 7.0).cos()))
}

pub fn mapped(mut raw: RawShape, map: impl Fn(DVec3) -> DVec3) -> RawShape {
    raw.positions.iter_mut().for_each(|p| *p = map(*p));
    raw
}

/// Both in one shape.
pub fn joined(mut a: RawShape, b: RawShape) -> RawShape {
    let first = a.positions.len() as u32;
    a.positions.extend(b.positions);
    a.triangles.extend(b.triangles.into_iter().map(|triangle| triangle.map(|index| index + first)));
    a
}

/// With some triangles turned over.
pub fn turned(mut raw: RawShape, mut which: impl FnMut(usize) -> bool) -> RawShape {
    for (index, triangle) in raw.triangles.iter_mut().enumerate() {
        if which(index) {
            triangle.swap(1, 2);
        }
    }
    raw
}

pub fn part(shape: u32, file_from_shape: DAffine3) -> RawPart {
    RawPart { shape, material: None, name: "part".to_string(), path: "part".to_string(), file_from_shape }
}

pub fn build(shapes: Vec<RawShape>, parts: Vec<RawPart>) -> (Option<Assembly>, Report) {
    let mut report = Report::default();
    (Assembly::build(RawMesh { shapes, parts, materials: Vec::new() }, 0, &mut report), report)
}

/// The shape alone where it is.
pub fn build_one(raw: RawShape) -> (Assembly, Report) {
    let (assembly, report) = build(vec![raw], vec![part(0, DAffine3::IDENTITY)]);
    (assembly.expect("triangles"), report)
}
