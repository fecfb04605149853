//! The diagnosis: is there a mismatch, what is it, what could it be as well, and what remains.

use std::sync::Arc;

use nalgebra::DVector;

use crate::inference::columns::background;
use crate::inference::columns::linearised::Linearised;
use crate::inference::held_out::confirmed::{apart_from_nothing, confirmed, outdone};
use crate::inference::held_out::sessions::leave_one_session_out;
use crate::inference::held_out::{Theme, hold_out};
use crate::inference::locate::{Structure, along, locate};
use crate::inference::model::evidence::rms;
use crate::inference::noise::in_common::wandering;
use crate::inference::noise::own_noise::{CLEARLY, own_spread};
use crate::inference::noise::scatter::{NoiseTest, Tails, in_spread};
use crate::inference::noise::suspects::are_many;
use crate::inference::search::Search;
use crate::inference::search::findings::findings;
use crate::inference::search::hidden_in_noise::hidden_in_noise;
use crate::inference::search::parts::part;
use crate::inference::search::pruning::{infer, settled};
use crate::inference::search::selection::{DiscrepancyModel, Pairs};
use crate::inference::{
    Covariate, Diagnosis, Discrepancy, Evidence, FindingPart, ForwardModel, Hypothesis, ShownBy, Term,
};
use crate::statistics::{HALF_95, chi_squared_survival, student_t_quantile};

/// So many times what a recording may scatter it may, where repeats show that it does.
const SHOWN_BY_REPEATS: f64 = 3.0;
/// Zeros that scatter so many times as far as readings are something of their own.
pub(crate) const ZEROS_APART: f64 = 4.0;
/// Most times that the noise of each sensor is found anew.
const NOISES: usize = 3;
/// Ln odds from which on it is said what the nominal numbers explain.
const WORTH_SAYING: f64 = 3.0;

/// Diagnoses a recording.
///
/// A stated noise that the best hypothesis contradicts tells no shape from chance: what is left is
/// searched again with the scatter that it has, and said to be more than was stated.
///
/// ```
/// use nalgebra::DVector;
/// use rodcal::diagnosis::rig::planned::effect_named;
/// use rodcal::inference::{Candidate, Evidence, ForwardModel, Location, Parameter, Term, diagnose, ranking};
/// use rodcal::units::Unit;
///
/// /// A slope over 40 data, and nothing else that might be real.
/// struct Slope(Vec<Candidate>);
///
/// impl ForwardModel for Slope {
///     fn candidates(&self) -> &[Candidate] {
///         &self.0
///     }
///
///     fn response(&self, terms: &[Term]) -> DVector<f64> {
///         let slope: f64 = terms.iter().map(|term| term.values[0]).sum();
///         DVector::from_fn(40, |row, _| slope * row as f64 / 39.0)
///     }
/// }
///
/// let effect = effect_named("stiffness_scale").expect("the library knows it");
/// let parameters = vec![Parameter::new("slope", Unit::NONE, 10.0)];
/// let model = Slope(vec![Candidate::new(effect, Location::Named("here".into()), parameters)]);
/// // a slope of 8 beside errors of 0.5 that change their sign from datum to datum
/// let recorded = |row: usize| 8.0 * row as f64 / 39.0 + if row % 2 == 0 { 0.5 } else { -0.5 };
/// let mut evidence = Evidence::new(DVector::from_fn(40, |row, _| recorded(row)));
/// evidence.fold = (0..40).map(|row| row % 5).collect();
/// let found = diagnose(&model, &evidence);
/// let slope = found.findings[0].quantity("slope").expect("its parameter");
/// assert!((slope.value - 8.0).abs() < 0.3 && slope.low < 8.0 && 8.0 < slope.high, "{slope:?}");
/// assert_eq!(ranking(model.candidates(), &found)[0].effect.name, "stiffness_scale");
/// ```
pub fn diagnose(model: &dyn ForwardModel, evidence: &Evidence) -> Diagnosis {
    let diagnosis = diagnose_with(model, evidence);
    let Some(stated) = evidence.stated_noise.filter(|_| diagnosis.noise_test.is_contradicted()) else {
        return diagnosis;
    };
    let mut diagnosis = diagnose_with(model, &Evidence { stated_noise: None, ..evidence.clone() });
    let degrees_of_freedom = evidence.residual.len() as f64 - diagnosis.taken;
    diagnosis.noise_test =
        noise_test(Some(stated), of_all(evidence) * diagnosis.noise, degrees_of_freedom.max(1.0));
    if diagnosis.discrepancy.is_none() && diagnosis.noise_test.is_contradicted() {
        let left = diagnosis.after.clone();
        diagnosis.discrepancy = Some(Discrepancy::without_curve(ShownBy::StatedNoise, left));
    }
    diagnosis
}

fn diagnose_with(model: &dyn ForwardModel, evidence: &Evidence) -> Diagnosis {
    diagnose_in(model, evidence, NOISES)
}

/// The same, with the noise of each sensor at most so many times anew.
fn diagnose_in(whole: &dyn ForwardModel, recorded: &Evidence, noises: usize) -> Diagnosis {
    let model = &Linearised::new(whole);
    let folded = background::folded(recorded);
    let (settled, known) = settled(model, &folded.evidence);
    let evidence = &settled;
    let model = &model.in_parts(evidence, &evidence.fold);
    let (search, hypothesis, left_over) = infer(model, evidence, Pairs::Screened, known);
    let longest = left_over.as_ref().and_then(DiscrepancyModel::curve).unwrap_or(&hypothesis);
    let spread = || {
        own_spread(evidence, &search.plain_residual(longest), CLEARLY)
            .or_else(|| hidden_in_noise(model, &search, longest))
    };
    if let Some(spread) = (noises > 0).then(spread).flatten() {
        let weight = spread.iter().map(|own| own.powi(-2)).collect();
        return diagnose_in(whole, &Evidence { spread, weight, ..recorded.clone() }, noises - 1);
    }
    let held_out = hold_out(model, evidence, &hypothesis.terms);
    let (hypothesis, left_over) =
        confirmed(model, &search, &folded, hypothesis, left_over, held_out.as_ref());
    let (mut hypothesis, mut left_over) = apart_from_nothing(model, &search, hypothesis, left_over);
    let parts_of = |hypothesis: &Hypothesis, left_over: &Option<DiscrepancyModel>| {
        let beside = left_over.as_ref().and_then(DiscrepancyModel::curve);
        let at = |position| part(model, &search, hypothesis, position, beside);
        (0..hypothesis.terms.len()).map(at).collect::<Vec<FindingPart>>()
    };
    let mut parts = parts_of(&hypothesis, &left_over);
    while let Some(position) = outdone(model, &search, &parts, left_over.as_ref()) {
        let shorter = search.without(&hypothesis, position);
        let Some(rest) = search.remains(&shorter) else { break };
        (hypothesis, left_over) = (shorter, Some(rest));
        parts = parts_of(&hypothesis, &left_over);
    }
    let none = search.fit(&[]);
    let by_base = search.predicted(&none, evidence, &DVector::zeros(evidence.residual.len()));
    let predicted = search.predicted(&hypothesis, evidence, &model.response(&hypothesis.terms));
    let (before, after) = (&evidence.residual - &by_base, &evidence.residual - &predicted);
    let theme = |part: FindingPart| (Theme::new(&model.candidates()[part.term.candidate]), part);
    let mut parts: Vec<(Theme, FindingPart)> = parts.into_iter().map(theme).collect();
    parts.sort_by(|(_, a), (_, b)| b.explains.total_cmp(&a.explains));
    let findings = findings(model, &search, &hypothesis, held_out.as_ref(), rms(&before), parts);
    let lack_of_fit_after = search.lack_of_fit(&hypothesis, &predicted);
    let longest = left_over.as_ref().and_then(DiscrepancyModel::curve).unwrap_or(&hypothesis);
    let left = &evidence.residual - search.predicted(longest, evidence, &model.response(&longest.terms));
    let degrees_of_freedom = (search.degrees_of_freedom() as f64 - longest.determined).max(1.0);
    let weighted: f64 = left.iter().zip(&evidence.weight).map(|(r, w)| w * r * r).sum();
    let noise = (weighted / degrees_of_freedom).sqrt();
    let residual = in_spread(evidence, &search.plain_residual(longest));
    let suspects = match evidence.is_robust {
        true => Tails::of(&residual, evidence.rounding()).suspects(&residual),
        false => Vec::new(),
    };
    let noise_test = noise_test(evidence.stated_noise, of_all(evidence) * longest.sigma, degrees_of_freedom);
    let is_contradicted = noise_test.is_contradicted();
    // repeats that scatter as much show that it is scatter, up to a point
    let times = if lack_of_fit_after.is_some() { SHOWN_BY_REPEATS } else { 1.0 };
    // zeros that were not taken scatter as far as they like: readings within a run do not
    let ratio = search.shared_ratio();
    let own = if ratio > ZEROS_APART * ZEROS_APART { noise / (1.0 + ratio).sqrt() } else { noise };
    // and so does what a sensor scatters from reading to reading, whatever the model is
    let worst = evidence.spread.iter().fold(0.0, |most: f64, own| most.max(*own));
    let is_more = |most: f64| own > times * most || worst * own > SHOWN_BY_REPEATS * times * most;
    let is_too_much = evidence.most_scatter.is_some_and(is_more);
    let are_many = are_many(evidence, &suspects);
    // of what hangs together, and only of that: what else is left has been looked for
    let wanders = evidence.correlated_noise.is_some() && wandering(evidence, &left).is_some();
    let varying = if left_over.is_none() { search.varying(&hypothesis) } else { None };
    let discrepancy = match &left_over {
        Some(DiscrepancyModel::Curve(longer)) => {
            Some(described(model, &search, evidence, longer, &predicted))
        }
        Some(DiscrepancyModel::Replicates) => {
            Some(Discrepancy::without_curve(ShownBy::Repeats, after.clone()))
        }
        None if varying.is_some() => varying,
        None if wanders => Some(Discrepancy::without_curve(ShownBy::Neighbours, after.clone())),
        None if is_contradicted => Some(Discrepancy::without_curve(ShownBy::StatedNoise, after.clone())),
        None if is_too_much => Some(Discrepancy::without_curve(ShownBy::Size, after.clone())),
        None if are_many => Some(Discrepancy::without_curve(ShownBy::Suspects, after.clone())),
        None if folded.is_implausible(longest) => {
            Some(Discrepancy::without_curve(ShownBy::Numbers, folded.response(longest)))
        }
        None => None,
    };
    // what repeats is no noise, even where no curve draws all of it
    let repeats = left_over.as_ref().and_then(|_| search.scatter_beside_repeats(longest, &left));
    let noise = repeats.map_or(noise, |repeats| repeats.min(noise));
    let coverage_factor = student_t_quantile(0.975, degrees_of_freedom).unwrap_or(HALF_95);
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

/// What the curve of the `longer` hypothesis says beside what is `predicted` without it; what the
/// calibration would take up of it is not left.
fn described(
    model: &Linearised<'_>,
    search: &Search,
    evidence: &Evidence,
    longer: &Hypothesis,
    predicted: &DVector<f64>,
) -> Discrepancy {
    let shape = search.predicted(longer, evidence, &model.response(&longer.terms)) - predicted;
    let curve = longer.terms.last();
    Discrepancy {
        candidate: curve.map(|curve| curve.candidate),
        location: curve.map(|curve| model.location(curve)),
        shown_by: ShownBy::Curve,
        rms: rms(&shape),
        shape,
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

/// Noise of all data over the usual one, as far as one number stands for all: what is stated
/// without more is stated of each of them.
fn of_all(evidence: &Evidence) -> f64 {
    match evidence.is_spread_stated || evidence.stated_noise.is_none() {
        true => 1.0,
        false => rms(&DVector::from_column_slice(&evidence.spread)),
    }
}

/// χ² of what is left against the noise that was stated.
fn noise_test(stated: Option<f64>, estimated: f64, degrees_of_freedom: f64) -> NoiseTest {
    let p_value = stated.and_then(|stated| {
        let square = degrees_of_freedom * (estimated / stated).powi(2);
        chi_squared_survival(square, degrees_of_freedom).ok()
    });
    NoiseTest { stated, estimated, p_value }
}
