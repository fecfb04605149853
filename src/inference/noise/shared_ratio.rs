//! How much of the scatter the data of a group share.

use std::collections::BTreeMap;

use nalgebra::DVector;

use crate::inference::Evidence;
use crate::inference::noise::correlation::{by_group, deviations_among, likeliest};
use crate::statistics::median;

/// ρ that is believed before the data: a zero that was read once is as good as any other reading.
const RATIO_BEFORE: f64 = 1.0;
/// What that belief counts, in degrees of freedom.
const BELIEF: f64 = 10.0;
/// Of fewer groups nobody knows which mean is far out; and how far that is, in robust standard
/// deviations.
const FEWEST_GROUPS: usize = 6;
const FAR: f64 = 3.0;
/// What moves the mean of its repeats, which makes others far out: so far from their median, one in
/// so many at most.
const FARTHER: f64 = 8.0;
const ONE_IN: usize = 3;

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
pub fn shared_ratio(evidence: &Evidence, left: &DVector<f64>, correlation: f64) -> f64 {
    let far_out = FarOut::of(evidence, left);
    let deviations =
        deviations_among(evidence, left, |row| !far_out.groups.contains_key(&evidence.shared[row]));
    let squares = Squares::of(evidence, &deviations, &far_out);
    let clear = || squares.clear().filter(|_| squares.is_clear_without_farthest(evidence, left));
    if correlation > 0.0 {
        let (ratio, _) = likeliest(&by_group(evidence, &deviations), correlation);
        return match ratio > CLEARLY / (1.0 - CLEARLY) && clear().is_some() {
            true => clearly(ratio, squares.count),
            false => believed(ratio / (1.0 + ratio), 1.0 / (1.0 + ratio), squares.count),
        };
    }
    if squares.count == 0.0 || squares.pairs == 0.0 || squares.square == 0.0 {
        return RATIO_BEFORE;
    }
    match clear() {
        Some(ratio) => clearly(ratio, squares.count),
        None => believed(squares.shared(), squares.mean() - squares.shared(), squares.count),
    }
}

/// Sums over the groups of deviations.
#[derive(Default)]
struct Squares {
    count: f64,
    square: f64,
    /// Products of two deviations of one group, and how many pairs there are.
    product: f64,
    pairs: f64,
    /// Squares about the means of the groups, and how many groups there are.
    within: f64,
    groups: f64,
    /// The group whose mean is the farthest out.
    farthest: Option<usize>,
}

impl Squares {
    fn of(evidence: &Evidence, deviations: &[Option<f64>], far_out: &FarOut) -> Squares {
        let mut all = Squares::default();
        let mut groups: BTreeMap<usize, (f64, f64, f64)> = BTreeMap::new();
        for (row, deviation) in deviations.iter().enumerate() {
            let Some(deviation) = deviation else { continue };
            let (total, squares, members) = groups.entry(evidence.shared[row]).or_default();
            *total += deviation;
            *squares += deviation * deviation;
            *members += 1.0;
        }
        // a step between two runs is no scatter of their zeros: a mean far out counts as far as
        // usual
        let limit = match groups.len() >= FEWEST_GROUPS {
            true => {
                let means: Vec<f64> =
                    groups.values().map(|(total, _, members)| (total / members).abs()).collect();
                FAR * 1.4826 * median(&means).unwrap_or_default()
            }
            false => f64::INFINITY,
        };
        let mut far = 0.0;
        for (group, (total, squares, members)) in groups {
            let mean = total / members;
            all.add(mean, squares - members * mean * mean, members, limit);
            if mean.abs() > far {
                (far, all.farthest) = (mean.abs(), Some(group));
            }
        }
        let limit = far_out.limit;
        far_out.groups.values().for_each(|&(within, members)| all.add(limit, within, members, limit));
        all
    }

    /// A group of so many members with its mean and its squares about it; how far off the mean
    /// counts.
    fn add(&mut self, mean: f64, within: f64, members: f64, limit: f64) {
        let clipped = mean.clamp(-limit, limit);
        self.count += members;
        self.square += within + members * mean * mean;
        self.within += within;
        self.groups += 1.0;
        self.product += (clipped * members).powi(2) - within - members * clipped * clipped;
        self.pairs += members * (members - 1.0);
    }

    fn mean(&self) -> f64 {
        self.square / self.count
    }

    fn shared(&self) -> f64 {
        (self.product / self.pairs).clamp(0.0, 0.999 * self.mean())
    }

    /// ρ where nearly all of the square is shared: what is a small part of it is no difference of
    /// large ones.
    fn clear(&self) -> Option<f64> {
        let freedom = self.count - self.groups;
        let is_clear = self.pairs > 0.0
            && self.shared() > CLEARLY * self.mean()
            && freedom >= ENOUGH
            && self.within > 0.0;
        is_clear.then(|| self.shared() * freedom / self.within)
    }

    /// False where it is one group that is far out: that is no scatter of zeros but one of them.
    fn is_clear_without_farthest(&self, evidence: &Evidence, left: &DVector<f64>) -> bool {
        let rows: Vec<usize> =
            (0..left.len()).filter(|&row| Some(evidence.shared[row]) != self.farthest).collect();
        let rest = evidence.part(&rows);
        let left = left.select_rows(&rows);
        Squares::of(&rest, &deviations_among(&rest, &left, |_| true), &FarOut::default()).clear().is_some()
    }
}

/// Groups that are far out: not by the mean of their repeats, of which one of three moves the other
/// two as well, but by the median.
#[derive(Default)]
struct FarOut {
    /// How far a mean may be off.
    limit: f64,
    /// Squares of each about its mean, and its members.
    groups: BTreeMap<usize, (f64, f64)>,
}

impl FarOut {
    fn of(evidence: &Evidence, left: &DVector<f64>) -> FarOut {
        let mut repeats: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let counting = evidence.replicate_group.iter().enumerate().filter(|(row, _)| evidence.counts(*row));
        counting.for_each(|(row, &group)| repeats.entry(group).or_default().push(row));
        let mut groups: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        for rows in repeats.values().filter(|rows| rows.len() > 1) {
            let centre = median(&rows.iter().map(|&row| left[row]).collect::<Vec<_>>()).unwrap_or_default();
            for &row in rows {
                let off = (left[row] - centre) * evidence.weight[row].sqrt();
                groups.entry(evidence.shared[row]).or_default().push(off);
            }
        }
        if groups.len() < FEWEST_GROUPS {
            return FarOut::default();
        }
        let mean = |own: &[f64]| own.iter().sum::<f64>() / own.len() as f64;
        let means: Vec<f64> = groups.values().map(|own| mean(own).abs()).collect();
        let limit = FARTHER * 1.4826 * median(&means).unwrap_or_default();
        let all = groups.len();
        let far = groups.into_iter().filter(|(_, own)| mean(own).abs() > limit);
        let with_squares = far.map(|(group, own)| {
            let within = own.iter().map(|off| (off - mean(&own)).powi(2)).sum();
            (group, (within, own.len() as f64))
        });
        let far: BTreeMap<usize, (f64, f64)> = with_squares.collect();
        match far.len() * ONE_IN > all {
            true => FarOut::default(),
            false => FarOut { limit, groups: far },
        }
    }
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

    /// Twelve runs of fourteen readings, all of the same fourteen loads, whose zeros scatter so
    /// many times as far as the readings.
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

    /// Two sensors in three runs each: one zero of the six is off, and moves the mean of its
    /// repeats.
    #[test]
    fn one_zero_of_three_that_is_far_out_is_no_scatter_of_zeros() {
        let ratio = |off: f64| {
            let mut random = Random::seeded(7, 0);
            let zeros: Vec<f64> =
                (0..6).map(|run| 0.5 * random.normal() + if run == 5 { off } else { 0.0 }).collect();
            let residual = DVector::from_fn(102, |i, _| zeros[i / 17] + random.normal());
            let evidence = Evidence {
                replicate_group: (0..102).map(|i| i / 51 * 17 + i % 17).collect(),
                shared: (0..102).map(|i| i / 17).collect(),
                ..Evidence::new(residual)
            };
            shared_ratio(&evidence, &evidence.residual, 0.0).sqrt()
        };
        assert!(ratio(0.0) < 1.0 && ratio(17.0) < 4.0, "{} {}", ratio(0.0), ratio(17.0));
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
