//! Sixteen samples against exact coverage: silhouettes, and the borders of toon bands.

use super::gpu;
use super::toon;
use super::truth::{World, center_px};
use glam::DVec2;

const SIZE: [u32; 2] = [256, 256];
const RADIUS: f64 = 1.6;
/// A side of the regular grid that stands for exact coverage: its error at a straight edge is below 1/16^1.5 = 0.016
/// at worst and a third of that on average.
const GRID: u32 = 16;
/// RMS over partly covered pixels. Sixteen stratified samples of a straight edge are off by about 1/(3 * 16^0.75).
const SILHOUETTE: f64 = 0.045;
/// RMS over pixels that a border crosses, of the step between its levels: samples' own filters fill the gaps between.
const BAND: f64 = 0.015;

/// Mean of a property over the regular grid of a pixel.
fn grid_mean(pixel: (u32, u32), value: impl Fn(DVec2) -> f64) -> f64 {
    let corner = center_px(pixel) - 0.5;
    let offset = |i: u32| (f64::from(i) + 0.5) / f64::from(GRID);
    let sum: f64 = gpu::pixels([GRID; 2]).map(|(x, y)| value(corner + DVec2::new(offset(x), offset(y)))).sum();
    sum / f64::from(GRID * GRID)
}

fn style(camera: &str, shader: &str, properties: &str) -> String {
    format!(
        r##"{{"camera": {{"bgcolor": "#000000", {camera}}}, "geometry": {{"atom": "{RADIUS}A", "scale": 1}},
            "mapping": {{"atom": "s"}}, "lights": [{{"position": [1, 2, 3]}}],
            "shaders": [{{"name": "s", "shader": "{shader}", "properties":
                {{"base_color": "#ffffff"{properties}}}}}]}}"##
    )
}

/// RMS and largest difference between a still and the truth over the pixels whose truth lies within `partly`.
fn errors(light: &[f64], truth: &[f64], partly: impl Fn(usize) -> bool) -> (f64, f64) {
    let differences: Vec<f64> = (0..light.len()).filter(|&i| partly(i)).map(|i| (light[i] - truth[i]).abs()).collect();
    assert!(differences.len() > 100, "{} pixels are too few", differences.len());
    let squares: f64 = differences.iter().map(|d| d * d).sum();
    ((squares / differences.len() as f64).sqrt(), differences.into_iter().fold(0.0, f64::max))
}

const CAMERAS: [&str; 2] = [r#""orthographic": true"#, r#""fov": 50, "target": [0.2, 0.1, 0]"#];

#[test]
fn silhouettes_are_near_their_coverage() {
    for camera in CAMERAS {
        let Some(mut engine) = gpu::engine(&["C 0.013 0.007 0"], &style(camera, "unlit", "")) else { return };
        let world = World::new(&engine, SIZE, &[RADIUS], 0.14);
        let truth: Vec<f64> = gpu::pixels(SIZE)
            .map(|pixel| grid_mean(pixel, |at| if world.seen(at).is_some() { 1.0 } else { 0.0 }))
            .collect();
        let partly = |i: usize| truth[i] > 0.0 && truth[i] < 1.0;
        let [(rms, worst), (rms_256, worst_256)] = [16, 256].map(|samples| {
            let light = gpu::channel(&gpu::still(&mut engine, SIZE, samples), 0);
            errors(&light, &truth, partly)
        });
        eprintln!(
            "silhouette: RMS {rms:.4} at 16 samples (worst {worst:.3}), {rms_256:.4} at 256 (worst {worst_256:.3})"
        );
        assert!(rms <= SILHOUETTE, "{camera}: {rms}");
        assert!(rms_256 <= 0.25 * SILHOUETTE, "{camera}: {rms_256} at 256 samples");
    }
}

#[test]
fn toon_bands_are_near_their_coverage() {
    let bands = (0.5, 0.5, 2.0, 4.0);
    let m = toon::material(bands);
    let step = f64::from(m.top / m.steps);
    let toward = glam::DVec3::new(1.0, 2.0, 3.0).normalize();
    for camera in CAMERAS {
        let properties = format!(", {}", toon::properties(bands));
        let Some(mut engine) = gpu::engine(&["C 0.013 0.007 0"], &style(camera, "toon", &properties)) else { return };
        let world = World::new(&engine, SIZE, &[RADIUS], 0.14);
        // The twin without width is the hard step.
        let level = |at: DVec2| {
            let (_, _, hit) = world.seen(at)?;
            Some(f64::from(toon::toon_level(hit.normal.dot(toward) as f32, 0.0, &m)))
        };
        let mut truth = Vec::new();
        let mut crossed = Vec::new();
        for pixel in gpu::pixels(SIZE) {
            let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)].map(DVec2::from);
            let inside = corners.iter().all(|corner| level(center_px(pixel) + *corner).is_some());
            let mean = if inside { grid_mean(pixel, |at| level(at).unwrap_or(0.0)) } else { 0.0 };
            let share = mean / step;
            crossed.push(inside && (share - share.round()).abs() > 1e-6);
            truth.push(share);
        }
        let [one, sixteen, many] = [1, 16, 256].map(|samples| {
            let light = gpu::channel(&gpu::still(&mut engine, SIZE, samples), 0);
            let shares: Vec<f64> = light.into_iter().map(|light| light / step).collect();
            errors(&shares, &truth, |i| crossed[i])
        });
        eprintln!(
            "toon bands: RMS {:.4} at 1 sample, {:.4} at 16 (worst {:.3}), {:.4} at 256",
            one.0, sixteen.0, sixteen.1, many.0
        );
        assert!(sixteen.0 <= BAND, "{camera}: {}", sixteen.0);
    }
}
