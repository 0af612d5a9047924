//! Measurements: how far pictures are from each other.

pub mod metrics;
