//! Without what the places of sockets, or of clamps that may be anywhere, take up: the mean of
//! their rows.

use nalgebra::{DMatrix, Vector3};

use super::super::draft::Draft;

/// Vectors less the weighted means of their sockets, or of the clamps whose place is free.
pub(super) fn minus_means(vectors: &[Vector3<f64>], draft: &Draft, weight: &[f64]) -> Vec<Vector3<f64>> {
    let mut sum = vec![(Vector3::zeros(), 0.0f64); draft.devices.len()];
    for (row, vector) in vectors.iter().enumerate() {
        let (total, weights) = &mut sum[draft.group[row]];
        *total += vector * weight[row];
        *weights += weight[row];
    }
    let mean = |group: usize| match draft.is_loose(group) {
        true => sum[group].0 / sum[group].1.max(f64::MIN_POSITIVE),
        false => Vector3::zeros(),
    };
    vectors.iter().zip(&draft.group).map(|(vector, &group)| vector - mean(group)).collect()
}

/// Columns of displacements less the means of their sockets, or of the clamps whose place is free.
pub(super) fn without_means(block: &mut DMatrix<f64>, draft: &Draft, weight: &[f64]) {
    if !draft.has_sockets() && draft.loose.is_empty() {
        return;
    }
    let mut size = vec![0.0f64; draft.devices.len()];
    draft.group.iter().zip(weight).for_each(|(&group, weight)| size[group] += weight);
    for mut column in block.column_iter_mut() {
        let mut sum = vec![Vector3::zeros(); size.len()];
        for (row, &group) in draft.group.iter().enumerate() {
            sum[group] += column.fixed_rows::<3>(3 * row) * weight[row];
        }
        for (row, &group) in draft.group.iter().enumerate().filter(|(_, group)| draft.is_loose(**group)) {
            let mut own = column.fixed_rows_mut::<3>(3 * row);
            own -= sum[group] / size[group].max(f64::MIN_POSITIVE);
        }
    }
}
