//! Thousands of damaged files, seeded: none may panic, and none may break what molecules and meshes promise.

use restyle::scene::{LoadOptions, ModelChoice, Molecule, Scene};
use std::path::PathBuf;

/// Damaged files. At some 0.2 ms each, more would only repeat.
const NUM_MUTATIONS: u32 = 2000;

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
    for atom in &molecule.atoms {
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
fn two_thousand_damaged_files_neither_panic_nor_break_promises() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let shipped = ["alpha_helix.pdb", "caffeine.xyz", "water.xyz"].map(|name| root.join("molecules").join(name));
    let real =
        ["acrolein.pdb", "psfgen-output.pdb", "MOF-5.pdb"].map(|name| root.join("../shared/data/molecules").join(name));
    let files: Vec<(String, Vec<u8>)> = shipped
        .iter()
        .chain(real.iter().filter(|path| path.is_file()))
        .map(|path| (path.display().to_string(), std::fs::read(path).expect("readable")))
        .collect();
    let mut random = Random(2016);
    let (mut num_loaded, mut num_refused) = (0, 0);
    for seed in 0..NUM_MUTATIONS {
        let (name, original) = &files[random.below(files.len())];
        let bytes = mutate(original, &mut random);
        let model = [ModelChoice::First, ModelChoice::All, ModelChoice::Number(seed % 3)][random.below(3)];
        match Scene::from_bytes_with(name, &bytes, &LoadOptions { model, ..LoadOptions::default() }) {
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
