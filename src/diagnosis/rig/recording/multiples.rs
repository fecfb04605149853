//! The step that numbers are written in.

use crate::units::UM;

/// The step that all values are multiples of, m: 10, 5, 2, 1, 0.5 µm and so on; 0 where they show
/// none.
pub fn step_of(values: &[f64]) -> f64 {
    const COARSEST: i32 = 1;
    const FINEST: i32 = -6;
    /// The file's decimals are not exact in binary, and the more steps the less so.
    const INEXACT: f64 = 1e-6;
    let is_multiple = |value: f64, step: f64| {
        let steps = value / UM / step;
        (steps - steps.round()).abs() <= INEXACT
    };
    let steps = (FINEST..=COARSEST).rev().flat_map(|decade| {
        let mantissas: &[f64] = if decade == COARSEST { &[1.0] } else { &[5.0, 2.0, 1.0] };
        mantissas.iter().map(move |mantissa| mantissa * 10f64.powi(decade))
    });
    let mut steps = steps.filter(|&step| values.iter().all(|value| is_multiple(*value, step)));
    steps.next().map_or(0.0, |step| step * UM)
}
