//! Single measurements of a choice exchanged for better ones.
//!
//! Without measurement j, U = P·Jⱼᵀ, S = (1 − JⱼU)⁻¹:
//!
//! ```text
//! P⁻ = P + U·S·Uᵀ        |M⁻| = |M|·|1 − JⱼU|        tr(W·P⁻) = tr(W·P) + tr(S·UᵀWU)
//! ```
//!
//! and with another one i added to that as for a choice that grows. What JᵢP⁻Jᵢᵀ takes is JᵢPJᵢᵀ,
//! which every measurement keeps by itself, and JᵢU: a few hundred products for each pair.

use nalgebra::{DMatrix, Matrix3, MatrixXx3};

use super::criterion::{Criterion, gain};
use super::measurements::Measurements;
use crate::linalg::positive_definite_inverse;
use crate::parallel::in_parallel;

/// An exchange has to be better by this share.
const BETTER: f64 = 1e-9;
/// Measurements of one job.
const PART: usize = 128;
/// Most times that all of a choice is gone through.
const MOST_PASSES: usize = 20;

/// What is known by the present choice, and what every measurement of the group in question would
/// add to it.
struct State<'a> {
    all: &'a Measurements,
    /// Weight W of the criterion, where it has one.
    weight: Option<&'a DMatrix<f64>>,
    /// Inverse P of the information matrix.
    inverse: DMatrix<f64>,
    /// The measurements of the group with their JPJᵀ and J·PWP·Jᵀ.
    group: Vec<Known>,
}

/// A measurement with its JPJᵀ and J·PWP·Jᵀ.
type Known = (usize, Matrix3<f64>, Matrix3<f64>);

impl State<'_> {
    /// What `job` makes of each measurement of the group, in their order; parts of the group on all
    /// processors.
    fn in_parts<T: Send>(&self, job: impl Fn(&Known) -> T + Sync + Send) -> Vec<T> {
        let parts: Vec<&[Known]> = self.group.chunks(PART).collect();
        in_parallel(parts.len(), |part| parts[part].iter().map(&job).collect::<Vec<T>>())
            .into_iter()
            .flatten()
            .collect()
    }

    /// P ← P + U·S·Uᵀ, and with it what measurements would add: with A = J·U, B = J·PW·U, T = UᵀWU
    ///
    /// JPJᵀ ← JPJᵀ + A·S·Aᵀ        J·PWP·Jᵀ ← J·PWP·Jᵀ + A·S·Bᵀ + B·S·Aᵀ + A·S·T·S·Aᵀ
    fn update(&mut self, u: &MatrixXx3<f64>, s: &Matrix3<f64>) {
        let weighted = self.weight.map(|weight| {
            let wu: MatrixXx3<f64> = weight * u;
            let t: Matrix3<f64> = u.tr_mul(&wu);
            (&self.inverse * wu, t)
        });
        let updated = self.in_parts(|(index, spread, of_weight)| {
            let (mut spread, mut of_weight) = (*spread, *of_weight);
            let a = self.all.times(*index, u);
            spread += a * s * a.transpose();
            if let Some((pwu, t)) = &weighted {
                let b = self.all.times(*index, pwu);
                let across = a * s * b.transpose();
                of_weight += across + across.transpose() + a * s * t * s * a.transpose();
            }
            (*index, spread, of_weight)
        });
        self.group = updated;
        self.inverse += u * s * u.transpose();
    }

    /// The measurement that is best in the place of one that is chosen, if that is better.
    fn better(&self, own: usize, is_chosen: &[bool]) -> Option<usize> {
        let u = self.all.spread(own, &self.inverse);
        let left = Matrix3::identity() - self.all.times(own, &u);
        let s = left.try_inverse()?;
        let weighted = self.weight.map(|weight| {
            let wu: MatrixXx3<f64> = weight * &u;
            let t: Matrix3<f64> = u.tr_mul(&wu);
            (&self.inverse * wu, t)
        });
        // what is lost without it
        let (loss, now) = match (&weighted, self.weight) {
            (Some((_, t)), Some(weight)) => ((s * t).trace(), self.inverse.dot(weight)),
            _ => (left.determinant(), 1.0),
        };
        let changes = self.in_parts(|(index, spread, of_weight)| {
            if is_chosen[*index] {
                return (f64::NEG_INFINITY, *index);
            }
            let a = self.all.times(*index, &u);
            let spread = spread + a * s * a.transpose();
            let change = match &weighted {
                None => gain(&spread, None) * loss - 1.0,
                Some((pwu, t)) => {
                    let b = self.all.times(*index, pwu);
                    let across = a * s * b.transpose();
                    let of_weight = of_weight + across + across.transpose() + a * s * t * s * a.transpose();
                    gain(&spread, Some(&of_weight)) - loss
                }
            };
            (change, *index)
        });
        let mut best: Option<(f64, usize)> = None;
        for (change, index) in changes {
            if change > BETTER * now && best.is_none_or(|(most, _)| change >= most) {
                best = Some((change, index));
            }
        }
        best.map(|(_, index)| index)
    }
}

/// `chosen` with measurements exchanged within their groups until no exchange of one is better; the
/// determinant stands for [`Criterion::Smallest`]. `None` where M is not positive definite.
pub(super) fn exchanged(
    all: &Measurements,
    mut chosen: Vec<usize>,
    before: &DMatrix<f64>,
    criterion: &Criterion,
    progress: &(dyn Fn() + Sync),
) -> Option<Vec<usize>> {
    let weight = match criterion {
        Criterion::Trace(weight) => Some(weight),
        _ => None,
    };
    let mut groups: Vec<usize> = chosen.iter().map(|&index| all.group(index)).collect();
    groups.sort_unstable();
    groups.dedup();
    let mut is_chosen = vec![false; all.len()];
    chosen.iter().for_each(|&index| is_chosen[index] = true);
    for _ in 0..MOST_PASSES {
        let mut is_better = false;
        for &group in &groups {
            // afresh, so that no rounding adds up
            let (inverse, _) = positive_definite_inverse(&all.information(&chosen, before))?;
            let of_weight = weight.map(|weight| &inverse * weight * &inverse);
            let known = |index: usize| {
                let weighted = of_weight.as_ref().map(|of_weight| all.quadratic(index, of_weight));
                (index, all.quadratic(index, &inverse), weighted.unwrap_or_default())
            };
            let of_group: Vec<usize> = all.of_group(group).collect();
            let group_known = in_parallel(of_group.len(), |k| known(of_group[k]));
            let mut state = State { all, weight, inverse, group: group_known };
            for place in 0..chosen.len() {
                if all.group(chosen[place]) != group {
                    continue;
                }
                progress();
                let Some(other) = state.better(chosen[place], &is_chosen) else { continue };
                let u = all.spread(chosen[place], &state.inverse);
                let Some(s) = (Matrix3::identity() - all.times(chosen[place], &u)).try_inverse() else {
                    continue;
                };
                state.update(&u, &s);
                let u = all.spread(other, &state.inverse);
                if let Some(s) = (Matrix3::identity() + all.times(other, &u)).try_inverse() {
                    state.update(&u, &-s);
                }
                is_chosen[chosen[place]] = false;
                is_chosen[other] = true;
                chosen[place] = other;
                is_better = true;
            }
        }
        if !is_better {
            break;
        }
    }
    Some(chosen)
}
