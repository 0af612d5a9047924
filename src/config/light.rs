//! `lights`: what shines on the scene.

use super::color::Srgba;
use super::error::Problem;
use super::length::Length;
use super::param::{Param, Value};
use super::read::Reader;
use super::syntax::Node;
use super::values::Values;

/// The keys of one light.
pub const PARAMS: &[Param] = &[
    Param::choice("type", &["directional", "point", "ambient"], "directional")
        .doc("What kind of light it is.")
        .examples(&[r#""directional""#, r#""point""#, r#""ambient""#]),
    Param::vector("position", [1.0, 2.0, 3.0])
        .unit("radii")
        .doc("Where a point light is, or a directional one shines from, in radii from the sphere's centre.")
        .examples(&["[-3, 1, 1]", "[1, 2, 3]", "[0, -3, 1]"]),
    Param::color("color", [255, 255, 255]).doc("Colour of the light.").examples(&[
        r##""#ffffff""##,
        r##""#ffb35c""##,
        "[110, 150, 255]",
    ]),
    Param::number("intensity", 1.0).range(0.0, 1000.0).doc("Factor on the colour.").examples(&["0.3", "1", "3"]),
    Param::choice("shadow", &["none", "hard", "soft"], "none").doc("What shadow it casts.").examples(&[
        r#""none""#,
        r#""hard""#,
        r#""soft""#,
    ]),
    Param::number("strength", 0.6)
        .range(0.0, 1.0)
        .doc("Darkness of the shadow; 1 is black.")
        .examples(&["0.2", "0.6", "1"]),
    Param::number("softness", 3.0)
        .range(0.0, 90.0)
        .unit("degrees")
        .doc("Angular diameter of the light, for soft shadows.")
        .examples(&["1", "8", "30"]),
    Param::boolean("movable", false).doc("Whether it can be dragged in a window.").examples(&["false", "true"]),
    Param::choice("space", &["camera", "scene"], "camera")
        .doc("Whether it turns with the camera or with the scene.")
        .examples(&[r#""camera""#, r#""scene""#]),
    Param::optional_length("range")
        .doc("Where a point light has faded to nothing; unset: it does not fade.")
        .examples(&["null", "2", "1.4"]),
];

/// What kind of light it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightKind {
    /// Parallel light from `position` towards the centre.
    Directional,
    /// Light from the point `position`.
    Point,
    /// Light from everywhere, on `basic` alone.
    Ambient,
}

/// What shadow a light casts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadow {
    /// None.
    None,
    /// With a sharp edge.
    Hard,
    /// With an edge as wide as the light's size makes it.
    Soft,
}

/// What a light is fixed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// The camera.
    Camera,
    /// The scene.
    Scene,
}

/// One light of a style.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    /// What kind of light it is.
    pub kind: LightKind,
    /// In radii of the scene from its centre.
    pub position: [f64; 3],
    /// Its colour.
    pub color: Srgba,
    /// Factor on the colour, in linear light.
    pub intensity: f64,
    /// What shadow it casts.
    pub shadow: Shadow,
    /// Darkness of the shadow; 1 is black.
    pub strength: f64,
    /// Angular diameter in degrees.
    pub softness: f64,
    /// Whether it can be dragged.
    pub movable: bool,
    /// What it is fixed to.
    pub space: Space,
    /// Where a point light has faded to nothing.
    pub range: Option<Length>,
}

/// Brightness of the ambient light of a style without `lights`. Ours: shadowed sides stay readable in print.
const AMBIENT_INTENSITY: f64 = 0.3;

impl Light {
    /// The light that the values of [`PARAMS`] describe.
    pub fn new(values: &Values) -> Self {
        let kinds = [LightKind::Directional, LightKind::Point, LightKind::Ambient];
        Self {
            kind: kinds[values.choice_index("type")],
            position: values.vector("position"),
            color: values.color("color"),
            intensity: values.number("intensity"),
            shadow: [Shadow::None, Shadow::Hard, Shadow::Soft][values.choice_index("shadow")],
            strength: values.number("strength"),
            softness: values.number("softness"),
            movable: values.boolean("movable"),
            space: [Space::Camera, Space::Scene][values.choice_index("space")],
            range: values.optional_length("range"),
        }
    }

    /// The lights of a style that has no `lights`: one key light and ambient.
    pub fn default_lights() -> Vec<Values> {
        let key = Values::defaults(PARAMS);
        let mut ambient = key.clone();
        let kind = key.choices("type").iter().position(|kind| *kind == "ambient").expect("it is a kind of light");
        ambient.change_default("type", Value::Choice(kind));
        ambient.change_default("intensity", Value::Number(AMBIENT_INTENSITY));
        vec![key, ambient]
    }

    /// Reads one light and says what is wrong with it.
    pub(super) fn read(reader: &mut Reader<'_>, node: &Node) -> Values {
        let members = reader.object("light", node);
        let values = reader.table("light", members, PARAMS);
        let light = Self::new(&values);
        if light.kind == LightKind::Directional && light.position == [0.0; 3] {
            let at = node.get("position").unwrap_or(node).span;
            let reason = "a directional light at the centre shines nowhere: one of its numbers must not be 0";
            reader.wrong(at, Problem::Meaningless(reason));
        }
        values
    }
}
