//! Exchanges that raise the least eigenvalue of the information: O4.
//!
//! No update of low rank gives λₘ. But vectors that span a part of the space bound it from above
//! and λ₁ from below (Rayleigh): with the lowest eigenvectors V of M⁻, the highest v and J of
//! another measurement,
//!
//! ```text
//! λₘ(M⁻ + JᵀJ) ≤ λₘ(Vᵀ(M⁻ + JᵀJ)V)        λ₁(M⁻ + JᵀJ) ≥ λ₁(M⁻) + |J·v|²
//! ```
//!
//! so that only those measurements are looked at exactly whose bound is above the best that was
//! found.

use nalgebra::{DMatrix, DVector, Matrix3, MatrixXx3};

use super::criterion::balance;
use super::measurements::Measurements;
use crate::parallel::in_parallel;

/// An exchange has to be better by this share.
const BETTER: f64 = 1e-9;
/// Measurements of one job.
const PART: usize = 128;
/// Most times that all of a choice is gone through.
const MOST_PASSES: usize = 8;

/// `chosen` with measurements exchanged within their groups until no exchange of one raises λₘ/√λ₁.
pub(super) fn exchanged(
    all: &Measurements,
    mut chosen: Vec<usize>,
    before: &DMatrix<f64>,
    progress: &(dyn Fn() + Sync),
) -> Vec<usize> {
    let Some(mut best) = balance(all.information(&chosen, before)) else { return chosen };
    let mut is_chosen = vec![false; all.len()];
    chosen.iter().for_each(|&index| is_chosen[index] = true);
    for _ in 0..MOST_PASSES {
        let start = best;
        let mut whole = all.information(&chosen, before);
        for place in 0..chosen.len() {
            progress();
            let own = chosen[place];
            let nothing = DMatrix::zeros(all.columns(), all.columns());
            let left = &whole - all.information(&[own], &nothing);
            let mut bounds = bounds(all, &left, all.group(own));
            bounds.retain(|(bound, index)| *bound > best * (1.0 + BETTER) && !is_chosen[*index]);
            bounds.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1)));
            for (bound, index) in bounds {
                if bound <= best * (1.0 + BETTER) {
                    break;
                }
                let exact = balance(all.information(&[index], &left)).unwrap_or(0.0);
                if exact > best * (1.0 + BETTER) {
                    (best, chosen[place]) = (exact, index);
                }
            }
            if chosen[place] != own {
                (is_chosen[own], is_chosen[chosen[place]]) = (false, true);
                whole = all.information(&[chosen[place]], &left);
            }
        }
        if best <= start * (1.0 + BETTER) {
            break;
        }
    }
    chosen
}

/// Upper bounds of λₘ/√λ₁ with each measurement of a group added to `left`.
fn bounds(all: &Measurements, left: &DMatrix<f64>, group: usize) -> Vec<(f64, usize)> {
    let eigen = left.clone().symmetric_eigen();
    let mut order: Vec<usize> = (0..left.nrows()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let vector = |rank: usize| -> DVector<f64> {
        order.get(rank).map_or_else(|| DVector::zeros(left.nrows()), |&k| eigen.eigenvectors.column(k).into())
    };
    let value = |rank: usize| order.get(rank).map_or(f64::INFINITY, |&k| eigen.eigenvalues[k]);
    let low = MatrixXx3::from_columns(&[vector(0), vector(1), vector(2)]);
    let greatest = order.len().saturating_sub(1);
    let zeros = DVector::zeros(left.nrows());
    let high = MatrixXx3::from_columns(&[vector(greatest), zeros.clone(), zeros]);
    let lowest = Matrix3::from_diagonal(&[value(0), value(1).min(1e300), value(2).min(1e300)].into());
    let of_group: Vec<usize> = all.of_group(group).collect();
    let parts: Vec<&[usize]> = of_group.chunks(PART).collect();
    let of_part = |part: usize| -> Vec<(f64, usize)> {
        let bound = |&index: &usize| {
            let (down, up) = (all.times(index, &low), all.times(index, &high));
            let least = (lowest + down.tr_mul(&down)).symmetric_eigenvalues().min();
            (least.max(0.0) / (value(greatest) + up.norm_squared()).sqrt(), index)
        };
        parts[part].iter().map(bound).collect()
    };
    in_parallel(parts.len(), of_part).into_iter().flatten().collect()
}
