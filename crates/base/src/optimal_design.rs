//! Which of very many measurements to make: exact designs of distinct measurements.
//!
//! A measurement says of m unknowns what its three rows J of the Jacobian say; with Λ known
//! beforehand, those that are chosen say
//!
//! ```text
//! M = Λ + Σ JᵀJ        P = M⁻¹, the covariance of the unknowns
//! ```
//!
//! - [`Measurements`]: all that could be made, each in a group
//! - [`Criterion`]: what M shall be good for
//! - [`choose`]: so many distinct ones of each group
//!
//! The choice grows one by one by the largest gain (H. P. Wynn, *Ann. Math. Statist.* 41 (1970)
//! 1655–1664), with gains that are computed again only where they may be the largest (M.
//! Minoux, *Optimization
//! Techniques* (1978) 234–243). Then single measurements are exchanged for others of their group as
//! long as that is better (V. V. Fedorov, *Theory of Optimal Experiments* (1972)), by updates of
//! rank three. Where there is little to choose from, it begins from other choices too. Of equal
//! gains the later measurement counts, so that nothing depends on chance.

mod criterion;
mod exchange;
mod grow;
mod measurements;
mod smallest;

pub use criterion::{Criterion, value};
pub use grow::grow;
pub use measurements::Measurements;

use nalgebra::DMatrix;

use crate::parallel::in_parallel;
use crate::statistics::Random;

/// Measurements times choices up to which other beginnings are tried too, and how many.
const FEW: usize = 5_000;
const BEGINNINGS: usize = 24;

/// `quotas[g]` distinct measurements of each group g, in ascending order: those that `criterion`
/// takes for best as far as exchanging single ones finds them. `before` is Λ, positive definite.
/// `None` where it is not, or where a group has too few. `progress` is called whenever one more was
/// taken or held against all others of its group.
///
/// ```
/// use nalgebra::{DMatrix, Matrix3xX, RowDVector};
/// use rodcal_base::optimal_design::{Criterion, Measurements, choose};
///
/// // a slope and an intercept are seen best at both ends
/// let mut all = Measurements::new(2);
/// for x in [0.0, 1.0, 2.0, 3.0] {
///     let mut rows = Matrix3xX::zeros(2);
///     rows.set_row(0, &RowDVector::from_vec(vec![x, 1.0]));
///     all.push(0, &rows);
/// }
/// let faint = DMatrix::identity(2, 2) * 1e-9;
/// assert_eq!(choose(&all, &[2], &faint, &Criterion::Determinant, &|| ()), Some(vec![0, 3]));
/// ```
pub fn choose(
    all: &Measurements,
    quotas: &[usize],
    before: &DMatrix<f64>,
    criterion: &Criterion,
    progress: &(dyn Fn() + Sync),
) -> Option<Vec<usize>> {
    let is_there = |(group, quota): (usize, &usize)| all.of_group(group).count() >= *quota;
    if !quotas.iter().enumerate().all(is_there) {
        return None;
    }
    crate::linalg::positive_definite_inverse(before)?;
    let total: usize = quotas.iter().sum();
    let beginnings = if all.len() * total <= FEW { BEGINNINGS } else { 1 };
    let improved = in_parallel(beginnings, |beginning| {
        let start = match beginning {
            0 => grow(all, quotas, before, criterion, progress)?,
            other => anything(all, quotas, other as u64),
        };
        let chosen = match (criterion, beginning) {
            (Criterion::Smallest, 0) => {
                let start = exchange::exchanged(all, start, before, criterion, progress)?;
                smallest::exchanged(all, start, before, progress)
            }
            (Criterion::Smallest, _) => smallest::exchanged(all, start, before, progress),
            _ => exchange::exchanged(all, start, before, criterion, progress)?,
        };
        Some((value(all, &chosen, before, criterion)?, chosen))
    });
    let mut best: Option<(f64, Vec<usize>)> = None;
    for (value, mut chosen) in improved.into_iter().flatten() {
        chosen.sort_unstable();
        if best.as_ref().is_none_or(|(least, _)| value > *least) {
            best = Some((value, chosen));
        }
    }
    best.map(|(_, chosen)| chosen)
}

/// Distinct measurements at random, as many of each group as there shall be.
pub fn anything(all: &Measurements, quotas: &[usize], seed: u64) -> Vec<usize> {
    let mut random = Random::seeded(seed, 5);
    let mut chosen = Vec::with_capacity(quotas.iter().sum());
    for (group, &quota) in quotas.iter().enumerate() {
        let mut open: Vec<usize> = all.of_group(group).collect();
        for taken in 0..quota.min(open.len()) {
            let other = taken + random.index(open.len() - taken);
            open.swap(taken, other);
            chosen.push(open[taken]);
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3xX;

    const COLUMNS: usize = 4;

    fn some(count: usize, groups: usize, seed: u64) -> Measurements {
        let mut random = Random::seeded(seed, 0);
        let mut all = Measurements::new(COLUMNS);
        for k in 0..count {
            // unlike one another: of some, one unknown hardly shows
            let size = random.uniform(0.2, 1.0);
            let rows = Matrix3xX::from_fn(COLUMNS, |_, c| {
                size * random.normal() * if c == k % COLUMNS { 0.05 } else { 1.0 }
            });
            all.push(k % groups, &rows);
        }
        all
    }

    fn before() -> DMatrix<f64> {
        DMatrix::identity(COLUMNS, COLUMNS) * 1e-3
    }

    fn criteria() -> [Criterion; 3] {
        let weight = DMatrix::from_fn(COLUMNS, COLUMNS, |i, k| if i == k { 1.0 + i as f64 } else { 0.3 });
        [Criterion::Determinant, Criterion::Trace(weight), Criterion::Smallest]
    }

    /// Every choice of so many of each group.
    fn every(all: &Measurements, quotas: &[usize]) -> Vec<Vec<usize>> {
        let mut choices = vec![Vec::new()];
        for (group, &quota) in quotas.iter().enumerate() {
            let open: Vec<usize> = all.of_group(group).collect();
            let subsets: Vec<Vec<usize>> = (0u32..1 << open.len())
                .filter(|bits| bits.count_ones() as usize == quota)
                .map(|bits| (0..open.len()).filter(|k| bits >> k & 1 == 1).map(|k| open[k]).collect())
                .collect();
            choices = choices
                .iter()
                .flat_map(|choice| subsets.iter().map(move |more| [choice.clone(), more.clone()].concat()))
                .collect();
        }
        choices
    }

    #[test]
    fn the_choice_is_that_of_brute_force() {
        for seed in 0..12 {
            let (all, quotas) = (some(14, 2, seed), [3, 2]);
            for criterion in criteria() {
                let worth = |chosen: &Vec<usize>| value(&all, chosen, &before(), &criterion).unwrap();
                let choices = every(&all, &quotas);
                assert_eq!(choices.len(), 35 * 21);
                let best = choices.iter().map(worth).fold(f64::NEG_INFINITY, f64::max);
                let chosen = choose(&all, &quotas, &before(), &criterion, &|| ()).unwrap();
                assert!((worth(&chosen) - best).abs() < 1e-9 * best.abs(), "seed {seed}, {criterion:?}");
                let sorted = |choice: &Vec<usize>| {
                    let mut sorted = choice.clone();
                    sorted.sort_unstable();
                    sorted
                };
                assert!(choices.iter().any(|choice| sorted(choice) == chosen), "{chosen:?}");
            }
        }
    }

    #[test]
    fn equals_are_told_apart_by_their_place_and_too_few_are_refused() {
        let mut all = Measurements::new(1);
        for _ in 0..5 {
            all.push(0, &Matrix3xX::from_element(1, 1.0));
        }
        let before = DMatrix::identity(1, 1);
        assert_eq!(choose(&all, &[2], &before, &Criterion::Determinant, &|| ()), Some(vec![3, 4]));
        assert_eq!(choose(&all, &[6], &before, &Criterion::Determinant, &|| ()), None);
        assert_eq!(choose(&all, &[2], &-before, &Criterion::Determinant, &|| ()), None);
    }

    #[test]
    fn lazy_gains_choose_what_all_gains_would() {
        let all = some(60, 3, 7);
        let mut chosen: Vec<usize> = Vec::new();
        for _ in 0..4 {
            for group in 0..3 {
                let worth = |&k: &usize| {
                    let more = [chosen.clone(), vec![k]].concat();
                    value(&all, &more, &before(), &Criterion::Determinant).unwrap()
                };
                let open = all.of_group(group).filter(|k| !chosen.contains(k));
                let best = open.max_by(|a, b| worth(a).total_cmp(&worth(b))).unwrap();
                chosen.push(best);
            }
        }
        assert_eq!(grow(&all, &[4, 4, 4], &before(), &Criterion::Determinant, &|| ()), Some(chosen));
    }
}
