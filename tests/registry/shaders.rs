//! The registry of shaders, and the tables that a style is read by.

use std::collections::BTreeSet;

use restyle::config::param::check_table;
use restyle::config::{Catalog, SECTIONS};
use restyle::effects::{EFFECTS, PassTarget};
use restyle::engine;
use restyle::shading::{DEFAULT_SHADER, SHADERS, shader_index};

use super::{assert_none, at, text};

#[test]
fn names_are_unique_and_legal() {
    let mut seen = BTreeSet::new();
    for shader in SHADERS {
        let name = shader.name();
        assert!(seen.insert(name), "{name:?} is registered twice");
        // A name is also part of a file's name and of names in WGSL.
        let legal = name.starts_with(|first: char| first.is_ascii_lowercase())
            && name.bytes().all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_')
            && !name.contains("__");
        assert!(legal, "{name:?} is not in lower case with underscores");
        assert!(shader.doc().ends_with('.'), "{name}: its doc is not a sentence");
    }
    assert!(shader_index(DEFAULT_SHADER).is_some(), "{DEFAULT_SHADER} is not registered");
}

#[test]
fn every_shader_has_its_files() {
    for shader in SHADERS {
        let name = shader.name();
        let own = format!("objects/{name}.wgsl");
        let wgsl = shader.wgsl().last().map(|file| file.path);
        assert_eq!(wgsl, Some(own.as_str()), "{name}: its own file comes last");
        let entry = format!("fn {name}_{}(", if shader.stylises() { "stylised" } else { "shade" });
        assert!(text(&format!("shaders/{own}")).contains(&entry), "shaders/{own}: there is no `{entry}`");
        assert_eq!(shader.material_info().path, own, "{name}: its material is declared in its own file");
        assert!(at(&format!("src/shading/{name}.rs")).exists(), "src/shading/{name}.rs is missing");
    }
}

#[test]
fn every_shader_has_a_twin() {
    let main = text("tests/twins/main.rs");
    for shader in SHADERS {
        let name = shader.name();
        let twin = format!("tests/twins/{name}.rs");
        assert!(at(&twin).exists(), "{twin} is missing: {name} has no twin");
        assert!(main.contains(&format!("mod {name};")), "tests/twins/main.rs: there is no `mod {name};`");
    }
}

#[test]
fn every_effect_has_its_files_its_twin_and_an_end() {
    let main = text("tests/twins/main.rs");
    for effect in EFFECTS {
        let (name, file) = (effect.name(), effect.file());
        assert!(effect.doc().ends_with('.'), "{name}: its doc is not a sentence");
        let own = format!("effects/{file}.wgsl");
        assert_eq!(effect.params_info().path, own, "{name}: its parameters are declared in its own file");
        assert!(at(&format!("src/effects/{file}.rs")).exists(), "src/effects/{file}.rs is missing");
        assert!(main.contains(&format!("mod {file};")), "tests/twins/main.rs: {name} has no twin `mod {file};`");
        // Features may choose other files and other passes.
        let mut all_code = String::new();
        for features in 0..1 << effect.features().len() {
            let files = effect.wgsl(features);
            assert_eq!(files.last().map(|file| file.path), Some(own.as_str()), "{name}: its own file comes last");
            let code: String = files.iter().map(|file| text(&format!("shaders/{}", file.path))).collect();
            let passes = effect.passes(features);
            for pass in passes {
                assert!(code.contains(&format!("fn {}(", pass.entry)), "{name}: there is no `fn {}`", pass.entry);
            }
            let ends: Vec<bool> = passes.iter().map(|pass| pass.target == PassTarget::Picture).collect();
            assert!(ends.iter().rev().skip(1).all(|end| !end) && ends.last() == Some(&true), "{name}: {ends:?}");
            all_code.push_str(&code);
        }
        for feature in effect.features() {
            let chooses = effect.passes(0)
                != effect.passes(1 << effect.features().iter().position(|f| f == feature).unwrap_or(0));
            assert!(chooses || all_code.contains(feature), "shaders/{own}: nothing reads {feature}");
        }
    }
}

#[test]
fn every_feature_is_named_once_and_read_by_its_shader() {
    let mut seen = BTreeSet::new();
    for shader in SHADERS {
        let name = shader.name();
        assert!(shader.features().len() <= 32, "{name}: a feature is one bit of 32");
        for feature in shader.features() {
            assert!(seen.insert(feature), "{name}: {feature} is the name of two features");
            let read = shader.wgsl().iter().any(|file| {
                let code = file.text.lines().map(|line| line.split("//").next().unwrap_or_default());
                code.into_iter().any(|line| line.contains(feature))
            });
            assert!(read, "{name}: no file of its WGSL reads {feature}");
        }
    }
}

#[test]
fn every_table_of_parameters_is_sound() {
    let mut tables: Vec<_> = SECTIONS.iter().map(|section| (section.key, section.params)).collect();
    tables.extend(SHADERS.iter().map(|shader| (shader.name(), shader.params())));
    tables.extend(EFFECTS.iter().map(|effect| (effect.name(), effect.params())));
    let complaints = tables
        .iter()
        .flat_map(|(name, params)| check_table(params).into_iter().map(move |wrong| format!("{name}: {wrong}")));
    assert_none(&complaints.collect::<Vec<_>>());
}

#[test]
fn every_parameter_has_a_few_examples() {
    let tables = SECTIONS.iter().map(|section| (section.key, section.params));
    let tables = tables.chain(SHADERS.iter().map(|shader| (shader.name(), shader.params())));
    let tables = tables.chain(EFFECTS.iter().map(|effect| (effect.name(), effect.params())));
    let complaints = tables.flat_map(|(group, params)| {
        let bare = params.iter().filter(|param| !(2..=4).contains(&param.examples.len()));
        bare.map(move |param| format!("{group}: {:?} has {} examples, not 2 to 4", param.name, param.examples.len()))
    });
    assert_none(&complaints.collect::<Vec<_>>());
}

#[test]
fn the_catalog_is_sound() {
    let shaders = engine::catalog();
    assert_none(&Catalog { shaders: &shaders, kinds: engine::DRAWN_KINDS }.check());
}
