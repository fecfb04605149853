//! What was set, row by row: the load that hung, or the displacement that was imposed.
//!
//! A displacement that is set again and again is read a little otherwise each time. Whatever
//! follows it from reading to reading (a wave of the step between two settings, a curve with a kink
//! at each) follows the scatter of these readings, and takes it off the loads. So readings of one
//! setting count as that setting wherever the rod is not its straight line: their mean.

use std::collections::BTreeMap;

use super::multiples::step_of;
use crate::rig::readings::{Axis, Driven, Reading};

/// Settings are as many times as far from each other as readings of one, and more.
const APART: f64 = 5.0;
/// How often one is read, on average.
const READ: usize = 2;
/// Readings of one lie within this share of the largest displacement.
const WITHIN: f64 = 0.005;

/// Of each row along the positive axis: the load, N, or the displacement, m, where it was read.
pub fn settings(rows: &[Reading], driven: Driven) -> Vec<Option<f64>> {
    if driven == Driven::Load {
        return rows.iter().map(|row| Some(row.signed_load())).collect();
    }
    let read = |row: &Reading| row.offset[row.direction.axis.index()];
    let mut settings: Vec<Option<f64>> = rows.iter().map(read).collect();
    // of each axis and the place where its displacement is read
    let mut places: BTreeMap<(Axis, Option<u64>), Vec<usize>> = BTreeMap::new();
    for (i, row) in rows.iter().enumerate().filter(|(i, _)| settings[*i].is_some()) {
        places.entry((row.direction.axis, row.read_station.map(f64::to_bits))).or_default().push(i);
    }
    for own in places.into_values() {
        let values: Vec<f64> = own.iter().filter_map(|&i| settings[i]).collect();
        for (i, set) in own.into_iter().zip(recurring(&values)) {
            settings[i] = Some(set);
        }
    }
    settings
}

/// The mean of those near to each, where they recur; else itself.
fn recurring(values: &[f64]) -> Vec<f64> {
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let step = step_of(values);
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut set = values.to_vec();
    let mut groups: Vec<Vec<usize>> = split(&order, values, step).unwrap_or_default();
    while let Some(own) = groups.pop() {
        if let Some(parts) = split(&own, values, step) {
            groups.extend(parts);
        } else if values[own[own.len() - 1]] - values[own[0]] <= WITHIN * largest {
            let mean = own.iter().map(|&i| values[i]).sum::<f64>() / own.len() as f64;
            own.iter().for_each(|&i| set[i] = mean);
        }
    }
    set
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
    use crate::rig::readings::Readings;
    use crate::statistics::Random;
    use crate::units::UM;

    fn set(values: &[f64]) -> Vec<f64> {
        recurring(&values.iter().map(|value| value * UM).collect::<Vec<_>>()).iter().map(|u| u / UM).collect()
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
        let two: Vec<f64> = (0..200).map(|k| f64::from(k) + if k < 100 { 0.0 } else { 5000.0 }).collect();
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
    fn loads_are_as_they_hang_and_each_axis_has_settings_of_its_own() {
        let text = "axis,load_n,dy_um,dz_um\ny,1,10,\n-y,2,-20,\nz,3,,10.5\n";
        let rows = Readings::from_text("f", text).unwrap().rows;
        assert_eq!(settings(&rows, Driven::Load), [Some(1.0), Some(-2.0), Some(3.0)]);
        let read = settings(&rows, Driven::Displacement);
        let read: Vec<_> = read.into_iter().map(|own| own.map(|u| (u / UM * 10.0).round() / 10.0)).collect();
        assert_eq!(read, [Some(10.0), Some(-20.0), Some(10.5)]);
    }
}
