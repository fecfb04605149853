//! A choice that grows by the measurement that adds most.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nalgebra::{DMatrix, Matrix3};

use super::criterion::{Criterion, gain};
use super::measurements::Measurements;
use crate::linalg::positive_definite_inverse;
use crate::parallel::in_parallel;

/// What a measurement added when it was last looked at, after so many others.
struct Offer {
    gain: f64,
    index: usize,
    after: usize,
}

impl PartialEq for Offer {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Offer {}

impl PartialOrd for Offer {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Offer {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain.total_cmp(&other.gain).then(self.index.cmp(&other.index))
    }
}

/// `quotas[g]` measurements of each group in the order in which they were taken, one group after
/// the other: every time the one that adds most to what is known by then. `None` where `before` is
/// not positive definite.
///
/// What a measurement adds to a determinant only falls as others are taken: one whose gain of
/// earlier is below another's of now needs no second look. Gains of a trace nearly always fall.
pub fn grow(
    all: &Measurements,
    quotas: &[usize],
    before: &DMatrix<f64>,
    criterion: &Criterion,
    progress: &(dyn Fn() + Sync),
) -> Option<Vec<usize>> {
    // P = M⁻¹, and PWP
    let (mut inverse, _) = positive_definite_inverse(before)?;
    let weighted = |inverse: &DMatrix<f64>| match criterion {
        Criterion::Trace(weight) => Some(inverse * weight * inverse),
        _ => None,
    };
    let mut weight = weighted(&inverse);
    let gain_of = |index: usize, inverse: &DMatrix<f64>, weight: Option<&DMatrix<f64>>| {
        let spread = all.quadratic(index, inverse);
        gain(&spread, weight.map(|weight| all.quadratic(index, weight)).as_ref())
    };
    let mut open: Vec<BinaryHeap<Offer>> = (0..quotas.len())
        .map(|group| {
            let of_group: Vec<usize> = all.of_group(group).collect();
            let gains = in_parallel(of_group.len(), |k| gain_of(of_group[k], &inverse, weight.as_ref()));
            of_group.into_iter().zip(gains).map(|(index, gain)| Offer { gain, index, after: 0 }).collect()
        })
        .collect();
    let mut chosen = Vec::with_capacity(quotas.iter().sum());
    for round in 0..quotas.iter().copied().max().unwrap_or(0) {
        for (group, _) in quotas.iter().enumerate().filter(|(_, quota)| round < **quota) {
            while let Some(offer) = open[group].pop() {
                if offer.after < chosen.len() {
                    let gain = gain_of(offer.index, &inverse, weight.as_ref());
                    open[group].push(Offer { gain, after: chosen.len(), ..offer });
                    continue;
                }
                chosen.push(offer.index);
                progress();
                // (M + JᵀJ)⁻¹ = P − P·Jᵀ(1 + J·P·Jᵀ)⁻¹J·P
                let across = all.spread(offer.index, &inverse);
                let grown = Matrix3::identity() + all.times(offer.index, &across);
                if let Some(middle) = grown.try_inverse() {
                    inverse -= &across * middle * across.transpose();
                }
                weight = weighted(&inverse);
                break;
            }
        }
    }
    Some(chosen)
}
