//! Thousands of damaged files, seeded: none may panic, and none may break what molecules and meshes promise.

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
    b" ? ",
    b" . ",
    b"'",
    b"\n;",
    b"\n;\n",
    b"\nloop_\n",
    b"\ndata_x\n",
    b"\n_atom_site.Cartn_x\n",
    b"1-60",
    b"(1-9999)(1-9999)",
    b"\xdd\xff\xff\xff\xff",
    b"\x91",
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

/// A small mmCIF with all tables that are read, written in one row of atoms per line.
const MMCIF: &str = "data_x\n_cell.length_a 10\n_cell.length_b 11\n_cell.length_c 12\n_cell.angle_beta 95.5\nloop_\n\
    _pdbx_struct_assembly_gen.assembly_id\n_pdbx_struct_assembly_gen.oper_expression\n\
    _pdbx_struct_assembly_gen.asym_id_list\n1 (1)(1-2) A,B\n2 1,2 A\nloop_\n_pdbx_struct_oper_list.id\n\
    _pdbx_struct_oper_list.matrix[1][1]\n_pdbx_struct_oper_list.matrix[1][2]\n_pdbx_struct_oper_list.matrix[1][3]\n\
    _pdbx_struct_oper_list.vector[1]\n_pdbx_struct_oper_list.matrix[2][1]\n_pdbx_struct_oper_list.matrix[2][2]\n\
    _pdbx_struct_oper_list.matrix[2][3]\n_pdbx_struct_oper_list.vector[2]\n_pdbx_struct_oper_list.matrix[3][1]\n\
    _pdbx_struct_oper_list.matrix[3][2]\n_pdbx_struct_oper_list.matrix[3][3]\n_pdbx_struct_oper_list.vector[3]\n\
    1 1 0 0 0 0 1 0 0 0 0 1 0\n2 0 -1 0 0 1 0 0 0 0 0 1 20\nloop_\n_struct_conn.conn_type_id\n\
    _struct_conn.ptnr1_label_asym_id\n_struct_conn.ptnr1_label_seq_id\n_struct_conn.ptnr1_label_atom_id\n\
    _struct_conn.ptnr2_label_asym_id\n_struct_conn.ptnr2_label_seq_id\n_struct_conn.ptnr2_label_atom_id\n\
    covale A 1 N B 2 O\nmetalc A 1 CA B 3 FE\nloop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n\
    _chem_comp_bond.atom_id_2\n_chem_comp_bond.value_order\nALA N CA SING\nALA CA C doub\nloop_\n\
    _atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_alt_id\n\
    _atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_seq_id\n_atom_site.Cartn_x\n\
    _atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.occupancy\n_atom_site.pdbx_PDB_model_num\n\
    ATOM 1 N N . ALA A 1 0.0 0.0 0.0 1.00 1\nATOM 2 C CA A ALA A 1 1.4 0.1 0.0 0.60 1\n\
    ATOM 3 C CA B ALA A 1 1.4 0.0 0.2 0.40 1\nATOM 4 C C . ALA A 1 2.1 1.3 0.0 1.00 1\n\
    HETATM 5 O \"O\" . HOH B 2 5.1 1.3 0.0 1.00 1\nHETATM 6 FE FE . HEM B 3 2.1 3.3 0.0 1.00 2\n";

/// A small crystal in two data blocks.
const CRYSTAL: &str = "data_a\n_cell_length_a 5.64(1)\n_cell_length_b 5.64\n_cell_length_c 5.64\n_cell_angle_gamma 120\n\
    loop_\n_symmetry_equiv_pos_as_xyz\nx,y,z\n'-x+1/2, y, -z'\nx-y,x,z+1/3\nloop_\n_atom_site_label\n\
    _atom_site_type_symbol\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n_atom_site_occupancy\n\
    _atom_site_disorder_group\nNa1 Na1+ 0 0 0 1 .\nCl1 Cl- 0.5 0.5(2) 0.5 0.5 1\nC2 C .1 .2 .3 0.5 2\ndata_b\n\
    _cell_length_a 5\n_cell_length_b 6\n_cell_length_c 7\n_atom_site_label C1\n_atom_site_fract_x 0.1\n\
    _atom_site_fract_y 0.2\n_atom_site_fract_z 0.3\n";

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
    for (center, radius) in molecule.drawn_balls() {
        let reach = center.as_dvec3().distance(sphere.center.as_dvec3());
        assert!(reach + f64::from(radius) <= f64::from(sphere.radius));
    }
    assert!(
        molecule.copies.iter().flat_map(|copy| &copy.atoms).all(|range| range.start < range.end && range.end <= count)
    );
    for atom in &molecule.atoms {
        assert!(molecule.chains.len() > molecule.residue(atom).chain as usize);
    }
    for bond in &molecule.bonds {
        assert!(bond.a < bond.b && bond.b < count && (1..=3).contains(&bond.order));
    }
    let ends = |i: usize| (molecule.bonds[i].a, molecule.bonds[i].b);
    assert!((1..molecule.bonds.len()).all(|i| ends(i - 1) < ends(i)), "sorted and unique");
}

/// Small meshes of each kind with most of what the kind has; the last is binary.
fn small_meshes() -> Vec<(String, Vec<u8>)> {
    let obj = "mtllib a.mtl\no box\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nvn 0 0 1\ng lid\n\
        usemtl red\nf 1//1 2//1 3//1 4//1\nusemtl blue\nf -4 -3 \\\n -2\nf 1 2 3 4 2\n";
    let stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n\
        endsolid a\nsolid b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 5\nendloop\nendfacet\n\
        endsolid b\n";
    let header = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
        property uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
    let ply = format!(
        "ply\nformat ascii 1.0\n{header}0 0 0 9 9 9\n1 0 0 9 9 9\n1 1 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2\n4 0 1 2 3\n"
    );
    let off = "COFF\n4 2 0\n0 0 0 255 0 0 255\n1 0 0 0 0 0 255\n1 1 0 0 0 0 255\n0 1 0 0 0 0 255\n3 0 1 2\n4 0 1 2 3\n";
    let mut binary = format!("ply\nformat binary_little_endian 1.0\n{header}").into_bytes();
    for [x, y] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0_f32]] {
        [x, y, 0.0].iter().for_each(|value| binary.extend(value.to_le_bytes()));
        binary.extend([9, 9, 9]);
    }
    for face in [&[0_i32, 1, 2][..], &[0, 1, 2, 3]] {
        binary.push(face.len() as u8);
        face.iter().for_each(|index| binary.extend(index.to_le_bytes()));
    }
    let mut facets = b"solid but binary".to_vec();
    facets.resize(80, b' ');
    facets.extend(4_u32.to_le_bytes());
    for i in 0..4 {
        let floats = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, i as f32];
        floats.iter().for_each(|value| facets.extend(value.to_le_bytes()));
        facets.extend([0, 0]);
    }
    let texts = [("a.obj", obj), ("a.stl", stl), ("a.ply", ply.as_str()), ("a.off", off)];
    let texts = texts.map(|(name, text)| (name.to_string(), text.as_bytes().to_vec()));
    texts.into_iter().chain([("b.ply".to_string(), binary), ("b.stl".to_string(), facets)]).collect()
}

#[test]
fn four_thousand_damaged_meshes_neither_panic_nor_break_promises() {
    let files = small_meshes();
    for (name, bytes) in &files {
        assert!(Scene::from_bytes(name, bytes).is_ok(), "{name}");
    }
    let mut random = Random(1987);
    let (mut num_loaded, mut num_refused) = (0, 0);
    for _ in 0..NUM_MUTATIONS * 2 {
        let (name, original) = &files[random.below(files.len())];
        let bytes = mutate(original, &mut random);
        match Scene::from_bytes(name, &bytes) {
            Ok(scene) => {
                num_loaded += 1;
                for shape in &scene.assembly.shapes {
                    let count = shape.positions.len();
                    assert!(shape.triangles.as_flattened().iter().all(|&index| (index as usize) < count));
                    assert!(shape.colors.is_empty() || shape.colors.len() == count);
                }
            }
            Err(error) => {
                let message = error.to_string();
                assert!(message.starts_with(name.as_str()) && message.is_ascii(), "{message}");
                num_refused += 1;
            }
        }
    }
    println!("{num_loaded} loaded, {num_refused} refused");
    assert!(num_loaded > 400 && num_refused > 400, "{num_loaded} {num_refused}");
}

#[test]
fn five_thousand_damaged_files_neither_panic_nor_break_promises() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let shipped = ["alpha_helix.pdb", "caffeine.xyz", "water.xyz"].map(|name| root.join("molecules").join(name));
    let real = ["acrolein.pdb", "psfgen-output.pdb", "MOF-5.pdb", "1cbs_full.bcif"]
        .map(|name| root.join("../shared/data/molecules").join(name));
    let files: Vec<(String, Vec<u8>)> = shipped
        .iter()
        .chain(real.iter().filter(|path| path.is_file()))
        .map(|path| (path.display().to_string(), std::fs::read(path).expect("readable")))
        .chain([MMCIF, CRYSTAL].map(|text| ("small.cif".to_string(), text.as_bytes().to_vec())))
        .chain(SAMPLES.iter().map(|&(name, text)| (name.to_string(), text.as_bytes().to_vec())))
        .collect();
    let mut random = Random(2016);
    let (mut num_loaded, mut num_refused) = (0, 0);
    for seed in 0..NUM_MUTATIONS {
        let (name, original) = &files[random.below(files.len())];
        let bytes = mutate(original, &mut random);
        let model = [ModelChoice::First, ModelChoice::All, ModelChoice::Number(seed % 3)][random.below(3)];
        let assembly = [None, None, Some("1"), Some("cell")][random.below(4)].map(str::to_string);
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

/// A glTF of one triangle, whose numbers are all of what can be wrong in one.
const GLTF: &[u8] = br#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"a","children":[1],"scale":[1,2,3]},{"mesh":0,"rotation":[0,0,0,1]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":4,"material":0}]}],"materials":[{"name":"red"}],
"accessors":[{"bufferView":0,"byteOffset":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3}],
"buffers":[{"byteLength":39,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAEC"}]}"#;

/// What importers of glTF stumble over, in place of a number.
const NASTY_VALUES: &[&str] = &[
    "-1",
    "0",
    "1",
    "7",
    "255",
    "5123",
    "4294967296",
    "18446744073709551615",
    "1e308",
    "null",
    "[]",
    "{}",
    "\"x\"",
    "",
];

#[test]
fn damaged_meshes_neither_panic_nor_break_promises() {
    let mut random = Random(2017);
    let (mut num_loaded, mut num_refused) = (0, 0);
    for _ in 0..NUM_MUTATIONS {
        let mut bytes = if random.below(4) == 0 { mutate(GLTF, &mut random) } else { GLTF.to_vec() };
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len() + 1);
            let Some(start) = (at..bytes.len()).find(|&i| bytes[i].is_ascii_digit()) else { continue };
            let end = (start..bytes.len()).find(|&i| !bytes[i].is_ascii_digit()).unwrap_or(bytes.len());
            bytes.splice(start..end, NASTY_VALUES[random.below(NASTY_VALUES.len())].bytes());
        }
        match Scene::from_bytes_with("a.gltf", &bytes, &LoadOptions::default()) {
            Ok(scene) => {
                let assembly = &scene.assembly;
                assert!(assembly.sphere.radius.is_finite() && !assembly.parts.is_empty());
                assert!(assembly.parts.iter().all(|part| part.world_from_shape.is_finite()));
                for shape in &assembly.shapes {
                    assert!(shape.positions.iter().all(|position| position.is_finite()));
                    let count = shape.positions.len() as u32;
                    assert!(shape.triangles.as_flattened().iter().all(|&index| index < count));
                }
                num_loaded += 1;
            }
            Err(error) => {
                let message = error.to_string();
                assert!(message.starts_with("a.gltf") && message.is_ascii(), "{message}");
                num_refused += 1;
            }
        }
    }
    println!("{num_loaded} loaded, {num_refused} refused");
    assert!(num_loaded > 100 && num_refused > 200, "{num_loaded} {num_refused}");
}
