//! Angles over the recorded range of a joint, as finely as what is tabulated over them needs.

use std::f64::consts::TAU;

/// Rows of a table for each cycle of its curve, and at least and at most.
const PER_CYCLE: f64 = 16.0;
const ROWS: (usize, usize) = (60, 4000);

/// A function of a joint's angle over the range of the recorded `angles`, as rows.
pub fn table(angles: &[f64], cycles_per_rev: f64, turn: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    spaced(angles, rows(angles, cycles_per_rev)).map(|q| (q, turn(q))).collect()
}

/// Rows that a curve with so many cycles per revolution needs over the range of the angles.
pub fn rows(angles: &[f64], cycles_per_rev: f64) -> usize {
    let (low, high) = range(angles);
    (PER_CYCLE * ((high - low) / TAU) * cycles_per_rev) as usize
}

/// So many equal steps over the range of the angles.
pub fn spaced(angles: &[f64], count: usize) -> impl Iterator<Item = f64> + use<> {
    let (low, high) = range(angles);
    let count = count.clamp(ROWS.0, ROWS.1);
    (0..=count).map(move |k| low + (high - low) * k as f64 / count as f64)
}

fn range(angles: &[f64]) -> (f64, f64) {
    let bounds = |(low, high): (f64, f64), &q: &f64| (low.min(q), high.max(q));
    angles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), bounds)
}
