//! Which terms keep their names once held-out data have spoken, and once all that may stand beside
//! them has.

use nalgebra::DVector;

use crate::inference::columns::background::Folded;
use crate::inference::columns::linearised::Linearised;
use crate::inference::held_out::Theme;
use crate::inference::score::priors::{APART, NAMED};
use crate::inference::search::Search;
use crate::inference::search::parts::{coverage_factor_of, estimates};
use crate::inference::search::selection::DiscrepancyModel;
use crate::inference::{FindingPart, ForwardModel, HeldOut, Hypothesis, Kind, Rival, Term};

/// A hypothesis without physics that held-out data do not confirm: where they are predicted no
/// worse without it, nor without it and another one that it undoes, it has no name. What happened
/// once says nothing of other data, nor does a mistake that was made in one fold alone. Nor do they
/// speak against an effect in whose place the numbers
/// of the file would be as far off as they cannot be: these predict as well as it does.
///
/// Nor has a name what fits the data no better than the numbers of the file do in its place, where
/// these may be so far off: that a file states its numbers twice too well is as likely.
///
/// Where a curve would then be left that is less likely than what it takes the place of, by the
/// odds of a name, the names stay: something is there, and this is likelier.
///
/// Nor has a name what most searches without a fold do not find again, where these predict no
/// better than nothing: something is there, and not the same to all of them. Beside something that
/// has no name it is none even where they find it again: it may be a part of that.
pub fn confirmed(
    model: &Linearised<'_>,
    search: &Search,
    folded: &Folded,
    hypothesis: Hypothesis,
    before_that: Option<DiscrepancyModel>,
    held_out: Option<&HeldOut>,
) -> (Hypothesis, Option<DiscrepancyModel>) {
    let Some(held_out) = held_out else { return (hypothesis, before_that) };
    let needless: Vec<&[Theme]> =
        held_out.losses_together().filter(|(_, loss)| *loss <= 0.0).map(|(themes, _)| themes).collect();
    let without = |whole: &Hypothesis, own: Theme| {
        let is_other = |term: &&Term| Theme::new(&model.candidates()[term.candidate]) != own;
        search.fit(&whole.terms.iter().filter(is_other).cloned().collect::<Vec<_>>())
    };
    // what a curve draws is not the numbers' to explain
    let whole = before_that.as_ref().and_then(DiscrepancyModel::curve).unwrap_or(&hypothesis);
    let takes_place =
        |own: Theme| !folded.is_implausible(whole) && folded.is_implausible(&without(whole, own));
    // ln of the likelihoods' ratio: what the data themselves say for a name
    let fits_no_better = |others: &Hypothesis| {
        let [more, less] = [others, &hypothesis].map(|own| search.left_square(own));
        (more - less) / (2.0 * hypothesis.sigma.powi(2)) < NAMED.ln() && !folded.is_implausible(others)
    };
    let is_confirmed = |term: &Term| {
        let candidate = &model.candidates()[term.candidate];
        let own = Theme::new(candidate);
        let is_needed =
            held_out.independent_loss(own) > 0.0 && !needless.iter().any(|themes| themes.contains(&own));
        let happened_once = match candidate.effect.kind {
            Kind::Event => true,
            Kind::Mistake => {
                is_of_one_fold(&model.response(std::slice::from_ref(term)), &folded.evidence.fold)
            }
            Kind::Physics => false,
        };
        happened_once || { (is_needed && !fits_no_better(&without(&hypothesis, own))) || takes_place(own) }
    };
    let is_found_again = |term: &Term| {
        let candidate = &model.candidates()[term.candidate];
        let found = held_out.found(model.candidates(), Theme::new(candidate));
        is_reproduced(candidate.effect.kind, held_out.gain, found, before_that.is_some())
    };
    let again: Vec<Term> = hypothesis.terms.iter().filter(|term| is_found_again(term)).cloned().collect();
    if again.len() < hypothesis.terms.len() {
        let shorter = search.fit(&again);
        if let Some(left_over) = search.remains(&shorter) {
            return (shorter, Some(left_over));
        }
    }
    let kept: Vec<Term> = hypothesis.terms.iter().filter(|term| is_confirmed(term)).cloned().collect();
    if kept.len() == hypothesis.terms.len() {
        return (hypothesis, before_that);
    }
    let shorter = search.fit(&kept);
    let left_over = search.remains(&shorter);
    let is_likelier = |longer: &Hypothesis| hypothesis.log_probability > longer.log_probability + NAMED.ln();
    if let Some(DiscrepancyModel::Curve(longer)) = &left_over
        && before_that.is_none()
        && is_likelier(longer)
    {
        return (hypothesis, None);
    }
    (shorter, left_over)
}

/// True of what changes the data of one fold only.
fn is_of_one_fold(response: &DVector<f64>, fold: &[usize]) -> bool {
    let changed = response.iter().zip(fold).filter(|(change, _)| **change != 0.0);
    let mut folds: Vec<usize> = changed.map(|(_, fold)| *fold).collect();
    folds.dedup();
    folds.iter().all(|fold| *fold == folds[0])
}

/// True of what happened once, of what predicts held-out data, and, where nothing is left beside
/// it, of what more than half of the searches without a fold find again.
fn is_reproduced(kind: Kind, gain: f64, (found, searches): (usize, usize), is_beside: bool) -> bool {
    kind != Kind::Physics || gain > 0.0 || (!is_beside && 2 * found > searches)
}

/// A hypothesis without effects of which, with all else that may be there, nothing is as good an
/// estimate as any other: the curve beside it may be as well, or zeros that differ from run to run.
pub fn apart_from_nothing(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: Hypothesis,
    left_over: Option<DiscrepancyModel>,
) -> (Hypothesis, Option<DiscrepancyModel>) {
    let beside = left_over.as_ref().and_then(DiscrepancyModel::curve);
    let coverage_factor = coverage_factor_of(search, &hypothesis);
    let is_apart = |position: &usize| {
        let candidate = &model.candidates()[hypothesis.terms[*position].candidate];
        let estimates = estimates(model, search, &hypothesis, *position, beside, coverage_factor);
        let parameters = estimates.iter().zip(&candidate.parameters);
        let is_event_beside_curve = candidate.effect.kind == Kind::Event && beside.is_some();
        is_event_beside_curve
            || parameters.into_iter().any(|(own, p)| p.neutral < own.low || p.neutral > own.high)
    };
    let kept: Vec<usize> = (0..hypothesis.terms.len()).filter(is_apart).collect();
    let terms: Vec<Term> = kept.iter().map(|&position| hypothesis.terms[position].clone()).collect();
    if terms.len() == hypothesis.terms.len() {
        return (hypothesis, left_over);
    }
    let shorter = search.fit(&terms);
    // where nothing but the curve would be left, or nothing but the effect, it is better named than
    // not
    match (search.remains(&shorter), beside.is_some()) {
        (Some(rest), true) => (shorter, Some(rest)),
        (None, false) => (shorter, None),
        _ => (hypothesis, left_over),
    }
}

/// The name, if any, that stands beside a curve alone: without that another effect would explain so
/// much more in its place, or it would be no name, and with it another one does as well. It names
/// what the curve does not draw right, unless it is there in the place of numbers of the file.
pub fn outdone(
    model: &Linearised<'_>,
    search: &Search,
    parts: &[FindingPart],
    left_over: Option<&DiscrepancyModel>,
) -> Option<usize> {
    let whole = left_over.and_then(DiscrepancyModel::curve)?;
    let alone = search.additions(&search.fit(&[]));
    let effect = |part: &FindingPart| model.candidates()[part.term.candidate].effect;
    let is_better =
        |own: &FindingPart, rival: &Rival| rival.effect != effect(own) && rival.odds * APART < 1.0;
    let is_no_name_alone = |own: &FindingPart| {
        let is_sure = parts.len() > 1 || alone[own.term.candidate] >= NAMED.ln();
        !is_sure && own.rivals.iter().any(|rival| rival.effect != effect(own))
    };
    let is_outdone = |position: &usize| {
        let own = &parts[*position];
        let is_beaten = own.rivals.iter().any(|rival| is_better(own, rival)) || is_no_name_alone(own);
        effect(own).kind != Kind::Mistake && is_beaten && !search.takes_numbers_place(whole, *position)
    };
    (0..parts.len()).find(is_outdone)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_of_one_fold_changes_no_other() {
        let fold = [0, 0, 1, 1, 2];
        assert!(is_of_one_fold(&DVector::from_vec(vec![0.0, 0.0, 3.0, -1.0, 0.0]), &fold));
        assert!(!is_of_one_fold(&DVector::from_vec(vec![0.0, 1.0, 3.0, 0.0, 0.0]), &fold));
    }

    #[test]
    fn what_neither_predicts_nor_comes_back_has_no_name() {
        for is_beside in [false, true] {
            let is_reproduced = |kind, gain, found| is_reproduced(kind, gain, found, is_beside);
            assert!(!is_reproduced(Kind::Physics, -0.1, (2, 4)));
            assert_eq!(is_reproduced(Kind::Physics, -0.1, (3, 4)), !is_beside);
            assert!(is_reproduced(Kind::Physics, 0.01, (0, 4)));
            assert!(is_reproduced(Kind::Event, -0.1, (0, 4)) && is_reproduced(Kind::Mistake, -0.1, (0, 4)));
        }
    }
}
