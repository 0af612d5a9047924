//! `geometry`: how large atoms and bonds are drawn.

use super::length::Length;
use super::param::{Param, Value};
use super::values::Values;

/// The keys of `geometry`.
pub const PARAMS: &[Param] = &[
    Param::choice_or_length("atom", &["vdw", "covalent"], "vdw")
        .doc("Radius of atoms: of the element, or one for all.")
        .examples(&[r#""vdw""#, r#""covalent""#, r#""1.5A""#]),
    Param::number("scale", 0.25)
        .range(0.001, 100.0)
        .doc("Atoms are drawn this many times their radius.")
        .examples(&["0.12", "0.25", "1"]),
    Param::length("bond_radius", "0.14A").doc("Radius of connectors.").examples(&[
        r#""0.05A""#,
        r#""0.14A""#,
        r#""0.3A""#,
    ]),
    Param::boolean("bond_orders", false).doc("Draws double and triple bonds as such.").examples(&["false", "true"]),
    Param::choice("file_unit", FILE_UNITS, "mm")
        .doc("What a unit of length in mesh files is.")
        .examples(&[r#""mm""#, r#""inch""#]),
];

/// The words of `file_unit`.
const FILE_UNITS: &[&str] = &["A", "nm", "um", "mm", "cm", "m", "inch"];

/// One unit of each of [`FILE_UNITS`] in millimetres.
const FILE_UNITS_MM: [f64; 7] = [1e-7, 1e-6, 1e-3, 1.0, 10.0, 1000.0, 25.4];

/// Where the radius of an atom comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AtomRadius {
    /// Van der Waals radius of the element.
    Vdw,
    /// Covalent radius of the element.
    Covalent,
    /// The same for all.
    Length(Length),
}

/// The geometry of a style.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Where the radius of an atom comes from.
    pub atom: AtomRadius,
    /// Factor on it.
    pub scale: f64,
    /// Radius of connectors.
    pub bond_radius: Length,
    /// Whether double and triple bonds are drawn as such.
    pub bond_orders: bool,
    /// A unit of mesh files in millimetres.
    pub file_unit_mm: f64,
}

impl Geometry {
    /// The geometry that the values of [`PARAMS`] describe.
    pub fn new(values: &Values) -> Self {
        let atom = match values.get("atom") {
            Some(Value::Length(length)) => AtomRadius::Length(*length),
            _ => [AtomRadius::Vdw, AtomRadius::Covalent][values.choice_index("atom")],
        };
        Self {
            atom,
            scale: values.number("scale"),
            bond_radius: values.length("bond_radius"),
            bond_orders: values.boolean("bond_orders"),
            file_unit_mm: FILE_UNITS_MM[values.choice_index("file_unit")],
        }
    }
}
