//! The transfer curve of display values [IEC61966, part 2-1].

/// The display value of linear light, both 0..1; what lies outside is cut.
pub fn srgb_from_linear(light: f64) -> f64 {
    let c = light.clamp(0.0, 1.0);
    if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

/// Linear light of a display value, both 0..1.
pub fn linear_from_srgb(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_meet() {
        for step in 0..=255 {
            let value = f64::from(step) / 255.0;
            assert!((srgb_from_linear(linear_from_srgb(value)) - value).abs() < 1e-7, "{step}");
        }
        assert!((linear_from_srgb(0.5) - 0.214_041_14).abs() < 1e-8);
        assert_eq!(srgb_from_linear(-1.0), 0.0);
        assert!((srgb_from_linear(2.0) - 1.0).abs() < 1e-12);
    }
}
