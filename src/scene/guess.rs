//! Guesses an element from what a file calls an atom.
//!
//! PDB files put the element symbol right-justified in the first two of the four name columns, so that ` CA ` is a carbon
//! alpha and `CA  ` is calcium [wwPDB format 3.3, ATOM]. Many files have no element columns and some shift the names, so the
//! residue has a say too. XYZ files write symbols, labels (`C1`) or atomic numbers.

use super::element::Element;
use super::molecule::ResidueKind;

/// Two-letter elements that a name may start with when the columns say so; others (`HE`, `CE`, `AC`) are nearly always labels.
const LIKELY_TWO_LETTER: &[&[u8; 2]] = &[
    b"CL", b"BR", b"FE", b"ZN", b"MG", b"MN", b"CO", b"NI", b"CU", b"NA", b"CA", b"CD", b"SE", b"SI", b"LI", b"AL",
    b"HG", b"PT", b"AU", b"AG", b"AS", b"MO", b"CR", b"TI", b"RU", b"RH", b"PD", b"SR", b"BA", b"RB", b"CS", b"PB",
    b"SN", b"SB", b"GA", b"ZR", b"IR", b"XE",
];

/// Residues made of H, C, N, O, P and S alone, whatever their names look like.
const POLYMER: &[&str] = &[
    "ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE", "LEU", "LYS", "MET", "PHE", "PRO", "SER",
    "THR", "TRP", "TYR", "VAL", "ASX", "GLX", "HID", "HIE", "HIP", "HSD", "HSE", "HSP", "CYX", "CYM", "ASH", "GLH",
    "LYN", "A", "C", "G", "T", "U", "I", "DA", "DC", "DG", "DT", "DU", "DI", "ADE", "CYT", "GUA", "THY", "URA", "N",
    "DN", "RA", "RC", "RG", "RU", "DA5", "DC5", "DG5", "DT5", "DA3", "DC3", "DG3", "DT3", "RA5", "RC5", "RG5", "RU5",
    "RA3", "RC3", "RG3", "RU3",
];

/// Nucleotides of three letters among [`POLYMER`]; all others of that length are amino acids.
const NUCLEIC_OF_THREE: &[&str] = &[
    "ADE", "CYT", "GUA", "THY", "URA", "DA5", "DC5", "DG5", "DT5", "DA3", "DC3", "DG3", "DT3", "RA5", "RC5", "RG5",
    "RU5", "RA3", "RC3", "RG3", "RU3",
];

/// Amino acids that were changed after or while they joined the chain, other names that programs give them, and what
/// caps a chain; three-letter names of [ChemComp, throughout].
const MODIFIED_AMINO: &[&str] = &[
    "MSE", "SEC", "PYL", "HYP", "SEP", "TPO", "PTR", "TYS", "CSO", "CSD", "CSX", "CME", "CSS", "OCS", "CAS", "CGU",
    "PCA", "KCX", "LLP", "MLY", "MLZ", "M3L", "ALY", "LYZ", "AGM", "FME", "NLE", "NVA", "ABA", "AIB", "ORN", "DAB",
    "CIR", "HIC", "MHO", "SME", "SAC", "IAS", "CRO", "DAL", "DVA", "DLE", "DPN", "DTR", "DTY", "DSN", "DTH", "DAS",
    "DGL", "DGN", "DLY", "DAR", "DPR", "DCY", "DHI", "DIL", "MED", "SAR", "UNK", "ACE", "FOR", "NH2", "NME", "NMA",
    "ETA", "CYS2", "CYSH", "HISA", "HISB", "HISD", "HISE", "HISH", "HIS1", "HIS2", "LYSH", "ASPH", "GLUH", "ARGN",
];

/// Nucleotides with changed bases or sugars [ChemComp, throughout].
const MODIFIED_NUCLEIC: &[&str] = &[
    "PSU", "5MC", "5MU", "H2U", "4SU", "OMC", "OMG", "OMU", "A2M", "1MA", "2MA", "6MZ", "MA6", "MIA", "T6A", "1MG",
    "2MG", "7MG", "M2G", "G7M", "YYG", "YG", "QUO", "UR3", "3TD", "4OC", "5HU", "5BU", "5IU", "BRU", "CBR", "CBV",
    "BGM", "8OG", "DZ", "P5P", "70U", "U8U", "MGT", "GTG", "RIA", "12A", "CM0", "2MU", "AET",
];

/// Monosaccharides of glycans, and common sugars of several [ChemComp; GLYCAM and CHARMM names beside them].
const SUGAR: &[&str] = &[
    "NAG", "NDG", "NGA", "A2G", "BGC", "GLC", "GAL", "GLA", "GLB", "MAN", "BMA", "FUC", "FUL", "FCA", "FCB", "SIA",
    "SLB", "NGC", "XYP", "XYS", "XYL", "ARA", "ARB", "RIB", "RAM", "RM4", "FRU", "GUP", "GCU", "BDP", "IDR", "IDS",
    "ADA", "GTR", "SGN", "GNS", "NGS", "ASG", "UAP", "KDO", "KDN", "GMH", "GCS", "PA1", "MUB", "AMU", "TYV", "ABE",
    "SUC", "MAL", "LAT", "LBT", "TRE", "GLS", "CBI", "BGLC", "AGLC", "BGAL", "AGAL", "BMAN", "AMAN", "AFUC", "BFUC",
    "BGLCNA", "AGLCNA", "ANE5", "0YB", "4YB", "VMB", "0MA", "0SA", "0LB", "0FA",
];

/// Names that programs give to water.
const WATER: &[&str] =
    &["HOH", "WAT", "DOD", "H2O", "SOL", "TIP", "TIP3", "TIP4", "TIP5", "TP3", "TP4", "T3P", "T4P", "SPC", "SPCE"];

/// Whether a residue is an amino acid or nucleotide that needs no `CONECT` records.
pub(super) fn is_polymer_residue(name: &str) -> bool {
    POLYMER.contains(&name)
}

/// What a residue is, by its name; `only` is the element of its atom where it has just one.
pub(super) fn residue_kind(name: &str, only: Option<Element>) -> ResidueKind {
    let is_nucleic = || name.len() < 3 || NUCLEIC_OF_THREE.contains(&name);
    match name {
        "" => ResidueKind::Other,
        _ if is_water(name) => ResidueKind::Water,
        _ if is_polymer_residue(name) && !is_nucleic() => ResidueKind::Protein,
        _ if is_polymer_residue(name) && !only.is_some_and(may_be_ion) => ResidueKind::Nucleic,
        _ if MODIFIED_AMINO.contains(&name) => ResidueKind::Protein,
        _ if MODIFIED_NUCLEIC.contains(&name) => ResidueKind::Nucleic,
        _ if SUGAR.contains(&name) => ResidueKind::Sugar,
        _ if only.is_some_and(may_be_ion) => ResidueKind::Ion,
        _ => ResidueKind::Ligand,
    }
}

/// Whether a single atom of an element is an ion or a noble gas rather than what is left of something larger.
fn may_be_ion(element: Element) -> bool {
    element.is_metal() || matches!(element.number(), 2 | 9 | 10 | 17 | 18 | 35 | 36 | 53 | 54 | 86)
}

/// Whether a residue is a water molecule.
pub(super) fn is_water(name: &str) -> bool {
    WATER.contains(&name)
}

/// The element of a PDB atom from its four name columns (spaces kept) and its residue's name.
///
/// Returns the unknown element if nothing fits. Case does not matter.
pub fn from_pdb_name(columns: [u8; 4], residue: &str) -> Element {
    let columns = columns.map(|byte| byte.to_ascii_uppercase());
    let residue = residue.to_ascii_uppercase();
    let letters = || columns.iter().copied().filter(u8::is_ascii_alphabetic);
    let Some(first) = letters().next() else {
        return Element::UNKNOWN;
    };
    if is_polymer_residue(&residue) || is_water(&residue) {
        return one_letter(first, b"HCNOPSD").unwrap_or_else(|| from_columns(columns));
    }
    // An ion is its own residue: atom ZN of residue ZN, however it is shifted.
    let name = columns.trim_ascii();
    if name == residue.as_bytes()
        && let Some(element) = Element::from_symbol(name)
    {
        return element;
    }
    from_columns(columns)
}

/// Reads the symbol where the format puts it, then wherever it could be.
fn from_columns(columns: [u8; 4]) -> Element {
    let [a, b, ..] = columns;
    let letters = || columns.iter().copied().filter(u8::is_ascii_alphabetic);
    let starts_left = a.is_ascii_alphabetic();
    if starts_left && b.is_ascii_alphabetic() {
        // A four-letter hydrogen name starts in the first column for want of room: HG11, HO5'.
        let full_hydrogen = a == b'H' && columns[3] != b' ';
        if !full_hydrogen && LIKELY_TWO_LETTER.contains(&&[a, b]) {
            return Element::from_symbol(&[a, b]).unwrap_or_default();
        }
    }
    letters()
        .next()
        .and_then(|letter| one_letter(letter, b"HCNOPSFIBKVWYUD"))
        .or_else(|| letters().nth(1).and_then(|letter| one_letter(letter, b"HCNOPS")))
        .or_else(|| if starts_left { Element::from_symbol(&[a, b]) } else { None })
        .unwrap_or_default()
}

/// The element of one letter if it is among those allowed.
fn one_letter(letter: u8, allowed: &[u8]) -> Option<Element> {
    if allowed.contains(&letter) { Element::from_symbol(&[letter]) } else { None }
}

/// The element of the first column of an XYZ file: a symbol, a symbol with a label (`C1`, `Fe2+`, `H_a`) or an atomic number.
///
/// Returns the unknown element for dummies (`X`, `Bq`) and for words that no element starts.
pub fn from_xyz_symbol(token: &[u8]) -> Element {
    if token.iter().all(u8::is_ascii_digit) {
        let number = std::str::from_utf8(token).ok().and_then(|digits| digits.parse().ok());
        return Element::from_number(number.unwrap_or(0));
    }
    let length = token.iter().take_while(|byte| byte.is_ascii_alphabetic()).count();
    Element::from_symbol(&token[..length]).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pdb(name: &str, residue: &str) -> &'static str {
        let columns: [u8; 4] = name.as_bytes().try_into().expect("four columns");
        from_pdb_name(columns, residue).symbol()
    }

    #[test]
    fn residues_are_known_by_their_names() {
        use ResidueKind::{Ion, Ligand, Nucleic, Other, Protein, Sugar, Water};
        let kind = |name: &str| residue_kind(name, None);
        for (names, expected) in [
            ("ALA TRP MSE SEC PYL HYP SEP TPO PTR HSD HIE CYX LYN ACE NME UNK", Protein),
            ("A U DG DT ADE PSU 5MC H2U 5MU OMG RA3", Nucleic),
            ("NAG MAN BMA GAL FUC GLC SIA BGLC", Sugar),
            ("HOH WAT TIP3 SOL DOD", Water),
            ("HEM ATP SO4 LIG GOL", Ligand),
        ] {
            for name in names.split(' ') {
                assert_eq!(kind(name), expected, "{name}");
            }
        }
        let only = |name: &str, symbol: &str| residue_kind(name, Element::from_symbol(symbol.as_bytes()));
        assert_eq!((only("ZN", "Zn"), only("CL", "Cl"), only("XE", "Xe"), only("K", "K")), (Ion, Ion, Ion, Ion));
        // Uranium, and what is left of uridine or of a ligand.
        assert_eq!((only("U", "U"), only("U", "P"), only("LIG", "C")), (Ion, Nucleic, Ligand));
        assert_eq!((only("ALA", "C"), only("HOH", "O"), kind("")), (Protein, Water, Other));
    }

    #[test]
    fn no_residue_is_of_two_kinds() {
        let lists = [POLYMER, MODIFIED_AMINO, MODIFIED_NUCLEIC, SUGAR, WATER];
        let mut names: Vec<&str> = lists.concat();
        names.sort_unstable();
        let twice: Vec<_> = names.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        assert!(twice.is_empty(), "{twice:?}");
        assert!(NUCLEIC_OF_THREE.iter().all(|name| POLYMER.contains(name) && name.len() == 3));
    }

    #[test]
    fn columns_tell_carbon_alpha_from_calcium() {
        assert_eq!(pdb(" CA ", "ALA"), "C");
        assert_eq!(pdb("CA  ", "CA"), "Ca");
        assert_eq!(pdb(" CA ", "CA"), "Ca");
        assert_eq!(pdb("CA  ", "UKN"), "Ca");
        assert_eq!(pdb(" CA ", "UKN"), "C");
        assert_eq!(pdb("CA  ", "ALA"), "C");
    }

    #[test]
    fn hydrogens_are_no_mercury_and_no_helium() {
        for name in ["HG11", "1HB ", " HE2", "HE2 ", "HH12", " HG ", "HG  ", "2HG1", "HO5'"] {
            assert_eq!(pdb(name, "ARG"), "H", "{name}");
        }
        assert_eq!(pdb("HO5'", "LIG"), "H");
        assert_eq!(pdb("HG  ", "HG"), "Hg");
        assert_eq!(pdb("HE2 ", "LIG"), "H");
    }

    #[test]
    fn ligands_keep_their_metals_and_halogens() {
        assert_eq!(pdb("FE  ", "HEM"), "Fe");
        assert_eq!(pdb(" NA ", "HEM"), "N");
        assert_eq!(pdb("CL1 ", "LIG"), "Cl");
        assert_eq!(pdb("BR2 ", "LIG"), "Br");
        assert_eq!(pdb(" ZN ", "ZN"), "Zn");
        assert_eq!(pdb("OA22", "NAP"), "O");
        assert_eq!(pdb("AC5 ", "AP5"), "C");
        assert_eq!(pdb(" PE ", "AP5"), "P");
    }

    #[test]
    fn nonsense_is_unknown() {
        assert_eq!(pdb("    ", "LIG"), "X");
        assert_eq!(pdb("1234", "LIG"), "X");
        assert_eq!(pdb("XQZ ", "LIG"), "X");
    }

    #[test]
    fn xyz_takes_labels_and_numbers() {
        for (token, symbol) in
            [("C1", "C"), ("6", "C"), ("Fe2+", "Fe"), ("H_a", "H"), ("X", "X"), ("Foo", "X"), ("D", "H"), ("999", "X")]
        {
            assert_eq!(from_xyz_symbol(token.as_bytes()).symbol(), symbol, "{token}");
        }
        assert_eq!(from_xyz_symbol(b"0"), Element::UNKNOWN);
        assert_eq!(from_xyz_symbol(b""), Element::UNKNOWN);
    }
}
