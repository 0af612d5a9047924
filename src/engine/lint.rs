//! What a style can be warned of by who knows the shaders, and better still the scene.

use crate::config::{AtomRadius, Length, Notice, ObjectKind, Origin, ShaderUse, Style, Warning};
use crate::providers::{ShaderProvider, unmatched};
use crate::scene::Scene;
use crate::shading;

use super::build;

/// The parameter that gives a shader an outline around its objects.
const HULL_SIZE: &str = "hull_size";

/// Post effects by the stage in which they change the picture.
const STAGES: [(&str, u8); 3] = [("ssaoPost", 0), ("outlinePost", 1), ("dofPost", 2)];

/// Height of the picture that lengths in points are taken in. It changes nothing here: such lines thin out by themselves.
const HEIGHT_PX: u32 = 1080;

/// Warnings that need no scene: effects out of order, and outlines that are too wide in any.
pub fn lint(style: &Style) -> Vec<Warning> {
    let outlines = style.shaders.iter().enumerate().filter_map(|(index, used)| wide_outline(style, index, used));
    effects_out_of_order(style).into_iter().chain(outlines).collect()
}

/// The same with a scene, in which every outline has a width and every object a radius, and selectors can match nothing.
pub fn lint_with(style: &Style, scene: &Scene) -> Vec<Warning> {
    let of_scene = wide_outlines(style, scene).into_iter().chain(unmatched(style, scene));
    effects_out_of_order(style).into_iter().chain(of_scene).collect()
}

/// Post effects that are listed after one of a later stage, each once.
fn effects_out_of_order(style: &Style) -> Vec<Warning> {
    let stage =
        |index: usize| STAGES.iter().find(|(name, _)| *name == style.shaders[index].shader).map(|(_, stage)| *stage);
    let name = |index: usize| style.shaders[index].name.clone();
    let mut latest: Option<(u8, usize)> = None;
    let mut warnings = Vec::new();
    for effect in &style.listed_effects {
        let Some(own) = stage(effect.index) else { continue };
        match latest {
            Some((before, after)) if before > own => {
                let notice = Notice::StageOrder { name: name(effect.index), after: name(after) };
                warnings.push(Warning { place: effect.place.clone(), notice });
            }
            _ => latest = Some((own, effect.index)),
        }
    }
    warnings
}

/// Outlines that are wider than the smallest object they are drawn around, which they turn into a blot.
fn wide_outlines(style: &Style, scene: &Scene) -> Vec<Warning> {
    let provider = ShaderProvider::new(scene, style);
    let objects = build::objects_of(&scene.molecule, style, provider.assignment());
    let mut smallest = vec![[f32::INFINITY; 2]; objects.materials.len()];
    for atom in &objects.list.atoms {
        let [of_atoms, _] = &mut smallest[atom.material as usize];
        *of_atoms = of_atoms.min(atom.radius);
    }
    for connector in &objects.list.connectors {
        let [_, of_connectors] = &mut smallest[connector.material() as usize];
        *of_connectors = of_connectors.min(connector.radius);
    }
    let mut warnings = Vec::new();
    for (used, [atom, connector]) in objects.materials.iter().map(|used| &style.shaders[used.shader]).zip(smallest) {
        let hull = shading::shader_index(used.shader).and_then(|shader| shading::SHADERS[shader].hull(&used.values));
        let width = hull.map_or(0.0, |hull| objects.lengths.screen(hull.width, HEIGHT_PX).1) as f32;
        let (outlined, radius) = match atom <= connector {
            true => (SMALLEST_ATOM, atom),
            false => (CONNECTOR, connector),
        };
        if width > radius {
            let angstrom = |length: f32| format!("{} A", rounded(f64::from(length)));
            let (width, radius) = (angstrom(width), angstrom(radius));
            warnings.extend(warning(used, Notice::WideOutline { width, outlined, radius }));
        }
    }
    warnings
}

/// What an outline surrounds, as messages have it.
const SMALLEST_ATOM: &str = "the smallest atom inside";
const CONNECTOR: &str = "a connector inside";
const EVERY_ATOM: &str = "every atom";

/// An outline that is too wide in any scene: as far as the units of its width and of what it surrounds agree.
fn wide_outline(style: &Style, index: usize, used: &ShaderUse) -> Option<Warning> {
    let width =
        shading::shader_index(used.shader).and_then(|shader| shading::SHADERS[shader].hull(&used.values))?.width;
    let draws = |kind| style.mapping.iter().any(|rule| rule.target == Some(index) && rule.selector.is_for(kind));
    let geometry = &style.geometry;
    let atom = match (geometry.atom, width) {
        _ if !draws(ObjectKind::Atom) => None,
        (AtomRadius::Length(Length::Angstrom(radius)), Length::Angstrom(width)) => {
            Some((width, radius * geometry.scale))
        }
        (AtomRadius::Length(Length::Radii(radius)), Length::Radii(width)) => Some((width, radius * geometry.scale)),
        // Where all atoms are alike, their median is each of them.
        (AtomRadius::Length(_), Length::MedianRadii(width)) => Some((width, 1.0)),
        _ => None,
    };
    let connector = match (geometry.bond_radius, width) {
        _ if !draws(ObjectKind::Connector) => None,
        (Length::Angstrom(radius), Length::Angstrom(width))
        | (Length::Radii(radius), Length::Radii(width))
        | (Length::MedianRadii(radius), Length::MedianRadii(width)) => Some((width, radius)),
        _ => None,
    };
    let candidates = [(EVERY_ATOM, atom), (CONNECTOR, connector)];
    let (outlined, radius) = candidates.into_iter().find_map(|(outlined, sizes)| {
        let (width, radius) = sizes?;
        (width > radius).then_some((outlined, radius))
    })?;
    let unit = match width {
        Length::Radii(_) => " radii".to_owned(),
        other => format!(" {}", other.unit()),
    };
    let sized = |length: f64| format!("{}{unit}", rounded(length));
    let notice = Notice::WideOutline { width: sized(width.number()), outlined, radius: sized(radius) };
    warning(used, notice)
}

/// A warning at the width that a file gives; the default of a shader is nobody's mistake.
fn warning(used: &ShaderUse, notice: Notice) -> Option<Warning> {
    match used.values.origin(HULL_SIZE) {
        Some(Origin::File(place)) => Some(Warning { place: place.clone(), notice }),
        _ => None,
    }
}

/// To three digits.
fn rounded(length: f64) -> f64 {
    if length == 0.0 || !length.is_finite() {
        return length;
    }
    let digit = 10f64.powi(2 - length.abs().log10().floor() as i32);
    (length * digit).round() / digit
}
