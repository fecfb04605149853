//! Is what neighbours have in common an effect, or do their errors hang together?
//!
//! Errors that hang together look like anything that goes on for a while: a drift, a step, a curve
//! over an angle that the poses follow. An effect, on the other hand, makes errors look as if they
//! hung together. So both are tried: the best hypothesis of independent errors, and those beside
//! the errors in common that are likeliest where nothing is known, and where the first has been
//! taken out. They are compared by the probability of the recording,
//!
//! ```text
//! ln p = ln p(W·y) + ln |W| − ½·ln |NᵀWᵀWN|       N the nuisance, W as in `correlated_noise.rs`
//! ```
//!
//! less a price for a and l ([`WORTH`]), which `in_common.rs` finds.

use nalgebra::DVector;

use crate::inference::columns::background::folded;
use crate::inference::columns::linearised::Linearised;
use crate::inference::noise::correlated_noise::CorrelatedNoise;
use crate::inference::noise::in_common::{WORTH, likeliest, walks};
use crate::inference::noise::whitening::Whitening;
use crate::inference::score::Moments;
use crate::inference::search::pruning::{infer, settled};
use crate::inference::search::selection::{DiscrepancyModel, Pairs};
use crate::inference::{Evidence, ForwardModel, Hypothesis};
use crate::linalg::transposed_product;

/// Times that an answer is asked again with the errors that it leaves.
const ROUNDS: usize = 2;
/// Ln of the odds by which a recording is too much for errors in common alone.
const FAR: f64 = 100.0;

/// The best hypothesis and what it leaves: neither confirmed by held-out data nor compared with its
/// rivals.
#[derive(Debug, Clone)]
pub struct Sketch {
    /// The hypothesis.
    pub hypothesis: Hypothesis,
    /// What it leaves.
    pub left: DVector<f64>,
    /// The errors that neighbours have in common beside it.
    pub correlated_noise: Option<CorrelatedNoise>,
    /// Ln of the probability of all of it, but for a constant of the recording.
    pub log_probability: f64,
    /// The hypothesis with the curve beside it that describes what is left and has no name, where
    /// there is one; nothing where the repeats alone show it.
    pub left_over: Option<Option<Hypothesis>>,
}

/// Of a recording whose `neighbours` nobody knows.
pub fn sketch(model: &dyn ForwardModel, evidence: &Evidence) -> Sketch {
    let model = &Linearised::new(model);
    let evidence =
        &folded(&Evidence { stated_noise: None, correlated_noise: None, ..evidence.clone() }).evidence;
    let (mut best, none) = beside(model, evidence, None);
    if evidence.courses.is_empty() {
        return best;
    }
    let mut tried = vec![None];
    let white = best.log_probability;
    for (start, is_none) in [(none, true), (best.left.clone(), false)] {
        let mut left = start;
        for _ in 0..ROUNDS {
            let correlated_noise = likeliest(evidence, &left);
            // what is far too much for errors in common says nothing of them
            let is_effect = |noise: CorrelatedNoise| log_probability_of_none(evidence, noise) < white - FAR;
            if is_none && correlated_noise.is_some_and(is_effect) {
                break;
            }
            if tried.contains(&correlated_noise) {
                break;
            }
            tried.push(correlated_noise);
            let (own, _) = beside(model, evidence, correlated_noise);
            left.copy_from(&own.left);
            if own.log_probability - WORTH > best.log_probability && !walks(evidence, &left) {
                best = Sketch { log_probability: own.log_probability - WORTH, ..own };
            }
        }
    }
    best
}

/// With these errors in common; and what is left where there is no effect.
fn beside(
    model: &Linearised<'_>,
    evidence: &Evidence,
    correlated_noise: Option<CorrelatedNoise>,
) -> (Sketch, DVector<f64>) {
    let evidence = &Evidence { correlated_noise, ..evidence.clone() };
    let (settled, known) = settled(model, evidence);
    let model = &model.in_parts(&settled, &settled.fold);
    let (search, hypothesis, left_over) = infer(model, &settled, Pairs::Screened, known);
    let predicted = search.predicted(&hypothesis, &settled, &model.response(&hypothesis.terms));
    let whole = match &left_over {
        Some(DiscrepancyModel::Curve(longer)) => longer.log_probability.max(hypothesis.log_probability),
        _ => hypothesis.log_probability,
    };
    let left = &settled.residual - predicted;
    let log_probability = whole + search.whitening.log_jacobian();
    let left_over = left_over.map(|found| found.curve().cloned());
    let none = &settled.residual - &settled.background * search.fit(&[]).background;
    (Sketch { left, hypothesis, correlated_noise, log_probability, left_over }, none)
}

/// Ln of the probability of a recording without any effect, as [`Sketch`] has it.
fn log_probability_of_none(evidence: &Evidence, noise: CorrelatedNoise) -> f64 {
    let whitening =
        Whitening::new(&Evidence { correlated_noise: Some(noise), ..evidence.clone() }, &evidence.residual);
    let (r, columns) = (whitening.apply(&evidence.residual), whitening.apply_columns(&evidence.background));
    let moments = Moments {
        square: r.norm_squared(),
        gram: transposed_product(&columns, &columns),
        product: columns.tr_mul(&r),
        bounds: vec![(f64::NEG_INFINITY, f64::INFINITY); columns.ncols()],
        effects: Vec::new(),
        degrees_of_freedom: whitening.degrees_of_freedom,
        floor: evidence.rounding(),
        stated: None,
    };
    moments.score().log_evidence + whitening.log_jacobian()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::tests::{Columns, independent};
    use crate::statistics::Random;

    const COUNT: usize = 120;

    /// A drift, moves after each tenth datum, and smooth curves.
    fn model() -> Columns {
        let along = |row: usize| row as f64 / COUNT as f64;
        let mut model = Columns::new(COUNT);
        model.add("drift", "", DMatrix::from_fn(COUNT, 1, |row, _| 2.0 * along(row) - 1.0), false);
        for place in (10..COUNT).step_by(10) {
            let step = DMatrix::from_fn(COUNT, 1, |row, _| f64::from(u8::from(row >= place)));
            model.add("move", &format!("{place}"), step, false);
        }
        let wave = |row: usize, k: usize| (std::f64::consts::PI * (k + 1) as f64 * along(row)).cos();
        model.add("curve", "", DMatrix::from_fn(COUNT, 6, wave), true);
        model
    }

    /// Errors of which 0.7 of the variance goes on for 5 data, with a drift besides; a course, or
    /// none.
    fn evidence(seed: u64, drift: f64, is_course: bool) -> Evidence {
        let mut random = Random::seeded(seed, 4);
        let (share, carried) = (0.7_f64, (-0.2_f64).exp());
        let mut slow = random.normal();
        let own = |row: usize| {
            slow = carried * slow + (1.0 - carried * carried).sqrt() * random.normal();
            let error = share.sqrt() * slow + (1.0 - share).sqrt() * random.normal();
            error + drift * (2.0 * row as f64 / COUNT as f64 - 1.0)
        };
        let residual = (0..COUNT).map(own).collect();
        let nuisance = DMatrix::from_element(COUNT, 1, 1.0);
        let place = |row: usize| is_course.then_some((0, row as f64));
        let courses = (0..COUNT).map(place).collect();
        let courses = if is_course { courses } else { Vec::new() };
        Evidence { nuisance, courses, ..independent(residual) }
    }

    #[test]
    fn errors_in_common_are_no_effect_and_hide_none_that_is_larger() {
        let model = model();
        let named = |drift: f64, is_course: bool| -> usize {
            let of_seed = |seed: u64| {
                let found = sketch(&model, &evidence(seed, drift, is_course));
                assert!(is_course || found.correlated_noise.is_none());
                usize::from(!found.hypothesis.terms.is_empty())
            };
            (0..40).map(of_seed).sum()
        };
        // taken for independent they are moves and drifts
        assert!(named(0.0, false) >= 4, "{}", named(0.0, false));
        assert!(named(0.0, true) <= 2, "{}", named(0.0, true));
        assert!(named(4.0, true) >= 36, "{}", named(4.0, true));
    }
}
