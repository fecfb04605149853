//! What comes and goes slowly, and looks like noise whose neighbours resemble each other.
//!
//! As long as the correlation φ of the noise is found with a swing or a drift in it, neither is
//! worth a name: it is what such noise does. With it taken out, φ is another one. So it is looked
//! for a second time as if neighbours did not resemble each other, and what is found so is compared
//! with what was found before, each beside the φ and the ρ that it leaves,
//!
//! ```text
//! ln P = ln p(r | φ, ρ) + ln |W|        W and its determinant as in `whitening.rs`
//! ```
//!
//! the evidence of `score.rs`, with the densities of both whitenings.

use crate::inference::columns::linearised::Linearised;
use crate::inference::score::priors::NAMED;
use crate::inference::search::Search;
use crate::inference::search::selection::{DiscrepancyModel, Pairs};
use crate::inference::{Evidence, Term};

/// What is found as if neighbours did not resemble each other, where that is likelier than
/// `found`, by the odds of a name; `None` where it is not.
pub fn hidden_in_correlation(
    model: &Linearised<'_>,
    evidence: &Evidence,
    found: &[Term],
) -> Option<Vec<Term>> {
    let independent = Evidence { correlation: Some(0.0), ..evidence.clone() };
    let (hypothesis, left_over) = Search::new(model, &independent, &[]).best(Pairs::LeftOut);
    let longest = match left_over {
        Some(DiscrepancyModel::Curve(longer)) => longer,
        _ => hypothesis,
    };
    let candidates = |terms: &[Term]| terms.iter().map(|term| term.candidate).collect::<Vec<_>>();
    let is_new = candidates(&longest.terms) != candidates(found);
    let log_probability = |terms: &[Term]| {
        let search = Search::new(model, evidence, terms);
        let whitening = &search.whitening;
        search.fit(terms).log_probability + whitening.log_determinant() + whitening.log_jacobian()
    };
    (is_new && log_probability(&longest.terms) > log_probability(found) + NAMED.ln()).then_some(longest.terms)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::tests::{Columns, independent};
    use crate::statistics::Random;

    /// Runs of so many conditions each.
    const RUNS: usize = 40;
    const POINTS: usize = 6;

    /// A period and a bit in four runs, seen since the zero of each run.
    fn swing(row: usize) -> f64 {
        let at = |row: usize| (11.3 * std::f64::consts::TAU * row as f64 / (RUNS * POINTS) as f64).sin();
        at(row) - at(row - row % POINTS)
    }

    /// What is found of a recording with a swing of this size, in noise of this correlation.
    fn found(size: f64, phi: f64, seed: u64) -> (f64, Option<Vec<Term>>) {
        let mut model = Columns::new(RUNS * POINTS);
        model.add("unknown", "swing", DMatrix::from_fn(RUNS * POINTS, 1, |row, _| swing(row)), true);
        let mut random = Random::seeded(seed, 0);
        let mut residual = Vec::new();
        for run in 0..RUNS {
            let (zero, mut noise) = (random.normal(), random.normal());
            for point in 0..POINTS {
                residual.push(size * swing(run * POINTS + point) + zero + noise);
                noise = phi * noise + (1.0 - phi * phi).sqrt() * random.normal();
            }
        }
        let evidence = Evidence {
            replicate_group: (0..RUNS * POINTS).map(|row| row % POINTS).collect(),
            shared: (0..RUNS * POINTS).map(|row| row / POINTS).collect(),
            is_robust: true,
            ..independent(residual)
        };
        let linear = Linearised::new(&model);
        let correlation = Search::new(&linear, &evidence, &[]).correlation();
        (correlation, hidden_in_correlation(&linear, &evidence, &[]))
    }

    #[test]
    fn a_swing_is_no_noise_whose_neighbours_resemble_each_other() {
        for seed in 0..5 {
            let (correlation, terms) = found(2.5, 0.0, seed);
            assert!(correlation > 0.3, "{seed}: {correlation}");
            assert_eq!(terms.map(|terms| terms.len()), Some(1), "{seed}");
        }
    }

    #[test]
    fn noise_whose_neighbours_resemble_each_other_hides_nothing() {
        for seed in 0..20 {
            let (correlation, terms) = found(0.0, 0.6, seed);
            assert!(correlation > 0.3 && terms.is_none(), "{seed}: {correlation}");
        }
    }
}
