//! A recording as it stands in its files, and how two of them are put together.

use super::drawing::Drawing;
use super::protocol::{Cell, Loading, Protocol};

/// A recording as it is written down.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    /// The rod of `rod.toml`.
    pub drawing: Drawing,
    /// Rods whose files stand beside it, by their names.
    pub others: Vec<(String, Drawing)>,
    /// Loads and columns.
    pub protocol: Protocol,
    /// The numbers of the cells, m.
    pub shown: Vec<f64>,
}

/// The right file with the loadings that `is_of` admits as they stand in the wrong one.
pub fn merged(right: &Written, wrong: &Written, is_of: impl Fn(usize) -> bool) -> Written {
    let mut merged = right.clone();
    let rows = |written: &Written| {
        let mut rows = vec![Vec::new(); written.protocol.loadings.len()];
        let cells = written.protocol.cells().into_iter().zip(&written.shown);
        cells.for_each(|(cell, shown)| rows[cell.loading].push(*shown));
        rows
    };
    let (mut shown, others) = (rows(right), rows(wrong));
    for (k, other) in others.into_iter().enumerate().filter(|(k, _)| is_of(*k)) {
        merged.protocol.loadings[k] = wrong.protocol.loadings[k].clone();
        merged.protocol.channels[k] = wrong.protocol.channels[k];
        shown[k] = other;
    }
    merged.shown = shown.concat();
    merged
}

/// The readings of one trial in the place of those of another one, loading by loading.
pub fn copy(written: &Written, from: usize, to: usize) -> Written {
    let mut copy = written.clone();
    let (loadings, cells) = (&written.protocol.loadings, written.protocol.cells());
    let of_trial = |trial: usize| {
        let own = cells.iter().enumerate().filter(move |(_, cell)| loadings[cell.loading].trial == trial);
        own.map(|(index, cell)| (index, *cell)).collect::<Vec<(usize, Cell)>>()
    };
    for ((source, a), (target, b)) in of_trial(from).into_iter().zip(of_trial(to)) {
        let (a, b) = ((&loadings[a.loading], a.channel), (&loadings[b.loading], b.channel));
        let key = |(l, channel): (&Loading, usize)| {
            (
                l.axis,
                l.sign.to_bits(),
                l.load.to_bits(),
                l.is_unloading,
                l.stations.map(f64::to_bits),
                channel,
            )
        };
        if key(a) == key(b) {
            copy.shown[target] = written.shown[source];
        }
    }
    copy
}

/// The same place, of one trial where that is named.
pub fn in_trials(key: &str, trials: &[usize], protocol: &Protocol) -> String {
    match trials {
        [trial] if protocol.columns.trial => format!("{key}, trial {}", trial + 1),
        _ => key.to_owned(),
    }
}
