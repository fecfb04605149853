//! The diagnosis: is there a mismatch, what is it, what could it be as well, and what remains.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::DVector;

use super::background::{self, Folded};
use super::effect::Reported;
use super::evidence::rms;
use super::held_out::{Theme, hold_out};
use super::linearised::Linearised;
use super::locate::{Structure, along, locate};
use super::parts::{coverage_factor_of, estimates, explained, part};
use super::pruning::{infer, settled};
use super::scatter::{NoiseTest, Suspect, Tails};
use super::search::Search;
use super::selection::{DiscrepancyModel, NAMED, Pairs};
use super::sessions::leave_one_session_out;
use super::{
    Covariate, Diagnosis, Discrepancy, Evidence, Finding, FindingPart, ForwardModel, HeldOut, Hypothesis,
    Kind, ShownBy, Term,
};
use crate::statistics::{chi_squared_survival, student_t_quantile};

/// So many times what a recording may scatter it may, where repeats show that it does.
const SHOWN_BY_REPEATS: f64 = 3.0;
/// Zeros that scatter so many times as far as readings are something of their own.
pub(crate) const ZEROS_APART: f64 = 4.0;
/// Ln odds from which on it is said what the nominal numbers explain.
const WORTH_SAYING: f64 = 3.0;

/// Diagnoses a recording.
///
/// A stated noise that the best hypothesis contradicts tells no shape from chance: what is left is
/// searched again with the scatter that it has, and said to be more than was stated.
pub fn diagnose(model: &dyn ForwardModel, evidence: &Evidence) -> Diagnosis {
    let diagnosis = diagnose_with(model, evidence);
    let Some(stated) = evidence.stated_noise.filter(|_| diagnosis.noise_test.is_contradicted()) else {
        return diagnosis;
    };
    let mut diagnosis = diagnose_with(model, &Evidence { stated_noise: None, ..evidence.clone() });
    let degrees_of_freedom = evidence.residual.len() as f64 - diagnosis.taken;
    diagnosis.noise_test = noise_test(Some(stated), diagnosis.noise, degrees_of_freedom.max(1.0));
    if diagnosis.discrepancy.is_none() && diagnosis.noise_test.is_contradicted() {
        let (rms, shape) = (rms(&diagnosis.after), diagnosis.after.clone());
        let shown_by = ShownBy::StatedNoise;
        diagnosis.discrepancy = Some(Discrepancy { candidate: None, location: None, shown_by, rms, shape });
    }
    diagnosis
}

fn diagnose_with(model: &dyn ForwardModel, evidence: &Evidence) -> Diagnosis {
    let model = &Linearised::new(model);
    let folded = background::folded(evidence);
    let (settled, known) = settled(model, &folded.evidence);
    let evidence = &settled;
    let model = &model.in_parts(evidence, &evidence.fold);
    let (search, hypothesis, left_over) = infer(model, evidence, Pairs::Screened, known);
    let held_out = hold_out(model, evidence, &hypothesis.terms);
    let (hypothesis, left_over) =
        confirmed(model, &search, &folded, hypothesis, left_over, held_out.as_ref());
    let (hypothesis, left_over) = apart_from_nothing(model, &search, hypothesis, left_over);
    let none = search.fit(&[]);
    let by_base = search.predicted(&none, evidence, &DVector::zeros(evidence.residual.len()));
    let predicted = search.predicted(&hypothesis, evidence, &model.response(&hypothesis.terms));
    let (before, after) = (&evidence.residual - &by_base, &evidence.residual - &predicted);
    let mut parts: Vec<(Theme, FindingPart)> = (0..hypothesis.terms.len())
        .map(|position| {
            let candidate = &model.candidates()[hypothesis.terms[position].candidate];
            (Theme::new(candidate), part(model, &search, &hypothesis, position, beside(&left_over)))
        })
        .collect();
    parts.sort_by(|(_, a), (_, b)| b.explains.total_cmp(&a.explains));
    let findings = findings(model, &search, &hypothesis, held_out.as_ref(), rms(&before), parts);
    let lack_of_fit_after = search.lack_of_fit(&hypothesis, &predicted);
    let mut longest = &hypothesis;
    let mut discrepancy = None;
    if let Some(DiscrepancyModel::Curve(longer)) = &left_over {
        longest = longer;
        // what the calibration would take up of the curve is not left
        let response = model.response(&longer.terms);
        let shape = search.predicted(longer, evidence, &response) - &predicted;
        let curve = longer.terms.last();
        discrepancy = Some(Discrepancy {
            candidate: curve.map(|curve| curve.candidate),
            location: curve.map(|curve| model.location(curve)),
            shown_by: ShownBy::Curve,
            rms: rms(&shape),
            shape,
        });
    } else if let Some(DiscrepancyModel::Replicates) = left_over {
        let (rms, shape) = (rms(&after), after.clone());
        let shown_by = ShownBy::Repeats;
        discrepancy = Some(Discrepancy { candidate: None, location: None, shown_by, rms, shape });
    }
    let left = &evidence.residual - search.predicted(longest, evidence, &model.response(&longest.terms));
    let degrees_of_freedom = (search.degrees_of_freedom() as f64 - longest.determined).max(1.0);
    let weighted: f64 = left.iter().zip(&evidence.weight).map(|(r, w)| w * r * r).sum();
    let noise = (weighted / degrees_of_freedom).sqrt();
    let residual = search.plain_residual(longest);
    let suspects = match evidence.is_robust {
        true => Tails::of(&residual, evidence.rounding()).suspects(&residual),
        false => Vec::new(),
    };
    let noise_test = noise_test(evidence.stated_noise, longest.sigma, degrees_of_freedom);
    let is_contradicted = noise_test.is_contradicted();
    // repeats that scatter as much show that it is scatter, up to a point
    let times = if lack_of_fit_after.is_some() { SHOWN_BY_REPEATS } else { 1.0 };
    // zeros that were not taken scatter as far as they like: readings within a run do not
    let ratio = search.shared_ratio();
    let own = if ratio > ZEROS_APART * ZEROS_APART { noise / (1.0 + ratio).sqrt() } else { noise };
    let is_too_much = evidence.most_scatter.is_some_and(|most| own > times * most);
    if discrepancy.is_none() && (is_contradicted || is_too_much) {
        let (rms, shape) = (rms(&after), after.clone());
        let shown_by = if is_contradicted { ShownBy::StatedNoise } else { ShownBy::Size };
        discrepancy = Some(Discrepancy { candidate: None, location: None, shown_by, rms, shape });
    }
    // many that are far off are no single ones
    if discrepancy.is_none()
        && (suspects.len() > suspects_at_most(evidence.recorded) || are_together(evidence, &suspects))
    {
        let (rms, shape) = (rms(&after), after.clone());
        let shown_by = ShownBy::Suspects;
        discrepancy = Some(Discrepancy { candidate: None, location: None, shown_by, rms, shape });
    }
    if discrepancy.is_none() && folded.is_implausible(longest) {
        let shape = folded.response(longest);
        let (rms, shown_by) = (rms(&shape), ShownBy::Numbers);
        discrepancy = Some(Discrepancy { candidate: None, location: None, shown_by, rms, shape });
    }
    let coverage_factor = student_t_quantile(0.975, degrees_of_freedom).unwrap_or(1.96);
    let worth = longest.background_worth();
    let nominal = match worth > WORTH_SAYING {
        true => folded.estimates(longest, coverage_factor),
        false => Vec::new(),
    };
    Diagnosis {
        findings,
        discrepancy,
        noise,
        noise_test,
        suspects,
        nominal_factors: folded.factors(longest),
        nominal,
        shared_ratio: search.shared_ratio(),
        lack_of_fit_before: search.lack_of_fit(&none, &by_base),
        lack_of_fit_after,
        structure_before: locate(evidence, &before),
        structure_after: locate(evidence, &after),
        structure_given_others: given_others(model, &search, evidence, &hypothesis),
        odds: search.additions(&none).to_vec(),
        held_out,
        sessions: match hypothesis.terms.is_empty() {
            true => Vec::new(),
            false => leave_one_session_out(model, evidence),
        },
        recorded: evidence.recorded,
        taken: evidence.residual.len() as f64 - degrees_of_freedom,
        before,
        after,
        settled: (Arc::new(evidence.clone()), longest.sigma),
        hypothesis,
    }
}

/// True where neighbours of a run are far off to one side: so many that they are no single ones, or
/// the run as a whole.
fn are_together(evidence: &Evidence, suspects: &[Suspect]) -> bool {
    const TOGETHER: usize = 3;
    let side: BTreeMap<usize, bool> = suspects.iter().map(|s| (s.datum, s.sigma > 0.0)).collect();
    let mut runs: BTreeMap<usize, Vec<Option<bool>>> = BTreeMap::new();
    for (datum, &run) in evidence.shared.iter().enumerate().take(evidence.recorded) {
        runs.entry(run).or_default().push(side.get(&datum).copied());
    }
    runs.values().any(|run| {
        let mut of_one_side = run.chunk_by(|a, b| a == b).filter(|part| part[0].is_some());
        of_one_side.any(|part| part.len() >= TOGETHER || (part.len() > 1 && part.len() == run.len()))
    })
}

/// Of so many data that many may be far off by themselves: a tenth, three at least.
fn suspects_at_most(count: usize) -> usize {
    (count / 10).max(3)
}

/// A hypothesis without physics that held-out data do not confirm: where they are predicted no
/// worse without it, nor without it and another one that it undoes, it has no name. What happened
/// once says nothing of other data. Nor do they speak against an effect in whose place the numbers
/// of the file would be as far off as they cannot be: these predict as well as it does.
///
/// Where a curve would then be left that is less likely than what it takes the place of, by the
/// odds of a name, the names stay: something is there, and this is likelier.
///
/// Nor has a name what most searches without a fold do not find again, where these predict no
/// better than nothing: something is there, and not the same to all of them.
fn confirmed(
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
    let takes_numbers_place = |own: Theme| {
        let is_other = |term: &&Term| Theme::new(&model.candidates()[term.candidate]) != own;
        let others: Vec<Term> = hypothesis.terms.iter().filter(is_other).cloned().collect();
        folded.is_implausible(&search.fit(&others)) && !folded.is_implausible(&hypothesis)
    };
    let is_confirmed = |term: &Term| {
        let candidate = &model.candidates()[term.candidate];
        let own = Theme::new(candidate);
        let is_needed =
            held_out.independent_loss(own) > 0.0 && !needless.iter().any(|themes| themes.contains(&own));
        candidate.effect.kind == Kind::Event || is_needed || takes_numbers_place(own)
    };
    let is_found_again = |term: &Term| {
        let candidate = &model.candidates()[term.candidate];
        let found = held_out.found(model.candidates(), Theme::new(candidate));
        is_reproduced(candidate.effect.kind, held_out.gain, found)
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

/// True of what happened once, of what predicts held-out data, and of what more than half of the
/// searches without a fold find again.
fn is_reproduced(kind: Kind, gain: f64, (found, of): (usize, usize)) -> bool {
    kind != Kind::Physics || gain > 0.0 || 2 * found > of
}

/// A hypothesis without effects of which, with all else that may be there, nothing is as good an
/// estimate as any other: the curve beside it may be as well, or zeros that differ from run to run.
fn apart_from_nothing(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: Hypothesis,
    left_over: Option<DiscrepancyModel>,
) -> (Hypothesis, Option<DiscrepancyModel>) {
    let beside = beside(&left_over);
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

/// What each covariate shows of the findings that are seen along it, beside all others.
fn given_others(
    model: &Linearised<'_>,
    search: &Search,
    evidence: &Evidence,
    hypothesis: &Hypothesis,
) -> Vec<Option<Structure>> {
    let of_index = |(index, covariate): (usize, &Covariate)| {
        let is_other = |term: &&Term| {
            let effect = model.candidates()[term.candidate].effect;
            !(effect.seen_along)(&model.location(term)).contains(&covariate.variable)
        };
        let others: Vec<Term> = hypothesis.terms.iter().filter(is_other).cloned().collect();
        if others.is_empty() || others.len() == hypothesis.terms.len() {
            return None;
        }
        let rest = search.fit(&others);
        let left = &evidence.residual - search.predicted(&rest, evidence, &model.response(&rest.terms));
        Some(along(covariate, &left, index as u64))
    };
    evidence.covariates.iter().enumerate().map(of_index).collect()
}

/// χ² of what is left against the noise that was stated.
fn noise_test(stated: Option<f64>, estimated: f64, degrees_of_freedom: f64) -> NoiseTest {
    let p_value = stated.and_then(|stated| {
        let square = degrees_of_freedom * (estimated / stated).powi(2);
        chi_squared_survival(square, degrees_of_freedom).ok()
    });
    NoiseTest { stated, estimated, p_value }
}

/// Parts as they are reported, the strongest first: the waves of one gear, what one knock did to
/// each channel, all misread poses, are one finding. `base` is the root mean square that the base
/// model leaves.
fn findings(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    held_out: Option<&HeldOut>,
    base: f64,
    parts: Vec<(Theme, FindingPart)>,
) -> Vec<Finding> {
    let mut findings: Vec<(Theme, Finding)> = Vec::new();
    for (theme, part) in parts {
        let effect = model.candidates()[part.term.candidate].effect;
        let location = part.location.place();
        let is_same = |(_, known): &&mut (Theme, Finding)| {
            known.effect == effect
                && match effect.reported {
                    Reported::Alone => false,
                    Reported::ByPlace => known.location == location,
                    Reported::ByRow => known.location.is_after_row_of(&location),
                    Reported::Together => true,
                }
        };
        match findings.iter_mut().find(is_same) {
            Some((_, known)) => {
                if effect.reported == Reported::Together {
                    known.location = known.location.clone().and(location);
                }
                known.p_value = known.p_value.min(part.p_value);
                known.parts.push(part);
            }
            None => {
                findings.push((theme, Finding::from_part(effect, location, Vec::new(), part)));
            }
        }
    }
    for (theme, finding) in &mut findings {
        finding.explains = match &finding.parts[..] {
            [part] => part.explains,
            parts => {
                let is_other = |term: &&Term| !parts.iter().any(|part| part.term.candidate == term.candidate);
                let others: Vec<Term> = hypothesis.terms.iter().filter(is_other).cloned().collect();
                explained(search, &search.fit(&others), hypothesis)
            }
        };
        finding.estimates = model.estimates(&finding.parts, hypothesis);
        finding.rivals = finding.parts.iter().flat_map(|part| part.rivals.clone()).collect();
        finding.rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
        finding.found_in_folds = held_out.map(|held_out| held_out.found(model.candidates(), *theme));
        finding.held_out_loss = held_out.map(|held_out| held_out.loss(*theme));
        finding.description = model.describe(finding);
    }
    let mut findings: Vec<Finding> = findings.into_iter().map(|(_, finding)| finding).collect();
    // by what held-out data lose without it; of what happened once they know nothing
    let strength = |finding: &Finding| {
        let explained = (finding.explains / base.max(f64::MIN_POSITIVE)).powi(2);
        match finding.kind() {
            Kind::Event => explained,
            Kind::Physics | Kind::Mistake => finding.held_out_loss.unwrap_or(explained),
        }
    };
    // a mistake is undone before anything else is believed
    let is_physics = |finding: &Finding| finding.kind() != Kind::Mistake;
    findings.sort_by(|a, b| is_physics(a).cmp(&is_physics(b)).then(strength(b).total_cmp(&strength(a))));
    findings
}

/// The hypothesis with what it leaves unexplained beside it.
fn beside(left_over: &Option<DiscrepancyModel>) -> Option<&Hypothesis> {
    match left_over {
        Some(DiscrepancyModel::Curve(longer)) => Some(longer),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_neither_predicts_nor_comes_back_has_no_name() {
        assert!(!is_reproduced(Kind::Physics, -0.1, (2, 4)));
        assert!(is_reproduced(Kind::Physics, -0.1, (3, 4)));
        assert!(is_reproduced(Kind::Physics, 0.01, (0, 4)));
        assert!(is_reproduced(Kind::Event, -0.1, (0, 4)) && is_reproduced(Kind::Mistake, -0.1, (0, 4)));
    }
}
