//! MTL: what an OBJ file says of its materials, in files beside it. Nothing that is wrong with them stops the mesh.

use std::collections::HashMap;

use glam::Vec3;

use super::names::Names;
use super::statement::{Statements, decoded, keyword, name, words};
use crate::scene::import::Import;
use crate::scene::import::lines::quote;
use crate::scene::import::number::float;
use crate::scene::mesh::MeshMaterial;
use crate::scene::report::NoteKind;

/// Linear grey of materials that no file describes: 0.8 in sRGB.
const GREY: f32 = 0.603_827_4;

/// The materials that faces use, in their order.
pub(super) fn read(import: &mut Import<'_>, names: &Names) -> Vec<MeshMaterial> {
    let mut known = HashMap::new();
    if !names.materials.is_empty() {
        for (line, library) in &names.libraries {
            read_libraries(import, *line, library, &mut known);
        }
    }
    let mut materials = Vec::with_capacity(names.materials.len());
    for name in &names.materials {
        let described: Option<&Described> = known.get(name);
        if described.is_none() {
            import.report.note(NoteKind::UnknownMaterial, None, || quote(name.as_bytes()));
        }
        if let Some(picture) = described.and_then(|described| described.picture.as_ref()) {
            import.report.note(NoteKind::PictureNotDrawn, None, || quote(picture.as_bytes()));
        }
        materials.push(described.unwrap_or(&Described::default()).material(name));
    }
    materials
}

/// Reads the file of a statement: names may hold spaces, and one statement may name several files.
fn read_libraries(import: &mut Import<'_>, line: u32, library: &str, known: &mut HashMap<String, Described>) {
    let whole = import.side_file(library);
    let several: Vec<&str> = library.split_whitespace().collect();
    if whole.is_err() && several.len() > 1 {
        for part in several {
            match import.side_file(part) {
                Ok(bytes) => parse(&bytes, known),
                Err(why) => note(import, line, part, &why.0),
            }
        }
        return;
    }
    match whole {
        Ok(bytes) => parse(&bytes, known),
        Err(why) => note(import, line, library, &why.0),
    }
}

fn note(import: &mut Import<'_>, line: u32, library: &str, why: &str) {
    import.report.note(NoteKind::MaterialFile, line, || format!("{} {why}", quote(library.as_bytes())));
}

/// What statements say of a material.
#[derive(Debug, Default, PartialEq)]
struct Described {
    /// sRGB.
    diffuse: Option<[f32; 3]>,
    dissolve: Option<f32>,
    transparency: Option<f32>,
    metallic: Option<f32>,
    roughness: Option<f32>,
    /// Exponent of a Phong highlight.
    shininess: Option<f32>,
    /// The file of the picture that it wears.
    picture: Option<String>,
}

/// Reads all materials of a file; later ones replace earlier ones of the same name.
fn parse(bytes: &[u8], known: &mut HashMap<String, Described>) {
    let text = decoded(bytes);
    let mut statements = Statements::new(&text);
    let mut current: Option<(String, Described)> = None;
    while let Some((_, statement)) = statements.next() {
        let (word, rest) = keyword(statement);
        if word == b"newmtl" {
            known.extend(current.replace((name(rest), Described::default())));
        } else if let Some((_, described)) = &mut current {
            described.add(word, rest);
        }
    }
    known.extend(current);
}

impl Described {
    fn add(&mut self, word: &[u8], rest: &[u8]) {
        // An option may stand before the number.
        let number = || words(rest).find_map(float).filter(|value| value.is_finite()).map(|value| value as f32);
        let set = |to: &mut Option<f32>| *to = number().or(*to);
        match word {
            b"Kd" => self.diffuse = color(rest).or(self.diffuse),
            b"d" => set(&mut self.dissolve),
            b"Tr" => set(&mut self.transparency),
            b"Pm" => set(&mut self.metallic),
            b"Pr" => set(&mut self.roughness),
            b"Ns" => set(&mut self.shininess),
            b"map_Kd" => self.picture = words(rest).last().map(name),
            _ => {}
        }
    }

    fn material(&self, name: &str) -> MeshMaterial {
        let share = |value: f32| value.clamp(0.0, 1.0);
        // A Phong lobe of exponent n is about as wide as a microfacet lobe of alpha = sqrt(2 / (n + 2)), and perceptual
        // roughness is the root of alpha.
        let of_phong = |exponent: f32| (2.0 / (exponent.max(0.0) + 2.0)).powf(0.25);
        MeshMaterial {
            name: name.to_owned(),
            base_color: self.diffuse.map_or(Vec3::splat(GREY), |color| Vec3::from_array(color.map(linear))),
            metallic: self.metallic.map(share),
            roughness: self.roughness.map(share).or(self.shininess.map(of_phong)),
            opacity: share(self.dissolve.or(self.transparency.map(|value| 1.0 - value)).unwrap_or(1.0)),
        }
    }
}

/// Three numbers, or one for all.
fn color(rest: &[u8]) -> Option<[f32; 3]> {
    let mut values = words(rest).map_while(float).map(|value| value as f32);
    let red = values.next()?;
    let color = match (values.next(), values.next()) {
        (Some(green), Some(blue)) => [red, green, blue],
        _ => [red; 3],
    };
    color.iter().all(|value| value.is_finite()).then_some(color)
}

/// Linear light of an sRGB value.
fn linear(value: f32) -> f32 {
    let value = value.clamp(0.0, 1.0);
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_become_linear_colours_and_shares() {
        let mut known = HashMap::new();
        parse(
            b"Kd 1 1 1\nnewmtl a b\r\n  Kd 0.5 0 1 # pink\n\td -halo 0.25\nNs 6\nmap_Kd -s 1 1 1 wood.png\n\nnewmtl steel\n\
              Kd 0.2\nTr 0.75\nPm 2\nPr 0.3\nNs 1000\nKs nonsense\nnewmtl bad\nKd x y z\nd nan\n",
            &mut known,
        );
        let first = &known["a b"];
        assert_eq!(first.picture.as_deref(), Some("wood.png"));
        let material = first.material("a b");
        assert!(material.base_color.distance(Vec3::new(0.214_041, 0.0, 1.0)) < 1e-5, "{}", material.base_color);
        assert_eq!((material.opacity, material.metallic), (0.25, None));
        assert!((material.roughness.expect("from Ns") - 0.25_f32.powf(0.25)).abs() < 1e-6);
        let steel = known["steel"].material("steel");
        assert_eq!((steel.opacity, steel.metallic, steel.roughness), (0.25, Some(1.0), Some(0.3)));
        assert!((steel.base_color - 0.033_105).abs().max_element() < 1e-5);
        assert_eq!(known["bad"], Described::default());
        assert!((linear(0.8) - GREY).abs() < 1e-6);
    }
}
