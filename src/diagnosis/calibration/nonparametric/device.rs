//! Displacement sensors that do not read along a straight line: along each axis of the devices
//!
//! ```text
//! R_c·e·Σ_k a_k·cos(π k x)       x the displacement that is shown along e, from 0 to 1
//! ```
//!
//! of all clamps, for the same sensors go from clamp to clamp more often than not.

use super::super::effects::contact::is_of_clamps;
use super::super::model::Context;
use super::super::model::entry::{Entry, linear};
use super::curve::{AXES, MOST, SIZE, cosine, curve, scaled};

/// A curve for each axis along which displacements differ.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    match is_of_clamps(context) && context.shows_displacements() {
        true => (0..3).filter_map(|axis| along(context, axis)).collect(),
        false => Vec::new(),
    }
}

fn along(context: &Context, axis: usize) -> Option<Entry> {
    let recording = context.recording;
    let rows = 0..context.configurations.len();
    let x = scaled(&rows.map(|row| context.displacement(row)[axis]).collect::<Vec<_>>())?;
    let parameters = (1..=MOST).map(|k| {
        let column = context.column(|row, _| recording.device(row).rotation.column(axis) * cosine(k, x[row]));
        (linear(format!("device_{}_cosine_{k}_um", AXES[axis]), SIZE / (1 + k) as f64), column)
    });
    let axis = AXES[axis];
    let label = format!("displacement along {axis} of the clamps, a curve");
    let follows = format!("follows the displacement that the clamps' sensors show along {axis}");
    Some(curve(label, follows, None, parameters.collect()))
}
