//! The diagnosis: is there a mismatch, what is it, what could it be as well, and what remains.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::background;
use super::effect::Reported;
use super::evidence::rms;
use super::held_out::{Theme, hold_out};
use super::linearised::Linearised;
use super::locate::{Structure, along, locate};
use super::pruning::{infer, settled};
use super::scatter::{NoiseTest, Suspect, Tails};
use super::search::Search;
use super::selection::{DiscrepancyModel, Pairs};
use super::sessions::leave_one_session_out;
use super::{
    Covariate, Diagnosis, Discrepancy, Estimate, Evidence, Finding, FindingPart, ForwardModel, HeldOut,
    Hypothesis, Kind, Parameter, Rival, ShownBy, Term,
};
use crate::statistics::{chi_squared_survival, student_t_quantile};

/// Odds within which another explanation counts as indistinguishable: 20 to 1.
const APART: f64 = 20.0;

/// So many of the effects that may be there besides count for an interval.
const AVERAGED: usize = 8;

/// A form of a law that leaves at most so much more, as a factor, may be the right one.
const HARDLY_MORE: f64 = 1.1;

/// So many times what a recording may scatter it may, where repeats show that it does.
const SHOWN_BY_REPEATS: f64 = 3.0;
/// Ln odds from which on it is said what the nominal numbers explain.
const WORTH_SAYING: f64 = 3.0;

/// Diagnoses a recording.
///
/// A stated noise that the best hypothesis contradicts tells no shape from chance: what is left is searched again with the scatter
/// that it has, and said to be more than was stated.
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

/// The best hypothesis and what it leaves: neither confirmed by held-out data nor compared with its rivals.
pub fn sketch(model: &dyn ForwardModel, evidence: &Evidence) -> (Hypothesis, DVector<f64>) {
    let model = &Linearised::new(model);
    let folded = background::folded(&Evidence { stated_noise: None, ..evidence.clone() });
    let (settled, known) = settled(model, &folded.evidence);
    let model = &model.in_parts(&settled, &settled.fold);
    let (search, hypothesis, _) = infer(model, &settled, Pairs::Screened, known);
    let predicted = search.predicted(&hypothesis, &settled, &model.response(&hypothesis.terms));
    (hypothesis, &settled.residual - predicted)
}

fn diagnose_with(model: &dyn ForwardModel, evidence: &Evidence) -> Diagnosis {
    let model = &Linearised::new(model);
    let folded = background::folded(evidence);
    let (settled, known) = settled(model, &folded.evidence);
    let evidence = &settled;
    let model = &model.in_parts(evidence, &evidence.fold);
    let (search, hypothesis, left_over) = infer(model, evidence, Pairs::Screened, known);
    let held_out = hold_out(model, evidence, &hypothesis.terms);
    let (hypothesis, left_over) = confirmed(model, &search, hypothesis, left_over, held_out.as_ref());
    let (hypothesis, left_over) = apart_from_curve(model, &search, hypothesis, left_over);
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
        true => Tails::of(&residual).suspects(&residual),
        false => Vec::new(),
    };
    let noise_test = noise_test(evidence.stated_noise, longest.sigma, degrees_of_freedom);
    let is_contradicted = noise_test.is_contradicted();
    // repeats that scatter as much show that it is scatter, up to a point
    let times = if lack_of_fit_after.is_some() { SHOWN_BY_REPEATS } else { 1.0 };
    let is_too_much = evidence.most_scatter.is_some_and(|most| noise > times * most);
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
        hypothesis,
    }
}

/// True where neighbours of a run are far off to one side: so many that they are no single ones, or the run as a whole.
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

/// A hypothesis without physics that held-out data do not confirm: where they are predicted no worse
/// without it, it has no name. What happened once says nothing of other data.
fn confirmed(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: Hypothesis,
    left_over: Option<DiscrepancyModel>,
    held_out: Option<&HeldOut>,
) -> (Hypothesis, Option<DiscrepancyModel>) {
    let Some(held_out) = held_out else { return (hypothesis, left_over) };
    let is_confirmed = |term: &Term| {
        let candidate = &model.candidates()[term.candidate];
        candidate.effect.kind == Kind::Event || held_out.loss(Theme::new(candidate)) > 0.0
    };
    let kept: Vec<Term> = hypothesis.terms.iter().filter(|term| is_confirmed(term)).cloned().collect();
    if kept.len() == hypothesis.terms.len() {
        return (hypothesis, left_over);
    }
    let shorter = search.fit(&kept);
    let left_over = search.remains(&shorter);
    (shorter, left_over)
}

/// A hypothesis without physics that the curve beside it may be as well: where, with all else that may be there, nothing of
/// it is an estimate like any other.
fn apart_from_curve(
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
        candidate.effect.kind == Kind::Event
            || parameters.into_iter().any(|(own, p)| p.neutral < own.low || p.neutral > own.high)
    };
    if beside.is_none() {
        return (hypothesis, left_over);
    }
    let kept: Vec<usize> = (0..hypothesis.terms.len()).filter(is_apart).collect();
    let terms: Vec<Term> = kept.iter().map(|&position| hypothesis.terms[position].clone()).collect();
    if terms.len() == hypothesis.terms.len() {
        return (hypothesis, left_over);
    }
    let shorter = search.fit(&terms);
    // where nothing would be left to be explained it is better named than not
    match search.remains(&shorter) {
        Some(rest) => (shorter, Some(rest)),
        None => (hypothesis, left_over),
    }
}

/// What each covariate shows of the findings that are seen along it, beside all others.
fn given_others(
    model: &Linearised<'_>,
    search: &Search,
    evidence: &Evidence,
    hypothesis: &Hypothesis,
) -> Vec<Option<Structure>> {
    let of = |(index, covariate): (usize, &Covariate)| {
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
    evidence.covariates.iter().enumerate().map(of).collect()
}

/// χ² of what is left against the noise that was stated.
fn noise_test(stated: Option<f64>, estimated: f64, degrees_of_freedom: f64) -> NoiseTest {
    let p_value = stated.and_then(|stated| {
        let square = degrees_of_freedom * (estimated / stated).powi(2);
        chi_squared_survival(square, degrees_of_freedom).ok()
    });
    NoiseTest { stated, estimated, p_value }
}

/// Parts as they are reported, the strongest first: the waves of one gear, all misread poses, are one
/// finding. `base` is the root mean square that the base model leaves.
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

/// One term with its interval and its rivals. What is left unexplained, a curve of the hypothesis `beside`, may be a part of it
/// or not: the interval holds both.
fn part(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    position: usize,
    beside: Option<&Hypothesis>,
) -> FindingPart {
    let term = &hypothesis.terms[position];
    let candidates = model.candidates();
    let rest = search.without(hypothesis, position);
    let first = first_of(hypothesis, position);
    let coverage_factor = coverage_factor_of(search, hypothesis);
    let mut estimates = estimates(model, search, hypothesis, position, beside, coverage_factor);
    // which form of a law is the right one is not known where another one leaves hardly more
    for form in search.other_forms(term.candidate) {
        let other = search.with(&rest, form);
        if search.left_rms(&other) > HARDLY_MORE * search.left_rms(hypothesis) {
            continue;
        }
        let Some(own) = other.terms.last() else { continue };
        let at = other.covariance.nrows() - own.values.len();
        widen(&mut estimates, intervals(model, &other, own, at, coverage_factor));
    }
    // candidates that would do in its place
    let additions = search.additions(&rest);
    // by the same measure as what was found: without it, what else the hypothesis holds is less
    // certain than with it
    let gained = (hypothesis.log_probability - rest.log_probability).min(additions[term.candidate]);
    let least = gained - 2.0 * APART.ln();
    let mut rivals: Vec<Rival> = (0..additions.len())
        .filter(|&index| {
            index != term.candidate && !candidates[index].is_nonparametric && additions[index] > least
        })
        .filter_map(|index| {
            let other = search.with(&rest, index);
            let odds = (hypothesis.log_probability - other.log_probability).exp();
            let own = other.terms.last()?.clone();
            let (effect, location) = (candidates[index].effect, model.location(&own));
            Some(Rival { effect, location, term: own, hypothesis: other, odds })
        })
        .filter(|rival| rival.odds < APART)
        .collect();
    rivals.sort_by(|a, b| a.odds.total_cmp(&b.odds));
    let gained = search.deviance(&rest, hypothesis.sigma) - search.deviance(hypothesis, hypothesis.sigma);
    // a curve has more parameters than the data determine of it
    let determined = (hypothesis.determined - rest.determined).clamp(1.0, term.values.len().max(1) as f64);
    FindingPart {
        term: term.clone(),
        location: model.location(term),
        estimates,
        first,
        covariance: {
            let count = term.values.len();
            hypothesis.covariance.view((first, first), (count, count)).into_owned()
        },
        coverage_factor,
        p_value: chi_squared_survival(gained.max(0.0), determined).unwrap_or(1.0),
        explains: explained(search, &rest, hypothesis),
        rivals,
    }
}

/// How many standard deviations a 95 % interval is, by the degrees of freedom that a hypothesis leaves.
fn coverage_factor_of(search: &Search, hypothesis: &Hypothesis) -> f64 {
    let degrees_of_freedom = (search.degrees_of_freedom() as f64 - hypothesis.determined).max(1.0);
    student_t_quantile(0.975, degrees_of_freedom).unwrap_or(1.96)
}

/// Where the parameters of a term begin among all of a hypothesis.
fn first_of(hypothesis: &Hypothesis, position: usize) -> usize {
    hypothesis.terms[..position].iter().map(|term| term.values.len()).sum()
}

/// Value and interval of the parameters of a term, with what else may be there, and with the curve `beside`.
fn estimates(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    position: usize,
    beside: Option<&Hypothesis>,
    coverage_factor: f64,
) -> Vec<Estimate> {
    let (term, first) = (&hypothesis.terms[position], first_of(hypothesis, position));
    let mut estimates = averaged(model, search, hypothesis, position, first, coverage_factor);
    let own =
        |other: &Hypothesis| other.terms.get(position).filter(|own| own.candidate == term.candidate).cloned();
    if let Some((longer, own)) = beside.and_then(|longer| Some((longer, own(longer)?))) {
        widen(&mut estimates, intervals(model, longer, &own, first, coverage_factor));
    }
    estimates
}

/// Value and 95 % interval of the parameters of a term, whatever else may be there besides: the hypotheses with one effect or
/// curve more, Y, have their share p in it (J. A. Hoeting et al., *Statistical Science* 14 (1999) 382–417, Eq 3),
///
/// ```text
/// var x = Σ p_Y·(s_Y² + (x_Y − x)²)
/// ```
fn averaged(
    model: &Linearised<'_>,
    search: &Search,
    hypothesis: &Hypothesis,
    position: usize,
    first: usize,
    coverage_factor: f64,
) -> Vec<Estimate> {
    let term = &hypothesis.terms[position];
    let additions = search.additions(hypothesis);
    let is_possible = |index: &usize| additions[*index] > -APART.ln();
    let mut likeliest: Vec<usize> = (0..additions.len()).filter(is_possible).collect();
    likeliest.sort_by(|&a, &b| additions[b].total_cmp(&additions[a]));
    likeliest.truncate(AVERAGED);
    let others: Vec<Hypothesis> = likeliest.into_iter().map(|index| search.with(hypothesis, index)).collect();
    let share = |other: &Hypothesis| (other.log_probability - hypothesis.log_probability).min(0.0).exp();
    let mut estimates = intervals(model, hypothesis, term, first, coverage_factor);
    let parameters = &model.candidates()[term.candidate].parameters;
    for (k, (estimate, parameter)) in estimates.iter_mut().zip(parameters).enumerate() {
        let variance = |hypothesis: &Hypothesis| hypothesis.covariance[(first + k, first + k)].max(0.0);
        let (mut total, mut weight) = (variance(hypothesis), 1.0);
        for other in &others {
            let off = other.terms[position].values[k] - term.values[k];
            total += share(other) * (variance(other) + off * off);
            weight += share(other);
        }
        let half = coverage_factor * (total / weight).sqrt();
        let (low, high) = parameter.bounds;
        (estimate.low, estimate.high) = ((term.values[k] - half).max(low), (term.values[k] + half).min(high));
    }
    estimates
}

/// Makes intervals hold those of another hypothesis.
fn widen(estimates: &mut [Estimate], others: Vec<Estimate>) {
    for (known, other) in estimates.iter_mut().zip(others) {
        (known.low, known.high) = (known.low.min(other.low), known.high.max(other.high));
    }
}

/// By how much the residual of a hypothesis is less than that of a shorter one, root of the difference of their mean
/// squares: what the base model would take up is explained by nothing else.
fn explained(search: &Search, shorter: &Hypothesis, hypothesis: &Hypothesis) -> f64 {
    let squares = search.left_rms(shorter).powi(2) - search.left_rms(hypothesis).powi(2);
    squares.max(0.0).sqrt()
}

/// Value and 95 % interval of the parameters of a term, which begin at `first` in the covariance of
/// its hypothesis.
fn intervals(
    model: &Linearised<'_>,
    hypothesis: &Hypothesis,
    term: &Term,
    first: usize,
    coverage_factor: f64,
) -> Vec<Estimate> {
    let parameters = &model.candidates()[term.candidate].parameters;
    let interval = |(k, (&value, parameter)): (usize, (&f64, &Parameter))| {
        let variance = hypothesis.covariance[(first + k, first + k)];
        let half = coverage_factor * variance.max(0.0).sqrt();
        let (low, high) = parameter.bounds;
        let (name, unit) = (parameter.name.clone(), parameter.unit);
        let (low, high) = ((value - half).max(low), (value + half).min(high));
        Estimate { name, unit, value, low, high }
    };
    term.values.iter().zip(parameters).enumerate().map(interval).collect()
}
