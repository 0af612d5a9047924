//! Every shader module that the program can compose, read and validated by naga.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::sync::OnceLock;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, Handle, Type, TypeInner};
use restyle::effects::EFFECTS;
use restyle::frame::bkb::{self, BkbForm, BkbKey, FragmentKind};
use restyle::frame::mesh::MeshForm;
use restyle::frame::sort;
use restyle::frame::{
    Drawn, EffectKey, Finish, LayerWork, ShadeKey, ShaderNeeds, ShadowFilter, VisibilityKey, aov_module, effect_module,
    layers, mesh_module, resolve_module, shade_module, visibility_module,
};
use restyle::gpu::Module;
use restyle::shading::SHADERS;

use super::{assert_none, files_below};

/// One struct of a module.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct WgslStruct {
    /// Its name.
    pub name: String,
    /// The file that declares it, below `shaders/`.
    pub file: &'static str,
    /// The line of its name.
    pub line: usize,
    /// Names and offsets of its members.
    pub fields: Vec<(String, usize)>,
    /// Bytes.
    pub size: usize,
    /// Whether a uniform or storage buffer holds it, alone or within another.
    pub in_buffer: bool,
}

/// What all modules together hold.
#[derive(Default)]
pub struct Survey {
    /// Mistakes, each with the first module that has it.
    pub mistakes: BTreeMap<String, String>,
    /// Files that are part of a module.
    pub files: BTreeSet<&'static str>,
    /// Structs, one entry for each declaration and layout.
    pub structs: BTreeSet<WgslStruct>,
}

/// The survey of all modules, made once.
pub fn survey() -> &'static Survey {
    static SURVEY: OnceLock<Survey> = OnceLock::new();
    SURVEY.get_or_init(|| {
        let mut survey = Survey::default();
        for orthographic in [false, true] {
            for hulls in [false, true] {
                for light in [false, true] {
                    for drawn in [Drawn::All, Drawn::Opaque, Drawn::CountedLayers, Drawn::WrittenLayers] {
                        if drawn.is_layers() && (hulls || light) {
                            continue;
                        }
                        let key = VisibilityKey { hulls, orthographic, light, drawn };
                        survey.read(&format!("visibility of atoms, {key:?}"), &visibility_module(true, key));
                        survey.read(&format!("visibility of connectors, {key:?}"), &visibility_module(false, key));
                        for (shell, numbered) in [(false, false), (false, true), (true, false), (true, true)] {
                            let name = format!("visibility of meshes, shell {shell}, numbered {numbered}, {key:?}");
                            survey.read(&name, &mesh_module(key, shell, numbered));
                        }
                    }
                }
            }
            for meshes in [false, true] {
                let name = format!("aov, orthographic {orthographic}, meshes {meshes}");
                survey.read(&name, &aov_module(orthographic, meshes));
            }
        }
        survey.read("resolve", &resolve_module());
        survey.read("room of layers", &layers::room_module());
        for class in 0..sort::CLASSES {
            survey.read(&format!("sorted layers of class {class}"), &sort::sort_module(class));
        }
        survey.read("nearest layers", &layers::nearest_module());
        for key in effect_keys() {
            survey.read(&format!("effect, {key:?}"), &effect_module(&key));
        }
        for key in shade_keys() {
            survey.read(&format!("shade, {key:?}"), &shade_module(&key));
        }
        survey.read("buckets of the k-buffer", &bkb::buckets_module());
        for key in bkb_keys() {
            survey.read_bkb(&key);
        }
        survey
    })
}

impl Survey {
    /// Reads all modules of a bucketed k-buffer.
    fn read_bkb(&mut self, key: &BkbKey) {
        self.read(&format!("clearing of the k-buffer, {:?}", key.form), &bkb::clear_module(key.form));
        self.read(&format!("blending of the k-buffer, {key:?}"), &bkb::blend_module(key));
        for kind in FragmentKind::ALL.into_iter().filter(|kind| kind.is_in(&key.shade)) {
            for numbered in [false, true] {
                let inserted = bkb::insert_module(kind, key.form, key.shade.orthographic, numbered);
                self.read(&format!("insertion of {kind:?}, numbered {numbered}, {:?}", key.form), &inserted);
                let stored = bkb::store_module(kind, key, numbered);
                self.read(&format!("storing of {kind:?}, numbered {numbered}, {key:?}"), &stored);
            }
        }
    }

    fn read(&mut self, name: &str, module: &Module) {
        let text = module.text();
        self.files.extend((1..=text.lines().count()).map(|line| module.place(line).0));
        let place = |line: u32| {
            let (file, line) = module.place(line as usize);
            if file.ends_with(".wgsl") { format!("shaders/{file}:{line}") } else { format!("{file}:{line}") }
        };
        let mut mistake = |line: Option<u32>, message: String| {
            let place = line.map_or("no line".to_owned(), place);
            self.mistakes.entry(format!("{place}: {message}")).or_insert(name.to_owned());
        };
        let parsed = match naga::front::wgsl::parse_str(&text) {
            Ok(parsed) => parsed,
            Err(error) => {
                return mistake(error.location(&text).map(|at| at.line_number), error.message().to_owned());
            }
        };
        // Half floats are packed in 32 bits, which every adapter unpacks. Where triangles have no numbers, other modules do.
        let asked = Capabilities::SHADER_FLOAT16_IN_FLOAT32 | Capabilities::PRIMITIVE_INDEX;
        let mut validator = Validator::new(ValidationFlags::all(), asked);
        if let Err(error) = validator.validate(&parsed) {
            let mut message = error.as_inner().to_string();
            let mut cause = error.as_inner().source();
            while let Some(error) = cause {
                message.push_str(&format!(": {error}"));
                cause = error.source();
            }
            mistake(error.location(&text).map(|at| at.line_number), message);
        }
        self.structs.extend(structs(&parsed, &text, module));
    }
}

fn structs(parsed: &naga::Module, text: &str, module: &Module) -> Vec<WgslStruct> {
    let mut in_buffer = BTreeSet::new();
    for (_, variable) in parsed.global_variables.iter() {
        if matches!(variable.space, AddressSpace::Uniform | AddressSpace::Storage { .. } | AddressSpace::Immediate) {
            collect(parsed, variable.ty, &mut in_buffer);
        }
    }
    let declared = parsed.types.iter().filter_map(|(handle, ty)| {
        let (TypeInner::Struct { members, span }, Some(name)) = (&ty.inner, &ty.name) else { return None };
        let at = text.find(&format!("struct {name} {{")).expect("naga knows it from the text");
        let (file, line) = module.place(text[..at].matches('\n').count() + 1);
        let fields = members.iter().map(|member| (member.name.clone().unwrap_or_default(), member.offset as usize));
        Some(WgslStruct {
            name: name.clone(),
            file,
            line,
            fields: fields.collect(),
            size: *span as usize,
            in_buffer: in_buffer.contains(&handle),
        })
    });
    declared.collect()
}

/// A type and what it is made of.
fn collect(parsed: &naga::Module, ty: Handle<Type>, into: &mut BTreeSet<Handle<Type>>) {
    if !into.insert(ty) {
        return;
    }
    match &parsed.types[ty].inner {
        TypeInner::Struct { members, .. } => members.iter().for_each(|member| collect(parsed, member.ty, into)),
        TypeInner::Array { base, .. } | TypeInner::BindingArray { base, .. } => collect(parsed, *base, into),
        _ => (),
    }
}

/// How many yes-or-no questions a [`ShadeKey`] answers, beside its list of shaders.
const NUM_SWITCHES: u32 = 23;

/// Answers, one a bit, of which at most one differs from the rest.
fn covering_switches() -> impl Iterator<Item = u32> {
    (0..1 << NUM_SWITCHES).filter(|bits: &u32| !(2..=NUM_SWITCHES - 2).contains(&bits.count_ones()))
}

/// Keys of the shading pass: every set of shaders with the covering answers. Any three questions are so answered in all
/// combinations, and most combinations of all are left out.
fn shade_keys() -> Vec<ShadeKey> {
    let mut keys = Vec::new();
    for shaders in 0..1u32 << SHADERS.len() {
        for switches in covering_switches() {
            let features = if switches >> 10 & 1 == 1 { u32::MAX } else { 0 };
            keys.push(shade_key(shaders, switches, features));
        }
    }
    for (index, shader) in SHADERS.iter().enumerate() {
        keys.extend((0..shader.features().len()).map(|bit| shade_key(1 << index, 0b11, 1 << bit)));
    }
    keys
}

/// Keys of every post effect: each set of its features with each camera and each end.
fn effect_keys() -> Vec<EffectKey> {
    let mut keys = Vec::new();
    for (effect, registered) in EFFECTS.iter().enumerate() {
        for features in 0..1 << registered.features().len() {
            for orthographic in [false, true] {
                let ends = [(Finish::Next, false), (Finish::Next, true), (Finish::Add, false), (Finish::Encode, false)];
                let key =
                    |(finish, leaves_surfaces)| EffectKey { effect, features, orthographic, finish, leaves_surfaces };
                keys.extend(ends.map(key));
            }
        }
    }
    keys
}

/// Keys of the bucketed k-buffer: each form with each camera and end, all shaders, with and without shadows and each kind of object.
fn bkb_keys() -> Vec<BkbKey> {
    let forms = [BkbForm::Published, BkbForm::OneWay, BkbForm::BruteForce, BkbForm::DualPass];
    let all_shaders = (1 << SHADERS.len()) - 1;
    let mut keys = Vec::new();
    for form in forms {
        for orthographic in [0, 1 << 11] {
            for (shadows, finish) in [(0, Finish::Next), (1 << 7, Finish::Add), (1 << 7, Finish::Encode)] {
                for kinds in [0b11, 1 << 13, 1 << 13 | 0b11] {
                    let shade = shade_key(all_shaders, kinds | shadows | orthographic, u32::MAX);
                    let keeps_kappa = finish == Finish::Add && form != BkbForm::DualPass;
                    keys.push(BkbKey { shade, form, finish, keeps_kappa });
                }
            }
        }
    }
    keys
}

fn shade_key(shaders: u32, switches: u32, features: u32) -> ShadeKey {
    let on = |switch: u32| switches >> switch & 1 == 1;
    let used = (0..SHADERS.len()).filter(|index| shaders >> index & 1 == 1);
    ShadeKey {
        shaders: used
            .map(|shader| ShaderNeeds { shader, features, only_material: on(9).then_some(shader as u32) })
            .collect(),
        atoms: on(0),
        connectors: on(1),
        atom_material: on(2).then_some(0),
        connector_material: on(3).then_some(1),
        meshes: on(13).then_some(MeshForm { shared: on(18), placed: on(19), colored: on(20) }),
        part_material: on(14).then_some(2),
        hulls: on(4),
        lights: if on(5) { 8 } else { 0 },
        point_lights: on(6),
        ambient: on(22),
        shadows: on(7),
        encode: on(8),
        soft_taps: if on(12) { 16 } else { 0 },
        geometry: on(15),
        layer_work: match (on(21), on(16)) {
            (false, false) => LayerWork::Blend,
            (false, true) => LayerWork::Mark { keeps_light: on(8) },
            (true, _) => LayerWork::Keep,
        },
        layers: on(17).then_some((if on(16) { Finish::Add } else { Finish::Next }, on(15))),
        shadow_filter: if on(16) { ShadowFilter::Depth } else { ShadowFilter::Objects },
        orthographic: on(11),
    }
}

#[test]
fn every_module_parses_and_validates() {
    let complaints: Vec<String> =
        survey().mistakes.iter().map(|(mistake, module)| format!("{mistake} (in {module})")).collect();
    assert_none(&complaints);
}

#[test]
fn every_shader_file_is_part_of_a_module() {
    let files = files_below("shaders", ".wgsl");
    assert!(!files.is_empty(), "there are no shaders");
    let unused = files.iter().filter(|file| !survey().files.contains(file.trim_start_matches("shaders/")));
    assert_none(&unused.map(|file| format!("{file}: no module uses it")).collect::<Vec<_>>());
}

#[test]
fn any_three_switches_are_tried_in_every_combination() {
    for chosen in (0..1u32 << NUM_SWITCHES).filter(|bits| bits.count_ones() == 3) {
        let answers: BTreeSet<u32> = covering_switches().map(|switches| switches & chosen).collect();
        assert_eq!(answers.len(), 8, "{chosen:b}");
    }
}
