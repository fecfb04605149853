//! Displacement sensors that do not read along a straight line: along each axis of the devices
//!
//! ```text
//! R_c·e·Σ_k a_k·cos(π k x)       x the displacement that is shown along e, from 0 to 1
//! ```
//!
//! of all clamps, for the same sensors go from clamp to clamp more often than not; and of one
//! clamp, or all, along e by the displacement along another axis: a guide that is worn on one side.

use nalgebra::Vector3;

use super::super::effects::contact::is_of_clamps;
use super::super::model::Context;
use super::super::model::entry::{Entry, linear};
use super::curve::{AXES, MOST, SIZE, cosine, curve, scaled};

/// Cosines of one clamp: it has few poses.
const OF_ONE: usize = 4;

/// A curve for each axis along which displacements differ; those across have the prior of one curve
/// together.
pub(super) fn all(context: &Context) -> Vec<Entry> {
    if !is_of_clamps(context) || !context.shows_displacements() {
        return Vec::new();
    }
    let count = context.recording.groups.len();
    let of_one = (0..count).filter(|_| count > 1).flat_map(|group| {
        let pairs = (0..9).map(|k| (k / 3, k % 3));
        pairs.filter_map(move |(shown, by)| across(context, Some(group), shown, by))
    });
    let of_all = (0..9).map(|k| (k / 3, k % 3)).filter(|(shown, by)| shown != by);
    let of_all = of_all.filter_map(|(shown, by)| across(context, None, shown, by));
    let mut across: Vec<Entry> = of_one.chain(of_all).collect();
    let share = 1.0 / across.len().max(1) as f64;
    across.iter_mut().for_each(|entry| entry.candidate.weight = share);
    (0..3).filter_map(|axis| along(context, axis)).chain(across).collect()
}

/// What is shown along an axis by the displacement along one, of a clamp or of all.
fn across(context: &Context, group: Option<usize>, shown: usize, by: usize) -> Option<Entry> {
    let recording = context.recording;
    let is_there = |row: usize| group.is_none_or(|group| recording.rows[row].group == group);
    let rows: Vec<usize> = (0..context.configurations.len()).filter(|&row| is_there(row)).collect();
    let scaled = scaled(&rows.iter().map(|&row| context.displacement(row)[by]).collect::<Vec<_>>())?;
    let mut x = vec![f64::NAN; context.configurations.len()];
    rows.iter().zip(scaled).for_each(|(&row, at)| x[row] = at);
    // of all clamps the constant is the tool's, or the base's; of one it is a part of the curve
    let first = if group.is_some() { 0 } else { 1 };
    let parameters = (first..=OF_ONE).map(|k| {
        let column = context.column(|row, _| match is_there(row) {
            true => recording.device(row).rotation.column(shown) * cosine(k, x[row]),
            false => Vector3::zeros(),
        });
        (linear(format!("device_{}_cosine_{k}_um", AXES[shown]), SIZE / (1 + k) as f64), column)
    });
    let place = group.map_or("all clamps".to_owned(), |group| recording.groups[group].name.to_string());
    let (shown, by) = (AXES[shown], AXES[by]);
    let label = format!("displacement along {by} at {place}, a curve along {shown}");
    let follows = format!("along {shown} of the device follows the displacement along {by} ({place})");
    Some(curve(label, follows, None, parameters.collect()))
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
