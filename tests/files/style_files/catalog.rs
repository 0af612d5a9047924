//! A catalog for tests: the shaders of the contract, with the parameters that style files know.

use restyle::config::{BaseColor, Catalog, CatalogEntry, ObjectKind, Param, Role};

const BASE_COLOR: Param = Param::base_color("base_color", BaseColor::Element).doc("Colour of the surface.");
const OPACITY: Param = Param::number("opacity", 1.0).range(0.0, 1.0).doc("0 is invisible.");

const BASIC: &[Param] = &[
    Param::number("smoothness", 0.5).range(0.0, 1.0).doc("1 is a mirror."),
    Param::number("metallic", 0.0).range(0.0, 1.0).doc("1 is metal."),
    BASE_COLOR,
    OPACITY,
];

const TOON: &[Param] = &[
    Param::color("color", [0, 0, 0]).doc("Colour of the outline."),
    Param::length("hull_size", "2pt").range(0.0, 1.0).unit("radii").doc("Width of the outline."),
    Param::number("outline_bias", 0.0).range(0.0, 1.0).doc("Threshold of the dot product."),
    Param::number("scale", 0.5).range(0.0, 10.0).doc("Factor on the light's direction."),
    Param::number("bias", 0.5).range(-10.0, 10.0).doc("Added to it."),
    Param::number("exponent", 1.0).range(0.01, 100.0).doc("Power of the sum."),
    Param::count("steps", 4).range(1.0, 64.0).unit("levels").doc("Number of levels."),
    Param::choice("levels", &["floor", "centre", "full"], "floor").doc("Brightness of each level."),
    Param::optional_color("shadow_color").doc("Colour of the darkest level."),
    Param::optional_color("specular_color").doc("Colour of highlights."),
    Param::number("specular_limit", 0.9).range(0.0, 1.0).doc("Where highlights begin."),
    BASE_COLOR,
    OPACITY,
];

const UNLIT: &[Param] = &[BASE_COLOR, OPACITY];

const DOF: &[Param] = &[Param::numbers("layers", &[0.0, 0.0, 0.7, 0.9]).of_len(4).range(0.0, 1.0).doc("Layers.")];

const SSAO: &[Param] = &[Param::length("radius", "3r").range(0.0, 100.0).unit("radii").doc("How far.")];

const fn object(name: &'static str, params: &'static [Param]) -> CatalogEntry {
    CatalogEntry { name, role: Role::Object, doc: "Draws.", params }
}

const fn effect(name: &'static str, params: &'static [Param]) -> CatalogEntry {
    CatalogEntry { name, role: Role::PostEffect, doc: "Changes.", params }
}

pub const CATALOG: Catalog<'_> = Catalog {
    shaders: &[
        object("basic", BASIC),
        object("toon", TOON),
        object("unlit", UNLIT),
        object("curvature", UNLIT),
        effect("ssaoPost", SSAO),
        effect("dofPost", DOF),
        effect("outlinePost", &[]),
    ],
    kinds: &[ObjectKind::Atom, ObjectKind::Connector, ObjectKind::Mesh],
};

#[test]
fn every_table_is_sound() {
    assert_eq!(CATALOG.check(), Vec::<String>::new());
    assert_eq!(CATALOG.check(), Vec::<String>::new());
    use restyle::config::{camera, geometry, light, param::check_table, transparency};
    for table in [camera::PARAMS, geometry::PARAMS, light::PARAMS, transparency::PARAMS] {
        assert_eq!(check_table(table), Vec::<String>::new());
    }
}
