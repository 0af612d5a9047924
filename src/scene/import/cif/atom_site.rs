//! The table of atoms, `atom_site`: its columns by name, in any order, and its rows one by one.

use super::super::number::ABSURD;
use super::super::{Import, models::Models};
use super::rows::{RowFault, Rows};
use super::symbol;
use super::table::find;
use super::value::Value;
use crate::scene::builder::NewAtom;
use crate::scene::element::Element;
use crate::scene::error::SceneError;
use crate::scene::name::Name;
use crate::scene::report::NoteKind;
use glam::DVec3;
use std::f64::consts::PI;

/// What the coordinates are measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::scene::import) enum Axes {
    /// Angstrom.
    Cartesian,
    /// The edges of the unit cell.
    Fractional,
}

/// Where the columns are. Names that authors gave go before those of the archive (`auth_` before `label_`).
#[derive(Debug)]
pub(in crate::scene::import) struct Columns {
    pub(in crate::scene::import) axes: Axes,
    coordinates: [usize; 3],
    group: Option<usize>,
    type_symbol: Option<usize>,
    /// The first that there is of the names that the pair may have.
    name: [Option<usize>; 2],
    residue_name: [Option<usize>; 2],
    chain: [Option<usize>; 2],
    residue_number: [Option<usize>; 2],
    label_chain: Option<usize>,
    insertion_code: Option<usize>,
    alt_loc: Option<usize>,
    occupancy: Option<usize>,
    b_factor: Option<usize>,
    u_factor: Option<usize>,
    charge: Option<usize>,
    model: Option<usize>,
    disorder_group: Option<usize>,
    disorder_assembly: Option<usize>,
    calculation: Option<usize>,
}

impl Columns {
    /// The columns of a table; the name of the one that is missing if it has no coordinates.
    pub(in crate::scene::import) fn new(names: &[&[u8]]) -> Result<Self, &'static str> {
        let column = |name| find(names, name);
        let three = |[x, y, z]: [&'static str; 3]| -> Result<[usize; 3], &'static str> {
            Ok([column(x).ok_or(x)?, column(y).ok_or(y)?, column(z).ok_or(z)?])
        };
        let cartesian = three(["Cartn_x", "Cartn_y", "Cartn_z"]);
        let (axes, coordinates) = match three(["fract_x", "fract_y", "fract_z"]) {
            Ok(fractional) if cartesian.is_err() => (Axes::Fractional, fractional),
            _ => (Axes::Cartesian, cartesian?),
        };
        let label_chain = column("label_asym_id");
        Ok(Self {
            axes,
            coordinates,
            group: column("group_PDB"),
            type_symbol: column("type_symbol"),
            name: [column("auth_atom_id"), column("label_atom_id").or_else(|| column("label"))],
            residue_name: [column("auth_comp_id"), column("label_comp_id")],
            chain: [column("auth_asym_id"), label_chain],
            residue_number: [column("auth_seq_id"), column("label_seq_id")],
            label_chain: label_chain.or_else(|| column("auth_asym_id")),
            insertion_code: column("pdbx_PDB_ins_code"),
            alt_loc: column("label_alt_id"),
            occupancy: column("occupancy"),
            b_factor: column("B_iso_or_equiv"),
            u_factor: column("U_iso_or_equiv"),
            charge: column("pdbx_formal_charge"),
            model: column("pdbx_PDB_model_num"),
            disorder_group: column("disorder_group"),
            disorder_assembly: column("disorder_assembly"),
            calculation: column("calc_flag"),
        })
    }
}

/// A row of the table.
pub(in crate::scene::import) struct Site<'a> {
    /// The atom; its position is measured as [`Columns::axes`] says.
    pub(super) atom: NewAtom<'a>,
    /// The chain as the archive counts them (`label_asym_id`), which assemblies name.
    pub(super) label_chain: &'a [u8],
    /// Which of the places of a disordered group it belongs to, and which group that is; empty where it is ordered.
    pub(super) disorder: (&'a [u8], &'a [u8]),
}

/// Reads rows of one table.
pub(in crate::scene::import) struct SiteReader<'c> {
    columns: &'c Columns,
    /// The model number of the row before.
    model: Option<Option<i64>>,
}

impl<'c> SiteReader<'c> {
    pub(in crate::scene::import) fn new(columns: &'c Columns) -> Self {
        Self { columns, model: None }
    }

    /// The next atom that is wanted and usable; none at the end.
    ///
    /// # Errors
    /// `Malformed` where values are shifted, or a coordinate is a number that no picture can hold.
    pub(super) fn next<'a>(
        &mut self,
        import: &mut Import<'_>,
        models: &mut Models,
        rows: &mut impl Rows<'a>,
    ) -> Result<Option<Site<'a>>, SceneError> {
        while rows.advance(&mut import.report).map_err(|fault| uneven(import, fault))? {
            self.begin_model(import, models, rows);
            let Some(model) = models.atom() else { continue };
            if let Some(site) = self.site(import, rows, model)? {
                return Ok(Some(site));
            }
        }
        Ok(None)
    }

    /// Begins a model where the row's number is not that of the row before.
    fn begin_model<'a>(&mut self, import: &mut Import<'_>, models: &mut Models, rows: &impl Rows<'a>) {
        let number = self.columns.model.and_then(|column| rows.value(column).integer());
        match self.model {
            Some(last) if last == number => return,
            Some(Some(last)) if number.is_none_or(|number| number < last) => {
                import.report.note(NoteKind::ModelMended, rows.line(), || format!("its number follows on {last}"));
            }
            _ => {}
        }
        self.model = Some(number);
        models.begin(number.and_then(|number| u32::try_from(number).ok()));
    }

    /// The atom of a row, or none, with a note, if its position is unusable.
    fn site<'a>(
        &self,
        import: &mut Import<'_>,
        rows: &impl Rows<'a>,
        model: u32,
    ) -> Result<Option<Site<'a>>, SceneError> {
        let columns = self.columns;
        let value = |column: Option<usize>| column.map_or(Value::Missing, |column| rows.value(column));
        let either = |pair: [Option<usize>; 2]| match value(pair[0]) {
            Value::Missing => value(pair[1]),
            value => value,
        };
        let group = value(columns.group).text();
        let is_hetero = group.eq_ignore_ascii_case(b"HETATM");
        if rows.is_suspect() && columns.group.is_some() && !is_hetero && !group.eq_ignore_ascii_case(b"ATOM") {
            return Err(shifted(import, rows, "group_PDB", value(columns.group)));
        }
        if value(columns.calculation).text().eq_ignore_ascii_case(b"dum") {
            return Ok(None);
        }
        let Some(position) = self.position(import, rows)? else { return Ok(None) };
        let name = either(columns.name).text();
        let residue_name = Name::new(either(columns.residue_name).text());
        let (element, charge) = element(import, rows, value(columns.type_symbol).text(), name, residue_name);
        let residue_number = either(columns.residue_number);
        let number = residue_number.integer().and_then(|number| i32::try_from(number).ok());
        if number.is_none() && residue_number != Value::Missing {
            import.report.note(NoteKind::BadResidueNumber, rows.line(), || residue_number.quoted());
        }
        let b_factor = value(columns.b_factor).finite();
        // B = 8 pi^2 U.
        let b_factor = b_factor.or_else(|| Some(value(columns.u_factor).finite()? * 8.0 * PI * PI));
        let atom = NewAtom {
            position,
            element,
            name: Name::new(name),
            alt_loc: value(columns.alt_loc).letter(),
            occupancy: value(columns.occupancy).finite().unwrap_or(1.0) as f32,
            residue_name,
            residue_number: number.unwrap_or(0),
            insertion_code: value(columns.insertion_code).letter(),
            is_hetero,
            chain: either(columns.chain).text(),
            model,
            b_factor: b_factor.unwrap_or(0.0) as f32,
            charge: value(columns.charge).finite().map_or(charge, |charge| charge as f32),
        };
        let disorder = (value(columns.disorder_group).text(), value(columns.disorder_assembly).text());
        Ok(Some(Site { atom, label_chain: value(columns.label_chain).text(), disorder }))
    }

    /// The coordinates of a row; none, with a note, if one is no number.
    fn position<'a>(&self, import: &mut Import<'_>, rows: &impl Rows<'a>) -> Result<Option<DVec3>, SceneError> {
        let mut position = DVec3::ZERO;
        for (axis, &column) in self.columns.coordinates.iter().enumerate() {
            let value = rows.value(column);
            let name = ["x", "y", "z"][axis];
            match (value.float(), rows.line()) {
                (Some(number), _) if number.is_finite() && number.abs() <= ABSURD => position[axis] = number,
                (Some(number), Some(line)) if number.is_finite() => {
                    let what = format!(
                        "{name} = {} is no position in angstrom; correct it or delete the line",
                        value.quoted()
                    );
                    return Err(import.malformed(line, what));
                }
                (None, _) if rows.is_suspect() && value != Value::Missing => {
                    return Err(shifted(import, rows, name, value));
                }
                (_, line) => {
                    import.report.note(NoteKind::BadCoordinate, line, || {
                        let row = if line.is_none() { format!("row {}: ", rows.number()) } else { String::new() };
                        format!("{row}{name} = {}", value.quoted())
                    });
                    return Ok(None);
                }
            }
        }
        Ok(Some(position))
    }
}

/// The element and charge of an atom: as its type says, else as its name suggests.
fn element<'a>(
    import: &mut Import<'_>,
    rows: &impl Rows<'a>,
    type_symbol: &[u8],
    name: &[u8],
    residue_name: Name,
) -> (Element, f32) {
    let (element, charge) = match type_symbol {
        [letter] => (Element::from_symbol(&[*letter]).unwrap_or_default(), 0.0),
        symbol => symbol::from_type_symbol(symbol),
    };
    if element.is_known() {
        return (element, charge);
    }
    let residue = residue_name.as_str();
    let guessed = if residue.is_empty() { symbol::from_label(name) } else { symbol::from_name(name, residue) };
    let kind = match (guessed.is_known(), type_symbol) {
        (false, _) => NoteKind::ElementUnknown,
        (true, []) => NoteKind::ElementGuessed,
        (true, _) => NoteKind::ElementCorrected,
    };
    import.report.note(kind, rows.line(), || match kind {
        NoteKind::ElementGuessed => String::new(),
        NoteKind::ElementCorrected => format!("{} taken as {}", Value::Text(type_symbol).quoted(), guessed.symbol()),
        _ => Value::Text(if name.is_empty() { type_symbol } else { name }).quoted(),
    });
    (guessed, charge)
}

/// The error of a table whose values are no whole number of rows.
pub(super) fn uneven(import: &Import<'_>, fault: RowFault) -> SceneError {
    let RowFault { line, num_values, num_columns } = fault;
    let what = format!(
        "the table of atoms ends within a row: {num_values} of {num_columns} values; add the missing ones, or write each row on \
         a line of its own so that the damaged one can be found"
    );
    import.malformed(line, what)
}

/// The error of a value that cannot stand in its column.
fn shifted<'a>(import: &Import<'_>, rows: &impl Rows<'a>, column: &str, value: Value<'_>) -> SceneError {
    let what = format!(
        "found {} where {column} belongs; a value is missing or too much, here or in a row before: add or delete it",
        value.quoted()
    );
    import.malformed(rows.line().unwrap_or(1), what)
}
