//! Data that are far off: single ones are remarks, many of them are something that nobody named.

use std::collections::BTreeMap;

use super::scatter::Suspect;
use crate::inference::Evidence;

/// True where so many data are far off that they are no single ones: of all, of one series, one
/// after the other, at one moment, or all repeats of one reading.
pub fn are_many(evidence: &Evidence, suspects: &[Suspect]) -> bool {
    suspects.len() > at_most(evidence.recorded)
        || are_of_one_series(evidence, suspects)
        || are_together(evidence, suspects)
        || are_at_once(evidence, suspects)
        || are_repeats(evidence, suspects)
}

/// Of so many data that many may be far off by themselves: a tenth, three at least.
fn at_most(count: usize) -> usize {
    (count / 10).max(3)
}

/// True where more than a quarter of the data of one series are far off, and more than five: a
/// display that errs is read along some lines only.
fn are_of_one_series(evidence: &Evidence, suspects: &[Suspect]) -> bool {
    const SHARE: usize = 4;
    const FEW: usize = 5;
    // how many, and how many of them are far off
    let mut all: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
    for &series in evidence.series.iter().take(evidence.recorded) {
        all.entry(series).or_default().0 += 1;
    }
    for suspect in suspects {
        all.entry(evidence.series[suspect.datum]).or_default().1 += 1;
    }
    all.values().any(|&(count, far)| far > FEW.max(count / SHARE))
}

/// True where neighbours of a run are far off to one side: so many that they are no single ones, or
/// the run as a whole, or as many of it, which is half of it.
fn are_together(evidence: &Evidence, suspects: &[Suspect]) -> bool {
    const TOGETHER: usize = 3;
    let side: BTreeMap<usize, bool> = suspects.iter().map(|s| (s.datum, s.sigma > 0.0)).collect();
    let mut runs: BTreeMap<usize, Vec<Option<bool>>> = BTreeMap::new();
    for (datum, &run) in evidence.shared.iter().enumerate().take(evidence.recorded) {
        runs.entry(run).or_default().push(side.get(&datum).copied());
    }
    runs.values().any(|run| {
        let is_half = |side: bool| {
            let count = run.iter().filter(|own| **own == Some(side)).count();
            count >= TOGETHER && 2 * count >= run.len()
        };
        let mut of_one_side = run.chunk_by(|a, b| a == b).filter(|part| part[0].is_some());
        of_one_side.any(|part| part.len() >= TOGETHER || (part.len() > 1 && part.len() == run.len()))
            || is_half(true)
            || is_half(false)
    })
}

/// True where all sensors, two at least, are far off at one moment: that is no mistake of one of
/// them, but something that happened to the rig.
fn are_at_once(evidence: &Evidence, suspects: &[Suspect]) -> bool {
    // how many, and how many of them are far off
    let mut moments: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
    for &instant in evidence.instant.iter().take(evidence.recorded) {
        moments.entry(instant).or_default().0 += 1;
    }
    for suspect in suspects {
        moments.entry(evidence.instant[suspect.datum]).or_default().1 += 1;
    }
    moments.values().any(|&(count, far)| far > 1 && far == count)
}

/// True where all repeats of a reading are as far off, three at least, or two where they are half
/// of all that is far off: what repeats agree on is no mistake of one of them.
fn are_repeats(evidence: &Evidence, suspects: &[Suspect]) -> bool {
    const SURE: usize = 3;
    // none of them is farther off than so many times the nearest
    const AS_FAR: f64 = 2.0;
    let mut groups: BTreeMap<usize, (usize, Vec<f64>)> = BTreeMap::new();
    for &group in evidence.replicate_group.iter().take(evidence.recorded) {
        groups.entry(group).or_default().0 += 1;
    }
    for suspect in suspects {
        if let Some(&group) = evidence.replicate_group.get(suspect.datum) {
            groups.entry(group).or_default().1.push(suspect.sigma);
        }
    }
    let agree =
        |far: &[f64]| far.iter().all(|a| far.iter().all(|b| a * b > 0.0 && a.abs() < AS_FAR * b.abs()));
    let whole = || groups.values().filter(|(count, far)| *count > 1 && far.len() == *count && agree(far));
    let in_whole: usize = whole().map(|(count, _)| count).sum();
    whole().any(|(count, _)| *count >= SURE) || (in_whole > 0 && 2 * in_whole >= suspects.len())
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;

    /// 120 data of four series in 30 runs, one of each in a run; these are far off, by turns.
    fn are_many_of(suspects: impl Iterator<Item = usize>) -> bool {
        let mut evidence = Evidence::new(DVector::zeros(120));
        evidence.series = (0..120).map(|datum| datum % 4).collect();
        evidence.shared = (0..120).map(|datum| datum / 4).collect();
        let sign = |k: usize| if k.is_multiple_of(2) { 6.0 } else { -6.0 };
        let suspects: Vec<Suspect> =
            suspects.enumerate().map(|(k, datum)| Suspect { datum, sigma: sign(k) }).collect();
        are_many(&evidence, &suspects)
    }

    #[test]
    fn a_third_of_one_series_are_no_single_ones() {
        // ten over all series are a few; so are seven of one
        assert!(!are_many_of((0..10).map(|k| 11 * k)));
        assert!(!are_many_of((0..7).map(|k| 4 * k)));
        // ten of one series are a third of it
        assert!(are_many_of((0..10).map(|k| 4 * k)));
        // and thirteen of all are too many
        assert!(are_many_of((0..13).map(|k| 9 * k)));
    }

    #[test]
    fn neighbours_that_are_off_to_one_side_are_no_single_ones() {
        let mut evidence = Evidence::new(DVector::zeros(40));
        evidence.shared = vec![0; 40];
        let far = |data: &[(usize, f64)]| {
            let suspects: Vec<Suspect> =
                data.iter().map(|&(datum, sigma)| Suspect { datum, sigma }).collect();
            are_many(&evidence, &suspects)
        };
        assert!(far(&[(7, 5.0), (8, 6.0), (9, 5.0)]));
        assert!(!far(&[(7, 5.0), (8, -6.0), (9, 5.0)]) && !far(&[(7, 5.0), (9, 6.0), (11, 5.0)]));
        // most of a run, with one between them that is just not far enough
        evidence.shared = (0..40).map(|datum| datum / 5).collect();
        let far = |data: &[(usize, f64)]| {
            let suspects: Vec<Suspect> =
                data.iter().map(|&(datum, sigma)| Suspect { datum, sigma }).collect();
            are_many(&evidence, &suspects)
        };
        assert!(far(&[(10, 5.0), (11, 6.0), (13, 5.0)]));
        assert!(!far(&[(10, 5.0), (11, -6.0), (13, 5.0)]) && !far(&[(8, 5.0), (11, 6.0), (13, 5.0)]));
    }

    #[test]
    fn sensors_that_are_off_at_one_moment_are_no_single_ones() {
        let mut evidence = Evidence::new(DVector::zeros(60));
        let suspects = [30, 31, 32].map(|datum| Suspect { datum, sigma: [6.0, -7.0][datum % 2] });
        assert!(!are_many(&evidence, &suspects));
        // three sensors read at each moment
        evidence.instant = (0..60).map(|datum| datum / 3).collect();
        assert!(are_many(&evidence, &suspects));
        assert!(!are_many(&evidence, &suspects[..2]));
    }

    #[test]
    fn what_all_repeats_show_is_no_single_one() {
        let far = |data: &[(usize, f64)], repeats: usize| {
            let mut evidence = Evidence::new(DVector::zeros(120));
            // each run goes through the same readings
            evidence.replicate_group = (0..120).map(|datum| datum % (120 / repeats)).collect();
            evidence.shared = (0..120).map(|datum| datum / (120 / repeats)).collect();
            let suspects: Vec<Suspect> =
                data.iter().map(|&(datum, sigma)| Suspect { datum, sigma }).collect();
            are_many(&evidence, &suspects)
        };
        assert!(far(&[(7, 5.0), (47, 6.0), (87, 5.0)], 3));
        assert!(!far(&[(7, 5.0), (47, -6.0), (87, 5.0)], 3) && !far(&[(7, 5.0), (47, 6.0), (90, 5.0)], 3));
        // nor are they where one is much farther off
        assert!(!far(&[(7, 5.0), (47, 6.0), (87, 15.0)], 3) && !far(&[(7, 5.0), (67, 15.0)], 2));
        // two may be chance, unless they are all, or half
        assert!(far(&[(7, 5.0), (67, 6.0)], 2));
        assert!(far(&[(7, 5.0), (67, 6.0), (20, 5.0), (90, 5.0)], 2));
        assert!(!far(&[(7, 5.0), (67, 6.0), (20, 5.0), (90, 5.0), (30, -5.0)], 2));
    }
}
