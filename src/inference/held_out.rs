//! Held-out proof: the whole selection is repeated without a fold, and its hypothesis predicts that
//! fold.
//!
//! What a theme (an effect; in joints, at those joints) is worth is found in the same folds: the
//! hypothesis of all data is fitted to the others with and without it, and predicts the fold.

use nalgebra::DVector;

use super::linearised::Linearised;
use super::pruning::infer;
use super::search::Search;
use super::selection::{APART, Pairs};
use super::{Candidate, Effect, Evidence, ForwardModel, Hypothesis, Location, Term};
use crate::parallel::in_parallel;
use crate::statistics::{Random, percentile_interval};

/// Squares of a fold before and after, and how many data they are of.
type Squares = (f64, f64, f64);

/// Draws of the bootstrap over folds.
const DRAWS: usize = 1000;

/// Errors of data that the model had not seen.
#[derive(Debug, Clone)]
pub struct HeldOut {
    /// Root mean square of what the base model leaves of held-out data.
    pub before: f64,
    /// And of what the hypothesis found without them leaves.
    pub after: f64,
    /// 1 − after²/before², with its 95 % interval by drawing folds again; `None` with fewer than three folds.
    pub gain: f64,
    /// See `gain`.
    pub gain_interval: Option<(f64, f64)>,
    /// Hypotheses of the folds.
    pub hypotheses: Vec<Vec<Term>>,
    /// What each theme of a fold's hypothesis is worth there; see [`HeldOut::loss`].
    losses: Vec<(Theme, f64)>,
    /// What the base model leaves of each datum while it is held out; NaN for data that never are.
    pub errors_before: DVector<f64>,
    /// And what the hypothesis of its fold leaves.
    pub errors_after: DVector<f64>,
}

/// What counts as the same finding in another search: an effect, and in joints its joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Theme {
    effect: &'static Effect,
    joints: Option<[usize; 2]>,
}

impl Theme {
    /// Of a candidate.
    pub fn new(candidate: &Candidate) -> Theme {
        let joints = match &candidate.location {
            Location::Joint { joint, .. } => Some([*joint, *joint]),
            Location::Coupling { from, to } => Some([*from, *to]),
            _ => None,
        };
        Theme { effect: candidate.effect, joints }
    }
}

impl HeldOut {
    /// In how many folds a theme is found again, of how many.
    pub fn found(&self, candidates: &[Candidate], theme: Theme) -> (usize, usize) {
        let is_it = |term: &Term| Theme::new(&candidates[term.candidate]) == theme;
        let count = self.hypotheses.iter().filter(|terms| terms.iter().any(is_it)).count();
        (count, self.hypotheses.len())
    }

    /// Share of the squares of the errors before that comes back without a theme.
    pub fn loss(&self, theme: Theme) -> f64 {
        self.losses.iter().filter(|(of, _)| *of == theme).map(|(_, loss)| loss).sum()
    }
}

/// What some of the data, `kept`, say of all data.
pub(super) struct Trained {
    /// What the base model, fitted to them, leaves of all data.
    pub before: DVector<f64>,
    /// And what the hypothesis that they support by themselves leaves, forms of its laws averaged.
    pub after: DVector<f64>,
    /// Its terms.
    pub terms: Vec<Term>,
    /// What a given hypothesis leaves, fitted to them, and what it leaves without each of its
    /// themes.
    pub with: DVector<f64>,
    /// See `with`.
    pub without: Vec<(Theme, DVector<f64>)>,
}

/// Selects with the data `kept` only, which are all but those of the part `left_out` of the model; `whole` are the terms that all data support.
pub(super) fn trained_on(
    model: &Linearised<'_>,
    evidence: &Evidence,
    kept: &[usize],
    left_out: usize,
    whole: &[Term],
) -> Trained {
    let (part, training) = (model.part(kept, left_out), evidence.part(kept));
    let pairs = if whole.len() > 1 { Pairs::Screened } else { Pairs::LeftOut };
    let (search, hypothesis, _) = infer(&part, &training, pairs, None);
    let left = |hypothesis: &Hypothesis| {
        let response = model.response(&hypothesis.terms);
        &evidence.residual - search.predicted(hypothesis, evidence, &response)
    };
    let theme = |term: &Term| Theme::new(&model.candidates()[term.candidate]);
    let mut without: Vec<(Theme, DVector<f64>)> = Vec::new();
    for term in whole {
        let own = theme(term);
        if without.iter().all(|(known, _)| *known != own) {
            let others: Vec<Term> = whole.iter().filter(|term| theme(term) != own).cloned().collect();
            without.push((own, left(&search.fit(&others))));
        }
    }
    Trained {
        before: left(&search.fit(&[])),
        after: averaged(&forms(&search, &hypothesis), left),
        with: if whole.is_empty() { DVector::zeros(0) } else { left(&search.fit(whole)) },
        terms: hypothesis.terms,
        without,
    }
}

/// A hypothesis and those with another form of one of its laws that these data hardly distinguish from it.
fn forms(search: &Search, hypothesis: &Hypothesis) -> Vec<Hypothesis> {
    let mut forms = vec![hypothesis.clone()];
    for (position, term) in hypothesis.terms.iter().enumerate() {
        let others = search.other_forms(term.candidate);
        if others.is_empty() {
            continue;
        }
        let rest = search.without(hypothesis, position);
        let other = others.into_iter().map(|form| search.with(&rest, form));
        forms.extend(other.filter(|other| other.log_probability > hypothesis.log_probability - APART.ln()));
    }
    forms
}

/// What hypotheses leave on average, each by its probability.
fn averaged(hypotheses: &[Hypothesis], left: impl Fn(&Hypothesis) -> DVector<f64>) -> DVector<f64> {
    let most = hypotheses.iter().map(|of| of.log_probability).fold(f64::NEG_INFINITY, f64::max);
    let share = |of: &Hypothesis| (of.log_probability - most).exp();
    let total: f64 = hypotheses.iter().map(share).sum();
    let weighted = hypotheses.iter().map(|of| left(of) * (share(of) / total));
    weighted.reduce(|sum, more| sum + more).unwrap_or_default()
}

/// Selects without each fold in turn, and predicts it; `whole` are the terms that all data support.
/// `None` with fewer than two folds. Data that hardly count for the fit hardly count here.
pub fn hold_out(model: &Linearised<'_>, evidence: &Evidence, whole: &[Term]) -> Option<HeldOut> {
    let mut folds: Vec<usize> = evidence.fold.clone();
    folds.sort_unstable();
    folds.dedup();
    folds.retain(|&fold| fold != Evidence::NONE);
    if folds.len() < 2 {
        return None;
    }
    let n = evidence.residual.len();
    let by_fold = in_parallel(folds.len(), |k| {
        let (held_out, kept): (Vec<usize>, Vec<usize>) =
            (0..n).partition(|&row| evidence.fold[row] == folds[k]);
        let trained = trained_on(model, evidence, &kept, folds[k], whole);
        (held_out, trained)
    });
    let (mut errors_before, mut errors_after) = (DVector::repeat(n, f64::NAN), DVector::repeat(n, f64::NAN));
    let (mut squares, mut hypotheses) = (Vec::<Squares>::new(), Vec::new());
    let mut losses: Vec<(Theme, f64)> = Vec::new();
    let square = |errors: &DVector<f64>, rows: &[usize]| -> f64 {
        rows.iter().map(|&row| evidence.weight[row] * errors[row].powi(2)).sum()
    };
    for (held_out, trained) in by_fold {
        let count: f64 = held_out.iter().map(|&row| evidence.weight[row]).sum();
        let (before, after) = (square(&trained.before, &held_out), square(&trained.after, &held_out));
        squares.push((before, after, count));
        for (theme, left) in trained.without {
            losses.push((theme, square(&left, &held_out) - square(&trained.with, &held_out)));
        }
        hypotheses.push(trained.terms);
        for &row in &held_out {
            (errors_before[row], errors_after[row]) = (trained.before[row], trained.after[row]);
        }
    }
    let total = |of_fold: &dyn Fn(&Squares) -> f64| squares.iter().map(of_fold).sum::<f64>();
    let (all_before, all_after, count) = (total(&|s| s.0), total(&|s| s.1), total(&|s| s.2));
    let per_square = 1.0 / all_before.max(f64::MIN_POSITIVE);
    losses.iter_mut().for_each(|(_, loss)| *loss *= per_square);
    Some(HeldOut {
        before: (all_before / count).sqrt(),
        after: (all_after / count).sqrt(),
        gain: 1.0 - all_after * per_square,
        gain_interval: (squares.len() > 2).then(|| interval(&squares)).flatten(),
        hypotheses,
        losses,
        errors_before,
        errors_after,
    })
}

fn interval(squares: &[Squares]) -> Option<(f64, f64)> {
    let mut random = Random::seeded(0, 0);
    let mut gains: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let (mut before, mut after) = (0.0, 0.0);
            for _ in squares {
                let (b, a, _) = squares[random.index(squares.len())];
                before += b;
                after += a;
            }
            1.0 - after / before.max(f64::MIN_POSITIVE)
        })
        .collect();
    percentile_interval(&mut gains, 0.95)
}
