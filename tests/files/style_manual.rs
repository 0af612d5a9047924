//! The manual of style files: current, with all its pictures, and true to the loader.

use std::collections::BTreeSet;

use restyle::config::manual::{FILE, PICTURES, Shown, manual, strips};
use restyle::config::{SECTIONS, Source, load};
use restyle::scene::Scene;
use restyle::shipped::{SCENES, find};

use super::style_schema::{House, Verdict, at, judge};

/// How to make it anew.
const RENEW: &str = "renew it with its pictures: restyle schema --manual docs";

#[test]
fn the_committed_manual_is_current() {
    let committed = std::fs::read_to_string(at("docs").join(FILE)).unwrap_or_default();
    assert!(committed == manual(&House::new().catalog()), "docs/{FILE} is not what the tables say; {RENEW}");
}

#[test]
fn every_picture_of_the_manual_is_there_and_no_other() {
    let house = House::new();
    let text = manual(&house.catalog());
    let named =
        text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).filter(|link| link.ends_with(".png"));
    let named: BTreeSet<String> = named.map(str::to_owned).collect();
    let folder = at("docs").join(PICTURES);
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap());
    let mut bytes = 0;
    let there: BTreeSet<String> = files
        .map(|file| {
            bytes += file.metadata().unwrap().len();
            format!("{PICTURES}/{}", file.file_name().to_string_lossy())
        })
        .collect();
    assert_eq!(named, there, "the manual names (left) other pictures than there are (right); {RENEW}");
    assert_eq!(named.len(), strips(&house.catalog()).len());
    assert!(bytes <= 800_000, "{bytes} bytes of pictures are too many to keep");
}

#[test]
fn every_style_of_the_manual_loads_and_is_valid() {
    let house = House::new();
    let validator = house.validator();
    let text = manual(&house.catalog());
    let examples: Vec<&str> = text.split("```json\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(examples.len(), 2);
    for example in examples {
        assert_eq!(judge(&house, &validator, example), Verdict::BothTake, "{example}");
    }
}

#[test]
fn every_picture_can_be_drawn() {
    let house = House::new();
    for strip in strips(&house.catalog()) {
        let name = strip.name();
        for style in &strip.styles {
            let style = load(&Source::new(name.as_str(), style.as_bytes()), &house.catalog());
            let style = style.unwrap_or_else(|mistakes| panic!("{mistakes}"));
            assert_eq!(style.warnings, [], "{name}");
        }
        let scene = match strip.scene {
            Shown::Pdb(text) => Scene::from_bytes("manual.pdb", text.as_bytes()),
            Shown::Shipped(shipped) => {
                let file = SCENES.iter().find_map(|among| find(among, shipped));
                let file = file.unwrap_or_else(|| panic!("{name}: there is no {shipped:?}"));
                Scene::from_bytes(file.file, file.bytes)
            }
        };
        assert!(scene.is_ok_and(|scene| !scene.molecule.atoms.is_empty() || !scene.assembly.is_empty()), "{name}");
    }
}

#[test]
fn every_parameter_is_in_the_manual() {
    let house = House::new();
    let text = manual(&house.catalog());
    let sections = SECTIONS.iter().map(|section| (section.key, section.params));
    let shaders = house.0.iter().map(|entry| (entry.name, entry.params));
    for (group, params) in sections.chain(shaders) {
        for param in params {
            let heading = format!("### {group}: `{}`\n\n{}\n\n{}\n", param.name, param.doc, param.facts());
            assert!(text.contains(&heading), "{heading}");
        }
    }
    for entry in &house.0 {
        let titles = [format!("## Shader `{}`\n", entry.name), format!("## Post effect `{}`\n", entry.name)];
        assert!(titles.iter().any(|title| text.contains(title)), "{}", entry.name);
    }
}
