//! The manual's pictures: for each parameter, one small scene drawn with each of its examples in turn.

use serde_json::{Value, json};

use crate::config::catalog::{BASIC, Catalog, Role};
use crate::config::param::Param;
use crate::config::sections::SECTIONS;

/// What a picture of the manual shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// A shipped one, by its name.
    Shipped(&'static str),
    /// The text of a PDB file.
    Pdb(&'static str),
}

/// A single, a double and a triple bond; no shipped file says of what order its bonds are.
const ACRYLONITRILE: Shown = Shown::Pdb(include_str!("acrylonitrile.pdb"));

/// Six atoms that touch: two chains, one of two residues.
const GROUPS: Shown = Shown::Pdb(include_str!("groups.pdb"));

/// A strip of pictures that differ in one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Strip {
    /// The section or shader.
    pub group: &'static str,
    /// The parameter.
    pub param: &'static str,
    /// What is drawn.
    pub scene: Shown,
    /// What is seen, for the manual.
    pub said: &'static str,
    /// A style for each picture, from left to right, as JSON.
    pub styles: Vec<String>,
}

impl Strip {
    /// The stem of its file.
    pub fn name(&self) -> String {
        format!("{}-{}", self.group, self.param)
    }
}

/// Parameters without pictures: they change nothing in a still, or no more than its noise, or only what others show is changed.
const UNSEEN: [(&str, &str); 21] = [
    ("geometry", "file_unit"),
    ("lights", "movable"),
    ("transparency", "memory_mb"),
    ("transparency", "method"),
    // As in basic.
    ("toon", "opacity"),
    ("unlit", "opacity"),
    ("curvature", "base_color"),
    ("curvature", "curvature_source"),
    ("curvature", "opacity"),
    ("curvature", "smoothness"),
    ("curvature", "metallic"),
    ("curvature", "scale"),
    ("curvature", "bias"),
    ("curvature", "steps"),
    ("curvature", "levels"),
    ("curvature", "shadow_color"),
    ("ssaoPost", "samples"),
    ("ssaoPost", "blur"),
    ("ssaoPost", "applies_to"),
    ("dofPost", "method"),
    ("dofPost", "focus"),
];

/// What a parameter is shown on.
struct Setting {
    group: &'static str,
    /// Empty for all others of the group.
    param: &'static str,
    scene: Shown,
    said: &'static str,
    /// What the style has beside [`base`].
    style: &'static str,
}

/// The first that fits is taken.
const SETTINGS: &[Setting] = &[
    Setting {
        group: "camera",
        param: "orthographic",
        scene: Shown::Shipped("nanotube"),
        said: "A nanotube, from close by.",
        style: r#"{ "camera": { "position": [0.15, 0.1, 2.2], "fov": 60, "zoom": 1.3 }, "geometry": { "scale": 0.3 } }"#,
    },
    Setting {
        group: "camera",
        param: "fov",
        scene: Shown::Shipped("sodium_chloride"),
        said: "A crystal of salt, turned; the camera steps back as the angle narrows.",
        style: r#"{ "lights": [{ "type": "directional", "position": [-1, 1.5, 1.5] }, { "type": "ambient", "intensity": 0.5 }] }"#,
    },
    Setting {
        group: "camera",
        param: "orient",
        scene: Shown::Shipped("alpha_helix"),
        said: "A helix, which stands upright in its file.",
        style: r#"{ "geometry": { "scale": 0.4 } }"#,
    },
    Setting {
        group: "camera",
        param: "exposure",
        scene: Shown::Shipped("methane"),
        said: "Methane.",
        style: r#"{ "camera": { "zoom": 1.4 } }"#,
    },
    Setting {
        group: "camera",
        param: "",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine.",
        style: r#"{ "camera": { "fov": 35 } }"#,
    },
    Setting {
        group: "geometry",
        param: "bond_orders",
        scene: ACRYLONITRILE,
        said: "Acrylonitrile, from a PDB file that says of what order its bonds are.",
        style: r##"{ "geometry": { "scale": 0.18, "bond_radius": "0.1A" }, "camera": { "zoom": 1.6, "target": [0.05, -0.1, 0] } }"##,
    },
    Setting {
        group: "geometry",
        param: "",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine.",
        style: r#"{ "camera": { "zoom": 1.25 }, "geometry": { "scale": 0.25, "bond_radius": "0.14A" } }"#,
    },
    Setting {
        group: "lights",
        param: "range",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine, with a point light on its right.",
        style: r#"{ "lights": [{ "type": "point", "position": [1.4, 0.4, 0.8], "intensity": 1.5 }, { "type": "ambient", "intensity": 0.2 }] }"#,
    },
    Setting {
        group: "lights",
        param: "space",
        scene: Shown::Shipped("methane"),
        said: "Methane, seen from its right; the light is written as coming from the left.",
        style: r#"{ "camera": { "position": [4, 0, 0], "zoom": 1.4 }, "lights": [{ "type": "directional", "position": [-3, 1, 1] }, { "type": "ambient", "intensity": 0.3 }] }"#,
    },
    Setting {
        group: "lights",
        param: "type",
        scene: Shown::Shipped("methane"),
        said: "Methane; an ambient light has no direction.",
        style: r##"{ "camera": { "zoom": 1.4 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#d8d3cb" } }], "lights": [{ "type": "directional", "position": [-1, 1, 1] }] }"##,
    },
    Setting {
        group: "lights",
        param: "shadow",
        scene: Shown::Shipped("methane"),
        said: "Methane, with light from behind one of its atoms on the right.",
        style: r##"{ "geometry": { "scale": 0.5 }, "camera": { "zoom": 1.8 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#e3c9a0" } }], "lights": [{ "type": "directional", "position": [2, 1.6, 0.9], "softness": 12, "strength": 0.8 }, { "type": "ambient", "intensity": 0.2 }] }"##,
    },
    Setting {
        group: "lights",
        param: "strength",
        scene: Shown::Shipped("methane"),
        said: "Methane, with light from behind one of its atoms on the right.",
        style: r##"{ "geometry": { "scale": 0.5 }, "camera": { "zoom": 1.8 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#e3c9a0" } }], "lights": [{ "type": "directional", "position": [2, 1.6, 0.9], "shadow": "hard" }, { "type": "ambient", "intensity": 0.2 }] }"##,
    },
    Setting {
        group: "lights",
        param: "softness",
        scene: Shown::Shipped("methane"),
        said: "Methane, with light from behind one of its atoms on the right.",
        style: r##"{ "geometry": { "scale": 0.5 }, "camera": { "zoom": 1.8 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#e3c9a0" } }], "lights": [{ "type": "directional", "position": [2, 1.6, 0.9], "shadow": "soft", "strength": 1 }, { "type": "ambient", "intensity": 0.2 }] }"##,
    },
    Setting {
        group: "lights",
        param: "",
        scene: Shown::Shipped("methane"),
        said: "Methane.",
        style: r##"{ "camera": { "zoom": 1.4 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#d8d3cb" } }], "lights": [{ "type": "directional", "position": [-1, 1.5, 1.5] }, { "type": "ambient", "intensity": 0.3 }] }"##,
    },
    Setting {
        group: "toon",
        param: "color",
        scene: Shown::Shipped("methane"),
        said: "Methane, with a `hull_size` of `\"30pt\"`.",
        style: r##"{ "camera": { "zoom": 1.3 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#f2a65a", "hull_size": "30pt" } }] }"##,
    },
    Setting {
        group: "toon",
        param: "specular_limit",
        scene: Shown::Shipped("methane"),
        said: "Methane, with a white highlight.",
        style: r##"{ "camera": { "zoom": 1.4 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#c8553d", "specular_color": "white" } }] }"##,
    },
    Setting {
        group: "toon",
        param: "specular_color",
        scene: Shown::Shipped("methane"),
        said: "Methane, with a `specular_limit` of `0.9`.",
        style: r##"{ "camera": { "zoom": 1.4 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#c8553d", "specular_limit": 0.9 } }] }"##,
    },
    Setting {
        group: "toon",
        param: "base_color",
        scene: Shown::Shipped("methane"),
        said: "Methane.",
        style: r##"{ "camera": { "zoom": 1.4 } }"##,
    },
    Setting {
        group: "toon",
        param: "shadow_color",
        scene: Shown::Shipped("methane"),
        said: "Methane, all in one colour, with a `bias` of `0.2`.",
        style: r##"{ "camera": { "zoom": 1.3 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#f2a65a", "bias": 0.2 } }] }"##,
    },
    Setting {
        group: "toon",
        param: "",
        scene: Shown::Shipped("methane"),
        said: "Methane, all in one colour.",
        style: r##"{ "camera": { "zoom": 1.3 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#f2a65a" } }] }"##,
    },
    Setting {
        group: "basic",
        param: "base_color",
        scene: Shown::Shipped("methane"),
        said: "Methane.",
        style: r##"{ "camera": { "zoom": 1.4 } }"##,
    },
    Setting {
        group: "basic",
        param: "smoothness",
        scene: Shown::Shipped("methane"),
        said: "Methane, all in one colour, with a `metallic` of `0.5`.",
        style: r##"{ "camera": { "zoom": 1.4 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#a33b2e", "metallic": 0.5 } }] }"##,
    },
    Setting {
        group: "basic",
        param: "",
        scene: Shown::Shipped("methane"),
        said: "Methane, all in one colour.",
        style: r##"{ "camera": { "zoom": 1.4 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#a33b2e" } }] }"##,
    },
    Setting {
        group: "curvature",
        param: "contour_emphasis",
        scene: Shown::Shipped("bracket"),
        said: "A bracket, with a `contour_width` of `0` and an `opacity_transfer` of `\"xray\"`.",
        style: r##"{ "camera": { "zoom": 1.2 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#5a7f9c", "opacity_transfer": "xray", "contour_width": 0, "gain": 0.4 } }] }"##,
    },
    Setting {
        group: "curvature",
        param: "depth_range",
        scene: Shown::Shipped("bracket"),
        said: "A bracket, with an `opacity_transfer` of `\"fig7a\"`.",
        style: r##"{ "camera": { "zoom": 1.2 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#5a7f9c", "opacity_transfer": "fig7a" } }] }"##,
    },
    Setting {
        group: "curvature",
        param: "",
        scene: Shown::Shipped("bracket"),
        said: "A bracket, with an `opacity_transfer` of `\"glass\"` and a `contour_width` of `4pt` where those do not change.",
        style: r##"{ "camera": { "zoom": 1.2 }, "shaders": [{ "name": "shown", "properties": { "base_color": "#5a7f9c", "opacity_transfer": "glass", "contour_width": "4pt" } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "depth_step",
        scene: Shown::Shipped("sodium_chloride"),
        said: "A crystal of salt, with a `silhouette_width` of `14pt`.",
        style: r##"{ "geometry": { "scale": 0.6 }, "shaders": [{ "name": "shown", "properties": { "silhouette_width": "14pt" } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "boundary",
        scene: GROUPS,
        said: "Six atoms in three residues of two chains, with a `boundary_width` of `36pt`.",
        style: r##"{ "geometry": { "scale": 1 }, "shaders": [{ "name": "shown", "properties": { "boundary_width": "36pt" } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "boundary_width",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine, with `boundary` `object` and silhouettes of `6pt`.",
        style: r##"{ "geometry": { "scale": 0.6 }, "shaders": [{ "name": "shown", "properties": { "boundary": "object", "silhouette_width": "6pt" } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "boundary_color",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine, with `boundary` `object` and lines of `8pt`.",
        style: r##"{ "geometry": { "scale": 0.6 }, "shaders": [{ "name": "shown", "properties": { "boundary": "object", "boundary_width": "8pt", "silhouette_width": 0 } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "crease_width",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine, with silhouettes of `6pt`.",
        style: r##"{ "geometry": { "scale": 0.6 }, "shaders": [{ "name": "shown", "properties": { "silhouette_width": "6pt" } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "crease_color",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine, with creases of `8pt`.",
        style: r##"{ "geometry": { "scale": 0.6 }, "shaders": [{ "name": "shown", "properties": { "crease_width": "8pt" } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "crease_angle",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine, with creases of `6pt`.",
        style: r##"{ "geometry": { "scale": 0.6 }, "shaders": [{ "name": "shown", "properties": { "crease_width": "6pt" } }] }"##,
    },
    Setting {
        group: "outlinePost",
        param: "",
        scene: Shown::Shipped("caffeine"),
        said: "Caffeine, with a `silhouette_width` of `8pt` where it is not the one that changes.",
        style: r##"{ "geometry": { "scale": 0.6 }, "shaders": [{ "name": "shown", "properties": { "silhouette_width": "8pt" } }] }"##,
    },
    Setting {
        group: "ssaoPost",
        param: "",
        scene: Shown::Shipped("arsenic_trioxide"),
        said: "A cage of arsenic and oxygen, with a `radius` of `4r` where it is not the one that changes.",
        style: r##"{ "geometry": { "scale": 0.5 }, "shaders": [{ "name": "shown", "properties": { "radius": "4r" } }] }"##,
    },
    Setting {
        group: "dofPost",
        param: "",
        scene: Shown::Shipped("benzene"),
        said: "Benzene from the side, with `layers` of `[0, 0.1, 0.3, 0.7]` and a `blur` of `70pt` where those do not change.",
        style: r##"{ "camera": { "position": [0.6, -2.2, 1.4] }, "shaders": [{ "name": "shown", "properties": { "layers": [0, 0.1, 0.3, 0.7], "blur": "70pt" } }] }"##,
    },
    Setting {
        group: "transparency",
        param: "k",
        scene: Shown::Shipped("benzene"),
        said: "Benzene of glass, its `method` of `\"bkb\"`.",
        style: r##"{ "geometry": { "atom": "vdw", "scale": 0.9 }, "transparency": { "method": "bkb" },
            "shaders": [{ "name": "shown", "properties": { "opacity": 0.5 } }] }"##,
    },
    // Any shader, also one that this table does not know yet.
    Setting {
        group: "",
        param: "",
        scene: Shown::Shipped("methane"),
        said: "Methane.",
        style: r##"{ "camera": { "zoom": 1.4 } }"##,
    },
];

/// What all pictures have in common.
fn base() -> Value {
    json!({
        "camera": { "bgcolor": "#e6e8ec" },
        "geometry": { "scale": 0.5, "bond_radius": "0.2A" },
        "mapping": { "*": "shown" },
        "shaders": [{ "name": "shown", "properties": {} }],
        "lights": [{ "type": "directional", "position": [-1, 1.5, 1.5] }, { "type": "ambient", "intensity": 0.5 }],
    })
}

/// Every strip of the manual, in its order.
pub fn strips(catalog: &Catalog<'_>) -> Vec<Strip> {
    let sections = SECTIONS.iter().map(|section| (section.key, section.params));
    let groups = sections.chain(catalog.shaders.iter().map(|entry| (entry.name, entry.params)));
    let all = groups.flat_map(|(group, params)| params.iter().map(move |param| (group, param)));
    let is_effect = |group: &str| catalog.get(group).is_some_and(|entry| entry.role == Role::PostEffect);
    let seen = all.filter(|(group, param)| !param.examples.is_empty() && !UNSEEN.contains(&(group, param.name)));
    seen.map(|(group, param)| strip(group, is_effect(group), param)).collect()
}

fn strip(group: &'static str, is_effect: bool, param: &'static Param) -> Strip {
    let fits = |setting: &&Setting| [group, ""].contains(&setting.group) && [param.name, ""].contains(&setting.param);
    let setting = SETTINGS.iter().find(fits).expect("the last fits all");
    let styles =
        param.examples.iter().map(|example| style(setting, group, is_effect, param, example).to_string()).collect();
    Strip { group, param: param.name, scene: setting.scene, said: setting.said, styles }
}

fn style(setting: &Setting, group: &str, is_effect: bool, param: &Param, example: &str) -> Value {
    let read = |text: &str| serde_json::from_str::<Value>(text).expect("a test draws every setting and example");
    let mut style = base();
    merge(&mut style, read(setting.style));
    let of_section = SECTIONS.iter().find(|section| section.key == group);
    if is_effect {
        // The effect's own properties stand where a shader's would.
        style["shaders"][0]["shader"] = group.into();
        style["mapping"] = json!({ "*": "flat", "post_effects": ["shown"] });
        let shown = style["shaders"][0].clone();
        style["shaders"] = json!([shown, { "name": "flat", "shader": "unlit" }]);
    } else {
        style["shaders"][0]["shader"] = of_section.map_or(group, |_| BASIC).into();
    }
    let place = match of_section {
        Some(section) if section.is_list => &mut style[group][0],
        Some(_) => &mut style[group],
        None => &mut style["shaders"][0]["properties"],
    };
    place[param.name] = read(example);
    style
}

/// Lays values over others: objects key by key, all else as a whole.
fn merge(onto: &mut Value, from: Value) {
    match (onto, from) {
        (Value::Object(onto), Value::Object(from)) => {
            for (key, value) in from {
                merge(onto.entry(key).or_insert(Value::Null), value);
            }
        }
        (onto, from) => *onto = from,
    }
}
