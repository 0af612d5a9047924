//! Bonds that the file names: between residues (`struct_conn`) and within them (`chem_comp_bond`).

use super::entry::Block;
use super::table::{Category, at};
use super::value::Value;
use crate::scene::bonds::FileBond;
use crate::scene::builder::MoleculeBuilder;
use crate::scene::molecule::Atom;
use crate::scene::name::Name;
use crate::scene::report::{NoteKind, Report};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// Slack over the sum of covalent radii for a metal's contact, in angstrom: coordination bonds are longer than others, and
/// what is farther is a contact that the file lists for completeness.
const METAL_TOLERANCE: f64 = 0.6;
/// Bonds of one atom to others of its residue. Ours: chemistry needs 12.
const MAX_PARTNERS: usize = 16;
/// Alternate locations of one atom that are bonded.
const MAX_ALTERNATES: usize = 8;

/// All bonds of a block between its atoms.
pub(super) fn of_block(
    block: &Block<'_>,
    builder: &MoleculeBuilder,
    atoms: Range<u32>,
    report: &mut Report,
) -> Vec<FileBond> {
    let mut bonds = between_residues(block, builder, atoms.clone(), report);
    within_residues(block, builder, atoms, &mut bonds);
    bonds
}

/// 1, 2 or 3 for the words that the archive has.
fn order(value: Value<'_>) -> u8 {
    let is = |word: &[u8]| value.text().get(..4).is_some_and(|start| start.eq_ignore_ascii_case(word));
    if is(b"doub") {
        2
    } else if is(b"trip") {
        3
    } else {
        1
    }
}

/// A residue as `struct_conn` names it: chain, number, insertion code.
type ResidueKey = (u32, i32, u8);

/// An atom that `struct_conn` names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Partner {
    residue: ResidueKey,
    residue_name: Name,
    atom: Name,
    alt_loc: u8,
}

/// Columns of one of the two partners, as authors and as the archive name it.
struct PartnerColumns {
    chain: [Option<usize>; 2],
    number: [Option<usize>; 2],
    residue_name: [Option<usize>; 2],
    atom: Option<usize>,
    alt_loc: Option<usize>,
    insertion_code: Option<usize>,
    symmetry: Option<usize>,
}

/// A bond of the table.
struct Connection {
    ends: [u32; 2],
    order: u8,
    is_metal: bool,
    line: Option<u32>,
}

/// The bonds of `struct_conn` but hydrogen bonds, salt bridges and those to symmetry mates.
fn between_residues(
    block: &Block<'_>,
    builder: &MoleculeBuilder,
    atoms: Range<u32>,
    report: &mut Report,
) -> Vec<FileBond> {
    let table = block.table(Category::StructConn);
    if table.values.is_empty() {
        return Vec::new();
    }
    let columns = [1, 2].map(|number| {
        let column = |name: &str| table.column(&name.replace('#', &format!("ptnr{number}")));
        PartnerColumns {
            chain: [column("#_auth_asym_id"), column("#_label_asym_id")],
            number: [column("#_auth_seq_id"), column("#_label_seq_id")],
            residue_name: [column("#_auth_comp_id"), column("#_label_comp_id")],
            atom: column("#_label_atom_id"),
            alt_loc: column("pdbx_#_label_alt_id"),
            insertion_code: column("pdbx_#_PDB_ins_code"),
            symmetry: column("#_symmetry"),
        }
    });
    let (kind, value_order) = (table.column("conn_type_id"), table.column("pdbx_value_order"));
    let chains: HashMap<&str, u32> =
        (0..).zip(builder.chains()).map(|(index, chain)| (chain.id.as_str(), index)).collect();
    let mut partners: Vec<Partner> = Vec::new();
    let mut partner_index: HashMap<Partner, u32> = HashMap::new();
    let mut connections: Vec<Connection> = Vec::new();
    let mut seen: HashSet<[u32; 2]> = HashSet::new();
    for (index, row) in table.rows().enumerate() {
        let kind = at(row, kind).text().to_ascii_lowercase();
        let is_metal = kind == b"metalc";
        let is_bond = is_metal || kind == b"disulf" || kind.starts_with(b"covale");
        let symmetry = [0, 1].map(|end| at(row, columns[end].symmetry));
        if !is_bond || symmetry[0] != symmetry[1] {
            continue;
        }
        let line = table.lines.get(index).copied();
        let ends = [0, 1].map(|end| partner(row, &columns[end], &chains));
        let [Some(a), Some(b)] = ends else { continue };
        let ends = [a, b].map(|partner| {
            *partner_index.entry(partner).or_insert_with(|| {
                partners.push(partner);
                partners.len() as u32 - 1
            })
        });
        if seen.insert([ends[0].min(ends[1]), ends[0].max(ends[1])]) {
            connections.push(Connection { ends, order: order(at(row, value_order)), is_metal, line });
        }
    }
    let found = find(&partners, builder, atoms);
    let mut bonds = Vec::new();
    for Connection { ends, order, is_metal, line } in connections {
        let [a, b] = ends.map(|end| found[end as usize].as_slice());
        if a.is_empty() || b.is_empty() {
            let name = |end: u32| partners[end as usize].atom;
            report.note(NoteKind::BondToNowhere, line, || format!("{} to {}", name(ends[0]), name(ends[1])));
            continue;
        }
        // The shorter list first, so that many bonds to one atom stay cheap.
        let (few, many) = if a.len() <= b.len() { (a, b) } else { (b, a) };
        for &one in few {
            let model = model(builder, one);
            let start = many.partition_point(|&other| self::model(builder, other) < model);
            for &other in many[start..].iter().take_while(|&&other| self::model(builder, other) == model) {
                if are_together(builder, one, other) && (!is_metal || is_coordination(builder, one, other)) {
                    bonds.push(FileBond { a: one, b: other, order });
                }
            }
        }
    }
    bonds
}

/// The atom that a row names at one end; none if it names no atom, or a chain that no atom has.
fn partner(row: &[Value<'_>], columns: &PartnerColumns, chains: &HashMap<&str, u32>) -> Option<Partner> {
    let either = |pair: [Option<usize>; 2]| match at(row, pair[0]) {
        Value::Missing => at(row, pair[1]),
        value => value,
    };
    let chain = either(columns.chain).to_text();
    let chain = *chains.get(&*String::from_utf8_lossy(&chain))?;
    let number = either(columns.number).integer().and_then(|number| i32::try_from(number).ok()).unwrap_or(0);
    let atom = at(row, columns.atom);
    (atom != Value::Missing).then(|| Partner {
        residue: (chain, number, at(row, columns.insertion_code).letter()),
        residue_name: Name::new(either(columns.residue_name).text()),
        atom: Name::new(atom.text()),
        alt_loc: at(row, columns.alt_loc).letter(),
    })
}

/// The atoms that each partner means, in the order of the file; several where there are models or alternate locations.
fn find(partners: &[Partner], builder: &MoleculeBuilder, atoms: Range<u32>) -> Vec<Vec<u32>> {
    let mut found = vec![Vec::new(); partners.len()];
    let mut wanted: HashMap<(ResidueKey, Name), Vec<u32>> = HashMap::new();
    let residues_wanted: HashSet<ResidueKey> = partners.iter().map(|partner| partner.residue).collect();
    for (index, partner) in (0..).zip(partners) {
        let list = wanted.entry((partner.residue, partner.atom)).or_default();
        if list.len() < MAX_ALTERNATES {
            list.push(index);
        }
    }
    let mut last = (u32::MAX, None);
    for index in atoms {
        let Some(atom) = builder.atoms().get(index as usize) else { break };
        if atom.residue != last.0 {
            let residue = &builder.residues()[atom.residue as usize];
            let key = (residue.chain, residue.number, residue.insertion_code);
            last = (atom.residue, residues_wanted.contains(&key).then_some((key, residue.name)));
        }
        let Some((key, residue_name)) = last.1 else { continue };
        for &partner in wanted.get(&(key, atom.name)).into_iter().flatten() {
            let Partner { residue_name: name, alt_loc, .. } = partners[partner as usize];
            let fits_alternate = alt_loc == 0 || atom.alt_loc == 0 || alt_loc == atom.alt_loc;
            if fits_alternate && (name == residue_name || name == Name::default()) {
                let list = &mut found[partner as usize];
                let model = model(builder, index);
                let is_full =
                    list.len() >= MAX_ALTERNATES && self::model(builder, list[list.len() - MAX_ALTERNATES]) == model;
                if !is_full {
                    list.push(index);
                }
            }
        }
    }
    found
}

/// The model of an atom.
fn model(builder: &MoleculeBuilder, atom: u32) -> u32 {
    builder.residues()[builder.atoms()[atom as usize].residue as usize].model
}

/// Whether two atoms are different ones that may be there at the same time.
fn are_together(builder: &MoleculeBuilder, a: u32, b: u32) -> bool {
    let [alt_a, alt_b] = [a, b].map(|index| builder.atoms()[index as usize].alt_loc);
    a != b && (alt_a == 0 || alt_b == 0 || alt_a == alt_b)
}

/// Whether a metal is near enough to count as bonded.
fn is_coordination(builder: &MoleculeBuilder, a: u32, b: u32) -> bool {
    let [a, b] = [a, b].map(|index| index as usize);
    let radius = |index: usize| f64::from(builder.atoms()[index].element.covalent_radius());
    builder.positions()[a].distance(builder.positions()[b]) <= radius(a) + radius(b) + METAL_TOLERANCE
}

/// Adds the bonds of `chem_comp_bond`.
fn within_residues(block: &Block<'_>, builder: &MoleculeBuilder, atoms: Range<u32>, bonds: &mut Vec<FileBond>) {
    let table = block.table(Category::ChemCompBond);
    let columns = ["comp_id", "atom_id_1", "atom_id_2", "value_order"].map(|name| table.column(name));
    let mut partners: HashMap<(Name, Name), Vec<(Name, u8)>> = HashMap::new();
    for row in table.rows() {
        let [residue, a, b, value_order] = columns.map(|column| at(row, column));
        let [residue, a, b] = [residue, a, b].map(|value| Name::new(value.text()));
        let list = partners.entry((residue, a)).or_default();
        if list.len() < MAX_PARTNERS && a != b {
            list.push((b, order(value_order)));
        }
    }
    if partners.is_empty() {
        return;
    }
    let range = atoms.start as usize..(atoms.end as usize).min(builder.atoms().len());
    let mut start = range.start as u32;
    // Name, alternate location and index of a residue's atoms, sorted.
    let mut names: Vec<(Name, u8, u32)> = Vec::new();
    for group in builder.atoms()[range].chunk_by(|a, b| a.residue == b.residue) {
        let residue = builder.residues()[group[0].residue as usize].name;
        names.clear();
        names.extend((start..).zip(group).map(|(index, atom)| (atom.name, atom.alt_loc, index)));
        names.sort_unstable();
        for (index, atom) in (start..).zip(group) {
            for &(other, order) in partners.get(&(residue, atom.name)).into_iter().flatten() {
                bonds.extend(others(&names, other, atom).map(|other| FileBond { a: index, b: other, order }));
            }
        }
        start += group.len() as u32;
    }
}

/// The atoms of a name that may be there together with an atom.
fn others(names: &[(Name, u8, u32)], name: Name, atom: &Atom) -> impl Iterator<Item = u32> {
    let start = names.partition_point(|other| other.0 < name);
    let alternates = names[start..].iter().take_while(move |other| other.0 == name).take(MAX_ALTERNATES);
    let alt_loc = atom.alt_loc;
    alternates.filter(move |other| alt_loc == 0 || other.1 == 0 || alt_loc == other.1).map(|other| other.2)
}

#[cfg(test)]
mod tests {
    use crate::scene::{NoteKind, Scene};

    const ATOMS: &str = "loop_\n_atom_site.group_PDB\n_atom_site.type_symbol\n_atom_site.label_atom_id\n\
        _atom_site.label_alt_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n\
        _atom_site.auth_asym_id\n_atom_site.auth_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n\
        HETATM C C1 . LIG A . X 7 0 0 0\nHETATM C C2 . LIG A . X 7 1.4 0 0\nHETATM O O1 . LIG A . X 7 2.7 0 0\n\
        HETATM ZN ZN . ZN B . X 8 5.1 0 0\nHETATM ZN ZN . ZN C . X 9 7.7 0 0\nHETATM C C1 . LIG D . Y 7 -3 0 0\n";

    /// Bonds by the numbers of their atoms, with their orders.
    fn bonds(tables: &str) -> (Vec<(u32, u32, u8)>, u32) {
        let scene = Scene::from_bytes("t.cif", format!("data_x\n{tables}{ATOMS}").as_bytes()).expect("a scene");
        let bonds = scene.molecule.bonds.iter().map(|bond| (bond.a, bond.b, bond.order)).collect();
        (bonds, scene.files[0].report.count(NoteKind::BondToNowhere))
    }

    #[test]
    fn residues_have_the_bonds_and_orders_of_their_component() {
        let table = "loop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_2\n\
            _chem_comp_bond.value_order\nLIG C1 C2 DOUB\nLIG O1 C2 sing\nLIG C1 H9 SING\nALA N CA SING\n";
        assert_eq!(bonds("").0, [(0, 1, 1), (1, 2, 1)]);
        assert_eq!(bonds(table).0, [(0, 1, 2), (1, 2, 1)]);
    }

    #[test]
    fn connections_join_residues() {
        let head = "loop_\n_struct_conn.id\n_struct_conn.conn_type_id\n_struct_conn.ptnr1_label_asym_id\n\
            _struct_conn.ptnr1_auth_asym_id\n_struct_conn.ptnr1_auth_seq_id\n_struct_conn.ptnr1_label_comp_id\n\
            _struct_conn.ptnr1_label_atom_id\n_struct_conn.ptnr1_symmetry\n_struct_conn.ptnr2_auth_asym_id\n\
            _struct_conn.ptnr2_auth_seq_id\n_struct_conn.ptnr2_label_comp_id\n_struct_conn.ptnr2_label_atom_id\n\
            _struct_conn.ptnr2_symmetry\n_struct_conn.pdbx_value_order\n";
        let with = |row: &str| bonds(&format!("{head}{row}\n"));
        let plain = bonds("").0;
        let mut linked = plain.clone();
        linked.insert(1, (0, 5, 2));
        assert_eq!(with("1 covale A X 7 LIG C1 1_555 Y 7 LIG C1 1_555 doub").0, linked);
        assert_eq!(with("1 hydrog A X 7 LIG C1 1_555 Y 7 LIG C1 1_555 ?"), (plain.clone(), 0));
        assert_eq!(with("1 covale A X 7 LIG C1 1_555 Y 7 LIG C1 2_665 ?"), (plain.clone(), 0));
        assert_eq!(with("1 covale A X 7 LIG C9 1_555 Y 7 LIG C1 1_555 ?"), (plain.clone(), 1));
        // 2.4 angstrom is a bond of zinc and oxygen, 5.0 is not.
        let mut held = plain.clone();
        held.push((2, 3, 1));
        assert_eq!(with("1 metalc A X 7 LIG O1 1_555 X 8 ZN ZN 1_555 ?").0, held);
        assert_eq!(with("1 metalc A X 7 LIG O1 1_555 X 9 ZN ZN 1_555 ?").0, plain);
    }
}
