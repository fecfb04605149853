//! What was set, row by row: the load that hung, or the displacement that was imposed.
//!
//! A displacement that is set again and again is read a little otherwise each time. Whatever
//! follows it from reading to reading (a wave of the step between two settings, a curve with a kink
//! at each) follows the scatter of these readings, and takes it off the loads. So readings of one
//! setting count as that setting, their mean, unless the loads follow each of them, which was
//! imposed then:
//!
//! ```text
//! f = r·k·e     e, f: the changes of displacement and load from one visit of a setting to the next
//!               that came from the same other setting;  k: the stiffness;  r = 1 or 0
//! ```

use std::collections::BTreeMap;

use super::multiples::step_of;
use crate::rig::readings::{Axis, Driven, Reading};

/// Settings are as many times as far from each other as readings of one, and more.
const APART: f64 = 5.0;
/// How often one is read, on average.
const READ: usize = 2;
/// Readings of one lie within this share of the largest displacement.
const WITHIN: f64 = 0.005;
/// What share of the readings are of settings at least, where any are.
const MOST: f64 = 0.9;
/// The r beyond which loads follow each reading, and how well it is known at least.
const FOLLOWS: f64 = 0.5;
const KNOWN: f64 = 0.25;

/// What was set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Along the positive axis: a load, N, or a displacement, m.
    pub value: f64,
    /// Standard deviation of a mean, which all its readings share; 0 of what was read once.
    pub sd: f64,
}

impl Setting {
    pub fn as_read(value: f64) -> Setting {
        Setting { value, sd: 0.0 }
    }
}

/// Of each row; of a displacement where it was read.
pub fn settings(rows: &[Reading], driven: Driven) -> Vec<Option<Setting>> {
    if driven == Driven::Load {
        return rows.iter().map(|row| Some(Setting::as_read(row.signed_load()))).collect();
    }
    let read = |row: &Reading| row.offset[row.direction.axis.index()];
    let mut settings: Vec<Option<Setting>> = rows.iter().map(|row| read(row).map(Setting::as_read)).collect();
    // of each axis and the place where its displacement is read
    let mut places: BTreeMap<(Axis, Option<u64>), Vec<usize>> = BTreeMap::new();
    for (i, row) in rows.iter().enumerate().filter(|(_, row)| read(row).is_some()) {
        places.entry((row.direction.axis, row.read_station.map(f64::to_bits))).or_default().push(i);
    }
    for own in places.into_values() {
        let place = Place::of(rows, in_order(rows, &own));
        if let Some(means) = recurring(&place.displacement).filter(|means| !place.follows(means)) {
            place.rows.iter().zip(means).for_each(|(&i, mean)| settings[i] = Some(mean));
        }
    }
    settings
}

/// Rows session by session and trial by trial, in the order of their times, or as they stand.
fn in_order(rows: &[Reading], own: &[usize]) -> Vec<usize> {
    let mut courses: BTreeMap<(Option<&str>, Option<&str>), Vec<usize>> = BTreeMap::new();
    for &i in own {
        courses.entry((rows[i].session.as_deref(), rows[i].trial.as_deref())).or_default().push(i);
    }
    let of_course = |mut course: Vec<usize>| {
        if course.iter().all(|&i| rows[i].time.is_some()) {
            let time = |i: usize| rows[i].time.unwrap_or_default();
            course.sort_by(|&a, &b| time(a).total_cmp(&time(b)));
        }
        course
    };
    courses.into_values().flat_map(of_course).collect()
}

/// Displacements along an axis that were read at one place, in their order, and their loads.
struct Place {
    rows: Vec<usize>,
    displacement: Vec<f64>,
    load: Vec<f64>,
}

impl Place {
    fn of(readings: &[Reading], rows: Vec<usize>) -> Place {
        let axis = |i: usize| readings[i].direction.axis.index();
        Place {
            displacement: rows.iter().filter_map(|&i| readings[i].offset[axis(i)]).collect(),
            load: rows.iter().map(|&i| readings[i].signed_load()).collect(),
            rows,
        }
    }

    /// Do the loads follow each reading of a setting?
    fn follows(&self, means: &[Setting]) -> bool {
        let mut last: BTreeMap<[Option<u64>; 2], usize> = BTreeMap::new();
        let (mut visits, mut before) = (Vec::new(), None);
        for (k, mean) in means.iter().enumerate() {
            let at = Some(mean.value.to_bits());
            if let Some(other) = last.insert([before, at], k) {
                let change = |values: &[f64]| values[k] - values[other];
                visits.push((change(&self.displacement), change(&self.load)));
            }
            before = at;
        }
        let all: Vec<(f64, f64)> = self.displacement.iter().copied().zip(self.load.iter().copied()).collect();
        let (Some(own), Some(all)) = (Line::of(&visits), Line::of(&all)) else { return false };
        own.sd <= KNOWN * all.slope.abs() && own.slope / all.slope > FOLLOWS
    }
}

/// A straight line through points, and the standard deviation of its slope.
struct Line {
    slope: f64,
    sd: f64,
}

impl Line {
    /// Nothing where the points do not say.
    fn of(points: &[(f64, f64)]) -> Option<Line> {
        const NUMBERS: f64 = 2.0;
        let count = points.len() as f64;
        let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), own| (x + own.0 / count, y + own.1 / count));
        let sum = |product: fn(f64, f64) -> f64| {
            points.iter().map(|own| product(own.0 - x, own.1 - y)).sum::<f64>()
        };
        let (xx, xy, yy) = (sum(|x, _| x * x), sum(|x, y| x * y), sum(|_, y| y * y));
        let slope = xy / xx;
        let sd = ((yy - slope * xy).max(0.0) / (count - NUMBERS) / xx).sqrt();
        (count > NUMBERS && slope.is_finite() && sd.is_finite()).then_some(Line { slope, sd })
    }
}

/// The mean of those near to each, or itself where these are too far apart; nothing where no value
/// recurs.
fn recurring(values: &[f64]) -> Option<Vec<Setting>> {
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let step = step_of(values);
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut set: Vec<Setting> = values.iter().copied().map(Setting::as_read).collect();
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
    let mean = |own: &[usize]| own.iter().map(|&i| values[i]).sum::<f64>() / own.len() as f64;
    let (mut squares, mut free) = (0.0, 0.0);
    for own in &means {
        let value = mean(own);
        squares += own.iter().map(|&i| (values[i] - value).powi(2)).sum::<f64>();
        free += own.len() as f64 - 1.0;
        own.iter().for_each(|&i| set[i].value = value);
    }
    let variance = if free > 0.0 { squares / free } else { 0.0 };
    // what is always rounded the same way is not known better for being read again
    let rounding = if variance < step * step { step * step / 12.0 } else { 0.0 };
    for own in &means {
        let sd = (variance / own.len() as f64 + rounding).sqrt();
        own.iter().for_each(|&i| set[i].sd = sd);
    }
    Some(set)
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
        let read: Vec<f64> = values.iter().map(|value| value * UM).collect();
        let set = recurring(&read).map(|set| set.iter().map(|own| own.value).collect());
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
        let of = |driven, unit: f64| -> Vec<f64> {
            let set = settings(&rows, driven).into_iter().flatten();
            set.map(|own| (own.value / unit * 10.0).round() / 10.0).collect()
        };
        assert_eq!(of(Driven::Load, 1.0), [1.0, -2.0, 3.0]);
        assert_eq!(of(Driven::Displacement, UM), [10.0, -20.0, 10.5]);
    }
}
