//! Two thousand damaged files, seeded: none may panic, and none may break what a molecule promises.

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
