//! `camera`: projection, background, framing.

use super::color::Srgba;
use super::error::Problem;
use super::param::Param;
use super::read::Reader;
use super::syntax::{Member, Node};
use super::values::Values;

/// How the scene is turned before the camera looks at it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Orient {
    /// As its coordinates are: the camera looks along -z with +y up.
    Default,
    /// By its principal axes, so that flat things face the camera.
    Principal,
}

/// The keys of `camera`.
pub const PARAMS: &[Param] = &[
    Param::boolean("orthographic", false)
        .or_text()
        .doc("Parallel projection instead of perspective.")
        .examples(&["false", "true"]),
    Param::color("bgcolor", [255, 255, 255]).doc("Colour of the background.").examples(&[
        r##""#ffffff""##,
        "[231, 220, 196]",
        r##""#101522""##,
    ]),
    // Below a degree, 32-bit depth fails; near 180 the picture is all edge.
    Param::number("fov", 35.0)
        .range(1.0, 150.0)
        .unit("degrees")
        .doc("Vertical field of view of a perspective camera.")
        .examples(&["15", "35", "100"]),
    Param::number("exposure", 0.0)
        .range(-10.0, 10.0)
        .unit("stops")
        .doc("Brightness of what basic draws; +1 doubles it.")
        .examples(&["-1", "0", "1"]),
    Param::number("zoom", 1.0)
        .range(0.01, 1000.0)
        .doc("Magnification; 1 frames the whole scene.")
        .examples(&["0.6", "1", "2.5"]),
    Param::choice("orient", &["default", "principal"], "default")
        .doc("principal turns flat things to face the camera.")
        .examples(&[r#""default""#, r#""principal""#]),
    Param::optional_vector("position")
        .unit("radii")
        .doc("Where the camera is, in radii from the sphere's centre.")
        .examples(&["[0, 0, 4]", "[3, 2, 3]", "[0, 4, 0.5]"]),
    Param::optional_vector("target")
        .unit("radii")
        .doc("Where it looks, in radii from the sphere's centre.")
        .examples(&["[0, 0, 0]", "[0.6, 0, 0]", "[0, 0.6, 0]"]),
    Param::optional_vector("up").doc("Which direction is up in the picture.").examples(&[
        "[0, 1, 0]",
        "[1, 1, 0]",
        "[1, 0, 0]",
    ]),
];

/// The camera of a style.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Parallel projection instead of perspective.
    pub orthographic: bool,
    /// Colour of the background.
    pub bgcolor: Srgba,
    /// Vertical field of view in degrees.
    pub fov: f64,
    /// In stops.
    pub exposure: f64,
    /// Magnification.
    pub zoom: f64,
    /// How the scene is turned.
    pub orient: Orient,
    /// In radii of the scene from its centre; `None`: where the whole scene is seen.
    pub position: Option<[f64; 3]>,
    /// In radii of the scene from its centre; `None`: the centre.
    pub target: Option<[f64; 3]>,
    /// Direction that is up; `None`: +y.
    pub up: Option<[f64; 3]>,
}

impl Camera {
    /// The camera that the values of [`PARAMS`] describe.
    pub fn new(values: &Values) -> Self {
        Self {
            orthographic: values.boolean("orthographic"),
            bgcolor: values.color("bgcolor"),
            fov: values.number("fov"),
            exposure: values.number("exposure"),
            zoom: values.number("zoom"),
            orient: [Orient::Default, Orient::Principal][values.choice_index("orient")],
            position: values.optional_vector("position"),
            target: values.optional_vector("target"),
            up: values.optional_vector("up"),
        }
    }

    /// Reads `camera` and says what is wrong with it.
    pub(super) fn read(reader: &mut Reader<'_>, node: &Node) -> Values {
        let members: &[Member] = reader.object("camera", node);
        let values = reader.table("camera", members, PARAMS);
        let camera = Self::new(&values);
        if camera.up == Some([0.0; 3]) {
            let at = node.get("up").unwrap_or(node).span;
            reader.wrong(at, Problem::Meaningless("\"up\" is no direction: one of its numbers must not be 0"));
        }
        if camera.position.is_some_and(|position| position == camera.target.unwrap_or([0.0; 3])) {
            let at = node.get("position").unwrap_or(node).span;
            let reason = "\"position\" and \"target\" are the same point, so the camera looks nowhere";
            reader.wrong(at, Problem::Meaningless(reason));
        }
        values
    }
}
