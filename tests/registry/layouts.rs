//! Structs that Rust writes and WGSL reads lie the same on both sides.

use std::collections::{BTreeMap, BTreeSet};

use restyle::frame::gpu_structs;
use restyle::gpu::StructInfo;

use super::assert_none;
use super::modules::{WgslStruct, survey};

/// Members as both sides must have them: padding may be named as it likes, but must be there.
fn fields<'a>(named: impl Iterator<Item = (&'a str, usize)>) -> Vec<String> {
    named.map(|(name, offset)| format!("{} at {offset}", if name.starts_with('_') { "_" } else { name })).collect()
}

/// What differs between the two sides.
fn differences(rust: &StructInfo, wgsl: &WgslStruct) -> Vec<String> {
    let rust_fields = fields(rust.fields.iter().map(|field| (field.name, field.offset)));
    let wgsl_fields = fields(wgsl.fields.iter().map(|(name, offset)| (name.as_str(), *offset)));
    let mut differences = Vec::new();
    for index in 0..rust_fields.len().max(wgsl_fields.len()) {
        let none = "nothing".to_owned();
        let (rust, wgsl) = (rust_fields.get(index).unwrap_or(&none), wgsl_fields.get(index).unwrap_or(&none));
        if rust != wgsl {
            differences.push(format!("member {index} is `{rust}` in Rust and `{wgsl}` in WGSL"));
        }
    }
    if rust.size != wgsl.size {
        differences.push(format!("{} bytes in Rust and {} in WGSL", rust.size, wgsl.size));
    }
    differences
}

#[test]
fn every_gpu_struct_equals_its_wgsl() {
    let mut complaints = BTreeSet::new();
    for rust in gpu_structs() {
        let named: Vec<&WgslStruct> = survey().structs.iter().filter(|wgsl| wgsl.name == rust.name).collect();
        if !named.iter().any(|wgsl| wgsl.file == rust.path) {
            complaints.insert(format!("shaders/{}: no module takes a struct {} from there", rust.path, rust.name));
        }
        for wgsl in named {
            let place = format!("shaders/{}:{}: struct {}", wgsl.file, wgsl.line, rust.name);
            complaints.extend(differences(&rust, wgsl).iter().map(|difference| format!("{place}: {difference}")));
        }
    }
    assert_none(&complaints.into_iter().collect::<Vec<_>>());
}

#[test]
fn every_struct_of_a_buffer_is_listed() {
    let listed: BTreeMap<&str, StructInfo> = gpu_structs().into_iter().map(|info| (info.name, info)).collect();
    let in_buffers: Vec<&WgslStruct> = survey().structs.iter().filter(|wgsl| wgsl.in_buffer).collect();
    assert!(!in_buffers.is_empty(), "no module has a struct in a buffer");
    let missing = in_buffers.iter().filter(|wgsl| !listed.contains_key(wgsl.name.as_str())).map(|wgsl| {
        format!(
            "shaders/{}:{}: struct {} lies in a buffer, but frame::gpu_structs() lacks it",
            wgsl.file, wgsl.line, wgsl.name
        )
    });
    assert_none(&missing.collect::<Vec<_>>());
}

#[test]
fn a_name_means_one_struct() {
    let mut names: Vec<&str> = gpu_structs().iter().map(|info| info.name).collect();
    names.sort_unstable();
    let twice = names.windows(2).filter(|pair| pair[0] == pair[1]);
    assert_none(&twice.map(|pair| format!("frame::gpu_structs() has two of {}", pair[0])).collect::<Vec<_>>());
}
