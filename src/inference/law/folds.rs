//! Held-out proof of a law: the whole search is repeated without a fold, and predicts that fold.
//!
//! The folds are those of the diagnosis. The findings are those of all data, fitted anew without
//! each fold: it is what the law adds to them that is asked.

use nalgebra::{DMatrix, DVector};

use super::choice::Choice;
use super::described::Data;
use super::remainder::Remainder;
use super::scan::{Scanned, scan_some};
use super::site::Site;
use crate::inference::score::priors::{APART, NAMED};
use crate::parallel::in_parallel;

/// By this share of its square a held-out error is lowered at least.
pub(super) const WORTH: f64 = 0.05;
/// Most laws that predict together.
const TOGETHER: usize = 12;

/// Root mean squares of what is left of held-out data.
pub(super) struct Folds {
    /// With the findings alone.
    pub without: f64,
    /// With the law that is found without each fold as well.
    pub with: f64,
    /// With each of some laws, fitted without each fold.
    pub own: Vec<f64>,
}

impl Folds {
    /// True for a held-out error that is lower than without a law by enough.
    pub fn is_lower(&self, error: f64) -> bool {
        error < self.without * (1.0 - WORTH).sqrt()
    }
}

/// All data as predicted with the findings alone, with the law that is found besides, and with each
/// of some laws.
type Predicted = (DVector<f64>, DVector<f64>, Vec<DVector<f64>>);

/// Predicts each fold; `None` where nothing could be held out. Each fold's own search is among
/// `tried`; `choices` are compared besides.
pub(super) fn hold_out(
    &Data { model, evidence, terms, size, sigma }: &Data,
    sites: &[Site],
    (choices, tried): (&[Choice], &[Choice]),
) -> Option<Folds> {
    let folds = evidence.folds();
    if folds.len() < 2 {
        return None;
    }
    let n = evidence.residual.len();
    let kept = |fold: usize| (0..n).filter(|&row| evidence.fold[row] != fold).collect::<Vec<_>>();
    let by_fold: Vec<Predicted> = in_parallel(folds.len(), |k| {
        let remainder = Remainder::new(model, evidence, terms, kept(folds[k]), sigma);
        let found = scan_some(&remainder, sites, size, |choice| tried.iter().any(|own| own.is(choice))).laws;
        let none = remainder.fit(&DMatrix::zeros(n, 0)).predicted;
        let predicted_by = |law: &Scanned| {
            let columns = law.choice.columns(&sites[law.choice.site], law.at, size);
            remainder.fit(&columns.columns).predicted
        };
        let best = found.first().map_or(f64::NEG_INFINITY, |law| law.log_odds);
        let with = match best > NAMED.ln() {
            true => averaged(
                found.iter().take(TOGETHER).take_while(|law| law.log_odds > best - APART.ln()),
                predicted_by,
            ),
            false => none.clone(),
        };
        let own = choices.iter().map(|choice| {
            let law = found.iter().find(|law| law.choice.is(choice));
            law.map_or_else(|| none.clone(), predicted_by)
        });
        let own = own.collect();
        (none, with, own)
    });
    let rms = |part: &dyn Fn(&Predicted) -> &DVector<f64>| {
        let (mut square, mut count) = (0.0, 0.0);
        for (k, predicted) in by_fold.iter().enumerate() {
            let predicted = part(predicted);
            for row in (0..n).filter(|&row| evidence.fold[row] == folds[k]) {
                square += evidence.weight[row] * (evidence.residual[row] - predicted[row]).powi(2);
                count += evidence.weight[row];
            }
        }
        (square / f64::max(count, f64::MIN_POSITIVE)).sqrt()
    };
    Some(Folds {
        without: rms(&|predicted| &predicted.0),
        with: rms(&|predicted| &predicted.1),
        own: (0..choices.len()).map(|k| rms(&|predicted| &predicted.2[k])).collect(),
    })
}

/// What laws predict on average, each by its probability.
fn averaged<'a>(
    laws: impl Iterator<Item = &'a Scanned>,
    predicted: impl Fn(&Scanned) -> DVector<f64>,
) -> DVector<f64> {
    let mut whole = 0.0;
    let mut sum = DVector::zeros(0);
    let mut most = None;
    for law in laws {
        let share = (law.log_odds - *most.get_or_insert(law.log_odds)).exp();
        let own = predicted(law) * share;
        whole += share;
        sum = if sum.is_empty() { own } else { sum + own };
    }
    sum / f64::max(whole, f64::MIN_POSITIVE)
}
