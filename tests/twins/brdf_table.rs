//! The committed albedo table against its integrals.

use restyle::shading::brdf_table::{BYTES, compute, compute_with};

/// Mathematical libraries differ in the last digits; more means that the table is stale.
const STALE: f32 = 1e-6;

#[test]
fn committed_table_is_what_compute_gives() {
    let computed = compute();
    if std::env::var("RESTYLE_BLESS").is_ok_and(|name| name == "brdf_table") {
        let bytes: Vec<u8> = computed.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        std::fs::write("src/shading/brdf_table.bin", bytes).unwrap();
        return;
    }
    assert_eq!(BYTES.len(), computed.len() * 16, "RESTYLE_BLESS=brdf_table cargo test writes the table");
    for (i, (texel, bytes)) in computed.iter().zip(BYTES.chunks_exact(16)).enumerate() {
        for (value, bytes) in texel.iter().zip(bytes.chunks_exact(4)) {
            let stored = f32::from_le_bytes(bytes.try_into().unwrap());
            assert!((stored - value).abs() <= STALE, "texel {i}: {stored} is stored, {value} computed");
        }
    }
}

#[test]
fn table_has_converged() {
    let (table, truth) = (compute(), compute_with(1 << 13));
    let mut worst = [0f32; 3];
    for (a, b) in table.iter().zip(&truth) {
        for channel in 0..3 {
            worst[channel] = worst[channel].max((a[channel] - b[channel]).abs());
        }
    }
    println!("table, largest error of A, B, D: {worst:?}");
    assert!(worst.iter().all(|&x| x < 2e-3), "{worst:?}");
}

#[test]
fn albedo_seen_from_above_is_that_of_the_closed_form() {
    let table = compute();
    let white = |x: usize, y: usize| table[y * 32 + x][0] + table[y * 32 + x][1];
    assert!((white(31, 0) - 1.0).abs() < 1e-3);
    // alpha = 1, n = v: D = 1 / pi and G2 = 2 n.l / (1 + n.l), so the albedo is the integral of
    // c / (1 + c) over c = 0..1.
    let rough = 1.0 - 2f32.ln();
    assert!((white(31, 31) - rough).abs() < 1e-3, "{} is not {rough}", white(31, 31));
}
