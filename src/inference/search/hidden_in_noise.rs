//! What only a sensor that is worse than the others draws.
//!
//! A curve, or an effect, that explains what is far out under the noise of all sensors may be no
//! more than the noise of one of them, of which it takes up as much as it has numbers. So each is
//! left out in turn, and where the sensors then scatter otherwise, what is found with the noise
//! that each has is compared with what was found before,
//!
//! ```text
//! ln P = ln p(r | spread) + ln |W| + ½·Σ ln w        w = 1/spread², W as in `whitening.rs`
//! ```

use crate::inference::columns::linearised::Linearised;
use crate::inference::noise::own_noise::{POSSIBLY, own_spread};
use crate::inference::noise::scatter::OFF;
use crate::inference::score::priors::NAMED;
use crate::inference::search::Search;
use crate::inference::search::selection::{DiscrepancyModel, Pairs};
use crate::inference::{Evidence, Hypothesis};

/// Probability beforehand that one sensor is much worse than the others.
const UNEVEN: f64 = 0.1;

/// The spread with which fewer effects explain as much, within the odds of a name, as the `longest`
/// hypothesis does without it, or as many explain more by these odds; `None` where there is none.
pub fn hidden_in_noise(model: &Linearised<'_>, search: &Search, longest: &Hypothesis) -> Option<Vec<f64>> {
    let evidence = search.evidence;
    let uneven = |spread: &Vec<f64>| {
        let times = spread.iter().zip(&evidence.spread).map(|(new, old)| (new / old).ln().abs());
        times.fold(0.0, f64::max)
    };
    let spread = (0..longest.terms.len())
        .filter_map(|position| {
            own_spread(evidence, &search.plain_residual(&search.without(longest, position)), POSSIBLY)
        })
        .max_by(|a, b| uneven(a).total_cmp(&uneven(b)))?;
    let other = Evidence { spread, shared_ratio: None, correlation: None, ..evidence.clone() };
    let other = evenly_weighted(&other, evidence);
    let found = Search::new(model, &other, &[]);
    let (hypothesis, left_over) = found.best(Pairs::LeftOut);
    let best = match left_over {
        Some(DiscrepancyModel::Curve(longer)) => longer,
        _ => hypothesis,
    };
    let with = |evidence: &Evidence| {
        let search = Search::new(model, evidence, &longest.terms);
        log_probability(&search, &search.fit(&longest.terms))
    };
    let alike = with(&evenly_weighted(evidence, evidence));
    // what is explained may leave sensors uneven as well
    let own = own_spread(evidence, &search.plain_residual(longest), POSSIBLY)
        .map(|spread| with(&evenly_weighted(&Evidence { spread, ..evidence.clone() }, evidence)));
    let gain = log_probability(&found, &best) - own.map_or(alike, |own| own.max(alike));
    let least = if best.terms.len() < longest.terms.len() { -NAMED.ln() } else { NAMED.ln() };
    (gain * evidence.information + UNEVEN.ln() > least).then_some(other.spread)
}

/// Without regard to tails; what was far off stays so.
fn evenly_weighted(evidence: &Evidence, settled: &Evidence) -> Evidence {
    let mut weight = evidence.even_weight();
    let off = (0..weight.len()).filter(|&row| !settled.counts(row));
    off.for_each(|row| weight[row] = OFF);
    Evidence { weight, information: 1.0, ..evidence.clone() }
}

fn log_probability(search: &Search, hypothesis: &Hypothesis) -> f64 {
    let whitening = &search.whitening;
    let roots: f64 = search.evidence.spread.iter().map(|own| -own.ln()).sum();
    hypothesis.log_probability + whitening.log_determinant() + whitening.log_jacobian() + roots
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::tests::{Columns, independent};
    use crate::statistics::Random;

    const READINGS: usize = 30;

    /// Two sensors in turn; of the first one a curve of cosines may be drawn.
    fn model() -> Columns {
        let mut model = Columns::new(2 * READINGS);
        let along = |row: usize| row as f64 / (2 * READINGS) as f64;
        let cosine = |row: usize, k: usize| (std::f64::consts::PI * (k + 1) as f64 * along(row)).cos();
        let of_first = |row: usize, k: usize| if row.is_multiple_of(2) { cosine(row, k) } else { 0.0 };
        model.add("unknown", "first", DMatrix::from_fn(2 * READINGS, 8, of_first), true);
        model
    }

    /// The spread of the first sensor where the curve is taken, in this noise of both with this
    /// wave in the first.
    fn hidden(seed: u64, noise: [f64; 2], wave: f64) -> Option<f64> {
        let model = model();
        let mut random = Random::seeded(seed, 0);
        let of_row = |row: usize| {
            let x = 3.0 * std::f64::consts::PI * row as f64 / (2 * READINGS) as f64;
            let own = if row.is_multiple_of(2) { wave * x.cos() } else { 0.0 };
            own + noise[row % 2] * random.normal()
        };
        let residual = (0..2 * READINGS).map(of_row).collect();
        let sensor = (0..2 * READINGS).map(|row| row % 2).collect();
        let evidence = Evidence { sensor, ..independent(residual) };
        let linear = Linearised::new(&model);
        let search = Search::new(&linear, &evidence, &[]);
        let longest = search.fit(&[model.term("unknown", &[0.0; 8])]);
        hidden_in_noise(&linear, &search, &longest).map(|spread| spread[0])
    }

    #[test]
    fn a_curve_that_draws_the_noise_of_a_sensor_is_none() {
        for seed in 0..20 {
            let spread = hidden(seed, [5.0, 1.0], 0.0);
            assert!(spread.is_some_and(|own| (3.0..12.0).contains(&own)), "{seed}: {spread:?}");
        }
    }

    #[test]
    fn a_wave_of_one_sensor_is_no_noise() {
        for seed in 0..20 {
            assert_eq!(hidden(seed, [1.0, 1.0], 5.0), None, "{seed}");
        }
    }

    #[test]
    fn neither_is_one_beside_the_noise_of_its_sensor() {
        for seed in 0..20 {
            // three times as much, not the ten that the wave would be
            let spread = hidden(seed, [3.0, 1.0], 15.0);
            assert!(spread.is_none_or(|own| own < 5.0), "{seed}: {spread:?}");
        }
    }
}
