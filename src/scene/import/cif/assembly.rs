//! Biological assemblies: copies of chains, placed by the operations of the file.

use super::super::lines::quote;
use super::entry::Block;
use super::operators::{self, MAX_COPIES};
use super::table::{Category, at};
use crate::scene::builder::NewCopy;
use crate::scene::error::SceneError;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Atoms in all copies together.
const MAX_COPIED_ATOMS: usize = 100_000_000;
/// Ranges of atoms in all copies together, of 8 bytes each.
const MAX_RANGES: usize = 4_000_000;
/// Ids that a message lists.
const LISTED_IDS: usize = 20;

/// Which atoms belong to which chain, as the archive counts chains.
#[derive(Debug, Default)]
pub(super) struct ChainRuns {
    index: HashMap<Vec<u8>, u32>,
    last: Vec<u8>,
    /// Neighbours of one chain: its index and the atoms.
    runs: Vec<(u32, Range<u32>)>,
}

impl ChainRuns {
    /// Adds the next atom.
    pub(super) fn push(&mut self, atom: u32, chain: &[u8]) {
        if let Some((_, range)) = self.runs.last_mut()
            && self.last == chain
            && range.end == atom
        {
            range.end += 1;
            return;
        }
        let next = self.index.len() as u32;
        let index = match self.index.get(chain) {
            Some(&index) => index,
            None => *self.index.entry(chain.to_vec()).or_insert(next),
        };
        self.last.clear();
        self.last.extend_from_slice(chain);
        self.runs.push((index, atom..atom + 1));
    }

    /// The atoms of a list of chains within a range, neighbours joined.
    fn of_chains(&self, list: &[u8], within: &Range<u32>) -> Vec<Range<u32>> {
        let names = list.split(|&byte| byte == b',').map(<[u8]>::trim_ascii);
        let wanted: HashSet<u32> = names.filter_map(|name| self.index.get(name).copied()).collect();
        let mut ranges: Vec<Range<u32>> = Vec::new();
        let runs = self.runs.iter().filter(|(chain, _)| list.is_empty() || wanted.contains(chain));
        for (_, run) in runs.filter(|(_, run)| run.start >= within.start && run.end <= within.end) {
            match ranges.last_mut() {
                Some(last) if last.end == run.start => last.end = run.end,
                _ => ranges.push(run.clone()),
            }
        }
        ranges
    }
}

/// The copies of an assembly of a block whose atoms are `atoms`.
///
/// # Errors
/// `NoSuchAssembly`; `Unsupported` if the copies are too many or the file contradicts itself.
pub(super) fn copies(
    file: &str,
    assembly: &str,
    block: &Block<'_>,
    runs: &ChainRuns,
    atoms: Range<u32>,
) -> Result<Vec<NewCopy>, SceneError> {
    let table = block.table(Category::AssemblyGenerator);
    let columns = ["assembly_id", "oper_expression", "asym_id_list"].map(|name| table.column(name));
    let generators: Vec<_> = table.rows().map(|row| columns.map(|column| at(row, column).to_text())).collect();
    let fail = |what: String| SceneError::Unsupported {
        file: file.to_string(),
        what: format!("assembly {assembly} {what}; leave --assembly away to draw the deposited atoms"),
    };
    let wanted: Vec<_> = generators.iter().filter(|[id, ..]| &**id == assembly.as_bytes()).collect();
    if wanted.is_empty() {
        let mut ids: Vec<String> = Vec::new();
        for [id, ..] in &generators {
            let id = plain(id);
            if ids.len() <= LISTED_IDS && !ids.contains(&id) {
                ids.push(id);
            }
        }
        let available = match ids.len() {
            0 => "none".to_string(),
            count if count > LISTED_IDS => format!("{}, ...", ids[..LISTED_IDS].join(", ")),
            _ => ids.join(", "),
        };
        let (file, assembly) = (file.to_string(), assembly.to_string());
        return Err(SceneError::NoSuchAssembly { file, assembly, available });
    }
    let operators = operators(block).map_err(fail)?;
    let (mut copies, mut num_atoms, mut num_ranges) = (Vec::new(), 0_usize, 0_usize);
    for [_, expression, chains] in wanted {
        let products =
            operators::products(expression).map_err(|what| fail(format!("has an operator expression that {what}")))?;
        let ranges = runs.of_chains(chains, &atoms);
        let size: usize = ranges.iter().map(ExactSizeIterator::len).sum();
        num_atoms = num_atoms.saturating_add(size.saturating_mul(products.len()));
        num_ranges = num_ranges.saturating_add(ranges.len().saturating_mul(products.len()));
        if copies.len() + products.len() > MAX_COPIES {
            return Err(fail(format!("has more than {MAX_COPIES} copies")));
        }
        if num_atoms > MAX_COPIED_ATOMS || num_ranges > MAX_RANGES {
            return Err(fail(format!("has {num_atoms} atoms in {num_ranges} pieces, more than are drawn")));
        }
        for product in products.iter().filter(|_| !ranges.is_empty()) {
            let mut place = DAffine3::IDENTITY;
            for id in product {
                let operator = operators
                    .get(id.as_slice())
                    .ok_or_else(|| fail(format!("needs an operation {} that the file lacks", plain(id))))?;
                place *= *operator;
            }
            copies.push(NewCopy { atoms: ranges.clone(), place });
        }
    }
    if copies.is_empty() {
        return Err(fail("is made of chains that have no atoms here".to_string()));
    }
    Ok(copies)
}

/// An id in a message.
fn plain(id: &[u8]) -> String {
    quote(id).trim_matches('"').to_string()
}

/// The operations of a block by their ids.
///
/// # Errors
/// What is wrong with one, in words.
fn operators(block: &Block<'_>) -> Result<HashMap<Vec<u8>, DAffine3>, String> {
    let table = block.table(Category::Operator);
    let id = table.column("id");
    let element = |row: usize, column: usize| table.column(&format!("matrix[{row}][{column}]"));
    let rows = [1, 2, 3].map(|row| [1, 2, 3].map(|column| element(row, column)));
    let vector = [1, 2, 3].map(|row| table.column(&format!("vector[{row}]")));
    let mut operators = HashMap::new();
    for row in table.rows() {
        let number = |column: Option<usize>| at(row, column).finite().unwrap_or(f64::NAN);
        let [x, y, z] = rows.map(|columns| DVec3::from(columns.map(number)));
        let matrix = DMat3::from_cols(x, y, z).transpose();
        let shift = DVec3::from(vector.map(number));
        let id = at(row, id).to_text().into_owned();
        let error = (matrix * matrix.transpose() - DMat3::IDENTITY).to_cols_array();
        let is_rigid = error.iter().all(|error| error.abs() < 0.01) && shift.abs().max_element() < 1e9;
        if !is_rigid {
            return Err(format!("has an operation {} that is no rotation and shift", plain(&id)));
        }
        operators.entry(id).or_insert(DAffine3::from_mat3_translation(matrix, shift));
    }
    Ok(operators)
}

#[cfg(test)]
mod tests {
    use crate::scene::{LoadOptions, Scene, SceneError};
    use glam::Vec3;

    /// Three chains; operation 2 turns by a right angle about z, 3 shifts by 10 along x.
    const TEXT: &str = "data_x\nloop_\n_pdbx_struct_assembly_gen.assembly_id\n_pdbx_struct_assembly_gen.oper_expression\n\
        _pdbx_struct_assembly_gen.asym_id_list\n1 1,2 A\n1 3 C\n2 (3)(2) A,B\nbig (1-100)(1-101) A\nlost 9 A\nvoid 1 Z\n\
        loop_\n_pdbx_struct_oper_list.id\n_pdbx_struct_oper_list.matrix[1][1]\n_pdbx_struct_oper_list.matrix[1][2]\n\
        _pdbx_struct_oper_list.matrix[1][3]\n_pdbx_struct_oper_list.vector[1]\n_pdbx_struct_oper_list.matrix[2][1]\n\
        _pdbx_struct_oper_list.matrix[2][2]\n_pdbx_struct_oper_list.matrix[2][3]\n_pdbx_struct_oper_list.vector[2]\n\
        _pdbx_struct_oper_list.matrix[3][1]\n_pdbx_struct_oper_list.matrix[3][2]\n_pdbx_struct_oper_list.matrix[3][3]\n\
        _pdbx_struct_oper_list.vector[3]\n1 1 0 0 0 0 1 0 0 0 0 1 0\n2 0 -1 0 0 1 0 0 0 0 0 1 0\n3 1 0 0 10 0 1 0 0 0 0 1 0\n\
        loop_\n_atom_site.id\n_atom_site.label_asym_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n\
        1 A 1 0 0\n2 B 2 0 0\n3 C 3 0 0\n";

    fn load(assembly: Option<&str>) -> Result<Scene, SceneError> {
        let options = LoadOptions { assembly: assembly.map(str::to_string), ..LoadOptions::default() };
        Scene::from_bytes_with("t.cif", TEXT.as_bytes(), &options)
    }

    /// Where the atoms are drawn, in the file's coordinates.
    fn drawn(assembly: Option<&str>) -> Vec<[i32; 3]> {
        let molecule = load(assembly).expect("a scene").molecule;
        let place = |(center, _): (Vec3, f32)| (center.as_dvec3() + molecule.origin).round().as_ivec3().to_array();
        molecule.drawn_balls().map(place).collect()
    }

    #[test]
    fn copies_stand_where_their_operations_say() {
        assert_eq!(drawn(None), [[1, 0, 0], [2, 0, 0], [3, 0, 0]]);
        assert_eq!(drawn(Some("1")), [[1, 0, 0], [0, 1, 0], [13, 0, 0]]);
        // Turned first, then shifted.
        assert_eq!(drawn(Some("2")), [[10, 1, 0], [10, 2, 0]]);
        let molecule = load(Some("2")).expect("a scene").molecule;
        let ranges = &molecule.copies[0].atoms;
        assert_eq!((molecule.copies.len(), ranges.len(), ranges[0].clone()), (1, 1, 0..2));
    }

    #[test]
    fn what_cannot_be_made_says_why() {
        let message = |assembly| load(Some(assembly)).expect_err("refused").to_string();
        assert_eq!(message("9"), "t.cif: has no assembly 9; it has 1, 2, big, lost, void");
        assert!(
            message("big").starts_with("t.cif: assembly big has an operator expression that means more than 10000")
        );
        assert!(message("lost").contains("needs an operation 9 that the file lacks; leave --assembly away"));
        assert!(message("void").contains("chains that have no atoms"));
    }
}
