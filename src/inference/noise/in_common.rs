//! Which errors neighbours have in common, found in what is left, and whether they wander.
//!
//! ```text
//! ln p(r) = ln |W| − ½·ln |NᵀWᵀWN| − ½·ν·ln |M·W·r|²     N the nuisance, W as in `correlated_noise.rs`
//! ```
//!
//! the restricted likelihood of what a hypothesis leaves (H. D. Patterson, R. Thompson,
//! *Biometrika* 58 (1971) 545–554), for shares a and lengths l.

use nalgebra::DVector;

use crate::inference::Evidence;
use crate::inference::noise::correlated_noise::CorrelatedNoise;
use crate::inference::noise::whitening::Whitening;
use crate::parallel::in_parallel;

/// Shares a and lengths l, in places of the course, that are tried.
const SHARES: [f64; 6] = [0.2, 0.35, 0.5, 0.7, 0.85, 1.0];
const LENGTHS: [f64; 5] = [0.7, 1.4, 2.8, 5.5, 11.0];
/// A length is at most this share of its course. What goes on for longer, or over more than some
/// ten poses, is no scatter.
const LONGEST: f64 = 0.15;
/// Lengths of what is no scatter, but walks along its course, and the ln odds from which on it
/// does: it is not left to errors in common.
const TOO_LONG: ([f64; 3], f64) = ([22.0, 44.0, 88.0], 1.5);
/// What wanders: this share of the variance at least, over more than this length. Noise of a
/// laboratory is a first-order autoregression of 0.2 to 0.6, that is over 0.6 to 2 places.
const WANDERS: (f64, f64) = (0.5, 2.8);
/// Ln of the odds from which on errors hang together, and from which on they wander.
pub const WORTH: f64 = 3.0;
/// Fewer data say nothing.
const FEWEST: usize = 60;

/// The likeliest errors in common of what is left; `None` where independent ones are as likely.
pub fn likeliest(evidence: &Evidence, left: &DVector<f64>) -> Option<CorrelatedNoise> {
    let (log_likelihood, best) = best_of(evidence, left, &LENGTHS, LONGEST, &SHARES)?;
    (log_likelihood > restricted(evidence, left, None) + WORTH).then_some(best)
}

/// True where what is left goes on for longer than any scatter.
pub fn walks(evidence: &Evidence, left: &DVector<f64>) -> bool {
    let (lengths, ln_odds) = TOO_LONG;
    let ln_of = |lengths: &[f64], longest: f64| Some(best_of(evidence, left, lengths, longest, &SHARES)?.0);
    match (ln_of(&lengths, 1.0), ln_of(&LENGTHS, LONGEST)) {
        (Some(walk), Some(scatter)) => walk > scatter + ln_odds,
        _ => false,
    }
}

/// The errors in common of what wanders together for longer than the scatter of a laboratory does,
/// with half of the variance at least; `None` where shorter ones, or none, are about as likely.
///
/// A little of long duration is what every recording has; most of it is something that moves.
pub fn wandering(evidence: &Evidence, left: &DVector<f64>) -> Option<CorrelatedNoise> {
    let (share, length) = WANDERS;
    let (short, long): (Vec<f64>, Vec<f64>) =
        LENGTHS.into_iter().chain(TOO_LONG.0).partition(|own| *own <= length);
    let much: Vec<f64> = SHARES.into_iter().filter(|own| *own >= share).collect();
    let (wanders, best) = best_of(evidence, left, &long, 1.0, &much)?;
    let scatters = best_of(evidence, left, &short, 1.0, &SHARES)?.0.max(restricted(evidence, left, None));
    (wanders > scatters + WORTH).then_some(best)
}

/// The likeliest errors in common of such lengths, at most of a share `longest` of the course, with
/// ln of the likelihood; `None` of too few data.
fn best_of(
    evidence: &Evidence,
    left: &DVector<f64>,
    lengths: &[f64],
    longest: f64,
    shares: &[f64],
) -> Option<(f64, CorrelatedNoise)> {
    let places = || evidence.courses.iter().flatten().map(|(_, place)| *place);
    if places().count() < FEWEST {
        return None;
    }
    let extent = places().fold(f64::NEG_INFINITY, f64::max) - places().fold(f64::INFINITY, f64::min);
    let lengths = lengths.iter().filter(|length| **length <= longest * extent);
    let all: Vec<CorrelatedNoise> = lengths
        .flat_map(|&length| shares.iter().map(move |&share| CorrelatedNoise { share, length }))
        .collect();
    let tried = in_parallel(all.len(), |k| (restricted(evidence, left, Some(all[k])), all[k]));
    tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0))
}

/// ln p(r), the restricted likelihood of what is left.
fn restricted(evidence: &Evidence, left: &DVector<f64>, correlated_noise: Option<CorrelatedNoise>) -> f64 {
    let whitening = Whitening::new(&Evidence { correlated_noise, ..evidence.clone() }, left);
    let square = whitening.apply(left).norm_squared().max(f64::MIN_POSITIVE);
    whitening.log_jacobian() - 0.5 * whitening.degrees_of_freedom as f64 * square.ln()
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::inference::tests::independent;
    use crate::statistics::Random;

    const COUNT: usize = 120;

    /// A course of such errors.
    fn evidence(residual: DVector<f64>) -> Evidence {
        let nuisance = DMatrix::from_element(residual.len(), 1, 1.0);
        let courses = (0..residual.len()).map(|row| Some((0, row as f64))).collect();
        Evidence { nuisance, courses, ..independent(residual.as_slice().to_vec()) }
    }

    /// Errors of which such a share of the variance goes on for such a length.
    fn errors(seed: u64, share: f64, length: f64) -> DVector<f64> {
        let (mut random, carried) = (Random::seeded(seed, 4), (-1.0 / length).exp());
        let mut slow = random.normal();
        DVector::from_fn(COUNT, |_, _| {
            slow = carried * slow + (1.0 - carried * carried).sqrt() * random.normal();
            share.sqrt() * slow + (1.0 - share).sqrt() * random.normal()
        })
    }

    #[test]
    fn share_and_length_are_found_and_independent_errors_have_none() {
        for seed in 0..10 {
            let evidence = evidence(errors(seed, 0.7, 5.0));
            let found = likeliest(&evidence, &evidence.residual).unwrap();
            assert!(found.share >= 0.35 && (1.4..=11.0).contains(&found.length), "{seed} {found:?}");
            assert_eq!(likeliest(&evidence, &errors(seed + 100, 0.0, 1.0)), None, "{seed}");
        }
    }

    /// A walk goes on for too long to be scatter.
    #[test]
    fn a_walk_is_nothing_that_errors_have_in_common() {
        let walks = (0..20).filter(|&seed| {
            let mut random = Random::seeded(seed, 6);
            let mut slow = 0.0;
            let left = DVector::from_fn(COUNT, |_, _| {
                slow += random.normal();
                slow + random.normal()
            });
            walks(&evidence(left.clone()), &left)
        });
        // of a single coordinate half of them
        let count = walks.count();
        assert!(count >= 9, "{count}");
    }

    /// Neither the noise of a laboratory nor a little that goes on for long.
    #[test]
    fn most_of_it_over_many_data_wanders_and_what_a_laboratory_has_does_not() {
        let wandering = |share: f64, length: f64| {
            let of_seed = |&seed: &u64| {
                let left = errors(seed, share, length);
                wandering(&evidence(left.clone()), &left).is_some()
            };
            (0..40).filter(of_seed).count()
        };
        // over 2 data: an autoregression of 0.6
        for (share, length) in [(0.0, 1.0), (1.0, 0.7), (1.0, 2.0), (0.5, 2.0), (0.2, 10.0)] {
            assert!(wandering(share, length) <= 1, "{share} {length}: {}", wandering(share, length));
        }
        // of a single coordinate most of them
        assert!(wandering(0.8, 12.0) >= 20, "{}", wandering(0.8, 12.0));
    }
}
