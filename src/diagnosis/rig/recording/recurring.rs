//! Displacements that are set again and again.
//!
//! Readings of one setting are far from those of all others beside what they scatter by: their mean
//! is where it was, within s/√n.

use nalgebra::DMatrix;

use super::estimate::{Estimate, most_errors};
use super::multiples::step_of;

/// Settings are as many times as far from each other as readings of one, and more.
const APART: f64 = 5.0;
/// How often one is read, on average.
const READ: usize = 2;
/// Readings of one lie within this share of the largest displacement.
const WITHIN: f64 = 0.02;
/// What share of the readings are of settings at least, where any are.
const MOST: f64 = 0.9;

/// The mean of those near to each, or itself where these are too far apart; nothing where few
/// values recur. Without errors where there are too many settings.
pub fn recurring(values: &[f64]) -> Option<Estimate> {
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let step = step_of(values);
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut groups: Vec<Vec<usize>> = split(&order, values, step)?;
    let mut means = Vec::new();
    while let Some(own) = groups.pop() {
        if let Some(parts) = split(&own, values, step) {
            groups.extend(parts);
        } else if values[own[own.len() - 1]] - values[own[0]] <= WITHIN * largest {
            means.push(own);
        }
    }
    if (means.iter().map(Vec::len).sum::<usize>() as f64) < MOST * values.len() as f64 {
        return None;
    }
    let errors = if means.len() <= most_errors(values.len()) { means.len() } else { 0 };
    let mut all = Estimate { values: values.to_vec(), errors: DMatrix::zeros(values.len(), errors) };
    let (mut squares, mut free) = (0.0, 0.0);
    for own in &means {
        let mean = own.iter().map(|&i| values[i]).sum::<f64>() / own.len() as f64;
        squares += own.iter().map(|&i| (values[i] - mean).powi(2)).sum::<f64>();
        free += own.len() as f64 - 1.0;
        own.iter().for_each(|&i| all.values[i] = mean);
    }
    let variance = if free > 0.0 { squares / free } else { 0.0 };
    // what is always rounded the same way is not known better for being read again
    let rounding = if variance < step * step { step * step / 12.0 } else { 0.0 };
    for (k, own) in means.iter().enumerate().take(errors) {
        let sd = (variance / own.len() as f64 + rounding).sqrt();
        own.iter().for_each(|&i| all.errors[(i, k)] = sd);
    }
    Some(all)
}

/// Parts that are far from each other beside what each is wide, or a step of the display, and of
/// several values each, on average; the fewest such, nothing where there are none. `order` is from
/// the least value to the largest.
fn split(order: &[usize], values: &[f64], step: f64) -> Option<Vec<Vec<usize>>> {
    let count = order.len();
    let at = |k: usize| values[order[k]];
    let gap = |k: usize| at(k + 1) - at(k);
    // parts grow over the least gaps: the other end of the one that begins, or ends, at a value
    let mut gaps: Vec<usize> = (0..count.saturating_sub(1)).collect();
    gaps.sort_by(|&a, &b| gap(a).total_cmp(&gap(b)));
    let (mut first, mut last): (Vec<usize>, Vec<usize>) = ((0..count).collect(), (0..count).collect());
    let (mut widest, mut least) = (step, None);
    for (closed, &k) in gaps.iter().enumerate() {
        // all gaps from this one on are open
        if READ * (count - closed) <= count && gap(k) > 0.0 && gap(k) >= APART * widest {
            least = Some(gap(k));
        }
        let (from, to) = (first[k], last[k + 1]);
        (last[from], first[to]) = (to, from);
        widest = widest.max(at(to) - at(from));
    }
    let least = least?;
    let parts = order.chunk_by(|&a, &b| values[b] - values[a] < least);
    Some(parts.map(<[usize]>::to_vec).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;
    use crate::units::UM;

    fn set(values: &[f64]) -> Vec<f64> {
        let read: Vec<f64> = values.iter().map(|value| value * UM).collect();
        let set = recurring(&read).map(|set| set.values);
        set.unwrap_or(read).iter().map(|u| u / UM).collect()
    }

    #[test]
    fn readings_of_one_setting_are_that_setting() {
        let mut random = Random::seeded(3, 0);
        for noise in [0.05, 1.0] {
            // there, back and beyond, several times, to 0.1 µm
            let places: Vec<f64> =
                (0..96).map(|k: i32| 250.0 * f64::from((k % 16 - 8).abs()) - 1000.0).collect();
            let read: Vec<f64> =
                places.iter().map(|u| ((u + noise * random.normal()) * 10.0).round() / 10.0).collect();
            let set = set(&read);
            let mut known: Vec<u64> = set.iter().map(|u| u.to_bits()).collect();
            known.sort_unstable();
            known.dedup();
            assert_eq!(known.len(), 9);
            assert!(set.iter().zip(&places).all(|(own, place)| (own - place).abs() < noise));
        }
    }

    #[test]
    fn what_does_not_recur_is_as_it_was_read() {
        let mut random = Random::seeded(4, 0);
        // a sweep, two of them far from each other, settings that are read once, and by chance
        let sweep: Vec<f64> = (0..200).map(f64::from).collect();
        let two: Vec<f64> = (0..400).map(|k| f64::from(k) + if k < 200 { 0.0 } else { 5000.0 }).collect();
        let once: Vec<f64> = (1..20).map(|k| 100.0 * f64::from(k)).collect();
        let by_chance: Vec<f64> = (0..200).map(|_| 500.0 * random.normal()).collect();
        for values in [sweep, two, once, by_chance] {
            let set = set(&values);
            assert!(set.iter().zip(&values).all(|(own, value)| (own - value).abs() < 1e-9));
        }
    }

    /// Steps of the display are no settings, but what lies closer together elsewhere is.
    #[test]
    fn settings_may_lie_unevenly() {
        let read = [10.0, 11.0, 10.0, 20.0, 21.0, 20.0, 1000.0, 1001.0, 999.0, 5000.0, 5001.0, 5001.0];
        let set = set(&read);
        let expected = [31.0 / 3.0, 61.0 / 3.0, 1000.0, 15002.0 / 3.0];
        for (k, own) in set.iter().enumerate() {
            assert!((own - expected[k / 3]).abs() < 1e-6, "{set:?}");
        }
    }

    #[test]
    fn too_many_settings_have_no_errors() {
        let errors = |settings: usize| {
            let read: Vec<f64> = (0..4 * settings).map(|k| (k % settings) as f64 * 10.5 * UM).collect();
            recurring(&read).unwrap().errors.ncols()
        };
        assert_eq!((errors(100), errors(1000)), (100, 0));
    }
}
