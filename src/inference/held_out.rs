//! Held-out proof: the whole selection is repeated without a fold, and its hypothesis predicts that
//! fold.
//!
//! What a theme (an effect; in joints, at those joints) is worth is found in the same folds: the
//! hypothesis of all data is fitted to the others with and without it, and predicts the fold.

pub(in crate::inference) mod compared;
pub(in crate::inference) mod confirmed;
pub(in crate::inference) mod sessions;

use nalgebra::DVector;

use crate::inference::columns::background::folded;
use crate::inference::columns::linearised::Linearised;
use crate::inference::noise::whitening::Whitening;
use crate::inference::score::priors::APART;
use crate::inference::search::Search;
use crate::inference::search::pruning::infer;
use crate::inference::search::selection::{DiscrepancyModel, Pairs};
use crate::inference::{Candidate, Effect, Evidence, ForwardModel, Hypothesis, Kind, Term};
use crate::parallel::in_parallel;
use crate::statistics::{Random, percentile_interval};

/// Squares of a fold before and after, and how many data they are of.
type Squares = (f64, f64, f64);

/// Draws of the bootstrap over folds.
const DRAWS: usize = 1000;

/// Errors of data that the model had not seen.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct HeldOut {
    /// Root mean square of what the base model leaves of held-out data.
    pub before: f64,
    /// And of what the hypothesis found without them leaves.
    pub after: f64,
    /// Share of the squares that vanishes, 1 − after²/before².
    pub gain: f64,
    /// 95 % interval of `gain`, from folds that are drawn again; `None` with fewer than three
    /// folds.
    pub gain_interval: Option<(f64, f64)>,
    /// Hypotheses of the folds.
    pub hypotheses: Vec<Vec<Term>>,
    /// What themes of all data are worth in each fold.
    losses: Vec<(Vec<Theme>, Loss)>,
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
        Theme { effect: candidate.effect, joints: candidate.location.joints() }
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
        self.losses.iter().filter(|(themes, _)| *themes == [theme]).map(|(_, loss)| loss.plain).sum()
    }

    /// The same of errors that are independent, (e'ᵀΣ⁻¹e' − eᵀΣ⁻¹e)/e₀ᵀΣ⁻¹e₀. The zero of a
    /// held-out run is as unknown with an effect as without it; squares of errors that have it in
    /// them would be its lottery.
    pub fn independent_loss(&self, theme: Theme) -> f64 {
        self.independent_loss_of(&[theme])
    }

    /// The same without two of them, or without all that are physics.
    pub fn losses_together(&self) -> impl Iterator<Item = (&[Theme], f64)> {
        let mut together: Vec<&[Theme]> = Vec::new();
        for (themes, _) in self.losses.iter().filter(|(themes, _)| themes.len() > 1) {
            if !together.contains(&&themes[..]) {
                together.push(themes);
            }
        }
        together.into_iter().map(|themes| (themes, self.independent_loss_of(themes)))
    }

    fn independent_loss_of(&self, themes: &[Theme]) -> f64 {
        self.losses.iter().filter(|(known, _)| known == themes).map(|(_, loss)| loss.independent).sum()
    }
}

/// Squares of errors that come back without some themes, as shares of those before.
#[derive(Debug, Clone, Copy)]
struct Loss {
    plain: f64,
    /// Of errors freed of what data share.
    independent: f64,
}

/// What some of the data, `kept`, say of all data.
pub(super) struct Trained {
    /// What the base model, fitted to them, leaves of all data.
    pub before: DVector<f64>,
    /// And what the hypothesis that they support by themselves leaves, forms of its laws averaged.
    pub after: DVector<f64>,
    /// Terms of that hypothesis.
    pub terms: Vec<Term>,
    /// What a given hypothesis leaves, fitted to them, and what it leaves without each of its
    /// themes, each two that are physics, and all of these: two that undo each other are worth much
    /// to each other and nothing together.
    pub with: DVector<f64>,
    /// Themes that were left out of the given hypothesis, and what it leaves then (one per datum).
    pub without: Vec<(Vec<Theme>, DVector<f64>)>,
}

/// Selects with the data `kept` only, which are all but those of the part `left_out` of the model;
/// `whole` are the terms that all data support.
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
    let without = left_out_together(whole.iter().map(theme)).into_iter().map(|themes| {
        let others: Vec<Term> = whole.iter().filter(|term| !themes.contains(&theme(term))).cloned().collect();
        let residual = left(&search.fit(&others));
        (themes, residual)
    });
    let without = without.collect();
    Trained {
        before: left(&search.fit(&[])),
        after: averaged(&forms(&search, &hypothesis), left),
        with: if whole.is_empty() { DVector::zeros(0) } else { left(&search.fit(whole)) },
        terms: hypothesis.terms,
        without,
    }
}

/// Each theme by itself, each two that are physics, and all that are.
fn left_out_together(themes: impl Iterator<Item = Theme>) -> Vec<Vec<Theme>> {
    let mut singles: Vec<Theme> = Vec::new();
    for theme in themes {
        if !singles.contains(&theme) {
            singles.push(theme);
        }
    }
    let physics: Vec<Theme> = singles.iter().copied().filter(|t| t.effect.kind != Kind::Event).collect();
    let mut sets: Vec<Vec<Theme>> = singles.into_iter().map(|theme| vec![theme]).collect();
    for (k, &first) in physics.iter().enumerate() {
        sets.extend(physics[k + 1..].iter().map(|&second| vec![first, second]));
    }
    if physics.len() > 2 {
        sets.push(physics);
    }
    sets
}

/// A hypothesis and those with another form of one of its laws that these data hardly distinguish
/// from it.
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
    let most = hypotheses.iter().map(|own| own.log_probability).fold(f64::NEG_INFINITY, f64::max);
    // the likeliest counts whole, however unlikely it is
    let share = |own: &Hypothesis| match own.log_probability == most {
        true => 1.0,
        false => (own.log_probability - most).exp(),
    };
    let total: f64 = hypotheses.iter().map(share).sum();
    let weighted = hypotheses.iter().map(|own| left(own) * (share(own) / total));
    weighted.reduce(|sum, more| sum + more).unwrap_or_default()
}

/// Selects without each fold in turn, and predicts it; `whole` are the terms that all data support.
/// `None` with fewer than two folds. Data that hardly count for the fit hardly count here.
pub fn hold_out(model: &Linearised<'_>, evidence: &Evidence, whole: &[Term]) -> Option<HeldOut> {
    let folds = evidence.folds();
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
    let mut losses: Vec<(Vec<Theme>, Loss)> = Vec::new();
    let square = |errors: &DVector<f64>, rows: &[usize]| -> f64 {
        rows.iter().map(|&row| evidence.weight[row] * errors[row].powi(2)).sum()
    };
    let mut independent_before = 0.0;
    for (held_out, trained) in by_fold {
        let part = evidence.part(&held_out);
        let whitening = Whitening::new(&part, &part.residual);
        // what a run's zero is says nothing for or against an effect
        let independent =
            |errors: &DVector<f64>| whitening.whitened(&errors.select_rows(&held_out)).norm_squared();
        independent_before += independent(&trained.before);
        let count: f64 = held_out.iter().map(|&row| evidence.weight[row]).sum();
        let (before, after) = (square(&trained.before, &held_out), square(&trained.after, &held_out));
        squares.push((before, after, count));
        for (themes, left) in trained.without {
            let plain = square(&left, &held_out) - square(&trained.with, &held_out);
            let independent = independent(&left) - independent(&trained.with);
            losses.push((themes, Loss { plain, independent }));
        }
        hypotheses.push(trained.terms);
        for &row in &held_out {
            (errors_before[row], errors_after[row]) = (trained.before[row], trained.after[row]);
        }
    }
    let total = |of_fold: &dyn Fn(&Squares) -> f64| squares.iter().map(of_fold).sum::<f64>();
    let (all_before, all_after, count) = (total(&|s| s.0), total(&|s| s.1), total(&|s| s.2));
    let per_square = 1.0 / all_before.max(f64::MIN_POSITIVE);
    let per_independent = 1.0 / independent_before.max(f64::MIN_POSITIVE);
    for (_, loss) in &mut losses {
        loss.plain *= per_square;
        loss.independent *= per_independent;
    }
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

/// Squares of all held-out data that given terms leave, fitted without them, or else what is found
/// without them, with the curve that has no name; `None` with fewer than two folds.
pub(crate) fn held_out_square(
    model: &dyn ForwardModel,
    evidence: &Evidence,
    terms: Option<&[Term]>,
) -> Option<f64> {
    let evidence = &folded(&Evidence { stated_noise: None, ..evidence.clone() }).evidence;
    let folds = evidence.folds();
    if folds.len() < 2 {
        return None;
    }
    let model = &Linearised::new(model).in_parts(evidence, &evidence.fold);
    let of_fold = in_parallel(folds.len(), |k| {
        let (held_out, kept): (Vec<usize>, Vec<usize>) =
            (0..evidence.residual.len()).partition(|&row| evidence.fold[row] == folds[k]);
        let (part, training) = (model.part(&kept, folds[k]), evidence.part(&kept));
        let (search, fitted) = match terms {
            Some(terms) => {
                let search = Search::new(&part, &training, terms);
                let fitted = search.fit(terms);
                (search, fitted)
            }
            None => {
                let (search, named, left_over) = infer(&part, &training, Pairs::LeftOut, None);
                let whole = left_over.as_ref().and_then(DiscrepancyModel::curve).cloned();
                (search, whole.unwrap_or(named))
            }
        };
        let left = &evidence.residual - search.predicted(&fitted, evidence, &model.response(&fitted.terms));
        held_out.iter().map(|&row| left[row].powi(2)).sum::<f64>()
    });
    Some(of_fold.iter().sum())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::UNKNOWN;

    #[test]
    fn what_may_undo_each_other_is_left_out_together() {
        let of_effect = |effect: &'static str, kind| {
            let effect = Box::leak(Box::new(Effect { name: effect, kind, ..UNKNOWN }));
            Theme { effect, joints: None }
        };
        let (a, b, c) =
            (of_effect("a", Kind::Physics), of_effect("b", Kind::Physics), of_effect("c", Kind::Physics));
        let event = of_effect("event", Kind::Event);
        let sets = left_out_together([a, event, b, a].into_iter());
        assert_eq!(sets, [vec![a], vec![event], vec![b], vec![a, b]]);
        let sets = left_out_together([a, b, c].into_iter());
        let expected = [vec![a], vec![b], vec![c], vec![a, b], vec![a, c], vec![b, c], vec![a, b, c]];
        assert_eq!(sets, expected);
    }

    #[test]
    fn what_two_are_worth_is_summed_over_the_folds() {
        let theme_of = |effect: &'static str| Theme {
            effect: Box::leak(Box::new(Effect { name: effect, ..UNKNOWN })),
            joints: None,
        };
        let (a, b) = (theme_of("a"), theme_of("b"));
        let of_share = |share: f64| Loss { plain: 2.0 * share, independent: share };
        let losses = vec![
            (vec![a], of_share(0.5)),
            (vec![a, b], of_share(0.1)),
            (vec![a], of_share(0.2)),
            (vec![a, b], of_share(-0.3)),
        ];
        let held_out = HeldOut {
            before: 1.0,
            after: 1.0,
            gain: 0.0,
            gain_interval: None,
            hypotheses: Vec::new(),
            losses,
            errors_before: DVector::zeros(0),
            errors_after: DVector::zeros(0),
        };
        // each seems worth a name, both together are worth less than nothing
        assert!((held_out.independent_loss(a) - 0.7).abs() < 1e-12);
        assert!((held_out.loss(a) - 1.4).abs() < 1e-12);
        let together: Vec<(&[Theme], f64)> = held_out.losses_together().collect();
        assert!(together.len() == 1 && together[0].0 == [a, b] && (together[0].1 + 0.2).abs() < 1e-12);
    }
}
