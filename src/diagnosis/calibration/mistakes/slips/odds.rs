//! How probable it is that a slip put a row where it is, against any disturbance.

use std::f64::consts::PI;

use super::super::draft::{Cell, Draft, DraftChange};
use crate::calibration::campaign::Recording;
use crate::statistics::median;

/// Degrees of freedom of the distances' distribution.
const NU: f64 = 4.0;
/// Ln of Γ(7/2)/(Γ(2)·(4π)^(3/2)), the density of that distribution in space at its middle.
const MIDDLE: f64 = -2.595;

/// Ln of the odds that a row was `left` from its point and a slip made it `length`, against any
/// disturbance that puts it anywhere in a volume (ln).
pub(super) fn ln_odds(ln_volume: f64, left: f64, scale: f64) -> f64 {
    let own = MIDDLE - 0.5 * (NU + 3.0) * ((left / scale).powi(2) / NU).ln_1p();
    own + ln_volume - 3.0 * scale.ln() + (4.0 * PI / 3.0).ln()
}

/// Ln of the odds that a row so far from its point was disturbed, against the scatter of the
/// others; none where it lies among them.
pub(super) fn disturbance(length: f64, scale: f64) -> f64 {
    (-ln_odds(3.0 * length.ln(), length, scale)).max(0.0)
}

/// Ln of the cube of what a disturbance may fill, m³. A displacement in a clamp is small whatever
/// happened: one that becomes small, or a neighbour's, is near for that alone.
pub(super) fn ln_volume(change: &DraftChange, length: f64, displacement: f64) -> f64 {
    let small = length.min(displacement).ln();
    match change {
        DraftChange::Within(_, inner) => ln_volume(inner, length, displacement),
        DraftChange::Seen(_) | DraftChange::Rows { .. } => 3.0 * small,
        DraftChange::Number { cell: Cell::Axis(_), .. } | DraftChange::Column { cell: Cell::Axis(_), .. } => {
            2.0 * length.ln() + small
        }
        _ => 3.0 * length.ln(),
    }
}

/// How large displacements in clamps are, in the middle, m; nothing limits points in {W}.
pub(super) fn displacement(draft: &Draft, recording: &Recording) -> f64 {
    if draft.has_sockets() || recording.groups.iter().any(|group| group.name.is_tracked()) {
        return f64::INFINITY;
    }
    let sizes: Vec<f64> = draft.seen.iter().map(|seen| seen.norm()).collect();
    median(&sizes).unwrap_or(f64::INFINITY).max(f64::MIN_POSITIVE)
}
