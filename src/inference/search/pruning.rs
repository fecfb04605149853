//! Which of the effects that make a hypothesis most probable are worth a name.

use std::collections::BTreeSet;

use nalgebra::DVector;

use crate::inference::Hypothesis;
use crate::inference::columns::background::{is_implausible, size_offsets};
use crate::inference::columns::linearised::Linearised;
use crate::inference::model::evidence::rms;
use crate::inference::noise::scatter::{OFF, SUSPECT, weighted};
use crate::inference::noise::whitening::Whitening;
use crate::inference::search::Search;
use crate::inference::search::hidden_in_correlation::hidden_in_correlation;
use crate::inference::search::hidden_in_groups::hidden;
use crate::inference::search::misread::unlike_repeats;
use crate::inference::search::selection::{DiscrepancyModel, LITTLE, Pairs};
use crate::inference::{Evidence, ForwardModel, Term};

/// What is left is little, as a share of the noise.
const LITTLE_IN_NOISE: f64 = 0.5;

/// An effect that a curve cannot draw has a name beside one that explains at most so many times as
/// much.
const BESIDE: f64 = 0.5;

/// Most times that weights and scatter are found anew.
const PASSES: usize = 3;
/// A change of a weight's root that changes nothing else.
const SAME_WEIGHT: f64 = 0.05;

/// A recording with the scatter that its hypothesis leaves: weights of the data, and the ratio of
/// shared to own errors. What is found first changes how the rest scatters, so that both are found
/// in turns. `evidence` may fix the ratio beforehand; then its weights count too.
///
/// Where nothing of it moved any more, what the last search has found comes with it.
pub fn settled(model: &Linearised<'_>, evidence: &Evidence) -> (Evidence, Option<Best>) {
    let mut evidence = evidence.clone();
    let mut known: Vec<Term> = Vec::new();
    let whitening = Whitening::new(&evidence, &evidence.residual);
    let is_plain = !evidence.is_robust && evidence.offsets.ncols() == 0;
    if is_plain && !whitening.is_of_shared_errors() {
        (evidence.shared_ratio, evidence.correlation) = (Some(whitening.ratio), Some(whitening.correlation));
        return (evidence, None);
    }
    let mut off: BTreeSet<usize> = match evidence.is_robust {
        true => unlike_repeats(&evidence),
        false => BTreeSet::new(),
    };
    off.iter().for_each(|&datum| evidence.weight[datum] = OFF);
    for pass in 0..PASSES {
        let search = Search::new(model, &evidence, &known);
        let (hypothesis, left_over) = search.best(Pairs::Screened);
        // a curve that explains what is left is no scatter
        let longest = match &left_over {
            Some(DiscrepancyModel::Curve(longer)) => longer,
            _ => &hypothesis,
        };
        let residual = search.plain_residual(longest);
        let (mut weight, information) = match evidence.is_robust {
            true => weighted(&evidence, &residual),
            false => (evidence.weight.clone(), 1.0),
        };
        if evidence.is_robust {
            // what was found far off stays so while it is
            off.retain(|&datum| residual[datum].abs() > SUSPECT * longest.sigma * evidence.spread[datum]);
            off.extend(search.misread(longest));
            off.iter().for_each(|&datum| weight[datum] = OFF);
        }
        let is_same_weight = weight
            .iter()
            .zip(&evidence.weight)
            .all(|(new, old)| (new.sqrt() - old.sqrt()).abs() < SAME_WEIGHT);
        let candidates = |terms: &[Term]| terms.iter().map(|t| t.candidate).collect::<Vec<_>>();
        let is_same = candidates(&known) == candidates(&longest.terms);
        let (ratio, correlation) = (search.shared_ratio(), search.correlation());
        let noise = longest.sigma;
        known = longest.terms.clone();
        if pass == 0 && search.whitening.is_of_shared_errors() {
            // a curve would draw it
            let response = model.response(&hypothesis.terms);
            let left = &evidence.residual - search.predicted(&hypothesis, &evidence, &response);
            let found = hidden(model, &evidence, &left);
            known.extend(found.filter(|new| known.iter().all(|old| old.candidate != new.candidate)));
        }
        if pass == 0 && correlation > 0.0 && evidence.correlation.is_none() {
            known = hidden_in_correlation(model, &evidence, &known).unwrap_or(known);
        }
        let has_shared = search.whitening.is_of_shared_errors();
        evidence.weight = if is_same_weight { evidence.weight } else { weight };
        let is_same_information = evidence.information == information;
        evidence.information = information;
        let is_settled = pass > 0 && is_same_weight && (is_same || !has_shared);
        if is_settled {
            (evidence.shared_ratio, evidence.correlation) = (Some(ratio), Some(correlation));
            return (evidence, is_same_information.then_some((hypothesis, left_over)));
        }
        size_offsets(&mut evidence, noise);
    }
    let whitening = Whitening::new(&evidence, &(&evidence.residual - model.response(&known)));
    (evidence.shared_ratio, evidence.correlation) = (Some(whitening.ratio), Some(whitening.correlation));
    (evidence, None)
}

/// The most probable hypothesis, and what it leaves.
pub type Best = (Hypothesis, Option<DiscrepancyModel>);

/// The hypothesis that a recording supports, what it leaves unexplained, and the search that found
/// them, with the scatter that [`settled`] has found; `known` is the best where that has found it.
pub fn infer<'a>(
    model: &'a Linearised<'a>,
    evidence: &'a Evidence,
    pairs: Pairs,
    known: Option<Best>,
) -> (Search<'a>, Hypothesis, Option<DiscrepancyModel>) {
    let search = Search::new(model, evidence, &[]);
    let (hypothesis, left_over) = known.unwrap_or_else(|| search.best(pairs));
    let hypothesis = beyond_the_tails(&search, hypothesis);
    let (hypothesis, left_over) = convincing(&search, hypothesis, left_over);
    (search, hypothesis, left_over)
}

/// A hypothesis without the effects that may as well be a part of what is left unexplained, and
/// what is left then.
///
/// An effect stays if it explains half as much as the unexplained curve, or more, even where that
/// is there to take its place (an outlier, which no smooth curve draws), or if what is left is
/// little beside it or beside the noise (a law of creep that is not quite the right one). It stays
/// too where the numbers of the file would be as far off in its place as they cannot be.
fn convincing(
    search: &Search,
    hypothesis: Hypothesis,
    unknown: Option<DiscrepancyModel>,
) -> (Hypothesis, Option<DiscrepancyModel>) {
    let Some(remainder) = &unknown else { return (hypothesis, unknown) };
    let own = |whole: &Hypothesis, position: usize| {
        let without = search.left_rms(&search.without(whole, position));
        (without.powi(2) - search.left_rms(whole).powi(2)).max(0.0).sqrt()
    };
    let left = match remainder {
        DiscrepancyModel::Curve(longer) => own(longer, longer.terms.len() - 1),
        DiscrepancyModel::Replicates => search.cells_rms(&hypothesis),
    };
    let is_kept = |position: usize| {
        let beside_curve = match remainder {
            DiscrepancyModel::Curve(longer) => own(longer, position),
            DiscrepancyModel::Replicates => own(&hypothesis, position),
        };
        let whole = unknown.as_ref().and_then(DiscrepancyModel::curve).unwrap_or(&hypothesis);
        search.takes_numbers_place(whole, position)
            || beside_curve > BESIDE * left
            || left < (LITTLE * own(&hypothesis, position)).max(LITTLE_IN_NOISE * hypothesis.sigma)
    };
    let kept: Vec<Term> =
        (0..hypothesis.terms.len()).filter(|&k| is_kept(k)).map(|k| hypothesis.terms[k].clone()).collect();
    if kept.len() == hypothesis.terms.len() {
        return (hypothesis, unknown);
    }
    let hypothesis = search.fit(&kept);
    let remainder = search.remains(&hypothesis).or(unknown);
    (hypothesis, remainder)
}

/// A hypothesis without events (a reading, or the three coordinates of a pose) that are no farther
/// out than the tails of this recording's noise reach.
///
/// Where the other residuals have more kurtosis than a normal distribution, by three standard
/// errors √(24/n), a datum has to be twice as far out as any of them.
fn beyond_the_tails(search: &Search, hypothesis: Hypothesis) -> Hypothesis {
    let events: Vec<bool> = hypothesis.terms.iter().map(|term| search.is_event(term)).collect();
    if !events.contains(&true) {
        return hypothesis;
    }
    let rest = search.standardised(&hypothesis);
    let n = rest.len() as f64;
    let (second, fourth) = (rest.norm_squared() / n, rest.map(|t| t.powi(4)).sum() / n);
    if fourth / second.powi(2) - 3.0 < 3.0 * (24.0 / n).sqrt() {
        return hypothesis;
    }
    let farthest = rest.amax();
    let is_kept = |position: &usize| {
        !events[*position] || {
            let without = search.without(&hypothesis, *position);
            search.standardised(&without).amax() * without.sigma > 2.0 * farthest * hypothesis.sigma
        }
    };
    let kept: Vec<Term> =
        (0..hypothesis.terms.len()).filter(is_kept).map(|k| hypothesis.terms[k].clone()).collect();
    if kept.len() == hypothesis.terms.len() { hypothesis } else { search.fit(&kept) }
}

impl Search<'_> {
    /// Sum of the weighted squares of what a hypothesis leaves.
    pub fn left_square(&self, hypothesis: &Hypothesis) -> f64 {
        let predicted = self.predicted(hypothesis, self.evidence, &self.model.response(&hypothesis.terms));
        let left = &self.evidence.residual - predicted;
        left.iter().zip(&self.evidence.weight).map(|(left, weight)| weight * left * left).sum()
    }

    /// True where the numbers of the file would be as far off as they cannot be in the place of a
    /// term.
    pub fn takes_numbers_place(&self, whole: &Hypothesis, position: usize) -> bool {
        !is_implausible(self.evidence, whole) && is_implausible(self.evidence, &self.without(whole, position))
    }

    /// Root mean square of what a hypothesis leaves.
    pub fn left_rms(&self, hypothesis: &Hypothesis) -> f64 {
        let predicted = self.predicted(hypothesis, self.evidence, &self.model.response(&hypothesis.terms));
        rms(&(&self.evidence.residual - predicted))
    }

    /// Can an effect say anything of the few data that it concerns?
    pub fn is_event(&self, term: &Term) -> bool {
        let columns = self.model.neutral(term.candidate);
        columns.row_iter().filter(|row| row.amax() > 0.0).count() <= columns.ncols()
    }

    /// Standardised residuals, whitened, that a hypothesis leaves.
    pub fn standardised(&self, hypothesis: &Hypothesis) -> DVector<f64> {
        let predicted = self.predicted(hypothesis, self.evidence, &self.model.response(&hypothesis.terms));
        self.whitening.whitened(&(&self.evidence.residual - predicted)) / hypothesis.sigma
    }

    /// What a hypothesis leaves of each datum, errors that data share taken out, not weighted.
    pub fn plain_residual(&self, hypothesis: &Hypothesis) -> DVector<f64> {
        let left = &self.evidence.residual
            - self.predicted(hypothesis, self.evidence, &self.model.response(&hypothesis.terms));
        self.whitening.without_shared(&left)
    }

    /// Root mean square of what repeats agree on that a hypothesis leaves; 0 where they do not.
    pub fn cells_rms(&self, hypothesis: &Hypothesis) -> f64 {
        let predicted = self.predicted(hypothesis, self.evidence, &self.model.response(&hypothesis.terms));
        let share = self.lack_of_fit(hypothesis, &predicted).map_or(0.0, |test| {
            // the squares of the replicates beyond what their degrees of freedom have of the noise
            let (a, b) = (test.dof_fit as f64, test.dof_repeats as f64);
            (a * (test.f - 1.0) / (a * test.f + b)).max(0.0)
        });
        self.left_rms(hypothesis) * share.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::tests::{Columns, independent};
    use crate::statistics::Random;

    const COUNT: usize = 200;

    /// A slope; one datum, three of them, and three that stand for two numbers.
    fn events() -> Columns {
        let mut model = Columns::new(COUNT);
        let at = |from: usize, columns: usize, rows: usize| {
            let is_one =
                move |row: usize, k: usize| row >= from && row < from + rows && (row - from) % columns == k;
            DMatrix::from_fn(COUNT, columns, move |row, k| f64::from(u8::from(is_one(row, k))))
        };
        model.add("slope", "", DMatrix::from_fn(COUNT, 1, |row, _| row as f64 / COUNT as f64), false);
        model.add("datum", "", at(100, 1, 1), false);
        model.add("point", "", at(120, 3, 3), false);
        model.add("shift", "", at(140, 2, 3), false);
        model
    }

    /// Noise, with these data besides.
    fn noise(besides: &[(usize, f64)]) -> Evidence {
        let mut random = Random::seeded(5, 0);
        let mut residual: Vec<f64> = (0..COUNT).map(|_| random.normal()).collect();
        besides.iter().for_each(|&(row, value)| residual[row] = value);
        independent(residual)
    }

    /// Which of `effects` stay, of a recording to which all of them are fitted.
    fn kept(evidence: &Evidence, effects: &[(&str, usize)]) -> Vec<&'static str> {
        let model = events();
        let linear = Linearised::new(&model);
        let search = Search::new(&linear, evidence, &[]);
        let terms: Vec<Term> =
            effects.iter().map(|(effect, count)| model.term(effect, &vec![0.0; *count])).collect();
        let hypothesis = beyond_the_tails(&search, search.fit(&terms));
        hypothesis.terms.iter().map(|term| model.candidates[term.candidate].effect.name).collect()
    }

    /// Data that make the tails heavy: the farthest is 7 noises out.
    const TAILS: [(usize, f64); 6] = [(10, 6.0), (30, -7.0), (50, 5.0), (70, -5.0), (90, 6.0), (160, 5.5)];

    #[test]
    fn where_tails_are_heavy_an_event_is_farther_out_than_twice_the_rest() {
        let with = |value: f64| noise(&[&TAILS[..], &[(100, value)]].concat());
        let effects = [("slope", 1), ("datum", 1)];
        // the sign does not matter, nor does any effect that is more than an event
        for near in [9.0, -13.0] {
            assert_eq!(kept(&with(near), &effects), ["slope"], "{near}");
        }
        for far in [16.0, -40.0] {
            assert_eq!(kept(&with(far), &effects), ["slope", "datum"], "{far}");
        }
        assert_eq!(kept(&with(0.0), &[("slope", 1)]), ["slope"]);
    }

    #[test]
    fn beside_normal_noise_an_event_may_be_near() {
        // the farthest of the others is 3 noises out
        assert_eq!(kept(&noise(&[(100, 4.5)]), &[("datum", 1)]), ["datum"]);
    }

    #[test]
    fn an_event_is_told_as_many_numbers_as_it_has_data() {
        let three = |row: usize, value: f64| [(row, value), (row + 1, value), (row + 2, -value)];
        let with = |row: usize, value: f64| noise(&[&TAILS[..], &three(row, value)].concat());
        assert!(kept(&with(120, 10.0), &[("point", 3)]).is_empty());
        assert_eq!(kept(&with(120, 20.0), &[("point", 3)]), ["point"]);
        // two numbers for three data say something of them
        assert_eq!(kept(&with(140, 10.0), &[("shift", 2)]), ["shift"]);
        let model = events();
        let linear = Linearised::new(&model);
        let evidence = noise(&[]);
        let search = Search::new(&linear, &evidence, &[]);
        let is_event = |effect: &str| search.is_event(&model.term(effect, &[]));
        assert_eq!(["slope", "datum", "point", "shift"].map(is_event), [false, true, true, false]);
    }

    /// 20 repeats of 10 conditions.
    const CONDITIONS: usize = 10;

    fn law(row: usize) -> f64 {
        2.0 * (row % CONDITIONS) as f64 / (CONDITIONS - 1) as f64 - 1.0
    }

    fn ripple(row: usize) -> f64 {
        if row.is_multiple_of(2) { 1.0 } else { -1.0 }
    }

    /// Does the law stay, beside what is left of a recording of it, of a ripple and of noise of
    /// these sizes? The ripple is seen by the repeats or is drawn by an unknown curve, which also
    /// has this function of the law.
    fn convinces(law_size: f64, ripple_size: f64, noise: f64, curve: Option<fn(f64) -> f64>) -> bool {
        let mut model = Columns::new(COUNT);
        model.add("law", "", DMatrix::from_fn(COUNT, 1, |row, _| law(row)), false);
        let other = curve.unwrap_or(UNLIKE);
        let of_curve = |row: usize, k: usize| if k == 0 { other(law(row)) } else { ripple(row) };
        model.add("curve", "", DMatrix::from_fn(COUNT, 2, of_curve), true);
        let mut random = Random::seeded(9, 0);
        let predicted = |row: usize| law_size * law(row) + ripple_size * ripple(row);
        let residual = (0..COUNT).map(|row| predicted(row) + noise * random.normal()).collect();
        let replicate_group = (0..COUNT).map(|row| row % CONDITIONS).collect();
        let evidence = Evidence { replicate_group, ..independent(residual) };
        let linear = Linearised::new(&model);
        let search = Search::new(&linear, &evidence, &[]);
        let hypothesis = search.fit(&[model.term("law", &[0.0])]);
        let remainder = match curve {
            Some(_) => DiscrepancyModel::Curve(search.with(&hypothesis, 1)),
            None => DiscrepancyModel::Replicates,
        };
        let (hypothesis, left) = convincing(&search, hypothesis, Some(remainder));
        assert!(left.is_some(), "what is left stays unexplained");
        !hypothesis.terms.is_empty()
    }

    const UNLIKE: fn(f64) -> f64 = |x| x * x;
    /// All but the law itself.
    const LIKE: fn(f64) -> f64 = |x| (0.8 * x).sin();

    #[test]
    fn an_effect_that_explains_less_than_is_left_has_no_name() {
        for curve in [Some(UNLIKE), None] {
            assert!(!convinces(1.0, 4.0, 0.3, curve), "{}", curve.is_some());
            assert!(convinces(4.0, 1.0, 0.3, curve), "{}", curve.is_some());
        }
        // nor has one whose place the curve can take
        assert!(!convinces(4.0, 1.0, 0.3, Some(LIKE)));
    }

    #[test]
    fn it_has_where_what_is_left_is_little_beside_it_or_beside_the_noise() {
        assert!(convinces(8.0, 0.35, 0.1, Some(LIKE)));
        assert!(!convinces(8.0, 1.6, 0.1, Some(LIKE)));
        assert!(convinces(0.5, 0.4, 1.2, Some(LIKE)));
        assert!(!convinces(0.5, 0.4, 0.3, Some(LIKE)));
    }

    #[test]
    fn without_a_remainder_nothing_is_doubted() {
        let model = events();
        let linear = Linearised::new(&model);
        let evidence = noise(&[]);
        let search = Search::new(&linear, &evidence, &[]);
        let hypothesis = search.fit(&[model.term("slope", &[0.0])]);
        let (hypothesis, left) = convincing(&search, hypothesis, None);
        assert!(hypothesis.terms.len() == 1 && left.is_none());
    }
}
