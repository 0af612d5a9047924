//! Atoms of a crystal: fractions of the cell's edges, as listed or filling the cell.

use super::super::Import;
use super::super::models::Models;
use super::super::number::ABSURD;
use super::atom_site::{Columns, Site, SiteReader};
use super::cell::Cell;
use super::disorder;
use super::entry::Block;
use super::places::Places;
use super::symmetry::Operation;
use super::table::{Category, TableRows};
use crate::scene::builder::{MoleculeBuilder, NewAtom};
use crate::scene::error::SceneError;
use crate::scene::report::NoteKind;
use glam::DVec3;

/// The assembly that is the whole unit cell.
const WHOLE_CELL: &str = "cell";
/// Operations of the largest space groups.
const MAX_OPERATIONS: usize = 192;
/// Atoms that are made at most to fill a cell.
const MAX_ATOMS: usize = 4_000_000;

/// Adds the atoms of a block's table.
///
/// # Errors
/// `Malformed` without a cell, `NoSuchAssembly`, `Unsupported` for too many operations or atoms.
pub(super) fn read(
    import: &mut Import<'_>,
    block: &Block<'_>,
    columns: &Columns,
    rows: &mut TableRows<'_, '_>,
    models: &mut Models,
    builder: &mut MoleculeBuilder,
) -> Result<(), SceneError> {
    let mut reader = SiteReader::new(columns);
    let mut sites = Vec::new();
    while let Some(site) = reader.next(import, models, rows)? {
        sites.push(site);
    }
    if sites.is_empty() {
        return Ok(());
    }
    let table = block.table(Category::Cell);
    let cell = Cell::new(table).map_err(|what| {
        let what = format!("the atoms are measured in edges of the unit cell, but {what}; complete the cell");
        match table.line.or(block.table(Category::AtomSite).line) {
            Some(line) => import.malformed(line, what),
            None => SceneError::Unsupported { file: import.file.to_string(), what },
        }
    })?;
    let keep = disorder::choose(&sites, &cell);
    let num_dropped = keep.iter().filter(|&&keep| !keep).count();
    import.report.note_many(NoteKind::AlternateLocation, num_dropped as u32, String::new);
    let sites: Vec<Site<'_>> = sites.into_iter().zip(keep).filter(|(_, keep)| *keep).map(|(site, _)| site).collect();
    match import.options.assembly.as_deref() {
        None => sites.iter().for_each(|site| push(import, builder, &cell, &site.atom)),
        Some(WHOLE_CELL) => fill_cell(import, block, &cell, &sites, builder)?,
        Some(assembly) => {
            let (file, assembly) = (import.file.to_string(), assembly.to_string());
            return Err(SceneError::NoSuchAssembly { file, assembly, available: WHOLE_CELL.to_string() });
        }
    }
    Ok(())
}

/// Adds an atom whose position is in fractions; notes it if that leads nowhere.
fn push(import: &mut Import<'_>, builder: &mut MoleculeBuilder, cell: &Cell, atom: &NewAtom<'_>) {
    let position = cell.cartesian_from_fractional * atom.position;
    if position.abs().max_element() <= ABSURD {
        builder.push(&NewAtom { position, ..*atom });
    } else {
        import.report.note(NoteKind::BadCoordinate, None, || format!("{} lies beyond all space", atom.name));
    }
}

/// Adds all images of the atoms that lie in the cell, each once.
fn fill_cell(
    import: &mut Import<'_>,
    block: &Block<'_>,
    cell: &Cell,
    sites: &[Site<'_>],
    builder: &mut MoleculeBuilder,
) -> Result<(), SceneError> {
    let operations = operations(import, block);
    let too_many = |what: String| SceneError::Unsupported { file: import.file.to_string(), what };
    if operations.len() > MAX_OPERATIONS {
        let what = format!(
            "has {} symmetry operations, but no space group has more than {MAX_OPERATIONS}; leave --assembly away",
            operations.len()
        );
        return Err(too_many(what));
    }
    if operations.len() * sites.len() > MAX_ATOMS {
        let what = format!(
            "its unit cell has up to {} atoms, and {MAX_ATOMS} at most are filled in; leave --assembly away",
            operations.len() * sites.len()
        );
        return Err(too_many(what));
    }
    let mut places = Places::new(cell);
    for operation in &operations {
        for site in sites {
            let position = wrap(operation.apply(site.atom.position));
            if places.take(position).is_ok() {
                push(import, builder, cell, &NewAtom { position, ..site.atom });
            }
        }
    }
    Ok(())
}

/// The image of a point in the cell at the origin; a hair below an edge's end is its beginning.
fn wrap(point: DVec3) -> DVec3 {
    let wrapped = point - point.floor();
    DVec3::select(wrapped.cmpgt(DVec3::splat(1.0 - 1e-5)), DVec3::ZERO, wrapped)
}

/// The operations of a block, the identity first; what is none is noted.
fn operations(import: &mut Import<'_>, block: &Block<'_>) -> Vec<Operation> {
    let mut operations = vec![Operation::IDENTITY];
    let table = block.table(Category::SymmetryOperation);
    let column = ["as_xyz", "pos_as_xyz", "operation_xyz"].iter().find_map(|name| table.column(name));
    let Some(column) = column else { return operations };
    for (index, row) in table.rows().enumerate() {
        let Some(value) = row.get(column) else { continue };
        match Operation::parse(value.text()) {
            Some(operation) if operation == Operation::IDENTITY => {}
            Some(operation) => operations.push(operation),
            None => import.report.note(NoteKind::BadSymmetry, table.lines.get(index).copied(), || value.quoted()),
        }
    }
    operations
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, ModelChoice, NoteKind, Scene, SceneError};

    fn load(text: &str, assembly: Option<&str>) -> Result<Scene, SceneError> {
        let options = LoadOptions { assembly: assembly.map(str::to_string), ..LoadOptions::default() };
        Scene::from_bytes_with("t.cif", text.as_bytes(), &options)
    }

    const ROCK_SALT: &str = "data_NaCl\n_cell_length_a 5.64\n_cell_length_b 5.64\n_cell_length_c 5.64\n\
        loop_\n_symmetry_equiv_pos_as_xyz\nx,y,z\nx,y+1/2,z+1/2\nx+1/2,y,z+1/2\n'x+1/2, y+1/2, z'\n-x,-y,-z\n\
        loop_\n_atom_site_label\n_atom_site_type_symbol\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n\
        Na1 Na1+ 0 0 0\nCl1 Cl1- 0.5 0.5 0.5\n";

    #[test]
    fn the_list_is_drawn_and_the_cell_on_request() {
        let scene = load(ROCK_SALT, None).expect("two atoms");
        assert_eq!(scene.molecule.atoms.len(), 2);
        let [na, cl] = [0, 1].map(|index| &scene.molecule.atoms[index]);
        assert_eq!((na.element.symbol(), na.charge, cl.element.symbol(), cl.charge), ("Na", 1.0, "Cl", -1.0));
        let distance = na.position.distance(cl.position);
        assert!((distance - 2.82 * 3.0_f32.sqrt()).abs() < 1e-5, "{distance}");
        let cell = load(ROCK_SALT, Some("cell")).expect("a cell").molecule;
        assert_eq!((cell.atoms.len(), cell.bonds.len()), (8, 0), "special positions once, no bonds of ions");
    }

    #[test]
    fn another_assembly_says_what_there_is() {
        let error = load(ROCK_SALT, Some("1")).expect_err("no assembly 1");
        assert_eq!(error.to_string(), "t.cif: has no assembly 1; it has cell");
    }

    #[test]
    fn without_a_cell_fractions_are_refused() {
        let message = load(&ROCK_SALT.replace("_cell_length_b 5.64\n", ""), None).expect_err("no cell").to_string();
        assert!(message.starts_with("t.cif:2: the atoms are measured in edges"), "{message}");
        assert!(message.ends_with("_cell_length_b is \"?\", no length in angstrom; complete the cell"), "{message}");
    }

    #[test]
    fn blocks_are_models() {
        let text = format!("{ROCK_SALT}{}", ROCK_SALT.replace("5.64", "6.0"));
        let scene = load(&text, None).expect("the first block");
        assert_eq!((scene.molecule.atoms.len(), scene.files[0].report.count(NoteKind::ModelSkipped)), (2, 1));
        let options = LoadOptions { model: ModelChoice::Number(2), ..LoadOptions::default() };
        let second = Scene::from_bytes_with("t.cif", text.as_bytes(), &options).expect("the second block").molecule;
        assert!((second.atoms[0].position.distance(second.atoms[1].position) - 3.0 * 3.0_f32.sqrt()).abs() < 1e-5);
    }

    #[test]
    fn one_place_of_a_disordered_group_and_one_atom_of_a_mixed_site_are_drawn() {
        let text = "data_x\n_cell_length_a 10\n_cell_length_b 10\n_cell_length_c 10\nloop_\n_atom_site_label\n\
            _atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n_atom_site_occupancy\n\
            _atom_site_disorder_assembly\n_atom_site_disorder_group\n\
            C1 0 0 0 1 . .\nC2A .1 0 0 0.4 A 1\nC2B .1 .1 0 0.6 A 2\nO1 .5 .5 .5 0.5 B 1\nO2 .5 .6 .5 0.5 B 2\n\
            Mg1 .3 .3 .3 0.3 . .\nFe1 .3 .3 .3 0.7 . .\nN1 .7 .7 .7 0.5 . -1\n";
        let scene = load(text, None).expect("a scene");
        let names: Vec<&str> = scene.molecule.atoms.iter().map(|atom| atom.name.as_str()).collect();
        assert_eq!(names, ["C1", "C2B", "O1", "Fe1", "N1"]);
        assert_eq!(scene.files[0].report.count(NoteKind::AlternateLocation), 3);
    }

    #[test]
    fn bad_operations_are_noted_with_their_line() {
        let scene = load(&ROCK_SALT.replace("-x,-y,-z", "-x,-y,-w"), Some("cell")).expect("a cell");
        assert_eq!(scene.molecule.atoms.len(), 8);
        let report = scene.files[0].report.to_string();
        assert!(report.contains("(line 11: \"-x,-y,-w\")"), "{report}");
    }
}
