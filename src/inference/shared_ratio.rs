//! How much of the scatter the data of a group share.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::Evidence;
use super::correlation::{by_group, deviations, likeliest};

/// ρ that is believed before the data: a zero that was read once is as good as any other reading.
const RATIO_BEFORE: f64 = 1.0;
/// What that belief counts, in degrees of freedom.
const BELIEF: f64 = 10.0;
/// Of fewer groups nobody knows which mean is far out; and how far that is, in robust standard
/// deviations.
const FEWEST_GROUPS: usize = 6;
const FAR: f64 = 3.0;

/// Where so large a share of the mean square is shared, zeros scatter three times as far as
/// readings: with so many degrees of freedom within the groups nothing needs to be believed of
/// those.
const CLEARLY: f64 = 0.9;
const ENOUGH: f64 = 20.0;

/// ρ from repeats: the mean product of two deviations of one group, over what the mean square has
/// beyond it.
///
/// Deviations are from the mean of the replicate group, so that nothing that repeats itself counts.
///
/// Beside a correlation the likeliest, drawn towards the same belief.
pub(super) fn shared_ratio(evidence: &Evidence, left: &DVector<f64>, correlation: f64) -> f64 {
    let deviations = deviations(evidence, left);
    if correlation > 0.0 {
        let count = deviations.iter().flatten().count() as f64;
        let (ratio, _) = likeliest(&by_group(evidence, &deviations), correlation);
        return match ratio > CLEARLY / (1.0 - CLEARLY) && count >= ENOUGH {
            true => clearly(ratio, count),
            false => believed(ratio / (1.0 + ratio), 1.0 / (1.0 + ratio), count),
        };
    }
    let (mut square, mut count) = (0.0, 0.0);
    let mut groups: BTreeMap<usize, (f64, f64, f64)> = BTreeMap::new();
    for (row, deviation) in deviations.iter().enumerate() {
        let Some(deviation) = deviation else { continue };
        square += deviation * deviation;
        count += 1.0;
        let (total, squares, members) = groups.entry(evidence.shared[row]).or_default();
        *total += deviation;
        *squares += deviation * deviation;
        *members += 1.0;
    }
    // a step between two runs is no scatter of their zeros: a mean far out counts as far as usual
    let limit = match groups.len() >= FEWEST_GROUPS {
        true => {
            let mut means: Vec<f64> =
                groups.values().map(|(total, _, members)| (total / members).abs()).collect();
            means.sort_by(f64::total_cmp);
            FAR * 1.4826 * means[means.len() / 2]
        }
        false => f64::INFINITY,
    };
    let (mut product, mut pairs, mut within, mut shares) = (0.0, 0.0, 0.0, 0.0);
    for (total, squares, members) in groups.into_values() {
        let mean = total / members;
        within += squares - members * mean * mean;
        shares += 1.0;
        let clipped = mean.clamp(-limit, limit);
        let squares = squares - members * (mean * mean - clipped * clipped);
        product += (clipped * members).powi(2) - squares;
        pairs += members * (members - 1.0);
    }
    if count == 0.0 || pairs == 0.0 || square == 0.0 {
        return RATIO_BEFORE;
    }
    let mean_square = square / count;
    let shared = (product / pairs).clamp(0.0, 0.999 * mean_square);
    let freedom = count - shares;
    if shared > CLEARLY * mean_square && freedom >= ENOUGH && within > 0.0 {
        // what is a small part of the square is no difference of large ones
        return clearly(shared * freedom / within, count);
    }
    let own = mean_square - shared;
    believed(shared, own, count)
}

/// A ρ that `count` data clearly show, beside the belief.
fn clearly(ratio: f64, count: f64) -> f64 {
    (ratio * count + RATIO_BEFORE * BELIEF) / (count + BELIEF)
}

/// ρ of two variances that `count` data show, beside the belief: that counts as [`BELIEF`] data of
/// the same mean square, split as it says.
fn believed(shared: f64, own: f64, count: f64) -> f64 {
    let split = RATIO_BEFORE / (1.0 + RATIO_BEFORE);
    let belief = BELIEF * (shared + own);
    (shared * count + split * belief) / (own * count + (1.0 - split) * belief)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// Twelve runs of fourteen readings, all of the same fourteen loads, whose zeros scatter so many
    /// times as far as the readings.
    fn evidence(times: f64) -> Evidence {
        let mut random = Random::seeded(5, 0);
        let zeros: Vec<f64> = (0..12).map(|_| times * random.normal()).collect();
        let residual = DVector::from_fn(168, |i, _| zeros[i / 14] + random.normal());
        Evidence {
            replicate_group: (0..168).map(|i| i % 14).collect(),
            shared: (0..168).map(|i| i / 14).collect(),
            ..Evidence::new(residual)
        }
    }

    #[test]
    fn zeros_far_apart_leave_the_scatter_of_readings_what_it_is() {
        for times in [0.0, 1.0, 3.0, 10.0, 150.0] {
            let evidence = evidence(times);
            for correlation in [0.0, 0.1] {
                let ratio = shared_ratio(&evidence, &evidence.residual, correlation);
                // the scatter of twelve zeros is known to a fifth, and half of small ones is belief
                let (low, high) = (0.5 * times - 0.2, 1.6 * times + 0.4);
                assert!((low..high).contains(&ratio.sqrt()), "{times} at {correlation}: {}", ratio.sqrt());
            }
        }
    }
}
