//! Bonds of the residues that every protein, nucleic acid and crystal is made of, by the names of their atoms.
//!
//! Names and orders are those of [ChemComp, throughout]; older names of the same atoms stand beside them (`O1P`, `OT1`, `CD` of
//! isoleucine). Hydrogens are not listed: they belong to the nearest atom of their residue. Charged groups have one
//! double bond (carboxylates, guanidinium, phosphates), rings alternate.

use super::name::Name;
use std::sync::LazyLock;

/// Bonds of every amino acid.
const AMINO: &str = "N-CA CA-C C=O C-OXT C=OT1 C-OT2";
/// Bonds of every nucleotide.
const NUCLEOTIDE: &str = "P=OP1 P-OP2 P-OP3 P=O1P P-O2P P-O3P P-O5' O5'-C5' C5'-C4' C4'-O4' C4'-C3' C3'-O3' C3'-C2' \
                          C2'-O2' C2'-C1' C1'-O4'";

/// Names of amino acids, and their bonds beside [`AMINO`].
const AMINO_ACIDS: &[(&str, &str)] = &[
    ("GLY", ""),
    ("ALA", "CA-CB"),
    ("ARG", "CA-CB CB-CG CG-CD CD-NE NE-CZ CZ-NH1 CZ=NH2"),
    ("ASN", "CA-CB CB-CG CG=OD1 CG-ND2"),
    ("ASP ASH", "CA-CB CB-CG CG=OD1 CG-OD2"),
    ("ASX", "CA-CB CB-CG"),
    ("CYS CYX CYM", "CA-CB CB-SG"),
    ("GLN", "CA-CB CB-CG CG-CD CD=OE1 CD-NE2"),
    ("GLU GLH", "CA-CB CB-CG CG-CD CD=OE1 CD-OE2"),
    ("GLX", "CA-CB CB-CG CG-CD"),
    ("HIS HIE HIP HSE HSP", "CA-CB CB-CG CG-ND1 CG=CD2 ND1=CE1 CD2-NE2 CE1-NE2"),
    ("HID HSD", "CA-CB CB-CG CG-ND1 CG=CD2 ND1-CE1 CD2-NE2 CE1=NE2"),
    ("ILE", "CA-CB CB-CG1 CB-CG2 CG1-CD1 CG1-CD"),
    ("LEU", "CA-CB CB-CG CG-CD1 CG-CD2"),
    ("LYS LYN", "CA-CB CB-CG CG-CD CD-CE CE-NZ"),
    ("MET", "CA-CB CB-CG CG-SD SD-CE"),
    ("MSE", "CA-CB CB-CG CG-SE SE-CE"),
    ("PHE", "CA-CB CB-CG CG=CD1 CG-CD2 CD1-CE1 CD2=CE2 CE1=CZ CE2-CZ"),
    ("PRO", "CA-CB CB-CG CG-CD CD-N"),
    ("HYP", "CA-CB CB-CG CG-CD CD-N CG-OD1"),
    ("SER", "CA-CB CB-OG"),
    ("SEC", "CA-CB CB-SE"),
    ("THR", "CA-CB CB-OG1 CB-CG2"),
    ("TRP", "CA-CB CB-CG CG=CD1 CG-CD2 CD1-NE1 NE1-CE2 CD2=CE2 CD2-CE3 CE2-CZ2 CE3=CZ3 CZ2=CH2 CZ3-CH2"),
    ("TYR", "CA-CB CB-CG CG=CD1 CG-CD2 CD1-CE1 CD2=CE2 CE1=CZ CE2-CZ CZ-OH"),
    ("VAL", "CA-CB CB-CG1 CB-CG2"),
];

/// Names of nucleotides, and their bonds beside [`NUCLEOTIDE`].
const NUCLEOTIDES: &[(&str, &str)] = &[
    ("A DA ADE RA DA5 DA3 RA5 RA3", "C1'-N9 N9-C8 C8=N7 N7-C5 C5-C6 C6-N6 C6=N1 N1-C2 C2=N3 N3-C4 C4=C5 C4-N9"),
    ("G DG GUA RG DG5 DG3 RG5 RG3", "C1'-N9 N9-C8 C8=N7 N7-C5 C5-C6 C6=O6 C6-N1 N1-C2 C2-N2 C2=N3 N3-C4 C4=C5 C4-N9"),
    ("I DI", "C1'-N9 N9-C8 C8=N7 N7-C5 C5-C6 C6=O6 C6-N1 N1-C2 C2=N3 N3-C4 C4=C5 C4-N9"),
    ("C DC CYT RC DC5 DC3 RC5 RC3", "C1'-N1 N1-C2 C2=O2 C2-N3 N3=C4 C4-N4 C4-C5 C5=C6 C6-N1"),
    ("U DU URA RU RU5 RU3", "C1'-N1 N1-C2 C2=O2 C2-N3 N3-C4 C4=O4 C4-C5 C5=C6 C6-N1"),
    ("T DT THY DT5 DT3", "C1'-N1 N1-C2 C2=O2 C2-N3 N3-C4 C4=O4 C4-C5 C5-C7 C5-C5M C5=C6 C6-N1"),
    ("N DN", ""),
];

/// A residue's atoms and the bonds between them.
#[derive(Debug, Default)]
pub(super) struct Template {
    /// Names of atoms other than hydrogen, in the order in which files have them, as far as that goes.
    pub(super) names: Vec<Name>,
    /// Bonds between places in `names`, with their orders.
    pub(super) bonds: Vec<(u8, u8, u8)>,
    /// Whether it is a nucleotide, in whose older names stars stand for primes.
    pub(super) is_nucleotide: bool,
}

/// All templates, and their residues' names in order.
pub(super) struct Table {
    templates: Vec<Template>,
    by_name: Vec<(Name, usize)>,
}

impl Table {
    fn parse() -> Self {
        let mut table = Self { templates: Vec::new(), by_name: Vec::new() };
        for (rows, common, is_nucleotide) in [(AMINO_ACIDS, AMINO, false), (NUCLEOTIDES, NUCLEOTIDE, true)] {
            for (residues, own) in rows {
                let names = residues.split(' ').map(|name| (Name::new(name.as_bytes()), table.templates.len()));
                table.by_name.extend(names);
                let mut template = Template { is_nucleotide, ..Template::default() };
                for bond in common.split(' ').chain(own.split(' ')).filter(|bond| !bond.is_empty()) {
                    template.add(bond);
                }
                table.templates.push(template);
            }
        }
        table.by_name.sort_unstable();
        table
    }

    /// The template of a residue.
    pub(super) fn find(&self, residue: Name) -> Option<&Template> {
        let at = self.by_name.binary_search_by_key(&residue, |&(name, _)| name).ok()?;
        self.templates.get(self.by_name[at].1)
    }
}

impl Template {
    /// Adds a bond: two names with `-` or `=` between them.
    fn add(&mut self, bond: &str) {
        let Some((a, b)) = bond.split_once(['-', '=']) else { return };
        let order = if bond.contains('=') { 2 } else { 1 };
        let [a, b] = [a, b].map(|name| self.place(Name::new(name.as_bytes())));
        self.bonds.push((a, b, order));
    }

    /// The place of a name, which is new or not.
    fn place(&mut self, name: Name) -> u8 {
        let place = self.names.iter().position(|&other| other == name).unwrap_or_else(|| {
            self.names.push(name);
            self.names.len() - 1
        });
        place as u8
    }
}

/// The table, parsed when it is first used.
pub(super) static TABLE: LazyLock<Table> = LazyLock::new(Table::parse);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::guess::is_polymer_residue;

    /// Bonds and double bonds of a residue without what only ends of chains and older names have.
    fn counts(residue: &str) -> (usize, usize) {
        let template = TABLE.find(Name::new(residue.as_bytes())).expect("a template");
        let is_usual = |name: Name| {
            let rare = ["OXT", "OT1", "OT2", "OP3", "O1P", "O2P", "O3P", "C5M"];
            !(rare.contains(&name.as_str()) || residue == "ILE" && name.as_str() == "CD")
        };
        let usual = template
            .bonds
            .iter()
            .filter(|bond| is_usual(template.names[bond.0 as usize]) && is_usual(template.names[bond.1 as usize]));
        usual.fold((0, 0), |(all, double), bond| (all + 1, double + usize::from(bond.2 == 2)))
    }

    #[test]
    fn residues_have_the_bonds_of_their_formulas() {
        // A molecule without ring has one bond less than atoms, each ring adds one; double bonds as drawn.
        for (residue, expected) in [
            ("GLY", (3, 1)),
            ("ALA", (4, 1)),
            ("ARG", (10, 2)),
            ("ASP", (7, 2)),
            ("HIS", (10, 3)),
            ("ILE", (7, 1)),
            ("PRO", (7, 1)),
            ("PHE", (11, 4)),
            ("TYR", (12, 4)),
            ("TRP", (15, 5)),
            // 22 heavy atoms and three rings; P=O and four in the base.
            ("A", (24, 5)),
            // Guanine has one more atom, uracil fewer by two and a ring.
            ("G", (25, 5)),
            ("U", (21, 4)),
            ("C", (21, 4)),
            ("DT", (22, 4)),
        ] {
            assert_eq!(counts(residue), expected, "{residue}");
        }
    }

    #[test]
    fn no_atom_has_more_bonds_than_its_element_allows() {
        for template in &TABLE.templates {
            let old = ["OT1", "OT2", "O1P", "O2P", "O3P", "C5M", "CD"];
            for (place, name) in (0..).zip(&template.names) {
                let is_old = |place: u8| {
                    let name = template.names[place as usize].as_str();
                    (template.names.contains(&Name::new(b"CD1")) || name != "CD") && old.contains(&name)
                };
                let own = template
                    .bonds
                    .iter()
                    .filter(|bond| [bond.0, bond.1].contains(&place) && !is_old(bond.0) && !is_old(bond.1));
                let valence: u8 = own.map(|bond| bond.2).sum();
                let most = match &name.as_str()[..1] {
                    "C" => 4,
                    "N" => 3,
                    "P" => 5,
                    _ => 2,
                };
                // Carbon of the carboxyl end: CA, O and OXT.
                assert!(valence <= most, "{name} in {:?} has {valence}", template.names);
            }
        }
    }

    #[test]
    fn every_common_polymer_residue_has_a_template() {
        for residue in ["ALA", "HSD", "CYX", "ADE", "DT", "I", "LYN", "RA5"] {
            assert!(is_polymer_residue(residue) && TABLE.find(Name::new(residue.as_bytes())).is_some(), "{residue}");
        }
        assert!(TABLE.find(Name::new(b"HEM")).is_none() && TABLE.find(Name::default()).is_none());
    }
}
