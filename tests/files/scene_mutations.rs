//! Five thousand damaged files, seeded: none may panic, and none may break what a molecule promises.

use restyle::scene::{LoadOptions, ModelChoice, Molecule, Scene};
use std::path::PathBuf;

/// Damaged files. At some 0.2 ms each, more would only repeat.
const NUM_MUTATIONS: u32 = 5000;

/// Numbers from a seed [ONeill2014, its underlying LCG].
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % limit.max(1)
    }
}

/// What importers stumble over, to be written anywhere.
const NASTY: &[&[u8]] = &[
    b"nan",
    b"-inf",
    b"1e300",
    b"9e29",
    b"********",
    b"\r",
    b"\n",
    b"\r\n",
    b"\0",
    b"\xff\xfe",
    b"\t",
    b"-",
    b"99999999999999999999",
    b"MODEL 0",
    b"\nMODEL     4294967295\n",
    b"\nENDMDL\n",
    b"\nEND\n",
    b"\nCONECT    1    2    2    2\n",
    b"\nCONECT99999A0000zzzzz\n",
    b"\nATOM",
    b"\nHETATM99999",
    b"A0000",
    b"\n-1\n",
    b"\n0\n\n",
    b"\n4294967296\n",
    b"H ",
    b"          ",
    b"1D400",
    b"\n$$$$\n",
    b"\nM  END\n",
    b"\nM  CHG  1   1  -1\n",
    b"  1  1  4  0\n",
    b"\nM  V30 BEGIN ATOM\n",
    b"\nM  V30 1 C 0 0 0 0 -\n",
    b"\n@<TRIPOS>ATOM\n",
    b"\n@<TRIPOS>MOLECULE\n",
    b" ar\n",
    b"\nREMARK 350   BIOMT1   1  1.0 0.0 0.0 0.0\n",
    b"\nREMARK 350 BIOMOLECULE: 1\n",
];

/// Small files of the formats that are tables of words, and of a PDB file with an assembly.
const SAMPLES: &[(&str, &str)] = &[
    (
        "pyrrole.sdf",
        "pyrrole\n  x\n\n  5  5  0  0  0  0            999 V2000
    0.0000    1.1000    0.0000 N   0  0  0
    1.1000    0.3000    0.0000 C   0  3  0
    0.7000   -1.0000    0.0000 C   0  0  0
   -0.7000   -1.0000    0.0000 C   0  0  0
   -1.1000    0.3000    0.0000 C   0  0  0
  1  2  4  0\n  2  3  4  0\n  3  4  4  0\n  4  5  4  0\n  5  1  4  0\nM  CHG  1   1  -1\nM  END\n> <x>\n1\n\n$$$$
water\n\n\n  1  0  0\n    9.0000    0.0000    0.0000 O   0  0  0\nM  END\n$$$$\n",
    ),
    (
        "carbonyl.mol",
        "\n\n\n  0  0  0     0  0            999 V3000\nM  V30 BEGIN CTAB\nM  V30 COUNTS 2 1 0 0 0\nM  V30 BEGIN ATOM
M  V30 1 C 0 0 -\nM  V30 0 0\nM  V30 2 O 1.2 0 0 0 CHG=-1 X=(1 2)\nM  V30 END ATOM\nM  V30 BEGIN BOND\nM  V30 1 2 1 2
M  V30 END BOND\nM  V30 END CTAB\nM  END\n",
    ),
    (
        "peptide.mol2",
        "@<TRIPOS>MOLECULE\npeptide\n 4 3 1\nPROTEIN\nUSER_CHARGES\n\n@<TRIPOS>ATOM
 1 N 0.0 0.0 0.0 N.am 1 GLY1 -0.1\n 2 CA 1.45 0.0 0.0 C.3 1 GLY1 0.1\n 3 C 2.9 0.3 0.0 C.2 1 GLY1\n 4 O 3.0 1.5 0.0 O.2 1 GLY1
@<TRIPOS>BOND\n 1 1 2 1\n 2 2 3 ar\n 3 3 4 2\n@<TRIPOS>SUBSTRUCTURE\n 1 GLY1 1 RESIDUE 0 A GLY\n",
    ),
    (
        "ions.pqr",
        "REMARK   1\nATOM      1  N   THR     1      17.047  14.099   3.625 -0.3200 2.0000
ATOM      2  CA  THR A   1A     16.967  12.784   4.338  0.3300 2.0000\nHETATM 3 ZN ZN 2 1.0 2.0 3.0 2.0 1.2\nEND\n",
    ),
    (
        "copies.pdb",
        "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A
REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000
REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000
REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000       20.00000
ATOM      1  N   GLY A   1       0.000   0.000   0.000  1.00  0.00           N1+
ATOM      2  CA  GLY A   1       1.450   0.000   0.000  1.00  0.00           C
ATOM      3  C   GLY A   1       2.900   0.300   0.000  1.00  0.00           C
ATOM      4  O   GLY B   1       3.000   1.500   0.000  1.00  0.00           O\n",
    ),
];

fn mutate(original: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..=random.below(6) {
        let at = random.below(bytes.len() + 1);
        match random.below(6) {
            0 => bytes.truncate(at),
            1 => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = random.below(256) as u8;
                }
            }
            2 => {
                let nasty = NASTY[random.below(NASTY.len())];
                bytes.splice(at..at, nasty.iter().copied());
            }
            3 => {
                let nasty = NASTY[random.below(NASTY.len())];
                let end = bytes.len().min(at + nasty.len());
                bytes.splice(at..end, nasty.iter().copied());
            }
            4 => {
                let end = bytes.len().min(at + random.below(200));
                bytes.drain(at..end);
            }
            _ => {
                let end = bytes.len().min(at + random.below(400));
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len() + 1);
                bytes.splice(to..to, copy);
            }
        }
    }
    bytes
}

fn assert_sound(molecule: &Molecule) {
    assert!(!molecule.atoms.is_empty());
    let (sphere, count) = (molecule.bounding_sphere(), molecule.atoms.len() as u32);
    assert!(sphere.radius.is_finite() && molecule.origin.is_finite());
    assert!(
        molecule.copies.iter().flat_map(|copy| &copy.atoms).all(|range| range.start < range.end && range.end <= count)
    );
    for atom in &molecule.atoms {
        if !molecule.copies.is_empty() {
            break;
        }
        let reach = atom.position.as_dvec3().distance(sphere.center.as_dvec3());
        assert!(reach + f64::from(atom.element.vdw_radius()) <= f64::from(sphere.radius));
        assert!(molecule.chains.len() > molecule.residue(atom).chain as usize);
    }
    for bond in &molecule.bonds {
        assert!(bond.a < bond.b && bond.b < count && (1..=3).contains(&bond.order));
    }
    let ends = |i: usize| (molecule.bonds[i].a, molecule.bonds[i].b);
    assert!((1..molecule.bonds.len()).all(|i| ends(i - 1) < ends(i)), "sorted and unique");
}

#[test]
fn five_thousand_damaged_files_neither_panic_nor_break_promises() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let shipped = ["alpha_helix.pdb", "caffeine.xyz", "water.xyz"].map(|name| root.join("molecules").join(name));
    let real =
        ["acrolein.pdb", "psfgen-output.pdb", "MOF-5.pdb"].map(|name| root.join("../shared/data/molecules").join(name));
    let files: Vec<(String, Vec<u8>)> = shipped
        .iter()
        .chain(real.iter().filter(|path| path.is_file()))
        .map(|path| (path.display().to_string(), std::fs::read(path).expect("readable")))
        .chain(SAMPLES.iter().map(|&(name, text)| (name.to_string(), text.as_bytes().to_vec())))
        .collect();
    let mut random = Random(2016);
    let (mut num_loaded, mut num_refused) = (0, 0);
    for seed in 0..NUM_MUTATIONS {
        let (name, original) = &files[random.below(files.len())];
        let bytes = mutate(original, &mut random);
        let model = [ModelChoice::First, ModelChoice::All, ModelChoice::Number(seed % 3)][random.below(3)];
        let assembly = (name == "copies.pdb" && random.below(2) == 0).then(|| "1".to_string());
        match Scene::from_bytes_with(name, &bytes, &LoadOptions { model, assembly }) {
            Ok(scene) => {
                assert_sound(&scene.molecule);
                num_loaded += 1;
            }
            Err(error) => {
                let message = error.to_string();
                assert!(message.starts_with(name.as_str()) && message.is_ascii(), "{message}");
                num_refused += 1;
            }
        }
    }
    println!("{num_loaded} loaded, {num_refused} refused");
    assert!(num_loaded > 200 && num_refused > 200, "{num_loaded} {num_refused}");
}
