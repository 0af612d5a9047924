//! The WGSL of the bucketed k-buffer's passes.

use super::{BkbForm, BkbKey};
use crate::frame::shade::{ShadeKey, add_shading, stylising_by_kappa};
use crate::frame::visibility::{self, Drawn, Kind, VisibilityKey};
use crate::gpu::Module;
use crate::wgsl;

/// Objects of one kind, whose fragments are stored by pipelines of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FragmentKind {
    /// Atoms.
    Atoms,
    /// Connectors.
    Connectors,
    /// Triangles of meshes.
    Meshes,
}

impl FragmentKind {
    /// All of them.
    pub const ALL: [FragmentKind; 3] = [FragmentKind::Atoms, FragmentKind::Connectors, FragmentKind::Meshes];

    pub(super) fn drawn(self) -> Kind {
        match self {
            FragmentKind::Atoms => Kind::Atom,
            FragmentKind::Connectors => Kind::Connector,
            FragmentKind::Meshes => Kind::Mesh,
        }
    }

    /// Whether a frame of this key has such objects.
    pub fn is_in(self, key: &ShadeKey) -> bool {
        match self {
            FragmentKind::Atoms => key.atoms,
            FragmentKind::Connectors => key.connectors,
            FragmentKind::Meshes => key.meshes.is_some(),
        }
    }

    /// How the number of an object's shape is found from the index of its id.
    fn shape(self) -> &'static str {
        match self {
            FragmentKind::Atoms => "index",
            FragmentKind::Connectors => "bkb.first_connector + index",
            FragmentKind::Meshes => "bkb.first_part + mesh_corners(index).part",
        }
    }
}

/// What shaders know of the form.
fn form_constants(form: BkbForm) -> String {
    format!("const DATA_WORDS: u32 = {}u;\nconst DUAL_PASS: bool = {};", form.data_words(), form.is_dual_pass())
}

/// `layer_key`: what Z holds of a fragment. The plain dual-pass k-buffer knows no shapes, and has all 32 bits for depths.
fn key_function(kind: FragmentKind, form: BkbForm) -> String {
    let body = if form.is_dual_pass() {
        "    return bitcast<u32>(t);".to_owned()
    } else {
        format!(
            "    let index = id & INDEX_MASK;\n    return stored_depth(bkb, t) << 16u | (({}) & 0xffffu);",
            kind.shape()
        )
    };
    format!("fn layer_key(id: u32, t: f32) -> u32 {{\n{body}\n}}")
}

fn add_objects(module: &mut Module, kind: FragmentKind, orthographic: bool, numbered: bool) {
    let key = VisibilityKey { hulls: false, orthographic, light: false, drawn: Drawn::CountedLayers };
    match kind {
        FragmentKind::Meshes => {
            visibility::add_triangles(module, key, false, numbered);
            visibility::add_triangle_layers(module, numbered);
        }
        _ => {
            let atoms = kind == FragmentKind::Atoms;
            visibility::add_impostors(module, atoms, key);
            visibility::add_impostor_layers(module, atoms);
        }
    }
}

/// The WGSL of clearing.
pub fn clear_module(form: BkbForm) -> Module {
    let mut module = Module::new(&[wgsl!("lib/bkb.wgsl"), wgsl!("bkb/clear.wgsl")]);
    module.add_generated("bkb options", form_constants(form));
    module
}

/// The WGSL of the first pass over objects of a kind.
pub fn insert_module(kind: FragmentKind, form: BkbForm, orthographic: bool, numbered: bool) -> Module {
    let mut module = Module::default();
    visibility::add_extensions(&mut module, numbered && kind == FragmentKind::Meshes);
    module.add_generated("view options", format!("const ORTHOGRAPHIC: bool = {orthographic};"));
    add_objects(&mut module, kind, orthographic, numbered);
    module.add(wgsl!("lib/bkb.wgsl"));
    module.add(wgsl!("bkb/insert.wgsl"));
    module.add_generated("bkb keys", key_function(kind, form));
    module
}

/// The WGSL that puts lists in the order of shapes and makes buckets.
pub fn buckets_module() -> Module {
    Module::new(&[wgsl!("lib/bkb.wgsl"), wgsl!("bkb/buckets.wgsl")])
}

/// The WGSL of the second pass over objects of a kind.
pub fn store_module(kind: FragmentKind, key: &BkbKey, numbered: bool) -> Module {
    let mut module = Module::default();
    visibility::add_extensions(&mut module, numbered && kind == FragmentKind::Meshes);
    let shade = ShadeKey {
        atoms: kind == FragmentKind::Atoms,
        connectors: kind == FragmentKind::Connectors,
        meshes: key.shade.meshes.filter(|_| kind == FragmentKind::Meshes),
        ..key.shade.clone()
    };
    add_shading(&mut module, &shade);
    add_objects(&mut module, kind, key.shade.orthographic, numbered);
    module.add(wgsl!("lib/bkb.wgsl"));
    module.add(wgsl!("bkb/data.wgsl"));
    if key.form.is_dual_pass() {
        module.add(wgsl!("bkb/find_sorted.wgsl"));
    } else {
        module.add(wgsl!("bkb/query.wgsl"));
        module.add(wgsl!("bkb/find_bucketed.wgsl"));
    }
    module.add(wgsl!("bkb/store.wgsl"));
    module.add_generated("bkb keys", key_function(kind, key.form));
    module.add_generated("bkb options", form_constants(key.form));
    module
}

/// The WGSL of stylising and blending.
pub fn blend_module(key: &BkbKey) -> Module {
    let mut module = Module::default();
    add_shading(&mut module, &key.shade);
    module.add(wgsl!("lib/bkb.wgsl"));
    module.add(wgsl!("bkb/data.wgsl"));
    if key.form.is_dual_pass() {
        module.add(wgsl!("bkb/order_sorted.wgsl"));
    } else {
        module.add(wgsl!("bkb/query.wgsl"));
        module.add(wgsl!("bkb/neighbours.wgsl"));
        module.add(wgsl!("lib/trace.wgsl"));
        module.add(wgsl!("bkb/stylise.wgsl"));
        module.add(wgsl!("bkb/order_bucketed.wgsl"));
        let (declared, kept) = match key.keeps_kappa {
            true => {
                ("@group(2) @binding(4) var<storage, read_write> bkb_kappa: array<f32>;\n", "bkb_kappa[slot] = kappa;")
            }
            false => ("", ""),
        };
        module.add_generated(
            "bkb queries",
            format!(
                "const BRUTE_FORCE: bool = {};\nconst REVERSE_CHECK: bool = {};\n{declared}\
                 fn keep_kappa(slot: u32, kappa: f32) {{ {kept} }}\n{}",
                key.form == BkbForm::BruteForce,
                key.form != BkbForm::OneWay,
                stylising_by_kappa(&key.shade),
            ),
        );
    }
    let finish = format!("{}\nconst FINISH: u32 = {}u;", form_constants(key.form), key.finish.number());
    module.add_generated("bkb options", finish);
    module.add(wgsl!("lib/finish.wgsl"));
    module.add(wgsl!("lib/fullscreen.wgsl"));
    module.add(wgsl!("bkb/blend.wgsl"));
    module
}
