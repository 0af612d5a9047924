//! The transfer functions that have names.
//!
//! Those of the paper are read off its words, since its figures are pictures without numbers [Murray2016 §5.2]; all
//! numbers are ours.

use std::sync::LazyLock;

use super::{Transfer, TransferKind, Written, points};

/// A transfer function with a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preset {
    /// Its name in style files.
    pub name: &'static str,
    /// One sentence for the manual and the editor.
    pub doc: &'static str,
    /// Its control points, each a curvature, then opacities at equal steps of depth from near to far, or one factor, or
    /// those on red, green and blue.
    pub points: &'static [&'static [f64]],
}

/// The presets of opacity.
pub const OPACITY: &[Preset] = &[
    Preset {
        name: "fig7a",
        doc: "Nearly clear where flat and near, nearly opaque where curved; all soon opaque with depth, which shows the front.",
        points: &[
            &[0.00, 0.05, 0.45, 0.75, 0.92, 1.0],
            &[0.25, 0.25, 0.60, 0.85, 0.96, 1.0],
            &[0.75, 0.85, 0.94, 0.98, 1.00, 1.0],
            &[1.00, 0.95, 0.98, 1.00, 1.00, 1.0],
        ],
    },
    Preset {
        name: "fig7b",
        doc: "Less weight in front and slower with depth: curved surfaces show over a wide range of depth.",
        points: &[
            &[0.00, 0.03, 0.06, 0.12, 0.25, 0.60],
            &[0.25, 0.10, 0.14, 0.22, 0.38, 0.70],
            &[0.75, 0.55, 0.60, 0.68, 0.80, 0.95],
            &[1.00, 0.70, 0.75, 0.82, 0.92, 1.00],
        ],
    },
    Preset {
        name: "fig8d",
        doc: "The front more opaque than what is far.",
        points: &[&[0.0, 0.55, 0.05], &[0.5, 0.85, 0.25], &[1.0, 1.0, 0.45]],
    },
    Preset { name: "constant", doc: "Opaque everywhere: only opacity counts.", points: &[&[0.0, 1.0]] },
    Preset {
        name: "glass",
        doc: "Clear where flat, with opaque edges and bends, much the same at every depth.",
        points: &[&[0.0, 0.08, 0.12], &[0.5, 0.45, 0.5], &[1.0, 0.9, 0.92]],
    },
    Preset {
        name: "xray",
        doc: "As opaque as it is curved, the same at every depth.",
        points: &[&[0.0, 0.03], &[1.0, 1.0]],
    },
    Preset {
        name: "ghost",
        doc: "Faint, a little less so far away, with soft edges.",
        points: &[&[0.0, 0.05, 0.25], &[1.0, 0.6, 0.6]],
    },
];

/// The presets of colour.
pub const COLOR: &[Preset] = &[
    Preset {
        name: "fig6a",
        doc: "Bright where convex, dark where concave.",
        points: &[&[-1.0, 1.6], &[0.0, 1.0], &[1.0, 0.3]],
    },
    Preset {
        name: "fig6b",
        doc: "Bright where curved either way, dark where flat.",
        points: &[&[-1.0, 1.5], &[0.0, 0.5], &[1.0, 1.5]],
    },
    Preset { name: "none", doc: "Colours as they are.", points: &[&[0.0, 1.0]] },
    Preset {
        name: "warm_cool",
        doc: "A little warmer where convex, cooler where concave.",
        points: &[&[-1.0, 1.2, 1.05, 0.85], &[0.0, 1.0, 1.0, 1.0], &[1.0, 0.7, 0.85, 1.1]],
    },
    Preset {
        name: "ink",
        doc: "Concave creases nearly black, the rest as it is.",
        points: &[&[-1.0, 1.1], &[0.0, 1.0], &[0.5, 0.4], &[1.0, 0.03]],
    },
];

/// The tables of the presets, in the order of the lists above: a style may use each many times.
static OPACITY_TABLES: LazyLock<Vec<Transfer>> = LazyLock::new(|| tables(TransferKind::Opacity));
static COLOR_TABLES: LazyLock<Vec<Transfer>> = LazyLock::new(|| tables(TransferKind::Color));

fn tables(kind: TransferKind) -> Vec<Transfer> {
    let of = |preset: &Preset| Transfer::new(Written::Preset(preset.name), points::nodes(kind, preset.points));
    kind.presets().iter().map(of).collect()
}

pub(super) fn find(kind: TransferKind, name: &str) -> Option<&'static Transfer> {
    let tables = match kind {
        TransferKind::Opacity => &*OPACITY_TABLES,
        TransferKind::Color => &*COLOR_TABLES,
    };
    kind.presets().iter().position(|preset| preset.name == name).map(|index| &tables[index])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_sound() {
        for kind in [TransferKind::Opacity, TransferKind::Color] {
            let presets = kind.presets();
            assert!(presets.len() <= 8);
            for (i, preset) in presets.iter().enumerate() {
                let name = preset.name;
                assert!(presets[..i].iter().all(|earlier| earlier.name != name), "{name} is there twice");
                assert!(preset.doc.ends_with('.'), "{name}: its doc is no sentence");
                let ((low, high), (least, most)) = (kind.curvatures(), kind.values());
                let points = preset.points;
                assert!(points.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{name} is out of order");
                for point in points {
                    assert_eq!(point.len(), points[0].len(), "{name}");
                    assert!((low..=high).contains(&point[0]), "{name}");
                    assert!(point[1..].iter().all(|value| (least..=most).contains(value)), "{name}");
                }
            }
        }
    }
}
