//! How far readings of one load are off each other, whatever the load does.

use std::collections::BTreeMap;

use crate::rig::readings::{Phase, Reading};
use crate::statistics::median;

/// Mean of q (`displaced.rs`) where each load has a reading of its own on the way up, and one on
/// the way down: the curve of any sensor and any rod. `kind`: the number of the axis and stations
/// of a row; `deflection`: D of each of these, m; `cap`: the largest share. `None` where fewer than
/// half of the rows have another one of their load.
pub(super) fn left_by_any_curve(
    rows: &[Reading],
    kind: &[usize],
    deflection: &[f64],
    cap: f64,
) -> Option<f64> {
    let mut alike: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (i, (row, &kind)) in rows.iter().zip(kind).enumerate() {
        let is_unloading = row.phase == Some(Phase::Unload);
        alike.entry((kind, row.direction.sign, row.load.to_bits(), is_unloading)).or_default().push(i);
    }
    let repeated = || alike.values().filter(|own| own.len() > 1);
    let count: usize = repeated().map(Vec::len).sum();
    if 2 * count < rows.len().max(1) {
        return None;
    }
    let mut left = 0.0;
    for own in repeated() {
        let deflection = deflection[kind[own[0]]];
        for channel in 0..3 {
            let read: Vec<f64> = own.iter().filter_map(|&i| rows[i].offset[channel]).collect();
            let Some(middle) = median(&read).filter(|_| deflection > 0.0) else { continue };
            left += read.iter().map(|one| ((one - middle).abs() / deflection).min(cap).powi(2)).sum::<f64>();
        }
    }
    Some(left / count as f64)
}
