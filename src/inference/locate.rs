//! Where a mismatch lives: along which of a recording's numbers the residuals are structured.
//!
//! Of residuals r, less their mean, sorted by a covariate that takes other values from datum to
//! datum, the strength is the correlation of neighbours, Σ rᵢ·rᵢ₊₁ / Σ rᵢ²; along a covariate that
//! repeats its values it is the share of the squares that the means of the values explain. z is its
//! distance, in standard deviations, from what the same residuals in random order give.

use nalgebra::DVector;

use crate::inference::{Covariate, Evidence};
use crate::statistics::{Random, mean, standard_deviation};

/// Random orders.
const ORDERS: usize = 100;
/// A covariate repeats its values if it has at least so many data per value.
const PER_VALUE: usize = 3;

/// How structured residuals are along a covariate.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Structure {
    /// 0 for none, 1 for nothing but structure.
    pub strength: f64,
    /// Standard deviations from chance.
    pub z: f64,
}

/// The structure of `residual` along each covariate of the evidence.
pub fn locate(evidence: &Evidence, residual: &DVector<f64>) -> Vec<Structure> {
    let of_index = |(index, covariate): (usize, &Covariate)| along(covariate, residual, index as u64);
    evidence.covariates.iter().enumerate().map(of_index).collect()
}

/// The same along one covariate; `stream` numbers it, so that its random orders are its own.
pub(super) fn along(covariate: &Covariate, residual: &DVector<f64>, stream: u64) -> Structure {
    let mut known: Vec<usize> = (0..residual.len()).filter(|&i| !covariate.values[i].is_nan()).collect();
    known.sort_by(|&a, &b| covariate.values[a].total_cmp(&covariate.values[b]));
    let mut values: Vec<f64> = known.iter().map(|&i| residual[i]).collect();
    let centre = mean(&values).unwrap_or_default();
    values.iter_mut().for_each(|value| *value -= centre);
    let square: f64 = values.iter().map(|v| v * v).sum();
    let groups = groups(&known.iter().map(|&i| covariate.values[i]).collect::<Vec<_>>());
    if square <= 0.0 || groups.len() < 2 {
        return Structure { strength: 0.0, z: 0.0 };
    }
    let strength = |values: &[f64]| match PER_VALUE * groups.len() <= values.len() {
        true => {
            let of_group = |group: &std::ops::Range<usize>| {
                values[group.clone()].iter().sum::<f64>().powi(2) / group.len() as f64
            };
            groups.iter().map(of_group).sum::<f64>() / square
        }
        false => values.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / square,
    };
    let found = strength(&values);
    let mut random = Random::seeded(0, stream);
    let by_chance: Vec<f64> = (0..ORDERS)
        .map(|_| {
            for last in (1..values.len()).rev() {
                values.swap(last, random.index(last + 1));
            }
            strength(&values)
        })
        .collect();
    let (centre, spread) = (mean(&by_chance), standard_deviation(&by_chance));
    let z = match (centre, spread) {
        (Some(centre), Some(spread)) if spread > 0.0 => (found - centre) / spread,
        _ => 0.0,
    };
    Structure { strength: found, z }
}

/// Stretches of equal values.
fn groups(sorted: &[f64]) -> Vec<std::ops::Range<usize>> {
    let mut groups: Vec<std::ops::Range<usize>> = Vec::new();
    for (i, value) in sorted.iter().enumerate() {
        match groups.last_mut() {
            Some(last) if sorted[last.start] == *value => last.end = i + 1,
            _ => groups.push(i..i + 1),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covariate(values: Vec<f64>) -> Covariate {
        Covariate { variable: crate::inference::Variable::Order, values }
    }

    #[test]
    fn structure_is_found_along_what_it_follows_and_nowhere_else() {
        let mut random = Random::seeded(1, 0);
        let angle: Vec<f64> = (0..200).map(|_| random.uniform(0.0, 6.0)).collect();
        let residual =
            DVector::from_iterator(200, angle.iter().map(|a| (3.0 * a).sin() + 0.3 * random.normal()));
        let along_angle = along(&covariate(angle.clone()), &residual, 0);
        assert!(along_angle.z > 8.0 && along_angle.strength > 0.6, "{along_angle:?}");
        let in_order = along(&covariate((0..200).map(f64::from).collect()), &residual, 1);
        assert!(in_order.z.abs() < 3.0, "{in_order:?}");
        // two halves, one of them unknown
        let phase = angle.iter().map(|a| if (3.0 * a).sin() > 0.0 { 1.0 } else { f64::NAN }).collect();
        assert_eq!(along(&covariate(phase), &residual, 2).z, 0.0, "nothing differs within one value");
        let phase = angle.iter().map(|a| (3.0 * a).sin().signum()).collect();
        assert!(along(&covariate(phase), &residual, 3).z > 20.0);
    }
}
